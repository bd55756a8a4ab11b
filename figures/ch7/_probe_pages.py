"""The pages of `probe`: before and after, stages in a row, and one way of blending beside another."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lietool.figure import Drawing
from lietool.render import mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera, project
from lietool.render.plot import number
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
_LEAST = 100.0
# Between stages, over how wide they are.
_GAP = 0.10
# Degrees of view of a long lens.
_LONG = 3.0
# A volume, over that at rest, that is called thin.
_THIN = 2.0 / 3.0
# By how much the column of another way is set apart, and what is in the middle from what is left of it.
_ASIDE = 22.0


def _camera(moving: Sequence[Moving], box: Box) -> Camera:
    look = moving[0].case.look
    shapes = [look.upright(each.extent) for each in moving]
    camera = mesh_page.together(shapes, look.direction, box, look.margin)
    return camera if look.lens is None else replace(camera, fov=np.radians(look.lens))


def shape(case: Case, points: Array, camera: Camera, stage: float) -> tuple[Record, ...]:
    look, rest = case.look, case.mesh.vertices
    ground = float(look.upright(rest)[:, 2].min())
    V = look.upright(points)
    return tuple(look.body(V, case.mesh.faces, camera, stage, min(ground, float(V[:, 2].min()))))


def probes(
    case: Case, moment: Moment, camera: Camera, moved: bool, arcs: bool = True, named: bool = True
) -> tuple[Record, ...]:
    look, records = case.look, []
    up = look.upright(np.eye(3))
    for frame, x in zip(look.upright(moment.frames), moment.vectors, strict=True):
        records += mesh_look.probe(frame, look.probe, moved=moved)
        if arcs and moved and np.degrees(np.linalg.norm(x)) > _LEAST:
            u, color = x @ up / np.linalg.norm(x), style.INK if look.dots else style.MARK
            # Around that end of the axis that is seen better.
            seen = 1.0 if camera.axes.sum(axis=0) @ u >= 0.0 else -1.0
            center = frame[:3, 3] + (0.0 if look.dots else 0.8 * seen * look.probe) * u
            text = None if named and not look.dots else ""
            records += mesh_look.turn(center, x @ up, 0.5 * look.probe, camera, color=color, text=text)
    return tuple(records)


def at_rest(moving: Moving) -> Moment:
    case = moving.case
    k = len(case.probes.names)
    n = len(case.mesh.vertices)
    return Moment(case.mesh.vertices, case.probes.rest, np.zeros((k, 3)), np.zeros(n, bool))


def pair(moving: Moving, t: float) -> Drawing:
    """Before and after, side by side."""
    case = moving.case
    boxes = mesh_page.grid(1, 2)
    camera, rest, moment = _camera([moving], boxes[0]), at_rest(moving), moving.at(t)
    views = [
        View(shape(case, rest.points, camera, 0.0), camera, boxes[0]),
        View(probes(case, rest, camera, False), camera, boxes[0]),
        View(shape(case, moment.points, camera, 1.0), camera, boxes[1]),
        View(probes(case, moment, camera, True), camera, boxes[1]),
        View(tuple(_names(case, rest, camera, boxes[0]) + _names(case, moment, camera, boxes[1]))),
        View((*mesh_page.titles(boxes, ["at rest", _moved(case, t, moment)]), mesh_page.legend(case.said))),
    ]
    return Drawing(Picture(tuple(views)), numbers(moving, moment), case.mesh.moved(moment.points))


def _names(case: Case, moment: Moment, camera: Camera, box: Box) -> list[Record]:
    """The numbers of several probes, of those that have grown with by how much; one's own stay unmarked."""
    count = len(moment.frames)
    if case.name == "own" or case.look.dots or count < 3:
        return []
    frames = case.look.upright(moment.frames)
    # Beside the tip of the third axis, which ends outside of most shapes, and away from their middle.
    tips = frames[:, :3, 3] + case.look.probe * frames[:, :3, 2]
    seen = project(camera, box, tips)
    middle = project(camera, box, case.look.upright(moment.points))[:, 0].mean()
    grown = np.cbrt(np.linalg.det(frames[:, :3, :3]) / np.linalg.det(case.probes.rest[:, :3, :3]))
    records: list[Record] = []
    for k in range(count):
        text = rf"$\mathbf{{{k + 1}}}$"
        if abs(grown[k] - 1.0) > 1e-6:
            text += rf" $(\times\,{number(grown[k], 2)})$"
        at = (float(seen[k, 0]), float(seen[k, 1]), 0.0)
        left = seen[k, 0] < middle - _ASIDE
        offset = (-15.0 if left else 15.0, 10.0)
        records.append(Label(text, at, style.INK, style.SMALL_TEXT, offset, "rc" if left else "lc"))
    return records


def _moved(case: Case, t: float, moment: Moment) -> str:
    """What is said over a shape that has moved."""
    if case.poses is not None:
        count = len(case.poses.frames)
        return f"pose {number(1.0 + t * (count - 1), 1)} of {count}"
    if case.look.dots and np.degrees(np.linalg.norm(moment.vectors, axis=1).max()) > _LEAST:
        # There is no room for it among the points.
        return f"turned by {degrees(moment)}"
    return "moved" if t == 1.0 else f"moved, $t = {number(t, 2)}$"


def numbers(moving: Moving, moment: Moment) -> dict[str, object]:
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
    lows = (524.0, 124.0) if beside else (300.0,)
    boxes = [(36.0, low, 1128.0, 298.0) for low in lows]
    shift, extents = _apart(case, moments, boxes[0])
    camera = mesh_page.together(extents, case.look.direction, boxes[0], 1.02)
    # So long a lens that every stage is seen from the same side.
    camera = replace(camera, fov=np.radians(_LONG))
    views: list[View] = []
    for box, ms in zip(boxes, moments, strict=True):
        for s, m, d in zip(times, ms, shift, strict=True):
            V, frames = case.look.upright(m.points) + d, case.look.upright(m.frames).copy()
            frames[:, :3, 3] += d
            views.append(View(tuple(case.look.body(V, case.mesh.faces, camera, float(s))), camera, box))
            frames_drawn = [r for f in frames for r in mesh_look.probe(f, case.look.probe, moved=s > 0.0)]
            views.append(View(tuple(frames_drawn), camera, box))
    middles = [V.mean(axis=0) for V in extents]
    names = [_head(each, mesh_page.TITLE - 410.0 * k, 600.0) for k, each in enumerate(both)]
    volume = np.array([measure.volumes(case.mesh, ms) for ms in moments])
    below = [
        label
        for box, ms, found in zip(boxes, moments, volume, strict=True)
        for label in _below(ms, found, [project(camera, box, x)[0] for x in middles], box[1] - 30.0)
    ]
    views.append(View((*names, *below, mesh_page.legend(case.said))))
    leaning = {
        "times": times,
        "leaning_degrees": np.array([measure.leaning(ms) for ms in moments]),
        "volume": volume,
    }
    return Drawing(
        Picture(tuple(views)),
        numbers(moving, moments[0][-1]) | leaning,
        case.mesh.moved(moments[0][-1].points),
    )


def _below(moments: Sequence[Moment], volumes: Array, places: Sequence[float], y: float) -> list[Record]:
    """Under each stage by how much is turned, and the volume over that at rest, red where much is lost."""
    records: list[Record] = []
    # Many stages are near each other: their angles alone.
    full = len(moments) <= 5
    for m, volume, x in zip(moments, volumes, places, strict=True):
        color = style.WRONG if full and volume < _THIN else style.INK
        text = degrees(m) + (f", volume ${number(volume, 2)}$" if full else "")
        records.append(Label(text, (float(x), y, 0.0), color, style.SMALL_TEXT, anchor="cn"))
    return records


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


def degrees(moment: Moment) -> str:
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
    if beside:
        boxes[-1] = (boxes[-1][0] + _ASIDE, *boxes[-1][1:])
    camera = _camera([each for each, _ in shown[-2:]], boxes[0])
    # Over their lower probe, which stays.
    feet = [float(project(camera, box, case.look.upright(case.probes.rest)[0, :3, 3])[0]) for box in boxes]
    views: list[View] = []
    for box, m, (_, s) in zip(boxes, moments, shown, strict=True):
        views.append(View(shape(case, m.points, camera, s), camera, box))
        views.append(View(probes(case, m, camera, True, arcs=False), camera, box))
    page: list[Record] = [_head(moving, mesh_page.TITLE, 0.5 * (feet[0] + feet[len(times) - 1]))]
    if beside:
        page.append(_head(beside, mesh_page.TITLE, feet[-1]))
        ends = [
            project(camera, box, case.look.upright(m.points))[:, 0]
            for box, m in zip(boxes, moments, strict=True)
        ]
        x = 0.5 * float(ends[-2].max() + ends[-1].min())
        page.append(Lines([(x, 94.0, 0.0), (x, 870.0, 0.0)], style.RULE, style.THIN))
    # Before an angle that a way does not keep.
    asked = [""] * len(times) + ["" if beside is None or beside.way.whole_turns else "asked: "]
    for text, m, x in zip(asked, moments, feet, strict=False):
        at = (x, boxes[0][1] - 16.0, 0.0)
        page.append(Label(text + degrees(m), at, style.INK, style.SMALL_TEXT, anchor="cn"))
    views.append(View((*page, mesh_page.legend(case.said))))
    return Drawing(
        Picture(tuple(views)),
        numbers(moving, moments[len(times) - 1])
        | {"times": times, "winding_degrees": np.array([measure.winding(m.points) for m in moments])},
        case.mesh.moved(moments[len(times) - 1].points),
    )
