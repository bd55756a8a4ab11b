"""The picture that compares slerp with normalised lerp and with lerp of Euler angles."""

from dataclasses import dataclass

import numpy as np

from lietool.render import marks, scene, style
from lietool.render.camera import Camera
from lietool.render.globe import globe
from lietool.render.plot import Axes, Ticks, number

from . import _slerp_ways

COLORS = (style.GROUP, style.ROUTE_1, style.ROUTE_2)
TEXTS = (style.GROUP_TEXT, style.ROUTE_1_TEXT, style.ROUTE_2_TEXT)
DASHES = (None, (20.0, 6.0), (7.0, 5.0))
DIRECTION = (1.0, 0.62, 0.5)
# Rows and plot share one t axis, from LEFT to RIGHT; ASIDE is the middle of the column for the moment t.
LEFT, RIGHT, ASIDE = 214.0, 838.0, 1040.0
ROWS = (784.0, 642.0, 500.0)
# The largest box of a solid on the page, and how far below its middle the numbers are.
CELL, BELOW = 122.0, 71.0
# More solids than this would be too small to see.
MOST_STEPS = 8
# Speeds above this multiple of the others leave the plot, which would otherwise show only them.
_TALLEST = 3.0


@dataclass(frozen=True, eq=False)
class Compared:
    """What is shown: of the three ways the rotations at `times`, at `t` (`now`) and finely (`paths`).

    `turned` is the angle from each of `times` to the next, `aside` how far from slerp each way is at `t`.
    """

    ways: _slerp_ways.Ways
    times: np.ndarray
    t: float
    rotations: np.ndarray
    turned: np.ndarray
    now: np.ndarray
    aside: np.ndarray
    instants: np.ndarray
    speeds: np.ndarray
    speeds_now: np.ndarray
    paths: np.ndarray

    @property
    def axis(self) -> int:
        """The axis of the solid whose tip moves on the widest circle while slerp turns it."""
        along = np.abs(self.ways.line @ self.rotations[0, 0])
        return int(np.argmin(along.round(9)))


def compared(ways: _slerp_ways.Ways, steps: int, t: float) -> Compared:
    """Compute what is shown for so many equal steps and a moment t."""
    times, instants, here = np.linspace(0.0, 1.0, min(steps, MOST_STEPS) + 1), ways.instants(), np.array([t])
    return Compared(
        ways,
        times,
        t,
        rotations=ways.rotations(times),
        turned=ways.turned(times),
        now=ways.rotations(here)[:, 0],
        aside=ways.from_slerp(here)[:, 0],
        instants=instants,
        speeds=ways.speeds(instants),
        speeds_now=ways.speeds(here)[:, 0],
        paths=ways.rotations(np.linspace(0.0, 1.0, 201)),
    )


def picture(c: Compared) -> scene.Picture:
    """Return rows of solids, the speeds below them, and beside these the moment t and the paths of a tip."""
    camera = Camera(DIRECTION, height=1.72)
    cell = min(CELL, 1.12 * (RIGHT - LEFT) / max(len(c.times) - 1, 1))
    views = []
    for row, y in enumerate(ROWS):
        x = LEFT + c.times * (RIGHT - LEFT)
        views += [_solid(R, (x[k], y), cell, camera) for k, R in enumerate(c.rotations[row])]
        views.append(_solid(c.now[row], (ASIDE, y), CELL, camera))
    page = [*_row_texts(c), *_moment(c), *_speeds(c), *_note(c.ways)]
    views.append(scene.View(tuple(page)))
    return scene.Picture((*views, *_paths(c)))


def _solid(R: np.ndarray, at: tuple[float, float], size: float, camera: Camera) -> scene.View:
    """The solid with its axes; a gap where the rotation is undefined."""
    box = (at[0] - size / 2.0, at[1] - size / 2.0, size, size)
    if not np.isfinite(R).all():
        gap = scene.Label("gap", (*at, 0.0), style.MARK, style.SMALL_TEXT)
        return scene.View((gap,))
    arrows = (
        scene.Arrow(np.zeros(3), 0.84 * R[:, k], color, 0.028, 2.8) for k, color in enumerate(style.AXES)
    )
    return scene.View((*marks.letter(R), *arrows), camera, box)


def _degrees(angle: float, digits: int | None = None) -> str:
    """An angle in radians as degrees, in whole ones from 10 on."""
    degrees = np.rad2deg(angle)
    if digits is None:
        digits = 0 if degrees >= 9.95 else 1 if degrees >= 0.995 else 2
    return rf"${number(degrees, digits)}^{{\circ}}$"


def _row_texts(c: Compared) -> list[scene.Record]:
    """Names with samples of their lines, the whole angle, and what is turned from each solid to the next."""
    records: list[scene.Record] = []
    middles = LEFT + (c.times[1:] + c.times[:-1]) / 2.0 * (RIGHT - LEFT)
    for row, y in enumerate(ROWS):
        records += [
            scene.Label(
                _slerp_ways.NAMES[row], (40.0, y + 22.0, 0.0), TEXTS[row], style.TITLE_TEXT, anchor="ln"
            ),
            scene.Lines([(40.0, y, 0.0), (118.0, y, 0.0)], COLORS[row], style.CURVE, dash=DASHES[row]),
            scene.Label(
                _degrees(c.turned[row].sum()), (40.0, y - 42.0, 0.0), style.INK, style.SMALL_TEXT, anchor="ln"
            ),
        ]
        records += [
            scene.Label(_degrees(angle), (x, y - BELOW, 0.0), style.MUTED, style.SMALL_TEXT)
            for x, angle in zip(middles, c.turned[row], strict=True)
        ]
    return records


def _moment(c: Compared) -> list[scene.Record]:
    """The column for the moment t, with how far each way is from slerp."""
    records: list[scene.Record] = [
        scene.Lines([(900.0, ROWS[2] - BELOW - 14.0, 0.0), (900.0, 868.0, 0.0)], style.RULE, style.HAIR),
        scene.Label(f"$t = {number(c.t)}$", (ASIDE, 862.0, 0.0), style.INK, style.TEXT),
    ]
    for row in (1, 2):
        if np.isfinite(c.aside[row]):
            text = f"{_degrees(c.aside[row])} from slerp"
            records.append(scene.Label(text, (ASIDE, ROWS[row] - BELOW, 0.0), TEXTS[row], style.SMALL_TEXT))
    return records


def _speeds(c: Compared) -> list[scene.Record]:
    degrees = np.rad2deg(c.speeds)
    tops = np.nanmax(degrees, axis=1)
    # The mean of a speed over t is the whole angle.
    top = max(min(tops.max(), _TALLEST * np.rad2deg(c.turned.sum(axis=1)).max()), 1.0)
    ticks = _ticks(top)
    axes = Axes((LEFT, 112.0, RIGHT - LEFT, 206.0), (0.0, 1.0), (0.0, max(1.04 * top, ticks[-1][0])))
    every = 2 if len(c.times) > MOST_STEPS else 1
    records = axes.frame(
        [(float(t), f"${number(t)}$") for t in c.times[::every]],
        ticks,
        "",
        "angular speed, degrees per unit of $t$",
    )
    records.append(scene.Label("$t$", axes.at(1.0, 0.0), style.INK, style.SMALL_TEXT, (34.0, -14.0), "lt"))
    records.append(axes.vertical(c.t, style.MUTED, dash=None))
    for row in (0, 1, 2):
        x, y = _below(c.instants, degrees[row], axes.ylim[1])
        records.append(axes.curve(x, y, COLORS[row], dash=DASHES[row]))
        if tops[row] > axes.ylim[1]:
            peak = c.instants[np.nanargmax(degrees[row])]
            text = rf"up to ${number(tops[row], 0)}^{{\circ}}$"
            at = axes.at(peak, axes.ylim[1])
            records.append(scene.Label(text, at, TEXTS[row], style.SMALL_TEXT, (0.0, -14.0), "ct", room=90.0))
        if not np.isfinite(degrees[row]).all():
            records.append(axes.dots(0.5, 0.0, COLORS[row], 8.0, hollow=True))
    for color, speed in zip(COLORS, np.rad2deg(c.speeds_now), strict=True):
        if speed <= axes.ylim[1]:
            records.append(scene.Points([axes.at(c.t, speed)], color, 10.0, rim=style.PAPER, shaded=False))
    return records


def _ticks(top: float) -> Ticks:
    """Two to five round numbers of degrees from 0 on, the last at or below `top`."""
    steps = (0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 90.0, 180.0, 360.0, 720.0, 1800.0)
    step = next((s for s in steps if top / s < 4.5), steps[-1])
    return [(k * step, _degrees(np.deg2rad(k * step), 1)) for k in range(int(top / step) + 1)]


def _below(x: np.ndarray, y: np.ndarray, top: float) -> tuple[np.ndarray, np.ndarray]:
    """A curve where it is not above `top`, with its points there; NaN breaks it."""
    above = y > top
    cut = np.flatnonzero(above[1:] != above[:-1])
    part = (top - y[cut]) / (y[cut + 1] - y[cut])
    crossing = x[cut] + part * (x[cut + 1] - x[cut])
    kept = np.where(above, np.nan, y)
    return np.insert(x, cut + 1, crossing), np.insert(kept, cut + 1, top)


def _note(ways: _slerp_ways.Ways) -> list[scene.Record]:
    """What is particular about the two ends, in one line below everything."""
    cosine = float(ways.start @ ways.end)
    value = rf"$q_0 \cdot q_1 = {number(cosine)}$"
    if ways.opposite:
        text = r"$q_1 = -q_0$: any axis $u$ serves, here $i$; nlerp has a gap at $t = 1/2$."
    elif ways.theta < 1e-9:
        text = "$q_1 = q_0$: nothing turns."
    elif cosine < 0.0:
        shorter = _degrees(2.0 * (np.pi - ways.theta))
        text = f"{value}: the long way round, as given; to $-q_1$ it is {shorter}."
    else:
        text = f"{value}: the short way round."
    return [scene.Label(text, (LEFT, 32.0, 0.0), style.INK, style.SMALL_TEXT, anchor="ln")]


def _paths(c: Compared) -> list[scene.View]:
    """Where the tip of one axis goes on a sphere: round the axis u, but not with Euler angles."""
    k = c.axis
    camera = Camera(DIRECTION, height=2.46)
    tips, here = c.rotations[..., k], c.now[..., k]
    records: list[scene.Record] = list(globe(camera))
    if c.ways.theta > 1e-9:
        u = c.ways.line / c.ways.theta
        records += [
            scene.Lines([-1.12 * u, 1.0 * u], style.INK, style.EDGE),
            scene.Arrow(0.98 * u, 1.22 * u, style.INK, 0.016, 3.4),
            marks.beyond("$u$", 1.22 * u, u, camera, size=style.SMALL_TEXT, gap=18.0, room=60.0),
        ]
    for row in (0, 2):
        curve = 1.004 * c.paths[row, :, :, k]
        records.append(scene.Lines(curve, COLORS[row], style.CURVE, dash=DASHES[row]))
        records.append(scene.Points(1.004 * tips[row], COLORS[row], 5.5))
    seen = np.isfinite(tips[1]).all(axis=-1)
    records.append(scene.Points(1.01 * tips[1][seen], style.PAPER, 4.5, rim=COLORS[1], shaded=False))
    for row in (0, 1, 2):
        if np.isfinite(here[row]).all():
            records.append(scene.Points([1.01 * here[row]], COLORS[row], 10.0, rim=style.PAPER))
    title = f"path of the ${'xyz'[k]}$ axis"
    heading = scene.Label(title, (ASIDE, 344.0, 0.0), style.AXES_TEXT[k], style.TEXT, anchor="cb")
    return [scene.View((heading,)), scene.View(tuple(records), camera, (890.0, 42.0, 300.0, 296.0))]
