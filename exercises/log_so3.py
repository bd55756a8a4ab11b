r"""The logarithm of rotations, everywhere.

Every rotation is $R = \exp(X)$ with a skew-symmetric $X$, the matrix $X \mathbf{p} = \mathbf{x} \times
\mathbf{p}$ of a vector $\mathbf{x}$: the axis of $R$ times its angle $\theta = |\mathbf{x}|$. The principal
logarithm is that with $0 \le \theta \le \pi$. Corrected, (7.6) and (7.7) say

$$\cos\theta = \tfrac12 (\operatorname{tr} R - 1), \qquad (7.6)$$

$$X = \frac{\theta}{2 \sin\theta}\,(R - R^T) , \qquad (7.7)$$

and this is enough far from $\theta = 0$ and from $\theta = \pi$. Near both $\sin\theta$ and the arc cosine
lose digits, and at $\theta = \pi$ nothing is left of $R - R^T$. Find $\mathbf{x}$ there in another way: from
the unit quaternion of $R$, for one, of which at least one of the four components is not small.

Write `log(R)`, which returns $\mathbf{x}$. It should have nine digits right for all rotations, also where
$\theta$ is tiny (relative to $\theta$) or short of $\pi$ by very little. At a half turn, $\theta = \pi$,
$\mathbf{x}$ and $-\mathbf{x}$ are both right: return either.

Matrices act on column vectors, angles are in radians. Rotations come in batches of shape `(..., 3, 3)`, of
different angles, and give vectors of shape `(..., 3)`.

The picture has the logarithms of two paths of rotations, as curves in space, by your function.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture, compare


def log(R):
    """Return the principal logarithms of rotations.

    Parameters
    ----------
    R : ndarray, shape (..., 3, 3)
        Rotations, for column vectors.

    Returns
    -------
    x : ndarray, shape (..., 3)
        Axis times angle, radians, |x| <= pi.
    """
    R = np.asarray(R, float)
    # Four times the products of the components of the quaternion (w, x, y, z), a row for each of them.
    Q = np.empty((*R.shape[:-2], 4, 4))
    Q[..., 1:, 1:] = R + np.swapaxes(R, -1, -2)
    for k, (i, j) in enumerate(((2, 1), (0, 2), (1, 0)), start=1):
        Q[..., 0, k] = Q[..., k, 0] = R[..., i, j] - R[..., j, i]
    a, b, c = np.moveaxis(np.diagonal(R, axis1=-2, axis2=-1), -1, 0)
    squares = np.stack([1.0 + a + b + c, 1.0 + a - b - c, 1.0 - a + b - c, 1.0 - a - b + c], axis=-1)
    Q[..., range(4), range(4)] = squares
    # The row of the largest component has no small divisor.
    row = np.argmax(squares, axis=-1)[..., None, None]
    q = np.take_along_axis(Q, row, axis=-2)[..., 0, :]
    q = np.where(q[..., :1] < 0.0, -q, q)
    w, v = q[..., 0], q[..., 1:]
    length = np.linalg.norm(v, axis=-1)
    turned = length > 0.0
    angle = 2.0 * np.arctan2(length, w)
    return np.where(turned, angle / np.where(turned, length, 1.0), 0.0)[..., None] * v


def _matrix(x):
    """The rotations about x by |x|."""
    x = np.asarray(x, float)
    theta = np.linalg.norm(x, axis=-1)[..., None, None]
    X = np.zeros((*x.shape, 3))
    for i, j, k in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        X[..., i, j], X[..., j, i] = x[..., k], -x[..., k]
    return np.eye(3) + np.sinc(theta / np.pi) * X + 0.5 * np.sinc(0.5 * theta / np.pi) ** 2 * (X @ X)


def _half_turn(u):
    """The rotation by pi about a unit vector, symmetric to the last digit."""
    return 2.0 * np.multiply.outer(u, u) - np.eye(3)


def _directions(rng, *shape):
    u = rng.normal(size=(*shape, 3))
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def _of_angle(rng, low, high, *shape):
    return _matrix(rng.uniform(low, high, (*shape, 1)) * _directions(rng, *shape))


def _apart(got, want):
    """The largest distance relative to the angle; at a half turn either sign will do."""
    compare.apart(got, want)
    got, want = np.asarray(got, float), np.asarray(want, float)
    if not want.size:
        return 0.0
    angle = np.linalg.norm(want, axis=-1)
    off = np.linalg.norm(got - want, axis=-1)
    either = np.fmin(off, np.linalg.norm(got + want, axis=-1))
    off = np.where(np.abs(angle - np.pi) < 1e-12, either, off)
    # Two that are nan in the same places are the same wrong result.
    blank = np.isnan(got).all(axis=-1) & np.isnan(want).all(axis=-1)
    return float(np.max(np.where(blank, 0.0, off / np.maximum(angle, 1e-8))))


def _ordinary(rng):
    yield Case("a quarter turn about z", (np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),))
    yield Case("a third of a turn about the diagonal", (np.eye(3)[[2, 0, 1]],))
    for says, low, high in (
        ("a small angle", 0.2, 0.5),
        ("an angle about 1", 0.8, 1.4),
        ("a blunt angle", 1.8, 2.6),
    ):
        yield Case(says, (_of_angle(rng, low, high),))


def _batches(rng):
    yield Case("six of different angles", (_of_angle(rng, 0.3, 2.8, 6),))
    yield Case("two rows of three", (_of_angle(rng, 0.3, 2.8, 2, 3),))
    yield Case("none at all", (np.zeros((0, 3, 3)),))


def _laws(f, rng):
    u = _directions(rng)
    s, t = rng.uniform(0.3, 1.2, 2)
    R, Q = _matrix(s * u), _of_angle(rng, 0.5, 2.5)
    x = f.log(R)
    yield Claim("exp(log R) = R", _matrix(x), R, (R,))
    yield Claim("the axis stays: R x = x", R @ x, x, (R,))
    yield Claim("log R^T = -log R", f.log(R.T), -x, (R,))
    yield Claim("log(Q R Q^T) = Q log R", f.log(Q @ R @ Q.T), Q @ x, (R, Q))
    yield Claim("turns about one axis add up", f.log(_matrix(t * u) @ R), (s + t) * u, (s * u, t * u))


def _near_identity(rng):
    yield Case("the identity", (np.eye(3),))
    yield Case("angle 1e-4", (_matrix(1e-4 * _directions(rng)),))
    yield Case("angle 1e-9", (_matrix(1e-9 * _directions(rng)),))
    many = np.stack([np.eye(3), _of_angle(rng, 0.5, 2.0), _matrix(1e-6 * _directions(rng))])
    yield Case("the identity among others", (many,))


def _near_half_turns(rng):
    yield Case("a half turn about x", (np.diag([1.0, -1.0, -1.0]),))
    yield Case("a half turn about z", (np.diag([-1.0, -1.0, 1.0]),))
    yield Case("a half turn about some axis", (_half_turn(_directions(rng)),))
    yield Case("angle pi - 1e-4", (_matrix((np.pi - 1e-4) * _directions(rng)),))
    yield Case("angle pi - 1e-9", (_matrix((np.pi - 1e-9) * _directions(rng)),))
    yield Case("angle pi - 1e-6 about -x", (_matrix(np.array([1e-6 - np.pi, 0.0, 0.0])),))
    yield Case(
        "half turns among others", (np.stack([_half_turn(_directions(rng)), _of_angle(rng, 1.0, 2.0)]),)
    )


def _across(R):
    """The vector of R - R^T: the axis times 2 sin theta."""
    return np.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], axis=-1
    )


def _by_trace(cosine, clipped, zero=False):
    """(7.7) with an angle by the arc cosine of a function of the trace."""

    def wrong(R):
        R = np.asarray(R, float)
        cos = cosine(R[..., 0, 0] + R[..., 1, 1] + R[..., 2, 2])
        theta = np.arccos(np.clip(cos, -1.0, 1.0) if clipped else cos)
        x = (theta / (2.0 * np.sin(theta)))[..., None] * _across(R)
        return np.where(theta[..., None] == 0.0, 0.0, x) if zero else x

    return wrong


def _printed(trace):
    return trace / 2.0


def _corrected(trace):
    return (trace - 1.0) / 2.0


def _by_tangent(R):
    """(7.7) with an angle by the arc tangent, and no axis where R - R^T vanishes."""
    R = np.asarray(R, float)
    v = 0.5 * _across(R)
    sine = _angle(v)
    theta = np.arctan2(sine, _corrected(np.trace(R, axis1=-2, axis2=-1))[..., None])
    return np.where(sine > 0.0, theta / np.where(sine > 0.0, sine, 1.0), 0.0) * v


# The right function, and what is right but near 0 and pi: of these many other mistakes are variations.
_BASES = (
    log,
    _by_tangent,
    *(_by_trace(_corrected, clipped, zero) for clipped in (False, True) for zero in (False, True)),
)


def _angle(x):
    return np.linalg.norm(x, axis=-1, keepdims=True)


def _mistakes():
    for clipped in (False, True):
        for zero in (False, True):
            yield Mistake(
                "the printed (7.6)",
                "The angle is acos(tr(R) / 2), the printed (7.6), which is wrong already for R = I: it is "
                "acos((tr(R) - 1) / 2), see `lietool errata 7.6`.",
                {"log": _by_trace(_printed, clipped, zero)},
            )
            yield Mistake(
                "arc cosine and sine",
                "Right, but not near 0 and pi: the arc cosine loses half of the digits, and (7.7) divides 0 "
                "by 0. Take the angle by atan2 of a sine and a cosine, and near pi the axis from R + R^T, or "
                "both from the quaternion.",
                {"log": _by_trace(_corrected, clipped, zero)},
            )
    yield Mistake(
        "no axis at half turns",
        "Right but for half turns, where R - R^T vanishes and (7.7) has no axis, and very near them, where "
        "it has lost its digits: there the axis is in R + R^T, or take it from the quaternion.",
        {"log": _by_tangent},
    )
    variations = (
        (
            "transposed",
            "This is the logarithm of R^T: X is transposed. With X p = x x p the third component of x is the "
            "entry of X in the second row and the first column.",
            lambda x: -x,
        ),
        ("twice as long", "x is twice too long: (7.7) divides R - R^T by 2 sin(theta).", lambda x: 2.0 * x),
        (
            "half of the angle",
            "x is half as long as it should be: the angle of a quaternion is half of that of its rotation.",
            lambda x: 0.5 * x,
        ),
        (
            "the sine for the angle",
            "This is the vector of (R - R^T) / 2, of length sin(theta); (7.7) makes that theta.",
            lambda x: np.sinc(_angle(x) / np.pi) * x,
        ),
        (
            "the axis only",
            "This is the axis, of length 1: it is to be multiplied by the angle.",
            lambda x: x / _angle(x),
        ),
        ("degrees", "The angle is given in degrees: x is in radians.", np.rad2deg),
        (
            "arc sine",
            "The angle is an arc sine, which is at most pi / 2: blunt angles come out as the acute ones with "
            "the same sine. Take atan2 of the sine and the cosine, (7.6).",
            lambda x: np.arcsin(np.sin(_angle(x))) * x / _angle(x),
        ),
    )
    for name, says, change in variations:
        for base in _BASES:
            yield Mistake(name, says, {"log": lambda R, change=change, base=base: change(base(R))})


EXERCISE = Exercise(
    number=9,
    title="The logarithm of rotations",
    equations=("7.6", "7.7"),
    functions=(
        Function(
            "log",
            library="lietool.lie.so3.log",
            starter="return np.full(np.shape(R)[:-1], np.nan)",
            apart=_apart,
        ),
    ),
    checks=(
        Check("ordinary angles", 2, cases=_ordinary),
        Check("many at once", 1, cases=_batches),
        Check("laws of the logarithm", 1, law=_laws),
        Check("the identity and near it", 1, cases=_near_identity),
        Check("half turns and near them", 2, cases=_near_half_turns),
    ),
    picture=Picture("B4.2b", 3, lambda f: {"log": f.log}),
    mistakes=tuple(_mistakes()),
)
