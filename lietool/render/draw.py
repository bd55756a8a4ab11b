"""From a picture's records to its pixels.

Opaque surfaces first, then everything else sorted from far to near, into a
half-float buffer in linear light with 3 x 3 samples a pixel; each pixel is
the mean of its samples, encoded as sRGB; labels last.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import moderngl
import numpy as np

from lietool.render import compose, context, labels, nearby, passes
from lietool.render.batches import Batch, Lens, batches, check_measures, extent
from lietool.render.camera import Box, Page, project
from lietool.render.scene import Picture, View
from lietool.render.theme import BOOK, Theme

SAMPLES, DRAFT_SAMPLES = 3, 2
# A buffer of this many pixels serves pictures of any size, part by part: fresh memory costs more than passes.
TILE = (1600, 450)
LARGEST = 20000
# In pixels, and unequal: an edge on a pixel's centre would be decided by rounding.
_SHIFT = (0.0371, 0.0193)


@dataclass(frozen=True, eq=False)
class Rendered:
    """A picture as pixels.

    Parameters
    ----------
    image : ndarray of uint8, shape (h, w, 3)
        sRGB, the upper row first.
    labels : tuple of PlacedLabel
        Every label with its box in pixels.
    """

    image: np.ndarray
    labels: tuple[compose.PlacedLabel, ...]


def render(
    picture: Picture,
    *,
    size: tuple[int, int] | None = None,
    draft: bool = False,
    backend: str | None = None,
    store: labels.Store | None = None,
    theme: Theme = BOOK,
) -> Rendered:
    """Render a picture.

    Parameters
    ----------
    picture : Picture
    size : tuple of int, optional
        Width and height in pixels; one pixel a page unit unless given. The page
        is scaled to fit and centred.
    draft : bool
        2 x 2 samples a pixel instead of 3 x 3.
    backend : str, optional
        Where OpenGL comes from, see `context.get`.
    store : Store, optional
        Where labels come from; the project's own goldens unless given.
    theme : Theme
        What the colours of `style` look like; as in the book unless given.

    Returns
    -------
    Rendered

    Raises
    ------
    NoRendererError
        If this machine has no OpenGL.
    MissingLabelError
        If the store is strict and lacks a label.
    ValueError
        If the size is not positive or too large, or a record holds what cannot be drawn.
    """
    width, height = size or picture.size
    sheet = _sheet(picture, (width, height), draft, backend, theme)
    image = np.empty((height, width, 3), np.uint8)
    prepared = [_prepare(view, sheet) for view in picture.views]
    for rows, columns, samples in _parts(sheet, prepared, theme.linear(picture.paper)):
        image[rows, columns] = _encoding()[samples[..., :3]]
    placed = compose.compose(image, picture, sheet.unit, sheet.corner, store or labels.Store(), theme)
    return Rendered(image, placed)


def layer(
    picture: Picture,
    view: View,
    *,
    size: tuple[int, int],
    draft: bool = False,
    backend: str | None = None,
    theme: Theme = BOOK,
) -> np.ndarray:
    """Render one view of a picture alone, on no ground and without its labels.

    Parameters
    ----------
    picture : Picture
        Whose page it is on.
    view : View
    size, draft, backend, theme
        As of `render`.

    Returns
    -------
    ndarray of float16, shape (h, w, 4)
        Linear light, premultiplied, and the opacity; the upper row first.

    Raises
    ------
    NoRendererError, ValueError
        As `render`.
    """
    sheet = _sheet(picture, size, draft, backend, theme)
    prepared = _prepare(view, sheet)
    image = np.zeros((size[1], size[0], 4), np.float16)
    for rows, columns, samples in _parts(sheet, [prepared], np.zeros(4), _reach(prepared, sheet)):
        image[rows, columns] = samples.view(np.float16)
    return image


@dataclass(frozen=True, eq=False)
class _Sheet:
    """The pixels that a page goes to: how many, how many of them to a page unit, where the page begins."""

    gl: moderngl.Context
    page: Box
    size: tuple[int, int]
    unit: float
    corner: tuple[float, float]
    per_side: int
    theme: Theme


def _sheet(picture: Picture, size: tuple[int, int], draft: bool, backend: str | None, theme: Theme) -> _Sheet:
    width, height = size
    if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
        raise ValueError(f"draw.render: size must be 1 to {LARGEST} pixels each way; got {width}x{height}")
    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    unit = min(width / page[2], height / page[3])
    corner = ((width - unit * page[2]) / 2.0, (height - unit * page[3]) / 2.0)
    gl = context.get(backend).gl
    return _Sheet(gl, page, size, unit, corner, DRAFT_SAMPLES if draft else SAMPLES, theme)


def _parts(
    sheet: _Sheet,
    views: Sequence["_Prepared"],
    ground: np.ndarray,
    region: tuple[int, int, int, int] | None = None,
) -> Iterator[tuple[slice, slice, np.ndarray]]:
    """Yield rows, columns and half floats (h, w, 4), by their bits, of each part of a sheet or its region."""
    height = sheet.size[1]
    for x, y, w, h in _tiles(*(region or (0, 0, *sheet.size))):
        target = passes.target(w, h, sheet.per_side)
        target.samples.use()
        target.samples.clear(*ground)
        to_tile = _page_to_tile(sheet.unit, (sheet.corner[0] - x, sheet.corner[1] - y), (w, h))
        for view in views:
            _draw_view(sheet, target.samples, view, to_tile, (w, h))
        yield (
            slice(height - y - h, height - y),
            slice(x, x + w),
            passes.resolve(sheet.gl, target, sheet.per_side),
        )


@dataclass(frozen=True, eq=False)
class _Prepared:
    view: View
    box: Box
    opaque: list[Batch]
    runs: list[Batch]


def _prepare(view: View, sheet: _Sheet) -> _Prepared:
    box = view.box or sheet.page
    if not (np.isfinite(box).all() and box[2] > 0.0 and box[3] > 0.0):
        raise ValueError(f"draw.render: View.box must be x, y and a width and height above 0; got {box}")
    flat = isinstance(view.camera, Page)
    for record in view.records:
        check_measures(record)
    view = nearby.view(view)
    lens = Lens(view.camera, box, sheet.unit, sheet.theme)
    found = [batch for record in view.records for batch in batches(record, lens)]
    opaque = [] if flat else [batch for batch in found if batch.opaque]
    rest = found if flat else [batch for batch in found if not batch.opaque]
    return _Prepared(view, box, opaque, list(_sorted_runs(rest, 0.0 if flat else view.camera.height)))


def _sorted_runs(rest: list[Batch], height: float) -> Iterator[Batch]:
    """Yield what can be drawn at once, far to near; on a page (height 0) in the order of the records."""
    if not rest:
        return
    # Images have a texture each, and cannot be drawn together.
    keys = [(b.kind, 0 if b.texels is None else id(b.texels)) for b in rest]
    kinds = list(dict.fromkeys(keys))
    groups = [[b for b, key in zip(rest, keys, strict=True) if key == kind] for kind in kinds]
    rows = [np.concatenate([b.data for b in group]) for group in groups]
    before = [0] * len(kinds)
    kind_of, row_of = [], []
    for batch, key in zip(rest, keys, strict=True):
        count, which = len(batch.data), kinds.index(key)
        kind_of.append(np.full(count, which))
        row_of.append(before[which] + np.arange(count))
        before[which] += count
    kind, row = np.concatenate(kind_of), np.concatenate(row_of)
    if height:
        # Rounded, so that a difference in the last bit does not change what overlaps what.
        depth = np.round(np.concatenate([b.depth for b in rest]) / (1e-4 * height))
        order = np.argsort(-depth, kind="stable")
        kind, row = kind[order], row[order]
    ends = np.flatnonzero(np.diff(kind, append=-1)) + 1
    for first, last in pairwise((0, *ends)):
        which = kind[first]
        data, depth = rows[which][row[first:last]], np.zeros(last - first)
        yield replace(groups[which][0], data=data, depth=depth)


def _reach(prepared: _Prepared, sheet: _Sheet) -> tuple[int, int, int, int]:
    """Left, lower edge, width and height in pixels of the part of the sheet that a view draws on."""
    low, high = np.array(sheet.size, float), np.zeros(2)
    for batch in [*prepared.opaque, *prepared.runs]:
        points, margin = extent(batch.kind, batch.data)
        seen = project(prepared.view.camera, prepared.box, points)[:, :2] * sheet.unit + sheet.corner
        # And what antialiasing and the shift of the samples may add.
        low = np.minimum(low, seen.min(axis=0) - margin - 2.0)
        high = np.maximum(high, seen.max(axis=0) + margin + 2.0)
    left, down = np.clip(np.floor(low), 0, sheet.size).astype(int).tolist()
    right, up = np.clip(np.ceil(high), 0, sheet.size).astype(int).tolist()
    return left, down, max(right - left, 0), max(up - down, 0)


def _tiles(left: int, low: int, width: int, height: int) -> Iterator[tuple[int, int, int, int]]:
    for y in range(0, height, TILE[1]):
        for x in range(0, width, TILE[0]):
            yield left + x, low + y, min(TILE[0], width - x), min(TILE[1], height - y)


def _page_to_tile(unit: float, corner: tuple[float, float], tile: tuple[int, int]) -> np.ndarray:
    """Return the 3 x 3 matrix from page units to the tile's clip coordinates."""
    scale = 2.0 * unit / np.asarray(tile, float)
    matrix = np.diag([*scale, 1.0])
    matrix[:2, 2] = 2.0 * np.asarray(corner) / np.asarray(tile) - 1.0
    return matrix


def _draw_view(
    sheet: _Sheet,
    samples: moderngl.Framebuffer,
    prepared: _Prepared,
    to_tile: np.ndarray,
    tile: tuple[int, int],
) -> None:
    gl, theme = sheet.gl, sheet.theme
    camera, box = prepared.view.camera, prepared.box
    viewport = (tile[0] * sheet.per_side, tile[1] * sheet.per_side)
    flat = isinstance(camera, Page)
    # The view's own clip square becomes its box on the page, and that its place in the tile.
    place = np.eye(4)
    center = to_tile @ [box[0] + box[2] / 2.0, box[1] + box[3] / 2.0, 1.0]
    place[:2, 3] = center[:2] + (0.0 if flat else 2.0 * np.asarray(_SHIFT) / tile)
    place[0, 0], place[1, 1] = to_tile[0, 0] * box[2] / 2.0, to_tile[1, 1] * box[3] / 2.0
    uniforms = {
        "view": camera.view(box).T.astype("f4").tobytes(),
        "projection": (place @ camera.projection(box)).T.astype("f4").tobytes(),
        "viewport": np.array(viewport, "f4").tobytes(),
        "per_side": np.array(sheet.per_side, "f4").tobytes(),
        "light": np.array([*theme.ambient, theme.key, theme.gloss], "f4").tobytes(),
        "glass": np.array(theme.glass, "f4").tobytes(),
    }
    if not flat:
        passes.clear_depth(samples)
    gl.enable_only(moderngl.DEPTH_TEST)
    gl.depth_func = "<="
    for batch in prepared.opaque:
        passes.draw(gl, batch, uniforms, flat)
    gl.enable_only(moderngl.BLEND if flat else moderngl.BLEND | moderngl.DEPTH_TEST)
    gl.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
    samples.depth_mask = False
    samples.use()
    for batch in prepared.runs:
        passes.draw(gl, batch, uniforms, flat)
    samples.depth_mask = True


@lru_cache(maxsize=1)
def _encoding() -> np.ndarray:
    """The sRGB byte of every half float: quicker than a power a pixel, and the same on every driver."""
    with np.errstate(invalid="ignore"):
        linear = np.clip(
            np.nan_to_num(np.arange(65536, dtype=np.uint16).view(np.float16).astype(float)), 0.0, 1.0
        )
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return np.rint(255.0 * srgb).astype(np.uint8)
