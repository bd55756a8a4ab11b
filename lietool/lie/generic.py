"""Matrix groups of any size: exponential, logarithm, one-parameter subgroups, canonical coordinates.

Everything is by SciPy, one matrix after the other; where a group has a module
of its own, that is faster and more accurate.  Bases of Lie algebras are in
`basis`, homogeneous coordinates in `projective`; both are reached from here.
"""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, series
from lietool.lie.basis import J_X as J_X
from lietool.lie.basis import J_Y as J_Y
from lietool.lie.basis import J_Z as J_Z
from lietool.lie.basis import ad as ad
from lietool.lie.basis import bch as bch
from lietool.lie.basis import bracket as bracket
from lietool.lie.basis import combine as combine
from lietool.lie.basis import coordinates as coordinates
from lietool.lie.basis import structure_constants as structure_constants
from lietool.lie.projective import affine as affine
from lietool.lie.projective import embed as embed
from lietool.lie.projective import homogeneous as homogeneous
from lietool.lie.projective import inhomogeneous as inhomogeneous
from lietool.lie.projective import parts as parts
from lietool.lie.projective import transform as transform

Array = NDArray[np.float64]

_NEAR = 0.1
"""The sine of the angle at the negative axis within which an eigenvalue is split off."""

_EQUAL = 1e-10
"""Eigenvalues this near to each other, relatively, are the same one, rounded."""

_RESIDUAL = 1e-9
"""The largest |exp(log A) - A| / |A| that is handed back."""


def _each(f: Callable[[Array], Any], A: Array) -> Array:
    """Apply a function of one matrix to each of a batch: batched `expm` is wrong in SciPy 1.18.0."""
    values = [f(M) for M in A.reshape(-1, *A.shape[-2:])]
    return np.array(values, dtype=np.float64).reshape(A.shape)


def exp(A: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix exponential, the sum of A^k / k!.

    Book: (4.1), (4.2), (4.3), (4.5), (4.6), (4.11), (4.17)

    Parameters
    ----------
    A : (..., n, n)
    check : bool, False to trust the values

    Returns
    -------
    exp_A : (..., n, n)

    Raises
    ------
    ValueError
        If A is not square or not finite.
    """
    from scipy.linalg import expm

    return _each(expm, checks.square("generic.exp", "A", A, check))


def log(A: ArrayLike, *, check: bool = True) -> Array:
    """Return a real logarithm of each matrix, the principal one where it is defined.

    That is where no eigenvalue is negative or 0.  A negative eigenvalue has
    real logarithms if it comes an even number of times with as many
    eigenvectors, as in a half turn: then pi J is added to the logarithm of
    its size, J a quarter turn in the space of its eigenvectors, one of many.
    All other matrices are refused, also those where the exponential of what
    was found does not give A again (a defective eigenvalue beside the
    negative axis, where the logarithm is of a size that float64 cannot use).

    Book: (4.12), (4.13)

    Parameters
    ----------
    A : (..., n, n), exponential
    check : bool, False to return nan where there is no logarithm

    Returns
    -------
    log_A : (..., n, n)

    Raises
    ------
    ValueError
        If A is not square or not finite, or has no real logarithm.
    """
    A = checks.square("generic.log", "A", A, check)
    L = np.full(A.shape, np.nan)
    for index in np.ndindex(A.shape[:-2]):
        try:
            L[index] = _log_to_residual(A[index])
        except _NoRealLogarithmError as reason:
            if check:
                remedy = "Blend it by another way than the matrix logarithm, such as phi_so."
                checks.fail("generic.log", "A", "a matrix with a real logarithm", str(reason), index, remedy)
    return L


class _NoRealLogarithmError(ArithmeticError):
    """Its text is what stands in the way."""


def _log_to_residual(A: Array) -> Array:
    """Return a real logarithm that has been tried."""
    from scipy.linalg import expm

    if not np.all(np.isfinite(A)):
        raise _NoRealLogarithmError("an entry that is not finite")
    worst = np.inf
    for way in (_real_log, _principal):
        L = way(A)
        residual = np.linalg.norm(expm(L) - A) / np.linalg.norm(A) if np.all(np.isfinite(L)) else np.inf
        if residual <= _RESIDUAL:
            return L
        worst = min(worst, float(residual))
    raise _NoRealLogarithmError(f"one whose exponential misses it by {worst:.1e} of its size")


def _principal(A: Array) -> Array:
    """Return the real part of SciPy's logarithm; what it warns of shows in the residual."""
    from scipy.linalg import logm

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return np.real(logm(A))


def _eigenvalues(A: Array) -> NDArray[np.complex128]:
    """Return the eigenvalues as the Schur form has them: of a defective one, half of the digits are noise."""
    from scipy.linalg import schur

    seen: list[complex] = []
    schur(A, output="real", sort=lambda re, im: bool(seen.append(complex(re, im))))
    return np.array(seen)


def _real_log(A: Array) -> Array:
    """Return a real logarithm; eigenvalues beside the negative axis are split off, one after the other."""
    from scipy.linalg import schur, solve_sylvester

    if not A.size:
        return A
    w = _eigenvalues(A)
    if np.any(w == 0.0):
        raise _NoRealLogarithmError("eigenvalue 0")
    left = (w.real < 0.0) & (np.abs(w.imag) <= _NEAR * np.abs(w))
    if not np.any(left):
        return _principal(A)
    z = complex(w[left][0])

    def chosen(re: float, im: float) -> bool:
        return min(abs(complex(re, im) - z), abs(complex(re, -im) - z)) <= _EQUAL * abs(z)

    sorted_schur: Any = schur(A, output="real", sort=chosen)
    T, Z, k = sorted_schur
    if not k:  # defective, and changed in half of its digits when it was moved
        return _principal(A)
    L1, L2 = _log_of_one_eigenvalue(T[:k, :k]), _real_log(T[k:, k:])
    # I, Y; 0, I takes T to its diagonal blocks.
    Y = solve_sylvester(T[:k, :k], -T[k:, k:], -T[:k, k:]) if k < len(T) else T[:k, k:]
    L = np.block([[L1, Y @ L2 - L1 @ Y], [np.zeros((len(T) - k, k)), L2]])
    return Z @ L @ Z.T


def _log_of_one_eigenvalue(T: Array) -> Array:
    """Return a real logarithm of a block in Schur form, whose eigenvalues are one near the negative axis."""
    k = len(T)
    mean = np.trace(T) / k
    size = np.abs(mean)
    spread = np.max(np.abs(T - mean * np.eye(k))) / size
    w = np.linalg.eigvals(T)
    if np.any(w.imag != 0.0) and spread > series.ROUNDED:
        if k > 2:
            return _principal(T)
        omega = np.abs(w[0].imag)
        return np.log(np.abs(w[0])) * np.eye(2) + np.arctan2(omega, mean) / omega * (T - mean * np.eye(2))
    if k % 2:
        times = "" if k == 1 else f", {k} times"
        raise _NoRealLogarithmError(f"the negative eigenvalue {mean:.6g}{times}")
    if spread > _EQUAL:
        raise _NoRealLogarithmError(f"the negative eigenvalue {mean:.6g} with too few eigenvectors")
    return np.log(size) * np.eye(k) + np.pi * np.kron(np.eye(k // 2), [[0.0, -1.0], [1.0, 0.0]])


def one_parameter(A: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix at t of the one-parameter subgroup of A: exp(t A), with the derivative A at 0.

    Book: (4.8), (4.14)

    Parameters
    ----------
    A : (..., n, n)
    t : (...)
    check : bool, False to trust the values

    Returns
    -------
    phi_t : (..., n, n)

    Raises
    ------
    ValueError
        If A is not square, or A or t is not finite.
    """
    A = checks.square("generic.one_parameter", "A", A, check)
    t = checks.array("generic.one_parameter", "t", t, (), check)
    checks.broadcast("generic.one_parameter", A=(A, 2), t=(t, 0))
    return exp(t[..., None, None] * A, check=False)


def first_kind(t: ArrayLike, basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix of canonical coordinates of the first kind: exp(t_1 X_1 + ... + t_k X_k).

    Its inverse near the identity is `coordinates` of `log`.

    Book: 4.5, (4.7)

    Parameters
    ----------
    t : (..., k)
    basis : (..., k, n, n), basis
    check : bool, False to trust the values

    Returns
    -------
    A : (..., n, n)

    Raises
    ------
    ValueError
        If t or the basis is not finite.
    """
    basis = checks.square("generic.first_kind", "basis", basis, check, 1)
    t = checks.array("generic.first_kind", "t", t, basis.shape[-3:-2], check)
    checks.broadcast("generic.first_kind", t=(t, 1), basis=(basis, 3))
    return exp(combine(t, basis, check=False), check=False)


def second_kind(t: ArrayLike, basis: ArrayLike, *, check: bool = True) -> Array:
    """Return the matrix of canonical coordinates of the second kind: exp(t_1 X_1) ... exp(t_k X_k).

    For the basis J_z, J_y, J_x of so(3) these are Euler angles.

    Book: 4.5, (2.21)

    Parameters
    ----------
    t : (..., k)
    basis : (..., k, n, n), basis
    check : bool, False to trust the values

    Returns
    -------
    A : (..., n, n)

    Raises
    ------
    ValueError
        If t or the basis is not finite.
    """
    basis = checks.square("generic.second_kind", "basis", basis, check, 1)
    t = checks.array("generic.second_kind", "t", t, basis.shape[-3:-2], check)
    checks.broadcast("generic.second_kind", t=(t, 1), basis=(basis, 3))
    factors = exp(t[..., None, None] * basis, check=False)
    A = factors[..., 0, :, :].copy()
    for i in range(1, factors.shape[-3]):
        A = A @ factors[..., i, :, :]
    return A
