"""PNG and GIF files, read back."""

import io

import numpy as np
import pytest
from PIL import Image, ImageSequence

from lietool.render import export


def _frames(count: int) -> list[np.ndarray]:
    """A shaded ball that moves over white paper, beside a small mark in a colour of its own."""
    y, x = np.mgrid[:60, :80]
    frames = []
    for k in range(count):
        height = np.clip(1.0 - ((x - 20 - 3 * k) ** 2 + (y - 30) ** 2) / 300.0, 0.0, 1.0)[..., None]
        image = np.full((60, 80, 3), 255.0) * (height == 0) + height * (80, 160, 240)
        image[2:4, 2:4] = (200, 56, 45)
        frames.append(np.rint(image).astype(np.uint8))
    return frames


def _read(data: bytes) -> list[np.ndarray]:
    with Image.open(io.BytesIO(data)) as image:
        return [np.array(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)]


def test_png_keeps_pixels_and_texts() -> None:
    image = _frames(1)[0]
    data = export.png(image, {"command": "slerp", "parameters": '{"label": "\N{GREEK SMALL LETTER THETA}"}'})
    with Image.open(io.BytesIO(data)) as found:
        assert found.info == {"command": "slerp", "parameters": '{"label": "\N{GREEK SMALL LETTER THETA}"}'}
        assert np.array_equal(np.array(found), image)


def test_png_knows_its_dots_per_inch() -> None:
    for dpi in (72.0, 300.0):
        with Image.open(io.BytesIO(export.png(_frames(1)[0], {}, dpi))) as found:
            assert found.info["dpi"] == pytest.approx((dpi, dpi), abs=0.02)


def test_apng_keeps_every_pixel_and_the_time() -> None:
    frames = _frames(7)
    data = export.apng([*frames, frames[3]], 1.0, {"Title": "a ball"})
    with Image.open(io.BytesIO(data)) as image:
        assert image.info["loop"] == 0 and image.info["Title"] == "a ball"
        found = [np.array(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)]
        durations = []
        for k in range(8):
            image.seek(k)
            durations.append(image.info["duration"])
    assert all(map(np.array_equal, found, [*frames, frames[3]]))
    assert sum(durations) == 1000.0 and max(durations) - min(durations) <= 1.0


def test_gif_does_not_flicker() -> None:
    frames = _frames(10)
    found = _read(export.gif(frames, 1.0))
    assert len(found) == len(frames)
    still = np.all([frame == frames[0] for frame in frames], axis=(0, 3))
    assert still.mean() > 0.4
    for before, after in zip(frames, found, strict=True):
        assert np.array_equal(after[still], found[0][still])
        # The paper has no tint, and no other colour is far off.
        assert np.all(after[(before == 255).all(axis=2)] == 255)
        assert np.abs(after.astype(int) - before).mean() < 0.5
    assert np.abs(found[0][3, 3].astype(int) - (200, 56, 45)).max() <= 6


def test_gif_takes_a_frame_twice() -> None:
    frames = _frames(4)
    found = _read(export.gif([*frames, frames[2], frames[1]], 1.2))
    assert np.array_equal(found[2], found[4])
    assert np.array_equal(found[1], found[5])


def test_gif_loops_in_the_time_asked_for() -> None:
    with Image.open(io.BytesIO(export.gif(_frames(8), 2.0))) as image:
        assert image.info["loop"] == 0
        assert image.info["duration"] == 250
    with Image.open(io.BytesIO(export.gif(_frames(8), 0.01))) as image:
        assert image.info["duration"] == 20


def test_gif_of_few_colours() -> None:
    frames = [np.full((4, 5, 3), grey, np.uint8) for grey in (0, 255)]
    assert [frame[0, 0, 0] for frame in _read(export.gif(frames, 1.0))] == [0, 255]


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((2, 2, 4), np.uint8),
        np.zeros((2, 2, 3)),
        np.zeros((2, 2), np.uint8),
        np.zeros((0, 2, 3), np.uint8),
    ],
)
def test_what_is_no_image_is_refused(image: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"export\.png: image must be uint8 \(h, w, 3\)"):
        export.png(image, {})
    with pytest.raises(ValueError, match=r"export\.gif: image must be uint8 \(h, w, 3\)"):
        export.gif([image], 1.0)
    with pytest.raises(ValueError, match=r"export\.apng: image must be uint8 \(h, w, 3\)"):
        export.apng([image], 1.0, {})


def test_gif_needs_frames_of_one_shape() -> None:
    with pytest.raises(ValueError, match="frames must not be empty"):
        export.gif([], 1.0)
    with pytest.raises(ValueError, match="frames must be of one shape"):
        export.gif([np.zeros((2, 2, 3), np.uint8), np.zeros((2, 3, 3), np.uint8)], 1.0)
