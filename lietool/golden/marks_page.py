"""The pages of graded submissions: one with a student's picture over the plate, and a class as a table.

They need no network and no other file: who gets one can open it anywhere.  What a student wrote or printed
is text there, and never a part of the page.
"""

import functools
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from lietool.golden import report_page

_PARTS = (("given", "given"), ("wanted", "wanted"), ("got", "got"), ("off", "off by"), ("trouble", "but"))
# What the two pictures are called where they are compared.
_CALLED = {"expected": "the book's", "actual": "yours"}
_ALONE = ("marks_alone.js", "theme.js")
_VIEWED = ("viewer.js", "theme.js", "marks.js")
_SAME = "Your function draws the plate."


def submission(
    about: Mapping[str, Any],
    *,
    file: str,
    expected: bytes | None,
    actual: bytes | None,
    drawn: bool,
    notes: Sequence[str] = (),
) -> str:
    """Make the page of a submission.

    Parameters
    ----------
    about : mapping
        ``exercise``, ``title``, ``marks``, ``of``, ``checks`` with their ``findings``, ``diagnosis``,
        ``seed``, ``digest``, ``printed``, ``trouble``, and ``picture`` with the ``plate`` and what it
        ``says``.
    file : str
        What was handed in.
    expected, actual : bytes, optional
        The plate and what the student's function draws, as PNG; `actual` is None where it is the same, or
        there is none.
    drawn : bool
        Whether there is one.
    notes : sequence of str
        What is wrong with the grader.

    Returns
    -------
    str
        HTML that names no other file.
    """
    pictures = []
    for part, data in (("expected", expected), ("actual", actual)):
        if data is not None:
            pictures.append(report_page.picture(part, data, _CALLED[part]))
    only = "yours, the same as the book's" if drawn else "the book's; yours could not be drawn"
    return _render(
        "marks.html",
        _VIEWED if pictures else _ALONE,
        title=f"{about['exercise']}: {about['marks']} of {about['of']}",
        about=about,
        full=about["marks"] == about["of"],
        file=file,
        notes=notes,
        says=_sentence(about, drawn),
        parts=_PARTS,
        pictures=pictures,
        called=_CALLED,
        data=json.dumps({"blobs": [], "worst": None, "only": only}),
    )


def of_class(
    title: str, summary: Sequence[str], groups: Sequence[Mapping[str, Any]], notes: Sequence[str] = ()
) -> str:
    """Make the page of a class.

    Parameters
    ----------
    title : str
    summary : sequence of str
        Sentences.
    groups : sequence of mapping
        An exercise each: ``title``, the titles of its ``checks``, and ``rows`` with ``file``, ``href`` (empty
        where there is no page), ``marks`` (a text), ``checks`` (whether each is right) and ``says``.
    notes : sequence of str
        What is wrong with the grader.

    Returns
    -------
    str
        HTML.
    """
    return _render("marks_class.html", _ALONE, title=title, summary=summary, groups=groups, notes=notes)


def rows(text: str) -> list[str]:
    """Return lines in which the rows of each matrix stand below each other.

    Parameters
    ----------
    text : str
        Values, as findings tell them: "a = [[1, 2], [3, 4]], b = [[5, 6], [7, 8]], t = 0.5".

    Returns
    -------
    list of str
        What follows a matrix begins a line of its own.
    """
    lines, line, depth, opened, matrix = [], "", 0, 0, False
    for char in text:
        if char == " " and line.endswith(("],", "];")) and (depth or matrix):
            lines.append(line)
            line = " " * (opened + depth) if depth else ""
            matrix = bool(depth)
            continue
        line += char
        if char == "[":
            opened = opened if depth else len(line) - 1
            depth += 1
            matrix = matrix or depth > 1
        depth -= char == "]"
    return [*lines, line]


def _sentence(about: Mapping[str, Any], drawn: bool) -> str:
    """What the picture comes to, as a sentence."""
    says = about["picture"]["says"] if about["picture"] else ""
    passed = bool(about["checks"]) and about["checks"][-1]["passed"]
    # Not with a capital: it may begin with the name of a function.
    return _SAME if drawn and passed else f"{says}."


def _render(template: str, scripts: Sequence[str], **values: Any) -> str:
    from markupsafe import Markup

    style = report_page.read("page.css") + report_page.read("marks.css")
    script = Markup("\n".join(map(report_page.read, scripts)))
    return _environment().get_template(template).render(style=Markup(style), script=script, **values)


@functools.cache
def _environment() -> Any:
    made = report_page.environment()
    made.filters["rows"] = lambda text: "\n".join(rows(text))
    made.filters["counted"] = _counted
    return made


def _counted(texts: Sequence[str]) -> str:
    return ", ".join(f"{text} ({n} times)" if n > 1 else text for text, n in Counter(texts).items())
