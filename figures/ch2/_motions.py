"""What the pictures of motions in the plane share: the legs of a way, angles, names, a legend."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lietool.lie import se2
from lietool.render import plane, polyline, scene, solids, style
from lietool.render.plot import number

from . import _letters

# The motions of a shape on each of its ways, at a time from 0 to 1.
Moving = Callable[[float], Sequence[np.ndarray]]
ORIGIN = np.zeros(2)
# Where pictures lie on the page: under the title and above the legend.
BOX = (90.0, 180.0, 1020.0, 620.0)
# Points nearer than this part of the picture are one.
_SAME = 1e-9
# The last part of an arc of several turns, radians, along which it comes back to its radius.
_CLOSING = 1.2
# The most that a shape is high on the page.
_HIGHEST = 300.0
# Dots, and how far from their middles arrows and spokes end, in page units.
DOT = 6.5
_TIP, _SPOKE = 10.0, 14.0


@dataclass(frozen=True)
class Way:
    """The colours of one of two ways, and the stroke that tells it from the other without colour."""

    color: str
    text: str
    dash: tuple[float, float] | None = None


FIRST = Way(style.ROUTE_1, style.ROUTE_1_TEXT)
SECOND = Way(style.ROUTE_2, style.ROUTE_2_TEXT, (13.0, 7.0))


def shift(b: ArrayLike) -> np.ndarray:
    """Return T_b, homogeneous."""
    return se2.exp(np.concatenate([[0.0], np.asarray(b, float)]))


def turn(theta: float) -> np.ndarray:
    """Return R_theta, homogeneous; radians."""
    return se2.exp([theta, 0.0, 0.0])


def parts(t: float, steps: int) -> list[float]:
    """Return how much of each of equally long steps is done at the time t."""
    return [float(np.clip(t * steps - k, 0.0, 1.0)) for k in range(steps)]


def same(a: ArrayLike, b: ArrayLike, scale: float) -> bool:
    """Whether two points, or motions, are the same in a picture of a size."""
    return bool(np.abs(np.asarray(a, float) - np.asarray(b, float)).max() <= _SAME * max(scale, 1.0))


def extent(points: Sequence[np.ndarray]) -> float:
    """Return the longer side of the box around points of the plane."""
    return float(np.ptp(np.stack(points), axis=0).max())


def straight(start: ArrayLike, along: ArrayLike) -> np.ndarray:
    """Return the two ends (2, 2) of a vector that begins at a point."""
    start = np.asarray(start, float)
    return np.stack([start, start + np.asarray(along, float)])


def about(center: ArrayLike, point: ArrayLike, theta: float, radius: float | None = None) -> np.ndarray:
    """Return the arc (n, 2) of a point that turns about another; with another radius, one beside it.

    Past a full turn it opens, so that all turns are seen; the point's own arc ends where the point does.
    """
    center = np.asarray(center, float)
    away = np.asarray(point, float) - center
    length = float(np.linalg.norm(away))
    start = float(np.arctan2(away[1], away[0]))
    if radius is not None:
        return plane.spiral(center, radius, start, theta)
    curve = plane.spiral(center, length, start, theta)
    along = np.linspace(0.0, theta, len(curve))
    true = center + length * plane.direction(start + along)
    closing = np.clip(np.abs(theta - along) / _CLOSING, 0.0, 1.0)[:, None]
    return true + closing * (curve - true)


def travellers(
    page: plane.Plane,
    letter: _letters.Letter,
    now: Sequence[np.ndarray],
    end: np.ndarray,
    t: float,
) -> list[scene.Record]:
    """Return the letter on both ways at a time, and where it will be; at the end it is one."""
    if t == 1.0:
        return letter.draw(page, end, _letters.END)
    records = letter.draw(page, end, _letters.OUTLINE)
    for T, way in zip(now, (FIRST, SECOND), strict=True):
        records += letter.draw(page, T, _letters.Look(style.AFTER, way.text))
    return records


def leg(
    page: plane.Plane,
    curve: np.ndarray,
    way: Way,
    name: str = "",
    away: ArrayLike | None = None,
    part: float = 0.5,
) -> list[scene.Record]:
    """Return a step of a way along a curve (n, 2), named at a part of it; nothing if it goes nowhere."""
    drawn = plane.path(_short(page.at(curve), _TIP), way.color, style.CURVE, dash=way.dash)
    return [*drawn, named(page, curve, f"${name}$", way.text, away, part)] if drawn and name else drawn


def given(
    page: plane.Plane, curve: np.ndarray, name: str, away: ArrayLike | None = None
) -> list[scene.Record]:
    """Return a vector that no way goes along, to be compared with others, with its name."""
    drawn = plane.path(_short(page.at(curve), _TIP), style.MUTED, style.CURVE)
    return [*drawn, named(page, curve, f"${name}$", style.INK, away)] if drawn and name else drawn


def _short(curve: np.ndarray, by: float) -> np.ndarray:
    """A curve on the page (n, 3) that ends a little earlier, if it is long enough."""
    return polyline.shortened(curve, by) if polyline.remaining(curve)[0] >= 4.0 * by else curve


def spoke(page: plane.Plane, center: ArrayLike, point: ArrayLike) -> scene.Lines:
    """Return the line from a centre to a point that turns about it; it leaves room for arrowheads."""
    line = _short(page.at(np.stack([np.asarray(center, float), np.asarray(point, float)])), _SPOKE)
    return scene.Lines(line, style.BEFORE_EDGE, style.THIN, 0.8)


def fan(
    page: plane.Plane, center: ArrayLike, curve: np.ndarray, color: str, alpha: float
) -> list[scene.Record]:
    """Return the area between a centre and an arc about it, of an arc of several turns its first turn."""
    around = curve - np.asarray(center, float)
    angles = np.unwrap(np.arctan2(around[:, 1], around[:, 0]))
    once = np.abs(angles - angles[0]) <= 2.0 * np.pi + 1e-9
    rim = curve[: len(curve) if once.all() else int(np.argmin(once))]
    corners = page.at(np.concatenate([[np.asarray(center, float)], rim]))
    faces = solids.fan_faces(len(corners))
    return [scene.Surface(corners, faces, color, material="flat", alpha=alpha)] if len(faces) else []


def area(page: plane.Plane, corners: ArrayLike, color: str, alpha: float) -> scene.Surface:
    """Return a convex area of the plane, tinted."""
    at = page.at(corners)
    return scene.Surface(at, solids.fan_faces(len(at)), color, material="flat", alpha=alpha)


def named(
    page: plane.Plane,
    curve: np.ndarray,
    text: str,
    color: str,
    away: ArrayLike | None = None,
    part: float = 0.5,
) -> scene.Label:
    """Return the name of a curve, beside a part of it; `away` is the side that it is liked at."""
    k = part * (len(curve) - 1)
    low, high = int(np.floor(k)), int(np.ceil(k))
    middle = curve[low] + (k - low) * (curve[high] - curve[low])
    if away is None:
        tangent = curve[-1] - curve[0] if len(curve) < 3 else curve[low + 1] - curve[max(low - 1, 0)]
        away = np.array([-tangent[1], tangent[0]])
    along = np.asarray(away, float)
    length = float(np.linalg.norm(along))
    along = along / length if length > 1e-12 else np.array([0.0, 1.0])
    half = wide(text, style.TEXT) / 2.0
    gap = 10.0 + half * abs(float(along[0])) + 14.0 * abs(float(along[1]))
    return scene.Label(text, page.at(middle), color, style.TEXT, (gap * along[0], gap * along[1]), room=44.0)


def angle(
    page: plane.Plane, curve: np.ndarray, center: np.ndarray, name: str = r"\theta"
) -> list[scene.Record]:
    """Return the angle theta between two vectors that begin at a point; nothing where it is 0."""
    drawn = plane.path(page.at(curve), style.ARC, style.CURVE)
    if not drawn:
        return []
    label = [named(page, curve, f"${name}$", style.ARC_TEXT, curve[len(curve) // 2] - center)] if name else []
    return [*fan(page, center, curve, style.ARC, 0.20), *drawn, *label]


def center(page: plane.Plane, text: str, at: np.ndarray, away: ArrayLike) -> scene.Label:
    """Return the name of a centre of turns."""
    return page.beyond(text, at, away, gap=28.0, room=44.0)


def tags(
    page: plane.Plane,
    letter: _letters.Letter,
    motions: Sequence[np.ndarray],
    names: Sequence[str],
    join: str,
) -> list[scene.Label]:
    """Return the names of shapes; those that are one have theirs joined."""
    scale = float(np.abs(motions).max())
    groups: list[list[int]] = []
    for k, T in enumerate(motions):
        if group := next((g for g in groups if same(T, motions[g[0]], scale)), None):
            group.append(k)
        else:
            groups.append([k])
    return [
        _letters.beside(page, letter, motions[g[0]], "$" + join.join(names[k] for k in g) + "$")
        for g in groups
    ]


def wide(text: str, size: float) -> float:
    """Return about how wide a text is, in page units, from the number of its signs."""
    signs = re.sub(r"\\(mathrm|mathbf|left|right)|\$", "", text)
    signs = re.sub(r"\\[,;:!]", " ", signs)
    signs = re.sub(r"\\[a-zA-Z]+", "o", signs)
    low = "".join(a or b for a, b in re.findall(r"[_^](?:\{([^{}]*)\}|(.))", signs))
    high = re.sub(r"[_^](?:\{[^{}]*\}|.)|[{}]", "", signs)
    return size * (0.47 * len(high) + 0.34 * len(low) + 0.35 * text.count("="))


def title(text: str) -> scene.Label:
    """Return the line above the picture."""
    return scene.Label(text, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")


def note(text: str, x: float = 600.0, y: float = 44.0, anchor: str = "cn") -> scene.Label:
    """Return a line below the picture."""
    return scene.Label(text, (x, y, 0.0), style.INK, style.SMALL_TEXT, anchor=anchor)


def legend(entries: Sequence[tuple[Way, str]], y: float = 96.0) -> list[scene.Record]:
    """Return the ways side by side in the middle below the picture: a stroke of each, and what it is."""
    stroke, gap, between = 74.0, 18.0, 84.0
    widths = [stroke + gap + wide(text, style.SMALL_TEXT) for _, text in entries]
    x = 600.0 - (sum(widths) + between * (len(entries) - 1)) / 2.0
    records: list[scene.Record] = []
    for (way, text), width in zip(entries, widths, strict=True):
        line = np.array([[x, y + 10.0, 0.0], [x + stroke, y + 10.0, 0.0]])
        records += plane.path(line, way.color, style.CURVE, dash=way.dash)
        at = (x + stroke + gap, y, 0.0)
        records.append(scene.Label(text, at, way.text, style.SMALL_TEXT, anchor="ln"))
        x += width + between
    return records


def degrees(theta: float) -> str:
    """Return an angle as mathtext, in degrees, without the dollars."""
    return rf"{number(np.rad2deg(theta), 1)}^{{\circ}}"


def vectors(*several: ArrayLike) -> list[str]:
    """Return vectors as mathtext, without the dollars, all with equally many decimals."""
    values = [np.asarray(v, float) for v in several]
    texts = [number(x) for v in values for x in v]
    digits = max(len(text.partition(".")[2]) for text in texts)
    return [rf"({{{_fixed(v[0], digits)}}},\, {{{_fixed(v[1], digits)}}})" for v in values]


def _fixed(value: float, digits: int) -> str:
    return f"{round(float(value), digits) + 0.0:.{digits}f}"


def fit(
    points: Iterable[ArrayLike], size: float, box: tuple[float, float, float, float] = BOX
) -> plane.Plane:
    """Return the plane that shows all of several sets of points, and no shape of a size too large."""
    every = np.concatenate([np.asarray(p, float).reshape(-1, 2) for p in points])
    return plane.fit(every, box, _HIGHEST / size)


def swept(letter: _letters.Letter, at: Moving) -> list[np.ndarray]:
    """Return the corners of the letter at times from 0 to 1, so that a page holds it all along its ways."""
    return [letter.outline(T) for t in np.linspace(0.0, 1.0, 61) for T in at(float(t))]


def picture(records: Sequence[scene.Record]) -> scene.Picture:
    """Return a page with one view."""
    return scene.Picture((scene.View(tuple(records)),))
