"""As rigid as possible: what a deformer made is moved on until the surface turns rather than stretches.

The energy is that of Chao, Pinkall, Sanan and Schroeder (2010), "spokes and rims": every vertex has a
rotation, and each of its faces counts by how far its map is from that,

    E = 1/3 sum over vertices i, sum over faces f at i of area_f |J_f - R_i P_f|^2,

J_f the map of the face as the deformed mesh has it, P_f the projection to its plane at rest.  Unlike that
of Sorkine and Alexa (2007), "spokes", no part of it is negative where cotangents are.  Both steps of a round,
the best rotations for given vertices and the best vertices for given rotations, make it less.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import polar
from lietool.mesh import laplacian, solve, surface, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh at rest, factored.

    Parameters
    ----------
    faces : ndarray of int, shape (m, 3)
    area : ndarray, shape (m,)
    tangent : ndarray, shape (m, 3, 3)
        The projection to the plane of each face.
    gradient, divergence, around : sparse array
        `around` (n, m) has a 1 where a vertex belongs to a face.
    factor : Factor
    pinned : ndarray of int
    part : ndarray of int, shape (n,)
        The connected part of each vertex without a pin, else -1.
    masses : ndarray, shape (n,)
    size : float
        The diagonal of the box round the vertices at rest.
    """

    faces: Index
    area: Array
    tangent: Array
    gradient: Any
    divergence: Any
    around: Any
    factor: solve.Factor
    pinned: Index
    part: Index
    masses: Array
    size: float


@dataclass(frozen=True, eq=False)
class Polished:
    """A mesh after some rounds.

    Parameters
    ----------
    vertices : ndarray, shape (n, 3)
    energy : ndarray, shape (rounds + 1,)
        Before the first round and after each; it does not rise.
    residual : float
        How far a vertex moved in the last round, at most, over the diagonal of the mesh at rest.
    """

    vertices: Array
    energy: Array
    residual: float


def prepare(V: ArrayLike, F: ArrayLike, pinned: ArrayLike) -> Prepared:
    """Return the factored system of a mesh at rest and the vertices that stay where the deformer put them.

    A connected part without a pin keeps its barycentre, and a vertex that no face uses its place.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    pinned : array_like of int, shape (k,)

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If V or F is none, a triangle has area 0, or pinned has no vertices or one twice.
    """
    from scipy.sparse import csr_array

    V, F = laplacian.checked("arap.prepare", V, F)
    n, m = len(V), len(F)
    pins = topology.distinct(
        "arap.prepare", "pinned", topology.vertex_set("arap.prepare", "pinned", pinned, n)
    )
    part = surface.health(V, F).part
    number = int(part.max()) + 1
    held = np.bincount(part[pins][part[pins] >= 0], minlength=number) > 0
    part = np.where((part >= 0) & ~held[part], part, -1)
    loose, first = np.unique(part, return_index=True)
    used = np.bincount(F.ravel(), minlength=n) > 0
    # One vertex of each loose part is held for the solver; the part is moved to its barycentre afterwards.
    fixed = np.union1d(np.union1d(pins, np.flatnonzero(~used)), first[loose >= 0])
    normal = surface.face_normals(V, F)
    around = csr_array((np.ones(3 * m), (F.ravel(), np.repeat(np.arange(m), 3))), (n, m))
    return Prepared(
        F,
        surface.areas(V, F),
        np.eye(3) - normal[:, :, None] * normal[:, None, :],
        laplacian.gradient(V, F),
        laplacian.divergence(V, F),
        around,
        solve.factor(laplacian.cotangent(V, F), fixed),
        pins,
        part,
        laplacian.mass(V, F),
        float(np.linalg.norm(np.ptp(V, axis=0))),
    )


def polish(prepared: Prepared, vertices: ArrayLike, rounds: int = 10) -> Polished:
    """Return a deformed mesh after some rounds towards the least energy.

    Parameters
    ----------
    prepared : Prepared
    vertices : array_like, shape (n, 3)
        What the deformer made; those that are pinned stay.
    rounds : int, optional
        At least 1.

    Returns
    -------
    Polished

    Raises
    ------
    ValueError
        If there are more or fewer vertices than at rest, one is not finite, or rounds is no such number.
    """
    x = topology.vertices("arap.polish", "vertices", vertices, 3)
    if len(x) != prepared.factor.count:
        must = f"the {prepared.factor.count} vertices at rest"
        topology.fail("arap.polish", "vertices", must, f"{len(x)}")
    if not isinstance(rounds, int | np.integer) or rounds < 1:
        topology.fail("arap.polish", "rounds", "a whole number, at least 1", repr(rounds))
    centre = _centres(prepared, x)
    energy, before = [], x
    for _ in range(rounds):
        before, J = x, _maps(prepared, x)
        R = _rotations(prepared, J)
        if not energy:
            energy.append(_energy(prepared, J, R))
        x = _global(prepared, R, x, centre)
        J = _maps(prepared, x)
        energy.append(_energy(prepared, J, R))
    residual = float(np.max(np.linalg.norm(x - before, axis=1))) / prepared.size
    return Polished(x, np.array(energy), residual)


def _maps(prepared: Prepared, x: Array) -> Array:
    """Return the maps (m, 3, 3) of the faces, of their planes at rest to space."""
    return (prepared.gradient @ x).reshape(-1, 3, 3).transpose(0, 2, 1)


def _rotations(prepared: Prepared, J: Array) -> Array:
    """Return the rotation (n, 3, 3) at each vertex nearest to the maps of its faces.

    Not checked for det > 0: of a reflection the polar decomposition takes the rotation nearest to it, which
    is what makes the energy least.
    """
    S = prepared.around @ (prepared.area[:, None, None] * J).reshape(-1, 9)
    S = S.reshape(-1, 3, 3)
    R = polar.rotation(S, check=False)
    # Faces crushed to a line or a point, or none at all: many rotations are as near, and polar finds none.
    loss = np.max(np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)), axis=(1, 2))
    if (crushed := ~(loss <= 1e-9)).any():
        U, _, W = np.linalg.svd(S[crushed])
        U[:, :, 2] *= np.linalg.det(U @ W)[:, None]
        R[crushed] = U @ W
    return R


def _energy(prepared: Prepared, J: Array, R: Array) -> float:
    apart = J[:, None] - R[prepared.faces] @ prepared.tangent[:, None]
    return float(np.sum(prepared.area * np.einsum("fkij,fkij->f", apart, apart)) / 3.0)


def _global(prepared: Prepared, R: Array, x: Array, centre: Array) -> Array:
    """Return the best vertices for given rotations."""
    mean = (prepared.around.T @ R.reshape(-1, 9)).reshape(-1, 3, 3) / 3.0
    field = (mean @ prepared.tangent).transpose(0, 2, 1).reshape(-1, 3)
    found = prepared.factor.solve(-(prepared.divergence @ field), x[prepared.factor.fixed])
    loose = prepared.part >= 0
    if loose.any():
        found[loose] += (centre - _centres(prepared, found))[prepared.part[loose]]
    return found


def _centres(prepared: Prepared, x: Array) -> Array:
    """Return the barycentres (parts, 3) of the parts without a pin; 0 for the others."""
    loose = prepared.part >= 0
    part, mass = prepared.part[loose], prepared.masses[loose]
    number = int(np.max(prepared.part)) + 1
    weight = np.maximum(np.bincount(part, mass, number), 1e-300)
    sums = [np.bincount(part, mass * x[loose, a], number) / weight for a in range(3)]
    return np.stack(sums, axis=1)
