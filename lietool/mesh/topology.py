"""Triangle meshes as arrays: what a mesh must be, its edges, who is whose neighbour, and where it ends."""

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]


LARGEST = 1e70
"""Of coordinates in space: squares of the areas of larger meshes overflow."""


def fail(where: str, name: str, must: str, got: str, remedy: str = "") -> NoReturn:
    """Raise the house's one-line ValueError."""
    raise ValueError(f"{where}: {name} must be {must}; got {got}.{' ' + remedy if remedy else ''}")


def vertices(where: str, name: str, V: ArrayLike, n: int = 2) -> Array:
    """Return V as finite float64 points (k, n), in space of at most LARGEST.

    Parameters
    ----------
    where, name : str
        Who asks, and what the argument is called, for the message.
    V : array_like, shape (k, n)
    n : int
        The dimension of the space.

    Returns
    -------
    V : (k, n)

    Raises
    ------
    ValueError
        If V has another shape, is not finite or too large.
    """
    try:
        a = np.asarray(V, float)
    except (TypeError, ValueError):
        fail(where, name, f"an array of numbers of shape (k, {n})", "something else")
    if a.ndim != 2 or a.shape[1] != n:
        fail(where, name, f"an array of shape (k, {n})", f"shape {a.shape}")
    bad = ~np.isfinite(a).all(axis=1)
    if bad.any():
        k = int(np.argmax(bad))
        fail(where, name, "finite", f"{a[k].tolist()} at vertex {k}")
    if n == 3 and (size := max(np.max(a, initial=0.0), -np.min(a, initial=0.0))) > LARGEST:
        fail(where, name, f"at most {LARGEST:g} in size", f"{size:.3g}", "Take another unit.")
    return a


def faces(where: str, F: ArrayLike, count: int) -> Index:
    """Return F as triangles (m, 3) of `count` vertices, each vertex used.

    Parameters
    ----------
    where : str
        Who asks, for the message.
    F : array_like of int, shape (m, 3)
    count : int
        How many vertices there are.

    Returns
    -------
    F : (m, 3), int

    Raises
    ------
    ValueError
        If F has another shape, an index out of range, a triangle with a vertex twice, or leaves a vertex out.
    """
    a = triangles(where, F, count)
    twice = (a[:, 0] == a[:, 1]) | (a[:, 1] == a[:, 2]) | (a[:, 2] == a[:, 0])
    if twice.any():
        k = int(np.argmax(twice))
        fail(where, "F", "three vertices in each triangle", f"{a[k].tolist()} at triangle {k}", "Remove it.")
    unused = np.bincount(a.ravel(), minlength=count) == 0
    if unused.any():
        k = int(np.argmax(unused))
        remedy = "Remove it, or give it a triangle."
        fail(where, "F", "a use of every vertex", f"none of vertex {k} ({int(unused.sum())} in all)", remedy)
    return a


def triangles(where: str, F: ArrayLike, count: int) -> Index:
    """Return F as triangles (m, 3) of some of `count` vertices; they may use a vertex twice.

    Raises
    ------
    ValueError
        If F has another shape, no triangle, or an index out of range.
    """
    try:
        a = np.asarray(F)
    except ValueError:
        fail(where, "F", "whole numbers of shape (m, 3)", "a ragged list")
    if a.ndim != 2 or a.shape[1:] != (3,) or a.dtype.kind not in "iu":
        fail(where, "F", "whole numbers of shape (m, 3)", f"{a.dtype} of shape {a.shape}")
    if not len(a):
        fail(where, "F", "at least one triangle", "none")
    a = a.astype(np.intp, copy=False)
    if a.min() < 0 or a.max() >= count:
        k = int(np.argmax(((a < 0) | (a >= count)).any(axis=1)))
        fail(where, "F", f"indices of the {count} vertices, from 0", f"{a[k].tolist()} at triangle {k}")
    return a


def areas(V: Array, F: Index) -> Array:
    """Return the signed areas (m,) of triangles of the plane, counter-clockwise ones positive."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def vertex_set(where: str, name: str, chosen: ArrayLike, count: int) -> Index:
    """Return some of `count` vertices as indices (k,), in the order given; there may be none.

    An array (count,) of true and false stands for those where it is true.

    Parameters
    ----------
    where, name : str
        Who asks, and what the argument is called, for the message.
    chosen : array_like of int, shape (k,)
    count : int

    Returns
    -------
    chosen : (k,), int

    Raises
    ------
    ValueError
        If they are no whole numbers of one axis, or one is no vertex.
    """
    try:
        a = np.asarray(chosen)
    except ValueError:
        fail(where, name, "whole numbers of shape (k,)", "a ragged list")
    if a.dtype.kind == "b" and a.shape == (count,):
        return np.flatnonzero(a)
    if a.ndim != 1 or (a.size and a.dtype.kind not in "iu"):
        fail(where, name, "whole numbers of shape (k,)", f"{a.dtype} of shape {a.shape}")
    a = a.astype(np.intp)
    outside = (a < 0) | (a >= count)
    if outside.any():
        fail(where, name, f"indices of the {count} vertices, from 0", f"{a[outside][0]}")
    return a


def distinct(where: str, name: str, chosen: Index) -> Index:
    """Return vertices (k,) as they are, if there is none twice among them.

    Raises
    ------
    ValueError
        If one is.
    """
    values, counts = np.unique(chosen, return_counts=True)
    if len(values) < len(chosen):
        fail(where, name, "distinct vertices", f"vertex {values[counts > 1][0]} twice")
    return chosen


def area_normals(V: Array, F: Index) -> Array:
    """Return the normals (m, 3) of triangles in space, as long as twice their areas."""
    return np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])


def half_edges(F: Index) -> Index:
    """Return the sides (3 m, 2) of triangles, three of each in turn, in its direction."""
    return F[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)


def edge_counts(F: Index) -> tuple[Index, Index]:
    """Return the edges (k, 2) of any triangles, sorted, the smaller index first, and how many have each."""
    half = np.sort(half_edges(F), axis=1)
    size = int(F.max()) + 1
    key, count = np.unique(half[:, 0] * size + half[:, 1], return_counts=True)
    return np.stack([key // size, key % size], axis=1), count


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a mesh.

    Parameters
    ----------
    ends : ndarray of int, shape (k, 2)
        The two vertices, the smaller index first.
    sides : ndarray of int, shape (k, 2)
        The triangles on both sides; -1 where the mesh ends.
    """

    ends: Index
    sides: Index

    @property
    def inner(self) -> Index:
        """The pairs of triangles (k, 2) that share an edge."""
        return self.sides[self.sides[:, 1] >= 0]


def edges(where: str, F: Index) -> Edges:
    """Return the edges of a mesh that no edge of which has more than two triangles.

    Raises
    ------
    ValueError
        If an edge has three triangles or more, or two that run through it in the same direction.
    """
    half = half_edges(F)
    owner = np.repeat(np.arange(len(F)), 3)
    size = int(F.max()) + 1
    key = half.min(axis=1) * size + half.max(axis=1)
    order = np.argsort(key, kind="stable")
    found, first, count = np.unique(key[order], return_index=True, return_counts=True)
    ends = np.stack([found // size, found % size], axis=1)
    if (count > 2).any():
        k = int(np.argmax(count > 2))
        got = f"{count[k]} at the edge of vertices {ends[k, 0]} and {ends[k, 1]}"
        fail(where, "F", "a surface, with one or two triangles at every edge", got)
    sides = np.full((len(found), 2), -1)
    sides[:, 0] = owner[order[first]]
    two = count == 2
    sides[two, 1] = owner[order[first[two] + 1]]
    forward = half[order][:, 0] < half[order][:, 1]
    same = two & (forward[first] == forward[np.minimum(first + 1, len(forward) - 1)])
    if same.any():
        k = int(np.argmax(same))
        got = f"triangles {sides[k, 0]} and {sides[k, 1]}, which run opposite ways round"
        fail(where, "F", "oriented alike", got, "Reverse one of them.")
    return Edges(ends, sides)


def components(count: int, pairs: Index) -> tuple[int, Index]:
    """Return the number of connected components of a graph, and the component of each of its nodes.

    Parameters
    ----------
    count : int
        How many nodes there are.
    pairs : ndarray of int, shape (k, 2)
        Which are joined.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), (count, count))
    number, labels = connected_components(graph, directed=False)
    return int(number), labels.astype(np.intp)


def parts(F: Index, count: int) -> tuple[int, Index]:
    """Return the number of connected parts of `count` vertices, and the part of each.

    A vertex that no triangle uses is a part by itself.
    """
    return components(count, F[:, [0, 1, 1, 2]].reshape(-1, 2))


def unheld(number: int, part: Index, held: Index) -> Index:
    """Return the first vertex of each part that has none of those that are held."""
    bare = np.bincount(part[held], minlength=number) == 0
    return np.unique(part, return_index=True)[1][bare]


def boundary(F: Index) -> list[Index]:
    """Return the boundary loops, each the vertices in the order of its triangles; the longest first.

    Raises
    ------
    ValueError
        If two parts of the boundary touch in one vertex.
    """
    half = half_edges(F)
    size = int(F.max()) + 1
    # A boundary edge is one whose reverse no triangle has.
    there, back = half[:, 0] * size + half[:, 1], half[:, 1] * size + half[:, 0]
    rim = half[~np.isin(there, back)]
    follow = np.full(size, -1)
    follow[rim[:, 0]] = rim[:, 1]
    if len(np.unique(rim[:, 0])) < len(rim):
        values, counts = np.unique(rim[:, 0], return_counts=True)
        fail("topology.boundary", "F", "a surface", f"two parts that touch in vertex {values[counts > 1][0]}")
    loops, left = [], set(rim[:, 0].tolist())
    while left:
        start = min(left)
        loop = [start]
        while (vertex := int(follow[loop[-1]])) != start:
            loop.append(vertex)
        left.difference_update(loop)
        loops.append(np.array(loop))
    return sorted(loops, key=len, reverse=True)
