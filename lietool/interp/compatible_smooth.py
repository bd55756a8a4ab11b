"""Move the inner vertices of a planar mesh to where its triangles are closest to equilateral.

A triangle's badness f = (sum of squared sides) / (4 sqrt(3) area) is 1 for an
equilateral one and infinite for a flat one.  As a function of one vertex it is
a square over a positive affine function, hence convex, and so is the sum of
its powers over the triangles around: Newton's step for each vertex, cut until
the sum falls, cannot turn a triangle over.  Vertices that share no edge are
moved together.  (Hormann and Greiner's MIPS energy, 2000, against the
equilateral triangle.)
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]
Pair = tuple[Array, Array]

_SQRT12 = 2.0 * np.sqrt(3.0)
_STEPS = 0.5 ** np.arange(1.0, 8.0)
# Beyond this a determinant could be rounding: 1e10 leaves five digits of it.
WORST = 1e10


def badness(points: Array, faces: Ints) -> Array:
    """Return f of each triangle: 1 if equilateral, infinite if not counter-clockwise.

    Parameters
    ----------
    points : (..., n, 2)
    faces : (m, 3) of int

    Returns
    -------
    f : (..., m)
    """
    a, b, c = (points[..., faces[:, k], :] for k in range(3))
    return _badness(*((p[..., 0], p[..., 1]) for p in (a, b, c)))


def _badness(a: Pair, b: Pair, v: Pair) -> Array:
    # Coordinates apart: sums over an axis of length 2 would take most of the time.
    abx, aby, avx, avy = b[0] - a[0], b[1] - a[1], v[0] - a[0], v[1] - a[1]
    bvx, bvy = v[0] - b[0], v[1] - b[1]
    sides = abx * abx + aby * aby + avx * avx + avy * avy + bvx * bvx + bvy * bvy
    twice = _SQRT12 * (abx * avy - aby * avx)
    good = twice * WORST > sides
    return np.where(good, sides / np.where(good, twice, 1.0), np.inf)


class Stars:
    """The triangles around each movable vertex, by groups of vertices that share no edge."""

    def __init__(self, faces: Ints, movable: NDArray[np.bool_]) -> None:
        corner = faces.ravel()
        order = np.argsort(corner, kind="stable")
        order = order[movable[corner[order]]]
        left, right = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
        first = np.searchsorted(corner[order], np.arange(len(movable) + 1))
        degree = np.diff(first)
        self.groups: list[tuple[Ints, Ints, Ints, NDArray[np.bool_]]] = []
        for vertices in _groups(faces, movable):
            slot = np.arange(degree[vertices].max())
            real = slot < degree[vertices][:, None]
            # A missing triangle repeats the first one and is not counted.
            at = order[first[vertices][:, None] + np.where(real, slot, 0)]
            self.groups.append((vertices, left[at], right[at], real))

    def sweep(self, points: Array, power: float) -> None:
        """Move each movable vertex once, in place.

        Parameters
        ----------
        points : (2, k, n)
            x and y, of each of k drawings.
        power : float
            At least 1; the larger, the more the worst triangles count.
        """
        for vertices, left, right, real in self.groups:
            a, b, v = points[:, :, left], points[:, :, right], points[:, :, vertices]
            now, step = _newton(a, b, v[..., None], real, power)
            trial = v + step
            late = _energy(a, b, trial, real, power) >= now
            if late.any():
                k, i = np.nonzero(late)
                some = v[:, k, i] + _STEPS[:, None, None] * step[:, k, i]
                energy = _energy(a[:, k, i], b[:, k, i], some.transpose(1, 0, 2), real[i], power)
                pick, rows = np.argmin(energy, axis=0), np.arange(len(k))
                better = energy[pick, rows] < now[k, i]
                trial[:, k, i] = np.where(better, some[pick, :, rows].T, v[:, k, i])
            points[:, :, vertices] = trial


def _energy(a: Array, b: Array, v: Array, real: NDArray[np.bool_], power: float) -> Array:
    f = _badness((a[0], a[1]), (b[0], b[1]), (v[0][..., None], v[1][..., None]))
    return np.sum(np.where(real, f, 0.0) ** power, axis=-1)


def _newton(a: Array, b: Array, v: Array, real: NDArray[np.bool_], power: float) -> tuple[Array, Array]:
    """Return the sum of f^power and Newton's step for it; along the gradient where that is singular."""
    sx, sy = _SQRT12 * (a[1] - b[1]), _SQRT12 * (b[0] - a[0])
    f = np.where(real, _badness((a[0], a[1]), (b[0], b[1]), (v[0], v[1])), 1.0)
    inverse = 1.0 / np.where(real, sx * (v[0] - a[0]) + sy * (v[1] - a[1]), 1.0)
    fx = (2.0 * (2.0 * v[0] - a[0] - b[0]) - f * sx) * inverse
    fy = (2.0 * (2.0 * v[1] - a[1] - b[1]) - f * sy) * inverse
    top = f.max(axis=-1, keepdims=True)
    weight = np.where(real, power * (f / top) ** (power - 1.0), 0.0)
    gx, gy = np.sum(weight * fx, axis=-1), np.sum(weight * fy, axis=-1)
    bend = (power - 1.0) / f
    p = np.sum(weight * ((4.0 - 2.0 * fx * sx) * inverse + bend * fx * fx), axis=-1)
    q = np.sum(weight * (bend * fx * fy - (fx * sy + fy * sx) * inverse), axis=-1)
    r = np.sum(weight * ((4.0 - 2.0 * fy * sy) * inverse + bend * fy * fy), axis=-1)
    det = p * r - q * q
    det = np.where(det > 1e-14 * (p + r) ** 2, det, (p + r) ** 2)
    now = np.sum(np.where(real, f, 0.0) ** power, axis=-1)
    return now, np.stack([q * gy - r * gx, q * gx - p * gy]) / det


def _groups(faces: Ints, movable: NDArray[np.bool_]) -> list[Ints]:
    """Return the movable vertices in groups without an edge inside, greedily."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.concatenate([edges, edges[:, ::-1]]), axis=0)
    edges = edges[movable[edges].all(axis=1)]
    neighbours: dict[int, list[int]] = {}
    for v, w in edges.tolist():
        neighbours.setdefault(v, []).append(w)
    colour: dict[int, int] = {}
    groups: list[list[int]] = []
    for v in np.flatnonzero(movable).tolist():
        taken = {colour.get(w) for w in neighbours.get(v, ())}
        k = next(k for k in range(len(taken) + 1) if k not in taken)
        colour[v] = k
        if k == len(groups):
            groups.append([])
        groups[k].append(v)
    return [np.array(g, np.intp) for g in groups]
