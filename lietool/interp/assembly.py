"""From triangles and constraints to the linear system of a frame: its matrix, and its right sides."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.interp import system, terms
from lietool.interp.constraint import Rows

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Assembly:
    """What is put together for every frame, and where it goes.

    Parameters
    ----------
    sums : tuple of Term
        The energy: one sum, or two where it is symmetrised.
    pattern : Pattern
        Where the entries of triangles and of constraints with a weight go.
    layout : Layout
        What is left of the matrix when the given vertices are taken out.
    anchors : ndarray of int
        Vertices that hold what the energy leaves loose; a condition takes back what they do.
    """

    sums: tuple[terms.Term, ...]
    pattern: terms.Pattern
    layout: system.Layout
    anchors: Index

    def factor(self, maps: Sequence[Complex], rows: Rows, frame: int) -> system.Factor:
        """Return the factored system of a frame.

        Parameters
        ----------
        maps : sequence of ndarray of complex, shape (2, m)
            The maps to be reached, for each of the sums.
        rows : Rows
        frame : int
            Which of the times of `rows`.
        """
        entries = self._entries(maps)
        for k in rows.kinds[1]:
            f, c = rows.factor(k, frame), rows.columns[k]
            block = rows.weights[k] * np.conj(f)[:, None] * f
            where = self.pattern.locate(np.repeat(c, len(c)), np.tile(c, len(c)))
            np.add.at(entries, where, block.ravel().real)
        strength = float(np.abs(entries[: self.pattern.count]).mean())
        entries[self.anchors] += strength
        held, back = self._anchored(strength)
        conditions = [dense(rows, frame, rows.kinds[2], self.pattern.count, self.layout.real), held]
        delta = [_deltas(rows, rows.kinds[2], self.layout.real), back]
        return system.Factor(self.layout, entries, np.concatenate(conditions), np.concatenate(delta))

    def right(self, maps: Sequence[Complex], rows: Rows, frame: int) -> Complex:
        """Return the right side of a frame; shape (n,)."""
        b = np.zeros(self.pattern.count, complex)
        for part, a in zip(self.sums, maps, strict=True):
            if part.pull is not None:
                b += part.pull @ a.ravel()
        for k in rows.kinds[1]:
            b[rows.columns[k]] += rows.weights[k] * np.conj(rows.factor(k, frame)) * rows.values[k, frame]
        return b

    def values(self, rows: Rows, frames: Index) -> tuple[NDArray[Any], Complex]:
        """Return what the conditions beside the matrix ask for, and where the given vertices are."""
        fixed, _, beside = rows.kinds
        asked = targets(rows, beside, self.layout.real)[:, frames].T
        anchors = len(self.anchors) * (2 if self.layout.real else 1)
        return np.concatenate([asked, np.zeros((len(frames), anchors))], axis=1), rows.values[fixed][
            :, frames
        ].T

    def _entries(self, maps: Sequence[Complex]) -> NDArray[Any]:
        forms = [part.form(a) for part, a in zip(self.sums, maps, strict=True)]
        entries = self.pattern.add(self.sums[0].blocks(forms[0]))
        for part, form in zip(self.sums[1:], forms[1:], strict=True):
            entries += self.pattern.add(part.blocks(form))
        if all(part.energy.is_rigid for part in self.sums):
            # E^F and E^P treat x and y alike: what is left of the imaginary part is rounding.
            return np.real(entries).copy()
        return entries

    def _anchored(self, strength: float) -> tuple[Array, Array]:
        count, n = len(self.anchors), self.pattern.count
        rows = np.zeros((count, n))
        rows[np.arange(count), self.anchors] = 1.0
        if self.layout.real:
            none = np.zeros_like(rows)
            rows = np.concatenate([np.hstack([rows, none]), np.hstack([none, rows])])
        return rows, np.full(len(rows), -1.0 / strength)


def dense(rows: Rows, frame: int, chosen: Index, count: int, real: bool) -> Array:
    """Return chosen conditions of one frame as the rows of a matrix on the unknowns.

    Parameters
    ----------
    rows : Rows
    frame : int
        Which of the times of `rows`.
    chosen : ndarray of int
        Which of the conditions.
    count : int
        Vertices.
    real : bool
        Whether the unknowns are x and y; a condition is then two rows, or one if only its real part counts.

    Returns
    -------
    U : ndarray, shape (k, count) or (k, 2 count)
    """
    out: list[Array] = []
    for k in chosen:
        f = np.zeros(count, complex)
        if len(rows.columns[k]):
            f[rows.columns[k]] = rows.factor(k, frame)
        else:
            f[:] = rows.factor(k, frame) / count
        if not real:
            # Of all conditions only that on a direction has factors that are not real.
            out.append(np.real(f))
            continue
        out.append(np.concatenate([np.real(f), -np.imag(f)]))
        if not rows.real[k]:
            out.append(np.concatenate([np.imag(f), np.real(f)]))
    return np.reshape(out, (-1, 2 * count if real else count))


def targets(rows: Rows, chosen: Index, real: bool) -> NDArray[Any]:
    """Return what chosen conditions ask for, in the order of `dense`; shape (k, T)."""
    out: list[NDArray[Any]] = []
    for k in chosen:
        value = rows.values[k]
        out += [value] if not real else [value.real] if rows.real[k] else [value.real, value.imag]
    return np.reshape(out, (-1, rows.values.shape[1]))


def _deltas(rows: Rows, chosen: Index, real: bool) -> Array:
    """Return 1 / weight of chosen conditions, in the order of `dense`."""
    out: list[float] = []
    for k in chosen:
        out += [1.0 / float(rows.weights[k])] * (1 if not real or rows.real[k] else 2)
    return np.array(out, float)
