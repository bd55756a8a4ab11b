r"""Quaternions: their product, and how they turn space.

A quaternion $a + bi + cj + dk$ is written here as an array `(a, b, c, d)`, real part first. Quaternions are
multiplied by the rules

$$i^2 = j^2 = k^2 = -1, \qquad ij = k = -ji, \quad jk = i = -kj, \quad ki = j = -ik,$$

so that multiplication by $a + bi + cj + dk$ from the left is the matrix of (2.24). A vector $\mathbf{p}$ of
space is the quaternion $(0, \mathbf{p})$ without a real part, and a quaternion $q \ne 0$ acts on it by

$$\mathbf{p} \mapsto q\,\mathbf{p}\,q^{-1}. \qquad (2.28)$$

For $q = \cos\frac\theta2 + \sin\frac\theta2\,\mathbf{u}$, (2.26), this is the rotation about $\mathbf{u}$ by
$\theta$. It does not depend on the length of $q$.

Write two functions:

- `product(q, p)` returns $q\,p$ of two quaternions.
- `action(q, p)` returns the vector $q\,\mathbf{p}\,q^{-1}$ of a quaternion `q` and a vector `p` of shape
  `(..., 3)`. The quaternion may be of any length but 0, which is refused with a `ValueError`.

Both arguments may be batches, `(..., 4)` and `(..., 3)`, which go together as numpy broadcasts them.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def product(q, p):
    """Return the product of two quaternions.

    Parameters
    ----------
    q, p : ndarray, shape (..., 4)
        Quaternions (a, b, c, d), real part first.

    Returns
    -------
    ndarray, shape (..., 4)
        The products q p.
    """
    a, b, c, d = np.moveaxis(np.asarray(q), -1, 0)
    w, x, y, z = np.moveaxis(np.asarray(p), -1, 0)
    return np.stack(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ],
        axis=-1,
    )


def action(q, p):
    """Return vectors as quaternions turn them.

    Parameters
    ----------
    q : ndarray, shape (..., 4)
        Quaternions (a, b, c, d) of any length but 0.
    p : ndarray, shape (..., 3)
        Vectors.

    Returns
    -------
    ndarray, shape (..., 3)
        The vectors q p q^-1.

    Raises
    ------
    ValueError
        If a quaternion is 0.
    """
    q, p = np.asarray(q, float), np.asarray(p, float)
    square = np.sum(q * q, axis=-1, keepdims=True)
    if np.any(square == 0.0):
        raise ValueError("the quaternion 0 has no inverse")
    inverse = q * np.array([1.0, -1.0, -1.0, -1.0]) / square
    imaginary = np.concatenate([np.zeros((*p.shape[:-1], 1)), p], axis=-1)
    return product(product(q, imaginary), inverse)[..., 1:]


_ONE, _I, _J, _K = np.eye(4)


def _unit(rng, *shape):
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def _products(rng):
    yield Case("1 and some quaternion", (_ONE, rng.normal(size=4)), "product")
    yield Case("i j", (_I, _J), "product")
    yield Case("k j", (_K, _J), "product")
    for _ in range(3):
        yield Case("some quaternions", (rng.normal(size=4), rng.normal(size=4)), "product")


def _actions(rng):
    half = np.sqrt(0.5)
    yield Case("a quarter of a turn about z", (half * (_ONE + _K), np.array([1.0, 0.0, 0.0])), "action")
    yield Case("half a turn about i", (_I, np.array([1.0, 2.0, 3.0])), "action")
    for _ in range(3):
        yield Case("some unit quaternion and vector", (_unit(rng), rng.normal(size=3)), "action")


def _batches(rng):
    yield Case("five products", (rng.normal(size=(5, 4)), rng.normal(size=(5, 4))), "product")
    yield Case("one quaternion by 2 x 3", (rng.normal(size=4), rng.normal(size=(2, 3, 4))), "product")
    yield Case("five vectors, each with its own", (_unit(rng, 5), rng.normal(size=(5, 3))), "action")
    yield Case("six vectors turned by one", (_unit(rng), rng.normal(size=(6, 3))), "action")


def _laws(f, rng):
    q, r, s = rng.normal(size=(3, 4))
    v, w = _unit(rng, 2)
    p = rng.normal(size=3)
    yield Claim("(q r) s = q (r s)", f.product(f.product(q, r), s), f.product(q, f.product(r, s)), (q, r, s))
    length = np.linalg.norm(q) * np.linalg.norm(r)
    yield Claim("|q r| = |q| |r|", np.linalg.norm(f.product(q, r)), length, (q, r))
    one_by_one = f.action(v, f.action(w, p))
    yield Claim(
        "q r turns as first r does, then q, (2.29)", f.action(f.product(v, w), p), one_by_one, (v, w, p)
    )
    yield Claim("q and -q turn alike, (2.30)", f.action(-v, p), f.action(v, p), (v, p))
    yield Claim("lengths stay", np.linalg.norm(f.action(v, p)), np.linalg.norm(p), (v, p))


def _hard(rng):
    yield Case("a quaternion of length 2", (2.0 * _unit(rng), rng.normal(size=3)), "action")
    yield Case("a quaternion of length 1e-3", (1e-3 * _unit(rng), rng.normal(size=3)), "action")
    yield Case("whole numbers", (np.array([1, 1, 1, 0]), np.array([1, 2, 3])), "action")
    yield Case("the quaternion 0", (np.zeros(4), np.array([1.0, 0.0, 0.0])), "action", raises=True)
    among = np.stack([_ONE, np.zeros(4)])
    yield Case("the quaternion 0 in a batch", (among, np.array([1.0, 0.0, 0.0])), "action", raises=True)


def _parts(real, across):
    """Return a wrong product: the inner and the cross product of the imaginary parts with other factors."""

    def wrong(q, p):
        (a, v), (b, w) = ((x[..., :1], x[..., 1:]) for x in (np.asarray(q, float), np.asarray(p, float)))
        first = a * b + real * np.sum(v * w, axis=-1, keepdims=True)
        return np.concatenate([first, a * w + b * v + across * np.cross(v, w)], axis=-1)

    return wrong


def _last(q):
    """Return a quaternion with its real part moved from the front to the end."""
    return np.roll(q, -1, axis=-1)


def _bar(q):
    return np.asarray(q) * np.array([1.0, -1.0, -1.0, -1.0])


def _sandwich(right, power=0):
    """Return a wrong action: q p times something, divided by a power of the length of q."""

    def wrong(q, p):
        imaginary = np.insert(np.asarray(p, float), 0, 0.0, axis=-1)
        length = np.linalg.norm(q, axis=-1, keepdims=True)
        return product(product(q, imaginary), right(q))[..., 1:] / length**power

    return wrong


def _shown(f):
    """Return what the figure takes; one call for each pair, for who has written functions of one."""

    def each(function):
        def mapped(q, p):
            batch = np.broadcast_shapes(q.shape[:-1], p.shape[:-1])
            pairs = (np.broadcast_to(x, (*batch, x.shape[-1])).reshape(-1, x.shape[-1]) for x in (q, p))
            return np.reshape([function(*pair) for pair in zip(*pairs, strict=True)], (*batch, p.shape[-1]))

        return mapped

    return {"multiply": each(f.product), "act": each(f.action)}


EXERCISE = Exercise(
    number=3,
    title="Quaternions: their product, and how they turn space",
    equations=("2.24", "2.26", "2.28", "2.29", "2.30"),
    functions=(
        Function(
            "product",
            library="lietool.lie.quaternion.multiply",
            starter="return np.full(np.broadcast_shapes(np.shape(q), np.shape(p)), np.nan)",
            tolerance=1e-12,
        ),
        Function(
            "action",
            library="lietool.lie.quaternion.act",
            starter="return np.full((*np.broadcast_shapes(np.shape(q)[:-1], np.shape(p)[:-1]), 3), np.nan)",
            tolerance=1e-12,
        ),
    ),
    checks=(
        Check("the product", 2, cases=_products),
        Check("the action", 2, cases=_actions),
        Check("batches", 1, cases=_batches),
        Check("laws", 1, law=_laws),
        Check("quaternions of other lengths, and 0", 1, cases=_hard),
    ),
    picture=Picture("B2.7", 3, _shown),
    mutants=("quaternion.multiply", "quaternion.to_matrix: sign", "quaternion.to_matrix: factor"),
    mistakes=(
        Mistake(
            "inner product added",
            "The inner product of the imaginary parts has the wrong sign: i^2 = j^2 = k^2 = -1, so that "
            "the real part of q p is a w - b x - c y - d z, the first row of (2.24).",
            {"product": _parts(1.0, 1.0)},
        ),
        Mistake(
            "no cross product",
            "The products of different units are missing: i j = k, j k = i, k i = j make a cross product "
            "of the imaginary parts, which stands beside a w and b v, (2.24).",
            {"product": _parts(-1.0, 0.0)},
        ),
        Mistake(
            "by components",
            "The components are multiplied one by one. A product of quaternions has sixteen terms, four "
            "in each component: multiply out by i j = k and so on, or use the matrix (2.24).",
            {"product": lambda q, p: np.asarray(q) * p},
        ),
        Mistake(
            "real part last",
            "The real part is taken to be the last component. Here quaternions are (a, b, c, d), real part "
            "first.",
            {
                "product": lambda q, p: np.roll(
                    product(np.roll(q, 1, axis=-1), np.roll(p, 1, axis=-1)), -1, axis=-1
                )
            },
        ),
        Mistake(
            "the other way round",
            "This is q^-1 p q, which turns back by the same angle: (2.28) has q on the left and its inverse "
            "on the right. A product in the wrong order does that too.",
            {"action": lambda q, p: action(_bar(q), p)},
        ),
        Mistake(
            "conjugate for inverse",
            "The vector is stretched by |q|^2. The inverse is the conjugate divided by |q|^2; only for unit "
            "quaternions are both the same.",
            {"action": _sandwich(_bar)},
        ),
        Mistake(
            "divided by the length",
            "The vector is stretched by |q|. The inverse is the conjugate divided by the square of the "
            "length: q times it must be 1.",
            {"action": _sandwich(_bar, 1)},
        ),
        Mistake(
            "from one side",
            "This is the imaginary part of q p alone, which is turned by half of the angle and has lost a "
            "part along the axis. (2.28) multiplies by q^-1 from the right as well.",
            {"action": _sandwich(lambda q: _ONE)},
        ),
        Mistake(
            "no inverse",
            "This is q p q. The factor on the right of (2.28) is the inverse of q.",
            {"action": _sandwich(np.asarray)},
        ),
    ),
)
