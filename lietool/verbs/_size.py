"""Sizes as they are said on the command line: in pixels, or as lengths with dots per inch."""

import math
import re
from dataclasses import dataclass

from lietool.figure import quoted

# Repeated from `render.draw` so that completion need not load OpenGL; a test compares them.
LARGEST = 20000
DPI = 300.0
_MOST_DPI = 4800.0
_INCHES = {"in": 1.0, "cm": 1.0 / 2.54, "mm": 0.1 / 2.54, "pt": 1.0 / 72.0}
# No sheet of a PDF may be longer.
_LONGEST = 200.0
# A page unit is a tenth of a millimetre unless a size is given: type is 8.5 to 10 points then.
_UNIT = 0.1 * _INCHES["mm"]
_LENGTH = r"([0-9]+\.?[0-9]*|\.[0-9]+)(in|cm|mm|pt)"
_WANTED = "width x height in pixels, such as 1200x900, or a width or both in cm, mm, in or pt, such as 8.5cm"


@dataclass(frozen=True)
class Size:
    """Width and height in pixels or, where it is a length, in inches; its height may follow from the page.

    Parameters
    ----------
    width : float
    height : float, optional
    is_length : bool
    text : str
        As it was said.
    dpi : float
        Dots per inch of a length.
    """

    width: float
    height: float | None
    is_length: bool
    text: str
    dpi: float = DPI

    def inches(self, page: tuple[int, int]) -> tuple[float, float]:
        """Return width and height of a length, for a picture whose page is so many units."""
        height = self.width * page[1] / page[0] if self.height is None else self.height
        return self.width, height

    def pixels(self, page: tuple[int, int]) -> tuple[int, int]:
        """Return width and height in pixels, for a picture whose page is so many units.

        Raises
        ------
        ValueError
            If they are none at all, or too many.
        """
        if not self.is_length:
            return round(self.width), round(self.height or 0.0)
        width, height = (round(self.dpi * side) for side in self.inches(page))
        if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
            raise ValueError(
                f"--size must be 1 to {LARGEST} pixels each way; got {self.text} at {self.dpi:g} dots per "
                f"inch, which is {width} x {height}. Change --size or --dpi"
            )
        return width, height


def parse(text: str) -> Size:
    """Read a size: ``1200x900``, ``8.5cm``, ``85mmx60mm``.

    Raises
    ------
    ValueError
        If the text is none, or it is too small or large: ``"must be ...; got ..."``.
    """
    if match := re.fullmatch(r"([0-9]+)[xX]([0-9]+)", text):
        # A float takes any number of digits; an int refuses more than some thousands, in words of its own.
        width, height = float(match[1]), float(match[2])
        if 1 <= width <= LARGEST and 1 <= height <= LARGEST:
            return Size(width, height, False, text)
        raise ValueError(
            f"must be 1 to {LARGEST} pixels each way; got {quoted(text)}. Write for example 1200x900"
        )
    match = re.fullmatch(f"{_LENGTH}(?:[xX]{_LENGTH})?", text, re.IGNORECASE)
    if not match:
        raise ValueError(f"must be {_WANTED}; got {quoted(text)}")
    pairs = (match.group(1, 2), match.group(3, 4))
    sides = [float(number) * _INCHES[unit.lower()] for number, unit in pairs if unit]
    if not all(0.0 < side <= _LONGEST for side in sides):
        raise ValueError(
            f"must be more than 0 and up to {_LONGEST:g}in; got {quoted(text)}. Write for example 8.5cm"
        )
    return Size(sides[0], sides[1] if len(sides) > 1 else None, True, text)


def dpi(text: str) -> float:
    """Read dots per inch.

    Raises
    ------
    ValueError
        If the text is no number, or out of range: ``"must be ...; got ..."``.
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 1.0 <= value <= _MOST_DPI:
        raise ValueError(
            f"must be dots per inch, 1 to {_MOST_DPI:g}; got {quoted(text)}. Write for example 300"
        )
    return value


def natural(page: tuple[int, int]) -> tuple[float, float]:
    """Return width and height in inches of a page that nobody gave a size."""
    return _UNIT * page[0], _UNIT * page[1]
