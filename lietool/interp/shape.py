"""From local maps to a moving shape: what is prepared once, and what is solved for each frame (chapter 6).

Two triangulations with the same faces give a map A_i for each triangle, a homotopy joins it to the identity,
and the vertices v(t) are those whose maps B_i(t) come nearest to the A_i(t), in the energy chosen and
under the constraints given.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import angles, constraint, energy, freedom, system, terms, triangle
from lietool.interp.constraint import Constraint
from lietool.interp.energy import Energy
from lietool.lie import checks
from lietool.mesh import topology

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Prepared:
    """All that does not depend on the frame.

    Parameters
    ----------
    source, target : ndarray, shape (n, 2)
    faces : ndarray of int, shape (m, 3)
    maps : ndarray, shape (m, 2, 2)
        The linear parts A_i of the local maps.
    theta : ndarray, shape (m,)
        Their angles of rotation, radians.
    homotopy : callable
        Of `triangle`.
    constraints : tuple of Constraint
    sums : tuple of Term
        The energy: one sum, or two where it is symmetrised.
    """

    source: Array
    target: Array
    faces: Index
    maps: Array
    theta: Array
    homotopy: triangle.Homotopy
    constraints: tuple[Constraint, ...]
    sums: tuple[terms.Term, ...]
    freedoms: freedom.Freedoms
    pattern: terms.Pattern
    layout: system.Layout
    anchors: Index

    @property
    def is_static(self) -> bool:
        """Whether one factorisation serves all frames."""
        moving = any(isinstance(c, constraint.Direction) and callable(c.normal) for c in self.constraints)
        return all(part.energy.is_rigid for part in self.sums) and not moving

    @cached_property
    def _first(self) -> system.Factor:
        rows = constraint.rows(self.constraints, len(self.source), np.zeros(1))
        return _factor(self, [part.form(0.0) for part in self.sums], rows, 0)


@dataclass(frozen=True, eq=False)
class Result:
    """The shape at some times.

    Parameters
    ----------
    prepared : Prepared
    t : ndarray, shape (T,)
    vertices : ndarray, shape (T, n, 2)
    residual : ndarray, shape (T,)
        The largest error in an equation of the linear system, relative to its terms.
    """

    prepared: Prepared
    t: Array
    vertices: Array
    residual: Array

    @cached_property
    def jacobians(self) -> Array:
        """The maps B_i(t) of the triangles; shape (T, m, 2, 2)."""
        corners = _complex(self.vertices)[:, self.prepared.faces.T]
        return np.stack([triangle.matrix(*self.prepared.sums[0].coordinates(c)) for c in corners])

    @cached_property
    def det(self) -> Array:
        """By which factor each triangle's area has changed; shape (T, m)."""
        areas = np.stack([topology.areas(V, self.prepared.faces) for V in self.vertices])
        return areas / topology.areas(self.prepared.source, self.prepared.faces)

    @property
    def flipped(self) -> NDArray[np.bool_]:
        """Which triangles are turned over or have collapsed; shape (T, m)."""
        return self.det <= 0.0

    @cached_property
    def energy(self) -> Array:
        """The weighted sum of the triangles' errors; shape (T,)."""
        corners = _complex(self.vertices)[:, self.prepared.faces.T]
        return np.array(
            [
                sum(float(part.form(t).at(part.coordinates(c)).sum()) for part in self.prepared.sums)
                for c, t in zip(corners, self.t.tolist(), strict=True)
            ]
        )


def local_maps(source: ArrayLike, target: ArrayLike, F: ArrayLike) -> Array:
    """Return the linear parts A_i of the maps that carry each triangle of a shape to its counterpart.

    Book: (5.2), 6.2

    Parameters
    ----------
    source, target : array_like, shape (n, 2)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    A : (m, 2, 2)

    Raises
    ------
    ValueError
        If the shapes do not fit together, or a triangle of either has no area or is turned over in the other.
    """
    return _read("shape.local_maps", source, target, F)[3]


def prepare(
    source: ArrayLike,
    target: ArrayLike,
    F: ArrayLike,
    *,
    error: Energy = energy.FROBENIUS,
    homotopy: triangle.Homotopy = triangle.logexp,
    constraints: Sequence[Constraint] | None = None,
    weights: ArrayLike | None = None,
    symmetric: bool = False,
    theta: ArrayLike | None = None,
    seed: int = 0,
    turns: Mapping[int, int] | None = None,
) -> Prepared:
    """Prepare the interpolation between two triangulated shapes.

    Book: 6.2, 6.3, 6.4

    Parameters
    ----------
    source, target : array_like, shape (n, 2)
        Corresponding vertices.
    F : array_like of int, shape (m, 3)
        The triangles of both.
    error : Energy
        One of `energy`.
    homotopy : callable
        One of `triangle`.
    constraints : sequence of Constraint, optional
        Without any: vertex 0 of each connected part on a straight line (Alexa 2000), and for energies
        that forgive rotations an edge of it along its triangle's own homotopy.
    weights : array_like, shape (m,), optional
        Of the triangles; their areas in the source (and in the target, for the way back) unless given.
    symmetric : bool
        Add the error of the way back, so that swapping the shapes reverses time.
    theta : array_like, shape (m,), optional
        Angles of the rotations, radians; consistent ones from `seed` with `turns` unless given, see `angles`.
    seed : int
        The triangle whose angle is in (-pi, pi].
    turns : mapping from int to int, optional
        Full turns to be added for a triangle.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If the shapes do not fit together, a triangle has no area or is turned over, angles do not close round
        a hole, or the constraints leave a freedom open.
    """
    where = "shape.prepare"
    P, Q, F, A = _read(where, source, target, F)
    if theta is None:
        angle = angles.consistent(np.angle(triangle.coordinates(A)[0]), F, seed, turns)
    else:
        angle = checks.array(where, "theta", theta, ())
        if angle.shape != (len(F),):
            checks.fail(where, "theta", f"one angle for each of {len(F)} triangles", f"{angle.shape}", None)
    sums = _sums(P, Q, F, A, angle, error, homotopy, _weights(where, weights, P, Q, F), symmetric)
    free = _freedoms(P, F, sums)
    chosen = tuple(_default(P, Q, F, A, angle, homotopy, free) if constraints is None else constraints)
    rows = constraint.rows(chosen, len(P), np.linspace(0.0, 1.0, 3))
    _once(where, rows)
    freedom.require(where, free, rows, len(P))
    fixed, soft, _ = _kinds(rows)
    extra = [np.array([(a, b) for a in rows.columns[k] for b in rows.columns[k]]) for k in soft]
    matrix = terms.pattern(F, len(P), np.concatenate([np.zeros((0, 2), np.intp), *extra]))
    held = np.array([rows.columns[k][0] for k in fixed], np.intp)
    at = system.layout(matrix, held, bool(rows.real.any()))
    anchors = _anchors(free, np.concatenate([held, [rows.columns[k][0] for k in soft]]).astype(np.intp))
    return Prepared(P, Q, F, A, angle, homotopy, chosen, sums, free, matrix, at, anchors)


def solve(prepared: Prepared, t: ArrayLike) -> Result:
    """Return the shape at given times.

    Book: (6.1), (6.2), (6.3), (6.4), 6.3

    Parameters
    ----------
    prepared : Prepared
    t : array_like, shape (T,) or ()
        Any real numbers; 0 is the source, 1 the target.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        If t is not finite, or a constraint leaves a freedom open at one of these times.
    """
    times = np.atleast_1d(checks.array("shape.solve", "t", t, ()))
    n = len(prepared.source)
    rows = constraint.rows(prepared.constraints, n, times)
    freedom.require("shape.solve", prepared.freedoms, rows, n)
    # As many frames at once as keep their right sides within some hundred megabytes.
    step = max(1, 4_000_000 // len(prepared.faces)) if prepared.is_static else 1
    found, residuals = [], []
    for first in range(0, len(times), step):
        frames = np.arange(first, min(first + step, len(times)))
        forms = [[part.form(float(times[frame])) for part in prepared.sums] for frame in frames]
        factor = prepared._first if prepared.is_static else _factor(prepared, forms[0], rows, first)
        v, residual = _frames(prepared, factor, rows, forms, frames)
        found.append(v)
        residuals.append(residual)
    v = np.concatenate(found, axis=1).T
    return Result(prepared, times, np.stack([v.real, v.imag], axis=-1), np.concatenate(residuals))


def _frames(
    prepared: Prepared,
    factor: system.Factor,
    rows: constraint.Rows,
    forms: list[list[energy.Form]],
    frames: Index,
) -> tuple[Complex, Array]:
    b = np.zeros((len(prepared.source), len(frames)), complex)
    flat = prepared.faces.T.ravel()
    for column, errors in enumerate(forms):
        for part, form in zip(prepared.sums, errors, strict=True):
            if part.energy.is_similarity:
                continue
            pull = part.pull(form).ravel()
            b[:, column] += np.bincount(flat, pull.real, len(b)) + 1j * np.bincount(flat, pull.imag, len(b))
    fixed, soft, beside = _kinds(rows)
    for k in soft:
        f = rows.factors[k][frames] if len(rows.factors[k]) > 1 else rows.factors[k]
        b[rows.columns[k]] += rows.weights[k] * np.conj(f.T) * rows.values[k][frames]
    anchored = 2 if prepared.layout.real else 1
    values = np.concatenate(
        [
            system.targets(rows, beside, prepared.layout.real)[:, frames],
            np.zeros((anchored * len(prepared.anchors), len(frames))),
        ]
    )
    return factor.solve(b, values, rows.values[fixed][:, frames])


def _factor(prepared: Prepared, forms: list[energy.Form], rows: constraint.Rows, frame: int) -> system.Factor:
    at, matrix = prepared.layout, prepared.pattern
    parts = zip(prepared.sums, forms, strict=True)
    entries: NDArray[Any] = np.sum([matrix.add(part.blocks(form)) for part, form in parts], axis=0)
    if all(part.energy.is_rigid for part in prepared.sums):
        # E^F and E^P treat x and y alike: what is left of the imaginary part is rounding.
        entries = entries.real
    _, soft, beside = _kinds(rows)
    for k in soft:
        f = rows.factors[k][frame if len(rows.factors[k]) > 1 else 0]
        c = rows.columns[k]
        block = rows.weights[k] * np.conj(f)[:, None] * f[None, :]
        where = matrix.locate(np.repeat(c, len(c)), np.tile(c, len(c)))
        np.add.at(entries, where, block.ravel().real)
    strength = float(np.abs(entries[matrix.diagonal]).mean())
    entries[matrix.diagonal[prepared.anchors]] += strength
    n = matrix.count
    anchor = np.zeros((len(prepared.anchors), n), complex)
    anchor[np.arange(len(anchor)), prepared.anchors] = 1.0
    back = np.full(len(anchor), -1.0 / strength)
    if at.real:
        anchor = np.concatenate(
            [np.hstack([anchor.real, 0 * anchor.real]), np.hstack([0 * anchor.real, anchor.real])]
        )
        back = np.tile(back, 2)
    conditions = np.concatenate([system.dense(rows, frame, beside, n, at.real), anchor])
    if not np.iscomplexobj(entries) and not np.any(conditions.imag):
        conditions = conditions.real
    return system.Factor(
        at, entries, conditions, np.concatenate([system.deltas(rows, beside, at.real), back])
    )


def _kinds(rows: constraint.Rows) -> tuple[Index, Index, Index]:
    """The conditions that take a vertex out, that go into the matrix, and that stand beside it."""
    one = np.array([len(c) == 1 for c in rows.columns], bool)
    exact = np.isinf(rows.weights)
    few = np.array([len(c) > 0 for c in rows.columns], bool)
    fixed, soft = one & exact, few & ~exact & ~rows.real
    every = np.arange(len(one))
    return every[fixed], every[soft], every[~(fixed | soft)]


def _once(where: str, rows: constraint.Rows) -> None:
    fixed, _, _ = _kinds(rows)
    held = [int(rows.columns[k][0]) for k in fixed]
    for place, vertex in enumerate(held):
        if vertex in held[:place]:
            must = "at most one exact Locus for each vertex"
            checks.fail(where, "constraints", must, f"two for vertex {vertex}", None, "Give one a weight.")


def _read(
    where: str, source: ArrayLike, target: ArrayLike, F: ArrayLike
) -> tuple[Array, Array, Index, Array]:
    P = topology.vertices(where, "source", source)
    Q = topology.vertices(where, "target", target)
    if len(P) != len(Q):
        checks.fail(where, "target", f"as many vertices as the source, {len(P)}", f"{len(Q)}", None)
    F = topology.faces(where, F, len(P))
    for name, V in (("source", P), ("target", Q)):
        sides = np.swapaxes(V[F[:, :2]] - V[F[:, 2:]], -1, -2)
        triangle.checks_degenerate(where, name, sides)
    E, D = (np.swapaxes(V[F[:, :2]] - V[F[:, 2:]], -1, -2) for V in (P, Q))
    A: Array = D @ np.linalg.inv(E)
    over = np.linalg.det(A) <= 0.0
    if over.any():
        k = int(np.argmax(over))
        remedy = (
            "Reverse the order of one shape's vertices." if over.all() else "Mend the triangulation there."
        )
        got = f"{int(over.sum())} turned over, the first triangle {k}"
        checks.fail(where, "target", "oriented as the source in every triangle", got, None, remedy)
    return P, Q, F, A


def _weights(where: str, weights: ArrayLike | None, P: Array, Q: Array, F: Index) -> tuple[Array, Array]:
    if weights is None:
        return np.abs(topology.areas(P, F)), np.abs(topology.areas(Q, F))
    w = checks.array(where, "weights", weights, ())
    if w.shape != (len(F),) or not np.all(w > 0.0):
        checks.fail(
            where, "weights", f"{len(F)} positive numbers", f"shape {w.shape}, least {np.min(w):g}", None
        )
    return w, w


def _sums(
    P: Array,
    Q: Array,
    F: Index,
    A: Array,
    theta: Array,
    error: Energy,
    homotopy: triangle.Homotopy,
    weights: tuple[Array, Array],
    symmetric: bool,
) -> tuple[terms.Term, ...]:
    forth = terms.homotopy_coordinates(A, theta, homotopy)
    there = terms.term(error, _complex(P)[F.T], weights[0], forth)
    if not symmetric:
        return (there,)
    back = terms.homotopy_coordinates(np.linalg.inv(A), -theta, homotopy)
    return there, terms.term(error, _complex(Q)[F.T], weights[1], lambda t: back(1.0 - t))


def _freedoms(P: Array, F: Index, sums: tuple[terms.Term, ...]) -> freedom.Freedoms:
    ends = np.concatenate([F[:, :2], F[:, 1:]])
    number, part = topology.components(len(P), ends)
    share = np.broadcast_to(np.asarray(sums[0].energy.rigid, float), len(F))
    stiff = np.zeros(number, bool)
    np.logical_or.at(stiff, part[F[:, 0]], share > 0.0)
    return freedom.Freedoms(part, ~stiff, _complex(P))


def _default(
    P: Array, Q: Array, F: Index, A: Array, theta: Array, homotopy: triangle.Homotopy, free: freedom.Freedoms
) -> list[Constraint]:
    found: list[Constraint] = []
    for k in range(free.parts):
        vertex = int(np.argmax(free.part == k))
        found.append(constraint.Locus(vertex, constraint.line(P[vertex], Q[vertex])))
        if not free.loose[k]:
            continue
        owner = int(np.argmax(np.any(F == vertex, axis=1)))
        other = int(next(v for v in F[owner] if v != vertex))
        found.append(
            constraint.Edge(other, vertex, _carried(A[owner], theta[owner], homotopy, P[other] - P[vertex]))
        )
    return found


def _carried(A: Array, theta: float, homotopy: triangle.Homotopy, e: Array) -> Callable[[Array], Array]:
    return lambda t: homotopy(A, t, theta) @ e


def _anchors(free: freedom.Freedoms, held: Index) -> Index:
    """Vertices to be held where the matrix alone would leave a part loose: none, one or two of each part."""
    found: list[int] = []
    for k in range(free.parts):
        inside = np.flatnonzero(free.part == k)
        have = np.unique(held[free.part[held] == k])
        need = (2 if free.loose[k] else 1) - len(have)
        if need <= 0:
            continue
        first = int(have[0]) if len(have) else int(inside[0])
        if not len(have):
            found.append(first)
            need -= 1
        if need > 0:
            found.append(int(inside[np.argmax(np.abs(free.shape[inside] - free.shape[first]))]))
    return np.array(found, np.intp)


def _complex(V: Array) -> Complex:
    return V[..., 0] + 1j * V[..., 1]
