"""Films: frames to the bytes of an MP4 file with H.264, which every player and browser shows."""

import tempfile
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType

import numpy as np

from lietool.render.export import check

# The lower, the better and the larger; at 16 no line or letter of ours looks worse than in the frames.
_QUALITY = "16"
# Of Rec. 709, in the numbers of H.264: what players take a film for that says nothing.
_REC_709 = 1
_LIMITED = 1


class NoEncoderError(ValueError):
    """Nothing here can write H.264; the message says what to install."""


def require() -> None:
    """Look for the encoder, before any frame is drawn.

    Raises
    ------
    NoEncoderError
        If PyAV is not installed, or cannot be loaded.
    """
    try:
        import av.codec

        av.codec.Codec("libx264", "w")
    except (ImportError, ValueError) as error:
        raise NoEncoderError(
            f"a .mp4 needs PyAV with its encoder for H.264, which cannot be used here ({error}). "
            "Install it with: pip install av, or write a .gif or .apng"
        ) from None


def mp4(
    frames: Sequence[np.ndarray], seconds: float, text: Mapping[str, str] = MappingProxyType({})
) -> bytes:
    """Return frames as the bytes of an MP4 file.

    Parameters
    ----------
    frames : sequence of ndarray of uint8, shape (h, w, 3)
        sRGB; width and height must be even, for its colours have half as many pixels each way.
    seconds : float
        How long it takes.
    text : mapping of str to str
        What the file says of itself: ``title``, ``comment``.

    Returns
    -------
    bytes
        Beginning with its index, so that it can be shown before all of it has come.

    Raises
    ------
    NoEncoderError
        If PyAV is missing.
    ValueError
        If there is no frame, or the frames are of different or odd sizes.
    """
    check("video.mp4", frames)
    height, width = frames[0].shape[:2]
    if height % 2 or width % 2:
        raise ValueError(f"video.mp4: frames must have an even width and height; got {width} x {height}.")
    require()
    import av

    rate = Fraction(len(frames) / seconds).limit_denominator(1001)
    # Its index goes to the front in a second pass, for which it has to be a file.
    with tempfile.TemporaryDirectory(prefix="lietool-") as folder:
        path = Path(folder) / "film.mp4"
        options = {"movflags": "+faststart", "fflags": "+bitexact"}
        with av.open(str(path), "w", format="mp4", options=options) as container:
            container.metadata.update(text)
            stream = container.add_stream("libx264", rate=rate)
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
            stream.options = {"crf": _QUALITY, "preset": "medium", "tune": "animation"}
            coder = stream.codec_context
            coder.color_range = _LIMITED
            coder.colorspace = coder.color_primaries = coder.color_trc = _REC_709
            for image in frames:
                frame = av.VideoFrame.from_ndarray(image, format="rgb24").reformat(
                    format="yuv420p", dst_colorspace=_REC_709, dst_color_range=_LIMITED
                )
                container.mux(stream.encode(frame))
            container.mux(stream.encode())
        return path.read_bytes()
