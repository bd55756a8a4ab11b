"""Groups in layers: every arrow goes upwards, to the next larger ones."""

from collections.abc import Sequence

import numpy as np

from lietool.figure import Drawing, nearest, quoted
from lietool.lie import groups
from lietool.lie.group_maps import Node
from lietool.render import scene, style

from . import _groups_cube as cube
from . import _groups_layout as layout
from . import _groups_marks as marks
from . import _groups_words as words

# Between two cards of a row, between a card and an arrow that passes, and between the arrows of a card.
APART, _ASIDE, _PORT = 28.0, 26.0, 30.0
# How far from the middle of a card an arrow begins if it leads aside.
_SIDE = 40.0
_HIGH = 88.0
# The least that is free between two rows, for the arrows and their labels.
_FREE = 80.0
_FOOT = 92.0
# How far arrows stay away from the cards that they pass.
_WAY = 16.0


def read(text: str, n: int) -> list[Node]:
    """Return the groups of a text such as SO,SE(2),DQ; those without a dimension of their own get n.

    Raises
    ------
    ValueError
        If a name is unknown, given twice, or has another dimension than 2 or 3.
    """
    nodes: list[Node] = []
    for word in filter(None, (word.strip() for word in text.split(","))):
        name, _, rest = word.partition("(")
        if name not in groups.GROUPS:
            hint = nearest(name, groups.GROUPS) or f" Known: {', '.join(groups.GROUPS)}."
            raise ValueError(f"nodes must be names of groups; got {quoted(name)}.{hint}")
        only = groups.GROUPS[name].only
        if rest and (rest not in ("2)", "3)") or only not in (None, int(rest[0]))):
            wanted = name if only else f"{name}(2) or {name}(3)"
            raise ValueError(
                f"nodes must have a dimension that they exist in; got {quoted(word)}. Write {wanted}"
            )
        node = (name, int(rest[0]) if rest else only or n)
        if node in nodes:
            raise ValueError(f"nodes must be different; got {word!r} twice. Leave one out")
        nodes.append(node)
    if not nodes:
        raise ValueError(f"nodes must name a group; got {quoted(text)}. Write for example SO,O,GL")
    return nodes


def drawing(nodes: Sequence[Node]) -> Drawing:
    """Return the order of any groups, drawn from below upwards."""
    maps = groups.edges(nodes)
    titles = [f"${marks.name(*node)}$" for node in nodes]
    under = [f"dim ${groups.get(name).dimension(n)}$" for name, n in nodes]
    widths = [marks.extent(text, style.TITLE_TEXT)[0] for text in (*titles, *under)]
    cards, links, page = placed(nodes, maps, (max(widths) + 44.0, _HIGH))
    for link in links:
        if link.map.kind == "covering":
            link.label = rf"${link.map.degree} : 1$"
    crossings = marks.pass_behind(links)
    records: list[scene.Record] = []
    for c, title, dimension in zip(cards, titles, under, strict=True):
        x, y = c.center
        records += c.records()
        records.append(marks.label(title, x, y + 4.0, size=style.TITLE_TEXT))
        records.append(marks.label(dimension, x, y - 32.0, color=style.MUTED))
    for link in links:
        records += marks.arrow(link)
    records += words.place_labels(links, cards, page)
    records += words.legend(links, cards, page=page)
    numbers = cube.numbers_of(nodes, maps)
    numbers |= {
        "level": np.unique([c.center[1] for c in cards], return_inverse=True)[1],
        "crossings": crossings,
    }
    return Drawing(scene.Picture((scene.View(tuple(records)),), (round(page[0]), round(page[1]))), numbers)


def placed(
    nodes: Sequence[Node],
    maps: Sequence[groups.Map],
    size: tuple[float, float],
    foot: float = _FOOT,
    free: float = _FREE,
    side: float = _SIDE,
) -> tuple[list[marks.Card], list[marks.Link], tuple[float, float]]:
    """Return cards and arrows in layers, and the page that holds them: larger if they need it.

    `free` is the least between two rows; an arrow that leads aside begins `side` from the middle of a card.
    """
    at = {node: i for i, node in enumerate(nodes)}
    arrows = [(at[m.source, m.n[0]], at[m.target, m.n[1]]) for m in maps if m.n]
    edges = size[0] + 2.0 * marks.MARGIN + marks.SHEET
    width = marks.PAGE[0] - edges
    found = layout.arrange(len(nodes), arrows, size[0] + APART, size[0] / 2.0 + _ASIDE, width)
    rows = int(found.level.max()) + 1
    span = float(np.ptp(np.concatenate([found.x, *(way[:, 0] for way in found.ways)]))) + edges
    tall = foot + rows * size[1] + (rows - 1) * free + 2.0 * marks.MARGIN
    grown = max(1.0, span / marks.PAGE[0], tall / marks.PAGE[1])
    page = (marks.PAGE[0] * grown, marks.PAGE[1] * grown)
    low, high = foot + size[1] / 2.0, page[1] - marks.MARGIN - size[1] / 2.0 - 10.0
    # Few rows keep together in the middle.
    step = min((high - low) / max(rows - 1, 1), 2.6 * size[1])
    low += (high - low - step * (rows - 1)) / 2.0
    middle = page[0] / 2.0

    def point(x: float, level: float) -> np.ndarray:
        return np.array([middle + x, low + step * level])

    cards = [
        marks.card(node, point(x, k), size) for node, x, k in zip(nodes, found.x, found.level, strict=True)
    ]
    links = [
        marks.Link(m, _route(np.array([point(*p) for p in way]), size[1]))
        for m, way in zip(maps, found.ways, strict=True)
    ]
    _apart(links, cards, arrows, side)
    for link in links:
        link.points = _taut(link.points, cards)
    return cards, links, page


def _route(points: np.ndarray, height: float) -> np.ndarray:
    """Upright past the cards of every row between."""
    half = np.array([0.0, height / 2.0 + 18.0])
    between = [end for p in points[1:-1] for end in (p - half, p + half)]
    return np.stack([points[0], *between, points[-1]])


def _taut(points: np.ndarray, cards: Sequence[marks.Card]) -> np.ndarray:
    """The way with as few corners as the cards leave it."""
    kept, at = [points[0]], 0
    while at < len(points) - 1:
        at = next(
            k for k in range(len(points) - 1, at, -1) if k == at + 1 or _clear(kept[-1], points[k], cards)
        )
        kept.append(points[at])
    return np.array(kept)


def _clear(a: np.ndarray, b: np.ndarray, cards: Sequence[marks.Card]) -> bool:
    """Whether a straight line stays away from all cards, but for those at its ends."""
    way = a + np.linspace(0.0, 1.0, 160)[:, None] * (b - a)
    for c in cards:
        low, high = np.array(c.box[:2]) - _WAY, np.array(c.box[2:]) + _WAY
        # At its ends an arrow may be as near as it is to begin with.
        if np.any(np.all((way > low) & (way < high), axis=1)[10:-10]):
            return False
    return True


def _apart(
    links: Sequence[marks.Link], cards: Sequence[marks.Card], arrows: Sequence[tuple[int, int]], side: float
) -> None:
    """Let the arrows of a card begin and end side by side, each as near as it can to where it leads."""
    ways = [link.points.copy() for link in links]
    for i, c in enumerate(cards):
        reach = c.size[0] / 2.0 - _PORT
        for end, other, edge in ((0, 1, c.box[3] + 13.0), (-1, -2, c.box[1] - 9.0)):
            mine = [k for k, arrow in enumerate(arrows) if arrow[end] == i]
            if not mine:
                continue
            mine.sort(key=lambda k, other=other: float(ways[k][other][0]))
            step = min(_PORT, 2.0 * reach / max(len(mine) - 1, 1)) * np.arange(len(mine))
            wanted = np.array([np.clip(ways[k][other][0] - c.center[0], -side, side) for k in mine])
            ports = np.clip(layout.rising(wanted - step), -reach, reach - step[-1]) + step
            for k, x in zip(mine, ports, strict=True):
                links[k].points[end] = (c.center[0] + x, edge)
