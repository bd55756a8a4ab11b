"""A surface cut along the level line of a function, so that two colours meet in a clean line.

The cut says where its vertices come from, not where they are: it serves all shapes with the same faces.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import topology
from lietool.mesh.topology import fail

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Cut:
    """Triangles on either side of a level line.

    Attributes
    ----------
    ends : (k, 2) of int
        The edges that are cut, each in a new vertex; these come after the old ones, in this order.
    share : (k,)
        How much of the second end each new vertex is, 0 to 1.
    above, below : (m, 3) of int
        Triangles where the function is above the level, and the others.
    """

    ends: Index
    share: Array
    above: Index
    below: Index

    def carry(self, x: ArrayLike) -> Array:
        """Return values at the old vertices (n, ...) with those at the new ones after them (n + k, ...)."""
        x = np.asarray(x, float)
        t = self.share.reshape(-1, *[1] * (x.ndim - 1))
        return np.concatenate([x, (1.0 - t) * x[self.ends[:, 0]] + t * x[self.ends[:, 1]]])


def along(F: ArrayLike, values: ArrayLike, level: float = 0.0) -> Cut:
    """Cut triangles along a level line of a function that is linear on each.

    Parameters
    ----------
    F : array_like of int, shape (m, 3)
    values : array_like, shape (n,)
        At the vertices.
    level : float

    Returns
    -------
    Cut

    Raises
    ------
    ValueError
        If the values are not finite numbers, one for each vertex, or the faces are no mesh of them.
    """
    try:
        x = np.asarray(values, float) - float(level)
    except (TypeError, ValueError):
        fail("cut.along", "values", "numbers", "something else")
    if x.ndim != 1 or not np.isfinite(x).all():
        fail(
            "cut.along",
            "values",
            "finite, of shape (n,)",
            f"shape {x.shape}" if x.ndim != 1 else "what is not",
        )
    faces = topology.faces("cut.along", F, len(x))
    # A vertex on the line counts as above.
    up = x >= 0.0
    count = up[faces].sum(axis=1)
    mixed = faces[(count == 1) | (count == 2)]
    # The corner that is alone on its side comes first.
    alone = np.argmax(up[mixed] == (up[mixed].sum(axis=1) == 1)[:, None], axis=1)
    mixed = np.take_along_axis(mixed, (alone[:, None] + np.arange(3)) % 3, axis=1)
    crossed = np.concatenate([mixed[:, [0, 1]], mixed[:, [0, 2]]])
    ends, place = np.unique(np.sort(crossed, axis=1), axis=0, return_inverse=True)
    place = np.reshape(place, -1)
    share = np.clip(x[ends[:, 0]] / (x[ends[:, 0]] - x[ends[:, 1]]), 1e-3, 1.0 - 1e-3)
    p, q = len(x) + place[: len(mixed)], len(x) + place[len(mixed) :]
    a, b, c = mixed.T
    tips = np.stack([a, p, q], axis=1)
    stumps = np.stack([p, b, c, p, c, q], axis=1).reshape(-1, 2, 3)
    tip_up = up[a]
    above = [faces[count == 3], tips[tip_up], stumps[~tip_up].reshape(-1, 3)]
    below = [faces[count == 0], tips[~tip_up], stumps[tip_up].reshape(-1, 3)]
    return Cut(ends, share, np.concatenate(above), np.concatenate(below))
