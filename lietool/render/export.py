"""Pixels to the bytes of a file: PNG with texts, still or moving, and GIF with one palette for all frames."""

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from PIL.PngImagePlugin import PngInfo

# Past this level zlib takes longer than the rendering and saves a tenth.
_COMPRESSION = 3
# One of the 256 entries of a GIF stays free: it marks pixels that do not change from frame to frame.
_COLORS = 255
# As many pixels are looked at to choose the palette; more do not make it better.
_SAMPLE = 400_000


def png(image: np.ndarray, text: Mapping[str, str], dpi: float | None = None) -> bytes:
    """Return an image as the bytes of a PNG file.

    Parameters
    ----------
    image : ndarray of uint8, shape (h, w, 3)
        sRGB, the upper row first.
    text : mapping of str to str
        Keywords and values of its text chunks.
    dpi : float, optional
        Dots per inch, by which programs that print know its size.

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If the image is of another shape or type.
    """
    from PIL import Image

    check("export.png", [image])
    density = {"dpi": (dpi, dpi)} if dpi else {}
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG", pnginfo=_said(text), compress_level=_COMPRESSION, **density)
    return file.getvalue()


def apng(frames: Sequence[np.ndarray], seconds: float, text: Mapping[str, str]) -> bytes:
    """Return frames as the bytes of a PNG file that moves, in all their colours, and loops for ever.

    Parameters
    ----------
    frames : sequence of ndarray of uint8, shape (h, w, 3)
        sRGB; a program that knows no moving PNG shows the first.
    seconds : float
        How long one round takes.
    text : mapping of str to str
        Keywords and values of its text chunks.

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If there is no frame, or the frames are not of one shape.
    """
    from PIL import Image

    check("export.apng", frames)
    pictures = [Image.fromarray(frame) for frame in frames]
    # In whole milliseconds, of which none is lost over the round.
    ends = np.rint(np.linspace(0.0, 1000.0 * seconds, len(frames) + 1)).astype(int)
    file = io.BytesIO()
    pictures[0].save(
        file,
        "PNG",
        save_all=True,
        append_images=pictures[1:],
        duration=np.diff(ends).tolist(),
        loop=0,
        pnginfo=_said(text),
        compress_level=_COMPRESSION,
    )
    return file.getvalue()


def _said(text: Mapping[str, str]) -> "PngInfo":
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    for keyword, value in text.items():
        # Latin-1 goes into tEXt, anything else into iTXt.
        info.add_text(keyword, value)
    return info


def gif(frames: Sequence[np.ndarray], seconds: float) -> bytes:
    """Return frames as the bytes of a GIF file that loops for ever.

    All frames share one palette and none is dithered, so that what does not move does not flicker.

    Parameters
    ----------
    frames : sequence of ndarray of uint8, shape (h, w, 3)
        sRGB; a frame that occurs twice may be the same array.
    seconds : float
        How long one round takes; a frame lasts a whole number of hundredths, at least two.

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If there is no frame, or the frames are not of one shape.
    """
    check("export.gif", frames)
    palette, index = _palette(frames)
    pictures = [_indexed(frame, palette, index) for frame in frames]
    # Browsers take anything below two hundredths for ten.
    duration = max(20, round(100 * seconds / len(frames)) * 10)
    file = io.BytesIO()
    pictures[0].save(
        file,
        "GIF",
        save_all=True,
        append_images=pictures[1:],
        duration=duration,
        loop=0,
        disposal=1,
        optimize=False,
    )
    return file.getvalue()


def _palette(frames: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """The colours of a palette, shape (n, 3), and for every 24-bit colour of the frames its index."""
    from PIL import Image

    distinct = {id(frame): frame for frame in frames}.values()
    every = np.zeros(1 << 24, bool)
    counts: dict[int, int] = {}
    for frame in distinct:
        codes = _codes(frame)
        every[codes] = True
        some, times = np.unique(
            codes.ravel()[:: max(1, codes.size * len(distinct) // _SAMPLE)], return_counts=True
        )
        for code, count in zip(some.tolist(), times.tolist(), strict=True):
            counts[code] = counts.get(code, 0) + count
    codes = np.array(sorted(counts, key=lambda code: (-counts[code], code)))
    # The root of the counts: a small thing in a colour of its own counts for more than its few pixels.
    weights = np.ceil(np.sqrt([counts[code] for code in codes.tolist()])).astype(int)
    sample = np.repeat(_colors(codes), weights, axis=0)[None]
    chosen = (
        Image.fromarray(sample).quantize(_COLORS - 1, Image.Quantize.MEDIANCUT, kmeans=1).getpalette() or []
    )
    # The paper, which is the commonest colour, must not take on a tint.
    palette = np.concatenate([_colors(codes[:1]), np.array(chosen, np.uint8).reshape(-1, 3)[: _COLORS - 1]])
    index = np.zeros(1 << 24, np.uint8)
    for part in np.array_split(np.flatnonzero(every), 1 + np.count_nonzero(every) // 20_000):
        index[part] = _nearest(_colors(part), palette)
    return palette, index


def _nearest(colors: np.ndarray, palette: np.ndarray) -> np.ndarray:
    a, b = colors.astype(np.float32), palette.astype(np.float32)
    return np.argmin((b * b).sum(1) - 2.0 * a @ b.T, axis=1)


def _indexed(frame: np.ndarray, palette: np.ndarray, index: np.ndarray):
    from PIL import Image

    picture = Image.fromarray(index[_codes(frame)])
    picture.putpalette(palette.tobytes())
    return picture


def _codes(image: np.ndarray) -> np.ndarray:
    wide = image.astype(np.uint32)
    return wide[..., 0] << 16 | wide[..., 1] << 8 | wide[..., 2]


def _colors(codes: np.ndarray) -> np.ndarray:
    return np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=1).astype(np.uint8)


def check(function: str, frames: Sequence[np.ndarray]) -> None:
    """Refuse what are no frames of one film: ValueError in the name of a function."""
    if not frames:
        raise ValueError(f"{function}: frames must not be empty. Give at least one.")
    for image in frames:
        if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3 or 0 in image.shape:
            raise ValueError(f"{function}: image must be uint8 (h, w, 3); got {image.dtype} {image.shape}.")
        if image.shape != frames[0].shape:
            raise ValueError(
                f"{function}: frames must be of one shape; got {image.shape} and {frames[0].shape}."
            )
