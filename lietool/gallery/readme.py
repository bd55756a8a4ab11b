"""The goldens for reading on a code host: Markdown with the pictures beside it."""

import html
import re
from collections.abc import Sequence

from lietool.gallery import prose
from lietool.gallery.entry import Chapter, Entry

_HEAD = """\
# The plates

<!-- Written by `lietool figures gallery --readme`, and by `lietool figures accept`. -->

These are the pictures that every later one is compared with. `lietool figures gallery` makes a page of them
with search, formulas, parameters and numbers.
"""


def build(entries: Sequence[Entry]) -> str:
    """Return the README of a folder of goldens.

    Parameters
    ----------
    entries : sequence of Entry
        The plates whose goldens lie there, in the order of chapters.

    Returns
    -------
    str
        Markdown.
    """
    chapters: dict[Chapter, list[Entry]] = {}
    for entry in entries:
        chapters.setdefault(entry.chapter, []).append(entry)
    parts = [_HEAD]
    parts += [_contents(chapter, members) for chapter, members in chapters.items()]
    for chapter, members in chapters.items():
        parts.append(f"\n## {heading(chapter)}\n")
        parts += map(_plate, members)
    return "\n".join(parts)


def heading(chapter: Chapter) -> str:
    """Return what stands above the plates of a chapter."""
    return f"{chapter.label}: {chapter.name}" if chapter.name else chapter.label


def _contents(chapter: Chapter, members: Sequence[Entry]) -> str:
    links = " · ".join(f"[{entry.id}](#{_anchor(entry.id)})" for entry in members)
    return f"- {heading(chapter)}: {links}"


def _anchor(plate_id: str) -> str:
    """The name of an anchor of our own: those that code hosts make of headings differ."""
    return f"plate-{plate_id.lower()}"


def _plate(entry: Entry) -> str:
    lines = [
        f'<a id="{_anchor(entry.id)}"></a>',
        "",
        f"### {entry.id}: {_prose(entry.title)}",
        "",
        f"![{escaped(entry.alternative)}]({entry.golden})",
        "",
        _prose(entry.caption),
        "",
        *(f"- {equation.shown} {_formula(equation.plain)}".rstrip() for equation in entry.equations),
        *([""] if entry.equations else []),
        "```sh",
        entry.commands[0].line,
        "```",
        "",
    ]
    return "\n".join(lines)


def _formula(plain: str) -> str:
    return f"`{plain}`" if plain else ""


def _prose(text: str) -> str:
    """A caption with its formulas set, in which nothing is taken for Markdown."""
    parts = re.split(r"(</?(?:i|sub|sup)>)", prose.to_html(text))
    return "".join(part if i % 2 else escaped(html.unescape(part)) for i, part in enumerate(parts))


def escaped(text: str) -> str:
    """Return a text in which nothing is taken for Markdown."""
    return re.sub(r"([\\`*_\[\]<>|#])", r"\\\1", text)
