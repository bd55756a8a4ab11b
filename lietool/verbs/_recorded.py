"""What a picture remembers of its parameters: the same words in every folder and on every machine."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from lietool.figure import Figure


def parameters(figure: Figure, values: Mapping[str, Any]) -> str:
    """Return the parameters of a picture as it records them.

    Parameters
    ----------
    figure : Figure
        What it is drawn by.
    values : mapping
        All its parameters.

    Returns
    -------
    str
        JSON; a file that lies in the figure's project is named from there, so that a golden that was
        made in one folder is judged in another.
    """
    root = _root(figure)

    def named(value: object) -> str:
        if not isinstance(value, Path):
            return str(value)
        return (value.relative_to(root) if value.is_relative_to(root) else value).as_posix()

    return json.dumps(values, default=named, ensure_ascii=False)


def inputs(values: Mapping[str, Any]) -> str:
    """Return what the files that a picture is drawn from held.

    Parameters
    ----------
    values : mapping
        All its parameters.

    Returns
    -------
    str
        JSON: the SHA-256 of each file, by the parameter's name; of several the name has a number.
    """
    return json.dumps({name: _digest(path) for name, path in _files(values)})


def _root(figure: Figure) -> Path:
    """The folder that holds the folder of figures."""
    folder = figure.file.parent.parent if figure.chapter else figure.file.parent
    return folder.parent


def _files(values: Mapping[str, Any]) -> Iterator[tuple[str, Path]]:
    for name, value in values.items():
        if isinstance(value, Path):
            yield name, value
        elif isinstance(value, tuple) and value and all(isinstance(part, Path) for part in value):
            yield from ((f"{name}[{i}]", path) for i, path in enumerate(value))


def _digest(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        return f"cannot be read ({error.strerror})"
