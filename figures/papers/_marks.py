"""Flat marks that are told apart by their shapes, and the row that explains them."""

from collections.abc import Callable, Sequence

import numpy as np

from lietool.render import scene, style
from lietool.render.solids import fan_faces

RADIUS = 8.0

Mark = Callable[[float, float], list[scene.Record]]
"""What draws a mark at a place of the page."""
Entry = tuple[Mark, float, str, float]
"""A mark, half its width, what it means, and how wide those words are."""


def label(text: str, x: float, y: float, anchor: str, color: str = style.INK) -> scene.Label:
    """Return words of a table or a plot; without a halo, since nothing runs under them."""
    return scene.Label(text, (x, y, 0.0), color, style.SMALL_TEXT, anchor=anchor, halo=False)


def line(x0: float, y0: float, x1: float, y1: float, color: str, width: float) -> scene.Lines:
    """Return a straight line on the page."""
    return scene.Lines([(x0, y0, 0.0), (x1, y1, 0.0)], color, width)


def disc(color: str, radius: float = RADIUS) -> Mark:
    """Return a filled disc."""
    return lambda x, y: [scene.Points([(x, y, 0.0)], color, radius, shaded=False)]


def circle(color: str, radius: float = RADIUS) -> Mark:
    """Return an empty disc with a rim."""
    return lambda x, y: [scene.Points([(x, y, 0.0)], style.PAPER, radius, rim=color, shaded=False)]


def ring(color: str, radius: float, width: float = style.CURVE) -> Mark:
    """Return a circle about a place."""
    angle = np.linspace(0.0, 2.0 * np.pi, 49)
    rim = radius * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
    return lambda x, y: [scene.Lines(rim + np.array([x, y, 0.0]), color, width)]


def polygon(corners: int, color: str, turned: float = 0.0, radius: float = RADIUS) -> Mark:
    """Return a regular polygon of the area of a disc; a corner is on top unless it is turned (radians)."""
    angle = np.pi / 2.0 + turned + 2.0 * np.pi * np.arange(corners) / corners
    reach = radius * np.sqrt(2.0 * np.pi / (corners * np.sin(2.0 * np.pi / corners)))
    rim = reach * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
    faces = fan_faces(corners)
    return lambda x, y: [scene.Surface(rim + np.array([x, y, 0.0]), faces, color, material="flat")]


def cross(color: str, radius: float = RADIUS) -> Mark:
    """Return two strokes across each other."""
    d = 0.9 * radius
    return lambda x, y: [line(x - d, y - s * d, x + d, y + s * d, color, 1.5 * style.CURVE) for s in (-1, 1)]


def legend(entries: Sequence[Entry], y: float, apart: float = 44.0, near: float = 12.0) -> list[scene.Record]:
    """Return the marks with their meanings in one row, in the middle of the page."""
    widths = [2.0 * half + near + words for _, half, _, words in entries]
    x = 600.0 - (sum(widths) + apart * (len(entries) - 1)) / 2.0
    records: list[scene.Record] = []
    for (mark, half, text, _), width in zip(entries, widths, strict=True):
        records += [*mark(x + half, y), label(text, x + 2.0 * half + near, y - 10.0, "ln")]
        x += width + apart
    return records
