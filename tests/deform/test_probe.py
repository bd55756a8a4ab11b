"""The probe deformer: its laws, the erratum about the origin, whole turns, and what it refuses."""

from typing import Any

import numpy as np
import pytest
from pytransform3d import transformations as pt

from lietool.deform import move, orientation, probe, turns, ways, weights
from lietool.lie import affine, so3

EVERY = pytest.mark.parametrize("way", ways.WAYS.values(), ids=ways.WAYS.keys())
N, K = 300, 4
RNG = np.random.default_rng(0)
V = RNG.normal(size=(N, 3))
REST = affine.phi_so(0.5 * RNG.normal(size=(K, 12)))
CURRENT = affine.phi_so(0.4 * RNG.normal(size=(K, 12))) @ REST
W = weights.partition_of_unity(weights.inverse_distance(weights.distances(V, REST[:, :3, 3])))


def frame(centre, R=None) -> np.ndarray:
    F = np.eye(4)
    F[:3, :3], F[:3, 3] = np.eye(3) if R is None else R, centre
    return F


def moved(A: np.ndarray, p: np.ndarray) -> np.ndarray:
    return p @ A[:3, :3].T + A[:3, 3]


RIGID = frame([1.0, -2.0, 3.0], so3.exp([0.5, -1.1, 0.8]))
AFFINE = affine.phi_so(0.5 * np.random.default_rng(4).normal(size=12))


def solve(
    points: Any = V, rest: Any = REST, current: Any = CURRENT, w: Any = W, origin=None, **others
) -> np.ndarray:
    return probe.solve(probe.prepare(points, rest, w, origin), current, **others).points


@EVERY
@pytest.mark.parametrize("origin", [None, np.zeros(3)], ids=["centre", "world"])
def test_equal_transformations_are_reproduced(way, origin):
    np.testing.assert_allclose(
        solve(current=AFFINE @ REST, way=way, origin=origin), moved(AFFINE, V), atol=1e-13
    )


@EVERY
def test_moved_along_with_all_probes_the_result_moves_along(way):
    result = solve(moved(RIGID, V), RIGID @ REST, RIGID @ CURRENT, way=way)
    np.testing.assert_allclose(result, moved(RIGID, solve(way=way)), atol=1e-13)


@EVERY
@pytest.mark.parametrize("rigid", [False, True])
def test_about_the_origin_of_the_world_only_some_move_along(way, rigid):
    """As `lie.blend` says of A -> G A G^-1: linear and alexa follow, among rigid A also the screws."""
    x = 0.4 * RNG.normal(size=(K, 12))
    x[:, 6:] *= not rigid
    current, zero = affine.phi_so(x) @ REST, np.zeros(3)
    result = solve(moved(RIGID, V), RIGID @ REST, RIGID @ current, way=way, origin=zero)
    gap = np.max(np.abs(result - moved(RIGID, solve(current=current, way=way, origin=zero))))
    follows = way.name in ("linear", "alexa") or (rigid and way.name in ("dual_quaternion", "phi_se"))
    assert gap < 1e-13 if follows else gap > 1e-2


@EVERY
def test_a_whole_weight_gives_that_transformation(way):
    w = np.eye(K)[np.arange(N) % K]
    result = solve(w=w, way=way)
    A = CURRENT @ np.linalg.inv(REST)
    for i in range(K):
        np.testing.assert_allclose(result[i::K], moved(A[i], V[i::K]), atol=1e-13)


@EVERY
def test_one_probe_moved_rigidly_moves_rigidly_where_it_has_all_weight(way):
    w = weights.capped(3.0 * weights.cutoff(weights.distances(V, [[0.0, 0, 0]]), 2.0))
    inside, outside = w[:, 0] == 1.0, w[:, 0] == 0.0
    assert inside.any() and outside.any() and not np.all(inside | outside)
    result = solve(rest=frame([0.0, 0, 0])[None], current=RIGID[None], w=w, way=way)
    np.testing.assert_allclose(result[inside], moved(RIGID, V[inside]), atol=1e-13)
    np.testing.assert_array_equal(result[outside], V[outside])


@EVERY
def test_nothing_moves_nothing(way):
    np.testing.assert_allclose(solve(current=REST, way=way), V, atol=1e-14)
    np.testing.assert_array_equal(solve(w=np.zeros((N, K)), way=way), V)


@pytest.mark.equation("B 7.9", "K 9")
def test_it_is_the_formula():
    """v' = c + sum w t + exp(sum w X) exp(sum w Y) (v - c), written out."""
    B = probe.motions(probe.prepare(V, REST, W), CURRENT)
    params = affine.psi_so(B)
    c = W @ REST[:, :3, 3]
    A = affine.phi_so(W @ params)
    expected = c + np.einsum("nij,nj->ni", A[:, :3, :3], V - c) + A[:, :3, 3]
    np.testing.assert_allclose(solve(), expected, atol=1e-13)
    t = CURRENT[:, :3, 3] - REST[:, :3, 3]
    np.testing.assert_allclose(params[:, 3:6], t, atol=1e-13)


@pytest.mark.equation("B 7.9", "M 5")
@EVERY
def test_about_the_origin_of_the_world_it_is_the_printed_formula(way):
    A = ways.blend(way, W, CURRENT @ np.linalg.inv(REST)).A
    expected = np.einsum("nij,nj->ni", A[:, :3, :3], V) + A[:, :3, 3]
    np.testing.assert_allclose(solve(way=way, origin=[0.0, 0, 0]), expected, atol=1e-13)


@pytest.mark.erratum("B 7.9", "M 5")
def test_the_printed_formula_depends_on_the_origin():
    """A quarter turn at weight 1/2 about a probe at x = 10, of the point (11, 0)."""
    rest, current = frame([10.0, 0, 0])[None], frame([10.0, 0, 0], so3.rotation("z", np.pi / 2))[None]
    half = {"points": [[11.0, 0, 0]], "rest": rest, "current": current, "w": [[0.5]]}
    np.testing.assert_allclose(solve(**half, origin=[0, 0, 0]), [[12.778, 2.778, 0.0]], atol=1e-3)
    np.testing.assert_allclose(solve(**half), [[10 + np.sqrt(0.5), np.sqrt(0.5), 0.0]], atol=1e-14)


def test_dual_quaternions_of_pytransform3d():
    current = frame([0.3, 0, 0.1], so3.exp([0.2, 1.0, -0.7])) @ REST
    other = frame([0.1, 0.5, 0.0], so3.exp([-0.9, 0.1, 0.3])) @ REST
    current[::2] = other[::2]
    A, c = current @ np.linalg.inv(REST), REST[:, :3, 3]
    q = np.array(
        [pt.dual_quaternion_from_transform(frame(-p) @ M @ frame(p)) for M, p in zip(A, c, strict=True)]
    )
    q *= np.where(q[:, :1] < 0.0, -1.0, 1.0)
    result = solve(current=current, way=ways.DUAL_QUATERNION)
    for i in range(0, N, 10):
        total = W[i] @ q / np.linalg.norm((W[i] @ q)[:4])
        total[4:] -= (total[:4] @ total[4:]) * total[:4]
        M = frame(W[i] @ c) @ pt.transform_from_dual_quaternion(total) @ frame(-W[i] @ c)
        np.testing.assert_allclose(result[i], moved(M, V[i]), atol=1e-13)


@EVERY
def test_blocks_and_order_change_nothing(way):
    points = RNG.normal(size=(9001, 3))
    w = weights.partition_of_unity(weights.inverse_distance(weights.distances(points, REST[:, :3, 3])))
    whole = solve(points, w=w, way=way)
    for part in (slice(4090, 4100), slice(0, 1), slice(None, None, -7)):
        np.testing.assert_allclose(solve(points[part], w=w[part], way=way), whole[part], rtol=0, atol=2e-14)
    assert solve(points[:0], w=w[:0], way=way).shape == (0, 3)


def test_separate_weights():
    w = weights.separate(W, np.zeros((N, K)), np.zeros((N, K)))
    B = probe.motions(probe.prepare(V, REST, W), CURRENT)
    x = W @ affine.psi_so(B)[:, :3]
    c = W @ REST[:, :3, 3]
    turned = c + np.einsum("nij,nj->ni", so3.exp(x), V - c)
    np.testing.assert_allclose(solve(w=w), turned, atol=1e-13)
    same = weights.separate(W, W.copy(), W.copy())
    for name in ("phi_so", "phi_se", "polar_quaternion"):
        way = ways.WAYS[name]
        np.testing.assert_allclose(solve(w=same, way=way), solve(way=way), atol=1e-13)
        half = weights.separate(W, W, 0.5 * W)
        np.testing.assert_allclose(solve(current=RIGID @ REST, w=half, way=way), moved(RIGID, V), atol=1e-13)
    # The origins are blended as the translations are, wherever those of rotations would put them.
    other = weights.partition_of_unity(weights.gaussian(weights.distances(V, REST[:, :3, 3]), 0.7))
    for name in ("phi_so", "polar_quaternion"):
        result = solve(current=RIGID @ REST, w=weights.separate(other, W, W), way=ways.WAYS[name])
        np.testing.assert_allclose(result, moved(RIGID, V), atol=1e-13)
    for name in ("linear", "dual_quaternion", "alexa"):
        with pytest.raises(
            ValueError, match=rf"^move\.solve: weights must be one for all: .*three, for {name}\.$"
        ):
            solve(w=same, way=ways.WAYS[name])


@EVERY
@pytest.mark.parametrize("origin", [None, np.zeros(3)], ids=["centre", "world"])
def test_the_transformation_of_each_point_takes_it_to_where_it_goes(way, origin):
    apart = weights.separate(W, 0.5 * W, 0.2 * W)
    for w in (W, apart) if way.parts else (W,):
        prepared = probe.prepare(V, REST, w, origin)
        now, _ = probe.pose(prepared, CURRENT, way)
        found = move.transformations(prepared.anchored, now)
        goes = (found.A @ np.column_stack([V, np.ones(N)])[..., None])[:, :3, 0]
        np.testing.assert_allclose(goes, move.solve(prepared.anchored, now).points, atol=1e-13)
        assert not found.fallback.any()


def test_alexa_counts_what_has_no_logarithm():
    rest = np.stack([frame([0.0, 0, 0]), frame([3.0, 0, 0])])
    current = rest.copy()
    current[0, :3, :3] = np.diag([-1.0, -2.0, 3.0])
    w = weights.cutoff(weights.distances(V, rest[:, :3, 3]), 1.0)
    prepared = probe.prepare(V, rest, w)
    result = probe.solve(prepared, current, ways.ALEXA)
    np.testing.assert_array_equal(result.fallback, w[:, 0] != 0.0)
    assert 0 < result.fallback.sum() < N
    polar = probe.solve(prepared, current, ways.POLAR_QUATERNION)
    np.testing.assert_array_equal(result.points[result.fallback], polar.points[result.fallback])
    assert not polar.fallback.any()
    blend = move.transformations(prepared.anchored, probe.pose(prepared, current, ways.ALEXA)[0])
    np.testing.assert_array_equal(blend.fallback, result.fallback)
    goes = (blend.A @ np.column_stack([V, np.ones(N)])[..., None])[:, :3, 0]
    np.testing.assert_allclose(goes, result.points, atol=1e-13)


# Whole turns.
Z = np.array([0.0, 0.0, 1.0])


def test_stated_turns_are_shared_out():
    rest = np.stack([frame([0.0, 0, 0]), frame([0.0, 0, 4.0])])
    points = np.stack([np.ones(9), np.zeros(9), np.linspace(0.0, 4.0, 9)], axis=1)
    t = points[:, 2] / 4.0
    current = rest.copy()
    current[1, :3, :3] = so3.rotation("z", np.radians(20))
    w = np.stack([1.0 - t, t], axis=1)
    result = solve(points, rest, current, w, turns=[[0, 0, 0], Z])
    angle = np.radians(380) * t
    np.testing.assert_allclose(
        result, np.stack([np.cos(angle), np.sin(angle), points[:, 2]], axis=1), atol=1e-14
    )
    short = solve(points, rest, current, w)
    np.testing.assert_allclose(np.arctan2(short[:, 1], short[:, 0]), np.radians(20) * t, atol=1e-14)
    for name, way in ways.WAYS.items():
        if name != "phi_so":
            with pytest.raises(
                ValueError, match=rf"^probe\.pose: turns must be 0: only phi_so .* for {name}\.$"
            ):
                solve(points, rest, current, w, way=way, turns=[[0, 0, 0], Z])
            solve(points, rest, current, w, way=way, turns=np.zeros((2, 3)))


def test_wound():
    np.testing.assert_allclose(turns.wound(np.zeros(3), 2 * Z), 4 * np.pi * Z)
    np.testing.assert_allclose(turns.wound(0.5 * Z, -Z), (0.5 - 2 * np.pi) * Z)
    np.testing.assert_allclose(turns.wound(-0.5 * Z, Z), (2 * np.pi - 0.5) * Z)
    x = np.random.default_rng(1).normal(size=(20, 3))
    n = np.sign(x @ Z + 1e-9)[:, None] * x / np.linalg.norm(x, axis=1, keepdims=True) * 3.0
    np.testing.assert_allclose(so3.exp(turns.wound(x, n)), so3.exp(x), atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(turns.wound(x, n) - x, axis=1), 6 * np.pi)
    with pytest.raises(
        ValueError, match=r"^turns\.wound: turns must be about the axis of the probe's rotation.*index \(1,\)"
    ):
        turns.wound([[0.5, 0, 0], [0.5, 0, 0]], [[1.0, 0, 0], [0, 1.0, 0]])
    with pytest.raises(
        ValueError, match=r"^turns\.wound: turns must be an axis times a whole number; got length 1\.5"
    ):
        turns.wound(np.zeros(3), 1.5 * Z)


def spun(angles) -> np.ndarray:
    """Poses of two probes, of which the second turns about z."""
    poses = np.broadcast_to(
        np.stack([frame([0.0, 0, 0]), frame([0.0, 0, 4.0])]), (len(angles), 2, 4, 4)
    ).copy()
    poses[:, 1, :3, :3] = so3.exp(np.asarray(angles, float)[:, None] * Z)
    return poses


TWO = spun([0.0])[0]


def test_a_sequence_is_followed_beyond_whole_turns():
    angles = np.radians(np.arange(0, 800, 80))
    prepared = probe.prepare(V, TWO, np.full((N, 2), 0.5))
    track = probe.follow(prepared, spun(angles))
    found = np.array([pose.params[1, :3] for pose in track.poses])
    np.testing.assert_allclose(found, angles[:, None] * Z, atol=1e-13)
    assert track.steps == ()
    result = move.solve(prepared.anchored, track.poses[-1]).points
    angle = 0.5 * angles[-1]
    expected = V - [0, 0, 2.0]
    np.testing.assert_allclose(result, expected @ so3.rotation("z", angle).T + [0, 0, 2.0], atol=1e-13)


def test_long_steps_are_reported_with_frame_and_probe():
    track = probe.follow(probe.prepare(V, TWO, np.full((N, 2), 0.5)), spun(np.radians([0, 80, 200, 280])))
    (step,) = track.steps
    assert (step.frame, step.probe) == (2, 1)
    assert step.angle == pytest.approx(np.radians(120))


def test_a_lift_that_cannot_go_on_is_reported():
    """A turn by 350 degrees whose axis tips over: near |x| = 2 pi x changes more than R."""
    poses = spun(np.radians([0, 80, 160, 240, 320, 350, 350]))
    poses[-1, 1, :3, :3] = so3.exp(np.radians(350) * np.array([np.sin(2.0), 0.0, np.cos(2.0)]))
    track = probe.follow(probe.prepare(V, TWO, np.full((N, 2), 0.5)), poses)
    (step,) = track.steps
    R = poses[-2:, 1, :3, :3]
    assert (step.frame, step.probe) == (6, 1) and step.angle > np.pi / 2
    assert np.linalg.norm(so3.log(R[1] @ R[0].T)) < np.radians(20)


def test_stated_frames_are_as_stated():
    prepared = probe.prepare(V, TWO, np.full((N, 2), 0.5))
    n = np.zeros((3, 2, 3))
    n[1, 1] = 2 * Z
    track = probe.follow(prepared, spun([0.0, 0.5, 0.6]), n)
    np.testing.assert_allclose([p.params[1, 2] for p in track.poses], [0.0, 0.5 + 4 * np.pi, 0.6 + 4 * np.pi])
    assert [(s.frame, s.probe) for s in track.steps] == [(1, 1)]
    told = np.ones((3, 2), dtype=bool)
    back = probe.follow(prepared, spun([0.0, 0.5, 0.6]), n, told)
    np.testing.assert_allclose([p.params[1, 2] for p in back.poses], [0.0, 0.5 + 4 * np.pi, 0.6])
    with pytest.raises(
        ValueError, match=r"^probe\.follow: turns and stated must be for 3 frames of 2 probes"
    ):
        probe.follow(prepared, spun([0.0, 0.5, 0.6]), n[:2])


# What is refused, or replaced.
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0])


@EVERY
def test_inside_out(way):
    current = CURRENT.copy()
    current[2] = CURRENT[2] @ MIRROR
    if way is ways.LINEAR:
        assert np.all(np.isfinite(solve(current=current, way=way)))
    else:
        with pytest.raises(
            ValueError,
            match=r"^orientation\.refuse: A must be .*det > 0; got singular values .*, -.*one of 1 at",
        ):
            solve(current=current, way=way)
    result = probe.solve(probe.prepare(V, REST, W), current, way, policy=orientation.nearest)
    np.testing.assert_array_equal(result.replaced, [False, False, True, False])
    assert np.all(np.isfinite(result.points))
    # A mirrored frame that stays mirrored is no reflection.
    rest = REST @ MIRROR
    np.testing.assert_allclose(
        solve(rest=rest, current=CURRENT @ MIRROR, way=way), solve(way=way), atol=1e-13
    )


def test_policies():
    A = np.broadcast_to(np.eye(4), (6, 4, 4)).copy()
    A[1, :3, :3] = np.diag([1.0, 1.0, -1.0])
    A[2, :3, :3] = np.outer([1.0, 2, 3], [1.0, 0, 1])
    A[3, :3, :3] = np.diag([2.0, 1.0, 0.0])
    A[4, :3, :3] = -np.eye(3)
    A[5, :3, :3] = np.diag([2.0, 1.0, 1e-3])
    with pytest.raises(ValueError, match=r"one of 4 at index \(1,\)"):
        orientation.refuse(A)
    result = orientation.nearest(A)
    np.testing.assert_array_equal(result.replaced, [False, True, True, True, True, False])
    np.testing.assert_array_equal(result.A[[0, 5]], A[[0, 5]])
    np.testing.assert_allclose(result.A[1, :3, :3], np.diag([1.0, 1.0, 1e-3]), atol=1e-15)
    d = np.linalg.svd(result.A[:, :3, :3], compute_uv=False)
    assert np.all(np.linalg.det(result.A) > 0.0) and np.all(d[:, 2] >= 0.9e-3 * d[:, 0] * (np.arange(6) != 5))
    A[2, :3, :3] = 0.0
    with pytest.raises(ValueError, match=r"^orientation\.nearest: A must be different from 0 .*index \(2,\)"):
        orientation.nearest(A)
    assert set(orientation.POLICIES) == {"raise", "nearest"}


def test_quaternions_that_cancel_are_named_by_point():
    rest, w = np.stack([frame([0.0, 0, 0])] * 2), np.zeros((N, 2))
    current = np.stack([frame([0.0, 0, 0], so3.exp([angle, 0, 0])) for angle in (np.pi, 2.8)])
    s, c = np.sin(1.4), np.cos(1.4)
    w[7] = np.array([-s, 1.0]) / (1.0 - s - c)
    with pytest.raises(ValueError, match=r"^move\.solve: weights must be such .*cancel.* at index \(7,\)\.$"):
        solve(rest=rest, current=current, w=w, way=ways.POLAR_QUATERNION)


def changed(a: np.ndarray, index, value) -> np.ndarray:
    b = a.copy()
    b[index] = value
    return b


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"points": changed(V, (3, 1), np.nan)},
            r"move\.prepare: points must be finite; got nan at index \(3,\)",
        ),
        ({"points": V[:, :2]}, r"move\.prepare: points must be an array of shape"),
        ({"points": V[:-1]}, r"move\.prepare: weights must be an array of shape \(299, 4\)"),
        ({"w": W[:, :2]}, r"move\.prepare: weights must be an array of shape \(300, 4\)"),
        ({"w": changed(W, (5, 0), np.inf)}, r"move\.prepare: weights must be finite"),
        (
            {"w": np.tile([1.0, -1.0, 0, 0], (N, 1))},
            r"move\.prepare: weights must be with a sum other than 0 .*300 of 300",
        ),
        ({"w": changed(W, (0, 0), 1e155)}, r"move\.prepare: weights must be at most"),
        ({"rest": REST[0]}, r"probe\.prepare: rest must be an array of shape \(k, 4, 4\)"),
        ({"rest": REST[:0], "w": W[:, :0]}, r"probe\.prepare: rest must be an array of shape \(k, 4, 4\)"),
        (
            {"rest": REST @ np.diag([1.0, 1, 0, 1])},
            r"probe\.prepare: rest must be invertible; got singular values .* at index \(0,\)",
        ),
        ({"rest": np.ones((K, 4, 4))}, r"probe\.prepare: rest must be an affine transformation"),
        (
            {"current": CURRENT[:3]},
            r"probe\.pose: current must be an array of shape \(4, 4, 4\); got shape \(3, 4, 4\)",
        ),
        ({"current": changed(CURRENT, (1, 0, 0), np.nan)}, r"probe\.pose: current must be finite"),
        ({"current": "here"}, r"probe\.pose: current must be real numbers"),
        (
            {"current": np.stack([CURRENT] * 2)},
            r"probe\.pose: current must be an array of shape \(4, 4, 4\)",
        ),
        ({"origin": np.zeros((2, 3))}, r"move\.prepare: weights must be an array of shape \(300, 2\)"),
        ({"origin": [0.0, np.nan, 0]}, r"move\.prepare: origins must be finite"),
        ({"turns": np.zeros((3, 3))}, r"probe\.pose: turns must be of shape \(4, 3\)"),
        ({"turns": np.full((4, 3), np.nan)}, r"probe\.pose: turns must be finite"),
        (
            {"w": 1e4 * W},
            r"move\.solve: weights must be such that their sum is a transformation; got .*overflows at index",
        ),
    ],
)
def test_bad_input(arguments, message):
    with pytest.raises(ValueError, match=rf"^{message}[^\n]*$"):
        solve(**arguments)
