"""Normals of a mesh for its shading: smooth, except where faces meet at a large angle."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.render import mesh_lines
from lietool.render.mesh_lines import CREASE

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def shading(V: ArrayLike, F: ArrayLike, crease: float = CREASE) -> tuple[Array, Index, Array, Index]:
    """Return a mesh with a normal for each vertex, its vertices doubled along creases.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    crease : float
        Radians.

    Returns
    -------
    vertices : ndarray, shape (k, 3)
    faces : ndarray of int, shape (m, 3)
    normals : ndarray, shape (k, 3)
        The mean over the faces around, each by its angle.
    origin : ndarray of int, shape (k,)
        Which of the given vertices each one is.
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp)
    N, part = mesh_lines.face_normals(V, F), _angles(V, F)
    weighted = N[:, None, :] * part[:, :, None]
    flat = F.ravel()
    sums = np.stack([np.bincount(flat, weighted[..., k].ravel(), len(V)) for k in range(3)], axis=1)
    found = mesh_lines.edges(F)
    inner = found.sides[:, 1] >= 0
    split = np.zeros(len(V), bool)
    split[found.ends[inner & mesh_lines.sharp(V, F, found, crease)]] = True
    corner = np.flatnonzero(split[flat])
    if not len(corner):
        return V, F, mesh_lines.unit(sums), np.arange(len(V))
    corner = corner[np.argsort(flat[corner], kind="stable")]
    mine = _together(flat[corner], N[corner // 3], weighted.reshape(-1, 3)[corner], np.cos(crease))
    faces = flat.copy()
    faces[corner] = len(V) + np.arange(len(corner))
    origin = np.concatenate([np.arange(len(V)), flat[corner]])
    every = mesh_lines.unit(np.concatenate([sums, mine]))
    return V[origin], faces.reshape(-1, 3), every, origin


def _together(vertex: Index, N: Array, weighted: Array, least: float) -> Array:
    """Sums (k, 3) over the corners at the same vertex, sorted by it, whose faces are near in direction."""
    start = np.flatnonzero(np.diff(vertex, prepend=-1))
    count = np.diff(start, append=len(vertex))
    group = np.repeat(np.arange(len(start)), count)
    # Every corner with every one at its vertex.
    each = count[group]
    one = np.repeat(np.arange(len(vertex)), each)
    other = start[group[one]] + np.arange(len(one)) - np.repeat(np.cumsum(each) - each, each)
    near = np.sum(N[one] * N[other], axis=1) >= least
    one, other = one[near], other[near]
    sums = [np.bincount(one, weights=weighted[other, k], minlength=len(vertex)) for k in range(3)]
    return np.stack(sums, axis=1).astype(float)


def _angles(V: Array, F: Index) -> Array:
    """The angles (m, 3) at the corners of faces, radians."""
    corners = V[F]
    one, two = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    return np.arctan2(np.linalg.norm(np.cross(one, two), axis=-1), np.sum(one * two, axis=-1))
