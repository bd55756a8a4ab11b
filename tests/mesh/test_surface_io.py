"""Files of meshes in space: nothing is lost or moved on the way, and broken ones say what is wrong where."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from lietool.mesh import surface_io
from lietool.mesh.surface import Mesh

V = np.array([[0.1, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1 / 3], [-1e-7, 5, 2], [7, 7, 7]])
F = np.array([[2, 0, 1], [0, 2, 3], [3, 2, 4]])
UV = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.25, 1.0], [0.5, 0.5]])
UV_FACES = np.array([[2, 0, 1], [4, 2, 3], [3, 1, 0]])
COLOURS = np.array([[k, 255 - k, 7, 255] for k in range(0, 180, 30)]) / 255.0
FULL = Mesh(V, F, UV, UV_FACES, COLOURS, {"arm": np.linspace(0, 1, 6), "leg": np.arange(6.0)})


@pytest.fixture
def write(tmp_path):
    def write(name: str, contents: str | bytes) -> Path:
        path = tmp_path / name
        path.write_bytes(contents.encode() if isinstance(contents, str) else contents)
        return path

    return write


@pytest.mark.parametrize("ending", [".obj", ".ply", ".off"])
def test_vertices_and_faces_come_back_equal(write, ending):
    mesh = surface_io.read(write(f"a{ending}", surface_io.encode(FULL, ending)))
    assert np.array_equal(mesh.vertices, V) and np.array_equal(mesh.faces, F)
    assert mesh.faces.dtype == np.intp
    # And once more to the same bytes: nothing creeps.
    assert surface_io.encode(mesh, ending) == surface_io.encode(FULL, ending) or ending == ".ply"


@pytest.mark.parametrize("ending", [".obj", ".ply"])
def test_textures_stay_at_their_corners(write, ending):
    mesh = surface_io.read(write(f"a{ending}", surface_io.encode(FULL, ending)))
    assert np.array_equal(mesh.uv[mesh.uv_faces], UV[UV_FACES])


def test_colours_and_painted_numbers_come_back(write):
    mesh = surface_io.read(write("a.ply", surface_io.encode(FULL, ".ply")))
    np.testing.assert_allclose(mesh.colours, COLOURS, atol=1e-15)
    assert list(mesh.attributes) == ["arm", "leg"]
    assert all(np.array_equal(mesh.attributes[k], FULL.attributes[k]) for k in mesh.attributes)
    mesh = surface_io.read(write("a.obj", surface_io.encode(FULL, ".obj")))
    assert np.array_equal(mesh.colours, COLOURS[:, :3])


def test_a_glb_has_all_in_float32_and_copies_of_vertices_at_seams_behind(write):
    mesh = surface_io.read(write("a.glb", surface_io.encode(FULL, ".glb")))
    assert np.array_equal(mesh.vertices[:6], V.astype(np.float32))
    assert len(mesh.vertices) == 8
    assert np.array_equal(mesh.vertices[mesh.faces], V.astype(np.float32)[F])
    np.testing.assert_allclose(mesh.uv[mesh.uv_faces], UV[UV_FACES], atol=1e-7)
    np.testing.assert_allclose(mesh.colours[:6], COLOURS, atol=1e-12)
    np.testing.assert_allclose(mesh.attributes["arm"][:6], FULL.attributes["arm"], atol=1e-7)
    plain = surface_io.read(write("b.glb", surface_io.encode(Mesh(V, F, None, None, COLOURS), ".glb")))
    assert np.array_equal(plain.faces, F) and plain.uv is None
    np.testing.assert_allclose(plain.colours, COLOURS, atol=1e-12)


def test_an_stl_gets_its_vertices_back_as_they_come(write):
    mesh = surface_io.read(write("a.stl", surface_io.encode(FULL, ".stl")))
    # The one that no face uses is gone; the others in the order of the corners.
    order = [2, 0, 1, 3, 4]
    assert np.array_equal(mesh.vertices, V[order].astype(np.float32))
    assert np.array_equal(np.array(order)[mesh.faces], F)
    lines = [f"vertex {x!r} {y!r} {z!r}" for x, y, z in V[F].reshape(-1, 3).tolist()]
    facets = [
        ["facet normal 0 0 1", "outer loop", *lines[k : k + 3], "endloop", "endfacet"] for k in (0, 3, 6)
    ]
    text = "\n".join(["solid a", *(line for facet in facets for line in facet), "endsolid a"])
    mesh = surface_io.read(write("b.stl", text))
    assert np.array_equal(mesh.vertices[mesh.faces], V[F])
    assert len(mesh.vertices) == 5


def test_an_obj_of_several_objects_with_polygons_and_relative_indices(write):
    text = """# a comment
        o first
        v 0 0 0
        v 1 0 0 # here too
        v 1 1 0
        v 0 1 0
        v -1 .5 0
        vt 0 0
        vt 1 0 0
        vn 0 0 1
        g a b
        usemtl red
        f 1/1/1 2/2/1 3/1/1 4//1 5
        o second
        v 0 0 1
        v 1e0 0 1
        v 0 \\
          1 1
        f -3 -2 -1
        s off
        f 1//1 2//1 3//1
        """
    text = text.replace("vt 0 0\n", "vt 0 0 0\n")
    for name, contents in [
        ("a.obj", text),
        ("b.obj", text.replace("\n", "\r\n")),
        ("c.obj", "\ufeff" + text),
    ]:
        mesh = surface_io.read(write(name, contents))
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4], [5, 6, 7], [0, 1, 2]]
        assert mesh.vertices[7].tolist() == [0, 1, 1]
        assert mesh.uv_faces.tolist() == [[0, 1, 0], [0, 0, -1], [0, -1, -1], [-1] * 3, [-1] * 3]
    again = surface_io.read(write("d.obj", surface_io.encode(mesh, ".obj")))
    assert np.array_equal(again.uv_faces, mesh.uv_faces)


POLYGONS = """ply
format {format} 1.0
comment made by hand
element vertex 5
property float x
property double y
property short z
property uchar red
property uchar green
property uchar blue
property float weight
element face 3
property uchar kind
property list uchar int vertex_indices
property list uchar float texcoord
end_header
"""


def polygons(order: str) -> bytes:
    points = [(0.0, 0.0, 0), (1.0, 0.0, 0), (1.0, 1.0, 3), (0.0, 1.0, 0), (0.5, 2.0, -1)]
    rows = [(*p, 255, k, 0, k / 4) for k, p in enumerate(points)]
    faces = [[0, 1, 2], [3, 2, 1, 0], [0, 1, 2, 3, 4]]
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = POLYGONS.format(format=name).encode()
    if not order:
        lines = [" ".join(map(str, row)) for row in rows]
        for face in faces:
            texture = " ".join(f"{k} 0.5" for k in face)
            lines.append(f"9 {len(face)} {' '.join(map(str, face))} {2 * len(face)} {texture}")
        return head + "\n".join(lines).encode()
    body = b"".join(struct.pack(f"{order}fdhBBBf", *row) for row in rows)
    for face in faces:
        texture = [x for k in face for x in (k, 0.5)]
        body += struct.pack(
            f"{order}BB{len(face)}iB{2 * len(face)}f", 9, len(face), *face, len(texture), *texture
        )
    return head + body


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_a_ply_that_mixes_polygons(write, order):
    mesh = surface_io.read(write("a.ply", polygons(order)))
    assert mesh.faces.tolist() == [[0, 1, 2], [3, 2, 1], [3, 1, 0], [0, 1, 2], [0, 2, 3], [0, 3, 4]]
    assert mesh.vertices[2].tolist() == [1, 1, 3] and mesh.vertices[4].tolist() == [0.5, 2, -1]
    assert np.array_equal(mesh.uv[mesh.uv_faces][..., 0], mesh.faces)
    np.testing.assert_allclose(mesh.colours[:, 1], np.arange(5) / 255)
    assert mesh.attributes["weight"].tolist() == [0, 0.25, 0.5, 0.75, 1]


def test_trimesh_reads_what_we_write(write):
    for ending in surface_io.ENDINGS:
        path = write(f"a{ending}", surface_io.encode(Mesh(V[:5], F, None, None, COLOURS[:5]), ending))
        mesh = trimesh.load_mesh(path, process=False)
        np.testing.assert_allclose(mesh.vertices[mesh.faces], V[F], atol=1e-6)


def test_an_off_with_comments_polygons_and_colours(write):
    text = "OFF # header\n\n4 2 0\n0 0 0\n1 0 0 # b\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2\n"
    for contents in (text, text.replace("OFF # header\n\n", "OFF "), text.replace("OFF # header\n", "")):
        mesh = surface_io.read(write("a.off", contents))
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2]]


def test_a_scene_is_one_mesh_with_its_parts_where_they_stand(write):
    part = trimesh.Trimesh(V[:5], F, process=False)
    other = trimesh.Trimesh(V[:4] + 1, F[:2], process=False)
    move, mirror = np.eye(4), np.diag([-1.0, 1, 1, 1])
    move[:3, 3] = 10, 0, 0
    scene = trimesh.Scene()
    scene.add_geometry(part, geom_name="p", node_name="one")
    scene.add_geometry(other, geom_name="q", node_name="two", parent_node_name="one", transform=move)
    scene.graph.update("three", "world", matrix=mirror, geometry="p")
    mesh = surface_io.read(write("a.glb", scene.export(file_type="glb")))
    assert len(mesh.vertices) == 5 + 5 + 4 and len(mesh.faces) == 8
    corner = mesh.vertices[mesh.faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    base = np.cross(V[F][:, 1] - V[F][:, 0], V[F][:, 2] - V[F][:, 0])
    # The mirrored copy is not inside out: its normals are the mirrored ones.
    found = {tuple(np.round(n, 5)) for n in normal[:6]}
    wanted = {tuple(np.round(n, 5)) for n in np.vstack([base, base * [-1, 1, 1]])}
    assert {tuple(x + 0.0 for x in n) for n in found} == {tuple(x + 0.0 for x in n) for n in wanted}
    np.testing.assert_allclose(mesh.vertices[10:], (V[:4] + 1 + [10, 0, 0]).astype(np.float32), atol=1e-6)


def glb(header: dict, body: bytes = b"") -> bytes:
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body
    )
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


GOOD_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
PLY = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
PLY += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
GARBAGE = bytes(range(256)) * 8
BROKEN = {
    "empty.obj": (b"", "a file with something in it; got an empty one"),
    "blank.ply": (b"  \n", "a file with something in it; got an empty one"),
    "a.xyz": (b"1 2 3", r"a mesh, .obj, .ply, .off, .stl, .glb; got .xyz\. Save it"),
    "garbage.obj": (GARBAGE, "text in UTF-8; got byte 0x80"),
    "binary.obj": (b"\0\1\2\3", "a mesh, .obj; got"),
    "garbage.off": (GARBAGE, "text in UTF-8"),
    "garbage.ply": (GARBAGE, "a mesh that begins with ply"),
    "garbage.stl": (GARBAGE, r"a whole mesh, of the \d+ bytes that the 1397903696 triangles .*; got 2048\."),
    "short.stl": (GARBAGE[:80] + b"\xff", r"a mesh, \.stl, with a head of 84 bytes; got 81\. Save"),
    "letters.glb": (
        glb({"asset": {"version": "2.0", "generator": "~"}}).replace(b"~", b"\xff"),
        r"a mesh, \.glb, (whose text is UTF-8; got other bytes|that trimesh reads; got an error)",
    ),
    "far.obj": (
        GOOD_OBJ + "v 1e90 0 0\nf 1 2 3\n",
        r"vertices that are finite and at most 1e\+70 in size; got \[1e\+90, 0.0, 0.0\] as vertex 3",
    ),
    "garbage.glb": (GARBAGE, "a mesh, .glb, that trimesh reads; got an error"),
    "none.obj": (GOOD_OBJ, "a mesh with faces; got 3 vertices and 0 faces"),
    "nan.obj": (
        GOOD_OBJ + "v nan 0 0\nf 1 2 3\n",
        "positions of three finite numbers; got 'nan 0 0' in line 4",
    ),
    "short.obj": (
        "v 0 0\n" + GOOD_OBJ + "f 1 2 3\n",
        "positions of three finite numbers; got '0 0' in line 1",
    ),
    "mixed.obj": (GOOD_OBJ + "v 1 2 3 .5 .5 .5\nf 1 2 3\n", "positions of three finite .* in line 4"),
    "word.obj": (GOOD_OBJ + "v a b c\nf 1 2 3\n", "positions of three finite numbers; got 'a b c' in line 4"),
    "range.obj": (GOOD_OBJ + "f 1 2 3\nf 1 2 4\n", "faces use its vertices, 1 to 3; got 4 in line 5"),
    "before.obj": (GOOD_OBJ + "f -1 -2 -4\n", "faces use its vertices, 1 to 3; got -4 in line 4"),
    "zero.obj": (GOOD_OBJ + "f 0 1 2\n", "faces are indices from 1; got '0 1 2' in line 4"),
    "slash.obj": (GOOD_OBJ + "f 1/ 2/1/1/1 3\n", "faces are indices from 1; got .* in line 4"),
    "float.obj": (GOOD_OBJ + "f 1.5 2 3\n", "faces are indices from 1; got '1.5 2 3' in line 4"),
    "two.obj": (GOOD_OBJ + "f 1 2\n", "faces have three corners or more; got '1 2' in line 4"),
    "vt.obj": (GOOD_OBJ + "vt 0 0\nf 1/1 2/1 3/2\n", "texture coordinates, 1 to 1; got 2 in line 5"),
    "novt.obj": (GOOD_OBJ + "f 1/1 2/1 3/2\n", "texture coordinates, 1 to 0; got 1 in line 4"),
    "huge.obj": (GOOD_OBJ + "f 1 2 99999999999999999999999\n", "faces are indices|use its vertices"),
    "head.off": (b"COFF\n1 1 1\n", r"begins with OFF .* in line 1\. Binary"),
    "cut.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n", "a whole mesh, with 3 vertices and 1 faces; got 2 lines"),
    "range.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "0 to 2; got 3 in line 6"),
    "nan.off": (b"OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "finite numbers; got '1 0 inf' in line 4"),
    "face.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "a count, at least 3, .* in line 6"),
    "negative.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "a count, at least 3, .* in line 6"),
    "none.off": (b"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "a mesh with faces; got 3 vertices and 0 faces"),
    "range.ply": (PLY + "3 0 1 7\n", "faces use its vertices, 0 to 2; got 7 in face 0"),
    "nan.ply": (
        PLY.replace("0 1 0\n", "nan 1 0\n") + "3 0 1 2\n",
        r"vertices that are finite .*; got \[nan, .* as vertex 2",
    ),
    "weight.ply": (
        surface_io.encode(Mesh(V, F, attributes={"arm": np.full(6, np.inf)}), ".ply"),
        "a mesh with finite numbers, arm; got inf as number 0",
    ),
    "uv.ply": (
        surface_io.encode(Mesh(V, F, np.full((1, 2), np.nan), 0 * F), ".ply"),
        "a mesh with finite numbers, texture coordinate; got nan",
    ),
    "word.ply": (PLY + "3 0 1 x\n", "a mesh of numbers behind its header; got could not convert"),
    "cut.ply": (PLY + "3 0 1\n", "a whole mesh, with 1 of face"),
    "two.ply": (PLY + "2 0 1\n", "three corners or more; got 2 in face 0"),
    "half.ply": (PLY + "3 0 1 1.5\n", "faces use its vertices, 0 to 2; got 1.5 in face 0"),
    "end.ply": (b"ply\nformat ascii 1.0\n", "an end, end_header; got none"),
    "type.ply": (
        PLY.replace("float x", "real x") + "3 0 1 2\n",
        "header of .* got 'property real x' in line 4",
    ),
    "flat.ply": (PLY.replace("property float z\n", ""), "vertices have x, y and z; got x, y"),
    "list.ply": (
        PLY.replace("vertex_indices", "corners") + "3 0 1 2\n",
        "a list, vertex_indices; got no such",
    ),
    "twice.ply": (
        PLY.replace("float z", "float y") + "3 0 1 2\n",
        "different names; got two of one in vertex",
    ),
    "cut.glb": (surface_io.encode(FULL, ".glb")[:-40], "a mesh, .glb, that trimesh reads"),
    "none.glb": (glb({"asset": {"version": "2.0"}}), "a mesh with faces; got none|trimesh reads"),
    "cut.stl": (
        surface_io.encode(FULL, ".stl")[:-10],
        r"a whole mesh, of the (\d+) bytes that the \d triangles in its head take; got \d+\. Save it anew",
    ),
    "zero.stl": (b"solid a\nendsolid a\n", "a mesh with faces; got none|trimesh reads"),
    "nan.stl": (
        bytes(84 - 4) + struct.pack("<I12fH", 1, 0, 0, 1, 0, 0, float("nan"), 1, 0, 0, 0, 1, 0, 0),
        "a mesh of finite vertices; got",
    ),
}


def test_an_stl_in_letters_may_have_a_name_in_any_code(write):
    text = surface_io.encode(Mesh(V[:5], F), ".stl")
    letters = trimesh.load_mesh(write("a.stl", text)).export(file_type="stl_ascii")
    for name in ("H\xfclle".encode("latin-1"), "H\xfclle".encode()):
        mesh = surface_io.read(write("b.stl", letters.encode().replace(b"solid", b"solid " + name, 1)))
        np.testing.assert_allclose(mesh.vertices[mesh.faces], V[F], atol=1e-6)


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_file_says_so_in_one_line(write, name):
    contents, message = BROKEN[name]
    with pytest.raises(ValueError, match=rf"^surface_io.read: \S*{name} must be [^\n]*$") as caught:
        surface_io.read(write(name, contents))
    assert caught.match(message)


def test_an_index_out_of_range_in_a_glb_is_refused(write):
    body = np.array([0, 1, 9, 0], "<u2").tobytes() + V[:3].astype("<f4").tobytes()
    header = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "buffers": [{"byteLength": len(body)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 6},
            {"buffer": 0, "byteOffset": 8, "byteLength": 36},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
        ],
    }
    with pytest.raises(ValueError, match=r"must be [^\n]*(use the 3 vertices of their part 0|trimesh reads)"):
        surface_io.read(write("a.glb", glb(header, body)))


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"none.obj must be a file; got none of that name"):
        surface_io.read(tmp_path / "none.obj")
    (tmp_path / "folder.ply").mkdir()
    with pytest.raises(ValueError, match=r"folder.ply must be a file; got a folder"):
        surface_io.read(tmp_path / "folder.ply")


def test_what_cannot_be_written_is_refused():
    with pytest.raises(ValueError, match=r"^surface_io.encode: ending must be one of .obj, .*; got '.fbx'"):
        surface_io.encode(FULL, ".fbx")
    bad = Mesh(np.where(np.arange(18).reshape(6, 3) == 4, np.inf, V), F)
    for ending in surface_io.ENDINGS:
        with pytest.raises(ValueError, match=r"vertices must be finite; got .* at vertex 1\."):
            surface_io.encode(bad, ending)
    for ending in (".stl", ".glb"):
        with pytest.raises(ValueError, match=rf"within what a {ending} holds"):
            surface_io.encode(Mesh(V * 1e40, F), ending)
