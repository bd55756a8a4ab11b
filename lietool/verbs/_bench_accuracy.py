"""`lietool bench accuracy`: errors against 50 digits, beside those of others, and the promises."""

import importlib.util
import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from lietool.verbs import _table

if TYPE_CHECKING:
    from lietool.bench.accuracy import Row

BROKEN = 5
_VERDICTS = {True: "holds", False: "broken", None: ""}


@click.command()
@click.option("--quick", is_flag=True, help="Fewer inputs of each class: seconds, not a minute.")
@click.option("--ours", is_flag=True, help="Leave SciPy and pytransform3d out, which take most of the time.")
@click.option("--json", "as_json", is_flag=True, help="Print every row as JSON.")
def accuracy(quick: bool, ours: bool, as_json: bool) -> int:
    """Compare with 50 digits on hard inputs; judge promises.

    Each row is a function on a class of inputs: angles at and near 0 and pi,
    eigenvalues equal, nearly equal and far apart, condition numbers to 1e12,
    scales from 1e-50 to 1e50, determinants of 1e-30. It shows the worst
    relative error, what is promised where the two are nearest, and the errors
    of others. At a half turn both signs of the axis are right. Nothing is
    promised where the promise is empty.

    Needs mpmath, which comes with lietool[test]. Exit code 0 if every promise
    holds, 5 if one is broken.
    """
    if importlib.util.find_spec("mpmath") is None:
        raise click.UsageError("mpmath is not installed. Install lietool[test], which brings it")
    from lietool.bench import accuracy, others, subjects

    missing = {} if ours else others.missing()
    libraries = () if ours else tuple(name for name in others.LIBRARIES if name not in missing)
    if reasons := sorted(set(missing.values())):
        click.echo(f"Compared without some: {'; '.join(reasons)}. Install lietool[test]", err=True)
    count = accuracy.QUICK if quick else accuracy.FULL
    found = [
        row
        for subject in _table.progress(subjects.SUBJECTS, "measuring")
        for row in accuracy.rows_of(subject, count, libraries)
    ]
    broken = [row for row in found if row.holds is False]
    if as_json:
        click.echo(json.dumps({"rows": [asdict(row) | {"holds": row.holds} for row in found]}, indent=2))
    else:
        _show(found, libraries)
    return BROKEN if broken else 0


def _show(found: Sequence["Row"], libraries: Sequence[str]) -> None:
    cells = []
    for row in found:
        others = [_other(row, library) for library in libraries]
        promised = "" if row.allowed is None else f"{row.allowed:.1e}"
        cells.append(
            (
                row.function,
                row.inputs,
                str(row.count),
                f"{row.ours:.1e}",
                promised,
                _VERDICTS[row.holds],
                *others,
            )
        )
    _table.show(
        ("function", "inputs", "number", "error", "promised", "verdict", *libraries), cells, verdict=5
    )
    judged = [row for row in found if row.holds is not None]
    broken = [row for row in judged if not row.holds]
    click.echo(f"\n{len(judged) - len(broken)} of {len(judged)} promises hold.")
    for text in dict.fromkeys(row.promise for row in judged):
        names = ", ".join(dict.fromkeys(row.function for row in judged if row.promise == text))
        click.echo(f"  {text}: {names}")


def _other(row: "Row", library: str) -> str:
    if library not in row.others:
        return ""
    refused = row.refused.get(library, 0)
    if refused == row.count:
        return "refuses all"
    return f"{row.others[library]:.1e}" + (f", refuses {refused}" if refused else "")
