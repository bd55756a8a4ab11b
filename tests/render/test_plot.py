"""Plots: numbers as text, values on the page, the records of a frame."""

import numpy as np
import pytest

from lietool.render import plot, style
from lietool.render.scene import Label, Lines, Points, Surface

AXES = plot.Axes((100.0, 200.0, 400.0, 100.0), (-2.0, 2.0), (0.0, 5.0))


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.0, 2, "0"),
        (-0.0, 2, "0"),
        (-0.001, 2, "0"),
        (-0.004, 2, "0"),
        (-1e-300, 9, "0"),
        (-0.4, 0, "0"),
        (1.0, 2, "1"),
        (-1.5, 2, "-1.5"),
        (100.0, 0, "100"),
        (100.0, 2, "100"),
        (-20.0, 1, "-20"),
        (2.675, 1, "2.7"),
        (0.1 + 0.2, 2, "0.3"),
        (1e6, 2, "1000000"),
        (np.float64(np.pi), 2, "3.14"),
        (3, 2, "3"),
    ],
)
def test_numbers(value, digits, text):
    assert plot.number(value, digits) == text


def test_no_minus_before_zero():
    values = np.concatenate([np.linspace(-0.02, 0.02, 401), -np.logspace(-20, 0, 61)])
    texts = {plot.number(v, d) for v in values for d in range(5)}
    assert not any(text.startswith("-") and not text.strip("-0.") for text in texts)


class TestAxes:
    def test_values_on_the_page(self):
        corners = AXES.at([-2.0, 2.0, 0.0], [0.0, 5.0, 2.5])
        assert corners.tolist() == [[100, 200, 0], [500, 300, 0], [300, 250, 0]]
        assert AXES.at(np.zeros((2, 3)), 1.0).shape == (2, 3, 3)
        assert AXES.at(0.0, 0.0).tolist() == [300, 200, 0]

    def test_a_curve_is_broken_by_nan(self):
        curve = AXES.curve([0.0, 1.0, 2.0], [1.0, np.nan, 3.0], style.INK)
        assert isinstance(curve, Lines) and np.isnan(np.asarray(curve.points)[1]).any()

    def test_the_frame(self):
        records = AXES.frame([(-2.0, "$-2$"), (0.0, "")], [(0.0, "$0$"), (5.0, "$5$")], "$x$", "title")
        labels = {r.text: r for r in records if isinstance(r, Label)}
        assert set(labels) == {"$-2$", "$0$", "$5$", "$x$", "title"}
        # All text lies outside of the rectangle.
        assert labels["$5$"].anchor == "rc" and labels["$5$"].offset[0] < 0
        assert labels["$-2$"].anchor == "ct" and labels["$-2$"].offset[1] < 0
        assert labels["title"].position == (100.0, 300.0, 0) and labels["title"].offset[1] > 0
        lines = [np.asarray(r.points) for r in records if isinstance(r, Lines)]
        assert len(lines) == 2 + 2 + 1
        assert not AXES.frame([], [], "", "")[1:]

    def test_dots(self):
        full, hollow = (
            AXES.dots(0.0, 1.0, style.INK),
            AXES.dots([0.0, 1.0], [1.0, 2.0], style.INK, hollow=True),
        )
        assert (
            isinstance(full, Points)
            and np.asarray(full.positions).shape == (1, 3)
            and full.color == style.INK
        )
        assert (hollow.color, hollow.rim) == (style.PAPER, style.INK) and not hollow.shaded

    def test_area_and_band(self):
        x = np.linspace(-2.0, 2.0, 41)
        area, band = AXES.area(x, 5.0 - x**2, style.INK, 0.1), AXES.band(-1.0, 1.0, style.BAND)
        for surface, wanted in ((area, 100 * 20 * np.trapezoid(5.0 - x**2, x)), (band, 200.0 * 100.0)):
            assert isinstance(surface, Surface) and surface.material == "flat"
            corners = np.asarray(surface.vertices)[np.asarray(surface.faces)]
            across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
            assert np.abs(across).sum() / 2 == pytest.approx(wanted)

    def test_a_vertical_line(self):
        assert np.asarray(AXES.vertical(1.0, style.RULE).points).tolist() == [[400, 200, 0], [400, 300, 0]]
