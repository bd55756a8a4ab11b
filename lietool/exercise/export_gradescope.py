"""An assignment for Gradescope: ``autograder.zip`` as it is uploaded there, and a folder for students.

Source: Gradescope, Autograder Specifications.
"""

import json
import math

from lietool.exercise import export, export_students, export_wheel
from lietool.exercise.export import Assignment
from lietool.exercise.grade import PATIENCE
from lietool.exercise.student import Limits


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
    return {
        "README.md": export.template(
            "gradescope.md",
            what=export_students.what(assignment.exercises),
            total=assignment.total,
            seed=assignment.seed,
            minutes=_minutes(assignment),
        ),
        "autograder.zip": autograder(assignment, wheel),
        **export_students.files(assignment, wheel),
    }


def autograder(assignment: Assignment, wheel: tuple[str, bytes]) -> bytes:
    """Return ``autograder.zip``; its files are at its root, where Gradescope looks for them."""
    settings = {
        "exercises": [exercise.name for exercise in assignment.exercises],
        "seed": assignment.seed,
        "visibility": "visible",
        # What the grader prints is for the teacher: the tests say it to the student.
        "stdout_visibility": "hidden",
    }
    return export_wheel.zipped(
        {
            "setup.sh": export.template("setup.sh"),
            "run_autograder": export.template("run_autograder"),
            "requirements.txt": f"./{wheel[0]}\n".encode(),
            "assignment.json": (json.dumps(settings, indent=1) + "\n").encode(),
            wheel[0]: wheel[1],
            **assignment.own,
        }
    )


def _minutes(assignment: Assignment) -> int:
    """The time in which all is graded though every function hangs, in steps of ten minutes."""
    functions = sum(len(exercise.functions) for exercise in assignment.exercises)
    seconds = 60 + functions * PATIENCE * Limits().wall
    return 10 * math.ceil(seconds / 600)
