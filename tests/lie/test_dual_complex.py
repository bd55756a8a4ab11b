"""Anti-commutative dual complex numbers: (2.38) to (2.41), SE(2), and their place in the dual quaternions."""

import mpmath
import numpy as np
import pytest

from lietool.lie import dual_complex, dual_quaternion, se2

PI = np.pi
ONE, IMAGINARY, EPSILON = np.eye(4)[[0, 1, 2]]
LENGTHS = {"ordinary": 1.3, "tiny": 1e-9, "near pi": PI - 1e-9, "zero": 0.0, "beyond": 2.8}
BATCHES = [(), (4,), (2, 3)]
exp, log, times = dual_complex.exp, dual_complex.log, dual_complex.multiply

each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_length = pytest.mark.parametrize("length", LENGTHS.values(), ids=LENGTHS.keys())


def algebra(batch, length: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(*batch, 3))
    x[..., 0] = 0.5 * length * rng.choice([-1.0, 1.0], size=batch)
    return x


def any_numbers(*batch: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(*batch, 4))


def parts(p):
    return p[..., 0] + 1j * p[..., 1], p[..., 2] + 1j * p[..., 3]


@pytest.mark.equation("B 2.38")
def test_product():
    p, q = any_numbers(2, 20)
    (p0, p1), (q0, q1), (r0, r1) = parts(p), parts(q), parts(times(p, q))
    np.testing.assert_allclose(r0, p0 * q0, atol=1e-15)
    np.testing.assert_allclose(r1, p1 * np.conj(q0) + p0 * q1, atol=1e-15)
    assert not np.any(times(EPSILON, EPSILON))
    np.testing.assert_array_equal(times(EPSILON, IMAGINARY), -times(IMAGINARY, EPSILON))


@pytest.mark.equation("B 2.39", "B 2.40")
def test_conjugate_and_absolute_value():
    p, q = any_numbers(2, 20, seed=1)
    bar, norm = dual_complex.conjugate, dual_complex.norm
    np.testing.assert_allclose(bar(times(p, q)), times(bar(q), bar(p)), atol=1e-14)
    np.testing.assert_allclose(norm(times(p, q)), norm(p) * norm(q))
    np.testing.assert_allclose(norm(p), np.abs(parts(p)[0]), rtol=1e-15)
    product = times(p, bar(p))
    np.testing.assert_allclose(product[:, 0], norm(p) ** 2)
    np.testing.assert_allclose(product[:, 1], 0, atol=1e-15)
    np.testing.assert_allclose(norm(dual_complex.normalize(p)), 1, rtol=1e-15)


@pytest.mark.equation("B 2.41")
def test_associative_and_distributive():
    a, b, c = any_numbers(3, 30, seed=2)
    np.testing.assert_allclose(times(times(a, b), c), times(a, times(b, c)), atol=2e-14)
    np.testing.assert_allclose(times(a, b + c), times(a, b) + times(a, c), atol=1e-14)
    np.testing.assert_allclose(times(a + b, c), times(a, c) + times(b, c), atol=1e-14)


def test_inverse():
    p = any_numbers(20, seed=3)
    identity = np.broadcast_to(ONE, p.shape)
    size = np.max(np.abs(dual_complex.inverse(p)))
    np.testing.assert_allclose(times(p, dual_complex.inverse(p)), identity, atol=1e-15 * size**2)
    np.testing.assert_allclose(times(dual_complex.inverse(p), p), identity, atol=1e-15 * size**2)
    unit = dual_complex.normalize(p)
    np.testing.assert_allclose(dual_complex.inverse(unit), unit * [1, -1, -1, -1], atol=2e-15)
    with pytest.raises(ValueError, match=r"^dual_complex\.inverse: p must be invertible"):
        dual_complex.inverse(EPSILON)


@pytest.mark.equation("B 2.35", "B 2.36")
@each_batch
@each_length
def test_action_on_the_plane(batch, length):
    """p (1 + v eps) p_bar = 1 + (p0^2 v + 2 p0 p1) eps."""
    p, q = exp(algebra(batch, length, 4)), exp(algebra(batch, 1.9, 5))
    v = np.random.default_rng(6).normal(size=(*batch, 2))
    point = np.concatenate([np.broadcast_to([1.0, 0.0], v.shape), v], axis=-1)
    moved = times(times(p, point), dual_complex.conjugate(p))
    np.testing.assert_allclose(moved[..., :2], point[..., :2], atol=1e-15)
    np.testing.assert_allclose(moved[..., 2:], dual_complex.act(p, v), atol=4e-15)
    z, (p0, p1) = v[..., 0] + 1j * v[..., 1], parts(p)
    np.testing.assert_allclose(p0**2 * z + 2 * p0 * p1, moved[..., 2] + 1j * moved[..., 3], atol=4e-15)
    M, A = dual_complex.to_complex_matrix, dual_complex.to_matrix(p)
    np.testing.assert_allclose(np.abs(M(p)[..., 0, 0]), 1, atol=1e-15)
    np.testing.assert_allclose(M(times(p, q)), M(p) @ M(q), atol=1e-14)
    np.testing.assert_allclose(M(p)[..., 0, 0] * z + M(p)[..., 0, 1], p0**2 * z + 2 * p0 * p1, atol=4e-15)
    np.testing.assert_allclose(
        (A[..., :2, :2] @ v[..., None])[..., 0] + A[..., :2, 2], moved[..., 2:], atol=4e-15
    )
    np.testing.assert_array_equal(dual_complex.act([1.0, 0.0, 0.3, -2.0], v), v + np.array([0.6, -4.0]))


@each_batch
@each_length
def test_two_to_one_onto_rigid_motions_of_the_plane(batch, length):
    p = exp(algebra(batch, length, 7))
    A = dual_complex.to_matrix(p)
    np.testing.assert_array_equal(dual_complex.to_matrix(-p), A)
    back = dual_complex.from_matrix(A)
    assert np.all(back[..., 0] >= 0)
    np.testing.assert_allclose(back, dual_complex.align(p, back), atol=2e-15)
    np.testing.assert_allclose(dual_complex.to_matrix(back), A, atol=2e-15)


@pytest.mark.parametrize("gap", [0.0, 1e-15, -1e-15, 1e-9, -1e-9, 1e-3])
def test_from_matrix_near_the_half_turn(gap):
    A = se2.exp([PI - gap, 1.0, 2.0])
    p = dual_complex.from_matrix(A)
    angle = np.arctan2(A[1, 0], A[0, 0]) / 2
    np.testing.assert_allclose(p[:2], [np.cos(angle), np.sin(angle)], rtol=0, atol=2e-16)
    np.testing.assert_allclose(dual_complex.to_matrix(p), A, atol=1e-15)


@each_batch
@each_length
def test_exp_and_log(batch, length):
    x = algebra(batch, length, 8)
    p = exp(x)
    np.testing.assert_allclose(dual_complex.to_matrix(p), se2.exp(2 * x), atol=4e-15)
    np.testing.assert_allclose(log(p), x, rtol=0, atol=4e-15)
    np.testing.assert_allclose(exp(-x), dual_complex.inverse(p), atol=1e-15)
    np.testing.assert_allclose(exp(1.7 * x), times(exp(0.6 * x), exp(1.1 * x)), atol=4e-15)


@pytest.mark.parametrize(
    "theta", [0.0, 1e-300, 1e-12, 1e-5, 0.5, 2.0, 3.0, PI - 1e-6, PI - 1e-12, -PI + 1e-9]
)
def test_exp_and_log_against_fifty_digits(theta):
    x = np.array([theta, 0.7, -1.3])
    p, back = exp(x), log(exp(x))
    with mpmath.workdps(50):
        t = mpmath.mpf(theta)
        s = mpmath.sin(t) / t if theta else mpmath.mpf(1)
        exact = [mpmath.cos(t), mpmath.sin(t), *(s * mpmath.mpf(float(v)) for v in x[1:])]
        assert max(abs(mpmath.mpf(float(v)) - e) for v, e in zip(p, exact, strict=True)) <= 4.5e-16
    np.testing.assert_allclose(back, x, rtol=2e-15)


def test_not_every_unit_number_is_an_exponential():
    """exp takes (n pi, b) to +-1: of the two numbers of a translation one has a logarithm."""
    np.testing.assert_array_equal(log([-1.0, 0, 0, 0]), [PI, 0, 0])
    np.testing.assert_allclose(log(exp([PI, 1.0, 2.0])), [PI, 1.0, 2.0], rtol=1e-15)
    p = np.array([[1.0, 0, 3, 4], [-1.0, 0, 3, 4]])
    np.testing.assert_array_equal(log(p[0]), [0, 3, 4])
    np.testing.assert_array_equal(log(-p[1]), [0, -3, -4])
    with pytest.raises(ValueError, match=r"^dual_complex\.log: p must be an exponential.* index \(1,\)"):
        log(p)


@each_batch
@each_length
def test_embedding_into_the_dual_quaternions(batch, length):
    """Section 2.10: p0 + p1 eps -> p0 + p1 j eps is a homomorphism, and keeps all that is defined on both."""
    rng = np.random.default_rng(9)
    p, q = rng.normal(size=(2, *batch, 4))
    into = dual_complex.to_dual_quaternion
    np.testing.assert_allclose(into(times(p, q)), dual_quaternion.multiply(into(p), into(q)), atol=1e-14)
    np.testing.assert_allclose(into(dual_complex.inverse(p)), dual_quaternion.inverse(into(p)), rtol=1e-13)
    both = dual_quaternion.conjugate(dual_quaternion.star(into(p)))
    np.testing.assert_array_equal(into(dual_complex.conjugate(p)), both)
    np.testing.assert_allclose(dual_quaternion.norm(into(p))[..., 0], dual_complex.norm(p))
    x, v = algebra(batch, length, 10), rng.normal(size=(*batch, 2))
    p, q = exp(x), exp(algebra(batch, 1.0, 11))
    point = np.concatenate([np.zeros((*batch, 1)), v], axis=-1)
    moved = dual_quaternion.act(into(p), point)
    np.testing.assert_allclose(moved[..., 1:], dual_complex.act(p, v), atol=4e-15)
    np.testing.assert_allclose(moved[..., 0], 0, atol=1e-15)
    twist = np.zeros((*batch, 6))
    twist[..., 0], twist[..., 4:] = x[..., 0], x[..., 1:]
    np.testing.assert_allclose(dual_quaternion.exp(twist), into(p), atol=2e-15)
    np.testing.assert_allclose(
        dual_quaternion.sclerp(into(p), into(q), 0.3), into(dual_complex.sclerp(p, q, 0.3)), atol=1e-14
    )
    some = np.stack([p, q, -p], axis=-2)
    np.testing.assert_allclose(
        dual_quaternion.dlb([0.2, 0.5, 0.1], into(some)),
        into(dual_complex.dlb([0.2, 0.5, 0.1], some)),
        atol=4e-15,
    )


@each_batch
def test_sclerp_turns_about_one_pole_at_constant_speed(batch):
    p, q, h = (exp(algebra(batch, 2.2, seed)) for seed in (12, 13, 14))
    sclerp = dual_complex.sclerp
    np.testing.assert_allclose(sclerp(p, q, 0.0), p, atol=1e-15)
    np.testing.assert_allclose(sclerp(p, q, 1.0), q, atol=4e-15)
    for t in (-0.4, 0.3, 1.9):
        middle = sclerp(p, q, t)
        np.testing.assert_allclose(times(h, middle), sclerp(times(h, p), times(h, q), t), atol=2e-14)
        np.testing.assert_allclose(times(middle, h), sclerp(times(p, h), times(q, h), t), atol=2e-14)
        np.testing.assert_allclose(middle, sclerp(q, p, 1 - t), atol=2e-14)
    with pytest.raises(ValueError, match=r"^dual_complex\.sclerp: q must be reached from p"):
        sclerp(ONE, [-1.0, 0.0, 0.5, 0.0], 0.5)


@each_batch
@each_length
def test_linear_blending_is_bi_invariant(batch, length):
    rng = np.random.default_rng(15)
    p = exp(algebra((*batch, 4), length, 16))
    w = rng.uniform(0.1, 1, size=(*batch, 4))
    g, h = exp(algebra((), 2.9, 17)), exp(algebra((), 2.1, 18))
    blend = dual_complex.dlb(w, p)
    moved = dual_complex.dlb(w, times(times(g, p), h))
    whole = times(times(g, blend), h)
    np.testing.assert_allclose(dual_complex.to_matrix(moved), dual_complex.to_matrix(whole), atol=4e-14)
    np.testing.assert_allclose(
        dual_complex.dlb(np.eye(4)[2], p), dual_complex.align(p[..., 2, :], p[..., 0, :]), atol=2e-15
    )
    with pytest.raises(ValueError, match=r"^dual_complex\.dlb: weights must be such"):
        dual_complex.dlb([0.0, 1.0, 1.0], [ONE, IMAGINARY, -IMAGINARY])
