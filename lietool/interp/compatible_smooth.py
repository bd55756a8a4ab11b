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

_SQRT12 = 2.0 * np.sqrt(3.0)
_STEPS = 0.5 ** np.arange(8.0)
# Beyond this a determinant could be rounding: 1e10 leaves five digits of it.
WORST = 1e10


def badness(points: Array, faces: Ints) -> Array:
    """Return f of each triangle: 1 if equilateral, infinite if not counter-clockwise.

    Parameters
    ----------
    points : (n, 2)
    faces : (m, 3) of int

    Returns
    -------
    f : (m,)
    """
    a, b, c = (points[faces[:, k]] for k in range(3))
    return _badness(a, b, c)


def _badness(a: Array, b: Array, v: Array) -> Array:
    ab, av, bv = b - a, v - a, v - b
    sides = np.sum(ab * ab, axis=-1) + np.sum(av * av, axis=-1) + np.sum(bv * bv, axis=-1)
    twice = ab[..., 0] * av[..., 1] - ab[..., 1] * av[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        f = sides / (_SQRT12 * twice)
    return np.where((twice > 0.0) & (f < WORST), f, np.inf)


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
        points : (n, 2)
        power : float
            At least 1; the larger, the more the worst triangles count.
        """
        for vertices, left, right, real in self.groups:
            a, b, v = points[left], points[right], points[vertices]
            step = _newton(a, b, v, real, power)
            trial = v + _STEPS[:, None, None] * step
            f = np.where(real, _badness(a, b, trial[..., None, :]), 1.0)
            energy = np.sum(f**power, axis=-1)
            now = np.sum(np.where(real, _badness(a, b, v[:, None]), 1.0) ** power, axis=-1)
            pick = np.argmin(energy, axis=0)
            rows = np.arange(len(vertices))
            better = energy[pick, rows] < now
            points[vertices[better]] = trial[pick, rows][better]


def _newton(a: Array, b: Array, v: Array, real: NDArray[np.bool_], power: float) -> Array:
    """Return Newton's step of the sum of f^power, or one along the gradient where that is singular."""
    ab = b - a
    slope = _SQRT12 * np.stack([-ab[..., 1], ab[..., 0]], axis=-1)
    f = np.where(real, _badness(a, b, v[:, None]), 1.0)
    det = np.where(real, np.sum(slope * (v[:, None] - a), axis=-1), 1.0)
    df = (2.0 * (2.0 * v[:, None] - a - b) - f[..., None] * slope) / det[..., None]
    cross = df[..., :, None] * slope[..., None, :]
    ddf = (4.0 * np.eye(2) - cross - np.swapaxes(cross, -1, -2)) / det[..., None, None]
    weight = np.where(real, power * (f / f.max(axis=1, keepdims=True)) ** (power - 1.0), 0.0)
    gradient = np.sum(weight[..., None] * df, axis=1)
    squares = ((power - 1.0) * weight / f)[..., None, None] * (df[..., :, None] * df[..., None, :])
    hessian = np.sum(weight[..., None, None] * ddf + squares, axis=1)
    p, q, r = hessian[:, 0, 0], hessian[:, 0, 1], hessian[:, 1, 1]
    det = p * r - q * q
    det = np.where(det > 1e-14 * (p + r) ** 2, det, (p + r) ** 2)
    x, y = gradient[:, 0], gradient[:, 1]
    return np.stack([q * y - r * x, q * x - p * y], axis=-1) / det[:, None]


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
