r"""The energy that forgives rotations.

The corners $\mathbf{p}_1, \mathbf{p}_2, \mathbf{p}_3$ of a triangle are moved to
$\mathbf{v}_1, \mathbf{v}_2, \mathbf{v}_3$. The linear part $B$ of the affine map that does so, (5.2), should
be near to a given map $A$, but turning and scaling the whole should cost nothing:

$$E^R = \min_{s, \delta} \|B - s\,R_\delta\,A\|_F^2, \qquad (6.4)$$

where $R_\delta$ is the rotation by $\delta$ and $\|M\|_F^2$ the sum of the squares of the entries of $M$. The
least value can be written down:

$$E^R = \|B\|_F^2 - \frac{\|B A^T\|_F^2 + 2 \det(B A^T)}{\|A\|_F^2}. \qquad (6.5)$$

Like $E^F$ it is quadratic in $\mathbf{v} = (x_1, y_1, x_2, y_2, x_3, y_3)$, and there is no linear part:

$$E^R = \mathbf{v}^T Q\,\mathbf{v}.$$

Write `similarity(corners, A)`, which returns the symmetric matrix $Q$. It depends on $A$, so that, other than
that of $E^F$, it changes with time. It is not positive definite: find out for which $\mathbf{v}$ the energy
is 0.

Both arguments may be batches, corners (the rows) of shape `(..., 3, 2)` and maps of shape `(..., 2, 2)`; they
go together as numpy broadcasts them. A triangle whose corners lie on one line, and the map 0, are refused
with a `ValueError`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def similarity(corners, A):
    """Return the matrix Q of E^R.

    Parameters
    ----------
    corners : ndarray, shape (..., 3, 2)
        Of the triangle at rest, one in each row.
    A : ndarray, shape (..., 2, 2)
        The map that it should have, but for rotation and scale.

    Returns
    -------
    ndarray, shape (..., 6, 6)
        For v = (x_1, y_1, x_2, y_2, x_3, y_3).

    Raises
    ------
    ValueError
        If the corners lie on one line but for rounding (the area is less than 1e-14 of the sum of the squares
        of the sides), or A is 0.
    """
    A = np.asarray(A, float)
    length = np.linalg.norm(A, axis=(-2, -1), keepdims=True)
    if not np.all(length > 0.0):
        raise ValueError("A must not be 0")
    # The maps s R A are the sums of multiples of A and of J A, which are perpendicular and equally long.
    A = A / length
    a, turned = (M.reshape(*A.shape[:-2], 4) for M in (A, np.array([[0.0, -1.0], [1.0, 0.0]]) @ A))
    across = np.eye(4) - a[..., :, None] * a[..., None, :] - turned[..., :, None] * turned[..., None, :]
    K = entries(corners)
    return np.swapaxes(K, -1, -2) @ across @ K


def entries(corners):
    """Return the matrix (..., 4, 6) from v to the entries (b11, b12, b21, b22) of B."""
    p = np.asarray(corners, float)
    sides = np.swapaxes(p[..., :2, :] - p[..., 2:, :], -1, -2)
    if np.any(np.abs(np.linalg.det(sides)) <= 1e-14 * np.sum(sides**2, axis=(-2, -1))):
        raise ValueError("the triangle must have an area")
    # [v1 - v3, v2 - v3] = B [p1 - p3, p2 - p3], so that B = sum of v_k g_k^T.
    first = np.linalg.inv(sides)
    g = np.concatenate([first, -first.sum(axis=-2, keepdims=True)], axis=-2)
    K = np.zeros((*g.shape[:-2], 2, 2, 3, 2))
    for i in range(2):
        K[..., i, :, :, i] = np.swapaxes(g, -1, -2)
    return K.reshape(*g.shape[:-2], 4, 6)


_UNIT = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
_J = np.array([[0.0, -1.0], [1.0, 0.0]])


def _triangles(rng, *shape):
    around = 2.0 * np.pi * (np.arange(3) / 3.0 + rng.uniform(-0.1, 0.1, (*shape, 3)))
    corners = np.stack([np.cos(around), np.sin(around)], axis=-1) * rng.uniform(0.6, 2.0, (*shape, 3, 1))
    return corners + rng.uniform(-3.0, 3.0, (*shape, 1, 2))


def _maps(rng, *shape):
    return rng.normal(size=(*shape, 2, 2))


def _ordinary(rng):
    yield Case("the triangle (1, 0), (0, 1), (0, 0) and the identity", (_UNIT, np.eye(2)))
    yield Case("the same triangle and a stretch", (_UNIT, np.diag([2.0, 1.0])))
    yield Case("the same triangle and a shear", (_UNIT, np.array([[1.0, 1.0], [0.0, 1.0]])))
    for _ in range(3):
        yield Case("some triangle and map", (_triangles(rng), _maps(rng)))


def _batches(rng):
    yield Case("four triangles, each with its map", (_triangles(rng, 4), _maps(rng, 4)))
    yield Case("five triangles at three moments", (_triangles(rng, 5), _maps(rng, 3, 5)))
    yield Case("one triangle and four maps", (_triangles(rng), _maps(rng, 4)))


def _laws(f, rng):
    p, A, v = _triangles(rng), _maps(rng), rng.normal(size=(3, 2))
    Q = f.similarity(p, A)
    yield Claim("Q is symmetric", Q, Q.T, (p, A))
    yield Claim(
        "Q (a, b, a, b, a, b) = 0: moving the triangle costs nothing", Q @ np.tile([2.0, -1.0], 3), 0.0
    )
    similar = p @ A.T @ (0.7 * np.eye(2) + 1.3 * _J)
    yield Claim("Q v = 0 where v = s R A p", Q @ similar.ravel(), 0.0, (p, A))
    B = (v[:2] - v[2]).T @ np.linalg.inv((p[:2] - p[2]).T)
    basis = np.stack([A.ravel(), (_J @ A).ravel()], axis=1)
    nearest = basis @ np.linalg.lstsq(basis, B.ravel(), rcond=None)[0]
    least = float(np.sum((B.ravel() - nearest) ** 2))
    yield Claim("v^T Q v is the least |B - s R A|^2, (6.4)", v.ravel() @ Q @ v.ravel(), least, (p, A, v))
    yield Claim("A may be turned and scaled", f.similarity(p, (0.5 * np.eye(2) - 2.0 * _J) @ A), Q, (p, A))


def _hard(rng):
    p, A = _triangles(rng), _maps(rng)
    yield Case("corners in the other sense", (p[::-1], A))
    yield Case("a map that turns over", (p, np.diag([1.0, -1.0]) @ A))
    yield Case("a map onto a line", (p, np.array([[1.0, 2.0], [0.5, 1.0]])))
    yield Case("a map of size 1e-9", (p, 1e-9 * A))
    yield Case("a map of size 1e9", (p, 1e9 * A))
    yield Case("a triangle 2^20 away from the origin", (np.round(p * 1024.0) / 1024.0 + 2.0**20, A))
    yield Case("whole numbers", (np.array([[0, 0], [2, 1], [1, 3]]), np.array([[2, 1], [0, 1]])))


def _bad(rng):
    p, A = _triangles(rng, 3), _maps(rng, 3)
    line = np.array([[0.1, 0.3], [0.2, 0.6], [0.7, 2.1]])
    yield Case("a triangle on one line", (line, A[0]), raises=True)
    yield Case("the map 0", (p[0], np.zeros((2, 2))), raises=True)
    yield Case("a batch with one triangle on a line", (np.stack([p[0], line, p[2]]), A), raises=True)
    yield Case("a batch with one map 0", (p, A * np.array([1.0, 1.0, 0.0])[:, None, None]), raises=True)


def _quadratic(energy):
    """Return a wrong matrix: that of an energy(B, A) that is quadratic in B."""

    def wrong(corners, A):
        A, K = np.asarray(A, float), entries(corners)
        units = np.eye(4).reshape(4, 2, 2)
        M = np.empty((*A.shape[:-2], 4, 4))
        for i in range(4):
            for j in range(4):
                plus, minus = (energy(units[i] + sign * units[j], A) for sign in (1.0, -1.0))
                M[..., i, j] = (plus - minus) / 4.0
        return np.swapaxes(K, -1, -2) @ M @ K

    return wrong


def _square(M):
    return np.sum(M**2, axis=(-2, -1))


def _along(B, A):
    return np.sum(B * A, axis=(-2, -1)) ** 2


def _t(M):
    return np.swapaxes(M, -1, -2)


def _closed(one, two):
    """(6.5) with the matrix M in it, and with a factor of its determinant."""

    def energy(B, A):
        return _square(B) - (_square(one(B, A)) + two * np.linalg.det(one(B, A))) / _square(A)

    return _quadratic(energy)


def _by_axes(corners, A):
    order = [0, 2, 4, 1, 3, 5]
    return similarity(corners, A)[..., order, :][..., order]


def _points(corners, A):
    """E^S: the corners, from the middle, instead of the entries."""
    p = np.asarray(corners, float)
    p = np.swapaxes(p - p.mean(axis=-2, keepdims=True), -1, -2)

    def where(M):
        return (M @ p).reshape(*np.broadcast_shapes(M.shape[:-2], p.shape[:-2]), 6)

    A = np.asarray(A, float)
    a = np.stack([where(A), where(_J @ A)], axis=-1)
    a = a / np.sqrt(np.sum(a**2, axis=-2, keepdims=True))
    moved = np.stack([where(B) for B in np.eye(4).reshape(4, 2, 2)], axis=-1) @ entries(corners)
    off = moved - a @ (_t(a) @ moved)
    return _t(off) @ off


EXERCISE = Exercise(
    number=14,
    title="The energy that forgives rotations",
    equations=("5.2", "6.4", "6.5"),
    functions=(
        Function(
            "similarity",
            library="lietool.interp.forms.similarity",
            starter="many = np.broadcast_shapes(np.shape(corners)[:-2], np.shape(A)[:-2])\n"
            "return np.full((*many, 6, 6), np.nan)",
        ),
    ),
    checks=(
        Check("ordinary triangles and maps", 2, cases=_ordinary),
        Check("batches", 1, cases=_batches),
        Check("laws of the energy", 2, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B6.7", 3, lambda f: {"similarity": f.similarity}),
    mutants=("energy.form", "terms.sides_to_map", "triangle_kernels.inverse"),
    mistakes=(
        Mistake(
            "nothing forgiven",
            "This is |B|^2: nothing is taken off. The part of B along A, and that along A turned by a right "
            "angle, cost nothing, (6.5).",
            {"similarity": _quadratic(lambda B, A: _square(B))},
        ),
        Mistake(
            "scale only",
            "Only the scale is forgiven: what is taken off is the part of B along A. The part along J A, A "
            "turned by a right angle, costs nothing either: s R_delta A are all sums of multiples of both.",
            {"similarity": _quadratic(lambda B, A: _square(B) - _along(B, A) / _square(A))},
        ),
        Mistake(
            "no determinant",
            "The determinant of (6.5) is left out: 2 det(B A^T) belongs to |B A^T|^2.",
            {"similarity": _closed(lambda B, A: B @ _t(A), 0.0)},
        ),
        Mistake(
            "one determinant",
            "The determinant of (6.5) is there once; it counts twice.",
            {"similarity": _closed(lambda B, A: B @ _t(A), 1.0)},
        ),
        Mistake(
            "minus the determinant",
            "The sign of the determinant is wrong: this forgives the mirror images s R_delta A of A instead "
            "of its similar maps.",
            {"similarity": _closed(lambda B, A: B @ _t(A), -2.0)},
        ),
        Mistake(
            "A not transposed",
            "This has B A where (6.5) has B A^T.",
            {"similarity": _closed(lambda B, A: B @ A, 2.0)},
        ),
        Mistake(
            "rotation on the other side",
            "This forgives A R_delta, which turns first and then maps: (6.5) has B A^T, not A^T B, since in "
            "(6.4) R_delta stands before A.",
            {"similarity": _closed(lambda B, A: _t(A) @ B, 2.0)},
        ),
        Mistake(
            "not over |A|^2",
            "What is taken off is not divided by |A|^2, (6.5), so that it depends on the size of A, which "
            "is forgiven.",
            {"similarity": _quadratic(lambda B, A: _square(B) - _along(B, A) - _along(B, _J @ A))},
        ),
        Mistake(
            "E^S",
            "This is the matrix of E^S, (6.3), which compares where the corners go. E^R compares the maps by "
            "their entries.",
            {"similarity": _points},
        ),
        Mistake(
            "all x, then all y",
            "This is Q for v = (x_1, x_2, x_3, y_1, y_2, y_3). Here x and y of a corner stand beside each "
            "other.",
            {"similarity": _by_axes},
        ),
        Mistake(
            "twice Q",
            "This is 2 Q, the matrix of second derivatives. In v^T Q v no factor stands before it.",
            {"similarity": lambda corners, A: 2.0 * similarity(corners, A)},
        ),
    ),
)
