"""A course for nbgrader: notebooks as it wants them, whose cells grade what is written in them."""

import csv
import dataclasses
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from lietool.exercise import export, export_nbgrader, load, notebook
from lietool.exercise.export import ExportError

nbformat = pytest.importorskip("nbformat")
NAMES = list(load.names())
WHEEL = ("lietool-9-py3-none-any.whl", b"PK")
STUB = "# YOUR CODE HERE\nraise NotImplementedError()"


def released(source: str, stub: str = STUB) -> str:
    """Return a cell as students get it: as nbgrader's ClearSolutions and ClearHiddenTests make it."""
    lines, inside = [], False
    for line in source.split("\n"):
        indent = re.match(r"\s*", line)
        if "### BEGIN" in line:
            assert not inside and indent
            inside = True
            lines += [indent[0] + part for part in stub.split("\n")] if "SOLUTION" in line else []
        elif "### END" in line:
            inside = False
        elif not inside:
            lines.append(line)
    assert not inside
    return "\n".join(lines)


@pytest.fixture
def kernel(monkeypatch):
    """Run cells one after the other as a kernel does, and return what came of the checks."""

    def run(cells):
        main, found = {"In": [""]}, []
        for cell in cells:
            main["In"].append(cell)
            monkeypatch.setattr(sys.modules["__main__"], "In", main["In"], raising=False)
            try:
                exec(compile(cell, "<cell>", "exec"), main)
            except notebook.Lost as lost:
                found.append(str(lost))
            else:
                found.append("")
        return found

    monkeypatch.setattr(notebook, "_show", lambda *_: None)
    return run


def code(book) -> list[str]:
    return [cell.source for cell in book.cells if cell.cell_type == "code"]


@pytest.mark.parametrize("name", NAMES)
class TestNotebook:
    def test_it_is_valid_and_the_same_each_time(self, name):
        book = export_nbgrader.notebook(load.load(name), 7)
        nbformat.validate(book)
        assert nbformat.writes(book) == nbformat.writes(export_nbgrader.notebook(load.load(name), 7))
        assert (book.nbformat, book.metadata.kernelspec.name) == (4, "python3")

    def test_its_metadata_is_of_the_third_schema(self, name):
        exercise = load.load(name)
        cells = export_nbgrader.notebook(exercise).cells
        about = [cell.metadata.nbgrader for cell in cells]
        for cell, meta in zip(cells, about, strict=True):
            assert meta.schema_version == 3 and re.fullmatch(r"[a-zA-Z0-9_\-]+", meta.grade_id)
            assert {type(meta[key]) for key in ("grade", "solution", "locked", "task")} == {bool}
            assert ("points" in meta) == meta.grade
            # A markdown cell that is graded would be one that is written in; a test is locked.
            assert not (cell.cell_type == "markdown" and meta.grade) and meta.locked != meta.solution
        assert len({meta.grade_id for meta in about}) == len(about)
        assert sum(meta.get("points", 0) for meta in about) == exercise.total
        assert sum(meta.solution for meta in about) == 1

    def test_what_students_get_has_no_solution_and_runs(self, name):
        exercise = load.load(name)
        text = released(export_nbgrader.solution(exercise))
        space: dict = {}
        exec(text, space)
        for function in exercise.functions:
            assert text.count(f"def {function.name}(") == 1 and space[function.name].__doc__
        assert text.count(STUB.split("\n")[0]) == len(exercise.functions)
        for line in exercise.solution_source.splitlines():
            # Of the bodies nothing is left that says more than a bracket.
            if line.startswith("    return ") and line not in exercise.starter_source:
                assert line not in text

    def test_the_solution_is_the_one_that_is_graded(self, name):
        exercise = load.load(name)
        plain, source = {}, {}
        exec(export_nbgrader.solution(exercise), source)
        exec(exercise.solution_source, plain)
        written = [x for x, value in plain.items() if callable(value) and hasattr(value, "__code__")]
        assert [source[x].__code__.co_code for x in written] == [plain[x].__code__.co_code for x in written]


def test_what_decorates_a_helper_comes_along():
    exercise = load.load("rodrigues")
    helper = "@staticmethod\ndef _helper():\n    return 1\n"
    made = export_nbgrader.solution(
        dataclasses.replace(exercise, solution_source=exercise.solution_source + helper)
    )
    space: dict = {}
    exec(made, space)
    assert isinstance(space["_helper"], staticmethod)


class TestCells:
    BOOK = code(export_nbgrader.notebook(load.load("rodrigues"), 7))

    def test_a_solution_passes_every_check(self, kernel):
        assert not any(kernel(self.BOOK))

    def test_what_students_get_passes_none_and_is_told_why(self, kernel):
        found = kernel([released(cell) for cell in self.BOOK])
        assert found[0] == "" and all(found[1:])
        assert found[1].startswith("ordinary angles: 0 of 3 points.\n  a quarter of a turn about z\n")
        assert "`raise NotImplementedError()`" in found[1]

    def test_a_wrong_one_has_the_marks_of_a_file_and_the_same_words(self, kernel):
        wrong = self.BOOK[0].replace("np.cos(theta)[", "np.cos(np.deg2rad(theta))[")
        wrong = wrong.replace("np.sin(theta)[", "np.sin(np.deg2rad(theta))[")
        # What a student tries besides is no part of it.
        found = kernel(["import os\nprint(os.name)", wrong, "rotation([0, 0, 1], 1)", *self.BOOK[1:]])[3:]
        assert [bool(text) for text in found] == [True, True, False, True, False, True]
        assert "taken for degrees" in found[0]
        assert "pixels are visibly others" in found[-1] and "off by" not in found[-1]

    def test_a_ready_answer_is_refused(self, kernel):
        cheat = (
            "from lietool.lie.so3 import from_axis_angle\ndef rotation(u, a): return from_axis_angle(u, a)"
        )
        found = kernel([cheat, *self.BOOK[1:2]])
        assert "lietool" in found[1] and "0 of 3 points" in found[1]

    def test_what_is_graded_has_another_seed_than_what_students_run(self):
        assert "seed = 7" in self.BOOK[1] and "7" not in released(self.BOOK[1])
        same = code(export_nbgrader.notebook(load.load("rodrigues")))
        assert same[1] == released(same[1]) and "seed" not in same[1]

    def test_a_notebook_shows_the_message_alone(self):
        assert notebook.Lost("a\nb")._render_traceback_() == ["a", "b"]

    def test_what_cannot_be_checked_is_said(self, monkeypatch):
        monkeypatch.delattr(sys.modules["__main__"], "In", raising=False)
        with pytest.raises(RuntimeError, match="this is no notebook"):
            notebook.check("rodrigues", "batches")
        monkeypatch.setattr(sys.modules["__main__"], "In", [""], raising=False)
        with pytest.raises(load.ExerciseError, match=r"has no check 'batch'\. Export"):
            notebook.check("rodrigues", "batch")
        monkeypatch.setattr(notebook, "_renderer", lambda: "nothing renders")
        with pytest.raises(RuntimeError, match="the picture cannot be judged here: nothing renders"):
            notebook.check("rodrigues", "the picture", seed=11)


class TestCourse:
    def test_it_has_the_layout_of_nbgrader(self):
        made = export_nbgrader.files(export.gather(("rodrigues", "cage-maps")), WHEEL)
        books = {f"source/{name}/{name}.ipynb" for name in ("rodrigues", "cage-maps")}
        pictures = {"source/rodrigues/B2.5.png", "source/cage-maps/B7.6.png"}
        assert set(made) == {*books, *pictures, "README.md", "nbgrader_config.py", WHEEL[0]}
        compile(made["nbgrader_config.py"], "nbgrader_config.py", "exec")
        assert b"@" not in made["README.md"]

    def test_checks_of_one_title_are_refused(self, monkeypatch):
        from dataclasses import replace

        exercise = load.load("rodrigues")
        with pytest.raises(ExportError, match="two checks have one title"):
            export_nbgrader.notebook(replace(exercise, checks=exercise.checks[:1] * 2))


def test_nbgrader_takes_it_through_a_term(tmp_path):
    """It validates, hands out, grades what comes back and exports marks; it runs where nbgrader is."""
    installed = pytest.importorskip("nbgrader", reason="nbgrader is 270 MB, and no part of the test extra")
    course = tmp_path / "course"
    export.publish(course, export_nbgrader.files(export.gather(("rodrigues",), 7), WHEEL))
    # It calls alembic by its name, which lies in the bin of the environment.
    programs = Path(installed.__file__).parents[4] / "bin"
    env = os.environ | {
        "PATH": f"{programs}:{os.environ['PATH']}",
        "HOME": str(tmp_path / "home"),
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
    }

    def nbgrader(*words):
        command = [sys.executable, "-m", "nbgrader", *words]
        done = subprocess.run(command, cwd=course, env=env, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "Success!" in nbgrader("validate", "source/rodrigues/rodrigues.ipynb")
    nbgrader("generate_assignment", "rodrigues")
    given = nbformat.read(course / "release/rodrigues/rodrigues.ipynb", 4)
    cells = export_nbgrader.notebook(load.load("rodrigues"), 7).cells
    assert [cell.source for cell in given.cells] == [released(cell.source) for cell in cells]
    assert "VALIDATION FAILED ON 6 CELL(S)!" in nbgrader("validate", "release/rodrigues/rodrigues.ipynb")
    right = code(export_nbgrader.notebook(load.load("rodrigues")))[0]
    for who, source in (
        ("ada", right),
        ("ben", right.replace("np.sin(theta)", "np.sin(-theta)")),
        ("cleo", ""),
    ):
        (cell,) = (cell for cell in given.cells if cell.id == "solution")
        cell.source = source
        (course / "submitted" / who / "rodrigues").mkdir(parents=True)
        nbformat.write(given, course / "submitted" / who / "rodrigues" / "rodrigues.ipynb")
    nbgrader("autograde", "rodrigues")
    nbgrader("export")
    with (course / "grades.csv").open() as file:
        marks = {row["student_id"]: float(row["raw_score"]) for row in csv.DictReader(file)}
    assert marks["ada"] == 10 and 0 < marks["ben"] < 5 and marks["cleo"] == 0
    graded = json.loads((course / "autograded/ben/rodrigues/rodrigues.ipynb").read_bytes())
    told = [
        line for cell in graded["cells"] for x in cell.get("outputs", ()) for line in x.get("traceback", ())
    ]
    assert any("turns the other way" in line for line in told)
