"""`lietool bench table1` and `table2`: the tables of Kaji and Ochiai, measured on this machine."""

import json
import os
from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from lietool.verbs import _table

if TYPE_CHECKING:
    from lietool.bench.experiments import Finding
    from lietool.bench.tables import Line

_COUNT = click.option(
    "--count",
    type=click.IntRange(1, 10_000_000),
    default=100_000,
    show_default=True,
    help="Random matrices; the paper takes a million.",
)
_JSON = click.option("--json", "as_json", is_flag=True, help="Print the measurements as JSON.")


@click.command()
@_COUNT
@_JSON
def table1(count: int, as_json: bool) -> None:
    """Measure table 1 of Kaji and Ochiai: exp, log.

    exp of symmetric 3 x 3 matrices, log of positive definite ones.
    Ours is lietool.lie.sym; the same as printed in the paper, (6) and (7);
    Higham's algorithm as SciPy has it, one matrix after the other, so on fewer
    of them; diagonalisation by LAPACK. The error is the largest squared
    Frobenius norm |X - exp(log X)|^2, as in the paper. Random X = A^T A with
    normal A, det A > 1e-3. The paper uses a single thread: so do NumPy and
    SciPy with OPENBLAS_NUM_THREADS=1 in the environment.
    """
    from lietool.bench import tables

    lines = tables.table1(count)
    if as_json:
        click.echo(json.dumps([asdict(line) for line in lines], indent=2))
        return
    click.echo(f"Time per matrix, {os.cpu_count()} CPUs")
    _show(("", "exp of sym(3)", "log of Sym+(3)"), lines)


@click.command()
@_COUNT
@_JSON
def table2(count: int, as_json: bool) -> None:
    """Measure table 2 of Kaji and Ochiai: phi, psi.

    The parametrisations of Aff+(3): what they cost, and what they can do.
    The error is the largest squared Frobenius norm |X - phi(psi(X))|^2 over
    normal X with det X > 1e-3. (The paper exchanges the columns phi and psi.)
    Every yes and no is the result of an experiment that looks for a
    counterexample; * marks those where the paper says otherwise. The paper's
    "no" to associativity is true of the powers: that the s-multiple after the
    t-multiple is the (s + t)-multiple.
    """
    from lietool.bench import experiments, tables

    lines, found = tables.table2(count), experiments.findings()
    careless = tables.careless_error(count)
    if as_json:
        rows = {name: {key: asdict(value) for key, value in row.items()} for name, row in found.items()}
        times = [asdict(line) for line in lines]
        click.echo(json.dumps({"times": times, "careless error": careless, "findings": rows}, indent=2))
        return
    click.echo(f"Time per matrix, {os.cpu_count()} CPUs")
    _show(("", "phi", "psi"), lines)
    click.echo(f"Alexa/SAM by the real part of any complex logarithm: error {careless:.1e}\n")
    cells = []
    for item in experiments.PROPERTIES:
        cells.append((item.name, *(_answer(name, item.name, row[item.name]) for name, row in found.items())))
    _table.show(("", *found), cells)
    click.echo("\n* The paper says otherwise.")


def _answer(method: str, name: str, finding: "Finding") -> str:
    from lietool.bench import experiments

    claim = experiments.PRINTED.get(method, {}).get(name)
    answer = "yes" if finding.holds else "no"
    return answer + ("" if claim in (None, finding.holds) else " *")


def _show(heads: Sequence[str], lines: Sequence["Line"]) -> None:
    cells = []
    for line in lines:
        of = f"{line.count}" + (f", {line.missed} have no parameters" if line.missed else "")
        cells.append(
            (line.name, f"{line.back * 1e9:.0f} ns", f"{line.there * 1e9:.0f} ns", f"{line.error:.1e}", of)
        )
    _table.show((*heads, "error", "of"), cells)
