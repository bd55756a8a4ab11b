"""The wheel: figures, exercises and goldens travel inside the package, and are found there."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOUND = (
    "from lietool import figure, paths; figure.load('slerp'); "
    "from lietool.exercise import load; load.load('slerp'); "
    "print(paths.FIGURES, paths.EXERCISES, paths.GOLDEN, len(figure.plates()), sep='\\n')"
)


def tracked(folder: str, suffixes: tuple[str, ...]) -> set[str]:
    return {
        str(path.relative_to(ROOT / folder)) for path in (ROOT / folder).rglob("*") if path.suffix in suffixes
    }


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A folder with what the wheel would install."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


@pytest.mark.parametrize(
    ("inside", "beside", "suffixes"),
    [
        ("figures", "figures", (".py",)),
        ("exercises", "exercises", (".py",)),
        ("goldens", "golden", (".png", ".json", ".md")),
        (".", "lietool", (".py", ".frag", ".toml", ".html", ".css", ".js")),
    ],
)
def test_every_file_is_in_it(site, inside, beside, suffixes):
    packed = {
        str(path.relative_to(site / "lietool" / inside)) for path in (site / "lietool" / inside).rglob("*")
    }
    assert tracked(beside, suffixes) <= packed


def test_it_holds_nothing_else(site):
    assert {path.name.partition("-")[0] for path in site.iterdir()} == {"lietool"}


def test_figures_and_goldens_are_found_inside(site, tmp_path):
    done = subprocess.run(
        [sys.executable, "-P", "-c", FOUND],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(site)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    figures, exercises, goldens, count = done.stdout.splitlines()
    assert figures == str(site / "lietool" / "figures") and int(count) > 0
    assert exercises == str(site / "lietool" / "exercises")
    assert goldens == str(site / "lietool" / "goldens")
