"""From a figure and its parameters to a file: a picture, or frames over the figure's time."""

import json
import math
import os
import sys
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import lietool
from lietool import atomic, paths
from lietool.figure import Drawing, Figure, Time, project

if TYPE_CHECKING:
    import numpy as np

ENDINGS = (".png", ".gif")


@dataclass(frozen=True)
class Quality:
    """How to render: size in pixels (None is the picture's own), draft or not, and with what."""

    size: tuple[int, int] | None = None
    draft: bool = False
    backend: str | None = None


def make(
    figure: Figure,
    params: Mapping[str, object],
    output: str | None,
    quality: Quality,
    *,
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
    numbers : bool
        Print the numbers shown, as JSON.
    swept : set of str
        Parameters that were given explicitly: an animation must not sweep them.
    """
    values = figure.check(params)
    target = (
        None if numbers and output is None else _target(f"{figure.name}.png" if output is None else output)
    )
    frames = None
    if target and target.suffix.lower() == ".gif":
        frames = _time(figure, swept)
    drawing = figure.draw(**values)
    if target:
        if frames:
            data = _animation(figure, values, frames, quality)
        else:
            data = _still(figure, values, drawing, quality)
        _write(target, data)
        click.echo(target, err=numbers)
    if numbers:
        from lietool.golden import numbers as numbers_

        click.echo(numbers_.dumps(drawing.numbers), nl=False)


def _target(output: str) -> Path:
    """The file to write, refused before any work is done where that is possible."""
    path = Path(output)
    try:
        # A pathlib path forgets the slash at the end, by which somebody means a folder.
        is_folder = path.is_dir() or output.endswith(("/", os.sep))
    except OSError as error:
        raise click.UsageError(f"--output {output}: {error.strerror}. Choose another name") from None
    if is_folder:
        raise click.UsageError(
            f"--output {output or repr('')} is a folder. Write a file name, ending in {' or '.join(ENDINGS)}"
        )
    if path.suffix.lower() not in ENDINGS:
        raise click.UsageError(f"--output must end in {' or '.join(ENDINGS)}; got {output!r}")
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


def _time(figure: Figure, swept: set[str]) -> Time:
    if figure.time is None:
        raise click.UsageError(f"{figure.name} has no time to animate. Write a .png")
    if figure.time.param in swept:
        option = "--" + figure.time.param.replace("_", "-")
        raise click.UsageError(
            f"a .gif sweeps {option}, so it cannot be given too. Leave out {option}, or write a .png"
        )
    return figure.time


def _still(figure: Figure, values: dict[str, Any], drawing: Drawing, quality: Quality) -> bytes:
    from lietool.render import export

    image = _render(drawing, quality)
    return export.png(image, provenance(figure, values))


def _animation(figure: Figure, values: dict[str, Any], time: Time, quality: Quality) -> bytes:
    from lietool.render import export

    places = sweep(time)
    images: dict[float, np.ndarray] = {}
    # Only somebody who watches wants to see progress.
    bar = click.progressbar(length=len(set(places)), label=figure.name, file=sys.stderr)
    with bar if sys.stderr.isatty() else nullcontext() as progress:
        for place in dict.fromkeys(places):
            images[place] = _render(figure.draw(**values | {time.param: place}), quality)
            if progress:
                progress.update(1)
    return export.gif([images[place] for place in places], time.seconds)


def sweep(time: Time) -> list[float]:
    """Return the values of a figure's time, frame by frame, so that the last leads on to the first.

    A closed one goes round at constant speed. Another goes forth and back, slows down at both ends,
    and takes the same values on both ways.

    Parameters
    ----------
    time : Time

    Returns
    -------
    list of float
        One for each frame.
    """
    count = time.frames
    if time.closed:
        parts = [k / count for k in range(count)]
    else:
        parts = [(1.0 - math.cos(2.0 * math.pi * min(k, count - k) / count)) / 2.0 for k in range(count)]
    return [time.start + (time.stop - time.start) * part for part in parts]


def _render(drawing: Drawing, quality: Quality) -> "np.ndarray":
    from lietool.render import draw, labels

    own = project()
    store = labels.Store((paths.GOLDEN / "labels", *((own / "golden" / "labels",) if own else ())))
    return draw.render(
        drawing.picture, size=quality.size, draft=quality.draft, backend=quality.backend, store=store
    ).image


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
        ``Software``, ``command``, ``parameters`` (JSON), ``renderer``; ``plate`` if they are those of one.
    """
    from lietool.render import context

    texts = {
        "Software": f"lietool {lietool.__version__}",
        "command": figure.name,
        "parameters": json.dumps(values, default=str, ensure_ascii=False),
        "renderer": str(context.get().info["renderer"]),
    }
    for plate_id in figure.plates:
        if figure.plate_params(plate_id) == values:
            return texts | {"plate": plate_id}
    return texts
