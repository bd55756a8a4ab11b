"""Systems factored once: against a dense solver, and what a singular one says."""

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array, eye_array

from lietool.mesh import solve


def chain(*lengths: int) -> csc_array:
    """The Laplacian of paths side by side."""
    n = sum(lengths)
    joined = np.ones(n - 1)
    joined[np.cumsum(lengths)[:-1] - 1] = 0.0
    W = diags_array([joined, joined], offsets=[1, -1], shape=(n, n))
    L = csc_array(diags_array(np.asarray(W.sum(axis=0)).ravel()) - W)
    L.eliminate_zeros()
    return L


@pytest.mark.equation("B 7.14")
def test_solutions_are_those_of_a_dense_solver():
    rng = np.random.default_rng(0)
    L, n = chain(30), 30
    fixed = np.array([7, 2, 29])
    b, values = rng.normal(size=(n, 4)), rng.normal(size=(3, 4))
    x = solve.factor(L, fixed).solve(b, values)
    free = np.setdiff1d(np.arange(n), fixed)
    A = L.toarray()
    expected = np.linalg.solve(A[np.ix_(free, free)], b[free] - A[np.ix_(free, fixed)] @ values)
    np.testing.assert_allclose(x[free], expected, rtol=1e-11, atol=1e-11)
    assert np.array_equal(x[fixed], values)


def test_a_regular_system_needs_no_fixed_values_and_one_all_fixed_no_solver():
    L = chain(9) + eye_array(9)
    b = np.arange(18.0).reshape(9, 2)
    x = solve.factor(L, []).solve(b, np.zeros((0, 2)))
    np.testing.assert_allclose(L @ x, b, atol=1e-13)
    assert np.array_equal(solve.factor(L, np.arange(9)).solve(b, 2 * b), 2 * b)


def test_arguments_are_left_alone():
    L = chain(5)
    before = L.copy()
    b, values = np.ones((5, 1)), np.zeros((1, 1))
    solve.factor(L, [0]).solve(b, values)
    assert abs(L - before).max() == 0.0 and np.all(b == 1) and np.all(values == 0)


def test_parts_that_nothing_holds_are_named():
    with pytest.raises(ValueError, match=r"^solve.factor: fixed must be a vertex in every connected part; "):
        solve.factor(chain(4), [])
    with pytest.raises(ValueError, match=r"got none in 2 of 3, those of vertex 0, 9\. Fix a vertex in each"):
        solve.factor(chain(4, 5, 3), [6])
    L = csc_array(chain(4).toarray() * 0 + np.diag([1.0, 1.0, 0.0, 1.0]))
    with pytest.raises(ValueError, match=r"L must be a row for every free vertex; got none at vertex 2\."):
        solve.factor(L, [0])


def test_singular_ones_beyond_that_are_refused():
    L = csc_array(np.array([[1.0, 2.0], [2.0, 4.0]]))
    with pytest.raises(ValueError, match=r"^solve.factor: L must be [^\n]*singular[^\n]*$"):
        solve.factor(L, []).solve(np.array([[1.0], [0.0]]), np.zeros((0, 1)))


class Poor:
    """Factors that are off by a share, as those of a nearly singular matrix."""

    def __init__(self, solver, share: float):
        self.solver, self.share = solver, share

    def solve(self, b: np.ndarray) -> np.ndarray:
        return (1.0 + self.share) * self.solver.solve(b)


def test_a_poor_solution_is_improved_and_a_wrong_one_refused():
    f, b, given = solve.factor(chain(30), [0]), np.sin(np.arange(30.0))[:, None], np.ones((1, 1))
    good, f.solver = f.solve(b, given), Poor(f.solver, 1e-6)
    np.testing.assert_allclose(f.solve(b, given), good, rtol=1e-11)
    f.solver = Poor(f.solver, 0.5)
    with pytest.raises(ValueError, match=r"^solve\.factor: L must be a regular matrix; got one that is"):
        f.solve(b, given)


def test_vertices_may_be_told_by_a_mask():
    L, b = chain(4), np.arange(4.0)[:, None]
    given = np.ones((2, 1))
    by_mask = solve.factor(L, [True, False, False, True]).solve(b, given)
    np.testing.assert_array_equal(by_mask, solve.factor(L, [0, 3]).solve(b, given))


def test_broken_arguments_are_refused():
    L = chain(4)
    for fixed, message in [
        ([0, 0], "distinct vertices; got vertex 0 twice"),
        ([4], "indices of the 4 vertices, from 0; got 4"),
        ([0.5], "whole numbers"),
        ([[0]], "whole numbers"),
    ]:
        with pytest.raises(ValueError, match=f"^solve.factor: fixed must be {message}"):
            solve.factor(L, fixed)
    with pytest.raises(ValueError, match=r"L must be a sparse square matrix; got ndarray of shape \(4, 4\)"):
        solve.factor(L.toarray(), [0])
    broken = L.copy()
    broken.data[3] = np.nan
    with pytest.raises(ValueError, match=r"L must be finite; got an entry that is not in column 1"):
        solve.factor(broken, [0])
    f = solve.factor(L, [0])
    for b, values, message in [
        (np.zeros(4), np.zeros((1, 1)), r"rhs must be an array of shape \(4, k\); got shape \(4,\)"),
        (
            np.zeros((4, 2)),
            np.zeros((1, 1)),
            r"values must be an array of shape \(1, 2\); got shape \(1, 1\)",
        ),
        (np.full((4, 1), np.nan), np.zeros((1, 1)), "rhs must be finite; got nan at row 0"),
        (np.zeros((4, 1)), np.full((1, 1), np.inf), "values must be finite; got inf at row 0"),
    ]:
        with pytest.raises(ValueError, match=f"^solve.Factor.solve: {message}"):
            f.solve(b, values)
