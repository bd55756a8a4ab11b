"""The formulas that must be fast, on components: one row of numbers for each entry of a matrix or vector.

`blocks.run` feeds them.  Nothing here checks its input.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import series
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]


def matrix(q: Rows) -> Rows:
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


def rotation_exp(x: Array) -> Rows:
    """Return the rotation about x by |x|, Rodrigues' formula (7.4).

    It goes by way of the quaternion cos(theta/2) + sin(theta/2) u, whose norm
    is divided out; so the rounding of |x| and of its sine and cosine cannot
    stretch the result, which summing I + a X + b X^2 lets it do near pi.
    """
    x, y, z = x
    h = 0.5 * np.sqrt(x * x + y * y + z * z)
    a = 0.5 * series.sinc(h)
    return matrix((np.cos(h), a * x, a * y, a * z))


def _second_order(vector: Array, a: Array | float, b: Array) -> Rows:
    """Return I + a X + b X^2 for the vector x, by X^2 = x x^T - |x|^2 I."""
    x, y, z = vector
    bx, by, bz = b * x, b * y, b * z
    ax, ay, az = a * x, a * y, a * z
    xx, yy, zz, xy, xz, yz = bx * x, by * y, bz * z, bx * y, bx * z, by * z
    return (
        *(1.0 - (yy + zz), xy - az, xz + ay),
        *(xy + az, 1.0 - (xx + zz), yz - ax),
        *(xz - ay, yz + ax, 1.0 - (xx + yy)),
    )


def left_jacobian(x: Array) -> Rows:
    """Return the matrix of (7.5)."""
    theta = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    return _second_order(x, series.versinc(theta), series.sine_defect(theta))


def left_jacobian_inverse(x: Array) -> Rows:
    """Return the matrix of (7.8)."""
    theta = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    return _second_order(x, -0.5, series.cotangent_defect(theta))


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


def product(q: Array, p: Array) -> Rows:
    """Return Hamilton's product q p."""
    a, b, c, d = q
    w, x, y, z = p
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
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
