"""SO(2) as a circle in the plane of the matrices [[a, -b], [b, a]], and the letter on stems around it.

The circle is turned so that I is its lowest point: on it larger angles are farther to the right near I.
"""

import numpy as np

from lietool.render import scene, style
from lietool.render.plane import Plane, direction

# The largest height of a letter, in radii of the circle.
_GLYPH = 0.42


def drawn(M: np.ndarray) -> np.ndarray:
    """Return where matrices [[a, -b], [b, a]] (..., 2, 2) are drawn: (b, -a), so that I is lowest."""
    return np.stack([M[..., 1, 0], -M[..., 0, 0]], axis=-1)


def toward(angle: np.ndarray | float) -> np.ndarray:
    """Return where rotations are drawn, by their angles (...), radians."""
    return np.stack([np.sin(angle), -np.cos(angle)], axis=-1)


def disc(place: Plane) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces of the area of the circle."""
    rim = direction(np.linspace(0.0, 2.0 * np.pi, 121))
    n = np.arange(1, 121)
    return place.at(np.concatenate([[[0.0, 0.0]], rim])), np.stack([0 * n, n, n + 1], axis=-1)


def held(
    place: Plane, at: np.ndarray, middle: np.ndarray, M: np.ndarray, size: float, fill: str, edge: str
) -> list[scene.Record]:
    """Return the letter under a matrix in some place, on a stem from where the matrix is."""
    moved = np.eye(3)
    moved[:2, :2], moved[:2, 2] = M, middle
    away = at - middle
    part = min(0.45 * size * float(np.linalg.norm(M[0])) / float(np.linalg.norm(away)), 1.0)
    return [
        place.line(np.stack([at, middle + part * away]), edge, style.THIN),
        *place.glyph(moved, fill, edge, size=size, width=style.THIN),
    ]


def size(apart: float, least: float) -> float:
    """Return the height of letters that far from each other; those at one place may be as large as any."""
    return min(_GLYPH, max(0.85 * apart, least)) if apart > 1e-9 else _GLYPH
