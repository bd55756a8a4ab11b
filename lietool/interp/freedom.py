"""Whether constraints hold a shape: which freedoms an energy leaves open, and what fixes them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.interp import assembly, constraint, triangle
from lietool.interp.constraint import Constraint, Rows
from lietool.interp.energy import Energy
from lietool.lie import checks
from lietool.mesh import topology

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]

_REMEDIES = {
    "translation": "Add a Locus (or pinned vertex) or a Barycentre.",
    "rotation": "Add an Edge, a Direction, or a second Locus.",
    "scale": "Add an Edge or a second Locus; a Direction does not fix it.",
}


@dataclass(frozen=True, eq=False)
class Freedoms:
    """What the energy does not see: moving each part, and, for similarities, turning and scaling it.

    Parameters
    ----------
    part : ndarray of int, shape (n,)
        The connected part of each vertex.
    loose : ndarray of bool, shape (parts,)
        Parts whose every triangle may turn and scale at no cost.
    shape : ndarray of complex, shape (n,)
        Where the vertices are at rest.
    """

    part: Index
    loose: NDArray[np.bool_]
    shape: Complex

    @property
    def parts(self) -> int:
        """How many connected parts there are."""
        return len(self.loose)

    def names(self) -> list[tuple[str, int]]:
        """Return what each real dimension of `basis` is called, and the part that it moves."""
        every, loose = range(self.parts), np.flatnonzero(self.loose).tolist()
        translations = [("translation", k) for k in every]
        return 2 * translations + [("scale", k) for k in loose] + [("rotation", k) for k in loose]

    def moves(self) -> Complex:
        """Return the translation of each part as columns (n, parts)."""
        return (self.part[:, None] == np.arange(self.parts)).astype(complex)

    def turns(self) -> Complex:
        """Return each loose part's own shape about its mean, whose multiples turn and scale it."""
        moves = self.moves()
        middle = (moves.T @ self.shape) / moves.sum(axis=0).real
        return (moves * (self.shape - middle[self.part])[:, None])[:, self.loose]


def of(v: Complex, F: Index, error: Energy) -> Freedoms:
    """Return the freedoms that an energy leaves a shape.

    Parameters
    ----------
    v : ndarray of complex, shape (n,)
        Its vertices.
    F : ndarray of int, shape (m, 3)
    error : Energy

    Returns
    -------
    Freedoms
    """
    number, part = topology.components(len(v), np.concatenate([F[:, :2], F[:, 1:]]))
    share = np.broadcast_to(np.asarray(error.rigid, float), len(F))
    stiff = np.zeros(number, bool)
    np.logical_or.at(stiff, part[F[:, 0]], share > 0.0)
    return Freedoms(part, ~stiff, v)


def default(
    freedoms: Freedoms, target: Complex, F: Index, maps: Array, theta: Array, homotopy: triangle.Homotopy
) -> list[Constraint]:
    """Return constraints that fix every freedom, when the user has none.

    Of each part the first vertex goes on a straight line (Alexa 2000); if the part is loose an edge there
    goes the way of the first triangle at it.

    Parameters
    ----------
    freedoms : Freedoms
    target : ndarray of complex, shape (n,)
    F : ndarray of int, shape (m, 3)
    maps : ndarray, shape (m, 2, 2)
    theta : ndarray, shape (m,)
    homotopy : callable

    Returns
    -------
    list of Constraint
    """
    found: list[Constraint] = []
    for k in range(freedoms.parts):
        vertex = int(np.argmax(freedoms.part == k))
        z, w = freedoms.shape[vertex], target[vertex]
        found.append(constraint.Locus(vertex, constraint.line((z.real, z.imag), (w.real, w.imag))))
        if freedoms.loose[k]:
            owner = int(np.flatnonzero(F.ravel() == vertex)[0] // 3)
            other = int(next(v for v in F[owner] if v != vertex))
            e = freedoms.shape[other] - z
            way = _carried(maps[owner], float(theta[owner]), homotopy, np.array([e.real, e.imag]))
            found.append(constraint.Edge(other, vertex, way))
    return found


def _carried(A: Array, theta: float, homotopy: triangle.Homotopy, e: Array) -> Callable[[Array], Array]:
    return lambda t: homotopy(A, t, theta) @ e


def anchors(freedoms: Freedoms, held: Index) -> Index:
    """Return vertices to be held where the matrix alone would leave a part loose.

    Parameters
    ----------
    freedoms : Freedoms
    held : ndarray of int
        Vertices that constraints in the matrix hold.

    Returns
    -------
    vertices : ndarray of int
        None, one or two of each part.
    """
    found: list[int] = []
    for k in range(freedoms.parts):
        inside = np.flatnonzero(freedoms.part == k)
        have = np.unique(held[freedoms.part[held] == k])
        need = (2 if freedoms.loose[k] else 1) - len(have)
        if need <= 0:
            continue
        first = int(have[0]) if len(have) else int(inside[0])
        if not len(have):
            found.append(first)
            need -= 1
        if need > 0:
            found.append(int(inside[np.argmax(np.abs(freedoms.shape[inside] - freedoms.shape[first]))]))
    return np.array(found, np.intp)


def require(where: str, freedoms: Freedoms, rows: Rows) -> None:
    """Refuse constraints that leave a freedom open, or that a shape shrunk to a point satisfies.

    Raises
    ------
    ValueError
        Naming the freedom, the part, and what would fix it.
    """
    moves, turns = freedoms.moves(), freedoms.turns()
    _collapse(where, freedoms, rows, moves)
    basis = np.concatenate([moves, 1j * moves, turns, 1j * turns], axis=1)
    basis = basis / np.maximum(np.linalg.norm(basis, axis=0), 1e-300)
    names = freedoms.names()
    every = np.arange(len(rows.columns))
    for frame in _different(rows):
        _, sizes, V = np.linalg.svd(_seen(rows, frame, every, basis), full_matrices=True)
        rank = int(np.sum(sizes > 1e-10))
        if rank < len(names):
            # The freedom that the first unseen movement consists of most.
            _refuse(where, freedoms, *names[int(np.argmax(np.abs(V[rank])))])


def _refuse(where: str, freedoms: Freedoms, kind: str, part: int) -> None:
    first = int(np.argmax(freedoms.part == part))
    whose = "" if freedoms.parts == 1 else f" of part {part} (vertex {first})"
    checks.fail(
        where, "constraints", "enough to fix the shape", f"an unfixed {kind}{whose}", None, _REMEDIES[kind]
    )


def _different(rows: Rows) -> range:
    """The frames whose conditions have other factors: only a direction that turns has any."""
    turning = any(len(f) > 1 for f in rows.factors)
    return range(rows.values.shape[1] if turning else 1)


def _seen(rows: Rows, frame: int, chosen: Index, basis: Complex) -> Array:
    """What conditions see of movements (n, k), two rows for each or one where its real part alone counts."""
    out: list[Array] = []
    for condition in chosen:
        f, columns = rows.factor(condition, frame), rows.columns[condition]
        value = f @ basis[columns] if len(columns) else f[0] * basis.mean(axis=0)
        out += [value.real] if rows.real[condition] else [value.real, value.imag]
    return np.reshape(out, (-1, basis.shape[1]))


def _collapse(where: str, freedoms: Freedoms, rows: Rows, moves: Complex) -> None:
    if not freedoms.loose.any():
        return
    # Parts that cannot collapse stay as they are; the others become points.
    size = max(float(np.ptp(freedoms.shape.real)), float(np.ptp(freedoms.shape.imag)), 1e-300)
    touched = [bool(len(c) == 0 or freedoms.loose[freedoms.part[c]].any()) for c in rows.columns]
    chosen = np.flatnonzero(touched) if any(touched) else np.arange(len(touched))
    basis = np.concatenate([moves, 1j * moves], axis=1)
    asked = assembly.targets(rows, chosen, True)
    different = _different(rows)
    for frame in different:
        M = _seen(rows, frame, chosen, basis)
        d = asked[:, [frame]] if len(different) > 1 else asked
        best = np.linalg.lstsq(M, d, rcond=None)[0]
        if np.any(np.max(np.abs(M @ best - d), axis=0, initial=0.0) < 1e-9 * size):
            must = "such that no shape shrunk to a point satisfies them, since this energy forgives it"
            got = f"{len(rows.columns)} of which a single point satisfies all"
            checks.fail(where, "constraints", must, got, None, "Add an Edge, or a second Locus.")
