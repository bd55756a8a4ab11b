"""Jacobi's rotations, on components: eigenvectors of small symmetric, singular vectors of small matrices.

They are slower than closed formulas, and as accurate as the matrix allows.
Every element is turned until it has settled, whatever lies beside it in its
block; so a batch gives exactly what single calls give.  Matrices are rows of
entries, row by row; symmetric ones the upper triangle (xx xy xz yy yz zz).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lietool.lie.blocks import Rows

Array = NDArray[np.float64]
List = list[Array]

_EPS = float(np.finfo(np.float64).eps)
_TINY = 1e-300  # keeps 0/0 at 0 and changes nothing else
_SMALL = 1e-8  # rotations by less leave only their square behind
_SWEEPS = 12
_LEAST = -1022  # the exponent of the smallest number with all its bits


def _turn(alpha: Array, beta: Array, gamma: Array) -> Array:
    """Return the tangent, at most 1, of the angle that makes [[alpha, gamma], [gamma, beta]] diagonal."""
    delta = beta - alpha
    twice = gamma + gamma
    root = np.sqrt(delta * delta + twice * twice)
    return twice / np.copysign(np.abs(delta) + root + _TINY, delta)


def _rotate(p: Array, q: Array, c: Array, s: Array) -> tuple[Array, Array]:
    return c * p - s * q, s * p + c * q


def _settle(rows: List, sweep: Callable[[List], tuple[List, NDArray[np.bool_]]], left: int = _SWEEPS) -> List:
    """Sweep until every element has settled; those that have are left alone."""
    while True:
        rows, restless = sweep(rows)
        left -= 1
        if left == 0 or not restless.any():
            return rows
        if not restless.all():
            index = np.flatnonzero(restless)
            rest = _settle([row[index] for row in rows], sweep, left)
            for row, settled in zip(rows, rest, strict=True):
                row[index] = settled
            return rows


def _unit(rows: List, n: int) -> List:
    """Append the rows of the unit matrix."""
    one, zero = np.ones_like(rows[0]), np.zeros_like(rows[0])
    return [*rows, *(one if i % (n + 1) == 0 else zero for i in range(n * n))]


def _eigen_sweep(rows: List) -> tuple[List, NDArray[np.bool_]]:
    rows = list(rows)
    restless = np.zeros(rows[0].shape, dtype=bool)
    # Diagonal entries p and q, the entry pq, the entries that join them to the third; columns of V.
    for p, q, pq, pr, qr, i, j in ((0, 3, 1, 2, 4, 6, 7), (0, 5, 2, 1, 4, 6, 8), (3, 5, 4, 1, 2, 7, 8)):
        gamma = rows[pq]
        t = _turn(rows[p], rows[q], gamma)
        restless |= np.abs(t) > _SMALL
        c = 1.0 / np.sqrt(1.0 + t * t)
        s = t * c
        shift = t * gamma
        rows[p], rows[q], rows[pq] = rows[p] - shift, rows[q] + shift, np.zeros_like(gamma)
        rows[pr], rows[qr] = _rotate(rows[pr], rows[qr], c, s)
        for k in (0, 3, 6):
            rows[i + k], rows[j + k] = _rotate(rows[i + k], rows[j + k], c, s)
    return rows, restless


def eigen(Y: Rows) -> tuple[Rows, Rows]:
    """Return the eigenvalues d and a rotation V, nine rows, with Y = V diag(d) V^T; d in no order."""
    rows = _settle(_unit(list(Y), 3), _eigen_sweep)
    return (rows[0], rows[3], rows[5]), _rotation(rows[6:])


def _to_grid(a: Array, grid: Array | float) -> tuple[Array, Array]:
    """Split numbers into whole multiples of a power of 2 and the rest."""
    big = grid * 1.5 * 2.0**52
    high = (a + big) - big
    return high, a - high


def eigen_error(Y: Rows, d: Rows, V: Rows) -> Rows:
    """Return v . (Y v - d v) for each eigenvalue d and vector v: what rounding has left out of d.

    Many turns round d by a few ulp of the largest entry.  On grids of 24 bits
    all products of Y v - d v, where nearly all cancels, and their sums are exact.
    """
    _, k = scaled(Y)
    grid = np.ldexp(1.0, k - 23)
    Yh, Yl = zip(*(_to_grid(y, grid) for y in Y), strict=True)
    Yh, Yl = full(Yh), full(Yl)
    errors = []
    for i in range(3):
        v = V[i::3]
        vh, vl = zip(*(_to_grid(x, 2.0**-23) for x in v), strict=True)
        dh, dl = _to_grid(d[i], grid)
        gap = []
        for j in range(3):
            high, low = Yh[3 * j : 3 * j + 3], Yl[3 * j : 3 * j + 3]
            exact = _dot(high, vh) - dh * vh[j]
            gap.append(exact + (_dot(high, vl) + _dot(low, v) - dh * vl[j] - dl * v[j]))
        errors.append(_dot(v, gap))
    return errors


def _pair(rows: List, i: int, j: int, n: int) -> NDArray[np.bool_]:
    """Turn columns i and j of A, and of V, until they are orthogonal, the longer first."""
    columns = range(0, n * n, n)
    p, q = [rows[i + k] for k in columns], [rows[j + k] for k in columns]
    alpha, beta, gamma = _dot(p, p), _dot(q, q), _dot(p, q)
    cosine = gamma * gamma
    lengths = alpha * beta
    # What rounding leaves of a dot product says nothing, and equal lengths would make it a large angle.
    t = _turn(alpha, beta, np.where(cosine > (2.0 * _EPS) ** 2 * lengths, gamma, 0.0))
    restless = (np.abs(t) > _SMALL) | (cosine > _SMALL**2 * lengths)
    c = 1.0 / np.sqrt(1.0 + t * t)
    s = t * c
    swap = alpha < beta
    # After an exchange the sweep meets one pair twice and another not at all.
    restless |= swap
    c, s = np.where(swap, s, c), np.where(swap, -c, s)
    for k in range(0, 2 * n * n, n):
        rows[i + k], rows[j + k] = _rotate(rows[i + k], rows[j + k], c, s)
    return restless


def _space_sweep(rows: List) -> tuple[List, NDArray[np.bool_]]:
    rows = list(rows)
    restless = _pair(rows, 0, 1, 3)
    restless |= _pair(rows, 0, 2, 3)
    restless |= _pair(rows, 1, 2, 3)
    return rows, restless


def _plane_sweep(rows: List) -> tuple[List, NDArray[np.bool_]]:
    rows = list(rows)
    return rows, _pair(rows, 0, 1, 2)


def _cross(a: Rows, b: Rows) -> Rows:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _dot(a: Rows, b: Rows) -> Array:
    return sum((x * y for x, y in zip(a[1:], b[1:], strict=True)), a[0] * b[0])


def _frame(a: Rows, b: Rows) -> tuple[Rows, Rows, Rows]:
    """Return the right-handed frame whose first vector is along a and whose second is in their plane."""
    f = 1.0 / (np.sqrt(_dot(a, a)) + _TINY)
    u = [f * x for x in a]
    along = _dot(u, b)
    v = [y - along * x for x, y in zip(u, b, strict=True)]
    f = 1.0 / (np.sqrt(_dot(v, v)) + _TINY)
    v = [f * y for y in v]
    return u, v, _cross(u, v)


def _by_rows(u: Rows, v: Rows, w: Rows) -> Rows:
    """Return the entries of the matrix with these columns."""
    return [entry for entries in zip(u, v, w, strict=True) for entry in entries]


def _rotation(V: Rows) -> Rows:
    """Take the rounding of many turns out of a rotation."""
    return _by_rows(*_frame(V[0::3], V[1::3]))


def scaled(A: Rows) -> tuple[Rows, NDArray[np.intc]]:
    """Return A / 2^k and k, which takes the largest entry near 1: squares neither overflow nor vanish."""
    largest = np.abs(A[0])
    for entry in A[1:]:
        np.maximum(largest, np.abs(entry), out=largest)
    _, k = np.frexp(largest)
    k = np.maximum(k, _LEAST)  # the reciprocal of a smaller one overflows, and 2^-52 squared does not vanish
    f = np.ldexp(1.0, -k)
    return [f * entry for entry in A], k


def svd_space(A: Rows) -> tuple[Rows, Rows, Rows]:
    """Return U, d, V with A = U diag(d) V^T, rotations U and V, d1 >= d2 >= |d3|; d3 has the sign of det A.

    One-sided Jacobi: V turns the columns of A until they are orthogonal.  It
    never forms A^T A, which squares the condition number.  The third column of
    U is the cross product of the others: too short to tell its own direction,
    it need not.
    """
    rows = _settle(_unit(list(A), 3), _space_sweep)
    a, b, c = rows[0:9:3], rows[1:9:3], rows[2:9:3]
    u, v, w = _frame(a, b)
    first = np.sqrt(_dot(a, a))
    second = np.minimum(_dot(v, b), first)  # equal ones may be rounded out of order
    d = (first, second, np.minimum(_dot(w, c), second))
    return _by_rows(u, v, w), d, _rotation(rows[9:])


def svd_plane(A: Rows) -> tuple[Rows, Rows, Rows]:
    """Return U, d, V with A = U diag(d) V^T, rotations U and V, d1 >= |d2|; d2 has the sign of det A."""
    rows = _settle(_unit(list(A), 2), _plane_sweep)
    first = np.hypot(rows[0], rows[2])
    f = 1.0 / (first + _TINY)
    x, y = f * rows[0], f * rows[2]
    f = 1.0 / np.hypot(rows[4], rows[6])
    c, s = f * rows[4], f * rows[6]
    return (x, -y, y, x), (first, np.minimum(x * rows[3] - y * rows[1], first)), (c, -s, s, c)


def conjugate_space(V: Rows, d: Rows) -> Rows:
    """Return the upper triangle of V diag(d) V^T."""
    r = [V[0:3], V[3:6], V[6:9]]
    scaled_rows = [[x * y for x, y in zip(row, d, strict=True)] for row in r]
    return [_dot(scaled_rows[i], r[j]) for i in range(3) for j in range(i, 3)]


def conjugate_plane(V: Rows, d: Rows) -> Rows:
    """Return the upper triangle of V diag(d) V^T."""
    (a, b, c, e), (p, q) = V, d
    return a * a * p + b * b * q, a * c * p + b * e * q, c * c * p + e * e * q


def product(A: Rows, B: Rows, n: int) -> Rows:
    """Return the matrix product A B."""
    return [
        sum((A[n * i + k] * B[n * k + j] for k in range(1, n)), A[n * i] * B[j])
        for i in range(n)
        for j in range(n)
    ]


def transpose(A: Rows, n: int) -> Rows:
    """Return the transpose of A."""
    return [A[n * j + i] for i in range(n) for j in range(n)]


def full(S: Rows) -> Rows:
    """Return all entries of the symmetric matrix whose upper triangle is given."""
    if len(S) == 3:
        a, b, c = S
        return a, b, b, c
    xx, xy, xz, yy, yz, zz = S
    return xx, xy, xz, xy, yy, yz, xz, yz, zz


def upper(A: Rows) -> Rows:
    """Return the upper triangle of the symmetric part."""
    if len(A) == 4:
        return A[0], 0.5 * (A[1] + A[2]), A[3]
    return (
        *(A[0], 0.5 * (A[1] + A[3]), 0.5 * (A[2] + A[6])),
        *(A[4], 0.5 * (A[5] + A[7]), A[8]),
    )
