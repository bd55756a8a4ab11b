"""What an interpolation of shapes knows before any frame, and what comes of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lietool.interp import system, terms, triangle
from lietool.interp.assembly import Assembly
from lietool.interp.constraint import Constraint
from lietool.interp.freedom import Freedoms
from lietool.mesh import topology

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Prepared:
    """All that does not depend on the frame.

    Parameters
    ----------
    source, target : ndarray, shape (n, 2)
    faces : ndarray of int, shape (m, 3)
    maps : ndarray, shape (m, 2, 2)
        The linear parts A_i of the local maps.
    theta : ndarray, shape (m,)
        Their angles of rotation, radians.
    homotopy : callable
        Of `triangle`.
    constraints : tuple of Constraint
    freedoms : Freedoms
        What the energy leaves open.
    assembly : Assembly
    factor : Factor or None
        The factored system, where one serves all frames.
    """

    source: Array
    target: Array
    faces: Index
    maps: Array
    theta: Array
    homotopy: triangle.Homotopy
    constraints: tuple[Constraint, ...]
    freedoms: Freedoms
    assembly: Assembly
    factor: system.Factor | None

    @property
    def is_static(self) -> bool:
        """Whether one factorisation serves all frames."""
        return self.factor is not None

    @property
    def sums(self) -> tuple[terms.Term, ...]:
        """The energy: one sum over the triangles, or two where it is symmetrised."""
        return self.assembly.sums


@dataclass(frozen=True, eq=False)
class Result:
    """The shape at some times.

    Parameters
    ----------
    prepared : Prepared
    t : ndarray, shape (T,)
    vertices : ndarray, shape (T, n, 2)
    residual : ndarray, shape (T,)
        The largest error in an equation of the linear system, relative to the norms of its matrix and of
        the solution.
    """

    prepared: Prepared
    t: Array
    vertices: Array
    residual: Array

    @cached_property
    def jacobians(self) -> Array:
        """The maps B_i(t) of the triangles; shape (T, m, 2, 2)."""
        part = self.prepared.sums[0]
        return np.stack([triangle.matrix(*part.coordinates(self._corners(k))) for k in range(len(self.t))])

    @cached_property
    def det(self) -> Array:
        """By which factor each triangle's area has changed; shape (T, m)."""
        areas = np.stack([topology.areas(V, self.prepared.faces) for V in self.vertices])
        return areas / topology.areas(self.prepared.source, self.prepared.faces)

    @property
    def flipped(self) -> NDArray[np.bool_]:
        """Which triangles are turned over or have collapsed; shape (T, m)."""
        return self.det <= 0.0

    @cached_property
    def energy(self) -> Array:
        """The weighted sum of the triangles' errors; shape (T,)."""
        total = np.zeros(len(self.t))
        for k, t in enumerate(self.t.tolist()):
            corners = self._corners(k)
            for part in self.prepared.sums:
                total[k] += part.form(part.maps(t)).at(part.coordinates(corners)).sum()
        return total

    def _corners(self, frame: int) -> Complex:
        V = self.vertices[frame]
        return (V[:, 0] + 1j * V[:, 1])[self.prepared.faces.T]
