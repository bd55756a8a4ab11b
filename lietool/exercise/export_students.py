"""What students get: what is to be done, the files to begin with, and lietool itself."""

from collections.abc import Sequence

from lietool.exercise import export
from lietool.exercise.export import Assignment
from lietool.exercise.record import Exercise


def files(assignment: Assignment, wheel: tuple[str, bytes]) -> dict[str, bytes]:
    """Return the folder of an assignment that is handed out.

    Parameters
    ----------
    assignment : Assignment
    wheel : tuple of str and bytes
        By `export_wheel.wheel`.

    Returns
    -------
    dict
        By paths, which begin with ``students/``.

    Raises
    ------
    ExerciseError
        If the plate of an exercise cannot be had.
    """
    made = {"README.md": _readme(assignment, wheel[0])}
    for exercise in assignment.exercises:
        name = export.file_name(exercise)
        made[name] = exercise.starter_source.encode()
        made[f"{name.removesuffix('.py')}.md"] = export.statement(exercise).encode()
        made[export.plate_file(exercise)] = export.plate(exercise)
    made[wheel[0]] = wheel[1]
    return {f"students/{name}": data for name, data in made.items()}


def _readme(assignment: Assignment, wheel: str) -> bytes:
    rows = [
        f"| {x.number} | [{x.title}]({export.file_name(x).removesuffix('.py')}.md) "
        f"| `{export.file_name(x)}` | {x.total} |"
        for x in assignment.exercises
    ]
    note = ""
    if assignment.own:
        own = [
            path.removeprefix("project/exercises/").removesuffix(".py").replace("_", "-")
            for path in assignment.own
            if path.startswith("project/exercises/")
        ]
        listed = ", ".join(x.name for x in assignment.exercises if x.name in own)
        note = f"\nYour teacher's own are not in lietool, and are checked when you hand in: {listed}.\n"
    return export.template(
        "students.md",
        table="\n".join(["| | exercise | file | points |", "| ---: | --- | --- | ---: |", *rows]),
        wheel=wheel,
        first=assignment.exercises[0].name,
        file=export.file_name(assignment.exercises[0]),
        note=note,
    )


def what(exercises: Sequence[Exercise]) -> str:
    """Name exercises in a sentence."""
    if len(exercises) == 1:
        return f"the exercise {exercises[0].name}"
    names = [exercise.name for exercise in exercises]
    return f"{len(names)} exercises ({', '.join(names[:-1])} and {names[-1]})"
