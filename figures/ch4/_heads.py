"""Arrowheads on a path: which way it is gone, and how often."""

import numpy as np

from lietool.render import scene

# Radius of a head in radii of its tube.
_WIDE = 4.0


def head(curve: np.ndarray, at: int, color: str, radius: float) -> list[scene.Record]:
    """Return a head on a tube of that radius along a curve (n, 3), at its point `at`; none where it rests."""
    around = curve[[max(at - 1, 0), min(at + 1, len(curve) - 1)]]
    step = around[1] - around[0]
    length = float(np.linalg.norm(step))
    if length < 1e-9:
        return []
    # Half of a short arrow is its head.
    reach = 3.0 * _WIDE * radius / length * step
    return [scene.Arrow(curve[at] - 0.5 * reach, curve[at] + 0.5 * reach, color, radius, _WIDE)]
