"""A shape with its probes, the weights at its points, and where it is at a time."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lietool.deform import move, orientation, probe, turns, ways, weights
from lietool.deform.probe_io import Poses, Probes
from lietool.lie import polar, so3
from lietool.mesh.surface import Mesh

from ._probe_look import Look
from ._probe_weights import PARTS, Shepard, weigh
from ._probe_weights import Recipe as Recipe

Array = NDArray[np.float64]

WAYS = {name.replace("_", "-"): way for name, way in ways.WAYS.items()}


@dataclass(frozen=True, eq=False)
class Case:
    """A shape and its probes, as they are when nothing is said of how to blend.

    `parts` are recipes for those of `PARTS` whose weights are others than the rest's.  `shepard` weighs by
    straight distances, and `solve` moves the points.
    """

    name: str
    mesh: Mesh
    probes: Probes
    look: Look
    recipe: Recipe
    painted: Array | None = None
    poses: Poses | None = None
    parts: Mapping[str, Recipe] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    shepard: Shepard = weights.shepard
    solve: Callable[[move.Prepared, move.Pose], move.Moved] = move.solve

    @cached_property
    def recipes(self) -> tuple[Recipe, ...]:
        """Those of `PARTS`; one and the same of those which have none of their own."""
        base = self.recipe if self.painted is None else Recipe("painted", values=self.painted)
        return tuple(self.parts.get(part, base) for part in PARTS)

    @cached_property
    def weights(self) -> Array | weights.Weights:
        """The weights (n, k)."""
        recipes = self.recipes
        made: list[Array] = []
        for k, recipe in enumerate(recipes):
            first = next(j for j in range(k + 1) if recipes[j] is recipe)
            made.append(made[first] if first < k else weigh(self.mesh, self.probes, recipe, self.shepard))
        return weights.separate(*made) if self.parts else made[0]

    @property
    def said(self) -> str:
        """How the weights are made."""
        if not self.parts:
            return self.recipes[0].words
        each = [f"of {part} {recipe.short}" for part, recipe in zip(PARTS, self.recipes, strict=True)]
        return f"weights {', '.join(each)}"

    def moving(self, way: str, origin: str, inside_out: str, name: str = "way") -> "Moving":
        """Return it under a way of blending, which the parameter of a name has given."""
        if self.parts and WAYS[way].parts is None:
            apart = [key for key, each in WAYS.items() if each.parts is not None]
            raise ValueError(
                f"{name} must be {' or '.join(apart)} where rotation, translation or stretch has weights of "
                f"its own; got {way}. Write one of these"
            )
        return Moving(self, WAYS[way], origin == "world", orientation.POLICIES[inside_out])


@dataclass(frozen=True, eq=False)
class Moment:
    """The points and the probes' frames at a time, their rotation vectors, and where the polar blend was."""

    points: Array
    frames: Array
    vectors: Array
    fallback: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Moving:
    """A case under one way of blending, and what is done with probes that turn space inside out."""

    case: Case
    way: ways.Way
    world: bool
    policy: orientation.Policy = orientation.refuse

    @cached_property
    def _prepared(self) -> probe.Prepared:
        origin = np.zeros(3) if self.world else None
        return probe.prepare(self.case.mesh.vertices, self.case.probes.rest, self.case.weights, origin)

    @cached_property
    def _centred(self) -> probe.Prepared:
        """The probes alone, about their own centres."""
        rest = self.case.probes.rest
        return probe.prepare(np.zeros((0, 3)), rest, np.zeros((0, len(rest))))

    @cached_property
    def _keys(self) -> Array:
        """The motions (f, k, 12) by phi_so at even times, about the rest centres."""
        case, track = self.case, self.track
        if track is not None:
            return np.stack([pose.params for pose in track.poses])
        pose = _pose(self._centred, case.probes, self.policy)
        return np.stack([np.zeros_like(pose.params), pose.params])

    @cached_property
    def track(self) -> probe.Track | None:
        """The sequence of poses followed, if there is one."""
        case, poses = self.case, self.case.poses
        if poses is None:
            return None
        for frames, whole in zip(poses.frames, poses.turns, strict=True):
            _check(case.probes.names, probe.motions(self._centred, frames), whole, self.policy)
        return probe.follow(self._centred, poses.frames, poses.turns, poses.stated, self.policy)

    @property
    def _current(self) -> Array:
        """The frames (f, k, 4, 4) that are gone through."""
        case = self.case
        return case.probes.current[None] if case.poses is None else case.poses.frames

    @cached_property
    def _straight(self) -> bool:
        """Whether a probe turns space inside out, which only the linear way can take."""
        if self.way is not ways.LINEAR or self.policy is orientation.nearest:
            return False
        current = self._current
        d = np.linalg.det(current[..., :3, :3]) / np.linalg.det(self.case.probes.rest[:, :3, :3])
        return bool(np.any(d < 1e-9))

    def frames(self, t: float) -> tuple[Array, Array]:
        """Return where the probes are at a time, (k, 4, 4), and their rotation vectors (k, 3)."""
        rest = self.case.probes.rest
        if self._straight:
            ends = (
                np.stack([rest, self.case.probes.current])
                if self.case.poses is None
                else self.case.poses.frames
            )
            return _between(ends, t), np.zeros((len(rest), 3))
        params = _between(self._keys, t)
        B, c = ways.PHI_SO.decode(params), rest[:, :3, 3]
        frames = B @ rest
        frames[:, :3, 3] = c + B[:, :3, 3]
        return frames, params[:, :3]

    def at(self, t: float) -> Moment:
        """Return everything at a time from 0 to 1."""
        frames, vectors = self.frames(t)
        B = probe.motions(self._prepared, frames)
        pose = move.encode(self.way, B, vectors if self.way.whole_turns else None)
        moved = self.case.solve(self._prepared.anchored, pose)
        return Moment(moved.points, frames, vectors, moved.fallback)

    @property
    def times(self) -> Array:
        """Times at which the shape is looked at to know how much room it takes."""
        if self.case.poses is None:
            return np.array([0.0, 0.5, 1.0])
        return np.linspace(0.0, 1.0, min(len(self.case.poses.frames), 9))

    @cached_property
    def extent(self) -> Array:
        """The corners (.., 3) of boxes around the shape at all these times, and its probes."""
        found = [self.case.mesh.vertices]
        for t in self.times:
            moment = self.at(float(t))
            # The tips of the probes' axes too.
            tips = moment.frames[:, :3, 3, None] + self.case.look.probe * moment.frames[:, :3, :3]
            found += [moment.points, np.swapaxes(tips, 1, 2).reshape(-1, 3)]
        return np.concatenate([_hull(x) for x in found])

    @property
    def moments(self) -> tuple[float, ...]:
        """The times of the poses of a sequence; none where there is no sequence."""
        if self.case.poses is None:
            return ()
        count = len(self.case.poses.frames)
        return tuple(k / max(count - 1, 1) for k in range(count))

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be told: steps so long that it is not known which way they go, and what was replaced."""
        return (*self.case.notes, *self._replaced, *self._long)

    @property
    def _replaced(self) -> tuple[str, ...]:
        if self.policy is not orientation.nearest:
            return ()
        replaced = self.policy(probe.motions(self._centred, self._current)).replaced
        names = [self.case.probes.names[k] for k in np.unique(np.nonzero(replaced)[1])]
        what = "the nearest motion that does neither takes its place"
        return tuple(f"probe {name} turns space inside out or flattens it; {what}" for name in names)

    @property
    def _long(self) -> tuple[str, ...]:
        if self.track is None or self.case.poses is None:
            return ()
        return tuple(
            f"pose {step.frame + 1}: probe {self.case.probes.names[step.probe]} turns by "
            f"{np.degrees(step.angle):.0f} degrees in one step, and may be meant to go the other way. "
            "Put a pose between, or state axis and degrees"
            for step in self.track.steps
            if not self.case.poses.stated[step.frame, step.probe]
        )


def _between(keys: Array, t: float) -> Array:
    """What is at a part of the way through keys (f, ...) at even distances."""
    at = t * (len(keys) - 1)
    k = min(int(at), max(len(keys) - 2, 0))
    after = keys[min(k + 1, len(keys) - 1)]
    return keys[k] + (at - k) * (after - keys[k])


def _hull(points: Array) -> Array:
    """A few of the points that lie outermost, in place of all of them."""
    directions = np.array(
        [[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z]
    )
    return points[np.unique(np.argmax(points @ directions.T, axis=0))]


def _pose(centred: probe.Prepared, probes: Probes, policy: orientation.Policy) -> move.Pose:
    B = probe.motions(centred, probes.current)
    _check(probes.names, B, probes.turns, policy)
    return probe.pose(centred, probes.current, ways.PHI_SO, probes.turns, policy)[0]


def _check(names: Sequence[str], B: Array, whole: Array, policy: orientation.Policy) -> None:
    """Refuse by their names the probes whose motions no way can take."""
    for name, given, n in zip(names, B, whole, strict=True):
        motion = given
        try:
            motion = policy(given).A
        except ValueError:
            d = np.linalg.svd(motion[:3, :3], compute_uv=False)
            inside_out = np.linalg.det(motion[:3, :3]) < 0.0
            d[2] *= -1.0 if inside_out else 1.0
            what = "turns space inside out" if inside_out else "flattens space"
            raise ValueError(
                f"probe {name} must have a motion with det > 0; got one that {what}, singular values "
                f"{', '.join(f'{x:.3g}' for x in d)}. Mend it, or write --way linear"
            ) from None
        try:
            turns.wound(so3.log(polar.rotation(motion[:3, :3])), n)
        except ValueError as error:
            raise ValueError(f"probe {name}: {str(error).replace(' at index ()', '')}") from None
