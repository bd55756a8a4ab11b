"""Who may import whom: the arrows of the design, read from the syntax tree of every file."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from lietool import paths

_ROOT = paths.PACKAGE.parent
# What stands below everything, and imports only the standard library.
_BASE = {"paths", "atomic", "cache", "lietool"}
# Imported inside functions only, wherever they are allowed: each takes a noticeable part of a second.
_SLOW = {"av", "matplotlib", "scipy", "skimage", "trimesh", "svgelements", "imageio", "rich", "numba"}


@dataclass(frozen=True)
class Rule:
    """What a part of the project may import: parts of ours, others' packages, and those in functions only."""

    ours: frozenset[str]
    others: frozenset[str] = frozenset()
    lazily: frozenset[str] = frozenset()
    ours_lazily: frozenset[str] = frozenset()


def _rule(ours: str = "", others: str = "", lazily: str = "", ours_lazily: str = "") -> Rule:
    return Rule(*(frozenset(names.split()) for names in (ours, others, lazily, ours_lazily)))


_BELOW = "paths atomic cache"
_ALL = "bench exercise gallery lie mesh interp deform render golden figure verbs mutation lietool " + _BELOW
RULES = {
    "lietool": _rule(),
    "paths": _rule(),
    "atomic": _rule(),
    "cache": _rule(),
    "__main__": _rule("cli"),
    "figures": _rule("paths"),
    "function": _rule(),
    "parameter": _rule(),
    "plate": _rule(),
    "declaration": _rule("function parameter plate"),
    "figure": _rule("declaration function parameter paths plate", ours_lazily="figures"),
    "cli": _rule("figure paths lietool", "click", "rich", ours_lazily="verbs"),
    "lie": _rule("lie", "numpy", "scipy"),
    # Solids that take seconds to make are kept in the cache folder, and written there whole.
    "mesh": _rule("mesh lie cache atomic", "numpy", "scipy trimesh skimage svgelements"),
    "interp": _rule("interp lie mesh", "numpy", "scipy skimage"),
    "deform": _rule("deform lie mesh", "numpy", "scipy skimage"),
    "bench": _rule("bench lie mesh interp deform", "numpy mpmath", "scipy pytransform3d skimage matplotlib"),
    "render": _rule("render " + _BELOW, "numpy moderngl glcontext PIL", "matplotlib av"),
    "golden": _rule("golden " + _BELOW, "numpy PIL pytest", "skimage matplotlib jinja2 markupsafe"),
    "gallery": _rule("gallery " + _BELOW, "jinja2 markupsafe", "matplotlib"),
    # It puts mistakes into what others import, and must not have imported that itself.
    "mutation": _rule("mutation lietool render golden " + _BELOW, "numpy"),
    # It grades what others have written, by the library, the catalogue of mistakes and the pictures.
    "exercise": _rule(
        "exercise figure function mutation golden render lietool " + _BELOW,
        "numpy",
        "nbformat IPython",
        ours_lazily="exercises",
    ),
    "exercises": _rule("paths"),
    "verbs": _rule(_ALL, "click", "numpy PIL rich moderngl"),
    # Imported by a verb when it is called, so what it needs may stand at its top.
    "a part of a verb": _rule(_ALL, "click numpy", "PIL rich moderngl"),
    # Its imports are those of the solution, and of the file that a student starts with.
    "an exercise": _rule("exercise function lie mesh interp deform", "numpy scipy"),
    "a figure": _rule("figure bench lie mesh interp deform render", "numpy"),
}
# Modules that may import more than the rest of their part.
EXCEPTIONS = {
    "lie": {"scipy": {"generic"}},
    "bench": {
        "mpmath": {"exact"},
        "scipy": {"others", "solvers"},
        "pytransform3d": {"others"},
        "skimage": {"peers"},
        "matplotlib": {"peers"},
    },
    "golden": {"pytest": {"plugin"}, "matplotlib": {"pixels"}},
    # Each where its notebooks are written, or run.
    "exercise": {"nbformat": {"export_nbgrader"}, "IPython": {"notebook"}},
}


@dataclass(frozen=True)
class Import:
    """One import: the file's part and module, what it imports, whether at the top, and where it stands."""

    part: str
    module: str
    target: str
    is_ours: bool
    at_top: bool
    place: str


def _files() -> list[Path]:
    folders = (paths.PACKAGE, paths.FIGURES, paths.EXERCISES)
    return sorted(
        file for folder in folders for file in folder.rglob("*.py") if "__pycache__" not in file.parts
    )


def _part(file: Path) -> str:
    if file.is_relative_to(paths.FIGURES):
        return "a figure"
    if file.is_relative_to(paths.EXERCISES):
        return "an exercise"
    first = file.relative_to(paths.PACKAGE).parts[0].removesuffix(".py")
    if first == "verbs" and file.name.startswith("_") and file.name != "__init__.py":
        return "a part of a verb"
    return "lietool" if first == "__init__" else first


def _imports(file: Path) -> Iterator[Import]:
    tree = ast.parse(file.read_bytes(), str(file))
    for node, at_top in _walk(tree, True):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            if _a_part_beside(file, node):
                continue
            assert node.level == 0, f"{file}:{node.lineno}: relative import"
            # `from lietool import figure` imports lietool.figure, `from lietool import __version__` does not.
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            words = name.split(".")
            ours = words[0] == "lietool"
            target = _our_part(words) if ours else words[0]
            place = f"{file.relative_to(_ROOT)}:{node.lineno}"
            yield Import(_part(file), file.stem, target, ours, at_top, place)


def _a_part_beside(file: Path, node: ast.ImportFrom) -> bool:
    """Whether it is ``from . import _part``, or from one: a long figure may keep parts beside itself."""
    if not (file.is_relative_to(paths.FIGURES) and node.level == 1):
        return False
    names = [node.module] if node.module else [alias.name for alias in node.names]
    return all(name.startswith("_") for name in names)


def _our_part(words: list[str]) -> str:
    if len(words) > 1 and (
        (paths.PACKAGE / words[1]).is_dir() or (paths.PACKAGE / f"{words[1]}.py").is_file()
    ):
        return words[1]
    return "lietool"


def _walk(node: ast.AST, at_top: bool) -> Iterator[tuple[ast.AST, bool]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        yield child, at_top
        inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        yield from _walk(child, at_top and not inside)


def _trouble(found: Import) -> str | None:
    rule = RULES[found.part]
    if found.is_ours:
        allowed = rule.ours if found.at_top else rule.ours | rule.ours_lazily
    elif found.target in sys.stdlib_module_names:
        return None
    else:
        allowed = rule.others if found.at_top else rule.others | rule.lazily
        only = EXCEPTIONS.get(found.part, {}).get(found.target)
        if only and found.module not in only:
            allowed = allowed - {found.target}
    if found.target in allowed:
        return None
    how = "at module level" if found.at_top else "in a function"
    return f"{found.place}: {found.part} must not import {found.target} {how}"


def test_every_file_has_a_rule() -> None:
    parts = {_part(file) for file in _files()}
    assert parts >= {"cli", "lie", "render", "golden", "verbs", "a figure"}
    assert parts <= RULES.keys()


def test_arrows() -> None:
    troubles = [_trouble(found) for file in _files() for found in _imports(file)]
    assert not list(filter(None, troubles)), "\n".join(filter(None, troubles))


def test_no_rule_lets_a_slow_package_in_at_module_level() -> None:
    slow = {name: rule.others & _SLOW for name, rule in RULES.items() if rule.others & _SLOW}
    assert slow == {"an exercise": {"scipy"}}


def test_the_rules_have_no_cycles_but_those_within_a_part() -> None:
    arrows = {name: (rule.ours | rule.ours_lazily) - {name} for name, rule in RULES.items()}
    while leaves := [name for name, targets in arrows.items() if not targets & arrows.keys()]:
        for name in leaves:
            del arrows[name]
    assert not arrows


@pytest.mark.parametrize(
    ("place", "text", "words"),
    [
        ("lie/so3.py", "import scipy.linalg", "lie must not import scipy at module level"),
        ("lie/so3.py", "def f():\n    import scipy", "lie must not import scipy in a function"),
        ("lie/so3.py", "from lietool.render import style", "lie must not import render"),
        ("lie/so3.py", "from lietool import figure", "lie must not import figure"),
        ("render/draw.py", "import matplotlib.pyplot", "render must not import matplotlib at module level"),
        ("render/draw.py", "import lietool.figure", "render must not import figure"),
        ("render/draw.py", "def f():\n    from lietool.lie import so3", "render must not import lie"),
        ("golden/store.py", "import lietool.render.draw", "golden must not import render"),
        ("golden/store.py", "import click", "golden must not import click"),
        ("figure.py", "import numpy as np", "figure must not import numpy"),
        ("figure.py", "if True:\n    import click", "figure must not import click"),
        ("cli.py", "from lietool.verbs import doctor", "cli must not import verbs at module level"),
        ("verbs/doctor.py", "import rich", "verbs must not import rich at module level"),
        ("verbs/doctor.py", "class A:\n    import rich", "verbs must not import rich at module level"),
    ],
)
def test_a_wrong_arrow_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, text: str, words: str
) -> None:
    package = tmp_path / "lietool"
    for part in RULES:
        (package / part).mkdir(parents=True)
    monkeypatch.setattr(paths, "PACKAGE", package)
    monkeypatch.setattr(sys.modules[__name__], "_ROOT", tmp_path)
    file = package / place
    file.write_text(text)
    assert words in str([_trouble(found) for found in _imports(file)])


@pytest.mark.parametrize(
    ("place", "text"),
    [
        ("lie/generic.py", "def f():\n    import scipy.linalg"),
        ("render/labels.py", "def f():\n    import matplotlib"),
        (
            "lie/so3.py",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from lietool.mesh import shapes",
        ),
    ],
)
def test_a_right_arrow_is_let_through(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, text: str
) -> None:
    monkeypatch.setattr(paths, "PACKAGE", tmp_path / "lietool")
    monkeypatch.setattr(sys.modules[__name__], "_ROOT", tmp_path)
    file = tmp_path / "lietool" / place
    file.parent.mkdir(parents=True)
    file.write_text(text)
    assert not any(_trouble(found) for found in _imports(file))


def test_figures_say_what_to_look_for() -> None:
    for file in paths.FIGURES.rglob("*.py"):
        if not file.name.startswith("_"):
            assert "What to look for: " in file.read_text(encoding="utf-8"), file


def test_modules_are_short() -> None:
    lengths = {str(file.relative_to(_ROOT)): len(file.read_bytes().splitlines()) for file in _files()}
    assert not {name: length for name, length in lengths.items() if length > 330}


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        ("lietool.cli", "numpy rich moderngl matplotlib PIL lietool.verbs"),
        ("lietool.figure", "numpy click"),
        ("lietool.render.draw", "matplotlib scipy skimage click lietool.figure"),
        ("lietool.lie.so3", "scipy matplotlib click lietool.render"),
    ],
)
def test_what_a_module_brings_along(module: str, absent: str) -> None:
    code = f"import sys, {module}; print(*(set({absent.split()!r}) & sys.modules.keys()))"
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert result.stdout.split() == []
