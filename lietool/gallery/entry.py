"""What a page says of a plate, as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Chapter:
    """A heading with its plates below it; `label` stands before the name, as ``Chapter 2``."""

    key: str
    label: str
    name: str


@dataclass(frozen=True)
class Equation:
    """A numbered equation: ``(4.27)`` in the book, ``K (9)`` in a paper."""

    number: str
    says: str
    plain: str
    tex: str

    @property
    def shown(self) -> str:
        """The number as a reader meets it."""
        text, _, digits = self.number.partition(" ")
        shown = f"({digits})" if digits[:1].isdigit() or digits[1:2] == "." else digits
        return shown if text == "B" else f"{text} {shown}"

    @property
    def key(self) -> str:
        """The number as it is searched for: ``4.27``, ``k9``."""
        text, _, digits = self.number.partition(" ")
        return ("" if text == "B" else text.lower()) + digits.lower().replace(" ", "")


@dataclass(frozen=True)
class Command:
    """A line to copy, and what it makes."""

    makes: str
    line: str


@dataclass(frozen=True)
class Parameter:
    """A parameter of a plate: its option, its value here, what it may be, and what it is."""

    option: str
    value: str
    range: str
    help: str


@dataclass(frozen=True)
class Number:
    """A quantity that the picture shows: its shape in words and its values, or the first of them."""

    name: str
    shape: str
    values: str


@dataclass(frozen=True)
class Picture:
    """A picture's file and its size in pixels."""

    data: bytes
    width: int
    height: int


@dataclass(frozen=True)
class Entry:
    """A plate; `pictures` by theme, of which a page needs ``light``; `golden` is that of its folder."""

    id: str
    command: str
    chapter: Chapter
    title: str
    caption: str
    equations: tuple[Equation, ...]
    commands: tuple[Command, ...]
    parameters: tuple[Parameter, ...] = ()
    code: Path | None = None
    line: int = 0
    root: Path | None = None
    golden: str = ""
    numbers: tuple[Number, ...] = ()
    numbers_file: bytes = b""
    pictures: Mapping[str, Picture] = field(default_factory=dict)

    @property
    def alternative(self) -> str:
        """What is read where the picture cannot be seen."""
        title = self.title if self.title.endswith((".", "?", "!")) else f"{self.title}."
        return f"{title} {self.caption}"
