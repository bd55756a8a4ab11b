"""The record of a solid; with normals, which are those of any surface."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.mesh.surface import vertex_normals as normals

Array = NDArray[np.float64]
Index = NDArray[np.intp]

__all__ = ["Solid", "changed", "frozen", "normals"]


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed mesh that knows its parts.

    Attributes
    ----------
    vertices : (n, 3)
    faces : (m, 3) of int
        Counter-clockwise seen from outside.
    normals : (n, 3)
        Unit, of the vertices.
    parts : tuple of str
        Names: "head", "arm 0", ...
    part : (n,) of int
        Which of them each vertex belongs to.
    along : (n,)
        From 0 at the root of the vertex's limb to 1 at its tip; 0 where it is none.
    around : (n,)
        The angle about the limb's axis, -pi to pi, 0 in front of a standing limb and under a lying one.
    distances : (p, n)
        How far each vertex is from each part alone, less inside; 0.45 where it is far.
    axes : mapping from str to ndarray (k, 3)
        The middle line of each limb, from its root to its tip.
    marks : mapping from str to int
        Vertices with a name: "eye left", "tip 0", ...
    eye : float
        The radius of balls at the marks that begin with "eye"; 0 if there are none.
    targets : mapping from str to ndarray (n, 3)
        Other positions of the same vertices.
    """

    vertices: Array
    faces: Index
    normals: Array
    parts: tuple[str, ...]
    part: Index
    along: Array
    around: Array
    distances: Array
    axes: Mapping[str, Array] = field(default_factory=dict)
    marks: Mapping[str, int] = field(default_factory=dict)
    eye: float = 0.0
    targets: Mapping[str, Array] = field(default_factory=dict)

    def of(self, *names: str) -> NDArray[np.bool_]:
        """Return which vertices (n,) belong to parts whose names begin with one of these."""
        return np.isin(self.part, np.flatnonzero(self._named(names)))

    def margin(self, *names: str) -> Array:
        """Return by how much vertices (n,) are nearer to such parts than to all others: 0 on the seams.

        Cut along its zeros (`cut.along`), the surface has the parts in clean lines.
        """
        mine = self._named(names)
        others = np.min(self.distances[~mine], axis=0, initial=1.0)
        return others - np.min(self.distances[mine], axis=0, initial=1.0)

    def _named(self, names: tuple[str, ...]) -> NDArray[np.bool_]:
        return np.array([part.startswith(names) for part in self.parts])


def changed(solid: Solid, **changes: Any) -> Solid:
    """Return the solid with other values for some of its attributes."""
    return frozen(replace(solid, **changes))


def frozen(solid: Solid) -> Solid:
    """Return the solid with nothing in it that can be written: one object serves every caller."""
    for value in vars(solid).values():
        for array in value.values() if isinstance(value, Mapping) else (value,):
            if isinstance(array, np.ndarray):
                array.setflags(write=False)
    own = {key: MappingProxyType(dict(x)) for key, x in vars(solid).items() if isinstance(x, Mapping)}
    return replace(solid, **own)
