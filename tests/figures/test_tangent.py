"""What `tangent` shows: a curve in the group, its velocity in the algebra, and exp of the straight line."""

import numpy as np
import pytest

from lietool import figure, paths

GROUPS = ("diagonal", "quaternion")


def shown(**params):
    return figure.load("tangent", (paths.FIGURES,)).draw(**params).numbers


def outside(group, points):
    """How far points are from the group."""
    if group == "diagonal":
        assert (points > 0.0).all()
        return np.abs(np.prod(points, axis=-1) - 1.0).max()
    return np.abs(np.linalg.norm(points, axis=-1) - 1.0).max()


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.parametrize("params", [{}, {"bend": 1.0, "speed": 1.2}, {"direction": -200.0}, {"speed": 0.0}])
class TestGroups:
    def test_both_curves_lie_in_the_group(self, group, params):
        numbers = shown(group=group, **params)
        for name in ("subgroup", "curve", "exp_tX", "curve_at_t"):
            assert outside(group, numbers[name]) < 1e-14, name

    def test_the_velocity_is_x_and_lies_in_the_algebra(self, group, params):
        numbers = shown(group=group, **params)
        X, velocity = numbers["X"], numbers["velocity"]
        assert np.abs(velocity - X).max() < 1e-11
        # Of trace 0, or imaginary.
        assert abs(X.sum() if group == "diagonal" else X[0]) < 1e-15

    def test_the_straight_line_leaves_the_group(self, group, params):
        numbers = shown(group=group, **params)
        identity = np.ones(3) if group == "diagonal" else np.array([1.0, 0.0, 0.0])
        point = identity + numbers["tX"]
        left = abs(np.prod(point) - 1.0) if group == "diagonal" else abs(np.linalg.norm(point) - 1.0)
        assert (left > 0.1) == (params.get("speed") != 0.0)


class TestSubgroup:
    def test_exponentials_are_elementwise(self, plate):
        numbers = plate("B4.1").numbers
        assert numbers["exp_tX"] == pytest.approx(np.exp(numbers["tX"]), rel=1e-14)

    def test_it_is_a_subgroup(self):
        halves, whole = shown(t=0.6)["exp_tX"], shown(t=1.2)["exp_tX"]
        assert whole == pytest.approx(halves * halves, rel=1e-14)

    def test_the_curve_agrees_with_it_only_without_a_bend(self):
        assert np.abs(shown(bend=0.0)["curve"] - shown(bend=0.0)["subgroup"]).max() < 1e-15
        assert np.abs(shown()["curve"] - shown()["subgroup"]).max() > 0.1


class TestContours:
    @pytest.mark.parametrize("group", GROUPS)
    def test_the_outline_ends_on_the_edge_where_it_goes_out_of_sight(self, group):
        from lietool.figures.ch4 import _tangent_groups as groups

        dome = groups.Chart(groups.GROUPS[group]()).dome(1.5)
        eye = np.array([3.0, -10.0, 5.0])
        outline, seen, hidden = dome.contours(eye, 0.02)
        assert np.isfinite(outline).all()
        for end in (outline[0], outline[-1]):
            for part in (seen, hidden):
                assert np.nanmin(np.linalg.norm(part - end, axis=-1)) < 1e-12

    def test_from_above_all_of_the_edge_is_seen(self):
        from lietool.figures.ch4 import _tangent_groups as groups

        dome = groups.Chart(groups.Diagonal()).dome(1.0)
        outline, seen, hidden = dome.contours(np.array([0.0, 0.0, 50.0]), 0.02)
        assert np.array_equal(seen, dome.rim) and np.isnan(outline).all() and np.isnan(hidden).all()
