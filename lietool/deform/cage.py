"""The cage deformer: each element of a cage tells a transformation, and points blend those by weights.

`prepare` binds points to a cage at rest: the elements (faces, edges or corners, see `cage_frames`), their
weights (`cage_weights`, or painted ones) and the origins, which are the elements' rest centres.  A pose of
the cage gives A_i, the map of each tetrahedron, and `solve` moves the points by

    v' = c + sum w_i t_i + exp(sum w_i X_i) exp(sum w_i Y_i) (v - c),  t_i = A_i c_i - c_i,
    c = sum w_i c_i / sum w_i

for `phi_so`, and the like for other ways.  With the origin 0 it is (7.9) as printed.  For `phi_so` the
rotations are made to continue each other over neighbouring elements (`adjacency`), so that a part of a cage
may be turned by up to 300 degrees; a sequence of poses goes on from there: `follow`.

A similarity of the whole cage moves the points by it.  Another affine map A does not quite, for a face tells
where its normal goes by the new normal, which is not A n.  Mean value coordinates (`mean_value`) reproduce
every A; Green coordinates (`green`) every similarity.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import adjacency, cage_checks, cage_frames, cage_weights, move, orientation, turns, ways
from lietool.deform.weights import Weights
from lietool.lie import matrix_checks, polar
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

Weigh = Callable[[Array, Array, cage_frames.Elements], Array]
Lift = Callable[[Array, Index], adjacency.Lift]
Maps = Callable[[cage_frames.Rest, Array], Array]


@dataclass(frozen=True, eq=False)
class Prepared:
    """Points bound to a cage: its vertices at rest (k, 3), the tetrahedra, and what `move` keeps."""

    vertices: Array
    rest: cage_frames.Rest
    anchored: move.Prepared

    @property
    def elements(self) -> cage_frames.Elements:
        """The elements of the cage, as many as there are weights for each point."""
        return self.rest.elements


@dataclass(frozen=True, eq=False)
class Pose:
    """The maps (p, 4, 4) of the elements in a pose, and as parameters of a way.

    `replaced` (p,) tells those that the policy for det <= 0 has replaced, `lift` the rotation vectors and
    where they are not to be relied on, None for ways without whole turns.
    """

    maps: Array
    encoded: move.Pose
    replaced: Mask
    lift: adjacency.Lift | None


@dataclass(frozen=True, eq=False)
class Result:
    """The points (n, 3), at which the polar blend stood in for the way's (n,), and the pose of the cage."""

    points: Array
    fallback: Mask
    pose: Pose


@dataclass(frozen=True)
class Step:
    """A step that may be the wrong one: at which frame, of which element, and how long, in radians."""

    frame: int
    element: int
    angle: float


@dataclass(frozen=True, eq=False)
class Track:
    """A sequence of poses whose rotations go on from each to the next, and the long steps."""

    poses: tuple[Pose, ...]
    steps: tuple[Step, ...]


def prepare(
    points: ArrayLike,
    V: ArrayLike,
    F: ArrayLike,
    kind: Callable[[ArrayLike], cage_frames.Elements] = cage_frames.faces,
    weights: ArrayLike | Weights | Weigh = cage_weights.weights,
    origin: ArrayLike | None = None,
) -> Prepared:
    """Bind points to a cage.

    Book: 7.2, Figures 7.5, 7.6
    MEIS: 3.2

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Vertices of a mesh, or a cloud; they may be outside.
    V : array_like, shape (k, 3)
    F : array_like of int, shape (m, 3)
        Counter-clockwise, seen from outside.
    kind : callable
        `cage_frames.faces`, `edges` or `corners`.
    weights : array_like (n, p), Weights or callable
        Painted ones, or what computes them from points, V and elements: `cage_weights.weights`, or a partial
        of it with other parameters.
    origin : array_like, shape (3,) or (p, 3), optional
        What the maps are expressed about: the elements' rest centres, unless given; 0 for (7.9) as printed.

    Returns
    -------
    prepared : Prepared

    Raises
    ------
    ValueError
        If the cage is not a closed surface oriented outwards that does not cross itself, a tetrahedron is
        flat, an array is not finite or of another shape, or no element counts at a point.
    """
    where = "cage.prepare"
    x = topology.vertices(where, "points", points, 3)
    V, F = cage_checks.closed(where, V, F)
    elements = kind(F)
    rest = cage_frames.rest(elements, V)
    w = weights(x, V, elements) if callable(weights) else weights
    origins = cage_frames.centres(elements, V) if origin is None else origin
    return Prepared(V, rest, move.prepare(x, origins, w))


def pose(
    prepared: Prepared,
    V: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    policy: orientation.Policy | None = None,
    lift: Lift | None = adjacency.consistent,
    maps: Maps = cage_frames.maps,
) -> Pose:
    """Return the transformations that the elements tell in a pose of the cage.

    Book: 7.2, Figure 7.6
    MEIS: 3.2
    Kaji-Ochiai: 4.3

    Parameters
    ----------
    prepared : Prepared
    V : array_like, shape (k, 3)
        The cage now.
    way : Way
    policy : Policy, optional
        What is done where det <= 0, see `orientation`: refused, unless given; to `linear` nothing,
        unless given.  In elements of faces and edges it is only where something has collapsed.
    lift : callable or None
        Rotation vectors from rotations and neighbours, for ways that keep whole turns:
        `adjacency.consistent`, or a partial of it that states seeds; None for the principal ones.
    maps : callable
        The maps of the tetrahedra from their rest and the cage now.

    Returns
    -------
    pose : Pose

    Raises
    ------
    ValueError
        If V is not finite or of another length, or the policy refuses an element.
    """
    now = topology.vertices("cage.pose", "V", V, 3)
    if len(now) != len(prepared.vertices):
        topology.fail("cage.pose", "V", f"the {len(prepared.vertices)} vertices of the cage", f"{len(now)}")
    B = move.about(maps(prepared.rest, now), prepared.anchored.origins)
    if policy is None and way is ways.LINEAR:
        oriented = orientation.Oriented(B, np.zeros(len(B), dtype=bool))
    else:
        if policy is None or policy is orientation.refuse:
            _oriented(prepared.elements, B)
        oriented = (policy or orientation.refuse)(B)
    B, found = oriented.A, None
    if way.whole_turns and lift is not None:
        found = lift(polar.rotation(B[:, :3, :3]), prepared.elements.pairs)
    encoded = move.encode(way, B, None if found is None else found.vectors)
    return Pose(move.about(B, -prepared.anchored.origins), encoded, oriented.replaced, found)


def _oriented(elements: cage_frames.Elements, B: Array) -> None:
    """Refuse maps that turn inside out or flatten, by the elements' names."""
    d = np.linalg.svd(B[:, :3, :3], compute_uv=False)
    bad = ~(d[:, 2] > matrix_checks.UNDECIDED * d[:, 0]) | ~(np.linalg.det(B[:, :3, :3]) > 0.0)
    if bad.any():
        k = int(np.argmax(bad))
        name = f"element {k} of {elements.name}, vertices {elements.ends[k].tolist()}"
        got = f"{int(bad.sum())} of {len(B)}, first {name}"
        remedy = "Mend the pose, take the policy orientation.nearest"
        remedy += ", or elements of faces or edges." if elements.name == "corners" else "."
        must = "a pose in which no tetrahedron flattens or turns inside out"
        topology.fail("cage.pose", "V", must, got, remedy)


def solve(
    prepared: Prepared,
    V: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    policy: orientation.Policy | None = None,
    lift: Lift | None = adjacency.consistent,
) -> Result:
    """Move the points with the cage.

    Book: (7.9), with an origin
    Kaji-Ochiai: (9)
    MEIS: (5), corrected: phi of the sum, not the sum of phi

    Parameters
    ----------
    prepared : Prepared
    V : array_like, shape (k, 3)
        The cage now.
    way : Way
    policy : Policy, optional
    lift : callable or None
        See `pose`.

    Returns
    -------
    result : Result

    Raises
    ------
    ValueError
        As `pose` and `move.solve`.
    """
    return moved(prepared, pose(prepared, V, way, policy, lift))


def moved(prepared: Prepared, pose: Pose) -> Result:
    """Move the points by a pose that is known, as those of `follow`.

    Kaji-Ochiai: (9)

    Parameters
    ----------
    prepared : Prepared
    pose : Pose

    Returns
    -------
    result : Result

    Raises
    ------
    ValueError
        As `move.solve`.
    """
    done = move.solve(prepared.anchored, pose.encoded)
    return Result(done.points, done.fallback, pose)


def follow(prepared: Prepared, poses: Iterable[ArrayLike], policy: orientation.Policy | None = None) -> Track:
    """Follow a sequence of poses by `phi_so`: turns add up, beyond 2 pi if need be.

    In each pose the elements continue each other, from seeds that go on from the pose before.

    Kaji-Ochiai: Algorithm 1, 4.3

    Parameters
    ----------
    prepared : Prepared
    poses : iterable of array_like, shape (k, 3)
    policy : Policy, optional
        What is done where det <= 0: refused, unless given.

    Returns
    -------
    track : Track
        Each of its poses goes to `moved`.

    Raises
    ------
    ValueError
        As `pose`.
    """
    followed: list[Pose] = []
    steps: list[Step] = []

    def on(R: Array, pairs: Index) -> adjacency.Lift:
        before = followed[-1].lift if followed else None
        if before is None:
            return adjacency.consistent(R, pairs)
        return adjacency.consistent(R, pairs, before.seeds.tolist(), before.vectors[before.seeds])

    for frame, V in enumerate(poses):
        now = pose(prepared, V, ways.PHI_SO, policy, on)
        if followed and now.lift is not None and followed[-1].lift is not None:
            angle = np.linalg.norm(now.lift.vectors - followed[-1].lift.vectors, axis=-1)
            steps += [Step(frame, int(i), float(angle[i])) for i in np.flatnonzero(angle > turns.LARGE_STEP)]
        followed.append(now)
    return Track(tuple(followed), tuple(steps))
