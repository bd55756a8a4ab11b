"""Files of vectors: what lies on a page as paths and text, what is seen through a camera as an image.

A reader zooms in, and a printer has more dots than a screen: so curves stay
curves.  Only light has to be computed dot by dot.  The files are the same, byte
by byte, whenever the same picture is written.
"""

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from lietool.render import compose, draw, labels, outline, overlay
from lietool.render.batches import Lens
from lietool.render.camera import Box, Page
from lietool.render.scene import Label, Picture, View
from lietool.render.theme import BOOK, Theme

POINTS = 72.0
"""In an inch."""

Kind = Literal["svg", "pdf"]
_SETTINGS = {
    "svg.hashsalt": "lietool",
    "svg.fonttype": "path",
    "svg.image_inline": True,
    "svg.id": None,
    # Fonts that printers take, and in which text can be searched.
    "pdf.fonttype": 42,
    "pdf.compression": 6,
    "pdf.use14corefonts": False,
    "pdf.inheritcolor": False,
    "path.simplify": False,
}
# The halo as strokes around the type: how far each reaches, in page units, and how opaque it is.
_HALO = ((3.4, 0.35), (1.7, 0.72))
# Pixels of the rasterised text before the first of its ink: an empty one, and what matplotlib adds.
_RIM = 1.25


@dataclass(frozen=True, eq=False)
class _Image:
    """Pixels uint8 (h, w, 4), and their lower left corner in pixels from that of the sheet."""

    pixels: np.ndarray
    corner: tuple[int, int]


@dataclass(frozen=True, eq=False)
class _Text:
    """A label with the left end of its base line, in page units."""

    label: Label
    at: np.ndarray


@dataclass(frozen=True, eq=False)
class _Contents:
    """All that is on a sheet, the first lowest, and what its coordinates mean."""

    inches: tuple[float, float]
    page: tuple[int, int]
    dots: tuple[int, int]
    theme: Theme
    paper: np.ndarray
    things: list[outline.Shape | _Image | _Text]

    @property
    def unit(self) -> float:
        """Points in a page unit."""
        return POINTS * min(self.inches[0] / self.page[0], self.inches[1] / self.page[1])

    @property
    def corner(self) -> np.ndarray:
        """Where the page begins, in points: it is in the middle of the sheet."""
        return (POINTS * np.array(self.inches) - self.unit * np.array(self.page)) / 2.0

    @property
    def dots_unit(self) -> float:
        """Pixels of an image in a page unit."""
        return min(self.dots[0] / self.page[0], self.dots[1] / self.page[1])

    @property
    def dots_corner(self) -> np.ndarray:
        """Where the page begins in an image, in pixels."""
        return (np.array(self.dots) - self.dots_unit * np.array(self.page)) / 2.0

    @property
    def dot(self) -> float:
        """Points in a pixel of an image."""
        return self.unit / self.dots_unit


def write(
    picture: Picture,
    kind: Kind,
    *,
    inches: tuple[float, float],
    dpi: float = 300.0,
    draft: bool = False,
    backend: str | None = None,
    store: labels.Store | None = None,
    theme: Theme = BOOK,
    about: Mapping[str, str] = MappingProxyType({}),
) -> bytes:
    """Return a picture as the bytes of an SVG or PDF file.

    Parameters
    ----------
    picture : Picture
    kind : {"svg", "pdf"}
    inches : tuple of float
        Width and height; the page is scaled to fit and centred.
    dpi : float
        Dots per inch of what is seen through a camera.
    draft, backend, store, theme
        As of `draw.render`; a renderer is needed only for what is seen through a camera or lit.
    about : mapping of str to str
        What the file says of itself: ``Title``, ``Software`` and anything else.

    Returns
    -------
    bytes

    Raises
    ------
    NoRendererError, MissingLabelError, ValueError
        As `draw.render`.
    """
    width, height = inches
    if kind not in ("svg", "pdf"):
        raise ValueError(f"vector.write: kind must be svg or pdf; got {kind!r}")
    if not (0.0 < width < np.inf and 0.0 < height < np.inf and 0.0 < dpi < np.inf):
        raise ValueError(
            f"vector.write: inches and dpi must be above 0 and finite; got {width} x {height} at {dpi}"
        )
    # Rounded upwards: no coarser than asked for.
    dots = int(np.ceil(width * dpi - 1e-6)), int(np.ceil(height * dpi - 1e-6))
    things = []

    def rendered(view: View) -> list[_Image]:
        samples = draw.layer(picture, view, size=dots, draft=draft, backend=backend, theme=theme)
        return _cut_out(samples, theme.linear(picture.paper)[:3])

    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    for view in picture.views:
        if not isinstance(view.camera, Page):
            things += rendered(view)
            continue
        lens = Lens(view.camera, view.box or page, 1.0, theme)
        for record in view.records:
            found = outline.shapes(record, lens)
            things += rendered(View((record,), view.camera, view.box)) if found is None else found
    things += _texts(picture, store or labels.Store())
    contents = _Contents(inches, picture.size, dots, theme, theme.linear(picture.paper)[:3], things)
    return _file(contents, kind, about)


def _cut_out(samples: np.ndarray, paper: np.ndarray) -> list[_Image]:
    """The part of an image that is not empty, for blending as encoded."""
    inked = samples[..., 3] > 0.0
    if not inked.any():
        return []
    rows, columns = (np.flatnonzero(inked.any(axis=axis)) for axis in (1, 0))
    part = samples[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return [_Image(overlay.pixels(part, paper), (int(columns[0]), len(samples) - 1 - int(rows[-1])))]


def _texts(picture: Picture, store: labels.Store) -> list[_Text]:
    """Every label where the picture of one pixel a page unit has it, but for the rounding to pixels."""
    texts = []
    for label, glyphs, point in compose.located(picture, 1.0, store):
        left, top = compose.anchored(label.anchor, glyphs)
        height = glyphs.coverage.shape[0]
        texts.append(_Text(label, point + np.array([left + _RIM, -top - height + glyphs.baseline])))
    return texts


def _file(contents: _Contents, kind: Kind, about: Mapping[str, str]) -> bytes:
    with labels.typesetting(_SETTINGS):
        from matplotlib.artist import Artist
        from matplotlib.backends.backend_pdf import FigureCanvasPdf
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure

        class Sheet(Artist):
            def draw(self, renderer: Any) -> None:
                _paint(renderer, contents)

        figure = Figure(figsize=contents.inches, dpi=POINTS / contents.dot, frameon=False)
        figure.add_artist(Sheet())
        file = io.BytesIO()
        if kind == "svg":
            FigureCanvasSVG(figure).print_svg(file, metadata=_svg_says(about))
        else:
            FigureCanvasPdf(figure).print_pdf(file, metadata=_pdf_says(about))
    return file.getvalue()


def _paint(renderer: Any, contents: _Contents) -> None:
    width, height = (POINTS * side for side in contents.inches)
    ground = np.array([(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)])
    paper = outline.Shape((ground / contents.unit,), np.append(contents.paper, 1.0), True)
    _shape(renderer, contents, paper, np.zeros(2))
    for thing in contents.things:
        match thing:
            case outline.Shape():
                _shape(renderer, contents, thing, contents.corner)
            case _Text():
                _text(renderer, contents, thing)
            case _Image():
                left, low = contents.corner + (np.array(thing.corner) - contents.dots_corner) * contents.dot
                # Matplotlib takes the lowest row first.
                renderer.draw_image(renderer.new_gc(), left, low, thing.pixels[::-1])


def _shape(renderer: Any, contents: _Contents, shape: outline.Shape, corner: np.ndarray) -> None:
    from matplotlib.path import Path
    from matplotlib.transforms import Affine2D

    if shape.disc:
        discs = [Path.circle(tuple(center), shape.disc) for center in shape.rings]
        path = Path.make_compound_path(*discs)
    else:
        path = Path.make_compound_path(*(_ring(ring, shape) for ring in shape.rings))
    color = tuple(overlay.colors(shape.color, contents.paper))
    gc = renderer.new_gc()
    gc.set_foreground(color, isRGBA=True)
    gc.set_linewidth(shape.width * contents.unit)
    gc.set_joinstyle("round")
    gc.set_capstyle("round" if shape.round_ends else "butt")
    if shape.dash:
        gc.set_dashes(0.0, [length * contents.unit for length in shape.dash])
    place = Affine2D().scale(contents.unit).translate(*corner)
    renderer.draw_path(gc, path, place, color if shape.filled else None)


def _ring(ring: np.ndarray, shape: outline.Shape) -> Any:
    from matplotlib.path import Path

    if shape.filled:
        return Path(np.concatenate([ring, ring[:1]]), closed=True)
    # A dash begins and ends where the line does, even if that is one place.
    closed = len(ring) > 3 and np.array_equal(ring[0], ring[-1]) and not shape.dash
    return Path(ring, closed=closed)


def _text(renderer: Any, contents: _Contents, text: _Text) -> None:
    from matplotlib.font_manager import FontProperties
    from matplotlib.path import Path
    from matplotlib.textpath import text_to_path
    from matplotlib.transforms import Affine2D

    label, theme = text.label, contents.theme
    font = FontProperties(size=label.size * contents.unit, family=labels.FONT)
    corners, codes = text_to_path.get_text_path(font, label.text, ismath=True)
    corners = np.reshape(corners, (-1, 2))
    if not len(corners):
        return
    scale = label.size / text_to_path.FONT_SCALE
    # Ink to the left of where the text begins moved the rasterised one to the right.
    at = text.at - np.array([min(scale * corners[:, 0].min(), 0.0), 0.0])
    left, base = contents.corner + contents.unit * at
    gc = renderer.new_gc()
    if label.halo:
        ink = Path(corners, codes)
        place = Affine2D().scale(scale * contents.unit).translate(left, base)
        gc.set_joinstyle("round")
        for reach, alpha in _HALO:
            gc.set_foreground((*overlay.encoded(contents.paper), alpha), isRGBA=True)
            gc.set_linewidth(2.0 * reach * contents.unit)
            renderer.draw_path(gc, ink, place, None)
    gc.set_foreground((*theme.srgb(label.color) / 255.0, 1.0), isRGBA=True)
    down = POINTS * contents.inches[1] - base
    height = down if renderer.flipy() else base - _raised(font, label.text)
    renderer.draw_text(gc, left, height, label.text, font, 0.0, True)


def _raised(font: Any, text: str) -> float:
    """By how much matplotlib sets a text too high in PDF, in points: it rounds heights up to whole ones."""
    from matplotlib.textpath import text_to_path

    rounded = text_to_path.mathtext_parser.parse(text, POINTS, font).glyphs
    exact = text_to_path.get_glyphs_mathtext(font, text)[0]
    if not rounded:
        return 0.0
    return rounded[0][-1] - exact[0][2] * font.get_size_in_points() / text_to_path.FONT_SCALE


def _svg_says(about: Mapping[str, str]) -> dict[str, Any]:
    said = {"Title": about.get("Title"), "Creator": about.get("Software"), "Description": _rest(about)}
    return {key: text for key, text in said.items() if text} | {"Date": None}


def _pdf_says(about: Mapping[str, str]) -> dict[str, Any]:
    said = {"Title": about.get("Title"), "Creator": about.get("Software"), "Subject": _rest(about)}
    return {key: text for key, text in said.items() if text} | {"CreationDate": None}


def _rest(about: Mapping[str, str]) -> str:
    rest = {key: text for key, text in about.items() if key not in ("Title", "Software")}
    return json.dumps(rest, ensure_ascii=False) if rest else ""
