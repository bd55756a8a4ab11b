"""Figure 2.4: the islands of O(2), SO(2) and GL(2)."""

import numpy as np
import pytest
from lietool.figures.ch2 import components

from lietool import figure, paths
from lietool.lie import groups, so2


def drawn(**params):
    return figure.load("components", (paths.FIGURES,)).draw(**params).numbers


class TestIslands:
    def test_every_matrix_is_of_the_group(self, plate):
        shown = plate("B2.4").numbers
        for name, sign in (("det_positive", 1.0), ("det_negative", -1.0)):
            A = shown[name]
            assert np.abs(np.swapaxes(A, -1, -2) @ A - np.eye(2)).max() < 1e-14
            assert shown[f"{name}_det"] == pytest.approx(np.full(len(A), sign))

    def test_a_matrix_of_o2_lies_at_its_first_column(self, plate):
        shown = plate("B2.4").numbers
        for name in ("det_positive", "det_negative"):
            assert np.abs(shown[f"{name}_places"] - shown[name][..., :, 0]).max() < 1e-14

    def test_reflections_are_those_of_the_half_angle(self, plate):
        shown = plate("B2.4").numbers
        half = np.arange(len(shown["det_negative"])) * np.pi / len(shown["det_negative"])
        # (2.10) as it is written on the left of its equals sign.
        mirrored = so2.exp(half) @ np.diag([1.0, -1.0]) @ so2.exp(-half)
        assert np.abs(shown["det_negative"] - mirrored).max() < 1e-14

    def test_two_reflections_make_a_rotation(self, plate):
        A = plate("B2.4").numbers["det_negative"]
        products = A[:, None] @ A[None]
        assert np.linalg.det(products) == pytest.approx(np.ones(products.shape[:2]))

    @pytest.mark.parametrize(("group", "name"), [("O2", "O"), ("SO2", "SO"), ("GL2", "GL")])
    def test_there_are_as_many_as_signs_of_the_determinant(self, group, name):
        shown = drawn(group=group)
        signs = np.sign(np.linalg.det(groups.sample(name, 200, seed=1, n=2)))
        assert shown["components"] == len(set(signs)) == len(shown["marked"])
        assert [np.sign(np.linalg.det(A)) for A in shown["marked"]] == [1.0, -1.0][: shown["components"]]

    def test_in_gl2_the_distance_grows_with_the_determinant(self):
        shown = drawn(group="GL2", glyphs=24)
        for name in ("det_positive", "det_negative"):
            order = np.argsort(np.abs(shown[f"{name}_det"]))
            far = np.linalg.norm(shown[f"{name}_places"], axis=-1)[order]
            assert (np.diff(far) > -1e-12).all() and far[0] < 1.0 < far[-1]
            assert groups.is_member("GL", shown[name]).all()


class TestTheWay:
    def test_the_straight_line_passes_zero(self, plate):
        shown = plate("B2.4").numbers
        t = np.linspace(0.0, 1.0, len(shown["way"]))
        # det((1 - t) A + t B) = det A (1 - 2 t) where B = A diag(1, -1).
        assert shown["way_det"] == pytest.approx(1.0 - 2.0 * t, abs=1e-14)
        assert np.linalg.matrix_rank(shown["way"][len(t) // 2], tol=1e-12) == 1

    def test_it_leaves_o2_but_for_its_ends(self, plate):
        member = plate("B2.4").numbers["way_is_member"]
        assert list(np.flatnonzero(member)) == [0, len(member) - 1]

    def test_of_gl2_it_leaves_at_one_moment_alone(self):
        shown = drawn(group="GL2", angle=-70.0)
        assert list(np.flatnonzero(shown["way_is_member"] == 0)) == [components.STEPS // 2]

    @pytest.mark.parametrize("angle", [0.0, 123.0, -360.0])
    def test_in_so2_a_path_leads_there(self, angle):
        shown = drawn(group="SO2", angle=angle)
        assert shown["way_is_member"].all()
        wanted = so2.exp(np.deg2rad(np.linspace(0.0, angle, len(shown["way"]))))
        assert np.abs(shown["way"] - wanted).max() < 1e-14

    def test_the_marked_ones_are_as_far_apart_as_the_angle_says(self):
        A, B = drawn(angle=250.0)["marked"]
        assert so2.log(A) == pytest.approx(np.deg2rad(250.0 - 360.0))
        assert np.abs(B - A @ np.diag([1.0, -1.0])).max() < 1e-15
