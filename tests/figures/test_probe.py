"""What the plates of the probe deformer claim, and what a user brings: against computations of our own."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool import figure, paths
from lietool.mesh import cloud_io, solids, surface_io
from lietool.render.scene import Surface

PROBE = figure.load("probe", (paths.FIGURES,))

TWO = """
[[probe]]
name = "root"
centre = [0, 0, 0]

[[probe]]
name = "tip"
centre = [0, 0, 2]
"""


def run(*words: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """The command itself, in a folder."""
    command = [sys.executable, "-m", "lietool", "probe", *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)


@pytest.fixture
def bar(tmp_path: Path) -> Path:
    """A coarse square bar with colours and a further number, from z = 0 to 2."""
    z, side = np.linspace(0.0, 2.0, 9), 0.2 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    V = np.array([[x, y, h] for h in z for x, y in side])
    k = np.arange(8)[:, None] * 4 + np.arange(4)
    nxt = np.arange(8)[:, None] * 4 + (np.arange(4) + 1) % 4
    a, b, c, d = k.ravel(), nxt.ravel(), (nxt + 4).ravel(), (k + 4).ravel()
    F = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    from lietool.mesh.surface import Mesh

    mesh = Mesh(V, F, colours=np.full((len(V), 3), 0.2), attributes={"heat": np.arange(len(V)) + 0.5})
    path = tmp_path / "bar.ply"
    path.write_bytes(surface_io.encode(mesh, ".ply"))
    (tmp_path / "two.toml").write_text(TWO)
    return path


class TestPlates:
    def test_the_duck_follows_its_probes(self, plate):
        shown = plate("B7.3").numbers
        mesh = PROBE.draw().mesh
        rest, now = shown["rest"], shown["frames"]
        V = solids.duck().vertices
        r = np.linalg.norm(V[:, None] - rest[:, :3, 3], axis=2)
        # Nearly all weight is that of the probe which is much nearer than the others.
        nearest = np.argmin(np.sort(r, axis=1)[:, 0] / np.sort(r, axis=1)[:, 1])
        i = int(np.argmin(r[nearest]))
        A = now[i] @ np.linalg.inv(rest[i])
        assert np.linalg.norm(mesh.vertices[nearest] - (A[:3, :3] @ V[nearest] + A[:3, 3])) < 0.1
        assert np.allclose(np.linalg.norm(shown["rotation_vectors_degrees"], axis=1), [0, 70, 40, 0])
        assert np.allclose(np.linalg.norm(now[1][:3, :3], axis=0), 1.2)

    def test_the_bar_keeps_its_volume_better_than_linearly(self, plate):
        volume = plate("B7.2").numbers["volume"]
        assert np.allclose(volume[:, 0], 1.0)
        assert round(100.0 * volume[0, -1]) == 89 and round(100.0 * volume[1, -1]) == 52
        assert (volume[0, 1:] > volume[1, 1:]).all()

    def test_the_bar_is_bent_to_an_arc_of_equal_length(self, plate):
        shown = plate("B7.2").numbers
        chord = np.linalg.norm(shown["frames"][1][:3, 3] - shown["frames"][0][:3, 3])
        length, angle = 2.4, np.radians(120.0)
        assert np.isclose(chord, 2.0 * length / angle * np.sin(angle / 2.0))
        assert abs(shown["leaning_degrees"][0, -1] - 120.0) < 10.0

    def test_strings_wind_beyond_a_turn_and_quaternions_do_not(self, plate):
        shown = plate("K2a").numbers
        assert np.isclose(np.linalg.norm(shown["rotation_vectors_degrees"][1]), 480.0)
        # The ends of the strings are not quite at the probes, whose weights are not quite 0 and 1 there.
        assert round(shown["winding_degrees"][3]) == 441 and round(shown["winding_degrees"][4]) == 111
        steps = np.diff(shown["winding_degrees"][:4])
        assert np.allclose(steps, steps[0], rtol=0.02)

    def test_the_arm_turns_by_all_degrees_and_by_quaternions_by_thirty(self, plate):
        shown = plate("K2b").numbers
        assert np.isclose(np.linalg.norm(shown["rotation_vectors_degrees"][0]), 390.0)
        ours, theirs = shown["twist_degrees_phi_so"], shown["twist_degrees_polar_quaternion"]
        assert abs(ours[-1] - 390.0) < 1.5 and abs(theirs[-1] - 30.0) < 1.5
        assert abs(ours[0]) < 1.0 and (np.diff(ours) > -0.5).all()

    def test_the_arm_by_another_library(self, plate):
        shown = plate("K2b").numbers
        s = solids.octopus()
        a = np.clip((s.along - 0.05) / 0.9, 0.0, 1.0)
        w = np.where(s.of("arm 0"), a * a * (3.0 - 2.0 * a), 0.0)
        c, x = shown["rest"][0][:3, 3], np.radians(shown["rotation_vectors_degrees"][0])
        moved = c + Rotation.from_rotvec(w[:, None] * x).apply(s.vertices - c)
        drawn = PROBE.draw(**PROBE.plate_params("K2b")).mesh.vertices
        assert np.allclose(drawn, moved, atol=1e-12)

    def test_the_middle_of_the_vortex_turns_most(self):
        mesh = PROBE.draw(example="vortex").mesh
        from lietool.mesh import particles

        P = particles.disc(18000, 12).points
        c, t = np.array([[0, 0, 0.25], [0, 0, -0.25]]), np.array([[0, 0, -0.9], [0, 0.2, -1.3]])
        x = np.radians(450.0) * np.array([[0.0, 0.0, 1.0], np.array([0.0, 0.2, 1.0]) / np.sqrt(1.04)])
        w = np.clip(1.0 - np.linalg.norm(P[:, None] - c, axis=2) / 1.05, 0.0, None) ** 2.5
        total = w.sum(axis=1, keepdims=True)
        about = w @ c / np.where(total > 0.0, total, 1.0)
        w /= np.maximum(1.0, total)
        moved = about + w @ t + Rotation.from_rotvec(w @ x).apply(P - about)
        assert np.allclose(mesh.vertices, moved, atol=1e-12)
        r, turned = np.linalg.norm(P[:, :2], axis=1), np.linalg.norm(w @ x, axis=1)
        assert turned[r < 0.05].min() > 2.0 * np.pi and turned[r > 0.99].max() < 0.1

    def test_the_vortex_has_probes_of_more_than_a_turn(self, plate):
        turned = np.linalg.norm(plate("B7.4").numbers["rotation_vectors_degrees"], axis=1)
        assert len(turned) == 2 and np.allclose(turned, 450.0)


class TestWays:
    @pytest.mark.parametrize(
        "way", ["phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"]
    )
    def test_nothing_moves_at_first(self, way):
        for example in ("duck", "cactus", "vortex"):
            drawing = PROBE.draw(example=example, way=way, t=0.0)
            assert drawing.numbers["moved_at_most"] < 1e-12

    def test_a_full_turn_more_is_nothing_to_matrices(self):
        found = {
            way: [
                PROBE.draw(example="particles", way=way, turn=turn, weights="auto").mesh.vertices
                for turn in (0.0, 360.0)
            ]
            for way in ("alexa", "linear", "phi-so")
        }
        assert np.allclose(*found["alexa"]) and np.allclose(*found["linear"])
        assert np.abs(found["phi-so"][1] - found["phi-so"][0]).max() > 0.5

    def test_the_origin_of_the_world_counts_only_where_it_is_asked_for(self, bar):
        far = bar.with_name("far.ply")
        mesh = surface_io.read(bar)
        far.write_bytes(surface_io.encode(mesh.moved(mesh.vertices + np.array([5.0, 0.0, 0.0])), ".ply"))
        words = "name=a centre={x},0,0;name=b centre={x},0,2 axis=0,1,0 degrees=80"
        for origin, equal in (("centre", True), ("world", False)):
            moved = [
                PROBE.draw(shape=path, probe=words.format(x=x), origin=origin).mesh.vertices - (x, 0.0, 0.0)
                for path, x in ((bar, 0), (far, 5))
            ]
            assert np.allclose(*moved) == equal


class TestOwn:
    def test_order_and_numbers_are_kept(self, bar):
        tip = "name=root centre=0,0,0;name=tip centre=0,0,2 axis=0,0,1 degrees=400 translation=0,0,1"
        done = run("bar.ply", "--probe", tip, "-o", "out.ply", folder=bar.parent)
        assert done.returncode == 0, done.stderr
        before, after = surface_io.read(bar), surface_io.read(bar.with_name("out.ply"))
        assert np.array_equal(before.faces, after.faces)
        assert np.array_equal(before.attributes["heat"], after.attributes["heat"])
        assert before.colours is not None and after.colours is not None
        assert np.array_equal(before.colours, after.colours)
        assert np.isclose(after.vertices[:, 2].max(), 3.0, atol=0.1)

    @pytest.mark.parametrize("ending", [".obj", ".off", ".stl", ".glb"])
    def test_every_format(self, bar, ending):
        source = bar.with_suffix(ending)
        source.write_bytes(surface_io.encode(surface_io.read(bar), ending))
        done = run(source.name, "-o", f"out{ending}", folder=bar.parent)
        assert done.returncode == 0, done.stderr
        assert len(surface_io.read(bar.with_name(f"out{ending}")).faces) == 64

    def test_its_own_colours_are_drawn(self, bar):
        light = ((0.2 + 0.055) / 1.055) ** 2.4
        drawn = [
            r.color
            for view in PROBE.draw(shape=bar).picture.views
            for r in view.records
            if isinstance(r, Surface) and isinstance(r.color, np.ndarray)
        ]
        assert len(drawn) == 2
        for colors in drawn:
            assert colors[:, :3] == pytest.approx(light, abs=1e-3) and (colors[:, 3] == 1.0).all()

    def test_a_cloud(self, tmp_path):
        points = np.random.default_rng(2).normal(size=(200, 3)) * (1.0, 0.5, 0.2)
        text = "\n".join(" ".join(map(repr, p)) for p in points.tolist())
        (tmp_path / "c.xyz").write_text(f"200\n{text}\n")
        probe = "name=a centre=0,0,0 axis=0,0,1 degrees=90"
        done = run("c.xyz", "--probe", probe, "-o", "c.ply", folder=tmp_path)
        assert done.returncode == 0, done.stderr
        found = cloud_io.read(tmp_path / "c.ply").vertices
        assert np.allclose(found, points @ Rotation.from_rotvec((0.0, 0.0, np.pi / 2.0)).as_matrix().T)
        done = run("c.xyz", "-o", "c.glb", folder=tmp_path)
        assert done.returncode == 2 and "points alone" in done.stderr

    def test_a_sequence_is_followed_pose_by_pose(self, bar):
        poses = [f"[[pose]]\ntip = {{ axis = [0, 0, 1], degrees = {d} }}\n" for d in (0, 80, 400)]
        turned = "[[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
        half = "[[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
        poses += [f"[[pose]]\ntip = {{ matrix = {m} }}\n" for m in (turned, half)]
        bar.with_name("anim.toml").write_text("fps = 5\n" + "".join(poses))
        words = ("bar.ply", "--probes", "two.toml", "--poses", "anim.toml")
        done = run(*words, "-o", "f%d.obj", folder=bar.parent)
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""
        files = sorted(bar.parent.glob("f*.obj"))
        assert [file.name for file in files] == [f"f{k}.obj" for k in range(5)]
        top = [surface_io.read(file).vertices[-4, :2] @ (1.0, 1.0j) for file in files]
        angle = np.degrees(np.angle(np.array(top) / top[0]))
        weight = (1.0 / 0.08) / (1.0 / 0.08 + 1.0 / 4.08)
        difference = angle - weight * np.array([0.0, 80.0, 400.0, 450.0, 540.0])
        assert np.allclose(difference, 360.0 * np.rint(difference / 360.0), atol=1e-6)
        track = [
            PROBE.draw(shape=bar, probes=bar.with_name("two.toml"), poses=bar.with_name("anim.toml"), t=t)
            for t in (0.5, 0.75, 1.0)
        ]
        degrees = [drawing.numbers["rotation_vectors_degrees"][1, 2] for drawing in track]
        assert np.allclose(degrees, [400.0, 450.0, 540.0])
        done = run(*words, "-o", "f.gif", "--size", "80x60", folder=bar.parent)
        assert done.returncode == 0, done.stderr
        from PIL import Image

        with Image.open(bar.with_name("f.gif")) as film:
            assert getattr(film, "n_frames", 1) == 5 and film.info["duration"] == 200

    def test_long_steps_are_told(self, bar):
        around = "[[{c}, -{s}, 0, 0], [{s}, {c}, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
        c, s = np.cos(np.radians(120.0)), np.sin(np.radians(120.0))
        rows = [
            f"[[pose]]\ntip = {{ matrix = {around.format(c=a, s=b)} }}\n" for a, b in ((1.0, 0.0), (c, s))
        ]
        bar.with_name("anim.toml").write_text("".join(rows))
        done = run(
            "bar.ply", "--probes", "two.toml", "--poses", "anim.toml", "-o", "f.obj", folder=bar.parent
        )
        assert done.returncode == 0
        assert done.stderr.count("\n") == 1 and "pose 2: probe tip turns by 120 degrees" in done.stderr

    def test_painted_weights(self, bar):
        mesh = surface_io.read(bar)
        w = (mesh.vertices[:, 2] / 2.0) ** 2
        bar.with_name("w.csv").write_text("\n".join(f"{1.0 - x!r}, {x!r}" for x in w.tolist()))
        words = "name=a centre=0,0,0;name=b centre=0,0,0 translation=1,0,0"
        moved = PROBE.draw(shape=bar, probe=words, paint=bar.with_name("w.csv")).mesh.vertices
        assert np.allclose(moved - mesh.vertices, w[:, None] * (1.0, 0.0, 0.0))

    def test_along_the_surface(self, bar):
        words = "name=a centre=0,0,0;name=b centre=0,0,2 translation=0,0,1"
        for distance in ("straight", "surface"):
            drawing = PROBE.draw(
                shape=bar, probe=words, weights="inverse-distance", power=3.0, distance=distance
            )
            assert drawing.mesh.vertices[:, 2].max() > 2.9


MISTAKES = {
    "no such file": (("none.ply",), "SHAPE must be a file that exists"),
    "a reflection": (("bar.ply", "--probes", "mirror.toml"), "probe glass must have a motion with det > 0"),
    "a flat motion": (("bar.ply", "--probes", "flat.toml"), "probe flat must have a motion with det > 0"),
    "turns about another axis": (("bar.ply", "--probes", "astray.toml"), "probe tip: turns.wound"),
    "both": (("bar.ply", "--probes", "two.toml", "--probe", "centre=0,0,0"), "must not be given together"),
    "a turn of one's own": (("bar.ply", "--probes", "two.toml", "--turn", "3"), "turn must be 0"),
    "an unknown key": (("bar.ply", "--probe", "center=0,0,0"), "must be key=value"),
    "no axis": (("bar.ply", "--probe", "centre=0,0,0 degrees=3"), "axis must be given"),
    "weights of nothing": (
        ("bar.ply", "--weights", "cutoff", "--reach", "0.02", "--sum", "unity"),
        "sum must be capped where weights are all 0",
    ),
    "weights painted and made": (("bar.ply", "--weights", "gaussian", "--paint", "w.csv"), "must be auto"),
    "too few weights": (("bar.ply", "--paint", "w.csv"), "got 3"),
    "weights of too few columns": (("bar.ply", "--paint", "one.csv"), "must be weights of 2 probes"),
    "another probe's pose": (("bar.ply", "--probes", "two.toml", "--poses", "tail.toml"), "the key 'tail'"),
    "a cloud without a surface": (
        ("c.xyz", "--weights", "gaussian", "--distance", "surface"),
        "distance must be straight for a cloud",
    ),
    "a cloud of words": (("w.xyz",), "must be a cloud of points; got none"),
    "a cloud of pairs": (("pairs.xyz",), "must be lines of three numbers; got 2 in line 2"),
    "an example beside one's own": (
        ("bar.ply", "--example", "duck"),
        "--example has no part in the picture beside --shape. Leave out one of them",
    ),
    "stages of one's own": (
        ("--example", "bend", "--probes", "two.toml", "--steps", "3"),
        "--steps has no part in the picture beside --probes",
    ),
    "no probe in words": (("bar.ply", "--probe", ";"), "probe must be one probe or more in words; got ';'"),
    "a probe far off": (
        ("bar.ply", "--probe", "name=sun centre=1e20,0,0 axis=0,0,1 degrees=9"),
        "probe sun must be within 1e+06 times the shape's size",
    ),
    "a pose far off": (("bar.ply", "--probes", "two.toml", "--poses", "away.toml"), "must be within 1e+06"),
    "a probe that bursts": (
        ("bar.ply", "--probe", "name=sun centre=0,0,0 scale=1e99"),
        "probe sun must stretch by at most 1e+06; got 1e+99",
    ),
    "too many poses": (
        ("bar.ply", "--probe", "name=tip centre=0,0,0", "--poses", "long.toml"),
        "poses must be at most 3600 poses; got 3601 in long.toml. Leave some out",
    ),
    "a film of one pose": (
        ("bar.ply", "--probe", "name=tip centre=0,0,0", "--poses", "still.toml", "-o", "out.gif"),
        "a film must have 2 to 3600 pictures; got a sequence of 1. Add another, or write a .png",
    ),
    "a dust": (("dust.xyz",), "must have an extent above 1e-70; got "),
    "faces without area": (
        ("flat.off", "--weights", "gaussian", "--distance", "surface"),
        "distance must be straight where faces have no area; got surface, with none in face 1. ",
    ),
    "a cloud at one place": (("one.xyz",), "must have an extent"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_are_one_line(mistake, bar):
    matrix = "[[probe]]\nname = {name!r}\ncentre = [0, 0, 2]\ncurrent = {{ matrix = {rows}{more} }}\n"
    mirror = "[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
    turned = "[[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
    files = {
        "mirror.toml": matrix.format(name="glass", rows=mirror, more=""),
        "flat.toml": matrix.format(name="flat", rows=mirror.replace("-1", "0"), more=""),
        "astray.toml": matrix.format(name="tip", rows=turned, more=", axis = [1, 0, 0], turns = 1"),
        "w.csv": "1,0\n0,1\n1,1\n",
        "one.csv": "1\n" * 36,
        "tail.toml": "[[pose]]\ntail = { axis = [0, 0, 1], degrees = 3 }\n",
        "c.xyz": "0 0 0\n1 0 0\n0 1 0\n",
        "w.xyz": "some words\n",
        "pairs.xyz": "0 0 0\n1 2\n",
        "one.xyz": "1 1 1\n1 1 1\n",
        "dust.xyz": "1e-300 0 0\n0 0 0\n",
        "flat.off": "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n3 0 1 2\n3 0 1 3\n",
        "away.toml": "[[pose]]\ntip = { translation = [0, 0, 1e30] }\n",
        "still.toml": "[[pose]]\n",
        "long.toml": "[[pose]]\n" * 3601,
    }
    for name, text in files.items():
        bar.with_name(name).write_text(text)
    words, message = MISTAKES[mistake]
    done = run(*(words if "-o" in words else (*words, "-o", "out.png")), folder=bar.parent)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert message in done.stderr
    assert not list(bar.parent.glob("out.*"))


def test_the_linear_way_takes_reflections(bar):
    mirror = "[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]"
    text = f"[[probe]]\ncentre = [0, 0, 2]\ncurrent = {{ matrix = {mirror} }}\n"
    bar.with_name("mirror.toml").write_text(text)
    before = surface_io.read(bar).vertices
    for t, x in ((0.0, 1.0), (0.5, 0.0), (1.0, -1.0)):
        moved = PROBE.draw(shape=bar, probes=bar.with_name("mirror.toml"), way="linear", t=t).mesh.vertices
        assert np.allclose(moved, before * (x, 1.0, 1.0), atol=1e-12)
