"""Paths of transformations: they meet their keys, follow blends, keep to classes, and are measured truly."""

import numpy as np
import pytest

from lietool.deform import pose, ways
from lietool.lie import affine, so3

WAYS = list(ways.WAYS.values())
MEETING = {
    "straight": pose.straight,
    "b_spline": pose.b_spline,
    "b_spline 2": lambda keys: pose.b_spline(keys, 2),
    "catmull_rom": pose.catmull_rom,
    "hermite": lambda keys: pose.hermite(keys, np.zeros_like(keys.params)),
}
TIMES = np.array([0.0, 0.7, 2.0, 2.5, 4.0])


def keys_of(seed: int = 0, count: int = 5, size: float = 0.6) -> np.ndarray:
    """Keys that all ways can do: near enough to the identity for a logarithm."""
    return affine.phi_so(size * np.random.default_rng(seed).normal(size=(count, 12)))


def about_x(angle: float, t: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
    A = np.eye(4)
    A[:3, :3], A[:3, 3] = so3.exp([angle, 0.0, 0.0]), t
    return A


@pytest.mark.parametrize("way", WAYS, ids=lambda w: w.name)
@pytest.mark.parametrize("curve", MEETING)
@pytest.mark.parametrize("make", [pose.principal, pose.followed])
def test_interpolating_curves_meet_the_keys(way, curve, make):
    A = keys_of()
    path = MEETING[curve](make(way, A, TIMES, [1.0, -2.0, 0.5]))
    np.testing.assert_allclose(pose.evaluate(path, TIMES), A, atol=1e-13)


@pytest.mark.parametrize("way", WAYS, ids=lambda w: w.name)
@pytest.mark.parametrize("curve", pose.CURVES)
def test_every_curve_begins_and_ends_at_keys_and_takes_any_shape_of_times(way, curve):
    A = keys_of(1)
    path = pose.CURVES[curve](pose.followed(way, A, TIMES))
    np.testing.assert_allclose(pose.evaluate(path, [0.0, 4.0]), A[[0, -1]], atol=1e-13)
    t = np.random.default_rng(2).uniform(0.0, 4.0, (2, 5))
    many = pose.evaluate(path, t)
    assert many.shape == (2, 5, 4, 4)
    assert pose.evaluate(path, 1.3).shape == (4, 4)
    assert pose.evaluate(path, np.zeros((0, 3))).shape == (0, 3, 4, 4)
    np.testing.assert_allclose(pose.evaluate(path, t[1, 3]), many[1, 3], atol=1e-14)


@pytest.mark.equation("K 9")
@pytest.mark.parametrize("way", WAYS, ids=lambda w: w.name)
@pytest.mark.parametrize("curve", pose.CURVES)
def test_two_keys_are_joined_by_their_blend(way, curve):
    A = keys_of(3, 2)
    path = pose.CURVES[curve](pose.principal(way, A))
    t = np.linspace(0.0, 1.0, 9)
    blend = ways.blend(way, np.stack([1.0 - t, t], axis=-1), A)
    assert not blend.fallback.any()
    np.testing.assert_allclose(pose.evaluate(path, t), blend.A, atol=1e-13)


@pytest.mark.parametrize("way", WAYS, ids=lambda w: w.name)
@pytest.mark.parametrize("curve", pose.CURVES)
def test_equal_keys_stay(way, curve):
    A = np.repeat(keys_of(4, 1), 4, axis=0)
    path = pose.CURVES[curve](pose.followed(way, A))
    np.testing.assert_allclose(
        pose.evaluate(path, np.linspace(0, 3, 13)), np.repeat(A[:1], 13, 0), atol=1e-13
    )
    found = pose.measure(path)
    assert found.spin == 1.0 or found.turned < 1e-10


@pytest.mark.parametrize("way", [ways.PHI_SO, ways.PHI_SE], ids=lambda w: w.name)
@pytest.mark.parametrize("curve", pose.CURVES)
def test_rigid_keys_stay_rigid(way, curve):
    p = np.random.default_rng(5).normal(size=(6, 12))
    p[:, 6:] = 0.0
    A = pose.evaluate(pose.CURVES[curve](pose.followed(way, affine.phi_so(p))), np.linspace(0.0, 5.0, 31))
    R = A[:, :3, :3]
    np.testing.assert_allclose(np.swapaxes(R, 1, 2) @ R, np.broadcast_to(np.eye(3), R.shape), atol=1e-13)


def test_curves_are_what_their_names_say():
    A = keys_of(6, 6)
    keys = pose.followed(ways.PHI_SO, A)
    t = np.linspace(0.0, 5.0, 41)
    # De Casteljau and de Boor, by hand.
    for s in (0.0, 0.31, 1.0):
        points = keys.params
        while len(points) > 1:
            points = (1.0 - s) * points[:-1] + s * points[1:]
        np.testing.assert_allclose(pose.bezier(keys).at(np.array([5.0 * s]))[0], points[0], atol=1e-13)
    near, degree_one = pose.b_spline_near(keys), pose.b_spline_near(keys, 1)
    np.testing.assert_allclose(degree_one.at(t), pose.straight(keys).at(t), atol=1e-13)
    # Between the least and the greatest of its control points, which an interpolating curve is not.
    low, high = keys.params.min(axis=0) - 1e-12, keys.params.max(axis=0) + 1e-12
    assert (near.at(t) >= low).all() and (near.at(t) <= high).all()
    # Catmull-Rom at even times: the well known matrix of its cubic.
    p0, p1, p2, p3 = keys.params[1:5]
    u = 0.3
    wanted = 0.5 * np.array([1, u, u**2, u**3]) @ [2 * p1, p2 - p0, 2 * p0 - 5 * p1 + 4 * p2 - p3,
                                                   3 * p1 - p0 - 3 * p2 + p3]  # fmt: skip
    np.testing.assert_allclose(pose.catmull_rom(keys).at(np.array([2.3]))[0], wanted, atol=1e-13)


def test_hermite_has_the_velocities_and_rests_where_they_are_nothing():
    keys = pose.followed(ways.PHI_SE, keys_of(7), TIMES)
    v = np.random.default_rng(8).normal(size=keys.params.shape)
    path, h = pose.hermite(keys, v), 1e-6
    for k in range(1, 4):
        rate = (path.at(TIMES[[k]] + h) - path.at(TIMES[[k]] - h))[0] / (2.0 * h)
        np.testing.assert_allclose(rate, v[k], atol=1e-4)


def test_keys_are_followed_through_whole_turns():
    angles = np.deg2rad([0, 80, 160, 240, 320, 400, 480])
    A = np.stack([about_x(a) for a in angles])
    keys = pose.followed(ways.PHI_SO, A)
    np.testing.assert_allclose(keys.params[:, 0], angles, atol=1e-12)
    assert not len(keys.far)
    # Each by itself turns back between 160 and 240 degrees; that is no longer a detour of 80 but of 280.
    alone = pose.principal(ways.PHI_SO, A)
    assert list(alone.far) == [3]
    short, long = (pose.measure(pose.straight(k)) for k in (keys, alone))
    assert short.spin == pytest.approx(1.0, abs=1e-9)
    assert long.spin == pytest.approx((80 + 80 + 280 + 80 + 80 + 80) / 480, rel=1e-9)
    # Quaternions are followed by their sign: no way back either.
    for way in (ways.POLAR_QUATERNION, ways.DUAL_QUATERNION):
        assert pose.measure(pose.straight(pose.followed(way, A))).spin == pytest.approx(1.0, abs=1e-9)
        half = pose.evaluate(pose.straight(pose.followed(way, A)), [2.5])
        np.testing.assert_allclose(half[0], about_x(np.deg2rad(200)), atol=1e-13)


def test_stated_turns():
    A = np.stack([about_x(0.0), about_x(0.3), about_x(0.1)])
    keys = pose.followed(ways.PHI_SO, A, near={1: [4.0 * np.pi, 0.0, 0.0]})
    np.testing.assert_allclose(keys.params[:, 0], [0.0, 0.3 + 4 * np.pi, 0.1 + 4 * np.pi], atol=1e-12)
    assert list(keys.far) == [1]
    np.testing.assert_allclose(pose.evaluate(pose.b_spline(keys), [0, 1, 2]), A, atol=1e-13)
    found = pose.measure(pose.straight(keys))
    assert found.turned == pytest.approx(0.3 + 4 * np.pi + 0.2) and found.geodesic == pytest.approx(0.5)
    # At the first key too, so that it all begins elsewhere.
    first = pose.followed(ways.PHI_SO, A, near={0: [2.0 * np.pi, 0.0, 0.0]})
    np.testing.assert_allclose(first.params[:, 0], np.array([0.0, 0.3, 0.1]) + 2.0 * np.pi, atol=1e-12)


def test_spin_against_an_integral_of_the_angular_velocity():
    from scipy.integrate import quad

    keys = pose.followed(ways.PHI_SO, keys_of(9, 4, 1.0))
    path = pose.b_spline(keys)

    def omega(t: float) -> float:
        x = path.at(np.array([t]))[0, :3]
        rate = path.at.derivative()(np.array([t]))[0, :3]
        return float(np.linalg.norm(so3.left_jacobian(x) @ rate))

    found = pose.measure(path)
    exact = sum(quad(omega, a, a + 1.0, epsabs=1e-10)[0] for a in range(3))
    assert found.turned == pytest.approx(exact, rel=1e-5)
    R = so3.exp(keys.params[:, :3])
    angles = [np.linalg.norm(so3.log(R[k].T @ R[k + 1])) for k in range(3)]
    assert found.geodesic == pytest.approx(sum(angles), rel=1e-12)
    assert found.spin >= 1.0 and not found.is_degenerate


def test_linear_paths_degenerate_and_the_others_do_not():
    A = np.stack([np.eye(4), about_x(np.pi - 1e-9, (3.0, 0.0, 0.0))])
    for way in WAYS:
        found = pose.measure(pose.straight(pose.followed(way, A)))
        if way is ways.LINEAR:
            assert found.least_det == pytest.approx(0.0, abs=1e-12)
            assert found.least_at == pytest.approx(0.5, abs=1e-3)
        else:
            assert found.least_det == pytest.approx(1.0, rel=1e-9) and not found.is_degenerate
            assert found.spin == pytest.approx(1.0, abs=1e-6)
    # Turned inside out in between: refused as a key, reported on a path.
    through = np.stack([np.eye(4), about_x(np.pi), np.diag([1.0, 1.0, 1.0, 1.0])])
    inside_out = pose.bezier(pose.principal(ways.LINEAR, through))
    assert pose.measure(inside_out).least_det == pytest.approx(0.0, abs=1e-9)
    # Back to where it began, but with a swing below 0 of the first entry, 18 (2 t^3 - 3 t^2 + t).
    swing = pose.hermite(pose.principal(ways.LINEAR, through[[0, 2]]), 18.0 * np.eye(12)[[0, 0]])
    found = pose.measure(swing)
    assert found.is_degenerate and found.least_det == pytest.approx(1.0 - np.sqrt(3.0), abs=1e-8)
    assert found.least_at == pytest.approx((3.0 + np.sqrt(3.0)) / 6.0, abs=1e-4)


def test_keys_about_their_own_centre_do_not_depend_on_the_world():
    A, c = keys_of(10), np.array([2.0, 1.0, -1.0])
    shift = np.eye(4)
    shift[:3, 3] = [7.0, -3.0, 4.0]
    back = np.linalg.inv(shift)
    t = np.linspace(0.0, 4.0, 17)
    for way in (ways.PHI_SO, ways.PHI_SE, ways.POLAR_QUATERNION):
        here = pose.evaluate(pose.b_spline(pose.followed(way, A, centre=c)), t)
        there = pose.followed(way, shift @ A @ back, centre=c + shift[:3, 3])
        np.testing.assert_allclose(pose.evaluate(pose.b_spline(there), t), shift @ here @ back, atol=1e-12)


def test_frames_relative_to_a_rest():
    rest, frames = keys_of(11, 1)[0], keys_of(12)
    np.testing.assert_allclose(pose.relative(rest, frames) @ rest, frames, atol=1e-13)


GOOD = keys_of(13)
NO_LOG = np.stack([np.eye(4), np.diag([-1.0, -2.0, 1.0, 1.0]), np.eye(4), np.diag([-1.0, -3.0, 1.0, 1.0])])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: pose.principal(ways.ALEXA, NO_LOG), r"A must .* alexa .*; got none for keys 1, 3\. Leave"),
        (lambda: pose.principal(ways.ALEXA, NO_LOG[:3]), r"A must .*; got none for key 1\."),
        (lambda: pose.principal(ways.PHI_SO, GOOD[:1]), "A must be two keys or more"),
        (lambda: pose.principal(ways.PHI_SO, GOOD[0]), "A must be two keys or more"),
        (lambda: pose.principal(ways.PHI_SO, GOOD[:, :3]), r"A must be an array of shape \(\.\.\., 4, 4\)"),
        (lambda: pose.principal(ways.PHI_SO, np.where(GOOD == 1, np.nan, GOOD)), "A must be finite"),
        (
            lambda: pose.principal(ways.LINEAR, GOOD * np.array([-1, 1, 1, 1])[:, None]),
            r"A must be transformations with det > 0; got det = -.* at index \(0,\)",
        ),
        (
            lambda: pose.principal(ways.PHI_SO, GOOD, [0, 1, 2, 2, 3]),
            r"times must be increasing, .*; got 2 after 2",
        ),
        (lambda: pose.principal(ways.PHI_SO, GOOD, np.arange(5) * 1e-200), r"times must be increasing, .*"),
        (lambda: pose.principal(ways.PHI_SO, GOOD, np.arange(5) * 1e120), r"times must be within 1e\+100"),
        (lambda: pose.followed(ways.PHI_SO, GOOD, near={0.5: [1, 0, 0]}), "near must be of keys 0 to 4"),
        (lambda: pose.principal(ways.PHI_SO, GOOD, [0, 1]), r"times must be an array of shape \(5,\)"),
        (lambda: pose.principal(ways.PHI_SO, GOOD, [0, 1, np.nan, 3, 4]), "times must be finite"),
        (lambda: pose.principal(ways.PHI_SO, GOOD, None, [0, 0]), "centre must be an array"),
        (lambda: pose.followed(ways.LINEAR, GOOD, near={0: [1, 0, 0]}), "near must be none, for linear"),
        (lambda: pose.followed(ways.PHI_SO, GOOD, near={5: [1, 0, 0]}), "near must be of keys 0 to 4"),
        (lambda: pose.followed(ways.PHI_SO, GOOD, near={0: [1, np.inf, 0]}), "near must be finite"),
        (lambda: pose.followed(ways.PHI_SO, GOOD, near={0: [[1, 0, 0]]}), "near must be vectors"),
        (
            lambda: pose.followed(ways.PHI_SE, [about_x(6.0), about_x(0.0, (0, 1, 0))], near={0: [6, 0, 0]}),
            r"A must have parameters near; got a whole number of turns .* at index \(1,\)",
        ),
        (lambda: pose.b_spline(pose.principal(ways.PHI_SO, GOOD), 0), "degree must be a whole number"),
        (lambda: pose.b_spline_near(pose.principal(ways.PHI_SO, GOOD), 2.5), "degree must be a whole number"),
        (lambda: pose.hermite(pose.principal(ways.PHI_SO, GOOD), np.zeros((5, 3))), "velocities must be"),
        (
            lambda: pose.hermite(pose.principal(ways.PHI_SO, GOOD), np.full((5, 12), np.nan)),
            "velocities must",
        ),
        (
            lambda: pose.evaluate(pose.straight(pose.principal(ways.PHI_SO, GOOD)), 4.1),
            "t must be from 0 to 4",
        ),
        (lambda: pose.evaluate(pose.straight(pose.principal(ways.PHI_SO, GOOD)), np.nan), "t must be finite"),
        (lambda: pose.measure(pose.straight(pose.principal(ways.PHI_SO, GOOD)), 0), "steps must be a whole"),
        (lambda: pose.relative(np.zeros((4, 4)), GOOD), "rest must be an affine transformation"),
        (
            lambda: pose.relative(np.diag([1.0, 1.0, 1e-300, 1.0]), GOOD),
            "rest must be invertible; got singular values 1, 1, 1e-300",
        ),
    ],
)
def test_bad_input_is_refused_by_name(call, message):
    with pytest.raises(ValueError, match=rf"^pose(_keys)?\.\w+: {message}[^\n]*$"):
        call()
