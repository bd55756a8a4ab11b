r"""The rotation about an axis.

A rotation of space is given by a unit vector $\mathbf{u}$, its axis, and an angle $\theta$. It carries a
vector $\mathbf{x}$ to

$$R\mathbf{x} = (\cos\theta)\,\mathbf{x} + (\sin\theta)\,(\mathbf{u}\times\mathbf{x})
  + (1 - \cos\theta)\,(\mathbf{u}\cdot\mathbf{x})\,\mathbf{u}, \qquad (2.14)$$

which is Rodrigues's formula. Seen from the tip of $\mathbf{u}$ the turn is counterclockwise.

Write `rotation(axis, angle)`, which returns the matrix $R$ of (2.14). Vectors are columns: `R @ x` is the
turned vector. The angle is in radians, of any size and sign.

Both arguments may be batches: axes of shape `(..., 3)` and angles of shape `(...)` go together as numpy
broadcasts them, and give matrices of shape `(..., 3, 3)`. An axis whose length is not 1, and what is not
finite, is refused with a `ValueError`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def rotation(axis, angle):
    """Return the rotation about an axis by an angle.

    Parameters
    ----------
    axis : ndarray, shape (..., 3)
        Unit vectors u.
    angle : float or ndarray, shape (...)
        Angles theta in radians.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        The matrices R, for column vectors.

    Raises
    ------
    ValueError
        If an axis is not of length 1 (to one part in a million), or a number is not finite.
    """
    u, theta = np.asarray(axis, float), np.asarray(angle, float)
    if not (np.isfinite(u).all() and np.isfinite(theta).all()):
        raise ValueError("axis and angle must be finite")
    if np.any(np.abs(np.linalg.norm(u, axis=-1) - 1.0) > 1e-6):
        raise ValueError("axis must have length 1")
    # (2.14) for the three vectors of the standard basis at once: the columns of R.
    cos, sin = np.cos(theta)[..., None, None], np.sin(theta)[..., None, None]
    along = u[..., :, None] * u[..., None, :]
    return cos * np.eye(3) + sin * cross_matrix(u) + (1.0 - cos) * along


def cross_matrix(u):
    """Return the matrix of x -> u cross x, shape (..., 3, 3)."""
    x, y, z = np.moveaxis(u, -1, 0)
    o = np.zeros_like(x)
    return np.stack([o, -z, y, z, o, -x, -y, x, o], axis=-1).reshape(*u.shape, 3)


_X, _Y, _Z = np.eye(3)
_DIAGONAL = np.full(3, 1.0) / np.sqrt(3.0)


def _axes(rng, *shape):
    u = rng.normal(size=(*shape, 3))
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def _ordinary(rng):
    yield Case("a quarter of a turn about z", (_Z, np.pi / 2.0))
    yield Case("a third of a turn about the diagonal", (_DIAGONAL, 2.0 * np.pi / 3.0))
    yield Case("backwards about x", (_X, -1.2))
    for _ in range(3):
        yield Case("some axis and angle", (_axes(rng), rng.uniform(-3.0, 3.0)))


def _batches(rng):
    yield Case("five axes and five angles", (_axes(rng, 5), rng.uniform(-3.0, 3.0, 5)))
    yield Case("one axis and four angles", (_axes(rng), rng.uniform(-3.0, 3.0, 4)))
    yield Case("two axes, each with three angles", (_axes(rng, 2, 1), rng.uniform(-3.0, 3.0, (2, 3))))


def _laws(f, rng):
    u, (a, b) = _axes(rng), rng.uniform(-3.0, 3.0, 2)
    R, S = f.rotation(u, a), f.rotation(u, b)
    yield Claim("R^T R = I", R.T @ R, np.eye(3), (u, a))
    yield Claim("det R = 1", np.linalg.det(R), 1.0, (u, a))
    yield Claim("R u = u, (2.16)", R @ u, u, (u, a))
    yield Claim("two turns about one axis: R(a) R(b) = R(a + b)", R @ S, f.rotation(u, a + b), (u, a, b))


def _hard(rng):
    yield Case("angle 0", (_axes(rng), 0.0))
    yield Case("half a turn", (_axes(rng), np.pi))
    yield Case("angle pi - 1e-9", (_axes(rng), np.pi - 1e-9))
    yield Case("angle 1e-6", (_axes(rng), 1e-6))
    yield Case("a hundred turns and a bit", (_axes(rng), 200.0 * np.pi + 1.0))
    yield Case("an axis of whole numbers", (np.array([0, 0, -1]), 0.5))


def _bad(rng):
    yield Case("an axis of length 2", (2.0 * _Y, 1.0), raises=True)
    yield Case("an axis of length 0", (np.zeros(3), 1.0), raises=True)
    yield Case("an angle that is nan", (_Z, np.nan), raises=True)
    yield Case("a batch with one axis of length 1.01", (np.stack([_X, 1.01 * _Y]), 1.0), raises=True)


def _formula(one, cross, along):
    """Return a wrong rotation: the three terms with other factors, functions of the angle."""

    def wrong(axis, angle):
        u, theta = np.asarray(axis, float), np.asarray(angle, float)[..., None, None]
        terms = (np.eye(3), cross_matrix(u), u[..., :, None] * u[..., None, :])
        return sum(factor(theta) * term for factor, term in zip((one, cross, along), terms, strict=True))

    return wrong


def _rest(theta):
    return 1.0 - np.cos(theta)


def _printed(axis, angle):
    """(A.1) as it is printed: a number is added to a vector."""
    u, theta = np.asarray(axis, float), np.asarray(angle, float)[..., None, None]
    across = np.eye(3) - u[..., :, None] * u[..., None, :]
    return np.cos(theta) * across + np.sin(theta) * cross_matrix(u) + np.ones((3, 1)) * u[..., None, :]


EXERCISE = Exercise(
    number=1,
    title="The rotation about an axis",
    equations=("2.14", "2.15", "2.16"),
    functions=(
        Function(
            "rotation",
            library="lietool.lie.so3.from_axis_angle",
            starter="return np.full((*np.shape(angle), 3, 3), np.nan)",
            tolerance=1e-12,
        ),
    ),
    checks=(
        Check("ordinary angles", 3, cases=_ordinary),
        Check("batches", 1, cases=_batches),
        Check("laws of rotations", 1, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B2.5", 3, lambda f: {"rotation": f.rotation}),
    mutants=("so3.from_axis_angle: half", "so3.exp: half angle missing", "so3.exp: angle off"),
    mistakes=(
        Mistake(
            "degrees",
            "The angle is taken for degrees. In (2.14) it is in radians, and so is the argument.",
            {"rotation": lambda axis, angle: rotation(axis, np.deg2rad(angle))},
        ),
        Mistake(
            "transposed",
            "This turns the other way: it is R^T, the rotation by -theta. For column vectors the matrix of "
            "u x in (2.15) has -u3 in its first row; in code for row vectors it stands transposed.",
            {"rotation": lambda axis, angle: rotation(axis, -np.asarray(angle))},
        ),
        Mistake(
            "1 - cos missing",
            "The part along the axis comes out too long, R u = (1 + cos theta) u: the last term of (2.14) "
            "has the factor 1 - cos(theta), for cos(theta) of that part is in the first term already.",
            {"rotation": _formula(np.cos, np.sin, np.ones_like)},
        ),
        Mistake(
            "I missing in (2.15)",
            "The vector across the axis is not shortened by cos(theta): the last matrix of (2.15) is "
            "u u^T - I, not u u^T; or begin with cos(theta) I as in (2.14).",
            {"rotation": _formula(np.ones_like, np.sin, _rest)},
        ),
        Mistake(
            "sine and cosine exchanged",
            "Sine and cosine have changed places: in (2.14) x itself has the cosine, u x x the sine.",
            {"rotation": _formula(np.sin, np.cos, lambda theta: 1.0 - np.sin(theta))},
        ),
        Mistake(
            "no part along the axis",
            "The last term of (2.14) is left out: lengths along the axis shrink by cos(theta), but R u = u.",
            {"rotation": _formula(np.cos, np.sin, np.zeros_like)},
        ),
        Mistake(
            "no part across",
            "The term with u x x of (2.14) is left out, or vanishes: nothing turns, lengths across the axis "
            "shrink. A product u * x by components is no cross product.",
            {"rotation": _formula(np.cos, np.zeros_like, _rest)},
        ),
        Mistake(
            "first order",
            "This is I + theta X, the beginning of the exponential series: good for tiny angles only. (2.14) "
            "has sin(theta) and 1 - cos(theta), and no more terms.",
            {"rotation": _formula(np.ones_like, lambda theta: theta, np.zeros_like)},
        ),
        Mistake(
            "second order",
            "This is I + theta X + theta^2 X^2 / 2, the beginning of the exponential series. The whole "
            "series has sin(theta) in place of theta, and 1 - cos(theta) in place of theta^2 / 2: (2.15).",
            {"rotation": _formula(lambda a: 1.0 - a * a / 2.0, lambda a: a, lambda a: a * a / 2.0)},
        ),
        Mistake(
            "the printed (A.1)",
            "The number u . x is added to every component: that is (A.1) as it is printed, which lacks a u "
            "behind it (see `lietool errata A.1`). The part along the axis is the vector (u . x) u, (2.14).",
            {"rotation": _printed},
        ),
    ),
)
