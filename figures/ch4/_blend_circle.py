"""SO(2) as a circle in the plane of the matrices [[a, -b], [b, a]], for `blend-space`, and so(2), a line.

The circle is turned so that I is its lowest point, and the line lies below it: the line of angles is the
tangent at I, and on both larger angles are farther to the right.
"""

from dataclasses import dataclass

import numpy as np

from lietool.lie import so2
from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.plane import Plane, direction
from lietool.render.solids import fan_faces

from . import _blend_cone as cone

# Where the rotated glyphs stand, in radii of the circle, and how far a second turn stands out.
_OUTSIDE, _OPENING = 1.34, 0.12
_GLYPH = 0.42
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
    """Return where matrices [[a, -b], [b, a]] (..., 2, 2) are drawn: (b, -a), so that I is lowest."""
    return np.stack([M[..., 1, 0], -M[..., 0, 0]], axis=-1)


def _toward(angle: np.ndarray | float) -> np.ndarray:
    """Where rotations are drawn, by their angles."""
    return drawn(so2.exp(angle))


def records(
    ends: Turns, times: np.ndarray, t: float, beyond: float, box: Box, curved: bool
) -> list[scene.Record]:
    """Return the circle with the chord between two rotations, or the arc that exp makes of their angles."""
    reach = _OUTSIDE + (0.26 if curved else 0.18)
    place = Plane((box[0] + box[2] / 2.0, box[1] + box[3] / 2.0), min(box[2], box[3]) / 2.0 / reach)
    found: list[scene.Record] = [
        scene.Surface(*_disc(place), style.GROUP, material="flat", alpha=0.05),
        place.circle((0.0, 0.0), 1.0, style.GROUP_TEXT, style.EDGE),
    ]
    chord = drawn(ends.linear(np.array([0.0, 1.0])))
    if curved:
        found.append(place.line(chord, style.MUTED, style.EDGE, dash=(8.0, 6.0)))
        found += _arc(place, ends, times)
    else:
        span = np.linspace(-beyond, 1.0 + beyond, 241)
        near = np.linalg.norm(drawn(ends.linear(span)), axis=-1) <= reach
        found.append(place.line(drawn(ends.linear(span[near])), style.WRONG, style.EDGE))
        found.append(place.line(chord, style.WRONG, _BOLD))
        found += _shrunken(place, ends, times)
    found.append(place.dots([(0.0, 0.0), (0.0, -1.0)], style.INK, 5.0))
    found.append(place.beyond("$0$", (0.0, 0.0), (0.4, 1.0), size=style.SMALL_TEXT, gap=24.0, room=40.0))
    found.append(place.beyond("$I$", (0.0, -1.0), (0.0, 1.0), size=style.SMALL_TEXT, gap=26.0, room=40.0))
    return found + _marks(place, ends, times, t, curved)


def _disc(place: Plane) -> tuple[np.ndarray, np.ndarray]:
    rim = direction(np.linspace(0.0, 2.0 * np.pi, 121))
    return place.at(np.concatenate([[[0.0, 0.0]], rim])), fan_faces(len(rim) + 1)


def _off(ends: Turns) -> np.ndarray:
    """The unit vector across the chord, away from the middle of the circle."""
    chord = drawn(ends.linear(np.array([0.0, 1.0])))
    middle, along = chord.mean(axis=0), chord[1] - chord[0]
    if np.linalg.norm(along) < 1e-9:
        return middle
    across = np.array([along[1], -along[0]]) / np.linalg.norm(along)
    return -across if across @ middle < -1e-9 else across


def _shrunken(place: Plane, ends: Turns, times: np.ndarray) -> list[scene.Record]:
    """The glyph under each blend, on a stem: inside the circle, those of the ends outside."""
    blends, off = ends.linear(times), _off(ends)
    points = drawn(blends)
    apart = float(np.linalg.norm(points[-1] - points[0])) / (len(times) - 1)
    if apart < 1e-9:
        blends, points, times = blends[[0, -1]], points[[0, -1]], times[[0, -1]]
    size = _size(1.25 * apart, 0.16)
    found: list[scene.Record] = []
    for k, (at, M, (fill, edge)) in enumerate(zip(points, blends, cone.colors(len(times)), strict=True)):
        if 0 < k < len(times) - 1:
            middle = at - 0.30 * off
        else:
            # Away from where the chord goes on.
            side = float(np.sign(at[0] * off[1] - at[1] * off[0]))
            middle = _OUTSIDE * so2.exp(0.30 * side) @ at
        found += _held(place, at, middle, M, size, fill, edge)
    return found


def _held(
    place: Plane, at: np.ndarray, middle: np.ndarray, M: np.ndarray, size: float, fill: str, edge: str
) -> list[scene.Record]:
    """The glyph under a matrix in some place, on a stem from where the matrix is."""
    moved = np.eye(3)
    moved[:2, :2], moved[:2, 2] = M, middle
    away = at - middle
    part = min(0.45 * size * float(np.linalg.norm(M[0])) / float(np.linalg.norm(away)), 1.0)
    return [
        place.line(np.stack([at, middle + part * away]), edge, style.THIN),
        *place.glyph(moved, fill, edge, size=size, width=style.THIN),
    ]


def _size(apart: float, least: float) -> float:
    """The height of glyphs that far from each other; those at one place may be as large as any."""
    return min(_GLYPH, max(0.85 * apart, least)) if apart > 1e-9 else _GLYPH


def _arc(place: Plane, ends: Turns, times: np.ndarray) -> list[scene.Record]:
    """The arc, and the glyph under each of its rotations, outside of it."""
    turn = ends.angle1 - ends.angle0
    start = ends.angle0 - np.pi / 2.0
    found = place.turn((0.0, 0.0), 1.0, start, turn, style.GROUP, width=_BOLD, head=False)
    size = _size(_OUTSIDE * abs(turn) / (len(times) - 1), 0.12)
    angles = ends.angles(times)
    for angle, (fill, edge) in zip(angles, cone.colors(len(times)), strict=True):
        extra = max(abs(angle - ends.angle0) / (2.0 * np.pi) - 1.0, 0.0)
        at = _toward(angle)
        found += _held(place, at, (_OUTSIDE + _OPENING * extra) * at, so2.exp(angle), size, fill, edge)
    return found


def _marks(place: Plane, ends: Turns, times: np.ndarray, t: float, curved: bool) -> list[scene.Record]:
    """The steps, the marked moment and the names."""
    way, color = (ends.curved, style.GROUP) if curved else (ends.linear, style.WRONG)
    steps, on = drawn(way(times)), drawn(way(np.array([t])))[0]
    found: list[scene.Record] = [place.dots(steps, color, 7.0)]
    if not curved:
        found.append(place.dots(steps[[0, -1]], style.GROUP_TEXT, 8.0))
    found.append(scene.Points(place.at([on]), color, 12.5, rim=style.PAPER))
    if curved:
        found.append(place.beyond("$R(t)$", on, -on, color=style.GROUP_TEXT, gap=40.0, room=60.0))
    else:
        found.append(place.beyond("$M(t)$", on, _off(ends), color=style.WRONG, gap=36.0, room=60.0))
    for angle, name, k in ((ends.angle0, "$R_0$", 0.0), (ends.angle1, "$R_1$", 1.0)):
        at = _toward(angle)
        if not curved or abs(t - k) > 0.08:
            found.append(place.beyond(name, at, -at if curved else at - _off(ends), gap=36.0, room=60.0))
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
    found.append(scene.Lines(at(stops[2:4]), style.ALGEBRA, style.CURVE))
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
