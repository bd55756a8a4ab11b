"""The energy of a whole shape: one Hermitian form for each triangle, summed into a sparse matrix.

With v = x + i y the map of a triangle depends complex-linearly on its corners, (beta, gamma) = K v, so that every
energy of `energy` is a Hermitian form in n complex numbers instead of a symmetric one in 2 n real ones.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.interp import energy, triangle
from lietool.interp.energy import Energy

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Term:
    """A sum of the triangles' errors, from one of the two shapes.

    Parameters
    ----------
    energy : Energy
    K : ndarray of complex, shape (m, 2, 3)
        From the corners of a triangle to the coordinates (beta, gamma) of its map.
    G : ndarray of complex, shape (m, 2, 2)
        The metric, times the triangle's weight.
    maps : callable
        From a time to the coordinates (m, 2) of the maps to be reached.
    """

    energy: Energy
    K: Complex
    G: Complex
    maps: Callable[[float], Complex]

    def blocks(self, t: float) -> Complex:
        """Return the Hermitian 3 x 3 matrix of every triangle; shape (m, 3, 3)."""
        Q = energy.form(self.energy, self.G, self.maps(t))
        return np.einsum("mia,mij,mjb->mab", np.conj(self.K), Q, self.K, optimize=True)

    def pull(self, t: float) -> tuple[Complex, float]:
        """Return the right side of every triangle, (m, 3), and the constant of the error."""
        r, c = energy.pull(self.energy, self.G, self.maps(t))
        return np.einsum("mia,mi->ma", np.conj(self.K), r), float(c.sum())

    def errors(self, corners: Complex, t: float) -> Array:
        """Return the weighted error (m,) of every triangle with corners (m, 3)."""
        x, a = np.einsum("mia,ma->mi", self.K, corners), self.maps(t)
        r, c = energy.pull(self.energy, self.G, a)
        Q = energy.form(self.energy, self.G, a)
        square = np.einsum("mi,mij,mj->m", np.conj(x), Q, x, optimize=True).real
        return np.maximum(square - 2.0 * np.sum(np.conj(x) * r, axis=-1).real + c, 0.0)


def corners_to_map(corners: Complex) -> Complex:
    """Return the matrices K (m, 2, 3) of triangles with corners (m, 3): where these go gives (beta, gamma).

    Book: (5.2)
    """
    e1, e2 = corners[:, 0] - corners[:, 2], corners[:, 1] - corners[:, 2]
    c1, c2 = np.conj(e1), np.conj(e2)
    K = np.stack([np.stack([c2, -c1, c1 - c2], axis=-1), np.stack([-e2, e1, e2 - e1], axis=-1)], axis=1)
    return K / (e1 * c2 - c1 * e2)[:, None, None]


def term(error: Energy, corners: Complex, weights: Array, maps: Callable[[float], Complex]) -> Term:
    """Return the sum of errors over triangles with corners (m, 3) in the shape that the maps start from."""
    real = np.stack([corners.real, corners.imag], axis=-1)
    G = weights[:, None, None] * energy.metric(error, real)
    return Term(error, corners_to_map(corners), G, maps)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Where the triangles' entries go in a sparse matrix with sorted columns.

    Parameters
    ----------
    place : ndarray of int, shape (m, 3, 3)
        For each entry of each triangle, its position among the entries of the matrix.
    indices, indptr : ndarray of int
        Of the matrix, by columns.
    diagonal : ndarray of int, shape (n,)
        The positions of the diagonal.
    """

    place: Index
    indices: NDArray[np.int32]
    indptr: NDArray[np.int32]
    diagonal: Index

    @property
    def count(self) -> int:
        """The size of the matrix."""
        return len(self.indptr) - 1

    def add(self, blocks: NDArray, at: Index | None = None) -> NDArray:
        """Return the entries of the matrix that is the sum of all blocks."""
        place = (self.place if at is None else at).ravel()
        size = len(self.indices)
        total = np.bincount(place, blocks.real.ravel(), size)
        return total + 1j * np.bincount(place, blocks.imag.ravel(), size) if np.iscomplexobj(blocks) else total

    def locate(self, row: Index, column: Index) -> Index:
        """Return the positions of entries that the matrix has."""
        keys = np.repeat(np.arange(self.count), np.diff(self.indptr)) * self.count + self.indices
        return np.searchsorted(keys, column * self.count + row)


def pattern(F: Index, count: int, extra: Index) -> Pattern:
    """Return where triangles (m, 3) and further entries (k, 2) go; all diagonal entries are there."""
    rows = np.broadcast_to(F[:, :, None], (len(F), 3, 3))
    columns = np.broadcast_to(F[:, None, :], (len(F), 3, 3))
    own = np.arange(count)
    key = np.concatenate([(columns * count + rows).ravel(), own * count + own, extra[:, 1] * count + extra[:, 0]])
    found, place = np.unique(key, return_inverse=True)
    indptr = np.searchsorted(found, np.arange(count + 1) * count)
    triangles = place[: 9 * len(F)].reshape(len(F), 3, 3)
    diagonal = place[9 * len(F) : 9 * len(F) + count]
    return Pattern(triangles, (found % count).astype(np.int32), indptr.astype(np.int32), diagonal)


def homotopy_coordinates(A: Array, theta: Array, homotopy: triangle.Homotopy) -> Callable[[float], Complex]:
    """Return the function from a time to the coordinates (m, 2) of the maps on their way."""

    def maps(t: float) -> Complex:
        return np.stack(triangle.coordinates(homotopy(A, t, theta)), axis=-1)

    return maps
