"""How much a deformation of a triangle mesh stretches, shears and turns over its faces.

Each face has a map from its rest to its deformed place, completed by the normals: n/sqrt|n|, n the cross
product of two edges, goes to its counterpart.  Its singular values are those of the triangle, s1 >= s2, and
sqrt(s1 s2) between them, so a similarity has three equal ones and the normal never decides the largest
or the smallest.

A face of a surface in space has no sign: seen by itself, a triangle that is turned over is a triangle that
has been rotated by a half turn.  So "flipped" needs something to compare with, and there are two answers:

    against     a transformation G_f that the face should have had, such as the guidance of Poisson editing:
                flipped where the deformed normal points away from G_f e1 x G_f e2
    by_neighbours   what the faces across its edges say: flipped where the deformed normal points away from
                the rest normal as the neighbours' rotations, in their mean, carry it

The second asks for nothing but the two meshes.  It finds single faces and narrow folds; inside a wide patch
that is turned over as a whole the faces agree with each other, and only the patch's rim is seen: by `folds`,
the edges across which the normals come to be more than a right angle apart from where they were.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import adjacency, local_maps
from lietool.lie import checks, polar
from lietool.mesh import laplacian, topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

COLLAPSED = 1e-12
"""A face is collapsed where its smaller singular value is at most so much of its larger one."""


@dataclass(frozen=True, eq=False)
class Distortion:
    """The singular values of all faces, and what follows from them.

    Parameters
    ----------
    weights : ndarray, shape (m,)
        The areas at rest, by which summaries weigh.
    largest, smallest : ndarray, shape (m,)
        The singular values s1 >= s2 of the faces' maps.
    """

    weights: Array
    largest: Array
    smallest: Array

    @property
    def inverse(self) -> Array:
        """1 / s2: how much a face is squeezed; infinite where it has collapsed to a line."""
        with np.errstate(divide="ignore"):
            return 1.0 / self.smallest

    @property
    def area(self) -> Array:
        """s1 s2: by which factor the area grows."""
        return self.largest * self.smallest

    @property
    def angle(self) -> Array:
        """s1 / s2 >= 1: how far from conformal; infinite where collapsed, also to a point."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = self.largest / self.smallest
        return np.where(self.smallest > 0.0, ratio, np.inf)

    @property
    def worst(self) -> Array:
        """The larger of s1 and 1 / s2: 1 where nothing is stretched or squeezed."""
        return np.maximum(self.largest, self.inverse)

    @property
    def collapsed(self) -> Mask:
        """Which faces have lost their area."""
        return self.smallest <= COLLAPSED * self.largest

    def summary(self) -> dict[str, "Summary"]:
        """Return the statistics of `largest`, `inverse`, `area`, `angle` and `worst`."""
        names = ("largest", "inverse", "area", "angle", "worst")
        return {name: summarise(getattr(self, name), self.weights) for name in names}


@dataclass(frozen=True)
class Summary:
    """A quantity over all faces, weighted by their areas at rest.

    Parameters
    ----------
    least, median, mean, most_of, most : float
        The minimum, the weighted median and mean, the weighted 95th percentile, the maximum.
    """

    least: float
    median: float
    mean: float
    most_of: float
    most: float


def measure(rest: ArrayLike, F: ArrayLike, deformed: ArrayLike) -> Distortion:
    """Return the singular values of the maps from each face at rest, with its normal, to the same deformed.

    Book: 7.3, table 7.1

    Parameters
    ----------
    rest : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    deformed : array_like, shape (n, 3)

    Returns
    -------
    Distortion

    Raises
    ------
    ValueError
        If the shapes do not fit together, are not finite, or a face at rest has no area.
    """
    V, F, U = _pair("distortion.measure", rest, F, deformed)
    at = local_maps.frames(V, F)
    one, two = local_maps.tangents(at, U)
    E, G, cross = _dot(one, one), _dot(two, two), _dot(one, two)
    largest = np.sqrt(0.5 * (E + G) + np.hypot(0.5 * (E - G), cross))
    # By the area, not by the difference of two squares: that would lose half of the digits of a thin face.
    small = _length(np.cross(one, two)) / np.where(largest > 0.0, largest, 1.0)
    return Distortion(at.area, largest, np.minimum(small, largest))


def summarise(values: ArrayLike, weights: ArrayLike) -> Summary:
    """Return the weighted statistics of a quantity.

    Parameters
    ----------
    values : array_like, shape (m,)
        May be infinite; then so are the mean and the maximum.
    weights : array_like, shape (m,)
        Not negative, and not all 0.

    Returns
    -------
    Summary

    Raises
    ------
    ValueError
        If the shapes differ, a value is nan, or the weights are negative or all 0.
    """
    where = "distortion.summarise"
    x = checks.array(where, "values", values, (), check=False)
    w = checks.array(where, "weights", weights, (), check=False)
    if x.ndim != 1 or not len(x) or x.shape != w.shape:
        topology.fail(where, "values and weights", "two arrays of one shape (m,)", f"{x.shape} and {w.shape}")
    if np.isnan(x).any():
        topology.fail(where, "values", "numbers", f"nan at index {int(np.argmax(np.isnan(x)))}")
    if not (np.isfinite(w).all() and w.min() >= 0.0 and w.max() > 0.0):
        topology.fail(where, "weights", "finite, not negative and not all 0", f"a sum of {w.sum():.3g}")
    used = w > 0.0
    x, w = x[used], w[used] / w[used].sum()
    order = np.argsort(x, kind="stable")
    share = np.cumsum(w[order])
    half, most_of = (
        float(x[order][min(int(np.searchsorted(share, part * share[-1])), len(x) - 1)])
        for part in (0.5, 0.95)
    )
    return Summary(float(x.min()), half, float(w @ x), most_of, float(x.max()))


def flipped_against(rest: ArrayLike, F: ArrayLike, deformed: ArrayLike, guide: ArrayLike) -> Mask:
    """Return which faces are turned over against the transformations that they should have had.

    Parameters
    ----------
    rest : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    deformed : array_like, shape (n, 3)
    guide : array_like, shape (m, 3, 3)
        For each face a linear map G; it carries the normal e1 x e2 to G e1 x G e2.

    Returns
    -------
    flipped : (m,)

    Raises
    ------
    ValueError
        If the shapes do not fit together or are not finite.
    """
    where = "distortion.flipped_against"
    V, F, U = _pair(where, rest, F, deformed)
    G = checks.array(where, "guide", guide, (3, 3), check=False)
    if G.shape != (len(F), 3, 3) or not np.isfinite(G).all():
        topology.fail(where, "guide", f"finite, of shape ({len(F)}, 3, 3)", f"shape {G.shape} or nan")
    one, two = (np.einsum("mij,mj->mi", G, V[F[:, k]] - V[F[:, 0]]) for k in (1, 2))
    return _dot(np.cross(one, two), topology.area_normals(U, F)) < 0.0


def flipped_by_neighbours(rest: ArrayLike, F: ArrayLike, deformed: ArrayLike) -> Mask:
    """Return which faces are turned over against the mean of what the faces across their edges did.

    Parameters
    ----------
    rest : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    deformed : array_like, shape (n, 3)

    Returns
    -------
    flipped : (m,)
        Without neighbours, false.

    Raises
    ------
    ValueError
        If the shapes do not fit together, are not finite, or a face at rest has no area.
    """
    V, F, U = _pair("distortion.flipped_by_neighbours", rest, F, deformed)
    R, n, after = _turned(V, F, U)
    pairs = adjacency.face_pairs(F)
    vote = np.zeros(len(F))
    for mine, other in (pairs.T, pairs[:, ::-1].T):
        np.add.at(vote, mine, _dot(np.einsum("mij,mj->mi", R[other], n[mine]), after[mine]))
    return vote < 0.0


def folds(rest: ArrayLike, F: ArrayLike, deformed: ArrayLike) -> Index:
    """Return the pairs of neighbouring faces of which each is turned over against what the other did.

    Parameters
    ----------
    rest : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    deformed : array_like, shape (n, 3)

    Returns
    -------
    pairs : (k, 2)
        The normals have come to be more than a right angle from where the other's rotation takes them.

    Raises
    ------
    ValueError
        If the shapes do not fit together, are not finite, or a face at rest has no area.
    """
    V, F, U = _pair("distortion.folds", rest, F, deformed)
    R, n, after = _turned(V, F, U)
    pairs = adjacency.face_pairs(F)
    a, b = pairs.T
    here = _dot(np.einsum("mij,mj->mi", R[b], n[a]), after[a])
    there = _dot(np.einsum("mij,mj->mi", R[a], n[b]), after[b])
    return pairs[(here < 0.0) & (there < 0.0)]


def _pair(where: str, rest: ArrayLike, F: ArrayLike, deformed: ArrayLike) -> tuple[Array, Index, Array]:
    V, F = laplacian.checked(where, topology.vertices(where, "rest", rest, 3), F)
    U = topology.vertices(where, "deformed", deformed, 3)
    if len(U) != len(V):
        topology.fail(where, "deformed", f"{len(V)} vertices, as many as at rest", f"{len(U)}")
    return V, F, U


def _turned(V: Array, F: Index, U: Array) -> tuple[Array, Array, Array]:
    """The rotations of the faces, and their normals at rest and deformed."""
    at = local_maps.frames(V, F)
    one, two = local_maps.tangents(at, U)
    n = np.cross(one, two)
    # How long the normal is does not matter to the rotation, and a face without area has none.
    return polar.rotation(np.stack([one, two, n], axis=-1) @ at.axes, check=False), at.normal, n


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ij,ij->i", a, b)


def _length(a: Array) -> Array:
    return np.sqrt(_dot(a, a))
