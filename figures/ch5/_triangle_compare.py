"""Ways beside each other over one line of time, with the area on the way, for `triangle-interp`."""

from dataclasses import dataclass

import numpy as np

from lietool.render import scene, style
from lietool.render.brackets import fixed
from lietool.render.plot import Axes

from . import _triangle_chart as charts
from . import _triangle_map as maps
from . import _triangle_shape as shapes

# How far a triangle may reach beyond the line of time.
_ASIDE = 60.0
# The height of a row with words instead of triangles, over that of the others; half the gap in lines behind.
_WORDS, _BREAK = 0.34, 26.0


@dataclass(frozen=True)
class _Page:
    """First and last moment, the part of the page for rows, their gap, and the plot's base and height."""

    left: float
    right: float
    rows: tuple[float, float]
    gap: float
    plot: tuple[float, float]


_PAIR = _Page(300.0, 1052.0, (292.0, 812.0), 40.0, (84.0, 158.0))
_FOUR = _Page(216.0, 730.0, (262.0, 812.0), 18.0, (84.0, 142.0))
PAIR_NAMES = {"arap": r"(1 - t)\,I + t\,S", "logexp": r"S^t"}


def pair(given: maps.Map, steps: int, t: float) -> scene.Picture:
    """Return the page of a symmetric map: the straight line and the power."""
    names = {method: rf"${name}$" for method, name in PAIR_NAMES.items()}
    said = r"$\mathrm{From\ }I\mathrm{\ to\ }S\mathrm{\ on\ a\ straight\ line,\ and\ by\ powers}$"
    rows, _ = _rows(given.symmetric, ("arap", "logexp"), names, _PAIR, steps, t)
    return scene.Picture((scene.View((*_title(said, 600.0), *rows)),))


def four(given: maps.Map, steps: int, t: float) -> scene.Picture:
    """Return the page of all methods, and where their maps are among all."""
    names = {method: f"${name}$" for method, name in maps.NAMES.items()}
    count = "Four" if given.has_log else "Three"
    said = rf"$\mathrm{{{count}\ ways\ from\ }}I\mathrm{{\ to\ }}A$"
    rows, scale = _rows(given, tuple(maps.METHODS), names, _FOUR, steps, t)
    records = [
        *_title(said, (_FOUR.left + _FOUR.right) / 2.0),
        *_title(r"$\mathrm{All\ }A\mathrm{\ with\ det} > 0$", charts.MIDDLE),
        *rows,
        *charts.chart(given),
        *charts.facts(given),
        *charts.loupe(given, shapes.Shape.of(given), t, scale),
    ]
    return scene.Picture((scene.View(tuple(records)),))


def _title(text: str, x: float) -> list[scene.Record]:
    return [scene.Label(text, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")]


def _rows(
    given: maps.Map,
    methods: tuple[str, ...],
    names: dict[str, str],
    page: _Page,
    steps: int,
    t: float,
) -> tuple[list[scene.Record], float]:
    """The rows over the plot, and the scale of their triangles."""
    times = shapes.moments(steps, 0.0)
    line = shapes.Strip(page.left, page.right, min(times[0], t), max(times[-1], t))
    shape = shapes.Shape.of(given)
    real = [method for method in methods if given.exists(method)]
    rows = {method: given.at(method, times) for method in real}
    scale, heights = _places(given, shape, methods, page, line, times, t)
    gone = [float(y) for method, y in zip(methods, heights, strict=True) if method not in rows]
    records = [
        *_verticals(line, times, page, float(heights[0]), gone),
        *_plot(given, real, page, line, times, t),
    ]
    for method, y in zip(methods, map(float, heights), strict=True):
        color, text = maps.COLORS[method]
        records.append(scene.Label(names[method], (36.0, y, 0.0), text, style.SMALL_TEXT, anchor="lb"))
        sample = [(36.0, y - 10.0, 0.0), (126.0, y - 10.0, 0.0)]
        records.append(scene.Lines(sample, color, style.CURVE, dash=maps.DASHES[method]))
        if method in rows:
            records += line.row(shape, rows[method], times, y, scale)
            now = given.at(method, t)
            edge = color if np.linalg.det(now) > 0.0 else style.WRONG
            at = (float(line.x(t)), y)
            records += shape.draw(now, at, scale, (style.PAPER, edge), width=style.CURVE)
            # Where there are two ways only, the other one over each.
            if len(methods) == 2:
                other = methods[1 - methods.index(method)]
                dashed = given.at(other, t), at, scale, maps.COLORS[other][0], (9.0, 6.0)
                records.append(shape.rim(*dashed))
        else:
            none = r"$A^t = \exp(t\,\log A)\mathrm{{:\ no\ real\ }}\log A$"
            where = ((page.left + page.right) / 2.0, y, 0.0)
            records.append(scene.Label(none, where, style.WRONG, style.SMALL_TEXT))
    return records, scale


def _places(
    given: maps.Map,
    shape: shapes.Shape,
    methods: tuple[str, ...],
    page: _Page,
    line: shapes.Strip,
    times: np.ndarray,
    t: float,
) -> tuple[float, np.ndarray]:
    """The scale of all triangles, and the rows' middles, as far apart as their triangles are high."""
    film = np.append(np.linspace(0.0, 1.0, 41), t)
    real = [method for method in methods if given.exists(method)]
    high = {method: 2.0 * float(shape.extent(given.at(method, film))[:, 1].max()) for method in real}
    words = _WORDS * max(high.values())
    most = line.scale(shape, [given.at(method, times) for method in real], times, np.inf)
    if not 0.0 <= t <= 1.0:
        wide = max(float(shape.extent(given.at(method, t))[0]) for method in real)
        most = min(most, _ASIDE / wide)
    heights = np.array([high.get(method, words) for method in methods])
    return shapes.stack(heights, *page.rows, page.gap, most)


def _verticals(
    line: shapes.Strip, times: np.ndarray, page: _Page, top: float, gone: list[float]
) -> list[scene.Record]:
    """Pale lines from the moments in the plot to their triangles, broken at rows of words."""
    levels = [sum(page.plot), *(y for row in sorted(gone) for y in (row - _BREAK, row + _BREAK)), top]
    return [
        scene.Lines([(x, low, 0.0), (x, high, 0.0)], style.RULE, style.HAIR)
        for x in line.x(times)
        for low, high in zip(levels[::2], levels[1::2], strict=True)
    ]


def _plot(
    given: maps.Map, methods: list[str], page: _Page, line: shapes.Strip, times: np.ndarray, t: float
) -> list[scene.Record]:
    """The determinants over the same line of time."""
    span = np.linspace(line.start, line.stop, 241)
    dets = {method: np.linalg.det(given.at(method, span)) for method in methods}
    low, high = (f([f(values) for values in dets.values()]) for f in (min, max))
    room = max(high, 1.0) - min(low, 0.0)
    ylim = (min(low, 0.0) - 0.04 * room, max(high, 1.0) + 0.04 * room)
    base, height = page.plot
    axes = Axes((line.left, base, line.right - line.left, height), (line.start, line.stop), ylim)
    zero, right = axes.at(line.start, 0.0), axes.at(line.stop, 0.0)
    ground = np.stack([zero, right]) + np.array([[-20.0, 0.0, 0.0], [24.0, 0.0, 0.0]])
    det = (line.left - 82.0, base + height / 2.0, 0.0)
    records: list[scene.Record] = [
        scene.Lines(ground, style.INK, style.THIN),
        scene.Label("$0$", zero, style.INK, style.SMALL_TEXT, (-34.0, 0.0), "rc"),
        scene.Label("$t$", right, style.INK, style.SMALL_TEXT, (38.0, 0.0), "lc"),
        scene.Label("$1$", axes.at(line.start, 1.0), style.INK, style.SMALL_TEXT, (-34.0, 0.0), "rc"),
        scene.Label(r"$\mathrm{det}$", det, style.INK, style.TEXT, anchor="rc"),
        *(axes.vertical(k, style.RULE) for k in (0.0, 1.0)),
        *(scene.Lines(axes.at([k, k], ylim), style.RULE, style.HAIR) for k in times[1:-1]),
        scene.Lines(axes.at([t, t], ylim), style.INK, style.THIN),
    ]
    pitch = float(np.diff(line.x(times)).min()) if len(times) > 1 else np.inf
    for k in times if pitch >= shapes.NAMED else (0.0, 1.0):
        at = axes.at(k, ylim[0])
        records.append(scene.Label(shapes.fraction(k), at, style.INK, style.SMALL_TEXT, (0.0, -12.0), "ct"))
    for method, values in dets.items():
        color, dash = maps.COLORS[method][0], maps.DASHES[method]
        if method == "matrix-log":
            # It lies on the curve of A^E, half of whose strokes it leaves to be seen.
            dash = (0.5 * maps.DASHES["logexp"][0], 0.5 * maps.DASHES["logexp"][0] + maps.DASHES["logexp"][1])
        records.append(axes.curve(span, np.where(values > 0.0, values, np.nan), color, dash=dash))
        records.append(axes.curve(span, np.where(values <= 0.0, values, np.nan), style.WRONG))
    for method in methods:
        for exit in given.exits(method):
            if line.start <= exit <= line.stop:
                x, y, _ = axes.at(exit, 0.0)
                records += shapes.cross((float(x), float(y)))
    return records + _values(given, methods, axes, t)


def _values(given: maps.Map, methods: list[str], axes: Axes, t: float) -> list[scene.Record]:
    """The determinants at the moment, as balls with their numbers; equal ones share theirs."""
    now = {method: float(np.linalg.det(given.at(method, t))) for method in methods}
    records: list[scene.Record] = []
    order = sorted((method for method in now if method != "matrix-log"), key=lambda method: now[method])
    shown: set[str] = set()
    for method in order:
        value, (color, text) = now[method], maps.COLORS[method]
        if value <= 0.0:
            color = text = style.WRONG
        at, said = axes.at(t, value), fixed(value)
        both = method == "logexp" and "matrix-log" in now
        if both and said not in shown:
            whose = scene.Label("$A^E,\\ A^t$", at, text, style.SMALL_TEXT, (-16.0, -12.0), "rt", room=60.0)
            records.append(whose)
        if both:
            records.append(scene.Points([at], color, 12.5, rim=style.PAPER, shaded=False))
            records.append(scene.Points([at], maps.COLORS["matrix-log"][0], 7.5, shaded=False))
        else:
            records.append(scene.Points([at], color, 9.0, rim=style.PAPER))
        if said in shown:
            continue
        shown.add(said)
        # The largest above its curve, the others below theirs, but the least where it is well apart.
        above = method == order[-1] or (len(order) == 3 and method == order[0] and value > 0.0)
        aside = (16.0, 12.0, "lb") if above else (16.0, -12.0, "lt")
        records.append(scene.Label(f"${said}$", at, text, style.SMALL_TEXT, aside[:2], aside[2], room=60.0))
    return records
