"""Values as a student reads them: in one line, the long ones by the entry that matters."""

from collections.abc import Sequence
from typing import Any

import numpy as np

# What fits in a line; of more, one entry is shown.
_MOST = 16
# Beside the largest entry of an array, what is less than this is no number but what rounding has left.
_DUST = 1e-14


def value(x: Any, digits: int = 6) -> str:
    """Return a value in one line, arrays with so many digits, and of a long array only its shape."""
    if isinstance(x, tuple | list):
        return ", ".join(value(part, digits) for part in x)
    if isinstance(x, str):
        return repr(x)
    array = np.asarray(x)
    if array.size > _MOST:
        return f"an array of shape {array.shape}"
    if array.dtype.kind not in "fiubc":
        return "no numbers"
    if not array.ndim:
        return _number(array[()], max(10, digits))
    return _row(_without_dust(array), digits)


def _row(array: np.ndarray, digits: int) -> str:
    if not array.ndim:
        return _number(array[()], digits)
    return f"[{', '.join(_row(part, digits) for part in array)}]"


def _number(x: Any, digits: int) -> str:
    # A zero has no sign that anybody should look at.
    return f"{x + 0:.{digits}g}" if np.asarray(x).dtype.kind != "b" else str(x)


def _without_dust(array: np.ndarray) -> np.ndarray:
    """What rounding leaves in place of a zero, as a zero."""
    size = np.abs(array[np.isfinite(array)]).max(initial=0.0)
    return np.where(np.abs(array) < _DUST * size, array.dtype.type(0), array)


def given(names: Sequence[str], args: Sequence[Any]) -> str:
    """Return arguments with their names: "axis = [0., 0., 1.], angle = 2.0944"."""
    # Of a function with *args not all have a name.
    named = [*names, *[""] * len(args)]
    return ", ".join(
        f"{name} = {value(x)}" if name else value(x) for name, x in zip(named, args, strict=False)
    )


def beside(got: Any, want: Any) -> tuple[str, str]:
    """Return what was wanted and what came, of long arrays the entry that is farthest off.

    Parameters
    ----------
    got, want : array_like or tuple of array_like
        Results of the same shapes, or of shapes that broadcast.

    Returns
    -------
    wanted, came : str
        One line each.
    """
    if isinstance(want, tuple):
        pairs = [beside(a, b) for a, b in zip(got, want, strict=True)]
        return "; ".join(a for a, _ in pairs), "; ".join(b for _, b in pairs)
    a, b = np.broadcast_arrays(got, want)
    if b.size <= _MOST:
        return _told(a, b)
    with np.errstate(invalid="ignore", over="ignore"):
        # As floats: of truth values there is no difference, and of unsigned integers a wrong one.
        off = np.where(a == b, 0.0, np.abs(a.astype(np.result_type(a, float)) - b))
    worst = np.unravel_index(int(np.argmax(np.where(np.isnan(off), np.inf, off))), b.shape)
    # The axes that belong together, of a matrix or a vector, are shown whole where there are few.
    keep = next((k for k in range(b.ndim) if np.prod(b.shape[k:], dtype=int) <= _MOST), b.ndim)
    index = worst[:keep]
    where = f"[{', '.join(map(str, index))}] "
    wanted, came = _told(a[index], b[index])
    return where + wanted, where + came


def _told(a: np.ndarray, b: np.ndarray) -> tuple[str, str]:
    """What was wanted and what came, with as many digits as show that they differ."""
    wanted, came = value(b), value(a)
    for digits in (12, 17):
        if wanted == came:
            wanted, came = value(b, digits), value(a, digits)
    return wanted, came
