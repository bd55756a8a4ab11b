"""One triangle: the map that carries it to another, and the ways from the identity to that map (chapter 5).

A homotopy A(t) of a map A joins A(0) = I to A(1) = A.  All four are functions
of a matrix, a time and an angle of rotation, so that one is as good an argument as
another:

    linear      A^L(t) = (1-t) I + t A                   may collapse on the way
    arap        A^P(t) = R(t theta) ((1-t) I + t S)       regular for 0 <= t <= 1
    logexp      A^E(t) = R(t theta) exp(t log S)          regular for every t
    matrix_log  exp(t log A)                              only where a real log A exists
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import triangle_kernels
from lietool.interp.triangle_kernels import coordinates as coordinates
from lietool.interp.triangle_kernels import det as det
from lietool.interp.triangle_kernels import inverse as inverse
from lietool.interp.triangle_kernels import matrix as matrix
from lietool.lie import checks

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

Homotopy = Callable[..., Array]
"""(A (..., 2, 2), t (...), theta) -> A(t), shape (*t.shape, *A.shape)."""


def frame(triangle: ArrayLike) -> Array:
    """Return the affine map that carries (1, 0), (0, 1), (0, 0) to the corners of a triangle.

    Book: (5.1)

    Parameters
    ----------
    triangle : (..., 3, 2)
        Its corners in this order.

    Returns
    -------
    A : (..., 3, 3)

    Raises
    ------
    ValueError
        If it has another shape or is not finite.
    """
    return _frame(checks.array("triangle.frame", "triangle", triangle, (3, 2)))


def _frame(p: Array) -> Array:
    A = np.zeros((*p.shape[:-2], 3, 3))
    A[..., :2, :2] = sides(p)
    A[..., :2, 2] = p[..., 2, :]
    A[..., 2, 2] = 1.0
    return A


def affine_map(source: ArrayLike, target: ArrayLike) -> Array:
    """Return the affine map that carries a triangle to another, corner by corner.

    Book: (5.2)

    Parameters
    ----------
    source : (..., 3, 2)
        The corners of the one.
    target : (..., 3, 2)
        The corners of the other.

    Returns
    -------
    A : (..., 3, 3)

    Raises
    ------
    ValueError
        If one has another shape or is not finite, or the corners of the source lie on a line.
    """
    where = "triangle.affine_map"
    P = _frame(checks.array(where, "source", source, (3, 2)))
    Q = _frame(checks.array(where, "target", target, (3, 2)))
    checks_degenerate(where, "source", P[..., :2, :2])
    A = np.broadcast_to(np.eye(3), np.broadcast_shapes(P.shape, Q.shape)).copy()
    A[..., :2, :2] = Q[..., :2, :2] @ inverse(P[..., :2, :2])
    # From corner to corner, not from the inverse of the whole: far from the origin that would lose digits.
    A[..., :2, 2] = Q[..., :2, 2] - np.einsum("...ij,...j->...i", A[..., :2, :2], P[..., :2, 2])
    return A


def sides(p: Array) -> Array:
    """Return two sides of triangles (..., 3, 2), p_1 - p_3 and p_2 - p_3, as columns (..., 2, 2)."""
    return np.swapaxes(p[..., :2, :] - p[..., 2:, :], -1, -2)


def checks_degenerate(where: str, name: str, E: Array) -> None:
    """Refuse triangles, given by two of their sides as columns (..., 2, 2), whose corners lie on a line."""
    twice = det(E)
    flat = np.abs(twice) <= 1e-14 * np.sum(E**2, axis=(-2, -1))
    if np.any(flat):
        index = checks.first(flat)
        checks.fail(where, name, "a triangle with area", f"area {0.5 * float(twice[index]):.3g}", index)


def linear(A: ArrayLike, t: ArrayLike, theta: ArrayLike | None = None) -> Array:
    """Return A^L(t), the straight line between I and A in the space of matrices.

    Book: 5.2

    Parameters
    ----------
    A : (..., 2, 2)
    t : (...)
        Any real number.
    theta : (...)
        Of no account: a straight line does not turn.

    Returns
    -------
    At : (*t, ..., 2, 2)
    """
    A = checks.array("triangle.linear", "A", A, (2, 2))
    t = _time("triangle.linear", t, A.ndim)
    return (1.0 - t) * np.eye(2) + t * A


def arap(A: ArrayLike, t: ArrayLike, theta: ArrayLike | None = None) -> Array:
    """Return A^P(t) = R(t theta) ((1-t) I + t S): rotation and stretch apart, the stretch on a straight line.

    For 0 <= t <= 1 it is regular; outside, (1-t) I + t S may collapse.

    Book: 5.2

    Parameters
    ----------
    A : (..., 2, 2), GL+
    t : (...)
        Any real number.
    theta : (...), rad
        The angle of rotation of A, with any number of full turns; that in (-pi, pi] unless given.

    Returns
    -------
    At : (*t, ..., 2, 2)

    Raises
    ------
    ValueError
        If det A <= 0, or theta is no angle of A.
    """
    A = _positive("triangle.arap", A)
    angle = _angle("triangle.arap", A, theta)
    t = _time("triangle.arap", t, A.ndim)[..., 0, 0]
    return matrix(*triangle_kernels.arap(A, angle)(t))


def logexp(A: ArrayLike, t: ArrayLike, theta: ArrayLike | None = None) -> Array:
    """Return A^E(t) = R(t theta) exp(t log S): rotation and stretch apart, the stretch by its logarithm.

    It is regular for every t.

    Book: 5.2

    Parameters
    ----------
    A : (..., 2, 2), GL+
    t : (...)
        Any real number.
    theta : (...), rad
        The angle of rotation of A, with any number of full turns; that in (-pi, pi] unless given.

    Returns
    -------
    At : (*t, ..., 2, 2)

    Raises
    ------
    ValueError
        If det A <= 0, or theta is no angle of A.
    """
    A = _positive("triangle.logexp", A)
    angle = _angle("triangle.logexp", A, theta)
    t = _time("triangle.logexp", t, A.ndim)[..., 0, 0]
    return matrix(*triangle_kernels.logexp(A, angle)(t))


def matrix_log(A: ArrayLike, t: ArrayLike, theta: ArrayLike | None = None) -> Array:
    """Return exp(t log A), the one-parameter subgroup through A (Alexa 2002).

    Parameters
    ----------
    A : (..., 2, 2), GL+
        With a real logarithm: see `has_real_log`.
    t : (...)
        Any real number.
    theta : (...)
        Of no account: the logarithm is the principal one.

    Returns
    -------
    At : (*t, ..., 2, 2)

    Raises
    ------
    ValueError
        If a matrix has no real logarithm; the message gives its index and eigenvalues.
    """
    A = checks.array("triangle.matrix_log", "A", A, (2, 2))
    without = ~has_real_log(A)
    if np.any(without):
        index = checks.first(without)
        values = ", ".join(f"{x:.4g}" for x in np.linalg.eigvals(A[index]))
        remedy = "Use logexp, which reaches all of GL+(2)."
        got = f"eigenvalues {values} in matrix"
        checks.fail("triangle.matrix_log", "A", "a matrix with a real logarithm", got, index, remedy)
    t = _time("triangle.matrix_log", t, A.ndim)[..., 0, 0]
    return matrix(*triangle_kernels.matrix_log(A, None)(t))


def has_real_log(A: ArrayLike) -> NDArray[np.bool_]:
    """Tell which matrices are exponentials of real matrices.

    Book: 5.2

    Those without eigenvalues on the negative real line, and the half turns with a dilation, -c I.

    Parameters
    ----------
    A : (..., 2, 2)

    Returns
    -------
    has : (...), bool
    """
    A = checks.array("triangle.has_real_log", "A", A, (2, 2))
    a, b = coordinates(A)
    spread = np.abs(b) ** 2 - a.imag**2
    half_turn = (np.abs(a.imag) + np.abs(b)) <= 1e-12 * np.abs(a.real)
    return (det(A) > 0.0) & ((spread < 0.0) | (a.real > 0.0) | half_turn)


def principal_angle(A: ArrayLike) -> Array:
    """Return the angle in (-pi, pi] of the rotation R in A = R S.

    Book: (3.11)

    Parameters
    ----------
    A : (..., 2, 2), GL+

    Returns
    -------
    theta : (...), rad
    """
    return np.angle(coordinates(_positive("triangle.principal_angle", A))[0])


def path(homotopy: Homotopy, A: Array, theta: Array) -> Callable[[float], Complex]:
    """Return the way of many maps at once, one time after the other, as fast as it can be had.

    Book: 5.2

    Parameters
    ----------
    homotopy : callable
        One of this module; or another with the same arguments, which is then called for each time.
    A : (m, 2, 2), GL+
    theta : (m,), rad
        The angles of rotation of A, with any number of full turns.

    Returns
    -------
    path : callable
        From a time to the coordinates of the maps A(t), (2, m) complex numbers.
    """
    for known, kernel in _KERNELS:
        if homotopy is known:
            way = kernel(A, theta)
            return lambda t: np.stack(way(t))
    # What it refuses is refused here, and not in the middle of a film.
    homotopy(A, 0.0, theta)
    return lambda t: np.stack(coordinates(homotopy(A, t, theta)))


def _time(where: str, t: ArrayLike, ndim: int) -> Array:
    """Return t as (*t, 1, ..., 1), with as many axes after it as a batch of matrices has."""
    t = checks.array(where, "t", t, ())
    return t.reshape(*t.shape, *(1,) * ndim)


def _angle(where: str, A: Array, theta: ArrayLike | None) -> Array:
    a = coordinates(A)[0]
    if theta is None:
        return np.angle(a)
    theta = checks.array(where, "theta", theta, ())
    wrong = np.abs(np.exp(1j * theta) * np.abs(a) - a) > 1e-6 * np.abs(a)
    if np.any(wrong):
        index = checks.first(wrong)
        must = f"{float(np.broadcast_to(np.angle(a), wrong.shape)[index]):.6g} but for full turns"
        got = f"{float(np.broadcast_to(theta, wrong.shape)[index]):.6g}"
        checks.fail(where, "theta", must, got, index)
    return theta


def _positive(where: str, A: ArrayLike) -> Array:
    A = checks.array(where, "A", A, (2, 2))
    size = det(A)
    if not np.all(size > 0.0):
        index = checks.first(~(size > 0.0))
        remedy = "A reflection cannot be reached from the identity; reverse one of the shapes."
        checks.fail(where, "A", "a map with det A > 0", f"det {float(size[index]):.4g}", index, remedy)
    return A


_KERNELS = (
    (linear, triangle_kernels.linear),
    (arap, triangle_kernels.arap),
    (logexp, triangle_kernels.logexp),
)
