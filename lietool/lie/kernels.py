"""The formulas that must be fast, on components: one row of numbers for each entry of a matrix or vector.

`blocks.run` feeds them.  Nothing here checks its input.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import series
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]

Vector = Rows | Array

_ZERO, _ONE = np.zeros(()), np.ones(())


def matrix(q: Rows) -> Rows:
    """Return the matrix of p -> q p q^-1, (2.28), for any q but 0.

    For the unit q of (2.26) these are the entries of (A.4) by half angles:
    (1 - cos theta) u_i u_j = 2 q_i q_j and (sin theta) u_i = 2 w q_i.
    """
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

    It goes by way of the quaternion cos(theta/2) + sin(theta/2) u, (2.26), whose norm
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
    """Return the matrix of (7.5), Y of (A.10)."""
    theta = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    return _second_order(x, series.versinc(theta), series.sine_defect(theta))


def left_jacobian_inverse(x: Array) -> Rows:
    """Return the matrix of (7.8), by (1 + cos theta) / sin theta = cot(theta/2)."""
    theta = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    return _second_order(x, -0.5, series.cotangent_defect(theta))


def shepperd(R: Rows | Array) -> Rows:
    """Return a positive multiple of the quaternion of R, with w >= 0.

    The ten products 4 q_i q_j are linear in R, by (2.28): 4 w^2 = 1 + tr R, and
    4 w (x, y, z) is the vector of R - R^T.  They form a symmetric matrix
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
    """Return the principal logarithm of R, theta u.

    The direction of (7.7) and the angle of (7.6), both from the quaternion:
    u sin(theta/2) is its vector, and theta/2 the angle of its two parts.
    """
    w, x, y, z = shepperd(R)
    # x, y, z are sin(theta/2) u and w is cos(theta/2), both to the same scale.
    f = 2.0 * series.angle_over_sine(np.sqrt(x * x + y * y + z * z), w)
    return f * x, f * y, f * z


def _cross(a: Vector, b: Vector) -> Rows:
    """Return the cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _rigid(R: Rows, d: Rows) -> Rows:
    """Return the homogeneous matrix of p -> R p + d, (2.43)."""
    return *R[:3], d[0], *R[3:6], d[1], *R[6:], d[2], _ZERO, _ZERO, _ZERO, _ONE


def rigid_exp(x: Array) -> Rows:
    """Return the screw motion of a twist, (7.4) and (7.5); X p is the cross product with the first half."""
    r, t = x[:3], x[3:]
    theta = np.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    h = 0.5 * theta
    a = 0.5 * series.sinc(h)
    R = matrix((np.cos(h), a * r[0], a * r[1], a * r[2]))
    b, c = 2.0 * a * a, series.sine_defect(theta)
    d = _cross(r, [b * ti + c * rt for ti, rt in zip(t, _cross(r, t), strict=True)])
    return _rigid(R, [ti + di for ti, di in zip(t, d, strict=True)])


def rigid_log(T: Array) -> Rows:
    """Return the principal logarithm of a rigid motion, (7.8) with cot(theta/2), which holds at pi."""
    w, *v = shepperd((*T[0:3], *T[4:7], *T[8:11]))
    d = T[3], T[7], T[11]
    s = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    f = 2.0 * series.angle_over_sine(s, w)
    r = [f * vi for vi in v]
    c = series.cotangent_defect(f * s)
    turned = _cross(r, [0.5 * di - c * rd for di, rd in zip(d, _cross(r, d), strict=True)])
    return *r, *(di - ti for di, ti in zip(d, turned, strict=True))


def _derivative(x: Vector, y: Vector, v: Rows, b: Array, b_slope: Array) -> Rows:
    """Return V + b (X Y + Y X) + (x . y) b_slope X^2, capitals being the matrices of the vectors."""
    s = x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
    e = s * b_slope
    z = [b * yi + 0.5 * e * xi for xi, yi in zip(x, y, strict=True)]
    # X Y + Y X = x y^T + y x^T - 2 (x . y) I, so that what remains is x z^T + z x^T - 2 (x . z) I.
    xx, yy, zz = (2.0 * xi * zi for xi, zi in zip(x, z, strict=True))
    xy, xz, yz = (x[i] * z[j] + x[j] * z[i] for i, j in ((0, 1), (0, 2), (1, 2)))
    return (
        *(-(yy + zz), xy - v[2], xz + v[1]),
        *(xy + v[2], -(xx + zz), yz - v[0]),
        *(xz - v[1], yz + v[0], -(xx + yy)),
    )


def _lower(V: Rows, Q: Rows) -> Rows:
    """Return the 6 x 6 matrix of the blocks V, 0; Q, V."""
    zeros = (_ZERO,) * 3
    upper = (entry for i in (0, 3, 6) for entry in (*V[i : i + 3], *zeros))
    lower = (entry for i in (0, 3, 6) for entry in (*Q[i : i + 3], *V[i : i + 3]))
    return *upper, *lower


def rigid_left_jacobian(x: Array) -> Rows:
    """Return V, 0; Q, V: V of (7.5) at the rotation r, and Q its derivative along the translation t.

    For the series of (e^z - 1) / z in ad x, a block triangular matrix with
    the diagonal X, X, has the derivative of its value at X beside the diagonal.
    """
    r, t = x[:3], x[3:]
    theta = np.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    b, c = series.versinc(theta), series.sine_defect(theta)
    e = (r[0] * t[0] + r[1] * t[1] + r[2] * t[2]) * series.versinc_slope(theta)
    v = [b * ti + e * ri for ri, ti in zip(r, t, strict=True)]
    return _lower(_second_order(r, b, c), _derivative(r, t, v, c, series.sine_defect_slope(theta)))


def rigid_left_jacobian_inverse(x: Array) -> Rows:
    """Return V^-1, 0; Q, V^-1: that of (7.8), and its derivative along the translation."""
    r, t = x[:3], x[3:]
    theta = np.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    c = series.cotangent_defect(theta)
    v = [-0.5 * ti for ti in t]
    return _lower(_second_order(r, -0.5, c), _derivative(r, t, v, c, series.cotangent_defect_slope(theta)))


def plane_exp(x: Array) -> Rows:
    """Return the motion of the plane of a twist: (7.5) with X = theta J, X^2 = -theta^2 I."""
    theta, lx, ly = x
    c, s = np.cos(theta), np.sin(theta)
    a, b = series.sinc(theta), theta * series.versinc(theta)
    return c, 0.0 - s, a * lx - b * ly, s, c, b * lx + a * ly, _ZERO, _ZERO, _ONE


def plane_log(T: Array) -> Rows:
    """Return the principal logarithm of a motion of the plane: (7.8) with X = theta J, X^2 = -theta^2 I."""
    # Adding 0.0 turns -0.0 into 0.0, so that the half turn is pi and never -pi.
    h = 0.5 * np.arctan2(T[3] - T[1] + 0.0, T[0] + T[4])
    a = np.cos(h) / series.sinc(h)  # (theta/2) cot(theta/2)
    return 2.0 * h, a * T[2] + h * T[5], a * T[5] - h * T[2]


def quaternion(R: Rows | Array) -> Rows:
    """Return the unit quaternion of R, with w >= 0."""
    w, x, y, z = shepperd(R)
    f = 1.0 / np.sqrt(w * w + x * x + y * y + z * z)
    return f * w, f * x, f * y, f * z


def product(q: Rows | Array, p: Rows | Array) -> Rows:
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


def quaternion_log(q: Rows | Array) -> Rows:
    """Return the principal logarithm of a unit quaternion; (pi, 0, 0) at -1, where every axis serves."""
    w, x, y, z = q
    s = np.sqrt(x * x + y * y + z * z)
    opposite = (s == 0.0) & (w < 0.0)
    f = series.angle_over_sine(s, np.where(opposite, 1.0, w))
    return np.where(opposite, np.pi, f * x), f * y, f * z


def space_defect(R: Vector) -> Rows:
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


def plane_defect(R: Vector) -> Rows:
    """Measure how far the columns (a, c), (b, d) of R are from |(a, c)| = 1, d = a, b = -c."""
    a, b, c, d = R
    return (np.maximum(np.abs(a * a + c * c - 1.0), np.maximum(np.abs(a - d), np.abs(b + c))),)


def _and_the_rest(worst: Array, d: Array, bottom: Array, unit: float) -> Rows:
    """Return the largest of a defect, that of a bottom row from 0 ... 0 1, and a translation in a unit."""
    for row in (*bottom[:-1], bottom[-1] - 1.0):
        np.maximum(worst, np.abs(row), out=worst)
    for row in d:
        np.maximum(worst, np.abs(unit * row), out=worst)
    return (worst,)


def space_rigid_defect(T: Array, unit: float) -> Rows:
    """Measure the rotation part's defect, the bottom row's, and the translation in a very long unit."""
    (worst,) = space_defect((*T[0:3], *T[4:7], *T[8:11]))
    return _and_the_rest(worst, T[3:12:4], T[12:], unit)


def plane_rigid_defect(T: Array, unit: float) -> Rows:
    """Measure the same in the plane."""
    (worst,) = plane_defect((*T[0:2], *T[3:5]))
    return _and_the_rest(worst, T[2:6:3], T[6:], unit)
