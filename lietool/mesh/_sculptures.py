"""What the solids are modelled of: an octopus, a ball with thorns, a duck, a cactus, an animal.

x is to the front, y to the left, z up.  Coordinates are rounded where they come from sines, so that every
machine models the same.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.mesh._flesh import Brick, Egg, Limb, Pot
from lietool.mesh._implicit import Body

Array = NDArray[np.float64]
Point = tuple[float, float, float]

# Of each arm of the octopus: azimuth, length, then the knots of its elevation and of its turn sideways.
_ARMS = (
    (90.0, 2.30, (14.0, 24.0, 30.0, 33.0, 34.0, 34.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    (43.0, 1.95, (-4.0, -16.0, -10.0, 2.0, 30.0, 120.0), (0.0, -6.0, -16.0, -22.0, -10.0, 40.0)),
    (2.0, 1.90, (-4.0, -16.0, -12.0, 0.0, 22.0, 60.0), (0.0, 8.0, 26.0, 30.0, -30.0, -110.0)),
    (-42.0, 2.00, (-4.0, -16.0, -10.0, 0.0, 8.0, 30.0), (0.0, 10.0, 20.0, 0.0, -50.0, -150.0)),
    (-90.0, 2.15, (-4.0, -14.0, -6.0, 6.0, 44.0, 150.0), (0.0, -8.0, -14.0, -4.0, 4.0, 10.0)),
    (-138.0, 1.95, (-4.0, -16.0, -10.0, 0.0, 10.0, 40.0), (0.0, 8.0, 22.0, 34.0, 70.0, 130.0)),
    (178.0, 1.90, (-4.0, -16.0, -10.0, 2.0, 16.0, 40.0), (0.0, 10.0, 22.0, 10.0, -40.0, -120.0)),
    (134.0, 1.95, (-4.0, -16.0, -10.0, 0.0, 16.0, 60.0), (0.0, 8.0, 26.0, 44.0, 90.0, 150.0)),
)


def _smooth(knots: Sequence[float] | Array, at: Array) -> Array:
    """A natural-looking curve through values at equal distances: Catmull and Rom's spline."""
    y = np.asarray(knots, float)
    y = np.concatenate([2.0 * y[:1] - y[1:2], y, 2.0 * y[-1:] - y[-2:-1]])
    k = np.minimum(np.floor(at * (len(y) - 3)).astype(int), len(y) - 4)
    t = at * (len(y) - 3) - k
    if y.ndim > 1:
        t = t[:, None]
    a, b, c, d = y[k], y[k + 1], y[k + 2], y[k + 3]
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def curve(points: Sequence[Point], count: int) -> Array:
    """Return `count` points (count, 3) of a smooth curve through some."""
    return np.round(_smooth(np.array(points), np.linspace(0.0, 1.0, count)), 9)


def _arm(azimuth: float, length: float, rises: Sequence[float], turns: Sequence[float], root: float) -> Array:
    """The axis of an arm: it leaves the body at an azimuth, and its direction changes along the way."""
    s = np.linspace(0.0, 1.0, 41)
    up = np.radians(_smooth(rises, s))
    side = np.radians(azimuth + _smooth(turns, s))
    step = np.stack([np.cos(up) * np.cos(side), np.cos(up) * np.sin(side), np.sin(up)], axis=1)
    path = np.concatenate([np.zeros((1, 3)), np.cumsum(0.5 * (step[1:] + step[:-1]), axis=0)]) * length / 40.0
    a = np.radians(azimuth)
    return np.round(path + np.array([root * np.cos(a), root * np.sin(a), 0.36]), 9)


def octopus() -> Body:
    """An octopus with a big head that waves one of its eight arms."""
    s = np.linspace(0.0, 1.0, 41)
    thick = np.round(0.185 * (1.0 - s) ** 0.85 + 0.036, 9)
    arms = tuple(
        Limb(f"arm {k}", _arm(azimuth, length, rises, turns, 0.40), thick, 0.16)
        for k, (azimuth, length, rises, turns) in enumerate(_ARMS)
    )
    head = (
        Egg("head", (-0.16, 0.0, 1.34), (0.70, 0.66, 0.80), tilt=-0.30),
        Egg("face", (0.04, 0.0, 0.66), (0.52, 0.50, 0.48), 0.42),
        Egg("foot", (0.0, 0.0, 0.38), (0.56, 0.56, 0.24), 0.20),
        Egg("brow left", (0.40, 0.27, 0.86), (0.17, 0.17, 0.18), 0.14),
        Egg("brow right", (0.40, -0.27, 0.86), (0.17, 0.17, 0.18), 0.14),
    )
    return Body((*head, *arms))


def thorn_ball() -> Body:
    """A ball with one large thorn upwards and small ones all round."""
    s = np.linspace(0.0, 1.0, 33)
    z = np.round(0.70 + 1.85 * s, 9)
    large = Limb(
        "thorn",
        np.stack([0.0 * z, 0.0 * z, z], axis=1),
        np.round(0.40 * (1.0 - s) ** 1.15 + 0.022, 9),
        0.24,
        front=(1.0, 0.0, 0.0),
    )
    small = []
    # A spiral from pole to pole at even distances; not where the large thorn stands.
    count = 22
    for k in range(count):
        height = 1.0 - (2.0 * k + 1.0) / count
        if height > 0.72:
            continue
        turn = np.pi * (3.0 - np.sqrt(5.0)) * k
        wide = np.sqrt(1.0 - height * height)
        u = np.round([wide * np.cos(turn), wide * np.sin(turn), height], 9)
        radii = np.linspace(0.155, 0.02, 9)
        small.append(Limb(f"small {k}", np.linspace(0.86, 1.27, 9)[:, None] * u, radii, 0.10))
    return Body((Egg("ball", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), *small, large))


def duck() -> Body:
    """A rubber duck."""
    tail = curve([(-0.55, 0.0, 0.10), (-0.92, 0.0, 0.30), (-1.14, 0.0, 0.58), (-1.26, 0.0, 0.86)], 25)
    s = np.linspace(0.0, 1.0, 25)
    return Body(
        (
            Egg("body", (0.0, 0.0, 0.0), (1.12, 0.84, 0.68)),
            Limb("tail", tail, np.round(0.46 * (1.0 - s) + 0.07, 9), 0.35),
            Egg("neck", (0.52, 0.0, 0.58), (0.50, 0.48, 0.60), 0.34),
            Egg("head", (0.62, 0.0, 1.18), (0.56, 0.53, 0.52), 0.12),
            Egg("wing left", (-0.26, 0.74, 0.16), (0.60, 0.15, 0.33), 0.10, tilt=0.30),
            Egg("wing right", (-0.26, -0.74, 0.16), (0.60, 0.15, 0.33), 0.10, tilt=0.30),
            Egg("upper beak", (1.20, 0.0, 1.13), (0.32, 0.26, 0.10), 0.07, tilt=-0.20),
            Egg("lower beak", (1.12, 0.0, 0.98), (0.25, 0.21, 0.08), 0.05, tilt=0.14),
        )
    )


def cactus() -> Body:
    """A cactus with two arms and a flower on its top, in a pot."""
    left = curve([(0, 0.05, 1.02), (0, 0.46, 1.00), (0, 0.74, 1.14), (0, 0.82, 1.45), (0, 0.82, 1.80)], 31)
    right = curve(
        [(0, -0.05, 1.42), (0, -0.42, 1.40), (0, -0.68, 1.52), (0, -0.75, 1.80), (0, -0.75, 2.06)], 31
    )
    s = np.linspace(0.0, 1.0, 31)
    stem = np.stack([0.0 * s, 0.0 * s, np.round(0.3 + 2.15 * s, 9)], axis=1)
    across = (1.0, 0.0, 0.0)
    petals = []
    for k in range(7):
        a = 2.0 * np.pi * k / 7.0
        out = np.round([np.cos(a), np.sin(a), 0.0], 9)
        way = np.array([(0.02, 2.76), (0.09, 2.84), (0.19, 2.90), (0.28, 2.92)])
        axis = way[:, :1] * out + way[:, 1:] * (0.0, 0.0, 1.0)
        petals.append(
            Limb(f"petal {k}", np.round(axis, 9), np.array([0.05, 0.065, 0.07, 0.045]), 0.03, across)
        )
    pot = np.array([(0.0, -0.45), (0.42, -0.45), (0.54, 0.22), (0.0, 0.22)])
    rim = np.array([(0.0, 0.22), (0.60, 0.22), (0.61, 0.40), (0.0, 0.40)])
    return Body(
        (
            Limb("stem", stem, np.round(0.33 + 0.06 * np.sin(0.4 + 2.4 * s), 9), 0.1, across, (10, 0.030)),
            Limb("left arm", left, np.full(31, 0.205), 0.14, across, (8, 0.022)),
            Limb("right arm", right, np.full(31, 0.18), 0.14, across, (8, 0.022)),
            Pot("pot", pot, 0.04, 0.03),
            Pot("rim", rim, 0.035, 0.03),
            *petals,
        )
    )


def bar() -> Body:
    """A square bar that stands upright, its edges rounded."""
    return Body((Brick("bar", (0.0, 0.0, 1.6), (0.32, 0.32, 1.6), 0.09),))
