"""Tables of a file of probes: the values in them, and the line that says which is wrong."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from lietool.lie import checks
from lietool.mesh.files import Place

Array = NDArray[np.float64]

_WORDS = {(): "a number", (3,): "a list of 3 numbers", (3, 3): "3 rows of 3 numbers", (4, 4): "4 rows of 4"}


@dataclass(frozen=True)
class Table:
    """A table of a file, and what it is called in messages."""

    place: Place
    label: str
    data: dict[str, Any]

    def fail(self, key: str, must: str, got: str, remedy: str = "") -> NoReturn:
        """Raise the one-line ValueError that names the file, the probe and the key."""
        at = ", ".join(filter(None, [str(self.place.path), self.label, key]))
        raise ValueError(
            f"{self.place.where}: {at} must be {must}; got {got}.{' ' + remedy if remedy else ''}"
        )

    def only(self, known: Collection[str]) -> None:
        """Refuse keys that mean nothing."""
        for key in self.data:
            if key not in known:
                self.fail("", f"a table of {', '.join(known)}", f"the key {key!r}")

    def table(self, key: str, value: object, label: str) -> "Table":
        """Return a value as a table."""
        if not isinstance(value, dict):
            self.fail(key, "a table", shown(value))
        return Table(self.place, label, value)

    def tables(self, key: str, wanted: str) -> list[object]:
        """Return the list of tables under a key, at least one."""
        value = self.data.get(key)
        if not isinstance(value, list) or not value:
            self.fail("" if value is None else key, wanted, "none" if not value else shown(value))
        return value

    def numbers(self, key: str, *shapes: tuple[int, ...]) -> Array:
        """Return the numbers under a key, of one of the shapes."""
        value = self.data[key]
        must = " or ".join(_WORDS[shape] for shape in shapes)
        try:
            a = np.array(value, dtype=object)
            good = all(isinstance(x, int | float) and not isinstance(x, bool) for x in a.ravel())
            a = a.astype(np.float64) if good and a.shape in shapes else None
        except (ValueError, OverflowError):
            a = None
        if a is None:
            self.fail(key, must, shown(value))
        if not np.all(np.abs(a) <= checks.LARGEST):
            limit = f"at most {checks.LARGEST:g} in size" if np.isfinite(a).all() else "finite"
            self.fail(key, f"{limit}, {must}", shown(value))
        return a

    def axis(self, key: str) -> Array:
        """Return the unit vector along the vector under a key."""
        a = self.numbers(key, (3,))
        size = np.max(np.abs(a))
        if not size > 1.0 / checks.LARGEST:
            self.fail(key, "an axis different from 0", shown(self.data[key]))
        a = a / size
        return a / np.linalg.norm(a)

    def frame(self, key: str) -> Array:
        """Return the affine 4 x 4 matrix under a key."""
        a = self.numbers(key, (4, 4))
        if not np.array_equal(a[3], [0.0, 0.0, 0.0, 1.0]):
            self.fail(key, "an affine matrix, last row 0 0 0 1", f"last row {a[3].tolist()}")
        return a


def named(top: Table, kind: str, wanted: str, names: list[str]) -> Iterator[Table]:
    """Yield the probes or handles of a file, and append the name of each, its number where it has none."""
    for i, value in enumerate(top.tables(kind, wanted)):
        label = f"{kind} {i + 1}"
        entry = top.table(label, value, label)
        name = entry.data.get("name", str(i + 1))
        if not isinstance(name, str) or not name:
            entry.fail("name", "a word", shown(name))
        if name in names:
            entry.fail("name", "another than those before", shown(name))
        names.append(name)
        yield Table(top.place, label if name == str(i + 1) else f"{label} ({name})", entry.data)


def shown(value: object) -> str:
    """Return a value as it is shown in a message, on one line and not too long."""
    if isinstance(value, dict):
        return "a table"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
