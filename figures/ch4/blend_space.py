"""Figures 4.3 and 4.4 of the book."""

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.plot import Axes, number

from . import _blend_circle as circle
from . import _blend_cone as cone

Symmetric = tuple[float, float, float]
_START, _END = (2.1, 0.7, 0.6), (0.7, -0.6, 2.6)


@figure(
    plates={
        "B4.3": Plate(
            title="A blend stays in a convex set and leaves a curved one",
            equations=("4.19",),
            caption=(
                "Left: the symmetric matrices of the plane, the positive definite ones inside the cone "
                "det = 0. The blend of two is the segment between them, and all of it is positive "
                "definite (ellipses: the unit disc under the matrix); it leaves the cone only beyond the "
                "ends (red). Right: the rotations are a circle. The chord leaves it at once: the blend of "
                "two rotations is none, and shrinks (glyph). Below: the determinants."
            ),
        ),
        "B4.4": Plate(
            title="Interpolation by linearisation",
            equations=("4.4", "4.19"),
            caption=(
                "The logarithm carries the ends to a flat space, the straight line there has equal steps, "
                "and exp carries it back as a curve in the curved space. Left: from the cone of positive "
                "definite matrices to sym(2); the curve never leaves the cone. Right: from the circle of "
                "rotations to the line of angles so(2); the glyph keeps its size. Dashed: the chord."
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
    angle0: Annotated[float, Param("angle of the rotation at t = 0", "deg", -360.0, 360.0)] = 20.0,
    angle1: Annotated[float, Param("angle of the rotation at t = 1", "deg", -360.0, 360.0)] = 150.0,
    steps: Annotated[int, Param("equal steps from one end to the other", low=1, high=24)] = 4,
    beyond: Annotated[float, Param("how far the ways go on before 0 and after 1", low=0.0, high=1.0)] = 0.35,
    t: Annotated[float, Param("the moment that is marked", low=0.0, high=1.0)] = 0.4,
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
    if smallest <= 1e-12 * float(np.abs(S).max()) or not S.any():
        raise ValueError(
            f"{name} must be positive definite; got smallest eigenvalue {smallest:.3g}. "
            "Give xx, xy, yy with xx > 0 and xx yy > xy^2"
        )
    return S


def _convex(
    stretches: cone.Stretches, turns: circle.Turns, times: np.ndarray, t: float, beyond: float
) -> scene.Picture:
    page: list[scene.Record] = [
        *_titles(r"$\mathrm{Sym}^{+}(2)\mathrm{\ is\ convex}$", r"$SO(2)\mathrm{\ is\ curved}$"),
        *circle.records(turns, times, t, beyond, (700.0, 340.0, 460.0, 470.0), False),
        *_determinants((110.0, 80.0, 440.0, 152.0), stretches.linear, t, beyond, "S", "S"),
        *_determinants((710.0, 80.0, 400.0, 152.0), turns.linear, t, beyond, "M", "R"),
    ]
    left = cone.view(stretches, times, t, beyond, (24.0, 306.0, 650.0, 540.0), False)
    return scene.Picture((left, scene.View(tuple(page))))


def _titles(left: str, right: str) -> list[scene.Record]:
    return [
        scene.Label(text, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, x in ((left, 349.0), (right, 930.0))
    ]


def _determinants(
    box: Box, way: Callable[[np.ndarray], np.ndarray], t: float, beyond: float, name: str, ends: str
) -> list[scene.Record]:
    """The determinant of a blend over t: in red where it is not positive."""
    span = np.linspace(-beyond, 1.0 + beyond, 241)
    values, now = np.linalg.det(way(span)), float(np.linalg.det(way(np.array(t))))
    low, high = float(values.min()), 1.1 * max(1.0, float(values.max()))
    low = 0.0 if low >= 0.0 else max(1.1 * low, -0.5 * high)
    axes = Axes(box, (-beyond, 1.0 + beyond), (low, high))
    # Rotations have 1; where that is too near to 0 to be told from it, the largest value stands instead.
    one = 1.0 if axes.at(0.0, 1.0)[1] - axes.at(0.0, 0.0)[1] > 34.0 else high / 1.1
    records = axes.frame(
        [(0.0, "$0$"), (1.0, "$1$")],
        [(0.0, "$0$"), (one, f"${one:.3g}$")],
        "$t$",
        rf"$\det {name}(t),\ \ {name}(t) = (1 - t)\,{ends}_0 + t\,{ends}_1$",
        title_size=style.SMALL_TEXT,
    )
    good = np.where(values > 0.0, values, np.nan)
    bad = np.where((values <= 0.0) & (values >= low), values, np.nan)
    records += [axes.vertical(x, style.RULE) for x in (0.0, 1.0)]
    records += [axes.curve(span, bad, style.WRONG, dash=(8.0, 6.0)), axes.curve(span, good, style.ALGEBRA)]
    records.append(scene.Points(axes.at([t], [now]), style.ALGEBRA, 10.0, rim=style.PAPER))
    records.append(
        scene.Label(
            f"${number(now)}$",
            axes.at(t, now),
            style.ALGEBRA_TEXT,
            style.SMALL_TEXT,
            (0.0, 20.0),
            "cb",
            room=70.0,
        )
    )
    return records


def _linearise(
    stretches: cone.Stretches, turns: circle.Turns, times: np.ndarray, t: float, beyond: float
) -> scene.Picture:
    page: list[scene.Record] = [
        *_titles(r"$\mathrm{Sym}^{+}(2)$", r"$SO(2)$"),
        *circle.records(turns, times, t, beyond, (700.0, 352.0, 460.0, 462.0), True),
        *circle.flat(turns, times, t, beyond, (720.0, 60.0, 420.0, 190.0)),
    ]
    for x, below in ((349.0, r"$\mathrm{sym}(2)$"), (930.0, r"$\mathfrak{so}(2)$")):
        page += _there_and_back(x, 268.0, 338.0)
        page.append(scene.Label(below, (x, 38.0, 0.0), style.ALGEBRA_TEXT, style.TITLE_TEXT, anchor="cn"))
    top = cone.view(stretches, times, t, beyond, (24.0, 344.0, 650.0, 480.0), True)
    bottom = cone.flat(stretches, times, t, beyond, (67.0, 70.0, 564.0, 200.0))
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
