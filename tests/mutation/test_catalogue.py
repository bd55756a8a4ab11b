"""The catalogues of mistakes: every entry fits the source as it is now, and is a mistake."""

import ast
import dataclasses
import functools
import itertools

import pytest

from lietool.mutation import mutant as mutant_
from lietool.mutation.hook import SUBJECTS
from lietool.mutation.mutant import Mutant, MutantError

MUTANTS = mutant_.catalogue()


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_every_mutant_fits_its_module_and_changes_what_that_does(mutant):
    """Its piece of source is there once, and the module compiles to something else."""
    assert mutant.module.startswith(tuple(f"{subject}." for subject in SUBJECTS))
    assert _code(mutant.source) != _code(mutant.original)
    assert mutant.lines
    assert mutant.says.endswith(".")


def test_no_two_mutants_are_the_same():
    for module, group in itertools.groupby(sorted(MUTANTS, key=lambda m: m.module), key=lambda m: m.module):
        sources = [_code(mutant.source) for mutant in group]
        assert len(set(sources)) == len(sources), module


@functools.cache
def _code(source: str) -> str:
    """What a module does, without its docstrings and comments."""
    tree = ast.parse(source)
    compile(tree, "module", "exec")
    return _without_docstrings(tree)


def _without_docstrings(tree: ast.Module) -> str:
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef) and ast.get_docstring(node):
            del node.body[0]
    return ast.dump(tree)


GOOD = Mutant("so3.hat: sign", "lietool.lie.so3", "0.0 - x[..., i]", "x[..., i]", "sign", "Symmetric.")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"name": "hat"}, "name must be 'where: what'"),
        ({"mistake": "silly"}, "mistake must be one of sign, transpose"),
        ({"mistake": "scaled"}, "mistake must be one of"),
        ({"mistake": "scaled 1e-9"}, "mistake must be one of"),
        ({"mistake": "erratum"}, "mistake must be one of"),
        ({"new": "0.0 - x[..., i]"}, "must be written out"),
        ({"says": " "}, "must be written out"),
    ],
)
def test_a_record_that_is_no_mutant_is_refused(changed, words):
    with pytest.raises(MutantError, match=words):
        dataclasses.replace(GOOD, **changed)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"old": "nowhere to be found"}, "it occurs 0 times. Copy it from the file"),
        ({"old": "return"}, "it occurs .. times"),
        ({"module": "lietool.lie.so9"}, "there is no module lietool.lie.so9"),
        ({"module": "numpy.linalg"}, "module must be one of lietool's"),
        ({"module": "lietool.../../x"}, "module must be one of lietool's"),
    ],
)
def test_a_mutant_that_does_not_fit_says_why(changed, words):
    with pytest.raises(MutantError, match=words):
        _ = dataclasses.replace(GOOD, **changed).source


def test_lines_are_those_of_the_statements_that_change(tmp_path, monkeypatch):
    text = "a = 1\nb = (\n    2,\n    3,\n)\n\n\ndef f(x, y=4):\n    if x:\n        return 5\n    return 6\n"
    (tmp_path / "m.py").write_text(text)
    monkeypatch.setattr(mutant_.paths, "PACKAGE", tmp_path)

    def lines(old, new):
        return sorted(Mutant("m: x", "lietool.m", old, new, "sign", "No.").lines)

    assert lines("3,", "30,") == [2, 3, 4, 5]
    assert lines("y=4", "y=40") == [8]
    assert lines("if x:", "if not x:") == [9]
    assert lines("        return 5\n    return 6", "        return 5\n    return 7") == [11]
    assert lines("        return 5\n    return 6", "        return 50\n    return 60") == [10, 11]
    # What is put in stands before a line, which is run then if it is.
    assert lines("    return 6", "    x += 1\n    return 6") == [11]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[mutant", "a.toml: it must be TOML with tables"),
        ("x = 1", "a.toml: it must be TOML with tables"),
        ('[[mutant]]\nname = "a: b"', "must have harmless, mistake, module, name, new, old, says; wrong or"),
        (
            '[[mutant]]\nname = "a: b"\nmodule = "lietool.x"\nold = "1"\nnew = "2"\nmistake = "sign"\n'
            'says = "No."\nharmles = "x"',
            "missing: harmles$",
        ),
    ],
)
def test_a_catalogue_that_is_none_is_refused(tmp_path, text, words):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(MutantError, match=words):
        mutant_.catalogue(tmp_path)


def test_two_mutants_of_one_name_are_refused(tmp_path):
    one = '[[mutant]]\nname = "a: b"\nmodule = "lietool.x"\nold = "1"\nnew = "2"\n'
    one += 'mistake = "sign"\nsays = "No."\n'
    (tmp_path / "a.toml").write_text(one)
    (tmp_path / "b.toml").write_text(one)
    with pytest.raises(MutantError, match=r"b\.toml: there are two mutants 'a: b'"):
        mutant_.catalogue(tmp_path)


def test_mutants_are_chosen_by_how_they_begin_or_their_module():
    assert mutant_.chosen([], MUTANTS) == MUTANTS
    found = mutant_.chosen(["slerp", "lietool.lie.kernels"], MUTANTS)
    assert {m.module for m in found} >= {"lietool.lie.slerp", "lietool.lie.kernels"}
    assert all(m.name.startswith("slerp") or m.module == "lietool.lie.kernels" for m in found)
    with pytest.raises(MutantError, match="no mutant begins with 'so9'"):
        mutant_.chosen(["so9"], MUTANTS)
