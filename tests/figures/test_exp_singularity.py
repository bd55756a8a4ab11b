"""The laws in the picture of the exponential map of SO(3) and of two paths' logarithms."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.lie import quaternion, so3
from lietool.render import scene


def drawn(**params):
    return figure.load("exp-singularity", (paths.FIGURES,)).draw(**params).numbers


def tubes(drawing):
    """The points of the way in the half sphere, which is the last of the pictures."""
    view = drawing.picture.views[3]
    return np.concatenate([x.points for x in view.records if isinstance(x, scene.Tube)])


class TestStages:
    def test_the_quaternion_is_of_the_rotation(self, plate):
        shown = plate("B4.2").numbers
        assert np.abs(quaternion.to_matrix(shown["quaternion"]) - shown["rotation"]).max() < 1e-14
        angle = np.linalg.norm(shown["x"])
        assert np.trace(shown["rotation"]) == pytest.approx(1 + 2 * np.cos(angle))
        assert shown["quaternion"][0] == pytest.approx(np.cos(angle / 2))
        assert shown["shell"] == np.ceil(angle / (2 * np.pi))

    def test_full_turns_collapse_to_one_and_minus_one(self, plate):
        collapsed = plate("B4.2").numbers["collapsed_to"]
        assert np.abs(collapsed[:, 0] - [-1, 1, -1]).max() < 1e-14 and np.abs(collapsed[:, 1:]).max() < 1e-14

    @pytest.mark.parametrize("turn, shells", [(0.0, 3), (360.0, 3), (361.0, 3), (1080.0, 3)])
    def test_a_shell_holds_its_outer_full_turn(self, turn, shells):
        shown = drawn(turn=turn, shells=shells)
        assert shown["shell"] == max(np.ceil(turn / 360.0), 1)

    @pytest.mark.parametrize("turn, heads", [(50.0, 0), (180.0, 1), (500.0, 3), (1080.0, 6)])
    def test_heads_count_the_half_turns(self, turn, heads):
        picture = figure.load("exp-singularity", (paths.FIGURES,)).draw(turn=turn).picture
        arrows = [r for r in picture.views[3].records if isinstance(r, scene.Arrow)]
        assert len(arrows) == heads

    def test_it_shows_the_exponential_map_that_it_is_given(self):
        exp_singularity = figure.load("exp-singularity", (paths.FIGURES,))
        first_order = exp_singularity.draw_with({"exp": lambda x: np.eye(3) + so3.hat(x)})
        way = tubes(first_order)
        assert np.abs(np.linalg.norm(tubes(exp_singularity.draw()), axis=-1) - 1.0).max() < 1e-14
        # |I + X|, which grows with the angle, as the distance from the middle of the sphere.
        assert np.linalg.norm(way, axis=-1).max() > 5.0


class TestPaths:
    def test_they_show_the_logarithm_that_they_are_given(self):
        exp_singularity = figure.load("exp-singularity", (paths.FIGURES,))
        params = exp_singularity.plate_params("B4.2b")
        shown = exp_singularity.draw_with({"log": lambda R: 0.5 * so3.log(R)}, **params).numbers
        right = exp_singularity.draw(**params).numbers
        # As far as the half turn, from which on it comes back.
        assert shown["lift_through"][:60] == pytest.approx(0.5 * right["lift_through"][:60], abs=1e-12)

    def test_through_the_identity_it_jumps_by_two_pi(self, plate):
        shown = plate("B4.2b").numbers
        steps = np.linalg.norm(np.diff(shown["lift_through"], axis=0), axis=-1)
        assert np.count_nonzero(steps > 0.5) == 1
        assert steps.max() == pytest.approx(2 * np.pi, abs=0.01) == shown["largest_step"][0]

    def test_beside_the_identity_it_never_does(self, plate):
        shown = plate("B4.2b").numbers
        steps = np.linalg.norm(np.diff(shown["lift_beside"], axis=0), axis=-1)
        assert steps.max() == pytest.approx(shown["largest_step"][1]) and steps.max() < 0.5
        # It stays inside the sphere of a full turn, where no logarithm is singular.
        assert np.linalg.norm(shown["lift_beside"], axis=-1).max() < 2 * np.pi - 0.05

    def test_the_singular_value_vanishes_at_full_turns(self, plate):
        shown = plate("B4.2b").numbers
        half = shown["length"] / 2
        # |sin(|x| / 2)| / (|x| / 2), the length of what a step across x becomes.
        wanted = np.abs(np.sinc(half / np.pi))
        assert np.abs(shown["smallest_singular_value"] - wanted).max() < 1e-12

    @pytest.mark.parametrize("aside", [1.0, 20.0, 60.0])
    def test_logarithms_are_of_the_paths(self, aside):
        shown = drawn(view="paths", turn=720.0, aside=aside)
        about = so3.rotation("z", np.deg2rad(aside))
        for turned, through, beside in zip(
            shown["turn"], shown["lift_through"], shown["lift_beside"], strict=True
        ):
            first, then = min(turned, 2 * np.pi), max(turned - 2 * np.pi, 0.0)
            R = so3.rotation("y", then) @ so3.rotation("x", first)
            assert np.abs(so3.exp(through) - R).max() < 1e-9
            assert np.abs(so3.exp(beside) - about @ R).max() < 1e-9
