"""Which typical mistake explains what a student's function returned."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from lietool import mutation
from lietool.exercise import compare
from lietool.exercise.record import Case, Exercise, Value

# How near a wrong function must be, relative to its values: nearer than two of them are to each other.
_NEAR = 1e-7
# With fewer answers than these, those that failed are looked at too.
_ENOUGH = 3
# Of several mistakes that explain it, those that are told.
_MOST = 2
_BLANK = "{} nan only, as the file does that you started with: write {}."
REFUSED = object()
"""Stands for the result of a function that raised an error."""


@dataclass(frozen=True, eq=False)
class Seen:
    """An input, what was wanted, and what the student's function returned, or `REFUSED`."""

    case: Case
    want: Value
    got: Any


@dataclass(frozen=True, eq=False)
class _Wrong:
    says: str
    functions: Mapping[str, Callable[..., Value]]


def sentences(exercise: Exercise, seen: Sequence[Seen]) -> tuple[str, ...]:
    """Return what explains the results of a student's functions.

    A mistake does if it gives what the student's function gives for all inputs, and does not for all of
    them give what is right.  Inputs that the student's function fails for say nothing, where there are
    others: who cannot take batches may have made a mistake besides.  Who fails for all has made none that
    can be known.

    Parameters
    ----------
    exercise : Exercise
        Whose mistakes are tried: its own, then those of the catalogue that it names.
    seen : sequence of Seen
        What was tried.

    Returns
    -------
    tuple of str
        At most two, a sentence or two each; none where all is right, or nothing explains it.
    """
    with np.errstate(all="ignore"):
        wrong = {x.case.function for x in seen if not _same(exercise, x.case.function, x.got, x.want)}
        if not wrong:
            return ()
        blank = wrong - {x.case.function for x in seen if not _is_blank(x.got)}
        if blank == {x.case.function for x in seen}:
            return (_BLANK.format("It returns", "the function"),)
        told = _recognised(exercise, seen, wrong - blank, _MOST - bool(blank))
        if blank:
            told.append(_BLANK.format(f"{' and '.join(sorted(blank))} gave", "what is left"))
        return tuple(told)


def _recognised(exercise: Exercise, seen: Sequence[Seen], wrong: Collection[str], most: int) -> list[str]:
    """What is said of at most so many mistakes that explain these wrong functions."""
    told: list[str] = []
    for mistake in _wrongs(exercise):
        mine = [x for x in seen if x.case.function in mistake.functions]
        if not any(name in wrong for name in mistake.functions) or mistake.says in told:
            continue
        if mine and _explains(exercise, mistake, mine):
            told.append(mistake.says)
            if len(told) == most:
                break
    return told


def _explains(exercise: Exercise, mistake: _Wrong, seen: Sequence[Seen]) -> bool:
    answered = [x for x in seen if x.got is not REFUSED]
    if not answered:
        return False
    differs = False
    for x in answered if len(answered) >= _ENOUGH else seen:
        name = x.case.function
        try:
            # It may spoil them.
            made = mistake.functions[name](*deepcopy(x.case.args))
        except Exception:
            made = REFUSED
        if not _same(exercise, name, x.got, made, _NEAR):
            return False
        # Near a mistake that is itself nearly right is no sign of it where the student is right.
        right = _same(exercise, name, made, x.want) or _same(exercise, name, x.got, x.want)
        differs = differs or not right
    return differs


def _wrongs(exercise: Exercise) -> Iterator[_Wrong]:
    for mistake in exercise.mistakes:
        yield _Wrong(mistake.says, mistake.functions)
    for mutant in _catalogue():
        if not mutant.name.startswith(exercise.mutants or ("\0",)):
            continue
        for function in exercise.functions:
            if function.library:
                yield _Wrong(
                    mutant.says, {function.name: function.calling(_mutated(mutant, function.library))}
                )


@cache
def _catalogue() -> tuple[mutation.Mutant, ...]:
    return tuple(mutation.catalogue())


@cache
def _mutated(mutant: mutation.Mutant, name: str) -> Callable[..., Value]:
    return mutation.function(mutant, name)


def _same(exercise: Exercise, name: str, a: Any, b: Any, tolerance: float = 0.0) -> bool:
    if a is REFUSED or b is REFUSED:
        return a is b
    function = exercise.function(name)
    try:
        return bool(function.apart(a, b) <= max(function.tolerance, tolerance))
    except compare.UnlikeError:
        return False


def _is_blank(value: Any) -> bool:
    """Whether a result is nan throughout, as that of a starter is."""
    if value is REFUSED:
        return False
    parts = value if isinstance(value, tuple | list) else (value,)
    return all(np.asarray(part).dtype.kind in "fc" and bool(np.isnan(part).all()) for part in parts)
