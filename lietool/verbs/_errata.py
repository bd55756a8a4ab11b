"""What an erratum is, and how a user names one."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Value = float | NDArray[np.float64]


@dataclass(frozen=True)
class Outcome:
    """What came of a counterexample: the two values, and how far each is off.

    `error` is nan where the printed form has no value; `rest`, the distance of the true form from an
    independent reference, is rounding.
    """

    printed: Value
    true: Value
    error: float
    rest: float


@dataclass(frozen=True)
class Erratum:
    """One thing that a text got wrong: where, what is printed, what is true, why; `compute` proves it."""

    where: str
    printed: str
    true: str
    why: str
    example: str
    compute: Callable[[], Outcome]
    also: tuple[str, ...] = ()


_F = TypeVar("_F", bound=Callable[[], Outcome])


def erratum(
    into: list[Erratum],
    where: str,
    *,
    printed: str,
    true: str,
    why: str,
    example: str,
    also: Sequence[str] = (),
) -> Callable[[_F], _F]:
    """Add the decorated counterexample to a list."""

    def add(compute: _F) -> _F:
        into.append(Erratum(where, printed, true, why, example, compute, tuple(also)))
        return compute

    return add


def outcome(printed: Value, true: Value, reference: Value | None = None) -> Outcome:
    """Return the outcome whose errors are the norms of the differences."""
    rest = 0.0 if reference is None else float(np.linalg.norm(np.subtract(true, reference)))
    return Outcome(printed, true, float(np.linalg.norm(np.subtract(printed, true))), rest)


def key(words: str) -> str:
    """Return a place without case, blanks and brackets: ``K Alg. 1`` is ``kalg1``."""
    words = words.lower().replace("algorithm", "alg").replace("chapter", "").replace("table", "tab")
    return re.sub(r"[^a-z0-9.]", "", re.sub(r"(?<=[a-z]{2})\.", "", words))


def select(words: str, every: Sequence[Erratum]) -> list[Erratum]:
    """Return the errata at a place: ``7.6``, ``B7.6``, ``K alg 1``; the text's letter may be left out."""
    wanted = key(words)

    def at(name: str) -> bool:
        rest = key(name).removeprefix(wanted) if key(name).startswith(wanted) else None
        # 2.3 is no part of 2.34.
        return rest is not None and not re.match(r"[0-9]|\.[0-9]", rest)

    def named(one: Erratum) -> bool:
        names = [name for place in (one.where, *one.also) for name in (place, place[1:])]
        return any(at(name) for name in names)

    return [one for one in every if named(one)] if wanted else list(every)
