"""The picture of figure 2.8: a line of the tangent space laid onto a great arc of the unit quaternions."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lietool.lie import quaternion
from lietool.render import scene, style
from lietool.render.camera import Camera, around
from lietool.render.globe import globe, joined, parallels
from lietool.render.plot import number
from lietool.render.solids import fan_faces

# Nearer than this to another, in radians of arc, a point goes without a name of its own.
_CLOSE = 0.2
# From this theta on the sector holds the name of the marked point on one side of its spoke or on the other.
_WIDE = 1.2
_BOX = (40.0, 146.0, 1120.0, 658.0)
_DIRECTION = (0.30, -1.0, 0.62)
# The radii of the arcs at the centre that show t theta and theta.
_PART, _WHOLE = 0.26, 0.46
# The drawn part of the tangent plane: half its depth, how far it goes on to the left, and where u lies in it.
_DEPTH, _LEFT, _BEHIND = 0.80, -0.75, 0.44


class Slice:
    """The unit quaternions of span(1, u, v) q0 as a sphere in space: q0 up, u q0 to the right."""

    def __init__(self, start: np.ndarray, u: np.ndarray) -> None:
        v = np.cross(np.eye(3)[np.argmin(np.abs(u))], u)
        units = np.array([u, v / np.linalg.norm(v), [0.0, 0.0, 0.0]])
        basis = np.concatenate([[[0.0], [0.0], [1.0]], units], axis=1)
        self.basis = quaternion.multiply(basis, start)

    def of(self, q: np.ndarray) -> np.ndarray:
        """Return quaternions (..., 4) as points of space (..., 3)."""
        return q @ self.basis.T


@dataclass(frozen=True, eq=False)
class Shown:
    """Points in the slice: on the tangent line, on the arc; whether q0 = 1, and whether q1 = -q0."""

    theta: float
    t: float
    line: np.ndarray
    arc: np.ndarray
    marked_line: np.ndarray
    marked: np.ndarray
    curve: np.ndarray
    at_one: bool
    opposite: bool


def picture(s: Shown) -> scene.Picture:
    ball = parallels(1.0, np.deg2rad(np.arange(-90.0, 91.0, 15.0)), 25)
    ball = ball[np.isfinite(ball[:, 0])]
    shown = np.concatenate([ball, _plane_corners(_reach(s.theta)), _wrap(s.theta)])
    camera = around(shown, _DIRECTION, _BOX, 1.0)
    records = [*_plane(s), *globe(camera), *_sector(s), *_curves(s), *_names(s, camera)]
    return scene.Picture((scene.View(tuple(records), camera, _BOX), scene.View(tuple(_texts(s)))))


def _texts(s: Shown) -> list[scene.Record]:
    """The title, and below the picture the two equations and the numbers."""
    moved = "" if s.at_one else r"\,q_0"
    start = "1" if s.at_one else "q_0"
    law = rf"$\mathrm{{slerp}}({start}, q_1, t) = \exp(t\theta\mathbf{{u}}){moved}$"
    if s.opposite:
        law = r"$q_1 = -q_0$: any $\mathbf{u}$ serves, here $i$"
    laws = r"$\exp(\theta\mathbf{u}) = \cos\theta + (\sin\theta)\,\mathbf{u}$,   " + law
    angles = (
        rf"{name} = {np.rad2deg(x):.1f}^{{\circ}}"
        for name, x in ((r"\theta", s.theta), (r"t\theta", s.t * s.theta))
    )
    values = r",\;\; ".join([f"t = {number(s.t)}", *angles])
    title = "equal steps on the line, equal arcs on the sphere"
    return [
        scene.Label(title, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label(laws, (600.0, 92.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
        scene.Label(f"${values}$", (600.0, 40.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
    ]


def _reach(theta: float) -> float:
    """Where the drawn part of the tangent plane ends."""
    return max(1.5, theta + 0.30)


def _plane_corners(reach: float) -> np.ndarray:
    y = _DEPTH
    return np.array([[_LEFT, -y, 1.0], [reach, -y, 1.0], [reach, y, 1.0], [_LEFT, y, 1.0]])


def _plane(s: Shown) -> list[scene.Record]:
    """A plane of the tangent space with its grid, and u in it, beside the line that it directs."""
    reach = _reach(s.theta)
    corners = _plane_corners(reach)
    grid = [np.array([[x, -_DEPTH, 1.0], [x, _DEPTH, 1.0]]) for x in np.arange(-0.5, reach, 0.25)]
    grid += [np.array([[_LEFT, v, 1.0], [reach, v, 1.0]]) for v in np.arange(-0.5, _DEPTH, 0.25)]
    records: list[scene.Record] = [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.ALGEBRA, material="flat", alpha=0.06),
        scene.Lines(joined(grid), style.ALGEBRA, style.HAIR, 0.22),
        scene.Lines(np.concatenate([corners, corners[:1]]), style.ALGEBRA, style.THIN, 0.7),
    ]
    if s.theta > 1e-12:
        ends = np.array([[0.0, _BEHIND, 1.0], [1.0, _BEHIND, 1.0]])
        records.append(scene.Arrow(ends[0], ends[1], style.ALGEBRA, 0.011, 3.0))
    return records


def _sector(s: Shown) -> list[scene.Record]:
    """The angle theta at the centre, and the part t theta of it."""
    fan = np.concatenate([[[0.0, 0.0, 0.0]], s.curve])
    spokes = joined(np.stack([np.zeros(3), end]) for end in (s.curve[0], s.curve[-1]))
    part = s.curve[: max(round(s.t * (len(s.curve) - 1)) + 1, 2)]
    return [
        scene.Surface(fan, fan_faces(len(fan)), style.GROUP, material="flat", alpha=0.10),
        scene.Lines(spokes, style.GROUP_TEXT, style.THIN),
        scene.Lines(np.stack([np.zeros(3), s.marked]), style.GROUP_TEXT, style.EDGE),
        scene.Lines(_PART * part, style.GROUP_TEXT, style.EDGE),
        scene.Lines(_WHOLE * s.curve, style.GROUP_TEXT, style.THIN),
        scene.Points([(0.0, 0.0, 0.0)], style.INK, 6.0),
    ]


def on_line(x: ArrayLike) -> np.ndarray:
    x = np.asarray(x, float)
    return np.stack([x, 0.0 * x, 0.0 * x + 1.0], axis=-1)


def _curves(s: Shown) -> list[scene.Record]:
    """The straight line above, the arc below, and how the line is laid onto the arc."""
    wraps = [_wrap(x) for x in s.line[1:, 0] if x > 1e-9]
    ends = np.stack([on_line(_LEFT), on_line(_reach(s.theta))])
    records: list[scene.Record] = [scene.Lines(ends, style.ALGEBRA, style.THIN)]
    if wraps:
        records += [
            scene.Lines(joined(wraps), style.MUTED, style.THIN, 0.6),
            scene.Tube(s.line, style.ALGEBRA, 0.013),
            scene.Tube(1.006 * s.curve, style.GROUP, 0.015),
        ]
    return [
        *records,
        scene.Points(s.line, style.ALGEBRA, 7.5),
        scene.Points(1.006 * s.arc, style.GROUP, 7.5),
        scene.Lines(_wrap(float(s.marked_line[0])), style.INK, style.EDGE),
        scene.Points([s.marked_line], style.ALGEBRA, 12.5, rim=style.PAPER),
        scene.Points([1.006 * s.marked], style.GROUP, 12.5, rim=style.PAPER),
    ]


def _wrap(x: float) -> np.ndarray:
    """The way of a point of the line, at distance x, while the line is wound onto the great circle."""
    wound = np.linspace(0.0, x, 41)
    sine, cosine = np.sin(wound), np.cos(wound)
    return np.stack([sine + (x - wound) * cosine, 0.0 * wound, cosine - (x - wound) * sine], axis=-1)


def _names(s: Shown, camera: Camera) -> list[scene.Record]:
    """Names of the ends, and of the marked point where that is not one of them."""
    moved = "" if s.at_one else r"\,q_0"
    plane = rf"$\mathrm{{Im}}\,\mathrm{{\mathbb{{H}}}}{moved}$"
    start = r"$1 = q_0$" if s.at_one else r"$q_0$"
    blue, dark, small = style.ALGEBRA_TEXT, style.GROUP_TEXT, style.SMALL_TEXT
    names: list[scene.Record] = [
        scene.Label(plane, (_reach(s.theta), -_DEPTH, 1.0), blue, offset=(0.0, -12.0), anchor="rt"),
        scene.Label(start, s.line[0], style.INK, offset=(2.0, 33.0), anchor="rb"),
    ]
    if s.theta > 1e-12:
        text = rf"$\mathbf{{u}}{moved}$"
        names.append(scene.Label(text, (0.5, _BEHIND, 1.0), blue, offset=(0.0, 17.0), anchor="cb"))
    at, rest = s.t * s.theta, (1.0 - s.t) * s.theta
    if s.theta > _CLOSE:
        names.append(scene.Label(r"$q_1$", s.arc[-1], style.INK, offset=(20.0, -8.0), anchor="lt"))
    if rest > _CLOSE:
        text = rf"$\theta\mathbf{{u}}{moved}$"
        names.append(scene.Label(text, s.line[-1], blue, offset=(0.0, 22.0), anchor="cb"))
    if rest > 1.5 * _CLOSE:
        middle = (_WHOLE + 0.11) * _on_circle(at + rest / 2.0)
        names.append(scene.Label(r"$\theta$", middle, dark, small))
    if at > _CLOSE:
        text = rf"t\theta\mathbf{{u}}{moved}"
        names += [
            scene.Label(f"${text}$", s.marked_line, blue, offset=(0.0, 24.0), anchor="cb"),
            _name_of_marked(s, rf"$\exp(t\theta\mathbf{{u}}){moved}$", at, camera),
            scene.Label(r"$t\theta$", (_PART + 0.10) * _on_circle(at / 2.0), dark, small),
        ]
    return names


def _on_circle(angle: float) -> np.ndarray:
    return np.array([np.sin(angle), 0.0, np.cos(angle)])


def _name_of_marked(s: Shown, text: str, angle: float, camera: Camera) -> scene.Label:
    """The name of the marked point, inside the sector; while that is narrow, in what is left of it.

    In motion it passes from one to the other over its own spoke; only in a small angle has it to be moved.
    """
    # About half of the text's width and height, and what is free around the ball.
    half = np.array([62.0 if s.at_one else 78.0, 14.0]) + 22.0
    back = camera.axes[:2] @ (-_on_circle(angle + np.pi / 2.0) - 1.3 * s.marked)
    inside = half * np.clip(1.6 * back / np.linalg.norm(back), -1.0, 1.0)
    away = 0.74 * _on_circle(angle + 0.36) - s.marked
    ahead = camera.axes[:2] @ away * _BOX[3] / camera.height
    part = float(np.clip((angle - 0.55) / 0.4, 0.0, 1.0))
    offset = part * inside + (1.0 - part) * ahead
    room = 80.0 if s.theta < _WIDE else 0.0
    return scene.Label(
        text, s.marked, style.GROUP_TEXT, offset=(float(offset[0]), float(offset[1])), room=room
    )
