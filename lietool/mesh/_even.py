"""Triangles of about one size and shape: split what is long, join what is short, turn edges, spread out.

After Botsch and Kobbelt, A remeshing approach to multiresolution modeling, 2004; many edges at once: of those
that would touch the same triangles the first in an order goes, the others wait for the next pass.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def even(
    V: Array, F: Index, size: Callable[[Array], Array], onto: Callable[[Array], Array], rounds: int = 5
) -> tuple[Array, Index]:
    """Return a closed mesh with triangles of about equal sides.

    Parameters
    ----------
    V, F : (n, 3), (m, 3)
        Closed, finer than the size or about as fine.
    size : callable
        The wanted side at points.
    onto : callable
        Brings points near the surface onto it.
    rounds : int

    Returns
    -------
    V : (k, 3)
    F : (l, 3)
    """
    for k in range(rounds):
        sides = size(V)
        V, F, sides = _split(V, F, sides)
        for _ in range(20 if k == 0 else 3):
            before = len(F)
            V, F, sides = _joined(V, F, sides)
            if len(F) == before:
                break
        for _ in range(4):
            F = _turned(V, F, by_angle=k >= rounds - 2)
        for _ in range(2):
            V = _spread(V, F, sides)
        V = np.round(onto(V), 7)
    for _ in range(3):
        F = _turned(V, F, by_angle=True)
    return V, _ordered(F)


def _edges(F: Index) -> tuple[Index, Index, Index]:
    """Edges (e, 2), their two triangles (e, 2), and the corners across them (e, 2), of a closed mesh."""
    found = topology.edges("even", F)
    # The corner of a triangle that is not of the edge: the sum of all three less the ends.
    across = F[found.sides].sum(axis=2) - found.ends.sum(axis=1)[:, None]
    return found.ends, found.sides, across


def _lengths(V: Array, ends: Index) -> Array:
    u = V[ends[:, 1]] - V[ends[:, 0]]
    return np.sqrt(u[:, 0] * u[:, 0] + u[:, 1] * u[:, 1] + u[:, 2] * u[:, 2])


def _ranks(order: Index, count: int) -> Index:
    """The place of each edge in an order; those left out come last, together."""
    rank = np.full(count, count)
    rank[order] = np.arange(len(order))
    return rank


def _least(rank: Index, at: Index, count: int) -> Index:
    """The least rank of the edges at each of `count` places; `at` (e, k) says where each edge is."""
    least = np.full(count, len(rank))
    np.minimum.at(least, at.ravel(), np.repeat(rank, at.shape[1]))
    return least


def _by(value: Array, chosen: Index) -> Index:
    """Chosen edges by a value, rounded so that a last bit decides nothing."""
    return chosen[np.argsort(np.round(value[chosen], 7), kind="stable")]


def _split(V: Array, F: Index, size: Array) -> tuple[Array, Index, Array]:
    """Edges that are too long are halved, at most one in a triangle."""
    ends, sides, _ = _edges(F)
    length = _lengths(V, ends)
    rank = _ranks(_by(-length, np.flatnonzero(length > 1.36 * size[ends].mean(axis=1))), len(ends))
    least = _least(rank, sides, len(F))
    go = np.flatnonzero((rank < len(ends)) & (least[sides] == rank[:, None]).all(axis=1))
    if not len(go):
        return V, F, size
    new = len(V) + np.arange(len(go))
    V = np.concatenate([V, 0.5 * (V[ends[go, 0]] + V[ends[go, 1]])])
    size = np.concatenate([size, size[ends[go]].mean(axis=1)])
    extra = []
    F = F.copy()
    for side in (0, 1):
        f = sides[go, side]
        second = F[f].copy()
        # The triangle keeps the first end and gets the middle for the second; the new one the other way.
        second[second == ends[go, 0][:, None]] = new
        first = F[f]
        first[first == ends[go, 1][:, None]] = new
        F[f] = first
        extra.append(second)
    return V, np.concatenate([F, *extra]), size


def _joined(V: Array, F: Index, size: Array) -> tuple[Array, Index, Array]:
    """Edges that are too short become points, unless something would fold over or get long."""
    from scipy.sparse import coo_array

    ends, _, across = _edges(F)
    length = _lengths(V, ends)
    n = len(V)
    ones = np.ones(2 * len(ends), np.int32)
    there = np.concatenate([ends, ends[:, ::-1]])
    beside = coo_array((ones, (there[:, 0], there[:, 1])), (n, n)).tocsr()
    short = np.flatnonzero(length < 0.76 * size[ends].mean(axis=1))
    # More than two common neighbours: joined, the edge would leave two triangles back to back.
    common = np.asarray(beside[ends[short, 0]].multiply(beside[ends[short, 1]]).sum(axis=1)).ravel()
    degree = np.bincount(ends.ravel(), minlength=n)
    thin = (degree[across[short]] <= 3).any(axis=1)
    rank = _ranks(_by(length, short[(common == 2) & ~thin]), len(ends))
    own = _least(rank, ends, n)
    around = own.copy()
    np.minimum.at(around, there[:, 0], own[there[:, 1]])
    go = np.flatnonzero((rank < len(ends)) & (around[ends] == rank[:, None]).all(axis=1))
    if not len(go):
        return V, F, size
    middle = 0.5 * (V[ends[go, 0]] + V[ends[go, 1]])
    to, W, of = np.arange(n), V.copy(), np.full(n, -1)
    to[ends[go, 1]] = ends[go, 0]
    W[ends[go, 0]], of[ends[go, 0]], of[ends[go, 1]] = middle, np.arange(len(go)), np.arange(len(go))
    G = to[F]
    owner = of[F].max(axis=1)
    lives = (G[:, 0] != G[:, 1]) & (G[:, 1] != G[:, 2]) & (G[:, 2] != G[:, 0])
    before, after = topology.area_normals(V, F), topology.area_normals(W, G)
    dot = np.sum(before * after, axis=1)
    both = np.sqrt(np.sum(before * before, axis=1) * np.sum(after * after, axis=1))
    sides3 = np.stack([_lengths(W, G[:, [i, j]]) for i, j in ((0, 1), (1, 2), (2, 0))], axis=1)
    bad = lives & (owner >= 0) & ((dot <= 0.2 * both) | (sides3.max(axis=1) > 1.36 * size[F].mean(axis=1)))
    keep = np.ones(len(go), bool)
    keep[owner[bad]] = False
    undone = go[~keep]
    to[ends[undone, 1]] = ends[undone, 1]
    W[ends[undone].ravel()] = V[ends[undone].ravel()]
    G = to[F]
    lives = (G[:, 0] != G[:, 1]) & (G[:, 1] != G[:, 2]) & (G[:, 2] != G[:, 0])
    used, G = np.unique(G[lives], return_inverse=True)
    return W[used], G.reshape(-1, 3), size[used]


def _cotangent(V: Array, corner: Index, a: Index, b: Index) -> Array:
    u, v = V[a] - V[corner], V[b] - V[corner]
    size = np.sqrt(np.maximum(np.sum(np.cross(u, v) ** 2, axis=1), 1e-30))
    return np.sum(u * v, axis=1) / size


def _turned(V: Array, F: Index, by_angle: bool) -> Index:
    """Edges turned to the other diagonal of their triangles: six at every vertex, or wide angles."""
    ends, sides, across = _edges(F)
    degree = np.bincount(ends.ravel(), minlength=len(V))
    if by_angle:
        gain = -(_cotangent(V, across[:, 0], *ends.T) + _cotangent(V, across[:, 1], *ends.T))
        # The other diagonal must be better by as much as the angles of this one are worse than straight.
        want = (gain > 0.02) & (degree[ends] > 4).all(axis=1) & (degree[across] < 9).all(axis=1)
    else:
        now = (degree[ends] - 6.0) ** 2
        then = (degree[ends] - 7.0) ** 2
        gain = (now - then).sum(axis=1) - ((degree[across] - 5.0) ** 2 - (degree[across] - 6.0) ** 2).sum(
            axis=1
        )
        want = gain > 0.0
    n = len(V)
    key = ends[:, 0] * n + ends[:, 1]
    other = across.min(axis=1) * n + across.max(axis=1)
    want &= ~np.isin(other, key) & (across[:, 0] != across[:, 1])
    # The first triangle has the edge one way round, the second the other.
    a, b = ends.T
    first = F[sides[:, 0]]
    forward = ((first == a[:, None]) & (np.roll(first, -1, axis=1) == b[:, None])).any(axis=1)
    a, b = np.where(forward, a, b), np.where(forward, b, a)
    c, d = across.T
    new = np.stack([np.stack([c, a, d], axis=1), np.stack([d, b, c], axis=1)], axis=1)
    old = topology.area_normals(V, F[sides[:, 0]]) + topology.area_normals(V, F[sides[:, 1]])
    for k in (0, 1):
        made = topology.area_normals(V, new[:, k])
        dot = np.sum(made * old, axis=1)
        want &= dot > 0.75 * np.sqrt(np.sum(made**2, axis=1) * np.sum(old**2, axis=1))
    rank = _ranks(_by(-gain, np.flatnonzero(want)), len(ends))
    corners = np.concatenate([ends, across], axis=1)
    least = _least(rank, corners, n)
    go = np.flatnonzero((rank < len(ends)) & (least[corners] == rank[:, None]).all(axis=1))
    F = F.copy()
    F[sides[go, 0]], F[sides[go, 1]] = new[go, 0], new[go, 1]
    return F


def _spread(V: Array, F: Index, size: Array) -> Array:
    """Each vertex moved along the surface to the mean of its neighbours, weighed by their triangles."""
    cross = topology.area_normals(V, F)
    area = np.sqrt(np.sum(cross**2, axis=1))
    # Where small triangles are wanted, the same area weighs more.
    weight = np.bincount(F.ravel(), np.repeat(area, 3), len(V)) / size**3
    normal = np.stack([np.bincount(F.ravel(), np.repeat(cross[:, k], 3), len(V)) for k in range(3)], axis=1)
    normal /= np.maximum(np.sqrt(np.sum(normal**2, axis=1)), 1e-30)[:, None]
    half = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    a, b = half.T
    # A vertex among triangles without area stays where it is.
    weight = np.maximum(weight, 1e-9 * weight.mean())
    total = np.bincount(a, weight[b], len(V))
    mean = np.stack([np.bincount(a, weight[b] * V[b, k], len(V)) for k in range(3)], axis=1) / total[:, None]
    step = mean - V
    step -= np.sum(step * normal, axis=1)[:, None] * normal
    return V + 0.8 * step


def _ordered(F: Index) -> Index:
    """Triangles with the least index first, in the order of their indices: one way to write a mesh."""
    first = np.argmin(F, axis=1)[:, None]
    F = np.take_along_axis(F, (first + np.arange(3)) % 3, axis=1)
    return F[np.lexsort(F.T[::-1])]
