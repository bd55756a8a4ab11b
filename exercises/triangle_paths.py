r"""Two ways from a triangle to another.

A map $A$ of the plane with $\det A > 0$, the linear part of the map between two triangles, is to be reached
from the identity: $A(t)$ with $A(0) = I$ and $A(1) = A$. By (3.11) there are a rotation and a stretch in it,

$$A = R\,S, \qquad R = R_\theta = \begin{pmatrix} \cos\theta & -\sin\theta \\ \sin\theta & \cos\theta
  \end{pmatrix}, \qquad S = S^T \text{ positive definite}.$$

The angle of $R$ is defined up to full turns; which one is meant is given. Section 5.2 has two ways that keep
rotation and stretch apart. Both turn evenly; the stretch goes on a straight line, or its logarithm does:

$$A^P(t) = R_{t\theta}\,\big((1 - t)\,I + t\,S\big), \qquad
  A^E(t) = R_{t\theta}\,S^t = R_{t\theta}\,\exp(t \log S).$$

Write both, `arap(A, t, theta)` and `logexp(A, t, theta)`. Here $\log S$ is the symmetric matrix whose
exponential is $S$: the axes of $S$, and the logarithms of the stretches along them.

`A` may be a batch, of shape `(..., 2, 2)`, with angles of shape `(...)`, and `t` an array of any shape: the
result is for all times and all matrices, of shape `(*t.shape, *A.shape)`. The time is any number, also
before 0 and after 1. A matrix whose determinant is not positive is refused with a `ValueError`, and so is
an angle that is not that of $A$, nor differs from it by full turns.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def arap(A, t, theta):
    """Return A^P(t), with the stretch on a straight line.

    Parameters
    ----------
    A : ndarray, shape (..., 2, 2)
        Matrices with positive determinants.
    t : float or ndarray
        Times.
    theta : float or ndarray, shape (...)
        Angles in radians: A = R_theta S.

    Returns
    -------
    ndarray, shape (*t.shape, ..., 2, 2)
        A^P(t) of each matrix at each time.

    Raises
    ------
    ValueError
        If det A <= 0, or theta is not the angle of A but for full turns (to one part in a million).
    """
    S = stretch(A, theta)
    t = np.asarray(t, float).reshape(*np.shape(t), *(1,) * S.ndim)
    return rotation(t[..., 0, 0] * theta) @ ((1.0 - t) * np.eye(2) + t * S)


def logexp(A, t, theta):
    """Return A^E(t), with the logarithm of the stretch on a straight line.

    Parameters
    ----------
    A : ndarray, shape (..., 2, 2)
        Matrices with positive determinants.
    t : float or ndarray
        Times.
    theta : float or ndarray, shape (...)
        Angles in radians: A = R_theta S.

    Returns
    -------
    ndarray, shape (*t.shape, ..., 2, 2)
        A^E(t) of each matrix at each time.

    Raises
    ------
    ValueError
        If det A <= 0, or theta is not the angle of A but for full turns (to one part in a million).
    """
    S = stretch(A, theta)
    t = np.asarray(t, float).reshape(*np.shape(t), *(1,) * S.ndim)
    sizes, axes = np.linalg.eigh(S)
    powers = axes * sizes[..., None, :] ** t @ np.swapaxes(axes, -1, -2)
    return rotation(t[..., 0, 0] * theta) @ powers


def rotation(theta):
    """Return R_theta, shape (..., 2, 2)."""
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)


def stretch(A, theta):
    """Return the S of A = R_theta S; ValueError if there is none that is positive definite."""
    A = np.asarray(A, float)
    if not np.all(np.linalg.det(A) > 0.0):
        raise ValueError("det A must be positive")
    S = np.swapaxes(rotation(theta), -1, -2) @ A
    # With det S > 0 it is positive definite where its trace is positive.
    trace, skew = S[..., 0, 0] + S[..., 1, 1], S[..., 1, 0] - S[..., 0, 1]
    if np.any(np.abs(skew) > 1e-6 * trace):
        raise ValueError("theta must be the angle of the rotation in A")
    return (S + np.swapaxes(S, -1, -2)) / 2.0


_HALF = np.array([[-1.8, 0.35], [0.85, -0.7]])
_TIMES = np.array([0.0, 0.25, 0.5, 1.0])


def _maps(rng, *shape, most=1.0):
    """Matrices with positive determinants, and the angles of their rotations."""
    theta, phi = rng.uniform(-3.0, 3.0, shape), rng.uniform(0.0, np.pi, shape)
    axes = rotation(phi)
    sizes = np.exp(rng.uniform(-most, most, (*shape, 2)))
    A = rotation(theta) @ (axes * sizes[..., None, :]) @ np.swapaxes(axes, -1, -2)
    return A, theta if shape else float(theta)


def _angle(A):
    return float(np.arctan2(A[1, 0] - A[0, 1], A[0, 0] + A[1, 1]))


def _ordinary(name):
    def cases(rng):
        yield Case("half way to the map of figure 5.6", (_HALF, 0.5, _angle(_HALF)), name)
        yield Case("a third of the way to a stretch", (np.array([[2.0, 0.6], [0.6, 0.9]]), 1 / 3, 0.0), name)
        yield Case("two thirds of a quarter turn", (rotation(np.pi / 2.0), 2.0 / 3.0, np.pi / 2.0), name)
        for _ in range(3):
            A, theta = _maps(rng)
            yield Case("some map and time", (A, rng.uniform(0.1, 0.9), theta), name)

    return cases


def _batches(rng):
    for name in ("arap", "logexp"):
        A, theta = _maps(rng)
        yield Case("one map and four times", (A, _TIMES, theta), name)
        A, theta = _maps(rng, 3)
        yield Case("three maps and one time", (A, 0.4, theta), name)
        yield Case("three maps, each at two by two times", (A, _TIMES.reshape(2, 2), theta), name)


def _laws(f, rng):
    A, theta = _maps(rng)
    s, t = rng.uniform(0.2, 0.8, 2)
    for name, way in (("A^P", f.arap), ("A^E", f.logexp)):
        yield Claim(f"{name}(0) = I", way(A, 0.0, theta), np.eye(2), (A, theta))
        yield Claim(f"{name}(1) = A", way(A, 1.0, theta), A, (A, theta))
    now = f.logexp(A, t, theta)
    yield Claim("det A^E(t) = (det A)^t", np.linalg.det(now), np.linalg.det(A) ** t, (A, t, theta))
    again = f.logexp(now, s, t * theta)
    yield Claim("A^E(s) of A^E(t) is A^E(s t)", again, f.logexp(A, s * t, theta), (A, s, t, theta))
    S = np.array([[1.4, -0.3], [-0.3, 0.8]])
    halves = [f.logexp(S, part, 0.0) for part in (t, 1.0 - t)]
    yield Claim("of a stretch, S^t S^(1 - t) = S", halves[0] @ halves[1], S, (S, t))


def _hard(rng):
    beyond = np.array([-0.6, 1.7])
    for name in ("arap", "logexp"):
        A, theta = _maps(rng)
        yield Case("before 0 and after 1", (A, beyond, theta), name)
        yield Case("with two full turns more", (A, _TIMES, theta + 4.0 * np.pi), name)
        yield Case("with a full turn less", (A, 0.3, theta - 2.0 * np.pi), name)
        yield Case("equal stretches along all axes", (3.0 * rotation(1.0), 0.5, 1.0), name)
        yield Case("half a turn", (-np.eye(2), 0.25, np.pi), name)
        long = rotation(0.7) @ np.diag([1e5, 1e-3])
        yield Case("stretches 1e5 and 1e-3", (long, 0.5, 0.7), name)
        yield Case("the identity", (np.eye(2), _TIMES, 0.0), name)
        yield Case("whole numbers", (np.array([[2, 0], [0, 1]]), 1, 0), name)


def _bad(rng):
    A, theta = _maps(rng)
    for name in ("arap", "logexp"):
        yield Case("a mirror image, det A = -1", (np.diag([1.0, -1.0]), 0.5, 0.0), name, raises=True)
        yield Case("a map onto a line, det A = 0", (np.diag([1.0, 0.0]), 0.5, 0.0), name, raises=True)
        yield Case("an angle that is not that of A", (A, 0.5, theta + 0.01), name, raises=True)
        yield Case("an angle off by half a turn", (A, 0.5, theta + np.pi), name, raises=True)


def _made(turned, stretched):
    """Return a wrong way: R(turned) times a function of S, t and A."""

    def wrong(A, t, theta):
        S = stretch(A, theta)
        t = np.asarray(t, float).reshape(*np.shape(t), *(1,) * S.ndim)
        return rotation(turned(t[..., 0, 0], theta)) @ stretched(S, t, np.asarray(A, float))

    return wrong


def _evenly(t, theta):
    return t * theta


def _not(t, theta):
    return 0.0 * t * theta


def _function(S, of):
    """Return the function of a symmetric matrix that takes its eigenvalues so."""
    sizes, axes = np.linalg.eigh(S)
    with np.errstate(all="ignore"):
        return axes * of(sizes)[..., None, :] @ np.swapaxes(axes, -1, -2)


def _line(S, t, A):
    return (1.0 - t) * np.eye(2) + t * S


def _power(S, t, A):
    sizes, axes = np.linalg.eigh(S)
    return axes * sizes[..., None, :] ** t @ np.swapaxes(axes, -1, -2)


def _straight(S, t, A):
    return (1.0 - t) * np.eye(2) + t * A


def _without_log(S, t, A):
    sizes, axes = np.linalg.eigh(S)
    return axes * np.exp(t * sizes[..., None, :]) @ np.swapaxes(axes, -1, -2)


def _first_order(S, t, A):
    return np.eye(2) + t * _function(S, np.log)


def _entries(S, t, A):
    with np.errstate(all="ignore"):
        return np.abs(S) ** t * np.sign(S)


def _degrees(t, theta):
    return np.deg2rad(t * theta)


_BOTH = ("arap", "logexp")
EXERCISE = Exercise(
    number=12,
    title="Two ways from a triangle to another",
    equations=("3.11",),
    functions=(
        Function(
            "arap",
            library="lietool.interp.triangle.arap",
            starter="return np.full((*np.shape(t), *np.shape(A)), np.nan)",
        ),
        Function(
            "logexp",
            library="lietool.interp.triangle.logexp",
            starter="return np.full((*np.shape(t), *np.shape(A)), np.nan)",
        ),
    ),
    checks=(
        Check("A^P at ordinary times", 1, cases=_ordinary("arap")),
        Check("A^E at ordinary times", 2, cases=_ordinary("logexp")),
        Check("batches", 1, cases=_batches),
        Check("laws of both ways", 1, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B5.6b", 3, lambda f: {"arap": f.arap, "logexp": f.logexp}),
    mutants=("triangle.arap", "triangle.logexp"),
    mistakes=(
        Mistake(
            "A^E for A^P",
            "This is A^E, where the logarithm of S goes straight. In A^P it is S itself: (1 - t) I + t S.",
            {"arap": _made(_evenly, _power)},
        ),
        Mistake(
            "A^P for A^E",
            "This is A^P, where S goes on a straight line. In A^E its logarithm does: S^t = exp(t log S), "
            "with the powers of the stretches along the axes of S.",
            {"logexp": _made(_evenly, _line)},
        ),
        *(
            Mistake(
                f"{name}: straight line",
                "This is A^L = (1 - t) I + t A, the straight line of matrices, on which a triangle may "
                "collapse. A = R S is to be taken apart first, (3.11), and R to be turned by t theta.",
                {name: _made(_not, _straight)},
            )
            for name in _BOTH
        ),
        Mistake(
            "arap: A for S",
            "The rotation is in it twice: R(t theta) stands before (1 - t) I + t A, but it should be S "
            "there, which is A without its rotation, S = R^T A.",
            {"arap": _made(_evenly, _straight)},
        ),
        *(
            Mistake(
                f"{name}: stretch without rotation",
                "It never turns: the rotation by t theta is left out.",
                {name: _made(_not, way)},
            )
            for name, way in zip(_BOTH, (_line, _power), strict=True)
        ),
        *(
            Mistake(
                f"{name}: degrees",
                "The angle is taken for degrees; theta is in radians.",
                {name: _made(_degrees, way)},
            )
            for name, way in zip(_BOTH, (_line, _power), strict=True)
        ),
        Mistake(
            "logexp: no logarithm",
            "This is R(t theta) exp(t S): the logarithm is missing. At t = 0 that is I, but at t = 1 it is "
            "not A; exp(t log S) is wanted.",
            {"logexp": _made(_evenly, _without_log)},
        ),
        Mistake(
            "logexp: I + t log S",
            "This is I + t log S, the beginning of the exponential series. exp(t log S) has the powers of "
            "the stretches along the axes of S.",
            {"logexp": _made(_evenly, _first_order)},
        ),
        Mistake(
            "logexp: powers of entries",
            "The entries of S are raised to the power t. The power of a matrix is that of its eigenvalues: "
            "S = Q D Q^T gives S^t = Q D^t Q^T.",
            {"logexp": _made(_evenly, _entries)},
        ),
    ),
)
