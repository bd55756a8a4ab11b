"""Weights of handles that are as smooth as the surface allows: harmonic and biharmonic.

A handle is a set of vertices at which its weight is 1 and those of the others are 0.  In between, harmonic
weights have the least Dirichlet energy (Joshi, Meyer, DeRose, Green and Sanocki 2007, on the surface itself);
biharmonic ones the least bending, the integral of the squared Laplacian (Botsch and Kobbelt 2004): they leave
the handles without a kink but may be below 0 or above 1.  All handles share one factored system.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh import laplacian, solve, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Handles = Sequence[ArrayLike]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A factored system of handles.

    Parameters
    ----------
    factor : Factor
        Its fixed vertices are those of all handles, one handle after the other.
    handle : ndarray of int, shape (b,)
        The handle of each of them.
    """

    factor: solve.Factor
    handle: Index


def prepare_harmonic(V: ArrayLike, F: ArrayLike, handles: Handles) -> Prepared:
    """Return the system of harmonic functions with given values at handles.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    handles : sequence of array_like of int
        k disjoint sets of vertices.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If V or F is none, a triangle has area 0, a handle is empty or shares a vertex with another, or a
        connected part of the mesh has no handle.
    """
    V, F = laplacian.checked("harmonic.prepare_harmonic", V, F)
    return _prepare("harmonic.prepare_harmonic", len(V), F, laplacian.cotangent(V, F), handles)


def prepare_biharmonic(V: ArrayLike, F: ArrayLike, handles: Handles) -> Prepared:
    """Return the system of biharmonic functions with given values at handles.

    The masses are those of Voronoi cells.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    handles : sequence of array_like of int
        k disjoint sets of vertices.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        As `prepare_harmonic`.
    """
    from scipy.sparse import csc_array

    V, F = laplacian.checked("harmonic.prepare_biharmonic", V, F)
    L = laplacian.cotangent(V, F)
    M = laplacian.voronoi_mass(V, F)
    scaled = csc_array(L)
    # M^-1 L; rows of vertices that no face uses are empty.
    scaled.data = L.data / M[L.indices]
    return _prepare("harmonic.prepare_biharmonic", len(V), F, L @ scaled, handles)


def extend(prepared: Prepared, values: ArrayLike) -> Array:
    """Return functions with given values at the vertices of handles.

    Parameters
    ----------
    prepared : Prepared
    values : array_like, shape (b, c)
        In the order of `prepared.factor.fixed`.

    Returns
    -------
    x : ndarray, shape (n, c)

    Raises
    ------
    ValueError
        If there are more or fewer values, or one is not finite.
    """
    values = checks.array("harmonic.extend", "values", values, (), check=False)
    wide = values.shape[1] if values.ndim == 2 else 1
    return prepared.factor.solve(np.zeros((prepared.factor.count, wide)), values)


def weights(prepared: Prepared) -> Array:
    """Return the weights of the handles; they sum to 1.

    Parameters
    ----------
    prepared : Prepared

    Returns
    -------
    weights : ndarray, shape (n, k)
    """
    return extend(prepared, np.eye(int(prepared.handle.max()) + 1)[prepared.handle])


def harmonic(V: ArrayLike, F: ArrayLike, handles: Handles) -> Array:
    """Return harmonic weights; where no cotangent weight is negative they are between 0 and 1.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    handles : sequence of array_like of int
        k disjoint sets of vertices.

    Returns
    -------
    weights : ndarray, shape (n, k)
        They sum to 1.

    Raises
    ------
    ValueError
        As `prepare_harmonic`.
    """
    return weights(prepare_harmonic(V, F, handles))


def biharmonic(V: ArrayLike, F: ArrayLike, handles: Handles) -> Array:
    """Return biharmonic weights.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    handles : sequence of array_like of int
        k disjoint sets of vertices.

    Returns
    -------
    weights : ndarray, shape (n, k)
        They sum to 1.

    Raises
    ------
    ValueError
        As `prepare_harmonic`.
    """
    return weights(prepare_biharmonic(V, F, handles))


def follow(
    V: ArrayLike,
    F: ArrayLike,
    handles: Handles,
    kind: Callable[[ArrayLike, ArrayLike, Handles], Array] = harmonic,
) -> Array:
    """Return weights on a mesh of several parts, those without a handle following the nearest one with.

    Of such a part every vertex has the weights of the vertex of the others that is nearest to the part, so
    that it moves as one piece with what it sits on.  A vertex that no face uses is a part.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    handles : sequence of array_like of int
        k disjoint sets of vertices.
    kind : callable, optional
        `harmonic` or `biharmonic`.

    Returns
    -------
    weights : ndarray, shape (n, k)

    Raises
    ------
    ValueError
        As `prepare_harmonic`, but for parts without a handle.
    """
    from scipy.spatial import KDTree

    V, F = laplacian.checked("harmonic.follow", V, F)
    vertex, handle = _handles("harmonic.follow", handles, len(V))
    number, part = topology.parts(F, len(V))
    held = np.bincount(part[vertex], minlength=number) > 0
    kept = np.flatnonzero(held[part])
    new = np.full(len(V), -1)
    new[kept] = np.arange(len(kept))
    inside = new[F[held[part[F[:, 0]]]]]
    sets = [new[vertex[handle == k]] for k in range(len(handles))]
    W = np.zeros((len(V), len(handles)))
    if len(inside):
        W[kept] = kind(V[kept], inside, sets)
    else:
        # Only vertices that no face uses are handles.
        W[vertex, handle] = 1.0
    loose = np.flatnonzero(~held[part])
    if len(loose):
        found = KDTree(V[kept]).query(V[loose])
        distance, nearest = np.asarray(found[0]), np.asarray(found[1])
        order = np.lexsort((loose, distance, part[loose]))
        first = order[np.unique(part[loose][order], return_index=True)[1]]
        chosen = np.zeros(number, np.intp)
        chosen[part[loose][first]] = kept[nearest[first]]
        W[loose] = W[chosen[part[loose]]]
    return W


def _prepare(where: str, n: int, F: Index, Q: Any, handles: Handles) -> Prepared:
    vertex, handle = _handles(where, handles, n)
    number, part = topology.parts(F, n)
    first = topology.unheld(number, part, vertex)
    if len(first):
        got = f"{len(first)} of {number} without one, with {laplacian.listed('vertex', first)}"
        remedy = "Give each a handle, or use harmonic.follow."
        topology.fail(where, "handles", "in every connected part", got, remedy)
    return Prepared(solve.factor(Q, vertex), handle)


def _handles(where: str, handles: Handles, n: int) -> tuple[Index, Index]:
    """Return the vertices of all handles and the handle of each."""
    sets = [topology.vertex_set(where, f"handles[{k}]", h, n) for k, h in enumerate(handles)]
    if not sets:
        topology.fail(where, "handles", "at least one set of vertices", "none")
    for k, s in enumerate(sets):
        if not len(s):
            topology.fail(where, f"handles[{k}]", "at least one vertex", "none")
    vertex = np.concatenate(sets)
    handle = np.repeat(np.arange(len(sets)), [len(s) for s in sets])
    both, count = np.unique(vertex, return_counts=True)
    if (count > 1).any():
        twice = int(both[count > 1][0])
        of = " and ".join(map(str, handle[vertex == twice][:2]))
        topology.fail(where, "handles", "disjoint", f"vertex {twice} twice, in handles {of}")
    return vertex, handle
