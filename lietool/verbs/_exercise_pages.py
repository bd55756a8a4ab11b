"""`lietool exercise check --report`: a page for each submission, and a table that leads to them."""

import functools
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lietool import atomic
from lietool.exercise import Exercise, picture
from lietool.golden import explain, marks_page
from lietool.verbs import _exercise_tell
from lietool.verbs._exercise_class import Marked
from lietool.verbs._exercise_read import printable
from lietool.verbs._exercise_tell import Row

PAGE = "index.html"


def write(
    folder: Path,
    marked: Sequence[Marked],
    rows: Sequence[Row],
    exercises: Mapping[str, Exercise],
    names: Sequence[str],
    notes: Sequence[str],
) -> None:
    """Write the pages: of one submission ``index.html``, of several also one for each by its file.

    Parameters
    ----------
    folder : Path
        Where to.
    marked : sequence of Marked
    rows : sequence of Row
        The same, as a table.
    exercises : mapping from str to Exercise
    names : sequence of str
        What each page is called, without the ending.
    notes : sequence of str
        What is wrong with the grader.

    Raises
    ------
    OSError
        If a page cannot be written.
    """
    if len(marked) == 1:
        atomic.write_bytes(folder / PAGE, _page(marked[0], notes).encode())
        return
    links = {}
    for each, row, name in zip(marked, rows, names, strict=True):
        if each.record is not None:
            links[row.file] = f"{name}.html"
            atomic.write_bytes(folder / links[row.file], _page(each, notes).encode())
    # Last, so that it never leads to what is not there.
    groups = list(_groups(rows, exercises, links))
    about = _exercise_tell.sentences(_exercise_tell.summary(rows))
    title = next(iter(exercises.values())).title if len(exercises) == 1 else "Exercises"
    atomic.write_bytes(folder / PAGE, marks_page.of_class(title, about, groups, notes).encode())


def _page(each: Marked, notes: Sequence[str]) -> str:
    made = each.record
    assert made is not None
    about = {**made.about, "trouble": _exercise_tell.trouble(made.about)}
    expected = _reference(about["picture"]["plate"]) if about["picture"] else None
    return marks_page.submission(
        about,
        # Whoever gets it need not know the grader's folders.
        file=printable(each.submission.path.name),
        expected=expected,
        actual=made.picture,
        drawn=made.drawn,
        notes=notes,
    )


@functools.cache
def _reference(plate: str) -> bytes:
    return explain.png(picture.golden(plate).image)


def _common(files: Sequence[str]) -> str:
    """Return the beginning that all names have in common, as far as it is a folder."""
    try:
        folder = os.path.commonpath(files)
    except ValueError:
        # Some from the root and some from here.
        return ""
    return folder.rstrip(os.sep) + os.sep if folder else ""


def _groups(
    rows: Sequence[Row], exercises: Mapping[str, Exercise], links: Mapping[str, str]
) -> "list[dict[str, Any]]":
    """The tables of a class: one for each exercise in the order of the book, and what is for none."""
    made, start = [], len(_common([row.file for row in rows]))
    for name in [*exercises, ""]:
        mine = [row for row in rows if (row.exercise if row.exercise in exercises else "") == name]
        if not mine:
            continue
        checks = list(dict.fromkeys(title for row in mine for title in row.checks))
        made.append(
            {
                "title": f"{name}: {exercises[name].title}" if name else "For no exercise",
                "checks": checks,
                "rows": [
                    {
                        "file": row.file[start:],
                        "href": links.get(row.file, ""),
                        "marks": f"{row.marks} of {row.of}" if row.of else "0",
                        "checks": [row.checks.get(title, 0) > 0 for title in checks],
                        "says": row.diagnosis,
                    }
                    for row in mine
                ],
            }
        )
    return made
