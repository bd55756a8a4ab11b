r"""A mesh from its gradients: Poisson's equation.

To edit a triangle mesh, every triangle is given a linear map $G$, what it is to do: turn, or stretch. Done to
each triangle alone this tears the mesh apart. Poisson's equation puts the triangles together again: it asks
for the coordinates whose gradients come nearest to those that the maps demand,
$$\nabla^2 f = \mathrm{div}\, v, \qquad f|_{\partial\Omega} = f^*|_{\partial\Omega}, \quad (7.12)$$
once for each of the coordinates $f = x, y, z$, with some vertices held at given places $f^*$.

**The guidance field.** A coordinate is a function that is linear on each triangle, with the gradient
$\nabla f = \sum_k f_k \nabla B_k$ there: $B_k$ is the hat function of the corner $k$, 1 there and 0 at the
two others. Its gradient lies in the plane of the triangle, is perpendicular to the opposite side $e_k$ and
points to the corner; its length is $|e_k| / 2|T|$, with $|T|$ the area. When $G$ acts on the triangle, the
gradient of the new coordinate $a$ is to be
$$v_a = \sum_b G_{ab} \nabla x_b ,$$
$x_1, x_2, x_3$ the old coordinates.

**The divergence** of a field $v$ that is constant on each triangle is summed around each vertex,
$$(\mathrm{div}\, v)(p_i) = - \sum_{T_k \ni p_i} \nabla B_{ik} \cdot v_k\, |T_k| , \quad (7.13)$$
so that it is positive where the field flows out, and the divergence of a gradient is the Laplacian.

**The equation** is $A f = b$, (7.14), with the matrix of the exercise on harmonic weights,
$A_{ij} = -\tfrac12(\cot\alpha + \cot\beta)$ for an edge and rows that sum to 0; also
$A_{ij} = \sum_k \nabla B_{ik} \cdot \nabla B_{jk} |T_k|$. It is positive, $A f = -\nabla^2 f$, hence
$b = -\mathrm{div}\, v$. Only the rows of free vertices count; in these, what is known goes to the right side.

Write two functions. In the picture the mesh has 6290 vertices, of which an arm is free: `scipy.sparse` and
`scipy.sparse.linalg` may be imported.
"""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import splu

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def divergence(V, F, v):
    """Return the divergence of a vector field on a mesh, integrated around each vertex.

    Parameters
    ----------
    V : ndarray, shape (n, 3)
        The vertices.
    F : ndarray of int, shape (m, 3)
        Each triangle's vertices; each triangle has an area.
    v : ndarray, shape (m, 3)
        The field, a vector for each triangle.

    Returns
    -------
    ndarray, shape (n,)
        The divergence at each vertex.
    """
    hats, area = _hats(V, F)
    flow = -area[:, None] * np.einsum("fki,fi->fk", hats, v)
    return np.bincount(F.ravel(), flow.ravel(), len(V))


def edit(V, F, G, held, places):
    """Return the mesh whose gradients are nearest to those that linear maps of its triangles demand.

    Parameters
    ----------
    V : ndarray, shape (n, 3)
        The vertices at rest.
    F : ndarray of int, shape (m, 3)
        Each triangle's vertices; each triangle has an area.
    G : ndarray, shape (m, 3, 3)
        What each triangle is to do: the matrix acts on columns.
    held : ndarray of int, shape (b,)
        The vertices that are held, each once; one at least in every connected part of the mesh.
    places : ndarray, shape (b, 3)
        Where they are held.

    Returns
    -------
    ndarray, shape (n, 3)
        The vertices; those that are held are at their places.
    """
    hats, area = _hats(V, F)
    # A row for each triangle and axis: the gradient of a function from its values.
    m, n = len(F), len(V)
    rows = np.repeat(np.arange(3 * m).reshape(m, 1, 3), 3, axis=1)
    gradient = csr_array(
        (hats.ravel(), (rows.ravel(), np.repeat(F[..., None], 3, axis=2).ravel())), (3 * m, n)
    )
    weighted = gradient.T * np.repeat(area, 3)
    demanded = (gradient @ V).reshape(m, 3, 3) @ np.swapaxes(G, 1, 2)
    b, A = weighted @ demanded.reshape(3 * m, 3), weighted @ gradient
    free = np.setdiff1d(np.arange(n), held)
    moved = np.empty((n, 3))
    moved[held] = places
    below = A.tocsr()[free]
    moved[free] = splu(below[:, free].tocsc()).solve(b[free] - below[:, held] @ places)
    return moved


def _hats(V, F):
    """The gradients (m, 3, 3) of the hat functions of the corners, and the areas of triangles."""
    corner = V[F]
    n = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    side = np.roll(corner, -2, axis=1) - np.roll(corner, -1, axis=1)
    square = np.sum(n * n, axis=1)
    return np.cross(n[:, None], side) / square[:, None, None], 0.5 * np.sqrt(square)


def _rough(rng, rows=5, columns=6, flat=False):
    """A grid of squares, each cut in two, with its vertices moved."""
    y, x = (a.ravel() for a in np.indices((rows, columns)))
    V = np.stack([x, y, 0.0 * x], axis=1) + 0.25 * rng.uniform(-1.0, 1.0, (len(x), 3))
    k = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]))
    F = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return V * [1.0, 1.0, 0.0 if flat else 1.0], F


def _turn(x):
    """The rotations about z by angles."""
    R = np.zeros((*np.shape(x), 3, 3))
    R[..., 0, 0] = R[..., 1, 1] = np.cos(x)
    R[..., 1, 0] = np.sin(x)
    R[..., 0, 1], R[..., 2, 2] = -R[..., 1, 0], 1.0
    return R


_SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
_HALVES = np.array([[0, 1, 2], [0, 2, 3]])
_ENDS = np.array([0, 6, 12, 18, 24, 5, 29])


def _fields(rng):
    east = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    yield Case("a unit square, the field (1, 0, 0)", (_SQUARE, _HALVES, east), "divergence")
    yield Case(
        "the same, another field in each half", (_SQUARE, _HALVES, east * [[1.0], [-2.0]]), "divergence"
    )
    V, F = _rough(rng)
    yield Case("a random field on a rough surface", (V, F, rng.normal(size=(len(F), 3))), "divergence")
    yield Case(
        "the same surface three times as large", (3.0 * V, F, rng.normal(size=(len(F), 3))), "divergence"
    )


def _whole(rng):
    V, F = _rough(rng)
    still = np.tile(np.eye(3), (len(F), 1, 1))
    yield Case("nothing is to change", (V, F, still, _ENDS, V[_ENDS]), "edit")
    R = _turn(np.pi / 2)
    yield Case("all turned by a quarter", (V, F, still @ R, _ENDS, V[_ENDS] @ R.T), "edit")
    yield Case("one vertex held, all turned", (V, F, still @ R, _ENDS[:1], V[_ENDS[:1]]), "edit")


def _each(rng):
    V, F = _rough(rng)
    middle = V[F].mean(axis=1)[:, 0]
    yield Case(
        "each turned further than its left neighbour", (V, F, _turn(0.4 * middle), _ENDS, V[_ENDS]), "edit"
    )
    G = np.eye(3) + 0.3 * rng.normal(size=(len(F), 3, 3))
    places = V[_ENDS] + rng.normal(size=(7, 3))
    yield Case("random maps and places", (V, F, G, _ENDS, places), "edit")
    yield Case("the same, held in another order", (V, F, G, _ENDS[::-1], places), "edit")


def _laws(f, rng):
    V, F = _rough(rng)
    div = f.divergence(V, F, rng.normal(size=(len(F), 3)))
    yield Claim("what flows out somewhere flows in elsewhere: the sum over all vertices is 0", div.sum(), 0.0)
    P, F = _rough(rng, flat=True)
    inner = np.setdiff1d(np.arange(30), np.concatenate([[*range(6)], [*range(24, 30)], _ENDS, [11, 17, 23]]))
    even = f.divergence(P, F, np.tile([0.3, -1.0, 0.0], (len(F), 1)))
    yield Claim("a constant field in the plane: 0 at inner vertices", even[inner], np.zeros(len(inner)))
    G = np.eye(3) + 0.3 * rng.normal(size=(3, 3))
    same = f.edit(V, F, np.tile(G, (len(F), 1, 1)), _ENDS, V[_ENDS] @ G.T)
    yield Claim("the same map for all, and its places: every vertex follows it", same, V @ G.T)
    maps, d = np.eye(3) + 0.3 * rng.normal(size=(len(F), 3, 3)), np.array([1.0, -2.0, 3.0])
    one, other = (f.edit(V, F, maps, _ENDS, V[_ENDS] + shift) for shift in (0.0, d))
    yield Claim("places moved by d: all move by d", other, one + d)


def _hard(f, rng):
    V, F = _rough(rng)
    G = np.eye(3) + 0.3 * rng.normal(size=(len(F), 3, 3))
    wanted = EXERCISE.function("edit").wanted(V, F, G, _ENDS, V[_ENDS])
    tiny = 1e6 * f.edit(1e-6 * V, F, G, _ENDS, 1e-6 * V[_ENDS])
    yield Claim("a mesh a million times smaller", tiny, wanted, tolerance=1e-7)
    far = f.edit(V + 1e3, F, G, _ENDS, V[_ENDS] + 1e3) - 1e3
    yield Claim("the same far from the origin", far, wanted, tolerance=1e-7)
    loose = np.arange(30)
    at = V + 1.0
    yield Claim("every vertex but one held", f.edit(V, F, G, loose[1:], at[1:])[1:], at[1:])


def _shown(f):
    """The student's function as the figure calls that of the library."""

    def join(prepared, guide, values):
        held = prepared.factor.fixed
        return np.asarray(f.edit(prepared.vertices, prepared.faces, guide, held, values))

    return {"join": join}


def _reference(join, V, F, G, held, places):
    from lietool.deform import poisson

    none = np.zeros((len(V), 1))
    prepared = poisson.prepare(V, F, held[1:], [held[:1]], none)
    order = np.argsort(held)
    return join(prepared, G, places[order][np.searchsorted(held[order], prepared.factor.fixed)])


def _solved(A, b, held, places):
    free = np.setdiff1d(np.arange(len(A)), held)
    moved = np.empty((len(A), 3))
    moved[held] = places
    moved[free] = np.linalg.solve(A[np.ix_(free, free)], (b - A[:, held] @ places)[free])
    return moved


def _wrong(change=lambda U: U, areas=True, sign=1.0, uniform=False):
    """An edit with mistakes: in the fields (m, 3, 3), of areas, of the sign, of the matrix."""

    def made(V, F, G, held, places):
        hats, area = _hats(V, F)
        gradient = np.zeros((len(F), 3, len(V)))
        np.put_along_axis(gradient, np.repeat(F[:, None], 3, axis=1), np.swapaxes(hats, 1, 2), axis=2)
        demanded = (gradient @ V) @ np.swapaxes(change(G), 1, 2)
        A = np.einsum("fin,fim,f->nm", gradient, gradient, area)
        if uniform:
            A = -(A != 0.0).astype(float)
            A -= np.diag(A.sum(axis=1))
        b = np.einsum("fin,fia,f->na", gradient, demanded, area if areas else np.ones_like(area))
        return _solved(A, sign * b, held, places)

    return made


EXERCISE = Exercise(
    number=19,
    title="A mesh from its gradients",
    equations=("7.12", "7.13", "7.14"),
    functions=(
        Function(
            "divergence",
            library="lietool.mesh.laplacian.divergence",
            call=lambda divergence, V, F, v: divergence(V, F) @ v.ravel(),
            starter="return np.full(len(V), np.nan)",
        ),
        Function(
            "edit",
            library="lietool.deform.poisson.join",
            call=_reference,
            starter="return np.full(V.shape, np.nan)",
            tolerance=1e-8,
        ),
    ),
    checks=(
        Check("the divergence", 2, cases=_fields),
        Check("one map for all", 1, cases=_whole),
        Check("a map for each", 2, cases=_each),
        Check("laws", 2, law=_laws),
        Check("hard inputs: tiny, far away", 1, law=_hard),
    ),
    picture=Picture("B7.8", 2, _shown),
    mutants=("laplacian.divergence: without area",),
    allowed=("scipy.sparse", "scipy.sparse.linalg"),
    mistakes=(
        Mistake(
            "as printed",
            "This is (7.13) as it is printed, without the minus: the divergence is then negative where the "
            "field flows out, and div grad is minus the Laplacian. `lietool errata 7.13`.",
            {"divergence": lambda V, F, v: -divergence(V, F, v)},
        ),
        Mistake(
            "without areas",
            "The areas |T| are left out of the divergence: each triangle counts by its own.",
            {"divergence": lambda V, F, v: divergence(V, F, v / _hats(V, F)[1][:, None])},
        ),
        Mistake(
            "twice the areas",
            "This is twice the divergence: the cross product of two sides is as long as twice the area.",
            {"divergence": lambda V, F, v: 2.0 * divergence(V, F, v)},
        ),
        Mistake(
            "sign of the right side",
            "The triangles are turned inside out: with the positive matrix A the right side is -div v, for "
            "A f = -(Laplacian of f).",
            {"edit": _wrong(sign=-1.0)},
        ),
        Mistake(
            "G transposed",
            "G acts on the gradients transposed: that of the new coordinate a is sum_b G_ab grad x_b.",
            {"edit": _wrong(lambda G: np.swapaxes(G, 1, 2))},
        ),
        Mistake(
            "no guidance",
            "Without the guidance field this is a membrane that is spread between what is held, "
            "A f = 0: the right side is -div v.",
            {"edit": _wrong(sign=0.0)},
        ),
        Mistake(
            "the maps left out",
            "The guidance field is the old gradients: the maps G have no part in it.",
            {"edit": _wrong(lambda G: 0.0 * G + np.eye(3))},
        ),
        Mistake(
            "areas left out of the right side",
            "The areas |T| are left out of the right side, while the matrix A has them in its cotangents.",
            {"edit": _wrong(areas=False)},
        ),
        Mistake(
            "every edge alike",
            "The matrix is the graph's, in which every edge counts alike: (7.14) has the cotangents.",
            {"edit": _wrong(uniform=True)},
        ),
    ),
)
