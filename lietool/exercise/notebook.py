"""The checks of an exercise in the cells of a notebook, as `lietool exercise export --to nbgrader` writes it.

What the cells define is graded as a file would be: in a process of its own, with the same limits, the same
words, the same marks.  But a notebook runs in the kernel that grades it: who means harm can do there what
nbgrader lets a notebook do, and notebooks of strangers belong in a container.
"""

import sys
from functools import lru_cache

from lietool.exercise import definitions, load, words
from lietool.exercise.grade import grade
from lietool.exercise.outcome import Graded, Shown

# Of the pictures that are shown, the width in pixels.
_WIDTH = 800


class Lost(AssertionError):  # noqa: N818 - it is no fault of the program
    """A check without its points; a notebook shows the message alone."""

    def _render_traceback_(self) -> list[str]:
        return str(self).splitlines()


def check(name: str, title: str, *, seed: int = 0) -> None:
    """Grade what the notebook defines, for one check of an exercise; nothing happens if it has its points.

    Parameters
    ----------
    name : str
        Of the exercise.
    title : str
        Of the check, or "the picture", which is shown.
    seed : int
        Of the random inputs.

    Raises
    ------
    Lost
        If the check has no points; the message says why.
    ExerciseError
        If there is no such exercise, or it has no such check.
    RuntimeError
        If this is no notebook, or the picture cannot be judged here.
    """
    exercise = load.load(name)
    source = definitions.needed(_cells(), [function.name for function in exercise.functions])
    made = _graded(exercise.name, source, seed)
    pictured = title == "the picture"
    if pictured and made.shown is None:
        raise RuntimeError(f"the picture cannot be judged here: {_renderer()}. The other checks can")
    found = [x for x in made.outcomes if (x.kind == "picture" if pictured else x.title == title)]
    if not found:
        raise load.ExerciseError(f"exercise {name} has no check {title!r}. Export the notebook again")
    if pictured and made.shown is not None:
        _show(made.shown, found[0].passed)
    if not found[0].passed:
        raise Lost("\n".join([words.outcome(found[0], source), *made.diagnosis]))


@lru_cache(maxsize=64)
def _graded(name: str, source: str, seed: int) -> Graded:
    """Every cell asks for a check of the same submission."""
    return grade(load.load(name), source, seed=seed, picture=not _renderer(), name="the notebook")


@lru_cache(maxsize=1)
def _renderer() -> str:
    """Why pictures cannot be compared here; empty where they can."""
    from lietool.render import context

    try:
        return "" if context.get().canonical else "the renderer is not Mesa's llvmpipe, see `lietool doctor`"
    except context.NoRendererError as error:
        return str(error)


def _cells() -> list[str]:
    """What has been run in this kernel."""
    ran = vars(sys.modules["__main__"]).get("In")
    if not isinstance(ran, list):
        raise RuntimeError("this is no notebook. Run it in Jupyter, or use `lietool exercise check FILE`")
    return [str(cell) for cell in ran]


def _show(shown: Shown, passed: bool) -> None:
    """Show what the student's function draws, and the plate where that is another."""
    # It is wherever there is a notebook, and nowhere else needed.
    from IPython.display import Image, Markdown, display  # pyright: ignore[reportMissingImports]

    from lietool.golden import explain

    pictures = [("Drawn with your function:", shown.student)]
    if not passed:
        pictures.append(("As it should be:", shown.reference))
    for says, image in pictures:
        if image is not None:
            display(Markdown(says), Image(data=explain.png(image), width=_WIDTH, alt=says))
