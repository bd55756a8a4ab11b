"""The errors E^P, E^F, E^S, E^R: by their definitions, by a generic minimiser, and by their kernels."""

import numpy as np
import pytest
from scipy.optimize import minimize

from lietool.interp import energy, triangle

RNG = np.random.default_rng(0)
A, B = RNG.normal(size=(2, 40, 2, 2))
CORNERS = RNG.normal(size=(40, 3, 2))
J = np.array([[0.0, -1.0], [1.0, 0.0]])
ALL = (energy.POINT, energy.FROBENIUS, energy.POINT_SIMILARITY, energy.SIMILARITY, energy.balanced(0.3))


def similar(x):
    return x[0] * np.eye(2) + x[1] * J


def moved(M, p):
    return np.einsum("...ij,...kj->...ki", M, p - p.mean(axis=-2, keepdims=True))


def least(f):
    return minimize(f, [0.0, 0.0], tol=1e-13).fun


class TestDefinitions:
    @pytest.mark.equation("B 6.1")
    def test_points(self):
        expected = np.sum((moved(B, CORNERS) - moved(A, CORNERS)) ** 2, axis=(1, 2))
        assert energy.error(B, A, energy.POINT, CORNERS) == pytest.approx(expected)

    @pytest.mark.equation("B 6.2")
    def test_frobenius(self):
        assert energy.error(B, A) == pytest.approx(np.sum((A - B) ** 2, axis=(1, 2)))

    @pytest.mark.equation("B 6.3")
    def test_points_up_to_similarity(self):
        found = energy.error(B, A, energy.POINT_SIMILARITY, CORNERS)
        for k in range(12):
            b, p = moved(B[k], CORNERS[k]), CORNERS[k]
            expected = least(lambda x, b=b, k=k, p=p: np.sum((b - moved(similar(x) @ A[k], p)) ** 2))
            assert found[k] == pytest.approx(expected, abs=1e-9)

    @pytest.mark.equation("B 6.4")
    def test_frobenius_up_to_similarity(self):
        found = energy.error(B, A, energy.SIMILARITY)
        for k in range(12):
            expected = least(lambda x, k=k: np.sum((B[k] - similar(x) @ A[k]) ** 2))
            assert found[k] == pytest.approx(expected, abs=1e-9)

    @pytest.mark.equation("B 6.5")
    def test_the_closed_form(self):
        M = B @ np.swapaxes(A, 1, 2)
        forgiven = (np.sum(M**2, axis=(1, 2)) + 2.0 * np.linalg.det(M)) / np.sum(A**2, axis=(1, 2))
        expected = np.sum(B**2, axis=(1, 2)) - forgiven
        assert energy.error(B, A, energy.SIMILARITY) == pytest.approx(expected)

    def test_balanced(self):
        w = np.linspace(0.0, 1.0, 40)
        rigid, loose = energy.error(B, A), energy.error(B, A, energy.SIMILARITY)
        assert energy.error(B, A, energy.balanced(w)) == pytest.approx(w * rigid + (1.0 - w) * loose)

    @pytest.mark.parametrize("w", [-0.1, 1.1, np.nan])
    def test_a_share_that_is_none(self, w):
        with pytest.raises(ValueError, match=r"energy.balanced: w must be"):
            energy.balanced(w)


class TestLaws:
    @pytest.mark.erratum("B 6.1, 6.3")
    def test_where_the_shape_lies_does_not_matter(self):
        for error in (energy.POINT, energy.POINT_SIMILARITY):
            here = energy.error(B, A, error, CORNERS)
            assert energy.error(B, A, error, CORNERS + np.array([300.0, -50.0])) == pytest.approx(
                here, rel=1e-8
            )
        # As printed, with the corners as they lie, it does.
        printed = [
            np.sum(np.einsum("nij,nkj->nki", A - B, CORNERS + shift) ** 2, axis=(1, 2))
            for shift in (0.0, 5.0)
        ]
        assert np.abs(printed[0] - printed[1]).min() > 0.1

    @pytest.mark.parametrize("error", ALL)
    def test_nothing_is_negative_and_the_aim_costs_nothing(self, error):
        assert energy.error(B, A, error, CORNERS).min() > 0.0
        assert energy.error(A, A, error, CORNERS).max() < 1e-13

    @pytest.mark.erratum("B 6.5")
    def test_similarities_cost_nothing(self):
        turned = similar((0.7, -1.9)) @ A
        for error in (energy.SIMILARITY, energy.POINT_SIMILARITY):
            assert energy.error(turned, A, error, CORNERS).max() < 1e-12
        assert energy.error(turned, A).min() > 0.1

    def test_the_kernel_has_two_dimensions(self):
        for error, rank in ((energy.FROBENIUS, 4), (energy.POINT, 4), (energy.SIMILARITY, 2)):
            for k in range(5):
                a = np.stack(triangle.coordinates(A[k : k + 1]))
                form = energy.form(error, energy.metric(error, CORNERS[k : k + 1]), a)
                Q = np.array(
                    [[form.first[0], form.mixed[0]], [np.conj(form.mixed[0]), form.second[0]]], complex
                )
                assert pytest.approx(np.conj(Q.T)) == Q
                values = np.linalg.eigvalsh(Q)
                # A complex dimension is two real ones.
                assert 2 * int(np.sum(values > 1e-12)) == rank
                if error is energy.SIMILARITY:
                    # |x|^2 is half of the Frobenius norm: 0, 0, 2, 2 of the printed form.
                    assert values == pytest.approx([0.0, 2.0], abs=1e-12)

    @pytest.mark.parametrize("error", ALL)
    def test_batches(self, error):
        one = energy.error(B[3], A[3], error, CORNERS[3])
        assert one == pytest.approx(energy.error(B, A, error if error is not ALL[4] else ALL[4], CORNERS)[3])
        many = energy.error(
            B.reshape(4, 10, 2, 2), A.reshape(4, 10, 2, 2), error, CORNERS.reshape(4, 10, 3, 2)
        )
        assert many.shape == (4, 10)

    def test_points_need_corners(self):
        with pytest.raises(ValueError, match="corners must be given"):
            energy.error(B, A, energy.POINT)
