"""The ways of blending on components: what moves a point, and what makes the matrix, from mixed parameters.

A way's parameters are rows, one for each number; a point is three rows.
Nothing here checks its input: where quaternions cancel each other, or an
exponential overflows, the result is nan or infinite, and `ways` says so.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lietool.lie import aff_kernels, affine_kernels, dual_kernels, kernels, series, sym_kernels
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]
Matrix = Callable[[Array], Rows]
Move = Callable[[Array, Rows], Rows]


def _symmetric(S: Rows, v: Rows) -> Rows:
    """Return S v of the upper triangle of S."""
    x, y, z = v
    xx, xy, xz, yy, yz, zz = S
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


def _turned(R: Rows, v: Rows, t: Rows) -> Rows:
    """Return R v + t."""
    x, y, z = v
    return [R[3 * i] * x + R[3 * i + 1] * y + R[3 * i + 2] * z + t[i] for i in range(3)]


def _affine(A: Rows, v: Rows) -> Rows:
    """Return the point to which a homogeneous matrix moves v."""
    x, y, z = v
    return [A[i] * x + A[i + 1] * y + A[i + 2] * z + A[i + 3] for i in (0, 4, 8)]


def _homogeneous(L: Rows, t: Rows) -> Rows:
    zero = np.zeros_like(t[0])
    return *L[:3], t[0], *L[3:6], t[1], *L[6:9], t[2], zero, zero, zero, zero + 1.0


def _stretched(R: Rows, S: Rows) -> Rows:
    """Return R S, from the upper triangle of S."""
    columns = [_symmetric(S, (R[i], R[i + 1], R[i + 2])) for i in (0, 3, 6)]
    return [entry for row in columns for entry in row]


def phi_so(p: Array, v: Rows) -> Rows:
    """Return exp(x) exp(Y) v + l."""
    return _turned(
        kernels.rotation_exp(p[:3]), _symmetric(sym_kernels.exp_space(list(p[6:])), v), list(p[3:6])
    )


def phi_se(p: Array, v: Rows) -> Rows:
    """Return exp(x, l) (exp(Y) v)."""
    return _affine(kernels.rigid_exp(p[:6]), _symmetric(sym_kernels.exp_space(list(p[6:])), v))


def alexa(p: Array, v: Rows) -> Rows:
    """Return exp(X) v, X by its first three rows."""
    return _affine(aff_kernels.exp(list(p)), v)


def linear(p: Array, v: Rows) -> Rows:
    """Return v + M v, M by its first three rows."""
    return [x + y for x, y in zip(v, _affine(list(p), v), strict=True)]


def linear_part(p: Array) -> Rows:
    """Return the linear part of I + M."""
    return [p[i] + 1.0 if i in (0, 5, 10) else p[i] for i in range(12) if i % 4 < 3]


def linear_matrix(p: Array) -> Rows:
    """Return I + M."""
    zero = np.zeros_like(p[0])
    rows = [p[i] + 1.0 if i in (0, 5, 10) else p[i] for i in range(12)]
    return *rows, zero, zero, zero, zero + 1.0


def _quaternion(p: Array) -> Rows:
    """Return 1 + p, of any length but 0; nan where it is nothing but rounding."""
    w = 1.0 + p[0]
    gone = w * w + p[1] * p[1] + p[2] * p[2] + p[3] * p[3] <= (4.0 * series.ROUNDED) ** 2
    return [np.where(gone, np.nan, w), p[1], p[2], p[3]]


def _stretch(p: Array) -> Rows:
    """Return the upper triangle of I + p."""
    return [p[0] + 1.0, p[1], p[2], p[3] + 1.0, p[4], p[5] + 1.0]


def polar_quaternion(p: Array, v: Rows) -> Rows:
    """Return R S v + t: R of the quaternion 1 + p, whatever its length."""
    return _turned(kernels.matrix(_quaternion(p)), _symmetric(_stretch(p[7:]), v), list(p[4:7]))


def polar_quaternion_part(p: Array) -> Rows:
    """Return R S."""
    return _stretched(kernels.matrix(_quaternion(p)), _stretch(p[7:]))


def polar_quaternion_matrix(p: Array) -> Rows:
    """Return R S and t."""
    return _homogeneous(polar_quaternion_part(p), list(p[4:7]))


def dual_quaternion(p: Array, v: Rows) -> Rows:
    """Return M S v: M of the dual quaternion 1 + p, whatever its length."""
    return dual_kernels.act([*_quaternion(p), *p[4:8]], _symmetric(_stretch(p[8:]), v))


def dual_quaternion_part(p: Array) -> Rows:
    """Return R S."""
    return _stretched(kernels.matrix(_quaternion(p)), _stretch(p[8:]))


def dual_quaternion_matrix(p: Array) -> Rows:
    """Return R S and t."""
    z = _quaternion(p)
    t = dual_kernels.translation([*z, *p[4:8]])
    return _homogeneous(_stretched(kernels.matrix(z), _stretch(p[8:])), t)


def alexa_part(p: Array) -> Rows:
    """Return exp of the linear part of X."""
    return aff_kernels.exp_part([p[i] for i in range(12) if i % 4 < 3])


def alexa_matrix(p: Array) -> Rows:
    """Return exp(X)."""
    return aff_kernels.exp(list(p))


def phi_part(p: Array) -> Rows:
    """Return exp(x) exp(Y)."""
    return _stretched(kernels.rotation_exp(p[:3]), sym_kernels.exp_space(list(p[6:])))


phi_so_matrix: Matrix = affine_kernels.phi_so
phi_se_matrix: Matrix = affine_kernels.phi_se
