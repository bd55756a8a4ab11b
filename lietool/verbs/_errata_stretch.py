"""Errata about decompositions and the parametrisation of affine maps, each with its counterexample."""

import numpy as np
from numpy.typing import NDArray

from lietool.interp import triangle
from lietool.lie import affine, polar, so3, sym
from lietool.verbs._errata import Erratum, Outcome, erratum, outcome

Array = NDArray[np.float64]
PI = np.pi
DECOMPOSITIONS: list[Erratum] = []
PARAMETERS: list[Erratum] = []


@erratum(
    DECOMPOSITIONS,
    "B 3.13 (text)",
    printed="X = R D R^T leaves only the order of the eigenvalues free",
    true="the signs of the columns of R are free too, in pairs",
    why="if e is an eigenvector, so is -e; changing two columns keeps det R = 1",
    example="the same X and D with R and with R diag(-1, -1, 1): distance of the two rotations, printed 0",
    also=("B 3.13",),
)
def signs_of_the_columns() -> Outcome:
    R, D = so3.exp(np.array([0.3, 0.4, 0.5])), np.diag([3.0, 2.0, 1.0])
    other = R @ np.diag([-1.0, -1.0, 1.0])
    apart = float(np.linalg.norm(R - other))
    return Outcome(0.0, apart, apart, float(np.linalg.norm(other @ D @ other.T - R @ D @ R.T)))


@erratum(
    DECOMPOSITIONS,
    "B 3.3.3 (text)",
    printed="A = (R'R) D R",
    true="A = (R'R) D R^T",
    why="A = R'S and S = R D R^T",
    example="a random A with det A > 0 (seed 1)",
)
def last_factor() -> Outcome:
    A = np.random.default_rng(1).normal(size=(3, 3))
    A[:, 0] *= np.sign(np.linalg.det(A))
    R1, S = polar.decompose(A)
    d, R = np.linalg.eigh(S)
    R[:, 0] *= np.linalg.det(R)
    return outcome(R1 @ R @ np.diag(d) @ R, R1 @ R @ np.diag(d) @ R.T, A)


@erratum(
    DECOMPOSITIONS,
    "B 5.2 (text)",
    printed="S^P(t) = (1 - t) I + t S may be degenerate",
    true="for t outside [0, 1] only",
    why="positive definite matrices are convex: no eigenvalue sinks below those of both ends",
    example="S = diag(0.2, 3): least eigenvalue on [0, 1], printed 0; it is 0 at t = 1.25",
)
def convex() -> Outcome:
    S = np.diag([0.2, 3.0])
    least = float(np.min(np.linalg.eigvalsh(triangle.arap(S, np.linspace(0.0, 1.0, 101)))))
    beyond = float(np.min(np.abs(np.linalg.eigvalsh(triangle.arap(S, 1.25)))))
    return Outcome(0.0, least, least, beyond)


def _polynomial(Y: Array, a: float, b: float, c: float) -> Array:
    return a * np.eye(3) + b * Y + c * Y @ Y


@erratum(
    DECOMPOSITIONS,
    "M (4) distinct",
    printed="c = s + t + u, with the t and u above it",
    true="c = s - t - u",
    why="two factors in the denominators of t and u are the wrong way round; a and b allow for it",
    example="Y = diag(1, 0, -1); the error is relative",
    also=("M 4",),
)
def three_eigenvalues() -> Outcome:
    l1, l2, l3 = 1.0, 0.0, -1.0
    Y = np.diag([l1, l2, l3])
    s = np.exp(l1) / (l1 - l2) / (l1 - l3)
    t = np.exp(l2) / (l2 - l3) / (l1 - l2)
    u = np.exp(l3) / (l2 - l3) / (l3 - l1)
    a = s * l2 * l3 - t * l3 * l1 - u * l1 * l2
    b = -s * (l2 + l3) + t * (l3 + l1) + u * (l1 + l2)
    printed, true = _polynomial(Y, a, b, s + t + u), _polynomial(Y, a, b, s - t - u)
    found, size = outcome(printed, true, sym.exp(Y)), float(np.linalg.norm(true))
    return Outcome(printed, true, found.error / size, found.rest / size)


@erratum(
    DECOMPOSITIONS,
    "M (4) two equal",
    printed="a = s - t, b = t l2 - s l3",
    true="a = t l2 - s l3, b = s - t",
    why="the slope of the line through the two values stands at Y, what is left at I; they are exchanged",
    example="Y = diag(1, 1, -1/2)",
    also=("M 4",),
)
def two_eigenvalues() -> Outcome:
    l2, l3 = 1.0, -0.5
    Y = np.diag([l2, l2, l3])
    s, t = np.exp(l2) / (l2 - l3), np.exp(l3) / (l2 - l3)
    slope, rest = s - t, t * l2 - s * l3
    return outcome(_polynomial(Y, slope, rest, 0.0), _polynomial(Y, rest, slope, 0.0), sym.exp(Y))


def _rigid(R: Array) -> Array:
    A = np.eye(4)
    A[:3, :3] = R
    return A


@erratum(
    PARAMETERS,
    "M (5)",
    printed="sum of phi(w_i psi(A_i))",
    true="phi(sum of w_i psi(A_i))",
    why="parameters may be added, transformations not: the sum of two rotations is none",
    example="Rx(1) and Ry(2) with weights 1/2: the linear part's |R^T R - I|",
    also=("M 5",),
)
def sum_outside() -> Outcome:
    psi = affine.psi_so(np.stack([_rigid(so3.rotation("x", 1.0)), _rigid(so3.rotation("y", 2.0))]))
    printed = affine.phi_so(0.5 * psi).sum(axis=0)[:3, :3]
    true = affine.phi_so(0.5 * psi.sum(axis=0))[:3, :3]
    error = np.linalg.norm(printed.T @ printed - np.eye(3))
    return Outcome(printed, true, float(error), float(np.linalg.norm(true.T @ true - np.eye(3))))


@erratum(
    PARAMETERS,
    "B 7.9, M 5",
    printed="phi(sum w_i psi(A_i)) v, with the origin wherever it lies",
    true="take the origin at the probe, or name it: the result depends on it",
    why="phi_so moves the origin on a straight line; so does phi_se as soon as there is stretch",
    example="a quarter turn about a probe at (10, 0, 0), weight 1/2, the point (11, 0, 0)",
    also=("B 7.9", "M 5"),
)
def no_origin() -> Outcome:
    to, p = np.eye(4), np.array([11.0, 0.0, 0.0, 1.0])
    to[0, 3] = 10.0
    back = np.linalg.inv(to)
    A = to @ _rigid(so3.rotation("z", PI / 2)) @ back
    printed = affine.phi_so(0.5 * affine.psi_so(A)) @ p
    true = to @ affine.phi_so(0.5 * affine.psi_so(back @ A @ to)) @ back @ p
    half = to @ _rigid(so3.rotation("z", PI / 4)) @ back @ p
    # Without stretch phi_se needs no origin; with it, it does.
    rigid = affine.phi_se(0.5 * affine.psi_se(A)) @ p
    stretched = to @ _rigid(so3.rotation("z", PI / 2) @ np.diag([2.0, 1.0, 1.0])) @ back
    near = to @ affine.phi_se(0.5 * affine.psi_se(back @ stretched @ to)) @ back @ p
    if np.linalg.norm(affine.phi_se(0.5 * affine.psi_se(stretched)) @ p - near) < 1.0:
        raise ArithmeticError("errata: phi_se must depend on the origin where there is stretch")
    rest = max(float(np.linalg.norm(true - half)), float(np.linalg.norm(rigid - half)))
    return Outcome(printed[:3], true[:3], float(np.linalg.norm(printed - true)), rest)


@erratum(
    PARAMETERS,
    "K Table 2",
    printed="columns phi, psi; the error is that of psi(phi(X)), X a matrix",
    true="the columns are exchanged; the error is that of phi(psi(X))",
    why="the costly polar decomposition is part of psi; and psi(phi(x)) returns the principal branch",
    example="the parameter of a rotation by 4 about z: psi(phi(x)) is 2 pi away",
)
def columns() -> Outcome:
    x = np.zeros(12)
    x[2], x[3:6], x[6:] = 4.0, (1.0, 2.0, 3.0), (0.3, 0.1, 0.0, -0.2, 0.1, 0.4)
    A = affine.phi_so(x)
    back = affine.psi_so(A)
    rest = np.linalg.norm(affine.phi_so(back) - A)
    return Outcome(back[:3], x[:3], float(np.linalg.norm(back - x)), float(rest))
