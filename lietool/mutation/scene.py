"""What a picture is made of, as plain arrays: whether two are the same before rendering, and what moved."""

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.golden import compare_numbers
from lietool.render import scene
from lietool.render.camera import Box, project

Array = NDArray[np.float64]

# Beyond the edge of the page, in page units: a stroke that begins there is still partly seen.
_MARGIN = 20.0


@dataclass(frozen=True, eq=False)
class Shape:
    """A picture without its renderer.

    Parameters
    ----------
    leaves : Mapping[str, ndarray]
        Every value of every record, under a dotted name.
    points : Mapping[str, (n, 2)]
        Where the vertices of each record lie on the page, in page units, which are a golden's pixels.
    size : tuple of int
        The page.
    """

    leaves: Mapping[str, np.ndarray]
    points: Mapping[str, Array]
    size: tuple[int, int]


def shape(picture: scene.Picture) -> Shape:
    """Take a picture apart.

    Parameters
    ----------
    picture : Picture

    Returns
    -------
    Shape
    """
    page: Box = (0.0, 0.0, float(picture.size[0]), float(picture.size[1]))
    points = {
        f"views.{v}.records.{r}.{type(record).__name__}": _on_page(record, view, page)
        for v, view in enumerate(picture.views)
        for r, record in enumerate(view.records)
    }
    return Shape(dict(_leaves(picture, "")), points, (int(picture.size[0]), int(picture.size[1])))


def differences(before: Shape, after: Shape) -> Sequence[compare_numbers.Difference]:
    """Compare two pictures record by record, to what rounding may change.

    Parameters
    ----------
    before, after : Shape

    Returns
    -------
    sequence of Difference
        As between goldens' numbers; empty where the pictures show the same.
    """
    return compare_numbers.numbers(before.leaves, after.leaves)


def displacement(before: Shape, after: Shape) -> float | None:
    """Measure how far any vertex on the page has moved.

    Parameters
    ----------
    before, after : Shape

    Returns
    -------
    float or None
        In page units; None where the two have other records or other numbers of vertices.
    """
    if before.points.keys() != after.points.keys():
        return None
    farthest = 0.0
    for name, a in before.points.items():
        b = after.points[name]
        if a.shape != b.shape or not np.array_equal(np.isnan(a), np.isnan(b)):
            return None
        seen = _inside(a, before.size) | _inside(b, after.size)
        moved = np.linalg.norm(b[seen] - a[seen], axis=-1)
        farthest = max(farthest, float(moved.max(initial=0.0)))
    return farthest


def _inside(points: Array, size: tuple[int, int]) -> NDArray[np.bool_]:
    return np.all((points >= -_MARGIN) & (points <= np.array(size) + _MARGIN), axis=-1)


def _leaves(value: object, under: str) -> Iterator[tuple[str, np.ndarray]]:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        # The kind too: a tube may have all that a line has.
        yield f"{under}kind", np.array(type(value).__name__)
        for field in dataclasses.fields(value):
            yield from _leaves(getattr(value, field.name), f"{under}{field.name}.")
        return
    array = _array(value)
    if array is not None:
        yield under.removesuffix("."), array
        return
    if not isinstance(value, list | tuple):
        raise TypeError(
            f"mutation.scene: a picture has numbers, texts and records; got {type(value).__name__}"
        )
    for i, item in enumerate(value):
        yield from _leaves(item, f"{under}{i}.")


def _array(value: object) -> np.ndarray | None:
    """Return a value as numbers or texts that can be compared; None where it is several things."""
    if value is None or isinstance(value, str):
        return np.array(str(value))
    if isinstance(value, list | tuple) and any(isinstance(item, str) or item is None for item in value):
        return None
    try:
        array = np.asarray(value)
    except ValueError:
        return None
    return array if array.dtype.kind in "biuf" else None


def _on_page(record: scene.Record, view: scene.View, page: Box) -> Array:
    points = np.asarray(_vertices(record), float).reshape(-1, 3)
    placed = project(view.camera, view.box or page, points)[:, :2]
    return placed + record.offset if isinstance(record, scene.Label) else placed


def _vertices(record: scene.Record) -> object:
    match record:
        case scene.Surface():
            return record.vertices
        case scene.Lines() | scene.Tube():
            return record.points
        case scene.Points():
            return record.positions
        case scene.Arrow():
            return np.array([record.start, record.end], float)
        case scene.Frame():
            tips = np.asarray(record.origin) + record.length * np.asarray(record.matrix, float).T
            return np.vstack([np.asarray(record.origin, float), tips])
        case scene.Image():
            corner, across, up = (np.asarray(v, float) for v in (record.corner, record.across, record.up))
            return np.array([corner, corner + across, corner + up, corner + across + up])
        case scene.Label():
            return record.position
