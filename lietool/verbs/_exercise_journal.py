"""What has been graded already: kept as it comes, so that a run that was killed goes on where it was.

A record is one file, written whole; its name is a digest of all that the marks depend on.  It lies in the
grader's folder for what can be made again, which no submission can write to.
"""

import base64
import functools
import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lietool import __version__, atomic, cache, figure, paths
from lietool.exercise import Exercise
from lietool.exercise.outcome import Graded

_FORMAT = 1


@dataclass(frozen=True, eq=False)
class Record:
    """What grading a text gave.

    Parameters
    ----------
    about : mapping
        As `Graded.as_json`.
    drawn : bool
        Whether the student's function could be drawn.
    picture : bytes, optional
        That, as PNG; None where it is the plate to the last bit.
    """

    about: Mapping[str, Any]
    drawn: bool = False
    picture: bytes | None = None


def record(graded: Graded) -> Record:
    """Make a record of what grading gave."""
    from lietool.golden import explain

    shown = graded.shown
    if shown is None or shown.student is None:
        return Record(graded.as_json())
    same = np.array_equal(shown.student, shown.reference)
    return Record(graded.as_json(), True, None if same else explain.png(shown.student))


class Journal:
    """The records of earlier runs, and of this one.

    Parameters
    ----------
    fresh : bool
        Whether those of earlier runs are left alone.
    """

    def __init__(self, fresh: bool = False) -> None:
        self._folder, self._fresh = cache.folder("exercises"), fresh

    def key(self, exercise: Exercise, digest: str, seed: int, picture: bool) -> str:
        """Return the name of a record: a digest of all that the marks depend on."""
        wanted = _wanted(exercise.picture.plate) if picture else ""
        told = [_FORMAT, __version__, _edition(), exercise.name, wanted, seed, digest]
        return hashlib.sha256(json.dumps(told).encode()).hexdigest()

    def read(self, key: str) -> Record | None:
        """Return a record; None where there is none, or what is there is none."""
        if self._fresh or self._folder is None:
            return None
        try:
            kept = json.loads(self._file(key).read_bytes())
            picture = kept["picture"]
            return Record(kept["about"], kept["drawn"], picture and base64.b64decode(picture))
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def keep(self, key: str, made: Record) -> None:
        """Keep a record; where it cannot be, a later run grades once more."""
        if self._folder is None:
            return
        picture = made.picture and base64.b64encode(made.picture).decode()
        kept = {"about": made.about, "drawn": made.drawn, "picture": picture}
        try:
            atomic.write_bytes(self._file(key), json.dumps(kept).encode())
        except OSError:
            return

    def _file(self, key: str) -> Path:
        assert self._folder is not None
        return self._folder / key[:2] / f"{key}.json"


@functools.cache
def _edition() -> str:
    """Return a digest of all sources that marks depend on, of figures and exercises too."""
    folders = [paths.PACKAGE, paths.FIGURES, paths.EXERCISES]
    if own := figure.project():
        folders += [own / "figures", own / "exercises"]
    made = hashlib.sha256()
    for folder in folders:
        for file in sorted(folder.rglob("*")):
            if file.suffix in (".py", ".toml", ".vert", ".frag", ".glsl") and file.is_file():
                made.update(f"{file.relative_to(folder)}\n".encode() + file.read_bytes())
    return made.hexdigest()


@functools.cache
def _wanted(plate: str) -> str:
    """Return a digest of the picture that a plate must be."""
    from lietool.exercise import picture

    return hashlib.sha256(picture.golden(plate).image.tobytes()).hexdigest()
