"""Shapes of our own in two poses, with one triangulation for both: a gecko, a snake, a cat and a fish.

A shape is a skeleton with flesh round its bones.  It is meshed once, at rest, and posed twice by turning
its bones; the flesh follows the bones near it (linear blend skinning).  The two poses therefore have the same
triangles, none of them turned over as long as the joints bend gently.

The outline is the zero set of a smooth distance to the flesh.  Points at even distances on it, and a
hexagonal lattice inside, are joined by Delaunay's triangulation and smoothed.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import _skeletons as skeletons
from lietool.mesh import topology
from lietool.mesh._skeletons import Pose, Skeleton

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# How soon the pull of a bone fades with the distance from it.
_FADE = 4.0


@dataclass(frozen=True, eq=False)
class Shape:
    """Two shapes with one triangulation.

    Attributes
    ----------
    source, target : (n, 2)
    faces : (m, 3) of int
        Counter-clockwise in both.
    boundary : (k,) of int
        The outline, counter-clockwise.
    along : (n,)
        From 0 at the nose to 1 at the tip of the tail: by this number both poses are coloured alike.
    marks : mapping from str to int
        Vertices with a name: "nose", "tail", names that begin with "eye", ...
    """

    source: Array
    target: Array
    faces: Index
    boundary: Index
    along: Array
    marks: Mapping[str, int]


@cache
def gecko() -> Shape:
    """Return a gecko, seen from above, that turns round and bends."""
    return _shape(skeletons.gecko())


@cache
def snake() -> Shape:
    """Return a snake that rolls up by more than 540 degrees."""
    return _shape(skeletons.snake())


@cache
def cat() -> Shape:
    """Return a cat, seen from the side, that leaps."""
    return _shape(skeletons.cat())


@cache
def fish() -> Shape:
    """Return a slender fish, seen from above, that turns away and bends."""
    return _shape(skeletons.fish())


SHAPES: dict[str, Callable[[], Shape]] = {"gecko": gecko, "snake": snake, "cat": cat, "fish": fish}


def _shape(skeleton: Skeleton) -> Shape:
    rest, faces, marks = _mesh(skeleton)
    weights = _weights(skeleton, rest)
    source, target = (_posed(skeleton, pose, rest, weights, marks) for pose in skeleton.poses)
    x = rest[:, 0]
    along = (x.max() - x) / np.ptp(x)
    for array in (source, target, faces, along):
        # One object serves every caller.
        array.setflags(write=False)
    return Shape(source, target, faces, topology.boundary(faces)[0], along, marks)


def _to_bones(skeleton: Skeleton, points: Array) -> Array:
    """The distances (b, n) of points from the surface of the flesh of each bone, negative inside."""
    start = np.array([bone.start for bone in skeleton.bones])[:, None]
    along = np.array([bone.end for bone in skeleton.bones])[:, None] - start
    thick = np.array([bone.thick for bone in skeleton.bones])
    part = np.clip(np.sum((points - start) * along, axis=-1) / np.sum(along**2, axis=-1), 0.0, 1.0)
    distance = np.linalg.norm(points - start - part[..., None] * along, axis=-1)
    return distance - (thick[:, :1] + part * (thick[:, 1:] - thick[:, :1]))


def _depth(skeleton: Skeleton, points: Array) -> Array:
    """A smooth distance from the outline (n,), negative inside."""
    d = _to_bones(skeleton, points) / skeleton.blend
    least = d.min(axis=0)
    return skeleton.blend * (least - np.log(np.exp(least - d).sum(axis=0)))


def _onto(skeleton: Skeleton, points: Array) -> Array:
    """Points near the outline brought onto it, along the gradient."""
    step = 1e-5
    for _ in range(4):
        moved = points[:, None] + step * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        depth = _depth(skeleton, moved.reshape(-1, 2)).reshape(-1, 4)
        gradient = (depth[:, ::2] - depth[:, 1::2]) / (2.0 * step)
        points = points - (_depth(skeleton, points) / np.sum(gradient**2, axis=1))[:, None] * gradient
    return points


def _outline(skeleton: Skeleton) -> Array:
    """Points on the outline at even distances, about the spacing."""
    from skimage.measure import find_contours

    joints = np.array([joint for bone in skeleton.bones for joint in (bone.start, bone.end)])
    low, high, cell = joints.min(axis=0) - 0.6, joints.max(axis=0) + 0.6, skeleton.spacing / 4.0
    x, y = (np.arange(a, b, cell) for a, b in zip(low, high, strict=True))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    depth = _depth(skeleton, grid.reshape(-1, 2)).reshape(grid.shape[:2])
    longest = max(find_contours(depth, 0.0), key=len)
    curve = _onto(skeleton, low + cell * longest)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], round(length[-1] / skeleton.spacing) + 1)[:-1]
    return _onto(skeleton, np.stack([np.interp(at, length, column) for column in curve.T], axis=1))


def _mesh(skeleton: Skeleton) -> tuple[Array, Index, dict[str, int]]:
    """The triangulation at rest: vertices, faces, and the vertices with a name."""
    rim = _outline(skeleton)
    h = skeleton.spacing
    low, high = rim.min(axis=0), rim.max(axis=0)
    rows = np.arange(low[1], high[1], np.sqrt(0.75) * h)
    lattice = [
        np.stack(np.broadcast_arrays(np.arange(low[0] + 0.5 * h * (k % 2), high[0], h), y), axis=1)
        for k, y in enumerate(rows)
    ]
    inside = np.concatenate(lattice)
    inside = inside[_depth(skeleton, inside) < -0.6 * h]
    points = np.concatenate([rim, inside])
    held = np.arange(len(points)) < len(rim)
    marks = {}
    for name, position in skeleton.marks.items():
        # A tip takes the nearest vertex of the outline, an eye one of those inside.
        within = name.startswith(("eye", "inner"))
        among = np.flatnonzero(held != within)
        nearest = int(among[np.argmin(np.linalg.norm(points[among] - position, axis=1))])
        points[nearest] = position if within else _onto(skeleton, np.array([position]))[0]
        marks[name] = nearest
    held[list(marks.values())] = True
    faces = _joined(skeleton, points)
    for _ in range(3):
        points = _smoothed(points, faces, held)
        faces = _joined(skeleton, points)
    return points, faces, marks


def _joined(skeleton: Skeleton, points: Array) -> Index:
    """Delaunay's triangles that lie inside, counter-clockwise, in an order of their own."""
    from scipy.spatial import Delaunay

    faces = np.asarray(Delaunay(points).simplices, np.intp)
    faces = faces[_depth(skeleton, points[faces].mean(axis=1)) < -0.02 * skeleton.spacing]
    over = topology.areas(points, faces) < 0.0
    faces[over] = faces[over][:, ::-1]
    first = np.argmin(faces, axis=1)[:, None]
    faces = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return faces[np.lexsort(faces.T[::-1])]


def _smoothed(points: Array, faces: Index, held: NDArray[np.bool_]) -> Array:
    """Each free vertex moved towards the mean of its neighbours, some times."""
    half = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    a, b = np.concatenate([half, half[:, ::-1]]).T
    count = np.bincount(a, minlength=len(points))[:, None]
    for _ in range(8):
        sums = np.stack([np.bincount(a, points[b, k], len(points)) for k in (0, 1)], axis=1)
        points = np.where(held[:, None], points, 0.4 * points + 0.6 * sums / count)
    return points


def _weights(skeleton: Skeleton, points: Array) -> Array:
    """How much each bone moves each point (b, n): mostly the bone whose flesh it is."""
    middle = np.array([np.mean(bone.thick) for bone in skeleton.bones])[:, None]
    # Relative to the thickness, and never 0 or less: on a bone it is a small number.
    distance = np.maximum(_to_bones(skeleton, points) + middle, 0.0) / middle + 0.15
    share = distance**-_FADE
    return share / share.sum(axis=0)


def _posed(skeleton: Skeleton, pose: Pose, points: Array, weights: Array, marks: Mapping[str, int]) -> Array:
    """Points after all bones have turned: each goes where its bones, by their weights, take it."""
    motion: dict[str, tuple[complex, complex]] = {}
    for bone in skeleton.bones:
        turn, shift = motion[bone.parent] if bone.parent else (1.0 + 0.0j, 0.0j)
        joint = complex(*bone.start)
        own = np.exp(1j * np.radians(pose.turns.get(bone.name, 0.0)))
        # z -> turn (joint + own (z - joint)) + shift
        motion[bone.name] = (turn * own, turn * joint * (1.0 - own) + shift)
    turns, shifts = np.array([motion[bone.name] for bone in skeleton.bones]).T
    z = points[:, 0] + 1j * points[:, 1]
    moved = np.sum(weights * (turns[:, None] * z + shifts[:, None]), axis=0)
    moved += complex(*pose.middle) - 0.5 * (moved[marks["nose"]] + moved[marks["tail"]])
    return np.stack([moved.real, moved.imag], axis=1)
