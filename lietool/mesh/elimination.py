"""In which order to eliminate the unknowns of a sparse system, so that its factors stay sparse.

Up to some size minimum degree, as SuperLU finds it: its factors have the fewest entries.  Beyond, it
leaves fronts so wide that factoring a million triangles takes half a minute; nested dissection (George
1973), which cuts the shape in two by a line of vertices that come last, and each half again, has a fifth more
entries and is five times as fast.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

LARGE = 100_000
"""Unknowns from which on a mesh is dissected."""

LEAF = 16
"""Parts of so few vertices are not cut again."""


def order(pattern: Any, x: Array) -> Index:
    """Return an order of elimination.

    Parameters
    ----------
    pattern : sparse array by columns, shape (n, n)
        Symmetric; only where its entries are matters.
    x : ndarray, shape (n, 2)
        Where the unknowns are in the plane.

    Returns
    -------
    order : ndarray of int, shape (n,)
        The unknowns, the one to be eliminated first at the head.
    """
    n = pattern.shape[0]
    if n >= LARGE:
        columns = np.repeat(np.arange(n), np.diff(pattern.indptr))
        below = pattern.indices > columns
        return dissection(pattern.indices[below], columns[below], x)
    return _minimum_degree(pattern) if n else np.zeros(0, np.intp)


def superlu(matrix: Any, ordered: bool) -> Any:
    """Factor a positive definite matrix, in its own order or in one that keeps the factors sparse."""
    from scipy.sparse.linalg import splu

    return splu(
        matrix,
        permc_spec="NATURAL" if ordered else "MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        panel_size=1 if matrix.shape[0] < LARGE else 4,
        options={"SymmetricMode": True},
    )


def dissection(one: Index, other: Index, x: Array) -> Index:
    """Return the order of nested dissection, all parts of a level cut at once.

    Parameters
    ----------
    one, other : ndarray of int, shape (k,)
        The pairs of unknowns that an equation joins.
    x : ndarray, shape (n, 2)

    Returns
    -------
    order : ndarray of int, shape (n,)
    """
    n = len(x)
    rank = np.argsort(np.argsort(x, axis=0, kind="stable"), axis=0)
    # One digit for each level: 0 and 1 for the halves, 2 for what separates them.
    code, part, side = np.zeros(n, np.int64), np.zeros(n, np.intp), np.zeros(n, np.int64)
    live = np.arange(n)
    active = np.ones(n, bool)
    while len(live):
        half, small = _halves(part[live], x[live], rank[live])
        side[live] = half
        inside = active[one] & active[other] & (part[one] == part[other])
        one, other = one[inside], other[inside]
        cut = side[one] != side[other]
        across = np.where(side[one] == 0, one, other)[cut]
        code *= 3
        code[live] += half
        # They are in half 0, so that the digit becomes 2: indexed so, each is added to once.
        code[across] += 2
        active[across], active[live[small]] = False, False
        live = live[active[live]]
        number = np.zeros(2 * len(small), np.intp)
        mine = 2 * part[live] + side[live]
        number[mine] = 1
        part[live] = (np.cumsum(number) - 1)[mine]
    return np.argsort(code, kind="stable")


def _halves(part: Index, x: Array, rank: Index) -> tuple[Index, NDArray[np.bool_]]:
    """Cut parts across their longer sides; which half each vertex is in, and whether its part is small."""
    count = int(part.max()) + 1
    size = np.bincount(part, minlength=count)
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, part, x)
    np.maximum.at(high, part, x)
    axis = np.argmax(high - low, axis=1)[part]
    key = part * (int(rank.max()) + 1) + np.where(axis == 0, rank[:, 0], rank[:, 1])
    place = np.empty(len(part), np.intp)
    place[np.argsort(key)] = np.arange(len(part))
    within = place - (np.cumsum(size) - size)[part]
    return (2 * within >= size[part]).astype(np.intp), size[part] <= LEAF


def _minimum_degree(pattern: Any) -> Index:
    from scipy.sparse import csc_array

    n = pattern.shape[0]
    # A matrix of this pattern that is diagonally dominant: only the pattern matters.
    data = np.where(pattern.indices == np.repeat(np.arange(n), np.diff(pattern.indptr)), float(n), -1e-3)
    factor = superlu(csc_array((data, pattern.indices, pattern.indptr), (n, n)), False)
    return np.argsort(factor.perm_c).astype(np.intp)
