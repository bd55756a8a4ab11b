"""`commute` for two rotations of space: one start, two orders, two ends, and the turn between the ends."""

import numpy as np

from lietool.figure import Drawing
from lietool.lie import so3
from lietool.render import plane, scene, style
from lietool.render.camera import Camera
from lietool.render.marks import LETTER, LETTER_BEFORE, beyond, coordinate_axes, curved_arrow, letter
from lietool.render.solids import frame_along

from . import _motions as m

_BETWEEN = (style.BETWEEN, style.GREYS[1], style.BONE)
# Middles of the cells: start, the columns and rows of the two ways, both ends together.
_SIDE, _HEIGHT = 318.0, 2.05
_START, _BOTH = (134.0, 435.0), (1010.0, 435.0)
_COLUMNS, _ROWS = (420.0, 720.0), (612.0, 258.0)
# Arrows run a little above the middles, clear of an x axis that comes towards the viewer.
_LEVEL, _BEND = 44.0, 50.0
_WAYS = (m.FIRST, m.SECOND)
_EYE = (1.0, 0.62, 0.46)
# How far axes and frames reach, and the rings on which angles are drawn, the solid being 1 high.
_AXIS, _FRAME, _RING = 0.98, 0.68, 0.36
# Nearer than this, in radians, both ends are one.
_SAME = 1e-9


def rotations(axes: tuple[str, str], angles: tuple[float, float], t: float) -> Drawing:
    """R_2 R_1 above and R_1 R_2 below, and what turns one end into the other."""
    turns = list(zip(axes, angles, strict=True))
    orders = [turns, turns[::-1]]
    done = m.parts(t, 2)
    stages = np.stack([_stages(order, (1.0, 1.0)) for order in orders])
    now = np.stack([_stages(order, done) for order in orders])
    between = so3.log(stages[0, 1].T @ stages[1, 1])
    delta = float(np.linalg.norm(between))
    views = [_cell(_START, [*letter(np.eye(3), colors=LETTER_BEFORE), *_given_axes()])]
    for k, y in enumerate(_ROWS):
        for j, x in enumerate(_COLUMNS):
            views.append(_cell((x, y), _step(orders[k][j], now[k], j, done[j], _WAYS[k].text)))
    views.append(_cell(_BOTH, _both(now[0, 1], now[1, 1])))
    page = [*_arrows(orders), *_words(turns, delta, _distance(now[0, 1], now[1, 1]) if t < 1.0 else None)]
    numbers = {
        "angles": np.array(angles),
        "stages": stages,
        "between": between,
        "angle_between": delta,
        "angle_between_deg": float(np.rad2deg(delta)),
        "now": now,
    }
    return Drawing(scene.Picture((*views, scene.View(tuple(page)))), numbers)


def _stages(order: list[tuple[str, float]], done: tuple[float, ...] | list[float]) -> np.ndarray:
    """After the first and after the second turn of an order, each done in part; the axes are fixed."""
    first, second = (
        so3.rotation(axis, part * theta) for (axis, theta), part in zip(order, done, strict=True)
    )
    return np.stack([first, second @ first])


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.linalg.norm(so3.log(a.T @ b)))


def _camera() -> Camera:
    return Camera(_EYE, (0.0, 0.0, 0.0), _HEIGHT)


def _cell(middle: tuple[float, float], records: list[scene.Record]) -> scene.View:
    box = (middle[0] - _SIDE / 2.0, middle[1] - _SIDE / 2.0, _SIDE, _SIDE)
    return scene.View(tuple(records), _camera(), box)


def _given_axes() -> list[scene.Record]:
    return coordinate_axes(_camera(), ("$x$", "$y$", "$z$"), 0.86 * _AXIS)


def _step(turn: tuple[str, float], now: np.ndarray, j: int, part: float, color: str) -> list[scene.Record]:
    """The solid after (or, at a time, during) a turn, and the axis of that turn with its angle."""
    axis, theta = turn
    u = np.eye(3)["xyz".index(axis)]
    colors = LETTER_BEFORE if part == 0.0 else (_BETWEEN, LETTER)[j]
    return [
        *letter(now[j], colors=colors),
        scene.Frame(now[j], length=_FRAME, radius=0.016),
        scene.Arrow(-_AXIS * u, _AXIS * u, style.INK, 0.010),
        beyond(f"${axis}$", _AXIS * u, u, _camera(), size=style.SMALL_TEXT, gap=22.0, room=64.0),
        *_angle(u, 0.86 * u, part * theta, color),
    ]


def _angle(axis: np.ndarray, center: np.ndarray, theta: float, color: str) -> list[scene.Record]:
    """A turn about an axis as a curved arrow, its middle where it is seen best."""
    frame, back = frame_along(axis), _camera().axes[2]
    # Towards the viewer; about an axis that itself comes towards the viewer, on the side away from the solid.
    toward = frame[:, :2].T @ back * (-1.0 if abs(axis @ back) > np.sqrt(0.5) else 1.0)
    start = float(np.arctan2(toward[1], toward[0])) - theta / 2.0
    ring = plane.spiral((0.0, 0.0), _RING, start, theta)
    whole = plane.arc((0.0, 0.0), _RING, 0.0, 2.0 * np.pi)
    fan = center + np.concatenate([[(0.0, 0.0)], ring]) @ frame[:, :2].T
    n = np.arange(1, len(ring))
    return [
        scene.Lines(center + whole @ frame[:, :2].T, color, style.HAIR, 0.5),
        scene.Surface(fan, np.stack([0 * n, n, n + 1], axis=-1), color, material="flat", alpha=0.30),
        *curved_arrow(fan[1:], color, 0.013, 2.2),
    ]


def _both(one: np.ndarray, two: np.ndarray) -> list[scene.Record]:
    """Both ends in one place, the second as its edges; and the turn that leads from the first to it."""
    records = letter(one)
    difference = so3.log(two @ one.T)
    delta = float(np.linalg.norm(difference))
    if delta < _SAME:
        return [*records, scene.Frame(one, length=_FRAME, radius=0.016)]
    u = difference / delta
    # The end of the axis that is seen.
    u_seen = u if u @ _camera().axes[2] >= 0.0 else -u
    return [
        *records,
        *(
            scene.Lines(record.points, style.ROUTE_2, style.EDGE, dash=(9.0, 5.0), lift=1.0)
            for record in letter(two)
            if isinstance(record, scene.Lines)
        ),
        scene.Arrow(-_AXIS * u_seen, _AXIS * u_seen, style.MARK, 0.010),
        *_angle(u, 0.86 * u_seen, delta, style.MARK),
    ]


def _name(turn: tuple[str, float]) -> str:
    return rf"R_{turn[0]}({m.degrees(turn[1])})"


def _arrows(orders: list[list[tuple[str, float]]]) -> list[scene.Record]:
    """From cell to cell, with the turn that leads there."""
    records: list[scene.Record] = []
    for row, order, way, up in zip(_ROWS, orders, _WAYS, (1.0, -1.0), strict=True):
        x, y = _START[0] + 60.0, row + _LEVEL
        bend = plane.arc((x + _BEND, y - up * _BEND), _BEND, np.pi, np.pi * (1.0 - up / 2.0), 21)
        begin = (x, _START[1] + (125.0 if up > 0.0 else -55.0))
        first = np.concatenate([[begin], bend, [(_COLUMNS[0] - 112.0, y)]])
        second = np.array([(_COLUMNS[0] + 106.0, y), (_COLUMNS[1] - 114.0, y)])
        for curve, turn in ((first, order[0]), (second, order[1])):
            points = np.column_stack([curve, np.zeros(len(curve))])
            records += plane.path(points, way.color, style.CURVE, dash=way.dash)
            middle = (max(curve[0, 0], x + _BEND / 2.0) + curve[-1, 0]) / 2.0
            name = f"${_name(turn)}$"
            records.append(
                scene.Label(name, (middle, y, 0.0), way.text, style.SMALL_TEXT, (0.0, 16.0), "cb", room=90.0)
            )
    return records


def _words(turns: list[tuple[str, float]], delta: float, so_far: float | None) -> list[scene.Record]:
    same = delta < _SAME
    one, two = (_name(turn) for turn in turns)
    if so_far is None:
        above, below = "both ends", rf"$\Vert \log(R_1^T R_2) \Vert = {m.degrees(delta)}$"
    else:
        above, below = "both, so far", rf"${m.degrees(so_far)}$ apart"
    x, y = _BOTH
    return [
        m.title("two orders, the same end: they commute" if same else "two orders, different ends"),
        *m.legend([(m.FIRST, f"$R_1 = {two}\\, {one}$"), (m.SECOND, f"$R_2 = {one}\\, {two}$")], 62.0),
        scene.Label(above, (x, y + 172.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
        scene.Label(below, (x, y - 196.0, 0.0), style.MARK, style.SMALL_TEXT, anchor="cn"),
    ]
