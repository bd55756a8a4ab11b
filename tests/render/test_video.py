"""MP4 files, decoded again."""

import io
import sys

import av
import numpy as np
import pytest

from lietool.render import video

RED, INK = (200, 55, 45), (43, 47, 54)


def frames(count: int, height: int = 90, width: int = 120) -> list[np.ndarray]:
    """A red square that moves over white paper, beside a dark strip."""
    found = []
    for k in range(count):
        image = np.full((height, width, 3), 255, np.uint8)
        image[20:60, 4 + 2 * k : 44 + 2 * k] = RED
        image[:, -20:] = INK
        found.append(image)
    return found


def decoded(data: bytes) -> list[np.ndarray]:
    with av.open(io.BytesIO(data)) as film:
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]


def test_every_frame_is_there_in_its_colours():
    images = frames(12)
    found = decoded(video.mp4(images, 0.5))
    assert len(found) == 12
    for k, image in enumerate(found):
        for at, color in (((80, 5), (255, 255, 255)), ((40, 20 + 2 * k), RED), ((45, 110), INK)):
            assert np.abs(image[at].astype(int) - color).max() <= 3


def test_what_players_need_to_know():
    data = video.mp4(frames(10), 0.4, {"title": "a square", "comment": "it moves"})
    # The index comes before the pictures.
    assert data[4:8] == b"ftyp" and data.find(b"moov") < data.find(b"mdat")
    with av.open(io.BytesIO(data)) as film:
        (stream,) = film.streams.video
        coder = stream.codec_context
        assert coder.name == "h264" and stream.pix_fmt == "yuv420p"
        assert (coder.color_range, coder.colorspace, coder.color_primaries, coder.color_trc) == (1, 1, 1, 1)
        assert stream.average_rate == 25 and stream.frames == 10
        assert stream.duration is not None and stream.duration * stream.time_base == pytest.approx(0.4)
        assert film.metadata["title"] == "a square" and film.metadata["comment"] == "it moves"


def test_the_same_frames_are_the_same_file():
    assert video.mp4(frames(6), 0.2) == video.mp4(frames(6), 0.2)


@pytest.mark.parametrize(
    ("images", "words"),
    [
        ([], "video.mp4: frames must not be empty"),
        ([np.zeros((4, 4), np.uint8)], "video.mp4: image must be uint8"),
        ([*frames(1), *frames(1, 80)], "video.mp4: frames must be of one shape"),
        (frames(2, 45), "video.mp4: frames must have an even width and height; got 120 x 45"),
        (frames(2, 90, 121), "video.mp4: frames must have an even width and height; got 121 x 90"),
    ],
)
def test_what_is_no_film_is_refused(images, words):
    with pytest.raises(ValueError, match=words):
        video.mp4(images, 1.0)


def test_without_an_encoder_it_says_what_to_install(monkeypatch):
    video.require()

    def none(*_: object) -> None:
        raise ValueError("libx264")

    monkeypatch.setattr(av.codec, "Codec", none)
    with pytest.raises(video.NoEncoderError, match=r"pip install av, or write a \.gif or \.apng"):
        video.require()
    monkeypatch.setitem(sys.modules, "av.codec", None)
    with pytest.raises(video.NoEncoderError, match="needs PyAV"):
        video.mp4(frames(2), 1.0)
