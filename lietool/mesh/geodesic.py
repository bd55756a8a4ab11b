"""Distances along a surface by the heat method (Crane, Weischedel and Wardetzky 2013).

Heat that has flowed from the sources for a short time t falls along shortest paths; the distance is what has
the gradient closest to the unit field opposite to that of heat.  Two sparse systems, factored once for all
sources.

Where there is a boundary the mean is taken of heat that may not cross it (Neumann) and heat that is lost
there (Dirichlet): either alone bends the distance towards the boundary or away from it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import laplacian, surface, topology
from lietool.mesh import solve as sparse

Array = NDArray[np.float64]
Index = NDArray[np.intp]

REACH = 300.0
"""Lengths sqrt(t) in the extent of a part: heat falls by e with each, and twice so many still are numbers."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh on which distances can be asked for.

    Parameters
    ----------
    part : ndarray of int, shape (n,)
        The connected part of each vertex, -1 where no face uses it.
    gradient, divergence : sparse array
    warm : Factor
        Of M + t L.
    cool : Factor or None
        The same with 0 at the boundary; None where there is none.
    poisson : Factor
        Of L, with one vertex of each part at 0.
    """

    part: Index
    gradient: Any
    divergence: Any
    warm: sparse.Factor
    cool: sparse.Factor | None
    poisson: sparse.Factor


def prepare(V: ArrayLike, F: ArrayLike) -> Prepared:
    """Return what distances from any vertices have in common.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If V or F is none, or a triangle has area 0 or nearly so.
    """
    V, F = laplacian.checked("geodesic.prepare", V, F)
    state = surface.health(V, F)
    L = laplacian.cotangent(V, F)
    M = laplacian.mass(V, F)
    warm = _diagonal(M) + _time(V, F, state.part) * L
    ends, count = topology.edge_counts(F)
    cold = np.union1d(ends[count == 1].ravel(), state.unused)
    cool = _factor(warm, cold) if state.boundary else None
    held = np.unique(state.part, return_index=True)[1]
    held = np.union1d(held, state.unused)
    return Prepared(
        state.part,
        laplacian.gradient(V, F),
        laplacian.divergence(V, F),
        _factor(warm, state.unused),
        cool,
        _factor(L, held),
    )


def _factor(A: Any, fixed: Index) -> sparse.Factor:
    """Factor one of the systems, each of which is regular but for rounding."""
    try:
        return sparse.factor(A, fixed)
    except ValueError:
        got = "some so thin that the system is singular to rounding"
        topology.fail("geodesic.prepare", "F", "triangles with an area", got, "Make the mesh even.")


def solve(prepared: Prepared, sources: Sequence[ArrayLike]) -> Array:
    """Return the distances from each of several sets of vertices.

    Parameters
    ----------
    prepared : Prepared
    sources : sequence of array_like of int
        k sets of vertices, none of them empty.

    Returns
    -------
    distance : ndarray, shape (n, k)
        To the nearest vertex of each set; infinite where no path leads, on other parts of the mesh.

    Raises
    ------
    ValueError
        If a set is empty or has no vertices of the mesh.
    """
    n = len(prepared.part)
    sets = [_set(s, n, k) for k, s in enumerate(sources)]
    if not sets:
        topology.fail("geodesic.solve", "sources", "at least one set of vertices", "none")
    start = np.zeros((n, len(sets)))
    for k, s in enumerate(sets):
        start[s, k] = 1.0
    heat = _flow(prepared.warm, start)
    if prepared.cool is not None:
        heat = 0.5 * (heat + _flow(prepared.cool, start))
    field = (prepared.gradient @ heat).reshape(-1, 3, len(sets))
    # Far away heat is so small that squares of it vanish.
    field /= _nonzero(np.max(np.abs(field), axis=1, keepdims=True))
    field /= -_nonzero(np.sqrt(np.sum(field**2, axis=1, keepdims=True)))
    right = -(prepared.divergence @ field.reshape(-1, len(sets)))
    distance = prepared.poisson.solve(right, np.zeros((len(prepared.poisson.fixed), len(sets))))
    for k, s in enumerate(sets):
        distance[:, k] = _from_zero(prepared.part, distance[:, k], s)
    return distance


def heat(V: ArrayLike, F: ArrayLike, sources: ArrayLike) -> Array:
    """Return the distances along a surface to the nearest of some vertices.

    On even triangles the error is about 1 % of the distance, and near the sources a part of an edge.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    sources : array_like of int, shape (k,)

    Returns
    -------
    distance : ndarray, shape (n,)
        Infinite where no path leads, on other parts of the mesh.

    Raises
    ------
    ValueError
        If V or F is none, a triangle has area 0, or sources has no vertices of the mesh.
    """
    return solve(prepare(V, F), [sources])[:, 0]


def _time(V: Array, F: Index, part: Index) -> float:
    """Return the square of the mean edge; more where a part is so long that heat would be no number."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    ends, _ = topology.edge_counts(F)
    length = np.linalg.norm(V[ends[:, 0]] - V[ends[:, 1]], axis=1)
    graph = coo_array((length, (ends[:, 0], ends[:, 1])), (len(V), len(V)))
    seeds = np.unique(part, return_index=True)[1]
    far = dijkstra(graph.tocsr(), directed=False, indices=seeds[part[seeds] >= 0], min_only=True)
    extent = float(np.max(far[np.isfinite(far)]))
    return max(float(np.mean(length)), extent / REACH) ** 2


def _diagonal(M: Array) -> Any:
    from scipy.sparse import csc_array

    return csc_array((M, (np.arange(len(M)), np.arange(len(M)))), (len(M), len(M)))


def _set(source: ArrayLike, n: int, k: int) -> Index:
    name = f"sources[{k}]"
    found = topology.vertex_set("geodesic.solve", name, source, n)
    if not len(found):
        topology.fail("geodesic.solve", name, "at least one vertex", "none")
    return found


def _flow(factor: sparse.Factor, start: Array) -> Array:
    return factor.solve(start, np.zeros((len(factor.fixed), start.shape[1])))


def _from_zero(part: Index, distance: Array, sources: Index) -> Array:
    """Return distances that are 0 on average at the sources of each part, and infinite where it has none."""
    lonely = sources[part[sources] < 0]
    used = sources[part[sources] >= 0]
    count = np.bincount(part[used], minlength=max(int(part.max()) + 1, 1))
    total = np.bincount(part[used], distance[used], len(count))
    shift = np.where(count > 0, total / np.maximum(count, 1), -np.inf)
    found = np.where(part >= 0, np.maximum(distance - shift[part], 0.0), np.inf)
    found[lonely] = 0.0
    return found


def _nonzero(x: Array) -> Array:
    return np.where(x > 0.0, x, 1.0)
