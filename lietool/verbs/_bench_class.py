"""`lietool bench class`: how long a class of submissions takes to be graded."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from lietool.bench import classes
from lietool.verbs import _studio, _table

# What the project promises; nothing fails where a machine is slower.
ONE_SECONDS, EACH_SECONDS = 2.0, 1.0
_WRONG = 5


@click.command("class")
@click.option("--exercise", "names", multiple=True, help="Only this; again for more. [default: all]")
@click.option("--count", type=click.IntRange(2, 10_000), default=300, show_default=True, help="Submissions.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Of the class.")
@click.option(
    "-o",
    "--output",
    "folder",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder in which to leave the submissions, grades.csv and the report.",
)
@click.option("-j", "--jobs", type=click.IntRange(1, 64), default=2, show_default=True, help="Processes.")
@click.option("--json", "as_json", is_flag=True, help="Print the measurements as JSON.")
def class_(
    names: tuple[str, ...], count: int, seed: int, folder: Path | None, jobs: int, as_json: bool
) -> None:
    """Time the grading of a class.

    The class is made from the solutions of the exercises: right ones, starters
    that nobody has touched, ones with a slip or two, and some that never end.
    Everything is graded anew, with pictures, a table and a report, as
    `lietool exercise check` does it; before that one right submission alone.
    """
    with tempfile.TemporaryDirectory(prefix="lietool-class-") as made:
        where = Path(made) if folder is None else folder
        found = measure(where, names, count, seed, jobs)
    if as_json:
        click.echo(json.dumps(found, indent=2, ensure_ascii=False))
        return
    rows = [
        ("one submission, on a processor", found["one"]["cpu"], ONE_SECONDS),
        (f"{count} submissions, by the clock", found["all"]["wall"], EACH_SECONDS * count),
    ]
    cells = []
    for name, value, goal in rows:
        cells.append((name, f"{value:.2f} s", f"< {goal:g} s", "met" if value < goal else "missed"))
    click.echo(f"{jobs} processes, {found['cpus']} CPUs, seed {seed}")
    _table.show(("what", "measured", "goal", "verdict"), cells)
    marks = ", ".join(f"{n} with {mark}" for mark, n in found["marks"].items())
    click.echo(f"marks: {marks}")


def measure(folder: Path, names: Sequence[str], count: int, seed: int, jobs: int) -> dict[str, Any]:
    """Make a class in a folder, grade it, and return how long that took.

    Parameters
    ----------
    folder : Path
        Where the submissions, ``grades.csv`` and ``report`` go.
    names : sequence of str
        The exercises; all where it is empty.
    count, seed : int
        How many submissions, and of which class.
    jobs : int
        How many processes grade.

    Returns
    -------
    dict
        ``one`` and ``all`` with ``wall`` in seconds, and ``cpu`` of one, ``marks`` and how many have them,
        ``cpus``, ``count`` and ``jobs``.
    """
    files = write(folder / "submissions", names, count, seed)
    check = [sys.executable, "-m", "lietool", "exercise", "check"]
    right = min(file for file, says in files.items() if says == "right")
    one = _timed([*check, str(right), "-o", str(folder)])
    report = ["--csv", str(folder / "grades.csv"), "--report", str(folder / "report")]
    every = _timed([*check, *map(str, files), "--fresh", "--jobs", str(jobs), *report, "--json"])
    graded = json.loads(every.pop("said"))["submissions"]
    # Those of its processes that others have started are not in it.
    every.pop("cpu")
    one.pop("said")
    marks = Counter(f"{each['marks']} of {each['of']}" for each in graded)
    ordered = dict(sorted(marks.items(), key=lambda x: [int(word) for word in x[0].split(" of ")]))
    return {"one": one, "all": every, "marks": ordered, "cpus": os.cpu_count(), "count": count, "jobs": jobs}


def write(folder: Path, names: Sequence[str], count: int, seed: int) -> dict[Path, str]:
    """Write a class, the exercises by turns, and return what was done to each solution by its file."""
    from lietool.exercise import load

    exercises = [load.load(name) for name in names or load.names()]
    if not exercises:
        raise _studio.Stop(2, "there is no exercise to make a class of")
    files: dict[Path, str] = {}
    with _studio.writing(str(folder)):
        folder.mkdir(parents=True, exist_ok=True)
        for index, exercise in enumerate(exercises):
            share = len(range(index, count, len(exercises)))
            made = classes.make(exercise.solution_source, exercise.starter_source, share, seed)
            # One at least is right: it is timed alone.
            made[:1] = [classes.Made(exercise.solution_source, "right")][:share]
            for number, each in enumerate(made):
                file = folder / f"{exercise.name}-{number:03}.py"
                file.write_text(each.source, encoding="utf-8")
                files[file] = each.says
    return files


def _timed(call: Sequence[str]) -> dict[str, Any]:
    """Run a check; return its seconds by the clock and on processors, and what it printed."""
    try:
        import resource
    except ImportError:
        raise _studio.Stop(2, "submissions are graded on Linux and macOS only") from None
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(call, capture_output=True, text=True)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, _WRONG):
        raise _studio.Stop(done.returncode, done.stderr.strip())
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"wall": round(wall, 3), "cpu": round(cpu, 3), "said": done.stdout}
