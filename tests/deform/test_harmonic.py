"""Weights of handles: against libigl, and what is true of harmonic functions."""

import igl
import numpy as np
import pytest

from lietool.deform import harmonic
from lietool.mesh import laplacian

KINDS = pytest.mark.parametrize(("order", "kind"), [(1, harmonic.harmonic), (2, harmonic.biharmonic)])


def sphere(level: int = 3) -> tuple[np.ndarray, np.ndarray]:
    V, F = igl.icosahedron()
    for _ in range(level):
        V, F = igl.upsample(V, F, 1)
        V /= np.linalg.norm(V, axis=1, keepdims=True)
    return V, F.astype(np.intp)


HANDLES = [[0, 12, 13], [100], [300, 301]]


@KINDS
@pytest.mark.parametrize("stretch", [(1, 1, 1), (1, 4, 0.5)])
def test_weights_are_libigls(order, kind, stretch):
    V, F = sphere()
    V = V * stretch
    b = np.concatenate(HANDLES)
    values = np.repeat(np.eye(3), [3, 1, 2], axis=0)
    theirs = igl.harmonic(V, F, b.astype(np.int64), values, order)
    np.testing.assert_allclose(kind(V, F, HANDLES), theirs, atol=1e-12 if order == 1 else 1e-8)


@KINDS
def test_weights_reproduce_constants_and_are_1_and_0_at_handles(order, kind):
    V, F = sphere()
    W = kind(V * [1, 4, 0.5], F, HANDLES)
    assert np.abs(W.sum(axis=1) - 1).max() <= 1e-10
    for k, handle in enumerate(HANDLES):
        assert np.array_equal(W[handle], np.tile(np.eye(3)[k], (len(handle), 1)))


def test_harmonic_weights_obey_the_maximum_principle_where_no_cotangent_weight_is_negative():
    V, F = sphere()
    L = laplacian.cotangent(V, F)
    assert (L - np.diag(L.diagonal())).max() <= 1e-14
    W = harmonic.harmonic(V, F, HANDLES)
    assert W.min() >= 0.0 and W.max() <= 1.0
    free = np.setdiff1d(np.arange(len(V)), np.concatenate(HANDLES))
    assert W[free].min() > 0.0 and W[free].max() < 1.0


def test_given_values_are_extended_by_the_same_factor():
    V, F = sphere()
    prepared = harmonic.prepare_harmonic(V, F, HANDLES)
    values = np.array([[0.0], [1.0], [2.0], [5.0], [-1.0], [0.5]])
    x = harmonic.extend(prepared, values)
    assert np.array_equal(x[prepared.factor.fixed], values)
    assert x.min() >= -1.0 and x.max() <= 5.0
    W = harmonic.weights(prepared)
    by_handle = np.array([[1.0], [2.0], [3.0]])
    np.testing.assert_allclose(
        harmonic.extend(prepared, by_handle[prepared.handle]), W @ by_handle, atol=1e-12
    )


def two_parts() -> tuple[np.ndarray, np.ndarray, int]:
    V, F = sphere(2)
    n = len(V)
    return np.vstack([V, 0.3 * V + [0, 0, 1.5], [[0, 0, -4.0]]]), np.vstack([F, F + n]), n


@KINDS
def test_a_part_without_a_handle_is_refused_by_a_vertex_of_it(order, kind):
    V, F, n = two_parts()
    with pytest.raises(
        ValueError,
        match=rf"in every connected part; got 2 of 3 without one, with vertex {n}, {2 * n}\. Give",
    ):
        kind(V, F, [[0], [5]])


@KINDS
def test_or_it_follows_what_is_nearest(order, kind):
    V, F, n = two_parts()
    top, bottom = int(np.argmax(V[:n, 2])), int(np.argmin(V[:n, 2]))
    W = harmonic.follow(V, F, [[0], [5]], kind)
    np.testing.assert_allclose(W[:n], kind(V[:n], F[: len(F) // 2], [[0], [5]]), atol=1e-13)
    assert np.array_equal(W[n : 2 * n], np.tile(W[top], (n, 1)))
    assert np.array_equal(W[-1], W[bottom])
    lone = harmonic.follow(V, F, [[2 * n]], kind)
    assert np.array_equal(lone, np.ones((len(V), 1)))
    both = harmonic.follow(V, F, [[0], [n]], kind)
    assert np.array_equal(both[:n, 0], np.ones(n)) or np.allclose(both[:n, 0], 1.0, atol=1e-12)


def test_handles_may_be_vertices_that_no_face_uses():
    V, F, n = two_parts()
    W = harmonic.harmonic(V, F, [[0], [5, 2 * n], [n + 3]])
    assert W[-1].tolist() == [0, 1, 0] and np.allclose(W[n : 2 * n, 2], 1.0)


def test_broken_handles_are_refused():
    V, F = sphere(1)
    for handles, message in [
        ([], "handles must be at least one set of vertices; got none"),
        ([[0], []], r"handles\[1\] must be at least one vertex; got none"),
        ([[0], [0]], "handles must be disjoint; got vertex 0 twice, in handles 0 and 1"),
        ([[0, 0]], "handles must be disjoint; got vertex 0 twice, in handles 0 and 0"),
        ([[len(V)]], rf"handles\[0\] must be indices of the {len(V)} vertices, from 0; got {len(V)}"),
        ([[-1]], r"handles\[0\] must be indices of the 42 vertices, from 0; got -1"),
        ([[0, 1.5]], r"handles\[0\] must be whole numbers of shape \(k,\); got float64"),
        ([[0, [1, 2]]], r"handles\[0\] must be whole numbers of shape \(k,\); got a ragged list"),
    ]:
        with pytest.raises(ValueError, match=rf"^harmonic\.prepare_harmonic: {message}[^\n]*$"):
            harmonic.harmonic(V, F, handles)
    with pytest.raises(ValueError, match=r"^harmonic.prepare_biharmonic: F must be triangles with an area"):
        harmonic.biharmonic(V, np.vstack([F, [[0, 1, 1]]]), [[0]])
