"""Figure 2.4 of the book."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import groups, polar, so2, sym
from lietool.render import plane, scene, style
from lietool.render.globe import joined
from lietool.render.plane import Plane
from lietool.render.plot import Axes, number
from lietool.render.solids import grid_faces

GROUPS = {"O2": "O", "SO2": "SO", "GL2": "GL"}
# (2.10): R(theta) FLIP is the reflection whose mirror lies at theta / 2.
FLIP = np.diag([1.0, -1.0])
STEPS = 9
_DOT = 12.0

# On the page the middles of the islands stand over their determinants on the axis below.
_MIDDLES, _ALONE, _LEVEL, _UNIT = {1: 912.0, -1: 288.0}, 600.0, 562.0, 153.0
_AXIS = Axes((288.0, 88.0, 624.0, 1.0), (-1.0, 1.0), (0.0, 1.0))
_STEPS = Axes((288.0, 88.0, 624.0, 1.0), (0.0, 1.0), (0.0, 1.0))
_STRIP, _WAY, _HEADING = 206.0, 136.0, 846.0
# From the middle of a letter of the strip to where the lines above and below it begin.
_APART = 44.0
# The rest is in units of an island: shores, heights of the letter F, the place of names.
_SHORES = (0.61, 1.64)
_SMALL, _LARGE, _NAME, _TURN, _MIRROR = 0.37, 0.76, 0.82, 0.53, 0.56


@dataclass(frozen=True, eq=False)
class _Island:
    """A component: some of its matrices, and a path in it that ends at the marked one; (..., 2, 2)."""

    sign: int
    samples: np.ndarray
    path: np.ndarray

    @property
    def marked(self) -> np.ndarray:
        return self.path[-1]

    @property
    def look(self) -> tuple[str, str]:
        """Fill and edge of the letter: of its front, or of its back, which a reflection shows."""
        return (style.AFTER, style.AFTER_EDGE) if self.sign > 0 else (style.GREYS[1], style.GREYS[0])


@figure(
    plates={
        "B2.4": Plate(
            title="O(2) is two islands",
            equations=("2.10", "2.12", "2.13"),
            caption=(
                "Every point of a circle is a matrix of O(2), placed by its first column and shown by what "
                "it does to the letter F. Right: the rotations, det = 1. Left: the reflections, det = -1, "
                "which show the letter's back. On each island a path (arrow) leads on: from I to any A, from "
                "D = diag(1, -1) to B = AD. In the middle what they do: A turns by its angle, B mirrors at "
                "a line at half of it. Below: the straight way from A to B leaves O(2), and at det = 0 the "
                "letter collapses."
            ),
        )
    },
    time=Time("angle", 0.0, 360.0, closed=True),
)
def components(
    group: Annotated[
        Literal["O2", "SO2", "GL2"], Param("orthogonal, rotations alone, or all that have an inverse")
    ] = "O2",
    angle: Annotated[
        float, Param("angle of the marked rotation A; B is A after a flip", "deg", -360.0, 360.0)
    ] = 110.0,
    glyphs: Annotated[int, Param("matrices shown on each island", low=1, high=24)] = 12,
) -> Drawing:
    """The connected components of a group of matrices are islands: no path leads from one to another.

    What to look for: round the right circle the letter F turns; round the left
    one its mirror does, half as fast, and the letter stays turned over. The
    determinant is 1 on one island and -1 on the other, and on a path from 1 to
    -1 it would have to pass 0. GL2 shows the matrices of positive and of
    negative determinant: there the angle round an island is that of the
    rotation in A = R S, and the distance from its middle grows with |det A|.
    """
    islands = _islands(group, float(np.deg2rad(angle)), glyphs)
    alone = len(islands) == 1
    t = np.linspace(0.0, 1.0, STEPS)[:, None, None]
    way = _along(islands[0]) if alone else (1.0 - t) * islands[0].marked + t * islands[1].marked
    member = groups.is_member(GROUPS[group], way)
    records = [r for island in islands for r in _island(island, group, alone)]
    records += _alone(islands[0]) if alone else _between(islands, group, way, member)
    numbers = {
        "components": len(islands),
        "marked": np.stack([island.marked for island in islands]),
        "way": way,
        "way_det": np.linalg.det(way),
        "way_is_member": member.astype(int),
    }
    for island in islands:
        name = "det_positive" if island.sign > 0 else "det_negative"
        numbers |= {name: island.samples, f"{name}_places": place(island.samples)}
        numbers[f"{name}_det"] = np.linalg.det(island.samples)
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def _islands(group: str, theta: float, count: int) -> list[_Island]:
    """As many as the group has components: the one of I, and the one of the flip."""
    around = 2.0 * np.pi * np.arange(count) / count
    along = np.linspace(0.0, theta, 161)
    samples, path = so2.exp(around), so2.exp(along)
    if group == "GL2":
        samples = samples @ sym.exp(_stretches(count))
        growing = np.linspace(0.0, 0.3, len(along))[:, None, None] * FLIP
        path = path @ sym.exp(growing)
    found = [_Island(1, samples, path), _Island(-1, samples @ FLIP, path @ FLIP)]
    return found[: groups.get(GROUPS[group]).components]


def _stretches(count: int) -> np.ndarray:
    """Logarithms of stretches: some shear at random, the trace in turn below and above 0."""
    Y = 0.22 * np.random.default_rng(4).normal(size=(count, 2, 2))
    Y = (Y + np.swapaxes(Y, -1, -2)) / 2.0
    trace = np.where(np.arange(count) % 2 == 0, 0.42, -0.42)
    wanted = (trace - np.trace(Y, axis1=-2, axis2=-1)) / 2.0
    return Y + wanted[:, None, None] * np.eye(2)


def _along(island: _Island) -> np.ndarray:
    return island.path[:: (len(island.path) - 1) // (STEPS - 1)]


def place(A: np.ndarray) -> np.ndarray:
    """Return where matrices (..., 2, 2) lie on their island (..., 2): the angle of R in A = R S, and |det A|.

    For an orthogonal matrix that is its first column.
    """
    d = np.linalg.det(A)[..., None]
    R, _ = polar.decompose(np.where(d[..., None] < 0.0, A @ FLIP, A))
    return R[..., :, 0] * (1.0 + 0.5 * np.log(np.abs(d)))


def _island(island: _Island, group: str, alone: bool) -> list[scene.Record]:
    sheet = Plane((_ALONE if alone else _MIDDLES[island.sign], _LEVEL), _UNIT)
    fill, edge = island.look
    at = place(island.samples)
    # Where determinants differ the letters lie at their own places; else outside the circle of all places.
    open_set = group == "GL2"
    core, apart = (1.16, 1.16) if open_set else (1.0, 1.33)
    records = [*_land(sheet, island, open_set), sheet.circle((0.0, 0.0), core, edge, style.EDGE)]
    if not open_set:
        records.append(sheet.dots(at, edge, 4.5))
    # As large as fits between neighbours, whatever way they are turned.
    size = min(0.29 if open_set else _SMALL, 1.5 * apart * np.sin(np.pi / max(len(at), 2)))
    for A, origin in zip(island.samples, sheet.at(apart * at), strict=True):
        small = Plane((float(origin[0]), float(origin[1])), _UNIT)
        records += small.glyph(A, fill, edge, size=size, width=style.THIN)
    way = sheet.at(core * place(island.path))
    # The arrow ends just inside the dot, which is drawn over its tip.
    seen = np.linalg.norm(way - way[-1], axis=-1) > 0.8 * _DOT
    records += plane.path(way[: np.flatnonzero(seen)[-1] + 1], style.ROUTE_1, 5.0) if seen.any() else []
    return records + _marked(sheet, island, core) + _heading(island, group, alone)


def _land(sheet: Plane, island: _Island, open_set: bool) -> list[scene.Record]:
    """The island itself, a ring round its middle; an open set has no coast of its own."""
    fill, edge = island.look
    around = plane.direction(np.linspace(0.0, 2.0 * np.pi, 181))
    vertices = sheet.at(np.concatenate([r * around for r in reversed(_SHORES)]))
    return [
        scene.Surface(vertices, grid_faces(2, 181), fill, material="flat", alpha=0.22),
        *(sheet.line(r * around, edge, style.THIN, 0.8, (3.0, 7.0) if open_set else None) for r in _SHORES),
    ]


def _marked(sheet: Plane, island: _Island, core: float) -> list[scene.Record]:
    """The marked element: a dot at its place, and in the middle what it does to the letter."""
    fill, edge = island.look
    first, last = core * place(island.path[0]), core * place(island.marked)
    records: list[scene.Record] = []
    records += sheet.glyph(island.marked, fill, edge, size=_LARGE)
    if core == 1.0:
        records += _mirror(sheet, last) if island.sign < 0 else _turn(sheet, island)
    records.append(sheet.dots(first, edge, 8.0))
    records.append(sheet.dots(last, style.ROUTE_1, _DOT))
    name, start = ("A", "I") if island.sign > 0 else ("B", "D")
    if np.linalg.norm(first - last) > 0.3:
        records.append(_name(sheet, start, first, edge, core))
    records.append(_name(sheet, name, last, style.ROUTE_1_TEXT, core))
    return records


def _mirror(sheet: Plane, column: np.ndarray) -> list[scene.Record]:
    """The line of fixed points of a reflection; by (2.10) at half the angle of its first column."""
    half = np.arctan2(column[1], column[0]) / 2.0
    ends = _MIRROR * plane.direction(np.array([half, half + np.pi]))
    return [sheet.line(ends, style.INK, style.EDGE)]


def _turn(sheet: Plane, island: _Island) -> list[scene.Record]:
    """The angle by which the marked rotation turns the letter, followed along the path."""
    columns = island.path[:, :, 0]
    angle = float(np.unwrap(np.arctan2(columns[:, 1], columns[:, 0]))[-1])
    return sheet.turn((0.0, 0.0), _TURN, 0.0, angle, style.INK, width=style.EDGE)


def _name(sheet: Plane, name: str, at: np.ndarray, color: str, core: float) -> scene.Label:
    inside = _NAME * at / np.linalg.norm(at)
    # In GL(2) there are matrices on both sides of the circle.
    room = 40.0 if core > 1.0 else 0.0
    return scene.Label(f"${name}$", sheet.at(inside), color, style.TEXT, room=room)


def _heading(island: _Island, group: str, alone: bool) -> list[scene.Record]:
    kinds = ("rotations", "reflections") if group != "GL2" else ("without a flip", "with a flip")
    kind = kinds[0] if island.sign > 0 else kinds[1]
    d = number(np.linalg.det(island.marked), 2)
    relation = f"= {d}" if group != "GL2" else f"{'>' if island.sign > 0 else '<'} 0"
    x = _ALONE if alone else _MIDDLES[island.sign]
    return [
        scene.Label(
            rf"{kind}, $\mathrm{{det}} {relation}$",
            (x, _HEADING, 0.0),
            style.INK,
            style.TITLE_TEXT,
            anchor="cn",
        )
    ]


def _between(islands: list[_Island], group: str, way: np.ndarray, member: np.ndarray) -> list[scene.Record]:
    """The straight way from A to B, each step over its determinant, and the wall at 0."""
    wall, low = _AXIS.at(0.0, 0.0)[0], _AXIS.box[1]
    shore = _LEVEL - _SHORES[1] * _UNIT
    walls = [
        [(wall, top, 0.0), (wall, bottom, 0.0)]
        for top, bottom in ((_HEADING - 26.0, _STRIP + 88.0), (_WAY - 24.0, low))
    ]
    guides = [
        [(x, top, 0.0), (x, bottom, 0.0)]
        for x in _MIDDLES.values()
        for top, bottom in ((shore, _STRIP + _APART), (_WAY - 24.0, low))
    ]
    records: list[scene.Record] = [
        scene.Lines(joined(np.array(guides)), style.RULE, style.THIN),
        scene.Lines(joined(np.array(walls)), style.WRONG, style.EDGE),
        scene.Label("no path", (wall, _HEADING, 0.0), style.WRONG, style.TITLE_TEXT, anchor="cn"),
        scene.Label(
            f"leaves ${group[:-1]}(2)$",
            (wall, _STRIP + 54.0, 0.0),
            style.WRONG,
            style.SMALL_TEXT,
            anchor="cn",
        ),
        *_AXIS.frame([(v, f"${v}$") for v in (-1, 0, 1)], [], r"$\mathrm{det}$"),
        *_parameter(wall),
    ]
    for A, inside in zip(way, member, strict=True):
        d = float(np.linalg.det(A))
        sheet = Plane((float(_AXIS.at(d, 0.0)[0]), _STRIP), _UNIT)
        fill, edge = islands[0 if d > 0.0 else 1].look if inside else (style.PAPER, style.WRONG)
        # A letter that has collapsed is all edge.
        width = style.CURVE if abs(d) < 1e-9 else style.THIN
        records += sheet.glyph(A, fill, edge, size=_SMALL, width=width)
    return records


def _parameter(middle: float) -> list[scene.Record]:
    """How the time runs along the straight way: from A, which is on the right, to B."""
    # As much as the texts need.
    formula, end = 128.0, 56.0
    start, stop = (_MIDDLES[1] - end, _WAY, 0.0), (_MIDDLES[-1] + end, _WAY, 0.0)
    before, after = (middle + formula, _WAY, 0.0), (middle - formula, _WAY, 0.0)
    texts = ((_MIDDLES[1], "$t = 0$"), (middle, r"$(1-t)\,A + t\,B$"), (_MIDDLES[-1], "$t = 1$"))
    return [
        scene.Lines([start, before], style.INK, style.THIN),
        *plane.path(np.array([after, stop]), style.INK, style.THIN),
        *(scene.Label(t, (x, _WAY, 0.0), style.INK, style.SMALL_TEXT) for x, t in texts),
    ]


def _alone(island: _Island) -> list[scene.Record]:
    """Steps on the path from I to A."""
    records = _STEPS.frame([(0.0, "$I$"), (1.0, "$A$")], [])
    for t, A in zip(np.linspace(0.0, 1.0, len(_along(island))), _along(island), strict=True):
        x = float(_STEPS.at(t, 0.0)[0])
        records += Plane((x, _STRIP), _UNIT).glyph(A, *island.look, size=_SMALL, width=style.THIN)
    text = r"a path in $SO(2)$: $\mathrm{det} = 1$ all along"
    return [
        *records,
        scene.Label(text, (600.0, _AXIS.box[1] - 14.0, 0.0), style.INK, style.SMALL_TEXT, anchor="ct"),
    ]
