r"""Harmonic weights of handles.

Some vertices of a triangle mesh are held by handles. Every other vertex is to have a weight for each handle,
between them as even as the surface allows: the harmonic function $h$, for which $\nabla^2 h = 0$ on the
surface, 1 at the vertices of the handle itself and 0 at those of all others.

On a mesh $h$ is linear in each triangle, and its Dirichlet energy $\int |\nabla h|^2$ is
$\tfrac12 \sum_{ij} w_{ij} (h_i - h_j)^2$, twice the sum over edges: an edge $ij$ counts by
$$w_{ij} = \tfrac12 \sum_{\text{triangles } ijk} \cot \alpha_k ,$$
with $\alpha_k$ the angle at the corner $k$ that lies opposite to the edge, in one triangle at a border and
in two elsewhere. The energy is least where at each vertex that no handle holds
$$(A h)_i = \sum_j w_{ij} (h_i - h_j) = 0 .$$
$A$ is the matrix of the Poisson equation (7.14), symmetric with $A_{ij} = -w_{ij}$ and
$A_{ii} = \sum_j w_{ij}$. Where values are given, they are moved to the right side: of the rows of vertices
that are free, the columns of those that are held.

Write two functions. The meshes are small, and full matrices will do; `scipy.sparse` and
`scipy.sparse.linalg` may be imported too. A triangle without an area has no cotangents: `weights` raises a
ValueError there.
"""

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def cotangents(V, F):
    """Return the cotangents of the angles at the corners of triangles.

    Parameters
    ----------
    V : ndarray, shape (n, 3)
        The vertices.
    F : ndarray of int, shape (m, 3)
        Each triangle's vertices; each triangle has an area.

    Returns
    -------
    ndarray, shape (m, 3)
        Entry (f, k) belongs to the corner F[f, k].
    """
    corner = V[F]
    u, v = np.roll(corner, -1, axis=1) - corner, np.roll(corner, -2, axis=1) - corner
    # The dot product is |u| |v| cos, the length of the cross product |u| |v| sin.
    return np.sum(u * v, axis=2) / np.linalg.norm(np.cross(u, v), axis=2)


def weights(V, F, handle):
    """Return harmonic weights of handles.

    Parameters
    ----------
    V : ndarray, shape (n, 3)
        The vertices.
    F : ndarray of int, shape (m, 3)
        Each triangle's vertices.
    handle : ndarray of int, shape (n,)
        The number of the handle that holds a vertex, from 0; -1 where it is free. Every connected part of
        the mesh has a vertex that is held.

    Returns
    -------
    ndarray, shape (n, k)
        A column for each handle, k = max(handle) + 1.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        w = 0.5 * cotangents(V, F).ravel()
    if not np.isfinite(w).all():
        raise ValueError("a triangle has no area")
    # The corner k is opposite to the edge between the next one and the one after.
    i, j = F[:, [1, 2, 0]].ravel(), F[:, [2, 0, 1]].ravel()
    rows, columns = np.concatenate([i, j, i, j]), np.concatenate([j, i, i, j])
    A = csc_array((np.concatenate([-w, -w, w, w]), (rows, columns)), (len(V), len(V)))
    held = handle >= 0
    h = np.zeros((len(V), handle.max() + 1))
    h[held] = np.eye(h.shape[1])[handle[held]]
    below = A[~held]
    h[~held] = splu(below[:, ~held]).solve(-(below[:, held] @ h[held]))
    return h


def _grid(rows, columns):
    """A flat grid of unit squares, each cut in two: vertices and triangles."""
    y, x = np.indices((rows, columns))
    V = np.stack([x.ravel(), y.ravel(), np.zeros(rows * columns)], axis=1).astype(float)
    k = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]))
    return V, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _rough(rng, rows=6, columns=7, flat=False):
    """A grid whose inner vertices are moved, in the plane or in space."""
    V, F = _grid(rows, columns)
    moved = V + 0.25 * rng.uniform(-1.0, 1.0, V.shape)
    return moved * [1.0, 1.0, 0.0 if flat else 2.0], F


def _border(V, rows, columns):
    k = np.arange(rows * columns).reshape(rows, columns)
    edge = np.ones((rows, columns), bool)
    edge[1:-1, 1:-1] = False
    return k[edge]


def _held(n, *sets):
    handle = np.full(n, -1)
    for k, own in enumerate(sets):
        handle[np.asarray(own)] = k
    return handle


_SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
_OCTAHEDRON = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)


def _corners(rng):
    yield Case("half a unit square", (_SQUARE, np.array([[0, 1, 2]])), "cotangents")
    even = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, np.sqrt(0.75), 0.0]])
    yield Case("three equal sides", (even, np.array([[0, 1, 2]])), "cotangents")
    obtuse = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    yield Case("an obtuse angle", (obtuse, np.array([[0, 1, 2]])), "cotangents")
    yield Case(
        "random triangles in space", (rng.normal(size=(9, 3)), np.arange(9).reshape(3, 3)), "cotangents"
    )


def _strip(rng):
    V, F = _grid(2, 5)
    ends = _held(10, [0, 5], [4, 9])
    yield Case("a strip of squares between two handles", (V, F, ends), "weights")
    wide = np.stack([V[:, 0] ** 2, V[:, 1], 0.0 * V[:, 0]], axis=1)
    yield Case("the same with squares that grow wider", (wide, F, ends), "weights")


def _surfaces(rng):
    V, F = _rough(rng)
    yield Case("a rough surface, two handles", (V, F, _held(42, [0, 1, 7], [40, 41])), "weights")
    yield Case("three handles, numbers mixed", (V, F, _held(42, [20], [0, 35], [6])), "weights")
    P = np.concatenate([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]] + 0.2 * rng.uniform(-1.0, 1.0, (6, 3))
    yield Case("a closed surface", (P, _OCTAHEDRON, _held(6, [4], [5])), "weights")


def _laws(f, rng):
    V, F = _rough(rng)
    h = f.weights(V, F, _held(42, [0], [6, 13], [35]))
    yield Claim("the weights of every vertex sum to 1", h.sum(axis=1), np.ones(42))
    yield Claim("at its vertices a handle has 1 and the others 0", h[[0, 6, 13, 35]], np.eye(3)[[0, 1, 1, 2]])
    P, F = _rough(rng, flat=True)
    border = _border(P, 6, 7)
    h = f.weights(P, F, _held(42, *border[:, None]))
    says = "in the plane, every vertex of the border a handle: the places, summed by weights, are reproduced"
    yield Claim(says, h @ P[border], P)


def _hard(f, rng):
    V, F = _rough(rng)
    handle = _held(42, [0, 1, 7], [40, 41])
    h = f.weights(V, F, handle)
    yield Claim("a mesh a million times smaller has the same weights", f.weights(1e-6 * V, F, handle), h)
    again = f.weights(V, np.roll(F, 1, axis=1), handle)
    yield Claim("triangles that begin with another corner: the same weights", again, h)
    flat = V * [1.0, 0.01, 1.0]
    from lietool.deform import harmonic

    want = harmonic.harmonic(flat, F, [np.flatnonzero(handle == k) for k in (0, 1)])
    yield Claim(
        "very obtuse triangles: weights below 0 or above 1 are left", f.weights(flat, F, handle), want
    )


def _bad(rng):
    V, F = _rough(rng)
    V[F[5, 1]] = V[F[5, 0]]
    yield Case("a triangle two of whose corners are one point", (V, F, _held(42, [0], [41])), "weights", True)


def _shown(f):
    """The student's function as the figure calls that of the library."""

    def weights(V, F, handles):
        return np.asarray(f.weights(V, F, _held(len(V), *handles)))

    return {"weights": weights}


def _reference(harmonic, V, F, handle):
    return harmonic(V, F, [np.flatnonzero(handle == k) for k in range(handle.max() + 1)])


def _with(entries, square=False):
    """The weights by other numbers (m, 3) for edges, those opposite to the corners."""

    def made(V, F, handle):
        i, j, w = F[:, [1, 2, 0]].ravel(), F[:, [2, 0, 1]].ravel(), entries(V, F).ravel()
        A = np.zeros((len(V), len(V)))
        np.add.at(A, (i, j), -w)
        np.add.at(A, (j, i), -w)
        A -= np.diag(A.sum(axis=1))
        return _solved(A @ A if square else A, handle)

    return made


def _solved(A, handle):
    held = handle >= 0
    h = np.zeros((len(A), handle.max() + 1))
    h[held] = np.eye(h.shape[1])[handle[held]]
    h[~held] = np.linalg.solve(A[np.ix_(~held, ~held)], -A[np.ix_(~held, held)] @ h[held])
    return h


def _uniform(V, F, handle):
    A = np.zeros((len(V), len(V)))
    A[F, np.roll(F, -1, axis=1)] = A[np.roll(F, -1, axis=1), F] = -1.0
    return _solved(A - np.diag(A.sum(axis=1)), handle)


def _cosines(V, F):
    return (c := cotangents(V, F)) / np.sqrt(1.0 + c * c)


def _by_distance(V, F, handle):
    """In proportion to the inverse squares of the distances to the handles' nearest vertices."""
    k = handle.max() + 1
    near = [np.linalg.norm(V[:, None] - V[handle == i], axis=2).min(axis=1) for i in range(k)]
    w = np.maximum(np.stack(near, axis=1), 1e-12) ** -2.0
    return w / w.sum(axis=1, keepdims=True)


EXERCISE = Exercise(
    number=18,
    title="Harmonic weights of handles",
    equations=("7.14",),
    functions=(
        Function(
            "cotangents",
            library="lietool.mesh.laplacian.cotangents",
            starter="return np.full(F.shape, np.nan)",
        ),
        Function(
            "weights",
            library="lietool.deform.harmonic.harmonic",
            call=_reference,
            starter="return np.full((len(V), handle.max() + 1), np.nan)",
            tolerance=1e-8,
        ),
    ),
    checks=(
        Check("cotangents", 2, cases=_corners),
        Check("a strip", 1, cases=_strip),
        Check("surfaces", 1, cases=_surfaces),
        Check("laws", 2, law=_laws),
        Check("hard inputs: obtuse, tiny", 1, law=_hard),
        Check("bad input: no area", 1, cases=_bad),
    ),
    picture=Picture("G7.14", 2, _shown),
    mutants=("harmonic.weights",),
    allowed=("scipy.sparse", "scipy.sparse.linalg"),
    mistakes=(
        Mistake(
            "cosine",
            "This is the cosine of the angle; the Laplacian has its cotangent, u . v / |u x v|.",
            {"cotangents": _cosines, "weights": _with(_cosines)},
        ),
        Mistake(
            "tangent",
            "This is the tangent of the angle, |u x v| / u . v; the Laplacian has the cotangent.",
            {"cotangents": lambda V, F: 1.0 / cotangents(V, F)},
        ),
        Mistake(
            "half of them",
            "These are half of the cotangents; the half comes in with w_ij.",
            {"cotangents": lambda V, F: 0.5 * cotangents(V, F)},
        ),
        Mistake(
            "another corner",
            "The cotangents stand at another corner than theirs: entry (f, k) belongs to the corner F[f, k].",
            {"cotangents": lambda V, F: np.roll(cotangents(V, F), 1, axis=1)},
        ),
        Mistake(
            "another corner, the other way",
            "The cotangents stand at another corner than theirs: entry (f, k) belongs to the corner F[f, k].",
            {"cotangents": lambda V, F: np.roll(cotangents(V, F), -1, axis=1)},
        ),
        Mistake(
            "at the edge's own corner",
            "An edge has the cotangent of a corner that it begins at; w_ij has that of the corner opposite.",
            {"weights": _with(lambda V, F: np.roll(cotangents(V, F), -1, axis=1))},
        ),
        Mistake(
            "at the edge's own end",
            "An edge has the cotangent of a corner that it ends at; w_ij has that of the corner opposite.",
            {"weights": _with(lambda V, F: np.roll(cotangents(V, F), 1, axis=1))},
        ),
        Mistake(
            "every edge alike",
            "Every edge counts alike here: the Laplacian of the graph, which does not know how long edges "
            "are. That of the surface has (cot + cot) / 2, (7.14).",
            {"weights": _uniform},
        ),
        Mistake(
            "cotangents cut off at 0",
            "Negative cotangents are set to 0. They are what an obtuse angle has, and belong to the energy.",
            {"weights": _with(lambda V, F: np.maximum(cotangents(V, F), 0.0))},
        ),
        Mistake(
            "the Laplacian twice",
            "A A h = 0 is the bilaplacian's equation; harmonic functions satisfy A h = 0.",
            {"weights": _with(lambda V, F: 0.5 * cotangents(V, F), square=True)},
        ),
        Mistake(
            "by distance",
            "These are weights by the distance to handles in space; harmonic ones solve an equation on the "
            "surface.",
            {"weights": _by_distance},
        ),
    ),
)
