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
# How much of the ink is in fine edges, and round triangles that are turned over.
_FINE, _TURNED = 0.38, 0.75
# Of all triangles: so few can be overlooked.
FEW = 0.03
# Into so many pieces each edge of a round outline is divided.
_PIECES = 4
# Into so many pieces the sides of a triangle that a ring cuts.
_PARTS = 12
# Between candidates for the middle of an empty place, in page units.
_GRID = 14.0


def color_at(t: float) -> Mix:
    """The colour of the shape at a time."""
    return style.ramp([t], TONES)


def drawn(
    place: Plane,
    pair: Shape,
    V: Array,
    color: Color,
    *,
    values: Array | None = None,
    tones: tuple[str, ...] = TONES,
    flipped: Array | None = None,
    edge: float = style.EDGE,
    eye: float = 4.0,
) -> list[Record]:
    """Return a shape whose vertices are V (n, 2), in one colour or, where given, by values (n,), 0 to 1.

    Triangles that are turned over come last, so that no other sheet hides them.
    """
    points, faces, owner, rim = skin(pair, V)
    at = place.at(points)
    if values is not None:
        shown = skin(pair, np.stack([values, values], axis=1))[0][:, 0]
        color = style.ramp(np.clip(shown, 0.0, 1.0), tones)
    ends = inner_edges(pair.faces)
    # Where triangles are small on the page, their edges must not fill them.
    reach = np.median(np.linalg.norm(pair.source[ends[:, 0]] - pair.source[ends[:, 1]], axis=1)) * place.scale
    fine = style.HAIR * float(np.clip(reach / 14.0, 0.4, 1.0))
    records: list[Record] = [
        Surface(at, faces, color, material="flat"),
        Lines(broken(at[ends]), style.INK, fine, alpha=_FINE),
    ]
    if flipped is not None and flipped.any():
        over = place.at(V[pair.faces[flipped]])[:, [0, 1, 2, 0]]
        few = flipped.sum() < FEW * len(flipped)
        records += [
            Surface(at, faces[flipped[owner]], style.WRONG, material="flat"),
            # Few would vanish without a line of their colour; of many, each should be seen.
            Lines(broken(over), style.WRONG if few else style.INK, fine, alpha=_TURNED if few else _FINE),
        ]
    records.append(Lines(at[rim], style.INK, edge))
    eyes = [v for name, v in pair.marks.items() if name.startswith("eye")]
    if eyes and eye:
        records.append(Points(at[eyes], style.INK, eye, shaded=False))
    return records


def inner_edges(faces: Array) -> Array:
    """The edges (k, 2) that lie between two triangles."""
    half = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    found, count = np.unique(half, axis=0, return_counts=True)
    return found[count > 1]


def skin(pair: Shape, V: Array) -> tuple[Array, Array, Array, Array]:
    """Points, faces, the triangle (of the shape) of each face, and the closed outline, as point numbers.

    An animal has flesh and no corners: a curve leads through the vertices of its outline, and the triangles
    there reach as far as the curve. Other shapes are drawn as they are.
    """
    faces, rim = pair.faces, np.append(pair.boundary, pair.boundary[0])
    if not any(name.startswith("eye") for name in pair.marks):
        return V, faces, np.arange(len(faces)), rim
    n, start, stop = len(V), rim[:-1], rim[1:]
    # The triangle at each edge of the outline; both run counter-clockwise.
    keys = (faces * n + np.roll(faces, -1, axis=1)).ravel()
    order = np.argsort(keys)
    outer = order[np.searchsorted(keys[order], start * n + stop)]
    wide = np.unique(outer // 3)
    curve, count = _curve(V[start]), _PIECES - 1
    points = np.concatenate([V, V[faces[wide]].mean(axis=1), curve.reshape(-1, V.shape[1])])
    first = n + len(wide)
    # Each of these triangles becomes a fan from its middle.
    middle = np.full(len(faces), -1)
    middle[wide] = n + np.arange(len(wide))
    inner = np.setdiff1d(np.concatenate([3 * wide, 3 * wide + 1, 3 * wide + 2]), outer)
    plain = np.stack([middle[inner // 3], faces.ravel()[inner], np.roll(faces, -1, axis=1).ravel()[inner]], 1)
    walk = np.column_stack([start, first + np.arange(curve.shape[0] * count).reshape(-1, count), stop])
    bent = np.stack([np.repeat(middle[outer // 3], _PIECES), walk[:, :-1].ravel(), walk[:, 1:].ravel()], 1)
    kept = np.flatnonzero(middle < 0)
    owner = np.concatenate([kept, inner // 3, np.repeat(outer // 3, _PIECES)])
    closed = np.append(walk[:, :-1].ravel(), start[0])
    return points, np.concatenate([faces[kept], plain, bent]), owner, closed


def _curve(P: Array) -> Array:
    """Points (k, pieces - 1, 2) between each of P (k, 2) and the next, on a smooth closed curve."""
    s = (np.arange(1, _PIECES) / _PIECES)[:, None]
    tangent = 0.5 * (np.roll(P, -1, axis=0) - np.roll(P, 1, axis=0))
    a, b = P[:, None], np.roll(P, -1, axis=0)[:, None]
    u, v = tangent[:, None], np.roll(tangent, -1, axis=0)[:, None]
    h = s * s * (3.0 - 2.0 * s)
    return a + h * (b - a) + s * (1.0 - s) ** 2 * u - s * s * (1.0 - s) * v


def broken(pieces: Array) -> Array:
    """Polylines (k, n, 3) as one with gaps."""
    gaps = np.full((len(pieces), 1, 3), np.nan)
    return np.concatenate([pieces, gaps], axis=1).reshape(-1, 3)[:-1]


def scattered(place: Plane, pair: Shape, corners: Array, color: Color) -> list[Record]:
    """Return triangles (m, 3, 2) that have nothing to do with each other; each eye on one of them."""
    at = place.at(corners)
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    records: list[Record] = [
        Surface(at.reshape(-1, 3), faces, color, material="flat"),
        Lines(broken(at[:, [0, 1, 2, 0]]), style.INK, style.HAIR, alpha=0.7),
    ]
    eyes = [v for name, v in pair.marks.items() if name.startswith("eye")]
    if eyes:
        where = at.reshape(-1, 3)[[int(np.argmax(pair.faces.ravel() == v)) for v in eyes]]
        records.append(Points(where, style.INK, 0.035 * place.scale, shaded=False))
    return records


def clusters(pair: Shape, turned: Array) -> list[Array]:
    """The triangles that are turned over, as groups (k,) that hang together."""
    chosen = np.flatnonzero(turned)
    faces = pair.faces[chosen]
    if not len(faces):
        return []
    part = topology.components(len(pair.source), np.concatenate([faces[:, :2], faces[:, 1:]]))[1][faces[:, 0]]
    return [chosen[part == k] for k in np.unique(part)]


def middle(points: Array) -> tuple[Array, float]:
    """The middle of what points (n, 2) extend over, and their largest distance from it."""
    center = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return center, float(np.linalg.norm(points - center, axis=1).max())


def empty(points: Array, box: tuple[float, float, float, float]) -> tuple[tuple[float, float], float]:
    """The largest circle in a box of the page that holds none of the points (n, 2): middle and radius."""
    x, y = (np.arange(box[k] + _GRID / 2.0, box[k] + box[k + 2], _GRID) for k in (0, 1))
    spots = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    room = np.minimum(spots - box[:2], np.add(box[:2], box[2:]) - spots).min(axis=1)
    cells = np.unique(np.round(points / _GRID), axis=0) * _GRID
    far = np.full(len(spots), np.inf)
    for some in np.array_split(cells, max(len(cells) // 200, 1)):
        # Written out, for a sum over two columns takes many times as long.
        gap = (spots[:, None, 0] - some[:, 0]) ** 2 + (spots[:, None, 1] - some[:, 1]) ** 2
        far = np.minimum(far, np.sqrt(gap.min(axis=1)))
    free = np.minimum(far, room)
    best = int(np.argmax(free))
    return (float(spots[best, 0]), float(spots[best, 1])), float(free[best])


def within(triangles: Array, owner: Array, center: Array, reach: float) -> tuple[Array, Array]:
    """What of triangles (m, 3, 2) lies in a circle, as triangles, and the owner (m,) of each.

    Those that the circle cuts are divided into small ones.
    """
    inside = np.linalg.norm(triangles - center, axis=-1) <= reach
    whole = inside.all(axis=1)
    # A circle may also cut sides without a corner inside.
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    near = ((low <= center + reach) & (high >= center - reach)).all(axis=1)
    some = np.flatnonzero(near & ~whole)
    small = _divided(triangles[some])
    kept = np.linalg.norm(small.mean(axis=2) - center, axis=-1) <= reach
    of = np.broadcast_to(owner[some][:, None], kept.shape)[kept]
    return np.concatenate([triangles[whole], small[kept]]), np.concatenate([owner[whole], of])


def _divided(triangles: Array) -> Array:
    """Triangles (k, 3, 2), each as many small ones; shape (k, _PARTS**2, 3, 2)."""
    i, j = np.meshgrid(np.arange(_PARTS), np.arange(_PARTS), indexing="ij")
    up = np.stack([(i, j), (i + 1, j), (i, j + 1)], axis=-1)[:, i + j < _PARTS]
    down = np.stack([(i + 1, j), (i + 1, j + 1), (i, j + 1)], axis=-1)[:, i + j < _PARTS - 1]
    u, v = np.concatenate([up, down], axis=1) / _PARTS
    shares = np.stack([1.0 - u - v, u, v], axis=-1)
    return np.einsum("pcs,ksx->kpcx", shares, triangles)


def cut(pieces: Array, center: Array, reach: float) -> Array:
    """What of straight pieces (k, 2, 2) lies in a circle."""
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    off = start - center
    a, b = (along**2).sum(axis=1), (off * along).sum(axis=1)
    root = b * b - a * ((off**2).sum(axis=1) - reach**2)
    kept = (root > 0.0) & (a > 0.0)
    start, along, a, b, root = (x[kept] for x in (start, along, a, b, root))
    first = np.clip((-b - np.sqrt(root)) / a, 0.0, 1.0)
    last = np.clip((-b + np.sqrt(root)) / a, 0.0, 1.0)
    found = start[:, None] + np.stack([first, last], axis=1)[..., None] * along[:, None]
    return found[last > first]
