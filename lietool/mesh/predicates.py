"""Which way three points turn, decided exactly.

The determinant is computed in floating point for all triples at once; where
its rounding error could change the sign, and only there, it is computed again
in rational numbers.  The bound is Shewchuk's first (Adaptive precision
floating-point arithmetic and fast robust geometric predicates, 1997, 4.2).
"""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BOUND = (3.0 + 16.0 * 2.0**-53) * 2.0**-53
# Products below this may have lost bits to underflow, which the bound knows nothing of.
_TINY = 1e-280


def orientation(a: Array, b: Array, c: Array) -> NDArray[np.int8]:
    """Return the sign of the signed area of triangles: 1 counter-clockwise, -1 clockwise, 0 on a line.

    Parameters
    ----------
    a, b, c : (..., 2)
        Finite; broadcast against each other.

    Returns
    -------
    sign : (...) of int8
    """
    left = (a[..., 0] - c[..., 0]) * (b[..., 1] - c[..., 1])
    right = (a[..., 1] - c[..., 1]) * (b[..., 0] - c[..., 0])
    det = np.asarray(left - right)
    sign = np.array(np.sign(det), np.int8)
    unsure = np.abs(det) <= _BOUND * (np.abs(left) + np.abs(right)) + _TINY
    if np.any(unsure):
        a, b, c = (np.broadcast_to(x, (*det.shape, 2))[unsure] for x in (a, b, c))
        sign[unsure] = [_exact(*row) for row in np.concatenate([a, b, c], axis=-1).tolist()]
    return sign


def _exact(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    if (ax == bx and ay == by) or (bx == cx and by == cy) or (ax == cx and ay == cy):
        return 0
    if (ax == bx == cx) or (ay == by == cy):
        return 0
    x, y = Fraction(cx), Fraction(cy)
    det = (Fraction(ax) - x) * (Fraction(by) - y) - (Fraction(ay) - y) * (Fraction(bx) - x)
    return (det > 0) - (det < 0)
