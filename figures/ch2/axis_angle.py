"""Figure 2.5 of the book."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import so3
from lietool.render import scene, solids, style
from lietool.render.camera import Box, Camera, around
from lietool.render.globe import globe, parallels
from lietool.render.marks import beyond, coordinate_axes, curved_arrow
from lietool.render.plot import number

from . import _directions

Vector = tuple[float, float, float]
_SPACE: Box = (60.0, 104.0, 1080.0, 716.0)
_CORNER: Box = (30.0, 92.0, 190.0, 190.0)
_TITLE, _LEGEND = 846.0, 52.0
# The plane of the circle is seen best when the line of sight meets it at about this sine.
_TILT = 0.45
# A part of x that is shorter than this, as a fraction of x, is not there.
_ZERO = 1e-9
_ROTATION = Library("lietool.lie.so3.from_axis_angle")
# The last is about the length of the name of a dashed part.
_SHAFT, _AXIS, _TURN, _SEEN, _LONG = 0.017, 1.16, 0.14, 0.25, 0.45
_X, _U, _ALONG = r"\mathbf{x}", r"\mathbf{u}", r"(\mathbf{u}\cdot\mathbf{x})\,\mathbf{u}"
_ACROSS, _CROSS = r"\mathbf{x}_{\!\perp}", r"\mathbf{u}\times\mathbf{x}"


@dataclass(frozen=True, eq=False)
class _Shown:
    """The vectors of (2.14), the way (n, 3) to Rx, and v, w = u x v, unit vectors in the circle's plane."""

    u: np.ndarray
    v: np.ndarray
    w: np.ndarray
    theta: float
    x: np.ndarray
    image: np.ndarray
    way: np.ndarray

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
                "The rotation by theta about the unit vector u carries the unit vector x along a circle to "
                "Rx. Its part (u.x)u along the axis stays. The part across it, x - (u.x)u, and u x x, as "
                "long and at right angles to both, span the plane of the circle. There the other way to Rx "
                "(dashed) goes by the cosine of theta along the one and by the sine along the other."
            ),
        )
    },
    time=Time("angle", 0.0, 360.0, closed=True),
)
def axis_angle(
    u: Annotated[Vector, Param("axis (x, y, z), brought to length 1")] = (0.1, 0.35, 0.95),
    x: Annotated[Vector, Param("the vector that is turned (x, y, z), brought to length 1 unless 0")] = (
        0.9,
        -0.4,
        0.6,
    ),
    angle: Annotated[float, Param("angle of the rotation", "deg", -720.0, 720.0)] = 112.0,
    *,
    rotation: Library = _ROTATION,
) -> Drawing:
    """Axis and angle: the rotation about u carries x along a circle, by Rodrigues' formula.

    What to look for: blue is the part of x along the axis, which does not move;
    red is the part across it, and green is u x x, a quarter turn further on.
    The dashed way to Rx is cos(theta) times red, then sin(theta) times green.
    The circle is a parallel of the unit sphere whose pole is u. Where x lies on
    the axis the circle is a point.
    """
    axis = _directions.unit("u", u)
    turned = _directions.unit("x", x) if any(x) else np.zeros(3)
    theta = float(np.deg2rad(angle))
    shown = parts(axis, turned, theta, rotation)
    across = turned - shown.center
    numbers = {
        "axis": axis,
        "vector": turned,
        "rotation": rotation(axis, theta),
        "image": shown.image,
        "along": shown.center,
        "across": across,
        "cross": np.cross(axis, turned),
        "radius": shown.radius,
    }
    return Drawing(_picture(shown), numbers)


def parts(
    u: np.ndarray, x: np.ndarray, theta: float, rotation: Callable[..., np.ndarray] = _ROTATION
) -> _Shown:
    """Return the vectors of (2.14); of an x on the axis, any direction across it serves as v."""
    across = x - (u @ x) * u
    radius = float(np.linalg.norm(across))
    v = across / radius if radius > _ZERO else solids.frame_along(u)[:, 0]
    # One at a time, so that a function that takes no batches is shown too.
    way = [so3.act(rotation(u, float(angle)), x) for angle in _along(_first_turn(theta))]
    return _Shown(u, v, np.cross(u, v), theta, x, so3.act(rotation(u, theta), x), np.stack(way))


def camera_for(s: _Shown) -> Camera:
    """From where the circle is an open ellipse, with the part across to the right and a little to the front.

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
    cost = 8.0 * (side * d @ s.u - _TILT) ** 2 + 2.0 * (d @ s.v - 0.2) ** 2 - right @ s.v
    cost += 8.0 * np.maximum(np.abs(d).max(axis=-1) - 0.88, 0.0)
    best = d[np.argmin(np.round(cost, 9))]
    ball = np.concatenate(
        [parallels(1.0, np.deg2rad(np.arange(-90.0, 91.0, 15.0))), [_AXIS * s.u, -1.16 * s.u]]
    )
    ball = ball[np.isfinite(ball).all(axis=-1)]
    return around(ball, (float(best[0]), float(best[1]), float(best[2])), _SPACE, 1.06)


def _picture(s: _Shown) -> scene.Picture:
    camera = camera_for(s)
    glass = [*globe(camera, alpha=0.6, frame=graticule(s, camera)), *_disc(s)] if s.x.any() else []
    small = Camera(camera.direction, (0.0, 0.0, 0.0), 2.9)
    views = (
        scene.View(tuple(glass), camera, _SPACE),
        # Over the glass, so that it does not tint them.
        scene.View((*_axis(s), *_circle(s, camera), *_vectors(s), *_names(s, camera)), camera, _SPACE),
        scene.View(tuple(coordinate_axes(small, ("$x$", "$y$", "$z$"), 0.9)), small, _CORNER),
        scene.View(tuple(_texts(s.theta))),
    )
    return scene.Picture(views)


def graticule(s: _Shown, camera: Camera) -> np.ndarray:
    """Return a frame with the pole u; two meridians run behind the axis, so that none runs beside it."""
    back = np.cross(camera.eye, s.u)
    side = back / np.linalg.norm(back)
    return np.stack([np.cross(side, s.u), side, s.u], axis=-1)


def _texts(theta: float) -> list[scene.Record]:
    degrees = number(np.rad2deg(theta), 1)
    title = rf"rotation about ${_U}$ by $\theta = {degrees}^{{\circ}}$"
    sides = rf"R{_X} = {_ALONG} + \cos\theta\;{_ACROSS} + \sin\theta\;({_CROSS})"
    where = rf"{_ACROSS} = {_X} - {_ALONG}"
    legend = rf"${sides}$,   ${where}$"
    return [
        scene.Label(title, (600.0, _TITLE, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label(legend, (600.0, _LEGEND, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
    ]


def _axis(s: _Shown) -> list[scene.Record]:
    """The unit vector u, and the axis along it."""
    return [
        scene.Lines([-_AXIS * s.u, _AXIS * s.u], style.INK, style.THIN),
        scene.Arrow((0.0, 0.0, 0.0), s.u, style.INK, 0.011, 4.0),
        scene.Points([(0.0, 0.0, 0.0)], style.INK, 7.0),
    ]


def _disc(s: _Shown) -> list[scene.Record]:
    """The plane of the circle, and the part of it that the angle takes."""
    if s.radius <= _ZERO:
        return []
    rim = s.around(s.radius, np.linspace(0.0, 2.0 * np.pi, 181))
    part = s.around(s.radius, _along(_first_turn(s.theta)))
    records: list[scene.Record] = []
    for edge, alpha in ((rim, 0.04), (part, 0.12)):
        fan = np.concatenate([s.center[None], edge])
        records.append(
            scene.Surface(fan, solids.fan_faces(len(fan)), style.ARC, material="flat", alpha=alpha)
        )
    return [*records, scene.Lines(rim, style.ARC, style.EDGE, 0.9)]


def _first_turn(theta: float) -> float:
    return min(max(theta, -2.0 * np.pi), 2.0 * np.pi)


def _along(theta: float) -> np.ndarray:
    return np.linspace(0.0, theta, max(round(abs(theta) / 0.05), 2) + 1)


def _circle(s: _Shown, camera: Camera) -> list[scene.Record]:
    """The way of x, and the angle in its middle."""
    along = _along(s.theta)
    small = 0.30 * s.radius if s.radius > _ZERO else _TURN
    # Past a full turn the arc opens, so that the turns are seen beside each other.
    opening = small * (1.0 + 0.16 * np.maximum(np.abs(along) / (2.0 * np.pi) - 1.0, 0.0))
    # Nearer to the viewer than the arrows that it crosses.
    lifted = s.around(opening, along) + 2.0 * _SHAFT * np.sign(camera.axes[2] @ s.u) * s.u
    records = curved_arrow(lifted, style.ARC_TEXT, 0.010, 4.2)
    if s.radius <= _ZERO:
        return [*records, scene.Points([s.x], style.ARC, 12.0, rim=style.PAPER)]
    return [*records, *curved_arrow(s.way, style.ARC, 0.014)]


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
            scene.Lines([C, foot], style.AXES_TEXT[0], style.CURVE, dash=(9.0, 6.0)),
            # Where the dashes lie inside of the red part, the dot shows how far they go.
            scene.Points([foot], style.AXES_TEXT[0], 6.0),
            scene.Lines([foot, s.image], style.AXES_TEXT[1], style.CURVE, dash=(9.0, 6.0)),
        ]
    return records


def _names(s: _Shown, camera: Camera) -> list[scene.Record]:
    red, green, blue = style.AXES_TEXT
    axis = beyond(f"${_U}$", s.u, np.cross(s.u, camera.axes[2]), camera, room=50.0)
    if not s.x.any():
        name = beyond(rf"${_X} = R{_X} = 0$", np.zeros(3), camera.axes[0], camera, gap=100.0, room=140.0)
        return [axis, name]
    right = camera.axes[0]
    if s.radius <= _ZERO:
        name = beyond(rf"${_X} = R{_X} = {_ALONG}$", s.x, -right, camera, gap=140.0, room=180.0)
        theta = beyond(r"$\theta$", s.center, -s.w, camera, color=style.ARC_TEXT, gap=60.0, room=90.0)
        return [axis, name, theta]
    C, foot = s.center, s.center + s.radius * np.cos(s.theta) * s.v
    up = np.sign(camera.axes[1] @ s.u) * s.u
    middle = s.around(0.42 * s.radius, np.array([s.theta / 2.0]))[0]
    same = bool(np.allclose(s.x, s.image, atol=1e-9))
    name = _X + ("" if s.leans else f" = {_ACROSS}") + (f" = R{_X}" if same else "")
    labels = [
        axis,
        beyond(f"${name}$", s.x, s.x, camera, gap=30.0, room=60.0),
        beyond(f"${_CROSS}$", C + s.radius * s.w, s.w, camera, color=green, gap=34.0, room=70.0),
    ]
    if s.theta:
        labels.append(scene.Label(r"$\theta$", middle, style.ARC_TEXT, style.TEXT, room=40.0))
    if s.leans:
        labels.append(beyond(f"${_ACROSS}$", C + 0.6 * s.radius * s.v, up, camera, color=red, room=50.0))
        labels.append(_beside(f"${_ALONG}$", 0.62 * C, right, camera, blue, style.TEXT, 34.0))
    if not same:
        labels.append(beyond(f"$R{_X}$", s.image, s.image, camera, color=style.ARC_TEXT, gap=32.0, room=60.0))
    return [*labels, *_route_names(s, foot, camera, up)]


def _route_names(s: _Shown, foot: np.ndarray, camera: Camera, up: np.ndarray) -> list[scene.Record]:
    """The names of the two dashed parts; one that is too short to be seen has none."""
    red, green, _ = style.AXES_TEXT
    along, across = s.radius * np.cos(s.theta), s.radius * np.sin(s.theta)
    labels: list[scene.Record] = []
    # At a full turn it would be the red part itself.
    if abs(along) > _SEEN and (along < 0.0 or abs(across) > _SEEN):
        text = rf"$\cos\theta\;{_ACROSS}$"
        if along < 0.0:
            # At its end, away from the arrow of Rx and from the other part.
            to_the_right = camera.axes[0] @ s.v >= 0.0
            above = camera.axes[1] @ (s.image - foot) < 0.0
            offset = (24.0 if to_the_right else -24.0, 14.0 if above else -14.0)
            anchor = ("r" if to_the_right else "l") + ("b" if above else "t")
            labels.append(scene.Label(text, foot, red, style.SMALL_TEXT, offset, anchor))
        else:
            middle = (s.center + foot) / 2.0
            labels.append(beyond(text, middle, -up, camera, color=red, size=style.SMALL_TEXT, room=50.0))
    if abs(across) > _SEEN:
        text, middle = rf"$\sin\theta\;{_CROSS}$", (foot + s.image) / 2.0
        out = -s.v if along < _SEEN else s.v
        # Inside of the circle nothing is in its way.
        inside = np.linalg.norm(middle + _LONG * out - s.center) < s.radius
        room = 0.0 if inside else 60.0
        labels.append(_beside(text, middle, out, camera, green, style.SMALL_TEXT, room))
    return labels


def _beside(
    text: str,
    at: np.ndarray,
    direction: np.ndarray,
    camera: Camera,
    color: str,
    size: float,
    room: float,
) -> scene.Label:
    """A long name to the left or to the right of a point, whichever a direction is seen to point to."""
    to_the_right = camera.axes[0] @ direction >= 0.0
    offset, anchor = (18.0, "lc") if to_the_right else (-18.0, "rc")
    return scene.Label(text, at, color, size, (offset, 0.0), anchor, room=room)
