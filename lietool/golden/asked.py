"""What a test asks for beside a picture: a name, a tolerance with its reason, a mask."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lietool.golden import verdict
from lietool.golden.place import Place

_NAME = re.compile(r"[^/\\:*?\"<>|\x00-\x1f]+(/[^/\\:*?\"<>|\x00-\x1f]+)*")


@dataclass(frozen=True)
class Tolerance:
    """How far one picture may be from its golden, and why it may be farther than others."""

    limits: verdict.Limits = field(default_factory=verdict.Limits)
    because: str = ""


def tolerance(because: str, **limits: float | None) -> Tolerance:
    """Return the tolerance of a picture.

    Parameters
    ----------
    because : str
        Why it is another than the usual one.
    **limits : float, optional
        Fields of `verdict.Limits`; None is the usual one.

    Raises
    ------
    ValueError
        If one is given without a reason or a reason without one, or it is no number that can be reached.
    """
    given = {name: value for name, value in limits.items() if value is not None}
    if given and not because.strip():
        raise ValueError(
            f"lietool_golden.check: because must say why {', '.join(given)} differ from the usual; got none. "
            "Write the reason"
        )
    if because.strip() and not given:
        raise ValueError(
            "lietool_golden.check: because must stand beside a tolerance; got none. Leave it out, or give "
            "pixels, delta_e, lowpass or relative"
        )
    for name, value in given.items():
        if not (np.isfinite(value) and value >= 0):
            raise ValueError(f"lietool_golden.check: {name} must be finite and not negative; got {value}")
    return Tolerance(verdict.Limits(**given), because.strip())  # type: ignore[arg-type]


def place(root: Path, name: str, renderer: str | None) -> Place:
    """Return where the golden of a name lies.

    Parameters
    ----------
    root : Path
        The folder of all goldens.
    name : str
        Words with slashes between them; the last names the file.
    renderer : str, optional
        A class of renderers that draws other pixels than the rest and has a golden of its own.

    Raises
    ------
    ValueError
        If the name is no name of a file below the folder.
    """
    for what, word in (("name", name), ("renderer", renderer)):
        if word is None:
            continue
        parts = word.split("/")
        if not _NAME.fullmatch(word) or {".", ".."} & set(parts) or any(p != p.strip(" ") for p in parts):
            raise ValueError(
                f"lietool_golden.check: {what} must be words with / between them, none of them . or .. and "
                f'without any of \\ : * ? " < > |; got {word!r}. Choose another'
            )
    above, _, last = name.rpartition("/")
    return Place(root, above, last + (f"@{renderer.replace('/', '-')}" if renderer else ""))


def check_mask(mask: np.ndarray | None, shown: np.ndarray) -> None:
    """Refuse a mask that is none for this picture (h, w, 3), or leaves nothing of it to compare."""
    if mask is None:
        return
    got = np.asarray(mask)
    if got.dtype != np.bool_ or got.shape != shown.shape[:2]:
        raise ValueError(
            f"lietool_golden.check: mask must be bool of shape {shown.shape[:2]}, as the picture; got "
            f"{got.dtype} of shape {got.shape}. True is where pixels may be anything"
        )
    if got.all():
        raise ValueError("lietool_golden.check: mask must leave something to compare; got True everywhere")
