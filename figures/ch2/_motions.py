"""What the pictures of motions in the plane share: the shape, the legs of a way, names, a legend."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lietool.lie import se2
from lietool.mesh import shapes
from lietool.render import plane, scene, style
from lietool.render.plot import number

# The marked point of the shape, where arrows begin and end: the foot of the F.
FOOT = shapes.letter_outline()[0]
ORIGIN = np.zeros(2)
# Where pictures lie on the page: under the title and above the legend.
BOX = (120.0, 180.0, 960.0, 590.0)
# Points nearer than this part of the picture are one.
_SAME = 1e-9
# The last part of an arc of several turns, radians, along which it comes back to its radius.
_CLOSING = 1.2
# The most that a shape is high on the page.
_HIGHEST = 300.0


@dataclass(frozen=True)
class Look:
    """How a shape is drawn."""

    fill: str
    edge: str
    alpha: float = 1.0
    dash: tuple[float, float] | None = None


START = Look(style.BEFORE, style.BEFORE_EDGE)
STAGE = Look(style.BETWEEN, style.BETWEEN_EDGE)
END = Look(style.AFTER, style.AFTER_EDGE)
# Where a shape will be, or would be.
OUTLINE = Look(style.AFTER, style.AFTER_EDGE, 0.16, (7.0, 6.0))


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


def outline(T: np.ndarray, size: float) -> np.ndarray:
    """Return the shape's corners (10, 2), its foot where T takes the origin."""
    return plane.moved(T, size * (shapes.letter_outline() - FOOT))


def shape(page: plane.Plane, T: np.ndarray, size: float, look: Look) -> list[scene.Record]:
    """Return the shape, its foot where T takes the origin."""
    return page.glyph(
        T @ shift(-size * FOOT), look.fill, look.edge, size=size, alpha=look.alpha, dash=look.dash
    )


def stages(page: plane.Plane, motions: Sequence[np.ndarray], size: float) -> list[scene.Record]:
    """Return the shape at the start and where it pauses."""
    records = shape(page, motions[0], size, START)
    for T in motions[1:]:
        records += shape(page, T, size, STAGE)
    return records


def travellers(
    page: plane.Plane, now: Sequence[np.ndarray] | np.ndarray, end: np.ndarray, size: float, t: float
) -> list[scene.Record]:
    """Return the shape on both ways at a time, and where it will be; at the end it is one."""
    if t == 1.0:
        return shape(page, end, size, END)
    records = shape(page, end, size, OUTLINE)
    for T, way in zip(now, (FIRST, SECOND), strict=True):
        records += shape(page, T, size, Look(style.AFTER, way.text))
    return records


def leg(
    page: plane.Plane, curve: np.ndarray, way: Way, name: str = "", away: ArrayLike | None = None
) -> list[scene.Record]:
    """Return a step of a way along a curve (n, 2), with its name; nothing if it goes nowhere."""
    drawn = plane.path(page.at(curve), way.color, style.CURVE, dash=way.dash)
    return [*drawn, named(page, curve, f"${name}$", way.text, away)] if drawn and name else drawn


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


def named(
    page: plane.Plane, curve: np.ndarray, text: str, color: str, away: ArrayLike | None = None
) -> scene.Label:
    """Return the name of a curve, beside its middle; `away` is the side that it is liked at."""
    k = (len(curve) - 1) / 2.0
    middle = (curve[int(np.floor(k))] + curve[int(np.ceil(k))]) / 2.0
    if away is None:
        tangent = curve[-1] - curve[0] if len(curve) < 3 else curve[int(k) + 1] - curve[int(k) - 1]
        away = np.array([-tangent[1], tangent[0]])
    return page.beyond(text, middle, away, color=color, gap=32.0, room=110.0)


def angle(page: plane.Plane, curve: np.ndarray, center: np.ndarray) -> list[scene.Record]:
    """Return the angle theta between two vectors that begin at a point; nothing where it is 0."""
    drawn = plane.path(page.at(curve), style.ARC, style.EDGE)
    if not drawn:
        return []
    return [*drawn, named(page, curve, r"$\theta$", style.ARC_TEXT, curve[len(curve) // 2] - center)]


def tagged(
    page: plane.Plane, T: np.ndarray, size: float, text: str, toward: ArrayLike, wide: float = 50.0
) -> scene.Label:
    """Return the name of a shape, outside of it on the side of a direction; `wide` is about its width."""
    corners = page.at(outline(T, size))[:, :2]
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    along = np.asarray(toward, float)
    length = float(np.linalg.norm(along))
    along = along / length if length > 1e-9 else np.array([0.0, 1.0])
    # Text is wider than high, so that beside a shape it begins further out than above.
    reach = float(((corners - middle) @ along).max()) + 30.0 + wide / 2.0 * abs(float(along[0]))
    return scene.Label(
        text, (*middle, 0.0), style.INK, style.TEXT, (reach * along[0], reach * along[1]), room=reach + 45.0
    )


def tags(
    page: plane.Plane,
    shapes_: Sequence[np.ndarray],
    size: float,
    names: Sequence[tuple[str, float]],
    towards: Sequence[ArrayLike],
    join: str,
) -> list[scene.Label]:
    """Return the names of shapes (each with about its width); those that are one have theirs joined."""
    scale = float(np.abs(shapes_).max())
    groups: list[list[int]] = []
    for k, T in enumerate(shapes_):
        if group := next((g for g in groups if same(T, shapes_[g[0]], scale)), None):
            group.append(k)
        else:
            groups.append([k])
    return [
        tagged(
            page,
            shapes_[g[0]],
            size,
            "$" + join.join(names[k][0] for k in g) + "$",
            towards[g[0]],
            sum(names[k][1] for k in g),
        )
        for g in groups
    ]


def title(text: str) -> scene.Label:
    """Return the line above the picture."""
    return scene.Label(text, (600.0, 842.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")


def note(text: str, x: float = 600.0, y: float = 44.0, anchor: str = "cn") -> scene.Label:
    """Return a line below the picture."""
    return scene.Label(text, (x, y, 0.0), style.INK, style.SMALL_TEXT, anchor=anchor)


def legend(entries: Sequence[tuple[Way, str]], y: float = 96.0) -> list[scene.Record]:
    """Return the ways side by side below the picture: a stroke of each, and what it is."""
    records: list[scene.Record] = []
    column = 1000.0 / len(entries)
    for k, (way, text) in enumerate(entries):
        x = 600.0 + column * (k - len(entries) / 2.0) + 40.0
        stroke = np.array([[x, y + 10.0, 0.0], [x + 74.0, y + 10.0, 0.0]])
        records += plane.path(stroke, way.color, style.CURVE, dash=way.dash)
        records.append(scene.Label(text, (x + 94.0, y, 0.0), way.text, style.SMALL_TEXT, anchor="ln"))
    return records


def degrees(theta: float) -> str:
    """Return an angle as mathtext, in degrees, without the dollars."""
    return rf"{number(np.rad2deg(theta), 1)}^{{\circ}}"


def vector(b: ArrayLike) -> str:
    """Return a vector as mathtext, without the dollars."""
    x, y = np.asarray(b, float)
    return rf"({{{number(x)}}},\, {{{number(y)}}})"


def fit(
    points: Iterable[ArrayLike], size: float, box: tuple[float, float, float, float] = BOX
) -> plane.Plane:
    """Return the plane that shows all of several sets of points, and no shape of a size too large."""
    every = np.concatenate([np.asarray(p, float).reshape(-1, 2) for p in points])
    return plane.fit(every, box, _HIGHEST / size)


def picture(records: Sequence[scene.Record]) -> scene.Picture:
    """Return a page with one view."""
    return scene.Picture((scene.View(tuple(records)),))
