"""SE(3), the rigid transformations of space, and its Lie algebra se(3), coordinates in R^6: a twist.

A twist is (rotation, translation): three numbers x, axis times angle, and
three numbers l.  A rigid transformation is a homogeneous matrix (2.43) of a
rotation R and a translation d.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, kernels, series, so3

Array = NDArray[np.float64]


def hat(x: ArrayLike) -> Array:
    """Return the matrix of a twist, the velocity field p -> x cross p + l.

    Book: (4.22), (A.8)
    MEIS: section 1

    Parameters
    ----------
    x : (..., 6)
        Rotation, then translation.

    Returns
    -------
    X : (..., 4, 4)
    """
    x = checks.array("se3.hat", "x", x, (6,), check=False)
    X = np.zeros((*x.shape[:-1], 4, 4))
    X[..., :3, :3] = so3.hat(x[..., :3])
    X[..., :3, 3] = x[..., 3:]
    return X


def vee(X: ArrayLike) -> Array:
    """Return the twist of a matrix of se(3), the inverse of `hat`.

    Book: (4.22), (A.8)

    Parameters
    ----------
    X : (..., 4, 4)
        The part that is neither skew nor a translation is left out.

    Returns
    -------
    x : (..., 6)
        Rotation, then translation.
    """
    X = checks.array("se3.vee", "X", X, (4, 4), check=False)
    return np.concatenate([so3.vee(X[..., :3, :3]), X[..., :3, 3]], axis=-1)


def exp(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the screw motion of a twist: R = exp(hat(x)), d = V l with the left Jacobian V of SO(3).

    Book: (2.43), (4.5), (7.3), (7.4), (7.5), (A.9), (A.10)
    MEIS: section 2, corrected: d is printed with R in the place of X

    Parameters
    ----------
    x : (..., 6)
        Rotation (radians, of any length), then translation.
    check : bool, False to trust the values

    Returns
    -------
    T : (..., 4, 4), rigid

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("se3.exp", "x", x, (6,), check)
    return blocks.run(kernels.rigid_exp, (4, 4), (x, 1))


def log(T: ArrayLike, *, check: bool = True) -> Array:
    """Return the principal logarithm of a rigid transformation, of a rotation by at most pi.

    (7.8) divides 0 by 0 at pi; l = d - x cross d / 2 + c x cross (x cross d)
    does not, where c is `series.cotangent_defect`, which is (7.8)'s last
    coefficient, (2 sin t - (1 + cos t) t) / (2 t^2 sin t), freed of a common factor.
    At a half turn the rotation is that of `so3.log`, one of two.

    Book: (7.6), (7.7), (7.8), (A.11)
    MEIS: section 2, corrected: the trace is that of the 3 x 3 part

    Parameters
    ----------
    T : (..., 4, 4), rigid
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 6)
        Rotation (radians), then translation.

    Raises
    ------
    ValueError
        If T is not a rigid transformation.
    """
    T = checks.rigid("se3.log", "T", T, 3, check)
    return blocks.run(kernels.rigid_log, (6,), (T, 2))


def log_near(T: ArrayLike, reference: ArrayLike, *, check: bool = True) -> tuple[Array, Array]:
    """Return the logarithm of a rigid transformation whose rotation is nearest to a reference's.

    The logarithms of a screw motion are (0, p) + (theta + 2 pi k) (u, m) for
    every whole k: u and m are the Pluecker coordinates of its axis, and p the
    translation along it.  Nearness is that of rotations, by `so3.log_near`:
    then the choice depends neither on the unit of length nor on the origin.
    A translation by d has those of full turns about an axis along d besides;
    in these, and in those of the identity, the part of l across the axis is
    free and taken from the reference.

    Book: (4.27), (4.28), (4.30)
    Kaji-Ochiai: Algorithm 1, corrected as in `so3.log_near`, with the translation

    Parameters
    ----------
    T : (..., 4, 4), rigid
    reference : (..., 6)
        Rotation (radians, of any length), then translation.
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 6)
        Rotation (radians), then translation, with exp(x) = T.
    distance : (...), radians
        Between the rotations of x and of the reference.

    Raises
    ------
    ValueError
        If T is not a rigid transformation or the reference is not finite.
    """
    T = checks.rigid("se3.log_near", "T", T, 3, check)
    reference = checks.array("se3.log_near", "reference", reference, (6,), check)
    checks.broadcast("se3.log_near", T=(T, 2), reference=(reference, 1))
    batch = np.broadcast_shapes(T.shape[:-2], reference.shape[:-1])
    T, reference = np.broadcast_to(T, (*batch, 4, 4)), np.broadcast_to(reference, (*batch, 6))
    d, x_near, l_near = T[..., :3, 3], reference[..., :3], reference[..., 3:]
    principal = log(T, check=False)
    x, ell = principal[..., :3], principal[..., 3:]
    u, theta = _direction(x)
    across, length = _direction(d)
    still = theta <= series.ROUNDED
    # A rounded product that should not move a point moves it in proportion to the reference's translation.
    moves = length > series.ROUNDED * np.linalg.norm(l_near, axis=-1, keepdims=True)
    along = across * np.sum(across * x_near, axis=-1, keepdims=True)
    turned, _ = so3.log_near(T[..., :3, :3], np.where(still & moves, along, x_near), check=False)
    # Away from the identity the line of all logarithms; m is the slope of l along it.
    turn = np.sum(u * (turned - x), axis=-1, keepdims=True)
    p = u * np.sum(u * d, axis=-1, keepdims=True)
    m = (ell - p) / np.where(still, 1.0, theta)
    v, angle = _direction(turned)
    free = l_near - v * np.sum(v * (l_near - d), axis=-1, keepdims=True)
    full = still & (angle > np.pi)
    ell = np.where(full, free, ell + np.where(still, 0.0, turn) * m)
    return np.concatenate([turned, ell], axis=-1), np.linalg.norm(turned - x_near, axis=-1)


def _direction(x: Array) -> tuple[Array, Array]:
    """Return a vector's direction, 0 for 0, and its length; both with the vector's axis kept."""
    size = np.max(np.abs(x), axis=-1, keepdims=True)
    y = x / np.where(size > 0.0, size, 1.0)
    norm = np.linalg.norm(y, axis=-1, keepdims=True)
    return y / np.where(norm > 0.0, norm, 1.0), size * norm


def inverse(T: ArrayLike) -> Array:
    """Return the inverse of a rigid transformation: R^T and -R^T d.

    Book: (2.43), (3.7)

    Parameters
    ----------
    T : (..., 4, 4), rigid

    Returns
    -------
    T_inverse : (..., 4, 4), rigid
    """
    T = checks.array("se3.inverse", "T", T, (4, 4), check=False)
    inverted = T.copy()
    inverted[..., :3, :3] = np.swapaxes(T[..., :3, :3], -1, -2)
    inverted[..., :3, 3] = 0.0 - np.einsum("...ji,...j->...i", T[..., :3, :3], T[..., :3, 3])
    return inverted


def act(T: ArrayLike, p: ArrayLike) -> Array:
    """Move points: R p + d.

    Book: (2.43)

    Parameters
    ----------
    T : (..., 4, 4), rigid
    p : (..., 3)

    Returns
    -------
    Tp : (..., 3)
    """
    T = checks.array("se3.act", "T", T, (4, 4), check=False)
    p = checks.array("se3.act", "p", p, (3,), check=False)
    checks.broadcast("se3.act", T=(T, 2), p=(p, 1))
    return np.einsum("...ij,...j->...i", T[..., :3, :3], p) + T[..., :3, 3]


def adjoint(T: ArrayLike) -> Array:
    """Return the matrix of Ad_T in coordinates, T hat(x) T^-1 = hat(Ad_T x): R, 0; hat(d) R, R.

    Book: (3.5), (4.11)

    Parameters
    ----------
    T : (..., 4, 4), rigid

    Returns
    -------
    Ad : (..., 6, 6)
    """
    T = checks.array("se3.adjoint", "T", T, (4, 4), check=False)
    R = T[..., :3, :3]
    Ad = np.zeros((*T.shape[:-2], 6, 6))
    Ad[..., :3, :3] = Ad[..., 3:, 3:] = R
    Ad[..., 3:, :3] = so3.hat(T[..., :3, 3]) @ R
    return Ad


def left_jacobian(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix from the rate of x to the twist velocity of exp(x), in fixed axes: V, 0; Q, V.

    V is that of SO(3), and Q its derivative along l.  It is singular where
    the rotation is of length 2 pi n, n >= 1.

    Book: (7.5), (A.10)

    Parameters
    ----------
    x : (..., 6)
        Rotation (radians), then translation.
    check : bool, False to trust the values

    Returns
    -------
    J : (..., 6, 6)

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("se3.left_jacobian", "x", x, (6,), check)
    return blocks.run(kernels.rigid_left_jacobian, (6, 6), (x, 1))


def left_jacobian_inverse(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix from the twist velocity of exp(x), in fixed axes, to the rate of x.

    Book: (7.8), (A.11)

    Parameters
    ----------
    x : (..., 6)
        Rotation (radians) not of length 2 pi n, n >= 1, then translation.
    check : bool, False to trust the values

    Returns
    -------
    J_inverse : (..., 6, 6)

    Raises
    ------
    ValueError
        If x is not finite, or its rotation of length 2 pi n up to rounding.
    """
    where = "se3.left_jacobian_inverse"
    x = checks.array(where, "x", x, (6,), check)
    if check:
        theta = np.linalg.norm(x[..., :3], axis=-1)
        singular = series.at_pole(theta)
        if np.any(singular):
            index = checks.first(singular)
            must = "of a rotation not of length 2 pi n, n >= 1"
            checks.fail(where, "x", must, f"length {theta[index]:.17g}", index)
    return blocks.run(kernels.rigid_left_jacobian_inverse, (6, 6), (x, 1))
