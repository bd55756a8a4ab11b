"""What a whole run found: kept with the catalogues, sampled by a quick run, told by the README."""

import re

import pytest

from lietool import figure, mutation, paths
from lietool.mutation import record
from lietool.mutation.mutant import Mutant
from lietool.mutation.score import VISIBLE, Outcome, Tried, score
from lietool.verbs import _figures_mutants

COMMANDS = {"P1": "x", "P2": "x", "Q1": "y"}


def mutant(number, module="lietool.lie.so3"):
    return Mutant(f"m{number}: x", module, "1", "2", "sign", "No.")


def kept(*plates):
    return {"by": ["picture"], "plates": list(plates), "displacement": 1.0}


def test_a_record_is_read_back(tmp_path):
    file = tmp_path / "record.json"
    seen = Outcome("P1", changed=True, picture=True, displacement=1.23456)
    counted = Outcome("Q1", changed=True, numbers=True, displacement=None)
    tried = [Tried(mutant(1), (counted, seen)), Tried(mutant(2), (counted,)), Tried(mutant(3))]
    about = score(tried, COMMANDS)
    record.write(tried, about, {"Q1": 0.01, "P1": 0.4321}, file)
    found = record.read(file)
    assert found["score"] == about
    assert found["seconds"] == {"P1": 0.4, "Q1": 0.1}
    assert found["mutants"] == {
        # Where a picture notices, the plates of the others are of no use to a quick run.
        "m1: x": {"by": ["picture", "numbers"], "plates": ["P1"], "displacement": 1.23},
        "m2: x": {"by": ["numbers"], "plates": ["Q1"], "displacement": None},
        "m3: x": {"by": [], "plates": [], "displacement": 0.0},
    }


@pytest.mark.parametrize("text", [None, "", "{"])
def test_no_record_is_an_empty_one(tmp_path, text):
    file = tmp_path / "record.json"
    if text is not None:
        file.write_text(text)
    assert record.read(file)["mutants"] == {}


def test_a_sample_is_of_all_modules_and_commands_and_no_longer_than_asked():
    mutants = [mutant(i, f"lietool.lie.m{i % 3}") for i in range(30)]
    known = {
        "seconds": {"P1": 0.5, "P2": 9.0, "Q1": 0.6},
        "mutants": {m.name: kept("P1", "P2", "Q1") for m in mutants},
    }
    plan = record.sample(known, mutants, COMMANDS, 0, 14.0)
    assert plan == record.sample(known, mutants[::-1], COMMANDS, 0, 14.0)
    assert plan != record.sample(known, mutants, COMMANDS, 1, 14.0)
    by_name = {m.name: m for m in mutants}
    assert {by_name[name].module for name in list(plan)[:3]} == {f"lietool.lie.m{i}" for i in range(3)}
    assert {plate for plates in plan.values() for plate in plates} == {"P1", "Q1"}
    # Each takes a process and the plate; the first on a plate twice that.
    assert len(plan) == 9
    assert not record.sample(known, mutants, {"R1": "z"}, 0, 14.0)


RECORD = record.read()


@pytest.mark.skipif(not RECORD["mutants"], reason="no whole run has been kept yet")
def test_the_record_is_of_these_mutants_and_plates():
    """Else: lietool figures mutants --record -j 2, which tries only what is new."""
    assert RECORD["mutants"].keys() == {m.name for m in mutation.catalogue()}
    known = figure.plates((paths.FIGURES,))
    assert {p for one in RECORD["mutants"].values() for p in one["plates"]} <= known.keys()


@pytest.mark.skipif(not RECORD["mutants"], reason="no whole run has been kept yet")
def test_every_effective_mutant_was_caught_and_the_harmless_are_those_declared():
    harmless = {m.name for m in mutation.catalogue() if m.harmless}
    for name, one in RECORD["mutants"].items():
        assert bool(one["by"]) != (name in harmless), name
        assert (one["displacement"] or 0.0) < VISIBLE or "picture" in one["by"], name
    assert RECORD["score"]["percent"] == RECORD["score"]["visible_percent"] == 100.0


@pytest.mark.skipif(not RECORD["mutants"], reason="no whole run has been kept yet")
def test_the_readme_tells_the_score():
    text = re.sub(r"\s+", " ", (paths.PACKAGE.parent / "README.md").read_text(encoding="utf-8"))
    for line in _figures_mutants.summary(RECORD["score"]):
        assert line in text, f"README.md must say: {line}"
