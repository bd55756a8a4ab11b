"""The energy of a whole shape: one Hermitian form for each triangle, summed into a sparse matrix.

With v = x + i y the map of a triangle depends complex-linearly on its corners, (beta, gamma) = K v, so that
every energy of `energy` is a Hermitian form in n complex numbers instead of a symmetric one in 2 n reals.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp import energy
from lietool.interp.energy import Energy, Form, Metric

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]

PAIRS = ((0, 1), (0, 2), (1, 2))
"""The edges of a triangle, in the order of what stands off the diagonal of its matrix."""


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
    pull : sparse array of complex, shape (n, 2 m), or None
        From the maps to be reached to the right side of the system; None where that is zero.
    """

    energy: Energy
    K: Complex
    G: Metric
    maps: Callable[[float], Complex]
    pull: Any

    def coordinates(self, corners: Complex) -> Complex:
        """Return the coordinates (2, m) of the maps that put the triangles' corners at (3, m)."""
        u = corners[:2] - corners[2]
        return self.K[:, 0] * u[0] + self.K[:, 1] * u[1]

    def form(self, maps: Complex) -> Form:
        """Return the errors as forms in the coordinates of maps, given those to be reached (2, m)."""
        return energy.form(self.energy, self.G, maps)

    def blocks(self, form: Form) -> tuple[Array, Complex]:
        """Return the Hermitian 3 x 3 matrix of every triangle: diagonal (3, m), and the `PAIRS` (3, m)."""
        K = self.K
        U = form.first * K[0] + form.mixed * K[1]
        W = np.conj(form.mixed) * K[0] + form.second * K[1]
        first, second = (_inner(K[0, i], U[i]) + _inner(K[1, i], W[i]) for i in (0, 1))
        mixed = np.conj(K[0, 0]) * U[1] + np.conj(K[1, 0]) * W[1]
        # Moving the triangle changes nothing, so that every row and every column sums to zero.
        diagonal = np.stack([first, second, first + second + 2.0 * mixed.real])
        return diagonal, np.stack([mixed, -first - mixed, -second - np.conj(mixed)])


def _inner(z: Complex, w: Complex) -> Array:
    return z.real * w.real + z.imag * w.imag


def sides_to_map(corners: Complex) -> Complex:
    """Return the matrices K of triangles: where two sides go gives (beta, gamma).

    Book: (5.2)

    Parameters
    ----------
    corners : ndarray of complex, shape (3, m)

    Returns
    -------
    K : ndarray of complex, shape (2, 2, m)
    """
    e1, e2 = corners[0] - corners[2], corners[1] - corners[2]
    c1, c2 = np.conj(e1), np.conj(e2)
    return np.stack([np.stack([c2, -c1]), np.stack([-e2, e1])]) / (e1 * c2 - c1 * e2)


def term(error: Energy, v: Complex, F: Index, weights: Array, maps: Callable[[float], Complex]) -> Term:
    """Return the sum of errors over the triangles of the shape that the maps start from.

    Parameters
    ----------
    error : Energy
    v : ndarray of complex, shape (n,)
        The shape's vertices.
    F : ndarray of int, shape (m, 3)
    weights : ndarray, shape (m,)
    maps : callable
        From a time to the coordinates (2, m) of the maps to be reached.

    Returns
    -------
    Term
    """
    corners = v[F.T]
    K = sides_to_map(corners)
    G = energy.metric(error, np.stack([corners.real, corners.imag], axis=-1).swapaxes(0, 1)).scaled(weights)
    pull = None if error.is_similarity else _pull(K, G, error, F, len(v))
    return Term(error, K, G, maps, pull)


def _pull(K: Complex, G: Metric, error: Energy, F: Index, count: int) -> Any:
    """The map K* G, times the share of the error that does not depend on time, from triangles to vertices."""
    from scipy.sparse import csr_array

    w = np.asarray(error.rigid, float)
    p, q = w * G.p, w * G.q
    side = np.conj(K)
    first, second = side[0] * p + side[1] * np.conj(q), side[0] * q + side[1] * p
    parts = [np.concatenate([part, -part.sum(axis=0, keepdims=True)]) for part in (first, second)]
    rows = np.tile(F.T.ravel(), 2)
    columns = np.arange(2 * len(F)).reshape(2, 1, -1) + np.zeros((1, 3, 1), np.intp)
    entries = np.stack(parts).ravel()
    return csr_array((entries, (rows, columns.ravel())), (count, 2 * len(F)))


@dataclass(frozen=True, eq=False)
class Pattern:
    """Where the triangles' entries go among those of the sparse matrix, which is Hermitian.

    The entries are those of the diagonal, n of them, then one for each edge above and one below it.

    Parameters
    ----------
    faces : ndarray of int, shape (m, 3)
    edge : ndarray of int, shape (3, m)
        The number of each triangle's edges, in the order of `PAIRS`.
    falling : ndarray of bool, shape (3, m)
        Whether the first vertex of the pair has the larger index.
    ends : ndarray of int, shape (k, 2)
        The vertices of the edges, the smaller index first.
    count : int
        The number of vertices, n.
    """

    faces: Index
    edge: Index
    falling: NDArray[np.bool_]
    ends: Index
    count: int

    @property
    def places(self) -> tuple[Index, Index]:
        """The rows and the columns of the entries."""
        own, low, high = np.arange(self.count), self.ends[:, 0], self.ends[:, 1]
        return np.concatenate([own, low, high]), np.concatenate([own, high, low])

    def add(self, blocks: tuple[Array, Complex]) -> Complex:
        """Return the entries of the matrix that is the sum of the blocks of all triangles."""
        diagonal, pairs = blocks
        edge, many = self.edge.ravel(), len(self.ends)
        imag = np.where(self.falling, -pairs.imag, pairs.imag)
        upper = np.bincount(edge, pairs.real.ravel(), many) + 1j * np.bincount(edge, imag.ravel(), many)
        entries = np.empty(self.count + 2 * many, complex)
        entries[: self.count] = np.bincount(self.faces.T.ravel(), diagonal.ravel(), self.count)
        entries[self.count : -many], entries[-many:] = upper, np.conj(upper)
        return entries

    def locate(self, row: Index, column: Index) -> Index:
        """Return the positions of entries that the matrix has."""
        low, high = np.minimum(row, column), np.maximum(row, column)
        keys = self.ends[:, 0] * self.count + self.ends[:, 1]
        edge = np.searchsorted(keys, low * self.count + high)
        beside = self.count + edge + np.where(row > column, len(keys), 0)
        return np.where(row == column, row, beside)


def pattern(F: Index, count: int, extra: Index) -> Pattern:
    """Return the pattern of a matrix that has room for triangles and for further pairs of vertices.

    Parameters
    ----------
    F : ndarray of int, shape (m, 3)
    count : int
        The number of vertices.
    extra : ndarray of int, shape (k, 2)

    Returns
    -------
    Pattern
    """
    pairs = np.concatenate([F[:, list(pair)] for pair in PAIRS] + [extra])
    keys = pairs.min(axis=1) * count + pairs.max(axis=1)
    found, number = np.unique(keys, return_inverse=True)
    edge = number[: 3 * len(F)].reshape(3, -1)
    falling = np.stack([F[:, i] > F[:, j] for i, j in PAIRS])
    return Pattern(F, edge, falling, np.stack([found // count, found % count], axis=1), count)
