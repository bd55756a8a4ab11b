"""Measure accuracy, speed, the tables of the papers, and how long starting and drawing take."""

import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import click

from lietool.verbs import (
    _bench_accuracy,
    _bench_class,
    _bench_deform,
    _bench_interp,
    _bench_pairs,
    _bench_peers,
    _bench_process,
    _bench_speed,
    _bench_tables,
    _table,
)

# What the project promises; nothing fails where a machine is slower.
HELP_FACTOR, COLD_SECONDS, PLATE_SECONDS, MEMORY_FACTOR = 1.3, 0.6, 0.4, 1.05
COLD = ("slerp", "--size", "1200x900")


@click.group()
def command() -> None:
    """Measure accuracy, speed, the tables of the papers, and how long starting and drawing take."""


for _subcommand in (
    _bench_accuracy.accuracy,
    _bench_speed.speed,
    _bench_tables.table1,
    _bench_tables.table2,
    _bench_interp.interp,
    _bench_interp.interp_work,
    _bench_pairs.pairs,
    _bench_deform.deform,
    _bench_deform.deform_work,
    _bench_deform.meshes,
    _bench_peers.peers,
    _bench_class.class_,
):
    command.add_command(_subcommand)


@command.command()
@click.option(
    "--runs", type=click.IntRange(1, 1000), default=10, show_default=True, help="Take the median of these."
)
@click.option("--json", "as_json", is_flag=True, help="Print the measurements as JSON.")
def startup(runs: int, as_json: bool) -> None:
    """Time --help, one picture, and every plate.

    Each time is that of a whole process, the median of several runs after one that is not counted. A plate's
    is that of its first drawing in a process whose OpenGL context exists; memory is the peak of that process,
    after it has drawn every plate twice, and six times.
    """
    found = measure(runs)
    if as_json:
        click.echo(json.dumps(found, indent=2))
    else:
        _show(found)


def measure(runs: int) -> dict[str, Any]:
    """Measure everything that `startup` shows.

    Parameters
    ----------
    runs : int
        How often each process is started.

    Returns
    -------
    dict
        ``seconds`` of each process, ``plates`` with the seconds of each, ``megabytes`` after two rounds and
        after six, ``backend``, ``cpus`` and ``runs``.
    """
    python, lietool = [sys.executable, "-c"], [sys.executable, "-m", "lietool"]
    with tempfile.TemporaryDirectory(prefix="lietool-bench-") as folder:
        calls = {
            "import numpy": [*python, "import numpy"],
            "lietool --help": [*lietool, "--help"],
            "lietool " + " ".join(COLD): [*lietool, *COLD, "-o", str(Path(folder, "cold.png"))],
        }
        times: dict[str, list[float]] = {name: [] for name in calls}
        # In turn, so that a machine that slows down slows all of them down.
        for run in range(runs + 1):
            for name, call in calls.items():
                seconds = _bench_process.timed(call)[0]
                if run:
                    times[name].append(seconds)
    worker = json.loads(_bench_process.timed([*lietool, "bench", "work"])[1])
    seconds = {name: statistics.median(values) for name, values in times.items()}
    return {"seconds": seconds, **worker, "cpus": os.cpu_count(), "runs": runs}


@command.command(hidden=True)
def work() -> None:
    """Draw all plates six times in this process, and print seconds, memory and backend as JSON."""
    from lietool import figure
    from lietool.render import context, draw, export

    backend = context.get().backend
    plates = {plate_id: figure.load(name) for plate_id, name in figure.plates().items()}
    seconds: dict[str, float] = {}
    megabytes: list[float] = []
    for _ in range(6):
        for plate_id, loaded in plates.items():
            start = time.perf_counter()
            drawing = loaded.draw(**loaded.plate_params(plate_id))
            export.png(draw.render(drawing.picture).image, {})
            seconds.setdefault(plate_id, time.perf_counter() - start)
        megabytes.append(_bench_process.peak())
    # In the second round everything is loaded, and the memory that the first gave back is in use again.
    memory = {"twice": megabytes[1], "six times": megabytes[-1]}
    click.echo(json.dumps({"plates": seconds, "megabytes": memory, "backend": backend}))


def _show(found: dict[str, Any]) -> None:
    (numpy, base), (help_, shown), (cold, drawn) = found["seconds"].items()
    warm, later = found["megabytes"].values()
    rows = [
        (numpy, base, "s", None),
        (help_, shown, "s", HELP_FACTOR * base),
        (cold, drawn, "s", COLD_SECONDS),
        *(
            (f"plate {plate_id}", seconds, "s", PLATE_SECONDS)
            for plate_id, seconds in found["plates"].items()
        ),
        ("peak memory, every plate twice", warm, "MB", None),
        ("peak memory, six times", later, "MB", MEMORY_FACTOR * warm),
    ]
    cells = []
    for name, value, unit, goal in rows:
        form = "{:.3f} s" if unit == "s" else "{:.0f} MB"
        verdict = "" if goal is None else "met" if value < goal else "missed"
        cells.append((name, form.format(value), "" if goal is None else f"< {form.format(goal)}", verdict))
    click.echo(f"Median of {found['runs']} runs, {found['cpus']} CPUs, {found['backend']}")
    _table.show(("what", "measured", "goal", "verdict"), cells)
