"""Pictures of strangers: every kind of PNG is read as an eye sees it, and what is none is one line."""

import io
import os
import pickle
import random
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from lietool.golden import picture

RGB = np.random.default_rng(0).integers(0, 256, (20, 30, 3), np.uint8)
DEEP = RGB.astype(">u2") * 257


def packed(image, kind="PNG", **options):
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def by_hand(width, height, depth, colour, rows=b"", *more, interlaced=0):
    """A PNG of a kind that Pillow does not write."""
    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
    body = [chunk(b"IHDR", header), *more, chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(body)


def lines(rows):
    """Rows of a PNG, none of them filtered."""
    return b"".join(b"\0" + row.tobytes() for row in rows)


def interlaced(image):
    """The seven passes of Adam7."""
    starts = [
        (0, 0, 8, 8),
        (0, 4, 8, 8),
        (4, 0, 8, 4),
        (0, 2, 4, 4),
        (2, 0, 4, 2),
        (0, 1, 2, 2),
        (1, 0, 2, 1),
    ]
    return b"".join(lines(image[y::dy, x::dx]) for y, x, dy, dx in starts)


def said(data, suffix=".png", **options):
    with pytest.raises(picture.PictureError) as caught:
        picture.decode(data, suffix, **options)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    "data",
    [
        packed(Image.fromarray(RGB)),
        packed(Image.fromarray(RGB).convert("RGBA")),
        by_hand(30, 20, 16, 2, lines(DEEP)),
        by_hand(30, 20, 8, 2, interlaced(RGB), interlaced=1),
        packed(Image.fromarray(RGB), "TIFF"),
        packed(Image.fromarray(RGB), "WEBP", lossless=True),
        packed(Image.fromarray(RGB), "BMP"),
        packed(Image.fromarray(RGB), "PPM"),
    ],
    ids=["rgb", "rgba", "deep", "interlaced", "tiff", "webp", "bmp", "ppm"],
)
def test_the_same_pixels_are_read_however_they_are_packed(data):
    assert np.array_equal(picture.decode(data, "").image, RGB)


def test_grey_and_palettes_become_colours():
    grey = RGB[..., 0]
    wanted = np.repeat(grey[..., None], 3, axis=2)
    for data in (
        packed(Image.fromarray(grey)),
        by_hand(30, 20, 16, 0, lines(DEEP[..., 0])),
        packed(Image.fromarray(grey).convert("P")),
        packed(Image.fromarray(grey), "GIF"),
    ):
        assert np.array_equal(picture.decode(data, "").image, wanted)
    two = Image.fromarray(grey).convert("1")
    assert np.array_equal(picture.decode(packed(two), ".png").image, np.array(two.convert("RGB")))


def test_sixteen_bits_of_grey_are_rounded():
    levels = np.array([[0, 128, 129, 257, 32896, 65406, 65407, 65535]], np.uint16)
    found = picture.decode(packed(Image.fromarray(levels)), ".png").image[0, :, 0]
    assert found.tolist() == [0, 0, 1, 1, 128, 254, 255, 255]


def test_what_is_transparent_lies_over_white():
    alpha = np.linspace(0, 255, 600).astype(np.uint8).reshape(20, 30)
    found = picture.decode(packed(Image.fromarray(np.dstack([RGB, alpha]))), ".png").image
    share = alpha[..., None] / 255.0
    assert np.abs(found - (share * RGB + (1.0 - share) * 255.0)).max() <= 0.5 + 1e-9
    first = tuple(map(int, RGB[0, 0]))
    found = picture.decode(packed(Image.fromarray(RGB), transparency=first), ".png").image
    assert found[0, 0].tolist() == [255] * 3 and np.array_equal(found[1:], RGB[1:])
    deep = by_hand(30, 20, 16, 0, lines(DEEP[..., 0]), chunk(b"tRNS", DEEP[0, 0, :1].tobytes()))
    assert picture.decode(deep, ".png").image[0, 0].tolist() == [255] * 3
    seen = packed(Image.fromarray(RGB).quantize(4), transparency=bytes(4))
    assert (picture.decode(seen, ".png").image == 255).all()


def test_texts_come_along(tmp_path):
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_text("plate", "B2.8")
    info.add_text("reason", "naïve – ξ")
    path = tmp_path / "a.png"
    path.write_bytes(packed(Image.fromarray(RGB), pnginfo=info))
    found = picture.load(path)
    assert found.texts == {"plate": "B2.8", "reason": "naïve – ξ"} and found.size == (30, 20)
    # They stand before the pixels, and are read even where those are torn.
    assert picture.told(path.read_bytes()[:-200]) == found.texts
    with pytest.raises(picture.PictureError):
        picture.told(b"hello")


MOVING = {"save_all": True, "append_images": [Image.fromarray(255 - RGB)]}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"hello", "is no picture that can be read"),
        (packed(Image.fromarray(RGB))[:-300], "is damaged or cut off"),
        (packed(Image.fromarray(RGB), **MOVING), "holds more than one picture"),
        (packed(Image.fromarray(RGB), "JPEG"), "is no PNG, as its name says, but a JPEG"),
        (by_hand(0, 10, 8, 2), "is no picture"),
        (by_hand(60000, 60000, 8, 2), "has far too many pixels"),
        (by_hand(10000, 10000, 8, 2), "has 10000x10000 pixels, and 64 million are the most"),
        (
            by_hand(30, 20, 8, 2, lines(RGB), chunk(b"zTXt", b"a\0\0" + zlib.compress(bytes(9_000_000)))),
            "is damaged or cut off (Decompressed data too large",
        ),
    ],
    ids=["text", "cut", "animated", "jpeg", "empty", "bomb", "large", "text-bomb"],
)
def test_what_is_no_picture_is_refused(data, words):
    assert words in said(data)


def test_other_kinds_are_refused_as_well():
    assert "holds more than one" in said(packed(Image.fromarray(RGB), "GIF", **MOVING), ".gif")
    assert "holds more than one" in said(packed(Image.fromarray(RGB), "TIFF", **MOVING), ".tif")
    assert "but a PNG. Rename it" in said(packed(Image.fromarray(RGB)), ".JPG")
    assert "floating-point" in said(packed(Image.fromarray(RGB[..., 0].astype(np.float32)), "TIFF"), ".tif")
    deep = Image.fromarray(RGB[..., 0].astype(np.int32) * 100_000)
    assert "beyond 16 bits" in said(packed(deep, "TIFF"), ".tif")


@pytest.mark.parametrize("kind", ["PNG", "TIFF", "GIF", "BMP", "WEBP", "PPM", "JPEG"])
def test_a_damaged_file_is_a_picture_or_one_line(kind, capsys):
    """Cut anywhere, or with bytes changed: of a PNG hardly one such is taken for a picture."""
    whole = packed(Image.fromarray(RGB), kind)
    choose, taken = random.Random(1), 0
    for trial in range(200):
        data = bytearray(whole)
        if trial % 2:
            data = data[: choose.randrange(len(data) - 12)]
        else:
            data[choose.randrange(min(len(data), 300))] ^= choose.randrange(1, 256)
        try:
            taken += picture.decode(bytes(data), "", most=1_000_000).image.dtype == np.uint8
        except picture.PictureError as error:
            assert "\n" not in str(error)
    assert kind != "PNG" or taken == 0
    assert capsys.readouterr() == ("", "")


def test_files_that_are_none(tmp_path):
    (tmp_path / "empty.png").touch()
    with (tmp_path / "huge.png").open("wb") as file:
        file.truncate(10**9)
    os.mkfifo(tmp_path / "pipe.png")
    wanted = {
        "empty.png": "is empty. Save it anew",
        "huge.png": "has 1000 MB, more than any picture of 64 million pixels",
        "pipe.png": "is a device or a pipe",
        "nowhere.png": "is not there. Correct the name",
        ".": "is a folder",
        "a\0.png": "cannot be opened",
        "x" * 300: "cannot be opened (File name too long)",
    }
    for name, words in wanted.items():
        with pytest.raises(picture.PictureError) as caught:
            picture.read(tmp_path / name)
        assert str(caught.value).startswith(str(tmp_path / name)) and words in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.remedy == "Look at its permissions"


def test_boxes_are_left_out():
    other = 255 - RGB
    found = picture.ignoring(RGB, other, [(2, 3, 10, 20), (29, 0, 30, 1)])
    assert np.array_equal(found[3:20, 2:10], RGB[3:20, 2:10]) and found[0, 29].tolist() == RGB[0, 29].tolist()
    assert np.array_equal(found[:3, :29], other[:3, :29])
    for box in ((5, 5, 5, 9), (0, 0, 31, 20), (-1, 0, 4, 4)):
        with pytest.raises(ValueError, match="ignore must be x0,y0,x1,y1"):
            picture.ignoring(RGB, other, [box])
