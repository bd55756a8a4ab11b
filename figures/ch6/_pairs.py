"""The pairs of shapes that can be shown: ours, the book's three triangles, and those in a user's files."""

from pathlib import Path

import numpy as np

from lietool.interp import compatible
from lietool.mesh import io, outline_io, shapes, topology

from . import _swallow

_MESHES = (".obj", ".off", ".ply")
_COUNT = 500

# The five points of the book's figure 6.2 in two poses, and its triangles, counted from 1.
_POINTS = ((-1.05, 0.95), (0.05, 0.35), (1.30, 0.20), (0.55, -0.85), (-1.00, -0.45))
_MOVED = ((-1.20, -0.30), (-0.30, 0.40), (0.95, 1.05), (0.95, -0.10), (0.05, -0.95))
_TRIANGLES = ((1, 2, 5), (2, 4, 5), (2, 3, 4))


def pair(example: str, source: Path | None, target: Path | None) -> shapes.Shape:
    """Return the two shapes: those of the files where they are given, else the example."""
    if source is not None and target is not None:
        return _from_files(source, target)
    if source is not None or target is not None:
        got = "only a source" if target is None else "only a target"
        raise ValueError(f"source and target must be given together; got {got}. Name the other file too")
    if example == "three-triangles":
        return _shape(np.array(_POINTS), np.array(_MOVED), _turned(np.array(_TRIANGLES) - 1))
    return _swallow.snake() if example == "swallow" else shapes.SHAPES[example]()


def _turned(faces: np.ndarray) -> np.ndarray:
    """Triangles counter-clockwise: the book lists the corners the other way round."""
    over = topology.areas(np.array(_POINTS), faces) < 0.0
    return np.where(over[:, None], faces[:, ::-1], faces)


def _from_files(source: Path, target: Path) -> shapes.Shape:
    meshes = [path.suffix.lower() in _MESHES for path in (source, target)]
    if all(meshes):
        read = io.read_pair(source, target)
        return _shape(read.source, read.target, read.faces)
    if any(meshes):
        got = f"{source.name} and {target.name}"
        raise ValueError(f"source and target must be two meshes or two outlines; got {got}. Convert one")
    made = compatible.outlines(outline_io.read(source), outline_io.read(target), triangles=_COUNT)
    return _shape(made.source, made.target, made.faces)


def _shape(source: np.ndarray, target: np.ndarray, faces: np.ndarray) -> shapes.Shape:
    """The record, with a nose and a tail at the ends of the source's longest direction."""
    moved = source - source.mean(axis=0)
    axis = np.linalg.svd(moved, full_matrices=False)[2][0]
    x = moved @ (axis * (1.0 if axis[np.argmax(np.abs(axis))] > 0.0 else -1.0))
    marks = {"nose": int(np.argmax(x)), "tail": int(np.argmin(x))}
    along = (x.max() - x) / np.ptp(x)
    return shapes.Shape(source, target, faces, topology.boundary(faces)[0], along, marks)
