"""Turn a valid common triangulation into a good one: thin it out, then refine and smooth, coarse to fine.

Every edit and every move keeps all triangles counter-clockwise in both planes
(Surazhsky and Gotsman, High quality compatible triangulations, 2004; Baxter,
Barla and Anjyo, Compatible embedding for 2D shape animation, 2009).  The
length of an edge is the root mean square of its lengths in the two planes,
each in units of the spacing there, so that a count of triangles can be asked
for.  Beside short boundary edges shorter ones are wanted, growing inwards.
"""

import heapq

import numpy as np
from numpy.typing import NDArray

from lietool.interp.compatible_mesh import Mesh
from lietool.interp.compatible_smooth import Stars, badness

Array = NDArray[np.float64]

_GROWTH = 0.4
_LONG, _SHORT = 1.4, 0.7
# A collapse may leave this badness, or what was there before.
_FAIR = 4.0
MOST = 50_000
"""Triangles that are made one edit at a time."""

_ROUNDS, _FIRST = 16, 2


class Remesher:
    """The state of the improvement: the mesh and the spacing in both planes."""

    def __init__(self, mesh: Mesh, spacing: tuple[float, float]) -> None:
        self.mesh = mesh
        self.unit = (0.5 / spacing[0] ** 2, 0.5 / spacing[1] ** 2)
        self.wanted: dict[int, float] = {}

    def length(self, u: int, v: int) -> float:
        """Return the length of an edge, in spacings."""
        a, b, c, d = self.mesh.points[u]
        e, f, g, h = self.mesh.points[v]
        p, q = self.unit
        return (p * ((e - a) ** 2 + (f - b) ** 2) + q * ((g - c) ** 2 + (h - d) ** 2)) ** 0.5

    def plan(self, coarse: float) -> None:
        """Set the edge length that is wanted at each vertex."""
        mesh = self.mesh
        wanted = dict.fromkeys(mesh.vertices(), coarse)
        for u, v in mesh.next.items():
            half = max(self.length(u, v), 1e-9)
            wanted[u], wanted[v] = min(wanted[u], half), min(wanted[v], half)
        heap = [(s, v) for v, s in wanted.items()]
        heapq.heapify(heap)
        while heap:
            s, v = heapq.heappop(heap)
            if s > wanted[v]:
                continue
            for w in mesh.ring(v):
                t = s + _GROWTH * self.length(v, w)
                if t < wanted[w]:
                    wanted[w] = t
                    heapq.heappush(heap, (t, w))
        self.wanted = wanted

    def stretch(self, u: int, v: int) -> float:
        """Return the length of an edge against what is wanted at its ends."""
        return 2.0 * self.length(u, v) / (self.wanted[u] + self.wanted[v])

    def cost(self, *triangles: tuple[int, int, int]) -> float:
        """Return the sum of the squared badness of triangles in both planes."""
        return sum(p * p + q * q for p, q in (self.mesh.badness(*t) for t in triangles))

    def flips(self) -> int:
        """Flip edges while that lowers the cost, and return how many were."""
        mesh, count = self.mesh, 0
        queue = self._worth_flipping()
        waiting = set(queue)
        for u, v in queue:  # grows while it is walked
            waiting.discard((u, v))
            w, x = mesh.apex.get((u, v)), mesh.apex.get((v, u))
            if w is None or x is None or (w, x) in mesh.apex or (x, w) in mesh.apex:
                continue
            after = self.cost((x, v, w), (w, u, x))
            if after < (1.0 - 1e-9) * self.cost((u, v, w), (v, u, x)):
                mesh.flip(u, v)
                count += 1
                for a, b in ((u, x), (x, v), (v, w), (w, u)):
                    edge = (a, b) if (a, b) in mesh.apex and (a < b or (b, a) not in mesh.apex) else (b, a)
                    if edge not in waiting:
                        waiting.add(edge)
                        queue.append(edge)
        return count

    def _worth_flipping(self) -> list[tuple[int, int]]:
        """Return the inner edges that a flip would improve, looked at all at once."""
        apex = self.mesh.apex
        rows = [(u, v, w, apex[v, u]) for (u, v), w in apex.items() if u < v and (v, u) in apex]
        u, v, w, x = np.array(sorted(rows), np.intp).reshape(-1, 4).T
        drawings = np.stack(self.mesh.arrays())

        def cost(*corners: NDArray[np.intp]) -> Array:
            return np.sum(badness(drawings, np.stack(corners, axis=1)) ** 2, axis=0)

        gain = cost(x, v, w) + cost(w, u, x) < (1.0 - 1e-9) * (cost(u, v, w) + cost(v, u, x))
        return list(zip(u[gain].tolist(), v[gain].tolist(), strict=True))

    def splits(self, most: int) -> int:
        """Halve the edges that are too long, the longest first, until there are so many triangles."""
        mesh = self.mesh
        heap = [(-self.stretch(u, v), u, v) for u, v in mesh.edges()]
        heap = [entry for entry in heap if entry[0] < -_LONG]
        heapq.heapify(heap)
        count = 0
        while heap and len(mesh.apex) < 3 * most:
            stretch, u, v = heapq.heappop(heap)
            if (u, v) not in mesh.apex or self.stretch(u, v) != -stretch:
                continue
            new = mesh.split(u, v)
            self.wanted[new] = 0.5 * (self.wanted[u] + self.wanted[v])
            count += 1
            for w in mesh.ring(new):
                edge = (new, w) if (new, w) in mesh.apex else (w, new)
                again = self.stretch(*edge)
                if again > _LONG:
                    heapq.heappush(heap, (-again, *edge))
        return count

    def collapses(self, short: float = _SHORT) -> int:
        """Remove inner vertices at edges that are too short, where the triangles stay fair."""
        mesh, count = self.mesh, 0
        order = sorted((self.stretch(u, v), u, v) for u, v in mesh.edges())
        for _, a, b in order:
            if self.stretch(a, b) >= short if a in mesh.start and b in mesh.start else True:
                continue
            if (a, b) not in mesh.apex:
                continue
            for u, v in ((a, b), (b, a)):
                if self._collapse(u, v):
                    count += 1
                    break
        return count

    def _collapse(self, u: int, v: int) -> bool:
        mesh = self.mesh
        after = mesh.collapsed(u, v)
        if after is None:
            return False
        ring = mesh.ring(u)
        before = mesh.worst([(u, a, b) for a, b in zip(ring, ring[1:] + ring[:1], strict=True)])
        if mesh.worst(after) > max(_FAIR, before):
            return False
        if max(self.stretch(v, w) for w in ring if w != v) > _LONG and before < _FAIR:
            return False
        mesh.collapse(u, v)
        return True

    def step(self, coarse: float, corners: int, most: int) -> None:
        """Bring the lengths of the edges near what is wanted, and smooth."""
        self.plan(coarse)
        self.collapses()
        self.flips()
        self.splits(most)
        self.flips()
        self.mesh = self.mesh.compact(corners)
        self.relax(2, 8)

    def smooth(self, sweeps: int, power: float) -> None:
        """Move the inner vertices of both drawings."""
        mesh = self.mesh
        faces = mesh.faces()
        movable = np.zeros(len(mesh.points), bool)
        movable[[v for v in mesh.start if v not in mesh.next]] = True
        if not movable.any():
            return
        stars = Stars(faces, movable)
        drawings = np.ascontiguousarray(np.stack(mesh.arrays()).transpose(2, 0, 1))
        for _ in range(sweeps):
            stars.sweep(drawings, power)
        mesh.place(*drawings.transpose(1, 2, 0))

    def relax(self, rounds: int, sweeps: int, power: float = 2.0) -> None:
        """Smooth and flip in turn until nothing flips."""
        for _ in range(rounds):
            self.smooth(sweeps, power)
            if not self.flips():
                break


def improve(mesh: Mesh, spacing: tuple[float, float], coarsest: float, triangles: int | None) -> Mesh:
    """Return a good mesh of about the given spacing or count, its first vertices the corners.

    Parameters
    ----------
    mesh : Mesh
    spacing : (float, float)
        The edge length wanted in the source and in the target.
    coarsest : float
        The length to begin with, in spacings.
    triangles : int or None
        If given, refinement ends there whatever the spacing: where the maps stretch
        much, triangles are slender and a spacing takes many more of them.
    """
    work = Remesher(mesh, spacing)
    corners, most = len(mesh.next), triangles or MOST
    work.flips()
    coarse = max(coarsest, 1.0)
    for turn in range(_ROUNDS):
        work.step(coarse, corners, most)
        if turn < _FIRST:
            continue
        count = len(work.mesh.apex) / 3
        if triangles is None:
            if coarse == 1.0:
                break
            coarse = max(1.0, 0.5 * coarse)
        else:
            if count > 0.95 * triangles:
                break
            coarse *= max(0.5, (count / triangles) ** 0.5)
    for _ in range(2):
        if triangles is not None:  # smoothing lets some be removed
            coarse *= float(np.clip((len(work.mesh.apex) / 3 / triangles) ** 0.5, 0.8, 1.0))
        work.step(coarse, corners, most)
    work.relax(8, 12)
    return work.mesh.compact(corners)
