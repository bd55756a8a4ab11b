"""TeX as outlines for a page: matplotlib's mathtext, and around it matrices and lines, which it lacks.

The outlines take the colour of the text, scale with it, and need no font where they are read.
"""

import functools
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from lietool import cache

# Outlines are whole numbers in thousandths of the type size.
_EM = 1000
# Where the bar of a fraction and the middle of a matrix lie, as in Computer Modern.
_AXIS = 250
# Of matrices and of formulas with several lines, as TeX has them or nearly so.
_ROW_ABOVE, _ROW_BELOW, _ROW_GAP, _COLUMN_GAP = 720, 210, 260, 850
_BRACKET, _BRACKET_FOOT, _BRACKET_SPACE = 44, 190, 150
_LINE_GAP, _INDENT = 420, 1200
_MATRIX = re.compile(r"\\begin\{bmatrix\}(.*?)\\end\{bmatrix\}")
_BREAK = re.compile(r"\\\\")
_MOVE, _LINE, _CURVE3, _CURVE4, _CLOSE = 1, 2, 3, 4, 79


@dataclass(frozen=True)
class Box:
    """A part of a formula: how far it reaches from its origin on the base line, and its SVG elements."""

    width: int
    above: int
    below: int
    parts: tuple[str, ...] = ()

    def moved(self, x: int, y: int) -> str:
        """Return the elements, `x` to the right and `y` down."""
        body = "".join(self.parts)
        return f'<g transform="translate({x} {y})">{body}</g>' if x or y else body


@dataclass
class Outlines:
    """The glyphs of all formulas on a page, each once."""

    paths: dict[str, str] = field(default_factory=dict)
    _names: dict[Any, str] = field(default_factory=dict)

    def name(self, glyph: Any, outline: Any) -> str:
        """Return the name of a glyph, new if it has not been met yet."""
        if glyph not in self._names:
            self._names[glyph] = f"_g{len(self._names)}"
            self.paths[self._names[glyph]] = _path(*outline)
        return self._names[glyph]


def typeset(tex: str, outlines: Outlines) -> Box:
    r"""Set a formula.

    Parameters
    ----------
    tex : str
        Mathtext without the dollars; ``\begin{bmatrix} a & b \\ c & d \end{bmatrix}`` stands for a matrix,
        and ``\\`` outside of one begins a new line.
    outlines : Outlines
        Gains the glyphs that are new.

    Returns
    -------
    Box
        Its base line is that of the first line.

    Raises
    ------
    ValueError
        If it is not such a formula.
    """
    matrices: list[str] = []

    def keep(match: re.Match[str]) -> str:
        matrices.append(match[1])
        return f"\0{len(matrices) - 1}\0"

    lines = []
    for line in _BREAK.split(_MATRIX.sub(keep, tex)):
        pieces = line.strip().split("\0")
        # Between the marks stand the numbers of matrices.
        boxes = [
            _matrix(matrices[int(piece)], outlines) if i % 2 else _plain(piece, outlines)
            for i, piece in enumerate(pieces)
            if i % 2 or piece.strip()
        ]
        lines.append(_row(boxes))
    return _stack(lines)


def _row(boxes: Sequence[Box]) -> Box:
    if len(boxes) == 1:
        return boxes[0]
    parts, x = [], 0
    for box in boxes:
        parts.append(box.moved(x, 0))
        x += box.width
    return Box(x, max(box.above for box in boxes), max(box.below for box in boxes), tuple(parts))


def _stack(lines: Sequence[Box]) -> Box:
    parts, y, width = [lines[0].moved(0, 0)], lines[0].below, lines[0].width
    for line in lines[1:]:
        y += _LINE_GAP + line.above
        parts.append(line.moved(_INDENT, y))
        y += line.below
        width = max(width, _INDENT + line.width)
    return Box(width, lines[0].above, y, tuple(parts))


def _matrix(rows: str, outlines: Outlines) -> Box:
    cells = [[_plain(cell, outlines) for cell in row.split("&")] for row in _BREAK.split(rows)]
    columns = max(map(len, cells))
    if any(len(row) != columns for row in cells):
        raise ValueError(
            f"formula.typeset: rows of a matrix must be of equal length; got {rows.strip()!r}. Fill it"
        )
    widths = [max(row[j].width for row in cells) for j in range(columns)]
    above = [max(_ROW_ABOVE, *(cell.above for cell in row)) for row in cells]
    below = [max(_ROW_BELOW, *(cell.below for cell in row)) for row in cells]
    height = sum(above) + sum(below) + _ROW_GAP * (len(cells) - 1)
    top = -_AXIS - height // 2
    left = 2 * _BRACKET_SPACE + _BRACKET
    parts, y = [], top
    for row, up, down in zip(cells, above, below, strict=True):
        y += up
        x = left
        for cell, width in zip(row, widths, strict=True):
            parts.append(cell.moved(x + (width - cell.width) // 2, y))
            x += width + _COLUMN_GAP
        y += down + _ROW_GAP
    inner = sum(widths) + _COLUMN_GAP * (columns - 1)
    right = left + inner + _BRACKET_SPACE
    parts.append(_bracket(_BRACKET_SPACE, _BRACKET_FOOT, top, height))
    parts.append(_bracket(right + _BRACKET, -_BRACKET_FOOT, top, height))
    return Box(right + _BRACKET + _BRACKET_SPACE, -top, height + top, tuple(parts))


def _bracket(x: int, foot: int, top: int, height: int) -> str:
    """A square bracket whose back is at x; its feet go to the right, or with a negative foot to the left."""
    thick = _BRACKET if foot > 0 else -_BRACKET
    inner = foot - thick
    down = height - 2 * _BRACKET
    return f'<path d="M{x} {top}h{foot}v{_BRACKET}h{-inner}v{down}h{inner}v{_BRACKET}h{-foot}z"/>'


def _plain(tex: str, outlines: Outlines) -> Box:
    if not tex.strip():
        return Box(0, 0, 0)
    writer, font = _writer()
    text = f"${tex.strip()}$"
    try:
        width, height, depth = writer.get_text_width_height_descent(text, font, True)
        placed, shapes, bars = writer.get_glyphs_mathtext(font, text)
    except ValueError as error:
        reason = str(error).strip().splitlines()[-1]
        raise ValueError(
            f"formula.typeset: tex must be mathtext; got {tex.strip()!r} ({reason}). Correct it"
        ) from None
    unit = _EM / writer.FONT_SCALE
    parts = []
    for glyph, x, y, scale in placed:
        size = f" scale({scale:.4g})" if abs(scale - 1) > 1e-3 else ""
        place = f"translate({x * unit:.0f} {-y * unit:.0f}){size}"
        parts.append(f'<use href="#{outlines.name(glyph, shapes[glyph])}" transform="{place}"/>')
    for vertices, codes in bars:
        parts.append(f'<path d="{_path(vertices, codes)}"/>')
    return Box(round(width * unit), round((height - depth) * unit), round(depth * unit), tuple(parts))


@functools.cache
def _writer() -> tuple[Any, Any]:
    if kept := cache.folder("matplotlib"):
        # Else it complains on stderr where there is no home to write to.
        os.environ.setdefault("MPLCONFIGDIR", str(kept))
    import logging

    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    # The fonts of the labels in the pictures.
    size = text_to_path.FONT_SCALE
    return text_to_path, FontProperties(family="cmr10", math_fontfamily="cm", size=size)


def _path(vertices: Any, codes: Any) -> str:
    """Return an outline as the ``d`` of an SVG path, y down, each point relative to the one before."""
    unit = _EM / _writer()[0].FONT_SCALE
    points = [(round(float(x) * unit), -round(float(y) * unit)) for x, y in vertices]
    words: list[str] = []
    here = start = (0, 0)
    i = 0
    while i < len(points):
        code = int(codes[i])
        if code == _CLOSE:
            words.append("z")
            here = start
            i += 1
            continue
        letter, count = {_MOVE: ("m", 1), _LINE: ("l", 1), _CURVE3: ("q", 2), _CURVE4: ("c", 3)}[code]
        group = points[i : i + count]
        words.append(letter + " ".join(f"{x - here[0]} {y - here[1]}" for x, y in group))
        here = group[-1]
        if code == _MOVE:
            start = here
        i += count
    return "".join(words).replace(" -", "-")
