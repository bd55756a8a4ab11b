"""The pages of `poisson`: handles and pins, two ways of blending, and three methods in a table."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import poisson
from lietool.figure import Drawing
from lietool.mesh import solids
from lietool.render import marks, mesh_lines, mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.plot import Axes, number
from lietool.render.scene import Label, Lines, Picture, Record, View
from lietool.render.theme import Mix

from ._close import framed, within
from ._poisson_case import WAYS, Case, Measured, guided, turned
from ._probe_pages import WORDS as NAMES

Array = NDArray[np.float64]

# Arcs of turns by less, degrees, are not drawn.
_LEAST = 0.5
# The last line of a page.
FOOT = 52.0
# The weight that would have the darkest colour; a line on a surface, towards the viewer.
_HIGH, _LIFT = 1.7, 0.003
# How often the border of a handle is averaged with its neighbours.
_SMOOTH = 4
# Of others the radius, in lengths of the handles' axes.
_ARC = 1.2
# Around a part that is seen from near by, in its own size.
_NEAR, _ASIDE = 1.16, 0.11
# By how much of their distance faces that are turned over are drawn nearer than what lies in their place.
_RAISED = 3e-4
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


def near(found: "Sequence[Method]", box: Box, margin: float) -> Camera:
    """A camera for results side by side: from near by where only a part of the mesh matters."""
    case = found[0].case
    if case.close is None:
        return _camera(case, [m.result.vertices for m in found], box, margin)
    shapes = [case.look.upright(m.result.vertices[case.close]) for m in found]
    made = mesh_page.together(shapes, case.look.direction, box, _NEAR)
    # More of what it grows from than of what is beyond it, where there is room.
    wide = made.height * box[2] / box[3]
    most = max(float(((V - made.target) @ made.axes[0]).max()) for V in shapes)
    x, y, z = (made.target - np.clip(0.46 * wide - most, 0.0, _ASIDE * wide) * made.axes[0]).tolist()
    return replace(made, target=(x, y, z))


def shown(m: "Method", camera: Camera, box: Box) -> list[View]:
    """A result, cut off at its box with a frame around it where it is seen from near by."""
    case, X = m.case, m.result.vertices
    records = _body(case, X, camera, 1.0)
    V, F, over = case.look.upright(X), case.mesh.faces, m.result.flipped
    raised = V + _RAISED * (camera.eye - V)
    records += mesh_look.surface(raised, F[over], style.WRONG, normals=solids.normals(V, F))
    if case.close is None:
        return [View(tuple(records), camera, box)]
    return [View(tuple(within(records, camera, box)), camera, box), View((framed(box),))]


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
        *mesh_look.surface(V, F, _tinted(weights)),
        *mesh_look.weight_levels(V, F, weights),
        *mesh_look.outline(V, F, camera, style.ALGEBRA_TEXT),
        *mesh_look.eyes(V, solids.normals(V, F), case.look.eyes, case.look.eye),
    ]


def _tinted(weights: ArrayLike) -> Mix:
    """Colours of weights that end where a blue axis is still seen before them."""
    return mesh_look.weight_colors(weights, _HIGH)


def _borders(case: Case, points: Array) -> list[Record]:
    """Where handles end on the surface, in lines that are smooth over the steps of its edges."""
    V, F = case.look.upright(points), case.mesh.faces
    ends = mesh_lines.edges(F).ends
    both = np.concatenate([ends, ends[:, ::-1]])
    count = np.bincount(both[:, 0], minlength=len(V))
    records: list[Record] = []
    for own in case.handles:
        held = np.zeros(len(V))
        held[own] = 1.0
        for _ in range(_SMOOTH):
            held = (held + np.bincount(both[:, 0], held[both[:, 1]], len(V))) / (1.0 + count)
        records.append(Lines(mesh_lines.level_lines(V, F, held, [0.5]), style.INK, style.CURVE, lift=_LIFT))
    return records


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
            records += _arc(frame[:3, 3], x @ up, up, _ARC * look.probe, camera)
    return mesh_look.inside(records, 0.95)


def _arc(centre: Array, x: Array, axes: Array, radius: float, camera: Camera) -> list[Record]:
    """The arc of a turn; by less than a half one it begins where an axis was at rest, with a line there."""
    angle = float(np.linalg.norm(x))
    if angle >= np.pi:
        return mesh_look.turn(centre, x, radius, camera)
    u = x / angle
    # Of the axes the one that goes farthest, the last of equals.
    best = max(range(3), key=lambda k: (round(float(np.linalg.norm(np.cross(axes[k], u))), 6), k))
    v = mesh_lines.unit(axes[best] - (axes[best] @ u) * u)
    along = np.linspace(0.0, angle, max(round(angle / 0.05), 2) + 1)
    ring = np.cos(along)[:, None] * v + np.sin(along)[:, None] * np.cross(u, v)
    out = ring[len(ring) // 2]
    name = rf"${number(np.degrees(angle), 0)}^{{\circ}}$"
    return [
        Lines([centre, centre + radius * v], style.MARK, style.EDGE),
        *marks.curved_arrow(centre + radius * ring, style.MARK, 0.035 * radius, 3.2),
        marks.beyond(name, centre + radius * out, out, camera, color=style.MARK, room=60.0),
    ]


def common(case: Case, result: poisson.Result) -> dict[str, object]:
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
        View((*_weighted(case, total, camera), *_borders(case, V), *_pins(case, V)), camera, boxes[0]),
        View(tuple(_handles(case, 0.0, camera, False)), camera, boxes[0]),
        View((*_body(case, X, camera, 1.0), *_borders(case, X)), camera, boxes[1]),
        View(tuple(_handles(case, t, camera, True)), camera, boxes[1]),
        View((*mesh_page.titles(boxes, ["at rest", "edited"]), *_legend(case))),
    ]
    numbers = common(case, result) | {"weights, mean": case.weights(kind).mean(axis=0)}
    return Drawing(Picture(tuple(views)), numbers, case.mesh.moved(X), notes(case, result))


def _legend(case: Case) -> list[Record]:
    word = "of the handle" if len(case.names) == 1 else "of the handles"
    records = mesh_page.color_bar((400.0, 62.0, 240.0, 18.0), title=f"weight {word}", colors=_tinted)
    ends = np.array([[870.0, 71.0, 0.0], [910.0, 71.0, 0.0]])
    records.append(Lines(ends, style.INK, style.CURVE))
    border = "handle's border" if len(case.names) == 1 else "handles' borders"
    records.append(Label(border, ends[1], style.INK, style.SMALL_TEXT, (14.0, 0.0), "lc", halo=False))
    if len(case.pins):
        at = np.array([[715.0, 71.0, 0.0]])
        records += mesh_look.cloud(at, style.MARK, 8.0)
        records.append(Label("pinned", at[0], style.INK, style.SMALL_TEXT, (20.0, 0.0), "lc", halo=False))
    return records


def notes(case: Case, result: poisson.Result) -> tuple[str, ...]:
    said = list(case.notes)
    if flipped := int(result.flipped.sum()):
        said.append(f"{flipped} of {len(result.flipped)} faces are turned over")
    if fallback := int(result.fallback.sum()):
        said.append(f"{fallback} faces have no real logarithm and were given the polar blend")
    return tuple(said)


@dataclass(frozen=True, eq=False)
class Method:
    """An edit by weights of a kind and a way of blending, with what is measured."""

    case: Case
    kind: str
    way: str
    result: poisson.Result
    measured: Measured
    places: Array
    degrees: Array

    @classmethod
    def of(cls, case: Case, kind: str, way: str, t: float) -> "Method":
        result = case.solve(kind, WAYS[way], t)
        along = guided(case, result) if case.name == "own" else turned(case, result.vertices)
        return cls(case, kind, way, result, Measured.of(case, result), *along)

    @property
    def numbers(self) -> dict[str, object]:
        """For the plate's file."""
        return self.measured.numbers | {"weight": self.places, "turned": self.degrees}


def compare(case: Case, kind: str, ways: tuple[str, str], t: float) -> Drawing:
    """At rest, the edit by two ways of blending, and how far each has turned from pins to handle."""
    boxes = [(40.0, 500.0, 540.0, 318.0), (40.0, 92.0, 540.0, 312.0), (620.0, 92.0, 540.0, 312.0)]
    found = [Method.of(case, kind, way, t) for way in ways]
    V = case.mesh.vertices
    camera = _camera(case, [m.result.vertices for m in found], boxes[0], 1.05)
    views = [
        View(tuple(_body(case, V, camera, 0.0)), camera, boxes[0]),
        View(tuple(_asked(case, t, camera)), camera, boxes[0]),
    ]
    lens = near(found, boxes[1], 1.05)
    views += [view for m, box in zip(found, boxes[1:], strict=True) for view in shown(m, lens, box)]
    words: list[Record] = [
        Label(text, (box[0] + box[2] / 2.0, base, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, box, base in zip(
            ("at rest", *(NAMES[WAYS[way].name] for way in ways)), boxes, (846.0, 418.0, 418.0), strict=True
        )
    ]
    for m, box in zip(found, boxes[1:], strict=True):
        line = f"mean stretch {m.measured.mean:.2f}, {m.measured.flipped or 'no'} faces turned over"
        at = (box[0] + box[2] / 2.0, FOOT, 0.0)
        words.append(Label(line, at, tone(m), style.SMALL_TEXT, anchor="cn"))
    if case.name == "arm":
        words += mesh_page.captions(boxes[:1], ["grey: pinned; blue tip: the handle"], 32.0)
    views.append(View((*words, *_plot(found))))
    numbers = {m.way: m.numbers for m in found}
    result = found[-1].result
    return Drawing(
        Picture(tuple(views)),
        common(case, result) | numbers,
        case.mesh.moved(result.vertices),
        notes(case, result),
    )


def _asked(case: Case, t: float, camera: Camera) -> list[Record]:
    """The handles at rest with the turns that are asked of them."""
    look = case.look
    up = look.upright(np.eye(3))
    records = _handles(case, 0.0, camera, False)
    for centre, x in zip(look.upright(case.motions.centres), t * case.motions.x, strict=True):
        if np.degrees(np.linalg.norm(x)) > _LEAST:
            records += mesh_look.turn(centre, x @ up, _ARC * look.probe, camera, text="")
            # Above: at its end it would stand among the numbers of the plot.
            above = centre + 1.3 * _ARC * look.probe * camera.axes[1]
            name = rf"${number(np.degrees(np.linalg.norm(x)), 0)}^{{\circ}}$"
            records.append(Label(name, above, style.MARK, style.TEXT, (0.0, 4.0), "cb", room=60.0))
    return records


def _plot(found: Sequence[Method]) -> list[Record]:
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
    records = axes.frame([(0.0, "$0$"), (1.0, "$1$")], ticks)
    middle, name = axes.box[0] + 0.5 * axes.box[2], "weight (pins $0$, handle $1$)"
    title = "turn of the guidance" if found[0].case.name == "own" else "turn along the arm"
    records += [
        Label(title, (middle, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        Label(name, (middle, axes.box[1], 0.0), style.INK, style.SMALL_TEXT, (0.0, -46.0), "ct", halo=False),
    ]
    for m, (color, text, dash) in zip(found, _COLORS, strict=True):
        records.append(axes.curve(m.places, m.degrees, color, dash=dash))
        label = rf"{NAMES[WAYS[m.way].name]}: ${number(m.degrees[-1], 0)}^{{\circ}}$"
        at = axes.at(0.62, np.interp(0.62, m.places, m.degrees))
        records.append(Label(label, at, text, style.SMALL_TEXT, (0.0, 26.0), "cb", room=110.0))
    return records


def tone(m: Method) -> str:
    """Red where faces are turned over."""
    return style.WRONG if m.measured.flipped else style.INK
