"""Motions of the plane as unit dual complex numbers, by functions that a figure is given."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.lie import so2

# Where these go says where everything goes.
_FRAME = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])


@dataclass(frozen=True, eq=False)
class Motions:
    """What makes the numbers, multiplies them and moves points by them.

    Parameters
    ----------
    number : callable
        The unit dual complex numbers (..., 4) of homogeneous matrices (..., 3, 3).
    multiply : callable
        The products (..., 4) of numbers.
    act : callable
        Points (..., 2) moved by numbers.
    """

    number: Callable[..., np.ndarray]
    multiply: Callable[..., np.ndarray]
    act: Callable[..., np.ndarray]

    def of(self, theta: float | np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return the numbers (..., 4) of turns by theta about the origin and then shifts by b (..., 2)."""
        b = np.asarray(b, float)
        T = np.zeros((*np.broadcast_shapes(np.shape(theta), b.shape[:-1]), 3, 3))
        T[..., :2, :2], T[..., :2, 2], T[..., 2, 2] = so2.exp(theta), b, 1.0
        return self.number(T)

    def turn(self, theta: float | np.ndarray) -> np.ndarray:
        """Return the numbers of turns about the origin."""
        return self.of(theta, np.zeros(2))

    def shift(self, b: np.ndarray) -> np.ndarray:
        """Return the numbers of shifts."""
        return self.of(0.0, b)

    def product(self, *factors: np.ndarray) -> np.ndarray:
        """Return the product of numbers; the last factor acts first."""
        result = factors[-1]
        for factor in factors[-2::-1]:
            result = self.multiply(factor, result)
        return result

    def matrix(self, p: np.ndarray) -> np.ndarray:
        """Return the homogeneous matrices (..., 3, 3) of numbers, from where points go."""
        x, y, origin = np.moveaxis(self.act(p[..., None, :], _FRAME), -2, 0)
        T = np.zeros((*p.shape[:-1], 3, 3))
        T[..., :2, :] = np.stack([x - origin, y - origin, origin], axis=-1)
        T[..., 2, 2] = 1.0
        return T
