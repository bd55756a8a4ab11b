"""The pages of `cage`: a shape in its cage at rest and posed, and one way beside the others."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lietool.deform import distortion
from lietool.figure import Drawing
from lietool.mesh.surface import Mesh
from lietool.render import mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.plot import number
from lietool.render.scene import Label, Picture, Record, View

from . import _cage_case as case_
from . import _cage_look as cages
from . import _probe_look as look_

Array = NDArray[np.float64]

NAMES = {"faces": "face", "edges": "edge", "corners": "corner"}
# What stands beside each other: titles, and what differs of the choice.
COMPARED = (
    ("maps of faces", {"coordinates": "maps", "by": "faces"}),
    ("maps of edges", {"coordinates": "maps", "by": "edges"}),
    ("maps of corners", {"coordinates": "maps", "by": "corners"}),
    ("faces, linearly", {"coordinates": "maps", "by": "faces", "way": "linear"}),
    ("mean value coordinates", {"coordinates": "mean-value"}),
    ("Green coordinates", {"coordinates": "green"}),
)


def camera(case: case_.Case, look: look_.Look, shapes: Sequence[Array], box: Box) -> Camera:
    """Return one camera for all."""
    return mesh_page.together([look.upright(V) for V in shapes], look.direction, box, look.margin)


def pair(
    case: case_.Case,
    choice: case_.Choice,
    look: look_.Look,
    at: tuple[float, float, float],
    shown: int,
    paint: str,
) -> Drawing:
    """The shape in its cage at rest, and both posed."""
    boxes = mesh_page.grid(1, 2, (36.0, 130.0, 1128.0, 690.0))
    mesh, kind = case.mesh, case_.elements(case, choice)
    moved = case_.move(case, choice, *at, shown)
    seen = camera(case, look, [case.vertices, moved.cage, mesh.vertices, moved.points], boxes[0])
    top, ground = cages.high(moved.weight), float(look.upright(mesh.vertices)[:, 2].min())
    views: list[View] = []
    for k, (box, V, C) in enumerate(
        zip(boxes, (mesh.vertices, moved.points), (case.vertices, moved.cage), strict=True)
    ):
        X, C = look.upright(V), look.upright(C)
        low = min(ground, float(X[:, 2].min()))
        if paint == "weight":
            body = cages.weighted(X, mesh.faces, moved.weight, top, look, seen, low, moved=k == 1)
        else:
            body = look.body(X, mesh.faces, seen, float(k), low)
        spots = moved.fallback if k else None
        hatches = cages.hatched(X, mesh.faces, spots, seen, box)
        views.append(
            View((*body, *hatches, *cages.cage(C, look.upright(case.vertices), kind, seen, shown)), seen, box)
        )
    page: list[Record] = [*mesh_page.titles(boxes, ["at rest", said(case, *at)])]
    if paint == "weight":
        page += cages.bar(moved.weight, top, _weight(choice))
    views.append(View(tuple(page)))
    numbers = _numbers(case, choice, moved, at, shown)
    return Drawing(Picture(tuple(views)), numbers, mesh.moved(moved.points), (*case.notes, *moved.notes))


def _weight(choice: case_.Choice) -> str:
    if choice.coordinates == "maps":
        return f"weight of the marked {NAMES[choice.by]}"
    return "sum of the coordinates of its corners"


def said(case: case_.Case, t: float, bend: float, twist: float) -> str:
    """What has been done to the cage, in words."""
    if case.to is not None:
        return "moved" if t == 1.0 else f"moved, $t = {number(t, 2)}$"
    words = [("bent", bend), ("twisted", twist)]
    if case.name == "duck":
        # A head leans and turns; which way, words say better than a sign.
        words = [("leant forward" if bend > 0.0 else "leant back", abs(bend)), ("turned", abs(twist))]
    parts = [
        f"{word} by ${number(t * angle, 0)}^{{\\circ}}$" for word, angle in words if abs(t * angle) >= 0.5
    ]
    return ", ".join(parts) or "not moved"


def _numbers(
    case: case_.Case, choice: case_.Choice, moved: case_.Moved, at: tuple[float, float, float], shown: int
) -> dict[str, object]:
    X = moved.points
    found: dict[str, object] = {
        "cage_rest": case.vertices,
        "cage": moved.cage,
        "shown": shown,
        "corners": case_.elements(case, choice).ends[shown],
        "weight_low": moved.weight.min(),
        "weight_high": moved.weight.max(),
        "weight_mean": moved.weight.mean(),
        "low": X.min(axis=0),
        "high": X.max(axis=0),
        "mean": X.mean(axis=0),
        "volume": volume(case.mesh, X),
        "outside": len(case.outside),
    }
    if moved.pose is not None:
        found["map"] = moved.pose.maps[shown]
        x = rotation_vector(moved, shown)
        if x is not None:
            found["rotation_vector_degrees"] = np.degrees(x)
    return found


def rotation_vector(moved: case_.Moved, shown: int) -> Array | None:
    """Return the rotation vector of an element with its turns, if the way has one."""
    if moved.pose is None:
        return None
    encoded = moved.pose.encoded
    if not encoded.way.whole_turns or encoded.way.parts is None:
        return None
    return encoded.params[shown, encoded.way.parts[0]]


def volume(mesh: Mesh, X: Array) -> float:
    """Return by which factor the volume within the surface has grown."""
    six = [
        float(np.sum(V[mesh.faces[:, 0]] * np.cross(V[mesh.faces[:, 1]], V[mesh.faces[:, 2]])))
        for V in (mesh.vertices, X)
    ]
    return six[1] / six[0] if six[0] != 0.0 else 0.0


def compare(
    case: case_.Case, choice: case_.Choice, look: look_.Look, at: tuple[float, float, float]
) -> Drawing:
    """The same pose by elements of three kinds, linearly, and by coordinates of vertices."""
    boxes = [(x, y, 360.0, 288.0) for y in (526.0, 122.0) for x in (36.0, 420.0, 804.0)]
    chosen = [replace(choice, **own) for _, own in COMPARED]  # type: ignore[arg-type]
    all_ = [case_.move(case, each, *at, 0) for each in chosen]
    mesh = case.mesh
    seen = camera(case, look, [all_[0].cage, *(m.points for m in all_)], boxes[0])
    ground = float(look.upright(mesh.vertices)[:, 2].min())
    views: list[View] = []
    labels: list[Record] = []
    volumes, stretches = [], []
    for (title, _), box, m in zip(COMPARED, boxes, all_, strict=True):
        X = look.upright(m.points)
        body = look.body(X, mesh.faces, seen, 1.0, min(ground, float(X[:, 2].min())))
        hatches = cages.hatched(X, mesh.faces, m.fallback, seen, box)
        lines = cages.edges(look.upright(m.cage), look.upright(case.vertices), case.faces, seen, 0.6)
        views.append(View((*body, *hatches, *lines), seen, box))
        text = _measured(mesh, m.points, volumes, stretches)
        x = box[0] + box[2] / 2.0
        labels.append(
            Label(title, (x, box[1] + box[3] + 32.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        )
        labels.append(Label(text, (x, box[1] - 18.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"))
    views.append(
        View(
            (
                *labels,
                mesh_page.legend(
                    "stretch: the larger of $s_1$ and $1/s_2$, not exceeded on 95 % of the surface"
                ),
            )
        )
    )
    numbers = {"volume": np.array(volumes), "stretch": np.array(stretches), "cage": all_[0].cage}
    notes = tuple(dict.fromkeys((*case.notes, *(note for m in all_ for note in m.notes))))
    return Drawing(Picture(tuple(views)), numbers, mesh.moved(all_[0].points), notes)


def _measured(mesh: Mesh, X: Array, volumes: list[float], stretches: list[float]) -> str:
    """Measure a shape that has a surface, and say it."""
    if not len(mesh.faces):
        return f"{len(X)} points"
    volumes.append(volume(mesh, X))
    stretches.append(distortion.measure(mesh.vertices, mesh.faces, X).summary()["worst"].most_of)
    return rf"volume $\times\,{volumes[-1]:.2f}$, stretch {stretches[-1]:.2f}"
