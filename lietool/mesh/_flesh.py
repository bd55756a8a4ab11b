"""Parts that bodies are made of: limbs, eggs, bricks and pots, each by its distance from any point.

Only sums, products and square roots are used, so that every machine gets the same values.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

REACH = 0.45
"""Farther than this from its box a part is not asked for its distance: the widest fillet."""

# Segments of a limb are handled so many at once, with one box.
_GROUP = 5


@dataclass(frozen=True, eq=False)
class Limb:
    """A round limb along a polyline: arms, legs, necks, tails.

    Parameters
    ----------
    name : str
    points : (k, 3)
        The axis.
    radii : (k,)
        Linear between the points.
    fillet : float
        How far from the seam the surface is rounded where the limb joins the rest.
    front : tuple of float
        The direction from which the angle about the axis is counted, at the root.
    ribs : tuple of int and float
        How many run along the limb and how high they are; the axis lies in a plane across `front` then.
    """

    name: str
    points: Array
    radii: Array
    fillet: float = 0.1
    front: tuple[float, float, float] = (0.0, 0.0, -1.0)
    ribs: tuple[int, float] = (0, 0.0)

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """The lower and the upper corner."""
        size = self.radii[:, None] + self.ribs[1]
        return (self.points - size).min(axis=0), (self.points + size).max(axis=0)

    def nearest(self, p: Array) -> tuple[Array, Array]:
        """Return the distance (n,), `REACH` at the most, and where it was taken (n,), in segments."""
        best, at = np.full(len(p), REACH), np.zeros(len(p))
        # A loop over the segments of one axis, a few dozen, and each only for the points near it.
        for k in range(0, len(self.points) - 1, _GROUP):
            ends = self.points[k : k + _GROUP + 1]
            size = self.radii[k : k + _GROUP + 1].max() + self.ribs[1] + REACH
            near = ((p > ends.min(axis=0) - size) & (p < ends.max(axis=0) + size)).all(axis=1)
            near = np.flatnonzero(near)
            q, least, where = p[near], best[near], at[near]
            for j in range(k, k + len(ends) - 1):
                d, t = self._segment(q, j)
                closer = d < least
                least, where = np.where(closer, d, least), np.where(closer, j + t, where)
            best[near], at[near] = least, where
        return best, at

    def _segment(self, p: Array, k: int) -> tuple[Array, Array]:
        u = self.points[k + 1] - self.points[k]
        r = p - self.points[k]
        t = (r[:, 0] * u[0] + r[:, 1] * u[1] + r[:, 2] * u[2]) / (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
        t = np.minimum(np.maximum(t, 0.0), 1.0)
        x, y, z = r[:, 0] - t * u[0], r[:, 1] - t * u[1], r[:, 2] - t * u[2]
        far = np.sqrt(x * x + y * y + z * z)
        thick = self.radii[k] + t * (self.radii[k + 1] - self.radii[k])
        if self.ribs[0]:
            f = self.front
            cosine = (x * f[0] + y * f[1] + z * f[2]) / np.maximum(far, 1e-9)
            # Ribs end smoothly on the round tip, where the offset turns along the axis.
            slope = (x * u[0] + y * u[1] + z * u[2]) / np.maximum(far, 1e-9)
            across = np.maximum(1.0 - slope * slope / (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), 0.0)
            thick = thick + self.ribs[1] * across * across * _cosine_of_multiple(cosine, self.ribs[0])
        return far - thick, t

    def distance(self, p: Array) -> Array:
        """Return the distance (n,) from the surface, negative inside."""
        return self.nearest(p)[0]

    def thickness(self, p: Array) -> Array:
        """Return the radius (n,) where points are nearest to the axis."""
        return np.interp(self.nearest(p)[1], np.arange(len(self.radii)), self.radii)

    def coordinates(self, p: Array) -> tuple[Array, Array]:
        """Return the part of the length (n,) at which points are, and their angle about the axis (n,)."""
        steps = np.diff(self.points, axis=0)
        lengths = np.sqrt((steps * steps).sum(axis=1))
        before = np.concatenate([[0.0], np.cumsum(lengths)])
        _, at = self.nearest(p)
        k = np.minimum(at.astype(int), len(steps) - 1)
        foot = self.points[k] + (at - k)[:, None] * steps[k]
        front = self._fronts(steps / lengths[:, None])
        side = np.cross(steps / lengths[:, None], front)
        out = p - foot
        angle = np.arctan2((out * side[k]).sum(axis=1), (out * front[k]).sum(axis=1))
        return np.interp(at, np.arange(len(before)), before / before[-1]), angle

    def _fronts(self, tangents: Array) -> Array:
        """Where the angle is 0 on each segment: carried along the axis with as little turning as can be."""
        front = np.array(self.front)
        fronts = np.empty_like(tangents)
        for k, t in enumerate(tangents):
            front = front - (front @ t) * t
            if front @ front < 1e-6:
                front = np.cross(t, np.eye(3)[np.argmin(np.abs(t))])
            front = front / np.sqrt(front @ front)
            fronts[k] = front
        return fronts


def _cosine_of_multiple(c: Array, n: int) -> Array:
    """cos(n x) for c = cos(x), by Chebyshev's recurrence: every machine multiplies alike."""
    before, now = np.ones_like(c), c
    for _ in range(n - 1):
        before, now = now, 2.0 * c * now - before
    return now


@dataclass(frozen=True, eq=False)
class Pot:
    """A solid of revolution about the z axis, of a convex outline.

    Parameters
    ----------
    name : str
    profile : (k, 2)
        Radius and height, upwards along the outside; the first and the last lie on the axis.
    rounding : float
        Added all round.
    fillet : float
    """

    name: str
    profile: Array
    rounding: float
    fillet: float = 0.05

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """The lower and the upper corner."""
        wide = float(self.profile[:, 0].max()) + self.rounding
        low, high = self.profile[:, 1].min() - self.rounding, self.profile[:, 1].max() + self.rounding
        return np.array([-wide, -wide, low]), np.array([wide, wide, high])

    def distance(self, p: Array) -> Array:
        """Return the distance (n,) from the surface, negative inside."""
        x, z = np.sqrt(p[:, 0] * p[:, 0] + p[:, 1] * p[:, 1]), p[:, 2]
        outside, depth = np.full(len(p), np.inf), np.full(len(p), -np.inf)
        for (a, b), (c, d) in pairwise(self.profile.tolist()):
            u, v = c - a, d - b
            size = u * u + v * v
            t = np.minimum(np.maximum(((x - a) * u + (z - b) * v) / size, 0.0), 1.0)
            outside = np.minimum(outside, (x - a - t * u) ** 2 + (z - b - t * v) ** 2)
            depth = np.maximum(depth, ((x - a) * v - (z - b) * u) / np.sqrt(size))
        return np.where(depth > 0.0, np.sqrt(outside), depth) - self.rounding

    def thickness(self, p: Array) -> Array:
        """Return what stands for a radius (n,): the edges are what is fine about it."""
        return np.full(len(p), 2.0 * self.rounding)


@dataclass(frozen=True, eq=False)
class Brick:
    """A box with rounded edges, half as large as `sides` on either side of its centre.

    Parameters
    ----------
    name : str
    center, sides : tuple of float
    rounding : float
        The radius of its edges.
    fillet : float
    """

    name: str
    center: tuple[float, float, float]
    sides: tuple[float, float, float]
    rounding: float
    fillet: float = 0.05

    @property
    def box(self) -> tuple[Array, Array]:
        """The lower and the upper corner."""
        return np.array(self.center) - self.sides, np.array(self.center) + self.sides

    def distance(self, p: Array) -> Array:
        """Return the distance (n,) from the surface, negative inside."""
        q = np.abs(p - np.array(self.center)) - np.array(self.sides) + self.rounding
        x, y, z = np.maximum(q, 0.0).T
        return np.sqrt(x * x + y * y + z * z) + np.minimum(q.max(axis=1), 0.0) - self.rounding

    def thickness(self, p: Array) -> Array:
        """Return what stands for a radius (n,): half the least side."""
        return np.full(len(p), min(self.sides))


@dataclass(frozen=True, eq=False)
class Egg:
    """An ellipsoid.

    Parameters
    ----------
    name : str
    center : tuple of float
    radii : tuple of float
    fillet : float
    tilt : float
        Radians about the y axis, from z towards x.
    """

    name: str
    center: tuple[float, float, float]
    radii: tuple[float, float, float]
    fillet: float = 0.1
    tilt: float = 0.0

    @property
    def box(self) -> tuple[Array, Array]:
        """The lower and the upper corner of a box that is large enough however it is tilted."""
        c, r = np.array(self.center), np.array(self.radii)
        if self.tilt:
            r = np.array([max(r[0], r[2]), r[1], max(r[0], r[2])])
        return c - r, c + r

    def distance(self, p: Array) -> Array:
        """Return roughly the distance (n,) from the surface, negative inside; exactly 0 on it."""
        x, y, z = (p - np.array(self.center)).T
        c, s = round(float(np.cos(self.tilt)), 9), round(float(np.sin(self.tilt)), 9)
        x, z = c * x - s * z, s * x + c * z
        a, b, e = self.radii
        k0 = np.sqrt(x * x / a**2 + y * y / b**2 + z * z / e**2)
        k1 = np.sqrt(x * x / a**4 + y * y / b**4 + z * z / e**4)
        return np.where(k1 > 1e-9, k0 * (k0 - 1.0) / np.maximum(k1, 1e-9), -min(self.radii))

    def thickness(self, p: Array) -> Array:
        """Return the least half axis, for each of the points (n,)."""
        return np.full(len(p), min(self.radii))


Part = Limb | Brick | Egg | Pot
