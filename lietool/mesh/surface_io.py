"""Read and write triangle meshes in space: .obj, .ply, .off, .stl and .glb.

Vertices and faces keep their order, and the numbers of vertices stay with them.  So that this holds, .obj,
.ply and .off are read here; .stl and .glb are read and written by trimesh.  Normals are left out of what is
read: they follow from what the mesh becomes.
"""

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.lie import checks
from lietool.mesh import _surface_obj, _surface_ply, _surface_polygons, surface, topology
from lietool.mesh.files import Place, read_bytes, read_text
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]

ENDINGS = (".obj", ".ply", ".off", ".stl", ".glb")


def read(path: str | Path) -> Mesh:
    """Return a mesh from a file .obj, .ply, .off, .stl or .glb.

    Polygons are cut into triangles from their first corner, (0, 1, 2), (0, 2, 3), ..., each in its place.

    - .obj: all groups and objects are one mesh, in the order of the file, with colours behind positions and
      texture coordinates of corners.
    - .ply: colours, texture coordinates of vertices or corners, and all further numbers of vertices.
    - .stl: its triangles know no vertices.  Corners at one place, to the last bit, become one, and vertices
      are numbered as they come.
    - .glb: the meshes of the scene in the order of the file, each as often as the scene has it, moved to
      where it has it.  Vertices that the file repeats, as it must along seams, stay apart: see
      `surface.weld`.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    mesh : Mesh

    Raises
    ------
    ValueError
        If the file is none of these, cannot be read, is broken or no mesh, with the line where it is known.
    """
    place = Place("surface_io.read", Path(path))
    ending = place.path.suffix.lower()
    if ending not in ENDINGS:
        got = ending or "no ending"
        place.fail(f"a mesh, {', '.join(ENDINGS)}", got, remedy="Save it as one of these.")
    if ending == ".obj":
        mesh = _surface_obj.decode(place, read_text(place))
    elif ending == ".off":
        mesh = _surface_polygons.decode_off(place, read_text(place))
    else:
        decode = {".ply": _surface_ply.decode, ".stl": _decode_stl, ".glb": _decode_glb}[ending]
        mesh = decode(place, read_bytes(place))
    _check(place, mesh)
    return mesh


def encode(mesh: Mesh, ending: str) -> bytes:
    """Return a mesh as the contents of a file.

    - .obj: colours without opacity and texture coordinates; no further numbers.
    - .ply: all, colours as bytes; the only format that has everything.
    - .off: positions and faces.
    - .stl: the triangles, in float32.
    - .glb: all, in float32, colours as bytes; where the texture has seams a vertex is repeated behind all
      others, so that these keep their numbers.

    What is read back from .obj, .ply and .off has equal vertices and faces.

    Parameters
    ----------
    mesh : Mesh
    ending : str
        One of ENDINGS.

    Returns
    -------
    contents : bytes

    Raises
    ------
    ValueError
        If there is no such format, or a vertex is not finite, or too large for float32 where that is written.
    """
    if ending not in ENDINGS:
        topology.fail("surface_io.encode", "ending", f"one of {', '.join(ENDINGS)}", repr(ending))
    V = topology.vertices("surface_io.encode", "vertices", mesh.vertices, 3)
    if ending in (".stl", ".glb") and not len(mesh.faces):
        topology.fail(
            "surface_io.encode", "ending", "one that holds points alone, .ply, .obj or .off", ending
        )
    if ending in (".stl", ".glb") and np.max(np.abs(V)) > np.finfo(np.float32).max:
        must = f"within what a {ending} holds, 3.4e38"
        topology.fail("surface_io.encode", "vertices", must, f"{np.max(np.abs(V)):.1e}")
    writers = {
        ".obj": _surface_obj.encode,
        ".ply": _surface_ply.encode,
        ".off": _surface_polygons.encode_off,
        ".stl": _encode_stl,
        ".glb": _encode_glb,
    }
    return writers[ending](mesh)


def _check(place: Place, mesh: Mesh) -> None:
    bad = np.any(~(np.abs(mesh.vertices) <= topology.LARGEST), axis=1)
    if bad.any():
        (k,) = checks.first(bad)
        must = f"a mesh of vertices that are finite and at most {topology.LARGEST:g} in size"
        place.fail(must, f"{mesh.vertices[k].tolist()} as vertex {k}")
    named = {"colour": mesh.colours, "texture coordinate": mesh.uv} | mesh.attributes
    for name, values in named.items():
        if values is not None and not np.isfinite(values).all():
            index = checks.first(~np.isfinite(values))
            place.fail(f"a mesh with finite numbers, {name}", f"{values[index]} as number {index[0]}")
    outside = np.any((mesh.faces < 0) | (mesh.faces >= len(mesh.vertices)), axis=1)
    if outside.any():
        (k,) = checks.first(outside)
        must = f"a mesh whose faces use its {len(mesh.vertices)} vertices"
        place.fail(must, f"{mesh.faces[k].tolist()} as face {k}")


def _loaded(place: Place, data: bytes, kind: str) -> Any:
    import trimesh

    try:
        # trimesh warns of broken numbers; what is wrong with them is said afterwards.
        with np.errstate(all="ignore"):
            return trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False)
    except ModuleNotFoundError:
        # What it would guess by in which letters a text is written.
        place.fail(f"a mesh, .{kind}, whose text is UTF-8", "other bytes", remedy="Save it anew.")
    except Exception as error:  # its readers raise whatever the broken file leads them to
        place.fail(f"a mesh, .{kind}, that trimesh reads", f"an error, {place.cause(error)}")


def _plain_stl(place: Place, data: bytes) -> bytes:
    """Return a file .stl that trimesh takes for what it is; a binary one that is cut off is refused."""
    count = int.from_bytes(data[80:84], "little")
    if data.isascii() or (len(data) >= 84 and len(data) == 84 + 50 * count):
        return data
    if data.lstrip().startswith(b"solid") and b"\0" not in data:
        # Letters of a name or a comment, in whatever code.
        return data.decode("ascii", "replace").replace("\ufffd", "?").encode("ascii")
    if len(data) < 84:
        place.fail("a mesh, .stl, with a head of 84 bytes", f"{len(data)}", remedy="Save it anew.")
    must = f"a whole mesh, of the {84 + 50 * count} bytes that the {count} triangles in its head take"
    place.fail(must, f"{len(data)}", remedy="Save it anew.")


def _decode_stl(place: Place, data: bytes) -> Mesh:
    data = _plain_stl(place, data)
    parts = [part for part in _loaded(place, data, "stl").geometry.values() if len(part.faces)]
    if not parts:
        place.fail("a mesh with faces", "none")
    corners = np.concatenate([np.asarray(part.vertices, float)[part.faces].reshape(-1, 3) for part in parts])
    bad = np.any(~np.isfinite(corners), axis=1)
    if bad.any():
        (k,) = checks.first(bad)
        place.fail("a mesh of finite vertices", f"{corners[k].tolist()} in face {k // 3}")
    first, where = surface.weld(corners)
    return Mesh(corners[first], where.reshape(-1, 3))


def _encode_stl(mesh: Mesh) -> bytes:
    import trimesh

    made: Any = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    return made.export(file_type="stl")


def _decode_glb(place: Place, data: bytes) -> Mesh:
    scene = _loaded(place, data, "glb")
    nodes = [scene.graph[node] for node in scene.graph.nodes_geometry]
    # In the order of the file: the graph has nodes in that of its search.
    rank = {name: k for k, name in enumerate(scene.geometry)}
    nodes.sort(key=lambda node: rank[node[1]])
    parts = [(scene.geometry[name], np.asarray(A, float)) for A, name in nodes]
    parts = [(part, A) for part, A in parts if len(getattr(part, "faces", ()))]
    if not parts:
        place.fail("a mesh with faces", "none")
    sizes = [len(part.vertices) for part, _ in parts]
    start = np.cumsum(sizes) - sizes
    V = np.concatenate([np.asarray(part.vertices, float) @ A[:3, :3].T + A[:3, 3] for part, A in parts])
    F = np.concatenate([_oriented(part, A) + k for (part, A), k in zip(parts, start, strict=True)])
    _check_parts(place, parts)
    uv = _joined([_part_uv(part) for part, _ in parts], sizes, 0.0)
    colours = _joined([_part_colours(part) for part, _ in parts], sizes, 1.0)
    names = dict.fromkeys(k for part, _ in parts for k in part.vertex_attributes)
    attributes = {}
    for name in names:
        rows = [
            _column(part.vertex_attributes.get(name), size)
            for (part, _), size in zip(parts, sizes, strict=True)
        ]
        column = _joined(rows, sizes, 0.0)
        if column is not None:
            attributes[name.removeprefix("_")] = column[:, 0]
    return Mesh(V, F, uv, None if uv is None else F, colours, attributes)


def _oriented(part: Any, A: Array) -> Index:
    """Return the faces of a part; a reflection turns them over."""
    F = np.asarray(part.faces).astype(np.intp)
    return F[:, ::-1] if np.linalg.det(A[:3, :3]) < 0.0 else F


def _check_parts(place: Place, parts: list[tuple[Any, Array]]) -> None:
    for k, (part, _) in enumerate(parts):
        if part.faces.min() < 0 or part.faces.max() >= len(part.vertices):
            must = f"a mesh whose faces use the {len(part.vertices)} vertices of their part {k}, from 0"
            place.fail(must, f"{part.faces.max()}")


def _part_uv(part: Any) -> Array | None:
    uv = getattr(part.visual, "uv", None)
    return None if uv is None or len(uv) != len(part.vertices) else np.asarray(uv, float)[:, :2]


def _part_colours(part: Any) -> Array | None:
    if part.visual.kind == "vertex":
        found = part.visual.vertex_colors
    else:
        found = getattr(part.visual, "vertex_attributes", {}).get("color")
    if found is None or len(found) != len(part.vertices):
        return None
    found = np.asarray(found)
    whole = float(np.iinfo(found.dtype).max) if found.dtype.kind == "u" else 1.0
    return np.pad(found / whole, ((0, 0), (0, 4 - found.shape[1])), constant_values=1.0)


def _column(values: Any, size: int) -> Array | None:
    """Return one number for each vertex, or nothing where there are none or several."""
    a = None if values is None else np.asarray(values, float)
    return a.reshape(size, 1) if a is not None and a.size == size else None


def _joined(rows: list[Array | None], sizes: list[int], rest: float) -> Array | None:
    """Return the rows of all parts, `rest` where a part has none; nothing if none has any."""
    width = next((row.shape[1] for row in rows if row is not None), None)
    if width is None:
        return None
    filled = [np.full((n, width), rest) if row is None else row for row, n in zip(rows, sizes, strict=True)]
    return np.concatenate(filled)


def _encode_glb(mesh: Mesh) -> bytes:
    import trimesh
    from trimesh.visual import ColorVisuals, TextureVisuals

    V, F, uv, origin = mesh.vertices, mesh.faces, None, np.arange(len(mesh.vertices))
    if mesh.uv is not None and mesh.uv_faces is not None:
        F, uv, origin = _split(mesh, mesh.uv, mesh.uv_faces)
    normal = surface.vertex_normals(V, mesh.faces)[origin]
    made: Any = trimesh.Trimesh(V[origin], F, vertex_normals=normal, process=False)
    made.vertex_attributes = {f"_{k}": v[origin].astype(np.float32) for k, v in mesh.attributes.items()}
    colours = None
    if mesh.colours is not None:
        colours = np.full((len(origin), 4), 255, np.uint8)
        colours[:, : mesh.colours.shape[1]] = np.rint(255.0 * np.clip(mesh.colours[origin], 0.0, 1.0))
    if uv is not None:
        made.visual = TextureVisuals(uv=uv)
        if colours is not None:
            made.visual.vertex_attributes["color"] = colours
    elif colours is not None:
        made.visual = ColorVisuals(made, vertex_colors=colours)
    return made.export(file_type="glb", include_normals=True)


def _split(mesh: Mesh, uv: Array, uv_faces: Index) -> tuple[Index, Array, Index]:
    """Return faces, texture coordinates and origins of vertices that have one texture coordinate each.

    A vertex keeps its number with the first it has; copies with its others stand behind all vertices.
    """
    n = len(mesh.vertices)
    key = mesh.faces.ravel() * (len(uv) + 1) + uv_faces.ravel() + 1
    pairs, first, corner = np.unique(key, return_index=True, return_inverse=True)
    vertex, texture = pairs // (len(uv) + 1), pairs % (len(uv) + 1) - 1
    # Of the pairs of a vertex that comes first in the faces stays.
    order = np.lexsort((first, vertex))
    head = np.zeros(len(pairs), bool)
    head[order[np.unique(vertex[order], return_index=True)[1]]] = True
    number = np.where(head, vertex, n + np.cumsum(~head) - 1)
    origin = np.concatenate([np.arange(n), vertex[~head]])
    table = np.zeros((len(origin), 2))
    table[number] = np.where(texture[:, None] >= 0, uv[texture], 0.0)
    return number[corner.ravel()].reshape(-1, 3), table, origin
