"""Interpolation between unit dual quaternions along a screw, and their linear blending.

Reached as `dual_quaternion.sclerp`, `dual_quaternion.dlb` and `dual_quaternion.align`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, dual_kernels, series
from lietool.lie.dual_checks import counted, unit, unvanished

Array = NDArray[np.float64]


def align(q: ArrayLike, reference: ArrayLike) -> Array:
    """Return q or -q, the same motion, whichever real part makes at most a right angle with the reference's.

    Book: 2.8, two unit dual quaternions for each motion

    Parameters
    ----------
    q : (..., 8)
    reference : (..., 8)

    Returns
    -------
    aligned : (..., 8)
    """
    where = "dual_quaternion.align"
    a = checks.array(where, "q", q, (8,), check=False)
    b = checks.array(where, "reference", reference, (8,), check=False)
    checks.broadcast(where, q=(a, 1), reference=(b, 1))
    cosine = np.einsum("...i,...i->...", a[..., :4], b[..., :4])
    return a * np.where(cosine < 0.0, -1.0, 1.0)[..., None]


def sclerp(q0: ArrayLike, q1: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Interpolate from q0 to q1 by a screw at constant speed: q0 exp(t log(q0^-1 q1)).

    The real part goes as `quaternion.slerp`.  If the real parts make an obtuse
    angle the screw turns by more than a half turn: the long way is not
    shortened silently.  For the short way pass align(q1, q0).

    Book: 2.8, (2.33) with dual numbers

    Parameters
    ----------
    q0 : (..., 8), unit dual quaternion
    q1 : (..., 8), unit dual quaternion
    t : (...)
        0 at q0, 1 at q1; other numbers go on along the screw.
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If q0 or q1 is not a unit dual quaternion, or the real part of q1 is
        minus that of q0, where no axis is singled out.
    """
    where = "dual_quaternion.sclerp"
    a, b = unit(where, "q0", q0, check), unit(where, "q1", q1, check)
    s = checks.array(where, "t", t, (), check)
    checks.broadcast(where, q0=(a, 1), q1=(b, 1), t=(s, 0))
    if check:
        gap = np.max(np.abs(a[..., :4] + b[..., :4]), axis=-1)
        if np.any(gap <= series.ROUNDED):
            index = checks.first(gap <= series.ROUNDED)
            got = f"the opposite rotation, {np.broadcast_to(b, (*gap.shape, 8))[index][:4]}"
            remedy = "No screw is singled out; align the signs, or go by way of a third."
            checks.fail(where, "q1", "different from -q0 in its real part", got, index, remedy)
    return blocks.run(dual_kernels.sclerp, (8,), (a, 1), (b, 1), (s, 0))


def dlb(weights: ArrayLike, q: ArrayLike, *, check: bool = True) -> Array:
    """Blend unit dual quaternions linearly: the sum of w_i q_i by its norm.

    The signs are first aligned to that of the first.  Only the ratios of the
    weights matter; negative ones go beyond, as long as the sum of the real
    parts does not vanish.  The blend moves along with its arguments under
    multiplication from the left and from the right.

    Book: 2.8
    Kaji-Ochiai: 6, the bi-invariant blend of SE(3)

    Parameters
    ----------
    weights : (..., k)
    q : (..., k, 8), unit dual quaternion
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 8), unit dual quaternion

    Raises
    ------
    ValueError
        If a q is not a unit dual quaternion, a weight is not finite, or the
        real parts cancel each other.
    """
    where = "dual_quaternion.dlb"
    w, a = counted(where, weights, "q", q, (8,), check)
    unit(where, "q", a, check)
    total = np.einsum("...k,...ki->...i", w, align(a, a[..., :1, :]))
    total = unvanished(where, w, total, 4)
    return blocks.run(dual_kernels.normalized, (8,), (total, 1))
