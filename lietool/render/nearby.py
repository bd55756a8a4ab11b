"""What is far from the origin, very large or very small, where single precision serves: about the target."""

from dataclasses import replace

import numpy as np

from lietool.render.camera import Page
from lietool.render.scene import Arrow, Frame, Image, Label, Lines, Points, Record, Surface, Tube, View

# Heights of a lens, and distances of its target from the origin in heights, up to which the shaders' numbers
# have a tenth of a pixel; what is within is left as it is, to the bit.
_HEIGHTS, _AWAY = (1e-6, 1e6), 1e3
# Single precision ends at 3.4e38, and the shaders need room for products.
_FARTHEST = 1e12

_PLACES: dict[type, tuple[str, ...]] = {
    Surface: ("vertices",),
    Lines: ("points",),
    Points: ("positions",),
    Arrow: ("start", "end"),
    Tube: ("points",),
    Frame: ("origin",),
    Image: ("corner",),
    Label: ("position",),
}
_LENGTHS: dict[type, tuple[str, ...]] = {
    Arrow: ("radius",),
    Tube: ("radius",),
    Frame: ("length", "radius"),
    Image: ("across", "up"),
}


def view(given: View) -> View:
    """Return a view that shows the same: where it needs that, about the origin by a lens of height 1.

    Parameters
    ----------
    given : View

    Returns
    -------
    View
        The same one where single precision serves.
    """
    camera = given.camera
    if isinstance(camera, Page):
        return given
    target, height = np.asarray(camera.target, float), camera.height
    if _HEIGHTS[0] <= height <= _HEIGHTS[1] and np.max(np.abs(target)) <= _AWAY * height:
        return given
    records = tuple(_moved(record, target, height) for record in given.records)
    return View(records, replace(camera, target=(0.0, 0.0, 0.0), height=1.0), given.box)


def _moved(record: Record, target: np.ndarray, height: float) -> Record:
    kind = type(record)
    places = {name: _place(getattr(record, name), target, height) for name in _PLACES[kind]}
    lengths = {name: np.asarray(getattr(record, name), float) / height for name in _LENGTHS.get(kind, ())}
    return replace(record, **places, **{k: float(v) if v.ndim == 0 else v for k, v in lengths.items()})


def _place(points: object, target: np.ndarray, height: float) -> np.ndarray:
    near = (np.asarray(points, float) - target) / height
    # What is no number, or infinite, is for others to refuse.
    return np.where(np.isfinite(near), np.clip(near, -_FARTHEST, _FARTHEST), near)
