"""What a figure file declares: its plates, its time, and by its signature its parameters.

Everything is checked when the file is loaded, so that a mistake is found before a picture is drawn.
"""

import inspect
import math
import re
import sys
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lietool import parameter as _parameter
from lietool.function import Library
from lietool.parameter import Parameter, nearest
from lietool.plate import Drawing, FigureError, Plate, Time, Tolerance

# The options that every figure command has; no parameter may be called so.
RESERVED = ("output", "plate", "theme", "size", "dpi", "seconds", "fps", "draft", "json", "backend", "help")

# What `Figure.mesh` is where every drawing has one.
EVERY = ("",)

# Of an animation: one that is longer would never end, or has frames longer than a GIF can say.
_MOST_FRAMES, _LONGEST = 1000, 600.0
# Of files without an option: nobody remembers the order of more.
_MOST_WORDS = 3


@dataclass(frozen=True)
class Figure:
    """A figure, read from its file."""

    name: str
    function: Callable[..., Drawing]
    parameters: tuple[Parameter, ...]
    plates: Mapping[str, Plate]
    time: Time | None
    file: Path
    chapter: str
    summary: str
    help: str
    mesh: tuple[str, ...] = ()
    functions: Mapping[str, Library] = field(default_factory=dict)

    def draw(self, **params: object) -> Drawing:
        """Draw the figure; parameters that are not given have their defaults.

        Raises
        ------
        ValueError
            If a parameter is unknown, of another type, not finite or out of range.
        FigureError
            If the function returns anything but a `Drawing`, or one with a mesh that is not declared, or
            without one that is.
        """
        return self.draw_with({}, **params)

    def draw_with(self, functions: Mapping[str, Callable[..., Any]], /, **params: object) -> Drawing:
        """Draw the figure with functions of one's own in place of those of the library that it shows.

        Parameters
        ----------
        functions : mapping from str to callable
            By the names of the keyword-only arguments of the figure's function; `functions` of this
            figure has what they stand for.  Those that are not given are the library's.
        **params : object
            As for `draw`.

        Raises
        ------
        ValueError
            As `draw`, or if the figure does not take a function of that name.
        FigureError
            As `draw`.
        """
        for name in functions:
            if name not in self.functions:
                hint = nearest(name, self.functions)
                raise ValueError(f"{self.name}.draw_with: it takes no function {name!r}.{hint}")
        values = self.check(params)
        drawing = self.function(**values, **functions)
        if not isinstance(drawing, Drawing):
            raise FigureError(f"{self.file}: {self.name} must return a Drawing; got {type(drawing).__name__}")
        if (drawing.mesh is not None) != self.shows_mesh(values):
            got = "none" if drawing.mesh is None else "one"
            raise FigureError(
                f"{self.file}: {self.name} must return a Drawing with a mesh just where @figure(mesh=...) "
                f"says so; got {got}. Correct one of them"
            )
        return drawing

    def shows_mesh(self, values: Mapping[str, object]) -> bool:
        """Return whether a drawing of all these parameters has a mesh."""
        return bool(self.mesh) and (self.mesh == EVERY or values[self.mesh[0]] in self.mesh[1:])

    def check(self, params: Mapping[str, object]) -> dict[str, Any]:
        """Return all parameters: those given, in their own types, and the defaults of the others.

        Raises
        ------
        ValueError
            If one is unknown or not as the signature says.
        """
        values = {parameter.name: parameter.default for parameter in self.parameters}
        known = {parameter.name: parameter for parameter in self.parameters}
        for name, value in params.items():
            if name not in known:
                raise ValueError(f"{self.name}.draw: no parameter {name!r}.{nearest(name, known)}")
            try:
                values[name] = known[name].check(value)
            except ValueError as error:
                raise ValueError(
                    f"{self.name}.draw: {name} {error}. Write for example {name}={values[name]!r}"
                ) from None
        return values

    def idle(self, values: Mapping[str, object], given: Iterable[str]) -> list[Parameter]:
        """Return those of the given parameters that have no part in the picture of these values."""
        named = set(given)
        return [p for p in self.parameters if p.name in named and p.idle(values)]

    @property
    def positional(self) -> tuple[Parameter, ...]:
        """The parameters that need no option on the command line, in their order there."""
        found = [p for p in self.parameters if p.param.positional]
        return tuple(sorted(found, key=lambda p: p.param.positional))

    def plate_params(self, plate_id: str) -> dict[str, Any]:
        """Return the parameters of a plate: the defaults, and over them its own.

        Raises
        ------
        ValueError
            If the figure has no such plate.
        """
        if plate_id not in self.plates:
            hint = nearest(plate_id, self.plates)
            raise ValueError(f"{self.name}.plate_params: no plate {plate_id!r}.{hint}")
        return self.check(self.plates[plate_id].params)


def figure(
    *, plates: Mapping[str, Plate], time: Time | None = None, mesh: bool | tuple[str, ...] = False
) -> Callable[[Callable[..., Drawing]], Figure]:
    """Make a figure of the function below: its signature lists the parameters, its docstring is the help.

    `mesh` says that its drawings have one; or with which choices of a parameter: ``("view", "whole")``.

    Raises
    ------
    FigureError
        If anything that a figure needs is missing or contradicts the rest.
    """

    def decorate(function: Callable[..., Drawing]) -> Figure:
        file = Path(function.__code__.co_filename)
        try:
            meshes = mesh if isinstance(mesh, tuple) else EVERY if mesh else ()
            return _checked(function, dict(plates), time, file, meshes)
        except ValueError as error:
            raise FigureError(f"{file}: {error}") from None

    return decorate


def _checked(
    function: Callable[..., Drawing],
    plates: dict[str, Plate],
    time: Time | None,
    file: Path,
    mesh: tuple[str, ...],
) -> Figure:
    if function.__name__ != file.stem:
        raise ValueError(
            f"the function {function.__name__} and its file have different names. Rename one of them"
        )
    help_text = inspect.getdoc(function) or ""
    summary = help_text.partition("\n")[0].strip()
    if not summary:
        if sys.flags.optimize > 1:
            raise ValueError(
                "Python leaves out docstrings, which figures need. Start it without -OO and PYTHONOPTIMIZE=2"
            )
        raise ValueError(
            f"{function.__name__} has no docstring. Its first line is shown by lietool --help; write one"
        )
    chapter = "" if file.parent.name == "figures" else file.parent.name
    name = function.__name__.replace("_", "-")
    read = _parameter.together(_read_signature(function))
    taken = _read_functions(function)
    checked = Figure(name, function, read, plates, time, file, chapter, summary, help_text, mesh, taken)
    _check_only(checked)
    _check_positional(checked)
    _check_plates(checked)
    if time:
        _check_time(time, read)
    return checked


def _read_functions(function: Callable[..., Drawing]) -> dict[str, Library]:
    arguments = inspect.signature(function).parameters.items()
    return {name: x.default for name, x in arguments if isinstance(x.default, Library)}


def _read_signature(function: Callable[..., Drawing]) -> Iterable[Parameter]:
    hints = typing.get_type_hints(function, include_extras=True)
    for name, argument in inspect.signature(function).parameters.items():
        if isinstance(argument.default, Library):
            if argument.kind is not inspect.Parameter.KEYWORD_ONLY:
                raise ValueError(f"function {name} must be keyword-only. Write it after the *")
            continue
        if name in RESERVED:
            raise ValueError(f"parameter {name} has the name of an option that every figure has. Rename it")
        if argument.default is inspect.Parameter.empty:
            raise ValueError(f"parameter {name} has no default. Bare lietool {function.__name__} needs one")
        try:
            yield _parameter.read(name, hints.get(name), argument.default)
        except ValueError as error:
            raise ValueError(f"parameter {name} {error}") from None


def _check_only(figure: Figure) -> None:
    choices = {parameter.name: parameter.param.choices for parameter in figure.parameters}
    said = {f"parameter {p.name}: only must be another": p.param.only for p in figure.parameters}
    said |= {f"parameter {p.name}: also must be another": p.param.also for p in figure.parameters}
    if figure.mesh != EVERY:
        said["mesh must be True, or a"] = figure.mesh
    for what, only in said.items():
        if only and (len(only) < 2 or not set(only[1:]) <= set(choices.get(only[0], ()))):
            raise ValueError(f"{what} parameter and some of its choices; got {only}. Correct it")


def _check_positional(figure: Figure) -> None:
    places = [parameter.param.positional for parameter in figure.positional]
    if places != list(range(1, len(places) + 1)) or len(places) > _MOST_WORDS:
        names = ", ".join(parameter.name for parameter in figure.positional)
        must = f"positional must count {names} from 1 to {_MOST_WORDS} at most"
        raise ValueError(f"{must}; got {places}. Correct it")
    for parameter in figure.positional[:-1]:
        if parameter.kind == "paths":
            raise ValueError(f"parameter {parameter.name} takes all files that follow. Make it the last")


def _check_plates(figure: Figure) -> None:
    if not figure.plates:
        raise ValueError(
            'no plates. Write @figure(plates={"ID": Plate(title=..., equations=(), caption=...)})'
        )
    first = next(iter(figure.plates))
    if len({str(plate_id).lower() for plate_id in figure.plates}) < len(figure.plates):
        raise ValueError(
            "two plates have ids that differ only in case, which the command line does not tell apart. "
            "Rename one"
        )
    for plate_id, plate in figure.plates.items():
        if not isinstance(plate_id, str) or not isinstance(plate, Plate):
            raise ValueError(
                f"plates must map texts to Plate(...); got {plate_id!r}: {type(plate).__name__}. Correct it"
            )
        # The id is a file name and a word on the command line.
        if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9.-]*", plate_id):
            raise ValueError(f"plate {plate_id!r} must be named by letters, digits, '.' and '-'. Rename it")
        if not plate.title.strip() or not plate.caption.strip():
            raise ValueError(f"plate {plate_id} has no title or no caption. Write both")
        if isinstance(plate.equations, str):
            raise ValueError(f'plate {plate_id}: equations must be a tuple. Write ("{plate.equations}",)')
        if plate_id == first and plate.params:
            raise ValueError(
                f"plate {plate_id} is the first, which stands for the defaults, but has params. "
                "Make them the defaults of the function"
            )
        tolerance = plate.tolerance
        limits = (tolerance.pixels, tolerance.delta_e, tolerance.lowpass, tolerance.relative)
        # With a limit that is NaN every picture would pass.
        if not all(math.isfinite(limit) and limit >= 0 for limit in limits):
            raise ValueError(
                f"plate {plate_id}: the limits of a tolerance must be finite and at least 0; got {limits}. "
                "Correct them"
            )
        if tolerance != Tolerance(because=tolerance.because) and not tolerance.because.strip():
            raise ValueError(
                f"plate {plate_id} has a tolerance of its own. Say why: Tolerance(..., because='...')"
            )
        try:
            figure.plate_params(plate_id)
        except ValueError as error:
            raise ValueError(f"plate {plate_id}: {error}") from None


def _check_time(time: Time, parameters: Sequence[Parameter]) -> None:
    known = {parameter.name: parameter for parameter in parameters if parameter.kind == "float"}
    if time.param not in known:
        raise ValueError(
            f"time is {time.param!r}, which must be a float parameter. Name one of {', '.join(known)}"
        )
    for end in (time.start, time.stop):
        try:
            known[time.param].check(end)
        except ValueError as error:
            raise ValueError(
                f"time goes outside of its parameter: {time.param} {error}. Shorten it"
            ) from None
    if not 2 <= time.frames <= _MOST_FRAMES or not 0 < time.seconds <= _LONGEST:
        raise ValueError(
            f"time must have 2 to {_MOST_FRAMES} frames and take up to {_LONGEST:g} seconds, more than 0;"
            f" got {time.frames} and {time.seconds:g}. Correct it"
        )
