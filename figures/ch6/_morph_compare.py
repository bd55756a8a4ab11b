"""Two ways at one moment, large: where each of them puts the error, and how that goes with the area."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lietool.mesh import topology
from lietool.mesh.shapes import Shape
from lietool.render import scene, style
from lietool.render.plane import Plane, fit
from lietool.render.plot import Axes

from . import _morph, _morph_plots
from . import _morph_marks as marks
from ._morph_row import Strip, held, loci, text

Array = np.ndarray

# From no error to the most that is told apart.
TONES = (style.PAPER, style.BETWEEN, style.AXIS_Z)
_TITLE, _SIDE, _TOP, _LOW = 846.0, 40.0, 780.0, 424.0
_PLOT, _BACK = (120.0, 104.0, 350.0, 226.0), (120.0, 92.0, 330.0, 238.0)
# Middles of the larger rings, and their radius.
_LOUPES, _RADIUS = ((662.0, 206.0), (902.0, 206.0)), 112.0
_LOUPES_BACK = ((718.0, 206.0), (1002.0, 206.0))
# Which part of the errors is large, and how much of the size of a shape is seen larger.
_WORST, _PART = 0.88, 0.085
_BAR = (1056.0, 110.0, 26.0, 190.0)
# Errors that are 0 but for rounding.
_NOISE = 1e-9
# Of triangles, in the plot.
_DOTS = (4.4, 3.2)


def errors(strip: Strip) -> Array:
    """How far each map is from the one that it should be, |B_i - A_i|, in the first frame; shape (m,)."""
    way, found = strip.way, strip.frames
    A = _morph.HOMOTOPIES[way.choice.homotopy](way.prepared.maps, float(found.t[0]), way.theta)
    return np.linalg.norm(found.jacobians[0] - A, axis=(-2, -1))


def picture(strips: Sequence[Strip], t: float) -> scene.Picture:
    """Return two ways beside each other at one moment, a part of each larger, and what tells them apart.

    That is the errors of their triangles, by which these are coloured; or the way back, which is dashed.
    """
    both = strips[0].both
    error = [errors(strip) for strip in strips]
    most = _most(error)
    pair = strips[0].way.pair
    reached = [strip.way.measured.vertices.reshape(-1, 2) for strip in strips]
    every = np.concatenate([*reached, pair.source, pair.target])
    panels = [Panel(strip, None if both else e / most) for strip, e in zip(strips, error, strict=True)]
    parts = _turned_back(panels) if both else _worst(panels, max(error, key=np.max))
    width = (1200.0 - 3.0 * _SIDE) / 2.0
    records: list[scene.Record] = []
    for k, (panel, middle) in enumerate(zip(panels, parts.middles, strict=True)):
        place = fit(every, (_SIDE + k * (width + _SIDE), _LOW, width, _TOP - _LOW))
        records += [*_ghosts(place, pair), *loci(place, panel.strip.way, t), *panel.draw(place)]
        records += held(place, panel.strip.way, panel.V, t)
        records += _larger(panel, place, middle, parts.reach, (_LOUPES_BACK if both else _LOUPES)[k])
        records += _said(panel.strip, k, _SIDE + k * (width + _SIDE) + 0.5 * width, t)
    if both:
        plot = _morph_plots.Plot(
            "way back: distance / size", [strip.way.asymmetry for strip in strips], "most", True
        )
        records += _morph_plots.one(plot, strips[0].way.measured.t, t, _BACK, _morph_plots.COLORS)
    else:
        records += [*_plot(strips, error, most), *_bar(most)]
    return scene.Picture((scene.View(tuple(records)),))


@dataclass(frozen=True, eq=False)
class Panel:
    """A way at its moment, its triangles coloured by numbers `part` from 0 to 1 where there are any."""

    strip: Strip
    part: Array | None

    @property
    def V(self) -> Array:
        """The vertices."""
        return self.strip.frames.vertices[0]

    @cached_property
    def back(self) -> Array | None:
        """The vertices on the way back, where it is compared with the way there."""
        return self.strip.way.back(self.strip.frames.t)[0] if self.strip.both else None

    def draw(self, place: Plane, center: Array | None = None, reach: float = np.inf) -> list[scene.Record]:
        """The shape; or only what lies within reach of some point."""
        pair, turned = self.strip.way.pair, self.strip.frames.flipped[0]
        points, faces, owner, rim = marks.skin(pair, self.V)
        whole = center is None
        middle = np.zeros(2) if center is None else center
        shown, who = (points[faces], owner) if whole else marks.within(points[faces], owner, middle, reach)
        color = marks.color_at(float(self.strip.frames.t[0]))
        if self.part is not None:
            color = style.ramp(np.repeat(np.clip(self.part[who], 0.0, 1.0), 3), TONES)
        over = pair.faces[turned]
        sides = np.stack([over, np.roll(over, -1, axis=1)], axis=-1).reshape(-1, 2)
        lines = (
            (marks.inner_edges(pair.faces), style.INK, style.HAIR, 0.5),
            (sides, style.WRONG, style.EDGE if whole else style.CURVE, 1.0),
            (np.stack([rim[:-1], rim[1:]], axis=1), style.INK, style.EDGE, 1.0),
        )
        flat = np.arange(3 * len(shown)).reshape(-1, 3)
        records: list[scene.Record] = []
        if len(flat):
            records.append(scene.Surface(place.at(shown).reshape(-1, 3), flat, color, material="flat"))
        for ends, tone, wide, alpha in lines:
            pieces = points[ends] if whole else marks.cut(points[ends], middle, reach)
            if len(pieces):
                records.append(scene.Lines(marks.broken(place.at(pieces)), tone, wide, alpha))
        eyes = [v for name, v in pair.marks.items() if name.startswith("eye")]
        if whole and eyes:
            records.append(scene.Points(place.at(self.V[eyes]), style.INK, 4.0, shaded=False))
        if self.back is not None:
            path = marks.skin(pair, self.back)[0][rim]
            if center is not None:
                path = np.where(np.linalg.norm(path - center, axis=1, keepdims=True) <= reach, path, np.nan)
            wide = 1.3 * style.EDGE if center is None else style.CURVE
            records.append(place.line(path, style.ROUTE_2, wide, dash=(7.0, 5.0)))
        return records


@dataclass(frozen=True)
class Parts:
    """What is shown larger: its middle in each panel, and how far it reaches."""

    middles: list[Array]
    reach: float


def _worst(panels: Sequence[Panel], error: Array) -> Parts:
    """What one of the ways has given up: of its largest errors, those that hang together."""
    pair = panels[0].strip.way.pair
    worst = marks.clusters(pair, error >= np.quantile(error, _WORST))
    some = pair.faces[max(worst, key=len)]
    found = [marks.middle(panel.V[some].reshape(-1, 2)) for panel in panels]
    return Parts([center for center, _ in found], 1.15 * max(reach for _, reach in found))


def _turned_back(panels: Sequence[Panel]) -> Parts:
    """Where the way back passes farthest from the way there, in the panel where it is farther off."""
    panel = max(panels, key=lambda p: p.strip.way.asymmetry.max())
    points, _, _, rim = marks.skin(panel.strip.way.pair, panel.V)
    back = points if panel.back is None else marks.skin(panel.strip.way.pair, panel.back)[0]
    # From the outline of the one to that of the other: along it, nothing is seen.
    far = np.linalg.norm(points[rim][:, None] - back[rim][None], axis=-1).min(axis=1)
    v = rim[np.argmax(far)]
    size = float(np.ptp(panels[1].strip.way.pair.source, axis=0).max())
    each = [marks.skin(p.strip.way.pair, p.V)[0][v] for p in panels]
    return Parts(each, _PART * size)


def _larger(panel: Panel, place: Plane, middle: Array, reach: float, center: tuple) -> list[scene.Record]:
    """A ring round a part of a panel, and the same part larger in another."""
    larger = _RADIUS / reach
    glass = Plane((center[0] - larger * middle[0], center[1] - larger * middle[1]), larger)
    start = place.at(middle)[:2]
    link = np.array(center) - start
    ends = np.array([reach * place.scale, np.linalg.norm(link) - _RADIUS]) / np.linalg.norm(link)
    line = np.pad(start + np.outer(ends, link), ((0, 0), (0, 1)))
    page = Plane((0.0, 0.0), 1.0)
    return [
        *panel.draw(glass, middle, reach),
        page.circle(start, reach * place.scale, style.MUTED),
        page.circle(center, _RADIUS, style.MUTED),
        scene.Lines(line, style.MUTED, style.THIN),
    ]


def _said(strip: Strip, k: int, middle: float, t: float) -> list[scene.Record]:
    """What a panel shows, and how many triangles are turned over in it."""
    color = _morph_plots.COLORS[k]
    det, turned = strip.frames.det[0], strip.frames.flipped[0]
    count = int(turned.sum())
    said = rf"{count} of {len(turned)} flipped, least $\det B_i = {{{det.min():.2f}}}$"
    tone = style.WRONG if count else style.MUTED
    name = f"{strip.name[0]}, $t = {t:.2f}$"
    left, anchor = (middle - 270.0 + 78.0, "ln") if strip.both else (middle, "cn")
    records: list[scene.Record] = [
        scene.Label(name, (left, _TITLE, 0.0), color[1], style.TITLE_TEXT, anchor=anchor, halo=False),
        text(said, left, _TITLE - 44.0, tone, anchor),
    ]
    if strip.both:
        sample = [(left - x, _TITLE + 9.0, 0.0) for x in (78.0, 16.0)]
        records.append(scene.Lines(sample, color[0], style.CURVE, dash=color[2]))
    return records


def _ghosts(place: Plane, pair: Shape) -> list[scene.Record]:
    """The outlines of source and target, with their names in them."""
    records: list[scene.Record] = []
    for V, tone, name, up in (
        (pair.source, marks.TONES[0], "$P$", -1.0),
        (pair.target, marks.TONES[2], "$Q$", 1.0),
    ):
        points, _, _, rim = marks.skin(pair, V)
        records.append(place.line(points[rim], tone, style.EDGE))
        at = V[np.argmax(up * V[:, 1])]
        records.append(place.beyond(name, at, (0.0, -up), size=style.SMALL_TEXT, gap=30.0, room=0.0))
    return records


def _most(error: list[Array]) -> float:
    """The error that has the strongest colour: hardly any triangle of the better way has more."""
    most = min(float(np.quantile(e, 0.97)) for e in error)
    return most if most > _NOISE else 1.0


def _plot(strips: Sequence[Strip], error: list[Array], most: float) -> list[scene.Record]:
    """The error of each triangle over its area, both by powers of ten."""
    pair = strips[0].way.pair
    area = topology.areas(pair.source, pair.faces)
    x = np.log10(area / area.mean())
    y = [np.log10(np.maximum(e, _NOISE)) for e in error]
    some = max(float(e.max()) for e in error) > _NOISE
    low = float(np.floor(min(np.quantile(v, 0.005) for v in y))) if some else -2.0
    high = max(float(np.ceil(max(v.max() for v in y))), low + 1.0)
    # Powers of ten need not begin with a whole one.
    left, right = float(x.min()) - 0.05, float(x.max()) + 0.05
    axes = Axes(_PLOT, (left, right), (low, high))
    step = max(1, int(np.ceil((high - low) / 4.0)))
    yticks = [(float(v), _ten(v)) for v in np.arange(low, high + 0.5, step)]
    xticks = [
        (np.log10(v), f"${v:g}$") for v in (0.02, 0.1, 0.5, 1.0, 2.0, 5.0) if left < np.log10(v) < right
    ]
    title = r"error $|B_i - A_i|$ of triangles"
    records = axes.frame(xticks, yticks, "", title, title_size=style.SMALL_TEXT)
    name = (0.5 * (_PLOT[0] + _PLOT[0] + _PLOT[2]), _PLOT[1] - 70.0, 0.0)
    records.append(
        scene.Label("area / mean area", name, style.INK, style.SMALL_TEXT, anchor="cn", halo=False)
    )
    # All of one size are taken or none: which comes first is a matter of rounding.
    large = x > np.sort(x)[-12:][0] - 1e-6
    heights = [float(axes.at(right, max(np.median(v[large]), low))[1]) for v in y]
    # Named beside the largest triangles, but not over each other.
    apart = 34.0 - abs(heights[0] - heights[1])
    up = heights[0] >= heights[1]
    for k in (0, 1):
        tone, type_, _ = _morph_plots.COLORS[k]
        keep = y[k] >= low
        if keep.any():
            records.append(scene.Points(axes.at(x[keep], y[k][keep]), tone, _DOTS[k], shaded=False))
        moved = 0.5 * max(apart, 0.0) * (1.0 if (k == 0) == up else -1.0)
        end = (_PLOT[0] + _PLOT[2], heights[k] + moved, 0.0)
        name = strips[k].name[0]
        records.append(scene.Label(name, end, type_, style.SMALL_TEXT, (16.0, 0.0), "lc", halo=False))
    return records


def _ten(exponent: float) -> str:
    return {0.0: "$1$", 1.0: "$10$"}.get(exponent) or rf"$10^{{{int(exponent)}}}$"


def _bar(most: float) -> list[scene.Record]:
    """Which colour is which error."""
    x, low, wide, tall = _BAR
    corners = [
        (x, low),
        (x + wide, low),
        (x + wide, low + tall / 2),
        (x, low + tall / 2),
        (x + wide, low + tall),
        (x, low + tall),
    ]
    at = np.array([(*c, 0.0) for c in corners])
    color = style.ramp([0.0, 0.0, 0.5, 0.5, 1.0, 1.0], TONES)
    faces = [[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]]
    said = [("$0$", low), (f"${most:.2g}$" if 0.01 <= most < 100.0 else _morph_plots.power(most), low + tall)]
    return [
        scene.Surface(at, faces, color, material="flat"),
        scene.Lines(at[[0, 1, 4, 5, 0]], style.INK, style.THIN),
        scene.Label(
            r"$|B_i - A_i|$", (x, low + tall, 0.0), style.INK, style.SMALL_TEXT, (0.0, 26.0), "lb", halo=False
        ),
        *(
            scene.Label(s, (x + wide, y, 0.0), style.INK, style.SMALL_TEXT, (14.0, 0.0), "lc", halo=False)
            for s, y in said
        ),
    ]
