"""The ways of blending affine transformations that the texts compare, each from weights and matrices.

What the weights lack of 1 belongs to the identity, for every way: weights of 0
give the identity, one weight w of one transformation is its "w-fold", and
adding (1 - sum of w, I) changes nothing.  For the ways by a linear space of
parameters, (K 9), this is so of itself.  Weights outside [0, 1] extrapolate:

    linear                 can be singular or turn inside out
    polar_quaternion       goes on along the arc; the stretch can become singular
    polar_dual_quaternion  nears a limit less than a half turn on; the stretch can become singular
    grassia                goes on turning; the stretch can become singular
    alexa, phi_so, phi_se  never singular

`WAYS` names them all.  Under a change of the coordinates, A -> G A from the
left or A -> A G from the right, with weights of sum 1, the blend follows

    linear                 for every G, from both sides
    polar_quaternion       for rigid G from the left, for rotations from the right
    polar_dual_quaternion  the same, and among rigid A for rigid G from both sides
    grassia, phi_so        for translations from the left only
    alexa, phi_se          for neither

but A -> G A G^-1 is followed by `linear` and `alexa` for every G, by the others
for rotations, and among rigid A by the dual quaternions and `phi_se` for rigid G.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import aff, aff_kernels, affine, blocks, checks, dual_kernels, kernels, polar, so3
from lietool.lie.blend_checks import arguments, oriented
from lietool.lie.dual_checks import unvanished

Array = NDArray[np.float64]


def _sum(weights: Array, x: Array) -> Array:
    return np.einsum("...k,...ki->...i", weights, x)


def _with_identity(weights: Array, x: Array, identity: Array) -> tuple[Array, Array]:
    """Append what the weights lack of 1, and the identity which it weighs; x is (..., k, n)."""
    missing = 1.0 - np.sum(weights, axis=-1, keepdims=True)
    last = np.broadcast_to(identity, (*x.shape[:-2], 1, x.shape[-1]))
    return np.concatenate([weights, missing], axis=-1), np.concatenate([x, last], axis=-2)


def _linear_sum(weights: Array, M: Array) -> Array:
    """Return the weighted sum of matrices (..., k, n, n), the identity taking what the weights lack."""
    n = M.shape[-1]
    w, m = _with_identity(weights, M.reshape(*M.shape[:-2], n * n), np.eye(n).ravel())
    total = _sum(w, m)
    return total.reshape(*total.shape[:-1], n, n)


def _assembled(R: Array, S: Array, t: Array) -> Array:
    """Return the homogeneous matrix of p -> R S p + t."""
    L = R @ S
    A = np.zeros((*L.shape[:-2], 4, 4))
    A[..., :3, :3], A[..., :3, 3], A[..., 3, 3] = L, t, 1.0
    return A


def linear(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend the matrices themselves: the sum of w_i A_i. A blend of rotations shrinks, and can collapse.

    Kaji-Ochiai: 6

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), affine
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine or a weight is not finite.
    """
    w, a = arguments("blend.linear", weights, A, check)
    total = _linear_sum(w, a)
    total[..., 3, :] = np.eye(4)[3]
    return total


def polar_quaternion(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend A = R S with the rotations on the sphere of quaternions, stretch and translation linearly.

    For two it is slerp (Shoemake and Duff 1992).  For more it is one step of the
    spherical average (Buss and Fillmore 2001) from the normalised sum, by |w_i|
    lest negative weights cancel; signs as the first's: no turn above a half turn.

    Book: (2.32), (3.11), 5.1
    Kaji-Ochiai: 2, 6

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), Aff+
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine with det > 0, a weight is not finite, or the
        quaternions cancel each other.
    """
    where = "blend.polar_quaternion"
    w, a = oriented(where, weights, A, check)
    R, S = polar.decompose(a[..., :3, :3], check=False)
    q = blocks.run(kernels.quaternion, (4,), (R, 2))
    q = q * np.where(np.sum(q * q[..., :1, :], axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    v, q = _with_identity(w, q, np.array([1.0, 0.0, 0.0, 0.0]))
    start = unvanished(where, v, _sum(np.abs(v), q), 4)
    back = start[..., None, :] * np.array([1.0, -1.0, -1.0, -1.0])
    ahead = blocks.run(lambda p, q: kernels.quaternion_log(kernels.product(p, q)), (3,), (back, 1), (q, 1))
    step = _sum(v, ahead)
    mean = blocks.run(lambda p, x: kernels.product(p, kernels.quaternion_exp(x)), (4,), (start, 1), (step, 1))
    return _assembled(
        blocks.run(kernels.matrix, (3, 3), (mean, 1)), _linear_sum(w, S), _sum(w, a[..., :3, 3])
    )


def polar_dual_quaternion(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend A = M S with the rigid M by dual quaternion linear blending, the stretch linearly.

    Turn and translation go together, along a screw.  The signs are aligned to
    that of the first, so no turn exceeds a half turn (Kavan et al. 2008).

    Book: 2.8, (3.11)
    Kaji-Ochiai: 2, 4.4

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), Aff+
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine with det > 0, a weight is not finite, or the
        quaternions cancel each other.
    """
    where = "blend.polar_dual_quaternion"
    w, a = oriented(where, weights, A, check)
    R, S = polar.decompose(a[..., :3, :3], check=False)
    q = blocks.run(
        lambda R, t: dual_kernels.from_translation(kernels.quaternion(R), t), (8,), (R, 2), (a[..., :3, 3], 1)
    )
    cosine = np.sum(q[..., :4] * q[..., :1, :4], axis=-1, keepdims=True)
    v, q = _with_identity(w, q * np.where(cosine < 0.0, -1.0, 1.0), np.eye(8)[0])
    total = unvanished(where, v, _sum(v, q), 4)
    M = blocks.run(lambda q: dual_kernels.matrix(dual_kernels.normalized(q)), (4, 4), (total, 1))
    return _assembled(M[..., :3, :3], _linear_sum(w, S), M[..., :3, 3])


def grassia(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend A = R S with the rotations by their logarithms in so(3), stretch and translation linearly.

    Book: (3.11)
    Kaji-Ochiai: 4.4, 6, after Grassia 1998

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), Aff+
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine with det > 0 or a weight is not finite.
    """
    w, a = oriented("blend.grassia", weights, A, check)
    R, S = polar.decompose(a[..., :3, :3], check=False)
    x = _sum(w, so3.log(R, check=False))
    return _assembled(so3.exp(x, check=False), _linear_sum(w, S), _sum(w, a[..., :3, 3]))


def alexa(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend the logarithms in aff(3): exp of the sum of w_i log A_i (Alexa 2002).

    Not every transformation has one: see `aff.log`.  It is checked always,
    whatever `check` says.

    Book: 4.3 (x)
    Kaji-Ochiai: 2, 6

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), affine exponential
        With real logarithms.
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine or has no real logarithm, naming all that have
        none, or a weight is not finite.
    """
    w, a = arguments("blend.alexa", weights, A, check)
    X, exists = aff_kernels.real_log(a.reshape(-1, 4, 4))
    if not np.all(exists):
        exists = exists.reshape(a.shape[:-2])
        missing = [tuple(int(i) for i in index) for index in np.argwhere(~exists)]
        got = f"none for {len(missing)} of {exists.size}"
        if len(missing) > 1:
            got += (
                ": " + ", ".join(str(index) for index in missing[:8]) + (", ..." if len(missing) > 8 else "")
            )
        values = ", ".join(f"{x:.4g}" for x in np.linalg.eigvals(a[missing[0]][:3, :3]))
        got += f"; eigenvalues {values}"
        checks.fail("blend.alexa", "A", "transformations with a real logarithm", got, missing[0], aff.REMEDY)
    total = _sum(w, X.reshape(*a.shape[:-2], 16))
    return aff.exp(total.reshape(*total.shape[:-1], 4, 4), check=check)


def phi_so(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend in R^3 x so(3) x sym(3): `affine.phi_so` of the sum of w_i psi_so(A_i).

    Kaji-Ochiai: (9)

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), Aff+
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine with det > 0 or a weight is not finite.
    """
    w, a = oriented("blend.phi_so", weights, A, check)
    return affine.phi_so(_sum(w, affine.psi_so(a, check=False)), check=check)


def phi_se(weights: ArrayLike, A: ArrayLike, *, check: bool = True) -> Array:
    """Blend in se(3) x sym(3): `affine.phi_se` of the sum of w_i psi_se(A_i).

    Book: (7.9)
    MEIS: (5), corrected: phi of the sum, not the sum of phi

    Parameters
    ----------
    weights : (..., k)
    A : (..., k, 4, 4), Aff+
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If an A is not affine with det > 0 or a weight is not finite.
    """
    w, a = oriented("blend.phi_se", weights, A, check)
    return affine.phi_se(_sum(w, affine.psi_se(a, check=False)), check=check)


WAYS: dict[str, Callable[..., Array]] = {
    "linear": linear,
    "polar_quaternion": polar_quaternion,
    "polar_dual_quaternion": polar_dual_quaternion,
    "grassia": grassia,
    "alexa": alexa,
    "phi_so": phi_so,
    "phi_se": phi_se,
}
"""Every way of blending by its name, in the order of the texts."""
