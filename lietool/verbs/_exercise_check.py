"""`lietool exercise check`: from files to marks: in a terminal, as JSON, tables, pages, pictures."""

import json
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from lietool import atomic
from lietool.exercise import Exercise, load
from lietool.exercise.record import NoGoldenError
from lietool.verbs import _exercise_class, _exercise_csv, _exercise_read, _exercise_tell, _studio
from lietool.verbs._exercise_class import Marked

_WRONG = 5
_NO_GOLDEN = 3


@dataclass(frozen=True)
class Wanted:
    """What the command line asks for."""

    exercise: str | None = None
    seed: int = 0
    pictures: Path | None = None
    report: Path | None = None
    csv: Path | None = None
    jobs: int = 1
    fresh: bool = False
    as_json: bool = False


def run(paths: Sequence[Path], wanted: Wanted) -> int:
    """Grade files and say what came of it.

    Parameters
    ----------
    paths : sequence of Path
        Submissions; without them all that has been started in this folder.
    wanted : Wanted

    Returns
    -------
    int
        0 if every submission has all of its points, else 5.

    Raises
    ------
    Stop
        With 2 if the only file cannot be read, or a result cannot be written, and 3 if the plate of an
        exercise has no golden.
    ExerciseError
        If there is no such exercise, or it is broken.
    """
    submissions = _exercise_read.read(paths, wanted.exercise)
    if len(submissions) == 1 and submissions[0].trouble:
        raise _studio.Stop(2, f"{submissions[0].file}: {submissions[0].trouble}")
    _prepare(wanted)
    names = dict.fromkeys(each.exercise for each in submissions if each.exercise)
    exercises = {name: load.load(name) for name in load.names() if name in names}
    note = _studio.current().trouble
    if not note:
        _goldens(exercises.values())
    if len(submissions) == 1:
        marked = [_exercise_class.alone(submissions[0], wanted.seed, not note)]
    else:
        marked = _exercise_class.together(
            submissions,
            exercises,
            seed=wanted.seed,
            picture=not note,
            jobs=wanted.jobs,
            fresh=wanted.fresh,
        )
    rows = _exercise_tell.rows(marked, exercises, not note)
    code = 0 if all(row.full for row in rows) else _WRONG
    saved, lost = _saved(marked, wanted)
    _files(marked, rows, exercises, wanted, note)
    if wanted.as_json:
        click.echo(json.dumps(_told(marked, rows, code, note), indent=2, ensure_ascii=False))
    else:
        _print(marked, rows, saved, note, wanted)
    if lost:
        click.echo(lost, err=True)
    return code


def _prepare(wanted: Wanted) -> None:
    """Find out before minutes of grading what cannot be written after them."""
    for path in (wanted.csv, wanted.report and wanted.report / "index.html"):
        if path is not None:
            with _studio.writing(str(path)):
                _try_folder(atomic.target(path)[0].parent)
    if wanted.pictures is not None:
        with _studio.writing(str(wanted.pictures)):
            _try_folder(wanted.pictures)


def _goldens(exercises: Iterable[Exercise]) -> None:
    from lietool.exercise import picture

    for exercise in exercises:
        try:
            picture.golden(exercise.picture.plate)
        except NoGoldenError as error:
            raise _studio.Stop(_NO_GOLDEN, str(error)) from None


def _try_folder(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    # Only a file shows whether there can be one: the mode of a folder says nothing of a read-only disk.
    with tempfile.TemporaryFile(dir=folder):
        pass


def _saved(marked: Sequence[Marked], wanted: Wanted) -> tuple[dict[str, Path], str]:
    """Save pictures; return the file of each submission, and why there is none where nobody has named one."""
    saved: dict[str, Path] = {}
    for each, stem in zip(marked, stems([each.submission.path for each in marked]), strict=True):
        data = _drawn(each)
        if data is None or (len(marked) > 1 and wanted.pictures is None):
            continue
        assert each.record is not None
        folder = wanted.pictures or each.submission.path.parent
        path = folder / f"{stem}-{each.record.about['picture']['plate']}.png"
        try:
            with _studio.writing(str(path)):
                atomic.write_bytes(path, data)
        except _studio.Stop as stop:
            # A folder of submissions may be read-only: that must not cost the marks.
            if wanted.pictures is not None:
                raise
            return {}, f"{stop.message}. Name a folder: -o DIR"
        saved[each.submission.file] = path
    return saved, ""


def stems(paths: Sequence[Path]) -> list[str]:
    """Return a name for each file, without its ending, that none of the others has in any case of letters."""
    taken: set[str] = {"index"}
    made = []
    for path in paths:
        base = "".join(c if c.isalnum() or c in "-_." else "_" for c in path.stem).strip(".") or "file"
        name, number = base, 1
        while name.casefold() in taken:
            number += 1
            name = f"{base}-{number}"
        taken.add(name.casefold())
        made.append(name)
    return made


def _drawn(each: Marked) -> bytes | None:
    """The picture that a submission draws, as PNG."""
    from lietool.exercise import picture
    from lietool.golden import explain

    if each.record is None or not each.record.drawn:
        return None
    # It is kept only where it is another than the plate.
    return each.record.picture or explain.png(picture.golden(each.record.about["picture"]["plate"]).image)


def _files(
    marked: Sequence[Marked],
    rows: Sequence[_exercise_tell.Row],
    exercises: Mapping[str, Exercise],
    wanted: Wanted,
    note: str,
) -> None:
    if wanted.csv is not None:
        order = dict.fromkeys(
            title for x in exercises.values() for title in _exercise_tell.titles(x, not note)
        )
        with _studio.writing(str(wanted.csv)):
            atomic.write_bytes(wanted.csv, _exercise_csv.dumps(rows, list(order)).encode())
    if wanted.report is not None:
        from lietool.verbs import _exercise_pages

        with _studio.writing(str(wanted.report)):
            names = stems([each.submission.path for each in marked])
            _exercise_pages.write(wanted.report, marked, rows, exercises, names, [note] if note else [])


def _told(
    marked: Sequence[Marked], rows: Sequence[_exercise_tell.Row], code: int, note: str
) -> dict[str, Any]:
    submissions = []
    for each, row in zip(marked, rows, strict=True):
        told: dict[str, Any] = {"file": row.file}
        if each.record is None:
            told |= {"exercise": row.exercise, "marks": 0, "of": row.of, "digest": row.digest}
        else:
            told |= each.record.about
        submissions.append(told | ({"trouble": each.trouble} if each.trouble else {}))
    about: dict[str, Any] = {"exit": code, "note": note, "submissions": submissions}
    return about | ({"summary": _exercise_tell.summary(rows)} if len(rows) > 1 else {})


def _print(
    marked: Sequence[Marked],
    rows: Sequence[_exercise_tell.Row],
    saved: Mapping[str, Path],
    note: str,
    wanted: Wanted,
) -> None:
    if len(marked) == 1:
        (only,) = marked
        assert only.record is not None
        _exercise_tell.one(only.record.about, str(saved.get(only.submission.file, "")))
    else:
        _exercise_tell.several(rows)
    if note:
        click.echo(f"Pictures were not compared, and have no points here: {note}")
    for path in (wanted.csv, wanted.report and wanted.report / "index.html"):
        if path is not None:
            click.echo(f"{path} is written.")
