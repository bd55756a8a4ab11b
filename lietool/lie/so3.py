"""SO(3), the rotations of space, and its Lie algebra so(3), coordinates in R^3: the axis times the angle."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, series, shepperd

AXES = ("x", "y", "z")


def hat(x: ArrayLike) -> NDArray[np.float64]:
    """Return the skew-symmetric matrix X with X p = x cross p.

    Book: (A.8)

    Parameters
    ----------
    x : (..., 3)

    Returns
    -------
    X : (..., 3, 3), skew
    """
    x = checks.array("so3.hat", "x", x, (3,), check=False)
    X = np.zeros((*x.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        X[..., k, j] = x[..., i]
        X[..., j, k] = 0.0 - x[..., i]
    return X


def vee(X: ArrayLike) -> NDArray[np.float64]:
    """Return the vector of a skew-symmetric matrix, the inverse of `hat`.

    Book: (A.8)

    Parameters
    ----------
    X : (..., 3, 3), skew

    Returns
    -------
    x : (..., 3)
    """
    X = checks.array("so3.vee", "X", X, (3, 3), check=False)
    D = X - np.swapaxes(X, -1, -2)
    return 0.5 * np.stack([D[..., 2, 1], D[..., 0, 2], D[..., 1, 0]], axis=-1)


def _exp_rows(x: NDArray[np.float64]) -> blocks.Rows:
    """Rodrigues' formula I + a X + b X^2, X^2 = x x^T - |x|^2 I."""
    x, y, z = x
    a, b = series.rodrigues(np.sqrt(x * x + y * y + z * z))
    bx, by, bz = b * x, b * y, b * z
    ax, ay, az = a * x, a * y, a * z
    xx, yy, zz, xy, xz, yz = bx * x, by * y, bz * z, bx * y, bx * z, by * z
    return (
        *(1.0 - (yy + zz), xy - az, xz + ay),
        *(xy + az, 1.0 - (xx + zz), yz - ax),
        *(xz - ay, yz + ax, 1.0 - (xx + yy)),
    )


def exp(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation about x by the angle |x|.

    Book: (2.15), (4.7), (4.20), (7.3), (7.4), (A.6)
    Kaji-Ochiai: (4)

    Parameters
    ----------
    x : (..., 3), radians
        Axis times angle, of any length.
    check : bool
        False skips the look for nan and infinity.

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("so3.exp", "x", x, (3,), check)
    return blocks.run(_exp_rows, (3, 3), (x, 1))


def _log_rows(R: NDArray[np.float64]) -> blocks.Rows:
    w, x, y, z = shepperd.quaternion(R)
    # x, y, z are sin(theta/2) u and w is cos(theta/2), both to the same scale.
    f = 2.0 * series.angle_over_sine(np.sqrt(x * x + y * y + z * z), w)
    return f * x, f * y, f * z


def log(R: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the principal logarithm of a rotation, |x| <= pi.

    At a half turn both x and -x serve: the largest component of x is positive.
    The angle comes from atan2 of the quaternion's two parts; (7.6) is printed
    without its -1 and an arc cosine would lose half of the digits near 0 and pi.

    Book: (4.24), (4.25), (4.26), (7.6), (7.7)
    Kaji-Ochiai: (8)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    check : bool
        False skips the look for nan, infinity and matrices that are not rotations.

    Returns
    -------
    x : (..., 3), radians

    Raises
    ------
    ValueError
        If R is not a rotation.
    """
    R = checks.rotation("so3.log", "R", R, 3, check)
    return blocks.run(_log_rows, (3,), (R, 2))


def _round(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to the nearest whole number, halves towards 0: of two logarithms equally near, the shorter."""
    return np.copysign(np.ceil(np.abs(turns) - 0.5), turns)


def log_near(
    R: ArrayLike, reference: ArrayLike, *, check: bool = True
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the logarithm of a rotation that is nearest to a reference, of all its branches.

    The logarithms of R are (theta + 2 pi k) u, for every whole k.  If R is the
    identity they are 0 and every vector of length 2 pi n; a rotation by less
    than `series.ROUNDED` counts as a rounded identity.  Of two equally near,
    the shorter is taken.

    Book: (4.27), (4.28)
    Kaji-Ochiai: Algorithm 1, corrected: the printed loop is not the nearest, and fails at angles 0 and pi

    Parameters
    ----------
    R : (..., 3, 3), rotation
    reference : (..., 3), radians
        Axis times angle, of any length.
    check : bool
        False skips the look for nan, infinity and matrices that are not rotations.

    Returns
    -------
    x : (..., 3), radians
        With exp(x) = R.
    distance : (...), radians
        |x - reference|.

    Raises
    ------
    ValueError
        If R is not a rotation or the reference is not finite.
    """
    principal = log(checks.rotation("so3.log_near", "R", R, 3, check), check=False)
    reference = checks.array("so3.log_near", "reference", reference, (3,), check)
    checks.broadcast("so3.log_near", R=(principal, 1), reference=(reference, 1))
    principal, reference = np.broadcast_arrays(principal, reference)
    theta = np.linalg.norm(principal, axis=-1, keepdims=True)
    length = np.linalg.norm(reference, axis=-1, keepdims=True)
    identity = theta <= series.ROUNDED
    u = principal / np.where(theta > 0.0, theta, 1.0)
    k = _round((np.sum(u * reference, axis=-1, keepdims=True) - theta) / (2.0 * np.pi))
    n = _round(length / (2.0 * np.pi))
    turned = principal + 2.0 * np.pi * np.where(identity, 0.0, k) * u
    around = 2.0 * np.pi * n * reference / np.where(length > 0.0, length, 1.0)
    x = np.where(identity & (n > 0.0), around, turned)
    return x, np.linalg.norm(x - reference, axis=-1)


def inverse(R: ArrayLike) -> NDArray[np.float64]:
    """Return the inverse of a rotation, its transpose.

    Book: (2.20)

    Parameters
    ----------
    R : (..., 3, 3), rotation

    Returns
    -------
    R_inverse : (..., 3, 3), rotation
    """
    R = checks.array("so3.inverse", "R", R, (3, 3), check=False)
    return np.swapaxes(R, -1, -2).copy()


def act(R: ArrayLike, p: ArrayLike) -> NDArray[np.float64]:
    """Rotate points about the origin.

    Book: (2.14)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    p : (..., 3)

    Returns
    -------
    Rp : (..., 3)
    """
    R = checks.array("so3.act", "R", R, (3, 3), check=False)
    p = checks.array("so3.act", "p", p, (3,), check=False)
    checks.broadcast("so3.act", R=(R, 2), p=(p, 1))
    return np.einsum("...ij,...j->...i", R, p)


def adjoint(R: ArrayLike) -> NDArray[np.float64]:
    """Return the matrix of Ad_R in coordinates, R hat(x) R^T = hat(Ad_R x): R itself.

    Book: (4.11)

    Parameters
    ----------
    R : (..., 3, 3), rotation

    Returns
    -------
    Ad : (..., 3, 3)
    """
    return checks.array("so3.adjoint", "R", R, (3, 3), check=False).copy()


def _second_order(
    x: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> NDArray[np.float64]:
    X = hat(x)
    return np.eye(3) + a[..., None, None] * X + b[..., None, None] * (X @ X)


def left_jacobian(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the matrix from the rate of x to the angular velocity of exp(x), in fixed axes.

    It is singular where |x| = 2 pi n, n >= 1, and it carries the translation part of se(3).

    Book: (7.5), (A.9), (A.10)

    Parameters
    ----------
    x : (..., 3), radians
    check : bool
        False skips the look for nan and infinity.

    Returns
    -------
    J : (..., 3, 3)

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("so3.left_jacobian", "x", x, (3,), check)
    theta = np.linalg.norm(x, axis=-1)
    return _second_order(x, series.versinc(theta), series.sine_defect(theta))


def left_jacobian_inverse(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the matrix from the angular velocity of exp(x), in fixed axes, to the rate of x.

    Book: (7.8), (A.11)

    Parameters
    ----------
    x : (..., 3), radians
        Not of length 2 pi n, n >= 1, where the left Jacobian is singular.
    check : bool
        False skips the look for nan, infinity and singular points.

    Returns
    -------
    J_inverse : (..., 3, 3)

    Raises
    ------
    ValueError
        If x is not finite, or of length 2 pi n up to rounding.
    """
    where = "so3.left_jacobian_inverse"
    x = checks.array(where, "x", x, (3,), check)
    theta = np.linalg.norm(x, axis=-1)
    if check:
        singular = series.at_pole(theta)
        if np.any(singular):
            index = checks.first(singular)
            checks.fail(where, "x", "not of length 2 pi n, n >= 1", f"length {theta[index]:.17g}", index)
    return _second_order(x, np.full_like(theta, -0.5), series.cotangent_defect(theta))


def from_axis_angle(u: ArrayLike, theta: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation about a unit vector by an angle.

    Book: (2.14), (2.15), (A.1), (A.2), (A.3), (A.4), (A.5), (A.7)

    Parameters
    ----------
    u : (..., 3), unit vector
    theta : (...), radians
    check : bool
        False skips the look for nan, infinity and vectors of another length.

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
    return exp(theta[..., None] * u, check=False)


def to_axis_angle(R: ArrayLike, *, check: bool = True) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the axis and the angle of a rotation; for the identity, the x-axis and 0.

    Book: (2.16), (2.19), (7.6), (7.7)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    check : bool
        False skips the look for nan, infinity and matrices that are not rotations.

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
    x = log(checks.rotation("so3.to_axis_angle", "R", R, 3, check), check=False)
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
    check : bool
        False skips the look for nan and infinity.

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
