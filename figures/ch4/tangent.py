"""Figure 4.1 of the book."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render import camera as cameras
from lietool.render import marks, scene, style
from lietool.render.globe import joined

from . import _tangent_groups as groups

# What is drawn of the curves, in t.
_FROM, _TO = -0.25, 1.5
_BOX = (20.0, 150.0, 1160.0, 688.0)
_DIRECTION = (0.30, -1.0, 0.50)


@figure(
    plates={
        "B4.1": Plate(
            title="The Lie algebra as a tangent space",
            equations=("4.8", "4.14", "4.17"),
            caption=(
                "The diagonal matrices of determinant 1 with positive entries are a group, and a curved "
                "surface. Its tangent plane at I is its Lie algebra, the matrices of trace 0. The curve "
                "gamma (dashed) lies in the group and passes I with the velocity X. The straight line tX "
                "leaves the group; exp (thin arrow) lays it onto the group, as the subgroup exp(tX)."
            ),
        )
    },
    time=Time("t", 0.0, 1.5),
)
def tangent(
    group: Annotated[
        Literal["diagonal", "quaternion"],
        Param("diagonal matrices of determinant 1, or a slice of the unit quaternions"),
    ] = "diagonal",
    direction: Annotated[float, Param("where X points in the tangent plane", "deg", -360.0, 360.0)] = -20.0,
    speed: Annotated[float, Param("length of X", low=0.0, high=1.2)] = 1.0,
    bend: Annotated[float, Param("how much the curve bends away from exp(tX)", low=-1.0, high=1.0)] = -0.8,
    t: Annotated[float, Param("the moment that is marked", low=0.0, high=1.5)] = 1.4,
) -> Drawing:
    """A group as a curved surface, its Lie algebra as the plane that touches it at the identity.

    What to look for: the dashed curve and the bold one leave I in the same
    direction, X, and only there they agree; X depends on the velocity alone.
    The thin arrow shows how exp winds the straight line onto the surface.
    The surface is no schematic: the three coordinates of a point are the entries
    of a matrix, turned so that I is at the top; for the quaternions, three of four.
    """
    chart = groups.Chart(groups.GROUPS[group]())
    angle = np.deg2rad(direction)
    X = speed * np.array([np.cos(angle), np.sin(angle)])
    curve = _Curve(X, 0.5 * bend * np.array([-X[1], X[0]]))
    times = np.linspace(_FROM, _TO, 106)
    numbers = {
        "X": chart.vector(X),
        "velocity": chart.velocity(curve.log),
        "tX": chart.vector(t * X),
        "exp_tX": chart.group.exp(chart.vector(t * X)),
        "curve_at_t": chart.group.exp(chart.vector(curve.log(t))),
        "subgroup": chart.group.exp(chart.vector(times[::15, None] * X)),
        "curve": chart.group.exp(chart.vector(curve.log(times[::15, None]))),
    }
    return Drawing(_picture(chart, curve, t), numbers)


@dataclass(frozen=True, eq=False)
class _Curve:
    """The curve exp(tX + t^2 Y) of the group, by its logarithm in the coordinates of the algebra."""

    X: np.ndarray
    Y: np.ndarray

    def log(self, t: ArrayLike) -> np.ndarray:
        t = np.asarray(t, float)
        return t * self.X + t * t * self.Y


def _picture(chart: groups.Chart, curve: _Curve, t: float) -> scene.Picture:
    times = np.linspace(_FROM, _TO, 106)[:, None]
    line, subgroup = chart.level(times * curve.X), chart.exp(times * curve.X)
    gamma = chart.exp(curve.log(times))
    low = -min(subgroup[:, 2].min(), gamma[:, 2].min())
    depth = float(np.clip(1.12 * low, chart.group.least, chart.group.deepest))
    dome = chart.dome(depth)
    # A whole number of the grid's squares to each side of the identity.
    half = max(1.0, np.ceil(2.0 * float(np.abs(line).max()) + 0.1) / 2.0)
    seen = np.concatenate([dome.points.reshape(-1, 3), half * _SQUARE])
    camera = cameras.around(seen, _DIRECTION, _BOX, 1.03)
    records: list[scene.Record] = [
        *_surface(dome, camera),
        *_curves(chart, curve, t, 0.0075 * camera.height),
    ]
    # The eye is above the plane, the group below it: they are laid over each other in this order.
    above: list[scene.Record] = [
        *_flat(chart, curve, t, 0.0075 * camera.height),
        *_names(chart, curve, t, half, camera),
        _named(dome, camera),
    ]
    views = (scene.View(tuple(layer), camera, _BOX) for layer in (records, _plane(half), above))
    return scene.Picture((*views, scene.View(tuple(_formulas(chart)))))


def _surface(dome: groups.Dome, camera: cameras.Camera) -> list[scene.Record]:
    outline, seen, hidden = dome.contours(camera.eye, 0.02 * camera.height)
    return [
        scene.Surface(
            dome.points.reshape(-1, 3), dome.faces, style.SHELL_FILLS[1], dome.normals.reshape(-1, 3), "glass"
        ),
        scene.Lines(dome.graticule, style.GROUP_TEXT, style.HAIR, 0.7 * style.GRATICULE_ALPHA),
        scene.Lines(hidden, style.GROUP_TEXT, style.HAIR, 0.3),
        scene.Lines(joined([seen, outline]), style.GROUP_TEXT, style.EDGE),
    ]


def _formulas(chart: groups.Chart) -> list[scene.Record]:
    """What the group and the algebra are, one under the other at their signs of equality."""
    texts = ((chart.group.name, style.GROUP_TEXT), (chart.group.algebra, style.ALGEBRA_TEXT))
    records: list[scene.Record] = []
    for i, (text, color) in enumerate(texts):
        y = 116.0 - 54.0 * i
        name, said = text.strip("$").split(" = ", 1)
        records.append(scene.Label(f"${name}$", (86.0, y, 0.0), color, style.SMALL_TEXT, anchor="rn"))
        records.append(scene.Label("$=$", (104.0, y, 0.0), color, style.SMALL_TEXT, anchor="cn"))
        records.append(scene.Label(f"${said}$", (124.0, y, 0.0), color, style.SMALL_TEXT, anchor="ln"))
    return records


def _named(dome: groups.Dome, camera: cameras.Camera) -> scene.Label:
    """The group's name, on the surface, far out on the ray that goes farthest to the left of the page."""
    leftmost = int(np.argmin(cameras.project(camera, _BOX, dome.rim)[:, 0]))
    at = dome.points[round(0.86 * (len(dome.points) - 1)), leftmost]
    return scene.Label(
        "$G$", at, style.GROUP_TEXT, style.TITLE_TEXT, offset=(12.0, 0.0), anchor="lc", room=60.0
    )


_SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])


def _plane(half: float) -> list[scene.Record]:
    """A square of the tangent plane with its grid, two lines to a unit."""
    steps = np.arange(-half, half + 0.25, 0.5)[1:-1]
    grid = [np.array([[x, -half, 0.0], [x, half, 0.0]]) for x in steps]
    grid += [line[:, [1, 0, 2]] for line in grid]
    corners = half * _SQUARE
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat", alpha=0.3),
        scene.Lines(joined(grid), style.ALGEBRA, style.HAIR, 0.35),
        scene.Lines(np.concatenate([corners, corners[:1]]), style.ALGEBRA, style.EDGE),
    ]


def _curves(chart: groups.Chart, curve: _Curve, t: float, radius: float) -> list[scene.Record]:
    times = np.linspace(_FROM, _TO, 106)[:, None]
    return [
        scene.Tube(chart.raised(times * curve.X, 0.8 * radius), style.GROUP, radius),
        scene.Lines(chart.exp(curve.log(times)), style.ROUTE_1, style.CURVE, dash=(11.0, 7.0), lift=0.01),
        *_wound(chart, t * curve.X, radius),
        scene.Points([chart.exp(t * curve.X)], style.GROUP, 12.5, rim=style.PAPER),
        scene.Points([chart.exp(curve.log(t))], style.ROUTE_1, 12.5, rim=style.PAPER),
    ]


def _flat(chart: groups.Chart, curve: _Curve, t: float, radius: float) -> list[scene.Record]:
    """What lies in the tangent plane: the straight line, its point, the vector."""
    return [
        scene.Lines(chart.level(np.array([[_FROM], [_TO]]) * curve.X), style.ALGEBRA, style.EDGE),
        scene.Arrow(np.zeros(3), chart.level(curve.X), style.ALGEBRA, 1.2 * radius),
        scene.Points([np.zeros(3)], style.INK, 9.0),
        scene.Points([chart.level(t * curve.X)], style.ALGEBRA, 12.5, rim=style.PAPER),
    ]


def _wound(chart: groups.Chart, x: np.ndarray, radius: float) -> list[scene.Record]:
    """How the end of the straight line goes while exp winds it onto the group: an arrow."""
    way = chart.unrolled(x)
    way[:, 2] += 1.5 * radius
    # It leaves room for the balls at both ends.
    away = np.minimum(np.linalg.norm(way - way[0], axis=-1), np.linalg.norm(way - way[-1], axis=-1))
    return marks.curved_arrow(way[away > 3.0 * radius], style.INK, 0.35 * radius, 5.0)


def _names(
    chart: groups.Chart, curve: _Curve, t: float, half: float, camera: cameras.Camera
) -> list[scene.Record]:
    """Every name beside what it names: those of the line above it, those of the curves apart."""
    blue = style.ALGEBRA_TEXT
    corner = half * _SQUARE[3]
    names: list[scene.Record] = [
        scene.Label(r"$\mathfrak{g} = T_I G$", corner, blue, offset=(0.0, 14.0), anchor="lb"),
        scene.Label("$I$", np.zeros(3), style.INK, offset=(-14.0, 16.0), anchor="rb", room=40.0),
    ]
    if not curve.X.any():
        names.append(scene.Label("$X = 0$", np.zeros(3), blue, offset=(20.0, 16.0), anchor="lb"))
        return names
    # While the marked point is on the arrow, the arrow's name stands at its tip.
    at = 0.5 if t > 0.85 else 1.0
    names.append(
        scene.Label(
            r"$X = \gamma'(0)$", chart.level(at * curve.X), blue, offset=(10.0, 18.0), anchor="lb", room=60.0
        )
    )
    if t * float(np.linalg.norm(curve.X)) < 0.25:
        return names
    way = chart.unrolled(t * curve.X)
    if np.linalg.norm(way[0] - way[-1]) > 0.12 * camera.height:
        early = way[len(way) // 3]
        names.append(
            scene.Label(r"$\exp$", early, style.INK, style.SMALL_TEXT, (22.0, 16.0), "lb", room=45.0)
        )
    names.append(
        scene.Label("$tX$", chart.level(t * curve.X), blue, offset=(8.0, 20.0), anchor="lb", room=40.0)
    )
    points = [chart.exp(t * curve.X), chart.exp(curve.log(t))]
    seen = cameras.project(camera, _BOX, np.array(points))[:, :2]
    apart = seen[0] - seen[1]
    distance = float(np.linalg.norm(apart))
    if distance < 26.0:
        both = r"$\exp(tX) = \gamma(t)$" if distance < 1.0 else r"$\exp(tX)$"
        names.append(
            scene.Label(both, points[0], style.GROUP_TEXT, offset=(24.0, 0.0), anchor="lc", room=60.0)
        )
        return names
    texts = ((r"$\exp(tX)$", style.GROUP_TEXT, 1.0), (r"$\gamma(t)$", style.ROUTE_1_TEXT, -1.0))
    for point, (text, color, side) in zip(points, texts, strict=True):
        to = side * apart / distance
        names.append(_beyond(text, point, to, color))
    return names


def _beyond(text: str, at: np.ndarray, toward: np.ndarray, color: str) -> scene.Label:
    """A name beyond a point, its nearest edge or corner towards it."""
    across = "c" if abs(toward[0]) < 0.4 else "l" if toward[0] > 0.0 else "r"
    upright = "c" if abs(toward[1]) < 0.4 else "b" if toward[1] > 0.0 else "t"
    offset = (22.0 * float(toward[0]), 22.0 * float(toward[1]))
    return scene.Label(text, at, color, style.TEXT, offset, across + upright, room=60.0)
