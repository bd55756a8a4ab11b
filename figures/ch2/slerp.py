"""Figure 2.8 of the book."""

from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import quaternion

from . import _slerp_compare, _slerp_sphere, _slerp_ways

Quaternion = tuple[float, float, float, float]
_SLERP = Library("lietool.lie.quaternion.slerp")


@figure(
    plates={
        "B2.8": Plate(
            title="Slerp and the exponential map",
            equations=("2.31", "2.32", "2.33", "2.34"),
            caption=(
                "The sphere is a slice of S^3. Its tangent space at 1 is a copy of Im H, of which a plane is "
                "drawn. The exponential map lays the straight line from 0 to theta u onto the great arc from "
                "q0 to q1, as a thread is wound onto a wheel (thin grey lines): equal steps on the line "
                "become equal arcs, which is slerp. The angle theta between the quaternions is half of the "
                "angle between their rotations."
            ),
        ),
        "B2.8b": Plate(
            title="Slerp, normalised lerp and lerp of Euler angles",
            equations=("2.21", "2.31", "2.32", "2.34"),
            caption=(
                "Three ways between the same two rotations, at equal steps of t; below each row, the angle "
                "turned from one solid to the next, and on the left the whole angle. Slerp turns about one "
                "axis u at constant speed. Normalised lerp (nlerp) takes the same way, fast in the middle. "
                "Angles R_z R_y R_x that change evenly go another way. On the right, the path of the tip of "
                "one axis of the solid, from t = 0 to t = 1; the large balls are at the moment of the "
                "hairline."
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
    *,
    interpolate: Library = _SLERP,
) -> Drawing:
    """Slerp as the exponential map: equal steps on a tangent line become equal arcs on the sphere.

    What to look for: the balls on the straight line and the balls on the arc
    are evenly spaced, each in its own way, and t divides the length of the line
    as it divides the angle theta. The sphere is the slice of the unit
    quaternions that holds the arc; with q0 other than 1 the whole picture is
    carried to q0 by multiplication from the right (2.33).
    """
    start, end = _unit("q0", q0), _unit("q1", q1)
    ways = _slerp_ways.between(start, end, interpolate)
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
    piece = _slerp_sphere.Slice(start, u)
    shown = _slerp_sphere.Shown(
        theta=theta,
        t=t,
        line=_slerp_sphere.on_line(theta * times),
        arc=piece.of(arc),
        marked_line=_slerp_sphere.on_line(theta * t),
        marked=piece.of(marked),
        curve=piece.of(ways.arc(np.linspace(0.0, 1.0, 161))),
        at_one=bool(np.allclose(start, (1.0, 0.0, 0.0, 0.0))),
        opposite=ways.opposite,
    )
    return Drawing(_slerp_sphere.picture(shown), numbers)


def _unit(name: str, q: Quaternion) -> np.ndarray:
    try:
        return quaternion.normalize(np.array(q))
    except ValueError:
        raise ValueError(
            f"{name} must have a length of 1e-150 to 1e150; got {q}. "
            "Write a quaternion of ordinary size, such as 1,0,0,0"
        ) from None
