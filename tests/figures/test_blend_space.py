"""What `blend-space` shows: blends inside the cone and off the circle, and curves that stay."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.lie import sym


def load():
    return figure.load("blend-space", (paths.FIGURES,))


def shown(**params):
    return load().draw(**params).numbers


class TestConvex:
    def test_blends_of_stretches_are_positive_definite(self, plate):
        numbers = plate("B4.3").numbers
        assert np.linalg.eigvalsh(numbers["stretch_blends"]).min() > 0.0
        # det^(1/2) is concave on Sym+(2): a blend has never less than the blend of both.
        root = np.sqrt(numbers["det_stretch"])
        assert (root >= np.linspace(root[0], root[-1], len(root)) - 1e-14).all()

    def test_blends_of_rotations_shrink_by_the_cosine_of_half_the_angle(self):
        numbers = shown(angle0=10.0, angle1=130.0, steps=2)
        assert numbers["det_turn"] == pytest.approx([1.0, np.cos(np.deg2rad(60.0)) ** 2, 1.0])

    def test_opposite_rotations_cancel(self):
        assert np.abs(shown(angle0=-90.0, angle1=90.0, t=0.5)["marked_turn"]).max() < 1e-15

    def test_the_straight_line_leaves_the_cone_where_the_determinant_vanishes(self):
        from lietool.figures.ch4._blend_cone import Stretches

        ends = Stretches(np.array([[2.1, 0.7], [0.7, 0.6]]), np.array([[0.7, -0.6], [-0.6, 2.6]]))
        low, high = ends.exits()
        assert low < 0.0 and high > 1.0
        assert np.abs(np.linalg.det(ends.linear(np.array([low, high])))).max() < 1e-14

    @pytest.mark.parametrize(
        ("first", "second", "exits"),
        [(1.0, 1.0, (-np.inf, np.inf)), (1.0, 2.0, (-1.0, np.inf)), (3.0, 1.0, (-np.inf, 1.5))],
    )
    def test_multiples_leave_by_the_apex_or_never(self, first, second, exits):
        from lietool.figures.ch4._blend_cone import Stretches

        S = np.array([[2.0, 0.3], [0.3, 0.7]])
        for unit in (np.eye(2), S):
            assert Stretches(first * unit, second * unit).exits() == pytest.approx(exits, rel=1e-6)


class TestLinearise:
    def test_the_curve_is_exp_of_equal_steps(self, plate):
        numbers = plate("B4.4").numbers
        logs = numbers["stretch_logs"]
        assert np.abs(np.diff(logs, n=2, axis=0)).max() < 1e-14
        assert np.abs(sym.log(numbers["stretch_curve"]) - logs).max() < 1e-14
        assert np.abs(np.diff(numbers["angles"], n=2)).max() < 1e-15

    def test_it_has_the_ends_of_the_chord_and_stays_in_its_space(self, plate):
        numbers = plate("B4.4").numbers
        for name in ("stretch", "turn"):
            blends, curve = numbers[f"{name}_blends"], numbers[f"{name}_curve"]
            assert np.abs(blends[[0, -1]] - curve[[0, -1]]).max() < 1e-14
        assert np.linalg.det(numbers["turn_curve"]) == pytest.approx(1.0)
        # det exp L = exp tr L: between the ends the determinant is a geometric sequence.
        det = np.linalg.det(numbers["stretch_curve"])
        assert det == pytest.approx(np.geomspace(det[0], det[-1], len(det)))

    def test_a_whole_turn_has_one_rotation_at_its_ends(self):
        numbers = shown(view="linearise", angle0=0.0, angle1=360.0)
        assert np.abs(numbers["turn_curve"][0] - numbers["turn_curve"][-1]).max() < 1e-15
        assert np.abs(numbers["turn_blends"] - np.eye(2)).max() < 1e-15
        assert np.abs(numbers["turn_curve"][2] + np.eye(2)).max() < 1e-15


class TestRefusals:
    @pytest.mark.parametrize("name", ["start", "end"])
    @pytest.mark.parametrize(
        "entries", [(1.0, 2.0, 1.0), (0.0, 0.0, 0.0), (-1.0, 0.0, -1.0), (1.0, 1.0, 1.0)]
    )
    def test_not_positive_definite(self, name, entries):
        with pytest.raises(ValueError, match=rf"^{name} must be positive definite; got .*") as caught:
            load().draw(**{name: entries})
        assert "\n" not in str(caught.value)

    def test_nearly_singular_ones_are_drawn(self):
        assert np.isfinite(shown(view="linearise", start=(1.0, 0.999999, 1.0))["stretch_curve"]).all()


class TestPage:
    def test_angles_grow_to_the_right_on_the_circle_and_below_it(self):
        from lietool.figures.ch4 import _blend_circle as circle

        from lietool.render import ring

        ends = circle.Turns(*np.deg2rad([-70.0, 50.0]))
        points = ring.drawn(ends.curved(np.linspace(0.0, 1.0, 5)))
        assert (np.diff(points[:, 0]) > 0.0).all()
        assert ring.drawn(np.eye(2)) == pytest.approx([0.0, -1.0])

    def test_both_plates_have_one_cone(self, plate):
        first, second = (plate(name).drawing.picture.views[0] for name in ("B4.3", "B4.4"))
        assert first.camera == second.camera and first.box == second.box
