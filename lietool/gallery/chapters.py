"""What chapters are called, and to which a plate belongs."""

import re

from lietool.gallery.entry import Chapter

# Of the book, and of the folder beside its chapters.
_NAMES = {
    "ch2": "Rigid transformations",
    "ch3": "Affine transformations",
    "ch4": "Exponential and logarithm",
    "ch5": "Between two triangles",
    "ch6": "Interpolation of shapes",
    "ch7": "Positive affine transformations in space",
    "papers": "Deformation by blended affine maps",
}


def chapter(plate_id: str, folder: str, project: str = "") -> Chapter:
    """Return the chapter that a plate belongs to.

    Parameters
    ----------
    plate_id : str
        One of the book's or of a paper's says it by its number, wherever the figure lies.
    folder : str
        The figure's folder, as ``ch2``; empty for figures that are in none.
    project : str
        The name of the project that it belongs to; empty for the book's.

    Returns
    -------
    Chapter
        Its key begins with a sign that no plate's id has.
    """
    if project:
        return Chapter(f"_own-{folder}", project, _label(folder) or "Figures")
    if match := re.match(r"[BGT](\d)\.", plate_id):
        folder = f"ch{match[1]}"
    elif re.match(r"[KM]T?\d", plate_id):
        folder = "papers"
    return Chapter(f"_{folder}", _label(folder), _NAMES.get(folder, ""))


def rank(chapter: Chapter) -> int:
    """Return a number by which chapters come in the order of the texts, and a project's own after them."""
    order = [f"_{folder}" for folder in _NAMES]
    return order.index(chapter.key) if chapter.key in order else len(order)


def _label(folder: str) -> str:
    number = folder.removeprefix("ch")
    if number.isdigit():
        return f"Chapter {number}"
    return "The papers" if folder == "papers" else folder.capitalize()
