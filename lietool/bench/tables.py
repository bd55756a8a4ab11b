"""Measure the two tables of Kaji and Ochiai on this machine."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.bench import methods, printed

Array = NDArray[np.float64]

SLOW = 200
"""Matrices for what takes them one after the other."""


@dataclass(frozen=True)
class Line:
    """A row of a table: seconds per matrix of both directions, and the largest |X - back(there(X))|^2.

    `count` is the number of matrices, `missed` how many of them have no
    parameters at all; they are left out of the error.
    """

    name: str
    back: float
    there: float
    error: float
    count: int
    missed: int = 0


def definite(count: int, seed: int = 21) -> Array:
    """Return A^T A of normal matrices with det A > 1e-3: those whose logarithm (7) is made for."""
    A = affine(count, seed)[:, :3, :3]
    return np.swapaxes(A, -1, -2) @ A


def affine(count: int, seed: int = 22) -> Array:
    """Return affine transformations with normal entries and determinants above 1e-3, as in the paper."""
    rng = np.random.default_rng(seed)
    A = np.tile(np.eye(4), (count, 1, 1))
    A[:, :3, :] = rng.normal(size=(count, 3, 4))
    A[:, :3, 0] *= np.sign(np.linalg.det(A[:, :3, :3]))[:, None]
    while np.any(small := np.linalg.det(A[:, :3, :3]) <= 1e-3):
        fresh = rng.normal(size=(int(small.sum()), 3, 3))
        fresh[..., 0] *= np.sign(np.linalg.det(fresh))[:, None]
        A[small, :3, :3] = fresh
    return A


def seconds(f: Callable[[], object], repeats: int = 5) -> float:
    """Return the median time of a call after one that is not counted."""
    f()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        f()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def squared_error(X: Array, again: Array) -> float:
    """Return the largest squared Frobenius norm of a difference."""
    return float(np.max(np.sum((X - again) ** 2, axis=(-2, -1))))


def round_trip(
    X: Array, there: Callable[[Array], Array], back: Callable[[Array], Array]
) -> tuple[float, int]:
    """Return the largest squared error of back(there(X)), and how many X have no parameters."""
    again = back(there(X))
    found = np.sum((X - again) ** 2, axis=(-2, -1)) < 1e-6 * np.sum(X * X, axis=(-2, -1))
    return squared_error(X[found], again[found]), int(np.sum(~found))


def _line(
    name: str, X: Array, there: Callable[[Array], Array], back: Callable[[Array], Array], repeats: int
) -> Line:
    parameters = there(X)
    times = (
        seconds(lambda: back(parameters), repeats) / len(X),
        seconds(lambda: there(X), repeats) / len(X),
    )
    error, missed = round_trip(X, there, back)
    return Line(name, *times, error, len(X), missed)


def table1(count: int, repeats: int = 5) -> list[Line]:
    """Measure exp (`back`) and log (`there`) of symmetric matrices, and the error of exp(log S)."""
    S = definite(count)
    lines = []
    for name, (exp, log) in methods.SYMMETRIC.items():
        few = exp is printed.higham_exp
        lines.append(_line(name, S[:SLOW] if few else S, log, exp, repeats))
    return lines


def table2(count: int, repeats: int = 5) -> list[Line]:
    """Measure phi (`back`) and psi (`there`) of affine transformations, and the error of phi(psi(X))."""
    A = affine(count)
    lines = [_line(m.name, A, m.psi, m.phi, repeats) for m in methods.METHODS]
    ours = methods.METHODS[0]
    return [*lines, _line("Ours, as printed", A, methods.printed_psi, ours.phi, repeats)]


def careless_error(count: int) -> float:
    """Return the error of Alexa's way by the real part of any complex logarithm, as in the paper."""
    alexa = next(m for m in methods.METHODS if m.way == "alexa")
    A = affine(count)
    return squared_error(A, alexa.phi(methods.careless_log(A)))
