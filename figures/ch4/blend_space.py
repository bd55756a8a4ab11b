"""Figures 4.3 and 4.4 of the book."""

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render import scene, style
from lietool.render.globe import joined
from lietool.render.plot import Axes

from . import _blend_circle as circle
from . import _blend_cone as cone

Symmetric = tuple[float, float, float]
_START, _END = (0.6, 0.2, 2.6), (2.4, 0.9, 0.8)
# On the page: both plates have one cone; then the circles, the plots, and the flat spaces.
_CONE = (24.0, 390.0, 640.0, 440.0)
_CIRCLE_ALONE, _CIRCLE = (677.0, 324.0, 506.0, 506.0), (690.0, 376.0, 480.0, 446.0)
_PLOTS = ((124.0, 84.0, 440.0, 180.0), (710.0, 84.0, 440.0, 180.0))
_LEFT, _RIGHT = 344.0, 930.0


@figure(
    plates={
        "B4.3": Plate(
            title="A blend stays in a convex set and leaves a curved one",
            equations=("4.19",),
            caption=(
                "Left: the symmetric matrices of the plane, the positive definite ones inside the cone "
                "det = 0. The blend of two is the segment between them, and all of it is positive "
                "definite (ellipses: the unit disc under the matrix); it leaves the cone only beyond the "
                "ends (crosses). Right: the rotations are a circle. The chord leaves it at once (red): the "
                "blend of two rotations is none, and shrinks (glyph). Below: the determinants."
            ),
        ),
        "B4.4": Plate(
            title="Interpolation by linearisation",
            equations=("4.4", "4.19"),
            caption=(
                "The logarithm carries the ends to a flat space, the straight line there has equal steps, "
                "and exp carries it back as a curve in the curved space. Left: from the cone of positive "
                "definite matrices to sym(2), which has three dimensions (grey: the shadow of the line); the "
                "curve never leaves the cone. Right: from the circle of rotations to the line of angles "
                "so(2); the glyph keeps its size. Dashed: the chord."
            ),
            params={"view": "linearise"},
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def blend_space(
    view: Annotated[
        Literal["convex", "linearise"], Param("blend where the things are, or by their logarithms")
    ] = "convex",
    start: Annotated[
        Symmetric, Param("positive definite matrix at t = 0 (xx, xy, yy)", low=-10, high=10)
    ] = _START,
    end: Annotated[
        Symmetric, Param("positive definite matrix at t = 1 (xx, xy, yy)", low=-10, high=10)
    ] = _END,
    angle0: Annotated[float, Param("angle of the rotation at t = 0", "deg", -360.0, 360.0)] = -70.0,
    angle1: Annotated[float, Param("angle of the rotation at t = 1", "deg", -360.0, 360.0)] = 50.0,
    steps: Annotated[int, Param("equal steps from one end to the other", low=1, high=24)] = 4,
    beyond: Annotated[float, Param("how far the ways go on before 0 and after 1", low=0.0, high=1.0)] = 0.4,
    t: Annotated[float, Param("the moment that is marked", low=0.0, high=1.0)] = 0.38,
) -> Drawing:
    """Where one may blend: a convex set holds its segments, a curved one does not; logarithms make it flat.

    What to look for: the same weights on both sides. In the cone the straight line
    is safe from t = 0 to 1, and fails beyond; on the circle it fails at once, and for
    opposite rotations it passes through 0. With --view linearise both ways run
    through logarithms: the points are equally spaced on the straight line below,
    and the curves above stay where they belong for every t. An angle is one logarithm of
    its rotation among many: 0 and 360 are one rotation, and a whole turn apart.
    """
    stretches = cone.Stretches(_definite("start", start), _definite("end", end))
    turns = circle.Turns(*np.deg2rad([angle0, angle1]))
    times = np.linspace(0.0, 1.0, steps + 1)
    numbers = {
        "stretch_blends": stretches.linear(times),
        "stretch_curve": stretches.curved(times),
        "stretch_logs": stretches.logs(times),
        "turn_blends": turns.linear(times),
        "turn_curve": turns.curved(times),
        "angles": turns.angles(times),
        "det_stretch": np.linalg.det(stretches.linear(times)),
        "det_turn": np.linalg.det(turns.linear(times)),
        "marked_stretch": (stretches.curved if view == "linearise" else stretches.linear)(np.array(t)),
        "marked_turn": (turns.curved if view == "linearise" else turns.linear)(np.array(t)),
    }
    draw = _linearise if view == "linearise" else _convex
    return Drawing(draw(stretches, turns, times, t, beyond), numbers)


def _definite(name: str, entries: Symmetric) -> np.ndarray:
    xx, xy, yy = entries
    S = np.array([[xx, xy], [xy, yy]])
    smallest = float(np.linalg.eigvalsh(S)[0])
    # With less, relative to the larger, the logarithm is rounding.
    if smallest <= 1e-12 * float(np.abs(S).max()):
        raise ValueError(
            f"{name} must be positive definite; got smallest eigenvalue {smallest:.3g}. "
            "Give xx, xy, yy with xx > 0 and xx yy > xy^2"
        )
    return S


def _convex(
    stretches: cone.Stretches, turns: circle.Turns, times: np.ndarray, t: float, beyond: float
) -> scene.Picture:
    spans = cone.shown(stretches, beyond), np.linspace(-beyond, 1.0 + beyond, 241)
    ways = stretches.linear, turns.linear
    highs = [1.1 * max(1.0, float(np.linalg.det(way(s)).max())) for way, s in zip(ways, spans, strict=True)]
    if max(highs) < 3.0 * min(highs):
        highs = [max(highs)] * 2
    xlim = (-beyond, 1.0 + beyond)
    left, right = (Axes(box, xlim, (0.0, high)) for box, high in zip(_PLOTS, highs, strict=True))
    page: list[scene.Record] = [
        *_titles(r"$\mathrm{Sym}^{+}(2)\mathrm{\ is\ convex}$", r"$\mathrm{SO}(2)\mathrm{\ is\ curved}$"),
        *circle.records(turns, times, t, beyond, _CIRCLE_ALONE, False),
        *_cone_set(left, stretches),
        *_plot(left, spans[0], stretches.linear, t, "S", "S"),
        *_plot(right, spans[1], turns.linear, t, "M", "R", style.WRONG),
        *_circle_set(right),
    ]
    return scene.Picture((cone.view(stretches, times, t, beyond, _CONE, False), scene.View(tuple(page))))


def _titles(left: str, right: str) -> list[scene.Record]:
    return [
        scene.Label(text, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, x in ((left, _LEFT), (right, _RIGHT))
    ]


def _plot(
    axes: Axes,
    span: np.ndarray,
    way: Callable[[np.ndarray], np.ndarray],
    t: float,
    name: str,
    ends: str,
    color: str = style.RIGHT,
) -> list[scene.Record]:
    """The determinant of a blend over t; in red where it is not positive."""
    values, now = np.linalg.det(way(span)), float(np.linalg.det(way(np.array(t))))
    records = axes.frame([(0.0, "$0$"), (1.0, "$1$")], [(0.0, "$0$")])
    left, low, wide, high = axes.box
    said = rf"$\det {name}(t),\ \ {name}(t) = (1 - t)\,{ends}_0 + t\,{ends}_1$"
    records += [
        scene.Label("$t$", (left + wide, low, 0.0), style.INK, style.SMALL_TEXT, (14.0, 0.0), "lc"),
        scene.Label(
            said, (left + wide / 2.0, low + high, 0.0), style.INK, style.SMALL_TEXT, (0.0, 22.0), "cb"
        ),
        *(axes.vertical(x, style.RULE) for x in (0.0, 1.0)),
        axes.curve(span, np.where(values <= 0.0, values, np.nan), style.WRONG),
        axes.curve(span, np.where(values >= 0.0, values, np.nan), color),
        scene.Points(axes.at([t], [now]), color, 10.0, rim=style.PAPER),
    ]
    # On the hollow side of the curve, and under the line of the rotations where there is room for it.
    room = 0.0 if axes.at(t, 1.0)[1] - axes.at(t, now)[1] > 40.0 else 45.0
    place = ((0.0, -18.0), "ct") if np.diff(values, n=2).mean() < 0.0 else ((0.0, 14.0), "cb")
    text = style.ALGEBRA_TEXT if color == style.RIGHT else color
    value = f"${round(now, 2) + 0.0:.2f}$"
    return [*records, scene.Label(value, axes.at(t, now), text, style.SMALL_TEXT, *place, room=room)]


def _cone_set(axes: Axes, stretches: cone.Stretches) -> list[scene.Record]:
    """Where a determinant belongs to a positive definite matrix, and where the line leaves these."""
    (x0, x1), (_, high) = axes.xlim, axes.ylim
    corners = axes.at([x0, x1, x1, x0], [0.0, 0.0, high, high])
    arms = 8.0 * np.array([[1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]])
    crosses = [axes.at(exit, 0.0) + arms for exit in stretches.exits() if x0 <= exit <= x1]
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.GROUP, material="flat", alpha=0.10),
        *(scene.Lines(joined([cross[:2], cross[2:]]), style.WRONG, style.CURVE) for cross in crosses),
    ]


def _circle_set(axes: Axes) -> list[scene.Record]:
    """The determinant of a rotation, which only the ends have."""
    one = axes.at(np.array(axes.xlim), 1.0)
    records: list[scene.Record] = [
        scene.Lines(one, style.GROUP, 1.6 * style.CURVE),
        scene.Points(axes.at([0.0, 1.0], [1.0, 1.0]), style.GROUP_TEXT, 8.0, shaded=False),
    ]
    # A tick that is too near to that of 0 is left out.
    if one[0, 1] - axes.box[1] > 34.0:
        records.append(scene.Label("$1$", one[0], style.INK, style.SMALL_TEXT, (-14.0, 0.0), "rc"))
    name = r"$\mathrm{SO}(2)$"
    at = axes.at(0.5, 1.0)
    return [*records, scene.Label(name, at, style.GROUP_TEXT, style.SMALL_TEXT, (0.0, 12.0), "cb", room=60.0)]


def _linearise(
    stretches: cone.Stretches, turns: circle.Turns, times: np.ndarray, t: float, beyond: float
) -> scene.Picture:
    page: list[scene.Record] = [
        *_titles(r"$\mathrm{Sym}^{+}(2)$", r"$\mathrm{SO}(2)$"),
        *circle.records(turns, times, t, beyond, _CIRCLE, True),
        *circle.flat(turns, times, t, beyond, (700.0, 80.0, 460.0, 180.0)),
    ]
    for x, below in ((_LEFT, r"$\mathfrak{sym}(2)$"), (_RIGHT, r"$\mathfrak{so}(2)$")):
        page += _there_and_back(x, 300.0, 366.0)
        page.append(scene.Label(below, (x, 38.0, 0.0), style.ALGEBRA_TEXT, style.TITLE_TEXT, anchor="cn"))
    top = cone.view(stretches, times, t, beyond, _CONE, True)
    bottom = cone.flat(stretches, times, t, beyond, (57.0, 78.0, 540.0, 216.0))
    return scene.Picture((top, bottom, scene.View(tuple(page))))


def _there_and_back(x: float, low: float, high: float) -> list[scene.Record]:
    """An arrow down, log, and one up, exp."""
    down, up = x - 24.0, x + 24.0
    middle = (low + high) / 2.0
    return [
        scene.Arrow((down, high, 0.0), (down, low, 0.0), style.ALGEBRA, 2.2, 4.0),
        scene.Arrow((up, low, 0.0), (up, high, 0.0), style.GROUP, 2.2, 4.0),
        scene.Label(r"$\log$", (down - 16.0, middle, 0.0), style.ALGEBRA_TEXT, style.TEXT, anchor="rc"),
        scene.Label(r"$\exp$", (up + 16.0, middle, 0.0), style.GROUP_TEXT, style.TEXT, anchor="lc"),
    ]
