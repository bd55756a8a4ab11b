"""Pictures as other libraries hold them, as the pixels that a golden keeps; none is imported for it."""

from typing import Any

import numpy as np


def of(picture: Any) -> np.ndarray:
    """Return the pixels of a picture.

    Parameters
    ----------
    picture : ndarray, PIL image, matplotlib figure or moderngl framebuffer
        An array is (h, w), (h, w, 3) or (h, w, 4), uint8 or bool, or floats from 0 to 1, the upper
        row first; a figure is drawn at its own size and dots per inch; a framebuffer is read as it
        is bound, and turned, for its lower row comes first.

    Returns
    -------
    (h, w, 3) uint8
        sRGB; over white where it is transparent.

    Raises
    ------
    TypeError
        If it is none of these.
    ValueError
        If it has another shape, no pixels, or floats that are not from 0 to 1.
    """
    for kind in type(picture).__mro__:
        name = f"{kind.__module__.partition('.')[0]}.{kind.__name__}"
        if name in _READERS:
            return _over_white(_READERS[name](picture))
    raise TypeError(
        "lietool_golden.check: image must be an array, a Pillow image, a matplotlib figure or a moderngl "
        f"framebuffer; got {type(picture).__name__}. Convert it to an array (h, w, 3) of uint8"
    )


def _array(picture: Any) -> np.ndarray:
    levels = np.asarray(picture)
    if levels.ndim == 2:
        levels = levels[..., None]
    if levels.ndim != 3 or levels.shape[2] not in (1, 3, 4) or levels.size == 0:
        raise ValueError(
            "lietool_golden.check: image must be (h, w), (h, w, 3) or (h, w, 4) with at least one pixel; "
            f"got shape {np.shape(picture)}. Bring the channels last"
        )
    if levels.dtype == np.bool_:
        return levels * np.uint8(255)
    if levels.dtype.kind == "f":
        # Also false where it is not a number.
        if not (levels.min() >= 0.0 and levels.max() <= 1.0):
            raise ValueError(
                "lietool_golden.check: image must have floats from 0 to 1; got "
                f"{float(levels.min()):g} to {float(levels.max()):g}. Scale it, or round it to uint8"
            )
        return np.rint(levels * 255.0).astype(np.uint8)
    if levels.dtype != np.uint8:
        raise ValueError(
            f"lietool_golden.check: image must be of uint8, bool or floats; got {levels.dtype}. Convert it"
        )
    return levels


def _pillow(picture: Any) -> np.ndarray:
    if picture.mode.startswith(("I", "F")):
        raise ValueError(
            f"lietool_golden.check: image must have 8 bits a channel; got Pillow's mode {picture.mode}. "
            "Bring its levels to 0 to 255 first"
        )
    return np.asarray(picture.convert("RGBA"))


def _matplotlib(picture: Any) -> np.ndarray:
    # Whatever it is shown with, goldens are drawn by Agg.
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    before = picture.canvas
    try:
        canvas = FigureCanvasAgg(picture)
        canvas.draw()
        return np.array(canvas.buffer_rgba())
    finally:
        picture.set_canvas(before)


def _framebuffer(picture: Any) -> np.ndarray:
    width, height = picture.size
    data = picture.read(components=4, alignment=1, dtype="f1")
    levels = np.frombuffer(data, np.uint8).reshape(height, width, 4)[::-1]
    # What a shader leaves in the fourth channel is seldom meant.
    return levels[..., :3]


_READERS = {
    "numpy.ndarray": _array,
    "PIL.Image": _pillow,
    "matplotlib.Figure": _matplotlib,
    "moderngl.Framebuffer": _framebuffer,
}


def _over_white(levels: np.ndarray) -> np.ndarray:
    if levels.shape[2] == 1:
        return np.repeat(levels, 3, axis=2)
    if levels.shape[2] == 3:
        return np.ascontiguousarray(levels)
    alpha = levels[..., 3:].astype(np.uint16)
    # Rounded as a program that draws does it.
    mixed = (levels[..., :3] * alpha + 255 * (255 - alpha) + 127) // 255
    return mixed.astype(np.uint8)
