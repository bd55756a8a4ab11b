"""What a cage must be: a closed surface, oriented outwards, that does not pass through itself.

Mean value and Green coordinates are integrals over such a surface, and the half spaces of its faces mean
something only if they are its inner sides.  What is refused is named: the edge, the face, the component.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import cage_view
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_FLAT = 1e-12
"""A face is degenerate if its area is at most so much of the square of its longest edge."""

_PAIRS = 400_000
"""Edges times faces that are tried for crossing at once."""


def closed(where: str, V: ArrayLike, F: ArrayLike) -> tuple[Array, Index]:
    """Return a cage as arrays, if it is a closed surface oriented outwards that does not cross itself.

    A component may be turned inwards where it is the wall of a hollow, inside another.  Crossings of an edge
    with a face's interior are seen, touching is not.

    Parameters
    ----------
    where : str
        Who asks, for the message.
    V : array_like, shape (k, 3)
    F : array_like of int, shape (m, 3)
        Counter-clockwise, seen from outside.

    Returns
    -------
    V : (k, 3)
    F : (m, 3), int

    Raises
    ------
    ValueError
        If it is not.
    """
    V, F = surface(where, V, F)
    pairs = topology.edges(where, F)
    rim = pairs.sides[:, 1] < 0
    if rim.any():
        a, b = pairs.ends[int(np.argmax(rim))].tolist()
        remedy = "Close the cage, or call without one and take the enclosing cage."
        got = f"one triangle only at {int(rim.sum())} edges, first that of vertices {a} and {b}"
        topology.fail(where, "F", "a closed surface", got, remedy)
    _outward(where, V, F, pairs.inner)
    crossing = crossings(V, F, pairs.ends)
    if len(crossing):
        edge, face = crossing[0]
        got = f"{len(crossing)} crossings, first of the edge {pairs.ends[edge].tolist()} with face {face}"
        topology.fail(where, "V", "a cage that does not pass through itself", got)
    return V, F


def surface(where: str, V: ArrayLike, F: ArrayLike) -> tuple[Array, Index]:
    """Return vertices and faces as arrays, none of the faces degenerate.

    Raises
    ------
    ValueError
        If the arrays are not that, or a face has no area.
    """
    V = topology.vertices(where, "V", V, 3)
    F = topology.faces(where, F, len(V))
    sides = V[F[:, [1, 2, 0]]] - V[F]
    longest = np.max(np.sum(sides * sides, axis=-1), axis=-1)
    area = 0.5 * np.linalg.norm(topology.area_normals(V, F), axis=-1)
    flat = area <= _FLAT * longest
    if flat.any():
        k = int(np.argmax(flat))
        got = f"area {area[k]:.3g} at face {k}, vertices {F[k].tolist()} ({int(flat.sum())} in all)"
        topology.fail(where, "F", "faces with an area", got, "Remove or repair them.")
    return V, F


def volumes(V: Array, F: Index, component: Index) -> Array:
    """Return the volume that each component's faces enclose; negative where they look inwards."""
    P = (V - V.mean(axis=0))[F]
    each = np.einsum("mi,mi->m", P[:, 0], np.cross(P[:, 1], P[:, 2])) / 6.0
    return np.bincount(component, weights=each).astype(np.float64)


def _outward(where: str, V: Array, F: Index, pairs: Index) -> None:
    count, component = topology.components(len(F), pairs)
    volume = volumes(V, F, component)
    for c in np.flatnonzero(volume <= 0.0).tolist():
        others = component != c
        inside = count > 1 and winding(V[F[~others][0, :1]], V, F[others])[0] > 0.5
        if not (inside and volume[c] < 0.0):
            which = "" if count == 1 else f" of component {c} (face {int(np.argmax(component == c))})"
            got = f"volume {volume[c]:.3g}{which}"
            remedy = "Reverse the faces: F[:, ::-1]." if volume[c] < 0.0 else ""
            topology.fail(where, "F", "counter-clockwise, seen from outside", got, remedy)


def winding(points: Array, V: Array, F: Index) -> Array:
    """Return how often a closed surface goes round each point: 1 inside, 0 outside.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
    V : ndarray, shape (k, 3)
    F : ndarray of int, shape (m, 3)

    Returns
    -------
    winding : (n,)
        The sum of the solid angles over 4 pi.
    """
    cage, total = cage_view.facets(V, F), np.zeros(len(points))
    for part, seen in cage_view.chunks(cage, points):
        total[part] = cage_view.solid_angles(cage, seen).sum(axis=1) / (4.0 * np.pi)
    return total


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("...i,...i->...", a, b)


def _cross(a: Array, b: Array) -> Array:
    """Return a x b (p, 3); NumPy's own spends its time on axes when there are but few."""
    (x, y, z), (u, v, w) = a.T, b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def crossings(V: Array, F: Index, ends: Index) -> Index:
    """Return the pairs (edge, face) of which the edge passes through the face's interior.

    Parameters
    ----------
    V : ndarray, shape (k, 3)
    F : ndarray of int, shape (m, 3)
    ends : ndarray of int, shape (e, 2)
        The edges to try.

    Returns
    -------
    pairs : (p, 2), int
    """
    low, high = V[F].min(axis=1), V[F].max(axis=1)
    found = []
    step = max(1, _PAIRS // len(F))
    for start in range(0, len(ends), step):
        E = V[ends[start : start + step]]
        near = ((E.min(axis=1)[:, None] <= high) & (E.max(axis=1)[:, None] >= low)).all(axis=-1)
        edge, face = np.nonzero(near)
        apart = (ends[start + edge][:, :, None] != F[face][:, None, :]).all(axis=(1, 2))
        edge, face = edge[apart], face[apart]
        through = _through(E[edge], V[F[face]])
        found.append(np.stack([start + edge[through], face[through]], axis=1))
    return np.concatenate(found)


def _through(E: Array, T: Array) -> NDArray[np.bool_]:
    """Whether segments E (p, 2, 3) pass through triangles T (p, 3, 3), by the signs of five volumes."""
    a, b = E[:, :1] - T, E[:, 1:] - T
    size = np.max(np.abs(np.concatenate([a, b], axis=1)), axis=(1, 2)) ** 3
    normal = _cross(T[:, 1] - T[:, 0], T[:, 2] - T[:, 0])
    above, below = _dot(a[:, 0], normal), _dot(b[:, 0], normal)
    # The line from E0 to E1 sees the three edges turn one way round.
    side = np.stack([_dot(b[:, 0] - a[:, 0], _cross(a[:, i], a[:, (i + 1) % 3])) for i in range(3)], axis=1)
    clear = 1e-13 * size
    split = (np.minimum(above, below) < -clear) & (np.maximum(above, below) > clear)
    return split & ((side > clear[:, None]).all(axis=1) | (side < -clear[:, None]).all(axis=1))
