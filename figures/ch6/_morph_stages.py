"""The pages before the strips: both shapes, and one moment between them, all at one scale."""

from dataclasses import dataclass

import numpy as np

from lietool.mesh import topology
from lietool.mesh.shapes import Shape
from lietool.render import scene, style
from lietool.render.plane import Plane, fit

from . import _morph_marks as marks

Array = np.ndarray

_TITLE, _LOWEST = 846.0, 58.0
# Boxes of the two shapes alone.
_ENDS = ((60.0, 116.0, 510.0, 682.0), (630.0, 116.0, 510.0, 682.0))
# White at the sides and between shapes, and the heights that they may fill.
_SIDE, _BETWEEN, _LOW, _HIGH = 36.0, 30.0, 104.0, 806.0
# Places with a number, how far numbers lie from them, and the largest ring.
_NAMED, _AWAY, _RING = 8, 25.0, 118.0


def label(
    text: str, x: float, y: float, size: float = style.SMALL_TEXT, tone: str = style.INK
) -> scene.Label:
    """Text in the middle of a line."""
    return scene.Label(text, (x, y, 0.0), tone, size, anchor="cn", halo=False)


def band(pair: Shape, part: float) -> Array:
    """The triangles at some part of the way from nose to tail."""
    along = pair.along[pair.faces]
    part = float(np.clip(part, 1e-9, 1.0 - 1e-9))
    return np.flatnonzero((along.min(axis=1) <= part) & (part <= along.max(axis=1)))


def tips(pair: Shape) -> Array:
    """Some places of the outline, in its order from the nose: the nose, the tail, and what juts out.

    These are farther from the middle of the source, along its edges, than the outline on either side.
    """
    ends = topology.edges("global_interp", pair.faces).ends
    length = np.linalg.norm(pair.source[ends[:, 0]] - pair.source[ends[:, 1]], axis=1)
    far = np.full(len(pair.source), np.inf)
    far[int(np.argmin(np.linalg.norm(pair.source - pair.source.mean(axis=0), axis=1)))] = 0.0
    while True:
        before = far.copy()
        np.minimum.at(far, ends[:, 0], before[ends[:, 1]] + length)
        np.minimum.at(far, ends[:, 1], before[ends[:, 0]] + length)
        if np.array_equal(before, far):
            break
    rim = np.roll(pair.boundary, -int(np.argmax(pair.boundary == pair.marks["nose"])))
    along, count = far[rim], len(rim)
    if count <= _NAMED:
        return rim
    near = max(3, count // 25)
    around = np.stack([np.roll(along, k) for k in range(-near, near + 1)])
    juts = np.flatnonzero(along >= around.max(axis=0))
    # An outline that is jagged has too many: the farthest serve.
    juts = juts[np.argsort(-along[juts], kind="stable")][:_NAMED]
    named = set(rim[juts].tolist())
    for name in ("nose", "tail"):
        # A tip with a name stands for what juts out beside it.
        at = int(np.argmax(rim == pair.marks[name]))
        beside = {int(rim[(at + k) % count]) for k in range(-near, near + 1)}
        named = (named - beside) | {pair.marks[name]}
    return rim[np.isin(rim, list(named))]


def ends(pair: Shape, part: float) -> scene.Picture:
    """Return both shapes, equal colours and numbers for corresponding places; a band is marked in both."""
    lit = band(pair, part)
    scale = min(fit(V, box).scale for V, box in zip((pair.source, pair.target), _ENDS, strict=True))
    records: list[scene.Record] = []
    for V, box, name in zip((pair.source, pair.target), _ENDS, ("source $P$", "target $Q$"), strict=True):
        place = fit(V, box, scale)
        records += marks.drawn(place, pair, V, style.INK, values=pair.along, eye=0.035 * scale)
        points, faces, owner, _ = marks.skin(pair, V)
        among = faces[np.isin(owner, lit)]
        records.append(scene.Surface(place.at(points), among, style.GREYS[0], material="flat"))
        outline = place.at(V[pair.faces[lit]])[:, [0, 1, 2, 0]]
        records.append(scene.Lines(marks.broken(outline), style.GREYS[1], style.HAIR))
        records += _numbers(place, pair, V)
        records.append(label(name, box[0] + 0.5 * box[2], _TITLE, style.TITLE_TEXT))
    m, n = len(pair.faces), len(pair.source)
    said = f"{n} vertices, {m} triangles; dark: the same {len(lit)} triangles in both"
    records.append(label(said, 600.0, 46.0))
    return scene.Picture((scene.View(tuple(records)),))


def _numbers(place: Plane, pair: Shape, V: Array) -> list[scene.Record]:
    """Some vertices of the outline with numbers beside them, outside."""
    chosen, rim = tips(pair), pair.boundary
    at = np.array([int(np.argmax(rim == v)) for v in chosen])
    before, after = V[rim[at - 1]], V[rim[(at + 1) % len(rim)]]
    # A tip points away from its neighbours; a side points to the right of the way along it.
    chord = after - before
    out = np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    records: list[scene.Record] = [place.dots(V[chosen], style.INK, 6.0)]
    for k, v in enumerate(chosen):
        records.append(
            place.beyond(f"{k + 1}", V[v], out[k], size=style.SMALL_TEXT, gap=_AWAY, room=_AWAY + 16.0)
        )
    return records


@dataclass(frozen=True)
class Stage:
    """Where the source, the moment between and the target are, at one scale."""

    source: Plane
    between: Plane
    target: Plane
    middles: tuple[float, float, float]


def stage(pair: Shape, extents: Array) -> Stage:
    """Return the places; all of `extents` (..., 2) fits between the source and the target."""
    shapes = [pair.source, extents.reshape(-1, 2), pair.target]
    wide, tall = np.array([np.ptp(V, axis=0) for V in shapes]).T
    room = 1200.0 - 2.0 * (_SIDE + _BETWEEN)
    scale = min(room / wide.sum(), (_HIGH - _LOW) / tall.max())
    # What is left goes between the three.
    spare = (room - scale * wide.sum()) / 4.0
    planes, middles, left = [], [], _SIDE
    for k, V in enumerate(shapes):
        box = (left + spare * (0.5 if k == 0 else 1.0), _LOW, scale * wide[k], _HIGH - _LOW)
        planes.append(fit(V, box, scale))
        middles.append(box[0] + 0.5 * box[2])
        left = box[0] + box[2] + _BETWEEN
    return Stage(planes[0], planes[1], planes[2], (middles[0], middles[1], middles[2]))


def _between(pair: Shape, places: Stage, drawn: list[scene.Record], title: str, said: str) -> scene.Picture:
    """Return a moment between the source and the target."""
    records: list[scene.Record] = []
    for V, place, x, name, moment in (
        (pair.source, places.source, places.middles[0], "source $P$", 0.0),
        (pair.target, places.target, places.middles[2], "target $Q$", 1.0),
    ):
        records += marks.drawn(place, pair, V, marks.color_at(moment), eye=0.035 * place.scale)
        records.append(label(name, float(np.clip(x, 120.0, 1080.0)), _TITLE, style.TITLE_TEXT))
    records += drawn
    records.append(label(title, places.middles[1], _TITLE, style.TITLE_TEXT))
    records.append(label(said, 600.0, _LOWEST))
    return scene.Picture((scene.View(tuple(records)),))


def torn(
    pair: Shape, corners: Array, places: Stage, t: float, gap: float, half: Array, reached: Array
) -> scene.Picture:
    """Return the triangles at time t, each by its own map, torn apart; and two neighbours, larger.

    Which ones is said by `half`, the triangles half way; `reached` (k, 2) is what corners reach at any time:
    there the ring is not.
    """
    drawn = marks.scattered(places.between, pair, corners, marks.color_at(t))
    drawn += _neighbours(pair, corners, half, places, t, reached)
    said = f"corners of one vertex lie up to {gap:.1f} edge lengths from their mean"
    return _between(pair, places, drawn, rf"local: $A_i(t)$, $t = {t:.2f}$", said)


def _neighbours(
    pair: Shape, corners: Array, half: Array, places: Stage, t: float, reached: Array
) -> list[scene.Record]:
    """A ring with two neighbours and their common edge in both, as each has it."""
    ends = places.source.at(pair.source), places.between.at(reached), places.target.at(pair.target)
    box = (_SIDE, _LOW - 10.0, 1200.0 - 2.0 * _SIDE, _HIGH - _LOW)
    center, free = marks.empty(np.concatenate(ends)[:, :2], box)
    radius = min(free - 10.0, _RING)
    toward = (np.array(center) - places.between.origin) / places.between.scale
    pair_of, edges = shared(pair, corners, half, toward)
    both = corners[pair_of].reshape(-1, 2)
    middle, reach = marks.middle(both)
    larger = 0.84 * radius / max(reach, 1e-9)
    if radius < 60.0 or larger < 1.5 * places.between.scale:
        return []
    loupe = Plane((center[0] - larger * middle[0], center[1] - larger * middle[1]), larger)
    records: list[scene.Record] = []
    there, around = places.between.at(middle)[:2], reach * places.between.scale + 6.0
    link = np.array(center) - there
    length = float(np.linalg.norm(link))
    if length > radius + around:
        line = there + np.outer([around / length, 1.0 - radius / length], link)
        records.append(scene.Lines(np.pad(line, ((0, 0), (0, 1))), style.MUTED, style.THIN))
    page = Plane((0.0, 0.0), 1.0)
    records += [page.circle(there, around, style.MUTED), page.circle(center, radius, style.MUTED)]
    for triangle in corners[pair_of]:
        at = loupe.at(triangle)
        records.append(scene.Surface(at, [[0, 1, 2]], marks.color_at(t), material="flat"))
        records.append(scene.Lines(at[[0, 1, 2, 0]], style.INK, style.THIN))
    for edge, tone, dash in zip(edges, (style.ROUTE_1, style.ROUTE_2), (None, (9.0, 6.0)), strict=True):
        records.append(loupe.line(edge, tone, 1.5 * style.CURVE, dash=dash))
    return records


def shared(pair: Shape, corners: Array, half: Array, toward: Array) -> tuple[Array, Array]:
    """Two neighbours (2,) that lie apart, and their common edge (2, 2, 2) as each of them has it.

    Half way, their edge lies apart by about half its length, or as near to that as any does; of these they
    are the nearest to some point.
    """
    faces, m, n = pair.faces, len(pair.faces), len(pair.source)
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    keys, back = ends[:, 0] * n + ends[:, 1], ends[:, 1] * n + ends[:, 0]
    order = np.argsort(keys)
    found = order[np.minimum(np.searchsorted(keys[order], back), 3 * m - 1)]
    inner = np.flatnonzero((keys[found] == back) & (ends[:, 0] < ends[:, 1]))

    def edges(V: Array) -> Array:
        where = np.stack([V, np.roll(V, -1, axis=1)], axis=2).reshape(-1, 2, 2)
        return np.stack([where[inner], where[found[inner]][:, ::-1]], axis=1)

    there = edges(half)
    apart = np.linalg.norm(there[:, 0] - there[:, 1], axis=-1).mean(axis=1)
    off = np.abs(apart / np.linalg.norm(there[:, 0, 0] - there[:, 0, 1], axis=-1) - 0.55)
    far = np.linalg.norm(there.mean(axis=(1, 2)) - toward, axis=-1)
    k = int(np.argmin(np.where(off <= max(0.25, float(off.min())), far, np.inf)))
    return np.array([inner[k], found[inner[k]]]) // 3, edges(corners)[k]


def stitched(
    pair: Shape, V: Array, flipped: Array, places: Stage, t: float, said: str, shown: list[scene.Record]
) -> scene.Picture:
    """Return the shape at time t, and what constraints there are."""
    place = places.between
    drawn = marks.drawn(place, pair, V, marks.color_at(t), flipped=flipped, eye=0.035 * place.scale)
    return _between(pair, places, drawn + shown, rf"global: $B_i(t)$, $t = {t:.2f}$", said)


def page(extents: Array) -> Plane:
    """The place of a shape that has the page for itself."""
    return fit(extents.reshape(-1, 2), (60.0, 60.0, 1080.0, 780.0))


def alone(
    pair: Shape, V: Array, flipped: Array, place: Plane, t: float, shown: list[scene.Record]
) -> scene.Picture:
    """Return nothing but the shape at time t, and what constraints there are."""
    drawn = marks.drawn(place, pair, V, marks.color_at(t), flipped=flipped, eye=0.035 * place.scale)
    return scene.Picture((scene.View((*drawn, *shown)),))


def gaps(pair: Shape, corners: Array) -> Array:
    """How far the corners that belong to one vertex lie from their mean, at most, for each vertex (n,)."""
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
