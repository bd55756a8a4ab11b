"""Images in files: levels and opacity as Pillow writes them, and files that are none."""

import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from lietool.render import raster

RNG = np.random.default_rng(8)
RGB = RNG.integers(0, 256, (5, 7, 3), dtype=np.uint8)


class TestRead:
    def test_colours(self, tmp_path):
        Image.fromarray(RGB).save(tmp_path / "a.png")
        read = raster.read(tmp_path / "a.png")
        assert np.array_equal(read.levels, RGB) and read.opacity is None

    def test_grey_and_one_bit(self, tmp_path):
        Image.fromarray(RGB[..., 0]).save(tmp_path / "a.png")
        Image.fromarray(RGB[..., 0] > 127).save(tmp_path / "b.png")
        assert np.array_equal(raster.read(tmp_path / "a.png").levels, np.repeat(RGB[..., :1], 3, axis=2))
        assert np.array_equal(raster.read(tmp_path / "b.png").levels[..., 1], 255.0 * (RGB[..., 0] > 127))

    def test_sixteen_bits(self, tmp_path):
        Image.fromarray(RGB[..., 0].astype(np.uint16) * 257).save(tmp_path / "a.png")
        assert np.array_equal(raster.read(tmp_path / "a.png").levels[..., 2], RGB[..., 0])

    def test_opacity(self, tmp_path):
        alpha = RNG.integers(0, 256, (5, 7), dtype=np.uint8)
        Image.fromarray(np.dstack([RGB, alpha])).save(tmp_path / "a.png")
        read = raster.read(tmp_path / "a.png")
        assert np.array_equal(read.levels, RGB)
        assert read.opacity is not None and np.allclose(255.0 * read.opacity, alpha)

    def test_a_colour_that_counts_as_clear(self, tmp_path):
        Image.fromarray(RGB).quantize(8).save(tmp_path / "a.png", transparency=3)
        opacity = raster.read(tmp_path / "a.png").opacity
        assert opacity is not None and set(np.unique(opacity)) == {0.0, 1.0}

    def test_it_is_upright(self, tmp_path):
        exif = Image.Exif()
        exif[0x0112] = 6
        Image.fromarray(RGB).save(tmp_path / "a.png", exif=exif)
        assert np.array_equal(raster.read(tmp_path / "a.png").levels, np.rot90(RGB, -1))


class TestRefused:
    def test_what_is_no_image(self, tmp_path):
        (tmp_path / "a.png").write_text("hello")
        with pytest.raises(
            ValueError, match=r"a.png must be an image .*; got something else. Save it anew.$"
        ):
            raster.read(tmp_path / "a.png")

    def test_a_file_that_ends_too_early(self, tmp_path):
        Image.fromarray(np.repeat(RGB, 40, axis=0)).save(tmp_path / "a.png")
        data = (tmp_path / "a.png").read_bytes()
        (tmp_path / "a.png").write_bytes(data[: len(data) // 2])
        with pytest.raises(ValueError, match=r"a\.png must be an image that can be read"):
            raster.read(tmp_path / "a.png")

    def test_too_many_pixels(self, tmp_path):
        Image.new("L", (5000, 2)).save(tmp_path / "a.png")
        with pytest.raises(ValueError, match="at most 4096 pixels each way; got 5000x2"):
            raster.read(tmp_path / "a.png")

    def test_far_too_many(self, tmp_path):
        head = struct.pack(">IIBBBBB", 50000, 50000, 8, 2, 0, 0, 0)
        chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(bytes(9))), (b"IEND", b"")]
        data = b"".join(
            struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
            for kind, body in chunks
        )
        (tmp_path / "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + data)
        with pytest.raises(ValueError, match=r"a\.png must be .* at most 4096 pixels each way; got far more"):
            raster.read(tmp_path / "a.png")

    @pytest.mark.parametrize("level", [np.nan, -np.nan])
    def test_levels_that_are_none(self, tmp_path, level):
        Image.fromarray(np.full((4, 5), level, np.float32)).save(tmp_path / "a.tiff")
        with pytest.raises(ValueError, match=r"a\.tiff must be an image of finite levels; got nan"):
            raster.read(tmp_path / "a.tiff")


def test_fitted():
    assert raster.fitted((10.0, 20.0, 400.0, 300.0), (200, 100)) == (10.0, 70.0, 400.0, 200.0)
    assert raster.fitted((0.0, 0.0, 400.0, 100.0), (50, 50)) == (150.0, 0.0, 100.0, 100.0)
