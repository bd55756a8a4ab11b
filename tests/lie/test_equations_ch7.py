"""Chapter 7 of the book, (7.1)-(7.9), with (1)-(3) and (5) of the MEIS paper: laws on random input."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import affine, blend, generic, se3, so3

PI = np.pi
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-12)
COUNT = 25
UPPER = np.triu_indices(3)


@pytest.fixture
def rng():
    return np.random.default_rng(7)


@pytest.fixture
def params(rng):
    """Rotation vector within a half turn, translation, symmetric part."""
    x = rng.normal(size=(COUNT, 3))
    x *= rng.uniform(0.1, 3.1, (COUNT, 1)) / np.linalg.norm(x, axis=-1, keepdims=True)
    return np.concatenate([x, rng.normal(size=(COUNT, 9))], axis=-1)


def block(A: np.ndarray, d: np.ndarray, corner: float) -> np.ndarray:
    H = np.zeros((len(A), 4, 4))
    H[:, :3, :3], H[:, :3, 3], H[:, 3, 3] = A, d, corner
    return H


def symmetric(y: np.ndarray) -> np.ndarray:
    """The matrix of xx xy xz yy yz zz."""
    Y = np.zeros((len(y), 3, 3))
    Y[:, UPPER[0], UPPER[1]] = Y[:, UPPER[1], UPPER[0]] = y
    return Y


def function_of(S: np.ndarray, f) -> np.ndarray:
    """A function of symmetric matrices by their eigenvalues."""
    d, Q = np.linalg.eigh(S)
    return (Q * f(d)[:, None, :]) @ np.swapaxes(Q, -1, -2)


def coefficients(theta: np.ndarray) -> tuple[np.ndarray, ...]:
    t = theta[:, None, None]
    return t, np.sin(t), np.cos(t)


@pytest.mark.equation("B 7.1", "M 1")
def test_a_motion_after_a_stretch(params):
    X, zero = block(so3.hat(params[:, :3]), params[:, 3:6], 0.0), np.zeros((COUNT, 3))
    stretch = block(function_of(symmetric(params[:, 6:]), np.exp), zero, 1.0)
    close(affine.phi_se(params), generic.exp(X) @ stretch, atol=1e-11)
    assert np.all(np.linalg.det(affine.phi_se(params)) > 0)


@pytest.mark.equation("B 7.2", "M 2")
def test_the_parameters_by_polar_decomposition(params, rng):
    A = rng.normal(size=(COUNT, 3, 3))
    A[..., 0] *= np.sign(np.linalg.det(A))[:, None]
    T = block(A, rng.normal(size=(COUNT, 3)), 1.0)
    S = function_of(np.swapaxes(A, -1, -2) @ A, np.sqrt)
    found = affine.psi_se(T)
    motion = T @ block(np.linalg.inv(S), np.zeros((COUNT, 3)), 1.0)
    close(se3.exp(found[:, :6]), motion, atol=1e-10)
    assert np.all(np.linalg.norm(found[:, :3], axis=-1) <= PI * (1 + 1e-15))
    close(symmetric(found[:, 6:]), function_of(S, np.log), atol=1e-10)
    close(affine.phi_se(found), T)
    close(affine.psi_se(affine.phi_se(params)), params, atol=1e-11)


@pytest.mark.erratum("B 7.1", "M 1")
def test_no_inverse_is_continuous_on_a_full_turn():
    turns = np.linspace(0.0, 1.0, 401)
    path = block(so3.rotation("x", 2 * PI * turns), np.zeros((401, 3)), 1.0)
    steps = np.linalg.norm(np.diff(affine.psi_so(path), axis=0), axis=-1)
    assert np.max(steps) > 6  # the principal values jump by 2 pi
    reference = np.zeros(12)
    for T in path:
        found = affine.psi_so_near(T, reference)
        assert np.linalg.norm(found - reference) < 0.02
        reference = found
    close(path[0], path[-1])
    close(reference[:3], [2 * PI, 0, 0])  # and those that follow end elsewhere than they began


@pytest.mark.equation("B 7.3")
def test_the_angle_of_a_skew_matrix(params):
    X = so3.hat(params[:, :3])
    theta = np.sqrt(X[:, 0, 1] ** 2 + X[:, 0, 2] ** 2 + X[:, 1, 2] ** 2)
    close(theta, np.sqrt(np.trace(np.swapaxes(X, -1, -2) @ X, axis1=1, axis2=2) / 2))
    close(so3.to_axis_angle(so3.exp(params[:, :3]))[1], theta)


@pytest.mark.equation("B 7.4", "B 7.5")
def test_the_motion_of_a_twist(params):
    x, d = params[:, :3], params[:, 3:6]
    X, (t, s, c) = so3.hat(x), coefficients(np.linalg.norm(x, axis=-1))
    R = np.eye(3) + s / t * X + (1 - c) / t**2 * (X @ X)
    V = np.eye(3) + (1 - c) / t**2 * X + (t - s) / t**3 * (X @ X)
    close(so3.exp(x), R)
    close(se3.exp(params[:, :6]), block(R, np.einsum("...ij,...j->...i", V, d), 1.0))


@pytest.mark.equation("B 7.6", "B 7.7")
def test_the_rotation_vector_of_a_rotation(rng):
    R, _ = np.linalg.qr(rng.normal(size=(COUNT, 3, 3)))
    R[..., 0] *= np.sign(np.linalg.det(R))[:, None]
    theta = np.arccos((np.trace(R, axis1=1, axis2=2) - 1) / 2)
    close(so3.to_axis_angle(R)[1], theta, atol=1e-11)
    t, s, _ = coefficients(theta)
    close(so3.hat(so3.log(R)), t / (2 * s) * (R - np.swapaxes(R, -1, -2)), atol=1e-11)


@pytest.mark.equation("B 7.8")
def test_the_translation_of_a_motion_in_the_algebra(params):
    x, d = params[:, :3], params[:, 3:6]
    X, (t, s, c) = so3.hat(x), coefficients(np.linalg.norm(x, axis=-1))
    back = np.eye(3) - X / 2 + (2 * s - (1 + c) * t) / (2 * t**2 * s) * (X @ X)
    wanted = np.concatenate([x, np.einsum("...ij,...j->...i", back, d)], axis=-1)
    close(se3.log(block(so3.exp(x), d, 1.0)), wanted)


@pytest.fixture
def motions(rng):
    """Three transformations with rotations below a quarter turn, and weights."""
    return affine.phi_se(0.4 * rng.normal(size=(3, 12))), rng.uniform(-0.5, 1.5, (COUNT, 3))


@pytest.mark.equation("B 7.9", "M 5")
def test_a_point_moves_by_the_blend_of_parameters(motions, rng):
    A, w = motions
    v = rng.normal(size=(COUNT, 3))
    blended = blend.phi_se(w, A)
    close(blended, affine.phi_se(w @ affine.psi_se(A)))
    for i in range(3):
        close(blend.phi_se(np.eye(3)[i], A), A[i])
    moved = generic.transform(blended, v)
    close(moved, np.einsum("...ij,...j->...i", blended[:, :3, :3], v) + blended[:, :3, 3])


@pytest.mark.erratum("B 7.9")
def test_a_blend_depends_on_the_origin():
    """A quarter turn at half weight, about a probe at x = 10."""
    shift = np.eye(4)
    shift[0, 3] = 10.0
    turn = np.eye(4)
    turn[:3, :3] = so3.rotation("z", PI / 2)
    world = shift @ turn @ np.linalg.inv(shift)
    p = np.array([11.0, 0.0, 0.0])
    at_probe = shift @ blend.phi_so([0.5], turn[None]) @ np.linalg.inv(shift)
    close(generic.transform(at_probe, p)[:2], [10 + np.sqrt(0.5), np.sqrt(0.5)])
    close(generic.transform(blend.phi_so([0.5], world[None]), p)[:2], [12.8, 2.8], atol=0.05)
    close(generic.transform(blend.phi_se([0.5], world[None]), p)[:2], [10 + np.sqrt(0.5), np.sqrt(0.5)])


@pytest.mark.erratum("M 5")
def test_a_sum_of_motions_is_no_motion():
    A = np.broadcast_to(np.eye(4), (2, 4, 4)).copy()
    A[0, :3, :3], A[1, :3, :3] = so3.rotation("x", 1.0), so3.rotation("y", 2.0)
    printed = np.sum(A, axis=0)[:3, :3]
    assert np.max(np.abs(printed.T @ printed - np.eye(3))) > 2
    R = blend.phi_se([1.0, 1.0], A)[:3, :3]
    close(R.T @ R, np.eye(3))
