"""What figure 7.1 shows: parameters, their image, and what psi says of it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.lie import affine, sym

Map = Callable[[np.ndarray], np.ndarray]
NOTHING = 1e-9
"""Shorter vectors are none."""
# Angles, radians, and translations that differ by less are the same; how far off phi(psi(A)) may be.
_SAME, EXACT = 1e-9, 1e-12
_UPPER = np.triu_indices(3)
# Of the way of the origin, so many points.
_FINE = 121


@dataclass(frozen=True, eq=False)
class Shown:
    """The parameters x, l = shift, Y = Q diag(logs) Q^T, all in `given`, their image A, and psi of it.

    S is what Y alone does, R what x alone does, and `way` (n, 3) where (x, l) takes the origin from 0 on.
    `same` says whether psi gives the parameters again, and `off` how far phi(psi(A)) is from A.
    """

    map: str
    x: np.ndarray
    shift: np.ndarray
    Q: np.ndarray
    logs: np.ndarray
    given: np.ndarray
    A: np.ndarray
    S: np.ndarray
    R: np.ndarray
    way: np.ndarray
    back: np.ndarray
    same: bool
    off: float

    @property
    def back_x(self) -> np.ndarray:
        """The rotation vector that psi answers."""
        return self.back[:3]

    @property
    def back_shift(self) -> np.ndarray:
        """The translation part that psi answers."""
        return self.back[3:6]

    @property
    def back_logs(self) -> np.ndarray:
        """The eigenvalues of the Y that psi answers, from the least."""
        return np.linalg.eigvalsh(symmetric(self.back))

    @property
    def returns(self) -> bool:
        """Whether what psi answers leads back to A."""
        return self.off <= EXACT

    @property
    def symbol(self) -> str:
        """The name of the map."""
        return r"\varphi_{se}" if self.map == "phi_se" else r"\varphi_{so}"

    @property
    def d(self) -> np.ndarray:
        """The translation of A."""
        return self.A[:3, 3]


def shown(
    name: str, x: np.ndarray, shift: np.ndarray, Q: np.ndarray, logs: np.ndarray, phi: Map, psi: Map
) -> Shown:
    """Return what a map makes of parameters, all at once and of some of them, and what psi says of that."""
    given = np.concatenate([x, shift, ((Q * logs) @ Q.T)[_UPPER]])
    part = np.repeat(np.eye(3), (3, 3, 6), axis=1)
    A = phi(given)
    S, R = (phi(given * part[k])[:3, :3] for k in (2, 0))
    way = phi(np.linspace(0.0, 1.0, _FINE)[:, None] * (given * (part[0] + part[1])))[:, :3, 3]
    back = psi(A)
    same = bool(np.abs(back - given).max() < _SAME * max(1.0, float(np.abs(given).max())))
    off = float(np.abs(phi(back) - A).max())
    return Shown(name, x, shift, Q, logs, given, A, S, R, way, back, same, off)


def of_rigid(exp: Map, log: Map) -> tuple[Map, Map]:
    """Return phi_se and its inverse that have other exp and log of rigid motions in them."""

    def phi(params: np.ndarray) -> np.ndarray:
        return exp(params[..., :6]) @ _stretch(sym.exp(symmetric(params)))

    def psi(A: np.ndarray) -> np.ndarray:
        back = affine.psi_se(A)
        back[..., :6] = log(A @ _stretch(sym.exp(-symmetric(back))))
        return back

    return phi, psi


def symmetric(params: np.ndarray) -> np.ndarray:
    """Return the Y of parameters (..., 12)."""
    Y = np.zeros((*params.shape[:-1], 3, 3))
    Y[..., _UPPER[0], _UPPER[1]] = Y[..., _UPPER[1], _UPPER[0]] = params[..., 6:]
    return Y


def _stretch(S: np.ndarray) -> np.ndarray:
    A = np.zeros((*S.shape[:-2], 4, 4))
    A[..., :3, :3], A[..., 3, 3] = S, 1.0
    return A


def unit(name: str, v: tuple[float, float, float]) -> np.ndarray:
    """Return a vector brought to length 1; ValueError if it has none."""
    w = np.asarray(v, float)
    size = float(np.abs(w).max())
    if not size > 1e-150:
        raise ValueError(f"parametrise: {name} must be different from 0; got {v}. Give a direction")
    w = w / size
    return w / np.linalg.norm(w)
