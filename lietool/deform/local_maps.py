"""The linear map of each face of a mesh with its normal: what one triangle of space lacks of a tetrahedron.

The fourth point is a corner plus n / sqrt|n|, n = e1 x e2: the map then carries the rest's unit normal to
that of the deformed face times the square root of its growth in area, and where the face has undergone a
similarity the map is that similarity.  (With unit normals it would not be: a face that doubles would keep its
thickness.)  Its determinant is the growth in area to the power 3/2.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import laplacian, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Frames:
    """Coordinates on the faces of a mesh at rest.

    Parameters
    ----------
    faces : ndarray of int, shape (m, 3)
    axes : ndarray, shape (m, 3, 3)
        Orthonormal: along the first edge, across it in the face, the normal; in rows.
    length, along, height : ndarray, shape (m,)
        The first edge is (length, 0), the edge to the third corner (along, height).
    """

    faces: Index
    axes: Array
    length: Array
    along: Array
    height: Array

    @property
    def area(self) -> Array:
        """The areas; shape (m,)."""
        return 0.5 * self.length * self.height

    @property
    def normal(self) -> Array:
        """The unit normals; shape (m, 3)."""
        return self.axes[:, 2]


def frames(V: ArrayLike, F: ArrayLike) -> Frames:
    """Return the coordinates on the faces of a mesh at rest.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    Frames

    Raises
    ------
    ValueError
        If V or F is none, or a face has no area.
    """
    V, F = laplacian.checked("local_maps.frames", V, F)
    u, v = _edges(V, F)
    n = np.cross(u, v)
    length, double = np.linalg.norm(u, axis=1), np.linalg.norm(n, axis=1)
    axis, normal = u / length[:, None], n / double[:, None]
    axes = np.stack([axis, np.cross(normal, axis), normal], axis=1)
    return Frames(F, axes, length, np.einsum("fi,fi->f", axis, v), double / length)


def tangents(at: Frames, U: Array) -> tuple[Array, Array]:
    """Return where the two axes in each face go in a mesh of the same faces.

    Parameters
    ----------
    at : Frames
    U : (n, 3)

    Returns
    -------
    one, two : (m, 3)
    """
    u, v = _edges(U, at.faces)
    one = u / at.length[:, None]
    return one, (v - at.along[:, None] * one) / at.height[:, None]


def maps(at: Frames, U: ArrayLike) -> Array:
    """Return the linear maps from the faces at rest, with their normals, to those of another mesh.

    Kaji-Ochiai: 5.3
    MEIS: 3.2, 3.3

    Parameters
    ----------
    at : Frames
    U : (n, 3)
        The vertices of the other mesh, of the same faces.

    Returns
    -------
    A : (m, 3, 3), GL+

    Raises
    ------
    ValueError
        If U is not finite, has fewer vertices than the faces need, or a face of it has no area.
    """
    where = "local_maps.maps"
    U = topology.vertices(where, "U", U, 3)
    if at.faces.max() >= len(U):
        topology.fail(where, "U", f"at least {at.faces.max() + 1} vertices", f"{len(U)}")
    if (flat := laplacian.degenerate(U, at.faces)).any():
        remedy = "Move its corners apart, or remove these faces from all meshes."
        topology.fail(where, "U", "a mesh with an area in every face", laplacian.named("face", flat), remedy)
    one, two = tangents(at, U)
    n = np.cross(one, two)
    n /= np.sqrt(np.linalg.norm(n, axis=1))[:, None]
    return np.stack([one, two, n], axis=-1) @ at.axes


def _edges(V: Array, F: Index) -> tuple[Array, Array]:
    origin = V[F[:, 0]]
    return V[F[:, 1]] - origin, V[F[:, 2]] - origin
