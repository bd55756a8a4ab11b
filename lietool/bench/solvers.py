"""Compare sparse solvers on matrices of the interpolation: why `interp.elimination` has the one it has."""

import importlib
import importlib.util
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.bench import morphs
from lietool.interp import constraint, energy, shape

PACKAGES = {"SuperLU": "scipy", "qdldl": "qdldl", "cholespy": "cholespy"}
RIGHT_SIDES = {"E^F": 120, "E^R": 3}
"""As the interpolation has them: x and y of sixty frames, or one frame with what stands beside the matrix."""


@dataclass(frozen=True)
class Row:
    """What a solver took for a matrix, in seconds.

    Parameters
    ----------
    solver : str
    matrix : str
        The energy: E^F is real, E^R complex (and where a solver takes real ones alone, of twice the size).
    triangles : int
    first : float
        To factor a matrix of an unknown pattern.
    again : float
        To factor the next matrix of the same pattern.
    solve : float
        For the right sides of `RIGHT_SIDES`.
    error : float
        The largest residual, relative to the largest right side.
    """

    solver: str
    matrix: str
    triangles: int
    first: float
    again: float
    solve: float
    error: float


def missing() -> dict[str, str]:
    """Return the solvers that are not installed here."""
    absent = (name for name, package in PACKAGES.items() if importlib.util.find_spec(package) is None)
    return {name: f"{PACKAGES[name]} is not installed" for name in absent}


def compare(size: int, repeats: int = 3) -> Iterator[Row]:
    """Yield what each solver that is here takes for a strip of about so many triangles.

    Parameters
    ----------
    size : int
    repeats : int
        The least of so many times.

    Yields
    ------
    Row
    """
    mesh = morphs.strip(size)
    for name, error in (("E^F", energy.FROBENIUS), ("E^R", energy.SIMILARITY)):
        matrix = _matrix(mesh, error)
        b = np.random.default_rng(5).normal(size=(RIGHT_SIDES[name], matrix.shape[0]))
        for solver in (name for name in PACKAGES if name not in missing()):
            complex_ = np.iscomplexobj(matrix.data) and solver != "SuperLU"
            A, right = (_real(matrix), np.concatenate([b, b], axis=1)) if complex_ else (matrix, b)
            first, again, solve, x = _SOLVERS[solver](A, right.astype(A.dtype), repeats)
            off = float(np.abs(A @ x.T - right.T).max() / np.abs(right).max())
            yield Row(solver, name, len(mesh[2]), first, again, solve, off)


def _matrix(mesh: morphs.Mesh, error: energy.Energy) -> Any:
    """The system of a frame between the two shapes, the free unknowns in the order of elimination."""
    prepared = shape.prepare(*mesh, error=error)
    rows = constraint.rows(prepared.constraints, len(mesh[0]), np.array([0.4]))
    maps = [part.maps(0.4) for part in prepared.sums]
    return (prepared.factor or prepared.assembly.factor(maps, rows, 0)).inner


def _real(A: Any) -> Any:
    """The real matrix of twice the size, x and y of a vertex side by side so that factors stay sparse."""
    from scipy.sparse import csc_array, kron

    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    return csc_array(kron(A.real, np.eye(2)) + kron(A.imag, J))


def _least(f: Callable[[], Any], repeats: int) -> tuple[float, Any]:
    best, found = float("inf"), None
    for _ in range(repeats):
        start = time.perf_counter()
        found = f()
        best = min(best, time.perf_counter() - start)
    return best, found


def _superlu(A: Any, b: NDArray[Any], repeats: int) -> tuple[float, float, float, NDArray[Any]]:
    from scipy.sparse import csc_array

    from lietool.mesh import elimination

    first, found = _least(lambda: elimination.superlu(A, False), repeats)
    order = np.argsort(found.perm_c)
    rows: Any = A[order]
    ordered = csc_array(rows[:, order])
    again, _ = _least(lambda: elimination.superlu(ordered, True), repeats)
    solve, x = _least(lambda: found.solve(b.T), repeats)
    return first, again, solve, x.T


def _qdldl(A: Any, b: NDArray[Any], repeats: int) -> tuple[float, float, float, NDArray[Any]]:
    from scipy.sparse import csc_matrix

    qdldl: Any = importlib.import_module("qdldl")
    old = csc_matrix(A)
    first, found = _least(lambda: qdldl.Solver(old), repeats)
    again, _ = _least(lambda: found.update(old), repeats)
    solve, x = _least(lambda: np.stack([found.solve(row) for row in b]), repeats)
    return first, again, solve, x


def _cholespy(A: Any, b: NDArray[Any], repeats: int) -> tuple[float, float, float, NDArray[Any]]:
    from scipy.sparse import coo_matrix

    cholespy: Any = importlib.import_module("cholespy")
    old: Any = coo_matrix(A)
    form = cholespy.MatrixType.COO
    first, found = _least(
        lambda: cholespy.CholeskySolverD(old.shape[0], old.row, old.col, old.data, form), repeats
    )
    # It takes no more than 128 right sides at once, and has no way to keep a pattern.
    right, x = np.ascontiguousarray(b.T), np.zeros(b.T.shape)
    solve, _ = _least(lambda: found.solve(right, x), repeats)
    return first, first, solve, x.T


_SOLVERS = {"SuperLU": _superlu, "qdldl": _qdldl, "cholespy": _cholespy}
