"""SO(3), the rotations of space, and its Lie algebra so(3), coordinates in R^3: the axis times the angle."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, kernels, series
from lietool.lie.axis_angle import AXES as AXES
from lietool.lie.axis_angle import from_axis_angle as from_axis_angle
from lietool.lie.axis_angle import rotation as rotation
from lietool.lie.axis_angle import to_axis_angle as to_axis_angle


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


def exp(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation about x by the angle |x|.

    Book: (2.15), (4.7), (4.20), (7.3), (7.4), (A.6)
    Kaji-Ochiai: (4)

    Parameters
    ----------
    x : (..., 3), radians
        Axis times angle, of any length.
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("so3.exp", "x", x, (3,), check)
    return blocks.run(kernels.rotation_exp, (3, 3), (x, 1))


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
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 3), radians

    Raises
    ------
    ValueError
        If R is not a rotation.
    """
    R = checks.rotation("so3.log", "R", R, 3, check)
    return blocks.run(kernels.rotation_log, (3,), (R, 2))


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
    check : bool, False to trust the values

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
    # All (theta + 2 pi k) u lie on one line: the nearest is nearest to the foot of the reference on it.
    k = _round((np.sum(u * reference, axis=-1, keepdims=True) - theta) / (2.0 * np.pi))
    n = _round(length / (2.0 * np.pi))
    turned = principal + 2.0 * np.pi * np.where(identity, 0.0, k) * u
    around = 2.0 * np.pi * n * reference / np.where(length > 0.0, length, 1.0)
    x = np.where(identity & (n > 0.0), around, turned)
    return x, np.linalg.norm(x - reference, axis=-1)


def log_along(R: ArrayLike, start: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return a logarithm along a path of rotations, each the nearest to the one before.

    It is continuous as long as the path does not pass I on a sphere |x| = 2 n pi, n >= 1.

    Book: 4.6

    Parameters
    ----------
    R : (..., n, 3, 3), rotation
        The path, in steps well below a half turn.
    start : (..., 3), radians
        What the first logarithm is to be nearest to.
    check : bool, False to trust the values

    Returns
    -------
    x : (..., n, 3), radians

    Raises
    ------
    ValueError
        If R holds a matrix that is not a rotation, or start is not finite.
    """
    R = checks.rotation("so3.log_along", "R", R, 3, check)
    reference = checks.array("so3.log_along", "start", start, (3,), check)
    x = np.empty((*np.broadcast_shapes(R.shape[:-3], reference.shape[:-1]), R.shape[-3], 3))
    for i in range(R.shape[-3]):
        reference, _ = log_near(R[..., i, :, :], reference, check=False)
        x[..., i, :] = reference
    return x


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


def left_jacobian(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the matrix from the rate of x to the angular velocity of exp(x), in fixed axes.

    The text knows it as Y of (A.9), which carries the translation part of se(3);
    not the symmetric Y of (7.1).  It is singular where |x| = 2 pi n, n >= 1.

    Book: (7.5), (A.9), (A.10)

    Parameters
    ----------
    x : (..., 3), radians
    check : bool, False to trust the values

    Returns
    -------
    J : (..., 3, 3)

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("so3.left_jacobian", "x", x, (3,), check)
    return blocks.run(kernels.left_jacobian, (3, 3), (x, 1))


def left_jacobian_inverse(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the matrix from the angular velocity of exp(x), in fixed axes, to the rate of x.

    Book: (7.8), (A.11)

    Parameters
    ----------
    x : (..., 3), radians
        Not of length 2 pi n, n >= 1, where the left Jacobian is singular.
    check : bool, False to trust the values

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
    if check:
        theta = np.linalg.norm(x, axis=-1)
        singular = series.at_pole(theta)
        if np.any(singular):
            index = checks.first(singular)
            checks.fail(where, "x", "not of length 2 pi n, n >= 1", f"length {theta[index]:.17g}", index)
    return blocks.run(kernels.left_jacobian_inverse, (3, 3), (x, 1))
