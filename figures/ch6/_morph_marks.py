"""A triangulated shape on the page: its area, fine edges, outline, eyes; what is turned over in red."""

import numpy as np

from lietool.mesh import topology
from lietool.mesh.shapes import Shape
from lietool.render import style
from lietool.render.plane import Plane
from lietool.render.scene import Lines, Points, Record, Surface
from lietool.render.theme import Color, Mix

Array = np.ndarray

# From the source to the target, by lightness too.
TONES = (style.SHELLS[0], style.RAMP[1], style.SHELLS[1])
_FINE = 0.38


def color_at(t: float) -> Mix:
    """The colour of the shape at a time."""
    return style.ramp([t], TONES)


def drawn(
    place: Plane,
    pair: Shape,
    V: Array,
    color: Color,
    *,
    flipped: Array | None = None,
    edge: float = style.EDGE,
    eye: float = 4.0,
) -> list[Record]:
    """Return a shape whose vertices are V (n, 2)."""
    at = place.at(V)
    ends = topology.edges("global_interp", pair.faces).ends
    # Where triangles are small on the page, their edges must not fill them.
    reach = np.median(np.linalg.norm(pair.source[ends[:, 0]] - pair.source[ends[:, 1]], axis=1)) * place.scale
    fine = style.HAIR * float(np.clip(reach / 14.0, 0.4, 1.0))
    records: list[Record] = [Surface(at, pair.faces, color, material="flat")]
    if flipped is not None and flipped.any():
        records.append(Surface(at, pair.faces[flipped], style.WRONG, material="flat"))
    records += [
        Lines(broken(at[ends]), style.INK, fine, alpha=_FINE),
        Lines(at[np.append(pair.boundary, pair.boundary[0])], style.INK, edge),
    ]
    eyes = [v for name, v in pair.marks.items() if name.startswith("eye")]
    if eyes and eye:
        records.append(Points(at[eyes], style.INK, eye, shaded=False))
    return records


def broken(pieces: Array) -> Array:
    """Polylines (k, n, 3) as one with gaps."""
    gaps = np.full((len(pieces), 1, 3), np.nan)
    return np.concatenate([pieces, gaps], axis=1).reshape(-1, 3)[:-1]


def scattered(place: Plane, corners: Array, color: Color) -> list[Record]:
    """Return triangles (m, 3, 2) that have nothing to do with each other."""
    at = place.at(corners)
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    return [
        Surface(at.reshape(-1, 3), faces, color, material="flat"),
        Lines(broken(at[:, [0, 1, 2, 0]]), style.INK, style.HAIR, alpha=0.7),
    ]
