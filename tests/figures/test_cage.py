"""What the plates of cages claim, and what a user brings: against computations of our own."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from lietool import figure, paths
from lietool.cli import command
from lietool.mesh import solids, surface_io, topology
from lietool.mesh.surface import Mesh

CAGE = figure.load("cage", (paths.FIGURES,))


def by_hand(V, F, k):
    """The tetrahedron of a face, (4, 3), as the text has it."""
    p = V[F[k]]
    n = np.cross(p[1] - p[0], p[2] - p[0])
    return np.vstack([p, p[0] + n / np.sqrt(np.linalg.norm(n))])


def affine(P, Q):
    """The affine map that takes four points to four points."""
    one = np.ones((1, 4))
    return np.vstack([Q.T, one]) @ np.linalg.inv(np.vstack([P.T, one]))


def rotated(V, angle=0.7, axis=1):
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(3)
    i, j = [k for k in range(3) if k != axis]
    R[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    return V @ R.T


def run(*words: object) -> Result:
    return CliRunner().invoke(command, ["cage", *map(str, words)])


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A coarse bar with colours and numbers, its cage, and that turned and grown by a similarity."""
    solid = solids.bar(0.15)
    n = len(solid.vertices)
    colours = np.linspace(0.0, 1.0, 3 * n).reshape(n, 3).round(2)
    mesh = Mesh(solid.vertices, solid.faces, colours=colours, attributes={"heat": np.arange(n) + 0.5})
    (tmp_path / "bar.ply").write_bytes(surface_io.encode(mesh, ".ply"))
    rest = CAGE.draw(example="bar", give="rest-cage").mesh
    (tmp_path / "rest.obj").write_bytes(surface_io.encode(rest, ".obj"))
    moved = rest.moved(1.3 * rotated(rest.vertices) + (0.2, -0.1, 0.4))
    (tmp_path / "to.obj").write_bytes(surface_io.encode(moved, ".obj"))
    return tmp_path


class TestExamples:
    @pytest.mark.parametrize("name", ["cactus", "duck", "bar"])
    def test_cages_are_closed_and_around_their_shapes(self, name):
        shown = CAGE.draw(example=name).numbers
        rest = CAGE.draw(example=name, give="rest-cage").mesh
        assert shown["outside"] == 0
        assert (topology.edges("test", rest.faces).sides >= 0).all()
        assert len(rest.vertices) - 3 * len(rest.faces) // 2 + len(rest.faces) == 2

    @pytest.mark.parametrize("coordinates", ["maps", "mean-value", "green"])
    def test_a_cage_that_has_not_moved_moves_nothing(self, coordinates):
        mesh = CAGE.draw(example="bar", coordinates=coordinates, t=0.0).mesh
        assert np.abs(mesh.vertices - solids.bar().vertices).max() < 1e-12

    def test_the_spine_becomes_an_arc_of_its_own_length(self):
        rest = CAGE.draw(example="bar", give="rest-cage").mesh.vertices
        now = CAGE.draw(example="bar", give="cage", bend=90.0, twist=0.0).mesh.vertices
        level = np.abs(rest[:, 2] - 2.8) < 1e-9
        radius = 2.4 / (np.pi / 2.0)
        # A quarter of a circle upwards from (0, 0, 0.4), towards y.
        assert np.allclose(now[level].mean(axis=0), (0.0, radius, 0.4 + radius))
        assert np.allclose(now[rest[:, 2] < 0.5], rest[rest[:, 2] < 0.5])


class TestPlates:
    def test_the_map_takes_the_tetrahedron(self, plate):
        shown = plate("B7.6").numbers
        rest, now = (CAGE.draw(give=which).mesh for which in ("rest-cage", "cage"))
        k = int(shown["shown"])
        P, Q = by_hand(rest.vertices, rest.faces, k), by_hand(now.vertices, now.faces, k)
        assert np.allclose(shown["tetrahedra"], [P, Q])
        assert np.allclose(shown["map"], affine(P, Q))
        # The ratio of the normals' lengths is the root of the ratio of the areas.
        normals = [np.linalg.norm(T[3] - T[0]) for T in (P, Q)]
        areas = [np.linalg.norm(np.cross(T[1] - T[0], T[2] - T[0])) for T in (P, Q)]
        assert np.isclose(normals[1] / normals[0], np.sqrt(areas[1] / areas[0]))

    @pytest.mark.parametrize("plate_id", ["B7.5", "M3"])
    def test_the_weight_is_large_before_its_face_and_nothing_behind(self, plate_id, plate):
        shown = plate(plate_id).numbers
        V, corners = shown["cage_rest"], shown["corners"]
        centre = V[corners].mean(axis=0)
        name = "cactus" if plate_id == "B7.5" else "duck"
        points = solids.SOLIDS[name](solids.FINE).vertices
        from lietool.figures.ch7 import _cage_case, _cage_examples

        case = _cage_examples.example(name)
        choice = _cage_case.Choice()
        w = _cage_case.move(case, choice, 1.0, 0.0, 0.0, int(shown["shown"])).weight
        n = np.cross(V[corners[1]] - V[corners[0]], V[corners[2]] - V[corners[0]])
        depth = (centre - points) @ n / np.linalg.norm(n)
        assert (w[depth <= 0.0] == 0.0).all() and (depth <= 0.0).any()
        assert np.isclose(w.max(), shown["weight_high"])
        far = np.linalg.norm(points - centre, axis=1)
        assert far[np.argmax(w)] < 1.5 * far.min() and w[far > 1.5].max() < 0.02

    def test_the_mesh_of_the_picture_is_as_said(self, plate):
        shown = plate("B7.5").numbers
        mesh = CAGE.draw().mesh
        assert np.allclose(mesh.vertices.mean(axis=0), shown["mean"])
        V = mesh.vertices[mesh.faces]
        rest = solids.cactus().vertices[mesh.faces]
        assert np.isclose(shown["volume"], np.linalg.det(V).sum() / np.linalg.det(rest).sum())

    def test_what_the_comparison_says(self, plate):
        shown = plate("B7.5b").numbers
        volume, stretch = shown["volume"], shown["stretch"]
        assert volume[3] == volume.min() and volume[3] < volume[0]
        assert stretch[5] == stretch.min()

    def test_edges_leave_fewer_dents_than_faces_and_corners(self):
        """The mean angle between neighbouring triangles, on sides that are flat at rest."""
        rest, F = solids.bar().vertices, solids.bar().faces
        pairs = topology.edges("test", F).sides

        def angles(V):
            n = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
            n /= np.linalg.norm(n, axis=1)[:, None]
            return np.arccos(np.clip(np.sum(n[pairs[:, 0]] * n[pairs[:, 1]], axis=1), -1.0, 1.0))

        # The front and the back lie in planes that stay what they are when the bar is bent.
        flat = (angles(rest) < 0.01) & (np.abs(rest[F].mean(axis=1)[pairs[:, 0], 0]) > 0.3)
        base = {"example": "bar", "bend": 120.0, "twist": 0.0}
        kinds = ({"by": "faces"}, {"by": "edges"}, {"coordinates": "mean-value"}, {"coordinates": "green"})
        rough = [angles(CAGE.draw(**base, **kind).mesh.vertices)[flat].mean() for kind in kinds]
        assert max(rough[2:]) < rough[1] < rough[0]


class TestTurns:
    def test_a_twist_beyond_a_turn_is_followed(self):
        params = {"example": "bar", "bend": 0.0, "twist": 400.0, "mark": "42"}
        followed = CAGE.draw(**params, turns="followed").numbers["rotation_vector_degrees"]
        principal = CAGE.draw(**params, turns="principal").numbers["rotation_vector_degrees"]
        assert abs(np.linalg.norm(followed) - 400.0) < 5.0
        assert abs(np.linalg.norm(principal) - 40.0) < 5.0

    def test_what_neighbours_do_not_tell_is_told(self):
        drawing = CAGE.draw(example="bar", bend=0.0, twist=400.0)
        assert any("--turns followed" in note for note in drawing.notes)
        assert not CAGE.draw(example="bar", bend=0.0, twist=60.0).notes


class TestOwn:
    @pytest.mark.parametrize("by", ["faces", "edges", "corners"])
    def test_a_similarity_of_the_cage_moves_the_shape_by_it(self, files, by):
        own = {"shape": files / "bar.ply", "cage": files / "rest.obj", "to": files / "to.obj"}
        before = surface_io.read(files / "bar.ply").vertices
        after = CAGE.draw(**own, by=by).mesh.vertices
        assert np.abs(after - (1.3 * rotated(before) + (0.2, -0.1, 0.4))).max() < 1e-9

    def test_order_and_attributes_are_kept(self, files):
        out = files / "out.ply"
        result = run(files / "bar.ply", "--cage", files / "rest.obj", "--to", files / "to.obj", "-o", out)
        assert (result.exit_code, result.stderr) == (0, "")
        before, after = surface_io.read(files / "bar.ply"), surface_io.read(out)
        assert np.array_equal(before.faces, after.faces)
        assert np.array_equal(before.attributes["heat"], after.attributes["heat"])
        assert np.allclose(before.colours, after.colours, atol=1 / 255)
        assert np.abs(after.vertices - (1.3 * rotated(before.vertices) + (0.2, -0.1, 0.4))).max() < 1e-6

    def test_without_a_cage_one_is_made_and_written(self, files):
        rest = files / "made.obj"
        result = run(files / "bar.ply", "--faces", 40, "--give", "rest-cage", "-o", rest)
        assert result.exit_code == 0 and "no cage is given" in result.stderr
        made = surface_io.read(rest)
        assert len(made.faces) <= 40
        again = run(files / "bar.ply", "--cage", rest, "--to", rest, "-o", files / "same.ply")
        assert (again.exit_code, again.stderr) == (0, "")
        same, before = surface_io.read(files / "same.ply"), surface_io.read(files / "bar.ply")
        assert np.abs(same.vertices - before.vertices).max() < 1e-6

    def test_vertices_outside_are_told(self, files):
        cage = surface_io.read(files / "rest.obj")
        small = files / "small.obj"
        small.write_bytes(surface_io.encode(cage.moved(cage.vertices * (1.0, 1.0, 0.8)), ".obj"))
        drawing = CAGE.draw(shape=files / "bar.ply", cage=small)
        many = int((surface_io.read(files / "bar.ply").vertices[:, 2] > 0.8 * 3.3).sum())
        assert drawing.numbers["outside"] == many
        assert any(f"{many} of" in note and "outside" in note for note in drawing.notes)

    def test_a_cloud(self, files):
        cloud = files / "cloud.xyz"
        np.savetxt(cloud, surface_io.read(files / "bar.ply").vertices[::5])
        drawing = CAGE.draw(shape=cloud, cage=files / "rest.obj", to=files / "to.obj")
        expected = 1.3 * rotated(np.loadtxt(cloud)) + (0.2, -0.1, 0.4)
        assert np.abs(drawing.mesh.vertices - expected).max() < 1e-9
        assert CAGE.draw(shape=cloud, cage=files / "rest.obj", view="compare").picture

    def refused(self, files: Path, words: str) -> str:
        result = run(*words.format(f=files).split(), "-o", files / "no.png")
        assert result.exit_code == 2, result.output
        line = result.stderr.strip().splitlines()[-1]
        assert "Traceback" not in result.stderr and not (files / "no.png").exists()
        return line

    def test_what_is_refused(self, files):
        cage = surface_io.read(files / "rest.obj")
        broken = {
            "open": Mesh(cage.vertices, cage.faces[1:]),
            "inside-out": Mesh(cage.vertices, cage.faces[:, ::-1]),
            "fewer": Mesh(cage.vertices[:-1], cage.faces[(cage.faces < len(cage.vertices) - 1).all(axis=1)]),
            "other": Mesh(
                cage.vertices, np.concatenate([cage.faces[:5], cage.faces[5:6, [1, 2, 0]], cage.faces[6:]])
            ),
            "flat": Mesh(cage.vertices * (1.0, 1.0, 0.0), cage.faces),
        }
        for name, mesh in broken.items():
            (files / f"{name}.obj").write_bytes(surface_io.encode(mesh, ".obj"))
        for words, expected in (
            ("{f}/bar.ply --cage {f}/open.obj", "closed surface"),
            ("{f}/bar.ply --cage {f}/inside-out.obj", "counter-clockwise"),
            ("{f}/bar.ply --cage {f}/flat.obj", "cage"),
            ("{f}/bar.ply --cage {f}/rest.obj --to {f}/fewer.obj", "24 vertices; got 23"),
            ("{f}/bar.ply --cage {f}/rest.obj --to {f}/other.obj", "face 5 of vertices"),
            ("{f}/bar.ply --to {f}/to.obj", "--cage"),
            ("--cage {f}/rest.obj", "Name the shape too"),
            ("{f}/bar.ply --cage {f}/none.obj", "a file that exists"),
            ("{f}/bar.ply --cage {f}/rest.obj --mark 44", "44 faces"),
            ("{f}/bar.ply --cage {f}/rest.obj --mark front", "mark must be auto"),
            ("{f}/bar.ply --cage {f}/rest.obj --to {f}/to.obj --turns followed", "got followed"),
        ):
            line = self.refused(files, words)
            assert expected in line, line
