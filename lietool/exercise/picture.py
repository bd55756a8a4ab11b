"""The plate of an exercise, drawn with a student's function in place of the library's."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from lietool import figure as figures
from lietool.exercise.outcome import Shown
from lietool.exercise.record import ExerciseError, NoGoldenError
from lietool.golden import compare, store
from lietool.golden.place import Place


def golden(plate: str) -> store.Golden:
    """Return the accepted picture of a plate.

    Parameters
    ----------
    plate : str
        Its id.

    Raises
    ------
    ExerciseError
        If there is no such plate.
    NoGoldenError
        If it has no golden that can be read.
    """
    try:
        return store.read(_place(plate))
    except figures.FigureError as error:
        raise ExerciseError(f"plate {plate}: {error}") from None
    except store.GoldenError as error:
        raise _no_golden(plate, str(error)) from None


def file(plate: str) -> Path:
    """Return the file with the accepted picture of a plate; raises as `golden` does."""
    try:
        path = _place(plate).png
    except figures.FigureError as error:
        raise ExerciseError(f"plate {plate}: {error}") from None
    if not path.is_file():
        raise _no_golden(plate, f"there is no golden at {path}")
    return path


def _no_golden(plate: str, why: str) -> NoGoldenError:
    return NoGoldenError(f'plate {plate}: {why}. Make it: `lietool figures accept {plate} --reason "..."`')


def drawn(plate: str, functions: Mapping[str, Callable[..., Any]]) -> np.ndarray:
    """Draw and render a plate with functions in place of those of the library that it shows.

    Parameters
    ----------
    plate : str
        Its id.
    functions : mapping from str to callable
        As for `Figure.draw_with`.

    Returns
    -------
    ndarray of uint8, shape (h, w, 3)
        The picture.

    Raises
    ------
    ExerciseError
        If the figure takes no function of such a name.
    NoRendererError
        If nothing on this machine can render.
    Exception
        What the figure raises where it cannot show what the functions return.
    """
    from lietool.render import draw, labels

    figure = figures.load(_command(plate))
    for name in functions:
        if name not in figure.functions:
            known = ", ".join(figure.functions) or "none"
            raise ExerciseError(
                f"plate {plate}: {figure.name} takes no function {name!r}; it takes {known}. "
                "Correct the picture of the exercise"
            )
    drawing = figure.draw_with(functions, **figure.plate_params(plate))
    rendered = draw.render(drawing.picture, store=labels.Store((_place(plate).labels,)))
    return rendered.image


def compared(plate: str, image: np.ndarray) -> tuple[bool, Shown]:
    """Compare a picture with the golden of a plate, by the plate's own rule.

    Parameters
    ----------
    plate : str
        Its id.
    image : ndarray of uint8, shape (h, w, 3)
        The picture.

    Returns
    -------
    passes : bool
        Whether they count as the same.
    shown : Shown
        Both.
    """
    wanted = golden(plate).image
    own = figures.declare(_command(plate)).plates[plate].tolerance
    found = compare.images(wanted, image, pixels=own.pixels, delta_e=own.delta_e, lowpass=own.lowpass)
    if not found.same_size:
        (w, h), (x, y) = found.actual_size, found.expected_size
        says = f"it is {w}x{h} pixels, the plate {x}x{y}"
    elif found.passes:
        says = "it is the plate"
    else:
        says = f"{found.over} pixels are visibly others than in the plate"
        says = says if found.over else "it is visibly paler or darker than the plate"
    return found.passes, Shown(plate, image, wanted, says)


def _command(plate: str) -> str:
    try:
        return figures.plates()[plate]
    except KeyError:
        hint = figures.nearest(plate, figures.plates())
        raise ExerciseError(f"no plate {plate!r}.{hint} Correct the picture of the exercise") from None


def _place(plate: str) -> Place:
    declared = figures.declare(_command(plate))
    return Place.beside(declared.file, declared.chapter, plate)
