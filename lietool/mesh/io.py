"""Read a flat mesh of a user, or two of the same connectivity, and write one.

Files are read by trimesh.  It is given the positions and faces alone, in their
order: from a whole file it would split vertices along the seams of textures
and leave out those that no face uses, and the two meshes would no longer match.
"""

import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh import mesh_text, topology
from lietool.mesh.files import BROKEN, Place, read_bytes, read_text
from lietool.mesh.predicates import orientation

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

_FLAT = 1e-5
_ENDINGS = (".obj", ".off", ".ply")


@dataclass(frozen=True, eq=False)
class Plane:
    """The plane of a flat mesh in space: the point (x, y) of the mesh is origin + x u + y v.

    Attributes
    ----------
    origin, u, v, normal : (3,)
        u and v are orthonormal and normal is their cross product; for a mesh in a plane of
        constant z they are the axes.
    """

    origin: Array
    u: Array
    v: Array
    normal: Array


@dataclass(frozen=True, eq=False)
class Flat:
    """A flat mesh.

    Attributes
    ----------
    vertices : (n, 2)
        In the order of the file.
    faces : (m, 3) of int
        Counter-clockwise.
    plane : Plane
        Where it lay.
    """

    vertices: Array
    faces: Ints
    plane: Plane


@dataclass(frozen=True, eq=False)
class Pair:
    """Two flat meshes of the same connectivity.

    Attributes
    ----------
    source, target : (n, 2)
    faces : (m, 3) of int
        Counter-clockwise in both.
    planes : (Plane, Plane)
    """

    source: Array
    target: Array
    faces: Ints
    planes: tuple[Plane, Plane]


def read(path: str | Path) -> Flat:
    """Return a flat mesh from a file .obj, .off or .ply.

    Parameters
    ----------
    path : str or Path
        Polygons of more than three corners are cut into triangles from their first corner.

    Returns
    -------
    mesh : Flat

    Raises
    ------
    ValueError
        If the file cannot be read as such, with the line where that is known, or the mesh is not
        flat, or has coincident vertices, flat triangles, triangles turned over or unused vertices.
    """
    place = Place("io.read", Path(path))
    V, F = _load(place)
    vertices, plane = _flatten(place, V, F)
    _check_distinct(place, vertices)
    topology.faces(f"io.read: {place.path}", F, len(vertices))
    sign = orientation(*(vertices[F[:, k]] for k in range(3)))
    _check_signs(place, vertices, F, sign)
    return Flat(vertices, F if sign[0] > 0 else F[:, ::-1].copy(), plane)


def read_pair(source: str | Path, target: str | Path) -> Pair:
    """Return two flat meshes with the same faces.

    Parameters
    ----------
    source, target : str or Path
        As for `read`.  The faces may come in another order, and begin at another corner.

    Returns
    -------
    pair : Pair

    Raises
    ------
    ValueError
        As `read`; or if the numbers of vertices or the faces differ, with the face, or the
        target is a reflection of the source.
    """
    first, second = read(source), read(target)
    place = Place("io.read_pair", Path(target))
    if len(first.vertices) != len(second.vertices):
        got = f"{len(second.vertices)}"
        place.fail(f"of as many vertices as {source}, {len(first.vertices)}", got)
    if len(first.faces) != len(second.faces):
        place.fail(f"of as many faces as {source}, {len(first.faces)}", f"{len(second.faces)}")
    mine, other = _canonical(first.faces), _canonical(second.faces)
    if not np.array_equal(mine[np.lexsort(mine.T)], other[np.lexsort(other.T)]):
        _report_difference(place, str(source), mine, other)
    return Pair(first.vertices, second.vertices, first.faces, (first.plane, second.plane))


def obj(vertices: ArrayLike, faces: ArrayLike) -> bytes:
    """Return a mesh as the contents of a file .obj; numbers are written so that they are read back exactly.

    Parameters
    ----------
    vertices : (n, 2) or (n, 3)
        Flat ones get z = 0.
    faces : (m, 3) of int

    Returns
    -------
    contents : bytes
    """
    V = checks.array("io.obj", "vertices", vertices, ())
    if V.ndim != 2 or V.shape[1] not in (2, 3):
        checks.fail("io.obj", "vertices", "an array of shape (n, 2) or (n, 3)", f"shape {V.shape}", None)
    F = topology.faces("io.obj", faces, len(V))
    tail = " 0" if V.shape[1] == 2 else ""
    lines = [f"v {' '.join(map(repr, row))}{tail}" for row in V.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (F + 1).tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")


def _load(place: Place) -> tuple[Array, Ints]:
    """Return vertices (n, 3) and triangles."""
    ending = place.path.suffix.lower()
    if ending not in _ENDINGS:
        remedy = "Save it as one of these."
        place.fail("a mesh, .obj, .off or .ply", ending or "no ending", remedy=remedy)
    if ending == ".ply":
        data = mesh_text.flat_ply(place, read_bytes(place))
    else:
        clean = mesh_text.clean_obj if ending == ".obj" else mesh_text.clean_off
        data = clean(place, read_text(place)).encode()
    import trimesh

    try:
        with np.errstate(invalid="raise", over="raise"):
            mesh = trimesh.load_mesh(
                io.BytesIO(data), file_type=ending[1:], process=False, maintain_order=True
            )
        V, F = np.asarray(mesh.vertices, float), np.asarray(mesh.faces)
    except BROKEN as error:
        place.fail(f"a mesh, {ending}, that trimesh reads", f"an error, {place.cause(error)}")
    if V.ndim != 2 or not len(V) or F.ndim != 2 or not len(F) or F.dtype.kind not in "iu":
        place.fail("a mesh of triangles", "no vertices" if not len(V) else "no faces")
    V = np.pad(V, ((0, 0), (0, 3 - V.shape[1])))
    bad = ~(np.abs(V) <= 1e100)
    if bad.any():
        i, k = checks.first(bad)
        place.fail("a mesh of finite vertices", f"{V[i, k]} in vertex {i}")
    outside = (F.min(axis=1) < 0) | (F.max(axis=1) >= len(V))
    if outside.any():
        (i,) = checks.first(outside)
        place.fail(f"a mesh whose faces use its {len(V)} vertices", f"{F[i].tolist()} as face {i}")
    return V, F.astype(np.intp)


def _flatten(place: Place, V: Array, F: Ints) -> tuple[Array, Plane]:
    """Return coordinates in the plane of the vertices, and that plane."""
    if np.all(V[:, 2] == V[0, 2]):
        x, y, z = np.eye(3)
        return V[:, :2].copy(), Plane(V[0, 2] * z, x, y, z)
    centre = V.mean(axis=0)
    _, size, axes = np.linalg.svd(V - centre, full_matrices=False)
    normal = axes[2]
    off = np.abs((V - centre) @ normal)
    if size[2] > _FLAT * size[0]:
        i = int(np.argmax(off))
        got = f"vertex {i} {off[i]:.3g} off the plane that fits best"
        place.fail("a flat mesh", got, remedy="Project it onto a plane.")
    # Seen from the side on which the faces are counter-clockwise: in space there is no other rule.
    a, b, c = (V[F[:, k]] for k in range(3))
    if np.sum(np.cross(b - a, c - a) @ normal) < 0.0:
        normal = -normal
    k = int(np.argmax(np.abs(normal) > 0.5))
    u = np.eye(3)[(k + 1) % 3]
    u = u - (u @ normal) * normal
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    return (V - centre) @ np.stack([u, v], axis=1), Plane(centre, u, v, normal)


def _check_distinct(place: Place, vertices: Array) -> None:
    order = np.lexsort(vertices.T)
    same = np.flatnonzero(np.all(vertices[order[1:]] == vertices[order[:-1]], axis=1))
    if len(same):
        pairs = np.sort(np.stack([order[same], order[same + 1]], axis=1), axis=1)
        i, j = (int(k) for k in pairs[np.lexsort(pairs.T[::-1])[0]])
        x, y = vertices[i]
        got = f"vertices {i} and {j} both at ({x:.6g}, {y:.6g})"
        place.fail("a mesh of distinct vertices", got, remedy="Merge them.")


def _check_signs(place: Place, vertices: Array, F: Ints, sign: NDArray[np.int8]) -> None:
    if np.any(sign == 0):
        (i,) = checks.first(sign == 0)
        x, y = vertices[F[i]].mean(axis=0)
        got = f"face {i}, {F[i].tolist()}, of area 0 near ({x:.6g}, {y:.6g})"
        place.fail("a mesh without flat triangles", got)
    if sign.min() != sign.max():
        few = 1 if np.count_nonzero(sign > 0) < np.count_nonzero(sign < 0) else -1
        (i,) = checks.first(sign == few)
        x, y = vertices[F[i]].mean(axis=0)
        got = f"face {i}, {F[i].tolist()}, turned over near ({x:.6g}, {y:.6g}), {np.sum(sign == few)} in all"
        place.fail("a mesh whose triangles all face one way", got)


def _canonical(F: Ints) -> Ints:
    """Return the faces, each from its smallest vertex."""
    at = np.argmin(F, axis=1)[:, None]
    return np.take_along_axis(F, (at + np.arange(3)) % 3, axis=1)


def _report_difference(place: Place, source: str, mine: Ints, other: Ints) -> None:
    turned = _canonical(other[:, ::-1])
    if np.array_equal(mine[np.lexsort(mine.T)], turned[np.lexsort(turned.T)]):
        remedy = "Mirror one of the meshes."
        place.fail(f"oriented as {source} is", "a reflection, det < 0 in every triangle", remedy=remedy)
    known = set(map(tuple, mine.tolist()))
    i = next((i for i, f in enumerate(other.tolist()) if tuple(f) not in known), 0)
    got = f"face {i}, {other[i].tolist()}, which {source} has not"
    place.fail(f"of the same faces as {source}", got, remedy="Both must number their vertices alike.")
