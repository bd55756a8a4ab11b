"""Meshes in space: normals and creases, outlines, level lines, hatching, shadows, probes, pages of views."""

import numpy as np
import pytest

from lietool.render import mesh_lines, mesh_look, mesh_page, mesh_shading, solids, style
from lietool.render.batches import Lens, batches
from lietool.render.camera import Camera, project
from lietool.render.scene import Arrow, Lines, Surface
from lietool.render.theme import BOOK, Mix

CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
CUBE = np.array(
    [
        0,
        1,
        3,
        0,
        3,
        2,
        4,
        6,
        7,
        4,
        7,
        5,
        0,
        4,
        5,
        0,
        5,
        1,
        2,
        3,
        7,
        2,
        7,
        6,
        0,
        2,
        6,
        0,
        6,
        4,
        1,
        5,
        7,
        1,
        7,
        3,
    ]
).reshape(12, 3)
CAMERA = Camera((1.0, 0.8, 0.6), (0.0, 0.0, 0.0), 4.0)
BOX = (0.0, 0.0, 900.0, 900.0)


def ball(rings: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """A closed ball of radius 1 whose vertices are shared."""
    V, F, _ = solids.sphere(1.0, rings=rings)
    V, place = np.unique(np.round(V, 9), axis=0, return_inverse=True)
    F = np.reshape(place, -1)[F]
    return V, F[np.diff(F[:, [0, 1, 2, 0]], axis=1).all(axis=1)]


def segments(points: np.ndarray) -> np.ndarray:
    """Ends (k, 2, 3) of the lines between rows of NaN."""
    rows = np.asarray(points).reshape(-1, 3, 3)
    assert np.isnan(rows[:, 2]).all()
    return rows[:, :2]


class TestShading:
    def test_a_ball_has_the_normals_of_a_ball_and_no_vertex_twice(self):
        V, F = ball()
        vertices, faces, N, origin = mesh_shading.shading(V, F)
        assert np.array_equal(vertices, V) and np.array_equal(faces, F)
        assert np.array_equal(origin, np.arange(len(V)))
        assert np.abs(N - V).max() < 0.01

    def test_a_cube_has_flat_faces(self):
        V, F, N, origin = mesh_shading.shading(CORNERS, CUBE)
        assert np.array_equal(V, CORNERS[origin])
        assert np.array_equal(origin[F], CUBE)
        assert N[F] == pytest.approx(np.repeat(mesh_lines.face_normals(CORNERS, CUBE)[:, None], 3, axis=1))

    def test_without_creases_a_cube_is_as_smooth_as_a_ball(self):
        V, _, N, _ = mesh_shading.shading(CORNERS, CUBE, np.pi)
        assert pytest.approx(V / np.sqrt(3.0)) == N

    def test_colours_by_face_and_by_vertex_go_with_their_own(self):
        colors = mesh_look.mixed((style.INK, style.PAPER), np.linspace((1, 0), (0, 1), 12))
        (by_face,) = mesh_look.surface(CORNERS, CUBE, colors, by_face=True)
        assert isinstance(by_face, Surface) and isinstance(by_face.color, Mix)
        assert by_face.color.weights[np.asarray(by_face.faces)] == pytest.approx(
            np.repeat(colors.weights[:, None], 3, axis=1)
        )
        (by_vertex,) = mesh_look.surface(CORNERS, CUBE, colors[:8])
        assert isinstance(by_vertex.color, Mix)
        at = np.asarray(by_vertex.vertices)
        rows = np.argmin(np.linalg.norm(at[:, None] - CORNERS, axis=2), axis=1)
        assert by_vertex.color.weights == pytest.approx(colors.weights[rows])

    def test_no_faces_are_nothing(self):
        assert mesh_look.surface(CORNERS, np.zeros((0, 3), int), style.INK) == []
        assert mesh_look.shadow(CORNERS, np.zeros((0, 3), int)) == []


class TestLines:
    def test_a_closed_mesh_has_three_edges_for_two_faces(self):
        F = ball()[1]
        found = mesh_lines.edges(F)
        assert 2 * len(found.ends) == 3 * len(F)
        assert (found.sides >= 0).all()
        # Each edge belongs to both of the faces that it names.
        for k in (0, 1):
            inside = F[found.sides[:, k]]
            assert (inside[:, :, None] == found.ends[:, None, :]).any(axis=1).all()
            assert (found.opposite[:, k] == inside.sum(axis=1) - found.ends.sum(axis=1)).all()

    def test_a_face_alone_is_all_boundary(self):
        found = mesh_lines.edges([[0, 1, 2]])
        assert (found.sides == [0, -1]).all()
        assert len(segments(mesh_lines.contour(np.eye(3), [[0, 1, 2]], CAMERA))) == 3

    def test_the_creases_of_a_cube_are_its_twelve_edges(self):
        assert len(segments(mesh_lines.creases(CORNERS, CUBE))) == 12
        assert len(segments(mesh_lines.all_edges(CORNERS, CUBE))) == 18
        assert len(segments(mesh_lines.creases(CORNERS, CUBE, np.radians(100.0)))) == 0

    def test_the_contour_of_a_cube_from_a_corner_is_a_hexagon(self):
        found = segments(mesh_lines.contour(CORNERS, CUBE, CAMERA))
        assert len(found) == 6
        # The nearest corner and the farthest are not on it.
        assert np.abs(np.abs(found.sum(axis=2)) - 1.0).max() == pytest.approx(0.0)

    def test_the_contour_of_a_ball_is_where_lines_of_sight_touch_it(self):
        V, F = ball(64)
        found = segments(mesh_lines.contour(V, F, CAMERA)).reshape(-1, 3)
        circle = CAMERA.sphere_outline((0.0, 0.0, 0.0), 1.0)
        assert np.linalg.norm(found[:, None] - circle[None], axis=-1).min(axis=1).max() < 0.08

    def test_a_hollow_contour_is_left_out(self):
        # A roof, and a valley: two faces, one seen from in front and one from behind.
        V = np.array([[0.0, -1, 0], [0, 1, 0], [1, 0, -1], [0.4, 0, -1]])
        F = np.array([[0, 2, 1], [0, 1, 3]])
        side = Camera((-1.0, 0.0, 0.2), (0.0, 0.0, 0.0), 4.0)
        turned = mesh_lines.edges(F).sides
        ridge = (turned >= 0).all(axis=1)
        assert ridge.sum() == 1
        roof = len(segments(mesh_lines.contour(V, F, side)))
        valley = len(segments(mesh_lines.contour(V, F[:, ::-1], side)))
        assert {roof, valley} == {4, 5}

    def test_level_lines_are_where_the_function_has_the_level(self):
        V, F = ball()
        for level in (-0.31, 0.0, 0.52):
            found = segments(mesh_lines.level_lines(V, F, V[:, 2], [level]))
            assert found[..., 2] == pytest.approx(level)
            assert np.linalg.norm(found[:, 1] - found[:, 0], axis=1).sum() == pytest.approx(
                2.0 * np.pi * np.sqrt(1.0 - level**2), rel=0.01
            )

    def test_hatching_is_straight_and_even_on_the_page(self):
        V, F = np.array([[0.0, -1, -1], [0, 1, -1], [-0.8, 0.1, 1]]), np.array([[0, 1, 2]])
        found = segments(mesh_lines.hatching(V, F, CAMERA, BOX, 12.0))
        assert len(found) > 20
        seen = project(CAMERA, BOX, found)
        slant = (seen[..., 0] + seen[..., 1]) / np.sqrt(2.0) / 12.0
        assert slant == pytest.approx(np.round(slant), abs=1e-9)
        assert len(np.unique(np.round(slant[:, 0]))) == len(found)
        normal = mesh_lines.face_normals(V, F)[0]
        assert (found - V[0]) @ normal == pytest.approx(0.0, abs=1e-12)
        assert mesh_lines.hatching(V, F[:0], CAMERA, BOX).shape == (0, 3)


class TestMarks:
    def test_a_shadow_covers_the_ground_under_the_mesh_and_no_more(self):
        (found,) = mesh_look.shadow(CORNERS, CUBE, strength=1.0)
        assert isinstance(found, Surface) and isinstance(found.color, Mix)
        P, dark = np.asarray(found.vertices), found.color.alpha
        assert P[:, 2] == pytest.approx(-1.0)
        middle = np.abs(P[:, :2]).max(axis=1) < 0.5
        outside = np.abs(P[:, :2]).max(axis=1) > 1.5
        assert dark[middle].min() > 0.9
        assert dark[outside].max() < 0.05
        # A shadow is as strong as it is said to be, and lies where the ground is.
        (low,) = mesh_look.shadow(CORNERS, CUBE, ground=-3.0, strength=0.5)
        assert isinstance(low, Surface) and isinstance(low.color, Mix)
        assert np.asarray(low.vertices)[:, 2] == pytest.approx(-3.0)
        assert low.color.alpha.max() <= 0.5

    def test_a_probe_has_its_axes_as_long_as_its_frame_says(self):
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = np.diag([1.0, 2.0, 0.5]), (1.0, 2.0, 3.0)
        arrows = [r for r in mesh_look.probe(frame, 0.3, moved=True) if isinstance(r, Arrow)]
        assert [a.color for a in arrows] == list(style.AXES)
        tips = np.array([a.end for a in arrows]) - frame[:3, 3]
        assert tips == pytest.approx(0.3 * frame[:3, :3].T)
        assert len({r.color for r in mesh_look.probe(frame, 0.3) if isinstance(r, Arrow)}) == 1

    def test_a_turn_ends_at_its_angle(self):
        x = np.radians(400.0) * np.array([0.0, 0.0, 1.0])
        *arc, name = mesh_look.turn((0.0, 0.0, 0.0), x, 0.5, CAMERA)
        assert name.text == r"$400^{\circ}$"
        tube, head = arc
        cone = np.asarray(head.vertices)
        start = np.asarray(tube.points)[0]
        tip = cone[np.argmax(np.linalg.norm(cone - tube.points[-1], axis=1))]
        angle = np.arctan2(tip[1], tip[0]) - np.arctan2(start[1], start[0])
        assert np.degrees(angle) % 360.0 == pytest.approx(40.0)
        assert np.linalg.norm(start) == pytest.approx(0.5)
        assert np.linalg.norm(tip) == pytest.approx(1.25 * 0.5)
        plain = mesh_look.turn((0.0, 0.0, 0.0), 0.7 * x, 0.5, CAMERA)[0].points
        assert np.linalg.norm(plain, axis=1) == pytest.approx(0.5, rel=1e-3)
        short = mesh_look.turn((0.0, 0.0, 0.0), 0.04 * x, 0.5, CAMERA)[0]
        assert isinstance(short, Arrow) and np.linalg.norm(short.end) == pytest.approx(0.5)
        assert mesh_look.turn((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.5, CAMERA) == []

    def test_a_cage_shows_no_diagonals(self):
        lines = [r for r in mesh_look.cage(CORNERS, CUBE, picked=(2, 3)) if isinstance(r, Lines)]
        assert len(segments(lines[0].points)) == 12

    def test_weights_are_pale_at_zero_dark_at_one_and_red_below(self):
        colors = mesh_look.weight_colors([0.0, 1.0, 1.7, -1.0, 0.5])
        first, last, red = 0, len(mesh_look.WEIGHTS) - 1, len(mesh_look.WEIGHTS)
        assert colors.weights[[0, 1, 2, 3], [first, last, last, red]] == pytest.approx(1.0)
        assert colors.weights.sum(axis=1) == pytest.approx(1.0)


class TestPage:
    def test_a_grid_fills_its_area(self):
        boxes = np.array(mesh_page.grid(2, 3, (10.0, 20.0, 320.0, 210.0), 10.0))
        assert boxes[:, 2:] == pytest.approx(np.tile([100.0, 100.0], (6, 1)))
        assert boxes[0] == pytest.approx([10, 130, 100, 100])
        assert boxes[5] == pytest.approx([230, 20, 100, 100])

    def test_each_shape_is_in_the_middle_of_its_box_in_one_scale(self):
        boxes = [(0.0, 0.0, 300.0, 400.0), (300.0, 0.0, 500.0, 200.0)]
        shapes = [CORNERS, 0.5 * CORNERS + (9.0, 0.0, 0.0)]
        cameras = mesh_page.each(shapes, (1.0, 0.5, 0.3), boxes)
        wide = []
        for V, camera, box in zip(shapes, cameras, boxes, strict=True):
            seen = project(camera, box, V)[:, :2]
            low, high = seen.min(axis=0), seen.max(axis=0)
            assert (low >= box[:2]).all() and (high <= np.add(box[:2], box[2:])).all()
            assert (low + high) / 2.0 == pytest.approx(np.add(box[:2], np.divide(box[2:], 2.0)), abs=3.0)
            wide.append(camera.height / box[3])
        assert wide[0] == pytest.approx(wide[1])

    def test_together_all_shapes_are_in_the_box(self):
        shapes = [CORNERS, 0.5 * CORNERS + (3.0, 0.0, 0.0)]
        camera = mesh_page.together(shapes, (0.0, 1.0, 0.2), BOX)
        seen = project(camera, BOX, np.concatenate(shapes))[:, :2]
        assert (seen >= 0.0).all() and (seen <= 900.0).all()

    def test_a_bar_of_colours_has_its_ticks_where_their_values_are(self):
        records = mesh_page.color_bar((100.0, 50.0, 200.0, 18.0), (-1.0, 1.0), ((-1.0, "a"), (0.5, "b")), "w")
        marks = [r for r in records if isinstance(r, Lines)][1:]
        assert [np.asarray(r.points)[0, 0] for r in marks] == pytest.approx([100.0, 250.0])


def test_a_shadow_is_drawn_before_all_else_that_is_not_opaque():
    # In its order by depth it would part the lines into hundreds of pieces.
    V, F = solids.sphere(1.0, (0.0, 0.0, 1.0), 24)[:2]
    box = (0.0, 0.0, 900.0, 900.0)
    lens = Lens(mesh_page.together([V], (-0.4, -0.8, 0.3), box), box, 1.0, BOOK)
    (shadow,), (lines,) = (batches(*made, lens) for made in (mesh_look.shadow(V, F), mesh_look.wires(V, F)))
    assert not shadow.opaque and shadow.depth.min() > lines.depth.max()
    assert len(np.unique(shadow.depth)) == 1
