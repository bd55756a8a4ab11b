"""What `blend` shows: a thorn by three ways, mixtures of animals, a controller, a user's files."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.linalg import expm, logm
from scipy.spatial import KDTree

from lietool import figure, paths
from lietool.cli import command
from lietool.deform import controller, ways
from lietool.lie import polar, so3
from lietool.mesh import solids, surface, surface_io
from lietool.render.scene import Surface

WAYS = list(ways.WAYS)


def load():
    return figure.load("blend", (paths.FIGURES,))


def draw(plate="K3a", **params):
    return load().draw(**load().plate_params(plate) | params)


def ball():
    return solids.thorn_ball(solids.DRAFT)


def leans(numbers):
    return dict(zip(numbers["blended"], np.asarray(numbers["lean"]), strict=True))


class TestThorn:
    def test_with_normals_it_leans_slants_and_folds(self, plate):
        lean = leans(plate("K3a").numbers)
        assert 10.0 < lean["phi_so"] < 20.0 < 30.0 < lean["alexa"] < 35.0
        assert lean["polar_quaternion"] > 150.0

    def test_the_numbers_of_the_captions(self, plate):
        said = load().plates["K3a"].caption
        for way, lean in list(leans(plate("K3a").numbers).items())[:2]:
            assert f" {lean:.0f}" in said, way
        assert f"{leans(plate('K3a2').numbers)['alexa']:.0f} degrees" in load().plates["K3a2"].caption

    def test_the_lean_is_that_of_the_tip(self):
        drawing, solid = draw(), ball()
        X, V = drawing.mesh.vertices, solid.vertices
        ring = solid.of("thorn") & (V[:, 2] > 2.0) & (V[:, 2] < 2.12)
        tip = solid.of("thorn") & (V[:, 2] > 2.45)
        axis = X[tip].mean(axis=0) - X[ring].mean(axis=0)
        assert np.degrees(np.arccos(axis[2] / np.linalg.norm(axis))) == pytest.approx(
            leans(drawing.numbers)["phi_so"], abs=3.0
        )

    def test_with_stated_maps_only_the_logarithm_leans(self, plate):
        lean = leans(plate("K3a2").numbers)
        assert lean["phi_so"] < 0.1 and lean["polar_quaternion"] < 0.1
        # Above where the thorn follows wholly its map is one, and so is its blend.
        D, Y = np.diag([0.2, 0.2, 0.0]), np.zeros((3, 3))
        Y[0, 2] = Y[2, 0] = 0.3
        maps = [so3.rotation("z", s * np.radians(134.0)) @ expm(s * Y + D) for s in (1.0, -1.0)]
        A = expm(sum(0.8 * logm(A).real for A in maps))
        assert lean["alexa"] == pytest.approx(
            np.degrees(np.arccos(A[2, 2] / np.linalg.norm(A[:, 2]))), abs=1.0
        )

    def test_what_normals_add_is_a_turn_about_other_axes(self):
        from lietool.figures.papers import _blend_family as families

        tilts = []
        for stated in (False, True):
            thorn = families.Thorn(134.0, 0.3, (0.2, 0.2, 0.0), stated)
            prepared = families.family("thorn", thorn, solids.DRAFT, None, (), "z").prepared("phi_so")
            x = np.array([so3.log(polar.rotation(A)) for A in prepared.maps])
            tilts.append(np.abs(x[..., :2]).max())
        assert tilts[0] > 0.3 and tilts[1] < 5e-3

    @pytest.mark.parametrize("way", WAYS)
    @pytest.mark.parametrize("k", [0, 1])
    def test_a_weight_of_one_gives_the_target(self, way, k):
        drawing = draw(way=way, weights=tuple(np.eye(2)[k]))
        assert drawing.mesh.vertices == pytest.approx(solids.thorn_targets(ball())[k], abs=1e-9)
        assert drawing.numbers["ways"][0] == way and len(set(drawing.numbers["ways"])) == 3

    def test_faces_without_a_logarithm_are_counted_and_hatched(self, plate):
        assert list(plate("K3a").numbers["lacking"]) == [0, 0, 0]
        flat = draw(angle=180.0)
        ours, alexa, quaternion = flat.numbers["lacking"]
        assert alexa > 100 and ours == quaternion == 0
        assert "have no logarithm" in draw(angle=180.0, way="alexa").notes[0]

    def test_quaternions_that_cancel_are_shown(self):
        drawing = draw("K3a2", angle=180.0, weights=(0.5,))
        assert "phi_so" in drawing.numbers["blended"]
        assert "polar_quaternion" not in drawing.numbers["blended"]
        with pytest.raises(ValueError, match="polar_quaternion has a blend; got quaternions that cancel"):
            draw("K3a2", angle=180.0, weights=(0.5,), way="polar_quaternion")


class TestPopulation:
    def test_weights_are_mixtures(self, plate):
        w = plate("K3b").numbers["weights"]
        assert w.shape == (12, 3) and (w >= 0.0).all()
        assert w.sum(axis=1) == pytest.approx(1.0)
        assert w == pytest.approx(np.random.default_rng(920).dirichlet([0.7] * 3, 12))

    def test_none_is_torn_or_turned_over(self, plate):
        numbers = plate("K3b").numbers
        assert not np.any(numbers["flipped"]) and not np.any(numbers["lacking"])
        sizes = np.ptp(numbers["bounds"], axis=1)
        beast = solids.animals(solids.DRAFT)
        all_ = np.array([np.ptp(beast.targets[name], axis=0) for name in ("tall", "fat", "long")])
        # Mixtures are no larger than the largest, nor smaller than the smallest.
        assert (sizes > 0.9 * all_.min(axis=0)).all() and (sizes < 1.05 * all_.max(axis=0)).all()

    def test_the_moment_of_a_film_scales_the_weights(self):
        half = draw("K3b", phase=90.0).numbers["weights"]
        assert half == pytest.approx(0.5 * np.asarray(draw("K3b").numbers["weights"]))


class TestController:
    def test_the_weights_lead_back_to_the_position(self, plate):
        numbers = plate("M4").numbers
        w = np.append(1.0 - numbers["weights"].sum(), numbers["weights"])
        assert w @ controller.regular(4) == pytest.approx(numbers["position"], abs=1e-9)
        assert (w > 0.0).all()

    @pytest.mark.equation("M 5")
    def test_a_corner_is_a_target_and_beyond_it_is_more(self, plate):
        numbers = plate("M5").numbers
        half, corner, beyond = numbers["weights"]
        assert corner == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
        assert list(numbers["distance"][1] == 0.0) == [False, False, True]
        assert (half > 0.0).all() and beyond.min() < 0.0 and beyond.max() > 1.0
        # The long one, longer.
        length = np.ptp(numbers["bounds"], axis=1)[:, 0]
        assert length[0] < length[1] < length[2]

    @pytest.mark.parametrize("way", WAYS)
    def test_every_way_meets_the_target_at_its_corner(self, way):
        drawing = draw("M4", way=way, reach=1.0, phase=0.0)
        target = solids.animals(solids.FINE).targets["long"]
        assert drawing.mesh.vertices == pytest.approx(target, abs=1e-8)

    def test_the_path_is_closed(self):
        first, last = (draw("M4", phase=phase) for phase in (0.0, 360.0))
        assert first.mesh.vertices == pytest.approx(last.mesh.vertices, abs=1e-9)


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a ball, two others with its faces, and files that do not go with it."""
    monkeypatch.chdir(tmp_path)
    beast = solids.animals(0.15)
    V, F = np.array(beast.vertices), np.array(beast.faces)
    write("rest.obj", V, F)
    write("tall.obj", beast.targets["tall"], F)
    write("fat.obj", beast.targets["fat"], F)
    write("fewer.obj", V, F[:-2])
    write("order.obj", V, F[::-1])
    turned = F.copy()
    turned[7] = F[7][[0, 2, 1]]
    write("turned.obj", V, turned)
    flat = V.copy()
    flat[F[5, 0]] = flat[F[5, 1]]
    write("flat.obj", flat, F)
    write("points.obj", np.concatenate([V, V[:1]]), F)
    lines = (tmp_path / "rest.obj").read_text().splitlines()
    at = [k for k, line in enumerate(lines) if line.startswith("v ")][3]
    (tmp_path / "nan.obj").write_text("\n".join([*lines[:at], "v nan 0 0", *lines[at + 1 :]]))
    return tmp_path


def write(name: str, V: np.ndarray, F: np.ndarray, **more: object) -> None:
    mesh = surface.Mesh(np.asarray(V), F, **more)  # type: ignore[arg-type]
    Path(name).write_bytes(surface_io.encode(mesh, Path(name).suffix))


def surfaces(rest: str, *targets: str, view: str = "ways") -> list[Surface]:
    """What is drawn of a user's files, with the rest as the blended shape."""
    files = {"rest": Path(rest), "targets": tuple(map(Path, targets))}
    views = load().draw(**files, view=view, weights=(0.0,)).picture.views
    return [r for one in views for r in one.records if isinstance(r, Surface)]


def colours_at(drawn: Surface, V: np.ndarray) -> np.ndarray:
    """The levels of sRGB (n, 3) in which a surface is drawn at points, at each of which it has a vertex."""
    away, nearest = KDTree(drawn.vertices).query(V)
    assert away.max() < 1e-6
    rgba = np.asarray(drawn.color)[nearest]
    assert (rgba[:, 3] == 1.0).all()
    light = rgba[:, :3]
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)


def run(*words: str):
    result = CliRunner().invoke(command, ["blend", *words])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


class TestOwn:
    @pytest.mark.parametrize("way", WAYS)
    def test_the_blend_is_written_in_the_order_of_the_rest(self, work, way):
        rest, fat = surface_io.read("rest.obj"), surface_io.read("fat.obj")
        done = run("rest.obj", "tall.obj", "fat.obj", "--weights", "0,1", "--way", way, "-o", "out.ply")
        assert (done.exit_code, done.stdout, done.stderr) == (0, "out.ply\n", "")
        out = surface_io.read("out.ply")
        assert np.array_equal(out.faces, rest.faces)
        assert out.vertices == pytest.approx(fat.vertices, abs=1e-6)

    def test_any_number_of_targets_and_one_weight_for_all(self, work):
        assert (
            run("rest.obj", "tall.obj", "fat.obj", "tall.obj", "--weights", "0", "-o", "o.glb").exit_code == 0
        )
        assert surface_io.read("o.glb").vertices == pytest.approx(
            surface_io.read("rest.obj").vertices, abs=1e-6
        )

    def test_attributes_stay_and_seams_stay_closed(self, work):
        rest, tall = surface_io.read("rest.obj"), surface_io.read("tall.obj")
        # As a file for games has it: every corner a vertex.
        corners, F = rest.faces.ravel(), np.arange(rest.faces.size).reshape(-1, 3)
        red = np.linspace(0.0, 1.0, len(corners)).round(2)
        write("a.ply", rest.vertices[corners], F, attributes={"paint": red})
        write("b.ply", tall.vertices[corners], F)
        assert run("a.ply", "b.ply", "--weights", "0.5", "-o", "c.ply").exit_code == 0
        found = surface_io.read("c.ply")
        assert found.attributes["paint"] == pytest.approx(red, abs=1e-6)
        together = np.zeros((len(rest.vertices), 3))
        together[corners] = found.vertices
        assert found.vertices == pytest.approx(together[corners], abs=1e-12)

    @pytest.mark.parametrize("view", ["ways", "shape"])
    def test_its_own_colours_are_drawn(self, work, view):
        rest, tall = surface_io.read("rest.obj"), surface_io.read("tall.obj")
        # As a file for games has it, each corner a vertex, and not in the order in which they become one.
        corners, F = rest.faces.ravel(), np.arange(rest.faces.size).reshape(-1, 3)
        low, high = rest.vertices.min(axis=0), rest.vertices.max(axis=0)
        red = (rest.vertices - low) / (high - low)
        blue = 1.0 - 0.5 * red
        write("red.ply", rest.vertices[corners], F, colours=red[corners])
        write("tall.ply", tall.vertices[corners], F)
        write("blue.ply", tall.vertices[corners], F, colours=blue[corners])
        seen = surfaces("red.ply", "tall.ply", "blue.ply", view=view)
        painted = [one for one in seen if isinstance(one.color, np.ndarray)]
        if view == "shape":
            assert len(painted) == 1
        else:
            # The rest, what is blended by three ways, and of the targets that which has colours.
            assert len(painted) == 5
            assert colours_at(painted[1], tall.vertices) == pytest.approx(blue, abs=3e-3)
        assert colours_at(painted[0], rest.vertices) == pytest.approx(red, abs=3e-3)
        assert not any(isinstance(one.color, np.ndarray) for one in surfaces("rest.obj", "tall.obj"))

    def test_turned_faces_are_told_beside_the_file(self, work):
        done = run("rest.obj", "tall.obj", "fat.obj", "--weights", "3,-2", "-o", "o.obj")
        assert done.stdout == "o.obj\n" and done.stderr.endswith("faces are turned over\n")

    @pytest.mark.parametrize("view", ["ways", "population", "controller", "ray", "shape"])
    @pytest.mark.parametrize("up", ["y", "z"])
    def test_every_view_of_them(self, work, view, up):
        done = run("rest.obj", "tall.obj", "fat.obj", "--view", view, "--up", up, "--json")
        assert done.exit_code == 0, done.stderr
        assert json.loads(done.stdout)

    @pytest.mark.parametrize(
        ("words", "line"),
        [
            ("rest.obj", "rest and targets must be given together; got no target."),
            ("--targets tall.obj", "rest and targets must be given together; got no rest."),
            ("rest.obj fewer.obj", " faces of rest.obj; got "),
            ("rest.obj tall.obj order.obj", "got face 0 of order.obj with vertices "),
            ("rest.obj turned.obj", "got face 7 of turned.obj with vertices "),
            ("rest.obj points.obj", " vertices of rest.obj; got "),
            ("rest.obj tall.obj flat.obj", " of flat.obj. Move their corners apart"),
            ("flat.obj tall.obj", " of flat.obj. Move their corners apart"),
            (
                "rest.obj nan.obj",
                "nan.obj must be a mesh with positions of three finite numbers; got 'nan 0 0'",
            ),
            (
                "rest.obj tall.obj --weights 1,2,3",
                "weights must be one number, for there is 1 target; got 1,2,3.",
            ),
            (
                "rest.obj tall.obj fat.obj --weights 1,2,3",
                "must be one number, or 2, for there are 2 targets;",
            ),
            ("rest.obj tall.obj --example thorn", "--example has no part in the picture beside --rest. "),
            ("rest.obj tall.obj --angle 3", "--angle has no part in the picture beside --rest. "),
            ("rest.obj tall.obj --view controller", "a controller must have two targets or more; got 1."),
            ("rest.obj tall.obj --maps stated", "--maps has no part in the picture beside --rest."),
        ],
    )
    def test_a_mistake_is_one_line(self, work, words, line):
        done = run(*words.split(), "-o", "out.glb")
        assert (done.exit_code, done.stdout, done.stderr.count("\n")) == (2, "", 1), done.stderr
        assert done.stderr.startswith("lietool blend: ") and line in done.stderr
        assert not (work / "out.glb").exists()
