"""What is left of a polyline."""

import numpy as np
import pytest

from lietool.render import polyline

BENT = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]])


def test_remaining():
    assert polyline.remaining(BENT).tolist() == [7.0, 4.0, 0.0]


@pytest.mark.parametrize(
    ("by", "end"), [(1.0, (3.0, 3.0)), (4.0, (3.0, 0.0)), (5.5, (1.5, 0.0)), (7.0, (0.0, 0.0))]
)
def test_shortened(by, end):
    found = polyline.shortened(BENT, by)
    assert found[-1] == pytest.approx(end)
    assert polyline.remaining(found)[0] == pytest.approx(7.0 - by)
    assert np.array_equal(found[0], BENT[0])


def test_a_point_that_is_there_twice_is_no_trouble():
    twice = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    assert polyline.shortened(twice, 1.0)[-1].tolist() == [1.0, 0.0, 0.0]
