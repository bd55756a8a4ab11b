"""Two pictures: are they the same, as an eye and not as a file comparison would say.

The rule has two halves, and each sees what the other is blind to.  The count
of pixels beyond a colour distance catches anything small and strong: a moved
edge, a missing dot, a changed letter.  The 9x9 mean of the *signed* difference
catches anything wide and weak, a surface three levels too light, while the
noise of antialiasing, which has no sign of its own, cancels in it.

Pixels beyond the colour distance are counted where they crowd.  Another
processor rounds a corner of a mesh otherwise in its last bit, and one sample of
one pixel falls on the other side of an edge: such pixels are strewn over the
picture, the more of them the finer the mesh, while a mistake leaves them side by side.
"""

from dataclasses import dataclass

import numpy as np

PIXELS = 8
# Pixels so near to each other, each way, are in one place; and so many may be strewn over all places.
NEAR, STREWN = 16, 48
DELTA_E = 2.0
LOWPASS = 1.5
BOX = 9

# sRGB to linear light for every 8-bit level, and linear sRGB to XYZ over the D65 white.
_LEVEL = np.arange(256) / 255.0
_LINEAR = np.where(_LEVEL <= 0.04045, _LEVEL / 12.92, ((_LEVEL + 0.055) / 1.055) ** 2.4)
_XYZ = np.array(
    [[0.412453, 0.357580, 0.180423], [0.212671, 0.715160, 0.072169], [0.019334, 0.119193, 0.950227]]
) / np.array([[0.95047], [1.0], [1.08883]])
_PIECE = 8192


@dataclass(frozen=True)
class Comparison:
    """What the comparison of two pictures found; lengths in pixels, positions (x, y) from the upper left.

    `over` counts pixels beyond the colour distance, `crowd` those of them
    that are in one place, 33x33 pixels around one of them.
    `lowpass` is the 9x9 mean of actual minus expected that is largest in
    magnitude, with its sign, and `channel` the channel where it was found.
    Positions are None where nothing differs.
    """

    expected_size: tuple[int, int]
    actual_size: tuple[int, int]
    differing: int = 0
    over: int = 0
    crowd: int = 0
    crowd_at: tuple[int, int] | None = None
    largest_delta_e: float = 0.0
    largest_delta_e_at: tuple[int, int] | None = None
    lowpass: float = 0.0
    lowpass_at: tuple[int, int] | None = None
    lowpass_channel: str = ""
    too_far: bool = False
    too_wide: bool = False
    pixels_limit: int = PIXELS
    strewn_limit: int = STREWN
    delta_e_limit: float = DELTA_E
    lowpass_limit: float = LOWPASS

    @property
    def same_size(self) -> bool:
        """Whether the two can be compared at all."""
        return self.expected_size == self.actual_size

    @property
    def equal(self) -> bool:
        """Whether every pixel is the same."""
        return self.same_size and self.differing == 0

    @property
    def passes(self) -> bool:
        """Whether the two count as the same picture."""
        return self.same_size and not self.too_far and not self.too_wide

    @property
    def beyond(self) -> str:
        """How many pixels exceed the colour distance and how many may, in words."""
        return (
            f"{self.over} px beyond dE {self.delta_e_limit:g} ({self.strewn_limit} allowed),"
            f" {self.crowd} of them in one place ({self.pixels_limit} allowed)"
        )

    @property
    def says(self) -> str:
        """All that the verdict rests on, in words."""
        return (
            f"{self.beyond}, largest {self.largest_delta_e:.1f} at {self.largest_delta_e_at};"
            f" 9x9 mean {self.lowpass:+.2f} levels of {self.lowpass_channel} ({self.lowpass_limit:g} allowed)"
            f" at {self.lowpass_at}"
        )

    @property
    def headroom_pixels(self) -> int:
        """How many more pixels might exceed the colour distance in one place; negative when it failed."""
        return min(self.pixels_limit - self.crowd, self.strewn_limit - self.over)

    @property
    def headroom_lowpass(self) -> float:
        """How many more grey levels the 9x9 mean might reach; negative when it failed."""
        return self.lowpass_limit - abs(self.lowpass)


def images(
    expected: np.ndarray,
    actual: np.ndarray,
    *,
    pixels: int = PIXELS,
    delta_e: float = DELTA_E,
    lowpass: float = LOWPASS,
) -> Comparison:
    """Compare two pictures by the rule that decides whether a golden still holds.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        sRGB pictures; different sizes are a verdict, not an error.
    pixels : int
        How many pixels may lie beyond `delta_e` in one place; in all they may be `STREWN`, or as many
        as this if that is more.
    delta_e : float
        Colour distance dE76 (CIELAB over D65) that a pixel may reach.
    lowpass : float
        Grey levels that the 9x9 mean of the signed difference may reach in any channel.

    Returns
    -------
    Comparison
        Every number the verdict rests on.

    Raises
    ------
    ValueError
        If a picture is not (h, w, 3) uint8 or has no pixels.
    """
    _check("expected", expected)
    _check("actual", actual)
    sizes = (_size(expected), _size(actual))
    limits = {
        "pixels_limit": pixels,
        "strewn_limit": max(STREWN, pixels),
        "delta_e_limit": delta_e,
        "lowpass_limit": lowpass,
    }
    if sizes[0] != sizes[1] or _same_bytes(expected, actual):
        return Comparison(*sizes, **limits)

    unequal = differing(expected, actual)
    changed = np.flatnonzero(unequal)
    # By one index into rows of pixels: a tenth of the time that two indices take.
    far = delta_e76(*(image.reshape(-1, 3).take(changed, axis=0) for image in (expected, actual)))
    worst = int(far.argmax())
    beyond = far > delta_e
    over = int(np.count_nonzero(beyond))
    rows, columns = np.divmod(changed[beyond], expected.shape[1])
    crowd, crowd_at = _crowd(columns, rows, expected.shape)
    # Beyond four pixels from the last differing one every mean is zero; the frame keeps the edges reflected.
    part = _around(unequal)
    sums = box_sums(np.subtract(actual[part], expected[part], dtype=np.int16))
    y, x, channel = np.unravel_index(int(np.abs(sums).argmax()), sums.shape)
    largest = int(sums[y, x, channel])
    return Comparison(
        *sizes,
        differing=changed.size,
        over=over,
        crowd=crowd,
        crowd_at=crowd_at,
        largest_delta_e=float(far[worst]),
        largest_delta_e_at=(int(changed[worst]) % sizes[0][0], int(changed[worst]) // sizes[0][0]),
        lowpass=largest / BOX**2,
        lowpass_at=(int(x) + part[1].start, int(y) + part[0].start),
        lowpass_channel="RGB"[channel],
        too_far=crowd > pixels or over > limits["strewn_limit"],
        # On the sums, which are whole numbers: a mean of exactly the limit is still within it.
        too_wide=abs(largest) > lowpass * BOX**2,
        **limits,
    )


def differing(expected: np.ndarray, actual: np.ndarray) -> np.ndarray:
    """Mark the pixels that are not the same.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        Pictures of one size.

    Returns
    -------
    (h, w) bool
        True where any channel differs.
    """
    unequal = expected != actual
    # Three ors; a reduction over so short an axis takes ten times as long.
    return unequal[..., 0] | unequal[..., 1] | unequal[..., 2]


def delta_e76(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Colour distance dE76 of 8-bit sRGB colours.

    Parameters
    ----------
    a, b : (..., 3) uint8
        sRGB colours.

    Returns
    -------
    (...) float64
        Euclidean distance in CIELAB over the D65 white.
    """
    a, b = np.broadcast_arrays(a, b)
    flat = a.reshape(-1, 3), b.reshape(-1, 3)
    distance = np.empty(len(flat[0]))
    # In pieces that stay in the processor's cache: seven times as fast as all at once.
    for start in range(0, distance.size, _PIECE):
        piece = slice(start, start + _PIECE)
        squares = [(x - y) ** 2 for x, y in zip(_lab(flat[0][piece]), _lab(flat[1][piece]), strict=True)]
        distance[piece] = np.sqrt(squares[0] + squares[1] + squares[2])
    return distance.reshape(a.shape[:-1])


def box_sums(difference: np.ndarray) -> np.ndarray:
    """Sum the 9x9 neighbours of each pixel, each channel by itself, edges reflected (d c b a | a b c d).

    Parameters
    ----------
    difference : (h, w, 3) int16
        Signed difference of two 8-bit pictures.

    Returns
    -------
    (h, w, 3) int16
        81 times the box mean, exactly: 81 * 255 fits into 16 bits.
    """
    half = BOX // 2
    padded = np.pad(difference, ((half, half), (half, half), (0, 0)), mode="symmetric")
    # Rows, then columns; nine neighbours by doubling (2, 4, 8, and one), four additions instead of eight.
    two = padded[:-1] + padded[1:]
    four = two[:-2] + two[2:]
    rows = four[:-5] + four[4:-1] + padded[8:]
    two = rows[:, :-1] + rows[:, 1:]
    four = two[:, :-2] + two[:, 2:]
    return four[:, :-5] + four[:, 4:-1] + rows[:, 8:]


def _crowd(x: np.ndarray, y: np.ndarray, shape: tuple[int, ...]) -> tuple[int, tuple[int, int] | None]:
    """The most pixels in one place, and around which; of equal places the upper left."""
    if not x.size:
        return 0, None
    if x.size <= 4 * STREWN:
        near = (np.abs(x - x[:, None]) <= NEAR) & (np.abs(y - y[:, None]) <= NEAR)
        count = near.sum(axis=1)
    else:
        # Sums over all pixels above and to the left; a place's is what is between its corners.
        marks = np.zeros((shape[0] + 1, shape[1] + 1), np.int32)
        marks[y + 1, x + 1] = 1
        sums = marks.cumsum(axis=0, out=marks).cumsum(axis=1, out=marks)
        top, left = np.maximum(y - NEAR, 0), np.maximum(x - NEAR, 0)
        bottom, right = np.minimum(y + NEAR + 1, shape[0]), np.minimum(x + NEAR + 1, shape[1])
        count = sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left]
    most = int(count.argmax())
    return int(count[most]), (int(x[most]), int(y[most]))


def _lab(colour: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    # No byte is out of the table's range; clipping spares a look at each.
    r, g, b = _LINEAR.take(np.ascontiguousarray(colour.T), mode="clip")
    x, y, z = (_lab_root(row[0] * r + row[1] * g + row[2] * b) for row in _XYZ)
    return 116.0 * y, 500.0 * (x - y), 200.0 * (y - z)


def _lab_root(t: np.ndarray) -> np.ndarray:
    root = np.cbrt(t)
    dark = t <= (6 / 29) ** 3
    root[dark] = t[dark] * (29 / 6) ** 2 / 3 + 4 / 29
    return root


def _around(unequal: np.ndarray) -> tuple[slice, slice]:
    """The part of a picture that holds all marked pixels and a box around each."""
    return _span(np.logical_or.reduce(unequal, axis=1)), _span(np.logical_or.reduce(unequal, axis=0))


def _span(marked: np.ndarray) -> slice:
    first, last = np.flatnonzero(marked)[[0, -1]]
    return slice(max(int(first) - BOX // 2, 0), int(last) + BOX // 2 + 1)


def _same_bytes(a: np.ndarray, b: np.ndarray) -> bool:
    if a.flags.c_contiguous and b.flags.c_contiguous and a.size % 8 == 0:
        a, b = a.reshape(-1).view(np.uint64), b.reshape(-1).view(np.uint64)
    return bool(np.array_equal(a, b))


def _size(image: np.ndarray) -> tuple[int, int]:
    return image.shape[1], image.shape[0]


def _check(name: str, image: np.ndarray) -> None:
    if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
        raise ValueError(
            f"compare.images: {name} must be a picture (h, w, 3) uint8; got {image.shape} {image.dtype}. "
            "Drop the alpha channel or round to 8 bits first."
        )
