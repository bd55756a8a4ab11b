"""One triangle: the map that carries it to another, and the ways from the identity to that map (chapter 5).

A homotopy A(t) of a map A joins A(0) = I to A(1) = A.  All four are functions
of a matrix, a time and an angle of rotation, so that one is as good an argument as
another:

    linear      A^L(t) = (1-t) I + t A                   may collapse on the way
    arap        A^P(t) = R(t theta) ((1-t) I + t S)       regular for 0 <= t <= 1
    logexp      A^E(t) = R(t theta) exp(t log S)          regular for every t
    matrix_log  exp(t log A)                              only where a real log A exists

A real matrix acts on the plane of complex numbers as z -> a z + b conj(z).
With A = R(theta) S, S symmetric, that is a = e^(i theta) tr(S)/2, so that the
polar decomposition is that of one complex number, and every power of A is a closed formula.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
    p = checks.array("triangle.frame", "triangle", triangle, (3, 2))
    A = np.zeros((*p.shape[:-2], 3, 3))
    A[..., :2, :2] = np.swapaxes(p[..., :2, :] - p[..., 2:, :], -1, -2)
    A[..., :2, 2] = p[..., 2, :]
    A[..., 2, 2] = 1.0
    return A


def affine_map(source: ArrayLike, target: ArrayLike) -> Array:
    """Return the affine map that carries a triangle to another, corner by corner.

    Book: (5.2)

    Parameters
    ----------
    source, target : (..., 3, 2)
        Their corners.

    Returns
    -------
    A : (..., 3, 3)

    Raises
    ------
    ValueError
        If one has another shape or is not finite, or the corners of the source lie on a line.
    """
    P, Q = frame(source), frame(target)
    checks_degenerate("triangle.affine_map", "source", P[..., :2, :2])
    A = np.broadcast_to(np.eye(3), np.broadcast_shapes(P.shape, Q.shape)).copy()
    A[..., :2, :2] = Q[..., :2, :2] @ _inverse(P[..., :2, :2])
    # From corner to corner, not from the inverse of the whole: far from the origin that would lose digits.
    A[..., :2, 2] = Q[..., :2, 2] - np.einsum("...ij,...j->...i", A[..., :2, :2], P[..., :2, 2])
    return A


def checks_degenerate(where: str, name: str, E: Array) -> None:
    """Refuse triangles, given by two of their sides as columns (..., 2, 2), whose corners lie on a line."""
    det = _det(E)
    flat = np.abs(det) <= 1e-14 * np.sum(E**2, axis=(-2, -1))
    if np.any(flat):
        index = checks.first(flat)
        checks.fail(where, name, "a triangle with area", f"area {0.5 * float(det[index]):.3g}", index)


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
    a, b = coordinates(A)
    angle = _angle("triangle.arap", a, theta)
    t = _time("triangle.arap", t, A.ndim)[..., 0, 0]
    turn, back = np.exp(1j * t * angle), np.exp(-1j * angle)
    return matrix(turn * (1.0 - t + t * np.abs(a)), turn * t * (b * back))


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
    a, b = coordinates(A)
    angle = _angle("triangle.logexp", a, theta)
    t = _time("triangle.logexp", t, A.ndim)[..., 0, 0]
    # The eigenvalues of S are |a| + |b| and |a| - |b|; the second would cancel, det does not.
    log_det = np.log(_det(A))
    half_spread = np.log(np.abs(a) + np.abs(b)) - 0.5 * log_det
    turn = np.exp(1j * t * angle + 0.5 * t * log_det)
    along = _unit(b * np.exp(-1j * angle))
    return matrix(turn * np.cosh(t * half_spread), turn * np.sinh(t * half_spread) * along)


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
    a, b = coordinates(A)
    t = _time("triangle.matrix_log", t, A.ndim)[..., 0, 0]
    # A = m I + Z, and Z Z = spread I.
    mean, size = a.real, 0.5 * np.log(_det(A))
    spread = np.abs(b) ** 2 - a.imag**2
    root = np.sqrt(np.abs(spread))
    turning = spread < 0.0
    phi = np.arctan2(root, mean)
    with np.errstate(invalid="ignore", divide="ignore"):
        eta = np.where(turning, 0.0, np.arctanh(np.where(turning, 0.0, root / mean)))
    even = np.where(turning, np.cos(t * phi), np.cosh(t * eta))
    odd = np.where(turning, np.sin(t * phi), np.sinh(t * eta))
    # Where both eigenvalues are equal, sinh(t eta)/root tends to t / mean.
    with np.errstate(divide="ignore", invalid="ignore"):
        odd = np.where(root > 1e-8 * np.abs(mean), odd / root, t / mean)
    # A half turn with a dilation has logarithms, of which this takes the turn to the left.
    half = np.broadcast_to((mean < 0.0) & (root <= 1e-8 * np.abs(mean)), odd.shape)
    grow = np.exp(t * size)
    even = np.where(half, np.cos(np.pi * t), even)
    here = np.where(half, 1j * np.sin(np.pi * t), 1j * odd * a.imag)
    return matrix(grow * even + grow * here, grow * np.where(half, 0.0, odd) * b)


def has_real_log(A: ArrayLike) -> NDArray[np.bool_]:
    """Tell which matrices are exponentials of real matrices.

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
    return (_det(A) > 0.0) & ((spread < 0.0) | (a.real > 0.0) | half_turn)


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


def coordinates(A: Array) -> tuple[Complex, Complex]:
    """Return the complex numbers (a, b) by which a matrix acts as z -> a z + b conj(z).

    Book: A.3
    """
    p, q, r, s = A[..., 0, 0], A[..., 0, 1], A[..., 1, 0], A[..., 1, 1]
    return 0.5 * (p + s + 1j * (r - q)), 0.5 * (p - s + 1j * (r + q))


def matrix(a: Complex | Array, b: Complex | Array) -> Array:
    """Return the matrices (..., 2, 2) that act as z -> a z + b conj(z)."""
    a, b = np.broadcast_arrays(a, b)
    rows = [a.real + b.real, b.imag - a.imag, a.imag + b.imag, a.real - b.real]
    return np.stack(rows, axis=-1).reshape(*a.shape, 2, 2)


def _unit(z: Complex) -> Complex:
    size = np.abs(z)
    return np.where(size > 0.0, z / np.where(size > 0.0, size, 1.0), 1.0)


def _time(where: str, t: ArrayLike, ndim: int) -> Array:
    """Return t as (*t, 1, ..., 1), with as many axes after it as a batch of matrices has."""
    t = checks.array(where, "t", t, ())
    return t.reshape(*t.shape, *(1,) * ndim)


def _angle(where: str, a: Complex, theta: ArrayLike | None) -> Array:
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
    det = _det(A)
    if not np.all(det > 0.0):
        index = checks.first(~(det > 0.0))
        remedy = "A reflection cannot be reached from the identity; reverse one of the shapes."
        checks.fail(where, "A", "a map with det A > 0", f"det {float(det[index]):.4g}", index, remedy)
    return A


def _det(A: Array) -> Array:
    return A[..., 0, 0] * A[..., 1, 1] - A[..., 0, 1] * A[..., 1, 0]


def _inverse(A: Array) -> Array:
    p, q, r, s = A[..., 0, 0], A[..., 0, 1], A[..., 1, 0], A[..., 1, 1]
    adjugate = np.stack([s, -q, -r, p], axis=-1).reshape(A.shape)
    return adjugate / _det(A)[..., None, None]
