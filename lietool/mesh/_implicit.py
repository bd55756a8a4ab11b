"""Bodies whose parts flow into each other, and their surface as triangles of marching cubes.

Each part joins what came before it with a fillet of its own width.  The values on the grid are rounded, so
that every machine gets the same triangles.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lietool.mesh._flesh import REACH, Limb, Part

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# Points are handled so many at once, which stay in the processor's cache.
_CHUNK = 1 << 15
# Of the spacing, the side of the smallest triangles.
_FINEST = 0.4
_CORNERS = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Body:
    """Parts in the order in which they are joined."""

    parts: tuple[Part, ...]

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """The lower and the upper corner."""
        boxes = [part.box for part in self.parts]
        return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)

    def distances(self, p: Array) -> Array:
        """Return the distance (parts, n) from each part alone, or `REACH` where it is far."""
        found = np.full((len(self.parts), len(p)), REACH)
        for row, part in zip(found, self.parts, strict=True):
            low, high = part.box
            near = np.flatnonzero(((p > low - REACH) & (p < high + REACH)).all(axis=1))
            row[near] = np.minimum(part.distance(p[near]), REACH)
        return found

    def value(self, p: Array) -> Array:
        """Return the field (n,) whose zeros are the surface, negative inside."""
        whole = np.empty(len(p))
        for k in range(0, len(p), _CHUNK):
            found = self.distances(p[k : k + _CHUNK])
            joined = found[0]
            for part, row in zip(self.parts[1:], found[1:], strict=True):
                joined = _joined(joined, row, part.fillet)
            whole[k : k + _CHUNK] = joined
        return whole

    def onto(self, p: Array, times: int = 2) -> Array:
        """Return points (n, 3) near the surface brought onto it along the gradient."""
        step = 2.0**-12
        for _ in range(times):
            # Four corners of a cube give the gradient, and their mean the value.
            f = self.value((p[None] + step * _CORNERS[:, None]).reshape(-1, 3)).reshape(4, -1)
            g = np.stack(
                [
                    _CORNERS[0, k] * f[0]
                    + _CORNERS[1, k] * f[1]
                    + _CORNERS[2, k] * f[2]
                    + _CORNERS[3, k] * f[3]
                    for k in range(3)
                ],
                axis=1,
            ) / (4.0 * step)
            size = g[:, 0] * g[:, 0] + g[:, 1] * g[:, 1] + g[:, 2] * g[:, 2]
            # Where parts meet the gradient is short: a step is never longer than a part of a triangle.
            far = np.clip(0.25 * (f[0] + f[1] + f[2] + f[3]) / np.maximum(size, 0.25), -0.03, 0.03)
            p = p - far[:, None] * g
        return np.round(p, 7)

    def owner(self, p: Array) -> Index:
        """Return which part each point (n,) belongs to: the one it is deepest in."""
        return np.argmin(np.round(self.distances(p), 6), axis=0)

    def fineness(self, p: Array, spacing: float) -> Array:
        """Return the side (n,) that triangles should have: the spacing, and less where the body is thin."""
        owner, thick = self.owner(p), np.empty(len(p))
        for k, part in enumerate(self.parts):
            mine = np.flatnonzero(owner == k)
            thick[mine] = part.thickness(p[mine])
        return np.clip(0.5 * thick, _FINEST * spacing, spacing)

    def coordinates(self, p: Array, owner: Index) -> tuple[Array, Array]:
        """Return how far along its limb each point is (n,), 0 to 1, and the angle about its axis (n,)."""
        along, around = np.zeros(len(p)), np.zeros(len(p))
        for k, part in enumerate(self.parts):
            mine = np.flatnonzero(owner == k)
            if isinstance(part, Limb) and len(mine):
                along[mine], around[mine] = part.coordinates(p[mine])
        return np.round(along, 6), np.round(around, 6)


def _joined(a: Array, b: Array, k: float) -> Array:
    """The smaller of both, smooth where they differ by less than k."""
    h = np.maximum(k - np.abs(a - b), 0.0) / k
    return np.minimum(a, b) - h * h * h * (k / 6.0)


def surface(body: Body, cell: float) -> tuple[Array, Index]:
    """Return the surface of a body as the triangles of marching cubes, oriented outwards: uneven ones.

    Parameters
    ----------
    body : Body
    cell : float
        The width of a cube.

    Returns
    -------
    V : (n, 3)
    F : (m, 3)
    """
    from skimage.measure import marching_cubes

    low, high = body.box
    # The corners lie at odd places, so that neither a plane of symmetry nor a flat foot falls onto them.
    low = low - cell * np.array([3.271, 3.413, 3.337])
    sides = [np.arange(a, b + 3.5 * cell, cell) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1)
    f = body.value(grid.reshape(-1, 3)) / cell
    f = np.round(f, 6)
    # A zero in a corner would make triangles without area.
    f = np.where(np.abs(f) < 1e-3, 1e-3, f).reshape(grid.shape[:3])
    V, F, _, _ = marching_cubes(f.astype(np.float32), 0.0, allow_degenerate=False)
    V = np.round(low + cell * V.astype(float), 6)
    F = F.astype(np.intp)
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    volume = float(np.sum(a * np.cross(b, c)))
    return V, F if volume > 0.0 else F[:, ::-1]
