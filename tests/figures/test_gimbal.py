"""The laws in the pictures of gimbal lock, and that they pass into lock without a jump."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.lie import euler
from lietool.render import draw


class TestGimbal:
    def test_at_lock_two_axes_are_one(self, plate):
        shown = plate("GL1").numbers
        assert shown["smallest_singular_value"][1] < 1e-15 < 0.1 < shown["smallest_singular_value"][0]
        ordinary, locked = shown["axes"]
        assert abs(locked[0] @ locked[2]) == pytest.approx(1.0, abs=1e-15)
        assert abs(np.linalg.det(locked)) < 1e-15 < 0.1 < abs(np.linalg.det(ordinary))
        for axes, smallest in zip(shown["axes"], shown["smallest_singular_value"], strict=True):
            assert np.linalg.svd(axes, compute_uv=False)[-1] == pytest.approx(smallest, abs=1e-15)

    def test_the_other_choice_of_signs_gives_the_same_rotations(self, plate):
        shown = plate("GL2").numbers
        about_z = shown["rotation_by_other_angles"]
        cosine, sine = np.cos(shown["theta"]), np.sin(shown["theta"])
        assert np.abs(about_z[:, 0, 0] - cosine).max() < 1e-14 > np.abs(about_z[:, 1, 0] - sine).max()
        assert np.abs(about_z[:, 2, 2] - 1.0).max() < 1e-14

    def test_the_rotation_is_the_product_of_its_angles(self, plate):
        shown = plate("GL1").numbers
        for angles, R in zip(shown["angles"], shown["rotation"], strict=True):
            (a, b, c), (p, q, r) = np.cos(angles), np.sin(angles)
            x = np.array([[1, 0, 0], [0, a, -p], [0, p, a]])
            y = np.array([[b, 0, q], [0, 1, 0], [-q, 0, b]])
            z = np.array([[c, -r, 0], [r, c, 0], [0, 0, 1]])
            assert np.abs(z @ y @ x - R).max() < 1e-15

    def test_the_angles_jump_though_the_rotation_does_not(self, plate):
        shown = plate("GL2").numbers
        angles, middle = shown["angles"], len(shown["theta"]) // 2
        steps = np.rad2deg(np.abs(np.diff(angles, axis=0)))
        jump = steps[middle - 1]
        assert sorted(jump.round(6))[1:] == pytest.approx([180.0, 180.0]) and jump[1] < 1e-9
        assert np.delete(steps, middle - 1, axis=0).max() < 2.0
        rotations = euler.to_matrix(angles, "xyx")
        assert np.abs(np.diff(rotations, axis=0)).max() < 0.02

    def test_where_the_singular_values_vanish(self, plate):
        shown = plate("GL2").numbers
        degrees = np.rad2deg(shown["theta_2"]).round(6)
        for convention, zeros in (("xyx", [-180.0, 0.0, 180.0]), ("xyz", [-90.0, 90.0])):
            smallest = shown[f"smallest_singular_value_{convention}"]
            assert degrees[smallest < 1e-9].tolist() == zeros
            assert 0.9 < smallest.max() <= 1.0 + 1e-12


class TestMotion:
    def placed(self, theta2: float) -> dict[str, list[np.ndarray]]:
        """Where the names of the axes on the left lie, in page units."""
        picture = figure.load("gimbal", (paths.FIGURES,)).draw(theta2=theta2).picture
        labels = draw.render(picture, size=(600, 450), draft=True).labels
        return {
            label.text: np.array([label.box[0] + label.box[2], label.box[1] + label.box[3]], float)
            for label in labels
            if label.text.startswith(r"$\theta") and "=" not in label.text and label.box[2] < 300
        }

    @pytest.mark.parametrize("theta2", [-89.9, -84.0, -70.0, -50.0, 0.0])
    def test_names_move_evenly(self, theta2):
        here, next_ = self.placed(theta2), self.placed(theta2 - 0.1)
        assert set(here) == set(next_) == {rf"$\theta_{k}$" for k in (1, 2, 3)}
        for name, at in here.items():
            assert np.abs(at - next_[name]).max() <= 8.0, name

    def test_the_other_lock_is_shown_as_one(self):
        shown = figure.load("gimbal", (paths.FIGURES,)).draw(theta2=90.0).numbers
        assert shown["smallest_singular_value"] == pytest.approx([0.0, 0.0], abs=1e-15)
        # There the inner axis points against the outer one, here along it.
        inner, outer = shown["axes"][:, 0], shown["axes"][:, 2]
        assert np.sum(inner * outer, axis=-1) == pytest.approx([-1.0, 1.0])
