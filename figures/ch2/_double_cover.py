"""A turning about an axis, as quaternions and as rotations: what figure 2.7 shows."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from lietool.lie import quaternion, so3

FULL = 2.0 * np.pi
# Of two quaternions; of a quaternion and a vector.
Map = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Shown:
    """The turning about `u` from `start`: quaternions at some stages (n, 4), and now, at the angle theta."""

    u: np.ndarray
    start: np.ndarray
    theta: float
    stages: np.ndarray
    at_stages: np.ndarray
    now: np.ndarray
    multiply: Map = quaternion.multiply
    act: Map = quaternion.act

    @property
    def at_one(self) -> bool:
        return bool(np.allclose(self.start, (1.0, 0.0, 0.0, 0.0)))

    def at(self, theta: ArrayLike) -> np.ndarray:
        """The quaternions at other angles."""
        return lift(self.u, self.start, theta, self.multiply)

    @property
    def turned(self) -> np.ndarray:
        """The rotation now (3, 3)."""
        return _by_action(self.now, self.act)

    @cached_property
    def turned_at_stages(self) -> np.ndarray:
        """The rotations at the stages (n, 3, 3): in the first turn by the action, then by products.

        Solids at opposite points of the circle look alike if both are right.
        """
        second = self.stages >= FULL
        by_action, by_products = self.at_stages[~second], self.at_stages[second]
        return np.concatenate([_by_action(by_action, self.act), _by_products(by_products, self.multiply)])

    def on_sphere(self, q: np.ndarray) -> np.ndarray:
        """Quaternions of the circle (..., 4) as points of space: the start up, u start on the right."""
        imaginary = np.concatenate([[0.0], self.u])
        up, right = self.start, quaternion.multiply(imaginary, self.start)
        return np.stack([q @ right, np.zeros(q.shape[:-1]), q @ up], axis=-1)

    def laps(self) -> list[np.ndarray]:
        """The angles of each turn that has begun."""
        ends = np.append(np.arange(0.0, self.theta - 1e-9, FULL), self.theta)
        return [np.linspace(a, b, max(round((b - a) / 0.04), 1) + 1) for a, b in pairwise(ends)]


def _by_action(q: np.ndarray, act: Map) -> np.ndarray:
    """Return the rotations of quaternions (..., 4), the images of the axes as columns."""
    return np.swapaxes(act(q[..., None, :], np.eye(3)), -1, -2)


def _by_products(q: np.ndarray, multiply: Map) -> np.ndarray:
    """Return the rotations of quaternions (..., 4) by p -> q p q^-1, (2.28)."""
    q = q[..., None, :]
    return np.swapaxes(multiply(multiply(q, np.eye(4)[1:]), quaternion.conjugate(q))[..., 1:], -1, -2)


def lift(
    u: np.ndarray, start: np.ndarray, theta: ArrayLike, multiply: Map = quaternion.multiply
) -> np.ndarray:
    """Return the quaternions exp(theta u / 2) start (..., 4), continuous in theta."""
    half = 0.5 * np.asarray(theta, float)
    q = quaternion.exp(half[..., None] * u)
    return multiply(q, start)


def distances(q: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Return how far R and q (..., 4) are from the start, each in its own space (..., 2), radians."""
    R, R0 = quaternion.to_matrix(q), quaternion.to_matrix(start)
    of_R = np.linalg.norm(so3.log(R @ R0.T), axis=-1)
    of_q = 2.0 * np.arctan2(np.linalg.norm(q - start, axis=-1), np.linalg.norm(q + start, axis=-1))
    return np.stack([of_R, of_q], axis=-1)
