"""What the functions of weights and of probes ask of their arguments, beside `lie.checks`."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]

CANCELLED = 1e-12
"""Of the sum of |w|: a smaller sum of w is the rounding of 0."""


def matrix(
    where: str, name: str, w: ArrayLike, points: int | None = None, probes: int | None = None
) -> Array:
    """Return finite numbers (n, k) as a float64 array, refused otherwise.

    Parameters
    ----------
    where, name : str
        Who asks, and what the argument is called, for the message.
    w : (n, k)
    points, probes : int or None
        The numbers of rows and columns, where they are known.

    Returns
    -------
    w : (n, k)

    Raises
    ------
    ValueError
        If w has another shape, or is not finite.
    """
    a = checks.array(where, name, w, ())
    n, k = "n" if points is None else points, "k" if probes is None else probes
    wrong = a.ndim != 2 or (points is not None and len(a) != points)
    if wrong or a.shape[1] == 0 or (probes is not None and a.shape[1] != probes):
        checks.fail(where, name, f"an array of shape ({n}, {k}), points by probes", f"shape {a.shape}", None)
    return a


def positions(where: str, name: str, points: ArrayLike) -> Array:
    """Return finite points (n, 3) as a float64 array, refused otherwise.

    Parameters
    ----------
    where, name : str
        Who asks, and what the argument is called, for the message.
    points : (n, 3)

    Returns
    -------
    points : (n, 3)

    Raises
    ------
    ValueError
        If they have another shape, or are not finite.
    """
    p = checks.array(where, name, points, (3,))
    if p.ndim != 2:
        checks.fail(where, name, "an array of shape (n, 3)", f"shape {p.shape}", None)
    return p


def lengths(where: str, r: ArrayLike) -> Array:
    """Return distances (n, k), none negative; infinite ones are allowed."""
    a = checks.array(where, "distances", r, (), check=False)
    if a.ndim != 2 or a.shape[1] == 0:
        checks.fail(
            where, "distances", "an array of shape (n, k), points by probes", f"shape {a.shape}", None
        )
    bad = ~(a >= 0.0)
    if np.any(bad):
        index = checks.first(bad)
        checks.fail(where, "distances", "0 or more", f"{a[index]}", index)
    return a


def positive(where: str, name: str, x: ArrayLike, k: int | None = None) -> Array:
    """Return one positive number, or one for each of k probes if there may be so many."""
    a = checks.array(where, name, x, ())
    if a.shape not in ((), (k,)):
        must = "one number" if k is None else f"one number or {k} of them, one for each probe"
        checks.fail(where, name, must, f"shape {a.shape}", None)
    if not np.all(a > 0.0):
        index = checks.first(~(a > 0.0))
        checks.fail(where, name, "above 0", f"{a[index]}", index or None)
    return a
