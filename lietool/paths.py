"""Where the figures, the exercises and the goldens lie, in a checkout and in a wheel.

In a checkout they are the folders ``figures/``, ``exercises/`` and ``golden/``
beside the package; in a wheel they travel inside it as ``lietool/figures``,
``lietool/exercises`` and ``lietool/goldens``.  All are found from this file alone, so that an editable
install can never read a stale copy.
"""

from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


def _beside_or_inside(inside: str, beside: str) -> Path:
    packaged = PACKAGE / inside
    return packaged if packaged.is_dir() else PACKAGE.parent / beside


FIGURES = _beside_or_inside("figures", "figures")
EXERCISES = _beside_or_inside("exercises", "exercises")
GOLDEN = _beside_or_inside("goldens", "golden")
