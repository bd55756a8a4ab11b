"""Moving shapes found with other forms than the library's: those that are passed to `global-interp`."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lietool.figure import Library
from lietool.interp import assembly, constraint, shape
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
            v = _minimum(np.asarray(G), np.asarray(u), rows, 0, slice(None))
        else:
            forms = weights[:, None, None] * np.asarray(self.similarity(P[F], maps))
            none = np.zeros((1, 2 * len(P)))
            each = [
                _minimum(_assembled(forms[k], F, len(P)), none, rows, k, slice(k, k + 1))
                for k in range(len(t))
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


def _assembled(forms: Array, F: Array, count: int) -> Any:
    """The sum of forms (m, 6, 6) of triangles, as a sparse matrix."""
    from scipy.sparse import coo_array

    at = (2 * F[..., None] + np.arange(2)).reshape(-1, 6)
    row, column = (np.broadcast_to(x, forms.shape).ravel() for x in (at[:, :, None], at[:, None, :]))
    return coo_array((forms.ravel(), (row, column)), (2 * count, 2 * count))


def _minimum(G: Any, u: Array, rows: constraint.Rows, frame: int, frames: slice) -> Array:
    """Where v^T G v + v^T u is least, or stationary, of the v under exact conditions; shape (T, 2 n)."""
    from scipy.sparse import block_array, csc_array
    from scipy.sparse.linalg import splu

    n, every = G.shape[0] // 2, np.arange(len(rows.columns))
    asked = assembly.targets(rows, every, True)[:, frames].T
    # From all x, then all y, to x and y of each vertex.
    U = assembly.dense(rows, frame, every, n, True).reshape(-1, 2, n).swapaxes(1, 2).reshape(-1, 2 * n)
    side = csc_array(U)
    # Only the symmetric part of G counts.
    system = csc_array(block_array([[csc_array(G + G.T), side.T], [side, None]]))
    try:
        found = splu(system).solve(np.concatenate([-u, asked], axis=1).T).T
    except RuntimeError:
        raise ValueError(
            "the form must hold the shape together; got one that leaves something loose. Correct the form"
        ) from None
    return found[:, : 2 * n]
