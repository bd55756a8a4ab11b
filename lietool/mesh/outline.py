"""Closed outlines in the plane: what makes one usable, and where it fails to be."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh.predicates import orientation

Array = NDArray[np.float64]

# Pairs of edges looked at in one go: a few tens of megabytes.
_PAIRS = 1 << 20


def area(points: Array) -> float:
    """Return the signed area of an outline: positive if it runs counter-clockwise.

    Parameters
    ----------
    points : (n, 2)

    Returns
    -------
    area : float
        In the square of the unit of the points.
    """
    x, y = (points - points[0]).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2.0)


def lengths(points: Array) -> Array:
    """Return the length of each edge of an outline; edge i runs from point i to the next.

    Parameters
    ----------
    points : (n, 2)

    Returns
    -------
    lengths : (n,)
    """
    return np.hypot(*(np.roll(points, -1, axis=0) - points).T)


def check(where: str, name: str, points: ArrayLike, remedy: str = "Move or leave out points there.") -> Array:
    """Return a simple polygon as an array of its own, or say where it is not one.

    Parameters
    ----------
    where : str
        The function that asks, for the message.
    name : str
        Its argument, for the message.
    points : (n, 2)
        The corners in order, the first not repeated at the end; in either direction.
    remedy : str
        What to do where it crosses itself, for the message.

    Returns
    -------
    points : (n, 2) of float64

    Raises
    ------
    ValueError
        If there are fewer than three points, or one is not finite, or two coincide, or
        the outline folds back, touches or crosses itself, or encloses nothing.
    """
    array = checks.array(where, name, points, (2,)).copy()
    if array.ndim != 2 or len(array) < 3:
        wanted = "an array of shape (n, 2), n at least 3"
        checks.fail(where, name, wanted, f"shape {array.shape}", None, "Give the corners of one outline.")
    _check_distinct(where, name, array)
    _check_turns(where, name, array)
    _check_crossings(where, name, array, remedy)
    return array


def _at(point: Array) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _check_distinct(where: str, name: str, points: Array) -> None:
    order = np.lexsort(points.T)
    same = np.flatnonzero(np.all(points[order[1:]] == points[order[:-1]], axis=1))
    if not len(same):
        return
    pairs = np.sort(np.stack([order[same], order[same + 1]], axis=1), axis=1)
    i, j = (int(k) for k in pairs[np.lexsort(pairs.T[::-1])[0]])
    closing = i == 0 and j == len(points) - 1
    remedy = (
        "Leave out the last point: outlines close by themselves." if closing else "Leave one of them out."
    )
    got = f"point {i} again as point {j}, {_at(points[j])},"
    checks.fail(where, name, "an outline of distinct points", got, (j,), remedy)


def _check_turns(where: str, name: str, points: Array) -> None:
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    straight = orientation(before, points, after) == 0
    backwards = straight & (np.sum((points - before) * (after - points), axis=1) < 0.0)
    if straight.all():
        got = f"{len(points)} points on one line"
        checks.fail(where, name, "an outline that encloses an area", got, None)
    if backwards.any():
        (i,) = checks.first(backwards)
        got = f"one that turns back on itself, {_at(points[i])},"
        checks.fail(where, name, "a simple polygon", got, (i,), "Leave the spike out.")


def _check_crossings(where: str, name: str, points: Array, remedy: str) -> None:
    n = len(points)
    after = np.roll(points, -1, axis=0)
    low, high = np.minimum(points, after), np.maximum(points, after)
    step = max(1, _PAIRS // n)
    for start in range(0, n, step):
        rows = np.arange(start, min(start + step, n))
        near = np.all((low[rows, None] <= high) & (high[rows, None] >= low), axis=-1)
        i, j = np.nonzero(near & (np.arange(n) > rows[:, None] + 1))
        i = rows[i]
        apart = (j + 1) % n != i
        i, j = i[apart], j[apart]
        bad = _meet(points[i], after[i], points[j], after[j])
        if bad.any():
            k = int(np.argmax(bad))
            _report_crossing(where, name, points, int(i[k]), int(j[k]), remedy)


def _meet(a: Array, b: Array, c: Array, d: Array) -> NDArray[np.bool_]:
    """Whether segments ab and cd, whose boxes overlap, have a point in common."""
    return (orientation(a, b, c) * orientation(a, b, d) <= 0) & (
        orientation(c, d, a) * orientation(c, d, b) <= 0
    )


def _report_crossing(where: str, name: str, points: Array, i: int, j: int, remedy: str) -> None:
    n = len(points)
    a, b, c, d = points[i], points[(i + 1) % n], points[j], points[(j + 1) % n]
    u, v, w = b - a, d - c, c - a
    det = u[0] * v[1] - u[1] * v[0]
    place = a + u * ((w[0] * v[1] - w[1] * v[0]) / det) if det else c
    edges = f"{i}-{(i + 1) % n} and {j}-{(j + 1) % n}"
    got = f"edges {edges} that meet near {_at(place)},"
    checks.fail(where, name, "a simple polygon", got, (i,), remedy)


def narrowest(points: Array) -> tuple[float, Array]:
    """Return the least distance of a corner of a polygon from an edge that it is no end of, and that corner.

    Parameters
    ----------
    points : (n, 2)
        n at least 4.

    Returns
    -------
    distance : float
    corner : (2,)
    """
    n = len(points)
    z = points[:, 0] + 1j * points[:, 1]
    side = np.roll(z, -1) - z
    best = (np.inf, points[0])
    for i in range(n):
        along = np.clip(((z[i] - z) * side.conj()).real / np.abs(side) ** 2, 0.0, 1.0)
        apart = np.abs(z[i] - z - along * side)
        apart[[i, i - 1]] = np.inf
        if apart.min() < best[0]:
            best = (float(apart.min()), points[i])
    return best
