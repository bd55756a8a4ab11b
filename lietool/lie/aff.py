"""The Lie algebra aff(3) and its exponential into Aff+(3), which does not reach every transformation.

An element of aff(3) is a matrix (L l; 0 0).  The exponentials are the squares
B^2: a transformation with negative eigenvalues is one only if they are equal
and not sheared, like a half turn.  This is why blending in aff(3) (Alexa 2002)
fails for some inputs, and why the texts go by the polar decomposition.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import aff_kernels, blocks, checks, matrix_checks

Array = NDArray[np.float64]


MUST = "an exponential, with no negative eigenvalue but equal pairs without shear"
REMEDY = "It has no real logarithm; use phi_so or phi_se, which reach all of Aff+(3)."


def _affine(where: str, A: ArrayLike, check: bool) -> Array:
    a = checks.array(where, "A", A, (4, 4), check)
    return matrix_checks.affine(where, "A", a, check)


def _eigenvalues(A: Array) -> str:
    return ", ".join(f"{x:.4g}" for x in np.linalg.eigvals(A[:3, :3]))


def exp(X: ArrayLike, *, check: bool = True) -> Array:
    """Return the exponential of an element of aff(3).

    Book: (4.1), 4.3 (x)
    Kaji-Ochiai: (10)

    Parameters
    ----------
    X : (..., 4, 4), infinitesimal affine
        With last row 0.
    check : bool, False to trust the values

    Returns
    -------
    A : (..., 4, 4), affine

    Raises
    ------
    ValueError
        If X is not finite, its last row is not 0, or its exponential overflows.
    """
    X = checks.array("aff.exp", "X", X, (4, 4), check)
    if check and X.size:
        bottom = np.max(np.abs(X[..., 3, :]), axis=-1)
        if np.any(bottom > 0.0):
            index = checks.first(bottom > 0.0)
            row = " ".join(f"{entry:.3g}" for entry in X[index][3])
            checks.fail("aff.exp", "X", "in aff(3), last row 0", f"last row {row}", index)
    with np.errstate(over="ignore", invalid="ignore"):
        A = blocks.run(aff_kernels.exp, (4, 4), (X, 2))
    if check and A.size and not np.max(np.abs(A)) < np.inf:
        index = checks.first(~np.all(np.isfinite(A), axis=(-1, -2)))
        checks.fail("aff.exp", "X", "with eigenvalues below 709", "an overflow", index)
    return A


def log(A: ArrayLike, *, check: bool = True) -> Array:
    """Return a real logarithm of an affine transformation: the principal one, where there is one.

    Its eigenvalues have imaginary parts from -pi to pi.  At a half turn with a
    scaling, where many serve, it turns by the right hand about the axis whose
    largest component is positive, as `so3.log` does.

    Book: 4.3 (x)
    Kaji-Ochiai: (11), for matrices that need not be diagonalisable

    Parameters
    ----------
    A : (..., 4, 4), affine exponential
        With a real logarithm.
    check : bool, False to trust the values
        Then it is 0 where there is no real logarithm.

    Returns
    -------
    X : (..., 4, 4)

    Raises
    ------
    ValueError
        If A is not affine or has no real logarithm.
    """
    a = _affine("aff.log", A, check)
    flat = a.reshape(-1, 4, 4)
    X, exists = aff_kernels.real_log(flat)
    if check and not np.all(exists):
        index = checks.first(~exists.reshape(a.shape[:-2]))
        got = f"eigenvalues {_eigenvalues(a[index])}"
        checks.fail("aff.log", "A", MUST, got, index, REMEDY)
    return X.reshape(a.shape)


def has_logarithm(A: ArrayLike, *, check: bool = True) -> NDArray[np.bool_]:
    """Tell whether an affine transformation has a real logarithm.

    Kaji-Ochiai: 6, the image of the exponential are the squares

    Parameters
    ----------
    A : (..., 4, 4), affine
    check : bool, False to trust the values

    Returns
    -------
    exists : (...)

    Raises
    ------
    ValueError
        If A is not affine.
    """
    a = _affine("aff.has_logarithm", A, check)
    _, exists = aff_kernels.real_log(a.reshape(-1, 4, 4))
    return exists.reshape(a.shape[:-2])
