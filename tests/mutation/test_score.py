"""The score: what counts as caught, and what is wrong."""

import pytest

from lietool.mutation.mutant import Mutant
from lietool.mutation.score import Outcome, Tried, score

MUTANT = Mutant("a: b", "lietool.lie.so3", "1", "2", "sign", "No.")
HARMLESS = Mutant("a: c", "lietool.lie.so3", "1", "2", "sign", "No.", "It cancels.")

SAME = Outcome("P1")
SEEN = Outcome("P2", changed=True, picture=True, displacement=2.0)
COUNTED = Outcome("P3", changed=True, numbers=True, displacement=0.01)
UNSEEN = Outcome("P4", changed=True, displacement=0.02)
HIDDEN = Outcome("P5", changed=True, numbers=True, displacement=0.5)
RAISED = Outcome("P6", changed=True, failure="undrawn", displacement=None)


@pytest.mark.parametrize(
    ("outcomes", "by", "displacement", "trouble"),
    [
        ((SAME, SEEN), ("picture",), 2.0, ""),
        ((SEEN, COUNTED, UNSEEN), ("picture", "numbers"), 2.0, ""),
        ((COUNTED,), ("numbers",), 0.01, ""),
        ((RAISED,), ("undrawn",), None, ""),
        ((UNSEEN, SAME), (), 0.02, "slips through"),
        ((HIDDEN, RAISED), ("numbers", "undrawn"), 0.5, "moves 0.50 px, and no picture notices"),
        ((SAME,), (), 0.0, "changes no plate, and is not declared harmless"),
        ((), (), 0.0, "no plate executes it, and it is not declared harmless"),
    ],
)
def test_what_a_mutant_comes_to(outcomes, by, displacement, trouble):
    tried = Tried(MUTANT, outcomes)
    assert (tried.by, tried.displacement, tried.trouble) == (by, displacement, trouble)
    assert tried.caught == bool(by)
    assert tried.effective == any(outcome.changed for outcome in outcomes)


def test_a_harmless_one_changes_nothing():
    assert Tried(HARMLESS, (SAME,)).trouble == ""
    assert Tried(HARMLESS, ()).trouble == ""
    assert Tried(HARMLESS, (SAME, COUNTED)).trouble == "declared harmless, but changes P3"


def test_a_sample_says_nothing_of_what_it_left_out():
    assert Tried(MUTANT, (SAME,), sampled=True).trouble == ""
    assert Tried(MUTANT, (UNSEEN,), sampled=True).trouble == "slips through"


def test_the_score_counts_what_is_effective():
    tried = [Tried(MUTANT, o) for o in ((SAME, SEEN), (HIDDEN,), (UNSEEN,), (RAISED,))]
    commands = {"P1": "x", "P2": "x", "P3": "y", "P4": "y", "P5": "y", "P6": "z"}
    about = score([*tried, Tried(HARMLESS, (SAME,))], commands)
    assert about == {
        "mutants": 5,
        "effective": 4,
        "caught": 3,
        "percent": 75.0,
        "by": {"picture": 1, "numbers": 1, "undrawn": 1, "hangs": 0},
        "visible": 2,
        "visible_by_picture": 1,
        "visible_percent": 50.0,
        "only_numbers": 1,
        "only_failures": 1,
        "harmless": 1,
        "commands": {"x": 1, "y": 1, "z": 1},
    }
    assert score([], commands)["percent"] == 100.0
