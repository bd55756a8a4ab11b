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

from lietool.deform import arap_kernels
from lietool.mesh import laplacian, solve, surface, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh at rest, factored.

    Parameters
    ----------
    faces : ndarray of int, shape (m, 3)
    frame : ndarray, shape (m, 6)
        Two orthonormal vectors in the plane of each face, times the root of its area.
    slopes : sparse array, shape (2 m, n)
        `slopes @ x` is to what the map of each face takes these.
    sums : sparse array, shape (3 n, n)
        `sums @ x` are the maps of the faces at each vertex, transposed, times area and added.
    factor : Factor
    pinned : ndarray of int
    part : ndarray of int, shape (n,)
        The connected part of each vertex without a pin, else -1.
    masses : ndarray, shape (n,)
    size : float
        The diagonal of the box round the vertices at rest.
    """

    faces: Index
    frame: Array
    slopes: Any
    sums: Any
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
    V, F = laplacian.checked("arap.prepare", V, F)
    n = len(V)
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
    frame, slopes, sums = _operators(V, F)
    return Prepared(
        F,
        frame,
        slopes,
        sums,
        solve.factor(laplacian.cotangent(V, F), fixed),
        pins,
        part,
        laplacian.mass(V, F),
        float(np.linalg.norm(np.ptp(V, axis=0))),
    )


def _operators(V: Array, F: Index) -> tuple[Array, Any, Any]:
    """Return `frame`, `slopes` and `sums` of a mesh at rest."""
    from scipy.sparse import csr_array, eye_array, kron

    n, m = len(V), len(F)
    G, area = laplacian.gradient(V, F), surface.areas(V, F)
    u = V[F[:, 1]] - V[F[:, 0]]
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    frame = np.stack([u, np.cross(surface.face_normals(V, F), u)], axis=1) * np.sqrt(area)[:, None, None]
    steep = (frame @ G.data.reshape(m, 3, 3)).ravel()
    slopes = csr_array((steep, np.repeat(F, 2, axis=0).ravel(), np.arange(0, 6 * m + 1, 3)), (2 * m, n))
    around = csr_array((np.repeat(area, 3), (F.ravel(), np.repeat(np.arange(m), 3))), (n, m))
    sums = csr_array(kron(around, eye_array(3), format="csr") @ G)
    return np.asarray(frame.reshape(m, 6), np.float64), slopes, sums


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
    q = np.repeat(np.eye(4)[:, :1], len(x), axis=1)
    for _ in range(rounds):
        before = x
        R, q = arap_kernels.rotations((prepared.sums @ x).reshape(-1, 9), q)
        if not energy:
            energy.append(_energy(prepared, x, R))
        x = _global(prepared, R, x, centre)
        energy.append(_energy(prepared, x, R))
    residual = float(np.max(np.linalg.norm(x - before, axis=1))) / prepared.size
    return Polished(x, np.array(energy), residual)


def _energy(prepared: Prepared, x: Array, R: Array) -> float:
    J = (prepared.slopes @ x).reshape(-1, 6)
    return arap_kernels.energy(prepared.faces, prepared.frame, J, R)


def _global(prepared: Prepared, R: Array, x: Array, centre: Array) -> Array:
    """Return the best vertices for given rotations (n, 9), transposed."""
    right = prepared.sums.T @ R.reshape(-1, 3) / 3.0
    found = prepared.factor.solve(right, x[prepared.factor.fixed])
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
