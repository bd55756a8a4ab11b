"""Files of a user: reading them, and saying where something in them is wrong."""

from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

BROKEN = (ArithmeticError, AttributeError, LookupError, NameError, RuntimeError, TypeError, ValueError)
"""What the libraries that read files raise for broken ones, beside errors of their own."""

_MOST = 512 * 1024 * 1024


@dataclass(frozen=True)
class Place:
    """A file, and the function that reads it, for messages."""

    where: str
    path: Path

    def cause(self, error: Exception) -> str:
        """Return the first line of what another library said."""
        return next(iter(str(error).strip().splitlines()), type(error).__name__)

    def fail(self, must: str, got: str, line: int | None = None, remedy: str = "") -> NoReturn:
        """Raise the one-line ValueError that names the file and the line."""
        at = "" if line is None else f" in line {line}"
        tail = f" {remedy}" if remedy else ""
        raise ValueError(f"{self.where}: {self.path} must be {must}; got {got}{at}.{tail}")


def read_bytes(place: Place) -> bytes:
    """Return what is in a file.

    Raises
    ------
    ValueError
        If there is no such file, or it cannot be read, or is empty.
    """
    try:
        if place.path.is_file() and place.path.stat().st_size > _MOST:
            place.fail("of at most 512 MiB", f"{place.path.stat().st_size >> 20} MiB")
        data = place.path.read_bytes()
    except FileNotFoundError:
        place.fail("a file", "none of that name", remedy="Check the path.")
    except IsADirectoryError:
        place.fail("a file", "a folder")
    except (OSError, ValueError) as error:
        if isinstance(error, ValueError) and str(error).startswith(place.where):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        place.fail("a file that can be read", reason.lower())
    if not data.strip():
        place.fail("a file with something in it", "an empty one")
    return data


def read_text(place: Place) -> str:
    """Return the text in a file.

    Raises
    ------
    ValueError
        As `read_bytes`, or if it is not text in UTF-8.
    """
    data = read_bytes(place)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        place.fail("text in UTF-8", f"byte 0x{data[error.start]:02x}", line)
