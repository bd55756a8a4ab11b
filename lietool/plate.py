"""What is written in a figure file and comes out of it: plates with their tolerances, time, drawings."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


class FigureError(ValueError):
    """A figure file that cannot be used; the message names the file and says what to do."""


@dataclass(frozen=True)
class Tolerance:
    """How far a picture and its numbers may be from their golden; other than the default needs `because`."""

    pixels: int = 8
    delta_e: float = 2.0
    lowpass: float = 1.5
    relative: float = 1e-9
    because: str = ""


@dataclass(frozen=True)
class Plate:
    """A named set of parameters of a figure: a picture of the book."""

    title: str
    equations: tuple[str, ...]
    caption: str
    params: Mapping[str, object] = field(default_factory=dict)
    tolerance: Tolerance = Tolerance()


@dataclass(frozen=True)
class Time:
    """What an animation sweeps: back and forth, round and round where `closed`, or once through `moments`."""

    param: str
    start: float
    stop: float
    frames: int = 48
    seconds: float = 4.0
    closed: bool = False
    moments: tuple[float, ...] = ()


@dataclass(frozen=True)
class Drawing:
    """What a figure returns: a `lietool.render.scene.Picture`, and the numbers that it shows.

    Where it shows a mesh that somebody may want to have, that too, as a `lietool.mesh.surface.Mesh`; and
    notes, a line each, of what is not as one would expect, which are told beside the file that is written.
    Where a film is to go through a sequence rather than forth and back, `moments` are its frames' times, and
    `fps` how many there are in a second.  Where its pictures are to share what each has for itself alone,
    such as a camera, `film` returns them from the values of the time.
    """

    picture: Any
    numbers: Mapping[str, object]
    mesh: Any = None
    notes: tuple[str, ...] = ()
    moments: tuple[float, ...] = ()
    fps: float = 24.0
    film: Callable[[Sequence[float]], Sequence[Any]] | None = None
