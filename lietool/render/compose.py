"""Labels laid over the rendered pixels."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lietool.render import labels, placement
from lietool.render.camera import Box, project
from lietool.render.scene import Label, Picture
from lietool.render.theme import Theme

# In pixels, and unequal: symmetry puts anchors half-way between two pixels, where the last bit would decide.
_SHIFT = np.array([0.1371, 0.1193])
# The halo, in page units: how far it reaches at full strength, how far it fades, how strong it is.
_HALO_REACH, _HALO_FADE, _HALO_STRENGTH = 2.2, 2.4, 0.86


@dataclass(frozen=True)
class PlacedLabel:
    """Where a label came to lie.

    Parameters
    ----------
    text : str
    key : str
        Its name in the label store.
    box : tuple of int
        Left, top, right, lower edge in pixels, y down; the ink lies inside.
    """

    text: str
    key: str
    box: tuple[int, int, int, int]


def compose(
    image: np.ndarray,
    picture: Picture,
    unit: float,
    corner: tuple[float, float],
    store: labels.Store,
    theme: Theme,
) -> tuple[PlacedLabel, ...]:
    """Draw every label of a picture into its pixels, each on whole pixels.

    Parameters
    ----------
    image : ndarray of uint8, shape (h, w, 3)
        Changed in place.
    picture : Picture
    unit : float
        Pixels per page unit.
    corner : tuple of float
        Where the page's lower left corner lies, in pixels from the lower left of the image.
    store : Store
        Where the rasterised labels come from.
    theme : Theme

    Returns
    -------
    tuple of PlacedLabel

    Raises
    ------
    MissingLabelError
        If the store is strict and lacks a label.
    ValueError
        If a text is not mathtext, or a colour or an anchor is of no known form.
    """
    placed = []
    for record, glyphs, point in located(picture, unit, store):
        x, y = point * unit + corner + _SHIFT
        left, top = _rounded(record, glyphs, x, image.shape[0] - y)
        _lay(image, record, glyphs, (left, top), unit, theme, picture.paper)
        placed.append(PlacedLabel(record.text, glyphs.key, _ink_box(glyphs, left, top)))
    return tuple(placed)


def located(
    picture: Picture, unit: float, store: labels.Store
) -> list[tuple[Label, labels.Glyphs, np.ndarray]]:
    """Return every label of a picture with its rasterised text and the page point where its anchor goes."""
    found = _found(picture, unit, store)
    boxes = [(r, at, _text_box(r, at, glyphs, unit)) for r, glyphs, at in found]
    moves = placement.places(boxes, picture)
    return [(r, glyphs, at + r.offset + m) for (r, glyphs, at), m in zip(found, moves, strict=True)]


def wanted(picture: Picture, unit: float, store: labels.Store) -> list[tuple[Label, np.ndarray, np.ndarray]]:
    """Return every label of a picture with its point and the box of its text, in page units."""
    return [(r, at, _text_box(r, at, glyphs, unit)) for r, glyphs, at in _found(picture, unit, store)]


def _found(
    picture: Picture, unit: float, store: labels.Store
) -> list[tuple[Label, labels.Glyphs, np.ndarray]]:
    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    return [
        (
            record,
            store.get(record.text, record.size * unit),
            project(view.camera, view.box or page, record.position)[:2],
        )
        for view in picture.views
        for record in view.records
        if isinstance(record, Label)
    ]


def _text_box(record: Label, point: np.ndarray, glyphs: labels.Glyphs, unit: float) -> np.ndarray:
    """Left, lower, right, upper edge of the ink where a label is liked best, in page units."""
    x, y = point + record.offset
    # In pixels from the anchor, y down.
    left, top, right, low = _ink_box(glyphs, *_rounded(record, glyphs, 0.0, 0.0))
    return np.array([x + left / unit, y - low / unit, x + right / unit, y - top / unit])


def anchored(anchor: str, glyphs: labels.Glyphs) -> tuple[float, float]:
    """Return where the upper left corner of a text lies, seen from its anchor, in pixels, y down."""
    height, width = glyphs.coverage.shape
    right = {"l": 0.0, "c": width / 2.0, "r": float(width)}
    down = {"t": 0.0, "c": height / 2.0, "b": float(height), "n": float(height - glyphs.baseline)}
    if len(anchor) != 2 or anchor[0] not in right or anchor[1] not in down:
        raise ValueError(
            f"Label.anchor must be one of l c r and one of t c b n, such as 'cb'; got {anchor!r}"
        )
    return -right[anchor[0]], -down[anchor[1]]


def _rounded(record: Label, glyphs: labels.Glyphs, x: float, y: float) -> tuple[int, int]:
    left, top = anchored(record.anchor, glyphs)
    return round(x + left), round(y + top)


def _ink_box(glyphs: labels.Glyphs, left: int, top: int) -> tuple[int, int, int, int]:
    rows = np.flatnonzero(glyphs.coverage.any(axis=1))
    columns = np.flatnonzero(glyphs.coverage.any(axis=0))
    if not len(rows):
        return left, top, left, top
    return left + int(columns[0]), top + int(rows[0]), left + int(columns[-1]) + 1, top + int(rows[-1]) + 1


def _lay(
    image: np.ndarray,
    record: Label,
    glyphs: labels.Glyphs,
    at: tuple[int, int],
    unit: float,
    theme: Theme,
    paper: str,
) -> None:
    if record.halo:
        reach, fade = max(round(_HALO_REACH * unit), 1), max(round(_HALO_FADE * unit), 1)
        soft = _halo(glyphs.coverage.tobytes(), glyphs.coverage.shape, reach, fade)
        margin = (soft.shape[0] - glyphs.coverage.shape[0]) // 2
        _blend(image, theme.srgb(paper), soft * _HALO_STRENGTH, at[0] - margin, at[1] - margin)
    _blend(image, theme.srgb(record.color), glyphs.coverage / 255.0, *at)


def _blend(image: np.ndarray, color: np.ndarray, coverage: np.ndarray, left: int, top: int) -> None:
    height, width = image.shape[:2]
    y0, y1 = max(top, 0), min(top + coverage.shape[0], height)
    x0, x1 = max(left, 0), min(left + coverage.shape[1], width)
    if y0 >= y1 or x0 >= x1:
        return
    part = image[y0:y1, x0:x1]
    alpha = coverage[y0 - top : y1 - top, x0 - left : x1 - left, None]
    # Text is blended as encoded, not in linear light: dark type on white keeps its weight.
    part[...] = np.rint(part * (1.0 - alpha) + color * alpha).astype(np.uint8)


@lru_cache(maxsize=256)
def _halo(coverage: bytes, shape: tuple[int, int], reach: int, fade: int) -> np.ndarray:
    margin = reach + fade
    ink = np.pad(np.frombuffer(coverage, np.uint8).reshape(shape) / 255.0, margin)
    for axis in (0, 1):
        ink = np.max([np.roll(ink, s, axis) for s in range(-reach, reach + 1)], axis=0)
    for axis in (0, 1, 0, 1):
        ink = np.mean([np.roll(ink, s, axis) for s in range(-(fade // 2), fade // 2 + 1)], axis=0)
    return ink
