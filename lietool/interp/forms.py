"""The energies of whole shapes written out in x and y, as one writes them first: v^T G v + v^T u + c.

The vertices are v = (x_1, y_1, ..., x_n, y_n), as in section 6.3.  `terms` has the same forms in complex
numbers, half as large and sparse, and that is what `shape` solves; these are for looking at, for checking
one's own, and for shapes that are small.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import assembly, energy, terms, triangle
from lietool.interp.constraint import Rows
from lietool.lie import checks
from lietool.mesh import topology

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


def matrix(P: ArrayLike, F: ArrayLike, weights: ArrayLike) -> Array:
    """Return the matrix G of E^F, the sum of weights times |B_i - A_i|^2; it does not depend on the A_i.

    Book: (6.2), 6.3

    Parameters
    ----------
    P : array_like, shape (n, 2)
        The vertices at rest.
    F : array_like of int, shape (m, 3)
    weights : array_like, shape (m,)
        Of the triangles.

    Returns
    -------
    G : (2 n, 2 n)
        Symmetric; its kernel are the translations of each connected part.

    Raises
    ------
    ValueError
        If a shape is wrong, or a triangle has no area.
    """
    part, F = _sum("forms.matrix", P, F, weights)
    # Which maps is of no account: E^F forgives nothing.
    blocks = _blocks(part, part.form(np.zeros((2, len(F)), complex)))
    at = (2 * F[..., None] + np.arange(2)).reshape(-1, 6)
    G = np.zeros((2 * len(np.asarray(P)), 2 * len(np.asarray(P))))
    np.add.at(G, (at[:, :, None], at[:, None, :]), blocks)
    return G


def pull(P: ArrayLike, F: ArrayLike, weights: ArrayLike, A: ArrayLike) -> Array:
    """Return the u of E^F = v^T G v + v^T u + c for maps A_i that are to be reached.

    Book: (6.2), 6.3

    Parameters
    ----------
    P : array_like, shape (n, 2)
        The vertices at rest.
    F : array_like of int, shape (m, 3)
    weights : array_like, shape (m,)
        Of the triangles.
    A : array_like, shape (..., m, 2, 2)

    Returns
    -------
    u : (..., 2 n)

    Raises
    ------
    ValueError
        If a shape is wrong, or a triangle has no area.
    """
    A = checks.array("forms.pull", "A", A, (2, 2))
    part, F = _sum("forms.pull", P, F, weights)
    if A.ndim < 3 or A.shape[-3] != len(F):
        checks.fail("forms.pull", "A", f"one map for each of {len(F)} triangles", f"shape {A.shape}", None)
    a = np.stack(triangle.coordinates(A), axis=-2)
    b = part.pull @ np.moveaxis(a.reshape(-1, 2 * len(F)), -1, 0)
    return np.ascontiguousarray(-2.0 * b.T).view(float).reshape(*A.shape[:-3], -1)


def similarity(corners: ArrayLike, A: ArrayLike) -> Array:
    """Return the matrix of E^R of a triangle, the least |B - s R A|^2 over all similarities s R.

    Book: (6.4), (6.5)

    Parameters
    ----------
    corners : array_like, shape (..., 3, 2)
        Of the triangle at rest.
    A : array_like, shape (..., 2, 2)
        The map that is to be reached.

    Returns
    -------
    Q : (..., 6, 6)
        Of the form in (x_1, y_1, x_2, y_2, x_3, y_3), where the corners go.  Its kernel has dimension 4: the
        translations, and the shapes s R A p.

    Raises
    ------
    ValueError
        If a shape is wrong, a triangle has no area, or A is 0.
    """
    where = "forms.similarity"
    p, A = checks.array(where, "corners", corners, (3, 2)), checks.array(where, "A", A, (2, 2))
    triangle.checks_degenerate(where, "corners", triangle.sides(p))
    if np.any(nothing := ~np.any(A, axis=(-2, -1))):
        checks.fail(where, "A", "a map that is not 0", "0", checks.first(nothing))
    many = np.broadcast_shapes(p.shape[:-2], A.shape[:-2])
    p, A = (np.broadcast_to(x, (*many, *x.shape[-2:])).reshape(-1, *x.shape[-2:]) for x in (p, A))
    faces = np.arange(3 * len(p)).reshape(-1, 3)
    part = terms.term(energy.SIMILARITY, _complex(p.reshape(-1, 2)), faces, np.ones(len(p)), _no_maps)
    return _blocks(part, part.form(np.stack(triangle.coordinates(A)))).reshape(*many, 6, 6)


def assembled(blocks: Array, F: Index, count: int) -> Any:
    """Return the matrix of a whole shape from those of its triangles.

    Parameters
    ----------
    blocks : ndarray, shape (m, 6, 6)
        As of `similarity`, times the triangles' weights.
    F : ndarray of int, shape (m, 3)
    count : int
        The number of vertices, n.

    Returns
    -------
    G : sparse array, shape (2 n, 2 n)
    """
    from scipy.sparse import coo_array

    at = (2 * F[..., None] + np.arange(2)).reshape(-1, 6)
    row, column = (np.broadcast_to(x, blocks.shape).ravel() for x in (at[:, :, None], at[:, None, :]))
    return coo_array((blocks.ravel(), (row, column)), (2 * count, 2 * count))


def least(G: Any, u: Array, rows: Rows, frames: Index) -> Array:
    """Return where v^T G v + v^T u is least, or stationary, of all v under conditions.

    Book: 6.3

    Parameters
    ----------
    G : ndarray or sparse array, shape (2 n, 2 n)
        Of it only the symmetric part counts.
    u : ndarray, shape (k, 2 n) or (1, 2 n)
    rows : Rows
        All of them exact, and with the same factors in all of these frames.
    frames : ndarray of int, shape (k,)
        Which of their times.

    Returns
    -------
    v : ndarray, shape (k, 2 n)

    Raises
    ------
    ValueError
        If the form and the conditions leave something loose.
    """
    from scipy.sparse import block_array, csc_array
    from scipy.sparse.linalg import splu

    n, every = G.shape[0] // 2, np.arange(len(rows.columns))
    asked = assembly.targets(rows, every, True)[:, frames].T
    # From all x, then all y, to x and y of each vertex.
    U = assembly.dense(rows, int(frames[0]), every, n, True)
    U = csc_array(U.reshape(-1, 2, n).swapaxes(1, 2).reshape(-1, 2 * n))
    pulled = np.broadcast_to(u, (len(frames), 2 * n))
    system = csc_array(block_array([[csc_array(G + G.T), U.T], [U, None]]))
    try:
        return splu(system).solve(np.concatenate([-pulled, asked], axis=1).T).T[:, : 2 * n]
    except RuntimeError:
        checks.fail(
            "forms.least", "G", "a form that holds the shape together", "one that leaves it loose", None
        )


def _sum(where: str, P: ArrayLike, F: ArrayLike, weights: ArrayLike) -> tuple[terms.Term, Index]:
    """The sum of E^F over the triangles, and these."""
    V = topology.vertices(where, "P", P)
    faces = topology.faces(where, F, len(V))
    share = checks.array(where, "weights", weights, ())
    if share.shape != (len(faces),):
        checks.fail(where, "weights", f"one for each of {len(faces)} triangles", f"shape {share.shape}", None)
    triangle.checks_degenerate(where, "P", triangle.sides(V[faces]))
    return terms.term(energy.FROBENIUS, _complex(V), faces, share, _no_maps), faces


def _no_maps(t: float) -> Complex:
    """What a form is asked for here is given with its own maps, not with those of a time."""
    raise NotImplementedError


def _complex(V: Array) -> Complex:
    return V[:, 0] + 1j * V[:, 1]


def _blocks(part: terms.Term, form: energy.Form) -> Array:
    """The real symmetric matrices (m, 6, 6) of the triangles."""
    diagonal, pairs = part.blocks(form)
    m = diagonal.shape[1]
    H: Complex = np.zeros((m, 3, 3), complex)
    H[:, range(3), range(3)] = diagonal.T
    for k, (i, j) in enumerate(terms.PAIRS):
        H[:, i, j], H[:, j, i] = pairs[k], np.conj(pairs[k])
    # conj(v) h w is the real form of [[Re h, -Im h], [Im h, Re h]].
    real = np.empty((m, 3, 2, 3, 2))
    real[:, :, 0, :, 0] = real[:, :, 1, :, 1] = np.real(H)
    real[:, :, 1, :, 0] = np.imag(H)
    real[:, :, 0, :, 1] = -np.imag(H)
    return real.reshape(m, 6, 6)
