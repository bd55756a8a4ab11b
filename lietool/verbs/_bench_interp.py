"""`lietool bench interp`: time and memory of interpolating whole shapes, beside libigl's ARAP."""

import json
import os
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

import click

from lietool.verbs import _bench_process, _table

if TYPE_CHECKING:
    from lietool.bench.morphs import Row
    from lietool.bench.solvers import Row as SolverRow

_VERDICTS = {True: "met", False: "missed", None: ""}


@click.command()
@click.option(
    "--size",
    "sizes",
    type=click.IntRange(2, 4_000_000),
    multiple=True,
    default=(1_000, 10_000, 100_000),
    show_default=True,
    help="Triangles; may be given again. A million takes some minutes.",
)
@click.option(
    "--frames", type=click.IntRange(1, 10_000), default=60, show_default=True, help="Frames of a film."
)
@click.option("--ours", is_flag=True, help="Leave libigl out.")
@click.option("--solvers", is_flag=True, help="Compare sparse solvers on the same matrices instead.")
@click.option("--json", "as_json", is_flag=True, help="Print the measurements as JSON.")
def interp(sizes: tuple[int, ...], frames: int, ours: bool, solvers: bool, as_json: bool) -> None:
    """Time the interpolation of shapes of many triangles.

    A strip is rolled up by exp and log, all triangles as rigid as may be (E^F)
    or as similar (E^R); beside it libigl's ARAP, ten iterations for a frame,
    from the frame before. Each method and size has a process of its own, whose
    peak memory is shown. The exponent is that of the time for a frame as a
    power of the number of triangles.

    libigl, and for --solvers qdldl and cholespy, are compared with where they
    are installed.
    """
    if solvers:
        _compare(sizes, as_json)
        return
    from lietool.bench import morphs

    missing = {morphs.LIBIGL: ""} if ours else morphs.missing()
    _say_missing([reason for reason in missing.values() if reason])
    chosen = [(method, size) for size in sorted(sizes) for method in morphs.METHODS if method not in missing]
    rows = [_measured(method, size, frames) for method, size in _table.progress(chosen, "timing")]
    grows, ahead = morphs.exponents(rows), morphs.ahead(rows)
    if as_json:
        lines = [asdict(row) | {"ahead": ahead.get((row.method, row.size))} for row in rows]
        click.echo(json.dumps({"rows": lines, "exponents": grows}, indent=2))
        return
    click.echo(f"The least of several runs, {os.cpu_count()} CPUs")
    _show(rows, ahead)
    for method, exponent in grows.items():
        click.echo(f"{method}: a frame of n triangles takes a time like n^{exponent:.2f}")


@click.command(hidden=True)
@click.argument("method")
@click.argument("size", type=int)
@click.argument("frames", type=int)
def interp_work(method: str, size: int, frames: int) -> None:
    """Time one method on one size in this process, and print the row as JSON."""
    from lietool.bench import morphs

    row = morphs.measure(method, size, frames)
    click.echo(json.dumps(asdict(replace(row, megabytes=_bench_process.peak()))))


def _measured(method: str, size: int, frames: int) -> "Row":
    from lietool.bench import morphs

    call = [sys.executable, "-m", "lietool", "bench", "interp-work", method, str(size), str(frames)]
    return morphs.Row(**json.loads(_bench_process.timed(call)[1]))


def _say_missing(reasons: Sequence[str]) -> None:
    if reasons:
        click.echo(f"Compared without some: {'; '.join(reasons)}.", err=True)


def _show(rows: Sequence["Row"], ahead: dict[tuple[str, int], float]) -> None:
    cells = []
    for row in rows:
        goals = [None if goal is None else f"< {goal:g} s" for goal in row.goals]
        factor = ahead.get((row.method, row.size))
        cells.append(
            (
                row.method,
                str(row.triangles),
                _seconds(row.prepare),
                str(row.frames),
                _seconds(row.solve),
                _seconds(row.per_frame),
                f"{row.megabytes:.0f} MB",
                "" if factor is None else f"{factor:.1f} x",
                ", ".join(filter(None, goals)),
                _VERDICTS[row.met],
            )
        )
    heads = (
        "method",
        "triangles",
        "before",
        "frames",
        "all",
        "each",
        "memory",
        "ahead by",
        "goal",
        "verdict",
    )
    _table.show(heads, cells)


def _compare(sizes: Sequence[int], as_json: bool) -> None:
    from lietool.bench import solvers

    _say_missing(list(solvers.missing().values()))
    found = [row for size in _table.progress(sorted(sizes), "timing") for row in solvers.compare(size)]
    if as_json:
        click.echo(json.dumps([asdict(row) for row in found], indent=2))
        return
    click.echo(f"The least of several runs, {os.cpu_count()} CPUs")
    heads = (
        "matrix",
        "triangles",
        "solver",
        "new pattern",
        "same pattern",
        "right sides",
        "solved",
        "residual",
    )
    _table.show(heads, [_line(row) for row in found])


def _line(row: "SolverRow") -> tuple[str, ...]:
    from lietool.bench import solvers

    times = (_seconds(row.first), _seconds(row.again))
    count = str(solvers.RIGHT_SIDES[row.matrix])
    return (
        row.matrix,
        str(row.triangles),
        row.solver,
        *times,
        count,
        _seconds(row.solve),
        f"{row.error:.0e}",
    )


def _seconds(value: float) -> str:
    return f"{value:.3g} s" if value >= 1.0 else f"{1e3 * value:.3g} ms"
