"""The benchmark of interpolations: what it times is right, and what is missing is said; no time is judged."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from lietool.bench import morphs, solvers
from lietool.cli import command
from lietool.interp import shape
from lietool.mesh import topology
from lietool.verbs import _bench_interp


@pytest.mark.parametrize("size", [2, 200, 1_000, 30_000])
def test_the_strip_is_a_mesh_of_about_that_size(size):
    P, Q, F = morphs.strip(size)
    assert abs(len(F) - size) <= max(2, 0.1 * size)
    assert topology.areas(P, F).min() > 0.0 and topology.areas(Q, F).min() > 0.0
    assert len(topology.boundary(topology.faces("here", F, len(P)))) == 1
    again = morphs.strip(size)
    assert all(np.array_equal(a, b) for a, b in zip((P, Q, F), again, strict=True))


def test_what_is_timed_turns_no_triangle_over():
    mesh = morphs.strip(500)
    for error in morphs.OURS.values():
        found = shape.solve(shape.prepare(*mesh, error=error), np.linspace(0.0, 1.0, 5))
        assert not found.flipped.any()
        assert found.vertices[-1] == pytest.approx(mesh[1], abs=1e-6)


@pytest.mark.parametrize("method", morphs.OURS)
def test_a_row_says_what_was_done(method):
    row = morphs.measure(method, 300, 7)
    assert (row.method, row.size, row.frames) == (method, 300, 7)
    assert row.prepare > 0.0 and row.solve > 0.0 and row.error < 1e-12
    assert row.per_frame == row.solve / 7 and row.met is None


def test_where_a_frame_takes_seconds_there_are_few():
    assert morphs.frames("E^F", 1_000_000) == morphs.FRAMES
    assert morphs.frames("E^R", 1_000_000) == morphs.frames(morphs.LIBIGL, 1_000_000) == morphs.FEW
    assert morphs.frames("E^R", 100_000) == morphs.FRAMES
    assert morphs.frames("E^R", 1_000_000, 2) == 2


def _row(method, size, prepare, solve, frames=60):
    return morphs.Row(method, size, size, frames, prepare, solve, 0.0)


def test_goals_are_judged_for_sixty_frames():
    assert _row("E^F", 10_000, 0.1, 0.3).met is True
    assert _row("E^F", 10_000, 0.2, 0.3).met is False
    assert _row("E^F", 10_000, 0.1, 0.3, 30).met is False
    assert _row("E^R", 10_000, 9.0, 1.4).met is True
    assert _row("E^F", 1_000, 9.0, 9.0).met is None


def test_exponents_and_factors():
    rows = [
        _row(m, n, 0.0, c * n**p) for m, c, p in (("E^F", 1.0, 1.0), ("E^R", 2.0, 1.5)) for n in (100, 900)
    ]
    rows += [_row(morphs.LIBIGL, 100, 0.0, 1000.0)]
    assert morphs.exponents(rows) == pytest.approx({"E^F": 1.0, "E^R": 1.5})
    assert morphs.ahead(rows) == pytest.approx({("E^F", 100): 10.0, ("E^R", 100): 0.5})


def test_libigl_bends_the_same_strip():
    row = morphs.measure(morphs.LIBIGL, 300, 3)
    assert row.triangles == len(morphs.strip(300)[2]) and row.solve > 0.0


def test_without_libigl_it_says_so(monkeypatch):
    monkeypatch.setattr(morphs.importlib.util, "find_spec", lambda name: None)
    result = CliRunner().invoke(command, ["bench", "interp", "--size", "50", "--frames", "2"])
    assert result.exit_code == 0, result.output
    assert "Compared without some: libigl is not installed." in result.stderr
    assert "libigl ARAP" not in result.stdout
    heads, *rows = (line.split() for line in result.stdout.splitlines()[1:])
    assert heads[:2] == ["method", "triangles"] and [row[0] for row in rows] == ["E^F", "E^R"]


def test_the_measurements_as_json():
    words = ["bench", "interp", "--ours", "--size", "60", "--size", "120", "--frames", "2", "--json"]
    result = CliRunner().invoke(command, words)
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert [(row["method"], row["size"]) for row in found["rows"]] == [
        ("E^F", 60),
        ("E^R", 60),
        ("E^F", 120),
        ("E^R", 120),
    ]
    assert all(row["megabytes"] > 10.0 and row["error"] < 1e-12 for row in found["rows"])
    assert set(found["exponents"]) == {"E^F", "E^R"}


def test_the_goals_are_shown(monkeypatch):
    monkeypatch.setattr(_bench_interp, "_measured", lambda method, size, frames: _row(method, size, 0.2, 0.3))
    result = CliRunner().invoke(command, ["bench", "interp", "--ours", "--size", "10000"])
    rows = {line.split()[0]: line for line in result.stdout.splitlines()[2:]}
    assert "< 0.15 s, < 0.4 s" in rows["E^F"] and rows["E^F"].endswith("missed")
    assert rows["E^R"].endswith("met")


def test_solvers_solve_the_same_systems():
    rows = list(solvers.compare(300, 1))
    here = [name for name in solvers.PACKAGES if name not in solvers.missing()]
    assert [(row.matrix, row.solver) for row in rows] == [(m, s) for m in ("E^F", "E^R") for s in here]
    assert "SuperLU" in here and all(row.error < 1e-9 for row in rows)
    result = CliRunner().invoke(command, ["bench", "interp", "--solvers", "--size", "60", "--json"])
    assert result.exit_code == 0 and {row["solver"] for row in json.loads(result.stdout)} == set(here)
    assert "SuperLU" in CliRunner().invoke(command, ["bench", "interp", "--solvers", "--size", "60"]).stdout
