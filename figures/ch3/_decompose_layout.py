"""Where the panels of `decompose` stand: as large as the page allows at every moment of the steps.

The sizes come from what the panels show from t = 0 to 1, so that in a film nothing moves but the shapes.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

# What the panels and their arrows may take of the page: left, lower edge, right, upper edge.
_LEFT, _LOW, _RIGHT, _HIGH = 50.0, 176.0, 1150.0, 852.0
# An arrow between two panels, and the least distance from its ends to them.
ARROW, _PAD = 100.0, 14.0
# Between two columns there stand a name and two lines beside the arrow's shaft.
_COLUMNS = ARROW + 2.0 * _PAD + 80.0
# For the names of the singular values, beyond the ends of the axes.
_NAMES = 40.0
# From the sides of the page to the upper panels of a triangle, at least: there are lines beside the arrows.
_ASIDE = 130.0
# How far outside of a disc its rotation is drawn, and the least radius of that.
OUTSIDE, LEAST = 1.13, 0.6


@dataclass(frozen=True)
class Extent:
    """Half of what a panel takes across, upright, and at most in any direction, in units of its plane.

    `names` says that there are names beyond the ends of its axes.
    """

    wide: float
    high: float
    reach: float
    names: bool


@dataclass(frozen=True)
class Layout:
    """The centres of the panels, and page units for a unit of their planes."""

    centers: tuple[np.ndarray, ...]
    scale: float


def extent(shapes: np.ndarray, tips: np.ndarray, names: bool) -> Extent:
    """Return what discs under matrices (n, 2, 2) take, with the arcs on which points (m, 2) turn about 0."""
    arcs = tips * OUTSIDE * np.maximum(1.0, LEAST / np.maximum(np.linalg.norm(tips, axis=-1), 1e-9))[:, None]
    wide, high = np.concatenate([np.linalg.norm(shapes, axis=-1), np.abs(arcs)]).max(axis=0)
    reach = max(np.linalg.norm(shapes, ord=2, axis=(1, 2)).max(), np.linalg.norm(arcs, axis=-1).max())
    return Extent(float(wide), float(high), float(reach), names)


def square(panels: tuple[Extent, ...]) -> Layout:
    """Return four panels, clockwise from the upper left, with straight arrows between them."""
    wide = max(panels[0].wide, panels[3].wide), max(panels[1].wide, panels[2].wide)

    def high(scale: float) -> tuple[float, float]:
        return max(_half(panel, scale) for panel in panels[:2]), max(
            _half(panel, scale) for panel in panels[2:]
        )

    rows = ARROW + 2.0 * _PAD
    across = (_RIGHT - _LEFT - _NAMES - _COLUMNS) / (2.0 * sum(wide))
    scale = min(_largest(lambda scale: 2.0 * sum(high(scale)) + rows <= _HIGH - _LOW), across)
    above, below = high(scale)
    apart, down = scale * sum(wide) + _COLUMNS, above + below + rows
    top = (_HIGH + _LOW + down + below - above) / 2.0
    left = 600.0 - (apart + scale * (wide[1] - wide[0])) / 2.0
    right = left + apart
    corners = ((left, top), (right, top), (right, top - down), (left, top - down))
    return Layout(tuple(np.array(corner) for corner in corners), scale)


def _half(panel: Extent, scale: float) -> float:
    """Half the height of a panel on the page."""
    return scale * panel.high + (_NAMES if panel.names else 0.0)


def triangle(panels: tuple[Extent, ...]) -> Layout:
    """Return three panels: two above, the last below and between them."""

    def placed(scale: float) -> Layout:
        top = _HIGH - max(_half(panel, scale) for panel in panels[:2])
        low = _LOW + _half(panels[2], scale)
        left = _LEFT + max(scale * panels[0].wide, _ASIDE)
        right = _RIGHT - max(scale * panels[1].wide + (_NAMES if panels[1].names else 0.0), _ASIDE)
        return Layout((np.array([left, top]), np.array([right, top]), np.array([600.0, low])), scale)

    def fits(layout: Layout) -> bool:
        a, b, c = layout.centers
        gaps = (
            np.linalg.norm(a - b) - layout.scale * (panels[0].reach + panels[1].reach) - 40.0,
            np.linalg.norm(a - c) - layout.scale * (panels[0].reach + panels[2].reach),
            np.linalg.norm(b - c) - layout.scale * (panels[1].reach + panels[2].reach),
        )
        return bool(min(gaps) >= ARROW + 2.0 * _PAD and a[1] > c[1])

    return placed(_largest(lambda scale: fits(placed(scale))))


def _largest(fits: Callable[[float], bool]) -> float:
    low, high = 0.0, 400.0
    for _ in range(40):
        middle = (low + high) / 2.0
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def ends(
    start: np.ndarray, end: np.ndarray, scale: float, panels: tuple[Extent, Extent]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of the arrow from one panel to the next: in the middle of what is free between them."""
    along = (end - start) / np.linalg.norm(end - start)

    def border(panel: Extent) -> float:
        upright, level = abs(along[1]) > 0.99, abs(along[0]) > 0.99
        return scale * (panel.high if upright else panel.wide if level else panel.reach)

    tail, tip = start + border(panels[0]) * along, end - border(panels[1]) * along
    middle = (tail + tip) / 2.0
    return middle - ARROW / 2.0 * along, middle + ARROW / 2.0 * along
