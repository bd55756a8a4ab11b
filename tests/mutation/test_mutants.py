"""`lietool figures mutants` on toy figures: what is noticed, by what, and what is kept of it."""

import json

import pytest
from click.testing import CliRunner

from lietool import mutation
from lietool.mutation import process, record
from lietool.mutation.mutant import Mutant
from lietool.verbs import _figures_mutants, _mutants_run
from lietool.verbs.figures import command

FIGURE = '''
"""Toy."""

from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, figure
from lietool.lie import so2
from lietool.render.scene import Lines, Picture, View


@figure(
    plates={
        "T1": Plate(title="A turn", equations=(), caption="Turned."),
        "T2": Plate(title="White", equations=(), caption="White on white.", params={"color": "#ffffff"}),
    }
)
def turned(color: Annotated[str, Param("colour")] = "#000000") -> Drawing:
    """Draw a turned stroke."""
    R = so2.exp(0.5)
    ends = np.array([[5.0, 5.0, 0.0], [5.0, 5.0, 0.0]])
    ends[1, :2] += R @ [30.0, 0.0]
    shown = {"first": 1} if color == "#000000" else {"entry": R[0, 0]}
    return Drawing(Picture((View((Lines(ends, color),)),), (60, 40)), shown)
'''

WHERE = "c, s = np.cos(x), np.sin(x)"


def mutant(name, new, harmless="", old=WHERE, module="lietool.lie.so2"):
    return Mutant(f"toy: {name}", module, old, new, "sign", "Wrong.", harmless)


SINE = "c, s = np.cos(x), np.sin({} * x)"
MUTANTS = (
    mutant("sign", SINE.format("-1.0")),
    mutant("slight", SINE.format("1.00001")),
    mutant("raises", "c, s = np.cos(x), np.sin(missing)"),
    mutant("hangs", "c, s = np.cos(x), np.sin(x)\n    while True: pass"),
    mutant("dies", "import os\n    os._exit(7)\n    c, s = np.cos(x), np.sin(x)"),
    mutant("unseen", "s, c = np.sin(x), np.cos(x)"),
    mutant("known", "s, c = np.sin(x), np.cos(x) ", "The same in another order."),
    mutant("wrongly known", SINE.format("-1.5"), "It is not."),
    mutant("elsewhere", "np.swapaxes(R, -2, -1)", old="np.swapaxes(R, -1, -2)"),
)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the verb on a project of toys with toy mutants, and return what it found or its output."""
    file = tmp_path / "figures" / "ch9" / "turned.py"
    file.parent.mkdir(parents=True)
    file.write_text(FIGURE)
    monkeypatch.setenv("LIETOOL_PROJECT", str(tmp_path))
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(_mutants_run, "_LEAST", 4.0)
    monkeypatch.setattr(_mutants_run, "_TIMES", 0.0)
    monkeypatch.setattr(mutation, "catalogue", lambda: MUTANTS)

    def invoke(line, code=0):
        words = ["mutants", "--plate", "turned", *(w.replace("_", " ") for w in line.split())]
        result = CliRunner().invoke(command, words, catch_exceptions=False)
        assert result.exit_code == code, result.output
        return json.loads(result.stdout) if "--json" in line else result.output

    invoke.file = file  # type: ignore[attr-defined]
    return invoke


@pytest.fixture
def counted(monkeypatch):
    """How many steps processes have done."""
    seen = []
    work = process.run

    def watched(jobs, *more):
        for news in work(jobs, *more):
            seen.append(news.step)
            yield news

    monkeypatch.setattr(process, "run", watched)
    return seen


@pytest.mark.usefixtures("canonical")
def test_every_kind_of_mutant_comes_to_what_it_is(run, counted):
    found = {one["name"]: one for one in run("-j 2 --json", 5)["mutants"]}
    by = {name.removeprefix("toy: "): (one["by"], one["plates"]) for name, one in found.items()}
    assert by["sign"] == (["picture"], ["T1"])
    assert by["raises"] == (["undrawn"], ["T1", "T2"]) or by["raises"] == (["undrawn"], ["T2", "T1"])
    # After a plate that hangs or ends the process no other is tried.
    assert by["hangs"][0] == ["hangs"]
    assert by["dies"][0] == ["undrawn"]
    assert len(by["hangs"][1]) == len(by["dies"][1]) == 1
    wrong = {name.removeprefix("toy: "): one["trouble"] for name, one in found.items() if one["trouble"]}
    assert (
        wrong
        == {
            "slight": "slips through",
            "unseen": "changes no plate, and is not declared harmless",
            "wrongly known": "declared harmless, but changes T1",
            "elsewhere": "no plate executes it, and it is not declared harmless",
        }
        or wrong.pop("wrongly known") == "declared harmless, but changes T2"
    )
    assert 0.0 < found["toy: slight"]["displacement"] < 1e-3
    assert found["toy: sign"]["displacement"] == pytest.approx(60.0 * 0.479425538604203)

    # What was found is kept, and a table says the same.
    del counted[:]
    text = run("", 5)
    assert not counted
    assert "toy: sign" in text and "28.8 px" in text and "toy: known: The same in another order." in text
    assert "WRONG toy: slight: slips through" in text

    # A figure that is another is tried anew, and nothing but what was asked for.
    run.file.write_text(run.file.read_text().replace("30.0", "20.0"))
    from lietool.mutation import reference

    reference._now.cache_clear()
    assert run("toy:_sign --json")["mutants"][0]["displacement"] == pytest.approx(40.0 * 0.479425538604203)
    assert len(counted) == 6


@pytest.mark.usefixtures("canonical")
def test_a_quick_run_tries_what_the_record_says(run, monkeypatch, tmp_path):
    kept = {
        "score": {},
        "seconds": {"T1": 0.1},
        "mutants": {"toy: sign": {"plates": ["T1"]}, "toy: gone": {"plates": ["T1"]}},
    }
    monkeypatch.setattr(record, "read", lambda: kept)
    found = run("--quick --json")
    assert [(one["name"], one["plates"]) for one in found["mutants"]] == [("toy: sign", ["T1"])]
    monkeypatch.setattr(_figures_mutants, "_LAST_BEGIN", -1.0)
    assert "1 of 1 were not begun for want of time." in run("--quick --fresh")
    kept["mutants"] = {}
    assert "--quick needs a record" in run("--quick", 2)


def test_the_catalogue_is_listed(run):
    assert "toy: known" in run("--list")
    assert [row["name"] for row in run("--list --json toy:_s")] == ["toy: sign", "toy: slight"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("nothing", "no mutant begins with 'nothing'"),
        ("--record", "--record keeps a whole run on our own plates"),
        ("--jobs 0", "0 is not in the range"),
    ],
)
def test_what_cannot_be_is_refused(run, line, words):
    assert words in run(line, 2)


def test_a_plate_that_cannot_be_drawn_is_no_measure(run):
    run.file.write_text(FIGURE.replace("so2.exp(0.5)", "so2.exp(np.nan)"))
    assert "T1 cannot be drawn even without a mistake: ValueError: so2.exp" in run("", 2)
