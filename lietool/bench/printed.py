"""The formulas of Kaji and Ochiai as they are printed, and the other ways that their tables name.

They are kept to be compared with, not to be used: `lietool.lie` has what
replaces them.  All take batches.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import generic

Array = NDArray[np.float64]

# "When x is small": where the error of the approximation meets that of the subtraction.
_SMALL_E2, _SMALL_L2 = 2e-3, 2e-4


def _eigenvalues(S: Array) -> Array:
    """Return the eigenvalues by the cubic formula, in falling order."""
    mean = np.trace(S, axis1=-2, axis2=-1) / 3.0
    K = S - mean[..., None, None] * np.eye(3)
    r = np.sqrt(np.sum(K * K, axis=(-1, -2)) / 6.0)
    cosine = np.linalg.det(K / np.where(r > 0.0, r, 1.0)[..., None, None]) / 2.0
    angle = np.arccos(np.clip(cosine, -1.0, 1.0)) / 3.0
    angles = np.stack([angle, angle - 2.0 * np.pi / 3.0, angle + 2.0 * np.pi / 3.0], axis=-1)
    return mean[..., None] + 2.0 * r[..., None] * np.cos(angles)


def _e2(x: Array) -> Array:
    small = np.abs(x) < _SMALL_E2
    y = np.where(small, 1.0, x)
    return np.where(small, 0.5 + x / 6.0 + x * x / 24.0, (np.exp(y) - 1.0 - y) / (y * y))


def _l2(x: Array) -> Array:
    small = np.abs(x - 1.0) < _SMALL_L2
    y = np.where(small, 2.0, x)
    return np.where(small, -(x - 1.0) / 2.0 + (x - 1.0) ** 2 / 3.0, (np.log(y) - (y - 1.0)) / (y - 1.0))


def _over(a: Array, b: Array, limit: float) -> Array:
    return np.where(b == 0.0, limit, a / np.where(b == 0.0, 1.0, b))


def sym_exp(Y: Array) -> Array:
    """(6), with the eigenvalues by the cubic formula."""
    d = _eigenvalues(Y)
    x, z = d[..., 0] - d[..., 1], d[..., 2] - d[..., 1]
    e, f = _e2(x), _e2(z)
    b = 1.0 - x * z * _over(e - f, x - z, 1.0 / 6.0)
    c = 0.5 + _over(x * (2.0 * e - 1.0) - z * (2.0 * f - 1.0), 2.0 * (x - z), 0.0)
    Z = Y - d[..., 1, None, None] * np.eye(3)
    series = np.eye(3) + b[..., None, None] * Z + c[..., None, None] * (Z @ Z)
    return np.exp(d[..., 1])[..., None, None] * series


def sym_log(S: Array) -> Array:
    """(7) for a matrix itself, without the square and its half."""
    d = _eigenvalues(S)
    middle = d[..., 1]
    x, z = d[..., 0] / middle, d[..., 2] / middle
    e, f = _l2(x), _l2(z)
    a = -1.0 + _over(z * e - x * f, x - z, 0.0)
    c = _over(e - f, x - z, -0.5)
    Z = S / middle[..., None, None]
    a, c = a[..., None, None], c[..., None, None]
    return (a + np.log(middle)[..., None, None]) * np.eye(3) - (a + c) * Z + c * (Z @ Z)


def higham_exp(Y: Array) -> Array:
    """Scaling and squaring, by SciPy, one after the other."""
    return generic.exp(Y, check=False)


def higham_log(S: Array) -> Array:
    """Inverse scaling and squaring, by SciPy, one after the other."""
    return generic.log(S, check=False)


def _diagonal(f: np.ufunc, S: Array) -> Array:
    d, P = np.linalg.eigh(S)
    return (P * f(d)[..., None, :]) @ np.swapaxes(P, -1, -2)


def diagonal_exp(Y: Array) -> Array:
    """(11): eigenvectors and eigenvalues, by LAPACK."""
    return _diagonal(np.exp, Y)


def diagonal_log(S: Array) -> Array:
    """(11): eigenvectors and eigenvalues, by LAPACK."""
    return _diagonal(np.log, S)


def newton_polar(A: Array, steps: int = 20) -> tuple[Array, Array]:
    """Return R and S of A = R S by Newton's iteration with scaling (Higham 1986)."""
    R = np.array(A)
    for _ in range(steps):
        inverse = np.swapaxes(np.linalg.inv(R), -1, -2)
        g = np.sqrt(np.linalg.norm(inverse, axis=(-2, -1)) / np.linalg.norm(R, axis=(-2, -1)))
        g = g[..., None, None]
        change = 0.5 * (g * R + inverse / g) - R
        R = R + change
        if np.max(np.abs(change)) <= 1e-15:
            break
    S = np.swapaxes(R, -1, -2) @ A
    return R, 0.5 * (S + np.swapaxes(S, -1, -2))
