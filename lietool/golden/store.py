"""Goldens on disk: a picture and its numbers per plate, and the labels that the pictures share.

The picture carries the SHA-256 of its pixels and of the numbers.  Written in
the order labels, numbers under another name, picture, and then the numbers get
their own name: the picture's rename is the one moment at which the golden
changes.  A kill before it leaves the old golden; one after it leaves the new,
whose numbers are found under either name.
"""

import contextlib
import io
import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from lietool import atomic
from lietool.golden import numbers as numbers_
from lietool.golden import picture as picture_
from lietool.golden import place as place_
from lietool.golden.place import GoldenError as GoldenError
from lietool.golden.place import Place as Place
from lietool.golden.place import remembered as remembered
from lietool.golden.place import settle as settle

LABELS = place_.LABELS
_PIXELS = "pixels-sha256"
_KEYS = "label-keys"
# Depth and kind of colour in the header of a PNG: 8 bits of red, green and blue.
_HEADER = slice(24, 26)
_PLAIN = b"\x08\x02"


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
    image, found, text = place_.whole(place, _decode)
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
    _, found, _ = place_.whole(place, _texts)
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
    """Write a golden: labels, numbers and the picture, which carries the SHA-256 of the numbers.

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
    info.add_text(_PIXELS, _pixels(image))
    info.add_text(place_.SHA, place_.digest(text))
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG", pnginfo=info, optimize=True)
    for name, data in labels.items():
        atomic.write_bytes(place.labels / name, data)
    final, mode = atomic.target(place.json)
    pending = place_.pending(place)
    try:
        atomic.write_bytes(pending, text)
        pending.chmod(mode)
        atomic.write_bytes(place.png, file.getvalue())
    except OSError:
        # Only of these is it sure that the picture is still the old one.
        with contextlib.suppress(OSError):
            pending.unlink(missing_ok=True)
        raise
    pending.replace(final)


def _decode(data: bytes) -> tuple[np.ndarray, dict[str, str]]:
    decoded = picture_.decode(data, ".png")
    if data[_HEADER] != _PLAIN:
        raise picture_.PictureError("is not of 8 bits of red, green and blue", "Save it so")
    if decoded.texts.get(_PIXELS, said := _pixels(decoded.image)) != said:
        raise picture_.PictureError("has other pixels than were accepted", "Restore them")
    return decoded.image, dict(decoded.texts)


def _texts(data: bytes) -> tuple[None, dict[str, str]]:
    return None, picture_.told(data)


def _numbers(path: Path, text: bytes) -> dict[str, object]:
    try:
        return numbers_.loads(text.decode())
    except ValueError as error:
        raise GoldenError("torn", f"{path} cannot be read ({error})") from error


def _pixels(image: np.ndarray) -> str:
    """The digest of a picture itself, whatever its file is packed like."""
    height, width = image.shape[:2]
    return place_.digest(b"%dx%d " % (width, height) + image.tobytes())
