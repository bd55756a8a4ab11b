"""A population: variations of a few shapes with weights at random, each with the colour of its mixture."""

import numpy as np

from lietool.deform import population
from lietool.figure import Drawing
from lietool.render import mesh_page, style
from lietool.render.camera import Box, Camera
from lietool.render.scene import Picture, View

from . import _blend_look as look
from ._blend_family import Family

Array = np.ndarray

# Of the parents, and of their variations.
_LEFT, _RIGHT = (30.0, 96.0, 250.0, 726.0), (300.0, 96.0, 870.0, 726.0)
_MOST = 5
_GLYPH = 31.0


def drawing(family: Family, way: str, count: int, seed: int, concentration: float, grown: float) -> Drawing:
    """Return the targets, and variations of them that have grown so far from the rest."""
    own = population.dirichlet(count, len(family), seed, concentration=concentration)
    made = [family.blended(way, grown * w) for w in own]
    # For all moments of a film one scale.
    full = made if grown == 1.0 else [family.blended(way, w) for w in own]
    parents = family.targets[:_MOST]
    left = mesh_page.grid(len(parents), 1, _LEFT)
    right = mesh_page.grid(*_rows(count), _RIGHT)[:count]
    views = []
    # One scale for all.
    shapes = [*parents, *(one.vertices for one in full)]
    cameras = _cameras(family, shapes, [*left, *right])
    for k, (X, camera, box) in enumerate(zip(parents, cameras, left, strict=False)):
        views.append(View(tuple(look.creature(family, X, camera, *look.target(k))), camera, box))
    for one, w, camera, box in zip(made, grown * own, cameras[len(left) :], right, strict=True):
        fill = look.mixed(w, look.points(family))
        records = look.creature(family, one.vertices, camera, fill, style.BETWEEN, style.GREYS[0])
        views.append(View(tuple(records), camera, box))
    page = mesh_page.titles([_LEFT, _RIGHT], [_title(len(family)), "variations"])
    glyphs = []
    for w, (x, y, width, _) in zip(
        [*np.eye(len(family))[: len(parents)], *own], [*left, *right], strict=True
    ):
        middle = x + width - 36.0, y + 28.0
        glyphs += look.glyph([w], middle, min(_GLYPH, 0.15 * width), rest=False, dot=7.0)
    said = "" if grown == 1.0 else rf", here times ${grown:.2f}$"
    legend = mesh_page.legend(f"ball in the triangle: the weights of the shape beside it{said}")
    numbers = {
        "weights": grown * own,
        "bounds": np.stack([look.bounds(one.vertices) for one in made]),
        "flipped": [one.flips for one in made],
        "lacking": [int(one.fallback.sum()) for one in made],
    }
    return Drawing(Picture((*views, View((*page, *glyphs, legend)))), numbers)


def _cameras(family: Family, shapes: list[Array], boxes: list[Box]) -> list[Camera]:
    return mesh_page.each([family.upright(X) for X in shapes], family.direction, boxes, 1.08)


def _title(count: int) -> str:
    return {1: "one shape", 2: "two shapes", 3: "three shapes"}.get(count, f"{count} shapes")


def _rows(count: int) -> tuple[int, int]:
    """Rows and columns for so many, in a box of this shape."""
    columns = int(np.ceil(np.sqrt(count * _RIGHT[2] / _RIGHT[3])))
    return -(-count // columns), columns
