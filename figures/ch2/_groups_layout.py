"""Layers for a partial order: who is above whom, in which order side by side, and where on the page.

Levels are longest chains; an arrow over several levels gets a place of its own in each between them; the
order within the levels is the one with the fewest crossings that sweeps find; then all is pulled straight.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

_STARTS, _SWEEPS = 12, 8
# How strongly everything is drawn to the middle.
_TOGETHER = 0.1
# How much an arrow likes to be straight, by how many of its ends are only places on its way.
_STRAIGHT = (1.0, 2.0, 8.0)


@dataclass(frozen=True, eq=False)
class Layout:
    """Where nodes and arrows go.

    Parameters
    ----------
    level : ndarray of int, shape (n,)
        0 for the lowest.
    x : ndarray, shape (n,)
        From the middle, in page units.
    ways : tuple of ndarray
        For each arrow the points (k, 2) in (x, level) that it goes through, its ends included.
    crossings : int
        How many pairs of arrows cross between the levels.
    """

    level: np.ndarray
    x: np.ndarray
    ways: tuple[np.ndarray, ...]
    crossings: int


def levels(n: int, arrows: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return the length of the longest chain of arrows that ends in each of n nodes, which goes upwards.

    A node that nothing enters is put right below what it leads to.
    """
    level = np.zeros(n, int)
    for _ in range(n):
        for a, b in arrows:
            level[b] = max(level[b], level[a] + 1)
    for _ in range(n):
        for a in range(n):
            above = [level[b] for s, b in arrows if s == a]
            if above and not any(b == a for _, b in arrows):
                level[a] = min(above) - 1
    return level


def arrange(n: int, arrows: Sequence[tuple[int, int]], apart: float, aside: float, width: float) -> Layout:
    """Return a layout of n nodes that lie at least `apart`, and `aside` from arrows that pass between them.

    Their middles keep within `width`, if the fullest row can.
    """
    level = levels(n, arrows)
    links, chains, at = _with_places(level, arrows)
    rows = [[i for i in range(len(at)) if at[i] == k] for k in range(int(at.max(initial=0)) + 1)]
    rows = _ordered(rows, links)
    x = _straightened(rows, links, n, (apart, aside), width)
    ways = tuple(np.stack([x[chain], at[chain]], axis=-1) for chain in chains)
    return Layout(level, x[:n], ways, _crossings(rows, links))


def _with_places(
    level: np.ndarray, arrows: Sequence[tuple[int, int]]
) -> tuple[list[tuple[int, int]], list[list[int]], np.ndarray]:
    """Cut every arrow into pieces from one level to the next; the new places are numbered after the nodes."""
    at = list(level)
    links, chains = [], []
    for a, b in arrows:
        chain = [a]
        for k in range(int(level[a]) + 1, int(level[b])):
            chain.append(len(at))
            at.append(np.int64(k))
        chain.append(b)
        chains.append(chain)
        links += list(pairwise(chain))
    return links, chains, np.array(at, int)


def _crossings(rows: list[list[int]], links: Sequence[tuple[int, int]]) -> int:
    place = {node: i for row in rows for i, node in enumerate(row)}
    level = {node: k for k, row in enumerate(rows) for node in row}
    count = 0
    for k in range(len(rows) - 1):
        ends = np.array([(place[a], place[b]) for a, b in links if level[a] == k]).reshape(-1, 2)
        across = (ends[:, None] - ends[None]).prod(axis=-1) < 0
        count += int(across.sum()) // 2
    return count


def _ordered(rows: list[list[int]], links: Sequence[tuple[int, int]]) -> list[list[int]]:
    """The order with the fewest crossings, and among those the one with the shortest arrows."""
    rng = np.random.default_rng(0)
    best, least = rows, (np.inf, np.inf)
    for start in range(_STARTS):
        trial = [list(row) if start == 0 else [int(i) for i in rng.permutation(row)] for row in rows]
        for sweep in range(_SWEEPS):
            upwards = sweep % 2 == 0
            order = range(1, len(trial)) if upwards else range(len(trial) - 2, -1, -1)
            for k in order:
                _by_middle(trial, k, k - 1 if upwards else k + 1, links)
            cost = _cost(trial, links)
            if cost < least:
                best, least = [list(row) for row in trial], cost
    _exchanged(best, links)
    # Of a diagram and its mirror image, the one with the first node on the left.
    first = next((row for row in best if 0 in row), [])
    if len(first) > 1 and first.index(0) > (len(first) - 1) / 2:
        best = [row[::-1] for row in best]
    return best


def _cost(rows: list[list[int]], links: Sequence[tuple[int, int]]) -> tuple[float, float]:
    middle = {node: i - (len(row) - 1) / 2 for row in rows for i, node in enumerate(row)}
    return _crossings(rows, links), sum(abs(middle[a] - middle[b]) for a, b in links)


def _by_middle(rows: list[list[int]], k: int, other: int, links: Sequence[tuple[int, int]]) -> None:
    """Sort a row by the mean place of what each node is joined to in another row."""
    place = {node: i for i, node in enumerate(rows[other])}
    near = {node: [] for node in rows[k]}
    for a, b in links:
        for own, far in ((a, b), (b, a)):
            if own in near and far in place:
                near[own].append(place[far])
    stay = {node: i * len(rows[other]) / len(rows[k]) for i, node in enumerate(rows[k])}
    rows[k].sort(key=lambda node: float(np.mean(near[node])) if near[node] else stay[node])


def _exchanged(rows: list[list[int]], links: Sequence[tuple[int, int]]) -> None:
    """Exchange any two nodes of a row for as long as that helps."""
    least, again = _cost(rows, links), True
    while again:
        again = False
        for row in rows:
            for i in range(len(row) - 1):
                for j in range(i + 1, len(row)):
                    row[i], row[j] = row[j], row[i]
                    cost = _cost(rows, links)
                    if cost < least:
                        least, again = cost, True
                    else:
                        row[i], row[j] = row[j], row[i]


def _straightened(
    rows: list[list[int]], links: Sequence[tuple[int, int]], n: int, least: tuple[float, float], width: float
) -> np.ndarray:
    """Where all lies from left to right: each as near to the mean of its neighbours as the rest lets it."""
    count = max(max(row) for row in rows) + 1
    near: list[list[tuple[int, float]]] = [[] for _ in range(count)]
    for a, b in links:
        weight = _STRAIGHT[(a >= n) + (b >= n)]
        near[a].append((b, weight))
        near[b].append((a, weight))
    offsets = [np.cumsum([0.0, *(least[max(a, b) >= n] for a, b in pairwise(row))]) for row in rows]
    fullest = max(offset[-1] for offset in offsets)
    # With hardly any room to spare the columns keep in line.
    half = (width if width - fullest > least[0] / 2.0 else fullest) / 2.0
    x = np.zeros(count)
    for row, offset in zip(rows, offsets, strict=True):
        x[row] = offset - offset[-1] / 2.0
    for _ in range(60):
        for row, offset in zip(rows, offsets, strict=True):
            wanted = np.array(
                [
                    np.average([x[j] for j, _ in near[i]], weights=[w for _, w in near[i]])
                    if near[i]
                    else x[i]
                    for i in row
                ]
            )
            wanted *= 1.0 - _TOGETHER
            risen = rising(0.5 * (wanted + x[row]) - offset)
            x[row] = np.clip(risen, -half, half - offset[-1]) + offset
    return x - (x.max() + x.min()) / 2.0


def rising(values: np.ndarray) -> np.ndarray:
    """The nearest sequence that never falls, in the sum of squares."""
    blocks: list[list[float]] = []
    for value in values:
        blocks.append([float(value), 1.0])
        while len(blocks) > 1 and blocks[-2][0] >= blocks[-1][0]:
            (a, m), (b, k) = blocks[-2:]
            blocks[-2:] = [[(a * m + b * k) / (m + k), m + k]]
    return np.concatenate([np.full(int(m), a) for a, m in blocks])
