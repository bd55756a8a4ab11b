"""Motions of the plane as unit dual complex numbers.

A dual complex number is $p = p_0 + p_1 \\varepsilon$ with complex $p_0, p_1$ and $\\varepsilon^2 = 0$. The
dual unit does not commute with complex numbers: what passes it is conjugated, $\\varepsilon z = \\bar z
\\varepsilon$. So (2.38) is

$$(p_0 + p_1 \\varepsilon)(q_0 + q_1 \\varepsilon) = p_0 q_0 + (p_1 \\bar q_0 + p_0 q_1)\\, \\varepsilon .$$

With $|p_0| = 1$ it is a unit one and moves the points $v$ of the plane, as complex numbers, by

$$v \\mapsto p_0^2\\, v + 2 p_0 p_1 .$$

Write three functions:

* `motion(theta, b)`: a unit dual complex number of the motion that first turns the plane by `theta` radians
  about the origin and then shifts it by `b`. Two numbers do this, $p$ and $-p$: return either.
* `multiply(p, q)`: the product (2.38).
* `act(p, v)`: where a unit dual complex number takes points.

A dual complex number is an array of four real numbers, (re p0, im p0, re p1, im p1), in its last axis; a
point or a shift is an array (x, y). All functions take many at once: whatever axes come before, of one
argument or of both, go together as numpy's broadcasting says.

The picture has a shape turned and shifted, and shifted and turned. Every place of it comes from your three
functions.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture, compare


def motion(theta, b):
    """Return a unit dual complex number of a turn and then a shift.

    Parameters
    ----------
    theta : float or ndarray, shape (...)
        The angle of the turn about the origin, radians; any size.
    b : ndarray, shape (..., 2)
        The shift.

    Returns
    -------
    p : ndarray, shape (..., 4)
        re p0, im p0, re p1, im p1.
    """
    theta, b = np.asarray(theta, dtype=float), np.asarray(b, dtype=float)
    p0 = np.exp(0.5j * theta)
    p1 = 0.5 * (b[..., 0] + 1j * b[..., 1]) * np.conj(p0)
    p0 = np.broadcast_to(p0, p1.shape)
    return np.stack([np.real(p0), np.imag(p0), np.real(p1), np.imag(p1)], axis=-1)


def multiply(p, q):
    """Return the product p q of two dual complex numbers.

    Parameters
    ----------
    p, q : ndarray, shape (..., 4)
        re p0, im p0, re p1, im p1; not only unit ones.

    Returns
    -------
    pq : ndarray, shape (..., 4)
    """
    p, q = np.asarray(p, dtype=float), np.asarray(q, dtype=float)
    p0, p1 = p[..., 0] + 1j * p[..., 1], p[..., 2] + 1j * p[..., 3]
    q0, q1 = q[..., 0] + 1j * q[..., 1], q[..., 2] + 1j * q[..., 3]
    r0, r1 = p0 * q0, p1 * np.conj(q0) + p0 * q1
    return np.stack([r0.real, r0.imag, r1.real, r1.imag], axis=-1)


def act(p, v):
    """Return where unit dual complex numbers take points of the plane.

    Parameters
    ----------
    p : ndarray, shape (..., 4)
        re p0, im p0, re p1, im p1, with |p0| = 1.
    v : ndarray, shape (..., 2)
        Points.

    Returns
    -------
    moved : ndarray, shape (..., 2)
    """
    p, v = np.asarray(p, dtype=float), np.asarray(v, dtype=float)
    p0, p1 = p[..., 0] + 1j * p[..., 1], p[..., 2] + 1j * p[..., 3]
    moved = p0 * p0 * (v[..., 0] + 1j * v[..., 1]) + 2 * p0 * p1
    return np.stack([moved.real, moved.imag], axis=-1)


def _split(p):
    p = np.asarray(p, dtype=float)
    return p[..., ::2] + 1j * p[..., 1::2]


def _joined(*parts):
    z = np.stack(np.broadcast_arrays(*parts), axis=-1)
    return np.stack([np.real(z), np.imag(z)], axis=-1).reshape(*z.shape[:-1], 2 * z.shape[-1])


def _unit(rng, *shape):
    """Unit dual complex numbers of any turns, half of them with re p0 < 0."""
    return motion(rng.uniform(-2.0 * np.pi, 2.0 * np.pi, shape), rng.normal(size=(*shape, 2)))


def _motions(rng):
    yield Case("a quarter turn alone", (np.pi / 2.0, np.zeros(2)), "motion")
    yield Case("a shift alone", (0.0, np.array([3.0, -1.0])), "motion")
    yield Case("a turn and a shift", (0.9, np.array([2.0, 1.0])), "motion")
    yield Case("the other way round, by more than a half turn", (-4.2, rng.normal(size=2)), "motion")
    yield Case("a half turn", (np.pi, rng.normal(size=2)), "motion")


def _products(rng):
    yield Case("two unit ones", (_unit(rng), _unit(rng)), "multiply")
    i, dual = np.array([0.0, 1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, 0.0])
    yield Case("i times the dual unit", (i, dual), "multiply")
    yield Case("the dual unit times i", (dual, i), "multiply")
    yield Case("two that are not unit ones", (rng.normal(size=4), rng.normal(size=4)), "multiply")


def _actions(rng):
    yield Case("a turn", (_joined(np.exp(0.4j), 0.0), np.array([1.0, 0.0])), "act")
    yield Case("a shift", (np.array([1.0, 0.0, 0.5, -1.0]), np.array([2.0, 3.0])), "act")
    p = _unit(rng)
    yield Case("both", (p, rng.normal(size=2)), "act")
    yield Case("the same motion by -p", (-p, rng.normal(size=2)), "act")


def _batches(rng):
    yield Case("many turns and shifts", (rng.uniform(-3.0, 3.0, 5), rng.normal(size=(5, 2))), "motion")
    yield Case("one turn, many shifts", (0.7, rng.normal(size=(5, 2))), "motion")
    yield Case("many turns, one shift", (rng.uniform(-3.0, 3.0, (2, 3)), rng.normal(size=2)), "motion")
    yield Case("every one with every one", (_unit(rng, 3, 1), _unit(rng, 4)), "multiply")
    yield Case("one motion, many points", (_unit(rng), rng.normal(size=(6, 2))), "act")
    yield Case("many motions, one point", (_unit(rng, 6), rng.normal(size=2)), "act")
    yield Case("none at all", (np.zeros((0, 4)), np.zeros((0, 2))), "act")


def _laws(f, rng):
    p, q, r, v = _unit(rng), _unit(rng), _unit(rng), rng.normal(size=2)
    yield Claim(
        "(p q) r = p (q r)", f.multiply(f.multiply(p, q), r), f.multiply(p, f.multiply(q, r)), (p, q, r)
    )
    yield Claim(
        "p q moves as q does and then p", f.act(f.multiply(p, q), v), f.act(p, f.act(q, v)), (p, q, v)
    )
    theta, b = rng.uniform(-3.0, 3.0), rng.normal(size=2)
    moved = f.act(f.motion(theta, b), np.array([[0.0, 0.0], [1.0, 0.0]]))
    yield Claim("motion(theta, b) takes the origin to b", moved[0], b, (theta, b))
    yield Claim(
        "motion(theta, b) turns by theta",
        moved[1] - moved[0],
        np.array([np.cos(theta), np.sin(theta)]),
        (theta, b),
    )


def _of_motion(library, theta, b):
    theta, b = np.asarray(theta, dtype=float), np.asarray(b, dtype=float)
    T = np.zeros((*np.broadcast_shapes(theta.shape, b.shape[:-1]), 3, 3))
    c, s = np.cos(theta), np.sin(theta)
    T[..., 0, 0], T[..., 0, 1], T[..., 1, 0], T[..., 1, 1], T[..., 2, 2] = c, -s, s, c, 1.0
    T[..., :2, 2] = b
    return library(T)


def _shown(f):
    def number(T):
        T = np.asarray(T, dtype=float)
        return f.motion(np.arctan2(T[..., 1, 0], T[..., 0, 0]), T[..., :2, 2])

    return {"number": number, "multiply": f.multiply, "act": f.act}


def _made(p0, p1):
    """A wrong `motion`, of what p0 and p1 are to be for an angle and a complex shift."""

    def wrong(theta, b):
        theta, z = np.asarray(theta, dtype=float), _split(b)[..., 0]
        return _joined(p0(theta, z), p1(theta, z))

    return {"motion": wrong}


def _multiplied(dual):
    """A wrong `multiply`, of what the dual part is to be."""

    def wrong(p, q):
        p, q = _split(p), _split(q)
        (p0, p1), (q0, q1) = (np.moveaxis(z, -1, 0) for z in (p, q))
        return _joined(p0 * q0, dual(p0, p1, q0, q1))

    return {"multiply": wrong}


def _moved(place):
    """A wrong `act`, of where a point is to go."""

    def wrong(p, v):
        p = _split(p)
        return _joined(place(p[..., 0], p[..., 1], _split(v)[..., 0]))

    return {"act": wrong}


def _half(theta, z):
    return np.exp(0.5j * theta)


_MISTAKES = (
    Mistake(
        "half angle missing",
        "Half angle missing: p0 = exp(i theta) turns by 2 theta, since a point is multiplied by p0^2; "
        "p0 = exp(i theta / 2) is wanted.",
        _made(lambda theta, z: np.exp(1j * theta), lambda theta, z: 0.5 * z * np.exp(-1j * theta)),
    ),
    Mistake(
        "half of the shift missing",
        "The shift is twice as long as it should be: v goes to p0^2 v + 2 p0 p1, so 2 p0 p1 = b and "
        "p1 = b conj(p0) / 2.",
        _made(_half, lambda theta, z: z * np.exp(-0.5j * theta)),
    ),
    Mistake(
        "shift, then turn",
        "This shifts first and turns then: p1 = p0 b / 2 belongs to v -> p0^2 (v + b). The turn first and "
        "then the shift is (1 + b eps / 2) p0; eps passes p0 and conjugates it, (2.38): p1 = b conj(p0) / 2.",
        _made(_half, lambda theta, z: 0.5 * z * np.exp(0.5j * theta)),
    ),
    Mistake(
        "p0 left out of the shift",
        "p1 = b / 2 shifts by p0 b, since v goes to p0^2 v + 2 p0 p1: 2 p0 p1 = b wants p1 = b conj(p0) / 2.",
        _made(_half, lambda theta, z: 0.5 * z + 0.0 * theta),
    ),
    Mistake(
        "degrees",
        "The angle is taken for degrees: theta is in radians.",
        _made(
            lambda theta, z: np.exp(0.5j * np.deg2rad(theta)),
            lambda theta, z: 0.5 * z * np.exp(-0.5j * np.deg2rad(theta)),
        ),
    ),
    Mistake(
        "conjugate missing",
        "The conjugate is missing: eps z = conj(z) eps, so the dual part is p1 conj(q0) + p0 q1, (2.38). "
        "With p1 q0 + p0 q1 these are the commuting dual numbers, which do not move the plane.",
        _multiplied(lambda p0, p1, q0, q1: p1 * q0 + p0 * q1),
    ),
    Mistake(
        "the other conjugate",
        "The wrong factor is conjugated: in p1 eps q0 it is q0 that passes eps, (2.38), and in p0 q1 eps "
        "nothing does. The dual part is p1 conj(q0) + p0 q1.",
        _multiplied(lambda p0, p1, q0, q1: p1 * q0 + np.conj(p0) * q1),
    ),
    Mistake(
        "factors exchanged",
        "This is q p: (2.38) does not commute, as a shift and a turn do not.",
        _multiplied(lambda p0, p1, q0, q1: q1 * np.conj(p0) + q0 * p1),
    ),
    Mistake(
        "square missing",
        "Points are turned by half of the angle: v goes to p0^2 v + 2 p0 p1, p0 squared.",
        _moved(lambda p0, p1, v: p0 * v + 2.0 * p0 * p1),
    ),
    Mistake(
        "factor 2 missing",
        "The shift is half as long as it should be: v goes to p0^2 v + 2 p0 p1.",
        _moved(lambda p0, p1, v: p0 * p0 * v + p0 * p1),
    ),
    Mistake(
        "p0 missing in the shift",
        "The shift is not turned along: v goes to p0^2 v + 2 p0 p1, not + 2 p1.",
        _moved(lambda p0, p1, v: p0 * p0 * v + 2.0 * p1),
    ),
    Mistake(
        "the other way round",
        "This turns the other way round, by conj(p0)^2: v goes to p0^2 v + 2 p0 p1.",
        _moved(lambda p0, p1, v: np.conj(p0) ** 2 * v + 2.0 * p0 * p1),
    ),
)

EXERCISE = Exercise(
    number=6,
    title="Motions of the plane as dual complex numbers",
    equations=("2.38",),
    functions=(
        Function(
            "motion",
            library="lietool.lie.dual_complex.from_matrix",
            call=_of_motion,
            starter="return np.full((*np.broadcast_shapes(np.shape(theta), np.shape(b)[:-1]), 4), np.nan)",
            apart=compare.up_to_sign,
        ),
        Function(
            "multiply",
            library="lietool.lie.dual_complex.multiply",
            starter="return np.full(np.broadcast_shapes(np.shape(p), np.shape(q)), np.nan)",
        ),
        Function(
            "act",
            library="lietool.lie.dual_complex.act",
            starter="return np.full((*np.broadcast_shapes(np.shape(p)[:-1], np.shape(v)[:-1]), 2), np.nan)",
        ),
    ),
    checks=(
        Check("numbers of motions", 2, cases=_motions),
        Check("products", 2, cases=_products),
        Check("points moved", 2, cases=_actions),
        Check("many at once", 1, cases=_batches),
        Check("laws: the product is one motion after the other", 1, law=_laws),
    ),
    picture=Picture("B2.3", 2, _shown),
    mistakes=_MISTAKES,
)
