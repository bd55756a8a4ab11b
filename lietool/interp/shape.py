"""From local maps to a moving shape: what is prepared once, and what is solved for each frame (chapter 6).

Two triangulations with the same faces give a map A_i for each triangle, a homotopy joins it to the identity,
and the vertices v(t) are those whose maps B_i(t) come nearest to the A_i(t), in the energy chosen and
under the constraints given.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import constraint, energy, freedom, shape_checks, system, terms, triangle
from lietool.interp.assembly import Assembly
from lietool.interp.constraint import Constraint, Rows
from lietool.interp.energy import Energy
from lietool.interp.freedom import Freedoms
from lietool.interp.shape_records import Prepared as Prepared
from lietool.interp.shape_records import Result as Result
from lietool.lie import checks

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]

BLOCK = 4_000_000
"""Frames times triangles that are solved at once: their right sides take some hundred megabytes."""

SHARED = 5_000
"""From so many triangles on, frames with a matrix of their own are solved by all processors."""


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
    return shape_checks.pair("shape.local_maps", source, target, F)[3]


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
    P, Q, F, A = shape_checks.pair(where, source, target, F)
    angle = shape_checks.theta(where, theta, A, F, seed, turns)
    shapes, areas = (_complex(P), _complex(Q)), shape_checks.weights(where, weights, P, Q, F)
    sums = _sums(shapes, F, A, angle, error, homotopy, areas, symmetric)
    free = freedom.of(shapes[0], F, error)
    if constraints is None:
        constraints = freedom.default(free, shapes[1], F, A, angle, homotopy)
    # Whether they hold the shape is asked again when the times are known; this finds what never would.
    rows = constraint.rows(constraints, len(P), np.linspace(0.0, 1.0, 3))
    shape_checks.held_once(where, rows)
    freedom.require(where, free, rows)
    moving = any(isinstance(c, constraint.Direction) and callable(c.normal) for c in constraints)
    static = error.is_rigid and not moving
    assembly = _assembly(sums, F, free, rows, not static)
    factor = assembly.factor([part.maps(0.0) for part in sums], rows, 0) if static else None
    return Prepared(P, Q, F, A, angle, homotopy, tuple(constraints), free, assembly, factor)


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
    freedom.require("shape.solve", prepared.freedoms, rows)
    v, residual = np.empty((len(times), n), complex), np.empty(len(times))
    step = max(1, BLOCK // len(prepared.faces)) if prepared.is_static else 1
    blocks = [np.arange(k, min(k + step, len(times))) for k in range(0, len(times), step)]
    solved = _each(lambda frames: _frames(prepared, rows, times, frames), blocks, _workers(prepared))
    for frames, found in zip(blocks, solved, strict=True):
        v[frames], residual[frames] = found
    return Result(prepared, times, v.view(float).reshape(len(times), n, 2), residual)


def _workers(prepared: Prepared) -> int:
    """How many frames to solve at the same time: factors of large matrices must fit into memory together."""
    size = len(prepared.faces)
    if prepared.is_static or size < SHARED:
        return 1
    return max(1, min(os.cpu_count() or 1, BLOCK // size))


def _each(
    f: Callable[[Index], tuple[Complex, Array]], blocks: Iterable[Index], workers: int
) -> Iterator[tuple[Complex, Array]]:
    """Call a function for every block, in their order; SuperLU lets other threads run."""
    if workers == 1:
        yield from map(f, blocks)
        return
    with ThreadPoolExecutor(workers) as pool:
        yield from pool.map(f, blocks)


def _frames(prepared: Prepared, rows: Rows, times: Array, frames: Index) -> tuple[Complex, Array]:
    """The vertices at some of the times, all with one factorisation, and the residuals."""
    assembly, factor = prepared.assembly, prepared.factor
    b = np.empty((len(frames), len(prepared.source)), complex)
    for place, frame in enumerate(frames.tolist()):
        maps = [part.maps(float(times[frame])) for part in assembly.sums]
        b[place] = assembly.right(maps, rows, frame)
        if factor is None:
            factor = assembly.factor(maps, rows, frame)
    assert factor is not None
    return factor.solve(b, *assembly.values(rows, frames))


def _sums(
    shapes: tuple[Complex, Complex],
    F: Index,
    A: Array,
    theta: Array,
    error: Energy,
    homotopy: triangle.Homotopy,
    weights: tuple[Array, Array],
    symmetric: bool,
) -> tuple[terms.Term, ...]:
    there = terms.term(error, shapes[0], F, weights[0], triangle.path(homotopy, A, theta))
    if not symmetric:
        return (there,)
    back = triangle.path(homotopy, triangle.inverse(A), -theta)
    return there, terms.term(error, shapes[1], F, weights[1], lambda t: back(1.0 - t))


def _assembly(sums: tuple[terms.Term, ...], F: Index, free: Freedoms, rows: Rows, ordered: bool) -> Assembly:
    n, soft = len(free.part), [rows.columns[k] for k in rows.kinds[1]]
    pairs = np.reshape([c for c in soft if len(c) == 2], (-1, 2)).astype(np.intp)
    matrix = terms.pattern(F, n, pairs)
    layout = system.layout(matrix, free.shape, rows.held, bool(rows.real.any()), ordered)
    holding = np.concatenate([rows.held, [int(c[0]) for c in soft]]).astype(np.intp)
    return Assembly(sums, matrix, layout, freedom.anchors(free, holding))


def _complex(V: Array) -> Complex:
    return V[:, 0] + 1j * V[:, 1]
