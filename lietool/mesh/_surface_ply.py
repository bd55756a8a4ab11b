"""Stanford files of surfaces: positions, colours, texture coordinates, further numbers of vertices, polygons.

trimesh reads no binary ones that mix triangles and polygons, and writes positions as float32; here they are
read as they stand, and written as float64.
"""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.mesh._surface_polygons import fan
from lietool.mesh.files import Place
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8",
}  # fmt: skip
_UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
_COLOURS = ("red", "green", "blue", "alpha")
_NORMALS = ("nx", "ny", "nz")


@dataclass(frozen=True)
class Property:
    """A property of a header: its name, the type of its numbers, and that of its length if it is a list."""

    name: str
    kind: str
    length: str = ""


@dataclass(frozen=True)
class Element:
    """An element of a header."""

    name: str
    count: int
    properties: tuple[Property, ...]


Column = Array | tuple[Index, Array]
"""The numbers of a property; of a list, how many each row has, and all of them one after the other."""


def decode(place: Place, data: bytes) -> Mesh:
    """Return the mesh in a file .ply, as text or binary."""
    order, elements, body = _header(place, data)
    if not order:
        # As if it were a binary file of float64 throughout: one way to read both.
        body, order = _numbers(place, body).tobytes(), "text"
    found: dict[str, dict[str, Column]] = {}
    at = 0
    for element in elements:
        found[element.name], at = _rows(place, element, order, body, at)
    vertex, face = found["vertex"], found["face"]
    V = np.stack([_plain(vertex[a]) for a in "xyz"], axis=1)
    listed = next((face[k] for k in ("vertex_indices", "vertex_index") if k in face), None)
    if not isinstance(listed, tuple):
        place.fail("a mesh whose faces are a list, vertex_indices", "no such property")
    count, corner = listed
    if count.min() < 3:
        place.fail("a mesh whose faces have three corners or more", f"{count.min()} in face {count.argmin()}")
    bad = ~((corner >= 0) & (corner < len(V)) & (corner == np.floor(corner)))
    if bad.any():
        k = int(np.argmax(bad))
        got = f"{corner[k]:g} in face {np.repeat(np.arange(len(count)), count)[k]}"
        place.fail(f"a mesh whose faces use its vertices, 0 to {len(V) - 1}", got)
    _, F = fan(count)
    faces = corner.astype(np.intp)[F]
    uv, uv_faces = _texture(vertex, face, count, F, faces)
    return Mesh(V, faces, uv, uv_faces, _colours(elements, vertex), _others(vertex))


def decode_cloud(place: Place, data: bytes) -> Mesh:
    """Return the points in a file .ply, whatever else is in it, as a mesh without faces."""
    order, elements, body = _header(place, data, faces=False)
    if not order:
        body, order = _numbers(place, body).tobytes(), "text"
    last = [element.name for element in elements].index("vertex")
    found: dict[str, dict[str, Column]] = {}
    at = 0
    for element in elements[: last + 1]:
        found[element.name], at = _rows(place, element, order, body, at)
    columns = found["vertex"]
    V = np.stack([_plain(columns[a]) for a in "xyz"], axis=1)
    colours = _colours(elements, columns)
    return Mesh(V, np.zeros((0, 3), np.intp), None, None, colours, _others(columns))


def encode(mesh: Mesh) -> bytes:
    """Return a mesh as the contents of a binary file .ply: float64, colours as bytes, corners' textures."""
    columns: dict[str, NDArray[Any]] = {name: mesh.vertices[:, a] for a, name in enumerate("xyz")}
    if mesh.colours is not None:
        bytes_ = np.rint(255.0 * np.clip(mesh.colours, 0.0, 1.0)).astype(np.uint8)
        columns |= {_COLOURS[k]: bytes_[:, k] for k in range(bytes_.shape[1])}
    columns |= mesh.attributes
    vertex = np.empty(len(mesh.vertices), [(name, _stored(column)) for name, column in columns.items()])
    for name, column in columns.items():
        vertex[name] = column
    fields: list[tuple[Any, ...]] = [("n", "u1"), ("vertex_indices", "<i4", (3,))]
    texture = mesh.uv is not None and mesh.uv_faces is not None
    if texture:
        fields += [("k", "u1"), ("texcoord", "<f8", (6,))]
    face = np.empty(len(mesh.faces), fields)
    face["n"], face["vertex_indices"] = 3, mesh.faces
    if mesh.uv is not None and mesh.uv_faces is not None:
        corners = np.where(mesh.uv_faces[..., None] >= 0, mesh.uv[mesh.uv_faces], 0.0)
        face["k"], face["texcoord"] = 6, corners.reshape(-1, 6)
    words = {"<f8": "double", "|u1": "uchar"}
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertex)}"]
    lines += [f"property {words[_stored(column)]} {name}" for name, column in columns.items()]
    lines += [f"element face {len(face)}", "property list uchar int vertex_indices"]
    lines += ["property list uchar double texcoord"] if texture else []
    return ("\n".join([*lines, "end_header"]) + "\n").encode("ascii") + vertex.tobytes() + face.tobytes()


def _stored(column: NDArray[Any]) -> str:
    return "|u1" if column.dtype == np.uint8 else "<f8"


def _header(place: Place, data: bytes, faces: bool = True) -> tuple[str, list[Element], bytes]:
    """Return "" for text or the byte order, the elements, and what follows."""
    end = re.search(rb"\nend_header[ \t]*\r?\n", data)
    if not re.match(rb"ply[ \t]*\r?\n", data):
        place.fail("a mesh that begins with ply", repr(data[:10].decode("ascii", "replace")), 1)
    if not end or not data[: end.end()].isascii():
        place.fail("a mesh whose header has an end, end_header", "none")
    order, elements = None, list[tuple[str, int, list[Property]]]()
    for number, line in enumerate(data[: end.start()].decode("ascii").splitlines(), 1):
        match line.split():
            case ["format", "ascii" | "binary_little_endian" | "binary_big_endian" as form, _]:
                order = {"ascii": "", "binary_little_endian": "<"}.get(form, ">")
            case ["element", name, size] if size.isdecimal() and len(size) < 12:
                elements.append((name, int(size), []))
            case ["property", kind, name] if kind in _TYPES and elements:
                elements[-1][2].append(Property(name, _TYPES[kind]))
            case ["property", "list", length, kind, name] if {length, kind} <= set(_TYPES) and elements:
                elements[-1][2].append(Property(name, _TYPES[kind], _TYPES[length]))
            case ["ply"] | ["comment", *_] | ["obj_info", *_] | []:
                pass
            case _:
                must = "a mesh with a header of format, element and property"
                place.fail(must, repr(line[:40]), number)
    if order is None:
        place.fail("a mesh whose header has a format", "none")
    made = [Element(name, size, tuple(properties)) for name, size, properties in elements]
    _check_header(place, made, faces)
    return order, made, data[end.end() :]


def _check_header(place: Place, elements: list[Element], faces: bool) -> None:
    sizes = {element.name: element.count for element in elements}
    if not sizes.get("vertex") and not faces:
        place.fail("a cloud of points", "none")
    if not sizes.get("vertex") or (faces and not sizes.get("face")):
        place.fail("a mesh with faces", f"{sizes.get('vertex', 0)} vertices and {sizes.get('face', 0)} faces")
    for element in elements:
        names = [p.name for p in element.properties]
        if len(set(names)) < len(names):
            place.fail("a mesh whose properties have different names", f"two of one in {element.name}")
    plain = [p.name for e in elements if e.name == "vertex" for p in e.properties if not p.length]
    if not {"x", "y", "z"} <= set(plain):
        place.fail("a mesh whose vertices have x, y and z", ", ".join(plain[:6]) or "none")


def _numbers(place: Place, body: bytes) -> Array:
    try:
        return np.array(body.decode("ascii").split(), float)
    except ValueError as error:
        place.fail("a mesh of numbers behind its header", place.cause(error))


def _rows(place: Place, element: Element, order: str, body: bytes, at: int) -> tuple[dict[str, Column], int]:
    """Return the columns of an element whose rows begin at a byte, and where the next element begins."""
    table = _table(element, order, body, at)
    if table is None:
        return _walk(place, element, order, body, at)
    columns: dict[str, Column] = {}
    for p in element.properties:
        values = table[p.name].astype(float)
        count = np.full(element.count, values.shape[-1], np.intp) if p.length else None
        columns[p.name] = values if count is None else (count, values.ravel())
    return columns, at + table.nbytes


def _kind(order: str, kind: str) -> np.dtype[Any]:
    return np.dtype("<f8" if order == "text" else order + kind)


def _table(element: Element, order: str, body: bytes, at: int) -> NDArray[Any] | None:
    """Return the rows of an element as long as all have lists of the lengths of the first."""
    fields: list[tuple[Any, ...]] = []
    for p in element.properties:
        if p.length:
            kind, offset = _kind(order, p.length), at + np.dtype(fields).itemsize
            if not element.count or offset + kind.itemsize > len(body):
                return None
            size = np.frombuffer(body, kind, 1, offset)[0]
            if not 0 <= size < 1e6:
                return None
            fields += [(f"{p.name} length", kind), (p.name, _kind(order, p.kind), (int(size),))]
        else:
            fields.append((p.name, _kind(order, p.kind)))
    dtype = np.dtype(fields)
    if at + element.count * dtype.itemsize > len(body):
        return None
    table = np.frombuffer(body, dtype, element.count, at)
    same = (
        np.all(table[f"{p.name} length"] == table[p.name].shape[-1]) for p in element.properties if p.length
    )
    return table if all(same) else None


def _walk(place: Place, element: Element, order: str, body: bytes, at: int) -> tuple[dict[str, Column], int]:
    """Return the columns of an element with rows of different lengths: each says where the next begins."""
    start: dict[str, list[int]] = {p.name: [] for p in element.properties}
    sizes: dict[str, list[int]] = {p.name: [] for p in element.properties}
    for row in range(element.count):
        for p in element.properties:
            size = 1
            if p.length:
                kind = _kind(order, p.length)
                size = np.frombuffer(body, kind, 1, at)[0] if at + kind.itemsize <= len(body) else -1
                if not 0 <= size < 1e6:
                    must = f"a whole mesh, with {element.count} of {element.name}"
                    place.fail(must, f"its end, or a list of no length, in number {row}")
                at += kind.itemsize
            start[p.name].append(at)
            sizes[p.name].append(int(size))
            at += int(size) * _kind(order, p.kind).itemsize
    if at > len(body):
        place.fail(f"a whole mesh, with {element.count} of {element.name}", f"{at - len(body)} bytes too few")
    raw = np.frombuffer(body, np.uint8)
    columns: dict[str, Column] = {}
    for p in element.properties:
        kind, count = _kind(order, p.kind), np.array(sizes[p.name], np.intp)
        within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        first = np.repeat(np.array(start[p.name], np.intp), count) + kind.itemsize * within
        values = raw[first[:, None] + np.arange(kind.itemsize)].view(kind).ravel().astype(float)
        columns[p.name] = (count, values) if p.length else values
    return columns, at


def _plain(column: Column) -> Array:
    return column[1] if isinstance(column, tuple) else column


def _texture(
    vertex: dict[str, Column], face: dict[str, Column], count: Index, F: Index, faces: Index
) -> tuple[Array | None, Index | None]:
    """Return texture coordinates, those of corners if there are any, else those of vertices."""
    corner = face.get("texcoord")
    if isinstance(corner, tuple) and np.array_equal(corner[0], 2 * count):
        uv, place = np.unique(corner[1].reshape(-1, 2), axis=0, return_inverse=True)
        return uv, place.reshape(-1)[F]
    for names in _UV:
        if set(names) <= set(vertex):
            return np.stack([_plain(vertex[k]) for k in names], axis=1), faces
    return None, None


def _colours(elements: list[Element], vertex: dict[str, Column]) -> Array | None:
    names = [k for k in _COLOURS if k in vertex]
    if names[:3] != list(_COLOURS[:3]):
        return None
    kinds = {p.name: p.kind for e in elements if e.name == "vertex" for p in e.properties}
    whole = {"u1": 255.0, "u2": 65535.0}
    return np.stack([_plain(vertex[k]) / whole.get(kinds[k], 1.0) for k in names], axis=1)


def _others(vertex: dict[str, Column]) -> dict[str, Array]:
    known = {*"xyz", *_NORMALS, *_COLOURS, *(k for names in _UV for k in names)}
    return {k: v for k, v in vertex.items() if k not in known and not isinstance(v, tuple)}
