"""`lietool doctor`, on this machine and on one where nothing renders."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

import lietool
from lietool.render import advice, probe
from lietool.verbs import doctor

# Imported by every interpreter that starts with this folder on its path, so by the probes, too.
_NO_LIBRARIES = """
import ctypes
class CDLL(ctypes.CDLL):
    def __init__(self, name, *rest, **options):
        if name and ("OSMesa" in name or "EGL" in name):
            raise OSError(f"{name}: cannot open shared object file: No such file or directory")
        super().__init__(name, *rest, **options)
ctypes.CDLL = CDLL
"""
_CANONICAL = {
    "backend": "osmesa",
    "canonical": True,
    "vendor": "Mesa",
    "renderer": "llvmpipe (LLVM 15.0.6, 256 bits)",
    "version": "4.5 (Core Profile) Mesa 22.3.6",
    "mesa": "22.3.6",
    "llvm": "15.0.6",
    "bits": 256,
    "libraries": ["/usr/lib/libOSMesa.so.8.0.0", "/usr/lib/libLLVM-15.so.1"],
    "skipped": {},
    "notes": ["a note"],
    "picture": "ab",
}
_SOFTPIPE = _CANONICAL | {"renderer": "softpipe", "canonical": False, "llvm": None, "bits": None}
_NONE = {"error": "lietool found nothing to render with (egl: none).", "skipped": {"egl": "none"}}


def outcome(monkeypatch, default: dict, other: dict, *arguments: str):
    """Run doctor on a machine where figures find `default`, and the second way gives `other`."""
    monkeypatch.setattr(probe, "run", lambda backend=None: default if backend is None else other)
    return CliRunner().invoke(doctor.command, list(arguments))


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    for name in ("LIETOOL_BACKEND", "GALLIUM_DRIVER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")


def test_all_is_well(monkeypatch):
    result = outcome(monkeypatch, _CANONICAL, _CANONICAL | {"backend": "egl"})
    assert result.exit_code == 0
    for words in ("osmesa", "Mesa 22.3.6, LLVM 15.0.6", "libOSMesa.so.8.0.0", "canonical   yes", "a note"):
        assert words in result.output
    assert "egl: llvmpipe (LLVM 15.0.6, 256 bits), the same pixels" in result.output
    assert "To mend it" not in result.output


def test_other_pixels_are_told(monkeypatch):
    assert "OTHER PIXELS" in outcome(monkeypatch, _CANONICAL, _CANONICAL | {"picture": "cd"}).output


def test_one_way_is_enough(monkeypatch):
    result = outcome(monkeypatch, _CANONICAL, _NONE)
    assert result.exit_code == 0 and "second way  none (egl: none)" in result.output


def test_json_says_the_same(monkeypatch):
    result = outcome(monkeypatch, _CANONICAL, _NONE, "--json")
    found = json.loads(result.output)
    assert result.exit_code == 0 and found["canonical"] is True and found["mend"] == []
    assert found["renderer"] == _CANONICAL and found["other"] == _NONE and found["same_pixels"] is None
    assert found["packages"]["lietool"] == lietool.__version__
    assert {"python", "system", "cpu", "cache"} < found.keys()


def test_a_wrong_driver_is_mended_by_unsetting_it(monkeypatch):
    monkeypatch.setenv("GALLIUM_DRIVER", "softpipe")
    result = outcome(monkeypatch, _SOFTPIPE, _SOFTPIPE)
    assert result.exit_code == 4 and "canonical   NO" in result.output
    assert "unset GALLIUM_DRIVER" in result.output and "install" not in result.output


def test_this_distributions_command_comes_first(monkeypatch):
    monkeypatch.setattr(advice, "distribution", lambda: {"ID": "fedora", "PRETTY_NAME": "Fedora Linux 41"})
    result = outcome(monkeypatch, _NONE, _NONE)
    assert result.exit_code == 4 and "Fedora Linux 41" in result.output
    first, *others = result.output.partition("To mend it:\n")[2].splitlines()
    assert "dnf install" in first and ["apt-get" in others[0], "pacman" in others[1]] == [True, True]


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setattr(doctor, "packages", lambda: {"lietool": "1", "moderngl": None})
    output = outcome(monkeypatch, {"error": "No module named 'moderngl'"}, _NONE).output
    assert "moderngl MISSING" in output and "-m pip install moderngl" in output


def test_elsewhere_there_is_no_package_to_install(monkeypatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    output = outcome(monkeypatch, _SOFTPIPE | {"backend": "system"}, _NONE).output
    assert "on Linux" in output and "apt-get" not in output


def test_the_cache_may_be_missing(monkeypatch, tmp_path):
    (tmp_path / "file").touch()
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path / "file" / "below"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    result = outcome(monkeypatch, _CANONICAL, _NONE)
    assert result.exit_code == 0 and "cannot be written" in result.output
    assert json.loads(outcome(monkeypatch, _CANONICAL, _NONE, "--json").output)["cache"]["writable"] is False


def test_the_cache_is_measured(monkeypatch, tmp_path):
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path))
    (tmp_path / "labels" / "deep").mkdir(parents=True)
    (tmp_path / "labels" / "deep" / "a.png").write_bytes(b"12345")
    found = json.loads(outcome(monkeypatch, _CANONICAL, _NONE, "--json").output)["cache"]
    assert found == {"wanted": str(tmp_path), "used": str(tmp_path), "writable": True, "bytes": {"labels": 5}}


def test_with_neither_library_it_gives_advice_and_no_traceback(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(_NO_LIBRARIES)
    done = subprocess.run(
        [sys.executable, "-c", "from lietool.verbs.doctor import command; command()"],
        env=os.environ
        | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(Path(lietool.__file__).parents[1])])},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 4 and done.stderr == ""
    assert "renderer    NONE" in done.stdout and "libOSMesa.so.8" in done.stdout and "libEGL" in done.stdout
    assert all(command in done.stdout for command in advice.commands().values())


def test_a_crash_and_a_hang_are_told(monkeypatch, tmp_path):
    (tmp_path / "sitecustomize.py").write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    assert probe.run(env={"PYTHONPATH": str(tmp_path)}) == {"error": "crashed with SIGSEGV"}
    (tmp_path / "sitecustomize.py").write_text("import time; time.sleep(60)")
    assert probe.run(env={"PYTHONPATH": str(tmp_path)}, timeout=0.2) == {"error": "hung for 0.2 s"}
