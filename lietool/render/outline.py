"""Records on a page as outlines: what is filled and what is stroked in one colour, for files of vectors."""

from collections import defaultdict
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from lietool.render import solids, style
from lietool.render.batches import Lens, check_measures, checked_faces, dashed, finite, runs, whole_strokes
from lietool.render.camera import Page, project
from lietool.render.overlay import encoded
from lietool.render.scene import Arrow, Frame, Label, Lines, Points, Record, Surface

# Colours that differ by less, of 0 to 1, are drawn as one; triangles and segments are divided until they do.
_ALIKE = 1.0 / 64.0
_DEEPEST = 5
# In page units: neighbours in other colours overlap by this much, else the paper shines through between them.
_SEAM = 0.3
# Where the rim of a point begins, of its radius; as in the shader.
_RIM = 0.78


@dataclass(frozen=True, eq=False)
class Shape:
    """Something in one colour: filled, stroked, or both.

    Parameters
    ----------
    rings : tuple of ndarray, shape (k, 2)
        Corners in page units.  What is filled is closed, and so is a ring whose last point is its first.
    color : ndarray, shape (4,)
        Linear RGBA.
    filled : bool
    width : float
        Of the stroke, in page units; its corners are round.
    dash : tuple of float, optional
        Lengths of stroke and gap, in page units.
    round_ends : bool
    disc : float
        With a radius, each ring is one point, the centre of a disc.
    """

    rings: tuple[np.ndarray, ...]
    color: np.ndarray
    filled: bool = False
    width: float = 0.0
    dash: tuple[float, float] | None = None
    round_ends: bool = True
    disc: float = 0.0


def shapes(record: Record, lens: Lens) -> list[Shape] | None:
    """Return the shapes of a record seen through a `Page`; None if light falls on it: it has to be rendered.

    Parameters
    ----------
    record : Record
        Of `scene`; a label has none.
    lens : Lens
        Of the view.

    Raises
    ------
    ValueError
        If it holds what cannot be drawn, as `batches.batches`; or if the lens is a camera's.
    """
    if not isinstance(lens.camera, Page):
        raise ValueError("outline.shapes: lens must be of a Page; got one of a Camera. Render the view")
    check_measures(record)
    match record:
        case Label():
            return []
        case Lines():
            return _lines(record, lens)
        case Points(shaded=False):
            return _points(record, lens)
        case Arrow():
            return _arrow(record, lens)
        case Frame():
            origin, matrix = finite(record.origin, "Frame.origin"), finite(record.matrix, "Frame.matrix")
            found: list[Shape] = []
            for axis, color in zip(matrix.T, style.AXES, strict=True):
                found += _arrow(Arrow(origin, origin + record.length * axis, color, record.radius), lens)
            return found
        case Surface(material="flat"):
            vertices = finite(record.vertices, "Surface.vertices").reshape(-1, 3)
            faces = checked_faces(record.faces, len(vertices))
            rgba = lens.theme.rgba(record.color, len(vertices), record.alpha)
            return _areas(_flat(vertices, lens)[faces], rgba[faces])
    return None


def _flat(points: np.ndarray, lens: Lens) -> np.ndarray:
    return project(lens.camera, lens.box, points)[..., :2]


def _lines(record: Lines, lens: Lens) -> list[Shape]:
    points = np.asarray(record.points, float).reshape(-1, 3)
    rgba = lens.theme.rgba(record.color, len(points), record.alpha)
    width = lens.theme.widths * record.width
    if not len(points) or (rgba != rgba[0]).any():
        if record.dash:
            points, rgba = dashed(points, rgba, record.dash, lens)
        flat = _flat(points, lens)
        return [shape for s in runs(points) for shape in _graded(flat[s], rgba[s], width)]
    color, flat = rgba[0], _flat(points, lens)
    rings = [flat[s] for s in runs(points)]
    if record.dash:
        return [_dashed(ring, color, width, record.dash) for ring in rings if np.ptp(ring, axis=0).any()]
    if color[3] < 1.0:
        # One after the other, since where two of them cross both are seen.
        return [Shape((ring,), color, width=width) for ring in rings]
    return [Shape(tuple(rings), color, width=width)] if rings else []


def _dashed(ring: np.ndarray, color: np.ndarray, width: float, dash: tuple[float, float]) -> Shape:
    length = float(np.linalg.norm(np.diff(ring, axis=0), axis=-1).sum())
    scale = whole_strokes(dash, length)[1]
    return Shape((ring,), color, width=width, dash=(scale * dash[0], scale * dash[1]))


def _graded(ring: np.ndarray, rgba: np.ndarray, width: float) -> list[Shape]:
    """A polyline whose colour changes, as pieces in one colour each."""
    pieces = []
    for a, b, first, last in zip(ring[:-1], ring[1:], rgba[:-1], rgba[1:], strict=True):
        count = max(int(np.ceil(_unlike(np.stack([first, last])) / _ALIKE)), 1)
        t = np.linspace(0.0, 1.0, count + 1)[:, None]
        colors = first + (t[:-1] + t[1:]) / 2.0 * (last - first)
        pieces += list(zip(a + t[:-1] * (b - a), a + t[1:] * (b - a), map(tuple, colors), strict=True))
    found = []
    for color, group in groupby(pieces, key=lambda piece: piece[2]):
        ends = list(group)
        corners = np.stack([ends[0][0], *(end for _, end, _ in ends)])
        opaque = color[3] >= 1.0
        if not opaque and len(pieces) > len(ends):
            corners[-1] += _unit(corners[-1] - corners[-2]) * _SEAM / 2.0
        found.append(Shape((corners,), np.array(color), width=width, round_ends=opaque))
    return found


def _points(record: Points, lens: Lens) -> list[Shape]:
    positions = finite(record.positions, "Points.positions").reshape(-1, 3)
    rgba = lens.theme.rgba(record.color, len(positions))
    found = []
    for at, color in zip(_flat(positions, lens), rgba, strict=True):
        if record.rim:
            rim = np.append(lens.theme.linear(record.rim)[:3], color[3])
            found.append(Shape((at,), rim, True, disc=record.radius))
        found.append(Shape((at,), color, True, disc=record.radius * (_RIM if record.rim else 1.0)))
    return found


def _arrow(record: Arrow, lens: Lens) -> list[Shape]:
    start, end = finite(record.start, "Arrow.start"), finite(record.end, "Arrow.end")
    color = lens.theme.rgba(record.color, 1, record.alpha)
    along = end - start
    length = float(np.linalg.norm(along))
    if length == 0.0:
        return []
    if abs(along[2]) > 1e-9 * length:
        vertices, faces, _ = solids.arrow(start, end, record.radius, record.head)
        return _areas(_flat(vertices, lens)[faces], np.broadcast_to(color, (len(faces), 3, 4)))
    cone = min(3.0 * record.head * record.radius, 0.5 * length)
    right, up = along[:2] / length, np.array([-along[1], along[0]]) / length
    upper = [(0.0, record.radius), (length - cone, record.radius), (length - cone, cone / 3.0)]
    profile = [*upper, (length, 0.0), *((x, -y) for x, y in reversed(upper))]
    ring = _flat(start, lens) + np.array([x * right + y * up for x, y in profile])
    return [Shape((ring,), color[0], True)]


def _areas(corners: np.ndarray, rgba: np.ndarray) -> list[Shape]:
    """Triangles (n, 3, 2) with colours at their corners (n, 3, 4), neighbours in one colour as one area."""
    if not len(corners):
        return []
    face, corners, rgba = _divided(corners, rgba)
    colors = rgba.mean(axis=1)
    level = np.round(np.concatenate([encoded(colors[:, :3]), colors[:, 3:]], axis=-1) / _ALIKE).astype(int)
    if (rgba == rgba[:, :1]).all():
        level = np.unique(colors, axis=0, return_inverse=True)[1].reshape(-1, 1)
    # In the order of the triangles, for a later one lies over those before it.
    order = np.lexsort((*level.T, face))
    found = []
    for _, group in groupby(order, key=lambda i: tuple(level[i])):
        rows = np.array(list(group))
        if rings := union(corners[rows]):
            found.append(Shape(rings, colors[rows].mean(axis=0), True))
    if len(found) < 2:
        return found
    return [Shape(shape.rings, shape.color, True, _SEAM if shape.color[3] >= 1.0 else 0.0) for shape in found]


def _divided(corners: np.ndarray, rgba: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangles divided into four until each is nearly in one colour, with the index of what it was."""
    face = np.arange(len(corners))
    for _ in range(_DEEPEST):
        large = np.array([_unlike(colors) > _ALIKE for colors in rgba], bool)
        if not large.any():
            break
        parts = []
        for values in (corners, rgba):
            a, b, c = np.moveaxis(values[large], 1, 0)
            ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
            four = np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]])
            parts.append(np.concatenate([values[~large], *np.moveaxis(four, 1, 2)]))
        corners, rgba = parts
        face = np.concatenate([face[~large], np.tile(face[large], 4)])
    return face, corners, rgba


def union(corners: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the rings around triangles, so that no seam is seen between those that share an edge.

    Parameters
    ----------
    corners : ndarray, shape (n, 3, 2)

    Returns
    -------
    tuple of ndarray, shape (k, 2)
        Closed, counter-clockwise about what is inside; of winding number n where n triangles overlap.
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    kept = np.where((area < 0.0)[:, None, None], corners[:, ::-1], corners)[np.abs(area) > 1e-9]
    places, index = np.unique(np.round(kept.reshape(-1, 2), 5), axis=0, return_inverse=True)
    count: dict[tuple[int, int], int] = defaultdict(int)
    for triangle in index.reshape(-1, 3).tolist():
        for start, end in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            # An edge that is run through both ways has the inside on both of its sides.
            if count[end, start]:
                count[end, start] -= 1
            else:
                count[start, end] += 1
    onward: dict[int, list[int]] = defaultdict(list)
    for (start, end), times in count.items():
        onward[start] += [end] * times
    rings = []
    for first in list(onward):
        while onward[first]:
            ring = [first]
            while len(ring) == 1 or ring[-1] != first:
                ring.append(onward[ring[-1]].pop())
            rings.append(places[ring[:-1]])
    return tuple(rings)


def _unlike(rgba: np.ndarray) -> float:
    """How far colours (n, 4) are from each other, as they are seen."""
    seen = np.concatenate([encoded(rgba[:, :3]), rgba[:, 3:]], axis=-1)
    return float(np.ptp(seen, axis=0).max())


def _unit(vector: np.ndarray) -> np.ndarray:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0.0 else vector
