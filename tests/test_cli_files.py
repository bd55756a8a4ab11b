"""Files on the command line: those that need no option, and the mesh of a drawing, on toy figures."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from click.testing import CliRunner, Result

from lietool import atomic, figure, paths
from lietool.cli import command
from lietool.mesh import surface_io
from lietool.verbs import _mesh

_SPIN = '''
from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.mesh import surface
from lietool.render.scene import Picture


@figure(
    plates={"F1": Plate("Spin", (), "Spin."), "F2": Plate("Twice", (), "Twice.", {"view": "both"})},
    time=Time("turn", 0, 90, frames=8, seconds=0.8),
    mesh=("view", "whole", "half"),
)
def spin(
    view: Annotated[Literal["whole", "half", "both"], Param("what to draw")] = "whole",
    turn: Annotated[float, Param("swept angle", "deg", 0, 90)] = 30.0,
    after: Annotated[Path | None, Param("what it becomes", positional=2)] = None,
    before: Annotated[Path | None, Param("your own shape", positional=1)] = None,
    axes: Annotated[Path | None, Param("a third file")] = None,
) -> Drawing:
    """A triangle that turns."""
    w = np.exp(1j * np.radians(turn)) * np.array([0.0, 2.0, 1.0 + 1.0j])
    V = np.stack([w.real, w.imag, 0.0 * w.real], axis=1)
    mesh = surface.Mesh(V, np.array([[0, 1, 2]])) if view != "both" else None
    names = str([before and before.name, after and after.name])
    return Drawing(Picture((), (64, 48)), {"files": names}, mesh)
'''
_SOLID = '''
import numpy as np

from lietool.figure import Drawing, Plate, figure
from lietool.mesh import surface
from lietool.render.scene import Picture


@figure(plates={"S1": Plate("Solid", (), "Solid.")}, mesh=True)
def solid() -> Drawing:
    """One triangle."""
    V = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]])
    return Drawing(Picture((), (64, 48)), {}, surface.Mesh(V, np.array([[0, 1, 2]])))
'''
_HERD = '''
from pathlib import Path
from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.mesh import surface
from lietool.render.scene import Picture


@figure(plates={"H1": Plate("Herd", (), "Herd.")}, time=Time("t", 0, 1, frames=4, seconds=0.4), mesh=True)
def herd(
    first: Annotated[Path | None, Param("the first", positional=1)] = None,
    others: Annotated[tuple[Path, ...], Param("the rest", positional=2)] = (),
    t: Annotated[float, Param("time", low=0, high=1)] = 0.0,
) -> Drawing:
    """Any number of files."""
    V = np.array([[0.0, 0.0, t], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]])
    files = f"{first and first.name} {[file.name for file in others]}"
    notes = () if others else ("1 file is few",)
    mesh = surface.Mesh(V, np.array([[0, 1, 2]]))
    return Drawing(Picture((), (64, 48)), {"files": files}, mesh, notes)
'''
_ALL = ".png, .svg, .pdf, .gif, .apng, .mp4, .obj, .off, .ply, .stl or .glb"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files a.svg to d.svg to work in, and toy figures."""
    chapter = tmp_path / "project/figures/ch9"
    chapter.mkdir(parents=True)
    (chapter / "spin.py").write_text(_SPIN)
    (chapter / "solid.py").write_text(_SOLID)
    (chapter / "herd.py").write_text(_HERD)
    monkeypatch.setenv(figure.PROJECT, str(tmp_path / "project"))
    monkeypatch.setattr(paths, "FIGURES", tmp_path / "none")
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    for name in "abcd":
        (work / f"{name}.svg").write_text("<svg/>")
    return work


def _run(*arguments: str) -> Result:
    result = CliRunner().invoke(command, arguments)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


def _files(*arguments: str) -> str:
    result = _run("spin", "--json", *arguments)
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)["files"]


def _left(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir() if file.suffix != ".svg")


class TestWords:
    @pytest.mark.parametrize(
        "words",
        [
            "a.svg b.svg",
            "--before a.svg --after b.svg",
            "a.svg --after b.svg",
            "--view half a.svg --turn 3 b.svg",
            "--plate F2 -- a.svg b.svg",
        ],
    )
    def test_files_need_no_option(self, folder: Path, words: str) -> None:
        assert _files(*words.split()) == "['a.svg', 'b.svg']"

    def test_fewer_are_the_first(self, folder: Path) -> None:
        assert _files("a.svg") == "['a.svg', None]"
        assert _files() == "[None, None]"

    @pytest.mark.parametrize(
        ("words", "line"),
        [
            ("a.svg b.svg c.svg", "only BEFORE and AFTER can be given without an option; got 'c.svg' too"),
            (
                "a.svg b.svg --after c.svg",
                "AFTER is given twice: 'b.svg', and --after c.svg. Leave out one of them",
            ),
            (
                "--before a.svg b.svg",
                "BEFORE is given twice: 'b.svg', and --before a.svg. Leave out one of them",
            ),
            ("a.svg none.svg", "AFTER must be a file that exists; got 'none.svg'"),
            (".", "BEFORE must be a file that exists; got '.'"),
            ("F2", "BEFORE must be a file that exists; got 'F2'. Write --plate F2"),
            ("a.svg " + "x" * 300, f"AFTER must be a file that exists; got '{'x' * 60}...'"),
        ],
    )
    def test_a_mistake_is_one_line(self, folder: Path, words: str, line: str) -> None:
        result = _run("spin", *words.split())
        assert (result.exit_code, result.stdout, result.stderr) == (2, "", f"lietool spin: {line}\n")
        assert _left(folder) == []

    def test_a_figure_without_them_takes_none(self, folder: Path) -> None:
        said = _run("solid", "a.svg").stderr
        assert said == "lietool solid: Got unexpected extra argument (a.svg). See lietool solid --help\n"

    def test_help_says_so(self, folder: Path) -> None:
        text = " ".join(_run("spin", "--help").stdout.split())
        assert "[OPTIONS] [BEFORE [AFTER]]" in text
        assert "your own shape [or the first FILE without an option]" in text
        assert "what it becomes [or the second FILE without an option]" in text
        assert "--axes FILE a third file Plates:" in text

    def test_completion_completes_files(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("_LIETOOL_COMPLETE", "bash_complete")
        monkeypatch.setenv("COMP_WORDS", "lietool spin a")
        monkeypatch.setenv("COMP_CWORD", "2")
        assert _run().stdout.split() == ["file,a"]


class TestManyWords:
    @pytest.mark.parametrize(
        ("words", "files"),
        [
            ("", "None []"),
            ("a.svg", "a.svg []"),
            ("a.svg b.svg c.svg d.svg", "a.svg ['b.svg', 'c.svg', 'd.svg']"),
            ("a.svg --others b.svg --others c.svg", "a.svg ['b.svg', 'c.svg']"),
            ("--first a.svg --others b.svg", "a.svg ['b.svg']"),
        ],
    )
    def test_the_last_takes_all_that_follow(self, folder: Path, words: str, files: str) -> None:
        result = _run("herd", "--json", *words.split())
        assert result.exit_code == 0, result.stderr
        assert json.loads(result.stdout)["files"] == files

    @pytest.mark.parametrize(
        ("words", "line"),
        [
            ("a.svg b.svg none.svg", "OTHERS must be files that exist; got 'none.svg'"),
            ("--others none.svg", "--others must be files that exist; got 'none.svg'."),
            (
                "a.svg b.svg --others c.svg",
                "OTHERS is given twice: 'b.svg', and --others c.svg. Leave out one of them",
            ),
        ],
    )
    def test_a_mistake_is_one_line(self, folder: Path, words: str, line: str) -> None:
        result = _run("herd", *words.split())
        assert (result.exit_code, result.stdout, result.stderr) == (2, "", f"lietool herd: {line}\n")

    def test_help_says_so(self, folder: Path) -> None:
        text = " ".join(_run("herd", "--help").stdout.split())
        assert "[OPTIONS] [FIRST [OTHERS...]]" in text
        assert "--others FILE the rest [once for each; or the second FILE without an option and all" in text

    def test_notes_are_told_once_beside_the_file(self, folder: Path) -> None:
        assert _run("herd", "a.svg", "-o", "x.obj").stderr == "lietool herd: 1 file is few\n"
        assert _run("herd", "a.svg", "--json").stderr == "lietool herd: 1 file is few\n"
        assert _run("herd", "a.svg", "-o", "x%d.obj").stderr == "lietool herd: 1 file is few\n"
        assert _run("herd", "a.svg", "b.svg", "-o", "x.obj").stderr == ""


class TestMeshes:
    def test_the_endings_are_those_that_can_be_written(self) -> None:
        assert set(_mesh.ENDINGS) == set(surface_io.ENDINGS)

    @pytest.mark.parametrize("ending", _mesh.ENDINGS)
    @pytest.mark.parametrize("turn", [0.0, 40.0])
    def test_the_mesh_is_that_of_the_moment(self, folder: Path, ending: str, turn: float) -> None:
        result = _run("spin", "--turn", str(turn), "-o", f"a{ending.upper()}")
        assert (result.exit_code, result.stdout) == (0, f"a{ending.upper()}\n")
        data = (folder / f"a{ending.upper()}").read_bytes()
        read = trimesh.load_mesh(io.BytesIO(data), file_type=ending[1:], process=False)
        w = np.exp(1j * np.radians(turn)) * np.array([0.0, 2.0, 1.0 + 1.0j])
        assert np.array(read.triangles[0]) == pytest.approx(
            np.stack([w.real, w.imag, 0.0 * w.real], axis=1), abs=1e-6
        )

    def test_with_numbers_both(self, folder: Path) -> None:
        result = _run("solid", "--json", "-o", "a.off")
        assert (result.stdout, result.stderr) == ("{}\n", "a.off\n")
        assert _left(folder) == ["a.off"]

    def test_one_for_each_moment_of_a_film(self, folder: Path) -> None:
        result = _run("spin", "-o", "part-%02d.obj")
        names = [f"part-{k:02d}.obj" for k in range(5)]
        assert result.stdout.split() == names == _left(folder)
        ends = [trimesh.load_mesh(name, process=False).vertices[1] for name in names]
        # From one end to the other, once.
        angles = np.degrees([np.arctan2(v[1], v[0]) for v in ends])
        assert angles[[0, -1]] == pytest.approx([0.0, 90.0], abs=1e-5) and (np.diff(angles) > 0.0).all()
        _run("spin", "--fps", "5", "--seconds", "4", "-o", "n%d.ply")
        assert len(list(folder.glob("n*.ply"))) == 11 and (folder / "n10.ply").is_file()

    @pytest.mark.parametrize(
        ("words", "line"),
        [
            (
                "spin --view both -o a.glb",
                "spin shows the mesh of one moment, which a .glb holds, only with --view whole or half. "
                "Write that, or a .png",
            ),
            ("spin --plate F2 -o a%d.stl", "spin shows the mesh of one moment, which a .stl holds, only"),
            ("spin -o a.jpg", f"--output must end in {_ALL}; got 'a.jpg'"),
            (
                "spin -o a.obj --theme dark --draft",
                "--theme and --draft say how to draw, and a .obj is no picture. Leave them out",
            ),
            ("spin -o a.obj --size 3cm", "--size says how to draw, and a .obj is no picture. Leave it out"),
            ("spin -o a.obj --fps 3", "--seconds and --fps are for films. "),
            ("spin -o a%d.obj --turn 3", "a .obj sweeps --turn, so it cannot be given too. Leave out"),
            (
                "spin -o a%d-%d.obj",
                "--output a%d-%d.obj must have one number to count by; got %d and %d. Write",
            ),
            ("spin -o a%10d.obj", "--output a%10d.obj must have one number to count by; got %10d. Write for"),
            (
                "spin -o a%d.png",
                "--output a%d.png must be one file, for numbered ones hold meshes; got %d in",
            ),
            ("solid -o a%d.obj", "solid has no time to animate. "),
            ("spin -o no/a%d.obj", "--output no/a%d.obj: there is no folder no. Make it first"),
        ],
    )
    def test_a_mistake_is_one_line(self, folder: Path, words: str, line: str) -> None:
        result = _run(*words.split())
        assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
        assert result.stderr.startswith(f"lietool {words.split()[0]}: {line}")
        assert _left(folder) == []

    def test_a_row_too_large_is_not_begun(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(_mesh, "_MOST_BYTES", 1 << 9)
        line = "--output a%d.obj must be files of at most 0 MiB together; got 5 of "
        result = _run("spin", "-o", "a%d.obj")
        assert (result.exit_code, result.stdout, _left(folder)) == (2, "", [])
        assert line in result.stderr and "Write fewer, by --fps" in result.stderr

    def test_a_name_with_a_sign_is_a_name(self, folder: Path) -> None:
        assert _run("spin", "-o", "100%.obj").stdout == "100%.obj\n"

    def test_a_figure_without_one_says_so(self, folder: Path) -> None:
        file = folder.parent / "project/figures/ch9/flat.py"
        file.write_text(_SOLID.replace(", mesh=True", "").replace("solid", "flat").replace("S1", "S2"))
        assert _run("flat", "-o", "a.obj").stderr == (
            "lietool flat: flat shows no mesh, which a .obj holds. Write a .png\n"
        )
        assert ".obj" not in _run("flat", "--help").stdout
        # What it does not declare it must not return.
        assert "just where @figure(mesh=...) says so; got one" in _run("flat", "--json").stderr

    def test_help_says_so(self, folder: Path) -> None:
        text = " ".join(_run("spin", "--help").stdout.split())
        assert ".mp4, or to hold the mesh shown, in .obj, .off, .ply, .stl or .glb; frame-%03d.obj" in text
        assert "frame-%03d.obj makes one for each moment of --turn. [default" in text
        text = " ".join(_run("solid", "--help").stdout.split())
        assert "in .obj, .off, .ply, .stl or .glb. [default ./solid.png]" in text

    def test_it_is_written_as_a_whole(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def full(*_: object) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(atomic, "write_bytes", full)
        assert "cannot write a.obj: No space left on device" in _run("solid", "-o", "a.obj").stderr
        assert _left(folder) == []

    def test_it_needs_no_renderer(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        from lietool.render import context

        def none(*_: object) -> None:
            raise context.NoRendererError({"osmesa": "not there"})

        monkeypatch.setattr(context, "get", none)
        assert _run("solid", "-o", "a.obj").exit_code == 0
