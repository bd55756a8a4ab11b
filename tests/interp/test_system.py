"""The linear systems: against generic solvers and libigl's matrix, alike on one processor and on many."""

import igl
import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import lsqr, spsolve

from lietool.interp import constraint, energy, shape, triangle
from lietool.mesh import elimination, topology

T = np.array([0.0, 0.3, 0.6, 1.0])


def entry_rows(P, F):
    """Rows that give the four entries of every triangle's map, times the root of its area; x and y apart."""
    E = np.linalg.inv(np.swapaxes(P[F[:, :2]] - P[F[:, 2:]], -1, -2))
    E = np.concatenate([E, -E.sum(axis=1, keepdims=True)], axis=1)
    E *= np.sqrt(topology.areas(P, F))[:, None, None]
    # B[:, j] = sum_k v_k E[k, j]
    row = np.arange(2 * len(F)).reshape(-1, 2)[:, None, :] + np.zeros((1, 3, 1), int)
    column = np.broadcast_to(F[:, :, None], row.shape)
    return sp.csr_array((E.ravel(), (row.ravel(), column.ravel())), (2 * len(F), len(P)))


def test_frobenius_is_a_generic_sparse_least_squares(shaken):
    P, Q, F = shaken
    prepared = shape.prepare(P, Q, F, homotopy=triangle.arap)
    found = shape.solve(prepared, 0.4).vertices[0]
    A = triangle.arap(prepared.maps, 0.4, prepared.theta)
    rows = entry_rows(P, F)
    weight = np.sqrt(topology.areas(P, F))
    start = 0.6 * P[0] + 0.4 * Q[0]
    for axis in range(2):
        right = np.repeat(weight, 2) * A[:, axis].ravel() - rows[:, [0]].toarray()[:, 0] * start[axis]
        expected = lsqr(rows[:, 1:], right, atol=1e-14, btol=1e-14, iter_lim=20000)[0]
        assert found[1:, axis] == pytest.approx(expected, abs=1e-8)
        assert found[0, axis] == pytest.approx(start[axis], abs=1e-15)


def test_similarity_is_a_generic_sparse_solution(shaken):
    P, Q, F = shaken
    prepared = shape.prepare(P, Q, F, error=energy.SIMILARITY)
    found = shape.solve(prepared, 0.4).vertices[0]
    A = triangle.logexp(prepared.maps, 0.4, prepared.theta)
    rows, m = entry_rows(P, F), len(F)
    # The entries of all maps in the order (triangle, row, column), from x and y of all vertices.
    order = (4 * np.arange(m)[:, None] + [0, 1]).ravel()
    both = sp.csr_array(sp.block_diag([rows, rows]))[np.argsort(np.concatenate([order, order + 2]))]
    a, b = A.reshape(m, 4), (np.array([[0.0, -1.0], [1.0, 0.0]]) @ A).reshape(m, 4)
    away = (
        np.eye(4)
        - (a[:, :, None] * a[:, None] + b[:, :, None] * b[:, None]) / np.sum(a**2, axis=1)[:, None, None]
    )
    H = sp.csr_array(both.T @ sp.block_diag(list(away), format="csr") @ both)
    first, edge = prepared.constraints
    held = [first.vertex, edge.start]
    places = np.concatenate([first.path(np.array([0.4])), edge.path(np.array([0.4]))])
    places[1] += places[0]
    fixed = np.concatenate([held, np.add(held, len(P))])
    free = np.setdiff1d(np.arange(2 * len(P)), fixed)
    v = np.zeros(2 * len(P))
    v[fixed] = places.T.ravel()
    v[free] = spsolve(sp.csc_array(H[free][:, free]), -(H[free][:, fixed] @ v[fixed]))
    assert found.T.ravel() == pytest.approx(v, abs=1e-7)


def test_the_matrix_of_frobenius_is_libigls_cotangent_matrix(shaken):
    P, Q, F = shaken
    part = shape.prepare(P, Q, F).assembly
    entries = part.pattern.add(part.sums[0].blocks(part.sums[0].form(part.sums[0].maps(0.5))))
    ours = sp.csr_array((entries.real, part.pattern.places), (len(P), len(P)))
    flat = np.concatenate([P, np.zeros((len(P), 1))], axis=1)
    theirs = -igl.cotmatrix(flat, F)
    assert abs(entries.imag).max() < 1e-12
    # |x|^2 of complex coordinates is half of the square of the Frobenius norm, which G = 2 I makes up for.
    assert ours.toarray() == pytest.approx(theirs.toarray(), abs=1e-9)


@pytest.mark.parametrize("error", [energy.SIMILARITY, energy.balanced(0.4)])
def test_many_processors_find_what_one_finds(bent, monkeypatch, error):
    prepared = shape.prepare(*bent, error=error)
    one = shape.solve(prepared, T)
    monkeypatch.setattr(shape, "SHARED", 1)
    monkeypatch.setattr(shape.os, "cpu_count", lambda: 3)
    assert shape._workers(prepared) == 3
    many = shape.solve(prepared, T)
    assert np.array_equal(one.vertices, many.vertices) and np.array_equal(one.residual, many.residual)


def test_blocks_of_frames_find_what_all_at_once_find(bent, monkeypatch):
    prepared = shape.prepare(*bent)
    whole = shape.solve(prepared, T).vertices
    monkeypatch.setattr(shape, "BLOCK", 2 * len(bent[2]))
    assert shape.solve(prepared, T).vertices == pytest.approx(whole, abs=1e-13)


class TestElimination:
    def factor_size(self, A, order):
        return elimination.superlu(sp.csc_array(sp.csc_array(A[order])[:, order]), True).L.nnz

    def test_both_orders_keep_factors_sparse(self, shaken, monkeypatch):
        P, Q, F = shaken
        A = shape.prepare(P, Q, F).factor.inner
        orders = [elimination.order(A, P[1:])]
        monkeypatch.setattr(elimination, "LARGE", 1)
        orders.append(elimination.order(A, P[1:]))
        for order in orders:
            assert np.array_equal(np.sort(order), np.arange(len(P) - 1))
            assert self.factor_size(A, order) < 0.3 * self.factor_size(A, np.arange(len(P) - 1))

    @pytest.mark.parametrize("error", [energy.FROBENIUS, energy.SIMILARITY])
    @pytest.mark.parametrize("direction", [False, True])
    def test_the_order_does_not_matter_to_the_shape(self, shaken, monkeypatch, error, direction):
        P, Q, F = shaken
        asked = [constraint.Locus(k, constraint.line(P[k], Q[k])) for k in (3, 400)]
        if direction:
            asked.append(constraint.Direction(5, 700, (0.3, 1.0)))
        found = [shape.solve(shape.prepare(P, Q, F, error=error, constraints=asked), T).vertices]
        monkeypatch.setattr(elimination, "LARGE", 1)
        prepared = shape.prepare(P, Q, F, error=error, constraints=asked)
        assert prepared.assembly.layout.ordered
        found.append(shape.solve(prepared, T).vertices)
        assert found[0] == pytest.approx(found[1], abs=1e-8)


@pytest.mark.parametrize("error", [energy.FROBENIUS, energy.SIMILARITY])
def test_where_every_vertex_is_given_nothing_is_left_to_solve(error):
    P, Q = np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[0.0, 0], [2, 0], [0, 1]])
    held = [constraint.Locus(k, constraint.line(P[k], Q[k])) for k in range(3)]
    found = shape.solve(shape.prepare(P, Q, [[0, 1, 2]], error=error, constraints=held), [0.0, 0.5])
    assert found.vertices == pytest.approx(np.stack([P, 0.5 * (P + Q)]))
    assert found.residual == pytest.approx([0.0, 0.0])


def test_a_poor_solution_is_improved(bent, monkeypatch):
    P, Q, F = bent
    good = shape.solve(shape.prepare(P, Q, F), T)
    solver = elimination.superlu

    class Careless:
        def __init__(self, matrix, ordered):
            self.inner = solver(matrix, ordered)

        def solve(self, b):
            return self.inner.solve(b) * (1.0 + 1e-8)

    monkeypatch.setattr(elimination, "superlu", Careless)
    found = shape.solve(shape.prepare(P, Q, F), T)
    assert found.residual.max() < 1e-13
    assert found.vertices == pytest.approx(good.vertices, abs=1e-12)


class TestHomotopies:
    def test_that_of_a_user_is_as_good_as_ours(self, bent):
        def own(A, t, theta=None):
            return triangle.arap(A, t, theta)

        for error in (energy.FROBENIUS, energy.SIMILARITY):
            found = [
                shape.solve(shape.prepare(*bent, error=error, homotopy=way), T).vertices
                for way in (own, triangle.arap)
            ]
            assert found[0] == pytest.approx(found[1], abs=1e-10)

    @pytest.mark.parametrize("way", [triangle.linear, triangle.arap, triangle.logexp])
    def test_the_fast_way_is_the_way(self, way):
        A = np.random.default_rng(9).normal(size=(50, 2, 2))
        A[np.linalg.det(A) < 0.0, 0] *= -1.0
        theta = triangle.principal_angle(A) + 2.0 * np.pi
        fast = triangle.path(way, A, theta)
        for t in (-0.4, 0.0, 0.7, 1.0):
            expected = np.stack(triangle.coordinates(way(A, t, theta)))
            assert fast(t) == pytest.approx(expected, rel=1e-12, abs=1e-12)

    def test_what_a_homotopy_refuses_is_refused_at_once(self):
        P = np.array([[0.0, 0], [1, 0], [0, 1]])
        with pytest.raises(ValueError, match="real logarithm"):
            shape.prepare(P, P * [-1.0, -2.0], [[0, 1, 2]], homotopy=triangle.matrix_log)

    def test_angles_that_are_none_of_the_maps(self, bent):
        theta = shape.prepare(*bent).theta.copy()
        theta[5] += 1.0
        with pytest.raises(ValueError, match=r"theta must be .* but for full turns; got .* at index \(5,\)"):
            shape.prepare(*bent, theta=theta)
