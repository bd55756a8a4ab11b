"""Where a label that may move goes: the place near its point that is freest of other text and of lines.

Everything is decided from the records as they are projected onto the page, not from pixels, so that a label
lies in the same place whatever renders the picture.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lietool.render.camera import Box, Camera, Page, project
from lietool.render.scene import (
    Arrow,
    Frame,
    Image,
    Label,
    Lines,
    Picture,
    Points,
    Record,
    Surface,
    Tube,
    View,
)

# In page units: what stays free around a text, and what stays free at the edges of the page.
_MARGIN, _EDGE = 5.0, 16.0
_DIRECTIONS = 16
# How far apart the places are that are tried along each direction, and the least distance from the point.
_STEP, _NEAR = 9.0, 10.0
# What is bad about a place, in page units of the way to the liked one that would be gone to avoid it.
_OUTSIDE, _OVERLAP, _CROSSED = 1e4, 2e3, 6.0
# In a film, how much worse than the liked place the one of the frame before may be.
_KEEP = 3.0
# Costs that differ by less are equal: the earlier place is taken.
_EQUAL = 1e-3


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Segments on the page that no text should lie on.

    Parameters
    ----------
    ends : ndarray, shape (n, 2, 2)
        In page units.
    half_width : ndarray, shape (n,)
    weight : ndarray, shape (n,)
        1 for a strong line, less for a pale or thin one.
    """

    ends: np.ndarray
    half_width: np.ndarray
    weight: np.ndarray

    def near(self, box: np.ndarray) -> "Obstacles":
        """Return those whose own box touches a box (left, lower, right, upper)."""
        low = self.ends.min(axis=1) - self.half_width[:, None]
        high = self.ends.max(axis=1) + self.half_width[:, None]
        close = (low <= box[2:]).all(axis=1) & (high >= box[:2]).all(axis=1)
        return Obstacles(self.ends[close], self.half_width[close], self.weight[close])


def obstacles(picture: Picture) -> Obstacles:
    """Return what text should keep away from: lines, points, arrows, and the outlines of surfaces."""
    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    parts = [
        part
        for view in picture.views
        for record in view.records
        if (part := _segments(record, view, view.box or page)) is not None
    ]
    if not parts:
        return Obstacles(np.zeros((0, 2, 2)), np.zeros(0), np.zeros(0))
    return Obstacles(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


Wanted = Sequence[tuple[Label, np.ndarray, np.ndarray]]
"""Each label with its point (2,) and the box (left, lower, right, upper) of its text, in page units."""


def places(wanted: Wanted, picture: Picture) -> list[tuple[float, float]]:
    """Return by how much each label is moved from where its offset and anchor put it, in page units.

    Parameters
    ----------
    wanted : sequence of (Label, ndarray (2,), ndarray (4,))
    picture : Picture

    Returns
    -------
    list of (float, float)
        (0, 0) for a label without room.
    """
    if not any(label.room for label, _, _ in wanted):
        return [(0.0, 0.0) for _ in wanted]
    return Plan.of(wanted, picture).places([None] * len(wanted))


@dataclass(frozen=True, eq=False)
class _Spots:
    """Where one label may go: middles of its box, the liked one first, and how bad each is by itself."""

    half: np.ndarray
    centers: np.ndarray
    cost: np.ndarray

    @property
    def boxes(self) -> np.ndarray:
        """What is to stay free, left, lower, right, upper; shape (n, 4)."""
        wide = self.half + _MARGIN
        return np.concatenate([self.centers - wide, self.centers + wide], axis=1)


@dataclass(frozen=True, eq=False)
class Plan:
    """The labels of a picture with all the places where they may go."""

    wanted: Wanted
    spots: tuple[_Spots | None, ...]

    @classmethod
    def of(cls, wanted: Wanted, picture: Picture) -> "Plan":
        """Return the plan of a picture; a label without room has no spots but its own."""
        around = obstacles(picture)
        page = np.array([_EDGE, _EDGE, picture.size[0] - _EDGE, picture.size[1] - _EDGE])
        return cls(
            wanted,
            tuple(
                _spots(point, box, label.room, around, page) if label.room else None
                for label, point, box in wanted
            ),
        )

    def places(self, before: Sequence[tuple[float, float] | None]) -> list[tuple[float, float]]:
        """Return the moves of all labels.

        Parameters
        ----------
        before : sequence of (float, float) or None
            In a film, their moves in the frame before, which they keep if they can; None for a new label.
        """
        moves = [np.zeros(2) if move is None else np.asarray(move) for move in before]
        # The second round sees where the labels after it went in the first.
        for _ in range(2):
            for i, spots in enumerate(self.spots):
                if spots is None:
                    continue
                others = [
                    box + np.tile(moves[j], 2)
                    for j, (_, _, box) in enumerate(self.wanted)
                    if j != i and (box[2:] > box[:2]).all()
                ]
                moves[i] = _best(spots, np.reshape(others, (-1, 4)), before[i])
        return [(float(x), float(y)) for x, y in moves]


def _best(spots: _Spots, others: np.ndarray, kept: tuple[float, float] | None) -> np.ndarray:
    wide, liked = spots.boxes, spots.centers[0]
    overlapping = (wide[:, None, :2] < others[None, :, 2:]) & (wide[:, None, 2:] > others[None, :, :2])
    away = np.linalg.norm(spots.centers - liked, axis=-1)
    if kept is not None:
        away = 0.3 * away + _KEEP * np.linalg.norm(spots.centers - liked - kept, axis=-1)
    cost = spots.cost + _OVERLAP * overlapping.all(axis=-1).sum(axis=1) + away
    return spots.centers[int(np.argmax(cost <= cost.min() + _EQUAL))] - liked


def _spots(point: np.ndarray, box: np.ndarray, room: float, around: Obstacles, page: np.ndarray) -> _Spots:
    half = (box[2:] - box[:2]) / 2.0
    liked = (box[2:] + box[:2]) / 2.0
    spots = _Spots(
        half, np.concatenate([liked[None], _candidates(point, half, liked - point, room)]), np.zeros(0)
    )
    wide = spots.boxes
    outside = (spots.centers - half < page[:2]) | (spots.centers + half > page[2:])
    reach = np.concatenate([wide[:, :2].min(axis=0), wide[:, 2:].max(axis=0)])
    cost = _OUTSIDE * outside.any(axis=1) + _CROSSED * crossed(wide, around.near(reach))
    return _Spots(half, spots.centers, cost)


def crossed(boxes: np.ndarray, around: Obstacles) -> np.ndarray:
    """Return the weighted length of obstacles in each box (left, lower, right, upper); shape (n,)."""
    if not len(around.ends):
        return np.zeros(len(boxes))
    start, along = around.ends[:, 0], around.ends[:, 1] - around.ends[:, 0]
    length = np.linalg.norm(along, axis=-1)
    first, last = np.zeros((len(boxes), len(start))), np.ones((len(boxes), len(start)))
    for axis in range(2):
        low = boxes[:, None, axis] - around.half_width - start[:, axis]
        high = boxes[:, None, axis + 2] + around.half_width - start[:, axis]
        step = along[:, axis]
        flat = np.abs(step) < 1e-9
        safe = np.where(flat, 1.0, step)
        one, two = low / safe, high / safe
        # A segment across this axis is inside for its whole length, or not at all.
        inside = (low <= 0.0) & (high >= 0.0)
        first = np.maximum(first, np.where(flat, np.where(inside, 0.0, 2.0), np.minimum(one, two)))
        last = np.minimum(last, np.where(flat, np.where(inside, 1.0, -1.0), np.maximum(one, two)))
    part = np.maximum(last - first, 0.0) * length + np.where(last >= first, 2.0 * around.half_width, 0.0)
    return (part * around.weight).sum(axis=1)


def _candidates(point: np.ndarray, half: np.ndarray, liked: np.ndarray, room: float) -> np.ndarray:
    """Middles of boxes around a point, none nearer to it than the text's liked place, at most `room` away."""
    gap = np.linalg.norm(np.maximum(np.abs(liked) - half, 0.0))
    first = np.arctan2(liked[1], liked[0]) if np.linalg.norm(liked) > 1e-9 else np.pi / 2
    # From the liked direction to both sides.
    k = np.arange(_DIRECTIONS)
    angle = first + np.where(k % 2 == 1, (k + 1) // 2, -(k // 2)) * 2.0 * np.pi / _DIRECTIONS
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    # Beside the point the box is centred on it, at a diagonal it touches with its corner.
    aside = half * np.clip(np.sqrt(2.0) * direction, -1.0, 1.0)
    distance = np.arange(min(max(gap, _NEAR), room), room + _STEP / 2.0, _STEP)
    return (point + aside + distance[:, None, None] * direction).reshape(-1, 2)


def _segments(record: Record, view: View, box: Box) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """The ends of a record's segments on the page, half their widths, and their weights."""
    camera = view.camera
    world = box[3] / camera.height if isinstance(camera, Camera) else 1.0
    half, weight = 1.0, 1.0
    match record:
        case Label():
            return None
        case Lines(points=points, width=width, alpha=alpha):
            ends = _pairs(np.asarray(points, float).reshape(-1, 3))
            half, weight = width / 2.0, alpha * min(width / 2.0, 1.0) ** 2
        case Tube(points=points, radius=radius):
            ends, half = _pairs(np.asarray(points, float)), radius * world
        case Arrow(start=start, end=end, radius=radius, alpha=alpha):
            ends = np.array([[start, end]], float)
            half, weight = 2.0 * radius * world, alpha
        case Frame(matrix=matrix, origin=origin, length=length, radius=radius):
            tips = np.asarray(origin, float) + length * np.asarray(matrix, float).T
            ends = np.stack([np.broadcast_to(np.asarray(origin, float), tips.shape), tips], axis=1)
            half = 2.0 * radius * world
        case Points(positions=positions, radius=radius):
            at = np.asarray(positions, float).reshape(-1, 3)
            ends, half = np.stack([at, at], axis=1), radius
        case Image(corner=corner, across=across, up=up):
            one, x, y = (np.asarray(side, float) for side in (corner, across, up))
            ends = _pairs(np.stack([one, one + x, one + x + y, one + y, one]))
        case Surface(alpha=alpha):
            ends, weight = _outline(record, camera), 0.3 + 0.7 * alpha
    if not len(ends):
        return None
    flat = project(camera, box, ends)[..., :2]
    return flat, np.full(len(flat), half), np.full(len(flat), weight)


def _pairs(points: np.ndarray) -> np.ndarray:
    pairs = np.stack([points[:-1], points[1:]], axis=1)
    return pairs[np.isfinite(pairs).all(axis=(1, 2))]


def _outline(surface: Surface, camera: Camera | Page) -> np.ndarray:
    """The edges (n, 2, 3) at which a surface ends, or turns away from the viewer."""
    vertices, faces = np.asarray(surface.vertices, float), np.asarray(surface.faces)
    if not faces.size:
        return np.zeros((0, 2, 3))
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    eye = camera.eye if isinstance(camera, Camera) else np.array([0.0, 0.0, 1e9])
    # Faces without area, as at the poles of a ball, face nowhere.
    real = np.linalg.norm(normals, axis=-1) > 1e-12
    faces, corners, normals = faces[real], corners[real], normals[real]
    front = np.sum(normals * (eye - corners[:, 0]), axis=-1) > 0.0
    # A grid that closes upon itself has its seam twice.
    vertices, same = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
    edges = np.sort(same[faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    key = edges[:, 0] * len(vertices) + edges[:, 1]
    # An edge between two faces that are both seen, or both hidden, is no part of the outline.
    found, where, count = np.unique(key, return_inverse=True, return_counts=True)
    seen = np.bincount(where, np.repeat(front, 3), len(found))
    a, b = found // len(vertices), found % len(vertices)
    outline = ((count == 1) | ((seen > 0) & (seen < count))) & (a != b)
    return np.stack([vertices[a[outline]], vertices[b[outline]]], axis=1)
