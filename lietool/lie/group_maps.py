"""The maps between the groups of `groups`: inclusions and double coverings, and the order they make."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.lie import dual_complex, dual_quaternion, quaternion

Array = NDArray[np.float64]
Node = tuple[str, int]
"""A group and the dimension of the space it moves: ("SE", 3) is SE(3), ("DCN", 2) acts on the plane."""


@dataclass(frozen=True)
class Map:
    """A map between two groups, g -> act(g).

    `kind` is "inclusion" (one-to-one, respects products), "subset" (an inclusion where one of the two is no
    group) or "covering" (onto, respects products, `degree` elements to each; `lift` gives one of them).
    `n` are the dimensions of source and target; None for every n, the same in both.
    """

    source: str
    target: str
    kind: str
    act: Callable[[Array], Array]
    n: tuple[int, int] | None = None
    degree: int = 1
    lift: Callable[[Array], Array] | None = None

    def ends(self, n: int) -> tuple[Node, Node] | None:
        """Return source and target, the source moving R^n; None if the map has other dimensions."""
        if self.n is None:
            return (self.source, n), (self.target, n)
        return ((self.source, self.n[0]), (self.target, self.n[1])) if self.n[0] == n else None


def _same(A: Array) -> Array:
    return A.copy()


def _after_one(A: Array) -> Array:
    """Return diag(1, A): the plane as the yz-plane of space, where unit complex numbers turn about x."""
    B = np.zeros((*A.shape[:-2], A.shape[-2] + 1, A.shape[-1] + 1))
    B[..., 0, 0] = 1.0
    B[..., 1:, 1:] = A
    return B


def homogeneous(A: Array) -> Array:
    """Return the matrix of (3.2) without translation."""
    B = np.zeros((*A.shape[:-2], A.shape[-2] + 1, A.shape[-1] + 1))
    B[..., :-1, :-1] = A
    B[..., -1, -1] = 1.0
    return B


def _pad(zeros: int) -> Callable[[Array], Array]:
    return lambda a: np.concatenate([a, np.zeros((*a.shape[:-1], zeros))], axis=-1)


def _turn(a: Array) -> Array:
    """Return the rotation by twice the angle: v -> p^2 v."""
    c, s = a[..., 0] ** 2 - a[..., 1] ** 2, 2.0 * a[..., 0] * a[..., 1]
    return np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)


def _half_turn(R: Array) -> Array:
    theta = 0.5 * np.arctan2(R[..., 1, 0], R[..., 0, 0])
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def _inclusions(act: Callable[[Array], Array], pairs: str, n: tuple[int, int] | None = None) -> list[Map]:
    # Sym+ is no group, so nothing that begins or ends there respects products.
    ends = [pair.split("<") for pair in pairs.split()]
    return [Map(s, t, "subset" if "Sym+" in (s, t) else "inclusion", act, n) for s, t in ends]


MAPS = (
    *_inclusions(_same, "SO<O SO<SL SO<CO+ SL<GL+ O<GL GL+<GL CO+<GL+ R+<CO+ R+<Diag+ Diag+<Sym+ Sym+<GL+"),
    *_inclusions(_same, "R<SE SE<E SE<Sim+ E<Aff Sim+<Aff+ Aff+<Aff S^1<C^x S^3<H^x DQ<DQ^x"),
    *_inclusions(homogeneous, "SO<SE O<E CO+<Sim+ GL+<Aff+ GL<Aff"),
    *_inclusions(_after_one, "SO<SO SE<SE", (2, 3)),
    *_inclusions(_pad(2), "S^1<S^3 C^x<H^x", (2, 3)),
    *_inclusions(_pad(2), "S^1<DCN"),
    *_inclusions(_pad(4), "S^3<DQ H^x<DQ^x"),
    *_inclusions(dual_complex.to_dual_quaternion, "DCN<DQ", (2, 3)),
    Map("S^1", "SO", "covering", _turn, (2, 2), 2, _half_turn),
    Map(
        *("S^3", "SO", "covering", lambda q: quaternion.to_matrix(q, check=False), (3, 3), 2),
        lambda R: quaternion.from_matrix(R, check=False),
    ),
    Map(
        *("DCN", "SE", "covering", lambda p: dual_complex.to_matrix(p, check=False), (2, 2), 2),
        lambda A: dual_complex.from_matrix(A, check=False),
    ),
    Map(
        *("DQ", "SE", "covering", lambda q: dual_quaternion.to_matrix(q, check=False), (3, 3), 2),
        lambda A: dual_quaternion.from_matrix(A, check=False),
    ),
)


def _route(source: Node, target: Node) -> list[Map] | None:
    """Return the inclusions that lead from one group to another, the fewest; None if it is not inside."""
    routes: dict[Node, list[Map]] = {source: []}
    queue = [source]
    for name, n in queue:
        for step in MAPS:
            ends = step.ends(n)
            if step.kind != "covering" and ends and ends[0] == (name, n) and ends[1] not in routes:
                routes[ends[1]] = [*routes[(name, n)], step]
                queue.append(ends[1])
    return routes.get(target)


def contains(larger: Node, smaller: Node) -> bool:
    """Tell whether one group lies in another, by the inclusions."""
    return _route(smaller, larger) is not None


def inclusion(source: Node, target: Node) -> Map:
    """Return the inclusion of one group in another, composed of those in MAPS.

    Raises
    ------
    ValueError
        If the source does not lie in the target.
    """
    route = _route(source, target)
    if route is None:
        raise ValueError(f"groups.inclusion: target must contain {source}; got {target}. See groups.MAPS.")

    def act(A: Array) -> Array:
        for step in route:
            A = step.act(A)
        return A

    kind = "subset" if any(step.kind == "subset" for step in route) else "inclusion"
    return Map(source[0], target[0], kind, act, (source[1], target[1]))


def edges(nodes: Sequence[Node]) -> tuple[Map, ...]:
    """Return the lines of a diagram of groups: inclusions with none of the others between, and coverings.

    Book: (2.29), (2.30)
    """
    found = [
        inclusion(a, b)
        for a in nodes
        for b in nodes
        if a != b
        and contains(b, a)
        and not any(c not in (a, b) and contains(c, a) and contains(b, c) for c in nodes)
    ]
    covers = [m for m in MAPS if m.kind == "covering" and m.n and set(m.ends(m.n[0]) or ()) <= set(nodes)]
    return (*found, *covers)
