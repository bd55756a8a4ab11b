"""What the functions of dual numbers ask of their arguments, besides `checks`."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, series

Array = NDArray[np.float64]


def invertible(where: str, name: str, q: ArrayLike, check: bool = True, real: int = 4) -> Array:
    """Return q as a float64 array of dual numbers whose real part, the first half, is not 0."""
    a = checks.array(where, name, q, (2 * real,), check)
    if check and a.size:
        size = np.max(np.abs(a[..., :real]), axis=-1)
        if not np.min(size) >= 1.0 / checks.LARGEST:
            index = checks.first(size < 1.0 / checks.LARGEST)
            got = f"a real part of norm {size[index]:.1e}"
            checks.fail(where, name, "invertible, with a real part different from zero", got, index)
    return a


def unit(where: str, name: str, q: ArrayLike, check: bool = True) -> Array:
    """Return q as a float64 array of dual quaternions z + w eps with |z| = 1 and <z, w> = 0."""
    a = checks.array(where, name, q, (8,), check)
    if check and a.size:
        z, w = a[..., :4], a[..., 4:]
        _length(where, name, z, "a unit dual quaternion")
        along = np.abs(np.einsum("...i,...i->...", z, w))
        allowed = checks.TOLERANCE * np.maximum(1.0, np.max(np.abs(w), axis=-1))
        if np.any(along > allowed):
            index = checks.first(along > allowed)
            must = f"a unit dual quaternion, |<z, w>| <= {checks.TOLERANCE:.0e} max(1, |w|)"
            checks.fail(where, name, must, f"{along[index]:.1e}", index, "Normalise it.")
    return a


def unit_complex(where: str, name: str, p: ArrayLike, check: bool = True) -> Array:
    """Return p as a float64 array of dual complex numbers with |p0| = 1."""
    a = checks.array(where, name, p, (4,), check)
    if check and a.size:
        _length(where, name, a[..., :2], "a unit dual complex number")
    return a


def _length(where: str, name: str, z: Array, what: str) -> None:
    square = np.einsum("...i,...i->...", z, z)
    bad = np.abs(square - 1.0) > 2 * checks.TOLERANCE  # the square's deviation is twice the norm's
    if np.any(bad):
        index = checks.first(bad)
        must = f"{what}, norm within {checks.TOLERANCE:.0e} of 1"
        checks.fail(where, name, must, f"{np.sqrt(square[index]):.6g}", index, "Normalise it.")


def counted(
    where: str, weights: ArrayLike, name: str, x: ArrayLike, core: tuple[int, ...], check: bool
) -> tuple[Array, Array]:
    """Return weights (..., k) and what they weigh (..., k, *core), one or more of it and as many of each."""
    a = checks.array(where, name, x, core, check=False)
    w = checks.array(where, "weights", weights, (), check=False)
    n = a.ndim - len(core)
    if n == 0 or a.shape[n - 1] == 0:
        shape = f"an array of shape (..., k, {', '.join(map(str, core))}), k >= 1"
        checks.fail(where, name, shape, f"shape {a.shape}", None)
    k = a.shape[n - 1]
    w = checks.array(where, "weights", w, (k,), check)
    a = checks.array(where, name, a, (k, *core), check)
    checks.broadcast(where, **{"weights": (w, 1), name: (a, len(core) + 1)})
    return w, a


def unvanished(where: str, weights: Array, total: Array, real: int) -> Array:
    """Return a weighted sum by the norm of its real part, or say which weights cancel that."""
    length = np.linalg.norm(total[..., :real], axis=-1)
    bad = length <= series.ROUNDED * np.sum(np.abs(weights), axis=-1)
    if np.any(bad):
        index = checks.first(bad)
        got = np.broadcast_to(weights, (*length.shape, weights.shape[-1]))[index]
        must = "such that the sum of the real parts does not vanish"
        checks.fail(where, "weights", must, f"weights {got}", index)
    return total / length[..., None]


def refuse_opposite(where: str, name: str, p: Array, must: str) -> None:
    """Refuse p0 = -1 with another p1 than 0: no exponential is there, nor is any within reach nearby."""
    bad = (p[..., 0] < 0.0) & (np.abs(p[..., 1]) <= series.ROUNDED)
    bad &= np.max(np.abs(p[..., 2:]), axis=-1) > series.ROUNDED
    if np.any(bad):
        index = checks.first(bad)
        checks.fail(where, name, must, f"{p[index]}", index, "Take its negative: the same motion.")
