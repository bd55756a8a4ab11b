"""A subcommand is a figure file: all that such a file needs, and the loader that finds it.

The names of commands come from file names; help lines and plates come from the syntax tree, so that
``lietool --help`` and shell completion import no figure and no numpy.
"""

import ast
import importlib
import importlib.util
import os
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from lietool import paths
from lietool.declaration import RESERVED as RESERVED
from lietool.declaration import Figure as Figure
from lietool.declaration import figure as figure
from lietool.function import Library as Library
from lietool.parameter import Param as Param
from lietool.parameter import Parameter as Parameter
from lietool.parameter import nearest as nearest
from lietool.parameter import quoted as quoted
from lietool.plate import Drawing as Drawing
from lietool.plate import FigureError as FigureError
from lietool.plate import Plate as Plate
from lietool.plate import Time as Time
from lietool.plate import Tolerance as Tolerance

# Also set by `lietool --project`: spawned workers inherit it.
PROJECT = "LIETOOL_PROJECT"
# What its folder of figures is imported as.
_OWN = "lietool_project"


def project() -> Path | None:
    """Return the folder whose own ``figures/`` and ``golden/`` are added to ours, if one is set.

    Raises
    ------
    FigureError
        If it has no folder ``figures``.
    """
    if not (name := os.environ.get(PROJECT)):
        return None
    folder = Path(name).resolve()
    if not (folder / "figures").is_dir():
        raise FigureError(
            f"project {name} must be a folder with a folder figures/ in it. Make one, or unset {PROJECT}"
        )
    return folder


def folders() -> tuple[Path, ...]:
    """Return the folders of figures: ours, then the project's."""
    own = project()
    return (paths.FIGURES, own / "figures") if own else (paths.FIGURES,)


def names(within: Sequence[Path] | None = None) -> dict[str, Path]:
    """Return the commands and their files, in the order of chapters, by file names only.

    Raises
    ------
    FigureError
        If two files make the same command.
    """
    found: dict[str, Path] = {}
    for file in _files(within):
        name = file.stem.replace("_", "-")
        if name in found:
            raise FigureError(
                f"two files make the command {name}: {found[name]} and {file}. Rename one of them"
            )
        found[name] = file
    return found


def summaries(within: Sequence[Path] | None = None) -> dict[str, str]:
    """Return the commands and their help lines, from the syntax tree; a broken file's says what is wrong."""
    lines = {}
    for name, file in names(within).items():
        try:
            lines[name] = _outline(file).summary
        except FigureError as error:
            lines[name] = f"broken: {error}"
    return lines


def plates(within: Sequence[Path] | None = None) -> dict[str, str]:
    """Return the ids of all plates and the commands that they belong to, from the syntax tree.

    They are in the order of chapters, and in each by their numbers.

    Raises
    ------
    FigureError
        If a file is broken, or two plates have the same id.
    """
    found: dict[str, tuple[str, Path]] = {}
    by_chapter: dict[Path, list[str]] = {}
    for name, file in names(within).items():
        for plate_id in _outline(file).plates:
            if plate_id in found:
                raise FigureError(
                    f"two files have the plate {plate_id}: {found[plate_id][1]} and {file}. Rename one"
                )
            found[plate_id] = (name, file)
            by_chapter.setdefault(file.parent, []).append(plate_id)
    return {
        plate_id: found[plate_id][0]
        for ids in by_chapter.values()
        for plate_id in sorted(ids, key=_by_number)
    }


def load(name: str, within: Sequence[Path] | None = None) -> Figure:
    """Import the file of a command and return its figure.

    Raises
    ------
    FigureError
        If the file is broken, or there is none.
    """
    file = _file(name, within)
    plates = _outline(file).plates
    try:
        module = _module(file)
    except FigureError:
        raise
    except ImportError as error:
        raise FigureError(f"{file}: {error}. Install what is missing, or correct the import") from error
    except ValueError as error:
        raise FigureError(f"{file}: {error}") from error
    figures = [
        item
        for item in vars(module).values()
        if isinstance(item, Figure) and item.function.__module__ == module.__name__
    ]
    if len(figures) != 1 or tuple(figures[0].plates) != plates:
        raise FigureError(
            f"{file}: plates must be written out, plates={{'ID': Plate(...), ...}}, in one @figure"
        )
    return figures[0]


def declare(name: str, within: Sequence[Path] | None = None) -> Figure:
    """Return the figure of a command as far as its signature goes, without importing what draws it.

    Only the declaration is run; where that needs more than the standard library, the file is loaded.

    Raises
    ------
    FigureError
        If the file is broken, or there is none.
    """
    file = _file(name, within)
    namespace: dict[str, Any] = {"__name__": file.stem}
    for node in _tree(file).body:
        if not _declares(node):
            continue
        if isinstance(node, ast.FunctionDef):
            # The docstring stays; the body is not run here, and need not even be compiled.
            node.body = node.body[:1]
        try:
            exec(compile(ast.Module([node], []), str(file), "exec"), namespace)
        except NameError:
            # Something that only the body or another declaration needs.
            continue
    declared = namespace.get(file.stem)
    return declared if isinstance(declared, Figure) else load(name, within)


@dataclass(frozen=True)
class _Outline:
    """What the syntax tree of a figure file says."""

    summary: str
    plates: tuple[str, ...]


def _files(within: Sequence[Path] | None) -> Iterator[Path]:
    for folder in folders() if within is None else within:
        for file in (*sorted(folder.glob("*.py")), *sorted(folder.glob("*/*.py"))):
            if not file.name.startswith("_"):
                yield file


def _file(name: str, within: Sequence[Path] | None) -> Path:
    known = names(within)
    if name not in known:
        raise FigureError(f"no figure {name!r}.{nearest(name, known)}")
    return known[name]


def _tree(file: Path) -> ast.Module:
    try:
        return ast.parse(file.read_bytes(), str(file))
    except (SyntaxError, ValueError, OSError) as error:
        where = f" line {error.lineno}:" if isinstance(error, SyntaxError) and error.lineno else ""
        what = error.msg if isinstance(error, SyntaxError) else error
        raise FigureError(f"{file}:{where} {what}") from None


def _outline(file: Path) -> _Outline:
    try:
        about = file.stat()
    except OSError as error:
        raise FigureError(f"{file}: {error}") from None
    return _outlined(file, about.st_mtime_ns, about.st_size)


# All files are asked for each plate that is looked up.
@cache
def _outlined(file: Path, modified: int, size: int) -> _Outline:
    for node in _tree(file).body:
        decorator = _decorator(node)
        if decorator and isinstance(node, ast.FunctionDef) and node.name == file.stem:
            summary = (ast.get_docstring(node) or "").partition("\n")[0]
            return _Outline(summary, tuple(_plate_ids(decorator)))
    raise FigureError(
        f"{file}: no function {file.stem} with @figure(...). Write one, or begin the file name with _"
    )


def _decorator(node: ast.stmt) -> ast.Call | None:
    for call in getattr(node, "decorator_list", ()):
        if isinstance(call, ast.Call) and ast.unparse(call.func).rpartition(".")[2] == "figure":
            return call
    return None


def _plate_ids(decorator: ast.Call) -> Iterator[str]:
    for keyword in decorator.keywords:
        if keyword.arg == "plates" and isinstance(keyword.value, ast.Dict):
            for key in keyword.value.keys:
                if isinstance(key, ast.Constant) and isinstance(key.value, str):
                    yield key.value


def _declares(node: ast.stmt) -> bool:
    """Whether a statement can matter to the declaration of a figure, and is quick to run."""
    if isinstance(node, ast.ImportFrom):
        return node.module == "lietool.figure" or _is_standard(node.module or "")
    if isinstance(node, ast.Import):
        return all(_is_standard(alias.name) for alias in node.names)
    return isinstance(node, ast.Assign | ast.AnnAssign) or _decorator(node) is not None


def _is_standard(module: str) -> bool:
    return module.partition(".")[0] in sys.stdlib_module_names


def _by_number(plate_id: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.findall(r"\d+|\D+", plate_id)]


def _module(file: Path) -> ModuleType:
    if file.is_relative_to(paths.FIGURES):
        return importlib.import_module(
            ".".join(("lietool.figures", *file.relative_to(paths.FIGURES).with_suffix("").parts))
        )
    root = file.parent if file.parent.name == "figures" else file.parent.parent
    package = _package(_OWN, root)
    if file.parent != root:
        package = _package(f"{_OWN}.{file.parent.name.replace('.', '_')}", file.parent)
    name = f"{package}.{file.stem}"
    if getattr(sys.modules.get(name), "__file__", None) == str(file):
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise FigureError(f"{file}: Python cannot import it. Its name must end in .py")
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _package(name: str, folder: Path) -> str:
    """Make a folder a package, so that figures in it can import parts beside them.

    Two projects may each have a chapter and a file of the same name: what was imported from another folder
    is forgotten.
    """
    if getattr(sys.modules.get(name), "__path__", None) != [str(folder)]:
        for known in [known for known in sys.modules if known == name or known.startswith(f"{name}.")]:
            del sys.modules[known]
        sys.modules[name] = ModuleType(name)
        sys.modules[name].__path__ = [str(folder)]
    return name
