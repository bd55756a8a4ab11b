"""Groups that are surfaces in space, for `tangent`: each as the points of R^3 that its elements truly are.

An element is given by the point of R^3 whose coordinates are its entries.  What is drawn is this point
seen from the identity: two coordinates in the tangent plane, the third along the normal.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.lie import quaternion, sym
from lietool.render import solids
from lietool.render.globe import joined


class Diagonal:
    """Diagonal matrices of determinant 1 with positive entries: the surface abc = 1 with a, b, c > 0."""

    name = r"$G = \{\mathrm{diag}(a, b, c) : a b c = 1,\ a, b, c > 0\}$"
    algebra = r"$\mathfrak{g} = \{\mathrm{diag}(x, y, z) : x + y + z = 0\}$"
    identity = np.ones(3)
    basis = np.array([[2.0, -1.0, -1.0], [0.0, 1.0, -1.0]]) / np.sqrt([[6.0], [2.0]])
    # The surface curves away from the origin, so that the side of the origin is up.
    normal = -np.ones(3) / np.sqrt(3.0)
    least, deepest, longest = 1.0, np.inf, 4.0

    def exp(self, x: np.ndarray) -> np.ndarray:
        """Return the entries a, b, c of exp of vectors (..., 3) of the algebra."""
        return np.diagonal(sym.exp(x[..., None] * np.eye(3)), axis1=-2, axis2=-1)

    def carried(self, g: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Return the velocity g X."""
        return g * x


class Quaternions:
    """The slice of the unit quaternions without a part along k: a sphere, no group, but full of subgroups."""

    name = r"$G = S^3\mathrm{,\ the\ part\ without\ } k$"
    algebra = r"$\mathfrak{g} = \mathrm{Im}\,\mathrm{\mathbb{H}}\mathrm{,\ likewise}$"
    identity = np.array([1.0, 0.0, 0.0])
    basis = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    normal = np.array([1.0, 0.0, 0.0])
    least, deepest, longest = 1.35, 2.0, np.pi

    def exp(self, x: np.ndarray) -> np.ndarray:
        """Return the parts w, x, y of exp of imaginary quaternions, given as (0, x, y)."""
        return quaternion.exp(np.concatenate([x[..., 1:], 0.0 * x[..., :1]], axis=-1))[..., :3]

    def carried(self, g: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Return the velocity q X, as long as q lies on the line of X."""
        full = [np.concatenate([part, 0.0 * part[..., :1]], axis=-1) for part in np.broadcast_arrays(g, x)]
        return quaternion.multiply(*full)[..., :3]


Group = Diagonal | Quaternions
GROUPS: dict[str, type[Diagonal] | type[Quaternions]] = {
    "diagonal": Diagonal,
    "quaternion": Quaternions,
}


@dataclass(frozen=True, eq=False)
class Dome:
    """A piece of the surface about the identity: rows are exp of circles, columns of rays."""

    points: np.ndarray
    normals: np.ndarray
    faces: np.ndarray
    graticule: np.ndarray

    @property
    def rim(self) -> np.ndarray:
        """The edge; shape (n, 3)."""
        return self.points[-1]

    def contours(self, eye: np.ndarray, least: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the outline, where the lines of sight touch the surface, and the edge, seen and hidden.

        The outline ends on the edge, where the edge goes out of sight.  Each is one polyline, with NaN
        between its parts.  Where the outline runs nearer than `least` to the edge, the edge alone is drawn.
        """
        facing = np.sum(self.normals * (eye - self.points), axis=-1)[:, :-1]
        rim, column = self.rim[:-1], np.arange(facing.shape[1])
        # The identity faces the eye, so that every ray which ends out of sight turns away once.
        row = np.maximum(np.argmax(facing < 0.0, axis=0), 1)
        f0, f1 = facing[row - 1, column], facing[row, column]
        part = (f0 / np.where(f0 == f1, 1.0, f0 - f1))[:, None]
        turns = (1.0 - part) * self.points[row - 1, column] + part * self.points[row, column]
        hidden = facing[-1] < 0.0
        if hidden.all() or not hidden.any():
            none = np.full((1, 3), np.nan)
            return (turns[[*column, 0]], none, self.rim) if hidden.all() else (none, self.rim, none)
        ways: dict[bool, list[np.ndarray]] = {False: [], True: []}
        outlines: list[np.ndarray] = []
        first = int(np.flatnonzero(hidden & ~np.roll(hidden, 1))[0])
        order = np.roll(column, -first)
        for run in np.split(order, np.flatnonzero(np.diff(hidden[order].astype(int))) + 1):
            before, after = (run[0] - 1) % len(column), (run[-1] + 1) % len(column)
            edge = np.concatenate([_border(facing[-1], rim, before, run[0]), rim[run]])
            edge = np.concatenate([edge, _border(facing[-1], rim, run[-1], after)])
            away = np.linalg.norm(turns[run] - rim[run], axis=-1).max()
            if hidden[run[0]] and away > least:
                outlines.append(np.concatenate([edge[:1], turns[run], edge[-1:]]))
            ways[bool(hidden[run[0]] and away > least)].append(edge)
        none = [np.full((1, 3), np.nan)]
        return joined(outlines or none), joined(ways[False] or none), joined(ways[True] or none)


def _border(facing: np.ndarray, rim: np.ndarray, i: int, j: int) -> np.ndarray:
    """The point (1, 3) between two of the edge where it goes out of sight."""
    part = facing[i] / (facing[i] - facing[j])
    return (rim[i] + part * (rim[j] - rim[i]))[None]


@dataclass(frozen=True)
class Chart:
    """A group with the view from its identity."""

    group: Group

    def vector(self, x: np.ndarray) -> np.ndarray:
        """Return vectors of the algebra from their two coordinates."""
        return np.asarray(x, float) @ self.group.basis

    def drawn(self, p: np.ndarray) -> np.ndarray:
        """Return where points of R^3 are drawn: the identity at 0, its tangent plane level."""
        axes = np.concatenate([self.group.basis, self.group.normal[None]])
        return (p - self.group.identity) @ axes.T

    def exp(self, x: np.ndarray) -> np.ndarray:
        """Return where exp of the algebra's vectors (..., 2) is drawn."""
        return self.drawn(self.group.exp(self.vector(x)))

    def level(self, x: np.ndarray) -> np.ndarray:
        """Return where the algebra's vectors are drawn in the tangent plane, the identity at 0."""
        x = np.asarray(x, float)
        return np.concatenate([x, 0.0 * x[..., :1]], axis=-1)

    def velocity(self, log: Callable[[float], np.ndarray], h: float = 1e-3) -> np.ndarray:
        """Return d/dt exp(log(t)) at t = 0, by differences of fourth order: a vector of R^3."""
        ahead, behind = ([self.group.exp(self.vector(log(s * k * h))) for k in (1, 2)] for s in (1, -1))
        return (8.0 * (ahead[0] - behind[0]) - (ahead[1] - behind[1])) / (12.0 * h)

    def raised(self, x: np.ndarray, height: float, h: float = 1e-4) -> np.ndarray:
        """Return where exp of vectors (..., 2) is drawn, moved off the surface to the side of the plane."""
        along, across = ((self.exp(x + h * e) - self.exp(x - h * e)) for e in np.eye(2))
        normal = np.cross(along, across)
        return self.exp(x) + height * normal / np.linalg.norm(normal, axis=-1, keepdims=True)

    def unrolled(self, x: np.ndarray, n: int = 41) -> np.ndarray:
        """Return the way of I + X to exp X as its line is wound onto the group: exp(sX) (I + (1 - s) X)."""
        s = np.linspace(0.0, 1.0, n)[:, None]
        X = self.vector(x)
        g = self.group.exp(s * X)
        return self.drawn(g + (1.0 - s) * self.group.carried(g, X))

    def rim(self, angle: np.ndarray, depth: float) -> np.ndarray:
        """Return how long vectors in directions `angle` are whose exp lies `depth` below the plane."""
        ways = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        low, high = np.zeros(len(ways)), np.full(len(ways), self.group.longest)
        for _ in range(50):
            middle = (low + high) / 2.0
            above = -self.exp(middle[:, None] * ways)[:, 2] < depth
            low, high = np.where(above, middle, low), np.where(above, high, middle)
        return low

    def dome(self, depth: float) -> Dome:
        """Return the part of the surface down to a depth."""
        angle = np.linspace(0.0, 2.0 * np.pi, 145)
        ways = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        rim = self.rim(angle, depth)
        part = np.linspace(0.0, 1.0, 61)[:, None, None]
        vertices, faces, normals = solids.grid(self.exp(part * (rim[:, None] * ways)))
        circles = [self.exp(0.5 * k * ways) for k in range(1, 7) if 0.5 * k < rim.max()]
        circles = [np.where(c[:, 2:] > -depth, c, np.nan) for c in circles]
        rays = [self.exp(np.linspace(0.0, rim[i], 41)[:, None] * ways[i]) for i in range(0, 144, 12)]
        shape = (len(part), len(angle), 3)
        return Dome(vertices.reshape(shape), normals.reshape(shape), faces, joined([*circles, *rays]))
