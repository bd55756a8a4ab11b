"""Appendix A of the book, equation by equation: laws of public functions, on random input."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import polar, so2, so3

PI = np.pi
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-14)


@pytest.fixture
def turns():
    """Unit vectors, angles, cosines and sines for vectors, points."""
    rng = np.random.default_rng(1)
    u = rng.normal(size=(30, 3))
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    theta = rng.uniform(-7, 7, 30)
    return u, theta, np.cos(theta)[:, None], np.sin(theta)[:, None], rng.normal(size=(30, 3))


def along(u: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.sum(u * x, axis=-1, keepdims=True) * u


@pytest.mark.equation("B A.1")
def test_what_lies_across_the_axis_turns(turns):
    u, theta, c, s, x = turns
    Rx = so3.act(so3.from_axis_angle(u, theta), x)
    close(Rx, along(u, x) + c * (x - along(u, x)) + s * np.cross(u, x))
    close(along(u, Rx), along(u, x))


@pytest.mark.erratum("B A.1")
def test_the_printed_number_is_no_vector(turns):
    u, theta, c, s, x = turns
    printed = np.sum(u * x, axis=-1, keepdims=True) + c * (x - along(u, x)) + s * np.cross(u, x)
    assert np.max(np.abs(printed - so3.act(so3.from_axis_angle(u, theta), x))) > 1


@pytest.mark.equation("B A.2")
def test_sorted_by_directions(turns):
    u, theta, c, s, x = turns
    close(so3.act(so3.from_axis_angle(u, theta), x), c * x + (1 - c) * along(u, x) + s * np.cross(u, x))


@pytest.mark.equation("B A.3")
def test_as_a_change(turns):
    u, theta, c, s, x = turns
    change = -(1 - c) * (x - along(u, x)) + s * np.cross(u, x)
    close(so3.act(so3.from_axis_angle(u, theta), x) - x, change)


@pytest.mark.equation("B A.4")
def test_the_nine_entries(turns):
    u, theta, *_ = turns
    for (u1, u2, u3), t in zip(u, theta, strict=True):
        c, s, v = np.cos(t), np.sin(t), 1 - np.cos(t)
        entries = [
            [c + v * u1 * u1, v * u1 * u2 - s * u3, v * u1 * u3 + s * u2],
            [v * u1 * u2 + s * u3, c + v * u2 * u2, v * u2 * u3 - s * u1],
            [v * u1 * u3 - s * u2, v * u2 * u3 + s * u1, c + v * u3 * u3],
        ]
        close(so3.from_axis_angle([u1, u2, u3], t), entries)


@pytest.mark.equation("B A.5", "B A.7")
def test_by_the_skew_matrix_of_a_unit_vector(turns):
    u, theta, c, s, _ = turns
    A = so3.hat(u)
    closed = np.eye(3) + s[..., None] * A + (1 - c)[..., None] * (A @ A)
    close(so3.from_axis_angle(u, theta), closed)
    power = series = np.broadcast_to(np.eye(3), A.shape)
    for k in range(1, 60):
        power = power @ (theta[:, None, None] * A) / k
        series = series + power
    close(so3.from_axis_angle(u, theta), series, atol=1e-12)
    close(so3.exp(theta[:, None] * u), series, atol=1e-12)


@pytest.mark.equation("B A.6")
def test_by_the_skew_matrix_of_axis_times_angle(turns):
    u, theta, c, s, _ = turns
    x, size = theta[:, None] * u, np.abs(theta)[:, None, None]
    A = so3.hat(x)
    s = np.abs(s) * np.sign(np.sin(np.abs(theta)))[:, None]
    close(so3.exp(x), np.eye(3) + s[..., None] / size * A + (1 - c)[..., None] / size**2 * (A @ A))


@pytest.mark.equation("B A.8")
def test_the_skew_matrix_is_the_cross_product(turns):
    u, _, _, _, x = turns
    A = so3.hat(x)
    close(np.einsum("...ij,...j->...i", A, u), np.cross(x, u))
    close(A[:, [2, 0, 1], [1, 2, 0]], x)
    close(so3.vee(A), x)
    close(np.sqrt(A[:, 0, 1] ** 2 + A[:, 0, 2] ** 2 + A[:, 1, 2] ** 2), np.linalg.norm(x, axis=-1))


@pytest.mark.equation("B A.9", "B A.10")
def test_the_matrix_of_the_translation(turns):
    u, theta, c, s, _ = turns
    X = so3.hat(theta[:, None] * u)
    power = series = np.broadcast_to(np.eye(3), X.shape)
    for k in range(2, 60):
        power = power @ X / k
        series = series + power
    Y = so3.left_jacobian(theta[:, None] * u)
    close(Y, series, atol=1e-12)
    t, c, s = theta[:, None, None], c[..., None], s[..., None]
    close(Y, np.eye(3) + (1 - c) / t**2 * X + (t - s) / t**3 * (X @ X), atol=1e-13)


@pytest.mark.equation("B A.11")
def test_its_inverse(turns):
    u, theta, c, s, _ = turns
    x = theta[:, None] * u
    X, t, c, s = so3.hat(x), theta[:, None, None], c[..., None], s[..., None]
    inverse = np.eye(3) - X / 2 + (2 * s - (1 + c) * t) / (2 * t**2 * s) * (X @ X)
    close(so3.left_jacobian_inverse(x), inverse, atol=1e-12)
    close(
        so3.left_jacobian_inverse(x) @ so3.left_jacobian(x), np.broadcast_to(np.eye(3), X.shape), atol=1e-12
    )


@pytest.mark.erratum("B A.11")
def test_its_coefficients_solve_the_equations_of_the_book():
    """b = (-a1, a1^2 - a2 (1 - a2 theta^2)) / (a1^2 theta^2 + (1 - a2 theta^2)^2)."""
    for theta in (0.4, 1.7, 3.0):
        a1, a2 = (1 - np.cos(theta)) / theta**2, (theta - np.sin(theta)) / theta**3
        b1, b2 = np.array([-a1, a1**2 - a2 * (1 - a2 * theta**2)]) / (
            a1**2 * theta**2 + (1 - a2 * theta**2) ** 2
        )
        X = so3.hat([0, 0, theta])
        close(np.eye(3) + b1 * X + b2 * X @ X, so3.left_jacobian_inverse([0, 0, theta]))


# ---- what the proof of (6.5) uses


@pytest.fixture
def matrices():
    rng = np.random.default_rng(3)
    A = rng.normal(size=(2, 30, 2, 2))
    A[..., 0] *= np.sign(np.linalg.det(A))[..., None]
    return A


@pytest.mark.equation("B A.12")
def test_a_times_its_transpose_is_symmetric(matrices):
    A = matrices[0]
    S, _ = polar.decompose_left(A)
    close(S @ S, A @ np.swapaxes(A, -1, -2), atol=1e-13)
    close(S, np.swapaxes(S, -1, -2))


@pytest.mark.equation("B A.13")
def test_symmetric_matrices_are_orthogonal_to_the_quarter_turn(matrices):
    S, J = polar.decompose(matrices[0])[1], so2.hat(1.0)
    close(J, so2.exp(PI / 2))
    close(np.trace(S @ J, axis1=-2, axis2=-1), 0.0)
    # And nothing else is: J measures what is skew.
    close(np.trace(matrices[0] @ J, axis1=-2, axis2=-1), -2 * so2.vee(matrices[0]))


@pytest.mark.equation("B A.14")
def test_the_inner_product_of_matrices_is_symmetric(matrices):
    P, Q = matrices
    PQ, QP = P @ np.swapaxes(Q, -1, -2), Q @ np.swapaxes(P, -1, -2)
    close(np.trace(PQ, axis1=-2, axis2=-1), np.trace(QP, axis1=-2, axis2=-1))
    rng = np.random.default_rng(5)
    x, y = rng.normal(size=(2, 30, 3))
    for a, b in ((x, y), (y, x)):
        product = so3.hat(a) @ np.swapaxes(so3.hat(b), -1, -2)
        close(np.trace(product, axis1=-2, axis2=-1) / 2, np.sum(x * y, axis=-1))


@pytest.mark.erratum("B A.3 (text)")
def test_turns_with_scale_are_spanned_by_i_and_j():
    rng = np.random.default_rng(6)
    s, delta = rng.normal(size=20), rng.uniform(-4, 4, 20)
    M = s[:, None, None] * so2.exp(delta)
    x, y = s * np.cos(delta), s * np.sin(delta)
    close(M, x[:, None, None] * np.eye(2) + y[:, None, None] * so2.hat(1.0))
    assert np.max(np.abs(M + np.swapaxes(M, -1, -2))) > 1  # printed: skew
