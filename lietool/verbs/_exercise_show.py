"""`lietool exercise show` and `start`: what is to be written, and the file that it is written in."""

import json
import sys
from pathlib import Path
from typing import Any

import click

from lietool import atomic, paths
from lietool.exercise import Exercise, load
from lietool.verbs import _exercise_tex, _studio

# The width that is read well, where a terminal has more.
_WIDTH = 100


def brief(exercise: Exercise) -> dict[str, Any]:
    """Return what a list says of an exercise."""
    return {
        "number": exercise.number,
        "name": exercise.name,
        "title": exercise.title,
        "equations": list(exercise.equations),
        "plate": exercise.picture.plate,
        "points": exercise.total,
    }


def run(name: str, *, solution: bool, as_json: bool) -> None:
    """Print an exercise, or its solution.

    Raises
    ------
    ExerciseError
        If there is no such exercise, or its file is broken.
    """
    exercise = load.load(name)
    if as_json:
        click.echo(json.dumps(_described(exercise, solution), indent=2, ensure_ascii=False))
    elif solution:
        click.echo(exercise.solution_source, nl=False)
    else:
        _print(exercise)


def start(name: str, folder: Path) -> None:
    """Write the file that an exercise begins with, and say what comes next.

    Raises
    ------
    ExerciseError
        As `run`.
    Stop
        With 2 if the file is there already or cannot be written.
    """
    exercise = load.load(name)
    file = folder / f"{exercise.name.replace('-', '_')}.py"
    if file.exists() or file.is_symlink():
        raise _studio.Stop(2, f"{file} is there already, and stays as it is. Name another folder")
    with _studio.writing(str(file)):
        atomic.write_bytes(file, exercise.starter_source.encode())
    program = _program(exercise)
    names = ", ".join(function.name for function in exercise.functions)
    click.echo(f"{file}: write {names} there. Then:")
    click.echo(f"  {program} exercise check {file}")
    click.echo(f"`{program} exercise show {exercise.name}` says what is to be written.")


def _described(exercise: Exercise, solution: bool) -> dict[str, Any]:
    checks = [{"title": check.title, "points": check.points} for check in exercise.checks]
    checks.append({"title": f"the picture {exercise.picture.plate}", "points": exercise.picture.points})
    told = {"statement": exercise.statement, "starter": exercise.starter_source, "checks": checks}
    told["functions"] = [function.name for function in exercise.functions]
    return brief(exercise) | told | ({"solution": exercise.solution_source} if solution else {})


def _page(exercise: Exercise, markdown: bool) -> str:
    # The first line is a title, and so is the exercise's own.
    _, _, text = exercise.statement.partition("\n")
    equations = f" ({', '.join(exercise.equations)})" if exercise.equations else ""
    rows = [f"- {check.title}: {_points(check.points)}" for check in exercise.checks]
    rows.append(f"- the picture {exercise.picture.plate}: {_points(exercise.picture.points)}")
    head = f"# {exercise.number}. {exercise.title}{equations}"
    return "\n".join(
        [head, "", _exercise_tex.readable(text.strip(), markdown=markdown), "", "## Checks", "", *rows]
    )


def _program(exercise: Exercise) -> str:
    return _studio.program(load.names()[exercise.name].is_relative_to(paths.EXERCISES))


def _points(count: int) -> str:
    return "1 point" if count == 1 else f"{count} points"


def _print(exercise: Exercise) -> None:
    program = _program(exercise)
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markdown import Markdown

        console = Console()
        console.print(Markdown(_page(exercise, True)), width=min(console.width, _WIDTH))
    else:
        click.echo(_page(exercise, False))
    click.echo()
    click.echo(f"{program} {_figure(exercise)} draws the picture, and")
    click.echo(f"{program} exercise start {exercise.name} writes the file to fill in.")


def _figure(exercise: Exercise) -> str:
    from lietool import figure

    plate = exercise.picture.plate
    return f"{figure.plates().get(plate, '')} --plate {plate}"
