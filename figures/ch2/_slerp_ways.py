"""Three ways from one rotation to another: slerp, normalised lerp, and a straight line of Euler angles."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.lie import euler, quaternion, series, so3

CONVENTION = "xyz"
NAMES = ("slerp", "nlerp", "Euler")
# Nodes for the length of a smooth curve between two steps: more change no digit that is kept.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


@dataclass(frozen=True, eq=False)
class Ways:
    """Two unit quaternions and what lies between them; `opposite` where q1 = -q0.

    `line` is theta u, the logarithm of q1 q0^-1.  The rotation turns by 2 theta: a quaternion turns
    space by twice its angle.  Euler angles start at `angles` and go by `turns`, each the shorter way round.
    """

    start: np.ndarray
    end: np.ndarray
    line: np.ndarray
    opposite: bool
    angles: np.ndarray
    turns: np.ndarray
    slerp: Callable[..., np.ndarray] = quaternion.slerp

    @property
    def theta(self) -> float:
        """The angle between the two quaternions."""
        return float(np.linalg.norm(self.line))

    def arc(self, t: np.ndarray) -> np.ndarray:
        """Return slerp (2.32), shape (n, 4); between opposite ends that of the exponential map (2.31)."""
        if self.opposite:
            return quaternion.multiply(quaternion.exp(t[:, None] * self.line), self.start)
        return self.slerp(self.start, self.end, t)

    def rotations(self, t: np.ndarray) -> np.ndarray:
        """Return the rotations of the three ways, shape (3, n, 3, 3); NaN where nlerp is undefined."""
        defined = self._chord(t) > series.ROUNDED
        chord = np.full((len(t), 3, 3), np.nan)
        chord[defined] = quaternion.to_matrix(quaternion.nlerp(self.start, self.end, t[defined]))
        return np.stack(
            [quaternion.to_matrix(self.arc(t)), chord, euler.to_matrix(self._angles(t), CONVENTION)]
        )

    def speeds(self, t: np.ndarray) -> np.ndarray:
        """Return the angular speeds, radians per unit of t; shape (3, n), NaN where nlerp is undefined."""
        chord = self._chord(t)
        defined = chord > series.ROUNDED
        along = np.full(len(t), np.nan)
        along[defined] = 2.0 * self._sine / chord[defined] ** 2
        rates = euler.jacobian(self._angles(t), CONVENTION) @ self.turns
        return np.stack([np.full(len(t), 2.0 * self.theta), along, np.linalg.norm(rates, axis=-1)])

    def turned(self, t: np.ndarray) -> np.ndarray:
        """Return the angle turned through between one t and the next; shape (3, n - 1)."""
        arc = 2.0 * self.theta * np.diff(t)
        chord = 0.0 * arc
        if not self.opposite:
            cosine = quaternion.dot(self.start, self.end)
            chord = np.diff(2.0 * np.arctan2(t * self._sine, (1.0 - t) + t * cosine))
        half = np.diff(t)[:, None] / 2.0
        nodes = t[:-1, None] + half * (1.0 + _NODES)
        speed = self.speeds(nodes.ravel())[2].reshape(nodes.shape)
        return np.stack([arc, chord, np.sum(half * _WEIGHTS * speed, axis=-1)])

    def from_slerp(self, t: np.ndarray) -> np.ndarray:
        """Return the angle of each way from slerp; shape (3, n), NaN where nlerp is undefined."""
        R = self.rotations(t)
        relative = np.swapaxes(R[0], -1, -2) @ R
        undefined = np.isnan(R[..., 0, 0])
        relative[undefined] = np.eye(3)
        return np.where(undefined, np.nan, np.linalg.norm(so3.log(relative), axis=-1))

    def instants(self, count: int = 201) -> np.ndarray:
        """Return values of t, 0 to 1, close together wherever one of the ways is fast."""
        # An odd count holds t = 1/2, where the curve of nlerp has its gap if there is one.
        even = np.linspace(0.0, 1.0, count)
        if self._sine <= series.ROUNDED:
            return even
        before, after = np.sin(even * self.theta), np.sin((1.0 - even) * self.theta)
        return np.unique(np.concatenate([even, before / (before + after)]))

    @property
    def _sine(self) -> float:
        return 0.0 if self.opposite else float(np.sin(self.theta))

    def _chord(self, t: np.ndarray) -> np.ndarray:
        chord = (1.0 - t)[:, None] * self.start + t[:, None] * self.end
        return np.linalg.norm(chord, axis=-1)

    def _angles(self, t: np.ndarray) -> np.ndarray:
        return self.angles + t[:, None] * self.turns


def between(start: np.ndarray, end: np.ndarray, slerp: Callable[..., np.ndarray] = quaternion.slerp) -> Ways:
    """Return the three ways between two unit quaternions."""
    # As in quaternion.slerp, but with room for the rounding of the two lengths.
    opposite = bool(np.linalg.norm(start + end) <= 2.0 * series.ROUNDED)
    # At -1 the logarithm is pi i: one of the many directions that would serve.
    line = quaternion.log(quaternion.multiply(end, quaternion.conjugate(start)))
    ends = euler.from_matrix(quaternion.to_matrix(np.stack([start, end])), CONVENTION)
    turns = ends[1] - ends[0]
    turns = turns - 2.0 * np.pi * np.ceil(turns / (2.0 * np.pi) - 0.5)
    return Ways(start, end, line, opposite, ends[0], turns, slerp)
