"""Whether constraints hold a shape: which freedoms an energy leaves open, and which of them nothing fixes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.interp import system
from lietool.interp.constraint import Rows
from lietool.lie import checks

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

    def moves(self) -> Complex:
        """Return the translation of each part as columns (n, parts)."""
        return (self.part[:, None] == np.arange(self.parts)).astype(complex)

    def turns(self) -> Complex:
        """Return each loose part's own shape about its mean, whose multiples turn and scale it."""
        moves = self.moves()
        middle = (moves.T @ self.shape) / moves.sum(axis=0).real
        return (moves * (self.shape - middle[self.part])[:, None])[:, self.loose]


def require(where: str, freedoms: Freedoms, rows: Rows, count: int) -> None:
    """Refuse constraints that leave a freedom open, or that a shape shrunk to a point satisfies.

    Raises
    ------
    ValueError
        Naming the freedom, the part, and what would fix it.
    """
    every = np.arange(len(rows.columns))
    _collapse(where, freedoms, rows, every, count)
    moves, turns = freedoms.moves(), freedoms.turns()
    names = [("translation", k, 1.0) for k in range(freedoms.parts)]
    names += [("translation", k, 1.0j) for k in range(freedoms.parts)]
    loose = np.flatnonzero(freedoms.loose)
    names += [("scale", int(k), 1.0) for k in loose] + [("rotation", int(k), 1.0j) for k in loose]
    basis = np.concatenate([moves, 1j * moves, turns, 1j * turns], axis=1)
    basis = basis / np.maximum(np.linalg.norm(basis, axis=0), 1e-300)
    for frame in range(rows.values.shape[1]):
        M = system.dense(rows, frame, every, count, real=True)
        M = M / np.maximum(np.linalg.norm(M, axis=1, keepdims=True), 1e-300)
        seen = M @ np.concatenate([basis.real, basis.imag])
        _, sizes, V = np.linalg.svd(seen, full_matrices=True)
        rank = int(np.sum(sizes > 1e-10))
        if rank < len(names):
            # The freedom that the first unseen movement consists of most.
            kind, part, _ = names[int(np.argmax(np.abs(V[rank])))]
            of = (
                ""
                if freedoms.parts == 1
                else f" of part {part} (vertex {int(np.argmax(freedoms.part == part))})"
            )
            checks.fail(
                where,
                "constraints",
                "enough to fix the shape",
                f"an unfixed {kind}{of}",
                None,
                _REMEDIES[kind],
            )


def _collapse(where: str, freedoms: Freedoms, rows: Rows, every: Index, count: int) -> None:
    if not freedoms.loose.any():
        return
    # Parts that cannot collapse stay as they are; the others become points.
    moves = freedoms.moves()
    basis = np.concatenate([moves, 1j * moves], axis=1)
    size = max(float(np.ptp(freedoms.shape.real)), float(np.ptp(freedoms.shape.imag)), 1e-300)
    touched = [bool(len(c) == 0 or freedoms.loose[freedoms.part[c]].any()) for c in rows.columns]
    chosen = every[np.array(touched, bool)] if touched else every
    for frame in range(rows.values.shape[1]):
        M = system.dense(rows, frame, chosen, count, real=True) @ np.concatenate([basis.real, basis.imag])
        d = system.targets(rows, chosen, True)[:, frame]
        best = np.linalg.lstsq(M, d, rcond=None)[0] if len(M) else np.zeros(0)
        if not len(M) or np.abs(M @ best - d).max() < 1e-9 * size:
            checks.fail(
                where,
                "constraints",
                "such that no shape shrunk to a point satisfies them, since this energy forgives it",
                f"{len(every)} of which a single point satisfies all",
                None,
                "Add an Edge, or a second Locus.",
            )
