"""`lietool figures gallery`: a page of all plates, and the README of their goldens."""

import functools
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np

from lietool import atomic, paths
from lietool.gallery import changes, chapters, entry, readme, site
from lietool.golden import folder as golden_folder
from lietool.golden import history, store
from lietool.golden import numbers as numbers_
from lietool.verbs import _equations_index, _jobs, _studio, equations

README, CHANGES = "README.md", "CHANGES.md"
# Of the numbers of a picture, what is shown on the page itself; all of them are a click away.
_FEW, _FIRST = 16, 6


@dataclass(frozen=True)
class Order:
    """What the page is made of: the accepted pictures, or such as are drawn now in each theme."""

    golden: bool
    themes: tuple[str, ...] = ("light", "dark")


def run(
    items: Sequence[_studio.Item], studio: _studio.Studio, folder: Path, *, golden: bool, jobs: int = 1
) -> None:
    """Write the page of some plates, and say where it is.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer of this process.
    folder : Path
        Where the page goes: missing, empty, or an older page.
    golden : bool
        Take the accepted pictures and draw nothing.
    jobs : int
        How many processes share the drawing.

    Raises
    ------
    Stop
        With 2 if the folder holds anything else or cannot be written, with 3 if a golden is wanted that
        is not whole, with 4 if nothing renders.
    """
    from lietool.gallery import page

    if strange := site.stranger(folder):
        raise _studio.Stop(2, f"{folder} cannot take a gallery: {strange}. Name another folder with -o")
    if not golden and jobs < 2:
        _require(studio)
    work = functools.partial(_entry, order=Order(golden), studio=studio if jobs < 2 else None)
    entries = _ordered(_jobs.each(work, items, jobs, "drawing"))
    text, assets = page.build(entries, folder)
    with _studio.writing(str(folder)), golden_folder.lock(folder):
        site.publish(folder, text, assets)
    click.echo(folder / site.PAGE)


def write_readme(items: Sequence[_studio.Item]) -> list[Path]:
    """Write README and history of every folder of goldens, and return those that were not so already.

    Parameters
    ----------
    items : sequence of Item
        All plates; those whose picture is not accepted yet are left out.

    Returns
    -------
    list of Path
        The files that have changed.

    Raises
    ------
    Stop
        With 2 if one cannot be written.
    """
    changed = []
    for path, text in readmes(items).items():
        if not path.is_file() or path.read_bytes() != text:
            with _studio.writing(str(path)):
                atomic.write_bytes(path, text)
            changed.append(path)
    return changed


def readmes(items: Sequence[_studio.Item]) -> dict[Path, bytes]:
    """Return what the README and the history of every folder of goldens should say."""
    by_root: dict[Path, list[_studio.Item]] = {}
    for item in items:
        if item.place.png.is_file():
            by_root.setdefault(item.place.root, []).append(item)
    texts = {}
    for root, accepted in by_root.items():
        entries = _ordered(map(_said, accepted))
        past = {item.id: history.read(store.remembered(item.place)) for item in accepted}
        texts[root / README] = readme.build(entries).encode()
        texts[root / CHANGES] = changes.build(entries, past).encode()
    return texts


def _ordered(entries: Iterable[entry.Entry]) -> list[entry.Entry]:
    return sorted(entries, key=lambda each: chapters.rank(each.chapter))


def _require(studio: _studio.Studio) -> None:
    try:
        studio.require()
    except _studio.Stop as stop:
        raise _studio.Stop(4, f"{stop.message}. --golden takes the accepted pictures") from None


def _entry(item: _studio.Item, order: Order, studio: _studio.Studio | None) -> entry.Entry:
    pictures, numbers = _accepted(item) if order.golden else _drawn(item, order, studio or _studio.Studio())
    return _said(
        item,
        numbers=tuple(_excerpt(numbers)),
        numbers_file=numbers_.dumps(numbers).encode(),
        pictures=pictures,
    )


def _accepted(item: _studio.Item) -> tuple[dict[str, entry.Picture], Mapping[str, object]]:
    try:
        golden = store.read(item.place)
    except store.GoldenError as error:
        raise _studio.Stop(3, f"{item.id}: {error}. Leave out --golden to draw it") from None
    return {"light": _picture(item.place.png.read_bytes(), golden.image)}, golden.numbers


def _drawn(
    item: _studio.Item, order: Order, studio: _studio.Studio
) -> tuple[dict[str, entry.Picture], Mapping[str, object]]:
    from lietool.render import export

    made = _studio.provenance(item, studio.info)
    # A picture goes by its content's name: the hour would rename all of them though nothing has changed.
    del made["date"]
    pictures, numbers = {}, {}
    for theme in order.themes:
        painted = studio.paint(item, theme="book" if theme == "light" else theme)
        pictures[theme] = _picture(export.png(painted.image, made), painted.image)
        numbers = painted.numbers
    return pictures, numbers


def _picture(data: bytes, image: np.ndarray) -> entry.Picture:
    height, width = image.shape[:2]
    return entry.Picture(data, width, height)


def _said(item: _studio.Item, **made: Any) -> entry.Entry:
    """All that the figure says of a plate."""
    declared = item.declared
    chapter, root = _chapter(item)
    return entry.Entry(
        id=item.id,
        command=item.command,
        chapter=chapter,
        title=item.plate.title,
        caption=item.plate.caption,
        equations=tuple(_equation(number) for number in item.plate.equations),
        commands=tuple(_commands(item)),
        parameters=tuple(_parameters(item)),
        code=declared.file,
        line=declared.function.__code__.co_firstlineno,
        root=root,
        golden=item.place.png.relative_to(item.place.root).as_posix(),
        **made,
    )


def _chapter(item: _studio.Item) -> tuple[entry.Chapter, Path]:
    """A plate's chapter, and the folder that holds the folder of figures that it comes from."""
    file, name = item.declared.file, item.declared.chapter
    figures = file.parent.parent if name else file.parent
    own = "" if figures == paths.FIGURES else figures.parent.name
    return chapters.chapter(item.id, name, own), figures.parent


def _equation(number: str) -> entry.Equation:
    number = number if " " in number else f"B {number}"
    listed = _listed().get(number)
    if listed is None:
        # A teacher's own figure may number as it likes.
        return entry.Equation(number, "", "", "")
    return entry.Equation(number, listed.says, listed.formula, equations.tex()[number])


@functools.cache
def _listed() -> dict[str, _equations_index.Equation]:
    return {equation.number: equation for equation in _equations_index.catalogue(equations.LIST)}


def _commands(item: _studio.Item) -> Iterator[entry.Command]:
    declared, words = item.declared, ["lietool"]
    chapter, root = _chapter(item)
    if chapter.key.startswith("_own"):
        # By its name alone: the whole path would tell readers of the folders of this machine.
        words += ["--project", root.name]
    words.append(item.command)
    if item.id != next(iter(declared.plates)):
        words += ["--plate", item.id]
    yield entry.Command("the picture", shlex.join(words))
    if declared.time:
        yield entry.Command("a loop", shlex.join([*words, "-o", f"{item.command}.gif"]))


def _parameters(item: _studio.Item) -> Iterator[entry.Parameter]:
    values = item.parameters
    for parameter in item.declared.parameters:
        if parameter.idle(values):
            continue
        value = values[parameter.name]
        allowed = ", ".join(parameter.param.choices) or parameter.range.replace("-", "−")
        shown = "none" if value in (None, ()) else parameter.text(value)
        if parameter.kind == "bool":
            shown = "yes" if value else "no"
        yield entry.Parameter(parameter.option, shown, allowed, parameter.param.help)


def _excerpt(values: Mapping[str, object], before: str = "") -> Iterator[entry.Number]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _excerpt(value, f"{before}{name}.")
            continue
        array = np.asarray(value)
        shape = " × ".join(map(str, array.shape))
        yield entry.Number(f"{before}{name}", shape, _values(array))


def _values(array: np.ndarray) -> str:
    if array.ndim == 2 and array.size <= _FEW:
        return "\n".join("  ".join(f"{_short(x):>9}" for x in row) for row in array)
    flat = array.ravel()
    words = [_short(x) for x in flat[: _FEW if array.size <= _FEW else _FIRST]]
    return ", ".join(words) + (", …" if array.size > _FEW else "")


def _short(value: Any) -> str:
    if isinstance(value, np.bool_):
        return "yes" if value else "no"
    if not isinstance(value, np.floating):
        return str(value)
    # Without the sign of what is nothing but rounding.
    text = f"{value if abs(value) > 1e-12 else 0.0:.4g}"
    return text.replace("-", "−")
