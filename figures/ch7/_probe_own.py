"""A user's own shapes, probes and sequences, from files and from words."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lietool.deform import probe_io
from lietool.deform.probe_io import Probes
from lietool.mesh import cloud_io, surface_io, topology
from lietool.render import style

from ._probe_case import Case, Recipe
from ._probe_look import Look
from ._probe_look import own as coloured

Array = NDArray[np.float64]

_DEGREES = 90.0
# How far off a probe may be, and by how much it may stretch, over half the diagonal of the shape's box:
# of what is beyond nothing but rounding would come back to the shape.
_FARTHEST = 1e6
# As many as a film has pictures.
_MOST_POSES = 3600
# Of the page's height: clouds of so many points have dots of such a size.
_DOTS = (2.2, 6.0)


def shape(path: Path, turn: float) -> Case:
    """Return a user's shape with two probes at the ends of its longest side, the second turned."""
    mesh = cloud_io.read(path) if cloud_io.is_cloud(path) else surface_io.read(path)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    size = half_diagonal(mesh.vertices)
    if not size > 1.0 / topology.LARGEST:
        got = "all its points at one place" if low.tolist() == high.tolist() else f"{size:.3g}"
        raise ValueError(
            f"shape {path} must have an extent above {1.0 / topology.LARGEST:g}; got {got}. Check the file"
        )
    (before, after), dots = coloured(mesh), 0.0
    if not len(mesh.faces):
        dots = float(np.clip(480.0 / np.sqrt(len(mesh.vertices)), *_DOTS))
        before, after = coloured(mesh, style.BEFORE_EDGE)
    look = Look((1.0, 0.5, 0.35), 0.33 * size, (before,), (after,), dots=dots)
    return Case("own", mesh, _two(low, high, turn), look, Recipe())


def half_diagonal(V: Array) -> float:
    """Half the diagonal of the box."""
    return 0.5 * math.hypot(*np.ptp(V, axis=0).tolist())


def _two(low: Array, high: Array, turn: float) -> Probes:
    """Probes at the ends of the longest side of a box; the second turns about that side."""
    k = int(np.argmax(high - low))
    middle, u = 0.5 * (low + high), np.eye(3)[k]
    ends = [middle + s * (0.5 * (high - low)[k]) * u for s in (-1.0, 1.0)]
    first, second = (",".join(f"{x!r}" for x in end.tolist()) for end in ends)
    axis = ",".join(f"{x:g}" for x in u)
    return probe_io.from_words(
        [f"name=first centre={first}", f"name=second centre={second} axis={axis} degrees={_DEGREES + turn!r}"]
    )


def probes(case: Case, file: Path | None, words: str, turn: float) -> Case:
    """Return a case with a user's probes in place of its own, if there are any."""
    lines = [line.strip() for line in words.split(";") if line.strip()]
    if words and not lines:
        raise ValueError(f"probe must be one probe or more in words; got {words!r}. Write 'centre=0,0,0'")
    if file is None and not lines:
        return case
    if file is not None and lines:
        raise ValueError("probes and probe must not be given together; got both. Leave one of them out")
    if turn != 0.0:
        raise ValueError(f"turn must be 0 for your own probes; got {turn:g}. Say it as degrees of a probe")
    found = probe_io.from_words(lines) if file is None else probe_io.read(file)
    within(case.mesh.vertices, "probe", found.names, found.rest, found.current[None])
    return replace(case, name="own", probes=found, painted=None, recipe=Recipe())


def poses(case: Case, file: Path | None) -> Case:
    """Return a case whose probes go through a user's sequence, if there is one."""
    if file is None:
        return case
    found = probe_io.read_poses(file, case.probes)
    if len(found.frames) > _MOST_POSES:
        raise ValueError(
            f"poses must be at most {_MOST_POSES} poses; got {len(found.frames)} in {file}. Leave some out"
        )
    within(case.mesh.vertices, "probe", case.probes.names, case.probes.rest, found.frames)
    return replace(case, name="own", poses=found)


def within(V: Array, kind: str, names: Sequence[str], rest: Array, now: Array) -> None:
    """Refuse frames, at rest (k, 4, 4) or now (f, k, 4, 4), that are beyond measure beside a shape (n, 3)."""
    size = half_diagonal(V)
    off = np.concatenate([rest[None], now])[..., :3, 3] - 0.5 * (V.min(axis=0) + V.max(axis=0))
    far = np.linalg.norm(off, axis=-1).max(axis=0) / size
    stretch = np.linalg.norm((now @ np.linalg.inv(rest))[..., :3, :3], 2, axis=(-2, -1)).max(axis=0)
    for name, away, factor in zip(names, far, stretch, strict=True):
        if away > _FARTHEST:
            raise ValueError(
                f"{kind} {name} must be within {_FARTHEST:g} times the shape's size, {size:.3g}; got "
                f"{away:.3g} times it. Write lengths in the shape's unit"
            )
        if factor > _FARTHEST:
            raise ValueError(
                f"{kind} {name} must stretch by at most {_FARTHEST:g}; got {factor:.3g}. "
                "Write a smaller scale"
            )
