"""Source, target and what several methods put between them, for `triangle-interp`."""

import numpy as np

from lietool.render import brackets, scene, style
from lietool.render.brackets import fixed

from . import _triangle_map as maps
from . import _triangle_shape as shapes

# The ends' middles, where the lanes begin and end, and the rooms of a triangle.
_LEFT, _RIGHT, _START, _STOP = 150.0, 1050.0, 380.0, 820.0
_ENDS = (190.0, 250.0)
# How far lanes are level before the first moment and after the last.
_LEVEL = 120.0
_MIDDLE, _PITCH = 430.0, 176.0
_NUMBERS = 92.0


def picture(given: maps.Map, steps: int, t: float, equations: bool) -> scene.Picture:
    """Return the page: the ends, and a lane with a triangle for each method."""
    shape = shapes.Shape.of(given)
    middle, pitch = (_MIDDLE + 60.0, 150.0) if equations else (_MIDDLE, _PITCH)
    question = r"One\ map,\,four\ ways\ to\ it:\ \ " if equations else r"Which\ triangle\ at\ "
    said = rf"$\mathrm{{{question}}}t = {fixed(t)}" + ("$" if equations else r"\,\mathrm{?}$")
    records: list[scene.Record] = [
        scene.Label(said, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
    ]
    line = shapes.Strip(_START, _STOP, min(t, 0.0), max(t, 1.0))
    scale = _scale(given, shape, line, steps, t, pitch)
    for k, method in enumerate(maps.METHODS):
        y = middle + pitch * (1.5 - k)
        records += _lane(given, shape, method, line, y, middle, steps, t, scale)
    records += _ends(given, shape, middle)
    if equations:
        records += _equation(given)
    return scene.Picture((scene.View(tuple(records)),))


def _scale(
    given: maps.Map, shape: shapes.Shape, line: shapes.Strip, steps: int, t: float, pitch: float
) -> float:
    times = np.unique(np.append(np.linspace(0.0, 1.0, 61), t))
    films = [given.at(method, times) for method in maps.METHODS if given.exists(method)]
    gap = (line.right - line.left) / (line.stop - line.start) / max(steps, 3)
    wide, high = np.concatenate([shape.extent(film) for film in films]).max(axis=0)
    return float(min(gap / 2.0 / wide, (pitch - 30.0) / 2.0 / high))


def _lane(
    given: maps.Map,
    shape: shapes.Shape,
    method: str,
    line: shapes.Strip,
    y: float,
    middle: float,
    steps: int,
    t: float,
    scale: float,
) -> list[scene.Record]:
    """The way of one method from the source to the target, with its name and its triangles."""
    color, text = maps.COLORS[method]
    name = scene.Label(
        "$A^t$" if method == "matrix-log" else f"${maps.NAMES[method]}$",
        (line.left - _LEVEL, y, 0.0),
        text,
        style.SMALL_TEXT,
        (4.0, 12.0),
        "lb",
    )
    if not given.exists(method):
        way = [_swing(_LEFT, line.left - _LEVEL, middle, y), _swing(_RIGHT, line.right + _LEVEL, middle, y)]
        none = r"$\mathrm{no\ real\ logarithm}$"
        where = ((line.left + line.right) / 2.0, y, 0.0)
        return [
            *(scene.Lines(part, color, style.EDGE, dash=maps.DASHES[method]) for part in way),
            scene.Label(none, where, style.WRONG, style.SMALL_TEXT),
            name,
        ]
    way = np.concatenate(
        [_swing(_LEFT, line.left - _LEVEL, middle, y), _swing(_RIGHT, line.right + _LEVEL, middle, y)[::-1]]
    )
    records: list[scene.Record] = [scene.Lines(way, color, style.EDGE, dash=maps.DASHES[method]), name]
    for moment in np.arange(1, steps) / steps:
        A = given.at(method, moment)
        colors = shapes.stage(float(moment), float(np.linalg.det(A)))
        records += shape.draw(A, (float(line.x(moment)), y), scale, colors, width=style.THIN)
    now = given.at(method, t)
    edge = style.WRONG if np.linalg.det(now) <= 0.0 else color
    return [*records, *shape.draw(now, (float(line.x(t)), y), scale, (style.PAPER, edge), width=style.CURVE)]


def _swing(x0: float, x1: float, y0: float, y1: float) -> np.ndarray:
    """A line that leaves one point level and comes to another level; shape (41, 3)."""
    part = np.linspace(0.0, 1.0, 41)
    smooth = part**2 * (3.0 - 2.0 * part)
    return np.stack([x0 + part * (x1 - x0), y0 + smooth * (y1 - y0), 0.0 * part], axis=-1)


def _ends(given: maps.Map, shape: shapes.Shape, middle: float) -> list[scene.Record]:
    """Both triangles, with their corners named."""
    ends = np.stack([np.eye(2), given.A])
    scale = float((np.array(_ENDS) / 2.0 / shape.extent(ends).max(axis=0)).min())
    records: list[scene.Record] = []
    for k, (A, x, name) in enumerate(zip(ends, (_LEFT, _RIGHT), "pq", strict=True)):
        corners = scale * shape.corners @ A.T
        # Paper behind, so that the lanes end at the triangle.
        records += shape.draw(A, (x, middle), scale, shapes.stage(float(k), 1.0))
        for i, corner in enumerate(corners):
            out = corner / np.linalg.norm(corner)
            at = (x + corner[0], middle + corner[1], 0.0)
            prime = f"$\\mathbf{{{name}}}_{i + 1}$"
            records.append(scene.Label(prime, at, style.INK, style.SMALL_TEXT, tuple(26.0 * out), room=44.0))
        moment = f"$t = {k}$"
        low = middle + float(corners[:, 1].min()) - 84.0
        records.append(scene.Label(moment, (x, low, 0.0), style.MUTED, style.SMALL_TEXT, anchor="cn"))
    return records


def _equation(given: maps.Map) -> list[scene.Record]:
    """The map between the triangles from their corners, in numbers."""
    target, source = (np.vstack([corners.T, np.ones(3)]) for corners in (given.target, given.source))
    widths = [brackets.width(part) for part in (target, source, given.affine)]
    left = 600.0 - (sum(widths) + 20.0 + 105.0 - 84.0) / 2.0
    records: list[scene.Record] = [_sign(r"$\hat A\ =$", left - 16.0, "rc")]
    records += brackets.matrix(target, left, _NUMBERS)
    left += widths[0] + 20.0
    records += brackets.matrix(source, left, _NUMBERS)
    left += widths[1]
    records.append(
        scene.Label("$-1$", (left + 4.0, _NUMBERS + 52.0, 0.0), style.INK, style.SMALL_TEXT, anchor="lc")
    )
    records.append(_sign(r"$\approx$", left + 68.0, "cc"))
    return [*records, *brackets.matrix(given.affine, left + 105.0, _NUMBERS)]


def _sign(text: str, x: float, anchor: str) -> scene.Label:
    return scene.Label(text, (x, _NUMBERS, 0.0), style.INK, style.TEXT, anchor=anchor)
