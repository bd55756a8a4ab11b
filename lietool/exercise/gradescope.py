"""A submission at Gradescope: ``python -m lietool.exercise.gradescope FOLDER`` writes its ``results.json``.

`FOLDER` is what Gradescope calls ``/autograder``: ``source/assignment.json`` says what is to be graded,
``submission/`` has what was handed in.  Source: Gradescope, Autograder Specifications.
"""

import base64
import html
import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lietool
from lietool import atomic
from lietool.exercise import load, words
from lietool.exercise.export import file_name
from lietool.exercise.grade import grade
from lietool.exercise.outcome import Graded, Shown
from lietool.exercise.record import Exercise

SETTINGS = Path("source", "assignment.json")
RESULTS = Path("results", "results.json")
# In bytes: the longest solution has some thousands.
_MOST = 1 << 20
# Of every second pixel each way: a page of results shows no more, and all pictures travel in one file.
_STEP = 2


@dataclass(frozen=True, eq=False)
class _Found:
    """What was handed in for an exercise: a file with its text, or why there is none."""

    name: str = ""
    source: str = ""
    trouble: str = ""


def results(root: Path) -> dict[str, Any]:
    """Grade what was handed in.

    Parameters
    ----------
    root : Path
        With ``source/assignment.json`` and ``submission/``.

    Returns
    -------
    dict
        As Gradescope reads it, the same for the same submission.

    Raises
    ------
    ExerciseError, OSError, ValueError
        If the assignment is broken; who handed in is not to blame.
    RuntimeError
        If no picture can be judged here.
    """
    settings = json.loads((root / SETTINGS).read_bytes())
    exercises = [load.load(name) for name in settings["exercises"]]
    require_renderer()
    files = _files(root / "submission")
    tests: list[dict[str, Any]] = []
    said, digests, marks = [], {}, 0
    for number, exercise in enumerate(exercises, 1):
        found = _found(exercise, files, alone=len(exercises) == 1)
        made = (
            None if found.trouble else grade(exercise, found.source, seed=settings["seed"], name=found.name)
        )
        title = f"{exercise.title}: " if len(exercises) > 1 else ""
        tests += _tests(exercise, made, found, title, f"{number}." if len(exercises) > 1 else "")
        none = f"{exercise.name}: 0 of {exercise.total} points.\n{found.trouble}"
        said.append(words.summary(made) if made else none)
        marks += made.marks if made else 0
        digests |= {exercise.name: made.digest} if made else {}
    return {
        "score": marks,
        "output": "\n\n".join(said),
        "output_format": "text",
        "visibility": settings["visibility"],
        "stdout_visibility": settings["stdout_visibility"],
        "tests": [{**test, "visibility": settings["visibility"]} for test in tests],
        "extra_data": {"lietool": lietool.__version__, "sha256": digests},
    }


def require_renderer() -> None:
    """Raise RuntimeError where no picture can be judged: nobody may lose points by that."""
    from lietool.render import context

    if not context.get().canonical:
        raise RuntimeError("the renderer is not Mesa's llvmpipe: `lietool doctor` says what to install")


def _files(folder: Path) -> dict[Path, str | None]:
    """Return the Python files of a submission and their texts; None where it is no text that can be read.

    A link is nothing that was handed in, wherever it leads.
    """
    found: dict[Path, str | None] = {}
    for base, folders, names in os.walk(folder):
        # Archives made on macOS have a shadow of each file there.
        folders[:] = sorted(x for x in folders if not x.startswith((".", "__")))
        for name in sorted(names):
            path = Path(base, name)
            if name.endswith(".py") and not name.startswith(".") and path.is_file() and not path.is_symlink():
                found[path.relative_to(folder)] = _text(path)
    return found


def _text(path: Path) -> str | None:
    with path.open("rb") as file:
        data = file.read(_MOST + 1)
    try:
        # An editor on Windows begins a file with a mark.
        return data.decode("utf-8-sig") if len(data) <= _MOST else None
    except UnicodeDecodeError:
        return None


def _found(exercise: Exercise, files: Mapping[Path, str | None], *, alone: bool) -> _Found:
    """Which file is for an exercise: the one that says so, else that with its name, or the only one."""
    wanted = file_name(exercise)
    mine = [path for path, text in files.items() if text and load.which(text) == exercise.name]
    mine = [path for path in mine if path.name == wanted] or mine
    mine = mine or [path for path in files if path.name == wanted]
    mine = mine or (list(files) if alone and len(files) == 1 else [])
    if not mine:
        first = f"{load.HEADER}{exercise.name}"
        return _Found(trouble=f"Nothing was handed in for it: {wanted}, whose first line is `{first}`.")
    if len(mine) > 1:
        listed = ", ".join(path.as_posix() for path in mine)
        return _Found(trouble=f"There are {len(mine)} files for it, {listed}. Hand in one.")
    text = files[mine[0]]
    if text is None:
        return _Found(trouble=f"{mine[0]} cannot be read: it is no text in UTF-8, or larger than 1 MiB.")
    return _Found(mine[0].name, text)


def _tests(
    exercise: Exercise, made: Graded | None, found: _Found, title: str, number: str
) -> Iterator[dict[str, Any]]:
    """Yield the checks of an exercise as Gradescope's test cases."""
    if made is None:
        titles = [(check.title, check.points) for check in exercise.checks]
        titles.append((f"the picture {exercise.picture.plate}", exercise.picture.points))
        for i, (name, points) in enumerate(titles, 1):
            yield _test(title + name, f"{number}{i}", 0, points, found.trouble)
        return
    for i, outcome in enumerate(made.outcomes, 1):
        test = _test(
            title + outcome.title, f"{number}{i}", outcome.points, outcome.of, words.outcome(outcome)
        )
        if outcome.kind == "picture" and made.shown is not None:
            test |= {"output": _page(test["output"], made.shown, outcome.passed), "output_format": "html"}
        yield test
    if made.printed:
        # Without points it is only told.
        yield {
            "name": f"What {found.name} printed",
            "number": f"{number}{len(made.outcomes) + 1}",
            "status": "passed",
            "output": made.printed,
            "output_format": "text",
        }


def _test(name: str, number: str, score: int, most: int, output: str) -> dict[str, Any]:
    about = {"name": name, "number": number, "score": score, "max_score": most}
    return about | {
        "status": "passed" if score == most else "failed",
        "output": output,
        "output_format": "text",
    }


def _page(text: str, shown: Shown, passed: bool) -> str:
    """What is said of a picture, with the picture, and the plate where that is another."""
    pictures = [("Drawn with your function", shown.student)]
    if not passed:
        pictures.append(("As it should be", shown.reference))
    parts = [f"<pre>{html.escape(text)}</pre>"]
    for says, image in pictures:
        if image is not None:
            parts.append(
                f'<p>{says}:</p><p><img src="{_address(image)}" alt="{says}: {html.escape(shown.says)}"></p>'
            )
    return "\n".join(parts)


def _address(image: Any) -> str:
    from lietool.golden import explain

    height, width = (n - n % _STEP for n in image.shape[:2])
    # The mean of each square.
    cut = image[:height, :width].reshape(height // _STEP, _STEP, width // _STEP, _STEP, 3)
    small = cut.mean(axis=(1, 3)).round().astype("uint8")
    return "data:image/png;base64," + base64.b64encode(explain.png(small)).decode()


def try_solutions(root: Path) -> list[str]:
    """Grade the library's own solutions, and return what is wrong with them: nothing, where all is well."""
    settings = json.loads((root / SETTINGS).read_bytes())
    require_renderer()
    wrong = []
    for name in settings["exercises"]:
        exercise = load.load(name)
        made = grade(exercise, exercise.solution_source, seed=settings["seed"])
        if made.marks < made.of:
            wrong += [words.outcome(outcome) for outcome in made.outcomes if not outcome.passed]
    return wrong


def main(arguments: Sequence[str]) -> int:
    """Grade, and write the results; with ``--try`` only grade the library's own solutions.

    Without results Gradescope says that the autograder failed, which is the truth wherever this ends with 1.
    """
    root = Path(arguments[0])
    try:
        if "--try" in arguments[1:]:
            wrong = try_solutions(root)
            print("\n".join(wrong) or "The solutions of all exercises have full marks here.")
            return 1 if wrong else 0
        made = results(root)
        atomic.write_bytes(root / RESULTS, (json.dumps(made, indent=1) + "\n").encode())
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        print(f"lietool: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    print(made["output"])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
