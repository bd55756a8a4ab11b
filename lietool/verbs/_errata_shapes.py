"""Errata about energies and the equation of Poisson, with counterexamples of a few triangles."""

import numpy as np
from numpy.typing import NDArray

from lietool.interp import energy
from lietool.lie import so2
from lietool.verbs._errata import Erratum, Outcome, erratum, outcome

Array = NDArray[np.float64]
SHAPES: list[Erratum] = []
J = np.array([[0.0, -1.0], [1.0, 0.0]])


def _hessian(A: Array) -> Array:
    """Return the Hessian of E^R in the entries of B: twice the projection away from s R_delta A, (6.5)."""
    a, b = A.ravel(), (J @ A).ravel()
    return 2.0 * (np.eye(4) - (np.outer(a, a) + np.outer(b, b)) / (a @ a))


def _second_differences(A: Array) -> Array:
    """Return the Hessian of E^R from values alone; of a quadratic form they are exact but for rounding."""
    unit = np.eye(4).reshape(4, 2, 2)
    single = energy.error(unit, A, energy.SIMILARITY)
    return energy.error(unit[:, None] + unit, A, energy.SIMILARITY) - single[:, None] - single


@erratum(
    SHAPES,
    "B 6.3 (text)",
    printed="G does not depend on time",
    true="for E^P and E^F; for E^S and E^R it does",
    why="the best similarity is sought among s R_delta A_i(t), and that plane turns with A_i(t)",
    example="E^R, A(0) = I and A(1) = R(1) diag(3, 1/2): distance of the two Hessians, printed 0",
)
def time_in_the_matrix() -> Outcome:
    start, end = np.eye(2), so2.exp(np.array(1.0)) @ np.diag([3.0, 0.5])
    apart = float(np.linalg.norm(_second_differences(end) - _second_differences(start)))
    rest = np.linalg.norm(_second_differences(end) - _hessian(end))
    return Outcome(0.0, apart, apart, float(rest))


def _minimiser(P: Array, central: bool) -> Array:
    """Minimise E^P over two triangles with a common edge; return the edges from the first vertex."""
    maps = (np.diag([2.0, 1.0]), so2.exp(np.array(0.8)))
    rows, rhs = [], []
    for triangle, A in zip(([0, 1, 2], [0, 2, 3]), maps, strict=True):
        p = P[triangle]
        # B = (v1 - v0, v2 - v0)(p1 - p0, p2 - p0)^-1: B p is a combination of the v, alike in x and y.
        inverse = np.linalg.inv(np.stack([p[1] - p[0], p[2] - p[0]], axis=-1))
        for point in p - p.mean(axis=0) if central else p:
            row = np.zeros(4)
            row[triangle[1:]] = inverse @ point
            rows.append(row[1:])
            rhs.append(A @ point)
    return np.linalg.lstsq(np.array(rows), np.array(rhs), rcond=None)[0]


@erratum(
    SHAPES,
    "B 6.1, 6.3",
    printed="sum of |B p_k - A p_k|^2 over the vertices p_k as they lie",
    true="the same with p_k relative to the triangle's centroid",
    why="a linear map errs in proportion to the distance from the origin, which means nothing here",
    example="two triangles, then the same moved by (5, 3): change of the edges of the minimiser",
    also=("B 6.1", "B 6.3"),
)
def where_the_shape_lies() -> Outcome:
    P = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    moved = P + np.array([5.0, 3.0])
    printed = float(np.linalg.norm(_minimiser(P, False) - _minimiser(moved, False)))
    true = float(np.linalg.norm(_minimiser(P, True) - _minimiser(moved, True)))
    return Outcome(printed, true, printed - true, true)


@erratum(
    SHAPES,
    "B 6.5",
    printed="positive definite in the entries of B",
    true="positive semi-definite; it vanishes on the plane of the s R_delta A",
    why="a similarity costs nothing: that is what the energy is for",
    example="A = R(1) diag(3, 1/2): eigenvalues of the Hessian; the error is the dimension of the kernel",
)
def kernel() -> Outcome:
    A = so2.exp(np.array(1.0)) @ np.diag([3.0, 0.5])
    d = np.linalg.eigvalsh(_second_differences(A))
    inside = float(energy.error(1.7 * so2.exp([0.0, 0.4, 2.0]) @ A, A, energy.SIMILARITY).max())
    rest = max(float(np.linalg.norm(d - [0.0, 0.0, 2.0, 2.0])), inside)
    return Outcome(float("nan"), np.array(d, dtype=float), float(np.sum(d < 1.0)), rest)


@erratum(
    SHAPES,
    "B A.3 (text)",
    printed="the s R_delta are a space of skew-symmetric matrices",
    true="they are the span of I and J, the complex numbers",
    why="s R_0 = s I is symmetric; only the multiples of J are skew",
    example="I + I^T, which would have to be 0",
)
def similarities() -> Outcome:
    one = np.eye(2)
    z, w = 0.6 - 1.1j, -0.4 + 0.3j
    product = (z.real * one + z.imag * J) @ (w.real * one + w.imag * J)
    rest = np.linalg.norm(product - ((z * w).real * one + (z * w).imag * J))
    return Outcome(np.zeros((2, 2)), one + one.T, float(np.linalg.norm(one + one.T)), float(rest))


@erratum(
    SHAPES,
    "B 7.13",
    printed="(div v)(p_i) = + sum of grad B_ik . v |T_k|",
    true="minus the sum; or let A be the positive stiffness matrix",
    why="integrate by parts: the hat function falls where the field flows outwards",
    example="f = (x^2 + y^2) / 2 on the six triangles round the origin: its Laplacian, per area, is 2",
)
def divergence() -> Outcome:
    angle = np.arange(6) * np.pi / 3
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    total = area = 0.0
    for p, q in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        edges = np.stack([p, q])
        size = 0.5 * float(np.linalg.det(edges))
        hat = np.linalg.solve(edges, [-1.0, -1.0])  # 1 at the origin, 0 at p and q
        v = np.linalg.solve(edges, [0.5 * p @ p, 0.5 * q @ q])  # grad f
        total += float(hat @ v) * size
        area += size / 3.0
    return outcome(total / area, -total / area, 2.0)
