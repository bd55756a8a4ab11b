"""Euler angles in all twelve conventions, which are data.

The convention `"ijk"` means R = R_k(t3) R_j(t2) R_i(t1): a rotation about the
fixed axis i, then j, then k, as (2.21) has it for `"xyz"` and (2.23) for
`"xyx"`.  Seen from the gimbal, k is the outer axis and i the inner one.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, quaternion, series, so3

Array = NDArray[np.float64]

PROPER = ("xyx", "xzx", "yxy", "yzy", "zxz", "zyz")
"""First and last axis are the same; locked at t2 = 0 and pi."""

TAIT_BRYAN = ("xyz", "xzy", "yxz", "yzx", "zxy", "zyx")
"""Three different axes; locked at t2 = -pi/2 and pi/2."""

CONVENTIONS = PROPER + TAIT_BRYAN

_HALF_PI_REST = 6.123233995736766e-17  # pi/2 less its float64


def _letters(where: str, convention: str) -> tuple[str, str, str]:
    if convention not in CONVENTIONS:
        checks.fail(where, "convention", f"one of {', '.join(CONVENTIONS)}", repr(convention), None)
    i, j, k = convention
    return i, j, k


def ring_frames(angles: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the orientations of the outer ring, the middle ring and the body in a gimbal.

    Book: (2.21), (2.23)

    Parameters
    ----------
    angles : (..., 3), radians
        t1, t2, t3.
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    frames : (..., 3, 3, 3), rotation
        R_k(t3), R_k(t3) R_j(t2) and R_k(t3) R_j(t2) R_i(t1).

    Raises
    ------
    ValueError
        If the convention is unknown or an angle is not finite.
    """
    i, j, k = _letters("euler.ring_frames", convention)
    t = checks.array("euler.ring_frames", "angles", angles, (3,), check)
    outer = so3.rotation(k, t[..., 2], check=False)
    middle = outer @ so3.rotation(j, t[..., 1], check=False)
    return np.stack([outer, middle, middle @ so3.rotation(i, t[..., 0], check=False)], axis=-3)


def to_matrix(angles: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the rotation R_k(t3) R_j(t2) R_i(t1).

    Book: (2.21), (2.22), (2.23)

    Parameters
    ----------
    angles : (..., 3), radians
        t1, t2, t3.
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If the convention is unknown or an angle is not finite.
    """
    i, j, k = _letters("euler.to_matrix", convention)
    t = checks.array("euler.to_matrix", "angles", angles, (3,), check)
    R = so3.rotation(k, t[..., 2], check=False) @ so3.rotation(j, t[..., 1], check=False)
    return R @ so3.rotation(i, t[..., 0], check=False)


def _handedness(i: int, j: int) -> float:
    """Return the sign of e_i x e_j against the third axis."""
    return 1.0 if (j - i) % 3 == 1 else -1.0


def _wrap(angle: Array) -> Array:
    """Bring an angle of (-2 pi, 2 pi] into (-pi, pi]."""
    angle = np.where(angle > np.pi, angle - 2.0 * np.pi, angle)
    return np.where(angle <= -np.pi, angle + 2.0 * np.pi, angle)


def from_matrix(R: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the Euler angles of a rotation.

    t2 is in [0, pi] for the proper conventions and in [-pi/2, pi/2] for the
    Tait-Bryan ones, t1 and t3 are in (-pi, pi].  At lock only t1 + t3 or
    t1 - t3 is determined; there t3 = 0, and t1 has it all.  That t1 and t3
    jump beside a lock is the nature of these angles, not of the method.

    Book: (2.21), (2.22), (2.23)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    angles : (..., 3), radians
        t1, t2, t3.

    Raises
    ------
    ValueError
        If the convention is unknown or R is not a rotation.
    """
    i, j, k = (so3.AXES.index(letter) for letter in _letters("euler.from_matrix", convention))
    R = checks.rotation("euler.from_matrix", "R", R, 3, check)
    q = quaternion.from_matrix(R, check=False)
    sign = _handedness(i, j)
    a, b, c, d = q[..., 0], q[..., 1 + i], q[..., 1 + j], sign * q[..., 4 - i - j]
    if k != i:
        # As in (2.22), a quarter turn about j in front leaves R_i R_j R_i, with t2 + pi/2 and sign t3.
        a, b, c, d = a - c, b + d, c + a, d - b
    # The quaternion is (cos t2/2 (cos s, sin s), sin t2/2 (cos r, sin r)), s = (t3 + t1)/2, r = (t3 - t1)/2.
    sine, cosine = np.hypot(c, d), np.hypot(a, b)
    s, r = np.arctan2(b, a), np.arctan2(d, c)
    r = np.where(sine <= series.LOCKED, -s, r)
    s = np.where(cosine <= series.LOCKED, -r, s)
    t1, t3 = _wrap(s - r), _wrap(s + r)
    if k == i:
        t2 = 2.0 * np.arctan2(sine, cosine)
    else:
        t2, t3 = np.arctan2(-sign * R[..., k, i], sine * cosine), sign * t3
    return np.stack([t1, t2, t3], axis=-1) + 0.0


def axes(angles: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the three axes about which t1, t2, t3 turn the body now, in fixed coordinates.

    Book: (2.21), (2.23)

    Parameters
    ----------
    angles : (..., 3), radians
        t1, t2, t3.
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    u : (..., 3, 3)
        u[..., n, :] is the axis of the n-th angle, a unit vector.

    Raises
    ------
    ValueError
        If the convention is unknown or an angle is not finite.
    """
    i, j, k = (so3.AXES.index(letter) for letter in _letters("euler.axes", convention))
    t = checks.array("euler.axes", "angles", angles, (3,), check)
    frames = ring_frames(t, convention, check=False)
    fixed = np.broadcast_to(np.eye(3)[k], (*t.shape[:-1], 3))
    # R_i(t1) leaves its axis alone, so that of the inner ring is read from the middle one; likewise outwards.
    return np.stack([frames[..., 1, :, i], frames[..., 0, :, j], fixed], axis=-2)


def jacobian(angles: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the matrix from the rates of the angles to the angular velocity in fixed axes.

    Its columns are the current axes; at lock two of them coincide up to sign.

    Book: (2.21), (2.23)

    Parameters
    ----------
    angles : (..., 3), radians
        t1, t2, t3.
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    J : (..., 3, 3)

    Raises
    ------
    ValueError
        If the convention is unknown or an angle is not finite.
    """
    _letters("euler.jacobian", convention)
    t = checks.array("euler.jacobian", "angles", angles, (3,), check)
    return np.swapaxes(axes(t, convention, check=False), -1, -2).copy()


def singular_values(angles: ArrayLike, convention: str, *, check: bool = True) -> Array:
    """Return the singular values of the Jacobian, largest first.

    The middle axis is orthogonal to the two others, whose inner product is
    cos t2 (proper) or sin t2 up to sign (Tait-Bryan): so they are
    sqrt 2 cos(v/2), 1, sqrt 2 sin(v/2), v being the angle from t2 to lock.

    Book: (2.22), (2.23)

    Parameters
    ----------
    angles : (..., 3), radians
        t1, t2, t3; only t2 matters.
    convention : {CONVENTIONS}
    check : bool, False to trust the values

    Returns
    -------
    sigma : (..., 3)

    Raises
    ------
    ValueError
        If the convention is unknown or an angle is not finite.
    """
    _letters("euler.singular_values", convention)
    v = checks.array("euler.singular_values", "angles", angles, (3,), check)[..., 1]
    if convention in TAIT_BRYAN:
        v = (np.abs(v) - np.pi / 2) - _HALF_PI_REST
    c, s = np.abs(np.cos(0.5 * v)), np.abs(np.sin(0.5 * v))
    return np.stack(
        [np.sqrt(2.0) * np.maximum(c, s), np.ones_like(v), np.sqrt(2.0) * np.minimum(c, s)], axis=-1
    )
