"""An image pasted into another: what is pasted where, the edit, and what it is measured by."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lietool.deform import image
from lietool.render import raster

from . import _dusk

Array = np.ndarray
Mask = np.ndarray

# Of our own target; and how high our own source is, of the target.
_HEIGHT, _PART = 405, 0.70


@dataclass(frozen=True, eq=False)
class Paste:
    """A source (h, w, 3) with its mask (h, w), and the source laid where it goes, beyond it the target.

    `laid` and `inside` are of the target's size.
    """

    source: Array
    mask: Mask
    target: Array
    laid: Array
    inside: Mask


@dataclass(frozen=True, eq=False)
class Edit:
    """The edit of a paste: the guidance field, the result, and the plain copy."""

    paste: Paste
    field: image.Field
    result: image.Result
    copy: Array

    def energy(self, shown: Array) -> float:
        """The integral of (7.10) of an image, in squares of levels."""
        return image.Result(self.result.prepared, self.field, shown).energy

    def step(self, shown: Array) -> float:
        """The mean step between neighbours of which one is inside and one is not, in levels."""
        total, count = 0.0, 0
        inside = self.paste.inside
        for axis, part in enumerate(image.gradient(shown)):
            across = np.diff(inside.astype(int), axis=1 - axis) != 0
            total += float(np.abs(part[across]).sum())
            count += 3 * int(across.sum())
        return total / count if count else 0.0


def paste(source: Path | None, target: Path | None, mask: Path | None, across: float, down: float) -> Paste:
    """Return what is pasted where: ours, unless there are files; the middle of the mask goes to a place."""
    ground = _dusk.evening(_HEIGHT) if target is None else raster.read(target).levels
    if source is None:
        if mask is not None:
            raise ValueError("mask must be given with a source; got only a mask. Name the source too")
        own = max(round(_PART * min(len(ground), 0.75 * ground.shape[1])), 24)
        levels, chosen = _dusk.balloon(own)
    else:
        read = raster.read(source)
        levels, chosen = read.levels, _chosen(read, mask)
    # The field between a pixel and its neighbour needs both.
    chosen = chosen.copy()
    chosen[[0, -1]] = chosen[:, [0, -1]] = False
    if not chosen.any():
        where = mask or source
        raise ValueError(f"mask must have pixels that are not at the source's edge; got none in {where}")
    rows, columns = (np.flatnonzero(chosen.any(axis=axis)) for axis in (1, 0))
    shift = [
        round(part * size - 0.5 * (place[0] + place[-1] + 1))
        for part, size, place in zip((down, across), ground.shape[:2], (rows, columns), strict=True)
    ]
    return _laid(levels, chosen, ground, shift[0], shift[1])


def _chosen(read: raster.Raster, mask: Path | None) -> Mask:
    if mask is None:
        if read.opacity is not None:
            return read.opacity >= 0.5
        return np.ones(read.levels.shape[:2], bool)
    painted = raster.read(mask)
    if painted.levels.shape != read.levels.shape:
        sizes = [f"{x.levels.shape[1]}x{x.levels.shape[0]}" for x in (read, painted)]
        raise ValueError(f"mask must be of the source's size, {sizes[0]}; got {sizes[1]}. Crop one of them")
    # White on black; or painted on nothing.
    if painted.opacity is not None and painted.opacity.min() < 0.5:
        return painted.opacity >= 0.5
    return painted.levels.mean(axis=2) >= 127.5


def _laid(levels: Array, chosen: Mask, ground: Array, row: int, column: int) -> Paste:
    """Lay the source with its upper left corner at a pixel of the target, cut off where that ends."""
    laid, inside = ground.copy(), np.zeros(ground.shape[:2], bool)
    height, width = ground.shape[:2]
    top, left = max(row, 0), max(column, 0)
    low, right = min(row + levels.shape[0], height), min(column + levels.shape[1], width)
    part = slice(top - row, low - row), slice(left - column, right - column)
    laid[top:low, left:right] = levels[part]
    inside[top:low, left:right] = chosen[part]
    if not inside.any() or inside.all():
        got = "every pixel" if inside.any() else "none"
        raise ValueError(f"mask must cover some pixels of the target and not all; got {got}. Move it")
    return Paste(levels, chosen, ground, laid, inside)


def _pairs(inside: Mask, axis: int) -> Mask:
    """Of which neighbours along an axis one at least is inside."""
    one, other = (np.take(inside, range(k, inside.shape[axis] - 1 + k), axis) for k in (0, 1))
    return one | other


def edit(given: Paste, mixed: bool, solve: Callable[..., image.Result] = image.solve) -> Edit:
    """Return the edit: inside the gradient is to be the source's, or the stronger of both."""
    inner, outer = image.gradient(given.laid), image.gradient(given.target)
    if mixed:
        inner = image.stronger(inner, outer)
    x, y = (
        np.where(_pairs(given.inside, axis)[..., None], one, other)
        for axis, one, other in zip((1, 0), inner, outer, strict=True)
    )
    field = x, y
    result = solve(image.prepare(given.inside), given.target, field)
    copy = np.where(given.inside[..., None], given.laid, given.target)
    return Edit(given, field, result, copy)
