"""Interpolation between unit dual complex numbers about a pole, and their linear blending.

Reached as `dual_complex.sclerp`, `dual_complex.dlb` and `dual_complex.align`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import blocks, checks, dual_complex_kernels
from lietool.lie.dual_checks import counted, refuse_opposite, unvanished
from lietool.lie.dual_checks import unit_complex as unit

Array = NDArray[np.float64]


def align(p: ArrayLike, reference: ArrayLike) -> Array:
    """Return p or -p, the same motion, whichever p0 makes at most a right angle with the reference's.

    Book: 2.10, two unit dual complex numbers for each motion

    Parameters
    ----------
    p : (..., 4)
    reference : (..., 4)

    Returns
    -------
    aligned : (..., 4)
    """
    where = "dual_complex.align"
    a = checks.array(where, "p", p, (4,), check=False)
    b = checks.array(where, "reference", reference, (4,), check=False)
    checks.broadcast(where, p=(a, 1), reference=(b, 1))
    cosine = np.einsum("...i,...i->...", a[..., :2], b[..., :2])
    return a * np.where(cosine < 0.0, -1.0, 1.0)[..., None]


def sclerp(p: ArrayLike, q: ArrayLike, t: ArrayLike, *, check: bool = True) -> Array:
    """Interpolate from p to q by a turn about a fixed pole at constant speed: p exp(t log(p^-1 q)).

    If the real parts make an obtuse angle it turns by more than a half turn:
    the long way is not shortened silently.  For the short way pass align(q, p).

    Book: 2.10, (2.33) with dual complex numbers

    Parameters
    ----------
    p : (..., 4), unit dual complex number
    q : (..., 4), unit dual complex number
    t : (...)
        0 at p, 1 at q; other numbers go on about the pole.
    check : bool, False to trust the values

    Returns
    -------
    r : (..., 4), unit dual complex number

    Raises
    ------
    ValueError
        If p or q is not a unit dual complex number, or q0 = -p0, where there is no pole.
    """
    where = "dual_complex.sclerp"
    a, b = unit(where, "p", p, check), unit(where, "q", q, check)
    s = checks.array(where, "t", t, (), check)
    checks.broadcast(where, p=(a, 1), q=(b, 1), t=(s, 0))
    if check:
        ratio = blocks.run(dual_complex_kernels.ratio, (4,), (a, 1), (b, 1))
        refuse_opposite(where, "q", ratio, "reached from p about a pole: p^-1 q with a logarithm")
    return blocks.run(dual_complex_kernels.sclerp, (4,), (a, 1), (b, 1), (s, 0))


def dlb(weights: ArrayLike, p: ArrayLike, *, check: bool = True) -> Array:
    """Blend unit dual complex numbers linearly: the sum of w_i p_i by its norm.

    The signs are first aligned to that of the first.  Only the ratios of the
    weights matter; negative ones go beyond, as long as the sum of the real
    parts does not vanish.  The blend moves along with its arguments under
    multiplication from the left and from the right.

    Book: 2.10
    Kaji-Ochiai: 6, the anti-commutative dual complex numbers

    Parameters
    ----------
    weights : (..., k)
    p : (..., k, 4), unit dual complex number
    check : bool, False to trust the values

    Returns
    -------
    blend : (..., 4), unit dual complex number

    Raises
    ------
    ValueError
        If a p is not a unit dual complex number, a weight is not finite, or
        the real parts cancel each other.
    """
    where = "dual_complex.dlb"
    w, a = counted(where, weights, "p", p, (4,), check)
    unit(where, "p", a, check)
    total = np.einsum("...k,...ki->...i", w, align(a, a[..., :1, :]))
    return unvanished(where, w, total, 2)
