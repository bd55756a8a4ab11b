"""The energies written out in x and y: they are those of maps, and have the kernels that they should have."""

import numpy as np
import pytest

from lietool.interp import constraint, energy, forms, shape, triangle

RNG = np.random.default_rng(2)
CORNERS, MOVED = RNG.normal(size=(2, 20, 3, 2))
A = RNG.normal(size=(20, 2, 2))
J = np.array([[0.0, -1.0], [1.0, 0.0]])


def linear(p, v):
    return triangle.affine_map(p, v)[..., :2, :2]


class TestFrobenius:
    @pytest.mark.equation("B 6.2")
    def test_it_is_the_sum_of_the_errors(self, bent):
        P, Q, F = bent
        weights, v = RNG.uniform(0.5, 2.0, len(F)), P + RNG.normal(size=P.shape)
        wanted = shape.local_maps(P, Q, F)
        G, u = forms.matrix(P, F, weights), forms.pull(P, F, weights, wanted)
        x = v.ravel()
        c = weights @ np.sum(wanted**2, axis=(1, 2))
        error = weights @ energy.error(linear(P[F], v[F]), wanted)
        assert x @ G @ x + x @ u + c == pytest.approx(error, rel=1e-12)

    def test_it_leaves_nothing_open_but_where_the_shape_is(self, bent):
        P, _, F = bent
        G = forms.matrix(P, F, np.ones(len(F)))
        sizes = np.linalg.eigvalsh(G)
        assert np.abs(sizes[:2]).max() < 1e-12 < 1e-3 < sizes[2]
        assert np.abs(G @ np.tile([3.0, -2.0], len(P))).max() < 1e-11 and np.array_equal(G, G.T)

    def test_many_maps_have_many_right_sides(self, bent):
        P, Q, F = bent
        wanted = triangle.logexp(shape.local_maps(P, Q, F), [0.2, 0.7])
        both = forms.pull(P, F, np.ones(len(F)), wanted)
        assert both.shape == (2, 2 * len(P))
        assert np.abs(both[1] - forms.pull(P, F, np.ones(len(F)), wanted[1])).max() < 1e-12

    @pytest.mark.parametrize(
        ("weights", "maps", "named"), [(1, 2, "weights"), (2, 3, "A"), (2, 1, "A")], ids=str
    )
    def test_what_does_not_fit_is_refused(self, weights, maps, named):
        P, F = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]), [[0, 1, 2], [1, 3, 2]]
        with pytest.raises(ValueError, match=f"forms.pull: {named} must"):
            forms.pull(P, F, np.ones(weights), np.ones((maps, 2, 2)))

    def test_a_flat_triangle_is_refused(self):
        with pytest.raises(ValueError, match=r"forms.matrix: P must be a triangle with area"):
            forms.matrix([[0.0, 0], [1, 0], [2, 0]], [[0, 1, 2]], [1.0])


class TestSimilarity:
    @pytest.mark.equation("B 6.4", "B 6.5")
    def test_it_is_the_least_error_over_similarities(self):
        Q, v = forms.similarity(CORNERS, A), MOVED.reshape(-1, 6)
        error = energy.error(linear(CORNERS, MOVED), A, energy.SIMILARITY)
        assert np.einsum("mi,mij,mj->m", v, Q, v) == pytest.approx(error, abs=1e-10, rel=1e-10)

    def test_translations_and_similar_shapes_cost_nothing(self):
        Q = forms.similarity(CORNERS, A)
        similar = CORNERS @ np.swapaxes(A, -1, -2) @ (0.3 * np.eye(2) + 2.0 * J) + [5.0, -1.0]
        size = np.abs(Q).max(axis=(1, 2))
        assert (np.abs(np.einsum("mij,mj->mi", Q, similar.reshape(-1, 6))).max(axis=1) < 1e-12 * size).all()
        sizes = np.linalg.eigvalsh(Q) / size[:, None]
        assert np.abs(sizes[:, :4]).max() < 1e-13 and sizes[:, 4].min() > 1e-4

    def test_batches_go_together(self):
        Q = forms.similarity(CORNERS[:3], A[:2, None])
        assert Q.shape == (2, 3, 6, 6)
        assert np.abs(Q[1, 2] - forms.similarity(CORNERS[2], A[1])).max() < 1e-10

    def test_a_map_that_is_0_is_refused(self):
        with pytest.raises(ValueError, match=r"forms.similarity: A must be a map that is not 0"):
            forms.similarity(CORNERS[0], np.zeros((2, 2)))


class TestLeast:
    TIMES = np.array([0.3, 0.5])

    def rows(self, prepared):
        return constraint.rows(prepared.constraints, len(prepared.source), self.TIMES)

    def test_it_is_the_shape_of_the_library(self, bent):
        P, Q, F = bent
        w = np.ones(len(F))
        prepared = shape.prepare(P, Q, F, weights=w)
        maps = prepared.homotopy(prepared.maps, self.TIMES, prepared.theta)
        v = forms.least(forms.matrix(P, F, w), forms.pull(P, F, w, maps), self.rows(prepared), np.arange(2))
        found = shape.solve(prepared, self.TIMES).vertices
        assert np.abs(v.reshape(found.shape) - found).max() < 1e-11

    def test_with_a_matrix_for_each_moment(self, bent):
        P, Q, F = bent
        prepared = shape.prepare(P, Q, F, error=energy.SIMILARITY, weights=np.ones(len(F)))
        maps = prepared.homotopy(prepared.maps, self.TIMES, prepared.theta)
        G = forms.assembled(forms.similarity(P[F], maps[1]), F, len(P))
        v = forms.least(G, np.zeros((1, 2 * len(P))), self.rows(prepared), np.array([1]))
        found = shape.solve(prepared, self.TIMES).vertices[1]
        assert np.abs(v.reshape(found.shape) - found).max() < 1e-11

    def test_a_form_that_holds_nothing_is_refused(self, bent):
        P, Q, F = bent
        with pytest.raises(ValueError, match=r"forms.least: G must be a form that holds the shape together"):
            none = np.zeros((2 * len(P), 2 * len(P)))
            forms.least(none, none[:1], self.rows(shape.prepare(P, Q, F)), np.arange(1))
