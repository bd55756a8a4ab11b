"""The page of figure 4 of Kaji and Ochiai: three ways through the same keys, and det over time."""

from dataclasses import dataclass, replace

import numpy as np

from lietool.deform import pose
from lietool.render import mesh_look, mesh_page, scene, style
from lietool.render.camera import Box, Camera
from lietool.render.plot import Axes

from ._pose_keys import Given

_DIRECTION = (0.3, -1.0, 0.3)
_AREA = (30.0, 292.0, 1140.0, 532.0)
_PLOT = (150.0, 88.0, 930.0, 124.0)
# A column is wider than what is seen in it by this, and at least as wide as its texts.
_WIDER, _LEAST = 1.08, 326.0
_TITLES = {
    "phi_so": r"$\varphi\ (\mathbf{x}, \mathbf{l}, Y)$",
    "phi_se": r"$\varphi\ (\hat{X}, Y)$",
    "alexa": r"$\mathrm{matrix\ logarithm}$",
    "linear": r"$\mathrm{matrices}$",
}
# Colours of the curves, and dashes that tell them apart without colour.
_CURVES = (
    (style.ROUTE_1, style.ROUTE_1_TEXT, None),
    (style.ROUTE_2, style.ROUTE_2_TEXT, (13.0, 7.0)),
    (style.MARK, style.MARK, (4.0, 4.0)),
)
# Points of the way of the centre, and directions in which a shape is measured.
_BETWEEN, _OUTER = 121, 200


@dataclass(frozen=True, eq=False)
class Row:
    """One way of joining the keys; without a path, and why, where it has none."""

    name: str
    path: pose.Path | None
    measure: pose.Measure | None
    t: np.ndarray
    det: np.ndarray
    why: str

    @property
    def inside_out(self) -> float:
        """The part of the time during which det <= 0, to a hundredth."""
        return round(float(np.mean(self.det <= 0.0)), 2) if len(self.det) else 0.0


@dataclass(frozen=True, eq=False)
class Shown:
    """A shape, its keys, the ways through them, how many poses between them, and a moment."""

    V: np.ndarray
    F: np.ndarray
    N: np.ndarray
    given: Given
    rows: tuple[Row, ...]
    frames: int
    now: float

    @property
    def moments(self) -> np.ndarray:
        """The times of the poses between the keys."""
        t = self.given.times
        part = np.arange(1, self.frames + 1) / (self.frames + 1.0)
        return (t[:-1, None] + np.diff(t)[:, None] * part).ravel()


def picture(s: Shown) -> scene.Picture:
    """Return the page."""
    few = _outer(s.V)
    seen = [np.concatenate([_moved(A, few) for A in _poses(s, row)[0]]) for row in s.rows]
    boxes = _columns(seen)
    cameras = mesh_page.each(seen, _DIRECTION, boxes, 1.04)
    views = []
    for row, camera, box in zip(s.rows, cameras, boxes, strict=True):
        views += [scene.View(tuple(rs), camera, box) for rs in (_shapes(s, row, camera), _way(s, row)) if rs]
    names = zip(mesh_page.titles(boxes, [_TITLES[row.name] for row in s.rows]), _CURVES, strict=True)
    texts = [
        *(replace(label, color=text) for label, (_, text, _) in names),
        *mesh_page.captions(boxes, [_caption(row) for row in s.rows]),
    ]
    return scene.Picture((*views, scene.View((*texts, *_plot(s)))))


def _columns(seen: list[np.ndarray]) -> list[Box]:
    """Boxes side by side, as wide as what is seen in them in one scale, and as texts need."""
    sides = np.array([np.ptp(points @ Camera(_DIRECTION).axes[:2].T, axis=0) for points in seen])
    left, low, width, height = _AREA
    scale = height / max(float(sides[:, 1].max()), 1e-9)
    while np.maximum(wide := _WIDER * scale * sides[:, 0], _LEAST).sum() > width:
        scale *= 0.98
    wide = np.maximum(wide, _LEAST)
    wide += (width - wide.sum()) / len(wide)
    starts = left + np.cumsum(wide) - wide
    return [(float(x), low, float(w), height) for x, w in zip(starts, wide, strict=True)]


def _outer(V: np.ndarray) -> np.ndarray:
    """Points of a shape that are the outermost in many directions: as large in a picture as the whole."""
    k = np.arange(_OUTER) + 0.5
    height, turn = 1.0 - 2.0 * k / _OUTER, np.pi * (1.0 + np.sqrt(5.0)) * k
    wide = np.sqrt(1.0 - height**2)
    ways = np.stack([wide * np.cos(turn), wide * np.sin(turn), height], axis=1)
    return V[np.unique(np.argmax(V @ ways.T, axis=0))]


def _moved(A: np.ndarray, V: np.ndarray) -> np.ndarray:
    return V @ A[:3, :3].T + A[:3, 3]


def _poses(s: Shown, row: Row) -> tuple[np.ndarray, np.ndarray]:
    """Poses (f, 4, 4) and what each is: 0 a key, 1 between, 2 at the moment."""
    keys = s.given.A
    if row.path is None:
        return keys, np.zeros(len(keys), int)
    apart = 0.4 * np.diff(s.given.times).min() / (s.frames + 1.0)
    between = s.moments[np.abs(s.moments - s.now) > apart]
    # At a key the key itself is shown, unless the curve passes it by.
    A = [keys, pose.evaluate(row.path, between), pose.evaluate(row.path, [s.now])]
    return np.concatenate(A), np.repeat([0, 1, 2], [len(part) for part in A])


_LOOKS = (
    (style.AFTER, style.AFTER_EDGE),
    (style.BETWEEN, style.BETWEEN_EDGE),
    (style.SHELLS[0], style.ALGEBRA_TEXT),
)


def _shapes(s: Shown, row: Row, camera: Camera) -> list[scene.Record]:
    records: list[scene.Record] = []
    for A, kind in zip(*_poses(s, row), strict=True):
        det = float(np.linalg.det(A[:3, :3]))
        X, F = _moved(A, s.V), s.F if det > 0.0 else s.F[:, ::-1]
        # By the cofactors, which exist where the inverse does not.
        L = A[:3, :3]
        N = s.N @ np.stack([np.cross(L[1], L[2]), np.cross(L[2], L[0]), np.cross(L[0], L[1])]).T
        length = np.linalg.norm(N, axis=1, keepdims=True)
        N = N / np.where(length > 0.0, length, 1.0)
        fill, edge = _LOOKS[kind] if det > 0.0 else (style.WRONG, style.INK)
        records += mesh_look.surface(X, F, fill, normals=N)
        records += mesh_look.outline(X, F, camera, edge, 1.6)
    return records


def _way(s: Shown, row: Row) -> list[scene.Record]:
    """The way of the centre, over the shapes."""
    if row.path is None:
        return []
    t = np.linspace(*row.path.ends, _BETWEEN)
    way = np.array([_moved(A, s.given.centre) for A in pose.evaluate(row.path, t)])
    keys = np.array([_moved(A, s.given.centre) for A in s.given.A])
    return [scene.Lines(way, style.INK, style.THIN, 0.75), scene.Points(keys, style.INK, 4.5, shaded=False)]


def _caption(row: Row) -> str:
    if row.measure is None:
        return r"$\mathrm{no\ real\ logarithm}$"
    if row.measure.is_degenerate:
        return rf"$\det A \leq 0\ \mathrm{{in}}\ {max(round(100.0 * row.inside_out), 1)}\%\ \mathrm{{of}}\ t$"
    spin = f"{row.measure.spin:.2f}" if np.isfinite(row.measure.spin) else r"\infty"
    return rf"$\mathrm{{spin}}\ {spin},\ \ \det A \geq {row.measure.least_det:.2f}$"


def _plot(s: Shown) -> list[scene.Record]:
    """det A over t."""
    dets = np.concatenate([row.det for row in s.rows if row.path is not None])
    top, low = max(1.1 * float(dets.max()), 1.2), min(1.1 * float(dets.min()), -0.15)
    times = s.given.times
    axes = Axes(_PLOT, (float(times[0]), float(times[-1])), (low, top))
    marks = [(0.0, "$0$"), (1.0, "$1$")] if top < 4.0 and low > -4.0 else [(0.0, "$0$")]
    ticks = [(float(t), f"${t:g}$") for t in times]
    records = axes.frame(ticks, marks, "$t$")
    records.append(
        scene.Label(
            r"$\det A$", axes.at(times[0], (low + top) / 2.0), style.INK, style.SMALL_TEXT, (-80.0, 0.0)
        )
    )
    for row, (color, _, dash) in zip(s.rows, _CURVES, strict=True):
        if row.path is not None:
            records.append(axes.curve(row.t, row.det, color, style.CURVE, dash))
    records.append(axes.vertical(s.now, style.ALGEBRA))
    return records
