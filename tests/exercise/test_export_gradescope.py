"""An assignment at Gradescope: its zip is unpacked and run as there, and what was handed in is found."""

import base64
import io
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lietool.exercise import export, export_gradescope, export_wheel, gradescope, load
from lietool.exercise.outcome import Finding, Graded, Outcome, Shown

RIGHT = load.load("rodrigues").solution_source
# A typical one: degrees.
WRONG = RIGHT.replace("np.cos(theta)[", "np.cos(np.deg2rad(theta))[").replace(
    "np.sin(theta)[", "np.sin(np.deg2rad(theta))["
)
SETTINGS = {"exercises": ["rodrigues"], "seed": 3, "visibility": "visible", "stdout_visibility": "hidden"}
# What Gradescope knows.
TOP = {"score", "output", "output_format", "visibility", "stdout_visibility", "tests", "extra_data"}
TEST = {"score", "max_score", "status", "name", "number", "output", "output_format", "visibility"}


@pytest.fixture
def root(tmp_path):
    """The folder that is ``/autograder`` there."""

    def make(files, **settings):
        (tmp_path / "source").mkdir(exist_ok=True)
        (tmp_path / "source" / "assignment.json").write_text(json.dumps(SETTINGS | settings))
        for name, data in files.items():
            path = tmp_path / "submission" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return tmp_path

    return make


@pytest.fixture
def graded(monkeypatch):
    """What was graded; it has 4 of 7 points."""
    seen = []

    def grade(exercise, source, *, seed, name=""):
        seen.append((exercise.name, source, seed, name))
        wrong = Finding("the <b>plate</b>", False, off="5 pixels are others")
        outcomes = (Outcome("numbers", "cases", 4, 4), Outcome("the picture", "picture", 0, 3, (wrong,)))
        image = np.arange(5 * 7 * 3, dtype=np.uint8).reshape(5, 7, 3)
        shown = Shown("B2.5", image, image[::-1], '5 "others"')
        return Graded(exercise.name, "T", outcomes, ("It is <half>.",), seed, "d1", "<i>hi", shown)

    monkeypatch.setattr(gradescope, "grade", grade)
    monkeypatch.setattr(gradescope, "require_renderer", lambda: None)
    return seen


def seen_in(page: str) -> list[np.ndarray]:
    """The pictures of a page."""
    parts = page.split('<img src="data:image/png;base64,')[1:]
    return [np.asarray(Image.open(io.BytesIO(base64.b64decode(x.partition('"')[0])))) for x in parts]


def test_the_zip_is_run_as_gradescope_runs_it(tmp_path):
    """It is set up from nothing but its own wheel, and grades by that; packages beside come from here."""
    assignment = export.gather(("rodrigues",), 3)
    data = export_gradescope.files(assignment, export_wheel.wheel())["autograder.zip"]
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        # At the root of the archive, where they are looked for.
        assert {"setup.sh", "run_autograder"} <= set(archive.namelist())
        archive.extractall(tmp_path / "source")
    (tmp_path / "submission").mkdir()
    (tmp_path / "submission" / "rodrigues.py").write_text(WRONG + "print('hello')\n")
    packages = str(Path(np.__file__).parents[1])
    env = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL"))}
    env |= {
        "AUTOGRADER_ROOT": str(tmp_path),
        "PYTHONPATH": packages,
        "PIP_NO_DEPS": "1",
        "PIP_NO_INDEX": "1",
        "PIP_NO_COMPILE": "1",
    }
    env |= {"PATH": f"{Path(sys.executable).parent}:{env['PATH']}"}
    for script in ("setup.sh", "run_autograder"):
        command = ["bash", tmp_path / "source" / script]
        done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_bytes())
    made = {test["name"]: test.get("score") for test in results["tests"]}
    assert results["score"] == sum(filter(None, made.values())) == 2
    assert made["ordinary angles"] == 0 and made["laws of rotations"] == 1
    assert "taken for degrees" in results["output"] and results["tests"][-1]["output"] == "hello\n"
    (page,) = (test["output"] for test in results["tests"] if test["output_format"] == "html")
    student, reference = seen_in(page)
    assert student.shape == reference.shape and (student != reference).any()


def test_a_solution_has_full_marks_twice_the_same(root):
    folder = root({"rodrigues.py": RIGHT})
    made = gradescope.results(folder)
    assert made["score"] == 10 and set(made) == TOP
    assert all(set(test) == TEST and test["status"] == "passed" for test in made["tests"])
    assert json.dumps(made) == json.dumps(gradescope.results(folder))
    assert len(seen_in(made["tests"][-1]["output"])) == 1


class TestResults:
    def test_scores_words_and_pictures_are_where_gradescope_looks_for_them(self, root, graded):
        made = gradescope.results(root({"rodrigues.py": "x"}, visibility="after_due_date"))
        assert (made["score"], made["stdout_visibility"]) == (4, "hidden")
        assert [(x["name"], x.get("score"), x.get("max_score"), x["status"]) for x in made["tests"]] == [
            ("numbers", 4, 4, "passed"),
            ("the picture", 0, 3, "failed"),
            ("What rodrigues.py printed", None, None, "passed"),
        ]
        assert {x["visibility"] for x in made["tests"]} == {"after_due_date"}
        assert made["extra_data"]["sha256"] == {"rodrigues": "d1"}

    def test_only_what_we_wrote_is_html(self, root, graded):
        made = gradescope.results(root({"rodrigues.py": "x"}))
        assert made["output_format"] == "text" and "<half>" in made["output"]
        formats = {x["name"]: x["output_format"] for x in made["tests"]}
        assert formats["What rodrigues.py printed"] == "text" and formats["the picture"] == "html"
        page = made["tests"][1]["output"]
        assert "&lt;b&gt;plate" in page and "5 &quot;others&quot;" in page and "<b>" not in page
        assert [x.shape for x in seen_in(page)] == [(2, 3, 3)] * 2

    def test_of_several_exercises_each_is_numbered(self, root, graded):
        made = gradescope.results(
            root({"a.py": "x", "cage_maps.py": "y"}, exercises=["rodrigues", "cage-maps"])
        )
        assert [name for name, *_ in graded] == ["cage-maps"]
        missing = [x for x in made["tests"] if x["number"].startswith("1.")]
        assert sum(x["max_score"] for x in missing) == 10 and not any(x["score"] for x in missing)
        assert missing[0]["name"] == "The rotation about an axis: ordinary angles"
        assert "`# lietool exercise: rodrigues`" in missing[0]["output"]
        assert "rodrigues: 0 of 10 points." in made["output"] and "cage-maps: 4 of 7" in made["output"]

    @pytest.mark.parametrize(
        ("files", "taken"),
        [
            ({"mine.py": "1"}, "mine.py"),
            ({"deep/er/mine.py": "1", "notes.txt": "2"}, "mine.py"),
            ({"rodrigues.py": "1", "other.py": "2"}, "rodrigues.py"),
            ({"mine.py": "# lietool exercise: rodrigues\n", "rodrigues.py": "2"}, "mine.py"),
            (
                {
                    "a.py": "# lietool exercise: rodrigues\n",
                    "b/rodrigues.py": "# lietool exercise: rodrigues\n",
                },
                "b",
            ),
            ({"mine.py": b"\xef\xbb\xbf# lietool exercise: rodrigues\n", "other.py": "2"}, "mine.py"),
            ({"mine.py": "1", "__MACOSX/mine.py": "2", ".git/x.py": "3", "._mine.py": "4"}, "mine.py"),
        ],
    )
    def test_the_file_is_found(self, root, graded, files, taken):
        gradescope.results(root(files))
        assert graded[0][3] == (taken if taken.endswith(".py") else "rodrigues.py")
        assert not graded[0][1].startswith("\ufeff")

    @pytest.mark.parametrize(
        ("files", "words"),
        [
            ({}, "Nothing was handed in"),
            ({"a.py": "1", "b.py": "2"}, "Nothing was handed in"),
            (
                {f"{x}.py": "# lietool exercise: rodrigues\n" for x in "ab"},
                "There are 2 files for it, a.py, b.py",
            ),
            ({"rodrigues.py": b"\xff\xfe"}, "rodrigues.py cannot be read"),
            ({"rodrigues.py": b" " * (1 << 20) + b"1"}, "rodrigues.py cannot be read"),
        ],
    )
    def test_what_cannot_be_graded_has_no_points_and_is_told_why(self, root, graded, files, words):
        made = gradescope.results(root(files))
        assert made["score"] == 0 and not graded and words in made["output"]
        assert all(words in test["output"] for test in made["tests"])

    def test_a_link_is_nothing_that_was_handed_in(self, root, graded):
        folder = root({"notes.txt": ""})
        (folder / "submission" / "rodrigues.py").symlink_to(folder / "source" / "assignment.json")
        (folder / "submission" / "all").symlink_to(folder)
        assert "Nothing was handed in" in gradescope.results(folder)["output"]


class TestMain:
    def test_a_broken_grader_takes_nobodys_points(self, root, capsys, monkeypatch):
        """Without results Gradescope says that the autograder failed."""
        folder = root({"rodrigues.py": RIGHT}, exercises=["nonesuch"])
        assert gradescope.main([str(folder)]) == 1
        assert "lietool: ExerciseError: no exercise 'nonesuch'" in capsys.readouterr().err

        def lost():
            raise RuntimeError("nothing renders")

        monkeypatch.setattr(gradescope, "require_renderer", lost)
        assert gradescope.main([str(root({}))]) == 1
        assert "nothing renders" in capsys.readouterr().err
        assert not (folder / "results").exists()

    def test_an_image_whose_solutions_lose_points_is_not_made(self, root, graded, capsys, monkeypatch):
        folder = root({})
        assert gradescope.main([str(folder), "--try"]) == 1
        assert "the picture: 0 of 3 points" in capsys.readouterr().out

    def test_results_are_written_whole(self, root, graded, capsys):
        folder = root({"rodrigues.py": "x"})
        assert gradescope.main([str(folder)]) == 0
        assert json.loads((folder / "results" / "results.json").read_bytes())["score"] == 4
        assert capsys.readouterr().out.startswith("rodrigues: 4 of 7 points.")


@pytest.mark.parametrize(("count", "minutes"), [(1, 10), (20, 20)])
def test_the_time_that_is_asked_for_is_enough_where_all_hangs(count, minutes):
    assignment = export.Assignment((load.load("rodrigues"),) * count)
    readme = export_gradescope.files(assignment, ("x.whl", b""))["README.md"].decode()
    assert f"a time limit of {minutes} minutes" in readme and "@" not in readme
