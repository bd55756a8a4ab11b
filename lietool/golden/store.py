"""Goldens on disk: a picture and its numbers per plate, and the labels that the pictures share.

Written in the order labels, numbers, picture, each file at once, and the
picture carries the SHA-256 of the numbers.  So a kill at any moment leaves the
old golden, the new one, or a pair that does not belong together and says so.
"""

import contextlib
import hashlib
import io
import json
import zlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError
from PIL.PngImagePlugin import PngImageFile, PngInfo

from lietool import atomic
from lietool.golden import numbers as numbers_

LABELS = "labels"
_TooLarge = Image.DecompressionBombError
_SHA = "numbers-sha256"
_KEYS = "label-keys"


class GoldenError(Exception):
    """A golden that cannot be compared with; `kind` is "missing", "torn" or "half accepted"."""

    def __init__(self, kind: str, message: str) -> None:
        super().__init__(message)
        self.kind = kind


@dataclass(frozen=True)
class Place:
    """Where the golden of one plate lies: `root`/`chapter`/`plate`.png and .json."""

    root: Path
    chapter: str
    plate: str

    @property
    def png(self) -> Path:
        """The picture."""
        return self.root / self.chapter / f"{self.plate}.png"

    @property
    def json(self) -> Path:
        """The numbers."""
        return self.root / self.chapter / f"{self.plate}.json"

    @property
    def labels(self) -> Path:
        """The folder of the labels, shared by all plates."""
        return self.root / LABELS


@dataclass(frozen=True, eq=False)
class Golden:
    """A golden that is whole: its picture (h, w, 3) uint8, its numbers, and where they come from."""

    image: np.ndarray
    numbers: dict[str, object]
    provenance: dict[str, str]


def read(place: Place) -> Golden:
    """Read the golden of a plate.

    Parameters
    ----------
    place : Place
        Where it should lie.

    Returns
    -------
    Golden
        Picture and numbers that belong together.

    Raises
    ------
    GoldenError
        If it is missing, torn or half accepted.
    """
    data, text = _bytes(place)
    image, found = _decode(place.png, data)
    _belong_together(place, text, found)
    return Golden(image, _numbers(place.json, text), found)


def provenance(place: Place) -> dict[str, str]:
    """Read where a golden comes from, without decoding its picture.

    Parameters
    ----------
    place : Place
        Where it should lie.

    Returns
    -------
    dict
        What `write` was given, and more that it added.

    Raises
    ------
    GoldenError
        As `read`, but for damage among the pixels.
    """
    data, text = _bytes(place)
    with _undamaged(place.png), Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
        found = _texts(picture)
    _belong_together(place, text, found)
    return found


def label_keys(found: Mapping[str, str]) -> frozenset[str]:
    """Read from a golden's provenance which labels it was drawn with.

    Parameters
    ----------
    found : Mapping[str, str]
        As `provenance` returns it.

    Returns
    -------
    frozenset of str
        Names of label files, without the ending.

    Raises
    ------
    GoldenError
        If they cannot be read.
    """
    try:
        return frozenset(map(str, json.loads(found.get(_KEYS, "[]"))))
    except (ValueError, TypeError) as error:
        raise GoldenError("torn", f"its label keys cannot be read ({error})") from error


def write(
    place: Place,
    image: np.ndarray,
    numbers: numbers_.Numbers,
    *,
    labels: Mapping[str, bytes],
    label_keys: Collection[str],
    provenance: Mapping[str, str],
) -> None:
    """Write a golden: labels, then numbers, then the picture that carries the numbers' SHA-256.

    The caller holds `folder.lock`.

    Parameters
    ----------
    place : Place
        Where to.
    image : (h, w, 3) uint8
        The picture, sRGB.
    numbers : Mapping[str, object]
        The numbers shown, all finite.
    labels : Mapping[str, bytes]
        Label files that are not there yet, by name.
    label_keys : Collection[str]
        All labels in the picture.
    provenance : Mapping[str, str]
        What the picture should remember.

    Raises
    ------
    ValueError
        If a number is not finite or of no kind that can be kept; then nothing is written.
    OSError
        If the folder cannot be written.
    """
    if bad := numbers_.nonfinite(numbers):
        raise ValueError(
            f"store.write: the numbers of {place.plate} must be finite; got {', '.join(bad)}. "
            "Leave such places out, or show them by a truth value."
        )
    text = numbers_.dumps(numbers).encode()
    info = PngInfo()
    for key, value in provenance.items():
        info.add_text(key, value)
    info.add_text(_KEYS, json.dumps(sorted(label_keys)))
    info.add_text(_SHA, _digest(text))
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG", pnginfo=info, optimize=True)
    for name, data in labels.items():
        atomic.write_bytes(place.labels / name, data)
    atomic.write_bytes(place.json, text)
    atomic.write_bytes(place.png, file.getvalue())


def _bytes(place: Place) -> tuple[bytes, bytes]:
    found = {}
    for path in (place.png, place.json):
        try:
            found[path] = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError as error:
            raise GoldenError("torn", f"{path} cannot be read ({error.strerror})") from error
    if not found:
        raise GoldenError("missing", f"there is no golden at {place.png}")
    for path in (place.png, place.json):
        if path not in found:
            raise GoldenError("half accepted", f"{path} is missing beside its other half")
    # A checkout may have turned the ends of lines.
    return found[place.png], found[place.json].replace(b"\r\n", b"\n")


@contextlib.contextmanager
def _undamaged(path: Path) -> Iterator[None]:
    try:
        yield
    except UnidentifiedImageError as error:
        # Pillow names the bytes in memory, which tells nobody anything.
        raise GoldenError("torn", f"{path} cannot be decoded (it is no PNG)") from error
    # All that Pillow raises for a file that is cut or changed.
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, zlib.error, _TooLarge) as error:
        raise GoldenError("torn", f"{path} cannot be decoded ({error})") from error


def _decode(path: Path, data: bytes) -> tuple[np.ndarray, dict[str, str]]:
    with _undamaged(path):
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            picture.verify()
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            image = np.array(picture)
            if picture.mode != "RGB":
                raise ValueError(f"mode {picture.mode} instead of RGB")
            return image, _texts(picture)


def _texts(picture: Image.Image) -> dict[str, str]:
    if not isinstance(picture, PngImageFile):
        return {}
    return {key: str(value) for key, value in picture.text.items()}


def _numbers(path: Path, text: bytes) -> dict[str, object]:
    try:
        return numbers_.loads(text.decode())
    except ValueError as error:
        raise GoldenError("torn", f"{path} cannot be read ({error})") from error


def _belong_together(place: Place, text: bytes, found: Mapping[str, str]) -> None:
    if found.get(_SHA) != _digest(text):
        raise GoldenError("half accepted", f"{place.png} does not belong to {place.json.name}")


def _digest(text: bytes) -> str:
    return hashlib.sha256(text).hexdigest()
