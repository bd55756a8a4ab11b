"""Painted weights: from text and from mesh files, and each mistake in them by its line."""

import numpy as np
import pytest

from lietool.deform import painted
from lietool.mesh import surface_io
from lietool.mesh.surface import Mesh

V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]])
F = np.array([[0, 1, 2], [1, 3, 2]])
WEIGHTS = {"arm": np.array([0, 0.25, 0.5, 1]), "leg": np.array([1, 0.75, 0.5, -0.125])}
COLOURS = np.array([[0, 1, 0], [1, 0, 0], [0.2, 0.4, 0.6], [1, 1, 1]])


@pytest.fixture
def write(tmp_path):
    def write(name: str, contents: str | bytes):
        path = tmp_path / name
        path.write_bytes(contents.encode() if isinstance(contents, str) else contents)
        return path

    return write


@pytest.mark.parametrize(
    "text", ["0 1\n.25 .75\n.5 .5\n1 -.125\n", "# a\n0, 1\n\n.25,.75 # b\n5e-1,.5\n1,-0.125"]
)
def test_lines_of_numbers(write, text):
    for name in ("w.txt", "w.csv"):
        found = painted.read(write(name, text), 4)
        assert np.array_equal(found, np.stack(list(WEIGHTS.values()), axis=1))
    assert painted.read(write("one.txt", "1\n0\n0\n1\n"), 4).shape == (4, 1)


def test_numbers_and_colours_of_a_mesh(write):
    ply = write("w.ply", surface_io.encode(Mesh(V, F, None, None, COLOURS, WEIGHTS), ".ply"))
    both = np.stack(list(WEIGHTS.values()), axis=1)
    assert np.array_equal(painted.read(ply, 4), both)
    assert np.array_equal(painted.read(ply, 4, ["leg"]), both[:, 1:])
    np.testing.assert_allclose(painted.read(ply, 4, ["blue", "arm"])[:, 0], COLOURS[:, 2], atol=1e-15)
    obj = write("w.obj", surface_io.encode(Mesh(V, F, None, None, COLOURS), ".obj"))
    assert np.array_equal(painted.read(obj, 4), COLOURS)
    glb = write("w.glb", surface_io.encode(Mesh(V, F, None, None, None, WEIGHTS), ".glb"))
    assert np.array_equal(painted.read(glb, 4, ["arm", "leg"]), both)


def test_what_is_wrong_is_said_in_a_line(write):
    plain = surface_io.encode(Mesh(V, F), ".obj")
    ply = surface_io.encode(Mesh(V, F, None, None, None, WEIGHTS), ".ply")
    for name, contents, names, message in [
        ("w.txt", "1\n2\n3\n", (), "weights of the 4 vertices of the mesh; got 3 of them"),
        ("w.txt", "1 2\n1\n", (), "2 finite numbers in each line as in the first; got '1' in line 2"),
        ("w.txt", "1\nnan\n1\n1\n", (), "1 finite numbers .* got 'nan' in line 2"),
        ("w.txt", "1\n\nx\n", (), "got 'x' in line 3"),
        ("w.txt", "# none\n", (), "a line of numbers for each vertex; got none"),
        ("w.txt", "", (), "an empty one"),
        ("w.txt", "1\n", ["arm"], "to have names; got .txt"),
        ("w.npy", b"1", (), "weights, .txt, .csv, .ply, .obj or .glb; got .npy"),
        (
            "w.txt",
            "1\n2\n-1e200\n4\n",
            (),
            r"of at most 1e\+150 in size; got -1e\+200 of handle 0 at vertex 2",
        ),
        ("w.obj", plain, (), "a mesh with numbers or colours of vertices; got none of them"),
        ("w.ply", ply, ["hand"], "a mesh with numbers hand of vertices; got arm, leg"),
        ("w.ply", ply, ["red"], "a mesh with numbers red of vertices; got arm, leg"),
    ]:
        with pytest.raises(
            ValueError, match=rf"^(painted|surface_io).read: \S*{name} must be [^\n]*$"
        ) as caught:
            painted.read(write(name, contents), 4, names)
        assert caught.match(message)
    with pytest.raises(ValueError, match="weights of the 5 vertices of the mesh; got 4 of them"):
        painted.read(write("w.ply", ply), 5)
