"""The quaternion of a rotation matrix, without cancellation."""

import numpy as np
from numpy.typing import NDArray

from lietool.lie.blocks import Rows


def quaternion(R: NDArray[np.float64]) -> Rows:
    """Return the rows of a positive multiple of the quaternion of R, with w >= 0.

    The ten products 4 q_i q_j are linear in R.  They form a symmetric matrix
    all of whose columns are multiples of q; the one with the largest diagonal
    entry, at least 1, loses nothing to rounding (Shepperd 1978).  At w = 0 the
    largest component is positive.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz = R
    wx, wy, wz = zy - yz, xz - zx, yx - xy
    sxy, sxz, syz = xy + yx, xz + zx, yz + zy
    best = 1.0 + xx + yy + zz
    q = [best.copy(), wx.copy(), wy.copy(), wz.copy()]
    for diagonal, column in (
        (d := 1.0 + xx - yy - zz, (wx, d, sxy, sxz)),
        (d := 1.0 - xx + yy - zz, (wy, sxy, d, syz)),
        (d := 1.0 - xx - yy + zz, (wz, sxz, syz, d)),
    ):
        larger = diagonal > best
        for component, other in zip((*q, best), (*column, diagonal), strict=True):
            np.copyto(component, other, where=larger)
    sign = np.where(q[0] < 0.0, -1.0, 1.0)
    return [component * sign for component in q]
