"""The factors of `decompose` in numbers, as a line of matrices."""

import numpy as np

from lietool.render import scene, style

# From row to row, from the middle to the ends of the brackets, from a bracket to the numbers; then gaps:
# between columns, between factors, and for the sign of equality.
_ROW, _BRACKET, _INNER, _COLUMNS, _GAP, _EQUAL = 40.0, 40.0, 14.0, 24.0, 14.0, 62.0
_MIDDLE = 68.0
# Widths of a digit, of a point and of a minus sign, over the type size.
_DIGIT, _POINT, _MINUS = 0.50, 0.28, 0.78


def fixed(value: float | np.floating | np.ndarray) -> str:
    """Return a number with two digits after the point, without a minus sign before zero."""
    return f"{round(float(value), 2) + 0.0:.2f}"


def _entry(value: float) -> str:
    """A nought that is exact is written as one."""
    return "0" if value == 0.0 else fixed(value)


def _width(text: str) -> float:
    digits = len(text) - text.count(".") - text.count("-")
    return style.SMALL_TEXT * (_DIGIT * digits + _POINT * text.count(".") + _MINUS * text.count("-"))


def matrices(named: list[tuple[str, np.ndarray]]) -> list[scene.Record]:
    """Return a line of matrices, each under its name: the first is the product of the others.

    The names are equal; the numbers are so only as far as they are not rounded.
    """
    texts = [[[_entry(x) for x in row] for row in matrix] for _, matrix in named]
    columns = [[max(_width(row[j]) for row in text) for j in range(2)] for text in texts]
    widths = [sum(column) + _COLUMNS + 2.0 * _INNER for column in columns]
    left = 600.0 - (sum(widths) + _EQUAL + _GAP * (len(named) - 2)) / 2.0
    exact = all(float(text) == x for t, (_, m) in zip(texts, named, strict=True) for text, x in _pairs(t, m))
    records: list[scene.Record] = []
    for k, (name, _) in enumerate(named):
        middle, right = left + widths[k] / 2.0, left + widths[k]
        records.append(_label(f"${name}$", middle, _MIDDLE + 56.0, style.TEXT, "cn"))
        x = left + _INNER
        for j in range(2):
            x += columns[k][j]
            for i in range(2):
                y = _MIDDLE + _ROW * (0.5 - i) - 10.0
                records.append(_label(f"${texts[k][i][j]}$", x, y, style.SMALL_TEXT, "rn"))
            x += _COLUMNS
        for edge, inner in ((left, left + 9.0), (right, right - 9.0)):
            high, low = _MIDDLE + _BRACKET, _MIDDLE - _BRACKET
            bracket = [(inner, high), (edge, high), (edge, low), (inner, low)]
            records.append(scene.Lines([(*p, 0.0) for p in bracket], style.INK, style.EDGE))
        if k == 0:
            sign = right + _EQUAL / 2.0
            records.append(_label("$=$", sign, _MIDDLE + 56.0, style.TEXT, "cn"))
            records.append(_label("$=$" if exact else r"$\approx$", sign, _MIDDLE, style.TEXT, "cc"))
        left = right + (_GAP if k else _EQUAL)
    return records


def _pairs(texts: list[list[str]], matrix: np.ndarray) -> list[tuple[str, float]]:
    return [(texts[i][j], float(matrix[i, j])) for i in range(2) for j in range(2)]


def _label(text: str, x: float, y: float, size: float, anchor: str) -> scene.Label:
    return scene.Label(text, (x, y, 0.0), style.INK, size, anchor=anchor)
