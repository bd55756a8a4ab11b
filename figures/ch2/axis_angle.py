"""Figure 2.5 of the book."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import so3
from lietool.render import scene, solids, style
from lietool.render.camera import Box, Camera, around
from lietool.render.globe import globe, parallels
from lietool.render.marks import beyond, coordinate_axes, curved_arrow
from lietool.render.plot import number

from . import _directions

Vector = tuple[float, float, float]
_SPACE: Box = (60.0, 116.0, 1080.0, 724.0)
_CORNER: Box = (24.0, 24.0, 200.0, 200.0)
# The plane of the circle is seen best when the line of sight meets it at about this sine.
_TILT = 0.45
# A part of x that is shorter than this, as a fraction of x, is not there.
_ZERO = 1e-9
_SHAFT, _AXIS, _TURN = 0.017, 1.42, 0.14


@dataclass(frozen=True, eq=False)
class _Shown:
    """The vectors of (2.14) in units of |x|, and the unit vectors v, w = u x v in the plane of the circle."""

    u: np.ndarray
    v: np.ndarray
    w: np.ndarray
    theta: float
    x: np.ndarray
    image: np.ndarray

    @property
    def center(self) -> np.ndarray:
        """(u . x) u"""
        return (self.u @ self.x) * self.u

    @property
    def radius(self) -> float:
        """The length of x - (u . x) u, and of u x x."""
        return float(np.linalg.norm(self.x - self.center))

    @property
    def leans(self) -> bool:
        """Whether x has a part along the axis."""
        return abs(float(self.u @ self.x)) > _ZERO

    def around(self, radius: ArrayLike, angle: np.ndarray) -> np.ndarray:
        """Points (n, 3) of a circle about the axis; angle 0 is the direction of x."""
        ring = np.cos(angle)[:, None] * self.v + np.sin(angle)[:, None] * self.w
        return self.center + np.reshape(radius, (-1, 1)) * ring


@figure(
    plates={
        "B2.5": Plate(
            title="Axis and angle",
            equations=("2.14", "2.15", "2.16", "2.17", "2.18"),
            caption=(
                "The rotation by theta about the axis u carries x along a circle to Rx. The part (u.x)u of x "
                "along the axis stays. The part x - (u.x)u across it, and u x x, as long and at right angles "
                "to both, span the plane of the circle; there Rx is reached by the cosine of theta along the "
                "one and the sine along the other (dashed)."
            ),
        )
    },
    time=Time("angle", 0.0, 360.0, closed=True),
)
def axis_angle(
    u: Annotated[Vector, Param("axis (x, y, z), brought to length 1")] = (0.1, 0.35, 0.95),
    x: Annotated[Vector, Param("the vector that is turned (x, y, z)")] = (0.9, -0.4, 1.0),
    angle: Annotated[float, Param("angle of the rotation", "deg", -720.0, 720.0)] = 140.0,
) -> Drawing:
    """Axis and angle: the rotation about u carries x along a circle, by Rodrigues' formula.

    What to look for: blue is the part of x along the axis, which does not move;
    red is the part across it, and green is u x x, a quarter turn further on.
    The dashed way to Rx is cos(theta) times red, then sin(theta) times green.
    The circle is a parallel of the sphere of radius |x| whose pole is u. Where
    x lies on the axis the circle is a point.
    """
    axis, size = _directions.unit("u", u), _directions.length(x)
    if size > 1e150:
        raise ValueError(f"x must have a length of 0 to 1e150; got {x}. Write for example 1,0,0")
    theta = float(np.deg2rad(angle))
    R = so3.from_axis_angle(axis, theta)
    image = so3.act(R, np.array(x))
    across = np.array(x) - (axis @ np.array(x)) * axis
    shown = parts(axis, np.array(x) / (size or 1.0), theta)
    numbers = {
        "axis": axis,
        "rotation": R,
        "image": image,
        "along": (axis @ np.array(x)) * axis,
        "across": across,
        "cross": np.cross(axis, np.array(x)),
        "radius": float(np.linalg.norm(across)),
    }
    return Drawing(_picture(shown), numbers)


def parts(u: np.ndarray, x: np.ndarray, theta: float) -> _Shown:
    """Return the vectors of (2.14); of an x on the axis, any direction across it serves as v."""
    across = x - (u @ x) * u
    radius = float(np.linalg.norm(across))
    v = across / radius if radius > _ZERO else solids.frame_along(u)[:, 0]
    return _Shown(u, v, np.cross(u, v), theta, x, so3.act(so3.from_axis_angle(u, theta), x))


def camera_for(s: _Shown) -> Camera:
    """From where the circle is an open ellipse, with the part across to the left and a little to the front.

    It depends on u and x alone, so that it rests while the angle changes.
    """
    elevation, azimuth = np.meshgrid(np.deg2rad(np.arange(8, 56, 4)), np.deg2rad(np.arange(0, 360, 6)))
    d = np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1
    ).reshape(-1, 3)
    right = np.cross((0.0, 0.0, 1.0), d)
    # An axis that points down is seen from behind.
    side = -1.0 if s.u[2] < -1e-9 else 1.0
    # Off the axes of space, of which one would be seen end on.
    cost = 8.0 * (side * d @ s.u - _TILT) ** 2 + 2.0 * (d @ s.v - 0.35) ** 2 + right @ s.v
    cost += 8.0 * np.maximum(np.abs(d).max(axis=-1) - 0.88, 0.0)
    best = d[np.argmin(np.round(cost, 9))]
    ball = np.concatenate(
        [parallels(1.0, np.deg2rad(np.arange(-90.0, 91.0, 15.0))), [_AXIS * s.u, -1.16 * s.u]]
    )
    ball = ball[np.isfinite(ball).all(axis=-1)]
    return around(ball, (float(best[0]), float(best[1]), float(best[2])), _SPACE, 1.06)


def _picture(s: _Shown) -> scene.Picture:
    camera = camera_for(s)
    records = _axis(s, camera)
    if s.x.any():
        records += [*globe(camera, alpha=0.6, frame=solids.frame_along(s.u)), *_circle(s)]
        records += _vectors(s)
    records += _names(s, camera)
    small = Camera(camera.direction, (0.0, 0.0, 0.0), 2.9)
    views = (
        scene.View(tuple(records), camera, _SPACE),
        scene.View(tuple(coordinate_axes(small, ("$x$", "$y$", "$z$"), 0.9)), small, _CORNER),
        scene.View(tuple(_equation(s.theta))),
    )
    return scene.Picture(views)


def _equation(theta: float) -> list[scene.Record]:
    degrees = number(np.rad2deg(theta), 1)
    texts = [
        r"$Rx = (u\cdot x)\,u + \cos\theta\;(x - (u\cdot x)\,u) + \sin\theta\;(u\times x)$",
        rf"$\theta = {degrees}^{{\circ}}$",
    ]
    return [
        scene.Label(text, (1160.0, 54.0 + 54.0 * i, 0.0), style.INK, style.SMALL_TEXT, anchor="rn")
        for i, text in enumerate(texts)
    ]


def _axis(s: _Shown, camera: Camera) -> list[scene.Record]:
    tip = _AXIS * s.u
    return [
        scene.Arrow(-1.16 * s.u, tip, style.INK, 0.010, 4.4),
        scene.Points([(0.0, 0.0, 0.0)], style.INK, 7.0),
        beyond(r"$u$", tip, s.u, camera),
    ]


def _circle(s: _Shown) -> list[scene.Record]:
    """The way of x, the plane of the circle, and the angle in its middle."""
    count = max(round(abs(s.theta) / 0.05), 2) + 1
    along = np.linspace(0.0, s.theta, count)
    small = 0.27 * s.radius if s.radius > _ZERO else _TURN
    # Past a full turn the arc opens, so that the turns are seen beside each other.
    opening = small * (1.0 + 0.16 * np.maximum(np.abs(along) / (2.0 * np.pi) - 1.0, 0.0))
    records = curved_arrow(s.around(opening, along), style.ARC_TEXT, 0.007, 3.6)
    if s.radius <= _ZERO:
        return [*records, scene.Points([s.x], style.ARC, 12.0, rim=style.PAPER)]
    rim = s.around(s.radius, np.linspace(0.0, 2.0 * np.pi, 181))
    part = s.around(s.radius, np.clip(along, -2.0 * np.pi, 2.0 * np.pi))
    for edge, alpha in ((rim, 0.07), (part, 0.20)):
        fan = np.concatenate([s.center[None], edge])
        n = np.arange(1, len(edge))
        faces = np.stack([0 * n, n, n + 1], axis=-1)
        records.append(scene.Surface(fan, faces, style.ARC, material="flat", alpha=alpha))
    records.append(scene.Lines(rim, style.ARC, style.EDGE, 0.9))
    # The arrow stops short of the tip of Rx.
    return [*records, *curved_arrow(part, style.ARC, 0.014)]


def _vectors(s: _Shown) -> list[scene.Record]:
    origin, C = np.zeros(3), s.center
    foot = C + s.radius * np.cos(s.theta) * s.v
    records: list[scene.Record] = []
    # Of a vector across the axis the red part would be all, and lie under it.
    if s.leans:
        records.append(scene.Arrow(origin, C, style.AXIS_Z, _SHAFT))
    if s.leans and s.radius > _ZERO:
        records.append(scene.Arrow(C, C + s.radius * s.v, style.AXIS_X, _SHAFT))
    if s.radius > _ZERO:
        records += [
            scene.Arrow(C, C + s.radius * s.w, style.AXIS_Y, _SHAFT),
            scene.Arrow(origin, s.x, style.BEFORE_EDGE, _SHAFT),
            scene.Arrow(origin, s.image, style.ARC, _SHAFT),
            scene.Lines([C, s.image], style.ARC_TEXT, style.EDGE),
            scene.Lines([C, foot, s.image], style.INK, style.EDGE, dash=(7.0, 6.0)),
        ]
    return records


def _names(s: _Shown, camera: Camera) -> list[scene.Record]:
    red, blue, green = style.AXES_TEXT[0], style.AXES_TEXT[2], style.AXES_TEXT[1]
    if not s.x.any():
        return [beyond(r"$x = Rx = 0$", np.zeros(3), camera.axes[0], camera, gap=100.0, room=140.0)]
    if s.radius <= _ZERO:
        name = beyond(r"$x = Rx = (u\cdot x)\,u$", s.x, camera.axes[0], camera, gap=140.0, room=180.0)
        return [name, beyond(r"$\theta$", s.center, -s.w, camera, color=style.ARC_TEXT, gap=90.0, room=180.0)]
    middle = s.around(0.42 * s.radius, np.array([s.theta / 2.0]))[0]
    same = bool(np.allclose(s.x, s.image, atol=1e-9))
    labels = [
        beyond(r"$x = Rx$" if same else "$x$", s.x, s.x, camera, gap=34.0, room=90.0),
        beyond(r"$x - (u\cdot x)\,u$", s.center + 0.56 * s.radius * s.v, s.u, camera, color=red, room=75.0),
        beyond(r"$u\times x$", s.center + s.radius * s.w, s.w, camera, color=green, gap=40.0, room=100.0),
        scene.Label(r"$\theta$", middle, style.ARC_TEXT, style.TEXT, room=60.0),
    ]
    if not same:
        labels.append(beyond(r"$Rx$", s.image, s.image, camera, color=style.ARC_TEXT, gap=34.0, room=60.0))
    if np.linalg.norm(s.center) > _ZERO:
        aside = np.cross(s.u, camera.axes[2])
        labels.append(
            beyond(r"$(u\cdot x)\,u$", 0.5 * s.center, aside, camera, color=blue, gap=68.0, room=140.0)
        )
    return list(labels)
