"""The nine classes of affine transformations, each with the part of the parameter space that it fills."""

from dataclasses import dataclass
from math import comb

import numpy as np

from lietool.figure import Drawing
from lietool.lie import affine, affine_classes, groups
from lietool.mesh import shapes
from lietool.render import camera, plane, scene, style
from lietool.render.marks import letter

from . import _groups_cube as cube
from . import _groups_marks as marks
from . import _groups_order as order
from . import _groups_words as words

_CARD, _ICON = (360.0, 128.0), 110.0
# Sides of the cells of a strip, by the dimension of the space, and the gap between its parts.
_CELLS, _GAP = {2: 24.0, 3: 16.0}, 10.0
# Standard deviations of what the shape is deformed by: rotation, translation, logarithm of stretch.
_SPREAD = (0.55, 0.30, 0.26)
_NAMES = {"translation": "R", "dilation": "R+"}
# Paler than elsewhere, since the shape after lies over it, and in grey has to stand out from it.
_BEFORE = (style.BEFORE, style.BEFORE_EDGE, style.PAPER)
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
    cards, links, page = order.placed(nodes, maps, _CARD)
    crossings = marks.pass_behind(links)
    records: list[scene.Record] = []
    for c, space in zip(cards, spaces, strict=True):
        records += [*c.records(), *_text(c, space, n)]
    for link in links:
        records += marks.arrow(link)
    records += [*_key(n), *words.legend(links, cards, extra=_legend())]
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
    left = x - wide / 2.0 + _ICON + 14.0
    name = f"${marks.name(*card.node)}$"
    right = x + wide / 2.0 - 16.0
    return [
        marks.label(name, left, y + 14.0, "ln", size=style.TITLE_TEXT),
        marks.label(f"dim ${space.dimension}$", right, y + 14.0, "rn", color=style.MUTED),
        *strip(space.pattern, n, left, y - 30.0),
    ]


def _offsets(n: int) -> np.ndarray:
    """Left edges of the cells of a strip, from its own."""
    jumps = np.repeat(np.arange(3), parts(n))
    return np.arange(len(jumps)) * _CELLS[n] + jumps * _GAP


def strip(pattern: tuple[str, ...], n: int, left: float, middle: float) -> list[scene.Record]:
    """Return a row of cells: full where a parameter is free, beads on a string where some are equal."""
    return _row(pattern, left + _offsets(n), middle, _CELLS[n])


def _row(pattern: tuple[str, ...], at: np.ndarray, middle: float, side: float) -> list[scene.Record]:
    records = [record for x, kind in zip(at, pattern, strict=True) for record in _cell(x, middle, kind, side)]
    tied = [x + side / 2.0 for x, kind in zip(at, pattern, strict=True) if kind == TIED]
    if tied:
        records.append(_line([(tied[0], middle), (tied[-1], middle)], style.ALGEBRA, style.CURVE))
        beads = [(x, middle, 7.0) for x in tied]
        records.append(scene.Points(beads, style.ALGEBRA, 0.4 * side, shaded=False))
    return records


def _cell(x: float, middle: float, kind: str, side: float) -> list[scene.Record]:
    low, high = middle - side / 2.0, middle + side / 2.0
    ring = [(x, low), (x + side, low), (x + side, high), (x, high), (x, low)]
    corners = [(*p, 5.0) for p in ring[:4]]
    fill = style.ALGEBRA if kind == FREE else style.PAPER
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], fill, material="flat"),
        _line(ring, style.PAPER if kind == FREE else style.RULE, style.THIN),
    ]


def _line(points: list[tuple[float, float]], color: str, width: float) -> scene.Lines:
    return scene.Lines([(*p, 6.0) for p in points], color, width)


def _key(n: int) -> list[scene.Record]:
    """What the cells of a strip stand for."""
    offsets, count = _offsets(n), parts(n)
    left, right, y = 40.0, 930.0, 838.0
    records = strip((FREE,) * len(offsets), n, left, y)
    first = 0
    for i, (name, word, size) in enumerate(zip("xlY", _PARTS, count, strict=True)):
        x = left + 0.5 * (offsets[first] + offsets[first + size - 1] + _CELLS[n])
        first += size
        down = y - 8.0 - 44.0 * i
        records.append(marks.label(f"${name}$", float(x), y - 44.0))
        records.append(marks.label(f"${name}$", right, down))
        records.append(marks.label(word, right + 28.0, down, "ln"))
    records.append(marks.label(r"$p \mapsto \exp(x)\,\exp(Y\,)\,p + l$", left, y - 96.0, "ln"))
    return records


def _legend(side: float = 16.0) -> list[words.Mark]:
    """What the looks of a cell mean."""

    def mark(pattern: tuple[str, ...], text: str) -> words.Mark:
        at = side * np.arange(len(pattern))
        return lambda x, y: _row(pattern, x + at, y, side), side * len(pattern), text

    return [mark((FREE,), "free"), mark((TIED, ZERO, TIED), "equal"), mark((ZERO,), "zero")]


def _icons(cards: list[marks.Card], A: np.ndarray) -> list[scene.View]:
    """The shape before and after one member of each class, all seen from the same place."""
    n = A.shape[-1] - 1
    boxes = [(c.center[0] - c.size[0] / 2.0 + 5.0, c.center[1] - _ICON / 2.0, _ICON, _ICON) for c in cards]
    if n == 2:
        return [_flat_icons(boxes, A)]
    corners = shapes.letter_solid()[0]
    seen = np.concatenate([corners, *(corners @ B[:3, :3].T + B[:3, 3] for B in A)])
    lens = camera.around(seen, (1.0, 0.42, 0.36), boxes[0], 1.02)
    before = tuple(letter(np.eye(3), colors=_BEFORE))
    # One view over the other, so that what comes after lies in front.
    return [
        scene.View(shown, lens, box)
        for box, B in zip(boxes, A, strict=True)
        for shown in (before, tuple(letter(B[:3, :3], B[:3, 3])))
    ]


def _flat_icons(boxes: list[tuple[float, float, float, float]], A: np.ndarray) -> scene.View:
    outline = shapes.letter_outline()
    seen = np.concatenate([outline, *(plane.moved(B, outline) for B in A)])
    records: list[scene.Record] = []
    for box, B in zip(boxes, A, strict=True):
        ground = plane.fit(seen, box)
        records += ground.glyph(np.eye(3), style.BEFORE, style.BEFORE_EDGE, width=style.THIN)
        records += ground.glyph(B, style.AFTER, style.AFTER_EDGE, width=style.THIN, alpha=0.85)
    return scene.View(tuple(records))
