"""Every deformer on any mesh: how long it takes, what it stretches and turns over, and what it refuses."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.bench import bodies, deformers
from lietool.deform import (
    arap,
    cage,
    distortion,
    enclosing,
    green,
    harmonic,
    mean_value,
    poisson,
    probe,
    shape_blend,
    ways,
    weights,
)
from lietool.mesh import geodesic, laplacian

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Vertices = Callable[[], Array]

ROUNDS = 5
"""Of the polish, after the probe."""


REPEATS = 3
"""The least time is taken, since what else the machine does only adds."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A mesh to be deformed, and what several deformers need of it.

    Parameters
    ----------
    name : str
    V : ndarray, shape (n, 3)
    F : ndarray of int, shape (m, 3)
    """

    name: str
    V: Array
    F: Index

    @cached_property
    def drag(self) -> deformers.Drag:
        """What stays, what is dragged, and where to."""
        return deformers.drag(self.V, self.F)

    @cached_property
    def cage(self) -> "Around":
        """A cage that encloses it, and the seconds that finding it took."""
        start = time.perf_counter()
        found = enclosing.cage(self.V, self.F)
        seconds = time.perf_counter() - start
        box = np.array([self.V.min(axis=0), self.V.max(axis=0)])
        return Around(found.vertices, found.faces, bodies.twisted(found.vertices, box), seconds)


@dataclass(frozen=True, eq=False)
class Around:
    """A cage (k, 3) of faces (m, 3), the same twisted, and the seconds that it took."""

    V: Array
    F: Index
    now: Array
    seconds: float


Make = Callable[[Subject], Vertices]


@dataclass(frozen=True)
class Row:
    """What a deformer did to a mesh.

    Parameters
    ----------
    mesh, deformer : str
    vertices, faces : int
    prepare, solve : float
        Seconds.
    least, most : float
        The smallest and the largest singular value of the maps of the faces that have an area.
    flipped : int
        Faces that are turned over against those across their edges.
    refused : str
        The message, where the deformer takes no such mesh; then the numbers are nan and 0.
    failed : str
        What went wrong without one: that is a bug.
    """

    mesh: str
    deformer: str
    vertices: int
    faces: int
    prepare: float = float("nan")
    solve: float = float("nan")
    least: float = float("nan")
    most: float = float("nan")
    flipped: int = 0
    refused: str = ""
    failed: str = ""


def measure(subject: Subject, deformer: str) -> Row:
    """Deform a mesh and measure what comes of it; a cage that encloses it is found beforehand.

    Parameters
    ----------
    subject : Subject
    deformer : str
        One of `DEFORMERS`.

    Returns
    -------
    Row
    """
    V, F = subject.V, subject.F
    row = partial(Row, subject.name, deformer, len(V), len(F))
    try:
        shown = F[~laplacian.degenerate(*laplacian.checked("meshes.measure", V, F, flat=True))]
        # Several deformers need them: the first is not to pay for all.
        _ = subject.cage if deformer.startswith("cage") else subject.drag
        start = time.perf_counter()
        solve = DEFORMERS[deformer](subject)
        before, (each, U) = time.perf_counter() - start, _best(solve)
    except ValueError as error:
        return row(refused=str(error)) if _told(error) else row(failed=f"ValueError: {error}")
    except Exception as error:  # whatever it is, it should have been a message
        return row(failed=f"{type(error).__name__}: {error}")
    if not np.isfinite(U).all():
        return row(failed=f"{int(np.sum(~np.isfinite(U).all(axis=1)))} vertices are not finite")
    if not len(shown):
        return row(before, each)
    found = distortion.measure(V, shown, U)
    flipped = int(distortion.flipped_by_neighbours(V, shown, U).sum())
    least, most = float(found.smallest.min()), float(found.largest.max())
    return row(before, each, least, most, flipped)


def warm() -> None:
    """Do all once that does something only the first time, such as loading what is needed."""
    subject = Subject("", *bodies.body(100))
    for deformer in DEFORMERS:
        if not deformer.startswith("cage"):
            measure(subject, deformer)


def _best(run: Vertices) -> tuple[float, Array]:
    """Return the least seconds of three runs, and what comes of them."""
    times = []
    while True:
        start = time.perf_counter()
        U = run()
        times.append(time.perf_counter() - start)
        if len(times) == REPEATS:
            return min(times), U


def _told(error: ValueError) -> bool:
    """Whether it is a message of ours, which names a function and is one line."""
    words = str(error).split(": ", 1)
    return len(words) == 2 and "." in words[0] and " " not in words[0] and "\n" not in words[1]


def _probe(way: ways.Way, subject: Subject) -> Vertices:
    prepared, current = _two_probes(subject)
    return lambda: probe.solve(prepared, current, way).points


def _two_probes(subject: Subject) -> tuple[probe.Prepared, Array]:
    """Return a probe at either end of the longest axis, and the frames now: one is turned and stretched."""
    V = subject.V
    ends = (np.flatnonzero(bodies.along(V)[2] < 0.1), subject.drag.handle)
    at = np.array([V[end].mean(axis=0) for end in ends])
    rest = np.tile(np.eye(4), (2, 1, 1))
    rest[:, :3, 3] = at
    w = weights.partition_of_unity(weights.inverse_distance(weights.distances(V, at)))
    return probe.prepare(V, rest, w), np.stack([rest[0], subject.drag.A @ rest[1]])


def _cage(subject: Subject) -> Vertices:
    around = subject.cage
    prepared = cage.prepare(subject.V, around.V, around.F)
    return lambda: cage.solve(prepared, around.now).points


def _coordinates(kind: Any, subject: Subject) -> Vertices:
    around = subject.cage
    prepared = kind.prepare(subject.V, around.V, around.F)
    return lambda: kind.solve(prepared, around.now)


def _blend(subject: Subject) -> Vertices:
    targets = [change(subject.V) for change in bodies.MAPS.values()]
    prepared = shape_blend.prepare(subject.V, targets, subject.F)
    return lambda: shape_blend.solve(prepared, [0.5, 0.3, 0.4]).vertices


def _poisson(kind: Callable[[Subject], Array], subject: Subject) -> Vertices:
    drag = subject.drag
    prepared = poisson.prepare(subject.V, subject.F, drag.pins, [drag.handle], kind(subject))
    return lambda: poisson.solve(prepared, drag.A[None]).vertices


def _harmonic(subject: Subject) -> Array:
    ends = [subject.drag.pins, subject.drag.handle]
    return harmonic.follow(subject.V, subject.F, ends)[:, 1:]


def _geodesic(subject: Subject) -> Array:
    pins, handle = subject.drag.pins, subject.drag.handle
    far = geodesic.solve(geodesic.prepare(subject.V, subject.F), [pins, handle])
    w = weights.partition_of_unity(weights.inverse_distance(far))[:, 1:]
    w[pins], w[handle] = 0.0, 1.0
    return w


def _polished(subject: Subject) -> Vertices:
    prepared, current = _two_probes(subject)
    held = np.concatenate([subject.drag.pins, subject.drag.handle])
    polish = arap.prepare(subject.V, subject.F, held)
    return lambda: arap.polish(polish, probe.solve(prepared, current).points, ROUNDS).vertices


DEFORMERS: dict[str, Make] = {
    "probe, phi_so": partial(_probe, ways.PHI_SO),
    "probe, dual quaternions": partial(_probe, ways.DUAL_QUATERNION),
    "probe, polished": _polished,
    "cage, phi_so": _cage,
    "cage, mean value": partial(_coordinates, mean_value),
    "cage, Green": partial(_coordinates, green),
    "shape blend": _blend,
    "Poisson, harmonic": partial(_poisson, _harmonic),
    "Poisson, geodesic": partial(_poisson, _geodesic),
}
"""Each with the motion that shows what it does: an end turned and stretched, a cage or a target twisted."""
