"""From a linear map for each face to one mesh: the vertices whose faces come nearest to what their maps ask.

The maps A'_j of neighbouring faces disagree about their common edge, so that applied one by one they tear the
mesh apart.  Stitched are the vertices that minimise

    sum of area_j |(B_j - A'_j) P_j|^2,

B_j the map of the face as it comes out, P_j the projector onto its plane at rest: only that part of a map is
seen by the three corners.  The normal equations have the cotangent matrix, whatever the maps are, so it is
factored once.  What they leave open, a translation of each connected part, is fixed by the part's barycentre;
or by pinned vertices.

The same stitch serves every deformer that gives transformations to faces instead of vertices (MEIS 3).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import local_maps
from lietool.lie import checks
from lietool.mesh import laplacian, topology
from lietool.mesh import solve as solving

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Prepared:
    """What does not depend on the maps.

    Parameters
    ----------
    rest : ndarray, shape (n, 3)
    frames : Frames
        Of the faces at rest.
    pins : ndarray of int, shape (k,)
    component : ndarray of int, shape (n,)
        Which connected part a vertex belongs to; one that no face uses is a part by itself.
    floating : ndarray of bool, shape (c,)
        Parts without a pin: their barycentres are to be given.
    stiffness, gradient, right, mean : sparse array
        The cotangent matrix (n, n); the gradient (3 m, n); the matrix from maps to right sides (n, 3 m); that
        from vertices to barycentres (c, n).
    factor : Factor
    """

    rest: Array
    frames: local_maps.Frames
    pins: Index
    component: Index
    floating: Mask
    stiffness: Any
    gradient: Any
    right: Any
    mean: Any
    factor: solving.Factor

    @property
    def faces(self) -> Index:
        """The triangles; shape (m, 3)."""
        return self.frames.faces

    def barycentres(self, V: ArrayLike) -> Array:
        """Return the barycentre of each connected part of a mesh, its vertices weighted by areas at rest.

        Parameters
        ----------
        V : (n, 3)

        Returns
        -------
        barycentre : (c, 3)
        """
        return self.mean @ np.asarray(V, float)


@dataclass(frozen=True, eq=False)
class Stitched:
    """A stitched mesh, and how well it fits.

    Parameters
    ----------
    prepared : Prepared
    maps : ndarray, shape (m, 3, 3)
        What the faces were asked for.
    vertices : ndarray, shape (n, 3)
    """

    prepared: Prepared
    maps: Array
    vertices: Array

    @cached_property
    def errors(self) -> Array:
        """Each face's part of the energy; shape (m,)."""
        at = self.prepared.frames
        missing = np.stack(local_maps.tangents(at, self.vertices), axis=-1)
        missing -= self.maps @ np.swapaxes(at.axes[:, :2], -1, -2)
        return at.area * np.einsum("fij,fij->f", missing, missing)

    @property
    def energy(self) -> float:
        """The sum of area |(B - A') P|^2 over the faces."""
        return float(self.errors.sum())

    @cached_property
    def residual(self) -> float:
        """The largest error in an equation, relative to the norms of matrix, solution and right side."""
        at, free = self.prepared, self.prepared.factor.free
        centred = self.vertices - at.barycentres(self.vertices)[at.component]
        b = _right(at, self.maps)[free]
        rest = np.abs(b - (at.stiffness @ centred)[free])
        scale = at.factor.norm * np.max(np.abs(centred), initial=0.0) + np.max(np.abs(b), initial=0.0)
        return float(np.max(rest, initial=0.0) / max(scale, 1e-300))

    @cached_property
    def det(self) -> Array:
        """The determinants of the realised maps with their normals: growth in area to the power 3/2.

        Negative where the face has come out turned over against its map: its normal points away from where
        the map carries it.  Shape (m,).
        """
        at = self.prepared.frames
        one, two = local_maps.tangents(at, self.vertices)
        n = np.cross(one, two)
        asked = self.maps @ np.swapaxes(at.axes[:, :2], -1, -2)
        side = np.einsum("fi,fi->f", n, np.cross(asked[..., 0], asked[..., 1]))
        return np.copysign(np.linalg.norm(n, axis=1) ** 1.5, side)

    @property
    def flipped(self) -> Mask:
        """Which faces are turned over or have collapsed; shape (m,)."""
        return self.det <= 0.0

    @property
    def flips(self) -> int:
        """How many faces are."""
        return int(self.flipped.sum())


def prepare(V: ArrayLike, F: ArrayLike, pins: ArrayLike = ()) -> Prepared:
    """Prepare the stitching of a mesh.

    Kaji-Ochiai: 5.3
    MEIS: 3.3

    Parameters
    ----------
    V : array_like, shape (n, 3)
        At rest.
    F : array_like of int, shape (m, 3)
    pins : array_like of int, shape (k,), optional
        Vertices whose positions will be given.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If V or F is none, a face has no area, or a pin is no vertex or given twice.
    """
    where = "stitch.prepare"
    V, F = laplacian.checked(where, V, F)
    pins = topology.distinct(where, "pins", topology.vertex_set(where, "pins", pins, len(V)))
    count, component = topology.parts(F, len(V))
    floating = np.ones(count, bool)
    floating[component[pins]] = False
    anchors = np.unique(component, return_index=True)[1][floating]
    stiffness = laplacian.cotangent(V, F)
    factor = solving.factor(stiffness, np.concatenate([pins, anchors]))
    at = local_maps.frames(V, F)
    gradient = laplacian.gradient(V, F)
    right = -laplacian.divergence(V, F)
    mean = _mean(laplacian.mass(V, F), component, count)
    return Prepared(V, at, pins, component, floating, stiffness, gradient, right, mean, factor)


def solve(
    prepared: Prepared,
    maps: ArrayLike,
    barycentre: ArrayLike | None = None,
    positions: ArrayLike | None = None,
) -> Stitched:
    """Return the mesh whose faces come nearest to their maps.

    Kaji-Ochiai: 5.3
    MEIS: 3.3

    Parameters
    ----------
    prepared : Prepared
    maps : (m, 3, 3)
        A linear map for each face; what it does to the normal does not matter.
    barycentre : (c, 3), optional
        Where the connected parts come to lie, see `Prepared.barycentres`; as at rest unless given.  Of no
        meaning for parts with a pin.
    positions : (k, 3), optional
        Of the pins; as at rest unless given.

    Returns
    -------
    Stitched

    Raises
    ------
    ValueError
        If a shape does not fit, or a number is not finite.
    """
    where = "stitch.solve"
    A = checks.array(where, "maps", maps, (3, 3))
    if A.shape != (len(prepared.faces), 3, 3):
        must = f"one for each of the {len(prepared.faces)} faces"
        checks.fail(where, "maps", must, f"shape {A.shape}", None)
    centre = prepared.barycentres(prepared.rest) if barycentre is None else barycentre
    centre = _points(where, "barycentre", centre, len(prepared.floating))
    fixed = prepared.rest[prepared.pins] if positions is None else positions
    fixed = _points(where, "positions", fixed, len(prepared.pins))
    # Anchors lie in the origin until their part is moved to its barycentre.
    values = np.zeros((len(prepared.factor.fixed), 3))
    values[: len(fixed)] = fixed
    x = prepared.factor.solve(_right(prepared, A), values)
    shift = np.where(prepared.floating[:, None], centre - prepared.mean @ x, 0.0)
    return Stitched(prepared, A, x + shift[prepared.component])


def deform(prepared: Prepared, A: ArrayLike, positions: ArrayLike | None = None) -> Stitched:
    """Return the mesh from an affine transformation for each face, of a probe or a cage at its centre.

    The barycentre of each part is the mean of those of its faces, each moved by its transformation.  Vertices
    without a face stay.

    MEIS: (5), by simplices

    Parameters
    ----------
    prepared : Prepared
    A : (m, 4, 4), affine
    positions : (k, 3), optional
        Of the pins; as at rest unless given.

    Returns
    -------
    Stitched

    Raises
    ------
    ValueError
        If a shape does not fit, or a number is not finite.
    """
    where = "stitch.deform"
    A = checks.array(where, "A", A, (4, 4))
    if A.shape != (len(prepared.faces), 4, 4):
        checks.fail(where, "A", f"one for each of the {len(prepared.faces)} faces", f"shape {A.shape}", None)
    moved = (A[:, :3, :3] @ centres(prepared)[..., None])[..., 0] + A[:, :3, 3]
    part, area = prepared.component[prepared.faces[:, 0]], prepared.frames.area
    count = len(prepared.floating)
    whole = np.bincount(part, area, count)
    sums = np.stack([np.bincount(part, area * moved[:, k], count) for k in range(3)], axis=1)
    used = whole > 0.0
    centre = prepared.barycentres(prepared.rest)
    centre[used] = sums[used] / whole[used, None]
    return solve(prepared, A[:, :3, :3], centre, positions)


def centres(prepared: Prepared) -> Array:
    """Return the centroids of the faces at rest: where transformations for `deform` are to be taken.

    Parameters
    ----------
    prepared : Prepared

    Returns
    -------
    c : (m, 3)
    """
    return prepared.rest[prepared.faces].mean(axis=1)


def _right(prepared: Prepared, A: Array) -> Array:
    """The right sides (n, 3): coordinate a of the field in face f is the row a of its map."""
    return prepared.right @ np.swapaxes(A, -1, -2).reshape(-1, 3)


def _mean(mass: Array, component: Index, count: int) -> Any:
    from scipy.sparse import csr_array

    whole = np.bincount(component, mass, count)
    # A part without a face is a vertex by itself, and its own barycentre.
    mine = whole[component]
    share = np.where(mine > 0.0, mass / np.where(mine > 0.0, mine, 1.0), 1.0)
    return csr_array((share, (component, np.arange(len(mass)))), (count, len(mass)))


def _points(where: str, name: str, x: ArrayLike, count: int) -> Array:
    p = checks.array(where, name, x, (3,))
    if p.shape != (count, 3):
        checks.fail(where, name, f"an array of shape ({count}, 3)", f"shape {p.shape}", None)
    return p
