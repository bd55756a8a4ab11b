"""Euler angles in all twelve conventions: (2.21) to (2.23), lock, and the Jacobian."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool.lie import euler, so3

PI = np.pi
each = pytest.mark.parametrize("convention", euler.CONVENTIONS)


def angles(convention: str, n: int = 200) -> np.ndarray:
    rng = np.random.default_rng(1)
    low, high = (0, PI) if convention in euler.PROPER else (-PI / 2, PI / 2)
    t = rng.uniform(-PI, PI, size=(n, 3))
    t[:, 1] = rng.uniform(low + 0.05, high - 0.05, size=n)
    return t


def lock(convention: str) -> tuple[float, float]:
    return (0.0, PI) if convention in euler.PROPER else (-PI / 2, PI / 2)


def test_twelve_conventions_are_all_there_are():
    letters = "xyz"
    assert set(euler.CONVENTIONS) == {
        a + b + c for a in letters for b in letters for c in letters if a != b != c
    }
    assert len(euler.CONVENTIONS) == 12


def test_the_two_of_the_book():
    """(2.21) and (2.23)."""
    t1, t2, t3 = t = np.array([0.3, -0.8, 1.9])
    x, y, z = so3.AXES
    by_221 = so3.rotation(z, t3) @ so3.rotation(y, t2) @ so3.rotation(x, t1)
    by_223 = so3.rotation(x, t3) @ so3.rotation(y, t2) @ so3.rotation(x, t1)
    assert np.array_equal(euler.to_matrix(t, "xyz"), by_221)
    assert np.array_equal(euler.to_matrix(t, "xyx"), by_223)


@each
def test_there_and_back(convention):
    t = angles(convention)
    R = euler.to_matrix(t, convention)
    np.testing.assert_allclose(euler.from_matrix(R, convention), t, atol=1e-14)


@each
def test_same_as_scipy(convention):
    t = angles(convention)
    np.testing.assert_allclose(
        euler.to_matrix(t, convention), Rotation.from_euler(convention, t).as_matrix(), atol=2e-15
    )
    R = so3.exp(np.random.default_rng(2).normal(size=(200, 3)))
    theirs = Rotation.from_matrix(R).as_euler(convention)
    np.testing.assert_allclose(euler.from_matrix(R, convention), theirs, atol=1e-12)


@each
@pytest.mark.parametrize("gap", [0.0, 1e-17, 1e-16, 4e-16, 1e-15, 1e-12, 1e-8, 1e-4])
def test_every_rotation_comes_back_at_and_beside_lock(convention, gap):
    rng = np.random.default_rng(3)
    for locked, side in zip(lock(convention), (1, -1), strict=True):
        t = rng.uniform(-PI, PI, size=(40, 3))
        t[:, 1] = locked + side * gap
        R = euler.to_matrix(t, convention)
        back = euler.from_matrix(R, convention)
        np.testing.assert_allclose(euler.to_matrix(back, convention), R, atol=3e-15)
        low, high = lock(convention)
        assert np.all((back[:, 1] >= low) & (back[:, 1] <= high))
        assert np.all((back > -PI) | (back[:, 1:2] == low), axis=None)
        assert np.all(back <= PI)
        if gap == 0.0:
            np.testing.assert_array_equal(back[:, 2], 0)


@each
def test_special_rotations_come_back(convention):
    R = np.array([so3.rotation(a, s * k * PI / 2) for a in "xyz" for k in range(4) for s in (1, -1)])
    R = np.concatenate([R, np.rint(R)])
    back = euler.from_matrix(R, convention)
    np.testing.assert_allclose(euler.to_matrix(back, convention), R, atol=1e-15)
    assert np.array_equal(euler.from_matrix(np.eye(3), convention), [0, 0, 0])


@each
def test_jacobian_is_the_angular_velocity(convention):
    t, h = angles(convention, 20), 1e-5
    J = euler.jacobian(t, convention)
    for n, step in enumerate(h * np.eye(3)):
        ahead, behind = (euler.to_matrix(t + s * step, convention) for s in (1, -1))
        velocity = so3.log(ahead @ so3.inverse(behind)) / (2 * h)
        np.testing.assert_allclose(J[..., n], velocity, atol=1e-9)


@each
def test_axes_are_the_columns_and_turn_with_the_rings(convention):
    t = angles(convention, 20)
    u = euler.axes(t, convention)
    np.testing.assert_array_equal(np.swapaxes(u, -1, -2), euler.jacobian(t, convention))
    np.testing.assert_allclose(np.linalg.norm(u, axis=-1), 1, atol=1e-15)
    np.testing.assert_allclose(np.sum(u[:, 1] * u[:, 0], -1), 0, atol=1e-15)
    np.testing.assert_allclose(np.sum(u[:, 1] * u[:, 2], -1), 0, atol=1e-15)
    frames = euler.ring_frames(t, convention)
    np.testing.assert_array_equal(frames[:, 2], euler.to_matrix(t, convention))
    for n, frame in ((0, 2), (1, 1), (2, 0)):  # each axis is fixed in the ring it turns
        letter = so3.AXES.index(convention[n])
        np.testing.assert_allclose(frames[:, frame, :, letter], u[:, n], atol=1e-15)


@each
def test_singular_values(convention):
    t = angles(convention)
    svd = np.linalg.svd(euler.jacobian(t, convention), compute_uv=False)
    np.testing.assert_allclose(euler.singular_values(t, convention), svd, atol=2e-15)


@each
@pytest.mark.parametrize("gap", [1e-3, 1e-8, 1e-12])
def test_smallest_singular_value_is_accurate_beside_lock(convention, gap):
    """sqrt(1 - |cos|) would give 0 from a gap of 1e-8 on; the true value is gap / sqrt 2."""
    for locked in lock(convention):
        for side in (1, -1):
            t2 = locked + side * gap
            true_gap = abs(
                t2 - locked - (np.sign(locked) * 6.123233995736766e-17 * (2 if locked == PI else 1))
            )
            value = euler.singular_values([0.4, t2, -1.0], convention)[2]
            assert value == pytest.approx(np.sqrt(2) * np.sin(true_gap / 2), rel=4e-15, abs=0)


@each
def test_lock_leaves_one_dimension(convention):
    for locked in lock(convention):
        J = euler.jacobian([0.3, locked, 1.1], convention)
        assert np.linalg.svd(J, compute_uv=False)[2] < 1e-15
        assert euler.singular_values([0.3, locked, 1.1], convention)[2] < 1e-15
        np.testing.assert_allclose(np.abs(J[:, 0] @ J[:, 2]), 1, atol=1e-15)


def test_2_22_relates_the_two_conventions():
    t = np.random.default_rng(4).uniform(-3, 3, size=(50, 3))
    theta = t[:, 0]
    y = so3.rotation("y", PI / 2)
    np.testing.assert_allclose(so3.rotation("z", theta) @ y, y @ so3.rotation("x", -theta), atol=1e-15)
    other = np.stack([t[:, 0], t[:, 1] - PI / 2, -t[:, 2]], axis=-1)
    np.testing.assert_allclose(euler.to_matrix(t, "xyz"), y @ euler.to_matrix(other, "xyx"), atol=2e-15)


def test_2_23_has_two_solutions_that_do_not_meet_at_zero():
    """R_z(theta) in the x-y-x convention: +-(-pi/2, theta, pi/2), and a jump as theta goes through 0."""
    theta = np.array([-3.0, -1.0, -1e-3, -1e-9, -1e-15, 1e-15, 1e-9, 1e-3, 1.0, 3.0])
    Rz = so3.rotation("z", theta)
    solution = np.stack([np.full_like(theta, -PI / 2), theta, np.full_like(theta, PI / 2)], axis=-1)
    np.testing.assert_allclose(euler.to_matrix(solution, "xyx"), Rz, atol=1e-15)
    np.testing.assert_allclose(euler.to_matrix(-solution, "xyx"), Rz, atol=1e-15)
    found = euler.from_matrix(Rz, "xyx")
    np.testing.assert_allclose(found, np.sign(theta)[:, None] * solution, atol=1e-15)
    assert found[4, 2] - found[5, 2] == pytest.approx(-PI)
    assert np.array_equal(euler.from_matrix(np.eye(3), "xyx"), [0, 0, 0])
