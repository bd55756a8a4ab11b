"""Images in a picture: every pixel where it belongs, smooth or square, behind and before other things."""

import numpy as np
import pytest

from lietool.render import draw, style, vector
from lietool.render.camera import Camera
from lietool.render.scene import Image, Lines, Picture, Surface, View
from lietool.render.theme import DARK

RNG = np.random.default_rng(5)
LEVELS = RNG.integers(0, 256, (12, 16, 3))


def image(levels=LEVELS, box=(0.0, 0.0, 16.0, 12.0), **options) -> Image:
    x, y, w, h = box
    return Image(np.asarray(levels) / 255.0, (x, y, 0.0), (w, 0.0, 0.0), (0.0, h, 0.0), **options)


def drawn(*records, size=(16, 12), **options):
    return draw.render(Picture((View(records),), size), **options).image


class TestPixels:
    def test_alone_it_is_itself(self):
        assert np.abs(drawn(image(smooth=False)).astype(int) - LEVELS).max() <= 1

    def test_four_pixels_of_the_page_for_one(self):
        found = drawn(image(box=(0.0, 0.0, 32.0, 24.0), smooth=False), size=(32, 24)).astype(int)
        assert np.abs(found - np.repeat(np.repeat(LEVELS, 2, 0), 2, 1)).max() <= 1

    def test_smooth_it_goes_from_one_to_the_next_in_light(self):
        found = drawn(image([[[0] * 3, [255] * 3]], (0.0, 0.0, 64.0, 8.0)), size=(64, 8))[4, :, 1]
        light = np.clip((np.arange(64) + 0.5 - 16.0) / 32.0, 0.0, 1.0)
        wanted = 255.0 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        assert np.abs(found - wanted).max() < 3.0

    def test_grey_has_three_equal_channels(self):
        found = drawn(image(LEVELS[..., 0], smooth=False)).astype(int)
        assert np.abs(found - LEVELS[..., :1]).max() <= 1

    def test_levels_beyond_are_cut_off(self):
        found = drawn(image(np.where(LEVELS > 127, 900, -900), smooth=False))
        assert set(np.unique(found)) == {0, 255}

    def test_it_is_the_same_in_every_theme(self):
        assert np.array_equal(drawn(image()), drawn(image(), theme=DARK))

    def test_tiles_have_no_seams(self, monkeypatch):
        whole = drawn(image(box=(0.0, 0.0, 64.0, 48.0)), size=(64, 48))
        monkeypatch.setattr(draw, "TILE", (17, 11))
        assert np.abs(drawn(image(box=(0.0, 0.0, 64.0, 48.0)), size=(64, 48)).astype(int) - whole).max() <= 1


class TestOrder:
    BLACK = np.zeros((2, 2, 3))

    def test_records_on_a_page_lie_in_their_order(self):
        line = Lines([(0.0, 6.0, 0.0), (16.0, 6.0, 0.0)], style.WRONG, 4.0)
        other = image(self.BLACK, (4.0, 0.0, 8.0, 12.0))
        over, under = drawn(image(), line, other), drawn(image(), other, line)
        assert (over[6, 8] == 0).all() and (under[6, 8] != 0).any()
        assert (over[6, 1] == under[6, 1]).all() and (over[6, 1] != LEVELS[6, 1]).any()

    def test_what_is_nearer_hides_it(self):
        camera = Camera((1.0, 0.0, 0.0), height=2.0)
        corners = [(0.0, -0.5, -0.5), (0.0, 0.5, -0.5), (0.0, 0.5, 0.5), (0.0, -0.5, 0.5)]
        pane = Surface(corners, [[0, 1, 2], [0, 2, 3]], "#ff0000", material="flat")
        for x, wanted in ((-0.5, (255, 0, 0)), (0.5, (0, 0, 0))):
            photo = Image(self.BLACK, (x, -0.3, -0.3), (0.0, 0.6, 0.0), (0.0, 0.0, 0.6))
            found = draw.render(Picture((View((photo, pane), camera),), (40, 40))).image
            assert tuple(found[20, 20]) == wanted

    def test_a_file_of_vectors_has_it(self):
        page = Picture((View((image(box=(100.0, 100.0, 400.0, 300.0)),)),))
        assert b"<image" in vector.write(page, "svg", inches=(4.0, 3.0))


class TestRefused:
    @pytest.mark.parametrize("shape", [(4,), (4, 4, 4), (0, 3, 3), (2, 5000)])
    def test_what_is_no_image(self, shape):
        with pytest.raises(ValueError, match=r"^draw.render: Image.pixels must be of shape .*; got \("):
            drawn(image(np.zeros(shape)))

    def test_what_is_not_finite(self):
        with pytest.raises(ValueError, match=r"Image\.pixels must be finite; got nan"):
            drawn(image(np.full((2, 2), np.nan)))
