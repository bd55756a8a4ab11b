"""A function of the library that a figure shows, as an argument of the figure: another may be passed in."""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Library:
    """A function of the library by its name, imported when it is first called.

    It is the default of a keyword-only argument of a figure, for which `Figure.draw_with` takes another
    function: one that a student has written.  The declaration of a figure needs no numpy by that.

    Parameters
    ----------
    name : str
        Dotted, such as "lietool.lie.so3.exp".
    """

    name: str

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the function."""
        return self.function(*args, **options)

    @property
    def function(self) -> Callable[..., Any]:
        """The function itself; raises ImportError or AttributeError where there is none of that name."""
        module, _, attribute = self.name.rpartition(".")
        return getattr(importlib.import_module(module), attribute)
