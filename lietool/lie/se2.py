"""SE(2), the rigid transformations of the plane, and its Lie algebra se(2), coordinates in R^3: a twist.

A twist is (rotation, translation): an angle theta and two numbers l.  A rigid
transformation is a homogeneous matrix (2.6) of a rotation R and a translation d.
J is the quarter turn.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, kernels, series

Array = NDArray[np.float64]


def hat(x: ArrayLike) -> Array:
    """Return the matrix of a twist, the velocity field p -> theta J p + l.

    Book: (4.4), (4.22)

    Parameters
    ----------
    x : (..., 3)
        Angle, then translation.

    Returns
    -------
    X : (..., 3, 3)
    """
    x = checks.array("se2.hat", "x", x, (3,), check=False)
    X = np.zeros((*x.shape[:-1], 3, 3))
    X[..., 1, 0] = x[..., 0]
    X[..., 0, 1] = 0.0 - x[..., 0]
    X[..., :2, 2] = x[..., 1:]
    return X


def vee(X: ArrayLike) -> Array:
    """Return the twist of a matrix of se(2), the inverse of `hat`.

    Book: (4.4), (4.22)

    Parameters
    ----------
    X : (..., 3, 3)
        The part that is neither skew nor a translation is left out.

    Returns
    -------
    x : (..., 3)
        Angle, then translation.
    """
    X = checks.array("se2.vee", "X", X, (3, 3), check=False)
    return np.stack([0.5 * (X[..., 1, 0] - X[..., 0, 1]), X[..., 0, 2], X[..., 1, 2]], axis=-1)


def exp(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the motion of a twist: R = R_theta, d = V l, theta V = (sin theta) I + (1 - cos theta) J.

    Book: (2.5), (2.9), (4.4), (4.5)

    Parameters
    ----------
    x : (..., 3)
        Angle (radians, of any size), then translation.
    check : bool, False to trust the values

    Returns
    -------
    T : (..., 3, 3), rigid

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("se2.exp", "x", x, (3,), check)
    return blocks.run(kernels.plane_exp, (3, 3), (x, 1))


def log(T: ArrayLike, *, check: bool = True) -> Array:
    """Return the principal logarithm of a rigid transformation, with its angle in (-pi, pi].

    l = (theta/2) (cot(theta/2) d - J d), the plane's (7.8), without its 0/0 at pi.

    Book: (2.6), (4.4), (4.5)

    Parameters
    ----------
    T : (..., 3, 3), rigid
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 3)
        Angle (radians), then translation.

    Raises
    ------
    ValueError
        If T is not a rigid transformation.
    """
    T = checks.rigid("se2.log", "T", T, 2, check)
    return blocks.run(kernels.plane_log, (3,), (T, 2))


def inverse(T: ArrayLike) -> Array:
    """Return the inverse of a rigid transformation: R^T and -R^T d.

    Book: (2.6), (3.7)

    Parameters
    ----------
    T : (..., 3, 3), rigid

    Returns
    -------
    T_inverse : (..., 3, 3), rigid
    """
    T = checks.array("se2.inverse", "T", T, (3, 3), check=False)
    inverted = T.copy()
    inverted[..., :2, :2] = np.swapaxes(T[..., :2, :2], -1, -2)
    inverted[..., :2, 2] = 0.0 - np.einsum("...ji,...j->...i", T[..., :2, :2], T[..., :2, 2])
    return inverted


def act(T: ArrayLike, p: ArrayLike) -> Array:
    """Move points: R p + d.

    Book: (2.4), (2.5), (2.6)

    Parameters
    ----------
    T : (..., 3, 3), rigid
    p : (..., 2)

    Returns
    -------
    Tp : (..., 2)
    """
    T = checks.array("se2.act", "T", T, (3, 3), check=False)
    p = checks.array("se2.act", "p", p, (2,), check=False)
    checks.broadcast("se2.act", T=(T, 2), p=(p, 1))
    return np.einsum("...ij,...j->...i", T[..., :2, :2], p) + T[..., :2, 2]


def adjoint(T: ArrayLike) -> Array:
    """Return the matrix of Ad_T in coordinates, T hat(x) T^-1 = hat(Ad_T x): 1, 0; -J d, R.

    Book: (2.7), (2.8), (3.5), (4.11)

    Parameters
    ----------
    T : (..., 3, 3), rigid

    Returns
    -------
    Ad : (..., 3, 3)
    """
    T = checks.array("se2.adjoint", "T", T, (3, 3), check=False)
    Ad = np.zeros(T.shape)
    Ad[..., 0, 0] = 1.0
    Ad[..., 1, 0] = T[..., 1, 2]
    Ad[..., 2, 0] = 0.0 - T[..., 0, 2]
    Ad[..., 1:, 1:] = T[..., :2, :2]
    return Ad


def _jacobian(a: Array, b: Array, q: tuple[Array, Array]) -> Array:
    """Return the matrix of the blocks 1, 0; q, a I + b J."""
    J = np.zeros((*a.shape, 3, 3))
    J[..., 0, 0] = 1.0
    J[..., 1, 0], J[..., 2, 0] = q
    J[..., 1, 1] = J[..., 2, 2] = a
    J[..., 2, 1] = b
    J[..., 1, 2] = 0.0 - b
    return J


def left_jacobian(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix from the rate of x to the twist velocity of exp(x), in fixed axes.

    It is singular where the angle is 2 pi n, n not 0.

    Book: (4.8), (4.14)

    Parameters
    ----------
    x : (..., 3)
        Angle (radians), then translation.
    check : bool, False to trust the values

    Returns
    -------
    J : (..., 3, 3)

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("se2.left_jacobian", "x", x, (3,), check)
    theta, lx, ly = np.moveaxis(x, -1, 0)
    b, c = series.versinc(theta), theta * series.sine_defect(theta)
    return _jacobian(series.sinc(theta), theta * b, (c * lx + b * ly, c * ly - b * lx))


def left_jacobian_inverse(x: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix from the twist velocity of exp(x), in fixed axes, to the rate of x.

    Book: (4.8), (4.14)

    Parameters
    ----------
    x : (..., 3)
        Angle (radians) but not 2 pi n, n not 0, then translation.
    check : bool, False to trust the values

    Returns
    -------
    J_inverse : (..., 3, 3)

    Raises
    ------
    ValueError
        If x is not finite, or its angle 2 pi n up to rounding.
    """
    where = "se2.left_jacobian_inverse"
    x = checks.array(where, "x", x, (3,), check)
    theta, lx, ly = np.moveaxis(x, -1, 0)
    if check:
        singular = series.at_pole(theta)
        if np.any(singular):
            index = checks.first(singular)
            checks.fail(where, "x", "of an angle not 2 pi n, n not 0", f"{theta[index]:.17g}", index)
    h, c = 0.5 * theta, theta * series.cotangent_defect(theta)
    return _jacobian(np.cos(h) / series.sinc(h), -h, (c * lx - 0.5 * ly, c * ly + 0.5 * lx))
