"""Points moved by blended transformations, each about an origin of its own: what probes and cages share.

Printed, (7.9) blends the transformations as they are, and the result depends
on where the world's origin lies.  Here A_i is expressed about its origin c_i:

    B_i = T(-c_i) A_i T(c_i),  with the translation t_i = A_i c_i - c_i
    v'  = c + B (v - c),  B the blend of the B_i,  c = sum of w_i c_i / sum of w_i

With `phi_so` that is v' = c + sum w_i t_i + exp(sum w_i X_i) exp(sum w_i Y_i) (v - c).
Moved together, by one rigid motion, points and transformations move the
result by it, for every way.  One origin for all, as 0, gives the printed form.

`prepare` keeps what does not change with the pose, `encode` turns a pose into
parameters, and `solve` goes through the points in blocks that stay in the cache.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import ways
from lietool.deform.weight_checks import CANCELLED, matrix, positions
from lietool.deform.weights import Weights
from lietool.lie import blocks, checks

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Prepared:
    """What stays when the pose changes.

    `origins` (k, 3) of the transformations, `centre` (n, 3) the blended origin
    of each point, `local` (n, 3) the points relative to it, and the weights.
    """

    origins: Array
    centre: Array
    local: Array
    weights: Weights


@dataclass(frozen=True)
class Pose:
    """Parameters (k, d) by a way, able (k,) where it has any; `polar` (k, 13) stands in where it has none."""

    way: ways.Way
    params: Array
    able: Mask
    polar: Array


@dataclass(frozen=True)
class Moved:
    """The points (n, 3), and at which the polar blend stood in for the way's (n,)."""

    points: Array
    fallback: Mask


def prepare(points: ArrayLike, origins: ArrayLike, weights: ArrayLike | Weights) -> Prepared:
    """Return what does not change with the pose.

    With separate weights the origins are blended by those of the translations,
    for then equal transformations with weights of sum 1 are reproduced; where
    these are all 0, by those of the rotations, or of the stretches.

    Book: (7.9), with an origin

    Parameters
    ----------
    points : (n, 3)
        Vertices of a mesh, or a cloud.
    origins : (k, 3)
        Or (3,), one for all: 0 for the form that is printed.
    weights : (n, k) or Weights

    Returns
    -------
    prepared : Prepared

    Raises
    ------
    ValueError
        If an array is not finite or of another shape, or weights cancel each
        other at a point, whose origin is then nowhere.
    """
    where = "move.prepare"
    p = positions(where, "points", points)
    o = checks.array(where, "origins", origins, (3,))
    if o.ndim > 2 or (o.ndim == 2 and not len(o)):
        checks.fail(where, "origins", "of shape (k, 3), k >= 1, or (3,)", f"shape {o.shape}", None)
    w = _weights(where, weights, len(p), len(o) if o.ndim == 2 else None)
    k = w.rotation.shape[1]
    centre = np.broadcast_to(o, p.shape) if o.ndim == 1 else _centre(where, p, o, w)
    return Prepared(np.broadcast_to(o, (k, 3)), centre, p - centre, w)


def _weights(where: str, weights: ArrayLike | Weights, n: int, k: int | None) -> Weights:
    if not isinstance(weights, Weights):
        w = np.ascontiguousarray(matrix(where, "weights", weights, n, k))
        return Weights(w, w, w)
    parts = (weights.rotation, weights.translation, weights.stretch)
    if weights.shared:
        return _weights(where, parts[0], n, k)
    k = np.shape(parts[0])[-1] if k is None else k
    return Weights(*(np.ascontiguousarray(matrix(where, "weights", w, n, k)) for w in parts))


def _centre(where: str, points: Array, origins: Array, weights: Weights) -> Array:
    """Return c of each point: the point itself where nothing moves it."""
    centre, open_ = points.copy(), np.ones(len(points), dtype=bool)
    parts = (
        [weights.translation] if weights.shared else [weights.translation, weights.rotation, weights.stretch]
    )
    for w in parts:
        # The largest |w|, without an array of all of them.
        total, size = np.sum(w, axis=1), np.maximum(np.max(w, axis=1), -np.min(w, axis=1))
        here = open_ & (size > 0.0)
        lost = here & (np.abs(total) <= CANCELLED * size)
        if np.any(lost):
            got = f"0 at {int(np.sum(lost))} of {len(points)} points, first"
            must = "with a sum other than 0 where they are not all 0"
            checks.fail(where, "weights", must, got, checks.first(lost), "Or name one origin for all.")
        centre[here] = (w @ origins)[here] / total[here, None]
        open_ &= ~here
    return centre


def about(A: ArrayLike, origins: ArrayLike) -> Array:
    """Return affine transformations as seen from origins: the translation becomes A c - c.

    Book: (7.9), with an origin

    Parameters
    ----------
    A : (..., 4, 4)
    origins : (..., 3)

    Returns
    -------
    B : (..., 4, 4)
    """
    a = checks.array("move.about", "A", A, (4, 4))
    c = checks.array("move.about", "origins", origins, (3,))
    checks.broadcast("move.about", A=(a, 2), origins=(c, 1))
    B = np.broadcast_to(a, np.broadcast_shapes(a.shape, (*c.shape[:-1], 1, 1))).copy()
    B[..., :3, 3] += ((a[..., :3, :3] - np.eye(3)) @ c[..., None])[..., 0]
    return B


def encode(way: ways.Way, B: ArrayLike, vectors: ArrayLike | None = None) -> Pose:
    """Return transformations, each about its origin, as parameters of a way.

    Book: (7.2)
    Kaji-Ochiai: (3)

    Parameters
    ----------
    way : Way
    B : (k, 4, 4)
        In Aff+; for `linear`, affine.
    vectors : (k, 3), radians, or None
        Rotation vectors of any length in place of the principal ones.

    Returns
    -------
    pose : Pose

    Raises
    ------
    ValueError
        If a B is not in Aff+, or vectors are given to a way without whole turns.
    """
    params, able = way.encode(B)
    if vectors is not None:
        if not way.whole_turns or way.parts is None:
            must = "left out: only phi_so keeps rotations beyond a half turn"
            checks.fail("move.encode", "vectors", must, f"some, for {way.name}", None)
        x = checks.array("move.encode", "vectors", vectors, (3,))
        if x.shape != (len(params), 3):
            checks.fail("move.encode", "vectors", f"of shape ({len(params)}, 3)", f"shape {x.shape}", None)
        params[:, way.parts[0]] = x
    polar = np.zeros((len(params), 0)) if able.all() else ways.POLAR_QUATERNION.encode(B)[0]
    return Pose(way, params, able, polar)


def solve(prepared: Prepared, pose: Pose) -> Moved:
    """Move every point by the blend of its transformations.

    Book: (7.9), with an origin
    Kaji-Ochiai: (9)

    Parameters
    ----------
    prepared : Prepared
    pose : Pose

    Returns
    -------
    moved : Moved

    Raises
    ------
    ValueError
        If the numbers of transformations differ, the way does not keep apart
        parts that have weights of their own, quaternions cancel each other at
        a point, or an exponential overflows.
    """
    _fits("move.solve", prepared, pose)
    points, fallback = np.empty_like(prepared.local), _fallback(prepared, pose)
    _through(prepared, pose.way, pose.params, points, None)
    if np.any(fallback):
        _through(prepared, ways.POLAR_QUATERNION, pose.polar, points, np.flatnonzero(fallback))
    return Moved(points, fallback)


def transformations(prepared: Prepared, pose: Pose) -> ways.Blend:
    """Return the blended transformation of every point, which takes it to where `solve` does.

    Of the centres of a mesh's faces, they are what `stitch.deform` makes one mesh of.

    Book: (7.9), with an origin
    MEIS: 3.3

    Parameters
    ----------
    prepared : Prepared
    pose : Pose

    Returns
    -------
    blend : ways.Blend
        A (n, 4, 4), and at which points the polar blend stood in (n,).

    Raises
    ------
    ValueError
        As `solve`.
    """
    _fits("move.transformations", prepared, pose)
    fallback, every = _fallback(prepared, pose), slice(None)
    B = pose.way.decode(_mixed(pose.way, pose.params.T, prepared.weights, every).T)
    if np.any(fallback):
        polar = _mixed(ways.POLAR_QUATERNION, pose.polar.T, prepared.weights, np.flatnonzero(fallback))
        B[fallback] = ways.POLAR_QUATERNION.decode(polar.T)
    return ways.Blend(about(B, -prepared.centre), fallback)


def _fits(where: str, prepared: Prepared, pose: Pose) -> None:
    """Refuse a pose of other transformations than there are weights for, or without parts to weigh apart."""
    w = prepared.weights
    if len(pose.params) != w.rotation.shape[1]:
        must = f"of {w.rotation.shape[1]} transformations, as many as there are weights"
        checks.fail(where, "pose", must, f"{len(pose.params)}", None)
    if not w.shared and pose.way.parts is None:
        apart = ", ".join(each.name for each in ways.WAYS.values() if each.parts)
        must = f"one for all: only {apart} keep rotation, translation and stretch apart"
        checks.fail(where, "weights", must, f"three, for {pose.way.name}", None)


def _fallback(prepared: Prepared, pose: Pose) -> Mask:
    """Where a transformation that has no parameters counts."""
    return np.any(prepared.weights.rotation[:, ~pose.able] != 0.0, axis=1)


def _through(
    prepared: Prepared, way: ways.Way, params: Array, points: Array, chosen: NDArray[np.intp] | None
) -> None:
    """Move the points, or the chosen ones, block by block."""
    n, columns = len(points) if chosen is None else len(chosen), np.ascontiguousarray(params.T)
    for start in range(0, n, blocks.BLOCK):
        part = slice(start, start + blocks.BLOCK) if chosen is None else chosen[start : start + blocks.BLOCK]
        v = np.ascontiguousarray(prepared.local[part].T)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            moved = np.array(way.kernel(_mixed(way, columns, prepared.weights, part), list(v))).T
        moved += prepared.centre[part]
        if not np.max(np.abs(moved)) < np.inf:
            bad = int(np.argmax(~np.all(np.isfinite(moved), axis=1)))
            index = (start + bad if chosen is None else int(chosen[start + bad]),)
            checks.fail("move.solve", "weights", *ways.UNDONE, index)
        points[part] = moved


def _mixed(way: ways.Way, columns: Array, weights: Weights, part: slice | NDArray[np.intp]) -> Array:
    """Return the weighted sums (d, b) of parameters (d, k) for a block of points."""
    if weights.shared or way.parts is None:
        return columns @ weights.rotation[part].T
    each = zip(way.parts, (weights.rotation, weights.translation, weights.stretch), strict=True)
    return np.concatenate([columns[rows] @ w[part].T for rows, w in each])
