"""Figure 2.8 of the book."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import quaternion
from lietool.render import scene, style
from lietool.render.camera import Camera
from lietool.render.globe import globe, joined

from . import _slerp_compare, _slerp_ways

Quaternion = tuple[float, float, float, float]
# Nearer than this to another, in radians of arc, a point goes without a name of its own.
_CLOSE = 0.2
# From a spoke to the middle of the name beside it, in radians.
_ASIDE = 0.36


@figure(
    plates={
        "B2.8": Plate(
            title="Slerp and the exponential map",
            equations=("2.31", "2.32", "2.33", "2.34"),
            caption=(
                "The plane Im H of imaginary quaternions touches the unit sphere at 1. The exponential map "
                "lays the straight line from 0 to theta u onto the great arc from q0 to q1, as a thread is "
                "wound onto a wheel (dashed): equal steps on the line become equal arcs, which is slerp. "
                "The sphere is a slice of S^3."
            ),
        ),
        "B2.8b": Plate(
            title="Slerp, normalised lerp and lerp of Euler angles",
            equations=("2.21", "2.31", "2.32", "2.34"),
            caption=(
                "Three ways between the same two rotations, at equal steps of t; below each row, the angle "
                "turned from one solid to the next, and on the left the whole angle. Slerp turns about one "
                "axis u at constant speed. Normalised lerp (nlerp) takes the same way, fast in the middle. "
                "Angles R_z R_y R_x that change evenly go another, longer way: lower right, the path of the "
                "tip of one axis of the solid."
            ),
            params={
                "view": "compare",
                "q0": (5.0, 1.0, -2.0, 0.0),
                "q1": (2.0, 0.0, 4.0, -2.0),
                "steps": 5,
                "t": 0.4,
            },
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def slerp(
    view: Annotated[Literal["sphere", "compare"], Param("one arc, or three ways to interpolate")] = "sphere",
    q0: Annotated[Quaternion, Param("start (w, x, y, z), brought to length 1")] = (1.0, 0.0, 0.0, 0.0),
    q1: Annotated[Quaternion, Param("end (w, x, y, z), brought to length 1")] = (-0.26, 0.35, 0.46, 0.77),
    steps: Annotated[
        int, Param("equal steps from start to end; compare shows at most 8", low=1, high=60)
    ] = 6,
    t: Annotated[float, Param("the moment that is marked", low=0.0, high=1.0)] = 0.6,
) -> Drawing:
    """Slerp as the exponential map: equal steps on a tangent line become equal arcs on the sphere.

    What to look for: the balls on the straight line and the balls on the arc
    are evenly spaced, each in its own way, and t divides the length of the line
    as it divides the angle theta. The sphere is the slice of the unit
    quaternions that holds the arc; with q0 other than 1 the whole picture is
    carried to q0 by multiplication from the right (2.33).
    """
    start, end = _unit("q0", q0), _unit("q1", q1)
    ways = _slerp_ways.between(start, end)
    return _sphere(ways, steps, t) if view == "sphere" else _compare(ways, steps, t)


def _compare(ways: _slerp_ways.Ways, steps: int, t: float) -> Drawing:
    shown = _slerp_compare.compared(ways, steps, t)
    numbers = {
        "theta": ways.theta,
        "line": ways.line,
        "euler_start": ways.angles,
        "euler_turns": ways.turns,
        "times": shown.times,
        "rotations": shown.rotations,
        "turned": shown.turned,
        "marked": shown.now,
        "from_slerp": shown.aside,
        "instants": shown.instants,
        "speeds": shown.speeds,
        "axis_paths": shown.paths[..., shown.axis],
    }
    return Drawing(_slerp_compare.picture(shown), numbers)


def _sphere(ways: _slerp_ways.Ways, steps: int, t: float) -> Drawing:
    start, line, theta = ways.start, ways.line, ways.theta
    u = line / theta if theta > 1e-12 else np.array([1.0, 0.0, 0.0])
    times = np.linspace(0.0, 1.0, steps + 1)
    # The balls come from the exponential map (2.31), the curve under them from (2.32).
    arc = quaternion.multiply(quaternion.exp(times[:, None] * line), start)
    marked = ways.arc(np.array([t]))[0]
    numbers = {
        "theta": theta,
        "axis": u,
        "tangent_points": times[:, None] * line,
        "arc_points": arc,
        "slerp": ways.arc(times),
        "marked": marked,
    }
    piece = _Slice(start, u)
    shown = _Shown(
        theta=theta,
        t=t,
        line=_on_line(theta * times),
        arc=piece.of(arc),
        marked_line=_on_line(theta * t),
        marked=piece.of(marked),
        curve=piece.of(ways.arc(np.linspace(0.0, 1.0, 161))),
        at_one=bool(np.allclose(start, (1.0, 0.0, 0.0, 0.0))),
        opposite=ways.opposite,
    )
    return Drawing(_picture(shown), numbers)


def _unit(name: str, q: Quaternion) -> np.ndarray:
    try:
        return quaternion.normalize(np.array(q))
    except ValueError:
        raise ValueError(
            f"{name} must have a length of 1e-150 to 1e150; got {q}. "
            "Write a quaternion of ordinary size, such as 1,0,0,0"
        ) from None


class _Slice:
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
class _Shown:
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


def _picture(s: _Shown) -> scene.Picture:
    reach = _reach(s.theta)
    left = -1.25
    height = max(2.7, (reach - left) * 0.86)
    camera = Camera((0.30, -1.0, 0.42), ((reach + left) / 2.0, 0.0, 0.12), height)
    records = [*_plane(reach), *globe(camera), *_sector(s), *_curves(s), *_names(s)]
    return scene.Picture((scene.View(tuple(records), camera), scene.View(tuple(_equations(s)))))


def _equations(s: _Shown) -> list[scene.Record]:
    moved = "" if s.at_one else r"\,q_0"
    lines = [
        r"$\exp(\theta u) = \cos\theta + \sin\theta\,u$",
        rf"$\mathrm{{slerp}}(q_0, q_1; t) = \exp(t\theta u){moved}$",
    ]
    if s.opposite:
        lines[1] = "$q_1 = -q_0$: any $u$ serves, here $i$"
    return [
        scene.Label(text, (1150.0, 130.0 - 58.0 * i, 0.0), style.INK, style.SMALL_TEXT, anchor="rn")
        for i, text in enumerate(lines)
    ]


def _reach(theta: float) -> float:
    """Where the drawn part of the tangent plane ends."""
    return max(1.5, theta + 0.30)


def _plane(reach: float) -> list[scene.Record]:
    """The part of Im H that lies over the sphere, with its grid."""
    x0, x1, y = -0.75, reach, 0.62
    corners = np.array([[x0, -y, 1.0], [x1, -y, 1.0], [x1, y, 1.0], [x0, y, 1.0]])
    grid = [np.array([[x, -y, 1.0], [x, y, 1.0]]) for x in np.arange(-0.5, x1, 0.25)]
    grid += [np.array([[x0, v, 1.0], [x1, v, 1.0]]) for v in np.arange(-0.5, 0.51, 0.25)]
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.ALGEBRA, material="flat", alpha=0.06),
        scene.Lines(joined(grid), style.ALGEBRA, style.HAIR, 0.22),
        scene.Lines(np.concatenate([corners, corners[:1]]), style.ALGEBRA, style.THIN, 0.7),
    ]


def _sector(s: _Shown) -> list[scene.Record]:
    """The angle theta at the centre, and the part t theta of it."""
    fan = np.concatenate([[[0.0, 0.0, 0.0]], s.curve])
    n = np.arange(1, len(s.curve))
    faces = np.stack([0 * n, n, n + 1], axis=-1)
    spokes = joined(np.stack([np.zeros(3), end]) for end in (s.curve[0], s.curve[-1]))
    part = s.curve[: max(round(s.t * (len(s.curve) - 1)) + 1, 2)]
    records: list[scene.Record] = [
        scene.Surface(fan, faces, style.GROUP, material="flat", alpha=0.10),
        scene.Lines(spokes, style.GROUP, style.EDGE, dash=(9.0, 7.0)),
        scene.Lines(np.stack([np.zeros(3), s.marked]), style.GROUP_TEXT, style.EDGE),
        scene.Lines(0.30 * part, style.GROUP_TEXT, style.EDGE),
        scene.Points([(0.0, 0.0, 0.0)], style.INK, 6.0),
    ]
    return records


def _on_line(x: ArrayLike) -> np.ndarray:
    x = np.asarray(x, float)
    return np.stack([x, 0.0 * x, 0.0 * x + 1.0], axis=-1)


def _curves(s: _Shown) -> list[scene.Record]:
    """The straight line above, the arc below, and how the line is laid onto the arc."""
    wraps = [_wrap(x) for x in s.line[1:, 0] if x > 1e-9]
    ends = np.stack([_on_line(-0.75), _on_line(_reach(s.theta))])
    records: list[scene.Record] = [scene.Lines(ends, style.ALGEBRA, style.THIN)]
    if wraps:
        records += [
            scene.Lines(joined(wraps), style.MUTED, style.THIN, 0.8, dash=(5.0, 6.0)),
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


def _names(s: _Shown) -> list[scene.Record]:
    """Names of the ends, and of the marked point where that is not one of them."""
    moved = "" if s.at_one else r"\,q_0"
    plane = rf"$\mathrm{{Im}}\,\mathrm{{\mathbb{{H}}}}{moved}$"
    start = r"$1 = q_0$" if s.at_one else r"$q_0$"
    blue, dark = style.ALGEBRA_TEXT, style.GROUP_TEXT
    names: list[scene.Record] = [
        scene.Label(plane, (-0.75, 0.62, 1.0), blue, offset=(4.0, 12.0), anchor="lb"),
        scene.Label(start, s.line[0], style.INK, offset=(-14.0, 14.0), anchor="rb"),
    ]
    at, rest = s.t * s.theta, (1.0 - s.t) * s.theta
    if s.theta > _CLOSE:
        names.append(scene.Label(r"$q_1$", s.arc[-1], style.INK, offset=(20.0, -8.0), anchor="lt"))
    if rest > _CLOSE:
        names.append(scene.Label(rf"$\theta u{moved}$", s.line[-1], blue, offset=(0.0, 22.0), anchor="cb"))
    if at > _CLOSE:
        names += [
            scene.Label(rf"$t\theta u{moved}$", s.marked_line, blue, offset=(0.0, 24.0), anchor="cb"),
            scene.Label(rf"$\exp(t\theta u){moved}$", _beside_spoke(at), dark),
            scene.Label(r"$t\theta$", 0.41 * _on_circle(at / 2.0), dark, style.SMALL_TEXT),
        ]
    return names


def _on_circle(angle: float) -> np.ndarray:
    return np.array([np.sin(angle), 0.0, np.cos(angle)])


def _beside_spoke(angle: float) -> np.ndarray:
    """Where the name of the marked point lies: in the sector, or beyond it as long as that is too narrow."""
    return 0.74 * _on_circle(angle + (_ASIDE if angle < 0.9 else -_ASIDE))
