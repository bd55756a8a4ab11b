"""What the weights (n, k) of points are made to sum to.

Reached as `weights.capped`, and so on.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform.weight_checks import CANCELLED, matrix, positive
from lietool.lie import checks

Array = NDArray[np.float64]


def unnormalised(w: ArrayLike) -> Array:
    """Return weights as they are, checked.

    Kaji-Ochiai: (9), which asks nothing of their sum

    Parameters
    ----------
    w : (n, k)

    Returns
    -------
    w : (n, k)

    Raises
    ------
    ValueError
        If w has another shape, or is not finite.
    """
    return matrix("weights.unnormalised", "w", w).copy()


def partition_of_unity(w: ArrayLike) -> Array:
    """Return weights divided by their sum.

    Kaji-Ochiai: 5.1

    Parameters
    ----------
    w : (n, k)

    Returns
    -------
    w : (n, k)
        The sum over the probes is 1 at every point.

    Raises
    ------
    ValueError
        If the weights of a point are all 0, or cancel each other, or are not finite.
    """
    where = "weights.partition_of_unity"
    a = matrix(where, "w", w)
    total = np.sum(a, axis=1, keepdims=True)
    lost = np.abs(total[:, 0]) <= CANCELLED * np.sum(np.abs(a), axis=1)
    if np.any(lost):
        point = checks.first(lost)
        got = f"0 at {int(np.sum(lost))} of {len(a)} points, first"
        checks.fail(
            where, "w", "weights with a sum other than 0", got, point, "Take capped(w), or more reach."
        )
    return a / total


def softmax(w: ArrayLike, sharpness: float = 1.0) -> Array:
    """Return exp(s w), divided by the sum of these: positive everywhere, also where w is 0.

    Kaji-Ochiai: 5.1

    Parameters
    ----------
    w : (n, k)
    sharpness : float
        The factor s above 0: the greater, the more the largest weight takes.

    Returns
    -------
    w : (n, k)
        The sum over the probes is 1 at every point.

    Raises
    ------
    ValueError
        If w has another shape, or is not finite, or the sharpness is not above 0.
    """
    a = matrix("weights.softmax", "w", w)
    s = float(positive("weights.softmax", "sharpness", sharpness))
    e = s * (a - np.max(a, axis=1, keepdims=True))
    with np.errstate(under="ignore"):
        np.exp(e, out=e)
    e /= np.sum(e, axis=1, keepdims=True)
    return e


def capped(w: ArrayLike) -> Array:
    """Return weights divided by max(1, sum): where they sum to less than 1, the rest is the identity's.

    Kaji-Ochiai: (9), with weights that end at a cutoff

    Parameters
    ----------
    w : (n, k)

    Returns
    -------
    w : (n, k)

    Raises
    ------
    ValueError
        If w has another shape, or is not finite.
    """
    a = matrix("weights.capped", "w", w)
    return a / np.maximum(np.sum(a, axis=1, keepdims=True), 1.0)


NORMALISATIONS: dict[str, Callable[[ArrayLike], Array]] = {
    "none": unnormalised,
    "partition_of_unity": partition_of_unity,
    "softmax": softmax,
    "capped": capped,
}
"""What may be done to the sums of weights, by name."""
