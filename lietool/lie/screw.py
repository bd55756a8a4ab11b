"""A rigid motion as a screw, a turn about an axis and a slide along it; or as a turn, then a translation.

Reached as `dual_quaternion.from_screw`, `dual_quaternion.to_screw`,
`dual_quaternion.from_rotation_translation` and `dual_quaternion.to_rotation_translation`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, dual_kernels
from lietool.lie.dual_checks import unit

Array = NDArray[np.float64]


def from_screw(
    u: ArrayLike, p: ArrayLike, theta: ArrayLike, d: ArrayLike, *, check: bool = True
) -> NDArray[np.float64]:
    """Return the turn by theta about the axis through p along u, together with the slide by d along it.

    It is the exponential of half the dual angle theta + d eps times the line u + (p cross u) eps.

    Book: (2.9), (2.26) with dual numbers, 2.8

    Parameters
    ----------
    u : (..., 3), unit vector
    p : (..., 3)
        Any point of the axis.
    theta : (...), radians
    d : (...)
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If u is not a unit vector, or something is not finite.
    """
    where = "dual_quaternion.from_screw"
    u = checks.unit(where, "u", u, 3, check)
    p = checks.array(where, "p", p, (3,), check)
    theta = checks.array(where, "theta", theta, (), check)
    d = checks.array(where, "d", d, (), check)
    checks.broadcast(where, u=(u, 1), p=(p, 1), theta=(theta, 0), d=(d, 0))
    half, slide = 0.5 * theta[..., None], 0.5 * d[..., None]
    a, b = np.broadcast_arrays(half * u, half * np.cross(p, u) + slide * u)
    return blocks.run(dual_kernels.exp, (8,), (np.concatenate([a, b], axis=-1), 1))


def to_screw(q: ArrayLike, *, check: bool = True) -> tuple[Array, Array, Array, Array]:
    """Return the axis, its point nearest to the origin, the angle and the slide of a unit dual quaternion.

    The angle is the one that q stands for, at most a full turn, and -q stands
    for the rest of it: align q with 1 for an angle of at most a half turn.
    A translation slides along its axis through the origin; the identity has the x-axis.

    Book: (2.9), (2.26) with dual numbers, 2.8

    Parameters
    ----------
    q : (..., 8), unit dual quaternion
    check : bool, False to trust the values

    Returns
    -------
    u : (..., 3), unit vector
    p : (..., 3)
    theta : (...), radians
        In [0, 2 pi].
    d : (...)

    Raises
    ------
    ValueError
        If q is not a unit dual quaternion.
    """
    x = blocks.run(dual_kernels.log, (6,), (unit("dual_quaternion.to_screw", "q", q, check), 1))
    a, b = x[..., :3], x[..., 3:]
    angle, length = _length(a), _length(b)
    # So small a turn would put the axis beyond all numbers.
    slides = angle * checks.LARGEST <= length
    axis = np.where(slides, b, a)
    size = np.where(slides, length, angle)
    # Scaled before it is normalised, as squares of small numbers vanish.
    u = np.where(size > 0.0, axis / np.where(size > 0.0, size, 1.0), np.array([1.0, 0.0, 0.0]))
    u = u / _length(u)
    d = np.einsum("...i,...i->...", u, b)
    across = np.where(slides, 0.0, (b - d[..., None] * u) / np.where(slides, 1.0, angle))
    return u, np.cross(u, across), 2.0 * np.where(slides, 0.0, angle)[..., 0], 2.0 * d


def _length(x: Array) -> Array:
    """Return the norms as a column, also where squares would vanish."""
    size = np.max(np.abs(x), axis=-1, keepdims=True)
    scaled = x / np.where(size > 0.0, size, 1.0)
    return size * np.sqrt(np.sum(scaled * scaled, axis=-1, keepdims=True))


def from_rotation_translation(r: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Return r + (t r / 2) eps: it turns by the unit quaternion r, then translates by t.

    Book: 2.8, corrected: 1 + (t/2) eps is the translation by t, the printed 1 + t eps that by 2 t

    Parameters
    ----------
    r : (..., 4), unit quaternion
    t : (..., 3)
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If r is not a unit quaternion or t is not finite.
    """
    where = "dual_quaternion.from_rotation_translation"
    r = checks.unit(where, "r", r, 4, check)
    t = checks.array(where, "t", t, (3,), check)
    checks.broadcast(where, r=(r, 1), t=(t, 1))
    return blocks.run(dual_kernels.from_translation, (8,), (r, 1), (t, 1))


def to_rotation_translation(q: ArrayLike, *, check: bool = True) -> tuple[Array, Array]:
    """Return the unit quaternion r and the vector t of q = r + (t r / 2) eps.

    Book: 2.8, corrected as `from_rotation_translation`

    Parameters
    ----------
    q : (..., 8), unit dual quaternion
    check : bool, False to trust the values

    Returns
    -------
    r : (..., 4), unit quaternion
    t : (..., 3)

    Raises
    ------
    ValueError
        If q is not a unit dual quaternion.
    """
    q = unit("dual_quaternion.to_rotation_translation", "q", q, check)
    return q[..., :4].copy(), blocks.run(dual_kernels.translation, (3,), (q, 1))
