"""The path of A(t) in SO(2) x Sym+(2), and the triangles on the way, for `triangle-interp`."""

import numpy as np

from lietool.lie import so2
from lietool.render import camera as cameras
from lietool.render import cone, ring, scene, style
from lietool.render.brackets import fixed
from lietool.render.camera import Box
from lietool.render.plane import Plane

from . import _triangle_map as maps
from . import _triangle_shape as shapes

_CIRCLE, _CONE = (24.0, 380.0, 440.0, 440.0), (480.0, 372.0, 696.0, 452.0)
_LEFT, _RIGHT = 244.0, 828.0
_ROW, _AXIS, _SAID = 262.0, 132.0, 32.0
# Where the letters stand, in radii of the circle, and by how much a turn after the first is farther out.
_OUTSIDE, _OPENING = 1.34, 0.12
# Nearer letters hide each other.
_CROWDED = 0.15
# Of the arc of the angle, and of the names on the moment's radius, in radii of the circle.
_ARC = 0.24
_BOLD = 1.6 * style.CURVE
# Over the largest stretch on the way, and how far the largest ellipse reaches, over the height of the view.
_HIGHER, _ELLIPSE, _LEAST = 1.24, 0.085, 0.035
FORMULAS = {
    "linear": r"A^L(t) = (1 - t)\,I + t\,A",
    "arap": r"A^P(t) = R_{t\theta}\,((1 - t)\,I + t\,S)",
    "logexp": r"A^E(t) = R_{t\theta}\,\exp(t\,\log S)",
    "matrix-log": r"A^t = \exp(t\,\log A)",
}


def picture(given: maps.Map, method: str, steps: int, beyond: float, t: float) -> scene.Picture:
    """Return the page of one method."""
    low, high = min(-beyond, t), max(1.0 + beyond, t)
    span = np.linspace(low, high, 241)
    # The cross stands in the middle of the gap between the names.
    page = [
        scene.Label(text, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, x in (
            (r"$\mathrm{SO}(2)$", _LEFT),
            (r"$\times$", (_LEFT + _RIGHT) / 2.0 - 11.0),
            (r"$\mathrm{Sym}^{+}(2)$", _RIGHT),
        )
    ]
    page += _circle(given, method, steps, span, t)
    page += _triangles(given, method, steps, beyond, t)
    return scene.Picture((_cone(given, method, steps, span, t, _CONE), scene.View(tuple(page))))


def color(method: str) -> tuple[str, str]:
    """Return the colours of the way of a method and of its text: straight lines are blue."""
    straight = method in ("linear", "arap")
    return (style.RIGHT, style.ALGEBRA_TEXT) if straight else (style.GROUP, style.GROUP_TEXT)


def _out(angles: np.ndarray) -> np.ndarray:
    """How far from the middle an angle is drawn: on the circle, in later turns farther out."""
    return 1.0 + _OPENING * np.maximum(np.abs(angles) / (2.0 * np.pi) - 1.0, 0.0)


def _circle(given: maps.Map, method: str, steps: int, span: np.ndarray, t: float) -> list[scene.Record]:
    inside, times = np.linspace(0.0, 1.0, 481), np.arange(steps + 1) / steps
    angles, on, beyond = (given.angles(method, s) for s in (times, np.array([t]), span))
    most = float(_out(np.concatenate([angles, on, beyond])).max())
    x, y, wide, high = _CIRCLE
    place = Plane((x + wide / 2.0, y + high / 2.0), min(wide, high) / 2.0 / (_OUTSIDE + 0.24 + most - 1.0))

    def at(angle: np.ndarray) -> np.ndarray:
        return _out(angle)[..., None] * ring.toward(angle)

    whole = given.angles(method, inside)
    fine = given.angles(method, np.linspace(span[0], span[-1], 721))
    found: list[scene.Record] = [
        scene.Surface(*ring.disc(place), style.GROUP, material="flat", alpha=0.05),
        place.circle((0.0, 0.0), 1.0, style.GROUP_TEXT, style.EDGE),
        place.line(at(fine), style.GROUP, style.CURVE),
        place.line(at(whole), style.GROUP, _BOLD),
        *_angle(place, float(whole[-1])),
    ]
    size = ring.size(_OUTSIDE * float(np.abs(np.diff(angles)).min()), 0.14)
    stages = style.stages(steps + 1)
    # Where they would hide each other, only the last stands, or that and the first.
    apart = _OUTSIDE * np.abs(angles - angles[-1])
    shown = np.full(steps + 1, bool(_OUTSIDE * np.abs(np.diff(angles)).min() >= _CROWDED))
    shown[[0, -1]] = apart[0] >= _CROWDED, True
    for angle, (fill, edge), stand in zip(angles, stages, shown, strict=True):
        if not stand:
            continue
        foot, stands = at(angle), (_OUTSIDE - 1.0 + _out(angle)) * ring.toward(angle)
        found += ring.held(place, foot, stands, so2.exp(angle), size, fill, edge)
    found += [
        place.dots([(0.0, 0.0)], style.INK, 5.0),
        place.dots(at(angles), style.GROUP, 7.0),
        scene.Points(place.at(at(on)), style.GROUP, 12.5, rim=style.PAPER),
        place.beyond("$R(t)$", at(on)[0], -at(on)[0], color=style.GROUP_TEXT, gap=52.0, room=72.0),
    ]
    for angle, name, k in ((0.0, "$I$", 0.0), (float(angles[-1]), "$R$", 1.0)):
        if abs(t - k) > 0.12 and (k == 0.0 or abs(angle) > 0.2):
            foot = at(np.array(angle))
            # Beside its radius, on the side away from the arc of the angle.
            aside = np.array([-foot[1], foot[0]]) * (1.0 if k else -1.0) * (1.0 if whole[-1] >= 0.0 else -1.0)
            found.append(place.beyond(name, foot, 0.8 * aside - foot, gap=36.0, room=50.0))
    return found


def _angle(place: Plane, angle: float) -> list[scene.Record]:
    """The radii to I and to R, and between them the arc of the angle with its value."""
    # The letters' circle begins at its lowest point.
    start, middle, end = -np.pi / 2.0, np.zeros(2), ring.toward(angle)
    value = rf"{round(np.degrees(angle), 1) + 0.0:.1f}^{{\circ}}"
    away = -ring.toward(0.5 * np.clip(angle, -np.pi, np.pi))
    # Inside the circle, which is too narrow for the long text beside an upright radius.
    long = abs(float(away[0])) < 0.9
    text, gap = (rf"\theta = {value}", 24.0 + 44.0 * abs(float(away[0]))) if long else (value, 82.0)
    return [
        place.line(np.stack([middle, ring.toward(0.0)]), style.GROUP_TEXT, style.THIN),
        place.line(np.stack([middle, end]), style.GROUP_TEXT, style.THIN),
        *place.turn((0.0, 0.0), _ARC, start, angle, style.GROUP_TEXT, width=style.EDGE),
        place.beyond(f"${text}$", (0.0, 0.0), away, color=style.GROUP_TEXT, gap=gap, room=0.0),
    ]


def _cone(given: maps.Map, method: str, steps: int, span: np.ndarray, t: float, box: Box) -> scene.View:
    inside, times = np.linspace(0.0, 1.0, 61), np.arange(steps + 1) / steps
    path, way = given.stretches(method, span), given.stretches(method, inside)
    steps_at, marked = given.stretches(method, times), given.stretches(method, np.array([t]))
    points = cone.drawn(way)
    height = _HIGHER * float(points[:, 2].max())
    across = _across(given.S)
    straight = cone.drawn(path)
    straight = straight[(straight[:, 2] >= 0.0) & (straight[:, 2] <= height)]
    camera = cameras.around(np.concatenate([cone.rim(height), straight]), cone.before(across), box, 1.04)
    main, text = color(method)
    good = np.linalg.eigvalsh(path)[:, 0] > 0.0
    shown = cone.drawn(path)
    shown[(shown[:, 2] > height) | (shown[:, 2] < 0.0)] = np.nan
    ways = cone.drawn(steps_at)
    gaps = np.linalg.norm(np.diff(ways, axis=0), axis=-1)
    apart, least = float(gaps.max()), float(gaps.min())
    part = 0.5 * least / camera.height if least > 1e-9 else _ELLIPSE
    size = float(np.clip(part, _LEAST, _ELLIPSE)) * camera.height
    size /= float(np.abs(np.linalg.eigvalsh(steps_at)).max())
    exits = given.exits(method)
    exits = exits[(exits > span[0]) & (exits < span[-1])]
    leaves = cone.drawn(given.stretches(method, exits))
    stands = np.abs(times - t) > 1e-9
    stages = style.stages(steps + 1)
    records = [
        *cone.glass(camera, height),
        *cone.section(camera, across, height, style.GROUP),
        scene.Lines(np.where(good[:, None], shown, np.nan), main, style.CURVE),
        scene.Lines(np.where(_with_neighbours(~good)[:, None], shown, np.nan), style.WRONG, style.CURVE),
        *cone.crosses(camera, leaves[(leaves[:, 2] >= 0.0) & (leaves[:, 2] < height)]),
        *([] if apart < 1e-9 else [scene.Lines(points, main, 2.0 * style.CURVE, lift=0.03)]),
        *cone.ellipses(
            camera, steps_at[stands], size, tuple(s for s, k in zip(stages, stands, strict=True) if k), 1.0
        ),
        *cone.ellipses(camera, marked, size, ((style.PAPER, main),), 1.0),
        scene.Points(ways, main, 7.0),
        scene.Points(cone.drawn(marked), main, 12.5, rim=style.PAPER),
        scene.Label("$0$", np.zeros(3), style.INK, style.SMALL_TEXT, (0.0, -12.0), "ct"),
        *_names(given, t),
        scene.Label("$S(t)$", cone.drawn(marked[0]), text, offset=(0.0, -20.0), anchor="ct", room=30.0),
    ]
    return scene.View(tuple(records), camera, box)


def _with_neighbours(where: np.ndarray) -> np.ndarray:
    """The points of a line that belong to a piece one end of which is marked."""
    more = where.copy()
    more[1:] |= where[:-1]
    more[:-1] |= where[1:]
    return more


def _across(S: np.ndarray) -> np.ndarray:
    """The direction (2,) in which the plane through the axis and S lies; any where S is on the axis."""
    x, y, _ = cone.drawn(S)
    length = float(np.hypot(x, y))
    return np.array([1.0, 0.0]) if length < 1e-9 else np.array([x, y]) / length


def _names(given: maps.Map, t: float) -> list[scene.Record]:
    """The names of the ends, across from their ellipses."""
    return [
        scene.Label(name, cone.drawn(S), style.INK, offset=(aside, -18.0), anchor="ct", room=30.0)
        for S, name, k, aside in ((np.eye(2), "$I$", 0.0, -12.0), (given.S, "$S$", 1.0, 0.0))
        if abs(t - k) > 0.12
    ]


def _triangles(given: maps.Map, method: str, steps: int, beyond: float, t: float) -> list[scene.Record]:
    """The triangles on the way over a line of time, that of the moment outlined, and how it is made."""
    times = shapes.moments(steps, beyond)
    line = shapes.Strip(140.0, 1082.0, min(times[0], t), max(times[-1], t))
    shape = shapes.Shape.of(given)
    A, now = given.at(method, times), given.at(method, t)
    scale = line.scale(shape, [A], times, 172.0)
    if not times[0] <= t <= times[-1]:
        wide, high = shape.extent(now)
        scale = min(scale, 84.0 / float(wide), 86.0 / float(high))
    main, text = color(method)
    det = float(np.linalg.det(now))
    if det <= 0.0:
        main = text = style.WRONG
    said = rf"${FORMULAS[method]},\ \ t = {fixed(t)}\mathrm{{:}}\ \ \mathrm{{det}} = {fixed(det)}$"
    x = float(line.x(t))
    top = _ROW + scale * float((shape.corners @ now.T)[:, 1].max())
    return [
        *line.row(shape, A, times, _ROW, scale),
        *line.axis(_AXIS, times),
        *_singular(given, method, line),
        *shape.draw(now, (x, _ROW), scale, (style.PAPER, main), width=style.CURVE),
        scene.Label("$A(t)$", (x, top, 0.0), text, offset=(0.0, 14.0), anchor="cb", room=0.0),
        scene.Points([(x, _AXIS, 0.0)], main, 12.5, rim=style.PAPER),
        scene.Label(said, (600.0, _SAID, 0.0), text, style.SMALL_TEXT, anchor="cn"),
    ]


def _singular(given: maps.Map, method: str, line: shapes.Strip) -> list[scene.Record]:
    """On the line of time, where the determinant is 0 or less."""
    span = np.linspace(line.start, line.stop, 481)
    wrong = _with_neighbours(np.linalg.det(given.at(method, span)) <= 0.0)
    x = np.where(wrong, line.x(span), np.nan)
    records: list[scene.Record] = []
    if wrong.any():
        records.append(
            scene.Lines(np.stack([x, 0.0 * x + _AXIS, 0.0 * x], axis=-1), style.WRONG, style.CURVE)
        )
    for exit in given.exits(method):
        if line.start <= exit <= line.stop:
            records += shapes.cross((float(line.x(exit)), _AXIS))
    return records
