"""What every function asks of its arguments, and how it says no.

A check is one vectorised pass.  Only when that fails are the offending index
and number looked for, so that the message can name them.
"""

from collections.abc import Sequence
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, kernels

TOLERANCE = 1e-6
"""The largest entry of |R^T R - I|, or deviation of a norm from 1, that a caller may bring."""

LARGEST = 1e150
"""Squares of larger numbers overflow; squares of numbers below 1 / LARGEST vanish."""


def fail(
    where: str, name: str, must: str, got: str, index: Sequence[int] | None, remedy: str = ""
) -> NoReturn:
    """Raise the house's one-line ValueError."""
    at = "" if index is None else f" at index ({', '.join(map(str, index))}{',' if len(index) == 1 else ''})"
    raise ValueError(f"{where}: {name} must be {must}; got {got}{at}.{' ' + remedy if remedy else ''}")


def first(bad: NDArray[np.bool_]) -> tuple[int, ...]:
    """Return the batch index of the first true entry, or () for a single element."""
    return tuple(int(i) for i in np.unravel_index(int(np.argmax(bad)), bad.shape))


def array(
    where: str, name: str, x: ArrayLike, core: tuple[int, ...], check: bool = True
) -> NDArray[np.float64]:
    """Return x as a float64 array whose trailing axes are `core`, all finite."""
    wanted = f"numbers of shape ({', '.join(['...', *map(str, core)])})"
    try:
        a = np.asarray(x)
    except ValueError:
        fail(where, name, wanted, "a ragged list", None)
    if a.dtype.kind not in "fiu":
        fail(where, name, f"real {wanted}", f"dtype {a.dtype}", None)
    a = a.astype(np.float64, copy=False)
    if core and a.shape[-len(core) :] != core:
        fail(
            where,
            name,
            f"an array of shape ({', '.join(['...', *map(str, core)])})",
            f"shape {a.shape}",
            None,
        )
    # Both propagate nan, so they find nan, infinity and what would overflow when squared.
    if check and a.size and not (np.max(a) <= LARGEST and np.min(a) >= -LARGEST):
        bad = ~(np.abs(a) <= LARGEST)
        index = first(bad)
        batch = index[: a.ndim - len(core)]
        limit = "finite" if not np.isfinite(a[index]) else f"at most {LARGEST:.0e} in size"
        fail(where, name, limit, f"{a[index]}", batch)
    return a


def square(where: str, name: str, x: ArrayLike, check: bool = True, leading: int = 0) -> NDArray[np.float64]:
    """Return x as a float64 array of square matrices, or of lists of them where `leading` is 1."""
    a = array(where, name, x, (), check=False)
    if a.ndim < 2 + leading or a.shape[-1] != a.shape[-2]:
        wanted = "(..., k, n, n)" if leading else "(..., n, n)"
        fail(where, name, f"an array of shape {wanted}", f"shape {a.shape}", None)
    return array(where, name, a, a.shape[a.ndim - 2 - leading :], check)


def vector(where: str, name: str, x: ArrayLike, check: bool = True) -> NDArray[np.float64]:
    """Return x as a float64 array of vectors of any length but 0."""
    a = array(where, name, x, (), check=False)
    if a.ndim < 1 or not a.shape[-1]:
        fail(where, name, "an array of shape (..., n)", f"shape {a.shape}", None)
    return array(where, name, a, a.shape[-1:], check)


def rotation(where: str, name: str, R: ArrayLike, n: int, check: bool = True) -> NDArray[np.float64]:
    """Return R as a float64 array of rotations: no entry of |R^T R - I| above TOLERANCE, det R > 0."""
    a = array(where, name, R, (n, n), check=False)
    if not check or not a.size:
        return a
    with np.errstate(invalid="ignore", over="ignore"):
        defect = blocks.run(kernels.space_defect if n == 3 else kernels.plane_defect, (), (a, 2))
    # An eighth, because this cheap measure is not the promised one; what lies between is asked for that one.
    if np.max(defect) <= 0.125 * TOLERANCE:
        return a
    array(where, name, a, (n, n))
    _orthogonal(where, name, a, "a rotation")
    return a


def rigid(where: str, name: str, T: ArrayLike, n: int, check: bool = True) -> NDArray[np.float64]:
    """Return T as a float64 array of homogeneous matrices: a rotation, a translation, the row 0 ... 0 1."""
    a = array(where, name, T, (n + 1, n + 1), check=False)
    if not check or not a.size:
        return a
    kernel = kernels.space_rigid_defect if n == 3 else kernels.plane_rigid_defect
    good = 0.125 * TOLERANCE
    with np.errstate(invalid="ignore", over="ignore"):
        # One pass for all: a translation of the largest size allowed counts as a defect that is just allowed.
        defect = blocks.run(lambda T: kernel(T, good / LARGEST), (), (a, 2))
    if np.max(defect) <= good:
        return a
    array(where, name, a, (n + 1, n + 1))
    bottom = np.max(np.abs(a[..., n, :] - np.eye(n + 1)[n]), axis=-1)
    if np.any(bottom > TOLERANCE):
        index = first(bottom > TOLERANCE)
        row = " ".join(f"{entry:.3g}" for entry in a[index][n])
        fail(where, name, f"a rigid transformation, last row {'0 ' * n}1", f"last row {row}", index)
    _orthogonal(where, name, a[..., :n, :n], "a rigid transformation")
    return a


def _orthogonal(where: str, name: str, R: NDArray[np.float64], what: str) -> None:
    """Refuse what is not a rotation, or not one as a part of something else."""
    n = R.shape[-1]
    gram = np.max(np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(n)), axis=(-1, -2))
    if np.any(gram > TOLERANCE):
        index = first(gram > TOLERANCE)
        remedy = "Project it onto the rotations first."
        fail(where, name, f"{what}, |R^T R - I| <= {TOLERANCE:.0e}", f"{gram[index]:.1e}", index, remedy)
    flipped = np.linalg.det(R) < 0
    if np.any(flipped):
        remedy = "A reflection has no logarithm here; flip one axis."
        fail(where, name, f"{what}, det > 0", "det = -1", first(flipped), remedy)


def unit(where: str, name: str, x: ArrayLike, n: int, check: bool = True) -> NDArray[np.float64]:
    """Return x as a float64 array of vectors with norm 1."""
    a = array(where, name, x, (n,), check)
    if check and a.size:
        defect = np.abs(np.einsum("...i,...i->...", a, a) - 1.0)
        if not np.max(defect) <= 2 * TOLERANCE:  # the square's deviation is twice the norm's
            index = first(defect > 2 * TOLERANCE)
            norm = float(np.sqrt(np.sum(a[index] ** 2)))
            what = "a unit quaternion" if n == 4 else "a unit vector"
            fail(
                where,
                name,
                f"{what}, norm within {TOLERANCE:.0e} of 1",
                f"{norm:.6g}",
                index,
                "Normalise it.",
            )
    return a


def nonzero(where: str, name: str, x: ArrayLike, n: int, check: bool = True) -> NDArray[np.float64]:
    """Return x as a float64 array of vectors that are not 0."""
    a = array(where, name, x, (n,), check)
    if check and a.size:
        size = np.max(np.abs(a), axis=-1)
        if not np.min(size) >= 1.0 / LARGEST:
            small = size < 1.0 / LARGEST
            index = first(small)
            fail(where, name, "different from zero", f"norm {size[index]:.1e}", index)
    return a


def broadcast(where: str, **arrays: tuple[NDArray[np.float64], int]) -> None:
    """Refuse arguments whose batch shapes do not go together."""
    shapes = {name: a.shape[: a.ndim - n] for name, (a, n) in arrays.items()}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        names = " and ".join(shapes)
        fail(where, names, "batches that broadcast", " and ".join(map(str, shapes.values())), None)
