"""What the readers of surfaces share: rows of numbers, polygons cut into triangles, and the text of .off."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lietool.mesh.files import Place
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Lines = list[tuple[int, str]]


def fan(count: Index) -> tuple[Index, Index]:
    """Return triangles (m, 3) of the corners of polygons, and the polygon (m,) of each.

    A polygon of the corners 0, 1, ..., k becomes (0, 1, 2), (0, 2, 3), ..., (0, k - 1, k), in the place
    of the polygon among the others.  Corners are numbered through all polygons.
    """
    start, pieces = np.cumsum(count) - count, count - 2
    polygon = np.repeat(np.arange(len(count)), pieces)
    within = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    first = start[polygon]
    return polygon, np.stack([first, first + 1 + within, first + 2 + within], axis=1)


def numbers(place: Place, what: str, rows: Lines, widths: Sequence[int]) -> Array:
    """Return rows of as many numbers each, one of `widths`, all finite."""
    if not rows:
        return np.zeros((0, widths[0]))
    words = [rest.split() for _, rest in rows]
    width = len(words[0])
    try:
        values = np.array(words, float) if width in widths else np.zeros((0, 0))
    except ValueError:
        values = np.zeros((0, 0))
    if values.shape == (len(rows), width) and np.max(np.abs(values)) <= 1e100:
        return values
    for (number, rest), row in zip(rows, words, strict=True):
        if len(row) not in widths or len(row) != width or not all(_is_number(w) for w in row):
            place.fail(f"a mesh with {what}", repr(rest[:40]), number)
    place.fail(f"a mesh with {what}", "others")


def _is_number(word: str) -> bool:
    try:
        return abs(float(word)) <= 1e100
    except ValueError:
        return False


def decode_off(place: Place, text: str) -> Mesh:
    """Return the mesh in the text of a file .off; colours of faces are left out."""
    lines = [
        (number, words)
        for number, line in enumerate(text.splitlines(), 1)
        if (words := line.partition("#")[0].strip())
    ]
    number, words = lines.pop(0) if lines else (1, "")
    if words.split()[:1] == ["OFF"]:
        words = words[3:]
        if not words.strip() and lines:
            number, words = lines.pop(0)
    sizes = words.split()
    if not 2 <= len(sizes) <= 3 or not all(w.isdecimal() for w in sizes):
        remedy = "Binary files of this format, and those with normals or colours of vertices, are not read."
        got = repr(words[:40])
        place.fail("a mesh that begins with OFF and its numbers of vertices and faces", got, number, remedy)
    n, m = int(sizes[0]), int(sizes[1])
    if not n or not m:
        place.fail("a mesh with faces", f"{n} vertices and {m} faces")
    if len(lines) < n + m:
        place.fail(f"a whole mesh, with {n} vertices and {m} faces", f"{len(lines)} lines of them")
    V = numbers(place, "positions of three finite numbers", lines[:n], (3,))
    corner, count, line = _off_polygons(place, lines[n : n + m])
    bad = corner >= n
    if bad.any():
        k = int(np.argmax(bad))
        got = f"{corner[k]}"
        place.fail(f"a mesh whose faces use its vertices, 0 to {n - 1}", got, int(np.repeat(line, count)[k]))
    return Mesh(V, corner[fan(count)[1]])


def _off_polygons(place: Place, lines: Lines) -> tuple[Index, Index, Index]:
    words = [rest.split() for _, rest in lines]
    for (number, rest), row in zip(lines, words, strict=True):
        size = int(row[0]) if row[0].isdecimal() and len(row[0]) < 9 else 0
        if size < 3 or len(row) <= size or not all(w.isdecimal() and len(w) < 18 for w in row[1 : size + 1]):
            must = "a mesh with faces of a count, at least 3, and as many indices"
            place.fail(must, repr(rest[:40]), number)
    count = np.array([int(row[0]) for row in words], np.intp)
    corner = [w for row, size in zip(words, count.tolist(), strict=True) for w in row[1 : size + 1]]
    return np.array(corner, np.int64).astype(np.intp), count, np.array([number for number, _ in lines])


def encode_off(mesh: Mesh) -> bytes:
    """Return a mesh as the contents of a file .off, with numbers that are read back exactly."""
    lines = ["OFF", f"{len(mesh.vertices)} {len(mesh.faces)} 0"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")
