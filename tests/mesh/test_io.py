"""Meshes from files: order kept, nothing merged, flat ones laid in their plane, every refusal."""

import re
import struct

import numpy as np
import pytest

from lietool.mesh import io

CORNERS = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
V = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
TRIANGLES = V + "f 1 2 3\nf 1 3 4\n"
OFF = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
HEAD = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
)
BODY = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
BINARY = HEAD.replace("ascii", "binary_little_endian").encode() + struct.pack(
    "<12dB4i", *np.pad(CORNERS, ((0, 0), (0, 1))).ravel(), 4, 0, 1, 2, 3
)


def save(folder, name, contents):
    file = folder / name
    file.write_bytes(contents if isinstance(contents, bytes) else contents.encode())
    return file


@pytest.mark.parametrize(
    ("name", "contents"),
    [
        ("a.obj", TRIANGLES),
        ("a.obj", V + "f 1 2 3 4\n"),
        ("a.obj", V.replace(" 0\n", "\n") + "f -4 -3 -2 -1\n"),
        ("a.obj", "# a square\nmtllib no.mtl\no square\n" + V + "s off\nusemtl red\nf 1 2 3 \\\n4\n"),
        ("a.obj", V + "f 1 4 3 2\n"),
        ("A.OBJ", TRIANGLES.replace("\n", "\r\n")),
        ("a.off", OFF),
        ("a.off", "OFF 4 1 0 # counts\n\n0 0\n1 0\n1 1\n0 1\n4 0 1 2 3 255 0 0\n"),
        ("a.ply", HEAD + BODY),
        ("a.ply", HEAD.replace("property double z\n", "") + BODY.replace(" 0\n", "\n")),
        ("a.ply", BINARY),
    ],
)
def test_formats(tmp_path, name, contents):
    mesh = io.read(save(tmp_path, name, contents))
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    assert mesh.faces.shape == (2, 3)
    assert sorted(mesh.faces.ravel().tolist()) in ([0, 0, 1, 2, 2, 3], [0, 1, 1, 2, 3, 3])
    np.testing.assert_array_equal(mesh.plane.normal, [0.0, 0.0, 1.0])


def test_seams_split_no_vertex(tmp_path):
    text = V + "vt 0 0\nvt 1 0\nvt 1 1\nvt .5 .5\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/4/1 3/1/1 4/2/1\n"
    mesh = io.read(save(tmp_path, "a.obj", text))
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3]])


def test_faces_do_not_reorder_vertices(tmp_path):
    mesh = io.read(save(tmp_path, "a.obj", V + "f 4 1 3\nf 3 1 2\n"))
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    np.testing.assert_array_equal(mesh.faces, [[3, 0, 2], [2, 0, 1]])


@pytest.mark.parametrize("seed", range(6))
def test_any_plane(tmp_path, seed):
    rng = np.random.default_rng(seed)
    frame, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    origin = rng.normal(size=3)
    flat = rng.normal(size=(3, 2))
    space = origin + flat @ frame[:, :2].T
    mesh = io.read(save(tmp_path, "a.obj", io.obj(space, [[0, 1, 2]])))
    plane = mesh.plane
    np.testing.assert_allclose(np.cross(plane.u, plane.v), plane.normal, atol=1e-14)
    np.testing.assert_allclose(plane.origin + mesh.vertices @ np.stack([plane.u, plane.v]), space, atol=1e-12)
    a, b, c = mesh.vertices[mesh.faces[0]]
    assert np.cross([*(b - a), 0.0], [*(c - a), 0.0])[2] > 0.0
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2]])


def test_written_numbers_are_read_back(tmp_path):
    points = np.random.default_rng(0).normal(size=(3, 2)) * [1e-9, 1e9]
    mesh = io.read(save(tmp_path, "a.obj", io.obj(points, [[0, 1, 2]])))
    np.testing.assert_array_equal(mesh.vertices, points)


def test_pairs(tmp_path):
    first = save(tmp_path, "a.obj", TRIANGLES)
    second = save(tmp_path, "b.off", OFF.replace("1 1 0\n0", "3 2 0\n0"))
    pair = io.read_pair(first, second)
    np.testing.assert_array_equal(pair.source, CORNERS)
    np.testing.assert_array_equal(pair.target[2], (3.0, 2.0))
    np.testing.assert_array_equal(pair.faces, [[0, 1, 2], [0, 2, 3]])


def test_two_clockwise_meshes_are_no_reflection(tmp_path):
    first = save(tmp_path, "a.obj", V + "f 3 2 1\nf 4 3 1\n")
    second = save(tmp_path, "b.obj", V.replace("1 1 0", "2 2 0") + "f 4 3 1\nf 3 2 1\n")
    pair = io.read_pair(first, second)
    np.testing.assert_array_equal(pair.faces, [[0, 1, 2], [0, 2, 3]])


REFUSED = [
    ("a.obj", V + "f 1 2 9\n", "faces use its vertices, 1 to 4; got 9 in line 5"),
    ("a.obj", V + "f 0 1 2\n", "faces are indices from 1, at least three; got 'f 0 1 2' in line 5"),
    ("a.obj", V + "f 1 2\n", "at least three; got 'f 1 2' in line 5"),
    ("a.obj", V + "f 1 2 x\n", "got 'f 1 2 x' in line 5"),
    ("a.obj", V + "f -5 -1 -2\n", "got 0 in line 5"),
    ("a.obj", "v 0 0 x\n" + V, "positions are two or three finite numbers; got '0 0 x' in line 1"),
    ("a.obj", V + "v 0 nan 0\n", "got '0 nan 0' in line 5"),
    ("a.obj", V + "v 1e999 0 0\n", "got '1e999 0 0' in line 5"),
    ("a.obj", V, "a mesh with faces; got 4 vertices and 0 faces"),
    ("a.obj", "", "a file with something in it; got an empty one"),
    ("a.obj", V + "%!PS\n", "a mesh, .obj; got '%!PS' in line 5"),
    ("a.obj", b"v \xff\n", "text in UTF-8; got byte 0xff in line 1"),
    ("a.obj", V + "v 1 0 0\nf 1 2 3\nf 1 3 4\nf 3 5 4\n", "vertices 1 and 4 both at (1, 0). Merge them."),
    ("a.obj", "v 0 0\nv 1 0\nv 2 0\nf 1 2 3\n", "face 0, [0, 1, 2], of area 0 near (1, 0)"),
    (
        "a.obj",
        V + "f 1 2 3\nf 1 4 3\n",
        "got face 1, [0, 3, 2], turned over near (0.333333, 0.666667), 1 in all",
    ),
    ("a.obj", V + "f 1 2 3\n", "a use of every vertex; got none of vertex 3"),
    ("a.obj", V + "f 1 2 2\n", "three vertices in each triangle; got [0, 1, 1] at triangle 0"),
    ("a.obj", V.replace("1 1 0", "1 1 1") + "f 1 2 3 4\n", "a flat mesh; got vertex"),
    ("a.off", "COFF\n4 1 0\n", "begins with OFF; got 'COFF' in line 1"),
    ("a.off", "OFF\nx y z\n", "its numbers of vertices and faces; got 'x y z' in line 2"),
    ("a.off", "OFF\n", "its numbers of vertices and faces; got '' in line 1"),
    ("a.off", "OFF\n0 0 0\n", "got 0 vertices and 0 faces"),
    ("a.off", OFF[:20], "a whole mesh, with vertex 2 of 4; got its end"),
    ("a.off", OFF.replace("4 0 1 2 3", "4 0 1 2"), "face 0 of 1: a count, at least 3, and as many indices"),
    ("a.off", OFF.replace("4 0 1 2 3", "3 0 1 7"), "its vertices, 0 to 3; got 7 in line 7"),
    ("a.ply", "hello", "begins with ply; got 'hello' in line 1"),
    ("a.ply", HEAD[:60], "whose header has an end, end_header; got none"),
    ("a.ply", HEAD + BODY[:20], "a whole mesh, with 5 lines after its header; got 4"),
    ("a.ply", HEAD + BODY.replace("1 1 0", "1 x 0"), "finite numbers; got '1 x 0' in line 12"),
    ("a.ply", HEAD.replace("double x", "double w") + BODY, "have x and y; got w, y, z"),
    (
        "a.ply",
        HEAD + BODY.replace("4 0 1 2 3", "3 0 1 9"),
        "faces use its 4 vertices; got [0, 1, 9] as face 0",
    ),
    ("a.ply", BINARY[:-9], "that trimesh reads; got an error, PLY is unexpected length!"),
    ("a.stl", "solid", "a mesh, .obj, .off or .ply; got .stl"),
]


@pytest.mark.parametrize(("name", "contents", "words"), REFUSED)
def test_refusals(tmp_path, name, contents, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        io.read(save(tmp_path, name, contents))
    assert re.fullmatch(r"io\.read: [^\n]*a\.\w+(: F)? must be [^\n]*", str(caught.value))


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (V + "f 1 2 4\nf 2 3 4\n", "of the same faces as"),
        (V + "f 1 2 4\nf 2 3 4\n", "got face 0, [0, 1, 3], which"),
        (TRIANGLES + "v 2 2 0\nf 2 5 3\n", "4; got 5"),
        (V + "v .5 .5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", "of as many vertices as"),
        (
            TRIANGLES.replace("v 1", "v -1"),
            "got a reflection, det < 0 in every triangle. Mirror one of the meshes.",
        ),
        (TRIANGLES.replace("1 1 0", "-.5 .5 0"), "turned over near"),
    ],
)
def test_pairs_refused(tmp_path, other, words):
    first, second = save(tmp_path, "a.obj", TRIANGLES), save(tmp_path, "b.obj", other)
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        io.read_pair(first, second)
    assert "\n" not in str(caught.value) and "b.obj" in str(caught.value)


def test_no_such_file(tmp_path):
    with pytest.raises(ValueError, match=r"none\.obj must be a file; got none of that name"):
        io.read(tmp_path / "none.obj")


def test_writing_refuses(tmp_path):
    with pytest.raises(ValueError, match=r"io\.obj: vertices must be an array of shape \(n, 2\) or \(n, 3\)"):
        io.obj(np.zeros((3, 4)), [[0, 1, 2]])
    with pytest.raises(ValueError, match=r"io\.obj: F must be indices of the 3 vertices"):
        io.obj(np.eye(3), [[0, 1, 3]])
