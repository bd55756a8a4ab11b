"""Exercises as an assignment for a class: what it consists of, and the folder that it is written to."""

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lietool import figure as figures
from lietool import paths
from lietool.exercise import load, picture
from lietool.exercise.record import Exercise

# It says what is ours in a folder: only that may be replaced.
MARK = ".lietool-export"
_TEMPLATES = Path(__file__).with_name("export_files")
_SCRIPT = b"#!"


class ExportError(ValueError):
    """An assignment that cannot be written; the message is one line and says what to do."""


@dataclass(frozen=True, eq=False)
class Assignment:
    """Exercises that are handed out together.

    Parameters
    ----------
    exercises : tuple of Exercise
        In the order of the book.
    seed : int
        Of the random inputs that marks are given for.
    own : mapping from str to bytes
        What of a teacher's project is needed to grade them, by paths that begin with ``project/``.
    """

    exercises: tuple[Exercise, ...]
    seed: int = 0
    own: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def total(self) -> int:
        """All points."""
        return sum(exercise.total for exercise in self.exercises)


def gather(names: Sequence[str], seed: int = 0) -> Assignment:
    """Return an assignment of some exercises.

    Parameters
    ----------
    names : sequence of str
        Without them it is all.
    seed : int
        Of the random inputs.

    Raises
    ------
    ExerciseError
        If there is no such exercise, or one is broken.
    ExportError
        If there is none at all.
    """
    wanted = {load.load(name).name for name in names}
    known = load.names()
    exercises = tuple(load.load(name) for name in known if name in wanted or not names)
    if not exercises:
        raise ExportError("there is no exercise to be exported. Write one, or name a project that has some")
    return Assignment(exercises, seed, _own([known[exercise.name] for exercise in exercises]))


def _own(files: Sequence[Path]) -> dict[str, bytes]:
    """What of the project has to travel: exercises with what they share, figures and their goldens."""
    project = figures.project()
    mine = [file for file in files if file.parent != paths.EXERCISES]
    if project is None or not mine:
        return {}
    mine += sorted((project / "exercises").glob("_*.py"))
    for folder in ("figures", "golden"):
        mine += sorted(path for path in (project / folder).rglob("*") if path.is_file())
    found = {path.relative_to(project): path for path in mine if "__pycache__" not in path.parts}
    # Without a folder of figures it would be no project.
    return {"project/figures/.keep": b""} | {
        f"project/{name.as_posix()}": path.read_bytes() for name, path in found.items()
    }


def statement(exercise: Exercise) -> str:
    """Return what is to be done, in markdown; it shows the plate as `plate_file` calls it."""
    # The first line of a docstring is its title, and the exercise has its own.
    _, _, text = exercise.statement.partition("\n")
    # |q| in a title is no end of a cell.
    rows = [f"| {check.title.replace('|', chr(92) + '|')} | {check.points} |" for check in exercise.checks]
    rows.append(
        f"| the picture {exercise.picture.plate}, drawn with your function | {exercise.picture.points} |"
    )
    return "\n".join(
        [
            f"# {exercise.number}. {exercise.title} ({', '.join(exercise.equations)})",
            f"\n{text.strip()}\n",
            "| what is checked | points |",
            "| --- | ---: |",
            *rows,
            f"\nThe picture that it is about:\n\n![plate {exercise.picture.plate}]({plate_file(exercise)})\n",
        ]
    )


def plate_file(exercise: Exercise) -> str:
    """Return the name of the file with the plate of an exercise."""
    return f"{exercise.picture.plate}.png"


def plate(exercise: Exercise) -> bytes:
    """Return the plate of an exercise as it should be, as PNG; raises ExerciseError."""
    return picture.file(exercise.picture.plate).read_bytes()


def file_name(exercise: Exercise) -> str:
    """Return the name of the file that a student writes."""
    return f"{exercise.name.replace('-', '_')}.py"


def template(name: str, **values: object) -> bytes:
    """Return one of the texts in ``export_files/``, with ``@name@`` replaced by its value."""
    text = (_TEMPLATES / name).read_text(encoding="utf-8")
    for key, value in values.items():
        text = text.replace(f"@{key}@", str(value))
    return text.encode()


def stranger(folder: Path) -> str:
    """Return why a folder must not be written to; empty if it may.

    Parameters
    ----------
    folder : Path
        Where an assignment is to go; it need not exist.

    Returns
    -------
    str
        What is in it that no export has put there, or that has been changed since.
    """
    if not folder.exists():
        return "it is a link that leads nowhere" if folder.is_symlink() else ""
    if not folder.is_dir():
        return "it is a file"
    if folder.resolve() == Path.cwd():
        return "it is the folder that you are in"
    inside = sorted(path for path in folder.rglob("*") if path.is_symlink() or not path.is_dir())
    if not inside:
        return ""
    try:
        known = json.loads((folder / MARK).read_bytes())["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return f"it holds {inside[0].relative_to(folder)} and was not made by `lietool exercise export`"
    for path in inside:
        name = path.relative_to(folder).as_posix()
        if name != MARK and name not in known:
            return f"it holds {name}, which no export has put there"
        if name != MARK and (path.is_symlink() or _digest(path.read_bytes()) != known[name]):
            return f"{name} in it has been changed since it was exported"
    return ""


def publish(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write a folder so that it is there whole or not at all; an older export is replaced.

    The caller has seen that it is no `stranger`.

    Parameters
    ----------
    folder : Path
        Where to.
    files : mapping from str to bytes
        By their paths in it; what begins with ``#!`` can be executed.

    Raises
    ------
    OSError
        If it cannot be written; what was there is there still.
    """
    folder = folder.resolve()
    folder.parent.mkdir(parents=True, exist_ok=True)
    # Beside it, since a rename is atomic only within one file system.
    work = Path(tempfile.mkdtemp(prefix=f".{folder.name[:40]}.", suffix=".part", dir=folder.parent))
    try:
        made, old = work / "new", work / "old"
        _write(made, files)
        if folder.exists():
            folder.rename(old)
        try:
            made.rename(folder)
        except BaseException:
            if old.exists():
                old.rename(folder)
            raise
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _write(folder: Path, files: Mapping[str, bytes]) -> None:
    folder.mkdir()
    mark = {
        "says": "Written by `lietool exercise export`.",
        "files": {x: _digest(files[x]) for x in sorted(files)},
    }
    for name, data in {**files, MARK: (json.dumps(mark, indent=1) + "\n").encode()}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if data.startswith(_SCRIPT):
            # Whoever may read it may run it.
            mode = path.stat().st_mode
            path.chmod(mode | (mode & 0o444) >> 2)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
