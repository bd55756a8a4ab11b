"""What the user asks of an interpolation besides its maps: loci, edges, directions, the barycentre.

A constraint is exact where its weight is None; else its squared violation, times the weight, is added to the
energy.  Where something goes is a path: a function from times (k,) to points (k, 2); `line`, `polyline`,
`spline`, `bspline` and `arc` make some.

With v = x + i y every constraint but one says that a complex-linear form of the vertices has some value; that
an edge has only its direction given is a real condition.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]
Path = Callable[[Array], ArrayLike]


@dataclass(frozen=True, eq=False)
class Locus:
    """A vertex follows a path, v_k(t) = u(t).

    Book: 6.5
    """

    vertex: int
    path: Path
    weight: float | None = None


@dataclass(frozen=True, eq=False)
class Edge:
    """The vector between two vertices is given, v_k(t) - v_l(t) = e(t).

    Book: 6.5
    """

    start: int
    end: int
    path: Path
    weight: float | None = None


@dataclass(frozen=True, eq=False)
class Direction:
    """The line through two vertices keeps its direction, n(t) . (v_k - v_l) = 0; length and sense are free.

    `normal` is a vector (2,), or a path of vectors.
    """

    start: int
    end: int
    normal: ArrayLike | Path
    weight: float | None = None


@dataclass(frozen=True, eq=False)
class Barycentre:
    """The mean of all vertices follows a path.

    Book: 6.5
    """

    path: Path
    weight: float | None = None


Constraint = Locus | Edge | Direction | Barycentre


def pinned(vertex: int, position: ArrayLike, weight: float | None = None) -> Locus:
    """Return the constraint that a vertex stays at a point (2,)."""
    at = checks.array("constraint.pinned", "position", position, (2,))
    return Locus(vertex, lambda t: np.broadcast_to(at, (*t.shape, 2)), weight)


def line(start: ArrayLike, end: ArrayLike) -> Path:
    """Return the path from a point to another at constant speed; it goes on beyond both."""
    a = checks.array("constraint.line", "start", start, (2,))
    b = checks.array("constraint.line", "end", end, (2,))
    return lambda t: (1.0 - t[..., None]) * a + t[..., None] * b


def polyline(points: ArrayLike) -> Path:
    """Return the path along points (k, 2), at constant speed in the length of the polyline.

    Raises
    ------
    ValueError
        If there are fewer than two points, or all are the same.
    """
    p = _points("constraint.polyline", points, 2)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=-1))])
    if length[-1] == 0.0:
        checks.fail("constraint.polyline", "points", "a path with length", "one point many times", None)
    at = length / length[-1]
    return lambda t: np.stack([np.interp(t, at, column) for column in p.T], axis=-1)


def spline(points: ArrayLike) -> Path:
    """Return the cubic spline through points (k, 2) at equal times (of a lower degree where they are few)."""
    from scipy.interpolate import make_interp_spline

    p = _points("constraint.spline", points, 2)
    curve = make_interp_spline(np.linspace(0.0, 1.0, len(p)), p, k=min(3, len(p) - 1))
    return lambda t: curve(t)


def bspline(control: ArrayLike, degree: int = 3) -> Path:
    """Return the clamped B-spline with control points (k, 2): it begins at the first and ends at the last.

    Raises
    ------
    ValueError
        If there are not more control points than the degree.
    """
    from scipy.interpolate import BSpline

    p = _points("constraint.bspline", control, degree + 1)
    inner = np.linspace(0.0, 1.0, len(p) - degree + 1)
    knots = np.concatenate([np.zeros(degree), inner, np.ones(degree)])
    curve = BSpline(knots, p, degree)
    return lambda t: curve(t)


def arc(center: ArrayLike, start: ArrayLike, angle: float, growth: float = 1.0) -> Path:
    """Return the path that turns a point (2,) about a centre by an angle (rad), while `growth` scales it."""
    c = checks.array("constraint.arc", "center", center, (2,))
    z = checks.array("constraint.arc", "start", start, (2,)) - c
    first = complex(z[0], z[1])

    def path(t: Array) -> Array:
        w = first * growth**t * np.exp(1j * angle * t)
        return c + np.stack([w.real, w.imag], axis=-1)

    return path


@dataclass(frozen=True, eq=False)
class Rows:
    """Linear conditions on the vertices at some times.

    Parameters
    ----------
    columns : tuple of ndarray of int
        For each condition, the vertices that it speaks of; none at all means all of them.
    factors : tuple of ndarray of complex, shape (T, number of columns) or (T, 1)
        What they are multiplied with.
    values : ndarray of complex, shape (rows, T)
    weights : ndarray, shape (rows,)
        Infinity where a condition is exact.
    real : ndarray of bool, shape (rows,)
        Only the real part of the sum counts.
    """

    columns: tuple[NDArray[np.intp], ...]
    factors: tuple[NDArray[np.complex128], ...]
    values: NDArray[np.complex128]
    weights: Array
    real: NDArray[np.bool_]

    @cached_property
    def kinds(self) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
        """The conditions that take a vertex out, that go into the matrix, and that stand beside it."""
        count = np.array([len(c) for c in self.columns], int)
        exact = np.isinf(self.weights)
        fixed, soft = (count == 1) & exact, (count > 0) & ~exact & ~self.real
        every = np.arange(len(count))
        return every[fixed], every[soft], every[~(fixed | soft)]

    @property
    def held(self) -> NDArray[np.intp]:
        """The vertices that are taken out."""
        return np.array([self.columns[k][0] for k in self.kinds[0]], np.intp)

    def factor(self, condition: int, frame: int) -> NDArray[np.complex128]:
        """Return what the vertices of a condition are multiplied with at one of the times."""
        factor = self.factors[condition]
        return factor[frame if len(factor) > 1 else 0]


def rows(constraints: Sequence[Constraint], count: int, t: Array) -> Rows:
    """Return what constraints ask of `count` vertices at times (T,).

    Raises
    ------
    ValueError
        If there is no such vertex, a path gives no points, a weight is not positive, or a direction is no
        direction.
    """
    columns, factors, values, weights, real = [], [], [], [], []
    for place, constraint in enumerate(constraints):
        where = f"constraint {place} ({type(constraint).__name__})"
        weights.append(_weight(where, constraint.weight))
        real.append(isinstance(constraint, Direction))
        factor = np.ones((1, 1), complex)
        match constraint:
            case Locus(vertex=vertex, path=path):
                column, value = [_vertex(where, "vertex", vertex, count)], _path(where, path, t)
            case Barycentre(path=path):
                column, value = [], _path(where, path, t)
            case Edge(start=start, end=end, path=path):
                column, value = _ends(where, start, end, count), _path(where, path, t)
                factor = np.array([[1.0, -1.0]], complex)
            case Direction(start=start, end=end, normal=normal):
                column, value = _ends(where, start, end, count), np.zeros(len(t), complex)
                n = _normal(where, normal, t)
                # n . w is the real part of conj(n) w.
                factor = np.conj(n)[:, None] * np.array([1.0, -1.0])
        columns.append(np.array(column, np.intp))
        factors.append(factor)
        values.append(value)
    return Rows(
        tuple(columns),
        tuple(factors),
        np.reshape(np.array(values, complex), (len(values), len(t))),
        np.array(weights, float),
        np.array(real, bool),
    )


def _points(where: str, points: ArrayLike, least: int) -> Array:
    p = checks.array(where, "points", points, (2,))
    if p.ndim != 2 or len(p) < least:
        checks.fail(where, "points", f"an array (k, 2) with k >= {least}", f"shape {p.shape}", None)
    return p


def _weight(where: str, weight: float | None) -> float:
    if weight is None:
        return np.inf
    if not (weight > 0.0 and np.isfinite(weight)):
        checks.fail(where, "weight", "positive, or None for an exact constraint", f"{weight}", None)
    return float(weight)


def _vertex(where: str, name: str, vertex: int, count: int) -> int:
    if not 0 <= vertex < count:
        checks.fail(where, name, f"a vertex, 0 to {count - 1}", f"{vertex}", None)
    return int(vertex)


def _ends(where: str, start: int, end: int, count: int) -> list[int]:
    ends = [_vertex(where, "start", start, count), _vertex(where, "end", end, count)]
    if ends[0] == ends[1]:
        checks.fail(where, "end", "another vertex than start", f"{end}", None)
    return ends


def _path(where: str, path: Path, t: Array) -> NDArray[np.complex128]:
    points = checks.array(where, "path", path(t), ())
    if points.shape != (len(t), 2):
        must = f"a function from times ({len(t)},) to points ({len(t)}, 2)"
        checks.fail(where, "path", must, f"shape {points.shape}", None)
    return points[:, 0] + 1j * points[:, 1]


def _normal(where: str, normal: ArrayLike | Path, t: Array) -> NDArray[np.complex128]:
    if callable(normal):
        n = _path(where, normal, t)
    else:
        fixed = checks.array(where, "normal", normal, (2,))
        n = np.array([complex(fixed[0], fixed[1])])
    size = np.abs(n)
    if not np.all(size > 0.0):
        checks.fail(where, "normal", "a direction, not 0", "0", None)
    return (n / size).astype(complex)
