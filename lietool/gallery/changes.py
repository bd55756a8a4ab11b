"""The history of the goldens for reading on a code host: Markdown, a section for each plate.

By plates and not by days, so that two branches that accept different plates
change different lines.
"""

from collections.abc import Mapping, Sequence
from typing import Protocol

from lietool.gallery import readme
from lietool.gallery.entry import Chapter, Entry

_HEAD = """\
# What was accepted, and why

<!-- Written by `lietool figures accept`, and by `lietool figures gallery --readme`. -->

The pictures carry all this themselves; the latest comes first.
"""


class Change(Protocol):
    """One accept of a plate."""

    @property
    def date(self) -> str:
        """When, ISO 8601."""
        ...

    @property
    def commit(self) -> str:
        """What was checked out."""
        ...

    @property
    def reason(self) -> str:
        """Why it was right."""
        ...

    @property
    def what(self) -> str:
        """What had changed; empty if nobody wrote it down."""
        ...


def build(entries: Sequence[Entry], changes: Mapping[str, Sequence[Change]]) -> str:
    """Return the history of a folder of goldens.

    Parameters
    ----------
    entries : sequence of Entry
        The plates whose goldens lie there, in the order of chapters.
    changes : Mapping[str, sequence of Change]
        What was accepted for each, the oldest first, by its id.

    Returns
    -------
    str
        Markdown.
    """
    parts = [_HEAD]
    chapter: Chapter | None = None
    for entry in entries:
        if entry.chapter != chapter:
            chapter = entry.chapter
            parts.append(f"## {readme.heading(chapter)}\n")
        parts.append(f"### [{entry.id}]({entry.golden})\n")
        parts += [_line(change) for change in reversed(changes.get(entry.id, ()))]
        parts.append("")
    return "\n".join(parts)


def _line(change: Change) -> str:
    reason = readme.escaped(change.reason)
    what = f" ({readme.escaped(change.what)})" if change.what else ""
    return f"- {change.date[:10]}, `{change.commit.replace('`', '')}`: {reason}{what}"
