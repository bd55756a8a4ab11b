"""The formulas of dual complex numbers on components, four rows each: re p0, im p0, re p1, im p1."""

import numpy as np

from lietool.lie import series
from lietool.lie.blocks import Rows


def _times(a: Rows, b: Rows) -> Rows:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def product(p: Rows, q: Rows) -> Rows:
    """Return p q by (2.38): the dual unit conjugates what passes it."""
    left, right = _times(p[2:], (q[0], -q[1])), _times(p[:2], q[2:])
    return *_times(p[:2], q[:2]), left[0] + right[0], left[1] + right[1]


def exp(x: Rows) -> Rows:
    """Return exp(i theta + b eps): the square of the argument is the real number -theta^2."""
    s = series.sinc(x[0])
    return np.cos(x[0]), s * x[0], s * x[1], s * x[2]


def log(p: Rows) -> Rows:
    """Return (theta, b) with -pi < theta <= pi; at p0 = -1, where only b = 0 is possible, (pi, 0)."""
    c, s, x, y = p
    n = np.hypot(c, s)
    opposite = (s == 0.0) & (c < 0.0)
    f = series.angle_over_sine(np.abs(s), np.where(opposite, 1.0, c))
    scale = np.where(opposite, 0.0, f * n)
    return np.where(opposite, np.pi, f * s), scale * x / n, scale * y / n


def place(p: Rows) -> Rows:
    """Return alpha = p0^2 and beta = 2 p0 p1, of v -> alpha v + beta, for any p0 but 0."""
    f = 1.0 / (p[0] * p[0] + p[1] * p[1])
    alpha, beta = _times(p[:2], p[:2]), _times(p[:2], p[2:])
    return f * alpha[0], f * alpha[1], 2.0 * f * beta[0], 2.0 * f * beta[1]


def matrix(p: Rows) -> Rows:
    """Return the homogeneous matrix of the plane."""
    a, b, x, y = place(p)
    zero = np.zeros_like(a)
    return a, -b, x, b, a, y, zero, zero, zero + 1.0


def act(p: Rows, v: Rows) -> Rows:
    """Return alpha v + beta."""
    a, b, x, y = place(p)
    turned = _times((a, b), v)
    return turned[0] + x, turned[1] + y


def from_matrix(A: Rows) -> Rows:
    """Return p0, the root of alpha with re p0 >= 0, and p1 = beta / (2 p0); at a half turn p0 = i."""
    a, b = A[0] + A[4], A[3] - A[1]
    # (1 + cos, sin) and (|sin|, 1 - cos) point at the half angle; the longer one keeps its digits.
    c, s = np.hypot(a, b) + np.abs(a), np.abs(b)
    c, s = np.where(a < 0.0, s, c), np.where(a < 0.0, c, s) * np.where(b < 0.0, -1.0, 1.0)
    n = np.hypot(c, s)
    c, s = c / n, s / n
    half = _times((0.5 * A[2], 0.5 * A[5]), (c, -s))
    return c, s, *half


def ratio(p: Rows, q: Rows) -> Rows:
    """Return p^-1 q of two unit dual complex numbers, the digits of a small angle or gap kept."""
    near = np.where(p[0] * q[0] + p[1] * q[1] < 0.0, -1.0, 1.0)
    r = product((p[0], -p[1], -p[2], -p[3]), [y - near * x for x, y in zip(p, q, strict=True)])
    return near + r[0], *r[1:]


def sclerp(p: Rows, q: Rows, t: Rows) -> Rows:
    """Return p exp(t log(p^-1 q))."""
    return product(p, exp([t[0] * x for x in log(ratio(p, q))]))
