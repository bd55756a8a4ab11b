"""Figure 2.5: Rodrigues' formula."""

import numpy as np
import pytest
from lietool.figures.ch2 import axis_angle

from lietool import figure, paths
from lietool.lie import quaternion
from lietool.render.camera import project


def drawn(**params):
    return figure.load("axis-angle", (paths.FIGURES,)).draw(**params)


def unit(v):
    return np.array(v) / np.linalg.norm(v)


class TestNumbers:
    def test_the_parts_make_the_image(self, plate):
        built = plate("B2.5")
        shown, theta = built.numbers, np.deg2rad(built.item.parameters["angle"])
        parts = shown["along"] + np.cos(theta) * shown["across"] + np.sin(theta) * shown["cross"]
        assert parts == pytest.approx(shown["image"], abs=1e-14)

    def test_it_is_the_rotation_of_the_quaternion(self, plate):
        built = plate("B2.5")
        shown, given = built.numbers, built.item.parameters
        q = quaternion.from_axis_angle(shown["axis"], np.deg2rad(given["angle"]))
        assert quaternion.act(q, unit(given["x"])) == pytest.approx(shown["image"], abs=1e-14)

    def test_the_three_vectors_are_at_right_angles(self, plate):
        shown = plate("B2.5").numbers
        vectors = np.stack([shown["along"], shown["across"], shown["cross"]])
        gram = vectors @ vectors.T
        assert np.abs(gram - np.diag(np.diag(gram))).max() < 1e-14
        assert gram[1, 1] == pytest.approx(gram[2, 2]) == pytest.approx(shown["radius"] ** 2)
        assert np.linalg.det(vectors) > 0.0

    @pytest.mark.parametrize("angle", [0.0, 360.0, -720.0])
    def test_full_turns_bring_it_back(self, angle):
        assert drawn(angle=angle).numbers["image"] == pytest.approx(unit((0.9, -0.4, 0.6)), abs=1e-14)

    def test_what_lies_on_the_axis_stays(self):
        shown = drawn(u=(1.0, 2.0, -2.0), x=(2.0, 4.0, -4.0), angle=77.0).numbers
        assert shown["image"] == pytest.approx(np.array([1.0, 2.0, -2.0]) / 3.0)
        assert shown["radius"] == pytest.approx(0.0, abs=1e-14)

    @pytest.mark.parametrize("size", [1e-100, 0.01, 7.0])
    def test_only_the_direction_of_x_counts(self, size):
        x = np.array([0.9, -0.4, 0.6])
        found = drawn(x=tuple(map(float, size * x))).numbers
        assert found["image"] == pytest.approx(drawn(x=(0.9, -0.4, 0.6)).numbers["image"], abs=1e-14)
        assert np.linalg.norm(found["vector"]) == pytest.approx(1.0)

    def test_the_zero_vector_stays(self):
        assert not drawn(x=(0.0, 0.0, 0.0)).numbers["image"].any()

    @pytest.mark.parametrize("u", [(0.0, 0.0, 0.0), (1e-200, 0.0, 0.0), (0.0, 1e200, 0.0)])
    def test_an_axis_without_direction_is_refused(self, u):
        with pytest.raises(ValueError, match=r"^u must have a length of .*; got .* Write .*") as caught:
            drawn(u=u)
        assert "\n" not in str(caught.value)


class TestCamera:
    @pytest.mark.parametrize(
        "u", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (1, 0.75, 0.5), (-1, -1, -1), (0.3, -2, 0.1)]
    )
    def test_the_circle_is_seen_open(self, u):
        axis = np.array(u, float) / np.linalg.norm(u)
        x = np.array([0.5, 0.4, 0.7])
        shown = axis_angle.parts(axis, x / np.linalg.norm(x), 1.0)
        camera = axis_angle.camera_for(shown)
        assert 0.25 < abs(camera.axes[2] @ axis) < 0.75
        ring = shown.around(shown.radius, np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False))
        seen = project(camera, (0.0, 0.0, 1000.0, 1000.0), ring)[:, :2]
        wide, narrow = np.linalg.svd(seen - seen.mean(axis=0), compute_uv=False)
        assert narrow / wide > 0.2

    @pytest.mark.parametrize("u", [(0, 0, 1), (0, 0, -1), (1, 0.75, 0.5), (0.3, -2, 0.1)])
    def test_no_meridian_runs_beside_the_axis(self, u):
        axis = unit(u)
        shown = axis_angle.parts(axis, unit((0.5, 0.4, 0.7)), 1.0)
        camera = axis_angle.camera_for(shown)
        frame = axis_angle.graticule(shown, camera)
        assert frame[:, 2] == pytest.approx(axis) and np.linalg.det(frame) == pytest.approx(1.0)
        # The eye lies in the plane of two opposite meridians.
        assert np.linalg.det(np.stack([frame[:, 0], axis, camera.eye])) == pytest.approx(0.0, abs=1e-9)

    def test_it_rests_while_the_angle_changes(self):
        cameras = [drawn(angle=angle).picture.views[1].camera for angle in (0.0, 100.0, -250.0)]
        assert cameras[0] == cameras[1] == cameras[2]
