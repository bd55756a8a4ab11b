"""The page of `probe` that follows one arm: what is measured along it, and the arm seen close by two ways."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.figure import Drawing
from lietool.mesh import solids
from lietool.render import mesh_page, style
from lietool.render.plot import Axes, number
from lietool.render.scene import Label, Picture, Record, View

from . import _probe_measure as measure
from . import _probe_pages as pages
from ._close import framed, within
from ._probe_case import Case, Moment, Moving

Array = NDArray[np.float64]


def page(moving: Moving, beside: Moving | None, t: float) -> Drawing:
    """At rest and what is measured along the arm; below, the arm alone by another way and by one way."""
    case = moving.case
    whole, windows = (28.0, 462.0, 562.0, 360.0), [(612.0, 44.0, 552.0, 352.0), (36.0, 44.0, 552.0, 352.0)]
    ways = [moving] + ([beside] if beside else [])
    rest = pages.at_rest(moving)
    moments = [each.at(t) for each in ways]
    camera = mesh_page.together([case.look.upright(_reach(case, [rest]))], case.look.direction, whole, 1.04)
    near = mesh_page.together(
        [case.look.upright(_reach(case, [rest, *moments], "arm 0"))], case.look.direction, windows[0], 1.12
    )
    views = [
        View(pages.shape(case, rest.points, camera, 0.0), camera, whole),
        View(pages.probes(case, rest, camera, False), camera, whole),
    ]
    for box, m in zip(windows, moments, strict=False):
        views.append(View(tuple(within(pages.shape(case, m.points, near, 1.0), near, box)), near, box))
        views.append(View(pages.probes(case, m, near, True, named=False), near, box))
    along = measure.ALONG
    twists = [measure.twist(m.points, m.vectors[0]) for m in moments]
    heads = [("at rest", 309.0, mesh_page.TITLE), ("turn along the arm", 930.0, mesh_page.TITLE)]
    heads += [
        (pages.WORDS[each.way.name], box[0] + 0.5 * box[2], 418.0)
        for each, box in zip(ways, windows, strict=False)
    ]
    said: list[Record] = [
        Label(text, (x, y, 0.0), style.INK, style.TITLE_TEXT, anchor="cn") for text, x, y in heads
    ]
    for box, m, twist in zip(windows, moments, twists, strict=False):
        text = f"asked {pages.degrees(m)}, turned ${number(twist[-1], 0)}^{{\\circ}}$"
        at = (box[0] + box[2] - 20.0, box[1] + 18.0, 0.0)
        said += [framed(box), Label(text, at, style.INK, style.SMALL_TEXT, anchor="rb")]
    views.append(View((*said, *_plot(ways, along, twists))))
    found = {f"twist_degrees_{each.way.name}": twist for each, twist in zip(ways, twists, strict=True)}
    return Drawing(
        Picture(tuple(views)),
        pages.numbers(moving, moments[0]) | {"along": along} | found,
        case.mesh.moved(moments[0].points),
    )


def _reach(case: Case, moments: Sequence[Moment], part: str = "") -> Array:
    """Points (n, 3) that must be seen: of the shape or of a part of it, and the tips of probes."""
    s = solids.octopus()
    shown = s.of(part) & (s.along > 0.15) if part else np.ones(len(s.vertices), bool)
    tips = [
        (m.frames[:, :3, 3, None] + case.look.probe * m.frames[:, :3, :3]).swapaxes(1, 2) for m in moments
    ]
    return np.concatenate([m.points[shown] for m in moments] + [x.reshape(-1, 3) for x in tips])


def _plot(ways: Sequence[Moving], along: Array, twists: Sequence[Array]) -> list[Record]:
    least, most = min(float(x.min()) for x in twists), max(float(x.max()) for x in twists)
    step = next(s for s in (10.0, 30.0, 90.0, 180.0, 360.0) if most - least <= 4.0 * s or s == 360.0)
    low = 0.0 if least > -0.1 * step else step * np.floor(least / step)
    high = max(step, 1.05 * most)
    axes = Axes((730.0, 506.0, 400.0, 280.0), (0.0, 1.0), (low, high))
    ticks = [(y, f"${number(y, 0)}^{{\\circ}}$") for y in np.arange(low, high + 1e-6, step)]
    records = axes.frame([(0.0, "root"), (1.0, "tip")], ticks)
    for k, (way, twist) in enumerate(zip(ways, twists, strict=True)):
        color, dash = ((style.ROUTE_1, None), (style.ROUTE_2, (12.0, 7.0)))[k]
        text = (style.ROUTE_1_TEXT, style.ROUTE_2_TEXT)[k]
        records.append(axes.curve(along, twist, color, dash=dash))
        # Left of what rises, above what does not.
        i = len(along) // 2 if twist[-1] > 0.5 * high else -4
        at = axes.at(along[i], twist[i])
        records.append(
            Label(pages.WORDS[way.way.name], at, text, style.SMALL_TEXT, (-14.0, 14.0), "rb", room=60.0)
        )
    return records
