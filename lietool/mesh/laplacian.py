"""The differential operators of a triangle mesh in space: stiffness, mass, gradient, divergence.

They are those of functions that are linear on each triangle (Pinkall and Polthier 1993).  Edges with more
than two triangles, boundaries and several components need nothing of their own: every triangle adds its part.
A triangle of area 0 has no cotangents and is refused by name.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

FLAT = 1e-14
"""Twice the area of a triangle over the square of its longest edge, below which its normal is rounding."""


def cotangent(V: ArrayLike, F: ArrayLike) -> Any:
    """Return the stiffness matrix: x^T L x is the Dirichlet energy, the integral of |grad x|^2.

    Book: (7.14), the matrix A.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    L : sparse array by columns, shape (n, n)
        Symmetric, positive semi-definite; rows sum to 0.

    Raises
    ------
    ValueError
        If V or F is none, or a triangle has area 0.
    """
    from scipy.sparse import csc_array

    V, F = checked("laplacian.cotangent", V, F)
    half = 0.5 * cotangents(V, F)
    # The cotangent at a corner belongs to the edge opposite to it.
    i, j = F[:, [1, 2, 0]], F[:, [2, 0, 1]]
    row = np.concatenate([i, j, i, j]).ravel()
    column = np.concatenate([j, i, i, j]).ravel()
    data = np.concatenate([-half, -half, half, half]).ravel()
    return csc_array((data, (row, column)), (len(V), len(V)))


def cotangents(V: Array, F: Index) -> Array:
    """Return the cotangents (m, 3) of the angles at the corners of triangles that are none of them flat."""
    corner = V[F]
    u, v = np.roll(corner, -1, axis=1) - corner, np.roll(corner, -2, axis=1) - corner
    double = np.linalg.norm(np.cross(u[:, 0], v[:, 0]), axis=1)
    return np.einsum("...i,...i->...", u, v) / double[:, None]


def mass(V: ArrayLike, F: ArrayLike) -> Array:
    """Return the lumped masses: a third of the area of the triangles round each vertex.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    M : ndarray, shape (n,)
        0 where no triangle uses the vertex.

    Raises
    ------
    ValueError
        If V or F is none.
    """
    V, F = checked("laplacian.mass", V, F, flat=True)
    third = np.linalg.norm(topology.area_normals(V, F), axis=1) / 6.0
    return np.bincount(F.ravel(), np.repeat(third, 3), len(V)).astype(float, copy=False)


def voronoi_mass(V: ArrayLike, F: ArrayLike) -> Array:
    """Return the lumped masses of Voronoi cells: what of each triangle is nearest to each of its corners.

    In obtuse triangles half of the area goes to the obtuse corner and a quarter to the others (Meyer,
    Desbrun, Schroeder and Barr 2003), so that no mass is negative.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    M : ndarray, shape (n,)
        0 where no triangle uses the vertex.

    Raises
    ------
    ValueError
        If V or F is none, or a triangle has area 0.
    """
    V, F = checked("laplacian.voronoi_mass", V, F)
    cot, corner = cotangents(V, F), V[F]
    edge = np.roll(corner, -2, axis=1) - np.roll(corner, -1, axis=1)  # opposite to each corner
    square = cot * np.einsum("fki,fki->fk", edge, edge)
    # The perpendicular bisectors cut an eighth of cot |e|^2 off at both ends of an edge.
    share = (square.sum(axis=1, keepdims=True) - square) / 8.0
    area = 0.5 * np.linalg.norm(topology.area_normals(V, F), axis=1)[:, None]
    obtuse = (cot < 0.0).any(axis=1, keepdims=True)
    share = np.where(obtuse, np.where(cot < 0.0, area / 2.0, area / 4.0), share)
    return np.bincount(F.ravel(), share.ravel(), len(V)).astype(float, copy=False)


def gradient(V: ArrayLike, F: ArrayLike) -> Any:
    """Return the matrix G with (G @ x).reshape(m, 3) the gradients of x, one in each triangle.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    G : sparse array by rows, shape (3 m, n)
        Row 3 f + a is the coordinate a of the gradient in triangle f.

    Raises
    ------
    ValueError
        If V or F is none, or a triangle has area 0.
    """
    from scipy.sparse import csr_array

    V, F = checked("laplacian.gradient", V, F)
    normal = topology.area_normals(V, F)
    # The gradient of the function that is 1 at a corner: the opposite edge, turned by a quarter.
    edge = V[F[:, [2, 0, 1]]] - V[F[:, [1, 2, 0]]]
    hat = np.cross(normal[:, None], edge) / np.einsum("fi,fi->f", normal, normal)[:, None, None]
    m = len(F)
    return csr_array(
        (hat.transpose(0, 2, 1).ravel(), np.repeat(F, 3, axis=0).ravel(), np.arange(0, 9 * m + 1, 3)),
        (3 * m, len(V)),
    )


def divergence(V: ArrayLike, F: ArrayLike) -> Any:
    """Return the matrix of the integrated divergence of a vector field that is constant in each triangle.

    It is minus the transposed gradient, weighted with areas, so that divergence @ gradient = -cotangent: the
    Poisson equation for a field u reads cotangent @ x = -divergence @ u.

    Book: (7.13), where the sign is the other one.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    D : sparse array by rows, shape (n, 3 m)

    Raises
    ------
    ValueError
        If V or F is none, or a triangle has area 0.
    """
    from scipy.sparse import csr_array

    V, F = checked("laplacian.divergence", V, F)
    G = gradient(V, F)
    area = 0.5 * np.linalg.norm(topology.area_normals(V, F), axis=1)
    G.data *= -np.repeat(area, 9)
    return csr_array(G.T)


def checked(where: str, V: ArrayLike, F: ArrayLike, flat: bool = False) -> tuple[Array, Index]:
    """Return vertices (n, 3) and triangles (m, 3) of which none is flat, unless they may be."""
    V = topology.vertices(where, "V", V, 3)
    F = topology.triangles(where, F, len(V))
    if not flat and (bad := degenerate(V, F)).any():
        remedy = "Remove them with surface.without_flat."
        topology.fail(where, "F", "triangles with an area", f"area 0 in {named('face', bad)}", remedy)
    return V, F


def degenerate(V: Array, F: Index) -> NDArray[np.bool_]:
    """Return which triangles (m,) have no area: twice it is at most FLAT times their longest edge squared."""
    edge = V[F[:, [1, 2, 0]]] - V[F]
    longest = np.max(np.einsum("fki,fki->fk", edge, edge), axis=1)
    return ~(np.linalg.norm(topology.area_normals(V, F), axis=1) > FLAT * longest)


def named(what: str, bad: NDArray[np.bool_]) -> str:
    """Return the first few of what is bad as words, such as "face 3" or "vertex 5, 7, 8, 9 and 12 more"."""
    return listed(what, np.flatnonzero(bad))


def listed(what: str, index: Index, most: int = 4) -> str:
    """Return the first few of some indices as words."""
    more = f" and {len(index) - most} more" if len(index) > most else ""
    return f"{what} {', '.join(map(str, index[:most]))}{more}"
