"""A cage as a point sees it: how far each face and each of its edges is, and at what angle.

The integrals behind mean value and Green coordinates come down to these numbers (divergence theorem in the
plane of a face).  With n the outward unit normal of a face, x0 the foot of a point x in its plane, edge i
opposite corner i with unit direction e_i, m_i = e_i x n its normal within the plane, and H_i the height:

    h    = (p - x) . n            positive where x is on the inner side
    d_i  = (p_{i+1} - x) . m_i    positive where x0 is on the triangle's side; lambda_i(x0) = d_i / H_i
    s_i  = (p_{i+1} - x) . e_i    where edge i begins; it ends at s_i + l_i
    rho_i = sqrt(d_i^2 + h^2)     the distance from x to the edge's line
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

PAIRS = 60_000
"""Points times faces looked at at once: the temporary arrays then take some tens of megabytes."""

TINY = 1e-150
"""Stands for 0 in denominators, far below any distance that rounding leaves."""

ON_SURFACE = 2e-14
"""A point is on the cage if it is nearer than so much of the cage's size."""

BESIDE = 1e-3
"""Within so much of the cage's size the solid angles of the nearest faces have lost digits that matter."""


@dataclass(frozen=True, eq=False)
class Facets:
    """The faces of a cage, in coordinates about its middle.

    Parameters
    ----------
    vertices : ndarray, shape (k, 3)
        Less the middle.
    faces : ndarray of int, shape (m, 3)
    middle : ndarray, shape (3,)
    size : float
        The longest side of the bounding box.
    """

    vertices: Array
    faces: Index
    middle: Array
    size: float

    @cached_property
    def edge(self) -> Array:
        """The edges opposite the corners, (3, m, 3)."""
        P = self.vertices[self.faces]
        return np.stack([P[:, (i + 2) % 3] - P[:, (i + 1) % 3] for i in range(3)])

    @cached_property
    def length(self) -> Array:
        """Their lengths, (3, m)."""
        return np.linalg.norm(self.edge, axis=-1)

    @cached_property
    def direction(self) -> Array:
        """Their unit directions, (3, m, 3)."""
        return self.edge / self.length[..., None]

    @cached_property
    def area(self) -> Array:
        """The areas of the faces, (m,)."""
        return 0.5 * np.linalg.norm(np.cross(self.edge[0], self.edge[1]), axis=-1)

    @cached_property
    def normal(self) -> Array:
        """The outward unit normals, (m, 3)."""
        return np.cross(self.edge[0], self.edge[1]) / (2.0 * self.area)[:, None]

    @cached_property
    def across(self) -> Array:
        """The unit normals of the edges in the faces' planes, outward, (3, m, 3)."""
        return np.cross(self.direction, self.normal)

    @cached_property
    def height(self) -> Array:
        """The heights of the triangles over their edges, (3, m)."""
        return 2.0 * self.area / self.length

    @cached_property
    def foot(self) -> Array:
        """Where along edge i corner i has its foot, from the edge's beginning, (3, m)."""
        return np.stack([-np.sum(self.edge[(i + 2) % 3] * self.direction[i], axis=-1) for i in range(3)])

    @cached_property
    def gram(self) -> Array:
        """The scalar products of the edges' normals, (3, 3, m)."""
        return np.einsum("imc,jmc->ijm", self.across, self.across)

    @cached_property
    def corner(self) -> Array:
        """The first corners, (m, 3)."""
        return self.vertices[self.faces[:, 0]]


@dataclass(frozen=True, eq=False)
class View:
    """What c points see of m faces.

    Parameters
    ----------
    h : ndarray, shape (c, m)
    d, start, rho : ndarray, shape (3, c, m)
        d_i, s_i, rho_i.
    end : ndarray, shape (3, c, m)
        s_i + l_i.
    """

    h: Array
    d: Array
    start: Array
    end: Array
    rho: Array

    @cached_property
    def radius(self) -> Array:
        """The distances to the corners, (3, c, m)."""
        r = np.sqrt(self.start * self.start + self.rho * self.rho)
        return r[[2, 0, 1]]

    @cached_property
    def arc(self) -> Array:
        """The angles theta_i under which the edges appear, (3, c, m)."""
        return np.arctan2(self.rho * (self.end - self.start), self.rho * self.rho + self.start * self.end)


def facets(V: Array, F: Index) -> Facets:
    """Return the faces of a checked cage."""
    low, high = V.min(axis=0), V.max(axis=0)
    middle = 0.5 * (low + high)
    return Facets(V - middle, F, middle, float(np.max(high - low)))


def view(cage: Facets, points: Array) -> View:
    """Return what points (c, 3), less the cage's middle, see of it."""
    x = points.T
    h = np.sum(cage.corner * cage.normal, axis=-1) - (cage.normal @ x).T
    begin = np.stack([cage.vertices[cage.faces[:, (i + 1) % 3]] for i in range(3)])
    d = np.sum(begin * cage.across, axis=-1)[:, None] - np.swapaxes(cage.across @ x, 1, 2)
    s = np.sum(begin * cage.direction, axis=-1)[:, None] - np.swapaxes(cage.direction @ x, 1, 2)
    rho = np.maximum(np.sqrt(d * d + h * h), TINY)
    return View(h, d, s, s + cage.length[:, None], rho)


def chunks(cage: Facets, points: Array) -> Iterator[tuple[slice, View]]:
    """Yield parts of the points and what they see."""
    step = max(1, PAIRS // len(cage.faces))
    for begin in range(0, len(points), step):
        part = slice(begin, min(begin + step, len(points)))
        yield part, view(cage, points[part] - cage.middle)


def solid_angles(cage: Facets, seen: View) -> Array:
    """Return the solid angles of the faces (c, m), positive from inside (Van Oosterom and Strackee 1983)."""
    r = seen.radius
    dots = seen.start * seen.end + seen.rho * seen.rho
    low = r[0] * r[1] * r[2] + np.sum(dots * r, axis=0)
    return 2.0 * np.arctan2(2.0 * seen.h * cage.area, low)


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest points of a cage, for those points of a chunk that are near to it.

    Parameters
    ----------
    row : ndarray of int, shape (q,)
        Which points.
    face : ndarray of int, shape (q,)
    share : ndarray, shape (q, 3)
        Barycentric coordinates in the face.
    distance : ndarray, shape (q,)
    """

    row: Index
    face: Index
    share: Array
    distance: Array


def nearest(cage: Facets, seen: View, reach: float) -> Nearest:
    """Return the nearest surface points of all points that are within a distance of the cage."""
    row, face = np.nonzero(np.abs(seen.h) <= reach)
    h, d, s = seen.h[row, face], seen.d[:, row, face], seen.start[:, row, face]
    length = cage.length[:, face]
    t = np.clip(-s / length, 0.0, 1.0)
    along = s + t * length
    square = d * d + along * along
    i = np.argmin(square, axis=0)
    every = np.arange(len(row))
    share = np.zeros((3, len(row)))
    share[(i + 1) % 3, every], share[(i + 2) % 3, every] = 1.0 - t[i, every], t[i, every]
    inside = (d >= 0.0).all(axis=0)
    share = np.where(inside, d / cage.height[:, face], share)
    distance = np.sqrt(np.where(inside, 0.0, square[i, every]) + h * h)
    close = np.flatnonzero(distance <= reach)
    close = close[np.lexsort((face[close], distance[close], row[close]))]
    close = close[np.unique(row[close], return_index=True)[1]]
    return Nearest(row[close], face[close], share.T[close], distance[close])


def gather(cage: Facets, corners: Array) -> Array:
    """Return numbers of the vertices (c, k), summed from those of the faces' corners (3, c, m)."""
    from scipy.sparse import csr_array

    m, k = len(cage.faces), len(cage.vertices)
    total = np.zeros((k, corners.shape[1]))
    for i in range(3):
        pick = csr_array((np.ones(m), (cage.faces[:, i], np.arange(m))), shape=(k, m))
        total += pick @ corners[i].T
    return total.T
