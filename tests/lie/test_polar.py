"""A = R S and A = U diag(d) V^T at any condition number and scale."""

import itertools

import mpmath
import numpy as np
import pytest
from scipy.linalg import polar as scipy_polar

from lietool.lie import polar, so2, so3, sym


def rotations(n: int, count: int) -> np.ndarray:
    rng = np.random.default_rng(count)
    return so2.exp(rng.uniform(-3, 3, count)) if n == 2 else so3.exp(rng.normal(size=(count, 3)))


def hard(n: int) -> np.ndarray:
    d = [(1, 1, 1), (1, 1 + 1e-15, 1), (1, 1 + 1e-9, 1), (2, 1, 1 - 1e-8), (3, 2, 1)]
    d += [t for c in (1e2, 1e6, 1e12) for t in ((c, 1, 1), (c, c, 1), (c, c**0.5, 1))]
    d += [(s, 3 * s, 1e-12 * s) for s in (1e-50, 1e50)]
    d = np.array(d)[:, :n]
    U, V = rotations(n, 6), rotations(n, 7)[:6]
    A = (U[:, None] * d[:, None, :]) @ np.swapaxes(V, -1, -2)[:, None]
    return np.concatenate([A.reshape(-1, n, n), np.eye(n) * d[:, None, :]])


def size(A: np.ndarray) -> np.ndarray:
    return np.max(np.abs(A), axis=(-1, -2), keepdims=True)


def assert_rotation(R: np.ndarray):
    n = R.shape[-1]
    np.testing.assert_allclose(np.swapaxes(R, -1, -2) @ R, np.broadcast_to(np.eye(n), R.shape), atol=2e-15)
    assert np.all(np.linalg.det(R) > 0.0)


@pytest.mark.equation("B 3.11", "B 3.12")
@pytest.mark.parametrize("n", [2, 3])
def test_both_orders_rebuild_the_matrix_and_share_the_rotation(n):
    A = hard(n)
    R, S = polar.decompose(A)
    T, Q = polar.decompose_left(A)
    assert_rotation(R)
    np.testing.assert_array_equal(R, Q)
    np.testing.assert_allclose(R @ S / size(A), A / size(A), atol=4e-15)
    np.testing.assert_allclose(T @ R / size(A), A / size(A), atol=4e-15)
    np.testing.assert_allclose(T / size(A), R @ S @ np.swapaxes(R, -1, -2) / size(A), atol=6e-15)
    np.testing.assert_array_equal(S, np.swapaxes(S, -1, -2))


@pytest.mark.equation("B 3.13", "B 3.14")
@pytest.mark.parametrize("n", [2, 3])
def test_singular_values_and_vectors(n):
    A = hard(n)
    U, d, V = polar.svd(A)
    assert_rotation(U)
    assert_rotation(V)
    assert np.all(np.diff(d, axis=-1) <= 0.0)
    np.testing.assert_allclose(
        (U * d[:, None, :]) @ np.swapaxes(V, -1, -2) / size(A), A / size(A), atol=4e-15
    )
    np.testing.assert_allclose(d / d[:, :1], np.linalg.svd(A, compute_uv=False) / d[:, :1], atol=4e-15)


@pytest.mark.parametrize("n", [2, 3])
def test_small_singular_values_keep_their_digits(n):
    """Of a matrix with columns of very different length, they are as exact as the large ones."""
    rng = np.random.default_rng(8)
    for scale in ((1.0, 1e-12, 1e-6), (1e-12, 1e-3, 1.0)):
        A = rng.normal(size=(5, n, n)) * np.array(scale)[:n]
        A[:, :, 0] *= np.sign(np.linalg.det(A))[:, None]
        d = polar.svd(A)[1]
        with mpmath.workdps(50):
            for a, value in zip(A, d, strict=True):
                exact = sorted(mpmath.svd_r(mpmath.matrix(a.tolist()), compute_uv=False), reverse=True)
                relative = [
                    abs(float((mpmath.mpf(float(v)) - e) / e)) for v, e in zip(value, exact, strict=True)
                ]
                assert max(relative) <= 2e-14


@pytest.mark.parametrize("n", [2, 3])
def test_numbers_that_have_lost_bits_are_still_taken_apart(n):
    one, tiny = np.eye(n), 5e-324
    A = np.stack([tiny * one, 1e-320 * (one + 1.0), 1e-315 * (one + 1.0), 1e-310 * (one + 1.0)])
    U, d, V = polar.svd(A, check=False)
    assert_rotation(U)
    assert_rotation(V)
    assert np.array_equal(d[0], np.full(n, tiny))
    np.testing.assert_allclose(U * d[..., None, :] @ V.swapaxes(-1, -2), A, rtol=0, atol=n * n * tiny)


def test_scipy_agrees():
    A = np.random.default_rng(5).normal(size=(30, 3, 3))
    A[np.linalg.det(A) < 0] *= -1.0
    for a in A:
        R, S = scipy_polar(a)
        for ours, theirs in zip(polar.decompose(a), (R, S), strict=True):
            np.testing.assert_allclose(ours, theirs, atol=1e-13)
        np.testing.assert_allclose(polar.decompose(a)[1], sym.sqrt(a.T @ a), atol=1e-12)


@pytest.mark.erratum("B 3.3.3 (text)")
def test_svd_from_polar_has_the_transpose():
    """A = (R' R) D R^T; the text prints (R' R) D R."""
    A = 3.0 * rotations(3, 4)[0] @ np.diag((1.0, 0.5, 0.1)) @ rotations(3, 5)[0]
    rotation, S = polar.decompose(A)
    d, R = np.linalg.eigh(S)
    np.testing.assert_allclose(rotation @ R @ np.diag(d) @ R.T, A, atol=1e-14)
    assert np.max(np.abs(rotation @ R @ np.diag(d) @ R - A)) > 0.5


@pytest.mark.erratum("B 3.13 (text)")
def test_diagonalisation_is_unique_but_for_order_and_signs():
    R, D = rotations(3, 4)[0], np.diag((3.0, 2.0, 1.0))
    other = R @ np.diag((-1.0, -1.0, 1.0))
    assert_rotation(other)
    np.testing.assert_allclose(other @ D @ other.T, R @ D @ R.T, atol=2e-15)
    assert np.max(np.abs(other - R)) > 0.5


def test_matrices_with_an_axis_of_their_own():
    # Zeros let a sweep exchange columns without turning any, and so pass over a pair.
    rng = np.random.default_rng(12)
    M = np.eye(2) + 0.4 * rng.normal(size=(1500, 2, 2))
    M = M[np.linalg.det(M) > 0.05]
    A = np.zeros((len(M), 3, 3))
    A[:, 0, 0], A[:, 1:, 1:] = rng.uniform(0.5, 2.0, len(M)), M
    orders = np.array(list(itertools.permutations(range(3))))
    A = np.concatenate([A[:, order][:, :, order] for order in orders])
    R, S = polar.decompose(A)
    assert_rotation(R)
    np.testing.assert_allclose(R @ S, A, atol=1e-14)
    theirs = np.stack([scipy_polar(a)[1] for a in A[::40]])
    np.testing.assert_allclose(S[::40], theirs, atol=1e-13)
    U, d, V = polar.svd(A)
    np.testing.assert_allclose(d, np.linalg.svd(A, compute_uv=False), atol=1e-14)
    np.testing.assert_allclose((U * d[:, None, :]) @ np.swapaxes(V, -1, -2), A, atol=1e-14)


@pytest.mark.parametrize("n", [2, 3])
def test_nearest_rotation_beats_all_others(n):
    rng = np.random.default_rng(6)
    A = rng.normal(size=(12, n, n))  # of both orientations
    A[0, :, 0] = 0.0  # a projection: no determinant at all
    R = polar.rotation(A)
    assert_rotation(R)
    best = np.sum((A - R) ** 2, axis=(-1, -2))
    for Q in rotations(n, 300):
        assert np.all(np.sum((A - Q) ** 2, axis=(-1, -2)) >= best - 1e-13)
    with pytest.raises(ValueError, match=r"one nearest rotation; got singular values 0, 0.* at index \(1,\)"):
        polar.rotation(np.stack([np.eye(n), np.zeros((n, n))]))
    flipped = np.eye(n)
    flipped[0, 0] = -1.0
    with pytest.raises(ValueError, match="one nearest rotation"):
        polar.rotation(flipped)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("f", [polar.decompose, polar.decompose_left, polar.svd])
def test_no_positive_determinant(f, n):
    A = np.tile(np.eye(n), (2, 3, 1, 1))
    A[1, 2, 0, 0] = -2.0
    with pytest.raises(
        ValueError, match=rf"polar.{f.__name__}: A must .*det > 0; got det = -2 at index \(1, 2\)"
    ):
        f(A)
    A[1, 2] = 0.0
    with pytest.raises(ValueError, match=r"got det = 0 at index \(1, 2\)"):
        f(A)
