"""Anti-commutative dual complex numbers p0 + p1 eps, written (re p0, im p0, re p1, im p1), for SE(2).

The product (2.38) is that of the dual quaternions p0 + p1 j eps.  A unit one,
|p0| = 1, moves the plane by v -> p0^2 v + 2 p0 p1; p and -p are the same
motion.  The Lie algebra is i R + C eps, written (theta, re b, im b), and
exp(x) moves the plane by the twist 2 x, as with quaternions.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, dual_complex_kernels
from lietool.lie.dual_checks import invertible, refuse_opposite
from lietool.lie.dual_checks import unit_complex as unit
from lietool.lie.dual_complex_blend import align as align
from lietool.lie.dual_complex_blend import dlb as dlb
from lietool.lie.dual_complex_blend import sclerp as sclerp

Array = NDArray[np.float64]


def multiply(p: ArrayLike, q: ArrayLike) -> Array:
    """Multiply two dual complex numbers: (p0 + p1 eps)(q0 + q1 eps) = p0 q0 + (p1 conj(q0) + p0 q1) eps.

    Book: (2.38), (2.41)

    Parameters
    ----------
    p : (..., 4)
    q : (..., 4)

    Returns
    -------
    pq : (..., 4)
    """
    where = "dual_complex.multiply"
    a, b = (checks.array(where, name, x, (4,), check=False) for name, x in (("p", p), ("q", q)))
    checks.broadcast(where, p=(a, 1), q=(b, 1))
    return blocks.run(dual_complex_kernels.product, (4,), (a, 1), (b, 1))


def conjugate(p: ArrayLike) -> Array:
    """Return conj(p0) + p1 eps, which the embedding takes to q_bar*, not to the inverse.

    Book: (2.39)

    Parameters
    ----------
    p : (..., 4)

    Returns
    -------
    p_bar : (..., 4)
    """
    return checks.array("dual_complex.conjugate", "p", p, (4,), check=False) * np.array([1.0, -1.0, 1.0, 1.0])


def norm(p: ArrayLike) -> Array:
    """Return the absolute value |p0|, which is multiplicative.

    Book: (2.40)

    Parameters
    ----------
    p : (..., 4)

    Returns
    -------
    length : (...)
    """
    p = checks.array("dual_complex.norm", "p", p, (4,), check=False)
    return np.hypot(p[..., 0], p[..., 1])


def normalize(p: ArrayLike, *, check: bool = True) -> Array:
    """Return p / |p|.

    Book: (2.40)

    Parameters
    ----------
    p : (..., 4), non-zero
        With a p0 that is not 0.
    check : bool, False to trust the values

    Returns
    -------
    unit : (..., 4), unit dual complex number

    Raises
    ------
    ValueError
        If p0 is zero or p is not finite.
    """
    p = invertible("dual_complex.normalize", "p", p, check, real=2)
    return p / norm(p)[..., None]


def inverse(p: ArrayLike, *, check: bool = True) -> Array:
    """Return the inverse, (conj(p0) - p1 eps) / |p0|^2.

    Book: 2.10

    Parameters
    ----------
    p : (..., 4), non-zero
        With a p0 that is not 0.
    check : bool, False to trust the values

    Returns
    -------
    p_inverse : (..., 4)

    Raises
    ------
    ValueError
        If p0 is zero or p is not finite.
    """
    p = invertible("dual_complex.inverse", "p", p, check, real=2)
    return p * np.array([1.0, -1.0, -1.0, -1.0]) / (p[..., :1] ** 2 + p[..., 1:2] ** 2)


def exp(x: ArrayLike, *, check: bool = True) -> Array:
    """Return exp(i theta + b eps) = exp(i theta) + (sin theta / theta) b eps: it turns the plane by 2 theta.

    Book: (4.1) in the dual complex numbers, 2.10

    Parameters
    ----------
    x : (..., 3), radians
        theta, then b.
    check : bool, False to trust the values

    Returns
    -------
    p : (..., 4), unit dual complex number

    Raises
    ------
    ValueError
        If x is not finite.
    """
    return blocks.run(
        dual_complex_kernels.exp, (4,), (checks.array("dual_complex.exp", "x", x, (3,), check), 1)
    )


def log(p: ArrayLike, *, check: bool = True) -> Array:
    """Return the principal logarithm (theta, b) of a unit dual complex number, -pi < theta <= pi.

    Of p and -p one at least has a logarithm: -1 + p1 eps, which translates,
    is no exponential unless p1 = 0.

    Book: 2.10

    Parameters
    ----------
    p : (..., 4), unit dual complex number
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 3), radians

    Raises
    ------
    ValueError
        If p is not a unit dual complex number, or p0 = -1 and p1 is not 0.
    """
    p = unit("dual_complex.log", "p", p, check)
    if check:
        refuse_opposite("dual_complex.log", "p", p, "an exponential: -1 + p1 eps is none")
    return blocks.run(dual_complex_kernels.log, (3,), (p, 1))


def act(p: ArrayLike, v: ArrayLike, *, check: bool = True) -> Array:
    """Move points of the plane: v -> p0^2 v + 2 p0 p1, by p (1 + v eps) p_bar.

    Book: 2.10, (2.35)

    Parameters
    ----------
    p : (..., 4), unit dual complex number
    v : (..., 2)
    check : bool, False to trust the values

    Returns
    -------
    moved : (..., 2)

    Raises
    ------
    ValueError
        If p is not a unit dual complex number.
    """
    p = unit("dual_complex.act", "p", p, check)
    v = checks.array("dual_complex.act", "v", v, (2,), check=False)
    checks.broadcast("dual_complex.act", p=(p, 1), v=(v, 1))
    return blocks.run(dual_complex_kernels.act, (2,), (p, 1), (v, 1))


def to_matrix(p: ArrayLike, *, check: bool = True) -> Array:
    """Return the homogeneous matrix of a unit dual complex number; -p gives the same.

    Book: 2.10, (2.43)

    Parameters
    ----------
    p : (..., 4), unit dual complex number
    check : bool, False to trust the values

    Returns
    -------
    A : (..., 3, 3), rigid

    Raises
    ------
    ValueError
        If p is not a unit dual complex number.
    """
    p = unit("dual_complex.to_matrix", "p", p, check)
    return blocks.run(dual_complex_kernels.matrix, (3, 3), (p, 1))


def from_matrix(A: ArrayLike, *, check: bool = True) -> Array:
    """Return the unit dual complex number of a rigid transformation of the plane, the one with re p0 >= 0.

    At a half turn p0 = i.

    Book: 2.10, (2.43)

    Parameters
    ----------
    A : (..., 3, 3), rigid
    check : bool, False to trust the values

    Returns
    -------
    p : (..., 4), unit dual complex number

    Raises
    ------
    ValueError
        If A is not a rigid transformation.
    """
    A = checks.rigid("dual_complex.from_matrix", "A", A, 2, check)
    return blocks.run(dual_complex_kernels.from_matrix, (4,), (A, 2))


def to_complex_matrix(p: ArrayLike, *, check: bool = True) -> NDArray[np.complex128]:
    """Return the complex matrix (alpha beta; 0 1) of v -> alpha v + beta, alpha = p0^2, beta = 2 p0 p1.

    Book: (2.35), (2.36)

    Parameters
    ----------
    p : (..., 4), unit dual complex number
    check : bool, False to trust the values

    Returns
    -------
    M : (..., 2, 2)

    Raises
    ------
    ValueError
        If p is not a unit dual complex number.
    """
    p = unit("dual_complex.to_complex_matrix", "p", p, check)
    place = blocks.run(dual_complex_kernels.place, (4,), (p, 1))
    M = np.zeros((*p.shape[:-1], 2, 2), dtype=np.complex128)
    M[..., 0, :] = place.view(np.complex128)
    M[..., 1, 1] = 1.0
    return M


def to_dual_quaternion(p: ArrayLike) -> Array:
    """Embed into the dual quaternions, p0 + p1 eps -> p0 + p1 j eps: the plane as that of y and z.

    It keeps products and norms, takes the conjugate to q_bar*, and a point v
    of the plane to (0, re v, im v).

    Book: 2.10

    Parameters
    ----------
    p : (..., 4)

    Returns
    -------
    q : (..., 8)
    """
    p = checks.array("dual_complex.to_dual_quaternion", "p", p, (4,), check=False)
    q = np.zeros((*p.shape[:-1], 8))
    q[..., :2], q[..., 6:] = p[..., :2], p[..., 2:]
    return q
