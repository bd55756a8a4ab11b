"""Two sets of numbers: do they agree to what rounding and another processor may change."""

from dataclasses import dataclass

import numpy as np

from lietool.golden.numbers import KINDS, Numbers, array_of, leaves

RELATIVE = 1e-9
# An array that is zero but for rounding has no scale of its own: below this one, 1e-9 max|b| would compare
# residues. Figures live at unit size, so differences up to 1e-9 * 1e-3 = 1e-12 are never shown.
SMALLEST_SCALE = 1e-3


@dataclass(frozen=True)
class Difference:
    """One entry that is not as expected; of an array, its worst element.

    `kind` is "missing", "extra", "kind" (other type), "shape" or "value";
    `by` and `allowed` are None unless floats differ, `count` says how many elements differ.
    """

    entry: str
    kind: str
    expected: object = None
    got: object = None
    index: tuple[int, ...] = ()
    by: float | None = None
    allowed: float | None = None
    count: int = 1

    def __str__(self) -> str:
        """Say it in one line."""
        if self.kind == "missing":
            return f"{self.entry}: missing"
        if self.kind == "extra":
            return f"{self.entry}: not in the golden"
        if self.kind in ("shape", "kind"):
            return f"{self.entry}: {self.kind} was {self.expected}, is {self.got}"
        where = self.entry + (f"[{', '.join(map(str, self.index))}]" if self.index else "")
        by = "" if self.by is None else f", off by {self.by:.2g} where {self.allowed:.2g} is allowed"
        others = f" ({self.count} elements differ)" if self.count > 1 else ""
        return f"{where}: expected {self.expected!r}, got {self.got!r}{by}{others}"


def numbers(expected: Numbers, got: Numbers, relative: float = RELATIVE) -> list[Difference]:
    """Compare numbers with the golden's.

    Floats may differ by `relative` times the largest magnitude that is
    expected in their array, or times 1e-3 if that is larger; all else must be
    the same, and so must NaN and infinities be in the same places.

    Parameters
    ----------
    expected, got : Mapping[str, object]
        As for `dumps`.
    relative : float
        The part of max|expected| that a float may be off.

    Returns
    -------
    list of Difference
        In the order of `expected`, then what is extra; empty when they agree.
    """
    before, after = dict(leaves(expected)), dict(leaves(got))
    found = []
    for entry, value in before.items():
        if entry not in after:
            found.append(Difference(entry, "missing"))
            continue
        difference = _compare(entry, array_of(entry, value), array_of(entry, after[entry]), relative)
        if difference:
            found.append(difference)
    return found + [Difference(entry, "extra") for entry in after if entry not in before]


def _compare(entry: str, a: np.ndarray, b: np.ndarray, relative: float) -> Difference | None:
    kinds = KINDS[a.dtype.kind], KINDS[b.dtype.kind]
    if kinds[0] != kinds[1]:
        return Difference(entry, "kind", *kinds)
    if a.shape != b.shape:
        return Difference(entry, "shape", a.shape, b.shape)
    if a.dtype.kind != "f":
        wrong = a != b
        if not wrong.any():
            return None
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        return Difference(entry, "value", a[index].item(), b[index].item(), index, count=int(wrong.sum()))
    a, b = a.astype(np.float64), b.astype(np.float64)
    finite = np.isfinite(a) & np.isfinite(b)
    scale = max(float(np.abs(a[np.isfinite(a)]).max(initial=0.0)), SMALLEST_SCALE)
    # Where one of them is not finite, the same is right and all else infinitely wrong.
    off = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.inf)
    np.subtract(b, a, out=off, where=finite)
    off = np.abs(off)
    wrong = off > relative * scale
    if not wrong.any():
        return None
    index = tuple(int(i) for i in np.unravel_index(int(off.argmax()), off.shape))
    value = a[index].item(), b[index].item()
    return Difference(entry, "value", *value, index, float(off[index]), relative * scale, int(wrong.sum()))
