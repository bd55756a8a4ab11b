r"""Points that follow probes.

Probes are frames that are put into a shape and moved; every point of the shape moves by a blend of their
motions. Write two functions.

**`weights`**: how much each probe counts at each point. With $r_{ji}$ the distance of point $j$ to the centre
of probe $i$, and a power $p > 0$,
$$w_{ji} = \frac{r_{ji}^{-p}}{\sum_k r_{jk}^{-p}},$$
so that the weights of every point sum to 1. A point that lies exactly at the centre of a probe has all its
weight there: 1 for this probe, 0 for the others.

**`deform`**: the motion of probe $i$ is given by its parameters, which are those of $\mathbb R^3 \times
\mathfrak{so}(3) \times \mathfrak{sym}(3)$,
$$A_i v = \exp(x_i)\exp(Y_i)\,v + l_i,$$
$x_i$ a rotation vector (axis times angle in radians, of any length: 7 means more than a full turn), $Y_i$ a
symmetric matrix, $l_i$ a translation (`shift`). Blended as it stands, (7.9) gives a result that depends on
where the origin of the coordinates is. Therefore each motion is first seen from the centre $c_i$ of its
probe, which it moves by
$$t_i = A_i c_i - c_i .$$
The parameters are then added up with the weights, and the sum acts about a centre that is blended too:
$$v' = c + \sum_i w_i t_i + \exp\Big(\sum_i w_i x_i\Big) \exp\Big(\sum_i w_i Y_i\Big) (v - c), \qquad
c = \frac{\sum_i w_i c_i}{\sum_i w_i}.$$
The weights given to `deform` need not sum to 1, but at no point are they all 0.

Vectors are columns, and arrays of vectors have one in each row. The exponentials are those of (4.7), about
any axis and by any angle, 0 among them, and of a symmetric matrix, $V \mathrm{diag}(e^{\lambda}) V^T$.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def weights(points, centres, power):
    """Return the weights of probes at points.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Where they are asked for.
    centres : ndarray, shape (k, 3)
        Of the probes; no two are the same.
    power : float
        The power p of the distance, at least 1.

    Returns
    -------
    ndarray, shape (n, k)
        A row for each point, which sums to 1.
    """
    r = np.linalg.norm(points[:, None] - centres, axis=2)
    # Relative to the nearest probe no power of a distance is too large or too small.
    nearest = r.min(axis=1, keepdims=True)
    at_probe = nearest == 0.0
    ratio = nearest / np.where(r > 0.0, r, 1.0)
    w = np.where(at_probe, r == 0.0, ratio**power)
    return w / w.sum(axis=1, keepdims=True)


def deform(points, centres, weights, x, Y, shift):
    """Return where points go when probes are moved.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        The shape at rest.
    centres : ndarray, shape (k, 3)
        Of the probes at rest.
    weights : ndarray, shape (n, k)
        Of the probes at the points.
    x : ndarray, shape (k, 3)
        Rotation vectors, axis times angle in radians.
    Y : ndarray, shape (k, 3, 3)
        Symmetric matrices, the logarithms of the stretches.
    shift : ndarray, shape (k, 3)
        Translations: probe i moves space by v -> exp(x_i) exp(Y_i) v + shift_i.

    Returns
    -------
    ndarray, shape (n, 3)
        The points moved.
    """
    A = _rotations(x) @ _stretches(Y)
    t = _applied(A, centres) + shift - centres
    c = weights @ centres / weights.sum(axis=1, keepdims=True)
    blended = _rotations(weights @ x) @ _stretches(np.tensordot(weights, Y, axes=1))
    return c + weights @ t + _applied(blended, points - c)


def _rotations(x):
    theta = np.linalg.norm(x, axis=-1)[..., None, None]
    X = np.zeros((*x.shape, 3))
    X[..., 2, 1], X[..., 0, 2], X[..., 1, 0] = x[..., 0], x[..., 1], x[..., 2]
    X = X - np.swapaxes(X, -1, -2)
    # np.sinc(a) is sin(pi a) / (pi a), and 1 at 0.
    return np.eye(3) + np.sinc(theta / np.pi) * X + 0.5 * np.sinc(theta / (2.0 * np.pi)) ** 2 * (X @ X)


def _stretches(Y):
    values, V = np.linalg.eigh(Y)
    return (V * np.exp(values)[..., None, :]) @ np.swapaxes(V, -1, -2)


def _applied(A, v):
    return (A @ v[..., None])[..., 0]


def _distances(points, centres):
    return np.linalg.norm(points[:, None] - centres, axis=2)


def _motions(rng, k, turn=1.5):
    """Parameters of k motions."""
    x = rng.normal(size=(k, 3))
    Y = 0.3 * rng.normal(size=(k, 3, 3))
    return turn * x, 0.5 * (Y + np.swapaxes(Y, -1, -2)), rng.normal(size=(k, 3))


def _few(rng):
    centres = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    yield Case(
        "a point a quarter of the way between two", (np.array([[0.5, 0.0, 0.0]]), centres, 2.0), "weights"
    )
    for power in (1.0, 2.5, 4.0):
        yield Case(
            f"random points, power {power:g}", (rng.normal(size=(7, 3)), rng.normal(size=(3, 3)), power)
        )


def _at_probes(rng):
    centres = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    yield Case("points at the probes", (centres, centres, 2.0))
    yield Case(
        "one of several points at a probe, power 4", (np.append(centres, -centres, 0)[2:], centres, 4.0)
    )
    yield Case("a thousand times as far away, power 6", (1e3 * rng.normal(size=(3, 3)), centres, 6.0))


def _one(rng):
    """One motion: nothing is blended yet."""
    v = np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    still, quarter = np.zeros((1, 3)), np.array([[0.0, 0.0, np.pi / 2]])
    flat, one = np.zeros((1, 3, 3)), np.ones((2, 1))
    yield Case("a quarter turn of a probe at 0", (v, still, one, quarter, flat, still), "deform")
    shift = np.array([[1.0, 2.0, 3.0]])
    yield Case("a translation", (v, np.array([[5.0, 0.0, 0.0]]), one, still, flat, shift), "deform")
    doubled = np.log(2.0) * np.eye(3)[None]
    yield Case("twice as large", (v, np.array([[0.0, 0.0, 1.0]]), one, still, doubled, still), "deform")
    centre = rng.normal(size=(1, 3))
    yield Case("any motion", (v, centre, one, *_motions(rng, 1)), "deform")


def _several(rng):
    v = np.array([[10.0, 0.0, 1.0]])
    centres = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 2]])
    shift = np.array([[0.0, 0.0, 0.0], [10.0, -10.0, 0.0]])
    half = np.array([[0.5, 0.5]])
    given = v, centres, half, x, np.zeros((2, 3, 3)), shift
    yield Case("a quarter turn about a probe at x = 10", given, "deform")
    for k in (2, 4):
        w = rng.uniform(0.1, 1.0, (5, k))
        w /= w.sum(axis=1, keepdims=True)
        v, c = rng.normal(size=(5, 3)), rng.normal(size=(k, 3))
        yield Case(f"random motions of {k} probes", (v, c, w, *_motions(rng, k)), "deform")


def _laws(f, rng):
    v, c, w = rng.normal(size=(6, 3)), rng.normal(size=(3, 3)), rng.uniform(0.1, 1.0, (6, 3))
    w /= w.sum(axis=1, keepdims=True)
    x, Y, shift = _motions(rng, 3)
    moved = f.deform(v, c, w, x, Y, shift)
    d = np.array([10.0, -4.0, 7.0])
    # The same motions with the origin elsewhere.
    seen = shift + d - _applied(_rotations(x) @ _stretches(Y), np.tile(d, (3, 1)))
    elsewhere = f.deform(v + d, c + d, w, x, Y, seen)
    yield Claim("points, probes and motions all moved by d: the result moves by d", elsewhere, moved + d)
    same = [np.repeat(a[:1], 3, axis=0) for a in (x, Y, shift)]
    alone = _applied(_rotations(x[0]) @ _stretches(Y[0]), v) + shift[0]
    yield Claim("probes that all move alike move the points alike", f.deform(v, c, w, *same), alone)
    even = np.tile(w[:1], (6, 1))
    rigid = f.deform(v, c, even, x, 0.0 * Y, shift)
    says = "points of equal weights keep their distances where no probe stretches"
    yield Claim(says, _distances(rigid, rigid), _distances(v, v))
    sums = f.weights(v, c, 3.0).sum(axis=1)
    yield Claim("the weights of every point sum to 1", sums, np.ones(6))


def _hard(rng):
    v, c = rng.normal(size=(4, 3)), rng.normal(size=(2, 3))
    w = rng.uniform(0.05, 0.4, (4, 2))
    yield Case("weights that sum to less than 1", (v, c, w, *_motions(rng, 2)), "deform")
    x, Y, shift = _motions(rng, 2)
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2.2 * np.pi]])
    yield Case("a turn by 396 degrees, and none", (v, c, w, x, Y, shift), "deform")
    yield Case("nothing moves", (v, c, w, 0.0 * x, 0.0 * Y, 0.0 * shift), "deform")


def _shown(f):
    """The student's functions as the figure calls those of the library."""
    from lietool.deform import move

    def solve(prepared, pose):
        x, t = pose.params[:, :3], pose.params[:, 3:6]
        Y = np.zeros((len(x), 3, 3))
        Y[:, *np.triu_indices(3)] = pose.params[:, 6:]
        Y = Y + np.swapaxes(np.triu(Y, 1), 1, 2)
        c = prepared.origins
        shift = t + c - _applied(_rotations(x) @ _stretches(Y), c)
        points = prepared.local + prepared.centre
        moved = np.asarray(f.deform(points, c, prepared.weights.rotation, x, Y, shift))
        return move.Moved(moved, np.zeros(len(moved), bool))

    return {"shepard": f.weights, "solve": solve}


def _reference(solve, points, centres, weights, x, Y, shift):
    """The deformer of the library, which is given motions seen from the probes' centres."""
    from lietool.deform import move, ways

    t = _applied(_rotations(x) @ _stretches(Y), centres) + shift - centres
    params = np.concatenate([x, t, Y[:, *np.triu_indices(3)]], axis=1)
    pose = move.Pose(ways.PHI_SO, params, np.ones(len(x), bool), np.zeros((len(x), 0)))
    return solve(move.prepare(points, centres, weights), pose).points


def _deformer(origin="blended", seen=True, turn=1.0):
    """A deformer with mistakes: about other origins, with the translations as they are, and so on."""

    def made(points, centres, weights, x, Y, shift):
        c = weights @ centres / weights.sum(axis=1, keepdims=True)
        c = {"blended": c, "world": 0.0 * c, "mean": 0.0 * c + centres.mean(axis=0)}[origin]
        t = _applied(_rotations(x) @ _stretches(Y), centres) + shift - centres if seen else shift
        L = _rotations(turn * (weights @ x)) @ _stretches(np.tensordot(weights, Y, axes=1))
        return c + weights @ t + _applied(L, points - c)

    return made


def _each(points, centres, weights, x, Y, shift):
    moved = (_rotations(x) @ _stretches(Y) @ points[:, None, :, None])[..., 0] + shift
    return np.einsum("nk,nki->ni", weights, moved)


def _powers(points, centres, power):
    return _distances(points, centres) ** -power


def _shares(w, axis=1):
    return w / w.sum(axis=axis, keepdims=True)


EXERCISE = Exercise(
    number=16,
    title="Weights of probes, and points that follow them",
    equations=("7.9",),
    functions=(
        Function(
            "weights",
            library="lietool.deform.weights.shepard",
            starter="return np.full((len(points), len(centres)), np.nan)",
        ),
        Function(
            "deform",
            library="lietool.deform.move.solve",
            call=_reference,
            starter="return np.full((len(points), 3), np.nan)",
        ),
    ),
    checks=(
        Check("weights of points", 1, cases=_few),
        Check("weights at probes and far away", 1, cases=_at_probes),
        Check("one probe", 1, cases=_one),
        Check("several probes", 2, cases=_several),
        Check("laws", 2, law=_laws),
        Check("hard inputs", 1, cases=_hard),
    ),
    picture=Picture("B7.3", 2, _shown),
    mutants=("weights.inverse_distance", "weights.partition_of_unity"),
    mistakes=(
        Mistake(
            "no care at the probes",
            "At the centre of a probe this divides by 0: there the weight is 1 for that probe and 0 for the "
            "others.",
            {"weights": lambda *args: _shares(_powers(*args))},
        ),
        Mistake(
            "not divided",
            "These weights do not sum to 1: divide those of each point by their sum over the probes.",
            {"weights": _powers},
        ),
        Mistake(
            "divided by the sum over the points",
            "The weights of a probe at all points sum to 1 here; those of all probes at a point should: "
            "sum along the other axis.",
            {"weights": lambda *args: _shares(_powers(*args), axis=0)},
        ),
        Mistake(
            "as printed",
            "This is (7.9) as it is printed: it depends on where the origin of the coordinates is. See each "
            "motion from the centre of its probe, t = A c - c, and blend the centres: `lietool errata 7.9`.",
            {"deform": _deformer("world", seen=False)},
        ),
        Mistake(
            "shift for t",
            "The translation is that of the origin of the coordinates; about its centre a probe moves by "
            "t_i = A_i c_i - c_i.",
            {"deform": _deformer(seen=False)},
        ),
        Mistake(
            "the mean of the centres",
            "The centre c of a point is the mean of the probes' centres by the weights at this point; here "
            "all count alike.",
            {"deform": _deformer("mean")},
        ),
        Mistake(
            "points",
            "This moves the point by every probe and takes the mean of the places, the linear blend, which "
            "flattens what turns: (7.9) adds up the parameters.",
            {"deform": _each},
        ),
        Mistake(
            "turned back",
            "The blend turns by -x: the rotation matrices are transposed.",
            {"deform": _deformer(turn=-1.0)},
        ),
    ),
)
