r"""The exponential map of rotations.

A vector $\mathbf{u}$ of space is also a skew-symmetric matrix, the one with $A \mathbf{p} = \mathbf{u}
\times \mathbf{p}$, and the exponential series $\exp(A) = I + A + A^2/2 + A^3/6 + \ldots$ of such a matrix is
a rotation: that about $\mathbf{u}$ by the angle $|\mathbf{u}|$. The series need not be summed, for it is

$$\exp(A) = I + \frac{\sin|\mathbf{u}|}{|\mathbf{u}|}\,A
  + \frac{1 - \cos|\mathbf{u}|}{|\mathbf{u}|^2}\,A^2 , \qquad (4.7)$$

where both fractions have limits as $\mathbf{u}$ goes to $0$.

Write two functions:

* `hat(u)`: the matrix $A$ of a vector;
* `exp(u)`: the rotation $\exp(A)$ of (4.7), for vectors of any length, $0$ included.

Matrices act on column vectors, angles are in radians. Vectors come in batches of shape `(..., 3)`, of
different lengths, and give matrices of shape `(..., 3, 3)`.

The picture has the rotations as the points of half a sphere, with $I$ at its pole: the lines on it and the
red way are where your `exp` takes straight lines and circles.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def hat(u):
    """Return the matrix A with A p = u x p.

    Parameters
    ----------
    u : ndarray, shape (..., 3)

    Returns
    -------
    A : ndarray, shape (..., 3, 3)
        Skew-symmetric.
    """
    x, y, z = np.moveaxis(np.asarray(u, float), -1, 0)
    o = np.zeros_like(x)
    rows = [np.stack(row, axis=-1) for row in ((o, -z, y), (z, o, -x), (-y, x, o))]
    return np.stack(rows, axis=-2)


def exp(u):
    """Return the rotation about u by the angle |u|.

    Parameters
    ----------
    u : ndarray, shape (..., 3)
        Axis times angle, radians, of any length.

    Returns
    -------
    R : ndarray, shape (..., 3, 3)
        Rotations, for column vectors.
    """
    A = hat(u)
    theta = np.linalg.norm(u, axis=-1)[..., None, None]
    # sinc(t) = sin(pi t) / (pi t), and 1 at 0; 1 - cos t = 2 sin(t / 2)^2.
    first, second = np.sinc(theta / np.pi), 0.5 * np.sinc(0.5 * theta / np.pi) ** 2
    return np.eye(3) + first * A + second * (A @ A)


def _directions(rng, *shape):
    u = rng.normal(size=(*shape, 3))
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def _matrices(rng):
    yield Case("a vector", (np.array([1.0, 2.0, 3.0]),), "hat")
    yield Case("the third axis", (np.array([0.0, 0.0, 1.0]),), "hat")
    yield Case("many", (rng.normal(size=(2, 4, 3)),), "hat")


def _ordinary(rng):
    yield Case("a quarter turn about z", (np.array([0.0, 0.0, np.pi / 2.0]),), "exp")
    yield Case("one radian about y", (np.array([0.0, 1.0, 0.0]),), "exp")
    for says, low, high in (("less than a half turn", 0.5, 3.0), ("more than a half turn", 3.5, 6.0)):
        yield Case(says, (rng.uniform(low, high) * _directions(rng),), "exp")


def _batches(rng):
    yield Case("six of different lengths", (rng.normal(size=(6, 3)),), "exp")
    yield Case("two rows of three", (rng.normal(size=(2, 3, 3)),), "exp")
    yield Case("one of them 0", (rng.normal(size=(3, 3)) * np.array([[1.0], [0.0], [1.0]]),), "exp")
    yield Case("none at all", (np.zeros((0, 3)),), "exp")


def _laws(f, rng):
    u, v, (s, t) = rng.normal(size=3), _directions(rng), rng.uniform(0.5, 2.0, 2)
    R, Q = f.exp(u), f.exp(v)
    yield Claim("R^T R = I", R.T @ R, np.eye(3), (u,))
    yield Claim("det R = 1", np.linalg.det(R), 1.0, (u,))
    yield Claim("the axis stays: R u = u", R @ u, u, (u,))
    yield Claim("exp(-u) = R^T", f.exp(-u), R.T, (u,))
    yield Claim(
        "exp(s u) exp(t u) = exp((s + t) u)", f.exp(s * u) @ f.exp(t * u), f.exp((s + t) * u), (u, s, t)
    )
    yield Claim("Q exp(u) Q^T = exp(Q u), Q = exp(v)", Q @ R @ Q.T, f.exp(Q @ u), (u, v))
    yield Claim("tr R = 1 + 2 cos |u|", np.trace(f.exp(s * v)), 1.0 + 2.0 * np.cos(s), (s * v,))


def _hard(rng):
    yield Case("u = 0", (np.zeros(3),), "exp")
    yield Case("length 1e-9", (1e-9 * _directions(rng),), "exp")
    yield Case("length 1e-200, whose square is 0", (1e-200 * _directions(rng),), "exp")
    yield Case("a half turn, length pi", (np.pi * _directions(rng),), "exp")
    yield Case("a full turn, length 2 pi", (2.0 * np.pi * _directions(rng),), "exp")
    yield Case("length 40, more than six turns", (40.0 * _directions(rng),), "exp")


def _formula(first, second):
    """A wrong `exp`, by the factors of A and A^2 as functions of the angle."""

    def wrong(u):
        A = hat(u)
        theta = np.linalg.norm(u, axis=-1)[..., None, None]
        return np.eye(3) + first(theta) * A + second(theta) * (A @ A)

    return {"exp": wrong}


def _first(theta):
    return np.sinc(theta / np.pi)


def _second(theta):
    return 0.5 * np.sinc(0.5 * theta / np.pi) ** 2


def _transposed(u):
    return hat(-np.asarray(u, float))


_MISTAKES = (
    Mistake(
        "hat transposed",
        "A is transposed: A p = u x p wants -u3 in the first row and u3 in the second. This one turns the "
        "other way.",
        {"hat": _transposed},
    ),
    Mistake(
        "both transposed",
        "The rotation turns the other way: the matrix of u x p has -u3 in its first row, u3 in its second.",
        {"exp": lambda u: exp(-np.asarray(u, float))},
    ),
    Mistake(
        "first order",
        "This is I + A, where the series begins: it is no rotation but for tiny u. (4.7) has sin |u| / |u| "
        "and a third term.",
        _formula(np.ones_like, np.zeros_like),
    ),
    Mistake(
        "second order",
        "These are the first three terms of the series, I + A + A^2 / 2: no rotation but for small u. (4.7) "
        "is the sum of all of them.",
        _formula(np.ones_like, lambda theta: np.full_like(theta, 0.5)),
    ),
    Mistake(
        "unit axis",
        "sin |u| and 1 - cos |u| belong to an axis of length 1: A has the length |u| in it, so that (4.7) "
        "divides by |u| and by |u|^2.",
        _formula(np.sin, lambda theta: 1.0 - np.cos(theta)),
    ),
    Mistake(
        "|u| for its square",
        "The last term is divided by |u| only: A^2 has |u|^2 in it, (4.7).",
        _formula(_first, lambda theta: theta * _second(theta)),
    ),
    Mistake(
        "A^2 missing",
        "The term with A^2 of (4.7) is missing: vectors across the axis become longer or shorter.",
        _formula(_first, np.zeros_like),
    ),
    Mistake(
        "minus A^2",
        "The sign of the last term is wrong: (4.7) has + (1 - cos |u|) / |u|^2 A^2; and A A^T is -A^2.",
        _formula(_first, lambda theta: -_second(theta)),
    ),
    Mistake(
        "cosine",
        "1 - cos |u| has become cos |u| in the last term of (4.7).",
        _formula(_first, lambda theta: np.cos(theta) / np.where(theta > 0.0, theta, 1.0) ** 2),
    ),
    Mistake(
        "entries",
        "This is the exponential function of every entry; exp(A) is the series of powers of a matrix, (4.7).",
        {"exp": lambda u: np.exp(hat(u))},
    ),
    Mistake(
        "0/0",
        "Right but for u = 0, where both fractions of (4.7) are 0/0: take their limits there, 1 and 1/2, and "
        "do not divide by a square that underflows.",
        _formula(lambda theta: np.sin(theta) / theta, lambda theta: (1.0 - np.cos(theta)) / theta**2),
    ),
    Mistake(
        "degrees",
        "|u| is taken for degrees: (4.7) has it in radians.",
        {"exp": lambda u: exp(np.deg2rad(u))},
    ),
)

EXERCISE = Exercise(
    number=8,
    title="The exponential map of rotations",
    equations=("4.7",),
    functions=(
        Function(
            "hat",
            library="lietool.lie.so3.hat",
            starter="return np.full((*np.shape(u), 3), np.nan)",
            tolerance=1e-14,
        ),
        Function(
            "exp",
            library="lietool.lie.so3.exp",
            starter="return np.full((*np.shape(u), 3), np.nan)",
            tolerance=1e-12,
        ),
    ),
    checks=(
        Check("the matrix of a vector", 1, cases=_matrices),
        Check("ordinary vectors", 2, cases=_ordinary),
        Check("many at once", 1, cases=_batches),
        Check("laws of the exponential map", 2, law=_laws),
        Check("hard inputs", 2, cases=_hard),
    ),
    picture=Picture("B4.2", 2, lambda f: {"exp": f.exp}),
    mutants=("so3.exp",),
    mistakes=_MISTAKES,
)
