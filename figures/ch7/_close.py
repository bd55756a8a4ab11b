"""What a view shows, cut off at its box: a part of a shape seen close, with a frame around it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import cut
from lietool.render import style
from lietool.render.camera import Box, Camera
from lietool.render.mesh_lines import joined_pairs, unit
from lietool.render.scene import Lines, Record, Surface
from lietool.render.theme import Mix

Array = NDArray[np.float64]

# Lines end a little before the frame, by their width.
_WIDE = 0.985


def within(records: Sequence[Record], camera: Camera, box: Box) -> list[Record]:
    """Return surfaces and lines cut off at the edges of a view's box, by planes through the eye."""
    found: list[Record] = []
    for record in records:
        if isinstance(record, Surface):
            found += _surface(record, camera, box)
        elif isinstance(record, Lines):
            found.append(replace(record, points=_pairs(np.asarray(record.points, float), camera, box)))
        else:
            found.append(record)
    return found


def framed(box: Box) -> Lines:
    """Return the frame of a box, on the page."""
    x, y, w, h = box
    corners = [(x, y, 0.0), (x + w, y, 0.0), (x + w, y + h, 0.0), (x, y + h, 0.0)]
    return Lines([*corners, corners[0]], style.MUTED, style.HAIR)


def _depths(points: Array, camera: Camera, box: Box, part: float = 1.0) -> Array:
    """How far points (..., 3) are on the inner side of the four planes, (..., 4): linear, as cuts need it."""
    x, y, back = np.moveaxis((points - camera.eye) @ camera.axes.T, -1, 0)
    up = -part * back * np.tan(camera.fov / 2.0)
    aside = up * box[2] / box[3]
    return np.stack([aside + x, aside - x, up + y, up - y], axis=-1)


def _surface(given: Surface, camera: Camera, box: Box) -> list[Record]:
    color, normals = given.color, given.normals
    several = not isinstance(color, str)
    values: dict[str, Array] = {"vertices": np.asarray(given.vertices, float)}
    if normals is not None:
        values["normals"] = np.asarray(normals, float)
    if several:
        values |= (
            {"tones": color.weights, "alpha": color.alpha} if isinstance(color, Mix) else {"rgba": color}
        )
    F = np.asarray(given.faces, np.intp)
    for k in range(4):
        if not len(F):
            return []
        # A cut takes a mesh that uses all of its vertices.
        used, F = np.unique(F, return_inverse=True)
        values, F = {name: x[used] for name, x in values.items()}, F.reshape(-1, 3)
        made = cut.along(F, _depths(values["vertices"], camera, box)[:, k])
        values, F = {name: made.carry(x) for name, x in values.items()}, made.above
    if not len(F):
        return []
    if several:
        mixed = isinstance(color, Mix)
        color = Mix(color.tones, values["tones"], values["alpha"]) if mixed else values["rgba"]
    N = None if normals is None else unit(values["normals"])
    return [replace(given, vertices=values["vertices"], faces=F, color=color, normals=N)]


def _pairs(points: Array, camera: Camera, box: Box) -> Array:
    """Cut off lines of two points each, with NaN between them."""
    a, b = points[0::3], points[1::3]
    p, q = _depths(a, camera, box, _WIDE), _depths(b, camera, box, _WIDE)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = p / (p - q)
    first = np.max(np.where(p < 0.0, np.where(q < 0.0, 1.0, share), 0.0), axis=1, initial=0.0)[:, None]
    last = np.min(np.where(q < 0.0, np.where(p < 0.0, 0.0, share), 1.0), axis=1, initial=1.0)[:, None]
    seen = (first < last)[:, 0]
    start, end = a + first * (b - a), a + last * (b - a)
    return joined_pairs(start[seen], end[seen])
