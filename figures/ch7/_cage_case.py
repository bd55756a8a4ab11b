"""A shape in its cage, how the cage is posed, and where the shape is then."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from lietool.deform import (
    adjacency,
    cage_checks,
    cage_frames,
    cage_weights,
    green,
    mean_value,
    orientation,
    ways,
)
from lietool.deform import cage as cage_
from lietool.deform import weights as weights_of
from lietool.lie import so3
from lietool.mesh.surface import Mesh

from . import _probe_look as look_

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

WAYS = {name.replace("_", "-"): way for name, way in ways.WAYS.items()}
KINDS = {"faces": cage_frames.faces, "edges": cage_frames.edges, "corners": cage_frames.corners}
# Where turns are followed through a sequence of poses, none is further from the one before, degrees.
_STEP = 30.0


@dataclass(frozen=True, eq=False)
class Spine:
    """The line about which a cage is bent and twisted.

    Parameters
    ----------
    foot : ndarray, shape (3,)
        Where it begins.
    along : ndarray, shape (3,)
        Unit vector.
    side : ndarray, shape (3,)
        Unit vector across, towards which it is bent.
    length : float
    share : ndarray, shape (k,)
        For each vertex of the cage from which part of the line it moves, 0 to 1.
    """

    foot: Array
    along: Array
    side: Array
    length: float
    share: Array

    def posed(self, V: Array, bend: float, twist: float) -> Array:
        """Return the vertices (k, 3), the line bent to an arc and all around it twisted, in degrees."""
        axis, angle = np.cross(self.along, self.side), np.radians(bend) * self.share
        R = so3.exp(angle[:, None] * axis) @ so3.exp(np.radians(twist) * self.share[:, None] * self.along)
        # An arc of the same length; sinc is sin(pi x) / (pi x).
        chord = self.length * self.share * np.sinc(angle / (2.0 * np.pi))
        way = np.cos(angle / 2.0)[:, None] * self.along + np.sin(angle / 2.0)[:, None] * self.side
        local = V - self.foot - (self.length * self.share)[:, None] * self.along
        return self.foot + chord[:, None] * way + (R @ local[..., None])[..., 0]


@dataclass(frozen=True, eq=False)
class Case:
    """A shape, its cage at rest, and how the cage is posed: along a line, or as given.

    `shown` is the face that is marked unless another is asked for.
    """

    name: str
    mesh: Mesh
    vertices: Array
    faces: Index
    look: look_.Look
    spine: Spine
    to: Array | None = None
    shown: int = 0
    notes: tuple[str, ...] = ()

    def posed(self, t: float, bend: float, twist: float) -> Array:
        """Return the cage at a part of its way."""
        if self.to is not None:
            return (1.0 - t) * self.vertices + t * self.to
        return self.spine.posed(self.vertices, t * bend, t * twist)

    def cage(self, at: tuple[float, float, float]) -> Mesh:
        """Return the cage at a part of its way, as a mesh."""
        return Mesh(self.posed(*at), self.faces)

    @cached_property
    def outside(self) -> Index:
        """The vertices of the shape that are not inside of the cage."""
        return np.flatnonzero(cage_checks.winding(self.mesh.vertices, self.vertices, self.faces) < 0.5)


@dataclass(frozen=True)
class Choice:
    """How the shape follows its cage, as the parameters of the command say; and what computes the maps."""

    coordinates: str = "maps"
    by: str = "faces"
    way: str = "phi-so"
    turns: str = "neighbours"
    power: float = cage_weights.POWER
    ramp: float = cage_weights.RAMP
    world: bool = False
    tetrahedra: Callable[[cage_frames.Elements, Array], Array] = cage_frames.tetrahedra
    maps: cage_.Maps = cage_frames.maps


@dataclass(frozen=True, eq=False)
class Moved:
    """The shape in a pose of the cage, the weight of the marked element, and what was not as it should be."""

    cage: Array
    points: Array
    weight: Array
    pose: cage_.Pose | None = None
    fallback: Mask | None = None
    notes: tuple[str, ...] = ()


@lru_cache(maxsize=16)
def prepared(case: Case, by: str, power: float, ramp: float, world: bool) -> cage_.Prepared:
    """The shape bound to its cage by maps of elements."""
    weigh = partial(
        cage_weights.weights, influence=partial(weights_of.inverse_distance, power=power), ramp=ramp
    )
    origin = np.zeros(3) if world else None
    return cage_.prepare(case.mesh.vertices, case.vertices, case.faces, KINDS[by], weigh, origin)


@lru_cache(maxsize=4)
def _mean_value(case: Case) -> mean_value.Prepared:
    return mean_value.prepare(case.mesh.vertices, case.vertices, case.faces)


@lru_cache(maxsize=4)
def _green(case: Case) -> green.Prepared:
    return green.prepare(case.mesh.vertices, case.vertices, case.faces)


def elements(case: Case, choice: Choice) -> cage_frames.Elements:
    """What the cage consists of; vertices are weighted by coordinates in faces."""
    return KINDS[choice.by if choice.coordinates == "maps" else "faces"](case.faces)


def marked(case: Case, choice: Choice, number: str) -> int:
    """Return the element that is marked: the one with a number in words, or one of the case's own face."""
    kind = elements(case, choice)
    if number.strip() in ("", "auto"):
        if kind.name == "corners":
            return 3 * case.shown
        return case.shown if kind.name == "faces" else int(np.argmax((kind.around == case.shown).any(axis=1)))
    if not number.strip().isdecimal() or int(number) >= kind.count:
        raise ValueError(
            f"mark must be auto, or the number of one of the cage's {kind.count} {kind.name}, from 0; "
            f"got {number!r:.40}"
        )
    return int(number)


def move(case: Case, choice: Choice, t: float, bend: float, twist: float, shown: int) -> Moved:
    """Return the shape in a pose."""
    now = case.posed(t, bend, twist)
    if choice.coordinates == "maps":
        return _by_maps(case, choice, (t, bend, twist), now, shown)
    corners = case.faces[shown]
    if choice.coordinates == "mean-value":
        at = _mean_value(case)
        return Moved(now, mean_value.solve(at, now), at.coordinates[:, corners].sum(axis=1))
    bound = _green(case)
    return Moved(now, green.solve(bound, now), bound.phi[:, corners].sum(axis=1))


def _by_maps(case: Case, choice: Choice, at: tuple[float, float, float], now: Array, shown: int) -> Moved:
    way, bound = WAYS[choice.way], prepared(case, choice.by, choice.power, choice.ramp, choice.world)
    policy = None if way is ways.LINEAR else orientation.nearest
    if choice.turns == "followed" and way is ways.PHI_SO:
        pose = cage_.follow(bound, _sequence(case, at), policy).poses[-1]
    else:
        lift = None if choice.turns == "principal" else adjacency.consistent
        pose = cage_.pose(bound, now, way, policy, lift, choice.maps)
    moved, notes = cage_.moved(bound, pose), []
    if pose.replaced.any():
        k = int(np.argmax(pose.replaced))
        ends = bound.elements.ends[k].tolist()
        notes.append(
            f"{int(pose.replaced.sum())} of {len(pose.replaced)} {choice.by} turn inside out or flatten, "
            f"first {k}, vertices {ends}; the nearest maps that do neither take their place"
        )
    if pose.lift is not None and choice.turns == "neighbours" and pose.lift.message:
        said = pose.lift.message.partition(". ")[0]
        notes.append(said if case.to is not None else f"{said}. Write --turns followed")
    if moved.fallback.any():
        notes.append(
            f"{int((~pose.encoded.able).sum())} of {len(pose.encoded.able)} {choice.by} have no logarithm; "
            f"{int(moved.fallback.sum())} vertices are moved by the polar blend"
        )
    weight = bound.anchored.weights.rotation[:, shown]
    return Moved(now, moved.points, weight, pose, moved.fallback, tuple(notes))


def _sequence(case: Case, at: tuple[float, float, float]) -> list[Array]:
    t, bend, twist = at
    if case.to is not None:
        raise ValueError(
            "turns must be neighbours or principal where a file says how the cage is moved, for it does not "
            "say by which way; got followed. Leave it out"
        )
    count = max(int(np.ceil(t * (abs(bend) + abs(twist)) / _STEP)), 1)
    return [case.posed(t * s, bend, twist) for s in np.linspace(0.0, 1.0, count + 1)]


def noted(case: Case, notes: tuple[str, ...]) -> Case:
    """The same with notes."""
    return replace(case, notes=notes)
