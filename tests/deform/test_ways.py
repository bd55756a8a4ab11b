"""The ways as parameters: what they encode comes back, and they blend as lie.blend and pytransform3d do."""

import numpy as np
import pytest
from pytransform3d import transformations as pt

from lietool.deform import orientation, ways
from lietool.lie import affine, blend, so3

EVERY = pytest.mark.parametrize("way", ways.WAYS.values(), ids=ways.WAYS.keys())
ORIENTED = pytest.mark.parametrize(
    "way", [way for way in ways.WAYS.values() if way is not ways.LINEAR], ids=lambda way: way.name
)


def transformations(batch, size: float = 0.4, seed: int = 0) -> np.ndarray:
    return affine.phi_so(size * np.random.default_rng(seed).normal(size=(*batch, 12)))


def partition(batch, k: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).dirichlet(np.ones(k), size=batch)


NO_LOG = np.diag([-1.0, -2.0, 3.0, 1.0])


@EVERY
def test_what_is_encoded_comes_back(way):
    A = transformations((4, 5))
    params, able = way.encode(A)
    assert params.shape == (4, 5, way.width)
    assert able.all()
    np.testing.assert_allclose(way.decode(params), A, atol=2e-14)


@EVERY
def test_the_identity_is_zero_and_a_weight_of_zero_is_the_identity(way):
    np.testing.assert_array_equal(way.encode(np.eye(4))[0], np.zeros(way.width))
    B = ways.blend(way, np.zeros((6, 3)), transformations((3,)))
    np.testing.assert_array_equal(B.A, np.broadcast_to(np.eye(4), (6, 4, 4)))


@EVERY
def test_one_whole_weight_gives_that_transformation(way):
    A = transformations((3,))
    B = ways.blend(way, np.eye(3), A)
    np.testing.assert_allclose(B.A, A, atol=2e-14)
    assert not B.fallback.any()


@pytest.mark.equation("B 7.9", "K 9", "M 5")
@pytest.mark.parametrize("name", ["linear", "alexa", "phi_so", "phi_se"])
def test_it_is_the_blend_of_the_lie_package(name):
    A, w = transformations((20, 3)), partition(20, 3)
    np.testing.assert_allclose(ways.blend(ways.WAYS[name], w, A).A, blend.WAYS[name](w, A), atol=1e-14)


def test_dual_quaternions_blend_as_those_of_the_lie_package_where_the_signs_are_the_same():
    A, w = transformations((20, 3), 0.3), partition(20, 3)
    B = ways.blend(ways.DUAL_QUATERNION, w, A).A
    np.testing.assert_allclose(B, blend.polar_dual_quaternion(w, A), atol=1e-14)


def test_dual_quaternions_blend_as_in_pytransform3d():
    rng = np.random.default_rng(3)
    x = np.concatenate([rng.normal(size=(30, 6)), np.zeros((30, 6))], axis=1)
    A, w = affine.phi_so(x).reshape(10, 3, 4, 4), partition(10, 3)
    B = ways.blend(ways.DUAL_QUATERNION, w, A).A
    for i in range(10):
        q = np.array([pt.dual_quaternion_from_transform(M) for M in A[i]])
        q *= np.where(q[:, :1] < 0.0, -1.0, 1.0)
        total = w[i] @ q
        # What pytransform3d makes of a dual quaternion that is not of length 1 is not the motion meant.
        z, u = total[:4] / np.linalg.norm(total[:4]), total[4:] / np.linalg.norm(total[:4])
        expected = pt.transform_from_dual_quaternion(np.concatenate([z, u - (z @ u) * z]))
        np.testing.assert_allclose(B[i], expected, atol=1e-14)


def test_polar_quaternion_is_the_normalised_sum():
    """The issue's words: q = (1 - sum w) 1 + sum w_i q_i, Re q_i >= 0; S = I + sum w_i (S_i - I)."""
    angles = np.array([0.5, 2.5])
    A = np.broadcast_to(np.eye(4), (2, 4, 4)).copy()
    A[:, :3, :3] = so3.exp(angles[:, None] * np.array([0.0, 0.0, 1.0])) * np.array([1.0, 2.0])[:, None, None]
    w = np.array([0.3, 0.4])
    B = ways.blend(ways.POLAR_QUATERNION, w, A).A
    q = (1.0 - w.sum()) + np.sum(w * np.exp(0.5j * angles))
    scale = 1.0 + w[1] * 1.0
    np.testing.assert_allclose(B[:2, :2], scale * so3.rotation("z", 2.0 * np.angle(q))[:2, :2], atol=1e-15)


@EVERY
def test_the_kernel_that_moves_points_is_the_matrix(way):
    A, rng = transformations((50,)), np.random.default_rng(5)
    params, v = way.encode(A)[0], rng.normal(size=(50, 3))
    moved = np.array(way.kernel(np.ascontiguousarray(params.T), list(v.T))).T
    np.testing.assert_allclose(moved, np.einsum("nij,nj->ni", A[:, :3, :3], v) + A[:, :3, 3], atol=1e-13)


@EVERY
def test_a_batch_is_its_elements(way):
    A, w = transformations((2, 5, 3)), partition((2, 5), 3)
    whole = ways.blend(way, w, A)
    for i in np.ndindex(2, 5):
        np.testing.assert_allclose(ways.blend(way, w[i], A[i]).A, whole.A[i], rtol=0, atol=4e-15)
    shared = ways.blend(way, w, A[0, 0])
    each = ways.blend(way, w, np.broadcast_to(A[0, 0], (2, 5, 3, 4, 4)))
    np.testing.assert_allclose(shared.A, each.A, rtol=0, atol=4e-15)
    assert ways.blend(way, w[:0], A[:0]).A.shape == (0, 5, 4, 4)


def test_rotations_beyond_a_half_turn_are_summed_by_phi_so():
    params = np.zeros((2, 12))
    params[1, 2] = 4.0 * np.pi
    A = ways.mix(ways.PHI_SO, [[0.75, 0.25], [0.875, 0.125], [0.0, 1.0]], params)
    for angle, M in zip([np.pi, np.pi / 2, 0.0], A, strict=True):
        np.testing.assert_allclose(M[:3, :3], so3.rotation("z", angle), atol=1e-15)


@pytest.mark.parametrize("batched", [False, True])
def test_alexa_without_a_logarithm_is_given_the_polar_blend_where_it_counts(batched):
    other = transformations((), seed=2)
    A, w = np.stack([NO_LOG, other]), np.array([[0.5, 0.5], [0.0, 1.0], [1.0, 0.0], [0.0, 0.0]])
    B = ways.blend(ways.ALEXA, w, np.broadcast_to(A, (4, 2, 4, 4)) if batched else A)
    np.testing.assert_array_equal(B.fallback, [True, False, True, False])
    polar = ways.blend(ways.POLAR_QUATERNION, w, A).A
    np.testing.assert_array_equal(B.A[B.fallback], polar[B.fallback])
    np.testing.assert_allclose(B.A[1], other, atol=1e-14)
    np.testing.assert_allclose(B.A[2], NO_LOG, atol=1e-14)
    assert ways.blend(ways.ALEXA, w[0], A).fallback.shape == ()


@ORIENTED
@pytest.mark.parametrize("L", [np.diag([1.0, 1.0, -1.0]), np.zeros((3, 3)), np.diag([1.0, 0.0, 1.0])])
def test_reflections_and_flat_ones_are_refused(way, L):
    A = np.broadcast_to(np.eye(4), (3, 4, 4)).copy()
    A[1, :3, :3] = L
    with pytest.raises(
        ValueError, match=rf"^ways\.{way.name}: A must be .*det > 0.* at index \(1,\)\.[^\n]*$"
    ):
        way.encode(A)
    mended = A.copy()
    if np.any(L):
        mended = orientation.nearest(A).A
        assert way.encode(mended)[1].shape == (3,)


@EVERY
@pytest.mark.parametrize(
    ("weights", "words"),
    [([0.5, np.nan], "finite"), ([0.5], "shape"), (np.ones((2, 2, 2)), None), ([[1e155, 0.0]], "at most")],
)
def test_bad_weights(way, weights, words):
    A = transformations((3, 2))
    words = words or "broadcast"
    with pytest.raises(ValueError, match=rf"^ways\.{way.name}: [^\n]*{words}[^\n]*$"):
        ways.blend(way, weights, A)


@EVERY
@pytest.mark.parametrize(
    "A", [np.full((2, 4, 4), np.nan), np.ones((2, 4, 4)), np.eye(3), np.zeros((0, 4, 4)), "x"]
)
def test_bad_matrices(way, A):
    with pytest.raises(ValueError, match=rf"^ways\.{way.name}: A must [^\n]*$"):
        ways.blend(way, [0.5, 0.5], A)


@pytest.mark.parametrize("way", [ways.POLAR_QUATERNION, ways.DUAL_QUATERNION], ids=lambda way: way.name)
def test_quaternions_that_cancel_are_refused(way):
    A = np.broadcast_to(np.eye(4), (2, 4, 4)).copy()
    A[:, :3, :3] = so3.exp([[np.pi, 0.0, 0.0], [2.8, 0.0, 0.0]])
    s, c = np.sin(1.4), np.cos(1.4)
    w = 1.0 / (1.0 - s - c)  # then 1 - w1 - w2 + w1 i + w2 (c + s i) = 0
    with pytest.raises(ValueError, match=rf"^ways\.{way.name}: params must be such [^\n]*at index \(1,\)"):
        ways.blend(way, [[1.0, 0.0], [-w * s, w]], A)


@pytest.mark.parametrize("way", [ways.PHI_SO, ways.PHI_SE, ways.ALEXA], ids=lambda way: way.name)
def test_overflow_is_refused(way):
    with pytest.raises(ValueError, match=rf"^ways\.{way.name}: params must be such [^\n]*overflows"):
        ways.blend(way, [1e5], np.diag([3.0, 3.0, 3.0, 1.0])[None])


def test_ways_are_asked_for_by_name():
    assert ways.named("phi_so") is ways.PHI_SO
    with pytest.raises(ValueError, match=r"^ways\.named: name must be one of linear, .*; got 'phi'\.$"):
        ways.named("phi")
    assert [way.name for way in ways.WAYS.values() if way.whole_turns] == ["phi_so"]


@EVERY
def test_the_linear_part_alone_is_that_of_the_matrix(way):
    A = transformations((4, 5))
    params = 0.8 * way.encode(A)[0]
    np.testing.assert_allclose(way.decode_linear(params), way.decode(params)[..., :3, :3], atol=1e-15)
