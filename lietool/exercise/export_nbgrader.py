"""A course for nbgrader: a source notebook for each exercise, in its layout and with its metadata.

Source: nbgrader, cell metadata of schema version 3, and course directory ``source/ASSIGNMENT/NAME.ipynb``.
"""

import ast
from collections.abc import Iterator
from typing import Any

from lietool.exercise import export, export_students
from lietool.exercise.export import Assignment, ExportError
from lietool.exercise.record import Exercise

_SCHEMA = 3
_BEGIN, _END = "### BEGIN SOLUTION", "### END SOLUTION"
_BEGIN_HIDDEN, _END_HIDDEN = "### BEGIN HIDDEN TESTS", "### END HIDDEN TESTS"
_KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}


def files(assignment: Assignment, wheel: tuple[str, bytes]) -> dict[str, bytes]:
    """Return the files of a course, by their paths.

    Parameters
    ----------
    assignment : Assignment
    wheel : tuple of str and bytes
        By `export_wheel.wheel`.

    Raises
    ------
    ExerciseError
        If the plate of an exercise cannot be had.
    ExportError
        If two checks of an exercise have one title.
    ModuleNotFoundError
        If nbformat is not installed.
    """
    import nbformat

    note = (
        "\nExercises of your own are in `project/`, where the configuration finds them.\n"
        if assignment.own
        else ""
    )
    made = {
        "README.md": export.template(
            "nbgrader.md",
            what=export_students.what(assignment.exercises),
            total=assignment.total,
            wheel=wheel[0],
            first=assignment.exercises[0].name,
            note=note,
        ),
        "nbgrader_config.py": export.template("nbgrader_config"),
        wheel[0]: wheel[1],
    }
    for exercise in assignment.exercises:
        folder = f"source/{exercise.name}"
        book = notebook(exercise, assignment.seed)
        made[f"{folder}/{exercise.name}.ipynb"] = (nbformat.writes(book) + "\n").encode()
        made[f"{folder}/{export.plate_file(exercise)}"] = export.plate(exercise)
    return made | dict(assignment.own)


def notebook(exercise: Exercise, seed: int = 0) -> Any:
    """Return the source notebook of an exercise: the statement, the solution, and a cell for each check.

    Parameters
    ----------
    exercise : Exercise
    seed : int
        Of the random inputs that marks are given for.  What students run while they work has seed 0; another
        is in hidden tests, which nbgrader takes out of what they get.

    Returns
    -------
    nbformat.NotebookNode
        Valid, and the same for the same exercise.

    Raises
    ------
    ExportError
        If two checks have one title.
    """
    import nbformat
    from nbformat import v4

    titles = [check.title for check in exercise.checks]
    if len(set(titles)) < len(titles):
        raise ExportError(f"exercise {exercise.name}: two checks have one title, {titles}. Give each its own")
    name = exercise.name
    cells = [
        v4.new_markdown_cell(
            export.statement(exercise), id="statement", metadata=_graded(f"{name}-statement")
        ),
        v4.new_code_cell(solution(exercise), id="solution", metadata=_solved(f"{name}-solution")),
        v4.new_markdown_cell(_ABOUT, id="about", metadata=_graded(f"{name}-about")),
    ]
    checks = [(check.title, check.title, check.points) for check in exercise.checks]
    checks.append(("the picture", f"the picture {exercise.picture.plate}", exercise.picture.points))
    for i, (title, says, points) in enumerate(checks, 1):
        source = "\n".join(_test(exercise, title, says, points, seed))
        meta = _graded(f"{name}-check-{i}", points)
        cells.append(v4.new_code_cell(source, id=f"check-{i}", metadata=meta))
    book = v4.new_notebook(cells=cells, metadata={"kernelspec": _KERNEL})
    nbformat.validate(book)
    return book


_ABOUT = """\
## Checks

Each of the following cells is a check. One that has its points says nothing, and the last shows the picture;
one that fails says for which input, what was wanted and what came. They take what the cells of this notebook
define, all of it numpy or plain Python, and try it in a process of its own: what you import beyond that is
refused there."""


def _test(exercise: Exercise, title: str, says: str, points: int, seed: int) -> Iterator[str]:
    yield f"# {says[0].upper()}{says[1:]}: {points} {'point' if points == 1 else 'points'}"
    yield "from lietool.exercise import notebook"
    yield ""
    if not seed:
        yield f"notebook.check({exercise.name!r}, {title!r})"
        return
    yield "seed = 0"
    yield _BEGIN_HIDDEN
    yield f"seed = {seed}"
    yield _END_HIDDEN
    yield f"notebook.check({exercise.name!r}, {title!r}, seed=seed)"


def solution(exercise: Exercise) -> str:
    """Return the cell that students write in: bodies are marked to be taken out, helpers with the last.

    Parameters
    ----------
    exercise : Exercise

    Returns
    -------
    str
        Python, with nbgrader's marks.
    """
    source = exercise.solution_source
    tree, lines = ast.parse(source), source.splitlines()
    wanted = {function.name for function in exercise.functions}
    imports, helpers, written = [], [], []
    for node in tree.body:
        # What decorates a helper belongs to it.
        first = min([node.lineno, *(x.lineno for x in getattr(node, "decorator_list", ()))])
        text = "\n".join(lines[first - 1 : node.end_lineno])
        if isinstance(node, ast.FunctionDef) and node.name in wanted:
            # The docstring stays, it says what to write.
            told = (node.body[0].end_lineno or node.lineno) - node.lineno + 1
            parts = text.splitlines()
            written.append(("\n".join(parts[:told]), "\n".join(parts[told:])))
        else:
            (imports if isinstance(node, ast.Import | ast.ImportFrom) else helpers).append(text)
    made = ["\n".join(imports)]
    for i, (told, body) in enumerate(written, 1):
        # A mark stands where the body does: what replaces it is indented as the mark is.
        inside = [body, *helpers] if i == len(written) else [body]
        made.append("\n".join([told, f"    {_BEGIN}", "\n\n\n".join(inside), f"    {_END}"]))
    return "\n\n\n".join(made)


def _graded(grade_id: str, points: int | None = None) -> dict[str, Any]:
    """Metadata of a cell that students cannot change; with points it is a test."""
    about: dict[str, Any] = {
        "schema_version": _SCHEMA,
        "grade_id": grade_id,
        "locked": True,
        "solution": False,
    }
    about |= {"grade": points is not None, "task": False}
    return {"nbgrader": about | ({} if points is None else {"points": points})}


def _solved(grade_id: str) -> dict[str, Any]:
    """Metadata of the cell that students write in."""
    about = {"schema_version": _SCHEMA, "grade_id": grade_id, "locked": False, "solution": True}
    return {"nbgrader": about | {"grade": False, "task": False}}
