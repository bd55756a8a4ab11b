"""Plates in several processes: the same verdicts and the same bytes as in one, and a death is one line."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lietool.render import context
from lietool.verbs import _jobs, _studio

FILE = '''
"""Toy."""

import os
import pathlib
import time
from typing import Annotated

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render.scene import Lines, Picture, View


@figure(
    plates={
        "T1": Plate(title="One", equations=(), caption="One."),
        "T2": Plate(title="Two", equations=(), caption="Two.", params={"count": 2}),
        "T3": Plate(title="Three", equations=(), caption="Three.", params={"count": 3}),
    }
)
def strokes(
    count: Annotated[int, Param("how many", "", 1, 9)] = 1,
    die: Annotated[bool, Param("end the process")] = False,
) -> Drawing:
    """Draw strokes."""
    if die or os.environ.get("STROKES_DIE"):
        os._exit(9)
    if what := os.environ.get("STROKES_FAIL"):
        raise {"refuse": ValueError("no\\nstrokes"), "break": KeyError("x")}[what]
    if beside := os.environ.get("STROKES_WAIT"):
        pathlib.Path(beside, f"{os.getpid()}.pid").touch()
        time.sleep(600)
    rows = [Lines([(5.0, 4.0 + 4.0 * k, 0.0), (55.0, 5.0 + 4.0 * k, 0.0)], "#2b2f36") for k in range(count)]
    return Drawing(Picture((View(tuple(rows)),), (60, 40)), {"count": count})
'''


@pytest.fixture
def project(tmp_path):
    (tmp_path / "figures" / "ch9").mkdir(parents=True)
    (tmp_path / "figures" / "ch9" / "strokes.py").write_text(FILE)
    return tmp_path


def call(project: Path, line: str, **environment: str) -> subprocess.CompletedProcess:
    words = [sys.executable, "-m", "lietool", "--project", str(project), "figures", *line.split()]
    return subprocess.run(
        words, cwd=project, capture_output=True, text=True, timeout=120, env=os.environ | environment
    )


def test_two_processes_make_what_one_makes(project):
    context.get()
    assert call(project, "accept T1 T2 --reason r").returncode == 0
    one = call(project, "verify strokes --json --jobs 1 -o one")
    two = call(project, "verify strokes --json --jobs 2 -o two")
    # T3 has no golden.
    assert (one.returncode, two.returncode) == (3, 3)
    first, second = json.loads(one.stdout), json.loads(two.stdout)
    assert [plate["verdict"] for plate in first["plates"]][:2] == ["equal", "equal"]
    assert json.dumps(second).replace("two/failed", "one/failed") == json.dumps(first)
    assert call(project, "build strokes -j 1 -o one").returncode == 0
    assert call(project, "build strokes -j 2 -o two").returncode == 0
    from PIL import Image

    for plate in ("T1", "T2", "T3"):
        images = [Image.open(project / folder / f"{plate}.png") for folder in ("one", "two")]
        assert images[0].tobytes() == images[1].tobytes()


def test_a_process_that_dies_is_one_line(project):
    context.get()
    done = call(project, "build strokes --jobs 2", STROKES_DIE="1")
    assert done.returncode == 1
    assert "one of 2 processes died" in done.stderr and "Traceback" not in done.stderr
    assert not list(project.glob("out/*"))


def test_an_error_of_a_plate_keeps_its_code(project):
    (project / "out").write_text("a file where the folder should be")
    done = call(project, "build strokes --jobs 2")
    assert done.returncode == 2 and done.stderr.count("\n") == 1


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_names_the_plate_and_the_line(project, jobs):
    context.get()
    refused = call(project, f"build strokes --jobs {jobs}", STROKES_FAIL="refuse")
    assert (refused.returncode, refused.stderr) == (2, "lietool figures: T1: no strokes\n")
    broken = call(project, f"build strokes --jobs {jobs}", STROKES_FAIL="break")
    assert broken.returncode == 1 and broken.stderr.count("\n") == 1
    assert "KeyError: 'x' (plate T1, strokes.py, line " in broken.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_the_one_that_started_it(project, how):
    context.get()
    words = [sys.executable, "-m", "lietool", "--project", str(project), "figures", "build", "strokes", "-j2"]
    environment = os.environ | {"STROKES_WAIT": str(project)}
    # Whatever runs the tests in the background has them ignore Ctrl-C, which would be inherited.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        parent = subprocess.Popen(words, cwd=project, env=environment, stderr=subprocess.DEVNULL)
    finally:
        signal.signal(signal.SIGINT, before)
    try:
        _until(lambda: len(list(project.glob("*.pid"))) == 2)
        parent.send_signal(how)
        assert parent.wait(30) == (130 if how == signal.SIGINT else -how)
    finally:
        parent.kill()
        parent.wait()
    workers = [int(path.stem) for path in project.glob("*.pid")]
    _until(lambda: not any(map(_lives, workers)))
    assert not list(project.glob("out/*"))


def _until(done) -> None:
    for _ in range(600):
        if done():
            return
        time.sleep(0.1)
    raise AssertionError("waited in vain")


def _lives(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize("jobs", ["0", "-1", "two", "1000"])
def test_a_number_of_processes_that_is_none_is_refused(project, jobs):
    done = call(project, f"build strokes --jobs={jobs}")
    assert done.returncode == 2 and "--jobs" in done.stderr and "Traceback" not in done.stderr


def test_processors_are_shared(monkeypatch):
    monkeypatch.setattr(_jobs.sys, "platform", "other")
    monkeypatch.setattr(_jobs.os, "cpu_count", lambda: 8)
    assert [_jobs.threads(jobs) for jobs in (1, 2, 3, 8, 20)] == [8, 4, 2, 1, 1]


def test_one_job_stays_in_this_process():
    items = [_studio.Item("T1", "strokes"), _studio.Item("T2", "strokes")]
    seen = []
    assert list(_jobs.each(lambda item: seen.append(item) or item.id, items, 1, "")) == ["T1", "T2"]
    assert seen == items
