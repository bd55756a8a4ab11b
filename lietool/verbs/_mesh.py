"""The mesh that a figure shows, to a file or, over the figure's time, to a row of numbered files."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from lietool.figure import Drawing, Figure, Time
from lietool.verbs import _film

if TYPE_CHECKING:
    from lietool.verbs._picture import Quality

# Repeated here so that completion need not load numpy; a test compares them with `mesh`.
ENDINGS = (".obj", ".off", ".ply", ".stl", ".glb")
_NUMBER = re.compile(r"%(0[1-9])?d")
# What somebody means by it, who may have written something else.
_MEANT = re.compile(r"%[-+ #0-9]*[diu]")
# Of a row of files, which are all made before the first is written.
_MOST_BYTES = 1 << 30


def check(figure: Figure, values: Mapping[str, object], ending: str, quality: "Quality") -> None:
    """Refuse to write a mesh where the figure shows none, or where how to draw is asked for.

    Raises
    ------
    click.UsageError
        It names the choices with which the figure shows a mesh, if there are any.
    """
    if not figure.mesh:
        raise click.UsageError(f"{figure.name} shows no mesh, which a {ending} holds. Write a .png")
    if not figure.shows_mesh(values):
        name, *choices = figure.mesh
        option = "--" + name.replace("_", "-")
        raise click.UsageError(
            f"{figure.name} shows the mesh of one moment, which a {ending} holds, only with "
            f"{option} {' or '.join(choices)}. Write that, or a .png"
        )
    if given := quality.given:
        says, them = ("say", "them") if len(given) > 1 else ("says", "it")
        raise click.UsageError(
            f"{' and '.join(given)} {says} how to draw, and a {ending} is no picture. Leave {them} out"
        )


def numbered(path: Path) -> bool:
    """Return whether a file name asks for a row of files: ``frame-%03d.obj``.

    Raises
    ------
    click.UsageError
        If it asks for one in another way, or for one of pictures.
    """
    meant = _MEANT.findall(path.name)
    if not meant:
        return False
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise click.UsageError(
            f"--output {path.name} must be one file, for numbered ones hold meshes; got "
            f"{' and '.join(meant)} in the name of a {ending}. Leave it out, or write a .gif or .mp4"
        )
    if len(meant) > 1 or not _NUMBER.fullmatch(meant[0]):
        raise click.UsageError(
            f"--output {path.name} must have one number to count by; got {' and '.join(meant)}. "
            f"Write for example frame-%03d{ending}"
        )
    return True


def still(mesh: Any, ending: str) -> bytes:
    """Return the contents of a file with a mesh."""
    from lietool.mesh import surface_io

    return surface_io.encode(mesh, ending)


def moving(
    draw: Callable[..., Drawing], values: Mapping[str, Any], time: Time, path: Path
) -> dict[Path, bytes]:
    """Return the files of a row and their contents: each moment of a film once, up to its far end.

    Raises
    ------
    click.UsageError
        If they are too large together.
    """
    width = (_NUMBER.findall(path.name) or [""])[0] or "d"
    found = {}
    moments = list(dict.fromkeys(_film.sweep(time)))
    for number, t in enumerate(moments):
        file = path.with_name(_NUMBER.sub(f"{number:{width}}", path.name))
        found[file] = still(draw(**{**values, time.param: t}).mesh, path.suffix.lower())
        if (size := len(found[file]) * len(moments)) > _MOST_BYTES:
            raise click.UsageError(
                f"--output {path.name} must be files of at most {_MOST_BYTES >> 20} MiB together; got "
                f"{len(moments)} of {len(found[file]) / 2**20:.3g} MiB, {size >> 20}. Write fewer, by --fps"
            )
    return found
