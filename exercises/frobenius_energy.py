r"""The matrix of E^F.

A shape is cut into triangles; its vertices at rest are $\mathbf{p}_1, \dots, \mathbf{p}_n$. Where they are
moved to $\mathbf{v}_1, \dots, \mathbf{v}_n$, each triangle $i$ has an affine map (5.2) that carries its
corners there, with the linear part $B_i$. It should be near to a given $A_i$. How near it is, is measured by

$$E_i^F = \|B_i - A_i\|_F^2, \qquad (6.2)$$

the sum of the squares of all four entries of the difference. Summed over the triangles, each with its weight
$w_i$ (its area, usually), this is quadratic in the vertices. With
$\mathbf{v} = (x_1, y_1, x_2, y_2, \dots, x_n, y_n)$, in this order, it can be written as in section 6.3:

$$E(\mathbf{v}) = \sum_i w_i\,\|B_i - A_i\|_F^2
  = \mathbf{v}^T G\,\mathbf{v} + \mathbf{v}^T\mathbf{u} + c$$

with a symmetric matrix $G$ that does not depend on the $A_i$. The vertices are best where the gradient
$2\,G\,\mathbf{v} + \mathbf{u}$ is zero.

Write `matrix(P, F, weights)`, which returns $G$, and `pull(P, F, weights, A)`, which returns $\mathbf{u}$.
The rows of `P`, of shape `(n, 2)`, are the vertices at rest; those of `F`, of shape `(m, 3)`, the numbers of
the vertices of each triangle, from 0, in either sense. The maps `A` have the shape `(..., m, 2, 2)`: often
there are those of many moments at once. A triangle whose corners lie on one line is refused with a
`ValueError`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def matrix(P, F, weights):
    """Return the matrix G of E^F.

    Parameters
    ----------
    P : ndarray, shape (n, 2)
        The vertices at rest.
    F : ndarray of int, shape (m, 3)
        The vertices of each triangle.
    weights : ndarray, shape (m,)
        Of the triangles.

    Returns
    -------
    ndarray, shape (2 n, 2 n)
        For v = (x_1, y_1, ..., x_n, y_n).

    Raises
    ------
    ValueError
        If the corners of a triangle lie on one line but for rounding (its area is less than 1e-14 of the sum
        of the squares of its sides).
    """
    g, n = gradients(P, F), len(P)
    # B = sum of v_k g_k^T has |B|^2 = sum of (v_k . v_l) (g_k . g_l): x and y by themselves, and alike.
    products = weights[:, None, None] * (g @ np.swapaxes(g, -1, -2))
    half = np.zeros((n, n))
    np.add.at(half, (F[:, :, None], F[:, None, :]), products)
    return np.kron(half, np.eye(2))


def pull(P, F, weights, A):
    """Return the vector u of E^F.

    Parameters
    ----------
    P : ndarray, shape (n, 2)
        The vertices at rest.
    F : ndarray of int, shape (m, 3)
        The vertices of each triangle.
    weights : ndarray, shape (m,)
        Of the triangles.
    A : ndarray, shape (..., m, 2, 2)
        The maps that the triangles should have.

    Returns
    -------
    ndarray, shape (..., 2 n)
        For v = (x_1, y_1, ..., x_n, y_n).

    Raises
    ------
    ValueError
        As of `matrix`.
    """
    # The mixed term of |B - A|^2 is -2 sum of v_k . (A g_k).
    each = -2.0 * weights[:, None, None] * (gradients(P, F) @ np.swapaxes(A, -1, -2))
    u = np.zeros((len(P), 2, *np.shape(A)[:-3]))
    np.add.at(u, F, np.moveaxis(each, (-3, -2, -1), (0, 1, 2)))
    return np.moveaxis(u, (0, 1), (-2, -1)).reshape(*np.shape(A)[:-3], -1)


def gradients(P, F):
    """Return the vectors g_k of triangles, shape (m, 3, 2), with which B = sum of v_k g_k^T."""
    p = np.asarray(P, float)[F]
    sides = np.swapaxes(p[:, :2] - p[:, 2:], -1, -2)
    if np.any(np.abs(np.linalg.det(sides)) <= 1e-14 * np.sum(sides**2, axis=(-2, -1))):
        raise ValueError("every triangle must have an area")
    # B carries sides to sides: [v1 - v3, v2 - v3] = B [p1 - p3, p2 - p3].
    first = np.linalg.inv(sides)
    return np.concatenate([first, -first.sum(axis=1, keepdims=True)], axis=1)


_ONE = (np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]]), np.array([1.0]))
_TWO = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.array([[0, 1, 2], [0, 2, 3]])


def _areas(P, F):
    (ax, ay), (bx, by) = (np.moveaxis(P[F[:, k]] - P[F[:, 2]], -1, 0) for k in (0, 1))
    return np.abs(ax * by - ay * bx) / 2.0


def _star(rng, k=5):
    """A vertex with k triangles round it, their areas, and their maps."""
    around = 2.0 * np.pi * (np.arange(k) + rng.uniform(-0.2, 0.2, k)) / k
    rim = np.stack([np.cos(around), np.sin(around)], axis=1) * rng.uniform(0.7, 1.6, (k, 1))
    P = np.concatenate([rng.uniform(-0.1, 0.1, (1, 2)), rim]) + rng.uniform(-2.0, 2.0, 2)
    F = np.array([[0, 1 + i, 1 + (i + 1) % k] for i in range(k)])
    return P, F, _areas(P, F)


def _maps(rng, *shape):
    return np.eye(2) + 0.6 * rng.normal(size=(*shape, 2, 2))


def _one(rng):
    yield Case("the triangle (0, 0), (2, 0), (0, 1)", _ONE, "matrix")
    p = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.75**0.5]])
    yield Case("a triangle with equal sides, of weight 3", (p, _ONE[1], np.array([3.0])), "matrix")
    P, F, weights = _star(rng)
    yield Case("some triangle", (P[F[0]], _ONE[1], weights[:1]), "matrix")


def _whole(rng):
    yield Case("a square of two triangles", (*_TWO, np.array([0.5, 0.5])), "matrix")
    yield Case("a star of five triangles", _star(rng), "matrix")
    P, F, _ = _star(rng, 6)
    yield Case("a star with other weights than areas", (P, F, rng.uniform(0.5, 2.0, 6)), "matrix")


def _pulls(rng):
    yield Case("one triangle", (*_ONE, np.array([[[1.0, 2.0], [0.0, 3.0]]])), "pull")
    yield Case("a star of five triangles", (*_star(rng), _maps(rng, 5)), "pull")
    yield Case("the maps of four moments", (*_star(rng, 4), _maps(rng, 4, 4)), "pull")
    yield Case("two by three moments", (*_star(rng), _maps(rng, 2, 3, 5)), "pull")


def _laws(f, rng):
    P, F, w = shape = _star(rng)
    A, v = _maps(rng, 5), P + rng.normal(size=P.shape)
    G, u = f.matrix(P, F, w), f.pull(P, F, w, A)
    yield Claim("G is symmetric", G, G.T, shape)
    yield Claim(
        "G (a, b, a, b, ...) = 0: moving all costs nothing", G @ np.tile([1.0, -2.0], len(P)), 0.0, shape
    )
    sides = [np.swapaxes(x[F][:, :2] - x[F][:, 2:], -1, -2) for x in (v, P)]
    B = sides[0] @ np.linalg.inv(sides[1])
    error = float(w @ np.sum((B - A) ** 2, axis=(1, 2)))
    c, x = float(w @ np.sum(A**2, axis=(1, 2))), v.ravel()
    yield Claim("v^T G v + v^T u + c is the sum of w |B - A|^2", x @ G @ x + x @ u + c, error, (*shape, A))
    same = np.broadcast_to(A[0], A.shape)
    gradient = 2.0 * G @ (P @ A[0].T).ravel() + f.pull(P, F, w, same)
    yield Claim("where all A_i are one A, v = A p is best", gradient, 0.0, (*shape, same))


def _hard(rng):
    P, F, w = _star(rng)
    A = _maps(rng, 5)
    for name, more in (("matrix", ()), ("pull", (A,))):
        yield Case("triangles in the other sense", (P, F[:, ::-1], w, *more), name)
        yield Case(
            "a shape 2^20 away from the origin", (np.round(P * 1024) / 1024 + 2.0**20, F, w, *more), name
        )
        number = rng.permutation(len(P))
        yield Case("vertices in another order", (P[np.argsort(number)], number[F], w, *more), name)
        flat = P * [1.0, 1e-3]
        yield Case("triangles a thousand times as long as high", (flat, F, w, *more), name)
    yield Case(
        "corners that are whole numbers", (np.array([[0, 0], [2, 1], [1, 3]]), _ONE[1], _ONE[2]), "matrix"
    )


def _bad(rng):
    P, F, w = _star(rng)
    line = np.array([[0.1, 0.3], [0.2, 0.6], [0.7, 2.1]])
    yield Case("a triangle on one line", (line, _ONE[1], _ONE[2]), "matrix", raises=True)
    yield Case("a triangle with one vertex twice", (P, np.array([[0, 1, 1]]), _ONE[2]), "matrix", raises=True)
    pressed = P.copy()
    pressed[2] = (pressed[0] + pressed[1]) / 2.0
    yield Case("one triangle of five on a line", (pressed, F, w, _maps(rng, 5)), "pull", raises=True)


def _halves(P, F, weights):
    return matrix(P, F, weights)[::2, ::2]


def _as_blocks(P, F, weights):
    return np.kron(np.eye(2), _halves(P, F, weights))


def _moments(P, F, weights):
    """E^P, with the corners from the middle of each triangle."""
    g = gradients(P, F)
    p = np.asarray(P, float)[F]
    p = p - p.mean(axis=1, keepdims=True)
    return _added(P, F, weights[:, None, None] * (g @ np.swapaxes(p, -1, -2) @ p @ np.swapaxes(g, -1, -2)))


def _added(P, F, products):
    half = np.zeros((len(P), len(P)))
    np.add.at(half, (F[:, :, None], F[:, None, :]), products)
    return np.kron(half, np.eye(2))


def _transposed(P, F, weights):
    """With the inverse of the sides transposed."""
    first = np.swapaxes(gradients(P, F)[:, :2], -1, -2)
    g = np.concatenate([first, -first.sum(axis=1, keepdims=True)], axis=1)
    return _added(P, F, weights[:, None, None] * (g @ np.swapaxes(g, -1, -2)))


def _overwritten(P, F, weights):
    """What `half[i, j] += ...` does: of several triangles at an edge the last one remains."""
    g, half = gradients(P, F), np.zeros((len(P), len(P)))
    half[F[:, :, None], F[:, None, :]] += weights[:, None, None] * (g @ np.swapaxes(g, -1, -2))
    return np.kron(half, np.eye(2))


def _by_axes(u):
    """All x, then all y."""
    return np.concatenate([u[..., ::2], u[..., 1::2]], axis=-1)


EXERCISE = Exercise(
    number=13,
    title="The matrix of E^F",
    equations=("5.2", "6.2"),
    functions=(
        Function(
            "matrix",
            library="lietool.interp.forms.matrix",
            starter="return np.full((2 * len(P), 2 * len(P)), np.nan)",
        ),
        Function(
            "pull",
            library="lietool.interp.forms.pull",
            starter="return np.full((*np.shape(A)[:-3], 2 * len(P)), np.nan)",
        ),
    ),
    checks=(
        Check("G of one triangle", 1, cases=_one),
        Check("G of several triangles", 1, cases=_whole),
        Check("u", 2, cases=_pulls),
        Check("laws of the energy", 1, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B6.4", 3, lambda f: {"matrix": f.matrix, "pull": f.pull}),
    mutants=("terms.", "triangle_kernels.inverse"),
    mistakes=(
        Mistake(
            "not added up",
            "At a vertex or an edge that several triangles have, only the last of them counts. With a list "
            "of places, G[i, j] += ... does not add up what is for the same place; np.add.at does.",
            {"matrix": _overwritten},
        ),
        Mistake(
            "weights left out",
            "The weights are left out: each triangle counts by its w_i, usually its area.",
            {"matrix": lambda P, F, weights: matrix(P, F, np.ones_like(weights))},
        ),
        Mistake(
            "all x, then all y",
            "This is G for v = (x_1, ..., x_n, y_1, ..., y_n). Here x and y of a vertex stand beside "
            "each other.",
            {"matrix": _as_blocks},
        ),
        Mistake(
            "twice G",
            "This is 2 G, the matrix of second derivatives. In v^T G v no factor stands before it.",
            {"matrix": lambda P, F, weights: 2.0 * matrix(P, F, weights)},
        ),
        Mistake(
            "E^P",
            "This is the matrix of E^P, (6.1), which compares where the corners go. E^F compares the maps "
            "by their entries, (6.2).",
            {"matrix": _moments},
        ),
        Mistake(
            "transposed",
            "The inverse of the sides stands transposed. [v1 - v3, v2 - v3] = B [p1 - p3, p2 - p3] has the "
            "sides as columns, so that B = v1 g1^T + v2 g2^T + v3 g3^T, where g1 and g2 are the rows of the "
            "inverse.",
            {"matrix": _transposed},
        ),
        Mistake(
            "half of u",
            "This is half of u. |B - A|^2 = |B|^2 - 2 B . A + |A|^2 has a 2 in its middle.",
            {"pull": lambda P, F, weights, A: 0.5 * pull(P, F, weights, A)},
        ),
        Mistake(
            "sign of u",
            "This is -u. |B - A|^2 = |B|^2 - 2 B . A + |A|^2 has a minus before its middle; the right side "
            "of 2 G v = -u has none.",
            {"pull": lambda P, F, weights, A: -pull(P, F, weights, A)},
        ),
        Mistake(
            "right side of G v",
            "This is -u / 2, the right side of G v = -u / 2; wanted is u itself.",
            {"pull": lambda P, F, weights, A: -0.5 * pull(P, F, weights, A)},
        ),
        Mistake(
            "A transposed",
            "The A_i stand transposed: each triangle is asked to turn the other way.",
            {"pull": lambda P, F, weights, A: pull(P, F, weights, np.swapaxes(A, -1, -2))},
        ),
        Mistake(
            "weights of u left out",
            "The weights are left out: in u, too, each triangle counts by its w_i.",
            {"pull": lambda P, F, weights, A: pull(P, F, np.ones_like(weights), A)},
        ),
        Mistake(
            "u by axes",
            "This is u for v = (x_1, ..., x_n, y_1, ..., y_n). Here x and y of a vertex stand beside "
            "each other.",
            {"pull": lambda P, F, weights, A: _by_axes(pull(P, F, weights, A))},
        ),
    ),
)
