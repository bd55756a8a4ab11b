"""A rotation of space as an axis and an angle.

Reached as `so3.from_axis_angle`, `so3.to_axis_angle` and `so3.rotation`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, kernels

AXES = ("x", "y", "z")


def from_axis_angle(u: ArrayLike, theta: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation about a unit vector by an angle.

    Book: (2.14), (2.15), (A.1), (A.2), (A.3), (A.4), (A.5), (A.7)

    Parameters
    ----------
    u : (..., 3), unit vector
    theta : (...), radians
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If u is not a unit vector or theta is not finite.
    """
    u = checks.unit("so3.from_axis_angle", "u", u, 3, check)
    theta = checks.array("so3.from_axis_angle", "theta", theta, (), check)
    checks.broadcast("so3.from_axis_angle", u=(u, 1), theta=(theta, 0))
    return blocks.run(kernels.rotation_exp, (3, 3), (theta[..., None] * u, 1))


def to_axis_angle(R: ArrayLike, *, check: bool = True) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the axis and the angle of a rotation; for the identity, the x-axis and 0.

    Book: (2.16), (2.19), (7.6), (7.7)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    check : bool, False to trust the values

    Returns
    -------
    u : (..., 3), unit vector
    theta : (...), radians
        In [0, pi].

    Raises
    ------
    ValueError
        If R is not a rotation.
    """
    R = checks.rotation("so3.to_axis_angle", "R", R, 3, check)
    x = blocks.run(kernels.rotation_log, (3,), (R, 2))
    # Scaled by its largest entry first, for the square of an angle below 1e-154 vanishes.
    size = np.max(np.abs(x), axis=-1, keepdims=True)
    direction = np.where(size > 0.0, x / np.where(size > 0.0, size, 1.0), np.array([1.0, 0.0, 0.0]))
    norm = np.linalg.norm(direction, axis=-1, keepdims=True)
    return direction / norm, (size * norm)[..., 0]


def rotation(axis: str, theta: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation about a coordinate axis by an angle.

    Book: (2.21)

    Parameters
    ----------
    axis : {AXES}
    theta : (...), radians
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If the axis has another name or theta is not finite.
    """
    if axis not in AXES:
        checks.fail("so3.rotation", "axis", "one of x, y, z", repr(axis), None)
    theta = checks.array("so3.rotation", "theta", theta, (), check)
    i = AXES.index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    R = np.zeros((*theta.shape, 3, 3))
    R[..., i, i] = 1.0
    R[..., j, j] = R[..., k, k] = np.cos(theta)
    R[..., k, j] = np.sin(theta)
    R[..., j, k] = 0.0 - R[..., k, j]
    return R
