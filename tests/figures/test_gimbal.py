"""The laws in the pictures of gimbal lock, and that they pass into lock without a jump."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.lie import euler
from lietool.render import scene, style


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
    @pytest.fixture
    def names(self, placed):
        """Where the names of the axes on the left lie, in page units."""

        def found(theta2: float) -> dict[str, np.ndarray]:
            picture = figure.load("gimbal", (paths.FIGURES,)).draw(theta2=theta2).picture
            return {
                label.text: np.array([label.box[0] + label.box[2], label.box[1] + label.box[3]], float)
                for label in placed(picture, 0.5)
                if label.text.startswith(r"$\theta") and "=" not in label.text and label.box[2] < 300
            }

        return found

    @pytest.mark.parametrize("theta2", [-89.9, -84.0, -70.0, -50.0, 0.0])
    def test_names_move_evenly(self, theta2, names):
        here, next_ = names(theta2), names(theta2 - 0.1)
        assert set(here) == set(next_) == {rf"$\theta_{k}$" for k in (1, 2, 3)}
        for name, at in here.items():
            assert np.abs(at - next_[name]).max() <= 8.0, name

    def test_the_other_lock_is_shown_as_one(self):
        shown = figure.load("gimbal", (paths.FIGURES,)).draw(theta2=90.0).numbers
        assert shown["smallest_singular_value"] == pytest.approx([0.0, 0.0], abs=1e-15)
        # There the inner axis points against the outer one, here along it.
        inner, outer = shown["axes"][:, 0], shown["axes"][:, 2]
        assert np.sum(inner * outer, axis=-1) == pytest.approx([-1.0, 1.0])


class TestSharedLine:
    def lines(self, theta2: float) -> dict[str, np.ndarray]:
        """The strokes of the red and of the blue axis in the left picture, as intervals of height."""
        picture = figure.load("gimbal", (paths.FIGURES,)).draw(theta2=theta2).picture
        found: dict[str, list[np.ndarray]] = {style.AXIS_X: [], style.AXIS_Z: []}
        for record in picture.views[0].records:
            if isinstance(record, scene.Lines) and record.color in found:
                points = np.asarray(record.points)[:, 2]
                parts = np.split(points, np.flatnonzero(np.isnan(points)))
                found[str(record.color)] += [np.sort(part[np.isfinite(part)]) for part in parts]
        return {color: np.array(parts) for color, parts in found.items()}

    @pytest.mark.parametrize("theta2", [-90.0, 90.0])
    def test_two_axes_take_turns_on_one_line(self, theta2):
        red, blue = self.lines(theta2).values()
        assert len(red) > 4 and len(blue) > 4
        for low, high in red:
            assert (np.minimum(high, blue[:, 1]) - np.maximum(low, blue[:, 0])).max() < 1e-9

    def test_away_from_lock_each_line_is_whole(self):
        _, blue = self.lines(-20.0).values()
        gaps = np.sort(blue[:, 0])[1:] - np.sort(blue[:, 1])[:-1]
        assert sorted(gaps.round(9))[-2] == 0.0 < gaps.max()

    @pytest.mark.parametrize(("theta2", "kept"), [(90.0, "-"), (-90.0, "+")])
    def test_what_is_said_to_matter_does(self, theta2, kept):
        gimbal = figure.load("gimbal", (paths.FIGURES,))
        said = [
            r.text for r in gimbal.draw(theta2=theta2).picture.views[1].records if isinstance(r, scene.Label)
        ]
        assert sum(rf"only $\theta_1 {kept} \theta_3$ matters" in text for text in said) == 1
        back = 25.0 if kept == "-" else -25.0
        one = gimbal.draw(theta1=10.0, theta2=theta2, theta3=40.0).numbers["rotation"][0]
        same = gimbal.draw(theta1=35.0, theta2=theta2, theta3=40.0 + back).numbers["rotation"][0]
        other = gimbal.draw(theta1=35.0, theta2=theta2, theta3=40.0 - back).numbers["rotation"][0]
        assert np.abs(one - same).max() < 1e-15 < 0.1 < np.abs(one - other).max()


class TestMarked:
    @pytest.mark.parametrize(
        ("theta", "said"),
        [
            (35.0, r"$\theta_1 = -90^{\circ},\;\, \theta_2 = 35^{\circ},\;\, \theta_3 = 90^{\circ}"),
            (0.0, r"$\theta_2 = 0^{\circ},\;\, \theta_1 + \theta_3 = 0^{\circ}"),
            (180.0, r"$\theta_2 = 180^{\circ},\;\, \theta_1 - \theta_3 = 180^{\circ}"),
        ],
    )
    def test_its_values_are_printed(self, theta, said):
        drawing = figure.load("gimbal", (paths.FIGURES,)).draw(view="angles", theta2=theta)
        found = [r.text for r in drawing.picture.views[0].records if isinstance(r, scene.Label)]
        assert sum(said in text for text in found) == 1
        assert drawing.numbers["marked_singular_value"] == pytest.approx(
            np.sqrt(2.0) * abs(np.sin(np.deg2rad(min(theta, 180.0 - theta)) / 2.0)), abs=1e-15
        )
