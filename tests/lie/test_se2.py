"""Rigid transformations of the plane against 50 digits and SciPy, and their laws."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from lietool.lie import se2, se3, so2

PI = np.pi
BATCHES = [(), (4,), (2, 3)]
ANGLES = [0.0, 1e-300, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 1.0, 1.6, 2.0, 3.0]
ANGLES += [PI - d for d in (1e-3, 1e-6, 1e-8, 1e-12, 1e-15, 4.5e-16, 0.0)]
SCALES = [1e-50, 1.0, 1e50]

each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_angle = pytest.mark.parametrize("angle", [1.3, 1e-9, PI - 1e-9, PI, 0.0])


def twists(batch: tuple[int, ...], angle: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(*batch, 3))
    x[..., 0] = angle * (1.0 if angle == PI else rng.choice([-1.0, 1.0], size=batch))
    return x


def hard_twists(theta: float) -> np.ndarray:
    rng = np.random.default_rng(3)
    return np.array(
        [[s * theta, *scale * rng.normal(size=2)] for s in (1, -1) for scale in SCALES for _ in range(8)]
    )


def exact(x: np.ndarray) -> tuple[mpmath.mpc, mpmath.mpc, mpmath.mpc]:
    """Return e^(i theta), V l and l as complex numbers."""
    theta, x, y = (mpmath.mpf(float(v)) for v in x)
    turn = mpmath.exp(1j * theta)
    translation = mpmath.mpc(x, y)
    return turn, translation * ((turn - 1) / (1j * theta) if theta else 1), translation


@pytest.mark.equation("B 2.5", "B 2.6", "B 4.4")
@pytest.mark.parametrize("theta", ANGLES)
def test_exp_and_log_to_a_few_ulp(theta):
    for x in hard_twists(theta):
        with mpmath.workdps(400 if theta == 1e-300 else 50):
            turn, d, translation = exact(x)
            T = se2.exp(x)
            assert abs(mpmath.mpc(T[0, 0], T[1, 0]) - turn) <= 5e-16
            assert abs(mpmath.mpc(T[0, 2], T[1, 2]) - d) <= 1e-15 * abs(d)
            c, s = float(turn.real), float(turn.imag)
            y = se2.log([[c, -s, float(d.real)], [s, c, float(d.imag)], [0, 0, 1]])
            assert abs(y[0] - x[0]) <= 5e-16 * abs(x[0])
            assert abs(mpmath.mpc(*y[1:]) - translation) <= 1e-15 * abs(translation)


@pytest.mark.parametrize("theta", [4.0, 2 * PI - 1e-9, 2 * PI, 31.0])
def test_exp_of_more_than_a_half_turn(theta):
    for x in hard_twists(theta):
        with mpmath.workdps(50):
            turn, d, translation = exact(x)
            T = se2.exp(x)
            assert abs(mpmath.mpc(T[0, 0], T[1, 0]) - turn) <= 5e-16
            assert abs(mpmath.mpc(T[0, 2], T[1, 2]) - d) <= 1e-15 * abs(translation)


@each_batch
@each_angle
@pytest.mark.equation("B 2.6", "B 4.8", "B 4.11")
def test_laws(batch, angle):
    x, y = twists(batch, angle, 1), twists(batch, 0.7, 2)
    f, g, h = se2.exp(x), se2.exp(y), se2.exp(twists(batch, 2.0, 3))
    np.testing.assert_allclose(se2.log(f), x, atol=2e-15)
    np.testing.assert_allclose((f @ g) @ h, f @ (g @ h), atol=4e-15)
    np.testing.assert_allclose(f @ se2.inverse(f), np.broadcast_to(np.eye(3), f.shape), atol=1e-15)
    np.testing.assert_allclose(se2.exp(1.7 * x), se2.exp(0.6 * x) @ se2.exp(1.1 * x), atol=4e-15)
    np.testing.assert_allclose(se2.exp(-x), se2.inverse(f), atol=2e-15)
    p = np.random.default_rng(4).normal(size=(*batch, 2))
    np.testing.assert_allclose(se2.act(f @ g, p), se2.act(f, se2.act(g, p)), atol=4e-15)
    z = np.einsum("...ij,...j->...i", se2.adjoint(f), y)
    np.testing.assert_allclose(f @ se2.hat(y) @ se2.inverse(f), se2.hat(z), atol=4e-15)
    np.testing.assert_allclose(f @ g @ se2.inverse(f), se2.exp(z), atol=8e-15)
    np.testing.assert_allclose(se2.adjoint(f @ h), se2.adjoint(f) @ se2.adjoint(h), atol=4e-15)
    assert np.array_equal(se2.vee(se2.hat(x)), x)


@each_batch
@each_angle
@pytest.mark.equation("B 4.14")
def test_jacobians(batch, angle):
    """exp(x + e) = exp(J e) exp(x) to first order; J fixes x; its inverse is one."""
    x, e = twists(batch, angle, 1), 1e-5 * twists(batch, 1.0, 2)
    if angle == PI:
        x[..., 0] -= 1e-4
    J, K = se2.left_jacobian(x), se2.left_jacobian_inverse(x)
    apply = lambda A, v: np.einsum("...ij,...j->...i", A, v)  # noqa: E731
    step = se2.log(se2.exp(x + e) @ se2.inverse(se2.exp(x - e))) / 2
    np.testing.assert_allclose(apply(J, e), step, atol=1e-14)
    np.testing.assert_allclose(apply(J, x), x, atol=2e-15)
    np.testing.assert_allclose(J @ K, np.broadcast_to(np.eye(3), J.shape), atol=4e-15)


def test_the_plane_in_space():
    """se(2) is the part of se(3) that turns about z and moves across it."""
    x = twists((20,), 1.3)
    wide = np.zeros((20, 6))
    wide[:, 2:5] = x
    at = np.ix_([0, 1, 3], [0, 1, 3])
    T = se3.exp(wide)
    np.testing.assert_allclose(T[(..., *at)], se2.exp(x), atol=4e-16)
    np.testing.assert_allclose(se3.log(T)[:, 2:5], se2.log(se2.exp(x)), atol=2e-15)
    keep = np.ix_([2, 3, 4], [2, 3, 4])
    np.testing.assert_allclose(se3.adjoint(T)[(..., *keep)], se2.adjoint(se2.exp(x)), atol=1e-15)
    for name in ("left_jacobian", "left_jacobian_inverse"):
        plane, space = getattr(se2, name)(x), getattr(se3, name)(wide)[(..., *keep)]
        np.testing.assert_allclose(space, plane, atol=1e-15)
    np.testing.assert_allclose(se2.exp(x), [expm(se2.hat(xi)) for xi in x], atol=2e-15)


@pytest.mark.equation("B 2.4", "B 2.5", "B 2.7", "B 2.8", "B 2.9", "B 3.5", "B 4.5")
def test_translations_and_rotations_of_the_plane():
    rng = np.random.default_rng(5)
    b, theta = rng.normal(size=2), 0.8
    T_b, R = se2.exp([0, *b]), se2.exp([theta, 0, 0])
    np.testing.assert_array_equal(T_b, [[1, 0, b[0]], [0, 1, b[1]], [0, 0, 1]])
    p = rng.normal(size=2)
    np.testing.assert_allclose(se2.act(T_b @ R, p), so2.exp(theta) @ p + b, atol=1e-15)
    turned = se2.exp([0, *(so2.exp(theta) @ b)])
    np.testing.assert_allclose(R @ T_b, turned @ R, atol=1e-15)
    np.testing.assert_allclose(R @ T_b @ se2.inverse(R), turned, atol=1e-15)
    about = T_b @ R @ se2.inverse(T_b)
    np.testing.assert_allclose(se2.act(about, b), b, atol=1e-15)
    # About b, the translation of the twist is -theta J b: the velocity at the origin.
    np.testing.assert_allclose(se2.log(about), [theta, theta * b[1], -theta * b[0]], atol=1e-15)


def test_half_turn_is_pi():
    T = np.diag([-1.0, -1.0, 1.0])
    T[0, 2] = 2.0
    for minus in (0.0, -0.0):
        T[0, 1] = T[1, 0] = minus
        np.testing.assert_allclose(se2.log(T), [PI, 0, -PI], atol=1e-15)


def test_what_is_not_rigid_and_where_no_inverse_is():
    T = np.tile(np.eye(3), (2, 1, 1))
    T[1, 2, 0] = 0.1
    with pytest.raises(
        ValueError, match=r"^se2\.log: T must be a rigid .* last row 0\.1 0 1 at index \(1,\)\."
    ):
        se2.log(T)
    T[1] = np.diag([1.0, -1.0, 1.0])
    with pytest.raises(
        ValueError, match=r"^se2\.log: T must be a rigid .* det > 0; got det = -1 at index \(1,\)"
    ):
        se2.log(T)
    with pytest.raises(ValueError, match=r"^se2\.left_jacobian_inverse: x must be of an angle not 2 pi n"):
        se2.left_jacobian_inverse([2 * PI, 1, 1])


coordinates = st.floats(-3.1, 3.1, allow_nan=False)


@settings(derandomize=True, deadline=None, max_examples=120)
@given(st.tuples(coordinates, coordinates, coordinates), st.sampled_from([1.0, 1e-5, 1e-12, 1e-200]))
def test_round_trip_on_whatever_hypothesis_finds(x, scale):
    x = np.array([scale * x[0], x[1], x[2]])
    y = se2.log(se2.exp(x))
    np.testing.assert_allclose(y[0], x[0], rtol=1e-15, atol=1e-320)
    np.testing.assert_allclose(y[1:], x[1:], rtol=0, atol=2e-15 * np.max(np.abs(x[1:])))
