"""A body of any number of vertices, cages round it, and known maps of space that bend and twist."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_GOLDEN = 0.5 * (1.0 + 5.0**0.5)
_CORNERS = np.array([[0, s, t * _GOLDEN] for s in (-1, 1) for t in (-1, 1)])
_CORNERS = np.concatenate([np.roll(_CORNERS, k, axis=1) for k in range(3)]) / np.hypot(1.0, _GOLDEN)

# Where limbs grow out of the ball, how long, and how thin.
_LIMBS = np.array([[1.0, 0, 0.2], [-0.6, 0.8, 0], [-0.6, -0.8, 0], [0.3, 0.7, -0.9], [0.3, -0.7, -0.9]])
_LIMBS /= np.linalg.norm(_LIMBS, axis=1, keepdims=True)
_LONG, _THIN = 1.2, 9.0


def sphere(count: int) -> tuple[Array, Index]:
    """Return about so many points of the unit sphere and the triangles between them.

    The faces of an icosahedron, each cut into f^2: 10 f^2 + 2 vertices.

    Parameters
    ----------
    count : int
        12 or more are made.

    Returns
    -------
    V : ndarray, shape (n, 3)
    F : ndarray of int, shape (m, 3)
        Counter-clockwise seen from outside.
    """
    f = max(1, round(((count - 2) / 10.0) ** 0.5))
    faces = _icosahedron()
    i, j = np.meshgrid(np.arange(f + 1), np.arange(f + 1), indexing="ij")
    inside = i + j <= f
    share = np.stack([f - i - j, i, j], axis=-1)[inside]
    points = share @ _CORNERS[faces]
    # A point is on the same corners, with the same shares, in every face that has it.
    name = np.where(share > 0, faces[:, None, :] * (f + 1) + share, 0)
    name.sort(axis=-1)
    base = 12 * (f + 1)
    key = (name[..., 0] * base + name[..., 1]) * base + name[..., 2]
    _, first, place = np.unique(key, return_index=True, return_inverse=True)
    number = np.full((f + 1, f + 1), -1)
    number[inside] = np.arange(len(share))
    up = np.stack([number[:-1, :-1], number[1:, :-1], number[:-1, 1:]], axis=-1)
    down = np.stack([number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    cut = np.concatenate([up[up.min(axis=-1) >= 0], down[down.min(axis=-1) >= 0]])
    V = points.reshape(-1, 3)[first]
    F = place.reshape(len(faces), -1)[:, cut].reshape(-1, 3)
    return V / np.linalg.norm(V, axis=1, keepdims=True), F


def _icosahedron() -> Index:
    """Return its twenty faces: corners at the distance of an edge from each other, seen from outside."""
    apart = np.linalg.norm(_CORNERS[:, None] - _CORNERS, axis=-1)
    near = (apart > 0.0) & (apart < 1.2)
    i, j, k = (axis.ravel() for axis in np.indices((12, 12, 12)))
    chosen = (i < j) & (i < k) & near[i, j] & near[j, k] & near[k, i]
    faces = np.stack([i, j, k], axis=-1)[chosen]
    return faces[np.linalg.det(_CORNERS[faces]) > 0.0]


def body(count: int) -> tuple[Array, Index]:
    """Return a closed body with five limbs, of about so many vertices."""
    V, F = sphere(count)
    grown = _LONG * np.sum(np.exp(_THIN * (V @ _LIMBS.T - 1.0)), axis=1)
    return V * (1.0 + grown)[:, None], F


def cage(V: Array, count: int = 42) -> tuple[Array, Index]:
    """Return a ball of about so many vertices round points."""
    low, high = V.min(axis=0), V.max(axis=0)
    C, F = sphere(count)
    middle = 0.5 * (low + high)
    # Its faces are nearer to the middle than its corners.
    radius = np.max(np.linalg.norm(V - middle, axis=1))
    return middle + 1.4 * radius * C, F


def along(V: Array, box: Array | None = None) -> tuple[int, Array, Array]:
    """Return the longest axis of a box, the middle of its lower end, and where points are: 0 to 1 along it.

    The box is given by its two corners; that of the points unless given.
    """
    low, high = (V.min(axis=0), V.max(axis=0)) if box is None else box
    axis = int(np.argmax(high - low))
    foot = 0.5 * (low + high)
    foot[axis] = low[axis]
    return axis, foot, (V[:, axis] - low[axis]) / max(high[axis] - low[axis], 1e-300)


def twisted(V: Array, box: Array | None = None, angle: float = 2.0) -> Array:
    """Return points turned about the longest axis, the more the farther along it."""
    axis, foot, t = along(V, box)
    return foot + _turned(V - foot, (axis + 1) % 3, (axis + 2) % 3, angle * t)


def bent(V: Array, box: Array | None = None, angle: float = 1.2) -> Array:
    """Return points on a bar that has become an arc of a circle, as long as it was."""
    axis, foot, t = along(V, box)
    x = V - foot
    side = (axis + 1) % 3
    low, high = (V.min(axis=0), V.max(axis=0)) if box is None else box
    length = max(high[axis] - low[axis], 1e-300)
    # The circle is so far away that nothing reaches its middle.
    radius = max(length / angle, 1.2 * (high[side] - low[side]))
    theta = length * t / radius
    result = x.copy()
    result[:, axis] = (radius - x[:, side]) * np.sin(theta)
    result[:, side] = radius - (radius - x[:, side]) * np.cos(theta)
    return foot + result


def swollen(V: Array, box: Array | None = None, most: float = 1.5) -> Array:
    """Return points moved away from the longest axis, the more the farther along it."""
    axis, foot, t = along(V, box)
    factor = 1.0 + (most - 1.0) * t
    result = (V - foot) * factor[:, None]
    result[:, axis] = (V - foot)[:, axis]
    return foot + result


MAPS: dict[str, Callable[..., Array]] = {"twisted": twisted, "bent": bent, "swollen": swollen}


def _turned(x: Array, i: int, j: int, angle: Array) -> Array:
    result = x.copy()
    c, s = np.cos(angle), np.sin(angle)
    result[:, i], result[:, j] = c * x[:, i] - s * x[:, j], s * x[:, i] + c * x[:, j]
    return result
