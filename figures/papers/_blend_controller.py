"""Weights from a controller: a point in a polygon whose corners are the shapes, and beyond it."""

from functools import lru_cache

import numpy as np

from lietool.deform import controller
from lietool.figure import Drawing
from lietool.render import mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.scene import Label, Lines, Picture, Points, Record, View

from . import _blend_look as look
from ._blend_family import Family
from ._blend_ways import notes

Array = np.ndarray

_PLANE: Box = (36.0, 60.0, 640.0, 780.0)
_LARGE: Box = (690.0, 130.0, 474.0, 690.0)
_MIDDLE, _RADIUS = (346.0, 452.0), 145.0
_SMALL = 190.0
# How far from the middle the shapes of the corners stand, in radii.
_OUT = 1.76
_MARK = 13.0
_KEPT = 8
_ABOVE: Box = (36.0, 340.0, 1088.0, 490.0)


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
    views = [View(tuple(_plane(by, at, reach))), *_corners(family, by, weights)]
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


def _plane(by: controller.Controller, at: Array, reach: float) -> list[Record]:
    """The polygon, the closed path of a film, and the point on it."""
    rim = np.concatenate([by.corners, by.corners[:1]])
    path = np.stack([position(reach, t) for t in np.linspace(0.0, 360.0, 181)])
    spokes = [Lines(_page(np.stack([at, c])), style.RULE, style.THIN) for c in by.corners]
    return [
        *spokes,
        Lines(_page(rim), style.INK, style.EDGE),
        Lines(_page(path), style.MARK, style.THIN, 0.7, dash=(9.0, 7.0)),
        *(
            Points(_page(c), style.BEFORE_EDGE if k == 0 else look.tone(k - 1), 11.0, style.INK, False)
            for k, c in enumerate(by.corners)
        ),
    ]


def _corners(family: Family, by: controller.Controller, weights: Array) -> list[View]:
    """The shapes at the corners, each with its weight."""
    shapes = [family.rest, *family.targets]
    shares = np.append(1.0 - weights.sum(), weights)
    boxes = []
    for c in by.corners:
        x, y, _ = _page(_OUT * c)[0]
        boxes.append((x - _SMALL / 2.0, y - _SMALL / 2.0 + 16.0, _SMALL, _SMALL))
    cameras = mesh_page.each([family.upright(X) for X in shapes], family.direction, boxes, 1.12)
    views = []
    for k, (X, camera, box) in enumerate(zip(shapes, cameras, boxes, strict=True)):
        colours = look.REST if k == 0 else look.target(k - 1)
        views.append(View(tuple(look.creature(family, X, camera, *colours)), camera, box))
        text = rf"$w_{{{k}}} = {look.number(shares[k])}$"
        if by.corners[k, 1] > 0.5:
            # Under the one above the polygon is its corner.
            label = Label(text, (box[0] + box[2], box[1] + 0.5 * box[3], 0.0), style.INK, anchor="lc")
        else:
            label = look.line(text, box[0] + box[2] / 2.0, box[1] - 14.0)
        views.append(View((label,)))
    return views


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
    boxes = mesh_page.grid(1, len(made), _ABOVE)
    camera = _camera([one.vertices for one in made], family, boxes[0])
    views, page = [], []
    for k, (one, box) in enumerate(zip(made, boxes, strict=True)):
        fill = look.mixed(weights[k], look.points(family))
        records = look.creature(family, one.vertices, camera, fill, style.BETWEEN, style.GREYS[0])
        views.append(View(tuple(records), camera, box))
        middle = box[0] + box[2] / 2.0
        page += look.glyph(list(weights[k : k + 1]), (middle, 230.0), 84.0, True, 10.0)
        page.append(look.line(rf"$\mathbf{{w}} = ({look.numbers(weights[k])})$", middle, 94.0))
        said = (
            f"{100.0 * far[k, led]:.0f} % away from target {led + 1}" if far[k, led] else f"target {led + 1}"
        )
        page.append(look.line(said, middle, 48.0))
    rim = "at the corner" if np.max(weights[1]) == 1.0 else "at the rim"
    page += mesh_page.titles(boxes, ["half way", rim, f"{reach:g} times as far"])
    numbers = {
        "positions": ats,
        "weights": weights,
        "bounds": np.stack([look.bounds(one.vertices) for one in made]),
        "distance": far,
        "flipped": [one.flips for one in made],
    }
    return Drawing(Picture((*views, View(tuple(page)))), numbers)


def alone(family: Family, way: str, full: Array, grown: float) -> Drawing:
    """Return nothing but the blended shape, grown so far towards full weights."""
    weights = grown * full
    made = family.blended(way, weights)
    box = (60.0, 60.0, 1080.0, 780.0)
    shapes = [family.rest, *family.targets, family.blended(way, full).vertices]
    camera = _camera(shapes, family, box)
    records = look.creature(family, made.vertices, camera, *look.RESULT)
    records += look.hatched(family, made.vertices, made.fallback, camera, box)
    title = look.line(
        rf"$\mathbf{{w}} = ({look.numbers(weights)})$" if len(weights) <= 6 else "blended", 600.0, 40.0
    )
    numbers = {"weights": weights, "bounds": look.bounds(made.vertices), "flipped": made.flips}
    told = notes(family, family.prepared(way), made)
    picture = Picture((View(tuple(records), camera, box), View((title,))))
    return Drawing(picture, numbers, family.written(made.vertices), tuple(told))
