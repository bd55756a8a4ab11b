"""The page: one HTML file that needs no network, and the pictures and numbers beside it."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from lietool.gallery import formula, prose, site
from lietool.gallery.entry import Chapter, Entry, Equation

_HERE = Path(__file__).parent
_THEMES = ("light", "dark")


@dataclass(frozen=True)
class Set:
    """An equation as it stands on the page: the name of its outlines and their place about the base line."""

    name: str
    box: formula.Box

    def svg(self, plain: str) -> Markup:
        """Return the element that shows it, with the plain formula for those who listen."""
        box = self.box
        height = box.above + box.below
        return Markup(
            '<svg class="tex" role="img" aria-label="{}" width="{}em" height="{}em" '
            'style="vertical-align:{}em" viewBox="0 {} {} {}"><use href="#{}"/></svg>'
        ).format(
            plain,
            box.width / 1000,
            height / 1000,
            -box.below / 1000,
            -box.above,
            box.width,
            height,
            self.name,
        )


def build(entries: Sequence[Entry], folder: Path) -> tuple[bytes, dict[str, bytes]]:
    """Make the page of some plates.

    Parameters
    ----------
    entries : sequence of Entry
        In the order in which they stand on the page.
    folder : Path
        Where the page will lie, for links to code.

    Returns
    -------
    page : bytes
        HTML.
    assets : dict of str to bytes
        The files that it names, by their paths within the folder.

    Raises
    ------
    ValueError
        If an equation cannot be set.
    """
    outlines, equations = formula.Outlines(), {}
    for equation in dict.fromkeys(equation for entry in entries for equation in entry.equations):
        if not equation.tex:
            continue
        name = f"_e{len(equations)}"
        equations[equation.number] = Set(name, formula.typeset(equation.tex, outlines))
    assets: dict[str, bytes] = {}
    plates = [_plate(entry, folder, assets) for entry in entries]
    text = _template().render(
        chapters=_grouped(entries, plates),
        count=len(plates),
        glyphs=[(name, Markup(path)) for name, path in outlines.paths.items()],
        equations=[(item.name, Markup("".join(item.box.parts))) for item in equations.values()],
        set=lambda equation: equations[equation.number].svg(equation.plain),
        style=Markup(_read("page.css")),
        script=Markup(_read("page.js")),
    )
    return re.sub(r"\n\s*\n+", "\n", text).encode(), assets


def _template() -> jinja2.Template:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_HERE),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["prose"] = lambda text: Markup(prose.to_html(text))
    return environment.get_template("page.html")


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


def _grouped(entries: Sequence[Entry], plates: Sequence[Any]) -> list[tuple[Chapter, list[Any]]]:
    chapters: dict[Chapter, list[Any]] = {}
    for entry, plate in zip(entries, plates, strict=True):
        chapters.setdefault(entry.chapter, []).append(plate)
    return list(chapters.items())


def _plate(entry: Entry, folder: Path, assets: dict[str, bytes]) -> dict[str, Any]:
    pictures = {}
    for theme in _THEMES:
        if picture := entry.pictures.get(theme):
            stem = entry.id if theme == "light" else f"{entry.id}-{theme}"
            pictures[theme] = site.named("pictures", stem, picture.data, "png")
            assets[pictures[theme]] = picture.data
    numbers = site.named("numbers", entry.id, entry.numbers_file, "json")
    assets[numbers] = entry.numbers_file
    code, link = _code(entry, folder)
    return {
        "entry": entry,
        "light": pictures["light"],
        "dark": pictures.get("dark"),
        "size": entry.pictures["light"],
        "numbers": numbers,
        "code": code,
        "link": link,
        "cited": " ".join(equation.key for equation in entry.equations),
        "words": _words(entry),
    }


def _code(entry: Entry, folder: Path) -> tuple[str, str]:
    """The place of a figure's code, and a link to it where page and code lie in the same project.

    A link that led out of the project would name the folders of the machine that the page was made on.
    """
    if entry.code is None or entry.root is None:
        return "", ""
    place = f"{entry.code.relative_to(entry.root).as_posix()}:{entry.line}"
    inside = folder.resolve().is_relative_to(entry.root)
    return place, Path(os.path.relpath(entry.code, folder.resolve())).as_posix() if inside else ""


def _words(entry: Entry) -> str:
    """What is searched besides number, title and equations."""
    said = [entry.caption, entry.command, entry.chapter.label, entry.chapter.name]
    said += [text for parameter in entry.parameters for text in (parameter.option, parameter.help)]
    said += [_said(equation) for equation in entry.equations]
    return " ".join(" ".join(said).lower().split())


def _said(equation: Equation) -> str:
    return f"{equation.says} {equation.plain}"
