"""The polar decomposition A = R S of matrices with det A > 0, and their singular values, n = 2 and 3.

All comes from U diag(d) V^T with rotations U and V, by one-sided Jacobi:
R = U V^T, S = V diag(d) V^T.  The product A^T A, of which the texts take the
square root, would lose the small singular values.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, matrix_checks
from lietool.lie import jacobi_kernels as jacobi
from lietool.lie.blocks import Rows

_SVD = {4: jacobi.svd_plane, 9: jacobi.svd_space}
_CONJUGATE = {4: jacobi.conjugate_plane, 9: jacobi.conjugate_space}


def _decompose(A: Rows, left: bool = False) -> tuple[Rows, Rows, Rows]:
    """Return R, the upper triangle of S, and the singular values; A = R S, or S R if left."""
    n = 2 if len(A) == 4 else 3
    A, k = jacobi.scaled(A)
    U, d, V = _SVD[len(A)](A)
    d = [np.ldexp(x, k) for x in d]
    return (
        jacobi.product(U, jacobi.transpose(V, n), n),
        _CONJUGATE[len(A)](U if left else V, d),
        d,
    )


def _split(where: str, A: NDArray[np.float64], check: bool, left: bool) -> tuple[NDArray, NDArray]:
    n = A.shape[-1]

    def kernel(A: Rows) -> Rows:
        R, S, d = _decompose(A, left)
        return *R, *jacobi.full(S), d[-1]

    both = blocks.run(kernel, (2 * n * n + 1,), (A, 2))
    if check:
        matrix_checks.orientation(where, A, both[..., -1])
    R, S = both[..., : n * n], both[..., n * n : -1]
    return R.reshape(A.shape).copy(), S.reshape(A.shape).copy()


def decompose(A: ArrayLike, *, check: bool = True) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Split a matrix into a rotation after a stretch, A = R S.

    Book: (3.11)

    Parameters
    ----------
    A : (..., n, n), GL+
    check : bool, False to trust the values

    Returns
    -------
    R : (..., n, n), rotation
    S : (..., n, n), SPD

    Raises
    ------
    ValueError
        If the determinant of A is not positive.
    """
    A = matrix_checks.square("polar.decompose", "A", A, check)
    return _split("polar.decompose", A, check, left=False)


def decompose_left(A: ArrayLike, *, check: bool = True) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Split a matrix into a stretch after a rotation, A = S R; R is that of `decompose`, S = R S' R^T.

    Book: (3.12)

    Parameters
    ----------
    A : (..., n, n), GL+
    check : bool, False to trust the values

    Returns
    -------
    S : (..., n, n), SPD
    R : (..., n, n), rotation

    Raises
    ------
    ValueError
        If the determinant of A is not positive.
    """
    A = matrix_checks.square("polar.decompose_left", "A", A, check)
    R, S = _split("polar.decompose_left", A, check, left=True)
    return S, R


def svd(
    A: ArrayLike, *, check: bool = True
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return rotations U, V and d with A = U diag(d) V^T, d in falling order.

    The text writes (R' R) D R for the product; it is (R' R) D R^T.

    Book: (3.13), (3.14)

    Parameters
    ----------
    A : (..., n, n), GL+
    check : bool, False to trust the values

    Returns
    -------
    U : (..., n, n), rotation
    d : (..., n)
        The singular values.
    V : (..., n, n), rotation

    Raises
    ------
    ValueError
        If the determinant of A is not positive.
    """
    A = matrix_checks.square("polar.svd", "A", A, check)
    n = A.shape[-1]

    def kernel(A: Rows) -> Rows:
        A, k = jacobi.scaled(A)
        U, d, V = _SVD[len(A)](A)
        return *U, *V, *(np.ldexp(x, k) for x in d)

    rows = blocks.run(kernel, (2 * n * n + n,), (A, 2))
    d = rows[..., 2 * n * n :].copy()
    if check:
        matrix_checks.orientation("polar.svd", A, d[..., -1])
    U, V = rows[..., : n * n], rows[..., n * n : 2 * n * n]
    return U.reshape(A.shape).copy(), d, V.reshape(A.shape).copy()


def rotation(A: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the rotation nearest to a matrix, in the sum of squares: R of A = R S if det A > 0.

    Book: (3.11)

    Parameters
    ----------
    A : (..., n, n)
        Any matrix that has one nearest rotation: a projection to a plane, for
        instance, or a reflection with different singular values.
    check : bool, False to trust the values

    Returns
    -------
    R : (..., n, n), rotation

    Raises
    ------
    ValueError
        If several rotations are equally near, as to 0.
    """
    A = matrix_checks.square("polar.rotation", "A", A, check)
    n = A.shape[-1]

    def kernel(A: Rows) -> Rows:
        R, _, d = _decompose(A)
        return *R, (d[-2] + d[-1]) / (d[0] + (d[0] == 0.0))

    rows = blocks.run(kernel, (n * n + 1,), (A, 2))
    if check and A.size and not np.min(rows[..., -1]) > matrix_checks.UNDECIDED:
        index = checks.first(~(rows[..., -1] > matrix_checks.UNDECIDED))
        d = np.linalg.svd(A[index], compute_uv=False)
        got = "singular values " + ", ".join(f"{x:.3g}" for x in d)
        checks.fail("polar.rotation", "A", "a matrix with one nearest rotation", got, index)
    return rows[..., : n * n].reshape(A.shape).copy()
