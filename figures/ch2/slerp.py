"""Figure 2.8 of the book."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import quaternion
from lietool.render import scene, style
from lietool.render.camera import Camera
from lietool.render.globe import globe, joined

Quaternion = tuple[float, float, float, float]


@figure(
    plates={
        "B2.8": Plate(
            title="Slerp and the exponential map",
            equations=("2.31", "2.32", "2.33", "2.34"),
            caption=(
                "The plane Im H of imaginary quaternions touches the unit sphere at 1. The exponential map "
                "lays the straight line from 0 to theta u onto the great arc from q0 to q1: equal steps "
                "on the line become equal arcs on the sphere, which is slerp."
            ),
        )
    },
    time=Time("t", 0.0, 1.0),
)
def slerp(
    q0: Annotated[Quaternion, Param("start (w, x, y, z), brought to length 1")] = (1.0, 0.0, 0.0, 0.0),
    q1: Annotated[Quaternion, Param("end (w, x, y, z), brought to length 1")] = (0.0, 0.36, 0.48, 0.8),
    steps: Annotated[int, Param("equal steps from start to end", low=1, high=60)] = 8,
    t: Annotated[float, Param("the moment that is marked", low=0.0, high=1.0)] = 0.625,
) -> Drawing:
    """Slerp as the exponential map: equal steps on a tangent line become equal arcs on the sphere.

    What to look for: the balls on the straight line and the balls on the arc
    are evenly spaced, each in its own way, and t divides the length of the line
    as it divides the angle theta. The sphere is the slice of the unit
    quaternions that holds the arc; with q0 other than 1 the whole picture is
    carried to q0 by multiplication from the right (2.33).
    """
    start, end = quaternion.normalize(np.array([q0, q1]))
    line = quaternion.log(quaternion.multiply(end, quaternion.conjugate(start)))
    theta = float(np.linalg.norm(line))
    u = line / theta if theta > 1e-12 else np.array([1.0, 0.0, 0.0])
    times = np.linspace(0.0, 1.0, steps + 1)
    # The balls come from the exponential map (2.31), the curve under them from (2.32).
    arc = quaternion.multiply(quaternion.exp(times[:, None] * line), start)
    curve = quaternion.slerp(start, end, np.linspace(0.0, 1.0, 161))
    marked = quaternion.slerp(start, end, t)
    numbers = {
        "theta": theta,
        "axis": u,
        "tangent_points": times[:, None] * line,
        "arc_points": arc,
        "slerp": quaternion.slerp(start, end, times),
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
        curve=piece.of(curve),
        at_one=bool(np.allclose(start, (1.0, 0.0, 0.0, 0.0))),
    )
    return Drawing(_picture(shown), numbers)


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
    """Points in the slice: on the tangent line, on the arc; and whether the slice is the one through 1."""

    theta: float
    t: float
    line: np.ndarray
    arc: np.ndarray
    marked_line: np.ndarray
    marked: np.ndarray
    curve: np.ndarray
    at_one: bool


def _picture(s: _Shown) -> scene.Picture:
    reach = max(1.5, s.theta + 0.32)
    left = -1.25
    height = max(2.7, (reach - left) * 0.86)
    camera = Camera((0.30, -1.0, 0.42), ((reach + left) / 2.0, 0.0, 0.12), height)
    records = [*_plane(reach), *globe(camera), *_sector(s), *_curves(s), *_names(s, camera)]
    return scene.Picture((scene.View(tuple(records), camera), scene.View(tuple(_equations(s.at_one)))))


def _equations(at_one: bool) -> list[scene.Record]:
    moved = "" if at_one else r"\,q_0"
    lines = [
        r"$\exp(\theta u) = \cos\theta + \sin\theta\,u$",
        rf"$\mathrm{{slerp}}(q_0, q_1; t) = \exp(t\theta u){moved}$",
    ]
    return [
        scene.Label(text, (1140.0, 150.0 - 54.0 * i, 0.0), style.INK, style.SMALL_TEXT + 2.0, anchor="rn")
        for i, text in enumerate(lines)
    ]


def _plane(reach: float) -> list[scene.Record]:
    """The part of Im H that lies over the sphere, with its grid."""
    x0, x1, y = -0.75, reach, 0.62
    corners = np.array([[x0, -y, 1.0], [x1, -y, 1.0], [x1, y, 1.0], [x0, y, 1.0]])
    grid = [np.array([[x, -y, 1.0], [x, y, 1.0]]) for x in np.arange(-0.5, x1, 0.25)]
    grid += [np.array([[x0, v, 1.0], [x1, v, 1.0]]) for v in np.arange(-0.5, 0.51, 0.25)]
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.ALGEBRA, material="flat", alpha=0.10),
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
        scene.Surface(fan, faces, style.ARC, material="flat", alpha=0.10),
        scene.Lines(spokes, style.ARC, 2.0, dash=(9.0, 7.0)),
        scene.Lines(np.stack([np.zeros(3), s.marked]), style.ARC_TEXT, 2.2),
        scene.Lines(0.30 * part, style.ARC_TEXT, 2.2),
        scene.Points([(0.0, 0.0, 0.0)], style.INK, 6.0),
    ]
    return records


def _on_line(x: ArrayLike) -> np.ndarray:
    x = np.asarray(x, float)
    return np.stack([x, 0.0 * x, 0.0 * x + 1.0], axis=-1)


def _curves(s: _Shown) -> list[scene.Record]:
    """The straight line above, the arc below, and which point goes where."""
    pairs = joined(np.stack([a, b]) for a, b in zip(s.line[1:], s.arc[1:], strict=True))
    records: list[scene.Record] = [scene.Lines(pairs, style.MUTED, style.THIN, 0.8, dash=(5.0, 6.0))]
    if s.theta > 1e-12:
        tip = _on_line(s.theta + 0.16)
        records += [
            scene.Arrow(_on_line(0.0), tip, style.ALGEBRA, 0.012),
            scene.Tube(1.016 * s.curve, style.ARC, 0.016),
        ]
    return [
        *records,
        scene.Points(s.line, style.ALGEBRA, 8.0),
        scene.Points(1.016 * s.arc, style.ARC, 8.0),
        scene.Lines(np.stack([s.marked_line, s.marked]), style.INK, style.EDGE),
        scene.Points([s.marked_line], style.ALGEBRA, 12.5, rim=style.PAPER),
        scene.Points([1.016 * s.marked], style.ARC, 12.5, rim=style.PAPER),
    ]


def _names(s: _Shown, camera: Camera) -> list[scene.Record]:
    q0 = "" if s.at_one else r"\,q_0"
    start = r"$1 = q_0$" if s.at_one else r"$q_0$"
    middle = 0.40 * s.curve[round(s.t * 80)]
    # Below the spoke: across it, clockwise.
    x, _, z = s.marked
    below = 0.56 * s.marked + 0.13 * np.array([z, 0.0, -x])
    return [
        scene.Label(
            rf"$\mathrm{{Im}}\,\mathrm{{\mathbb{{H}}}}{q0}$",
            (-0.72, -0.62, 1.0),
            style.ALGEBRA_TEXT,
            offset=(-4, -10),
            anchor="lt",
        ),
        scene.Label(start, s.line[0], style.INK, offset=(-10, 22), anchor="rb"),
        scene.Label(rf"$\theta u{q0}$", s.line[-1], style.ALGEBRA_TEXT, offset=(0, 22), anchor="cb"),
        scene.Label(rf"$t\theta u{q0}$", s.marked_line, style.ALGEBRA_TEXT, offset=(0, 24), anchor="cb"),
        scene.Label(rf"$\exp(t\theta u){q0}$", below, style.ARC_TEXT, anchor="lt"),
        scene.Label(r"$q_1$", s.arc[-1], style.INK, offset=(20, -8), anchor="lt"),
        scene.Label(r"$t\theta$", middle, style.ARC_TEXT, style.SMALL_TEXT),
    ]
