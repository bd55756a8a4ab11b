"""KT2 shows what experiments find, and errors by what rounding on another processor does not change."""

import numpy as np
import pytest
from lietool.figures.papers import properties

from lietool import figure, paths
from lietool.bench import experiments, tables
from lietool.lie import polar, so3


class TestProperties:
    def test_every_answer_is_an_experiments(self, plate):
        numbers, found = plate("KT2").numbers, experiments.findings()
        for i, name in enumerate(numbers["properties"]):
            for j, method in enumerate(numbers["methods"]):
                assert numbers["holds"][i][j] == found[method][name].holds
        assert list(numbers["known_turn"])[:5] == [860, 860, 169, 140, 860]

    def test_no_column_is_full(self, plate):
        assert not np.all(plate("KT2").numbers["holds"], axis=0).any()

    def test_what_is_ringed(self, plate):
        numbers = plate("KT2").numbers
        ringed = [
            (numbers["properties"][i], numbers["methods"][j])
            for i, j in np.argwhere(numbers["paper_says_otherwise"])
        ]
        assert ringed == [
            ("Extrapolation", "Alexa/SAM"),
            ("Associativity", "Ours"),
            ("Associativity", "Polar+Grassia"),
        ]
        # Each of them is a yes here: the caption and the picture show it so.
        assert np.asarray(numbers["holds"])[np.asarray(numbers["paper_says_otherwise"])].all()

    @pytest.mark.parametrize("turn", [1.0, 100.0, 360.0])
    def test_nobody_is_blamed_for_small_turns(self, turn):
        numbers = figure.load("properties", (paths.FIGURES,)).draw(turn=turn).numbers
        row = list(numbers["properties"]).index("Large rotation")
        assert not numbers["paper_says_otherwise"][row].any()

    def test_the_ranges_that_the_caption_names(self):
        for count, seed in ((400, 2), (100, 3), (100, 6)):
            R = polar.rotation(experiments._moderate(count, seed)[:, :3, :3])
            assert np.rad2deg(np.linalg.norm(so3.log(R), axis=-1)).max() < 90.0


class TestErrors:
    def test_what_is_shown(self, plate):
        numbers = plate("KT2").numbers
        assert list(numbers["error"]).count(r"<\!10^{-26}") == 5
        assert list(numbers["error"])[2] == "87" and list(numbers["error"])[-1] == "0"
        assert numbers["without_real_logarithm"] == 33

    def test_rounding_is_far_below_its_bound(self):
        X = tables.affine(2000)
        for method in properties.methods.METHODS:
            error, missed = tables.round_trip(X, method.psi, method.phi)
            assert missed or error < 0.02 * properties.ROUNDING, method.name

    def test_a_logarithm_is_missed_where_an_eigenvalue_alone_is_negative(self):
        X = tables.affine(2000)
        w = np.linalg.eigvals(X[:, :3, :3])
        negative = ((np.abs(w.imag) < 1e-9) & (w.real < 0.0)).any(axis=-1)
        alexa = next(m for m in properties.methods.METHODS if m.way == "alexa")
        assert tables.round_trip(X, alexa.psi, alexa.phi)[1] == negative.sum()

    def test_texts(self):
        assert properties.error_text(0.0) == "0" and properties.error_text(87.2) == "87"
        assert properties.error_text(1e-28) == properties.error_text(2e-29) == r"<\!10^{-26}"
        assert properties.error_text(1.9e-25, 0.0) == "10^{-25}"
