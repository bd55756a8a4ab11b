"""The parametrisations phi and psi of affine transformations, on components.

A parameter is a rotation vector x, a translation part l and the upper
triangle of a symmetric Y; a transformation is rows of its homogeneous matrix.
`blocks.run` feeds these functions; nothing here checks its input.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import jacobi_kernels as jacobi
from lietool.lie import kernels, series, sym_kernels
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]

_ZERO, _ONE = np.zeros(()), np.ones(())
_LN2 = float(np.log(2.0))


def _apply(M: Rows, v: Rows) -> Rows:
    """Return the product of a matrix and a vector."""
    n = len(v)
    return [sum((M[n * i + j] * v[j] for j in range(1, n)), M[n * i] * v[0]) for i in range(n)]


def _homogeneous(A: Rows, d: Rows) -> Rows:
    if len(d) == 2:
        return *A[:2], d[0], *A[2:], d[1], _ZERO, _ZERO, _ONE
    return *A[:3], d[0], *A[3:6], d[1], *A[6:], d[2], _ZERO, _ZERO, _ZERO, _ONE


def _phi(x: Array, d: Rows, Y: Rows) -> Rows:
    S = jacobi.full(sym_kernels.exp_space(Y))
    return _homogeneous(jacobi.product(kernels.rotation_exp(x), S, 3), d)


def phi_so(p: Array) -> Rows:
    """Return exp(x) exp(Y), translated by l."""
    return _phi(p[:3], list(p[3:6]), list(p[6:]))


def phi_se(p: Array) -> Rows:
    """Return exp(x, l) exp(Y): l goes through the left Jacobian of x, (7.5)."""
    return _phi(p[:3], _apply(kernels.left_jacobian(p[:3]), list(p[3:6])), list(p[6:]))


def psi_parts(A: Array) -> Rows:
    """Return the rotation R (9) and the upper triangle of Y = log S (6), nan where det A <= 0.

    With A = U diag(d) V^T the texts' S = sqrt(A^T A), (7.2), is V diag(d) V^T:
    so R = A S^-1 = U V^T and log S = V diag(log d) V^T, without forming A^T A,
    which squares the condition number.

    The largest of log d is added last: see `sym_kernels.relative_log`.
    """
    M, k = jacobi.scaled((*A[0:3], *A[4:7], *A[8:11]))
    U, d, V = jacobi.svd_space(M)
    logs, m = sym_kernels.relative_log(d)
    m = m + k * _LN2
    Y = jacobi.conjugate_space(V, logs)
    R = jacobi.product(U, jacobi.transpose(V, 3), 3)
    return *R, Y[0] + m, Y[1], Y[2], Y[3] + m, Y[4], Y[5] + m


def psi_so(A: Array) -> Rows:
    """Return x, l, Y with phi_so(x, l, Y) = A."""
    parts = psi_parts(A)
    return *kernels.rotation_log(np.stack(parts[:9])), A[3], A[7], A[11], *parts[9:]


def psi_se(A: Array) -> Rows:
    """Return x, l, Y with phi_se(x, l, Y) = A; l by (7.8), as S leaves the translation d of A alone."""
    x, y, z, *rest = psi_so(A)
    return x, y, z, *_apply(kernels.left_jacobian_inverse(np.stack((x, y, z))), rest[:3]), *rest[3:]


def phi_so_plane(p: Rows) -> Rows:
    """Return exp(x) exp(Y), translated by l, in the plane."""
    x, lx, ly, *Y = p
    c, s = np.cos(x), np.sin(x)
    S = jacobi.full(sym_kernels.exp_plane(Y))
    return _homogeneous(jacobi.product((c, 0.0 - s, s, c), S, 2), (lx, ly))


def phi_se_plane(p: Rows) -> Rows:
    """Return exp(x, l) exp(Y) in the plane."""
    a, b = series.sinc(p[0]), p[0] * series.versinc(p[0])
    return phi_so_plane((p[0], a * p[1] - b * p[2], b * p[1] + a * p[2], *p[3:]))


def psi_so_plane(A: Array) -> Rows:
    """Return x, l, Y with phi_so_plane(x, l, Y) = A."""
    M, k = jacobi.scaled((A[0], A[1], A[3], A[4]))
    U, d, V = jacobi.svd_plane(M)
    logs, m = sym_kernels.relative_log(d)
    m = m + k * _LN2
    xx, xy, yy = jacobi.conjugate_plane(V, logs)
    # Adding 0.0 turns -0.0 into 0.0, so that the half turn is pi and never -pi.
    x = np.arctan2(U[2] * V[0] - U[0] * V[2] + 0.0, U[0] * V[0] + U[2] * V[2])
    return x, A[2], A[5], xx + m, xy, yy + m


def psi_se_plane(A: Array) -> Rows:
    """Return x, l, Y with phi_se_plane(x, l, Y) = A."""
    x, dx, dy, *Y = psi_so_plane(A)
    return x, *back_plane(x, dx, dy), *Y


def back_plane(x: Array, dx: Array, dy: Array) -> Rows:
    """Return the l that the motion with angle x carries to the translation d: (7.8) in the plane."""
    h = 0.5 * x
    a = np.cos(h) / series.sinc(h)
    return a * dx + h * dy, a * dy - h * dx
