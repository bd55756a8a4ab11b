"""A triangle mesh in space: what belongs to it, its areas and normals, and what is wrong with it, by name."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import laplacian, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

CHANNELS = ("red", "green", "blue", "alpha")
"""The names of colours among the numbers of vertices."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh with what a file said of it.

    Parameters
    ----------
    vertices : ndarray, shape (n, 3)
        In the order of the file.
    faces : ndarray of int, shape (m, 3)
        Counter-clockwise seen from outside.
    uv : ndarray, shape (t, 2), optional
        Texture coordinates; a vertex has several where the texture has a seam.
    uv_faces : ndarray of int, shape (m, 3), optional
        Which of them each corner has; -1 where it has none.
    colours : ndarray, shape (n, 3) or (n, 4), optional
        Red, green, blue and perhaps opacity of the vertices, from 0 to 1.
    attributes : dict of str to ndarray, shape (n,)
        Further numbers of the vertices, such as painted weights.
    """

    vertices: Array
    faces: Index
    uv: Array | None = None
    uv_faces: Index | None = None
    colours: Array | None = None
    attributes: dict[str, Array] = field(default_factory=dict)

    @property
    def numbers(self) -> dict[str, Array]:
        """All numbers of the vertices by name: red, green, blue, alpha, as far as there are, then others."""
        colours = np.zeros((len(self.vertices), 0)) if self.colours is None else self.colours
        return dict(zip(CHANNELS, colours.T, strict=False)) | self.attributes

    def moved(self, vertices: ArrayLike) -> "Mesh":
        """Return the mesh with its vertices (n, 3) elsewhere, and all else as it was.

        Raises
        ------
        ValueError
            If there are more or fewer of them, or one is not finite.
        """
        V = topology.vertices("surface.Mesh.moved", "vertices", vertices, 3)
        if len(V) != len(self.vertices):
            must = f"the {len(self.vertices)} vertices of the mesh"
            topology.fail("surface.Mesh.moved", "vertices", must, f"{len(V)}")
        return replace(self, vertices=V)


@dataclass(frozen=True, eq=False)
class Health:
    """What a deformer may stumble over in a mesh.

    Parameters
    ----------
    components : int
        Connected parts, of the vertices that faces use.
    part : ndarray of int, shape (n,)
        In which of them each vertex is; -1 where no face uses it.
    unused : ndarray of int
        The vertices that no face uses.
    flat : ndarray of int
        The faces without an area.
    boundary : int
        Edges of one face.
    crowded : ndarray of int, shape (k, 2)
        Edges of three faces or more, the smaller vertex first.
    twisted : ndarray of int, shape (k, 2)
        Edges of two faces that run through them the same way: one of these is inside out.
    doubles : int
        Vertices at the place of an earlier one.
    """

    components: int
    part: Index
    unused: Index
    flat: Index
    boundary: int
    crowded: Index
    twisted: Index
    doubles: int

    @property
    def closed(self) -> bool:
        """Whether it is a closed, oriented surface."""
        return self.boundary == 0 and not len(self.crowded) and not len(self.twisted)


def health(V: ArrayLike, F: ArrayLike) -> Health:
    """Return what there is to know of a mesh before it is deformed.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    Health

    Raises
    ------
    ValueError
        If V is not finite or F has an index out of range.
    """
    V, F = laplacian.checked("surface.health", V, F, flat=True)
    n = len(V)
    half = topology.half_edges(F)
    half = half[half[:, 0] != half[:, 1]]
    low, high = half.min(axis=1), half.max(axis=1)
    key, place, count = np.unique(low * n + high, return_inverse=True, return_counts=True)
    turn = np.abs(np.bincount(place, np.where(half[:, 0] < half[:, 1], 1.0, -1.0), len(key)))
    ends = np.stack([key // n, key % n], axis=1)
    used = np.bincount(F.ravel(), minlength=n) > 0
    _, label = topology.components(n, half)
    part = np.full(n, -1)
    part[used] = np.unique(label[used], return_inverse=True)[1]
    flat = np.flatnonzero(laplacian.degenerate(V, F))
    crowded, twisted = ends[count > 2], ends[(count == 2) & (turn > 0.0)]
    boundary, doubles = int(np.sum(count == 1)), n - len(weld(V)[0])
    return Health(int(part.max()) + 1, part, np.flatnonzero(~used), flat, boundary, crowded, twisted, doubles)


def areas(V: ArrayLike, F: ArrayLike) -> Array:
    """Return the areas (m,) of the faces.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    area : ndarray, shape (m,)

    Raises
    ------
    ValueError
        If V is not finite or F has an index out of range.
    """
    V, F = laplacian.checked("surface.areas", V, F, flat=True)
    return 0.5 * np.linalg.norm(topology.area_normals(V, F), axis=1)


def face_normals(V: ArrayLike, F: ArrayLike) -> Array:
    """Return the unit normals (m, 3) of the faces; 0 for those without an area.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    normal : ndarray, shape (m, 3)

    Raises
    ------
    ValueError
        If V is not finite or F has an index out of range.
    """
    V, F = laplacian.checked("surface.face_normals", V, F, flat=True)
    normal = _unit(topology.area_normals(V, F))
    normal[laplacian.degenerate(V, F)] = 0.0
    return normal


def vertex_normals(V: ArrayLike, F: ArrayLike) -> Array:
    """Return unit normals (n, 3) at the vertices, means of those of faces weighted with areas.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    normal : ndarray, shape (n, 3)
        0 where no face uses the vertex, or its faces have no area.

    Raises
    ------
    ValueError
        If V is not finite or F has an index out of range.
    """
    V, F = laplacian.checked("surface.vertex_normals", V, F, flat=True)
    cross = np.repeat(topology.area_normals(V, F), 3, axis=0)
    corner = F.ravel()
    total = np.stack([np.bincount(corner, cross[:, a], len(V)) for a in range(3)], axis=1)
    return _unit(total.astype(float, copy=False))


def without_flat(mesh: Mesh) -> tuple[Mesh, Index]:
    """Return a mesh without its faces of no area, and which these were.

    Parameters
    ----------
    mesh : Mesh

    Returns
    -------
    mesh : Mesh
        With the same vertices, some of which no face may use any more.
    removed : ndarray of int
    """
    flat = laplacian.degenerate(mesh.vertices, mesh.faces)
    kept = None if mesh.uv_faces is None else mesh.uv_faces[~flat]
    return replace(mesh, faces=mesh.faces[~flat], uv_faces=kept), np.flatnonzero(flat)


def weld(V: ArrayLike) -> tuple[Index, Index]:
    """Return the first vertex at each place, and for each vertex the number of its place.

    Vertices are at one place if their coordinates are equal, to the last bit but for the sign of 0.  Files
    for printing and for games repeat vertices; V[first], place[F] is the mesh without, and W[place] takes
    what was found for it back.

    Parameters
    ----------
    V : array_like, shape (n, 3)

    Returns
    -------
    first : ndarray of int, shape (k,)
        Ascending: places are numbered as their first vertices come.
    place : ndarray of int, shape (n,)

    Raises
    ------
    ValueError
        If V is not finite.
    """
    V = topology.vertices("surface.weld", "V", V, 3)
    order = np.lexsort(V.T)
    new = np.ones(len(V), bool)
    new[1:] = np.any(V[order[1:]] != V[order[:-1]], axis=1)
    # The sort is stable, so that the first of a group is the one of the smallest index.
    group = np.empty(len(V), np.intp)
    group[order] = np.cumsum(new) - 1
    head = order[new]
    rank = np.empty(len(head), np.intp)
    rank[np.argsort(head)] = np.arange(len(head))
    return np.sort(head), rank[group]


def _unit(x: Array) -> Array:
    size = np.linalg.norm(x, axis=1, keepdims=True)
    return x / np.where(size > 0.0, size, 1.0)
