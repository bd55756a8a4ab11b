"""Finding exercises, and what is made of their files."""

import ast

import numpy as np
import pytest

from lietool import figure as figures
from lietool.exercise import ExerciseError, load

TWICE = '''
"""Twice a number.

Write `twice(x)`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture

FACTOR: float = 2.0
UNUSED = 5.0


def twice(x):
    """Return twice x.

    Parameters
    ----------
    x : ndarray, shape (...)
    """
    return _times(x, FACTOR)


def _times(x, by):
    return by * np.asarray(x)


def _numbers(rng):
    yield Case("one", (1.0,))
    yield Case("many", (rng.random(30),))


def _sums(f, rng):
    x = rng.random(3)
    yield Claim("f(x) = x + x", f.twice(x), x + x, given=(x,))


EXERCISE = Exercise(
    number=7,
    title="Twice",
    equations=("1.1", "1.2"),
    functions=(Function("twice", reference=lambda x: 2.0 * np.asarray(x), starter="return np.nan * x"),),
    checks=(Check("numbers", 2, cases=_numbers), Check("sums", 1, law=_sums)),
    picture=Picture("T1", 1, lambda f: {"twice": f.twice}),
    mistakes=(Mistake("thrice", "This is three times x.", {"twice": lambda x: 3.0 * np.asarray(x)}),),
)
'''


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A function that writes a file of exercises of a project's own."""
    (tmp_path / "figures").mkdir()
    (tmp_path / "exercises").mkdir()
    monkeypatch.setenv(figures.PROJECT, str(tmp_path))

    def write(text=TWICE, name="twice_it"):
        file = tmp_path / "exercises" / f"{name}.py"
        file.write_text(text)
        return file

    return write


def test_an_exercise_of_a_project_is_found(project):
    file = project()
    assert load.names()["twice-it"] == file
    made = load.load("twice_it")
    assert (made.name, made.number, made.total) == ("twice-it", 7, 4)
    assert made.statement == "Twice a number.\n\nWrite `twice(x)`."
    assert made.arguments == {"twice": ("x",)}


def test_the_starter_is_the_signature_and_the_docstring(project):
    project()
    made = load.load("twice-it")
    assert made.starter_source == (
        "# lietool exercise: twice-it\n# Twice (1.1, 1.2): `lietool exercise show twice-it`\n\n"
        'import numpy as np\n\n\ndef twice(x):\n    """Return twice x.\n\n    Parameters\n    ----------\n'
        '    x : ndarray, shape (...)\n    """\n    # Write it here, in place of what follows.\n'
        "    return np.nan * x\n"
    )
    assert load.which(made.starter_source) == "twice-it"


def test_the_solution_has_what_it_needs_of_the_file_and_nothing_else(project):
    project()
    made = load.load("twice-it")
    names = [ast.unparse(node).split("\n")[0] for node in ast.parse(made.solution_source).body]
    assert names == ["import numpy as np", "FACTOR: float = 2.0", "def twice(x):", "def _times(x, by):"]
    space = {}
    exec(made.solution_source, space)
    assert space["twice"](np.array([4.0])) == 8.0


def test_the_solution_has_what_decorates_or_changes_what_it_needs(project):
    project(
        TWICE.replace("def _times", "@np.vectorize\ndef _times")
        .replace("FACTOR: float = 2.0", "FACTOR = np.ones(2)\nFACTOR[1] = 2.0")
        .replace("FACTOR)", "FACTOR[1])")
        .replace("UNUSED = 5.0", "class Unused:\n    pass")
    )
    space = {}
    exec(load.load("twice-it").solution_source, space)
    assert space["twice"](np.array([4.0])) == 8.0 and isinstance(space["_times"], np.vectorize)
    assert "Unused" not in space


def test_a_file_may_say_its_encoding(project):
    file = project()
    file.write_bytes(f"# coding: latin-1\n{TWICE}".replace("twice x.", "twice \xe4.").encode("latin-1"))
    assert "twice \xe4." in load.load("twice-it").starter_source


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("EXERCISE = Exercise(\n    number=7", "EXERCISE = Exercise(\n    number=N", "must say its number"),
        ("functions=(Function", "functions=() and (Function", "it has no function that is to be written"),
        ("def twice(x)", "def thrice(x)", "no function twice, which is to be written"),
        ('    """Return twice x.', '    x = """Return twice x.', "twice has no docstring"),
        ("reference=lambda x: 2.0 * np.asarray(x), ", "", "twice has nothing to be judged by"),
        ('Check("numbers", 2, cases=_numbers)', 'Check("numbers", 2)', "must have cases or a law"),
        ('Check("numbers", 2', 'Check("numbers", 0', "must have whole points, at least 1; got [0, 1, 1]"),
        ('Check("numbers", 2', 'Check("numbers", np.nan', "whole points, at least 1; got [nan, 1, 1]"),
        ('Check("numbers", 2', 'Check("numbers", None', "whole points, at least 1; got [None, 1, 1]"),
        ("def twice(x)", "@np.vectorize\ndef twice(x)", "twice is decorated, which no starter is"),
        ('{"twice": lambda x: 3.0', '{"once": lambda x: 3.0', "mistake 'thrice' must be of twice"),
        ("import numpy as np", "import numpy as np; 1 / 0", "ZeroDivisionError: division by zero"),
        ("import numpy as np", "import numpy as", "line 7: "),
        ("EXERCISE = ", "OTHER = ", "it must have EXERCISE"),
        ('"""Twice a number.\n\nWrite `twice(x)`.\n"""', "", "it has no docstring, which is the statement"),
    ],
)
def test_a_broken_file_is_one_line(project, before, after, message):
    assert before in TWICE
    file = project(TWICE.replace(before, after, 1).replace("=N,", "=int('7'),"))
    with pytest.raises(ExerciseError) as error:
        load.load("twice-it")
    assert str(error.value).startswith(str(file)) and message in str(error.value)
    assert "\n" not in str(error.value)


def test_an_unknown_name_has_the_nearest(project):
    project()
    with pytest.raises(ExerciseError, match=r"no exercise .twise_it.\. Nearest: twice-it"):
        load.load("twise_it")


def test_two_of_one_name_are_named(project, monkeypatch):
    first = project(name="a_b")
    second = project(name="a-b")
    with pytest.raises(ExerciseError) as error:
        load.names()
    assert str(first) in str(error.value) and str(second) in str(error.value)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("# lietool exercise: slerp\n", "slerp"),
        ("#!/usr/bin/env python\n#lietool exercise:exp_so3  \n", "exp-so3"),
        ("import numpy\n", None),
        ("x = '# lietool exercise: slerp'\n", None),
    ],
)
def test_a_submission_says_what_it_is_for(text, name):
    assert load.which(text) == name
