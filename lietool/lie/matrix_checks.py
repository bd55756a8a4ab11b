"""What the functions of symmetric, square and affine matrices ask of their arguments, beside `checks`."""

from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks
from lietool.lie.blocks import Rows

UNDECIDED = 4.0 * float(np.finfo(np.float64).eps)
"""Relative to the largest singular value: what is smaller may be rounding."""


def square(where: str, name: str, A: ArrayLike, check: bool = True) -> NDArray[np.float64]:
    """Return A as a float64 array of 2 x 2 or 3 x 3 matrices, all finite."""
    a = checks.array(where, name, A, (), check=False)
    if a.ndim < 2 or a.shape[-1] not in (2, 3) or a.shape[-2] != a.shape[-1]:
        checks.fail(where, name, "an array of shape (..., n, n), n = 2 or 3", f"shape {a.shape}", None)
    return checks.array(where, name, a, a.shape[-2:], check)


def _asymmetry(S: Rows) -> Rows:
    """Return how far the largest |S - S^T| is above what is allowed; nan if S has one."""
    n = 2 if len(S) == 4 else 3
    size = np.abs(S[0])
    for entry in S[1:]:
        size = np.maximum(size, np.abs(entry))
    gap = np.abs(S[1] - S[n])
    if n == 3:
        gap = np.maximum(gap, np.maximum(np.abs(S[2] - S[6]), np.abs(S[5] - S[7])))
    return (np.where(size <= checks.LARGEST, gap - checks.TOLERANCE * size, np.nan),)


def symmetric(where: str, name: str, S: ArrayLike, check: bool = True) -> NDArray[np.float64]:
    """Return S as a float64 array of matrices with |S - S^T| <= TOLERANCE |S|, in their largest entries."""
    a = square(where, name, S, check=False)
    if check and a.size:
        with np.errstate(invalid="ignore", over="ignore"):
            excess = blocks.run(_asymmetry, (), (a, 2))
        if not np.max(excess) <= 0.0:
            checks.array(where, name, a, a.shape[-2:])
            index = checks.first(excess > 0.0)
            must = f"symmetric, |{name} - {name}^T| <= {checks.TOLERANCE:.0e} |{name}|"
            gap = np.max(np.abs(a[index] - a[index].T))
            checks.fail(where, name, must, f"{gap:.1e}", index, "Take its symmetric part.")
    return a


def inside_out(where: str, A: NDArray[np.float64], index: tuple[int, ...]) -> NoReturn:
    """Raise the error for one matrix whose determinant is not positive."""
    det = float(np.linalg.det(A))
    got = f"det = {det:.3g}" + (", which is rounding" if det > 0.0 else "")
    remedy = "It turns space inside out or flattens it; stretches and rotations do not."
    checks.fail(where, "A", "a matrix with det > 0", got, index, remedy)


def orientation(where: str, A: NDArray[np.float64], smallest: NDArray[np.float64]) -> None:
    """Refuse A where its smallest singular value, with the sign of the determinant, is not positive."""
    if smallest.size and not np.min(smallest) > 0.0:
        index = checks.first(~(smallest > 0.0))
        n = smallest.ndim
        inside_out(where, A.reshape(*smallest.shape, *A.shape[n:])[index], index)


def affine(where: str, name: str, A: ArrayLike, check: bool = True) -> NDArray[np.float64]:
    """Return A as a float64 array of homogeneous matrices, last row 0 ... 0 1, of any determinant."""
    a = checks.array(where, name, A, (), check=False)
    if a.ndim < 2 or a.shape[-1] not in (3, 4) or a.shape[-2] != a.shape[-1]:
        must = "an array of shape (..., 4, 4), or (..., 3, 3) in the plane"
        checks.fail(where, name, must, f"shape {a.shape}", None)
    a = checks.array(where, name, a, a.shape[-2:], check)
    if check and a.size:
        n = a.shape[-1] - 1
        last = np.eye(n + 1)[n]
        if any(np.max(np.abs(a[..., n, i] - last[i])) > checks.TOLERANCE for i in range(n + 1)):
            bottom = np.max(np.abs(a[..., n, :] - last), axis=-1)
            index = checks.first(bottom > checks.TOLERANCE)
            row = " ".join(f"{entry:.3g}" for entry in a[index][n])
            must = f"an affine transformation, last row {'0 ' * n}1"
            checks.fail(where, name, must, f"last row {row}", index)
    return a


def invertible(where: str, name: str, A: NDArray[np.float64]) -> None:
    """Refuse homogeneous matrices whose linear parts are singular, or so nearly that rounding may be why."""
    n = A.shape[-1] - 1
    d = np.linalg.svd(A[..., :n, :n], compute_uv=False)
    flat = ~(d[..., -1] > UNDECIDED * d[..., 0])
    if np.any(flat):
        index = checks.first(flat)
        values = ", ".join(f"{x:.3g}" for x in d[index])
        checks.fail(where, name, "invertible", f"singular values {values}", index)


def parameters(where: str, name: str, p: ArrayLike, check: bool = True) -> tuple[NDArray[np.float64], int]:
    """Return parameters of affine transformations as a float64 array, and the dimension that they are for."""
    a = checks.array(where, name, p, (), check=False)
    n = {12: 3, 6: 2}.get(a.shape[-1] if a.ndim else 0)
    if n is None:
        must = "an array of shape (..., 12), or (..., 6) in the plane"
        checks.fail(where, name, must, f"shape {a.shape}", None)
    return checks.array(where, name, a, a.shape[-1:], check), n
