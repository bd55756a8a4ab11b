"""Weights from a controller: a point in a polygon whose corners are the shapes, and beyond it."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from lietool.deform import controller
from lietool.figure import Drawing
from lietool.render import mesh_page, style
from lietool.render.camera import Box, Camera, project
from lietool.render.scene import Label, Lines, Picture, Points, Record, View

from . import _blend_look as look
from ._blend_family import Family
from ._blend_ways import notes

Array = np.ndarray

_PLANE: Box = (36.0, 60.0, 640.0, 780.0)
_LARGE: Box = (690.0, 130.0, 474.0, 690.0)
_MIDDLE, _RADIUS = (356.0, 436.0), 158.0
_SMALL = 200.0
# From corners to their shapes; from feet to the base line of a weight.
_GAP, _UNDER = 30.0, 44.0
_MARK = 13.0
# Lines to corners: of weight 0, and how much thicker of weight 1.
_HAIR, _THICK = 1.0, 12.0
_KEPT = 8
# Where shapes along a ray stand: from left to right, their middle and height, the room between them.
_ROW, _HIGH, _BETWEEN = (34.0, 1104.0), (606.0, 370.0), 30.0
# A column has room for its texts.
_TEXT = 306.0
# The polygons below them.
_GLYPH_AT, _GLYPH = 264.0, 90.0


def polygon(family: Family) -> controller.Controller:
    """The controller of a family: the rest at its first corner, at the top.

    Raises
    ------
    ValueError
        If there are fewer than three shapes.
    """
    if len(family) < 2:
        remedy = "Name one more, or blend by --weights"
        raise ValueError(f"a controller must have two targets or more; got {len(family)}. {remedy}")
    return controller.controller(controller.regular(len(family) + 1), rest=0)


def position(reach: float, phase: float) -> Array:
    """The point so far from the middle, in this direction in degrees from the right, counter-clockwise."""
    angle = np.radians(phase)
    # To the last bit on the corners that lie along an axis.
    return reach * np.round([np.cos(angle), np.sin(angle)], 15)


def drawing(family: Family, way: str, reach: float, phase: float) -> Drawing:
    """Return the controller with the shapes at its corners, and beside it the shape of its position."""
    by = polygon(family)
    at = position(reach, phase)
    weights = np.round(by.weights(at), 12) + 0.0
    made = family.blended(way, weights)
    camera = _around_path(family, way, reach)
    fill = look.mixed(weights, look.points(family))
    large = look.creature(family, made.vertices, camera, fill, style.BETWEEN, style.GREYS[0])
    views = [View(tuple(_plane(by, at))), *_corners(family, by, weights)]
    views.append(View((Points(_page(at), style.MARK, _MARK),)))
    views.append(View(tuple(large), camera, _LARGE))
    views.append(View(tuple(mesh_page.titles([_PLANE, _LARGE], ["controller", "blended shape"]))))
    numbers = {
        "position": at,
        "weights": weights,
        "bounds": look.bounds(made.vertices),
        "distance": look.distances(family, made.vertices),
        "flipped": made.flips,
    }
    told = notes(family, family.prepared(way), made)
    return Drawing(Picture(tuple(views)), numbers, family.written(made.vertices), tuple(told))


def _camera(shapes: list[Array], family: Family, box: Box) -> Camera:
    return mesh_page.together([family.upright(X) for X in shapes], family.direction, box, 1.08)


@lru_cache(_KEPT)
def _around_path(family: Family, way: str, reach: float) -> Camera:
    """One camera for all the positions of a film."""
    places = np.stack([position(reach, t) for t in np.arange(0.0, 360.0, 30.0)])
    shapes = [family.blended(way, w).vertices for w in polygon(family).weights(places)]
    return _camera(shapes, family, _LARGE)


def _page(p: Array) -> Array:
    return np.pad(np.asarray(_MIDDLE) + _RADIUS * np.atleast_2d(p), ((0, 0), (0, 1)))


def _plane(by: controller.Controller, at: Array) -> list[Record]:
    """The polygon, and from a point in it lines to its corners, as thick as their weights."""
    rim = np.concatenate([by.corners, by.corners[:1]])
    weights = by.weights(at)
    shares = np.append(1.0 - weights.sum(), weights)
    spokes = [
        Lines(_page(np.stack([at, c])), style.MUTED, _HAIR + _THICK * min(max(share, 0.0), 1.0))
        for c, share in zip(by.corners, shares, strict=True)
    ]
    return [
        *spokes,
        Lines(_page(rim), style.INK, style.EDGE),
        *(
            Points(_page(c), style.BEFORE_EDGE if k == 0 else look.tone(k - 1), 11.0, style.INK, False)
            for k, c in enumerate(by.corners)
        ),
    ]


def _corners(family: Family, by: controller.Controller, weights: Array) -> list[View]:
    """The shapes at the corners, each with its weight."""
    shapes = [family.rest, *family.targets]
    shares = np.append(1.0 - weights.sum(), weights)
    boxes = [(0.0, 0.0, _SMALL, _SMALL)] * len(shapes)
    cameras = mesh_page.each([family.upright(X) for X in shapes], family.direction, boxes, 1.12)
    views = []
    for k, (X, camera, box) in enumerate(zip(shapes, cameras, boxes, strict=True)):
        seen = project(camera, box, family.upright(X))[:, :2]
        low, high = seen.min(axis=0), seen.max(axis=0)
        # What is to stand at a corner: the shape, and its weight below it.
        low[1] -= _UNDER + 8.0
        x, y = _page(by.corners[k])[0, :2] - low + _beside(by.corners[k], high - low)
        colours = look.REST if k == 0 else look.target(k - 1)
        views.append(View(tuple(look.creature(family, X, camera, *colours)), camera, (x, y, *box[2:])))
        middle = x + 0.5 * (low[0] + high[0])
        views.append(View((look.line(rf"$w_{{{k}}} = {look.number(shares[k])}$", middle, y + low[1] + 8.0),)))
    return views


def _beside(corner: Array, size: Array) -> Array:
    """Where the left lower corner of a box lies that is outside of a corner of the polygon, one gap away."""
    out = corner / np.linalg.norm(corner)
    # From the box's middle to its rim in this direction.
    reach = np.min(0.5 * size / np.maximum(np.abs(out), 1e-9))
    return (reach + _GAP) * out - 0.5 * size


def ray(family: Family, way: str, reach: float, phase: float) -> Drawing:
    """Return shapes from the middle of the controller outwards: half way, on its rim, and beyond."""
    by = polygon(family)
    reaches = np.array([0.5, 1.0, reach])
    ats = np.stack([position(r, phase) for r in reaches])
    weights = np.round(by.weights(ats), 12) + 0.0
    made = [family.blended(way, w) for w in weights]
    far = np.stack([look.distances(family, one.vertices) for one in made])
    # The target that the way leads nearest to.
    led = int(np.argmax(weights[1]))
    camera, boxes, columns = _side_by_side([one.vertices for one in made], family)
    views, page = [], []
    for k, (one, box, column) in enumerate(zip(made, boxes, columns, strict=True)):
        fill = look.mixed(weights[k], look.points(family))
        records = look.creature(family, one.vertices, camera, fill, style.BETWEEN, style.GREYS[0])
        views.append(View(tuple(records), camera, box))
        middle = column[0] + column[2] / 2.0
        page += _way(by, ats[k], weights[k], (middle, _GLYPH_AT))
        # More than three do not fit into a line.
        few = rf"$\mathbf{{w}} = ({look.numbers(weights[k])})$"
        one_of = rf"$w_{{{led + 1}}} = {look.number(weights[k, led])}$"
        page.append(look.line(few if len(family) <= 3 else one_of, middle, 98.0))
        away = f"off by up to {far[k, led]:.2f}"
        page.append(look.line(away if far[k, led] else f"target {led + 1}", middle, 52.0))
    rim = "at the corner" if np.max(weights[1]) == 1.0 else "at the rim"
    page += mesh_page.titles(columns, ["half way", rim, f"{reach:g} times as far"])
    numbers = {
        "positions": ats,
        "weights": weights,
        "bounds": np.stack([look.bounds(one.vertices) for one in made]),
        "distance": far,
        "flipped": [one.flips for one in made],
    }
    return Drawing(Picture((*views, View(tuple(page)))), numbers)


def _side_by_side(shapes: list[Array], family: Family) -> tuple[Camera, list[Box], list[Box]]:
    """One camera for shapes on one ground, as large as the page allows; their boxes, and their columns."""
    upright = [family.upright(X) for X in shapes]
    full = (0.0, 0.0, _ROW[1] - _ROW[0], _HIGH[1])
    camera = mesh_page.together(upright, family.direction, full, 1.02)
    seen = [project(camera, full, U)[:, 0] for U in upright]
    wide = np.array([np.ptp(x) for x in seen])
    room = full[2] - _BETWEEN * (len(shapes) - 1)
    # The largest scale at which all columns fit; none is narrower than its texts.
    scales = np.linspace(1.0, 0.2, 161)
    fits = [bool(np.maximum(s * wide, _TEXT).sum() <= room) for s in scales]
    scale = float(scales[int(np.argmax(fits))])
    camera = replace(camera, height=camera.height / scale)
    widths = np.maximum(scale * wide, _TEXT)
    widths += (room - widths.sum()) / len(widths)
    left = _ROW[0] + np.concatenate([[0.0], np.cumsum(widths + _BETWEEN)[:-1]])
    low = _HIGH[0] - 0.5 * full[3]
    boxes = []
    for U, x, width in zip(upright, left, widths, strict=True):
        span = project(camera, full, U)[:, 0]
        boxes.append((float(x + 0.5 * width - 0.5 * (span.min() + span.max())), low, full[2], full[3]))
    columns = [(float(x), low, float(w), full[3]) for x, w in zip(left, widths, strict=True)]
    return camera, boxes, columns


def _way(by: controller.Controller, at: Array, weights: Array, middle: tuple[float, float]) -> list[Record]:
    """The polygon with its corners numbered, and the way from its middle to where the ball is."""
    start = np.array([*middle, 0.0])
    end = start + _GLYPH * np.append(at, 0.0)
    records: list[Record] = [
        Lines(np.stack([start, end]), style.MARK, style.EDGE),
        Points(start[None], style.MARK, 4.0),
        *look.glyph([weights], middle, _GLYPH, True, 10.0),
    ]
    for k, corner in enumerate(by.corners):
        place = start + _GLYPH * np.append(corner, 0.0)
        # Beside the corner, not on a way that goes through it.
        along = float(corner @ at) / max(float(np.linalg.norm(corner) * np.linalg.norm(at)), 1e-9)
        offset = (
            (20.0, 10.0 if corner[1] > 0.0 else -10.0)
            if abs(corner[0]) < 0.5
            else (8.0 * np.sign(corner[0]), -30.0)
        )
        if len(by.corners) > 4 and along < 0.9:
            offset = 24.0 * corner[0], 24.0 * corner[1]
        records.append(Label(rf"${k}$", place, style.INK, style.SMALL_TEXT, offset, "cc"))
    return records


def alone(family: Family, way: str, full: Array, grown: float) -> Drawing:
    """Return nothing but the blended shape, grown so far towards full weights."""
    weights = grown * full
    made = family.blended(way, weights)
    box = (60.0, 60.0, 1080.0, 780.0)
    shapes = [family.rest, *family.targets, family.blended(way, full).vertices]
    camera = _camera(shapes, family, box)
    records = look.creature(family, made.vertices, camera, *look.own(family, 0, look.RESULT))
    records += look.hatched(family, made.vertices, made.fallback, camera, box)
    title = look.line(
        rf"$\mathbf{{w}} = ({look.numbers(weights)})$" if len(weights) <= 6 else "blended", 600.0, 40.0
    )
    numbers = {"weights": weights, "bounds": look.bounds(made.vertices), "flipped": made.flips}
    told = notes(family, family.prepared(way), made)
    picture = Picture((View(tuple(records), camera, box), View((title,))))
    return Drawing(picture, numbers, family.written(made.vertices), tuple(told))
