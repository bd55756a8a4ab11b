"""Quaternions z + w j as complex matrices of two rows.

Reached as `quaternion.to_complex_matrix` and `quaternion.from_complex_matrix`.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks


def to_complex_matrix(q: ArrayLike) -> NDArray[np.complex128]:
    """Return the complex matrix (z -w; w_bar z_bar) of q = z + w j, z = a + b i, w = c + d i.

    It is a homomorphism, and the determinant is |q|^2; those of unit quaternions make up SU(2).

    Book: (2.37)

    Parameters
    ----------
    q : (..., 4)

    Returns
    -------
    M : (..., 2, 2)
    """
    q = checks.array("quaternion.to_complex_matrix", "q", q, (4,), check=False)
    z, w = q[..., 0] + 1j * q[..., 1], q[..., 2] + 1j * q[..., 3]
    M = np.stack([z, -w, np.conj(w), np.conj(z)], axis=-1)
    return M.reshape(*M.shape[:-1], 2, 2)


def from_complex_matrix(M: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the quaternion of a complex matrix of the form (z -w; w_bar z_bar).

    Book: (2.37)

    Parameters
    ----------
    M : (..., 2, 2), complex form
    check : bool, False to trust the values

    Returns
    -------
    q : (..., 4)

    Raises
    ------
    ValueError
        If M is not of that form, within 1e-6 of its largest entry.
    """
    where, must = "quaternion.from_complex_matrix", "real numbers or complex ones of shape (..., 2, 2)"
    try:
        m = np.asarray(M)
    except ValueError:
        checks.fail(where, "M", must, "a ragged list", None)
    if m.dtype.kind not in "fiuc":
        checks.fail(where, "M", must, f"dtype {m.dtype}", None)
    if m.shape[-2:] != (2, 2):
        checks.fail(where, "M", "an array of shape (..., 2, 2)", f"shape {m.shape}", None)
    z, w = m[..., 0, 0], np.conj(m[..., 1, 0])
    if check and m.size:
        with np.errstate(invalid="ignore"):
            defect = np.maximum(np.abs(m[..., 1, 1] - np.conj(z)), np.abs(m[..., 0, 1] + w))
        size = np.max(np.abs(m), axis=(-1, -2))
        bad = ~(defect <= checks.TOLERANCE * size) | ~(size <= checks.LARGEST)
        if np.any(bad):
            index = checks.first(bad)
            finite = size[index] <= checks.LARGEST
            form = "of the form (z -w; conj w, conj z)" if finite else "finite"
            got = f"a deviation of {defect[index]:.1e}" if finite else f"size {size[index]}"
            checks.fail(where, "M", form, got, index)
    # The mean of what should be equal: the nearest matrix of the form.
    z, w = 0.5 * (z + np.conj(m[..., 1, 1])), 0.5 * (w - m[..., 0, 1])
    return np.stack([z.real, z.imag, w.real, w.imag], axis=-1).astype(np.float64)
