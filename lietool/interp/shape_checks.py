"""Whether two shapes fit together, and what else comes with them; and how their angles are read."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import angles, triangle
from lietool.interp.constraint import Rows
from lietool.lie import checks
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def pair(where: str, source: ArrayLike, target: ArrayLike, F: ArrayLike) -> tuple[Array, Array, Index, Array]:
    """Return two shapes, their triangles, and the linear parts of the maps from one to the other.

    Parameters
    ----------
    where : str
        Who asks, for the message.
    source, target : array_like, shape (n, 2)
    F : array_like of int, shape (m, 3)

    Returns
    -------
    P, Q : (n, 2)
    F : (m, 3), int
    A : (m, 2, 2)

    Raises
    ------
    ValueError
        If the shapes do not fit together, or a triangle of either has no area or is turned over in the other.
    """
    P = topology.vertices(where, "source", source)
    Q = topology.vertices(where, "target", target)
    if len(P) != len(Q):
        checks.fail(where, "target", f"as many vertices as the source, {len(P)}", f"{len(Q)}", None)
    F = topology.faces(where, F, len(P))
    E, D = (triangle.sides(V[F]) for V in (P, Q))
    triangle.checks_degenerate(where, "source", E)
    triangle.checks_degenerate(where, "target", D)
    A = D @ triangle.inverse(E)
    over = triangle.det(A) <= 0.0
    if over.any():
        k = int(np.argmax(over))
        mend = "Reverse the order of one shape's vertices." if over.all() else "Mend the triangulation there."
        got = f"{int(over.sum())} turned over, the first triangle {k}"
        checks.fail(where, "target", "oriented as the source in every triangle", got, None, mend)
    return P, Q, F, A


def weights(where: str, given: ArrayLike | None, P: Array, Q: Array, F: Index) -> tuple[Array, Array]:
    """Return the triangles' weights for the way there and the way back: their areas, unless given.

    Raises
    ------
    ValueError
        If there is not one for each triangle, or one is not positive.
    """
    if given is None:
        return np.abs(topology.areas(P, F)), np.abs(topology.areas(Q, F))
    w = checks.array(where, "weights", given, ())
    if w.shape != (len(F),):
        checks.fail(where, "weights", f"one number for each of {len(F)} triangles", f"shape {w.shape}", None)
    if not np.all(w > 0.0):
        index = checks.first(~(w > 0.0))
        checks.fail(where, "weights", "positive", f"{float(w[index]):g}", index)
    return w, w


def theta(
    where: str, given: ArrayLike | None, A: Array, F: Index, seed: int, turns: Mapping[int, int] | None
) -> Array:
    """Return the angles of the rotations: those given, or consistent ones.

    Raises
    ------
    ValueError
        If those given are not one for each triangle, or not the angles of its map; or if there are no
        consistent ones.
    """
    principal = triangle.principal_angle(A)
    if given is None:
        return angles.consistent(principal, F, seed, turns)
    angle = checks.array(where, "theta", given, ())
    if angle.shape != (len(F),):
        checks.fail(where, "theta", f"one angle for each of {len(F)} triangles", f"{angle.shape}", None)
    wrong = np.abs(np.exp(1j * (angle - principal)) - 1.0) > 1e-6
    if wrong.any():
        index = checks.first(wrong)
        must = f"{principal[index]:.6g} but for full turns"
        checks.fail(where, "theta", must, f"{angle[index]:.6g}", index)
    return angle


def held_once(where: str, rows: Rows) -> None:
    """Refuse two exact loci for one vertex."""
    vertices, counts = np.unique(rows.held, return_counts=True)
    if (counts > 1).any():
        vertex = int(vertices[np.argmax(counts > 1)])
        must = "at most one exact Locus for each vertex"
        checks.fail(where, "constraints", must, f"two for vertex {vertex}", None, "Give one a weight.")
