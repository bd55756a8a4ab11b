"""What the plate of harmonic weights claims: straight lines on any triangles, and what is held."""

import numpy as np
import pytest

from lietool import figure, paths

HARMONIC = figure.load("harmonic", (paths.FIGURES,))


@pytest.mark.parametrize("uneven", [0.0, 0.4, 1.0])
def test_between_two_edges_the_weight_is_linear_on_any_triangles(uneven):
    assert HARMONIC.draw(uneven=uneven).numbers["farthest from straight"] == 0.0


def test_weights_are_between_0_and_1():
    low, high = np.transpose(HARMONIC.draw().numbers["least and most"])
    assert np.allclose(low, 0.0, atol=1e-12) and np.allclose(high, 1.0, atol=1e-12)


def test_the_triangles_are_as_uneven_as_they_are_asked_to_be():
    sizes = [HARMONIC.draw(uneven=u).numbers["largest over smallest face"] for u in (0.0, 0.5, 1.0)]
    assert sizes[0] == pytest.approx(1.0) and sizes[0] < 5.0 < sizes[1] < 100.0 < sizes[2]


def test_weights_that_are_passed_in_are_shown():
    def across(V, F, handles):
        return np.stack([V[:, 1], 1.0 - V[:, 1]], axis=1)

    numbers = HARMONIC.draw_with({"weights": across}).numbers
    assert numbers["farthest from straight"] == 1.0
