"""The page of figure 4 of Kaji and Ochiai: three ways through the same keys as strips, and det below."""

from dataclasses import dataclass

import numpy as np

from lietool.deform import pose
from lietool.render import mesh_look, mesh_page, scene, style
from lietool.render.camera import Camera, around
from lietool.render.plot import Axes

from ._pose_keys import Given

_DIRECTION = (0.3, -1.0, 0.3)
# Nearly without perspective: a pose looks the same wherever it stands in its strip.
_FOV = np.radians(1.0)
# The strips, from their lower edge to their upper; the plot, whose times are those of the strips; the ways.
_STRIPS, _GAP, _LEAST = (288.0, 866.0), 8.0, 150.0
_PLOT, _WAYS, _NAMES = (276.0, 122.0, 832.0, 122.0), (34.0, 104.0, 160.0, 150.0), 36.0
# A key is at most so high, and over the distance between two poses so wide.
_HIGH, _WIDE, _RIM = 150.0, 1.06, 5.0
_TITLES = {
    "phi_so": (r"$\varphi_{so}$",),
    "phi_se": (r"$\varphi_{se}$",),
    "alexa": (r"$\mathrm{matrix}$", r"$\mathrm{logarithm}$"),
    "linear": (r"$\mathrm{matrices}$",),
}
# Colours of the curves, and widths and dashes that tell them apart without colour where they coincide.
_CURVES = (
    (style.ROUTE_1, style.ROUTE_1_TEXT, 5.5, None),
    (style.ROUTE_2_TEXT, style.ROUTE_2_TEXT, 2.2, (13.0, 9.0)),
    (style.MARK, style.MARK, style.CURVE, (5.0, 4.0)),
)
# Points of the way of the centre, and directions in which a shape is measured.
_BETWEEN, _OUTER = 121, 200
_RULE = (style.RULE, style.HAIR)
# Curves of determinants that differ by less, over the height of the plot, are one to the eye.
_ALIKE = 0.02
# A name stands below a curve that is as far above 0, page units, or above it.
_CLEAR = 45.0


@dataclass(frozen=True, eq=False)
class Row:
    """One way of joining the keys; without a path, and why, where it has none."""

    name: str
    path: pose.Path | None
    measure: pose.Measure | None
    t: np.ndarray
    det: np.ndarray
    ratio: float
    why: str

    @property
    def inside_out(self) -> float:
        """The part of the time during which det <= 0, to a hundredth."""
        return round(float(np.mean(self.det <= 0.0)), 2) if len(self.det) else 0.0

    @property
    def flat(self) -> np.ndarray:
        """The times at which det changes its sign."""
        k = np.flatnonzero((self.det[:-1] > 0.0) != (self.det[1:] > 0.0))
        part = self.det[k] / (self.det[k] - self.det[k + 1])
        return self.t[k] + part * (self.t[k + 1] - self.t[k])


@dataclass(frozen=True, eq=False)
class Shown:
    """A shape, its keys, the ways through them, how many poses between them, and a moment.

    `asked` is the largest ratio of stretches of a key, `meets` whether the ways pass through all of them,
    `stand` (3, 3) turns what is upwards in the shape's file upwards on the page; `painted` (n, 4) are colours
    of the shape's own, in which keys and the moment are drawn: their outlines still say which is which.
    """

    V: np.ndarray
    F: np.ndarray
    N: np.ndarray
    given: Given
    rows: tuple[Row, ...]
    frames: int
    now: float
    asked: float
    meets: bool
    stand: np.ndarray
    painted: np.ndarray | None = None

    @property
    def step(self) -> float:
        """The least time between two poses that are shown."""
        return float(np.diff(self.given.times).min()) / (self.frames + 1.0)

    @property
    def moments(self) -> np.ndarray:
        """The times of the poses between the keys; one that the moment would cover is left out."""
        t = self.given.times
        part = np.arange(1, self.frames + 1) / (self.frames + 1.0)
        between = (t[:-1, None] + np.diff(t)[:, None] * part).ravel()
        return between[np.abs(between - self.now) > 0.6 * self.step]


@dataclass(frozen=True, eq=False)
class _Pose:
    """A pose (3, 3) at a time, its kind (0 a key, 1 between, 2 at the moment), and how far it reaches."""

    L: np.ndarray
    t: float
    kind: int
    low: np.ndarray
    high: np.ndarray


def picture(s: Shown) -> scene.Picture:
    """Return the page."""
    axes = _axes(s)
    strips = [_poses(s, row) for row in s.rows]
    scale, middles = _layout(s, strips)
    rules = [
        scene.Lines(np.array([axes.at(t, axes.ylim[0]), (axes.at(t, 0.0)[0], _STRIPS[1], 0.0)]), *_RULE)
        for t in s.given.times
    ]
    now = np.array([axes.at(s.now, axes.ylim[0]), (axes.at(s.now, 0.0)[0], _STRIPS[1], 0.0)])
    views = [scene.View((*rules, scene.Lines(now, style.ALGEBRA, style.THIN, dash=(7.0, 6.0))))]
    for poses, middle in zip(strips, middles, strict=True):
        views += [_view(s, p, scale, (float(axes.at(p.t, 0.0)[0]), middle)) for p in poses]
    names = [r for k, row in enumerate(s.rows) for r in _name(s, row, middles[k], _CURVES[k][1])]
    return scene.Picture((*views, *_ways(s), scene.View((*names, *_plot(s, axes), _legend(s)))))


def _layout(s: Shown, strips: list[list[_Pose]]) -> tuple[float, list[float]]:
    """The scale, page units, in which all strips are as high as there is room, and their middles."""
    room = _STRIPS[1] - _STRIPS[0] - _GAP * (len(strips) - 1)
    keys = [p for p in strips[0] if p.kind == 0]
    wide = _WIDE * _PLOT[2] * s.step / float(np.ptp(s.given.times))
    scale = min(
        wide / max(float((p.high - p.low)[0]) for p in keys),
        _HIGH / max(float((p.high - p.low)[1]) for p in keys),
    )
    tall = np.array(
        [2.0 * max(float(np.abs([p.low[1], p.high[1]]).max()) for p in poses) for poses in strips]
    )
    while np.maximum(tall * scale, _LEAST).sum() > room:
        scale *= 0.97
    heights = np.maximum(tall * scale, _LEAST)
    heights += (room - heights.sum()) / len(heights)
    tops = _STRIPS[1] - np.cumsum(heights + _GAP) + heights + _GAP
    return scale, list(tops - heights / 2.0)


def _poses(s: Shown, row: Row) -> list[_Pose]:
    """The poses of a strip, in the order in which they are drawn: the keys over those between them."""
    few, axes = _outer(s.V) - s.given.centre, Camera(_DIRECTION).axes[:2]
    times, kinds = s.given.times, np.zeros(len(s.given.times), int)
    A = s.given.A
    if row.path is not None:
        # At a key the key itself is shown, unless the curve passes it by.
        between = s.moments
        kinds = np.repeat([1, 0, 2], [len(between), len(times), 1])
        times = np.concatenate([between, times, [s.now]])
        A = np.concatenate([pose.evaluate(row.path, between), A, pose.evaluate(row.path, [s.now])])
    poses = []
    for L, t, kind in zip(A[:, :3, :3], times, kinds, strict=True):
        seen = few @ (s.stand @ L).T @ axes.T
        poses.append(_Pose(L, float(t), int(kind), seen.min(axis=0), seen.max(axis=0)))
    return poses


_LOOKS = (
    (style.AFTER, style.AFTER_EDGE, 1.6),
    (style.BETWEEN, style.BETWEEN_EDGE, style.EDGE),
    (style.SHELLS[0], style.ALGEBRA_TEXT, 1.6),
)


def _view(s: Shown, p: _Pose, scale: float, at: tuple[float, float]) -> scene.View:
    """A pose about its place on the page."""
    reach = scale * np.maximum(np.abs(p.low), np.abs(p.high)) + _RIM
    box = (at[0] - float(reach[0]), at[1] - float(reach[1]), 2.0 * float(reach[0]), 2.0 * float(reach[1]))
    camera = Camera(_DIRECTION, (0.0, 0.0, 0.0), box[3] / scale, _FOV)
    L = p.L
    inverted = float(np.linalg.det(L)) <= 0.0
    X, F = (s.V - s.given.centre) @ (s.stand @ L).T, s.F[:, ::-1] if inverted else s.F
    # By the cofactors, which exist where the inverse does not.
    N = s.N @ np.stack([np.cross(L[1], L[2]), np.cross(L[2], L[0]), np.cross(L[0], L[1])]).T
    length = np.linalg.norm(N, axis=1, keepdims=True)
    N = (N / np.where(length > 0.0, length, 1.0)) @ s.stand.T
    fill, edge, width = (style.WRONG, style.INK, 1.6) if inverted else _LOOKS[p.kind]
    color = fill if s.painted is None or inverted or p.kind == 1 else s.painted
    records = mesh_look.surface(X, F, color, normals=N)
    return scene.View((*records, *mesh_look.outline(X, F, camera, edge, width)), camera, box)


def _name(s: Shown, row: Row, middle: float, color: str) -> list[scene.Record]:
    """What stands at the left of a strip: its name and what was measured."""
    lines = [(text, color, style.TITLE_TEXT) for text in _TITLES[row.name]]
    lines += [(text, tone, style.SMALL_TEXT) for text, tone in _measured(s, row)]
    top = middle + 38.0 * (len(lines) - 1) / 2.0
    return [
        scene.Label(text, (_NAMES, top - 38.0 * k, 0.0), tone, size, anchor="lc")
        for k, (text, tone, size) in enumerate(lines)
    ]


def _measured(s: Shown, row: Row) -> list[tuple[str, str]]:
    if row.measure is None:
        return [(r"$\mathrm{no\ real}$", style.MARK), (r"$\mathrm{logarithm}$", style.MARK)]
    lines = []
    if s.meets and not row.measure.is_degenerate:
        far = row.measure.turned > 1.5 * row.measure.geodesic + 1e-9
        turned = rf"$\mathrm{{turn}}\ {np.degrees(row.measure.turned):.0f}^{{\circ}}$"
        lines.append((turned, style.MARK if far else style.INK))
    ratio = rf"{row.ratio:.1f}" if np.isfinite(row.ratio) else r"\infty"
    lines.append((rf"$\mathrm{{ratio}}\ {ratio}$", style.MARK if row.ratio > 2.0 * s.asked else style.INK))
    return lines


def _legend(s: Shown) -> scene.Label:
    asked = rf"\mathrm{{ratio}}\ {s.asked:.1f}"
    if s.meets and s.rows[0].measure is not None:
        asked += rf",\ \mathrm{{turn}}\ {np.degrees(s.rows[0].measure.geodesic):.0f}^{{\circ}}"
    return mesh_page.legend(
        r"$\mathrm{ratio{:}\ largest\ to\ smallest\ stretch}$"
        + rf"$;\quad\mathrm{{of\ the\ keys{{:}}}}\ {asked}$"
    )


def _ways(s: Shown) -> list[scene.View]:
    """Where the centre goes."""
    keys = _centre(s, s.given.A)
    ways = [
        None
        if row.path is None
        else _centre(s, pose.evaluate(row.path, np.linspace(*row.path.ends, _BETWEEN)))
        for row in s.rows
    ]
    camera = around(np.concatenate([keys, *(w for w in ways if w is not None)]), _DIRECTION, _WAYS, 1.15)
    records: list[scene.Record] = [
        scene.Lines(way, color, 0.7 * width, dash=dash)
        for way, (color, _, width, dash) in zip(ways, _CURVES, strict=True)
        if way is not None
    ]
    records.append(scene.Points(keys, style.ARC, 6.0, rim=style.ARC_TEXT, shaded=False))
    first = s.rows[0].path
    if first is not None:
        records.append(
            scene.Points(_centre(s, pose.evaluate(first, [s.now])), style.ALGEBRA, 5.0, shaded=False)
        )
    left, low, width, height = _WAYS
    at = (left + width / 2.0, low + height, 0.0)
    name = scene.Label(r"$\mathrm{centre}$", at, style.INK, style.SMALL_TEXT, (0.0, 20.0))
    return [scene.View(tuple(records), camera, _WAYS), scene.View((name,))]


def _centre(s: Shown, A: np.ndarray) -> np.ndarray:
    return (A[:, :3, :3] @ s.given.centre + A[:, :3, 3]) @ s.stand.T


def _outer(V: np.ndarray) -> np.ndarray:
    """Points of a shape that are the outermost in many directions: as large in a picture as the whole."""
    k = np.arange(_OUTER) + 0.5
    height, turn = 1.0 - 2.0 * k / _OUTER, np.pi * (1.0 + np.sqrt(5.0)) * k
    wide = np.sqrt(1.0 - height**2)
    ways = np.stack([wide * np.cos(turn), wide * np.sin(turn), height], axis=1)
    return V[np.unique(np.argmax(V @ ways.T, axis=0))]


def _axes(s: Shown) -> Axes:
    dets = np.concatenate([row.det for row in s.rows if row.path is not None])
    top = max(1.1 * float(dets.max()), 1.25)
    times = s.given.times
    return Axes(_PLOT, (float(times[0]), float(times[-1])), (min(1.1 * float(dets.min()), -0.2 * top), top))


def _plot(s: Shown, axes: Axes) -> list[scene.Record]:
    """det A over t, with what is inside out below 0."""
    low, top = axes.ylim
    times = s.given.times
    marks = [(0.0, "$0$"), (1.0, "$1$")] if top < 4.0 and low > -4.0 else [(0.0, "$0$")]
    corners = axes.at([times[0], times[-1], times[-1], times[0]], [low, low, 0.0, 0.0])
    records: list[scene.Record] = [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.WRONG, material="flat", alpha=0.16)
    ]
    records += axes.frame([(float(t), f"${t:g}$") for t in times], marks, "$t$")
    records.append(
        scene.Label(r"$\det A$", axes.at(times[0], top), style.INK, style.SMALL_TEXT, (-14.0, 10.0), "rc")
    )
    for row, (color, _, width, dash) in zip(s.rows, _CURVES, strict=True):
        if row.path is not None:
            records.append(axes.curve(row.t, row.det, color, width, dash))
            if len(row.flat):
                records.append(axes.dots(row.flat, np.zeros(len(row.flat)), color, 6.0))
    return [*records, *_curve_names(s, axes)]


def _curve_names(s: Shown, axes: Axes) -> list[scene.Record]:
    """Names at the curves; one for those that cannot be told apart."""
    found = [(row, _CURVES[k][1]) for k, row in enumerate(s.rows) if row.path is not None]
    height = axes.ylim[1] - axes.ylim[0]
    groups: list[list[tuple[Row, str]]] = []
    for row, color in found:
        for group in groups:
            if np.abs(group[0][0].det - row.det).max() < _ALIKE * height:
                group.append((row, color))
                break
        else:
            groups.append([(row, color)])
    names = []
    for k, group in enumerate(groups):
        text = r"\ \mathrm{and}\ ".join(r"\ ".join(_TITLES[row.name]).replace("$", "") for row, _ in group)
        at = len(group[0][0].t) // 2
        place = axes.at(group[0][0].t[at], group[0][0].det[at])
        below = k > 0 and place[1] > axes.at(0.0, 0.0)[1] + _CLEAR
        up = (0.0, -24.0 if below else 24.0)
        names.append(scene.Label(f"${text}$", place, group[0][1], style.SMALL_TEXT, up, room=120.0))
    return names
