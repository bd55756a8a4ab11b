"""Where a golden lies, and which of the files there belong together, even where a writer was killed."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from lietool import atomic, paths
from lietool.golden import picture

T = TypeVar("T")

LABELS = "labels"
SHA = "numbers-sha256"
"""Under which a picture carries the digest of its numbers."""


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

    @classmethod
    def beside(cls, file: Path, chapter: str, plate: str) -> "Place":
        """Return the place of a plate by the file of its figure: beside the folder of figures it is in."""
        folder = file.parent.parent if chapter else file.parent
        return cls(paths.GOLDEN if folder == paths.FIGURES else folder.parent / "golden", chapter, plate)

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


def settle(place: Place) -> None:
    """Finish, or forget, what somebody who wrote a golden and was killed has left of it.

    The caller holds `folder.lock`.

    Parameters
    ----------
    place : Place
        Where it lies.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    left = pending(place)
    if not left.is_file():
        return
    if remembered(place).get(SHA) == digest(left.read_bytes()):
        left.replace(atomic.target(place.json)[0])
    else:
        left.unlink(missing_ok=True)


def remembered(place: Place) -> dict[str, str]:
    """Read what a picture says of itself, be it ever so damaged.

    Parameters
    ----------
    place : Place
        Where it should lie.

    Returns
    -------
    dict
        What can still be read; perhaps nothing.
    """
    try:
        return picture.told(place.png.read_bytes())
    except (OSError, picture.PictureError):
        return {}


def pending(place: Place) -> Path:
    """Return the file for the numbers of a picture to come, beside the one that it will replace."""
    try:
        final = place.json.resolve()
    except RuntimeError:
        # A loop of links, which whoever opens it will be told of.
        final = place.json
    return final.with_name(f".{final.name}.next")


def whole(place: Place, look: Callable[[bytes], tuple[T, dict[str, str]]]) -> tuple[T, dict[str, str], bytes]:
    """Read a picture and the numbers that belong to it, even while somebody else writes both.

    Parameters
    ----------
    place : Place
        Where they should lie.
    look : callable
        From the bytes of a picture to what is wanted of it, and its texts.

    Returns
    -------
    tuple
        What is wanted, the texts, and the numbers' file.

    Raises
    ------
    GoldenError
        If they are missing, torn or half accepted.
    """
    before = None
    while True:
        files = _files(place)
        try:
            return _paired(place, files, look)
        except GoldenError:
            # Seen twice the same, nobody is at work on it.
            if files == before:
                raise
            before = files


def _files(place: Place) -> tuple[bytes | None, ...]:
    found = []
    for path in (place.png, place.json, pending(place)):
        try:
            found.append(path.read_bytes())
        except (FileNotFoundError, NotADirectoryError):
            found.append(None)
        except OSError as error:
            raise GoldenError("torn", f"{path} cannot be read ({error.strerror})") from error
    return tuple(found)


def _paired(
    place: Place,
    files: tuple[bytes | None, ...],
    look: Callable[[bytes], tuple[T, dict[str, str]]],
) -> tuple[T, dict[str, str], bytes]:
    data, *texts = files
    if data is None and texts[0] is None:
        raise GoldenError("missing", f"there is no golden at {place.png}")
    if data is None:
        raise GoldenError("half accepted", f"{place.png} is missing beside its other half")
    try:
        seen, found = look(data)
    except picture.PictureError as error:
        raise GoldenError("torn", f"{place.png} cannot be decoded: it {error.what}") from error
    for text in texts:
        # A checkout may have turned the ends of lines.
        if text is not None and digest(turned := text.replace(b"\r\n", b"\n")) == found.get(SHA):
            return seen, found, turned
    if texts == [None, None]:
        raise GoldenError("half accepted", f"{place.json} is missing beside its other half")
    raise GoldenError("half accepted", f"{place.png} does not belong to {place.json.name}")


def digest(text: bytes) -> str:
    """Return the SHA-256 of a file's bytes, in hexadecimal."""
    return hashlib.sha256(text).hexdigest()
