"""List the numbered equations: what each says, where it is computed, which test proves it."""

import functools
import json
import os
import re
import tomllib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from lietool import paths
from lietool.figure import nearest
from lietool.verbs import _equations_index, _table
from lietool.verbs._equations_index import Equation, Place

LIST = paths.PACKAGE / "verbs" / "equations.toml"
BUILT = paths.PACKAGE / "verbs" / "equations.json"
TEX = paths.PACKAGE / "verbs" / "equations_tex.toml"
_HEADS = {"functions": "function", "tests": "test", "plates": "plate", "errata": "erratum"}
_STATES = {
    "proved": "a function computes it and a test proves it",
    "law": "a test proves it of several functions",
    "implemented": "a function computes it",
    "open": "not built yet",
}


@click.command()
@click.argument("which", nargs=-1, metavar="[NUMBER]")
@click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
def command(which: tuple[str, ...], as_json: bool) -> None:
    """List the numbered equations: what each says, where it is computed, which test proves it.

    NUMBER is one of the book's (7.8, B7.8), of Kaji and Ochiai's paper (K 6, "K Algorithm 1") or of the
    MEIS paper (M4), in any case, and shows all about it with a computed example. A chapter (7, A) or a text
    (B, K, M) lists its own. Functions are found by docstrings, tests by markers, plates by their figures.
    """
    every = index()
    chosen = select(" ".join(which), every)
    if len(chosen) == 1:
        about = describe(chosen[0])
        click.echo(json.dumps(about, indent=2, ensure_ascii=False) if as_json else _page(about))
    elif as_json:
        click.echo(json.dumps([_row(equation) for equation in chosen], indent=2, ensure_ascii=False))
    else:
        _show(chosen)


@functools.cache
def index() -> list[Equation]:
    """Return all equations: in a wheel as they were read when it was built, in a checkout as they are now."""
    if BUILT.is_file():
        return _equations_index.loads(BUILT.read_text(encoding="utf-8"))
    found = _equations_index.scan(paths.PACKAGE, paths.FIGURES, paths.PACKAGE.parent / "tests")
    return _equations_index.join(_equations_index.catalogue(LIST), found)


def select(words: str, every: Sequence[Equation]) -> list[Equation]:
    """Return the equations that a user means: one by its number, or those of a chapter or a text.

    Parameters
    ----------
    words : str
        ``7.8``, ``B7.8``, ``(7.8)``, ``k 6``, ``algorithm 1``, ``7``, ``K``; empty for all.
    every : sequence of Equation
        All there are.

    Returns
    -------
    list of Equation
        At least one.

    Raises
    ------
    UsageError
        If there is none, naming the nearest.
    """
    key = _key(words)
    by_key = {_key(equation.number): equation for equation in every}
    for known in (key, f"b{key}", f"k{key}" if key.startswith("alg") else key):
        if known in by_key:
            return [by_key[known]]
    start = f"{key}." if key.isdigit() or key == "a" else key
    chosen = [e for e in every if not key or any(_key(e.number).startswith(x) for x in (start, f"b{start}"))]
    if not chosen:
        numbers = [equation.number for equation in every]
        hint = nearest(words, numbers) or nearest(f"B {words}", numbers)
        raise click.UsageError(f"no equation {words!r}.{hint} lietool equations lists all")
    return chosen


def describe(equation: Equation) -> dict[str, Any]:
    """Return all about an equation, with a computed example where there is one."""
    about: dict[str, Any] = {
        "number": equation.number,
        "text": _equations_index.TEXTS[equation.number[0]],
        "says": equation.says,
        "formula": equation.formula,
        "tex": tex()[equation.number],
        "state": equation.state,
    }
    if equation.awaited:
        about["awaited"] = equation.awaited
    for kind in _equations_index.KINDS:
        about[kind] = [{"name": place.name, "at": _located(place)} for place in getattr(equation, kind)]
    about["example"] = [{"input": line, "output": value} for line, value in example(equation)]
    return about


def example(equation: Equation) -> list[tuple[str, str]]:
    """Compute an example: the one of the list, else the first function on a fixed input.

    Returns
    -------
    list of tuple of str
        Inputs and outputs; empty where nothing can be computed yet.
    """
    from lietool.verbs import _equations_example

    if equation.number in _examples():
        return _equations_example.of_expressions(_examples()[equation.number])
    for place in equation.functions:
        if place.file.startswith("lietool/lie/"):
            return _equations_example.of_function(place.name)
    return []


@functools.cache
def _examples() -> dict[str, list[str]]:
    return tomllib.loads(LIST.read_text(encoding="utf-8"))["examples"]


@functools.cache
def tex() -> dict[str, str]:
    """Return the equations in TeX, by their numbers with the letter of their text."""
    listed = tomllib.loads(TEX.read_text(encoding="utf-8"))
    return {f"{text} {number}": line for text, lines in listed.items() for number, line in lines.items()}


def _key(words: str) -> str:
    """Reduce a number to what two spellings of it share: ``B (7.8)`` and ``b7.8`` are ``b7.8``."""
    return re.sub(r"[\s()]", "", words.lower()).replace("algorithm", "alg").replace("alg.", "alg")


def _row(equation: Equation) -> dict[str, Any]:
    row: dict[str, Any] = {"number": equation.number, "says": equation.says, "formula": equation.formula}
    for kind in _equations_index.KINDS:
        row[kind] = [f"{place.name} {place.file}:{place.line}" for place in getattr(equation, kind)]
    return row | {"state": equation.state, "awaited": equation.awaited}


def _show(chosen: Sequence[Equation]) -> None:
    cells = []
    for equation in chosen:
        function = _brief([place.name for place in equation.functions])
        function = function or ("law" if equation.tests else equation.awaited)
        test = _brief([f"{Path(place.file).name}:{place.line}" for place in equation.tests])
        cells.append((equation.number, equation.says, function, test, equation.state))
    _table.show(("number", "what it says", "function or law", "test", "state"), cells, verdict=4)
    counts = Counter(equation.state for equation in chosen)
    click.echo(f"{len(chosen)} equations")
    for state, meaning in _STATES.items():
        if counts[state]:
            click.echo(f"  {counts[state]:>4}  {state:<12}{meaning}")
    click.echo(f"`lietool equations {chosen[0].number}` shows one, with a computed example.")


def _brief(names: Sequence[str]) -> str:
    return "" if not names else names[0] + (f" +{len(names) - 1}" if len(names) > 1 else "")


def _page(about: dict[str, Any]) -> str:
    lines = [f"{about['number']}  {about['says']}", f"  {about['formula']}", ""]
    meaning = _STATES[about["state"]] + (f"; awaits {about['awaited']}" if "awaited" in about else "")
    lines.append(f"  {'state':<10}{about['state']}: {meaning}")
    width = max((len(place["name"]) for kind in _HEADS for place in about[kind]), default=0)
    for kind, head in _HEADS.items():
        lines += [f"  {head:<10}{place['name']:<{width}}  {place['at']}" for place in about[kind]]
    if about["example"]:
        lines += ["", "  example"]
        for step in about["example"]:
            lines += _step(step["input"], step["output"])
    return "\n".join(lines)


def _step(given: str, value: str) -> list[str]:
    """One line of an example: what is computed, and behind or below it what comes out."""
    if "\n" not in value and " = " not in given:
        return [f"    {given} = {value}"]
    if re.fullmatch(r"\w+ = np\.(array\(.*\])\)", given):
        # A value that is written out says itself.
        return [f"    {given}"]
    ends = "" if " = " in given else " ="
    return [f"    {given}{ends}", *(f"      {line}" for line in value.splitlines())]


def _located(place: Place) -> str:
    """File and line as an editor opens them: from where the user is, or the whole path."""
    file = paths.PACKAGE.parent / place.file
    if place.file.startswith("figures/"):
        file = paths.FIGURES / place.file.removeprefix("figures/")
    if not file.is_file():
        return f"{place.file}:{place.line} (in the source distribution)"
    relative = os.path.relpath(file)
    return f"{file if relative.startswith('..') else relative}:{place.line}"
