"""Two images of our own: a balloon on a bright day, and hills at dusk; in levels from 0 to 255.

They are whole, as cameras give them: what is decided by comparing them is then decided alike on every
machine.  Lengths are in heights of an image, x to the right and y down.
"""

from functools import cache

import numpy as np

Array = np.ndarray
Level = tuple[float, float, float]

# Samples of a pixel each way.
_FINE = 3
_SEED = 20

# The sky at dusk from the top down; hills from far to near: height of the ridge, how it waves, its colour.
_DUSK: tuple[tuple[float, Level], ...] = (
    (0.00, (52.0, 62.0, 122.0)),
    (0.26, (104.0, 92.0, 160.0)),
    (0.50, (192.0, 130.0, 164.0)),
    (0.68, (246.0, 178.0, 146.0)),
    (0.80, (255.0, 220.0, 164.0)),
)
_HILLS: tuple[tuple[float, float, Level], ...] = (
    (0.690, 0.030, (184.0, 132.0, 152.0)),
    (0.745, 0.040, (128.0, 98.0, 136.0)),
    (0.815, 0.045, (80.0, 68.0, 110.0)),
    (0.895, 0.040, (44.0, 44.0, 78.0)),
)
# The sun has just gone down here; how far its light reaches, and what it adds.
_SUN, _REACH, _GLOW = (0.30, 0.70), (0.50, 0.20), (70.0, 62.0, 10.0)
_FIRS = (
    (0.06, 0.085),
    (0.115, 0.125),
    (0.155, 0.075),
    (1.13, 0.09),
    (1.185, 0.14),
    (1.235, 0.105),
    (1.29, 0.07),
)
_STARS = 70

# The day: sky from the top down, and the balloon's gores, its basket and ropes.
_DAY: tuple[tuple[float, Level], ...] = ((0.0, (126.0, 170.0, 210.0)), (1.0, (200.0, 214.0, 222.0)))
_GORES: tuple[Level, ...] = (
    (248.0, 240.0, 226.0),
    (244.0, 188.0, 104.0),
    (248.0, 240.0, 226.0),
    (96.0, 150.0, 204.0),
)
_GORE_COUNT, _TILT = 16, 0.22
_BASKET, _ROPE = (176.0, 136.0, 100.0), (112.0, 96.0, 88.0)
# The envelope: its middle and radius; and the lower end of the basket.
_MIDDLE, _RADIUS, _FOOT = (0.5, 0.375), 0.265, 0.865
# Where the ball becomes a cone, below its middle, radians; and where that ends, in radii.
_CONE, _MOUTH = np.radians(37.0), 1.36
_LIGHT = (-0.60, 0.42, 0.68)
# How far beyond the balloon the mask is drawn.
_LOOSE = 0.045


@cache
def evening(height: int) -> Array:
    """Return hills under the sky after sunset (height, 4/3 height, 3), in whole levels."""
    x, y = _places(height, 4 * height // 3, 1)
    image = _ramp(_DUSK, y)
    glow = np.exp(-(((x - _SUN[0]) / _REACH[0]) ** 2) - ((y - _SUN[1]) / _REACH[1]) ** 2)
    image += glow[..., None] * np.array(_GLOW)
    image += _clouds(x, y)
    image += _stars(x, y)
    last = len(_HILLS) - 1
    for k, (ridge, wave, color) in enumerate(_HILLS):
        top = ridge + wave * _waves(x[0], k)
        if k == last:
            top = _firs(x[0], top)
        # Haze lies in the valleys, and thins towards the eye.
        depth = np.clip((y - top) / 0.10, 0.0, 1.0)[..., None]
        haze = 0.42 * (1.0 - 0.85 * k / last) * depth
        body = (1.0 - haze) * np.array(color) + haze * np.array(_DUSK[-1][1])
        # How much of the pixel is below the ridge.
        steep = np.sqrt(1.0 + (np.gradient(top) * height) ** 2)
        cover = np.clip((y - top) * height / steep + 0.5, 0.0, 1.0)[..., None]
        image = (1.0 - cover) * image + cover * body
    return np.rint(np.clip(image, 0.0, 255.0))


@cache
def balloon(height: int) -> tuple[Array, Array]:
    """Return a balloon on a bright day (height, height, 3), in whole levels, and a loose mask around it."""
    x, y = _places(height, height, _FINE)
    image = _ramp(_DAY, y) + _far_clouds(x, y)
    image = _basket(image, x, y)
    image = _envelope(image, x, y)
    px, py = (a[_FINE // 2 :: _FINE, _FINE // 2 :: _FINE] for a in (x, y))
    return _developed(image), _around(px, py) < _LOOSE


def _places(height: int, width: int, fine: int) -> tuple[Array, Array]:
    """x and y of the samples, so many to a pixel each way."""
    rows, columns = ((np.arange(n * fine) + 0.5) / (fine * height) for n in (height, width))
    x, y = np.meshgrid(columns, rows)
    return x, y


def _developed(samples: Array) -> Array:
    """The means of the samples of each pixel, as whole levels."""
    h, w = (n // _FINE for n in samples.shape[:2])
    return np.rint(np.clip(samples, 0.0, 255.0).reshape(h, _FINE, w, _FINE, 3).mean(axis=(1, 3)))


def _ramp(stops: tuple[tuple[float, Level], ...], at: Array) -> Array:
    where = [stop for stop, _ in stops]
    return np.stack([np.interp(at, where, [color[k] for _, color in stops]) for k in range(3)], axis=-1)


def _waves(x: Array, k: int) -> Array:
    """A ridge between -1 and 1, another for each k."""
    total = np.zeros_like(x)
    for n, (frequency, size) in enumerate(((2.1, 0.55), (4.7, 0.28), (9.3, 0.12), (21.0, 0.05))):
        total += size * np.sin(frequency * (1.0 + 0.13 * k) * x + 1.7 * k + 2.3 * n + 0.9)
    return total


def _firs(x: Array, ground: Array) -> Array:
    """The upper edge of firs that stand on the ground."""
    top = ground.copy()
    for at, tall in _FIRS:
        out = np.abs(x - at) / (0.30 * tall)
        # Branches in tiers, wider below.
        tier = 0.10 * (1.0 - np.abs(((1.0 - out) * 7.0) % 1.0 - 0.5) * 2.0)
        edge = ground - tall * (1.0 - out - tier * (out < 0.9))
        top = np.where(out < 1.0, np.minimum(top, edge), top)
    return top


def _noise(x: Array, y: Array, cells: int) -> Array:
    """Smooth noise, -1 to 1, with so many values in a height."""
    lattice = np.random.default_rng(_SEED + cells).uniform(-1.0, 1.0, (cells + 2, 3 * cells + 2))
    u, v = (cells * np.mod(x, 3.0)).ravel(), (cells * np.clip(y, 0.0, 1.0)).ravel()
    i, j = v.astype(int), np.minimum(u.astype(int), 3 * cells)
    s, t = (w * w * (3.0 - 2.0 * w) for w in (v - i, u - j))
    upper = lattice[i, j] * (1.0 - t) + lattice[i, j + 1] * t
    lower = lattice[i + 1, j] * (1.0 - t) + lattice[i + 1, j + 1] * t
    return (upper * (1.0 - s) + lower * s).reshape(x.shape)


def _clouds(x: Array, y: Array) -> Array:
    """Long thin clouds, lit from below where the sun went down."""
    sizes = ((9, 0.6), (18, 0.3), (36, 0.15))
    density = sum(
        size * _noise(0.42 * x + 0.11 * n, 0.10 + 0.8 * y, cells) for n, (cells, size) in enumerate(sizes)
    )
    band = np.exp(-(((y - 0.56) / 0.10) ** 2))
    cover = np.clip(band * (density + 0.10) * 2.2, 0.0, 1.0)
    return cover[..., None] * np.array((28.0, 2.0, -16.0))


def _stars(x: Array, y: Array) -> Array:
    """Stars of the early evening, more and brighter ones high up."""
    rng = np.random.default_rng(_SEED)
    at = rng.uniform((0.0, 0.0), (4.0 / 3.0, 0.42), (_STARS, 2))
    bright = rng.uniform(0.25, 1.0, _STARS) ** 2 * (1.0 - at[:, 1] / 0.42)
    light = np.zeros_like(x)
    step = x[0, 1] - x[0, 0]
    for (u, v), b in zip(at, bright, strict=True):
        r = 0.0028 + 0.0016 * b
        rows, columns = (slice(max(int((c - 4 * r) / step), 0), int((c + 4 * r) / step) + 1) for c in (v, u))
        far = ((x[rows, columns] - u) ** 2 + (y[rows, columns] - v) ** 2) / r**2
        light[rows, columns] += 190.0 * b * np.exp(-far)
    return light[..., None] * np.array((1.0, 0.97, 0.90))


def _far_clouds(x: Array, y: Array) -> Array:
    """White clouds low in the day's sky."""
    density = sum(size * _noise(0.7 * x, y, cells) for cells, size in ((5, 0.6), (10, 0.3), (20, 0.15)))
    # None near the balloon, where they would be pasted with it.
    apart = np.clip(_around(x, y) / _LOOSE - 1.0, 0.0, 1.0)
    cover = np.clip((density - 0.02 + 0.5 * (y - 0.8)) * 1.6, 0.0, 1.0) * apart
    return cover[..., None] * np.array((50.0, 28.0, 16.0))


def _profile(y: Array) -> Array:
    """The radius of the envelope at a height: a ball above, a cone below."""
    t = (y - _MIDDLE[1]) / _RADIUS
    ball = np.sqrt(np.clip(1.0 - t * t, 0.0, 1.0))
    cone = np.cos(_CONE) - np.tan(_CONE) * (t - np.sin(_CONE))
    return _RADIUS * np.where(t < np.sin(_CONE), ball, np.where(t < _MOUTH, cone, 0.0))


def _envelope(image: Array, x: Array, y: Array) -> Array:
    radius = _profile(y)
    inside = (np.abs(x - _MIDDLE[0]) < radius) & (radius > 0.0)
    u = np.where(inside, (x - _MIDDLE[0]) / np.where(radius > 0.0, radius, 1.0), 0.0)
    longitude = np.arcsin(np.clip(u, -1.0, 1.0)) + _TILT
    gore = longitude * _GORE_COUNT / (2.0 * np.pi)
    which = np.floor(gore).astype(int) % len(_GORES)
    color = np.array(_GORES)[which]
    # A band around the middle in the other colours.
    band = np.abs(y - _MIDDLE[1] - 0.05) < 0.040
    color = np.where(band[..., None], np.array(_GORES)[(which + 2) % len(_GORES)], color)
    # Each gore bulges between its seams.
    bulge = 0.30 * np.sin(2.0 * np.pi * (gore - np.floor(gore) - 0.5))
    slope = np.gradient(radius, y[1, 0] - y[0, 0], axis=0)
    lean = slope / np.sqrt(1.0 + slope**2)
    across = np.sqrt(1.0 - lean**2)
    turn = np.arcsin(np.clip(u, -1.0, 1.0)) + 0.5 * bulge
    normal = np.stack([across * np.sin(turn), lean, across * np.cos(turn)], axis=-1)
    light = np.array(_LIGHT) / np.linalg.norm(_LIGHT)
    lit = np.clip(normal @ light, 0.0, 1.0)
    seam = 1.0 - 0.10 * np.exp(-(((gore - np.rint(gore)) / 0.035) ** 2))
    shade = (0.56 + 0.50 * lit) * seam
    half = light + np.array([0.0, 0.0, 1.0])
    shine = 34.0 * np.clip(normal @ half / np.linalg.norm(half), 0.0, 1.0) ** 24
    return np.where(inside[..., None], color * shade[..., None] + shine[..., None], image)


def _basket(image: Array, x: Array, y: Array) -> Array:
    mouth = _MIDDLE[1] + _MOUTH * _RADIUS
    top, wide = _FOOT - 0.085, 0.052
    u = x - _MIDDLE[0]
    t = np.clip((y - mouth) / (top - mouth), 0.0, 1.0)
    for side in (-1.0, -0.35, 0.35, 1.0):
        rope = np.abs(u - side * (0.042 * (1.0 - t) + 0.046 * t)) < 0.0035
        image = np.where((rope & (y > mouth - 0.01) & (y < top))[..., None], np.array(_ROPE), image)
    deep = np.clip((y - top) / (_FOOT - top), 0.0, 1.0)
    inside = (np.abs(u) < wide * (1.0 - 0.10 * deep)) & (y > top) & (y < _FOOT)
    weave = 0.90 + 0.10 * np.sign(np.sin(260.0 * u) * np.sin(300.0 * y))
    shade = (1.02 - 0.50 * np.clip(u / wide * 0.5 + 0.5, 0.0, 1.0)) * weave * np.where(deep < 0.14, 1.18, 1.0)
    return np.where(inside[..., None], np.array(_BASKET) * shade[..., None], image)


def _around(x: Array, y: Array) -> Array:
    """How far a place is from the balloon: a ball, a smaller one at the basket, and what is between."""
    r1, r2, length = _RADIUS, 0.070, _FOOT - 0.06 - _MIDDLE[1]
    px, py = np.abs(x - _MIDDLE[0]), y - _MIDDLE[1]
    sine = (r1 - r2) / length
    cosine = np.sqrt(1.0 - sine * sine)
    # The foot of the place on the common tangent of the two.
    along = py * cosine - px * sine
    beside = px * cosine + py * sine - r1
    upper, lower = np.hypot(px, py) - r1, np.hypot(px, py - length) - r2
    return np.where(along < 0.0, upper, np.where(along > length * cosine, lower, beside))
