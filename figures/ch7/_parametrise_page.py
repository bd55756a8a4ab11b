"""The page of figure 7.1: the three steps of phi above, the three parameters below."""

from collections.abc import Sequence

import numpy as np

from lietool.render import letter as shape
from lietool.render import marks, mesh_look, scene, solids, style
from lietool.render.camera import Camera, around
from lietool.render.globe import globe, joined
from lietool.render.mesh_page import each
from lietool.render.plot import number

from . import _parametrise_words as words
from ._parametrise_shown import NOTHING, Shown

_DIRECTION = (1.0, 0.5, 0.34)
_COLUMNS = ((196.0, 240.0), (446.0, 340.0), (780.0, 396.0))
_UPPER = tuple((x, 458.0, w, 366.0) for x, w in _COLUMNS)
_LOWER = tuple((x, 164.0, w, 284.0) for x, w in _COLUMNS)
_BALL, _SMALL = np.pi, style.SMALL_TEXT
# Half of the axis of rotation, in heights of the letter; the axes of space beside l; where its ball has pi.
_AXIS, _SPACE, _RIM = 0.95, 0.9, 0
# Where the turn is drawn on the axis, beyond the letter, and its radius: up to half a turn, and beyond.
_OUT, _RADIUS = 1.14, (0.42, 0.3)
_LETTERS = {
    "rest": (style.BEFORE_EDGE, style.GREYS[1], style.BEFORE),
    "between": (style.BETWEEN_EDGE, style.GREYS[1], style.BETWEEN),
    "after": (style.ARC, style.GREYS[1], style.AFTER),
}


def pictures(shown: Sequence[Shown]) -> list[scene.Picture]:
    """Return a page for each of some parameters, such as the moments of a film, all seen in one way."""
    upper, lower = _upper(shown), _lower(shown)
    pages = []
    for s in shown:
        said = scene.View((*words.texts(s, _UPPER, _LOWER), *words.maps(s)))
        pages.append(scene.Picture((*_steps(s, upper), *_parameters(s, lower), said)))
    return pages


def _upper(shown: Sequence[Shown]) -> list[Camera]:
    """The cameras of the three steps, all in one scale."""
    corners = shape.solid()[0]
    seen: list[list[np.ndarray]] = [[], [], []]
    for s in shown:
        seen[0] += [corners, corners @ s.S.T]
        seen[1] += [corners @ s.S.T, corners @ (s.R @ s.S).T, *_ends(s), _reach(s)]
        seen[2] += [corners @ (s.R @ s.S).T, corners @ s.A[:3, :3].T + s.d, s.way, s.shift[None]]
    return each([np.concatenate(points) for points in seen], _DIRECTION, _UPPER, 1.1)


def _lower(shown: Sequence[Shown]) -> list[Camera]:
    """The cameras of the three parameters."""
    seen: list[list[np.ndarray]] = [
        [],
        [_BALL * np.eye(3), -_BALL * np.eye(3)],
        [np.zeros((1, 3)), _SPACE * np.eye(3)],
    ]
    for s in shown:
        factor = max(float(np.exp(s.logs.max())), 1.0)
        seen[0] += [factor * s.Q.T, -factor * s.Q.T, np.eye(3), -np.eye(3)]
        seen[1] += [s.x[None], s.back_x[None]]
        seen[2] += [s.shift[None], s.back_shift[None]]
    return [
        around(np.concatenate(points), _DIRECTION, box, 1.22)
        for points, box in zip(seen, _LOWER, strict=True)
    ]


def _steps(s: Shown, cameras: Sequence[Camera]) -> list[scene.View]:
    """The letter before and after each step."""
    zero, one = np.zeros(3), np.eye(3)
    records = [
        [*_ghost(one, zero), *_letter(s.S, zero, "between")],
        [*_ghost(s.S, zero), *_letter(s.R @ s.S, zero, "between"), *_turn(s, cameras[1])],
        [*_ghost(s.R @ s.S, zero), *_letter(s.R @ s.S, s.d, "after")],
    ]
    views = [
        scene.View(tuple(rows), camera, box)
        for rows, camera, box in zip(records, cameras, _UPPER, strict=True)
    ]
    # The ends of the way lie inside of the letters.
    return [*views, scene.View(tuple(_moved(s, cameras[2])), cameras[2], _UPPER[2])]


def _axis(s: Shown) -> np.ndarray:
    """The unit vector along x as a row (1, 3); z where there is no rotation."""
    theta = float(np.linalg.norm(s.x))
    return (s.x / theta if theta > NOTHING else np.array([0.0, 0.0, 1.0]))[None]


def _ends(s: Shown) -> tuple[np.ndarray, np.ndarray]:
    """The ends of what is drawn of the axis, each (1, 3): first the nearer, where the turn is."""
    u = _axis(s)
    near = u if u[0] @ np.array(_DIRECTION) >= 0.0 else -u
    return (_OUT + 0.16) * near, -_AXIS * near


def _reach(s: Shown) -> np.ndarray:
    """Points (n, 3) that the turn does not reach beyond, where it goes all round its axis."""
    center = _OUT / (_OUT + 0.16) * _ends(s)[0]
    far = _RADIUS[1] * max(1.0, 0.2 * float(np.linalg.norm(s.x)) / np.pi + 0.85)
    return center if np.linalg.norm(s.x) < np.pi else center + far * np.concatenate([np.eye(3), -np.eye(3)])


def _letter(M: np.ndarray, at: np.ndarray, look: str) -> list[scene.Record]:
    return marks.letter(M, at, colors=_LETTERS[look])


def _ghost(M: np.ndarray, at: np.ndarray) -> list[scene.Record]:
    """The letter as its edges alone."""
    corners, _, _ = shape.solid()
    placed = corners @ M.T + at
    n = len(placed) // 2
    rim = np.append(np.arange(n), 0)
    edges = joined(placed[rows] for rows in (rim, rim + n, *np.arange(2 * n).reshape(2, n).T))
    return [scene.Lines(edges, style.BEFORE_EDGE, style.HAIR)]


def _turn(s: Shown, camera: Camera) -> list[scene.Record]:
    """The axis, and the turn about it where it leaves the letter towards the viewer."""
    if np.linalg.norm(s.x) <= NOTHING:
        return []
    near, far = (end[0] for end in _ends(s))
    center = _OUT / (_OUT + 0.16) * near
    angle = float(np.linalg.norm(s.x))
    radius = _RADIUS[0] if angle < np.pi else _RADIUS[1]
    arc = mesh_look.turn(center, s.x, radius, camera, color=style.ALGEBRA_TEXT, text="")
    records: list[scene.Record] = [scene.Lines([far, near], style.ALGEBRA, style.THIN, dash=(9.0, 6.0)), *arc]
    turned = arc[0]
    if not isinstance(turned, scene.Tube):
        return records
    points = np.asarray(turned.points)
    start = points[0]
    if angle <= 2.0 * np.pi:
        stop = center + s.R @ (start - center)
        records.append(scene.Lines([start, center, stop], style.ALGEBRA_TEXT, style.HAIR))
    # Its name is at its middle, or below its beginning, where a long one has its free end.
    at = points[len(points) // 2] if angle < np.pi else start
    name = rf"${number(np.degrees(angle), 1)}^{{\circ}}$"
    color = style.ALGEBRA_TEXT
    records.append(marks.beyond(name, at, at - center, camera, color=color, gap=26.0, room=50.0))
    return records


def _moved(s: Shown, camera: Camera) -> list[scene.Record]:
    """The way of the origin to d, and l, along which it sets out."""
    way = s.way
    records: list[scene.Record] = [scene.Points([np.zeros(3)], style.INK, 6.0)]
    if s.map == "phi_se" and np.linalg.norm(s.shift) > NOTHING:
        records.append(scene.Arrow(np.zeros(3), s.shift, style.ALGEBRA, 0.016))
        records.append(
            marks.beyond(
                r"$\mathbf{l}$", s.shift, s.shift, camera, color=style.ALGEBRA_TEXT, gap=24.0, room=60.0
            )
        )
    if np.linalg.norm(s.d) > NOTHING:
        if s.map == "phi_so":
            records.append(scene.Arrow(np.zeros(3), s.d, style.ALGEBRA, 0.016))
            name = r"$\mathbf{l}$"
            records.append(
                marks.beyond(name, s.d, s.d, camera, color=style.ALGEBRA_TEXT, gap=24.0, room=60.0)
            )
        else:
            records += marks.curved_arrow(way, style.AFTER_EDGE, 0.02)
            middle = way[len(way) // 2]
            away = middle - (s.shift * (middle @ s.shift) / max(float(s.shift @ s.shift), 1e-12))
            name = r"$\mathbf{d}$"
            records.append(
                marks.beyond(name, middle, away, camera, color=style.ARC_TEXT, gap=24.0, room=60.0)
            )
    return records


def _parameters(s: Shown, cameras: Sequence[Camera]) -> list[scene.View]:
    """The three parameters."""
    built = zip((_stretch, _vector, _translation), cameras, _LOWER, strict=True)
    return [
        scene.View(tuple(records), camera, box)
        for build, camera, box in built
        for records in build(s, camera)
    ]


def _stretch(s: Shown, camera: Camera) -> list[list[scene.Record]]:
    """The image of the unit ball under exp(Y); over it the arrows from the ball to it, along the axes."""
    factors = np.exp(s.logs)
    V, F, N = solids.sphere(1.0, rings=40)
    normals = (N / factors) @ s.Q.T
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    egg = (V * factors) @ s.Q.T
    ball = scene.Lines(
        camera.sphere_outline(np.zeros(3), 1.0), style.BEFORE_EDGE, style.THIN, dash=(7.0, 6.0)
    )
    over: list[scene.Record] = [ball]
    for q, log in zip(s.Q.T, s.logs, strict=True):
        over.append(scene.Lines([-q, q], style.ALGEBRA, style.HAIR))
        if abs(log) <= NOTHING:
            over.append(scene.Points([-q, q], style.ALGEBRA, 5.0, shaded=False))
        for side in (q, -q) if abs(log) > NOTHING else ():
            over.append(scene.Arrow(side, np.exp(log) * side, style.ALGEBRA, 0.011 * camera.height, 2.2))
        # A name stands at the nearer end of its axis.
        near = q if q @ camera.axes[2] >= 0.0 else -q
        end = max(float(np.exp(log)), 1.0) * near
        text = f"${words.signed(float(log))}$"
        over.append(
            marks.beyond(text, end, near, camera, color=style.ALGEBRA_TEXT, size=_SMALL, gap=34.0, room=60.0)
        )
    return [[scene.Surface(egg, F, style.BETWEEN, normals, "soft")], over]


def _vector(s: Shown, camera: Camera) -> list[list[scene.Record]]:
    """The rotation vector, and the ball of the principal ones."""
    over: list[scene.Record] = [scene.Points([np.zeros(3)], style.INK, 5.0)]
    over += _given(s.x, r"$\mathbf{x}$", camera)
    if not s.same:
        over += _answered(s.back_x, s.x, r"$\mathbf{x}'$", camera)
    rim = camera.sphere_outline(np.zeros(3), _BALL)[_RIM]
    over.append(scene.Lines([np.zeros(3), rim], style.GLASS_EDGE, style.THIN))
    over.append(scene.Label(r"$\pi$", 0.62 * rim, style.GLASS_EDGE, _SMALL, (0.0, 20.0), room=40.0))
    return [globe(camera, _BALL, alpha=0.6), over]


def _translation(s: Shown, camera: Camera) -> list[list[scene.Record]]:
    """The translation part, beside the axes of space."""
    records: list[scene.Record] = []
    for axis, name in zip(np.eye(3), "xyz", strict=True):
        records.append(scene.Lines([np.zeros(3), _SPACE * axis], style.MUTED, style.THIN))
        records.append(
            marks.beyond(
                f"${name}$", _SPACE * axis, axis, camera, color=style.MUTED, size=_SMALL, gap=20.0, room=50.0
            )
        )
    records += [scene.Points([np.zeros(3)], style.INK, 5.0), *_given(s.shift, r"$\mathbf{l}$", camera)]
    if not s.same:
        records += _answered(s.back_shift, s.shift, r"$\mathbf{l}'$", camera)
    return [records]


def _given(v: np.ndarray, name: str, camera: Camera) -> list[scene.Record]:
    """A vector of the parameters."""
    if np.linalg.norm(v) <= NOTHING:
        return []
    label = marks.beyond(name, v, v, camera, color=style.ALGEBRA_TEXT, gap=26.0, room=60.0)
    return [scene.Arrow(np.zeros(3), v, style.ALGEBRA, 0.011 * camera.height), label]


def _answered(v: np.ndarray, given: np.ndarray, name: str, camera: Camera) -> list[scene.Record]:
    """The one that psi gives instead."""
    if np.linalg.norm(v - given) <= NOTHING:
        return []
    return [
        scene.Lines([np.zeros(3), v], style.MARK, style.CURVE, dash=(9.0, 6.0)),
        scene.Points([v], style.MARK, 8.0),
        scene.Label(name, v, style.MARK, style.TEXT, (32.0, 6.0), room=40.0),
    ]
