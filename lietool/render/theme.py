"""Themes: what a colour's meaning looks like on white paper, on a dark slide and in print without colour.

Figures name colours by their meaning, as `style` lists them, and never learn which theme draws them: a name
is a `Tone`, computed colours are a `Mix` of names, and only the renderer asks a `Theme` for their values.
A hex string or an array that is none of `style`'s is the same in every theme.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np


class Tone(str):
    """A colour by its meaning: as text it is the book's value, and every other theme has one of its own.

    Parameters
    ----------
    book, dark, print : str
        ``#rrggbb`` on white paper, on a dark slide, and in a print that may be grey.
    """

    __slots__ = ("values",)
    values: Mapping[str, str]

    def __new__(cls, book: str, dark: str, print: str) -> "Tone":
        """Make the book's text, with the values of the themes beside it."""
        made = super().__new__(cls, book)
        made.values = MappingProxyType({"book": book, "dark": dark, "print": print})
        return made

    def __reduce__(self) -> tuple[type["Tone"], tuple[str, ...]]:
        """Let a picture travel to another process, or be copied, with the colours of all themes."""
        return Tone, tuple(self.values.values())


@dataclass(frozen=True, eq=False)
class Mix:
    """Colours that are mixed from others in linear light, one for each point; a theme gives them values.

    Parameters
    ----------
    tones : tuple of str
        Colours of `style`.
    weights : ndarray, shape (n, k)
        How much of each of the k tones goes into each colour; a row sums to 1.
    alpha : ndarray, shape (n,)
        Opacities.
    """

    tones: tuple[str, ...]
    weights: np.ndarray
    alpha: np.ndarray

    def __len__(self) -> int:
        return len(self.weights)

    def __getitem__(self, rows: Any) -> "Mix":
        """Return some of the colours, by a slice or an array of indices, as of an array."""
        return Mix(self.tones, self.weights[rows], self.alpha[rows])


Color = str | Mix | np.ndarray


def light(levels: np.ndarray) -> np.ndarray:
    """Return the linear light of levels of sRGB, 0 to 1; of the same shape."""
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True)
class Theme:
    """How a picture looks; which colour a meaning has is said by the tones of `style`.

    Parameters
    ----------
    name : str
        Under which a tone has its value.
    widths : float
        By how much every line is wider than the figure says.
    ambient : tuple of float
        Light on matte surfaces from below and from above.
    key : float
        Light on matte surfaces from the lamp.
    gloss : float
        Strength of the highlights.
    glass : tuple of float
        Opacity of glass where it is seen straight on and at its rim, and brightness there.
    veil : float
        Power by which opacities are taken: on a dark ground the eye sees more of a little light
        than it misses of it on white paper.
    shade : float
        The same for shadows, which take light away: of a dark ground there is little to take.
    """

    name: str
    widths: float = 1.0
    ambient: tuple[float, float] = (0.30, 0.55)
    key: float = 0.66
    gloss: float = 1.0
    glass: tuple[float, float, float, float] = (0.16, 0.74, 1.08, 0.80)
    veil: float = 1.0
    shade: float = 1.0

    def hex(self, color: str) -> str:
        """Return the value ``#rrggbb`` of a colour; ValueError if it has none."""
        value = color.values[self.name] if isinstance(color, Tone) else color
        if not isinstance(value, str) or not re.fullmatch("#[0-9A-Fa-f]{6}", value):
            raise ValueError(f"theme.hex: color must be #rrggbb; got {color!r}. Take one of style's own")
        return value

    def srgb(self, color: str) -> np.ndarray:
        """Return a colour as its three levels, 0 to 255; shape (3,)."""
        value = self.hex(color)
        return np.array([int(value[i : i + 2], 16) for i in (1, 3, 5)], float)

    def linear(self, color: str, alpha: float = 1.0) -> np.ndarray:
        """Return a colour as linear red, green, blue and the opacity, not premultiplied; shape (4,)."""
        return np.append(light(self.srgb(color) / 255.0), alpha)

    def rgba(self, color: Color, n: int, alpha: float = 1.0, *, shadow: bool = False) -> np.ndarray:
        """Return the colours of `n` points as linear RGBA, their opacities times `alpha`; shape (n, 4)."""
        if isinstance(color, Mix):
            rows = color.weights @ np.array([self.linear(tone) for tone in color.tones])
            rows[:, 3] = color.alpha
        else:
            rows = self.linear(color) if isinstance(color, str) else np.asarray(color, float)
        rows = np.broadcast_to(rows, (n, 4)).copy()
        rows[:, 3] = (alpha * rows[:, 3]) ** (self.shade if shadow else self.veil)
        return rows


BOOK = Theme("book")
DARK = Theme("dark", ambient=(0.36, 0.60), gloss=0.35, glass=(0.06, 0.60, 1.00, 1.05), veil=1.6, shade=0.5)
PRINT = Theme("print", widths=1.4, ambient=(0.42, 0.64), key=0.60)
THEMES = {theme.name: theme for theme in (BOOK, DARK, PRINT)}
