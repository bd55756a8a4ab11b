"""What the plates of Poisson editing claim: who stays, who turns how far, and what it costs; a user's own."""

import json

import numpy as np
import pytest
from lietool.figures.ch7 import _close as close
from lietool.figures.ch7 import _poisson_case as case_
from lietool.figures.ch7 import _poisson_examples as examples

from lietool import figure, paths
from lietool.lie import so3, sym
from lietool.mesh import solids, surface_io
from lietool.mesh.surface import Mesh
from lietool.render import mesh_lines, style
from lietool.render import solids as solids_
from lietool.render.camera import Camera, project
from lietool.render.scene import Lines, Surface
from lietool.render.theme import Mix

POISSON = figure.load("poisson", (paths.FIGURES,))
RNG = np.random.default_rng(2)
PHI, POLAR = case_.WAYS["phi-so"], case_.WAYS["polar-quaternion"]


def moved(A, V):
    return V @ A[:3, :3].T + A[:3, 3]


class TestHandles:
    def test_pins_stay_and_the_handle_goes(self):
        case = examples.by_head()
        V, X = case.mesh.vertices, case.solve("harmonic", PHI, 1.0).vertices
        assert np.array_equal(X[case.pins], V[case.pins])
        A, _ = case.motions.at(1.0)
        assert np.allclose(X[case.handles[0]], moved(A[0], V[case.handles[0]]), atol=1e-12)

    def test_the_caption(self, plate):
        numbers = plate("B7.7").numbers
        assert numbers["distortion"]["flipped"] == 0
        L = numbers["transformations"][0, :3, :3]
        assert np.degrees(np.linalg.norm(so3.log(L @ np.linalg.inv(sym_part(L))))) == pytest.approx(30.0)

    def test_harmonic_weights_are_largest_at_the_handle_and_least_at_the_pins(self):
        case = examples.by_head()
        w = case.weights("harmonic")[:, 0]
        assert (w[case.handles[0]] == 1.0).all() and (w[case.pins] == 0.0).all()
        assert w.min() >= -1e-12 and w.max() <= 1.0 + 1e-12

    @pytest.mark.parametrize("kind", ["harmonic", "biharmonic", "geodesic"])
    def test_at_the_start_nothing_has_moved(self, kind):
        case = examples.by_head()
        X = case.solve(kind, PHI, 0.0).vertices
        assert np.allclose(X, case.mesh.vertices, atol=1e-11)


def sym_part(L):
    return sym.exp(0.5 * sym.log(L.T @ L))


class TestTurns:
    def test_quaternions_turn_by_the_remainder(self, plate):
        numbers = plate("B7.8").numbers
        assert numbers["phi-so"]["turned"][-1] == pytest.approx(400.0)
        assert numbers["polar-quaternion"]["turned"][-1] == pytest.approx(40.0)
        assert (np.diff(numbers["phi-so"]["turned"]) > 0.0).all()
        assert numbers["phi-so"]["flipped"] == 0 and numbers["polar-quaternion"]["flipped"] > 200

    def test_the_table(self, plate):
        numbers = plate("T7.1").numbers
        geodesic, harmonic, ours = (
            (numbers["asked 170"][name], numbers["asked 400"][name])
            for name in ("geodesic, polar-quaternion", "harmonic, polar-quaternion", "harmonic, phi-so")
        )
        for one, _ in (geodesic, harmonic, ours):
            assert one["turned"][-1] == pytest.approx(170.0) and one["flipped"] == 0
        assert geodesic[0]["95 %"] > 1.1 * harmonic[0]["95 %"]
        assert abs(ours[0]["mean"] - harmonic[0]["mean"]) < 0.02
        for _, other in (geodesic, harmonic):
            assert other["turned"][-1] == pytest.approx(40.0) and other["flipped"] > 200
        assert ours[1]["turned"][-1] == pytest.approx(400.0) and ours[1]["flipped"] == 0

    @pytest.mark.parametrize(("degrees", "by_quaternion"), [(300.0, -60.0), (540.0, 180.0), (-400.0, 40.0)])
    def test_other_turns(self, degrees, by_quaternion):
        case = examples.by_arm(degrees, "twist")
        found = [case_.turned(case, case.solve("harmonic", way, 1.0).vertices)[1][-1] for way in (PHI, POLAR)]
        assert found == pytest.approx([abs(degrees), by_quaternion])

    def test_both_have_the_handle_at_the_same_place(self):
        case = examples.by_arm(400.0, "roll")
        one, other = (case.solve("harmonic", way, 1.0).vertices[case.handles[0]] for way in (PHI, POLAR))
        assert np.allclose(one, other, atol=1e-12)

    def test_what_is_measured_is_what_was_done(self):
        case = examples.by_arm(500.0, "twist")
        V, w = case.mesh.vertices, case.weights("harmonic")
        x, c = case.motions.x[0], case.motions.centres[0]
        # Without Poisson's equation: every vertex turned about one line.
        X = ((so3.exp(w * x) @ (V - c)[..., None])[..., 0]) + c
        places, degrees = case_.turned(case, X)
        assert np.abs(degrees - 500.0 * places).max() < 9.0

    def test_the_guidance_of_a_rolled_arm(self):
        case = examples.by_arm(700.0, "roll")
        places, degrees = case_.guided(case, case.solve("harmonic", PHI, 1.0))
        assert degrees[-1] == pytest.approx(700.0) and np.abs(degrees - 700.0 * places).max() < 15.0


class TestMotions:
    def test_the_way_ends_where_it_should(self):
        A = np.tile(np.eye(4), (4, 1, 1))
        R = so3.exp(RNG.normal(size=(4, 3)))
        A[:, :3, :3] = R @ sym.exp(0.2 * np.stack([M + M.T for M in RNG.normal(size=(4, 3, 3))]))
        A[:, :3, 3] = RNG.normal(size=(4, 3))
        u = so3.log(R) / np.linalg.norm(so3.log(R), axis=1, keepdims=True)
        turns = np.array([0.0, 1.0, -2.0, 3.0])[:, None] * u
        motions = case_.Motions.of(RNG.normal(size=(4, 3)), A, turns)
        B, n = motions.at(1.0)
        assert np.allclose(B, A, atol=1e-12) and np.allclose(n, turns, atol=1e-9)
        start, none = motions.at(0.0)
        assert np.allclose(start, np.eye(4)) and not none.any()

    @pytest.mark.parametrize("degrees", [180.0, 360.0, 540.0, 720.0])
    def test_turns_that_end_at_a_branch(self, degrees):
        x = np.radians(degrees) * np.array([[0.0, 0.6, 0.8]])
        motions = case_.Motions(np.zeros((1, 3)), x, np.zeros((1, 3, 3)), np.zeros((1, 3)))
        A, turns = motions.at(1.0)
        assert np.allclose(so3.log(A[:, :3, :3]) + 2 * np.pi * turns, x, atol=1e-6)

    def test_a_straight_line_is_rolled_to_a_circle(self):
        line = np.linspace((0.0, 0.0, 0.0), (0.0, 2.0, 0.0), 41)
        a, free, held = 1.1, examples._HELD - examples._ROOT, 1.0 - examples._HELD
        middle = 0.5 * (1.0 + examples._HELD) * line[-1]
        go = examples._rolled(line, np.array([a, 0.0, 0.0]), middle)
        radius, ahead = 2.0 * free / a, held
        arc = np.array(
            [0.0, radius * np.sin(a) + ahead * np.cos(a), radius * (1 - np.cos(a)) + ahead * np.sin(a)]
        )
        assert np.allclose(middle + go, arc + np.array([0.0, 2.0 * examples._ROOT, 0.0]), atol=1e-5)


def bar():
    s = solids.bar(solids.DRAFT)
    return Mesh(s.vertices, s.faces, colours=np.tile([0.2, 0.4, 0.6], (len(s.vertices), 1)))


def files(tmp_path, mesh, **motion):
    data = {
        "pin": [{"box": {"low": [-1, -1, -1], "high": [1, 1, 0.3]}}],
        "handle": [{"name": "top", "box": {"low": [-1, -1, 2.8], "high": [1, 1, 4]}, "motion": motion}],
    }
    (tmp_path / "h.json").write_text(json.dumps(data))
    (tmp_path / "bar.ply").write_bytes(surface_io.encode(mesh, ".ply"))
    return {"mesh": tmp_path / "bar.ply", "handles": tmp_path / "h.json"}


class TestFiles:
    def test_the_mesh_is_given_back_with_all_that_belongs_to_it(self, tmp_path):
        mesh = bar()
        own = files(tmp_path, mesh, translation=[0, 0, 1])
        found = POISSON.draw(**own).mesh
        assert np.array_equal(found.faces, mesh.faces) and np.allclose(found.colours, mesh.colours, atol=0.01)
        low, high = mesh.vertices[:, 2] <= 0.3, mesh.vertices[:, 2] >= 2.8
        assert np.allclose(found.vertices[low], mesh.vertices[low])
        assert np.allclose(found.vertices[high], mesh.vertices[high] + (0.0, 0.0, 1.0))

    @pytest.mark.parametrize("example", ["handles", "octopus", "table"])
    def test_every_page(self, tmp_path, example):
        own = files(tmp_path, bar(), axis=[0, 0, 1], degrees=450)
        drawing = POISSON.draw(example=example, **own)
        assert drawing.numbers["turns"] == pytest.approx(np.array([[0.0, 0.0, 1.0]]))

    def test_a_twisted_bar_turns_as_far_as_asked(self, tmp_path):
        own = files(tmp_path, bar(), axis=[0, 0, 1], degrees=450)
        numbers = POISSON.draw(example="octopus", **own).numbers
        assert numbers["phi-so"]["turned"][-1] == pytest.approx(450.0)
        assert numbers["polar-quaternion"]["turned"][-1] == pytest.approx(90.0)

    def test_painted_weights(self, tmp_path):
        mesh = bar()
        own = files(tmp_path, mesh, axis=[0, 0, 1], degrees=90)
        z = mesh.vertices[:, 2]
        np.savetxt(tmp_path / "w.txt", np.clip((z - 0.3) / 2.5, 0.0, 1.0))
        numbers = POISSON.draw(paint=tmp_path / "w.txt", **own).numbers
        assert numbers["weights, mean"] == pytest.approx(np.clip((z - 0.3) / 2.5, 0.0, 1.0).mean())

    def test_vertices_that_no_face_uses(self, tmp_path):
        mesh = bar()
        more = Mesh(np.concatenate([mesh.vertices, [[5.0, 5.0, 5.0]]]), mesh.faces)
        drawing = POISSON.draw(**files(tmp_path, more, translation=[0, 0, 1]))
        assert drawing.notes == ("1 vertex that no face uses stays where it is",)
        assert np.array_equal(drawing.mesh.vertices[-1], [5.0, 5.0, 5.0])


class TestRefused:
    def test_half_of_what_is_needed(self, tmp_path):
        own = files(tmp_path, bar())
        with pytest.raises(ValueError, match="mesh and handles must be given together; got no handles"):
            POISSON.draw(mesh=own["mesh"])
        with pytest.raises(ValueError, match="mesh and handles must be given together; got no mesh"):
            POISSON.draw(handles=own["handles"])

    def test_a_part_that_nothing_holds(self, tmp_path):
        mesh = bar()
        V, n = mesh.vertices, len(mesh.vertices)
        two = Mesh(
            np.concatenate([V, 0.2 * V + (9.0, 0.0, 1.0)]), np.concatenate([mesh.faces, mesh.faces + n])
        )
        with pytest.raises(ValueError, match=f"a vertex in every connected part; got .* vertex {n}"):
            POISSON.draw(**files(tmp_path, two))

    def test_weights_of_other_handles(self, tmp_path):
        mesh = bar()
        own = files(tmp_path, mesh)
        np.savetxt(tmp_path / "w.txt", np.zeros((len(mesh.vertices), 2)))
        with pytest.raises(ValueError, match="paint must be weights of 1 handle, top; got 2 in"):
            POISSON.draw(paint=tmp_path / "w.txt", **own)

    def test_a_face_without_an_area(self, tmp_path):
        mesh = bar()
        flat = Mesh(mesh.vertices, np.concatenate([mesh.faces, [[0, 1, 1]], [[2, 2, 3]]]))
        with pytest.raises(
            ValueError, match=r"bar.ply must have an area in every face; got none in face \d+ and 1"
        ):
            POISSON.draw(**files(tmp_path, flat))

    @pytest.mark.parametrize(
        ("motion", "said"),
        [
            ({"scale": 1e90}, "handle top must stretch by at most"),
            ({"translation": [0, 0, 1e9]}, "must be within"),
        ],
    )
    def test_motions_beyond_measure(self, tmp_path, motion, said):
        with pytest.raises(ValueError, match=said):
            POISSON.draw(**files(tmp_path, bar(), **motion))

    def test_options_that_have_no_part_beside_files(self, tmp_path):
        own = POISSON.plate_params("B7.7") | files(tmp_path, bar())
        named = {parameter.name: parameter for parameter in POISSON.parameters}
        for example, names in (("octopus", ("motion", "turn")), ("table", ("motion", "turn", "first"))):
            for name in names:
                assert "mesh" in named[name].idle_because(own | {"example": example})
        assert "paint" in named["weights"].idle_because(own | {"paint": tmp_path / "w.txt"})
        assert not named["weights"].idle(own)


class TestClose:
    def test_what_is_seen_ends_at_the_frame(self):
        box, camera = (100.0, 200.0, 300.0, 150.0), Camera((1.0, 0.4, 0.3), (0.1, 0.2, 0.3), 1.5)
        V, F, N = solids_.sphere(2.0, (0.0, 0.3, 0.2), 24)
        fading = Mix((style.INK, style.PAPER), np.tile([0.25, 0.75], (len(V), 1)), np.ones(len(V)))
        records = [Surface(V, F, fading, N), Lines(mesh_lines.all_edges(V, F), style.INK)]
        surface, lines = close.within(records, camera, box)
        assert len(surface.color) == len(surface.vertices) == len(surface.normals)
        used = np.unique(surface.faces)
        seen = project(camera, box, surface.vertices[used])
        for k in (0, 1):
            assert seen[:, k].min() == pytest.approx(box[k], abs=0.3)
            assert seen[:, k].max() == pytest.approx(box[k] + box[2 + k], abs=0.3)
        ends = np.asarray(lines.points)[np.isfinite(lines.points).all(axis=1)]
        at = project(camera, box, ends)[:, :2] - np.array(box[:2])
        assert (at > 0.0).all() and (at < box[2:]).all() and len(ends) < 2 * len(F)

    def test_all_of_it_or_nothing(self):
        box, camera = (0.0, 0.0, 100.0, 100.0), Camera(target=(0.0, 0.0, 0.0), height=9.0)
        V, F, N = solids_.sphere(1.0, (0.0, 0.0, 0.0), 12)
        (whole,) = close.within([Surface(V, F, style.INK, N)], camera, box)
        assert len(whole.faces) == len(F)
        aside = V + 30.0 * camera.axes[0]
        assert close.within([Surface(aside, F, style.INK, N)], camera, box) == []
