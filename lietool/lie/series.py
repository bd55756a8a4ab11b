"""The coefficients like (sin t)/t, and every threshold that decides when an angle counts as small.

Each function is even or odd in its angle, defined at 0, and accurate to a few
ulp on both sides of its switch; nothing else in the package may test an angle
for smallness.
"""

from math import factorial

import numpy as np
from numpy.typing import ArrayLike, NDArray

_EPS = float(np.finfo(np.float64).eps)

ROUNDED = 16 * _EPS
"""Radians. The product of a few rotations that should be the identity differs from it by less than this."""

LOCKED = 2 * _EPS
"""The rounding of the small components of a quaternion read from a matrix: below it they say nothing."""

_TINY = 1e-300  # stands in for an exact 0: sin and atan2 return it unchanged, so the quotient is the limit

# (t - sin t) / t^3: where the subtraction keeps all but two bits, t - sin t > t / 4.
_DEFECT_SWITCH = 1.6
_DEFECT = [(-1.0) ** k / factorial(2 * k + 3) for k in range(12)]

# (sin h - h cos h) / h^3, an entire function; for h > 1 the subtraction keeps all but two bits.
_LEVER_SWITCH = 1.0
_LEVER = [(-1.0) ** k * (2 * k + 2) / factorial(2 * k + 3) for k in range(10)]

# The slope of (t - sin t) / t^3; beyond the switch its subtraction keeps all but two bits.
_DEFECT_SLOPE_SWITCH = 4.0
_DEFECT_SLOPE = [(-1.0) ** (k + 1) * (2 * k + 2) / factorial(2 * k + 5) for k in range(20)]

# ((t/4) sin t + t^2/4 - 1 + cos t) / t^6, an entire function; beyond the switch two bits are lost.
_COTANGENT_SLOPE_SWITCH = 3.5
_COTANGENT_SLOPE = [(-1.0) ** k * (k + 1) / (2 * factorial(2 * k + 6)) for k in range(16)]


def _polynomial(coefficients: list[float], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Evaluate sum c_k x^k by Horner's rule."""
    value = np.full_like(x, coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        value = value * x + coefficient
    return value


def sinc(t: ArrayLike) -> NDArray[np.float64]:
    """Divide the sine of an angle by the angle: (sin t) / t, and 1 at 0.

    Book: (7.4)

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    t = np.asarray(t, dtype=np.float64)
    t = np.where(t == 0.0, _TINY, t)
    return np.sin(t) / t


def versinc(t: ArrayLike) -> NDArray[np.float64]:
    """Divide the versed sine of an angle by its square: (1 - cos t) / t^2, and 1/2 at 0.

    It is half the square of `sinc` of t/2, which subtracts nothing.

    Book: (7.4)
    Kaji-Ochiai: (4)

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    half = sinc(0.5 * np.asarray(t, dtype=np.float64))
    return 0.5 * half * half


def sine_defect(t: ArrayLike) -> NDArray[np.float64]:
    """Divide what the sine lacks by the cube of the angle: (t - sin t) / t^3, and 1/6 at 0.

    Book: (7.5)

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    t = np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(t, _DEFECT_SWITCH)
    far = np.maximum(t, _DEFECT_SWITCH)
    return np.where(
        t < _DEFECT_SWITCH, _polynomial(_DEFECT, near * near), (far - np.sin(far)) / (far * far * far)
    )


def cotangent_defect(t: ArrayLike) -> NDArray[np.float64]:
    """Return (1 - (t/2) cot(t/2)) / t^2, and 1/12 at 0: the second coefficient of the inverse left Jacobian.

    It is the last coefficient of (7.8), as (1 + cos t) / sin t = cot(t/2); what
    is printed is 0/0 at t = pi.  With h = t/2: (sin h - h cos h) / (4 h^2 sin h).

    Book: (7.8)

    Parameters
    ----------
    t : (...), radians
        Any angle except the poles 2 pi n, n not 0.

    Returns
    -------
    value : (...)
    """
    h = 0.5 * np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(h, _LEVER_SWITCH)
    far = np.maximum(h, _LEVER_SWITCH)
    sine = np.sin(far)
    return np.where(
        h < _LEVER_SWITCH,
        _polynomial(_LEVER, near * near) / (4.0 * sinc(near)),
        (sine - far * np.cos(far)) / (4.0 * far * far * sine),
    )


def sinc_slope(t: ArrayLike) -> NDArray[np.float64]:
    """Return (sin t - t cos t) / t^3, and 1/3 at 0: the derivative of `sinc` is -t times this.

    Book: 2.8, the exponential of dual quaternions

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    t = np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(t, _LEVER_SWITCH)
    far = np.maximum(t, _LEVER_SWITCH)
    return np.where(
        t < _LEVER_SWITCH,
        _polynomial(_LEVER, near * near),
        (np.sin(far) - far * np.cos(far)) / (far * far * far),
    )


def versinc_slope(t: ArrayLike) -> NDArray[np.float64]:
    """Divide the derivative of `versinc` by the angle: (t sin t - 2 (1 - cos t)) / t^4, and -1/12 at 0.

    With h = t/2 it is -(1/4) (sin h / h) (sin h - h cos h) / h^3.  The left
    Jacobian of SE(3) holds the derivative of that of SO(3), and this in it.

    Book: (7.5), (A.10)

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    h = 0.5 * np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(h, _LEVER_SWITCH)
    far = np.maximum(h, _LEVER_SWITCH)
    lever = np.where(
        h < _LEVER_SWITCH,
        _polynomial(_LEVER, near * near),
        (np.sin(far) - far * np.cos(far)) / (far * far * far),
    )
    return -0.25 * sinc(h) * lever


def sine_defect_slope(t: ArrayLike) -> NDArray[np.float64]:
    """Divide the derivative of `sine_defect` by the angle, and return -1/60 at 0.

    It is (1 - cos t) / t^4 - 3 (t - sin t) / t^5.

    Book: (7.5), (A.10)

    Parameters
    ----------
    t : (...), radians
        Any angle.

    Returns
    -------
    value : (...)
    """
    t = np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(t, _DEFECT_SLOPE_SWITCH)
    far = np.maximum(t, _DEFECT_SLOPE_SWITCH)
    return np.where(
        t < _DEFECT_SLOPE_SWITCH,
        _polynomial(_DEFECT_SLOPE, near * near),
        (versinc(far) - 3.0 * sine_defect(far)) / (far * far),
    )


def cotangent_defect_slope(t: ArrayLike) -> NDArray[np.float64]:
    """Divide the derivative of `cotangent_defect` by the angle, and return 1/360 at 0.

    It is ((t/4) sin t + t^2/4 - 1 + cos t) / (t^4 sin^2(t/2)).

    Book: (7.8), (A.11)

    Parameters
    ----------
    t : (...), radians
        Any angle except the poles 2 pi n, n not 0.

    Returns
    -------
    value : (...)
    """
    t = np.abs(np.asarray(t, dtype=np.float64))
    near = np.minimum(t, _COTANGENT_SLOPE_SWITCH)
    far = np.maximum(t, _COTANGENT_SLOPE_SWITCH)
    half = sinc(0.5 * near)
    square = far * far
    sine = np.sin(0.5 * far)
    return np.where(
        t < _COTANGENT_SLOPE_SWITCH,
        4.0 * _polynomial(_COTANGENT_SLOPE, near * near) / (half * half),
        (0.25 * (far * np.sin(far) + square) - 2.0 * sine * sine) / (square * square * sine * sine),
    )


def angle_over_sine(s: ArrayLike, c: ArrayLike) -> NDArray[np.float64]:
    """Divide the angle of the point (c, s) by s: atan2(s, c) / s, and 1/c at s = 0.

    This carries the imaginary part of a quaternion, of norm s, to its logarithm.
    The norm of (c, s) need not be 1: the angle does not change with it.

    Book: (2.31)

    Parameters
    ----------
    s : (...), positive
        The sine, or a positive multiple of it; 0 only together with c > 0.
    c : (...), positive
        The cosine, or the same multiple of it.

    Returns
    -------
    value : (...), radians
    """
    s = np.asarray(s, dtype=np.float64)
    s = np.where(s == 0.0, _TINY, s)
    return np.arctan2(s, c) / s


def at_pole(t: ArrayLike) -> NDArray[np.bool_]:
    """Tell whether an angle is 2 pi n, n not 0, up to its rounding: a pole of `cotangent_defect`.

    Book: (4.30)

    Parameters
    ----------
    t : (...), radians

    Returns
    -------
    pole : (...)
    """
    t = np.abs(np.asarray(t, dtype=np.float64))
    return (t > 1.0) & (np.abs(np.sin(0.5 * t)) <= _EPS * t)
