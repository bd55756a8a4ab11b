"""Time the interpolation of whole shapes: ours by two energies, and libigl's ARAP beside it, on one mesh."""

import importlib
import importlib.util
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp import energy, shape

Array = NDArray[np.float64]
Mesh = tuple[Array, Array, NDArray[np.intp]]

SIZES = (1_000, 10_000, 100_000, 1_000_000)
FRAMES = 60
OURS = {"E^F": energy.FROBENIUS, "E^R": energy.SIMILARITY}
LIBIGL = "libigl ARAP"
METHODS = (*OURS, LIBIGL)

ITERATIONS = 10
"""What libigl does for a frame, from the frame before."""

FEW = 4
"""Frames where sixty would take minutes: each costs as much as the one before."""

REPEATS, PATIENCE = 3, 2.0
"""The least of so many runs is taken, since what else the machine does only adds; a longer one is alone."""

GOALS = {("E^F", 10_000): (0.15, 0.4), ("E^F", 100_000): (None, 6.0), ("E^R", 10_000): (None, 1.5)}
"""Seconds for preparation and for sixty frames, by method and number of triangles."""


@dataclass(frozen=True)
class Row:
    """What one method took for one mesh.

    Parameters
    ----------
    method : str
    size : int
        The triangles that were asked for; `triangles` is what a mesh of about that size has.
    prepare, solve : float
        Seconds; before any frame, and for all of them.
    error : float
        The largest residual of a linear system; nan for libigl, which solves a sequence of them.
    megabytes : float
        The most memory that the process had; nan where it was not measured.
    """

    method: str
    size: int
    triangles: int
    frames: int
    prepare: float
    solve: float
    error: float
    megabytes: float = float("nan")

    @property
    def per_frame(self) -> float:
        """Seconds for a frame."""
        return self.solve / self.frames

    @property
    def goals(self) -> tuple[float | None, float | None]:
        """What preparation and sixty frames may take; None where nothing was promised."""
        return GOALS.get((self.method, self.size), (None, None))

    @property
    def met(self) -> bool | None:
        """Whether both goals are met; None where there is none."""
        taken = (self.prepare, FRAMES * self.per_frame)
        judged = [t <= goal for t, goal in zip(taken, self.goals, strict=True) if goal is not None]
        return all(judged) if judged else None


def strip(size: int, seed: int = 41) -> Mesh:
    """Return a strip of about so many triangles, the same rolled up, and its triangles.

    Four times as long as it is wide, its inner vertices shaken, every square cut by one diagonal or
    the other: like a mesh of a user, and without the order that a grid has.
    """
    wide = max(1, round((size / 8.0) ** 0.5))
    long = max(1, round(size / (2.0 * wide)))
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(long + 1.0), np.arange(wide + 1.0), indexing="ij")
    shake = rng.uniform(-0.2, 0.2, size=(2, *x.shape))
    shake[:, [0, -1]] = shake[:, :, [0, -1]] = 0.0
    V = np.stack([x + shake[0], y + shake[1]], axis=-1).reshape(-1, 2) / wide
    a = (np.arange(long)[:, None] * (wide + 1) + np.arange(wide)).ravel()
    b, c, d = a + wide + 1, a + wide + 2, a + 1
    one = np.stack([a, b, c, a, c, d], axis=-1)
    other = np.stack([a, b, d, b, c, d], axis=-1)
    F = np.where(rng.random(len(a))[:, None] < 0.5, one, other).reshape(-1, 3)
    angle, radius = 0.8 * V[:, 0], 1.4 + 0.1 * V[:, 0] + (1.0 - V[:, 1])
    return V, radius[:, None] * np.stack([np.sin(angle), -np.cos(angle)], axis=-1), F


def frames(method: str, size: int, wanted: int = FRAMES) -> int:
    """Return how many frames to time: fewer where every one of them takes seconds."""
    slow = {"E^R": 300_000, LIBIGL: 300_000}
    return min(wanted, FEW) if size > slow.get(method, size) else wanted


def missing() -> dict[str, str]:
    """Return the methods that cannot be compared with here, and why."""
    return {} if importlib.util.find_spec("igl") else {LIBIGL: "libigl is not installed"}


def measure(method: str, size: int, wanted: int = FRAMES) -> Row:
    """Time a method on a strip, after a small one that is not counted.

    Raises
    ------
    ModuleNotFoundError
        If libigl is asked for and missing.
    """
    run = _libigl if method == LIBIGL else _ours
    run(method, strip(200), np.linspace(0.0, 1.0, 2))
    mesh, t = strip(size), np.linspace(0.0, 1.0, frames(method, size, wanted))
    runs = [run(method, mesh, t)]
    while len(runs) < REPEATS and sum(runs[-1][:2]) < PATIENCE:
        runs.append(run(method, mesh, t))
    prepare, solve = (min(times) for times in list(zip(*runs, strict=True))[:2])
    error = runs[0][2]
    return Row(method, size, len(mesh[2]), len(t), prepare, solve, error)


def _ours(method: str, mesh: Mesh, t: Array) -> tuple[float, float, float]:
    start = time.perf_counter()
    prepared = shape.prepare(*mesh, error=OURS[method])
    middle = time.perf_counter()
    found = shape.solve(prepared, t)
    return middle - start, time.perf_counter() - middle, float(found.residual.max())


def _libigl(method: str, mesh: Mesh, t: Array) -> tuple[float, float, float]:
    igl: Any = importlib.import_module("igl")
    P, Q, F = mesh
    # The shape is held at two opposite corners, which go straight to where they belong.
    held = np.array([0, len(P) - 1], np.int32)
    start = time.perf_counter()
    data = igl.ARAPData()
    data.max_iter = ITERATIONS
    igl.arap_precomputation(P, F, 2, held, data)
    middle = time.perf_counter()
    U = P
    for s in t.tolist():
        U = igl.arap_solve((1.0 - s) * P[held] + s * Q[held], data, U)
    return middle - start, time.perf_counter() - middle, float("nan")


def exponents(rows: Sequence[Row]) -> dict[str, float]:
    """Return by which power of the number of triangles the time for a frame grows.

    The slope of least squares in logarithms; only methods that were timed on two sizes have one.
    """
    found = {}
    for method in dict.fromkeys(row.method for row in rows):
        points = [(row.triangles, row.per_frame) for row in rows if row.method == method]
        if len(points) > 1:
            x, y = np.log(np.array(points)).T
            found[method] = float(np.polyfit(x, y, 1)[0])
    return found


def ahead(rows: Sequence[Row]) -> dict[tuple[str, int], float]:
    """Return how many times as long libigl takes for a frame, by our method and size."""
    others = {row.size: row.per_frame for row in rows if row.method == LIBIGL}
    return {
        (row.method, row.size): others[row.size] / row.per_frame
        for row in rows
        if row.method in OURS and row.size in others
    }
