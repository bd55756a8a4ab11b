"""The polar decomposition.

A matrix $A$ with $\\det A > 0$ is, in exactly one way, a stretch along axes at right angles and after it a
rotation,

$$A = R\\, S, \\qquad (3.11)$$

where $R$ is a rotation, $R^T R = 1$ and $\\det R = 1$, and $S$ is symmetric with positive eigenvalues. So
$S^2 = A^T A$. With the singular value decomposition (3.14), $A = U D V^T$, all of it can be read off.

Write `decompose(A)`, which returns $R$ and $S$, for matrices of the plane and of space. A matrix that
flattens ($\\det A = 0$) or reflects ($\\det A < 0$) has no such decomposition: refuse it with a `ValueError`,
also where it is one of many.

Matrices act on column vectors. Many come at once: whatever axes there are before the last two are kept.

The picture has the disc after $S$ and after $R$: both matrices come from your function.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def decompose(A):
    """Return the rotation and the stretch of A = R S.

    Parameters
    ----------
    A : ndarray, shape (..., n, n)
        Matrices, n = 2 or 3.

    Returns
    -------
    R : ndarray, shape (..., n, n)
        Rotations.
    S : ndarray, shape (..., n, n)
        Symmetric, with positive eigenvalues.

    Raises
    ------
    ValueError
        If the determinant of a matrix is not positive.
    """
    A = np.asarray(A, dtype=float)
    if not np.all(np.linalg.det(A) > 0.0):
        raise ValueError("A must have det A > 0: it flattens or reflects")
    # Not the root of A^T A, in which the small singular values are lost.
    U, d, Vt = np.linalg.svd(A)
    V = np.swapaxes(Vt, -1, -2)
    return U @ Vt, (V * d[..., None, :]) @ Vt


def _turns(rng, n, *shape):
    """Random rotations."""
    Q = np.linalg.qr(rng.normal(size=(*shape, n, n)))[0]
    Q[..., 0] *= np.sign(np.linalg.det(Q))[..., None]
    return Q


def _stretched(rng, d, *shape):
    """Random matrices with det > 0 and the singular values d."""
    n = len(d)
    return (_turns(rng, n, *shape) * np.asarray(d, dtype=float)) @ np.swapaxes(_turns(rng, n, *shape), -1, -2)


def _ordinary(rng):
    yield Case("the matrix of the picture", (np.array([[0.9, -0.3], [1.0, 1.0]]),))
    yield Case("a shear of the plane", (np.array([[1.0, 1.5], [0.0, 1.0]]),))
    yield Case("a matrix of the plane", (_stretched(rng, (1.7, 0.4)),))
    yield Case("a matrix of space", (_stretched(rng, (2.1, 1.2, 0.3)),))
    yield Case("stretches along the axes", (np.diag([2.0, 0.5, 3.0]),))


def _batches(rng):
    yield Case("five of space", (_stretched(rng, (1.5, 1.0, 0.6), 5),))
    yield Case("two rows of three of the plane", (_stretched(rng, (2.0, 0.7), 2, 3),))
    yield Case("none at all", (np.zeros((0, 3, 3)),))


def _laws(f, rng):
    for n, d in ((2, (1.9, 0.3)), (3, (2.2, 0.9, 0.4))):
        A, one = _stretched(rng, d), np.eye(n)
        R, S = f.decompose(A)
        yield Claim("R S = A", R @ S, A, (A,))
        yield Claim("R^T R = 1", R.T @ R, one, (A,))
        yield Claim("det R = 1", np.linalg.det(R), 1.0, (A,))
        yield Claim("S = S^T", S, S.T, (A,))
        yield Claim("S^2 = A^T A", S @ S, A.T @ A, (A,))
        yield Claim("S stretches by the singular values of A", np.linalg.eigvalsh(S)[::-1], np.array(d), (A,))
    A, Q = _stretched(rng, (2.2, 0.9, 0.4)), _turns(rng, 3)
    R, S = f.decompose(Q @ A)
    yield Claim("a rotation Q after A only turns R: Q R", R, Q @ f.decompose(A)[0], (A, Q))
    yield Claim("a rotation Q after A leaves S", S, f.decompose(A)[1], (A, Q))


def _hard(rng):
    yield Case("a rotation, nothing to stretch", (_turns(rng, 3),))
    yield Case("a half turn and twice the size", (np.diag([-2.0, -2.0]),))
    yield Case("two equal stretches", (_stretched(rng, (2.0, 2.0, 0.5)),))
    yield Case(
        "nearly flat, 1 : 1e-6; the squares in A^T A are 1 : 1e-12", (_stretched(rng, (1.0, 0.6, 1e-6)),)
    )
    yield Case("nearly flat in the plane, 1 : 1e-7", (_stretched(rng, (1.0, 1e-7)),))
    yield Case("very large, 1e30", (_stretched(rng, (2e30, 1e30, 0.5e30)),))
    yield Case("very small, 1e-30", (_stretched(rng, (2e-30, 1e-30, 0.5e-30)),))


def _refused(rng):
    yield Case("a reflection of the plane", (np.diag([1.0, -1.0]),), raises=True)
    yield Case("space inside out", (-_stretched(rng, (1.4, 1.0, 0.7)),), raises=True)
    yield Case("a projection to a plane", (np.diag([1.0, 0.0, 1.0]),), raises=True)
    yield Case("all zeros", (np.zeros((2, 2)),), raises=True)
    many = _stretched(rng, (1.4, 0.7), 4)
    many[2, 0] *= -1.0
    yield Case("one reflection among three others", (many,), raises=True)


def _factors(A):
    U, d, Vt = np.linalg.svd(A)
    return U, d, Vt, np.swapaxes(Vt, -1, -2)


def _square_for_stretch(A):
    A = np.asarray(A, dtype=float)
    S = np.swapaxes(A, -1, -2) @ A
    return A @ np.linalg.inv(S), S


def _root_of_entries(A):
    A = np.asarray(A, dtype=float)
    S = np.sqrt(np.swapaxes(A, -1, -2) @ A)
    return A @ np.linalg.inv(S), S


def _not_transposed(A):
    U, d, Vt, V = _factors(A)
    return U @ V, (Vt * d[..., None, :]) @ V


def _orthogonal_and_triangular(A):
    Q, T = np.linalg.qr(A)
    return Q, T


def _exchanged(A):
    U, d, Vt, V = _factors(A)
    return (V * d[..., None, :]) @ Vt, U @ Vt


_MISTAKES = (
    Mistake(
        "no root",
        "The root is missing: this S is A^T A, which stretches by the squares of the singular values; "
        "S^2 = A^T A, (3.11).",
        {"decompose": _square_for_stretch},
    ),
    Mistake(
        "root of the entries",
        "The root of a matrix is not that of its entries: S is V D V^T, where A^T A = V D^2 V^T.",
        {"decompose": _root_of_entries},
    ),
    Mistake(
        "V for V^T",
        "V and V^T are exchanged: `np.linalg.svd` returns V^T, the third factor of A = U D V^T as it stands "
        "in (3.14), so R = U V^T is the product of its first and its third result.",
        {"decompose": _not_transposed},
    ),
    Mistake(
        "Q R",
        "This is the QR decomposition: its second factor is triangular. S of (3.11) is symmetric.",
        {"decompose": _orthogonal_and_triangular},
    ),
    Mistake("S, R", "R and S are exchanged: return R first, then S.", {"decompose": _exchanged}),
)

EXERCISE = Exercise(
    number=7,
    title="The polar decomposition",
    equations=("3.11",),
    functions=(
        Function(
            "decompose",
            library="lietool.lie.polar.decompose",
            starter="return np.full(np.shape(A), np.nan), np.full(np.shape(A), np.nan)",
        ),
    ),
    checks=(
        Check("ordinary matrices", 2, cases=_ordinary),
        Check("many at once", 1, cases=_batches),
        Check("laws: what R and S are", 2, law=_laws),
        Check("hard inputs", 2, cases=_hard),
        Check("what has none is refused", 1, cases=_refused),
    ),
    picture=Picture("B3.3b", 2, lambda f: {"polar": f.decompose}),
    mutants=("polar.decompose",),
    mistakes=_MISTAKES,
)
