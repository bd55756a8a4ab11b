"""Interpolation between two unit quaternions: along the great arc, and along the chord.

Reached as `quaternion.slerp` and `quaternion.nlerp`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, series

Array = NDArray[np.float64]


def _arguments(where: str, q0: ArrayLike, q1: ArrayLike, t: ArrayLike, check: bool) -> tuple[Array, ...]:
    a = checks.unit(where, "q0", q0, 4, check)
    b = checks.unit(where, "q1", q1, 4, check)
    s = checks.array(where, "t", t, (), check)
    checks.broadcast(where, q0=(a, 1), q1=(b, 1), t=(s, 0))
    batch = np.broadcast_shapes(a.shape[:-1], b.shape[:-1], s.shape)
    return np.broadcast_to(a, (*batch, 4)), np.broadcast_to(b, (*batch, 4)), np.broadcast_to(s, batch)


def slerp(q0: ArrayLike, q1: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Interpolate along the great arc from q0 to q1 at constant speed.

    The arc is the one of length theta <= pi on the sphere of quaternions, half
    the angle turned on the way from one rotation to the other.  If
    q0 . q1 < 0 it is not the shortest way between the two rotations; for that,
    pass -q1.  It is evaluated as cos(t theta) q0 + sin(t theta) n, n the unit
    tangent at q0 towards q1: the same as (2.32), whose division by sin(theta)
    would magnify rounding near theta = pi.

    Book: (2.32), (2.33), (2.34)

    Parameters
    ----------
    q0 : (..., 4), unit quaternion
    q1 : (..., 4), unit quaternion
    t : (...)
        0 at q0, 1 at q1; other numbers go on along the great circle.
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If q0 or q1 is not a unit quaternion, or q1 = -q0, where no arc is singled out.
    """
    q0, q1, t = _arguments("quaternion.slerp", q0, q1, t, check)
    cosine = np.einsum("...i,...i->...", q0, q1)
    # q1 -+ q0 is nearly exact where q1 is near +-q0, so its part across q0 keeps its digits.
    near = np.where(cosine < 0.0, -1.0, 1.0)[..., None]
    difference = q1 - near * q0
    tangent = difference - np.einsum("...i,...i->...", q0, difference)[..., None] * q0
    sine = np.sqrt(np.einsum("...i,...i->...", tangent, tangent))
    if check:
        antipodal = (cosine < 0.0) & (sine <= series.ROUNDED)
        if np.any(antipodal):
            index = checks.first(antipodal)
            remedy = "No great arc is singled out; interpolate by way of a third quaternion."
            checks.fail("quaternion.slerp", "q1", "different from -q0", f"{q1[index]}", index, remedy)
    theta = np.arctan2(sine, cosine)
    weight = np.where(sine > 0.0, np.sin(t * theta) / np.where(sine > 0.0, sine, 1.0), t)
    return np.cos(t * theta)[..., None] * q0 + weight[..., None] * tangent


def nlerp(q0: ArrayLike, q1: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Interpolate along the chord from q0 to q1 and project onto the sphere: the same arc, at uneven speed.

    Book: (2.32), for comparison

    Parameters
    ----------
    q0 : (..., 4), unit quaternion
    q1 : (..., 4), unit quaternion
    t : (...)
        0 at q0, 1 at q1.
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If q0 or q1 is not a unit quaternion, or the chord meets 0 at t.
    """
    q0, q1, t = _arguments("quaternion.nlerp", q0, q1, t, check)
    chord = (1.0 - t)[..., None] * q0 + t[..., None] * q1
    length = np.sqrt(np.einsum("...i,...i->...", chord, chord))
    if check and np.any(length <= series.ROUNDED):
        index = checks.first(length <= series.ROUNDED)
        checks.fail("quaternion.nlerp", "q1", "different from -q0 at t = 1/2", f"{q1[index]}", index)
    return chord / length[..., None]
