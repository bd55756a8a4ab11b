"""Named axes and labels placed by rule: where a label goes follows from what it names."""

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import letter as letter_
from lietool.render import polyline, style
from lietool.render.camera import Camera
from lietool.render.globe import joined
from lietool.render.scene import Arrow, Label, Lines, Record, Surface, Tube

# Front, back and walls of the solid: told apart in grey too.
LETTER = (style.ARC, style.GREYS[1], style.GREYS[2])
LETTER_BEFORE = (style.BEFORE_EDGE, style.GREYS[1], style.BEFORE)


def beyond(
    text: str,
    at: ArrayLike,
    direction: ArrayLike,
    camera: Camera,
    *,
    color: str = style.INK,
    size: float = style.TEXT,
    gap: float = 28.0,
    room: float = 0.0,
) -> Label:
    """Return a label beyond a point, further along a direction as the camera sees it.

    Parameters
    ----------
    text : str
        Mathtext.
    at : array_like, shape (3,)
        The point, such as the tip of an arrow.
    direction : array_like, shape (3,)
        Any length; one straight at the viewer puts the label above the point.
    camera : Camera
    color : str
    size : float
        Type size in page units.
    gap : float
        From the point to the middle of the label, in page units.
    room : float
        How far it may move to find a free place, see `Label`.
    """
    along = camera.axes[:2] @ np.asarray(direction, float)
    length = float(np.linalg.norm(along))
    along = along / length if length > 1e-9 else np.array([0.0, 1.0])
    return Label(text, np.asarray(at, float), color, size, (gap * along[0], gap * along[1]), room=room)


def coordinate_axes(camera: Camera, names: tuple[str, str, str], length: float) -> list[Record]:
    """Return the three axes of space as dark arrows from the origin, each with its name beyond its tip."""
    records: list[Record] = []
    for axis, name in zip(np.eye(3), names, strict=True):
        records.append(Arrow(np.zeros(3), length * axis, style.INK, 0.010))
        records.append(beyond(name, length * axis, axis, camera, size=style.SMALL_TEXT, gap=22.0, room=50.0))
    return records


def letter(
    A: ArrayLike,
    origin: ArrayLike = (0.0, 0.0, 0.0),
    *,
    size: float = 1.0,
    colors: tuple[str, str, str] = LETTER,
    alpha: float = 1.0,
) -> list[Record]:
    """Return the solid F, the shape that stands for "a shape" in space, under a linear map.

    Parameters
    ----------
    A : array_like, shape (3, 3)
        Any matrix; a reflection turns the faces inside out, which is mended.
    origin : array_like, shape (3,)
        Where its centre goes.
    size : float
        Height before `A`.
    colors : tuple of str
        Of the front, the back and the walls.
    alpha : float
    """
    A = np.asarray(A, float)
    vertices, faces, side = letter_.solid()
    placed = size * vertices @ A.T + np.asarray(origin, float)
    if np.linalg.det(A) < 0.0:
        faces = faces[:, ::-1]
    half = len(vertices) // 2
    rims = [np.append(np.arange(half), 0), np.append(np.arange(half), 0) + half]
    creases = joined(placed[rim] for rim in (*rims, *np.arange(2 * half).reshape(2, half).T))
    return [
        *(
            Surface(placed, faces[side == k], color, material="soft", alpha=alpha)
            for k, color in enumerate(colors)
        ),
        Lines(creases, style.INK, style.HAIR, 0.7 * alpha),
    ]


def curved_arrow(points: ArrayLike, color: str, radius: float, head: float = 2.6) -> list[Record]:
    """Return a round tube along a polyline (n, 3) with an arrow's head; nothing where it has no length."""
    points = np.asarray(points, float)
    length, reach = polyline.remaining(points)[0], 3.0 * head * radius
    if length < 1e-9:
        return []
    if length <= reach:
        return [Arrow(points[0], points[-1], color, radius, head)]
    shaft = polyline.shortened(points, reach)
    start = shaft[-1]
    # Half of an arrow is its head: this one begins as far before its place as it is long.
    back = start - (points[-1] - start)
    return [
        Tube(shaft, color, radius),
        Arrow(start - 1e-3 * (start - back), points[-1], color, radius, head),
    ]
