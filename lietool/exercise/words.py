"""What came of a check in plain lines, as a mail, a notebook or another grader's page can show it."""

import re
from collections.abc import Iterator

from lietool.exercise.outcome import Finding, Graded, Outcome

# Of the inputs that fail a check, those that are told.
_MOST = 4
_PARTS = (("given", "given"), ("wanted", "wanted"), ("got", "got"), ("off", "off by"))
_LINE = re.compile(r"^line (\d+): ")


def outcome(made: Outcome, source: str = "") -> str:
    """Return what came of a check.

    Parameters
    ----------
    made : Outcome
    source : str
        What was graded, where its reader has it not as a file: its lines are quoted, not numbered.

    Returns
    -------
    str
        Several lines.
    """
    return "\n".join(_lines(made, source.splitlines()))


def _lines(made: Outcome, source: list[str]) -> Iterator[str]:
    points = "1 point" if made.of == 1 else f"{made.of} points"
    if made.passed:
        yield f"{made.title}: {points}, all is right."
        return
    yield f"{made.title}: 0 of {points}."
    failed = [finding for finding in made.findings if not finding.passed]
    for finding in failed[:_MOST]:
        yield from _of_finding(finding, source)
    if made.trouble:
        yield f"  {_quoted(made.trouble, source)}"
    if len(failed) > _MOST:
        yield f"  And {len(failed) - _MOST} more of {len(made.findings)} inputs."


def _of_finding(finding: Finding, source: list[str]) -> Iterator[str]:
    yield f"  {finding.says}"
    for name, word in _PARTS:
        if text := getattr(finding, name):
            # Of a picture it is a sentence.
            yield f"    {word:7}{text}" if finding.got or name != "off" else f"    {text}"
    if finding.trouble:
        yield f"    {_quoted(finding.trouble, source)}"


def _quoted(trouble: str, source: list[str]) -> str:
    match = _LINE.match(trouble)
    if match is None or not 0 < int(match[1]) <= len(source):
        return trouble
    return f"`{source[int(match[1]) - 1].strip()}`: {trouble[match.end() :]}"


def summary(made: Graded) -> str:
    """Return the marks and what explains them."""
    lines = [f"{made.exercise}: {made.marks} of {made.of} points."]
    return "\n".join([*lines, *filter(None, [made.trouble]), *made.diagnosis])
