"""Weights of probes at the points of a shape: by distance, harmonic on the surface, or painted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lietool.deform import handle_io, harmonic, weights
from lietool.deform.probe_io import Probes
from lietool.deform.probe_values import Table
from lietool.mesh import geodesic, laplacian, surface, topology
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Shepard = Callable[[Array, Array, float], Array]

DISTANCES = ("inverse-distance", "cutoff", "gaussian")
SMOOTH = ("harmonic", "biharmonic")
PARTS = ("rotation", "translation", "stretch")
"""What may have weights of its own, in the order of `weights.separate`."""
_SUMS = {
    "unity": weights.partition_of_unity,
    "softmax": weights.softmax,
    "capped": weights.capped,
    "none": weights.unnormalised,
}


@dataclass(frozen=True)
class Recipe:
    """How weights are made; `reach` and `hold` in the units of the shape.

    `kind` is one of `DISTANCES` or `SMOOTH`; "painted", with these as `values`; or "none", all 0.
    """

    kind: str = "inverse-distance"
    power: float = 2.0
    reach: float = 1.0
    sum: str = "auto"
    distance: str = "straight"
    hold: float = 0.0
    loose: str = "refuse"
    values: Array | None = field(default=None, compare=False)

    @property
    def of_sum(self) -> str:
        """What is done to their sum: what ends somewhere lacks of 1 what belongs to the identity."""
        if self.sum != "auto":
            return self.sum
        return "unity" if self.kind == "inverse-distance" else "capped"

    @property
    def short(self) -> str:
        """How the weights are made, but for their sum."""
        if self.kind not in DISTANCES:
            return "0" if self.kind == "none" else self.kind
        r = "r_i"
        raised = "" if self.power == 1.0 else f"^{{{self.power:g}}}"
        formula = {
            "inverse-distance": f"1/{r}{raised}",
            "cutoff": rf"(1-{r}/{self.reach:.3g})_+{raised}",
            "gaussian": rf"\exp(-\frac{{1}}{{2}}({r}/{self.reach:.3g})^2)",
        }[self.kind]
        return f"${formula}$"

    @property
    def words(self) -> str:
        """How the weights are made, for a legend."""
        if self.kind not in DISTANCES:
            return f"{self.kind} weights"
        after = {
            "unity": ", divided by their sum",
            "softmax": ", by softmax",
            "capped": r", divided by $\max(1, \sum w_i)$",
            "none": "",
        }[self.of_sum]
        along = "" if self.distance == "straight" else " along the surface"
        return f"weights $w_i = {self.short[1:]}{after}; $r_i$: distance to probe $i${along}"


def weigh(mesh: Mesh, probes: Probes, recipe: Recipe, shepard: Shepard = weights.shepard) -> Array:
    """Return weights (n, k) of probes at the vertices of a mesh, by a function where they are Shepard's."""
    V, centres = mesh.vertices, probes.rest[:, :3, 3]
    if recipe.kind == "none":
        return np.zeros((len(V), len(centres)))
    if recipe.values is not None:
        return recipe.values
    if recipe.kind in SMOOTH:
        return _smooth(mesh, probes, recipe)
    if (recipe.kind, recipe.of_sum, recipe.distance) == ("inverse-distance", "unity", "straight"):
        return shepard(V, centres, recipe.power)
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
    _surface("distance", "straight", "surface", mesh)
    used = np.unique(mesh.faces)
    near = used[np.argmin(weights.distances(mesh.vertices[used], centres), axis=0)]
    found = geodesic.solve(geodesic.prepare(mesh.vertices, mesh.faces), list(near[:, None]))
    # Rounding may leave a distance a little below 0.
    return np.maximum(found, 0.0)


def _surface(name: str, other: str, got: str, mesh: Mesh) -> None:
    """Refuse a cloud, and faces without an area."""
    if not len(mesh.faces):
        raise ValueError(f"{name} must be {other} for a cloud; got {got}, which it has none of. Leave it out")
    flat = surface.health(mesh.vertices, mesh.faces).flat
    if len(flat):
        raise ValueError(
            f"{name} must be {other} where faces have no area; got {got}, with none in "
            f"{laplacian.listed('face', flat)}. Remove them, or leave it out"
        )


def _smooth(mesh: Mesh, probes: Probes, recipe: Recipe) -> Array:
    _surface("weights", f"{', '.join(DISTANCES[:2])} or {DISTANCES[2]}", recipe.kind, mesh)
    sets = handles(mesh, probes, recipe.hold)
    bare = _bare(mesh, sets)
    if recipe.loose == "refuse" and len(bare):
        raise ValueError(
            f"weights must be by distance where a part of the shape has no probe; got {recipe.kind}, with "
            f"{len(bare)} such parts, {laplacian.listed('that of vertex', bare, 1)}. Put a probe on each, or "
            "let probes hold more, or of your own shape write --loose follow, in a table "
            'loose = "follow"'
        )
    make = harmonic.harmonic if recipe.kind == "harmonic" else harmonic.biharmonic
    return harmonic.follow(mesh.vertices, mesh.faces, sets, make)


def _bare(mesh: Mesh, sets: Sequence[Index]) -> Index:
    """The first vertex of each part of the surface in which no probe holds any."""
    number, part = topology.parts(mesh.faces, len(mesh.vertices))
    first = topology.unheld(number, part, np.concatenate(sets))
    return np.intersect1d(first, mesh.faces)


def handles(mesh: Mesh, probes: Probes, hold: float) -> list[Index]:
    """Return the vertices that each probe holds.

    They are those which its table says; or else those which are farther from it by at most `hold` than the
    nearest, and nearer to it than to another probe that may hold them.
    """
    stated = [None if entry is None else handle_io.chosen(entry, mesh) for entry in _tables(probes)]
    owner = np.full(len(mesh.vertices), -1)
    for k, own in enumerate(stated):
        if own is None:
            continue
        if np.any(owner[own] >= 0):
            v = int(own[owner[own] >= 0][0])
            raise ValueError(
                f"probe {probes.names[k]} must hold vertices of its own; got vertex {v}, which probe "
                f"{probes.names[owner[v]]} holds. Write handles that are apart"
            )
        owner[own] = k
    free = np.array([k for k, own in enumerate(stated) if own is None], np.intp)
    used = np.unique(mesh.faces)
    used = used[owner[used] < 0]
    if len(free) and len(used):
        r = weights.distances(mesh.vertices[used], probes.rest[free, :3, 3])
        near = np.where(r <= r.min(axis=0) + hold, r, np.inf)
        held = np.isfinite(near).any(axis=1)
        owner[used[held]] = free[np.argmin(near[held], axis=1)]
    sets = [np.flatnonzero(owner == k) for k in range(len(stated))]
    for name, own in zip(probes.names, sets, strict=True):
        if not len(own):
            raise ValueError(
                f"probe {name} must hold a vertex of its own; got none, for other probes hold those about "
                "it. Put it elsewhere, or give it a handle in the file of probes"
            )
    return sets


def _tables(probes: Probes) -> Sequence[Table | None]:
    return probes.handles or (None,) * len(probes.names)


def loose_vertices(mesh: Mesh, probes: Probes) -> int:
    """Return how many vertices no face uses and no probe is told to hold."""
    held = [handle_io.chosen(entry, mesh) for entry in probes.handles if entry is not None]
    used = np.concatenate([mesh.faces.ravel(), *held])
    return len(mesh.vertices) - len(np.unique(used))
