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

_CIRCLE, _CONE = (20.0, 336.0, 500.0, 490.0), (545.0, 346.0, 640.0, 480.0)
_LEFT, _CROSS, _RIGHT = 270.0, 525.0, 865.0
_ROW, _AXIS, _SAID, _NOW = 238.0, 138.0, 40.0, (556.0, 416.0)
# Where the letters stand, in radii of the circle, and by how much a turn after the first is farther out.
_OUTSIDE, _OPENING = 1.34, 0.12
# Nearer letters hide each other.
_CROWDED = 0.15
_BOLD = 1.6 * style.CURVE
FORMULAS = {
    "linear": r"A^L(t) = (1 - t)\,I + t\,A",
    "arap": r"A^P(t) = R_{t\theta}\,((1 - t)\,I + t\,S)",
    "logexp": r"A^E(t) = R_{t\theta}\,\exp(t\,\log S)",
    "matrix-log": r"\exp(t\,\log A)",
}


def picture(given: maps.Map, method: str, steps: int, beyond: float, t: float) -> scene.Picture:
    """Return the page of one method."""
    low, high = min(-beyond, t), max(1.0 + beyond, t)
    span = np.linspace(low, high, 241)
    page = [
        scene.Label(text, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for text, x in (
            (r"$\mathrm{SO}(2)$", _LEFT),
            (r"$\times$", _CROSS),
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
    place = Plane((x + wide / 2.0, y + high / 2.0), min(wide, high) / 2.0 / (_OUTSIDE + 0.26 + most - 1.0))

    def at(angle: np.ndarray) -> np.ndarray:
        return _out(angle)[..., None] * ring.toward(angle)

    whole = given.angles(method, inside)
    fine = given.angles(method, np.linspace(span[0], span[-1], 721))
    found: list[scene.Record] = [
        scene.Surface(*ring.disc(place), style.GROUP, material="flat", alpha=0.05),
        place.circle((0.0, 0.0), 1.0, style.GROUP_TEXT, style.EDGE),
        place.line(at(fine), style.GROUP, style.CURVE),
        place.line(at(whole), style.GROUP, _BOLD),
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
        *_held_mark(place, at(on)[0]),
        _said(place, given, method),
        place.beyond("$R(t)$", at(on)[0], -_on_axis(at(on)[0]), color=style.GROUP_TEXT, gap=44.0, room=70.0),
    ]
    for angle, name, k in ((0.0, "$I$", 0.0), (float(angles[-1]), "$R$", 1.0)):
        if abs(t - k) > 0.08 and (k == 0.0 or abs(angle) > 0.2):
            foot = at(np.array(angle))
            found.append(place.beyond(name, foot, -foot, gap=32.0, room=50.0))
    return found


def _on_axis(point: np.ndarray) -> np.ndarray:
    """Return a direction, upwards where there is none."""
    return point if np.linalg.norm(point) > 1e-9 else np.array([0.0, -1.0])


def _held_mark(place: Plane, at: np.ndarray) -> list[scene.Record]:
    return [scene.Points(place.at([at]), style.GROUP, 12.5, rim=style.PAPER)]


def _said(place: Plane, given: maps.Map, method: str) -> scene.Label:
    angle = float(given.angles(method, np.array([1.0]))[0])
    text = rf"$\theta = {round(np.degrees(angle), 1) + 0.0:.1f}^{{\circ}}$"
    return place.beyond(text, (0.0, 0.0), (0.0, 1.0), color=style.GROUP_TEXT, gap=34.0, room=0.0)


def _cone(given: maps.Map, method: str, steps: int, span: np.ndarray, t: float, box: Box) -> scene.View:
    inside, times = np.linspace(0.0, 1.0, 61), np.arange(steps + 1) / steps
    path, way = given.stretches(method, span), given.stretches(method, inside)
    steps_at, marked = given.stretches(method, times), given.stretches(method, np.array([t]))
    points = cone.drawn(way)
    height = 1.16 * float(points[:, 2].max())
    camera = cameras.around(np.concatenate([cone.rim(height), points]), _direction(given.S), box, 1.10)
    main, text = color(method)
    good = np.linalg.eigvalsh(path)[:, 0] > 0.0
    shown = cone.drawn(path)
    shown[(shown[:, 2] > height) | (np.linalg.norm(shown[:, :2], axis=-1) > 1.12 * height)] = np.nan
    shown[shown[:, 2] < 0.0] = np.nan
    apart = float(np.linalg.norm(np.diff(cone.drawn(steps_at), axis=0), axis=-1).max())
    least = float(np.linalg.norm(np.diff(cone.drawn(steps_at), axis=0), axis=-1).min())
    size = float(np.clip(0.5 * least, 0.03 * camera.height, 0.085 * camera.height))
    size /= float(np.abs(np.linalg.eigvalsh(steps_at)).max())
    side = 1.0 if method in ("linear", "arap") else -1.0
    # Beside the ellipse of the moment, which hangs on a stem.
    wide, high = size * np.linalg.norm(marked[0], axis=-1) * box[3] / camera.height
    beside = (-float(wide) - 12.0, -side * (box[3] * cone.STEM + float(high)))
    exits = given.exits(method)
    exits = exits[(exits > span[0]) & (exits < span[-1])]
    leaves = cone.drawn(given.stretches(method, exits))
    records = [
        *cone.glass(camera, height),
        scene.Lines(np.where(good[:, None], shown, np.nan), main, style.EDGE),
        scene.Lines(np.where(_with_neighbours(~good)[:, None], shown, np.nan), style.WRONG, style.EDGE),
        *cone.crosses(camera, leaves[(leaves[:, 2] >= 0.0) & (leaves[:, 2] < height)]),
        *([] if apart < 1e-9 else [scene.Tube(points, main, 0.0065 * camera.height)]),
        *cone.ellipses(camera, steps_at, size, style.stages(steps + 1), side),
        *cone.ellipses(camera, marked, size, ((style.PAPER, main),), -side),
        scene.Points(cone.drawn(steps_at), main, 7.0),
        scene.Points(cone.drawn(marked), main, 12.5, rim=style.PAPER),
        scene.Label("$0$", np.zeros(3), style.INK, style.SMALL_TEXT, (0.0, -12.0), "ct"),
        *_names(given, t, side),
        scene.Label("$S(t)$", cone.drawn(marked[0]), text, offset=beside, anchor="rc", room=60.0),
    ]
    return scene.View(tuple(records), camera, box)


def _with_neighbours(where: np.ndarray) -> np.ndarray:
    """The points of a line that belong to a piece one end of which is marked."""
    more = where.copy()
    more[1:] |= where[:-1]
    more[:-1] |= where[1:]
    return more


def _direction(S: np.ndarray) -> tuple[float, float, float]:
    """From where the way from I to S is seen from the side."""
    x, y, _ = cone.drawn(S)
    if np.hypot(x, y) < 1e-9:
        return (0.42, -1.0, 0.54)
    angle = np.arctan2(y, x) - np.pi / 2.0
    return (float(np.cos(angle)), float(np.sin(angle)), 0.50)


def _names(given: maps.Map, t: float, side: float) -> list[scene.Record]:
    """The names of the ends, across from their ellipses, which are above (1) or below (-1) them."""
    upright = "t" if side > 0.0 else "b"
    return [
        scene.Label(
            name,
            cone.drawn(S),
            style.INK,
            offset=(-8.0 if across == "r" else 0.0, -18.0 * side),
            anchor=across + upright,
            room=60.0,
        )
        for S, name, k, across in ((np.eye(2), "$I$", 0.0, "r"), (given.S, "$S$", 1.0, "c"))
        if abs(t - k) > 0.08
    ]


def _triangles(given: maps.Map, method: str, steps: int, beyond: float, t: float) -> list[scene.Record]:
    """The triangles on the way over a line of time, that of the moment, and in words how it is made."""
    times = shapes.moments(steps, beyond)
    line = shapes.Strip(100.0, 1086.0, min(times[0], t), max(times[-1], t))
    shape = shapes.Shape.of(given)
    A, now = given.at(method, times), given.at(method, t)
    film = given.at(method, np.linspace(min(t, 0.0), max(t, 1.0), 61))
    scale = line.scale(shape, [A], times, 156.0)
    large = 76.0 / float(shape.extent(film).max())
    main, text = color(method)
    det = float(np.linalg.det(now))
    if det <= 0.0:
        main = text = style.WRONG
    said = rf"${FORMULAS[method]},\ \ t = {fixed(t)}\mathrm{{:}}\ \ \mathrm{{det}} = {fixed(det)}$"
    return [
        *line.row(shape, A, times, _ROW, scale),
        *line.axis(_AXIS),
        *shape.draw(now, _NOW, large, (style.PAPER, main)),
        scene.Label("$A(t)$", (_NOW[0], _NOW[1] + 88.0, 0.0), text, anchor="cb"),
        scene.Points([(float(line.x(t)), _AXIS, 0.0)], main, 12.5, rim=style.PAPER),
        scene.Label(said, (600.0, _SAID, 0.0), text, style.SMALL_TEXT, anchor="cn"),
    ]
