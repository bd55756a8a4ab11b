"""Strips of frames: one way or two above each other, and below them what is measured, over t."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lietool.interp import shape
from lietool.mesh import topology
from lietool.render import scene, style
from lietool.render.plane import Plane
from lietool.render.plot import Axes, number

from . import _morph
from . import _morph_marks as marks

Array = np.ndarray

_LEFT, _RIGHT = 40.0, 1160.0
_FILLED = 0.93
_COLORS = ((style.ROUTE_1, style.ROUTE_1_TEXT, None), (style.ROUTE_2, style.ROUTE_2_TEXT, (13.0, 8.0)))
# Above the other two, the row that goes wrong.
_THREE = ((style.WRONG, style.WRONG, (4.0, 7.0)), *_COLORS)
# Of all triangles: so few can be overlooked.
_FEW = 0.03
# How far the line of a given direction reaches, over the size of the shape.
_REACH = 0.62


@dataclass(frozen=True)
class Row:
    """Where a row stands: base line of its title, lower and upper end of the shapes, line of the counts.

    Its columns begin at `left`.
    """

    title: float
    low: float
    high: float
    counts: float
    left: float = _LEFT


# Lines of text below the shapes, the room that a title takes, and what the axes need below and above.
_LINE, _UNDER_TITLE, _AXES_BELOW, _AXES_ABOVE = 38.0, 34.0, 62.0, 66.0
_TITLE, _LOWEST, _HIGHEST = 846.0, 116.0, 240.0
# Of three rows: the upper end, where the columns begin beside the titles, and the height of a line of those.
_TOP, _BESIDE, _TITLE_LINE = 880.0, 262.0, 33.0


@dataclass(frozen=True, eq=False)
class Strip:
    """A way with its name, in phrases, and its frames at some times; compared with the way back, or not."""

    name: tuple[str, ...]
    way: _morph.Way
    frames: shape.Result
    both: bool = False


def picture(strips: Sequence[Strip], t: float) -> scene.Picture:
    """Return the page; `t` is the moment that is marked in the plots."""
    return _three(strips, t) if len(strips) > 2 else _few(strips, t)


def _three(strips: Sequence[Strip], t: float) -> scene.Picture:
    """Three rows have their titles at their left, and no line of counts."""
    window = _window(strips)
    columns = len(strips[0].frames.t)
    wide, tall = window[1] - window[0], window[3] - window[2]
    times = _LOWEST + _AXES_BELOW + _AXES_ABOVE + 14.0
    pitch = (_TOP - times - _LINE) / len(strips)
    scale = min(_FILLED * (_RIGHT - _BESIDE) / columns / wide, 0.88 * pitch / tall)
    records: list[scene.Record] = []
    for k, strip in enumerate(strips):
        middle = _TOP - (k + 0.5) * pitch
        half = 0.5 * scale * tall
        row = Row(middle, middle - half, middle + half, 0.0, _BESIDE)
        records += _row(strip, row, scale, window, False)
        records += _beside(strip, middle, _THREE[k][1])
    records += _moments(strips, _BESIDE, times)
    records += _plots(strips, t, _AXES_BELOW, _LOWEST, _THREE)
    return scene.Picture((scene.View(tuple(records)),))


def _beside(strip: Strip, middle: float, tone: str) -> list[scene.Record]:
    """A row's title at its left: the energy, the input line by line, and how many triangles flip."""
    count = int(strip.way.measured.flipped.sum(axis=1).max())
    # What stands in brackets has a line of its own.
    lines = [line for phrase in strip.name for line in phrase.replace(" $(", "\n$(").split("\n")]
    lines.append(f"up to {count} flipped" if count else "none flipped")
    top = middle + 0.5 * _TITLE_LINE * (len(lines) - 1)
    records: list[scene.Record] = []
    for k, line in enumerate(lines):
        size = style.TITLE_TEXT if k == 0 else style.SMALL_TEXT
        at = (_LEFT, top - k * _TITLE_LINE + (5.0 if k == 0 else 0.0), 0.0)
        records.append(scene.Label(line, at, tone, size, anchor="lc", halo=False))
    return records


def _moments(strips: Sequence[Strip], left: float, height: float) -> list[scene.Record]:
    """The times of the frames, below them."""
    times = strips[0].frames.t
    return [
        scene.Label(
            f"$t = {number(moment)}$",
            (_center(k, len(times), left), height, 0.0),
            style.INK,
            style.SMALL_TEXT,
            anchor="cn",
            halo=False,
        )
        for k, moment in enumerate(times)
    ]


def _few(strips: Sequence[Strip], t: float) -> scene.Picture:
    """One row or two have their titles above them."""
    window = _window(strips)
    columns = len(strips[0].frames.t)
    led = len(strips) == 1 and bool(strips[0].way.led.loci)
    counted = led or any(bool(s.way.measured.flipped.any()) for s in strips)
    wide, tall = window[1] - window[0], window[3] - window[2]
    # What is left of the page for shapes, when text and the lowest plots have had theirs.
    lines = (len(strips) if counted else 0) + 1
    taken = _LOWEST + _AXES_BELOW + _AXES_ABOVE + _LINE * (lines + 0.6) + len(strips) * _UNDER_TITLE
    free = (_TITLE - taken - (len(strips) - 1) * 62.0) / len(strips)
    scale = min(_FILLED * (_RIGHT - _LEFT) / columns / wide, free / tall)
    # What shapes that are wide leave unused goes to the plots, and then between all parts.
    spare = len(strips) * (free - scale * tall)
    high = min(_HIGHEST, _LOWEST + 0.6 * spare)
    gap = (spare - (high - _LOWEST)) / (3.0 * len(strips))
    rows, times = _rows(len(strips), scale * tall, gap, counted)
    low = _AXES_BELOW + gap
    records: list[scene.Record] = []
    for k, (strip, row) in enumerate(zip(strips, rows, strict=True)):
        records += _title(", ".join(strip.name), row.title, k if len(strips) > 1 else None)
        records += _row(strip, row, scale, window, counted)
    records += _moments(strips, _LEFT, times)
    records += _plots(strips, t, low, high)
    return scene.Picture((scene.View(tuple(records)),))


def _rows(count: int, tall: float, gap: float, counted: bool) -> tuple[list[Row], float]:
    """Where rows stand, from the title downwards; and the line of the times, below the last."""
    rows, title, times = [], _TITLE, 0.0
    for k in range(count):
        high = title - _UNDER_TITLE - gap
        low = high - tall
        times = low - gap - _LINE
        last = k == count - 1
        counts = times - _LINE if last else times
        rows.append(Row(title, low, high, counts))
        title = (counts if counted else low - gap) - 62.0
    return rows, times


def _center(k: int, columns: int, left: float) -> float:
    return left + (k + 0.5) * (_RIGHT - left) / columns


def _shift(way: _morph.Way, t: Array | float) -> Array:
    """What is at the middle of a column: that of the shape, or where curves are drawn, theirs."""
    x = way.measured.vertices[..., 0]
    middle = 0.5 * (x.min(axis=1) + x.max(axis=1))
    if way.led.loci:
        return np.full(np.shape(t), 0.5 * (middle[0] + middle[-1]))
    return np.interp(t, way.measured.t, middle)


def _window(strips: Sequence[Strip]) -> tuple[float, float, float, float]:
    """What a column must hold, at all times: left and right of its middle, and heights."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for way in (strip.way for strip in strips):
        V = way.measured.vertices.copy()
        V[..., 0] -= _shift(way, way.measured.t)[:, None]
        points = [V.reshape(-1, 2)]
        for _, path in way.led.loci:
            points.append(np.asarray(path(way.measured.t)) - [_shift(way, 0.0), 0.0])
        every = np.concatenate(points)
        low, high = np.minimum(low, every.min(axis=0)), np.maximum(high, every.max(axis=0))
    side = max(-low[0], high[0])
    return -side, side, float(low[1]), float(high[1])


def _row(
    strip: Strip, row: Row, scale: float, window: tuple[float, ...], counted: bool
) -> list[scene.Record]:
    way, frames = strip.way, strip.frames
    base = 0.5 * (row.low + row.high) - 0.5 * scale * (window[2] + window[3])
    columns = len(frames.t)
    records: list[scene.Record] = []
    fine = np.linspace(0.0, 1.0, 4 * _morph.MOMENTS)
    if way.led.barycentre is not None:
        path = np.asarray(way.led.barycentre(fine))
        x = np.interp(fine, frames.t, [_center(k, columns, row.left) for k in range(columns)])
        across = x + scale * (path[:, 0] - _shift(way, fine))
        curve = np.stack([across, base + scale * path[:, 1], np.zeros_like(x)], axis=1)
        records.append(scene.Lines(curve, style.ROUTE_1, style.EDGE))
    for k, moment in enumerate(frames.t):
        middle = _center(k, columns, row.left)
        place = Plane((middle - scale * float(_shift(way, moment)), base), scale)
        V, turned = frames.vertices[k], frames.flipped[k]
        for _, path in way.led.loci:
            records.append(place.line(np.asarray(path(fine)), style.ROUTE_1, style.EDGE))
        records += marks.drawn(place, way.pair, V, marks.color_at(moment), flipped=turned, eye=0.07 * scale)
        records += held(place, way, V, moment)
        records += _rings(place, way, V, turned)
        if counted:
            records.append(_count(row.counts, middle, int(turned.sum())))
    return records


def _count(height: float, middle: float, count: int) -> scene.Record:
    """How many triangles are turned over."""
    tone = style.WRONG if count else style.MUTED
    at = (middle, height, 0.0)
    return scene.Label(f"{count} flipped", at, tone, style.SMALL_TEXT, anchor="cn", halo=False)


def _rings(place: Plane, way: _morph.Way, V: Array, turned: Array) -> list[scene.Record]:
    """Where few triangles are turned over, rings that show where."""
    records: list[scene.Record] = []
    if 0 < turned.sum() < _FEW * len(turned):
        faces = way.pair.faces[turned]
        _, part = topology.components(len(V), np.concatenate([faces[:, :2], faces[:, 1:]]))
        for k in np.unique(part[faces[:, 0]]):
            corners = V[part == k]
            center = corners.mean(axis=0)
            radius = float(np.linalg.norm(corners - center, axis=1).max()) + 12.0 / place.scale
            records.append(place.circle(center, radius, style.WRONG, style.EDGE))
    return records


def held(place: Plane, way: _morph.Way, V: Array, t: float, curves: bool = False) -> list[scene.Record]:
    """What the constraints hold: the vertices on curves, the edge or its line, the barycentre."""
    records: list[scene.Record] = []
    paths = [path for _, path in way.led.loci]
    if way.led.barycentre is not None:
        paths.append(way.led.barycentre)
    for path in paths if curves else ():
        fine = np.asarray(path(np.linspace(0.0, 1.0, 4 * _morph.MOMENTS)))
        records.append(place.line(fine, style.ROUTE_1, style.EDGE))
    dots = [V[v] for v, _ in way.led.loci]
    if way.led.line is not None:
        ends, along = V[list(way.led.line.ends)], way.led.line.along(t)
        reach = _REACH * float(np.ptp(way.pair.source, axis=0).max())
        line = ends.mean(axis=0) + np.multiply.outer([-reach, reach], along)
        records.append(place.line(line, style.ROUTE_1, style.EDGE, dash=(9.0, 7.0)))
        records.append(scene.Points(place.at(ends), style.ROUTE_1, 4.5, shaded=False))
    if way.led.edge is not None:
        records.append(place.line(V[list(way.led.edge)], style.ROUTE_1, 2.0 * style.EDGE))
    if way.led.barycentre is not None:
        dots.append(V.mean(axis=0))
    if dots:
        at = place.at(np.array(dots))
        records.append(scene.Points(at, style.ROUTE_1, 7.0, rim=style.PAPER, shaded=False))
    return records


def _title(name: str, height: float, k: int | None) -> list[scene.Record]:
    """A row's name; where there are two, in the colour of its curves with a piece of them below it."""
    at = (0.5 * (_LEFT + _RIGHT), height, 0.0)
    tone = style.INK if k is None else _COLORS[k][1]
    return [scene.Label(name, at, tone, style.TITLE_TEXT, anchor="cn", halo=False)]


def _plots(
    strips: Sequence[Strip], t: float, low: float, high: float, colors: Sequence[tuple] = _COLORS
) -> list[scene.Record]:
    x = strips[0].way.measured.t
    shown = [
        (r"least $\det B_i$", [s.way.measured.det.min(axis=1) for s in strips], True),
        ("area, source = 1", [s.way.area for s in strips], True),
        ("energy over area", [s.way.energy for s in strips], False),
    ]
    if strips[0].both:
        shown[1] = ("from the way back", [s.way.asymmetry for s in strips], False)
    records: list[scene.Record] = []
    for place, (title, curves, one) in enumerate(shown):
        least, most = min(float(c.min()) for c in curves), max(float(c.max()) for c in curves)
        limits = _limits(least, most, one)
        axes = Axes((118.0 + 380.0 * place, low, 232.0, high), (0.0, 1.0), limits)
        ticks = [(0.0, "$0$"), (1.0, "$1$")] if one else [(0.0, "$0$"), (limits[1], _power(limits[1]))]
        if limits[0] < -0.3 * (limits[1] - limits[0]):
            ticks.append((limits[0], f"${limits[0]:g}$"))
        if limits[1] - limits[0] > 4.0 and one:
            ticks = [tick for tick in ticks if tick[0] != 1.0]
        records += axes.frame([(0.0, "$0$"), (1.0, "$1$")], ticks, "", title, title_size=style.SMALL_TEXT)
        name = (axes.box[0] + 0.5 * axes.box[2], low, 0.0)
        records.append(scene.Label("$t$", name, style.INK, style.SMALL_TEXT, (0.0, -14.0), "ct", halo=False))
        records.append(axes.vertical(t, style.MUTED))
        for curve, (tone, _, dash) in zip(curves, colors, strict=False):
            records.append(axes.curve(x, curve, tone, dash=dash))
    return records


def _limits(least: float, most: float, one: bool) -> tuple[float, float]:
    if one:
        low = 0.0 if least >= -0.02 else float(np.floor(2.0 * least) / 2.0)
        return low, max(1.0, float(np.ceil(2.0 * (most - 0.02)) / 2.0))
    return 0.0, _round_up(max(most, 1e-12))


def _round_up(value: float) -> float:
    """The next number with one digit."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(np.ceil(value / power - 1e-9) * power)


def _power(value: float) -> str:
    exponent = int(np.floor(np.log10(value) + 1e-9))
    if -3 < exponent < 4:
        return f"${value:g}$"
    digit = round(value / 10.0**exponent)
    return rf"${digit}\cdot 10^{{{exponent}}}$" if digit != 1 else rf"$10^{{{exponent}}}$"
