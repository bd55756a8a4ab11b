"""The ways of blending transformations: to parameters, a weighted sum, back; an argument of every deformer.

A way turns each A_i into a list of numbers, 0 for the identity; these are
summed by weights, and the sum is turned into a transformation.  So what the
weights lack of 1 belongs to the identity.  `encode` is done once for each pose,
the weighted sum is one matrix product for all points, and `move` applies the
transformation of each point to it without storing a matrix.

    linear            the entries of A - I
    polar_quaternion  A = R S: q - 1 with Re q >= 0, t, S - I; the sum of q is normalised
    dual_quaternion   A = M S: the dual quaternion of M less 1, Re >= 0, and S - I
    alexa             the principal logarithm in aff(3); not every A has one
    phi_so            x, l, Y of Kaji and Ochiai, the only one that keeps whole turns
    phi_se            x, l, Y of the book

`lie.blend` has the finer blends of a few transformations (the spherical
average, signs by the first); linear, alexa, phi_so and phi_se are the same.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import way_kernels
from lietool.lie import aff_kernels, affine_kernels, blocks, checks, kernels, matrix_checks, polar
from lietool.lie.dual_checks import counted

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_UPPER = ([0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2])


@dataclass(frozen=True)
class Way:
    """A way of blending: to parameters, and back from their weighted sum.

    `encode(A)` of (..., 4, 4) gives the parameters (..., width) and where there
    are any (...); `decode(params)` gives (..., 4, 4).  `parts` are the columns
    of rotation, translation and stretch where the way keeps them apart, so that
    each may have weights of its own.  `whole_turns`: rotation vectors beyond pi mean something.
    """

    name: str
    encode: Callable[[ArrayLike], tuple[Array, Mask]]
    decode: Callable[[ArrayLike], Array]
    decode_linear: Callable[[ArrayLike], Array]
    width: int
    kernel: way_kernels.Move = field(repr=False)
    parts: tuple[slice, slice, slice] | None = None
    whole_turns: bool = False


@dataclass(frozen=True)
class Blend:
    """Blended transformations (..., 4, 4), and where the polar blend stands in for the way's (...)."""

    A: Array
    fallback: Mask


def _oriented(name: str, A: ArrayLike) -> Array:
    """Return A as homogeneous matrices with det > 0."""
    where = f"ways.{name}"
    a = matrix_checks.affine(where, "A", checks.array(where, "A", A, (4, 4)))
    if a.size:
        L = a[..., :3, :3]
        size = np.max(np.abs(L), axis=(-1, -2), keepdims=True)
        det = np.linalg.det(L / np.where(size > 0.0, size, 1.0))
        if not np.min(det) > 0.0:
            index = checks.first(~(det > 0.0))
            got, must = f"det = {np.linalg.det(L[index]):.3g}", "matrices with det > 0"
            checks.fail(where, "A", must, got, index, "Take orientation.nearest(A), or leave it out.")
    return a


def _everywhere(params: Array) -> Mask:
    return np.ones(params.shape[:-1], dtype=bool)


def _encode_linear(A: ArrayLike) -> tuple[Array, Mask]:
    a = matrix_checks.affine("ways.linear", "A", checks.array("ways.linear", "A", A, (4, 4)))
    params = (a - np.eye(4))[..., :3, :].reshape(*a.shape[:-2], 12)
    return params, _everywhere(params)


def _encode_alexa(A: ArrayLike) -> tuple[Array, Mask]:
    a = _oriented("alexa", A)
    X, exists = aff_kernels.real_log(a.reshape(-1, 4, 4))
    return X[:, :3].reshape(*a.shape[:-2], 12), exists.reshape(a.shape[:-2])


def _encode_phi(name: str, kernel: Callable[[Array], blocks.Rows], A: ArrayLike) -> tuple[Array, Mask]:
    params = blocks.run(kernel, (12,), (_oriented(name, A), 2))
    _resolved(name, params)
    return params, _everywhere(params)


def _resolved(name: str, params: Array) -> None:
    """Refuse matrices so nearly flat that rounding has made their smallest singular value 0 or less."""
    if params.size and not np.all(np.isfinite(params[..., -1])):
        index = checks.first(~np.isfinite(params[..., -1]))
        checks.fail(f"ways.{name}", "A", "matrices with det > 0", "a determinant that is rounding", index)


def _polar(name: str, A: ArrayLike) -> tuple[Array, Array, Array]:
    """Return the unit quaternion with Re q >= 0, the upper triangle of S - I, and t."""
    a = _oriented(name, A)
    R, S = polar.decompose(a[..., :3, :3], check=False)
    q = blocks.run(kernels.quaternion, (4,), (R, 2))
    return q, (S - np.eye(3))[..., *_UPPER], a[..., :3, 3]


def _encode_polar_quaternion(A: ArrayLike) -> tuple[Array, Mask]:
    q, S, t = _polar("polar_quaternion", A)
    params = np.concatenate([q - np.eye(4)[0], t, S], axis=-1)
    return params, _everywhere(params)


def _encode_dual_quaternion(A: ArrayLike) -> tuple[Array, Mask]:
    q, S, t = _polar("dual_quaternion", A)
    w = blocks.run(lambda t, q: kernels.product([0.0 * t[0], *(0.5 * t)], q), (4,), (t, 1), (q, 1))
    params = np.concatenate([q - np.eye(4)[0], w, S], axis=-1)
    return params, _everywhere(params)


def _decode(name: str, width: int, size: int, kernel: way_kernels.Matrix, params: ArrayLike) -> Array:
    where = f"ways.{name}"
    p = checks.array(where, "params", params, (width,))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        A = blocks.run(kernel, (size, size), (p, 1))
    if A.size and not np.max(np.abs(A)) < np.inf:
        index = checks.first(~np.all(np.isfinite(A), axis=(-1, -2)))
        checks.fail(where, "params", *UNDONE, index)
    return A


UNDONE = (
    "such that their sum is a transformation",
    "quaternions that cancel each other or an exponential that overflows",
)


def _way(
    name: str,
    width: int,
    encode: Callable[[ArrayLike], tuple[Array, Mask]],
    matrix: way_kernels.Matrix,
    part: way_kernels.Matrix,
    move: way_kernels.Move,
    parts: tuple[slice, slice, slice] | None = None,
    whole_turns: bool = False,
) -> Way:
    decode, decode_linear = (
        partial(_decode, name, width, n, kernel) for n, kernel in ((4, matrix), (3, part))
    )
    return Way(name, encode, decode, decode_linear, width, move, parts, whole_turns)


_TWELVE = (slice(0, 3), slice(3, 6), slice(6, 12))

LINEAR = _way(
    "linear",
    12,
    _encode_linear,
    way_kernels.linear_matrix,
    way_kernels.linear_part,
    way_kernels.linear,
)
POLAR_QUATERNION = _way(
    "polar_quaternion",
    13,
    _encode_polar_quaternion,
    way_kernels.polar_quaternion_matrix,
    way_kernels.polar_quaternion_part,
    way_kernels.polar_quaternion,
    (slice(0, 4), slice(4, 7), slice(7, 13)),
)
DUAL_QUATERNION = _way(
    "dual_quaternion",
    14,
    _encode_dual_quaternion,
    way_kernels.dual_quaternion_matrix,
    way_kernels.dual_quaternion_part,
    way_kernels.dual_quaternion,
)
ALEXA = _way("alexa", 12, _encode_alexa, way_kernels.alexa_matrix, way_kernels.alexa_part, way_kernels.alexa)
PHI_SO = _way(
    "phi_so",
    12,
    partial(_encode_phi, "phi_so", affine_kernels.psi_so),
    way_kernels.phi_so_matrix,
    way_kernels.phi_part,
    way_kernels.phi_so,
    _TWELVE,
    whole_turns=True,
)
PHI_SE = _way(
    "phi_se",
    12,
    partial(_encode_phi, "phi_se", affine_kernels.psi_se),
    way_kernels.phi_se_matrix,
    way_kernels.phi_part,
    way_kernels.phi_se,
    _TWELVE,
)

WAYS: dict[str, Way] = {
    way.name: way for way in (LINEAR, POLAR_QUATERNION, DUAL_QUATERNION, ALEXA, PHI_SO, PHI_SE)
}
"""Every way of blending by its name, in the order of the texts."""


def named(name: str) -> Way:
    """Return the way of a name.

    Kaji-Ochiai: 6, which compares them

    Parameters
    ----------
    name : str

    Returns
    -------
    way : Way

    Raises
    ------
    ValueError
        If there is none of that name.
    """
    if name not in WAYS:
        raise ValueError(f"ways.named: name must be one of {', '.join(WAYS)}; got {name!r}.")
    return WAYS[name]


def mix(way: Way, weights: ArrayLike, params: ArrayLike) -> Array:
    """Blend transformations that are given by their parameters, which may hold rotations beyond pi.

    Book: (7.9)
    Kaji-Ochiai: (9)

    Parameters
    ----------
    way : Way
    weights : (..., k)
    params : (..., k, d)
        As many numbers as `way.width`.

    Returns
    -------
    A : (..., 4, 4)

    Raises
    ------
    ValueError
        If a number is not finite, the shapes do not go together, quaternions
        cancel each other, or an exponential overflows.
    """
    w, p = counted("ways.mix", weights, "params", params, (way.width,), check=True)
    return way.decode(_sum(w, p))


def _sum(weights: Array, x: Array) -> Array:
    """Return the weighted sums (..., d) of x (..., k, d)."""
    if x.ndim == 2:
        return weights @ x
    return (weights[..., None, :] @ x)[..., 0, :]


def blend(way: Way, weights: ArrayLike, A: ArrayLike) -> Blend:
    """Blend transformations by a way; by the polar one where it has no parameters for one that counts.

    Only alexa lacks any: where a matrix of weight other than 0 has no real logarithm.

    Book: (7.9)
    Kaji-Ochiai: (9)
    MEIS: (5), corrected: phi of the sum, not the sum of phi

    Parameters
    ----------
    way : Way
    weights : (..., k)
    A : (..., k, 4, 4)
        In Aff+; for `linear`, affine.

    Returns
    -------
    blend : Blend
        A (..., 4, 4) and fallback (...).

    Raises
    ------
    ValueError
        If a number is not finite, the shapes do not go together, an A is not
        affine, or has det <= 0 and the way is not linear, or quaternions cancel.
    """
    w, a = counted(f"ways.{way.name}", weights, "A", A, (4, 4), check=True)
    params, able = way.encode(a)
    fallback = np.any((w != 0.0) & ~able, axis=-1)
    mixed = _sum(w, params)
    if not np.any(fallback):
        return Blend(way.decode(mixed), fallback)
    mixed[fallback] = 0.0
    B = way.decode(mixed)
    other, _ = POLAR_QUATERNION.encode(a)
    if a.ndim > 3:
        other = np.broadcast_to(other, (*fallback.shape, *other.shape[-2:]))[fallback]
    B[fallback] = mix(POLAR_QUATERNION, np.broadcast_to(w, (*fallback.shape, w.shape[-1]))[fallback], other)
    return Blend(B, fallback)
