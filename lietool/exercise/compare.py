"""How far what a student's function returned is from what it should have returned."""

from typing import Any

import numpy as np

Array = np.ndarray


class UnlikeError(ValueError):
    """Two results that cannot be compared; the message says what came and what was wanted."""


def apart(got: Any, want: Any) -> float:
    """Return the largest difference, relative to the larger of 1 and the largest number that is wanted.

    Parameters
    ----------
    got, want : array_like or tuple of array_like
        Results; in a tuple each is judged by itself, and the largest is returned.

    Returns
    -------
    float
        0 where both are equal; nan where one is not finite and the other is.

    Raises
    ------
    UnlikeError
        If there are other many of them, of another shape, or no numbers.
    """
    pairs = _pairs(got, want)
    return float(np.max([_one(a, b) for a, b in pairs])) if pairs else 0.0


def up_to_sign(got: Any, want: Any) -> float:
    """Return how far apart vectors are of which v and -v stand for the same: unit quaternions, axes.

    Parameters
    ----------
    got, want : ndarray, shape (..., n)
        Vectors; each may have either sign.

    Returns
    -------
    float
        As of `apart`.

    Raises
    ------
    UnlikeError
        As `apart`.
    """
    ((a, b),) = _pairs(got, want)
    if not a.size:
        return 0.0
    same = ((a == b) | (np.isnan(a) & np.isnan(b))).all(axis=-1)
    with np.errstate(invalid="ignore", over="ignore"):
        nearer = np.minimum(np.abs(a - b).max(axis=-1), np.abs(a + b).max(axis=-1))
    nearer = np.where(same, 0.0, nearer)
    return float(np.max(nearer) / max(1.0, float(np.abs(b).max())))


def doubles(got: Any, want: Any) -> Any:
    """Return a result in double precision, complex where that is wanted.

    Parameters
    ----------
    got, want : array_like or tuple of array_like
        Results.

    Returns
    -------
    ndarray or tuple of ndarray
        A tuple where that is wanted.

    Raises
    ------
    UnlikeError
        As `apart`.
    """
    made = tuple(a for a, _ in _pairs(got, want))
    return made if isinstance(want, tuple) else made[0]


def shape(value: Any) -> str:
    """Return the shape of a result in words: "an array of shape (3, 3)", "a number"."""
    if isinstance(value, tuple | list):
        return f"{len(value)} results: " + ", ".join(shape(part) for part in value)
    dims = np.shape(value)
    return f"an array of shape {dims}" if dims else "a number"


def _pairs(got: Any, want: Any) -> list[tuple[Array, Array]]:
    many = isinstance(want, tuple)
    if (not isinstance(got, tuple | list) or len(got) != len(want)) if many else isinstance(got, tuple):
        raise UnlikeError(f"it returned {shape(got)}; wanted {shape(want)}")
    pairs = list(zip(got, want, strict=True)) if many else [(got, want)]
    made = []
    for a, b in pairs:
        a, b = np.asarray(a), np.asarray(b)
        if a.dtype.kind not in ("c" if b.dtype.kind == "c" else "") + "fiub":
            raise UnlikeError(f"it returned {_kind(a)}; wanted real numbers")
        if a.shape != b.shape:
            raise UnlikeError(f"it returned {shape(got)}; wanted {shape(want)}")
        made.append((a.astype(np.result_type(a, b, float)), b))
    return made


def _kind(a: Array) -> str:
    return {"c": "complex numbers", "O": "no numbers", "U": "text", "S": "text"}.get(
        a.dtype.kind, "no numbers"
    )


def _one(a: Array, b: Array) -> float:
    if not a.size:
        return 0.0
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.where(same, 0.0, np.abs(a - b))
    finite = np.abs(b[np.isfinite(b)])
    return float(off.max() / max(1.0, float(finite.max(initial=0.0))))
