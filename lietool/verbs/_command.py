"""The command of a figure: its parameters and plates as options, help and completion."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

import click
from click.shell_completion import CompletionItem

from lietool.figure import Figure, Parameter, nearest, plates, quoted
from lietool.verbs import _film, _mesh, _picture, _size

# Repeated here so that completion need not load OpenGL; a test compares them with `render`.
BACKENDS = ("osmesa", "egl", "gpu", "system")
# The name of all words without an option, which no parameter has.
_WORDS = "_words"
_PLACES = ("", "first", "second", "third")
_METAVARS = {"float": "NUMBER", "int": "N", "str": "TEXT", "path": "FILE", "paths": "FILE"}


def command(figure: Figure) -> click.Command:
    """Return the click command of a figure; its options are the figure's parameters and the common ones."""
    return _Command(figure)


class _Command(click.Command):
    """A command whose help has a section for its parameters and one for its plates."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure
        about, files = _texts(figure.help)
        super().__init__(
            figure.name,
            callback=self._run,
            params=[*_words(figure), *map(_option, figure.parameters), *_common(figure)],
            help=about,
            short_help=figure.summary,
            epilog=files,
        )

    def _run(
        self,
        *,
        output: str | None,
        plate: str | None,
        theme: str,
        size: _size.Size | None,
        dpi: float | None,
        draft: bool,
        json: bool,
        backend: str | None,
        seconds: float | None = None,
        fps: float | None = None,
        **given: object,
    ) -> None:
        words = cast(tuple[str, ...], given.pop(_WORDS, ()))
        # An option that is not given is None, for it has no default of its own.
        explicit = {name: value for name, value in given.items() if value is not None}
        explicit |= _placed(self.figure, words, explicit)
        params = (self.figure.plate_params(plate) if plate else {}) | explicit
        values = self.figure.check(params)
        for idle in self.figure.idle(values, explicit):
            raise click.UsageError(f"{idle.option} {idle.idle_because(values)}")
        quality = _picture.Quality(size, dpi, theme, draft, backend)
        pace = _film.Pace(seconds, fps)
        _picture.make(self.figure, params, output, quality, pace=pace, numbers=json, swept=set(explicit))

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        own = {parameter.name for parameter in self.figure.parameters}
        sections: dict[str, list[tuple[str, str]]] = {"Parameters": [], "Options": []}
        for option in self.get_params(ctx):
            if record := option.get_help_record(ctx):
                sections["Parameters" if option.name in own else "Options"].append(record)
        for title in ("Parameters", "Plates", "Options"):
            if rows := _described(self.figure) if title == "Plates" else sections[title]:
                with formatter.section(title):
                    formatter.write_dl(rows)


def _texts(text: str) -> tuple[str, str]:
    """What help begins with, and what it ends with: from the first `::` on, files line by line."""
    paragraphs = text.split("\n\n")
    first = next((k for k, paragraph in enumerate(paragraphs) if paragraph.endswith("::")), len(paragraphs))
    shown = [
        # What follows this mark is not wrapped.
        "\b\n" + paragraph if paragraph.startswith("    ") else re.sub("::$", ":", paragraph)
        for paragraph in paragraphs[first:]
    ]
    return "\n\n".join(paragraphs[:first]), "\n\n".join(shown)


def _words(figure: Figure) -> Iterator[click.Argument]:
    """The words that need no option, if the figure takes any: files."""
    if figure.positional:
        names = "".join(
            f" [{parameter.word}{'...' * (parameter.kind == 'paths')}" for parameter in figure.positional
        ).strip()
        yield click.Argument(
            [_WORDS], nargs=-1, type=_Word(), metavar=names + "]" * len(figure.positional), required=False
        )


def _placed(figure: Figure, words: tuple[str, ...], given: Mapping[str, object]) -> dict[str, object]:
    """The parameters that words without an option give."""
    places, found = figure.positional, dict[str, Any]()
    if len(words) > len(places) and places[-1].kind != "paths":
        most, more = " and ".join(parameter.word for parameter in places), words[len(places)]
        raise click.UsageError(f"only {most} can be given without an option; got {quoted(more)} too")
    for k, text in enumerate(words):
        parameter = places[min(k, len(places) - 1)]
        if parameter.name in given:
            raise click.UsageError(
                f"{parameter.word} is given twice: {quoted(text)}, and "
                f"{parameter.option} {parameter.text(given[parameter.name])}. Leave out one of them"
            )
        try:
            value = parameter.parse(text)
        except ValueError as error:
            hint = f". Write --plate {text}" if text in plates() else ""
            raise click.UsageError(f"{parameter.word} {error}{hint}") from None
        several = parameter.kind == "paths"
        found[parameter.name] = (*found.get(parameter.name, ()), *value) if several else value
    return found


def _described(figure: Figure) -> list[tuple[str, str]]:
    """Id and description of every plate."""
    rows = []
    for plate_id, plate in figure.plates.items():
        equations = f" ({', '.join(plate.equations)})" if plate.equations else ""
        rows.append((plate_id, plate.title + equations))
    return rows


class _Value(click.ParamType):
    """The text form of a figure's parameter."""

    name = "value"

    def __init__(self, parameter: Parameter) -> None:
        self.parameter = parameter

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        mine = self.parameter
        try:
            return mine.parse(value)
        except ValueError as error:
            hint = "." + nearest(value, mine.param.choices)
            if not mine.param.choices and mine.default not in (None, ()):
                hint = f". Write for example {mine.option} {mine.text(mine.default)}"
            raise click.UsageError(f"{mine.option} {error}{hint}", ctx) from None

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        if self.parameter.kind in ("path", "paths"):
            return [CompletionItem(incomplete, type="file")]
        return [CompletionItem(item) for item in self.parameter.param.choices if item.startswith(incomplete)]


class _Word(click.ParamType):
    """A file that needs no option; what it must be is asked when its place is known."""

    name = "file"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return [CompletionItem(incomplete, type="file")]


class _PlateId(click.ParamType):
    """A plate of one figure."""

    name = "id"

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        own = {plate_id.lower(): plate_id for plate_id in self.figure.plates}
        if value.lower() in own:
            return own[value.lower()]
        every = plates()
        if value in every:
            message = (
                f"plate {value} belongs to another command. Write lietool {every[value]} --plate {value}"
            )
        else:
            ids = ", ".join(self.figure.plates)
            message = f"--plate must be one of {ids}; got {value!r}.{nearest(value, every)}"
        raise click.UsageError(message, ctx)

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        rows = _described(self.figure)
        return [
            CompletionItem(plate_id, help=text) for plate_id, text in rows if plate_id.startswith(incomplete)
        ]


class _Read(click.ParamType):
    """An option that a function reads; where it cannot, its ValueError says "must be ...; got ..."."""

    name = "text"

    def __init__(self, read: Callable[[str], Any]) -> None:
        self.read = read

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        try:
            return self.read(value)
        except ValueError as error:
            option = param.opts[-1] if param else "a value"
            raise click.UsageError(f"{option} {error}", ctx) from None


def _up_to(most: float, unit: str, example: float) -> Callable[[str], float]:
    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not 0.0 < value <= most:
            raise ValueError(
                f"must be a number of {unit}, more than 0 and up to {most:g}; got {quoted(text)}. "
                f"Write for example {example:g}"
            )
        return value

    return read


SIZE, DPI, THEME = _Read(_size.parse), _Read(_size.dpi), click.Choice(_picture.THEMES)


def _option(parameter: Parameter) -> click.Option:
    param, default = parameter.param, parameter.default
    facts = [fact for fact in (parameter.where, parameter.range) if fact]
    several = parameter.kind == "paths"
    if several:
        facts.append("once for each")
    if param.positional:
        on = " and all that follow" if several else ""
        facts.append(f"or the {_PLACES[param.positional]} FILE without an option{on}")
    if parameter.kind == "bool":
        on, off = parameter.option, f"--no-{parameter.option[2:]}"
        about = f"{param.help} [{'; '.join([*facts, f'default {on if default else off}'])}]"
        return click.Option([f"{on}/{off}", parameter.name], default=None, help=about)
    if default not in (None, ()):
        facts.append(f"default {parameter.text(default)}")
    metavar = _METAVARS.get(parameter.kind) or parameter.components.upper()
    if param.choices:
        metavar = "|".join(param.choices)
    elif not metavar:
        metavar = ",".join("N" * parameter.length) or "N,N,..."
    about = param.help + (f" [{'; '.join(facts)}]" if facts else "")
    return click.Option(
        [parameter.option, parameter.name],
        type=_Value(parameter),
        metavar=metavar,
        help=about,
        multiple=several,
        callback=_joined if several else None,
    )


def _joined(ctx: click.Context, param: click.Parameter, value: tuple[tuple[Any, ...], ...]) -> Any:
    """All that an option was given with, one time or another; None where it was not given."""
    return tuple(item for items in value for item in items) or None


def _common(figure: Figure) -> Iterator[click.Option]:
    about = f"File to write; it ends in {_picture.listed(_picture.ENDINGS)}"
    if figure.mesh:
        about += f", or to hold the mesh shown, in {_picture.listed(_mesh.ENDINGS)}"
    if figure.mesh and figure.time:
        about += f"; frame-%03d.obj makes one for each moment of --{figure.time.param}"
    about += f". [default ./{figure.name}.png]"
    yield click.Option(["-o", "--output"], type=click.Path(), metavar="FILE", help=about)
    yield click.Option(
        ["--plate"], type=_PlateId(figure), metavar="ID", help="Start from this plate's parameters."
    )
    yield click.Option(
        ["--theme"],
        type=THEME,
        default="book",
        help="White paper, a dark slide, or print in grey. [default: book]",
    )
    yield click.Option(
        ["--size"],
        type=SIZE,
        metavar="SIZE",
        help="Pixels, 1600x1200, or a length in cm, mm, in or pt: a width, 8.5cm, or both, 8.5cmx6cm. "
        "[default: the picture's own; 12 cm wide as .svg or .pdf]",
    )
    yield click.Option(
        ["--dpi"],
        type=DPI,
        metavar="N",
        help="Dots per inch of a length, and of images in .svg and .pdf. [default 300]",
    )
    if figure.time:
        time = figure.time
        yield click.Option(
            ["--seconds"],
            type=_Read(_up_to(_film.LONGEST, "seconds", 4)),
            metavar="N",
            help=f"How long a film takes. [default {time.seconds:g}]",
        )
        yield click.Option(
            ["--fps"],
            type=_Read(_up_to(_film.FASTEST, "pictures a second", 30)),
            metavar="N",
            help=f"Its pictures a second. [default {_film.rate(time, '.mp4'):g}; "
            f".gif {_film.rate(time, '.gif'):g}]",
        )
    yield click.Option(["--draft"], is_flag=True, help="Faster, with coarser edges.")
    yield click.Option(
        ["--json"], is_flag=True, help="Print the numbers shown; without -o, no picture is made."
    )
    yield click.Option(["--backend"], type=click.Choice(BACKENDS), help="Where OpenGL comes from.")
