"""From a picture's records to its pixels.

Opaque surfaces first, then everything else sorted from far to near, into a
half-float buffer in linear light with 3 x 3 samples a pixel; each pixel is
the mean of its samples, encoded as sRGB; labels last.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from itertools import pairwise

import moderngl
import numpy as np

from lietool.render import compose, context, labels
from lietool.render.batches import Batch, Lens, batches, check_measures
from lietool.render.camera import Box, Page
from lietool.render.scene import Picture, View
from lietool.render.theme import BOOK, Theme

SAMPLES, DRAFT_SAMPLES = 3, 2
# A buffer of this many pixels serves pictures of any size, part by part: fresh memory costs more than passes.
TILE = (1600, 450)
LARGEST = 20000
# In pixels, and unequal: an edge on a pixel's centre would be decided by rounding.
_SHIFT = (0.0371, 0.0193)

_LAYOUT = {
    "surface": ("3f 3f 4f 1f", ("in_position", "in_normal", "in_color", "in_material")),
    "lines": (
        "3f 3f 3f 3f 4f 4f 1f 1f/i",
        ("in_before", "in_a", "in_b", "in_after", "in_color_a", "in_color_b", "in_half_width", "in_lift"),
    ),
    "points": (
        "3f 4f 4f 1f 1f 1f/i",
        ("in_position", "in_color", "in_rim", "in_radius", "in_shaded", "in_lift"),
    ),
}


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
    if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
        raise ValueError(f"draw.render: size must be 1 to {LARGEST} pixels each way; got {width}x{height}")
    gl = context.get(backend).gl
    unit = min(width / picture.size[0], height / picture.size[1])
    corner = ((width - unit * picture.size[0]) / 2.0, (height - unit * picture.size[1]) / 2.0)
    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    views = [_prepare(view, page, unit, theme) for view in picture.views]
    per_side = DRAFT_SAMPLES if draft else SAMPLES
    image = np.empty((height, width, 3), np.uint8)
    for x, y, w, h in _tiles(width, height):
        target = _target(w, h, per_side)
        target.samples.use()
        target.samples.clear(*theme.linear(picture.paper))
        for view in views:
            to_tile = _page_to_tile(unit, (corner[0] - x, corner[1] - y), (w, h))
            _draw_view(gl, target.samples, view, to_tile, (w, h), per_side, theme)
        image[height - y - h : height - y, x : x + w] = _resolve(gl, target, per_side)
    placed = compose.compose(image, picture, unit, corner, store or labels.Store(), theme)
    return Rendered(image, placed)


@dataclass(frozen=True, eq=False)
class _Prepared:
    view: View
    box: Box
    opaque: list[Batch]
    runs: list[tuple[str, np.ndarray]]


def _prepare(view: View, page: Box, unit: float, theme: Theme) -> _Prepared:
    box = view.box or page
    if not (np.isfinite(box).all() and box[2] > 0.0 and box[3] > 0.0):
        raise ValueError(f"draw.render: View.box must be x, y and a width and height above 0; got {box}")
    flat = isinstance(view.camera, Page)
    lens = Lens(view.camera, box, unit, theme)
    for record in view.records:
        check_measures(record)
    found = [batch for record in view.records for batch in batches(record, lens)]
    opaque = [] if flat else [batch for batch in found if batch.opaque]
    rest = found if flat else [batch for batch in found if not batch.opaque]
    return _Prepared(view, box, opaque, list(_sorted_runs(rest, 0.0 if flat else view.camera.height)))


def _sorted_runs(rest: list[Batch], height: float) -> Iterator[tuple[str, np.ndarray]]:
    """Yield what can be drawn at once, far to near; on a page (height 0) in the order of the records."""
    kinds = list(dict.fromkeys(batch.kind for batch in rest))
    if not kinds:
        return
    rows = {kind: np.concatenate([b.data for b in rest if b.kind == kind]) for kind in kinds}
    before = dict.fromkeys(kinds, 0)
    kind_of, row_of = [], []
    for batch in rest:
        count = len(batch.data)
        kind_of.append(np.full(count, kinds.index(batch.kind)))
        row_of.append(before[batch.kind] + np.arange(count))
        before[batch.kind] += count
    kind, row = np.concatenate(kind_of), np.concatenate(row_of)
    if height:
        # Rounded, so that a difference in the last bit does not change what overlaps what.
        depth = np.round(np.concatenate([b.depth for b in rest]) / (1e-4 * height))
        order = np.argsort(-depth, kind="stable")
        kind, row = kind[order], row[order]
    ends = np.flatnonzero(np.diff(kind, append=-1)) + 1
    for first, last in pairwise((0, *ends)):
        name = kinds[kind[first]]
        yield name, rows[name][row[first:last]]


def _tiles(width: int, height: int) -> Iterator[tuple[int, int, int, int]]:
    for y in range(0, height, TILE[1]):
        for x in range(0, width, TILE[0]):
            yield x, y, min(TILE[0], width - x), min(TILE[1], height - y)


def _page_to_tile(unit: float, corner: tuple[float, float], tile: tuple[int, int]) -> np.ndarray:
    """Return the 3 x 3 matrix from page units to the tile's clip coordinates."""
    scale = 2.0 * unit / np.asarray(tile, float)
    matrix = np.diag([*scale, 1.0])
    matrix[:2, 2] = 2.0 * np.asarray(corner) / np.asarray(tile) - 1.0
    return matrix


@dataclass(frozen=True, eq=False)
class _Target:
    samples: moderngl.Framebuffer
    texture: moderngl.Texture
    pixels: moderngl.Framebuffer


@lru_cache(maxsize=2)
def _target(width: int, height: int, per_side: int) -> _Target:
    gl = context.get().gl
    fine = (width * per_side, height * per_side)
    texture = gl.texture(fine, 4, dtype="f2")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    samples = gl.framebuffer([texture], gl.depth_renderbuffer(fine))
    return _Target(samples, texture, gl.framebuffer([gl.renderbuffer((width, height), 4, dtype="f2")]))


@lru_cache(maxsize=8)
def program(name: str) -> moderngl.Program:
    """Return a shader program of ``shaders/``, compiled once a process."""
    folder = resources.files("lietool.render") / "shaders"
    read = [(folder / f"{name}.{kind}").read_text() for kind in ("vert", "frag")]
    return context.get().gl.program(vertex_shader=read[0], fragment_shader=read[1])


def _draw_view(
    gl: moderngl.Context,
    samples: moderngl.Framebuffer,
    prepared: _Prepared,
    to_tile: np.ndarray,
    tile: tuple[int, int],
    per_side: int,
    theme: Theme,
) -> None:
    camera, box = prepared.view.camera, prepared.box
    viewport = (tile[0] * per_side, tile[1] * per_side)
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
        "per_side": np.array(per_side, "f4").tobytes(),
        "light": np.array([*theme.ambient, theme.key, theme.gloss], "f4").tobytes(),
        "glass": np.array(theme.glass, "f4").tobytes(),
    }
    if not flat:
        _clear_depth(samples)
    gl.enable_only(moderngl.DEPTH_TEST)
    gl.depth_func = "<="
    for batch in prepared.opaque:
        _draw(gl, batch.kind, batch.data, uniforms, flat)
    gl.enable_only(moderngl.BLEND if flat else moderngl.BLEND | moderngl.DEPTH_TEST)
    gl.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
    samples.depth_mask = False
    samples.use()
    for kind, data in prepared.runs:
        _draw(gl, kind, data, uniforms, flat)
    samples.depth_mask = True


def _clear_depth(samples: moderngl.Framebuffer) -> None:
    """Begin a view: its depths cannot be compared with those of the views under it."""
    samples.color_mask = (False, False, False, False)
    samples.clear()
    samples.color_mask = (True, True, True, True)
    samples.use()


def _draw(gl: moderngl.Context, kind: str, data: np.ndarray, uniforms: dict[str, bytes], flat: bool) -> None:
    name = "surface" if kind.startswith("glass") else kind
    shader = program(name)
    for key, value in uniforms.items():
        if key in shader:
            shader[key].write(value)  # type: ignore[union-attr]
    if name == "surface":
        shader["side"] = {"glass far": -1.0, "glass near": 1.0}.get(kind, 0.0)
        shader["lens"] = not flat
    layout, attributes = _LAYOUT[name]
    buffer = gl.buffer(np.ascontiguousarray(data, "f4"))
    array = gl.vertex_array(shader, [(buffer, layout, *attributes)])
    if name == "surface":
        array.render(moderngl.TRIANGLES)
    else:
        array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(data))
    array.release()
    buffer.release()


def _resolve(gl: moderngl.Context, target: _Target, per_side: int) -> np.ndarray:
    target.pixels.use()
    gl.enable_only(moderngl.NOTHING)
    shader = program("resolve")
    shader["per_side"] = per_side
    target.texture.use(0)
    array = gl.vertex_array(shader, [])
    array.render(moderngl.TRIANGLES, vertices=3)
    array.release()
    width, height = target.pixels.size
    raw = np.frombuffer(target.pixels.read(components=4, dtype="f2"), np.uint16)
    return _encoding()[raw.reshape(height, width, 4)[::-1, :, :3]]


@lru_cache(maxsize=1)
def _encoding() -> np.ndarray:
    """The sRGB byte of every half float: quicker than a power a pixel, and the same on every driver."""
    with np.errstate(invalid="ignore"):
        linear = np.clip(
            np.nan_to_num(np.arange(65536, dtype=np.uint16).view(np.float16).astype(float)), 0.0, 1.0
        )
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return np.rint(255.0 * srgb).astype(np.uint8)
