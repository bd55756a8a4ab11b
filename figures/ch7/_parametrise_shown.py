"""What figure 7.1 shows: parameters, their image, and what psi says of it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

NOTHING = 1e-9
"""Shorter vectors are none."""


@dataclass(frozen=True, eq=False)
class Shown:
    """The parameters x, l = shift, Y = Q diag(logs) Q^T, their image A, and what psi says of it.

    Of the image, S is that of Y alone, R that of x alone, and `way` (n, 3) what (x, l) makes of the origin on
    the way from 0.  Of psi, `back_logs` are the eigenvalues of its Y; `same` says whether it gives the
    parameters again, `returns` whether it leads back to A.
    """

    map: str
    x: np.ndarray
    shift: np.ndarray
    Q: np.ndarray
    logs: np.ndarray
    A: np.ndarray
    S: np.ndarray
    R: np.ndarray
    way: np.ndarray
    back_x: np.ndarray
    back_shift: np.ndarray
    back_logs: np.ndarray
    same: bool
    returns: bool

    @property
    def symbol(self) -> str:
        """The name of the map."""
        return r"\varphi_{se}" if self.map == "phi_se" else r"\varphi_{so}"

    @property
    def d(self) -> np.ndarray:
        """The translation of A."""
        return self.A[:3, 3]


def parts(
    phi: Callable[[np.ndarray], np.ndarray], given: np.ndarray, n: int = 121
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the stretch, the rotation, and the way (n, 3) of the origin, that a map makes of parameters."""
    moved = np.where(np.arange(12) < 6, np.linspace(0.0, 1.0, n)[:, None] * given, 0.0)
    S, R = (phi(np.where(part, given, 0.0))[:3, :3] for part in (np.arange(12) >= 6, np.arange(12) < 3))
    return S, R, phi(moved)[:, :3, 3]


def unit(name: str, v: tuple[float, float, float]) -> np.ndarray:
    """Return a vector brought to length 1; ValueError if it has none."""
    w = np.asarray(v, float)
    size = float(np.abs(w).max())
    if not size > 1e-150:
        raise ValueError(f"parametrise: {name} must be different from 0; got {v}. Give a direction")
    w = w / size
    return w / np.linalg.norm(w)
