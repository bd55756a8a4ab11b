"""`lietool figures noise`: on a project whose figure can be told to depend on the processor."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from lietool.golden import compare
from lietool.verbs import _noise_settings, _noise_worker

FIGURE = '''
"""Toy."""

import os
from typing import Annotated

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render.scene import Label, Lines, Picture, View


@figure(plates={"T1": Plate(title="A line", equations=(), caption="One.")})
def line(count: Annotated[int, Param("how many", "", 1, 9)] = 3) -> Drawing:
    """Draw a line."""
    old = "OPENBLAS_CORETYPE" in os.environ
    if os.environ.get("TOY_CRASHES") and old:
        os.abort()
    end = 40.0 + (9.0 if os.environ.get("TOY_MOVES") and old else 0.0)
    view = View((Lines([(10.0, 20.0, 0.0), (end, 20.0, 0.0)], "#2b2f36", 4.0),))
    return Drawing(Picture((view,), (60, 40)), {"end": end, "count": count})
'''


@pytest.fixture
def noise(tmp_path, canonical):
    folder = tmp_path / "figures" / "ch1"
    folder.mkdir(parents=True)
    (folder / "line.py").write_text(FIGURE)

    def run(*arguments, **variables):
        return subprocess.run(
            [sys.executable, "-m", "lietool", "--project", str(tmp_path), "figures", *arguments],
            capture_output=True,
            text=True,
            env=os.environ | variables,
        )

    assert run("noise", "T1", "--quick").returncode == 3
    assert run("accept", "T1", "--reason", "a test").returncode == 0
    return run


def test_what_is_harmless_is_no_alarm_and_what_depends_on_the_processor_is_one(noise):
    done = noise("noise", "T1", "--quick", "--json", "-j", "2")
    about = json.loads(done.stdout)
    assert done.returncode == 0 and about["alarms"] == []
    ways = len(about["settings"])
    (plate,) = about["plates"]
    # Three ways to compute; each way to render with and without jitter.
    assert ways == 4 and about["pictures"] == plate["pictures"] == 3 + 2 * ways
    assert plate["equal"] == 3 + ways and 0 < plate["lowpass"] < plate["lowpass_limit"]

    moved = noise("noise", "T1", "--quick", TOY_MOVES="1")
    assert moved.returncode == 5 and "alarm" in moved.stdout
    assert "end: expected 40.0, got 49.0" in moved.stdout and "in one place" in moved.stdout

    crashed = noise("noise", "T1", "--quick", TOY_CRASHES="1")
    assert crashed.returncode == 5 and "crashed with SIGABRT" in crashed.stdout
    assert "Traceback" not in crashed.stdout + crashed.stderr


def test_jitter_is_the_same_each_time_and_one_level_at_most():
    image = np.random.default_rng(0).integers(0, 256, (30, 40, 3), dtype=np.uint8)
    one, other = _noise_worker.jittered(image, "B2.8"), _noise_worker.jittered(image, "B2.8")
    step = one.astype(int) - image
    assert (one == other).all() and np.abs(step).max() == 1
    assert set(np.unique(step)) == {-1, 0, 1} and not compare.images(image, one).over


def test_every_setting_is_there_once_and_decides_its_variables(monkeypatch):
    ways = _noise_settings.every()
    assert len(set(ways)) == len(ways) == 2 * 4 * 4 * 2 + 2 and set(_noise_settings.few()) < set(ways)
    monkeypatch.setenv("LP_NUM_THREADS", "5")
    monkeypatch.setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse2")
    found = _noise_settings.environment(_noise_settings.Setting("egl", 7, "", 128), "there")
    assert found["LP_NUM_THREADS"] == "7" and "GALLIUM_OVERRIDE_CPU_CAPS" not in found
    assert (found["LIETOOL_BACKEND"], found["LP_NATIVE_VECTOR_WIDTH"]) == ("egl", "128")
    with_caps = _noise_settings.environment(_noise_settings.Setting(caps="sse4.1"), "there")
    assert with_caps["GALLIUM_OVERRIDE_CPU_CAPS"] == "sse4.1"
