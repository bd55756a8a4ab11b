"""The pages of `probe`: before and after, stages in a row, and one way of blending beside another."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.figure import Drawing
from lietool.render import mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera, project
from lietool.render.plot import Axes, number
from lietool.render.scene import Label, Lines, Picture, Record, View

from . import _probe_measure as measure
from ._probe_case import Case, Moment, Moving

Array = NDArray[np.float64]

WORDS = {
    "phi_so": r"rotation vectors, $\varphi_{so}$",
    "phi_se": r"rotation vectors, $\varphi_{se}$",
    "alexa": "matrix logarithm",
    "polar_quaternion": "quaternions",
    "dual_quaternion": "dual quaternions",
    "linear": "matrices",
}
# A probe that turns by less, degrees, has no arc: its axes say by how much.
_LEAST = 180.0
# Between stages, over how wide they are.
_GAP = 0.10


def _camera(moving: Sequence[Moving], box: Box) -> Camera:
    look = moving[0].case.look
    shapes = [look.upright(each.extent) for each in moving]
    return mesh_page.together(shapes, look.direction, box, look.margin)


def _shape(case: Case, points: Array, camera: Camera, stage: float) -> tuple[Record, ...]:
    look, rest = case.look, case.mesh.vertices
    ground = float(look.upright(rest)[:, 2].min())
    V = look.upright(points)
    return tuple(look.body(V, case.mesh.faces, camera, stage, min(ground, float(V[:, 2].min()))))


def _probes(case: Case, moment: Moment, camera: Camera, moved: bool, arcs: bool = True) -> tuple[Record, ...]:
    look, records = case.look, []
    up = look.upright(np.eye(3))
    for frame, x in zip(look.upright(moment.frames), moment.vectors, strict=True):
        records += mesh_look.probe(frame, look.probe, moved=moved)
        if arcs and moved and np.degrees(np.linalg.norm(x)) > _LEAST:
            u, color = x @ up / np.linalg.norm(x), style.INK if look.dots else style.MARK
            # Around that end of the axis that is seen better.
            seen = 1.0 if camera.axes.sum(axis=0) @ u >= 0.0 else -1.0
            center = frame[:3, 3] + (0.0 if look.dots else 0.8 * seen * look.probe) * u
            text = "" if look.dots else None
            records += mesh_look.turn(center, x @ up, 0.5 * look.probe, camera, color=color, text=text)
    return tuple(mesh_look.inside(records, 0.9))


def _rest(moving: Moving) -> Moment:
    case = moving.case
    k = len(case.probes.names)
    n = len(case.mesh.vertices)
    return Moment(case.mesh.vertices, case.probes.rest, np.zeros((k, 3)), np.zeros(n, bool))


def pair(moving: Moving, t: float) -> Drawing:
    """Before and after, side by side."""
    case = moving.case
    boxes = mesh_page.grid(1, 2)
    camera, rest, moment = _camera([moving], boxes[0]), _rest(moving), moving.at(t)
    views = [
        View(_shape(case, rest.points, camera, 0.0), camera, boxes[0]),
        View(_probes(case, rest, camera, False), camera, boxes[0]),
        View(_shape(case, moment.points, camera, 1.0), camera, boxes[1]),
        View(_probes(case, moment, camera, True), camera, boxes[1]),
        View((*mesh_page.titles(boxes, ["at rest", _moved(case, t, moment)]), mesh_page.legend(case.said))),
    ]
    return Drawing(Picture(tuple(views)), _numbers(moving, moment), case.mesh.moved(moment.points))


def _moved(case: Case, t: float, moment: Moment) -> str:
    """What is said over a shape that has moved."""
    if case.poses is not None:
        count = len(case.poses.frames)
        return f"pose {number(1.0 + t * (count - 1), 1)} of {count}"
    if case.look.dots and np.degrees(np.linalg.norm(moment.vectors, axis=1).max()) > _LEAST:
        # There is no room for it among the points.
        return f"turned by {_degrees(moment)}"
    return "moved" if t == 1.0 else f"moved, $t = {number(t, 2)}$"


def _numbers(moving: Moving, moment: Moment) -> dict[str, object]:
    """What every page shows: where the probes are, and the shape, and by how much it has moved."""
    case = moving.case
    V, X = case.mesh.vertices, moment.points
    far = np.linalg.norm(X - V, axis=1)
    return {
        "probes": list(case.probes.names),
        "rest": case.probes.rest,
        "frames": moment.frames,
        "rotation_vectors_degrees": np.degrees(moment.vectors),
        "low": X.min(axis=0),
        "high": X.max(axis=0),
        "mean": X.mean(axis=0),
        "moved_at_most": far.max(),
        "fallback": int(moment.fallback.sum()),
    }


def row(moving: Moving, beside: Moving | None, t: float, steps: int) -> Drawing:
    """Stages in a row, on one ground; below it, a row by another way."""
    case = moving.case
    times = np.linspace(0.0, t, steps)
    both = [moving] + ([beside] if beside else [])
    moments = [[each.at(float(s)) for s in times] for each in both]
    lows = (492.0, 100.0) if beside else (290.0,)
    boxes = [(36.0, low, 1128.0, 325.0) for low in lows]
    shift, extents = _apart(case, moments, boxes[0])
    camera = mesh_page.together(extents, case.look.direction, boxes[0], 1.02)
    views: list[View] = []
    for box, ms in zip(boxes, moments, strict=True):
        for s, m, d in zip(times, ms, shift, strict=True):
            V, frames = case.look.upright(m.points) + d, case.look.upright(m.frames).copy()
            frames[:, :3, 3] += d
            views.append(View(tuple(case.look.body(V, case.mesh.faces, camera, float(s))), camera, box))
            probes = [r for f in frames for r in mesh_look.probe(f, case.look.probe, moved=s > 0.0)]
            views.append(View(tuple(mesh_look.inside(probes, 0.9)), camera, box))
    middles = [V.mean(axis=0) for V in extents]
    names = [_head(each, mesh_page.TITLE - 398.0 * k, 600.0) for k, each in enumerate(both)]
    angles = [
        Label(
            _degrees(m),
            (project(camera, boxes[-1], middle)[0], boxes[-1][1] - 32.0, 0.0),
            style.INK,
            style.SMALL_TEXT,
            anchor="cn",
        )
        for m, middle in zip(moments[0], middles, strict=True)
    ]
    views.append(View((*names, *angles, mesh_page.legend(case.said, 20.0))))
    leaning = {
        "times": times,
        "leaning_degrees": np.array([measure.leaning(ms) for ms in moments]),
        "volume": np.array([measure.volumes(case.mesh, ms) for ms in moments]),
    }
    return Drawing(
        Picture(tuple(views)),
        _numbers(moving, moments[0][-1]) | leaning,
        case.mesh.moved(moments[0][-1].points),
    )


def _apart(case: Case, moments: Sequence[Sequence[Moment]], box: Box) -> tuple[Array, list[Array]]:
    """By how much stages are moved to fill a box side by side, and where they are then, all rows together."""
    look = case.look
    extents = [
        np.concatenate([x for m in stage for x in (look.upright(m.points), look.upright(m.frames)[:, :3, 3])])
        for stage in zip(*moments, strict=True)
    ]
    right, upward = Camera(look.direction).axes[:2]
    low = np.array([(V @ right).min() for V in extents])
    wide = np.array([(V @ right).max() for V in extents]) - low
    high = max(float(np.ptp(V @ upward)) for V in extents)
    gap = (0.96 * high * box[2] / box[3] - float(wide.sum())) / max(len(wide) - 1, 1)
    start = np.cumsum(np.append(0.0, wide + max(gap, _GAP * float(wide.mean()))))[:-1]
    shift = (start - low)[:, None] * right
    return shift, [V + d for V, d in zip(extents, shift, strict=True)]


def _degrees(moment: Moment) -> str:
    """By how much the probe has turned that has turned most."""
    return f"${number(np.degrees(np.linalg.norm(moment.vectors, axis=1).max()), 0)}^{{\\circ}}$"


def _head(moving: Moving, base: float, x: float) -> Label:
    return Label(WORDS[moving.way.name], (x, base, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")


def columns(moving: Moving, beside: Moving | None, t: float, steps: int) -> Drawing:
    """Upright stages in columns, and the last by another way at the right."""
    case = moving.case
    times = np.linspace(0.0, t, steps)
    shown = [(moving, float(s)) for s in times] + ([(beside, t)] if beside else [])
    moments = [each.at(s) for each, s in shown]
    boxes = mesh_page.grid(1, len(shown), (36.0, 110.0, 1128.0, 710.0), 8.0)
    camera = _camera([each for each, _ in shown[-2:]], boxes[0])
    views: list[View] = []
    for box, m, (_, s) in zip(boxes, moments, shown, strict=True):
        views.append(View(_shape(case, m.points, camera, s), camera, box))
        views.append(View(_probes(case, m, camera, True, arcs=False), camera, box))
    last = boxes[len(times) - 1]
    page: list[Record] = [_head(moving, mesh_page.TITLE, 0.5 * (boxes[0][0] + last[0] + last[2]))]
    if beside:
        page.append(_head(beside, mesh_page.TITLE, boxes[-1][0] + 0.5 * boxes[-1][2]))
        x = 0.5 * (last[0] + last[2] + boxes[-1][0])
        page.append(Lines([(x, 70.0, 0.0), (x, 870.0, 0.0)], style.RULE, style.THIN))
    page += mesh_page.captions(boxes, [_degrees(m) for m in moments], 26.0)
    views.append(View((*page, mesh_page.legend(case.said, 28.0))))
    return Drawing(
        Picture(tuple(views)),
        _numbers(moving, moments[len(times) - 1])
        | {"times": times, "winding_degrees": np.array([measure.winding(m.points) for m in moments])},
        case.mesh.moved(moments[len(times) - 1].points),
    )


def compare(moving: Moving, beside: Moving | None, t: float) -> Drawing:
    """At rest, by one way and by another, and what is measured along the arm."""
    case = moving.case
    boxes = [(28.0, 462.0, 562.0, 350.0), (610.0, 462.0, 562.0, 350.0), (28.0, 30.0, 562.0, 350.0)]
    ways = [moving] + ([beside] if beside else [])
    camera, rest = _camera(ways, boxes[0]), _rest(moving)
    moments = [each.at(t) for each in ways]
    views: list[View] = []
    for k, (box, m) in enumerate(zip(boxes, [rest, *moments], strict=False)):
        views.append(View(_shape(case, m.points, camera, float(k > 0)), camera, box))
        views.append(View(_probes(case, m, camera, k > 0), camera, box))
    along = measure.ALONG
    twists = [measure.twist(m.points, m.vectors[0]) for m in moments]
    texts = ["at rest", *(WORDS[each.way.name] for each in ways)]
    labels = [
        Label(text, (box[0] + box[2] / 2.0, base, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, box, base in zip(texts, boxes, (846.0, 846.0, 414.0), strict=False)
    ]
    views.append(View((*labels, *_plot(ways, along, twists))))
    found = {f"twist_degrees_{each.way.name}": twist for each, twist in zip(ways, twists, strict=True)}
    return Drawing(
        Picture(tuple(views)),
        _numbers(moving, moments[0]) | {"along": along} | found,
        case.mesh.moved(moments[0].points),
    )


def _plot(ways: Sequence[Moving], along: Array, twists: Sequence[Array]) -> list[Record]:
    least, most = min(float(x.min()) for x in twists), max(float(x.max()) for x in twists)
    step = next(s for s in (10.0, 30.0, 90.0, 180.0, 360.0) if most - least <= 4.0 * s or s == 360.0)
    low = 0.0 if least > -0.1 * step else step * np.floor(least / step)
    high = max(step, 1.05 * most)
    axes = Axes((735.0, 92.0, 400.0, 250.0), (0.0, 1.0), (low, high))
    ticks = [(y, f"${number(y, 0)}^{{\\circ}}$") for y in np.arange(low, high + 1e-6, step)]
    records = axes.frame([(0.0, "root"), (1.0, "tip")], ticks, title="turned, measured at the arm")
    for k, (way, twist) in enumerate(zip(ways, twists, strict=True)):
        color, dash = ((style.ROUTE_1, None), (style.ROUTE_2, (12.0, 7.0)))[k]
        text = (style.ROUTE_1_TEXT, style.ROUTE_2_TEXT)[k]
        records.append(axes.curve(along, twist, color, dash=dash))
        at = axes.at(along[-6], twist[-6])
        records.append(Label(WORDS[way.way.name], at, text, style.SMALL_TEXT, (-16.0, 20.0), "rb", room=60.0))
    return records
