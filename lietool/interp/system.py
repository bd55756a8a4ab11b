"""The linear system of an interpolation: what is known before any frame, and the solution of a frame.

The minimum of v* H v - 2 Re(v* b) under conditions U v = d is

    H v + U* mu = b,    U v - Delta mu = d,

with Delta = 0 for an exact condition and 1/c for one of weight c.  Vertices that follow a path exactly are
taken out, conditions on few vertices with a weight go into H, and the others stand beside the matrix: they
are few, and each costs one more right side.  A condition on a direction is real, and then the system is written in x and y.

Where nothing in H holds a part of the shape, anchors do: a weight on one or two vertices, which a further
condition takes back again, so that H can be factored whatever holds the shape.

The order of elimination is found once.  With it the factors of a new frame have the pattern of the old.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp.constraint import Rows
from lietool.interp.terms import Pattern

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Layout:
    """Which entries of the matrix go where once it is cut and reordered.

    Parameters
    ----------
    count : int
        Vertices.
    real : bool
        Unknowns are x and y of all vertices, not complex numbers.
    free, fixed : ndarray of int
        The unknowns that are solved for, in the order of elimination, and those that are given.
    inner, cross : tuple of ndarray
        Positions in the source of entries, row indices and column pointers of the matrix among the free
        unknowns, and from the fixed to the free.
    """

    count: int
    real: bool
    free: Index
    fixed: Index
    inner: tuple[Index, NDArray[np.int32], NDArray[np.int32]]
    cross: tuple[Index, NDArray[np.int32], NDArray[np.int32]]

    def source(self, entries: NDArray[Any]) -> NDArray[Any]:
        """Return the entries of which the matrix is made."""
        return np.concatenate([entries.real, entries.imag, -entries.imag]) if self.real else entries

    def split(self, v: Complex) -> NDArray[Any]:
        """Return the unknowns of vertices (n, ...)."""
        return np.concatenate([v.real, v.imag]) if self.real else v

    def join(self, z: NDArray[Any]) -> Complex:
        """Return the vertices of unknowns."""
        return z[: self.count] + 1j * z[self.count :] if self.real else z.astype(complex, copy=False)


def layout(matrix: Pattern, fixed: Index, real: bool) -> Layout:
    """Return the layout of a system, with an order of elimination that keeps its factors sparse."""
    from scipy.sparse import csc_array, vstack
    from scipy.sparse import hstack as beside

    n, size = matrix.count, len(matrix.indices)

    def numbered(first: int) -> csc_array:
        # Counted from 1: a position 0 would be dropped as an entry that is not there.
        data = np.arange(first + 1, first + size + 1)
        return csc_array((data, matrix.indices, matrix.indptr), (n, n))

    whole: Any = numbered(0)
    if real:
        whole = vstack(
            [beside([numbered(0), numbered(2 * size)]), beside([numbered(size), numbered(0)])], format="csc"
        )
        fixed = np.concatenate([fixed, fixed + n])
    unknowns = whole.shape[0]
    free = np.setdiff1d(np.arange(unknowns), fixed)
    free = free[_order(csc_array(whole[free][:, free]))]
    parts = []
    for columns in (free, fixed):
        part: Any = csc_array(whole[free][:, columns])
        part.sort_indices()
        parts.append((part.data - 1, part.indices.astype(np.int32), part.indptr.astype(np.int32)))
    return Layout(n, real, free, fixed, parts[0], parts[1])


def _order(pattern: Any) -> Index:
    """Return an order of elimination for a symmetric pattern: minimum degree, as SuperLU finds it."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    n = pattern.shape[0]
    if not n:
        return np.zeros(0, np.intp)
    # A matrix of this pattern that is diagonally dominant: only the pattern matters.
    data = np.where(pattern.indices == np.repeat(np.arange(n), np.diff(pattern.indptr)), float(n), -1e-3)
    factor = splu(
        csc_array((data, pattern.indices, pattern.indptr), (n, n)),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    # perm_c tells where each column goes; its inverse lists the columns in their order.
    return np.argsort(factor.perm_c)


class Factor:
    """A factored frame: the matrix among the free unknowns, and the conditions beside it."""

    def __init__(self, at: Layout, entries: NDArray, rows: NDArray, delta: Array) -> None:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        source = at.source(entries)
        n, m = len(at.free), len(at.fixed)
        self.at = at
        self.inner = csc_array((source[at.inner[0]], *at.inner[1:]), (n, n))
        self.cross = csc_array((source[at.cross[0]], *at.cross[1:]), (n, m))
        self.solver = splu(
            self.inner, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
        self.rows, self.rows_fixed = rows[:, at.free], rows[:, at.fixed]
        self.delta = delta
        self.beside = self._base(np.conj(self.rows.T)) if len(rows) else np.zeros((n, 0))
        self.schur = self.rows @ self.beside + np.diag(delta)

    def _base(self, b: NDArray[Any]) -> NDArray[Any]:
        b = np.ascontiguousarray(b)
        if np.iscomplexobj(b) and not np.iscomplexobj(self.inner.data):
            return self.solver.solve(b.real) + 1j * self.solver.solve(b.imag)
        return self.solver.solve(b.astype(self.inner.dtype, copy=False))

    def _bordered(self, b: NDArray, d: NDArray[Any]) -> tuple[NDArray, NDArray[Any]]:
        z = self._base(b)
        if not len(self.rows):
            return z, d
        mu = np.linalg.solve(self.schur, self.rows @ z - d)
        return z - self.beside @ mu, mu

    def solve(self, b: Complex, values: NDArray, given: Complex) -> tuple[Complex, Array]:
        """Return the vertices, and the largest relative residual of each column.

        Parameters
        ----------
        b : ndarray of complex, shape (n, T)
        values : ndarray, shape (rows, T)
            What the conditions beside the matrix ask for.
        given : ndarray of complex, shape (fixed vertices, T)
        """
        at = self.at
        known = np.concatenate([given.real, given.imag]) if at.real else given
        right = at.split(b)[at.free] - self.cross @ known
        d = values - self.rows_fixed @ known
        z, mu = self._bordered(right, d)
        residual, rest = self._residual(z, mu, right, d)
        if np.max(residual, initial=0.0) > 1e-13:
            dz, dmu = self._bordered(*rest)
            z, mu = z + dz, mu + dmu
            residual, _ = self._residual(z, mu, right, d)
        whole = np.zeros((len(at.free) + len(at.fixed), z.shape[1]), np.result_type(z, known))
        whole[at.free], whole[at.fixed] = z, known
        return at.join(whole), residual

    def _residual(
        self, z: NDArray, mu: NDArray, b: NDArray, d: NDArray
    ) -> tuple[Array, tuple[NDArray, NDArray[Any]]]:
        rest = b - self.inner @ z - np.conj(self.rows.T) @ mu
        miss = d - self.rows @ z + self.delta[:, None] * mu
        size = abs(self.inner) @ np.abs(z) + np.abs(b)
        scale = np.maximum(size.max(axis=0, initial=0.0), 1e-300)
        residual = np.abs(rest).max(axis=0, initial=0.0) / scale
        reach = np.maximum(np.abs(d).max(axis=0, initial=0.0), np.abs(z).max(axis=0, initial=0.0))
        miss_size = np.abs(miss).max(axis=0, initial=0.0) / np.maximum(reach, 1e-300)
        return np.maximum(residual, miss_size), (rest, miss)


def dense(rows: Rows, frame: int, chosen: Index, count: int, real: bool) -> NDArray[Any]:
    """Return chosen conditions of one frame as the rows of a matrix on the unknowns."""
    width = 2 * count if real else count
    out: list[NDArray[Any]] = []
    for k in chosen:
        f = np.zeros(count, complex)
        factor = rows.factors[k][frame if len(rows.factors[k]) > 1 else 0]
        if len(rows.columns[k]):
            f[rows.columns[k]] = factor
        else:
            f[:] = factor / count
        if not real:
            out.append(f)
            continue
        out.append(np.concatenate([f.real, -f.imag]))
        if not rows.real[k]:
            out.append(np.concatenate([f.imag, f.real]))
    return np.reshape(out, (-1, width))


def targets(rows: Rows, chosen: Index, real: bool) -> NDArray[Any]:
    """Return what chosen conditions ask for, in the order of `dense`; shape (rows, T)."""
    out: list[NDArray[Any]] = []
    for k in chosen:
        value = rows.values[k]
        out += [value] if not real else [value.real] if rows.real[k] else [value.real, value.imag]
    return np.reshape(out, (-1, rows.values.shape[1]))


def deltas(rows: Rows, chosen: Index, real: bool) -> Array:
    """Return 1 / weight of chosen conditions, in the order of `dense`."""
    out: list[Any] = []
    for k in chosen:
        out += [1.0 / rows.weights[k]] * (1 if not real or rows.real[k] else 2)
    return np.array(out, float)
