"""Blending shapes: from a mesh at rest and N targets with the same faces, the shape of any N weights.

Each face with its normal has a linear map to each target; these are blended face by face, in one of `ways`,
and the blends are stitched together again.  Nothing but the blend depends on the weights, so a frame costs
one weighted sum, one exponential for each face and one solution with factors that are there already.

Weights (0, ..., 1, ..., 0) give a target, weights 0 the rest, and they may be anything else: what they lack
of 1 belongs to the rest, and outside [0, 1] they extrapolate.  The maps have no translation; each connected
part's barycentre is blended linearly.  So phi_so and phi_se, which differ in the translation, are one here.

Of phi_so and phi_se the rotation vectors are made consistent over the faces (`adjacency`), so that two
neighbours that turn by 170 and 190 degrees turn the same way.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import adjacency, local_maps, stitch, ways
from lietool.lie import checks
from lietool.lie import polar as polar_parts
from lietool.mesh import laplacian, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

_KEEP = "Keep the order of the rest, as files .obj, .ply and .off do; .glb and .stl may not."
Stated = Mapping[int, Mapping[int, ArrayLike]]


@dataclass(frozen=True, eq=False)
class Prepared:
    """What does not depend on the weights.

    Parameters
    ----------
    way : Way
    targets : ndarray, shape (N, n, 3)
    maps : ndarray, shape (N, m, 3, 3)
        The linear map of each face to each target.
    params : ndarray, shape (N, m, d)
        Their parameters.
    able : ndarray of bool, shape (N, m)
        Where the way has any: all, but for alexa.
    spare : ndarray, shape (N, s, 13)
        The polar parameters of the faces that lack any in some target.
    lacking : ndarray of int, shape (s,)
        These faces.
    lifts : tuple of Lift
        The consistent rotation vectors of each target; empty where the way has none.
    stitching : stitch.Prepared
    barycentres : ndarray, shape (N + 1, c, 3)
        Of the connected parts of the rest, then of the targets.
    """

    way: ways.Way
    targets: Array
    maps: Array
    params: Array
    able: Mask
    spare: Array
    lacking: Index
    lifts: tuple[adjacency.Lift, ...]
    stitching: stitch.Prepared
    barycentres: Array

    @property
    def messages(self) -> tuple[str, ...]:
        """What is to be told of the rotations of the targets, a line for each that is not all promised."""
        return tuple(f"target {k}: {lift.message}" for k, lift in enumerate(self.lifts) if lift.message)


@dataclass(frozen=True, eq=False)
class Blended(stitch.Stitched):
    """A blended shape: the stitched mesh, its energy, residual, determinants and flipped faces.

    Parameters
    ----------
    weights : ndarray, shape (N,)
    fallback : ndarray of bool, shape (m,)
        Faces of the polar blend, where the way has no parameters for a target of weight other than 0.
    """

    weights: Array
    fallback: Mask


def prepare(
    rest: ArrayLike,
    targets: Sequence[ArrayLike],
    F: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    *,
    maps: ArrayLike | None = None,
    stated: Stated | None = None,
    pins: ArrayLike = (),
) -> Prepared:
    """Prepare the blending of shapes.

    Kaji-Ochiai: 5.3
    MEIS: 3.3

    Parameters
    ----------
    rest : array_like, shape (n, 3)
    targets : sequence of array_like, each of shape (n, 3)
        Corresponding vertices, of the same faces: `same_faces`.
    F : array_like of int, shape (m, 3)
    way : Way
        Of `ways`.
    maps : (N, m, 3, 3), GL+, optional
        The linear map of each face to each target, where more is known of it than what a face with its normal
        tells; those are taken unless given.  A target is met only as far as they agree about it.
    stated : mapping, optional
        For a target, and a face of it, a rotation vector that the face's is to be the nearest to:
        `adjacency.turned` states turns.  The others continue these.
    pins : array_like of int, shape (k,), optional
        Vertices that go straight from shape to shape, or wherever `solve` is told.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If a target does not fit the rest, a face of either has no area, a map has no place or det <= 0, or
        what is stated is of no use.
    """
    where = "shape_blend.prepare"
    V, F = laplacian.checked(where, rest, F)
    shapes = _targets(where, targets, V, F)
    if not isinstance(way, ways.Way):
        topology.fail(where, "way", "one of ways.WAYS", repr(way), "ways.named finds one by its name.")
    if stated and not _has_vectors(way):
        got = f"some for {way.name}"
        checks.fail(where, "stated", "left out for ways without rotation vectors", got, None)
    stitching = stitch.prepare(V, F, pins)
    linear = _maps(where, maps, stitching.frames, shapes)
    # One target at a time: the transformations of all at once would be larger than all that is kept.
    encoded = [way.encode(homogeneous(A)) for A in linear]
    params, able = np.stack([p for p, _ in encoded]), np.stack([a for _, a in encoded])
    lifts: tuple[adjacency.Lift, ...] = ()
    if _has_vectors(way):
        lifts = _lifts(where, linear, F, stated or {})
        params[..., :3] = [lift.vectors for lift in lifts]
    lacking = np.flatnonzero(~able.all(axis=0))
    spare, _ = ways.POLAR_QUATERNION.encode(homogeneous(linear[:, lacking]))
    centres = np.stack([stitching.barycentres(U) for U in (V, *shapes)])
    return Prepared(way, shapes, linear, params, able, spare, lacking, lifts, stitching, centres)


def solve(prepared: Prepared, weights: ArrayLike, positions: ArrayLike | None = None) -> Blended:
    """Return the shape of given weights.

    Kaji-Ochiai: (9), 5.3
    MEIS: 3.3

    Parameters
    ----------
    prepared : Prepared
    weights : (N,)
        One for each target, any real numbers.
    positions : (k, 3), optional
        Of the pins; those of all shapes blended linearly unless given.

    Returns
    -------
    Blended

    Raises
    ------
    ValueError
        If weights are not finite or not one for each target; if blended quaternions cancel each other or an
        exponential overflows.
    """
    where = "shape_blend.solve"
    w = checks.array(where, "weights", weights, ())
    if w.shape != (len(prepared.targets),):
        must = f"one for each of the {len(prepared.targets)} targets"
        checks.fail(where, "weights", must, f"shape {w.shape}", None)
    A, fallback = _blend(prepared, w)
    at = prepared.stitching
    share = np.concatenate([[1.0 - w.sum()], w])
    if positions is None:
        positions = np.tensordot(share, np.stack([V[at.pins] for V in (at.rest, *prepared.targets)]), 1)
    found = stitch.solve(at, A, np.tensordot(share, prepared.barycentres, 1), positions)
    return Blended(at, A, found.vertices, w, fallback)


def same_faces(F: ArrayLike, others: Sequence[ArrayLike]) -> None:
    """Refuse targets whose faces are not those of the rest, in the same order.

    Kaji-Ochiai: 5.3, compatible triangulations

    Parameters
    ----------
    F : array_like of int, shape (m, 3)
    others : sequence of array_like of int, each of shape (m, 3)

    Raises
    ------
    ValueError
        If one differs, naming the first face that does; or telling that it is the same mesh reordered.
    """
    where, F = "shape_blend.same_faces", np.asarray(F)
    for k, other in enumerate(others):
        G = np.asarray(other)
        if G.shape != F.shape:
            must = f"a mesh of the {len(F)} faces of the rest"
            topology.fail(where, "target", must, f"{len(G)} in {k}", _KEEP)
        differ = (G != F).any(axis=1)
        if differ.any():
            j = int(np.argmax(differ))
            sets = [{tuple(sorted(f)) for f in faces.tolist()} for faces in (F, G)]
            remedy = "They are the same in another order: reorder them." if sets[0] == sets[1] else _KEEP
            got = f"face {j} of target {k} with vertices {G[j].tolist()} instead of {F[j].tolist()}"
            topology.fail(where, "target", "a mesh of the faces of the rest", got, remedy)


def homogeneous(A: Array) -> Array:
    """Return the matrices (..., 4, 4) of linear maps (..., 3, 3).

    Parameters
    ----------
    A : (..., 3, 3)

    Returns
    -------
    H : (..., 4, 4), affine
    """
    H = np.zeros((*A.shape[:-2], 4, 4))
    H[..., :3, :3], H[..., 3, 3] = A, 1.0
    return H


def _has_vectors(way: ways.Way) -> bool:
    """Whether the first three parameters are a rotation vector."""
    return way.parts is not None and way.parts[0] == slice(0, 3)


def _targets(where: str, targets: Sequence[ArrayLike], V: Array, F: Index) -> Array:
    if not len(targets):
        topology.fail(where, "targets", "at least one mesh", "none")
    shapes = []
    for k, target in enumerate(targets):
        U = topology.vertices(where, f"target {k}", target, 3)
        if len(U) != len(V):
            must = f"as many vertices as the rest, {len(V)}"
            topology.fail(where, f"target {k}", must, f"{len(U)}", "The shapes must correspond.")
        if (flat := laplacian.degenerate(U, F)).any():
            remedy = "Move its corners apart, or remove these faces from all meshes."
            got = f"none in {laplacian.named('face', flat)}"
            topology.fail(where, f"target {k}", "a mesh with an area in every face", got, remedy)
        shapes.append(U)
    return np.stack(shapes)


def _maps(where: str, maps: ArrayLike | None, at: local_maps.Frames, shapes: Array) -> Array:
    if maps is None:
        return np.stack([local_maps.maps(at, U) for U in shapes])
    A = checks.array(where, "maps", maps, (3, 3))
    if A.shape != (len(shapes), len(at.faces), 3, 3):
        must = f"one for each of {len(shapes)} targets and {len(at.faces)} faces"
        checks.fail(where, "maps", must, f"shape {A.shape}", None)
    return A


def _lifts(where: str, maps: Array, F: Index, stated: Stated) -> tuple[adjacency.Lift, ...]:
    pairs = adjacency.face_pairs(F)
    for k, faces in stated.items():
        if not 0 <= k < len(maps):
            topology.fail(where, "stated", f"for targets 0 to {len(maps) - 1}", f"{k}")
        for j, vector in faces.items():
            if not 0 <= j < maps.shape[1]:
                topology.fail(where, "stated", f"for faces 0 to {maps.shape[1] - 1}", f"{j} in target {k}")
            if checks.array(where, f"stated[{k}][{j}]", vector, (3,)).ndim > 1:
                got = f"shape {np.shape(vector)} for face {j} of target {k}"
                topology.fail(where, "stated", "single rotation vectors", got)
    return tuple(
        adjacency.consistent(
            polar_parts.rotation(A),
            pairs,
            list(stated.get(k, {})),
            np.reshape([np.asarray(x, float) for x in stated.get(k, {}).values()], (-1, 3)),
        )
        for k, A in enumerate(maps)
    )


def _blend(prepared: Prepared, w: Array) -> tuple[Array, Mask]:
    """The blended linear maps, and where they are the polar ones."""
    count, m, d = prepared.params.shape
    mixed = (w @ prepared.params.reshape(count, m * d)).reshape(m, d)
    fallback = np.zeros(m, bool)
    if not len(prepared.lacking):
        return prepared.way.decode_linear(mixed), fallback
    needed = np.any((w[:, None] != 0.0) & ~prepared.able[:, prepared.lacking], axis=0)
    fallback[prepared.lacking[needed]] = True
    mixed[fallback] = 0.0
    A = prepared.way.decode_linear(mixed)
    polar = np.tensordot(w, prepared.spare[:, needed], 1)
    A[fallback] = ways.POLAR_QUATERNION.decode_linear(polar)
    return A, fallback
