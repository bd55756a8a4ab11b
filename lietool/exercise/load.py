"""Finding exercises, and making of each file what a student begins with and a model solution."""

import ast
import importlib
import importlib.util
import re
import sys
import tokenize
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType

from lietool import figure as figures
from lietool import paths
from lietool.exercise import definitions
from lietool.exercise.record import Exercise, ExerciseError

HEADER = "# lietool exercise: "
"""What the first line of every starter begins with; the name follows."""
_HEADER = re.compile(r"^#\s*lietool exercise:\s*([\w-]+)\s*$", re.MULTILINE)
_IMPORT = re.compile(r"(?:import|from)\s")
# A header is looked for in this much of a file.
_TOP = 4000
_OWN = "lietool_project.exercises"


def folders() -> tuple[Path, ...]:
    """Return the folders of exercises: ours, then the project's where it has one.

    Raises
    ------
    ExerciseError
        If the project is none.
    """
    try:
        own = figures.project()
    except figures.FigureError as error:
        raise ExerciseError(str(error)) from None
    return (paths.EXERCISES, own / "exercises") if own else (paths.EXERCISES,)


def names(within: Sequence[Path] | None = None) -> dict[str, Path]:
    """Return the exercises and their files, in the order of the book.

    Raises
    ------
    ExerciseError
        If two files have one name, or one does not say its number.
    """
    found: dict[str, tuple[int, Path]] = {}
    for folder in folders() if within is None else within:
        for file in sorted(folder.glob("*.py")):
            if file.name.startswith("_") or file.is_dir():
                continue
            name = file.stem.replace("_", "-")
            if name in found:
                raise ExerciseError(
                    f"two files have the exercise {name}: {found[name][1]} and {file}. Rename one"
                )
            found[name] = (_number(file), file)
    return {name: file for name, (_, file) in sorted(found.items(), key=lambda x: (x[1][0], x[0]))}


def load(name: str, within: Sequence[Path] | None = None) -> Exercise:
    """Return an exercise by its name; "-" and "_" are the same.

    Raises
    ------
    ExerciseError
        If there is none, or its file is broken.
    """
    known = names(within)
    wanted = name.replace("_", "-")
    if wanted not in known:
        raise ExerciseError(
            f"no exercise {name!r}.{figures.nearest(wanted, known)} See `lietool exercise list`"
        )
    file = known[wanted]
    try:
        module = _module(file)
    except Exception as error:
        raise ExerciseError(f"{file}: {type(error).__name__}: {error}".replace("\n", " ")) from error
    exercise = getattr(module, "EXERCISE", None)
    if not isinstance(exercise, Exercise):
        raise ExerciseError(f"{file}: it must have EXERCISE = Exercise(...). Write it at the end")
    made = _completed(exercise, wanted, file)
    _check(made, file)
    return made


def which(source: str) -> str | None:
    """Return the name of the exercise that a submission says it is for, or None."""
    match = _HEADER.search(source[:_TOP])
    return match[1].replace("_", "-") if match else None


def _number(file: Path) -> int:
    """The number of an exercise from the syntax tree: a list must not import all of them."""
    for node in ast.walk(_tree(file)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] == "Exercise":
            for keyword in node.keywords:
                value = keyword.value.value if isinstance(keyword.value, ast.Constant) else None
                if keyword.arg == "number" and isinstance(value, int):
                    return value
    raise ExerciseError(
        f"{file}: EXERCISE = Exercise(number=..., ...) must say its number. Write it as a number"
    )


def _tree(file: Path) -> ast.Module:
    try:
        return ast.parse(file.read_bytes(), str(file))
    except (SyntaxError, ValueError, OSError) as error:
        where = f" line {error.lineno}:" if isinstance(error, SyntaxError) and error.lineno else ""
        what = error.msg if isinstance(error, SyntaxError) else error
        raise ExerciseError(f"{file}:{where} {what}") from None


def _module(file: Path) -> ModuleType:
    if file.parent == paths.EXERCISES:
        return importlib.import_module(f"lietool.exercises.{file.stem}")
    name = f"{_OWN}.{file.stem}"
    if getattr(sys.modules.get(name), "__file__", None) == str(file):
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ExerciseError(f"{file}: Python cannot import it. Its name must end in .py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules[name] = module
    return module


def _completed(exercise: Exercise, name: str, file: Path) -> Exercise:
    tree = _tree(file)
    with tokenize.open(file) as opened:
        text = opened.read()
    written = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    for function in exercise.functions:
        if function.name not in written:
            raise ExerciseError(
                f"{file}: no function {function.name}, which is to be written. Write its solution"
            )
        if not ast.get_docstring(written[function.name]):
            raise ExerciseError(
                f"{file}: {function.name} has no docstring, which says what to write. Write one"
            )
        if written[function.name].decorator_list:
            # It would stand outside of what a student begins with.
            raise ExerciseError(
                f"{file}: {function.name} is decorated, which no starter is. Write it plainly"
            )
    title = f"{exercise.title} ({', '.join(exercise.equations)})"
    head = f"{HEADER}{name}\n# {title}: `lietool exercise show {name}`\n\n"
    wanted = [function.name for function in exercise.functions]
    imports = "".join(_imports(tree))
    starters = [_started(text, written[f.name], f.starter) for f in exercise.functions]
    parts = [part for part in definitions.statements([text], wanted) if not _IMPORT.match(part)]
    return replace(
        exercise,
        name=name,
        statement=ast.get_docstring(tree) or "",
        starter_source=head + "\n\n\n".join([imports.rstrip(), *starters]) + "\n",
        solution_source=head + "\n\n\n".join([imports.rstrip(), *parts]) + "\n",
        arguments={name: tuple(x.arg for x in written[name].args.args) for name in wanted},
    )


def _imports(tree: ast.Module) -> Iterator[str]:
    """All that the file imports but ourselves, which a submission must not."""
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            module = node.names[0].name if isinstance(node, ast.Import) else node.module or ""
            if module.partition(".")[0] != "lietool":
                yield ast.unparse(node) + "\n"


def _started(text: str, node: ast.FunctionDef, body: str) -> str:
    """A function as far as the end of its docstring, and the starter's body."""
    lines = text.splitlines()
    told = "\n".join(lines[node.lineno - 1 : node.body[0].end_lineno])
    indented = "\n".join(f"    {line}" if line else "" for line in body.strip().splitlines())
    return f"{told}\n    # Write it here, in place of what follows.\n{indented}"


def _check(exercise: Exercise, file: Path) -> None:
    if not exercise.statement:
        raise ExerciseError(f"{file}: it has no docstring, which is the statement. Write one")
    if not exercise.functions:
        raise ExerciseError(f"{file}: it has no function that is to be written. Name one in functions=")
    points = [check.points for check in exercise.checks] + [exercise.picture.points]
    if not exercise.checks or not all(isinstance(point, int) and point > 0 for point in points):
        raise ExerciseError(
            f"{file}: checks and picture must have whole points, at least 1; got {points}. Correct them"
        )
    for check in exercise.checks:
        if (check.cases is None) == (check.law is None):
            raise ExerciseError(f"{file}: check {check.title!r} must have cases or a law. Write one of them")
    for function in exercise.functions:
        if not function.library and function.reference is None:
            raise ExerciseError(
                f"{file}: {function.name} has nothing to be judged by. "
                "Write Function(..., library='lietool...')"
            )
    known = {function.name for function in exercise.functions}
    for mistake in exercise.mistakes:
        if not mistake.functions or not set(mistake.functions) <= known:
            raise ExerciseError(
                f"{file}: mistake {mistake.name!r} must be of {', '.join(sorted(known))}. Correct it"
            )
