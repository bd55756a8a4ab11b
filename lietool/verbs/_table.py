"""Tables for a reader: ruled and coloured on a terminal, aligned columns of plain text in a pipe."""

import sys
from collections.abc import Iterable, Iterator, Sequence
from typing import TypeVar

import click

T = TypeVar("T")

_STYLES = {"equal": "green", "passes": "green", "golden": "green", "not compared": "dim"}
_STYLES |= {"proved": "green", "law": "green", "implemented": "yellow", "open": "dim"}
_STYLES |= {"holds": "green", "": "dim"}


def show(heads: Sequence[str], rows: Sequence[Sequence[str]], verdict: int | None = None) -> None:
    """Print a table.

    Parameters
    ----------
    heads : sequence of str
        One per column.
    rows : sequence of sequence of str
        The cells.
    verdict : int, optional
        The column whose words are coloured: green where all is well, red otherwise.
    """
    if not sys.stdout.isatty():
        _plain([heads, *rows])
        return
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for number, head in enumerate(heads):
        table.add_column(head, no_wrap=number == 0, overflow="fold")
    for row in rows:
        table.add_row(
            *(Text(cell, _STYLES.get(cell, "red") if i == verdict else "") for i, cell in enumerate(row))
        )
    Console().print(table)


def progress(things: Sequence[T], doing: str) -> Iterator[T]:
    """Go through things with a progress bar on standard error, if that is a terminal.

    Parameters
    ----------
    things : sequence
        What to go through.
    doing : str
        What stands before the bar.

    Yields
    ------
    object
        Each of them.
    """
    if not sys.stderr.isatty() or len(things) < 2:
        yield from things
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(things, doing, console=Console(stderr=True), transient=True)


def _plain(rows: Iterable[Sequence[str]]) -> None:
    rows = list(rows)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        click.echo("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
