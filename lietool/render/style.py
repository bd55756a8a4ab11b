"""Colours, widths and type sizes, named by what they mean; nothing else in the project knows a colour.

Every colour is an sRGB hex string.  The three frame colours keep apart for the
common forms of colour blindness because they differ in lightness (red in the
middle, green light, blue dark), so that they keep apart in grey too; type in
their colours takes the darker `AXES_TEXT`.  Widths and sizes are in page units: the page of a
picture is 1200 x 900 of them unless it says otherwise.
"""

import re

import numpy as np

PAPER = "#ffffff"
INK = "#2b2f36"
MUTED = "#6b7280"
RULE = "#c9cdd4"
BAND = "#eef2f7"

ARC = "#e0860b"
ARC_TEXT = "#94560a"
ALGEBRA = "#2b66b1"
ALGEBRA_TEXT = "#1f4d8a"
WRONG = "#c8372d"
RIGHT = "#2b66b1"
MARK = "#c8372d"

BEFORE, BEFORE_EDGE = "#e3e7ed", "#8d97a6"
BETWEEN, BETWEEN_EDGE = "#fdeccf", "#c58a35"
AFTER, AFTER_EDGE = "#f0b35a", "#94560a"
ROUTE_1, ROUTE_1_TEXT = "#17736d", "#0f5c57"
ROUTE_2, ROUTE_2_TEXT = "#b565b0", "#8a3f86"
GROUP, GROUP_TEXT = ARC, ARC_TEXT

AXIS_X = "#cc3b30"
AXIS_Y = "#69b78d"
AXIS_Z = "#21508f"
AXES = (AXIS_X, AXIS_Y, AXIS_Z)
AXES_TEXT = ("#b02f26", "#2c7a52", "#21508f")
GREYS = ("#3a3f47", "#8d939d", "#d9dde3")

GLASS = "#b4cdea"
GLASS_EDGE = "#4a6a94"
BONE = "#f3f1ea"
SHELLS = ("#7aa6d8", "#f0b35a", "#6fb58f")
SHELL_FILLS = ("#b3cdee", "#fadcae", "#b9dfca")
SHELLS_TEXT = ("#2b5f9e", "#94560a", "#26704a")

CURVE = 3.2
HAIR = 1.05
THIN = 1.6
EDGE = 1.9
GRATICULE_ALPHA = 0.42

# At a column of 8.5 cm, where a page unit is 0.07 mm, the smallest type is 6 points.
SMALL_TEXT = 30.0
TEXT = 33.0
TITLE_TEXT = 35.0


def srgb(color: str) -> np.ndarray:
    """Return a hex colour as its three levels, 0 to 255.

    Parameters
    ----------
    color : str
        ``#rrggbb``.

    Returns
    -------
    ndarray, shape (3,)

    Raises
    ------
    ValueError
        If it is not of that form.
    """
    if not isinstance(color, str) or not re.fullmatch("#[0-9A-Fa-f]{6}", color):
        raise ValueError(f"style.srgb: color must be #rrggbb; got {color!r}. Take one of style's own")
    return np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)], float)


def linear(color: str, alpha: float = 1.0) -> np.ndarray:
    """Return an sRGB hex colour as linear RGBA.

    Parameters
    ----------
    color : str
        ``#rrggbb``.
    alpha : float
        Opacity, 0 to 1.

    Returns
    -------
    ndarray, shape (4,)
        Linear red, green, blue and the opacity (not premultiplied).

    Raises
    ------
    ValueError
        If the colour is not of that form.
    """
    levels = srgb(color) / 255.0
    rgb = np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
    return np.append(rgb, alpha)


def ramp(t: np.ndarray, colors: tuple[str, ...] = (AXIS_Z, "#f2e3c0", "#d96b2b")) -> np.ndarray:
    """Return linear RGBA along a ramp of colours.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Positions, 0 to 1.
    colors : tuple of str
        The stops, equally spaced; blue, cream, orange unless given.

    Returns
    -------
    ndarray, shape (n, 4)
    """
    stops = np.array([linear(c) for c in colors])
    where = np.linspace(0.0, 1.0, len(stops))
    return np.stack([np.interp(t, where, stops[:, i]) for i in range(4)], axis=-1)
