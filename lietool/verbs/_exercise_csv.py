"""The marks of a class as a table that other programs read; the same bytes for the same files."""

import csv
import io
from collections.abc import Sequence

from lietool.verbs._exercise_tell import Row

# A cell that begins so is a formula to a spreadsheet, and file names are the students'.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def dumps(rows: Sequence[Row], order: Sequence[str]) -> str:
    """Return the table as CSV.

    Parameters
    ----------
    rows : sequence of Row
        In their order.
    order : sequence of str
        The titles of all checks, in theirs; where an exercise has no such check the cell is empty.

    Returns
    -------
    str
        Lines end in a line feed.
    """
    file = io.StringIO()
    write = csv.writer(file, lineterminator="\n").writerow
    write(["file", "exercise", "marks", "of", *map(_text, order), "diagnosis", "digest"])
    for row in rows:
        points = [row.checks.get(title, "") for title in order]
        of = row.of or ""
        write(
            [_text(row.file), _text(row.exercise), row.marks, of, *points, _text(row.diagnosis), row.digest]
        )
    return file.getvalue()


def _text(text: str) -> str:
    return f"'{text}" if text.startswith(_FORMULA) else text
