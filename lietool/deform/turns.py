"""Whole turns, which no matrix knows of, added to principal rotation vectors."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]

LARGE_STEP = 0.5 * np.pi
"""Radians: a longer step of a rotation vector, from one pose or key to the next, is reported as in doubt."""

_STILL = 1e-9
"""Radians: a rotation by less counts as none, which whole turns about any axis go with."""

_APART = 0.5
"""The cosine of the largest angle between the axis of stated turns and that of the rotation."""


def wound(x: ArrayLike, turns: ArrayLike) -> Array:
    """Return rotation vectors with whole turns added, about the axis and in the sense that is stated.

    Kaji-Ochiai: 4.3

    Parameters
    ----------
    x : (k, 3), radians
        Principal rotation vectors.
    turns : (k, 3)
        Axis times number of whole turns.

    Returns
    -------
    x : (k, 3), radians

    Raises
    ------
    ValueError
        If the turns are not whole, or their axis is more than 60 degrees off
        that of the rotation: all its logarithms lie on one line.
    """
    where = "turns.wound"
    a, t = checks.array(where, "x", x, (3,)), checks.array(where, "turns", turns, (3,))
    checks.broadcast(where, x=(a, 1), turns=(t, 1))
    a, t = np.broadcast_arrays(a, t)
    n, theta = np.linalg.norm(t, axis=-1, keepdims=True), np.linalg.norm(a, axis=-1, keepdims=True)
    broken = np.abs(n - np.rint(n))[..., 0] > checks.TOLERANCE
    if np.any(broken):
        index = checks.first(broken)
        checks.fail(where, "turns", "an axis times a whole number", f"length {n[index][0]:.6g}", index)
    n = np.rint(n)
    u, still = t / np.where(n > 0.0, n, 1.0), theta <= _STILL
    w = np.where(still, u, a / np.where(theta > 0.0, theta, 1.0))
    cosine = np.sum(u * w, axis=-1, keepdims=True)
    astray = ((n > 0.0) & (np.abs(cosine) < _APART))[..., 0]
    if np.any(astray):
        index = checks.first(astray)
        must = "about the axis of the probe's rotation"
        checks.fail(where, "turns", must, f"{np.round(u[index], 4)}, not {np.round(w[index], 4)}", index)
    return a + 2.0 * np.pi * n * np.sign(cosine) * w
