"""The pages of `poisson`: handles and pins, two ways of blending, and three methods in a table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.deform import poisson
from lietool.figure import Drawing
from lietool.mesh import solids
from lietool.render import mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.plot import Axes, number
from lietool.render.scene import Label, Picture, Record, View

from ._poisson_case import WAYS, Case, Measured, guided, turned
from ._probe_pages import WORDS

Array = NDArray[np.float64]

# Arcs of turns by less, degrees, are not drawn.
_LEAST = 0.5
# Of others the radius, in lengths of the handles' axes.
_ARC = 1.2
_COLORS = ((style.ROUTE_2, style.ROUTE_2_TEXT, (12.0, 7.0)), (style.ROUTE_1, style.ROUTE_1_TEXT, None))


def _camera(case: Case, shapes: Sequence[Array], box: Box, margin: float = 1.06) -> Camera:
    look = case.look
    upright = [look.upright(V) for V in (case.mesh.vertices, *shapes, _tips(case))]
    return mesh_page.together(upright, look.direction, box, margin)


def _tips(case: Case) -> Array:
    """The ends of the handles' axes, at rest and moved."""
    own = case.motions.centres[:, None] + case.look.probe * np.eye(3)
    A, _ = case.motions.at(1.0)
    moved = (A[:, None, :3, :3] @ own[..., None])[..., 0] + A[:, None, :3, 3]
    return np.concatenate([own, moved]).reshape(-1, 3) if case.name == "own" else case.motions.centres


def _ground(case: Case, points: Array) -> float:
    look = case.look
    return min(float(look.upright(V)[:, 2].min()) for V in (case.mesh.vertices, points))


def _body(case: Case, points: Array, camera: Camera, stage: float) -> list[Record]:
    V = case.look.upright(points)
    records = case.look.body(V, case.mesh.faces, camera, stage, _ground(case, points))
    # Where pins and handles have no colours of their own.
    return records if case.name == "arm" else [*records, *_pins(case, points)]


def _weighted(case: Case, weights: Array, camera: Camera) -> list[Record]:
    """The mesh at rest in the colours of weights (n,)."""
    V, F = case.look.upright(case.mesh.vertices), case.mesh.faces
    return [
        *mesh_look.shadow(V, F, _ground(case, case.mesh.vertices)),
        *mesh_look.surface(V, F, mesh_look.weight_colors(weights)),
        *mesh_look.weight_levels(V, F, weights),
        *mesh_look.outline(V, F, camera, style.ALGEBRA_TEXT),
        *mesh_look.eyes(V, solids.normals(V, F), case.look.eyes, case.look.eye),
    ]


def _pins(case: Case, points: Array) -> list[Record]:
    return mesh_look.cloud(case.look.upright(points[case.pins]), style.MARK, 3.4)


def _handles(case: Case, t: float, camera: Camera, arcs: bool) -> list[Record]:
    """The handles as frames at their centres, on a part of their way."""
    look = case.look
    A, _ = case.motions.at(t)
    frames = np.tile(np.eye(4), (len(A), 1, 1))
    frames[:, :3, 3] = case.motions.centres
    up = look.upright(np.eye(3))
    records: list[Record] = []
    for frame, x in zip(look.upright(A @ frames), t * case.motions.x, strict=True):
        records += mesh_look.probe(frame, look.probe, moved=True)
        if arcs and np.degrees(np.linalg.norm(x)) > _LEAST:
            records += mesh_look.turn(frame[:3, 3], x @ up, _ARC * look.probe, camera)
    return mesh_look.inside(records, 0.95)


def _common(case: Case, result: poisson.Result) -> dict[str, object]:
    """What every page says of the result that it gives away."""
    X = result.vertices
    A, turns = case.motions.at(1.0)
    return {
        "handles": list(case.names),
        "transformations": A,
        "turns": turns,
        "low": X.min(axis=0),
        "high": X.max(axis=0),
        "mean": X.mean(axis=0),
        "fallback": int(result.fallback.sum()),
        "distortion": Measured.of(case, result).numbers,
    }


def handles(case: Case, kind: str, way: str, t: float) -> Drawing:
    """At rest with the weights of the handles, and edited."""
    boxes = mesh_page.grid(1, 2)
    result = case.solve(kind, WAYS[way], t)
    V, X = case.mesh.vertices, result.vertices
    total = case.weights(kind).sum(axis=1)
    camera = _camera(case, [X], boxes[0])
    views = [
        View((*_weighted(case, total, camera), *_pins(case, V)), camera, boxes[0]),
        View(tuple(_handles(case, 0.0, camera, False)), camera, boxes[0]),
        View(tuple(_body(case, X, camera, 1.0)), camera, boxes[1]),
        View(tuple(_handles(case, t, camera, True)), camera, boxes[1]),
        View((*mesh_page.titles(boxes, ["at rest", "edited"]), *_legend(case))),
    ]
    numbers = _common(case, result) | {"weights, mean": case.weights(kind).mean(axis=0)}
    return Drawing(Picture(tuple(views)), numbers, case.mesh.moved(X), _notes(case, result))


def _legend(case: Case) -> list[Record]:
    word = "of the handle" if len(case.names) == 1 else "of the handles"
    records = mesh_page.color_bar((468.0, 62.0, 240.0, 18.0), title=f"weight {word}")
    if len(case.pins):
        at = np.array([[830.0, 71.0, 0.0]])
        records += mesh_look.cloud(at, style.MARK, 8.0)
        records.append(Label("pinned", at[0], style.INK, style.SMALL_TEXT, (20.0, 0.0), "lc", halo=False))
    return records


def _notes(case: Case, result: poisson.Result) -> tuple[str, ...]:
    notes = list(case.notes)
    if flipped := int(result.flipped.sum()):
        notes.append(f"{flipped} of {len(result.flipped)} faces are turned over")
    if fallback := int(result.fallback.sum()):
        notes.append(f"{fallback} faces have no real logarithm and were given the polar blend")
    return tuple(notes)


@dataclass(frozen=True, eq=False)
class _Method:
    """An edit by weights of a kind and a way of blending, with what is measured."""

    case: Case
    kind: str
    way: str
    result: poisson.Result
    measured: Measured
    places: Array
    degrees: Array

    @classmethod
    def of(cls, case: Case, kind: str, way: str, t: float) -> "_Method":
        result = case.solve(kind, WAYS[way], t)
        along = guided(case, result) if case.name == "own" else turned(case, result.vertices)
        return cls(case, kind, way, result, Measured.of(case, result), *along)

    @property
    def numbers(self) -> dict[str, object]:
        """For the plate's file."""
        return self.measured.numbers | {"weight": self.places, "turned": self.degrees}


def compare(case: Case, kind: str, ways: tuple[str, str], t: float) -> Drawing:
    """At rest, the edit by two ways of blending, and how far each has turned from pins to handle."""
    boxes = [(24.0, 498.0, 566.0, 330.0), (24.0, 78.0, 566.0, 330.0), (610.0, 78.0, 566.0, 330.0)]
    found = [_Method.of(case, kind, way, t) for way in ways]
    V = case.mesh.vertices
    camera = _camera(case, [m.result.vertices for m in found], boxes[0], 1.02)
    views = [
        View(tuple(_body(case, V, camera, 0.0)), camera, boxes[0]),
        View(tuple(_asked(case, t, camera)), camera, boxes[0]),
    ]
    views += [
        View(tuple(_body(case, m.result.vertices, camera, 1.0)), camera, box)
        for m, box in zip(found, boxes[1:], strict=True)
    ]
    words: list[Record] = [
        Label(text, (box[0] + box[2] / 2.0, base, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, box, base in zip(
            ("at rest", *(WORDS[WAYS[way].name] for way in ways)), boxes, (846.0, 420.0, 420.0), strict=True
        )
    ]
    for m, box in zip(found, boxes[1:], strict=True):
        line = f"mean stretch {m.measured.mean:.2f}, {m.measured.flipped or 'no'} faces turned over"
        at = (box[0] + box[2] / 2.0, box[1] - 44.0, 0.0)
        words.append(Label(line, at, _tone(m), style.SMALL_TEXT, anchor="cn"))
    if case.name == "arm":
        words += mesh_page.captions(boxes[:1], ["grey: pinned; red tip: the handle"], 22.0)
    views.append(View((*words, *_plot(found))))
    numbers = {m.way: m.numbers for m in found}
    result = found[-1].result
    return Drawing(
        Picture(tuple(views)),
        _common(case, result) | numbers,
        case.mesh.moved(result.vertices),
        _notes(case, result),
    )


def _asked(case: Case, t: float, camera: Camera) -> list[Record]:
    """The handles at rest with the turns that are asked of them."""
    look = case.look
    up = look.upright(np.eye(3))
    records = _handles(case, 0.0, camera, False)
    for centre, x in zip(look.upright(case.motions.centres), t * case.motions.x, strict=True):
        if np.degrees(np.linalg.norm(x)) > _LEAST:
            records += mesh_look.turn(centre, x @ up, _ARC * look.probe, camera)
    return records


def _plot(found: Sequence[_Method]) -> list[Record]:
    """How far each has turned, over the weight of the handle."""
    most = max(1.12 * max(float(m.degrees.max()) for m in found), 10.0)
    # Beyond half a turn quaternions go the shorter way round, which is back.
    least = min(1.12 * min(float(m.degrees.min()) for m in found), 0.0)
    least = 0.0 if least > -0.02 * most else least
    step = next((s for s in (30.0, 90.0, 180.0, 360.0) if most <= 3.5 * s), 720.0)
    axes = Axes((732.0, 546.0, 380.0, 236.0), (0.0, 1.0), (least, most))
    ticks = [
        (y, rf"${number(y, 0)}^{{\circ}}$") for y in step * np.arange(np.ceil(least / step), most / step)
    ]
    records = axes.frame([(0.0, "$0$ (pins)"), (1.0, "$1$ (handle)")], ticks)
    middle = axes.box[0] + 0.5 * axes.box[2]
    title = "turned, of the guidance" if found[0].case.name == "own" else "turned, measured"
    records += [
        Label(title, (middle, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        Label(
            "weight", (middle, axes.box[1], 0.0), style.INK, style.SMALL_TEXT, (0.0, -14.0), "ct", halo=False
        ),
    ]
    for m, (color, text, dash) in zip(found, _COLORS, strict=True):
        records.append(axes.curve(m.places, m.degrees, color, dash=dash))
        label = rf"{WORDS[WAYS[m.way].name]}: ${number(m.degrees[-1], 0)}^{{\circ}}$"
        at = axes.at(0.62, np.interp(0.62, m.places, m.degrees))
        records.append(Label(label, at, text, style.SMALL_TEXT, (0.0, 26.0), "cb", room=110.0))
    return records


METHODS = (
    ("geodesic", "polar-quaternion", ("geodesic weights,", "quaternions")),
    ("harmonic", "polar-quaternion", ("harmonic weights,", "quaternions")),
    ("harmonic", "phi-so", ("harmonic weights,", "parametrisation")),
)
"""The rows of table 7.1: weights, way of blending, and both in words."""

_LINES = ("mean stretch", "5 % above", "turned over")
# Where the columns begin, their pitch and width; the rows' upper end and the part of the page that they take.
_COLUMNS, _PITCH, _WIDE, _TOP, _ROWS = 212.0, 326.0, 316.0, 790.0, 722.0
_LINE, _TALL = 34.0, 240.0


def table(cases: Sequence[Case], asked: Sequence[float | None], t: float) -> Drawing:
    """The three methods, each on the same edits: one row of pictures for each, and what is measured."""
    pitch = _ROWS / len(cases)
    tall = min(pitch - _LINE * (1 + len(_LINES)) - 14.0, 440.0)
    boxes = [
        [(_COLUMNS + k * _PITCH, _TOP - i * pitch - tall, _WIDE, tall) for k in range(3)]
        for i in range(len(cases))
    ]
    rows = [[_Method.of(case, kind, way, t) for kind, way, _ in METHODS] for case in cases]
    shapes = [cases[0].look.upright(m.result.vertices) for row in rows for m in row]
    camera = mesh_page.together(shapes, cases[0].look.direction, boxes[0][0], 1.02)
    views: list[View] = []
    words: list[Record] = []
    for row, places, degrees in zip(rows, boxes, asked, strict=True):
        for m, box in zip(row, places, strict=True):
            views.append(View(tuple(_body(m.case, m.result.vertices, camera, 1.0)), camera, box))
            words += _column(m, box, -1.0 if (degrees or 0.0) < 0.0 else 1.0)
        words += _names(places[0], degrees)
    for box, (_, _, name) in zip(boxes[0], METHODS, strict=True):
        for k, line in enumerate(name):
            at = (box[0] + 0.5 * box[2], 846.0 - 38.0 * k, 0.0)
            words.append(Label(line, at, style.INK, style.TITLE_TEXT, anchor="cn"))
    meant = "stretch: the larger of $s_1$ and $1/s_2$ of a face that is free"
    views.append(View((*words, mesh_page.legend(meant, 32.0))))
    ours = rows[-1][-1]
    found = {
        "edit" if degrees is None else f"asked {degrees:g}": {f"{m.kind}, {m.way}": m.numbers for m in row}
        for degrees, row in zip(asked, rows, strict=True)
    }
    return Drawing(
        Picture(tuple(views)),
        _common(ours.case, ours.result) | found,
        ours.case.mesh.moved(ours.result.vertices),
        _notes(ours.case, ours.result),
    )


def _names(box: Box, degrees: float | None) -> list[Record]:
    """What was asked for beside a row of pictures, and the names of the lines below it."""
    records: list[Record] = []
    right, middle = _COLUMNS - 14.0, box[1] + 0.5 * box[3]
    shown = () if degrees is None else ("asked for:", rf"${number(degrees, 0)}^{{\circ}}$")
    for k, line in enumerate(shown):
        at = (right, middle + 20.0 - 40.0 * k, 0.0)
        records.append(Label(line, at, style.INK, style.TEXT, anchor="rn"))
    # Without a turn of ours it is a user's mesh, of which only the guidance is followed.
    for k, line in enumerate(("guidance" if degrees is None else "turned by", *_LINES)):
        at = (right, box[1] - _LINE * (k + 1), 0.0)
        records.append(Label(line, at, style.MUTED, style.SMALL_TEXT, anchor="rn", halo=False))
    return records


def _tone(m: _Method) -> str:
    """Red where faces are turned over."""
    return style.WRONG if m.measured.flipped else style.INK


def _column(m: _Method, box: Box, sign: float) -> list[Record]:
    """What is measured, below a picture; turns with a sign."""
    lines = (
        rf"${number(sign * m.degrees[-1], 0)}^{{\circ}}$",
        f"{m.measured.mean:.2f}",
        f"{m.measured.most_of:.2f}",
        f"{m.measured.flipped or 'none'}",
    )
    x = box[0] + 0.5 * box[2]
    return [
        Label(line, (x, box[1] - _LINE * (k + 1), 0.0), _tone(m), style.SMALL_TEXT, anchor="cn", halo=False)
        for k, line in enumerate(lines)
    ]
