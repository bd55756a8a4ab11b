"""SO(2) as a circle in the plane of the matrices [[a, -b], [b, a]], for `blend-space`, and so(2), a line."""

from dataclasses import dataclass

import numpy as np

from lietool.lie import so2
from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.plane import Plane, direction

from . import _blend_cone as cone

# Where the rotated glyphs stand, in radii of the circle, and how far a second turn stands out.
_OUTSIDE, _OPENING = 1.30, 0.12
_GLYPH = 0.44
_TICK = np.array([[0.0, -9.0, 0.0], [0.0, 9.0, 0.0]])
# The way between the ends, over the circle or the line that it is a part of.
_BOLD = 1.6 * style.CURVE


@dataclass(frozen=True, eq=False)
class Turns:
    """Two rotations, by their angles: each a logarithm of its rotation, one of many."""

    angle0: float
    angle1: float

    def linear(self, t: np.ndarray) -> np.ndarray:
        """Return (1 - t) R0 + t R1."""
        t = np.asarray(t, float)[..., None, None]
        return (1.0 - t) * so2.exp(self.angle0) + t * so2.exp(self.angle1)

    def angles(self, t: np.ndarray) -> np.ndarray:
        """Return the angles on the straight line."""
        return (1.0 - np.asarray(t, float)) * self.angle0 + np.asarray(t, float) * self.angle1

    def curved(self, t: np.ndarray) -> np.ndarray:
        """Return the rotations by `angles`."""
        return so2.exp(self.angles(t))


def drawn(M: np.ndarray) -> np.ndarray:
    """Return where matrices [[a, -b], [b, a]] (..., 2, 2) are drawn: (a, b)."""
    return M[..., :, 0]


def records(
    ends: Turns, times: np.ndarray, t: float, beyond: float, box: Box, curved: bool
) -> list[scene.Record]:
    """Return the circle with the chord between two rotations, or the arc that exp makes of their angles."""
    span = np.array([-beyond, 1.0 + beyond])
    goes_on = drawn(ends.linear(span))
    # Room for what stands outside of the circle: glyphs, and the chord where it goes on.
    reach = max(_OUTSIDE + 0.30 if curved else 1.25, float(np.linalg.norm(goes_on, axis=-1).max()) + 0.03)
    radius = min(box[2], box[3]) / 2.0 / reach
    place = Plane((box[0] + box[2] / 2.0, box[1] + box[3] / 2.0), radius)
    found: list[scene.Record] = [
        scene.Surface(*_disc(place), style.GROUP, material="flat", alpha=0.05),
        place.circle((0.0, 0.0), 1.0, style.GROUP, style.CURVE),
    ]
    chord = drawn(ends.linear(np.array([0.0, 1.0])))
    found.append(place.line(goes_on, style.ALGEBRA, style.EDGE, dash=(9.0, 6.0)))
    if curved:
        found += _arc(place, ends, times)
    else:
        found.append(place.line(chord, style.ALGEBRA, _BOLD))
        found += _shrunken(place, ends, times)
    found.append(place.dots([(0.0, 0.0)], style.INK, 5.0))
    found.append(place.beyond("$0$", (0.0, 0.0), (0.6, -1.0), size=style.SMALL_TEXT, gap=22.0, room=50.0))
    return found + _marks(place, ends, times, t, curved)


def _disc(place: Plane) -> tuple[np.ndarray, np.ndarray]:
    rim = direction(np.linspace(0.0, 2.0 * np.pi, 121))
    n = np.arange(1, 121)
    return place.at(np.concatenate([[[0.0, 0.0]], rim])), np.stack([0 * n, n, n + 1], axis=-1)


def _shrunken(place: Plane, ends: Turns, times: np.ndarray) -> list[scene.Record]:
    """The glyph under each blend, at its place on the chord."""
    found: list[scene.Record] = []
    blends = ends.linear(times)
    size = _size(float(np.linalg.norm(np.diff(drawn(blends), axis=0), axis=-1).max()), 0.16)
    for at, M, (fill, edge) in zip(drawn(blends), blends, cone.colors(len(times)), strict=True):
        moved = np.eye(3)
        moved[:2, :2], moved[:2, 2] = M, at
        found += place.glyph(moved, fill, edge, size=size, width=style.THIN)
    return found


def _size(apart: float, least: float) -> float:
    """The height of glyphs that far from each other; those at one place may be as large as any."""
    return min(_GLYPH, max(0.85 * apart, least)) if apart > 1e-9 else _GLYPH


def _arc(place: Plane, ends: Turns, times: np.ndarray) -> list[scene.Record]:
    """The arc, and the glyph under each of its rotations, outside of it."""
    turn = ends.angle1 - ends.angle0
    found = place.turn((0.0, 0.0), 1.0, ends.angle0, turn, style.GROUP_TEXT, width=_BOLD, head=False)
    size = _size(_OUTSIDE * abs(turn) / (len(times) - 1), 0.12)
    angles = ends.angles(times)
    for angle, (fill, edge) in zip(angles, cone.colors(len(times)), strict=True):
        extra = max(abs(angle - ends.angle0) / (2.0 * np.pi) - 1.0, 0.0)
        moved = np.eye(3)
        moved[:2, :2] = so2.exp(angle)
        moved[:2, 2] = (_OUTSIDE + _OPENING * extra) * direction(angle)
        found += place.glyph(moved, fill, edge, size=size, width=style.THIN)
    return found


def _marks(place: Plane, ends: Turns, times: np.ndarray, t: float, curved: bool) -> list[scene.Record]:
    """The steps, the marked moment and the names."""
    blend = drawn(ends.linear(np.array([t])))[0]
    found: list[scene.Record] = []
    if curved:
        on = drawn(ends.curved(np.array([t])))[0]
        found.append(place.dots(drawn(ends.curved(times)), style.GROUP, 7.0))
        found.append(place.dots(drawn(ends.linear(times)), style.ALGEBRA, _BOLD))
        found.append(place.line([blend, on], style.INK, style.THIN))
        found.append(scene.Points(place.at([blend]), style.ALGEBRA, 9.0, rim=style.PAPER))
        found.append(scene.Points(place.at([on]), style.GROUP, 12.5, rim=style.PAPER))
        found.append(place.beyond("$R(t)$", on, -on, color=style.GROUP_TEXT, gap=50.0, room=90.0))
    else:
        found.append(place.dots(drawn(ends.linear(times)), style.ALGEBRA, _BOLD))
        found.append(scene.Points(place.at([blend]), style.ALGEBRA, 12.5, rim=style.PAPER))
        found.append(place.beyond("$M(t)$", blend, -blend, color=style.ALGEBRA_TEXT, gap=56.0, room=110.0))
    for angle, name in ((ends.angle0, "$R_0$"), (ends.angle1, "$R_1$")):
        toward = direction(angle)
        found.append(
            place.beyond(
                name, toward, -toward if curved else toward, gap=34.0 if curved else 62.0, room=110.0
            )
        )
    return found


def flat(ends: Turns, times: np.ndarray, t: float, beyond: float, box: Box) -> list[scene.Record]:
    """Return so(2) as a line with its angles, and the straight way between two of them."""
    stops = ends.angles(np.array([0.0, 1.0, -beyond, 1.0 + beyond, t]))
    low, high = min(stops.min(), 0.0) - 0.35, max(stops.max(), 0.0) + 0.35
    left, middle = box[0], box[1] + box[3] / 2.0
    scale = box[2] / (high - low)

    def at(angle: np.ndarray | float) -> np.ndarray:
        angle = np.atleast_1d(np.asarray(angle, float))
        return np.stack([left + scale * (angle - low), 0.0 * angle + middle, 0.0 * angle], axis=-1)

    found: list[scene.Record] = [
        scene.Arrow(at(low)[0], at(high)[0], style.ALGEBRA, 1.0, 5.0),
    ]
    quarter = np.pi / 2.0 * (1.0 if scale * np.pi / 2.0 > 70.0 else 2.0 if scale * np.pi > 70.0 else 4.0)
    for k in range(int(np.ceil(low / quarter)), int(np.floor(high / quarter)) + 1):
        x = at(k * quarter)[0]
        found.append(scene.Lines(x + _TICK, style.ALGEBRA, style.THIN))
        found.append(
            scene.Label(_multiple(k * quarter), x, style.ALGEBRA_TEXT, style.SMALL_TEXT, (0.0, -20.0), "ct")
        )
    found.append(scene.Lines(at(stops[2:4]), style.ALGEBRA, style.EDGE))
    found.append(scene.Lines(at(stops[:2]), style.ALGEBRA, _BOLD))
    found.append(scene.Points(at(ends.angles(times)), style.ALGEBRA, 7.0))
    found.append(scene.Points(at(stops[4]), style.ALGEBRA, 12.5, rim=style.PAPER))
    for k in range(2):
        if abs(t - k) > 0.08:
            name = rf"$\theta_{k}$"
            found.append(
                scene.Label(
                    name, at(stops[k])[0], style.ALGEBRA_TEXT, style.TEXT, (0.0, 22.0), "cb", room=60.0
                )
            )
    return found


def _multiple(angle: float) -> str:
    """An angle as a multiple of pi, in halves."""
    halves = round(2.0 * angle / np.pi)
    if halves == 0:
        return "$0$"
    sign, halves = "-" if halves < 0 else "", abs(halves)
    top = halves // 2 if halves % 2 == 0 else halves
    count = "" if top == 1 else str(top)
    return rf"${sign}{count}\pi$" if halves % 2 == 0 else rf"${sign}{count}\pi/2$"
