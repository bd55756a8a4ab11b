"""Upright round strings, each a tube of rings with half a ball at either end, all triangles of one shape."""

import numpy as np
from numpy.typing import NDArray

from lietool.mesh._solid import Solid, normals

Array = NDArray[np.float64]
Index = NDArray[np.intp]


_RADIUS, _LENGTH, _APART = 0.10, 4.0, 0.34


def strings(count: int, around: int) -> Solid:
    """Return `count` strings side by side, with `around` vertices on a ring."""
    V, F = string(_RADIUS, _LENGTH, around)
    shifts = _APART * (np.arange(count) - (count - 1) / 2.0)
    vertices = np.round(np.concatenate([V + np.array([0.0, y, 0.0]) for y in shifts]), 9)
    faces = np.concatenate([F + k * len(V) for k in range(count)])
    names = tuple(f"string {k}" for k in range(count))
    z = np.linspace(-_LENGTH / 2.0, _LENGTH / 2.0, 41)
    axes = {name: np.stack([0.0 * z, 0.0 * z + y, z], axis=1) for name, y in zip(names, shifts, strict=True)}
    angle = np.asarray(np.tile(np.round(np.arctan2(V[:, 1], V[:, 0]), 9), count), float)
    part = np.repeat(np.arange(count), len(V))
    along = np.tile(V[:, 2] / _LENGTH + 0.5, count)
    distances = np.where(part == np.arange(count)[:, None], 0.0, _APART - 2.0 * _RADIUS)
    return Solid(vertices, faces, normals(vertices, faces), names, part, along, angle, distances, axes)


def string(radius: float, length: float, around: int) -> tuple[Array, Index]:
    """Return a string along the z axis, its middle at the origin.

    Parameters
    ----------
    radius, length : float
        The length from tip to tip.
    around : int
        Vertices on a ring.

    Returns
    -------
    V : (n, 3)
    F : (m, 3)
    """
    straight = length - 2.0 * radius
    # Each ring is turned by half a step against the one below, at the height of triangles with equal sides.
    rings = max(2, round(straight / (2.0 * np.pi * radius / around * np.sqrt(0.75))))
    caps = max(2, round(around / 4.0))
    rise = np.linspace(0.0, np.pi / 2.0, caps + 1)[:-1]
    z = np.concatenate([
        -straight / 2.0 - radius * np.cos(rise[1:]),
        np.linspace(-straight / 2.0, straight / 2.0, rings + 1),
        straight / 2.0 + radius * np.cos(rise[:0:-1]),
    ])  # fmt: skip
    wide = np.concatenate(
        [radius * np.sin(rise[1:]), np.full(rings + 1, radius), radius * np.sin(rise[:0:-1])]
    )
    count = len(z)
    angle = 2.0 * np.pi * (np.arange(around) + 0.5 * (np.arange(count) % 2)[:, None]) / around
    ring = np.stack(
        [wide[:, None] * np.cos(angle), wide[:, None] * np.sin(angle), z[:, None] + 0.0 * angle], -1
    )
    tips = np.array([[0.0, 0.0, -length / 2.0], [0.0, 0.0, length / 2.0]])
    V = np.round(np.concatenate([ring.reshape(-1, 3), tips]), 9)
    k, j = np.meshgrid(np.arange(count - 1), np.arange(around), indexing="ij")
    # From an even ring the one above is half a step ahead, from an odd one half a step behind.
    ahead = (k + 1) % 2
    a, b = k * around + j, k * around + (j + 1) % around
    c, d = (k + 1) * around + (j + 1 - ahead) % around, (k + 1) * around + (j + 2 - ahead) % around
    sides = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([b, d, c], -1).reshape(-1, 3)])
    j = np.arange(around)
    low, high = count * around, count * around + 1
    top = (count - 1) * around
    caps_low = np.stack([np.full(around, low), (j + 1) % around, j], -1)
    caps_high = np.stack([np.full(around, high), top + j, top + (j + 1) % around], -1)
    return V, np.concatenate([sides, caps_low, caps_high])
