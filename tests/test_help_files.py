"""The files that help ends with are read by the command that shows them, and printed as they are written."""

import re
import textwrap
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lietool.cli import command
from lietool.deform import handle_io, probe_io
from lietool.mesh import surface_io
from lietool.mesh.surface import Mesh


def files(name: str) -> list[str]:
    """The examples at the end of a command's help, which are indented further than all else there."""
    result = CliRunner().invoke(command, [name, "--help"], terminal_width=80)
    assert result.exit_code == 0, result.output
    end = result.output.partition("Show this message and exit.\n")[2]
    blocks = re.findall(r"(?:^ {6}.*\n|^\n(?= {6}))+", end, re.M)
    return [textwrap.dedent(block).strip() + "\n" for block in blocks]


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """A column of tetrahedra from z = 0 to 2, off the origin."""
    corners = np.array([[0.2, 0.0, 0.0], [-0.2, 0.1, 0.0], [-0.1, -0.2, 0.0], [0.0, 0.0, 0.2]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    lifts = np.linspace(0.0, 1.9, 6)[:, None, None] * [0.0, 0.0, 1.0]
    F = (4 * np.arange(6)[:, None, None] + faces).reshape(-1, 3)
    path = tmp_path / "column.obj"
    path.write_bytes(surface_io.encode(Mesh((corners + lifts).reshape(-1, 3), F), ".obj"))
    return path


def test_the_files_of_probe(tmp_path: Path, mesh: Path) -> None:
    probes, poses, weighed = files("probe")
    (tmp_path / "p.toml").write_text(probes)
    (tmp_path / "anim.toml").write_text(poses)
    read = probe_io.read(tmp_path / "p.toml")
    assert read.names == ("foot", "head")
    # 400 degrees are one whole turn and 40.
    assert read.turns == pytest.approx(np.array([[0, 0, 0], [0, 0, 1]]))
    sequence = probe_io.read_poses(tmp_path / "anim.toml", read)
    assert sequence.fps == 24.0 and sequence.frames.shape == (2, 2, 4, 4)
    (tmp_path / "w.toml").write_text(weighed)
    words = ["probe", str(mesh), "--probes", str(tmp_path / "w.toml"), "--json"]
    result = CliRunner().invoke(command, words)
    # Of its six tetrahedra three have a probe.
    assert result.exit_code == 2 and "with 3 such parts, that of vertex 4 and 2 more" in result.output
    (tmp_path / "w.toml").write_text(weighed.replace('"harmonic"', '"harmonic"\nloose = "follow"'))
    result = CliRunner().invoke(command, words)
    assert result.exit_code == 0, result.output


def test_the_file_of_poisson(tmp_path: Path, mesh: Path) -> None:
    (handles,) = files("poisson")
    (tmp_path / "h.toml").write_text(handles)
    read = handle_io.read(tmp_path / "h.toml", surface_io.read(mesh))
    assert read.names == ("tip",) and len(read.pins) and len(read.vertices[0])


def test_the_file_of_pose(tmp_path: Path, mesh: Path) -> None:
    (keys,) = files("pose")
    (tmp_path / "k.toml").write_text(keys)
    words = ["pose", str(mesh), "--keys", str(tmp_path / "k.toml"), "--json"]
    result = CliRunner().invoke(command, words)
    assert result.exit_code == 0, result.output
    assert '"phi_so found": true' in result.output


def test_the_commands_of_cage(mesh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (lines,) = files("cage")
    monkeypatch.chdir(tmp_path)
    mesh.rename("my.obj")
    make, move = (line.split()[1:] for line in lines.splitlines())
    result = CliRunner().invoke(command, make)
    assert result.exit_code == 0, result.output
    Path("cage.obj").rename("moved.obj")
    Path("cage.obj").write_bytes(Path("moved.obj").read_bytes())
    result = CliRunner().invoke(command, move)
    assert result.exit_code == 0, result.output
    # The cage has not been moved.
    before, after = surface_io.read("my.obj"), surface_io.read("out.obj")
    assert after.vertices == pytest.approx(before.vertices, abs=1e-9)


def test_help_without_a_file_ends_with_its_options() -> None:
    output = CliRunner().invoke(command, ["slerp", "--help"], terminal_width=80).output
    assert output.endswith("Show this message and exit.\n")
