"""Time the deformers of chapter 7 after their preparation, and what other libraries have beside them."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.bench import bodies, skinning
from lietool.deform import arap, cage, green, harmonic, mean_value, poisson, probe, shape_blend, ways, weights
from lietool.lie import affine, so3
from lietool.mesh import laplacian, surface, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

POINTS = (100_000, 1_000_000)
SURFACE, BLEND = 43_562, 2_892
"""As many vertices as the armadillo of Stanford has, and as many as Crane's cow, within a percent."""

PROBES, CAGE, ROUNDS = 16, 42, 10
MOST_IN_CAGE = 300_000
"""Points for which weights of 80 faces take less than a quarter of a gigabyte."""

REPEATS, PATIENCE = 9, 2.0
"""The least of so many runs is taken, since what else the machine does only adds; fewer if they are long."""

GOALS = {
    ("probe, phi_so", 100_002): (None, 0.08),
    ("probe, phi_se", 100_002): (None, 0.08),
    ("probe, phi_so", 998_562): (None, 0.9),
    ("probe, phi_se", 998_562): (None, 0.9),
    ("Poisson, phi_so", SURFACE): (1.5, 0.06),
    ("shape blend, phi_so", BLEND): (None, 0.05),
}
"""Seconds before and for each frame, by method and the vertices that there are."""


@dataclass(frozen=True)
class Task:
    """What is timed: `prepare()`, and `solve` of what it returns.

    Parameters
    ----------
    vertices : int
    prepare : callable
    solve : callable
    """

    vertices: int
    prepare: Callable[[], Any]
    solve: Callable[[Any], Any]


@dataclass(frozen=True)
class Row:
    """What one method took.

    Parameters
    ----------
    method : str
    vertices : int
    prepare, solve : float
        Seconds: before any frame, and for each.
    own : bool
        Whether on a mesh of the user's, of which nothing was promised.
    megabytes : float
        The most memory that the process had; nan where it was not measured.
    """

    method: str
    vertices: int
    prepare: float
    solve: float
    own: bool = False
    megabytes: float = float("nan")

    @property
    def goals(self) -> tuple[float | None, float | None]:
        """What preparation and a frame may take; None where nothing was promised."""
        return (None, None) if self.own else GOALS.get((self.method, self.vertices), (None, None))

    @property
    def met(self) -> bool | None:
        """Whether all goals are met; None where there is none."""
        taken = (self.prepare, self.solve)
        judged = [t <= goal for t, goal in zip(taken, self.goals, strict=True) if goal is not None]
        return all(judged) if judged else None


def measure(method: str, size: int, mesh: tuple[Array, Index] | None = None) -> Row:
    """Time a method, after a small run that is not counted.

    Parameters
    ----------
    method : str
        One of `METHODS`.
    size : int
        About so many vertices.
    mesh : tuple of ndarray, optional
        Vertices and faces to take instead.

    Returns
    -------
    Row

    Raises
    ------
    ValueError
        If the mesh is refused.
    """
    make = {**CLOUD, **SURFACES, **BLENDS}[method]
    once = make(*bodies.body(200))
    once.solve(once.prepare())
    task = make(*(bodies.body(size) if mesh is None else mesh))
    before, prepared = _least(task.prepare)
    each, _ = _least(partial(task.solve, prepared))
    return Row(method, task.vertices, before, each, mesh is not None)


def _least(run: Callable[[], Any]) -> tuple[float, Any]:
    times: list[float] = []
    while True:
        start = time.perf_counter()
        result = run()
        times.append(time.perf_counter() - start)
        if len(times) == REPEATS or sum(times) > PATIENCE:
            return min(times), result


def missing() -> dict[str, str]:
    """Return the methods of others that cannot be compared with here, and why."""
    return skinning.missing()


def probes(V: Array, count: int = PROBES) -> tuple[Array, Array, Array]:
    """Return frames of probes at rest and now, turned and stretched, and their weights at the points."""
    rng = np.random.default_rng(23)
    at = V[np.linspace(0, len(V) - 1, count).astype(int)]
    rest = np.tile(np.eye(4), (count, 1, 1))
    rest[:, :3, 3] = at
    axes = rng.normal(size=(count, 3))
    axes *= rng.uniform(0.2, 1.2, size=(count, 1)) / np.linalg.norm(axes, axis=1, keepdims=True)
    current = rest @ affine.phi_so(
        np.concatenate([axes, 0.3 * rng.normal(size=(count, 3)), 0.1 * rng.normal(size=(count, 6))], axis=1)
    )
    return rest, current, weights.partition_of_unity(weights.inverse_distance(weights.distances(V, at)))


@dataclass(frozen=True)
class Drag:
    """Which vertices of a mesh stay, which are dragged, and by which transformation (4, 4)."""

    pins: Index
    handle: Index
    A: Array


def drag(V: Array, F: Index, angle: float = 1.8) -> Drag:
    """Return pins at the lower end of the longest axis, and a handle at the upper that is turned about it.

    Of every connected part that has neither, the lowest vertex is a pin.

    Raises
    ------
    ValueError
        If V or F is none, or all vertices are at one place.
    """
    V, F = laplacian.checked("deformers.drag", V, F, flat=True)
    if not np.ptp(V, axis=0).any():
        topology.fail("deformers.drag", "V", "vertices of which some differ", f"{len(V)} at one place")
    axis, _, t = bodies.along(V)
    handle = np.flatnonzero(t > 0.9)
    part = surface.health(V, F).part
    held = np.zeros(len(V), bool)
    held[t < 0.1] = held[handle] = True
    number = int(part.max()) + 1
    loose = np.bincount(part[held & (part >= 0)], minlength=number) == 0
    order = np.lexsort((t, part))
    lowest = order[np.unique(part[order], return_index=True)[1]]
    lowest = lowest[part[lowest] >= 0]
    pins = (t < 0.1) | (part < 0)
    pins[lowest[loose[part[lowest]]]] = True
    pins[handle] = False
    centre, vector = V[handle].mean(axis=0), angle * np.eye(3)[axis]
    L = so3.exp(vector) @ np.diag(np.where(np.arange(3) == axis, 1.15, 1.0))
    A = np.eye(4)
    A[:3, :3], A[:3, 3] = L, centre - L @ centre + 0.1 * np.ptp(V, axis=0).max()
    return Drag(np.flatnonzero(pins), handle, A)


def _probe(way: ways.Way, V: Array, F: Index) -> Task:
    rest, current, w = probes(V)
    return Task(
        len(V), lambda: probe.prepare(V, rest, w), lambda prepared: probe.solve(prepared, current, way)
    )


def _cage(way: ways.Way, V: Array, F: Index) -> Task:
    C, G = bodies.cage(V, CAGE)
    now = bodies.twisted(C)
    return Task(len(V), lambda: cage.prepare(V, C, G), lambda prepared: cage.solve(prepared, now, way))


def _coordinates(kind: Any, V: Array, F: Index) -> Task:
    C, G = bodies.cage(V, CAGE)
    now = bodies.twisted(C)
    return Task(len(V), lambda: kind.prepare(V, C, G), lambda prepared: kind.solve(prepared, now))


def _poisson(way: ways.Way, V: Array, F: Index) -> Task:
    set_ = drag(V, F)

    def prepare() -> poisson.Prepared:
        w = harmonic.follow(V, F, [set_.pins, set_.handle])[:, 1:]
        return poisson.prepare(V, F, set_.pins, [set_.handle], w)

    return Task(len(V), prepare, lambda prepared: poisson.solve(prepared, set_.A[None], way))


def _arap(V: Array, F: Index) -> Task:
    set_ = drag(V, F)
    pinned, start = np.concatenate([set_.pins, set_.handle]), V.copy()
    start[set_.handle] = V[set_.handle] @ set_.A[:3, :3].T + set_.A[:3, 3]
    return Task(
        len(V), lambda: arap.prepare(V, F, pinned), lambda prepared: arap.polish(prepared, start, ROUNDS)
    )


def _libigl_arap(V: Array, F: Index) -> Task:
    set_ = drag(V, F)
    held = np.concatenate([set_.pins, set_.handle])
    now = V[held].copy()
    now[len(set_.pins) :] = V[set_.handle] @ set_.A[:3, :3].T + set_.A[:3, 3]
    return Task(len(V), *skinning.arap(V, F, held, now, ROUNDS))


def _skinned(kind: Callable[..., Any], V: Array, F: Index) -> Task:
    rest, current, w = probes(V)
    return Task(len(V), *kind(V, w, current @ np.linalg.inv(rest)))


def _blend(way: ways.Way, V: Array, F: Index) -> Task:
    targets = [change(V) for change in bodies.MAPS.values()]
    w = np.array([0.5, 0.3, 0.4])
    return Task(
        len(V),
        lambda: shape_blend.prepare(V, targets, F, way),
        lambda prepared: shape_blend.solve(prepared, w),
    )


Make = Callable[[Array, Index], Task]

CLOUD: dict[str, Make] = {
    **{f"probe, {name}": partial(_probe, way) for name, way in ways.WAYS.items()},
    skinning.LINEAR: partial(_skinned, skinning.linear),
    skinning.DUAL: partial(_skinned, skinning.dual),
    "cage, phi_so": partial(_cage, ways.PHI_SO),
    "cage, mean value": partial(_coordinates, mean_value),
    "cage, Green": partial(_coordinates, green),
}
"""By what a point is moved without its neighbours, for any number of points."""

SURFACES: dict[str, Make] = {
    **{f"Poisson, {name}": partial(_poisson, way) for name, way in ways.WAYS.items()},
    "ARAP polish": _arap,
    skinning.ARAP: _libigl_arap,
}
BLENDS: dict[str, Make] = {
    f"shape blend, {name}": partial(_blend, way) for name, way in ways.WAYS.items() if name != "phi_se"
}
"""Of maps without a translation phi_se is phi_so."""


METHODS = (*CLOUD, *SURFACES, *BLENDS)


def chosen(sizes: tuple[int, ...], left_out: Mapping[str, str], cages: bool = False) -> list[tuple[str, int]]:
    """Return all methods with their numbers of vertices, but those left out.

    Cages are left out too where there are many points, unless asked for.
    """
    found = [
        (method, size)
        for size in sorted(sizes)
        for method in CLOUD
        if cages or size <= MOST_IN_CAGE or not method.startswith("cage")
    ]
    found += [(method, SURFACE) for method in SURFACES] + [(method, BLEND) for method in BLENDS]
    return [(method, size) for method, size in found if method not in left_out]


def with_memory(row: Row, megabytes: float) -> Row:
    """Return a row with the most memory that its process had."""
    return replace(row, megabytes=megabytes)
