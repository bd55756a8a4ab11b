"""Affine transformations with positive determinant, Aff+(n), in coordinates of a linear space, n = 3 or 2.

A parameter is a rotation vector x (radians), a translation part l and a
symmetric matrix Y by its upper triangle: 12 numbers, x 3, l 3, xx xy xz yy yz
zz; in the plane 6, angle 1, l 2, xx xy yy.  A transformation is its
homogeneous matrix, 4 x 4 or 3 x 3.  The texts have two different maps:

    phi_so(x, l, Y):  p -> exp(x) exp(Y) p + l       Kaji and Ochiai
    phi_se(x, l, Y):  p -> exp(x, l) (exp(Y) p)      the book; exp of se(n)

where exp(x) is the texts' exp(X), X = so3.hat(x).  Kaji and Ochiai list l first
and then X12, X13, X23, which are -x3, x2, -x1.

`psi_so` and `psi_se` go back, by the principal rotation; `psi_so_near` and
`psi_se_near` by the one nearest to a reference.  No inverse is continuous on
all of Aff+: along R_x(2 pi t) it jumps, or ends at 2 pi, not 0.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import affine_kernels, blocks, checks, matrix_checks, series, so3
from lietool.lie.affine_classes import CLASSES as CLASSES
from lietool.lie.affine_classes import project as project

_NOTHING = 1e-9
"""Radians, lengths or logarithms of stretch: what `classify` takes for 0."""


def _phi(where: str, space, plane, params: ArrayLike, check: bool) -> NDArray[np.float64]:
    p, n = matrix_checks.parameters(where, "params", params, check)
    with np.errstate(over="ignore", invalid="ignore"):
        A = blocks.run(space if n == 3 else plane, (n + 1, n + 1), (p, 1))
    if check and A.size and not np.max(A) < np.inf:
        index = checks.first(~np.all(np.isfinite(A), axis=(-1, -2)))
        checks.fail(where, "params", "with eigenvalues of the symmetric part below 709", "an overflow", index)
    return A


def _psi(where: str, space, plane, A: ArrayLike, check: bool) -> NDArray[np.float64]:
    A = matrix_checks.affine(where, "A", A, check)
    n = A.shape[-1] - 1
    p = blocks.run(space if n == 3 else plane, (12 if n == 3 else 6,), (A, 2))
    if check:
        _oriented(where, A, p)
    return p


def _oriented(where: str, A: NDArray[np.float64], p: NDArray[np.float64]) -> None:
    """Refuse A where the symmetric part came out as nan: the determinant is not positive."""
    if p.size and np.isnan(np.min(p[..., -1])):
        index = checks.first(np.isnan(p[..., -1]))
        matrix_checks.inside_out(where, A[index], index)


def phi_so(params: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the affine transformation p -> exp(x) exp(Y) p + l.

    Kaji-Ochiai: (1), (2)

    Parameters
    ----------
    params : (..., 12)
        Or (..., 6), of the plane.
    check : bool, False to trust the values

    Returns
    -------
    A : (..., 4, 4), Aff+

    Raises
    ------
    ValueError
        If params are not finite, or so large that exp(Y) overflows.
    """
    return _phi("affine.phi_so", affine_kernels.phi_so, affine_kernels.phi_so_plane, params, check)


def phi_se(params: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the affine transformation that stretches by exp(Y), then moves by exp(x, l) in SE(n).

    Book: (7.1), (7.5)
    MEIS: (1)

    Parameters
    ----------
    params : (..., 12)
        Or (..., 6), of the plane.
    check : bool, False to trust the values

    Returns
    -------
    A : (..., 4, 4), Aff+

    Raises
    ------
    ValueError
        If params are not finite, or so large that exp(Y) overflows.
    """
    return _phi("affine.phi_se", affine_kernels.phi_se, affine_kernels.phi_se_plane, params, check)


def psi_so(A: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the parameters of an affine transformation under `phi_so`, with the principal rotation.

    Kaji-Ochiai: (3), (7), (8)

    Parameters
    ----------
    A : (..., 4, 4), Aff+
        Or (..., 3, 3), of the plane.
    check : bool, False to trust the values
        Then the symmetric part is nan where the determinant is not positive.

    Returns
    -------
    params : (..., 12)

    Raises
    ------
    ValueError
        If A is not affine or its determinant is not positive.
    """
    return _psi("affine.psi_so", affine_kernels.psi_so, affine_kernels.psi_so_plane, A, check)


def psi_se(A: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the parameters of an affine transformation under `phi_se`, with the principal rotation.

    Book: (7.2), (7.8)
    MEIS: (2)

    Parameters
    ----------
    A : (..., 4, 4), Aff+
        Or (..., 3, 3), of the plane.
    check : bool, False to trust the values
        Then the symmetric part is nan where the determinant is not positive.

    Returns
    -------
    params : (..., 12)

    Raises
    ------
    ValueError
        If A is not affine or its determinant is not positive.
    """
    return _psi("affine.psi_se", affine_kernels.psi_se, affine_kernels.psi_se_plane, A, check)


def _near(where: str, A: ArrayLike, reference: ArrayLike, check: bool) -> tuple[NDArray[np.float64], int]:
    """Return the parameters under phi_so with the rotation nearest to that of the reference."""
    A = matrix_checks.affine(where, "A", A, check)
    r, n = matrix_checks.parameters(where, "reference", reference, check)
    if A.shape[-1] != n + 1:
        must = f"parameters of {A.shape[-1] - 1} dimensions"
        checks.fail(where, "reference", must, f"shape {r.shape}", None)
    checks.broadcast(where, A=(A, 2), reference=(r, 1))
    if n == 2:
        p = blocks.run(affine_kernels.psi_so_plane, (6,), (A, 2))
        R = None
    else:
        parts = blocks.run(affine_kernels.psi_parts, (15,), (A, 2))
        R = parts[..., :9].reshape(*parts.shape[:-1], 3, 3)
        p = np.concatenate([np.zeros_like(parts[..., :3]), A[..., :3, 3], parts[..., 9:]], axis=-1)
    if check:
        _oriented(where, A, p)
    p = np.broadcast_to(p, np.broadcast_shapes(p.shape, r.shape)).copy()
    if R is None:
        p[..., 0] += 2.0 * np.pi * np.rint((r[..., 0] - p[..., 0]) / (2.0 * np.pi))
    else:
        p[..., :3], _ = so3.log_near(R, r[..., :3], check=False)
    return p, n


def psi_so_near(A: ArrayLike, reference: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the parameters under `phi_so` whose rotation is the nearest to that of other parameters.

    Kaji-Ochiai: (3), Algorithm 1, by `so3.log_near`

    Parameters
    ----------
    A : (..., 4, 4), Aff+
        Or (..., 3, 3), of the plane.
    reference : (..., 12)
        Or (..., 6); its rotation vector alone is looked at, of any length.
    check : bool, False to trust the values

    Returns
    -------
    params : (..., 12)

    Raises
    ------
    ValueError
        If A is not affine, its determinant is not positive, or the reference is not finite.
    """
    return _near("affine.psi_so_near", A, reference, check)[0]


def psi_se_near(A: ArrayLike, reference: ArrayLike, *, check: bool = True) -> NDArray[np.float64]:
    """Return the parameters under `phi_se` whose rotation is the nearest to that of other parameters.

    As the rotation nears whole turns, the translation part grows without bound
    unless the translation is along the axis: (7.8) has a pole there.

    Book: (7.2), (7.8)
    Kaji-Ochiai: Algorithm 1, by `so3.log_near`

    Parameters
    ----------
    A : (..., 4, 4), Aff+
        Or (..., 3, 3), of the plane.
    reference : (..., 12)
        Or (..., 6); its rotation vector alone is looked at, of any length.
    check : bool, False to trust the values

    Returns
    -------
    params : (..., 12)

    Raises
    ------
    ValueError
        If A is not affine, its determinant is not positive, or the reference is
        not finite; or if the nearest rotation is a whole number of turns and
        the translation not along its axis: no screw motion does both.
    """
    p, n = _near("affine.psi_se_near", A, reference, check)
    x, d = (p[..., :3], p[..., 3:6]) if n == 3 else (p[..., 0], p[..., 1:3])
    theta = np.linalg.norm(x, axis=-1) if n == 3 else x
    whole = series.at_pole(theta)
    if check and np.any(whole):
        unit = x / np.where(whole, theta, 1.0)[..., None] if n == 3 else np.zeros_like(d)
        across = np.linalg.norm(d - np.sum(unit * d, axis=-1, keepdims=True) * unit, axis=-1)
        impossible = whole & (across > checks.TOLERANCE**2 * np.linalg.norm(d, axis=-1))
        if np.any(impossible):
            index = checks.first(impossible)
            must, got = "one that leads to no whole turn", f"an angle of {theta[index]:.17g}"
            remedy = "No screw motion turns so and moves off its axis; take another reference, or phi_so."
            checks.fail("affine.psi_se_near", "reference", must, got, index, remedy)
    # After whole turns a screw motion has gone along its axis only, by l itself.
    if n == 3:
        back = so3.act(so3.left_jacobian_inverse(np.where(whole[..., None], 0.0, x), check=False), d)
    else:
        back = np.stack(affine_kernels.back_plane(np.where(whole, 0.0, x), d[..., 0], d[..., 1]), axis=-1)
    d[...] = back
    return p


def classify(A: ArrayLike, *, check: bool = True) -> NDArray[np.str_]:
    """Return the name of the smallest of the nine classes that contains an affine transformation.

    Parts of its parameters below 1e-9 count as 0: radians, lengths, logarithms
    of stretch.  The identity is in all; it counts as a dilation.

    Kaji-Ochiai: Figure 1, (V)

    Parameters
    ----------
    A : (..., 4, 4), Aff+
        Or (..., 3, 3), of the plane.
    check : bool, False to trust the values

    Returns
    -------
    name : (...), name

    Raises
    ------
    ValueError
        If A is not affine or its determinant is not positive.
    """
    where = "affine.classify"
    p = _psi(where, affine_kernels.psi_so, affine_kernels.psi_so_plane, A, check)
    names = np.full(p.shape[:-1], "", dtype=f"<U{max(map(len, CLASSES))}")
    for name in CLASSES:
        inside = np.all(np.abs(p - project(p, name, check=False)) <= _NOTHING, axis=-1)
        names[inside & (names == "")] = name
    return names
