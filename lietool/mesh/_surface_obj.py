"""Wavefront files of surfaces in space: positions, colours, texture coordinates and polygons, in their order.

trimesh reads them too, but repeats vertices along the seams of textures and puts quadrangles behind
triangles; here every vertex and face stays where the file has it.
"""

import re

import numpy as np
from numpy.typing import NDArray

from lietool.mesh._surface_polygons import fan, numbers
from lietool.mesh.files import Place
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Lines = list[tuple[int, str]]

_CORNER = re.compile(r"-?\d+(/(-?\d*)(/(-?\d*))?)?")


def decode(place: Place, text: str) -> Mesh:
    """Return the mesh in the text of a file .obj; all its groups and objects are one mesh."""
    rows: dict[str, Lines] = {"v": [], "vt": [], "f": []}
    for number, line in _lines(text):
        word, _, rest = line.partition("#")[0].strip().replace("\t", " ").partition(" ")
        if word in rows:
            rows[word].append((number, rest))
        elif word and not re.fullmatch(r"[A-Za-z_]\w*", word):
            place.fail("a mesh, .obj", repr(line[:40]), number)
    if not rows["v"] or not rows["f"]:
        place.fail("a mesh with faces", f"{len(rows['v'])} vertices and {len(rows['f'])} faces")
    V, colours = _positions(place, rows["v"])
    uv = numbers(place, "texture coordinates of two or three finite numbers", rows["vt"], (1, 2, 3))
    corner, count = _corners(place, rows["f"])
    line = np.repeat([number for number, _ in rows["f"]], count)
    faces = _absolute(place, corner[:, 0], line, rows["v"], "vertices")
    _, F = fan(count)
    if not (corner[:, 1] != 0).any():
        return Mesh(V, faces[F], colours=colours)
    there = corner[:, 1] != 0
    uv_corner = np.full(len(corner), -1)
    uv_corner[there] = _absolute(place, corner[there, 1], line[there], rows["vt"], "texture coordinates")
    flat = np.zeros((len(uv), 2))
    flat[:, : min(uv.shape[1], 2)] = uv[:, :2]
    return Mesh(V, faces[F], flat, uv_corner[F], colours)


def _lines(text: str) -> Lines:
    """Return the lines with their numbers; one that ends with a backslash goes on in the next."""
    lines = list(enumerate(text.splitlines(), 1))
    if "\\" not in text:
        return lines
    joined: Lines = []
    for number, line in lines:
        if joined and joined[-1][1].endswith("\\"):
            first, start = joined.pop()
            joined.append((first, f"{start[:-1]} {line}"))
        else:
            joined.append((number, line))
    return joined


def _positions(place: Place, rows: Lines) -> tuple[Array, Array | None]:
    """Return positions and colours: three numbers, perhaps a fourth, which divides, or three of colour."""
    values = numbers(place, "positions of three finite numbers", rows, (3, 4, 6, 7))
    V, more = values[:, :3], values.shape[1] - 3
    if more in (1, 4) and not np.all(values[:, 3] == 1.0):
        place.fail("a mesh whose fourth coordinates are 1", "others", remedy="Divide by them first.")
    return V.copy(), values[:, -3:].copy() if more >= 3 else None


def _corners(place: Place, rows: Lines) -> tuple[Index, Index]:
    """Return position and texture numbers (c, 2) of corners as they stand, 0 for none, and their counts."""
    words = [rest.split() for _, rest in rows]
    count = np.array([len(w) for w in words], np.intp)
    if count.min() < 3:
        k = int(np.argmin(count))
        place.fail("a mesh whose faces have three corners or more", repr(rows[k][1]), rows[k][0])
    tokens = [word for row in words for word in row]
    slashes = [token.count("/") for token in tokens]
    pad = ("/0/0", "/0", "")
    if max(slashes) <= 2:
        full = [token.replace("//", "/0/") + pad[k] for token, k in zip(tokens, slashes, strict=True)]
        try:
            flat = np.array("/".join(full).split("/"), np.int64)
        except (ValueError, OverflowError):
            flat = np.zeros(0, np.int64)
        if len(flat) == 3 * len(tokens) and flat[::3].all():
            return flat.reshape(-1, 3)[:, :2].astype(np.intp), count
    for (number, rest), row in zip(rows, words, strict=True):
        if not all(_CORNER.fullmatch(w) and int(w.split("/")[0]) for w in row):
            place.fail("a mesh whose faces are indices from 1", repr(rest[:40]), number)
    place.fail("a mesh whose faces are indices such as 1, 1/2, 1/2/3 or 1//3", "others")


def _absolute(place: Place, index: Index, line: Index, rows: Lines, what: str) -> Index:
    """Return indices from 0; negative ones count back from what the file had before their line."""
    before = np.searchsorted([number for number, _ in rows], line)
    found = np.where(index > 0, index - 1, before + index)
    bad = (found < 0) | (found >= len(rows))
    if bad.any():
        k = int(np.argmax(bad))
        place.fail(f"a mesh whose faces use its {what}, 1 to {len(rows)}", f"{index[k]}", int(line[k]))
    return found


def encode(mesh: Mesh) -> bytes:
    """Return a mesh as the contents of a file .obj, with numbers that are read back exactly."""
    rows = mesh.vertices if mesh.colours is None else np.hstack([mesh.vertices, mesh.colours[:, :3]])
    lines = [f"v {' '.join(map(repr, row))}" for row in rows.tolist()]
    F = (mesh.faces + 1).tolist()
    if mesh.uv is None or mesh.uv_faces is None:
        lines += [f"f {a} {b} {c}" for a, b, c in F]
    else:
        lines += [f"vt {u!r} {v!r}" for u, v in mesh.uv.tolist()]
        T = [[f"/{t + 1}" if t >= 0 else "" for t in row] for row in mesh.uv_faces.tolist()]
        lines += [f"f {a}{r} {b}{s} {c}{t}" for (a, b, c), (r, s, t) in zip(F, T, strict=True)]
    return ("\n".join(lines) + "\n").encode("ascii")
