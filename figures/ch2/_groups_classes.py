"""The nine classes of affine transformations, each with the part of the parameter space that it fills."""

from dataclasses import dataclass
from math import comb

import numpy as np

from lietool.figure import Drawing
from lietool.lie import affine, affine_classes, groups
from lietool.render import camera, plane, scene, style
from lietool.render import letter as shape
from lietool.render.globe import joined
from lietool.render.marks import letter

from . import _groups_cube as cube
from . import _groups_marks as marks
from . import _groups_order as order
from . import _groups_words as words

_CARD, _ICON = (360.0, 138.0), (122.0, 126.0)
# Under the lowest row, and between two rows.
_FOOT, _FREE = 88.0, 56.0
# Sides of the cells of a strip, by the dimension of the space, and the gap between its parts.
_CELLS, _GAP = {2: 24.0, 3: 15.0}, 9.0
# Of the key: its cells, and from one row to the next.
_KEY_CELL, _KEY_ROW = (38.0, 34.0), 44.0
# Standard deviations of what the shape is deformed by: rotation, translation, logarithm of stretch.
_SPREAD = (0.45, 0.20, 0.22)
_NAMES = {"translation": "R", "dilation": "R+"}
# The walls are darker than the front: in an icon's size grey ones would be taken for the shape before.
_AFTER = (style.AFTER, style.GREYS[1], style.BETWEEN_EDGE)
_PARTS = ("rotation", "translation", "stretch")
FREE, TIED, ZERO = "free", "tied", "zero"


@dataclass(frozen=True, eq=False)
class Subspace:
    """A linear subspace of the parameters, found by experiment: what the projection does to each axis."""

    matrix: np.ndarray
    pattern: tuple[str, ...]

    @property
    def dimension(self) -> int:
        """The rank of the projection."""
        return int(np.linalg.matrix_rank(self.matrix))


def subspace(name: str, n: int) -> Subspace:
    """Return the subspace of a class from `affine_classes.project`, the columns being images of the axes."""
    P = affine_classes.project(np.eye(n * (n + 1)), name).T
    pattern = tuple(
        ZERO if not row.any() else FREE if np.array_equal(row, axis) else TIED
        for row, axis in zip(P, np.eye(len(P)), strict=True)
    )
    return Subspace(P, pattern)


def parts(n: int) -> tuple[int, int, int]:
    """Return how many parameters turn, shift and stretch."""
    return comb(n, 2), n, comb(n + 1, 2)


def drawing(n: int, seed: int) -> Drawing:
    """Return the hierarchy of the classes in n dimensions."""
    nodes = [(_NAMES.get(name, name), n) for name in affine_classes.CLASSES]
    spaces = [subspace(name, n) for name in affine_classes.CLASSES]
    params = np.random.default_rng(seed).normal(size=n * (n + 1)) * np.repeat(_SPREAD, parts(n))
    members = np.stack([affine_classes.project(params, name) for name in affine_classes.CLASSES])
    A = affine.phi_so(members)
    maps = groups.edges(nodes)
    # An arrow to the next column begins and ends half way to it: it goes straight up.
    cards, links, page = order.placed(nodes, maps, _CARD, _FOOT, _FREE, (_CARD[0] + order.APART) / 4.0)
    crossings = marks.pass_behind(links)
    records: list[scene.Record] = []
    for c, space in zip(cards, spaces, strict=True):
        records += [*c.records(), *_text(c, space, n)]
    for link in links:
        records += marks.arrow(link)
    records += [*_key(n, page), *_looks(page), *words.legend(links, cards)]
    views = [scene.View(tuple(records)), *_icons(cards, A)]
    numbers = cube.numbers_of(nodes, maps)
    numbers |= {
        "rank": np.array([space.dimension for space in spaces]),
        "pattern": [" ".join(space.pattern) for space in spaces],
        "parameters": params,
        "members": members,
        "matrices": A,
        "crossings": crossings,
    }
    return Drawing(scene.Picture(tuple(views), (round(page[0]), round(page[1]))), numbers)


def _text(card: marks.Card, space: Subspace, n: int) -> list[scene.Record]:
    (x, y), wide = card.center, card.size[0]
    left = x - wide / 2.0 + _ICON[0] + 20.0
    return [
        marks.label(f"${marks.name(*card.node)}$", left, y + 24.0, "ln", size=style.TITLE_TEXT),
        marks.label(f"dim ${space.dimension}$", left, y - 15.0, "ln", color=style.MUTED),
        *strip(space.pattern, n, left, y - 44.0),
    ]


def _offsets(n: int) -> np.ndarray:
    """Left edges of the cells of a strip, from its own."""
    jumps = np.repeat(np.arange(3), parts(n))
    return np.arange(len(jumps)) * _CELLS[n] + jumps * _GAP


def strip(pattern: tuple[str, ...], n: int, left: float, middle: float) -> list[scene.Record]:
    """Return a row of cells: full where a parameter is free, beads on a string where some are equal."""
    return _row(pattern, left + _offsets(n), middle, _CELLS[n])


def _row(pattern: tuple[str, ...], at: np.ndarray, middle: float, side: float) -> list[scene.Record]:
    size = (side, side)
    records = [record for x, kind in zip(at, pattern, strict=True) for record in _cell(x, middle, kind, size)]
    tied = [x + side / 2.0 for x, kind in zip(at, pattern, strict=True) if kind == TIED]
    if tied:
        records.append(_line([(tied[0], middle), (tied[-1], middle)], style.ALGEBRA, style.CURVE))
        beads = [(x, middle, 7.0) for x in tied]
        records.append(scene.Points(beads, style.ALGEBRA, 0.4 * side, shaded=False))
    return records


def _cell(x: float, middle: float, kind: str, size: tuple[float, float]) -> list[scene.Record]:
    low, high, right = middle - size[1] / 2.0, middle + size[1] / 2.0, x + size[0]
    ring = [(x, low), (right, low), (right, high), (x, high), (x, low)]
    corners = [(*p, 5.0) for p in ring[:4]]
    fill = style.ALGEBRA if kind == FREE else style.PAPER
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], fill, material="flat"),
        _line(ring, style.PAPER if kind == FREE else style.BEFORE_EDGE, style.THIN),
    ]


def _line(points: list[tuple[float, float]], color: str, width: float) -> scene.Lines:
    return scene.Lines([(*p, 6.0) for p in points], color, width)


def _indices(n: int) -> tuple[list[str], list[str], list[str]]:
    """What the cells of a strip are, in order: components of a vector, entries of a symmetric matrix.

    In the plane a rotation is one number, which needs no index.
    """
    axes = [str(i + 1) for i in range(n)]
    upper = [axes[i] + axes[j] for i, j in zip(*np.triu_indices(n), strict=True)]
    return axes if n == 3 else [""], axes, upper


def _key(n: int, page: tuple[float, float]) -> list[scene.Record]:
    """What the cells of a strip stand for, from left to right, and the map that they make."""
    wide, x, y = _KEY_CELL[0], 30.0, page[1] - 58.0
    turn = r"\mathbf{x}" if n == 3 else "x"
    records: list[scene.Record] = []
    for name, word, indices in zip((turn, r"\mathbf{l}", "Y"), _PARTS, _indices(n), strict=True):
        records.append(marks.label(f"${name}$", x, y - 10.0, "ln"))
        for i, index in enumerate(indices):
            left = x + 32.0 + wide * i
            records += _cell(left, y, FREE, _KEY_CELL)
            if index:
                records.append(marks.label(f"${index}$", left + wide / 2.0, y - 10.0, color=style.PAPER))
        records.append(marks.label(word, x + 32.0 + wide * len(indices) + 12.0, y - 10.0, "ln"))
        y -= _KEY_ROW
    text = rf"$\mathbf{{p}} \mapsto \exp({turn})\,\exp(Y)\,\mathbf{{p}} + \mathbf{{l}}$"
    return [*records, marks.label(text, x, y - 12.0, "ln")]


def _looks(page: tuple[float, float], side: float = 24.0) -> list[scene.Record]:
    """What the looks of a cell mean."""
    records: list[scene.Record] = []
    x, y = page[0] - 222.0, page[1] - 58.0
    for pattern, word in (((FREE,), "free"), ((ZERO,), "zero"), ((TIED, ZERO, TIED), "equal")):
        at = x + side * (np.arange(len(pattern)) + (3 - len(pattern)) / 2.0)
        records += _row(pattern, at, y, side)
        records.append(marks.label(word, x + 3.0 * side + 18.0, y - 10.0, "ln"))
        y -= _KEY_ROW
    return records


def _icons(cards: list[marks.Card], A: np.ndarray) -> list[scene.View]:
    """The shape before and after one member of each class, all seen from the same place."""
    n = A.shape[-1] - 1
    boxes = [(c.center[0] - c.size[0] / 2.0 + 13.0, c.center[1] - _ICON[1] / 2.0, *_ICON) for c in cards]
    if n == 2:
        return [_flat_icons(boxes, A)]
    corners = shape.solid()[0]
    seen = np.concatenate([corners, *(corners @ B[:3, :3].T + B[:3, 3] for B in A)])
    lens = camera.around(seen, (1.0, 0.42, 0.36), boxes[0], 1.03)
    # One view over the other, so that what comes after lies in front.
    return [
        scene.View(shown, lens, box)
        for box, B in zip(boxes, A, strict=True)
        for shown in (_outlined(), tuple(letter(B[:3, :3], B[:3, 3], colors=_AFTER)))
    ]


def _outlined() -> tuple[scene.Record, ...]:
    """The solid before, as a pale outline that hides its own back."""
    vertices, faces, _ = shape.solid()
    half = len(vertices) // 2
    front, back = vertices[:half], vertices[half:]
    rims = [np.concatenate([rim, rim[:1]]) for rim in (front, back)]
    edges = joined([*rims, *np.stack([front, back], axis=1)])
    return (
        scene.Surface(vertices, faces, style.PAPER, material="flat"),
        scene.Lines(edges, style.BEFORE_EDGE, style.THIN),
    )


def _flat_icons(boxes: list[tuple[float, float, float, float]], A: np.ndarray) -> scene.View:
    outline = shape.outline()
    seen = np.concatenate([outline, *(plane.moved(B, outline) for B in A)])
    records: list[scene.Record] = []
    for box, B in zip(boxes, A, strict=True):
        ground = plane.fit(seen, box)
        records += ground.glyph(np.eye(3), style.PAPER, style.BEFORE_EDGE, width=style.THIN)
        records += ground.glyph(B, style.AFTER, style.AFTER_EDGE, width=style.THIN, alpha=0.85)
    return scene.View(tuple(records))
