"""Dual quaternions z + w eps, eps^2 = 0: (..., 8), the quaternion z and then w; unit ones move space rigidly.

They are the matrices (z w; 0 z) of quaternions.  A unit dual quaternion has
|z| = 1 and <z, w> = 0, (4.16); its Lie algebra is Im H + eps Im H, written as
(..., 6).  As with quaternions there is no half angle in `exp`: exp(x) moves
space by the twist 2 x, and 1 + w eps translates by 2 w, not by w as section
2.8 says.  q and -q are the same motion.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, dual_kernels, quaternion
from lietool.lie.dual_blend import align as align
from lietool.lie.dual_blend import dlb as dlb
from lietool.lie.dual_blend import sclerp as sclerp
from lietool.lie.dual_checks import invertible, unit
from lietool.lie.screw import from_rotation_translation as from_rotation_translation
from lietool.lie.screw import from_screw as from_screw
from lietool.lie.screw import to_rotation_translation as to_rotation_translation
from lietool.lie.screw import to_screw as to_screw

Array = NDArray[np.float64]

_STAR = np.repeat([1.0, -1.0], 4)
_BAR = np.tile([1.0, -1.0, -1.0, -1.0], 2)


def multiply(q: ArrayLike, p: ArrayLike) -> Array:
    """Multiply two dual quaternions.

    Book: 2.8, (4.15)

    Parameters
    ----------
    q : (..., 8)
    p : (..., 8)

    Returns
    -------
    qp : (..., 8)
    """
    where = "dual_quaternion.multiply"
    a, b = (checks.array(where, name, x, (8,), check=False) for name, x in (("q", q), ("p", p)))
    checks.broadcast(where, q=(a, 1), p=(b, 1))
    return blocks.run(dual_kernels.product, (8,), (a, 1), (b, 1))


def left_matrix(q: ArrayLike) -> Array:
    """Return the matrix (Z 0; W Z) with L p = q p, Z and W the `quaternion.left_matrix` of z and w.

    Book: 2.8 (ii)

    Parameters
    ----------
    q : (..., 8)

    Returns
    -------
    L : (..., 8, 8)
    """
    q = checks.array("dual_quaternion.left_matrix", "q", q, (8,), check=False)
    L = np.zeros((*q.shape, 8))
    L[..., :4, :4] = L[..., 4:, 4:] = quaternion.left_matrix(q[..., :4])
    L[..., 4:, :4] = quaternion.left_matrix(q[..., 4:])
    return L


def conjugate(q: ArrayLike) -> Array:
    """Return the conjugate of both quaternions: the inverse of a unit dual quaternion.

    Book: 2.8

    Parameters
    ----------
    q : (..., 8)

    Returns
    -------
    q_bar : (..., 8)
    """
    return checks.array("dual_quaternion.conjugate", "q", q, (8,), check=False) * _BAR


def star(q: ArrayLike) -> Array:
    """Return the involution q* = z - w eps.

    Book: 2.8

    Parameters
    ----------
    q : (..., 8)

    Returns
    -------
    q_star : (..., 8)
    """
    return checks.array("dual_quaternion.star", "q", q, (8,), check=False) * _STAR


def norm(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the norm, the dual number |z| + <z, w>/|z| eps whose square is q times its conjugate.

    Book: 2.8

    Parameters
    ----------
    q : (..., 8), non-zero
        With a real part z that is not 0.
    check : bool, False to trust the values

    Returns
    -------
    length : (..., 2)

    Raises
    ------
    ValueError
        If the real part is zero or q is not finite.
    """
    q = invertible("dual_quaternion.norm", "q", q, check)
    length = quaternion.norm(q[..., :4])
    along = np.einsum("...i,...i->...", q[..., :4] / length[..., None], q[..., 4:])
    return np.stack([length, along], axis=-1)


def normalize(q: ArrayLike, *, check: bool = True) -> Array:
    """Return q by its norm: the nearest motion, z to length 1 and w without its part along z.

    Book: 2.8, (4.16)

    Parameters
    ----------
    q : (..., 8), non-zero
        With a real part z that is not 0.
    check : bool, False to trust the values

    Returns
    -------
    unit : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If the real part is zero or q is not finite.
    """
    q = invertible("dual_quaternion.normalize", "q", q, check)
    # By the length first, so that no square overflows or vanishes; the kernel does the rest.
    q = q / quaternion.norm(q[..., :4])[..., None]
    return blocks.run(dual_kernels.normalized, (8,), (q, 1))


def inverse(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the inverse z^-1 - z^-1 w z^-1 eps.

    Book: 2.8, (4.15)

    Parameters
    ----------
    q : (..., 8), non-zero
        With a real part z that is not 0.
    check : bool, False to trust the values

    Returns
    -------
    q_inverse : (..., 8)

    Raises
    ------
    ValueError
        If the real part is zero or q is not finite.
    """
    q = invertible("dual_quaternion.inverse", "q", q, check)
    z = quaternion.inverse(q[..., :4], check=False)
    w = quaternion.multiply(quaternion.multiply(z, q[..., 4:]), z)
    return np.concatenate([z, -w], axis=-1)


def exp(x: ArrayLike, *, check: bool = True) -> Array:
    """Return exp(a + b eps), with no half: it moves space by the twist (2 a, 2 b).

    Book: (2.31) with dual numbers, 2.8, 4.3 (xiii)

    Parameters
    ----------
    x : (..., 6), radians
        The imaginary quaternions a, then b.
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If x is not finite.
    """
    return blocks.run(dual_kernels.exp, (8,), (checks.array("dual_quaternion.exp", "x", x, (6,), check), 1))


def log(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the principal logarithm a + b eps of a unit dual quaternion, |a| <= pi.

    Every unit dual quaternion has one.  At z = -1 the axis is that of w, and x
    where w = 0; beside it the axis of the screw lies far away and b is large.

    Book: (2.31) with dual numbers, 2.8

    Parameters
    ----------
    q : (..., 8), unit dual quaternion
    check : bool, False to trust the values

    Returns
    -------
    x : (..., 6), radians

    Raises
    ------
    ValueError
        If q is not a unit dual quaternion.
    """
    return blocks.run(dual_kernels.log, (6,), (unit("dual_quaternion.log", "q", q, check), 1))


def act(q: ArrayLike, p: ArrayLike, *, check: bool = True) -> Array:
    """Move points: 1 + p eps -> q (1 + p eps) q_bar*.

    Book: 2.8

    Parameters
    ----------
    q : (..., 8), unit dual quaternion
    p : (..., 3)
    check : bool, False to trust the values

    Returns
    -------
    moved : (..., 3)

    Raises
    ------
    ValueError
        If q is not a unit dual quaternion.
    """
    q = unit("dual_quaternion.act", "q", q, check)
    p = checks.array("dual_quaternion.act", "p", p, (3,), check=False)
    checks.broadcast("dual_quaternion.act", q=(q, 1), p=(p, 1))
    return blocks.run(dual_kernels.act, (3,), (q, 1), (p, 1))


def to_matrix(q: ArrayLike, *, check: bool = True) -> Array:
    """Return the homogeneous matrix of a unit dual quaternion; -q gives the same.

    Book: 2.8, (2.43)

    Parameters
    ----------
    q : (..., 8), unit dual quaternion
    check : bool, False to trust the values

    Returns
    -------
    A : (..., 4, 4), rigid

    Raises
    ------
    ValueError
        If q is not a unit dual quaternion.
    """
    return blocks.run(dual_kernels.matrix, (4, 4), (unit("dual_quaternion.to_matrix", "q", q, check), 1))


def from_matrix(A: ArrayLike, *, check: bool = True) -> Array:
    """Return the unit dual quaternion of a rigid transformation, the one of the two with w >= 0 in z.

    Book: 2.8, (2.43)

    Parameters
    ----------
    A : (..., 4, 4), rigid
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If A is not a rigid transformation.
    """
    A = checks.rigid("dual_quaternion.from_matrix", "A", A, 3, check)
    return blocks.run(dual_kernels.from_matrix, (8,), (A, 2))
