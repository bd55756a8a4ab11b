"""`lietool bench deform` and `bench meshes`: how long the deformers take, and what they do to any mesh."""

import json
import math
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from lietool.verbs import _bench_process, _table

if TYPE_CHECKING:
    from lietool.bench.deformers import Row
    from lietool.bench.meshes import Row as MeshRow
    from lietool.bench.meshes import Subject

_VERDICTS = {True: "met", False: "missed", None: ""}
_FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
# Of the procedural solids: enough to see what happens, and made in a few seconds each.
_SPACING = 0.085


@click.command()
@click.option(
    "--size",
    "sizes",
    type=click.IntRange(12, 4_000_000),
    multiple=True,
    default=(100_000, 1_000_000),
    show_default=True,
    help="Points, for probes, cages and skinning; may be given again.",
)
@click.option("--mesh", type=_FILE, help="Take this mesh instead: .obj, .ply, .off, .stl or .glb.")
@click.option("--only", multiple=True, help="Only methods whose name begins so; may be given again.")
@click.option("--json", "as_json", is_flag=True, help="Print the measurements as JSON.")
def deform(sizes: tuple[int, ...], mesh: Path | None, only: tuple[str, ...], as_json: bool) -> None:
    """Time the deformers after their preparation.

    Sixteen probes move points by every way of blending, the same as libigl's linear blend skinning and
    dual quaternions by pytransform3d beside them; a cage of eighty faces, with weights of its own, mean
    value and Green coordinates, up to 300 000 points; Poisson drag and ARAP on a body of 43 562 vertices, as
    many as Stanford's armadillo, the polish by ten rounds like libigl's; three shapes blended, of 2 892
    vertices. Each has a process of its own, whose peak memory is shown. Weights of probes are not counted;
    the preparation of a Poisson drag contains its harmonic weights.
    """
    from lietool.bench import deformers

    missing = deformers.missing()
    if missing:
        click.echo(f"Compared without some: {'; '.join(sorted(set(missing.values())))}.", err=True)
    # Of a mesh that is given, all sizes are its own.
    chosen = deformers.chosen(sizes if mesh is None else sizes[:1], missing, cages=mesh is not None)
    chosen = [(name, size) for name, size in chosen if not only or name.startswith(only)]
    if not chosen:
        raise click.UsageError(f"--only must begin one of: {'; '.join(deformers.METHODS)}.")
    rows = [_measured(method, size, mesh) for method, size in _table.progress(chosen, "timing")]
    if as_json:
        lines = [asdict(row) | {"goals": row.goals, "met": row.met} for row in rows]
        click.echo(json.dumps({"cpus": os.cpu_count(), "rows": lines}, indent=2))
        return
    click.echo(f"The least of several runs, {os.cpu_count()} CPUs")
    heads = ("method", "vertices", "before", "each", "memory", "goal", "verdict")
    _table.show(heads, [_cells(row) for row in rows])


@click.command(hidden=True)
@click.argument("method")
@click.argument("size", type=int)
@click.argument("mesh", type=_FILE, required=False)
def deform_work(method: str, size: int, mesh: Path | None) -> None:
    """Time one deformer in this process, and print the row as JSON."""
    from lietool.bench import deformers
    from lietool.mesh import surface_io

    read = None if mesh is None else surface_io.read(mesh)
    row = deformers.measure(method, size, None if read is None else (read.vertices, read.faces))
    click.echo(json.dumps(asdict(deformers.with_memory(row, _bench_process.peak()))))


def _measured(method: str, size: int, mesh: Path | None) -> "Row":
    from lietool.bench import deformers

    call = [sys.executable, "-m", "lietool", "bench", "deform-work", method, str(size)]
    return deformers.Row(**json.loads(_bench_process.timed([*call, *([str(mesh)] if mesh else [])])[1]))


def _cells(row: "Row") -> tuple[str, ...]:
    words = ("{} before", "{} each")
    goals = [w.format(f"< {g:g} s") for w, g in zip(words, row.goals, strict=True) if g is not None]
    return (
        row.method,
        str(row.vertices),
        _seconds(row.prepare),
        _seconds(row.solve),
        f"{row.megabytes:.0f} MB",
        ", ".join(goals),
        _VERDICTS[row.met],
    )


@click.command()
@click.argument("files", nargs=-1, type=_FILE)
@click.option("--json", "as_json", is_flag=True, help="Print the numbers as JSON.")
def meshes(files: tuple[Path, ...], as_json: bool) -> None:
    """Try every deformer on meshes: time, stretch, flipped faces, and what is refused.

    Of FILES .obj, .ply, .off, .stl or .glb; without any, on the solids that the figures show. An end of the
    longest axis is turned and stretched by a probe or a handle, a cage or a target twisted. Least and
    most are singular values of the faces' maps; flipped are faces that are turned over against those across
    their edges. A cage that encloses the mesh is found once; these seconds are told below the table.

    Exits with 1 if a deformer fails without a message, which is a bug.
    """
    from lietool.bench import meshes as bench

    bench.warm()
    rows: list[MeshRow] = []
    cages: dict[str, tuple[int, float]] = {}
    for subject in _subjects(files):
        # One mesh at a time is kept, whatever it needed.
        rows += [
            bench.measure(subject, deformer) for deformer in _table.progress([*bench.DEFORMERS], subject.name)
        ]
        if "cage" in vars(subject):
            cages[subject.name] = (len(subject.cage.F), subject.cage.seconds)
    if as_json:
        found = {name: {"faces": faces, "seconds": seconds} for name, (faces, seconds) in cages.items()}
        click.echo(json.dumps({"rows": [_plain(row) for row in rows], "cages": found}, indent=2))
    else:
        heads = (
            "mesh",
            "vertices",
            "faces",
            "deformer",
            "before",
            "each",
            "least",
            "most",
            "flipped",
            "refused",
        )
        _table.show(heads, [_line(row) for row in rows])
        for name, (faces, seconds) in cages.items():
            click.echo(f"{name}: a cage of {faces} faces in {_seconds(seconds)}")
    if any(row.failed for row in rows):
        raise click.exceptions.Exit(1)


def _subjects(files: Sequence[Path]) -> "Iterator[Subject]":
    from lietool.bench.meshes import Subject
    from lietool.mesh import solids, surface_io

    if not files:
        for name, make in solids.SOLIDS.items():
            solid = make(_SPACING)
            yield Subject(name, solid.vertices, solid.faces)
    for path in files:
        read = surface_io.read(path)
        yield Subject(path.name, read.vertices, read.faces)


def _plain(row: "MeshRow") -> dict[str, Any]:
    """Return a row as JSON has it, which knows no nan."""
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in asdict(row).items()}


def _line(row: "MeshRow") -> tuple[str, ...]:
    said = f"failed: {row.failed}" if row.failed else row.refused
    sizes = (row.mesh, str(row.vertices), str(row.faces), row.deformer)
    if said:
        return *sizes, "", "", "", "", "", said
    numbers = ("" if np.isnan(x) else f"{x:.3g}" for x in (row.least, row.most))
    return *sizes, _seconds(row.prepare), _seconds(row.solve), *numbers, str(row.flipped or ""), ""


def _seconds(value: float) -> str:
    return f"{value:.3g} s" if value >= 1.0 else f"{1e3 * value:.3g} ms"
