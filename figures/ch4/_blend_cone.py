"""Sym+(2) as a cone of glass, for `blend-space`, and sym(2), the flat space of the logarithms.

A symmetric matrix is drawn at ((xx - yy) / sqrt 2, sqrt 2 xy, (xx + yy) / sqrt 2): distances are those
between matrices, the multiples of I are the axis, and det = 0 is the cone.
"""

from dataclasses import dataclass

import numpy as np

from lietool.lie import sym
from lietool.render import camera as cameras
from lietool.render import plane, scene, solids, style
from lietool.render.camera import Box, Camera
from lietool.render.globe import joined

# Of the stems of the ellipses, over the height of the view.
_STEM = 0.045
_CONE_DIRECTION = (0.42, -1.0, 0.54)
_FLAT_DIRECTION = (0.42, -1.0, 0.32)


def drawn(S: np.ndarray) -> np.ndarray:
    """Return where symmetric matrices (..., 2, 2) are drawn; shape (..., 3)."""
    x, y, z = S[..., 0, 0] - S[..., 1, 1], 2.0 * S[..., 0, 1], S[..., 0, 0] + S[..., 1, 1]
    return np.stack([x, y, z], axis=-1) / np.sqrt(2.0)


@dataclass(frozen=True, eq=False)
class Stretches:
    """Two positive definite matrices and what lies between them."""

    S0: np.ndarray
    S1: np.ndarray

    def linear(self, t: np.ndarray) -> np.ndarray:
        """Return (1 - t) S0 + t S1."""
        t = np.asarray(t, float)[..., None, None]
        return (1.0 - t) * self.S0 + t * self.S1

    def logs(self, t: np.ndarray) -> np.ndarray:
        """Return (1 - t) log S0 + t log S1."""
        t = np.asarray(t, float)[..., None, None]
        return (1.0 - t) * sym.log(self.S0) + t * sym.log(self.S1)

    def curved(self, t: np.ndarray) -> np.ndarray:
        """Return exp of `logs`."""
        return sym.exp(self.logs(t))

    def exits(self) -> tuple[float, float]:
        """Return the t before 0 and after 1 where the straight line leaves the cone; infinite if never."""
        # det is quadratic in t: its values at -1, 0, 1 tell which.
        low, c, high = np.linalg.det(self.linear(np.array([-1.0, 0.0, 1.0])))
        a, b = (low + high) / 2.0 - c, (high - low) / 2.0
        if abs(a) <= 1e-14 * c:
            roots = np.array([-c / b]) if abs(b) > 1e-14 * c else np.zeros(0)
        else:
            # Through the apex the line leaves at a double root, which rounding may take away.
            inside = b * b - 4.0 * a * c
            root = np.sqrt(max(inside, 0.0))
            q = -0.5 * (b + np.copysign(root, b))
            roots = np.array([q / a, c / q]) if inside >= -1e-12 * b * b else np.zeros(0)
        before, after = roots[roots < 0.0], roots[roots > 1.0]
        return (float(before.max()) if len(before) else -np.inf, float(after.min()) if len(after) else np.inf)


def glass(camera: Camera, height: float) -> list[scene.Record]:
    """Return the cone up to a height, open above: wall, graticule, rim, outline, axis, name."""
    angle = np.linspace(0.0, 2.0 * np.pi, 97)
    ring = np.stack([np.cos(angle), np.sin(angle), np.ones(97)], axis=-1)
    part = np.linspace(0.0, height, 25)
    wall = part[:, None, None] * ring
    normals = np.broadcast_to(ring * (1.0, 1.0, -1.0) / np.sqrt(2.0), wall.shape)
    circles = [k * height / 4.0 * ring for k in range(1, 4)]
    generators = [np.stack([np.zeros(3), height * ring[i]]) for i in range(0, 96, 8)]
    # The lines of sight touch the cone along two of its generators.
    x, y, z = camera.eye
    aside = np.arccos(np.clip(z / np.hypot(x, y), -1.0, 1.0))
    touching = np.arctan2(y, x) + np.array([-aside, aside])
    edges = [height * np.array([[0, 0, 0], [np.cos(a), np.sin(a), 1.0]]) for a in touching]
    right = edges[int(np.argmax([camera.axes[0] @ edge[1] for edge in edges]))]
    return [
        scene.Surface(
            wall.reshape(-1, 3),
            solids.grid_faces(25, 97),
            style.SHELL_FILLS[1],
            normals.reshape(-1, 3),
            "glass",
        ),
        scene.Lines(
            joined([*circles, *generators]), style.GROUP_TEXT, style.HAIR, 0.7 * style.GRATICULE_ALPHA
        ),
        scene.Lines(joined([height * ring, *edges]), style.GROUP_TEXT, style.EDGE),
        scene.Lines([(0, 0, 0), (0, 0, height)], style.MUTED, style.THIN, 0.8, dash=(2.0, 6.0)),
        scene.Label(r"$\det = 0$", 0.5 * right[1], style.GROUP_TEXT, style.SMALL_TEXT, (16.0, -6.0), "lt"),
    ]


def ellipses(
    camera: Camera, S: np.ndarray, size: float, colors: tuple[tuple[str, str], ...], side: float
) -> list[scene.Record]:
    """Return the disc under each matrix (n, 2, 2), facing the viewer, on a stem up (1) or down (-1)."""
    around = plane.arc((0.0, 0.0), size, 0.0, 2.0 * np.pi, 61)
    faces = solids.fan_faces(len(around) + 1)
    up = side * camera.axes[1]
    records: list[scene.Record] = []
    for at, matrix, (fill, edge) in zip(drawn(S), S, colors, strict=True):
        foot = at + _STEM * camera.height * up
        middle = foot + size * float(np.linalg.norm(matrix[1])) * up
        rim = middle + plane.moved(matrix, around) @ camera.axes[:2]
        records.append(scene.Lines([at, foot], edge, style.THIN))
        records.append(scene.Surface(np.concatenate([[middle], rim]), faces, fill, material="flat"))
        records.append(scene.Lines(rim, edge, style.EDGE))
    return records


def colors(count: int) -> tuple[tuple[str, str], ...]:
    """Return fill and edge for shapes from first to last."""
    between = ((style.BETWEEN, style.BETWEEN_EDGE),) * max(count - 2, 0)
    return ((style.BEFORE, style.BEFORE_EDGE), *between, (style.AFTER, style.AFTER_EDGE))[:count]


def view(ends: Stretches, times: np.ndarray, t: float, beyond: float, box: Box, curved: bool) -> scene.View:
    """Return the cone with the line between two matrices, or the curve that exp makes of their logarithms."""
    way = ends.curved if curved else ends.linear
    # Between the ends the trace of neither way is larger than at one of them.
    height = 1.25 * float(drawn(ends.linear(np.array([0.0, 1.0])))[:, 2].max())
    angle = np.linspace(0.0, 2.0 * np.pi, 25)
    ring = height * np.stack([np.cos(angle), np.sin(angle), 1.0 + 0.0 * angle], axis=-1)
    line = _line(ends, beyond, height)
    camera = cameras.around(
        np.concatenate([ring, [[0.0, 0.0, 0.0]], drawn(ends.linear(line))]), _CONE_DIRECTION, box, 1.10
    )
    color, steps = style.GROUP if curved else style.RIGHT, way(times)
    # An ellipse takes no more than its part of the way, and no more than a tenth of the picture.
    apart = np.linalg.norm(np.diff(drawn(steps), axis=0), axis=-1).max()
    size = float(np.clip(0.5 * apart, 0.03 * camera.height, 0.085 * camera.height))
    size /= float(np.linalg.eigvalsh(steps).max())
    marked = way(np.array([t]))
    # The curve hangs under the chord, and so do its ellipses.
    side = -1.0 if curved else 1.0
    records = [
        *glass(camera, height),
        *_ways(ends, line, beyond, height, camera, curved),
        *ellipses(camera, steps, size, colors(len(times)), side),
        *ellipses(camera, marked, size, ((style.PAPER, color),), -side),
        scene.Points(drawn(steps), color, 7.0),
        scene.Points(drawn(marked), color, 12.5, rim=style.PAPER),
        *_names(ends, marked[0], t, height, side),
    ]
    return scene.View(tuple(records), camera, box)


def _line(ends: Stretches, beyond: float, height: float) -> np.ndarray:
    """The t of the straight line: as far as wanted, but only a little way out of the cone."""
    span = shown(ends, beyond)
    return span[drawn(ends.linear(span))[:, 2] <= height]


def shown(ends: Stretches, beyond: float) -> np.ndarray:
    """Return moments before 0 to after 1, as far as wanted, but only a little out of the cone."""
    low, high = ends.exits()
    return np.linspace(max(-beyond, low - 0.08), min(1.0 + beyond, high + 0.08), 121)


def _ways(
    ends: Stretches, line: np.ndarray, beyond: float, height: float, camera: Camera, curved: bool
) -> list[scene.Record]:
    """The straight line, which leaves the cone where it goes on, or the curve, which never does."""
    inside, radius = np.linspace(0.0, 1.0, 61), 0.0065 * camera.height
    if curved:
        span = drawn(ends.curved(np.linspace(-beyond, 1.0 + beyond, 121)))
        return [
            scene.Lines(drawn(ends.linear(inside[[0, -1]])), style.MUTED, style.EDGE, dash=(8.0, 6.0)),
            scene.Lines(np.where(span[:, 2:] <= height, span, np.nan), style.GROUP, style.EDGE),
            scene.Tube(drawn(ends.curved(inside)), style.GROUP, radius),
        ]
    low, high = ends.exits()
    parts = (line[line <= low], line[(line >= low) & (line <= high)], line[line >= high])
    records: list[scene.Record] = [
        scene.Lines(drawn(ends.linear(part)), color, style.EDGE)
        for part, color in zip(parts, (style.WRONG, style.RIGHT, style.WRONG), strict=True)
        if len(part) > 1
    ]
    leaves = [exit for exit in (low, high) if line[0] <= exit <= line[-1]]
    across = 0.016 * camera.height * np.array([[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]])
    for point in drawn(ends.linear(np.array(leaves))):
        arms = point + across @ camera.axes[:2]
        records.append(scene.Lines(joined([arms[:2], arms[2:]]), style.WRONG, style.CURVE, lift=0.03))
    records.append(scene.Tube(drawn(ends.linear(inside)), style.RIGHT, radius))
    return records


def _names(ends: Stretches, marked: np.ndarray, t: float, height: float, side: float) -> list[scene.Record]:
    """The names, those of matrices across from their ellipses, which are above (1) or below (-1) them."""
    color = style.ALGEBRA_TEXT if side > 0.0 else style.GROUP_TEXT
    unit = drawn(np.eye(2))
    anchor = "ct" if side > 0.0 else "cb"
    records: list[scene.Record] = [
        scene.Label("$0$", np.zeros(3), style.INK, style.SMALL_TEXT, (0.0, -12.0), "ct"),
    ]
    if 0.15 * height < unit[2] < 0.95 * height:
        records.append(scene.Points([unit], style.INK, 6.0))
        records.append(scene.Label("$I$", unit, style.INK, style.SMALL_TEXT, (-14.0, -4.0), "rt", room=40.0))
    for S, name, k in ((ends.S0, "$S_0$", 0.0), (ends.S1, "$S_1$", 1.0)):
        if abs(t - k) > 0.08:
            offset = (0.0, -18.0 * side)
            records.append(scene.Label(name, drawn(S), style.INK, offset=offset, anchor=anchor, room=50.0))
    offset = (24.0, -20.0 * side)
    beside = "lt" if side > 0.0 else "lb"
    records.append(scene.Label("$S(t)$", drawn(marked), color, offset=offset, anchor=beside, room=60.0))
    return records


def flat(ends: Stretches, times: np.ndarray, t: float, beyond: float, box: Box) -> scene.View:
    """Return sym(2), a space of three dimensions: the line between the logarithms, and its shadow."""
    line = drawn(ends.logs(np.array([-beyond, 1.0 + beyond])))
    balls, marked = drawn(ends.logs(times)), drawn(ends.logs(np.array([t])))
    half = max(0.6, 1.1 * float(np.abs(line[:, :2]).max()))
    low, high = (
        float(min(line[:, 2].min(), 0.0)) - 0.35 * half,
        float(max(line[:, 2].max(), 0.0)) + 0.45 * half,
    )
    square = half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0]], float)
    floor = square + np.array([0.0, 0.0, low])
    axis = np.array([[0.0, 0.0, low], [0.0, 0.0, high]])
    camera = cameras.around(np.concatenate([floor, axis, line]), _FLAT_DIRECTION, box, 1.04)
    grid = [np.array([[x, -half, low], [x, half, low]]) for x in np.linspace(-half, half, 9)[1:-1]]
    grid += [g[:, [1, 0, 2]] for g in grid]

    def shadow(points: np.ndarray) -> np.ndarray:
        return points * (1.0, 1.0, 0.0) + (0.0, 0.0, low)

    zero = np.zeros(3)
    drops = joined(np.stack([point, shadow(point)]) for point in balls)
    blue = style.ALGEBRA_TEXT
    records: list[scene.Record] = [
        scene.Surface(floor[:4], [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat"),
        scene.Lines(joined(grid), style.ALGEBRA, style.HAIR, 0.25),
        scene.Lines(floor, style.ALGEBRA, style.THIN, 0.7),
        scene.Lines(axis, style.MUTED, style.THIN, 0.8, dash=(2.0, 6.0)),
        scene.Lines(drops, style.MUTED, style.HAIR),
        scene.Lines(shadow(line), style.GREYS[1], style.CURVE),
        scene.Lines(line, style.ALGEBRA, style.EDGE),
        scene.Tube(balls[[0, -1]], style.ALGEBRA, 0.010 * camera.height),
        scene.Points(balls, style.ALGEBRA, 7.0),
        scene.Points(marked, style.ALGEBRA, 12.5, rim=style.PAPER),
        scene.Points([zero], style.INK, 6.0),
        scene.Label("$0$", zero, style.INK, style.SMALL_TEXT, (14.0, -2.0), "lc"),
    ]
    # Away from the other one, as the page shows them.
    apart = float(np.sign(camera.axes[0] @ (balls[-1] - balls[0]) + 1e-12))
    for ball, name, k in ((balls[0], r"$\log S_0$", 0.0), (balls[-1], r"$\log S_1$", 1.0)):
        if abs(t - k) > 0.08:
            side = apart * (2.0 * k - 1.0)
            anchor = "lb" if side > 0.0 else "rb"
            records.append(
                scene.Label(name, ball, blue, style.SMALL_TEXT, (8.0 * side, 12.0), anchor, room=45.0)
            )
    return scene.View(tuple(records), camera, box)
