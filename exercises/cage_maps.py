r"""The maps of a cage's faces.

A cage is a closed surface of triangles around a shape; who moves its vertices moves the shape. Every face of
the cage tells an affine map: the one that takes the face from where it is at rest to where it is in the pose.
Three points do not determine an affine map of space. A fourth point is added by the normal of the face: with
the corners $p_1, p_2, p_3$,
$$e_1 = p_2 - p_1, \qquad e_2 = p_3 - p_1, \qquad n = e_1 \times e_2, \qquad
p_4 = p_1 + \frac{n}{\sqrt{|n|}} .$$
The length of $n$ is twice the area of the face, so that of $n/\sqrt{|n|}$ grows as the sides do: a cage that
is made twice as large has tetrahedra twice as large in every direction. A face that has collapsed, $n = 0$,
has its fourth point at $p_1$.

The map of the face is the only affine one with
$$A\,p_k = p_k' \qquad (k = 1, \dots, 4),$$
as a homogeneous matrix of 4 rows of 4 that acts on columns $(x, y, z, 1)^T$, the last row $(0, 0, 0, 1)$.
These are the $\hat A_i$ that (7.9) blends, figure 7.6.

Write two functions; both take many faces at once. For `maps` all faces have an area at rest; if one has
none there is no map, and a ValueError is wanted. In the pose a face may collapse.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def tetrahedra(corners):
    """Return the tetrahedra of faces: their corners, and a fourth point by the normal.

    Parameters
    ----------
    corners : ndarray, shape (m, 3, 3)
        corners[i, k] is the point p_(k+1) of face i.

    Returns
    -------
    ndarray, shape (m, 4, 3)
        The points p_1 to p_4 of each face.
    """
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(n, axis=1, keepdims=True)
    up = n / np.sqrt(np.where(size > 0.0, size, 1.0))
    return np.concatenate([corners, (corners[:, 0] + up)[:, None]], axis=1)


def maps(rest, posed):
    """Return the affine maps that take faces from rest to a pose.

    Parameters
    ----------
    rest : ndarray, shape (m, 3, 3)
        The corners of m faces at rest; rest[i, k] is a point.
    posed : ndarray, shape (m, 3, 3)
        The same corners in the pose.

    Returns
    -------
    ndarray, shape (m, 4, 4)
        Homogeneous matrices; they act on columns.
    """
    P, Q = _homogeneous(tetrahedra(rest)), _homogeneous(tetrahedra(posed))
    # numpy's error of a singular matrix is a ValueError.
    A = Q @ np.linalg.inv(P)
    A[:, 3] = [0.0, 0.0, 0.0, 1.0]
    return A


def _homogeneous(points):
    """The points (m, 4, 3) as columns with a 1 below."""
    columns = np.swapaxes(points, 1, 2)
    return np.concatenate([columns, np.ones((len(points), 1, 4))], axis=1)


_FLAT = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def _turn(rng):
    """A random rotation."""
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q * np.sign(np.linalg.det(Q))


def _normals(rng):
    yield Case("the corners of half a unit square", (_FLAT[None],), "tetrahedra")
    yield Case("the same twice as large", (2.0 * _FLAT[None],), "tetrahedra")
    yield Case("with the corners the other way round", (_FLAT[None, ::-1],), "tetrahedra")
    yield Case("random faces", (rng.normal(size=(5, 3, 3)),), "tetrahedra")


def _single(rng):
    P = _FLAT[None]
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    yield Case("a translation", (P + 3.0, P + np.array([4.0, 3.0, 1.0])), "maps")
    yield Case("a quarter turn about z", (P, P @ quarter.T), "maps")
    yield Case("twice as large", (P + 1.0, 2.0 * P), "maps")
    yield Case("longer on one side", (P, P * [4.0, 1.0, 1.0]), "maps")


def _batch(rng):
    yield Case("one random face", (rng.normal(size=(1, 3, 3)), rng.normal(size=(1, 3, 3))), "maps")
    yield Case("40 random faces", (rng.normal(size=(40, 3, 3)), rng.normal(size=(40, 3, 3))), "maps")


def _laws(f, rng):
    P, Q, S = rng.normal(size=(3, 4, 3, 3))
    A = f.maps(P, Q)
    T, moved = f.tetrahedra(P), f.tetrahedra(Q)
    there = np.einsum("mij,mkj->mki", A[:, :3, :3], T) + A[:, None, :3, 3]
    yield Claim("A p_k = p_k' for all four points", there, moved, tolerance=1e-8)
    yield Claim("to a pose and on to the next: the product", f.maps(Q, S) @ A, f.maps(P, S), tolerance=1e-7)
    similar = np.eye(4)
    similar[:3, :3], similar[:3, 3] = 1.7 * _turn(rng), rng.normal(size=3)
    now = P @ similar[:3, :3].T + similar[:3, 3]
    says = "a face turned, moved and made 1.7 times as large has this as its map"
    yield Claim(says, f.maps(P, now), np.tile(similar, (4, 1, 1)))


def _hard(f, rng):
    """Inputs that only care gets right: told as laws, lest they hide which mistake it is."""
    line = np.array([[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]])
    flat = np.concatenate([line, line[:, :1]], axis=1)
    yield Claim("a face that has collapsed to a line has p_4 = p_1", f.tetrahedra(line), flat, (line,))
    A = f.maps(_FLAT[None] + 1.0, np.full((1, 3, 3), 2.0))[0]
    point = np.zeros((4, 4))
    point[:, 3] = [2.0, 2.0, 2.0, 1.0]
    yield Claim("a face that has collapsed to (2, 2, 2) takes all of space there", A, point)
    P, Q = rng.normal(size=(2, 3, 3, 3))
    small = f.maps(1e-6 * P, 1e-6 * Q)[:, :3, :3]
    says = "of faces a million times smaller, rest and pose, the linear part is the same"
    yield Claim(says, small, f.maps(P, Q)[:, :3, :3], tolerance=1e-7)


def _bad(rng):
    line = np.array([[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]])
    yield Case("a face at rest that is a line", (line, _FLAT[None]), "maps", raises=True)
    both = np.concatenate([_FLAT[None], np.ones((1, 3, 3))])
    yield Case("two faces at rest, one of them a point", (both, both), "maps", raises=True)


def _shown(f):
    """The student's functions as the figure calls those of the library."""

    def fourth(elements, V):
        return np.asarray(f.tetrahedra(V[elements.faces]))

    def found(rest, V):
        sides = np.swapaxes(np.linalg.inv(rest.inverse), 1, 2)
        P = rest.origin[:, None] + np.concatenate([np.zeros((len(sides), 1, 3)), sides[:, :2]], axis=1)
        A = np.asarray(f.maps(P, V[rest.elements.faces]))
        if np.abs(A[:, 3] - np.eye(4)[3]).max() > 1e-9:
            raise ValueError("the last row of a map is not 0 0 0 1")
        return A

    return {"tetrahedra": fourth, "maps": found}


def _as_cage(corners):
    """The elements of faces that have no vertex in common, and their vertices."""
    from lietool.deform import cage_frames

    F = np.arange(3 * len(corners)).reshape(-1, 3)
    return cage_frames.faces(F), np.reshape(corners, (-1, 3))


def _reference(maps, rest, posed):
    from lietool.deform import cage_frames

    elements, V = _as_cage(rest)
    return maps(cage_frames.rest(elements, V), np.reshape(posed, (-1, 3)))


def _by_normal(power, side=1.0):
    """Both functions with a fourth point at n |n|^power."""

    def made(corners):
        n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        up = side * n * np.linalg.norm(n, axis=1, keepdims=True) ** power
        return np.concatenate([corners, (corners[:, 0] + up)[:, None]], axis=1)

    def mapped(rest, posed):
        return _homogeneous(made(posed)) @ np.linalg.inv(_homogeneous(made(rest)))

    return {"tetrahedra": made, "maps": mapped}


def _linear(change):
    """The maps with another linear part, which keep the first corner's way."""

    def made(rest, posed):
        P, Q = (np.swapaxes((T := tetrahedra(X))[:, 1:] - T[:, :1], 1, 2) for X in (rest, posed))
        A = np.tile(np.eye(4), (len(P), 1, 1))
        A[:, :3, :3] = change(P, Q)
        A[:, :3, 3] = posed[:, 0] - (A[:, :3, :3] @ rest[:, 0, :, None])[..., 0]
        return A

    return made


def _first_corner(rest, posed):
    A = maps(rest, posed)
    A[:, :3, 3] = posed[:, 0] - rest[:, 0]
    return A


def _in_plane(P, Q):
    return Q[..., :2] @ np.linalg.pinv(P[..., :2])


EXERCISE = Exercise(
    number=17,
    title="The maps of a cage's faces",
    equations=("7.9", "M 5"),
    functions=(
        Function(
            "tetrahedra",
            library="lietool.deform.cage_frames.tetrahedra",
            call=lambda tetrahedra, corners: tetrahedra(*_as_cage(corners)),
            starter="return np.full((len(corners), 4, 3), np.nan)",
        ),
        Function(
            "maps",
            library="lietool.deform.cage_frames.maps",
            call=_reference,
            starter="return np.full((len(rest), 4, 4), np.nan)",
            tolerance=1e-8,
        ),
    ),
    checks=(
        Check("the fourth point", 2, cases=_normals),
        Check("the map of a face", 1, cases=_single),
        Check("many faces", 1, cases=_batch),
        Check("laws", 2, law=_laws),
        Check("hard inputs: collapsed, tiny", 1, law=_hard),
        Check("bad input: no area at rest", 1, cases=_bad),
    ),
    picture=Picture("B7.6", 2, _shown),
    mutants=("cage_frames.maps: inverse on the wrong side",),
    mistakes=(
        Mistake(
            "unit normal",
            "The fourth point is at the unit normal, which does not grow with the cage: a cage twice as "
            "large would have maps that scale by 2, 2 and 1. Add n / sqrt|n|.",
            _by_normal(-1.0),
        ),
        Mistake(
            "whole normal",
            "The fourth point is at n itself, whose length is an area and grows with the square of the cage. "
            "Add n / sqrt|n|.",
            _by_normal(0.0),
        ),
        Mistake(
            "normal inwards",
            "The fourth point lies on the inner side: n = e_1 x e_2, with e_1 to the second corner and e_2 "
            "to the third. (The maps are the same.)",
            {"tetrahedra": _by_normal(-0.5, -1.0)["tetrahedra"]},
        ),
        Mistake(
            "back to rest",
            "This is the map from the pose back to rest, the inverse of what is wanted: A P = Q, so that "
            "A = Q P^-1.",
            {"maps": lambda rest, posed: maps(posed, rest)},
        ),
        Mistake(
            "wrong order",
            "P^-1 Q for Q P^-1: with the points in the columns A P = Q.",
            {"maps": _linear(lambda P, Q: np.linalg.inv(P) @ Q)},
        ),
        Mistake(
            "rows for columns",
            "The matrices are those that act on rows: transpose them, for they act on columns "
            "(x, y, z, 1)^T.",
            {"maps": lambda rest, posed: np.swapaxes(maps(rest, posed), 1, 2)},
        ),
        Mistake(
            "linear part transposed",
            "The linear part is transposed: the sides of the tetrahedra belong into the columns of P and Q.",
            {"maps": _linear(lambda P, Q: np.swapaxes(Q @ np.linalg.inv(P), 1, 2))},
        ),
        Mistake(
            "translation of a corner",
            "The translation is p_1' - p_1, by which the first corner moves; the linear part turns p_1 too, "
            "and what is left is p_1' - L p_1.",
            {"maps": _first_corner},
        ),
        Mistake(
            "in the plane of the face",
            "This map flattens what is across the face: three points do not determine it. Take p_4 too.",
            {"maps": _linear(_in_plane)},
        ),
    ),
)
