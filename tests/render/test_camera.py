"""Cameras: what is where on the page."""

import numpy as np
import pytest

from lietool.render.camera import Camera, Page, project

BOX = (100.0, 50.0, 600.0, 300.0)
CAMERAS = [
    Camera(),
    Camera((0.0, -3.0, 0.4), (1.0, 2.0, 3.0), 5.0),
    Camera((0.0, 0.0, 1.0)),
    Camera((0.0, 0.0, -2.0), height=0.01),
    Camera((1.0, 0.0, 0.0), height=2000.0, fov=np.deg2rad(60.0)),
]


@pytest.mark.parametrize("camera", CAMERAS)
class TestCamera:
    def test_axes_are_a_rotation_with_the_vertical_up(self, camera):
        right, up, back = camera.axes
        assert np.abs(camera.axes @ camera.axes.T - np.eye(3)).max() < 1e-12
        assert np.linalg.det(camera.axes) == pytest.approx(1.0)
        assert back @ camera.direction == pytest.approx(np.linalg.norm(camera.direction))
        assert abs(right[2]) < 1e-12 and up[2] >= -1e-12

    def test_the_target_is_in_the_middle(self, camera):
        x, y, depth = project(camera, BOX, camera.target)
        assert (x, y) == pytest.approx((400.0, 200.0)) and depth == pytest.approx(camera.distance)
        assert np.linalg.norm(camera.eye - camera.target) == pytest.approx(camera.distance)

    def test_height_is_what_the_box_shows(self, camera):
        right, up, _ = camera.axes
        ends = np.array([-0.5, 0.5])[:, None] * camera.height
        assert project(camera, BOX, camera.target + ends * up)[:, 1] == pytest.approx([50.0, 350.0])
        # The scale is the same both ways.
        assert project(camera, BOX, camera.target + ends * right)[:, 0] == pytest.approx([250.0, 550.0])

    def test_nearer_is_larger(self, camera):
        _, up, back = camera.axes
        step = 0.2 * camera.height
        sizes = [
            np.diff(project(camera, BOX, camera.target + s * back + [[0.0], [step]] * up)[:, 1])[0]
            for s in (-step, 0.0, step)
        ]
        assert sizes[0] < sizes[1] < sizes[2]
        depths = [project(camera, BOX, camera.target + s * back)[2] for s in (-step, step)]
        assert np.diff(depths)[0] == pytest.approx(-2 * step)

    def test_batches_of_points(self, camera):
        points = np.random.default_rng(2).normal(size=(2, 5, 3)) * camera.height / 4 + camera.target
        whole = project(camera, BOX, points)
        assert whole.shape == (2, 5, 3)
        assert whole[1, 3] == pytest.approx(project(camera, BOX, points[1, 3]))

    def test_clip_space(self, camera):
        # Everything within half a height of the target is between the near and the far plane, nearer first.
        z = np.array([-0.5, 0.0, 0.5]) * camera.height
        seen = np.stack([0 * z, 0 * z, z - camera.distance, 1 + 0 * z], axis=-1)
        clip = seen @ camera.projection(BOX).T
        depth = clip[:, 2] / clip[:, 3]
        assert (np.abs(depth) < 1).all() and depth[0] > depth[1] > depth[2]

    def test_the_outline_of_a_ball_is_where_lines_of_sight_touch(self, camera):
        center, radius = np.add(camera.target, 0.1 * camera.height), 0.3 * camera.height
        ring = camera.sphere_outline(center, radius, 33)
        assert ring.shape == (33, 3) and ring[0] == pytest.approx(ring[-1])
        assert np.linalg.norm(ring - center, axis=-1) == pytest.approx(np.full(33, radius))
        assert np.abs(np.sum((ring - center) * (ring - camera.eye), axis=-1)).max() < 1e-9 * camera.height**2


def test_a_page_is_its_box():
    points = np.array([(0.0, 0.0, 0.0), (600.0, 300.0, 5.0), (17.5, 3.25, -9.0)])
    assert project(Page(), BOX, points)[:, :2] == pytest.approx(points[:, :2] + (100.0, 50.0))
    assert project(Page(), BOX, points)[:, 2].tolist() == [0.0, -5.0, 9.0]
