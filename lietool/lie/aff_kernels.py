"""The exponential of aff(3) on components, and the logarithm of Aff(3) on stacks of matrices.

`aff` calls them.  Nothing here checks its input.
"""

from collections.abc import Sequence
from math import factorial

import numpy as np
from numpy.typing import NDArray

from lietool.lie import series
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]

# Of (e^z - 1)/z: with |z| <= 1 what is left out is below 1e-17.
_MEAN = [1.0 / factorial(k + 1) for k in range(18)]
# 2 artanh(W) = 2 (W + W^3/3 + ...): with |W| < 1/8 the last term is below 1e-17 of the first.
_ARTANH = [2.0 / (2 * k + 1) for k in range(9)]


def _square(M: Rows) -> Rows:
    """Return M^2 of a matrix (3, 3)."""
    a, b, c, d, e, f, g, h, i = M
    bd, cg, fh = b * d, c * g, f * h
    ae, ai, ei = a + e, a + i, e + i
    return (
        *(a * a + bd + cg, b * ae + c * h, c * ai + b * f),
        *(d * ae + f * g, e * e + bd + fh, f * ei + c * d),
        *(g * ai + d * h, h * ei + b * g, i * i + cg + fh),
    )


def _invariants(M: Rows) -> tuple[Array, Array, Array]:
    """Return the coefficients of M^3 = s1 M^2 - s2 M + s3 I (Cayley and Hamilton)."""
    a, b, c, d, e, f, g, h, i = M
    minor = e * i - f * h
    s2 = minor + (a * e - b * d) + (a * i - c * g)
    return a + e + i, s2, a * minor - b * (d * i - f * g) + c * (d * h - e * g)


def _quadratic(c: Sequence[Array], M: Rows, M2: Rows) -> list[Array]:
    """Return c_0 I + c_1 M + c_2 M^2."""
    rows = [c[1] * x + c[2] * y for x, y in zip(M, M2, strict=True)]
    return [row + c[0] if i in (0, 4, 8) else row for i, row in enumerate(rows)]


def _halved(L: Rows) -> tuple[Rows, NDArray[np.int_]]:
    """Return L / 2^s, whose rows have an absolute sum of at most 1, and s >= 0."""
    size = np.abs(L[0]) + np.abs(L[1]) + np.abs(L[2])
    for i in (3, 6):
        size = np.maximum(size, np.abs(L[i]) + np.abs(L[i + 1]) + np.abs(L[i + 2]))
    steps = np.maximum(np.frexp(size)[1], 0)
    f = np.ldexp(1.0, -steps)
    return [x * f for x in L], steps


def _series(M: Rows) -> tuple[Sequence[Array], Sequence[Array]]:
    """Return e^M and (e^M - I) / M as coefficients of I, M and M^2.

    Horner's rule, in which a multiplication by M costs no product of matrices: M^3 is reduced at once.
    """
    s1, s2, s3 = _invariants(M)
    x, y, z = np.full_like(s1, _MEAN[-1]), np.zeros_like(s1), np.zeros_like(s1)
    held = np.empty_like(s1)
    for c in reversed(_MEAN[:-1]):
        # In place: of new arrays the memory takes as long as the sums.
        y += np.multiply(s1, z, out=held)
        x -= np.multiply(s2, z, out=held)
        z *= s3
        z += c
        x, y, z = z, x, y
    return (s3 * z + 1.0, x - s2 * z, y + s1 * z), (x, y, z)


def exp_part(L: Rows) -> Rows:
    """Return e^L of matrices (3, 3), as `exp` does."""
    M, steps = _halved(L)
    E = _quadratic(_series(M)[0], M, _square(M))
    while np.any(on := steps > 0):
        for row, new in zip(E, _square(E), strict=True):
            np.copyto(row, new, where=on)
        steps = steps - 1
    return E


def exp(X: Rows) -> Rows:
    """Return e^X by its series, after halving, and squaring; the translation goes by (e^L - I) / L.

    Each element is halved as often as its linear part L asks; the translation has no say in it.
    """
    M, steps = _halved([X[i] for i in range(12) if i % 4 < 3])
    M2 = _square(M)
    of_exp, of_mean = _series(M)
    E, J = _quadratic(of_exp, M, M2), _quadratic(of_mean, M, M2)
    f = np.ldexp(1.0, -steps)
    t = [X[i] * f for i in (3, 7, 11)]
    t = [J[i] * t[0] + J[i + 1] * t[1] + J[i + 2] * t[2] for i in (0, 3, 6)]
    while np.any(on := steps > 0):
        twice = [E[3 * i] * t[0] + E[3 * i + 1] * t[1] + E[3 * i + 2] * t[2] + t[i] for i in range(3)]
        for row, new in zip((*E, *t), (*_square(E), *twice), strict=True):
            np.copyto(row, new, where=on)
        steps = steps - 1
    zero = np.zeros_like(t[0])
    return *E[:3], t[0], *E[3:6], t[1], *E[6:], t[2], zero, zero, zero, zero + 1.0


def real_log(A: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return real logarithms of homogeneous matrices (n, 4, 4), and which of them exist; 0 for the others.

    A real logarithm exists if and only if no eigenvalue is 0 and every Jordan
    block of a negative one occurs an even number of times: in three
    dimensions, if negative eigenvalues are two, equal, and not sheared.
    """
    values, vectors = np.linalg.eig(A[:, :3, :3])
    values = values.astype(np.complex128)
    real = values.imag == 0.0
    negative = np.sum(real & (values.real <= 0.0), axis=-1)
    exists = (negative % 2 == 0) & np.all(values != 0.0, axis=-1)
    # Near the negative axis the principal logarithm breaks down; there a third eigenvalue stands apart.
    turns = np.any(-values.real > np.abs(values.imag), axis=-1) & exists
    plain = exists & ~turns
    # Diagonalising errs by the condition number of the eigenvectors, the square roots by that of A.
    skewness = np.linalg.cond(vectors)
    straight = plain & ((skewness < 100.0) | (skewness < np.linalg.cond(A[:, :3, :3])))
    # Near I its error is large beside the logarithm; the square roots need no more than A - I there.
    straight &= np.max(np.abs(A[:, :3, :3] - np.eye(3)), axis=(-1, -2)) > 0.2
    plain &= ~straight
    X = np.zeros_like(A)
    X[straight] = _diagonal_log(A[straight], values[straight], vectors[straight])
    X[plain] = _principal_log(A[plain])
    third = np.max(np.where(real, values.real, -np.inf), axis=-1)
    X[turns], exists[turns] = _turning_log(A[turns], third[turns])
    return X, exists


def _diagonal_log(A: Array, values: NDArray, vectors: NDArray) -> Array:
    """Return logarithms by eigenvectors, (11) of Kaji and Ochiai."""
    log = np.log(values)
    # The vector is carried to (e^X - 1)/X times it, as in `_turning_log`.
    away = values != 1.0
    stretch = np.where(away, log / np.where(away, values - 1.0, 1.0), 1.0)
    back = np.linalg.inv(vectors)
    X = np.zeros_like(A)
    X[:, :3, :3] = ((vectors * log[:, None, :]) @ back).real
    X[:, :3, 3:] = ((vectors * stretch[:, None, :]) @ (back @ A[:, :3, 3:])).real
    return X


def _principal_log(A: Array) -> Array:
    """Return logarithms by inverse scaling and squaring.

    Z = A^(1/2^s) - I is carried along by Z -> Z (A^(1/2) + I)^-1, which subtracts
    nothing; at the end log(I + Z) = 2 artanh(Z (2 I + Z)^-1).
    """
    one = np.eye(4)
    Z, root, steps = A - one, A.copy(), np.zeros(len(A), dtype=np.int64)
    far = np.arange(len(A))
    while far.size:
        size = np.max(np.sum(np.abs(Z[far, :3, :3]), axis=-2), axis=-1)
        far = far[size > 0.2]
        root[far] = _sqrt(root[far])
        Z[far] = Z[far] @ np.linalg.inv(root[far] + one)
        steps[far] += 1
    W = Z @ np.linalg.inv(2.0 * one + Z)
    square = W @ W
    series_sum = _ARTANH[-1] * square
    for c in reversed(_ARTANH[1:-1]):
        series_sum = (series_sum + c * one) @ square
    return np.ldexp(W @ (series_sum + _ARTANH[0] * one), steps[:, None, None])


def _sqrt(A: Array) -> Array:
    """Return principal square roots, of the linear part by the product iteration of Denman and Beavers."""
    one = np.eye(3)
    X, M = A[:, :3, :3].copy(), A[:, :3, :3].copy()
    for _ in range(40):
        # The scaling by the determinant serves while M is far from I.
        gap = np.max(np.abs(M - one), axis=(-1, -2))
        if not np.any(gap > series.ROUNDED):
            break
        scale = np.where(gap > 0.1, np.abs(np.linalg.det(M)) ** (-1.0 / 6.0), 1.0)[:, None, None]
        inverse = np.linalg.inv(M) / (scale * scale)
        X = 0.5 * scale * X @ (one + inverse)
        M = 0.5 * one + 0.25 * (scale * scale * M + inverse)
        if not np.any(gap > 1e-8):
            break
    root = A.copy()
    root[:, :3, :3] = X
    root[:, :3, 3] = np.linalg.solve(X + one, A[:, :3, 3:])[..., 0]
    return root


def _turning_log(A: Array, third: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return logarithms where two eigenvalues are near the negative axis and the third is positive.

    The space splits into the line of the third, along r, and the plane Q of the
    two, across the left eigenvector.  In the plane B = m I + N, N^2 = -delta I.
    If N = 0, a half turn and a scaling, every J with J^2 = -I serves; taken is
    the quarter turn by the right hand about that eigenvector, whose largest
    component is positive.
    """
    L, t = A[:, :3, :3], A[:, :3, 3:]
    U, _, Vt = np.linalg.svd(L - third[:, None, None] * np.eye(3))
    sign = np.sign(np.take_along_axis(U[..., 2], np.argmax(np.abs(U[..., 2]), axis=-1)[:, None], axis=-1))
    left, r = U[..., 2] * sign, Vt[:, 2]
    Q = U[..., :2] * np.stack([np.sign(np.linalg.det(U)) * sign[:, 0], np.ones(len(A))], axis=-1)[:, None]
    B = np.swapaxes(Q, -1, -2) @ L @ Q
    C, exists = _plane_log(B, np.max(np.abs(L), axis=(-1, -2)))
    # p = r (line p) + Q (plane p)
    line = (left / np.sum(left * r, axis=-1, keepdims=True))[:, None, :]
    plane = np.swapaxes(Q, -1, -2) @ (np.eye(3) - r[..., None] * line)
    X = np.zeros_like(A)
    X[:, :3, :3] = np.log(third)[:, None, None] * r[..., None] * line + Q @ C @ plane
    # exp carries the vector v to (e^X - 1)/X v: on the line and in the plane divide by that.
    stretch = (np.log(third) / np.where(third == 1.0, 1.0, third - 1.0))[:, None, None]
    stretch = np.where(third[:, None, None] == 1.0, 1.0, stretch)
    inplane = C @ np.linalg.solve(B - np.eye(2), plane @ t)
    X[:, :3, 3:] = stretch * r[..., None] * (line @ t) + Q @ inplane
    return np.where(exists[:, None, None], X, 0.0), exists


def _plane_log(B: Array, size: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return logarithms of 2 x 2 matrices whose eigenvalues are nearly negative, and which of them exist."""
    m, skew = 0.5 * (B[:, 0, 0] + B[:, 1, 1]), 0.5 * (B[:, 0, 0] - B[:, 1, 1])
    N = np.stack([skew, B[:, 0, 1], B[:, 1, 0], -skew], axis=-1).reshape(B.shape)
    delta = -(N[:, 0, 0] ** 2 + N[:, 0, 1] * N[:, 1, 0])
    largest = np.max(np.abs(N), axis=(-1, -2))
    half_turn = largest <= series.ROUNDED * size
    # Below this delta may be the rounding of 0: a shear, whose logarithm would be as large as that is small.
    exists = half_turn | (delta > series.ROUNDED * size * largest)
    root = np.sqrt(np.where(exists & ~half_turn, delta, 1.0))
    angle = np.where(half_turn, np.pi, np.arctan2(root, m))
    J = np.where(half_turn[:, None, None], np.array([[0.0, -1.0], [1.0, 0.0]]), N / root[:, None, None])
    length = np.where(half_turn, np.abs(m), np.hypot(m, root))
    return np.log(length)[:, None, None] * np.eye(2) + angle[:, None, None] * J, exists
