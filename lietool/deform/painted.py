"""Weights that were painted: numbers of the vertices in a text file, or in a mesh file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lietool.lie import checks
from lietool.mesh import surface_io
from lietool.mesh.files import Place, read_text
from lietool.mesh.surface import CHANNELS, Mesh

Array = NDArray[np.float64]


def read(path: str | Path, count: int, names: Sequence[str] = ()) -> Array:
    """Return the weights of handles at the vertices of a mesh.

    - .txt, .csv: a line for each vertex with a number for each handle, separated by blanks or commas; what
      follows a # is left out.
    - .ply, .obj, .glb: the mesh with the weights painted on it.  Those called `names`, which may be red,
      green, blue and alpha; by default all numbers of vertices in the order of the file, and where there
      are none the colours red, green and blue.

    Parameters
    ----------
    path : str or Path
    count : int
        How many vertices the mesh to be deformed has.
    names : sequence of str, optional

    Returns
    -------
    weights : ndarray, shape (count, k)

    Raises
    ------
    ValueError
        If the file cannot be read, has more or fewer vertices, a number that is not finite, or no such name.
    """
    place = Place("painted.read", Path(path))
    ending = place.path.suffix.lower()
    if ending in (".txt", ".csv"):
        if names:
            place.fail("a mesh, .ply, .obj or .glb, to have names", ending, remedy="Leave the names out.")
        weights = _rows(place, read_text(place))
    elif ending in (".ply", ".obj", ".glb"):
        weights = _named(place, surface_io.read(path), names)
    else:
        place.fail("weights, .txt, .csv, .ply, .obj or .glb", ending or "no ending")
    if not np.max(np.abs(weights)) <= checks.LARGEST:
        i, k = checks.first(~(np.abs(weights) <= checks.LARGEST))
        got = f"{weights[i, k]:g} of handle {k} at vertex {i}"
        place.fail(f"weights of at most {checks.LARGEST:g} in size", got)
    if len(weights) != count:
        place.fail(f"weights of the {count} vertices of the mesh", f"{len(weights)} of them")
    return weights


def _rows(place: Place, text: str) -> Array:
    lines = [
        (number, words)
        for number, line in enumerate(text.splitlines(), 1)
        if (words := line.partition("#")[0].replace(",", " ").split())
    ]
    if not lines:
        place.fail("weights, a line of numbers for each vertex", "none")
    width = len(lines[0][1])
    try:
        values = np.array([words for _, words in lines], float)
    except ValueError:
        values = np.zeros((0, 0))
    if values.shape != (len(lines), width) or not np.isfinite(values).all():
        for number, words in lines:
            if len(words) != width or not all(_is_finite(word) for word in words):
                must = f"weights, {width} finite numbers in each line as in the first"
                place.fail(must, repr(" ".join(words)[:40]), number)
    return values


def _is_finite(word: str) -> bool:
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return False


def _named(place: Place, mesh: Mesh, names: Sequence[str]) -> Array:
    found = mesh.numbers
    chosen = list(names) or list(mesh.attributes) or [k for k in CHANNELS[:3] if k in found]
    if not chosen:
        place.fail("a mesh with numbers or colours of vertices", "none of them")
    for name in chosen:
        if name not in found:
            place.fail(f"a mesh with numbers {name} of vertices", ", ".join(found) or "none")
    weights = np.stack([found[name] for name in chosen], axis=1)
    if not np.isfinite(weights).all():
        i, k = checks.first(~np.isfinite(weights))
        place.fail("a mesh with finite weights", f"{weights[i, k]} as {chosen[k]} of vertex {i}")
    return weights
