"""Green coordinates of a closed triangle mesh (Lipman, Levin and Cohen-Or 2008).

A point inside is the sum of phi_i v_i over the cage's vertices and psi_j n_j over its faces' outward unit
normals, by Green's third identity with the fundamental solution -1 / (4 pi r):

    phi_i = 1/(4 pi) int lambda_i h / r^3 dA,     psi_j = 1/(4 pi) int 1/r dA.

When the cage moves, n_j is scaled by the stretch s_j of its face, so that a similarity of the cage moves all
by it; in the plane the map is conformal, in space nearly so, but it does not follow the cage's own
boundary.  In closed form, with the numbers of `cage_view`, the solid angle Omega of a face, and
L_e = int ds / r = asinh(end_e / rho_e) - asinh(start_e / rho_e),

    phi_i = (d_i Omega + h sum_e (m_i . m_e) L_e) / (4 pi H_i),     psi = (sum_e d_e L_e - h Omega) / (4 pi).

On the cage the coordinates are the limits from inside: phi has as much of the solid angle as the other faces
leave, and gives it to the hat functions there.  Outside the sums vanish (the identity gives 0), so they are
continued as the paper has it, through the nearest face: the point's own affine coordinates in that face and
its normal are added.  That is smooth across the face, and reproduces similarities, but it jumps where the
nearest face changes; `Prepared.outside` says which points it concerns.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import cage_checks, cage_view, mean_value
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Prepared:
    """Points bound to a cage.

    Parameters
    ----------
    phi : ndarray, shape (n, k)
        Of each point, one for each cage vertex; their sum is 1.
    psi : ndarray, shape (n, m)
        One for each face; lengths.
    rest : ndarray, shape (k, 3)
        The cage at rest.
    faces : ndarray of int, shape (m, 3)
    outside : ndarray of bool, shape (n,)
        Points outside of the cage, for which the coordinates are continued through the nearest face.
    """

    phi: Array
    psi: Array
    rest: Array
    faces: Index
    outside: Mask


def prepare(points: ArrayLike, V: ArrayLike, F: ArrayLike) -> Prepared:
    """Bind points to a cage by Green coordinates.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        On the cage the limit from inside is taken; outside see above.
    V : array_like, shape (k, 3)
    F : array_like of int, shape (m, 3)
        Counter-clockwise, seen from outside.

    Returns
    -------
    prepared : Prepared

    Raises
    ------
    ValueError
        If the cage is not a closed surface oriented outwards, or a number is not finite.
    """
    where = "green.prepare"
    x = topology.vertices(where, "points", points, 3)
    V, F = cage_checks.closed(where, V, F)
    cage = cage_view.facets(V, F)
    phi, psi = np.empty((len(x), len(V))), np.empty((len(x), len(F)))
    outside = np.zeros(len(x), bool)
    for part, seen in cage_view.chunks(cage, x):
        phi[part], psi[part], outside[part] = _coordinates(cage, seen)
    out = np.flatnonzero(outside)
    if len(out):
        _continue(cage, x, out, phi, psi)
    return Prepared(phi, psi, V, F, outside)


def solve(prepared: Prepared, V: ArrayLike) -> Array:
    """Return the points, moved with the cage.

    Parameters
    ----------
    prepared : Prepared
    V : array_like, shape (k, 3)
        The cage as it is now.

    Returns
    -------
    points : (n, 3)

    Raises
    ------
    ValueError
        If V is not finite or has another number of vertices than the cage.
    """
    now = mean_value.current("green.solve", V, len(prepared.rest))
    normals = stretched_normals(prepared.rest, now, prepared.faces)
    return prepared.phi @ now + prepared.psi @ normals


def stretched_normals(rest: ArrayLike, now: ArrayLike, F: ArrayLike) -> Array:
    """Return the faces' unit normals times their stretch s_j; 0 for a face that has collapsed.

    s = sqrt((|u'|^2 |v|^2 - 2 (u'.v') (u.v) + |v'|^2 |u|^2) / 2) / (2 area), u and v two edges: the root mean
    square of the face's singular values, 1 for a rigid motion, the factor of a similarity.

    Parameters
    ----------
    rest, now : array_like, shape (k, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    normals : (m, 3)
    """
    P, Q = np.asarray(rest, float)[np.asarray(F)], np.asarray(now, float)[np.asarray(F)]
    u, v, a, b = P[:, 1] - P[:, 0], P[:, 2] - P[:, 0], Q[:, 1] - Q[:, 0], Q[:, 2] - Q[:, 0]
    square = _dot(a, a) * _dot(v, v) - 2.0 * _dot(a, b) * _dot(u, v) + _dot(b, b) * _dot(u, u)
    twice = np.linalg.norm(np.cross(u, v), axis=-1)
    s = np.sqrt(np.maximum(0.5 * square, 0.0)) / twice
    n = np.cross(a, b)
    size = np.linalg.norm(n, axis=-1)
    return n * (s / np.where(size > 0.0, size, 1.0))[:, None]


def _dot(a: Array, b: Array) -> Array:
    return np.sum(a * b, axis=-1)


def _coordinates(cage: cage_view.Facets, seen: cage_view.View) -> tuple[Array, Array, Mask]:
    """Return phi (c, k), psi (c, m) as the integrals are inside and on the cage, and which are outside."""
    h, d = seen.h, seen.d
    omega, log = cage_view.solid_angles(cage, seen), _logarithm(seen)
    turn = np.einsum("iem,ecm->icm", cage.gram, log)
    corners = (d * omega + h * turn) / (4.0 * np.pi * cage.height[:, None])
    psi = (np.sum(d * log, axis=0) - h * omega) / (4.0 * np.pi)
    phi = cage_view.gather(cage, corners)
    rounds = np.rint(omega.sum(axis=1) / (4.0 * np.pi))
    near = cage_view.nearest(cage, seen, cage_view.BESIDE * cage.size)
    rounds[near.row[near.distance <= cage_view.ON_SURFACE * cage.size]] = 1.0
    # The faces' solid angles round where they are nearest; only their sum is known, and belongs there.
    missing = rounds[near.row] - phi[near.row].sum(axis=1)
    np.add.at(phi, (near.row[:, None], cage.faces[near.face]), near.share * missing[:, None])
    return phi, psi, rounds < 0.5


def _logarithm(seen: cage_view.View) -> Array:
    """Return int ds / r over the edges, with no difference of nearly equal numbers."""
    r = seen.radius
    a = r[[1, 2, 0]] + np.abs(seen.start)
    b = r[[2, 0, 1]] + np.abs(seen.end)
    a, b = np.maximum(a, cage_view.TINY), np.maximum(b, cage_view.TINY)
    across = (seen.start < 0.0) & (seen.end > 0.0)
    apart = np.where(seen.end > 0.0, b / a, a / b)
    # Two logarithms: on the line of an edge the product of both quotients overflows.
    return np.log(np.where(across, a / seen.rho, apart)) + np.log(np.where(across, b / seen.rho, 1.0))


def _continue(cage: cage_view.Facets, x: Array, out: Index, phi: Array, psi: Array) -> None:
    """Add what points outside have in the nearest face and its normal."""
    step = max(1, cage_view.PAIRS // len(cage.faces))
    for begin in range(0, len(out), step):
        rows = out[begin : begin + step]
        seen = cage_view.view(cage, x[rows] - cage.middle)
        near = cage_view.nearest(cage, seen, np.inf)
        place = (np.arange(len(rows)), near.face)
        share = (seen.d[:, *place] / cage.height[:, near.face]).T
        np.add.at(phi, (rows[:, None], cage.faces[near.face]), share)
        psi[rows, near.face] -= seen.h[place]
