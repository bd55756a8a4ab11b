"""The thorn seen from above, drawn beside it: how it is slanted and turned, and whereto its tip goes."""

import numpy as np

from lietool.render import marks, style
from lietool.render.camera import Box, Camera
from lietool.render.scene import Arrow, Lines, Points, Record

from . import _blend_look as look
from ._blend_family import Family

Array = np.ndarray

ROOM = 24.0
"""So far shapes move to the right for it."""
# The tip of the thorn at rest is above this.
_TIP = 2.5
# Where the plan's middle is from a box's left upper corner, page units; its rim, and the arc of a turn.
_FROM_LEFT, _FROM_TOP = 48.0, 96.0
_RIM, _ARC = 54.0, 32.0
# Of arrows: half their thickness, and the shortest that has a head.
_SHAFT, _SHORT = 2.2, 9.0


def plan(family: Family, camera: Camera, box: Box, X: Array, color: str) -> list[Record]:
    """A circle with an arrow to where a shape's tip goes, in the scale of the shapes; a dot if nowhere.

    To the right on the page is to the right for the camera, and down is towards it.
    """
    gone = (tip(family, X) - tip(family, family.rest))[:2] @ _turned(family).T * box[3] / camera.height
    middle = _middle(box)
    around = np.linspace(0.0, 2.0 * np.pi, 73)
    records: list[Record] = [Lines(middle + _RIM * _at(around), style.MUTED, style.THIN)]
    if np.linalg.norm(gone) < _SHORT:
        return [*records, Points(_flat(gone[None]) + middle, color, 5.0)]
    return [
        *records,
        Points(middle[None], style.MUTED, 3.0),
        Arrow(middle, middle + _flat(gone), color, _SHAFT, 3.4),
    ]


def tip(family: Family, X: Array) -> Array:
    """The middle of what is the tip of the thorn at rest."""
    return X[family.rest[:, 2] > _TIP].mean(axis=0)


def turned(family: Family, box: Box, target: int, degrees: float) -> list[Record]:
    """How a target's thorn is made: slanted where the dashed line points, then turned along the arc."""
    if degrees < 1.0:
        return []
    sign = 1.0 if target == 0 else -1.0
    middle = _middle(box)
    across = _turned(family) @ [sign, 0.0]
    first = np.arctan2(across[1], across[0])
    angle = sign * np.radians(degrees)
    arc = _at(first + np.linspace(0.0, angle, 60))
    text = rf"${sign * degrees:.0f}^{{\circ}}$"
    return [
        Lines(
            np.stack([middle, middle + _RIM * arc[0]]), look.target(target)[2], style.THIN, dash=(6.0, 5.0)
        ),
        *marks.curved_arrow(middle + _ARC * arc, style.MARK, 1.3, 4.2),
        look.line(text, middle[0], middle[1] - _RIM - 34.0, color=style.MARK),
    ]


def named(box: Box) -> list[Record]:
    """What the plan is, below it."""
    x, y, _ = _middle(box)
    return [look.line("from above", x, y - _RIM - 34.0)]


def _middle(box: Box) -> Array:
    return np.array([box[0] + _FROM_LEFT, box[1] + box[3] - _FROM_TOP, 0.0])


def _turned(family: Family) -> Array:
    """From x and y to right and up in the plan."""
    x, y = np.asarray(family.direction[:2]) / np.hypot(*family.direction[:2])
    return np.array([[-y, x], [-x, -y]])


def _at(angle: Array) -> Array:
    return np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)


def _flat(p: Array) -> Array:
    return np.pad(np.asarray(p, float), [(0, 0)] * (np.ndim(p) - 1) + [(0, 1)])
