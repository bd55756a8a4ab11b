"""Key transformations as parameters, each a continuation of the one before.

A rotation has many rotation vectors and two quaternions; a curve through parameters needs those that belong
together:

    followed    each key's rotation vector is the nearest to that of the key before (phi_so, phi_se), its
                quaternion the nearer of the two (polar_quaternion, dual_quaternion)
    principal   each key by itself, turned by no more than pi: what blending by weights does

Turns between two keys that are not seen in them are stated.  A step of more than a quarter turn is reported
by `far`: there the choice is in doubt.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import turns, ways
from lietool.lie import affine, checks, matrix_checks

Array = NDArray[np.float64]
Index = NDArray[np.intp]

CLOSE = 1e-9
"""Keys nearer to each other in time, as a part of the whole, count as one too many."""

FARTHEST = 1e100
"""Of times; and their steps are at least its inverse."""

_NEAR = {"phi_so": affine.psi_so_near, "phi_se": affine.psi_se_near}
"""The ways whose first three parameters are a rotation vector, and how to find the nearest."""

_TURNED = {"polar_quaternion": 4, "dual_quaternion": 8}
"""The ways that begin with a quaternion less 1, or a dual one, of which the negative does as well."""


@dataclass(frozen=True, eq=False)
class Keys:
    """Key transformations as parameters.

    Parameters
    ----------
    way : Way
    A : ndarray, shape (k, 4, 4)
    times : ndarray, shape (k,)
        Increasing.
    params : ndarray, shape (k, d)
    centre : ndarray, shape (3,)
        The point whose path the translations describe.
    """

    way: ways.Way
    A: Array
    times: Array
    params: Array
    centre: Array

    @property
    def far(self) -> Index:
        """The keys whose rotation vectors are more than a quarter turn from those of the keys before."""
        if self.way.name not in _NEAR:
            return np.zeros(0, np.intp)
        step = np.linalg.norm(np.diff(self.params[:, :3], axis=0), axis=1)
        return np.flatnonzero(step > turns.LARGE_STEP) + 1


def principal(
    way: ways.Way, A: ArrayLike, times: ArrayLike | None = None, centre: ArrayLike = (0.0, 0.0, 0.0)
) -> Keys:
    """Return keys with the parameters that each has by itself.

    Kaji-Ochiai: 5.4, (3), (7), (8)

    Parameters
    ----------
    way : Way
        One of `ways.WAYS`.
    A : array_like, shape (k, 4, 4), Aff+
        What carries the object from its rest to each pose; `relative` makes it of frames.
    times : array_like, shape (k,), optional
        0, 1, 2, ... unless given.
    centre : array_like, shape (3,)
        The point of the object at rest about which it turns and stretches.

    Returns
    -------
    Keys

    Raises
    ------
    ValueError
        If there are fewer than two keys, the times do not increase, a key is not affine with det > 0, or the
        way has no parameters for one, such as a real logarithm.
    """
    where = "pose_keys.principal"
    a = checks.array(where, "A", A, (4, 4))
    if a.ndim != 3 or len(a) < 2:
        checks.fail(where, "A", "two keys or more, of shape (k, 4, 4)", f"shape {a.shape}", None)
    t = checks.array(where, "times", np.arange(len(a)) if times is None else times, ())
    if t.shape != (len(a),):
        checks.fail(where, "times", f"an array of shape ({len(a)},)", f"shape {t.shape}", None)
    # Of steps that differ more, and of spans beyond these, splines are rounding.
    enough = np.diff(t) > max(CLOSE * (t[-1] - t[0]), 1.0 / FARTHEST)
    if not enough.all():
        k = int(np.argmin(enough)) + 1
        got = f"{t[k]:g} after {t[k - 1]:g}"
        checks.fail(where, "times", f"increasing, by more than {CLOSE:g} of the whole", got, (k,))
    if t[-1] - t[0] > FARTHEST:
        checks.fail(where, "times", f"within {FARTHEST:g}", f"{t[0]:g} to {t[-1]:g}", None)
    _oriented(where, a)
    c = checks.array(where, "centre", centre, (3,))
    if c.shape != (3,):
        checks.fail(where, "centre", "an array of shape (3,)", f"shape {c.shape}", None)
    params, able = way.encode(about(a, c))
    if not able.all():
        bad = np.flatnonzero(~able)
        got = f"none for {'keys' if len(bad) > 1 else 'key'} {', '.join(map(str, bad))}"
        remedy = "Leave them out, or take phi_so or phi_se, which reach all of Aff+(3)."
        checks.fail(where, "A", f"transformations that {way.name} has parameters for", got, None, remedy)
    return Keys(way, a, t, params, c)


def followed(
    way: ways.Way,
    A: ArrayLike,
    times: ArrayLike | None = None,
    centre: ArrayLike = (0.0, 0.0, 0.0),
    *,
    near: Mapping[int, ArrayLike] | None = None,
) -> Keys:
    """Return keys with parameters that continue each other.

    The matrix logarithm and matrices have nothing to choose, and are as in `principal`.

    Kaji-Ochiai: 5.4, Algorithm 1

    Parameters
    ----------
    way, A, times, centre
        As for `principal`.
    near : mapping from int to array_like, shape (3,), radians, optional
        For a key by its index, what its rotation vector is to be nearest to, instead of that of the key
        before: 2 pi n times the axis for n full turns. Only for phi_so and phi_se.

    Returns
    -------
    Keys

    Raises
    ------
    ValueError
        As `principal`; if vectors are given for keys that there are not, or for a way that has none; or,
        for phi_se, at a whole number of turns with a translation off the axis.
    """
    keys = principal(way, A, times, centre)
    stated = _stated(keys, near or {})
    params, local = keys.params.copy(), about(keys.A, keys.centre)
    for k in range(len(params)):
        if way.name in _NEAR:
            if k in stated or k:
                params[k] = _nearest(way, local[k], stated.get(k, params[k - 1, :3]), k)
        elif way.name in _TURNED and k:
            params[k] = _shorter(params[k], params[k - 1], _TURNED[way.name])
    return replace(keys, params=params)


def relative(rest: ArrayLike, frames: ArrayLike) -> Array:
    """Return what carries a frame at rest to other frames, A = frame rest^-1.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    rest : (..., 4, 4), Aff+
    frames : (..., 4, 4), Aff+

    Returns
    -------
    A : (..., 4, 4), Aff+

    Raises
    ------
    ValueError
        If a number is not finite, a matrix not affine, or the rest is singular.
    """
    where = "pose_keys.relative"
    a = matrix_checks.affine(where, "rest", checks.array(where, "rest", rest, (4, 4)))
    b = matrix_checks.affine(where, "frames", checks.array(where, "frames", frames, (4, 4)))
    checks.broadcast(where, rest=(a, 2), frames=(b, 2))
    matrix_checks.invertible(where, "rest", a)
    return b @ np.linalg.inv(a)


def about(A: Array, centre: Array) -> Array:
    """Return A in coordinates whose origin is the centre.

    Parameters
    ----------
    A : ndarray, shape (..., 4, 4), affine
    centre : ndarray, shape (3,)

    Returns
    -------
    moved : (..., 4, 4), affine
    """
    moved = A.copy()
    moved[..., :3, 3] += A[..., :3, :3] @ centre - centre
    return moved


def _nearest(way: ways.Way, A: Array, x: Array, k: int) -> Array:
    """The parameters of key k with the rotation vector that is nearest to x."""
    try:
        return _NEAR[way.name](A, np.concatenate([x, np.zeros(9)]))
    except ValueError as error:
        got = f"a whole number of turns at {np.round(x, 3).tolist()} with a translation off the axis"
        remedy = "No screw motion does both; take phi_so."
        raise ValueError(
            f"pose_keys.followed: A must have parameters near; got {got} at index ({k},). {remedy}"
        ) from error


def _oriented(where: str, A: Array) -> None:
    """Refuse det <= 0, for `linear` as for the others: its path is to be compared with theirs."""
    L = A[:, :3, :3]
    size = np.max(np.abs(L), axis=(1, 2))
    good = (size > 0.0) & (np.linalg.det(L / np.where(size > 0.0, size, 1.0)[:, None, None]) > 0.0)
    if not good.all():
        index = checks.first(~good)
        got = f"det = {np.linalg.det(L[index]):.3g}"
        checks.fail(where, "A", "transformations with det > 0", got, index)


def _shorter(params: Array, before: Array, count: int) -> Array:
    """Return the parameters with that quaternion of the two which is nearer to the one before."""
    one = np.eye(count)[0]
    q, last = params[:count] + one, before[:count] + one
    return params if q[:4] @ last[:4] >= 0.0 else np.concatenate([-q - one, params[count:]])


def _stated(keys: Keys, near: Mapping[int, ArrayLike]) -> dict[int, Array]:
    where = "pose_keys.followed"
    if near and keys.way.name not in _NEAR:
        _refuse(where, f"none, for {keys.way.name} has no rotation vectors", f"{len(near)}")
    stated = {}
    for k, x in near.items():
        if k not in range(len(keys.times)):
            _refuse(where, f"of keys 0 to {len(keys.times) - 1}", f"one of {k!r}")
        stated[k] = checks.array(where, "near", x, (3,))
        if stated[k].shape != (3,):
            _refuse(where, "vectors (3,)", f"shape {stated[k].shape}")
    return stated


def _refuse(where: str, must: str, got: str) -> NoReturn:
    checks.fail(where, "near", must, got, None)
