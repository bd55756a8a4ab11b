"""Records turned into arrays for the graphics library: triangles, segments, balls, images, with depths."""

from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from lietool.render import solids, style
from lietool.render.camera import Box, Camera, Page, project
from lietool.render.scene import Arrow, Frame, Image, Label, Lines, Points, Record, Surface, Tube
from lietool.render.theme import BOOK, Theme, light

# More than any page has pixels; a dash that is finer would only take time.
_MOST_DASHES = 20000
# Every OpenGL has textures of this size.
_LARGEST_IMAGE = 4096

# A shadow is drawn as what is flat, but before all else.
MATERIALS = {"flat": 0.0, "matte": 1.0, "glass": 2.0, "soft": 3.0, "shadow": 0.0}


@dataclass(frozen=True, eq=False)
class Batch:
    """Elements of one kind, each a row.

    Parameters
    ----------
    kind : {"surface", "glass far", "glass near", "lines", "points", "image"}
    data : ndarray of float32, shape (n, ...)
        What the shader reads for each triangle (three vertices), segment, ball or image.
    depth : ndarray, shape (n,)
        By which translucent elements are sorted, farthest first.
    opaque : bool
        Nothing behind it shows, so that it may be drawn first and fill the depth buffer.
    texels : ndarray of float16, shape (h, w, 4), optional
        Of an image: its pixels in linear light, the lowest row first.
    smooth : bool
        Whether an image is smooth between them.
    """

    kind: str
    data: np.ndarray
    depth: np.ndarray
    opaque: bool = False
    texels: np.ndarray | None = None
    smooth: bool = True


@dataclass(frozen=True)
class Lens:
    """What a record needs to know to become a batch: camera, box on the page, pixels per page unit, theme."""

    camera: Camera | Page
    box: Box
    unit: float
    theme: Theme = BOOK

    @property
    def world(self) -> float:
        """World units per page unit at the target."""
        return self.camera.height / self.box[3] if isinstance(self.camera, Camera) else 1.0

    def depth(self, points: np.ndarray) -> np.ndarray:
        """Return the distance along the axis of view of points (..., 3)."""
        return project(self.camera, self.box, points)[..., 2]


@singledispatch
def batches(record: Record, lens: Lens) -> list[Batch]:
    """Return the batches that draw a record.

    Parameters
    ----------
    record : Record
        Of `scene`; a label has none, it is composed afterwards.
    lens : Lens

    Raises
    ------
    ValueError
        If it holds what cannot be drawn: a coordinate that is NaN or infinite where it may not be, a face
        without vertices, a material, colour or dash of no known form.
    TypeError
        If it is no record of `scene`.
    """
    raise TypeError(f"batches: record must be one of scene.Record; got {type(record).__name__}")


@batches.register
def _(record: Label, lens: Lens) -> list[Batch]:
    finite(record.position, "Label.position")
    return []


@batches.register
def _(record: Surface, lens: Lens) -> list[Batch]:
    vertices = finite(record.vertices, "Surface.vertices")
    faces = checked_faces(record.faces, len(vertices))
    if not len(faces):
        return []
    if record.material not in MATERIALS:
        known = ", ".join(MATERIALS)
        raise ValueError(f"draw.render: Surface.material must be one of {known}; got {record.material!r}")
    corners = vertices.take(faces, axis=0)
    if record.normals is None:
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        normals = np.repeat((normals / np.where(length > 0, length, 1.0))[:, None], 3, axis=1)
    else:
        normals = np.asarray(record.normals, float).take(faces, axis=0)
    color = lens.theme.rgba(record.color, len(vertices), record.alpha, shadow=record.material == "shadow")
    material = np.full((*faces.shape, 1), MATERIALS[record.material])
    data = np.concatenate([corners, normals, color.take(faces, axis=0), material], axis=-1).astype("f4")
    depth = lens.depth((corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0)
    if record.material == "glass":
        return _walls(data, corners, normals, depth, lens)
    if record.material == "shadow":
        # Under everything; in its order by depth it would part each run of lines into hundreds.
        depth = np.full(len(depth), np.finfo(np.float32).max)
    return [Batch("surface", data, depth, bool(color[faces, 3].min() >= 1.0))]


def _walls(
    data: np.ndarray, corners: np.ndarray, normals: np.ndarray, depth: np.ndarray, lens: Lens
) -> list[Batch]:
    """The far wall of a shell of glass before everything else, the near wall at its middle.

    What lies nearer than the middle is taken to be in front of the glass.
    """
    eye = lens.camera.eye if isinstance(lens.camera, Camera) else np.array([0.0, 0.0, 1e9])
    facing = np.sum(normals * (eye - corners), axis=-1)
    far, near = data[(facing < 0.0).any(axis=1)], data[(facing > 0.0).any(axis=1)]
    return [
        Batch("glass far", far, np.full(len(far), depth.max())),
        Batch("glass near", near, np.full(len(near), depth.mean())),
    ]


@batches.register
def _(record: Lines, lens: Lens) -> list[Batch]:
    points = np.asarray(record.points, float).reshape(-1, 3)
    color = lens.theme.rgba(record.color, len(points), record.alpha)
    half_width = lens.theme.widths * record.width * lens.unit / 2.0
    # A hairline thinner than a pixel would vanish between two of them; it is drawn paler instead.
    if half_width < 0.35:
        color[:, 3] *= half_width / 0.35
        half_width = 0.35
    if record.dash:
        points, color = dashed(points, color, record.dash, lens)
    lift = record.lift * lens.camera.height
    data = _segments(points, color, half_width, lift)
    depth = lens.depth((data[:, 3:6] + data[:, 6:9]) / 2.0) - lift
    return [Batch("lines", data.astype("f4"), depth)] if len(data) else []


@batches.register
def _(record: Points, lens: Lens) -> list[Batch]:
    positions = finite(record.positions, "Points.positions").reshape(-1, 3)
    n = len(positions)
    rim = lens.theme.rgba(record.rim, n) if record.rim else np.zeros((n, 4))
    lift = 1.5 * record.radius * lens.world
    rest = np.tile([record.radius * lens.unit, float(record.shaded), lift], (n, 1))
    data = np.concatenate([positions, lens.theme.rgba(record.color, n), rim, rest], axis=-1)
    return [Batch("points", data.astype("f4"), lens.depth(positions) - lift)] if n else []


@batches.register
def _(record: Arrow, lens: Lens) -> list[Batch]:
    start, end = finite(record.start, "Arrow.start"), finite(record.end, "Arrow.end")
    vertices, faces, normals = solids.arrow(start, end, record.radius, record.head)
    material = "flat" if isinstance(lens.camera, Page) else "matte"
    return batches(Surface(vertices, faces, record.color, normals, material, record.alpha), lens)


@batches.register
def _(record: Tube, lens: Lens) -> list[Batch]:
    points = finite(record.points, "Tube.points")
    vertices, faces, normals = solids.tube(points, record.radius, record.closed)
    color = record.color
    if not isinstance(color, str):
        # Every ring of the tube takes the colour of the nearest point of its axis.
        near = np.argmin(np.linalg.norm(vertices[:, None] - points[None], axis=-1), axis=1)
        color = color[near]
    return batches(Surface(vertices, faces, color, normals), lens)


@batches.register
def _(record: Frame, lens: Lens) -> list[Batch]:
    origin, matrix = finite(record.origin, "Frame.origin"), finite(record.matrix, "Frame.matrix")
    found: list[Batch] = []
    for axis, color in zip(matrix.T, style.AXES, strict=True):
        found += batches(Arrow(origin, origin + record.length * axis, color, record.radius), lens)
    return found


@batches.register
def _(record: Image, lens: Lens) -> list[Batch]:
    pixels = finite(record.pixels, "Image.pixels")
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[:, :, None], 3, axis=2)
    if pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.size or max(pixels.shape) > _LARGEST_IMAGE:
        must = f"(h, w) or (h, w, 3), at most {_LARGEST_IMAGE} each way"
        raise ValueError(f"draw.render: Image.pixels must be of shape {must}; got {np.shape(record.pixels)}")
    sides = [finite(getattr(record, name), f"Image.{name}") for name in ("corner", "across", "up")]
    linear = light(np.clip(pixels[::-1], 0.0, 1.0))
    texels = np.concatenate([linear, np.ones((*linear.shape[:2], 1))], axis=2).astype("f2")
    middle = sides[0] + 0.5 * (sides[1] + sides[2])
    data = np.concatenate(sides)[None].astype("f4")
    return [Batch("image", data, lens.depth(middle[None]), True, texels, record.smooth)]


def extent(kind: str, data: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the points (n, 3) of a batch's rows, and how far beyond them it draws, in pixels."""
    if kind == "lines":
        return data[:, 3:9].reshape(-1, 3), float(data[:, 20].max())
    if kind == "points":
        return data[:, :3], float(data[:, 11].max())
    if kind == "image":
        corner, across, up = data[:, :3], data[:, 3:6], data[:, 6:9]
        return np.concatenate([corner, corner + across, corner + up, corner + across + up]), 0.0
    return data[..., :3].reshape(-1, 3), 0.0


def check_measures(record: Record) -> None:
    """Refuse an opacity outside of 0 to 1, and a width, radius or type size that is negative or no number."""
    for field, most in (("alpha", 1.0), ("width", np.inf), ("radius", np.inf), ("size", np.inf)):
        value = getattr(record, field, 0.0)
        if not (0.0 <= value <= most and np.isfinite(value)):
            wanted = "0 to 1" if most == 1.0 else "finite and not negative"
            raise ValueError(f"draw.render: {type(record).__name__}.{field} must be {wanted}; got {value}")


def finite(values: object, name: str) -> np.ndarray:
    """Return values as an array; ValueError where one of them is NaN or infinite."""
    array = np.asarray(values, float)
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"draw.render: {name} must be finite; got {array[where]} at index {where}")
    return array


def checked_faces(values: object, count: int) -> np.ndarray:
    """Return triangles (n, 3) of `count` vertices; ValueError if they are none."""
    faces = np.asarray(values)
    if faces.size == 0:
        return np.zeros((0, 3), int)
    if faces.dtype.kind not in "iu" or faces.ndim != 2 or faces.shape[1] != 3:
        raise ValueError(
            f"draw.render: Surface.faces must be whole numbers (n, 3); got {faces.dtype} {faces.shape}"
        )
    if faces.min() < 0 or faces.max() >= count:
        raise ValueError(
            f"draw.render: Surface.faces must be indices of its {count} vertices, from 0; "
            f"got {faces.min()} to {faces.max()}"
        )
    return faces


def runs(points: np.ndarray) -> list[slice]:
    """Return where the polylines are between which there is a row of NaN."""
    broken = np.flatnonzero(~np.isfinite(points).all(axis=1))
    starts = np.concatenate([[0], broken + 1])
    ends = np.concatenate([broken, [len(points)]])
    return [slice(a, b) for a, b in zip(starts, ends, strict=True) if b - a >= 2]


def _segments(points: np.ndarray, color: np.ndarray, half_width: float, lift: float) -> np.ndarray:
    """The segments of all polylines, each with the points before and after it; shape (n, 22)."""
    first, last = np.array([(s.start, s.stop - 1) for s in runs(points)], int).reshape(-1, 2).T
    count = last - first
    closed = (count > 1) & (points[first] == points[last]).all(axis=1)
    # Of each segment where it starts, and of its polyline where that begins and ends.
    at = np.arange(count.sum()) + np.repeat(first - (np.cumsum(count) - count), count)
    head, tail, ring = (np.repeat(of, count) for of in (first, last, closed))
    before = np.where(at > head, at - 1, np.where(ring, tail - 1, head))
    after = np.where(at + 1 < tail, at + 2, np.where(ring, head + 1, tail))
    parts = [points[before], points[at], points[at + 1], points[after], color[at], color[at + 1]]
    return np.concatenate([*parts, np.broadcast_to([half_width, lift], (len(at), 2))], axis=-1)


def whole_strokes(dash: tuple[float, float], length: float) -> tuple[int, float]:
    """Return how many strokes of a dash a line of some length has, and by how much they are stretched.

    Both ends of the line end in ink.

    Raises
    ------
    ValueError
        If they are no lengths, or so short that nobody would see them.
    """
    stroke, gap = dash
    if not (stroke >= 0.0 and gap >= 0.0 and stroke + gap > 0.0):
        raise ValueError(f"draw.render: Lines.dash must be two lengths, not both 0; got {dash}")
    # Of dots without length it takes two to have both ends.
    count = max(round((length + gap) / (stroke + gap)), 1 if stroke > 0.0 else 2)
    if count > _MOST_DASHES:
        raise ValueError(
            f"draw.render: Lines.dash must make at most {_MOST_DASHES} strokes of a line; "
            f"got {dash}, which makes {count}"
        )
    return count, length / (count * (stroke + gap) - gap)


def dashed(
    points: np.ndarray, color: np.ndarray, dash: tuple[float, float], lens: Lens
) -> tuple[np.ndarray, np.ndarray]:
    """Return the strokes of a dashed line and their colours, as polylines with NaN between them."""
    stroke, gap = dash
    out_points, out_color = [], []
    for s in runs(points):
        page = project(lens.camera, lens.box, points[s])
        length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(page[:, :2], axis=0), axis=-1))])
        # What is linear on the page is a quotient in space: the far half of a segment is shorter there.
        weight = 1.0 / page[:, 2] if isinstance(lens.camera, Camera) else np.ones(len(page))
        if length[-1] == 0.0:
            continue
        count, scale = whole_strokes(dash, float(length[-1]))
        first = np.arange(count) * (stroke + gap) * scale
        last = first + stroke * scale
        low, high = np.searchsorted(length, first, "right"), np.searchsorted(length, last)
        ends = zip(first, low, high, last, strict=True)
        at = np.concatenate([part for a, i, j, b in ends for part in ([a], length[i:j], [b, np.nan])])
        scaled = np.interp(at, length, weight)
        for source, out in ((points[s], out_points), (color[s], out_color)):
            columns = [np.interp(at, length, column * weight) / scaled for column in source.T]
            out.append(np.stack(columns, axis=-1))
    if not out_points:
        return points[:0], color[:0]
    return np.concatenate(out_points), np.concatenate(out_color)
