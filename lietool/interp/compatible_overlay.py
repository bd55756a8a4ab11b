"""A first triangulation common to two polygons: the overlay of one triangulation of each.

Aronov, Seidel and Souvaine (On compatible triangulations of simple polygons,
1993) draw the diagonals of both triangulations in a regular polygon and take
their crossings as new vertices.  Only the order of the crossings along each
diagonal matters: a face of the overlay lies in one triangle of either polygon
and has at most two corners on each side of it, so it is strictly convex
wherever on the diagonals the crossings are put.  Here they are spread evenly,
which no shape can crowd.  The triangulations themselves are those with the
fewest crossings, by dynamic programming over all diagonals, each polygon in
turn (Klincsek's algorithm with the crossings as weights).
"""

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from lietool.mesh.predicates import orientation

Array = NDArray[np.float64]
Chords = NDArray[np.intp]

_SHAPE_WEIGHT = 0.1
_ROUNDS = 8
# Diagonals that pass a corner closer than this, relative to the polygon's size, are a last resort.
_CLEARANCES = (1e-7, 1e-11, 1e-15)


class OverlayError(Exception):
    """No triangulation was found, although one exists: the corners are too close to a line."""


def common(P: Array, Q: Array) -> tuple[Array, Array, NDArray[np.intp]]:
    """Return points and faces of the overlay in both polygons.

    Parameters
    ----------
    P, Q : (n, 2)
        Simple, counter-clockwise.

    Returns
    -------
    source, target : (n + k, 2)
        The corners, then the crossings.
    faces : (m, 3) of int
        Counter-clockwise in both.
    """
    for clearance in _CLEARANCES:
        try:
            return _common(P, Q, clearance)
        except OverlayError:
            if clearance == _CLEARANCES[-1]:
                raise
    raise OverlayError


def _common(P: Array, Q: Array, clearance: float) -> tuple[Array, Array, NDArray[np.intp]]:
    n = len(P)
    first, second = _pair(P, Q, clearance)
    shared = _members(first, second)
    crossing = _crossings(first[~shared], second[~_members(second, first)])
    pairs = np.stack(np.nonzero(crossing), axis=1)
    ends = np.concatenate(
        [first[~shared][pairs[:, 0]], second[~_members(second, first)][pairs[:, 1]]], axis=1
    )
    along_first = _paths(n, first, ends, 0)
    along_second = _paths(n, second, ends, 1)
    source = _spread(P, len(ends), along_first)
    target = _spread(Q, len(ends), along_second)
    only_second = [along_second[k] for k in np.flatnonzero(~_members(second, first))]
    polygons = _faces(n, ends, along_first + only_second)
    return source, target, _fans(polygons, source, target)


def _pair(P: Array, Q: Array, clearance: float) -> tuple[Chords, Chords]:
    """Return the diagonals of a triangulation of each polygon, with few crossings between them."""
    n = len(P)
    seen, shape = zip(*((_visible(X, clearance), _Shapes(X)) for X in (P, Q)), strict=True)
    # Start with diagonals that the other polygon has as well.
    chords = [_best(P, seen[0], (~seen[1]).astype(float), shape[0])]
    chords.append(_best(Q, seen[1], _weights(n, chords[0]), shape[1]))
    count = int(_crossings(*chords).sum())
    for turn in range(_ROUNDS):
        k = turn % 2
        trial = _best((P, Q)[k], seen[k], _weights(n, chords[1 - k]), shape[k])
        fewer = int(_crossings(*((trial, chords[1]) if k == 0 else (chords[0], trial))).sum())
        if fewer < count:
            chords[k], count = trial, fewer
        elif turn:
            break
    return chords[0], chords[1]


class _Shapes:
    """Costs of the triangles (i, k, j) of a polygon, i < k < j, for all i and k at once."""

    def __init__(self, points: Array) -> None:
        self.x, self.y = (c - c[:, None] for c in points.T.copy())  # [i, j]: from i to j
        self.squares = self.x**2 + self.y**2

    def cost(self, span: int) -> Array:
        """Return the costs, shape (n - span, span - 1), for j = i + span."""
        x, y = _towards(self.x, span), _towards(self.y, span)
        det = _diagonal(self.y, span) * x - _diagonal(self.x, span) * y
        sides = _diagonal(self.squares, span) + _towards(self.squares, span) + _from(self.squares, span)
        with np.errstate(divide="ignore", invalid="ignore"):
            cost = _SHAPE_WEIGHT * np.log2(sides / det)
        # The sign must be beyond doubt: 1e-13 is far above the rounding of the two products.
        return np.where(det > 1e-13 * sides, cost, np.inf)


def _towards(matrix: Array, span: int) -> Array:
    """Return the entries (i, k) for all k from i + 1 to i + span - 1, without copying."""
    n = len(matrix)
    return as_strided(matrix[:, 1:], (n - span, span - 1), (8 * n + 8, 8), writeable=False)


def _from(matrix: Array, span: int) -> Array:
    """Return the entries (i + span, k) for the same k; a symmetric matrix has the same at (k, i + span)."""
    n = len(matrix)
    return as_strided(matrix[span:, 1:], (n - span, span - 1), (8 * n + 8, 8), writeable=False)


def _diagonal(matrix: Array, span: int) -> Array:
    """Return the entries (i, i + span) as a column."""
    return np.diagonal(matrix, span)[:, None]


def _best(points: Array, seen: NDArray[np.bool_], weight: Array, shapes: _Shapes) -> Chords:
    """Return the diagonals of the triangulation of least weight."""
    n = len(points)
    cost = np.full((n, n), np.inf)
    choice = np.zeros((n, n), np.intp)
    edge = np.arange(n - 1)
    cost[edge, edge + 1] = cost[edge + 1, edge] = 0.0
    for span in range(2, n):
        total = _towards(cost, span) + _from(cost, span) + shapes.cost(span)
        pick = np.argmin(total, axis=1)
        i = np.arange(n - span)
        j = i + span
        closed = span == n - 1
        cost[i, j] = np.where(closed | seen[i, j], total[i, pick] + (0.0 if closed else weight[i, j]), np.inf)
        cost[j, i] = cost[i, j]
        choice[i, j] = i + 1 + pick
    if not np.isfinite(cost[0, n - 1]):
        raise OverlayError
    chords, stack = [], [(0, n - 1)]
    while stack:
        i, j = stack.pop()
        if j - i > 1:
            k = int(choice[i, j])
            chords += [pair for pair in ((i, k), (k, j)) if pair[1] - pair[0] > 1]
            stack += [(i, k), (k, j)]
    return np.array(sorted(chords), np.intp).reshape(-1, 2)


def _visible(points: Array, clearance: float) -> NDArray[np.bool_]:
    """Return which diagonals lie inside a polygon, well clear of its other corners."""
    n = len(points)
    x, y = (c - c[:, None] for c in points.T.copy())  # [i, j]: from i to j
    margin = clearance * np.ptp(points, axis=0).max()
    this, after = np.arange(n), np.roll(np.arange(n), -1)
    before = np.roll(after, 2)
    ux, uy = x[this, after], y[this, after]
    # [j, k]: whether point j is on the left of the edge from k.
    ahead = (ux[:, None] * y - uy[:, None] * x > 0.0).T.copy()
    turn = x[before, this] * uy - y[before, this] * ux
    seen = np.zeros((n, n), bool)
    for i in range(n - 2):
        j = np.arange(i + 2, n - (i == 0))
        left = ux[i] * y[i, j] - uy[i] * x[i, j] > 0.0
        right = x[before[i], i] * y[i, j] - y[before[i], i] * x[i, j] > 0.0
        j = j[(left & right) if turn[i] > 0.0 else (left | right)]
        dx, dy = x[i, j, None], y[i, j, None]
        side = dx * y[i] - dy * x[i]  # of all corners of each diagonal, times its length
        sign = side > 0.0
        across = (sign != sign[:, after]) & (ahead[i] != ahead[j])
        rows = np.arange(len(j))
        across[:, [i, i - 1]] = False
        across[rows, j] = across[rows, j - 1] = False
        # Corners beside the diagonal block it, too.
        row, corner = np.nonzero(np.abs(side) <= margin * np.hypot(dx, dy))
        reach = dx[row, 0] * x[i, corner] + dy[row, 0] * y[i, corner]
        beside = (
            (reach > 0.0) & (reach < dx[row, 0] ** 2 + dy[row, 0] ** 2) & (corner != i) & (corner != j[row])
        )
        blocked = across.any(axis=1)
        blocked[row[beside]] = True
        seen[i, j] = ~blocked
    return seen


def _weights(n: int, chords: Chords) -> Array:
    """Return for each pair (i, j), i < j, how many diagonals cross it."""
    ends = np.zeros((n + 1, n + 1))
    np.add.at(ends, (chords[:, 0] + 1, chords[:, 1] + 1), 1.0)
    total = ends.cumsum(axis=0).cumsum(axis=1)  # [a, b]: diagonals with ends below a and below b
    i, j = np.arange(n)[:, None], np.arange(n)[None, :]
    top = np.full((n, n), n)
    # One end strictly between i and j, the other before i or after j.
    after = total[j, top] - total[i + 1, top] - total[j, j + 1] + total[i + 1, j + 1]
    before = total[i, j] - total[i, np.minimum(i + 1, n)]
    return np.where(j > i + 1, after + before, 0.0)


def _members(chords: Chords, others: Chords) -> NDArray[np.bool_]:
    known = set(map(tuple, others.tolist()))
    return np.array([tuple(c) in known for c in chords.tolist()], bool)


def _crossings(first: Chords, second: Chords) -> NDArray[np.bool_]:
    """Return which diagonals cross, shape (len(first), len(second))."""
    a, b = first[:, 0, None], first[:, 1, None]
    c, d = second[:, 0], second[:, 1]
    return ((a < c) & (c < b) & (b < d)) | ((c < a) & (a < d) & (d < b))


def _paths(n: int, chords: Chords, ends: Chords, which: int) -> list[list[int]]:
    """Return the vertices along each diagonal: its first corner, the crossings in order, its last."""
    of: dict[tuple[int, int], list[int]] = {tuple(c): [] for c in chords.tolist()}
    keys = []
    for k, (a, b, c, d) in enumerate(ends.tolist()):
        (i, j), (p, q) = ((a, b), (c, d)) if which == 0 else ((c, d), (a, b))
        inner, outer = (p, q) if i < p < j else (q, p)
        of[i, j].append(k)
        # From i to j the inner ends go forwards around the polygon and the outer ends go backwards.
        keys.append((inner, -((outer - i) % n)))
    return [[i, *(n + k for k in sorted(of[i, j], key=keys.__getitem__)), j] for i, j in chords.tolist()]


def _spread(corners: Array, count: int, paths: list[list[int]]) -> Array:
    points = np.concatenate([corners, np.full((count, 2), np.nan)])
    for path in paths:
        t = np.linspace(0.0, 1.0, len(path))[1:-1, None]
        points[path[1:-1]] = (1.0 - t) * corners[path[0]] + t * corners[path[-1]]
    return points


def _faces(n: int, ends: Chords, paths: list[list[int]]) -> list[list[int]]:
    """Return the faces on the left of all edges inside, from the order of the edges around each vertex."""
    towards: list[dict[int, int]] = [
        {} for _ in range(n + len(ends))
    ]  # corner in that direction -> neighbour
    for i in range(n):
        towards[i][(i + 1) % n] = (i + 1) % n
        towards[i][i - 1 if i else n - 1] = i - 1 if i else n - 1
    for path in paths:
        for k, v in enumerate(path):
            if k:
                towards[v][path[0]] = path[k - 1]
            if k < len(path) - 1:
                towards[v][path[-1]] = path[k + 1]
    before: dict[tuple[int, int], int] = {}
    for v, corners in enumerate(towards):
        turn = sorted(corners, key=lambda c: (c - v - 1) % n) if v < n else sorted(corners)
        around = [corners[c] for c in turn]
        for k, u in enumerate(around):
            before[v, u] = around[k - 1]
    faces, used = [], {((i + 1) % n, i) for i in range(n)}
    for v, u in before:
        face, a, b = [], v, u
        while (a, b) not in used:
            used.add((a, b))
            face.append(a)
            a, b = b, before[b, a]
        if face:
            faces.append(face)
    return faces


def _fans(polygons: list[list[int]], source: Array, target: Array) -> NDArray[np.intp]:
    """Return each strictly convex face as a fan from the corner that gives the best worst triangle."""
    rows, owner = [], []
    for k, face in enumerate(polygons):
        for s in range(len(face) if len(face) > 3 else 1):
            turned = face[s:] + face[:s]
            rows += [(turned[0], turned[i], turned[i + 1]) for i in range(1, len(face) - 1)]
            owner += [(k, s)] * (len(face) - 2)
    triangles = np.array(rows, np.intp)
    worst = np.full(len(rows), np.inf)
    for points in (source, target):
        a, b, c = (points[triangles[:, k]] for k in range(3))
        sides = sum(np.sum((p - q) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a)))
        twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        quality = np.where(orientation(a, b, c) > 0, np.maximum(twice, 1e-300) / sides, -1.0)
        worst = np.minimum(worst, quality)
    best: dict[int, tuple[float, int]] = {}
    grade: dict[tuple[int, int], float] = {}
    for key, quality in zip(owner, worst.tolist(), strict=True):
        grade[key] = min(grade.get(key, np.inf), quality)
    for (k, s), quality in grade.items():
        if k not in best or quality > best[k][0]:
            best[k] = (quality, s)
    if min(quality for quality, _ in best.values()) <= 0.0:
        raise OverlayError
    return triangles[[best[k][1] == s for k, s in owner]]
