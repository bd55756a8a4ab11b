"""The page of `decompose`: what every step does to the disc, the arrows between, the factors in numbers."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lietool.lie import so2
from lietool.render import scene, style
from lietool.render.plane import Plane, arc, moved, path

# Centres of the panels, for three steps and for two; what a panel's disc may take around its centre.
_SQUARE = ((300.0, 716.0), (900.0, 716.0), (900.0, 352.0), (300.0, 352.0))
_MIDDLE = np.array([600.0, 534.0])
_TRIANGLE = ((250.0, 690.0), (950.0, 690.0), (600.0, 364.0))
_ROOM = {4: 146.0, 3: 172.0}
# How far outside of a disc its rotation is drawn.
_OUTSIDE = 1.19
# Of a matrix in numbers: from column to column, from row to row, from its middle to its brackets.
_COLUMN, _ROW, _BRACKET = 94.0, 40.0, (100.0, 40.0)
_FILLS = {
    "first": (style.BEFORE, style.BEFORE_EDGE),
    "middle": (style.BETWEEN, style.BETWEEN_EDGE),
    "last": (style.AFTER, style.AFTER_EDGE),
}


@dataclass(frozen=True, eq=False)
class Step:
    """A factor: its name, its matrix, what it does, along which axes (columns) or by which angle."""

    name: str
    matrix: np.ndarray
    kind: Literal["turn", "stretch", "flip"]
    axes: np.ndarray
    angle: float = 0.0
    angle_name: str = ""

    def part(self, done: float) -> np.ndarray:
        """The step as far as it has come; a reflection has to pass through its mirror."""
        if self.kind == "turn":
            return so2.exp(done * self.angle)
        return (1.0 - done) * np.eye(2) + done * self.matrix


@dataclass(frozen=True, eq=False)
class Stage:
    """The product so far, the axes under it, and the step that led here, done to some part."""

    matrix: np.ndarray
    axes: np.ndarray
    step: Step | None
    done: float = 1.0


def picture(
    A: np.ndarray, steps: tuple[Step, ...], stages: tuple[Stage, ...], d: np.ndarray, same: bool
) -> scene.Picture:
    """Return the page; `same` says that the singular values are equal, so that the axes mean nothing."""
    centers = _SQUARE if len(stages) == 4 else _TRIANGLE
    room = _ROOM[len(stages)]
    scale = room / (_OUTSIDE * max(1.0, d[0]))
    records: list[scene.Record] = []
    for k, (stage, center) in enumerate(zip(stages, centers, strict=True)):
        place = Plane(center, scale)
        colors = _FILLS["first" if k == 0 else "last" if k == len(stages) - 1 else "middle"]
        records += _panel(place, stage, colors, room / scale, same)
        if k:
            records += _deed(place, stage, stages[k - 1], room / scale, same)
            records += _connector(centers[k - 1], center, room, steps[k - 1].name, _said(steps[k - 1], d))
    records += _stretched(steps, centers, room, same)
    records += _connector(centers[0], centers[-1], room, "A", (), style.MUTED)
    records += _remark(steps, d, same, len(stages))
    records += _matrices([("A", A)] + [(step.name, step.matrix) for step in steps[::-1]])
    return scene.Picture((scene.View(tuple(records)),))


def _panel(
    place: Plane, stage: Stage, colors: tuple[str, str], reach: float, same: bool
) -> list[scene.Record]:
    """The disc, the glyph and the axes, carried as far as the stage says."""
    fill, edge = colors
    disc = moved(stage.matrix, arc((0.0, 0.0), 1.0, 0.0, 2.0 * np.pi, 121))
    n = np.arange(1, len(disc))
    faces = np.stack([0 * n, n, n + 1], axis=-1)
    cross = np.array([[-reach, 0.0], [reach, 0.0], [np.nan, np.nan], [0.0, -reach], [0.0, reach]])
    records: list[scene.Record] = [
        scene.Surface(
            place.at(np.concatenate([[[0.0, 0.0]], disc])), faces, fill, material="flat", alpha=0.35
        ),
        place.line(cross, style.RULE, style.HAIR),
        *place.glyph(stage.matrix, fill, edge, size=1.1, width=style.THIN),
        place.line(disc, edge, style.EDGE),
    ]
    for axis, color in zip(stage.axes.T, style.AXES, strict=False):
        ink = style.BEFORE_EDGE if same else color
        records.append(place.line([(0.0, 0.0), axis], ink, style.THIN if same else style.CURVE))
        records.append(place.dots([axis], ink, 5.0 if same else 8.0))
    return [*records, place.dots([(0.0, 0.0)], style.INK, 4.5)]


def _deed(place: Plane, stage: Stage, before: Stage, reach: float, same: bool) -> list[scene.Record]:
    """What the step did: the outline before, and a curved arrow, or dotted axes with arrows, or a mirror."""
    step = stage.step
    outline = moved(before.matrix, arc((0.0, 0.0), 1.0, 0.0, 2.0 * np.pi, 121))
    ghost = place.line(outline, style.MUTED, style.THIN, 0.8, dash=(5.0, 6.0))
    if step is None:
        return []
    if step.kind == "turn":
        x, y = before.axes[:, 0]
        radius = _OUTSIDE * max(float(np.hypot(x, y)), 0.6)
        curved = place.turn((0.0, 0.0), radius, float(np.arctan2(y, x)), stage.done * step.angle, style.INK)
        return [ghost, *curved]
    if step.kind == "flip":
        along = reach * step.axes[:, 0]
        return [ghost, place.line([-along, along], style.MARK, style.EDGE, dash=(16.0, 7.0))]
    records: list[scene.Record] = [ghost]
    if same:
        return records
    for axis, size in zip(step.axes.T, np.linalg.eigvalsh(step.matrix)[::-1], strict=True):
        records.append(place.line([-reach * axis, reach * axis], style.INK, style.EDGE, dash=(2.0, 6.0)))
        grown = 1.0 + stage.done * (size - 1.0)
        records += path(place.at([-axis, -grown * axis]), style.INK, style.EDGE)
    return records


def _stretched(
    steps: tuple[Step, ...], centers: tuple[tuple[float, float], ...], room: float, same: bool
) -> list[scene.Record]:
    """The names of the singular values, at those ends of the dotted axes that are away from the arrows."""
    records: list[scene.Record] = []
    for k, step in enumerate(steps):
        if step.kind != "stretch" or same:
            continue
        here = np.asarray(centers[k + 1])
        others = np.array([centers[k], centers[(k + 2) % len(centers)]]) - here
        others /= np.linalg.norm(others, axis=-1, keepdims=True)
        for i, axis in enumerate(step.axes.T):
            end = axis if (others @ axis).max() <= (others @ -axis).max() + 1e-9 else -axis
            at = here + room * end
            records.append(
                scene.Label(
                    rf"$\sigma_{i + 1}$", (*at, 0.0), style.AXES_TEXT[i], style.TEXT, tuple(24.0 * end)
                )
            )
    return records


def _said(step: Step, d: np.ndarray) -> tuple[str, ...]:
    """What a step amounts to, in one line or two."""
    if step.kind == "stretch":
        return tuple(rf"$\sigma_{i + 1} = {fixed(d[i])}$" for i in range(2))
    angle = rf"{round(np.degrees(step.angle), 1) + 0.0:.1f}^{{\circ}}"
    if step.kind == "flip":
        return r"$\mathrm{mirror\ at}$", f"${angle}$"
    return (rf"${step.angle_name + ' = ' if step.angle_name else ''}{angle}$",)


def fixed(value: float | np.floating | np.ndarray) -> str:
    """Return a number with two digits after the point, without a minus sign before zero."""
    return f"{round(float(value), 2) + 0.0:.2f}"


def _connector(
    start: tuple[float, float],
    end: tuple[float, float],
    room: float,
    name: str,
    said: tuple[str, ...],
    color: str = style.INK,
) -> list[scene.Record]:
    """The arrow from panel to panel, its name on the outer side, and what it amounts to."""
    a, b = np.asarray(start), np.asarray(end)
    along = (b - a) / np.linalg.norm(b - a)
    tail, tip = a + (room + 16.0) * along, b - (room + 16.0) * along
    middle = (tail + tip) / 2.0
    out = np.array([along[1], -along[0]])
    if out @ (middle - _MIDDLE) < 0.0:
        out = -out
    records: list[scene.Record] = [scene.Arrow((*tail, 0.0), (*tip, 0.0), color, 2.2, 4.0)]
    records.append(_beside(f"${name}$", middle, out, 20.0, 0.0, color, style.TITLE_TEXT))
    slanting = 0.1 < abs(out[0]) < 0.9
    for i, line in enumerate(said):
        # Beside a slanting arrow the lines go on under the name; else they stand on the other side of it.
        first = 0.0 if out[1] > 0.9 else len(said) - 1.0 if out[1] < -0.9 else (len(said) - 1.0) / 2.0
        down = 44.0 + 38.0 * i if slanting else 38.0 * (i - first)
        toward = out if slanting else -out
        records.append(_beside(line, middle, toward, 20.0, down, style.MUTED, style.SMALL_TEXT))
    return records


def _beside(
    text: str, at: np.ndarray, toward: np.ndarray, gap: float, down: float, color: str, size: float
) -> scene.Label:
    """A line of text beside a point, so that its nearest edge or corner is a gap away."""
    across = "c" if abs(toward[0]) < 0.3 else "l" if toward[0] > 0.0 else "r"
    upright = "c" if abs(toward[1]) < 0.3 else "b" if toward[1] > 0.0 else "t"
    offset = (gap * float(toward[0]), gap * float(toward[1]) - down)
    return scene.Label(text, (*at, 0.0), color, size, offset, across + upright)


def _remark(steps: tuple[Step, ...], d: np.ndarray, same: bool, count: int) -> list[scene.Record]:
    """What is special about the matrix, where the panels leave room."""
    lines = []
    if d[0] == 0.0:
        lines += [r"$A = 0\mathrm{:\ all\ goes}$", r"$\mathrm{to\ the\ origin}$"]
    elif d[1] <= 1e-12 * d[0]:
        lines += [r"$\det A = 0\mathrm{:\ the\ disc}$", r"$\mathrm{becomes\ a\ segment}$"]
    elif any(step.kind == "flip" for step in steps):
        lines += [r"$\det A < 0\mathrm{:}$", r"$Q\ \mathrm{is\ a\ reflection}$"]
    if same and d[0] > 0.0:
        lines += [r"$\sigma_1 = \sigma_2\mathrm{:\ any}$", r"$\mathrm{axes\ will\ do}$"]
    x, y = (600.0, 534.0) if count == 4 else (215.0, 300.0)
    top = y + 20.0 * (len(lines) - 1)
    return [
        scene.Label(line, (x, top - 40.0 * i, 0.0), style.MARK, style.SMALL_TEXT)
        for i, line in enumerate(lines)
    ]


def _matrices(named: list[tuple[str, np.ndarray]]) -> list[scene.Record]:
    """A line of matrices in numbers, each under its name; after the first an equals sign."""
    pitch = 2.0 * _BRACKET[0] + 40.0
    left = 600.0 - pitch * (len(named) - 1) / 2.0
    records: list[scene.Record] = []
    for k, (name, matrix) in enumerate(named):
        # The sign of equality takes a little more than the gap between two factors.
        x, y = left + pitch * k + (12.0 if k else -12.0), 68.0
        records.append(scene.Label(f"${name}$", (x, y + 56.0, 0.0), style.INK, style.TEXT, anchor="cn"))
        for i, j in np.ndindex(2, 2):
            at = (x + _COLUMN * (j - 0.1), y + _ROW * (0.5 - i), 0.0)
            text = f"${fixed(matrix[i, j])}$"
            records.append(scene.Label(text, at, style.INK, style.SMALL_TEXT, (0.0, -10.0), "rn"))
        for side in (-1.0, 1.0):
            edge, inner = x + side * _BRACKET[0], x + side * (_BRACKET[0] - 9.0)
            high, low = y + _BRACKET[1], y - _BRACKET[1]
            bracket = [(inner, high), (edge, high), (edge, low), (inner, low)]
            records.append(scene.Lines([(*p, 0.0) for p in bracket], style.INK, style.EDGE))
    records.append(scene.Label("$=$", (left + pitch / 2.0, 68.0, 0.0), style.INK, style.TEXT))
    return records
