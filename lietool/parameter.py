"""One parameter of a figure: its type, unit, range and text form, read from the figure's signature."""

import difflib
import math
import os
import re
import types
import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from numbers import Integral, Real
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

_NUMBER_WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
# A message is one line: of a longer value only the beginning is shown.
_LONGEST = 60
_KINDS = {float: "float", int: "int", str: "str", bool: "bool", Path: "path"}


@dataclass(frozen=True)
class Param:
    """What a signature says about a parameter beside its type; it stands inside `Annotated`.

    Components of a vector that `help` names, as in ``"start (w, x, y, z)"``, are named in messages too.
    `only` names another parameter and those of its choices with which this one has a part in the picture:
    ``only=("view", "rings")``, and `also` one more of the kind; `unless` names those beside which it has
    none when they are given: one's own files, ``unless=("mesh",)``; `needs` one without which it has none.
    A file may also be given without its option: ``positional=1`` is the first word on the command line that
    belongs to no option; files, which are the last, take all that follow.
    """

    help: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    unless: tuple[str, ...] = ()
    needs: str = ""
    positional: int = 0


@dataclass(frozen=True)
class Parameter:
    """A parameter as the command line needs it.

    `kind` is ``"float"``, ``"int"``, ``"str"``, ``"bool"``, ``"path"``, ``"paths"`` or ``"vector"``;
    `length` is that of a vector, and 0 where any will do.  The text of paths is that of one of them.
    """

    name: str
    kind: str
    length: int
    default: Any
    param: Param

    @property
    def option(self) -> str:
        """The long option: ``--q0``."""
        return _option(self.name)

    @property
    def range(self) -> str:
        """The range and unit in words: ``"0 to 360 deg"``, or nothing."""
        low, high = self.param.low, self.param.high
        words = ""
        if low is not None and high is not None:
            words = f"{low:g} to {high:g}"
        elif low is not None:
            words = f"at least {low:g}"
        elif high is not None:
            words = f"at most {high:g}"
        return f"{words} {self.param.unit}".strip()

    @property
    def where(self) -> str:
        """When it has a part, in words: ``"with --view rings"``, ``"without --mesh"``, or nothing."""
        words = []
        for name, *choices in filter(None, (self.param.only, self.param.also)):
            words.append(f"with {_option(name)} {' or '.join(choices)}")
        if self.param.needs:
            words.append(f"with {_option(self.param.needs)}")
        if self.param.unless:
            words.append(f"without {' and '.join(map(_option, self.param.unless))}")
        return ", ".join(words)

    @property
    def word(self) -> str:
        """What stands for it on the command line where it needs no option: ``"SOURCE"``."""
        return self.name.upper().replace("_", "-")

    def idle(self, values: Mapping[str, object]) -> bool:
        """Return whether it has no part in the picture, given all parameters."""
        return bool(self.idle_because(values))

    def idle_because(self, values: Mapping[str, object]) -> str:
        """Return why it has no part in the picture and what to do, given all parameters; or nothing."""
        param = self.param
        for name in param.unless:
            # What is not given is None, or empty.
            if values[name]:
                return f"has no part in the picture beside {_option(name)}. Leave out one of them"
        musts = [f"beside {_option(param.needs)}"] if param.needs and not values[param.needs] else []
        for name, *choices in filter(None, (param.only, param.also)):
            musts += [] if values[name] in choices else [f"with {_option(name)} {' or '.join(choices)}"]
        if musts:
            return f"has a part in the picture only {musts[0]}. Leave it out, or write that"
        return ""

    @property
    def components(self) -> str:
        """The names of a vector's components, ``"w,x,y,z"``, where its help gives them."""
        for group in re.findall(r"\((\w+(?:, ?\w+)+)\)", self.param.help):
            names = re.split(", ?", group)
            if len(names) == self.length:
                return ",".join(names)
        return ""

    @property
    def wanted(self) -> str:
        """What a value must be, in words: ``"a finite number, 0 to 360 deg"``."""
        if self.param.choices:
            return "one of " + ", ".join(self.param.choices)
        count = _NUMBER_WORDS[self.length] if 0 < self.length < len(_NUMBER_WORDS) else str(self.length)
        noun = {
            "float": "a finite number",
            "int": "a whole number",
            "str": "a text",
            "bool": "true or false",
            "path": "a file that exists",
            "paths": "files that exist",
            "vector": f"{count} finite numbers" if self.length else "finite numbers with commas between them",
        }[self.kind]
        return (noun + f" {self.components}").strip() + (f", {self.range}" if self.range else "")

    def text(self, value: Any) -> str:
        """Write a value as one types it: ``"1,0,0,0"``."""
        if self.kind == "vector":
            return ",".join(f"{number:.15g}" for number in value)
        if self.kind == "paths":
            return ", ".join(map(str, value))
        return f"{value:.15g}" if self.kind == "float" else str(value)

    def parse(self, text: str) -> Any:
        """Read a value from its text form.

        Raises
        ------
        ValueError
            If the text is not such a value: ``"must be ...; got ..."``.
        """
        try:
            match self.kind:
                case "float":
                    value: Any = float(text)
                case "int":
                    value = int(text)
                case "vector":
                    value = tuple(float(part) for part in text.split(","))
                case "bool":
                    value = {"true": True, "false": False}[text.lower()]
                case "paths":
                    value = (text,)
                case _:
                    value = text
            return self.check(value)
        except (ValueError, KeyError):
            raise ValueError(f"must be {self.wanted}; got {quoted(text)}") from None

    def check(self, value: Any) -> Any:
        """Return the value in the parameter's own type.

        Raises
        ------
        ValueError
            If it is of another type, not finite or out of range: ``"must be ...; got ..."``.
        """
        checked = self._converted(value)
        if checked is None and not (value is None and self.default is None):
            raise ValueError(f"must be {self.wanted}; got {value!r}")
        return checked

    def _converted(self, value: Any) -> Any:
        """The value in its type, or None if it is not one."""
        match self.kind:
            case "float" if self._is_number(value):
                return float(value)
            case "int" if isinstance(value, Integral) and self._is_number(value):
                return int(value)
            case "vector" if isinstance(value, Iterable) and not isinstance(value, str):
                numbers = tuple(value)
                if all(map(self._is_number, numbers)) and len(numbers) == (self.length or len(numbers)):
                    return tuple(map(float, numbers)) or None
            case "str" if isinstance(value, str) and (value in self.param.choices or not self.param.choices):
                return value
            case "bool" if isinstance(value, bool):
                return value
            case "path" if _is_file(value):
                return Path(value)
            case "paths" if isinstance(value, Iterable) and not isinstance(value, str):
                files = tuple(value)
                return tuple(map(Path, files)) if all(map(_is_file, files)) else None
        return None

    def _is_number(self, value: Any) -> bool:
        low = -math.inf if self.param.low is None else self.param.low
        high = math.inf if self.param.high is None else self.param.high
        if isinstance(value, bool) or not isinstance(value, Real):
            return False
        try:
            number = float(value)
        except OverflowError:
            return False
        return math.isfinite(number) and low <= number <= high


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _is_file(value: Any) -> typing.TypeGuard[str | os.PathLike]:
    # Unlike pathlib's, it says of a name that is too long, too, that there is no such file.
    return isinstance(value, str | os.PathLike) and os.path.isfile(value)  # noqa: PTH113


def read(name: str, annotation: Any, default: Any) -> Parameter:
    """Make the parameter that a signature declares.

    Parameters
    ----------
    name : str
        Its name in the signature.
    annotation : type
        ``Annotated[type, Param(...)]``.
    default : object
        Its default.

    Returns
    -------
    Parameter
        The parameter, its default in its own type.

    Raises
    ------
    ValueError
        If anything is missing or contradicts the rest; the message says what to write instead.
    """
    params = [item for item in get_args(annotation)[1:] if isinstance(item, Param)]
    if get_origin(annotation) is not Annotated or len(params) != 1:
        raise ValueError(
            'must be annotated. Write for example Annotated[float, Param("swept angle", "deg", 0, 360)]'
        )
    (param,) = params
    kind, length, choices = _kind(get_args(annotation)[0])
    if choices:
        param = replace(param, choices=choices)
    parameter = Parameter(name, kind, length, default, param)
    _refuse_contradictions(parameter)
    if default is None and kind == "path":
        return parameter
    try:
        return replace(parameter, default=parameter.check(default))
    except ValueError as error:
        raise ValueError(f"has a default that {error}. Correct the default or the range") from None


def together(read: Iterable[Parameter]) -> tuple[Parameter, ...]:
    """Return the parameters of a signature; ValueError where one names others that will not do."""
    parameters = tuple(read)
    # What is not given must be seen to be so.
    empty = {parameter.name for parameter in parameters if parameter.default in (None, (), "")}
    for parameter in parameters:
        files = {*parameter.param.unless, parameter.param.needs} - {""}
        if not files <= empty - {parameter.name}:
            must = f"must be other parameters without a default; got {', '.join(sorted(files))}. Correct it"
            raise ValueError(f"parameter {parameter.name}: unless and needs {must}")
    return parameters


def _kind(base: Any) -> tuple[str, int, tuple[str, ...]]:
    """Kind, length and choices of a type."""
    arguments = get_args(base)
    if base in _KINDS:
        return _KINDS[base], 0, ()
    if get_origin(base) is tuple and arguments == (Path, ...):
        return "paths", 0, ()
    if get_origin(base) is Literal and all(isinstance(choice, str) for choice in arguments):
        return "str", 0, arguments
    if get_origin(base) is tuple and arguments and all(item in (float, ...) for item in arguments):
        return "vector", 0 if ... in arguments else len(arguments), ()
    if get_origin(base) in (types.UnionType, typing.Union) and set(arguments) == {Path, type(None)}:
        return "path", 0, ()
    raise ValueError(
        f"has the type {base}. Use float, int, str, bool, Path, Literal of texts or a tuple of floats or "
        "paths"
    )


def _refuse_contradictions(parameter: Parameter) -> None:
    param, numeric = parameter.param, parameter.kind in ("float", "int", "vector")
    if not param.help.strip():
        raise ValueError("has no help. Say in a few words what it is: Param('swept angle', ...)")
    if param.unit == "rad":
        raise ValueError(
            "is in radians. Angles of a figure are in degrees: write 'deg', and convert in the figure"
        )
    if not numeric and (param.unit or param.low is not None or param.high is not None):
        raise ValueError("has a unit or a range but is no number. Leave them out")
    if param.positional and parameter.kind not in ("path", "paths"):
        raise ValueError("is positional but no file. Leave that out: what is no file is given by its option")
    if param.choices and parameter.kind != "str":
        raise ValueError("has choices but is no text. Leave them out")
    if param.low is not None and param.high is not None and param.low > param.high:
        raise ValueError(f"has an empty range, {param.low:g} to {param.high:g}. Exchange its ends")


def quoted(text: str) -> str:
    """Return a text as a message shows it: in quotes, and only the beginning of a long one."""
    return repr(text if len(text) <= _LONGEST else f"{text[:_LONGEST]}...")


def nearest(name: str, known: Iterable[str]) -> str:
    """Return ``" Nearest: a, b."`` for a name that is not known, or nothing where none is near."""
    lowered = {item.lower(): item for item in known}
    # In a short name one letter is a large part.
    near = difflib.get_close_matches(name.lower(), lowered, 3, 0.6 if len(name) > 3 else 0.5)
    return f" Nearest: {', '.join(lowered[item] for item in near)}." if near else ""
