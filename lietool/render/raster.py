"""Images in files, as levels from 0 to 255, and where they lie on a page."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import numpy as np
from numpy.typing import NDArray

from lietool.render import scene
from lietool.render.camera import Box

if TYPE_CHECKING:
    from PIL.Image import Image as Opened

Array = NDArray[np.float64]

LARGEST = 4096
"""Pixels each way that an image may have."""


@dataclass(frozen=True, eq=False)
class Raster:
    """An image.

    Parameters
    ----------
    levels : ndarray, shape (h, w, 3)
        Red, green and blue as encoded in sRGB, from 0 to 255, the upper row first.
    opacity : ndarray, shape (h, w), optional
        From 0 to 1; None where the file has none.
    """

    levels: Array
    opacity: Array | None = None


def read(path: Path) -> Raster:
    """Return the image in a file: .png, or whatever else Pillow reads.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Raster
        Upright, where the file says how it was held.

    Raises
    ------
    ValueError
        If the file is no image, is broken or has too many pixels.
    """
    from PIL import Image, ImageOps, UnidentifiedImageError

    too_many = f"an image of at most {LARGEST} pixels each way"
    try:
        with Image.open(path) as opened:
            if max(opened.size) > LARGEST:
                got = "x".join(map(str, opened.size))
                _fail(path, too_many, got, "Make it smaller.")
            found = _raster(ImageOps.exif_transpose(opened))
    except Image.DecompressionBombError:
        # Of so many Pillow says that before it lets anybody look at the size.
        _fail(path, too_many, "far more", "Make it smaller.")
    # What Pillow's readers raise when a file ends too early or contradicts itself.
    except (OSError, SyntaxError, EOFError, OverflowError, TypeError, IndexError, KeyError) as error:
        got = f"an error, {type(error).__name__}"
        if isinstance(error, UnidentifiedImageError):
            got = "something else"
        _fail(path, "an image that can be read, such as a .png", got, "Save it anew.")
    if not np.isfinite(found.levels).all():
        _fail(path, "an image of finite levels", "nan or infinity", "Save it as a .png.")
    return found


def _fail(path: Path, must: str, got: str, remedy: str) -> NoReturn:
    raise ValueError(f"raster.read: {path} must be {must}; got {got}. {remedy}")


def _raster(opened: "Opened") -> Raster:
    if opened.mode.startswith("I;16"):
        grey = np.asarray(opened, float) / 257.0
        return Raster(np.repeat(grey[..., None], 3, axis=2))
    if opened.mode in ("I", "F"):
        # No convention says what their numbers mean; those of a 16 bit .png are up to 65535.
        grey = np.clip(np.asarray(opened, float) / (257.0 if opened.mode == "I" else 1.0), 0.0, 255.0)
        return Raster(np.repeat(grey[..., None], 3, axis=2))
    if opened.mode in ("RGBA", "LA", "PA", "La", "RGBa") or "transparency" in opened.info:
        levels = np.asarray(opened.convert("RGBA"), float)
        return Raster(levels[..., :3], levels[..., 3] / 255.0)
    return Raster(np.asarray(opened.convert("RGB"), float))


def fitted(box: Box, size: tuple[int, int]) -> Box:
    """Return the largest box in the middle of another that has the shape of an image's size (w, h)."""
    scale = min(box[2] / size[0], box[3] / size[1])
    w, h = scale * size[0], scale * size[1]
    return (box[0] + 0.5 * (box[2] - w), box[1] + 0.5 * (box[3] - h), w, h)


def shown(levels: Array, box: Box) -> scene.Image:
    """Return levels (h, w, 3) or (h, w) in a box of the page."""
    return scene.Image(levels / 255.0, (box[0], box[1], 0.0), (box[2], 0.0, 0.0), (0.0, box[3], 0.0))
