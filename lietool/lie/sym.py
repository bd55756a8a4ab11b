"""Symmetric matrices sym(n) and positive definite ones Sym+(n), n = 2 and 3, which exp makes one."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, matrix_checks, sym_kernels
from lietool.lie import jacobi_kernels as jacobi
from lietool.lie.blocks import Rows

_KERNELS = {
    "exp": {2: sym_kernels.exp_plane, 3: sym_kernels.exp_space},
    "log": {2: sym_kernels.log_plane, 3: sym_kernels.log_space},
    "power": {2: sym_kernels.power_plane, 3: sym_kernels.power_space},
}


def _apply(name: str, S: NDArray[np.float64], *more: tuple[NDArray[np.float64], int]) -> NDArray[np.float64]:
    n = S.shape[-1]
    kernel = _KERNELS[name][n]

    def whole(S: Rows, *more: Rows) -> Rows:
        return jacobi.full(kernel(jacobi.upper(S), *more))

    with np.errstate(over="ignore", invalid="ignore"):
        return blocks.run(whole, (n, n), (S, 2), *more)


def _definite(where: str, name: str, S: NDArray[np.float64], result: NDArray[np.float64]) -> None:
    """Refuse S where its logarithm or power came out as nan: not positive definite."""
    if result.size and np.isnan(np.min(result)):
        index = checks.first(np.isnan(result[..., 0, 0]))
        given = np.broadcast_to(S, result.shape)[index]
        got = f"smallest eigenvalue {np.linalg.eigvalsh(given)[0]:.3g}"
        checks.fail(where, name, "positive definite", got, index)


def exp(Y: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the exponential of a symmetric matrix, a positive definite one.

    (4) as printed in MEIS has wrong signs, and divides by differences of
    eigenvalues; here equal and nearly equal ones are no special case.

    Book: (4.3), (4.18), (4.19)
    MEIS: (3), (4)
    Kaji-Ochiai: (6), (12), (13)

    Parameters
    ----------
    Y : (..., n, n), symmetric
    check : bool, False to trust the values

    Returns
    -------
    S : (..., n, n), SPD

    Raises
    ------
    ValueError
        If Y is not symmetric, or so large that its exponential overflows.
    """
    Y = matrix_checks.symmetric("sym.exp", "Y", Y, check)
    S = _apply("exp", Y)
    if check and S.size and not np.max(S) < np.inf:
        index = checks.first(~np.all(np.isfinite(S), axis=(-1, -2)))
        largest = np.linalg.eigvalsh(Y[index])[-1]
        checks.fail("sym.exp", "Y", "without eigenvalues above 709", f"{largest:.6g}", index)
    return S


def log(S: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the symmetric logarithm of a positive definite matrix.

    Book: (4.19)
    Kaji-Ochiai: (7)

    Parameters
    ----------
    S : (..., n, n), SPD
    check : bool, False to trust the values
        Then the logarithm of what is not positive definite is nan.

    Returns
    -------
    Y : (..., n, n), symmetric

    Raises
    ------
    ValueError
        If S is not symmetric and positive definite.
    """
    S = matrix_checks.symmetric("sym.log", "S", S, check)
    Y = _apply("log", S)
    if check:
        _definite("sym.log", "S", S, Y)
    return Y


def power(S: ArrayLike, t: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return S^t = exp(t log S), a curve of positive definite matrices from I at 0 to S at 1.

    Book: (3.13), (4.3)
    Kaji-Ochiai: (11)

    Parameters
    ----------
    S : (..., n, n), SPD
    t : (...)
        Any number.
    check : bool, False to trust the values
        Then a power of what is not positive definite is nan.

    Returns
    -------
    S_t : (..., n, n), SPD

    Raises
    ------
    ValueError
        If S is not symmetric and positive definite, or t is not finite.
    """
    S = matrix_checks.symmetric("sym.power", "S", S, check)
    t = checks.array("sym.power", "t", t, (), check)
    checks.broadcast("sym.power", S=(S, 2), t=(t, 0))
    result = _apply("power", S, (t, 0))
    if check:
        _definite("sym.power", "S", S, result)
    return result


def sqrt(S: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the positive definite square root of a positive definite matrix.

    Book: (3.13), (7.2)
    MEIS: (2)

    Parameters
    ----------
    S : (..., n, n), SPD
    check : bool, False to trust the values
        Then the root of what is not positive definite is nan.

    Returns
    -------
    root : (..., n, n), SPD

    Raises
    ------
    ValueError
        If S is not symmetric and positive definite.
    """
    S = matrix_checks.symmetric("sym.sqrt", "S", S, check)
    result = _apply("power", S, (np.array(0.5), 0))
    if check:
        _definite("sym.sqrt", "S", S, result)
    return result
