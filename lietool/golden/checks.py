"""Goldens of any project's tests: what one test asks for, compared or written, and all of a run together."""

import platform
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from lietool.golden import compare, compare_numbers, explain, folder, history, pixels, report, store, verdict
from lietool.golden import picture as picture_
from lietool.golden.asked import Tolerance, check_mask, place
from lietool.golden.place import Place

UPDATES = ("missing", "changed", "all")


class MismatchError(AssertionError):
    """A picture or its numbers are not as their golden, or there is none."""


@dataclass(frozen=True)
class Settings:
    """What holds for a whole run: where goldens lie, what may be written, where failures are left."""

    root: Path
    left: Path
    update: str = ""
    reporting: bool = False


@dataclass(frozen=True, eq=False)
class Record:
    """What came of one check, ready to travel from one process to another."""

    name: str
    test: str
    word: str
    passes: bool
    written: str = ""
    messages: tuple[str, ...] = ()
    left: tuple[str, ...] = ()
    numbers: Mapping[str, float | int] = field(default_factory=dict)
    entry: report.Entry | None = None

    @property
    def said(self) -> str:
        """The verdict in one line, for a log."""
        return "; ".join((self.word, *self.messages)) + (f"; written: {self.written}" if self.written else "")

    @property
    def see(self) -> tuple[str, ...]:
        """Where a reader finds the pictures of a failure."""
        return (f"see {', '.join(self.left)}",) if self.left else ()

    def plain(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            key: list(value) if isinstance(value, tuple) else dict(value) if key == "numbers" else value
            for key, value in vars(self).items()
            if key != "entry"
        }


def check(
    settings: Settings,
    test: str,
    image: Any,
    *,
    name: str,
    numbers: Mapping[str, object] | None = None,
    mask: np.ndarray | None = None,
    ignore: Sequence[tuple[int, int, int, int]] = (),
    renderer: str | None = None,
    tolerated: Tolerance | None = None,
) -> Record:
    """Compare a picture and its numbers with their golden, or write it where that was asked for.

    Parameters
    ----------
    settings : Settings
        Of the run.
    test : str
        Who asks.
    image : object
        As `pixels.of` takes it.
    name : str
        Which golden.
    numbers : Mapping[str, object], optional
        What is shown in numbers.
    mask : (h, w) bool, optional
        True where pixels may be anything.
    ignore : sequence of (x0, y0, x1, y1)
        Boxes where pixels may be anything.
    renderer : str, optional
        As of `asked.place`.
    tolerated : Tolerance, optional
        As `asked.tolerance` makes it.

    Returns
    -------
    Record
        It passes or not; nothing is raised for a difference.
    """
    tolerated = tolerated or Tolerance()
    where = place(settings.root, name, renderer)
    shown = pixels.of(image)
    now = _provenance(name, test, renderer)
    golden, found = _compared(where, shown, numbers or {}, tolerated.limits, mask, ignore)
    written = _to_write(settings.update, found, golden)
    if written:
        _write(where, found.shown, numbers or {}, now, golden, written)
    left = () if written else _left(settings, where, found, golden)
    entry = None
    if settings.reporting:
        entry = report.entry(
            found.key(where),
            expected=None if golden is None else golden.image,
            actual=found.shown,
            title=test,
            word=found.word,
            messages=found.messages,
            comparison=found.comparison,
            before=None if golden is None else golden.numbers,
            after=numbers or {},
            differences=found.differences,
            relative=tolerated.limits.relative,
            because=tolerated.because,
            provenance=({} if golden is None else golden.provenance, now),
        )
    return Record(
        found.key(where),
        test,
        found.word,
        bool(written) or not found.messages,
        written,
        found.messages,
        left,
        found.measured,
        entry,
    )


@dataclass(frozen=True, eq=False)
class _Found:
    """What a comparison gave; `shown` is the picture, with the golden's pixels where any will do."""

    shown: np.ndarray
    messages: tuple[str, ...] = ()
    word: str = "equal"
    comparison: compare.Comparison | None = None
    differences: tuple[compare_numbers.Difference, ...] = ()

    @staticmethod
    def key(where: Place) -> str:
        return where.png.relative_to(where.root).with_suffix("").as_posix()

    @property
    def measured(self) -> dict[str, float | int]:
        c = self.comparison
        if c is None or not c.same_size:
            return {}
        return {"differing": c.differing, "over": c.over, "crowd": c.crowd, "lowpass": c.lowpass}


def _compared(
    where: Place,
    shown: np.ndarray,
    numbers: Mapping[str, object],
    limits: verdict.Limits,
    mask: np.ndarray | None,
    ignore: Sequence[tuple[int, int, int, int]],
) -> tuple[store.Golden | None, _Found]:
    check_mask(mask, shown)
    try:
        golden = store.read(where)
    except store.GoldenError as error:
        return None, _Found(shown, (_unreadable(error),), error.kind)
    if golden.image.shape == shown.shape:
        shown = picture_.ignoring(golden.image, shown, ignore)
        if mask is not None:
            shown[mask] = golden.image[mask]
    found = compare.images(
        golden.image, shown, pixels=limits.pixels, delta_e=limits.delta_e, lowpass=limits.lowpass
    )
    differences = tuple(compare_numbers.numbers(golden.numbers, numbers, limits.relative))
    messages, words = [], []
    if not found.same_size:
        (w, h), (gw, gh) = found.actual_size, found.expected_size
        messages.append(f"the picture is {w}x{h}, its golden {gw}x{gh}")
        words.append("size")
    elif not found.passes:
        messages.append(f"picture differs: {found.says}")
        words.append("picture")
    if differences:
        more = f"; and {len(differences) - 3} entries more" if len(differences) > 3 else ""
        messages.append(f"numbers differ: {'; '.join(map(str, differences[:3]))}{more}")
        words.append("numbers")
    word = ", ".join(words) or ("equal" if found.equal else "passes")
    return golden, _Found(shown, tuple(messages), word, found, differences)


def _unreadable(error: store.GoldenError) -> str:
    remedy = "Restore it from version control, or write it again with --golden-update=changed"
    if error.kind == "missing":
        remedy = "Look at the picture; if it is right, write it with --golden-update=missing"
    return f"{error}. {remedy}"


def _to_write(update: str, found: _Found, golden: store.Golden | None) -> str:
    """What was asked to be written of what was found, in a word; empty where nothing was."""
    if not update:
        return ""
    if found.word == "missing":
        return "new"
    if update == "missing":
        return ""
    if golden is None:
        return f"whole again, was {found.word}"
    same = found.word == "equal" and not found.differences
    if found.messages or (update == "all" and not same):
        return found.word
    return ""


def _write(
    where: Place,
    shown: np.ndarray,
    numbers: Mapping[str, object],
    now: Mapping[str, str],
    golden: store.Golden | None,
    what: str,
) -> None:
    before = {} if golden is None else golden.provenance
    with folder.lock(where.root):
        told = {**now, history.KEY: history.extended(before, now, what)}
        store.write(where, shown, numbers, labels={}, label_keys=(), provenance=told)


def _left(settings: Settings, where: Place, found: _Found, golden: store.Golden | None) -> tuple[str, ...]:
    """Leave pictures of a failure where a reader finds them, and none of one that is mended."""
    pictures: dict[str, np.ndarray | None] = {}
    if found.messages:
        pictures["actual"] = found.shown
        pictures["expected"] = None if golden is None else golden.image
        if found.comparison is not None and found.comparison.same_size and golden is not None:
            pictures["difference"] = explain.amplified(golden.image, found.shown)
    return tuple(map(str, explain.leave(settings.left, found.key(where), **pictures)))


def _provenance(name: str, test: str, renderer: str | None) -> dict[str, str]:
    versions = {}
    for package in ("numpy", "pillow", "matplotlib", "moderngl", "lietool"):
        try:
            versions[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return {
        "plate": name,
        "test": test,
        "date": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "renderer": renderer or "any",
        "system": platform.platform(),
        **versions,
        "reason": f"written by {test}",
    }


def unused(root: Path, used: Collection[str]) -> list[str]:
    """List the goldens that no test has asked for.

    Parameters
    ----------
    root : Path
        The folder of all goldens.
    used : collection of str
        Names of records.

    Returns
    -------
    list of str
        Names, sorted.
    """
    there = (path.relative_to(root).with_suffix("").as_posix() for path in root.rglob("*.png"))
    return sorted(name for name in there if name not in used)


def twice(records: Iterable[Record]) -> list[str]:
    """List the names that several tests have used, with who they are."""
    tests: dict[str, list[str]] = {}
    for record in records:
        tests.setdefault(record.name, []).append(record.test)
    return [f"{name}: {', '.join(who)}" for name, who in tests.items() if len(who) > 1]
