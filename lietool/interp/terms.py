"""The energy of a whole shape: one Hermitian form for each triangle, summed into a sparse matrix.

With v = x + i y the map of a triangle depends complex-linearly on its corners, (beta, gamma) = K v, so that
every energy of `energy` is a Hermitian form in n complex numbers instead of a symmetric one in 2 n reals.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp import energy, triangle
from lietool.interp.energy import Energy, Form, Metric

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Term:
    """A sum of the triangles' errors, from one of the two shapes.

    Parameters
    ----------
    energy : Energy
    K : ndarray of complex, shape (2, 2, m)
        From two sides of a triangle, v_1 - v_3 and v_2 - v_3, to the coordinates (beta, gamma) of its map.
    G : Metric
        With the triangle's weight in it.
    maps : callable
        From a time to the coordinates (2, m) of the maps to be reached.
    """

    energy: Energy
    K: Complex
    G: Metric
    maps: Callable[[float], Complex]

    def coordinates(self, corners: Complex) -> Complex:
        """Return the coordinates (2, m) of the maps that put the triangles' corners at (3, m)."""
        u = corners[:2] - corners[2]
        return self.K[:, 0] * u[0] + self.K[:, 1] * u[1]

    def form(self, t: float) -> Form:
        """Return the errors at a time as forms in the coordinates of the maps."""
        return energy.form(self.energy, self.G, self.maps(t))

    def blocks(self, form: Form) -> Complex:
        """Return the Hermitian 3 x 3 matrix of every triangle; shape (3, 3, m)."""
        K = self.K
        U = form.first * K[0] + form.mixed * K[1]
        W = np.conj(form.mixed) * K[0] + form.second * K[1]
        first, second = ((np.conj(K[0, i]) * U[i] + np.conj(K[1, i]) * W[i]).real for i in (0, 1))
        mixed = np.conj(K[0, 0]) * U[1] + np.conj(K[1, 0]) * W[1]
        # Moving the triangle changes nothing, so that every row and every column sums to zero.
        M = np.empty((3, 3, len(first)), complex)
        M[0, 0], M[1, 1], M[0, 1] = first, second, mixed
        M[0, 2], M[1, 2] = -first - mixed, -second - np.conj(mixed)
        M[2, 2] = first + second + 2.0 * mixed.real
        for i, j in ((0, 1), (0, 2), (1, 2)):
            M[j, i] = np.conj(M[i, j])
        return M

    def pull(self, form: Form) -> Complex:
        """Return the right side of every triangle; shape (3, m)."""
        b = np.conj(self.K[0]) * form.r[0] + np.conj(self.K[1]) * form.r[1]
        return np.concatenate([b, -b.sum(axis=0, keepdims=True)])


def sides_to_map(corners: Complex) -> Complex:
    """Return the matrices K (2, 2, m) of triangles (3, m): where two sides go gives (beta, gamma).

    Book: (5.2)
    """
    e1, e2 = corners[0] - corners[2], corners[1] - corners[2]
    c1, c2 = np.conj(e1), np.conj(e2)
    return np.stack([np.stack([c2, -c1]), np.stack([-e2, e1])]) / (e1 * c2 - c1 * e2)


def term(error: Energy, corners: Complex, weights: Array, maps: Callable[[float], Complex]) -> Term:
    """Return the sum of errors over triangles with corners (3, m) in the shape that the maps start from."""
    real = np.stack([corners.real, corners.imag], axis=-1).swapaxes(0, 1)
    return Term(error, sides_to_map(corners), energy.metric(error, real).scaled(weights), maps)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Where the triangles' entries go in a sparse matrix with sorted columns.

    Parameters
    ----------
    place : ndarray of int, shape (3, 3, m)
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

    def add(self, blocks: NDArray, at: Index | None = None) -> NDArray[Any]:
        """Return the entries of the matrix that is the sum of all blocks."""
        place = (self.place if at is None else at).ravel()
        size = len(self.indices)
        total = np.bincount(place, blocks.real.ravel(), size)
        return (
            total + 1j * np.bincount(place, blocks.imag.ravel(), size) if np.iscomplexobj(blocks) else total
        )

    def locate(self, row: Index, column: Index) -> Index:
        """Return the positions of entries that the matrix has."""
        keys = np.repeat(np.arange(self.count), np.diff(self.indptr)) * self.count + self.indices
        return np.searchsorted(keys, column * self.count + row)


def pattern(F: Index, count: int, extra: Index) -> Pattern:
    """Return where triangles (m, 3) and further entries (k, 2) go; all diagonal entries are there."""
    rows = np.broadcast_to(F.T[:, None, :], (3, 3, len(F)))
    columns = np.broadcast_to(F.T[None, :, :], (3, 3, len(F)))
    own = np.arange(count)
    key = np.concatenate(
        [(columns * count + rows).ravel(), own * count + own, extra[:, 1] * count + extra[:, 0]]
    )
    found, place = np.unique(key, return_inverse=True)
    indptr = np.searchsorted(found, np.arange(count + 1) * count)
    triangles = place[: 9 * len(F)].reshape(3, 3, len(F))
    diagonal = place[9 * len(F) : 9 * len(F) + count]
    return Pattern(triangles, (found % count).astype(np.int32), indptr.astype(np.int32), diagonal)


def homotopy_coordinates(A: Array, theta: Array, homotopy: triangle.Homotopy) -> Callable[[float], Complex]:
    """Return the function from a time to the coordinates (2, m) of the maps on their way."""

    def maps(t: float) -> Complex:
        return np.stack(triangle.coordinates(homotopy(A, t, theta)))

    return maps
