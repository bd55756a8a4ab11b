"""The laws of every group of rotations, on batches, at ordinary, tiny and nearly straight angles."""

from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lietool.lie import quaternion, so2, so3


class Group(NamedTuple):
    module: ModuleType
    dimension: int  # 0 where the algebra is written as plain numbers
    matrix: bool


GROUPS = {
    "so2": Group(so2, 0, True),
    "so3": Group(so3, 3, True),
    "quaternion": Group(quaternion, 3, False),
}
LENGTHS = {"ordinary": 1.3, "tiny": 1e-9, "near pi": np.pi - 1e-9, "zero": 0.0}
BATCHES = [(), (4,), (2, 3)]

each_group = pytest.mark.parametrize("group", GROUPS.values(), ids=GROUPS.keys())
each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_length = pytest.mark.parametrize("length", LENGTHS.values(), ids=LENGTHS.keys())
matrix_groups = pytest.mark.parametrize("name", ["so2", "so3"])


def vectors(group: Group, batch: tuple[int, ...], length: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    if not group.dimension:
        return length * rng.choice([-1.0, 1.0], size=batch)
    x = rng.normal(size=(*batch, group.dimension))
    return length * x / np.linalg.norm(x, axis=-1, keepdims=True)


def times(group: Group, g, h):
    return g @ h if group.matrix else quaternion.multiply(g, h)


def one(group: Group) -> np.ndarray:
    return np.eye(group.dimension or 2) if group.matrix else np.array([1.0, 0, 0, 0])


def apply(Ad, x):
    return Ad * x if Ad.ndim == x.ndim else np.einsum("...ij,...j->...i", Ad, x)


@each_group
@each_batch
@each_length
def test_log_undoes_exp(group, batch, length):
    x = vectors(group, batch, length)
    np.testing.assert_allclose(group.module.log(group.module.exp(x)), x, rtol=0, atol=1.2e-15 * length)


@each_group
@each_batch
@each_length
def test_exp_undoes_log(group, batch, length):
    g = group.module.exp(vectors(group, batch, length))
    np.testing.assert_allclose(group.module.exp(group.module.log(g)), g, rtol=0, atol=2e-15)


@each_group
@each_batch
@each_length
def test_associative_with_one_and_inverse(group, batch, length):
    f, g, h = (group.module.exp(vectors(group, batch, length, seed)) for seed in (1, 2, 3))
    left, right = times(group, times(group, f, g), h), times(group, f, times(group, g, h))
    np.testing.assert_allclose(left, right, atol=1e-15)
    unit = np.broadcast_to(one(group), f.shape)
    np.testing.assert_allclose(times(group, f, group.module.inverse(f)), unit, atol=1e-15)
    np.testing.assert_allclose(times(group, group.module.inverse(f), f), unit, atol=1e-15)
    np.testing.assert_array_equal(times(group, unit, f), f)


@each_group
@each_batch
@each_length
def test_exp_of_a_line_is_a_subgroup(group, batch, length):
    """(4.8)."""
    x = vectors(group, batch, length)
    exp = group.module.exp
    np.testing.assert_allclose(exp(1.7 * x), times(group, exp(0.6 * x), exp(1.1 * x)), atol=3e-15)
    np.testing.assert_allclose(exp(-x), group.module.inverse(exp(x)), atol=1e-15)


@each_group
@each_batch
def test_exp_of_a_sum_is_not_the_product(group, batch):
    """(4.9) fails, but in the commutative group; (4.10) holds for commuting arguments."""
    x, y = vectors(group, batch, 1.0, 1), vectors(group, batch, 1.0, 2)
    exp = group.module.exp
    gap = np.max(np.abs(exp(x + y) - times(group, exp(x), exp(y))))
    assert gap < 1e-15 if not group.dimension else gap > 1e-2


@each_batch
@each_length
@matrix_groups
def test_adjoint(name, batch, length):
    """(4.11): R exp(X) R^-1 = exp(R X R^-1) = exp(hat(Ad x))."""
    group = GROUPS[name]
    module = group.module
    R = module.exp(vectors(group, batch, length, 1))
    S = module.exp(vectors(group, batch, 0.8, 2))
    x = vectors(group, batch, 0.7, 3)
    Ad = module.adjoint(R)
    np.testing.assert_allclose(R @ module.hat(x) @ module.inverse(R), module.hat(apply(Ad, x)), atol=1e-15)
    np.testing.assert_allclose(R @ module.exp(x) @ module.inverse(R), module.exp(apply(Ad, x)), atol=2e-15)
    both = apply(module.adjoint(R @ S), x)
    np.testing.assert_allclose(both, apply(Ad, apply(module.adjoint(S), x)), atol=1e-15)


@each_batch
@each_length
@matrix_groups
def test_left_jacobian_and_its_inverse(name, batch, length):
    """exp(x + d) = exp(J d) exp(x) to first order; J fixes x and so does its inverse."""
    group = GROUPS[name]
    module = group.module
    x, d = vectors(group, batch, length, 1), vectors(group, batch, 1e-5, 2)
    J, K = module.left_jacobian(x), module.left_jacobian_inverse(x)
    step = module.log(module.exp(x + d) @ module.inverse(module.exp(x - d))) / 2
    np.testing.assert_allclose(apply(J, d), step, atol=2e-15)
    np.testing.assert_allclose(apply(K, apply(J, d)), d, atol=1e-20)
    np.testing.assert_allclose(apply(J, x), x, atol=2e-15)
    np.testing.assert_allclose(apply(K, x), x, atol=2e-15)


@each_batch
@matrix_groups
def test_hat_vee_act_and_what_a_rotation_leaves_in_place(name, batch):
    group = GROUPS[name]
    module = group.module
    x, R = vectors(group, batch, 1.1, 1), module.exp(vectors(group, batch, 2.0, 2))
    assert np.array_equal(module.vee(module.hat(x)), x)
    n = group.dimension or 2
    p = np.random.default_rng(5).normal(size=(*batch, n))
    np.testing.assert_allclose(module.act(R, p), (R @ p[..., None])[..., 0], atol=1e-15)
    if n == 3:
        np.testing.assert_allclose((module.hat(x) @ p[..., None])[..., 0], np.cross(x, p), atol=1e-15)
        np.testing.assert_allclose(module.act(module.exp(x), x), x, atol=1e-15)
        np.testing.assert_allclose((module.hat(x) @ x[..., None])[..., 0], 0, atol=1e-15)


coordinates = st.floats(-3.0, 3.0, allow_nan=False)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.tuples(coordinates, coordinates, coordinates), st.sampled_from([1.0, 1e-5, 1e-12, 1e-200]))
def test_rotations_and_quaternions_on_whatever_hypothesis_finds(x, scale):
    x = scale * np.array(x)
    R, q = so3.exp(x), quaternion.exp(0.5 * x)
    np.testing.assert_allclose(quaternion.to_matrix(q), R, atol=2e-15)
    np.testing.assert_allclose(so3.exp(so3.log(R)), R, atol=2e-15)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-15)
    theta = np.linalg.norm(x)
    if theta < np.pi - 1e-12:
        np.testing.assert_allclose(so3.log(R), x, rtol=0, atol=2e-15 * theta + 1e-320)
    # Beside the spheres |x| = 2 pi n every direction gives nearly the identity, and R forgets the axis.
    sine = abs(np.sin(theta / 2))
    if theta < 1.0 or sine > 1e-6:
        near, distance = so3.log_near(R, x)
        np.testing.assert_allclose(
            near, x, rtol=0, atol=2e-15 * theta / (1.0 if theta < 1.0 else sine) + 1e-320
        )
        assert distance <= 1e-8
