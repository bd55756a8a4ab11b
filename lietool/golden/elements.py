"""Which elements of a changed number are off: its vertex, its column, and by how much."""

from dataclasses import dataclass

import numpy as np

from lietool.golden.compare_numbers import SMALLEST_SCALE, Difference
from lietool.golden.numbers import Numbers, array_of, leaves

_MOST = 6
# What a list of places is called in the numbers of our plates; its rows are points.
_PLACES = ("vertices", "vertex", "points", "positions", "places", "curve", "cage", "source", "target")
_AXES = "xyz"


@dataclass(frozen=True)
class Element:
    """One number of an array that is not as expected; `by` is got minus expected, None where not floats."""

    index: tuple[int, ...]
    where: str
    expected: object
    got: object
    by: float | None = None


def worst(
    differences: tuple[Difference, ...], expected: Numbers, got: Numbers, most: int = _MOST
) -> dict[str, tuple[Element, ...]]:
    """Find the elements that are off most, of every entry of which a value has changed.

    Parameters
    ----------
    differences : tuple of Difference
        What comparing the numbers gave.
    expected, got : Mapping[str, object]
        The numbers that were compared.
    most : int
        How many elements of an entry.

    Returns
    -------
    dict of str to tuple of Element
        By entry, the worst first; entries that changed in kind or shape are left out.
    """
    before, after = dict(leaves(expected)), dict(leaves(got))
    return {
        found.entry: _worst(
            found, array_of(found.entry, before[found.entry]), array_of(found.entry, after[found.entry]), most
        )
        for found in differences
        if found.kind == "value"
    }


def nearest(expected: Numbers, got: Numbers, relative: float) -> tuple[str, float]:
    """Find the entry of floats that is nearest to what is allowed, or farthest beyond it.

    Parameters
    ----------
    expected, got : Mapping[str, object]
        Two sets of numbers.
    relative : float
        As `compare_numbers.numbers` takes it.

    Returns
    -------
    entry : str
        Its dotted name; empty where nothing is off.
    used : float
        The part of what is allowed that it is off.
    """
    after, found = dict(leaves(got)), ("", 0.0)
    for entry, value in leaves(expected):
        if entry not in after:
            continue
        a, b = array_of(entry, value), array_of(entry, after[entry])
        if a.dtype.kind != "f" or b.dtype.kind != "f" or a.shape != b.shape or not a.size:
            continue
        scale = max(float(np.abs(a[np.isfinite(a)]).max(initial=0.0)), SMALLEST_SCALE)
        used = float(np.abs(_off(a, b)).max()) / (relative * scale) if relative else 0.0
        if used > found[1]:
            found = entry, used
    return found


def place(entry: str, index: tuple[int, ...], shape: tuple[int, ...]) -> str:
    """Say which element an index is, in the words of a figure where they are plain.

    Parameters
    ----------
    entry : str
        The dotted name of the numbers.
    index : tuple of int
        Of the element.
    shape : tuple of int
        Of the array.

    Returns
    -------
    str
        Such as "vertex 12, y", or "[12, 1]" where the rows are no points.
    """
    if not index:
        return ""
    is_place = entry.rpartition(".")[2].startswith(_PLACES) and len(shape) > 1 and shape[-1] in (2, 3)
    if not is_place:
        return f"[{', '.join(map(str, index))}]"
    within = f"{index[:-2] or ''}".replace("(", "[").replace(",)", "]").replace(")", "]")
    return f"{within + ' ' if within else ''}vertex {index[-2]}, {_AXES[index[-1]]}"


def _worst(found: Difference, a: np.ndarray, b: np.ndarray, most: int) -> tuple[Element, ...]:
    if found.allowed is None:
        indices = np.argwhere(np.atleast_1d(a != b))[:most]
        off = None
    else:
        off = _off(a, b)
        wrong = np.flatnonzero(np.abs(off) > found.allowed)
        order = wrong[np.argsort(-np.abs(off).ravel()[wrong], kind="stable")][:most]
        indices = np.stack(np.unravel_index(order, off.shape), axis=-1) if a.ndim else np.zeros((1, 0), int)
    said = []
    for row in indices:
        index = tuple(int(i) for i in row)[: a.ndim]
        by = None if off is None else float(off[index])
        said.append(Element(index, place(found.entry, index, a.shape), a[index].item(), b[index].item(), by))
    return tuple(said)


def _off(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Got minus expected, infinite where one alone is not finite, zero where both are the same."""
    a, b = a.astype(np.float64), b.astype(np.float64)
    off = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.inf)
    np.subtract(b, a, out=off, where=np.isfinite(a) & np.isfinite(b))
    return off
