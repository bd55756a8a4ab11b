"""Sample two outlines so that their points correspond: evenly by arc length, corners kept."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.lie import checks
from lietool.mesh import outline

Array = NDArray[np.float64]

# A turn of the outline by more than this is a corner; those of flattened curves are smaller.
_SHARP = np.deg2rad(25.0)
_ALIGNED = 256
_NEAR = 0.04
# Of ways to lay outlines on each other that fit almost equally well, that which turns them least.
_UNTURNED = 0.1


def sample(
    where: str, P: Array, Q: Array, marks: Sequence[tuple[int, int]] | None, samples: int
) -> tuple[Array, Array]:
    """Return as many points on either outline, both counter-clockwise.

    Parameters
    ----------
    where : str
        The function that asks, for messages.
    P, Q : (n, 2), (k, 2)
        Simple polygons.
    marks : sequence of (int, int) or None
    samples : int

    Returns
    -------
    first, second : (m, 2)
        The first mark comes first.
    """
    if isinstance(samples, bool) or not isinstance(samples, int | np.integer) or not 3 <= samples <= 5000:
        checks.fail(where, "samples", "a whole number from 3 to 5000", repr(samples), None)
    given = None if marks is None or not len(marks) else _pairs(where, marks, len(P), len(Q))
    turned = [outline.area(X) < 0.0 for X in (P, Q)]
    P, Q = (X[::-1] if t else X for X, t in zip((P, Q), turned, strict=True))
    if given is None:
        pairs = np.array([_nearest_start(P, Q)])
    else:
        last = np.array([len(P), len(Q)]) - 1
        pairs = np.where(turned, last - given, given)
        _check_order(where, given, pairs, len(Q))
    pairs = pairs[np.argsort(pairs[:, 0])]
    whole = [outline.lengths(X).sum() for X in (P, Q)]
    pieces: list[tuple[Array, Array]] = []
    for (i, j), (k, m) in zip(pairs, np.roll(pairs, -1, axis=0), strict=True):
        pieces.append(_between(_Piece(P, i, k, whole[0]), _Piece(Q, j, m, whole[1]), samples))
    first, second = (np.concatenate(points) for points in zip(*pieces, strict=True))
    return first, second


def _pairs(where: str, marks: Sequence[tuple[int, int]], n: int, k: int) -> NDArray[np.intp]:
    remedy = "Give pairs (point of P, point of Q), counted from 0."
    try:
        pairs = np.array(marks)
    except ValueError:
        checks.fail(where, "marks", "pairs of whole numbers", "a ragged list", None, remedy)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu":
        got = f"shape {pairs.shape} of {pairs.dtype}"
        checks.fail(where, "marks", "pairs of whole numbers", got, None, remedy)
    for side, (name, count) in enumerate((("P", n), ("Q", k))):
        column = pairs[:, side]
        bad = (column < 0) | (column >= count)
        if bad.any():
            (i,) = checks.first(bad)
            must = f"points of {name}, 0 to {count - 1}"
            checks.fail(where, "marks", must, str(column[i]), (i, side))
        again = np.array([c in column[:i] for i, c in enumerate(column.tolist())])
        if again.any():
            (i,) = checks.first(again)
            must = f"of different points of {name}"
            checks.fail(where, "marks", must, f"{column[i]} again", (i, side), "Mark each point once.")
    return pairs.astype(np.intp)


def _check_order(where: str, given: NDArray[np.intp], pairs: NDArray[np.intp], k: int) -> None:
    """Refuse marks that do not follow each other in the same order counter-clockwise on both outlines."""
    order = np.argsort(pairs[:, 0])
    steps = np.diff(pairs[order, 1], append=pairs[order[0], 1]) % k
    if steps.sum() == k or len(pairs) < 3:
        return
    must = "in the same order around P and Q"
    if (k - steps).sum() == k:
        remedy = "The map would be a reflection: mirror Q, or mark other points."
        checks.fail(where, "marks", must, "the reverse order on Q", None, remedy)
    # The first mark that lies behind one before it.
    (i,) = checks.first(np.cumsum(steps) >= k)
    bad = int(order[min(i + 1, len(order) - 1)])
    got = f"({given[bad, 0]}, {given[bad, 1]})"
    checks.fail(where, "marks", must, got, (bad,), "Leave it out or correct it.")


def _nearest_start(P: Array, Q: Array) -> tuple[int, int]:
    """Return a point of P and one of Q that correspond when the outlines are laid on each other."""
    start = int(np.argmax(_turns(P)))
    even = []
    for X in (np.roll(P, -start, axis=0), Q):
        points = _Piece(X, 0, 0, 1.0).at(np.arange(_ALIGNED) / _ALIGNED)
        z = points[:, 0] + 1j * points[:, 1]
        even.append((z - z.mean()) / np.sqrt(abs(outline.area(X))))
    # By the convolution theorem, for each shift: the angle by which Q is turned against P where they are
    # closest, and the sum of squared distances then, but for constants.
    product = np.fft.ifft(np.fft.fft(even[0]).conj() * np.fft.fft(even[1]))
    match = np.abs(product) * (1.0 - _UNTURNED * (np.angle(product) / np.pi) ** 2)
    s = np.concatenate([[0.0], np.cumsum(outline.lengths(Q))])
    apart = np.abs(s[:-1] / s[-1] - np.argmax(match) / _ALIGNED)
    apart = np.minimum(apart, 1.0 - apart)
    # A corner belongs to a corner, if there is one near by.
    corner = (_turns(Q) > _SHARP) & (apart < _NEAR)
    return start, int(np.argmin(np.where(corner, apart - 1.0, apart)))


def _turns(points: Array) -> Array:
    """Return by how much an outline turns at each of its points, in radians."""
    z = points[:, 0] + 1j * points[:, 1]
    return np.abs(np.angle((np.roll(z, -1) - z) * (z - np.roll(z, 1)).conj()))


class _Piece:
    """Part of an outline from one of its points to another, by its arc length from 0 to 1."""

    def __init__(self, points: Array, start: int, stop: int, whole: float) -> None:
        n = len(points)
        count = (stop - start - 1) % n + 1
        self.points = points[(start + np.arange(count + 1)) % n]
        s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))])
        self.share = float(s[-1] / whole)
        self.s = s / s[-1]
        side = np.diff(self.points[:, 0] + 1j * self.points[:, 1])
        turn = np.abs(np.angle(side[1:] * side[:-1].conj()))
        self.sharp = self.s[1:-1][turn > _SHARP]

    def at(self, s: Array) -> Array:
        return np.stack([np.interp(s, self.s, x) for x in self.points.T], axis=1)


def _between(a: _Piece, b: _Piece, samples: int) -> tuple[Array, Array]:
    """Return the points of one piece of either outline, without the last ones."""
    share = 0.5 * (a.share + b.share)
    s, t = _breaks(a.sharp, b.sharp, 1.0 / max(1.0, samples * share))
    first, second = [], []
    for k in range(len(s) - 1):
        part = 0.5 * ((s[k + 1] - s[k]) * a.share + (t[k + 1] - t[k]) * b.share)
        f = np.arange(max(1, round(samples * part))) / max(1, round(samples * part))
        first.append(a.at(s[k] + f * (s[k + 1] - s[k])))
        second.append(b.at(t[k] + f * (t[k + 1] - t[k])))
    return np.concatenate(first), np.concatenate(second)


def _breaks(s: Array, t: Array, close: float) -> tuple[Array, Array]:
    """Return where corners lie on both pieces: each of either, close ones of both as one, and the ends."""
    both: list[tuple[float, float]] = [(0.0, 0.0)]
    if len(s) and len(t):
        apart = np.abs(s[:, None] - t)
        partner, back = np.argmin(apart, axis=1), np.argmin(apart, axis=0)
        for i in range(len(s)):
            j = int(partner[i])
            if back[j] == i and apart[i, j] <= close and s[i] > both[-1][0] and t[j] > both[-1][1]:
                both.append((float(s[i]), float(t[j])))
    both.append((1.0, 1.0))
    x, y = np.array(both).T
    only_s, only_t = s[~np.isin(s, x)], t[~np.isin(t, y)]
    # Corners of one piece go where the common corners beside them put them on the other.
    xs = np.concatenate([x, only_s, np.interp(only_t, y, x)])
    ys = np.concatenate([y, np.interp(only_s, x, y), only_t])
    order = np.argsort(xs, kind="stable")
    return xs[order], ys[order]
