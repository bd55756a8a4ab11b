"""Plots on a page: axes, curves and their text, made of the same records as everything else.

A plot is drawn by the same renderer as the scene beside it, so that its lines
have the same quality and its text comes from the same labels.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import style
from lietool.render.scene import Label, Lines, Points, Record, Surface

Ticks = Sequence[tuple[float, str]]
_TICK = 7.0


def number(value: float | np.floating, digits: int = 2) -> str:
    """Return a number as text, rounded, without a minus sign before zero.

    Parameters
    ----------
    value : float
    digits : int
        After the decimal point.

    Returns
    -------
    str
        Without trailing zeros.
    """
    text = f"{round(float(value), digits) + 0.0:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


@dataclass(frozen=True)
class Axes:
    """A rectangle of the page with its own coordinates.

    Parameters
    ----------
    box : tuple of float
        Left, lower edge, width, height in page units: where the curves are; ticks and text lie outside.
    xlim, ylim : tuple of float
        The values at the edges.
    """

    box: tuple[float, float, float, float]
    xlim: tuple[float, float]
    ylim: tuple[float, float]

    def at(self, x: ArrayLike, y: ArrayLike) -> np.ndarray:
        """Return where values lie on the page; shape (..., 3)."""
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        px = self.box[0] + (x - self.xlim[0]) / (self.xlim[1] - self.xlim[0]) * self.box[2]
        py = self.box[1] + (y - self.ylim[0]) / (self.ylim[1] - self.ylim[0]) * self.box[3]
        return np.stack([px, py, np.zeros_like(px)], axis=-1)

    def frame(
        self,
        xticks: Ticks,
        yticks: Ticks,
        xlabel: str = "",
        title: str = "",
        *,
        size: float = style.SMALL_TEXT,
        title_size: float = style.TEXT,
    ) -> list[Record]:
        """Return the axes: two lines, ticks, faint rules, numbers and names.

        Parameters
        ----------
        xticks, yticks : sequence of (float, str)
            Where, and the mathtext there; a text may be empty.
        xlabel : str
            At the right end of the lower edge.
        title : str
            Above the left end of the upper edge.
        size, title_size : float
            Type sizes in page units.
        """
        left, low = self.box[:2]
        right, high = left + self.box[2], low + self.box[3]
        records: list[Record] = []
        for value, text in yticks:
            x, y = left, self.at(self.xlim[0], value)[1]
            records.append(_line((x, y), (right, y), style.RULE, style.HAIR))
            if text:
                records.append(Label(text, (x, y, 0), style.INK, size, (-14.0, 0.0), "rc", halo=False))
        for value, text in xticks:
            x = self.at(value, self.ylim[0])[0]
            records.append(_line((x, low), (x, low - _TICK), style.INK, style.THIN))
            if text:
                records.append(Label(text, (x, low, 0), style.INK, size, (0.0, -14.0), "ct", halo=False))
        records.append(_line((left, low), (right, low), style.INK, style.THIN))
        if xlabel:
            records.append(Label(xlabel, (right, low, 0), style.INK, size, (54.0, -14.0), "lt", halo=False))
        if title:
            records.append(
                Label(title, (left, high, 0), style.INK, title_size, (0.0, 26.0), "lb", halo=False)
            )
        return records

    def curve(
        self,
        x: ArrayLike,
        y: ArrayLike,
        color: str,
        width: float = style.CURVE,
        dash: tuple[float, float] | None = None,
    ) -> Lines:
        """Return a curve; NaN breaks it."""
        return Lines(self.at(x, y), color, width, dash=dash)

    def dots(
        self, x: ArrayLike, y: ArrayLike, color: str, radius: float = 7.0, hollow: bool = False
    ) -> Points:
        """Return discs at values; a hollow one marks an end that does not belong to the curve."""
        if hollow:
            return Points(self.at(x, y).reshape(-1, 3), style.PAPER, radius, rim=color, shaded=False)
        return Points(self.at(x, y).reshape(-1, 3), color, radius, shaded=False)

    def band(self, x0: float, x1: float, color: str) -> Surface:
        """Return a filled strip over the whole height between two values of x."""
        corners = self.at([x0, x1, x1, x0], [self.ylim[0]] * 2 + [self.ylim[1]] * 2)
        return Surface(corners, [[0, 1, 2], [0, 2, 3]], color, material="flat")

    def area(self, x: ArrayLike, y: ArrayLike, color: str, alpha: float) -> Surface:
        """Return the area between a curve and the lower edge."""
        upper = self.at(x, y)
        lower = self.at(x, np.full(len(upper), self.ylim[0]))
        n = np.arange(len(upper) - 1)
        faces = np.concatenate(
            [
                np.stack([n, n + 1, n + 1 + len(upper)], axis=-1),
                np.stack([n, n + 1 + len(upper), n + len(upper)], axis=-1),
            ]
        )
        return Surface(np.concatenate([upper, lower]), faces, color, material="flat", alpha=alpha)

    def vertical(self, x: float, color: str, dash: tuple[float, float] | None = (7.0, 6.0)) -> Lines:
        """Return a line over the whole height at a value of x."""
        return Lines(self.at([x, x], self.ylim), color, style.THIN, dash=dash)


def _line(a: tuple[float, float], b: tuple[float, float], color: str, width: float) -> Lines:
    return Lines([(*a, 0.0), (*b, 0.0)], color, width)
