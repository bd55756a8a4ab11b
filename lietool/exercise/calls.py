"""A student's functions as laws and figures call them: what comes back is as the right function gives it."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from lietool.exercise import compare
from lietool.exercise.record import Exercise, Function


class Caller(Protocol):
    """What runs a student's functions: `lietool.exercise.student.Student`, or another in a test."""

    def call(self, function: str, *args: Any) -> Any:
        """Call a function by its name; raises `student.Trouble`."""
        ...


class Functions:
    """The functions of a submission as attributes: ``f.rotation(axis, angle)``.

    What they return is of double precision and has the shape that it should have: a law or a figure need not
    ask whether somebody has returned integers.  Where it is of another shape `compare.UnlikeError` is raised.

    Parameters
    ----------
    exercise : Exercise
        Whose functions they are.
    student : Caller
        Where they run.
    finite : bool
        Whether what is not finite is refused too: a figure cannot draw it.
    """

    def __init__(self, exercise: Exercise, student: Caller, *, finite: bool = False) -> None:
        self._student, self._finite = student, finite
        for function in exercise.functions:
            setattr(self, function.name, self._calling(function))

    def __getattr__(self, name: str) -> Callable[..., Any]:
        raise AttributeError(f"the exercise has no function {name!r}")

    def _calling(self, function: Function) -> Callable[..., Any]:
        def call(*args: Any) -> Any:
            got = self._student.call(function.name, *args)
            try:
                wanted = function.wanted(*args)
            except ValueError:
                # What other functions of the student gave may be nothing that the right one takes.
                return got
            try:
                made = compare.doubles(got, wanted)
            except compare.UnlikeError as error:
                raise compare.UnlikeError(f"{function.name}: {error}") from None
            if self._finite and not _is_finite(made):
                raise compare.UnlikeError(f"{function.name}: it returned numbers that are not finite")
            return made

        return call


def _is_finite(value: Any) -> bool:
    if isinstance(value, tuple | list):
        return all(map(_is_finite, value))
    return bool(np.isfinite(np.asarray(value)).all())
