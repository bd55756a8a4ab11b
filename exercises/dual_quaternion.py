r"""Dual quaternions: turns and translations in one number.

A dual quaternion is $z + w\varepsilon$, where $z$ and $w$ are quaternions, $\varepsilon^2 = 0$, and
$\varepsilon$ commutes with everything (section 2.8). It is written here as an array of eight numbers,
$z$ and then $w$, each with its real part first. A point $\mathbf{p}$ of space is the dual quaternion
$1 + \mathbf{p}\,\varepsilon$, and a unit dual quaternion $q$, one with $|z| = 1$ and
$\langle z, w\rangle = 0$ (4.16), moves it by

$$1 + \mathbf{p}\,\varepsilon \;\mapsto\; q\,(1 + \mathbf{p}\,\varepsilon)\,\bar q^{*},
  \qquad \bar q^{*} = \bar z - \bar w\,\varepsilon .$$

Turns are $q = z$, translations $q = 1 + w\varepsilon$ with an imaginary $w$, and every rigid motion is a
product of these.

Write three functions:

- `motion(z, t)` returns the unit dual quaternion that first turns space by the unit quaternion `z` and then
  translates it by the vector `t`.
- `product(q, p)` returns $q\,p$ of two dual quaternions, of any two.
- `action(q, p)` returns where the unit dual quaternion `q` takes the point `p`.

All of them take batches, which go together as numpy broadcasts them: quaternions `(..., 4)`, vectors and
points `(..., 3)`, dual quaternions `(..., 8)`. In the plate dual quaternions move a plane that is held aslant
in space: shift, turn, shift back.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture
from lietool.exercise import compare as _compare


def motion(z, t):
    """Return the dual quaternions of turns and then translations.

    Parameters
    ----------
    z : ndarray, shape (..., 4)
        Unit quaternions, real part first.
    t : ndarray, shape (..., 3)
        Translations.

    Returns
    -------
    ndarray, shape (..., 8)
        Unit dual quaternions z + w eps.
    """
    z, t = np.asarray(z, float), np.asarray(t, float)
    # 1 + w eps translates by 2 w: once for each side of the point.
    w = 0.5 * times(imaginary(t), z)
    return np.concatenate([np.broadcast_to(z, w.shape), w], axis=-1)


def product(q, p):
    """Return the product of two dual quaternions.

    Parameters
    ----------
    q, p : ndarray, shape (..., 8)
        Dual quaternions z + w eps, not only unit ones.

    Returns
    -------
    ndarray, shape (..., 8)
        The products q p.
    """
    z, w, x, y = q[..., :4], q[..., 4:], p[..., :4], p[..., 4:]
    return np.concatenate([times(z, x), times(z, y) + times(w, x)], axis=-1)


def action(q, p):
    """Return points as unit dual quaternions move them.

    Parameters
    ----------
    q : ndarray, shape (..., 8)
        Unit dual quaternions z + w eps.
    p : ndarray, shape (..., 3)
        Points.

    Returns
    -------
    ndarray, shape (..., 3)
    """
    z, w = q[..., :4], q[..., 4:]
    back = conjugate(z)
    # Multiplied out: z p z^-1 + w z^-1 - z w_bar, of which the last two are the same.
    return (times(times(z, imaginary(p)), back) + 2.0 * times(w, back))[..., 1:]


def times(q, p):
    """Return products of quaternions, shape (..., 4)."""
    a, b = q[..., :1], p[..., :1]
    v, w = q[..., 1:], p[..., 1:]
    real = a * b - np.sum(v * w, axis=-1, keepdims=True)
    return np.concatenate([real, a * w + b * v + np.cross(v, w)], axis=-1)


def conjugate(q):
    """Return quaternions with the signs of their imaginary parts changed."""
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def imaginary(p):
    """Return vectors as quaternions, shape (..., 4)."""
    p = np.asarray(p, float)
    return np.concatenate([np.zeros((*p.shape[:-1], 1)), p], axis=-1)


_ONE, _I, _J, _K = np.eye(4)
_QUARTER = np.sqrt(0.5) * (_ONE + _K)


def _unit(rng, *shape):
    z = rng.normal(size=(*shape, 4))
    return z / np.linalg.norm(z, axis=-1, keepdims=True)


def _moving(rng, *shape):
    """Unit dual quaternions."""
    return motion(_unit(rng, *shape), rng.normal(size=(*shape, 3)))


def _motions(rng):
    yield Case("a turn alone", (_unit(rng), np.zeros(3)), "motion")
    yield Case("a translation alone", (_ONE, np.array([2.0, -4.0, 6.0])), "motion")
    yield Case("a quarter of a turn about z, then a translation along x", (_QUARTER, np.eye(3)[0]), "motion")
    yield Case("half a turn, then a translation", (_J, rng.normal(size=3)), "motion")
    yield Case("some turn and translation", (_unit(rng), rng.normal(size=3)), "motion")


def _products(rng):
    eps = np.concatenate([np.zeros(4), _ONE])
    yield Case("eps eps", (eps, eps), "product")
    yield Case("i times j eps", (np.append(_I, 0.0 * _I), np.append(0.0 * _J, _J)), "product")
    yield Case("i eps times j", (np.append(0.0 * _I, _I), np.append(_J, 0.0 * _J)), "product")
    yield Case("two unit ones", (_moving(rng), _moving(rng)), "product")
    yield Case("two that are not unit ones", (rng.normal(size=8), rng.normal(size=8)), "product")


def _actions(rng):
    p = rng.normal(size=3)
    yield Case("a turn", (motion(_QUARTER, np.zeros(3)), np.array([1.0, 0.0, 2.0])), "action")
    yield Case("1 + w eps", (np.concatenate([_ONE, 0.5 * _I - _K]), np.array([1.0, 2.0, 3.0])), "action")
    yield Case("the origin", (q := _moving(rng), np.zeros(3)), "action")
    yield Case("some motion and point", (q, p), "action")
    yield Case("the same motion by -q", (-q, p), "action")


def _batches(rng):
    yield Case("many turns and translations", (_unit(rng, 5), rng.normal(size=(5, 3))), "motion")
    yield Case("one turn, many translations", (_unit(rng), rng.normal(size=(5, 3))), "motion")
    yield Case("many turns, one translation", (_unit(rng, 2, 3), rng.normal(size=3)), "motion")
    yield Case("every one with every one", (_moving(rng, 3, 1), _moving(rng, 4)), "product")
    yield Case("one motion, many points", (_moving(rng), rng.normal(size=(6, 3))), "action")
    yield Case("many motions, one point", (_moving(rng, 6), rng.normal(size=3)), "action")


def _laws(f, rng):
    (q, r, s), (p, b), z = _moving(rng, 3), rng.normal(size=(2, 3)), _unit(rng)
    yield Claim("(q r) s = q (r s)", f.product(f.product(q, r), s), f.product(q, f.product(r, s)), (q, r, s))
    moved = f.action(q, f.action(r, p))
    yield Claim("q r moves as first r does, then q", f.action(f.product(q, r), p), moved, (q, r, p))
    yield Claim("motion(z, t) takes the origin to t", f.action(f.motion(z, b), np.zeros(3)), b, (z, b))
    # A translation seen from a turned frame.
    turn, back = (f.motion(x, np.zeros(3)) for x in (z, conjugate(z)))
    there = f.product(f.product(turn, f.motion(_ONE, b)), back)
    yield Claim("R T_b R^-1 = T_Rb, (2.8)", there, f.motion(_ONE, f.action(turn, b)), (z, b))


# Where the plate is held in space: two directions in its plane, the axis of its turns, and its origin beside
# that of space, so that every turn of it is a turn and a translation.
_ACROSS, _UP, _AXIS = np.array([[3.0, -6.0, 2.0], [6.0, 2.0, -3.0], [2.0, 3.0, 6.0]]) / 7.0
_PLANE, _ASIDE = np.stack([_ACROSS, _UP]), np.array([1.0, -0.5])


def _shown(f):
    """Return what the figure takes: motions of its plane, which is held aslant in space."""

    def number(T):
        half = 0.5 * np.arctan2(T[..., 1, 0], T[..., 0, 0])[..., None]
        z = np.concatenate([np.cos(half), np.sin(half) * _AXIS], axis=-1)
        return f.motion(z, (T[..., :2, 2] + _ASIDE - T[..., :2, :2] @ _ASIDE) @ _PLANE)

    def act(q, p):
        return f.action(q, _AXIS + (p + _ASIDE) @ _PLANE) @ _PLANE.T - _ASIDE

    return {"number": number, "multiply": f.product, "act": act}


def _made(dual):
    """Return a wrong `motion`, of what w is to be."""

    def wrong(z, t):
        w = dual(np.asarray(z, float), imaginary(t))
        return np.concatenate([np.broadcast_to(z, w.shape), w], axis=-1)

    return {"motion": wrong}


def _multiplied(dual):
    """Return a wrong `product`, of what its dual part is to be."""

    def wrong(q, p):
        parts = q[..., :4], q[..., 4:], p[..., :4], p[..., 4:]
        return np.concatenate(np.broadcast_arrays(times(parts[0], parts[2]), dual(*parts)), axis=-1)

    return {"product": wrong}


def _moved(place):
    """Return a wrong `action`, of where a point is to go."""
    return {"action": lambda q, p: place(q[..., :4], q[..., 4:], imaginary(p))[..., 1:]}


_MISTAKES = (
    Mistake(
        "translation by 2 t",
        "It translates by 2 t. The text says that 1 + w eps translates by w, but the point has q on both "
        "sides and w is added twice (see `lietool errata 2.8`): w = t z / 2.",
        _made(lambda z, t: times(t, z)),
    ),
    Mistake(
        "first the translation",
        "This translates first and turns then: w = z t / 2. A product is read from the right: first z, then "
        "the translation is (1 + t/2 eps) z, with w = t z / 2.",
        _made(lambda z, t: 0.5 * times(z, t)),
    ),
    Mistake(
        "z missing",
        "z is missing from the dual part: (1 + t/2 eps) z = z + (t z / 2) eps. With w = t / 2 this is not "
        "even a unit dual quaternion, (4.16).",
        _made(lambda z, t: 0.5 * t + 0.0 * z),
    ),
    *(
        Mistake(
            name,
            "A term of the product is missing: (z + w eps)(x + y eps) has the dual part z y + w x.",
            _multiplied(dual),
        )
        for name, dual in (
            ("z y alone", lambda z, w, x, y: times(z, y)),
            ("w x alone", lambda z, w, x, y: times(w, x)),
        )
    ),
    Mistake(
        "order within the dual part",
        "In the dual part of the product the quaternions have changed places: it is z y + w x, the left "
        "factor on the left in both; quaternions do not commute.",
        _multiplied(lambda z, w, x, y: times(z, y) + times(x, w)),
    ),
    Mistake(
        "dual parts by themselves",
        "The two halves are multiplied each by itself: but eps^2 = 0, so that w y is no part of the product, "
        "and z y + w x is its dual part.",
        _multiplied(lambda z, w, x, y: times(w, y)),
    ),
    Mistake(
        "eps^2 = -1",
        "The product of the dual parts is added to the real part: eps^2 is 0.",
        {
            "product": lambda q, p: (
                product(q, p)
                - np.concatenate(np.broadcast_arrays(times(q[..., 4:], p[..., 4:]), np.zeros(4)), axis=-1)
            )
        },
    ),
    Mistake(
        "factors exchanged",
        "This is p q: dual quaternions do not commute, as turns and translations do not.",
        {"product": lambda q, p: product(p, q)},
    ),
    Mistake(
        "star missing",
        "Translations do nothing here. On the right of the point stands the conjugate with a star, whose "
        "dual part has changed its sign: without that w z^-1 and z w_bar cancel.",
        _moved(lambda z, w, p: times(times(z, p), conjugate(z))),
    ),
    Mistake(
        "once",
        "The translation is half as long as it should be: both sides of the point add one, w z^-1 and "
        "-z w_bar, which are the same.",
        _moved(lambda z, w, p: times(times(z, p), conjugate(z)) + times(w, conjugate(z))),
    ),
    Mistake(
        "2 w",
        "The translation is 2 w z^-1. It is 2 w only where nothing turns, z = 1.",
        _moved(lambda z, w, p: times(times(z, p), conjugate(z)) + 2.0 * w),
    ),
    Mistake(
        "the other way round",
        "This turns the other way: the point stands between z on its left and its conjugate on its right.",
        _moved(lambda z, w, p: times(times(conjugate(z), p), z) + 2.0 * times(w, conjugate(z))),
    ),
)

EXERCISE = Exercise(
    number=5,
    title="Dual quaternions: turns and translations in one number",
    equations=("2.8", "4.15", "4.16"),
    functions=(
        Function(
            "motion",
            library="lietool.lie.dual_quaternion.from_rotation_translation",
            starter="return np.full((*np.broadcast_shapes(np.shape(z)[:-1], np.shape(t)[:-1]), 8), np.nan)",
            apart=_compare.up_to_sign,
        ),
        Function(
            "product",
            library="lietool.lie.dual_quaternion.multiply",
            starter="return np.full(np.broadcast_shapes(np.shape(q), np.shape(p)), np.nan)",
        ),
        Function(
            "action",
            library="lietool.lie.dual_quaternion.act",
            starter="return np.full((*np.broadcast_shapes(np.shape(q)[:-1], np.shape(p)[:-1]), 3), np.nan)",
        ),
    ),
    checks=(
        Check("dual quaternions of motions", 2, cases=_motions),
        Check("products", 2, cases=_products),
        Check("points moved", 2, cases=_actions),
        Check("batches", 1, cases=_batches),
        Check("laws: one motion after the other, and (2.8)", 1, law=_laws),
    ),
    picture=Picture("B2.3b", 2, _shown),
    mutants=("quaternion.multiply: sign", "dual_quaternion.translation: conjugate"),
    mistakes=_MISTAKES,
)
