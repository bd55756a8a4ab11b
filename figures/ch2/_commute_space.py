"""`commute` for two rotations of space: one start, two orders, two ends, and the turn between the ends."""

import numpy as np

from lietool.figure import Drawing
from lietool.lie import so3
from lietool.render import letter as shape
from lietool.render import plane, scene, style
from lietool.render.camera import Camera
from lietool.render.marks import LETTER, LETTER_BEFORE, beyond, coordinate_axes, curved_arrow, letter
from lietool.render.solids import fan_faces, frame_along

from . import _motions as m

_BETWEEN = (style.BETWEEN, style.GREYS[1], style.BONE)
_OTHER = (style.ROUTE_2, style.ROUTE_2, style.ROUTE_2)
# Middles of the cells and their sides: start, the columns and rows of the two ways, both ends together.
_SIDE, _HEIGHT = 330.0, 2.0
_START, _BOTH, _LARGE = (146.0, 450.0), (978.0, 462.0), 460.0
_COLUMNS, _ROWS = (398.0, 670.0), (632.0, 278.0)
# Arrows run a little above the middles, clear of an x axis that comes towards the viewer.
_LEVEL, _BEND = 44.0, 50.0
_WAYS = (m.FIRST, m.SECOND)
_EYE = (1.0, 0.62, 0.46)
# How far axes and frames reach, and the rings on which angles are drawn, the solid being 1 high.
_AXIS, _FRAME, _RING = 0.92, 0.68, 0.42
# The line of sight and the axis of the turn between both ends enclose about this, so that the turn is seen.
_OBLIQUE, _HEIGHTS = np.deg2rad(28.0), np.deg2rad(np.arange(15, 41, 5))
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
    views = [_cell(_START, _given())]
    for k, y in enumerate(_ROWS):
        for j, x in enumerate(_COLUMNS):
            views.append(_cell((x, y), _step(orders[k][j], now[k], j, done[j], _WAYS[k].text)))
    large = (_BOTH[0] - _LARGE / 2.0, _BOTH[1] - _LARGE / 2.0, _LARGE, _LARGE)
    eye = _eye(stages[0, 1], stages[1, 1])
    views.append(scene.View(tuple(_both(now[0, 1], now[1, 1], eye)), eye, large))
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


def _given() -> list[scene.Record]:
    """The solid at the start, its frame, and the axes of space, which stay."""
    return [
        *letter(np.eye(3), colors=LETTER_BEFORE),
        scene.Frame(np.eye(3), length=_FRAME, radius=0.016),
        *coordinate_axes(_camera(), ("$x$", "$y$", "$z$"), _AXIS),
    ]


def _eye(one: np.ndarray, two: np.ndarray) -> Camera:
    """From where the turn between two ends is seen: obliquely along its axis, and both fronts in view."""
    axis, delta = _between(one, two)
    if delta < _SAME:
        return _camera()
    around, up = (np.ravel(grid) for grid in np.meshgrid(np.deg2rad(np.arange(-60, 121, 5)), _HEIGHTS))
    eyes = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    fronts = eyes @ (one[:, 0] + two[:, 0]) / 2.0
    best = int(np.argmax(np.round(fronts - 2.0 * np.abs(np.abs(eyes @ axis) - np.cos(_OBLIQUE)), 9)))
    return Camera(tuple(eyes[best].tolist()), (0.0, 0.0, 0.0), _HEIGHT)


def _between(one: np.ndarray, two: np.ndarray) -> tuple[np.ndarray, float]:
    """The axis, in space, and the angle of the turn that leads from one end to the other."""
    difference = so3.log(two @ one.T)
    delta = float(np.linalg.norm(difference))
    return (difference / delta if delta >= _SAME else np.array([0.0, 0.0, 1.0])), delta


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
    return [
        scene.Lines(center + whole @ frame[:, :2].T, color, style.HAIR, 0.5),
        scene.Surface(fan, fan_faces(len(fan)), color, material="flat", alpha=0.30),
        *curved_arrow(fan[1:], color, 0.017, 2.9),
    ]


def _both(one: np.ndarray, two: np.ndarray, camera: Camera) -> list[scene.Record]:
    """Both ends in one place, the second translucent; and the turn that leads from the first to it."""
    axis, delta = _between(one, two)
    if delta < _SAME:
        return [*letter(one), scene.Frame(one, length=_FRAME, radius=0.016)]
    return [
        *letter(one),
        *letter(two, colors=_OTHER, alpha=0.42),
        *(
            scene.Lines(record.points, style.ROUTE_2_TEXT, style.THIN, lift=0.004)
            for record in letter(two)
            if isinstance(record, scene.Lines)
        ),
        scene.Arrow(-_AXIS * axis, _AXIS * axis, style.MARK, 0.010),
        *_corner_turned(one, axis, delta, camera),
    ]


def _corner_turned(one: np.ndarray, axis: np.ndarray, delta: float, camera: Camera) -> list[scene.Record]:
    """The arc on which a corner of the first solid goes to the same corner of the second, and its angle."""
    corners = shape.solid()[0] @ one.T
    outward = corners - np.outer(corners @ axis, axis)
    # Far from the axis, so that the arc is long, and halfway on the viewer's side of the solid.
    middle = so3.exp(0.5 * delta * axis)
    score = np.linalg.norm(outward, axis=-1) + 0.5 * (corners @ middle.T) @ camera.axes[2]
    best = int(np.argmax(np.round(score, 9)))
    center, start = corners[best] - outward[best], outward[best]
    across = np.cross(axis, start)
    angles = np.linspace(0.0, delta, max(round(delta / 0.05), 2) + 1)
    rim = center + np.outer(np.cos(angles), start) + np.outer(np.sin(angles), across)
    whole = np.linspace(0.0, 2.0 * np.pi, 121)
    ring = center + np.outer(np.cos(whole), start) + np.outer(np.sin(whole), across)
    fan = np.concatenate([[center], rim])
    return [
        scene.Lines(ring, style.MARK, style.HAIR, 0.6),
        scene.Surface(fan, fan_faces(len(fan)), style.MARK, material="flat", alpha=0.30),
        scene.Lines(np.stack([rim[0], center, rim[-1]]), style.MARK, style.EDGE, lift=0.02),
        *curved_arrow(rim, style.MARK, 0.014, 2.9),
        scene.Points(rim[[0, -1]], style.MARK, 5.0),
        beyond("$R_1$", rim[0], rim[0] - rim[-1], camera, color=m.FIRST.text, gap=30.0, room=50.0),
        beyond("$R_2$", rim[-1], rim[-1] - rim[0], camera, color=m.SECOND.text, gap=30.0, room=50.0),
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
        above, below = "both ends", rf"angle of $R_1^T R_2 = {m.degrees(delta)}$"
    else:
        above, below = "both, so far", rf"${m.degrees(so_far)}$ apart"
    x, y = _BOTH
    return [
        m.title("two orders, the same end: they commute" if same else "two orders, different ends"),
        *m.legend([(m.FIRST, f"$R_1 = {two}\\, {one}$"), (m.SECOND, f"$R_2 = {one}\\, {two}$")], 62.0),
        scene.Label(above, (x, y + 205.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
        scene.Label(below, (x, y - 222.0, 0.0), style.MARK, style.SMALL_TEXT, anchor="cn"),
    ]
