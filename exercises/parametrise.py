r"""Affine transformations as points of a linear space.

An affine transformation of space is a matrix

$$\hat A = \begin{pmatrix} A & \mathbf{d} \\ 0 & 1 \end{pmatrix}, \qquad \det A > 0.$$

It can be said by 12 numbers that may be any: a rotation vector $\mathbf{x}$, with $X\mathbf{p} =
\mathbf{x}\times\mathbf{p}$, a vector $\mathbf{l}$, and a symmetric matrix $Y$:

$$\varphi(\mathbf{x}, \mathbf{l}, Y) = \exp(\hat X)\,\iota(\exp Y), \qquad
  \hat X = \begin{pmatrix} X & \mathbf{l} \\ 0 & 0 \end{pmatrix}, \qquad
  \iota(S) = \begin{pmatrix} S & 0 \\ 0 & 1 \end{pmatrix}. \qquad (7.1)$$

First the stretch, then the motion. With $\theta = |\mathbf{x}|$ the motion $\exp(\hat X)$ has the rotation
and the translation

$$R = I + \frac{\sin\theta}{\theta} X + \frac{1 - \cos\theta}{\theta^2} X^2, \qquad
  \mathbf{d} = \Big(I + \frac{1 - \cos\theta}{\theta^2} X + \frac{\theta - \sin\theta}{\theta^3} X^2\Big)\,
  \mathbf{l}. \qquad (7.4), (7.5)$$

Back it goes by the polar decomposition $A = R S$, with $S = \sqrt{A^T A}$:

$$\psi(\hat A) = \big(\log(\hat A\;\iota(S)^{-1}),\ \log S\big). \qquad (7.2)$$

Write `phi(x, ell, Y)` and `psi(A)`, which returns the tuple `x, ell, Y` with $|\mathbf{x}| \le \pi$; `ell`
is $\mathbf{l}$. Angles are in radians. Both take batches: vectors of shape `(..., 3)`, symmetric matrices of
shape `(..., 3, 3)`, affine matrices of shape `(..., 4, 4)`. The rotation may be tiny, or nearly half a turn,
and the factors of the stretch very different from each other. What $\psi$ has no value for is refused with a
`ValueError`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def phi(x, ell, Y):
    """Return the affine transformation that stretches by exp(Y), then moves by the exponential of (x, l).

    Parameters
    ----------
    x : ndarray, shape (..., 3)
        Rotation vectors.
    ell : ndarray, shape (..., 3)
        Translation parts.
    Y : ndarray, shape (..., 3, 3)
        Symmetric matrices.

    Returns
    -------
    ndarray, shape (..., 4, 4)
        The matrices of (7.1).
    """
    x, ell, Y = (np.asarray(part, float) for part in (x, ell, Y))
    theta, X = np.linalg.norm(x, axis=-1)[..., None, None], cross_matrix(x)
    sine, rest = np.sinc(theta / np.pi), 0.5 * np.sinc(theta / (2.0 * np.pi)) ** 2
    R = np.eye(3) + sine * X + rest * X @ X
    V = np.eye(3) + rest * X + past_sine(theta) * X @ X
    A = np.zeros((*np.broadcast_shapes(x.shape, ell.shape, Y.shape[:-1])[:-1], 4, 4))
    A[..., :3, :3] = R @ of_symmetric(Y, np.exp)
    A[..., :3, 3] = np.einsum("...ij,...j->...i", V, ell)
    A[..., 3, 3] = 1.0
    return A


def psi(A):
    """Return what phi makes an affine transformation of, with a rotation of at most half a turn.

    Parameters
    ----------
    A : ndarray, shape (..., 4, 4)
        Affine matrices with det A > 0.

    Returns
    -------
    x : ndarray, shape (..., 3)
        Rotation vectors, of length at most pi.
    ell : ndarray, shape (..., 3)
        Translation parts.
    Y : ndarray, shape (..., 3, 3)
        Symmetric matrices.

    Raises
    ------
    ValueError
        If det A is not positive, the last row is not 0 0 0 1, or a number is not finite.
    """
    A = np.asarray(A, float)
    if not np.isfinite(A).all() or np.any(A[..., 3, :] != [0.0, 0.0, 0.0, 1.0]):
        raise ValueError("A must be affine: finite numbers, and 0 0 0 1 in the last row")
    # A^T A would square the ratio of the factors.
    U, sizes, Vt = np.linalg.svd(A[..., :3, :3])
    R = U @ Vt
    if np.any(sizes[..., 2] == 0.0) or np.any(np.linalg.det(R) < 0.0):
        raise ValueError("det A must be positive")
    Y = np.swapaxes(Vt, -1, -2) @ (np.log(sizes)[..., None] * Vt)
    x = rotation_vector(R)
    return x, set_out(x, A[..., :3, 3]), Y


def set_out(x, d):
    """Return the l of (7.8), with which a screw motion by x carries the origin to d."""
    theta, X = np.linalg.norm(x, axis=-1)[..., None, None], cross_matrix(x)
    # Its last factor is also (1 - (theta/2) cot(theta/2)) / theta^2, which is good at pi.
    far = np.where(theta > 0.1, theta, 1.0)
    near = 1.0 / 12.0 + theta**2 / 720.0 + theta**4 / 30240.0 + theta**6 / 1209600.0
    last = np.where(theta > 0.1, (1.0 - 0.5 * far / np.tan(0.5 * far)) / far**2, near)
    return np.einsum("...ij,...j->...i", np.eye(3) - 0.5 * X + last * X @ X, d)


def cross_matrix(x):
    """Return the matrix X of p -> x cross p, shape (..., 3, 3)."""
    a, b, c = np.moveaxis(x, -1, 0)
    o = np.zeros_like(a)
    return np.stack([o, -c, b, c, o, -a, -b, a, o], axis=-1).reshape(*x.shape, 3)


def past_sine(theta):
    """Return (theta - sin theta) / theta^3."""
    far = np.where(theta > 0.1, theta, 1.0)
    near = 1.0 / 6.0 - theta**2 / 120.0 + theta**4 / 5040.0 - theta**6 / 362880.0
    return np.where(theta > 0.1, (far - np.sin(far)) / far**3, near)


def of_symmetric(Y, function):
    """Return a function of symmetric matrices, by their eigenvalues."""
    values, Q = np.linalg.eigh(Y)
    return Q * function(values)[..., None, :] @ np.swapaxes(Q, -1, -2)


def rotation_vector(R):
    """Return the axis of rotations times their angle, 0 to pi; shape (..., 3)."""
    # The quaternion is the eigenvector of a matrix that is linear in R, at every angle equally good.
    skew = np.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1
    )
    trace = np.trace(R, axis1=-2, axis2=-1)
    M = np.zeros((*R.shape[:-2], 4, 4))
    M[..., 0, 0], M[..., 0, 1:], M[..., 1:, 0] = trace, skew, skew
    M[..., 1:, 1:] = R + np.swapaxes(R, -1, -2) - trace[..., None, None] * np.eye(3)
    q = np.linalg.eigh(M)[1][..., 3]
    q = q * np.where(q[..., :1] < 0.0, -1.0, 1.0)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    return 2.0 * np.arctan2(sine, q[..., :1]) * q[..., 1:] / np.where(sine > 0.0, sine, 1.0)


def _vectors(rng, *shape, length=None):
    u = rng.normal(size=(*shape, 3))
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    return u * (rng.uniform(0.2, 2.8, (*shape, 1)) if length is None else length)


def _symmetric(rng, *shape):
    M = rng.normal(size=(*shape, 3, 3))
    return 0.25 * (M + np.swapaxes(M, -1, -2))


def _given(rng, *shape, length=None):
    return _vectors(rng, *shape, length=length), rng.uniform(-2.0, 2.0, (*shape, 3)), _symmetric(rng, *shape)


_Z = np.array([0.0, 0.0, 1.0])
_NO = np.zeros(3), np.zeros((3, 3))


def _phis(rng):
    yield Case("a quarter of a turn about z", (np.pi / 2.0 * _Z, *_NO), "phi")
    yield Case("a screw: half a turn about z, rising by 3", (np.pi * _Z, 3.0 * _Z, _NO[1]), "phi")
    yield Case("a stretch along x", (_NO[0], _NO[0], np.diag([0.7, 0.0, 0.0])), "phi")
    for _ in range(3):
        yield Case("some parameters", _given(rng), "phi")
    yield Case("a batch of two by three", _given(rng, 2, 3), "phi")


def _psis(rng):
    yield Case("the identity", (np.eye(4),), "psi")
    yield Case("a stretch along x by 2", (np.diag([2.0, 1.0, 1.0, 1.0]),), "psi")
    for _ in range(3):
        yield Case("some affine transformation", (phi(*_given(rng)),), "psi")
    yield Case("a batch of two by three", (phi(*_given(rng, 2, 3)),), "psi")


def _laws(f, rng):
    given = _given(rng)
    A = f.phi(*given)
    for name, part, wanted in zip("xlY", f.psi(A), given, strict=True):
        yield Claim(f"psi(phi(x, l, Y)) has the same {name}", part, wanted, given)
    x, _, Y = beyond = _given(rng, length=4.0)
    A = f.phi(*beyond)
    back = f.psi(A)
    yield Claim("phi(psi(A)) = A, also where x has come from beyond pi", f.phi(*back), A, (A,))
    yield Claim("det A = exp(tr Y)", np.linalg.det(A[:3, :3]), np.exp(np.trace(Y)), beyond)
    yield Claim("psi(A) has |x| <= pi", np.linalg.norm(back[0]), 2.0 * np.pi - np.linalg.norm(x), (A,))


def _hard(rng):
    for says, length in (("tiny rotations, 1e-7", 1e-7), ("rotations by 2e-3", 2e-3)):
        given = _given(rng, length=length)
        yield Case(says, given, "phi")
        yield Case(says, (phi(*given),), "psi")
    for says, angle in (("pi - 1e-3", np.pi - 1e-3), ("pi - 1e-8", np.pi - 1e-8)):
        yield Case(f"a rotation by {says}", (phi(*_given(rng, length=angle)),), "psi")
    yield Case("three turns and a bit", _given(rng, length=19.0), "phi")
    x, ell, _ = _given(rng)
    for says, logs in (("1e5, 1 and 1e-5", [11.5, 0.0, -11.5]), ("1, 1 and 1e-7", [0.0, 0.0, -16.1])):
        yield Case(f"factors of stretch {says}", (phi(x, ell, np.diag(logs)),), "psi")
    yield Case("the same factor along all axes", (phi(x, ell, 0.8 * np.eye(3)),), "psi")


def _bad(rng):
    A = phi(*_given(rng))
    yield Case("a mirror image", (np.diag([-1.0, 1.0, 1.0, 1.0]) @ A,), "psi", raises=True)
    yield Case("a map onto a plane, det A = 0", (np.diag([1.0, 1.0, 0.0, 1.0]),), "psi", raises=True)
    yield Case("a last row 0 0 1 1", (np.eye(4) + np.outer([0, 0, 0, 1], [0, 0, 1, 0]),), "psi", raises=True)
    yield Case("a batch with one nan", (np.stack([A, np.nan * A]),), "psi", raises=True)


_I, _J = np.triu_indices(3)


def _joined(x, ell, Y):
    return np.concatenate([x, ell, np.asarray(Y)[..., _I, _J]], axis=-1)


def _apart(params):
    Y = np.zeros((*np.shape(params)[:-1], 3, 3))
    Y[..., _I, _J] = Y[..., _J, _I] = params[..., 6:]
    return params[..., :3], params[..., 3:6], Y


def _printed(A):
    """Psi with the angle of (7.6) as it is printed."""
    x, _, Y = psi(A)
    R = _rotation(x)
    with np.errstate(all="ignore"):
        theta = np.arccos(0.5 * np.trace(R, axis1=-2, axis2=-1))[..., None, None]
        X = theta / (2.0 * np.sin(theta)) * (R - np.swapaxes(R, -1, -2))
        x = np.stack([X[..., 2, 1], X[..., 0, 2], X[..., 1, 0]], axis=-1)
        return x, set_out(x, np.asarray(A, float)[..., :3, 3]), Y


def _psi_of(other):
    """Return a wrong psi, which makes others of the right x, ell, Y and of d."""
    return lambda A: other(*psi(A), np.asarray(A, float)[..., :3, 3])


def _rotation(x):
    return phi(x, 0.0 * x, np.zeros((3, 3)))[..., :3, :3]


EXERCISE = Exercise(
    number=15,
    title="Affine transformations as points of a linear space",
    equations=("7.1", "7.2", "7.4", "7.5", "7.6", "7.7", "7.8"),
    functions=(
        Function(
            "phi",
            library="lietool.lie.affine.phi_se",
            call=lambda function, x, ell, Y: function(_joined(x, ell, Y)),
            starter="return np.full((*np.shape(x)[:-1], 4, 4), np.nan)",
        ),
        Function(
            "psi",
            library="lietool.lie.affine.psi_se",
            call=lambda function, A: _apart(function(A)),
            starter="empty = np.full((*np.shape(A)[:-2], 3, 3), np.nan)\n"
            "return empty[..., 0], empty[..., 0], empty",
        ),
    ),
    checks=(
        Check("phi", 1, cases=_phis),
        Check("psi", 2, cases=_psis),
        Check("laws of both", 1, law=_laws),
        Check("hard inputs", 2, cases=_hard),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture(
        "B7.1b",
        3,
        lambda f: {"phi_se": lambda p: f.phi(*_apart(p)), "psi_se": lambda A: _joined(*f.psi(A))},
    ),
    mutants=("affine.phi_", "affine.psi_se"),
    mistakes=(
        Mistake(
            "translation as it is",
            "Here l itself is the translation. In (7.1) it is where the origin sets out to, on its way along "
            "a screw, and d = V l by (7.5).",
            {"phi": lambda x, ell, Y: phi(x, set_out(x, ell), Y)},
        ),
        Mistake(
            "stretch last",
            "The factors are exchanged: (7.1) stretches first, and for column vectors what comes first "
            "stands on the right, exp(X) iota(exp Y).",
            {"phi": lambda x, ell, Y: phi(0.0 * x, 0.0 * ell, Y) @ phi(x, ell, 0.0 * Y)},
        ),
        Mistake(
            "rotation backwards",
            "The rotation goes the other way: X p is the cross product x x p, and has -x3 in its first row.",
            {"phi": lambda x, ell, Y: phi(-x, ell, Y)},
        ),
        Mistake(
            "the printed (7.6)",
            "The angle is that of (7.6) as it is printed. tr R = 1 + 2 cos(theta), so that theta is the arc "
            "cosine of (tr R - 1) / 2: see `lietool errata 7.6`.",
            {"psi": _printed},
        ),
        Mistake(
            "l is d",
            "l is taken for the translation d. By (7.5) d = V l, and (7.8) gives l = V^-1 d.",
            {"psi": _psi_of(lambda x, ell, Y, d: (x, d, Y))},
        ),
        Mistake(
            "twice Y",
            "This is log(A^T A), twice the logarithm of S = sqrt(A^T A).",
            {"psi": _psi_of(lambda x, ell, Y, d: (x, ell, 2.0 * Y))},
        ),
        Mistake(
            "stretch on the left",
            "This is the logarithm of sqrt(A A^T), that of A = S R. In (7.2) A = R S, S = sqrt(A^T A).",
            {"psi": _psi_of(lambda x, ell, Y, d: (x, ell, _rotation(x) @ Y @ _rotation(-x)))},
        ),
        Mistake(
            "x backwards",
            "This is -x: R - R^T = 2 sin(theta) X, (7.7), and X has x3 in its second row, first column.",
            {"psi": _psi_of(lambda x, ell, Y, d: (-x, ell, Y))},
        ),
    ),
)
