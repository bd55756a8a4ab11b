"""Marks in space: names beyond tips, the solid letter, arrows along curves."""

import numpy as np
import pytest

from lietool.render import marks, style
from lietool.render.camera import Camera
from lietool.render.scene import Arrow, Surface, Tube

CAMERA = Camera((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 2.0)


def test_a_name_stands_where_the_camera_sees_the_direction_point():
    assert marks.beyond("$z$", np.zeros(3), (0.0, 0.0, 2.0), CAMERA, gap=10.0).offset == pytest.approx(
        (0, 10)
    )
    assert marks.beyond("$y$", np.zeros(3), (0.0, 5.0, 0.0), CAMERA, gap=10.0).offset == pytest.approx(
        (10, 0)
    )
    # Towards the eye there is no direction on the page.
    assert marks.beyond("$x$", np.zeros(3), (1.0, 0.0, 0.0), CAMERA, gap=10.0).offset == (0.0, 10.0)


@pytest.mark.parametrize("A", [np.eye(3), np.diag([1.0, -2.0, 0.5])], ids=["rotation", "reflection"])
def test_the_faces_of_the_letter_look_outwards(A):
    surfaces = [r for r in marks.letter(A, (5.0, 6.0, 7.0)) if isinstance(r, Surface)]
    corners = np.concatenate([np.asarray(r.vertices)[np.asarray(r.faces)] for r in surfaces])
    # The volume that the faces enclose is positive, and that of the letter under A.
    volume = np.linalg.det(corners - (5.0, 6.0, 7.0)).sum() / 6.0
    same = [r for r in marks.letter(np.eye(3)) if isinstance(r, Surface)]
    before = np.concatenate([np.asarray(r.vertices)[np.asarray(r.faces)] for r in same])
    assert volume == pytest.approx(abs(np.linalg.det(A)) * np.linalg.det(before).sum() / 6.0)
    assert volume > 0.0


class TestCurvedArrow:
    along = np.linspace(0.0, 2.0, 41)
    curve = np.stack([np.cos(along), np.sin(along), 0.0 * along], axis=-1)

    def test_its_tip_is_the_end_of_the_curve(self):
        tube, arrow = marks.curved_arrow(self.curve, style.INK, 0.01)
        assert isinstance(tube, Tube) and isinstance(arrow, Arrow)
        assert np.array_equal(arrow.end, self.curve[-1]) and np.array_equal(
            np.asarray(tube.points)[0], [1, 0, 0]
        )
        head = np.linalg.norm(np.asarray(arrow.end) - np.asarray(tube.points)[-1])
        assert head == pytest.approx(3.0 * 2.6 * 0.01, rel=1e-3)

    def test_a_short_one_is_straight_and_one_without_length_is_nothing(self):
        (arrow,) = marks.curved_arrow(0.01 * self.curve, style.INK, 0.01)
        assert isinstance(arrow, Arrow)
        assert marks.curved_arrow(0.0 * self.curve, style.INK, 0.01) == []


def test_axes_have_arrows_of_their_length():
    arrows = [r for r in marks.coordinate_axes(CAMERA, ("$x$", "$y$", "$z$"), 1.5) if isinstance(r, Arrow)]
    assert np.array_equal([arrow.end for arrow in arrows], 1.5 * np.eye(3))
