"""The homotopies of chapter 5 in complex numbers, unchecked: what does not depend on time is computed once.

A real matrix acts on the plane of complex numbers as z -> a z + b conj(z).
With A = R(theta) S, S symmetric, that is a = e^(i theta) tr(S)/2, so that the
polar decomposition is that of one complex number, and every power of A is a closed formula.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

Path = Callable[[Any], tuple[Complex, Complex]]
"""From times, a number or an array that fits the batch of maps, to the coordinates (a, b) of the maps."""


def coordinates(A: Array) -> tuple[Complex, Complex]:
    """Return the complex numbers (a, b) by which a matrix acts as z -> a z + b conj(z).

    Book: A.3

    Parameters
    ----------
    A : (..., 2, 2)

    Returns
    -------
    a : (...), complex
    b : (...), complex
    """
    p, q, r, s = A[..., 0, 0], A[..., 0, 1], A[..., 1, 0], A[..., 1, 1]
    return 0.5 * (p + s + 1j * (r - q)), 0.5 * (p - s + 1j * (r + q))


def matrix(a: Complex | Array, b: Complex | Array) -> Array:
    """Return the matrices that act as z -> a z + b conj(z).

    Book: A.3

    Parameters
    ----------
    a, b : (...), complex

    Returns
    -------
    A : (..., 2, 2)
    """
    a, b = np.broadcast_arrays(a, b)
    rows = [a.real + b.real, b.imag - a.imag, a.imag + b.imag, a.real - b.real]
    return np.stack(rows, axis=-1).reshape(*a.shape, 2, 2)


def det(A: Array) -> Array:
    """Return the determinants of (..., 2, 2); from coordinates, |a|^2 - |b|^2, they would lose digits."""
    return A[..., 0, 0] * A[..., 1, 1] - A[..., 0, 1] * A[..., 1, 0]


def inverse(A: Array) -> Array:
    """Return the inverses of (..., 2, 2)."""
    p, q, r, s = A[..., 0, 0], A[..., 0, 1], A[..., 1, 0], A[..., 1, 1]
    adjugate = np.stack([s, -q, -r, p], axis=-1).reshape(A.shape)
    return adjugate / det(A)[..., None, None]


def linear(A: Array, theta: Array | None) -> Path:
    """Return the way A^L(t) = (1-t) I + t A."""
    a, b = coordinates(A)
    return lambda t: (1.0 - t + t * a, t * b)


def arap(A: Array, theta: Array) -> Path:
    """Return the way A^P(t) = R(t theta) ((1-t) I + t S)."""
    a, b = coordinates(A)
    size, along = np.abs(a), b * np.exp(-1j * theta)

    def path(t: Any) -> tuple[Complex, Complex]:
        turn = np.exp(1j * (t * theta))
        return turn * (1.0 - t + t * size), turn * (t * along)

    return path


def logexp(A: Array, theta: Array) -> Path:
    """Return the way A^E(t) = R(t theta) exp(t log S)."""
    a, b = coordinates(A)
    # The eigenvalues of S are |a| + |b| and |a| - |b|; the second would cancel, det does not.
    log_det = np.log(det(A))
    half_spread = np.log(np.abs(a) + np.abs(b)) - 0.5 * log_det
    rate = 0.5 * log_det + 1j * theta
    along = _unit(b * np.exp(-1j * theta))

    def path(t: Any) -> tuple[Complex, Complex]:
        turn = np.exp(t * rate)
        return turn * np.cosh(t * half_spread), turn * np.sinh(t * half_spread) * along

    return path


def matrix_log(A: Array, theta: Array | None) -> Path:
    """Return the way exp(t log A), for maps that have a real logarithm."""
    a, b = coordinates(A)
    # A = m I + Z, and Z Z = spread I.
    mean, size = a.real, 0.5 * np.log(det(A))
    spread = np.abs(b) ** 2 - a.imag**2
    root = np.sqrt(np.abs(spread))
    turning = spread < 0.0
    phi = np.arctan2(root, mean)
    equal = root <= 1e-8 * np.abs(mean)
    half_turn = (mean < 0.0) & equal
    with np.errstate(invalid="ignore", divide="ignore"):
        eta = np.where(turning, 0.0, np.arctanh(np.where(turning, 0.0, root / mean)))

    def path(t: Any) -> tuple[Complex, Complex]:
        even = np.where(turning, np.cos(t * phi), np.cosh(t * eta))
        odd = np.where(turning, np.sin(t * phi), np.sinh(t * eta))
        # Where both eigenvalues are equal, sinh(t eta)/root tends to t / mean.
        with np.errstate(divide="ignore", invalid="ignore"):
            odd = np.where(equal, t / mean, odd / root)
        # A half turn with a dilation has logarithms, of which this takes the turn to the left.
        even = np.where(half_turn, np.cos(np.pi * t), even)
        here = np.where(half_turn, 1j * np.sin(np.pi * t), 1j * odd * a.imag)
        grow = np.exp(t * size)
        return grow * (even + here), grow * np.where(half_turn, 0.0, odd) * b

    return path


def _unit(z: Complex) -> Complex:
    size = np.abs(z)
    return np.where(size > 0.0, z / np.where(size > 0.0, size, 1.0), 1.0)
