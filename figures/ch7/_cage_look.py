"""How cages and the weights of their elements look."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lietool.deform import cage_frames
from lietool.mesh import solids, topology
from lietool.render import mesh_lines, mesh_look, mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.scene import Lines, Points, Record, Surface
from lietool.render.theme import Mix

from . import _probe_look as look_

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

# Faces that meet at less, radians, are two halves of one.
_FLAT = np.radians(18.0)
_LIFT = 0.0025


def cage(
    V: Array, rest: Array, elements: cage_frames.Elements, camera: Camera, shown: int, dots: float = 4.5
) -> list[Record]:
    """Return a cage, the edges behind and those between nearly coplanar faces fainter; one element marked."""
    F = elements.faces
    width = style.CURVE * min(dots / 4.0, 1.0)
    records: list[Record] = [
        Surface(V, F, style.GLASS, material="flat", alpha=0.10),
        *edges(V, rest, F, camera),
        Points(V[np.unique(F)], style.MUTED, dots, shaded=False),
    ]
    for face in F[elements.around[shown]]:
        ring = V[np.append(face, face[0])]
        # A dark rim, and white about it: in grey it would else be lost among the cage's edges.
        records.append(Lines(ring, style.PAPER, 3.6 * width, lift=0.003))
        records.append(Lines(ring, style.INK, 2.6 * width, lift=0.004))
        records.append(Lines(ring, style.ARC, 1.6 * width, lift=0.006))
    if elements.name != "faces":
        ends = V[elements.points[shown]]
        records.append(Points(ends, style.MARK, 8.0, shaded=False))
        if len(ends) > 1:
            records.append(Lines(ends, style.MARK, 2.0 * style.CURVE, lift=0.008))
    return records


def edges(V: Array, rest: Array, F: Index, camera: Camera, strength: float = 1.0) -> list[Record]:
    """Return the edges of a cage."""
    found = topology.edges("cage", F)
    before, now = topology.area_normals(rest, F), topology.area_normals(V, F)
    one, two = (mesh_lines.unit(before[found.sides[:, k]]) for k in range(2))
    thin = np.sum(one * two, axis=1) > np.cos(_FLAT)
    toward = np.einsum("mi,mi->m", now, camera.eye - V[F].mean(axis=1)) > 0.0
    front = toward[found.sides].any(axis=1)
    records: list[Record] = []
    for mask, width, alpha in (
        (front & ~thin, style.EDGE, 0.95),
        (front & thin, style.HAIR, 0.75),
        (~front & ~thin, style.HAIR, 0.50),
        (~front & thin, style.HAIR, 0.22),
    ):
        ends = V[found.ends[mask]]
        gaps = np.full((len(ends), 1, 3), np.nan)
        points = np.concatenate([ends, gaps], axis=1).reshape(-1, 3)[:-1]
        if len(points):
            records.append(Lines(points, style.MUTED, width, strength * alpha, lift=_LIFT))
    return records


def weighted(
    V: Array,
    F: Index,
    weight: Array,
    high: float,
    look: look_.Look,
    camera: Camera,
    ground: float | None,
    moved: bool = False,
) -> list[Record]:
    """Return a shape coloured by weights, on grey at rest and on orange where it has moved."""
    colors, edge = shades(weight, high, moved), style.AFTER_EDGE if moved else style.MUTED
    if look.dots:
        return mesh_look.cloud(V, colors, look.dots)
    N = solids.normals(V, F)
    shadow = mesh_look.shadow(V, F, ground) if look.stands else []
    return [
        *shadow,
        *mesh_look.surface(V, F, colors, normals=N),
        *mesh_look.outline(V, F, camera, edge),
        *mesh_look.eyes(V, N, look.eyes, look.eye),
    ]


def shades(weight: Array, high: float, moved: bool) -> Mix:
    """Return colours of weights (n,): of what has moved, none is its own orange."""
    made = mesh_look.weight_colors(weight, high)
    return replace(made, tones=(style.AFTER, *made.tones[1:])) if moved else made


def hatched(V: Array, F: Index, spots: Mask | None, camera: Camera, box: Box) -> list[Record]:
    """Return slanted lines over the faces all of whose vertices are marked."""
    if spots is None or not spots.any() or not len(F):
        return []
    return mesh_look.hatched(V, F[spots[F].all(axis=1)], camera, box)


def high(weight: Array) -> float:
    """Return where the ramp of weights ends: the least round number that is not below them."""
    most = float(np.abs(weight).max())
    if not most > 0.0:
        return 1.0
    step = 10.0 ** np.floor(np.log10(most) - 1e-9)
    return float(
        next(
            k * step
            for k in (1.0, 1.2, 1.6, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
            if k * step >= most * (1.0 - 1e-9)
        )
    )


def bar(weight: Array, top: float, title: str, x: float = 640.0, y: float = 74.0) -> list[Record]:
    """Return the ramps of weights, at rest below and of what has moved above; from below 0 where some are."""
    low = -top if float(weight.min()) < -0.02 * top else 0.0
    ticks = [(v, f"${v:g}$") for v in ((low, 0.0, top) if low < 0.0 else (0.0, 0.5 * top, top))]

    ramps = [lambda values, moved=moved: shades(values, top, moved) for moved in (False, True)]
    return [
        *mesh_page.color_bar((x, y + 14.0, 240.0, 14.0), (low, top), (), title, ramps[1]),
        *mesh_page.color_bar((x, y, 240.0, 14.0), (low, top), ticks, "", ramps[0]),
    ]
