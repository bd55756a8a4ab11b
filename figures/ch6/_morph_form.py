"""Moving shapes found with other forms than the library's: those that are passed to `global-interp`."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lietool.figure import Library
from lietool.interp import constraint, forms, shape
from lietool.mesh import topology

Array = np.ndarray

MATRIX = Library("lietool.interp.forms.matrix")
PULL = Library("lietool.interp.forms.pull")
SIMILARITY = Library("lietool.interp.forms.similarity")
# Shapes that reach farther than this, in sizes of the source, cannot be shown.
_FAR = 100.0


@dataclass(frozen=True)
class Forms:
    """The forms of E^F and of E^R that shapes are found with; by default those of the library.

    Parameters
    ----------
    matrix, pull : callable
        G and u of E^F, as of `lietool.interp.forms`.
    similarity : callable
        The matrix of E^R of triangles, as there.
    """

    matrix: Callable[..., Array] = MATRIX
    pull: Callable[..., Array] = PULL
    similarity: Callable[..., Array] = SIMILARITY

    def others(self, energy: str) -> bool:
        """Return whether an energy has another form here than in the library, which solves its own faster."""
        given = {"frobenius": (self.matrix, self.pull), "similarity": (self.similarity,)}.get(energy, ())
        return not all(isinstance(form, Library) for form in given)

    def solve(self, energy: str, prepared: shape.Prepared, weights: Array, t: Array) -> shape.Result:
        """Return the shape at times (T,), by these forms and the constraints of what is prepared.

        Parameters
        ----------
        energy : str
            "frobenius" or "similarity".
        prepared : Prepared
        weights : ndarray, shape (m,)
            Of the triangles.
        t : ndarray, shape (T,)

        Raises
        ------
        ValueError
            If the form leaves the shape loose, or puts it far away.
        """
        P, F = prepared.source, prepared.faces
        maps = prepared.homotopy(prepared.maps, t, prepared.theta)
        rows = constraint.rows(prepared.constraints, len(P), t)
        if energy == "frobenius":
            G, u = self.matrix(P, F, weights), self.pull(P, F, weights, maps)
            v = forms.least(np.asarray(G), np.asarray(u), rows, np.arange(len(t)))
        else:
            blocks = weights[:, None, None] * np.asarray(self.similarity(P[F], maps))
            none = np.zeros((1, 2 * len(P)))
            each = [
                forms.least(forms.assembled(block, F, len(P)), none, rows, np.array([k]))
                for k, block in enumerate(blocks)
            ]
            v = np.concatenate(each)
        size = float(np.ptp(P, axis=0).max())
        if not np.abs(v).max() <= _FAR * size:
            raise ValueError(
                f"the form of {energy} must hold the shape together; got one whose least value is at a shape "
                f"over {_FAR:g} times as large. Correct the form"
            )
        return shape.Result(prepared, t, v.reshape(len(t), len(P), 2), np.zeros(len(t)))


LIBRARY = Forms()


def weights(prepared: shape.Prepared, equal: bool) -> Array:
    """Return those of the triangles: their areas, or all the same."""
    areas = topology.areas(prepared.source, prepared.faces)
    return np.ones(len(areas)) if equal else areas
