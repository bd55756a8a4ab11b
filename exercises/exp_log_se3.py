r"""The exponential map of rigid motions, and its inverse.

A twist is a rotation vector $\mathbf{x}$, axis times angle, and a translation part $\mathbf{l}$. With the
matrix $X$ of $\mathbf{x} \times$ and $\theta = |\mathbf{x}|$, its exponential is the rigid motion of the
rotation $R$ and the translation $\mathbf{d}$,

$$R = I + \frac{\sin\theta}{\theta} X + \frac{1 - \cos\theta}{\theta^2} X^2, \qquad
\mathbf{d} = \Bigl(I + \frac{1 - \cos\theta}{\theta^2} X + \frac{\theta - \sin\theta}{\theta^3} X^2\Bigr)
  \mathbf{l}, \qquad (7.4), (7.5)$$

a screw motion about an axis that need not pass the origin. Back from $R$ and $\mathbf{d}$ lead (corrected)

$$\cos\theta = \tfrac12 (\operatorname{tr} R - 1), \qquad
X = \frac{\theta}{2 \sin\theta} (R - R^T), \qquad (7.6), (7.7)$$

$$\mathbf{l} = \Bigl(I - \frac12 X
  + \frac{2 \sin\theta - (1 + \cos\theta)\,\theta}{2\theta^2 \sin\theta} X^2\Bigr) \mathbf{d}. \qquad (7.8)$$

Write two functions:

* `exp(twist)`: the homogeneous matrix, $R$ and $\mathbf{d}$ over the row 0 0 0 1, of a twist of any length;
* `log(T)`: the twist of a homogeneous matrix, with $0 \le \theta \le \pi$. At a half turn there are two:
  return either.

A twist is an array of six numbers, first $\mathbf{x}$, in radians, then $\mathbf{l}$. Both functions take
batches, `exp` of shape `(..., 6)` and `log` of shape `(..., 4, 4)`. At $\theta = 0$, for a translation, the
fractions have limits; near it they lose digits as they stand, and near $\theta = \pi$ so does (7.7).

The picture has a motion by more than half a turn: where the letter comes to rest, the way of the origin and
the turn are by your `exp`; the twist that comes back, dashed, is by your `log`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture, compare
from lietool.lie import se3


def exp(twist):
    """Return the rigid motions of twists.

    Parameters
    ----------
    twist : ndarray, shape (..., 6)
        Rotation vectors x (radians, of any length), then translation parts l.

    Returns
    -------
    T : ndarray, shape (..., 4, 4)
        Homogeneous matrices, for column vectors.
    """
    twist = np.asarray(twist, float)
    X, velocity = cross_matrix(twist[..., :3]), twist[..., 3:, None]
    theta = np.linalg.norm(twist[..., :3], axis=-1)[..., None, None]
    # sinc(t) = sin(pi t) / (pi t), and 1 at 0; 1 - cos t = 2 sin(t / 2)^2.
    a, b = np.sinc(theta / np.pi), 0.5 * np.sinc(0.5 * theta / np.pi) ** 2
    turned = theta > 1e-4
    c = np.where(turned, (1.0 - a) / np.where(turned, theta, 1.0) ** 2, 1.0 / 6.0)
    T = np.zeros((*twist.shape[:-1], 4, 4))
    T[..., :3, :3] = np.eye(3) + a * X + b * X @ X
    T[..., :3, 3:] = velocity + b * X @ velocity + c * X @ X @ velocity
    T[..., 3, 3] = 1.0
    return T


def log(T):
    """Return the twists of rigid motions.

    Parameters
    ----------
    T : ndarray, shape (..., 4, 4)
        Homogeneous matrices of rigid motions, for column vectors.

    Returns
    -------
    twist : ndarray, shape (..., 6)
        Rotation vectors x (radians, |x| <= pi), then translation parts l.
    """
    T = np.asarray(T, float)
    x, d = rotation_vector(T[..., :3, :3]), T[..., :3, 3:]
    X, half = cross_matrix(x), 0.5 * np.linalg.norm(x, axis=-1)[..., None, None]
    turned = half > 1e-4
    safe = np.where(turned, half, 1.0)
    # The last factor of (7.8) is (1 - (theta / 2) cot(theta / 2)) / theta^2.
    c = np.where(turned, (1.0 - safe * np.cos(safe) / np.sin(safe)) / (4.0 * safe**2), 1.0 / 12.0)
    velocity = d - 0.5 * X @ d + c * X @ X @ d
    return np.concatenate([x, velocity[..., 0]], axis=-1)


def cross_matrix(x):
    """Return the matrices X with X p = x cross p."""
    X = np.zeros((*x.shape, 3))
    for i, j, k in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        X[..., i, j], X[..., j, i] = x[..., k], -x[..., k]
    return X


def rotation_vector(R):
    """Return the principal logarithms of rotations, by their quaternions."""
    # Four times q q^T for the unit quaternion q, less the unit matrix.
    Q = np.zeros((*R.shape[:-2], 4, 4))
    trace = np.trace(R, axis1=-2, axis2=-1)[..., None, None]
    Q[..., :1, :1], Q[..., 1:, 1:] = trace, R + np.swapaxes(R, -1, -2) - trace * np.eye(3)
    for k, (i, j) in enumerate(((2, 1), (0, 2), (1, 0)), start=1):
        Q[..., 0, k] = Q[..., k, 0] = R[..., i, j] - R[..., j, i]
    q = np.linalg.eigh(Q)[1][..., -1]
    q = np.where(q[..., :1] < 0.0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    return 2.0 * np.arctan2(sine, q[..., :1]) / np.where(sine > 0.0, sine, 1.0) * q[..., 1:]


def _directions(rng, *shape):
    u = rng.normal(size=(*shape, 3))
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def _twists(rng, low, high=None, *shape):
    """Twists of angles in a range, or of one."""
    x = rng.uniform(low, low if high is None else high, (*shape, 1)) * _directions(rng, *shape)
    return np.concatenate([x, 2.0 * rng.normal(size=(*shape, 3))], axis=-1)


def _half_turn(rng):
    u = _directions(rng)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = 2.0 * np.outer(u, u) - np.eye(3), rng.normal(size=3)
    return T


def _apart(got, want):
    """Twists by their difference; at a half turn, where there are two, by their motions."""
    off = compare.apart(got, want)
    got, want = np.asarray(got, float), np.asarray(want, float)
    half = np.abs(np.linalg.norm(want[..., :3], axis=-1) - np.pi) < 1e-12
    if not half.any() or not np.isfinite(got[half]).all():
        return off
    rest = compare.apart(got[~half], want[~half]) if not half.all() else 0.0
    length = np.abs(np.linalg.norm(got[half][:, :3], axis=-1) - np.pi).max()
    return max(rest, float(length), compare.apart(se3.exp(got[half]), se3.exp(want[half])))


def _exp_ordinary(rng):
    yield Case("a quarter turn about z", (np.array([0.0, 0.0, np.pi / 2.0, 1.0, 0.0, 0.0]),), "exp")
    yield Case("a screw motion along x", (np.array([2.0, 0.0, 0.0, 3.0, 0.0, 0.0]),), "exp")
    yield Case("less than half a turn", (_twists(rng, 0.5, 2.8),), "exp")
    yield Case("more than half a turn", (_twists(rng, 3.5, 6.0),), "exp")


def _log_ordinary(rng):
    T = np.eye(4)[[1, 2, 0, 3]]
    T[:3, 3] = 1.0, 2.0, 3.0
    yield Case("a third of a turn about the diagonal", (T,), "log")
    for says, low, high in (
        ("a small angle", 0.2, 0.5),
        ("an angle about 1", 0.8, 1.4),
        ("a blunt one", 1.8, 2.6),
    ):
        yield Case(says, (se3.exp(_twists(rng, low, high)),), "log")


def _batches(rng):
    yield Case("five twists", (_twists(rng, 0.3, 2.8, 5),), "exp")
    yield Case("two rows of three motions", (se3.exp(_twists(rng, 0.3, 2.8, 2, 3)),), "log")
    yield Case("no twist at all", (np.zeros((0, 6)),), "exp")
    yield Case("no motion at all", (np.zeros((0, 4, 4)),), "log")


def _laws(f, rng):
    x = _twists(rng, 0.5, 1.2)
    s, t = rng.uniform(0.3, 1.2, 2)
    T = f.exp(x)
    yield Claim("log(exp(x, l)) = (x, l)", f.log(T), x, (x,))
    yield Claim("exp(log T) = T", f.exp(f.log(se3.exp(-x))), se3.exp(-x), (se3.exp(-x),))
    yield Claim(
        "exp(s x) exp(t x) = exp((s + t) x)", f.exp(s * x) @ f.exp(t * x), f.exp((s + t) * x), (x, s, t)
    )
    yield Claim("exp(-x, -l) is the inverse", f.exp(-x) @ T, np.eye(4), (x,))
    yield Claim("the advance along the axis: x . d = x . l", x[:3] @ T[:3, 3], x[:3] @ x[3:], (x,))


def _exp_hard(rng):
    yield Case("a translation, x = 0", (np.array([0.0, 0.0, 0.0, 1.0, -2.0, 3.0]),), "exp")
    yield Case("angle 1e-8", (_twists(rng, 1e-8),), "exp")
    yield Case("angle 1e-5", (_twists(rng, 1e-5),), "exp")
    yield Case("a full turn", (_twists(rng, 2.0 * np.pi),), "exp")
    yield Case("angle 40, more than six turns", (_twists(rng, 40.0),), "exp")
    mixed = np.stack([_twists(rng, 1.0), np.array([0.0, 0.0, 0.0, 1.0, 2.0, 3.0])])
    yield Case("a translation among others", (mixed,), "exp")


def _log_hard(rng):
    yield Case("no motion", (np.eye(4),), "log")
    yield Case("a translation", (se3.exp([0.0, 0.0, 0.0, 1.0, -2.0, 3.0]),), "log")
    yield Case("angle 1e-8", (se3.exp(_twists(rng, 1e-8)),), "log")
    yield Case("angle pi - 1e-4", (se3.exp(_twists(rng, np.pi - 1e-4)),), "log")
    yield Case("angle pi - 1e-9", (se3.exp(_twists(rng, np.pi - 1e-9)),), "log")
    yield Case("a half turn", (_half_turn(rng),), "log")


def _exponential(second, third):
    """A wrong `exp`: d = (I + second X + third X^2) l, with functions of the angle."""

    def wrong(twist):
        twist = np.asarray(twist, float)
        X, velocity = cross_matrix(twist[..., :3]), twist[..., 3:, None]
        theta = np.linalg.norm(twist[..., :3], axis=-1)[..., None, None]
        T = exp(twist)
        T[..., :3, 3:] = velocity + second(theta) * X @ velocity + third(theta) * X @ X @ velocity
        return T

    return {"exp": wrong}


def _second(theta):
    return 0.5 * np.sinc(0.5 * theta / np.pi) ** 2


def _turned_translation(twist):
    T = exp(twist)
    T[..., :3, 3:] = T[..., :3, :3] @ np.asarray(twist, float)[..., 3:, None]
    return T


def _exp_as_it_stands(twist):
    twist = np.asarray(twist, float)
    X, velocity = cross_matrix(twist[..., :3]), twist[..., 3:, None]
    theta = np.linalg.norm(twist[..., :3], axis=-1)[..., None, None]
    sin, cos = np.sin(theta), np.cos(theta)
    second, third = (1.0 - cos) / theta**2, (theta - sin) / theta**3
    T = np.zeros((*twist.shape[:-1], 4, 4))
    T[..., :3, :3] = np.eye(3) + sin / theta * X + second * (X @ X)
    T[..., :3, 3:] = velocity + second * (X @ velocity) + third * (X @ X @ velocity)
    T[..., 3, 3] = 1.0
    return T


def _log_as_it_stands(less, clipped):
    """(7.6) to (7.8), of the trace less a number."""

    def wrong(T):
        T = np.asarray(T, float)
        R, d = T[..., :3, :3], T[..., :3, 3:]
        cos = (np.trace(R, axis1=-2, axis2=-1) - less) / 2.0
        theta = np.arccos(np.clip(cos, -1.0, 1.0) if clipped else cos)[..., None, None]
        X = theta / (2.0 * np.sin(theta)) * (R - np.swapaxes(R, -1, -2))
        sin, cos = np.sin(theta), np.cos(theta)
        last = (2.0 * sin - (1.0 + cos) * theta) / (2.0 * theta**2 * sin)
        velocity = d - 0.5 * X @ d + last * X @ X @ d
        return np.stack(
            [X[..., 2, 1], X[..., 0, 2], X[..., 1, 0], *np.moveaxis(velocity[..., 0], -1, 0)], axis=-1
        )

    return {"log": wrong}


_OF_EXP = (
    Mistake(
        "d = R l",
        "d is R l here, a translation and then a rotation. In exp both go on together: (7.5).",
        {"exp": _turned_translation},
    ),
    Mistake(
        "last term missing", "The term with X^2 of (7.5) is missing.", _exponential(_second, np.zeros_like)
    ),
    Mistake(
        "0/0",
        "Right, but not near x = 0: the fractions of (7.4) and (7.5) lose their digits there, and at 0, for "
        "translations, they are 0/0. The limits are 1, 1/2 and 1/6; 1 - cos theta is 2 sin(theta/2)^2.",
        {"exp": _exp_as_it_stands},
    ),
)


def _of_log():
    yield Mistake(
        "of the inverse",
        "This is the twist of the inverse motion: (7.7) has R - R^T, not R^T - R, and (7.8) begins with d.",
        {"log": lambda T: -log(T)},
    )
    for clipped in (False, True):
        yield Mistake(
            "the printed (7.6)",
            "The angle is acos(tr(R) / 2): the printed (7.6), see `lietool errata 7.6`, or the right one "
            "with the trace of the 4 x 4 matrix. It is acos((tr(R) - 1) / 2), with the 3 x 3 part R.",
            _log_as_it_stands(0.0, clipped),
        )
        yield Mistake(
            "formulas as they stand",
            "Right, but not near 0 and pi: the arc cosine loses half of the digits, and (7.7) and (7.8) "
            "divide 0 by 0. Take x from the quaternion, and 1/12 for the last factor of (7.8) at 0.",
            _log_as_it_stands(1.0, clipped),
        )


EXERCISE = Exercise(
    number=10,
    title="The exponential map of rigid motions, and its inverse",
    equations=("7.4", "7.5", "7.6", "7.7", "7.8"),
    functions=(
        Function(
            "exp",
            library="lietool.lie.se3.exp",
            starter="return np.full((*np.shape(twist)[:-1], 4, 4), np.nan)",
            tolerance=1e-11,
        ),
        Function(
            "log",
            library="lietool.lie.se3.log",
            starter="return np.full((*np.shape(T)[:-2], 6), np.nan)",
            apart=_apart,
        ),
    ),
    checks=(
        Check("exp of ordinary twists", 2, cases=_exp_ordinary),
        Check("log of ordinary motions", 2, cases=_log_ordinary),
        Check("many at once", 1, cases=_batches),
        Check("laws of both together", 1, law=_laws),
        Check("exp: translations, tiny angles, full turns", 1, cases=_exp_hard),
        Check("log: translations, tiny angles, half turns", 1, cases=_log_hard),
    ),
    picture=Picture("B7.1b", 2, lambda f: {"exp": f.exp, "log": f.log}),
    mutants=("se3.exp", "se3.log"),
    mistakes=(*_OF_EXP, *_of_log()),
)
