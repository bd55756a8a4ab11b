"""Read an outline from a file of a user: two columns of numbers, a list of points, or a drawing."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import outline, outline_svg
from lietool.mesh.files import Place, read_text

Array = NDArray[np.float64]

_WHERE = "outline_io.read"


def read(path: str | Path, *, tolerance: float = 5e-4, outer: bool = False) -> Array:
    """Return the outline in a file, checked.

    Parameters
    ----------
    path : str or Path
        `.csv`: two columns, x and y, separated by commas, semicolons, tabs or spaces; a first line
        of names and lines that begin with # are skipped.
        `.json`: a list of points [x, y].
        `.svg`: a drawing of one closed shape, or `drawing.svg#name` for the shape of that id;
        transforms and units are honoured, and y, which runs down there, is turned to run up.
    tolerance : float
        How far the polygon may stray from a curve of a drawing, over the size of the shape.
    outer : bool
        Take the outer one of several outlines, that is fill the holes; else they are refused.

    Returns
    -------
    points : (n, 2)
        A simple polygon in the direction of the file; a last point that repeats the first and
        points that the next one repeats are left out.

    Raises
    ------
    ValueError
        If the file cannot be read as such, with the line, or holds no simple polygon, with the place.
    """
    readers: dict[str, Callable[[Place, str], Array]] = {
        ".csv": lambda place, _: _columns(place, read_text(place)),
        ".json": lambda place, _: _points(place, read_text(place)),
        ".svg": lambda place, name: outline_svg.shape(place, read_text(place), name, tolerance, outer),
    }
    whole, _, name = str(path).rpartition("#")
    named = bool(whole) and whole.lower().endswith(".svg") and not Path(path).exists()
    place = Place(_WHERE, Path(whole if named else path))
    ending = place.path.suffix.lower()
    if ending not in readers:
        place.fail(
            "a file .svg, .csv or .json", f"{ending or 'no ending'}", remedy="Name it after what it holds."
        )
    if not 0.0 < tolerance < 1.0:
        place.fail("read with a tolerance between 0 and 1", f"{tolerance}")
    points = _distinct(readers[ending](place, name if named else ""))
    return outline.check(_WHERE, str(place.path), points)


def _distinct(points: Array) -> Array:
    """Return the points without those that the next one repeats, the last one's next being the first."""
    if points.ndim != 2 or not len(points):
        return points
    keep = np.any(points != np.roll(points, -1, axis=0), axis=1)
    return points[keep] if keep.any() else points[:1]


def _columns(place: Place, text: str) -> Array:
    rows: list[tuple[float, float]] = []
    first = True
    for number, line in enumerate(text.splitlines(), 1):
        content = line.split("#")[0].strip().strip("\ufeff")
        if not content:
            continue
        words = [w for w in re.split(r"\s*[;\t]\s*|\s*,\s*|\s+", content) if w]
        try:
            values = [float(w.strip('"')) for w in words]
        except ValueError:
            if first:  # the names of the columns
                first = False
                continue
            place.fail("a table of numbers", f"{content[:40]!r}", number)
        first = False
        if len(values) != 2:
            place.fail("two columns, x and y", f"{len(values)} numbers", number)
        if not np.isfinite(values).all():
            place.fail("finite numbers", f"{content[:40]!r}", number)
        rows.append((values[0], values[1]))
    if not rows:
        place.fail("a table of points", "no numbers")
    return np.array(rows)


def _points(place: Place, text: str) -> Array:
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        place.fail("JSON", error.msg.lower(), error.lineno)
    except RecursionError:
        place.fail("a list of points [x, y]", "a list nested too deeply")
    if not isinstance(data, list) or not data:
        got = "an empty list" if data == [] else f"a {type(data).__name__}"
        place.fail("a list of points [x, y]", got)
    for i, point in enumerate(data):
        pair = isinstance(point, list) and len(point) == 2
        if not pair or any(isinstance(v, bool) or not isinstance(v, int | float) for v in point):
            place.fail("a list of points [x, y]", f"{json.dumps(point)[:40]} as point {i}")
        if not all(abs(v) <= 1e150 for v in point):
            place.fail("a list of finite points", f"{json.dumps(point)[:40]} as point {i}")
    return np.array(data, float)
