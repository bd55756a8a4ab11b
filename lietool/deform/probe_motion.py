"""The motion of a probe, read from a table: see `probe_io` for the keys."""

import numpy as np
from numpy.typing import NDArray

from lietool.deform.probe_values import Table, shown
from lietool.lie import checks, so3

Array = NDArray[np.float64]

KEYS = ("axis", "degrees", "turns", "scale", "stretch", "translation", "matrix")


def read(table: Table, rest: Array) -> tuple[Array, Array, bool]:
    """Return the frame now, whole turns on top of the principal rotation, and whether they are stated.

    Parameters
    ----------
    table : Table
    rest : (4, 4)
        The frame at rest.

    Returns
    -------
    current : (4, 4)
    turns : (3,)
        Axis times number.
    stated : bool

    Raises
    ------
    ValueError
        If a key is unknown, missing, or its value is wrong.
    """
    table.only(KEYS)
    if "matrix" in table.data:
        return _matrix(table)
    turned, turns = _turned(table)
    c, A = rest[:3, 3], np.eye(4)
    A[:3, :3] = turned @ _stretched(table, rest)
    translation = table.numbers("translation", (3,)) if "translation" in table.data else np.zeros(3)
    A[:3, 3] = c + translation - A[:3, :3] @ c
    current = A @ rest
    current[:3, 3] = c + translation
    return current, turns, True


def _whole(table: Table) -> float:
    n = float(table.numbers("turns", ())) if "turns" in table.data else 0.0
    if n != round(n):
        table.fail("turns", "a whole number", shown(table.data["turns"]), "The rest belongs to degrees.")
    return n


def _matrix(table: Table) -> tuple[Array, Array, bool]:
    for key in table.data:
        if key not in ("matrix", "axis", "turns"):
            table.fail(key, "left out beside matrix", shown(table.data[key]))
    if ("axis" in table.data) != ("turns" in table.data):
        table.fail("", "given axis and turns beside matrix, or neither", f"only {sorted(table.data)[0]}")
    if "turns" not in table.data:
        return table.frame("matrix"), np.zeros(3), False
    return table.frame("matrix"), _whole(table) * table.axis("axis"), True


def _turned(table: Table) -> tuple[Array, Array]:
    """Return the rotation, and the whole turns that its principal logarithm lacks."""
    degrees = float(table.numbers("degrees", ())) if "degrees" in table.data else 0.0
    total = degrees + 360.0 * _whole(table)
    if "axis" not in table.data:
        if total != 0.0:
            table.fail("axis", "given beside degrees or turns", "none")
        return np.eye(3), np.zeros(3)
    if not {"degrees", "turns"} & set(table.data):
        table.fail("axis", "left out, or given degrees or turns beside it", shown(table.data["axis"]))
    if abs(total) > 1e9:
        table.fail("degrees", "at most 1e9 degrees with the turns", f"{total:g}")
    u = table.axis("axis")
    # Degrees are taken apart before they become radians: 360 of them are no turn at all.
    R = so3.exp(np.radians(total - 360.0 * np.rint(total / 360.0)) * u)
    return R, np.rint((np.radians(total) - u @ so3.log(R)) / (2.0 * np.pi)) * u


def _stretched(table: Table, rest: Array) -> Array:
    if "stretch" in table.data:
        if "scale" in table.data:
            table.fail("scale", "left out beside stretch", shown(table.data["scale"]))
        S = table.numbers("stretch", (3, 3))
        if not np.max(np.abs(S - S.T)) <= checks.TOLERANCE * np.max(np.abs(S)):
            table.fail("stretch", "symmetric", shown(table.data["stretch"]))
        if not np.min(np.linalg.eigvalsh(S)) > 0.0:
            table.fail("stretch", "positive definite", shown(table.data["stretch"]), "Reflect by matrix.")
        return 0.5 * (S + S.T)
    if "scale" not in table.data:
        return np.eye(3)
    s = table.numbers("scale", (), (3,))
    if not np.min(s) > 0.0:
        table.fail("scale", "above 0", shown(table.data["scale"]), "Reflect by matrix.")
    axes = rest[:3, :3] / np.linalg.norm(rest[:3, :3], axis=0)
    if s.ndim == 0 or s[0] == s[1] == s[2]:
        return float(s.flat[0]) * np.eye(3)
    if np.max(np.abs(axes.T @ axes - np.eye(3))) > checks.TOLERANCE:
        table.fail("scale", "one number, for the axes of the frame are not at right angles", f"{s.tolist()}")
    return (axes * s) @ axes.T


def rotation(table: Table, key: str) -> Array:
    """Return the rotation under a key, 3 rows of 3 numbers, or a table of axis and degrees.

    Parameters
    ----------
    table : Table
    key : str

    Returns
    -------
    R : (3, 3), rotation

    Raises
    ------
    ValueError
        If it is neither.
    """
    value = table.data[key]
    if isinstance(value, dict):
        part = Table(table.place, f"{table.label}, {key}", value)
        part.only(("axis", "degrees"))
        return _turned(part)[0]
    R = table.numbers(key, (3, 3))
    if np.max(np.abs(R.T @ R - np.eye(3))) > checks.TOLERANCE or np.linalg.det(R) < 0.0:
        must = "a rotation, to six digits, or { axis, degrees }"
        table.fail(key, must, shown(value), "A frame may be any invertible matrix.")
    return R
