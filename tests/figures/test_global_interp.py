"""What the plates of global interpolation claim: who flips, who does not, and that the ends are met."""

import sys
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image, ImageSequence

from lietool import figure, paths
from lietool.cli import command
from lietool.interp import forms
from lietool.mesh import io, shapes, topology
from lietool.render.scene import Surface

GLOBAL = figure.load("global-interp", (paths.FIGURES,))
MARKS, MORPH, STAGES, SWALLOW = (
    sys.modules[f"lietool.figures.ch6.{name}"]
    for name in ("_morph_marks", "_morph", "_morph_stages", "_swallow")
)
HALF = 20
DATA = Path(__file__).parent.parent / "data"


def turned(V, F):
    """How many triangles are turned over, by areas of our own."""
    a, b, c = (V[F[:, k]] for k in range(3))
    u, v = (b - a) @ (1.0, 1.0j), (c - a) @ (1.0, 1.0j)
    return int(np.sum((np.conj(u) * v).imag <= 0.0))


@pytest.mark.parametrize("name", shapes.SHAPES)
class TestShapes:
    def test_the_triangles_are_good_in_both(self, name):
        pair = shapes.SHAPES[name]()
        assert 300 <= len(pair.faces) <= 700
        for V in (pair.source, pair.target):
            assert (topology.areas(V, pair.faces) > 0.0).all()
            edges = V[pair.faces] - V[np.roll(pair.faces, 1, axis=1)]
            u = edges / np.linalg.norm(edges, axis=-1, keepdims=True)
            cosines = -np.sum(u * np.roll(u, 1, axis=1), axis=-1)
            assert np.degrees(np.arccos(cosines)).min() > 12.0

    def test_it_is_one_disc(self, name):
        pair = shapes.SHAPES[name]()
        assert len(topology.boundary(pair.faces)) == 1
        edges = topology.edges("test", pair.faces).ends
        assert len(pair.source) - len(edges) + len(pair.faces) == 1

    def test_it_is_the_same_every_time(self, name):
        first = shapes.SHAPES[name]()
        shapes.SHAPES[name].cache_clear()
        again = shapes.SHAPES[name]()
        assert np.array_equal(first.target, again.target) and np.array_equal(first.faces, again.faces)


class TestSwallow:
    def test_the_triangles_are_good_in_both(self):
        pair = SWALLOW.snake()
        areas = [topology.areas(V, pair.faces) for V in (pair.source, pair.target)]
        assert all((a > 0.0).all() for a in areas)
        # Small beside large ones, and not the same in both.
        assert areas[0].max() > 50.0 * areas[0].min()
        change = areas[1] / areas[0]
        assert change.min() < 0.4 and change.max() > 2.0
        assert len(pair.source) - len(topology.edges("test", pair.faces).ends) + len(pair.faces) == 1


class TestSkin:
    @pytest.mark.parametrize("name", shapes.SHAPES)
    def test_a_smooth_outline_holds_the_shape(self, name):
        pair = shapes.SHAPES[name]()
        points, faces, owner, rim = MARKS.skin(pair, pair.source)
        areas = topology.areas(points, faces)
        # At the sharpest tips a sliver may fold, by less than can be seen.
        assert areas.min() > -0.03 * np.median(topology.areas(pair.source, pair.faces))
        assert set(owner.tolist()) == set(range(len(pair.faces)))
        z = points[rim] @ np.array([1.0, 1.0j])
        enclosed = 0.5 * np.sum((np.conj(z[:-1]) * z[1:]).imag)
        assert areas.sum() == pytest.approx(enclosed)
        # The vertices stay where they are; so does, nearly, each triangle's area.
        assert np.array_equal(points[: len(pair.source)], pair.source)
        each = np.bincount(owner, areas)
        assert each == pytest.approx(topology.areas(pair.source, pair.faces), rel=0.6)
        assert set(pair.boundary.tolist()) <= set(rim.tolist())

    def test_a_shape_with_corners_keeps_them(self):
        pair = SWALLOW.Shape(
            np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
            np.zeros((4, 2)),
            np.array([[0, 1, 2], [0, 2, 3]]),
            np.arange(4),
            np.zeros(4),
            {"nose": 0, "tail": 2},
        )
        points, faces, owner, rim = MARKS.skin(pair, pair.source)
        assert points is pair.source and faces is pair.faces
        assert owner.tolist() == [0, 1] and rim.tolist() == [0, 1, 2, 3, 0]

    def test_what_a_ring_shows_lies_in_it(self):
        pair = shapes.fish()
        center, reach = pair.source[pair.marks["nose"]], 0.4
        triangles = pair.source[pair.faces]
        shown, owner = MARKS.within(triangles, np.arange(len(triangles)), center, reach)
        assert np.linalg.norm(shown.mean(axis=1) - center, axis=-1).max() <= reach
        a, b = (shown[:, k] - shown[:, 0] for k in (1, 2))
        areas = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        # By sampling: how much of each triangle lies inside.
        rng = np.random.default_rng(3)
        shares = rng.dirichlet(np.ones(3), 4000)
        inside = np.linalg.norm(np.einsum("sc,mcx->msx", shares, triangles) - center, axis=-1) <= reach
        expected = inside.mean(axis=1) * topology.areas(pair.source, pair.faces)
        found = np.bincount(owner, areas, len(triangles))
        assert found.sum() == pytest.approx(expected.sum(), rel=0.02)
        pieces = MARKS.cut(triangles[:, :2], center, reach)
        assert np.linalg.norm(pieces - center, axis=-1).max() <= reach + 1e-12

    def test_the_largest_empty_circle(self):
        points = np.array([[x, y] for x in range(0, 300, 5) for y in range(0, 200, 5) if (x, y) != (0, 0)])
        points = points[np.linalg.norm(points - [200.0, 90.0], axis=1) > 50.0]
        center, radius = MARKS.empty(points, (0.0, 0.0, 300.0, 200.0))
        assert np.linalg.norm(np.subtract(center, [200.0, 90.0])) < 12.0 and 36.0 < radius < 60.0


class TestLoci:
    def test_e_f_flips_most_of_the_fish(self, plate):
        shown = plate("B6.5").numbers
        assert shown["flipped"][HALF] > 0.7 * len(shapes.fish().faces)
        assert shown["least_det"].min() < -1.0 and shown["area"].min() < 0.0
        assert shown["flipped_in_frames"][2] == turned(shown["vertices"][2], shapes.fish().faces)

    def test_e_r_flips_none(self, plate):
        shown = plate("B6.7").numbers
        assert shown["flipped"].max() == 0 and shown["least_det"].min() > 0.5
        assert all(turned(V, shapes.fish().faces) == 0 for V in shown["vertices"])

    def test_the_curves_wind_a_full_turn_away(self):
        pair = shapes.fish()
        a, b = pair.marks["nose"], pair.marks["tail"]
        shown = [
            GLOBAL.draw(**GLOBAL.plate_params("B6.7") | {"winding": k, "steps": 3}).numbers for k in (0, -1)
        ]
        turns = []
        for numbers in shown:
            chord = (numbers["vertices"][:, a] - numbers["vertices"][:, b]) @ (1.0, 1.0j)
            turns.append(np.angle(chord[1:] / chord[:-1]).sum())
            middle = 0.5 * (numbers["vertices"][:, a] + numbers["vertices"][:, b])
            assert np.abs(middle).max() < 1e-12
        assert turns[0] - turns[1] == pytest.approx(2.0 * np.pi)
        mean = np.average(shown[0]["theta"], weights=topology.areas(pair.source, pair.faces))
        assert abs(turns[0] - mean) < np.pi

    def test_without_winding_neither_flips(self):
        for energy in ("frobenius", "similarity"):
            params = GLOBAL.plate_params("B6.5") | {"winding": 0, "energy": energy}
            assert GLOBAL.draw(**params).numbers["flipped"].max() == 0


class TestLargeRotations:
    def test_the_snake_rolls_up_by_more_than_540_degrees(self, plate):
        theta = plate("B6.8").numbers["theta_beside"]
        assert np.degrees(np.ptp(theta)) > 540.0

    def test_e_f_with_principal_angles_breaks_it(self, plate):
        shown = plate("B6.6").numbers
        assert np.abs(shown["theta"]).max() <= np.pi
        assert shown["flipped"].max() >= 3 and shown["least_det"].min() < -0.2

    def test_what_is_seen_larger_stands_still_in_a_film(self, monkeypatch):
        loupe, seen = sys.modules["lietool.figures.ch6._morph_loupe"], []
        draw = loupe.draw
        monkeypatch.setattr(loupe, "draw", lambda *args: seen.append((args[0], draw(*args))) or seen[-1][1])
        params = GLOBAL.plate_params("B6.6")
        for t in np.linspace(0.0, 1.0, 9):
            GLOBAL.draw(**params | {"t": float(t)})
        assert len(seen) == 9
        first = seen[0][0]
        for one, records in seen:
            assert one.k == 2 and np.array_equal(one.near, first.near)
            assert (*one.spot, one.radius, one.scale) == (*first.spot, first.radius, first.scale)
            for record in records:
                if isinstance(record, Surface):
                    far = np.linalg.norm(np.asarray(record.vertices)[:, :2] - one.spot, axis=1)
                    # Of a triangle that the ring cuts, pieces reach a little beyond.
                    assert far.max() < 1.1 * one.radius

    def test_e_r_with_the_same_input_does_not(self, plate):
        shown = plate("B6.8").numbers
        assert np.array_equal(shown["theta"], plate("B6.6").numbers["theta"])
        assert shown["flipped"].max() == 0 and shown["least_det"].min() > 0.3

    def test_and_stands_below_what_breaks(self, plate):
        shown, broken = plate("B6.8").numbers, plate("B6.6").numbers
        for name in ("theta", "flipped", "least_det", "energy"):
            assert np.array_equal(shown[f"{name}_above"], broken[name])

    def test_nor_does_e_f_with_consistent_angles(self, plate):
        shown = plate("B6.8").numbers
        assert shown["flipped_beside"].max() == 0 and shown["least_det_beside"].min() > 0.3
        # A thousandth of what the broken snake costs.
        assert shown["energy_beside"].max() < 1e-3 * plate("B6.6").numbers["energy"].max()

    def test_e_r_does_not_depend_on_the_angles(self, plate):
        params = GLOBAL.plate_params("B6.8")
        other = GLOBAL.draw(**params | {"angles": "consistent"}).numbers
        assert other["vertices"] == pytest.approx(plate("B6.8").numbers["vertices"], abs=1e-9)


class TestStages:
    def test_every_strip_begins_and_ends_with_the_shapes(self, plate):
        for plate_id in GLOBAL.plates:
            params = GLOBAL.plate_params(plate_id)
            if params["stage"] == "frames":
                pair, V = shapes.SHAPES[params["example"]](), plate(plate_id).numbers["vertices"]
                assert V[0] == pytest.approx(pair.source, abs=1e-9)
                assert V[-1] == pytest.approx(pair.target, abs=1e-9)

    def test_local_maps_tear_it_apart_and_global_ones_do_not(self, plate):
        torn = plate("B6.3").numbers
        pair = shapes.gecko()
        assert torn["largest_gap"] > 1.0
        P = pair.source[pair.faces]
        for corners, A, p in zip(torn["corners"][::50], torn["maps"][::50], P[::50], strict=True):
            assert corners[1] - corners[0] == pytest.approx(A @ (p[1] - p[0]), abs=1e-12)
        assert plate("B6.4").numbers["det"].min() > 0.3

    def test_numbers_stand_at_nose_feet_and_tail(self, plate):
        pair, numbered = shapes.gecko(), plate("B6.1").numbers["numbered"]
        assert numbered[0] == pair.marks["nose"] and pair.marks["tail"] in numbered
        assert len(numbered) == 6 and set(numbered.tolist()) <= set(pair.boundary.tolist())

    def test_neighbours_in_the_ring_share_their_edge(self):
        pair = shapes.gecko()
        choice = MORPH.Choice("frobenius", "logexp", "consistent", "line", 0.0, 0, 0, 0.5, "area")
        corners = MORPH.apart(pair, choice, 0.5)[0]
        two, edges = STAGES.shared(pair, corners, corners, np.zeros(2))
        assert len(set(pair.faces[two[0]]) & set(pair.faces[two[1]])) == 2
        for f, edge in zip(two, edges, strict=True):
            assert all(any(np.array_equal(p, c) for c in corners[f]) for p in edge)
        whole = STAGES.shared(pair, pair.source[pair.faces], corners, np.zeros(2))[1]
        assert whole[0] == pytest.approx(whole[1], abs=1e-12)

    def test_apart_at_the_ends_it_is_whole(self):
        for t in (0.0, 1.0):
            assert GLOBAL.draw(stage="local", t=t).numbers["largest_gap"] < 1e-9

    def test_maps_carry_triangles_to_triangles(self, plate):
        shown = plate("B6.2").numbers
        assert len(shown["maps"]) == 3
        for A, P, Q in zip(shown["maps"], shown["source"], shown["target"], strict=True):
            assert (P[1:] - P[0]) @ A.T == pytest.approx(Q[1:] - Q[0])


class TestEnergies:
    def test_points_give_up_small_triangles(self, plate):
        shown, pair = plate("G6.1").numbers, SWALLOW.snake()
        assert shown["least_det_beside"].min() < shown["least_det"].min()
        assert shown["flipped_beside"].max() > 20 and shown["flipped"].max() == 0
        # A tenth of the triangles, the smallest and the largest: worse under E^P, and better.
        order = np.argsort(topology.areas(pair.source, pair.faces))
        tenth = len(order) // 10
        ratio = np.log(shown["error_beside"] / shown["error"])
        assert ratio[order[:tenth]].mean() > 0.5 and ratio[order[-tenth:]].mean() < -0.5

    def test_errors_are_those_of_the_maps(self, plate):
        shown, pair = plate("G6.1").numbers, SWALLOW.snake()
        energy = np.sum(topology.areas(pair.source, pair.faces) * shown["error"] ** 2)
        area = topology.areas(pair.source, pair.faces).sum()
        assert energy / area == pytest.approx(shown["energy"][HALF])

    def test_points_up_to_similarity_follow_where_e_f_flips(self, plate):
        shown = plate("G6.2").numbers
        assert shown["flipped"].max() == 0 and shown["flipped_beside"].max() > 50

    def test_errors_up_to_similarity_agree_in_substance(self, plate):
        params = GLOBAL.plate_params("G6.2") | {"beside": "similarity"}
        shown, pair = GLOBAL.draw(**params).numbers, shapes.cat()
        assert shown["flipped"].max() == shown["flipped_beside"].max() == 0
        far = np.linalg.norm(shown["vertices"] - shown["vertices_beside"], axis=-1).max()
        assert 0.0 < far < 0.02 * np.ptp(pair.source, axis=0).max()

    def test_e_f_would_rather_have_the_fish_that_shrinks(self, plate):
        # By one measure, the way that follows the curves costs more than the one that E^F finds.
        mine, other = plate("B6.5").numbers, plate("B6.7").numbers
        assert np.array_equal(mine["least_det_unseen"], other["least_det"])
        assert np.array_equal(mine["least_det"], other["least_det_unseen"])
        ways = [
            MORPH.way(
                shapes.fish(),
                MORPH.Choice(energy, "logexp", "consistent", "loci", 0.0, 0, -1, 0.5, "area"),
            )
            for energy in ("frobenius", "similarity")
        ]
        costs = [way.error(similar=False) for way in ways]
        assert costs[0] == pytest.approx(mine["energy"], abs=1e-12)
        assert (costs[0][1:-1] < costs[1][1:-1]).all()
        assert ways[1].error(similar=True) == pytest.approx(other["energy"], abs=1e-12)

    def test_a_balance_keeps_more_of_the_area(self, plate):
        shown = plate("G6.3").numbers
        assert shown["area"].min() > shown["area_beside"].min() + 0.1

    def test_the_symmetrised_error_is_symmetric(self, plate):
        shown = plate("G6.4").numbers
        assert np.abs(shown["vertices_beside"] - shown["back_beside"]).max() < 1e-10
        assert shown["asymmetry_beside"].max() < 1e-10 and shown["asymmetry"].max() > 0.02
        far = np.linalg.norm(shown["vertices"] - shown["back"], axis=-1).max()
        size = np.ptp(SWALLOW.snake().source, axis=0).max()
        assert far / size == pytest.approx(shown["asymmetry"][HALF])

    def test_the_somersault(self, plate):
        shown, pair = plate("G6.5").numbers, shapes.cat()
        assert shown["flipped"].max() == 0
        a, b = pair.marks["inner fore"], pair.marks["inner hind"]
        chord = (shown["vertices"][:, a] - shown["vertices"][:, b]) @ (1.0, 1.0j)
        turn = np.angle(chord[1:] / chord[:-1]).sum()
        assert turn == pytest.approx(np.angle(chord[-1] / chord[0]) - 2.0 * np.pi)

    def test_only_the_direction_of_an_edge(self, plate):
        shown, pair = plate("G6.5").numbers, shapes.cat()
        a, b = pair.marks["inner fore"], pair.marks["inner hind"]
        V = shown["vertices_beside"]
        first, *_, last = chord = (V[:, a] - V[:, b]) @ (1.0, 1.0j)
        t = shown["times"]
        angle = np.angle(first) + t * np.angle(last / first) + np.deg2rad(40.0) * np.sin(np.pi * t)
        assert np.abs((chord * np.exp(-1j * angle)).imag).max() < 1e-12
        assert shown["flipped_beside"].max() == 0
        # Its length is not that between both ends' lengths.
        assert np.abs(chord[2]) < 0.9 * min(np.abs(first), np.abs(last))
        assert V[[0, -1]] == pytest.approx(np.stack([pair.source, pair.target]), abs=1e-9)


class TestMeshes:
    @pytest.mark.parametrize("stage", ["global", "morph", "frames"])
    @pytest.mark.parametrize("t", [0.0, 0.3, 1.0])
    def test_it_is_that_of_the_moment(self, stage, t):
        drawing, pair = GLOBAL.draw(stage=stage, example="fish", t=t), shapes.fish()
        V = drawing.mesh.vertices
        assert np.array_equal(drawing.mesh.faces, pair.faces) and not V[:, 2].any()
        shown = drawing.numbers["vertices"]
        assert np.array_equal(V[:, :2], shown[2] if stage == "frames" else shown)
        for end, there in ((0.0, pair.source), (1.0, pair.target)):
            assert t != end or V[:, :2] == pytest.approx(there, abs=1e-9)

    def test_of_three_rows_the_one_asked_for(self):
        drawing = GLOBAL.draw(**GLOBAL.plate_params("B6.8"))
        assert np.array_equal(drawing.mesh.vertices[:, :2], drawing.numbers["vertices"][2])

    def test_torn_apart_triangles_have_corners_of_their_own(self, plate):
        mesh = GLOBAL.draw(stage="local").mesh
        assert np.array_equal(mesh.vertices[mesh.faces][..., :2], plate("B6.3").numbers["corners"])

    def test_two_shapes_are_not_one_moment(self):
        assert GLOBAL.draw(stage="ends").mesh is None and GLOBAL.draw(stage="maps").mesh is None


class TestFiles:
    def test_two_outlines(self, tmp_path):
        for name, d in (("a", "M0 0 H40 V10 H0 Z"), ("b", "M0 0 H10 V40 H0 Z")):
            file = tmp_path / f"{name}.svg"
            file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{d}"/></svg>')
        params = {"source": tmp_path / "a.svg", "target": tmp_path / "b.svg", "stage": "frames"}
        shown = GLOBAL.draw(**params).numbers
        assert shown["flipped"].max() == 0

    def test_two_drawings_of_which_one_is_turned(self):
        files = {"source": DATA / "fish.svg", "target": DATA / "bird.svg"}
        shown = GLOBAL.draw(stage="frames", **files).numbers
        # Fin and wing, and both tails, belong together although the bird is drawn rising.
        assert shown["flipped"].max() == 0 and shown["least_det"].min() > 0.3
        assert shown["energy"].max() < 1e-3

    def test_a_film_of_them_by_the_command(self, tmp_path):
        call = [
            "global-interp",
            str(DATA / "fish.svg"),
            str(DATA / "bird.svg"),
            "--draft",
            "--size",
            "160x120",
        ]
        result = CliRunner().invoke(
            command, [*call, "--fps", "4", "--seconds", "1", "-o", str(tmp_path / "m.gif")]
        )
        assert (result.exit_code, result.stdout) == (0, f"{tmp_path / 'm.gif'}\n")
        with Image.open(tmp_path / "m.gif") as film:
            frames = [np.asarray(frame.convert("RGB"), float) for frame in ImageSequence.Iterator(film)]
        assert len(frames) == 4 and np.abs(frames[2] - frames[0]).max() > 100.0

    def test_two_meshes(self, tmp_path):
        pair = shapes.fish()
        for name, V in (("a", pair.source), ("b", pair.target)):
            (tmp_path / f"{name}.obj").write_bytes(io.obj(V, pair.faces))
        shown = GLOBAL.draw(stage="global", source=tmp_path / "a.obj", target=tmp_path / "b.obj").numbers
        assert len(shown["det"]) == len(pair.faces) and shown["det"].min() > 0.5

    def test_one_is_not_enough(self, tmp_path):
        file = tmp_path / "a.svg"
        file.write_text("<svg/>")
        with pytest.raises(ValueError, match="given together; got only a source"):
            GLOBAL.draw(source=file)


class TestOtherForms:
    FROBENIUS: ClassVar = {
        "matrix": lambda *given: forms.matrix(*given),
        "pull": lambda *given: forms.pull(*given),
    }
    SIMILARITY: ClassVar = {"similarity": lambda *given: forms.similarity(*given)}

    @pytest.mark.parametrize(
        ("plate_id", "given"), [("B6.4", FROBENIUS), ("B6.7", SIMILARITY)], ids=["B6.4", "B6.7"]
    )
    def test_right_ones_find_the_shape_of_the_library(self, plate_id, given, plate):
        found = GLOBAL.draw_with(given, **GLOBAL.plate_params(plate_id)).numbers
        wanted = plate(plate_id).numbers
        for name in ("vertices", "least_det", "area"):
            assert np.abs(found[name] - wanted[name]).max() < 1e-8, name

    def test_wrong_ones_find_another(self, plate):
        half = {**self.FROBENIUS, "pull": lambda *given: 0.5 * forms.pull(*given)}
        found = GLOBAL.draw_with(half, **GLOBAL.plate_params("B6.4")).numbers
        # About its barycentre the shape is half as large.
        shapes_of = [x - x.mean(axis=0) for x in (found["vertices"], plate("B6.4").numbers["vertices"])]
        assert np.abs(shapes_of[0] - 0.5 * shapes_of[1]).max() < 1e-9

    def test_what_holds_nothing_together_is_refused(self):
        none = {"similarity": lambda p, A: np.zeros((*A.shape[:-2], 6, 6))}
        with pytest.raises(ValueError, match="a form that holds the shape together"):
            GLOBAL.draw_with(none, **GLOBAL.plate_params("B6.7"))
        far = {**self.FROBENIUS, "matrix": lambda *given: 1e-4 * forms.matrix(*given)}
        with pytest.raises(ValueError, match="over 100 times as large"):
            GLOBAL.draw_with(far, **GLOBAL.plate_params("B6.4"))
