"""The factors of `decompose` in numbers, as a line of matrices."""

import numpy as np

from lietool.render import brackets, scene, style

# Gaps between factors, and for the sign of equality.
_GAP, _EQUAL = 14.0, 62.0
_MIDDLE = 68.0


def matrices(named: list[tuple[str, np.ndarray]]) -> list[scene.Record]:
    """Return a line of matrices, each under its name: the first is the product of the others.

    The names are equal; the numbers are so only as far as they are not rounded.
    """
    widths = [brackets.width(matrix) for _, matrix in named]
    left = 600.0 - (sum(widths) + _EQUAL + _GAP * (len(named) - 2)) / 2.0
    exact = all(_exact(matrix) for _, matrix in named)
    records: list[scene.Record] = []
    for k, ((name, matrix), width) in enumerate(zip(named, widths, strict=True)):
        right = left + width
        records.append(_label(f"${name}$", left + width / 2.0, _MIDDLE + 56.0, "cn"))
        records += brackets.matrix(matrix, left, _MIDDLE)
        if k == 0:
            sign = right + _EQUAL / 2.0
            records.append(_label("$=$", sign, _MIDDLE + 56.0, "cn"))
            records.append(_label("$=$" if exact else r"$\approx$", sign, _MIDDLE, "cc"))
        left = right + (_GAP if k else _EQUAL)
    return records


def _exact(matrix: np.ndarray) -> bool:
    """Whether the numbers of a matrix are written without rounding."""
    return bool(np.all(np.array(brackets.entries(matrix), float) == matrix))


def _label(text: str, x: float, y: float, anchor: str) -> scene.Label:
    return scene.Label(text, (x, y, 0.0), style.INK, style.TEXT, anchor=anchor)
