"""Marks in a terminal: one submission with what is wrong in it, or a class and what it got wrong most."""

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from lietool.exercise import Exercise
from lietool.golden import marks_page
from lietool.verbs import _table
from lietool.verbs._exercise_class import Marked
from lietool.verbs._exercise_read import printable

# Of the other inputs that fail a check, those that are named; --json and --report have all.
_MOST = 4
# Of what is most often wrong.
_FIRST = 5
_WIDTH = 100
# Lines of what a submission has printed.
_PRINTED = 8
_PARTS = (("given", "given"), ("wanted", "wanted"), ("got", "got"), ("off", "off by"), ("trouble", "but"))


@dataclass(frozen=True)
class Row:
    """A submission in the table of a class.

    Parameters
    ----------
    file, exercise : str
    marks, of : int
        `of` is 0 where it is not known what the file is for.
    checks : mapping from str to int
        The points of each check by its title.
    diagnosis : str
        What explains it, or why it could not be graded.
    digest : str
    """

    file: str
    exercise: str
    marks: int
    of: int
    checks: Mapping[str, int]
    diagnosis: str
    digest: str

    @property
    def full(self) -> bool:
        """Whether all points are earned."""
        return 0 < self.of == self.marks


def titles(exercise: Exercise, picture: bool = True) -> dict[str, int]:
    """Return the checks of an exercise by their titles, and the points of each."""
    found = {check.title: check.points for check in exercise.checks}
    return found | ({f"the picture {exercise.picture.plate}": exercise.picture.points} if picture else {})


def rows(marked: Sequence[Marked], exercises: Mapping[str, Exercise], picture: bool) -> list[Row]:
    """Return the table of a class; who handed in what cannot be graded has no points."""
    only = next(iter(exercises)) if len(exercises) == 1 else ""
    made = []
    for each in marked:
        mine = each.submission
        if each.record is not None:
            about = each.record.about
            checks = {check["title"]: check["points"] for check in about["checks"]}
            said = " ".join(about["diagnosis"]) or _first_trouble(about)
            made.append(Row(mine.file, mine.exercise, about["marks"], about["of"], checks, said, mine.digest))
            continue
        name = mine.exercise or only
        all_ = titles(exercises[name], picture) if name in exercises else {}
        none = dict.fromkeys(all_, 0)
        made.append(Row(mine.file, name, 0, sum(all_.values()), none, each.trouble, mine.digest))
    return made


def trouble(about: Mapping[str, Any]) -> str:
    """Return what kept a submission from giving any value, as a syntax error does; empty if it gave one."""
    if about["trouble"]:
        return about["trouble"]
    findings = [finding for check in about["checks"] for finding in check["findings"]]
    if any(not finding["trouble"] for finding in findings):
        return ""
    return next((finding["trouble"] for finding in findings), "")


def one(about: Mapping[str, Any], picture: str) -> None:
    """Print the marks of one submission, and of what failed the input, what was wanted and what came.

    Parameters
    ----------
    about : mapping
        As `Graded.as_json`.
    picture : str
        The file that its picture was saved in; empty where there is none.
    """
    click.echo(f"{about['exercise']}: {about['title']}")
    cells = [(x["title"], f"{x['points']} of {x['of']}", _word(x)) for x in about["checks"]]
    cells.append(("", f"{about['marks']} of {about['of']}", ""))
    _table.show(("check", "points", "verdict"), cells, verdict=2)
    if never := trouble(about):
        click.echo("\n" + click.style("It gave no value:", bold=True) + f" {printable(never)}")
    for check in about["checks"]:
        if not check["passed"] and not never:
            click.echo("\n" + "\n".join(_lines(check)))
    if about["printed"]:
        click.echo("\nWhat it printed:")
        printed = about["printed"].splitlines()
        for line in printed[:_PRINTED]:
            click.echo(f"  {printable(line)[:_WIDTH]}")
        if len(printed) > _PRINTED:
            click.echo(f"  and {len(printed) - _PRINTED} lines more")
    if about["diagnosis"]:
        click.echo("\n" + click.style("What it looks like:", bold=True))
        for says in about["diagnosis"]:
            click.echo(textwrap.fill(says, _WIDTH, initial_indent="  ", subsequent_indent="  "))
    if picture:
        click.echo(f"\n{picture} shows what your function draws{_beside(about)}.")


def summary(found: Sequence[Row]) -> dict[str, Any]:
    """Return how many submissions there are, how good they are, and what was most often wrong.

    Parameters
    ----------
    found : sequence of Row

    Returns
    -------
    dict
        ``submissions``, ``ungraded`` (of which nobody knows what they are for), ``full``, ``mean`` (a share
        of the marks of all others),
        ``wrong`` and ``said``, pairs of a text and how often, the most frequent first.
    """
    known = [row for row in found if row.of]
    several = len({row.exercise for row in known}) > 1
    wrong: Counter[str] = Counter()
    for row in known:
        name = f"{row.exercise}: " if several else ""
        wrong.update(f"{name}{title}" for title, points in row.checks.items() if not points)
    said = Counter(row.diagnosis for row in found if row.diagnosis and not row.full)
    return {
        "submissions": len(found),
        "ungraded": len(found) - len(known),
        "full": sum(row.full for row in found),
        "mean": round(sum(row.marks / row.of for row in known) / len(known), 4) if known else 0.0,
        "wrong": _most(wrong),
        "said": _most(said),
    }


def sentences(about: Mapping[str, Any]) -> list[str]:
    """Say a summary in sentences."""
    count, full = about["submissions"], about["full"]
    none = about["ungraded"]
    graded = f"{count - none} of {count} submissions" if none else f"{count} submissions"
    lines = [f"{graded}: {about['mean']:.0%} of the points on average, {full} with all of them."]
    if none:
        lines.append(f"{none} could not be graded, and the reason stands beside each.")
    if about["wrong"]:
        lines.append("Most often wrong: " + ", ".join(f"{what} ({n})" for what, n in about["wrong"]) + ".")
    for what, n in about["said"]:
        if n > 1:
            lines.append(f"Said {n} times: {what}")
    return lines


def several(found: Sequence[Row]) -> None:
    """Print the table of a class and its summary."""
    exercises = len({row.exercise for row in found}) > 1
    heads = ["file", *["exercise"] * exercises, "marks", "", "lost in", "diagnosis"]
    cells = []
    for row in found:
        lost = ", ".join(title for title, points in row.checks.items() if not points)
        word = "passes" if row.full else "fails"
        marks = f"{row.marks} of {row.of}" if row.of else "0"
        # A column of a table is no place for all of it.
        said = textwrap.shorten(row.diagnosis, 80, placeholder=" ...")
        lost = "everything" if row.checks and not row.marks else lost
        cells.append([row.file, *[row.exercise] * exercises, marks, word, lost, said])
    _table.show(heads, cells, verdict=2 + exercises)
    click.echo()
    for line in sentences(summary(found)):
        click.echo(line)
    click.echo("`lietool exercise check` with one of the files says what is wrong in it.")


def _most(counted: Counter[str]) -> list[tuple[str, int]]:
    # Of equally many the first by name: the order of the files must not matter.
    return sorted(counted.items(), key=lambda x: (-x[1], x[0]))[:_FIRST]


def _first_trouble(about: Mapping[str, Any]) -> str:
    """What kept the first input of all that fail from giving a value; empty if it gave one."""
    failed = (x for check in about["checks"] for x in check["findings"] if not x["passed"])
    return about["trouble"] or next(failed, {"trouble": ""})["trouble"]


def _word(check: Mapping[str, Any]) -> str:
    return "passes" if check["passed"] else "fails"


def _lines(check: Mapping[str, Any]) -> Iterator[str]:
    yield click.style(check["title"], bold=True)
    if check["trouble"]:
        yield f"  {printable(check['trouble'])}"
    failed = [finding for finding in check["findings"] if not finding["passed"]]
    for finding in failed[:1]:
        yield f"  {printable(finding['says'])}"
        for key, called in _PARTS:
            # A picture says the same in both.
            if finding[key] and not (key == "off" and finding["trouble"]):
                yield from _wrapped(called, printable(finding[key]))
    if others := Counter(printable(finding["says"]) for finding in failed[1:]):
        named = [f"{says} ({n} times)" if n > 1 else says for says, n in list(others.items())[:_MOST]]
        more = len(others) - _MOST
        named += [f"and {more} more"] if more > 0 else []
        yield from _wrapped("also", "; ".join(named), 2)


def _wrapped(called: str, text: str, indent: int = 4) -> list[str]:
    """Lines of a value, each row of a matrix in one of its own."""
    head, rest = f"{'':{indent}}{called:<8}", " " * (indent + 8)
    lines = []
    for row in marks_page.rows(text):
        under = rest + " " * (len(row) - len(row.lstrip()))
        lines += textwrap.wrap(
            row.lstrip(),
            _WIDTH,
            initial_indent=under if lines else head,
            # Within brackets that are still open.
            subsequent_indent=f"{under}  ",
            break_long_words=False,
            break_on_hyphens=False,
        )
    return lines


def _beside(about: Mapping[str, Any]) -> str:
    wrong = about["checks"] and not about["checks"][-1]["passed"]
    return "; --report DIR lays it over the book's" if wrong else ""
