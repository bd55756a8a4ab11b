"""A picture from anybody's program, as the pixels that an eye sees; what is none is refused in one line.

Nothing is decoded before its size is known, and nothing that is cut, changed
or named as what it is not is taken for a picture.  Levels are taken as sRGB:
colour profiles are not applied.
"""

import io
import logging
import stat
import struct
import warnings
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError
from PIL.PngImagePlugin import PngImageFile

MOST = 64_000_000
"""Pixels that a picture may have."""

# By what Pillow calls them. No other reader of it sees a file of a stranger.
_FORMATS = {
    "PNG": (".png", ".apng"),
    "JPEG": (".jpg", ".jpeg", ".jpe", ".jfif"),
    "TIFF": (".tif", ".tiff"),
    "WEBP": (".webp",),
    "GIF": (".gif",),
    "BMP": (".bmp",),
    "PPM": (".ppm", ".pgm", ".pbm", ".pnm"),
}
# Bytes that a pixel takes where nothing is compressed: four channels of 16 bits.
_WIDEST = 8
_ROOM = 1 << 20
# What Pillow has to tell of a damaged file it raises as well.
logging.getLogger("PIL").addHandler(logging.NullHandler())
_TRANSPARENT = ("RGBA", "LA", "PA", "La", "RGBa")


class PictureError(ValueError):
    """A file that is no picture to compare: what is wrong with it, and what to do."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(f"{what}. {remedy}")
        self.what = what
        self.remedy = remedy

    def __reduce__(self) -> tuple[type["PictureError"], tuple[str, str]]:
        """Let it travel from one process to another."""
        return PictureError, (self.what, self.remedy)


@dataclass(frozen=True, eq=False)
class Picture:
    """Pixels (h, w, 3) uint8, the texts that a PNG carries, and what kind of file it was ("PNG")."""

    image: np.ndarray
    texts: Mapping[str, str] = field(default_factory=dict)
    kind: str = "PNG"

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.image.shape[1], self.image.shape[0]


def read(path: str | Path, *, most: int = MOST) -> np.ndarray:
    """Read the pixels of a picture.

    Parameters
    ----------
    path : str or Path
        A still picture: PNG of any kind, or TIFF, WebP, GIF, BMP, PPM, JPEG.
    most : int
        How many pixels it may have.

    Returns
    -------
    (h, w, 3) uint8
        As `load`.

    Raises
    ------
    PictureError
        As `load`.
    """
    return load(path, most=most).image


def load(path: str | Path, *, most: int = MOST) -> Picture:
    """Read a picture and the texts that it carries.

    Parameters
    ----------
    path : str or Path
        A still picture: PNG of any kind, or TIFF, WebP, GIF, BMP, PPM, JPEG.
    most : int
        How many pixels it may have.

    Returns
    -------
    Picture
        Upright, over white where it is transparent, 16 bits rounded to 8 where it is grey and cut to the
        upper 8 where it has colours.

    Raises
    ------
    PictureError
        If there is no such file, or it is no picture, damaged, too large, animated or wrongly named.
    """
    path = Path(path)
    try:
        return decode(_bytes(path, most), path.suffix, most=most)
    except PictureError as error:
        raise PictureError(f"{path} {error.what}", error.remedy) from error.__cause__


def decode(data: bytes, suffix: str, *, most: int = MOST) -> Picture:
    """Decode the bytes of a picture.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        What its name ends in; one that belongs to another kind of picture is an error.
    most : int
        How many pixels it may have.

    Returns
    -------
    Picture
        As `load`.

    Raises
    ------
    PictureError
        As `load`; the message lacks the file's name.
    """
    with _faults(), _opened(data, suffix, most) as opened:
        if isinstance(opened, PngImageFile):
            opened.verify()
    with _faults(), _opened(data, suffix, most) as opened:
        kind = str(opened.format)
        if getattr(opened, "is_animated", False):
            raise PictureError(
                "holds more than one picture: it is animated, or has pages", "Save the one that is meant"
            )
        opened.load()
        image = _rgb(ImageOps.exif_transpose(opened))
        # Of a PNG these are its texts, read to the end.
        texts = opened.text if isinstance(opened, PngImageFile) else {}
        return Picture(image, {key: str(value) for key, value in texts.items()}, kind)


def told(data: bytes) -> dict[str, str]:
    """Return the texts of a PNG that stand before its pixels, which may be damaged.

    Parameters
    ----------
    data : bytes
        The file, or how much there is of it.

    Returns
    -------
    dict
        Keywords and texts.

    Raises
    ------
    PictureError
        If it does not even begin as a PNG.
    """
    with _faults(), _opened(data, ".png", MOST) as opened:
        # Its attribute `text` would decode the pixels, to find what comes after them.
        return {str(key): str(value) for key, value in opened.info.items() if isinstance(value, str)}


def ignoring(
    expected: np.ndarray, actual: np.ndarray, boxes: Sequence[tuple[int, int, int, int]]
) -> np.ndarray:
    """Return a picture that cannot differ from another inside some boxes.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        Pictures of one size.
    boxes : sequence of (x0, y0, x1, y1)
        In pixels from the upper left, x1 and y1 just outside.

    Returns
    -------
    (h, w, 3) uint8
        `actual`, with the expected pixels inside.

    Raises
    ------
    ValueError
        If a box is empty or not within the picture.
    """
    height, width = expected.shape[:2]
    image = actual.copy()
    for box in boxes:
        x0, y0, x1, y1 = box
        if not (0 <= x0 < x1 <= width and 0 <= y0 < y1 <= height):
            raise ValueError(
                f"ignore must be x0,y0,x1,y1 with x0 < x1 and y0 < y1 within the {width}x{height} picture; "
                f"got {','.join(map(str, box))}. Correct it"
            )
        image[y0:y1, x0:x1] = expected[y0:y1, x0:x1]
    return image


def _bytes(path: Path, most: int) -> bytes:
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise PictureError("is a folder", "Name a picture in it")
        if not stat.S_ISREG(status.st_mode):
            raise PictureError("is a device or a pipe", "Name a file")
        if status.st_size > _WIDEST * most + _ROOM:
            raise PictureError(
                f"has {status.st_size / 1e6:.0f} MB, more than any picture of {most / 1e6:g} million pixels",
                "Save it smaller",
            )
        if data := path.read_bytes():
            return data
        raise PictureError("is empty", "Save it anew")
    except FileNotFoundError as error:
        raise PictureError("is not there", "Correct the name") from error
    except (OSError, ValueError) as error:
        if isinstance(error, PictureError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise PictureError(f"cannot be opened ({reason})", "Look at its permissions") from error


@contextmanager
def _faults() -> Iterator[None]:
    """Turn all that Pillow raises for files that are cut, changed or contradict themselves into one error."""
    try:
        yield
    except PictureError:
        raise
    except UnidentifiedImageError as error:
        # Pillow names the bytes in memory, which tells nobody anything.
        raise PictureError("is no picture that can be read, such as a PNG", "Save it anew") from error
    except Image.DecompressionBombError as error:
        # Of so many Pillow says that before it lets anybody look at the size.
        raise PictureError("has far too many pixels", "Make it smaller") from error
    except (
        OSError, SyntaxError, ValueError, EOFError, LookupError, TypeError, ArithmeticError, struct.error,
        zlib.error, AttributeError,
    ) as error:  # fmt: skip
        said = " ".join(str(error).split()) or type(error).__name__
        raise PictureError(f"is damaged or cut off ({said})", "Save it anew") from error


@contextmanager
def _opened(data: bytes, suffix: str, most: int) -> Iterator[Image.Image]:
    with warnings.catch_warnings():
        # A limit of our own follows; what else Pillow warns of is no reader's concern.
        warnings.simplefilter("ignore")
        with Image.open(io.BytesIO(data), formats=tuple(_FORMATS)) as opened:
            _check_name(str(opened.format), suffix.lower())
            width, height = opened.size
            if width * height > most:
                raise PictureError(
                    f"has {width}x{height} pixels, and {most / 1e6:g} million are the most", "Make it smaller"
                )
            yield opened


def _check_name(kind: str, suffix: str) -> None:
    claimed = [name for name, endings in _FORMATS.items() if suffix in endings]
    if claimed and kind not in claimed:
        raise PictureError(
            f"is no {claimed[0]}, as its name says, but a {kind}", f"Rename it, or save it as a {claimed[0]}"
        )


def _rgb(opened: Image.Image) -> np.ndarray:
    if opened.mode == "F":
        raise PictureError("has floating-point levels", "Save it with 8 bits")
    if opened.mode.startswith("I"):
        return _from_grey(np.asarray(opened, np.int64), opened.info.get("transparency"))
    if opened.mode in _TRANSPARENT or "transparency" in opened.info:
        levels = np.array(opened.convert("RGBA")).astype(np.uint32)
        colour, alpha = levels[..., :3], levels[..., 3:]
        return ((colour * alpha + 255 * (255 - alpha) + 127) // 255).astype(np.uint8)
    return np.array(opened.convert("RGB"))


def _from_grey(levels: np.ndarray, transparent: object) -> np.ndarray:
    """From levels up to 65535, one of which may stand for nothing, to those of 8 bits."""
    if levels.min() < 0 or levels.max() > 65535:
        raise PictureError("has levels beyond 16 bits", "Save it with 8 bits")
    grey = (levels + 128) // 257
    if isinstance(transparent, int):
        grey[levels == transparent] = 255
    return np.repeat(grey.astype(np.uint8)[..., None], 3, axis=2)
