"""The formulas that must be fast, on components: one row of numbers for each entry of a matrix or vector.

`blocks.run` feeds them.  Nothing here checks its input.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import series
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]


def rodrigues(x: Array) -> Rows:
    """Return I + a X + b X^2 for the vector x, (7.4), by X^2 = x x^T - |x|^2 I."""
    x, y, z = x
    a, b = series.rodrigues(np.sqrt(x * x + y * y + z * z))
    bx, by, bz = b * x, b * y, b * z
    ax, ay, az = a * x, a * y, a * z
    xx, yy, zz, xy, xz, yz = bx * x, by * y, bz * z, bx * y, bx * z, by * z
    return (
        *(1.0 - (yy + zz), xy - az, xz + ay),
        *(xy + az, 1.0 - (xx + zz), yz - ax),
        *(xz - ay, yz + ax, 1.0 - (xx + yy)),
    )


def shepperd(R: Array) -> Rows:
    """Return a positive multiple of the quaternion of R, with w >= 0.

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


def rotation_log(R: Array) -> Rows:
    """Return the principal logarithm of R."""
    w, x, y, z = shepperd(R)
    # x, y, z are sin(theta/2) u and w is cos(theta/2), both to the same scale.
    f = 2.0 * series.angle_over_sine(np.sqrt(x * x + y * y + z * z), w)
    return f * x, f * y, f * z


def quaternion(R: Array) -> Rows:
    """Return the unit quaternion of R, with w >= 0."""
    w, x, y, z = shepperd(R)
    f = 1.0 / np.sqrt(w * w + x * x + y * y + z * z)
    return f * w, f * x, f * y, f * z


def matrix(q: Array) -> Rows:
    """Return the matrix of p -> q p q^-1, (2.28), for any q but 0."""
    w, x, y, z = q
    s = 2.0 / (w * w + x * x + y * y + z * z)
    sx, sy, sz = s * x, s * y, s * z
    wx, wy, wz, xx, yy, zz, xy, xz, yz = (
        w * sx,
        w * sy,
        w * sz,
        x * sx,
        y * sy,
        z * sz,
        x * sy,
        x * sz,
        y * sz,
    )
    return (
        *(1.0 - (yy + zz), xy - wz, xz + wy),
        *(xy + wz, 1.0 - (xx + zz), yz - wx),
        *(xz - wy, yz + wx, 1.0 - (xx + yy)),
    )


def quaternion_exp(x: Array) -> Rows:
    """Return cos |x| + sin |x| u, (2.31)."""
    x, y, z = x
    theta = np.sqrt(x * x + y * y + z * z)
    a = series.sinc(theta)
    return np.cos(theta), a * x, a * y, a * z


def quaternion_log(q: Array) -> Rows:
    """Return the principal logarithm of a unit quaternion; (pi, 0, 0) at -1, where every axis serves."""
    w, x, y, z = q
    s = np.sqrt(x * x + y * y + z * z)
    opposite = (s == 0.0) & (w < 0.0)
    f = series.angle_over_sine(s, np.where(opposite, 1.0, w))
    return np.where(opposite, np.pi, f * x), f * y, f * z


def space_defect(R: Array) -> Rows:
    """Measure how far the columns of R are from |a| = |b| = 1, a . b = 0, c = a x b: R^T R and det in one."""
    ax, bx, cx, ay, by, cy, az, bz, cz = R
    worst = np.abs(ax * ax + ay * ay + az * az - 1.0)
    for defect in (
        bx * bx + by * by + bz * bz - 1.0,
        ax * bx + ay * by + az * bz,
        ay * bz - az * by - cx,
        az * bx - ax * bz - cy,
        ax * by - ay * bx - cz,
    ):
        np.maximum(worst, np.abs(defect, out=defect), out=worst)
    return (worst,)


def plane_defect(R: Array) -> Rows:
    """Measure how far the columns (a, c), (b, d) of R are from |(a, c)| = 1, d = a, b = -c."""
    a, b, c, d = R
    return (np.maximum(np.abs(a * a + c * c - 1.0), np.maximum(np.abs(a - d), np.abs(b + c))),)
