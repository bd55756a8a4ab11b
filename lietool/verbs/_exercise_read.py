"""Submissions as files: what each is for, its text, or why it has none; nothing in it is run here."""

import hashlib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from lietool.exercise import load
from lietool.figure import nearest, quoted
from lietool.verbs import _studio

# In bytes: the longest solution has some thousands.
_MOST = 1 << 20


@dataclass(frozen=True)
class Submission:
    """A file that somebody has handed in.

    Parameters
    ----------
    file : str
        As it was named, printable.
    path : Path
        Where it is.
    exercise : str
        What it is for; empty where that is not known.
    source : str
        Its text.
    digest : str
        SHA-256 of the text; empty where there is none.
    trouble : str
        Why it cannot be graded, in a line.
    """

    file: str
    path: Path
    exercise: str = ""
    source: str = ""
    digest: str = ""
    trouble: str = ""


def printable(text: str) -> str:
    """Return a text in which nothing can move the cursor, ring, or turn the direction of writing."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def read(paths: Sequence[Path], name: str | None) -> list[Submission]:
    """Read submissions.

    Parameters
    ----------
    paths : sequence of Path
        The files; a file that is named twice is read once.  Without them it is all that has been started in
        this folder.
    name : str, optional
        The exercise that they are for; else the first lines of each say.

    Returns
    -------
    list of Submission
        By the names of the files.

    Raises
    ------
    Stop
        With 2 if nothing has been started here.
    ExerciseError
        If there is no such exercise.
    """
    known = load.names()
    if name is not None:
        name = load.load(name).name
    if not paths:
        paths = list(_started(name))
        if not paths:
            raise _studio.Stop(
                2,
                "nothing has been started in this folder. Write lietool exercise start NAME, or name a file",
            )
    ordered = sorted(dict.fromkeys(paths), key=lambda path: (path.name, str(path)))
    return [_read(path, name, known) for path in ordered]


def _started(name: str | None) -> Iterator[Path]:
    for path in sorted(Path().glob("*.py")):
        made = _read(path, None, load.names())
        if made.exercise and name in (None, made.exercise):
            yield path


def _read(path: Path, name: str | None, known: Collection[str]) -> Submission:
    file = printable(str(path))
    data, trouble = _bytes(path)
    if trouble:
        return Submission(file, path, name or "", trouble=trouble)
    try:
        # An editor on Windows begins a file with a mark.
        source = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return Submission(file, path, name or "", trouble=f"it is no text: byte {error.start} is not UTF-8")
    if "\0" in source:
        return Submission(file, path, name or "", trouble="it is no text: it has a NUL character")
    exercise, trouble = _meant(source, name, known)
    digest = hashlib.sha256(source.encode()).hexdigest()
    return Submission(file, path, exercise, source, digest, trouble)


def _bytes(path: Path) -> tuple[bytes, str]:
    """Return what is in a file, or why nothing can be read."""
    try:
        if path.is_dir():
            return b"", "it is a folder. Name the files in it"
        if path.exists() and not path.is_file():
            return b"", "it is a device or a pipe, and no file"
        with path.open("rb") as file:
            data = file.read(_MOST + 1)
    except OSError as error:
        return b"", "there is no such file" if isinstance(error, FileNotFoundError) else _reason(error)
    if len(data) > _MOST:
        return b"", f"it is too large: more than {_MOST >> 20} MiB"
    return data, ""


def _reason(error: OSError) -> str:
    return f"it cannot be read: {error.strerror or type(error).__name__}"


def _meant(source: str, name: str | None, known: Collection[str]) -> tuple[str, str]:
    """Return the exercise that a submission is for, or why that is not known."""
    said = load.which(source)
    if name is not None:
        return name, ""
    if said is None:
        first = f"{load.HEADER}NAME"
        return "", f"its first lines do not say what it is for ({first}). Give --exercise NAME"
    if said not in known:
        return (
            "",
            f"no exercise {quoted(said)}.{nearest(said, known)} Correct it, or give --exercise",
        )
    return said, ""
