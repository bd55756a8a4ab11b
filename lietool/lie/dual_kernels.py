"""The formulas of dual quaternions on components, eight rows each: z, then w, of z + w eps.

`blocks.run` feeds them, as it does `kernels`.  Nothing here checks its input.
"""

import numpy as np

from lietool.lie import checks, kernels, series
from lietool.lie.blocks import Rows


def _conjugate(q: Rows) -> Rows:
    return q[0], -q[1], -q[2], -q[3]


def _dot(a: Rows, b: Rows):
    return sum(x * y for x, y in zip(a[1:], b[1:], strict=True)) + a[0] * b[0]


def product(q: Rows, p: Rows) -> Rows:
    """Return the product, by eps^2 = 0."""
    left, right = kernels.product(q[:4], p[4:]), kernels.product(q[4:], p[:4])
    return *kernels.product(q[:4], p[:4]), *(x + y for x, y in zip(left, right, strict=True))


def normalized(q: Rows) -> Rows:
    """Return q by its norm: z to length 1, and w without its part along z."""
    f = 1.0 / np.sqrt(_dot(q[:4], q[:4]))
    z, w = [f * x for x in q[:4]], [f * x for x in q[4:]]
    along = _dot(z, w)
    return *z, *(x - along * y for x, y in zip(w, z, strict=True))


def exp(x: Rows) -> Rows:
    """Return exp(a + b eps): cos and (sin t)/t of the dual angle |a| + <a, b>/|a| eps, expanded in eps."""
    a, b = x[:3], x[3:]
    theta = np.sqrt(_dot(a, a))
    sinc, slope = series.sinc(theta), series.sinc_slope(theta) * _dot(a, b)
    return (
        *(np.cos(theta), *(sinc * y for y in a)),
        *(-sinc * _dot(a, b), *(sinc * y - slope * v for y, v in zip(b, a, strict=True))),
    )


def log(q: Rows) -> Rows:
    """Return the principal logarithm a + b eps of a unit dual quaternion, |a| <= pi.

    Along the axis u = a / |a| the dual part of exp is (-d sin, d cos u): d is
    read from both, so that nothing is divided by a small sine.  Across it b is
    w stretched by |a| / sin |a|.
    """
    v, w = q[1:4], q[5:]
    s = np.sqrt(_dot(v, v))
    n = np.hypot(s, q[0])
    c = q[0] / n
    # Below this the squares in s have lost digits, and no axis but that of w makes itself felt.
    none = s * checks.LARGEST <= 1.0
    opposite = none & (c < 0.0)
    # atan2(s, c) / s for the unnormalised pair: it carries v to a, whatever the length of z.
    f = series.angle_over_sine(s, np.where(opposite, 1.0, q[0]))
    u = [np.where(none, 0.0, y / np.where(none, 1.0, s)) for y in v]
    along = _dot(u, w) / n
    slide = c * along - s / n * q[4] / n
    across = [y / n - along * e for y, e in zip(w, u, strict=True)]
    # Once more, for f is large near pi and what is left along u would grow with it.
    rest = _dot(u, across)
    a = [f * y for y in v]
    b = [f * n * (y - rest * e) + slide * e for y, e in zip(across, u, strict=True)]
    if np.any(opposite):
        # exp(pi u + d u eps) = -1 - d u eps: the axis is that of the translation, if there is one.
        size = np.sqrt(_dot(w, w))
        still = size == 0.0
        for i, y in enumerate(w):
            axis = np.where(still, float(i == 0), -y / np.where(still, 1.0, size))
            a[i] = np.where(opposite, np.pi * axis, a[i])
            b[i] = np.where(opposite, -y / n, b[i])
    return *a, *b


def translation(q: Rows) -> Rows:
    """Return the translation 2 w / z, for any z but 0; twice, which section 2.8 forgets."""
    f = 2.0 / _dot(q[:4], q[:4])
    return [f * x for x in kernels.product(q[4:], _conjugate(q[:4]))[1:]]


def matrix(q: Rows) -> Rows:
    """Return the homogeneous matrix."""
    R, t = kernels.matrix(q[:4]), translation(q)
    zero = np.zeros_like(t[0])
    return *R[:3], t[0], *R[3:6], t[1], *R[6:], t[2], zero, zero, zero, zero + 1.0


def act(q: Rows, p: Rows) -> Rows:
    """Return R p + t."""
    R, t = kernels.matrix(q[:4]), translation(q)
    return [R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2] + t[i] for i in range(3)]


def from_translation(z: Rows, t: Rows) -> Rows:
    """Return z + (t z / 2) eps: z first, then the translation by t."""
    w = kernels.product([np.zeros_like(t[0]), *(0.5 * x for x in t)], z)
    return *z, *w


def from_matrix(A: Rows) -> Rows:
    """Return the unit dual quaternion of a homogeneous matrix, with w >= 0 in its real part."""
    z = kernels.quaternion([A[i] for i in (0, 1, 2, 4, 5, 6, 8, 9, 10)])
    return from_translation(z, [A[3], A[7], A[11]])


def ratio(q0: Rows, q1: Rows) -> Rows:
    """Return q0^-1 q1 of two unit dual quaternions.

    Where q1 is near +-q0 it is +-1 plus the product with the difference, which
    subtracts exactly and keeps the digits of a small angle, or of a small gap to pi.
    """
    near = np.where(_dot(q0[:4], q1[:4]) < 0.0, -1.0, 1.0)
    back = [*_conjugate(q0[:4]), *_conjugate(q0[4:])]
    r = product(back, [y - near * x for x, y in zip(q0, q1, strict=True)])
    return near + r[0], *r[1:]


def sclerp(q0: Rows, q1: Rows, t: Rows) -> Rows:
    """Return q0 exp(t log(q0^-1 q1))."""
    return product(q0, exp([t[0] * x for x in log(ratio(q0, q1))]))
