"""Section 7.3.1 of the book begins with images: an edit in the domain of gradients."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.render import raster, scene, style
from lietool.render.camera import Box
from lietool.render.mesh_lines import level_lines
from lietool.render.plot import number
from lietool.render.solids import grid_faces

from . import _paste

Array = np.ndarray

_TITLE, _SECOND, _FOOT = 846.0, 516.0, 52.0
# The upper images lie between these edges, at most so wide, with equal gaps.
_LEFT, _RIGHT, _UPPER = 40.0, 1160.0, (348.0, 262.0)
_LOWER: tuple[Box, ...] = ((40.0, 96.0, 542.0, 404.0), (618.0, 96.0, 542.0, 404.0))
# The relief where the field is 0, and how much a step of one level lightens it.
_LEVEL, _GAIN = 168.0, 5.0
# Pixels each way that a page can show; of more, means are shown.
_MOST = 1100


@figure(
    plates={
        "G7.10": Plate(
            title="An image edited by its gradient",
            equations=("7.10", "7.11"),
            caption=(
                "A balloon on a bright day, a sky at dusk, and the field g': inside the red line the "
                "gradient of the one, outside that of the other; drawn as a relief lit from the upper left, "
                "grey where g' is 0. Below, the pixels copied, with a seam, and the image whose gradient is "
                "nearest to g': no seam, and the balloon in the evening's light. In its shade four per cent "
                "of what is pasted would be darker than black."
            ),
        ),
    },
    time=Time("across", 0.18, 0.82),
)
def poisson_image(
    view: Annotated[
        Literal["story", "result"], Param("all that belongs to it, or the edited image alone, pixel by pixel")
    ] = "story",
    gradients: Annotated[
        Literal["source", "mixed"],
        Param("inside the mask: the source's, or pixel by pixel the stronger of both"),
    ] = "source",
    across: Annotated[
        float, Param("where the middle of the mask goes, of the target's width", low=0.0, high=1.0)
    ] = 0.68,
    down: Annotated[
        float, Param("where it goes, of the target's height from above", low=0.0, high=1.0)
    ] = 0.39,
    source: Annotated[Path | None, Param("your own image to paste (png, ...)", positional=1)] = None,
    target: Annotated[Path | None, Param("your own image to paste it into", positional=2)] = None,
    mask: Annotated[
        Path | None,
        Param(
            "which part of the source: white on black, of its size; unless given, where the source is opaque",
            positional=3,
        ),
    ] = None,
    *,
    solve: Library = Library("lietool.deform.image.solve"),
) -> Drawing:
    """One image pasted into another by its gradient: the solution of Poisson's equation has no seam.

    What to look for: in the plain copy, the bright sky around the balloon. The edit
    keeps the steps from pixel to pixel inside the mask and takes the colours at its
    edge from the target: the error in the colours is spread over the whole inside,
    where nobody sees it, and so the balloon itself changes its colours.
    """
    given = _paste.paste(source, target, mask, across, down)
    made = _paste.edit(given, gradients == "mixed", solve)
    picture = _alone(made) if view == "result" else _story(made)
    return Drawing(picture, _numbers(made))


def _numbers(made: _paste.Edit) -> dict[str, object]:
    edited = made.result.image
    rows = np.linspace(0, len(edited) - 1, 9).round().astype(int)
    return {
        "step across the edge": {
            "copy": made.step(made.copy),
            "result": made.step(edited),
            "target": made.step(made.paste.target),
        },
        "energy": {"copy": made.energy(made.copy), "result": made.result.energy},
        "darker than black": float((edited[made.paste.inside] < 0.0).any(axis=1).mean()),
        "range": [float(edited.min()), float(edited.max())],
        "result, some rows and every ninth column": edited[rows][:, ::9],
    }


def _alone(made: _paste.Edit) -> scene.Picture:
    edited = made.result.image
    size = edited.shape[1], edited.shape[0]
    image = scene.Image(
        edited / 255.0, (0.0, 0.0, 0.0), (size[0], 0.0, 0.0), (0.0, size[1], 0.0), smooth=False
    )
    return scene.Picture((scene.View((image,)),), size=size)


def _story(made: _paste.Edit) -> scene.Picture:
    given = made.paste
    records: list[scene.Record] = []
    upper = (
        (given.source, given.mask, "source"),
        (given.target, given.inside, "target"),
        (_relief(made.field), given.inside, "guidance field $\\mathbf{g}'$"),
    )
    for box, (levels, mask, name) in zip(_row([levels for levels, *_ in upper]), upper, strict=True):
        records += _panel(box, levels, name, _TITLE, mask)
    lower = (
        (made.copy, "pixels copied"),
        (made.result.image, r"gradients copied: $\Delta I' = \mathrm{div}\,\mathbf{g}'$"),
    )
    for box, (levels, name) in zip(_LOWER, lower, strict=True):
        records += _panel(box, levels, name, _SECOND)
    steps = [number(made.step(levels), 1) for levels in (made.copy, made.result.image, given.target)]
    lines = (
        f"mean step across the seam: {steps[0]} of 255",
        f"across the seam: {steps[1]} (the target's own: {steps[2]})",
    )
    for box, line in zip(_LOWER, lines, strict=True):
        records.append(_text(line, box, _FOOT, style.SMALL_TEXT))
    return scene.Picture((scene.View(tuple(records)),))


def _row(images: list[Array]) -> list[Box]:
    """Boxes of the images of the upper row, which are not of one width: with equal gaps, edge to edge."""
    own = [raster.fitted((0.0, 566.0, *_UPPER), (a.shape[1], a.shape[0])) for a in images]
    gap = (_RIGHT - _LEFT - sum(box[2] for box in own)) / (len(own) - 1)
    left = _LEFT + np.concatenate([[0.0], np.cumsum([box[2] + gap for box in own])])
    return [(float(x), box[1], box[2], box[3]) for x, box in zip(left, own, strict=False)]


def _panel(box: Box, levels: Array, name: str, base: float, mask: Array | None = None) -> list[scene.Record]:
    """An image with its name above, and the outline of a mask on it."""
    place = raster.fitted(box, (levels.shape[1], levels.shape[0]))
    x, y, w, h = place
    frame = np.array([(x, y, 0.0), (x + w, y, 0.0), (x + w, y + h, 0.0), (x, y + h, 0.0), (x, y, 0.0)])
    records: list[scene.Record] = [
        raster.shown(_averaged(levels), place),
        scene.Lines(frame, style.MUTED, style.HAIR),
        _text(name, box, base, style.TITLE_TEXT),
    ]
    if mask is not None:
        edge = _outline(mask, place)
        # Pale at its sides, so that it is seen without colour too.
        records[1:1] = [
            scene.Lines(edge, style.BONE, 2.4 * style.EDGE, 0.9),
            scene.Lines(edge, style.MARK, style.EDGE),
        ]
    return records


def _text(text: str, box: Box, base: float, size: float) -> scene.Label:
    at = (box[0] + 0.5 * box[2], base, 0.0)
    return scene.Label(text, at, style.INK, size, anchor="cn", halo=False)


def _relief(field: tuple[Array, Array]) -> Array:
    """The field as a relief that is lit from the upper left, grey where it is 0."""
    x, y = (part.mean(axis=2) for part in field)
    rise = np.zeros((len(x), y.shape[1]))
    rise[:, :-1] += x
    rise[:-1] += y
    return np.clip(_LEVEL + _GAIN * rise, 0.0, 255.0)


def _averaged(levels: Array) -> Array:
    """The image with means of squares of pixels in place of these, until the page can show it."""
    k = -(-max(levels.shape[:2]) // _MOST)
    if k == 1:
        return levels
    h, w = (n // k * k for n in levels.shape[:2])
    rest = levels.shape[2:]
    return levels[:h, :w].reshape(h // k, k, w // k, k, *rest).mean(axis=(1, 3))


def _outline(mask: Array, box: Box) -> Array:
    """The edge of a mask as a curve that is smooth over the steps of its pixels."""
    wide = np.pad(mask.astype(float), 3)
    for axis in (0, 1):
        wide = (np.roll(wide, -1, axis) + wide + np.roll(wide, 1, axis)) / 3.0
    cells = [wide[i : i + wide.shape[0] - 1, j : j + wide.shape[1] - 1] for i in (0, 1) for j in (0, 1)]
    near = ((np.min(cells, axis=0) < 0.5) & (np.max(cells, axis=0) >= 0.5)).ravel()
    faces = grid_faces(*wide.shape)[np.tile(near, 2)]
    rows, columns = np.indices(wide.shape)
    h, w = mask.shape
    x = box[0] + np.clip((columns - 2.5) / w, 0.0, 1.0) * box[2]
    y = box[1] + (1.0 - np.clip((rows - 2.5) / h, 0.0, 1.0)) * box[3]
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    return level_lines(points, faces, wide.ravel(), [0.5])
