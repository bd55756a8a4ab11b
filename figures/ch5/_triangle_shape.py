"""A triangle with the letter F in it, and a row of such triangles over a line of time."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from lietool.render import letter, plane, scene, style
from lietool.render.theme import Color

from . import _triangle_map as maps

# How much of the room in the triangle the letter takes.
_LETTER = 0.86
# How much of a colour is in its tint.
_TINT = 0.2
# White at the sides of the page.
_EDGE = 26.0
# From one moment to the next, where each of them is named on the line of time.
NAMED = 80.0
Colors = tuple[Color, str]


@dataclass(frozen=True, eq=False)
class Shape:
    """The source with a letter in it, both from the middle of the corners."""

    corners: np.ndarray
    letter: np.ndarray

    @classmethod
    def of(cls, source: maps.Map) -> "Shape":
        """Return the shape of a map's source, with the largest upright letter that it holds."""
        corners = source.about_middle
        along = np.roll(corners, -1, axis=0) - corners
        inward = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        inward *= np.sign(np.linalg.det(along[:2]))
        # It touches all three sides: inward . (middle + size * p) is least where the letter reaches.
        reach = -(inward @ letter.outline().T).min(axis=1)
        held = np.linalg.solve(np.column_stack([inward, -reach]), np.sum(inward * corners, axis=1))
        return cls(corners, held[:2] + _LETTER * held[2] * letter.outline())

    def extent(self, A: np.ndarray) -> np.ndarray:
        """Return the half width and half height (..., 2) of the triangle under matrices (..., 2, 2)."""
        return np.abs(np.einsum("...ij,kj->...ki", A, self.corners)).max(axis=-2)

    def draw(
        self,
        A: np.ndarray,
        at: tuple[float, float],
        scale: float,
        colors: Colors,
        *,
        width: float = style.EDGE,
    ) -> list[scene.Record]:
        """Return the triangle under a matrix at some place of the page: its area, outline and letter.

        Parameters
        ----------
        A : ndarray, shape (2, 2)
        at : tuple of float
            Where its middle lies, in page units.
        scale : float
            Page units for a unit of the plane.
        colors : tuple of color and str
            Of the triangle's area, of its outline and the letter.
        width : float
            Of the outline.
        """
        place = plane.Plane(at, scale)
        rim, glyph = (place.at(plane.moved(A, points)) for points in (self.corners, self.letter))
        fill, edge = colors
        # Both ends inside the first side, so that the outline has no open corner.
        start = (rim[:1] + rim[1:2]) / 2.0
        return [
            scene.Surface(rim, [[0, 1, 2]], fill, material="flat"),
            scene.Surface(glyph, letter.triangles(), edge, material="flat"),
            scene.Lines(np.concatenate([start, rim[1:], rim[:1], start]), edge, width),
        ]

    def rim(
        self, A: np.ndarray, at: tuple[float, float], scale: float, color: str, dash: tuple[float, float]
    ) -> scene.Lines:
        """Return nothing but the dashed outline of the triangle under a matrix."""
        rim = plane.Plane(at, scale).at(plane.moved(A, self.corners))
        return scene.Lines(np.concatenate([rim, rim[:1]]), color, style.EDGE, dash=dash)


def tint(color: str) -> Color:
    """Return a pale form of a colour."""
    return style.ramp([_TINT], (style.PAPER, color))


def cross(at: tuple[float, float]) -> list[scene.Record]:
    """Return a red cross on the page, where a matrix is singular."""
    arms = 9.0 * np.array([[1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]])
    arms += [*at, 0.0]
    return [scene.Lines(arms[i : i + 2], style.WRONG, style.CURVE) for i in (0, 2)]


def fraction(t: float) -> str:
    """Return a moment as mathtext, as a fraction in lowest terms."""
    return f"${Fraction(float(t)).limit_denominator(99)}$"


def stage(t: float, det: float) -> Colors:
    """Return the colours of a triangle at a moment: before, after, on the way, beyond, or turned over."""
    if det <= 0.0:
        return style.PAPER, style.WRONG
    if abs(t) < 1e-9:
        return style.BEFORE, style.BEFORE_EDGE
    if abs(t - 1.0) < 1e-9:
        return style.AFTER, style.AFTER_EDGE
    return (style.BETWEEN, style.BETWEEN_EDGE) if 0.0 < t < 1.0 else (style.PAPER, style.BETWEEN_EDGE)


def moments(steps: int, beyond: float) -> np.ndarray:
    """Return the equal steps from 0 to 1, and as many of the same before and after as there is room for."""
    more = int(np.floor(beyond * steps + 1e-9))
    return np.arange(-more, steps + more + 1) / steps


@dataclass(frozen=True, eq=False)
class Strip:
    """A line of time on the page.

    Parameters
    ----------
    left, right : float
        Where the first and the last moment lie, in page units.
    start, stop : float
        These moments.
    """

    left: float
    right: float
    start: float
    stop: float

    def x(self, t: np.ndarray | float) -> np.ndarray:
        """Return where moments lie."""
        part = (np.asarray(t, float) - self.start) / (self.stop - self.start)
        return self.left + part * (self.right - self.left)

    def scale(self, shape: Shape, rows: list[np.ndarray], times: np.ndarray, height: float) -> float:
        """Return the scale at which neighbours hardly touch, and none is too high or leaves the page."""
        gaps = np.diff(self.x(times))
        limits = [np.inf]
        for A in rows:
            wide, high = np.moveaxis(shape.extent(A), -1, 0)
            limits.append(float((1.04 * gaps / (wide[1:] + wide[:-1])).min()) if len(gaps) else np.inf)
            limits.append(height / 2.0 / float(high.max()))
            limits += [(self.left - _EDGE) / float(wide[0]), (1200.0 - _EDGE - self.right) / float(wide[-1])]
        return min(limits)

    def row(
        self, shape: Shape, A: np.ndarray, times: np.ndarray, y: float, scale: float
    ) -> list[scene.Record]:
        """Return the triangles under matrices (n, 2, 2) at their moments, beside each other."""
        records: list[scene.Record] = []
        for t, matrix in zip(times, A, strict=True):
            colors = stage(float(t), float(np.linalg.det(matrix)))
            records += shape.draw(matrix, (float(self.x(t)), y), scale, colors, width=style.THIN)
        return records

    def axis(self, y: float, times: np.ndarray) -> list[scene.Record]:
        """Return the line of time with its moments, which have a name where there is room for it."""
        low, high = self.left - 20.0, self.right + 34.0
        records: list[scene.Record] = [scene.Arrow((low, y, 0.0), (high, y, 0.0), style.MUTED, 0.8, 5.0)]
        pitch = float(np.diff(self.x(times)).min()) if len(times) > 1 else np.inf
        for k in times:
            x = float(self.x(k))
            records.append(scene.Lines([(x, y - 7.0, 0.0), (x, y + 7.0, 0.0)], style.INK, style.THIN))
            if pitch >= NAMED or abs(k - np.round(k)) < 1e-9:
                where = (x, y - 14.0, 0.0)
                records.append(scene.Label(fraction(k), where, style.INK, style.SMALL_TEXT, anchor="ct"))
        name = scene.Label("$t$", (high, y, 0.0), style.INK, style.SMALL_TEXT, (0.0, -14.0), "ct")
        return [*records, name]


def stack(heights: np.ndarray, low: float, high: float, gap: float, most: float) -> tuple[float, np.ndarray]:
    """Return the scale at which rows of such heights fill a part of the page, and their middles.

    Parameters
    ----------
    heights : ndarray, shape (n,)
        In units of the plane, from the uppermost row down.
    low, high : float
        The part of the page.
    gap : float
        Between rows.
    most : float
        The largest scale.
    """
    count = len(heights)
    scale = min((high - low - gap * (count - 1)) / float(heights.sum()), most)
    # What a smaller scale leaves goes between the rows.
    pitch = scale * heights + (high - low + gap - scale * float(heights.sum())) / count
    return scale, high + gap / 2.0 - np.cumsum(pitch) + pitch / 2.0
