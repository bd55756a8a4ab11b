"""Solids: unit normals that point outwards, volumes by hand, frames that do not twist, nothing degenerate."""

import numpy as np
import pytest

from lietool.render import solids
from lietool.render.solids import Triangles

ANGLE = np.linspace(0.0, 2.0 * np.pi, 241)
CIRCLE = np.stack([np.cos(ANGLE), np.sin(ANGLE), 0.0 * ANGLE], axis=-1)
HELIX = np.stack([np.cos(3 * ANGLE), np.sin(3 * ANGLE), ANGLE / 2.0], axis=-1)
ZIGZAG = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (2, 1, 1)], float)


def volume(solid: Triangles) -> float:
    vertices, faces, _ = solid
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def polygon(n: int) -> float:
    """The area of a regular polygon in the unit circle."""
    return n / 2.0 * np.sin(2.0 * np.pi / n)


CONE = 3.0 * 2.6 * 0.1
SOLIDS = {
    "ball": (solids.sphere(0.7, (1, 2, 3)), 4 / 3 * np.pi * 0.7**3),
    "arrow": (
        solids.arrow((1, 0, 0), (2, 2, 2), 0.1),
        polygon(28) * (0.01 * (3 - CONE) + 0.26**2 * CONE / 3),
    ),
    "short arrow": (
        solids.arrow((0, 0, 0), (0, 0, -0.3), 0.01, 5.0),
        polygon(28) * (1e-4 * 0.15 + 0.05**2 * 0.15 / 3),
    ),
    "straight tube": (
        solids.tube([(0, 0, 0), (0, 0, 2)], 0.1),
        polygon(16) * 0.01 * 2 + 4 / 3 * np.pi * 0.1**3,
    ),
    "helix": (
        solids.tube(HELIX, 0.1),
        polygon(16) * 0.01 * np.hypot(3, 0.5) * 2 * np.pi + 4 / 3 * np.pi * 0.1**3,
    ),
    "torus": (solids.tube(CIRCLE[:-1], 0.1, closed=True), polygon(16) * 0.01 * 2 * np.pi),
    "band": (solids.band(0.8, 1.0, 0.1), np.pi * 0.36 * 0.1),
    "cylinder": (solids.revolve([(0, 0), (0.5, 0), (0.5, 2), (0, 2)]), polygon(40) * 0.25 * 2),
}


@pytest.mark.parametrize("name", SOLIDS)
class TestEverySolid:
    def test_normals_are_unit(self, name):
        vertices, _, normals = SOLIDS[name][0]
        assert normals.shape == vertices.shape
        assert np.abs(np.linalg.norm(normals, axis=-1) - 1.0).max() < 1e-12

    def test_normals_and_faces_point_outwards(self, name):
        vertices, faces, normals = SOLIDS[name][0]
        corners = vertices[faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        whole = np.linalg.norm(across, axis=-1) > 1e-12
        assert whole.mean() > 0.6
        assert (np.einsum("ij,ikj->ik", across, normals[faces])[whole] > 0).all()

    def test_volume(self, name):
        # Slightly less than the smooth one; by the divergence theorem this says closed and oriented too.
        solid, wanted = SOLIDS[name]
        assert volume(solid) == pytest.approx(wanted, rel=0.03)

    def test_no_index_is_out_of_range(self, name):
        vertices, faces, _ = SOLIDS[name][0]
        assert faces.min() >= 0 and faces.max() < len(vertices) and np.isfinite(vertices).all()


class TestFrames:
    @pytest.mark.parametrize("direction", [(1, 0, 0), (0, -2, 0), (0, 0, 3), (1, 1, 1), (-1e-9, 0, 1e-9)])
    def test_along_a_direction(self, direction):
        frame = solids.frame_along(direction)
        assert np.abs(frame.T @ frame - np.eye(3)).max() < 1e-12 and np.linalg.det(frame) > 0
        assert frame[:, 2] == pytest.approx(np.array(direction) / np.linalg.norm(direction), abs=1e-12)

    @pytest.mark.parametrize("points", [HELIX, CIRCLE, ZIGZAG, ZIGZAG[:2]])
    def test_they_are_rotations_along_the_line(self, points):
        frames = solids.transported_frames(points, closed=False)
        assert np.abs(np.swapaxes(frames, -1, -2) @ frames - np.eye(3)).max() < 1e-12
        assert np.linalg.det(frames).min() > 0
        steps = np.diff(points, axis=0)
        assert (np.einsum("ij,ij->i", frames[:-1, :, 2], steps) > 0).all()

    @pytest.mark.parametrize("closed", [False, True])
    def test_they_do_not_twist_along_a_plane_curve(self, closed):
        tilt = solids.frame_along((1.0, 2.0, 0.5))
        ellipse = CIRCLE * (1.0, 0.4, 1.0) @ tilt.T
        frames = solids.transported_frames(ellipse, closed)
        # What the normal of the plane is in the frame does not change along the way.
        seen = np.einsum("nij,i->nj", frames, tilt[:, 2])
        assert np.ptp(seen, axis=0).max() < 1e-12

    def test_they_turn_as_little_as_possible_along_a_space_curve(self):
        frames = solids.transported_frames(HELIX, closed=False)
        between = np.swapaxes(frames[:-1], -1, -2) @ frames[1:]
        # The part of each small turn about the line itself.
        assert np.abs(between[:, 1, 0] - between[:, 0, 1]).max() < 1e-3

    def test_straight_back(self):
        frames = solids.transported_frames(np.array([(0, 0, 0), (1, 0, 0), (0, 0, 0)], float), closed=False)
        assert np.abs(np.swapaxes(frames, -1, -2) @ frames - np.eye(3)).max() < 1e-12


class TestTubes:
    def test_a_helix_keeps_its_radius(self):
        vertices, _, _ = solids.tube(HELIX, 0.1)
        rings = vertices.reshape(-1, 17, 3)[6:-6]
        assert np.abs(np.linalg.norm(rings - HELIX[:, None], axis=-1) - 0.1).max() < 1e-12
        assert np.linalg.norm(rings[:, 0] - rings[:, -1], axis=-1).max() < 1e-12

    def test_a_closed_one_has_no_ends(self):
        for points in (CIRCLE, CIRCLE[:-1]):
            rings = solids.tube(points, 0.1, closed=True)[0].reshape(-1, 17, 3)
            assert len(rings) == len(CIRCLE)
            # The last ring is the first again, wherever its points begin.
            assert np.linalg.norm(rings[0].mean(axis=0) - rings[-1].mean(axis=0)) < 1e-12
            assert np.abs(np.linalg.norm(rings[-1] - CIRCLE[0], axis=-1) - 0.1).max() < 1e-12

    def test_the_ends_are_half_balls(self):
        vertices, _, _ = solids.tube([(0, 0, 0), (2, 0, 0)], 0.25)
        assert vertices[:, 0].min() == pytest.approx(-0.25) and vertices[:, 0].max() == pytest.approx(2.25)
        cap = vertices[vertices[:, 0] < 0]
        assert np.abs(np.linalg.norm(cap, axis=-1) - 0.25).max() < 1e-12

    def test_repeated_points(self):
        once, often = solids.tube(ZIGZAG, 0.1), solids.tube(np.repeat(ZIGZAG, 3, axis=0), 0.1)
        assert np.array_equal(once[0], often[0])

    def test_one_point_is_a_ball(self):
        for points in ([(1, 2, 3)], [(1, 2, 3)] * 4):
            vertices, _, _ = solids.tube(points, 0.5)
            assert np.abs(np.linalg.norm(vertices - (1, 2, 3), axis=-1) - 0.5).max() < 1e-12

    def test_straight_back(self):
        vertices, _, normals = solids.tube([(0, 0, 0), (1, 0, 0), (0.3, 0, 0)], 0.1)
        assert np.isfinite(vertices).all() and np.abs(np.linalg.norm(normals, axis=-1) - 1).max() < 1e-12


class TestDegenerate:
    def test_an_arrow_without_length(self):
        vertices, faces, normals = solids.arrow((1, 2, 3), (1, 2, 3), 0.1)
        assert vertices.shape == normals.shape == (0, 3) and faces.shape == (0, 3)

    def test_a_corner_twice_in_a_profile(self):
        once, twice = (
            solids.revolve(p) for p in ([(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 0), (1, 0), (1, 1)])
        )
        assert np.array_equal(once[0], twice[0]) and np.array_equal(once[1], twice[1])

    def test_an_arrow_points(self):
        vertices, _, _ = solids.arrow((0, 0, 0), (0, 0, 1), 0.02)
        tip = vertices[vertices[:, 2] > 1 - 1e-12]
        assert len(tip) and np.abs(tip[:, :2]).max() < 1e-12
        wide = np.linalg.norm(vertices[:, :2], axis=-1)
        assert wide.max() == pytest.approx(2.6 * 0.02)


class TestGrid:
    def test_normals_of_a_ball_in_polar_coordinates(self):
        theta, phi = np.meshgrid(np.linspace(0, np.pi, 61), np.linspace(0, 2 * np.pi, 121), indexing="ij")
        points = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
        vertices, faces, normals = solids.grid(points)
        assert np.abs(np.linalg.norm(normals, axis=-1) - 1).max() < 1e-12
        along = np.einsum("ij,ij->i", normals, vertices)
        assert along.min() > 0.995 and len(faces) == 2 * 60 * 120

    def test_faces(self):
        faces = solids.grid_faces(3, 4)
        assert faces.shape == (12, 3) and set(faces.ravel()) == set(range(12))
        for empty in ((1, 4), (3, 1)):
            assert solids.grid_faces(*empty).shape == (0, 3)
