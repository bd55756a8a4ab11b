"""What must be in the picture of the octopus of `probe`: all of it, or its arm seen close."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import solids

from ._probe_case import Case, Moment

Array = NDArray[np.float64]

# Around a probe, over its size: what its axes and the arrow of its turn take.
_AROUND = 1.45


def whole(case: Case, moments: Sequence[Moment]) -> Array:
    """Return points (n, 3) around the octopus and its probes."""
    return _upright(case, moments, np.ones(len(case.mesh.vertices), bool))


def close(case: Case, moments: Sequence[Moment]) -> Array:
    """Return points (n, 3) around the arm, its probe and the eye beside it."""
    s = solids.octopus()
    eye = case.mesh.vertices[s.marks["eye left"]] + 1.1 * s.eye * np.concatenate([np.eye(3), -np.eye(3)])
    points = _upright(case, moments, s.of("arm 0") & (s.along > 0.1))
    return np.concatenate([points, case.look.upright(eye)])


def _upright(case: Case, moments: Sequence[Moment], shown: NDArray[np.bool_]) -> Array:
    ends = _AROUND * case.look.probe * np.concatenate([np.eye(3), -np.eye(3)[2:]])
    around = [m.frames[:, None, :3, 3] + ends for m in moments]
    points = [m.points[shown] for m in moments] + [x.reshape(-1, 3) for x in around]
    return case.look.upright(np.concatenate(points))
