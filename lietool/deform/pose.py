"""Key transformations joined by a curve in the parameters of a way of blending.

Each key A_j in Aff+(3) has parameters, see `pose_keys`; an ordinary curve runs through them or near them,
and its points are turned back into transformations.  Any spline serves, because the parameters make up a
linear space (phi_so, phi_se, the logarithm) or are treated as if they did (matrices, quaternions).

    straight        lines from key to key: two neighbours blended by weights
    b_spline        through every key, twice differentiable
    b_spline_near   near the keys, through the first and the last
    bezier          the same, one polynomial for all keys
    hermite         through every key with given velocities
    catmull_rom     through every key with velocities from their neighbours

The last two and b_spline may swing beyond the convex hull of the keys' parameters.  By phi_so, phi_se and
alexa nothing becomes singular there; `linear` can even between two keys.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import pose_keys
from lietool.deform.pose_keys import Keys as Keys
from lietool.deform.pose_keys import followed as followed
from lietool.deform.pose_keys import principal as principal
from lietool.deform.pose_keys import relative as relative
from lietool.lie import checks, polar, so3

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Path:
    """A curve of transformations.

    Parameters
    ----------
    keys : Keys
    name : str
        Of the curve.
    at : callable
        From times (T,) to parameters (T, d).
    """

    keys: Keys
    name: str
    at: Callable[[Array], Array]

    @cached_property
    def ends(self) -> tuple[float, float]:
        """The times of the first key and the last."""
        return float(self.keys.times[0]), float(self.keys.times[-1])


@dataclass(frozen=True)
class Measure:
    """How a path turns and whether it degenerates.

    Parameters
    ----------
    turned : float, radians
        The integral of |omega|, the angular velocity of the polar rotations, over the path.
    geodesic : float, radians
        The sum of the angles between successive keys: no path that meets them turns less.
    least_det : float
        The smallest determinant of the linear part.
    least_at : float
        The time of that.
    """

    turned: float
    geodesic: float
    least_det: float
    least_at: float

    @property
    def spin(self) -> float:
        """`turned` over `geodesic`: 1 where there is no detour; infinite if only the path turns."""
        if self.geodesic <= 1e-12:
            return 1.0 if self.turned <= 1e-12 else float("inf")
        return self.turned / self.geodesic

    @property
    def is_degenerate(self) -> bool:
        """Whether the path flattens the object or turns it inside out."""
        return self.least_det <= 0.0


def evaluate(path: Path, t: ArrayLike) -> Array:
    """Return the transformations at some times.

    Kaji-Ochiai: 5.4, (9)

    Parameters
    ----------
    path : Path
    t : array_like, shape (...)
        From the time of the first key to that of the last.

    Returns
    -------
    A : (..., 4, 4)

    Raises
    ------
    ValueError
        If a time is not finite or not between the keys, or the curve leads where quaternions vanish.
    """
    where = "pose.evaluate"
    s = checks.array(where, "t", t, ())
    start, stop = path.ends
    if np.any((s < start) | (s > stop)):
        index = checks.first((s < start) | (s > stop))
        checks.fail(where, "t", f"from {start:g} to {stop:g}", f"{s[index]:g}", index)
    A = path.keys.way.decode(path.at(np.atleast_1d(s).ravel()))
    return pose_keys.about(A, -path.keys.centre).reshape(*s.shape, 4, 4)


def measure(path: Path, steps: int = 256) -> Measure:
    """Return how much a path turns, and its smallest determinant.

    The rotation is that of A = R S.  Where det A <= 0, as `linear` may have it, it is the nearest rotation,
    which jumps by up to pi: then `turned` says no more than that.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    path : Path
    steps : int
        Between two keys; a step must not turn by pi. The error falls with the square of their number.

    Returns
    -------
    Measure

    Raises
    ------
    ValueError
        If steps is none, or the path has no transformation somewhere.
    """
    t = _times(path.keys.times, _whole("pose.measure", "steps", steps, 2**20))
    A = evaluate(path, t)[:, :3, :3]
    keys = polar.rotation(path.keys.A[:, :3, :3], check=False)
    turned, geodesic = _angles(polar.rotation(A, check=False)), _angles(keys)
    det = np.linalg.det(A)
    # Twice again between the neighbours of the smallest: a minimum is flat, so that is near enough.
    for _ in range(2):
        k = int(np.argmin(det))
        t = np.linspace(t[max(k - 1, 0)], t[min(k + 1, len(t) - 1)], 65)
        det = np.linalg.det(evaluate(path, t)[:, :3, :3])
    k = int(np.argmin(det))
    return Measure(turned, geodesic, float(det[k]), float(t[k]))


def straight(keys: Keys) -> Path:
    """Return the path by straight lines from key to key, the blend of two neighbours at a time.

    Kaji-Ochiai: (9)

    Parameters
    ----------
    keys : Keys

    Returns
    -------
    Path
    """
    return _spline(keys, 1, "straight")


def b_spline(keys: Keys, degree: int = 3) -> Path:
    """Return the path by the B-spline that meets every key.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    keys : Keys
    degree : int
        From 1 to 7; with k keys at most k - 1, which is taken instead.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If the degree is none.
    """
    return _spline(keys, min(_whole("pose.b_spline", "degree", degree, 7), len(keys.times) - 1), "b_spline")


def b_spline_near(keys: Keys, degree: int = 3) -> Path:
    """Return the path by the B-spline that the keys control: it meets the first and the last.

    The knots are means of neighbouring times: it is near a key about when that was set.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    keys : Keys
    degree : int
        From 1 to 7; with k keys at most k - 1, which is taken instead.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If the degree is none.
    """
    from scipy.interpolate import BSpline

    t, p = keys.times, min(_whole("pose.b_spline_near", "degree", degree, 7), len(keys.times) - 1)
    inner = np.convolve(t[1:-1], np.full(p, 1.0 / p), "valid") if len(t) - 2 >= p else np.zeros(0)
    knots = np.concatenate([np.full(p + 1, t[0]), inner, np.full(p + 1, t[-1])])
    return Path(keys, "b_spline_near", BSpline(knots, keys.params, p))


def bezier(keys: Keys) -> Path:
    """Return the path by the Bezier curve that the keys control: it meets the first and the last.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    keys : Keys
        Of the times only the first and the last matter.

    Returns
    -------
    Path
    """
    from scipy.interpolate import BPoly

    return Path(keys, "bezier", BPoly(keys.params[:, None], keys.times[[0, -1]]))


def hermite(keys: Keys, velocities: ArrayLike) -> Path:
    """Return the path by the cubic curve that meets every key with a given velocity.

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    keys : Keys
    velocities : array_like, shape (k, d)
        The rates of the parameters at the keys; 0 rests there.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If the velocities are not finite or not as many as the parameters.
    """
    v = checks.array("pose.hermite", "velocities", velocities, ())
    if v.shape != keys.params.shape:
        must = f"an array of shape {keys.params.shape}"
        checks.fail("pose.hermite", "velocities", must, f"shape {v.shape}", None)
    return Path(keys, "hermite", _cubic(keys, v))


def catmull_rom(keys: Keys) -> Path:
    """Return the path by the cubic curve that meets every key with the mean velocity between its neighbours.

    At the ends it is that to the only neighbour (Catmull and Rom 1974).

    Kaji-Ochiai: 5.4

    Parameters
    ----------
    keys : Keys

    Returns
    -------
    Path
    """
    p, t = np.pad(keys.params, ((1, 1), (0, 0)), "edge"), np.pad(keys.times, 1, "edge")
    return Path(keys, "catmull_rom", _cubic(keys, (p[2:] - p[:-2]) / (t[2:] - t[:-2])[:, None]))


CURVES: dict[str, Callable[[Keys], Path]] = {
    "straight": straight,
    "b_spline": b_spline,
    "b_spline_near": b_spline_near,
    "bezier": bezier,
    "catmull_rom": catmull_rom,
}
"""The curves that need nothing but keys."""


def _angles(R: Array) -> float:
    """The sum of the angles between successive rotations."""
    steps = np.swapaxes(R[:-1], -1, -2) @ R[1:]
    return float(np.linalg.norm(so3.log(steps, check=False), axis=-1).sum())


def _times(keys: Array, steps: int) -> Array:
    """The times of the keys, and steps between them."""
    parts = keys[:-1, None] + np.diff(keys)[:, None] * (np.arange(steps) / steps)
    return np.append(parts.ravel(), keys[-1])


def _cubic(keys: Keys, velocities: Array) -> Callable[[Array], Array]:
    from scipy.interpolate import CubicHermiteSpline

    return CubicHermiteSpline(keys.times, keys.params, velocities)


def _spline(keys: Keys, degree: int, name: str) -> Path:
    from scipy.interpolate import make_interp_spline

    return Path(keys, name, make_interp_spline(keys.times, keys.params, degree))


def _whole(where: str, name: str, number: object, most: int) -> int:
    if not isinstance(number, int | np.integer) or isinstance(number, bool) or not 1 <= number <= most:
        checks.fail(where, name, f"a whole number from 1 to {most}", f"{number!r}", None)
    return int(number)
