"""Rotation vectors over a graph: what is promised up to 300 degrees, and what is reported beyond."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool.deform import adjacency
from lietool.lie import polar, so3

DEGREES = np.pi / 180.0


def grid(rows: int, columns: int) -> np.ndarray:
    """Pairs of neighbours of a grid that is closed the second way round."""
    k = np.arange(rows * columns).reshape(rows, columns)
    up = np.stack([k[:-1], k[1:]], axis=-1).reshape(-1, 2)
    return np.concatenate([up, np.stack([k, np.roll(k, -1, axis=1)], axis=-1).reshape(-1, 2)])


def chain(n: int) -> np.ndarray:
    return np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)


def thorn(twist: float, rows: int = 120, columns: int = 12, radius: float = 0.5) -> np.ndarray:
    """Rotations of the linear parts of a round thorn along z that is twisted, degrees at its tip.

    p -> R_z(phi(z)) p has the linear part R_z(phi) (I + phi' (e_z x p) e_z^T), whose shear tilts the
    rotation a little about the radius, another radius at each face.
    """
    z, a = np.meshgrid(np.linspace(0.0, 2.5, rows), np.arange(columns) * 2 * np.pi / columns, indexing="ij")
    s = z / 2.5
    phi = twist * DEGREES * s * s * (3.0 - 2.0 * s)
    slope = twist * DEGREES * 6.0 * s * (1.0 - s) / 2.5
    r = radius * (1.0 - 0.9 * s)
    shear = np.broadcast_to(np.eye(3), (*z.shape, 3, 3)).copy()
    shear[..., 0, 2] = -slope * r * np.sin(a)
    shear[..., 1, 2] = slope * r * np.cos(a)
    R = so3.rotation("z", phi) @ shear
    return polar.rotation(R.reshape(-1, 3, 3))


def test_each_vector_is_a_logarithm_and_scipy_agrees():
    R = Rotation.random(50, random_state=3).as_matrix()
    lift = adjacency.consistent(R, chain(50))
    np.testing.assert_allclose(Rotation.from_rotvec(lift.vectors).as_matrix(), R, atol=1e-13)


@pytest.mark.parametrize("largest", [170.0, 250.0, 299.0])
def test_a_field_of_rotations_up_to_300_degrees_is_found_again(largest):
    rows, columns = 40, 16
    rng = np.random.default_rng(5)
    height, round_ = np.meshgrid(np.linspace(0, 1, rows), np.arange(columns), indexing="ij")
    axis = np.stack([0.3 * np.cos(round_ / 16 * 2 * np.pi), 0.3 * np.sin(3.0 * height), 1 + height], axis=-1)
    axis /= np.linalg.norm(axis, axis=-1, keepdims=True)
    x = (axis * (height * largest * DEGREES)[..., None]).reshape(-1, 3)
    shuffled = rng.permutation(len(x))
    pairs = np.argsort(shuffled)[grid(rows, columns)]
    lift = adjacency.consistent(so3.exp(x)[shuffled], pairs)
    np.testing.assert_allclose(lift.vectors, x[shuffled], atol=1e-9)
    assert lift.is_promised and not lift.message
    assert lift.angle.max() == pytest.approx(largest * DEGREES)


def test_the_promise_holds_for_the_worst_steps():
    """Whatever the parent up to 300 degrees and whatever child up to 300 less than 90 from it."""
    rng = np.random.default_rng(0)
    a, c = rng.normal(size=(2, 40_000, 3))
    a, c = (
        v / np.linalg.norm(v, axis=1, keepdims=True) * rng.uniform(100, 300, (len(v), 1)) * DEGREES
        for v in (a, c)
    )
    relative = Rotation.from_rotvec(a).inv() * Rotation.from_rotvec(c)
    # The vectors of the same lift: their quaternions are on one side.
    half = [np.concatenate([np.cos(0.5 * n), np.sin(0.5 * n) * v / n], axis=1) for v, n in (
        (v, np.linalg.norm(v, axis=1, keepdims=True)) for v in (a, c))]  # fmt: skip
    ok = (relative.magnitude() < 90 * DEGREES) & (np.sum(half[0] * half[1], axis=1) > 0)
    a, c = a[ok], c[ok]
    R = so3.exp(np.stack([a, c], axis=1)).reshape(-1, 3, 3)
    k = np.arange(len(a))
    lift = adjacency.consistent(R, np.stack([2 * k, 2 * k + 1], axis=1), seeds=(2 * k).tolist(), near=a)
    assert len(a) > 3_000
    np.testing.assert_allclose(lift.vectors[1::2], c, atol=1e-9)
    # The nearest logarithm alone is not always right: the reason for the quaternions.
    alone, _ = so3.log_near(so3.exp(c), a)
    assert np.any(np.abs(alone - c) > 1.0)


def test_small_steps_are_those_of_log_near():
    rng = np.random.default_rng(8)
    x = np.cumsum(rng.normal(scale=0.05, size=(300, 3)), axis=0)
    R = so3.exp(x)
    lift = adjacency.consistent(R, chain(300), seeds=[0], near=x[:1])
    np.testing.assert_allclose(lift.vectors, so3.log_along(R, x[0]), atol=1e-12)
    np.testing.assert_allclose(lift.vectors, x, atol=1e-9)


@pytest.mark.erratum("K 4.3, 5.3 (text)")
@pytest.mark.parametrize("twist", [380.0, 420.0, 480.0, 540.0])
def test_a_thorn_twisted_by_more_than_a_turn_stays_below_354_degrees(twist):
    R = thorn(twist)
    lift = adjacency.consistent(R, grid(120, 12))
    assert np.rad2deg(lift.angle.max()) < 355.0
    tip = np.rad2deg(lift.angle.reshape(120, 12)[-1])
    np.testing.assert_allclose(tip, abs(720.0 - twist), atol=1.0)
    # It is told: everything above the place where 300 degrees are passed, tips of 180 degrees too.
    assert lift.beyond.reshape(120, 12)[-1].all() and not lift.beyond.reshape(120, 12)[0].any()
    assert "beyond" in lift.message


def test_the_thorn_below_300_degrees_is_promised():
    lift = adjacency.consistent(thorn(260.0), grid(120, 12))
    np.testing.assert_allclose(np.rad2deg(lift.angle.reshape(120, 12)[-1]), 260.0, atol=0.1)
    assert lift.is_promised


def test_a_seed_at_the_tip_states_the_turns():
    R, tip = thorn(540.0), 119 * 12
    lift = adjacency.consistent(R, grid(120, 12), seeds=[0, tip], near=[[0, 0, 0], [0, 0, 540.0 * DEGREES]])
    angle = np.rad2deg(lift.vectors.reshape(120, 12, 3)[..., 2])
    np.testing.assert_allclose(angle[-1], 540.0, atol=1.0)
    assert angle[:40].max() < 270.0
    # Where both meet there is a tear that no choice mends, and it is named.
    assert lift.open.any() and "do not continue" in lift.message


def test_turns_about_one_axis_pass_the_identity_and_go_on():
    angle = np.linspace(0.0, 1000.0, 101) * DEGREES
    lift = adjacency.consistent(so3.rotation("y", angle), chain(101))
    np.testing.assert_allclose(lift.vectors[:, 1], angle, atol=1e-9)
    assert lift.beyond.any()  # right here, but not for every such field


def test_components_seeds_and_turns():
    x = np.zeros((9, 3))
    x[:3, 2], x[3:6, 0], x[6:, 1] = [0.1, 0.2, 0.3], [2.0, 1.5, 1.0], [3.0, 3.3, 3.6]
    pairs = [[0, 1], [1, 2], [4, 3], [5, 4], [6, 7], [7, 8]]
    lift = adjacency.consistent(so3.exp(x), pairs)
    assert sorted(lift.seeds.tolist()) == [0, 5, 8]  # 8 turns by 2.68 the other way
    np.testing.assert_allclose(lift.vectors[:6], x[:6], atol=1e-12)
    np.testing.assert_allclose(lift.vectors[6:], x[6:] - [0, 2 * np.pi, 0], atol=1e-12)
    near = adjacency.turned(x[[1, 6]], [2, 0])
    lift = adjacency.consistent(so3.exp(x), pairs, [1, 6], near)
    np.testing.assert_allclose(lift.vectors[:3] - [0, 0, 4 * np.pi], x[:3], atol=1e-12)
    np.testing.assert_allclose(lift.vectors[6:], x[6:], atol=1e-12)
    assert lift.component.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    assert lift.parent.tolist() == [1, -1, 1, 4, 5, -1, -1, 6, 7]


def test_identities_with_stated_turns_all_turn():
    R = np.broadcast_to(np.eye(3), (5, 3, 3))
    lift = adjacency.consistent(R, chain(5), [2], [[0.0, 4.0 * np.pi, 0.0]])
    np.testing.assert_allclose(lift.vectors, np.tile([0.0, 4.0 * np.pi, 0.0], (5, 1)), atol=1e-14)
    assert not adjacency.consistent(R, chain(5)).vectors.any()


def test_a_loop_that_does_not_close_is_reported():
    """Round a ring the rotations make one full turn: no choice is continuous."""
    n = 24
    R = so3.rotation("z", np.arange(n) * 2 * np.pi / n)
    ring = np.concatenate([chain(n), [[n - 1, 0]]])
    lift = adjacency.consistent(R, ring)
    assert lift.open.sum() == 1 and "1 pairs of neighbours" in lift.message
    assert adjacency.consistent(R, chain(n)).open.sum() == 0


def test_a_step_of_more_than_90_degrees_is_gone_round_where_possible():
    x = np.array([[0, 0, 0.0], [0, 0, 1.2], [0, 0, 2.4], [0, 0, 3.6]])
    pairs = [[0, 3], [0, 1], [1, 2], [2, 3]]
    lift = adjacency.consistent(so3.exp(x), pairs)
    np.testing.assert_allclose(lift.vectors, x, atol=1e-12)
    assert lift.apart[0] > np.pi / 2 and not lift.beyond.any()
    over = adjacency.consistent(so3.exp(x[[0, 3]]), [[0, 1]])
    assert over.beyond.tolist() == [False, True]


def test_rounding_decides_neither_seeds_nor_ways():
    """Quarter turns and equal rotations, in axes that make other last bits of them."""
    quarter = so3.rotation("x", 0.5 * np.pi)
    R = np.stack([so3.rotation("z", 0.3), quarter, quarter, so3.rotation("x", 0.3), so3.rotation("z", 0.3)])
    R[2] = R[1] @ so3.rotation("y", 0.5 * np.pi)
    pairs = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0], [0, 2], [1, 3]]
    wanted = adjacency.consistent(R, pairs)
    for Q in Rotation.random(40, random_state=3).as_matrix():
        lift = adjacency.consistent(Q @ R @ Q.T, pairs)
        assert lift.seeds.tolist() == wanted.seeds.tolist() == [0]
        assert lift.parent.tolist() == wanted.parent.tolist()
        assert lift.beyond.tolist() == wanted.beyond.tolist()
        np.testing.assert_allclose(lift.vectors, wanted.vectors @ Q.T, atol=1e-12)


def test_rotations_at_random_end():
    R = Rotation.random(3000, random_state=1).as_matrix()
    lift = adjacency.consistent(R, grid(300, 10))
    assert not lift.is_promised
    np.testing.assert_allclose(so3.exp(lift.vectors), R, atol=1e-12)


def test_the_order_of_nodes_does_not_matter_and_results_repeat():
    R, pairs = thorn(290.0), grid(120, 12)
    first, second = (adjacency.consistent(R, pairs) for _ in range(2))
    assert np.array_equal(first.vectors, second.vectors)
    p = np.random.default_rng(2).permutation(len(R))
    mixed = adjacency.consistent(R[p], np.argsort(p)[pairs])
    np.testing.assert_allclose(mixed.vectors, first.vectors[p], atol=1e-12)


def test_face_pairs():
    F = [[0, 1, 2], [2, 1, 3], [4, 5, 6]]
    assert adjacency.face_pairs(F).tolist() == [[0, 1]]
    # Three faces at one edge are all joined.
    assert adjacency.face_pairs([[0, 1, 2], [1, 0, 3], [0, 1, 4]]).tolist() == [[0, 1], [1, 2]]


def test_turned():
    np.testing.assert_allclose(adjacency.turned([0, 0, 1.0], -1), [0, 0, 1.0 - 2 * np.pi])
    assert adjacency.turned(np.zeros((2, 3)), 0).shape == (2, 3)
    with pytest.raises(ValueError, match=r"adjacency.turned: x must be a rotation with an axis; got 0"):
        adjacency.turned([0, 0, 0.0], 1)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((np.ones((2, 3, 3)), [[0, 1]]), "R must be a rotation"),
        ((np.full((2, 3, 3), np.nan), [[0, 1]]), "R must be finite"),
        ((np.eye(3), [[0, 1]]), r"R must be an array of shape \(m, 3, 3\)"),
        ((np.stack([np.eye(3)] * 2), [[0, 2]]), r"pairs must be nodes, 0 to 1; got \[0, 2\] at index \(0,\)"),
        ((np.stack([np.eye(3)] * 2), [[0.0, 1.0]]), "pairs must be whole numbers"),
        ((np.stack([np.eye(3)] * 2), [[0, 1]], [5]), "seeds must be nodes, 0 to 1; got 5"),
        ((np.stack([np.eye(3)] * 2), [[0, 1]], [0, 0]), "seeds must be different"),
        ((np.stack([np.eye(3)] * 2), [[0, 1]], None, [[0, 0, 1.0]]), "near must be given with seeds"),
        ((np.stack([np.eye(3)] * 2), [[0, 1]], [0], [0, 0, 1.0]), r"near must be an array of shape \(1, 3\)"),
        ((np.stack([np.eye(3)] * 2), [[0, 1]], [0], [[0, np.nan, 1.0]]), "near must be finite"),
    ],
)
def test_bad_input_is_named(arguments, says):
    with pytest.raises(ValueError, match=rf"^adjacency.consistent: {says}"):
        adjacency.consistent(*arguments)
