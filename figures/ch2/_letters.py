"""The letter F in the pictures of motions in the plane: its tracked corner, and how it is drawn."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lietool.lie import se2
from lietool.render import letter as shape
from lietool.render import plane, scene, style

# The strokes of the letter as boxes (left, lower, right, upper), the letter being 1 high about its middle.
_BOXES = (np.array([[0, 0, 1, 4], [1, 3, 3, 4], [1, 1, 2, 2]]) - [1.5, 2.0, 1.5, 2.0]) / 4.0
# Its corners in the order in which they are liked as the tracked one: upper left, foot, the others outside.
_CORNERS = (9, 0, 8, 1, 7)
# How near to a letter a curve may pass without being on it, and how far around the tracked corner it may.
_NEAR, _FREE = 0.07, 0.16


@dataclass(frozen=True)
class Look:
    """How a shape is drawn."""

    fill: str
    edge: str
    alpha: float = 1.0
    dash: tuple[float, float] | None = None


START = Look(style.BEFORE, style.BEFORE_EDGE)
STAGE = Look(style.BETWEEN, style.BETWEEN_EDGE)
GHOST = Look(style.BETWEEN, style.BETWEEN_EDGE, 0.8)
FAINT = Look(style.BETWEEN, style.BETWEEN_EDGE, 0.35)
END = Look(style.AFTER, style.AFTER_EDGE)
# On the other way, and its end.
OTHER_GHOST = Look(style.ROUTE_2, style.ROUTE_2, 0.05)
OTHER_STAGE = Look(style.ROUTE_2, style.ROUTE_2, 0.16)
OTHER_END = Look(style.ROUTE_2, style.ROUTE_2_TEXT, 0.55)
# Where a shape will be, or would be.
OUTLINE = Look(style.AFTER, style.AFTER_EDGE, 0.16, (7.0, 6.0))


@dataclass(frozen=True)
class Letter:
    """The letter F of a size, carried by motions that take the origin to its tracked corner.

    Parameters
    ----------
    size : float
        Height, in units of the plane.
    corner : tuple of float
        The tracked corner, of the letter 1 high about its middle.
    """

    size: float
    corner: tuple[float, float]

    def outline(self, T: np.ndarray) -> np.ndarray:
        """Return the corners (10, 2) under a motion."""
        return plane.moved(T, self.size * (shape.outline() - self.corner))

    def draw(self, page: plane.Plane, T: np.ndarray, look: Look) -> list[scene.Record]:
        """Return the letter under a motion."""
        x, y = self.corner
        own = T @ se2.exp([0.0, -self.size * x, -self.size * y])
        return page.glyph(own, look.fill, look.edge, size=self.size, alpha=look.alpha, dash=look.dash)

    def stages(self, page: plane.Plane, motions: Sequence[np.ndarray]) -> list[scene.Record]:
        """Return the letter at the start and where it pauses."""
        records = self.draw(page, motions[0], START)
        for T in motions[1:]:
            records += self.draw(page, T, STAGE)
        return records

    def on(self, T: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return which points (n, 2) lie on the letter under a motion, or right beside it."""
        own = plane.moved(np.linalg.inv(T), points) / self.size
        at = (own + self.corner)[:, None, :]
        inside = ((at > _BOXES[:, :2] - _NEAR) & (at < _BOXES[:, 2:] + _NEAR)).all(axis=-1).any(axis=-1)
        return inside & (np.linalg.norm(own, axis=-1) > _FREE)


def tracked(size: float, motions: Sequence[np.ndarray], curves: Sequence[np.ndarray]) -> Letter:
    """Return the letter with that corner tracked at which curves cross the letters least.

    Parameters
    ----------
    size : float
    motions : sequence of ndarray, shape (3, 3)
        Which take the origin to the places of the tracked corner.
    curves : sequence of ndarray, shape (n, 2)
        Arrows between these places, and other lines that no letter should lie on.
    """
    outline = shape.outline()
    found = [Letter(size, (float(outline[k, 0]), float(outline[k, 1]))) for k in _CORNERS]
    pieces = [_pieces(curve) for curve in curves]
    middles, lengths = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    cost = np.array([_crossed(letter, motions, middles, lengths) for letter in found]) / size
    return found[int(np.argmax(cost <= cost.min() + 1e-6))]


def _pieces(curve: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The middles (n, 2) and the lengths (n,) of short pieces of a curve."""
    curve = np.asarray(curve, float)
    fine = np.linspace(0.0, len(curve) - 1.0, max(2 * len(curve), 81))
    at = np.stack([np.interp(fine, np.arange(len(curve)), curve[:, k]) for k in range(2)], axis=-1)
    return (at[1:] + at[:-1]) / 2.0, np.linalg.norm(np.diff(at, axis=0), axis=-1)


def _crossed(
    letter: Letter, motions: Sequence[np.ndarray], middles: np.ndarray, lengths: np.ndarray
) -> float:
    """How long the curves run on letters, and how much the letters lie on each other."""
    length = sum(float(lengths[letter.on(T, middles)].sum()) for T in motions)
    squares = np.concatenate([[(b[:2] + b[2:]) / 2.0, b[:2], b[2:]] for b in _BOXES]) - letter.corner
    shared = sum(
        letter.on(T, plane.moved(S, letter.size * squares)).sum()
        for i, T in enumerate(motions)
        for S in motions[:i]
    )
    return length + 0.3 * letter.size * float(shared)


def beside(page: plane.Plane, letter: Letter, T: np.ndarray, text: str) -> scene.Label:
    """Return the name of an upright letter, in the free corner to the right of its foot."""
    outline = page.at(letter.outline(T))
    return scene.Label(text, outline[1], style.INK, style.TEXT, (12.0, 8.0), "lb", room=70.0)
