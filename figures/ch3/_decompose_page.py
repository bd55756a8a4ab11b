"""The page of `decompose`: what every step does to the disc, the arrows between, the factors in numbers."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lietool.lie import so2
from lietool.render import brackets, scene, style
from lietool.render.plane import Plane, arc, moved, path
from lietool.render.solids import fan_faces

from . import _decompose_layout as layouts
from . import _decompose_numbers as factors

_MIDDLE = np.array([600.0, 534.0])
# How far axes go on past what is drawn, and arrows lie beside a radius, in page units.
_PAST, _BESIDE = 20.0, 17.0
_FILLS = {
    "first": (style.BEFORE, style.BEFORE_EDGE),
    "middle": (style.BETWEEN, style.BETWEEN_EDGE),
    "last": (style.AFTER, style.AFTER_EDGE),
}


@dataclass(frozen=True, eq=False)
class Step:
    """A factor: its name, its matrix, what it does, along which axes (columns) or by which angle.

    `off` is what the matrix of a turn has beside the rotation by its angle, if it was given a wrong one.
    """

    name: str
    matrix: np.ndarray
    kind: Literal["turn", "stretch", "flip"]
    axes: np.ndarray
    angle: float = 0.0
    angle_name: str = ""
    off: np.ndarray | float = 0.0

    def part(self, done: float) -> np.ndarray:
        """The step as far as it has come; a reflection has to pass through its mirror."""
        if self.kind == "turn":
            return so2.exp(done * self.angle) + done * self.off
        return (1.0 - done) * np.eye(2) + done * self.matrix


@dataclass(frozen=True, eq=False)
class Stage:
    """The product so far, the axes under it, and the step that led here, done to some part."""

    matrix: np.ndarray
    axes: np.ndarray
    step: Step | None
    done: float = 1.0


Stages = tuple[Stage, ...]


def picture(
    A: np.ndarray,
    steps: tuple[Step, ...],
    stages: Stages,
    film: tuple[Stages, ...],
    d: np.ndarray,
    same: bool,
) -> scene.Picture:
    """Return the page.

    `film` are the stages at moments from t = 0 to 1; `same` says that the singular values are equal,
    so that the axes mean nothing.
    """
    panels = tuple(_extent(moments) for moments in zip(*film, strict=True))
    layout = layouts.square(panels) if len(panels) == 4 else layouts.triangle(panels)
    records: list[scene.Record] = []
    for k, (stage, center) in enumerate(zip(stages, layout.centers, strict=True)):
        place = Plane((float(center[0]), float(center[1])), layout.scale)
        colors = _FILLS["first" if k == 0 else "last" if k == len(stages) - 1 else "middle"]
        reach = np.array([panels[k].wide, panels[k].high]) + _PAST / layout.scale
        before = _before(place, stage, stages[k - 1], same) if k else []
        records += _panel(place, stage, colors, reach, before, same)
        if k:
            records += _deed(place, stage, stages[k - 1], reach, same)
            name, said = rf"\mathrm{{{k}\!:}}\ {steps[k - 1].name}", _said(steps[k - 1], d)
            between = layouts.ends(layout.centers[k - 1], center, layout.scale, (panels[k - 1], panels[k]))
            records += _connector(between, name, said)
            if steps[k - 1].kind == "stretch" and not same:
                others = np.array([layout.centers[k - 1], layout.centers[(k + 1) % len(stages)]])
                records += _stretched(place, stage, others)
    at_once = layouts.ends(layout.centers[0], layout.centers[-1], layout.scale, (panels[0], panels[-1]))
    records += _connector(at_once, "A", (), style.MUTED, (9.0, 6.0))
    records += _remark(steps, d, same, layout)
    records += factors.matrices([("A", A)] + [(step.name, step.matrix) for step in steps[::-1]])
    return scene.Picture((scene.View(tuple(records)),))


def _extent(moments: Stages) -> layouts.Extent:
    """What a panel takes while its shape changes from the first of the moments to the last."""
    shapes = np.array([moment.matrix for moment in moments])
    step = moments[0].step
    tips = np.array([moment.axes[:, 0] for moment in moments])
    kind = "" if step is None else step.kind
    return layouts.extent(shapes, tips if kind == "turn" else 0.0 * tips[:1], kind == "stretch")


def _panel(
    place: Plane,
    stage: Stage,
    colors: tuple[str, str],
    reach: np.ndarray,
    before: list[scene.Record],
    same: bool,
) -> list[scene.Record]:
    """The disc, the glyph and the axes, carried as far as the stage says; `before` lies under the glyph."""
    fill, edge = colors
    disc = moved(stage.matrix, _circle())
    fan = place.at(np.concatenate([[[0.0, 0.0]], disc]))
    cross = np.array([[-1.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [0.0, -1.0], [0.0, 1.0]])
    records: list[scene.Record] = [
        scene.Surface(fan, fan_faces(len(fan)), fill, material="flat", alpha=0.35),
        place.line(reach * cross, style.RULE, style.HAIR),
        *before,
        *place.glyph(stage.matrix, fill, edge, size=1.1, width=style.THIN),
        place.line(disc, edge, style.EDGE),
    ]
    for axis, color in zip(stage.axes.T, style.AXES, strict=False):
        ink = style.BEFORE_EDGE if same else color
        records.append(place.line([(0.0, 0.0), axis], ink, style.THIN if same else style.CURVE))
        records.append(place.dots([axis], ink, 5.0 if same else 8.0))
    return [*records, place.dots([(0.0, 0.0)], style.INK, 4.5)]


def _circle() -> np.ndarray:
    return arc((0.0, 0.0), 1.0, 0.0, 2.0 * np.pi, 121)


def _before(place: Plane, stage: Stage, before: Stage, same: bool) -> list[scene.Record]:
    """What was there before the step: the outline; the axis that turns; the axes that are stretched."""
    step = stage.step
    records: list[scene.Record] = [place.line(moved(before.matrix, _circle()), style.BEFORE_EDGE, style.THIN)]
    if step is None or (same and step.kind == "stretch"):
        return records
    if step.kind == "turn" and not same:
        start = before.axes[:, 0]
        records.append(place.line(np.stack([0.0 * start, start]), style.AXIS_X, style.EDGE, 0.45))
        records.append(scene.Points([place.at(start)], style.PAPER, 6.5, rim=style.AXIS_X, shaded=False))
    if step.kind == "stretch":
        for k, axis in enumerate(step.axes.T):
            past = _past(place, stage, k) * axis
            records.append(place.line([-past, past], style.INK, style.EDGE, dash=(2.0, 6.0)))
    return records


def _past(place: Plane, stage: Stage, k: int) -> float:
    """How far from the centre a dotted axis ends: past the disc and what has become of it."""
    return max(1.0, float(np.linalg.norm(stage.axes[:, k]))) + _PAST / place.scale


def _deed(place: Plane, stage: Stage, before: Stage, reach: np.ndarray, same: bool) -> list[scene.Record]:
    """What the step did: a curved arrow, or arrows along the axes, or a mirror."""
    step = stage.step
    if step is None or (same and step.kind == "stretch"):
        return []
    if step.kind == "turn":
        x, y = before.axes[:, 0]
        radius = layouts.OUTSIDE * max(float(np.hypot(x, y)), layouts.LEAST)
        return place.turn((0.0, 0.0), radius, float(np.arctan2(y, x)), stage.done * step.angle, style.INK)
    if step.kind == "flip":
        along = float(reach.max()) * step.axes[:, 0]
        return [place.line(np.array([-along, along]), style.MARK, style.EDGE)]
    records: list[scene.Record] = []
    for axis, size in zip(step.axes.T, np.linalg.eigvalsh(step.matrix)[::-1], strict=True):
        grown = 1.0 + stage.done * (size - 1.0)
        # The radius lies on the axis at this side: the arrow goes beside it.
        beside = _BESIDE / place.scale * np.array([-axis[1], axis[0]])
        records += _grown(place.at([-axis, -grown * axis]))
        records += _grown(place.at([axis + beside, grown * axis + beside]))
    return records


def _grown(ends: np.ndarray) -> list[scene.Record]:
    """An arrow from where a point was to where it is; a short one is thin, so that it keeps its head."""
    length = float(np.linalg.norm(ends[1] - ends[0]))
    return path(ends, style.INK, min(style.CURVE, length / 6.5)) if length > 3.0 else []


def _stretched(place: Plane, stage: Stage, others: np.ndarray) -> list[scene.Record]:
    """The names of the singular values, at those ends of the dotted axes that are away from the arrows."""
    records: list[scene.Record] = []
    axes = stage.step.axes if stage.step is not None else np.eye(2)
    away = others - np.asarray(place.origin)
    away /= np.linalg.norm(away, axis=-1, keepdims=True)
    for k, axis in enumerate(axes.T):
        end = axis if (away @ axis).max() <= (away @ -axis).max() + 1e-9 else -axis
        at = place.at(_past(place, stage, k) * end)
        records.append(
            scene.Label(rf"$\sigma_{k + 1}$", at, style.AXES_TEXT[k], style.TEXT, tuple(22.0 * end))
        )
    return records


def _said(step: Step, d: np.ndarray) -> tuple[str, ...]:
    """What a step amounts to, in one line or two."""
    if step.kind == "stretch":
        return tuple(rf"$\sigma_{i + 1} = {brackets.fixed(d[i])}$" for i in range(2))
    angle = rf"{round(np.degrees(step.angle), 1) + 0.0:.1f}^{{\circ}}"
    if step.kind == "flip":
        return r"$\mathrm{mirror\ at}$", f"${angle}$"
    return (rf"${step.angle_name + ' = ' if step.angle_name else ''}{angle}$",)


def _connector(
    ends: tuple[np.ndarray, np.ndarray],
    name: str,
    said: tuple[str, ...],
    color: str = style.INK,
    dash: tuple[float, float] | None = None,
) -> list[scene.Record]:
    """The arrow from panel to panel, its name on the outer side, and what it amounts to."""
    tail, tip = ends
    middle = (tail + tip) / 2.0
    along = (tip - tail) / np.linalg.norm(tip - tail)
    out = np.array([along[1], -along[0]])
    if out @ (middle - _MIDDLE) < 0.0:
        out = -out
    records = path(np.array([[*tail, 0.0], [*tip, 0.0]]), color, style.CURVE, dash=dash)
    upright, level = abs(out[0]) > 0.9, abs(out[0]) < 0.1
    gap = 14.0 if level else 18.0
    # Beside an upright or a slanting arrow all stands on its outer side; else on both.
    first = 38.0 * len(said) / 2.0 if upright else 0.0
    records.append(_beside(f"${name}$", middle, out, gap, -first, color, style.TITLE_TEXT))
    for i, line in enumerate(said):
        toward = -out if level else out
        down = 38.0 * (i if out[1] > 0.0 else i - len(said) + 1) if level else 42.0 + 38.0 * i - first
        records.append(_beside(line, middle, toward, gap, down, style.MUTED, style.SMALL_TEXT))
    return records


def _beside(
    text: str, at: np.ndarray, toward: np.ndarray, gap: float, down: float, color: str, size: float
) -> scene.Label:
    """A line of text beside a point, so that its nearest edge or corner is a gap away."""
    across = "c" if abs(toward[0]) < 0.3 else "l" if toward[0] > 0.0 else "r"
    upright = "c" if abs(toward[1]) < 0.3 else "b" if toward[1] > 0.0 else "t"
    offset = (gap * float(toward[0]), gap * float(toward[1]) - down)
    return scene.Label(text, (*at, 0.0), color, size, offset, across + upright)


def _remark(steps: tuple[Step, ...], d: np.ndarray, same: bool, layout: layouts.Layout) -> list[scene.Record]:
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
    four = len(layout.centers) == 4
    x, y = np.mean(layout.centers, axis=0) if four else (190.0, 240.0)
    top = y + 20.0 * (len(lines) - 1)
    return [
        scene.Label(line, (float(x), top - 40.0 * i, 0.0), style.MARK, style.SMALL_TEXT)
        for i, line in enumerate(lines)
    ]
