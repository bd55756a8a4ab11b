"""A coarse cage around a mesh or a cloud of points, for those who have none.

The points that are at most some distance away from the shape, hollows filled, make a solid; its surface is
taken from a grid (marching cubes) and made coarser from outside (`nested_hull`), so that it goes on to
contain the solid.  The more faces are allowed, the nearer the cage follows limbs.  Parts that are farther
apart than about twice the distance get cages of their own, all in one.  The result depends on the arguments
alone.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import cage_checks, cage_view, nested_hull
from lietool.mesh import _kept, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

FACES = 120
"""How many faces a cage has at most, unless told."""

MARGIN = 0.02
"""How far the cage keeps from the shape, as a part of the diagonal of its bounding box, unless told."""

_CELLS = 22
"""Cells of the grid along the diagonal, for 120 faces; more for more."""

_CLEAR = 0.12
"""Grid values nearer to the level than so much of a cell are moved away: no slivers at the grid's corners."""


_MAKERS = tuple(
    Path(module).with_name(f"{name}.py")
    for module, name in ((__file__, "enclosing"), (__file__, "nested_hull"), (topology.__file__, "topology"))
)


@dataclass(frozen=True, eq=False)
class Cage:
    """A cage around a shape.

    Parameters
    ----------
    vertices : ndarray, shape (k, 3)
    faces : ndarray of int, shape (m, 3)
        Closed, counter-clockwise seen from outside.
    margin : float
        No point of the shape is nearer to the cage than this.
    components : int
        Of how many closed surfaces it consists.
    """

    vertices: Array
    faces: Index
    margin: float
    components: int


def cage(points: ArrayLike, F: ArrayLike | None = None, faces: int = FACES, margin: float = MARGIN) -> Cage:
    """Return a coarse closed cage that encloses all points.

    Book: 7.2, Figure 7.5

    Parameters
    ----------
    points : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3), optional
        The triangles of a mesh, which are enclosed as well; any: with boundaries, in parts, degenerate ones.
    faces : int
        How many faces the cage has at most, 12 or more; some more if it has parts and handles to keep.
    margin : float
        How far it keeps from the points, as a part of the diagonal of their bounding box; above 0.

    Returns
    -------
    cage : Cage

    Raises
    ------
    ValueError
        If there are no points or they all coincide, a number is not finite or out of range, or F names a
        vertex that there is not.
    """
    where = "enclosing.cage"
    x, f = _arguments(where, points, F, faces, margin)
    low, high = x.min(axis=0), x.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    if not diagonal > 0.0:
        topology.fail(where, "points", "different from each other", f"{len(x)} at one place")
    # In units of the diagonal, about the middle.
    x = (x - 0.5 * (low + high)) / diagonal
    cell = min(1.0 / (_CELLS * np.sqrt(max(faces, 40) / 120.0)), 1.5 * margin + 0.02)
    samples = _samples(x, f, 0.5 * cell)
    V, G = _offset(samples, margin, cell)
    V, G = nested_hull.coarsen(V, G, faces)
    number, _ = topology.components(len(G), topology.edges(where, G).inner)
    _enclosed(where, V, G, x, margin)
    return Cage(V * diagonal + 0.5 * (low + high), G, margin * diagonal, number)


def kept(points: ArrayLike, F: ArrayLike | None = None, faces: int = FACES, margin: float = MARGIN) -> Cage:
    """Return the cage of `cage`, kept in the cache folder: it takes seconds, and a user moves it many times.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3), optional
    faces : int
    margin : float

    Returns
    -------
    cage : Cage
        Its arrays are not writable.

    Raises
    ------
    ValueError
        As `cage`.
    """
    x, f = _arguments("enclosing.cage", points, F, faces, margin)
    digest = hashlib.sha256(np.ascontiguousarray(x).tobytes())
    digest.update(np.ascontiguousarray(f, np.int64).tobytes())

    def make() -> _kept.Arrays:
        made = cage(x, f, faces, margin)
        return {"V": made.vertices, "F": made.faces, "rest": np.array([made.margin, made.components])}

    name = f"{digest.hexdigest()[:24]}-{faces}-{float(margin)!r}"
    arrays = _kept.kept(name, make, "cages", _MAKERS)
    keep, number = arrays["rest"].tolist()
    return Cage(arrays["V"], arrays["F"], keep, int(number))


def _arguments(
    where: str, points: ArrayLike, F: ArrayLike | None, faces: int, margin: float
) -> tuple[Array, Index]:
    x = topology.vertices(where, "points", points, 3)
    if not len(x):
        topology.fail(where, "points", "an array of shape (n, 3), n > 0", "none")
    if not isinstance(faces, int | np.integer) or faces < 12:
        topology.fail(where, "faces", "a whole number of 12 or more", f"{faces}")
    if not (np.ndim(margin) == 0 and np.isfinite(margin) and 1e-3 <= margin <= 1.0):
        topology.fail(where, "margin", "a part of the diagonal from 0.001 to 1", f"{margin}")
    f = np.zeros((0, 3), np.intp) if F is None else np.asarray(F)
    if f.size == 0:
        return x, np.zeros((0, 3), np.intp)
    if f.ndim != 2 or f.shape[1] != 3 or f.dtype.kind not in "iu":
        topology.fail(where, "F", "whole numbers of shape (m, 3)", f"{f.dtype} of shape {f.shape}")
    if f.min() < 0 or f.max() >= len(x):
        topology.fail(where, "F", f"indices of the {len(x)} points, from 0", f"{f.min()} to {f.max()}")
    return x, f.astype(np.intp)


def _samples(x: Array, F: Index, spacing: float) -> Array:
    """Return the points, and others on large triangles, nowhere farther apart than the spacing."""
    P = x[F]
    longest = np.sqrt(np.max(np.sum((P - P[:, [1, 2, 0]]) ** 2, axis=-1), axis=-1, initial=0.0))
    parts = np.ceil(longest / spacing).astype(int)
    found = [x]
    for n in np.unique(parts[parts > 1]).tolist():
        i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
        share = np.stack([i, j, n - i - j], axis=-1)[i + j <= n] / n
        found.append((share @ P[parts == n]).reshape(-1, 3))
    return np.concatenate(found)


def _offset(samples: Array, margin: float, cell: float) -> tuple[Array, Index]:
    """Return a closed surface that keeps the margin from the samples, of triangles as large as the cells."""
    from scipy.spatial import KDTree

    tree = KDTree(samples)
    reach = margin + 0.5 * cell
    while True:
        V, F = _level(tree, samples, reach, cell)
        # The distance from the samples changes along a face by no more than one goes along it.
        middles, step = _middles(V, F, 4)
        near = tree.query(middles, distance_upper_bound=margin + 2.0 * step)[0]
        if float(np.min(near)) - step > margin:
            return V, F
        reach += 0.25 * cell


def _level(tree, samples: Array, reach: float, cell: float) -> tuple[Array, Index]:
    """Return the outer surface of all that is within a distance of the samples."""
    from scipy import ndimage
    from skimage.measure import marching_cubes

    low = samples.min(axis=0) - reach - 2.0 * cell
    count = np.ceil((samples.max(axis=0) + reach + 2.0 * cell - low) / cell).astype(int) + 1
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in count), indexing="ij"), axis=-1)
    # The level passes no cube of which a corner is farther than its diagonal; how far is of no account.
    far = reach + 2.0 * cell
    distance = tree.query(low + cell * grid.reshape(-1, 3), distance_upper_bound=far)[0]
    value = np.minimum(distance, far).reshape(count) - reach
    parts = np.zeros(value.shape, np.int32)
    ndimage.label(value > 0.0, output=parts)
    hollow = (value > 0.0) & (parts != parts[0, 0, 0])
    value = np.where(hollow, -cell, np.copysign(np.maximum(np.abs(value), _CLEAR * cell), value))
    V, F, _, _ = marching_cubes(value, 0.0, gradient_direction="ascent")
    V, F = V.astype(float), F.astype(np.intp)
    middle = V.mean(axis=0)
    solid = np.linalg.det(V[F] - middle).sum()
    return low + cell * V, F if solid > 0.0 else F[:, ::-1]


def _middles(V: Array, F: Index, n: int) -> tuple[Array, float]:
    """Return points spread over the faces, and how far any point of a face is from the next at most."""
    P = V[F]
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    share = np.stack([i, j, n - i - j], axis=-1)[i + j <= n] / n
    longest = np.sqrt(np.max(np.sum((P - P[:, [1, 2, 0]]) ** 2, axis=-1)))
    return (share @ P).reshape(-1, 3), float(longest / n / np.sqrt(3.0))


def _enclosed(where: str, V: Array, F: Index, x: Array, margin: float) -> None:
    """Make sure of what is promised: it follows from the construction, were it not for rounding."""
    V, F = cage_checks.closed(where, V, F)
    cage = cage_view.facets(V, F)
    for part, seen in cage_view.chunks(cage, x):
        near = cage_view.nearest(cage, seen, 0.999 * margin)
        bad = np.abs(cage_view.solid_angles(cage, seen).sum(axis=1) - 4.0 * np.pi) > 1e-3
        bad[near.row] = True
        if bad.any():
            k = part.start + int(np.argmax(bad))
            remedy = "Give another margin or number of faces."
            topology.fail(
                where, "points", "enclosed by the cage that was found", f"point {k} outside", remedy
            )
