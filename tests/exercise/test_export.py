"""Exercises as an assignment: the folder that is written, and what students and scripts find in it."""

import dataclasses
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner

from lietool import figure as figures
from lietool import paths
from lietool.exercise import ExerciseError, export, export_plain, export_wheel, load, words
from lietool.exercise.export import MARK, ExportError
from lietool.exercise.outcome import Finding, Graded, Outcome
from lietool.verbs import _exercise_export

WHEEL = ("lietool-9-py3-none-any.whl", b"PK")
OWN = '''
"""Twice a number.

Write `twice(x)`.
"""

import numpy as np

from lietool.exercise import Case, Check, Exercise, Function, Picture


def twice(x):
    """Return twice x."""
    return 2.0 * np.asarray(x)


EXERCISE = Exercise(
    number=90,
    title="Twice",
    equations=("1.1",),
    functions=(Function("twice", reference=lambda x: 2.0 * np.asarray(x)),),
    checks=(Check("numbers", 7, cases=lambda rng: [Case("one", (1.0,))]),),
    picture=Picture("B2.5", 3, lambda f: {}),
)
'''


@pytest.fixture
def no_wheel(monkeypatch):
    monkeypatch.setattr(export_wheel, "wheel", lambda: WHEEL)


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A project with an exercise of its own."""
    project = tmp_path / "project"
    for name, text in (("exercises/my_own.py", OWN), ("exercises/_shared.py", ""), ("figures/a/_b.py", "")):
        (project / name).parent.mkdir(parents=True, exist_ok=True)
        (project / name).write_text(text.lstrip())
    monkeypatch.setenv(figures.PROJECT, str(project))
    return project


def run(*words_):
    return CliRunner().invoke(_exercise_export.command, [str(word) for word in words_])


def tree(folder: Path) -> dict[str, bytes]:
    return {x.relative_to(folder).as_posix(): x.read_bytes() for x in folder.rglob("*") if x.is_file()}


FILES = {"README.md": b"text", "a/run": b"#!/bin/sh\nexit 0\n"}


class TestFolder:
    def test_it_holds_the_files_and_what_is_a_script_runs(self, tmp_path):
        folder = tmp_path / "new" / "folder"
        export.publish(folder, FILES)
        found = tree(folder)
        del found[MARK]
        assert found == FILES
        assert subprocess.run([folder / "a" / "run"]).returncode == 0
        assert not os.access(folder / "README.md", os.X_OK)
        assert [x.name for x in folder.parent.iterdir()] == ["folder"]

    def test_an_older_export_is_replaced_with_all_that_was_in_it(self, tmp_path):
        folder = tmp_path / "folder"
        folder.mkdir()
        for files in (FILES, {"other": b"1"}):
            assert not export.stranger(folder)
            export.publish(folder, files)
        assert set(tree(folder)) == {"other", MARK}

    @pytest.mark.parametrize(
        ("spoil", "words_"),
        [
            (lambda folder: (folder / "mine").write_text(""), "it holds mine, which no export has put there"),
            (lambda folder: (folder / "a" / "mine").symlink_to("."), "it holds a/mine"),
            (lambda folder: (folder / "README.md").write_text("x"), "README.md in it has been changed"),
            (lambda folder: (folder / MARK).write_text("[]"), "was not made by"),
            (lambda folder: (folder / MARK).unlink(), "it holds README.md and was not made by"),
        ],
    )
    def test_what_is_not_ours_is_refused(self, tmp_path, spoil, words_):
        export.publish(tmp_path / "folder", FILES)
        spoil(tmp_path / "folder")
        assert words_ in export.stranger(tmp_path / "folder")

    def test_what_is_no_folder_is_refused(self, tmp_path, monkeypatch):
        (tmp_path / "file").touch()
        (tmp_path / "link").symlink_to("nowhere")
        monkeypatch.chdir(tmp_path)
        assert export.stranger(tmp_path / "file") == "it is a file"
        assert export.stranger(tmp_path / "link") == "it is a link that leads nowhere"
        assert export.stranger(Path()) == "it is the folder that you are in"

    @pytest.mark.parametrize("at", [1, 2])
    def test_what_fails_leaves_what_was_there(self, tmp_path, monkeypatch, at):
        folder = tmp_path / "folder"
        export.publish(folder, FILES)
        before, calls, rename = tree(folder), [], Path.rename

        def failing(path, target):
            calls.append(path)
            if len(calls) == at:
                raise OSError(28, "No space left on device")
            return rename(path, target)

        monkeypatch.setattr(Path, "rename", failing)
        with pytest.raises(OSError, match="No space"):
            export.publish(folder, {"other": b"1"})
        assert tree(folder) == before
        assert [x.name for x in tmp_path.iterdir()] == ["folder"]

    def test_what_cannot_be_written_leaves_nothing(self, tmp_path):
        with pytest.raises(OSError):
            export.publish(tmp_path / "folder", {"a": b"", "a/b": b""})
        assert not list(tmp_path.iterdir())


class TestAssignment:
    def test_without_names_it_is_all_in_the_order_of_the_book(self):
        assert [x.name for x in export.gather(()).exercises] == list(load.names())

    def test_names_are_ordered_and_each_is_once(self):
        found = export.gather(("cage_maps", "rodrigues", "cage-maps"), 3)
        assert [x.name for x in found.exercises] == ["rodrigues", "cage-maps"]
        assert (found.seed, found.total, dict(found.own)) == (3, 20, {})

    def test_what_is_unknown_is_said(self, monkeypatch, tmp_path):
        with pytest.raises(ExerciseError, match=r"no exercise 'rodrigue'\. Nearest: rodrigues"):
            export.gather(("rodrigue",))
        monkeypatch.setattr(load, "folders", lambda: (tmp_path,))
        with pytest.raises(ExportError, match="there is no exercise to be exported"):
            export.gather(())

    def test_what_a_teachers_own_needs_comes_along(self, own):
        (own / "figures" / "__pycache__").mkdir()
        (own / "figures" / "__pycache__" / "b.pyc").touch()
        found = export.gather(("my-own", "rodrigues"))
        names = {"exercises/my_own.py", "exercises/_shared.py", "figures/a/_b.py", "figures/.keep"}
        assert set(found.own) == {f"project/{name}" for name in names}
        assert not export.gather(("rodrigues",)).own

    def test_a_statement_says_what_to_do_and_what_it_is_worth(self):
        text = export.statement(load.load("rodrigues"))
        assert text.startswith("# 1. The rotation about an axis (2.14, 2.15, 2.16)\n\nA rotation of space")
        assert "| ordinary angles | 3 |\n" in text and "(B2.5.png)" in text

    def test_a_bar_in_a_title_ends_no_cell(self):
        exercise = load.load("rodrigues")
        check = dataclasses.replace(exercise.checks[0], title="|q| = 1")
        text = export.statement(dataclasses.replace(exercise, checks=(check,)))
        assert "| \\|q\\| = 1 | 3 |\n" in text


class TestPlain:
    @pytest.fixture
    def folder(self, tmp_path, no_wheel):
        assert run("--to", "plain", tmp_path / "out", "rodrigues", "--seed", 5).exit_code == 0
        return tmp_path / "out"

    @pytest.fixture
    def graded(self, tmp_path, folder):
        """Run its script with a lietool that says what it was called with."""
        program = tmp_path / "bin" / "lietool"
        program.parent.mkdir()

        def call(*words_, code=0, script=None):
            said = 'printf "%s\\n" "$@" "${LIETOOL_PROJECT-}"'
            program.write_text(f"#!/bin/sh\n{said}\nexit {code}\n")
            program.chmod(0o755)
            return subprocess.run(
                [script or folder / "grade.sh", *words_],
                env={"PATH": f"{program.parent}:{os.environ['PATH']}"},
                cwd=tmp_path,
                capture_output=True,
                text=True,
            )

        return call

    def test_students_get_what_they_need(self, folder):
        given = tree(folder / "students")
        assert set(given) == {"README.md", "rodrigues.py", "rodrigues.md", "B2.5.png", WHEEL[0]}
        assert load.which(given["rodrigues.py"].decode()) == "rodrigues"
        assert b"np.nan" in given["rodrigues.py"] and b"cross_matrix" not in given["rodrigues.py"]
        assert (
            "| [The rotation about an axis](rodrigues.md) | `rodrigues.py` | 10 |"
            in given["README.md"].decode()
        )
        assert not [name for name, data in tree(folder).items() if b"@seed@" in data or b"@note@" in data]

    def test_all_that_is_handed_in_goes_to_one_command(self, tmp_path, graded):
        for name in ("ada l/a.py", "ben/b.py", "ben/__MACOSX/b.py", "ben/.git/c.py", "ben/notes.txt"):
            (tmp_path / "in" / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / "in" / name).touch()
        done = graded("in", "--jobs", "2", code=5)
        assert (done.returncode, done.stderr) == (0, "")
        *options, first, second, project = done.stdout.splitlines()
        assert " ".join(options) == "exercise check --seed 5 --csv grades.csv --report report --jobs 2"
        assert {first, second} == {"in/ada l/a.py", "in/ben/b.py"} and not project

    def test_what_goes_wrong_is_said(self, tmp_path, graded):
        assert graded().returncode == 2
        assert "usage:" in graded("nowhere").stderr
        (tmp_path / "in").mkdir()
        assert "no file in in ends in .py" in graded("in").stderr
        (tmp_path / "in" / "a.py").touch()
        assert graded("in", code=2).returncode not in (0, 5)

    def test_a_teachers_own_exercise_is_graded_by_what_came_along(self, tmp_path, own, no_wheel, graded):
        assert run("--to", "plain", tmp_path / "own", "my-own").exit_code == 0
        (tmp_path / "in").mkdir()
        (tmp_path / "in" / "a.py").touch()
        done = graded("in", script=tmp_path / "own" / "grade.sh")
        assert done.stdout.splitlines()[-1] == str(tmp_path / "own" / "project")
        assert "checked when you hand in: my-own." in (tmp_path / "own/students/README.md").read_text()
        assert not list((tmp_path / "own" / "students").glob("project"))


class TestCommand:
    def test_it_says_what_comes_next(self, tmp_path, no_wheel):
        done = run("--to", "plain", tmp_path / "out", "rodrigues", "cage-maps")
        assert (done.exit_code, done.stderr) == (0, "")
        assert "20 points" in done.stdout and "grade.sh" in done.stdout

    @pytest.mark.parametrize(
        ("given", "words_"),
        [
            (("--to", "plane", "out"), "'plane' is not one of"),
            (("--to", "plain"), "requires 2 arguments"),
            (("rodrigues",), "Missing option '--to'"),
            (("--to", "plain", "full"), "full cannot take an assignment: it holds mine"),
            (("--to", "plain", "out", "--seed", "-1"), "x>=0"),
        ],
    )
    def test_what_is_wrong_is_said(self, tmp_path, monkeypatch, no_wheel, given, words_):
        monkeypatch.chdir(tmp_path)
        (tmp_path / "full").mkdir()
        (tmp_path / "full" / "mine").touch()
        done = run(*given)
        assert done.exit_code == 2 and words_ in done.stderr
        assert [x.name for x in tmp_path.iterdir()] == ["full"]

    def test_a_folder_that_cannot_be_written_is_said(self, tmp_path, no_wheel):
        (tmp_path / "file").touch()
        done = run("--to", "plain", tmp_path / "file" / "out", "rodrigues")
        assert done.exit_code == 2 and "cannot be written: " in done.stderr

    def test_the_same_exercises_make_the_same_files(self, no_wheel):
        one, other = (export_plain.files(export.gather(("rodrigues",)), WHEEL) for _ in range(2))
        assert one == other


class TestWheel:
    def test_one_that_cannot_be_built_is_said(self, monkeypatch, tmp_path):
        (tmp_path / "pyproject.toml").write_text("[build-system]\n")
        monkeypatch.setattr(paths, "PACKAGE", tmp_path / "lietool")
        with pytest.raises(ExportError, match=r"the wheel of lietool cannot be built: .+ Install hatchling"):
            export_wheel.wheel()

    def test_what_is_not_installed_is_said(self, monkeypatch, tmp_path):
        monkeypatch.setattr(paths, "PACKAGE", tmp_path / "lietool")
        with pytest.raises(ExportError, match=r"another lietool is installed|is not installed"):
            export_wheel.wheel()

    def test_an_installed_one_is_packed_as_it_was(self, tmp_path):
        name, data = export_wheel.wheel()
        (tmp_path / name).write_bytes(data)
        command = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-index", "--no-compile"]
        subprocess.run([*command, "--target", tmp_path / "site", tmp_path / name], check=True, timeout=300)
        code = "from lietool.exercise import export_wheel as e; n, d = e.wheel(); open(n, 'wb').write(d)"
        again = tmp_path / "again"
        again.mkdir()
        subprocess.run(
            [sys.executable, "-P", "-c", code],
            cwd=again,
            env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path / "site"), *sys.path])},
            check=True,
            timeout=300,
        )
        assert [x.name for x in again.iterdir()] == [name]
        with zipfile.ZipFile(tmp_path / name) as one, zipfile.ZipFile(again / name) as other:
            assert sorted(one.namelist()) == sorted(other.namelist())
            differ = [x for x in one.namelist() if one.read(x) != other.read(x)]
        assert not [x for x in differ if not x.endswith("/RECORD")]

    def test_a_zip_file_is_the_same_for_the_same_files(self):
        files = {"run": b"#!/bin/sh\n", "a.whl": b"x" * 100, "b": b"y" * 100}
        data = export_wheel.zipped(files)
        assert data == export_wheel.zipped(files)
        with zipfile.ZipFile(__import__("io").BytesIO(data)) as archive:
            modes = {x.filename: x.external_attr >> 16 for x in archive.infolist()}
        assert modes == {"run": 0o100755, "a.whl": 0o100644, "b": 0o100644}


class TestWords:
    WRONG = Finding("one", False, "x = 1", "2", "3", "1, allowed 1e-9")

    def test_what_failed_is_told_and_what_is_right_is_not(self):
        made = Outcome("numbers", "cases", 0, 2, (self.WRONG, Finding("two", True)))
        lines = ["numbers: 0 of 2 points.", "  one", "    given  x = 1", "    wanted 2", "    got    3"]
        assert words.outcome(made).splitlines() == [*lines, "    off by 1, allowed 1e-9"]
        assert words.outcome(Outcome("laws", "law", 1, 1)) == "laws: 1 point, all is right."

    def test_of_many_some_are_told(self):
        made = Outcome("numbers", "cases", 0, 1, (self.WRONG,) * 9)
        assert words.outcome(made).endswith("  And 5 more of 9 inputs.")

    def test_a_line_is_quoted_where_nobody_could_count_it(self):
        made = Outcome(
            "numbers", "cases", 0, 1, (Finding("one", False, trouble="line 2: no"),), "line 9: gone"
        )
        assert "    `x = 1`: no\n  line 9: gone" in words.outcome(made, "y\n  x = 1\n")
        assert "    line 2: no\n" in words.outcome(made)

    def test_a_summary_has_what_explains_the_marks(self):
        made = Graded("slerp", "Slerp", (Outcome("a", "cases", 0, 2),), ("Half.",), trouble="It hangs.")
        assert words.summary(made) == "slerp: 0 of 2 points.\nIt hangs.\nHalf."
