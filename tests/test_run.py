"""`./run` and `.ci/run` with a stand-in for Python, so that nothing is fetched or installed."""

import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="./run is for Linux")

# Makes environments out of itself, notes what it is asked, and waits while there is a gate.
STAND_IN = """#!/bin/sh
[ -z "${PYTHONHOME-}${PYTHONPATH-}${PIP_TARGET-}" ] || echo leaked >>"$NOTES"
case "$*" in
"-c import ensurepip") ;;
"-m venv"*)
    echo venv >>"$NOTES"
    for folder; do :; done
    mkdir -p "$folder/bin"
    ln -s "$0" "$folder/bin/python"
    echo "command = python3 -m venv $PWD/$folder" >"$folder/pyvenv.cfg"
    printf '#!%s/bin/python\\n' "$PWD/$folder" >"$folder/bin/tool"
    ;;
"-m pip install"*)
    echo "$*" >>"$NOTES"
    if [ -p "$GATE" ]; then read -r _ <"$GATE"; fi
    exit "${PIP_STATUS-0}"
    ;;
"-m "*) echo "$*" ;;
*lietool.render*) ;;
*) exec "$REAL" "$@" ;;
esac
"""


class Clone:
    """A copy of what `./run` reads, in a folder with a space in its name."""

    def __init__(self, tmp_path: Path) -> None:
        self.notes, self.gate = tmp_path / "notes", tmp_path / "gate"
        self.root = tmp_path / "my clone"
        self.root.mkdir()
        for name in ("run", "pyproject.toml", "requirements.lock"):
            shutil.copy(ROOT / name, self.root)
        stand_in = tmp_path / "bin" / "python3"
        stand_in.parent.mkdir()
        stand_in.write_text(STAND_IN)
        stand_in.chmod(0o755)
        self.environment = {
            "PATH": f"{stand_in.parent}:/usr/bin:/bin",
            "NOTES": str(self.notes),
            "GATE": str(self.gate),
            "REAL": sys.executable,
        }

    def start(self, *arguments: str, folder: Path | None = None, **environment: str) -> subprocess.Popen:
        return subprocess.Popen(
            [self.root / "run", *arguments],
            cwd=folder or self.root,
            env=self.environment | environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, *arguments: str, **options) -> tuple[int, str, str]:
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err

    def asked(self) -> list[str]:
        """What Python was asked since the last call."""
        if not self.notes.exists():
            return []
        lines = self.notes.read_text().splitlines()
        self.notes.unlink()
        return ["venv" if line == "venv" else line.rpartition(" ")[2] for line in lines]

    def start_and_stop_in_pip(self, *arguments: str) -> subprocess.Popen:
        os.mkfifo(self.gate)
        process = self.start(*arguments)
        deadline = time.monotonic() + 60
        while "pip install" not in (self.notes.read_text() if self.notes.exists() else ""):
            assert time.monotonic() < deadline and process.poll() is None
            time.sleep(0.01)
        return process

    def open_gate(self) -> None:
        descriptor = os.open(self.gate, os.O_RDWR)
        self.gate.unlink()
        os.write(descriptor, b"\n")
        os.close(descriptor)


WHOLE = ["venv", "requirements.lock", "."]
RUNTIME = ["venv", ".venv.tmp/runtime.lock", "."]


@pytest.fixture
def clone(tmp_path):
    return Clone(tmp_path)


def test_help_names_every_command(clone):
    status, out, _ = clone.run("help")
    commands = re.findall(r"^([a-z]+)(?: \|.*)?\)", (ROOT / "run").read_text(), re.MULTILINE)
    assert status == 0 and commands and all(f"./run {command}" in out for command in commands)
    assert clone.run() == (0, out, "") and clone.asked() == []


def test_an_unknown_command_exits_2(clone):
    status, out, err = clone.run("figure")
    assert status == 2 and out == "" and "no command figure" in err and "./run figures" in err


def test_the_first_run_builds_and_the_second_does_nothing(clone):
    status, out, err = clone.run("figures", "--draft", "a b")
    assert (status, out) == (0, "-m lietool figures build --draft a b\n") and "building .venv" in err
    assert clone.asked() == RUNTIME
    assert clone.run("figures", folder=Path("/")) == (0, "-m lietool figures build\n", "")
    assert clone.asked() == []


def test_run_time_packages_only_until_tests_ask_for_more(clone):
    clone.run("figures")
    text = (clone.root / ".venv" / "runtime.lock").read_text()
    assert "numpy==" in text and "pytest==" not in text
    clone.asked()
    # What the caller says comes last, and so wins: `-n 0` is one process.
    assert re.fullmatch(r"-m pytest -n auto .* -n 0 -k so3\n", clone.run("test", "-n", "0", "-k", "so3")[1])
    assert clone.asked() == ["requirements.lock"]
    assert clone.run("test")[2] == clone.run("figures")[2] == ""
    assert clone.asked() == []


def test_tests_first_build_everything_at_once(clone):
    clone.run("test")
    clone.run("figures")
    assert clone.asked() == WHOLE


def test_scripts_name_the_environment_by_its_final_place(clone):
    clone.run("figures")
    tool = (clone.root / ".venv" / "bin" / "tool").read_text()
    assert tool == f"#!{clone.root}/.venv/bin/python\n"


def test_a_changed_lock_builds_anew(clone):
    clone.run("test")
    (clone.root / ".venv" / "sys").mkdir()
    with (clone.root / "requirements.lock").open("a") as lock:
        lock.write("# changed\n")
    clone.asked()
    assert clone.run("test")[0] == 0 and clone.asked() == WHOLE
    assert (clone.root / ".venv" / "sys").is_dir()
    assert not list(clone.root.glob(".venv.[!l]*"))


def test_a_changed_project_is_installed_again(clone):
    clone.run("figures")
    with (clone.root / "pyproject.toml").open("a") as project:
        project.write("# changed\n")
    clone.asked()
    clone.run("figures")
    assert clone.asked() == ["."]


def test_a_moved_clone_builds_anew(clone):
    clone.run("figures")
    clone.root = clone.root.rename(clone.root.with_name("elsewhere"))
    clone.asked()
    clone.run("figures")
    assert clone.asked() == RUNTIME


def test_another_run_waits_and_says_so(clone):
    first = clone.start_and_stop_in_pip("figures")
    second = clone.start("figures")
    assert second.stderr is not None and "waiting" in second.stderr.readline()
    clone.open_gate()
    for process in (first, second):
        assert process.communicate(timeout=60)[0] == "-m lietool figures build\n" and process.returncode == 0
    assert clone.asked() == RUNTIME


def test_a_killed_run_leaves_nothing_that_hinders_the_next(clone):
    first = clone.start_and_stop_in_pip("figures")
    os.killpg(first.pid, signal.SIGKILL)
    first.communicate()
    assert (clone.root / ".venv.tmp").is_dir() and not (clone.root / ".venv").exists()
    clone.gate.unlink()
    clone.asked()
    status, _, err = clone.run("figures")
    assert status == 0 and "waiting" not in err and clone.asked() == RUNTIME


def test_what_a_killed_run_had_started_is_waited_for(clone):
    first = clone.start_and_stop_in_pip("figures")
    first.kill()
    first.wait()
    second = clone.start("figures")
    assert second.stderr is not None and "waiting" in second.stderr.readline()
    clone.open_gate()
    second.communicate(timeout=60)
    first.communicate()
    assert second.returncode == 0 and clone.asked() == [*RUNTIME[:2], *RUNTIME]


def test_killed_between_the_two_renames(clone):
    clone.run("figures")
    (clone.root / ".venv").rename(clone.root / ".venv.tmp")
    (clone.root / ".venv.old").mkdir()
    clone.asked()
    assert clone.run("figures")[0] == 0 and clone.asked() == []
    assert not list(clone.root.glob(".venv.[!l]*"))


def test_killed_while_packages_for_tests_were_added(clone):
    clone.run("figures")
    (clone.root / ".venv" / "adding").touch()
    clone.asked()
    assert clone.run("figures")[2] == ""
    assert clone.run("test")[0] == 0 and clone.asked() == WHOLE


def test_a_failed_install_is_reported_and_tried_again(clone):
    status, out, err = clone.run("figures", PIP_STATUS="1")
    assert (status, out) == (1, "") and "pip could not install" in err
    assert not (clone.root / ".venv").exists()
    assert clone.run("figures")[0] == 0


def test_an_environment_of_someone_else_is_left_alone(clone):
    (clone.root / ".venv").mkdir()
    status, _, err = clone.run("figures")
    assert status == 1 and "not made by ./run" in err and list((clone.root / ".venv").iterdir()) == []


def test_a_python_that_is_too_old_is_refused(clone, tmp_path):
    old = tmp_path / "old"
    old.write_text("#!/bin/sh\necho 3.10\n")
    old.chmod(0o755)
    status, _, err = clone.run("figures", PYTHON=str(old))
    assert status == 1 and f"found {old} (3.10)" in err and "3.11" in err and "PYTHON=" in err


def test_settings_for_another_python_do_not_reach_this_one(clone):
    clone.run("figures", PYTHONHOME="/nowhere", PYTHONPATH="/nowhere", PIP_TARGET="/nowhere")
    assert clone.asked() == RUNTIME


def _locked() -> tuple[dict[str, str], dict[str, str]]:
    parts = (ROOT / "requirements.lock").read_text().split("\n# == test ==\n")
    runtime, test = (dict(re.findall(r"^([a-z0-9-]+)==(\S+)", part, re.MULTILINE)) for part in parts)
    return runtime, test


def test_the_lock_holds_what_the_project_asks_for():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    runtime, test = _locked()
    asked = project["project"]["dependencies"] + project["build-system"]["requires"]
    extras = project["project"]["optional-dependencies"]["test"]
    for lines, locked in ((asked, runtime), (extras, runtime | test)):
        for requirement in map(Requirement, lines):
            version = locked[canonicalize_name(requirement.name)]
            assert requirement.specifier.contains(version), f"{requirement}: ./run lock"
    assert not runtime.keys() & test.keys()


def test_every_package_in_the_lock_has_hashes_and_none_a_place():
    text = (ROOT / "requirements.lock").read_text()
    blocks = re.split(r"\n(?=\S)", text)
    assert all("--hash=sha256:" in block for block in blocks if not block.startswith("#"))
    assert "://" not in text and "--index" not in text


def system(tmp_path: Path, *missing: str) -> Path:
    """A folder with the programs of the system that `./run` uses, and an apt-get that only notes."""
    folder = tmp_path / "system"
    folder.mkdir()
    for name in ("sh", "env", "id", "readlink", "dirname", "basename", "cat", "grep", "tail", "rm"):
        (folder / name).symlink_to(shutil.which(name) or f"/usr/bin/{name}")
    scripts = {
        "sudo": 'shift; exec "$@"',
        "apt-get": 'echo "$*" >>"$NOTES"; exit "${APT_STATUS-0}"',
        "chromium": "",
        "chromedriver": "",
    }
    for name in scripts.keys() - set(missing):
        (folder / name).write_text(f"#!/bin/sh\n{scripts[name]}\n")
        (folder / name).chmod(0o755)
    return folder


class TestBrowser:
    def test_one_that_is_there_is_left_alone(self, clone, tmp_path):
        assert clone.run("browser", PATH=str(system(tmp_path))) == (0, "", "") and clone.asked() == []

    @pytest.mark.parametrize("missing", ["chromium", "chromedriver"])
    def test_one_that_is_not_is_installed_with_its_driver(self, clone, tmp_path, missing):
        status, _, err = clone.run("browser", PATH=str(system(tmp_path, missing)))
        (asked,) = clone.notes.read_text().splitlines()
        assert status == 0 and "installing Chromium" in err
        assert asked.endswith("install -y --no-install-recommends chromium chromium-driver")
        assert not (clone.root / ".venv").exists() and not (clone.root / ".venv.log").exists()

    def test_a_failure_is_one_of_the_command(self, clone, tmp_path):
        status, _, err = clone.run("browser", PATH=str(system(tmp_path, "chromium")), APT_STATUS="1")
        assert status == 1 and "apt-get could not install it" in err

    def test_where_there_is_no_apt_it_says_what_is_wanted(self, clone, tmp_path):
        status, _, err = clone.run("browser", PATH=str(system(tmp_path, "chromium", "apt-get")))
        assert status == 1 and "apt-get install chromium chromium-driver" in err


@pytest.mark.parametrize(
    ("lint", "test", "browser", "expected"), [(0, 0, 0, 0), (1, 0, 0, 1), (0, 5, 0, 1), (0, 0, 1, 1)]
)
def test_ci_fails_with_its_parts_and_wants_a_renderer_and_a_browser(tmp_path, lint, test, browser, expected):
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci" / "run", tmp_path / ".ci" / "run")
    stand_in = tmp_path / "run"
    stand_in.write_text(
        '#!/bin/sh\necho "$1 $LIETOOL_REQUIRE_RENDERER $LIETOOL_REQUIRE_BROWSER"\n'
        f'[ "$1" = browser ] && exit {browser}\n[ "$1" = lint ] && exit {lint}\nexit {test}\n'
    )
    stand_in.chmod(0o755)
    done = subprocess.run(["bash", tmp_path / ".ci" / "run"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (expected, "browser 1 1\nlint 1 1\ntest 1 1\nmutants 1 1\n")


def test_scripts_can_be_executed():
    assert all((ROOT / name).stat().st_mode & stat.S_IXUSR for name in ("run", ".ci/run"))
