"""Colours, widths and type sizes, named by what they mean; nothing else in the project knows a colour.

A colour is a `Tone`: its value on the book's white paper, on a dark slide, and in a
print that may lose its hues, where lightness alone has to tell things apart.  The
three frame colours keep apart for the common forms of colour blindness because they
differ in lightness (red in the middle, green light, blue dark), so that they keep
apart in grey too; type in their colours takes the darker `AXES_TEXT`.  Widths and
sizes are in page units: the page of a picture is 1200 x 900 of them unless it says
otherwise.
"""

import numpy as np
from numpy.typing import ArrayLike

from lietool.render.theme import Mix, Tone

#             book       dark       print
PAPER = Tone("#ffffff", "#171a20", "#ffffff")
INK = Tone("#2b2f36", "#e6e8ec", "#000000")
MUTED = Tone("#6b7280", "#a3abb8", "#555555")
RULE = Tone("#c9cdd4", "#3d444f", "#b4b4b4")
BAND = Tone("#eef2f7", "#222730", "#eeeeee")

ARC = Tone("#e0860b", "#f0a03a", "#c47a00")
ARC_TEXT = Tone("#94560a", "#f5b862", "#7a4600")
ALGEBRA = Tone("#2b66b1", "#6ea8f0", "#12386f")
ALGEBRA_TEXT = Tone("#1f4d8a", "#93bff5", "#0d2a54")
WRONG = Tone("#c8372d", "#f2695c", "#c8372d")
RIGHT = Tone("#2b66b1", "#6ea8f0", "#12386f")
MARK = Tone("#c8372d", "#f2695c", "#c8372d")

BEFORE = Tone("#e3e7ed", "#2f353f", "#ebebeb")
BEFORE_EDGE = Tone("#8d97a6", "#8591a3", "#8a8a8a")
BETWEEN = Tone("#fdeccf", "#51422a", "#d8ccb4")
BETWEEN_EDGE = Tone("#c58a35", "#d39a45", "#7d6a48")
AFTER = Tone("#f0b35a", "#b97722", "#e09a3c")
AFTER_EDGE = Tone("#94560a", "#f7cf8f", "#4a2b00")
ROUTE_1 = Tone("#17736d", "#3fc4b8", "#0c4f4a")
ROUTE_1_TEXT = Tone("#0f5c57", "#5fd6cb", "#0a423e")
ROUTE_2 = Tone("#b565b0", "#c77fd8", "#b974b4")
ROUTE_2_TEXT = Tone("#8a3f86", "#dba3e6", "#7a3576")
GROUP, GROUP_TEXT = ARC, ARC_TEXT

AXIS_X = Tone("#cc3b30", "#f58e82", "#c8372d")
AXIS_Y = Tone("#69b78d", "#aee8c6", "#48a075")
AXIS_Z = Tone("#21508f", "#4f86d8", "#143a70")
AXES = (AXIS_X, AXIS_Y, AXIS_Z)
AXES_TEXT = (
    Tone("#b02f26", "#f8a59b", "#a3271d"),
    Tone("#2c7a52", "#a5e0bd", "#22704a"),
    Tone("#21508f", "#7fb0f2", "#143a70"),
)
GREYS = (
    Tone("#3a3f47", "#d3d7de", "#333333"),
    Tone("#8d939d", "#8d949f", "#5e5e5e"),
    Tone("#d9dde3", "#4b515c", "#d0d0d0"),
)

GLASS = Tone("#b4cdea", "#5f86bd", "#c9d3de")
GLASS_EDGE = Tone("#4a6a94", "#8fb0dc", "#33455c")
SHADOW = Tone("#2b2f36", "#000000", "#000000")
EYE_WHITE = Tone("#ffffff", "#f4f5f7", "#ffffff")
PUPIL = Tone("#2b2f36", "#17191d", "#000000")
BONE = Tone("#f3f1ea", "#6d7480", "#f3f1ea")
SHELLS = (
    Tone("#7aa6d8", "#4f7fbd", "#6f9acd"),
    Tone("#f0b35a", "#c98a35", "#f6cf8d"),
    Tone("#6fb58f", "#4d9a72", "#2f7a55"),
)
SHELL_FILLS = (
    Tone("#b3cdee", "#2f4a70", "#92aeda"),
    Tone("#fadcae", "#6b4d22", "#fdf0d8"),
    Tone("#b9dfca", "#2c5a43", "#b6d6c4"),
)
SHELLS_TEXT = (
    Tone("#2b5f9e", "#8fbdf2", "#1d4476"),
    Tone("#94560a", "#f0bb70", "#7a4600"),
    Tone("#26704a", "#86d3aa", "#1b5436"),
)
RAMP = (AXIS_Z, Tone("#f2e3c0", "#f2e3c0", "#9a938a"), Tone("#d96b2b", "#e57a3a", "#f5d9b0"))

CURVE = 3.2
HAIR = 1.05
THIN = 1.6
EDGE = 1.9
GRATICULE_ALPHA = 0.42

# At a column of 8.5 cm, where a page unit is 0.07 mm, the smallest type is 6 points.
SMALL_TEXT = 30.0
TEXT = 33.0
TITLE_TEXT = 35.0


def ramp(t: ArrayLike, tones: tuple[str, ...] = RAMP) -> Mix:
    """Return colours along a ramp, mixed in linear light.

    Parameters
    ----------
    t : array_like, shape (n,)
        Positions, 0 to 1.
    tones : tuple of str
        The stops, equally spaced; blue, cream, orange unless given.

    Returns
    -------
    Mix
        n colours.
    """
    t = np.asarray(t, float).reshape(-1)
    where = np.linspace(0.0, 1.0, len(tones))
    hats = [np.interp(t, where, row) for row in np.eye(len(tones))]
    return Mix(tones, np.stack(hats, axis=-1), np.ones(len(t)))


def fade(color: str | Mix, alpha: ArrayLike) -> Mix:
    """Return a colour, or several, with other opacities.

    Parameters
    ----------
    color : str or Mix
    alpha : array_like, shape () or (n,)
        Opacity of each point, 0 to 1; those of several colours are multiplied by it.

    Returns
    -------
    Mix
        n colours; one, which serves for any number of points, where `alpha` is a number.
    """
    alpha = np.atleast_1d(np.asarray(alpha, float))
    if isinstance(color, Mix):
        return Mix(color.tones, color.weights, color.alpha * alpha)
    return Mix((color,), np.ones((len(alpha), 1)), alpha)


def stages(count: int) -> tuple[tuple[str, str], ...]:
    """Return fill and edge for shapes from first to last: before, on the way, after."""
    between = ((BETWEEN, BETWEEN_EDGE),) * max(count - 2, 0)
    return ((BEFORE, BEFORE_EDGE), *between, (AFTER, AFTER_EDGE))[:count]
