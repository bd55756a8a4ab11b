"""Homogeneous coordinates, projective maps, and the affine ones among them.

Reached from `generic` too.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]


def homogeneous(x: ArrayLike) -> Array:
    """Return the homogeneous coordinates [x_1 : ... : x_n : 1] of a point.

    Book: (2.4), (2.45)

    Parameters
    ----------
    x : (..., n)

    Returns
    -------
    z : (..., m)
        One more.
    """
    x = checks.vector("projective.homogeneous", "x", x, False)
    return np.concatenate([x, np.ones((*x.shape[:-1], 1))], axis=-1)


def inhomogeneous(z: ArrayLike, *, check: bool = True) -> Array:
    """Return the point with homogeneous coordinates z, the same for every multiple of z.

    Book: (2.44)

    Parameters
    ----------
    z : (..., m)
    check : bool, False to return inf or nan for points at infinity

    Returns
    -------
    x : (..., n)
        One less.

    Raises
    ------
    ValueError
        If z is not finite, or its last coordinate 0: a point at infinity.
    """
    z = checks.vector("projective.inhomogeneous", "z", z, check)
    return _divide("projective.inhomogeneous", "z", z, check)


def _divide(where: str, name: str, z: Array, check: bool) -> Array:
    last = z[..., -1:]
    if check and np.any(last == 0.0):
        got = "a point at infinity, last coordinate 0"
        checks.fail(where, name, "a finite point", got, checks.first(last[..., 0] == 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return z[..., :-1] / last


def transform(P: ArrayLike, x: ArrayLike, *, check: bool = True) -> Array:
    """Apply a projective map to points; every multiple of P is the same map.

    Book: (2.44), (2.45)

    Parameters
    ----------
    P : (..., m, m)
    x : (..., n)
        n = m - 1.
    check : bool, False to return inf or nan for points sent to infinity

    Returns
    -------
    Px : (..., n)

    Raises
    ------
    ValueError
        If P or x is not finite, or a point is sent to infinity.
    """
    where = "projective.transform"
    P = checks.square(where, "P", P, check)
    x = checks.array(where, "x", x, (P.shape[-1] - 1,), check)
    checks.broadcast(where, P=(P, 2), x=(x, 1))
    return _divide(where, "x", (P @ homogeneous(x)[..., None])[..., 0], check)


def affine(P: ArrayLike, *, check: bool = True) -> Array:
    """Return the multiple of a projective map with the last row 0 ... 0 1: an affine map of R^n.

    Book: (2.44), (2.45), (3.2)

    Parameters
    ----------
    P : (..., m, m), affine multiple
        A projective map that sends no point of R^n to infinity: 0 ... 0 a in the last row, a not 0.
    check : bool, False to trust the values

    Returns
    -------
    A : (..., m, m), affine

    Raises
    ------
    ValueError
        If P is not finite, or does not map R^n to itself.
    """
    P = checks.square("projective.affine", "P", P, check)
    last = P[..., -1, :]
    if check and P.size:
        size = np.max(np.abs(P), axis=(-1, -2))
        off = np.max(np.abs(last[..., :-1]), axis=-1, initial=0.0) > checks.TOLERANCE * size
        if np.any(off | (last[..., -1] == 0.0)):
            index = checks.first(off | (last[..., -1] == 0.0))
            row = " ".join(f"{entry:.3g}" for entry in last[index])
            must = "a map of R^n to itself, last row 0 ... 0 and a number that is not 0"
            checks.fail("projective.affine", "P", must, f"last row {row}", index)
    with np.errstate(divide="ignore", invalid="ignore"):
        A = P / last[..., -1, None, None]
    A[..., -1, :] = np.eye(P.shape[-1])[-1]
    return A


def embed(A: ArrayLike, d: ArrayLike, *, check: bool = True) -> Array:
    """Return the homogeneous matrix of x -> A x + d: GL(n) x R^n in GL(n + 1), the product a semi-direct one.

    With d = 0 it is iota, the natural embedding of (7.1).

    Book: (2.5), (2.42), (3.2), (3.4), (3.6), (3.9), (3.10), (7.1)

    Parameters
    ----------
    A : (..., n, n)
    d : (..., n)
    check : bool, False to trust the values

    Returns
    -------
    M : (..., m, m), affine
        m = n + 1.

    Raises
    ------
    ValueError
        If A is not square, or A or d is not finite.
    """
    where = "projective.embed"
    A = checks.square(where, "A", A, check)
    n = A.shape[-1]
    d = checks.array(where, "d", d, (n,), check)
    checks.broadcast(where, A=(A, 2), d=(d, 1))
    M = np.zeros((*np.broadcast_shapes(A.shape[:-2], d.shape[:-1]), n + 1, n + 1))
    M[..., :n, :n] = A
    M[..., :n, n] = d
    M[..., n, n] = 1.0
    return M


def parts(M: ArrayLike) -> tuple[Array, Array]:
    """Return the linear part and the translation of a homogeneous matrix, the inverse of `embed`.

    Book: (3.2), (3.6), (4.23)

    Parameters
    ----------
    M : (..., m, m), affine

    Returns
    -------
    A : (..., n, n)
    d : (..., n)
    """
    M = checks.square("projective.parts", "M", M, False)
    return M[..., :-1, :-1].copy(), M[..., :-1, -1].copy()
