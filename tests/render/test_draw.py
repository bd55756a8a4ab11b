"""Pixels: colours, depths, widths and sizes against numbers computed by hand, the same everywhere."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lietool import figure
from lietool.golden import compare
from lietool.render import context, draw, solids, style
from lietool.render.camera import Camera
from lietool.render.scene import (
    Arrow,
    Frame,
    Label,
    Lines,
    Picture,
    Points,
    Record,
    Surface,
    Tube,
    View,
)
from lietool.render.theme import BOOK

CAMERA = Camera((1.0, 0.0, 0.0), height=2.0)
SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def page(*records: Record, size: tuple[int, int] = (64, 48), **options) -> np.ndarray:
    """The image of records on a page; [y, x] with y up, as on the page."""
    picture = Picture((View(records),), size)
    return draw.render(picture, **options).image[::-1]


def seen(*records: Record, size: tuple[int, int] = (60, 60), camera: Camera = CAMERA) -> np.ndarray:
    """The image of records through a lens that looks along -x; [y, x] with y up."""
    return draw.render(Picture((View(records, camera),), size)).image[::-1]


def rectangle(x: float, y: float, width: float, height: float, color: str, alpha: float = 1.0) -> Surface:
    corners = [(x, y, 0), (x + width, y, 0), (x + width, y + height, 0), (x, y + height, 0)]
    return Surface(corners, SQUARE, color, material="flat", alpha=alpha)


def across(x: float, half: float, color: str, alpha: float = 1.0) -> Surface:
    """A square facing the lens, `x` towards it."""
    corners = [(x, -half, -half), (x, half, -half), (x, half, half), (x, -half, half)]
    return Surface(corners, SQUARE, color, material="flat", alpha=alpha)


def srgb(linear: np.ndarray | float) -> np.ndarray:
    linear = np.asarray(linear)
    return np.rint(255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def ink(image: np.ndarray) -> np.ndarray:
    """How much of each pixel black covers, from the green channel of black on white."""
    level = image[..., 1] / 255.0
    return 1.0 - np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4)


class TestColours:
    def test_a_flat_colour_is_its_hex(self):
        levels = np.arange(256)
        squares = [
            rectangle(4.0 * (v % 16), 4.0 * (v // 16), 4, 4, f"#{v:02x}{255 - v:02x}{v ^ 85:02x}")
            for v in levels
        ]
        image = page(*squares, size=(64, 64))
        wanted = np.stack([levels, 255 - levels, levels ^ 85], axis=-1)
        assert np.array_equal(image[2::4, 2::4].reshape(-1, 3), wanted)

    def test_half_transparent_is_half_the_light(self):
        # Black at one half over white is linear 0.5: 1.055 * 0.5^(1 / 2.4) - 0.055 = 0.73536 = 187.5 / 255.
        assert page(rectangle(0, 0, 64, 48, "#000000", 0.5))[20, 20].tolist() == [188] * 3
        color, alpha = BOOK.linear("#2b66b1")[:3], 0.3
        image = page(rectangle(0, 0, 64, 48, "#2b66b1", alpha))
        assert np.abs(image[20, 20] - srgb(alpha * color + (1 - alpha))).max() <= 1

    def test_colours_of_vertices_are_mixed_in_linear_light(self):
        black, white = BOOK.linear("#000000"), BOOK.linear("#ffffff")
        ramp = np.array([black, white, white, black])
        image = page(Surface([(0, 0, 0), (64, 0, 0), (64, 48, 0), (0, 48, 0)], SQUARE, ramp, material="flat"))
        assert np.abs(image[24, :, 0] - srgb((np.arange(64) + 0.5) / 64)).max() <= 1

    def test_paper(self):
        assert np.array_equal(page(), np.full((48, 64, 3), 255))
        picture = Picture((), (8, 4), paper="#336699")
        assert draw.render(picture).image.tolist() == [[[0x33, 0x66, 0x99]] * 8] * 4

    def test_half_a_pixel_of_an_edge(self):
        image = page(rectangle(0, 0, 20.5, 48, "#000000"))
        assert image[10, 19, 0] == 0 and image[10, 21, 0] == 255
        # Three samples a pixel: one or two of them.
        assert 1 / 3 - 0.01 < ink(image)[10, 20] < 2 / 3 + 0.01

    def test_light_comes_from_above(self):
        turned = [seen(Surface(*solids.sphere(0.8)[:2], "#808080", solids.sphere(0.8)[2]))]
        column = turned[0][:, 30, 0].astype(int)
        assert column[45] > column[30] > column[15]


class TestDepth:
    def test_the_nearer_surface_hides_the_farther(self):
        near, far = across(0.1, 0.5, "#c8372d"), across(-0.1, 0.8, "#2b66b1")
        image = seen(near, far)
        assert np.array_equal(image, seen(far, near))
        assert image[30, 30].tolist() == [0xC8, 0x37, 0x2D] and image[30, 8].tolist() == [0x2B, 0x66, 0xB1]

    def test_surfaces_cut_each_other(self):
        # Two squares crossed along the vertical: each hides half of the other.
        a, b = across(0.0, 0.8, "#c8372d"), across(0.0, 0.8, "#2b66b1")
        turn = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
        b = Surface(np.asarray(b.vertices) @ turn.T, SQUARE, "#2b66b1", material="flat")
        image = seen(a, b)
        assert {tuple(image[30, x].tolist()) for x in (18, 42)} == {(0xC8, 0x37, 0x2D), (0x2B, 0x66, 0xB1)}
        assert np.array_equal(image, seen(b, a))

    def test_translucent_surfaces_in_any_order(self):
        near, far = across(0.3, 0.5, "#c8372d", 0.5), across(-0.3, 0.8, "#2b66b1", 0.4)
        image = seen(near, far)
        assert np.array_equal(image, seen(far, near))
        red, blue = BOOK.linear("#c8372d")[:3], BOOK.linear("#2b66b1")[:3]
        wanted = srgb(0.5 * red + 0.5 * (0.4 * blue + 0.6))
        assert np.abs(image[30, 30] - wanted).max() <= 1

    def test_translucent_triangles_of_one_mesh_in_any_order(self):
        vertices, faces, normals = solids.sphere(0.8, rings=8)
        colors = style.ramp(np.linspace(0, 1, len(vertices)))
        order = np.random.default_rng(1).permutation(len(faces))
        first = seen(Surface(vertices, faces, colors, normals, alpha=0.5))
        second = seen(Surface(vertices, faces[order], colors, normals, alpha=0.5))
        assert compare.images(first, second).over == 0

    def test_opaque_hides_translucent_behind_it(self):
        near, far = across(0.3, 0.5, "#c8372d"), across(-0.3, 0.8, "#2b66b1", 0.4)
        assert seen(near, far)[30, 30].tolist() == [0xC8, 0x37, 0x2D]

    def test_glass_tints_what_is_inside_and_not_what_is_before(self):
        vertices, faces, normals = solids.sphere(0.8)
        glass = Surface(vertices, faces, style.GLASS, normals, "glass")
        for ball in (
            lambda x: across(x, 0.2, "#c8372d"),
            lambda x: Points([(x, 0, 0)], "#c8372d", 4.0, shaded=False),
        ):
            inside, before, behind = (seen(glass, ball(x))[30, 30].astype(int) for x in (-0.3, 0.95, -1.5))
            assert before.tolist() == [0xC8, 0x37, 0x2D]
            assert inside[2] > before[2] + 3 and behind[2] > inside[2] + 3
        assert (seen(glass)[30, 30] < 255).any()

    def test_a_later_view_lies_over_an_earlier_one(self):
        near, far = across(0.5, 0.5, "#c8372d"), across(-0.5, 0.8, "#2b66b1")
        views = (View((near,), CAMERA), View((far,), CAMERA))
        image = draw.render(Picture(views, (60, 60))).image
        assert image[30, 30].tolist() == [0x2B, 0x66, 0xB1]
        over = View((rectangle(0, 0, 30, 60, "#2e8b57"),))
        image = draw.render(Picture((*views, over), (60, 60))).image
        assert image[30, 15].tolist() == [0x2E, 0x8B, 0x57] and image[30, 31].tolist() == [0x2B, 0x66, 0xB1]

    def test_records_on_a_page_lie_in_their_order(self):
        under, over = rectangle(0, 0, 40, 40, "#c8372d"), Lines([(0, 20, 0), (60, 20, 0)], "#2b66b1", 6.0)
        assert page(under, over)[20, 20].tolist() == [0x2B, 0x66, 0xB1]
        assert page(over, under)[20, 20].tolist() == [0xC8, 0x37, 0x2D]

    def test_a_line_on_a_surface_is_whole(self):
        line = Lines([(0, -0.5, 0), (0, 0.5, 0)], "#000000", 4.0)
        assert ink(seen(across(0.0, 0.8, "#ffffff"), line)).sum() == pytest.approx(
            ink(seen(line)).sum(), rel=0.01
        )
        assert ink(seen(across(0.2, 0.8, "#ffffff"), line)).sum() == 0.0


def stroke(length: float, width: float, turn: float = 0.0) -> float:
    """The area of a line with round ends and one joint that turns by an angle."""
    r = width / 2
    return width * length + np.pi * r**2 + r**2 * (turn / 2 - np.tan(turn / 2))


class TestLines:
    @pytest.mark.parametrize("degrees", [0.0, 11.3, 45.0, 67.1, 90.0, 151.0])
    @pytest.mark.parametrize("width", [0.6, 1.0, 1.9, 5.3])
    def test_width(self, width, degrees):
        along = np.array([np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees)), 0])
        middle = np.array([60.3, 60.1, 0])
        # Several, since a byte is a coarse measure of one line that lies along the pixels.
        shifts = [np.array([-along[1], along[0], 0]) * s for s in (-31.17, -14.53, 0.09, 13.71, 31.33)]
        lines = [Lines([middle - 40 * along + s, middle + 40 * along + s], "#000000", width) for s in shifts]
        image = page(*lines, size=(120, 120))
        assert ink(image).sum() == pytest.approx(5 * stroke(80, width), rel=0.01)

    @pytest.mark.parametrize("degrees", [10.0, 45.0, 90.0, 120.0])
    def test_joints(self, degrees):
        turn = np.deg2rad(degrees)
        corner = np.array([50.0, 30.0, 0])
        ends = [corner - (35, 0, 0), corner, corner + 35 * np.array([np.cos(turn), np.sin(turn), 0])]
        image = page(Lines(ends, "#000000", 8.0), size=(100, 100))
        assert ink(image).sum() == pytest.approx(stroke(70, 8, turn), rel=0.01)

    def test_a_closed_line_has_no_ends(self):
        angle = np.linspace(0, 2 * np.pi, 73)
        ring = np.stack([50 + 30 * np.cos(angle), 50 + 30 * np.sin(angle), 0 * angle], axis=-1)
        ring[-1] = ring[0]
        image = page(Lines(ring, "#000000", 6.0), size=(100, 100))
        assert ink(image).sum() == pytest.approx(np.pi * (33**2 - 27**2), rel=0.01)

    @pytest.mark.parametrize("degrees", [1.0, 30.0, 100.0, 150.0])
    def test_a_translucent_line_shows_no_joints(self, degrees):
        turn = np.deg2rad(degrees)
        points = np.zeros((4, 3))
        heading = 0.3
        points[0, :2] = 30, 40
        for i in range(3):
            points[i + 1, :2] = points[i, :2] + 30 * np.array([np.cos(heading), np.sin(heading)])
            heading += turn if i % 2 == 0 else -turn
        image = page(Lines(points, "#000000", 9.0, alpha=0.5), size=(140, 120))
        assert image.min() == 188
        wanted = stroke(90, 9, turn) + stroke(0, 9, turn) - stroke(0, 9)
        assert 2 * ink(image).sum() == pytest.approx(wanted, rel=0.01)

    def test_a_fine_translucent_curve_is_even(self):
        angle = np.linspace(0, 4.5, 400)
        curve = np.stack([60 + 30 * np.cos(angle), 60 + 30 * np.sin(angle), 0 * angle], axis=-1)
        image = page(Lines(curve, "#000000", 10.0, alpha=0.5), size=(120, 120))
        assert image.min() == 188
        assert 2 * ink(image).sum() == pytest.approx(stroke(30 * 4.5, 10), rel=0.01)

    @pytest.mark.parametrize("width", [0.01, 0.1, 0.3])
    def test_a_hairline_gets_paler_and_does_not_vanish(self, width):
        image = page(Lines([(10, 9.7, 0), (90, 42.1, 0)], "#000000", width), size=(100, 50))
        # Bytes of sRGB cannot hold the palest of them exactly.
        assert ink(image).sum() == pytest.approx(
            width * np.hypot(80, 32.4), rel=0.05 if width > 0.05 else 0.5
        )

    def test_width_is_in_page_units(self):
        line = Lines([(10, 10, 0), (90, 70, 0)], "#000000", 4.0)
        areas = [
            ink(draw.render(Picture((View((line,)),), (100, 80)), **options).image).sum()
            for options in ({}, {"size": (300, 240)}, {"draft": True})
        ]
        assert areas == pytest.approx([stroke(100, 4), 9 * stroke(100, 4), stroke(100, 4)], rel=0.01)

    def test_width_does_not_depend_on_the_distance(self):
        near, far = (
            ink(seen(Lines([(x, 0, -0.2), (x, 0, 0.2)], "#000000", 4.0)))[30].sum() for x in (2.0, -2.0)
        )
        assert near == pytest.approx(4.0, rel=0.01) and far == pytest.approx(4.0, rel=0.01)

    def test_dashes(self):
        image = page(Lines([(10, 10, 0), (110, 10, 0)], "#000000", 2.0, dash=(10.0, 8.0)), size=(120, 20))
        # 6 strokes and 5 gaps are 100 units; each stroke has round ends.
        assert ink(image).sum() == pytest.approx(6 * stroke(10, 2), rel=0.01)
        row = ink(image)[9:11].mean(axis=0) > 0.99
        starts = np.flatnonzero(np.diff(row.astype(int)) == 1) + 1
        assert np.array_equal(starts, 10 + 18 * np.arange(6)) and row.sum() == 60

    def test_dashes_are_stretched_so_that_both_ends_are_ink(self):
        image = page(Lines([(10, 10, 0), (107, 10, 0)], "#000000", 2.0, dash=(10.0, 8.0)), size=(120, 20))
        row = ink(image)[9:11].mean(axis=0)
        assert row[10:12].min() > 0.99 and row[105:107].min() > 0.99 and row[:9].max() == row[109:].max() == 0

    def test_dashes_go_round_corners(self):
        corner = [(10, 10, 0), (50, 10, 0), (50, 50, 0)]
        straight = [(10, 10, 0), (90, 10, 0)]
        areas = [
            ink(page(Lines(p, "#000000", 2.0, dash=(7.0, 5.0)), size=(100, 60))).sum()
            for p in (corner, straight)
        ]
        assert areas[0] == pytest.approx(areas[1], rel=0.02)

    def test_dashes_are_even_on_the_page(self):
        # Away from the viewer a unit of the space is shorter; a dash is not.
        line = Lines([(-2, -0.9, 0), (2, 0.9, 0)], "#000000", 3.0, dash=(6.0, 6.0))
        row = ink(seen(line, size=(200, 200)))[98:102].mean(axis=0) > 0.5
        lengths = np.diff(np.flatnonzero(np.diff(row.astype(int))))
        assert len(lengths) > 10 and np.ptp(lengths[::2]) <= 2

    def test_nan_breaks_a_line(self):
        gap = [(10, 10, 0), (30, 10, 0), (np.nan,) * 3, (60, 10, 0), (90, 10, 0)]
        image = page(Lines(gap, "#000000", 4.0), size=(100, 20))
        assert ink(image).sum() == pytest.approx(stroke(20, 4) + stroke(30, 4), rel=0.01)
        assert ink(image)[10, 45] == 0.0

    @pytest.mark.parametrize(
        ("scale", "shift"), [(1e40, 0.0), (1e-40, 0.0), (1.0, 1e9), (1e60, 3e62), (1e-3, 5e3), (2.0**-8, 0.0)]
    )
    def test_the_unit_and_the_origin_do_not_matter(self, scale, shift):
        def image(scale: float, shift: float) -> np.ndarray:
            def put(*points: tuple[float, float, float]) -> np.ndarray:
                return scale * np.array(points) + shift

            target = tuple((scale * np.zeros(3) + shift).tolist())
            camera = Camera((1.0, 0.7, 0.5), target=target, height=2.0 * scale)
            records = (
                Surface(
                    put((0, -0.6, -0.6), (0, 0.6, -0.6), (0, 0.6, 0.6), (0.3, -0.6, 0.6)), SQUARE, "#c06020"
                ),
                Lines(
                    put((0.5, -0.8, 0), (0.5, 0.8, 0), (np.nan,) * 3, (0.5, 0, 0.8), (0.5, 0, -0.8)),
                    "#204080",
                ),
                Points(put((0.7, 0.3, 0.3)), "#208040"),
                Arrow(put((0, 0, 0))[0], put((0.6, -0.6, 0.4))[0], "#802080", 0.05 * scale),
                Tube(put((0, -0.5, 0.5), (0, 0, 0.8), (0, 0.5, 0.5)), "#808020", 0.05 * scale),
                Frame(np.eye(3), put((0.3, 0.3, -0.5))[0], 0.4 * scale, 0.03 * scale),
            )
            return seen(*records, camera=camera).astype(int)

        assert (np.abs(image(scale, shift) - image(1.0, 0.0)).max(axis=2) > 24).mean() < 0.004

    def test_nothing_to_draw(self):
        for points in (np.zeros((0, 3)), [(np.nan,) * 3] * 3, [(5, 5, 0)], [(np.nan,) * 3, (5, 5, 0)]):
            assert page(Lines(points, "#000000")).min() == 255


class TestPoints:
    @pytest.mark.parametrize("radius", [3.0, 7.5, 20.0])
    def test_radius(self, radius):
        image = page(Points([(25.3, 24.8, 0)], "#000000", radius, shaded=False), size=(50, 50))
        assert ink(image).sum() == pytest.approx(np.pi * radius**2, rel=0.01)

    def test_radius_does_not_depend_on_the_distance(self):
        areas = [ink(seen(Points([(x, 0, 0)], "#000000", 8.0, shaded=False))).sum() for x in (2.0, -2.0)]
        assert areas == pytest.approx([np.pi * 64] * 2, rel=0.01)

    def test_rim(self):
        image = page(Points([(25, 25, 0)], "#c8372d", 20, rim="#2b66b1", shaded=False), size=(50, 50))
        assert image[25, 25].tolist() == [0xC8, 0x37, 0x2D] and image[25, 7].tolist() == [0x2B, 0x66, 0xB1]

    def test_a_ball_is_lit_from_above_and_the_left(self):
        image = page(Points([(25, 25, 0)], "#808080", 20), size=(50, 50))[..., 0].astype(int)
        assert image[34, 20] > image[25, 25] > image[16, 30]


class TestSilhouettes:
    @pytest.mark.parametrize("center", [(0.0, 0.0, 0.0), (0.4, -0.5, 0.3)])
    def test_the_outline_of_a_ball_is_its_edge(self, center):
        camera = Camera((1.0, 0.4, 0.3), height=2.6)
        vertices, faces, _ = solids.sphere(0.7, center, rings=96)
        ball = Surface(vertices, faces, "#000000", material="flat")
        outline = camera.sphere_outline(center, 0.7)
        fan = np.concatenate([[center], outline])
        n = np.arange(1, len(outline))
        disc = Surface(fan, np.stack([0 * n, n, n + 1], axis=-1), "#000000", material="flat")
        areas = [ink(seen(record, size=(200, 200), camera=camera)).sum() for record in (ball, disc)]
        assert areas[0] == pytest.approx(areas[1], rel=2e-3)


class TestSizes:
    def test_the_page_is_scaled_and_centred(self):
        square = rectangle(0, 0, 100, 100, "#000000")
        image = draw.render(Picture((View((square,)),), (100, 100)), size=(80, 20)).image
        assert (image[:, 30:50] == 0).all() and (image[:, :30] == 255).all() and (image[:, 50:] == 255).all()
        image = draw.render(Picture((View((square,)),), (100, 100)), size=(20, 80)).image
        assert (image[30:50] == 0).all() and (image[:30] == 255).all() and (image[50:] == 255).all()

    def test_a_view_has_its_box(self):
        view = View((across(0.0, 1.0, "#000000"),), CAMERA, (20.0, 10.0, 40.0, 30.0))
        image = draw.render(Picture((view,), (100, 60))).image[::-1]
        columns, rows = (
            np.flatnonzero((image < 255).any(axis=(0, 2))),
            np.flatnonzero((image < 255).any(axis=(1, 2))),
        )
        assert abs(rows[0] - 10) <= 1 and abs(rows[-1] - 39) <= 1
        assert abs(columns[0] - 25) <= 1 and abs(columns[-1] - 54) <= 1

    @pytest.mark.parametrize("name", ["slerp", "gimbal", "exp-singularity"])
    def test_tiles_have_no_seams(self, name, monkeypatch):
        picture = figure.load(name).draw().picture
        monkeypatch.setattr(draw, "TILE", (240, 180))
        whole = draw.render(picture, size=(240, 180)).image
        for tile in ((240, 90), (100, 75), (67, 41)):
            monkeypatch.setattr(draw, "TILE", tile)
            compared = compare.images(whole, draw.render(picture, size=(240, 180)).image)
            # An edge may pass a sample on the other side by the last bit of its position.
            assert compared.differing < 100 and compared.over <= 8 and compared.passes

    def test_an_upright_line_across_tiles(self, monkeypatch):
        line = Lines([(0, 0, -0.95), (0, 0, 0.95)], "#000000", 0.5)
        monkeypatch.setattr(draw, "TILE", (60, 60))
        whole = seen(line)
        monkeypatch.setattr(draw, "TILE", (60, 17))
        assert np.array_equal(seen(line), whole)

    def test_flat_pictures_in_tiles_are_equal(self, monkeypatch):
        records = [
            rectangle(5, 5, 31, 22, "#c8372d", 0.5),
            Points([(30, 30, 0)], "#2b66b1", 9.0, rim="#000000"),
        ]
        whole = page(*records)
        monkeypatch.setattr(draw, "TILE", (16, 16))
        assert np.array_equal(page(*records), whole)

    def test_a_draft_differs_little(self):
        picture = figure.load("slerp").draw().picture
        full, draft = (
            draw.render(picture, size=(240, 180), draft=d).image.astype(float) for d in (False, True)
        )
        assert 0 < np.abs(full - draft).mean() < 1.0

    @pytest.mark.parametrize("size", [(0, 5), (5, -1), (20001, 5), (5, 20001)])
    def test_impossible_sizes(self, size):
        with pytest.raises(ValueError, match=r"^draw\.render: size must be 1 to 20000 pixels each way; got "):
            draw.render(Picture(()), size=size)

    def test_one_pixel(self):
        assert draw.render(
            Picture((View((rectangle(0, 0, 9, 9, "#c8372d"),)),), (9, 9)), size=(1, 1)
        ).image.tolist() == [[[0xC8, 0x37, 0x2D]]]


class TestRefused:
    @pytest.mark.parametrize(
        ("record", "name"),
        [
            (Lines([(0, 0, 0), (9, 9, 0)], "#000000", -1.0), "Lines.width"),
            (Lines([(0, 0, 0), (9, 9, 0)], "#000000", np.inf), "Lines.width"),
            (Lines([(0, 0, 0), (9, 9, 0)], "#000000", alpha=np.nan), "Lines.alpha"),
            (rectangle(0, 0, 9, 9, "#000000", 1.5), "Surface.alpha"),
            (Points([(0, 0, 0)], "#000000", np.nan), "Points.radius"),
            (Tube([(0, 0, 0), (9, 0, 0)], "#000000", -2.0), "Tube.radius"),
            (Label("$x$", (5, 5, 0), "#000000", np.nan), "Label.size"),
        ],
    )
    def test_what_cannot_be_measured(self, record, name):
        with pytest.raises(ValueError, match=rf"^draw\.render: {name} must be .*; got "):
            page(record)

    @pytest.mark.parametrize(
        ("record", "name"),
        [
            (Surface([(0, 0, 0), (1, np.nan, 0), (1, 1, 0)], [(0, 1, 2)], "#000000"), "Surface.vertices"),
            (Points([(0, np.inf, 0)], "#000000"), "Points.positions"),
            (Tube([(0, 0, 0), (np.nan, 0, 0)], "#000000", 1.0), "Tube.points"),
            (Arrow((0, 0, 0), (0, np.nan, 0), "#000000", 1.0), "Arrow.end"),
            (Arrow((np.inf, 0, 0), (0, 0, 0), "#000000", 1.0), "Arrow.start"),
            (Frame(np.full((3, 3), np.nan)), "Frame.matrix"),
            (Frame(np.eye(3), (0.0, np.nan, 0.0)), "Frame.origin"),
            (Label("$x$", (np.nan, 0, 0), "#000000"), "Label.position"),
        ],
    )
    def test_what_is_not_finite(self, record, name):
        with pytest.raises(
            ValueError, match=rf"^draw\.render: {name} must be finite; got (nan|inf) at index \("
        ):
            page(record)

    @pytest.mark.parametrize("dash", [(0.0, 0.0), (-1.0, 2.0), (np.nan, 2.0)])
    def test_dashes_without_length(self, dash):
        with pytest.raises(ValueError, match=r"^draw\.render: Lines\.dash must be "):
            page(Lines([(0, 0, 0), (9, 9, 0)], "#000000", dash=dash))

    @pytest.mark.parametrize(
        ("changed", "message"),
        [
            ({"faces": [(0, 1, 3)]}, "faces must be indices of its 3 vertices, from 0; got 0 to 3"),
            ({"faces": [(0, 1, -1)]}, "faces must be indices of its 3 vertices, from 0; got -1 to 1"),
            ({"faces": [(0, 1, 1.5)]}, r"faces must be whole numbers \(n, 3\); got float64 \(1, 3\)"),
            ({"material": "wood"}, "material must be one of flat, matte, glass, soft, shadow; got 'wood'"),
        ],
    )
    def test_a_surface_that_is_none(self, changed, message):
        parts = {"vertices": np.eye(3), "faces": [(0, 1, 2)], "color": "#000000"} | changed
        with pytest.raises(ValueError, match=rf"^draw\.render: Surface\.{message}"):
            page(Surface(**parts))

    def test_a_dash_too_fine_to_see(self):
        with pytest.raises(ValueError, match=r"^draw\.render: Lines\.dash must make at most 20000 strokes"):
            page(Lines([(0, 0, 0), (9, 9, 0)], "#000000", dash=(1e-9, 1e-9)))

    @pytest.mark.parametrize("color", ["red", "#12345", "#1234567", "#12345g"])
    def test_a_colour_that_is_none(self, color):
        with pytest.raises(ValueError, match=r"color must be #rrggbb; got "):
            page(Points([(0, 0, 0)], color))
        with pytest.raises(ValueError, match=r"color must be #rrggbb; got "):
            page(Label("$x$", (0, 0, 0), color))

    @pytest.mark.parametrize("box", [(0, 0, 0, 0), (0, 0, -5, 5), (0, 0, np.nan, 5)])
    def test_a_box_without_area(self, box):
        picture = Picture((View((Points([(0, 0, 0)], "#000000"),), box=box),), (9, 9))
        with pytest.raises(ValueError, match=r"^draw\.render: View\.box must be "):
            draw.render(picture)

    def test_what_is_no_record(self):
        with pytest.raises(TypeError, match=r"record must be one of scene\.Record; got str"):
            page("x")  # type: ignore[arg-type]

    def test_degenerate_records_draw_nothing(self):
        nothing = [
            Arrow((5, 5, 0), (5, 5, 0), "#000000", 1.0),
            Points(np.zeros((0, 3)), "#000000"),
            Surface(np.zeros((0, 3)), np.zeros((0, 3), int), "#000000"),
            Surface([(0, 0, 0), (9, 9, 0), (18, 18, 0)], [(0, 1, 2)], "#000000"),
        ]
        assert page(*nothing).min() == 255


SCRIPT = """
import hashlib, sys
from lietool import figure
from lietool.render import context, draw
context.get(sys.argv[1] or None)
image = draw.render(figure.load("slerp").draw().picture, size=(200, 150)).image
print(context.get().backend, hashlib.sha256(image.tobytes()).hexdigest())
"""


def elsewhere(backend: str = "", **env: str) -> list[str]:
    """Which backend another process has, and the digest of its picture."""
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, backend], env=os.environ | env, capture_output=True, text=True
    )
    if "NoRendererError" in done.stderr:
        raise context.NoRendererError({backend or "any": "not in another process"})
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


class TestTheSameEverywhere:
    def here(self) -> str:
        picture = figure.load("slerp").draw().picture
        return hashlib.sha256(draw.render(picture, size=(200, 150)).image.tobytes()).hexdigest()

    def test_twice(self):
        assert self.here() == self.here()

    def test_after_other_pictures(self):
        before = self.here()
        draw.render(figure.load("gimbal").draw().picture, size=(64, 48), draft=True)
        page(rectangle(0, 0, 9, 9, "#c8372d"))
        assert self.here() == before

    @pytest.mark.parametrize("threads", ["0", "1", "3"])
    def test_in_another_process_with_other_threads(self, threads):
        here = self.here()
        assert elsewhere(LP_NUM_THREADS=threads)[1] == here

    def test_by_osmesa_and_by_egl(self):
        (osmesa, first), (egl, second) = elsewhere("osmesa"), elsewhere("egl")
        assert (osmesa, egl) == ("osmesa", "egl") and first == second


@pytest.mark.skipif(
    not Path("/proc/self/statm").exists(), reason="the system does not tell a process's memory"
)
def test_memory_does_not_grow():
    code = (
        "from lietool import figure; from lietool.render import draw\n"
        "picture = figure.load('slerp').draw().picture\n"
        "def used(): return int(open('/proc/self/statm').read().split()[1]) * 4096 // 2**20\n"
        "for count in (6, 30):\n"
        "    for i in range(count): draw.render(picture, size=[(64, 48), (120, 90), (90, 120)][i % 3])\n"
        "    print(used())"
    )
    draw.render(Picture(()), size=(1, 1))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    before, after = map(int, done.stdout.split())
    # A picture's triangles and buffers are some 5 MB: thirty that stay would be 150.
    assert after - before < 50


class TestLayer:
    """One view alone, on no ground: over the paper it is the picture."""

    @pytest.mark.parametrize(
        "record",
        [
            Lines([(0, -2.0, -0.7), (0, 0.9, 0.5)], "#c8372d", 30.0),
            Points([(0, 0.2, 0.1), (0, 1.3, 0.0)], "#2b66b1", 25.0),
            across(0.0, 0.4, "#2b66b1", 0.5),
            Surface(*solids.sphere(0.5)[:2], style.GLASS, solids.sphere(0.5)[2], "glass"),
            Label("$x$", (0, 0, 0), "#000000"),
        ],
    )
    def test_over_paper(self, record):
        # The box is small, and what is drawn leaves it.
        view = View((record,), CAMERA, (40.0, 30.0, 40.0, 30.0))
        picture = Picture((view,), (120, 90))
        samples = draw.layer(picture, view, size=(240, 180)).astype(float)
        light = samples[..., :3] + (1.0 - samples[..., 3:])
        shown = 255.0 * np.where(
            light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0.0) ** (1 / 2.4) - 0.055
        )
        bare = Picture(
            (View(tuple(r for r in view.records if not isinstance(r, Label)), CAMERA, view.box),), (120, 90)
        )
        expected = draw.render(bare, size=(240, 180)).image
        # A pixel on an edge may be rounded otherwise, and one brighter than paper is cut off earlier.
        off = np.abs(shown - expected).max(axis=-1)
        assert np.count_nonzero(off > 2.0) <= 25 and np.count_nonzero(off > 8.0) <= 3
        assert samples[..., 3].any() == (not isinstance(record, Label))

    def test_nothing_in_the_view(self):
        view = View((Points([(0, 50.0, 0)], "#000000", 3.0),), CAMERA)
        assert not draw.layer(Picture((view,), (60, 40)), view, size=(60, 40)).any()

    def test_a_size_that_is_none(self):
        with pytest.raises(ValueError, match=r"draw\.render: size must be 1 to 20000"):
            draw.layer(Picture((), (60, 40)), View(()), size=(0, 40))
