"""Figure 4 of Kaji and Ochiai: paths through keys, against SciPy's splines and its matrix logarithm."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation

from lietool import figure, paths
from lietool.mesh import surface_io
from lietool.mesh.surface import Mesh
from lietool.render import style
from lietool.render.scene import Label, Surface

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def drawn(**params):
    return figure.load("pose", (paths.FIGURES,)).draw(**params)


def texts(drawing):
    return [r.text for view in drawing.picture.views for r in view.records if isinstance(r, Label)]


def natural(values):
    """The cubic through four keys: with so few, not-a-knot is one polynomial."""
    return CubicSpline(np.arange(4.0), values, bc_type="not-a-knot")


@pytest.fixture
def mesh(tmp_path):
    path = tmp_path / "corner.obj"
    path.write_text(TETRAHEDRON)
    return path


@pytest.fixture
def keys(tmp_path):
    def write(data, name="keys.json"):
        path = tmp_path / name
        path.write_text(data if isinstance(data, str) else json.dumps(data))
        return path

    return write


class TestNumbers:
    def test_matrices_added_up_are_inside_out_for_a_while(self, plate):
        shown = plate("K4").numbers
        A = natural(shown["keys"][:, :3, :3])(np.linspace(0.0, 3.0, 2001))
        det = np.linalg.det(A)
        assert det.min() < 0.0
        assert shown["linear least det"] == pytest.approx(det.min(), abs=1e-4)
        assert shown["linear inside out"] == pytest.approx(np.mean(det <= 0.0), abs=0.006)

    def test_by_logarithms_nothing_is_inside_out_but_it_goes_the_long_way_round(self, plate):
        shown = plate("K4").numbers
        for name in ("phi_so", "alexa"):
            assert shown[f"{name} least det"] == pytest.approx(1.0)
            assert shown[f"{name} inside out"] == 0.0
        needed = shown["phi_so needed"]
        assert shown["alexa turned"] > 1.7 * needed
        assert needed <= shown["phi_so turned"] < 1.2 * needed

    def test_by_the_logarithm_it_is_drawn_out_as_no_key_is(self, plate):
        shown = plate("K4").numbers
        logs = np.array([np.real(logm(A[:3, :3])) for A in shown["keys"]])
        s = np.array([np.linalg.svd(expm(x))[1] for x in natural(logs)(np.linspace(0.0, 3.0, 601))])
        assert shown["alexa ratio"] == pytest.approx((s[:, 0] / s[:, 2]).max(), rel=1e-3)
        assert shown["alexa ratio"] > 5.0 * shown["keys ratio"]
        assert shown["phi_so ratio"] < 1.2 * shown["keys ratio"]
        near = plate("K4b").numbers
        assert near["phi_so ratio"] < near["keys ratio"] < 0.4 * near["alexa ratio"]

    def test_the_turns_needed_are_the_angles_between_the_keys(self, plate):
        shown = plate("K4").numbers
        u, _, v = np.linalg.svd(shown["keys"][:, :3, :3])
        R = Rotation.from_matrix(u @ v)
        angles = (R[:-1].inv() * R[1:]).magnitude()
        assert shown["phi_so needed"] == pytest.approx(np.degrees(angles.sum()), abs=1e-5)

    def test_the_way_of_the_matrix_logarithm(self, plate):
        shown = plate("K4").numbers
        logs = np.array([np.real(logm(A[:3, :3])) for A in shown["keys"]])
        L = np.array([expm(x) for x in natural(logs)(np.linspace(0.0, 3.0, 769))])
        u, _, v = np.linalg.svd(L)
        R = Rotation.from_matrix(u @ v)
        turned = np.degrees((R[:-1].inv() * R[1:]).magnitude().sum())
        assert shown["alexa turned"] == pytest.approx(turned, rel=1e-3)

    @pytest.mark.parametrize("t", [0.0, 1.0])
    def test_it_begins_and_ends_at_keys(self, t):
        shown = drawn(t=t).numbers
        assert shown["A"] == pytest.approx(shown["keys"][0 if t == 0.0 else -1], abs=1e-9)


class TestFiles:
    def test_the_mesh_that_is_returned_is_moved_by_the_path_at_the_moment(self, mesh, keys):
        file = keys(
            {"centre": [0, 0, 0], "key": [{}, {"axis": [0, 0, 1], "degrees": 400, "translation": [1, 2, 3]}]}
        )
        found = drawn(mesh=mesh, keys=file, t=0.5)
        R = Rotation.from_rotvec([0.0, 0.0, np.radians(200.0)]).as_matrix()
        assert found.mesh.vertices == pytest.approx(surface_io.read(mesh).vertices @ R.T + [0.5, 1.0, 1.5])

    def test_turns_are_stated_and_matrices_are_followed(self, mesh, keys):
        turned = [{}, {"axis": [0, 0, 1], "degrees": 120}, {"axis": [0, 0, 1], "degrees": 240}]
        R = [Rotation.from_rotvec([0, 0, k * 2 * np.pi / 3]).as_matrix() for k in range(3)]
        written = [{"matrix": [*([*map(float, row), 0.0] for row in M), [0.0, 0.0, 0.0, 1.0]]} for M in R]
        for given in (turned, written):
            found = drawn(mesh=mesh, keys=keys({"centre": [0, 0, 0], "key": given}), curve="straight", t=0.75)
            right = Rotation.from_rotvec([0.0, 0.0, np.pi]).as_matrix()
            assert found.numbers["A"][:3, :3] == pytest.approx(right, abs=1e-9)

    def test_a_matrix_moves_space(self, mesh, keys):
        """Whatever is turned about: 1 leaves the mesh where its file has it."""
        one, lifted = np.eye(4), np.eye(4)
        lifted[2, 3] = 2.0
        file = keys({"centre": [5, 0, 0], "key": [{"matrix": one.tolist()}, {"matrix": lifted.tolist()}]})
        V = surface_io.read(mesh).vertices
        assert drawn(mesh=mesh, keys=file, t=0.0).mesh.vertices == pytest.approx(V)
        assert drawn(mesh=mesh, keys=file, t=0.5).mesh.vertices == pytest.approx(V + np.array([0, 0, 1]))

    def test_times_and_toml(self, mesh, keys):
        file = keys("[[key]]\ntime = 2\n[[key]]\ntime = 6\ntranslation = [8, 0, 0]\n", "keys.toml")
        found = drawn(mesh=mesh, keys=file, t=0.25)
        assert found.numbers["times"] == pytest.approx([2.0, 6.0])
        assert found.numbers["A"][:3, 3] == pytest.approx([2.0, 0.0, 0.0])

    def test_a_key_without_a_logarithm_leaves_a_row_to_the_keys_alone(self, mesh, keys):
        half = {"axis": [0, 0, 1], "degrees": 180, "scale": [1, 2, 1]}
        found = drawn(mesh=mesh, keys=keys({"key": [{}, half]}))
        assert not found.numbers["alexa found"] and found.numbers["phi_so found"]
        assert r"$\mathrm{no\ real}$" in texts(found)

    @pytest.mark.parametrize(
        ("data", "message"),
        [
            ({"key": [{}]}, "two or more; got one"),
            ({"key": []}, "at least two"),
            ({"keys": [{}, {}]}, "a table of centre, key; got the key 'keys'"),
            ({"key": [{}] * 201}, "at most 200 keys; got 201"),
            ({"key": [{}, {"turn": 1}]}, "a table of time, axis"),
            (
                {"key": [{}, {"scale": 1e9}]},
                r"key 2 must be a pose that stretches by at most 1e\+06; got 1e\+09",
            ),
            (
                {"key": [{}, {"translation": [0, 1e90, 0]}]},
                r"key 2 must be a pose within 1e\+06 times the shape's size, .*; got .*e\+\d\d times it",
            ),
            ('{"key": [{}], "key": [{}, {}]}', "the key 'key' twice"),
            ({"key": [{}, {"turn": 1}]}, "key 2 must be a table of .*; got the key 'turn'"),
            (
                {"key": [{"time": 1}, {"time": 1}]},
                "key 2 has a later time than the one before; got 1 after 1",
            ),
            ({"key": [{}, {"scale": -1}]}, "key 2, scale must be above 0"),
            (
                {"key": [{}, {"matrix": np.diag([1, 1, -1, 1]).tolist()}]},
                "key 2, matrix must be of positive determinant; got singular values 1, 1, -1",
            ),
            ("{", "must be a JSON file"),
        ],
        ids=str,
    )
    def test_what_is_wrong_is_said_in_one_line(self, keys, data, message):
        with pytest.raises(ValueError, match=message) as caught:
            drawn(keys=keys(data))
        assert "\n" not in str(caught.value)

    def test_a_mesh_without_extent_is_refused(self, tmp_path):
        path = tmp_path / "point.obj"
        path.write_text("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")
        with pytest.raises(ValueError, match="extent"):
            drawn(mesh=path)


def test_a_mesh_may_lie_on_its_back(mesh, keys, tmp_path):
    V, F = surface_io.read(mesh).vertices, surface_io.read(mesh).faces
    lying = np.stack([V[:, 0], V[:, 2], -V[:, 1]], axis=1)
    (tmp_path / "lying.ply").write_bytes(surface_io.encode(Mesh(lying, F), ".ply"))
    seen = []
    for file, up, axis in ((mesh, "z", [0, 0, 1]), (tmp_path / "lying.ply", "y", [0, 1, 0])):
        given = keys({"key": [{}, {"axis": axis, "degrees": 200, "scale": 1.3}]}, f"{up}.json")
        records = [r for view in drawn(mesh=file, keys=given, up=up).picture.views for r in view.records]
        seen.append([r.vertices for r in records if isinstance(r, Surface)])
    assert len(seen[0]) == len(seen[1]) > 6
    for standing, stood in zip(*seen, strict=True):
        assert stood == pytest.approx(standing, abs=1e-6)


def test_its_own_colours_are_drawn_but_not_between_the_keys_nor_inside_out(mesh, tmp_path):
    bare = surface_io.read(mesh)
    colours = np.array([[0.2, 0.4, 0.6], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.6, 0.2, 0.0]])
    file = tmp_path / "coloured.ply"
    file.write_bytes(surface_io.encode(replace(bare, colours=colours), ".ply"))
    own, plain = (
        [r.color for view in drawn(mesh=path).picture.views for r in view.records if isinstance(r, Surface)]
        for path in (file, mesh)
    )
    light = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    painted = [color for color in own if isinstance(color, np.ndarray)]
    for color in painted:
        assert color[:, :3] == pytest.approx(light, abs=5e-3) and (color[:, 3] == 1.0).all()
    kept = (style.BETWEEN, style.WRONG)
    assert [isinstance(color, str) for color in own] == [color in kept for color in plain]
    assert painted and {style.BETWEEN, style.WRONG} <= {color for color in own if isinstance(color, str)}
