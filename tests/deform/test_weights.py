"""Weights from distances, and their sums."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from lietool.deform import weights

RNG = np.random.default_rng(0)
POINTS, CENTRES = RNG.normal(size=(5000, 3)), RNG.normal(size=(4, 3))
R = weights.distances(POINTS, CENTRES)


def test_distances_are_scipys_and_go_block_by_block():
    np.testing.assert_allclose(R, cdist(POINTS, CENTRES), rtol=1e-14)
    np.testing.assert_array_equal(weights.distances(POINTS[4090:4100], CENTRES), R[4090:4100])
    assert weights.distances(np.zeros((0, 3)), CENTRES).shape == (0, 4)


def test_inverse_distance():
    np.testing.assert_allclose(weights.inverse_distance(R), R**-2.0, rtol=1e-14)
    np.testing.assert_allclose(weights.inverse_distance(R, 3.5), R**-3.5, rtol=1e-13)


def test_at_a_probe_it_has_all_weight():
    w = weights.partition_of_unity(weights.inverse_distance(weights.distances(CENTRES, CENTRES)))
    np.testing.assert_allclose(w, np.eye(4), atol=1e-15)
    both = weights.partition_of_unity(weights.inverse_distance([[0.0, 0.0, 1.0]]))
    np.testing.assert_allclose(both, [[0.5, 0.5, 0.0]], atol=1e-15)


def test_shepard_is_the_inverse_distance_as_a_partition_of_unity():
    w = weights.shepard(POINTS, CENTRES, 2.5)
    want = weights.distances(POINTS, CENTRES) ** -2.5
    np.testing.assert_allclose(w, want / want.sum(axis=1, keepdims=True), rtol=1e-12)
    np.testing.assert_allclose(weights.shepard(CENTRES, CENTRES), np.eye(len(CENTRES)), atol=1e-15)


def test_what_is_infinitely_far_has_no_weight():
    r = np.array([[1.0, np.inf], [np.inf, np.inf]])
    np.testing.assert_array_equal(weights.inverse_distance(r), [[1.0, 0.0], [0.0, 0.0]])
    np.testing.assert_array_equal(weights.cutoff(r, 2.0), [[0.25, 0.0], [0.0, 0.0]])
    np.testing.assert_array_equal(weights.gaussian(r, 1.0) > 0.0, [[True, False], [False, False]])


def test_cutoff_falls_from_one_to_nothing_at_the_reach():
    r = np.array([[0.0], [0.5], [1.0], [2.0], [3.0]])
    np.testing.assert_allclose(weights.cutoff(r, 2.0, 3.0), [[1.0], [0.75**3], [0.125], [0.0], [0.0]])
    each = weights.cutoff(np.ones((1, 2)), [2.0, 4.0], 1.0)
    np.testing.assert_allclose(each, [[0.5, 0.75]])


def test_gaussian():
    w = weights.gaussian(R, [1.0, 2.0, 0.5, 1.5])
    np.testing.assert_allclose(w, np.exp(-0.5 * (R / [1.0, 2.0, 0.5, 1.5]) ** 2), rtol=1e-14)


def test_sums():
    w = RNG.uniform(size=(50, 4))
    np.testing.assert_array_equal(weights.unnormalised(w), w)
    for normal in (weights.partition_of_unity, weights.softmax):
        np.testing.assert_allclose(normal(w).sum(axis=1), 1.0, rtol=1e-15)
        assert np.all(normal(w) > 0.0)
    np.testing.assert_allclose(
        weights.softmax(w, 3.0)[:, 0] / weights.softmax(w, 3.0)[:, 1], np.exp(3 * (w[:, 0] - w[:, 1]))
    )
    np.testing.assert_allclose(weights.softmax([[1e5, 0.0]]), [[1.0, 0.0]])
    capped = weights.capped(w)
    more = w.sum(axis=1) > 1.0
    assert 0 < more.sum() < 50
    np.testing.assert_array_equal(capped[~more], w[~more])
    np.testing.assert_allclose(capped[more], weights.partition_of_unity(w)[more])
    np.testing.assert_array_equal(weights.capped(np.zeros((2, 3))), np.zeros((2, 3)))
    assert set(weights.NORMALISATIONS) == {"none", "partition_of_unity", "softmax", "capped"}


@pytest.mark.parametrize("normal", weights.NORMALISATIONS.values(), ids=weights.NORMALISATIONS.keys())
def test_arguments_are_left_alone(normal):
    w = RNG.uniform(size=(7, 2))
    before = w.copy()
    assert not np.shares_memory(normal(w), w)
    np.testing.assert_array_equal(w, before)
    assert normal(np.zeros((0, 2))).shape == (0, 2)


def test_separate_weights():
    w = weights.separate(*RNG.uniform(size=(3, 5, 2)))
    assert not w.shared
    with pytest.raises(ValueError, match=r"^weights\.separate: stretch must be an array of shape \(5, 2\)"):
        weights.separate(w.rotation, w.translation, w.stretch[:, :1])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: weights.distances([[0, 0, np.nan]], CENTRES), r"weights\.distances: points must be finite"),
        (
            lambda: weights.distances([[0.0, 0]], CENTRES),
            r"weights\.distances: points must be an array of shape",
        ),
        (
            lambda: weights.distances([0.0, 0, 0], CENTRES),
            r"weights\.distances: points must be an array of shape \(n, 3\)",
        ),
        (
            lambda: weights.distances(POINTS, np.zeros((0, 3))),
            r"weights\.distances: centres must be of shape .*k >= 1",
        ),
        (
            lambda: weights.inverse_distance([[1.0, -1.0]]),
            r"weights\.inverse_distance: distances must be 0 or more; got -1\.0 at index \(0, 1\)",
        ),
        (
            lambda: weights.inverse_distance([[np.nan]]),
            r"weights\.inverse_distance: distances must be 0 or more; got nan",
        ),
        (
            lambda: weights.inverse_distance([1.0]),
            r"weights\.inverse_distance: distances must be an array of shape",
        ),
        (lambda: weights.inverse_distance([[1.0]], 0.0), r"weights\.inverse_distance: power must be above 0"),
        (
            lambda: weights.inverse_distance([[1.0]], np.nan),
            r"weights\.inverse_distance: power must be finite",
        ),
        (
            lambda: weights.inverse_distance([[1.0]], []),  # pyright: ignore
            r"weights\.inverse_distance: power must be one number; got shape \(0,\)",
        ),
        (lambda: weights.inverse_distance([[1e-9, 1.0]], 40.0), r"weights\.inverse_distance: .* overflow"),
        (lambda: weights.cutoff([[1.0]], 0.0), r"weights\.cutoff: reach must be above 0; got 0\.0"),
        (lambda: weights.cutoff([[1.0]], [1.0, 2.0]), r"weights\.cutoff: reach must be one number or 1"),
        (lambda: weights.gaussian([[1.0]], -1.0), r"weights\.gaussian: width must be above 0"),
        (lambda: weights.softmax([[1.0]], -1.0), r"weights\.softmax: sharpness must be above 0"),
        (
            lambda: weights.partition_of_unity([[1.0, 1.0], [0.0, 0.0]]),
            r"weights\.partition_of_unity: w must be weights .* 1 of 2 points, first at index \(1,\)",
        ),
        (
            lambda: weights.partition_of_unity([[1.0, -1.0]]),
            r"weights\.partition_of_unity: .* sum other than 0",
        ),
        (lambda: weights.capped([[np.inf]]), r"weights\.capped: w must be finite"),
        (lambda: weights.capped(np.zeros((3, 0))), r"weights\.capped: w must be an array of shape"),
        (lambda: weights.unnormalised("x"), r"weights\.unnormalised: w must be real numbers"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=rf"^{message}[^\n]*$"):
        call()
