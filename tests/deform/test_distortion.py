"""Distortion against singular values that are known, and what is called flipped."""

import numpy as np
import pytest

from lietool.deform import distortion
from lietool.lie import so3

V = np.array([[0, 0, 0], [2, 0, 0], [3, 2, 0], [0, 1.5, 0], [1.4, 0.8, 0.3], [1, 3, 0.2]], float)
F = np.array([[0, 1, 4], [1, 2, 4], [2, 5, 4], [5, 3, 4], [3, 0, 4]])


def turn(*x: float) -> np.ndarray:
    return so3.exp(np.array(x))


def test_nothing_happens_to_a_moved_mesh():
    found = distortion.measure(V, F, V @ turn(1.0, 2.0, -0.5).T + [3.0, -1.0, 7.0])
    for value in (found.largest, found.smallest, found.area, found.angle, found.worst, found.inverse):
        np.testing.assert_allclose(value, 1.0, rtol=1e-14)
    assert not found.collapsed.any()


def test_singular_values_are_those_of_the_maps_with_normals():
    rng = np.random.default_rng(1)
    U = V + 0.4 * rng.normal(size=V.shape)
    found = distortion.measure(V, F, U)
    for k, (a, b, c) in enumerate(F):
        ends = []
        for W in (V, U):
            u, v = W[b] - W[a], W[c] - W[a]
            n = np.cross(u, v)
            ends.append(np.stack([u, v, n / np.sqrt(np.linalg.norm(n))], axis=1))
        d = np.linalg.svd(ends[1] @ np.linalg.inv(ends[0]), compute_uv=False)
        s1, s2 = found.largest[k], found.smallest[k]
        np.testing.assert_allclose(d, [s1, np.sqrt(s1 * s2), s2], rtol=1e-13)


@pytest.mark.parametrize("squeeze", [1e-9, 1e-5, 0.3])
def test_a_thin_face_keeps_its_digits(squeeze):
    flat = V * [1.0, 1.0, 0.0]
    R = turn(0.3, 0.2, 0.9)
    found = distortion.measure(flat, F, (flat * [2.0, squeeze, 1.0]) @ R.T)
    np.testing.assert_allclose(found.largest, 2.0, rtol=1e-9)
    np.testing.assert_allclose(found.smallest, squeeze, rtol=1e-6)
    np.testing.assert_allclose(found.area, 2.0 * squeeze, rtol=1e-6)


def test_collapsed_faces_are_infinite_and_never_nan():
    U = V.copy()
    U[4] = U[0]
    found = distortion.measure(V, F, U)
    assert list(found.collapsed) == [True, False, False, False, True]
    assert np.isinf(found.inverse[0]) and np.isinf(found.angle[0])
    nowhere = distortion.measure(V, F, np.zeros_like(V))
    assert nowhere.collapsed.all() and np.isinf(nowhere.angle).all() and (nowhere.area == 0.0).all()
    assert not np.isnan([list(vars(s).values()) for s in nowhere.summary().values()]).any()


def test_summaries_weigh_by_area():
    found = distortion.summarise([1.0, 2.0, 10.0], [1.0, 8.0, 1.0])
    assert (found.least, found.median, found.most_of, found.most) == (1.0, 2.0, 10.0, 10.0)
    assert found.mean == pytest.approx(2.7)
    assert distortion.summarise([1.0, 5.0], [1.0, 0.0]).most == 1.0


def sheet(n: int) -> tuple[np.ndarray, np.ndarray]:
    i, j = np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij")
    a = (i * n + j).ravel()
    faces = np.concatenate([np.stack([a, a + n, a + 1], 1), np.stack([a + 1, a + n, a + n + 1], 1)])
    x = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), -1).reshape(-1, 2)
    return np.concatenate([x, np.zeros((n * n, 1))], 1).astype(float), faces


def test_a_vertex_pushed_through_an_edge_flips_the_faces_that_it_turns_over():
    P, T = sheet(6)
    U = P.copy()
    U[14] += [1.4, 0.0, 0.0]  # past its neighbour
    turned = np.cross(U[T[:, 1]] - U[T[:, 0]], U[T[:, 2]] - U[T[:, 0]])[:, 2] < 0.0
    assert 0 < turned.sum() <= 3
    R = turn(0.4, -1.0, 2.0)
    for W in (U, U @ R.T + 5.0):
        np.testing.assert_array_equal(distortion.flipped_by_neighbours(P, T, W), turned)
    guide = np.broadcast_to(R, (len(T), 3, 3))
    np.testing.assert_array_equal(distortion.flipped_against(P, T, U @ R.T, guide), turned)
    # Across a fold one face is turned over and the other not.
    pairs = distortion.folds(P, T, U)
    assert len(pairs) and (turned[pairs].sum(axis=1) == 1).all()


def test_a_patch_that_is_turned_over_is_seen_against_a_guide_and_by_its_rim():
    P, T = sheet(9)
    U = P.copy()
    inner = np.flatnonzero((np.abs(P[:, 0] - 4) <= 2) & (np.abs(P[:, 1] - 4) <= 2))
    U[inner, 0] = 8.0 - P[inner, 0]
    turned = np.cross(U[T[:, 1]] - U[T[:, 0]], U[T[:, 2]] - U[T[:, 0]])[:, 2] < 0.0
    against = distortion.flipped_against(P, T, U, np.broadcast_to(np.eye(3), (len(T), 3, 3)))
    np.testing.assert_array_equal(against, turned)
    assert distortion.flipped_by_neighbours(P, T, U).sum() < turned.sum()
    assert len(distortion.folds(P, T, U))


def test_a_fold_is_one_that_both_faces_see():
    """Two faces of which one alone points away from where the other's rotation takes its normal."""
    rest = np.array([[-0.27, -1.56, -0.38], [0.51, 0.59, -1.03], [0.3, 1.16, 1.76], [-0.7, -0.86, 0.05]])
    now = np.array([[-2.93, -0.53, -0.27], [-0.46, -1.58, -0.25], [-0.78, 0.76, -0.92], [-0.28, -0.23, 0.57]])
    pair = np.array([[0, 1, 2], [1, 0, 3]])
    assert distortion.flipped_by_neighbours(rest, pair, now).tolist() == [False, True]
    assert not len(distortion.folds(rest, pair, now))


def test_bending_and_twisting_flip_nothing():
    P, T = sheet(9)
    angle = 0.6 * P[:, 0]
    U = np.stack([np.sin(angle), P[:, 1], 1.0 - np.cos(angle)], axis=1)
    assert not distortion.flipped_by_neighbours(P, T, U).any()
    assert not len(distortion.folds(P, T, U))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"deformed": V[:-1]}, r"deformed must be 6 vertices, as many as at rest; got 5"),
        ({"deformed": np.where(V == 2.0, np.nan, V)}, r"deformed must be finite; got .* vertex 1"),
        ({"rest": V * [1.0, 0.0, 0.0]}, r"F must be triangles with an area; got area 0 in faces? 0, 1, 2"),
        ({"deformed": V * 1e80}, r"deformed must be at most 1e\+70 in size; got 3e\+80"),
        ({"rest": V * 1e80}, r"rest must be at most 1e\+70 in size"),
        ({"F": F + 2}, r"F must be indices of the 6 vertices"),
        ({"F": F[:0]}, r"F must be at least one triangle"),
    ],
)
def test_bad_input_is_refused_by_name(change, message):
    given = {"rest": V, "F": F, "deformed": V} | change
    for f in (distortion.measure, distortion.flipped_by_neighbours, distortion.folds):
        with pytest.raises(ValueError, match=rf"^distortion\.{f.__name__}: {message}[^\n]*$"):
            f(**given)
    with pytest.raises(ValueError, match="guide must be finite"):
        distortion.flipped_against(V, F, V, np.full((5, 3, 3), np.nan))
    for values, weights in (
        ([np.nan], [1.0]),
        ([1.0], [0.0]),
        ([1.0], [-1.0]),
        ([], []),
        ([1.0], [1.0, 2.0]),
    ):
        with pytest.raises(ValueError, match=r"^distortion\.summarise: "):
            distortion.summarise(values, weights)
