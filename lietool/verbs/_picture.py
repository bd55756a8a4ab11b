"""From a figure and its parameters to a file: a picture, or frames over the figure's time."""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import lietool
from lietool import atomic, paths
from lietool.figure import Drawing, Figure, Time, project
from lietool.verbs import _film, _mesh, _recorded, _size
from lietool.verbs._film import sweep as sweep

if TYPE_CHECKING:
    import numpy as np

    from lietool.render.labels import Store
    from lietool.render.scene import Picture
    from lietool.render.theme import Theme

VECTORS = (".svg", ".pdf")
ENDINGS = (".png", *VECTORS, *_film.ENDINGS)
# Repeated here so that completion need not load numpy; a test compares them with `render`.
THEMES = ("book", "dark", "print")


@dataclass(frozen=True)
class Quality:
    """How to render.

    Parameters
    ----------
    size : Size, optional
        The picture's own unless given.
    dpi : float, optional
        Dots per inch, where the size is a length or the file is one of vectors.
    theme : str
    draft : bool
        With fewer samples.
    backend : str, optional
        Where OpenGL comes from.
    """

    size: _size.Size | None = None
    dpi: float | None = None
    theme: str = "book"
    draft: bool = False
    backend: str | None = None

    def __post_init__(self) -> None:
        if self.size and self.dpi:
            object.__setattr__(self, "size", replace(self.size, dpi=self.dpi))

    @property
    def comparable(self) -> bool:
        """Whether a picture can be like its golden."""
        return self == Quality()

    @property
    def look(self) -> "Theme":
        """The theme itself."""
        from lietool.render import theme

        return theme.THEMES[self.theme]

    @property
    def given(self) -> list[str]:
        """The options that were given."""
        plain = Quality()
        names = ("size", "dpi", "theme", "draft", "backend")
        return [f"--{name}" for name in names if getattr(self, name) != getattr(plain, name)]

    @property
    def other(self) -> dict[str, str]:
        """What a picture should tell of itself where it was not drawn as goldens are."""
        said = {"theme": self.theme, "draft": "yes" if self.draft else ""}
        return {key: value for key, value in said.items() if value not in ("", "book")}

    @property
    def density(self) -> float | None:
        """Dots per inch of a picture of a given length; None where it has none."""
        return self.size.dpi if self.size and self.size.is_length else None

    def check(self, ending: str) -> None:
        """Refuse what contradicts itself, or makes no sense for files with an ending.

        Raises
        ------
        click.UsageError
            If dots per inch are given but no length, or pixels for a file of vectors.
        """
        if ending in VECTORS:
            if self.size and not self.size.is_length:
                raise click.UsageError(
                    f"--size {self.size.text} is in pixels, but a {ending} has none. "
                    "Write a length, for example --size 12cm"
                )
        elif self.dpi and not (self.size and self.size.is_length):
            raise click.UsageError(
                "--dpi says how many pixels a length has, and no length is given. "
                f"Write for example --size 8.5cm --dpi {self.dpi:g}"
            )


def make(
    figure: Figure,
    params: Mapping[str, object],
    output: str | None,
    quality: Quality,
    *,
    pace: _film.Pace = _film.ITS_OWN,
    numbers: bool,
    swept: set[str],
) -> None:
    """Draw a figure and write it, print its numbers, or both.

    Parameters
    ----------
    figure : Figure
    params : mapping
        What is not given has its default.
    output : str, optional
        The file; None is ``./<figure>.png``, or no file where `numbers` are printed.
    quality : Quality
    pace : Pace
        Of a film.
    numbers : bool
        Print the numbers shown, as JSON.
    swept : set of str
        Parameters that were given explicitly: a film must not sweep them.
    """
    values = figure.check(params)
    target = None
    if output is not None or not numbers:
        target = _target(f"{figure.name}.png" if output is None else output, figure)
    ending = target.suffix.lower() if target else ""
    solid, row = ending in _mesh.ENDINGS, target is not None and _mesh.numbered(target)
    moving = ending in _film.ENDINGS or row
    if solid:
        _mesh.check(figure, values, ending, quality)
    elif target:
        quality.check(ending)
    if pace != _film.ITS_OWN and not moving:
        raise click.UsageError(
            f"--seconds and --fps are for films. Write one of {listed(_film.ENDINGS)} with --output"
        )
    time = _film.paced(_film.time(figure, values, ending, swept), ending, pace) if moving else None
    notes: dict[str, None] = {}

    def draw(**values: object) -> Drawing:
        drawing = figure.draw(**values)
        notes.update(dict.fromkeys(drawing.notes))
        return drawing

    # A film draws frames of its own, but of which moments may be for the drawing to say.
    drawing = draw(**values) if numbers or not time or figure.mesh else None
    if time and drawing and drawing.moments:
        time = _film.followed(time, drawing.moments, drawing.fps, pace)
    written: dict[Path, bytes] = {}
    if target and time and row:
        written = _mesh.moving(draw, values, time, target)
    elif target and time:
        written[target] = _moving(figure, draw, values, time, ending, quality)
    elif target and drawing and solid:
        written[target] = _mesh.still(drawing.mesh, ending)
    elif target and drawing:
        written[target] = _still(figure, values, drawing, ending, quality)
    for path, data in written.items():
        _write(path, data)
        click.echo(path, err=numbers)
    for note in notes:
        click.echo(f"lietool {figure.name}: {note}", err=True)
    if numbers and drawing:
        from lietool.golden import numbers as numbers_

        click.echo(numbers_.dumps(drawing.numbers), nl=False)


def endings(figure: Figure) -> tuple[str, ...]:
    """Return the endings of all files that a figure can be written to."""
    return (*ENDINGS, *_mesh.ENDINGS) if figure.mesh else ENDINGS


def _target(output: str, figure: Figure) -> Path:
    """The file to write, refused before any work is done where that is possible."""
    path, known = Path(output), listed(endings(figure))
    try:
        # A pathlib path forgets the slash at the end, by which somebody means a folder.
        is_folder = path.is_dir() or output.endswith(("/", os.sep))
    except OSError as error:
        raise click.UsageError(f"--output {output}: {error.strerror}. Choose another name") from None
    if is_folder:
        raise click.UsageError(
            f"--output {output or repr('')} is a folder. Write a file name, ending in {known}"
        )
    if path.exists() and not path.is_file():
        raise click.UsageError(f"--output {output} is a device or a pipe. Write the name of a file")
    if path.suffix.lower() not in (*ENDINGS, *_mesh.ENDINGS):
        raise click.UsageError(f"--output must end in {known}; got {output!r}")
    if not path.parent.is_dir():
        raise click.UsageError(f"--output {output}: there is no folder {path.parent}. Make it first")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise click.UsageError(
            f"--output {output}: the folder {path.parent.resolve()} is not writable. Choose another"
        )
    return path


def _write(path: Path, data: bytes) -> None:
    try:
        atomic.write_bytes(path, data)
    except OSError as error:
        reason = error.strerror or error
        raise click.UsageError(f"cannot write {path}: {reason}. Choose another place with --output") from None


def listed(endings: tuple[str, ...]) -> str:
    """Write several endings as one says them: ``.gif, .apng or .mp4``."""
    return ", ".join(endings[:-1]) + " or " + endings[-1]


def _still(figure: Figure, values: dict[str, Any], drawing: Drawing, ending: str, quality: Quality) -> bytes:
    from lietool.render import export

    if ending not in VECTORS:
        image = _render(drawing.picture, quality)
        return export.png(image, provenance(figure, values) | quality.other, quality.density)
    from lietool.render import vector

    picture = drawing.picture
    return vector.write(
        picture,
        "svg" if ending == ".svg" else "pdf",
        inches=quality.size.inches(picture.size) if quality.size else _size.natural(picture.size),
        dpi=quality.dpi or _size.DPI,
        draft=quality.draft,
        backend=quality.backend,
        store=_store(),
        theme=quality.look,
        about=_about(figure, values),
    )


def _moving(
    figure: Figure,
    draw: Callable[..., Drawing],
    values: dict[str, Any],
    time: Time,
    ending: str,
    quality: Quality,
) -> bytes:
    even = ending == ".mp4"

    def pages(moments: list[float]) -> Sequence["Picture"]:
        first = draw(**values | {time.param: moments[0]})
        if first.film is not None:
            return first.film(moments)
        return [first.picture, *(draw(**values | {time.param: t}).picture for t in moments[1:])]

    def render(picture: "Picture") -> "np.ndarray":
        return _render(picture, quality, even)

    def settle(pictures: Sequence["Picture"]) -> list["Picture"]:
        from lietool.render import film

        return film.settled(pictures, _store(), closed=time.closed)

    return _film.encode(time, ending, pages, settle, render, figure.name, _about(figure, values))


def _render(picture: "Picture", quality: Quality, even: bool = False) -> "np.ndarray":
    from lietool.render import draw

    width, height = quality.size.pixels(picture.size) if quality.size else picture.size
    if even:
        # The page is centred, so that nobody sees a pixel more.
        width, height = width + width % 2, height + height % 2
    return draw.render(
        picture,
        size=(width, height),
        draft=quality.draft,
        backend=quality.backend,
        store=_store(),
        theme=quality.look,
    ).image


def _store() -> "Store":
    from lietool.render import labels

    own = project()
    return labels.Store((paths.GOLDEN / "labels", *((own / "golden" / "labels",) if own else ())))


def provenance(figure: Figure, values: Mapping[str, Any]) -> dict[str, str]:
    """Return where a picture comes from, as the texts of its PNG.

    Parameters
    ----------
    figure : Figure
    values : mapping
        All its parameters.

    Returns
    -------
    dict of str
        ``Title``, ``Software``, ``command``, ``parameters`` (JSON), ``renderer``; ``plate`` if they are those
        of one.
    """
    from lietool.render import context

    return _about(figure, values) | {"renderer": str(context.get().info["renderer"])}


def _about(figure: Figure, values: Mapping[str, Any]) -> dict[str, str]:
    texts = {
        "Title": figure.summary.rstrip("."),
        "Software": f"lietool {lietool.__version__}",
        "command": figure.name,
        "parameters": _recorded.parameters(figure, values),
    }
    for plate_id, plate in figure.plates.items():
        if figure.plate_params(plate_id) == values:
            return texts | {"Title": plate.title, "plate": plate_id}
    return texts
