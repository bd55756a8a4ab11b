"""A folder of one's own, with figures and goldens, used as a teacher does: from anywhere, beside the book."""

import json
import os
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from lietool import figure, paths
from lietool.cli import command

TURN = '''
"""Toy."""

from pathlib import Path
from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render import scene
from lietool.render.camera import Camera

from .{dots}_frames import pair

HERE = Path(__file__).parent


@figure(
    plates={{
        "X{n}": Plate("A turned frame", (), "A frame before and after a rotation about z."),
        "X{n}b": Plate("From a file", (), "As a file says.", {{"angles": HERE / "angles.txt"}}),
    }}
)
def {name}(
    theta: Annotated[float, Param("angle about z", "deg", -360.0, 360.0)] = 50.0,
    angles: Annotated[Path | None, Param("a file with an angle")] = None,
) -> Drawing:
    """A frame before and after a rotation.

    What to look for: the blue axis stays where it is.
    """
    R, records = pair(float(angles.read_text()) if angles else theta)
    return Drawing(scene.Picture((scene.View(records, Camera()),), (80, 60)), {{"rotation": R}})
'''
PART = '''
"""What both figures draw."""

import numpy as np

from lietool.lie import so3
from lietool.render import scene


def pair(theta):
    R = so3.rotation("z", np.deg2rad(theta))
    return R, (scene.Frame(np.eye(3), radius=0.008), scene.Frame(R, radius=0.03))
'''


@pytest.fixture
def course(tmp_path, monkeypatch):
    """A course in a folder with a blank in its name; the working folder is beside it."""
    folder = tmp_path / "my course"
    week = folder / "figures" / "week 1.2"
    week.mkdir(parents=True)
    (folder / "figures" / "_frames.py").write_text(PART)
    (folder / "figures" / "turn.py").write_text(TURN.format(dots="", n=1, name="turn"))
    (week / "again.py").write_text(TURN.format(dots=".", n=2, name="again"))
    for place in (folder / "figures", week):
        (place / "angles.txt").write_text("75")
    # Set by the option, and to be forgotten after the test.
    monkeypatch.setenv(figure.PROJECT, "")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    return folder


def run(folder, *words, code=0):
    result = CliRunner().invoke(command, ["--project", str(folder), *words])
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output
    return result.output


def own(folder, *words, code=0):
    return run(folder, "figures", *words, code=code)


def test_without_names_it_is_the_plates_of_the_project(course):
    rows = json.loads(own(course, "list", "--json"))
    assert [row["plate"] for row in rows] == ["X1", "X1b", "X2", "X2b"]
    # The book's are there all the same.
    assert [row["plate"] for row in json.loads(own(course, "list", "b2.8", "turn", "--json"))] == [
        "B2.8",
        "X1",
        "X1b",
    ]
    assert "slerp" in run(course, "--help") and "again" in run(course, "--help")


def test_the_whole_way(course, tmp_path, canonical):
    """Accept, verify, gallery, check; then in another folder, with two processes, from a relative path."""
    book = {path: path.stat().st_mtime_ns for path in paths.GOLDEN.glob("*.md")}
    said = own(course, "verify", code=3)
    assert "lietool --project '" in said and "figures accept X1 --reason" in said
    own(course, "accept", "--all", "--reason", "first version")
    assert {path: path.stat().st_mtime_ns for path in paths.GOLDEN.glob("*.md")} == book
    golden = course / "golden"
    assert sorted(path.name for path in golden.iterdir()) == [
        "CHANGES.md", "README.md", "X1.json", "X1.png", "X1b.json", "X1b.png", "week 1.2",
    ]  # fmt: skip
    assert "first version (new)" in (golden / "CHANGES.md").read_text()
    run(course, "again", "--plate", "X2b", "-o", "mine.png")
    assert run(course, "check", "mine.png").splitlines() == ["X2b  From a file", "equal"]

    # As a checkout on another machine is: the paths in the goldens must not know where they were made.
    shutil.move(course, tmp_path / "checkout")
    moved = os.path.relpath(tmp_path / "checkout")
    assert "4 plates: 4 as accepted, 0 not." in own(moved, "verify", "-j", "2")
    own(moved, "gallery", "--golden")
    page = Path("out/gallery/index.html").read_text()
    assert "checkout" in page and "B2.8" not in page
    own(moved, "report", "-o", "report.html")
    page = Path("report.html").read_text()
    assert f"lietool --project {moved} figures accept --from review.json" in page and "B2.8" not in page
    # A drawing that has changed, and a golden that belongs to nobody.
    (Path(moved) / "figures" / "angles.txt").write_text("76")
    said = own(moved, "verify", "X1b", code=5)
    assert "the golden was made from other files: angles was " in said
    (Path(moved) / "golden" / "X9.png").write_bytes(b"")
    assert "X9.png belongs to no plate" in own(moved, "verify", code=3)


def test_two_projects_do_not_get_in_each_others_way(course, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(course, other)
    (other / "figures" / "_frames.py").write_text(
        PART.replace("pair(theta):", "pair(theta):\n    theta = 0.0")
    )
    turned = json.loads(run(course, "turn", "--json"))["rotation"]
    assert json.loads(run(other, "turn", "--json"))["rotation"] != turned
    assert json.loads(run(course, "again", "--json"))["rotation"] == turned


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("slerp.py", TURN.format(dots="", n=3, name="slerp"), "two files make the command slerp"),
        ("other.py", TURN.format(dots="", n=1, name="other"), "two files have the plate X1"),
        ("torn.py", "def torn(:", "torn.py: line 1: "),
        ("nothing.py", "x = 1", "no function nothing with @figure"),
    ],
)
def test_a_file_that_cannot_be_a_figure_is_one_line(course, name, text, words):
    (course / "figures" / name).write_text(text)
    said = own(course, "verify", code=2)
    assert words in said and said.count("\n") == 1


def test_a_part_that_is_missing_is_one_line(course):
    (course / "figures" / "_frames.py").unlink()
    said = run(course, "turn", code=2)
    assert "turn.py: No module named 'lietool_project._frames'" in said and said.count("\n") == 1


def test_a_project_without_figures_does_not_pass(tmp_path, monkeypatch):
    monkeypatch.setenv(figure.PROJECT, "")
    assert "must be a folder with a folder figures/ in it" in own(tmp_path, "verify", code=2)
    (tmp_path / "figures").mkdir()
    assert "there is no plate to compare" in own(tmp_path, "verify", code=2)
    assert "there is no plate to compare" in own(tmp_path, "report", code=2)
