"""A student's functions, called in a process of their own: only values come back, or the trouble that came.

What a student's file can do there, and what it cannot:

- It runs in another process, in an empty environment and a folder of its own that is removed.  What it does
  to its interpreter (a function of numpy replaced, `open` replaced, the loop that calls it found through a
  frame) it does to itself: nothing of the grader is there, neither the reference nor the expected values.
- It answers on a socket that its prints do not reach, in arrays of numbers and never in pickled objects.  Who
  finds the socket can send answers there, but no others than a function could have returned: only values can
  be forged, and they are judged as any others.
- Time is the processor's, so that a busy machine fails nobody; who sleeps meets the clock on the wall.
  Memory, written bytes, open files and processes are limited, and threads refused.  A process that hangs,
  crashes or ends loses its own call: the next call starts another.  It ends with the grader, also if that is
  killed.
- Other imports, files outside, processes, the network and signals are refused twice.  An audit hook of
  Python says why, in words for a student; it is no wall, for a process cannot be kept from itself.  On Linux
  (x86_64, aarch64) the kernel is the wall: Landlock (since 5.13) leaves the files of Python and numpy to be
  read, and a filter of system calls leaves those of computing.  `Student.walls` says which of the two stand.
  On macOS, and on Linux without them, the audit hook and the limits are all there is.

What it does not protect against: a fault in the kernel or in these walls; a function that recognises its
input and returns what the book says; a student who learns from the messages what a hidden input was; two
students who hand in the same.  Strangers who mean harm belong in a container besides (the README has a
recipe).

Grading the same file twice gives the same: random and numpy.random start from the seed, also a generator that
is given none, and texts hash the same.  A file that reads the clock or `id()` can still differ, and one that
takes just about the time that it has.

It needs Linux or macOS: on Windows a process cannot be limited so.
"""

import os
from collections.abc import Sequence
from typing import Any, Self

import numpy as np

from lietool.exercise import _student_wire as wire
from lietool.exercise._student_process import Process
from lietool.exercise._student_trouble import Limits, Trouble, plain

__all__ = ["Limits", "Student", "Trouble"]

# In characters: the longest solution of ours has some four thousand.
_LONGEST_SOURCE = 1 << 20
# Of what it prints, in characters.
_PRINTED = 4000


class Student:
    """A student's functions, each called by its name.

    It is to be entered, used and left in one thread: its process ends with that.

    Parameters
    ----------
    source : str
        The student's file.
    functions : sequence of str
        What may be called.
    allowed : sequence of str
        Modules that may be imported beside numpy and the plain ones of the standard library.
    limits : Limits
    name : str
        What messages call the file.
    seed : int
        Of random and numpy.random, 0 or more.

    Raises
    ------
    RuntimeError
        If this system cannot limit a process.
    """

    def __init__(
        self,
        source: str,
        *,
        functions: Sequence[str],
        allowed: Sequence[str] = (),
        limits: Limits = Limits(),  # noqa: B008 - it is frozen
        name: str = "submission.py",
        seed: int = 0,
    ) -> None:
        if os.name != "posix":
            raise RuntimeError(
                "a student's file is graded in a process with limits: that needs Linux or macOS"
            )
        # A mark that some editors begin a file with is no part of it.
        self._source = source.removeprefix("\ufeff")
        self._functions, self._allowed = tuple(functions), tuple(allowed)
        self._limits, self._name, self._seed = limits, name, seed
        self._process: Process | None = None
        self._printed = b""
        self._lost = _of_text(source)
        self.walls: tuple[str, ...] = ()

    def __enter__(self) -> Self:
        # It imports numpy while the grader makes ready too.
        if self._lost is None:
            self._process = self._started()
        return self

    def __exit__(self, *_: object) -> None:
        self._forget()

    @property
    def printed(self) -> str:
        """What it has printed so far, cut to 4000 characters."""
        data = self._printed + (bytes(self._process.printed) if self._process else b"")
        return plain(data.decode("utf-8", "replace"))[:_PRINTED]

    def call(self, function: str, *args: Any) -> np.ndarray | tuple[np.ndarray, ...]:
        """Call a function of the student.

        Parameters
        ----------
        function : str
            Its name.
        *args : array_like, str, or tuple or list of these
            Copies of them are passed; arrays stay arrays, and numbers what they are.

        Returns
        -------
        ndarray or tuple of ndarray
            Numbers of at most double precision.  They are the grader's own, and may be written.

        Raises
        ------
        Trouble
            If no value comes.
        ValueError
            If the exercise has no such function, or an argument is nothing that can be sent.
        """
        if function not in self._functions:
            raise ValueError(f"{function} is none of the functions {', '.join(self._functions)}")
        process = self._loaded()
        try:
            values = process.ask({"function": function}, args)
        except Trouble:
            if not process.lives:
                self._forget()
            raise
        except wire.WireError as error:
            raise ValueError(f"an argument of {function} cannot be passed: {error}") from None
        if len(values) == 1 and isinstance(values[0], np.ndarray):
            return values[0]
        if len(values) == 1 and isinstance(values[0], tuple):
            parts = values[0]
            if all(isinstance(part, np.ndarray) for part in parts):
                return parts
        raise Trouble("output", "it answered something that is no array")

    def _started(self) -> Process:
        return Process(self._allowed, self._limits, self._name, "random" in self._source)

    def _loaded(self) -> Process:
        """Return a process in which the file is loaded; raises what came of that before."""
        if self._lost is not None:
            raise self._lost.again()
        if self._process is None:
            self._process = self._started()
        process = self._process
        if not process.loaded:
            process.loaded = True
            try:
                process.ask({"source": self._source, "seed": self._seed})
            except Trouble as trouble:
                self._lost = trouble
                self._forget()
                raise trouble.again() from None
            self.walls = process.walls or ()
        return process

    def _forget(self) -> None:
        """End the process; the next call starts another."""
        if self._process is not None:
            self._process.end()
            self._printed += self._process.printed
            self._process = None


def _of_text(source: str) -> Trouble | None:
    """Return what is wrong with a text before it is loaded anywhere."""
    if len(source) > _LONGEST_SOURCE:
        return Trouble(
            "refused", f"the file has {len(source)} characters: at most {_LONGEST_SOURCE} are read"
        )
    if "\0" in source:
        line = source[: source.index("\0")].count("\n") + 1
        return Trouble("error", "SyntaxError: there is a NUL character", "SyntaxError", ("Exception",), line)
    return None
