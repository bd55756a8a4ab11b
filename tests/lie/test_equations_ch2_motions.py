"""Chapter 2 of the book, (2.4)-(2.9) and (2.35)-(2.45): motions as matrices and as dual complex numbers."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import dual_complex, dual_quaternion, generic, groups, quaternion, se2, se3, so2, so3

close = partial(np.testing.assert_allclose, rtol=0, atol=1e-13)
COUNT = 25


@pytest.fixture
def rng():
    return np.random.default_rng(22)


def block(A: np.ndarray, d: np.ndarray) -> np.ndarray:
    """The matrices [[A, d], [0, 1]], made without our functions."""
    H = np.zeros((len(A), A.shape[-1] + 1, A.shape[-1] + 1))
    H[:, :-1, :-1], H[:, :-1, -1], H[:, -1, -1] = A, d, 1.0
    return H


def shift(d: np.ndarray) -> np.ndarray:
    return block(np.broadcast_to(np.eye(d.shape[-1]), (len(d), d.shape[-1], d.shape[-1])), d)


def turn(theta: np.ndarray) -> np.ndarray:
    return block(so2.exp(theta), np.zeros((len(theta), 2)))


def orthogonal(rng: np.random.Generator, n: int, sign: float) -> np.ndarray:
    Q, _ = np.linalg.qr(rng.normal(size=(COUNT, n, n)))
    Q[..., 0] *= (sign * np.sign(np.linalg.det(Q)))[:, None]
    return Q


def apply(A: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.einsum("...ij,...j->...i", A, x)


def as_complex(x: np.ndarray) -> np.ndarray:
    return x[..., 0] + 1j * x[..., 1]


@pytest.mark.equation("B 2.4")
def test_a_translation_is_a_matrix(rng):
    b, x = rng.normal(size=(2, COUNT, 2))
    T = se2.exp(np.concatenate([np.zeros((COUNT, 1)), b], axis=-1))
    close(T, shift(b))
    close(se2.act(T, x), x + b)
    close(apply(T, generic.homogeneous(x)), np.concatenate([x + b, np.ones((COUNT, 1))], axis=-1))


@pytest.mark.equation("B 2.5", "B 2.6")
def test_first_turn_then_shift(rng):
    theta, (b, x) = rng.uniform(-3, 3, COUNT), rng.normal(size=(2, COUNT, 2))
    T = block(so2.exp(theta), b)
    close(se2.act(T, x), so2.act(so2.exp(theta), x) + b)
    close(shift(b) @ turn(theta), T)
    # Every such matrix is in the group, and every element of the group is such a matrix.
    close(se2.exp(se2.log(T)), T)
    close(se2.log(T)[:, 0], theta)
    close(se2.inverse(T) @ T, shift(0 * b))
    with pytest.raises(ValueError, match=r"se2\.log: T must be"):
        se2.log(block(orthogonal(rng, 2, -1.0), b))


@pytest.mark.equation("B 2.7", "B 2.8", "B 3.5")
def test_a_turned_translation_is_a_translation(rng):
    theta, b = rng.uniform(-9, 9, COUNT), rng.normal(size=(COUNT, 2))
    moved = so2.act(so2.exp(theta), b)
    close(turn(theta) @ shift(b), shift(moved) @ turn(theta))
    close(turn(theta) @ shift(b) @ turn(-theta), shift(moved))
    still = np.concatenate([np.zeros((COUNT, 1)), b], axis=-1)
    close(apply(se2.adjoint(turn(theta)), still), np.concatenate([np.zeros((COUNT, 1)), moved], axis=-1))
    R, d = so3.exp(rng.normal(size=(COUNT, 3))), rng.normal(size=(COUNT, 3))
    at_rest, T = np.concatenate([0 * d, d], axis=-1), block(R, 0 * d)
    close(T @ se3.exp(at_rest) @ se3.inverse(T), shift(so3.act(R, d)))


@pytest.mark.equation("B 2.9")
def test_a_turn_about_another_point(rng):
    theta, (b, x) = rng.uniform(-3, 3, COUNT), rng.normal(size=(2, COUNT, 2))
    T = shift(b) @ turn(theta) @ shift(-b)
    close(se2.act(T, b), b)
    close(as_complex(se2.act(T, x) - b), np.exp(1j * theta) * as_complex(x - b))
    # It is the exponential of an angular velocity about b.
    velocity = np.stack([theta, theta * b[:, 1], -theta * b[:, 0]], axis=-1)
    close(se2.exp(velocity), T)


# ---- complex numbers


@pytest.mark.equation("B 2.35", "B 2.36")
def test_a_motion_of_the_plane_in_complex_numbers(rng):
    theta, (b, x) = rng.uniform(-3, 3, COUNT), rng.normal(size=(2, COUNT, 2))
    T = block(so2.exp(theta), b)
    alpha, beta = np.exp(1j * theta), as_complex(b)
    close(as_complex(se2.act(T, x)), alpha * as_complex(x) + beta)
    M = dual_complex.to_complex_matrix(dual_complex.from_matrix(T))
    close(M[:, 0, 0], alpha)
    close(M[:, 0, 1], beta)
    close(M[:, 1], np.broadcast_to([0.0, 1.0], (COUNT, 2)))
    close(M[1:] @ M[:-1], dual_complex.to_complex_matrix(dual_complex.from_matrix(T[1:] @ T[:-1])))


@pytest.mark.equation("B 2.37")
def test_quaternions_are_complex_matrices(rng):
    q, p = rng.normal(size=(2, COUNT, 4))
    z, w = q[:, 0] + 1j * q[:, 1], q[:, 2] + 1j * q[:, 3]
    M = quaternion.to_complex_matrix(q)
    close(M, np.stack([z, -w, w.conj(), z.conj()], axis=-1).reshape(COUNT, 2, 2))
    close(M @ quaternion.to_complex_matrix(p), quaternion.to_complex_matrix(quaternion.multiply(q, p)))
    close(np.linalg.det(M), quaternion.norm(q) ** 2)
    close(quaternion.from_complex_matrix(M), q)


@pytest.mark.equation("B 2.38", "B 2.41")
def test_dual_complex_numbers_multiply(rng):
    p, q, r = rng.normal(size=(3, COUNT, 4))
    (p0, p1), (q0, q1) = ((as_complex(x[:, :2]), as_complex(x[:, 2:])) for x in (p, q))
    product = dual_complex.multiply(p, q)
    close(as_complex(product[:, :2]), p0 * q0)
    close(as_complex(product[:, 2:]), p1 * q0.conj() + p0 * q1)
    times = dual_complex.multiply
    close(times(times(p, q), r), times(p, times(q, r)))
    close(times(p, q + r), times(p, q) + times(p, r))
    close(times(p + q, r), times(p, r) + times(q, r))
    assert np.max(np.abs(times(p, q) - times(q, p))) > 1
    epsilon = np.array([0.0, 0, 1, 0])
    close(times(epsilon, epsilon), 0.0)
    # They lie among the dual quaternions, p0 + p1 j eps.
    lifted = dual_complex.to_dual_quaternion
    close(lifted(times(p, q)), dual_quaternion.multiply(lifted(p), lifted(q)))


@pytest.mark.equation("B 2.39", "B 2.40")
def test_dual_complex_conjugate_and_absolute_value(rng):
    p, q = rng.normal(size=(2, COUNT, 4))
    close(dual_complex.conjugate(p), p * [1, -1, 1, 1])
    close(dual_complex.norm(p), np.abs(as_complex(p[:, :2])))
    close(dual_complex.norm(dual_complex.multiply(p, q)), dual_complex.norm(p) * dual_complex.norm(q))
    reverse = dual_complex.multiply(dual_complex.conjugate(q), dual_complex.conjugate(p))
    close(dual_complex.conjugate(dual_complex.multiply(p, q)), reverse)
    # A point v is 1 + v eps, and p moves it to p (1 + v eps) conj(p).
    unit, v = dual_complex.normalize(p), rng.normal(size=(COUNT, 2))
    point = np.concatenate([np.broadcast_to([1.0, 0.0], (COUNT, 2)), v], axis=-1)
    moved = dual_complex.multiply(dual_complex.multiply(unit, point), dual_complex.conjugate(unit))
    close(moved[:, :2], np.broadcast_to([1.0, 0.0], (COUNT, 2)))
    close(moved[:, 2:], dual_complex.act(unit, v))


# ---- homogeneous matrices


@pytest.mark.equation("B 2.12", "B 2.42", "B 2.43")
@pytest.mark.parametrize("n", [2, 3])
def test_who_belongs_to_the_congruences_and_the_motions(rng, n):
    d = rng.normal(size=(COUNT, n))
    turned, flipped = orthogonal(rng, n, 1.0), orthogonal(rng, n, -1.0)
    assert np.all(groups.is_member("O", turned)) and np.all(groups.is_member("O", flipped))
    assert not np.any(groups.is_member("O", 1.01 * turned))
    motion, flip = block(turned, d), block(flipped, d)
    assert np.all(groups.is_member("E", motion)) and np.all(groups.is_member("E", flip))
    assert np.all(groups.is_member("SE", motion)) and not np.any(groups.is_member("SE", flip))
    assert np.all(groups.is_member("SE", flip[1:] @ flip[:-1]))
    assert not np.any(groups.is_member("E", block(1.01 * turned, d)))
    x, y = rng.normal(size=(2, COUNT, n))
    moved = generic.transform(flip, x) - generic.transform(flip, y)
    close(np.linalg.norm(moved, axis=-1), np.linalg.norm(x - y, axis=-1))
    close(generic.embed(flipped, d), flip)


@pytest.mark.equation("B 2.44")
def test_a_projective_map(rng):
    P, x = rng.normal(size=(COUNT, 4, 4)), rng.normal(size=(COUNT, 3))
    z = apply(P, np.concatenate([x, np.ones((COUNT, 1))], axis=-1))
    close(generic.transform(P, x), z[:, :3] / z[:, 3:], atol=1e-10)
    close(generic.transform(-2.5 * P, x), generic.transform(P, x), atol=1e-10)
    close(generic.inhomogeneous(-3.0 * generic.homogeneous(x)), x)
    # Lines stay lines: the images of three points in a row are in a row.
    images = [generic.transform(P, x + t * np.array([1.0, -2.0, 0.5])) for t in (0.0, 0.1, 0.3)]
    a, b = images[1] - images[0], images[2] - images[0]
    size = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    close(np.linalg.norm(np.cross(a, b), axis=-1) / size, 0.0, atol=1e-9)


@pytest.mark.equation("B 2.45")
def test_a_projective_map_with_such_a_last_row_is_affine(rng):
    A, d, x = rng.normal(size=(COUNT, 3, 3)), rng.normal(size=(COUNT, 3)), rng.normal(size=(COUNT, 3))
    close(generic.transform(block(A, d), x), apply(A, x) + d)
    close(generic.affine(-2.0 * block(A, d)), block(A, d))
    parallel = generic.transform(block(A, d), x + 1.0) - generic.transform(block(A, d), x)
    close(parallel, np.sum(A, axis=-1), atol=1e-12)
    with pytest.raises(ValueError, match=r"affine: P must"):
        generic.affine(rng.normal(size=(4, 4)))
