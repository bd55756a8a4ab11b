"""Which functions are measured, on which inputs, and what is promised of them: one line each."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.bench import exact
from lietool.lie import affine, dual_quaternion, polar, quaternion, se2, se3, so2, so3, sym

Array = NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Promise:
    """The largest error that is promised, for each element of a batch, and how that is written."""

    text: str
    allowed: Callable[[Array], Array]


@dataclass(frozen=True)
class Subject:
    """A function that is measured.

    Parameters
    ----------
    name : str
        As it is called; a round trip says what it does.
    inputs : str
        A family of `inputs`.
    ours : callable
        From a batch to its blocks, such as rotation and translation.
    exact : callable
        From one element to all values that are right, in the same blocks.
    promise : Promise, optional
    least : float
        Errors are relative to the norm of the result, or to this if that is larger.
    """

    name: str
    inputs: str
    ours: Callable[[Array], tuple[Array, ...]]
    exact: Callable[..., list[exact.Value]]
    promise: Promise | None = None
    least: float = 0.0


def _norm(Y: Array) -> Array:
    return np.max(np.abs(np.linalg.eigvalsh(Y)), axis=-1)


def _few_ulps(x: Array) -> Array:
    return np.full(len(x), 1e-15)


def _sym_exp(Y: Array) -> Array:
    return 1e-15 * np.maximum(1.0, _norm(Y))


def _sym_log(S: Array) -> Array:
    # The eigenvalues of a rounded matrix of condition 1e12 are far more accurate than this needs.
    d = np.linalg.eigvalsh(S)
    logs = np.linalg.norm(np.log(d), axis=-1)
    # Absolute, as promised, over what the error is relative to.
    return (EPS * d[:, -1] / d[:, 0] + 3e-15 * np.maximum(1.0, logs)) / np.maximum(1.0, logs)


def _round_trip(A: Array) -> Array:
    # A third of log det A: the mean logarithm of the singular values.
    _, log_det = np.linalg.slogdet(A[:, :3, :3])
    return 4e-15 * np.maximum(1.0, np.abs(log_det) / 3.0)


ULPS = Promise("1e-15", _few_ulps)
SYM_EXP = Promise("1e-15 max(1, |Y|)", _sym_exp)
SYM_LOG = Promise("eps cond + 3e-15 max(1, |log S|)", _sym_log)
PSI = Promise("4e-15 max(1, |log scale|)", _round_trip)
BEYOND = ("angle to 2 pi",)
"""Classes of which nothing is promised."""


def _one(f: Callable[[Array], Array]) -> Callable[[Array], tuple[Array, ...]]:
    return lambda x: (f(x),)


def _parts(f: Callable[[Array], Array]) -> Callable[[Array], tuple[Array, ...]]:
    """Rotation and translation of homogeneous matrices."""

    def both(x: Array) -> tuple[Array, ...]:
        T = f(x)
        return T[..., :-1, :-1], T[..., :-1, -1]

    return both


def _cut(f: Callable[[Array], Array], k: int) -> Callable[[Array], tuple[Array, ...]]:
    """The first k numbers, and the others."""

    def both(x: Array) -> tuple[Array, ...]:
        y = f(x)
        return y[..., :k], y[..., k:]

    return both


SUBJECTS = (
    Subject("so2.exp", "angles", _one(so2.exp), exact.so2_exp, ULPS),
    Subject("so2.log", "plane_rotations", _one(so2.log), exact.so2_log, ULPS),
    Subject("so3.exp", "vectors", _one(so3.exp), exact.so3_exp, ULPS),
    Subject("so3.log", "rotations", _one(so3.log), exact.so3_log, ULPS),
    Subject("so3.left_jacobian", "vectors", _one(so3.left_jacobian), exact.so3_left_jacobian),
    Subject(
        "so3.left_jacobian_inverse",
        "vectors",
        _one(so3.left_jacobian_inverse),
        exact.so3_left_jacobian_inverse,
    ),
    Subject("se2.exp", "plane_twists", _parts(se2.exp), exact.se2_exp, ULPS),
    Subject("se2.log", "plane_rigid", _cut(se2.log, 1), exact.se2_log, ULPS),
    Subject("se3.exp", "twists", _parts(se3.exp), exact.se3_exp, ULPS),
    Subject("se3.log", "rigid", _cut(se3.log, 3), exact.se3_log, ULPS),
    Subject("quaternion.exp", "vectors", _one(quaternion.exp), exact.quaternion_exp),
    Subject("quaternion.log", "unit_quaternions", _one(quaternion.log), exact.quaternion_log),
    Subject(
        "quaternion.from_matrix", "rotations", _one(quaternion.from_matrix), exact.quaternion_from_matrix
    ),
    Subject("dual_quaternion.exp", "twists", _cut(dual_quaternion.exp, 4), exact.dual_quaternion_exp),
    Subject("sym.exp (2 x 2)", "plane_symmetric", _one(sym.exp), exact.sym_exp, SYM_EXP),
    Subject("sym.exp (3 x 3)", "symmetric", _one(sym.exp), exact.sym_exp, SYM_EXP),
    Subject("sym.log (2 x 2)", "plane_definite", _one(sym.log), exact.sym_log, SYM_LOG, least=1.0),
    Subject("sym.log (3 x 3)", "definite", _one(sym.log), exact.sym_log, SYM_LOG, least=1.0),
    Subject("sym.sqrt", "definite", _one(sym.sqrt), exact.sym_sqrt),
    Subject("polar.decompose", "linear", polar.decompose, exact.polar_decompose),
    Subject("affine.phi_so", "parameters", _parts(affine.phi_so), exact.phi_so),
    Subject("affine.phi_se", "parameters", _parts(affine.phi_se), exact.phi_se),
    Subject(
        "phi_so(psi_so(A))",
        "affine",
        _parts(lambda A: affine.phi_so(affine.psi_so(A))),
        exact.affine_itself,
        PSI,
    ),
    Subject(
        "phi_se(psi_se(A))",
        "affine",
        _parts(lambda A: affine.phi_se(affine.psi_se(A))),
        exact.affine_itself,
        PSI,
    ),
)
