"""What is measured at the moved shapes alone: windings of strings, twists of an arm, the lean of a bar."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.lie import quaternion, so3
from lietool.mesh import solids
from lietool.mesh.surface import Mesh

from ._probe_case import Moment

Array = NDArray[np.float64]

_BINS = 40
ALONG = (np.arange(_BINS) + 0.5) / _BINS
"""Places along a limb, from its root to its tip, at which things are measured."""


def _rings(part: NDArray[np.bool_], along: Array) -> list[NDArray[np.intp]]:
    """The vertices of a limb, in parts from its root to its tip."""
    place = np.minimum((along * _BINS).astype(np.intp), _BINS - 1)
    return [np.flatnonzero(part & (place == k)) for k in range(_BINS)]


def winding(points: Array) -> float:
    """Return by how many degrees the strings are wound about each other from below to above."""
    s = solids.strings()
    first, last = s.parts[0], s.parts[-1]
    ends = [
        np.array([points[ring].mean(axis=0) for ring in _rings(s.of(name), s.along)])
        for name in (first, last)
    ]
    across = (ends[1] - ends[0])[:, :2]
    angle = np.unwrap(np.arctan2(across[:, 1], across[:, 0]))
    return float(np.degrees(angle[-1] - angle[0]))


def twist(points: Array, axis: Array) -> Array:
    """Return by how many degrees (n,) each place along the octopus's arm has turned about an axis.

    It is counted from the root on, and on beyond full turns.
    """
    s = solids.octopus()
    rings = [ring for ring in _rings(s.of("arm 0"), s.along) if len(ring) > 5]
    q = quaternion.from_matrix(np.stack([_turned(s.vertices[ring], points[ring]) for ring in rings]))
    u = axis if np.any(axis) else s.axes["arm 0"][-1] - s.axes["arm 0"][0]
    # What is left of each rotation without the part that tilts the axis.
    angle = 2.0 * np.arctan2(q[:, 1:] @ (u / np.linalg.norm(u)), q[:, 0])
    angle = np.unwrap(np.append(0.0, angle))[1:]
    places = np.array([s.along[ring].mean() for ring in rings])
    return np.interp(ALONG, places, np.degrees(angle))


def _turned(P: Array, Q: Array) -> Array:
    """The rotation that takes points P (n, 3) nearest to Q, but for a translation."""
    M = (Q - Q.mean(axis=0)).T @ (P - P.mean(axis=0))
    U, _, Vt = np.linalg.svd(M)
    return (U * (1.0, 1.0, np.linalg.det(U @ Vt))) @ Vt


def leaning(moments: Sequence[Moment]) -> Array:
    """Return by how many degrees (k,) the upper end of the bar leans, at several moments."""
    s = solids.bar()
    R = np.stack([_turned(s.vertices[s.along > 0.85], m.points[s.along > 0.85]) for m in moments])
    return np.degrees(np.linalg.norm(so3.log_along(R, np.zeros(3)), axis=1))


def volumes(mesh: Mesh, moments: Sequence[Moment]) -> Array:
    """Return the volumes (k,) of a closed mesh at several moments, over that at rest."""
    found = [_volume(V, mesh.faces) for V in (mesh.vertices, *(m.points for m in moments))]
    return np.array(found[1:]) / found[0]


def _volume(V: Array, F: NDArray[np.intp]) -> float:
    a, b, c = (V[F[:, k]] for k in range(3))
    return float(np.sum(a * np.cross(b, c))) / 6.0
