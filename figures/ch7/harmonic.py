"""Weights between handles that are even on the surface, whatever its triangles are like."""

from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.render import mesh_lines, mesh_look, mesh_page, style
from lietool.render.camera import Box
from lietool.render.plot import number
from lietool.render.scene import Label, Lines, Picture, Record, Surface, View
from lietool.render.solids import grid_faces
from lietool.render.theme import Mix

Array = np.ndarray

_BOXES: tuple[Box, ...] = ((50.0, 232.0, 530.0, 530.0), (620.0, 232.0, 530.0, 530.0))
# Vertices along a side; how far those inside are moved at random, over the sides of squares.
_SIDE, _ROUGH = 27, 0.22
# By how much squares are narrowed and widened: with 1 some would have no width at all.
_MOST = 0.86
# The weight that would have the darkest colour.
_HIGH = 1.7
# The discs that are held, middles and radius; the last is the handle.
_DISCS, _RADIUS = ((0.20, 0.22), (0.84, 0.36), (0.44, 0.74)), 0.075


@figure(
    plates={
        "G7.14": Plate(
            title="Harmonic weights on an uneven mesh",
            equations=("7.14",),
            caption=(
                "A flat sheet whose triangles are small in some places and large in others, most of them "
                "askew. Vertices at the red dots are pinned, those at the black ones are of the handle; the "
                "lines are those of equal weight, a tenth apart. Between two edges harmonic weights make "
                "straight and equal strips, exactly: they know the surface and not its triangles."
            ),
        ),
    },
    time=Time("uneven", 0.0, 1.0),
)
def harmonic(
    uneven: Annotated[float, Param("how uneven the triangles are", low=0.0, high=1.0)] = 1.0,
    lines: Annotated[int, Param("lines of equal weight", low=1, high=39)] = 9,
    *,
    weights: Library = Library("lietool.deform.harmonic.harmonic"),
) -> Drawing:
    """Harmonic weights between pins and a handle, on a sheet of uneven triangles.

    What to look for: the lines of equal weight do not care how the sheet is cut
    into triangles. At the left they are straight, and equally far apart; were every
    edge to count alike, they would follow the vertices, and crowd where these do.
    """
    V, F = _sheet(uneven)
    edges = [np.flatnonzero(V[:, 0] == x) for x in (0.0, 1.0)]
    discs = [np.flatnonzero(np.hypot(*(V[:, :2] - middle).T) < _RADIUS) for middle in _DISCS]
    sets = (edges, [np.concatenate(discs[:2]), discs[2]])
    found = [_handled(weights, V, F, *both) for both in sets]
    levels = np.arange(1, lines + 1) / (lines + 1.0)
    off = float(np.abs(found[0] - V[:, 0]).max())
    records: list[Record] = []
    for box, w, (pins, handle) in zip(_BOXES, found, sets, strict=True):
        records += _panel(box, (V, F), w, levels, (pins, handle))
    rows = np.arange(_SIDE // 2, len(V), _SIDE)
    numbers = {
        # What is left of it is rounding.
        "farthest from straight": round(off, 9),
        "least and most": [[float(w.min()), float(w.max())] for w in found],
        "weights, some": [w[rows] for w in found],
        "largest over smallest face": _spread(V, F),
    }
    return Drawing(Picture((View((*records, *_words(off))),)), numbers)


def _handled(weights: Callable[..., Array], V: Array, F: Array, pins: Array, handle: Array) -> Array:
    """The weights of the handle."""
    return np.asarray(weights(V, F, [handle, pins]))[:, 0]


def _sheet(uneven: float) -> tuple[Array, Array]:
    """A unit square, its inner vertices moved: vertices (n, 3) and triangles."""
    along = np.linspace(0.0, 1.0, _SIDE)
    y, x = (a.ravel() for a in np.meshgrid(along, along, indexing="ij"))
    wave = uneven * _MOST / (2.0 * np.pi)
    moved = np.stack(
        [
            x + wave * np.sin(2.0 * np.pi * x) * np.cos(2.0 * np.pi * y),
            y + wave * np.sin(2.0 * np.pi * y) * np.cos(np.pi * x),
            np.zeros_like(x),
        ],
        axis=1,
    )
    # A square is narrowest where the wave falls most; nothing may turn over there.
    room = (1.0 - uneven * _MOST) / (_SIDE - 1.0)
    inner = (np.abs(x - 0.5) < 0.5 - 1e-9) & (np.abs(y - 0.5) < 0.5 - 1e-9)
    rng = np.random.default_rng(7)
    jitter = _ROUGH * uneven * room * rng.uniform(-1.0, 1.0, (len(x), 2))
    moved[inner, :2] += jitter[inner]
    # On the sides exactly, where rounding would have moved them a little.
    moved[:, 0] = np.where(np.isin(x, (0.0, 1.0)), x, moved[:, 0])
    moved[:, 1] = np.where(np.isin(y, (0.0, 1.0)), y, moved[:, 1])
    return moved, grid_faces(_SIDE, _SIDE)


def _spread(V: Array, F: Array) -> float:
    a, b, c = (V[F[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return float(area.max() / area.min())


def _panel(
    box: Box, mesh: tuple[Array, Array], w: Array, levels: Array, sets: tuple[Array, Array]
) -> list[Record]:
    """The sheet in the colours of a weight, with its lines and what is held."""
    V, F = mesh
    place = np.array([box[0], box[1], 0.0]) + V * np.array([box[2], box[3], 1.0])
    records: list[Record] = [
        Surface(place, F, _tinted(w), material="flat"),
        Lines(mesh_lines.all_edges(place, F), style.INK, style.HAIR, 0.30),
        Lines(mesh_lines.level_lines(place, F, w, levels), style.INK, style.CURVE),
    ]
    for own, color in zip(sets, (style.MARK, style.INK), strict=True):
        records += mesh_look.cloud(place[own], color, 4.0)
    return records


def _tinted(w: ArrayLike) -> Mix:
    """Colours of weights on which black lines are seen, in grey too."""
    return mesh_look.weight_colors(w, _HIGH)


def _words(off: float) -> list[Record]:
    records: list[Record] = [*mesh_page.titles(_BOXES, ["between two edges", "between discs"])]
    said = number(off, 3) if off >= 5e-4 else "0"
    texts = [f"farthest from straight: {said}", "the same triangles"]
    records += mesh_page.captions(_BOXES, texts, 40.0)
    records += mesh_page.color_bar((330.0, 92.0, 240.0, 18.0), title="weight of the handle", colors=_tinted)
    for x, color, text in ((690.0, style.MARK, "pinned"), (870.0, style.INK, "handle")):
        at = np.array([[x, 101.0, 0.0]])
        records += mesh_look.cloud(at, color, 8.0)
        records.append(Label(text, at[0], style.INK, style.SMALL_TEXT, (20.0, 0.0), "lc", halo=False))
    return records
