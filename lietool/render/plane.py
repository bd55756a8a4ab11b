"""A part of the plane on the page: the glyph, arrows, arcs and circles of the figures in two dimensions."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import letter, polyline, style
from lietool.render.camera import Box
from lietool.render.scene import Arrow, Label, Lines, Points, Record, Surface

# The page's arrows: half the width of the shaft, and the head that goes with it.
_SHAFT, _HEAD = 1.9, 3.9
# By how much of its radius an arc opens with every turn, so that a second turn does not hide the first.
_OPENING = 0.12


@dataclass(frozen=True)
class Plane:
    """A map from the plane to the page.

    Parameters
    ----------
    origin : tuple of float
        Where (0, 0) lies, in page units.
    scale : float
        Page units for a unit of the plane.
    """

    origin: tuple[float, float]
    scale: float

    def at(self, points: ArrayLike) -> np.ndarray:
        """Return where points (..., 2) lie on the page; shape (..., 3)."""
        points = np.asarray(points, float)
        page = np.asarray(self.origin) + self.scale * points
        return np.concatenate([page, np.zeros((*page.shape[:-1], 1))], axis=-1)

    def glyph(
        self,
        A: ArrayLike,
        fill: str,
        edge: str,
        *,
        size: float = 1.0,
        width: float = style.EDGE,
        alpha: float = 1.0,
        dash: tuple[float, float] | None = None,
    ) -> list[Record]:
        """Return the glyph F under a matrix, linear (2, 2) or homogeneous (3, 3).

        Parameters
        ----------
        A : array_like, shape (2, 2) or (3, 3)
        fill, edge : str
            Colours of the area and of its outline.
        size : float
            Height before `A`, in units of the plane.
        width : float
            Of the outline.
        alpha : float
            Of the area.
        dash : tuple of float, optional
            Of the outline.
        """
        outline = self.at(moved(A, size * letter.outline()))
        return [
            Surface(outline, letter.triangles(), fill, material="flat", alpha=alpha),
            Lines(np.concatenate([outline, outline[:1]]), edge, width, dash=dash),
        ]

    def line(
        self,
        points: ArrayLike,
        color: str,
        width: float = style.THIN,
        alpha: float = 1.0,
        dash: tuple[float, float] | None = None,
    ) -> Lines:
        """Return a polyline through points (n, 2); a row of NaN breaks it."""
        return Lines(self.at(points), color, width, alpha, dash)

    def arrow(self, start: ArrayLike, end: ArrayLike, color: str, radius: float = _SHAFT) -> Arrow:
        """Return a straight arrow, its shaft twice `radius` page units wide."""
        return Arrow(self.at(start), self.at(end), color, radius, _HEAD)

    def circle(
        self,
        center: ArrayLike,
        radius: float,
        color: str,
        width: float = style.THIN,
        alpha: float = 1.0,
        dash: tuple[float, float] | None = None,
    ) -> Lines:
        """Return a circle; `radius` in units of the plane."""
        return self.line(arc(center, radius, 0.0, 2.0 * np.pi, 121), color, width, alpha, dash)

    def turn(
        self,
        center: ArrayLike,
        radius: float,
        start: float,
        angle: float,
        color: str,
        *,
        width: float = style.CURVE,
        head: bool = True,
        dash: tuple[float, float] | None = None,
    ) -> list[Record]:
        """Return the arc of a turn, with an arrow's head at its end; past a full turn it is a spiral.

        Parameters
        ----------
        center : array_like, shape (2,)
        radius : float
            In units of the plane.
        start, angle : float
            Where it begins and by how much it turns, radians; counter-clockwise where positive.
        color : str
        width : float
            In page units.
        head : bool
        dash : tuple of float, optional
        """
        at = spiral(center, radius, start, angle)
        return path(self.at(at), color, width, head=head, dash=dash)

    def dots(self, points: ArrayLike, color: str, radius: float = 7.0) -> Points:
        """Return discs at points (n, 2)."""
        return Points(self.at(points).reshape(-1, 3), color, radius, shaded=False)

    def beyond(
        self,
        text: str,
        at: ArrayLike,
        toward: ArrayLike,
        *,
        color: str = style.INK,
        size: float = style.TEXT,
        gap: float = 30.0,
        room: float = 60.0,
    ) -> Label:
        """Return a label beyond a point, further along a direction; it may move a little to be free."""
        along = np.asarray(toward, float)
        length = float(np.linalg.norm(along))
        along = along / length if length > 1e-12 else np.array([0.0, 1.0])
        return Label(text, self.at(at), color, size, (gap * along[0], gap * along[1]), room=room)

    def axes(
        self, xlim: tuple[float, float], ylim: tuple[float, float], names: tuple[str, str] = ("$x$", "$y$")
    ) -> list[Record]:
        """Return the two coordinate axes as thin arrows, each with its name beyond its tip."""
        records: list[Record] = []
        for k, (low, high) in enumerate((xlim, ylim)):
            axis = np.eye(2)[k]
            records.append(Arrow(self.at(low * axis), self.at(high * axis), style.MUTED, 0.8, 5.0))
            if names[k]:
                records.append(
                    self.beyond(
                        names[k], high * axis, axis, color=style.MUTED, size=style.SMALL_TEXT, gap=22.0
                    )
                )
        return records


def fit(points: ArrayLike, box: Box, most: float = np.inf) -> Plane:
    """Return the plane that shows points as large as a box allows, in its middle.

    Parameters
    ----------
    points : array_like, shape (n, 2)
    box : tuple of float
        Left, lower edge, width, height on the page.
    most : float
        The largest scale, for points that lie close together.
    """
    points = np.asarray(points, float).reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    extent = np.maximum(high - low, 1e-9)
    scale = min(box[2] / extent[0], box[3] / extent[1], most)
    middle = np.array([box[0] + box[2] / 2.0, box[1] + box[3] / 2.0]) - scale * (low + high) / 2.0
    return Plane((float(middle[0]), float(middle[1])), float(scale))


def moved(A: ArrayLike, points: ArrayLike) -> np.ndarray:
    """Return points (..., 2) under a linear (2, 2) or homogeneous (3, 3) matrix."""
    A, points = np.asarray(A, float), np.asarray(points, float)
    shift = A[:2, 2] if A.shape == (3, 3) else 0.0
    return points @ A[:2, :2].T + shift


def direction(angle: ArrayLike) -> np.ndarray:
    """Return unit vectors (..., 2) at angles, radians."""
    angle = np.asarray(angle, float)
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def arc(center: ArrayLike, radius: float, start: float, stop: float, n: int = 61) -> np.ndarray:
    """Return points (n, 2) of an arc between two angles, radians."""
    return np.asarray(center, float) + radius * direction(np.linspace(start, stop, n))


def spiral(center: ArrayLike, radius: float, start: float, angle: float) -> np.ndarray:
    """Return points (n, 2) of the arc of a turn, radians; past a full turn it opens to a spiral."""
    count = max(round(abs(angle) / 0.05), 2) + 1
    along = np.linspace(0.0, angle, count)
    opening = radius * (1.0 + _OPENING * np.maximum(np.abs(along) - 2.0 * np.pi, 0.0) / (2.0 * np.pi))
    return np.asarray(center, float) + opening[:, None] * direction(start + along)


def path(
    points: np.ndarray,
    color: str,
    width: float,
    *,
    head: bool = True,
    dash: tuple[float, float] | None = None,
) -> list[Record]:
    """Return a curve on the page (n, 3) that ends in an arrow's head; too short a one is left out."""
    length, reach = polyline.remaining(points)[0], 6.0 * width
    if length < 1e-6:
        return []
    if not head or length < reach:
        return [Lines(points, color, width, dash=dash)]
    # The head stands on the last piece of the curve, as long as itself, along its chord.
    shaft = polyline.shortened(points, reach)
    return [
        Lines(shaft, color, width, dash=dash),
        *_head(shaft[-1], points[-1], color, 0.76 * reach),
    ]


def _head(start: np.ndarray, tip: np.ndarray, color: str, wide: float) -> Sequence[Record]:
    along = (tip - start) / np.linalg.norm(tip - start)
    across = np.array([-along[1], along[0], 0.0]) * wide / 2.0
    # A hair of overlap, so that no paper shows between curve and head.
    back = start - 0.5 * along
    return [Surface(np.stack([back + across, back - across, tip]), [[0, 1, 2]], color, material="flat")]
