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
DIRECTION = (1.0, -0.44, 0.28)
# Rows and plot share one t axis, from LEFT to RIGHT; ASIDE is the middle of what is beside them.
LEFT, RIGHT, ASIDE = 224.0, 724.0, 968.0
ROWS = (732.0, 578.0, 424.0)
# The largest box of a solid on the page, and how far below its middle the numbers are.
CELL, BELOW = 114.0, 80.0
PLOT = (LEFT, 106.0, RIGHT - LEFT, 140.0)
SPHERE = (ASIDE - 196.0, 392.0, 392.0, 392.0)
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
    """Return rows of solids above their speeds, with the moment t across; beside these the paths of a tip."""
    camera = Camera(DIRECTION, height=1.46)
    apart = (RIGHT - LEFT) / max(len(c.times) - 1, 1)
    cell = min(CELL, 1.2 * apart)
    now = LEFT + c.t * (RIGHT - LEFT)
    hairline = scene.Lines([(now, ROWS[2] - 64.0, 0.0), (now, ROWS[0] + 58.0, 0.0)], style.MUTED, style.THIN)
    views = [scene.View((hairline,))]
    for row, y in enumerate(ROWS):
        for x, R in zip(LEFT + c.times * (RIGHT - LEFT), c.rotations[row], strict=True):
            # The solid of the moment t moves along the row; those of the steps make way for it.
            way = float(np.clip((abs(x - now) / apart - 0.25) / 0.7, 0.0, 1.0))
            views += _solid(R, (x, y), cell, camera, way)
        views += _solid(c.now[row], (now, y), cell, camera)
    page = [*_row_texts(c), *_moment(c), *_speeds(c), *_note(c.ways)]
    views.append(scene.View(tuple(page)))
    return scene.Picture((*views, *_paths(c)))


def _solid(
    R: np.ndarray, at: tuple[float, float], size: float, camera: Camera, alpha: float = 1.0
) -> list[scene.View]:
    """The solid with its axes; a gap where the rotation is undefined."""
    box = (at[0] - size / 2.0, at[1] - size / 2.0, size, size)
    if alpha < 0.02:
        return []
    if not np.isfinite(R).all():
        gap = scene.Label("gap", (*at, 0.0), style.MARK, style.SMALL_TEXT)
        return [scene.View((gap,))] if alpha > 0.5 else []
    arrows = (
        scene.Arrow(np.zeros(3), 0.74 * R[:, k], color, 0.019, 3.2, alpha)
        for k, color in enumerate(style.AXES)
    )
    return [scene.View((*marks.letter(R, alpha=alpha), *arrows), camera, box)]


def _degrees(angle: float, digits: int | None = None) -> str:
    """An angle in radians as degrees, in whole ones from 10 on."""
    degrees = np.rad2deg(angle)
    if digits is None:
        digits = 0 if degrees >= 9.95 else 1 if degrees >= 0.995 else 2
    return rf"${number(degrees, digits)}^{{\circ}}$"


def _row_texts(c: Compared) -> list[scene.Record]:
    """The times; names with samples of their lines, the whole angle, and what is turned from step to step."""
    x = LEFT + c.times * (RIGHT - LEFT)
    title = "three ways, at equal steps of $t$"
    records: list[scene.Record] = [
        scene.Label(title, ((LEFT + RIGHT) / 2.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label("$t =$", (LEFT - 26.0, 798.0, 0.0), style.INK, style.SMALL_TEXT, anchor="rn"),
    ]
    records += [
        scene.Label(text, (LEFT + t * (RIGHT - LEFT), 798.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")
        for t, text in _times(c)
    ]
    for row, y in enumerate(ROWS):
        for text, up, color, size in (
            (_slerp_ways.NAMES[row], 22.0, TEXTS[row], style.TITLE_TEXT),
            (f"{_degrees(c.turned[row].sum())} in all", -42.0, style.INK, style.SMALL_TEXT),
        ):
            records.append(scene.Label(text, (28.0, y + up, 0.0), color, size, anchor="ln"))
        records.append(
            scene.Lines([(28.0, y, 0.0), (106.0, y, 0.0)], COLORS[row], style.CURVE, dash=DASHES[row])
        )
        for start, end, angle in zip(x[:-1] + 6.0, x[1:] - 6.0, c.turned[row], strict=True):
            low, high = y - BELOW + 18.0, y - BELOW + 24.0
            bracket = [(start, high, 0), (start, low, 0), (end, low, 0), (end, high, 0)]
            where = ((start + end) / 2.0, y - BELOW + 9.0, 0.0)
            records.append(scene.Lines(bracket, style.RULE, style.THIN))
            records.append(scene.Label(_degrees(angle), where, style.INK, style.SMALL_TEXT, anchor="ct"))
    return records


def _times(c: Compared) -> Ticks:
    """The times of the solids, as many as there is room for."""
    return [(float(t), f"${number(t)}$") for t in c.times[:: 2 if len(c.times) > MOST_STEPS else 1]]


def _moment(c: Compared) -> list[scene.Record]:
    """How far each way is from slerp at the moment t, with the ball that it has on the sphere."""
    heading = rf"at $t = {number(c.t)}$"
    records: list[scene.Record] = [
        scene.Label(heading, (ASIDE, PLOT[1] + PLOT[3] + 30.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
    ]
    for row, y in ((1, 216.0), (2, 166.0)):
        text = f"{_slerp_ways.NAMES[row]} undefined"
        if np.isfinite(c.aside[row]):
            text = f"{_degrees(c.aside[row])} from slerp"
        at = (ASIDE - 96.0, y, 0.0)
        records.append(scene.Points([(ASIDE - 122.0, y, 0.0)], COLORS[row], 9.0))
        records.append(scene.Label(text, at, TEXTS[row], style.SMALL_TEXT, anchor="lc"))
    return records


def _speeds(c: Compared) -> list[scene.Record]:
    degrees = np.rad2deg(c.speeds)
    tops = np.nanmax(degrees, axis=1)
    # The mean of a speed over t is the whole angle.
    top = max(min(tops.max(), _TALLEST * np.rad2deg(c.turned.sum(axis=1)).max()), 1.0)
    ticks = _ticks(top)
    axes = Axes(PLOT, (0.0, 1.0), (0.0, max(1.04 * top, ticks[-1][0])))
    records = axes.frame(_times(c), ticks)
    title, above = "angular speed, degrees per unit of $t$", (PLOT[2] / 2.0, PLOT[3] + 30.0)
    at = (PLOT[0] + above[0], PLOT[1] + above[1], 0.0)
    records.append(scene.Label(title, at, style.INK, style.TITLE_TEXT, anchor="cn"))
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
        text = r"$q_1 = -q_0$: any axis $\mathbf{u}$ serves, here $i$; nlerp has a gap at $t = 1/2$."
    elif ways.theta < 1e-9:
        text = "$q_1 = q_0$: nothing turns."
    elif cosine < 0.0:
        shorter = _degrees(2.0 * (np.pi - ways.theta))
        text = f"{value}: the long way round, as given; to $-q_1$ it is {shorter}."
    else:
        text = f"{value}: the short way round."
    return [scene.Label(text, (600.0, 34.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")]


def _paths(c: Compared) -> list[scene.View]:
    """Where the tip of one axis goes on a sphere: round the axis u, but not with Euler angles."""
    k = c.axis
    camera = Camera(DIRECTION, height=2.28)
    tips, here = c.rotations[..., k], c.now[..., k]
    records: list[scene.Record] = [*globe(camera), *_axis(c.ways, camera)]
    for row in (0, 2):
        records.append(scene.Lines(1.004 * c.paths[row, :, :, k], COLORS[row], style.CURVE, dash=DASHES[row]))
    for row in (0, 1, 2):
        inner = 1.004 * tips[row, 1:-1]
        inner = inner[np.isfinite(inner).all(axis=-1)]
        if len(inner):
            records.append(scene.Points(inner, COLORS[row], 6.0))
        if np.isfinite(here[row]).all():
            records.append(scene.Points([1.01 * here[row]], COLORS[row], 9.0, rim=style.PAPER))
    records += _ends(tips[0, 0], tips[0, -1], camera)
    title = f"path of the ${'xyz'[k]}$ axis"
    heading = scene.Label(title, (ASIDE, 846.0, 0.0), style.AXES_TEXT[k], style.TITLE_TEXT, anchor="cn")
    return [scene.View((heading,)), scene.View(tuple(records), camera, SPHERE)]


def _axis(ways: _slerp_ways.Ways, camera: Camera) -> list[scene.Record]:
    """The unit vector u about which slerp turns, on its axis."""
    if ways.theta <= 1e-9:
        return []
    u = ways.line / ways.theta
    return [
        scene.Lines([-1.06 * u, 1.06 * u], style.INK, style.THIN),
        scene.Arrow(np.zeros(3), u, style.INK, 0.012, 3.4),
        marks.beyond(r"$\mathbf{u}$", u, u, camera, gap=24.0, room=60.0),
    ]


def _ends(first: np.ndarray, last: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The tips at t = 0 and t = 1, which the three ways share."""
    same = np.linalg.norm(first - last) < 0.1
    named = ((first, "$0$"), (last, "$1$")) if not same else ((first, "$0, 1$"),)
    return [
        scene.Points(1.006 * np.stack([first, last]), style.INK, 7.5),
        *(
            marks.beyond(text, tip, tip, camera, size=style.SMALL_TEXT, gap=24.0, room=60.0)
            for tip, text in named
        ),
    ]
