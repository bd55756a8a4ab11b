"""Every erratum: what is printed fails by the error that was once stated; what is true holds to rounding."""

import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

from lietool.cli import command
from lietool.verbs import _errata, errata

# By text, with the error that was stated when each was found; None where no number was, or of other input.
STATED = {
    "B 2.8 (text)": math.sqrt(0.98),
    "B 2.34": 1.62,
    "B 3.3.3 (text)": None,  # 4.75, of some random matrix
    "B 3.13 (text)": None,
    "B 4.6 (text)": 2 * math.pi,
    "B 5.2 (text)": None,
    "B 6.1, 6.3": None,
    "B 6.3 (text)": None,  # 2.16, of some other motion
    "B 6.5": 2,
    "B 7.1, M 1 (text)": 2 * math.pi,
    "B 7.6": math.nan,
    "B 7.9, M 5": None,
    "B 7.13": None,
    "B A.1": 3.16,
    "B A.3 (text)": None,
    "B A.11 (solution)": None,
    "M section 2, d": 0.57,
    "M section 2, theta": 0.52,
    "M (4) distinct": None,  # 0.69, of some other matrix
    "M (4) two equal": 0.15,
    "M (5)": 4.0,
    "K section 1": None,
    "K 4.3, 5.3 (text)": 540 - 354,
    "K (8) near pi": 2 * (math.pi - 0.01),
    "K Alg. 1, theta = pi": None,
    "K Alg. 1, theta = 0": math.nan,
    "K Alg. 1, closest": 0.5,
    "K Table 2": 2 * math.pi,
}
EVERY = {one.where: one for one in errata.every()}


def run(*words: str) -> str:
    result = CliRunner().invoke(command, ["errata", *words])
    assert result.exit_code == 0, result.output
    return result.output


def test_all_are_there():
    assert list(EVERY) == list(STATED)


@pytest.mark.parametrize("where", STATED)
@pytest.mark.erratum("B 2.34", "B 3.13", "B 6.1", "B 6.3", "B 6.5", "B 7.1", "B 7.6", "B 7.9", "B 7.13")
@pytest.mark.erratum("B A.1", "B A.11", "M 1", "M 4", "M 5", "K 8", "K Algorithm 1")
def test_what_is_printed_fails_and_what_is_true_holds(where: str):
    found = EVERY[where].compute()
    assert found.rest < 2e-14
    stated = STATED[where]
    if stated is None:
        assert found.error > 0.1
    elif math.isnan(stated):
        assert math.isnan(found.error)
        assert np.all(np.isnan(found.printed))
    else:
        assert found.error == pytest.approx(stated, rel=0.05)
    assert np.all(np.isfinite(found.true))
    again = EVERY[where].compute()
    np.testing.assert_array_equal(found.true, again.true)


def test_numbers_that_were_stated_as_points():
    found = EVERY["B 7.9, M 5"].compute()
    np.testing.assert_allclose(found.printed, [12.8, 2.8, 0], atol=0.05)
    np.testing.assert_allclose(found.true, [10.7, 0.7, 0], atol=0.05)
    np.testing.assert_allclose(EVERY["B 6.5"].compute().true, [0, 0, 2, 2], atol=1e-14)
    assert EVERY["K 4.3, 5.3 (text)"].compute().true == pytest.approx(354, abs=0.1)
    np.testing.assert_allclose(EVERY["K section 1"].compute().printed, -np.eye(2), atol=1e-15)
    assert EVERY["B 2.34"].compute().error == pytest.approx(2 * math.sin(0.3 * math.pi))


def test_the_list_is_a_table():
    lines = run().splitlines()
    assert lines[0].split() == ["where", "printed", "true", "error"]
    assert [line.split("  ")[0] for line in lines[1:]] == list(STATED)
    assert max(map(len, lines)) < 180


@pytest.mark.parametrize(
    ("words", "wheres"),
    [
        ("7.6", ["B 7.6"]),
        ("B7.6", ["B 7.6"]),
        ("b (7.6)", ["B 7.6"]),
        ("2.8", ["B 2.8 (text)"]),
        ("6.3", ["B 6.1, 6.3", "B 6.3 (text)"]),
        ("A.1", ["B A.1"]),
        ("B A.11", ["B A.11 (solution)"]),
        ("M 5", ["B 7.9, M 5", "M (5)"]),
        ("m4", ["M (4) distinct", "M (4) two equal"]),
        ("m section 2", ["M section 2, d", "M section 2, theta"]),
        ("K alg 1", ["K Alg. 1, theta = pi", "K Alg. 1, theta = 0", "K Alg. 1, closest"]),
        ("algorithm 1", ["K Alg. 1, theta = pi", "K Alg. 1, theta = 0", "K Alg. 1, closest"]),
        ("table 2", ["K Table 2"]),
        ("K 5.3", ["K 4.3, 5.3 (text)"]),
    ],
)
def test_one_is_found_by_its_place(words: str, wheres: list[str]):
    output = run(*words.split())
    assert [line for line in output.splitlines() if line and not line.startswith(" ")] == wheres
    for head in ("printed", "true", "why", "example", "printed gives", "true gives", "error"):
        assert output.count(f"\n  {head:<15}") == len(wheres)


@pytest.mark.parametrize("where", STATED)
def test_every_one_is_found_by_its_own_name(where: str):
    assert EVERY[where] in _errata.select(where, list(EVERY.values()))


def test_an_unknown_place_names_the_nearest():
    result = CliRunner().invoke(command, ["errata", "7.7"])
    assert result.exit_code == 2
    assert re.fullmatch(
        r"lietool errata: no erratum '7\.7'\. Nearest: .*7\.\d.* lietool errata lists all\n", result.output
    )


def test_json():
    rows = json.loads(run("--json"), parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))
    assert [row["where"] for row in rows] == list(STATED)
    (row,) = json.loads(run("7.6", "--json"))
    assert row["printed_gives"] is None and row["error"] is None
    assert row["true_gives"] == 0.0
    (row,) = json.loads(run("7.13", "--json"))
    assert row["error"] == pytest.approx(4.0)


def test_the_words_are_whole():
    for one in EVERY.values():
        for text in (one.printed, one.true, one.why, one.example):
            assert len(text) > 5
            assert text == text.strip()
            assert not text.endswith(".")
