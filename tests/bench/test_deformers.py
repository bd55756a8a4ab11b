"""The benchmarks of deformers: what they do is right, and what is missing is said; no time is judged."""

import json

import igl
import numpy as np
import pytest
from click.testing import CliRunner

from lietool.bench import bodies, deformers, meshes, skinning
from lietool.cli import command
from lietool.deform import probe, ways
from lietool.mesh import surface, surface_io
from lietool.verbs import _bench_deform


@pytest.mark.parametrize("count", [12, 42, 250, 2_892, 43_562])
def test_the_body_is_closed_and_has_as_many_vertices_as_asked_for(count):
    V, F = bodies.body(count)
    assert abs(len(V) - count) <= 0.1 * count
    state = surface.health(V, F)
    assert state.closed and state.components == 1 and not len(state.flat) and not state.doubles
    assert np.linalg.det(V[F]).sum() > 0.0


def test_the_sphere_is_that_of_the_icosahedron():
    V, F = bodies.sphere(12)
    assert len(V) == 12 and len(F) == 20
    edges = np.linalg.norm(V[F] - V[F[:, [1, 2, 0]]], axis=-1)
    np.testing.assert_allclose(edges, edges[0, 0], rtol=1e-14)


def test_a_cage_encloses_what_it_is_made_for():
    V, _ = bodies.body(500)
    C, G = bodies.cage(V)
    assert np.all(np.abs(igl.fast_winding_number(C, G, V) - 1.0) < 0.1)


def test_maps_turn_nothing_over_and_leave_the_lower_end():
    V, F = bodies.body(2_000)
    low = bodies.along(V)[2] == 0.0
    for change in bodies.MAPS.values():
        U = change(V)
        np.testing.assert_allclose(U[low], V[low], atol=1e-12)
        box = np.array([V.min(axis=0), V.max(axis=0)])
        np.testing.assert_array_equal(change(V[::7], box), U[::7])
        assert np.linalg.norm(U - V, axis=1).max() > 0.3
        assert np.linalg.det(U[F]).sum() > 0.0
    x = bodies.bent(V)
    # An arc that is as long as the axis was: a short step along the axis keeps its length in the middle.
    line = np.zeros((101, 3))
    line[:, 0] = np.linspace(0.0, 1.0, 101)
    arc = bodies.bent(line)
    assert np.linalg.norm(np.diff(arc, axis=0), axis=1).sum() == pytest.approx(1.0, rel=1e-3)
    assert x.shape == V.shape


def test_of_every_part_something_is_held():
    V, F = bodies.body(250)
    n = len(V)
    # A second body inside of the first, and a vertex that no face uses.
    V, F = np.vstack([V, 0.1 * V, [[0.0, 0.0, 0.1]]]), np.vstack([F, F + n])
    drag = deformers.drag(V, F)
    assert not set(drag.pins) & set(drag.handle)
    assert 2 * n in drag.pins and np.sum((drag.pins >= n) & (drag.pins < 2 * n)) == 1
    assert np.sum(drag.pins < n) > 2 and len(drag.handle) > 2
    with pytest.raises(ValueError, match=r"^deformers\.drag: V must be vertices of which some differ"):
        deformers.drag(np.zeros((3, 3)), np.array([[0, 1, 2]]))


def test_the_others_do_what_ours_do():
    V, _ = bodies.body(300)
    rest, current, w = deformers.probes(V)
    A = current @ np.linalg.inv(rest)
    printed = probe.prepare(V, rest, w, origin=np.zeros(3))
    before, each = skinning.linear(V, w, A)
    ours = probe.solve(printed, current, ways.LINEAR).points
    np.testing.assert_allclose(each(before()), ours, atol=1e-12)
    # Without stretch the blends of dual quaternions are one, where no sign is to be chosen.
    U, _, W = np.linalg.svd(A[:, :3, :3])
    A[:, :3, :3] = U @ W
    before, each = skinning.dual(V, w, A)
    ours = probe.solve(printed, A @ rest, ways.DUAL_QUATERNION).points
    np.testing.assert_allclose(each(before()), ours, atol=1e-12)


def test_libigl_holds_what_is_held():
    V, F = bodies.body(300)
    drag = deformers.drag(V, F)
    held = np.concatenate([drag.pins, drag.handle])
    prepare, solve = skinning.arap(V, F, held, V[held] + [0.0, 0.1, 0.0], 3)
    assert np.allclose(solve(prepare())[held], V[held] + [0.0, 0.1, 0.0])


@pytest.mark.parametrize("method", deformers.METHODS)
def test_a_row_says_what_was_timed(method):
    row = deformers.measure(method, 150)
    assert row.method == method and row.vertices == 162
    assert row.prepare > 0.0 and row.solve > 0.0 and not row.own and row.met is None


def test_goals_are_those_of_the_sizes_that_are_made():
    for (method, vertices), goals in deformers.GOALS.items():
        assert method in deformers.METHODS
        assert any(len(bodies.sphere(n)[0]) == vertices for n in (*deformers.POINTS, vertices))
        assert deformers.Row(method, vertices, 0.0, 0.0).met is True
        assert deformers.Row(method, vertices, 9.0, 9.0).met is False
        assert deformers.Row(method, vertices, 9.0, 9.0, own=True).met is None
        assert goals[1] is not None
    assert deformers.Row("Poisson, phi_so", deformers.SURFACE, 2.0, 0.01).met is False


def test_cages_are_left_out_where_there_are_many_points():
    chosen = deformers.chosen((1_000, 1_000_000), {skinning.ARAP: ""})
    assert ("cage, Green", 1_000) in chosen and ("cage, Green", 1_000_000) not in chosen
    assert ("probe, alexa", 1_000_000) in chosen
    assert skinning.ARAP not in dict(chosen)
    assert ("cage, Green", 1_000_000) in deformers.chosen((1_000_000,), {}, cages=True)


def test_the_measurements_as_json():
    words = ["bench", "deform", "--size", "100", "--only", "probe, l", "--only", "cage, m", "--json"]
    result = CliRunner().invoke(command, words)
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert [(row["method"], row["vertices"]) for row in rows] == [
        ("probe, linear", 92),
        ("cage, mean value", 92),
    ]
    assert all(row["megabytes"] > 10.0 and row["met"] is None for row in rows)


def test_the_goals_are_shown(monkeypatch):
    def measured(method, size, mesh):
        return deformers.Row(method, 43_562, 1.0, 0.07, mesh is not None)

    monkeypatch.setattr(_bench_deform, "_measured", measured)
    result = CliRunner().invoke(command, ["bench", "deform", "--only", "Poisson, phi"])
    lines = {line.split("  ")[0]: line for line in result.stdout.splitlines()[2:]}
    assert "< 1.5 s before, < 0.06 s each" in lines["Poisson, phi_so"]
    assert lines["Poisson, phi_so"].endswith("missed")
    assert not lines["Poisson, phi_se"].endswith(("met", "missed"))


def test_a_mesh_of_the_users_is_timed(tmp_path):
    path = tmp_path / "body.off"
    path.write_bytes(surface_io.encode(surface.Mesh(*bodies.body(150)), ".off"))
    words = ["bench", "deform", "--mesh", str(path), "--only", "Poisson, l", "--json"]
    (row,) = json.loads(CliRunner().invoke(command, words).stdout)["rows"]
    assert row["own"] and row["vertices"] == 162 and row["met"] is None
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")
    result = CliRunner().invoke(command, ["bench", "deform", "--mesh", str(path), "--only", "Poisson, l"])
    assert result.exit_code == 2 and "must be triangles with an area" in result.stderr


def test_what_there_is_not_is_a_usage_error():
    result = CliRunner().invoke(command, ["bench", "deform", "--only", "cages"])
    assert result.exit_code == 2 and "--only must begin one of: probe, linear; " in result.stderr


def test_without_the_others_it_says_so(monkeypatch):
    monkeypatch.setattr(skinning.importlib.util, "find_spec", lambda name: None)
    result = CliRunner().invoke(
        command, ["bench", "deform", "--size", "50", "--only", "probe, l", "--only", "lib"]
    )
    assert result.exit_code == 0, result.output
    said = "Compared without some: libigl is not installed; pytransform3d is not installed."
    assert said in result.stderr
    assert "libigl linear" not in result.stdout


@pytest.fixture(scope="module")
def subject():
    return meshes.Subject("body", *bodies.body(300))


class TestMeshes:
    """`bench meshes`: the table of every deformer on any mesh."""

    @pytest.mark.parametrize("deformer", meshes.DEFORMERS)
    def test_every_deformer_moves_a_body(self, subject, deformer):
        row = meshes.measure(subject, deformer)
        assert not row.refused and not row.failed and row.flipped <= 3
        assert 0.1 < row.least < 1.0 < row.most < 4.0

    def test_what_is_refused_has_its_message(self):
        V, F = bodies.body(200)
        F[3] = [3, 3, 5]
        row = meshes.measure(meshes.Subject("body", V, F), "shape blend")
        assert row.refused.startswith("shape_blend.prepare: F must be triangles with an area")
        assert not row.failed and np.isnan(row.solve)
        assert not meshes.measure(meshes.Subject("body", V, F), "probe, phi_so").refused

    def test_numbers_that_are_none_are_no_crash(self):
        V, F = bodies.body(200)
        for bad in (np.nan, np.inf, 1e90):
            W = V.copy()
            W[4, 1] = bad
            for deformer in meshes.DEFORMERS:
                row = meshes.measure(meshes.Subject("body", W, F), deformer)
                assert row.refused and not row.failed
        flat = V * [1.0, 0.0, 0.0]
        line = meshes.Subject("line", flat, F)
        rows = [meshes.measure(line, deformer) for deformer in meshes.DEFORMERS]
        assert not any(row.failed for row in rows) and np.isnan(rows[0].least)

    @pytest.mark.parametrize(
        "error", [TypeError("no"), ValueError("zero-size array to reduction"), np.linalg.LinAlgError("no")]
    )
    def test_an_error_without_a_message_of_ours_is_a_failure(self, monkeypatch, tmp_path, error):
        def broken(subject):
            raise error

        monkeypatch.setattr(
            meshes, "DEFORMERS", {"broken": broken, "probe, phi_so": meshes.DEFORMERS["probe, phi_so"]}
        )
        path = tmp_path / "body.off"
        path.write_bytes(surface_io.encode(surface.Mesh(*bodies.body(100)), ".off"))
        result = CliRunner().invoke(command, ["bench", "meshes", str(path)])
        assert result.exit_code == 1
        lines = result.stdout.splitlines()
        assert "failed: " in lines[1] and "probe" in lines[2]

    def test_vertices_that_are_nowhere_are_a_failure(self, monkeypatch):
        V, F = bodies.body(100)
        monkeypatch.setattr(meshes, "DEFORMERS", {"lost": lambda subject: lambda: V * np.nan})
        assert (
            meshes.measure(meshes.Subject("body", V, F), "lost").failed == f"{len(V)} vertices are not finite"
        )

    def test_the_table_as_json(self, tmp_path, monkeypatch):
        few = {name: meshes.DEFORMERS[name] for name in ("probe, phi_so", "cage, mean value", "shape blend")}
        monkeypatch.setattr(meshes, "DEFORMERS", few)
        path = tmp_path / "bad.off"
        path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n")
        result = CliRunner().invoke(command, ["bench", "meshes", str(path), "--json"])
        assert result.exit_code == 0, result.output
        found = json.loads(result.stdout)
        assert [row["deformer"] for row in found["rows"]] == list(few)
        assert "area 0 in face 0" in found["rows"][2]["refused"] and found["rows"][2]["least"] is None
        assert found["rows"][0]["vertices"] == 4 and found["rows"][0]["most"] > 0.5
        assert found["cages"]["bad.off"]["faces"] >= 12
