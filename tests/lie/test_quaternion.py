"""Quaternions: the algebra, the double cover, and interpolation on the sphere."""

import mpmath
import numpy as np
import pytest
from pytransform3d import rotations as pr
from scipy.spatial.transform import Rotation, Slerp

from lietool.lie import quaternion, so3

PI = np.pi
ONE, *IJK = np.eye(4)


def units(n: int, seed: int = 0) -> np.ndarray:
    return quaternion.normalize(np.random.default_rng(seed).normal(size=(n, 4)))


def test_multiplication_table():
    """Definition (i) of section 2.7."""
    times = quaternion.multiply
    i, j, k = IJK
    assert all(np.array_equal(times(e, e), -ONE) for e in IJK)
    for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
        assert np.array_equal(times(a, b), c)
        assert np.array_equal(times(b, a), -c)


def test_matrices_multiply_as_quaternions_do():
    """(2.24)."""
    q, p = np.random.default_rng(1).normal(size=(2, 30, 4))
    L = quaternion.left_matrix
    np.testing.assert_allclose(L(quaternion.multiply(q, p)), L(q) @ L(p), atol=1e-14)
    np.testing.assert_array_equal(L(q)[..., 0], q)
    np.testing.assert_array_equal(L(quaternion.conjugate(q)), np.swapaxes(L(q), -1, -2))
    np.testing.assert_allclose(np.linalg.det(L(q)), quaternion.norm(q) ** 4)


@pytest.mark.equation("B 2.37")
def test_complex_matrices_multiply_as_quaternions_do():
    """(2.37): q = z + w j, (z -w; w_bar z_bar), both ways; |q|^2 is the determinant."""
    q, p = np.random.default_rng(21).normal(size=(2, 30, 4))
    M = quaternion.to_complex_matrix
    z, w = q[:, 0] + 1j * q[:, 1], q[:, 2] + 1j * q[:, 3]
    printed = np.stack([z, -w, w.conj(), z.conj()], axis=-1).reshape(30, 2, 2)
    np.testing.assert_array_equal(M(q), printed)
    np.testing.assert_allclose(M(quaternion.multiply(q, p)), M(q) @ M(p), atol=1e-14)
    np.testing.assert_array_equal(M(quaternion.conjugate(q)), np.conj(np.swapaxes(M(q), -1, -2)))
    np.testing.assert_allclose(np.linalg.det(M(q)), quaternion.norm(q) ** 2)
    unit = M(quaternion.normalize(q))
    np.testing.assert_allclose(unit @ np.conj(np.swapaxes(unit, -1, -2)), np.eye(2) + 0 * unit, atol=1e-15)
    np.testing.assert_array_equal(quaternion.from_complex_matrix(M(q)), q)
    np.testing.assert_allclose(np.linalg.inv(M(q)), M(quaternion.inverse(q)), rtol=1e-13)
    i, j, k = IJK
    np.testing.assert_array_equal(M(i) @ M(j), M(k))


def test_complex_matrix_of_another_form_is_refused():
    M = quaternion.to_complex_matrix(np.ones((2, 3, 4)))
    M[1, 2, 0, 0] += 1e-3
    with pytest.raises(
        ValueError, match=r"^quaternion\.from_complex_matrix: M must be of the form .*\(1, 2\)"
    ):
        quaternion.from_complex_matrix(M)


def test_conjugate_norm_and_inverse():
    q, p = np.random.default_rng(2).normal(size=(2, 30, 4))
    times, norm = quaternion.multiply, quaternion.norm
    np.testing.assert_allclose(times(q, quaternion.conjugate(q)), norm(q)[:, None] ** 2 * ONE, atol=1e-14)
    np.testing.assert_allclose(norm(times(q, p)), norm(q) * norm(p))
    np.testing.assert_allclose(
        quaternion.conjugate(times(q, p)), times(quaternion.conjugate(p), quaternion.conjugate(q)), atol=1e-14
    )
    np.testing.assert_allclose(times(quaternion.inverse(q), q), np.broadcast_to(ONE, q.shape), atol=1e-15)
    real = times(p, quaternion.inverse(q))[..., 0] * norm(q) ** 2
    np.testing.assert_allclose(quaternion.dot(q, p), real, atol=1e-14)


@pytest.mark.parametrize("scale", [1e-149, 1e-100, 1.0, 1e149])
def test_norm_neither_overflows_nor_vanishes(scale):
    q = scale * np.array([1.0, 2.0, -2.0, 4.0])
    assert quaternion.norm(q) == pytest.approx(5 * scale, rel=1e-15, abs=0)
    assert quaternion.normalize(q) == pytest.approx(np.array([0.2, 0.4, -0.4, 0.8]), rel=1e-15, abs=0)
    assert quaternion.norm(np.zeros(4)) == 0


def test_two_to_one_onto_rotations():
    """(2.28) to (2.30), and (4.29), (4.30)."""
    q, p = units(200, 3), units(200, 4)
    R = quaternion.to_matrix(q)
    assert np.array_equal(quaternion.to_matrix(-q), R)
    np.testing.assert_allclose(quaternion.to_matrix(3.7 * q), R, atol=1e-15)
    np.testing.assert_allclose(
        quaternion.to_matrix(quaternion.multiply(q, p)), R @ quaternion.to_matrix(p), atol=2e-15
    )
    back = quaternion.from_matrix(R)
    assert np.all(back[:, 0] >= 0)
    np.testing.assert_allclose(back, np.where(q[:, :1] < 0, -q, q), atol=1e-15)
    for n in (1, 2, 3):
        x = 2 * n * PI * np.array([0.6, 0.0, 0.8])
        np.testing.assert_allclose(quaternion.exp(x / 2), (-1.0) ** n * ONE, atol=1e-14)
        np.testing.assert_allclose(so3.exp(x), np.eye(3), atol=1e-14)


def test_action_is_conjugation():
    """(2.27), (2.28)."""
    q = np.random.default_rng(5).normal(size=(50, 4))
    p = np.random.default_rng(6).normal(size=(50, 3))
    imaginary = np.concatenate([np.zeros((50, 1)), p], axis=-1)
    turned = quaternion.multiply(quaternion.multiply(q, imaginary), quaternion.inverse(q))
    np.testing.assert_allclose(turned[:, 0], 0, atol=1e-15)
    np.testing.assert_allclose(quaternion.act(q, p), turned[:, 1:], atol=4e-15)


def test_half_angle_for_rotations_and_none_for_exp():
    """(2.26) against (2.31)."""
    x = np.random.default_rng(7).normal(size=(50, 3))
    theta = np.linalg.norm(x, axis=-1)
    u = x / theta[:, None]
    np.testing.assert_allclose(
        quaternion.to_matrix(quaternion.from_axis_angle(u, theta)), so3.exp(x), atol=2e-15
    )
    np.testing.assert_allclose(quaternion.to_matrix(quaternion.exp(x)), so3.exp(2 * x), atol=4e-15)
    np.testing.assert_allclose(quaternion.exp(x)[:, 0], np.cos(theta), atol=1e-15)


def test_log_at_the_far_pole():
    np.testing.assert_array_equal(quaternion.log(-ONE), [PI, 0, 0])
    np.testing.assert_array_equal(quaternion.log(ONE), [0, 0, 0])
    almost = np.array([-1.0, 0.0, 1e-12, 0.0])
    np.testing.assert_allclose(quaternion.log(almost), [0, PI - 1e-12, 0], rtol=1e-15)


def test_same_as_other_libraries():
    q, p = units(20, 8), units(20, 9)
    xyzw = np.roll(q, -1, axis=-1)
    np.testing.assert_allclose(quaternion.to_matrix(q), Rotation.from_quat(xyzw).as_matrix(), atol=1e-15)
    for a, b in zip(q, p, strict=True):
        np.testing.assert_allclose(quaternion.multiply(a, b), pr.concatenate_quaternions(a, b), atol=1e-15)
        near = b if a @ b > 0 else -b  # SciPy goes the shorter way
        steps = Slerp([0, 1], Rotation.from_quat([np.roll(a, -1), np.roll(near, -1)]))([0.2, 0.7]).as_matrix()
        np.testing.assert_allclose(
            quaternion.to_matrix(quaternion.slerp(a, near, [0.2, 0.7])), steps, atol=4e-15
        )


def printed_slerp(q0, q1, t):
    """Evaluate (2.32) with 60 digits."""
    q0, q1 = ([mpmath.mpf(float(v)) for v in q] for q in (q0, q1))
    q0, q1 = ([v / mpmath.sqrt(sum(x * x for x in q)) for v in q] for q in (q0, q1))
    theta = mpmath.acos(sum(a * b for a, b in zip(q0, q1, strict=True)))
    if theta == 0:
        return q0
    s, t = mpmath.sin(theta), mpmath.mpf(float(t))
    return [
        mpmath.sin((1 - t) * theta) / s * a + mpmath.sin(t * theta) / s * b
        for a, b in zip(q0, q1, strict=True)
    ]


@pytest.mark.parametrize("theta", [0.0, 1e-200, 1e-9, 1e-8, 0.3, PI / 2, 1.6, 3.0, PI - 1e-4])
@pytest.mark.parametrize("t", [0.0, 1e-9, 0.25, 0.5, 1.0, -0.4, 1.7])
def test_slerp_is_2_32_to_a_few_ulp(theta, t):
    rng = np.random.default_rng(10)
    q0 = units(4, 11)
    x = rng.normal(size=(4, 3))
    q1 = quaternion.multiply(quaternion.exp(theta * x / np.linalg.norm(x, axis=-1, keepdims=True)), q0)
    value = quaternion.slerp(q0, q1, t)
    # The direction of the arc is what q0 and q1, rounded, still tell of it: 1 ulp / sin(theta).
    allowed = 1.5e-15 * max(1.0, 1.0 / max(np.sin(theta), 1e-4) if theta > 1.6 else 1.0)
    with mpmath.workdps(60):
        for a, b, v in zip(q0, q1, value, strict=True):
            exact = printed_slerp(a, b, t)
            assert max(abs(mpmath.mpf(float(c)) - e) for c, e in zip(v, exact, strict=True)) <= allowed
    np.testing.assert_allclose(quaternion.norm(value), 1, atol=2e-15)


def test_slerp_of_nearly_opposite_points_stays_on_the_sphere_at_even_speed():
    t = np.linspace(0, 1, 9)
    for gap in (1e-6, 1e-10, 1e-13):
        q1 = quaternion.normalize([-1.0, gap, -gap, 0.3 * gap])
        path = quaternion.slerp(ONE, q1, t)
        np.testing.assert_allclose(quaternion.norm(path), 1, atol=1e-15)
        np.testing.assert_allclose(path[:, 0], np.cos(t * np.linalg.norm(quaternion.log(q1))), atol=1e-15)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-8])
def test_slerp_of_nearly_opposite_points_keeps_the_plane_of_the_arc(gap):
    rng = np.random.default_rng(16)
    q0 = units(10, 17)
    q1 = quaternion.normalize(-q0 + gap * rng.normal(size=q0.shape))
    value = quaternion.slerp(q0, q1, 0.4)
    with mpmath.workdps(60):
        for a, b, v in zip(q0, q1, value, strict=True):
            exact = printed_slerp(a, b, 0.4)
            assert max(abs(mpmath.mpf(float(c)) - e) for c, e in zip(v, exact, strict=True)) <= 2e-15


def test_slerp_properties():
    """(2.33), (2.34), ends, reversal, constant speed, no silent shortest way."""
    q0, q1, h = units(30, 12), units(30, 13), units(30, 14)
    t = np.linspace(0, 1, 30)
    slerp, times = quaternion.slerp, quaternion.multiply
    np.testing.assert_array_equal(slerp(q0, q1, 0.0), q0)
    np.testing.assert_allclose(slerp(q0, q1, 1.0), q1, atol=1e-15)
    np.testing.assert_allclose(slerp(q0, q1, t), slerp(q1, q0, 1 - t), atol=3e-15)
    ratio = times(q1, quaternion.inverse(q0))
    np.testing.assert_allclose(slerp(q0, q1, t), times(slerp(ONE, ratio, t), q0), atol=3e-15)
    np.testing.assert_allclose(slerp(times(q0, h), times(q1, h), t), times(slerp(q0, q1, t), h), atol=4e-15)
    x = quaternion.log(q1)
    np.testing.assert_allclose(slerp(ONE, q1, t), quaternion.exp(t[:, None] * x), atol=3e-15)
    path = slerp(q0[0], q1[0], np.linspace(0, 1, 11))
    speed = np.linalg.norm(quaternion.log(times(path[1:], quaternion.conjugate(path[:-1]))), axis=-1)
    np.testing.assert_allclose(speed, speed[0], rtol=1e-14)
    long = quaternion.normalize(np.array([-1.0, 0.5, 0, 0]))
    assert 10 * speed[0] == pytest.approx(np.arccos(q0[0] @ q1[0]))
    assert np.linalg.norm(quaternion.log(slerp(ONE, long, 1.0))) > PI / 2


def test_nlerp_keeps_the_arc_but_not_the_speed():
    q0, q1 = ONE, quaternion.exp([0.0, 0.0, 1.4])
    t = np.linspace(0, 1, 11)
    path = quaternion.nlerp(q0, q1, t)
    np.testing.assert_allclose(quaternion.norm(path), 1, atol=1e-15)
    np.testing.assert_array_equal(path[:, 1:3], 0)
    np.testing.assert_allclose(path[5], quaternion.slerp(q0, q1, 0.5), atol=1e-15)
    assert np.max(np.abs(path - quaternion.slerp(q0, q1, t))) > 0.01


def test_opposite_points_have_no_arc():
    q0 = units(3, 15)
    q1 = q0.copy()
    q1[2] *= -1
    with pytest.raises(
        ValueError, match=r"^quaternion\.slerp: q1 must be different from -q0; .* index \(2,\)"
    ):
        quaternion.slerp(q0, q1, 0.3)
    with pytest.raises(
        ValueError, match=r"^quaternion\.nlerp: q1 must be different from -q0 .* index \(2,\)"
    ):
        quaternion.nlerp(q0, q1, 0.5)
