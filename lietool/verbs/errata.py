"""List what the texts got wrong: the printed form, the true one, a counterexample computed on the spot."""

import json
import math
import re
import shutil
import textwrap
from collections.abc import Sequence
from typing import Any

import click

from lietool.figure import nearest
from lietool.verbs import _errata, _table


@click.command()
@click.argument("which", nargs=-1, metavar="[PLACE]")
@click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
def command(which: tuple[str, ...], as_json: bool) -> None:
    """List what the texts got wrong: the printed form, the true one, a counterexample computed on the spot.

    PLACE is an equation or a passage of the book (7.6, B7.6), of Kaji and Ochiai's paper (K 8, "K alg 1") or
    of the MEIS paper (M 4), in any case, and shows all about it. The error is the distance between what the
    printed form gives and what the true one gives.
    """
    chosen = select(" ".join(which))
    if as_json:
        click.echo(json.dumps([describe(one) for one in chosen], indent=2, ensure_ascii=False))
    elif which:
        click.echo("\n\n".join(_page(describe(one)) for one in chosen))
    else:
        rows = [[one.where, one.printed, one.true, _number(one.compute().error)] for one in chosen]
        _table.show(("where", "printed", "true", "error"), rows)


def every() -> list[_errata.Erratum]:
    """Return all errata: the book's in the order of its pages, then those of the two papers."""
    from lietool.verbs import _errata_rotations as turns
    from lietool.verbs import _errata_shapes as shapes
    from lietool.verbs import _errata_stretch as stretch

    found = [
        *turns.ROTATIONS,
        *turns.LOGARITHMS,
        *stretch.DECOMPOSITIONS,
        *stretch.PARAMETERS,
        *shapes.SHAPES,
    ]
    return sorted(found, key=_order)


def select(words: str) -> list[_errata.Erratum]:
    """Return the errata that a user means, all for no words.

    Raises
    ------
    UsageError
        If there is none at that place, naming the nearest.
    """
    known = every()
    chosen = _errata.select(words, known)
    if not chosen:
        hint = nearest(words, [name for one in known for name in (one.where, *one.also)])
        raise click.UsageError(f"no erratum {words!r}.{hint} lietool errata lists all")
    return chosen


def describe(one: _errata.Erratum) -> dict[str, Any]:
    """Return an erratum and its counterexample, computed now, ready for JSON; null stands for no value."""
    found = one.compute()
    return {
        "where": one.where,
        "printed": one.printed,
        "true": one.true,
        "why": one.why,
        "example": one.example,
        "printed_gives": _plain(found.printed),
        "true_gives": _plain(found.true),
        "error": _plain(found.error),
        "error_of_true": _plain(found.rest),
    }


def _order(one: _errata.Erratum) -> tuple[int, bool, list[int]]:
    """The text, then its numbers; what has a letter before its number comes after."""
    text, place = one.where.split(" ", 1)
    numbers = re.findall(r"\d+", place.partition(",")[0])
    return "BMK".index(text), place.startswith(("A.", "Alg", "Table")), [int(n) for n in numbers]


def _plain(value: Any) -> Any:
    """Return numbers and lists of them; None for nan."""
    if isinstance(value, float):
        return None if math.isnan(value) else value
    return (
        [_plain(item) for item in value.tolist()] if hasattr(value, "tolist") else [_plain(v) for v in value]
    )


def _page(about: dict[str, Any]) -> str:
    lines = [about["where"]]
    rows = [
        ("printed", about["printed"]),
        ("true", about["true"]),
        ("why", about["why"]),
        ("example", about["example"]),
        ("printed gives", _text(about["printed_gives"])),
        ("true gives", _text(about["true_gives"])),
        ("error", f"{_number(about['error'])} (of the true form {_number(about['error_of_true'])})"),
    ]
    width = max(min(shutil.get_terminal_size((100, 24)).columns, 100), 60)
    for head, text in rows:
        lines += textwrap.wrap(
            text, width, initial_indent=f"  {head:<15}", subsequent_indent=" " * 17, break_on_hyphens=False
        )
    return "\n".join(lines)


def _text(value: Any) -> str:
    if value is None:
        return "no value"
    if isinstance(value, Sequence):
        return f"({', '.join(_text(item) for item in value)})"
    return f"{value + 0.0:.6g}" if abs(value) > 1e-14 else "0"


def _number(value: float | None) -> str:
    if value is None or math.isnan(value):
        return "no value"
    return f"{value:.3g}"
