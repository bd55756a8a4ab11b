"""A small library with pictures to keep: spirals as points, as pixels, and as a plot."""

import numpy as np


def spiral(turns: float, count: int = 200) -> np.ndarray:
    """Return points (count, 2) on a spiral from the origin to the unit circle."""
    t = np.linspace(0.0, 1.0, count)
    angle = 2.0 * np.pi * turns * t
    return np.stack([t * np.cos(angle), t * np.sin(angle)], axis=1)


def pixels(points: np.ndarray, size: int = 120) -> np.ndarray:
    """Return an image (size, size) of floats from 0 to 1: light, darker the nearer a point is."""
    y, x = np.mgrid[1.0 : -1.0 : size * 1j, -1.0 : 1.0 : size * 1j]
    far = np.full(x.shape, np.inf)
    for px, py in points:
        far = np.minimum(far, np.hypot(x - px, y - py))
    return np.clip(far / 0.1, 0.0, 1.0)
