"""Exercises: from an equation of the book to marks, with a picture.

An exercise is one file ``exercises/<name>.py``.  Its docstring is the statement, the functions of which it
says `Function` are both the starter (their signatures and docstrings) and the library's own solution (their
bodies), and ``EXERCISE = Exercise(...)`` has the checks, the picture and the mistakes that are recognised:

.. code-block:: python

    \"\"\"The root of a number.

    Heron's rule: write `root(x)` so that ...
    \"\"\"

    import numpy as np

    from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


    def root(x):
        \"\"\"Return the root of x >= 0, an array of any shape.\"\"\"
        return np.sqrt(x)


    def _numbers(rng):
        yield Case("four", (4.0,))
        yield Case("a hundred at once", (rng.random(100),))


    def _squares(f, rng):
        x = rng.random(5)
        yield Claim("its square is x", f.root(x) ** 2, x, given=(x,))


    EXERCISE = Exercise(
        number=1,
        title="The root of a number",
        equations=("2.1",),
        functions=(Function("root", reference=np.sqrt, starter="return np.full(np.shape(x), np.nan)"),),
        checks=(Check("numbers", 4, cases=_numbers), Check("squares", 3, law=_squares)),
        picture=Picture("B2.1", 3, lambda f: {"root": f.root}),
        mistakes=(Mistake("half", "This is half of x.", {"root": lambda x: np.asarray(x) / 2.0}),),
    )

What a student writes runs in a process of its own (`student`); only its values come back, and `grade` judges
them here.
"""

from lietool.exercise.record import Case as Case
from lietool.exercise.record import Check as Check
from lietool.exercise.record import Claim as Claim
from lietool.exercise.record import Exercise as Exercise
from lietool.exercise.record import ExerciseError as ExerciseError
from lietool.exercise.record import Function as Function
from lietool.exercise.record import Mistake as Mistake
from lietool.exercise.record import Picture as Picture
from lietool.function import Library as Library
