"""`lietool exercise export`: exercises as an assignment for a class, in another system's own format."""

import importlib
from pathlib import Path

import click

from lietool.verbs import _studio

_SYSTEMS = ("gradescope", "nbgrader", "plain")
_NO_GOLDEN = 3
# What comes next.
_NEXT = {
    "gradescope": "Upload autograder.zip to a programming assignment of {total} points; hand out students/.",
    "nbgrader": "There nbgrader knows {count} as an assignment: `nbgrader generate_assignment {first}`.",
    "plain": "Hand out students/; ./grade.sh FOLDER grades what comes back.",
}


@click.command("export")
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option(
    "--to",
    type=(click.Choice(_SYSTEMS), click.Path(path_type=Path)),
    required=True,
    metavar="SYSTEM DIR",
    help="gradescope, nbgrader or plain; and the folder to write, which is new, empty, or an older export.",
)
@click.option(
    "--seed",
    type=click.IntRange(0),
    metavar="N",
    default=0,
    show_default=True,
    help="Of the random inputs that marks are given for.",
)
def command(names: tuple[str, ...], to: tuple[str, Path], seed: int) -> None:
    """Write exercises as an assignment for a class, all of them where none is named.

    \b
    gradescope  autograder.zip to be uploaded there, and a folder for students
    nbgrader    a course with a source notebook for each exercise; needs nbformat
    plain       a folder for students, and a script that grades what comes back

    Each has the lietool that runs as a wheel: so students and graders have what
    you have tried.  DIR/README.md says what to do with it.
    """
    from lietool.exercise import export, export_wheel
    from lietool.exercise.record import NoGoldenError

    system, folder = to
    writer = importlib.import_module(f"lietool.exercise.export_{system}")
    if strange := export.stranger(folder):
        raise _studio.Stop(2, f"{folder} cannot take an assignment: {strange}. Name a new folder")
    try:
        assignment = export.gather(names, seed)
        files = writer.files(assignment, export_wheel.wheel())
    except NoGoldenError as error:
        raise _studio.Stop(_NO_GOLDEN, str(error)) from None
    with _studio.writing(str(folder)):
        export.publish(folder, files)
    exercises = assignment.exercises
    count = "the exercise" if len(exercises) == 1 else f"each of {len(exercises)} exercises"
    click.echo(f"{folder}: {assignment.total} points. {folder / 'README.md'} says what to do with it.")
    click.echo(_NEXT[system].format(total=assignment.total, count=count, first=exercises[0].name))
