"""SO(2), the rotations of the plane, and its Lie algebra so(2), coordinates in R: the angle.

The group is commutative, so the adjoint and both Jacobians are the number 1.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks


def hat(x: ArrayLike) -> NDArray[np.float64]:
    """Return the skew-symmetric matrix of an angle.

    Book: (4.4)

    Parameters
    ----------
    x : (...), radians

    Returns
    -------
    X : (..., 2, 2), skew
    """
    x = checks.array("so2.hat", "x", x, (), check=False)
    X = np.zeros((*x.shape, 2, 2))
    X[..., 1, 0] = x
    X[..., 0, 1] = 0.0 - x
    return X


def vee(X: ArrayLike) -> NDArray[np.float64]:
    """Return the angle of a skew-symmetric matrix, the inverse of `hat`.

    Book: (4.4)

    Parameters
    ----------
    X : (..., 2, 2), skew

    Returns
    -------
    x : (...), radians
    """
    X = checks.array("so2.vee", "X", X, (2, 2), check=False)
    return 0.5 * (X[..., 1, 0] - X[..., 0, 1])


def exp(x: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation by an angle.

    Book: (2.1), (2.2), (4.4)

    Parameters
    ----------
    x : (...), radians
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 2, 2), rotation

    Raises
    ------
    ValueError
        If x is not finite.
    """
    x = checks.array("so2.exp", "x", x, (), check)
    c, s = np.cos(x), np.sin(x)
    return np.stack([c, 0.0 - s, s, c], axis=-1).reshape(*x.shape, 2, 2)


def log(R: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the angle of a rotation, in (-pi, pi].

    Book: (2.1), (2.3)

    Parameters
    ----------
    R : (..., 2, 2), rotation
    check : bool, False to trust the values

    Returns
    -------
    x : (...), radians

    Raises
    ------
    ValueError
        If R is not a rotation.
    """
    R = checks.rotation("so2.log", "R", R, 2, check)
    # Adding 0.0 turns -0.0 into 0.0, so that the half turn is pi and never -pi.
    return np.arctan2(R[..., 1, 0] - R[..., 0, 1] + 0.0, R[..., 0, 0] + R[..., 1, 1])


def inverse(R: ArrayLike) -> NDArray[np.float64]:
    """Return the inverse of a rotation, its transpose.

    Book: (2.3)

    Parameters
    ----------
    R : (..., 2, 2), rotation

    Returns
    -------
    R_inverse : (..., 2, 2), rotation
    """
    R = checks.array("so2.inverse", "R", R, (2, 2), check=False)
    return np.swapaxes(R, -1, -2).copy()


def act(R: ArrayLike, p: ArrayLike) -> NDArray[np.float64]:
    """Rotate points about the origin.

    Book: (2.1)

    Parameters
    ----------
    R : (..., 2, 2), rotation
    p : (..., 2)

    Returns
    -------
    Rp : (..., 2)
    """
    R = checks.array("so2.act", "R", R, (2, 2), check=False)
    p = checks.array("so2.act", "p", p, (2,), check=False)
    checks.broadcast("so2.act", R=(R, 2), p=(p, 1))
    return np.einsum("...ij,...j->...i", R, p)


def adjoint(R: ArrayLike) -> NDArray[np.float64]:
    """Return the factor by which Ad_R multiplies the angle: 1, for SO(2) is commutative.

    Book: (2.3)

    Parameters
    ----------
    R : (..., 2, 2), rotation

    Returns
    -------
    Ad : (...)
    """
    return np.ones(checks.array("so2.adjoint", "R", R, (2, 2), check=False).shape[:-2])


def left_jacobian(x: ArrayLike) -> NDArray[np.float64]:
    """Return the factor from the rate of x to the angular velocity of exp(x): 1.

    Book: (4.8)

    Parameters
    ----------
    x : (...), radians

    Returns
    -------
    J : (...)
    """
    return np.ones(checks.array("so2.left_jacobian", "x", x, (), check=False).shape)


def left_jacobian_inverse(x: ArrayLike) -> NDArray[np.float64]:
    """Return the factor from the angular velocity of exp(x) to the rate of x: 1.

    Book: (4.8)

    Parameters
    ----------
    x : (...), radians

    Returns
    -------
    J_inverse : (...)
    """
    return np.ones(checks.array("so2.left_jacobian_inverse", "x", x, (), check=False).shape)
