"""Distances by heat: against exact ones on a sphere and in the plane, with the error stated."""

import igl
import numpy as np
import pytest

from lietool.mesh import geodesic


def sphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    V, F = igl.icosahedron()
    for _ in range(level):
        V, F = igl.upsample(V, F, 1)
        V /= np.linalg.norm(V, axis=1, keepdims=True)
    return V, F.astype(np.intp)


def disc(k: int) -> tuple[np.ndarray, np.ndarray]:
    """A square of even triangles, rows shifted by half a side."""
    x, y = np.meshgrid(np.arange(k) / k, np.arange(k) * np.sqrt(0.75) / k, indexing="ij")
    x = x + 0.5 / k * (np.arange(k) % 2)
    i = np.arange(k * k).reshape(k, k)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    even = (np.arange(k - 1) % 2 == 0)[None, :, None]
    first = np.where(even, np.stack([a, b, d], -1), np.stack([a, b, c], -1))
    second = np.where(even, np.stack([b, c, d], -1), np.stack([a, c, d], -1))
    V = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    return V, np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])


@pytest.mark.parametrize(("level", "worst", "mean"), [(3, 0.05, 0.025), (4, 0.03, 0.012)])
def test_on_a_sphere_the_error_is_a_percent_and_halves_with_the_edges(level, worst, mean):
    V, F = sphere(level)
    exact = np.arccos(np.clip(V @ V[5], -1, 1))
    error = np.abs(geodesic.heat(V, F, [5]) - exact) / np.pi
    assert error.max() <= worst and error.mean() <= mean


def test_in_the_plane_the_boundary_does_not_bend_distances():
    V, F = disc(41)
    middle = int(np.argmin(np.linalg.norm(V - V.mean(axis=0), axis=1)))
    exact = np.linalg.norm(V - V[middle], axis=1)
    error = np.abs(geodesic.heat(V, F, [middle]) - exact) / exact.max()
    # Of heat that may not cross the boundary alone the largest error is 0.027, of lost heat alone 0.087.
    assert error.mean() <= 0.007 and error.max() <= 0.016


def test_sets_are_solved_together_and_the_nearest_source_counts():
    V, F = sphere(3)
    prepared = geodesic.prepare(V, F)
    both = geodesic.solve(prepared, [[5], [9, 200]])
    assert both.shape == (len(V), 2)
    np.testing.assert_allclose(both[:, 0], geodesic.heat(V, F, [5]), atol=1e-10)
    exact = np.arccos(np.clip(np.max(V @ V[[9, 200]].T, axis=1), -1, 1))
    assert np.abs(both[:, 1] - exact).mean() <= 0.04 * np.pi
    assert both[[9, 200], 1].max() <= 0.02 and both[5, 0] == 0.0
    assert both.min() == 0.0


def test_size_and_place_of_the_shape_do_not_matter():
    V, F = sphere(2)
    found = geodesic.heat(V, F, [3])
    np.testing.assert_allclose(geodesic.heat(1e-6 * V, F, [3]), 1e-6 * found, atol=1e-15)
    np.testing.assert_allclose(geodesic.heat(1e6 * V + 1e6, F, [3]), 1e6 * found, rtol=1e-6, atol=1e-3)


def test_other_parts_and_lone_vertices_are_infinitely_far():
    V, F = sphere(2)
    n = len(V)
    W = np.vstack([V, 0.1 * V, [[5.0, 5, 5]]])
    G = np.vstack([F, F + n])
    prepared = geodesic.prepare(W, G)
    found = geodesic.solve(prepared, [[3], [3, n + 4], [2 * n]])
    np.testing.assert_allclose(found[:n, 0], geodesic.heat(V, F, [3]), atol=0.02)
    assert np.isinf(found[n:, 0]).all()
    assert np.isfinite(found[: 2 * n, 1]).all() and np.isinf(found[-1, 1])
    assert found[-1, 2] == 0.0 and np.isinf(found[:-1, 2]).all()


def test_a_strip_of_thousands_of_edges_still_has_distances():
    # Heat after the usual time would be 0 beyond 745 edges.
    k = 3000
    x = np.repeat(np.arange(k, dtype=float), 2)
    V = np.stack([x, np.tile([0.0, 1.0], k), 0 * x], axis=1)
    i = 2 * np.arange(k - 1)[:, None]
    F = np.vstack([i + np.array([0, 2, 1]), i + np.array([1, 2, 3])])
    found = geodesic.heat(V, F, [0, 1])
    assert np.abs(found - x).max() <= 0.01 * k


def test_a_crowded_edge_is_no_obstacle():
    V, F = disc(12)
    V = np.vstack([V, [[0.5, 0.5, 0.4]]])
    a, b = F[60, 0], F[60, 1]
    found = geodesic.heat(V, np.vstack([F, [[a, b, len(V) - 1]]]), [0])
    assert np.isfinite(found).all() and found[-1] > 0.3


def test_broken_arguments_are_refused():
    V, F = sphere(1)
    for sources, message in [
        ([], "at least one vertex; got none"),
        ([len(V)], f"indices of the {len(V)} vertices, from 0; got {len(V)}"),
        ([0.5], "whole numbers"),
    ]:
        with pytest.raises(ValueError, match=rf"^geodesic.solve: sources\[0\] must be [^\n]*{message}"):
            geodesic.heat(V, F, sources)
    with pytest.raises(ValueError, match="at least one set of vertices; got none"):
        geodesic.solve(geodesic.prepare(V, F), [])
    with pytest.raises(
        ValueError, match=r"^geodesic.prepare: F must be triangles with an area; got area 0 in face"
    ):
        geodesic.heat(V, np.vstack([F, [[0, 0, 1]]]), [0])


def test_a_mesh_of_needles_is_refused_by_this_name():
    V, F = sphere(2)
    V += 0.1 * np.random.default_rng(1).normal(size=V.shape)
    with pytest.raises(ValueError, match=r"^geodesic\.prepare: F must be triangles [^\n]* so thin [^\n]*$"):
        geodesic.prepare(V * [1e-8, 1e-8, 1.0], F)
