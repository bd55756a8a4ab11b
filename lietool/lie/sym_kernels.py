"""Exponential and logarithm of symmetric matrices, on components: the upper triangle (xx xy xz yy yz zz).

A function f of Y is a polynomial of degree n - 1 in Y that agrees with f at
the eigenvalues.  Its coefficients are divided differences of f, written so
that equal eigenvalues are no special case.  `blocks.run` feeds these
functions; nothing here checks its input, and what overflows is infinite or nan.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lietool.lie import jacobi_kernels as jacobi
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]

_TINY = 1e-300  # keeps 0/0 at 0 and changes nothing else
_WIDEST = 8.0  # spread of eigenvalues of which the polynomial in Y still gives the exponential
_WORST = 16.0  # condition number up to which it gives the logarithm
_LN2 = float(np.log(2.0))
_ROOT3 = float(np.sqrt(3.0))
_THREE_HALVES_BITS = float(np.sqrt(2.0))


def _eigenvalues(Y: Rows) -> tuple[Array, Array, Array]:
    """Return l2, l1 - l2 and l2 - l3 for eigenvalues l1 >= l2 >= l3, the roots of (M 3) by trigonometry."""
    xx, xy, xz, yy, yz, zz = Y
    mean = (xx + yy + zz) * (1.0 / 3.0)
    a, b, c = xx - mean, yy - mean, zz - mean
    xy2, xz2, yz2 = xy * xy, xz * xz, yz * yz
    p = np.sqrt((0.5 * (a * a + b * b + c * c) + (xy2 + xz2 + yz2)) * (1.0 / 3.0))
    det = a * (b * c - yz2) - b * xz2 - c * xy2 + 2.0 * (xy * xz) * yz
    third = np.arccos(np.clip(det / (2.0 * p * p * p + _TINY), -1.0, 1.0)) * (1.0 / 3.0)
    sine = _ROOT3 * np.sin(third)
    cosine = np.cos(third)
    x = np.maximum(p * (3.0 * cosine - sine), 0.0)
    return mean - p * (cosine - sine), x, 2.0 * p * sine


def _polynomial(Z: Rows, b: Array, c: Array) -> Rows:
    """Return b Z + c Z^2."""
    xx, xy, xz, yy, yz, zz = Z
    xy2, xz2, yz2 = xy * xy, xz * xz, yz * yz
    return (
        b * xx + c * (xx * xx + xy2 + xz2),
        xy * (b + c * (xx + yy)) + c * (xz * yz),
        xz * (b + c * (xx + zz)) + c * (xy * yz),
        b * yy + c * (yy * yy + xy2 + yz2),
        yz * (b + c * (yy + zz)) + c * (xy * xz),
        b * zz + c * (zz * zz + xz2 + yz2),
    )


def _shifted(Y: Rows, s: Array) -> Rows:
    return Y[0] - s, Y[1], Y[2], Y[3] - s, Y[4], Y[5] - s


def _repair(result: Rows, Y: Rows, where: NDArray[np.bool_], function: Callable[[Rows], Rows]) -> Rows:
    """Replace what the closed formula cannot do by what the slower function gives."""
    if where.any():
        index = np.flatnonzero(where)
        for row, better in zip(result, function([y[index] for y in Y]), strict=True):
            row[index] = better
    return result


def _quotient(function: Callable[[Array], Array], x: Array) -> Array:
    """Return f(x) / x, and its limit 1 at 0."""
    x = np.where(x == 0.0, _TINY, x)
    return function(x) / x


def exp_space(Y: Rows) -> Rows:
    """Return exp Y = e^l2 (I + b Z + c Z^2) with Z = Y - l2 I, (K 6).

    With e(z) = (e^z - 1)/z, b + c x = e(x) at x = l1 - l2 and b - c y = e(-y)
    at y = l2 - l3; x and -y are lambda'1 and lambda'3 of the text.  The rounding
    of c is that of e(x) divided by x + y, and the square of Z is at most
    (x + y)^2: so it is harmless when x and y vanish.
    """
    middle, x, y = _eigenvalues(Y)
    wide = x + y > _WIDEST
    if wide.any():
        x, y = np.minimum(x, _WIDEST), np.minimum(y, _WIDEST)
    low = _quotient(np.expm1, -y)
    c = (_quotient(np.expm1, x) - low) / (x + y + _TINY)
    scale = np.exp(middle)
    E = _polynomial(_shifted(Y, middle), scale * (low + c * y), scale * c)
    return _repair([E[0] + scale, E[1], E[2], E[3] + scale, E[4], E[5] + scale], Y, wide, exp_jacobi)


def exp_jacobi(Y: Rows) -> Rows:
    """Return V diag(exp d) V^T, with d to half an ulp: exp makes its error a relative one."""
    d, V = jacobi.eigen(Y)
    error = jacobi.eigen_error(Y, d, V)
    return jacobi.conjugate_space(V, [np.exp(x) * (1.0 + e) for x, e in zip(d, error, strict=True)])


def _binary_scale(trace: Array, n: int) -> tuple[Array, Array]:
    """Return 2^-k and k log 2, with the mean eigenvalue between 2^(k - 1/2) and 2^(k + 1/2)."""
    _, k = np.frexp(trace * (_THREE_HALVES_BITS / n))
    k = k - 1
    return np.ldexp(1.0, -k), k * _LN2


def log_space(S: Rows) -> Rows:
    """Return log S = (log l2) I + b Z + c Z^2 with Z = S / l2 - I; nan where S is not positive definite.

    (K 7) is the same for A^T A = S^2, halved, in powers of Z + I.  With
    g(z) = log(1 + z)/z, b + c x = g(x) at x = l1/l2 - 1 and b - c w = g(-w) at
    w = 1 - l3/l2.  A power of 2 is divided out and then I subtracted, exactly
    where S is near I: so what S - I holds is kept.
    """
    f, shift = _binary_scale(S[0] + S[3] + S[5], 3)
    E = [f * s for s in S]
    for i in (0, 3, 5):
        E[i] -= 1.0
    middle, x, w = _eigenvalues(E)
    l2 = 1.0 + middle
    bad = ~(l2 + x <= _WORST * (l2 - w))
    if bad.any():
        middle, x, w, l2 = (np.where(bad, v, u) for u, v in ((middle, 0.0), (x, 0.0), (w, 0.0), (l2, 1.0)))
    r = 1.0 / l2
    x, w = x * r, w * r
    high = _quotient(np.log1p, x)
    c = (high - _quotient(np.log1p, -w)) / (x + w + _TINY)
    L = _polynomial([r * z for z in _shifted(E, middle)], high - c * x, c)
    m = np.log1p(middle) + shift
    return _repair([L[0] + m, L[1], L[2], L[3] + m, L[4], L[5] + m], S, bad, log_jacobi)


def relative_log(d: Rows) -> tuple[Rows, Array]:
    """Return the logarithms of d less the largest, and the largest; nan where one of d is not positive.

    V diag V^T of the former rounds least along the longest axis, where an
    error weighs most in the exponential; the latter is then added to the
    diagonal, so that the scale of d plays no part.
    """
    logs = [np.log(np.where(x > 0.0, x, np.nan)) for x in d]
    largest = logs[0]
    for x in logs[1:]:
        largest = np.maximum(largest, x)
    return [x - largest for x in logs], largest


def log_jacobi(S: Rows) -> Rows:
    """Return V diag(log d) V^T."""
    S, k = jacobi.scaled(S)
    d, V = jacobi.eigen(S)
    logs, m = relative_log(d)
    m = m + k * _LN2
    L = jacobi.conjugate_space(V, logs)
    return L[0] + m, L[1], L[2], L[3] + m, L[4], L[5] + m


def power_space(S: Rows, t: Rows) -> Rows:
    """Return V diag(d^t) V^T; nan where S is not positive definite."""
    S, k = jacobi.scaled(S)
    d, V = jacobi.eigen(S)
    powers = [np.where(x > 0.0, x, np.nan) ** t[0] for x in d]
    scale = np.exp2(t[0] * k)
    return [scale * x for x in jacobi.conjugate_space(V, powers)]


def power_plane(S: Rows, t: Rows) -> Rows:
    """Return S^t by its logarithm; nan where S is not positive definite."""
    S, k = jacobi.scaled(S)
    scale = np.exp2(t[0] * k)
    return [scale * x for x in exp_plane([t[0] * y for y in log_plane(S)])]


def exp_plane(Y: Rows) -> Rows:
    """Return exp Y = e^m (cosh h I + sinh h / h B), with Y = m I + B and +-h the eigenvalues of B."""
    xx, xy, yy = Y
    b = 0.5 * (xx - yy)
    h = np.hypot(b, xy)
    e = np.exp(0.5 * (xx + yy) + h)
    s = e * _quotient(np.expm1, -2.0 * h)
    low = e * np.exp(-2.0 * h)
    c = low + s * h
    return c + s * b, s * xy, c - s * b


def log_plane(S: Rows) -> Rows:
    """Return log S = log l2 I + g (S - l2 I), with g = log(l1/l2) / (l1 - l2); nan unless S is positive."""
    f, shift = _binary_scale(S[0] + S[2], 2)
    xx, xy, yy = f * S[0] - 1.0, f * S[1], f * S[2] - 1.0
    b = 0.5 * (xx - yy)
    h = np.hypot(b, xy)
    small = 0.5 * (xx + yy) - h
    small = np.where(small > -1.0, small, np.nan)
    l2 = 1.0 + small
    g = _quotient(np.log1p, 2.0 * h / l2) / l2
    m = np.log1p(small) + shift + g * h
    return m + g * b, g * xy, m - g * b
