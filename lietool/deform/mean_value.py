"""Mean value coordinates of a closed triangle mesh (Ju, Schaefer and Warren 2005).

The weight of a cage vertex is w_i = int lambda_i(y) / |y - x| over the sphere of directions, y the point of
the cage seen there, lambda_i its hat function.  Over a face, d(direction) = h / r^3 dA, and the divergence
theorem gives, with the numbers of `cage_view` and q_e = theta_e / rho_e,

    w_i = (d_i J + h/2 sum_e (m_i . m_e) q_e) / H_i,     J = int h / r^4 dA = 1/(2h) sum_e d_e q_e.

It is the paper's sum, in another order: the paper divides by sines of angles that vanish together where the
point lies in the plane of the face or on the line of an edge, and drops the faces where they are small.  Here
J = T / 2h - h/2 sum_e sgn(d_e) q_e / (rho_e + |d_e|), T = sum_e sgn(d_e) theta_e; outside of the triangle
T is theta_a + theta_b - theta_c or its negative, which comes from the spherical triangle's half-angle formula
when it is small.  So the planes of faces and the lines of edges are nothing special.

The coordinates w_i / sum w are continuous on all of space, and smooth but for the cage itself; on it they are
its hat functions, exactly.  Outside they are defined too, where some are negative.  In a cage that is not
convex some are negative inside, and a limb that a part of the cage passes by is moved by that part: the
known weakness of these coordinates.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import cage_checks, cage_view
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_SMALL = 0.01
"""Below this the angle alpha_k is computed from the product of the sines, radians."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """Points bound to a cage.

    Parameters
    ----------
    coordinates : ndarray, shape (n, k)
        Of each point, one for each cage vertex; their sum is 1.
    faces : ndarray of int, shape (m, 3)
        Those of the cage.
    """

    coordinates: Array
    faces: Index


def coordinates(points: ArrayLike, V: ArrayLike, F: ArrayLike) -> Array:
    """Return the mean value coordinates of points in a cage.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Anywhere: on the cage its hat functions are the coordinates.
    V : array_like, shape (k, 3)
        The cage.
    F : array_like of int, shape (m, 3)
        Its faces, counter-clockwise seen from outside.

    Returns
    -------
    coordinates : (n, k)
        For every affine map A, the sum of coordinate times A v is A of the point.

    Raises
    ------
    ValueError
        If the cage is not a closed surface oriented outwards, or a number is not finite.
    """
    return prepare(points, V, F).coordinates


def prepare(points: ArrayLike, V: ArrayLike, F: ArrayLike) -> Prepared:
    """Bind points to a cage by mean value coordinates.

    Book: [Ju2005], 7.2

    Parameters
    ----------
    points : array_like, shape (n, 3)
    V : array_like, shape (k, 3)
    F : array_like of int, shape (m, 3)
        Counter-clockwise, seen from outside.

    Returns
    -------
    prepared : Prepared

    Raises
    ------
    ValueError
        If the cage is not a closed surface oriented outwards, or a number is not finite.
    """
    where = "mean_value.prepare"
    x = topology.vertices(where, "points", points, 3)
    V, F = cage_checks.closed(where, V, F)
    cage = cage_view.facets(V, F)
    result = np.empty((len(x), len(V)))
    for part, seen in cage_view.chunks(cage, x):
        w = cage_view.gather(cage, _weights(cage, seen))
        on = cage_view.nearest(cage, seen, cage_view.ON_SURFACE * cage.size)
        w[on.row] = 0.0
        w[on.row[:, None], F[on.face]] = on.share
        result[part] = w / w.sum(axis=1, keepdims=True)
    return Prepared(result, F)


def solve(prepared: Prepared, V: ArrayLike) -> Array:
    """Return the points, moved with the cage.

    Book: [Ju2005], 7.2

    Parameters
    ----------
    prepared : Prepared
    V : array_like, shape (k, 3)
        The cage as it is now.

    Returns
    -------
    points : (n, 3)

    Raises
    ------
    ValueError
        If V is not finite or has another number of vertices than the cage.
    """
    now = current("mean_value.solve", V, prepared.coordinates.shape[1])
    return prepared.coordinates @ now


def current(where: str, V: ArrayLike, count: int) -> Array:
    """Return the vertices of a moved cage, as many as there were.

    Raises
    ------
    ValueError
        If V is not finite or has another number of vertices than the cage.
    """
    now = topology.vertices(where, "V", V, 3)
    if len(now) != count:
        topology.fail(where, "V", f"the {count} vertices of the cage", f"{len(now)}")
    return now


def _weights(cage: cage_view.Facets, seen: cage_view.View) -> Array:
    """Return the integrals of the corners' hat functions over each face, (3, c, m)."""
    h, d = seen.h, seen.d
    q = seen.arc / seen.rho
    sign = np.where(d < 0.0, -1.0, 1.0)
    J = _excess(cage, seen, sign) - 0.5 * h * np.sum(sign * q / (seen.rho + np.abs(d)), axis=0)
    turn = np.einsum("iem,ecm->icm", cage.gram, q)
    return (d * J + 0.5 * h * turn) / cage.height[:, None]


def _excess(cage: cage_view.Facets, seen: cage_view.View, sign: Array) -> Array:
    """Return T / 2h, without cancellation where the point is outside the triangle and near its plane."""
    h, theta = seen.h, seen.arc
    flat = np.where(np.abs(h) < cage_view.TINY, cage_view.TINY, h)
    result = 0.5 * np.sum(sign * theta, axis=0) / flat
    half = 0.5 * np.sum(theta, axis=0)
    minus = np.sum(sign < 0.0, axis=0)
    for k in range(3):
        odd = (minus == 1) & (sign[k] < 0.0) | (minus == 2) & (sign[k] > 0.0)
        row, face = np.nonzero(odd & (np.abs(half - theta[k]) < _SMALL))
        place = (row, face)
        if len(row):
            result[place] = np.where(minus[place] == 1, 1.0, -1.0) * _thin(cage, seen, k, place)
    return result


def _thin(cage: cage_view.Facets, seen: cage_view.View, k: int, place: tuple[Index, Index]) -> Array:
    """Return alpha_k / h, alpha_k = (theta_i + theta_j - theta_k) / 2, where it is small.

    With s half the sum of the arcs and alpha_i = s - theta_i,
    sin s sin alpha_0 sin alpha_1 sin alpha_2 = (h A / (r0 r1 r2))^2.  Near the line of edge a, alpha_b and
    alpha_k are small together: their sum is theta_a, their difference theta_k - theta_b.
    """
    row, face = place
    every = np.arange(len(row))
    h, theta, r = seen.h[place], seen.arc[:, row, face], seen.radius[:, row, face]
    i, j = (k + 1) % 3, (k + 2) % 3
    a = np.where(theta[i] < theta[j], i, j)
    b = 3 - k - a
    d, rho, start = (part[a, row, face] for part in (seen.d, seen.rho, seen.start))
    # Along edge a: where it begins and ends, which corners these are, and the third corner's foot.
    forward = (a + 1) % 3 == b
    s_b = np.where(forward, start, seen.end[a, row, face])
    s_k = np.where(forward, seen.end[a, row, face], start)
    s_a = start + cage.foot[a, face]
    r_a, r_b, r_k = r[a, every], r[b, every], r[k]
    bend = rho * rho * (1.0 / (r_b * (r_b + np.abs(s_b))) - 1.0 / (r_k * (r_k + np.abs(s_k))))
    along = np.where(s_b * s_k > 0.0, np.sign(s_b) * bend, s_k / r_k - s_b / r_b)
    across = (rho * rho - d * cage.height[a, face]) * (r_b - r_k) / (r_b * r_k)
    mean = 0.5 * (theta[b, every] + theta[k])
    sine = (across + s_a * along) / (2.0 * r_a * np.sin(mean))
    apart = 2.0 * np.arcsin(np.clip(sine, -1.0, 1.0))
    near, far = 0.5 * (theta[a, every] - apart), 0.5 * (theta[a, every] + apart)
    product = np.sin(mean + 0.5 * theta[a, every]) * np.sin(mean - 0.5 * theta[a, every])
    g = (cage.area[face] / (r_a * r_b * r_k)) ** 2 / (product * np.sin(np.maximum(far, cage_view.TINY)))
    flat = np.where(np.abs(h) < cage_view.TINY, cage_view.TINY, h)
    alpha = np.where(far > near, np.arcsin(np.minimum(h * h * g, 1.0)), near)
    # In the plane itself the face has no solid angle, also on the line of an edge, where near is anything.
    return np.where(np.abs(h) < cage_view.TINY, 0.0, alpha / flat)
