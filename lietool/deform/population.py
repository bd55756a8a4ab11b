"""Weights for many variations of a few shapes: at random, from a seed, or all of a grid."""

from math import comb

import numpy as np
from numpy.typing import NDArray

from lietool.lie import checks

Array = NDArray[np.float64]

MOST = 1_000_000
"""A grid of more weights is refused."""


def dirichlet(count: int, targets: int, seed: int, *, concentration: float = 1.0, rest: float = 0.0) -> Array:
    """Return weights at random: not negative, of sum 1 with the rest's, by the Dirichlet distribution.

    Kaji-Ochiai: figure 3

    Parameters
    ----------
    count : int
        How many variations.
    targets : int
    seed : int
        Equal seeds give equal weights.
    concentration : float
        1 is uniform over all mixtures; below, most are near to a single target; above, near to the mean.
    rest : float
        The concentration of the rest, whose weight is what the others lack of 1; 0 leaves it out.

    Returns
    -------
    w : (count, targets)

    Raises
    ------
    ValueError
        If a number is out of its range.
    """
    where = "population.dirichlet"
    _at_least(where, "count", count, 0)
    _at_least(where, "targets", targets, 1)
    _at_least(where, "seed", seed, 0)
    if not 0.0 < concentration < np.inf:
        checks.fail(where, "concentration", "positive and finite", f"{concentration}", None)
    if not 0.0 <= rest < np.inf:
        checks.fail(where, "rest", "not negative, and finite", f"{rest}", None)
    alpha = [concentration] * targets + ([rest] if rest > 0.0 else [])
    return np.random.default_rng(seed).dirichlet(alpha, count)[:, :targets]


def grid(targets: int, steps: int) -> Array:
    """Return all weights of sum 1 that are whole multiples of 1 / steps, the corners among them.

    Kaji-Ochiai: figure 3

    Parameters
    ----------
    targets : int
    steps : int
        At least 1, which gives the targets alone.

    Returns
    -------
    w : (count, targets)
        In lexical order, from (1, 0, ...) to (..., 0, 1).

    Raises
    ------
    ValueError
        If a number is too small, or there would be more than a million weights.
    """
    where = "population.grid"
    _at_least(where, "targets", targets, 1)
    _at_least(where, "steps", steps, 1)
    if (many := comb(steps + targets - 1, targets - 1)) > MOST:
        checks.fail(where, "steps", f"so few that there are at most {MOST} weights", f"{many}", None)
    w = np.zeros((1, 0), np.intp)
    for _ in range(targets - 1):
        left = steps - w.sum(axis=1)
        share = np.concatenate([np.arange(n, -1, -1) for n in left])
        w = np.column_stack([np.repeat(w, left + 1, axis=0), share])
    return np.column_stack([w, steps - w.sum(axis=1)]) / steps


def _at_least(where: str, name: str, value: int, least: int) -> None:
    if not isinstance(value, int | np.integer) or value < least:
        checks.fail(where, name, f"a whole number, at least {least}", f"{value}", None)
