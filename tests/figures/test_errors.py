"""KT1 shows errors as powers of ten, which rounding on another processor does not change."""

import numpy as np
import pytest
from lietool.figures.papers import errors

from lietool.bench import methods, printed
from lietool.lie import so3


@pytest.fixture(scope="module")
def found():
    """The errors before they are rounded, of the plate and of other matrices."""
    return {
        seed: (errors._symmetric(rng, 1000), errors._affine(rng, 1000))
        for seed in (1, 2)
        for rng in [np.random.default_rng(seed)]
    }


class TestRobust:
    def test_errors_are_well_inside_their_decades(self, found):
        for rows in found[1]:
            for name, row in rows.items():
                decades = np.log10(row)
                # Between processors the mean of 1000 moves by 0.06 at most (most by 0.02), of few by 0.15.
                margin = 0.2 if name == "Higham" else 0.06
                assert np.abs(np.abs(decades - np.floor(decades)) - 0.5).min() > margin, name

    def test_other_matrices_give_the_same_picture(self, found):
        for one, other in zip(found[1], found[2], strict=True):
            for name in one:
                assert np.abs(np.log10(one[name] / other[name])).max() < 0.3, name

    def test_decades(self):
        assert errors.decade(np.array([1.0, 0.4, 0.2, 2e-15, 0.0])).tolist() == [0, 0, -1, -15, -16]


class TestMean:
    def test_it_is_the_root_mean_square(self):
        rng = np.random.default_rng(5)
        X, off = rng.normal(size=(2, 40, 3, 3)), 1e-3 * rng.normal(size=(2, 40, 3, 3))
        relative = np.linalg.norm(off, axis=(2, 3)) / np.linalg.norm(X, axis=(2, 3))
        wanted = [np.sqrt(sum(r**2 for r in row) / 40) for row in relative]
        assert errors._mean(lambda Y: Y + off, X) == pytest.approx(wanted, rel=1e-9)

    def test_no_number_and_nonsense_count_as_one(self):
        X = np.tile(np.eye(3), (1, 4, 1, 1))
        again = X.copy()
        again[0, 0], again[0, 1] = np.nan, 1e9
        assert errors._mean(lambda Y: again, X) == pytest.approx([np.sqrt(0.5)])


class TestErrors:
    def test_ours_stay_at_rounding_as_highams_and_diagonalisation_do(self, plate):
        shown = plate("KT1").numbers
        for name in ("ours", "Higham", "diagonal"):
            assert set(shown["log_error_decade"][name]) == {-15}
        assert set(shown["psi_error_decade"]["ours"]) == {-15}

    def test_newton_loses_half_the_digits_of_the_condition_number(self, plate):
        steps = np.diff(plate("KT1").numbers["psi_error_decade"]["Newton"])
        assert steps.tolist() == [0, 0, 1, 1, 1]

    def test_the_printed_formulas_lose_them_all(self, plate):
        shown = plate("KT1").numbers
        assert np.diff(shown["log_error_decade"]["as printed"])[:3].tolist() == [2, 2, 2]
        assert shown["psi_error_decade"]["as printed"][2:].tolist() == [0, 0, 0, 0]

    def test_the_cost_of_the_printed_logarithm_is_its_subtraction(self):
        # Against the same matrix's eigenvalues, known exactly: it is the formula that loses, not the matrix.
        R = so3.exp(np.array([0.3, -0.8, 0.5]))
        S = R @ np.diag([1.0, 1e-4, 1e-7]) @ R.T
        S = 0.5 * (S + S.T)
        wanted = R @ np.diag(np.log([1.0, 1e-4, 1e-7])) @ R.T
        exp, log = methods.SYMMETRIC["Ours"]
        off = [np.linalg.norm(f(S) - wanted) / np.linalg.norm(wanted) for f in (log, printed.sym_log)]
        assert off[0] < 1e-8 and np.linalg.norm(exp(log(S)) - S) < 1e-14 < np.linalg.norm(
            printed.sym_exp(printed.sym_log(S)) - S
        )
