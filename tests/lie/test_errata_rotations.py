"""Where the printed formulas about rotations fail, and that what is implemented does not."""

import numpy as np
import pytest

from lietool.lie import quaternion, so3

PI = np.pi


def test_2_34_needs_theta_below_pi():
    """slerp(1, exp(theta u), t) = exp(t theta u): at theta = 4 slerp goes the other way round."""
    u, t, one = np.array([0.0, 0.0, 1.0]), 0.3, [1.0, 0, 0, 0]

    def gap(theta: float) -> float:
        arc = quaternion.slerp(one, quaternion.exp(theta * u), t)
        return float(np.linalg.norm(arc - quaternion.exp(t * theta * u)))

    assert all(gap(theta) < 1e-15 for theta in (0.0, 1e-9, 1.0, 3.0, 3.14))
    # The two points part at the rate of a full turn.
    assert gap(4.0) == pytest.approx(2 * np.sin(PI * t))
    assert gap(4.0) > 1.6


def test_7_6_lacks_a_one():
    """acos(tr R / 2) has no value at R = I; acos((tr R - 1) / 2) has, but loses half of the digits."""
    with np.errstate(invalid="ignore"):
        assert np.isnan(np.arccos(np.trace(np.eye(3)) / 2))
    R = so3.rotation("x", 2.0)
    assert abs(np.arccos(np.trace(R) / 2) - 2.0) > 0.3
    assert np.arccos((np.trace(R) - 1) / 2) == pytest.approx(2.0)
    for theta in (1e-9, PI - 1e-9):
        R = so3.rotation("x", theta)
        assert abs(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1)) - theta) > 5e-10
        assert np.linalg.norm(so3.log(R)) == pytest.approx(theta, rel=1e-15, abs=0)


def printed_algorithm_1(R: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Kaji-Ochiai, Algorithm 1, as printed, on vectors."""
    theta = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    length = np.linalg.norm(reference)
    if theta == PI:
        return PI / length * reference if length > 0 else np.array([0.0, 0.0, -PI])
    u = so3.vee(R - R.T) / (2 * np.sin(theta))
    if u @ reference < 0:
        u, theta = -u, -theta
    while length - theta > PI:
        theta += 2 * PI
    while theta - length > PI:
        theta -= 2 * PI
    return theta * u


def test_algorithm_1_at_a_half_turn_returns_another_rotation():
    R, reference = so3.rotation("x", PI), np.array([0.0, 0.0, 1.0])
    R = np.rint(R)
    np.testing.assert_allclose(so3.exp(printed_algorithm_1(R, reference)), so3.rotation("z", PI), atol=1e-15)
    x, _ = so3.log_near(R, reference)
    np.testing.assert_allclose(so3.exp(x), R, atol=1e-15)
    for sign in (1.0, -1.0):  # the nearer of the two
        np.testing.assert_allclose(so3.log_near(R, [sign, 0.2, 0])[0], [sign * PI, 0, 0], atol=1e-15)


def test_algorithm_1_divides_zero_by_zero_at_the_identity():
    reference = np.array([0.0, 6.0, 1.0])
    with np.errstate(invalid="ignore"):
        assert np.all(np.isnan(printed_algorithm_1(np.eye(3), reference)))
    x, distance = so3.log_near(np.eye(3), reference)
    np.testing.assert_allclose(x, 2 * PI * reference / np.linalg.norm(reference))
    assert distance == pytest.approx(2 * PI - np.linalg.norm(reference))


def test_algorithm_1_is_often_not_the_nearest():
    rng = np.random.default_rng(5)
    R, reference = so3.exp(rng.normal(size=(400, 3))), rng.normal(size=(400, 3)) * 8
    nearest, distance = so3.log_near(R, reference)
    printed = np.array([printed_algorithm_1(Ri, Xi) for Ri, Xi in zip(R, reference, strict=True)])
    printed_distance = np.linalg.norm(printed - reference, axis=-1)
    np.testing.assert_allclose(so3.exp(nearest), R, atol=1e-13)
    assert np.all(distance <= printed_distance + 1e-10)
    assert np.mean(printed_distance > distance + 1e-6) > 0.4


def test_sign_near_pi_needs_the_whole_vector():
    """Kaji-Ochiai (8): the sign from one component fails where that component of the axis is 0."""
    x = (PI - 0.01) * np.array([-1.0, 0.0, 0.0])
    R = so3.exp(x)
    v = np.array([1.0, 0.0, 0.0])  # an eigenvector, as good as -v
    sign = 1.0 if v[1] * (R - R.T)[0, 2] >= 0 else -1.0
    assert np.linalg.norm(sign * (PI - 0.01) * v - x) > 6
    np.testing.assert_allclose(so3.log(R), x, atol=2e-15)


def test_no_continuous_logarithm_through_a_full_turn():
    """A full turn about x, then one about y: the logarithm jumps by 2 pi where the path passes I."""
    s = np.linspace(0, 1, 201)
    path = np.concatenate([so3.rotation("x", 2 * PI * s), so3.rotation("y", s[1:])])
    x, worst = np.zeros(3), 0.0
    for R in path:
        x, step = so3.log_near(R, x)
        worst = max(worst, float(step))
    assert worst == pytest.approx(2 * PI, abs=0.04)
