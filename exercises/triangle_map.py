r"""The map between two triangles.

A triangle of the plane is given by its corners $\mathbf{p}_k = (x_k, y_k)$, $k = 1, 2, 3$. One affine map
carries the points $(1, 0)$, $(0, 1)$, $(0, 0)$, in this order, to its corners; as a matrix it is

$$\begin{pmatrix} x_1 - x_3 & x_2 - x_3 & x_3 \\ y_1 - y_3 & y_2 - y_3 & y_3 \\ 0 & 0 & 1 \end{pmatrix}
 = \begin{pmatrix} x_1 & x_2 & x_3 \\ y_1 & y_2 & y_3 \\ 1 & 1 & 1 \end{pmatrix}
   \begin{pmatrix} 1 & 0 & 0 \\ 0 & 1 & 0 \\ -1 & -1 & 1 \end{pmatrix}. \qquad (5.1)$$

Of two triangles, $\mathbf{p}$ and $\mathbf{q}$ with $\mathbf{q}_k = (x'_k, y'_k)$, the first is carried to
the second, corner by corner, by just one affine map:

$$\hat A = \begin{pmatrix} A & \mathbf{d} \\ 0 & 1 \end{pmatrix}
 = \begin{pmatrix} x'_1 & x'_2 & x'_3 \\ y'_1 & y'_2 & y'_3 \\ 1 & 1 & 1 \end{pmatrix}
   \begin{pmatrix} x_1 & x_2 & x_3 \\ y_1 & y_2 & y_3 \\ 1 & 1 & 1 \end{pmatrix}^{-1}. \qquad (5.2)$$

Write `frame(triangle)`, the matrix of (5.1), and `triangle_map(source, target)`, the $\hat A$ of (5.2). Both
return matrices for column vectors: `A_hat @ [x, y, 1]` is the image of the point $(x, y)$.

The corners of a triangle are the rows of an array of shape `(3, 2)`. Both functions also take batches, of
shape `(..., 3, 2)`; the batches of source and target go together as numpy broadcasts them. A source whose
corners lie on one line has no map to other triangles and is refused with a `ValueError`, and so is what is
not finite. The target may be any three points. A small triangle may lie far from the origin: what it loses
there should be no more than rounding.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture, compare


def frame(triangle):
    """Return the affine map that carries (1, 0), (0, 1), (0, 0) to the corners of a triangle.

    Parameters
    ----------
    triangle : ndarray, shape (..., 3, 2)
        The corners, one in each row.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        The matrix of (5.1).
    """
    p = np.asarray(triangle, float)
    made = np.zeros((*p.shape[:-2], 3, 3))
    # The sides p1 - p3 and p2 - p3 and the corner p3, as columns.
    made[..., :2, 0] = p[..., 0, :] - p[..., 2, :]
    made[..., :2, 1] = p[..., 1, :] - p[..., 2, :]
    made[..., :2, 2] = p[..., 2, :]
    made[..., 2, 2] = 1.0
    return made


def triangle_map(source, target):
    """Return the affine map that carries a triangle to another, corner by corner.

    Parameters
    ----------
    source : ndarray, shape (..., 3, 2)
        The corners p of the one, one in each row.
    target : ndarray, shape (..., 3, 2)
        The corners q of the other.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        The matrix A-hat of (5.2).

    Raises
    ------
    ValueError
        If the corners of a source lie on one line but for rounding (its area is less than 1e-14 of the sum
        of the squares of its sides), or a number is not finite.
    """
    if not (np.isfinite(source).all() and np.isfinite(target).all()):
        raise ValueError("corners must be finite")
    P, Q = frame(source), frame(target)
    E = P[..., :2, :2]
    if np.any(np.abs(np.linalg.det(E)) <= 1e-14 * np.sum(E**2, axis=(-2, -1))):
        raise ValueError("the source must be a triangle with area")
    # Sides to sides, then a corner to its corner: the inverse of all of (5.2) loses digits far from 0.
    A = Q[..., :2, :2] @ np.linalg.inv(E)
    made = np.zeros((*A.shape[:-2], 3, 3))
    made[..., :2, :2] = A
    made[..., :2, 2] = Q[..., :2, 2] - np.einsum("...ij,...j->...i", A, P[..., :2, 2])
    made[..., 2, 2] = 1.0
    return made


_FIRST = np.array([[0.0, 0.0], [1.5, 1.4], [-0.1, 1.6]])
_SECOND = np.array([[4.8, 0.5], [3.0, 2.64], [4.16, 0.61]])
_UNIT = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])


def _triangles(rng, *shape):
    """Triangles of about the same size, none of them flat, somewhere near the origin."""
    around = 2.0 * np.pi * (np.arange(3) / 3.0 + rng.uniform(-0.1, 0.1, (*shape, 3)))
    corners = np.stack([np.cos(around), np.sin(around)], axis=-1) * rng.uniform(0.6, 2.0, (*shape, 3, 1))
    return corners + rng.uniform(-3.0, 3.0, (*shape, 1, 2))


def _frames(rng):
    yield Case("the grey triangle of figure 5.1", (_FIRST,), "frame")
    yield Case("some triangle", (_triangles(rng),), "frame")
    yield Case("two by three triangles at once", (_triangles(rng, 2, 3),), "frame")


def _ordinary(rng):
    yield Case("the triangles of figure 5.1", (_FIRST, _SECOND), "triangle_map")
    yield Case("a triangle that is moved only", (_FIRST, _FIRST + np.array([2.0, -1.0])), "triangle_map")
    yield Case("a mirror image", (_FIRST, _FIRST * [-1.0, 1.0]), "triangle_map")
    for _ in range(3):
        yield Case("some triangles", (_triangles(rng), _triangles(rng)), "triangle_map")


def _batches(rng):
    yield Case("four triangles and their images", (_triangles(rng, 4), _triangles(rng, 4)), "triangle_map")
    yield Case("one triangle and five images", (_triangles(rng), _triangles(rng, 5)), "triangle_map")
    yield Case(
        "two triangles, each with three images",
        (_triangles(rng, 2, 1), _triangles(rng, 2, 3)),
        "triangle_map",
    )


def _laws(f, rng):
    p, q, r = _triangles(rng, 3)
    to_q, to_r = f.triangle_map(p, q), f.triangle_map(q, r)
    ones = np.ones((1, 3))
    image = to_q @ np.vstack([p.T, ones])
    yield Claim("the corners p_k go to q_k", image, np.vstack([q.T, ones]), (p, q))
    middle = to_q @ np.append(p.mean(axis=0), 1.0)
    yield Claim("the middle goes to the middle", middle[:2], q.mean(axis=0), (p, q))
    yield Claim("from p to q and from q to r is from p to r", to_r @ to_q, f.triangle_map(p, r), (p, q, r))
    yield Claim("(1, 0), (0, 1), (0, 0) to p is (5.1)", f.triangle_map(_UNIT, p), f.frame(p), (p,))


def _hard(rng):
    p, q = _triangles(rng, 2)
    yield Case("corners that are whole numbers", (np.array([[0, 0], [2, 1], [1, 3]]), _UNIT), "triangle_map")
    yield Case("a triangle of size 1e-9", (1e-9 * p, 1e-9 * q), "triangle_map")
    # The numbers are such that both triangles are there without rounding.
    away, still = np.array([2.0**30, -(2.0**30)]), np.round(1024.0 * p) / 1024.0
    # As far as it tells, the linear part: beside d its errors would not be seen.
    yield Case("a triangle 1e9 away, carried to the origin", (still + away, _UNIT), "triangle_map")
    yield Case("a target on one line", (p, [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]]), "triangle_map")


def _bad(rng):
    line = np.array([[0.1, 0.3], [0.2, 0.6], [0.7, 2.1]])
    yield Case("a source on one line", (line, _SECOND), "triangle_map", raises=True)
    yield Case("a source that is a point", (np.ones((3, 2)), _SECOND), "triangle_map", raises=True)
    flat = np.stack([_FIRST, line])
    yield Case("a batch with one source on a line", (flat, _SECOND), "triangle_map", raises=True)
    yield Case("a target with a nan", (_FIRST, _SECOND * [1.0, np.nan]), "triangle_map", raises=True)


def _parts_apart(got, want):
    """Linear part and translation by themselves, each relative to its size: d may be very much larger."""
    compare.apart(got, want)
    got, want = np.asarray(got, float), np.asarray(want, float)
    parts = ((slice(0, 2), slice(0, 2)), (slice(0, 2), 2), (2, slice(None)))
    return max(compare.apart(got[..., i, j], want[..., i, j]) for i, j in parts)


def _homogeneous(corners):
    p = np.swapaxes(np.asarray(corners, float), -1, -2)
    return np.concatenate([p, np.ones((*p.shape[:-2], 1, 3))], axis=-2)


def _made(A, d):
    """Return the matrix of a linear part and a translation."""
    shape = np.broadcast_shapes(A.shape[:-2], d.shape[:-1])
    made = np.zeros((*shape, 3, 3))
    made[..., :2, :2], made[..., :2, 2], made[..., 2, 2] = A, d, 1.0
    return made


def _linear(source, target):
    return triangle_map(source, target)[..., :2, :2]


def _corner(corners):
    return np.asarray(corners, float)[..., 2, :]


EXERCISE = Exercise(
    number=11,
    title="The map between two triangles",
    equations=("5.1", "5.2"),
    functions=(
        Function(
            "frame",
            library="lietool.interp.triangle.frame",
            starter="return np.full((*np.shape(triangle)[:-2], 3, 3), np.nan)",
            tolerance=1e-12,
        ),
        Function(
            "triangle_map",
            library="lietool.interp.triangle.affine_map",
            starter="many = np.broadcast_shapes(np.shape(source), np.shape(target))[:-2]\n"
            "return np.full((*many, 3, 3), np.nan)",
            apart=_parts_apart,
            tolerance=1e-10,
        ),
    ),
    checks=(
        Check("the frame of a triangle", 1, cases=_frames),
        Check("ordinary triangles", 2, cases=_ordinary),
        Check("batches", 1, cases=_batches),
        Check("laws of affine maps", 1, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B5.1b", 3, lambda f: {"affine_map": f.triangle_map}),
    mutants=("triangle.affine_map",),
    mistakes=(
        Mistake(
            "the wrong way",
            "This is the map from the target to the source. A-hat P = Q gives A-hat = Q P^-1, (5.2): the "
            "matrix that is inverted is that of the triangle where one begins.",
            {"triangle_map": lambda source, target: np.linalg.inv(triangle_map(source, target))},
        ),
        Mistake(
            "inverse in front",
            "This is P^-1 Q. The corners are columns, A-hat P = Q, so that the inverse stands behind: "
            "A-hat = Q P^-1, (5.2).",
            {"triangle_map": lambda s, t: np.linalg.inv(_homogeneous(s)) @ _homogeneous(t)},
        ),
        Mistake(
            "transposed",
            "This matrix is transposed: it is for points that are rows. In (5.2) the corners are columns "
            "over a row of ones, and A-hat ends with the row 0 0 1.",
            {"triangle_map": lambda s, t: np.swapaxes(triangle_map(s, t), -1, -2)},
        ),
        Mistake(
            "d is q - p",
            "The translation is taken for q3 - p3. The linear part moves p3 too: d = q3 - A p3, which is "
            "what the last column of (5.2) comes to.",
            {"triangle_map": lambda s, t: _made(_linear(s, t), _corner(t) - _corner(s))},
        ),
        Mistake(
            "no translation",
            "The last column is 0: only the linear part A of (5.2) is there, which leaves the origin where "
            "it is. The corners go to q by A p + d.",
            {"triangle_map": lambda s, t: _made(_linear(s, t), np.zeros(2))},
        ),
        Mistake(
            "d is q",
            "The translation is taken for q3, as if p3 were the origin: d = q3 - A p3.",
            {"triangle_map": lambda s, t: _made(_linear(s, t), _corner(t))},
        ),
        Mistake(
            "sides from the first corner",
            "This carries (0, 0) to the first corner. In (5.1) the third is that of the origin: the sides "
            "are p1 - p3 and p2 - p3, and the last column is p3.",
            {"frame": lambda triangle: frame(np.roll(triangle, -1, axis=-2))},
        ),
        Mistake(
            "corners for sides",
            "These are the corners over a row of ones, the first matrix on the right of (5.1). What is "
            "wanted is its product with the second: the sides p1 - p3 and p2 - p3, and p3, as columns.",
            {"frame": _homogeneous},
        ),
        Mistake(
            "sides backwards",
            "The sides have the wrong sign: (5.1) has p1 - p3 and p2 - p3, from the third corner to "
            "the others.",
            {"frame": lambda triangle: frame(triangle) * [-1.0, -1.0, 1.0]},
        ),
        Mistake(
            "frame transposed",
            "This matrix is transposed: in (5.1) the sides are columns, and the last row is 0 0 1.",
            {"frame": lambda triangle: np.swapaxes(frame(triangle), -1, -2)},
        ),
    ),
)
