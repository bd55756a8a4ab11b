"""Shapes in cages of our own: cells of a grid give the cage's faces, a table where their corners are."""

from collections.abc import Callable, Iterable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import solids
from lietool.mesh.surface import Mesh
from lietool.render import style

from . import _cage_case as case_
from . import _probe_look as look_

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Cell = tuple[int, int]


def cells(
    filled: Iterable[Cell], place: Callable[[int, int, int], tuple[float, float, float]]
) -> tuple[Array, Index]:
    """Return the surface of cells (i, k) of a grid that is one cell deep, two triangles for each side.

    `place(i, j, k)` is the corner at line i across, line j in depth, 0 the front, and line k upwards.
    """
    inside = set(filled)
    quads: list[tuple[tuple[int, int, int], ...]] = []
    for i, k in sorted(inside):
        a, b, c, d = ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))
        quads.append(tuple((p, 0, q) for p, q in (a, b, c, d)))
        quads.append(tuple((p, 1, q) for p, q in (a, d, c, b)))
        for (p, q), beside in (
            ((a, b), (i, k - 1)),
            ((b, c), (i + 1, k)),
            ((c, d), (i, k + 1)),
            ((d, a), (i - 1, k)),
        ):
            if beside not in inside:
                quads.append(((p[0], 0, p[1]), (p[0], 1, p[1]), (q[0], 1, q[1]), (q[0], 0, q[1])))
    corners = sorted({corner for quad in quads for corner in quad})
    number = {corner: n for n, corner in enumerate(corners)}
    fan = [[number[quad[n]] for n in triangle] for quad in quads for triangle in ((0, 1, 2), (0, 2, 3))]
    return np.array([place(*corner) for corner in corners]), np.array(fan, np.intp)


# The cactus: lines across, from its right to its left; lines upwards, of its right and of its left half.
_ACROSS = (-1.04, -0.505, -0.45, 0.45, 0.54, 1.12)
_RIGHT = (-0.56, 0.48, 0.72, 1.12, 1.72, 2.05, 2.38, 2.66, 3.06)
_LEFT = (-0.56, 0.48, 0.72, 1.32, 1.72, 2.14, 2.40, 2.66, 3.06)
_STEM = tuple((2, k) for k in range(8))
_CACTUS = (*_STEM, (3, 2), *((4, k) for k in (2, 3, 4)), (1, 3), *((0, k) for k in (3, 4, 5)))
# How far the pot goes across and in depth, at its lower lines.
_POT = (0.58, 0.70)


def _cactus_corner(i: int, j: int, k: int) -> tuple[float, float, float]:
    y = _ACROSS[i]
    deep = 0.45 if i in (2, 3) else 0.28
    if k < 2:
        y, deep = float(np.sign(y)) * _POT[k], _POT[k]
    return (deep if j == 0 else -deep), y, (_LEFT if y > 0.0 else _RIGHT)[k]


# The duck: lines upwards, from its tail to its beak lines forward; how far these go forward, up and sideways.
_BODY = tuple((i, k) for i in range(4) for k in (0, 1))
_DUCK = (*_BODY, (0, 2), *((i, k) for i in (2, 3) for k in (2, 3, 4)), (4, 3))
_FORWARD = (
    (-0.95, -0.45, 0.10, 0.60, 0.98),
    (-1.36, -0.62, 0.02, 0.66, 1.28),
    (-1.46, -0.62, -0.20, 0.62, 1.28),
    (-1.46, -1.00, -0.06, 0.62, 1.28, 1.62),
    (0.0, 0.0, -0.02, 0.62, 1.28, 1.62),
    (0.0, 0.0, 0.12, 0.62, 1.12),
)
_UP = (-0.76, -0.02, 0.72, 0.85, 1.38, 1.84)
_TAIL = 1.06
_WIDE = (
    (0.46, 0.66, 0.70, 0.66, 0.46),
    (0.66, 1.00, 1.00, 0.92, 0.60),
    (0.42, 0.84, 0.84, 0.74, 0.60),
    (0.26, 0.26, 0.62, 0.68, 0.56, 0.36),
    (0.0, 0.0, 0.62, 0.68, 0.56, 0.36),
    (0.0, 0.0, 0.44, 0.48, 0.40),
)


def _duck_corner(i: int, j: int, k: int) -> tuple[float, float, float]:
    y = _WIDE[k][i]
    return _FORWARD[k][i], (-y if j == 0 else y), (_TAIL if k == 3 and i < 2 else _UP[k])


# The bar: lines upwards.
_BAR = (-0.1, 0.4, 1.2, 2.0, 2.8, 3.3)


def _bar_corner(i: int, j: int, k: int) -> tuple[float, float, float]:
    return (0.44 if j == 0 else -0.44), (-0.44, 0.44)[i], _BAR[k]


_PLACES = {
    "cactus": (_CACTUS, _cactus_corner),
    "duck": (_DUCK, _duck_corner),
    "bar": ([(0, k) for k in range(5)], _bar_corner),
}
# Where the line begins along which the cage is bent, and how long it is; it goes upwards.
_SPINES = {
    "bar": ((0.0, 0.0, 0.4), 2.4, (0.0, 1.0, 0.0)),
    "cactus": ((0.0, 0.0, 0.48), 2.58, (0.0, 1.0, 0.0)),
    "duck": ((0.55, 0.0, 0.6), 0.6, (1.0, 0.0, 0.0)),
}
# Which faces are marked: in front, where the cage bends.
_SHOWN = {"cactus": 64, "duck": 86, "bar": 2}


@cache
def example(name: str, spacing: float = solids.FINE) -> case_.Case:
    """Return a shape in its cage."""
    solid = solids.SOLIDS[name](spacing)
    V, F = cells(*_PLACES[name])
    foot, length, side = _SPINES[name]
    up = np.array([0.0, 0.0, 1.0])
    share = np.clip((V[:, 2] - foot[2]) / length, 0.0, 1.0)
    if name == "duck":
        # Its tail is as high as its neck, and stays.
        share = np.where(V[:, 0] < -0.5, 0.0, share)
    spine = case_.Spine(np.array(foot), up, np.array(side), length, share)
    mesh = Mesh(solid.vertices, solid.faces)
    return case_.Case(name, mesh, V, F, _look(name, solid), spine, shown=_SHOWN[name])


def _look(name: str, solid: solids.Solid) -> look_.Look:
    if name == "cactus":
        made = look_.patches(solid.faces, [solid.margin("pot", "rim"), solid.margin("petal")])
        colors = (style.BETWEEN_EDGE, style.ROUTE_2, style.SHELLS[2])
        return look_.Look((1.0, 0.3, 0.3), 0.5, colors, colors, made, (style.INK, style.INK))
    if name == "bar":
        made = look_.patches(solid.faces, [solid.margin("front", "back")])
        colors = (style.AFTER, style.BETWEEN)
        return look_.Look((1.0, 0.3, 0.3), 0.5, colors, colors, made)
    made = look_.patches(solid.faces, [solid.margin("upper beak", "lower beak")])
    eyes = tuple(vertex for mark, vertex in solid.marks.items() if mark.startswith("eye"))
    colors = (style.MARK, style.AFTER)
    return look_.Look((1.0, -0.9, 0.3), 0.5, colors, colors, made, (style.INK, style.INK), eyes, solid.eye)
