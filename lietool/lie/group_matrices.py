"""How to tell, to mend and to draw matrices of each group of `groups`; nothing here checks its input.

A closed condition (R^T R = I) holds up to a tolerance and is measured by `defect`; an open one
(det A > 0) holds or not and is `inside`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FLOOR = 2.0**-26
"""The smallest singular value, relative to the largest, that `groups.project` gives in an open set."""


@dataclass(frozen=True)
class Elements:
    """The elements of a group: how far from it, whether inside, the representative, and its operations."""

    defect: Callable[[Array], Array]
    inside: Callable[[Array], NDArray[np.bool_]]
    project: Callable[[Array], Array]
    generic: Callable[[Array], Array]
    multiply: Callable[[Array, Array], Array]
    inverse: Callable[[Array], Array]


def _largest(A: Array, axes: int) -> Array:
    return np.max(np.abs(A), axis=tuple(range(-axes, 0)))


def _transpose(A: Array) -> Array:
    return np.swapaxes(A, -1, -2)


def _eye(A: Array) -> Array:
    return np.broadcast_to(np.eye(A.shape[-1]), A.shape).copy()


def _inverse(A: Array) -> Array:
    return np.linalg.inv(A).astype(np.float64, copy=False)


def _none(A: Array) -> Array:
    return np.zeros(A.shape[:-2])


def _all(A: Array) -> NDArray[np.bool_]:
    return np.ones(A.shape[:-2], dtype=bool)


def positive(A: Array) -> NDArray[np.bool_]:
    """Tell whether the determinant is positive, by its sign alone: at scale 1e-150 its value would vanish."""
    return np.linalg.slogdet(A)[0] > 0


def _regular(A: Array) -> NDArray[np.bool_]:
    d = np.linalg.svd(A, compute_uv=False)
    return d[..., -1] > d.shape[-1] * np.finfo(float).eps * d[..., 0]


def _orthogonal_defect(A: Array) -> Array:
    return _largest(_transpose(A) @ A - np.eye(A.shape[-1]), 2)


def _scale(A: Array) -> Array:
    """Return c where A = c R: the root mean square of the singular values."""
    size = _largest(A, 2)[..., None, None]
    unit = A / np.where(size > 0.0, size, 1.0)
    return size * np.sqrt(np.sum(unit * unit, axis=(-1, -2), keepdims=True) / A.shape[-1])


def _conformal_defect(A: Array) -> Array:
    c = _scale(A)
    return _orthogonal_defect(A / np.where(c > 0.0, c, 1.0))


def _conformal_rotation(A: Array) -> Array:
    return A / _scale(A)


def _mean_diagonal(A: Array) -> Array:
    return np.trace(A, axis1=-2, axis2=-1)[..., None, None] / A.shape[-1]


def _relative(D: Array, A: Array) -> Array:
    size = _largest(A, 2)
    return _largest(D, 2) / np.where(size > 0.0, size, 1.0)


def _diagonal(A: Array) -> Array:
    return A * np.eye(A.shape[-1])


def _raise(d: Array) -> Array:
    """Raise what is below FLOOR times the largest; all that where nothing is positive becomes FLOOR."""
    largest = np.max(d, axis=-1, keepdims=True)
    return np.maximum(d, FLOOR * np.where(largest > 0.0, largest, 1.0))


def _nearest_orthogonal(A: Array) -> Array:
    U, _, Vt = np.linalg.svd(A)
    return U @ Vt


def _nearest_rotation(A: Array) -> Array:
    # `polar.rotation` is for n = 2 and 3, and refuses where several are equally near.
    U, _, Vt = np.linalg.svd(A)
    U[..., :, -1] *= np.sign(np.linalg.det(U) * np.linalg.det(Vt))[..., None]
    return U @ Vt


def _nearest_regular(A: Array) -> Array:
    U, d, Vt = np.linalg.svd(A)
    return np.where(_regular(A)[..., None, None], A, (U * _raise(d)[..., None, :]) @ Vt)


def _nearest_positive(A: Array) -> Array:
    """Return A, or where det A <= 0 a matrix next to the nearest one with det >= 0, which is singular."""
    U, d, Vt = np.linalg.svd(A)
    sign = np.sign(np.linalg.det(U) * np.linalg.det(Vt))[..., None]
    d = np.concatenate([_raise(d)[..., :-1], sign * FLOOR * _raise(d)[..., :1]], axis=-1)
    return np.where((_regular(A) & positive(A))[..., None, None], A, (U * d[..., None, :]) @ Vt)


def _special(A: Array) -> Array:
    """Divide by the n-th root of the determinant; for the others first make it positive."""
    B = _nearest_positive(A)
    return B * np.exp(-np.linalg.slogdet(B)[1] / A.shape[-1])[..., None, None]


def _conformal(A: Array) -> Array:
    R = _nearest_rotation(A)
    return _raise(np.sum(R * A, axis=(-1, -2))[..., None] / A.shape[-1])[..., None] * R


def _nearest_spd(A: Array) -> Array:
    d, V = np.linalg.eigh(0.5 * (A + _transpose(A)))
    S = (V * _raise(d)[..., None, :]) @ _transpose(V)
    S = 0.5 * (S + _transpose(S))
    kept = (np.min(d, axis=-1) >= FLOOR * np.max(d, axis=-1)) & (np.max(d, axis=-1) > 0)
    return np.where(kept[..., None, None], 0.5 * (A + _transpose(A)), S)


def _spd(A: Array) -> NDArray[np.bool_]:
    d = np.linalg.eigvalsh(0.5 * (A + _transpose(A)))
    return d[..., 0] > 0.0


def _positive_diagonal(A: Array) -> Array:
    return _raise(np.diagonal(A, axis1=-2, axis2=-1))[..., None] * np.eye(A.shape[-1])


def _dilation(A: Array) -> Array:
    return _raise(_mean_diagonal(A)[..., 0])[..., None] * np.eye(A.shape[-1])


def same(A: Array) -> Array:
    return A


def _flipped(A: Array) -> Array:
    """Change the sign of the first column where det A < 0."""
    A = A.copy()
    A[..., :, 0] *= np.where(positive(A), 1.0, -1.0)[..., None]
    return A


def _exponential(A: Array) -> Array:
    d, V = np.linalg.eigh(0.5 * (A + _transpose(A)))
    S = (V * np.exp(d)[..., None, :]) @ _transpose(V)
    return 0.5 * (S + _transpose(S))


def _matrices(
    defect: Callable[[Array], Array],
    inside: Callable[[Array], NDArray[np.bool_]],
    project: Callable[[Array], Array],
    generic: Callable[[Array], Array] | None = None,
) -> Elements:
    return Elements(defect, inside, project, generic or project, np.matmul, _inverse)


LINEAR = {
    "I": _matrices(lambda A: _largest(A - np.eye(A.shape[-1]), 2), _all, _eye),
    "SO": _matrices(_orthogonal_defect, positive, _nearest_rotation),
    "O": _matrices(_orthogonal_defect, _all, _nearest_orthogonal),
    "GL": _matrices(_none, _regular, _nearest_regular, same),
    "GL+": _matrices(_none, lambda A: _regular(A) & positive(A), _nearest_positive, _flipped),
    "SL": _matrices(
        lambda A: np.abs(np.linalg.det(A) - 1.0), positive, _special, lambda A: _special(_flipped(A))
    ),
    "CO+": _matrices(_conformal_defect, lambda A: positive(A) & (_scale(A)[..., 0, 0] > 0), _conformal),
    "R+": _matrices(
        lambda A: _relative(A - _mean_diagonal(A) * np.eye(A.shape[-1]), A),
        lambda A: _mean_diagonal(A)[..., 0, 0] > 0,
        _dilation,
        lambda A: _dilation(np.abs(A)),
    ),
    "Sym+": _matrices(lambda A: _relative(A - _transpose(A), A), _spd, _nearest_spd, _exponential),
    "Diag+": _matrices(
        lambda A: _relative(A - _diagonal(A), A),
        lambda A: np.min(np.diagonal(A, axis1=-2, axis2=-1), axis=-1) > 0,
        _positive_diagonal,
        lambda A: np.exp(A) * np.eye(A.shape[-1]),
    ),
}


def _homogeneous(linear: Elements) -> Elements:
    """Add translations: the linear part obeys `linear`, the last row is (0, ..., 0, 1)."""

    def last(A: Array) -> Array:
        return np.eye(A.shape[-1])[-1]

    def on_block(change: Callable[[Array], Array], A: Array) -> Array:
        B = A.copy()
        B[..., :-1, :-1] = change(np.ascontiguousarray(A[..., :-1, :-1]))
        B[..., -1, :] = last(A)
        return B

    return Elements(
        lambda A: np.maximum(linear.defect(A[..., :-1, :-1]), _largest(A[..., -1, :] - last(A), 1)),
        lambda A: linear.inside(A[..., :-1, :-1]),
        lambda A: on_block(linear.project, A),
        lambda A: on_block(linear.generic, A),
        np.matmul,
        _inverse,
    )


MATRICES = {
    **{name: elements for name, elements in LINEAR.items() if name != "I"},
    "R": _homogeneous(LINEAR["I"]),
    "SE": _homogeneous(LINEAR["SO"]),
    "E": _homogeneous(LINEAR["O"]),
    "Sim+": _homogeneous(LINEAR["CO+"]),
    "Aff+": _homogeneous(LINEAR["GL+"]),
    "Aff": _homogeneous(LINEAR["GL"]),
}


def _linear_part(A: Array) -> Array:
    h = _eye(A)
    h[..., :-1, :-1] = A[..., :-1, :-1]
    return h


ACTING = {**dict.fromkeys(("SE", "E", "Sim+", "Aff+", "Aff"), _linear_part), "CO+": _conformal_rotation}
"""The factor h of A = h k, by the name of the group."""
