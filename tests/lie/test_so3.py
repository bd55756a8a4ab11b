"""Rotations of space against 50 digits, against other libraries, and the logarithm nearest to a reference."""

import mpmath
import numpy as np
import pytest
from pytransform3d import rotations as pr
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from lietool.lie import axis_angle, series, so3

EPS = 2.0**-52
PI = np.pi


def hard_axes() -> np.ndarray:
    rng = np.random.default_rng(11)
    u = [*rng.normal(size=(12, 3)), *np.eye(3), *-np.eye(3)]
    u += [
        (1, 1, 0),
        (1, 1e-8, 0),
        (1e-9, 1, 1e-9),
        (1, -1, 1),
        (1e-16, 1, -1),
        (1, 1, 1e-200),
        (-1, 1e-12, 1),
    ]
    u = np.array(u, dtype=float)
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


ANGLES = [1e-300, 1e-160, 1e-20, 1e-15, 1e-9, 1e-8, 1e-4, 0.1, 0.5, 1.0, 1.6, 2.0, 2.1, 2.5, 3.0]
ANGLES += [PI - d for d in (1e-3, 1e-6, 1e-8, 1e-12, 1e-15, 4.5e-16, 0.0)]


def exact_exp(x: np.ndarray) -> mpmath.matrix:
    x = [mpmath.mpf(float(v)) for v in x]
    theta = mpmath.sqrt(sum(v * v for v in x))
    X = mpmath.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    return mpmath.eye(3) + mpmath.sin(theta) / theta * X + 2 * (mpmath.sin(theta / 2) / theta) ** 2 * X * X


def exact_jacobian(x: np.ndarray) -> mpmath.matrix:
    x = [mpmath.mpf(float(v)) for v in x]
    t = mpmath.sqrt(sum(v * v for v in x))
    X = mpmath.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    return mpmath.eye(3) + 2 * (mpmath.sin(t / 2) / t) ** 2 * X + (t - mpmath.sin(t)) / t**3 * X * X


def norm(x) -> mpmath.mpf:
    return mpmath.sqrt(sum(mpmath.mpf(v) ** 2 for v in x))


def rounded(M: mpmath.matrix) -> np.ndarray:
    return np.array([[float(M[i, j]) for j in range(3)] for i in range(3)])


def error(value: np.ndarray, exact: mpmath.matrix) -> float:
    return float(max(abs(mpmath.mpf(float(value[i, j])) - exact[i, j]) for i in range(3) for j in range(3)))


@pytest.mark.parametrize("theta", ANGLES)
def test_exp_and_log_to_a_few_ulp(theta):
    for x in theta * hard_axes():
        with mpmath.workdps(50):
            exact = exact_exp(x)
            assert error(so3.exp(x), exact) <= 1e-15
            # The rounded matrix may have lost the sign of the axis at a half turn.
            y = so3.log(rounded(exact))
            signs = (1, -1) if theta > PI - 2e-15 else (1,)
            given = [mpmath.mpf(float(v)) for v in x]
            gaps = [
                norm([mpmath.mpf(float(v)) - s * g for v, g in zip(y, given, strict=True)]) for s in signs
            ]
            assert min(gaps) <= 1e-15 * norm(given)


@pytest.mark.parametrize("theta", [1e-15, 1e-9, 1e-5, 1e-3, 0.1])
def test_small_rotations_keep_their_relative_accuracy(theta):
    for x in theta * hard_axes():
        with mpmath.workdps(50):
            exact = exact_exp(x)
            R = so3.exp(x)
            for i, j in ((0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)):
                assert abs(mpmath.mpf(float(R[i, j])) - exact[i, j]) <= 3 * EPS * theta


@pytest.mark.parametrize("theta", [1e-9, 1e-4, 0.5, 1.6, 2.0, 3.0, PI, 4.0, 6.0])
def test_jacobians_to_a_few_ulp(theta):
    for x in theta * hard_axes()[::3]:
        with mpmath.workdps(70):
            exact = exact_jacobian(x)
            inverse = exact**-1
            assert error(so3.left_jacobian(x), exact) <= 1e-15
            scale = float(max(abs(v) for v in inverse))
            assert error(so3.left_jacobian_inverse(x), inverse) <= 2e-15 * scale**2


def test_exp_is_the_series_and_rodrigues_formula():
    """(2.15), (4.7), (7.4), (A.4), (A.5), Kaji-Ochiai (4)."""
    x = np.random.default_rng(2).normal(size=(20, 3))
    theta = np.linalg.norm(x, axis=-1)[:, None, None]
    X = so3.hat(x)
    R = so3.exp(x)
    for i in range(len(x)):
        np.testing.assert_allclose(R[i], expm(X[i]), atol=1e-14)
    half = series.sinc(theta / 2)
    by_4 = np.eye(3) + series.sinc(theta) * X + half**2 / 2 * X @ X
    np.testing.assert_allclose(R, by_4, atol=2e-15)
    u = x[..., None] / theta
    by_215 = (
        np.eye(3) + np.sin(theta) * X / theta + (1 - np.cos(theta)) * (u @ np.swapaxes(u, -1, -2) - np.eye(3))
    )
    np.testing.assert_allclose(R, by_215, atol=2e-15)
    p = np.random.default_rng(3).normal(size=(20, 3))
    c, s, v = np.cos(theta[..., 0]), np.sin(theta[..., 0]), u[..., 0]
    along = np.sum(v * p, axis=-1, keepdims=True) * v
    cross = np.cross(v, p)
    for printed in (
        c * p + s * cross + (1 - c) * along,
        p - (1 - c) * (p - along) + s * cross,
    ):  # (2.14), (A.3)
        np.testing.assert_allclose(so3.act(R, p), printed, atol=4e-15)
    np.testing.assert_allclose(
        so3.act(R, p), along + c * (p - along) + s * cross, atol=4e-15
    )  # (A.1) corrected
    assert (
        np.max(np.abs(so3.act(R, p) - (np.sum(v * p, -1, keepdims=True) + c * (p - along) + s * cross))) > 0.1
    )


def test_rotation_in_a_frame_of_its_axis():
    """(2.16) to (2.19)."""
    rng = np.random.default_rng(4)
    F = so3.exp(rng.normal(size=(10, 3)))
    theta = rng.uniform(-3, 3, size=10)
    R = so3.from_axis_angle(F[..., 0], theta)
    np.testing.assert_allclose(R, F @ so3.rotation("x", theta) @ so3.inverse(F), atol=2e-15)
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    np.testing.assert_allclose(so3.act(R, F[..., 0]), F[..., 0], atol=1e-15)
    np.testing.assert_allclose(so3.act(R, F[..., 1]), c * F[..., 1] + s * F[..., 2], atol=2e-15)
    np.testing.assert_allclose(so3.act(R, F[..., 2]), c * F[..., 2] - s * F[..., 1], atol=2e-15)


def test_same_as_other_libraries():
    x = np.random.default_rng(5).normal(size=(200, 3))
    R = so3.exp(x)
    np.testing.assert_allclose(R, Rotation.from_rotvec(x).as_matrix(), atol=2e-15)
    np.testing.assert_allclose(so3.log(R), Rotation.from_matrix(R).as_rotvec(), atol=4e-15)
    for xi, Ri in zip(x[:20], R, strict=False):
        np.testing.assert_allclose(Ri, pr.matrix_from_compact_axis_angle(xi), atol=4e-15)
        np.testing.assert_allclose(so3.hat(xi), pr.cross_product_matrix(xi))


@pytest.mark.parametrize("name", axis_angle.AXES)
def test_elementary_rotations(name):
    theta = np.linspace(-7, 7, 29)
    u = np.eye(3)[axis_angle.AXES.index(name)]
    np.testing.assert_allclose(so3.rotation(name, theta), so3.from_axis_angle(u, theta), atol=4e-15)
    assert so3.rotation(name, PI / 2) @ np.roll(u, 1) == pytest.approx(np.roll(u, 2), abs=1e-15)


def test_axis_and_angle_come_back():
    u = hard_axes()
    for theta in (1e-300, 1e-160, 1e-9, 0.3, 2.0, 3.1):
        v, angle = so3.to_axis_angle(so3.from_axis_angle(u, theta))
        np.testing.assert_allclose(v, u, atol=1e-15 / min(theta, 1) if theta > 1e-3 else 1e-15)
        np.testing.assert_allclose(angle, theta, rtol=2e-15)
    v, angle = so3.to_axis_angle(np.eye(3))
    assert np.array_equal(v, [1, 0, 0])
    assert angle == 0


def test_half_turns_have_a_positive_largest_component():
    for u in hard_axes():
        x = so3.log(2 * np.outer(u, u) - np.eye(3))
        assert abs(np.linalg.norm(x) - PI) < 1e-15 * PI
        assert abs(abs(x @ u) - PI) < 4e-15
        assert np.max(x) >= np.max(np.abs(x)) - 1e-14  # of equally large ones, one


def brute_force(R: np.ndarray, reference: np.ndarray) -> float:
    """Return the smallest distance to a logarithm, by trying the branches."""
    x = so3.log(R)
    theta = np.linalg.norm(x)
    if theta == 0:
        length = np.linalg.norm(reference)
        return min(abs(length - 2 * PI * n) for n in range(40))
    u = x / theta
    return min(np.linalg.norm((theta + 2 * PI * k) * u - reference) for k in range(-40, 41))


def test_log_near_is_the_nearest_of_all_branches():
    rng = np.random.default_rng(6)
    half = [2 * np.outer(u, u) - np.eye(3) for u in hard_axes()]
    R = np.array([*so3.exp(2 * rng.normal(size=(200, 3))), *half, *[np.eye(3)] * 20])
    reference = rng.normal(size=(len(R), 3)) * rng.choice([0.1, 3.0, 30.0], size=(len(R), 1))
    x, distance = so3.log_near(R, reference)
    np.testing.assert_allclose(so3.exp(x), R, atol=1e-13)
    np.testing.assert_allclose(distance, np.linalg.norm(x - reference, axis=-1))
    for Ri, ri, d in zip(R, reference, distance, strict=True):
        assert d == pytest.approx(brute_force(Ri, ri), abs=1e-12)


def test_log_near_gives_back_a_long_logarithm():
    u = hard_axes()
    for theta in (0.0, 1.0, PI, 5.0, 2 * PI, 9.0, 4 * PI, 31.0):
        x, distance = so3.log_near(so3.exp(theta * u), theta * u)
        np.testing.assert_allclose(x, theta * u, atol=4e-15 * max(theta, 1))
        assert np.all(distance <= 1e-13)


def test_log_near_follows_a_product_through_the_identity():
    """Rounded products miss the identity by a few ulp, about some axis; that must not lose the branch."""
    u = hard_axes()
    half = so3.exp(PI * u)
    x, _ = so3.log_near(half @ half, 2 * PI * u)
    np.testing.assert_allclose(x, 2 * PI * u, atol=1e-14)


def test_log_near_of_two_equally_near_takes_the_shorter():
    x, distance = so3.log_near(np.eye(3), [PI, 0, 0])
    assert np.array_equal(x, [0, 0, 0])
    assert distance == PI
    x, distance = so3.log_near(so3.rotation("x", PI), [0.0, 1.0, 0.0])
    assert np.linalg.norm(x) == pytest.approx(PI)
    x, _ = so3.log_near(np.eye(3), [0, 0, 0])
    assert np.array_equal(x, [0, 0, 0])


def test_left_jacobian_inverse_refuses_the_spheres_where_there_is_none():
    x = np.array([[1.0, 0, 0], [0, 2 * PI, 0], [0, 0, 0]])
    with pytest.raises(
        ValueError, match=r"^so3\.left_jacobian_inverse: x must not be|x must be not of length"
    ):
        so3.left_jacobian_inverse(x)
    assert np.linalg.svd(so3.left_jacobian(x[1]), compute_uv=False)[-1] < 1e-15
