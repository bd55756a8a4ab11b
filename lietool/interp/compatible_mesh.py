"""One connectivity drawn in two planes, and the edits that keep it valid in both: flip, split, collapse.

Surazhsky and Gotsman (High quality compatible triangulations, 2004) improve a
common triangulation by such edits, each tried in both planes before it is done.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lietool.interp.compatible_smooth import WORST

Array = NDArray[np.float64]

_SCALE = 1.0 / (2.0 * 3.0**0.5)
_LIMIT = WORST


class Mesh:
    """Vertices as rows (x, y in the source, x, y in the target), faces as a map from edges to apexes."""

    def __init__(self, source: Array, target: Array, faces: NDArray[np.intp], rim: list[int]) -> None:
        self.points: list[tuple[float, float, float, float]] = [
            (*p, *q) for p, q in zip(source.tolist(), target.tolist(), strict=True)
        ]
        self.apex: dict[tuple[int, int], int] = {}
        for a, b, c in faces.tolist():
            self._add(a, b, c)
        # What follows on the boundary; there the walk around a vertex begins.
        self.next = dict(zip(rim, rim[1:] + rim[:1], strict=True))
        self.start: dict[int, int] = dict(self.apex.keys())
        self.start.update(self.next)

    def _add(self, a: int, b: int, c: int) -> None:
        self.apex[a, b], self.apex[b, c], self.apex[c, a] = c, a, b

    def _remove(self, a: int, b: int, c: int) -> None:
        del self.apex[a, b], self.apex[b, c], self.apex[c, a]

    def faces(self) -> NDArray[np.intp]:
        """Return the faces, each from its smallest vertex, in order."""
        rows = sorted((a, b, c) for (a, b), c in self.apex.items() if a < b and a < c)
        return np.array(rows, np.intp)

    def arrays(self) -> tuple[Array, Array]:
        """Return the points in the source and in the target."""
        points = np.array(self.points)
        return points[:, :2].copy(), points[:, 2:].copy()

    def place(self, source: Array, target: Array) -> None:
        """Take new positions."""
        self.points = list(map(tuple, np.concatenate([source, target], axis=1).tolist()))

    def ring(self, v: int) -> list[int]:
        """Return the neighbours of a vertex counter-clockwise; on the boundary from next to previous."""
        apex, first = self.apex, self.start[v]
        ring, w = [first], apex[v, first]
        while w != first:
            ring.append(w)
            if (v, w) not in apex:
                break
            w = apex[v, w]
        return ring

    def vertices(self) -> list[int]:
        """Return the vertices that are left."""
        return sorted(self.start)

    def edges(self) -> Iterator[tuple[int, int]]:
        """Return each edge once; a boundary edge in its own direction."""
        return ((a, b) for a, b in self.apex if a < b or (b, a) not in self.apex)

    def badness(self, a: int, b: int, c: int) -> tuple[float, float]:
        """Return f of a triangle in both planes; infinite where it is flat or turned over."""
        ax, ay, az, aw = self.points[a]
        bx, by, bz, bw = self.points[b]
        cx, cy, cz, cw = self.points[c]
        return _badness(bx - ax, by - ay, cx - ax, cy - ay), _badness(bz - az, bw - aw, cz - az, cw - aw)

    def worst(self, triangles: list[tuple[int, int, int]]) -> float:
        """Return the largest f of triangles in either plane."""
        return max(max(self.badness(*t)) for t in triangles)

    def flip(self, u: int, v: int) -> None:
        """Turn an inner edge in its quadrilateral."""
        w, x = self.apex[u, v], self.apex[v, u]
        self._remove(u, v, w)
        self._remove(v, u, x)
        self._add(x, v, w)
        self._add(w, u, x)
        if u not in self.next and self.start[u] == v:
            self.start[u] = w
        if v not in self.next and self.start[v] == u:
            self.start[v] = x

    def split(self, u: int, v: int) -> int:
        """Halve an edge in both planes and return its new vertex; a boundary edge in its direction."""
        new = len(self.points)
        p, q = self.points[u], self.points[v]
        self.points.append(tuple(0.5 * (s + t) for s, t in zip(p, q, strict=True)))  # type: ignore[arg-type]
        for a, b in ((u, v), (v, u)):
            if (a, b) in self.apex:
                w = self.apex[a, b]
                self._remove(a, b, w)
                self._add(a, new, w)
                self._add(new, b, w)
        if (v, u) not in self.apex and (v, new) not in self.apex:
            self.next[u], self.next[new] = new, v
        for a, b in ((u, v), (v, u)):
            if self.start[a] == b:
                self.start[a] = new
        self.start[new] = v
        return new

    def collapsed(self, u: int, v: int) -> list[tuple[int, int, int]] | None:
        """Return the triangles that pulling an inner vertex into a neighbour leaves, None if it cannot be."""
        ring = self.ring(u)
        if u in self.next or len(set(ring).intersection(self.ring(v))) != 2:
            return None
        k = ring.index(v)
        ring = ring[k + 1 :] + ring[:k]
        return [(v, a, b) for a, b in pairwise(ring)]

    def collapse(self, u: int, v: int) -> None:
        """Pull an inner vertex into a neighbour."""
        ring = self.ring(u)
        new = self.collapsed(u, v) or []
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
            self._remove(u, a, b)
        for triangle in new:
            self._add(*triangle)
        del self.start[u]
        for a, b in ((a, b) for _, a, b in new):
            for end, other in ((a, b), (b, v), (v, a)):
                if end not in self.next:
                    self.start[end] = other

    def compact(self, corners: int) -> "Mesh":
        """Return the same mesh numbered anew: the given corners, the rest of the boundary, the inside."""
        rim = [0]
        while self.next[rim[-1]] != 0:
            rim.append(self.next[rim[-1]])
        rest = [v for v in rim if v >= corners]
        order = [*range(corners), *rest, *(v for v in self.vertices() if v not in self.next)]
        number = np.zeros(len(self.points), np.intp)
        number[order] = np.arange(len(order))
        points = np.array(self.points)[order]
        return Mesh(points[:, :2], points[:, 2:], number[self.faces()], number[rim].tolist())


def _badness(bx: float, by: float, cx: float, cy: float) -> float:
    det = bx * cy - by * cx
    if det <= 0.0:
        return float("inf")
    dx, dy = cx - bx, cy - by
    f = _SCALE * (bx * bx + by * by + cx * cx + cy * cy + dx * dx + dy * dy) / det
    return f if f < _LIMIT else float("inf")
