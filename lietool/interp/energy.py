"""How far a map B is from the map A that it should be: E^P, E^F, E^S, E^R as quadratic forms.

With B acting as z -> beta z + gamma conj(z), and x = (beta, gamma), a = (those of A), all four are given by a
Hermitian 2 x 2 matrix G of the triangle:

    rigid          (x - a)* G (x - a)                      E^F, E^P        kernel: x = a only
    similarity     x* G x - |a* G x|^2 / (a* G a)          E^R, E^S        kernel: x = w a, w complex

for the least over all multiples w = s e^(i delta) is the distance from a line.
G = 2 I measures maps by the Frobenius norm (E^F and E^R); G from the moments of the corners p_k about their
centroid measures them by what they do to the corners (E^P and E^S).

Taken from a fixed origin, as printed, E^P and E^S would depend on where the shape lies.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import triangle
from lietool.lie import checks

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Energy:
    """Which error is summed over the triangles.

    Parameters
    ----------
    metric : {"frobenius", "points"}
        Maps are compared by their entries, or by where they take a triangle's corners.
    rigid : float or ndarray, shape (m,)
        The share w of the rigid error, 0 to 1; the rest is that of similarities.
    """

    metric: str
    rigid: float | Array = 1.0

    @property
    def is_rigid(self) -> bool:
        """Whether nothing is forgiven: the form does not depend on the maps, and so not on time."""
        return bool(np.all(np.asarray(self.rigid) == 1.0))

    @property
    def is_similarity(self) -> bool:
        """Whether rotations and dilations of every triangle cost nothing."""
        return bool(np.all(np.asarray(self.rigid) == 0.0))


POINT = Energy("points", 1.0)
"""E^P, (6.1): distances of the corners."""

FROBENIUS = Energy("frobenius", 1.0)
"""E^F, (6.2): Frobenius norm (Alexa 2000)."""

POINT_SIMILARITY = Energy("points", 0.0)
"""E^S, (6.3): distances of the corners, up to similarity (Werman and Weinshall 1995)."""

SIMILARITY = Energy("frobenius", 0.0)
"""E^R, (6.4): Frobenius norm, up to similarity."""


def balanced(w: float | ArrayLike) -> Energy:
    """Return w E^F + (1-w) E^R, with one w for all triangles or one for each.

    Book: 6.4 (ii)

    Raises
    ------
    ValueError
        If w is not between 0 and 1.
    """
    share = checks.array("energy.balanced", "w", w, ())
    if not np.all((share >= 0.0) & (share <= 1.0)):
        index = checks.first(~((share >= 0.0) & (share <= 1.0)))
        checks.fail("energy.balanced", "w", "0 to 1", f"{float(share[index]):g}", index)
    return Energy("frobenius", share if share.ndim else float(share))


@dataclass(frozen=True, eq=False)
class Metric:
    """The Hermitian matrices G = [[p, q], [conj q, p]] of triangles; p real and q complex, shape (m,)."""

    p: Array
    q: Complex

    def times(self, x: Complex) -> Complex:
        """Return G x for x (2, m)."""
        return np.stack([self.p * x[0] + self.q * x[1], np.conj(self.q) * x[0] + self.p * x[1]])

    def scaled(self, weights: Array) -> "Metric":
        """Return the matrices times a number for each triangle."""
        return Metric(weights * self.p, weights * self.q)


def metric(energy: Energy, corners: Array) -> Metric:
    """Return the matrix G of each triangle, given its corners (m, 3, 2)."""
    if energy.metric == "frobenius":
        return Metric(np.full(len(corners), 2.0), np.zeros(len(corners), complex))
    p = corners[..., 0] + 1j * corners[..., 1]
    p = p - p.mean(axis=-1, keepdims=True)
    # |beta p + gamma conj p|^2 has the mixed term conj(beta) gamma conj(p)^2.
    return Metric(np.sum(np.abs(p) ** 2, axis=-1), np.sum(np.conj(p) ** 2, axis=-1))


@dataclass(frozen=True, eq=False)
class Form:
    """The error x* Q x - 2 Re(x* r) + c, with x, r (2, m) and Q = [[first, mixed], [conj mixed, second]]."""

    first: Array
    second: Array
    mixed: Complex
    r: Complex
    c: Array

    def at(self, x: Complex) -> Array:
        """Return the error (m,); the exact value is never negative, rounding may leave it so."""
        square = self.first * _square(x[0]) + self.second * _square(x[1])
        cross = np.conj(x[0]) * self.mixed * x[1] - np.conj(x[0]) * self.r[0] - np.conj(x[1]) * self.r[1]
        return np.maximum(square + 2.0 * cross.real + self.c, 0.0)


def form(energy: Energy, G: Metric, a: Complex) -> Form:
    """Return the error of triangles as a form in the coordinates of a map.

    Parameters
    ----------
    energy : Energy
    G : Metric
    a : ndarray of complex, shape (2, m)
        The coordinates of the maps to be reached.
    """
    w = np.asarray(energy.rigid, float)
    Ga = G.times(a)
    size = (np.conj(a[0]) * Ga[0] + np.conj(a[1]) * Ga[1]).real
    first, second, mixed = G.p, G.p, G.q
    if not energy.is_rigid:
        forgiven = (1.0 - w) / size
        first, second = G.p - forgiven * _square(Ga[0]), G.p - forgiven * _square(Ga[1])
        mixed = G.q - forgiven * Ga[0] * np.conj(Ga[1])
    return Form(first, second, mixed, w * Ga, w * size)


def error(B: ArrayLike, A: ArrayLike, energy: Energy = FROBENIUS, corners: ArrayLike | None = None) -> Array:
    """Return the error of maps, one for each triangle, without its weight.

    Book: (6.1), (6.2), (6.3), (6.4), (6.5)

    Parameters
    ----------
    B : (..., 2, 2)
        The maps that are judged.
    A : (..., 2, 2)
        The maps that they should be.
    energy : Energy
    corners : (..., 3, 2), optional
        Of the triangles; needed where maps are compared by them.

    Returns
    -------
    E : (...)

    Raises
    ------
    ValueError
        If a shape is wrong, or the corners are needed and missing.
    """
    B = checks.array("energy.error", "B", B, (2, 2))
    A = checks.array("energy.error", "A", A, (2, 2))
    shape = np.broadcast_shapes(A.shape[:-2], B.shape[:-2])
    if energy.metric == "points" and corners is None:
        checks.fail("energy.error", "corners", "given for an error of points", "None", None)
    p = checks.array("energy.error", "corners", np.zeros((3, 2)) if corners is None else corners, (3, 2))
    p = np.broadcast_to(p, (*shape, 3, 2)).reshape(-1, 3, 2)
    x, a = (
        np.stack(triangle.coordinates(np.broadcast_to(M, (*shape, 2, 2)).reshape(-1, 2, 2))) for M in (B, A)
    )
    return form(energy, metric(energy, p), a).at(x).reshape(shape)


def _square(z: Complex) -> Array:
    return z.real**2 + z.imag**2
