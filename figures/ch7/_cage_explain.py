"""One element of a cage: its tetrahedron before and after, and the affine map that this defines."""

import numpy as np
from numpy.typing import NDArray

from lietool.deform import cage_frames
from lietool.figure import Drawing
from lietool.lie import polar, so3
from lietool.render import brackets, marks, mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.scene import Arrow, Label, Lines, Picture, Record, Surface, View

from . import _cage_case as case_
from . import _cage_look as cages
from . import _cage_pages as pages
from . import _probe_look as look_

Array = NDArray[np.float64]

_SMALL: tuple[Box, Box] = ((30.0, 476.0, 290.0, 336.0), (30.0, 84.0, 290.0, 336.0))
_LARGE: tuple[Box, Box] = ((330.0, 476.0, 410.0, 336.0), (330.0, 84.0, 410.0, 336.0))
_MIDDLE = 960.0
_BARE = (0.0, 1.0)
# It is seen from so much further round than the shape, so that its normal is not seen from its tip.
_ROUND, _ABOVE = 40.0, 14.0
# The frame that shows the map, over the longest side of the tetrahedron.
_FRAME = 0.26
# Its axes have the same colours before and after, so that each is found again; paler before.
_PALE = 0.62
_SIDES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_FACES = ((1, 0, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_FOURTH = {
    "faces": (
        r"$\mathbf{e}_1=\mathbf{p}_2-\mathbf{p}_1,\ \mathbf{e}_2=\mathbf{p}_3-\mathbf{p}_1$",
        r"$\mathbf{n}=\mathbf{e}_1\times\mathbf{e}_2$",
        r"$\mathbf{p}_4=\mathbf{p}_1+\mathbf{n}/\sqrt{|\mathbf{n}|}$",
    ),
    "edges": (r"$\mathbf{p}_3$, $\mathbf{p}_4$: from the middle", "along the mean normal,", "and across"),
    "corners": (r"$\mathbf{p}_4$: from $\mathbf{p}_1$ along", "the mean normal of its faces"),
}


def explain(
    case: case_.Case, choice: case_.Choice, look: look_.Look, at: tuple[float, float, float], shown: int
) -> Drawing:
    """The cage, the tetrahedron of one element, and its map in numbers and as a frame."""
    kind = case_.elements(case, choice)
    now = case.posed(*at)
    T = np.stack([choice.tetrahedra(kind, V)[shown] for V in (case.vertices, now)])
    A = choice.maps(cage_frames.rest(kind, case.vertices), now)[shown]
    moved = case_.move(case, choice, *at, shown)
    views = _whole(case, look, kind, moved, shown)
    aside = look.turned(_ROUND, _ABOVE)
    *frames, size = _frames(T[0], A)
    extents = [look.upright(np.concatenate([t, _tips(f, size)])) for t, f in zip(T, frames, strict=True)]
    seen = mesh_page.each(extents, aside.direction, _LARGE, 1.24)
    for k in range(2):
        records = _tetrahedron(look.upright(T[k]), kind.name, seen[k], moved=k == 1)
        frame = look.upright(frames[k])
        views.append(View(tuple(records), seen[k], _LARGE[k]))
        # The frame stands inside of the tetrahedron.
        views.append(
            View(tuple(mesh_look.probe(frame, size, moved=True, alpha=(_PALE, 1.0)[k])), seen[k], _LARGE[k])
        )
    x = pages.rotation_vector(moved, shown)
    angle = float(np.degrees(np.linalg.norm(_rotation(A) if x is None else x)))
    name = pages.NAMES[choice.by]
    heads = [
        Label(text, (x, mesh_page.TITLE, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, x in (("cage", 175.0), (f"tetrahedron of one {name}", 535.0), ("its map", _MIDDLE))
    ]
    rows = [
        Label(text, (175.0, y, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")
        for text, y in (("at rest", 440.0), ("in the pose", 48.0))
    ]
    views.append(View((*heads, *rows, *_down(), *_numbers(A, angle, kind.name))))
    found = {
        "shown": shown,
        "corners": kind.ends[shown],
        "tetrahedra": T,
        "map": A,
        "rotation_vector_degrees": np.degrees(_rotation(A)),
        "stretches": np.linalg.svd(A[:3, :3], compute_uv=False),
    }
    return Drawing(Picture(tuple(views)), found, case.mesh.moved(moved.points), (*case.notes, *moved.notes))


def _whole(
    case: case_.Case, look: look_.Look, kind: cage_frames.Elements, moved: case_.Moved, shown: int
) -> list[View]:
    mesh = case.mesh
    shapes = [case.vertices, moved.cage, mesh.vertices, moved.points]
    seen = pages.camera(case, look, shapes, _SMALL[0])
    rest, ground = look.upright(case.vertices), float(look.upright(mesh.vertices)[:, 2].min())
    views = []
    for k, (V, C) in enumerate(((mesh.vertices, case.vertices), (moved.points, moved.cage))):
        X = look.upright(V)
        body = look.body(X, mesh.faces, seen, float(k), min(ground, float(X[:, 2].min())))
        views.append(
            View((*body, *cages.cage(look.upright(C), rest, kind, seen, shown, dots=2.6)), seen, _SMALL[k])
        )
    return views


def _frames(T: Array, A: Array) -> tuple[Array, Array, float]:
    """A frame in the middle of the tetrahedron's base, where the map takes it, and how large it is drawn."""
    frame = np.eye(4)
    size = max(float(np.linalg.norm(T[i] - T[j])) for i, j in _SIDES)
    frame[:3, 3] = T[:3].mean(axis=0)
    return frame, A @ frame, _FRAME * size


def _tips(frame: Array, size: float) -> Array:
    return frame[:3, 3] + size * frame[:3, :3].T


def _tetrahedron(T: Array, kind: str, camera: Camera, moved: bool) -> list[Record]:
    middle = T.mean(axis=0)
    fill, edge = (style.AFTER, style.AFTER_EDGE) if moved else (style.GLASS, style.GLASS_EDGE)
    records: list[Record] = [
        Surface(T, np.array(_FACES[:1]), fill, material="flat", alpha=0.55),
        Surface(T, np.array(_FACES[1:]), fill, material="flat", alpha=0.16),
    ]
    size = max(float(np.linalg.norm(T[i] - T[j])) for i, j in _SIDES)
    for i, j in _SIDES:
        base = j < 3
        records.append(Lines(T[[i, j]], edge, style.CURVE if base else style.THIN, 1.0 if base else 0.8))
    # An edge's third and fourth point belong to no side of the cage.
    foot = T[0] if kind != "edges" else 0.5 * (T[0] + T[1])
    for k in (3,) if kind != "edges" else (2, 3):
        if np.linalg.norm(T[k] - foot) > 1e-9 * size:
            records.append(Arrow(foot, T[k], style.INK, 0.011 * size, 3.0))
    for k in range(4):
        away = T[k] - middle
        if np.linalg.norm(away) > 1e-9 * size:
            text = rf"$\mathbf{{p}}_{k + 1}'$" if moved else rf"$\mathbf{{p}}_{k + 1}$"
            records.append(marks.beyond(text, T[k], away, camera, room=50.0))
    return records + (_named(T, camera, moved) if kind == "faces" else [])


def _named(T: Array, camera: Camera, moved: bool) -> list[Record]:
    """The names of two sides of a face, and of its normal."""
    dash = "'" if moved else ""
    normal = rf"$\mathbf{{n}}{dash}/\sqrt{{|\mathbf{{n}}{dash}|}}$"
    records: list[Record] = []
    # The frame stands over the middle of the first side.
    for text, (i, j), other, share in (
        (rf"$\mathbf{{e}}_1{dash}$", (0, 1), 2, 0.18),
        (rf"$\mathbf{{e}}_2{dash}$", (0, 2), 1, 0.5),
        (normal, (0, 3), 1, 0.5),
    ):
        away, along = 0.5 * (T[i] + T[j]) - T[other], T[j] - T[i]
        length = float(np.linalg.norm(along))
        if length < 1e-9:
            continue
        across = away - (away @ along) / length**2 * along
        place = T[i] + share * along
        color = style.INK if j == 3 else style.GLASS_EDGE if not moved else style.AFTER_EDGE
        gap, room = (62.0 if j == 3 else 22.0), 40.0
        records.append(
            marks.beyond(text, place, across, camera, color=color, size=style.SMALL_TEXT, gap=gap, room=room)
        )
    return records


def _down() -> list[Record]:
    """The way from the one tetrahedron to the other."""
    return [
        Arrow((535.0, 482.0, 0.0), (535.0, 402.0, 0.0), style.INK, 2.2, 3.6),
        Label(r"$\hat A_i$", (535.0, 446.0, 0.0), style.INK, style.TEXT, (18.0, 0.0), "lc"),
    ]


def _rotation(A: Array) -> Array:
    """The rotation vector of the nearest rotation."""
    return so3.log(polar.rotation(A[:3, :3])) if np.linalg.det(A[:3, :3]) > 0.0 else np.zeros(3)


def _numbers(A: Array, angle: float, kind: str) -> list[Record]:
    # What is 0 or 1 but for rounding is written so.
    shown = np.round(A, 9) + 0.0
    s = np.linalg.svd(A[:3, :3], compute_uv=False)
    records: list[Record] = [
        *brackets.matrix(shown, _MIDDLE - 0.5 * brackets.width(shown, _BARE), 620.0, bare=_BARE)
    ]
    turned = rf"turned by ${angle:.0f}^{{\circ}}$"
    if np.linalg.det(A[:3, :3]) <= 0.0:
        turned = "turned inside out"
    lines = (
        (r"$\hat A_i\,\mathbf{p}_k=\mathbf{p}_k'$", 732.0, style.INK),
        (turned, 446.0, style.INK),
        ("stretched by", 394.0, style.INK),
        (", ".join(f"${brackets.fixed(x)}$" for x in s), 348.0, style.INK),
        *((text, 246.0 - 52.0 * k, style.INK) for k, text in enumerate(_FOURTH[kind])),
    )
    return records + [
        Label(text, (_MIDDLE, y, 0.0), color, style.SMALL_TEXT, anchor="cn") for text, y, color in lines
    ]
