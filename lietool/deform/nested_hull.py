"""A closed surface made coarser from outside: edges collapse to points that leave all of it inside.

Each collapse takes the faces around an edge away and puts a fan about a new point in their place.  If the
point is on the outer side of all planes of these faces, what lies between is made of tetrahedra with a
positive volume, and the new solid contains the old (progressive hulls: Sander, Gu, Gortler, Hoppe and
Snyder 2000).  Among these points the one is taken that is nearest to the planes, in the sum of area times
square; the cheapest collapse is done first.  Nothing is random.
"""

import heapq
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lietool.deform import cage_checks
from lietool.lie.blocks import Rows
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Edge = tuple[int, int]
Entry = tuple[float, Edge, int, tuple[int, int], tuple[float, ...]]

_STAR = 14
"""The most faces around an edge for which a collapse is tried."""

_MIDDLE = 0.02
"""How much the distance from the edge's middle counts, beside that from the planes."""

_LENGTH = 0.03
"""How much the square of the edge's length counts: triangles of like sizes make a good cage."""

_TURN = 0.3
"""The least cosine between a face's normal before and after."""

_THIN = 0.12
"""The least quality of a new face, unless it is better than the worst before: 1 is equilateral, 0 flat."""

_TOGETHER = 16
"""How many collapses are looked at again together."""

_PAIRS = np.array(list(combinations(range(_STAR), 2)))
_TRIPLES = np.array(list(combinations(range(_STAR), 3)))


@dataclass(eq=False)
class _Surface:
    """The surface while it changes: points (k, 3), faces (m, 3), -1 where gone, and the faces of each vertex.

    `stamp` counts the changes around each vertex, `version` how often an edge was evaluated; on the heap are
    the cost, the edge, its version, the stamps of its ends and the point.
    """

    points: Array
    faces: Index
    around: list[set[int]]
    slack: float
    stamp: list[int]
    heap: list[Entry] = field(default_factory=list)
    version: dict[Edge, int] = field(default_factory=dict)

    def ring(self, v: int) -> set[int]:
        """The neighbours of a vertex."""
        return set(self.faces[list(self.around[v])].ravel().tolist()) - {v}

    def stamps(self, edge: Edge) -> tuple[int, int]:
        """The stamps of the ends of an edge."""
        return self.stamp[edge[0]], self.stamp[edge[1]]


def coarsen(V: Array, F: Index, count: int) -> tuple[Array, Index]:
    """Return a coarser surface around a closed one.

    Parameters
    ----------
    V : ndarray, shape (k, 3)
    F : ndarray of int, shape (m, 3)
        A closed surface, oriented outwards.
    count : int
        How many faces there should be at most; more are left where no further collapse is possible, since
        each component keeps its handles and no face may become a sliver or cross others.

    Returns
    -------
    V : (k', 3)
    F : (m', 3), int
    """
    around: list[set[int]] = [set() for _ in range(len(V))]
    for f, corners in enumerate(F.tolist()):
        for v in corners:
            around[v].add(f)
    size = float(np.max(np.ptp(V, axis=0)))
    surface = _Surface(V.copy(), F.copy(), around, 1e-12 * size, [0] * len(V))
    left = len(F)
    every, _ = topology.edge_counts(F)
    for start in range(0, len(every), 200):
        _evaluate(surface, [(a, b) for a, b in every[start : start + 200].tolist()])
    while left > count and (entry := _next(surface)) is not None:
        edge, point = entry[1], np.array(entry[4])
        if _allowed(surface, edge, point):
            left -= _collapse(surface, edge, point)
    used, F = np.unique(surface.faces[surface.faces[:, 0] >= 0], return_inverse=True)
    return surface.points[used], F.reshape(-1, 3).astype(np.intp)


def _next(surface: _Surface) -> Entry | None:
    """Return the cheapest collapse; those whose surroundings have changed are looked at again first."""
    while surface.heap:
        stale = []
        while surface.heap and len(stale) < _TOGETHER:
            entry = heapq.heappop(surface.heap)
            _, edge, version, stamps, _ = entry
            if surface.version[edge] != version or not surface.around[edge[0]] & surface.around[edge[1]]:
                continue
            if surface.stamps(edge) != stamps:
                stale.append(edge)
            elif not stale:
                return entry
            else:
                heapq.heappush(surface.heap, entry)
                break
        if stale:
            _evaluate(surface, stale)
    return None


def _evaluate(surface: _Surface, edges: list[Edge]) -> None:
    """Put edges on the heap, with the best point and its cost."""
    stars = [sorted(surface.around[a] | surface.around[b]) for a, b in edges]
    kept = [k for k, star in enumerate(stars) if len(star) <= _STAR]
    for edge in edges:
        surface.version[edge] = surface.version.get(edge, 0) + 1
    if not kept:
        return
    # Shorter stars are filled with their first face: the same plane once more, of no area.
    filled = [(stars[k] + stars[k][:1] * _STAR)[:_STAR] for k in kept]
    weight = np.array([[1.0] * len(stars[k]) + [0.0] * (_STAR - len(stars[k])) for k in kept])
    corner = surface.points[surface.faces[np.array(filled)]]
    ends = surface.points[np.array([edges[k] for k in kept])]
    found, cost = _best(corner, weight, ends, surface.slack)
    for row, k in enumerate(kept):
        if np.isfinite(cost[row]):
            edge, point = edges[k], tuple(found[row].tolist())
            entry = (float(cost[row]), edge, surface.version[edge], surface.stamps(edge), point)
            heapq.heappush(surface.heap, entry)


def _best(corner: Array, weight: Array, ends: Array, slack: float) -> tuple[Array, Array]:
    """Return the points outside of all planes that cost least, and the costs; infinite where there is none.

    The cost is quadratic, in coordinates that make it |z|^2 about its minimum.  The nearest point of a
    polyhedron to 0 lies on none, one, two or three of its planes, and all these are tried.
    """
    middle = ends.mean(axis=1)
    n = _cross(corner[..., 1, :] - corner[..., 0, :], corner[..., 2, :] - corner[..., 0, :])
    twice = np.linalg.norm(n, axis=-1)
    n = n / twice[..., None]
    area = weight * twice
    b = np.einsum("eki,eki->ek", n, corner[..., 0, :] - middle[:, None])
    total = area.sum(axis=1)
    H = np.einsum("ek,eki,ekj->eij", area, n, n) + _MIDDLE * total[:, None, None] * np.eye(3)
    lowest = np.linalg.solve(H, np.einsum("ek,eki,ek->ei", area, n, b)[..., None])[..., 0]
    C = np.linalg.cholesky(H)
    G = np.swapaxes(np.linalg.solve(C, np.swapaxes(n, 1, 2)), 1, 2)
    b = b - np.einsum("eki,ei->ek", n, lowest)
    z = _candidates(G, b)
    with np.errstate(invalid="ignore"):
        # Planes before candidates: `all` is quick along any axis but the last.
        clear = (G @ np.swapaxes(z, 1, 2) - b[:, :, None] >= -slack).all(axis=1)
        square = np.where(clear, np.einsum("eci,eci->ec", z, z), np.inf)
    pick = np.argmin(square, axis=1)
    row = np.arange(len(z))
    moved = np.linalg.solve(np.swapaxes(C, 1, 2), z[row, pick][..., None])[..., 0]
    point = middle + lowest + moved
    offset = np.einsum("eki,ei->ek", n, lowest + moved) - (b + np.einsum("eki,ei->ek", n, lowest))
    length = np.sum((ends[:, 1] - ends[:, 0]) ** 2, axis=-1)
    cost = np.sum(area * offset**2, axis=1) + _LENGTH * total * length
    return point, np.where(np.isfinite(square[row, pick]), cost, np.inf)


def _candidates(G: Array, b: Array) -> Array:
    """Return the points nearest to 0 on all intersections of up to three planes G z = b, (e, c, 3)."""
    g = (G[..., 0], G[..., 1], G[..., 2])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        share = b / np.einsum("eki,eki->ek", G, G)
        one = [x * share for x in g]
        (p, bp), (q, bq) = _taken(g, b, _PAIRS[:, 0]), _taken(g, b, _PAIRS[:, 1])
        across = _cross_rows(p, q)
        size = across[0] ** 2 + across[1] ** 2 + across[2] ** 2
        pairs = zip(_cross_rows(q, across), _cross_rows(across, p), strict=True)
        two = [(bp * x + bq * y) / size for x, y in pairs]
        (p, bp), (q, bq), (r, br) = (_taken(g, b, _TRIPLES[:, i]) for i in range(3))
        qr = _cross_rows(q, r)
        size = p[0] * qr[0] + p[1] * qr[1] + p[2] * qr[2]
        triples = zip(qr, _cross_rows(r, p), _cross_rows(p, q), strict=True)
        three = [(bp * x + bq * y + br * z) / size for x, y, z in triples]
    zero = np.zeros_like(b[:, :1])
    every = np.stack(
        [np.concatenate([zero, *rows], axis=1) for rows in zip(one, two, three, strict=True)], -1
    )
    return np.where(np.isfinite(every), every, np.nan)


def _taken(g: Rows, b: Array, index: Index) -> tuple[Rows, Array]:
    return [x[:, index] for x in g], b[:, index]


def _cross_rows(a: Rows, b: Rows) -> Rows:
    (x, y, z), (u, v, w) = a, b
    return [y * w - z * v, z * u - x * w, x * v - y * u]


def _allowed(surface: _Surface, edge: Edge, point: Array) -> bool:
    """Whether a collapse leaves a surface, turns no face over, makes no sliver and crosses nothing."""
    a, b = edge
    if len(surface.ring(a) & surface.ring(b)) != 2:
        return False
    star = sorted(surface.around[a] ^ surface.around[b])
    if len(surface.around[a] & surface.around[b]) != 2 or len(star) < 3:
        return False
    F = surface.faces[star]
    old = surface.points[F]
    new = np.where(np.isin(F, edge)[..., None], point, old)
    n, m = (_cross(P[:, 1] - P[:, 0], P[:, 2] - P[:, 0]) for P in (old, new))
    n_size, m_size = np.linalg.norm(n, axis=1), np.linalg.norm(m, axis=1)
    if not (np.sum(n * m, axis=1) > _TURN * n_size * m_size).all():
        return False
    before = surface.points[surface.faces[list(surface.around[a] | surface.around[b])]]
    least = min(_THIN, 0.9 * float(_quality(before).min()))
    return bool(_quality(new).min() > least) and not _crosses(surface, edge, F, new, point)


def _cross(a: Array, b: Array) -> Array:
    """Return a x b; NumPy's own spends its time on axes when there are but few."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def _quality(T: Array) -> Array:
    """Return 4 sqrt(3) area / sum of squared edges of triangles: 1 for an equilateral one."""
    n = np.linalg.norm(_cross(T[:, 1] - T[:, 0], T[:, 2] - T[:, 0]), axis=1)
    return 2.0 * np.sqrt(3.0) * n / np.sum((T - T[:, [1, 2, 0]]) ** 2, axis=(1, 2))


def _crosses(surface: _Surface, edge: Edge, F: Index, new: Array, point: Array) -> bool:
    """Whether the new fan would cross the rest of the surface."""
    low, high = new.min(axis=(0, 1)), new.max(axis=(0, 1))
    near = surface.faces[:, 0] >= 0
    for axis in range(3):
        x, y, z = (surface.points[surface.faces[:, k], axis] for k in range(3))
        near &= np.minimum(np.minimum(x, y), z) <= high[axis]
        near &= np.maximum(np.maximum(x, y), z) >= low[axis]
    near[list(surface.around[edge[0]] | surface.around[edge[1]])] = False
    if not near.any():
        return False
    V = np.concatenate([surface.points, point[None]])
    fan = np.where(np.isin(F, edge), len(surface.points), F)
    both = [(surface.faces[near], fan), (fan, surface.faces[near])]
    return any(len(cage_checks.crossings(V, one, topology.edge_counts(two)[0])) > 0 for one, two in both)


def _collapse(surface: _Surface, edge: Edge, point: Array) -> int:
    """Put the point in place of the edge, and return how many faces are gone."""
    a, b = edge
    gone = surface.around[a] & surface.around[b]
    for f in gone:
        for v in surface.faces[f].tolist():
            surface.around[v].discard(f)
        surface.faces[f] = -1
    moved = list(surface.around[b])
    surface.faces[moved] = np.where(surface.faces[moved] == b, a, surface.faces[moved])
    surface.around[a] |= surface.around[b]
    surface.around[b] = set()
    surface.points[a] = point
    ring = sorted(surface.ring(a))
    for v in (a, *ring):
        surface.stamp[v] += 1
    # What else has changed is looked at again when its turn comes.
    _evaluate(surface, [(min(a, v), max(a, v)) for v in ring])
    return len(gone)
