"""How good a triangulation of two shapes is: its angles, areas and the maps between its triangles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]


@dataclass(frozen=True)
class Quality:
    """The extremes over all triangles, and where they are.

    Attributes
    ----------
    least_angle : (float, float)
        In the source and in the target, in radians; pi/3 would be the best.
    least_angle_at : (int, int)
        The triangles that have them.
    middle_angle : (float, float)
        The median over the triangles of their least angles, in radians.
    area_ratio : (float, float)
        The least and the largest determinant of a map: the area in the target over that in the source.
    condition : float
        The largest condition number of a map: its larger over its smaller singular value.
    condition_at : int
        The triangle that has it.
    middle_condition : float
        The median of the condition numbers.
    """

    least_angle: tuple[float, float]
    least_angle_at: tuple[int, int]
    middle_angle: tuple[float, float]
    area_ratio: tuple[float, float]
    condition: float
    condition_at: int
    middle_condition: float


def measure(source: Array, target: Array, faces: Ints) -> Quality:
    """Return the quality of a triangulation without flat triangles.

    Parameters
    ----------
    source, target : (n, 2)
    faces : (m, 3) of int
    """
    angles = [_least_angles(X, faces) for X in (source, target)]
    a, b = (_sides(X, faces) for X in (source, target))
    det_a, det_b = (x[:, 0, 0] * x[:, 1, 1] - x[:, 0, 1] * x[:, 1, 0] for x in (a, b))
    ratio = det_b / det_a
    adjugate = np.stack([a[:, 1, 1], -a[:, 0, 1], -a[:, 1, 0], a[:, 0, 0]], axis=-1).reshape(-1, 2, 2)
    # |B adj A|^2 / (det B det A) is the sum of the condition number and its inverse.
    both = np.sum((b @ adjugate) ** 2, axis=(1, 2)) / (det_a * det_b)
    half = np.maximum(0.5 * both, 1.0)
    condition = half + np.sqrt(half * half - 1.0)
    at = [int(np.argmin(x)) for x in angles]
    return Quality(
        least_angle=(float(angles[0][at[0]]), float(angles[1][at[1]])),
        least_angle_at=(at[0], at[1]),
        middle_angle=(float(np.median(angles[0])), float(np.median(angles[1]))),
        area_ratio=(float(ratio.min()), float(ratio.max())),
        condition=float(condition.max()),
        condition_at=int(np.argmax(condition)),
        middle_condition=float(np.median(condition)),
    )


def _sides(points: Array, faces: Ints) -> Array:
    """Return the matrices whose columns are two sides of each triangle."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.stack([b - a, c - a], axis=-1)


def _least_angles(points: Array, faces: Ints) -> Array:
    angles = []
    for k in range(3):
        sides = _sides(points, np.roll(faces, k, axis=1))
        cross = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 1, 0] * sides[:, 0, 1]
        angles.append(np.arctan2(cross, np.sum(sides[:, :, 0] * sides[:, :, 1], axis=1)))
    return np.min(angles, axis=0)
