"""Measure errors against 50 digits, for every function and class of input, and judge the promises."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from lietool.bench import exact, inputs, others, subjects
from lietool.bench.subjects import Subject

FULL, QUICK = 12, 3
"""Axes or positions of each input."""


@dataclass(frozen=True)
class Row:
    """One function on one class of inputs.

    `ours` is the worst relative error, `allowed` what is promised where error
    and promise are nearest to each other, or None; `used` is the largest part
    of a promise that an error takes, at most 1 if it holds. `others` are the
    worst errors by library, `refused` how many inputs each would not take.
    """

    function: str
    inputs: str
    count: int
    ours: float
    promise: str
    allowed: float | None
    used: float | None
    others: dict[str, float] = field(default_factory=dict)
    refused: dict[str, int] = field(default_factory=dict)

    @property
    def holds(self) -> bool | None:
        """Whether the promise holds, None where nothing is promised."""
        return None if self.used is None else self.used <= 1.0


def rows(count: int = FULL, libraries: Iterable[str] = ()) -> Iterator[Row]:
    """Measure every function, class by class; for the arguments see `rows_of`."""
    for subject in subjects.SUBJECTS:
        yield from rows_of(subject, count, tuple(libraries))


def rows_of(subject: Subject, count: int = FULL, libraries: Iterable[str] = ()) -> Iterator[Row]:
    """Measure one function.

    Parameters
    ----------
    subject : Subject
    count : int
        Axes or positions of each input.
    libraries : iterable of str
        Of `others.LIBRARIES`, those to compare with.

    Yields
    ------
    Row
        Class by class.
    """
    for name, elements in inputs.FAMILIES[subject.inputs](count).items():
        yield _row(subject, name, elements, tuple(libraries))


def _row(subject: Subject, name: str, elements: np.ndarray, libraries: tuple[str, ...]) -> Row:
    right = [subject.exact(x.tolist() if x.ndim else float(x)) for x in elements]
    measure = _measure(subject, right)
    blocks = [np.asarray(block) for block in subject.ours(elements)]
    errors = np.array([measure(i, [block[i] for block in blocks]) for i in range(len(elements))])
    promise = None if name in subjects.BEYOND else subject.promise
    allowed = promise.allowed(elements) if promise else None
    hardest = int(np.argmax(errors / allowed)) if allowed is not None else 0
    found = {}
    for library in libraries:
        if f := others.functions(library, subject.name):
            found[library] = others.worst(f, elements, measure)
    return Row(
        subject.name,
        name,
        len(elements),
        float(errors.max()),
        promise.text if promise else "",
        None if allowed is None else float(allowed[hardest]),
        None if allowed is None else float(errors[hardest] / allowed[hardest]),
        {library: error for library, (error, _) in found.items()},
        {library: refused for library, (_, refused) in found.items() if refused},
    )


def _measure(subject: Subject, right: list[list[exact.Value]]) -> Callable[[int, Iterable], float]:
    def measure(i: int, blocks: Iterable) -> float:
        return exact.relative_errors(others.flat(tuple(blocks)), right[i], subject.least)

    return measure
