"""`lietool figures accept --from review.json`: what was marked in a report becomes golden, nothing else."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from lietool.golden import report
from lietool.verbs import _figures_accept, _studio, _table

_KEYS = ("plate", "reason", "picture", "numbers")
_MOST = 10_000_000
_FORM = "the review.json that the page of `lietool figures report` hands out"


@dataclass(frozen=True)
class Mark:
    """One plate that was found right: why, and the SHA-256 of the picture and the numbers that were seen."""

    plate: str
    reason: str
    picture: str
    numbers: str


class Reviewed(_studio.Studio):
    """The renderer of a review: it paints every plate once and hands out what was checked."""

    def __init__(self, studio: _studio.Studio, marks: Mapping[str, Mark]) -> None:
        self._studio, self._marks = studio, marks
        self._painted: dict[str, _studio.Painted] = {}

    @cached_property
    def info(self) -> Mapping[str, Any]:
        """What renders."""
        return self._studio.info

    @cached_property
    def trouble(self) -> str:
        """Why pictures cannot be compared here."""
        return self._studio.trouble

    def check(self, items: Sequence[_studio.Item]) -> None:
        """Paint all plates, and stop with 5 if one is not what was reviewed; nothing is written before."""
        for item in _table.progress(items, "checking"):
            painted, mark = self._studio.paint(item), self._marks[item.id]
            now = report.picture_digest(painted.image), report.numbers_digest(painted.numbers)
            parts = zip(("picture", "numbers"), now, (mark.picture, mark.numbers), strict=True)
            if other := [part for part, sha, seen in parts if sha != seen]:
                differ = " and ".join(other)
                raise _studio.Stop(
                    5,
                    f"{item.id}: {differ} drawn now {'is' if other == ['picture'] else 'are'} not what was "
                    "reviewed. Make the report again on this machine and look again; nothing was accepted",
                )
            self._painted[item.id] = painted

    def paint(self, item: _studio.Item, **look: Any) -> _studio.Painted:
        """Hand out what was checked."""
        return self._painted[item.id]


def run(path: Path, studio: _studio.Studio) -> None:
    """Accept what a review marks, each plate with its reason.

    Parameters
    ----------
    path : Path
        The review.
    studio : Studio
        The renderer.

    Raises
    ------
    Stop
        With 2 if the review cannot be used, with 4 if the renderer is not canonical, with 5 if what is
        drawn now is not what was reviewed; then nothing is accepted.
    """
    marks = read(path)
    known = {item.id: item for item in _studio.items()}
    if strange := [name for name in marks if name not in known]:
        raise _studio.Stop(
            2, f"{path}: there is no plate {', '.join(map(repr, strange))} here. See `lietool figures list`"
        )
    items = [item for item in known.values() if item.id in marks]
    reviewed = Reviewed(studio, marks)
    reasons = {name: mark.reason for name, mark in marks.items()}
    _figures_accept.run(items, reviewed, reasons, before=lambda: reviewed.check(items))


def read(path: Path) -> dict[str, Mark]:
    """Read a review.

    Parameters
    ----------
    path : Path
        As the page hands it out.

    Returns
    -------
    dict of str to Mark
        By plate; reasons with single spaces.

    Raises
    ------
    Stop
        With 2 if it is no review, marks nothing, marks a plate twice or gives no reason.
    """
    try:
        with path.open("rb") as file:
            data = file.read(_MOST + 1)
        if len(data) > _MOST:
            raise ValueError(f"it is larger than {_MOST // 1_000_000} MB")
        found = json.loads(data.decode())
    except OSError as error:
        raise _studio.Stop(2, f"{path} cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise _studio.Stop(2, f"{path} is not {_FORM}: {error}") from None
    listed = found.get("accept") if isinstance(found, dict) and found.get("review") == 1 else None
    if not isinstance(listed, list):
        raise _studio.Stop(2, f"{path} is not {_FORM}: it has no list `accept`")
    if not listed:
        raise _studio.Stop(2, f"{path} marks nothing. Mark pictures in the report, each with a reason")
    marks: dict[str, Mark] = {}
    for number, each in enumerate(listed, 1):
        mark = _mark(path, number, each)
        if mark.plate in marks:
            raise _studio.Stop(2, f"{path}: {mark.plate} is marked twice. Keep one of its reasons")
        marks[mark.plate] = mark
    return marks


def _mark(path: Path, number: int, each: object) -> Mark:
    values = [each.get(key) for key in _KEYS] if isinstance(each, dict) else [None]
    if not all(isinstance(value, str) for value in values):
        raise _studio.Stop(
            2, f"{path}: mark {number} needs texts {', '.join(_KEYS)}. Download the review again"
        )
    plate, reason, picture, numbers = map(str, values)
    if not reason.strip():
        raise _studio.Stop(
            2, f"{path}: {plate} has no reason. Say why it is right; it is kept with the golden"
        )
    return Mark(plate, " ".join(reason.split()), picture, numbers)
