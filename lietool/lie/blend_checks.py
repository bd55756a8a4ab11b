"""What the ways of blending ask of their arguments."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, matrix_checks
from lietool.lie.dual_checks import counted

Array = NDArray[np.float64]


def arguments(where: str, weights: ArrayLike, A: ArrayLike, check: bool) -> tuple[Array, Array]:
    """Return weights (..., k) and homogeneous matrices (..., k, 4, 4)."""
    w, a = counted(where, weights, "A", A, (4, 4), check)
    return w, matrix_checks.affine(where, "A", a, check)


def oriented(where: str, weights: ArrayLike, A: ArrayLike, check: bool) -> tuple[Array, Array]:
    """Return the arguments of the ways that decompose A, which refuse det <= 0."""
    w, a = arguments(where, weights, A, check)
    if check and a.size:
        L = a[..., :3, :3]
        size = np.max(np.abs(L), axis=(-1, -2), keepdims=True)
        det = np.linalg.det(L / np.where(size > 0.0, size, 1.0))
        if not np.min(det) > 0.0:
            index = checks.first(~(det > 0.0))
            remedy = "Leave it out, or replace it by the nearest with det > 0."
            checks.fail(
                where, "A", "matrices with det > 0", f"det = {np.linalg.det(L[index]):.3g}", index, remedy
            )
    return w, a
