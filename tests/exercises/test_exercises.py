"""Every exercise: its solution has all marks, its starter none, and what is wrong is known by its mistake."""

import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lietool.exercise import grade, load
from lietool.exercise.student import Trouble
from lietool.verbs import _equations_index

NAMES = list(load.names())
_WRONG = Path(__file__).with_name("wrong")


def _entries(name):
    return tomllib.loads((_WRONG / f"{name.replace('-', '_')}.toml").read_text())["wrong"]


WRONG = [
    pytest.param(name, entry, id=f"{name}: {entry['name']}") for name in NAMES for entry in _entries(name)
]
MISTAKES = [
    pytest.param(name, number, id=f"{name}: {mistake.name}")
    for name in NAMES
    for number, mistake in enumerate(load.load(name).mistakes)
]


class Inline:
    """Functions of this process in the place of a student's."""

    def __init__(self, functions):
        self.functions = functions

    def call(self, function, *args):
        args = [x.copy() if isinstance(x, np.ndarray) else x for x in args]
        try:
            with np.errstate(all="ignore"):
                return self.functions[function](*args)
        except Exception as error:
            kinds = [kind.__name__ for kind in type(error).__mro__]
            raise Trouble("error", str(error), name=kinds[0], bases=tuple(kinds[1:])) from None


@cache
def _solution(name):
    space = {"__name__": "solution"}
    exec(load.load(name).solution_source, space)
    return space


@pytest.mark.parametrize("name", NAMES)
def test_the_solution_has_all_marks(name):
    exercise = load.load(name)
    made = grade.grade(exercise, exercise.solution_source)
    assert made.marks == made.of == exercise.total == 10, made.as_json()
    assert made.diagnosis == () and made.shown is not None and made.shown.student is not None


@pytest.mark.parametrize("name", NAMES)
def test_the_solution_has_all_marks_with_other_inputs(name):
    for seed in range(1, 6):
        made = grade.judge(load.load(name), Inline(_solution(name)), seed=seed, picture=False)
        assert made.marks == made.of, (seed, made.as_json())


@pytest.mark.parametrize("name", NAMES)
def test_the_library_has_all_marks(name):
    exercise = load.load(name)
    wanted = {function.name: function.wanted for function in exercise.functions}
    made = grade.judge(exercise, Inline(wanted), picture=False)
    lost = [outcome for outcome in made.outcomes if not outcome.passed]
    assert not lost, made.as_json()


@pytest.mark.parametrize("name", NAMES)
def test_the_starter_runs_and_has_none(name):
    exercise = load.load(name)
    made = grade.grade(exercise, exercise.starter_source)
    assert made.marks == 0 and not made.trouble
    assert made.diagnosis == (
        "It returns nan only, as the file does that you started with: write the function.",
    )
    troubles = [finding.trouble for outcome in made.outcomes for finding in outcome.findings]
    assert not any("rror" in trouble for trouble in troubles), troubles


@pytest.mark.parametrize("name", NAMES)
def test_at_least_three_wrong_solutions_are_known(name):
    entries = _entries(name)
    assert len(entries) >= 3 and sum(bool(entry["says"]) for entry in entries) >= 2
    assert all(0 <= entry["marks"] < 10 for entry in entries)


@pytest.mark.parametrize(("name", "entry"), WRONG)
def test_a_wrong_solution_has_its_marks_and_its_diagnosis(name, entry):
    made = grade.grade(load.load(name), entry["source"])
    assert made.marks == entry["marks"], made.as_json()
    assert any(entry["says"] in told for told in made.diagnosis) if entry["says"] else not made.diagnosis, (
        made.diagnosis
    )
    again = grade.grade(load.load(name), entry["source"])
    assert again.as_json() == made.as_json()


@pytest.mark.parametrize(("name", "number"), MISTAKES)
def test_who_makes_a_mistake_is_told_of_it(name, number):
    exercise = load.load(name)
    mistake = exercise.mistakes[number]
    made = grade.judge(exercise, Inline(_solution(name) | dict(mistake.functions)), picture=False)
    assert made.marks < made.of and mistake.says in made.diagnosis, made.as_json()


def test_they_are_in_the_order_of_the_book_and_many():
    exercises = [load.load(name) for name in NAMES]
    assert [exercise.number for exercise in exercises] == list(range(1, len(NAMES) + 1))
    assert len(NAMES) >= 16


def test_their_equations_are_those_of_the_texts():
    folder = Path(_equations_index.__file__).parent
    known = {entry.number for entry in _equations_index.catalogue(folder / "equations.toml")}
    for name in NAMES:
        cited = load.load(name).equations
        unknown = {number if " " in number else f"B {number}" for number in cited} - known
        assert not unknown, (name, unknown)
