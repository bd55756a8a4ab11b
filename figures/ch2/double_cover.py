"""Figure 2.7 of the book."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import quaternion, so3
from lietool.render import scene, solids, style
from lietool.render.camera import Box, Camera
from lietool.render.globe import globe, joined
from lietool.render.marks import LETTER, LETTER_BEFORE, beyond, curved_arrow, letter
from lietool.render.plot import Axes, number

from . import _directions

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
FULL = 2.0 * np.pi
# The solid is looked at from here; on the sphere it is turned so that it looks the same.
_LOOK = (1.0, 0.62, 0.5)
_SOLID: Box = (20.0, 372.0, 440.0, 440.0)
_SPHERE: Box = (428.0, 26.0, 760.0, 800.0)
# Distance of the solids from the middle of the sphere; that of their angles, and how far these are aside.
_BESIDE, _SIZE, _ANGLES, _ASIDE = 1.34, 0.42, 0.80, np.deg2rad(11.5)
_CAMERA = Camera((0.2, -1.0, 0.26), (0.0, 0.0, 0.0), 3.42)
# Length of a dash and its gap, in radii of the sphere.
_DASH = 0.13


@figure(
    plates={
        "B2.7": Plate(
            title="One turn of a solid is half a turn of its quaternion",
            equations=("2.26", "2.29", "2.30"),
            caption=(
                "Left: a solid turns about u once (whole line) and once more (dashed). Right: its unit "
                "quaternion goes half as fast along a great circle of a slice of S^3, in the first turn from "
                "1 to -1, in the second back to 1. Opposite points q and -q are one rotation: the solids at "
                "them look alike. Below: how far the rotation R and the quaternion q are from their start."
            ),
        )
    },
    time=Time("turn", 0.0, 720.0, frames=96, seconds=8.0, closed=True),
)
def double_cover(
    axis: Annotated[Vector, Param("axis of the turning (x, y, z), brought to length 1")] = (0.25, -0.1, 1.0),
    turn: Annotated[float, Param("angle by which the solid has turned", "deg", 0.0, 1440.0)] = 720.0,
    q: Annotated[Quaternion, Param("quaternion of the start (w, x, y, z), brought to length 1")] = (
        1.0,
        0.0,
        0.0,
        0.0,
    ),
) -> Drawing:
    """The double cover: while a solid turns twice, its unit quaternion goes round once.

    What to look for: after 360 degrees the solid is as it was, but its
    quaternion is -q; only after 720 degrees both are back. Solids at opposite
    points of the great circle look alike, for q and -q are one rotation. The
    path is exp(theta u / 2) q, followed without a jump; a further pair of turns
    is drawn a little outside of the first.
    """
    u, start = _directions.unit("axis", axis), _directions.unit("q", q)
    theta = float(np.deg2rad(turn))
    stages = np.arange(8) * np.pi / 2.0
    shown = Shown(u, start, theta, stages, lift(u, start, stages), lift(u, start, theta))
    along = np.linspace(0.0, max(theta, 2.0 * FULL), 241)
    far = distances(lift(u, start, along), start)
    here = distances(shown.now, start)
    look = Camera(_LOOK, (0.0, 0.0, 0.0), 2.6)
    views = (
        scene.View(tuple(_solid(shown, look)), look, _SOLID),
        scene.View(tuple(_sphere(shown, _CAMERA, look)), _CAMERA, _SPHERE),
        scene.View((*_headings(shown), *_plot(along, far, theta, here))),
    )
    numbers = {
        "axis": u,
        "stages": np.rad2deg(stages),
        "quaternions": shown.at_stages,
        "rotations": quaternion.to_matrix(shown.at_stages),
        "quaternion": shown.now,
        "rotation": quaternion.to_matrix(shown.now),
        "turn": np.rad2deg(along),
        "distances": np.rad2deg(far),
    }
    return Drawing(scene.Picture(views), numbers)


@dataclass(frozen=True, eq=False)
class Shown:
    """The turning about `u` from `start`: quaternions at some stages (n, 4), and now, at the angle theta."""

    u: np.ndarray
    start: np.ndarray
    theta: float
    stages: np.ndarray
    at_stages: np.ndarray
    now: np.ndarray

    @property
    def at_one(self) -> bool:
        return bool(np.allclose(self.start, (1.0, 0.0, 0.0, 0.0)))

    def on_sphere(self, q: np.ndarray) -> np.ndarray:
        """Quaternions of the circle (..., 4) as points of space: the start up, u start on the right."""
        imaginary = np.concatenate([[0.0], self.u])
        up, right = self.start, quaternion.multiply(imaginary, self.start)
        return np.stack([q @ right, np.zeros(q.shape[:-1]), q @ up], axis=-1)

    def laps(self) -> list[np.ndarray]:
        """The angles of each turn that has begun."""
        ends = np.append(np.arange(0.0, self.theta - 1e-9, FULL), self.theta)
        return [np.linspace(a, b, max(round((b - a) / 0.04), 1) + 1) for a, b in pairwise(ends)]


def lift(u: np.ndarray, start: np.ndarray, theta: ArrayLike) -> np.ndarray:
    """Return the quaternions exp(theta u / 2) start (..., 4), continuous in theta."""
    half = 0.5 * np.asarray(theta, float)
    return quaternion.multiply(quaternion.exp(half[..., None] * u), start)


def distances(q: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Return how far R and q (..., 4) are from the start, each in its own space (..., 2), radians."""
    R, R0 = quaternion.to_matrix(q), quaternion.to_matrix(start)
    of_R = np.linalg.norm(so3.log(R @ R0.T), axis=-1)
    of_q = 2.0 * np.arctan2(np.linalg.norm(q - start, axis=-1), np.linalg.norm(q + start, axis=-1))
    return np.stack([of_R, of_q], axis=-1)


def _route(curve: np.ndarray, lap: int, radius: float) -> list[scene.Record]:
    """One turn of a way (n, 3): odd turns whole, even ones in dashes of another colour."""
    if lap % 2 == 0:
        return curved_arrow(curve, style.ROUTE_1, radius, 3.8)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=-1))])
    count = max(round(length[-1] / _DASH), 1)
    cuts = np.linspace(0.0, length[-1], 3 * count)
    records: list[scene.Record] = []
    for k in range(count):
        first, last = cuts[3 * k], cuts[3 * k + 2 if k < count - 1 else -1]
        inside = length[(length > first) & (length < last)]
        at = np.concatenate([[first], inside, [last]])
        piece = np.stack([np.interp(at, length, column) for column in curve.T], axis=-1)
        end = k == count - 1
        records += (
            curved_arrow(piece, style.ROUTE_2, radius, 3.8)
            if end
            else [scene.Tube(piece, style.ROUTE_2, radius)]
        )
    return records


def _solid(s: Shown, look: Camera) -> list[scene.Record]:
    """The solid as it is now, its axis, and about it the turns so far, each outside of the one before."""
    records = letter(quaternion.to_matrix(s.now))
    records += [
        scene.Arrow(-0.95 * s.u, 1.18 * s.u, style.INK, 0.012, 4.0),
        beyond("$u$", 1.18 * s.u, s.u, look),
    ]
    frame = solids.frame_along(s.u)
    for lap, angles in enumerate(s.laps()):
        ring = np.cos(angles)[:, None] * frame[:, 0] + np.sin(angles)[:, None] * frame[:, 1]
        records += _route((0.76 + 0.10 * angles / FULL)[:, None] * ring, lap, 0.017)
    return records


def _sphere(s: Shown, camera: Camera, look: Camera) -> list[scene.Record]:
    records: list[scene.Record] = [*globe(camera), scene.Points([(0.0, 0.0, 0.0)], style.INK, 5.0)]
    points = s.on_sphere(s.at_stages)
    diameters = joined(np.stack([-p, p]) for p in points[:4])
    records.append(scene.Lines(diameters, style.MUTED, style.HAIR, 0.7, dash=(4.0, 6.0)))
    for lap, angles in enumerate(s.laps()):
        # The third turn goes where the first went; it is drawn beside it.
        outside = 1.004 + 0.05 * (lap // 2)
        records += _route(outside * s.on_sphere(lift(s.u, s.start, angles)), lap, 0.016)
    now = 1.004 * s.on_sphere(s.now)
    records.append(scene.Lines([now, -now], style.INK, style.EDGE, dash=(9.0, 6.0)))
    records.append(scene.Points([-now], style.PAPER, 10.0, rim=style.INK, shaded=False))
    records.append(scene.Points([now], style.INK, 12.0, rim=style.PAPER))
    # Across the diameter, on the side where the path comes from.
    aside = np.array([-now[2], 0.0, now[0]])
    for text, at in (("$q$", now), ("$-q$", -now)):
        records.append(beyond(text, 0.86 * at, aside, camera, room=70.0))
    return records + _stages(s, points, camera, look)


def _stages(s: Shown, points: np.ndarray, camera: Camera, look: Camera) -> list[scene.Record]:
    """Beside every stage a solid, inside its angle; stages that are still to come are pale."""
    carry = camera.axes.T @ look.axes
    records: list[scene.Record] = []
    for theta, R, p in zip(s.stages, quaternion.to_matrix(s.at_stages), points, strict=True):
        reached = theta <= s.theta + 1e-9
        records += letter(carry @ R, _BESIDE * p, size=_SIZE, colors=LETTER if reached else LETTER_BEFORE)
        color = style.ROUTE_1_TEXT if theta <= FULL else style.ROUTE_2_TEXT
        color = color if reached else style.MUTED
        records.append(_angle(s, theta, _ASIDE * _side(theta), color))
        records.append(scene.Points([1.004 * p], color, 6.0))
    if s.theta >= 2.0 * FULL - 1e-9:
        records.append(_angle(s, 2.0 * FULL, -_ASIDE, style.ROUTE_2_TEXT))
    return records + _poles(s, points, camera)


def _side(theta: float) -> float:
    """On which side of its diameter the name of a stage has room: away from the vertical one."""
    slanting = np.sin(theta)
    return float(np.sign(slanting)) if abs(slanting) > 0.5 else -1.0 if np.cos(theta / 2.0) < -0.5 else 1.0


def _angle(s: Shown, theta: float, aside: float, color: str) -> scene.Label:
    """The name of a stage, inside the sphere and beside the diameter."""
    at = s.on_sphere(lift(s.u, s.start, theta + 2.0 * aside))
    text = rf"${number(np.rad2deg(theta), 0)}^{{\circ}}$"
    return scene.Label(text, _ANGLES * at, color, style.SMALL_TEXT)


def _poles(s: Shown, points: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The names of the start and of its opposite, beside their solids."""
    names = ("$1$", "$-1$") if s.at_one else ("$q_0$", "$-q_0$")
    offset = (0.62 * _SIZE * _SPHERE[3] / camera.height, 0.0)
    return [
        scene.Label(name, _BESIDE * p, style.INK, style.TEXT, offset, "lc")
        for name, p in zip(names, points[[0, 4]], strict=True)
    ]


def _headings(s: Shown) -> list[scene.Record]:
    moved = "" if s.at_one else r"\,q_0"
    bracket = ("", "") if s.at_one else ("(", ")")
    degrees = number(np.rad2deg(s.theta), 1)
    texts = (
        (240.0, rf"turned by $\theta = {degrees}^{{\circ}}$"),
        (820.0, rf"$q = {bracket[0]}\cos(\theta/2) + \sin(\theta/2)\,u{bracket[1]}{moved}$"),
    )
    return [scene.Label(text, (x, 852.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn") for x, text in texts]


def _plot(turn: np.ndarray, far: np.ndarray, theta: float, here: np.ndarray) -> list[scene.Record]:
    """How far R and q are from the start, over the angle."""
    last = float(np.rad2deg(turn[-1]))
    axes = Axes((104.0, 92.0, 300.0, 150.0), (0.0, last), (0.0, 190.0))
    step = 360 if last <= 720.0 else 720
    xticks = [(float(d), rf"${d}^{{\circ}}$") for d in range(0, int(last) + 1, step)]
    yticks = [(0.0, r"$0^{\circ}$"), (180.0, r"$180^{\circ}$")]
    records = axes.frame(xticks, yticks, "", "distance from the start", title_size=style.SMALL_TEXT)
    x, y = np.rad2deg(turn), np.rad2deg(far)
    records.append(axes.curve(x, y[:, 0], style.MUTED, style.EDGE))
    for lap in range(round(last / 360.0 + 0.5)):
        inside = (x >= 360.0 * lap - 1e-9) & (x <= 360.0 * (lap + 1) + 1e-9)
        color, dash = ((style.ROUTE_1, None), (style.ROUTE_2, (9.0, 6.0)))[lap % 2]
        records.append(axes.curve(x[inside], y[inside, 1], color, style.CURVE, dash))
    for text, at, color in (("$q$", (360.0, 122.0), style.INK), ("$R$", (660.0, 122.0), style.MUTED)):
        records.append(scene.Label(text, axes.at(*at), color, style.SMALL_TEXT, room=50.0))
    now = float(np.rad2deg(theta))
    records.append(axes.vertical(now, style.MUTED))
    records.append(axes.dots(now, float(np.rad2deg(here[0])), style.MUTED, 7.0))
    records.append(axes.dots(now, float(np.rad2deg(here[1])), style.INK, 8.0))
    return records
