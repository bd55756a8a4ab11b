"""Rotation vectors that belong together: one for each node of a graph, each continuing its neighbours'.

A rotation fixes its vector only up to full turns.  From seeds the choice spreads over the graph, breadth
first: a node takes that logarithm (theta + 2 pi k) u which continues the vector of the node before it.
The unit quaternions of two neighbours are less than a half turn apart if they have a positive product, which
says whether k is even or odd, and of those left the nearest is taken.  So a step is right whenever

    neighbours differ by less than 90 degrees, and no rotation exceeds 300 degrees

(by `so3.log_near` alone: 63 degrees).  What goes beyond is reported, never mended: a continuous choice
cannot cross |x| = 2 n pi, n >= 1, unless it passes I exactly, as turns about one common axis do.  A thorn
twisted by 540 degrees comes out below 360, and no seed within the thorn's foot helps; the turns are to be
stated, by a seed at its tip.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, quaternion, series, so3
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

FULL = 2.0 * np.pi
PROMISED = np.deg2rad(300.0)
"""The largest rotation for which the choice is promised; as near to any other |x| = 2 n pi none is."""
APART = np.deg2rad(90.0)
"""How far neighbours may differ for that."""
_SAME = 1e-6
"""Radians by which two choices for one rotation may differ and be the same."""
_EVEN = 9
"""Decimals of angles that are compared: what is equal but for rounding goes by index, on every machine."""


@dataclass(frozen=True, eq=False)
class Lift:
    """Consistent rotation vectors, and where they are not to be relied on.

    Parameters
    ----------
    vectors : ndarray, shape (m, 3)
        Axis times angle, radians, of any length.
    seeds : ndarray of int, shape (s,)
        Where the choice began, in the order given; the lowest node first if they were found.
    parent : ndarray of int, shape (m,)
        From which neighbour a node's choice came; -1 at seeds.
    component : ndarray of int, shape (m,)
        Which connected part a node belongs to.
    pairs : ndarray of int, shape (p, 2)
        The neighbours.
    apart : ndarray, shape (p,)
        The angles between neighbouring rotations, radians.
    open : ndarray of bool, shape (p,)
        Neighbours whose vectors do not continue each other: a loop through them does not close, or what two
        seeds ask for meets there.
    beyond : ndarray of bool, shape (m,)
        Nodes whose choice is not promised: they, or a node on their way from the seed, are within
        60 degrees of |x| = 2 n pi, n >= 1, or the way has a step of more than 90 degrees.
    """

    vectors: Array
    seeds: Index
    parent: Index
    component: Index
    pairs: Index
    apart: Array
    open: Mask
    beyond: Mask

    @cached_property
    def angle(self) -> Array:
        """The angle of each rotation with its turns, radians; shape (m,)."""
        return np.linalg.norm(self.vectors, axis=-1)

    @property
    def is_promised(self) -> bool:
        """Whether every choice is: nothing beyond, and every loop closes."""
        return not (self.beyond.any() or self.open.any())

    @property
    def message(self) -> str:
        """What is to be told, in one line; empty where all is well."""
        said = []
        if self.beyond.any():
            k = int(np.flatnonzero(self.beyond)[np.argmax(self.angle[self.beyond])])
            largest = np.rad2deg(self.angle[k])
            many = f"{int(self.beyond.sum())} of {len(self.beyond)} rotations"
            said.append(f"{many} are beyond what neighbours tell (up to {largest:.0f} degrees, at {k})")
        if self.open.any():
            i, j = self.pairs[int(np.argmax(self.open))].tolist()
            many = f"{int(self.open.sum())} pairs of neighbours"
            said.append(f"{many} do not continue each other, first {i} and {j}")
        return "" if not said else "; ".join(said) + ". State the turns of a seed there."


def consistent(
    R: ArrayLike, pairs: ArrayLike, seeds: Sequence[int] | None = None, near: ArrayLike | None = None
) -> Lift:
    """Return rotation vectors that continue each other between neighbours.

    Book: (4.27), (4.28)
    Kaji-Ochiai: 4.3, Algorithm 1, over a graph

    Parameters
    ----------
    R : (m, 3, 3), rotation
    pairs : array_like of int, shape (p, 2)
        Which nodes are neighbours: `face_pairs` of a mesh.
    seeds : sequence of int, optional
        Nodes to begin at, several in one connected part if need be.  A part without any begins at its
        smallest rotation, the one whose principal logarithm is least in doubt.
    near : (s, 3), radians, optional
        The seeds have the logarithm that is nearest to these vectors: `turned` states turns.  The principal
        one unless given.

    Returns
    -------
    lift : Lift

    Raises
    ------
    ValueError
        If R is not rotations, or a pair or a seed is no node.
    """
    where = "adjacency.consistent"
    R = checks.rotation(where, "R", R, 3)
    if R.ndim != 3:
        checks.fail(where, "R", "an array of shape (m, 3, 3)", f"shape {R.shape}", None)
    principal = so3.log(R, check=False)
    ends = _pairs(where, pairs, len(R))
    count, component = topology.components(len(R), ends)
    begin, begun = _seeds(where, seeds, near, R, principal)
    found = _smallest(principal, component)[np.setdiff1d(np.arange(count), component[begin])]
    begin, begun = np.concatenate([begin, found]), np.concatenate([begun, principal[found]])
    relative = np.swapaxes(R[ends[:, 0]], -1, -2) @ R[ends[:, 1]]
    apart = np.linalg.norm(so3.log(relative, check=False), axis=-1)
    parent, levels = _tree(len(R), ends, apart, begin)
    x = np.zeros((len(R), 3))
    x[begin] = begun
    beyond = _doubtful(x)
    for nodes in levels:
        x[nodes] = _continued(principal[nodes], x[parent[nodes]])
        beyond[nodes] = _doubtful(x[nodes]) | beyond[parent[nodes]] | _far(R, nodes, parent[nodes])
    torn = np.zeros(len(ends), bool)
    for one, other in (ends.T, ends.T[::-1]):
        torn |= np.max(np.abs(_continued(principal[other], x[one]) - x[other]), axis=-1) > _SAME
    return Lift(x, begin, parent, component, ends, apart, torn, beyond)


def turned(x: ArrayLike, turns: ArrayLike) -> Array:
    """Return rotation vectors with full turns about their own axes added, for the `near` of seeds.

    Book: (4.27)

    Parameters
    ----------
    x : (..., 3), radians
    turns : (...)
        How many; negative ones turn back.

    Returns
    -------
    near : (..., 3), radians

    Raises
    ------
    ValueError
        If x is 0, which has no axis, where turns are added.
    """
    where = "adjacency.turned"
    x = checks.array(where, "x", x, (3,))
    n = checks.array(where, "turns", turns, ())
    checks.broadcast(where, x=(x, 1), turns=(n, 0))
    length, n = np.broadcast_arrays(np.linalg.norm(x, axis=-1), n)
    bad: Mask = np.logical_and(length <= series.ROUNDED, n != 0.0)
    if np.any(bad):
        remedy = "Give 2 pi times the turns times the axis instead."
        checks.fail(where, "x", "a rotation with an axis", "0", checks.first(np.asarray(bad)), remedy)
    return x * (1.0 + FULL * n / np.where(length > series.ROUNDED, length, 1.0))[..., None]


def face_pairs(F: ArrayLike) -> Index:
    """Return the faces that share an edge, two by two; where an edge has more, one after the other.

    Parameters
    ----------
    F : array_like of int, shape (m, 3)

    Returns
    -------
    pairs : (p, 2), int
    """
    F = np.asarray(F, np.intp).reshape(-1, 3)
    half = np.sort(topology.half_edges(F), axis=1)
    owner = np.repeat(np.arange(len(F)), 3)
    order = np.lexsort((owner, half[:, 1], half[:, 0]))
    same = np.all(half[order][1:] == half[order][:-1], axis=1)
    return np.stack([owner[order][:-1][same], owner[order][1:][same]], axis=1)


def _pairs(where: str, pairs: ArrayLike, count: int) -> Index:
    p = np.asarray(pairs)
    if not p.size:
        return np.zeros((0, 2), np.intp)
    if p.ndim != 2 or p.shape[1] != 2 or p.dtype.kind not in "iu":
        checks.fail(where, "pairs", "whole numbers of shape (p, 2)", f"{p.dtype} of shape {p.shape}", None)
    bad = ((p < 0) | (p >= count)).any(axis=1)
    if bad.any():
        index = checks.first(np.asarray(bad))
        checks.fail(where, "pairs", f"nodes, 0 to {count - 1}", f"{p[index].tolist()}", index)
    return p.astype(np.intp, copy=False)


def _seeds(
    where: str, seeds: Sequence[int] | None, near: ArrayLike | None, R: Array, principal: Array
) -> tuple[Index, Array]:
    """The seeds and their vectors."""
    if seeds is None:
        if near is not None:
            checks.fail(where, "near", "given with seeds", "no seeds", None)
        return np.zeros(0, np.intp), np.zeros((0, 3))
    begin = np.asarray(seeds, None if len(seeds) else np.intp)
    if begin.ndim != 1 or begin.dtype.kind not in "iu":
        checks.fail(where, "seeds", "whole numbers of shape (s,)", f"{begin.dtype} {begin.shape}", None)
    if len(begin) and not 0 <= begin.min() <= begin.max() < len(R):
        index = checks.first((begin < 0) | (begin >= len(R)))
        checks.fail(where, "seeds", f"nodes, 0 to {len(R) - 1}", f"{begin[index]}", index)
    if len(np.unique(begin)) < len(begin):
        checks.fail(where, "seeds", "different nodes", f"{begin.tolist()}", None)
    begin = begin.astype(np.intp)
    if near is None:
        return begin, principal[begin]
    reference = checks.array(where, "near", near, (3,))
    if reference.shape != (len(begin), 3):
        checks.fail(where, "near", f"an array of shape ({len(begin)}, 3)", f"shape {reference.shape}", None)
    return begin, so3.log_near(R[begin], reference, check=False)[0]


def _smallest(principal: Array, component: Index) -> Index:
    """The node of each component that turns the least; of equals the first."""
    angle = np.round(np.linalg.norm(principal, axis=-1), _EVEN)
    order = np.lexsort((np.arange(len(component)), angle, component))
    return order[np.unique(component[order], return_index=True)[1]]


def _far(R: Array, nodes: Index, before: Index) -> Mask:
    trace = np.einsum("kij,kij->k", R[nodes], R[before])
    return trace < 1.0 + 2.0 * np.cos(APART) - 1e-9


def _doubtful(x: Array) -> Mask:
    """Whether a vector is too near to a sphere |x| = 2 n pi, n >= 1."""
    length = np.linalg.norm(x, axis=-1)
    from_sphere = np.abs(length - FULL * np.maximum(1.0, np.rint(length / FULL)))
    return from_sphere < FULL - PROMISED - 1e-9


def _continued(principal: Array, reference: Array) -> Array:
    """Return the logarithms that continue the reference: by the sign of quaternions, then by nearness."""
    theta = np.linalg.norm(principal, axis=-1)
    length = np.linalg.norm(reference, axis=-1)
    ahead, before = (quaternion.exp(0.5 * v, check=False) for v in (principal, reference))
    odd = (np.einsum("...i,...i->...", ahead, before) < 0.0).astype(float)
    u = principal / np.where(theta > 0.0, theta, 1.0)[..., None]
    foot = np.einsum("...i,...i->...", u, reference)
    # Of each parity they are 4 pi apart on their line; halves towards 0, as so3.log_near has it.
    turns = odd + 2.0 * _round((foot - theta) / (2.0 * FULL) - 0.5 * odd)
    around = odd + 2.0 * _round(0.5 * (length / FULL - odd))
    identity = theta <= series.ROUNDED
    whole = FULL * around / np.where(length > 0.0, length, 1.0)
    along = principal + FULL * np.where(identity, 0.0, turns)[..., None] * u
    return np.where((identity & (around > 0.0))[..., None], whole[..., None] * reference, along)


def _round(turns: Array) -> Array:
    return np.copysign(np.ceil(np.abs(turns) - 0.5), turns)


def _tree(count: int, ends: Index, apart: Array, seeds: Index) -> tuple[Index, list[Index]]:
    """Return each node's parent and the levels, breadth first from the seeds.

    Neighbours that differ by more than is promised are taken only where no other way leads on.
    """
    apart = np.round(apart, _EVEN)
    near = apart <= np.round(APART, _EVEN)
    _, island = topology.components(count, ends[near])
    start, there = _rows(count, ends[near])
    parent = np.full(count, -2)
    parent[seeds] = -1
    levels: list[Index] = []
    front = seeds
    while True:
        while len(front):
            front = _next(front, start, there, parent)
            if len(front):
                levels.append(front)
        both = np.concatenate([ends, ends[:, ::-1]])
        across = np.flatnonzero((parent[both[:, 0]] > -2) & (parent[both[:, 1]] == -2))
        if not len(across):
            return parent, levels
        across = across[np.argsort(apart[across % len(ends)], kind="stable")]  # the smallest gap first
        first = across[np.unique(island[both[across, 1]], return_index=True)[1]]
        front = both[first, 1]
        parent[front] = both[first, 0]
        levels.append(front)


def _rows(count: int, ends: Index) -> tuple[Index, Index]:
    """The neighbours of each node one after the other, and where those of each begin."""
    both = np.concatenate([ends, ends[:, ::-1]])
    order = np.lexsort((both[:, 1], both[:, 0]))
    return np.concatenate([[0], np.cumsum(np.bincount(both[:, 0], minlength=count))]), both[order, 1]


def _next(front: Index, start: Index, there: Index, parent: Index) -> Index:
    """Set the parents of the nodes next to a front, and return them in order."""
    size = start[front + 1] - start[front]
    offset = np.repeat(start[front] - np.cumsum(size) + size, size)
    found = there[offset + np.arange(int(size.sum()))]
    owner = np.repeat(front, size)
    new = parent[found] == -2
    nodes, first = np.unique(found[new], return_index=True)
    parent[nodes] = owner[new][first]
    return nodes
