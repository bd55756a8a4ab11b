"""Shapes that records are made of: tubes, arrows, balls, rings, as triangles with smooth normals.

These are for looking at, not to compute with: vertices are doubled along sharp edges.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

Triangles = tuple[np.ndarray, np.ndarray, np.ndarray]


def frame_along(direction: ArrayLike) -> np.ndarray:
    """Return a right-handed frame whose third column is along `direction`; shape (3, 3)."""
    w = np.asarray(direction, float)
    w = w / np.linalg.norm(w)
    # The axis least along w keeps the cross product long.
    u = np.cross(np.eye(3)[np.argmin(np.abs(w))], w)
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(w, u), w], axis=-1)


def grid_faces(rows: int, columns: int) -> np.ndarray:
    """Return the triangles of a grid of vertices, row after row; shape (2 (rows - 1)(columns - 1), 3)."""
    a = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([a[:-1, :-1], a[:-1, 1:], a[1:, 1:], a[1:, :-1]], axis=-1).reshape(-1, 4)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def fan_faces(count: int) -> np.ndarray:
    """Return the triangles of a fan of vertices about the first of them; shape (count - 2, 3)."""
    k = np.arange(1, count - 1)
    return np.stack([0 * k, k, k + 1], axis=-1)


def grid(points: np.ndarray) -> Triangles:
    """Return the surface through a grid of points.

    Parameters
    ----------
    points : ndarray, shape (rows, columns, 3)
        A first or last row may be a single point, a pole.
    """
    normals = np.cross(np.gradient(points, axis=0), np.gradient(points, axis=1))
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    normals /= np.where(length > 0.0, length, 1.0)
    for edge, inner in ((0, 1), (-1, -2)):
        if np.ptp(points[edge], axis=0).max() < 1e-9:
            pole = normals[inner].mean(axis=0)
            normals[edge] = pole / np.linalg.norm(pole)
    return points.reshape(-1, 3), grid_faces(*points.shape[:2]), normals.reshape(-1, 3)


def revolve(profile: ArrayLike, segments: int = 40) -> Triangles:
    """Turn a profile about the z axis, with a sharp edge at each of its corners.

    Parameters
    ----------
    profile : array_like, shape (k, 2)
        Radius and height; the outside lies to the right when walking along it.
    segments : int
        Around the axis.

    Returns
    -------
    vertices, faces, normals : ndarray
    """
    profile = np.asarray(profile, float)
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    vertices, normals, faces = [], [], []
    for first, last in pairwise(profile):
        along = last - first
        length = np.linalg.norm(along)
        if length == 0.0:
            continue
        out, up = along[1] / length, -along[0] / length
        for radius, z in (first, last):
            vertices.append(np.column_stack([radius * circle, np.full(segments + 1, z)]))
            normals.append(np.column_stack([out * circle, np.full(segments + 1, up)]))
        start = 2 * (segments + 1) * len(faces)
        faces.append(grid_faces(2, segments + 1) + start)
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(normals)


def arrow(start: ArrayLike, end: ArrayLike, radius: float, head: float = 2.6) -> Triangles:
    """Return an arrow: a cylinder of `radius` and a cone `head` times as wide.

    A short arrow keeps its proportions: the head is never longer than half of it.
    """
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(end - start))
    if length == 0.0:
        return np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 3))
    cone = min(3.0 * head * radius, 0.5 * length)
    wide = cone / 3.0
    profile = [(0, 0), (radius, 0), (radius, length - cone), (wide, length - cone), (0, length)]
    vertices, faces, normals = revolve(profile, 28)
    axes = frame_along(end - start)
    return vertices @ axes.T + start, faces, normals @ axes.T


def sphere(radius: float = 1.0, center: ArrayLike = (0.0, 0.0, 0.0), rings: int = 48) -> Triangles:
    """Return a ball with `rings` parallels and twice as many meridians."""
    theta = np.linspace(0.0, np.pi, rings + 1)[:, None]
    phi = np.linspace(0.0, 2.0 * np.pi, 2 * rings + 1)[None, :]
    normals = np.stack(
        [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0.0 * phi], axis=-1
    ).reshape(-1, 3)
    # From pole to pole first and then around turns the grid's faces inwards.
    faces = grid_faces(rings + 1, 2 * rings + 1)[:, ::-1]
    return radius * normals + np.asarray(center, float), faces, normals


def transported_frames(points: np.ndarray, closed: bool) -> np.ndarray:
    """Return frames along a polyline that turn about it as little as possible; shape (n, 3, 3)."""
    steps = np.diff(points, axis=0)
    steps /= np.linalg.norm(steps, axis=-1, keepdims=True)
    before = np.concatenate([steps[-1:] if closed else steps[:1], steps])
    after = np.concatenate([steps, steps[:1] if closed else steps[-1:]])
    tangents = before + after
    # Where the polyline turns straight back, it passes through a direction across it.
    for i in np.flatnonzero(np.linalg.norm(tangents, axis=-1) < 1e-9):
        tangents[i] = frame_along(before[i])[:, 0]
    tangents /= np.linalg.norm(tangents, axis=-1, keepdims=True)
    # Any frames along the curve, each then turned by what the transport of the one before differs from it.
    u = np.cross(np.eye(3)[np.argmin(np.abs(tangents), axis=-1)], tangents)
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    v = np.cross(tangents, u)
    a, b = tangents[:-1], tangents[1:]
    lean = np.sum(b * u[:-1], axis=-1) / (1.0 + np.sum(a * b, axis=-1))
    carried = u[:-1] - lean[:, None] * (a + b)
    turn = np.arctan2(np.sum(carried * v[1:], axis=-1), np.sum(carried * u[1:], axis=-1))
    angle = np.concatenate([[0.0], np.cumsum(turn)])[:, None]
    first, second = np.cos(angle) * u + np.sin(angle) * v, np.cos(angle) * v - np.sin(angle) * u
    return np.stack([first, second, tangents], axis=-1)


def tube(points: ArrayLike, radius: float, closed: bool = False, segments: int = 16) -> Triangles:
    """Return a round tube along a polyline, with half balls at its ends.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        At least one; repeated ones are left out.
    radius : float
    closed : bool
        Join the last point to the first; then no ends.
    segments : int
        Around the tube.
    """
    points = np.asarray(points, float)
    keep = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=-1) > 1e-12])
    points = points[keep]
    if len(points) < 2:
        return sphere(radius, points[0], 10)
    if closed and np.linalg.norm(points[-1] - points[0]) > 1e-12:
        points = np.concatenate([points, points[:1]])
    frames = transported_frames(points, closed)
    lean, scale = np.zeros(len(points)), np.ones(len(points))
    if not closed:
        cap = np.linspace(0.0, np.pi / 2, 7)[:-1]
        frames = np.concatenate([frames[[0] * 6], frames, frames[[-1] * 6]])
        points = np.concatenate([points[[0] * 6], points, points[[-1] * 6]])
        lean = np.concatenate([-np.cos(cap), lean, np.cos(cap[::-1])])
        scale = np.concatenate([np.sin(cap), scale, np.sin(cap[::-1])])
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    ring = np.cos(angle)[:, None] * frames[:, None, :, 0] + np.sin(angle)[:, None] * frames[:, None, :, 1]
    normals = scale[:, None, None] * ring + (lean[:, None] * frames[:, :, 2])[:, None, :]
    vertices = points[:, None, :] + radius * normals
    faces = grid_faces(len(points), segments + 1)
    return vertices.reshape(-1, 3), faces, normals.reshape(-1, 3)


def band(inner: float, outer: float, thickness: float, bevel: float = 0.15) -> Triangles:
    """Return a flat ring about the z axis with bevelled edges.

    Parameters
    ----------
    inner, outer : float
        Radii.
    thickness : float
        Along z, centred at 0.
    bevel : float
        Width of the slanted edge, as a fraction of the smaller side of the section.
    """
    h = thickness / 2.0
    b = bevel * min(thickness, outer - inner)
    profile = [
        (inner, h - b), (inner, -h + b), (inner + b, -h), (outer - b, -h), (outer, -h + b),
        (outer, h - b), (outer - b, h), (inner + b, h), (inner, h - b),
    ]  # fmt: skip
    return revolve(profile, 120)
