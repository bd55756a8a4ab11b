"""Dual quaternions: the algebra, screws, the double cover of SE(3), blending along screws."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytransform3d import transformations as pt

from lietool.lie import dual_quaternion, quaternion, se3, so3

PI = np.pi
ONE = np.eye(8)[0]
EPS = 2.0**-52
LENGTHS = {"ordinary": 1.3, "tiny": 1e-9, "near pi": PI - 1e-9, "zero": 0.0, "beyond": 2.8}
BATCHES = [(), (4,), (2, 3)]
exp, log, times = dual_quaternion.exp, dual_quaternion.log, dual_quaternion.multiply

each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_length = pytest.mark.parametrize("length", LENGTHS.values(), ids=LENGTHS.keys())


def algebra(batch, length: float, seed: int = 0) -> np.ndarray:
    """Sample a + b eps with |a| = length / 2, so that space turns by the length."""
    x = np.random.default_rng(seed).normal(size=(*batch, 6))
    x[..., :3] *= 0.5 * length / np.linalg.norm(x[..., :3], axis=-1, keepdims=True)
    return x


def any_numbers(*batch: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(*batch, 8))


@pytest.mark.equation("B 4.15")
def test_algebra_and_invertible_numbers():
    """Section 2.8 (i) and (ii): eps^2 = 0, associative, the matrices (z w; 0 z), inverses where z != 0."""
    q, p, r = any_numbers(3, 20)
    eps = np.eye(8)[4]
    assert not np.any(times(eps, eps))
    np.testing.assert_array_equal(times(eps, q), times(q, eps))
    np.testing.assert_allclose(times(times(q, p), r), times(q, times(p, r)), atol=4e-14)
    L = dual_quaternion.left_matrix
    np.testing.assert_allclose(L(times(q, p)), L(q) @ L(p), atol=4e-14)
    np.testing.assert_allclose((L(q) @ p[..., None])[..., 0], times(q, p), atol=1e-14)
    identity = np.broadcast_to(ONE, q.shape)
    size = np.max(np.abs(dual_quaternion.inverse(q)), axis=-1).max()
    np.testing.assert_allclose(times(q, dual_quaternion.inverse(q)), identity, atol=1e-15 * size**2)
    np.testing.assert_allclose(times(dual_quaternion.inverse(q), q), identity, atol=1e-15 * size**2)
    with pytest.raises(ValueError, match=r"^dual_quaternion\.inverse: q must be invertible.* index \(2,\)"):
        dual_quaternion.inverse(np.where(np.arange(20)[:, None] == 2, eps, q))


def test_conjugates_and_norm():
    q, p = any_numbers(2, 20, seed=1)
    bar, star, norm = dual_quaternion.conjugate, dual_quaternion.star, dual_quaternion.norm
    np.testing.assert_allclose(bar(times(q, p)), times(bar(p), bar(q)), atol=1e-14)
    np.testing.assert_allclose(star(times(q, p)), times(star(q), star(p)), atol=1e-14)
    np.testing.assert_array_equal(star(bar(q)), bar(star(q)))

    def dual(a, b):  # the product of dual numbers
        return np.stack([a[..., 0] * b[..., 0], a[..., 0] * b[..., 1] + a[..., 1] * b[..., 0]], axis=-1)

    np.testing.assert_allclose(norm(times(q, p)), dual(norm(q), norm(p)), rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(times(q, bar(q))[..., [0, 4]], dual(norm(q), norm(q)), rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(times(q, bar(q))[..., [1, 2, 3, 5, 6, 7]], 0, atol=1e-14)


@pytest.mark.equation("B 4.16")
@pytest.mark.parametrize("scale", [1e-140, 1e-100, 1.0, 1e140])
def test_normalize_gives_the_unit_ones_and_splits_off_the_norm(scale):
    q = any_numbers(20, seed=2)
    unit = dual_quaternion.normalize(scale * q)
    np.testing.assert_allclose(np.linalg.norm(unit[:, :4], axis=-1), 1, atol=1e-15)
    size = np.max(np.abs(unit[:, 4:]), axis=-1)
    assert np.all(np.abs(np.sum(unit[:, :4] * unit[:, 4:], axis=-1)) <= 4e-16 * np.maximum(1, size))
    length = np.zeros((20, 8))
    length[:, [0, 4]] = dual_quaternion.norm(q)
    np.testing.assert_allclose(times(length, unit), q, atol=4e-15)
    np.testing.assert_allclose(dual_quaternion.inverse(unit), dual_quaternion.conjugate(unit), atol=1e-14)


@pytest.mark.erratum("B 2.8")
def test_one_plus_w_eps_translates_by_twice_w():
    w, p = np.array([0.3, -1.0, 2.0]), np.array([5.0, 0.5, -4.0])
    q = np.concatenate([ONE[:4], [0], w])
    np.testing.assert_array_equal(dual_quaternion.act(q, p), p + 2 * w)
    printed = p + w
    assert np.linalg.norm(dual_quaternion.act(q, p) - printed) == pytest.approx(np.linalg.norm(w))
    half = dual_quaternion.from_rotation_translation(ONE[:4], w)
    np.testing.assert_array_equal(dual_quaternion.act(half, p), printed)


@each_batch
@each_length
def test_action_is_the_sandwich_and_that_of_the_matrix(batch, length):
    """Section 2.8: 1 + p eps -> q (1 + p eps) q_bar*."""
    q = exp(algebra(batch, length, 3))
    p = np.random.default_rng(4).normal(size=(*batch, 3))
    point = np.zeros((*batch, 8))
    point[..., 0], point[..., 5:] = 1, p
    moved = times(times(q, point), dual_quaternion.conjugate(dual_quaternion.star(q)))
    np.testing.assert_allclose(moved[..., 5:], dual_quaternion.act(q, p), atol=1e-14)
    np.testing.assert_allclose(moved[..., :5], np.broadcast_to(ONE[:5], (*batch, 5)), atol=2e-15)
    A = dual_quaternion.to_matrix(q)
    np.testing.assert_allclose(
        A[..., :3, :3] @ p[..., None] + A[..., :3, 3:], moved[..., 5:, None], atol=1e-14
    )


@each_batch
@each_length
def test_two_to_one_onto_rigid_motions(batch, length):
    q, p = exp(algebra(batch, length, 5)), exp(algebra(batch, 1.7, 6))
    A = dual_quaternion.to_matrix(q)
    np.testing.assert_array_equal(dual_quaternion.to_matrix(-q), A)
    np.testing.assert_allclose(
        dual_quaternion.to_matrix(times(q, p)), A @ dual_quaternion.to_matrix(p), atol=1e-14
    )
    back = dual_quaternion.from_matrix(A)
    np.testing.assert_allclose(back, dual_quaternion.align(q, back), atol=4e-15)
    np.testing.assert_allclose(dual_quaternion.to_matrix(back), A, atol=4e-15)
    r, t = dual_quaternion.to_rotation_translation(q)
    np.testing.assert_allclose(dual_quaternion.from_rotation_translation(r, t), q, atol=4e-15)
    np.testing.assert_allclose(A[..., :3, :3], quaternion.to_matrix(r), atol=1e-15)
    np.testing.assert_allclose(A[..., :3, 3], t, atol=1e-15)


@each_batch
@each_length
def test_exp_and_log(batch, length):
    x = algebra(batch, length, 7)
    q = exp(x)
    np.testing.assert_allclose(dual_quaternion.to_matrix(q), se3.exp(2 * x), atol=4e-15)
    np.testing.assert_allclose(log(q), x, rtol=0, atol=4e-15)
    np.testing.assert_allclose(exp(log(q)), q, rtol=0, atol=4e-15)
    np.testing.assert_allclose(exp(-x), dual_quaternion.conjugate(q), atol=1e-15)
    np.testing.assert_allclose(exp(1.7 * x), times(exp(0.6 * x), exp(1.1 * x)), atol=8e-15)


def exact_exp(x) -> list:
    """Sum the series of exp(a + b eps) = sum (a + b eps)^n / n!, by the two recursions that it is."""
    a, b = ([mpmath.mpf(float(v)) for v in part] for part in (x[:3], x[3:]))
    theta = mpmath.sqrt(mpmath.fsum(v * v for v in a))
    ab = mpmath.fsum(u * v for u, v in zip(a, b, strict=True))
    if theta == 0:
        return [mpmath.mpf(1), *a, mpmath.mpf(0), *b]
    s = mpmath.sin(theta) / theta
    slope = (mpmath.cos(theta) - s) / theta**2
    dual = [s * v + slope * ab * u for u, v in zip(a, b, strict=True)]
    return [mpmath.cos(theta), *(s * v for v in a), -s * ab, *dual]


def error(value, exact) -> float:
    return float(max(abs(mpmath.mpf(float(v)) - e) for v, e in zip(value, exact, strict=True)))


ANGLES = [0, 1e-300, 1e-160, 1e-12, 1e-8, 1e-5, 0.3, 0.999, 1, PI / 2, 2, 3]
CLOSE = [PI - 1e-3, PI - 1e-8, PI - 1e-12, PI - 1e-15]


@pytest.mark.parametrize("angle", ANGLES + CLOSE)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e9])
def test_exp_and_log_against_fifty_digits(angle, size):
    x = algebra((6,), 2 * angle, 8)
    x[:, 3:] *= size
    with mpmath.workdps(50):
        for xi, q, back in zip(x, exp(x), log(exp(x)), strict=True):
            exact, b = exact_exp(xi), np.max(np.abs(xi[3:]))
            assert error(q[:4], exact[:4]) <= 3 * EPS
            assert error(q[4:], exact[4:]) <= 4 * EPS * b
            # Of a rounded q the axis is known to EPS / sin(angle), and so is what depends on it.
            again = exact_exp(back)
            assert error(q[:4], again[:4]) <= 6 * EPS
            assert error(q[4:], again[4:]) <= 12 * EPS * b
            if angle <= 2:
                np.testing.assert_allclose(back[:3], xi[:3], rtol=0, atol=4 * EPS * angle)
                np.testing.assert_allclose(back[3:], xi[3:], rtol=0, atol=12 * EPS * b)


def test_every_unit_dual_quaternion_has_a_logarithm():
    for w in ([0.0, 0.0, 0.0], [0.0, 3.0, -4.0], [1e-200, 0.0, 0.0]):
        q = np.concatenate([-ONE[:4], [0.0], w])
        x = log(q)
        assert np.linalg.norm(x[:3]) == pytest.approx(PI, rel=1e-15)
        np.testing.assert_allclose(exp(x), q, atol=2e-15)
    # Beside -1 the axis lies far away: one ulp of the angle, EPS 2, moves it by EPS 2 / gap of its distance.
    for gap in (1e-3, 1e-6, 1e-9):
        almost = np.array([-np.cos(gap), np.sin(gap), 0, 0, 0, 0, 0.5, 0])
        np.testing.assert_allclose(exp(log(almost)), almost, rtol=0, atol=2 * EPS / gap)


def test_screws():
    """A turn by theta about the axis p + R u, and a slide by d along it."""
    rng = np.random.default_rng(9)
    u = rng.normal(size=(30, 3))
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    p, d, theta = rng.normal(size=(30, 3)), rng.normal(size=30), rng.uniform(0.1, 6.0, 30)
    q = dual_quaternion.from_screw(u, p, theta, d)
    np.testing.assert_allclose(dual_quaternion.act(q, p), p + d[:, None] * u, atol=4e-15)
    np.testing.assert_allclose(quaternion.to_matrix(q[:, :4]), so3.from_axis_angle(u, theta), atol=4e-15)
    v, foot, turn, slide = dual_quaternion.to_screw(q)
    np.testing.assert_allclose(v, u, atol=4e-14)
    np.testing.assert_allclose(foot, p - np.sum(p * u, axis=-1, keepdims=True) * u, atol=2e-13)
    np.testing.assert_allclose(turn, theta, atol=4e-15)
    np.testing.assert_allclose(slide, d, atol=4e-14)
    _, _, rest, back = dual_quaternion.to_screw(-q)
    np.testing.assert_allclose(rest, 2 * PI - theta, atol=4e-15)
    np.testing.assert_allclose(back, -d, atol=4e-14)


def test_screw_of_a_translation_and_of_nothing():
    t = np.array([0.0, 3.0, 4.0])
    q = dual_quaternion.from_rotation_translation(ONE[:4], t)
    u, p, theta, d = dual_quaternion.to_screw(q)
    np.testing.assert_allclose(u, t / 5, rtol=1e-15)
    assert (theta, d) == (0, pytest.approx(5, rel=1e-15)) and not np.any(p)
    u, p, theta, d = dual_quaternion.to_screw(ONE)
    np.testing.assert_array_equal(u, [1, 0, 0])
    assert (theta, d) == (0, 0) and not np.any(p)


def test_same_as_pytransform3d():
    x, y = algebra((20,), 2.0, 10), algebra((20,), 2.5, 11)
    for a, b in zip(exp(x), exp(y), strict=True):
        b = dual_quaternion.align(b, a)
        np.testing.assert_allclose(times(a, b), pt.concatenate_dual_quaternions(a, b), atol=1e-14)
        np.testing.assert_allclose(
            dual_quaternion.to_matrix(a), pt.transform_from_dual_quaternion(a), atol=4e-15
        )
        for t in (0.0, 0.3, 1.0, 1.6):
            theirs = pt.dual_quaternion_sclerp(a, b, t)
            np.testing.assert_allclose(dual_quaternion.sclerp(a, b, t), theirs, atol=2e-14)


@each_batch
def test_sclerp_is_a_screw_at_constant_speed(batch):
    """(2.33) with dual numbers: ends, reversal, invariance from both sides, no silent shortest way."""
    q0, q1, h = (exp(algebra(batch, 2.2, seed)) for seed in (12, 13, 14))
    sclerp = dual_quaternion.sclerp
    np.testing.assert_allclose(sclerp(q0, q1, 0.0), q0, atol=1e-15)
    np.testing.assert_allclose(sclerp(q0, q1, 1.0), q1, atol=4e-15)
    for t in (-0.4, 0.3, 1.9):
        middle = sclerp(q0, q1, t)
        np.testing.assert_allclose(middle, sclerp(q1, q0, 1 - t), atol=2e-14)
        np.testing.assert_allclose(times(h, middle), sclerp(times(h, q0), times(h, q1), t), atol=4e-14)
        np.testing.assert_allclose(times(middle, h), sclerp(times(q0, h), times(q1, h), t), atol=4e-14)
        np.testing.assert_allclose(middle[..., :4], quaternion.slerp(q0[..., :4], q1[..., :4], t), atol=4e-15)
        step = times(dual_quaternion.conjugate(q0), middle)
        whole = log(times(dual_quaternion.conjugate(q0), q1))
        np.testing.assert_allclose(step, exp(t * whole), atol=2e-14)


def test_sclerp_goes_the_long_way_if_told_to():
    q1 = dual_quaternion.from_screw([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 1.5 * PI, 0.0)
    long = dual_quaternion.to_screw(dual_quaternion.sclerp(ONE, q1, 0.5))
    short = dual_quaternion.to_screw(dual_quaternion.sclerp(ONE, dual_quaternion.align(q1, ONE), 0.5))
    assert long[2] == pytest.approx(0.75 * PI) and short[2] == pytest.approx(0.25 * PI)
    np.testing.assert_allclose(long[0], -short[0], atol=1e-15)
    with pytest.raises(
        ValueError, match=r"^dual_quaternion\.sclerp: q1 must be different from -q0 .*index \(1,\)"
    ):
        dual_quaternion.sclerp(ONE, [q1, -ONE], 0.5)


@pytest.mark.parametrize("gap", [1e-3, 1e-8, 1e-12])
def test_sclerp_of_near_neighbours_keeps_the_digits_of_what_lies_between(gap):
    """The step is computed from the difference, which is exact; one from the product would be off by EPS."""
    q0 = exp(algebra((20,), 1.1, 15))
    near = times(q0, exp(gap * algebra((20,), 1.0, 16)))
    whole, half = near - q0, dual_quaternion.sclerp(q0, near, 0.5) - q0
    np.testing.assert_allclose(half, 0.5 * whole, rtol=0, atol=gap**2 + 2 * EPS * np.max(np.abs(q0)))


def test_align():
    q = exp(algebra((40,), 1.0, 17)) * np.random.default_rng(18).choice([-1, 1], 40)[:, None]
    aligned = dual_quaternion.align(q, ONE)
    assert np.all(aligned[:, 0] > 0) and np.array_equal(np.abs(aligned), np.abs(q))
    np.testing.assert_array_equal(dual_quaternion.to_matrix(aligned), dual_quaternion.to_matrix(q))


@each_batch
@each_length
def test_linear_blending_is_bi_invariant(batch, length):
    rng = np.random.default_rng(19)
    q = exp(algebra((*batch, 4), length, 20))
    w = rng.uniform(0.1, 1, size=(*batch, 4))
    w /= np.sum(w, axis=-1, keepdims=True)
    g, h = exp(algebra((), 2.9, 21)), exp(algebra((), 2.1, 22))
    dlb = dual_quaternion.dlb
    blend = dlb(w, q)
    moved = dlb(w, times(times(g, q), h))
    np.testing.assert_allclose(
        dual_quaternion.to_matrix(moved), dual_quaternion.to_matrix(times(times(g, blend), h)), atol=4e-14
    )
    np.testing.assert_allclose(dlb(7.0 * w, q), blend, atol=4e-15)
    signs = rng.choice([-1.0, 1.0], size=(*batch, 3, 1))
    flipped = np.concatenate([q[..., :1, :], signs * q[..., 1:, :]], axis=-2)
    np.testing.assert_allclose(dlb(w, flipped), blend, atol=1e-15)
    one_hot = dlb(np.eye(4)[2], q)
    np.testing.assert_allclose(one_hot, dual_quaternion.align(q[..., 2, :], q[..., 0, :]), atol=2e-15)


def test_linear_blending_of_two_runs_along_the_screw_but_not_evenly():
    q0, q1 = ONE, dual_quaternion.from_screw([0.6, 0.0, 0.8], [1.0, 2.0, 0.0], 2.0, 0.7)
    axis = dual_quaternion.to_screw(q1)
    for t in (0.2, 0.5, 0.8):
        u, _, turn, slide = dual_quaternion.to_screw(dual_quaternion.dlb([1 - t, t], [q0, q1]))
        np.testing.assert_allclose(u, axis[0], atol=1e-14)
        even = np.array([turn / 2.0, slide / 0.7])
        assert np.max(np.abs(even - t)) < 0.06
        if t == 0.5:
            np.testing.assert_allclose(even, t, atol=1e-15)
        else:
            assert np.min(np.abs(even - t)) > 1e-3


def test_linear_blending_says_when_it_cannot():
    i, j = np.eye(8)[1], np.eye(8)[2]
    with pytest.raises(
        ValueError, match=r"^dual_quaternion\.dlb: weights must be such that the sum.*index \(1,\)"
    ):
        dual_quaternion.dlb([[1.0, 1.0, 0.0], [0.0, 0.5, 0.5]], [ONE, i, -i + 0 * j])
    with pytest.raises(
        ValueError, match=r"^dual_quaternion\.dlb: q must be a unit dual quaternion.*index \(1,\)"
    ):
        dual_quaternion.dlb([0.5, 0.5], [ONE, ONE + 0.1 * np.eye(8)[4]])
    with pytest.raises(ValueError, match=r"^dual_quaternion\.dlb: q must be an array of shape .*k >= 1; got"):
        dual_quaternion.dlb(0.5, ONE)


coordinates = st.floats(-2.0, 2.0, allow_nan=False)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.lists(coordinates, min_size=6, max_size=6), st.sampled_from([1.0, 1e-5, 1e-12, 1e-200]))
def test_whatever_hypothesis_finds(x, scale):
    x = np.array(x) * np.repeat([scale, 1.0], 3)
    q = exp(x)
    np.testing.assert_allclose(exp(log(q)), q, rtol=0, atol=1e-14)
    np.testing.assert_allclose(dual_quaternion.to_matrix(q), se3.exp(2 * x), atol=1e-14)
    if np.linalg.norm(x[:3]) < 3:
        np.testing.assert_allclose(log(q)[:3], x[:3], rtol=0, atol=1e-14 * max(scale, 1e-300))
