"""What the two tables of Kaji and Ochiai compare: exp and log of sym(3), phi and psi of Aff+(3)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.bench import printed
from lietool.lie import aff, affine, dual_quaternion, quaternion, so3, sym

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Method:
    """A way to write transformations as parameters.

    Parameters
    ----------
    name : str
        As in Table 2, for those that it has.
    way : str
        Its blend, in `blend.WAYS`.
    psi : callable
        From matrices (..., 4, 4) to parameters.
    phi : callable
        Back, from any parameters.
    near : callable
        psi with the branch that is nearest to other parameters, for one matrix.
    """

    name: str
    way: str
    psi: Callable[[Array], Array]
    phi: Callable[[Array], Array]
    near: Callable[[Array, Array], Array]


def _assemble(R: Array, S: Array, d: Array) -> Array:
    A = np.zeros((*d.shape[:-1], 4, 4))
    A[..., :3, :3], A[..., :3, 3], A[..., 3, 3] = R @ S, d, 1.0
    return A


def _split(A: Array) -> tuple[Array, Array, Array]:
    R, S = printed.newton_polar(A[..., :3, :3])
    return R, S.reshape(*S.shape[:-2], 9), A[..., :3, 3]


def _square(p: Array) -> Array:
    return p.reshape(*p.shape[:-1], 3, 3)


def _linear_psi(A: Array) -> Array:
    return A[..., :3, :].reshape(*A.shape[:-2], 12)


def _linear_phi(p: Array) -> Array:
    A = np.zeros((*p.shape[:-1], 4, 4))
    A[..., :3, :], A[..., 3, 3] = p.reshape(*p.shape[:-1], 3, 4), 1.0
    return A


def _quaternion_psi(A: Array) -> Array:
    R, S, d = _split(A)
    return np.concatenate([quaternion.from_matrix(R, check=False), d, S], axis=-1)


def _quaternion_phi(p: Array) -> Array:
    return _assemble(quaternion.to_matrix(p[..., :4], check=False), _square(p[..., 7:]), p[..., 4:7])


def _dual_psi(A: Array) -> Array:
    R, S, d = _split(A)
    q = quaternion.from_matrix(R, check=False)
    return np.concatenate([dual_quaternion.from_rotation_translation(q, d, check=False), S], axis=-1)


def _dual_phi(p: Array) -> Array:
    q = dual_quaternion.normalize(p[..., :8], check=False)
    r, d = dual_quaternion.to_rotation_translation(q, check=False)
    return _assemble(quaternion.to_matrix(r, check=False), _square(p[..., 8:]), d)


def _sign(psi: Callable[[Array], Array], n: int) -> Callable[[Array, Array], Array]:
    """The one of the two quaternions that is nearer."""

    def near(A: Array, reference: Array) -> Array:
        p = psi(A)
        p[:n] *= np.copysign(1.0, p[:4] @ reference[:4])
        return p

    return near


def _grassia_psi(A: Array) -> Array:
    R, S, d = _split(A)
    return np.concatenate([so3.log(R, check=False), d, S], axis=-1)


def _grassia_phi(p: Array) -> Array:
    return _assemble(so3.exp(p[..., :3], check=False), _square(p[..., 6:]), p[..., 3:6])


def _grassia_near(A: Array, reference: Array) -> Array:
    R, S, d = _split(A)
    return np.concatenate([so3.log_near(R, reference[:3], check=False)[0], d, S])


def _alexa_psi(A: Array) -> Array:
    return aff.log(A, check=False)[..., :3, :].reshape(*A.shape[:-2], 12)


def _alexa_phi(p: Array) -> Array:
    X = np.zeros((*p.shape[:-1], 4, 4))
    X[..., :3, :] = p.reshape(*p.shape[:-1], 3, 4)
    return aff.exp(X, check=False)


def _alone(psi: Callable[[Array], Array]) -> Callable[[Array, Array], Array]:
    """There is one branch only."""
    return lambda A, reference: psi(A)


def _so_psi(A: Array) -> Array:
    return affine.psi_so(A, check=False)


def _so_phi(p: Array) -> Array:
    return affine.phi_so(p, check=False)


def _se_psi(A: Array) -> Array:
    return affine.psi_se(A, check=False)


def _se_phi(p: Array) -> Array:
    return affine.phi_se(p, check=False)


def printed_psi(A: Array) -> Array:
    """Return the parameters of `affine.psi_so` by the formulas as printed: polar decomposition by A^T A."""
    L = A[..., :3, :3]
    Y = 0.5 * printed.sym_log(np.swapaxes(L, -1, -2) @ L)
    R = L @ printed.sym_exp(-Y)
    upper = [Y[..., i, j, None] for i in range(3) for j in range(i, 3)]
    return np.concatenate([so3.log(R, check=False), A[..., :3, 3], *upper], axis=-1)


def newton_psi(A: Array) -> Array:
    """Return the same by Newton's polar decomposition, as section 4.4 of the paper advises."""
    R, S = printed.newton_polar(A[..., :3, :3])
    Y = sym.log(S, check=False)
    upper = [Y[..., i, j, None] for i in range(3) for j in range(i, 3)]
    return np.concatenate([so3.log(R, check=False), A[..., :3, 3], *upper], axis=-1)


def careless_log(A: Array) -> Array:
    """Return the real part of the complex logarithm: what a program gets that never asks for a real one."""
    w, P = np.linalg.eig(A)
    L = P @ (np.log(w.astype(complex))[..., None] * np.linalg.inv(P))
    return np.real(L)[..., :3, :].reshape(*A.shape[:-2], 12)


def _unchecked(f: Callable[..., Array]) -> Callable[[Array], Array]:
    return lambda x: f(x, check=False)


METHODS = (
    Method("Ours", "phi_so", _so_psi, _so_phi, affine.psi_so_near),
    Method("Ours, by se(3)", "phi_se", _se_psi, _se_phi, affine.psi_se_near),
    Method("Alexa/SAM", "alexa", _alexa_psi, _alexa_phi, _alone(_alexa_psi)),
    Method("Polar+DQ", "polar_dual_quaternion", _dual_psi, _dual_phi, _sign(_dual_psi, 8)),
    Method("Polar+Grassia", "grassia", _grassia_psi, _grassia_phi, _grassia_near),
    Method(
        "Polar+quaternion", "polar_quaternion", _quaternion_psi, _quaternion_phi, _sign(_quaternion_psi, 4)
    ),
    Method("Linear", "linear", _linear_psi, _linear_phi, _alone(_linear_psi)),
)

SYMMETRIC: Mapping[str, tuple[Callable[[Array], Array], Callable[[Array], Array]]] = {
    "Ours": (_unchecked(sym.exp), _unchecked(sym.log)),
    "Ours, as printed": (printed.sym_exp, printed.sym_log),
    "Higham": (printed.higham_exp, printed.higham_log),
    "Diag": (printed.diagonal_exp, printed.diagonal_log),
}
"""The ways of Table 1: exp and log of symmetric matrices."""
