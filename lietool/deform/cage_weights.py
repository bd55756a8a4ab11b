"""How much each element of a cage counts at a point: by distance, and only on the inner side of its faces.

    w_i(v) = influence(|v - c_i|) * ramp(depth / width), normalised

depth is how far v lies behind the plane of the element's face, width a part of r = 3 volume / area of the
cage.  The texts set w_i = 0 in the outer half space; cut off barely, weights jump where v crosses the plane
of a face, which happens inside of every cage that is not convex, and tears the shape there.  The ramp is 0
at depth 0 and before, 1 at the width and beyond, and in between the polynomial of degree 5 with two
continuous derivatives.  An element with two faces, an edge, takes the mean of their ramps.

The sum cannot vanish for want of faces.  Over a closed cage the sum of area times depth is 3 times the volume
wherever v is, even outside, so some face has depth r or more, and its ramp is 1.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import weights as weights_of
from lietool.deform.cage_frames import Elements, centres
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Function = Callable[[Array], Array]

POWER = 3.0
"""Of the inverse distance: above 2, lest far faces, which are many, prevail; mean values have it too."""

RAMP = 0.5
"""The width of the ramp, as a part of the cage's 3 volume / area: a third of a round limb's thickness."""

_PAIRS = 400_000
"""Points times elements at once."""


def inverse_cube(distances: Array) -> Array:
    """Return 1 / r^3, the influence unless another is given.

    Parameters
    ----------
    distances : ndarray, shape (n, p)

    Returns
    -------
    w : (n, p)

    Raises
    ------
    ValueError
        As `weights.inverse_distance`.
    """
    return weights_of.inverse_distance(distances, POWER)


def weights(
    points: ArrayLike,
    V: ArrayLike,
    elements: Elements,
    influence: Function = inverse_cube,
    ramp: float = RAMP,
    normalise: Function = weights_of.partition_of_unity,
    measure: ArrayLike | None = None,
) -> Array:
    """Return the weights of the elements of a cage at points.

    Book: 7.2
    MEIS: 3.2

    Parameters
    ----------
    points : array_like, shape (n, 3)
    V : array_like, shape (k, 3)
        The cage at rest, closed and oriented outwards.
    elements : Elements
        Of `cage_frames`.
    influence : callable
        From distances (c, p) to weights (c, p), none negative: those of `weights`, with their parameters.
    ramp : float
        The width of the ramp, times 3 volume / area of the cage; up to 1 some face always counts fully.
    normalise : callable
        Of `weights`: the partition of unity; `capped` leaves the identity what the sum lacks of 1.
    measure : array_like, shape (p,), optional
        By which the elements count: `measures` for their parts of the area, so that it matters less how
        finely a part of the cage is divided.  Unless given, 1 for each face, edge and vertex.

    Returns
    -------
    weights : (n, p)

    Raises
    ------
    ValueError
        If a number is not finite, the ramp or a measure not above 0, the influence is no weights, or no
        element counts at a point that is to have weights of sum 1.
    """
    where = "cage_weights.weights"
    x, V = topology.vertices(where, "points", points, 3), topology.vertices(where, "V", V, 3)
    if not (np.ndim(ramp) == 0 and np.isfinite(ramp) and ramp > 0.0):
        topology.fail(where, "ramp", "a number above 0", f"{ramp}")
    share = _measure(where, elements, V, measure)
    normal, offset, width = _planes(V, elements.faces)
    centre = centres(elements, V)
    result = np.empty((len(x), elements.count))
    step = max(1, _PAIRS // elements.count)
    for begin in range(0, len(x), step):
        part = slice(begin, begin + step)
        rise = smooth((offset - x[part] @ normal.T) / (ramp * width))
        w = np.asarray(influence(weights_of.distances(x[part], centre)), float)
        _influence(where, w, (len(x[part]), elements.count), begin)
        w = w * rise[:, elements.around].mean(axis=-1) * share
        if normalise is weights_of.partition_of_unity:
            _positive(where, w, begin)
        result[part] = normalise(w)
    return result


def smooth(t: ArrayLike) -> Array:
    """Return the ramp: 0 up to 0, 1 from 1 on, and 10 t^3 - 15 t^4 + 6 t^5 between.

    Parameters
    ----------
    t : array_like

    Returns
    -------
    rise : array
        Of the same shape.
    """
    t = np.clip(np.asarray(t, float), 0.0, 1.0)
    return t * t * t * (10.0 + t * (6.0 * t - 15.0))


def measures(elements: Elements, V: ArrayLike) -> Array:
    """Return the part of a cage's area that belongs to each element, as fractions of sum 1.

    A face has its own, an edge a third of each of its faces, a corner a third of its face.

    Parameters
    ----------
    elements : Elements
    V : array_like, shape (k, 3)

    Returns
    -------
    measure : (p,)
    """
    V = topology.vertices("cage_weights.measures", "V", V, 3)
    area = np.linalg.norm(topology.area_normals(V, elements.faces), axis=-1)
    part = area[elements.around].sum(axis=1)
    return part / part.sum()


def _measure(where: str, elements: Elements, V: Array, measure: ArrayLike | None) -> Array:
    if measure is None:
        if elements.points.shape[1] > 1:
            return np.ones(elements.count)
        # The corners of a vertex share it by their angles, lest a vertex count for more by having more faces.
        P = V[elements.ends]
        a, b = P[:, 1] - P[:, 0], P[:, 2] - P[:, 0]
        angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
        return angle / np.bincount(elements.ends[:, 0], angle)[elements.ends[:, 0]]
    given = np.asarray(measure, float)
    if given.shape != (elements.count,) or not (np.isfinite(given) & (given > 0.0)).all():
        topology.fail(where, "measure", f"{elements.count} finite numbers above 0", f"shape {given.shape}")
    return given


def _planes(V: Array, F: Index) -> tuple[Array, Array, float]:
    """Return unit normals (m, 3) and offsets (m,) of the faces' planes, and 3 volume / area."""
    normal, corner = topology.area_normals(V, F), V[F[:, 0]]
    size = np.linalg.norm(normal, axis=-1)
    middle = V.mean(axis=0)
    solid = np.sum(normal * (corner - middle)) / 2.0
    area = size.sum() / 2.0
    if not (size.min() > 0.0 and solid > 0.0):
        must = "a closed cage, oriented outwards, with an area in every face"
        topology.fail("cage_weights.weights", "V", must, f"volume {solid / 3.0:.3g}, area {size.min():.3g}")
    normal = normal / size[:, None]
    return normal, np.sum(normal * corner, axis=-1), float(solid / area)


def _influence(where: str, w: Array, shape: tuple[int, int], begin: int) -> None:
    if w.shape != shape:
        topology.fail(where, "influence", f"a function that gives shape {shape}", f"shape {w.shape}")
    bad = ~(np.isfinite(w) & (w >= 0.0)).all(axis=1)
    if bad.any():
        got = f"other at point {begin + int(np.argmax(bad))}"
        topology.fail(where, "influence", "finite and not negative", got)


def _positive(where: str, w: Array, begin: int) -> None:
    none = ~(w > 0.0).any(axis=1)
    if none.any():
        k = int(np.argmax(none))
        got = f"0 for all elements at point {begin + k}"
        remedy = "Let it reach farther, or leave the rest to the identity: normalise=weights.capped."
        must = "above 0 for some element on whose inner side a point is"
        topology.fail(where, "influence", must, got, remedy)
