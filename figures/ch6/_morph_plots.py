"""What is measured of strips, over t, below them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lietool.render import scene, style
from lietool.render.plot import Axes

from . import _morph
from ._morph_row import Strip

Array = np.ndarray

# Of the first and the second row: colour of the curve, of type, and dashes.
COLORS = ((style.ROUTE_1, style.ROUTE_1_TEXT, None), (style.ROUTE_2, style.ROUTE_2_TEXT, (13.0, 8.0)))
# Of the way that is not drawn.
OTHER = (style.MUTED, style.MUTED, (3.0, 6.0))
_PITCH, _WIDE, _FIRST = 380.0, 232.0, 122.0


@dataclass(frozen=True, eq=False)
class Plot:
    """Curves over t with one axis: from 0 or below to 1, in degrees, or from 0 to the most; or dots.

    With `valued`, the values at the moment are said; `bounds` are those of the curves, or of more of them.
    """

    title: str
    curves: list[Array]
    kind: str = "one"
    valued: bool = False
    bounds: tuple[float, float] | None = None


def same_maps(ways: Sequence[_morph.Way]) -> bool:
    """Whether one E^F serves all ways: their local maps are the same, and turn as the shape does."""
    first = ways[0]
    same = all(np.array_equal(way.theta, first.theta) for way in ways)
    asked = {way.choice.energy for way in ways}
    return same and (first.choice.angles == "consistent" or asked == {"frobenius"})


def shown(strips: Sequence[Strip], other: _morph.Way | None) -> list[Plot]:
    """What is plotted of some rows, and of a way beside that is not drawn."""
    ways = [strip.way for strip in strips] + ([other] if other is not None else [])
    area = [way.area for way in ways]
    signed = "signed area" if min(float(a.min()) for a in area) < 0.0 else "area"
    similar = not same_maps(ways)
    name = "E^R" if similar else "E^F"
    plots = [
        Plot(r"least $\det B_i$", [way.measured.det.min(axis=1) for way in ways]),
        Plot(f"{signed} / area of $P$", area, valued=len(strips) > 1),
        Plot(f"${name}$ / area of $P$", [way.error(similar) for way in ways], "most"),
    ]
    if strips[0].both:
        plots[1] = Plot("largest distance / size", [way.asymmetry for way in ways], "most")
    elif any(way.led.line is not None or way.led.named for way in ways):
        plots[1] = Plot(r"turn of the edge", [way.turn for way in ways], "degrees")
    elif len(ways) == 1 and ways[0].choice.angles == "principal":
        plots[1] = Plot("angles along the body", [np.degrees(ways[0].theta)], "along")
    return plots


def draw(
    strips: Sequence[Strip], other: _morph.Way | None, t: float, low: float, high: float
) -> list[scene.Record]:
    """Three plots beside each other, `high` page units high from `low`."""
    records: list[scene.Record] = []
    colors = (COLORS[0], OTHER) if other is not None else COLORS
    for k, plot in enumerate(shown(strips, other)):
        box = (_FIRST + _PITCH * k, low, _WIDE, high)
        if plot.kind == "along":
            records += _along(strips[0].way, box, plot)
        else:
            records += one(plot, strips[0].way.measured.t, t, box, colors)
    return records


def one(plot: Plot, x: Array, t: float, box: tuple, colors: Sequence[tuple]) -> list[scene.Record]:
    """One plot over t."""
    limits, ticks = _axis(plot)
    axes = Axes(box, (0.0, 1.0), limits)
    records = axes.frame([(0.0, "$0$"), (1.0, "$1$")], ticks, "", plot.title, title_size=style.SMALL_TEXT)
    end = (box[0] + box[2], box[1], 0.0)
    records.append(scene.Label("$t$", end, style.INK, style.SMALL_TEXT, (26.0, -14.0), "lt", halo=False))
    records.append(axes.vertical(t, style.MUTED))
    if plot.kind == "one" and all(value != 1.0 for value, _ in ticks) and limits[1] >= 1.0:
        # At the left there is no room beside 0.
        one_ = axes.at(1.0, 1.0)
        records.append(axes.curve([0.0, 1.0], [1.0, 1.0], style.RULE, style.HAIR))
        records.append(scene.Label("$1$", one_, style.INK, style.SMALL_TEXT, (14.0, 0.0), "lc", halo=False))
    # The way that is drawn over the one that is not.
    for curve, (tone, _, dash) in reversed(list(zip(plot.curves, colors, strict=False))):
        records.append(axes.curve(x, curve, tone, dash=dash))
    if plot.valued:
        records += _values(plot, x, t, axes, colors)
    return records


def _values(plot: Plot, x: Array, t: float, axes: Axes, colors: Sequence[tuple]) -> list[scene.Record]:
    """The values at the moment, at dots on the curves: the greater above its dot, the other below."""
    at = [float(np.interp(t, x, curve)) for curve in plot.curves]
    if max(at) - min(at) < 0.02 * (axes.ylim[1] - axes.ylim[0]):
        return []
    records: list[scene.Record] = []
    for value, (tone, type_, _) in zip(at, colors, strict=False):
        up = value == max(at)
        spot = axes.at(t, value)
        records.append(scene.Points([spot], tone, 6.0, shaded=False))
        # The lower one at the other side, where its curve comes from.
        left = t > 0.75 or (not up and t > 0.25)
        offset = (-12.0 if left else 12.0, 8.0 if up or value < axes.ylim[0] + 0.1 * axes.ylim[1] else -4.0)
        anchor = ("r" if left else "l") + ("b" if offset[1] > 0.0 else "t")
        records.append(
            scene.Label(
                f"${value:.{3 if axes.ylim[1] < 0.1 else 2}f}$",
                spot,
                type_,
                style.SMALL_TEXT,
                offset,
                anchor,
                room=46.0,
            )
        )
    return records


def _along(way: _morph.Way, box: tuple, plot: Plot) -> list[scene.Record]:
    """The angles of the local maps from the nose to the tail, and the consistent ones where they differ."""
    along = way.pair.along[way.pair.faces].mean(axis=1)
    given, even = np.degrees(way.theta), np.degrees(way.consistent)
    low = min(-180.0, 180.0 * np.floor(even.min() / 180.0))
    high = max(180.0, 180.0 * np.ceil(even.max() / 180.0))
    axes = Axes(box, (0.0, 1.0), (low, high))
    ticks = [(v, rf"${v:g}^{{\circ}}$") for v in sorted({low, -180.0, 180.0, high})]
    records = axes.frame([(0.0, "nose"), (1.0, "tail")], ticks, "", plot.title, title_size=style.SMALL_TEXT)
    differs = np.abs(even - given) > 1.0
    if differs.any():
        records.append(axes.dots(along[differs], even[differs], style.GREYS[1], 2.0))
    records.append(axes.dots(along, given, COLORS[0][0], 2.6))
    return records


def _axis(plot: Plot) -> tuple[tuple[float, float], list[tuple[float, str]]]:
    """The limits of an axis, and its ticks."""
    every = np.concatenate(plot.curves)
    least, most = plot.bounds or (float(every.min()), float(every.max()))
    if plot.kind == "most":
        high = _round_up(max(most, 1e-12))
        return (0.0, high), [(0.0, "$0$"), (high, power(high))]
    if plot.kind == "degrees":
        low, high = (90.0 * float(f) for f in (np.floor(least / 90.0 + 1e-9), np.ceil(most / 90.0 - 1e-9)))
        high = max(high, low + 90.0)
        values = [0.0] if low <= 0.0 <= high else []
        for v in (low, high):
            values += [v] if all(abs(v - w) > 0.28 * (high - low) for w in values) else []
        return (low, high), [(v, rf"${v:g}^{{\circ}}$") for v in values]
    low = 0.0 if least >= -0.02 else float(np.floor(2.0 * least) / 2.0)
    high = max(1.0, float(np.ceil(2.0 * (most - 0.02)) / 2.0))
    values = [0.0]
    # Numbers at 1, at the upper and at the lower end, where no other stands in its way.
    apart = 0.28 * (high - low)
    for v in (1.0, low, high):
        values += [v] if min(abs(v - w) for w in values) > apart else []
    return (low, high), [(v, f"${v:g}$") for v in values]


def _round_up(value: float) -> float:
    """The next number with one digit."""
    power_of_ten = 10.0 ** np.floor(np.log10(value))
    return float(np.ceil(value / power_of_ten - 1e-9) * power_of_ten)


def power(value: float) -> str:
    """A number with one digit as mathtext."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    if -3 < exponent < 4:
        return f"${value:g}$"
    digit = round(value / 10.0**exponent)
    return rf"${digit}\cdot 10^{{{exponent}}}$" if digit != 1 else rf"$10^{{{exponent}}}$"
