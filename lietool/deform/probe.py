"""The probe deformer: frames that are carried along take the points around them along.

A probe is a frame, a homogeneous matrix, at rest and now: it tells
A_i = current_i rest_i^-1.  Each A_i is expressed about the probe's rest centre,
see `move`; `prepare` with the origin 0 gives (7.9) as it is printed.

Matrices know nothing of whole turns.  They are stated, or a sequence of poses
is followed from each to the next: `follow`.  A continuous lift cannot cross
the rotation vectors of length 2 n pi unless the pose passes exactly through
the rest position, so a step of more than a quarter turn is reported.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import move, orientation, ways
from lietool.deform import turns as turns_of
from lietool.deform.weights import Weights
from lietool.lie import checks, matrix_checks, so3

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Prepared:
    """The inverses (k, 4, 4) of the rest frames, and what `move` keeps."""

    rest_inverse: Array
    anchored: move.Prepared


@dataclass(frozen=True)
class Result:
    """The points (n, 3); at which the polar blend stood in (n,); which probes had to be replaced (k,)."""

    points: Array
    fallback: Mask
    replaced: Mask


@dataclass(frozen=True)
class Step:
    """A step that may be the wrong one: at which frame, of which probe, and how long, in radians."""

    frame: int
    probe: int
    angle: float


@dataclass(frozen=True)
class Track:
    """A sequence of poses with rotations beyond a half turn, its long steps, and what was replaced (f, k)."""

    poses: tuple[move.Pose, ...]
    steps: tuple[Step, ...]
    replaced: Mask


def prepare(
    points: ArrayLike, rest: ArrayLike, weights: ArrayLike | Weights, origin: ArrayLike | None = None
) -> Prepared:
    """Return what does not change with the pose.

    Book: 7.2

    Parameters
    ----------
    points : (n, 3)
        Vertices of a mesh, or a cloud.
    rest : (k, 4, 4)
        Frames, affine and invertible.
    weights : (n, k) or Weights
    origin : (k, 3) or (3,), or None
        What each motion is expressed about: the rest centres, unless given; 0
        for the printed form.

    Returns
    -------
    prepared : Prepared

    Raises
    ------
    ValueError
        If an array is not finite or of another shape, or a rest frame is singular.
    """
    where = "probe.prepare"
    r = _frames(where, "rest", rest)
    matrix_checks.invertible(where, "rest", r)
    inverse = np.empty_like(r)
    inverse[...] = np.linalg.inv(r)
    return Prepared(inverse, move.prepare(points, r[:, :3, 3] if origin is None else origin, weights))


def _frames(where: str, name: str, frames: ArrayLike, k: int | None = None, sequence: bool = False) -> Array:
    """Return homogeneous matrices (k, 4, 4), or a sequence of poses of them (f, k, 4, 4)."""
    a = matrix_checks.affine(where, name, checks.array(where, name, frames, (4, 4)))
    lead = a.shape[:-2]
    wanted = ("f, " if sequence else "") + ("k" if k is None else str(k))
    if len(lead) != 1 + sequence or lead[-1] == 0 or (k is not None and lead[-1] != k):
        checks.fail(where, name, f"an array of shape ({wanted}, 4, 4)", f"shape {a.shape}", None)
    return a


def motions(prepared: Prepared, current: ArrayLike) -> Array:
    """Return what carries each rest frame to the current one, about its origin: t = A c - c.

    Book: 7.2

    Parameters
    ----------
    prepared : Prepared
    current : (k, 4, 4)
        Or (f, k, 4, 4), a sequence.

    Returns
    -------
    B : (k, 4, 4)

    Raises
    ------
    ValueError
        If current is not finite, not affine, or of another shape.
    """
    sequence = np.ndim(current) == 4
    c = _frames("probe.motions", "current", current, len(prepared.rest_inverse), sequence)
    return move.about(c @ prepared.rest_inverse, prepared.anchored.origins)


def pose(
    prepared: Prepared,
    current: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    turns: ArrayLike | None = None,
    policy: orientation.Policy | None = None,
) -> tuple[move.Pose, Mask]:
    """Return the parameters of a pose, and which probes the policy has replaced.

    Kaji-Ochiai: (3), 4.3

    Parameters
    ----------
    prepared : Prepared
    current : (k, 4, 4)
    way : Way
    turns : (k, 3) or None
        Axis times number of whole turns, on top of the principal rotation.
    policy : Policy or None
        What is done where det <= 0, see `orientation`: refused, unless given;
        to `linear` nothing, unless given.

    Returns
    -------
    pose : move.Pose
    replaced : (k,)

    Raises
    ------
    ValueError
        If the policy refuses a probe, or turns are given to another way than
        phi_so, are not whole, or go about another axis than the probe's rotation.
    """
    now = _frames("probe.pose", "current", current, len(prepared.rest_inverse))
    oriented = _oriented(motions(prepared, now), way, policy)
    B = oriented.A
    if turns is None:
        return move.encode(way, B), oriented.replaced
    n = checks.array("probe.pose", "turns", turns, (3,))
    if n.shape != (len(B), 3):
        checks.fail("probe.pose", "turns", f"of shape ({len(B)}, 3)", f"shape {n.shape}", None)
    if not way.whole_turns:
        if np.any(n != 0.0):
            checks.fail(
                "probe.pose", "turns", "0: only phi_so keeps whole turns", f"some, for {way.name}", None
            )
        return move.encode(way, B), oriented.replaced
    principal = way.encode(B)[0][:, :3]
    return move.encode(way, B, turns_of.wound(principal, n)), oriented.replaced


def _oriented(B: Array, way: ways.Way, policy: orientation.Policy | None) -> orientation.Oriented:
    if policy is None and way is ways.LINEAR:
        return orientation.Oriented(B, np.zeros(B.shape[:-2], dtype=bool))
    return (policy or orientation.refuse)(B)


def solve(
    prepared: Prepared,
    current: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    turns: ArrayLike | None = None,
    policy: orientation.Policy | None = None,
) -> Result:
    """Move the points by the probes.

    Book: (7.9), with an origin
    Kaji-Ochiai: (9), 5.1
    MEIS: (5), corrected: phi of the sum, not the sum of phi

    Parameters
    ----------
    prepared : Prepared
    current : (k, 4, 4)
        The frames now.
    way : Way
    turns : (k, 3) or None
        Axis times number of whole turns, for phi_so.
    policy : Policy or None
        What is done where det <= 0, see `pose`.

    Returns
    -------
    result : Result

    Raises
    ------
    ValueError
        As `pose` and `move.solve`.
    """
    now, replaced = pose(prepared, current, way, turns, policy)
    moved = move.solve(prepared.anchored, now)
    return Result(moved.points, moved.fallback, replaced)


def follow(
    prepared: Prepared,
    poses: ArrayLike,
    turns: ArrayLike | None = None,
    stated: ArrayLike | None = None,
    policy: orientation.Policy | None = None,
) -> Track:
    """Follow a sequence of poses: each rotation vector is the nearest to the one before, or as stated.

    The first is principal, unless stated.  For phi_so: no other way keeps them.

    Kaji-Ochiai: Algorithm 1, by `so3.log_near`

    Parameters
    ----------
    prepared : Prepared
    poses : (f, k, 4, 4)
        The frames of the probes at each time.
    turns : (f, k, 3) or None
        Axis times number of whole turns, on top of the principal rotation.
    stated : (f, k), bool, or None
        Where the turns count; where they are not 0, unless given.
    policy : Policy or None
        What is done where det <= 0: refused, unless given.

    Returns
    -------
    track : Track
        Each of its poses goes to `move.solve(prepared.anchored, pose)`.

    Raises
    ------
    ValueError
        As `pose`.
    """
    where = "probe.follow"
    k = len(prepared.rest_inverse)
    a = _frames(where, "poses", poses, k, sequence=True)
    n = checks.array(where, "turns", np.zeros((*a.shape[:2], 3)) if turns is None else turns, (3,))
    told = np.any(n != 0.0, axis=-1) if stated is None else np.asarray(stated, dtype=bool)
    if n.shape[:-1] != a.shape[:2] or told.shape != a.shape[:2]:
        got = f"shapes {n.shape} and {told.shape}"
        checks.fail(where, "turns and stated", f"for {len(a)} frames of {k} probes", got, None)
    oriented = _oriented(motions(prepared, a), ways.PHI_SO, policy)
    encoded, steps, before = [], [], np.zeros((k, 3))
    for i, B in enumerate(oriented.A):
        principal = ways.PHI_SO.encode(B)[0][:, :3]
        x, _ = so3.log_near(so3.exp(principal), before)
        x[told[i]] = turns_of.wound(principal[told[i]], n[i][told[i]])
        angles = np.linalg.norm(x - before, axis=-1)
        if i:
            steps += [Step(i, int(j), float(angles[j])) for j in np.flatnonzero(angles > turns_of.LARGE_STEP)]
        encoded.append(move.encode(ways.PHI_SO, B, x))
        before = x
    return Track(tuple(encoded), tuple(steps), oriented.replaced)
