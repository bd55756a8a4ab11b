"""The plane on the page: where points go, and arcs, arrows and the glyph there."""

import numpy as np
import pytest

from lietool.render import letter, plane, style
from lietool.render.scene import Lines, Surface

PAGE = plane.Plane((100.0, 50.0), 20.0)


def test_fit_fills_the_box_one_way_and_is_in_its_middle_the_other():
    points = np.array([[-1.0, 2.0], [3.0, 2.5], [0.0, 3.0]])
    at = plane.fit(points, (10.0, 20.0, 400.0, 300.0)).at(points)
    low, high = at.min(axis=0), at.max(axis=0)
    assert (low + high)[:2] / 2.0 == pytest.approx([210.0, 170.0])
    assert (high - low)[:2] == pytest.approx([400.0, 100.0])
    assert plane.fit(points, (10.0, 20.0, 400.0, 300.0), most=7.0).scale == 7.0


def test_fit_of_one_point_is_as_large_as_is_allowed():
    found = plane.fit([[2.0, 3.0]], (0.0, 0.0, 100.0, 60.0), most=40.0)
    assert found.scale == 40.0 and found.at([2.0, 3.0])[:2] == pytest.approx([50.0, 30.0])


def test_points_move_under_linear_and_under_homogeneous_matrices():
    A = np.array([[0.0, -1.0], [2.0, 0.0]])
    T = np.array([[0.0, -1.0, 5.0], [2.0, 0.0, 6.0], [0.0, 0.0, 1.0]])
    points = np.array([[[1.0, 0.0], [0.0, 1.0]]])
    assert plane.moved(A, points).tolist() == [[[0.0, 2.0], [-1.0, 0.0]]]
    assert plane.moved(T, points).tolist() == [[[5.0, 8.0], [4.0, 6.0]]]


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.7, -0.7, 2.0 * np.pi, -5.0 * np.pi])
def test_a_spiral_is_an_arc_for_one_turn_and_opens_after_it(angle):
    at = plane.spiral((1.0, 2.0), 3.0, 0.4, angle) - (1.0, 2.0)
    radius = np.linalg.norm(at, axis=-1)
    turned = np.unwrap(np.arctan2(at[:, 1], at[:, 0]))
    assert turned[0] == pytest.approx(0.4) and turned[-1] - turned[0] == pytest.approx(angle)
    first = np.abs(turned - turned[0]) <= 2.0 * np.pi + 1e-9
    assert radius[first] == pytest.approx(3.0) and (np.diff(radius[~first]) > 0.0).all()
    assert np.linalg.norm(np.diff(at, axis=0), axis=-1).max() < 0.06 * radius.max()


class TestPath:
    @pytest.mark.parametrize("length", [40.0, 300.0])
    def test_the_tip_of_its_head_is_its_end(self, length):
        at = np.array([[0.0, 0.0, 0.0], [0.4 * length, 0.0, 0.0], [length, 0.0, 0.0]])
        line, head = plane.path(at, style.INK, 3.0)
        assert isinstance(line, Lines) and isinstance(head, Surface)
        corners, shaft = np.asarray(head.vertices), np.asarray(line.points)
        assert corners[2].tolist() == [length, 0.0, 0.0]
        # Six widths long, and no gap between it and the curve.
        assert shaft[-1, 0] == pytest.approx(length - 18.0) and corners[:2, 0].max() < shaft[-1, 0]

    def test_what_is_too_short_has_no_head_and_what_has_no_length_is_left_out(self):
        at = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
        assert [type(record) for record in plane.path(at, style.INK, 3.0)] == [Lines]
        assert [type(record) for record in plane.path(10.0 * at, style.INK, 3.0, head=False)] == [Lines]
        assert plane.path(0.0 * at, style.INK, 3.0) == []


def test_the_glyph_is_the_letter_under_the_matrix():
    A = np.array([[1.0, 0.5], [0.0, -2.0]])
    area, edge = PAGE.glyph(A, style.AFTER, style.AFTER_EDGE, size=3.0)
    assert isinstance(area, Surface) and isinstance(edge, Lines)
    wanted = (100.0, 50.0) + 20.0 * (3.0 * letter.outline() @ A.T)
    assert np.asarray(area.vertices)[:, :2] == pytest.approx(wanted)
    assert np.asarray(edge.points)[-1].tolist() == np.asarray(edge.points)[0].tolist()


def test_a_name_stands_beyond_a_point_and_above_one_without_direction():
    assert PAGE.beyond("$a$", (1.0, 1.0), (3.0, 4.0), gap=10.0).offset == pytest.approx((6.0, 8.0))
    assert PAGE.beyond("$a$", (1.0, 1.0), (0.0, 0.0), gap=10.0).offset == pytest.approx((0.0, 10.0))
