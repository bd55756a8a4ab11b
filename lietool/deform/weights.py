"""Weights from distances, (n points, k probes), and what they are made to sum to.

The distances may be straight (`distances`), along a surface, or any others;
infinite ones, as between two components, get the weight 0.  Then one of

    unnormalised        as they are
    partition_of_unity  divided by their sum
    softmax             exp of them, divided by the sum of these
    capped              divided by max(1, sum): what lacks of 1 is the identity's
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform.weight_checks import lengths, matrix, positions, positive
from lietool.deform.weight_sums import NORMALISATIONS as NORMALISATIONS
from lietool.deform.weight_sums import capped as capped
from lietool.deform.weight_sums import partition_of_unity as partition_of_unity
from lietool.deform.weight_sums import softmax as softmax
from lietool.deform.weight_sums import unnormalised as unnormalised
from lietool.lie import blocks, checks

Array = NDArray[np.float64]

NEAREST = 1e-9
"""Of the largest distance: `inverse_distance` counts shorter ones as this, lest a weight be infinite."""


@dataclass(frozen=True)
class Weights:
    """Weights (n, k) of the probes at the points, of their rotation, translation and stretch."""

    rotation: Array
    translation: Array
    stretch: Array

    @property
    def shared(self) -> bool:
        """Whether one array serves for all three."""
        return self.rotation is self.translation and self.rotation is self.stretch


def separate(rotation: ArrayLike, translation: ArrayLike, stretch: ArrayLike) -> Weights:
    """Return different weights for the three parts of a transformation.

    Kaji-Ochiai: 5.1

    Parameters
    ----------
    rotation, translation, stretch : (n, k)

    Returns
    -------
    weights : Weights

    Raises
    ------
    ValueError
        If they are not of one shape (n, k), or not finite.
    """
    where = "weights.separate"
    r = matrix(where, "rotation", rotation)
    t = matrix(where, "translation", translation, *r.shape)
    return Weights(r, t, matrix(where, "stretch", stretch, *r.shape))


def distances(points: ArrayLike, centres: ArrayLike) -> Array:
    """Return the straight distances from points to the centres of probes.

    Book: 7.2

    Parameters
    ----------
    points : (n, 3)
    centres : (k, 3)

    Returns
    -------
    r : (n, k)

    Raises
    ------
    ValueError
        If points or centres are no finite arrays of these shapes, or there are no centres.
    """
    where = "weights.distances"
    p, c = positions(where, "points", points), positions(where, "centres", centres)
    if not len(c):
        checks.fail(where, "centres", "of shape (k, 3), k >= 1", f"shape {c.shape}", None)
    r = np.empty((len(p), len(c)))
    for start in range(0, len(p), blocks.BLOCK):
        part = p[start : start + blocks.BLOCK, None, :] - c
        r[start : start + blocks.BLOCK] = np.einsum("nki,nki->nk", part, part)
    return np.sqrt(r, out=r)


def inverse_distance(distances: ArrayLike, power: float = 2.0) -> Array:
    """Return 1 / r^p.

    At a probe it would be infinite: distances below `NEAREST` of the largest
    count as that, which after `partition_of_unity` gives the probe all weight.

    Book: 7.2
    Kaji-Ochiai: 5.1

    Parameters
    ----------
    distances : (n, k)
    power : float
        Above 0.

    Returns
    -------
    w : (n, k)

    Raises
    ------
    ValueError
        If a distance is negative or nan, the power is not above 0, or a weight overflows.
    """
    where = "weights.inverse_distance"
    r, p = lengths(where, distances), float(positive(where, "power", power))
    largest = np.max(r, initial=0.0, where=np.isfinite(r)) or 1.0
    with np.errstate(over="ignore", divide="ignore", under="ignore"):
        w = np.maximum(r, NEAREST * largest)
        w **= p
        np.divide(1.0, w, out=w)
    if not np.all(w <= checks.LARGEST):
        index = checks.first(~(w <= checks.LARGEST))
        got = f"{r[index]:.3g} to the power of {p:g}"
        checks.fail(where, "distances", "such that 1 / r^p does not overflow", got, index, "Scale them.")
    return w


def shepard(points: ArrayLike, centres: ArrayLike, power: float = 2.0) -> Array:
    """Return 1 / r^p of the straight distances, divided by their sum: Shepard's weights.

    Book: 7.2
    Kaji-Ochiai: 5.1

    Parameters
    ----------
    points : (n, 3)
    centres : (k, 3)
    power : float
        Above 0.

    Returns
    -------
    w : (n, k)
        They sum to 1; at a probe all is its.

    Raises
    ------
    ValueError
        As `distances` and `inverse_distance`.
    """
    return partition_of_unity(inverse_distance(distances(points, centres), power))


def cutoff(distances: ArrayLike, reach: ArrayLike, power: float = 2.0) -> Array:
    """Return ((reach - r) / reach)^p within the reach of a probe and 0 beyond.

    Kaji-Ochiai: 5.1, weights from the distance

    Parameters
    ----------
    distances : (n, k)
    reach : (k,)
        Or one number for all.
    power : float
        Above 0; above 1 for weights without a kink at the reach.

    Returns
    -------
    w : (n, k)
        From 1 at the probe to 0.

    Raises
    ------
    ValueError
        If a distance is negative or nan, or the reach or the power is not above 0.
    """
    where = "weights.cutoff"
    r = lengths(where, distances)
    d, p = positive(where, "reach", reach, r.shape[1]), float(positive(where, "power", power))
    w = r / -d
    w += 1.0
    np.maximum(w, 0.0, out=w)
    w **= p
    return w


def gaussian(distances: ArrayLike, width: ArrayLike) -> Array:
    """Return exp(-(r / width)^2 / 2).

    Kaji-Ochiai: 5.1, weights from the distance

    Parameters
    ----------
    distances : (n, k)
    width : (k,)
        The standard deviation, or one number for all.

    Returns
    -------
    w : (n, k)
        From 1 at the probe to 0.

    Raises
    ------
    ValueError
        If a distance is negative or nan, or the width is not above 0.
    """
    where = "weights.gaussian"
    r = lengths(where, distances)
    w = r / positive(where, "width", width, r.shape[1])
    with np.errstate(over="ignore", under="ignore"):
        np.multiply(w, w, out=w)
        w *= -0.5
        return np.exp(w, out=w)
