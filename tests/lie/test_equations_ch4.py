"""Chapter 4 of the book, equation by equation: laws of public functions, on random input."""

from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from lietool.lie import dual_quaternion, generic, polar, quaternion, se2, se3, so2, so3, sym

PI = np.pi
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-13)


@pytest.fixture
def rng():
    return np.random.default_rng(4)


def series(A: np.ndarray, terms: int = 60) -> np.ndarray:
    """The partial sum of the exponential series."""
    power = total = np.broadcast_to(np.eye(A.shape[-1]), A.shape)
    for k in range(1, terms):
        power = power @ A / k
        total = total + power
    return total


def block(A: np.ndarray, d: np.ndarray, corner: float) -> np.ndarray:
    """The matrix [[A, d], [0, corner]] of a batch."""
    H = np.zeros((len(A), A.shape[-1] + 1, A.shape[-1] + 1))
    H[:, :-1, :-1], H[:, :-1, -1], H[:, -1, -1] = A, d, corner
    return H


def rotations(rng: np.random.Generator, count: int) -> np.ndarray:
    Q, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    Q[..., 0] *= np.sign(np.linalg.det(Q))[:, None]
    return Q


def vectors(rng: np.random.Generator, count: int, low: float, high: float) -> np.ndarray:
    """Vectors of every direction, with lengths between two bounds."""
    x = rng.normal(size=(count, 3))
    return rng.uniform(low, high, (count, 1)) * x / np.linalg.norm(x, axis=-1, keepdims=True)


def apart(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    return np.max(np.abs(A - B), axis=(-1, -2))


# ---- the exponential of a matrix


@pytest.mark.equation("B 4.1", "K 10")
@pytest.mark.parametrize("n", [1, 2, 3, 4, 6])
def test_the_series_of_a_matrix(rng, n):
    A = rng.normal(size=(10, n, n))
    close(generic.exp(A), series(A), atol=1e-11)


@pytest.mark.equation("B 4.2")
def test_the_series_of_a_number():
    for x in (Fraction(1), Fraction(-7, 3), Fraction(5, 2), Fraction(1, 1000)):
        term = total = Fraction(1)
        for k in range(1, 60):
            term = term * x / k
            total += term
        np.testing.assert_allclose(generic.exp([[float(x)]]), [[float(total)]], rtol=1e-15)
        np.testing.assert_allclose(
            sym.exp(np.diag([float(x)] * 3)), float(total) * np.eye(3), rtol=2e-15, atol=0
        )


@pytest.mark.equation("B 4.3")
def test_a_diagonal_matrix_entry_by_entry(rng):
    d = rng.normal(size=(20, 3)) * 2
    D = d[:, :, None] * np.eye(3)
    wanted = np.exp(d)[:, :, None] * np.eye(3)
    np.testing.assert_allclose(generic.exp(D), wanted, rtol=1e-13)
    np.testing.assert_allclose(sym.exp(D), wanted, rtol=1e-13, atol=1e-13)


@pytest.mark.equation("B 4.4")
def test_a_skew_matrix_of_the_plane(rng):
    theta = rng.uniform(-6, 6, 20)
    X = np.zeros((20, 2, 2))
    X[:, 0, 1], X[:, 1, 0] = -theta, theta
    close(so2.hat(theta), X)
    close(so2.exp(theta), series(X), atol=1e-12)
    close(generic.exp(X), so2.exp(theta))


@pytest.mark.equation("B 4.5")
def test_a_velocity_alone_is_a_translation(rng):
    d = rng.normal(size=(20, 3))
    close(
        generic.exp(block(np.zeros((20, 3, 3)), d, 0.0)),
        block(np.broadcast_to(np.eye(3), (20, 3, 3)), d, 1.0),
    )
    close(se3.exp(np.concatenate([0 * d, d], axis=-1)), block(np.broadcast_to(np.eye(3), (20, 3, 3)), d, 1.0))
    flat = np.concatenate([np.zeros((20, 1)), d[:, :2]], axis=-1)
    close(se2.exp(flat), block(np.broadcast_to(np.eye(2), (20, 2, 2)), d[:, :2], 1.0))


@pytest.mark.equation("B 4.6")
@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_the_series_of_a_triangular_matrix_ends(rng, n):
    A = np.triu(rng.normal(size=(10, n, n)), 1)
    close(np.linalg.matrix_power(A, n), 0.0)
    close(generic.exp(A), series(A, n))
    assert np.all(apart(series(A, n - 1), generic.exp(A)) > 1e-6)


@pytest.mark.equation("B 4.7")
def test_a_skew_matrix_of_space(rng):
    u = vectors(rng, 20, 0.1, 6.0)
    A = so3.hat(u)
    size = np.linalg.norm(u, axis=-1)
    np.testing.assert_allclose(-np.trace(A @ A, axis1=1, axis2=2) / 2, size**2)
    s, c = np.sin(size)[:, None, None], np.cos(size)[:, None, None]
    n = size[:, None, None]
    close(so3.exp(u), np.eye(3) + s / n * A + (1 - c) / n**2 * (A @ A))
    close(so3.exp(u), series(A), atol=1e-12)
    close(so3.exp(2 * PI * u / size[:, None]), np.broadcast_to(np.eye(3), A.shape))


@pytest.mark.equation("B 4.8")
def test_exponents_along_one_direction_add(rng):
    A, (s, t) = rng.normal(size=(20, 3, 3)), rng.uniform(-1, 1, (2, 20, 1, 1))
    close(generic.exp((s + t) * A), generic.exp(s * A) @ generic.exp(t * A), atol=1e-12)
    x = vectors(rng, 20, 0.0, 6.0)
    close(so3.exp((s + t)[..., 0] * x), so3.exp(s[..., 0] * x) @ so3.exp(t[..., 0] * x))
    z = np.concatenate([x, rng.normal(size=(20, 3))], axis=-1)
    close(se3.exp((s + t)[..., 0] * z), se3.exp(s[..., 0] * z) @ se3.exp(t[..., 0] * z))
    Y = A + np.swapaxes(A, -1, -2)
    close(sym.exp((s + t) * Y), sym.exp(s * Y) @ sym.exp(t * Y), atol=1e-10)


@pytest.mark.equation("B 4.9")
def test_exponents_of_two_matrices_do_not_add():
    A, B = np.array([[0.0, 0], [1, 0]]), np.array([[0.0, -1], [0, 0]])
    close(generic.exp(A) @ generic.exp(B), [[1, -1], [1, 0]])
    close(generic.exp(B) @ generic.exp(A), [[0, -1], [1, 1]])
    close(generic.exp(A + B), so2.exp(1.0))


@pytest.mark.equation("B 4.10")
def test_exponents_of_commuting_matrices_add(rng):
    A = rng.normal(size=(20, 3, 3)) / 2
    B = 0.3 * np.eye(3) - 0.4 * A + 0.2 * A @ A
    close(A @ B, B @ A)
    close(generic.exp(A + B), generic.exp(A) @ generic.exp(B), atol=1e-11)


@pytest.mark.equation("B 4.11")
def test_the_exponential_goes_along_with_a_change_of_basis(rng):
    A, P = rng.normal(size=(20, 3, 3)), rng.normal(size=(20, 3, 3)) + 4 * np.eye(3)
    inverse = np.linalg.inv(P)
    np.testing.assert_allclose(
        generic.exp(inverse @ A @ P), inverse @ generic.exp(A) @ P, rtol=1e-9, atol=1e-11
    )
    x, R = vectors(rng, 20, 0.0, 6.0), rotations(rng, 20)
    turned = np.einsum("...ij,...j->...i", so3.adjoint(R), x)
    close(so3.exp(turned), R @ so3.exp(x) @ so3.inverse(R))
    close(so3.hat(turned), R @ so3.hat(x) @ so3.inverse(R))


@pytest.mark.equation("B 4.12")
def test_the_exponential_of_numbers_is_onto_the_positive_ones(rng):
    y = np.exp(rng.uniform(-20, 20, 30))
    x = sym.log(y[:, None, None] * np.eye(2))[:, 0, 0]
    np.testing.assert_allclose(x, np.log(y), rtol=1e-15, atol=1e-15)
    np.testing.assert_allclose(sym.exp(x[:, None, None] * np.eye(2))[:, 0, 0], y, rtol=1e-14)
    with pytest.raises(ValueError, match=r"sym\.log: S must be"):
        sym.log(-np.eye(2))


@pytest.mark.equation("B 4.13")
def test_eulers_formula(rng):
    theta = rng.uniform(-9, 9, 30)
    turned = so2.act(so2.exp(theta), np.array([1.0, 0.0]))
    close(turned[:, 0] + 1j * turned[:, 1], np.exp(1j * theta))
    close(so2.exp(theta + 2 * PI), so2.exp(theta))


# ---- the Lie algebra


@pytest.mark.equation("B 4.14")
def test_velocities_at_the_identity(rng):
    a, b, h = rng.normal(size=(20, 6)), rng.normal(size=(20, 6)), 1e-5

    def curve(t: float) -> np.ndarray:
        return se3.exp(t * a) @ se3.exp(np.sin(t) * b)

    velocity = (curve(h) - curve(-h)) / (2 * h)
    close(velocity, se3.hat(a + b), atol=1e-8)
    close(velocity[:, 3], 0.0)
    close(velocity[:, :3, :3] + np.swapaxes(velocity[:, :3, :3], -1, -2), 0.0, atol=1e-8)


@pytest.mark.equation("B 4.15")
def test_invertible_dual_quaternions_are_a_group(rng):
    q, p, r = rng.normal(size=(3, 20, 8))
    one = np.eye(8)[0]
    close(dual_quaternion.multiply(q, dual_quaternion.inverse(q)), np.broadcast_to(one, q.shape), atol=1e-12)
    close(dual_quaternion.multiply(dual_quaternion.inverse(q), q), np.broadcast_to(one, q.shape), atol=1e-12)
    left = dual_quaternion.multiply(dual_quaternion.multiply(q, p), r)
    close(left, dual_quaternion.multiply(q, dual_quaternion.multiply(p, r)), atol=1e-12)
    with pytest.raises(ValueError, match=r"dual_quaternion\.inverse"):
        dual_quaternion.inverse(np.eye(8)[5])


@pytest.mark.equation("B 4.16")
def test_unit_dual_quaternions_are_a_group(rng):
    q, p = dual_quaternion.exp(rng.normal(size=(2, 20, 6)))
    for unit in (q, dual_quaternion.multiply(q, p), dual_quaternion.inverse(q)):
        close(np.linalg.norm(unit[:, :4], axis=-1), 1.0)
        close(np.sum(unit[:, :4] * unit[:, 4:], axis=-1), 0.0)


@pytest.mark.equation("B 4.17")
def test_the_exponential_leads_into_the_group_and_is_one_to_one_near_0(rng):
    x, h = rng.normal(size=(20, 6)), 1e-6
    close((se3.exp(h * x) - se3.exp(-h * x)) / (2 * h), se3.hat(x), atol=1e-9)
    z = np.concatenate([vectors(rng, 20, 0.0, 3.1), rng.normal(size=(20, 3))], axis=-1)
    T = se3.exp(z)
    close(T[:, :3, :3] @ np.swapaxes(T[:, :3, :3], -1, -2), np.broadcast_to(np.eye(3), (20, 3, 3)))
    close(np.linalg.det(T), 1.0)
    close(T[:, 3], np.broadcast_to([0.0, 0, 0, 1], (20, 4)))
    close(se3.log(T), z, atol=1e-12)
    close(so3.log(so3.exp(z[:, :3])), z[:, :3])


@pytest.mark.equation("B 4.18")
def test_diagonal_matrices_go_to_positive_ones(rng):
    d = rng.normal(size=(20, 3)) * 3
    D = d[:, :, None] * np.eye(3)
    E = sym.exp(D)
    assert np.all(np.diagonal(E, axis1=1, axis2=2) > 0)
    close(E * (1 - np.eye(3)), 0.0)
    close(sym.log(E), D, atol=1e-11)


@pytest.mark.equation("B 4.19")
@pytest.mark.parametrize("n", [2, 3])
def test_symmetric_matrices_go_to_positive_definite_ones(rng, n):
    Y = rng.normal(size=(20, n, n))
    Y = Y + np.swapaxes(Y, -1, -2)
    S = sym.exp(Y)
    close(S, np.swapaxes(S, -1, -2))
    assert np.all(np.linalg.eigvalsh(S) > 0)
    close(sym.log(S), Y, atol=1e-11)
    B = rng.normal(size=(20, n, n))
    P = B @ np.swapaxes(B, -1, -2) + 0.1 * np.eye(n)
    np.testing.assert_allclose(sym.exp(sym.log(P)), P, rtol=1e-12, atol=1e-12)
    R = so2.exp(1.0) if n == 2 else so3.exp([0.3, -0.8, 0.4])
    close(sym.exp(R @ Y @ R.T), R @ S @ R.T, atol=1e-10)


@pytest.mark.equation("B 4.20", "B 4.24")
def test_the_ball_of_radius_pi_is_enough(rng):
    R = np.concatenate([rotations(rng, 40), so3.rotation("y", PI)[None], np.eye(3)[None]])
    x = so3.log(R)
    assert np.all(np.linalg.norm(x, axis=-1) <= PI * (1 + 1e-15))
    close(so3.exp(x), R)
    X = so3.hat(x)
    close(X, -np.swapaxes(X, -1, -2))
    close(generic.exp(X), R, atol=1e-12)


# ---- decompositions


@pytest.mark.equation("B 4.21")
def test_a_matrix_is_skew_plus_symmetric_as_it_is_a_rotation_times_a_stretch(rng):
    A, h = rng.normal(size=(20, 3, 3)), 1e-5
    skew, symmetric = (A - np.swapaxes(A, -1, -2)) / 2, (A + np.swapaxes(A, -1, -2)) / 2
    close(so3.hat(so3.vee(A)), skew)
    close(so3.vee(symmetric), 0.0)
    (R, S), (R_back, S_back) = polar.decompose(np.eye(3) + h * A), polar.decompose(np.eye(3) - h * A)
    close((R - R_back) / (2 * h), skew, atol=1e-8)
    close((S - S_back) / (2 * h), symmetric, atol=1e-8)


@pytest.mark.equation("B 4.22")
def test_a_twist_is_a_rotation_and_a_translation(rng):
    w, d = rng.normal(size=(2, 20, 3))
    close(se3.hat(np.concatenate([w, d], axis=-1)), block(so3.hat(w), d, 0.0))
    close(se3.vee(block(so3.hat(w), d, 0.0)), np.concatenate([w, d], axis=-1))
    close(se2.hat(np.concatenate([w[:, :1], d[:, :2]], axis=-1)), block(so2.hat(w[:, 0]), d[:, :2], 0.0))


@pytest.mark.equation("B 4.23")
def test_an_affine_velocity_is_a_linear_one_and_a_translation(rng):
    A, d = rng.normal(size=(20, 3, 3)) / 2, rng.normal(size=(20, 3))
    T = generic.exp(block(A, d, 0.0))
    close(T[:, 3], np.broadcast_to([0.0, 0, 0, 1], (20, 4)))
    close(T[:, :3, :3], generic.exp(A), atol=1e-12)
    assert np.all(np.linalg.det(T[:, :3, :3]) > 0)
    close(
        T[:, :3, 3], np.einsum("...ij,...j->...i", (series(A) - np.eye(3)) @ np.linalg.inv(A), d), atol=1e-9
    )


# ---- where the exponential of SO(3) is one-to-one


@pytest.mark.equation("B 4.25")
def test_inside_the_ball_it_is_one_to_one(rng):
    x = vectors(rng, 40, 0.0, PI - 1e-3)
    R = so3.exp(x)
    close(so3.log(R), x)
    np.testing.assert_allclose(
        np.linalg.det(R + np.eye(3)), 4 * (1 + np.cos(np.linalg.norm(x, axis=-1))), atol=1e-13
    )
    assert np.all(np.linalg.det(R + np.eye(3)) > 1e-7)


@pytest.mark.equation("B 4.26")
def test_on_its_sphere_it_is_two_to_one(rng):
    x = vectors(rng, 40, PI, PI)
    R = so3.exp(x)
    close(so3.exp(-x), R)
    close(np.linalg.det(R + np.eye(3)), 0.0)
    principal = so3.log(R)
    close(np.minimum(np.abs(principal - x).max(-1), np.abs(principal + x).max(-1)), 0.0)
    assert np.all(apart(so3.exp(x[1:]), so3.exp(x[:-1])) > 1e-3)


def partner(x: np.ndarray, n: int) -> np.ndarray:
    """The other vector of shell n with the same rotation."""
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    return x - 2 * PI * (2 * n - 1) * x / length


@pytest.mark.equation("B 4.27", "B 4.28")
@pytest.mark.parametrize("n", [1, 2, 5])
def test_in_every_shell_each_rotation_is_met_twice(rng, n):
    low, high = 2 * (n - 1) * PI, 2 * n * PI
    x = vectors(rng, 40, low + 0.1, high - 0.1)
    R = so3.exp(x)
    assert np.all(apart(R, np.eye(3)) > 1e-3)
    other = partner(x, n)
    length = np.linalg.norm(other, axis=-1)
    assert np.all((low < length) & (length < high))
    close(so3.exp(other), R)
    # The logarithms lie on the axis 2 pi apart; the nearest to the middles of the shell there are these two.
    middle = (low + PI) * x / np.linalg.norm(x, axis=-1, keepdims=True)
    close(so3.log_near(R, middle)[0], x, atol=1e-12)
    close(so3.log_near(R, -middle)[0], other, atol=1e-12)
    J = so3.left_jacobian(x)
    assert np.all(np.linalg.det(J) > 1e-5)


@pytest.mark.equation("B 4.29")
@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_a_shell_is_the_sphere_of_quaternions(rng, n):
    x = vectors(rng, 40, 2 * (n - 1) * PI + 0.1, 2 * n * PI - 0.1)
    q = quaternion.exp(x / 2)
    assert np.all(np.abs(q[:, 0]) < 1 - 1e-5)
    close(quaternion.to_matrix(q), so3.exp(x))
    close(quaternion.exp(partner(x, n) / 2), -q)
    half = quaternion.log(q)
    size = np.linalg.norm(half, axis=-1, keepdims=True)
    around = 2 * (n - 1) * PI + 2 * size if n % 2 else 2 * size - 2 * n * PI
    close(around * half / size, x, atol=1e-12)


@pytest.mark.equation("B 4.30")
@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_the_sphere_between_two_shells_is_one_point(rng, n):
    x = vectors(rng, 40, 2 * n * PI, 2 * n * PI)
    close(quaternion.exp(x / 2), np.broadcast_to([(-1.0) ** n, 0, 0, 0], (40, 4)))
    close(so3.exp(x), np.broadcast_to(np.eye(3), (40, 3, 3)))
    close(np.linalg.det(so3.left_jacobian(x)), 0.0)
