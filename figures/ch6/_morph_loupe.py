"""A larger ring beside a strip: in a film always the same triangles of one column, at one place and scale."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.interp import shape
from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.plane import Plane
from lietool.render.theme import Color

from . import _morph_marks as marks
from ._morph_row import Strip, ring, times

Array = np.ndarray

# The smallest and the largest radius; how much of it is filled half way, and the white around it then.
_SMALLEST, _LARGEST, _FILLED, _WHITE = 52.0, 96.0, 0.9, 12.0
# It is at least so much larger than the strip.
_LEAST = 2.0

Place = Callable[[int, float], Plane]
"""The plane of a column at a time."""


@dataclass(frozen=True, eq=False)
class Loupe:
    """What is seen larger: triangles of a column that are turned over half way, and these with neighbours.

    `spot` is the middle on the page, `radius` in its units, and `scale` how large the shape is.
    """

    k: int
    some: Array
    near: Array
    spot: Array
    radius: float
    scale: float


def found(strip: Strip, place: Place, box: Box) -> Loupe | None:
    """Return what is seen larger in a box of the page, which shapes leave free; None without such or room.

    It is chosen when t is half way, whatever t is, so that nothing jumps in a film.
    """
    columns, faces = len(strip.frames.t), strip.way.pair.faces
    half = strip.way.at(times(0.5, columns // 2))
    turned = half.flipped.sum(axis=1)
    k = int(np.argmax(turned))
    if not 0 < turned[k] < marks.FEW * len(faces):
        return None
    some = max(marks.clusters(strip.way.pair, half.flipped[k]), key=len)
    near = np.flatnonzero(np.isin(faces, faces[some]).any(axis=1))
    spot, free = marks.empty(_drawn(half, place), box)
    radius = min(free - _WHITE, _LARGEST, _clear(strip, place, np.array(spot)))
    scale = _FILLED * radius / marks.middle(half.vertices[k][faces[near]].reshape(-1, 2))[1]
    if radius < _SMALLEST or scale < _LEAST * place(k, 0.5).scale:
        return None
    return Loupe(k, some, near, np.array(spot), radius, scale)


def _drawn(frames: shape.Result, place: Place) -> Array:
    """Where on the page the vertices of all columns are, (n, 2)."""
    shown = zip(frames.t.tolist(), frames.vertices, strict=True)
    return np.concatenate([place(k, t).at(V)[:, :2] for k, (t, V) in enumerate(shown)])


def _clear(strip: Strip, place: Place, spot: Array) -> float:
    """How near to a place on the page any column comes in a film."""
    steps, measured = len(strip.frames.t) // 2, strip.way.measured
    nearest = np.inf
    for k in range(2 * steps + 1):
        first, last = (0.0, k / steps) if k <= steps else (k / steps - 1.0, 1.0)
        for t, V in zip(measured.t.tolist(), measured.vertices, strict=True):
            if first <= t <= last:
                at = place(k, t)
                far = np.linalg.norm(V - (spot - at.origin) / at.scale, axis=1)
                nearest = min(nearest, at.scale * float(far.min()))
    return nearest


def draw(loupe: Loupe, strip: Strip, place: Place) -> list[scene.Record]:
    """Return the ring with what is in it, cut off at it, and a line from where that is in the strip."""
    k, faces = loupe.k, strip.way.pair.faces
    t, V, turned = float(strip.frames.t[k]), strip.frames.vertices[k], strip.frames.flipped[k]
    middle, _ = marks.middle(V[faces[loupe.near]].reshape(-1, 2))
    glass = Plane((*(loupe.spot - loupe.scale * middle),), loupe.scale)
    reach = loupe.radius / loupe.scale
    over = turned[loupe.near]
    tone = style.WRONG if over.any() else style.MUTED
    right, wrong = (V[faces[loupe.near[chosen]]] for chosen in (~over, over))
    return [
        *_linked(loupe, place(k, t), V[faces[loupe.some]].reshape(-1, 2), tone),
        *_pieces(glass, right, middle, reach, (marks.color_at(t), 1.0), (style.INK, style.HAIR)),
        *_pieces(glass, wrong, middle, reach, (style.WRONG, 0.85), (style.WRONG, style.EDGE)),
        Plane((0.0, 0.0), 1.0).circle(loupe.spot, loupe.radius, tone, style.EDGE),
    ]


def _linked(loupe: Loupe, at: Plane, points: Array, tone: str) -> list[scene.Record]:
    """A ring round points (n, 2) of the strip, and a line from it to the loupe."""
    small = ring(at, points, tone)
    rim = np.asarray(small.points)[:, :2]
    start = at.at(marks.middle(points)[0])[:2]
    link = loupe.spot - start
    length, around = float(np.linalg.norm(link)), float(np.linalg.norm(rim[0] - start))
    if length <= loupe.radius + around:
        return [small]
    line = start + np.outer([around / length, 1.0 - loupe.radius / length], link)
    return [small, scene.Lines(np.pad(line, ((0, 0), (0, 1))), tone, style.THIN)]


def _pieces(
    glass: Plane,
    triangles: Array,
    middle: Array,
    reach: float,
    fill: tuple[Color, float],
    line: tuple[str, float],
) -> list[scene.Record]:
    """Triangles (m, 3, 2) as far as they lie in a circle, with their edges."""
    kept, _ = marks.within(triangles, np.zeros(len(triangles)), middle, reach)
    if not len(kept):
        return []
    at = glass.at(kept.reshape(-1, 2))
    inner = np.arange(len(at)).reshape(-1, 3)
    records: list[scene.Record] = [scene.Surface(at, inner, fill[0], material="flat", alpha=fill[1])]
    whole = (np.linalg.norm(triangles - middle, axis=-1) <= reach).all(axis=1)
    closed = triangles[:, [0, 1, 2, 0]]
    if whole.any():
        records.append(scene.Lines(marks.broken(glass.at(closed[whole])), *line))
    sides = np.stack([closed[~whole][:, :-1], closed[~whole][:, 1:]], axis=2).reshape(-1, 2, 2)
    ends = marks.cut(sides, middle, reach)
    if len(ends):
        records.append(scene.Lines(marks.broken(glass.at(ends)), *line))
    return records
