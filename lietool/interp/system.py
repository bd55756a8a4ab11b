"""The linear system of an interpolation: what is known before any frame, and the solution of a frame.

The minimum of v* H v - 2 Re(v* b) under conditions U v = d is

    H v + U* mu = b,    U v - Delta mu = d,

with Delta = 0 for an exact condition and 1/c for one of weight c.  Vertices that follow a path exactly are
taken out, conditions on few vertices with a weight go into H, and the others stand beside the matrix: they
are few, and each costs one more right side.  A condition on a direction is real, and then the system is
written in x and y.

Where nothing in H holds a part of the shape, anchors do: a weight on one or two vertices, which a further
condition takes back again, so that H can be factored whatever holds the shape.

Where the matrix changes with every frame the order of elimination is found once, and with it the factors of
a new frame have the pattern of the old.  Of the solvers that were tried SuperLU, with narrow panels, is the
fastest for these very sparse factors, and the only one that takes complex matrices as they are: see
`lietool bench interp --solvers`.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp.terms import Pattern
from lietool.mesh import elimination

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Places = tuple[Index, NDArray[np.int32], NDArray[np.int32]]

GOOD = 1e-13
"""A solution with a larger relative residual is improved once."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Which entries of the matrix go where once it is cut and reordered.

    Parameters
    ----------
    count : int
        Vertices.
    real : bool
        Unknowns are x and y of all vertices, not complex numbers.
    ordered : bool
        Whether the free unknowns are in the order of elimination.
    free, fixed : ndarray of int
        The unknowns that are solved for, and those that are given.
    inner, cross : tuple of ndarray
        Positions in the source of entries, row indices and column pointers of the matrix among the free
        unknowns, and from the fixed to the free.
    """

    count: int
    real: bool
    ordered: bool
    free: Index
    fixed: Index
    inner: Places
    cross: Places

    def source(self, entries: NDArray[Any]) -> NDArray[Any]:
        """Return the entries of which the matrix is made."""
        if not self.real:
            return entries
        real, imag = np.real(entries), np.imag(entries)
        return np.concatenate([real, imag, -imag])


def layout(matrix: Pattern, v: Complex, fixed: Index, real: bool, ordered: bool) -> Layout:
    """Return the layout of a system.

    Parameters
    ----------
    matrix : Pattern
    v : ndarray of complex, shape (n,)
        Where the vertices are at rest.
    fixed : ndarray of int
        The vertices whose places are given.
    real : bool
        Whether the unknowns are to be x and y.
    ordered : bool
        Whether to look for an order of elimination that serves every frame; large systems need one anyway.

    Returns
    -------
    Layout
    """
    from scipy.sparse import csc_array

    n, size = matrix.count, matrix.count + 2 * len(matrix.ends)
    row, column = matrix.places
    # Counted from 1: a position 0 would be dropped as an entry that is not there.
    number = np.arange(1, size + 1)
    if real:
        # The matrix of a complex number, [[x, -y], [y, x]], from the source (x, y, -y).
        row = np.concatenate([row, row, row + n, row + n])
        column = np.concatenate([column, column + n, column, column + n])
        number = np.concatenate([number, number + 2 * size, number + size, number])
        fixed, n = np.concatenate([fixed, fixed + n]), 2 * n
    whole = csc_array((number, (row, column)), (n, n))
    free = np.setdiff1d(np.arange(n), fixed)
    if ordered := ordered or len(free) >= elimination.LARGE:
        x = np.tile(np.stack([v.real, v.imag], axis=1), (2 if real else 1, 1))
        free = free[elimination.order(csc_array(whole[free][:, free]), x[free])]
    below = whole[free]
    inner, cross = (_places(below[:, columns]) for columns in (free, fixed))
    return Layout(matrix.count, real, ordered, free, fixed, inner, cross)


def _places(part: Any) -> Places:
    part.sort_indices()
    return part.data - 1, part.indices.astype(np.int32), part.indptr.astype(np.int32)


class Factor:
    """A factored system.

    Parameters
    ----------
    at : Layout
    entries : ndarray, shape (entries of the pattern,)
        Of H, real or complex.
    rows : ndarray, shape (k, unknowns)
        The conditions U that stand beside the matrix.
    delta : ndarray, shape (k,)
    """

    def __init__(self, at: Layout, entries: NDArray[Any], rows: Array, delta: Array):
        from scipy.sparse import csc_array

        self.at = at
        source, free, fixed = at.source(entries), len(at.free), len(at.fixed)
        place, indices, indptr = at.inner
        self.inner = csc_array((source[place], indices, indptr), (free, free))
        place, indices, indptr = at.cross
        self.cross = csc_array((source[place], indices, indptr), (free, fixed))
        # Where every vertex is given there is nothing to solve.
        self.solver = elimination.superlu(self.inner, at.ordered) if free else None
        self.norm = float(np.max(abs(self.inner).sum(axis=0), initial=0.0))
        self.rows, self.rows_fixed, self.delta = rows[:, at.free], rows[:, at.fixed], delta
        self.beside = self._base(self.rows.astype(self.inner.dtype)) if len(rows) else self.rows
        self.schur = self.rows @ self.beside.T + np.diag(delta)

    def solve(self, b: Complex, values: NDArray[Any], given: Complex) -> tuple[Complex, Array]:
        """Solve for many right sides.

        Parameters
        ----------
        b : ndarray of complex, shape (T, n)
        values : ndarray, shape (T, k)
            What the conditions beside the matrix ask for.
        given : ndarray of complex, shape (T, fixed vertices)

        Returns
        -------
        v : ndarray of complex, shape (T, n)
        residual : ndarray, shape (T,)
            Relative to the norms of the matrix and of the solution.
        """
        if self.at.real:
            z, residual = self._solve(_beside(b), np.real(values), _beside(given))
            return z[:, : self.at.count] + 1j * z[:, self.at.count :], residual
        if np.iscomplexobj(self.inner.data):
            return self._solve(b, values, given)
        # A real matrix: the real parts of all right sides, then the imaginary ones.
        z, residual = self._solve(*(np.concatenate([np.real(x), np.imag(x)]) for x in (b, values, given)))
        T = len(b)
        return z[:T] + 1j * z[T:], np.maximum(residual[:T], residual[T:])

    def _solve(
        self, b: NDArray[Any], values: NDArray[Any], given: NDArray[Any]
    ) -> tuple[NDArray[Any], Array]:
        right = b[:, self.at.free]
        if given.shape[1]:
            right -= (self.cross @ given.T).T
            values = values - given @ self.rows_fixed.T
        z, mu = self._bordered(right, values)
        residual, rest, miss = self._residual(z, mu, right, values)
        if (poor := residual > GOOD).any():
            dz, dmu = self._bordered(rest[poor], miss[poor])
            z[poor], mu[poor] = z[poor] + dz, mu[poor] + dmu
            residual[poor] = self._residual(z[poor], mu[poor], right[poor], values[poor])[0]
        whole = np.empty(b.shape, z.dtype)
        whole[:, self.at.free], whole[:, self.at.fixed] = z, given
        return whole, residual

    def _base(self, b: NDArray[Any]) -> NDArray[Any]:
        return self.solver.solve(b.T).T if self.solver else b

    def _bordered(self, b: NDArray[Any], d: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        z = self._base(b)
        if not len(self.rows):
            return z, d
        mu = np.linalg.solve(self.schur, (z @ self.rows.T - d).T).T
        return z - mu @ self.beside, mu

    def _residual(
        self, z: NDArray[Any], mu: NDArray[Any], b: NDArray[Any], d: NDArray[Any]
    ) -> tuple[Array, NDArray[Any], NDArray[Any]]:
        """The relative residual of each right side, and what is left of both kinds of equations."""
        rest = b - (self.inner @ z.T).T - mu @ self.rows
        miss = d - z @ self.rows.T + self.delta * mu
        reach = _largest(z)
        scale = self.norm * reach + _largest(b)
        missed = _largest(miss) / np.maximum(np.maximum(_largest(d), reach), 1e-300)
        return np.maximum(_largest(rest) / np.maximum(scale, 1e-300), missed), rest, miss


def _largest(x: NDArray[Any]) -> Array:
    if np.iscomplexobj(x):
        return np.sqrt(np.max(np.real(x) ** 2 + np.imag(x) ** 2, axis=1, initial=0.0))
    return np.maximum(np.max(x, axis=1, initial=0.0), -np.min(x, axis=1, initial=0.0))


def _beside(v: Complex) -> Array:
    return np.concatenate([v.real, v.imag], axis=1)
