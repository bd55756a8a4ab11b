"""`lietool bench accuracy` on a small sample: every promise holds, and a broken one would be seen."""

import dataclasses
import importlib
import json

import mpmath
import numpy as np
import pytest
from click.testing import CliRunner

from lietool.bench import accuracy, exact, inputs, others, subjects
from lietool.cli import command
from lietool.verbs import _bench_accuracy

COUNT = 2
PROMISED = [s for s in subjects.SUBJECTS if s.promise]


@pytest.mark.parametrize("subject", subjects.SUBJECTS, ids=lambda s: s.name)
def test_every_promise_holds(subject):
    rows = list(accuracy.rows_of(subject, COUNT))
    assert [row.inputs for row in rows] == list(inputs.FAMILIES[subject.inputs](COUNT))
    for row in rows:
        assert np.isfinite(row.ours), row
        assert row.holds is not False, row
    assert any(row.holds for row in rows) == bool(subject.promise)


def test_the_functions_that_have_a_promise_are_measured():
    names = {s.name.split(" ")[0] for s in PROMISED}
    groups = {f"{group}.{word}" for group in ("so2", "so3", "se2", "se3", "sym") for word in ("exp", "log")}
    assert groups | {"phi_so(psi_so(A))", "phi_se(psi_se(A))"} <= names
    for subject in subjects.SUBJECTS:
        if "(" not in subject.name:
            module, name = subject.name.split(".")
            assert callable(getattr(importlib.import_module(f"lietool.lie.{module}"), name))


def test_all_hard_inputs_are_there():
    angles = np.concatenate([np.hypot(np.hypot(*x.T[:2]), x.T[2]) for x in inputs.vectors(COUNT).values()])
    hard = [
        0.0,
        1e-300,
        1e-12,
        1e-8,
        1e-5,
        np.pi,
        2 * np.pi - 1e-9,
        *(np.pi - 10.0**-k for k in range(3, 16)),
    ]
    assert all(np.min(np.abs(angles - a)) <= 1e-15 * max(a, 1e-300) for a in hard)
    affine = np.concatenate(list(inputs.affine(COUNT).values()))[:, :3, :3]
    d = np.linalg.svd(affine, compute_uv=False)
    assert np.all(np.linalg.det(affine) > 0)
    condition, scale = d[:, 0] / d[:, 2], d[:, 1]
    assert condition.min() < 1 + 1e-12 and condition.max() > 9e11
    assert scale.min() < 1e-49 and scale.max() > 1e49
    assert np.any(np.abs(np.log10(np.prod(d, axis=-1)) + 30) < 0.1)


def test_a_broken_promise_is_seen():
    so3_log = next(s for s in subjects.SUBJECTS if s.name == "so3.log")
    worse = dataclasses.replace(so3_log, ours=lambda R: (so3_log.ours(R)[0] * (1 + 4e-15),))
    rows = {row.inputs: row for row in accuracy.rows_of(worse, COUNT)}
    assert rows["ordinary angle"].holds is False
    assert 3e-15 < rows["ordinary angle"].ours < 5e-15
    nan = dataclasses.replace(so3_log, ours=lambda R: (np.full(R.shape[:-1], np.nan),))
    assert all(row.holds is False for row in accuracy.rows_of(nan, COUNT))


def test_at_a_half_turn_both_signs_are_right_and_elsewhere_not():
    R = np.diag([1.0, -1.0, -1.0])
    for sign in (1.0, -1.0):
        assert exact.relative_errors([[sign * np.pi, 0.0, 0.0]], exact.so3_log(R), 0.0) < 1e-15
    right = exact.so3_log(exact_rotation := [[float(v) for v in row] for row in np.eye(3)])
    assert len(right) == 1 and exact_rotation
    assert exact.relative_errors([[0.0, 0.0, 0.0]], right, 0.0) == 0.0
    assert exact.relative_errors([[1e-300, 0.0, 0.0]], right, 0.0) == float("inf")


def test_the_references_are_those_of_mpmath():
    x = [0.3, -1.1, 2.0]
    X = mpmath.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    with mpmath.workdps(50):
        E = mpmath.expm(X)
        off = max(abs(a - b) for a, b in zip(exact.so3_exp(x)[0][0], E, strict=True))
        assert off < mpmath.mpf(10) ** -48
        Y = mpmath.matrix([[0.3, 0.1, -0.2], [0.1, -1.0, 0.5], [-0.2, 0.5, 2.0]])
        off = max(abs(a - b) for a, b in zip(exact.sym_exp(Y.tolist())[0][0], mpmath.expm(Y), strict=True))
        assert off < mpmath.mpf(10) ** -47
    assert mpmath.mp.dps == 15


@pytest.mark.parametrize("library", others.LIBRARIES)
def test_what_others_compute_is_the_same_thing(library):
    assert library not in others.missing()
    compared = 0
    for subject in subjects.SUBJECTS:
        if f := others.functions(library, subject.name):
            classes = inputs.FAMILIES[subject.inputs](COUNT)
            name = next(n for n in classes if n.startswith(("ordinary", "equal")))
            for x in classes[name][:3]:
                got = others.apply(f, x)
                assert got is not None
                right = subject.exact(x.tolist() if x.ndim else float(x))
                assert exact.relative_errors(others.flat(got), right, subject.least) < 1e-12
            compared += 1
    assert compared >= 5


def test_refusals_of_others_are_counted():
    def refuses(x):
        if x > 1:
            raise ValueError("too large")
        return (x,)

    assert others.worst(refuses, np.array([0.5, 2.0, 3.0]), lambda i, blocks: float(blocks[0])) == (0.5, 2)


def run(monkeypatch, allowed: float, *words: str):
    one = next(s for s in subjects.SUBJECTS if s.name == "so2.exp")
    promise = subjects.Promise("a trial", lambda x: np.full(len(x), allowed))
    monkeypatch.setattr(subjects, "SUBJECTS", (dataclasses.replace(one, promise=promise),))
    return CliRunner().invoke(command, ["bench", "accuracy", "--quick", *words])


def test_the_command_shows_the_rows_and_judges_them(monkeypatch):
    result = run(monkeypatch, 1e-15)
    assert result.exit_code == 0, result.output
    rows = [line.split() for line in result.stdout.splitlines()]
    assert rows[0][:4] == ["function", "inputs", "number", "error"]
    assert rows[2][:4] == ["so2.exp", "ordinary", "angle", "12"] and "holds" in rows[2]
    assert "3 of 3 promises hold." in result.stdout


def test_a_broken_promise_is_exit_code_5(monkeypatch):
    result = run(monkeypatch, 1e-30, "--ours", "--json")
    assert result.exit_code == _bench_accuracy.BROKEN == 5
    rows = json.loads(result.stdout)["rows"]
    assert [row["holds"] for row in rows] == [False, False, False, None]
    assert not rows[0]["others"]


def test_what_is_missing_is_said_in_a_line(monkeypatch):
    monkeypatch.setattr(others, "missing", lambda: {"pytransform3d": "pytransform3d is not installed"})
    result = run(monkeypatch, 1e-15)
    assert result.exit_code == 0
    assert "Compared without some: pytransform3d is not installed." in result.stderr
    assert "pytransform3d" not in result.stdout
    monkeypatch.setattr(_bench_accuracy.importlib.util, "find_spec", lambda name: None)
    result = run(monkeypatch, 1e-15)
    assert result.exit_code == 2
    assert "mpmath is not installed. Install lietool[test]" in result.stderr
