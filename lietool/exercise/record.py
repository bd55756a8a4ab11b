"""What an exercise says of itself: functions to write, checks with points, a picture, and known mistakes."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lietool.exercise import compare
from lietool.function import Library

Value = Any
"""What a function takes or returns: an array, a number, or a tuple of these."""


class ExerciseError(ValueError):
    """An exercise that cannot be used; the message is one line, names the file and says what to do."""


class NoGoldenError(ExerciseError):
    """An exercise whose plate has no picture to compare with."""


@dataclass(frozen=True, eq=False)
class Function:
    """A function that a student writes.

    Parameters
    ----------
    name : str
        As in the file of the exercise, where its docstring and the library's own solution stand.
    library : str
        The dotted name of the function of the library that it is judged by; mistakes of the catalogue are
        tried in that.
    call : callable, optional
        Calls it: ``call(function, *args)``, where its arguments or results are other than the student's.
    reference : callable, optional
        What it is judged by where that is no single function of the library.
    starter : str
        The body that a student starts with: it runs, and gives nan in the right shape.
    apart : callable
        How far apart two results are: ``apart(got, want) -> float``.
    tolerance : float
        How far apart they may be.
    """

    name: str
    library: str = ""
    call: Callable[..., Value] | None = None
    reference: Callable[..., Value] | None = None
    starter: str = "return np.nan"
    apart: Callable[[Value, Value], float] = compare.apart
    tolerance: float = 1e-9

    @property
    def wanted(self) -> Callable[..., Value]:
        """The right function."""
        return self.reference or self.calling(Library(self.library))

    def calling(self, function: Callable[..., Value]) -> Callable[..., Value]:
        """Return a function of the library, or one with a mistake in it, as a student would write it."""
        call = self.call
        return function if call is None else lambda *args: call(function, *args)


@dataclass(frozen=True, eq=False)
class Case:
    """An input, and whether a ValueError is wanted for it.

    Parameters
    ----------
    says : str
        What it is, in words: "angle pi - 1e-9".
    args : tuple
        Arrays and numbers.
    function : str
        Which function it is for, where there are several; else the first.
    raises : bool
        Whether it must be refused.
    """

    says: str
    args: tuple[Value, ...]
    function: str = ""
    raises: bool = False


@dataclass(frozen=True, eq=False)
class Claim:
    """Two values that a law says are equal.

    Parameters
    ----------
    says : str
        The law: "R^T R = 1".
    got, want : array_like
        Both sides; `want` may be one for all of a batch.
    given : tuple
        What they were computed for, to be shown.
    tolerance : float
        How far apart they may be, relative to the larger of 1 and the largest of `want`.
    """

    says: str
    got: Value
    want: Value
    given: tuple[Value, ...] = ()
    tolerance: float = 1e-9


Cases = Callable[[np.random.Generator], Iterable[Case]]
Law = Callable[[Any, np.random.Generator], Iterable[Claim]]


@dataclass(frozen=True, eq=False)
class Check:
    """Something that is worth points, all or none of them.

    Parameters
    ----------
    title : str
        What it is, for a table: "hard inputs".
    points : int
        What it is worth.
    cases : callable, optional
        ``cases(rng)`` gives inputs for which the student's results must be the reference's.
    law : callable, optional
        ``law(f, rng)`` gives claims about what the student's functions ``f.name(...)`` return.
    """

    title: str
    points: int
    cases: Cases | None = None
    law: Law | None = None


@dataclass(frozen=True, eq=False)
class Picture:
    """The plate that shows the function: drawn with the student's, it must be the golden.

    Parameters
    ----------
    plate : str
        Its id.
    points : int
        What it is worth.
    functions : callable
        ``functions(f)`` gives what is passed to the figure in place of the library's, by the names of its
        arguments.
    """

    plate: str
    points: int
    functions: Callable[[Any], Mapping[str, Callable[..., Value]]]


@dataclass(frozen=True, eq=False)
class Mistake:
    """A typical wrong solution: who writes a function that agrees with it is told so.

    Parameters
    ----------
    name : str
        A few words: "degrees".
    says : str
        A sentence or two that teach: what this computes, and what is wanted instead, with the equation.
    functions : mapping from str to callable
        The wrong functions by name; those that are left out are right.
    """

    name: str
    says: str
    functions: Mapping[str, Callable[..., Value]]


@dataclass(frozen=True, eq=False)
class Exercise:
    """An exercise.

    Parameters
    ----------
    number : int
        Its place in the order of the book.
    title : str
        For lists.
    equations : tuple of str
        Their numbers in the book.
    functions : tuple of Function
        What is to be written.
    checks : tuple of Check
        What is tried, from the simple to the hard.
    picture : Picture
        What is drawn.
    mutants : tuple of str
        Mistakes of the catalogue whose names begin so are looked for in what a student has written.
    mistakes : tuple of Mistake
        Those that the catalogue does not have; they are told first.
    allowed : tuple of str
        Modules that may be imported besides numpy and the plain ones of Python.
    name, statement, starter_source, solution_source : str
        Filled in from the file: its name, its docstring, and what a student begins with and may end with.
    arguments : mapping from str to tuple of str
        Filled in from the file: the names of the functions' arguments.
    """

    number: int
    title: str
    equations: tuple[str, ...]
    functions: tuple[Function, ...]
    checks: tuple[Check, ...]
    picture: Picture
    mutants: tuple[str, ...] = ()
    mistakes: tuple[Mistake, ...] = ()
    allowed: tuple[str, ...] = ()
    name: str = ""
    statement: str = field(default="", repr=False)
    starter_source: str = field(default="", repr=False)
    solution_source: str = field(default="", repr=False)
    arguments: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def total(self) -> int:
        """All points."""
        return sum(check.points for check in self.checks) + self.picture.points

    def function(self, name: str) -> Function:
        """Return a function by its name, the first where that is empty; raises KeyError."""
        if not name:
            return self.functions[0]
        return {function.name: function for function in self.functions}[name]
