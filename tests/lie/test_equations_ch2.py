"""Chapter 2 of the book, equation by equation: laws of public functions, on random input."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import euler, quaternion, so2, so3

PI = np.pi
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-14)


@pytest.fixture
def rng():
    return np.random.default_rng(2)


def orthogonal(rng: np.random.Generator, n: int, count: int, sign: float) -> np.ndarray:
    """Random orthogonal matrices with the given determinant, made without our functions."""
    Q, T = np.linalg.qr(rng.normal(size=(count, n, n)))
    # As LAPACK leaves the signs, all turns of the plane would be by less than a quarter.
    Q *= np.sign(np.diagonal(T, axis1=-2, axis2=-1))[:, None, :]
    Q[..., 0] *= (sign * np.sign(np.linalg.det(Q)))[:, None]
    return Q


def unit(rng: np.random.Generator, n: int, count: int) -> np.ndarray:
    x = rng.normal(size=(count, n))
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def apart(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Distance of matrices, one for each of a batch."""
    return np.max(np.abs(A - B), axis=(-1, -2))


# ---- the plane


@pytest.mark.equation("B 2.1")
def test_a_turn_of_the_plane(rng):
    theta = rng.uniform(-9, 9, 30)
    R = so2.exp(theta)
    close(R[:, 0, 0], np.cos(theta))
    close(R[:, 1, 1], np.cos(theta))
    close(R[:, 1, 0], np.sin(theta))
    close(R[:, 0, 1], -np.sin(theta))
    z = rng.normal(size=(30, 2))
    turned = (z[:, 0] + 1j * z[:, 1]) * (np.cos(theta) + 1j * np.sin(theta))
    close(so2.act(R, z), np.stack([turned.real, turned.imag], axis=-1))


@pytest.mark.equation("B 2.2")
def test_the_turns_are_all_of_the_group(rng):
    A = orthogonal(rng, 2, 40, 1.0)
    close(so2.exp(so2.log(A)), A)
    theta = rng.uniform(-PI, PI, 40)
    for k in (-2, 1, 3):
        np.testing.assert_allclose(so2.exp(theta + 2 * PI * k), so2.exp(theta), atol=1e-14)
    assert np.all(apart(so2.exp(theta + 1e-3), so2.exp(theta)) > 5e-4)


@pytest.mark.equation("B 2.3", "B 2.13")
def test_orthogonal_with_determinant_one(rng):
    R = so2.exp(rng.uniform(-9, 9, 40))
    close(R @ np.swapaxes(R, -1, -2), np.broadcast_to(np.eye(2), R.shape))
    close(np.linalg.det(R), 1.0)
    close(so2.inverse(R) @ R, np.broadcast_to(np.eye(2), R.shape))
    close(R[:20] @ R[20:], R[20:] @ R[:20])
    with pytest.raises(ValueError, match=r"so2\.log: R must be a rotation"):
        so2.log(orthogonal(rng, 2, 3, -1.0))
    with pytest.raises(ValueError, match=r"so2\.log: R must be a rotation"):
        so2.log(1.1 * R)


def reflection(theta: np.ndarray) -> np.ndarray:
    return so2.exp(theta) @ np.diag([1.0, -1.0]) @ so2.exp(-theta)


@pytest.mark.equation("B 2.10")
def test_a_reflection_in_a_line(rng):
    theta = rng.uniform(-9, 9, 30)
    F = reflection(theta)
    c, s = np.cos(2 * theta), np.sin(2 * theta)
    close(F, np.stack([c, s, s, -c], axis=-1).reshape(-1, 2, 2))
    close(np.linalg.det(F), -1.0)
    along = so2.act(so2.exp(theta), np.array([1.0, 0.0]))
    across = so2.act(so2.exp(theta), np.array([0.0, 1.0]))
    close(so2.act(F, along), along)
    close(so2.act(F, across), -across)


@pytest.mark.equation("B 2.11")
def test_two_reflections_make_a_turn(rng):
    a, b = rng.uniform(-9, 9, (2, 30))
    close(reflection(a) @ reflection(b), so2.exp(2 * a - 2 * b))
    assert np.max(apart(reflection(b) @ reflection(a), so2.exp(2 * a - 2 * b))) > 1


# ---- axis and angle


@pytest.mark.equation("B 2.14")
def test_rodrigues_moves_a_vector(rng):
    u, theta, x = unit(rng, 3, 30), rng.uniform(-9, 9, 30), rng.normal(size=(30, 3))
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    along = np.sum(u * x, axis=-1, keepdims=True) * u
    close(so3.act(so3.from_axis_angle(u, theta), x), c * x + s * np.cross(u, x) + (1 - c) * along)


@pytest.mark.equation("B 2.15")
def test_rodrigues_as_a_matrix(rng):
    u, theta = unit(rng, 3, 30), rng.uniform(-9, 9, 30)
    c, s = np.cos(theta)[:, None, None], np.sin(theta)[:, None, None]
    zero = np.zeros(30)
    skew = np.array([[zero, -u[:, 2], u[:, 1]], [u[:, 2], zero, -u[:, 0]], [-u[:, 1], u[:, 0], zero]])
    R = np.eye(3) + s * np.moveaxis(skew, -1, 0) + (1 - c) * (u[:, :, None] * u[:, None, :] - np.eye(3))
    close(so3.from_axis_angle(u, theta), R)
    close(so3.exp(theta[:, None] * u), R)


@pytest.mark.equation("B 2.16", "B 2.17", "B 2.18")
def test_the_frame_of_the_axis_turns(rng):
    F, theta = orthogonal(rng, 3, 30, 1.0), rng.uniform(-9, 9, 30)
    u, v, w = np.moveaxis(F, -1, 0)
    R, c, s = so3.from_axis_angle(u, theta), np.cos(theta)[:, None], np.sin(theta)[:, None]
    close(so3.act(R, u), u)
    close(so3.act(R, v), c * v + s * w)
    close(so3.act(R, w), c * w - s * v)


@pytest.mark.equation("B 2.19")
def test_every_rotation_is_one_about_x_in_another_frame(rng):
    R = orthogonal(rng, 3, 30, 1.0)
    u, theta = so3.to_axis_angle(R)
    v = np.cross(u, rng.normal(size=(30, 3)))
    v /= np.linalg.norm(v, axis=-1, keepdims=True)
    F = np.stack([u, v, np.cross(u, v)], axis=-1)
    Rx = np.broadcast_to(np.eye(3), R.shape).copy()
    Rx[:, 1:, 1:] = so2.exp(theta)
    close(F @ Rx @ np.swapaxes(F, -1, -2), R)
    close(so3.rotation("x", theta), Rx)


@pytest.mark.equation("B 2.20")
def test_orthogonal_with_determinant_one_is_a_turn_about_an_axis(rng):
    u, theta = unit(rng, 3, 30), rng.uniform(-9, 9, 30)
    R = so3.from_axis_angle(u, theta)
    close(R @ np.swapaxes(R, -1, -2), np.broadcast_to(np.eye(3), R.shape))
    close(np.linalg.det(R), 1.0)
    A = orthogonal(rng, 3, 30, 1.0)
    close(so3.from_axis_angle(*so3.to_axis_angle(A)), A)
    close(so3.inverse(A) @ A, np.broadcast_to(np.eye(3), A.shape))
    with pytest.raises(ValueError, match=r"so3\.log: R must be a rotation"):
        so3.log(orthogonal(rng, 3, 3, -1.0))
    a, b = so3.rotation("x", PI / 6), so3.rotation("z", PI / 4)
    assert apart(a @ b, b @ a) > 0.3


# ---- Euler angles


def turn(axis: str, theta: float) -> np.ndarray:
    """The rotation about a coordinate axis, entry by entry as printed in (2.21)."""
    c, s = np.cos(theta), np.sin(theta)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


@pytest.mark.equation("B 2.21")
def test_three_turns_reach_every_rotation(rng):
    for t1, t2, t3 in rng.uniform(-9, 9, (20, 3)):
        R = turn("z", t3) @ turn("y", t2) @ turn("x", t1)
        close(euler.to_matrix([t1, t2, t3], "xyz"), R)
        close(euler.ring_frames([t1, t2, t3], "xyz")[-1], R)
    A = orthogonal(rng, 3, 30, 1.0)
    for t, R in zip(euler.from_matrix(A, "xyz"), A, strict=True):
        close(turn("z", t[2]) @ turn("y", t[1]) @ turn("x", t[0]), R)


@pytest.mark.equation("B 2.22")
def test_a_quarter_turn_leads_to_the_other_convention(rng):
    t = rng.uniform(-9, 9, (30, 3))
    other = t * [1, 1, -1] - [0, PI / 2, 0]
    close(euler.to_matrix(t, "xyz"), so3.rotation("y", PI / 2) @ euler.to_matrix(other, "xyx"))
    close(euler.singular_values(t, "xyz"), euler.singular_values(other, "xyx"))


@pytest.mark.equation("B 2.23")
@pytest.mark.parametrize("size", [1e-12, 1e-3, 1.0, 3.0])
def test_a_small_turn_about_z_has_large_angles(size):
    for theta in (size, -size):
        angles = np.array([-PI / 2, theta, PI / 2])
        close(euler.to_matrix(angles, "xyx"), turn("z", theta))
        close(euler.to_matrix(-angles, "xyx"), euler.to_matrix([PI / 2, -theta, -PI / 2], "xyx"))
        close(euler.from_matrix(turn("z", theta), "xyx"), np.sign(theta) * angles, atol=1e-13)
    close(euler.to_matrix([0.3, 0.0, 0.4], "xyx"), euler.to_matrix([0.7, 0.0, 0.0], "xyx"))


# ---- quaternions


@pytest.mark.equation("B 2.24")
def test_quaternions_are_real_matrices(rng):
    q, p = rng.normal(size=(2, 30, 4))
    a, b, c, d = q.T
    printed = np.array([[a, -b, -c, -d], [b, a, -d, c], [c, d, a, -b], [d, -c, b, a]])
    close(quaternion.left_matrix(q), np.moveaxis(printed, -1, 0))
    close(quaternion.left_matrix(quaternion.multiply(q, p))[..., 0], quaternion.multiply(q, p))
    close(
        quaternion.left_matrix(q) @ quaternion.left_matrix(p),
        quaternion.left_matrix(quaternion.multiply(q, p)),
        atol=1e-13,
    )
    one, i, j, k = np.eye(4)
    close(quaternion.multiply(i, j), k)
    close(quaternion.multiply(j, k), i)
    close(quaternion.multiply(k, i), j)
    close([quaternion.multiply(e, e) for e in (i, j, k)], [-one] * 3)


@pytest.mark.equation("B 2.25")
def test_unit_quaternions_are_a_group(rng):
    q, p = unit(rng, 4, 30), unit(rng, 4, 30)
    close(quaternion.norm(quaternion.multiply(q, p)), 1.0)
    close(quaternion.multiply(q, quaternion.conjugate(q)), np.broadcast_to([1.0, 0, 0, 0], q.shape))
    close(quaternion.inverse(q), quaternion.conjugate(q))
    longer = rng.uniform(0.1, 9, (30, 1)) * q
    close(quaternion.norm(longer) ** 2, np.sum(longer**2, axis=-1), atol=1e-13)
    close(quaternion.normalize(longer), q)


@pytest.mark.equation("B 2.26")
def test_a_unit_quaternion_has_half_of_the_angle(rng):
    u, theta = unit(rng, 3, 30), rng.uniform(-9, 9, 30)
    q = quaternion.from_axis_angle(u, theta)
    close(q[:, 0], np.cos(theta / 2))
    close(q[:, 1:], np.sin(theta / 2)[:, None] * u)
    close(quaternion.to_matrix(q), so3.from_axis_angle(u, theta))
    any_unit = unit(rng, 4, 30)
    x = quaternion.log(any_unit)
    half = np.linalg.norm(x, axis=-1)
    close(quaternion.from_axis_angle(x / half[:, None], 2 * half), any_unit)


@pytest.mark.equation("B 2.27", "B 2.28")
def test_conjugation_turns_imaginary_quaternions(rng):
    u, theta, p = unit(rng, 3, 30), rng.uniform(-9, 9, 30), rng.normal(size=(30, 3))
    q = quaternion.from_axis_angle(u, theta)
    imaginary = np.concatenate([np.zeros((30, 1)), p], axis=-1)
    moved = quaternion.multiply(quaternion.multiply(q, imaginary), quaternion.inverse(q))
    close(moved[:, 0], 0.0)
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    rodrigues = c * p + s * np.cross(u, p) + (1 - c) * np.sum(u * p, axis=-1, keepdims=True) * u
    close(moved[:, 1:], rodrigues)
    close(quaternion.act(q, p), rodrigues)


@pytest.mark.equation("B 2.29")
def test_products_go_to_products_and_every_rotation_is_met(rng):
    q, p = unit(rng, 4, 30), unit(rng, 4, 30)
    R = quaternion.to_matrix(quaternion.multiply(q, p))
    close(R, quaternion.to_matrix(q) @ quaternion.to_matrix(p))
    A = orthogonal(rng, 3, 30, 1.0)
    close(quaternion.to_matrix(quaternion.from_matrix(A)), A)


@pytest.mark.equation("B 2.30")
def test_only_the_sign_of_a_quaternion_is_lost(rng):
    q = unit(rng, 4, 30)
    close(quaternion.to_matrix(-q), quaternion.to_matrix(q))
    again = quaternion.from_matrix(quaternion.to_matrix(q))
    close(np.sign(q[:, :1]) * again, q)
    close(quaternion.from_matrix(np.eye(3)), [1.0, 0, 0, 0])


@pytest.mark.equation("B 2.31")
def test_the_exponential_of_an_imaginary_quaternion(rng):
    x = rng.normal(size=(30, 3)) * 2
    imaginary = np.concatenate([np.zeros((30, 1)), x], axis=-1)
    power = series = np.broadcast_to([1.0, 0, 0, 0], imaginary.shape)
    for n in range(1, 60):
        power = quaternion.multiply(power, imaginary) / n
        series = series + power
    close(quaternion.exp(x), series, atol=1e-12)
    theta = np.linalg.norm(x, axis=-1, keepdims=True)
    close(quaternion.exp(x), np.concatenate([np.cos(theta), np.sin(theta) * x / theta], axis=-1))
    q = unit(rng, 4, 30)
    close(quaternion.exp(quaternion.log(q)), q)


@pytest.mark.equation("B 2.32")
def test_slerp_in_sines(rng):
    q0, q1, t = unit(rng, 4, 30), unit(rng, 4, 30), rng.uniform(-1, 2, 30)
    theta = np.arccos(np.sum(q0 * q1, axis=-1))
    weights = np.stack([np.sin((1 - t) * theta), np.sin(t * theta)], axis=-1) / np.sin(theta)[:, None]
    close(quaternion.slerp(q0, q1, t), weights[:, :1] * q0 + weights[:, 1:] * q1, atol=1e-13)
    close(quaternion.dot(q0, q1), np.cos(theta))


@pytest.mark.equation("B 2.33")
def test_slerp_goes_along_with_multiplication_from_the_right(rng):
    q0, q1, t = unit(rng, 4, 30), unit(rng, 4, 30), rng.uniform(-1, 2, 30)
    ratio = quaternion.multiply(q1, quaternion.inverse(q0))
    from_one = quaternion.slerp([1.0, 0, 0, 0], ratio, t)
    close(quaternion.slerp(q0, q1, t), quaternion.multiply(from_one, q0))


@pytest.mark.equation("B 2.34")
def test_slerp_from_one_is_the_exponential_of_a_line(rng):
    u, theta, t = unit(rng, 3, 30), rng.uniform(0.01, PI - 0.01, 30), rng.uniform(-1, 2, 30)
    end = quaternion.exp(theta[:, None] * u)
    close(quaternion.slerp([1.0, 0, 0, 0], end, t), quaternion.exp((t * theta)[:, None] * u), atol=1e-13)
