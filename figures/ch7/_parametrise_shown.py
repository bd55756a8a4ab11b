"""What figure 7.1 shows: parameters, their image, and what psi says of it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

NOTHING = 1e-9
"""Shorter vectors are none."""


@dataclass(frozen=True, eq=False)
class Shown:
    """The parameters x, l = shift, Y = Q diag(logs) Q^T, all in `given`, their image A, and psi of it.

    `rigid` is what A does after the stretch; with phi_se `exp`, the exponential map of se(3), says it.
    """

    map: str
    x: np.ndarray
    shift: np.ndarray
    Q: np.ndarray
    logs: np.ndarray
    given: np.ndarray
    A: np.ndarray
    rigid: np.ndarray
    exp: Callable[[np.ndarray], np.ndarray]
    back: np.ndarray
    same: bool

    @property
    def back_x(self) -> np.ndarray:
        """The rotation vector that psi answers."""
        return self.back[:3]

    @property
    def back_shift(self) -> np.ndarray:
        """The translation part that psi answers."""
        return self.back[3:6]

    @property
    def Y(self) -> np.ndarray:
        """The logarithm of the stretch."""
        return (self.Q * self.logs) @ self.Q.T

    @property
    def symbol(self) -> str:
        """The name of the map."""
        return r"\varphi_{se}" if self.map == "phi_se" else r"\varphi_{so}"

    @property
    def S(self) -> np.ndarray:
        """exp(Y)"""
        return (self.Q * np.exp(self.logs)) @ self.Q.T

    @property
    def R(self) -> np.ndarray:
        """The rotation of A."""
        return self.rigid[:3, :3]

    @property
    def d(self) -> np.ndarray:
        """The translation of A."""
        return self.rigid[:3, 3]

    def way(self, n: int = 121) -> np.ndarray:
        """The way (n, 3) of the origin to d: of the screw motion, or straight."""
        t = np.linspace(0.0, 1.0, n)[:, None]
        if self.map == "phi_so":
            return t * self.shift
        return self.exp(t * np.concatenate([self.x, self.shift]))[:, :3, 3]


def unit(name: str, v: tuple[float, float, float]) -> np.ndarray:
    """Return a vector brought to length 1; ValueError if it has none."""
    w = np.asarray(v, float)
    size = float(np.abs(w).max())
    if not size > 1e-150:
        raise ValueError(f"parametrise: {name} must be different from 0; got {v}. Give a direction")
    w = w / size
    return w / np.linalg.norm(w)
