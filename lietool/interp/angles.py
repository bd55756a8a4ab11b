"""Angles of rotation that belong together: one number for each triangle, without jumps of full turns.

The rotation R_i of a local map A_i = R_i S_i fixes its angle up to full turns.
Two triangles with a common edge agree on where that edge goes, and with S_i positive neither map turns it
by a right angle or more away from R_i: their angles, rightly chosen, differ by less than pi.  From one
triangle the choice spreads over the mesh.  Round a hole it may fail to close, and then there is none.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh import topology

Array = NDArray[np.float64]
FULL = 2.0 * np.pi


def consistent(
    principal: ArrayLike, F: ArrayLike, seed: int = 0, turns: Mapping[int, int] | None = None
) -> Array:
    """Return angles of rotation that differ by less than pi between triangles with a common edge.

    Book: 6.3

    Parameters
    ----------
    principal : (m,), rad
        An angle of each triangle's rotation, up to full turns.
    F : array_like of int, shape (m, 3)
    seed : int
        The triangle whose angle stays as it is; in other components it is the one with the lowest index.
    turns : mapping from int to int, optional
        For a triangle, the full turns to be added to its angle; its whole component goes along.

    Returns
    -------
    theta : (m,), rad

    Raises
    ------
    ValueError
        If the differences round a closed loop of triangles do not sum to zero, two prescribed numbers of
        turns contradict each other, or there is no such triangle.
    """
    where = "angles.consistent"
    principal = checks.array(where, "principal", principal, ())
    F = topology.faces(where, F, int(np.max(F)) + 1)
    if principal.shape != (len(F),):
        checks.fail(
            where, "principal", f"one angle for each of the {len(F)} triangles", f"{principal.shape}", None
        )
    _in_range(where, "seed", seed, len(F))
    pairs = topology.edges(where, F).inner
    number, component = topology.components(len(F), pairs)
    roots = np.full(number, len(F))
    np.minimum.at(roots, component, np.arange(len(F)))
    roots[component[seed]] = seed
    theta = _spread(principal, pairs, roots)
    _closed(where, principal, theta, pairs)
    return theta + FULL * _prescribed(where, principal, theta, component, turns or {})[component]


def _wrapped(angle: Array) -> Array:
    """Return angles brought to [-pi, pi)."""
    return np.mod(angle + np.pi, FULL) - np.pi


def _spread(principal: Array, pairs: NDArray[np.intp], roots: NDArray[np.intp]) -> Array:
    """Carry the roots' angles along spanning trees; a triangle's is the sum of the steps up to its root."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    count = len(principal)
    # One more node, joined to all roots, makes one tree of all components.
    ends = np.concatenate([pairs, np.stack([np.full(len(roots), count), roots], axis=1)])
    graph = coo_array((np.ones(len(ends), np.int8), (ends[:, 0], ends[:, 1])), (count + 1, count + 1))
    before = breadth_first_order(graph.tocsr(), count, directed=False, return_predecessors=True)[1]
    parent = before.astype(np.intp)
    parent[count] = count
    value = np.append(principal, 0.0)
    step = _wrapped(value - value[parent])
    step[roots], step[count] = value[roots], 0.0
    # Twice as far up the tree with each round: the sum over a path of any length in a few steps.
    while not np.all(parent == count):
        step, parent = step + np.where(parent == count, 0.0, step[parent]), parent[parent]
    turns = np.rint((step[:-1] - principal) / FULL)
    # Whole turns added to the given angle: sums of steps would gather rounding errors.
    return principal + FULL * turns


def _closed(where: str, principal: Array, theta: Array, pairs: NDArray[np.intp]) -> None:
    gap = theta[pairs[:, 1]] - theta[pairs[:, 0]]
    open_ = np.abs(gap - _wrapped(principal[pairs[:, 1]] - principal[pairs[:, 0]])) > 1e-6
    # A difference of exactly pi may be taken either way.
    open_ &= np.abs(np.abs(gap) - np.pi) > 1e-6
    if open_.any():
        k = int(np.argmax(open_))
        turns = round(float(gap[k] / FULL))
        checks.fail(
            where,
            "principal",
            "angles that close round every loop of triangles",
            f"{turns:+d} full turns between the neighbours {pairs[k, 0]} and {pairs[k, 1]}",
            None,
            "The shape is wound round a hole; cut it open there.",
        )


def _prescribed(
    where: str, principal: Array, theta: Array, component: NDArray[np.intp], turns: Mapping[int, int]
) -> NDArray[np.intp]:
    """The full turns that each component gains."""
    extra = np.zeros(int(component.max()) + 1, np.intp)
    said: dict[int, int] = {}
    for triangle, wanted in turns.items():
        _in_range(where, "turns", triangle, len(theta))
        # Counted from the triangle's own given angle, wherever the seed lies.
        add = int(wanted) - round(float(theta[triangle] - principal[triangle]) / FULL)
        part = int(component[triangle])
        if part in said and extra[part] != add:
            got = f"{turns[said[part]]} for triangle {said[part]} and {wanted} for triangle {triangle}"
            checks.fail(where, "turns", "alike within a connected part", got, None, "Give one of them.")
        extra[part], said[part] = add, triangle
    return extra


def _in_range(where: str, name: str, triangle: int, count: int) -> None:
    if not 0 <= triangle < count:
        checks.fail(where, name, f"a triangle, 0 to {count - 1}", f"{triangle}", None)
