"""Figure 2.7 of the book."""

from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.render import scene, solids, style
from lietool.render.camera import Box, Camera
from lietool.render.globe import globe, joined
from lietool.render.marks import LETTER, LETTER_BEFORE, beyond, curved_arrow, letter
from lietool.render.plot import Axes, number

from . import _directions
from ._double_cover import FULL, Shown, distances, lift

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
_MULTIPLY, _ACT = Library("lietool.lie.quaternion.multiply"), Library("lietool.lie.quaternion.act")
# The solid is looked at from here; on the sphere it is turned so that it looks the same.
LOOK = (1.0, 0.45, 0.38)
_SOLID: Box = (20.0, 372.0, 440.0, 440.0)
_SPHERE: Box = (428.0, 20.0, 760.0, 800.0)
_MIDDLES, _TITLE = (240.0, 808.0), 846.0
# Distance of the solids from the middle of the sphere, on the page; that of the angles, along their radii.
_BESIDE, _SIZE, _ANGLES = 1.41, 0.42, 0.76
# So that the great circle lies well inside of the outline: its plane is seen at this angle.
_CAMERA = Camera((0.62, -1.0, 0.28), (0.0, 0.0, 0.0), 3.5)
# Half the width and the height that the text of an angle needs, in page units.
_TEXT = (44.0, 23.0)
# First radius of the turns about the solid, and by how much they open; thickness and head of the ways.
_RING, _OPENING, _SHAFT, _HEAD = 0.70, 0.15, 0.016, 4.8
# Half a ball, in radians of the sphere: there a way ends.
_BALL = 0.055
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
                "1 to -1, in the second back to 1; the angles are those of the solid. Opposite points q and "
                "-q are one rotation: the solids there look alike. Below: how far the rotation R (thin) and "
                "the quaternion q (heavy) are from their start."
            ),
        )
    },
    time=Time("turn", 0.0, 720.0, frames=96, seconds=8.0, closed=True),
)
def double_cover(
    axis: Annotated[Vector, Param("axis of the turning (x, y, z), brought to length 1")] = (0.9, -0.15, 0.42),
    turn: Annotated[float, Param("angle by which the solid has turned", "deg", 0.0, 1440.0)] = 720.0,
    q: Annotated[Quaternion, Param("quaternion of the start (w, x, y, z), brought to length 1")] = (
        1.0,
        0.0,
        0.0,
        0.0,
    ),
    *,
    multiply: Library = _MULTIPLY,
    act: Library = _ACT,
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
    at_stages, now = (lift(u, start, angle, multiply) for angle in (stages, theta))
    shown = Shown(u, start, theta, stages, at_stages, now, multiply, act)
    along = np.linspace(0.0, max(theta, 2.0 * FULL), 241)
    far = distances(shown.at(along), start)
    here = distances(shown.now, start)
    look = Camera(LOOK, (0.0, 0.0, 0.0), 2.6)
    views = (
        scene.View(tuple(_solid(shown, look)), look, _SOLID),
        scene.View(tuple(_sphere(shown, _CAMERA, look)), _CAMERA, _SPHERE),
        scene.View((*_headings(shown), *_plot(along, far, theta, here))),
    )
    numbers = {
        "axis": u,
        "stages": np.rad2deg(stages),
        "quaternions": shown.at_stages,
        "rotations": shown.turned_at_stages,
        "quaternion": shown.now,
        "rotation": shown.turned,
        "turn": np.rad2deg(along),
        "distances": np.rad2deg(far),
    }
    return Drawing(scene.Picture(views), numbers)


def _route(curve: np.ndarray, lap: int, radius: float) -> list[scene.Record]:
    """One turn of a way (n, 3): odd turns whole, even ones in dashes of another colour."""
    if lap % 2 == 0:
        return curved_arrow(curve, style.ROUTE_1, radius, _HEAD)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=-1))])
    # The last dash is as long as its head needs.
    dashed = max(length[-1] - 3.6 * _HEAD * radius, 0.0)
    count = max(round(dashed / _DASH), 1)
    cuts = np.append(np.linspace(0.0, dashed, 3 * count + 1), length[-1])
    if length[-1] > 0.0 and dashed == 0.0:
        return curved_arrow(curve, style.ROUTE_2, radius, _HEAD)
    records: list[scene.Record] = []
    for first, last in [*zip(cuts[0:-1:3], cuts[2:-1:3], strict=False), cuts[-2:]]:
        inside = length[(length > first) & (length < last)]
        at = np.concatenate([[first], inside, [last]])
        piece = np.stack([np.interp(at, length, column) for column in curve.T], axis=-1)
        if last == length[-1]:
            records += curved_arrow(piece, style.ROUTE_2, radius, _HEAD)
        else:
            records.append(scene.Tube(piece, style.ROUTE_2, radius))
    return records


def _solid(s: Shown, look: Camera) -> list[scene.Record]:
    """The solid as it is now, its axis, and about it the turns so far, each outside of the one before."""
    records = letter(s.turned)
    records += [
        scene.Arrow(-0.95 * s.u, 1.3 * s.u, style.INK, 0.012, 4.0),
        beyond(r"$\mathbf{u}$", 1.3 * s.u, s.u, look),
    ]
    frame = _ring_frame(s.u, look)
    for lap, angles in enumerate(s.laps()):
        ring = np.cos(angles)[:, None] * frame[:, 0] + np.sin(angles)[:, None] * frame[:, 1]
        records += _route((_RING + _OPENING * angles / FULL)[:, None] * ring, lap, _SHAFT)
    return records


def _ring_frame(u: np.ndarray, look: Camera) -> np.ndarray:
    """A frame along u; its first column lies in the page, where turns are seen farthest apart."""
    across = np.cross(look.axes[2], u)
    if np.linalg.norm(across) < 1e-6:
        return solids.frame_along(u)
    across /= np.linalg.norm(across)
    return np.stack([across, np.cross(u, across), u], axis=-1)


def _sphere(s: Shown, camera: Camera, look: Camera) -> list[scene.Record]:
    records: list[scene.Record] = [*globe(camera), scene.Points([(0.0, 0.0, 0.0)], style.INK, 5.0)]
    points = s.on_sphere(s.at_stages)
    for lap, angles in enumerate(s.laps()):
        # The third turn goes where the first went; it is drawn beside it.
        outside = 1.004 + 0.05 * (lap // 2)
        angles = angles[angles <= angles[-1] - 2.0 * _BALL]
        if len(angles) > 1:
            records += _route(outside * s.on_sphere(s.at(angles)), lap, _SHAFT)
    now = 1.004 * s.on_sphere(s.now)
    for p in (now, -now):
        # Where the name of a stage lies on this radius it is left free; that of the start lies beside it.
        named = np.linalg.norm(points[1:] - p, axis=-1).min() < 0.01
        records.append(_radius(p, camera, style.INK, style.EDGE, gap=bool(named)))
    records.append(scene.Points([-now], style.PAPER, 10.0, rim=style.INK, shaded=False))
    records.append(scene.Points([now], style.INK, 12.0, rim=style.PAPER))
    return records + _stages(s, points, camera, look) + _names(s, points, now, camera)


def _stages(s: Shown, points: np.ndarray, camera: Camera, look: Camera) -> list[scene.Record]:
    """On the radius of every stage its angle and a solid; stages that are still to come are pale."""
    carry = camera.axes.T @ look.axes
    records: list[scene.Record] = []
    for theta, R, p in zip(s.stages, s.turned_at_stages, points, strict=True):
        reached = theta <= s.theta + 1e-9
        page = camera.axes[:2] @ p
        out = page / np.linalg.norm(page)
        place = _BESIDE * out @ camera.axes[:2]
        records += letter(carry @ R, place, size=_SIZE, colors=LETTER if reached else LETTER_BEFORE)
        color = style.ROUTE_1_TEXT if theta <= FULL else style.ROUTE_2_TEXT
        color = color if reached else style.MUTED
        records += [
            _radius(p, camera, style.MUTED, style.HAIR, gap=theta > 0.0),
            *_angles(s, theta, p, color),
        ]
        records.append(scene.Points([1.004 * p], color, 6.0))
    return records


def _radius(p: np.ndarray, camera: Camera, color: str, width: float, gap: bool) -> scene.Lines:
    """From the middle to a point of the sphere, without the place where an angle is written."""
    if not gap:
        return scene.Lines([0.0 * p, p], color, width)
    page = camera.axes[:2] @ p
    length = float(np.linalg.norm(page))
    half = float(np.min(np.array(_TEXT) * length / np.maximum(np.abs(page), 1e-9)))
    half /= length * _SPHERE[3] / camera.height
    ends = [[0.0 * p, (_ANGLES - half) * p], [(_ANGLES + half) * p, p]]
    return scene.Lines(joined(np.array(ends)), color, width)


def _angles(s: Shown, theta: float, p: np.ndarray, color: str) -> list[scene.Record]:
    """The name of a stage in the gap of its radius; at the start beside it, for there a second one comes."""
    named = [(theta, color, 0.0, "cc")]
    if theta == 0.0:
        named = [(0.0, color, 12.0, "lc")]
        if s.theta >= 2.0 * FULL - 1e-9:
            named.append((2.0 * FULL, style.ROUTE_2_TEXT, -12.0, "rc"))
    return [
        scene.Label(
            rf"${number(np.rad2deg(angle), 0)}^{{\circ}}$",
            _ANGLES * p,
            tone,
            style.SMALL_TEXT,
            (aside, 0.0),
            anchor,
        )
        for angle, tone, aside, anchor in named
    ]


def _names(s: Shown, points: np.ndarray, now: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The names of q and -q beside their balls, and those of the start and of its opposite."""
    one = "1" if s.at_one else "q_0"
    turns = s.theta / FULL
    if abs(turns - round(turns)) < 1e-9:
        sign, other = ("", "-") if round(turns) % 2 == 0 else ("-", "")
        named = ((f"q = {sign}{one}", now), (f"-q = {other}{one}", -now))
    else:
        named = (("q", now), ("-q", -now), (one, points[0]), (f"-{one}", points[4]))
    return [_name(text, at, camera) for text, at in named]


def _name(text: str, at: np.ndarray, camera: Camera) -> scene.Label:
    """Outside of the great circle, beside the solid that stands there."""
    page = camera.axes[:2] @ at
    out = page / np.linalg.norm(page)
    side = 1.0 if out[0] >= -1e-9 else -1.0
    offset = (22.0 * side, 28.0 * float(np.sign(out[1])))
    return scene.Label(
        f"${text}$", at, style.INK, style.TEXT, offset, "lc" if side > 0.0 else "rc", room=30.0
    )


def _headings(s: Shown) -> list[scene.Record]:
    moved = "" if s.at_one else r"\,q_0"
    bracket = ("", "") if s.at_one else ("(", ")")
    degrees = number(np.rad2deg(s.theta), 1)
    texts = (
        (_MIDDLES[0], rf"turned by $\theta = {degrees}^{{\circ}}$"),
        (_MIDDLES[1], rf"$q = {bracket[0]}\cos(\theta/2) + \sin(\theta/2)\,\mathbf{{u}}{bracket[1]}{moved}$"),
    )
    return [
        scene.Label(text, (x, _TITLE, 0.0), style.INK, style.TITLE_TEXT, anchor="cn") for x, text in texts
    ]


def _plot(turn: np.ndarray, far: np.ndarray, theta: float, here: np.ndarray) -> list[scene.Record]:
    """How far R and q are from the start, over the angle."""
    last = float(np.rad2deg(turn[-1]))
    axes = Axes((104.0, 92.0, 300.0, 170.0), (0.0, last), (0.0, 230.0))
    step = 360 if last <= 720.0 else 720
    xticks = [(float(d), rf"${d}^{{\circ}}$") for d in range(0, int(last) + 1, step)]
    yticks = [(0.0, r"$0^{\circ}$"), (180.0, r"$180^{\circ}$")]
    records = axes.frame(xticks, yticks, r"$\theta$", "distance from the start", title_size=style.SMALL_TEXT)
    x, y = np.rad2deg(turn), np.rad2deg(far)
    records.append(axes.curve(x, y[:, 0], style.MUTED, style.EDGE))
    for lap in range(round(last / 360.0 + 0.5)):
        inside = (x >= 360.0 * lap - 1e-9) & (x <= 360.0 * (lap + 1) + 1e-9)
        color, dash = ((style.ROUTE_1, None), (style.ROUTE_2, (9.0, 6.0)))[lap % 2]
        records.append(axes.curve(x[inside], y[inside, 1], color, style.CURVE, dash))
    # Each over its peak in the first two turns.
    for text, at, color in (("$R$", 180.0, style.MUTED), ("$q$", 360.0, style.INK)):
        records.append(
            scene.Label(text, axes.at(at, 180.0), color, style.SMALL_TEXT, (0.0, 10.0), "cb", halo=False)
        )
    now = float(np.rad2deg(theta))
    records.append(axes.vertical(now, style.MUTED))
    records.append(axes.dots(now, float(np.rad2deg(here[0])), style.MUTED, 7.0))
    records.append(axes.dots(now, float(np.rad2deg(here[1])), style.INK, 8.0))
    return records
