"""Sparse symmetric systems of a mesh, factored once and solved for many right sides.

L x = b at the free vertices, with the others given.  The factors are SuperLU's, without pivoting, in the
order of minimum degree.  Of the orders that SciPy has it gives the fewest entries on surfaces, and up to
700 000 vertices, on surfaces in space and on grids, it is faster than cutting them by planes as
`elimination.dissection` does.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh import elimination, topology
from lietool.mesh.laplacian import listed, named

Array = NDArray[np.float64]
Index = NDArray[np.intp]

GOOD = 1e-13
"""A solution with a larger residual, relative to |L| |x| + |b|, is improved once."""
BAD = 1e-9
"""A solution with a larger one after that is none."""
FLOATING = 1e-10
"""Rows of a part that sum to less than this share of their diagonal hold it nowhere."""


class Factor:
    """A factored system; made by `factor`.

    Parameters
    ----------
    L : sparse array by columns, shape (n, n)
    free, fixed : ndarray of int
        The vertices that are solved for, and those with given values.
    """

    def __init__(self, L: Any, free: Index, fixed: Index):
        from scipy.sparse import csc_array

        self.count, self.free, self.fixed = L.shape[0], free, fixed
        below = csc_array(L[free])
        self.inner = csc_array(below[:, free])
        self.cross = csc_array(below[:, fixed])
        self.norm = float(np.max(abs(self.inner).sum(axis=0), initial=0.0))
        # Where every vertex is given there is nothing to solve.
        self.solver = _superlu(self.inner) if len(free) else None

    def solve(self, rhs: ArrayLike, values: ArrayLike) -> Array:
        """Return the solutions.

        Parameters
        ----------
        rhs : array_like, shape (n, k)
            Its rows at fixed vertices have no meaning.
        values : array_like, shape (len(fixed), k)

        Returns
        -------
        x : ndarray, shape (n, k)

        Raises
        ------
        ValueError
            If a shape does not fit, a number is not finite, or the system is singular to rounding.
        """
        b, given = self._arguments(rhs, values)
        x = np.empty(b.shape)
        x[self.fixed] = given
        if self.solver is None:
            return x
        right = b[self.free] - self.cross @ given if len(given) else b[self.free]
        z = self.solver.solve(right)
        residual, rest = self._residual(z, right)
        if not residual <= GOOD:
            z = z + self.solver.solve(rest)
            residual, _ = self._residual(z, right)
        if not residual <= BAD:
            got = f"one that is singular to rounding, residual {residual:.1e}"
            topology.fail("solve.factor", "L", "a regular matrix", got, "Fix more vertices.")
        x[self.free] = z
        return x

    def _residual(self, z: Array, b: Array) -> tuple[float, Array]:
        rest = b - self.inner @ z
        scale = self.norm * _largest(z) + _largest(b)
        return float(np.max(_largest(rest) / np.maximum(scale, 1e-300), initial=0.0)), rest

    def _arguments(self, rhs: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
        where, n, fixed = "solve.Factor.solve", self.count, len(self.fixed)
        b = checks.array(where, "rhs", rhs, (), check=False)
        given = checks.array(where, "values", values, (), check=False)
        if b.ndim != 2 or len(b) != n:
            topology.fail(where, "rhs", f"an array of shape ({n}, k)", f"shape {b.shape}")
        if given.shape != (fixed, b.shape[1]):
            must = f"an array of shape ({fixed}, {b.shape[1]})"
            topology.fail(where, "values", must, f"shape {given.shape}")
        for name, a in (("rhs", b), ("values", given)):
            # Of rows at fixed vertices nothing is asked, but they are no place for nan either.
            if not np.isfinite(a).all():
                i, k = np.argwhere(~np.isfinite(a))[0]
                topology.fail(where, name, "finite", f"{a[i, k]} at row {i}")
        return b, given


def factor(L: Any, fixed: ArrayLike) -> Factor:
    """Return the factors of a symmetric positive semi-definite system with some values given.

    Book: (7.14)

    Parameters
    ----------
    L : sparse array, shape (n, n)
    fixed : array_like of int, shape (k,)
        The vertices whose values are given; may be empty where L is regular.

    Returns
    -------
    Factor

    Raises
    ------
    ValueError
        If an argument does not fit, or the system is singular: a part of the mesh, which is named by one of
        its vertices, is held nowhere, or a vertex has no equation.
    """
    where = "solve.factor"
    L = _matrix(where, L)
    n = L.shape[0]
    fixed = topology.distinct(where, "fixed", topology.vertex_set(where, "fixed", fixed, n))
    given = np.zeros(n, bool)
    given[fixed] = True
    free = np.flatnonzero(~given)
    _refuse_floating(where, L, given)
    return Factor(L, free, fixed)


def _matrix(where: str, L: Any) -> Any:
    from scipy.sparse import csc_array, issparse

    if not issparse(L) or L.ndim != 2 or L.shape[0] != L.shape[1]:
        topology.fail(where, "L", "a sparse square matrix", f"{type(L).__name__} of shape {np.shape(L)}")
    L = csc_array(L, dtype=float)
    L.sum_duplicates()
    if not np.isfinite(L.data).all():
        k = int(np.searchsorted(L.indptr, np.argmax(~np.isfinite(L.data)), side="right")) - 1
        topology.fail(where, "L", "finite", f"an entry that is not in column {k}")
    return L


def _refuse_floating(where: str, L: Any, given: NDArray[np.bool_]) -> None:
    """Refuse parts without a given value whose rows sum to 0: a constant may be added to any solution."""
    n = L.shape[0]
    diagonal = L.diagonal()
    empty = (diagonal == 0.0) & ~given
    if empty.any():
        remedy = "Fix it, or remove it from the mesh."
        topology.fail(where, "L", "a row for every free vertex", f"none at {named('vertex', empty)}", remedy)
    column = np.repeat(np.arange(n), np.diff(L.indptr))
    used = L.data != 0.0
    number, part = topology.components(n, np.stack([L.indices[used], column[used]], axis=1))
    held = given | (np.abs(L.sum(axis=0)) > FLOATING * diagonal)
    first = topology.unheld(number, part, np.flatnonzero(held))
    if len(first):
        got = f"none in {len(first)} of {number}, those of {listed('vertex', first)}"
        topology.fail(where, "fixed", "a vertex in every connected part", got, "Fix a vertex in each.")


def _superlu(inner: Any) -> Any:
    try:
        return elimination.superlu(inner, False)
    except RuntimeError as error:
        got = f"a singular one ({str(error).strip().lower()})"
        topology.fail("solve.factor", "L", "regular among the free vertices", got)


def _largest(x: Array) -> Array:
    return np.maximum(np.max(x, axis=0, initial=0.0), -np.min(x, axis=0, initial=0.0))
