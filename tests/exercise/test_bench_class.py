"""The class that `lietool bench class` makes: the same for a seed, and what it says it is."""

import ast
import json

import pytest

from lietool.bench import classes
from lietool.exercise import load
from lietool.verbs import _bench_class

SOLUTION = '''# lietool exercise: half
# Halves.

import numpy as np


def half(x):
    """Return half of x, which is not negative."""
    if np.any(x < 0):
        raise ValueError("x must be 0 or more")
    return np.sin(x) - x / 2.0
'''
STARTER = "# lietool exercise: half\n\n\ndef half(x):\n    return np.nan\n"


def test_a_class_is_of_all_kinds_and_the_same_for_a_seed() -> None:
    made = classes.make(SOLUTION, STARTER, 200, 5)
    assert made == classes.make(SOLUTION, STARTER, 200, 5) != classes.make(SOLUTION, STARTER, 200, 6)
    said = {each.says for each in made}
    assert {"right", "starter", "nothing is refused", "minus the result", "cos for np.sin"} <= said
    assert {"turned: x < 0", "Mult in x / 2.0", "the wrong way round: x / 2.0", "4.0 for 2.0"} <= said
    assert {"loop", "exit", "recursion", "memory", "import"} & said
    for each in made:
        ast.parse(each.source)
        assert load.which(each.source) == "half"
        assert (each.source == SOLUTION) == (each.says == "right")
        assert (each.source == STARTER) == (each.says == "starter")


def test_a_slip_changes_one_thing() -> None:
    for each in classes.make(SOLUTION, STARTER, 60, 1):
        if each.says in ("right", "starter") or each.says in classes._TROUBLES:
            continue
        lines = zip(ast.unparse(ast.parse(SOLUTION)).splitlines(), each.source.splitlines()[3:], strict=False)
        changed = sum(a != b for a, b in lines)
        assert changed == 1 or ";" in each.says or each.says == "nothing is refused"


def test_every_solution_of_ours_makes_a_class() -> None:
    for name in load.names():
        exercise = load.load(name)
        made = classes.make(exercise.solution_source, exercise.starter_source, 40, 0)
        assert len({each.source for each in made}) > 10, name


@pytest.mark.usefixtures("canonical", "submit")
def test_a_class_is_timed(exercise, tmp_path) -> None:
    from click.testing import CliRunner

    from lietool.cli import command

    words = ["bench", "class", "--exercise", "square-root", "--count", "3", "-o", "made"]
    done = CliRunner().invoke(command, [*words, "--json"])
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert sum(found["marks"].values()) == 3 == found["count"] and "10 of 10" in found["marks"]
    assert found["all"]["wall"] > 0.0 < found["one"]["cpu"]
    made = tmp_path / "made"
    assert len(list((made / "submissions").glob("*.py"))) == 3
    assert (made / "grades.csv").is_file() and (made / "report" / "index.html").is_file()
    again = _bench_class.write(tmp_path / "again", ["square-root"], 3, 0)
    assert [path.read_bytes() for path in again] == [
        path.read_bytes() for path in sorted((made / "submissions").iterdir())
    ]
