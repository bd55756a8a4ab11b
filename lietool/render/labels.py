"""Text as pictures: mathematical labels, rasterised once and kept.

Text drifts with the version of the font rasteriser, so a golden picture never
depends on one: a label is drawn by matplotlib once, to coverage, and kept as a
small PNG under a name made from its text and size.  A store looks for it in its
folders first, then in the user's cache, and only then asks matplotlib.
"""

import contextlib
import hashlib
import io
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from lietool import atomic, cache, paths

# Part of every key: what is drawn for a text changes only together with this.
FORMAT = "cm-1"
# What is no mathematics in a text; the rest is in the fonts of the same family.
FONT = "cmr10"
# Rasterising larger and averaging gives the same shape wherever a glyph falls on the pixels.
_OVERSAMPLE = 4


class MissingLabelError(LookupError):
    """A label that a strict store does not hold."""

    def __init__(self, text: str, pixels: float) -> None:
        super().__init__(
            f"label {text!r} at {pixels:g} px is not in the label store; accept the plate to add it"
        )
        self.text = text
        self.pixels = pixels


@dataclass(frozen=True, eq=False)
class Glyphs:
    """A rasterised label.

    Parameters
    ----------
    coverage : ndarray of uint8, shape (h, w)
    baseline : int
        Rows from the lower edge up to the base line.
    key : str
        The name of its file in a store, without the ending.
    """

    coverage: np.ndarray
    baseline: int
    key: str


def key(text: str, pixels: float) -> str:
    """Return the name under which a label is kept.

    Parameters
    ----------
    text : str
        Mathtext.
    pixels : float
        Type size in pixels.

    Returns
    -------
    str
        A readable stem and a digest of text, size and format.
    """
    digest = hashlib.sha256(f"{FORMAT}\n{pixels:.2f}\n{text}".encode()).hexdigest()[:12]
    stem = re.sub(r"[^0-9A-Za-z]+", "-", text).strip("-").lower()[:24] or "sign"
    return f"{stem}-{digest}"


@dataclass
class Store:
    """Where labels come from.

    Parameters
    ----------
    folders : sequence of Path
        Looked through in this order; never written to.
    strict : bool
        Raise `MissingLabelError` for a label that the folders do not hold,
        instead of rasterising it.
    """

    folders: Sequence[Path] = (paths.GOLDEN / "labels",)
    strict: bool = False
    _new: dict[str, tuple[Glyphs, str]] = field(default_factory=dict, init=False)

    def get(self, text: str, pixels: float) -> Glyphs:
        """Return the label, from the folders, the user's cache, or new.

        Parameters
        ----------
        text : str
            Mathtext.
        pixels : float
            Type size in pixels.

        Returns
        -------
        Glyphs
            `fresh` gains its file where the folders do not hold it.

        Raises
        ------
        MissingLabelError
            If the store is strict and the folders do not hold it.
        ValueError
            If the text is not mathtext.
        """
        name = key(text, pixels)
        for folder in self.folders:
            if glyphs := _read(Path(folder) / f"{name}.png"):
                return glyphs
        if self.strict:
            raise MissingLabelError(text, pixels)
        kept = _kept()
        glyphs = _read(kept / f"{name}.png") if kept else None
        if glyphs is None:
            glyphs = Glyphs(*rasterise(text, pixels), name)
            if kept:
                # A disk that is full costs time, never the picture.
                with contextlib.suppress(OSError):
                    atomic.write_bytes(kept / f"{name}.png", encode(glyphs, text))
        self._new[f"{name}.png"] = glyphs, text
        return glyphs

    @property
    def fresh(self) -> dict[str, bytes]:
        """File names and contents of the labels that were asked for and that the folders do not hold."""
        return {name: encode(glyphs, text) for name, (glyphs, text) in self._new.items()}


def _kept() -> Path | None:
    """The cache of the matplotlib that is installed: another one may draw the same text otherwise."""
    return cache.folder(f"labels-{_version()}")


@lru_cache(maxsize=1)
def _version() -> str:
    from importlib import metadata

    return metadata.version("matplotlib")


@lru_cache(maxsize=512)
def _decode(path: Path, stamp: int) -> Glyphs | None:
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as image:
            # A byte that flipped would otherwise decode to another shape.
            image.verify()
        with Image.open(path) as image:
            baseline = int(image.info["Baseline"])
            return Glyphs(np.array(image.convert("L")), baseline, path.stem)
    except (OSError, UnidentifiedImageError, SyntaxError, KeyError, ValueError):
        # A file that somebody tore is as good as none: it is made again.
        return None


def _read(path: Path) -> Glyphs | None:
    try:
        return _decode(path, path.stat().st_mtime_ns)
    except OSError:
        return None


def encode(glyphs: Glyphs, text: str) -> bytes:
    """Return a label as the bytes of its PNG file, which carries its text and base line."""
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_text("Baseline", str(glyphs.baseline))
    info.add_itxt("Text", text)
    file = io.BytesIO()
    Image.fromarray(glyphs.coverage).save(file, "PNG", pnginfo=info, optimize=True)
    return file.getvalue()


def rasterise(text: str, pixels: float) -> tuple[np.ndarray, int]:
    """Draw mathtext with matplotlib.

    Parameters
    ----------
    text : str
        Mathtext; its fonts come with matplotlib, none of the system's is used.
    pixels : float
        Type size in pixels.

    Returns
    -------
    coverage : ndarray of uint8, shape (h, w)
    baseline : int
        Rows from the lower edge up to the base line.

    Raises
    ------
    ValueError
        If the text is not mathtext.
    """
    with typesetting():
        from matplotlib.font_manager import FontProperties
        from matplotlib.mathtext import MathTextParser

        # The error quotes the text and a caret before it comes to the point in its last line.
        try:
            drawn = MathTextParser("agg").parse(
                text, 72, FontProperties(size=pixels * _OVERSAMPLE, family=FONT)
            )
        except ValueError as error:
            reason = str(error).strip().splitlines()[-1]
            raise ValueError(f"labels.rasterise: text must be mathtext; got {text!r} ({reason})") from None
    fine = np.asarray(drawn.image, float)
    return _average(fine, round(drawn.depth))


@contextlib.contextmanager
def typesetting(settings: Mapping[str, Any] = MappingProxyType({})) -> Iterator[None]:
    """Let matplotlib set text as every label is set, whatever its user has chosen; `settings` come on top."""
    if kept := cache.folder("matplotlib"):
        # Else it complains on stderr where there is no home to write to.
        os.environ.setdefault("MPLCONFIGDIR", str(kept))
    import logging

    # Where it keeps its own cache, and which glyphs it lacks, is no message for the user of a figure.
    for name in ("matplotlib", "fontTools"):
        logging.getLogger(name).setLevel(logging.ERROR)
    import matplotlib

    fonts: Any = {"mathtext.fontset": "cm", "font.family": FONT, "text.hinting": "none"}
    with matplotlib.rc_context(fonts | dict(settings)):
        yield


def _average(fine: np.ndarray, depth: int) -> tuple[np.ndarray, int]:
    n = _OVERSAMPLE
    rows, columns = fine.shape
    # Whole pixels on both sides of the base line, and an empty rim for the halo to start from.
    below = -(-depth // n) + 1
    above = -(-(rows - depth) // n) + 1
    wide = -(-columns // n) + 2
    padded = np.zeros(((above + below) * n, wide * n))
    top = above * n - (rows - depth)
    padded[top : top + rows, n : n + columns] = fine
    coarse = padded.reshape(above + below, n, wide, n).mean(axis=(1, 3))
    return np.rint(coarse).astype(np.uint8), below
