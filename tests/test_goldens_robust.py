"""What may happen to goldens while the program runs: no room, no right to write, kill -9, somebody else."""

import os
import resource
import shutil
import signal
import subprocess
import sys

import pytest
from click.testing import CliRunner

from lietool import figure
from lietool.cli import command

pytestmark = pytest.mark.usefixtures("canonical")

DOTS = '''
"""Toy."""

from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render.scene import Picture, Points, View


@figure(
    plates={
        "T1": Plate("One", (), "One."),
        "T2": Plate("Two", (), "Two.", {"count": 2}),
        "T3": Plate("Three", (), "Three.", {"count": 3}),
    }
)
def dots(count: Annotated[int, Param("how many", "", 1, 9)] = 1) -> Drawing:
    """Draw lines."""
    x = np.random.default_rng(SEED + count).uniform(5.0, 55.0, (40, 3)) * (1.0, 0.7, 0.0)
    return Drawing(Picture((View((Points(x, "#2b2f36", 6.0),)),), (60, 40)), {"x": x})
'''


@pytest.fixture
def course(tmp_path, monkeypatch):
    (tmp_path / "figures").mkdir()
    draw(tmp_path, 0)
    monkeypatch.setenv(figure.PROJECT, "")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def draw(course, seed):
    """Write the figure anew, of another length, by which Python knows that it has changed."""
    sys.modules.pop("lietool_project.dots", None)
    (course / "figures" / "dots.py").write_text(DOTS.replace("SEED", str(seed)))


def start(course, *words, before=(), **options):
    line = [*before, sys.executable, "-m", "lietool", "--project", ".", "figures", *words]
    return subprocess.Popen(
        line, cwd=course, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options
    )


def alone(course, *words, code, **options):
    """Run it in a process of its own, and return what it has to say."""
    with start(course, *words, **options) as process:
        said, wrong = process.communicate(timeout=120)
    assert process.returncode == code, said + wrong
    return wrong


def run(*words):
    """Run it here, where nothing is in its way."""
    result = CliRunner().invoke(command, ["--project", ".", "figures", *words])
    assert result.exit_code == 0, result.output
    return result.output


ACCEPT = ("accept", "--all", "--reason", "looked at")


def contents(course):
    return {path: path.read_bytes() for path in (course / "golden").rglob("*") if path.is_file()}


def bound_by_permissions():
    """A prefix under which even root may write only where the mode of a folder allows it."""
    if os.getuid() != 0:
        return []
    if shutil.which("setpriv") is None:
        pytest.skip("root may write everywhere, and there is no setpriv to forbid it")
    return ["setpriv", "--inh-caps=-dac_override", "--bounding-set=-dac_override"]


def test_a_folder_that_is_read_only_is_one_line(course):
    run(*ACCEPT)
    before = contents(course)
    draw(course, 77)
    golden = course / "golden"
    golden.chmod(0o555)
    try:
        wrong = alone(course, *ACCEPT, code=2, before=bound_by_permissions())
        assert "golden/T1.png cannot be written: Permission denied" in wrong and wrong.count("\n") == 1
        before[golden / "CHANGES.md"] = b"stale"
        (golden / "CHANGES.md").write_bytes(b"stale")
        wrong = alone(course, "gallery", "--readme", code=2, before=bound_by_permissions())
        assert "CHANGES.md cannot be written: Permission denied" in wrong and wrong.count("\n") == 1
    finally:
        golden.chmod(0o755)
    assert contents(course) == before


def test_no_room_for_a_picture_is_one_line(course):
    run(*ACCEPT)
    before = contents(course)
    draw(course, 77)
    small = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))}
    wrong = alone(course, *ACCEPT, code=2, **small)
    assert "golden/T1.png cannot be written: File too large" in wrong and wrong.count("\n") == 1
    assert contents(course) == before
    # The pictures of failures have to go somewhere as well.
    wrong = alone(course, "verify", "T1", code=2, **small)
    assert "out/failed cannot be written: File too large" in wrong and wrong.count("\n") == 1
    assert not list((course / "out").rglob("*.p*"))


def test_a_killed_accept_leaves_whole_goldens_and_the_next_one_goes_on(course):
    run("accept", "T1", "--reason", "looked at")
    draw(course, 77)
    with start(course, "accept", "--all", "--reason", "second") as process:
        assert process.stdout and process.stdout.readline().startswith("T1: ")
        process.send_signal(signal.SIGKILL)
    listed = [line.split() for line in run("list").splitlines()[1:]]
    states = {words[0]: words[2] for words in listed}
    assert states["T1"] == "golden" and set(states.values()) <= {"golden", "missing"}
    run(*ACCEPT)
    assert "3 plates: 3 as accepted" in run("verify")
    names = sorted(path.name for path in contents(course))
    assert names == ["CHANGES.md", "README.md", *(f"T{n}.{x}" for n in "123" for x in ("json", "png"))]
    text = (course / "golden" / "CHANGES.md").read_text()
    assert text.count(": second (") in (1, 2, 3) and text.count(": looked at (") >= 1


def test_two_at_once_wait_for_each_other_and_a_third_may_look_on(course):
    run("accept", "T1", "--reason", "looked at")
    draw(course, 77)
    both = [start(course, *ACCEPT) for _ in "ab"]
    looks = ""
    while any(process.poll() is None for process in both):
        looks += run("list")
    said = [process.communicate(timeout=120) for process in both]
    assert [process.returncode for process in both] == [0, 0], said
    # Whoever came second waited, and then found that nothing had changed.
    assert sorted(out.count("unchanged") for out, _ in said) == [0, 3]
    assert "T1" in looks and "half accepted" not in looks and "torn" not in looks
    assert "3 plates: 3 as accepted" in run("verify")
