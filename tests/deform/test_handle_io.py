"""Files of pins and handles: who belongs to what, what moves it, and every mistake by its name."""

import json

import numpy as np
import pytest

from lietool.deform import handle_io
from lietool.lie import so3
from lietool.mesh.surface import Mesh

GRID = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
MESH = Mesh(
    GRID,
    np.array([[0, 1, 2]]),
    colours=np.tile([1.0, 0.0, 0.25], (64, 1)),
    attributes={"held": (GRID[:, 0] == 3.0) * 0.75},
)
TOP = {"box": {"low": [0, 0, 3], "high": [3, 3, 3]}}


def read(tmp_path, data):
    file = tmp_path / "h.json"
    file.write_text(json.dumps(data))
    return handle_io.read(file, MESH)


def handle(**more):
    return {"handle": [{**TOP, **more}]}


class TestWho:
    def test_by_number_ball_box_and_paint(self, tmp_path):
        pins = [
            {"vertices": [5, 7]},
            {"ball": {"centre": [1, 1, 1], "radius": 1.0}},
            {"attribute": {"name": "held"}},
            {"attribute": {"name": "blue", "above": 0.3}, "vertices": [9]},
        ]
        found = read(tmp_path, {"pin": pins, **handle()})
        wanted = np.linalg.norm(GRID - 1.0, axis=1) <= 1.0
        wanted |= GRID[:, 0] == 3.0
        wanted[[5, 7, 9]] = True
        wanted &= GRID[:, 2] < 3.0
        assert np.array_equal(found.pins, np.flatnonzero(wanted))
        assert np.array_equal(found.vertices[0], np.flatnonzero(GRID[:, 2] == 3.0))

    def test_without_pins(self, tmp_path):
        found = read(tmp_path, handle())
        assert not len(found.pins) and found.names == ("1",)
        assert np.array_equal(found.A[0], np.eye(4)) and not found.turns.any()

    def test_the_centre(self, tmp_path):
        assert np.allclose(read(tmp_path, handle()).centres, [[1.5, 1.5, 3.0]])
        assert np.allclose(read(tmp_path, handle(centre=[1, 2, 3])).centres, [[1.0, 2.0, 3.0]])


class TestMotion:
    def test_about_the_centre(self, tmp_path):
        motion = {"axis": [0, 0, 2], "degrees": 400, "scale": 2, "translation": [0, 0, 1]}
        found = read(tmp_path, handle(centre=[1, 2, 3], motion=motion))
        R = so3.exp([0.0, 0.0, np.radians(400)])
        P = np.random.default_rng(3).normal(size=(5, 3))
        c = np.array([1.0, 2.0, 3.0])
        assert np.allclose(P @ found.A[0, :3, :3].T + found.A[0, :3, 3], (P - c) @ (2 * R.T) + c + (0, 0, 1))
        assert np.allclose(found.turns, [[0.0, 0.0, 1.0]])

    def test_a_matrix_is_of_space(self, tmp_path):
        M = np.eye(4)
        M[:3] = np.random.default_rng(4).normal(size=(3, 4)) + 3.0 * np.eye(3, 4)
        assert np.allclose(read(tmp_path, handle(motion={"matrix": M.tolist()})).A[0], M)

    def test_toml(self, tmp_path):
        file = tmp_path / "h.toml"
        file.write_text('[[handle]]\nname = "tip"\nvertices = [0]\nmotion = { translation = [1, 0, 0] }\n')
        found = handle_io.read(file, MESH)
        assert found.names == ("tip",) and np.array_equal(found.A[0, :3, 3], [1.0, 0.0, 0.0])


MIRROR = np.diag([1.0, 1.0, -1.0, 1.0]).tolist()
MISTAKES = [
    ({}, "must be a file of handles, with at least one .*; got none"),
    ({"handles": []}, "must be a table of pin, handle; got the key 'handles'"),
    ({"pin": {}, **handle()}, r"pin must be \[\[pin\]\] tables, or left out; got"),
    ({"handle": [{}]}, "handle 1 must be given vertices, ball, box or attribute; got none of them"),
    (
        {"handle": [{"vertices": [64]}]},
        "handle 1, vertices must be numbers of the 64 vertices, from 0; got 64",
    ),
    ({"handle": [{"vertices": [0.5]}]}, "vertices must be a list of whole numbers"),
    (
        {"handle": [{"vertices": []}]},
        r"must be of at least one vertex; got none. The mesh goes from \[0.0, 0",
    ),
    ({"handle": [{"ball": {"centre": [0, 0, 0]}}]}, "ball must be given centre and radius; got no radius"),
    ({"handle": [{"ball": {"centre": [0, 0, 0], "radius": 0}}]}, "radius must be above 0; got 0"),
    ({"handle": [{"box": {"low": [1, 0, 0], "high": [0, 1, 1]}}]}, "box, high must be at least low"),
    (
        {"handle": [{"attribute": {"name": "x"}}]},
        "name must be numbers of .* red, green, blue, held; got 'x'",
    ),
    ({"handle": [TOP, TOP]}, "handle 2 must be of vertices of its own; got vertex 3, which is handle 1's"),
    ({"handle": [{"name": "a", **TOP}, {"name": "a", "vertices": [0]}]}, "name must be another than"),
    (handle(name=""), "handle 1, name must be a word"),
    (handle(spin=3), r"must be a table of name, centre, motion, .*; got the key 'spin'"),
    (handle(motion={"degrees": 3}), "axis must be given beside degrees"),
    (handle(motion={"matrix": MIRROR}), "motion, matrix must be of positive determinant; got -1"),
    (handle(centre=[0, 0]), "centre must be a list of 3 numbers"),
]


@pytest.mark.parametrize(("data", "message"), MISTAKES)
def test_mistakes(tmp_path, data, message):
    with pytest.raises(ValueError, match=message) as caught:
        read(tmp_path, data)
    assert "\n" not in str(caught.value) and "h.json" in str(caught.value)
