"""Weights from a point in the plane: the corners of a polygon stand for shapes, the point for a mixture.

The weights are the mean value coordinates of the point (Floater 2003; Hormann and Floater 2006 for any simple
polygon, and for points outside).  They sum to 1, they reproduce the point, sum w_i c_i = p, they are 1, 0, 0
... at a corner and linear along an edge; inside a convex polygon they are positive.  Outside the polygon some
are negative and the shapes are extrapolated.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks

Array = NDArray[np.float64]

_ON = 1e-14
"""Relative to the polygon: nearer to an edge or corner a point is on it."""


@dataclass(frozen=True, eq=False)
class Controller:
    """A polygon whose corners stand for shapes; made by `controller`.

    Parameters
    ----------
    corners : ndarray, shape (k, 2)
    rest : int or None
        The corner that stands for the shape at rest; the others are the targets, in their order.
    """

    corners: Array
    rest: int | None

    @property
    def targets(self) -> int:
        """How many targets there are."""
        return len(self.corners) - (self.rest is not None)

    def weights(self, position: ArrayLike) -> Array:
        """Return the weights of the targets for a position.

        Parameters
        ----------
        position : (..., 2)

        Returns
        -------
        w : (..., targets)
            With a corner for the rest, they lack of 1 what is the rest's.
        """
        w = coordinates(self.corners, position)
        return w if self.rest is None else np.delete(w, self.rest, axis=-1)

    def position(self, weights: ArrayLike) -> Array:
        """Return the point of the polygon's plane that weights belong to, sum w_i c_i.

        It undoes `weights`: a position's weights lead back to it.  The converse holds only for a triangle:
        with more corners many weights have one position, of which `weights` gives one choice.

        Parameters
        ----------
        weights : (..., targets)
            Of any sum; a corner for the rest takes what they lack of 1, without one it must be 1.

        Returns
        -------
        position : (..., 2)

        Raises
        ------
        ValueError
            If a weight is not finite, or they do not sum to 1 and there is no rest.
        """
        where = "controller.position"
        w = checks.array(where, "weights", weights, (self.targets,))
        missing = 1.0 - w.sum(axis=-1)
        if self.rest is not None:
            w = np.insert(w, self.rest, missing, axis=-1)
        elif (bad := np.abs(np.asarray(missing)) > checks.TOLERANCE).any():
            index = checks.first(bad)
            checks.fail(where, "weights", "of sum 1", f"{1.0 - np.asarray(missing)[index]:.6g}", index)
        return w @ self.corners


def controller(corners: ArrayLike, rest: int | None = None) -> Controller:
    """Return a controller.

    MEIS: 3.3, figure 4

    Parameters
    ----------
    corners : (k, 2)
        Of a simple polygon, either way round: `regular` makes one.
    rest : int, optional
        The corner that stands for the shape at rest.

    Returns
    -------
    Controller

    Raises
    ------
    ValueError
        If the polygon has fewer than three corners, crosses or touches itself, or there is no such corner.
    """
    c = _polygon("controller.controller", corners)
    if rest is not None and not (isinstance(rest, int | np.integer) and 0 <= rest < len(c)):
        checks.fail("controller.controller", "rest", f"a corner, 0 to {len(c) - 1}", f"{rest}", None)
    return Controller(c, rest)


def regular(k: int, radius: float = 1.0) -> Array:
    """Return the corners of a regular polygon, the first at the top, counter-clockwise.

    Parameters
    ----------
    k : int
        At least 3.
    radius : float

    Returns
    -------
    corners : (k, 2)

    Raises
    ------
    ValueError
        If k is below 3 or the radius is not positive and finite.
    """
    if not isinstance(k, int | np.integer) or k < 3:
        checks.fail(
            "controller.regular",
            "k",
            "a whole number, at least 3",
            f"{k}",
            None,
            "Add a corner for the rest.",
        )
    if not 0.0 < radius < np.inf:
        checks.fail("controller.regular", "radius", "positive and finite", f"{radius}", None)
    angle = 0.5 * np.pi + 2.0 * np.pi * np.arange(k) / k
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def coordinates(corners: ArrayLike, position: ArrayLike) -> Array:
    """Return the mean value coordinates of points with respect to a polygon.

    Floater (2003), Hormann and Floater (2006)

    Parameters
    ----------
    corners : (k, 2)
        Of a simple polygon.
    position : (..., 2)
        Anywhere in the plane.

    Returns
    -------
    w : (..., k)
        Of sum 1.

    Raises
    ------
    ValueError
        If the polygon is none, or a position is not finite.
    """
    where = "controller.coordinates"
    c = _polygon(where, corners)
    p = checks.array(where, "position", position, (2,))
    scale = float(np.max(np.abs(c - c.mean(axis=0))))
    s = (c - p[..., None, :]) / scale
    r = np.hypot(s[..., 0], s[..., 1])
    after, r_after = np.roll(s, -1, axis=-2), np.roll(r, -1, axis=-1)
    double = s[..., 0] * after[..., 1] - s[..., 1] * after[..., 0]
    inner = s[..., 0] * after[..., 0] + s[..., 1] * after[..., 1]
    # tan of half the angle at p, by the quotient of the two that does not cancel.
    sharp = inner >= 0.0
    on = ~sharp & (np.abs(double) <= _ON) | (r * r_after <= _ON * _ON)
    below = np.where(sharp, r * r_after + inner, np.where(on, 1.0, double))
    tangent = np.where(sharp, double, r * r_after - inner) / np.where(below == 0.0, 1.0, below)
    w = (np.roll(tangent, 1, axis=-1) + tangent) / np.where(r > 0.0, r, 1.0)
    edge = on.any(axis=-1)
    if edge.any():
        w[edge] = _on_edge(on[edge], r[edge], r_after[edge])
    return w / w.sum(axis=-1, keepdims=True)


def _on_edge(on: NDArray[np.bool_], r: Array, r_after: Array) -> Array:
    """Linear along the edge that the point is on."""
    k = np.argmax(on, axis=-1)
    row = np.arange(len(k))
    w = np.zeros(r.shape)
    w[row, k], w[row, (k + 1) % r.shape[-1]] = r_after[row, k], r[row, k]
    return w


def _polygon(where: str, corners: ArrayLike) -> Array:
    c = checks.array(where, "corners", corners, (2,))
    if c.ndim != 2 or len(c) < 3:
        must = "three corners or more, of shape (k, 2)"
        checks.fail(where, "corners", must, f"shape {c.shape}", None, "Add a corner for the rest.")
    d = np.roll(c, -1, axis=0)
    i, j = np.triu_indices(len(c), 1)
    apart = (j - i > 1) & (j - i < len(c) - 1)
    i, j = i[apart], j[apart]
    meet = (_side(c[i], d[i], c[j]) * _side(c[i], d[i], d[j]) <= 0) & (
        _side(c[j], d[j], c[i]) * _side(c[j], d[j], d[i]) <= 0
    )
    # Four corners on one line have no sides; then the boxes decide.
    meet &= np.all(np.maximum(c[i], d[i]) >= np.minimum(c[j], d[j]), axis=1)
    meet &= np.all(np.maximum(c[j], d[j]) >= np.minimum(c[i], d[i]), axis=1)
    if meet.any():
        k = int(np.argmax(meet))
        got = f"edges {int(i[k])} and {int(j[k])} that meet"
        checks.fail(where, "corners", "of a polygon that does not cross itself", got, None)
    before = np.roll(c, 1, axis=0)
    back = (_side(before, c, d) == 0) & (np.einsum("ki,ki->k", c - before, d - c) <= 0.0)
    if back.any():
        index = checks.first(back)
        checks.fail(where, "corners", "different, and no edge back along another", f"{c[index]}", index)
    return c


def _side(a: Array, b: Array, p: Array) -> Array:
    """On which side of the lines a b points are: the sign, 0 where rounding decides."""
    u, v = b - a, p - a
    cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    size = np.abs(u[:, 0] * v[:, 1]) + np.abs(u[:, 1] * v[:, 0])
    return np.where(np.abs(cross) <= 4e-16 * size, 0.0, np.sign(cross))
