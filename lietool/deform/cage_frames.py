"""The elements of a cage and their tetrahedra: what tells an affine map from how the cage was moved.

Three ways to make them, each a function of the faces:

    faces     a face and, over its first corner, n / sqrt|n|, n = e1 x e2
    edges     both ends of an edge; over its middle the normal and, in the surface, the normal x the edge
    corners   a vertex, two successive neighbours, and over it the normal: as many as a vertex has faces

What is added to the cage's own points has the length sqrt|n| of a face (the root of the mean |n| of those
around an edge or a vertex), so a cage that is scaled has tetrahedra scaled in all directions.  A unit normal
keeps its length and does not: a cage scaled by 1.2 then has maps that scale by 1.2, 1.2 and 1.  Normals
of edges and vertices are the directions of the sums of n, areas' worth.

A face's map has det > 0, whatever the pose: its frame is e1, e2, e1 x e2.  So has an edge's.  That of a
corner has not where the vertex's normal comes to lie behind the corner's face.  Without area det is 0.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import adjacency
from lietool.lie import matrix_checks
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

CANCELLED = 1e-12
"""Of the areas that it is summed from: a shorter normal is the rounding of 0."""


@dataclass(frozen=True, eq=False)
class Elements:
    """The parts of a cage that carry a transformation each.

    Parameters
    ----------
    name : str
        "faces", "edges" or "corners".
    faces : ndarray of int, shape (m, 3)
        Those of the cage.
    points : ndarray of int, shape (p, 1, 2 or 3)
        The cage's vertices in the middle of which an element is: its rest centre.
    around : ndarray of int, shape (p, 1 or 2)
        The faces whose half spaces it looks into.
    ends : ndarray of int, shape (p, 3)
        The corners of the tetrahedron that the cage has; for edges the two ends, the first again.
    pairs : ndarray of int, shape (q, 2)
        Which elements are neighbours.
    """

    name: str
    faces: Index
    points: Index
    around: Index
    ends: Index
    pairs: Index

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.ends)


def faces(F: ArrayLike) -> Elements:
    """Return the faces as elements, neighbours across edges.

    Book: 7.2, Figure 7.6
    MEIS: 3.2

    Parameters
    ----------
    F : array_like of int, shape (m, 3)

    Returns
    -------
    elements : Elements
    """
    f = np.asarray(F, np.intp)
    every = np.arange(len(f))[:, None]
    return Elements("faces", f, f, every, f, adjacency.face_pairs(f))


def edges(F: ArrayLike) -> Elements:
    """Return the edges as elements, neighbours within faces.

    Parameters
    ----------
    F : array_like of int, shape (m, 3)
        A closed surface, oriented.

    Returns
    -------
    elements : Elements

    Raises
    ------
    ValueError
        If an edge has not two triangles.
    """
    f = np.asarray(F, np.intp)
    found = topology.edges("cage_frames.edges", f)
    if (found.sides < 0).any():
        k = int(np.argmax((found.sides < 0).any(axis=1)))
        got = f"one triangle at the edge of vertices {found.ends[k].tolist()}"
        topology.fail("cage_frames.edges", "F", "a closed surface", got)
    size = int(f.max()) + 1
    half = np.sort(topology.half_edges(f), axis=1)
    key = found.ends[:, 0] * size + found.ends[:, 1]
    of_face = np.searchsorted(key, half[:, 0] * size + half[:, 1]).reshape(-1, 3)
    pairs = topology.half_edges(of_face)
    ends = found.ends[:, [0, 1, 0]]
    return Elements("edges", f, found.ends, found.sides, ends, pairs)


def corners(F: ArrayLike) -> Elements:
    """Return the vertices as elements, one for each face they have: neighbours round a vertex and in a face.

    Parameters
    ----------
    F : array_like of int, shape (m, 3)

    Returns
    -------
    elements : Elements
    """
    f = np.asarray(F, np.intp)
    m = len(f)
    # Element 3 f + i is the corner i of the face f.
    ends = np.stack([f, np.roll(f, -1, axis=1), np.roll(f, -2, axis=1)], axis=-1).reshape(-1, 3)
    around = np.repeat(np.arange(m), 3)[:, None]
    within = topology.half_edges(np.arange(3 * m).reshape(-1, 3))
    # The next face round v after (v, a, b) is (v, b, c).
    size = int(f.max()) + 1
    leaves, comes = ends[:, 0] * size + ends[:, 1], ends[:, 0] * size + ends[:, 2]
    order = np.argsort(leaves, kind="stable")
    at = np.minimum(np.searchsorted(leaves[order], comes), 3 * m - 1)
    found = leaves[order][at] == comes
    round_ = np.stack([np.arange(3 * m), order[at]], axis=1)[found]
    return Elements("corners", f, ends[:, :1], around, ends, np.concatenate([within, round_]))


def centres(elements: Elements, V: Array) -> Array:
    """Return the middles of the elements: of a face, an edge, or the vertex.

    Parameters
    ----------
    elements : Elements
    V : ndarray, shape (k, 3)

    Returns
    -------
    centres : (p, 3)
    """
    return V[elements.points].mean(axis=1)


def tetrahedra(elements: Elements, V: ArrayLike) -> Array:
    """Return the tetrahedra of a cage, (p, 4, 3).

    Book: 7.2, Figure 7.6
    MEIS: 3.2, with a normal that scales

    Parameters
    ----------
    elements : Elements
    V : array_like, shape (k, 3)
        Where a face, or all faces around an edge or vertex, have no area, nothing is added.

    Returns
    -------
    tetrahedra : (p, 4, 3)

    Raises
    ------
    ValueError
        If V is not finite or the faces name a vertex that it lacks.
    """
    where = "cage_frames.tetrahedra"
    V = topology.vertices(where, "V", V, 3)
    F = elements.faces
    if F.max() >= len(V):
        topology.fail(where, "V", f"at least {int(F.max()) + 1} vertices", f"{len(V)}")
    n = topology.area_normals(V, F)
    size = np.linalg.norm(n, axis=-1)
    E = V[elements.ends]
    if elements.name == "faces":
        return np.concatenate([E, E[:, :1] + _sized(n, size)[:, None]], axis=1)
    if elements.name == "corners":
        number = np.bincount(F.ravel(), minlength=len(V))
        total = np.zeros_like(V)
        np.add.at(total, F, n[:, None])
        mean = np.bincount(F.ravel(), np.repeat(size, 3), len(V)) / np.maximum(number, 1)
        up = _sized(total, mean)[elements.ends[:, 0]]
        return np.concatenate([E, E[:, :1] + up[:, None]], axis=1)
    mean = size[elements.around].mean(axis=1)
    up = _sized(n[elements.around].sum(axis=1), mean)
    along = E[:, 1] - E[:, 0]
    beside = _sized(np.cross(up, along), mean)
    middle = E[:, :1] + 0.5 * along[:, None]
    return np.concatenate([E[:, :2], middle + up[:, None], middle + beside[:, None]], axis=1)


def _sized(direction: Array, area: Array) -> Array:
    """Return vectors of the directions given, of the lengths sqrt(area); 0 where there is no direction.

    Normals that cancel but for rounding, as where the surface folds onto itself, have none.
    """
    length = np.linalg.norm(direction, axis=-1)
    there = length > CANCELLED * area
    return np.where(there, np.sqrt(area) / np.where(there, length, 1.0), 0.0)[:, None] * direction


@dataclass(frozen=True, eq=False)
class Rest:
    """The tetrahedra at rest.

    Parameters
    ----------
    elements : Elements
    origin : ndarray, shape (p, 3)
        The first points.
    inverse : ndarray, shape (p, 3, 3)
        Of the matrices whose columns are the other points, seen from the first.
    """

    elements: Elements
    origin: Array
    inverse: Array


def rest(elements: Elements, V: ArrayLike) -> Rest:
    """Return the tetrahedra of a cage at rest, which must not be flat.

    Parameters
    ----------
    elements : Elements
    V : array_like, shape (k, 3)

    Returns
    -------
    rest : Rest

    Raises
    ------
    ValueError
        If V is not finite, or a tetrahedron is flat: a face without area, an edge at which the surface folds
        onto itself, a vertex whose normal lies in one of its faces.
    """
    T = tetrahedra(elements, V)
    sides = _sides(T)
    d = np.linalg.svd(sides, compute_uv=False)
    flat = ~(d[:, 2] > 1e3 * matrix_checks.UNDECIDED * d[:, 0])
    if flat.any():
        k = int(np.argmax(flat))
        got = f"a flat one at element {k} of {elements.name}, vertices {elements.ends[k].tolist()}"
        remedy = "Move these vertices, or take another kind of elements."
        topology.fail("cage_frames.rest", "V", "a cage with a volume in every tetrahedron", got, remedy)
    return Rest(elements, T[:, 0], np.asarray(np.linalg.inv(sides), np.float64))


def maps(at: Rest, V: ArrayLike) -> Array:
    """Return the affine maps that carry the tetrahedra at rest to those of a pose.

    Book: 7.2, Figure 7.6
    MEIS: 3.2

    Parameters
    ----------
    at : Rest
    V : array_like, shape (k, 3)
        The cage now.

    Returns
    -------
    A : (p, 4, 4)

    Raises
    ------
    ValueError
        If V is not finite or has too few vertices.
    """
    T = tetrahedra(at.elements, V)
    A = np.zeros((len(T), 4, 4))
    A[:, :3, :3] = _sides(T) @ at.inverse
    A[:, :3, 3] = T[:, 0] - np.einsum("pij,pj->pi", A[:, :3, :3], at.origin)
    A[:, 3, 3] = 1.0
    return A


def _sides(T: Array) -> Array:
    return np.swapaxes(T[:, 1:] - T[:, :1], 1, 2)
