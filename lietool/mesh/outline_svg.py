"""One closed shape of an SVG drawing as a polygon; the drawing is read by svgelements."""

import io
import re
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import outline
from lietool.mesh.files import BROKEN, Place

Array = NDArray[np.float64]

# Numbers that follow each command of a path; svgelements stops at an error without a word.
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_TOKEN = re.compile(rf"\s*,?\s*([MLHVCSQTAZmlhvcsqtaz]|{_NUMBER})")
# The flags of an arc may stand without a space between them and the number that follows.
_ARC = re.compile(
    rf"\s*,?\s*({_NUMBER})\s*,?\s*({_NUMBER})\s*,?\s*({_NUMBER})\s*,?\s*([01])\s*,?\s*([01])"
    rf"\s*,?\s*({_NUMBER})\s*,?\s*({_NUMBER})"
)
_MOST_PIECES = 2000


def shape(place: Place, text: str, name: str, tolerance: float, outer: bool) -> Array:
    """Return the polygon of the only shape of a drawing, or of the one named, y running up.

    Parameters
    ----------
    place : Place
        For messages.
    text : str
        The drawing.
    name : str
        The id of the shape, or "".
    tolerance : float
        Over the size of the shape.
    outer : bool
        Fill holes.
    """
    root = _parse(place, text)
    for element in root.iter():
        if element.tag.rpartition("}")[2] == "path":
            _check_data(place, text, element.get("d", ""))
    closed = [
        (label, points)
        for label, ident, path in _paths(place, text)
        if not name or ident == name
        for points in _polygons(place, label, path, tolerance)
    ]
    if not closed:
        wanted = f"a drawing with a shape of id {name!r}" if name else "a drawing of a closed shape"
        remedy = "" if name else "Text must be turned into paths, and pictures into outlines, first."
        place.fail(wanted, "none", remedy=remedy)
    return _only(place, closed, outer)


def _parse(place: Place, text: str) -> ElementTree.Element:
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        place.fail("a drawing, that is XML", str(error).split(":")[0], error.position[0])
    if root.tag.rpartition("}")[2] != "svg":
        place.fail("a drawing, <svg>", f"<{root.tag.rpartition('}')[2]}>")
    return root


def _check_data(place: Place, text: str, data: str) -> None:
    """Refuse a path that breaks off, with the line where it stands."""
    at, command, left = 0, "", 0
    while data[at:].strip(" ,\t\r\n"):
        arc = _ARC.match(data, at) if command == "A" else None
        match = arc or _TOKEN.match(data, at)
        word = match[1] if match and not arc else ""
        letter = word.upper() if word.isalpha() else ""
        if match is None or (letter and left) or (not letter and not command) or (not at and letter != "M"):
            break
        # Beyond all use, and squares of such numbers overflow.
        if any(abs(float(w)) > 1e100 for w in (arc.groups() if arc else [word] if not letter else [])):
            break
        if letter:
            command, left = letter, _COUNTS[letter]
        elif arc:
            left = 0
        elif command in "ZA":
            break
        else:
            left = (left or _COUNTS[command]) - 1
        at = match.end()
    else:
        if not left:
            return
    # What was read has spaces where the file may have new lines.
    found = re.search(r"\s".join(map(re.escape, re.split(r"\s", data[:60]))), text)
    line = text.count("\n", 0, found.start() + at) + 1 if found else None
    place.fail(
        "a drawing whose paths are whole and finite", f"{data[max(0, at - 8) : at + 12].strip()!r}", line
    )


def _paths(place: Place, text: str) -> list[tuple[str, str | None, object]]:
    """Return what is visible, as paths, with a label and the id of each."""
    import svgelements

    try:
        drawing = svgelements.SVG.parse(io.StringIO(text), reify=True)
        shapes = [
            (e, abs(svgelements.Path(e))) for e in drawing.elements() if isinstance(e, svgelements.Shape)
        ]
    except BROKEN as error:
        place.fail("a drawing that svgelements reads", f"an error, {place.cause(error)}")
    found = []
    for element, path in shapes:
        values = element.values or {}
        if values.get("visibility") == "hidden" or values.get("display") == "none":
            continue
        tag = values.get("tag", type(element).__name__.lower())
        found.append((f"<{tag}{f' id={element.id!r}' if element.id else ''}>", element.id, path))
    return found


def _polygons(place: Place, label: str, path: object, tolerance: float) -> list[Array]:
    """Return the subpaths that enclose something, flattened."""
    polygons = []
    try:
        box = path.bbox()  # type: ignore[attr-defined]
    except BROKEN as error:
        place.fail("a drawing that svgelements reads", f"an error, {place.cause(error)}")
    if box is None:
        return []
    step = tolerance * max(box[2] - box[0], box[3] - box[1])
    for part in path.as_subpaths():  # type: ignore[attr-defined]
        pieces = [_flat(segment, step) for segment in part]
        points = np.concatenate([p for p in pieces if len(p)] or [np.zeros((0, 2))])
        points = np.stack([points[:, 0], 0.0 - points[:, 1]], axis=1)
        if not np.all(np.abs(points) <= 1e100):
            place.fail("a drawing of finite coordinates", f"others in {label}")
        if len(points):
            # Ends that meet but for rounding are one point.
            gap = np.hypot(*(points - np.roll(points, -1, axis=0)).T)
            points = points[gap > 1e-3 * step]
        if len(points) > 2:
            polygons.append(points)
    return polygons


def _flat(segment: object, step: float) -> Array:
    """Return the points of a segment after its start, close enough to it."""
    import svgelements as svg

    if isinstance(segment, svg.Arc):
        known = np.array([[*p] for p in (segment.start, segment.end, segment.center) if p], float)
        if not np.all(np.abs(known) <= 1e100):
            return np.full((1, 2), np.nan)
        parts = [_flat(curve, step) for curve in segment.as_cubic_curves()]
        return np.concatenate(parts) if parts else np.zeros((0, 2))
    if isinstance(segment, svg.CubicBezier):
        control = [segment.start, segment.control1, segment.control2, segment.end]
    elif isinstance(segment, svg.QuadraticBezier):
        control = [segment.start, segment.control, segment.end]
    else:
        end = segment.end  # type: ignore[attr-defined]
        return np.zeros((0, 2)) if end is None else np.array([[end.x, end.y]])
    b = np.array([(p.x, p.y) for p in control])
    degree = len(b) - 1
    # Wang's bound: n pieces stray at most degree (degree - 1) / 8 max |second difference| / n^2.
    if not np.all(np.abs(b) <= 1e100):
        return b[-1:] + np.nan
    bend = np.hypot(*np.diff(b, 2, axis=0).T).max()
    n = int(
        np.clip(np.ceil(np.sqrt(degree * (degree - 1) / 8.0 * bend / max(step, 1e-300))), 1, _MOST_PIECES)
    )
    t = (np.arange(1, n + 1) / n)[:, None]
    while len(b) > 1:  # de Casteljau, for all t at once
        b = [(1.0 - t) * p + t * q for p, q in pairwise(b)]
    return np.asarray(b[0])


def _only(place: Place, closed: list[tuple[str, Array]], outer: bool) -> Array:
    """Return the outline that holds all the others, if holes may be filled, or the only one."""
    largest = max(range(len(closed)), key=lambda k: abs(outline.area(closed[k][1])))
    label, points = closed[largest]
    low, high = points.min(axis=0), points.max(axis=0)
    for k, (other, inner) in enumerate(closed):
        if k == largest:
            continue
        x, y = inner[0, 0], 0.0 - inner[0, 1]
        at = f"near x = {x:.6g}, y = {y:.6g}"
        if not (np.all(inner >= low) and np.all(inner <= high) and _holds(points, inner[0])):
            got = f"{label} and, beside it, {other} {at}"
            place.fail("one shape", got, remedy="Join them, or name one by its id: drawing.svg#id.")
        if not outer:
            got = f"a hole in {label}, {at}" if other == label else f"{other} inside {label}, {at}"
            place.fail("a shape without holes", got, remedy="Fill it, or take the outer outline only.")
    return points


def _holds(points: Array, p: Array) -> bool:
    """Whether a point is inside a polygon, by the crossings of a ray."""
    a, b = points, np.roll(points, -1, axis=0)
    spans = (a[:, 1] > p[1]) != (b[:, 1] > p[1])
    a, b = a[spans], b[spans]
    x = a[:, 0] + (p[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(x > p[0]) % 2)
