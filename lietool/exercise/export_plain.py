"""An assignment without any other system: a folder for students, and a script that grades what comes back."""

from lietool.exercise import export, export_students
from lietool.exercise.export import Assignment


def files(assignment: Assignment, wheel: tuple[str, bytes]) -> dict[str, bytes]:
    """Return the files of an assignment, by their paths.

    Parameters
    ----------
    assignment : Assignment
    wheel : tuple of str and bytes
        By `export_wheel.wheel`.

    Raises
    ------
    ExerciseError
        If the plate of an exercise cannot be had.
    """
    what = export_students.what(assignment.exercises)
    about = {"total": assignment.total, "seed": assignment.seed, "wheel": wheel[0]}
    return {
        "README.md": export.template("plain.md", what=what[0].upper() + what[1:], **about),
        "grade.sh": export.template("grade.sh", seed=assignment.seed),
        **export_students.files(assignment, wheel),
        **assignment.own,
    }
