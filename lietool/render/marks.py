"""Named axes and labels placed by rule: where a label goes follows from what it names."""

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import style
from lietool.render.camera import Camera
from lietool.render.scene import Arrow, Label, Record


def beyond(
    text: str,
    at: ArrayLike,
    direction: ArrayLike,
    camera: Camera,
    *,
    color: str = style.INK,
    size: float = style.TEXT,
    gap: float = 28.0,
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
    """
    along = camera.axes[:2] @ np.asarray(direction, float)
    length = float(np.linalg.norm(along))
    along = along / length if length > 1e-9 else np.array([0.0, 1.0])
    return Label(text, np.asarray(at, float), color, size, (gap * along[0], gap * along[1]))


def coordinate_axes(camera: Camera, names: tuple[str, str, str], length: float) -> list[Record]:
    """Return the three axes of space as dark arrows from the origin, each with its name beyond its tip."""
    records: list[Record] = []
    for axis, name in zip(np.eye(3), names, strict=True):
        records.append(Arrow(np.zeros(3), length * axis, style.INK, 0.010))
        records.append(beyond(name, length * axis, axis, camera, size=style.SMALL_TEXT, gap=22.0))
    return records
