"""Eight groups as the corners of a cube: each direction in space is a relation between groups."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lietool.figure import Drawing
from lietool.lie import groups
from lietool.lie.group_maps import Node
from lietool.render import scene, style

from . import _groups_marks as marks
from . import _groups_words as words

# A step to the right, up and back, on the page; and where the corner without any of them is.
_STEPS = np.array([[546.0, 0.0], [0.0, 412.0], [366.0, 222.0]])
_CARD = (220.0, 104.0)
_BOTTOM = 162.0
# Between a name and the dimension beside it.
_BETWEEN = 14.0


@dataclass(frozen=True)
class Direction:
    """A relation between groups: which groups have it, and the label of an arrow to one that does."""

    has: Callable[[Node], bool]
    label: Callable[[groups.Map], str]


def _translations(node: Node) -> bool:
    made = groups.get(node[0]).product
    return made is not None and made.kind == "semidirect"


def _covered(node: Node) -> bool:
    return any(m.kind == "covering" and m.n and (m.target, m.n[1]) == node for m in groups.MAPS)


def _deforms(node: Node) -> bool:
    """Whether the linear part is not compact: more than rotations and reflections."""
    made = groups.get(node[0]).product
    return not groups.get(made.acting if made else node[0]).compact


def _times(m: groups.Map, n: int | str) -> str:
    return rf"${{\ltimes}}\,{marks.normal(m.target, n)}$"


# What the arrows of figure 2.9 do, by their sources; tests hold each against the map itself.
_INTO_SPACE = {
    "S^1": r"$z \mapsto z$",
    "DCN": r"$p_1\varepsilon \mapsto p_1\,j\,\varepsilon$",
    "SO": r"$R \mapsto \mathrm{diag}(1, R)$",
    "SE": r"$A \mapsto \mathrm{diag}(1, A)$",
}
_MOVES = {
    "S^1": r"$v \mapsto z^2\,v$",
    "DCN": r"$v \mapsto p_0^2\,v + 2\,p_0\,p_1$",
    "S^3": r"$v \mapsto q\,v\,\bar{q}$",
    "DQ": r"$v \mapsto q\,v\,\bar{q} + 2\,w\,\bar{q}$",
}


def _dimension(m: groups.Map) -> int:
    return m.n[1] if m.n else 3


_ELEMENTS = {
    ("S^1", 2): "z",
    ("S^3", 3): "q",
    ("DCN", 2): r"p_0 + p_1\varepsilon",
    ("DQ", 3): r"q + w\,\varepsilon",
    **{("SO", n): "R" for n in (2, 3)},
    **{("SE", n): "A" for n in (2, 3)},
}
DUAL_NODES = tuple(_ELEMENTS)
DUAL = (
    Direction(lambda node: node[1] == 3, lambda m: _INTO_SPACE[m.source]),
    Direction(_translations, lambda m: _times(m, _dimension(m))),
    Direction(_covered, lambda m: _MOVES[m.source]),
)
INCLUDED = ("SO", "O", "GL+", "GL", "SE", "E", "Aff+", "Aff")


def inclusions(n: int | str) -> tuple[Direction, ...]:
    """Return the directions of figure 3.1."""
    return (
        Direction(lambda node: not groups.get(node[0]).connected, lambda m: "index $2$"),
        Direction(_translations, lambda m: _times(m, n)),
        Direction(_deforms, lambda m: rf"${{\cdot}}\,{marks.name('Sym+', n)}$"),
    )


def drawing(nodes: Sequence[Node], directions: Sequence[Direction], shown: str) -> Drawing:
    """Return a cube of groups; `shown` is "2", "3", or "both" for names with n and two dimensions."""
    corners = np.array([[int(d.has(node)) for d in directions] for node in nodes])
    low = np.array([(marks.PAGE[0] - _STEPS[:, 0].sum() - marks.SHEET) / 2.0, _BOTTOM])
    places = low + corners @ _STEPS
    cards = [marks.card(node, place, _CARD) for node, place in zip(nodes, places, strict=True)]
    at = {node: i for i, node in enumerate(nodes)}
    links = []
    for m in groups.edges(nodes):
        ends = m.ends(m.n[0]) if m.n else None
        if ends is None:
            continue
        i, j = (at[end] for end in ends)
        axis = int(np.flatnonzero(corners[i] != corners[j])[0])
        points = marks.trimmed(places[[i, j]], cards[i], cards[j])
        depth = (float(corners[i, 2]), float(corners[j, 2]))
        links.append(marks.Link(m, points, depth, directions[axis].label(m), axis))
    crossings = marks.pass_behind(links)
    records: list[scene.Record] = []
    for c in cards:
        records += [*c.records(), *_text(c, shown)]
    for link in links:
        records += marks.arrow(link)
    records += words.place_labels(links, cards)
    dimensions: words.Mark = (lambda x, y: (), 0.0, "dim for $n = 2, 3$")
    records += words.legend(links, cards, extra=[dimensions] if shown == "both" else [])
    numbers = numbers_of(nodes, [link.map for link in links], (2, 3) if shown == "both" else None)
    numbers |= {"corner": corners, "crossings": crossings}
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def _text(card: marks.Card, shown: str) -> list[scene.Record]:
    (x, y), (name, n) = card.center, card.node
    record = groups.get(name)
    both = shown == "both"
    title = f"${marks.name(name, 'n' if both else n)}$"
    values = r",\,".join(str(record.dimension(k)) for k in ((2, 3) if both else (n,)))
    dimension = f"dim ${values}$"
    if shown != "elements":
        return [
            marks.label(title, x, y + 6.0, size=style.TITLE_TEXT),
            marks.label(dimension, x, y - 34.0, color=style.MUTED),
        ]
    # Name and dimension side by side, in the middle together.
    wide = marks.extent(title, style.TITLE_TEXT)[0] + _BETWEEN
    left = x - (wide + marks.extent(dimension)[0]) / 2.0
    return [
        marks.label(title, left, y + 7.0, "ln", size=style.TITLE_TEXT),
        marks.label(dimension, left + wide, y + 7.0, "ln", color=style.MUTED),
        marks.label(f"${_ELEMENTS[card.node]}$", x, y - 36.0),
    ]


def numbers_of(
    nodes: Sequence[Node], maps: Sequence[groups.Map], dimensions: Sequence[int] | None = None
) -> dict[str, object]:
    """Return what a diagram says, as numbers and texts."""
    records = [groups.get(name) for name, _ in nodes]
    return {
        "nodes": [groups.label(*node) for node in nodes],
        "dimension": np.array(
            [[r.dimension(k) for k in dimensions or (n,)] for r, (_, n) in zip(records, nodes, strict=True)]
        ),
        "components": np.array([r.components for r in records]),
        "compact": np.array([r.compact for r in records]),
        "arrows": [
            f"{groups.label(m.source, m.n[0])} -> {groups.label(m.target, m.n[1])}: {m.kind}"
            for m in maps
            if m.n
        ],
        "degree": np.array([m.degree for m in maps]),
    }
