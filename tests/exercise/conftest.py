"""A course of one's own: an exercise with a plate that is drawn in an instant, and submissions for it."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from lietool import figure
from lietool.cli import command

_FIGURE = '''
import os
from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, figure
from lietool.render import scene


@figure(plates={"R1": Plate("Roots", (), "The roots of numbers.")})
def roots(
    count: Annotated[int, Param("how many", "", 2, 99)] = 20, *, root: Library = Library("numpy.sqrt")
) -> Drawing:
    """The roots of numbers."""
    x = np.linspace(0.0, 1.0, count)
    y = np.asarray(root(x))
    while y[-1] == 42.0:
        pass
    if y[-1] == 43.0:
        os._exit(3)
    if y[-1] == 44.0:
        raise ValueError("no roots: 44")
    line = scene.Lines(np.stack([x - 0.5, y - 0.5, 0.0 * x], axis=1), "#245a9e", 6.0)
    return Drawing(scene.Picture((scene.View((line,)),), (80, 60)), {"root": y})
'''
_EXERCISE = '''
r"""The root of a number.

Every $x \\ge 0$ has a root $\\sqrt{x}$, with

$$\\sqrt{x}^2 = x. \\qquad (2.1)$$

Write `root(x)`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def root(x):
    """Return the root of x >= 0, an array of any shape."""
    if np.any(np.asarray(x) < 0):
        raise ValueError("x must be 0 or more")
    return np.sqrt(x)


def _numbers(rng):
    yield Case("four", (4.0,))
    yield Case("a hundred at once", (rng.random(100),))


def _squares(f, rng):
    x = rng.random(5)
    yield Claim("its square is x", f.root(x) ** 2, x, given=(x,))


def _bad(rng):
    yield Case("minus one", (-1.0,), raises=True)


EXERCISE = Exercise(
    number=1,
    title="The root of a number",
    equations=("2.1",),
    functions=(Function("root", reference=np.sqrt, starter="return np.full(np.shape(x), np.nan)"),),
    checks=(
        Check("numbers", 4, cases=_numbers),
        Check("squares", 2, law=_squares),
        Check("bad input", 1, cases=_bad),
    ),
    picture=Picture("R1", 3, lambda f: {"root": f.root}),
    mistakes=(
        Mistake("half", "This is half of x; (2.1) wants its root.", {"root": lambda x: np.asarray(x) / 2}),
    ),
)
'''
HEAD = "# lietool exercise: square-root\nimport numpy as np\n\n\ndef root(x):\n"
BODIES = {
    "right": "    if np.any(np.asarray(x) < 0):\n        raise ValueError('no')\n    return np.sqrt(x)\n",
    "lenient": "    return np.sqrt(np.abs(x))\n",
    "half": "    return np.asarray(x) / 2\n",
    "blank": "    return np.full(np.shape(x), np.nan)\n",
    "broken": "    retrun x\n",
    "hangs": "    return np.full(np.shape(x), 42.0)\n",
    "kills": "    return np.full(np.shape(x), 43.0)\n",
    "refused": "    return np.full(np.shape(x), 44.0)\n",
    "rude": "    print('\\x1b[2J\\x07 <script>alert()</script>')\n    raise TypeError('<b>\\x1b[3mno</b>')\n",
}


@pytest.fixture(scope="session")
def course(tmp_path_factory: pytest.TempPathFactory, own_cache: None) -> Path:
    """A project with an exercise, its figure and the golden of its plate."""
    folder = tmp_path_factory.mktemp("course")
    for name, text in (("figures/roots.py", _FIGURE), ("exercises/square_root.py", _EXERCISE)):
        (folder / name).parent.mkdir()
        (folder / name).write_text(text)
    before = os.environ.get(figure.PROJECT)
    args = ["--project", str(folder), "figures", "accept", "--all", "--reason", "for tests"]
    done = CliRunner().invoke(command, args)
    if before is None:
        os.environ.pop(figure.PROJECT, None)
    if done.exit_code == 4:
        pytest.skip(done.output)
    assert done.exit_code == 0, done.output
    return folder


@pytest.fixture
def submit(course: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """A function that hands in a body of `BODIES`, in a folder that is the current one."""
    monkeypatch.setenv(figure.PROJECT, str(course))
    monkeypatch.chdir(tmp_path)

    def write(body: str, file: str = "") -> Path:
        path = Path(file or f"{body}.py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEAD + BODIES.get(body, body))
        return path

    return write


@pytest.fixture
def exercise() -> Callable[..., Result]:
    """A function that runs `lietool exercise` and looks at its exit code."""

    def run(*words: object, code: int = 0) -> Result:
        done = CliRunner().invoke(command, ["exercise", *map(str, words)])
        assert done.exit_code == code, done.output + repr(done.exception)
        assert "Traceback" not in done.output and (code != 2 or done.output.count("\n") == 1)
        return done

    return run
