"""Matrices of two columns written in numbers, between brackets, on the page."""

import numpy as np

from lietool.render import scene, style

# From row to row, from the middle to the ends of the brackets, from a bracket to the numbers, and the gap
# between columns.
_ROW, _BRACKET, _INNER, _COLUMNS = 40.0, 40.0, 14.0, 24.0
# Widths of a digit, of a point and of a minus sign, over the type size.
_DIGIT, _POINT, _MINUS = 0.50, 0.28, 0.78


def fixed(value: float | np.floating | np.ndarray) -> str:
    """Return a number with two digits after the point, without a minus sign before zero."""
    return f"{round(float(value), 2) + 0.0:.2f}"


def entries(matrix: np.ndarray, bare: tuple[float, ...] = (0.0,)) -> list[list[str]]:
    """Return the numbers of a matrix (m, n) as texts; those that are exactly a bare one have no decimals."""
    return [[f"{abs(x):.0f}" if x in bare else fixed(x) for x in row] for row in matrix]


def width(matrix: np.ndarray, bare: tuple[float, ...] = (0.0,)) -> float:
    """Return how wide a matrix (m, n) is with its brackets, in page units."""
    columns = _columns(matrix, bare)
    return sum(columns) + _COLUMNS * (len(columns) - 1) + 2.0 * _INNER


def corner(
    matrix: np.ndarray, left: float, middle: float, count: int, bare: tuple[float, ...] = (0.0,)
) -> tuple[float, float, float, float]:
    """Return left, low, right, high of the first rows and columns, so many of each, of a matrix (m, n)."""
    columns = _columns(matrix, bare)[:count]
    start, high = left + _INNER, middle + _ROW * 0.5 * len(matrix)
    return start, high - _ROW * count, start + sum(columns) + _COLUMNS * (count - 1), high


def matrix(
    matrix: np.ndarray,
    left: float,
    middle: float,
    color: str = style.INK,
    bare: tuple[float, ...] = (0.0,),
) -> list[scene.Record]:
    """Return a matrix (m, n) in brackets.

    Parameters
    ----------
    matrix : ndarray, shape (m, n)
    left : float
        Where its left bracket stands, in page units.
    middle : float
        The height of its middle.
    color : str
    bare : tuple of float
        Numbers, none of them negative, that have no decimals where they are exact.
    """
    texts, columns, right = entries(matrix, bare), _columns(matrix, bare), left + width(matrix, bare)
    rows = len(texts)
    records: list[scene.Record] = []
    x = left + _INNER
    for j, column in enumerate(columns):
        x += column
        for i in range(rows):
            at = (x, middle + _ROW * (0.5 * (rows - 1) - i) - 10.0, 0.0)
            records.append(scene.Label(f"${texts[i][j]}$", at, color, style.SMALL_TEXT, anchor="rn"))
        x += _COLUMNS
    half = _BRACKET + 0.5 * _ROW * (rows - 2)
    for edge, inner in ((left, left + 9.0), (right, right - 9.0)):
        bracket = [
            (inner, middle + half),
            (edge, middle + half),
            (edge, middle - half),
            (inner, middle - half),
        ]
        records.append(scene.Lines([(*p, 0.0) for p in bracket], color, style.EDGE))
    return records


def _columns(matrix: np.ndarray, bare: tuple[float, ...]) -> list[float]:
    """How wide the columns are."""
    texts = entries(matrix, bare)
    return [max(_width(row[j]) for row in texts) for j in range(len(texts[0]))]


def _width(text: str) -> float:
    digits = len(text) - text.count(".") - text.count("-")
    return style.SMALL_TEXT * (_DIGIT * digits + _POINT * text.count(".") + _MINUS * text.count("-"))
