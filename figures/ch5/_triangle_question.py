"""Source, target and what several methods put between them, for `triangle-interp`."""

import numpy as np

from lietool.render import scene, style
from lietool.render.brackets import fixed

from . import _triangle_map as maps
from . import _triangle_shape as shapes

# Where the first and the last moment lie, the part of the page for the lanes, and the line of time.
_LEFT, _RIGHT = 232.0, 1082.0
_LOW, _HIGH, _AXIS = 122.0, 808.0, 84.0
_GAP = 22.0
# The part of the time between source and target in which a lane comes to its height.
_SWING = 0.24
# The corners' names beside a triangle.
_NAMES = 42.0


def picture(given: maps.Map, steps: int, t: float) -> scene.Picture:
    """Return the page: the ends, and a lane with its triangles for each method."""
    shape = shapes.Shape.of(given)
    said = rf"$\mathrm{{Which\ triangle\ at\ }}t = {fixed(t)}\,\mathrm{{?}}$"
    line = shapes.Strip(_LEFT, _RIGHT, min(t, 0.0), max(t, 1.0))
    scale, heights = _places(given, shape, line, steps, t)
    records: list[scene.Record] = [
        scene.Label(said, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        *line.axis(_AXIS, shapes.moments(steps, 0.0)),
        scene.Points([(float(line.x(t)), _AXIS, 0.0)], style.INK, 11.0, rim=style.PAPER, shaded=False),
    ]
    lanes = list(zip(maps.METHODS, heights, strict=True))
    for method, y in lanes:
        records += _lane(given, method, line, float(y))
    records += _ends(given, shape, line, scale)
    for method, y in lanes:
        if given.exists(method):
            records += _stages(given, shape, method, line, float(y), steps, t, scale)
    return scene.Picture((scene.View(tuple(records)),))


def _places(
    given: maps.Map, shape: shapes.Shape, line: shapes.Strip, steps: int, t: float
) -> tuple[float, np.ndarray]:
    """The scale of all triangles, and the heights of the lanes, as far apart as their triangles are high."""
    # Away from the ends, where all lanes meet.
    inside = np.linspace(_SWING, 1.0 - _SWING, 41)
    ends = shape.extent(np.stack([np.eye(2), given.A]))
    gap = (line.right - line.left) / (line.stop - line.start)
    high = [
        2.0 * shape.extent(given.at(method, np.append(inside, t)))[:, 1].max()
        if given.exists(method)
        else 0.0
        for method in maps.METHODS
    ]
    most = [(_HIGH - _LOW) / 2.0 / ends[:, 1].max(), (_LEFT - 130.0) / ends[:, 0].max()]
    for method in maps.METHODS:
        if given.exists(method):
            times = shapes.moments(steps, 0.0) if steps > 1 else np.array([0.0, t, 1.0])
            wide = shape.extent(given.at(method, times))[:, 0]
            most.append(1.04 * gap / len(times[1:]) / float((wide[1:] + wide[:-1]).max()))
    # A lane without triangles has words.
    heights = np.maximum(high, 0.2 * max(high))
    return shapes.stack(heights, _LOW, _HIGH, _GAP, min(most))


def _height(t: np.ndarray, y: float) -> np.ndarray:
    """How high a lane is at moments: it leaves the height of the ends, and comes back to it."""
    part = np.clip(np.minimum(np.abs(t), np.abs(1.0 - t)) / _SWING, 0.0, 1.0)
    middle = (_LOW + _HIGH) / 2.0
    return middle + part**2 * (3.0 - 2.0 * part) * (y - middle)


def _lane(given: maps.Map, method: str, line: shapes.Strip, y: float) -> list[scene.Record]:
    """The way of one method from the source to the target, with its name."""
    color, text = maps.COLORS[method]
    span = np.linspace(line.start, line.stop, 241)
    x, dash = line.x(span), maps.DASHES[method]
    way = np.stack([x, _height(span, y), 0.0 * x], axis=-1)
    sample = [(36.0, y - 10.0, 0.0), (126.0, y - 10.0, 0.0)]
    name = f"${maps.NAMES[method]}$"
    records: list[scene.Record] = [
        scene.Label(name, (36.0, y, 0.0), text, style.SMALL_TEXT, anchor="lb"),
        scene.Lines(sample, color, style.CURVE, dash=dash),
    ]
    if given.exists(method):
        return [*records, scene.Lines(way, color, style.EDGE, dash=dash)]
    none = r"$\mathrm{no\ real\ logarithm}$"
    where = (float(line.x(0.5)), y, 0.0)
    away = np.abs(way[:, 0] - where[0]) > 170.0
    way[~away] = np.nan
    return [
        *records,
        scene.Lines(way, color, style.EDGE, dash=dash),
        scene.Label(none, where, style.WRONG, style.SMALL_TEXT),
    ]


def _stages(
    given: maps.Map,
    shape: shapes.Shape,
    method: str,
    line: shapes.Strip,
    y: float,
    steps: int,
    t: float,
    scale: float,
) -> list[scene.Record]:
    """The triangles of one method at equal steps, in its tint, and outlined that of the moment."""
    color = maps.COLORS[method][0]
    records: list[scene.Record] = []
    for moment in [*np.arange(1, steps) / steps, t]:
        A = given.at(method, moment)
        edge = style.WRONG if np.linalg.det(A) <= 0.0 else color
        here = moment == t
        fill, width = (style.PAPER, style.CURVE) if here else (shapes.tint(edge), style.THIN)
        at = float(line.x(moment)), float(_height(np.array(moment), y))
        records += shape.draw(A, at, scale, (fill, edge), width=width)
    return records


def _ends(given: maps.Map, shape: shapes.Shape, line: shapes.Strip, scale: float) -> list[scene.Record]:
    """Both triangles, with their corners named."""
    records: list[scene.Record] = []
    for k, (A, name) in enumerate(zip((np.eye(2), given.A), "pq", strict=True)):
        at = float(line.x(k)), (_LOW + _HIGH) / 2.0
        records += shape.draw(A, at, scale, shapes.stage(float(k), 1.0))
        for i, corner in enumerate(scale * shape.corners @ A.T):
            out = 26.0 * corner / np.linalg.norm(corner)
            where = (at[0] + corner[0], at[1] + corner[1], 0.0)
            said = f"$\\mathbf{{{name}}}_{i + 1}$"
            records.append(scene.Label(said, where, style.INK, style.SMALL_TEXT, tuple(out), room=_NAMES))
    return records
