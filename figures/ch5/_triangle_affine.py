"""The affine map from one triangle to the other, in the plane and in numbers, for `triangle-interp`."""

import numpy as np

from lietool.render import brackets, plane, scene, style

from . import _triangle_map as maps
from . import _triangle_shape as shapes

_BOX = (90.0, 350.0, 1020.0, 400.0)
_NUMBERS = 150.0
# Exact noughts and ones belong to the form of the matrices.
_BARE = (0.0, 1.0)


def picture(given: maps.Map, t: float) -> scene.Picture:
    """Return the page: both triangles, the arrows between, the source under A and by t d on, the matrix."""
    title = r"$\mathrm{The\ affine\ map\ that\ carries\ }\mathbf{p}\mathrm{\ to\ }\mathbf{q}$"
    records: list[scene.Record] = [
        scene.Label(title, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
    ]
    records += _plane(given, t)
    records += _equation(given)
    return scene.Picture((scene.View(tuple(records)),))


def _plane(given: maps.Map, t: float) -> list[scene.Record]:
    """The triangles where they lie, the origin, the source under A on its way, and the translation."""
    shift = given.affine[:2, 2]
    still = given.source @ given.A.T
    turned, reached = still + t * shift, still + shift
    # The place does not change with t from 0 to 1.
    points = np.concatenate([given.source, still, turned, reached, given.target, [[0.0, 0.0]]])
    place = plane.fit(points, _BOX)
    shape = shapes.Shape.of(given)
    low, high = points.min(axis=0), points.max(axis=0)
    more = 36.0 / place.scale
    records: list[scene.Record] = [
        *place.axes((low[0] - more, high[0] + more), (low[1] - more, high[1] + more)),
    ]
    for A, corners, colors in (
        (np.eye(2), given.source, shapes.stage(0.0, 1.0)),
        (given.A, reached, shapes.stage(1.0, 1.0)),
        (given.A, turned, (style.BETWEEN, style.BETWEEN_EDGE)),
    ):
        middle = place.at(corners.mean(axis=0))
        records += shape.draw(A, (float(middle[0]), float(middle[1])), place.scale, colors)
    return [*records, *_names(given, place), *_moves(place, given, turned, shift, t)]


def _names(given: maps.Map, place: plane.Plane) -> list[scene.Record]:
    records: list[scene.Record] = []
    for name, corners in (("p", given.source), ("q", given.target)):
        records.append(place.dots(corners, style.INK, 5.0))
        for i, out in enumerate(corners - corners.mean(axis=0)):
            said = f"$\\mathbf{{{name}}}_{i + 1}$"
            records.append(place.beyond(said, corners[i], out, size=style.SMALL_TEXT, gap=26.0, room=44.0))
    return records


def _moves(
    place: plane.Plane, given: maps.Map, turned: np.ndarray, shift: np.ndarray, t: float
) -> list[scene.Record]:
    """The arrow from triangle to triangle, and that of the translation, from the origin; their names."""
    records: list[scene.Record] = []
    ends = _between(given.source, given.target, 22.0 / place.scale)
    if ends is not None:
        records += plane.path(place.at(ends), style.MUTED, style.CURVE)
        across = np.array([ends[0, 1] - ends[1, 1], ends[1, 0] - ends[0, 0]])
        records.append(place.beyond(r"$\hat A$", ends.mean(axis=0), across, gap=28.0, room=40.0))
    if np.linalg.norm(shift) * place.scale >= 30.0:
        across = np.array([shift[1], -shift[0]])
        records.append(place.arrow((0.0, 0.0), shift, style.INK))
        records.append(place.beyond(r"$\mathbf{d}$", 0.5 * shift, across, gap=24.0, room=40.0))
    if abs(t - 1.0) > 0.02:
        side = turned[[1, 2]].mean(axis=0)
        said = r"$A\,\mathbf{p}$" if t == 0.0 else r"$A\,\mathbf{p} + t\,\mathbf{d}$"
        out = side - turned.mean(axis=0)
        records.append(place.beyond(said, side, out, gap=40.0, room=80.0))
    return records


def _between(source: np.ndarray, target: np.ndarray, gap: float) -> np.ndarray | None:
    """Where the line between the middles of two triangles is outside both, and a gap away; none if short."""
    start, stop = source.mean(axis=0), target.mean(axis=0)
    length = float(np.linalg.norm(stop - start))
    if length < 1e-9:
        return None
    first = _leaves(source, start, (stop - start) / length) + gap
    last = length - _leaves(target, stop, (start - stop) / length) - gap
    return start + np.array([[first], [last]]) * (stop - start) / length if last - first > 3.0 * gap else None


def _leaves(corners: np.ndarray, start: np.ndarray, along: np.ndarray) -> float:
    """How far from a point inside it one leaves a triangle in a direction."""
    found = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        sides = np.stack([along, a - b], axis=-1)
        if abs(np.linalg.det(sides)) > 1e-12:
            far, part = np.linalg.solve(sides, a - start)
            if far > 0.0 and -1e-9 <= part <= 1.0 + 1e-9:
                found.append(float(far))
    return min(found, default=0.0)


def _equation(given: maps.Map) -> list[scene.Record]:
    """The map between the triangles from their corners, in numbers; its parts named."""
    target, source = (np.vstack([corners.T, np.ones(3)]) for corners in (given.target, given.source))
    widths = [brackets.width(part, _BARE) for part in (target, source, given.affine)]
    left = 600.0 - (sum(widths) + 20.0 + 105.0 - 84.0) / 2.0
    records: list[scene.Record] = [_sign(r"$\hat A\ =$", left - 16.0, "rc")]
    records += brackets.matrix(target, left, _NUMBERS, bare=_BARE)
    left += widths[0] + 20.0
    records += brackets.matrix(source, left, _NUMBERS, bare=_BARE)
    left += widths[1]
    inverse = (left + 4.0, _NUMBERS + 52.0, 0.0)
    records.append(scene.Label("$-1$", inverse, style.INK, style.SMALL_TEXT, anchor="lc"))
    records.append(_sign(r"$\approx$", left + 68.0, "cc"))
    left += 105.0
    records += brackets.matrix(given.affine, left, _NUMBERS, bare=_BARE)
    x0, low, x1, high = brackets.corner(given.affine, left, _NUMBERS, 2, _BARE)
    x0, low, x1, high = x0 - 5.0, low + 2.0, x1 + 9.0, high - 3.0
    box = [(x0, low, 0.0), (x1, low, 0.0), (x1, high, 0.0), (x0, high, 0.0)]
    last = (x1 + left + widths[2]) / 2.0
    names = ((r"$A$", (x0 + x1) / 2.0), (r"$\mathbf{d}$", last))
    return [
        *records,
        scene.Lines([*box, box[0]], style.AFTER_EDGE, style.EDGE),
        *(_above(text, x) for text, x in names),
    ]


def _above(text: str, x: float) -> scene.Label:
    return scene.Label(text, (x, _NUMBERS + 80.0, 0.0), style.INK, style.TEXT, anchor="cn")


def _sign(text: str, x: float, anchor: str) -> scene.Label:
    return scene.Label(text, (x, _NUMBERS, 0.0), style.INK, style.TEXT, anchor=anchor)
