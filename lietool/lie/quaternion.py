"""Quaternions (w, x, y, z), Hamilton's product; imaginary ones are vectors of R^3, unit ones rotate it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, kernels
from lietool.lie.quaternion_complex import from_complex_matrix as from_complex_matrix
from lietool.lie.quaternion_complex import to_complex_matrix as to_complex_matrix
from lietool.lie.slerp import nlerp as nlerp
from lietool.lie.slerp import slerp as slerp

Array = NDArray[np.float64]


def _pair(where: str, q: ArrayLike, p: ArrayLike) -> tuple[Array, Array]:
    a, b = (checks.array(where, name, x, (4,), check=False) for name, x in (("q", q), ("p", p)))
    checks.broadcast(where, q=(a, 1), p=(b, 1))
    return a, b


def multiply(q: ArrayLike, p: ArrayLike) -> Array:
    """Multiply two quaternions: i j = k.

    Book: (2.24), (2.29)

    Parameters
    ----------
    q : (..., 4)
    p : (..., 4)

    Returns
    -------
    qp : (..., 4)
    """
    a, b = _pair("quaternion.multiply", q, p)
    return blocks.run(kernels.product, (4,), (a, 1), (b, 1))


def left_matrix(q: ArrayLike) -> Array:
    """Return the matrix L with L p = q p.

    Book: (2.24)

    Parameters
    ----------
    q : (..., 4)

    Returns
    -------
    L : (..., 4, 4)
    """
    a, b, c, d = np.moveaxis(checks.array("quaternion.left_matrix", "q", q, (4,), check=False), -1, 0)
    L = np.stack([a, -b, -c, -d, b, a, -d, c, c, d, a, -b, d, -c, b, a], axis=-1)
    return L.reshape(*L.shape[:-1], 4, 4)


def conjugate(q: ArrayLike) -> Array:
    """Change the sign of the imaginary part.

    Book: (2.25)

    Parameters
    ----------
    q : (..., 4)

    Returns
    -------
    q_bar : (..., 4)
    """
    return checks.array("quaternion.conjugate", "q", q, (4,), check=False) * np.array([1.0, -1.0, -1.0, -1.0])


def dot(q: ArrayLike, p: ArrayLike) -> Array:
    """Return the inner product of R^4, the real part of p q^-1 for unit quaternions.

    Book: (2.32) for its cosine

    Parameters
    ----------
    q : (..., 4)
    p : (..., 4)

    Returns
    -------
    product : (...)
    """
    a, b = _pair("quaternion.dot", q, p)
    return np.einsum("...i,...i->...", a, b)


def norm(q: ArrayLike) -> Array:
    """Return the absolute value |q|.

    Book: (2.25)

    Parameters
    ----------
    q : (..., 4)

    Returns
    -------
    length : (...)
    """
    q = checks.array("quaternion.norm", "q", q, (4,), check=False)
    # Scaled by its largest entry first, so that squares neither overflow nor vanish.
    size = np.max(np.abs(q), axis=-1, keepdims=True)
    scaled = q / np.where(size > 0.0, size, 1.0)
    return np.sqrt(np.einsum("...i,...i->...", scaled, scaled)) * size[..., 0]


def normalize(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the unit quaternion q / |q|.

    Book: (2.25)

    Parameters
    ----------
    q : (..., 4), non-zero
    check : bool, False to trust the values

    Returns
    -------
    unit : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If q is zero or not finite.
    """
    q = checks.nonzero("quaternion.normalize", "q", q, 4, check)
    return q / norm(q)[..., None]


def inverse(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the inverse, the conjugate by the squared norm.

    Book: (2.25)

    Parameters
    ----------
    q : (..., 4), non-zero
    check : bool, False to trust the values

    Returns
    -------
    q_inverse : (..., 4)

    Raises
    ------
    ValueError
        If q is zero or not finite.
    """
    q = checks.nonzero("quaternion.inverse", "q", q, 4, check)
    return conjugate(q) / np.einsum("...i,...i->...", q, q)[..., None]


def exp(x: ArrayLike, *, check: bool = True) -> Array:
    """Return exp(theta u) = cos(theta) + sin(theta) u, with no half angle: it turns space by 2 theta.

    Book: (2.31)

    Parameters
    ----------
    x : (..., 3), radians
        The imaginary quaternion theta u.
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If x is not finite.
    """
    return blocks.run(kernels.quaternion_exp, (4,), (checks.array("quaternion.exp", "x", x, (3,), check), 1))


def log(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the principal logarithm theta u of a unit quaternion, 0 <= theta <= pi.

    At q = -1, where every unit u serves, it is (pi, 0, 0).

    Book: (2.31)

    Parameters
    ----------
    q : (..., 4), unit quaternion
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 3), radians

    Raises
    ------
    ValueError
        If q is not a unit quaternion.
    """
    return blocks.run(kernels.quaternion_log, (3,), (checks.unit("quaternion.log", "q", q, 4, check), 1))


def act(q: ArrayLike, p: ArrayLike, *, check: bool = True) -> Array:
    """Turn points by p -> q p q^-1.

    Book: (2.27), (2.28)

    Parameters
    ----------
    q : (..., 4), non-zero
    p : (..., 3)
    check : bool, False to trust the values

    Returns
    -------
    turned : (..., 3)

    Raises
    ------
    ValueError
        If q is zero or not finite.
    """
    q = checks.nonzero("quaternion.act", "q", q, 4, check)
    p = checks.array("quaternion.act", "p", p, (3,), check=False)
    checks.broadcast("quaternion.act", q=(q, 1), p=(p, 1))
    return np.einsum("...ij,...j->...i", to_matrix(q, check=False), p)


def to_matrix(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix of p -> q p q^-1; q and every multiple of it give the same.

    Book: (2.28), (2.29), (2.30)

    Parameters
    ----------
    q : (..., 4), non-zero
    check : bool, False to trust the values

    Returns
    -------
    R : (..., 3, 3), rotation

    Raises
    ------
    ValueError
        If q is zero or not finite.
    """
    return blocks.run(kernels.matrix, (3, 3), (checks.nonzero("quaternion.to_matrix", "q", q, 4, check), 1))


def from_matrix(R: ArrayLike, *, check: bool = True) -> Array:
    """Return the unit quaternion of a rotation, the one of the two with w >= 0.

    At w = 0 the largest component is positive.

    Book: (2.29), (2.30)

    Parameters
    ----------
    R : (..., 3, 3), rotation
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If R is not a rotation.
    """
    R = checks.rotation("quaternion.from_matrix", "R", R, 3, check)
    return blocks.run(kernels.quaternion, (4,), (R, 2))


def from_axis_angle(u: ArrayLike, theta: ArrayLike, *, check: bool = True) -> Array:
    """Return the unit quaternion cos(theta/2) + sin(theta/2) u that turns space by theta about u.

    Book: (2.26)

    Parameters
    ----------
    u : (..., 3), unit vector
    theta : (...), radians
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4), unit quaternion

    Raises
    ------
    ValueError
        If u is not a unit vector or theta is not finite.
    """
    u = checks.unit("quaternion.from_axis_angle", "u", u, 3, check)
    theta = checks.array("quaternion.from_axis_angle", "theta", theta, (), check)
    checks.broadcast("quaternion.from_axis_angle", u=(u, 1), theta=(theta, 0))
    return exp(0.5 * theta[..., None] * u, check=False)
