"""Why two pictures are not the same: where they differ, how much, and a picture of it.

None of this decides anything.  It is made only once a comparison has failed,
so that it may take its time.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lietool import atomic
from lietool.golden import compare

# How much of the expected picture shines through the difference, so that one sees where one is.
_GHOST = 0.15
_GAIN = 16
# Differing pixels so near to each other are one blob.
_REACH = 6
_MOST = 8
# Of the map of similarity: its colours, and the root of 1 - SSIM below which it is clear.
_MILD, _STRONG, _UNSEEN = (250.0, 204.0, 90.0), (150.0, 10.0, 40.0), 0.05
_PARTS = ("expected", "actual", "difference")


@dataclass(frozen=True)
class Blob:
    """A place where two pictures differ, and how much; `box` is (x0, y0, x1, y1), x1 and y1 just outside."""

    box: tuple[int, int, int, int]
    pixels: int
    delta_e: float
    ssim: float

    def __str__(self) -> str:
        """Say it in one line."""
        x0, y0, x1, y1 = self.box
        how = f"dE {self.delta_e:.1f}, SSIM {self.ssim:.3f}"
        return f"{x1 - x0}x{y1 - y0} at ({x0}, {y0}): {self.pixels} px, {how}"


def blobs(expected: np.ndarray, actual: np.ndarray, *, delta_e: float = compare.DELTA_E) -> list[Blob]:
    """Find where two pictures differ.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        Pictures of one size.
    delta_e : float
        Pixels beyond this distance make the blobs; if there are none, all that differ do.

    Returns
    -------
    list of Blob
        The larger first.
    """
    from skimage.measure import label, regionprops
    from skimage.morphology import isotropic_dilation

    far = _distances(expected, actual)
    mask = far > delta_e if (far > delta_e).any() else far > 0
    similarity = _similarity(expected, actual)
    found = []
    # Grown marks hold together what antialiasing tore apart; only the true ones are counted.
    for region in regionprops(mask * np.asarray(label(isotropic_dilation(mask, _REACH)))):
        y0, x0, y1, x1 = (int(edge) for edge in region.bbox)
        inside = np.s_[y0:y1, x0:x1]
        worst = float(far[inside].max()), float(similarity[inside].min())
        found.append(Blob((x0, y0, x1, y1), int(region.area), *worst))
    return sorted(found, key=lambda blob: (-blob.pixels, blob.box))


def amplified(expected: np.ndarray, actual: np.ndarray) -> np.ndarray:
    """Draw the signed difference, sixteenfold, about mid-grey over a ghost of the expected picture.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        Pictures of one size.

    Returns
    -------
    (h, w, 3) uint8
        Lighter where actual is lighter.
    """
    ghost = 128 + _GHOST * (expected.mean(axis=2, keepdims=True) - 128)
    return np.clip(ghost + _GAIN * (actual.astype(float) - expected), 0, 255).round().astype(np.uint8)


def similarity_png(expected: np.ndarray, actual: np.ndarray) -> bytes:
    """Draw where two pictures are alike: clear where SSIM is 1, a warm colour over what is unlike.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        Pictures of one size.

    Returns
    -------
    bytes
        PNG with a palette whose colour and opacity follow 1 - SSIM, which runs from 0 to 2.
    """
    import io

    from PIL import Image

    # The root shows also what is slight: most of a difference has a similarity near 1.
    unlike = np.sqrt(np.clip(1.0 - _similarity(expected, actual), 0.0, 1.0))
    picture = Image.fromarray((unlike * 255).round().astype(np.uint8), "L").convert("P")
    ramp = np.linspace(0.0, 1.0, 256)[:, None]
    colours = np.array(_MILD) * (1 - ramp) + np.array(_STRONG) * ramp
    picture.putpalette(colours.round().astype(np.uint8).tobytes())
    alpha = np.where(ramp[:, 0] < _UNSEEN, 0.0, 70 + 185 * ramp[:, 0]).round().astype(np.uint8)
    file = io.BytesIO()
    picture.save(file, "PNG", transparency=alpha.tobytes())
    return file.getvalue()


def lines(expected: np.ndarray, actual: np.ndarray, found: compare.Comparison) -> list[str]:
    """Explain a comparison that failed, in lines for a reader.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        The pictures.
    found : Comparison
        What comparing them gave.

    Returns
    -------
    list of str
        The verdict's numbers, then the blobs.
    """
    said = [
        f"{found.beyond}, largest {found.largest_delta_e:.1f} at {found.largest_delta_e_at}",
        f"9x9 mean {found.lowpass:+.2f} levels of {found.lowpass_channel} (allowed {found.lowpass_limit:g})"
        f" at {found.lowpass_at}",
    ]
    places = blobs(expected, actual, delta_e=found.delta_e_limit)
    said += [str(blob) for blob in places[:_MOST]]
    return said + ([f"and {len(places) - _MOST} places more"] if len(places) > _MOST else [])


def leave(folder: Path, plate: str, **pictures: np.ndarray | None) -> list[Path]:
    """Leave pictures of a failure for the reader, and take away those of an earlier one.

    Parameters
    ----------
    folder : Path
        Such as out/failed; not made for nothing.
    plate : str
        What the file names begin with.
    **pictures : (h, w, 3) uint8
        expected, actual and difference; a part that is not given is removed, so all when the plate passes.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    written = []
    for part in _PARTS:
        path = folder / f"{plate}-{part}.png"
        picture = pictures.get(part)
        if picture is None:
            path.unlink(missing_ok=True)
        else:
            atomic.write_bytes(path, png(picture))
            written.append(path)
    return written


def _distances(expected: np.ndarray, actual: np.ndarray) -> np.ndarray:
    mask = compare.differing(expected, actual)
    far = np.zeros(mask.shape)
    far[mask] = compare.delta_e76(expected[mask], actual[mask])
    return far


def _similarity(expected: np.ndarray, actual: np.ndarray) -> np.ndarray:
    """SSIM around each pixel, over 7x7."""
    from skimage.metrics import structural_similarity

    greys = [np.pad(picture.mean(axis=2), 3, mode="symmetric") for picture in (expected, actual)]
    return structural_similarity(*greys, data_range=255, full=True)[1][3:-3, 3:-3]


def png(picture: np.ndarray) -> bytes:
    """Write a picture as PNG.

    Parameters
    ----------
    picture : (h, w, 3) or (h, w) uint8
        sRGB or grey.

    Returns
    -------
    bytes
        The file.
    """
    import io

    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(picture).save(file, "PNG")
    return file.getvalue()
