"""What `decompose` shows, against NumPy's own decompositions and the text's formulas."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.render import scene

MATRICES = {
    "ordinary": (0.9, -0.3, 1.0, 1.0),
    "reflection": (0.5, 1.2, 0.8, -0.6),
    "singular": (1.0, 0.5, 2.0, 1.0),
    "nought": (0.0, 0.0, 0.0, 0.0),
    "rotation": (0.8, -0.6, 0.6, 0.8),
    "half turn": (-1.0, 0.0, 0.0, -1.0),
    "nearly singular": (-10.0, 10.0, 10.0, -9.99),
    "shear": (1.0, 3.0, 0.0, 1.0),
    "mirror": (0.0, 1.0, 1.0, 0.0),
}


def shown(**params):
    return figure.load("decompose", (paths.FIGURES,)).draw(**params).numbers


@pytest.fixture(params=MATRICES.values(), ids=MATRICES)
def matrix(request):
    return request.param


class TestSvd:
    def test_the_factors_multiply_to_the_matrix(self, matrix):
        U, D, Vt = shown(matrix=matrix)["factors"]
        A = np.reshape(matrix, (2, 2))
        assert np.abs(U @ D @ Vt - A).max() <= 1e-14 * max(1.0, np.abs(A).max())

    def test_singular_values_are_numpys(self, matrix):
        A = np.reshape(matrix, (2, 2))
        d = shown(matrix=matrix)["singular_values"]
        assert d == pytest.approx(np.linalg.svd(A, compute_uv=False), abs=1e-13)

    def test_only_the_last_factor_reflects(self, matrix):
        U, D, Vt = shown(matrix=matrix)["factors"]
        assert np.abs(U @ U.T - np.eye(2)).max() < 1e-14 > np.abs(Vt @ Vt.T - np.eye(2)).max()
        assert np.linalg.det(Vt) > 0.0 and (np.diagonal(D) >= 0.0).all()
        assert (np.linalg.det(U) < 0.0) == (np.linalg.det(np.reshape(matrix, (2, 2))) < -1e-9)

    def test_the_first_turn_is_at_most_a_quarter(self, matrix):
        assert abs(shown(matrix=matrix)["angles"][0]) <= np.pi / 2 + 1e-15

    def test_of_all_pairs_of_directions_one_stays_at_right_angles(self):
        numbers = shown()
        V = numbers["right_axes"]
        carried = numbers["A"] @ V
        assert abs(carried[:, 0] @ carried[:, 1]) < 1e-15
        assert np.linalg.norm(carried, axis=0) == pytest.approx(numbers["singular_values"])


class TestPolar:
    def test_it_shows_the_function_that_it_is_given(self):
        drawn = figure.load("decompose", (paths.FIGURES,)).draw_with(
            {"polar": lambda A: (np.linalg.inv(A.T), A.T @ A)}, kind="polar"
        )
        R, S = drawn.numbers["factors"]
        A = drawn.numbers["A"]
        assert np.abs(S - A.T @ A).max() == 0.0
        assert np.abs(drawn.numbers["shown"][-1] - A).max() < 1e-15
        assert np.abs(R - np.linalg.inv(A.T)).max() < 1e-15

    @pytest.mark.parametrize("kind", ["polar", "polar-left"])
    def test_the_factors_multiply_to_the_matrix(self, kind, matrix):
        first, second = shown(kind=kind, matrix=matrix)["factors"]
        A = np.reshape(matrix, (2, 2))
        assert np.abs(first @ second - A).max() <= 1e-14 * max(1.0, np.abs(A).max())

    def test_both_orders_have_one_rotation_and_two_stretches(self, matrix):
        R, S = shown(kind="polar", matrix=matrix)["factors"]
        left, again = shown(kind="polar-left", matrix=matrix)["factors"]
        assert np.abs(R - again).max() < 1e-14
        assert np.abs(left - R @ S @ R.T).max() <= 1e-14 * max(1.0, np.abs(S).max())
        assert np.linalg.eigvalsh(S).min() > -1e-13

    def test_the_plates_show_the_same_matrix(self, plate):
        assert np.array_equal(plate("B3.3").numbers["A"], plate("B3.3b").numbers["A"])
        assert np.array_equal(plate("B3.3").numbers["A"], plate("B3.3c").numbers["A"])


class TestSteps:
    @pytest.mark.parametrize("kind", ["svd", "polar", "polar-left"])
    def test_they_lead_from_the_disc_to_the_matrix(self, kind, matrix):
        start, end = (shown(kind=kind, matrix=matrix, t=t)["shown"] for t in (0.0, 1.0))
        assert np.abs(start - np.eye(2)).max() == 0.0
        A = np.reshape(matrix, (2, 2))
        assert np.abs(end[-1] - A).max() <= 1e-13 * max(1.0, np.abs(A).max())

    def test_one_begins_when_the_one_before_has_ended(self):
        first, second, third = np.diff(shown(t=0.5)["shown"], axis=0)
        assert np.abs(first).max() > 0.1 and np.abs(second).max() > 0.1 and np.abs(third).max() == 0.0


class TestPage:
    @pytest.mark.parametrize("kind", ["svd", "polar", "polar-left"])
    def test_nothing_moves_with_time_but_the_shapes(self, kind, matrix):
        early, late = (labels(kind=kind, matrix=matrix, t=t) for t in (0.3, 1.0))
        assert early.keys() == late.keys()
        # The names of the singular values go with the ends of the axes.
        names = [name for name in early if not name.startswith(r"$\sigma") or "=" in name]
        assert "$A$" in names
        for name in names:
            assert np.abs(early[name] - late[name]).max() < 1e-9, name

    def test_numbers_are_equal_only_where_they_are_not_rounded(self):
        assert r"$\approx$" in labels()
        assert r"$\approx$" not in labels(matrix=(0.0, -2.0, 1.0, 0.0))


def labels(**params):
    picture = figure.load("decompose", (paths.FIGURES,)).draw(**params).picture
    return {
        record.text: np.asarray(record.position)
        for view in picture.views
        for record in view.records
        if isinstance(record, scene.Label)
    }
