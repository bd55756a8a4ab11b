"""Views of meshes side by side: boxes on the page, cameras of one scale, titles, and a bar of colours."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import style
from lietool.render.camera import Box, Camera, around
from lietool.render.mesh_look import weight_colors
from lietool.render.scene import Label, Lines, Record, Surface
from lietool.render.theme import Mix

TITLE = 846.0
"""The base line of titles."""

AREA: Box = (36.0, 100.0, 1128.0, 720.0)
"""What views take of the page unless said: below the titles, above a legend."""

_TICK = 7.0


def grid(rows: int, columns: int, area: Box = AREA, gap: float = 16.0) -> list[Box]:
    """Return boxes of one size, row after row from above, `gap` page units apart."""
    left, low, width, height = area
    w, h = (width - (columns - 1) * gap) / columns, (height - (rows - 1) * gap) / rows
    return [
        (left + j * (w + gap), low + (rows - 1 - i) * (h + gap), w, h)
        for i in range(rows)
        for j in range(columns)
    ]


def together(
    shapes: Sequence[ArrayLike], direction: tuple[float, float, float], box: Box, margin: float = 1.06
) -> Camera:
    """Return one camera that shows all of several shapes (n, 3), as they lie in space, in boxes like this."""
    return around(
        np.concatenate([np.asarray(V, float).reshape(-1, 3) for V in shapes]), direction, box, margin
    )


def each(
    shapes: Sequence[ArrayLike],
    direction: tuple[float, float, float],
    boxes: Sequence[Box],
    margin: float = 1.06,
) -> list[Camera]:
    """Return a camera for each of several shapes, each in the middle of its box, all in one scale."""
    own = [around(np.asarray(V, float), direction, box, margin) for V, box in zip(shapes, boxes, strict=True)]
    scale = min(box[3] / camera.height for camera, box in zip(own, boxes, strict=True))
    return [Camera(c.direction, c.target, box[3] / scale, c.fov) for c, box in zip(own, boxes, strict=True)]


def titles(boxes: Sequence[Box], texts: Sequence[str]) -> list[Label]:
    """Return titles at the line of titles, each over the middle of its box."""
    return [
        Label(text, (box[0] + box[2] / 2.0, TITLE, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for box, text in zip(boxes, texts, strict=True)
    ]


def captions(boxes: Sequence[Box], texts: Sequence[str], below: float = 34.0) -> list[Label]:
    """Return a line of small text under the middle of each box, its base line so far below it."""
    return [
        Label(text, (box[0] + box[2] / 2.0, box[1] - below, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")
        for box, text in zip(boxes, texts, strict=True)
    ]


def legend(text: str, y: float = 52.0) -> Label:
    """Return the last line of a page, in its middle."""
    return Label(text, (600.0, y, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")


def color_bar(
    box: Box,
    limits: tuple[float, float] = (0.0, 1.0),
    ticks: Sequence[tuple[float, str]] = ((0.0, "$0$"), (0.5, "$0.5$"), (1.0, "$1$")),
    title: str = "",
    colors: Callable[[ArrayLike], Mix] = weight_colors,
) -> list[Record]:
    """Return a lying bar of colours with its ticks below and its title to the left.

    Parameters
    ----------
    box : tuple of float
        Of the bar alone; about 240 by 18.
    limits : tuple of float
        The values at its ends.
    ticks : sequence of (float, str)
    title : str
    colors : callable
        From values (n,) to colours.
    """
    left, low, width, height = box
    values = np.linspace(*limits, 65)
    x = left + width * np.linspace(0.0, 1.0, 65)
    points = np.concatenate(
        [np.stack([x, np.full(65, y), np.zeros(65)], axis=1) for y in (low, low + height)]
    )
    k = np.arange(64)
    faces = np.concatenate([np.stack([k, k + 1, k + 66], axis=1), np.stack([k, k + 66, k + 65], axis=1)])
    rim = [(left, low, 0), (left + width, low, 0), (left + width, low + height, 0), (left, low + height, 0)]
    records: list[Record] = [
        Surface(points, faces, colors(np.tile(values, 2)), material="flat"),
        Lines([*rim, rim[0]], style.INK, style.HAIR),
    ]
    for value, text in ticks:
        at = left + width * (value - limits[0]) / (limits[1] - limits[0])
        records.append(Lines([(at, low, 0), (at, low - _TICK, 0)], style.INK, style.THIN))
        records.append(Label(text, (at, low, 0), style.INK, style.SMALL_TEXT, (0.0, -13.0), "ct", halo=False))
    if title:
        middle = (left, low + height / 2.0, 0)
        records.append(Label(title, middle, style.INK, style.SMALL_TEXT, (-20.0, 0.0), "rc", halo=False))
    return records
