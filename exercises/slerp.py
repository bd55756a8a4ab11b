r"""Spherical linear interpolation.

Two unit quaternions $q_0$, $q_1$ are points of a sphere, $\theta$ apart, where $\cos\theta = q_0 \cdot q_1$
is their inner product in $\mathbb{R}^4$. The point that has gone a part $t$ of the way from one to the other
along the great arc, at constant speed, is

$$\mathrm{slerp}(q_0, q_1, t) = \frac{\sin((1-t)\theta)}{\sin\theta}\,q_0
  + \frac{\sin(t\theta)}{\sin\theta}\,q_1. \qquad (2.32)$$

Write `slerp(q0, q1, t)`. Quaternions are arrays `(a, b, c, d)` of length 1, real part first; `t` is a number,
mostly from 0 to 1, but other numbers go on along the great circle. The arc is the one between the two
quaternions as they are given, $0 \le \theta < \pi$. Where $q_1 = q_0$ it is a point. Where $q_1 = -q_0$ no
arc is singled out: raise a `ValueError`, and do so for a quaternion that is not of length 1.

All three may be batches, `(..., 4)` and for `t` `(...)`, which go together as numpy broadcasts them.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture
from lietool.lie import quaternion as _quaternion


def slerp(q0, q1, t):
    """Return points of the great arc between unit quaternions.

    Parameters
    ----------
    q0, q1 : ndarray, shape (..., 4)
        Unit quaternions (a, b, c, d), real part first.
    t : float or ndarray, shape (...)
        Where on the arc: 0 at q0, 1 at q1.

    Returns
    -------
    ndarray, shape (..., 4)
        The unit quaternions (2.32).

    Raises
    ------
    ValueError
        If a quaternion is not of length 1 (to one part in a million), or q1 = -q0.
    """
    q0, q1, t = np.asarray(q0, float), np.asarray(q1, float), np.asarray(t, float)
    for q in (q0, q1):
        if not np.all(np.abs(np.linalg.norm(q, axis=-1) - 1.0) < 1e-6):
            raise ValueError("quaternions must have length 1")
    # Half of the angle between them is that of a right triangle; no arc cosine, which is blind near 0.
    chord, sum_ = np.linalg.norm(q1 - q0, axis=-1), np.linalg.norm(q1 + q0, axis=-1)
    if np.any(sum_ < 1e-12):
        raise ValueError("q1 = -q0: there is no single arc")
    theta = 2.0 * np.arctan2(chord, sum_)
    # Nearer than this the arc is its chord, and the quotients of (2.32) are 0 / 0 at last.
    near = theta < 1e-12
    sine = np.where(near, 1.0, np.sin(theta))
    first = np.where(near, 1.0 - t, np.sin((1.0 - t) * theta) / sine)
    second = np.where(near, t, np.sin(t * theta) / sine)
    return first[..., None] * q0 + second[..., None] * q1


_ONE, _I, _J, _K = np.eye(4)


def _unit(rng, *shape):
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def _apart(rng, theta):
    """Two unit quaternions at an angle of each other."""
    q0, other = _unit(rng, 2)
    across = other - (other @ q0) * q0
    return q0, np.cos(theta) * q0 + np.sin(theta) * across / np.linalg.norm(across)


def _ordinary(rng):
    yield Case("half of a right angle", (_ONE, _I, 0.5))
    yield Case("the start of an arc", (*_apart(rng, 1.0), 0.0))
    yield Case("the end of an arc", (*_apart(rng, 1.0), 1.0))
    yield Case("an arc of 1, a third of it", (*_apart(rng, 1.0), 1.0 / 3.0))
    yield Case("an arc longer than a right angle", (*_apart(rng, 2.2), 0.3))
    yield Case("an arc of 0.4", (*_apart(rng, 0.4), rng.uniform(0.6, 0.9)))


def _batches(rng):
    yield Case("one arc at five times", (*_apart(rng, 1.3), np.linspace(0.0, 1.0, 5)))
    q0, q1 = (np.stack(q) for q in zip(*(_apart(rng, theta) for theta in (0.3, 1.4, 2.5)), strict=True))
    yield Case("three arcs, each at its own time", (q0, q1, rng.uniform(0.1, 0.9, 3)))
    yield Case("three arcs, each at two times", (q0[:, None], q1[:, None], rng.uniform(0.1, 0.9, (3, 2))))


def _laws(f, rng):
    theta, t = rng.uniform(0.5, 2.5), rng.uniform(0.2, 0.8)
    q0, q1 = _apart(rng, theta)
    whole = _quaternion.multiply(q1, _quaternion.conjugate(q0))
    yield Claim("it is a unit quaternion", np.linalg.norm(f.slerp(q0, q1, t)), 1.0, (q0, q1, t))
    moved = _quaternion.multiply(f.slerp(_ONE, whole, t), q0)
    yield Claim("slerp(q0, q1, t) = slerp(1, q1 q0^-1, t) q0, (2.33)", f.slerp(q0, q1, t), moved, (q0, q1, t))
    u = rng.normal(size=3)
    u /= np.linalg.norm(u)
    wanted = _quaternion.exp(t * theta * u)
    got = f.slerp(_ONE, _quaternion.exp(theta * u), t)
    yield Claim("slerp(1, exp(theta u), t) = exp(t theta u), (2.34)", got, wanted, (theta, u, t))
    steps = np.array([f.slerp(q0, q1, s) for s in (0.0, 0.25, 0.5, 0.75, 1.0)])
    cosines = np.sum(steps[1:] * steps[:-1], axis=-1)
    yield Claim("a quarter of t is a quarter of theta", cosines, np.full(4, np.cos(theta / 4.0)), (q0, q1))


def _hard(rng):
    half = np.full(4, 0.5)
    yield Case("theta = 0: both are the same", (half, half, 0.3))
    yield Case("theta = 1e-8", (_ONE, np.array([1.0, 1e-8, 0.0, 0.0]), 0.3))
    yield Case("theta = 0.02", (*_apart(rng, 0.02), 0.3))
    yield Case("theta = pi - 0.01", (*_apart(rng, np.pi - 0.01), 0.4))
    yield Case("t = 1.5, behind the end", (*_apart(rng, 1.2), 1.5))


def _bad(rng):
    q = _unit(rng)
    yield Case("q1 = -q0", (q, -q, 0.5), raises=True)
    yield Case("a quaternion of length 2", (2.0 * q, _unit(rng), 0.5), raises=True)
    yield Case("a batch with one q1 = -q0", (np.stack([_ONE, _I]), np.stack([_J, -_I]), 0.5), raises=True)


def _wrong(weights, guarded=True, flipped=False):
    """Return a wrong interpolation: weights(theta, t) of both ends.

    A guarded one goes over to the chord where the quotients are 0 / 0; who forgets that gets nan there.
    """

    def wrong(q0, q1, t):
        q0, q1, t = np.asarray(q0, float), np.asarray(q1, float), np.asarray(t, float)
        cosine = np.sum(q0 * q1, axis=-1)
        if flipped:
            q1, cosine = np.where(cosine < 0.0, -1.0, 1.0)[..., None] * q1, np.abs(cosine)
        first, second = weights(np.arccos(np.clip(cosine, -1.0, 1.0)), t)
        if guarded:
            first, second = (
                np.where(cosine >= 1.0, chord, x) for chord, x in ((1.0 - t, first), (t, second))
            )
        return first[..., None] * q0 + second[..., None] * q1

    return wrong


def _shoemake(theta, t):
    return np.sin((1.0 - t) * theta) / np.sin(theta), np.sin(t * theta) / np.sin(theta)


def _undivided(theta, t):
    return np.sin((1.0 - t) * theta), np.sin(t * theta)


def _near_the_chord(q0, q1, t):
    """Return the interpolation with the chord for small angles."""
    cosine = np.sum(np.asarray(q0) * q1, axis=-1)[..., None]
    t = np.asarray(t, float)
    chord = (1.0 - t)[..., None] * q0 + t[..., None] * q1
    return np.where(cosine > 0.9995, chord / np.linalg.norm(chord, axis=-1, keepdims=True), slerp(q0, q1, t))


def _mistakes(name, says, weights, flipped=False):
    """Return a mistake twice: with and without care for q1 = q0."""
    return [
        Mistake(f"{name}{more}", says, {"slerp": _wrong(weights, guarded, flipped)})
        for more, guarded in (("", True), (", 0 / 0", False))
    ]


def _shown(f):
    """Return what the figure takes; one call for each time, for who has written it for one."""
    return {"interpolate": lambda q0, q1, t: np.stack([f.slerp(q0, q1, float(x)) for x in t])}


EXERCISE = Exercise(
    number=4,
    title="Spherical linear interpolation",
    equations=("2.32", "2.33", "2.34"),
    functions=(
        Function(
            "slerp",
            library="lietool.lie.quaternion.slerp",
            starter="return np.full((*np.broadcast_shapes(np.shape(q0)[:-1], np.shape(t)), 4), np.nan)",
        ),
    ),
    checks=(
        Check("ordinary arcs", 2, cases=_ordinary),
        Check("batches", 1, cases=_batches),
        Check("(2.33), (2.34) and constant speed", 2, law=_laws),
        Check("hard inputs", 1, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("B2.8", 3, _shown),
    mutants=("slerp:",),
    mistakes=(
        Mistake(
            "chord for small angles",
            "Near q0 it goes over to the chord, where theta is not yet small enough for that: (2.32) itself "
            "is good until theta is lost in rounding, below 1e-8 or so.",
            {"slerp": _near_the_chord},
        ),
        Mistake(
            "nan at q0",
            "Right but where q1 = q0, or nearly so: there (2.32) is 0 / 0. The limit of both quotients is "
            "1 - t and t.",
            {"slerp": _wrong(_shoemake, guarded=False)},
        ),
        *_mistakes(
            "shorter way",
            "Where q0 . q1 < 0 it goes to -q1. That is the shorter way between the two rotations, and often "
            "wanted; but (2.32) is the arc between the quaternions as they are given.",
            _shoemake,
            flipped=True,
        ),
        *_mistakes(
            "lerp",
            "This is the chord, (1 - t) q0 + t q1, which runs inside the sphere: these are no unit "
            "quaternions. The weights of (2.32) are quotients of sines.",
            lambda theta, t: (1.0 - t + 0.0 * theta, t + 0.0 * theta),
        )[:1],
        *_mistakes(
            "not divided",
            "The weights are not divided by sin(theta): at t = 0 (2.32) is q0 itself.",
            _undivided,
        ),
        *_mistakes(
            "angle of the rotation",
            "The angle is taken twice: cos(theta) = q0 . q1 is the angle between the quaternions, half "
            "of the angle between the rotations, and (2.32) wants that one.",
            lambda theta, t: _shoemake(2.0 * theta, t),
        ),
        *_mistakes(
            "half of the angle",
            "The angle is halved: (2.32) wants theta itself, cos(theta) = q0 . q1; (2.26) has the half.",
            lambda theta, t: _shoemake(0.5 * theta, t),
        ),
        *_mistakes(
            "weights exchanged",
            "The weights have changed places, so that it begins at q1: q0 has the sine of (1 - t) theta.",
            lambda theta, t: _shoemake(theta, 1.0 - t),
        ),
    ),
)
