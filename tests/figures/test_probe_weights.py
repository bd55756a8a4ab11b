"""Weights of probes: harmonic, and others for rotation, translation and stretch; by laws and the library."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lietool import figure, paths
from lietool.cli import command
from lietool.deform import harmonic, probe, probe_io, weights
from lietool.mesh import solids, surface_io
from lietool.mesh.surface import Mesh

PROBE = figure.load("probe", (paths.FIGURES,))
MOVED: str = "name=a centre=0,0,0;name=b centre=0,0,2 axis=0,1,0 degrees=80 scale=1.5 translation=0.2,0,0.1"
# The same about the origin for both: a motion of all space.
EQUAL = [
    f"name={n} centre=0,0,{z} axis=0,0,1 degrees=70 scale=1.3 translation=0.5,0,{0.3 * z!r}"
    for n, z in (("a", 0.0), ("b", 2.0))
]


def column(*lifts: float) -> Mesh:
    """Closed square tubes from z = 0 to 2, one for each lift to the side, as one mesh."""
    z, side = np.linspace(0.0, 2.0, 13), 0.2 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    V = np.array([[x, y, h] for h in z for x, y in side])
    a = (np.arange(12)[:, None] * 4 + np.arange(4)).ravel()
    b = (np.arange(12)[:, None] * 4 + (np.arange(4) + 1) % 4).ravel()
    F = np.concatenate([np.stack([a, b, b + 4], 1), np.stack([a, b + 4, a + 4], 1)])
    n = len(V)
    return Mesh(
        np.concatenate([V + np.array([x, 0.0, 0.0]) for x in lifts]),
        np.concatenate([F + k * n for k in range(len(lifts))]),
    )


@pytest.fixture
def tube(tmp_path: Path) -> Path:
    path = tmp_path / "tube.ply"
    path.write_bytes(surface_io.encode(column(0.0), ".ply"))
    return path


def moved(shape: Path, **params: object) -> np.ndarray:
    mesh = PROBE.draw(shape=shape, **params).mesh
    assert mesh is not None
    return mesh.vertices


def written(folder: Path, text: str) -> Path:
    path = folder / "p.toml"
    path.write_text(text)
    return path


def refused(*words: str) -> str:
    result = CliRunner().invoke(command, ["probe", *words, "--json"])
    assert result.exit_code == 2 and result.output.count("\n") == 1, result.output
    return result.output


@pytest.mark.parametrize("kind", ["harmonic", "biharmonic"])
def test_as_the_library(tube, kind):
    mesh = surface_io.read(tube)
    z = mesh.vertices[:, 2]
    sets = [np.flatnonzero(z < 0.1), np.flatnonzero(z > 1.9)]
    w = getattr(harmonic, kind)(mesh.vertices, mesh.faces, sets)
    assert np.allclose(w.sum(axis=1), 1.0)
    given = probe_io.from_words(list[str](MOVED.split(";")))
    expected = probe.solve(probe.prepare(mesh.vertices, given.rest, w), given.current).points
    assert np.allclose(moved(tube, probe=MOVED, weights=kind, hold=0.0), expected, atol=1e-12)


@pytest.mark.parametrize("kind", ["harmonic", "biharmonic", "inverse-distance"])
def test_equal_motions_are_reproduced(tube, kind):
    V = surface_io.read(tube).vertices
    c, s = np.cos(np.radians(70.0)), np.sin(np.radians(70.0))
    expected = 1.3 * V @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T + (0.5, 0.0, 0.0)
    found = moved(tube, probe=";".join(EQUAL), weights=kind, rotation_weights="harmonic hold=0.2")
    assert np.allclose(found, expected, atol=1e-9)


def test_held_vertices_do_as_the_probe_does():
    drawing = PROBE.draw(weights="harmonic")
    V, mesh = solids.duck().vertices, drawing.mesh
    assert mesh is not None
    for rest, now in zip(*(np.asarray(drawing.numbers[key]) for key in ("rest", "frames")), strict=True):
        k = np.argmin(np.linalg.norm(V - rest[:3, 3], axis=1))
        A = now @ np.linalg.inv(rest)
        assert np.allclose(mesh.vertices[k], A[:3, :3] @ V[k] + A[:3, 3], atol=1e-9)


def test_without_weights_of_rotation_nothing_turns(tube):
    words = "centre=0,0,0 axis=0,0,1 degrees=400"
    V = surface_io.read(tube).vertices
    assert np.allclose(moved(tube, probe=words, rotation_weights="none"), V)
    assert not np.allclose(moved(tube, probe=words, stretch_weights="none"), V)
    grown = "centre=0,0,0 scale=2"
    assert np.allclose(moved(tube, probe=grown, stretch_weights="none"), V)


def test_parts_as_the_library(tube):
    V = surface_io.read(tube).vertices
    given = probe_io.from_words(list[str](MOVED.split(";")))
    size = 0.5 * float(np.linalg.norm(np.ptp(V, axis=0)))
    r = weights.distances(V, given.rest[:, :3, 3])
    base = weights.partition_of_unity(weights.inverse_distance(r))
    turn = weights.capped(weights.gaussian(r, 0.3 * size))
    apart = weights.separate(turn, base, np.zeros_like(base))
    expected = probe.solve(probe.prepare(V, given.rest, apart), given.current).points
    found = moved(tube, probe=MOVED, rotation_weights="gaussian reach=0.3", stretch_weights="none")
    assert np.allclose(found, expected, atol=1e-12)
    # In a file lengths are those of the shape.
    lines = [f"[weights]\nrotation = {{ kind = 'gaussian', reach = {0.3 * size!r} }}\n"]
    lines.append(
        "stretch = { kind = 'none' }\n[[probe]]\ncentre = [0, 0, 0]\n[[probe]]\ncentre = [0, 0, 2]\n"
    )
    lines.append("current = { axis = [0, 1, 0], degrees = 80, scale = 1.5, translation = [0.2, 0, 0.1] }\n")
    file = written(tube.parent, "".join(lines))
    assert np.allclose(moved(tube, probes=file), expected, atol=1e-12)


def test_painted_in_a_file(tube):
    V = surface_io.read(tube).vertices
    tube.with_name("w.csv").write_text("".join(f"{z / 2.0!r}\n" for z in V[:, 2].tolist()))
    text = "[weights]\nkind = 'painted'\nfile = 'w.csv'\n[[probe]]\ncentre = [0, 0, 0]\n"
    file = written(tube.parent, text + "current = { translation = [1, 0, 0] }\n")
    assert np.allclose(moved(tube, probes=file) - V, V[:, 2:] / 2.0 * (1.0, 0.0, 0.0))


def test_parts_without_a_probe(tmp_path):
    two = tmp_path / "two.ply"
    two.write_bytes(surface_io.encode(column(0.0, 5.0), ".ply"))
    words = (str(two), "--probe", MOVED, "--weights", "harmonic")
    output = refused(*words)
    assert "got harmonic, with 1 such parts, that of vertex 52" in output and "--loose follow" in output
    found = moved(two, probe=MOVED, weights="harmonic", loose="follow")
    rest = column(5.0).vertices
    lengths = [np.linalg.norm(V[1:] - V[:-1], axis=1) for V in (rest, found[52:])]
    # It moves as one piece, with one stretch.
    assert np.allclose(lengths[1] / lengths[0], (lengths[1] / lengths[0])[0])


def test_reflections_are_replaced_and_told(tube):
    # Of equal stretches it would not be known which is turned back.
    mirror = "[[-0.5, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"
    file = written(
        tube.parent, f"[[probe]]\nname = 'm'\ncentre = [0, 0, 0]\ncurrent = {{ matrix = {mirror} }}\n"
    )
    assert "probe m must have a motion with det > 0" in refused(str(tube), "--probes", str(file))
    drawing = PROBE.draw(shape=tube, probes=file, inside_out="nearest")
    assert drawing.notes[0].startswith("probe m turns space inside out or flattens it")
    assert drawing.mesh is not None
    V = surface_io.read(tube).vertices
    assert np.allclose(drawing.mesh.vertices, V * (1e-3, 1.0, 1.0), atol=1e-9)


HANDLED = "[[probe]]\nname = 'a'\ncentre = [0, 0, 0]\nhandle = { vertices = [0] }\n"
MISTAKES = {
    "linear": (("--rotation-weights", "none", "--way", "linear"), "way must be polar-quaternion or phi-so"),
    "unknown": (("--rotation-weights", "gauss"), "kind must be one of inverse-distance"),
    "a key of others": (("--rotation-weights", "cutoff hold=1"), "got the key 'hold'"),
    "twice": (("--rotation-weights", "cutoff reach=1 reach=2"), "reach must be given once"),
    "no reach": (("--rotation-weights", "cutoff reach=-1"), "reach must be 1e-06 to 1e+06"),
    "no file": (("--stretch-weights", "painted"), "file must be the name of a file of weights"),
    "one place": (
        ("--probe", "name=a centre=0,0,0;name=b centre=0,0,0", "--weights", "harmonic"),
        "probe b must hold a vertex of its own",
    ),
    "hold": (("--hold", "0.3"), "--hold has a part in the picture only with --weights harmonic"),
    "inside out": (("--inside-out", "nearest"), "only beside --probes"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_are_one_line(tube, mistake):
    words, message = MISTAKES[mistake]
    assert message in refused(str(tube), *words)


FILES = {
    "kind twice": (
        "[weights]\nkind = 'gaussian'\n" + HANDLED,
        ("--weights", "cutoff"),
        "weights must be left out",
    ),
    "empty": ("[weights]\n" + HANDLED, (), "given kind, or rotation"),
    "part twice": (
        "[weights]\nrotation = { kind = 'none' }\n" + HANDLED,
        ("--rotation-weights", "none"),
        "rotation-weights must be left out",
    ),
    "a vertex twice": (
        HANDLED + HANDLED.replace("'a'", "'b'"),
        ("--weights", "harmonic"),
        "probe b must hold vertices of its own; got vertex 0, which probe a holds",
    ),
    "no vertex": (HANDLED.replace("[0]", "[99]"), ("--weights", "harmonic"), "vertices must be numbers of"),
}


@pytest.mark.parametrize("mistake", FILES)
def test_mistakes_in_files_are_one_line(tube, mistake):
    text, words, message = FILES[mistake]
    assert message in refused(str(tube), "--probes", str(written(tube.parent, text)), *words)


def test_a_handle_without_a_part_is_told(tube):
    drawing = PROBE.draw(shape=tube, probes=written(tube.parent, HANDLED))
    assert drawing.notes == ("the handle of probe a has no part: weights are not harmonic or biharmonic",)


def test_clouds_have_no_harmonic_weights(tmp_path):
    cloud = tmp_path / "c.xyz"
    cloud.write_text("0 0 0\n1 0 0\n0 1 0\n")
    assert "for a cloud; got harmonic" in refused(str(cloud), "--weights", "harmonic")


def test_what_is_declared_is_what_is_meant():
    # Twice, since a declaration is read without numpy.
    from lietool.figures.ch7 import _probe_recipes, _probe_weights, probe

    assert (probe._DISTANCES, probe._SMOOTH) == (_probe_weights.DISTANCES, _probe_weights.SMOOTH)
    assert (probe._REACH, probe._HOLD) == (_probe_recipes.REACH, _probe_recipes.HOLD)
