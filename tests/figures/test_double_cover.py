"""Figure 2.7: a turning solid and its unit quaternion."""

import numpy as np
import pytest
from lietool.figures.ch2 import double_cover

from lietool import figure, paths
from lietool.lie import quaternion, so3

U = np.array([2.0, -1.0, 2.0]) / 3.0
START = np.array([0.1, -0.7, 0.5, 0.5])


def drawn(**params):
    return figure.load("double-cover", (paths.FIGURES,)).draw(**params).numbers


class TestNumbers:
    def test_one_turn_arrives_at_the_opposite_and_two_at_the_start(self):
        q = drawn(turn=0.0)["quaternion"]
        assert drawn(turn=360.0)["quaternion"] == pytest.approx(-q, abs=1e-14)
        assert drawn(turn=720.0)["quaternion"] == pytest.approx(q, abs=1e-14)
        assert drawn(turn=1440.0)["quaternion"] == pytest.approx(q, abs=1e-14)

    def test_the_rotation_is_back_after_each_turn(self):
        R = drawn(turn=40.0)["rotation"]
        for turn in (400.0, 760.0, 1120.0):
            assert np.abs(drawn(turn=turn)["rotation"] - R).max() < 1e-14

    def test_solids_at_opposite_points_look_alike(self, plate):
        shown = plate("B2.7").numbers
        q, R = shown["quaternions"], shown["rotations"]
        assert np.abs(q[:4] + q[4:]).max() < 1e-14
        assert np.abs(R[:4] - R[4:]).max() < 1e-14
        # And no two others do.
        apart = np.abs(R[:4, None] - R[None, :4]).max(axis=(-1, -2)) + np.eye(4)
        assert apart.min() > 0.1

    def test_rotations_are_those_of_axis_and_angle(self, plate):
        shown = plate("B2.7").numbers
        wanted = so3.from_axis_angle(shown["axis"], np.deg2rad(shown["stages"]))
        assert np.abs(shown["rotations"] - wanted).max() < 1e-14

    def test_distances_rise_and_fall(self, plate):
        shown = plate("B2.7").numbers
        turn = shown["turn"]
        of_R = np.abs((turn + 180.0) % 360.0 - 180.0)
        of_q = np.abs((turn / 2.0 + 180.0) % 360.0 - 180.0)
        assert np.abs(shown["distances"] - np.stack([of_R, of_q], axis=-1)).max() < 1e-6

    def test_every_solid_shows_its_front(self, plate):
        look = np.array(double_cover.LOOK) / np.linalg.norm(double_cover.LOOK)
        # The front of the letter looks along x; seen more aslant it can hardly be read.
        assert (plate("B2.7").numbers["rotations"][:, :, 0] @ look).min() > 0.5

    @pytest.mark.parametrize("name", ["axis", "q"])
    def test_what_has_no_direction_is_refused(self, name):
        with pytest.raises(ValueError, match=rf"^{name} must have a length of .*; got .* Write .*"):
            drawn(**{name: (0.0,) * (3 if name == "axis" else 4)})


class TestLift:
    def test_it_is_continuous_where_the_principal_quaternion_jumps(self):
        start = START / np.linalg.norm(START)
        theta = np.linspace(0.0, 4.0 * np.pi, 400)
        q = double_cover.lift(U, start, theta)
        steps = np.linalg.norm(np.diff(q, axis=0), axis=-1)
        assert steps.max() < np.diff(theta).max()
        principal = quaternion.from_matrix(quaternion.to_matrix(q))
        assert np.linalg.norm(np.diff(principal, axis=0), axis=-1).max() > 1.9

    def test_it_turns_about_the_axis_after_the_start(self):
        start = START / np.linalg.norm(START)
        R = quaternion.to_matrix(double_cover.lift(U, start, 1.2))
        assert np.abs(R - so3.from_axis_angle(U, 1.2) @ quaternion.to_matrix(start)).max() < 1e-14

    def test_it_stays_on_its_slice_of_the_sphere(self):
        start = START / np.linalg.norm(START)
        theta = np.linspace(0.0, 4.0 * np.pi, 50)
        s = double_cover.Shown(U, start, 0.0, theta, double_cover.lift(U, start, theta), start)
        at = s.on_sphere(s.at_stages)
        wanted = np.stack([np.sin(theta / 2.0), 0.0 * theta, np.cos(theta / 2.0)], axis=-1)
        assert np.abs(at - wanted).max() < 1e-14
