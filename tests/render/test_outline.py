"""Outlines of what lies on a page, and colours for programs that know no linear light."""

import numpy as np
import pytest

from lietool.render import outline, overlay, style
from lietool.render.batches import Lens
from lietool.render.camera import Camera, Page
from lietool.render.scene import Arrow, Frame, Label, Lines, Points, Record, Surface, Tube
from lietool.render.theme import BOOK, PRINT

BOX = (100.0, 50.0, 400.0, 300.0)
LENS = Lens(Page(), BOX, 1.0)
CORNER = np.array(BOX[:2])
WHITE = np.ones(3)


def shapes(record: Record, lens: Lens = LENS) -> list[outline.Shape]:
    found = outline.shapes(record, lens)
    assert found is not None
    return found


def area(ring: np.ndarray) -> float:
    x, y = ring.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2.0)


def square(x: float, y: float, side: float) -> np.ndarray:
    return np.array([(x, y, 0), (x + side, y, 0), (x + side, y + side, 0), (x, y + side, 0)], float)


class TestUnion:
    def test_triangles_that_share_an_edge_are_one_ring(self):
        corners = square(0, 0, 10)[:, :2]
        for faces in ([[0, 1, 2], [0, 2, 3]], [[2, 1, 0], [0, 2, 3]]):
            (ring,) = outline.union(corners[np.array(faces)])
            assert area(ring) == pytest.approx(100.0)
            assert len(ring) == 4

    def test_a_hole_stays_one(self):
        angle = np.linspace(0.0, 2.0 * np.pi, 13)[:-1]
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        points = np.concatenate([circle, 2.0 * circle])
        k = np.arange(12)
        faces = np.concatenate(
            [
                np.stack([k, k + 12, (k + 1) % 12], axis=-1),
                np.stack([k + 12, (k + 1) % 12 + 12, (k + 1) % 12], axis=-1),
            ]
        )
        rings = outline.union(points[faces])
        assert sorted(np.sign([area(ring) for ring in rings])) == [-1.0, 1.0]
        whole = 6.0 * np.sin(np.pi / 6.0)
        assert sum(area(ring) for ring in rings) == pytest.approx(3.0 * whole, rel=1e-5)

    def test_what_has_no_area_is_left_out(self):
        assert outline.union(np.array([[(0, 0), (1, 1), (2, 2)]], float)) == ()


class TestShapes:
    def test_a_surface_in_one_colour_is_one_area(self):
        (shape,) = shapes(Surface(square(5, 5, 10), [[0, 1, 2], [0, 2, 3]], style.INK, material="flat"))
        assert shape.filled and shape.width == 0.0
        assert np.array_equal(shape.color, BOOK.linear(style.INK))
        (ring,) = shape.rings
        assert ring.min(axis=0) == pytest.approx(CORNER + 5.0) and area(ring) == pytest.approx(100.0)

    def test_a_surface_that_changes_colour_is_divided(self):
        colors = style.ramp([0.0, 1.0, 1.0, 0.0], (style.INK, style.PAPER))
        found = shapes(Surface(square(0, 0, 64), [[0, 1, 2], [0, 2, 3]], colors, material="flat"))
        assert len(found) > 20
        total = sum(area(ring) for shape in found for ring in shape.rings)
        assert total == pytest.approx(64.0**2)
        # Darker where it is nearer to the dark side.
        at = np.array([np.concatenate(shape.rings)[:, 0].mean() for shape in found])
        light = np.array([shape.color[1] for shape in found])
        assert np.corrcoef(at, light)[0, 1] > 0.99

    def test_faces_in_colours_of_their_own_keep_them_and_their_order(self):
        points = np.concatenate([square(0, 0, 10), square(5, 0, 10)])
        colors = np.repeat([[1.0, 0, 0, 1], [0, 1.0, 0, 1]], 4, axis=0)
        faces = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
        found = shapes(Surface(points, faces, colors, material="flat"))
        assert [shape.color.tolist() for shape in found] == [[1, 0, 0, 1], [0, 1, 0, 1]]

    def test_lines(self):
        points = [(0, 0, 0), (9, 0, 0), (np.nan, 0, 0), (0, 5, 0), (9, 5, 0)]
        (shape,) = shapes(Lines(points, style.INK, 3.0))
        assert len(shape.rings) == 2 and shape.width == 3.0 and shape.round_ends
        # Half transparent, two that cross are seen through each other.
        assert [len(s.rings) for s in shapes(Lines(points, style.INK, 3.0, alpha=0.5))] == [1, 1]
        lens = Lens(Page(), BOX, 1.0, PRINT)
        (shape,) = shapes(Lines(points, style.INK, 3.0), lens)
        assert shape.width == pytest.approx(3.0 * PRINT.widths)

    def test_a_dash_ends_in_ink(self):
        (shape,) = shapes(Lines([(0, 0, 0), (97, 0, 0)], style.INK, 2.0, dash=(10.0, 8.0)))
        assert shape.dash is not None
        stroke, gap = shape.dash
        count = (97.0 + gap) / (stroke + gap)
        assert count == pytest.approx(round(count)) and stroke / gap == pytest.approx(10.0 / 8.0)

    def test_dots_of_a_line(self):
        (shape,) = shapes(Lines([(0, 0, 0), (9, 0, 0)], style.INK, 2.0, dash=(0.0, 30.0)))
        assert shape.dash == pytest.approx((0.0, 9.0))

    def test_a_line_that_fades(self):
        points = np.stack([np.linspace(0, 90, 31), np.zeros(31), np.zeros(31)], axis=-1)
        found = shapes(Lines(points, style.fade(style.MARK, np.linspace(0.0, 1.0, 31)), 4.0))
        alphas = [shape.color[3] for shape in found]
        assert alphas == sorted(alphas) and len(alphas) > 30
        assert not any(shape.round_ends for shape in found)
        dashed = shapes(
            Lines(points, style.fade(style.MARK, np.linspace(0.0, 1.0, 31)), 4.0, dash=(9.0, 5.0))
        )
        assert len(dashed) > 6 and all(shape.dash is None for shape in dashed)

    def test_points(self):
        at = np.array([(10, 20, 0), (30, 20, 0)], float)
        found = shapes(Points(at, style.PAPER, 8.0, rim=style.MARK, shaded=False))
        assert [shape.disc for shape in found] == pytest.approx([8.0, 6.24, 8.0, 6.24])
        assert np.array_equal(found[2].rings[0], at[1, :2] + CORNER)
        assert np.array_equal(found[0].color, BOOK.linear(style.MARK))
        assert len(shapes(Points(at, style.INK, 8.0, shaded=False))) == 2

    @pytest.mark.parametrize("end", [(50.0, 0.0, 0.0), (30.0, 40.0, 0.0), (4.0, 3.0, 0.0)])
    def test_an_arrow_is_its_silhouette(self, end):
        (flat,) = shapes(Arrow((0, 0, 0), end, style.INK, 2.0))
        (ring,) = flat.rings
        assert len(ring) == 7
        assert np.linalg.norm(ring - CORNER - end[:2], axis=-1).min() == pytest.approx(0.0, abs=1e-9)
        # One that leaves the page by a hair is drawn from its triangles, and must look the same.
        tilted = shapes(Arrow((0, 0, 0), (end[0], end[1], 1e-6), style.INK, 2.0))
        corners = np.concatenate([r for shape in tilted for r in shape.rings])
        assert corners.min(axis=0) == pytest.approx(ring.min(axis=0), abs=0.02)
        assert corners.max(axis=0) == pytest.approx(ring.max(axis=0), abs=0.02)

    def test_a_frame_is_three_arrows(self):
        colors = [shape.color.tolist() for shape in shapes(Frame(np.eye(3), length=40.0, radius=1.0))]
        assert colors[0] == BOOK.linear(style.AXIS_X).tolist()
        assert colors[1] == BOOK.linear(style.AXIS_Y).tolist()

    @pytest.mark.parametrize(
        "record",
        [
            Tube([(0, 0, 0), (9, 0, 0)], style.INK, 2.0),
            Points([(0, 0, 0)], style.INK),
            Surface(square(0, 0, 9), [[0, 1, 2]], style.INK),
        ],
    )
    def test_what_light_falls_on_is_rendered(self, record):
        assert outline.shapes(record, LENS) is None

    @pytest.mark.parametrize(
        "record",
        [
            Arrow((5, 5, 0), (5, 5, 0), style.INK, 1.0),
            Lines([(np.nan, 0, 0)] * 3, style.INK),
            Lines(np.zeros((0, 3)), style.INK),
            Points(np.zeros((0, 3)), style.INK, shaded=False),
            Surface(np.zeros((0, 3)), np.zeros((0, 3), int), style.INK, material="flat"),
            Label("$x$", (0, 0, 0), style.INK),
        ],
    )
    def test_nothing_to_draw(self, record):
        assert shapes(record) == []

    @pytest.mark.parametrize(
        ("record", "words"),
        [
            (Lines([(0, 0, 0), (9, 9, 0)], style.INK, -1.0), "Lines.width"),
            (Lines([(0, 0, 0), (9, 9, 0)], style.INK, dash=(0.0, 0.0)), "Lines.dash"),
            (Points([(0, np.inf, 0)], style.INK, shaded=False), "Points.positions"),
            (Surface(np.eye(3), [(0, 1, 7)], style.INK, material="flat"), "Surface.faces"),
        ],
    )
    def test_what_cannot_be_drawn_is_refused(self, record, words):
        with pytest.raises(ValueError, match=words):
            outline.shapes(record, LENS)

    def test_a_camera_is_refused(self):
        with pytest.raises(ValueError, match="lens must be of a Page"):
            outline.shapes(Points([(0, 0, 0)], style.INK), Lens(Camera(), BOX, 1.0))


class TestOverlay:
    """Blended as encoded over the paper, the colours look as blended in linear light."""

    @pytest.mark.parametrize("paper", [WHITE, np.zeros(3), np.array([0.01, 0.012, 0.016])])
    def test_colours(self, paper):
        rng = np.random.default_rng(3)
        rgba = rng.uniform(0.0, 1.0, (500, 4))
        found = overlay.colors(rgba, paper)
        assert found.min() >= 0.0 and found.max() <= 1.0
        alpha = found[:, 3:]
        seen = found[:, :3] * alpha + overlay.encoded(paper) * (1.0 - alpha)
        wanted = overlay.encoded(rgba[:, :3] * rgba[:, 3:] + paper * (1.0 - rgba[:, 3:]))
        assert np.abs(seen - wanted).max() < 1e-9

    def test_black_on_white_stays_black(self):
        # Half of black in linear light is 0.735 encoded: 26 % of black.
        found = overlay.colors(np.array([0.0, 0.0, 0.0, 0.5]), WHITE)
        assert found == pytest.approx([0, 0, 0, 0.2646], abs=1e-4)

    def test_what_is_opaque_or_empty_stays_so(self):
        rgba = np.array([[0.2, 0.5, 0.1, 1.0], [0.2, 0.5, 0.1, 0.0]])
        found = overlay.colors(rgba, WHITE)
        assert found[0] == pytest.approx([*overlay.encoded(rgba[0, :3]), 1.0]) and found[1, 3] == 0.0

    def test_pixels(self):
        rng = np.random.default_rng(4)
        alpha = rng.uniform(0.0, 1.0, (40, 50, 1))
        alpha[:5], alpha[5:10] = 0.0, 1.0
        samples = np.concatenate([rng.uniform(0.0, 1.0, (40, 50, 3)) * alpha, alpha], axis=-1).astype("f2")
        for paper in (WHITE, BOOK.linear(style.INK)[:3]):
            image = overlay.pixels(samples, paper).astype(float)
            part = image[..., 3:] / 255.0
            seen = image[..., :3] * part + 255.0 * overlay.encoded(paper) * (1.0 - part)
            light = samples[..., :3].astype(float) + paper * (1.0 - samples[..., 3:].astype(float))
            assert np.abs(seen - 255.0 * overlay.encoded(light)).max() < 0.6
            assert (image[:5, :, 3] == 0).all() and (image[5:10, :, 3] == 255).all()
