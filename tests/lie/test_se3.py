"""Rigid transformations of space against 50 digits and other libraries; their laws; every logarithm."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytransform3d import transformations as pt
from scipy.linalg import expm, logm

from lietool.lie import se3, series, so3

PI = np.pi
BATCHES = [(), (4,), (2, 3)]
LENGTHS = {"ordinary": 1.3, "tiny": 1e-9, "near pi": PI - 1e-9, "zero": 0.0}
ANGLES = [0.0, 1e-300, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 1.0, 1.6, 2.0, 2.5, 3.0]
ANGLES += [PI - d for d in (1e-3, 1e-6, 1e-8, 1e-12, 1e-15, 4.5e-16, 0.0)]
SCALES = [1e-50, 1.0, 1e50]

each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_length = pytest.mark.parametrize("length", LENGTHS.values(), ids=LENGTHS.keys())


def hard_axes() -> np.ndarray:
    rng = np.random.default_rng(11)
    u = [
        *rng.normal(size=(4, 3)),
        *np.eye(3),
        (-1, 0, 0),
        (1, 1, 0),
        (1, 1e-8, 0),
        (1, -1, 1),
        (1e-16, 1, -1),
    ]
    u = np.array(u, dtype=float)
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def twists(batch: tuple[int, ...], length: float, seed: int = 0, scale: float = 1.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(*batch, 6)) * scale
    x[..., :3] *= length / np.linalg.norm(x[..., :3], axis=-1, keepdims=True)
    return x


def hard_twists(theta: float) -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    ways = (lambda u: rng.normal(size=3), lambda u: u, lambda u: np.cross(u, (0.3, -0.5, 0.8)))
    return [np.r_[theta * u, scale * way(u)] for u in hard_axes() for scale in SCALES for way in ways]


def matrix(x) -> mpmath.matrix:
    return mpmath.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def exact(x) -> tuple[mpmath.matrix, mpmath.matrix]:
    """Return R and V."""
    X, t = matrix(x), norm(x)
    if t < 1e-20:
        return mpmath.eye(3) + X, mpmath.eye(3) + X / 2
    a, b, c = mpmath.sin(t) / t, 2 * (mpmath.sin(t / 2) / t) ** 2, (t - mpmath.sin(t)) / t**3
    return mpmath.eye(3) + a * X + b * X * X, mpmath.eye(3) + b * X + c * X * X


def numbers(x) -> mpmath.matrix:
    return mpmath.matrix([mpmath.mpf(float(v)) for v in x])


def norm(x) -> mpmath.mpf:
    return mpmath.sqrt(sum(v * v for v in x))


def rounded(R: mpmath.matrix, d: mpmath.matrix) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = np.array(R.tolist(), dtype=float)
    T[:3, 3] = np.array([float(v) for v in d])
    return T


@pytest.mark.equation("B 7.3", "B 7.4", "B 7.5", "B 7.6", "B 7.7", "B 7.8", "B 2.43")
@pytest.mark.parametrize("theta", ANGLES)
def test_exp_and_log_to_a_few_ulp(theta):
    for x in hard_twists(theta)[::2]:
        with mpmath.workdps(50):
            r, translation = numbers(x[:3]), numbers(x[3:])
            R, V = exact(r)
            d = V * translation
            T = se3.exp(x)
            assert max(abs(mpmath.mpf(float(T[i, j])) - R[i, j]) for i in range(3) for j in range(3)) <= 1e-15
            assert norm(numbers(T[:3, 3]) - d) <= 1e-15 * norm(d)
            assert np.array_equal(T[3], [0, 0, 0, 1])
            y = se3.log(rounded(R, d))
            # The rounded matrix may have lost the sign of the axis at a half turn; its other logarithm then.
            others = [r, r * (1 - 2 * mpmath.pi / norm(r))] if theta > PI - 2e-15 else [r]
            gaps = []
            for other in others:
                back = mpmath.lu_solve(exact(other)[1], d)
                turn = norm(numbers(y[:3]) - other) / (norm(other) or 1)
                gaps.append(max(turn, norm(numbers(y[3:]) - back) / norm(back)))
            assert min(gaps) <= 1e-15


@pytest.mark.parametrize("theta", [4.0, 6.0, 2 * PI - 1e-9, 2 * PI, 31.0])
def test_exp_of_more_than_a_half_turn(theta):
    for x in hard_twists(theta)[::2]:
        with mpmath.workdps(50):
            R, V = exact(numbers(x[:3]))
            T = se3.exp(x)
            gap = max(abs(mpmath.mpf(float(T[i, j])) - R[i, j]) for i in range(3) for j in range(3))
            assert gap <= 1e-15 * max(1.0, theta / 4)
            # Across the axis V sends nearly everything to 0 there, so the error is measured by l.
            assert norm(numbers(T[:3, 3]) - V * numbers(x[3:])) <= 1e-15 * norm(numbers(x[3:]))


def exact_ad(x) -> mpmath.matrix:
    A, X, P = mpmath.zeros(6), matrix(x[:3]), matrix(x[3:])
    for i in range(3):
        for j in range(3):
            A[i, j] = A[3 + i, 3 + j] = X[i, j]
            A[3 + i, j] = P[i, j]
    return A


@pytest.mark.equation("B 7.5", "B A.10", "B 7.8", "B A.11")
@pytest.mark.parametrize("theta", [0.0, 1e-9, 1e-4, 0.5, 1.6, 2.4, 3.0, 3.5, PI, 4.0, 6.0])
def test_jacobians_are_the_series_in_ad(theta):
    """The sum of ad^k / (k + 1)!, and its inverse."""
    for x in hard_twists(theta)[1::27]:
        x = np.r_[x[:3], x[3:] / np.linalg.norm(x[3:])]
        with mpmath.workdps(50):
            A = exact_ad(numbers(x))
            J = term = mpmath.eye(6)
            for k in range(2, 60):
                term = term * A / k
                J = J + term
            K = J**-1
            size = float(max(abs(v) for v in K))
            for value, true, bound in (
                (se3.left_jacobian(x), J, 1e-15),
                (se3.left_jacobian_inverse(x), K, 2e-15 * size**2),
            ):
                gap = max(
                    abs(mpmath.mpf(float(value[i, j])) - true[i, j]) for i in range(6) for j in range(6)
                )
                assert gap <= bound


@each_batch
@each_length
@pytest.mark.parametrize("scale", SCALES)
def test_log_undoes_exp(batch, length, scale):
    x = twists(batch, length, 0, scale)
    y = se3.log(se3.exp(x))
    np.testing.assert_allclose(y[..., :3], x[..., :3], rtol=0, atol=1.5e-15 * length)
    np.testing.assert_allclose(y[..., 3:], x[..., 3:], rtol=0, atol=8e-15 * scale)


@each_batch
@each_length
@pytest.mark.equation("B 3.7", "B 2.43")
def test_group_laws(batch, length):
    f, g, h = (se3.exp(twists(batch, length, seed)) for seed in (1, 2, 3))
    np.testing.assert_allclose((f @ g) @ h, f @ (g @ h), atol=4e-15)
    one = np.broadcast_to(np.eye(4), f.shape)
    np.testing.assert_allclose(f @ se3.inverse(f), one, atol=2e-15)
    np.testing.assert_allclose(se3.inverse(f) @ f, one, atol=2e-15)
    p = np.random.default_rng(4).normal(size=(*batch, 3))
    np.testing.assert_allclose(se3.act(f @ g, p), se3.act(f, se3.act(g, p)), atol=4e-15)
    # Every member is one rotation, then one translation; translations are normal.
    only = np.array(one)
    only[..., :3, 3] = f[..., :3, 3]
    turn = np.array(f)
    turn[..., :3, 3] = 0.0
    np.testing.assert_array_equal(only @ turn, f)
    moved = g @ only @ se3.inverse(g)
    np.testing.assert_allclose(moved[..., :3, :3], one[..., :3, :3], atol=1e-15)
    np.testing.assert_allclose(moved[..., :3, 3], so3.act(g[..., :3, :3], f[..., :3, 3]), atol=4e-15)


@each_batch
@each_length
@pytest.mark.equation("B 4.8", "B 4.11")
def test_subgroups_and_adjoint(batch, length):
    x, y = twists(batch, length, 1), twists(batch, 0.7, 2)
    np.testing.assert_allclose(se3.exp(1.7 * x), se3.exp(0.6 * x) @ se3.exp(1.1 * x), atol=5e-15)
    np.testing.assert_allclose(se3.exp(-x), se3.inverse(se3.exp(x)), atol=3e-15)
    T, S = se3.exp(x), se3.exp(twists(batch, 0.8, 3))
    Ad = se3.adjoint(T)
    z = np.einsum("...ij,...j->...i", Ad, y)
    np.testing.assert_allclose(T @ se3.hat(y) @ se3.inverse(T), se3.hat(z), atol=1e-14)
    np.testing.assert_allclose(T @ se3.exp(y) @ se3.inverse(T), se3.exp(z), atol=2e-14)
    np.testing.assert_allclose(se3.adjoint(T @ S), Ad @ se3.adjoint(S), atol=1e-14)


@each_batch
@each_length
def test_jacobians_are_derivatives(batch, length):
    """exp(x + e) = exp(J e) exp(x) to first order; J fixes x."""
    x, e = twists(batch, length, 1), 1e-5 * twists(batch, 1.0, 2)
    J, K = se3.left_jacobian(x), se3.left_jacobian_inverse(x)
    step = se3.log(se3.exp(x + e) @ se3.inverse(se3.exp(x - e))) / 2
    apply = lambda A, v: np.einsum("...ij,...j->...i", A, v)  # noqa: E731
    np.testing.assert_allclose(apply(J, e), step, atol=1e-14)
    np.testing.assert_allclose(apply(K, apply(J, e)), e, atol=1e-18)
    np.testing.assert_allclose(apply(J, x), x, atol=4e-15)


@pytest.mark.equation("B 4.22")
def test_hat_vee_and_the_axis_of_a_screw():
    x = twists((7,), 1.3)
    assert np.array_equal(se3.vee(se3.hat(x)), x)
    p = np.random.default_rng(1).normal(size=(7, 3))
    field = (se3.hat(x) @ np.concatenate([p, np.ones((7, 1))], axis=-1)[..., None])[..., :3, 0]
    np.testing.assert_allclose(field, np.cross(x[..., :3], p) + x[..., 3:], atol=1e-15)
    # A rotation about a line through p leaves its points in place.
    about = np.concatenate([x[..., :3], np.cross(p, x[..., :3])], axis=-1)
    np.testing.assert_allclose(se3.act(se3.exp(about), p + x[..., :3]), p + x[..., :3], atol=4e-15)


@pytest.mark.equation("B 4.5")
def test_translations_are_their_own_logarithms():
    x = np.r_[0, 0, 0, 1e50, -2.0, 1e-50]
    assert np.array_equal(se3.log(se3.exp(x)), x)
    assert np.array_equal(se3.exp(x), np.eye(4) + se3.hat(x))


@pytest.mark.equation("B A.9")
def test_same_as_other_libraries():
    x = twists((30,), 2.1)
    T = se3.exp(x)
    for xi, Ti in zip(x, T, strict=True):
        np.testing.assert_allclose(Ti, expm(se3.hat(xi)), atol=4e-15)
        np.testing.assert_allclose(se3.hat(se3.log(Ti)), logm(Ti), atol=2e-14)
        np.testing.assert_allclose(Ti, pt.transform_from_exponential_coordinates(xi), atol=1e-14)
        np.testing.assert_allclose(se3.log(Ti), pt.exponential_coordinates_from_transform(Ti), atol=1e-14)
        np.testing.assert_allclose(se3.adjoint(Ti), pt.adjoint_from_transform(Ti), atol=1e-15)


def every_log(T: np.ndarray, turns: range) -> np.ndarray:
    """Return the logarithms with these numbers of turns, each by the inverse of its own V."""
    x = so3.log(T[:3, :3])
    theta = np.linalg.norm(x)
    r = np.array([(theta + 2 * PI * k) / theta * x for k in turns])
    return np.concatenate([r, so3.left_jacobian_inverse(r) @ T[:3, 3]], axis=-1)


@pytest.mark.equation("B 4.27", "B 4.28", "K Algorithm 1")
def test_log_near_is_the_nearest_rotation_of_all_branches():
    rng = np.random.default_rng(6)
    for T in se3.exp(twists((40,), 1.7)):
        reference = rng.normal(size=6) * rng.choice([0.1, 3.0, 20.0])
        x, distance = se3.log_near(T, reference)
        np.testing.assert_allclose(se3.exp(x), T, atol=1e-13)
        branches = every_log(T, range(-15, 16))
        gaps = np.linalg.norm(branches[:, :3] - reference[:3], axis=-1)
        assert distance == pytest.approx(np.min(gaps), abs=1e-12)
        np.testing.assert_allclose(x, branches[np.argmin(gaps)], atol=1e-11)


def test_log_near_depends_neither_on_the_unit_nor_on_the_origin():
    x = twists((20,), 2.0)
    T, reference = se3.exp(x), twists((20,), 9.0, 1)
    y, _ = se3.log_near(T, reference)
    unit = np.r_[1, 1, 1, 1e6, 1e6, 1e6]
    S = T.copy()
    S[:, :3, 3] *= 1e6
    np.testing.assert_allclose(se3.log_near(S, unit * reference)[0], unit * y, rtol=1e-12, atol=1e-8)
    G = se3.exp([0.3, -2.0, 1.0, 40.0, 50.0, -60.0])
    there = se3.log_near(G @ T @ se3.inverse(G), reference @ se3.adjoint(G).T)[0]
    np.testing.assert_allclose(there, y @ se3.adjoint(G).T, rtol=0, atol=2e-10)


def test_log_near_gives_back_a_long_logarithm():
    u = hard_axes()
    for theta in (0.0, 1.0, PI, 5.0, 9.0, 31.0):
        x = np.concatenate([theta * u, np.random.default_rng(1).normal(size=u.shape)], axis=-1)
        y, distance = se3.log_near(se3.exp(x), x)
        np.testing.assert_allclose(y, x, rtol=0, atol=3e-14 * max(theta, 1))
        assert np.all(distance <= 1e-13)


@pytest.mark.equation("B 4.30")
def test_log_near_of_full_turns():
    """Beside (0, d), a translation has as logarithms full turns about axes along it, wherever they lie."""
    d = np.array([0.0, 0.0, 2.0])
    T = np.eye(4)
    T[:3, 3] = d
    x, distance = se3.log_near(T, [0.1, 0, 6.0, 5.0, 7.0, 9.0])
    np.testing.assert_allclose(x, [0, 0, 2 * PI, 5.0, 7.0, 2.0])
    assert distance == pytest.approx(np.hypot(0.1, 2 * PI - 6.0))
    np.testing.assert_allclose(se3.exp(x), T, atol=1e-14)
    x, _ = se3.log_near(T, [0.1, 0, -6.0, 5.0, 7.0, 9.0])
    np.testing.assert_allclose(x, [0, 0, -2 * PI, 5.0, 7.0, 2.0])
    x, _ = se3.log_near(T, [6.0, 0, 0.0, 5.0, 7.0, 9.0])  # no logarithm turns about x
    np.testing.assert_allclose(x, [0, 0, 0, 0, 0, 2])
    x, _ = se3.log_near(np.eye(4), [6.0, 0, 0.0, 5.0, 7.0, 9.0])
    np.testing.assert_allclose(x, [2 * PI, 0, 0, 0, 7, 9])
    np.testing.assert_allclose(se3.exp(x), np.eye(4), atol=1e-14)
    assert np.array_equal(se3.log_near(np.eye(4), np.zeros(6))[0], np.zeros(6))


def test_log_near_follows_a_product_through_the_full_turn():
    """Rounded products miss the identity by a few ulp, about some axis; that must not lose the branch."""
    for u in hard_axes():
        x = np.r_[PI * u, 3.0 * u + 2.0 * np.cross(u, (0.1, 0.2, 0.9))]
        half = se3.exp(x)
        y, _ = se3.log_near(half @ half, 2 * x)
        np.testing.assert_allclose(y, 2 * x, atol=1e-13)


def printed_7_8(R: np.ndarray, d: np.ndarray, trace: float | None = None) -> np.ndarray:
    """The logarithm as (7.6), with its -1, (7.7) and (7.8) have it."""
    theta = np.arccos(((np.trace(R) if trace is None else trace) - 1) / 2)
    X = theta / (2 * np.sin(theta)) * (R - R.T)
    top, bottom = 2 * np.sin(theta) - (1 + np.cos(theta)) * theta, 2 * theta**2 * np.sin(theta)
    return d - X @ d / 2 + top / bottom * (X @ X @ d)


@pytest.mark.erratum("B 7.8")
@pytest.mark.equation("B 7.8")
def test_7_8_divides_zero_by_zero_at_a_half_turn():
    d = np.array([0.0, 1.0, 2.0])
    R = np.diag([1.0, -1.0, -1.0])
    with np.errstate(invalid="ignore"):
        assert not np.allclose(printed_7_8(R, d), se3.log(rounded(mpmath.matrix(R.tolist()), d))[3:])
    x = np.array([PI, 0, 0, *np.linalg.solve(so3.left_jacobian([PI, 0, 0]), d)])
    np.testing.assert_allclose(se3.log(rounded(mpmath.matrix(R.tolist()), d)), x, atol=1e-15)
    sine, cosine = R[2, 1], R[1, 1]
    with np.errstate(invalid="ignore"):
        assert np.isnan((2 * sine - (1 + cosine) * PI) / (2 * PI**2 * sine))
    # Beside pi the arc cosine of the trace has lost half of the digits.
    worst = 0.0
    for gap in (1e-6, 1e-7, 1e-8):
        x = np.r_[PI - gap, 0, 0, 0, 1.0, 2.0]
        T = se3.exp(x)
        worst = max(worst, float(np.max(np.abs(printed_7_8(T[:3, :3], T[:3, 3]) - x[3:]))))
        np.testing.assert_allclose(se3.log(T), x, atol=4e-15)
    assert worst > 1e-9
    assert series.cotangent_defect(PI) == pytest.approx(1 / PI**2, rel=1e-15)


@pytest.mark.erratum("M section 2")
def test_the_formula_of_the_2013_paper_needs_x_and_the_small_trace():
    x = np.array([0.5, -0.9, 0.7, 1.0, 2.0, -1.0])
    T, theta = se3.exp(x), np.linalg.norm(x[:3])
    R, X, d = T[:3, :3], so3.hat(x[:3]), T[:3, 3]
    b, c = series.versinc(theta), series.sine_defect(theta)
    np.testing.assert_allclose((np.eye(3) + b * X + c * X @ X) @ x[3:], d, atol=1e-15)
    assert np.max(np.abs((np.eye(3) + b * R + c * R @ R) @ x[3:] - d)) > 0.5
    assert np.arccos((np.trace(R) - 1) / 2) == pytest.approx(theta)
    assert abs(np.arccos((np.trace(T) - 1) / 2) - theta) > 0.4


@pytest.mark.parametrize(
    ("break_it", "message"),
    [
        (
            lambda T: T[1].__setitem__((3, 0), 0.5),
            r"last row 0 0 0 1; got last row 0.5 0 0 1 at index \(1,\)",
        ),
        (lambda T: T[2].__setitem__((0, 0), 9.0), r"\|R\^T R - I\| <= 1e-06; got .* at index \(2,\)"),
        (lambda T: T[0].__setitem__((2, 2), -1.0), r"det > 0; got det = -1 at index \(0,\)"),
        (lambda T: T[2].__setitem__((0, 3), np.nan), r"finite; got nan at index \(2,\)"),
    ],
)
def test_what_is_not_rigid_is_refused(break_it, message):
    T = np.tile(np.eye(4), (3, 1, 1))
    break_it(T)
    with pytest.raises(ValueError, match=r"^se3\.log: T must be .*" + message):
        se3.log(T)


def test_left_jacobian_inverse_refuses_the_spheres_where_there_is_none():
    x = np.array([[1.0, 0, 0, 1, 2, 3], [0, 2 * PI, 0, 1, 2, 3]])
    with pytest.raises(ValueError, match=r"^se3\.left_jacobian_inverse: x must be of a rotation .* \(1,\)\."):
        se3.left_jacobian_inverse(x)


coordinates = st.floats(-1.8, 1.8, allow_nan=False)


@settings(derandomize=True, deadline=None, max_examples=120)
@given(st.lists(coordinates, min_size=6, max_size=6), st.sampled_from([1.0, 1e-5, 1e-12, 1e-200]))
def test_round_trip_on_whatever_hypothesis_finds(x, scale):
    x = np.array(x)
    x[:3] *= scale
    theta = np.linalg.norm(x[:3])
    if theta < PI - 1e-12:
        y = se3.log(se3.exp(x))
        np.testing.assert_allclose(y[:3], x[:3], rtol=0, atol=2e-15 * theta + 1e-320)
        np.testing.assert_allclose(y[3:], x[3:], rtol=0, atol=6e-15 * np.max(np.abs(x[3:])))
    np.testing.assert_allclose(se3.exp(-x) @ se3.exp(x), np.eye(4), atol=4e-15)
