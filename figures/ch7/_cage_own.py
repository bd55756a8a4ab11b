"""A user's own shapes and cages, from files."""

from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lietool.deform import cage_checks, enclosing
from lietool.mesh import cloud_io, surface_io
from lietool.mesh.surface import Mesh
from lietool.render import style

from . import _cage_case as case_
from . import _probe_look as look_

Array = NDArray[np.float64]

# Of the page's height: clouds of so many points have dots of such a size.
_DOTS = (2.2, 6.0)


def alone(cage: Path | None, to: Path | None) -> None:
    """Refuse a cage without a shape."""
    for name, file in (("cage", cage), ("to", to)):
        if file is not None:
            raise ValueError(
                f"{name} must come with a shape of your own; got {file} alone. Name the shape too"
            )


def case(shape: Path, cage: Path | None, to: Path | None, faces: int, margin: float) -> case_.Case:
    """Return the case of a user's files; of the last few it is remembered, for films."""
    if to is not None and cage is None:
        raise ValueError(f"to must come with the cage at rest; got {to} without. Name that by --cage too")
    stamps = tuple((file, _stamp(file)) for file in (shape, cage, to) if file is not None)
    return _case(shape, cage, to, faces, margin, stamps)


def _stamp(file: Path) -> tuple[int, int] | None:
    try:
        state = file.stat()
    except OSError:
        return None
    return state.st_mtime_ns, state.st_size


@lru_cache(maxsize=2)
def _case(
    shape: Path, cage: Path | None, to: Path | None, faces: int, margin: float, stamps: object
) -> case_.Case:
    mesh = cloud_io.read(shape) if cloud_io.is_cloud(shape) else surface_io.read(shape)
    size = 0.5 * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    if not size > 0.0:
        raise ValueError(
            f"shape {shape} must have an extent; got all its points at one place. Check the file"
        )
    notes = []
    if cage is None:
        made = enclosing.kept(mesh.vertices, mesh.faces if len(mesh.faces) else None, faces, margin)
        rest = Mesh(made.vertices, made.faces)
        many = f", in {made.components} parts" if made.components > 1 else ""
        notes.append(
            f"no cage is given; one of {len(made.faces)} faces is made{many}. --give rest-cage -o FILE.obj "
            "writes it, to be moved by you"
        )
    else:
        rest = surface_io.read(cage)
        try:
            cage_checks.closed("cage", rest.vertices, rest.faces)
        except ValueError as error:
            raise ValueError(f"cage {cage}: {str(error).removeprefix('cage: ')}") from None
    now = None if to is None else _moved(rest, cage, to)
    (before, after), dots = look_.own(mesh), 0.0
    if not len(mesh.faces):
        dots = float(np.clip(480.0 / np.sqrt(len(mesh.vertices)), *_DOTS))
        before, after = look_.own(mesh, style.BEFORE_EDGE)
    look = look_.Look((1.0, 0.5, 0.35), 0.33 * size, (before,), (after,), dots=dots)
    spine, shown = _spine(rest.vertices), _front(rest, look.direction)
    found = case_.Case("own", mesh, rest.vertices, rest.faces, look, spine, now, shown)
    outside = found.outside
    if len(outside):
        notes.append(
            f"{len(outside)} of {len(mesh.vertices)} vertices are outside of the cage, "
            f"first {outside[0]}; they are moved too, but less as the cage is"
        )
    return case_.noted(found, tuple(notes))


def _moved(rest: Mesh, cage: Path | None, to: Path) -> Array:
    """The vertices of the moved cage, if its faces are those of the cage at rest."""
    now = surface_io.read(to)
    if len(now.vertices) != len(rest.vertices):
        raise ValueError(
            f"to must be the cage {cage} moved, {len(rest.vertices)} vertices; got {len(now.vertices)} in "
            f"{to}. Move its vertices only, and keep their order"
        )
    same = now.faces.shape == rest.faces.shape and bool((now.faces == rest.faces).all())
    if not same:
        differ = f"{len(now.faces)} faces"
        if now.faces.shape == rest.faces.shape:
            k = int(np.argmax((now.faces != rest.faces).any(axis=1)))
            differ = f"face {k} of vertices {now.faces[k].tolist()}, not {rest.faces[k].tolist()},"
        raise ValueError(
            f"to must have the {len(rest.faces)} faces of the cage {cage}; got {differ} in {to}. Move its "
            "vertices only, and keep their order"
        )
    return now.vertices


def _spine(V: Array) -> case_.Spine:
    """The middle line of a cage's box, along its longest side, bent towards its next longest."""
    low, high = V.min(axis=0), V.max(axis=0)
    k = int(np.argmax(high - low))
    others = [i for i in range(3) if i != k]
    side = others[int(np.argmax((high - low)[others]))]
    foot = 0.5 * (low + high)
    foot[k] = low[k]
    length = float(high[k] - low[k])
    share = np.clip((V[:, k] - low[k]) / length, 0.0, 1.0)
    return case_.Spine(foot, np.eye(3)[k], np.eye(3)[side], length, share)


def _front(rest: Mesh, direction: tuple[float, float, float]) -> int:
    """The face that is farthest in front."""
    return int(np.argmax(rest.vertices[rest.faces].mean(axis=1) @ np.array(direction)))
