"""Plates KT1 and KT2 show the tables, by numbers that rounding on another processor does not change."""

import numpy as np
from lietool.figures.papers import errors, properties

from lietool.bench import experiments


def test_errors_are_well_inside_their_bands():
    rng = np.random.default_rng(1)
    for rows in (errors._symmetric(rng, 400), errors._affine(rng, 400)):
        for row in rows.values():
            for error in row[~np.isnan(row)]:
                assert min(abs(np.log10(error) - edge) for edge in errors.EDGES) > 0.15
    assert [errors.level(e) for e in (0.0, 1e-14, 1e-12, 1e-6, 1e-4, float("nan"))] == [0, 0, 1, 4, 5, 5]


def test_what_the_first_table_shows(plate):
    numbers = plate("KT1").numbers
    for table, conditions in (("log_error_at_most", 6), ("psi_error_at_most", 6)):
        assert list(numbers[table]["ours"]) == ["1e-13"] * conditions
        assert "lost" in list(numbers[table]["as printed"])
    assert list(numbers["psi_error_at_most"]["Newton"])[-1] == "1e-11"


def test_what_the_second_table_shows(plate):
    numbers = plate("KT2").numbers
    found = experiments.findings()
    for i, name in enumerate(numbers["properties"]):
        for j, method in enumerate(numbers["methods"]):
            assert numbers["holds"][i][j] == found[method][name].holds
    assert np.sum(numbers["paper_says_otherwise"]) == 3
    assert numbers["without_real_logarithm"] == 33
    assert list(numbers["known_turn"])[:5] == [860, 860, 169, 140, 860]


def test_errors_of_rounding_are_far_from_the_ends_of_their_bar():
    assert properties._decade(1e-28) == properties._decade(2e-29) == "1e-30 to 1e-26"
    assert properties._decade(0.0) == "0" and properties._decade(87.0) == "1e2"
    decades, _ = properties._errors()
    assert decades.count("1e-30 to 1e-26") == 5
