"""A shape with its probes, the weights at its points, and where it is at a time."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lietool.deform import move, orientation, probe, turns, ways, weights
from lietool.deform.probe_io import Poses, Probes
from lietool.lie import polar, so3
from lietool.mesh import geodesic, surface
from lietool.mesh.surface import Mesh

from ._probe_look import Look

Array = NDArray[np.float64]

WAYS = {name.replace("_", "-"): way for name, way in ways.WAYS.items()}
_SUMS = {
    "unity": weights.partition_of_unity,
    "softmax": weights.softmax,
    "capped": weights.capped,
    "none": weights.unnormalised,
}


@dataclass(frozen=True)
class Recipe:
    """How weights come from distances; `reach` in the units of the shape."""

    kind: str = "inverse-distance"
    power: float = 2.0
    reach: float = 1.0
    sum: str = "auto"
    distance: str = "straight"

    @property
    def of_sum(self) -> str:
        """What is done to their sum: what ends somewhere lacks of 1 what belongs to the identity."""
        if self.sum != "auto":
            return self.sum
        return "unity" if self.kind == "inverse-distance" else "capped"

    @property
    def words(self) -> str:
        """How the weights are made, for a legend."""
        r = "r_i"
        raised = "" if self.power == 1.0 else f"^{{{self.power:g}}}"
        formula = {
            "inverse-distance": f"1/{r}{raised}",
            "cutoff": rf"(1-{r}/{self.reach:.3g})_+{raised}",
            "gaussian": rf"\exp(-\frac{{1}}{{2}}({r}/{self.reach:.3g})^2)",
        }[self.kind]
        after = {
            "unity": ", divided by their sum",
            "softmax": ", by softmax",
            "capped": r", divided by $\max(1, \sum w_i)$",
            "none": "",
        }[self.of_sum]
        along = "" if self.distance == "straight" else " along the surface"
        return f"weights $w_i = {formula}${after}; $r_i$: distance to probe $i${along}"


@dataclass(frozen=True, eq=False)
class Case:
    """A shape and its probes, as they are when nothing is said of how to blend."""

    name: str
    mesh: Mesh
    probes: Probes
    look: Look
    recipe: Recipe
    painted: Array | None = None
    poses: Poses | None = None

    @cached_property
    def weights(self) -> Array:
        """The weights (n, k)."""
        if self.painted is not None:
            return self.painted
        return weigh(self.mesh, self.probes.rest[:, :3, 3], self.recipe)

    @property
    def said(self) -> str:
        """How the weights are made."""
        return "painted weights" if self.painted is not None else self.recipe.words


def weigh(mesh: Mesh, centres: Array, recipe: Recipe) -> Array:
    """Return weights (n, k) of probes with centres (k, 3) at the vertices of a mesh."""
    V = mesh.vertices
    r = _along(mesh, centres) if recipe.distance == "surface" else weights.distances(V, centres)
    if recipe.kind == "inverse-distance":
        w = weights.inverse_distance(r, recipe.power)
    elif recipe.kind == "cutoff":
        w = weights.cutoff(r, recipe.reach, recipe.power)
    else:
        w = weights.gaussian(r, recipe.reach)
    return normalised(w, recipe.of_sum)


def normalised(w: Array, total: str) -> Array:
    """Return weights (n, k) with their sums made what is wanted."""
    lost = np.sum(w, axis=1) == 0.0
    if total == "unity" and np.any(lost):
        raise ValueError(
            f"sum must be capped where weights are all 0; got unity with {int(lost.sum())} such points of "
            f"{len(w)}, first {int(np.argmax(lost))}. Write --sum capped, or let weights reach farther"
        )
    return _SUMS[total](w)


def _along(mesh: Mesh, centres: Array) -> Array:
    """Distances along the surface from the vertices nearest to centres."""
    if not len(mesh.faces):
        raise ValueError(
            "distance must be straight for a cloud; got surface, which it has none of. Leave it out"
        )
    flat = surface.health(mesh.vertices, mesh.faces).flat
    if len(flat):
        raise ValueError(
            f"distance must be straight where faces have no area; got surface, with none in {_first(flat)}. "
            "Remove them, or leave it out"
        )
    used = np.unique(mesh.faces)
    near = used[np.argmin(weights.distances(mesh.vertices[used], centres), axis=0)]
    found = geodesic.solve(geodesic.prepare(mesh.vertices, mesh.faces), list(near[:, None]))
    # Rounding may leave a distance a little below 0.
    return np.maximum(found, 0.0)


def _first(faces: NDArray[np.intp]) -> str:
    more = f" and {len(faces) - 4} more" if len(faces) > 4 else ""
    return f"face {', '.join(map(str, faces[:4]))}{more}"


@dataclass(frozen=True, eq=False)
class Moment:
    """The points and the probes' frames at a time, their rotation vectors, and where the polar blend was."""

    points: Array
    frames: Array
    vectors: Array
    fallback: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Moving:
    """A case under one way of blending."""

    case: Case
    way: ways.Way
    world: bool

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
        pose = _pose(self._centred, case.probes)
        return np.stack([np.zeros_like(pose.params), pose.params])

    @cached_property
    def track(self) -> probe.Track | None:
        """The sequence of poses followed, if there is one."""
        case, poses = self.case, self.case.poses
        if poses is None:
            return None
        for frames, whole in zip(poses.frames, poses.turns, strict=True):
            _check(case.probes.names, probe.motions(self._centred, frames), whole)
        return probe.follow(self._centred, poses.frames, poses.turns, poses.stated)

    @cached_property
    def _straight(self) -> bool:
        """Whether a probe turns space inside out, which only the linear way can take."""
        if self.way is not ways.LINEAR:
            return False
        current = self.case.probes.current[None] if self.case.poses is None else self.case.poses.frames
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
        moved = move.solve(self._prepared.anchored, pose)
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
        """What is to be told of a sequence: steps so long that it is not known which way they go."""
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


def _pose(centred: probe.Prepared, probes: Probes) -> move.Pose:
    B = probe.motions(centred, probes.current)
    _check(probes.names, B, probes.turns)
    return probe.pose(centred, probes.current, ways.PHI_SO, probes.turns)[0]


def _check(names: Sequence[str], B: Array, whole: Array) -> None:
    """Refuse by their names the probes whose motions no way can take."""
    for name, motion, n in zip(names, B, whole, strict=True):
        try:
            orientation.refuse(motion)
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
