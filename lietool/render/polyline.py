"""Lengths along polylines."""

import numpy as np


def remaining(points: np.ndarray) -> np.ndarray:
    """Return how far it is from each point of a polyline (n, d) to its end; shape (n,)."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    return np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])


def shortened(points: np.ndarray, by: float) -> np.ndarray:
    """Return a polyline (n, d) without the last part of it, `by` long and no longer than all of it."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    left = remaining(points)
    cut = int(np.flatnonzero(left >= by)[-1])
    end = points[cut] + (left[cut] - by) / steps[cut] * (points[cut + 1] - points[cut])
    return np.concatenate([points[: cut + 1], end[None]])
