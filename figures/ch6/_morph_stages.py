"""The pages before the strips: both shapes, their local maps, and one moment between them, large."""

import numpy as np

from lietool.interp import shape
from lietool.mesh import topology
from lietool.mesh.shapes import Shape
from lietool.render import brackets, scene, style
from lietool.render.plane import Plane, fit

from . import _morph_marks as marks

Array = np.ndarray

_TITLE = 846.0
# Boxes of the two shapes alone; of both beside a moment between them, which is as large as they are.
_ENDS = ((60.0, 130.0, 510.0, 670.0), (630.0, 130.0, 510.0, 670.0))


def _label(
    text: str, x: float, y: float, size: float = style.SMALL_TEXT, tone: str = style.INK
) -> scene.Label:
    return scene.Label(text, (x, y, 0.0), tone, size, anchor="cn", halo=False)


def band(pair: Shape, part: float) -> Array:
    """The triangles at some part of the way from nose to tail."""
    along = pair.along[pair.faces]
    part = float(np.clip(part, 1e-9, 1.0 - 1e-9))
    return np.flatnonzero((along.min(axis=1) <= part) & (part <= along.max(axis=1)))


def ends(pair: Shape, part: float) -> scene.Picture:
    """Return both shapes, equal colours for corresponding places; a band of triangles is marked in both."""
    colors = style.ramp(pair.along, marks.TONES)
    lit = band(pair, part)
    places = [fit(V, box) for V, box in zip((pair.source, pair.target), _ENDS, strict=True)]
    scale = min(place.scale for place in places)
    records: list[scene.Record] = []
    for V, box, name in zip((pair.source, pair.target), _ENDS, ("source $P$", "target $Q$"), strict=True):
        place = fit(V, box, scale)
        records += marks.drawn(place, pair, V, colors, eye=0.035 * scale)
        records.append(scene.Surface(place.at(V), pair.faces[lit], style.GREYS[0], material="flat"))
        outline = place.at(V[pair.faces[lit]])[:, [0, 1, 2, 0]]
        records.append(scene.Lines(marks.broken(outline), style.PAPER, style.HAIR))
        records.append(_label(name, box[0] + 0.5 * box[2], _TITLE, style.TITLE_TEXT))
    m, n = len(pair.faces), len(pair.source)
    records.append(_label(f"{n} vertices, {m} triangles; dark: the same {len(lit)} in both", 600.0, 58.0))
    return scene.Picture((scene.View(tuple(records)),))


def between(
    pair: Shape, t: float, middle: list[scene.Record], place: Plane, title: str, said: str
) -> scene.Picture:
    """Return a moment, large, between the small source and the small target."""
    records: list[scene.Record] = []
    for V, x, name, moment in (
        (pair.source, 24.0, "source $P$", 0.0),
        (pair.target, 936.0, "target $Q$", 1.0),
    ):
        there = fit(V, (x, 250.0, 240.0, 460.0), 0.5 * place.scale)
        records += marks.drawn(there, pair, V, marks.color_at(moment), eye=0.018 * place.scale)
        records.append(_label(name, x + 120.0, _TITLE, style.TITLE_TEXT))
    records += middle
    records.append(_label(title, 600.0, _TITLE, style.TITLE_TEXT))
    records.append(_label(said, 600.0, 58.0))
    return scene.Picture((scene.View(tuple(records)),))


def stage(pair: Shape, extents: Array) -> Plane:
    """The place of the moment between: all of `extents` (..., 2) fits into it."""
    return fit(extents.reshape(-1, 2), (290.0, 110.0, 620.0, 700.0))


def torn(pair: Shape, corners: Array, place: Plane, t: float, said: str) -> scene.Picture:
    """Return the triangles at time t, each by its own map, torn apart."""
    middle = marks.scattered(place, corners, marks.color_at(t))
    return between(pair, t, middle, place, rf"local: $A_i(t)$, $t = {t:.2f}$", said)


def stitched(
    pair: Shape, V: Array, flipped: Array, place: Plane, t: float, said: str, shown: list[scene.Record]
) -> scene.Picture:
    """Return the shape at time t, and what constraints there are."""
    middle = marks.drawn(place, pair, V, marks.color_at(t), flipped=flipped, eye=0.035 * place.scale)
    return between(pair, t, middle + shown, place, rf"global: $B_i(t)$, $t = {t:.2f}$", said)


def page(extents: Array) -> Plane:
    """The place of a shape that has the page for itself."""
    return fit(extents.reshape(-1, 2), (60.0, 60.0, 1080.0, 780.0))


def alone(
    pair: Shape, V: Array, flipped: Array, place: Plane, t: float, shown: list[scene.Record]
) -> scene.Picture:
    """Return nothing but the shape at time t, and what constraints there are."""
    drawn = marks.drawn(place, pair, V, marks.color_at(t), flipped=flipped, eye=0.035 * place.scale)
    return scene.Picture((scene.View((*drawn, *shown)),))


def shown_maps(pair: Shape) -> Array:
    """Three triangles whose maps are shown: all of three, or some along the shape."""
    along = pair.along[pair.faces].mean(axis=1)
    if len(along) <= 3:
        return np.arange(len(along))
    return np.array([int(np.argmin(np.abs(along - part))) for part in (0.12, 0.45, 0.8)])


def maps(pair: Shape, at: Array, t: float) -> scene.Picture:
    """Return both shapes with some triangles coloured, and below, each of these under its map A_i(t)."""
    chosen = shown_maps(pair)
    tones = style.SHELL_FILLS
    boxes = ((80.0, 430.0, 440.0, 340.0), (680.0, 430.0, 440.0, 340.0))
    scale = min(fit(V, box).scale for V, box in zip((pair.source, pair.target), boxes, strict=True))
    records: list[scene.Record] = []
    few = len(pair.faces) <= 8
    for V, box, title, point in zip(
        (pair.source, pair.target), boxes, ("source $P$", "target $Q$"), ("p", "q"), strict=True
    ):
        place = fit(V, box, scale)
        records += marks.drawn(place, pair, V, style.BEFORE, eye=0.06 * scale)
        for k, i in enumerate(chosen):
            records += _lit(place, V[pair.faces[i]], tones[k])
            if few:
                middle = place.at(V[pair.faces[i]].mean(axis=0))
                records.append(scene.Label(rf"$\tau_{i + 1}$", middle, style.INK, style.TEXT, halo=False))
        if few:
            records += _points(place, V, point)
        records.append(_label(title, box[0] + 0.5 * box[2], _TITLE, style.TITLE_TEXT))
    records += _below(pair, chosen, at, tones)
    records.append(_label(rf"dashed: before; filled: under $A_i(t)$, $t = {t:.2f}$", 600.0, 58.0))
    return scene.Picture((scene.View(tuple(records)),))


def _lit(place: Plane, corners: Array, tone: str, alpha: float = 1.0) -> list[scene.Record]:
    at = place.at(corners)
    return [
        scene.Surface(at, [[0, 1, 2]], tone, material="flat", alpha=alpha),
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


def _below(pair: Shape, chosen: Array, at: Array, tones: tuple[str, ...]) -> list[scene.Record]:
    """Each triangle about its own centre: in the source dashed, under A_i(t) filled, and the matrix A_i."""
    corners = pair.source[pair.faces[chosen]]
    corners = corners - corners.mean(axis=1, keepdims=True)
    full = shape.local_maps(pair.source, pair.target, pair.faces)[chosen]
    sizes = [np.abs(corners).max(), np.abs(np.einsum("mij,mkj->mki", full, corners)).max()]
    scale = 74.0 / max(sizes)
    records: list[scene.Record] = []
    for k, i in enumerate(chosen):
        middle = 600.0 + 375.0 * (k - 0.5 * (len(chosen) - 1))
        place = Plane((middle - 108.0, 226.0), scale)
        before = np.concatenate([corners[k], corners[k, :1]])
        records += _lit(place, corners[k] @ at[i].T, tones[k])
        records.append(place.line(before, style.BEFORE_EDGE, style.EDGE, dash=(9.0, 7.0)))
        wide = brackets.width(full[k])
        records += brackets.matrix(full[k], middle - 18.0, 226.0)
        records.append(_label(rf"$A_{{{i + 1}}}$", middle - 18.0 + 0.5 * wide, 298.0))
    return records


def gaps(pair: Shape, corners: Array) -> Array:
    """How far the corners that belong to one vertex lie apart, at most, for each vertex (n,)."""
    flat, number = corners.reshape(-1, 2), pair.faces.ravel()
    count = np.bincount(number)[:, None]
    mean = np.stack([np.bincount(number, flat[:, k]) for k in (0, 1)], axis=1) / count
    far = np.zeros(len(count))
    np.maximum.at(far, number, np.linalg.norm(flat - mean[number], axis=1))
    return far


def side(pair: Shape) -> float:
    """The typical length of an edge in the source."""
    e = topology.edges("global_interp", pair.faces).ends
    return float(np.median(np.linalg.norm(pair.source[e[:, 0]] - pair.source[e[:, 1]], axis=1)))
