"""What to do with transformations that turn space inside out or flatten it: a policy, passed as a function.

No blend but the linear one can take them, for there is no path to them from
the identity.  `refuse` says which there are; `nearest` replaces them, and says how many.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, matrix_checks

Array = NDArray[np.float64]

FLATTEST = 1e-3
"""The ratio of the smallest to the largest stretch of what `nearest` puts in place of a reflection."""


@dataclass(frozen=True)
class Oriented:
    """Transformations (..., 4, 4) with det > 0, and which of them were replaced (...)."""

    A: Array
    replaced: NDArray[np.bool_]


Policy = Callable[[ArrayLike], Oriented]


def _signed(where: str, A: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """Return affine transformations, and U, d, V^T of their linear parts.

    The last of d has the sign of the determinant, for U V^T is a rotation.
    """
    a = matrix_checks.affine(where, "A", checks.array(where, "A", A, (4, 4)))
    U, d, Vt = np.linalg.svd(a[..., :3, :3])
    flipped = np.linalg.det(U @ Vt) < 0.0
    U[flipped, :, 2] *= -1.0
    d[flipped, 2] *= -1.0
    return a, U, d, Vt


def refuse(A: ArrayLike) -> Oriented:
    """Return transformations as they are, or say which have no positive determinant.

    Book: (3.4)

    Parameters
    ----------
    A : (..., 4, 4), Aff+

    Returns
    -------
    oriented : Oriented

    Raises
    ------
    ValueError
        If an A is not affine, or its determinant is not positive, or is but rounding.
    """
    where = "orientation.refuse"
    a, _, d, _ = _signed(where, A)
    bad = ~(d[..., 2] > matrix_checks.UNDECIDED * d[..., 0])
    if np.any(bad):
        index = checks.first(bad)
        # The signed singular values say more than a determinant, which may be large and yet rounding.
        values = ", ".join(f"{x:.3g}" for x in d[index])
        got = f"singular values {values}, one of {int(np.sum(bad))}"
        must, remedy = "transformations with det > 0", "Mend it, or take orientation.nearest(A)."
        checks.fail(where, "A", must, got, index, remedy)
    return Oriented(a.copy(), bad)


def nearest(A: ArrayLike) -> Oriented:
    """Replace what has no positive determinant by the nearest that is no flatter than 1 : 1000.

    Nearest in the sum of squares: of the singular values, signed so that the
    axes are right-handed, those below `FLATTEST` times the largest become that.

    Book: (3.4), (3.14)

    Parameters
    ----------
    A : (..., 4, 4), affine

    Returns
    -------
    oriented : Oriented

    Raises
    ------
    ValueError
        If an A is not affine, or its linear part is 0.
    """
    where = "orientation.nearest"
    a, U, d, Vt = _signed(where, A)
    bad = ~(d[..., 2] > matrix_checks.UNDECIDED * d[..., 0])
    nothing = bad & ~(d[..., 0] > 0.0)
    if np.any(nothing):
        must = "different from 0 in its linear part"
        checks.fail(where, "A", must, "0", checks.first(nothing), "No size is the nearest to none.")
    result = a.copy()
    d = np.maximum(d, FLATTEST * d[..., :1])
    result[bad, :3, :3] = ((U * d[..., None, :]) @ Vt)[bad]
    return Oriented(result, bad)


POLICIES: dict[str, Policy] = {"raise": refuse, "nearest": nearest}
"""The policies by the names that commands give them."""
