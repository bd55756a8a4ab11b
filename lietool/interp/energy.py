"""How far a map B is from the map A that it should be: E^P, E^F, E^S, E^R as the quadratic forms that they are.

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


def metric(energy: Energy, corners: Array) -> Complex:
    """Return the matrix G of each triangle, given its corners (m, 3, 2); shape (m, 2, 2)."""
    G = np.zeros((len(corners), 2, 2), complex)
    if energy.metric == "frobenius":
        G[:, 0, 0] = G[:, 1, 1] = 2.0
        return G
    p = corners[..., 0] + 1j * corners[..., 1]
    p = p - p.mean(axis=-1, keepdims=True)
    G[:, 0, 0] = G[:, 1, 1] = np.sum(np.abs(p) ** 2, axis=-1)
    # |beta p + gamma conj p|^2 has the mixed term conj(beta) gamma conj(p)^2.
    G[:, 0, 1] = np.sum(np.conj(p) ** 2, axis=-1)
    G[:, 1, 0] = np.conj(G[:, 0, 1])
    return G


def form(energy: Energy, G: Complex, A: Complex) -> Complex:
    """Return the Hermitian matrix Q of the error x* Q x - 2 Re(x* r) + c; shape (..., m, 2, 2).

    Parameters
    ----------
    energy : Energy
    G : (m, 2, 2)
        From `metric`.
    A : (..., m, 2)
        The coordinates of the maps to be reached.
    """
    if energy.is_rigid:
        return G
    Ga = np.einsum("mij,...mj->...mi", G, A)
    size = np.sum(np.conj(A) * Ga, axis=-1).real
    forgiven = Ga[..., :, None] * np.conj(Ga[..., None, :]) / size[..., None, None]
    return G - (1.0 - _column(energy.rigid, 2)) * forgiven


def pull(energy: Energy, G: Complex, A: Complex) -> tuple[Complex, Array]:
    """Return r (..., m, 2) and c (..., m) of the error x* Q x - 2 Re(x* r) + c."""
    w = np.asarray(energy.rigid, float)
    Ga = np.einsum("mij,...mj->...mi", G, A)
    return _column(w, 1) * Ga, w * np.sum(np.conj(A) * Ga, axis=-1).real


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
        np.stack(triangle.coordinates(np.broadcast_to(M, (*shape, 2, 2)).reshape(-1, 2, 2)), axis=-1)
        for M in (B, A)
    )
    G = metric(energy, p)
    r, c = pull(energy, G, a)
    Q = form(energy, G, a)
    value = np.einsum("mi,mij,mj->m", np.conj(x), Q, x).real - 2.0 * np.sum(np.conj(x) * r, axis=-1).real + c
    # The exact value is never negative; rounding may leave it so.
    return np.maximum(value, 0.0).reshape(shape)


def _column(w: float | Array, axes: int) -> Array:
    w = np.asarray(w, float)
    return w.reshape(*w.shape, *(1,) * axes)
