"""What the diagrams of groups are drawn with: cards, arrows, names, a legend, and places for labels."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from lietool.lie import groups
from lietool.lie.group_maps import Node
from lietool.render import labels, scene, solids, style

PAGE = (1200.0, 900.0)
MARGIN = 26.0
# From the edge of a card to an arrow's end, and between the sheets of a card.
_CLEAR, SHEET = 9.0, 9.0
_ROUND = 12.0
_HEAD, _WIDE, _HOOK = 19.0, 15.0, 6.0
# By how much a line that passes behind another is broken, to each side.
_BREAK = 9.0
# Where the next sheet of a card is: to the back, but below, so that arrows leave from the front one.
_NEXT = np.array([SHEET, -SHEET])
# From the outer frame of what is compact to its inner one; of the small card in a legend.
_INSET, _SMALL_INSET = 6.0, 4.0
# How far from a corner an arrow begins to turn.
_BEND = 46.0
# The outline of a set that is no group.
_DASH = (9.0, 6.0)
_LETTERS = {"R": r"\mathrm{\mathbb{R}}", "C": r"\mathrm{\mathbb{C}}", "H": r"\mathrm{\mathbb{H}}"}


def name(node: str, n: int | str) -> str:
    """Return the name of a group as mathtext without its dollars."""
    if node == "R":
        return rf"{_LETTERS['R']}^{n}"
    stem, power = node.removesuffix("+").removesuffix("^x"), ""
    if node.endswith("+"):
        power = "^{+}"
    elif node.endswith("^x"):
        power = r"^{\times}"
    base = stem if stem.startswith("S^") else _LETTERS.get(stem, rf"\mathrm{{{stem}}}")
    in_dimension = groups.get(node).only is None and node != "R+"
    return f"{base}{power}({n})" if in_dimension else base + power


def normal(node: str, n: int | str) -> str:
    """Return the normal factor of a semidirect product as mathtext, such as 1 + eps Im H."""
    product = groups.get(node).product
    if product is None:
        raise ValueError(f"_groups_marks.normal: node must be a product; got {node}. See groups.GROUPS.")
    if product.normal in groups.GROUPS:
        return name(product.normal, n)
    words = {"eps": r"\,\varepsilon", "Im": r"\mathrm{Im}\,", "+": "+", **_LETTERS}
    # The dual unit comes last, as in the elements: it does not commute with all of them.
    parts = sorted(product.normal.split(), key=lambda word: word == "eps")
    return f"({''.join(words.get(word, word) for word in parts)})"


@cache
def extent(text: str, size: float = style.SMALL_TEXT) -> tuple[float, float]:
    """Return how wide and high a text is, in page units."""
    rows, columns = labels.Store().get(text, size).coverage.shape
    return float(columns), float(rows)


@dataclass(frozen=True)
class Card:
    """A group on the page: its box, and what is known of its shape."""

    node: Node
    center: tuple[float, float]
    size: tuple[float, float]
    compact: bool
    sheets: int
    group: bool = True

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Left, lower, right and upper edge, with all sheets."""
        (x, y), (w, h), more = self.center, self.size, SHEET * (self.sheets - 1)
        return x - w / 2, y - h / 2 - more, x + w / 2 + more, y + h / 2

    def records(self) -> list[scene.Record]:
        """Return the card: tinted and framed twice if compact, one sheet for each component."""
        records: list[scene.Record] = []
        for k in reversed(range(self.sheets)):
            center, z = np.asarray(self.center) + _NEXT * k, 4.0 - 0.1 * k
            outline = _rounded(center, self.size, z)
            # Its last point is its first.
            faces = solids.fan_faces(len(outline) - 1)
            fill = style.BAND if self.compact else style.PAPER
            records.append(scene.Surface(outline, faces, fill, material="flat"))
            records.append(scene.Lines(outline, style.MUTED, style.EDGE, dash=None if self.group else _DASH))
            if self.compact:
                inset = _INSET if self.size[0] > 60.0 else _SMALL_INSET
                inner = _rounded(center, (self.size[0] - 2.0 * inset, self.size[1] - 2.0 * inset), z, inset)
                records.append(scene.Lines(inner, style.MUTED, style.THIN))
        return records


def card(node: Node, center: ArrayLike, size: tuple[float, float]) -> Card:
    """Return the card of a group, its shape read from the record."""
    x, y = np.asarray(center, float)
    record = groups.get(node[0])
    return Card(node, (float(x), float(y)), size, record.compact, record.components, record.is_group)


def _rounded(center: np.ndarray, size: tuple[float, float], z: float, inset: float = 0.0) -> np.ndarray:
    """A closed rounded rectangle, counter-clockwise, with the corners of one that is larger by an inset."""
    around = _ROUND - inset
    half = np.asarray(size) / 2.0 - around
    turn = np.linspace(0.0, np.pi / 2.0, 9)
    corners = []
    for k, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        angle = turn + k * np.pi / 2.0
        arc = around * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        corners.append(center + half * (sx, sy) + arc)
    ring = np.concatenate([*corners, corners[0][:1]])
    return np.column_stack([ring, np.full(len(ring), z)])


@dataclass(eq=False)
class Link:
    """An arrow between two cards along points of the page; `depth` says which passes behind at a crossing.

    The labels of one `family` like to be at the same part of their arrows.
    """

    map: groups.Map
    points: np.ndarray
    depth: tuple[float, float] = (0.0, 0.0)
    label: str = ""
    family: int | None = None
    gaps: list[float] = field(default_factory=list)

    @property
    def segments(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """The straight pieces."""
        return list(zip(self.points[:-1], self.points[1:], strict=True))


def trimmed(points: ArrayLike, source: Card, target: Card) -> np.ndarray:
    """Return a polyline between the middles of two cards, cut off clear of both."""
    points = np.array(points, float)
    points[0] = _leave(source, points[0], points[1])
    points[-1] = _leave(target, points[-1], points[-2])
    return points


def _leave(card: Card, start: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Where a ray from inside a card has left it and come clear."""
    low, high = np.array(card.box[:2]) - _CLEAR, np.array(card.box[2:]) + _CLEAR
    along = toward - start
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(along > 0.0, (high - start) / along, (low - start) / along)
    return start + along * float(np.min(reach[np.abs(along) > 1e-9]))


def pass_behind(links: Sequence[Link]) -> int:
    """Break, at every crossing of two arrows, the one that lies deeper; return how many cross."""
    count = 0
    for a, b in combinations(links, 2):
        for i, first in enumerate(a.segments):
            for j, second in enumerate(b.segments):
                at = _crossing(first, second)
                if at is None:
                    continue
                count += 1
                depths = [(1.0 - t) * x.depth[0] + t * x.depth[1] for x, t in ((a, at[0]), (b, at[1]))]
                # Where neither is behind, the one that has more to both sides of the crossing.
                room = [_room(x, k, t) for x, k, t in ((a, i, at[0]), (b, j, at[1]))]
                behind = depths[0] > depths[1] if depths[0] != depths[1] else room[0] > room[1]
                deeper, piece, t = (a, i, at[0]) if behind else (b, j, at[1])
                deeper.gaps.append(piece + t)
    return count


def _room(link: Link, piece: int, t: float) -> float:
    """How far a place of an arrow is from the nearer of its ends."""
    steps = np.linalg.norm(np.diff(link.points, axis=0), axis=-1)
    before = float(steps[:piece].sum() + t * steps[piece])
    return min(before, float(steps.sum()) - before)


def _crossing(
    first: tuple[np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray]
) -> tuple[float, float] | None:
    u, v, w = first[1] - first[0], second[1] - second[0], second[0] - first[0]
    area = u[0] * v[1] - u[1] * v[0]
    if abs(area) < 1e-9:
        return None
    s, t = (w[0] * v[1] - w[1] * v[0]) / area, (w[0] * u[1] - w[1] * u[0]) / area
    return (float(s), float(t)) if 0.0 < s < 1.0 and 0.0 < t < 1.0 else None


def arrow(link: Link) -> list[scene.Record]:
    """Return an arrow: with a hook where it is an inclusion, with two heads where it covers."""
    covering = link.map.kind == "covering"
    color, width = (style.GROUP, style.CURVE) if covering else (style.INK, style.EDGE)
    points = link.points
    along = points[-1] - points[-2]
    along = along / np.linalg.norm(along)
    across = np.array([-along[1], along[0]])
    records: list[scene.Record] = []
    tips = [points[-1]] + ([points[-1] - 0.85 * _HEAD * along] if covering else [])
    for tip in tips:
        barb = tip - _HEAD * along
        notch = tip - 0.72 * _HEAD * along
        corners = np.stack([tip, barb + _WIDE / 2.0 * across, notch, barb - _WIDE / 2.0 * across])
        records.append(scene.Surface(_flat(corners, 1.0), [[0, 1, 2], [0, 2, 3]], color, material="flat"))
    shaft = points.copy()
    shaft[-1] = tips[-1] - 0.7 * _HEAD * along
    pieces = _broken(shaft, _along(points, link.gaps))
    if not covering:
        first = points[1] - points[0]
        first = first / np.linalg.norm(first)
        # To the left, unless that is below.
        side = np.array([-first[1], first[0]]) * (1.0 if first[0] > -1e-9 else -1.0)
        turn = np.linspace(np.pi, 0.0, 15)[:, None]
        start = pieces[0][0] + _HOOK * first
        hook = start + _HOOK * (side + side * np.cos(turn) - first * np.sin(turn))
        pieces[0][0] = start
        records.append(scene.Lines(_flat(hook, 1.0), color, width))
    records += [scene.Lines(_flat(_bent(piece), 1.0), color, width) for piece in pieces]
    return records


def _bent(points: np.ndarray) -> np.ndarray:
    """A polyline with its corners rounded off."""
    t = np.linspace(0.0, 1.0, 9)[:, None]
    pieces = [points[:1]]
    for a, b, c in zip(points, points[1:], points[2:], strict=False):
        lengths = [float(np.linalg.norm(end - b)) for end in (a, c)]
        cut = [b + min(_BEND, 0.5 * far) / far * (end - b) for end, far in zip((a, c), lengths, strict=True)]
        pieces.append((1.0 - t) ** 2 * cut[0] + 2.0 * t * (1.0 - t) * b + t**2 * cut[1])
    return np.concatenate([*pieces, points[-1:]])


def _lengths(points: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=-1))])


def _along(points: np.ndarray, gaps: Iterable[float]) -> list[float]:
    """How far along a polyline places are that are given as a segment's number and the part of it."""
    return sorted(float(np.interp(gap, np.arange(len(points)), _lengths(points))) for gap in gaps)


def _broken(points: np.ndarray, gaps: Sequence[float]) -> list[np.ndarray]:
    """A polyline without a piece around each place, given by how far along it is."""
    length = _lengths(points)
    ends = [0.0, *(gap + side for gap in gaps for side in (-_BREAK, _BREAK)), float(length[-1])]
    pieces = []
    for low, high in zip(ends[::2], ends[1::2], strict=True):
        if high <= low:
            continue
        inside = length[(length > low) & (length < high)]
        at = np.concatenate([[low], inside, [high]])
        pieces.append(np.stack([np.interp(at, length, column) for column in points.T], axis=-1))
    return pieces


def _flat(points: np.ndarray, z: float) -> np.ndarray:
    return np.column_stack([points, np.full(len(points), z)])


def label(
    text: str,
    x: float,
    y: float,
    anchor: str = "cn",
    color: str = style.INK,
    size: float = style.SMALL_TEXT,
) -> scene.Label:
    """Return a label at a point of the page."""
    return scene.Label(text, (x, y, 5.0), color, size, anchor=anchor, halo=False)
