"""One frame of a strip: the shape, what constraints hold of it, and where it is turned over."""

from dataclasses import dataclass

import numpy as np

from lietool.interp import shape
from lietool.render import scene, style
from lietool.render.plane import Plane, path
from lietool.render.plot import number

from . import _morph
from . import _morph_marks as marks

Array = np.ndarray

LEFT, RIGHT = 40.0, 1160.0
# How far the line of a given direction reaches, over the size of the shape.
_REACH = 0.62
# Of the curves that vertices follow: the first solid, the second dashed; and how pale they are ahead.
_DASHES = (None, (7.0, 5.0))
_AHEAD = 0.45
# White between a triangle that is turned over and its ring.
_RING = 9.0


@dataclass(frozen=True, eq=False)
class Strip:
    """A way with its name, in phrases, and its frames at some times; compared with the way back, or not."""

    name: tuple[str, ...]
    way: _morph.Way
    frames: shape.Result
    both: bool = False


@dataclass(frozen=True)
class Row:
    """Where a row stands: lower and upper end of its shapes, and where its columns begin and end."""

    low: float
    high: float
    left: float = LEFT
    right: float = RIGHT

    def x(self, k: int, columns: int) -> float:
        """The middle of a column."""
        return self.left + (k + 0.5) * (self.right - self.left) / columns


def shift(way: _morph.Way, t: Array | float) -> Array:
    """What is at the middle of a column: that of the shape, or where curves are drawn, theirs."""
    x = way.measured.vertices[..., 0]
    middle = 0.5 * (x.min(axis=1) + x.max(axis=1))
    if way.led.loci:
        return np.full(np.shape(t), 0.5 * (middle[0] + middle[-1]))
    return np.interp(t, way.measured.t, middle)


def window(ways: list[_morph.Way]) -> tuple[float, float, float, float]:
    """What a column must hold, at all times: left and right of its middle, and heights."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for way in ways:
        V = way.measured.vertices.copy()
        V[..., 0] -= shift(way, way.measured.t)[:, None]
        points = [V.reshape(-1, 2)]
        for _, curve in way.led.loci:
            points.append(np.asarray(curve(way.measured.t)) - [shift(way, 0.0), 0.0])
        every = np.concatenate(points)
        low, high = np.minimum(low, every.min(axis=0)), np.maximum(high, every.max(axis=0))
    side = max(-low[0], high[0])
    return -side, side, float(low[1]), float(high[1])


def place(way: _morph.Way, moment: float, x: float, middle: float, scale: float, size: tuple) -> Plane:
    """The plane of a frame whose column's middle is at x and whose window (`size`) has its at `middle`."""
    base = middle - 0.5 * scale * (size[2] + size[3])
    return Plane((x - scale * float(shift(way, moment)), base), scale)


def frame(strip: Strip, k: int, at: Plane) -> list[scene.Record]:
    """One frame of a strip in its plane."""
    way, moment = strip.way, float(strip.frames.t[k])
    V, turned = strip.frames.vertices[k], strip.frames.flipped[k]
    records = loci(at, way, moment)
    records += marks.drawn(
        at, way.pair, V, marks.color_at(moment), flipped=turned, eye=min(0.07 * at.scale, 4.5)
    )
    if strip.both:
        back = way.back(np.array([moment]))[0]
        points, _, _, rim = marks.skin(way.pair, back)
        records.append(at.line(points[rim], style.ROUTE_2, 1.3 * style.EDGE, dash=(7.0, 5.0)))
    return [*records, *held(at, way, V, moment)]


def row(strip: Strip, there: Row, scale: float, size: tuple) -> list[scene.Record]:
    """All frames of a strip beside each other, and the curve of the barycentre over them."""
    frames, columns, middle = strip.frames, len(strip.frames.t), 0.5 * (there.low + there.high)
    records: list[scene.Record] = []
    for k, moment in enumerate(frames.t.tolist()):
        at = place(strip.way, moment, there.x(k, columns), middle, scale, size)
        records += [*frame(strip, k, at), *rings(at, strip, k)]
    led = strip.way.led
    if led.barycentre is not None and (led.line is not None or led.named):
        fine = np.linspace(0.0, 1.0, 4 * _morph.MOMENTS)
        curve = np.asarray(led.barycentre(fine))
        x = np.interp(fine, frames.t, [there.x(k, columns) for k in range(columns)])
        across = x + scale * (curve[:, 0] - shift(strip.way, fine))
        base = middle - 0.5 * scale * (size[2] + size[3])
        line = np.stack([across, base + scale * curve[:, 1], np.zeros_like(x)], axis=1)
        records.append(scene.Lines(line, style.ROUTE_1, style.THIN, dash=(9.0, 7.0)))
    return records


def times(t: float, steps: int) -> Array:
    """The times of a strip's columns: so many steps from 0 to t, and as many on to 1."""
    return np.concatenate([np.linspace(0.0, t, steps + 1), np.linspace(t, 1.0, steps + 1)[1:]])


def count(strip: Strip, k: int) -> tuple[str, str]:
    """How many triangles of a frame are turned over, and the colour in which that is said."""
    found = int(strip.frames.flipped[k].sum())
    return f"{found} flipped", style.WRONG if found else style.MUTED


def text(said: str, x: float, y: float, tone: str = style.INK, anchor: str = "cn") -> scene.Label:
    """Small text on a line."""
    return scene.Label(said, (x, y, 0.0), tone, style.SMALL_TEXT, anchor=anchor, halo=False)


def moment(t: float) -> str:
    """The time of a frame."""
    return f"$t = {number(t)}$"


def rings(at: Plane, strip: Strip, k: int, but: Array | None = None) -> list[scene.Record]:
    """Where few triangles are turned over, rings that show where; none round those among `but`."""
    turned, V = strip.frames.flipped[k], strip.frames.vertices[k]
    if not 0 < turned.sum() < marks.FEW * len(turned):
        return []
    records: list[scene.Record] = []
    for some in marks.clusters(strip.way.pair, turned):
        if but is None or not np.isin(some, but).all():
            records.append(ring(at, V[strip.way.pair.faces[some]].reshape(-1, 2)))
    return records


def ring(at: Plane, points: Array, tone: str = style.WRONG) -> scene.Lines:
    """A ring round points (n, 2)."""
    center, reach = marks.middle(points)
    return at.circle(center, reach + _RING / at.scale, tone, style.EDGE)


def loci(at: Plane, way: _morph.Way, t: float) -> list[scene.Record]:
    """The curves that vertices follow, strong as far as they have come."""
    records: list[scene.Record] = []
    count = 4 * _morph.MOMENTS
    for (_, curve), dash in zip(way.led.loci, _DASHES, strict=False):
        ahead = at.at(np.asarray(curve(np.linspace(t, 1.0, count))))
        behind = np.asarray(curve(np.linspace(0.0, t, count)))
        whole = at.at(np.asarray(curve(np.linspace(0.0, 1.0, count))))
        records.append(scene.Lines(ahead, style.ROUTE_1, style.EDGE, alpha=_AHEAD, dash=dash))
        # Of the whole curve only the head, at its end.
        records += path(whole, style.ROUTE_1, style.EDGE)[1:]
        if t > 0.0:
            records.append(at.line(behind, style.ROUTE_1, 1.3 * style.EDGE, dash=dash))
    return records


def held(at: Plane, way: _morph.Way, V: Array, t: float) -> list[scene.Record]:
    """What the constraints hold: the vertices on curves, the edge or its line, the barycentre."""
    records: list[scene.Record] = []
    dots = [V[v] for v, _ in way.led.loci]
    if way.led.line is not None:
        ends, along = V[list(way.led.line.ends)], way.led.line.along(t)
        reach = _REACH * float(np.ptp(V, axis=0).max())
        line = ends.mean(axis=0) + np.multiply.outer([-reach, reach], along)
        records.append(at.line(line, style.ROUTE_1, style.EDGE, dash=(9.0, 7.0)))
        records.append(scene.Points(at.at(ends), style.ROUTE_1, 4.5, shaded=False))
    if way.led.edge is not None:
        a, b = V[list(way.led.edge)]
        if way.led.named:
            records += path(at.at(np.stack([b, a])), style.ROUTE_1, 1.3 * style.EDGE)
        else:
            records.append(at.line(np.stack([b, a]), style.ROUTE_1, style.CURVE))
            records.append(scene.Points(at.at(np.stack([a, b])), style.ROUTE_1, 4.5, shaded=False))
    if way.led.barycentre is not None:
        dots.append(V.mean(axis=0))
    if dots:
        spots = at.at(np.array(dots))
        records.append(scene.Points(spots, style.ROUTE_1, 6.5, rim=style.PAPER, shaded=False))
    return records
