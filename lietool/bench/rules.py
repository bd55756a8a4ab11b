"""Rules near our own for comparing pictures: what each would miss of mistakes, and call one of noise.

A rule counts pixels beyond a colour distance, in one place and in all, and looks at the largest 9x9 mean of
the signed difference; here a picture is measured once and judged by many rules.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Rule:
    """Limits that a picture must keep; each may be reached.

    Parameters
    ----------
    pixels : int
        Beyond `delta_e` in one place.
    near : int
        Pixels each way from one of them that are in its place.
    strewn : int
        Pixels beyond `delta_e` in the whole picture.
    delta_e : float
        Colour distance dE76.
    lowpass : float
        Grey levels of the 9x9 mean.
    """

    pixels: int
    near: int
    strewn: int
    delta_e: float
    lowpass: float


@dataclass(frozen=True)
class Measured:
    """A picture against its golden: pixels that differ, and beyond each distance in all and in one place."""

    differing: int
    over: Mapping[float, int]
    crowd: Mapping[tuple[float, int], int]
    lowpass: float

    def uses(self, rule: Rule) -> tuple[float, float, float]:
        """How much of each limit it uses: in one place, in all, of the mean; beyond 1 it fails."""
        return (
            self.crowd[rule.delta_e, rule.near] / rule.pixels,
            self.over[rule.delta_e] / rule.strewn,
            self.lowpass / rule.lowpass,
        )

    def use(self, rule: Rule) -> float:
        """How much it uses of the limit that it uses most."""
        return max(self.uses(rule))


# What is tried beside our own, one at a time, and a few together.
_STEPS: Mapping[str, tuple[float, ...]] = {
    "pixels": (4, 6, 12, 16, 24),
    "near": (4, 8, 12, 24, 32),
    "strewn": (16, 24, 32, 64, 96),
    "delta_e": (1.0, 1.5, 2.5, 3.0, 4.0),
    "lowpass": (0.5, 0.75, 1.0, 2.0, 3.0),
}
_TOGETHER = (
    {"pixels": 8, "strewn": 8},
    {"pixels": 48, "strewn": 48},
    {"near": 8, "pixels": 6},
    {"near": 32, "pixels": 12},
    {"delta_e": 3.0, "pixels": 6},
    {"delta_e": 1.5, "pixels": 12, "strewn": 96},
)


def neighbours(own: Rule) -> list[Rule]:
    """List our own rule and those near it."""
    steps = [{name: value} for name, values in _STEPS.items() for value in values]
    found = [own, *(replace(own, **step) for step in (*steps, *_TOGETHER))]  # type: ignore[arg-type]
    return list(dict.fromkeys(found))


def measure(
    x: np.ndarray,
    y: np.ndarray,
    delta_e: np.ndarray,
    lowpass: float,
    size: tuple[int, int],
    rules: Sequence[Rule],
) -> Measured:
    """Measure all that rules look at.

    Parameters
    ----------
    x, y : (n,) int
        Pixels that differ.
    delta_e : (n,) float64
        Their colour distances.
    lowpass : float
        Largest magnitude of the 9x9 mean of the signed difference, in grey levels.
    size : tuple of int
        Width and height of the picture.
    rules : sequence of Rule
        What will be asked.

    Returns
    -------
    Measured
    """
    over, crowd = {}, {}
    for limit in {rule.delta_e for rule in rules}:
        far = delta_e > limit
        over[limit] = int(far.sum())
        widths = {rule.near for rule in rules if rule.delta_e == limit}
        crowd |= {(limit, near): n for near, n in _crowds(x[far], y[far], size, widths).items()}
    return Measured(x.size, over, crowd, lowpass)


def _crowds(x: np.ndarray, y: np.ndarray, size: tuple[int, int], widths: Iterable[int]) -> dict[int, int]:
    """The most marked pixels around one of them, for each half width."""
    if not x.size:
        return dict.fromkeys(widths, 0)
    width, height = size
    sums = np.zeros((height + 1, width + 1), np.int32)
    sums[y + 1, x + 1] = 1
    sums = sums.cumsum(axis=0).cumsum(axis=1)
    found = {}
    for near in widths:
        top, left = np.maximum(y - near, 0), np.maximum(x - near, 0)
        bottom, right = np.minimum(y + near + 1, height), np.minimum(x + near + 1, width)
        count = sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left]
        found[near] = int(count.max())
    return found


@dataclass(frozen=True)
class Standing:
    """What a rule does with mistakes and with noise.

    Parameters
    ----------
    rule : Rule
    missed : tuple of str
        Mistakes that none of their pictures shows.
    alarms : int
        Pictures of noise that it fails.
    least : float
        Of the mistakes that it catches, how many times a limit the one reaches that is caught most narrowly.
    most : float
        How much of a limit noise uses, at most.
    """

    rule: Rule
    missed: tuple[str, ...]
    alarms: int
    least: float
    most: float

    def better(self, other: "Standing") -> bool:
        """Whether it misses fewer and has fewer alarms; not worse in either, and better in one."""
        mine, others = (len(self.missed), self.alarms), (len(other.missed), other.alarms)
        return mine != others and mine[0] <= others[0] and mine[1] <= others[1]

    def plain(self) -> dict[str, Any]:
        """Return it for JSON."""
        rest = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "rule"}
        return asdict(self.rule) | rest | {"missed": list(self.missed)}


def standing(rule: Rule, mistakes: Mapping[str, Sequence[Measured]], noise: Sequence[Measured]) -> Standing:
    """Judge all pictures by a rule.

    Parameters
    ----------
    rule : Rule
    mistakes : Mapping[str, sequence of Measured]
        By mistake its pictures; one that fails is enough.
    noise : sequence of Measured

    Returns
    -------
    Standing
    """
    uses = {name: max(one.use(rule) for one in pictures) for name, pictures in mistakes.items()}
    noisy = [one.use(rule) for one in noise]
    return Standing(
        rule,
        tuple(name for name, use in uses.items() if use <= 1.0),
        sum(use > 1.0 for use in noisy),
        min((use for use in uses.values() if use > 1.0), default=float("nan")),
        max(noisy, default=0.0),
    )
