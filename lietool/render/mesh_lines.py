"""Lines that belong to a mesh in space: its outline for an eye, its edges, creases, level lines and hatching.

All are rows of points with NaN between the lines, as `scene.Lines` takes them, and lie on the mesh; the
renderer leaves out what the mesh hides.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.render.camera import Box, Camera, project

Array = NDArray[np.float64]
Index = NDArray[np.intp]

CREASE = np.radians(40.0)
"""Between faces that meet at a larger angle, radians, a surface has a sharp edge."""

# Of a mesh's size, the shortest line of an outline.
_SHORTEST = 0.03


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a mesh with the faces on either side.

    Parameters
    ----------
    ends : ndarray of int, shape (e, 2)
    sides : ndarray of int, shape (e, 2)
        Two of the faces at each; the second is -1 at the boundary.
    opposite : ndarray of int, shape (e, 2)
        The corners of these faces that are not on the edge; -1 where there is no face.
    """

    ends: Index
    sides: Index
    opposite: Index


def edges(F: ArrayLike) -> Edges:
    """Return the edges of faces (m, 3), each once."""
    return _edges(np.asarray(F, np.intp).tobytes())


# One mesh is drawn in many poses, and in every frame of a film.
@lru_cache(maxsize=16)
def _edges(faces: bytes) -> Edges:
    F = np.frombuffer(faces, np.intp).reshape(-1, 3)
    if not len(F):
        none = np.zeros((0, 2), np.intp)
        return Edges(none, none, none)
    half = np.sort(np.stack([F, np.roll(F, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    tip = np.roll(F, -2, axis=1).ravel()
    key = half[:, 0] * (int(F.max()) + 1) + half[:, 1]
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    count = np.diff(first, append=len(order))
    pair = np.stack([order[first], order[np.minimum(first + 1, len(order) - 1)]], axis=1)
    inside = np.stack([np.ones(len(first), bool), count > 1], axis=1)
    sides = np.where(inside, pair // 3, -1)
    found = Edges(half[order[first]], sides, np.where(inside, tip[pair], -1))
    for array in (found.ends, found.sides, found.opposite):
        array.setflags(write=False)
    return found


def face_normals(V: ArrayLike, F: ArrayLike) -> Array:
    """Return unit normals (m, 3) of faces; 0 where a face has no area."""
    corners = np.asarray(V, float)[np.asarray(F, np.intp)]
    return unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def unit(vectors: ArrayLike) -> Array:
    """Return vectors (..., 3) brought to length 1; 0 stays."""
    vectors = np.asarray(vectors, float)
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)


def joined_pairs(first: ArrayLike, second: ArrayLike) -> Array:
    """Return segments between points (k, 3) and others, with NaN between them; shape (3 k, 3)."""
    first, second = np.asarray(first, float), np.asarray(second, float)
    return np.stack([first, second, np.full_like(first, np.nan)], axis=1).reshape(-1, 3)


def all_edges(V: ArrayLike, F: ArrayLike) -> Array:
    """Return every edge of a mesh."""
    ends = np.asarray(V, float)[edges(F).ends]
    return joined_pairs(ends[:, 0], ends[:, 1])


def creases(V: ArrayLike, F: ArrayLike, angle: float = CREASE) -> Array:
    """Return the boundary of a mesh and the edges at which its faces meet at a larger angle, radians."""
    V, found = np.asarray(V, float), edges(F)
    ends = V[found.ends[sharp(V, F, found, angle)]]
    return joined_pairs(ends[:, 0], ends[:, 1])


def sharp(V: ArrayLike, F: ArrayLike, found: Edges, angle: float = CREASE) -> NDArray[np.bool_]:
    """Return which edges are at the boundary or have a larger angle, radians, between their faces."""
    N = face_normals(V, F)
    turned = np.sum(N[found.sides[:, 0]] * N[found.sides[:, 1]], axis=1) < np.cos(angle)
    return turned | (found.sides[:, 1] < 0)


def contour(V: ArrayLike, F: ArrayLike, camera: Camera) -> Array:
    """Return the edges between faces that a camera sees from in front and from behind, and the boundary.

    Where a surface is hollow along such an edge it hides the edge itself, so that this one is left out.
    So is what hangs together for less than a part of the mesh's size: a dash that the eye cannot follow,
    where a flat place is seen from the side and rounding decides which way a face looks.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    camera : Camera

    Returns
    -------
    ndarray, shape (3 k, 3)
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp)
    found = edges(F)
    N = face_normals(V, F)
    middle = (V[F[:, 0]] + V[F[:, 1]] + V[F[:, 2]]) / 3.0
    front = np.sum(N * (camera.eye - middle), axis=1) > 0.0
    border = found.sides[:, 1] < 0
    # Few edges are left for what costs more.
    turns = np.flatnonzero(border | (front[found.sides[:, 0]] != front[found.sides[:, 1]]))
    if not len(turns):
        return np.zeros((0, 3))
    ends, side = V[found.ends[turns]], found.sides[turns, 0]
    bent = np.sum(N[side] * (V[found.opposite[turns, 1]] - ends[:, 0]), axis=1) < 0.0
    seen = np.linalg.norm(np.cross(unit(ends[:, 0] - camera.eye), ends[:, 1] - ends[:, 0]), axis=1)
    chain = chains(found.ends[turns])
    long = np.bincount(chain, seen)[chain] > _SHORTEST * np.linalg.norm(np.ptp(V, axis=0))
    ends = ends[border[turns] | (bent & long)]
    return joined_pairs(ends[:, 0], ends[:, 1])


def chains(ends: Index) -> Index:
    """Return for edges (k, 2) of vertices which of them hang together; numbered by their least vertex."""
    low = np.arange(int(ends.max(initial=-1)) + 1)
    while True:
        least = low[ends].min(axis=1)
        before = low.copy()
        np.minimum.at(low, ends.ravel(), np.repeat(least, 2))
        # Each follows the one that it points to, so that long chains take few rounds.
        low = low[low]
        if (low == before).all():
            return low[ends[:, 0]]


def level_lines(V: ArrayLike, F: ArrayLike, values: ArrayLike, levels: ArrayLike) -> Array:
    """Return the lines on a mesh where a function, linear on each face, has certain values.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    values : array_like, shape (n,)
    levels : array_like, shape (k,)

    Returns
    -------
    ndarray, shape (3 k, 3)
    """
    V, values = np.asarray(V, float), np.asarray(values, float)
    corners, at = V[np.asarray(F, np.intp)], values[np.asarray(F, np.intp)]
    parts = [_crossing(corners, at - level) for level in np.asarray(levels, float).ravel()]
    return np.concatenate([*parts, np.zeros((0, 3))])


def hatching(V: ArrayLike, F: ArrayLike, camera: Camera, box: Box, apart: float = 9.0) -> Array:
    """Return slanted lines over faces, everywhere equally far apart on the page.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
        Only the faces to be hatched.
    camera : Camera
    box : tuple of float
        Of the view on the page.
    apart : float
        Page units between neighbours.

    Returns
    -------
    ndarray, shape (3 k, 3)
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp)
    if not len(F):
        return np.zeros((0, 3))
    seen = project(camera, box, V)
    slant, depth = (seen[:, 0] + seen[:, 1]) / (np.sqrt(2.0) * apart), seen[:, 2]
    at, far = slant[F], depth[F]
    low, high = np.ceil(at.min(axis=1)).astype(int), np.floor(at.max(axis=1)).astype(int)
    count = np.maximum(high - low + 1, 0)
    row = np.repeat(np.arange(len(F)), count)
    level = low[row] + np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    # Times the depth, what is straight on the page is linear in space.
    return _crossing(V[F[row]], (at[row] - level[:, None]) * far[row])


def _crossing(corners: Array, values: Array) -> Array:
    """Segments across triangles (m, 3, 3) where a linear function with such values (m, 3) is 0."""
    up = values >= 0.0
    count = up.sum(axis=1)
    mixed = (count == 1) | (count == 2)
    corners, values, up, count = corners[mixed], values[mixed], up[mixed], count[mixed]
    # The corner that is alone on its side comes first.
    alone = np.argmax(up == (count == 1)[:, None], axis=1)
    turn = (alone[:, None] + np.arange(3)) % 3
    x = np.take_along_axis(values, turn, axis=1)
    P = np.take_along_axis(corners, turn[:, :, None], axis=1)
    ends = []
    for k in (1, 2):
        t = (x[:, 0] / (x[:, 0] - x[:, k]))[:, None]
        ends.append((1.0 - t) * P[:, 0] + t * P[:, k])
    return joined_pairs(*ends)
