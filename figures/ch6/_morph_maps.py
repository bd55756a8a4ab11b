"""Some triangles of two shapes, and the map of each, for `global-interp`."""

import numpy as np

from lietool.interp import shape
from lietool.mesh.shapes import Shape
from lietool.render import brackets, scene, style
from lietool.render.plane import Plane, fit

from . import _morph_marks as marks
from ._morph_stages import label

Array = np.ndarray

_TITLE, _LOWEST = 846.0, 46.0
_BOXES = ((80.0, 440.0, 440.0, 340.0), (680.0, 440.0, 440.0, 340.0))
# The lower row: its middle, the line of its names, and how far a triangle reaches.
_MIDDLE, _NAMES, _REACH = 216.0, 330.0, 80.0


def chosen(pair: Shape) -> Array:
    """Three triangles whose maps are shown: all of three, or some along the shape."""
    along = pair.along[pair.faces].mean(axis=1)
    if len(along) <= 3:
        return np.arange(len(along))
    return np.array([int(np.argmin(np.abs(along - part))) for part in (0.12, 0.45, 0.8)])


def picture(pair: Shape, at: Array, t: float) -> scene.Picture:
    """Return both shapes with some triangles coloured, and below, each of these under its map A_i."""
    some, tones = chosen(pair), style.SHELL_FILLS
    scale = min(fit(V, box).scale for V, box in zip((pair.source, pair.target), _BOXES, strict=True))
    records: list[scene.Record] = []
    few = len(pair.faces) <= 8
    for V, box, title, point in zip(
        (pair.source, pair.target), _BOXES, ("source $P$", "target $Q$"), ("p", "q"), strict=True
    ):
        place = fit(V, box, scale)
        records += marks.drawn(place, pair, V, style.BEFORE, eye=0.06 * scale)
        for k, i in enumerate(some):
            records += _lit(place, V[pair.faces[i]], tones[k])
            if few:
                middle = place.at(V[pair.faces[i]].mean(axis=0))
                records.append(scene.Label(rf"$\tau_{k + 1}$", middle, style.INK, style.TEXT, halo=False))
        if few:
            records += _points(place, V, point)
        records.append(label(title, box[0] + 0.5 * box[2], _TITLE, style.TITLE_TEXT))
    records += _below(pair, some, at, tones)
    said = rf"dashed: in $P$; filled: under $A_i$, as in $Q$; outlined: under $A_i(t)$, $t = {t:.2f}$"
    records.append(label(said, 600.0, _LOWEST))
    return scene.Picture((scene.View(tuple(records)),))


def _lit(place: Plane, corners: Array, tone: str) -> list[scene.Record]:
    at = place.at(corners)
    return [
        scene.Surface(at, [[0, 1, 2]], tone, material="flat"),
        scene.Lines(at[[0, 1, 2, 0]], style.INK, style.EDGE),
    ]


def _points(place: Plane, V: Array, name: str) -> list[scene.Record]:
    """The vertices with their numbers, away from the middle."""
    records: list[scene.Record] = [place.dots(V, style.INK, 6.0)]
    for k, at in enumerate(V):
        away = at - V.mean(axis=0)
        text = rf"$\mathbf{{{name}}}_{k + 1}$"
        records.append(place.beyond(text, at, away, size=style.SMALL_TEXT, gap=30.0, room=30.0))
    return records


def _below(pair: Shape, some: Array, at: Array, tones: tuple[str, ...]) -> list[scene.Record]:
    """Each triangle about its own centre: before, under A_i and under A_i(t); and the matrix A_i."""
    corners = pair.source[pair.faces[some]]
    corners = corners - corners.mean(axis=1, keepdims=True)
    full = shape.local_maps(pair.source, pair.target, pair.faces)[some]
    after = np.einsum("mij,mkj->mki", full, corners)
    scale = _REACH / max(float(np.abs(V).max()) for V in (corners, after))
    records: list[scene.Record] = []
    for k, i in enumerate(some):
        middle = 600.0 + 375.0 * (k - 0.5 * (len(some) - 1))
        place = Plane((middle - 108.0, _MIDDLE), scale)
        records += _lit(place, after[k], tones[k])
        before, now = (V[[0, 1, 2, 0]] for V in (corners[k], corners[k] @ at[i].T))
        records.append(place.line(before, style.MUTED, style.EDGE, dash=(9.0, 7.0)))
        records.append(place.line(now, style.INK, style.HAIR))
        wide = brackets.width(full[k])
        records += brackets.matrix(full[k], middle - 18.0, _MIDDLE)
        records.append(label(rf"$\tau_{{{k + 1}}}$", middle - 108.0, _NAMES))
        records.append(label(rf"$A_{{{k + 1}}}$", middle - 18.0 + 0.5 * wide, _NAMES))
    return records
