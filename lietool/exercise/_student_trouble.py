"""What a student's process may use, and what comes of a call that gives no value."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

# Characters of a message.
_LONGEST = 400
_ADDRESS = re.compile(" at 0x[0-9a-fA-F]+")
_KINDS = ("time", "memory", "exit", "refused", "output")


@dataclass(frozen=True)
class Limits:
    """What a student's process may use; other processes and threads it may not start.

    Parameters
    ----------
    cpu : float
        Seconds of the processor's time, in one call.
    wall : float
        Seconds that a call may last.  On Linux one that computes goes on, since the machine may be busy with
        others; ten times as long at most.
    memory : int
        In bytes of addresses, beyond what Python and numpy take.
    files : int
        Open at once.
    written : int
        In bytes: into its folder, and as print.
    answer : int
        In bytes, what a call may return.
    """

    cpu: float = 5.0
    wall: float = 20.0
    memory: int = 1 << 30
    files: int = 32
    written: int = 4 << 20
    answer: int = 64 << 20


class Trouble(Exception):  # noqa: N818 - it is no fault of the program
    """A call that gave no value.

    Parameters
    ----------
    kind : str
        "error" (an exception), "time", "memory", "crash" (of the interpreter), "exit", "refused" or "output"
        (an answer that is none).
    message : str
        One plain line.
    name : str
        The type of the student's exception.
    bases : tuple of str
        The names of the types that it is derived from.
    line : int, optional
        In the student's file.
    """

    def __init__(
        self, kind: str, message: str, name: str = "", bases: Sequence[str] = (), line: int | None = None
    ) -> None:
        super().__init__(message)
        self.kind, self.message, self.name = kind, message, name
        self.bases, self.line = tuple(bases), line

    def again(self) -> "Trouble":
        """Return the same, to be raised once more."""
        return Trouble(self.kind, self.message, self.name, self.bases, self.line)


def told_by(told: Any) -> Trouble:
    """Return the trouble that an answer tells of; what it says is the student's."""
    told = told if isinstance(told, dict) else {}
    kind, message, name, bases, line = (told.get(key) for key in ("kind", "message", "name", "bases", "line"))
    return Trouble(
        kind if kind in _KINDS else "error",
        plain(message)[:_LONGEST] if isinstance(message, str) and message else "it failed",
        plain(name)[:100] if isinstance(name, str) else "",
        [base for base in bases if isinstance(base, str)][:50] if isinstance(bases, list) else (),
        line if type(line) is int and 0 < line < 10**6 else None,
    )


def plain(text: str) -> str:
    """Return a text that a terminal takes as text, and that is the same another time: addresses are not."""
    text = _ADDRESS.sub(" at 0x...", text)
    return "".join(c if c.isprintable() or c in "\n\t" else "\N{REPLACEMENT CHARACTER}" for c in text)
