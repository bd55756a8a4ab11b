"""Strips of frames: one way, or up to three above each other, and beside or below them what is measured."""

from collections.abc import Sequence

import numpy as np

from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.plane import Plane

from . import _morph, _morph_loupe, _morph_plots
from ._morph_row import LEFT, RIGHT, Row, Strip, count, frame, moment, place, rings, row, text, window

Array = np.ndarray

_FILLED, _WHITE = 0.95, 26.0
_TITLE = 846.0
# Lines of text, the room that a title takes, what axes need below and above, and their height.
_LINE, _UNDER_TITLE, _AXES_BELOW, _AXES_ABOVE = 38.0, 32.0, 62.0, 66.0
_LOWEST, _HIGHEST = 116.0, 200.0
# A line that names the curves of plots; the sample of a line, and how far text is from it.
_LEGEND, _SAMPLE, _BESIDE = 42.0, 62.0, 16.0
# Energies with long names.
_LONG = ("balanced", "symmetric")
# From the last line of a row to the title of the next.
_NEXT = 52.0
# Of three rows: where their frames end and their plots begin, and the plots' height.
_FRAMES_END, _PLOT, _PLOT_HIGH = 830.0, (938.0, 200.0), 118.0


def picture(strips: Sequence[Strip], t: float, other: _morph.Way | None = None) -> scene.Picture:
    """Return the page; `t` is the moment that is marked in the plots, `other` a way only for them."""
    if len(strips) == 1:
        return _alone(strips[0], t, other)
    return _two(strips, t) if len(strips) == 2 else _three(strips, t)


def _alone(strip: Strip, t: float, other: _morph.Way | None) -> scene.Picture:
    """One row, or where curves are round, frames in turn above and below a line."""
    size = window([strip.way, *([other] if other is not None else [])])
    wide, tall = size[1] - size[0], size[3] - size[2]
    columns = len(strip.frames.t)
    pitch = (RIGHT - LEFT) / columns
    low = _AXES_BELOW + (_LEGEND if other is not None else 0.0)
    free = _TITLE - _UNDER_TITLE - (low + _LOWEST + _AXES_ABOVE)
    line = min(_FILLED * pitch / wide, (free - 2.0 * _LINE) / tall)
    scale, drop = _staggered(pitch, wide, tall, free - 2.0 * _LINE - 16.0)
    records: list[scene.Record] = [_heading(", ".join(strip.name), _TITLE)]
    if not strip.way.led.loci or scale < 1.1 * line:
        scale, drop = line, 0.0
    spare = free - 2.0 * _LINE - scale * tall - drop
    high = min(_HIGHEST, _LOWEST + 0.5 * spare)
    gap = 0.5 * (spare - (high - _LOWEST))
    top = _TITLE - _UNDER_TITLE - 0.6 * gap - (_LINE if drop else 0.0)

    def at(k: int, now: float) -> Plane:
        middle = top - drop * (k % 2) - 0.5 * scale * tall
        return place(strip.way, now, LEFT + (k + 0.5) * pitch, middle, scale, size)

    for k, now in enumerate(strip.frames.t.tolist()):
        down = drop * (k % 2)
        x = LEFT + (k + 0.5) * pitch
        records += frame(strip, k, at(k, now))
        said, tone = count(strip, k)
        if drop:
            y = top - down - scale * tall - 34.0 if k % 2 else top + 14.0
            x = float(np.clip(x, LEFT + 130.0, RIGHT - 150.0))
            records += [text(moment(now), x - 12.0, y, anchor="rn"), text(said, x + 12.0, y, tone, "ln")]
        else:
            y = top - scale * tall - 34.0
            records += [text(moment(now), x, y), text(said, x, y - _LINE, tone)]
    if not drop:
        records += _enlarged(strip, at, (LEFT, top - scale * tall, RIGHT - LEFT, tall * scale))
    records += _morph_plots.draw([strip], other, t, low, high)
    if other is not None:
        records += _legend(strip, other)
    return scene.Picture((scene.View(tuple(records)),))


def _enlarged(strip: Strip, at: _morph_loupe.Place, box: Box) -> list[scene.Record]:
    """Rings at the few triangles that are turned over, and those of one column larger."""
    loupe = _morph_loupe.found(strip, at, box)
    records: list[scene.Record] = []
    for k, now in enumerate(strip.frames.t.tolist()):
        records += rings(at(k, now), strip, k, loupe.some if loupe and loupe.k == k else None)
    return records + (_morph_loupe.draw(loupe, strip, at) if loupe else [])


def _staggered(pitch: float, wide: float, tall: float, free: float) -> tuple[float, float]:
    """The largest scale of round frames, each other one lower, and by how much it is."""
    # At the sides, some white is left.
    most = min(2.0 * pitch * _FILLED, 2.0 * LEFT + pitch - 2.0 * _WHITE)
    scales = np.linspace(0.4, 1.0, 241) * most / wide
    drops = free - scales * tall
    # Ellipses that fill the windows do not meet.
    apart = (pitch / (scales * wide)) ** 2 + (np.maximum(drops, 0.0) / (scales * tall)) ** 2
    fits = (drops >= 0.0) & (apart >= 1.03)
    k = int(np.flatnonzero(fits)[-1]) if fits.any() else 0
    return float(scales[k]), float(max(drops[k], 0.0))


def _heading(name: str, y: float) -> scene.Label:
    return scene.Label(
        name, (0.5 * (LEFT + RIGHT), y, 0.0), style.INK, style.TITLE_TEXT, anchor="cn", halo=False
    )


def _sample(y: float, x: float, colors: tuple) -> scene.Lines:
    """A piece of a line, beside text on a base line."""
    return scene.Lines(
        [(x, y + 9.0, 0.0), (x + _SAMPLE, y + 9.0, 0.0)], colors[0], style.CURVE, dash=colors[2]
    )


def _legend(strip: Strip, other: _morph.Way) -> list[scene.Record]:
    """Which curve of the plots is which."""
    y = 28.0
    records: list[scene.Record] = []
    said = (f"{strip.name[0]}, drawn above", f"{_morph.NAMES[other.choice.energy]} with the same constraints")
    for x, name, colors in zip(
        ((90.0, 640.0) if strip.way.choice.energy in _LONG else (215.0, 610.0)),
        said,
        (_morph_plots.COLORS[0], _morph_plots.OTHER),
        strict=True,
    ):
        records.append(_sample(y, x, colors))
        records.append(text(name, x + _SAMPLE + _BESIDE, y, colors[1], "ln"))
    return records


def _two(strips: Sequence[Strip], t: float) -> scene.Picture:
    """Two rows, each under its title with a piece of its curves in the plots."""
    size = window([strip.way for strip in strips])
    wide, tall = size[1] - size[0], size[3] - size[2]
    columns = len(strips[0].frames.t)
    taken = _AXES_BELOW + _LOWEST + _AXES_ABOVE + 2.0 * (_UNDER_TITLE + _LINE) + _LINE + _NEXT
    free = (_TITLE - taken) / 2.0
    scale = min(_FILLED * (RIGHT - LEFT) / columns / wide, free / tall)
    # What wide shapes leave goes to the plots, and then between all parts.
    spare = 2.0 * (free - scale * tall)
    high = min(_HIGHEST, _LOWEST + 0.4 * spare)
    gap = (spare - (high - _LOWEST)) / 6.0
    records: list[scene.Record] = []
    title = _TITLE
    for k, strip in enumerate(strips):
        colors = _morph_plots.COLORS[k]
        records.append(_sample(title, LEFT, colors))
        name = (LEFT + _SAMPLE + _BESIDE, title, 0.0)
        said = ", ".join(strip.name)
        records.append(scene.Label(said, name, colors[1], style.TITLE_TEXT, anchor="ln", halo=False))
        there = Row(title - _UNDER_TITLE - gap - scale * tall, title - _UNDER_TITLE - gap)
        records += row(strip, there, scale, size)
        y = there.low - gap - 30.0
        for j in range(columns):
            said, tone = count(strip, j)
            x = there.x(j, columns)
            if k == 1:
                records.append(text(moment(float(strip.frames.t[j])), x, y))
            records.append(text(said, x, y - (_LINE if k == 1 else 0.0), tone))
        title = y - _NEXT
    records += _morph_plots.draw(strips, None, t, _AXES_BELOW + gap, high)
    return scene.Picture((scene.View(tuple(records)),))


def _three(strips: Sequence[Strip], t: float) -> scene.Picture:
    """Three rows, each with its title above it and the least determinant at its right."""
    size = window([strip.way for strip in strips])
    wide, tall = size[1] - size[0], size[3] - size[2]
    columns = len(strips[0].frames.t)
    times = 34.0
    pitch = (_TITLE + 34.0 - times - _LINE) / len(strips)
    scale = min(1.04 * (_FRAMES_END - LEFT) / columns / wide, (pitch - _LINE - 24.0) / tall)
    least = [strip.way.measured.det.min(axis=1) for strip in strips]
    records: list[scene.Record] = []
    for k, strip in enumerate(strips):
        top = _TITLE + 34.0 - k * pitch
        most = int(strip.way.measured.flipped.sum(axis=1).max())
        tone = style.WRONG if most else style.ROUTE_1_TEXT
        said = f"{', '.join(strip.name)}: " + (f"up to {most} flipped" if most else "none flipped")
        name = (LEFT, top - 34.0, 0.0)
        records.append(scene.Label(said, name, tone, style.TITLE_TEXT, anchor="ln", halo=False))
        high = top - _LINE - 16.0
        there = Row(high - (pitch - _LINE - 24.0), high, LEFT, _FRAMES_END)
        records += row(strip, there, scale, size)
        plot = _morph_plots.Plot(r"least $\det B_i$" if k == 0 else "", [least[k]], bounds=_bounds(least))
        box = (_PLOT[0], 0.5 * (there.low + there.high) - 0.5 * _PLOT_HIGH, _PLOT[1], _PLOT_HIGH)
        colors = (style.WRONG, style.WRONG, None) if most else _morph_plots.COLORS[0]
        records += _morph_plots.one(plot, strip.way.measured.t, t, box, (colors,))
    for j, now in enumerate(strips[0].frames.t.tolist()):
        records.append(text(moment(now), Row(0.0, 0.0, LEFT, _FRAMES_END).x(j, columns), times))
    return scene.Picture((scene.View(tuple(records)),))


def _bounds(curves: list[Array]) -> tuple[float, float]:
    return min(float(c.min()) for c in curves), max(float(c.max()) for c in curves)
