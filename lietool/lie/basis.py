"""Lie algebras of matrices by a basis X_1 ... X_k: bracket, coordinates, structure constants, the map ad.

Reached from `generic` too.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]

ORDERS = (1, 2, 3, 4)
"""Those of `bch`."""


def _turn(i: int, j: int) -> Array:
    """Return the generator of the rotations from axis i to axis j, which nobody can change."""
    J = np.zeros((3, 3))
    J[j, i], J[i, j] = 1.0, -1.0
    J.flags.writeable = False
    return J


J_X, J_Y, J_Z = _turn(1, 2), _turn(2, 0), _turn(0, 1)
"""The basis of so(3) of section 4.5: [J_x, J_y] = J_z and so on in a cycle."""


def bracket(A: ArrayLike, B: ArrayLike) -> Array:
    """Return the Lie bracket A B - B A, which is 0 where A and B commute.

    Book: 4.2, (4.10)

    Parameters
    ----------
    A : (..., n, n)
    B : (..., n, n)

    Returns
    -------
    AB_BA : (..., n, n)
    """
    A, B = (checks.square("basis.bracket", name, X, False) for name, X in (("A", A), ("B", B)))
    if A.shape[-1] != B.shape[-1]:
        checks.array("basis.bracket", "B", B, A.shape[-2:], False)
    checks.broadcast("basis.bracket", A=(A, 2), B=(B, 2))
    return A @ B - B @ A


def bch(X: ArrayLike, Y: ArrayLike, order: int = 4) -> Array:
    """Return log(exp(X) exp(Y)) by the Baker-Campbell-Hausdorff series up to brackets of an order.

    Of order 1 it is X + Y, and exact where X and Y commute, (4.10).  It
    converges if |X| + |Y| < log 2 in the spectral norm.

    Book: (4.9), (4.10)

    Parameters
    ----------
    X : (..., n, n)
    Y : (..., n, n)
    order : {ORDERS}

    Returns
    -------
    Z : (..., n, n)

    Raises
    ------
    ValueError
        If X or Y is not square, or the order another one.
    """
    if order not in ORDERS:
        checks.fail("basis.bch", "order", "one of 1, 2, 3, 4", repr(order), None)
    X, Y = (checks.square("basis.bch", name, A, False) for name, A in (("X", X), ("Y", Y)))
    Z = bracket(X, Y)
    XZ = bracket(X, Z)
    terms = (X + Y, Z / 2.0, (XZ - bracket(Y, Z)) / 12.0, bracket(Y, XZ) / -24.0)
    return np.sum(terms[:order], axis=0)


def combine(t: ArrayLike, basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix with coordinates t: t_1 X_1 + ... + t_k X_k.

    Book: 4.5, (4.22)

    Parameters
    ----------
    t : (..., k)
    basis : (..., k, n, n), basis
    check : bool, False to trust the values

    Returns
    -------
    X : (..., n, n)

    Raises
    ------
    ValueError
        If t or the basis is not finite.
    """
    basis = checks.square("basis.combine", "basis", basis, check, 1)
    t = checks.array("basis.combine", "t", t, basis.shape[-3:-2], check)
    checks.broadcast("basis.combine", t=(t, 1), basis=(basis, 3))
    return np.sum(t[..., None, None] * basis, axis=-3)


def _solve(where: str, name: str, X: Array, basis: Array, batch: int, check: bool) -> Array:
    """Return the coordinates of X, whose first `batch` axes an error names, by least squares."""
    entries = X.shape[-1] * X.shape[-2]
    B = basis.reshape(*basis.shape[:-2], entries)
    x = X.reshape(*X.shape[:-2], entries)
    gram = B @ np.swapaxes(B, -1, -2)
    if check and gram.size:
        size = np.linalg.eigvalsh(gram)
        dependent = size[..., 0] <= checks.TOLERANCE**2 * size[..., -1]
        if np.any(dependent):
            index = checks.first(dependent)
            got = f"a combination of size {np.sqrt(max(size[index][0], 0.0)):.1e}"
            checks.fail(where, "basis", "linearly independent matrices", got, index[:batch])
    t = np.asarray(np.linalg.solve(gram, B @ x[..., None]), dtype=np.float64)
    if check and x.size:
        rest = np.linalg.norm(x - (np.swapaxes(t, -1, -2) @ B)[..., 0, :], axis=-1)
        # A bracket may vanish, so it is measured by the basis as well.
        outside = rest > checks.TOLERANCE * (
            np.linalg.norm(x, axis=-1) + np.sqrt(np.max(np.abs(gram), axis=(-1, -2)))
        )
        if np.any(outside):
            index = checks.first(outside)
            checks.fail(
                where, name, "in the span of the basis", f"a rest of {rest[index]:.1e}", index[:batch]
            )
    return t[..., 0]


def coordinates(X: ArrayLike, basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the coordinates of a matrix of the algebra, the inverse of `combine`.

    Book: 4.5, (4.21), (4.22), (4.23)

    Parameters
    ----------
    X : (..., n, n), skew
        Any matrix in the span of the basis.
    basis : (..., k, n, n), basis
    check : bool, False to take the nearest matrix in the span

    Returns
    -------
    t : (..., k)

    Raises
    ------
    ValueError
        If X is not finite or not in the span, or the basis is not independent.
    """
    where = "basis.coordinates"
    X, basis = checks.square(where, "X", X, check), checks.square(where, "basis", basis, check, 1)
    checks.array(where, "basis", basis, X.shape[-2:], False)
    checks.broadcast(where, X=(X, 2), basis=(basis, 3))
    batch = np.broadcast_shapes(X.shape[:-2], basis.shape[:-3])
    X = np.broadcast_to(X, (*batch, *X.shape[-2:]))
    return _solve(where, "X", X, np.broadcast_to(basis, (*batch, *basis.shape[-3:])), len(batch), check)


def structure_constants(basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the c with [X_i, X_j] = c_ij1 X_1 + ... + c_ijk X_k.

    For J_x, J_y, J_z they are the signs of the permutations i, j, k.

    Book: 4.2, 4.5

    Parameters
    ----------
    basis : (..., k, n, n), basis
    check : bool, False to take what lies in the span

    Returns
    -------
    c : (..., k, k, k)

    Raises
    ------
    ValueError
        If the basis is not finite, not independent, or not that of an algebra.
    """
    where = "basis.structure_constants"
    basis = checks.square(where, "basis", basis, check, 1)
    return _brackets(where, "basis", basis, basis, check)


def ad(X: ArrayLike, basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix of Y -> [X, Y] in the coordinates of a basis, the derivative of the adjoint at I.

    Book: 4.2, (4.11)

    Parameters
    ----------
    X : (..., n, n), skew
        Any matrix whose brackets with the basis are in its span.
    basis : (..., k, n, n), basis
    check : bool, False to take what lies in the span

    Returns
    -------
    ad_X : (..., k, k)

    Raises
    ------
    ValueError
        If X or the basis is not finite, or a bracket is not in the span.
    """
    where = "basis.ad"
    X, basis = checks.square(where, "X", X, check), checks.square(where, "basis", basis, check, 1)
    checks.array(where, "basis", basis, X.shape[-2:], False)
    checks.broadcast(where, X=(X, 2), basis=(basis, 3))
    images = _brackets(where, "X", X[..., None, :, :], basis, check)
    return np.ascontiguousarray(np.swapaxes(images[..., 0, :, :], -1, -2))


def _brackets(where: str, name: str, X: Array, basis: Array, check: bool) -> Array:
    """Return the coordinates of [X_i, B_j], by i, j."""
    Z = bracket(X[..., :, None, :, :], basis[..., None, :, :, :])
    wide = np.broadcast_to(basis[..., None, None, :, :, :], (*Z.shape[:-2], *basis.shape[-3:]))
    return _solve(where, name, Z, wide, Z.ndim - 4, check)
