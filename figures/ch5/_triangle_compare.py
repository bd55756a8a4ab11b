"""Ways beside each other over one line of time, with the area on the way, for `triangle-interp`."""

from dataclasses import dataclass

import numpy as np

from lietool.interp import triangle
from lietool.render import brackets, scene, style
from lietool.render.brackets import fixed
from lietool.render.plot import Axes

from . import _triangle_map as maps
from . import _triangle_shape as shapes

_PLOT = (78.0, 168.0)
# How far a triangle may reach beyond the line of time.
_ASIDE = 60.0


@dataclass(frozen=True)
class _Page:
    """Where rows and the plot lie: first and last moment, the rows' middles, and the room of a triangle."""

    left: float
    right: float
    rows: tuple[float, ...]
    height: float


_PAIR = _Page(320.0, 1060.0, (694.0, 440.0), 236.0)
_FOUR = _Page(258.0, 716.0, (738.0, 616.0, 494.0, 372.0), 116.0)
PAIR_NAMES = {"arap": r"(1 - t)\,I + t\,S", "logexp": r"S^t"}


def pair(given: maps.Map, steps: int, t: float) -> scene.Picture:
    """Return the page of a symmetric map: the straight line and the power."""
    names = {method: rf"${name}$" for method, name in PAIR_NAMES.items()}
    records = _title(
        r"$\mathrm{From\ }I\mathrm{\ to\ }S\mathrm{\ on\ a\ straight\ line,and\ by\ powers}$", 600.0
    )
    records += _rows(given.symmetric, ("arap", "logexp"), names, _PAIR, steps, t)
    return scene.Picture((scene.View(tuple(records)),))


def four(given: maps.Map, steps: int, t: float) -> scene.Picture:
    """Return the page of all methods, and where their maps are among all."""
    names = {method: f"${name}$" for method, name in maps.NAMES.items()}
    records = _title(r"$\mathrm{Four\ ways\ from\ }I\mathrm{\ to\ }A$", (_FOUR.left + _FOUR.right) / 2.0)
    records += _title(r"$\mathrm{All\ }A$", 1005.0)
    records += _rows(given, tuple(maps.METHODS), names, _FOUR, steps, t)
    records += _chart(given) + _facts(given)
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
) -> list[scene.Record]:
    times = shapes.moments(steps, 0.0)
    start, stop = min(times[0], t), max(times[-1], t)
    line = shapes.Strip(page.left, page.right, start, stop)
    shape = shapes.Shape.of(given)
    real = [method for method in methods if given.exists(method)]
    rows = {method: given.at(method, times) for method in real}
    scale = line.scale(shape, list(rows.values()), times, page.height)
    if not 0.0 <= t <= 1.0:
        wide, high = shape.extent(np.stack([given.at(method, t) for method in real])).max(axis=0)
        scale = min(scale, page.height / 2.0 / float(high), _ASIDE / float(wide))
    records = _plot(given, real, line, t)
    for method, y in zip(methods, page.rows, strict=True):
        color, text = maps.COLORS[method]
        records.append(scene.Label(names[method], (36.0, y + 10.0, 0.0), text, style.SMALL_TEXT, anchor="lb"))
        sample = [(36.0, y, 0.0), (126.0, y, 0.0)]
        records.append(scene.Lines(sample, color, style.CURVE, dash=maps.DASHES[method]))
        if method in rows:
            records += line.row(shape, rows[method], times, y, scale)
            now = given.at(method, t)
            edge = color if np.linalg.det(now) > 0.0 else style.WRONG
            at = (float(line.x(t)), y)
            records += shape.draw(now, at, scale, (style.PAPER, edge), width=style.CURVE)
        else:
            where = ((page.left + page.right) / 2.0, y, 0.0)
            none = r"$\mathrm{no\ real\ logarithm}$"
            records.append(scene.Label(none, where, style.WRONG, style.TEXT))
    return records


def _plot(given: maps.Map, methods: list[str], line: shapes.Strip, t: float) -> list[scene.Record]:
    """The determinants over the same line of time."""
    span = np.linspace(line.start, line.stop, 241)
    dets = {method: np.linalg.det(given.at(method, span)) for method in methods}
    now = {method: float(np.linalg.det(given.at(method, t))) for method in methods}
    low, high = (f([f(values) for values in dets.values()]) for f in (min, max))
    room = max(high, 1.0) - min(low, 0.0)
    ylim = (min(low, 0.0) - 0.04 * room, max(high, 1.0) + 0.04 * room)
    base, height = _PLOT
    axes = Axes((line.left, base, line.right - line.left, height), (line.start, line.stop), ylim)
    zero, right = axes.at(line.start, 0.0), axes.at(line.stop, 0.0)
    ground = np.stack([zero, right]) + np.array([[-20.0, 0.0, 0.0], [24.0, 0.0, 0.0]])
    records: list[scene.Record] = [
        scene.Lines(ground, style.INK, style.THIN),
        scene.Label("$0$", zero, style.INK, style.SMALL_TEXT, (-34.0, 0.0), "rc"),
        scene.Label("$t$", right, style.INK, style.SMALL_TEXT, (38.0, 0.0), "lc"),
        scene.Label("$1$", axes.at(line.start, 1.0), style.INK, style.SMALL_TEXT, (-34.0, 0.0), "rc"),
        scene.Label(r"$\det$", (36.0, base + height / 2.0, 0.0), style.INK, style.TEXT, anchor="lc"),
        *(axes.vertical(k, style.RULE) for k in (0.0, 1.0)),
        scene.Lines(axes.at([t, t], ylim), style.INK, style.THIN),
    ]
    for k in (0.0, 1.0):
        at = axes.at(k, ylim[0])
        records.append(scene.Label(f"${k:.0f}$", at, style.INK, style.SMALL_TEXT, (0.0, -12.0), "ct"))
    for method, values in dets.items():
        color, dash = maps.COLORS[method][0], maps.DASHES[method]
        records.append(axes.curve(span, np.where(values > 0.0, values, np.nan), color, dash=dash))
        records.append(axes.curve(span, np.where(values <= 0.0, values, np.nan), style.WRONG))
    arms = 8.0 * np.array([[1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]])
    for method in methods:
        for exit in given.exits(method):
            if line.start <= exit <= line.stop:
                cross = axes.at(exit, 0.0) + arms
                records += [scene.Lines(cross[i : i + 2], style.WRONG, style.CURVE) for i in (0, 2)]
    for method, value in now.items():
        color = maps.COLORS[method][0] if value > 0.0 else style.WRONG
        at = axes.at(t, value)
        records.append(scene.Points([at], color, 9.0, rim=style.PAPER))
        if len(now) == 2:
            text = maps.COLORS[method][1] if value > 0.0 else style.WRONG
            aside = (16.0, 12.0, "lb") if value == max(now.values()) else (16.0, -12.0, "lt")
            said = f"${fixed(value)}$"
            records.append(scene.Label(said, at, text, style.SMALL_TEXT, aside[:2], aside[2], room=40.0))
    return records


def without_log(angle: float, unequal: float) -> bool:
    """Return whether A has no real logarithm, by the angle of R and (s1 - s2) / (s1 + s2) of S.

    Its eigenvalues are negative: past a quarter turn, where the sine is at most that part.
    """
    return bool(np.cos(angle) < 0.0 and np.abs(np.sin(angle)) <= unequal and unequal > 0.0)


def _chart(given: maps.Map) -> list[scene.Record]:
    """All maps A by the angle of R and how unequal S stretches: where A has no real logarithm."""
    axes = Axes((874.0, 480.0, 262.0, 270.0), (0.0, 2.0 * np.pi), (0.0, 1.0))
    records = axes.frame(
        [(0.0, "$0$"), (np.pi, r"$\pi$"), (2.0 * np.pi, r"$2\pi$")],
        [(0.0, "$0$"), (1.0, "$1$")],
    )
    # The border of `without_log`.
    angles = np.linspace(np.pi / 2.0, 1.5 * np.pi, 121)
    low = axes.at(angles, np.abs(np.sin(angles)))
    high = axes.at(angles, np.ones(121))
    n = np.arange(120)
    faces = np.concatenate([np.stack([n, n + 1, n + 122], axis=-1), np.stack([n, n + 122, n + 121], axis=-1)])
    records.insert(
        0, scene.Surface(np.concatenate([low, high]), faces, style.WRONG, material="flat", alpha=0.16)
    )
    records.append(scene.Lines(low, style.WRONG, style.EDGE))
    a, b = (np.abs(x) for x in triangle.coordinates(given.A))
    angle = np.mod(triangle.principal_angle(given.A), 2.0 * np.pi)
    at = axes.at(angle, b / a)
    color = style.GROUP if given.has_log else style.WRONG
    none = r"$\mathrm{no\ real}\ \log A$"
    records += [
        scene.Points([axes.at(np.pi, 0.0)], style.PAPER, 7.0, rim=style.WRONG, shaded=False),
        scene.Points([at], color, 12.5, rim=style.PAPER),
        scene.Label(r"$\theta$", axes.at(2 * np.pi, 0.0), style.INK, style.SMALL_TEXT, (24.0, 0.0), "lc"),
        scene.Label(
            r"$\frac{\sigma_1 - \sigma_2}{\sigma_1 + \sigma_2}$",
            axes.at(0.0, 0.5),
            style.INK,
            style.TITLE_TEXT,
            (-16.0, 0.0),
            "rc",
        ),
        scene.Label(none, axes.at(np.pi, 1.0), style.WRONG, style.SMALL_TEXT, (0.0, 14.0), "cb"),
        scene.Label("$A$", at, style.INK, style.SMALL_TEXT, (0.0, 18.0), "cb", room=50.0),
    ]
    return records


def _facts(given: maps.Map) -> list[scene.Record]:
    """The matrix and its eigenvalues."""
    x, y = 850.0, 322.0
    values = np.sort_complex(np.linalg.eigvals(given.A))[::-1]
    if np.abs(values.imag).max() <= 1e-9 * np.abs(values).max():
        # In braces, so that a minus after a comma is a sign.
        said = rf"$\lambda = {{{fixed(values[0].real)}}},\ {{{fixed(values[1].real)}}}$"
    else:
        said = rf"$\lambda = {fixed(values[0].real)} \pm {fixed(abs(values[0].imag))}\,i$"
    collapses = bool(np.any((given.exits("linear") >= 0.0) & (given.exits("linear") <= 1.0)))
    color = style.INK if given.has_log else style.WRONG
    words = r"$A^L\mathrm{\ collapses}$" if collapses else r"$A^L\mathrm{\ does\ not\ collapse}$"
    return [
        scene.Label(words, (x - 10.0, y - 140.0, 0.0), color, style.SMALL_TEXT, anchor="lc"),
        scene.Label(r"$A\ \approx$", (x, y, 0.0), style.INK, style.TEXT, (-10.0, 0.0), "lc"),
        *brackets.matrix(given.A, x + 80.0, y),
        scene.Label(said, (x - 10.0, y - 84.0, 0.0), color, style.SMALL_TEXT, anchor="lc"),
    ]
