"""The report of a comparison: one HTML file with every picture, every number, and why it is not the same.

The page needs no network and opens from disk.  Who reads it swipes, blinks and
magnifies, and marks what is right with a reason; the review that the page
hands out carries the SHA-256 of the picture and the numbers that were looked
at, so that nothing else can be accepted by it.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from lietool.golden import compare, compare_numbers, explain
from lietool.golden import elements as elements_
from lietool.golden import numbers as numbers_

FAILED, CHANGED, PASSED = "failed", "changed", "passed"
_NOTHING: tuple[Mapping[str, str], Mapping[str, str]] = ({}, {})


@dataclass(frozen=True, eq=False)
class Entry:
    """All that the report tells of one picture.

    `kind` is "failed", "changed" (it passes, but is not the same to the last
    bit) or "passed"; `word` is the verdict.  Pictures are PNG; `actual` is None
    where it equals `expected`, and both are None where there is none.  `ssim`
    is a map of the similarity of a failure.  `because` is the reason of a
    tolerance that is not the usual one, `provenance` that of the golden and
    that of now, `accept` the command that accepts it, without the reason.
    `counted` says how many entries of numbers were compared, and `nearest` which
    one is nearest to its limit and what part of it is used, beyond 1 if it differs.
    `digests` name what was drawn now, the picture's and the numbers', as
    `picture_digest` and `numbers_digest` make them; empty where nothing was.
    """

    name: str
    title: str
    kind: str
    word: str
    messages: tuple[str, ...] = ()
    expected: bytes | None = None
    actual: bytes | None = None
    comparison: compare.Comparison | None = None
    blobs: tuple[explain.Blob, ...] = ()
    ssim: bytes | None = None
    differences: tuple[compare_numbers.Difference, ...] = ()
    because: str = ""
    parameters: Mapping[str, str] = field(default_factory=dict)
    provenance: tuple[Mapping[str, str], Mapping[str, str]] = _NOTHING
    accept: str = ""
    elements: Mapping[str, tuple[elements_.Element, ...]] = field(default_factory=dict)
    counted: int = 0
    nearest: tuple[str, float] = ("", 0.0)
    digests: tuple[str, str] = ("", "")


def entry(
    name: str,
    *,
    expected: np.ndarray | None,
    actual: np.ndarray | None,
    title: str = "",
    word: str = "",
    messages: Sequence[str] = (),
    comparison: compare.Comparison | None = None,
    before: numbers_.Numbers | None = None,
    after: numbers_.Numbers | None = None,
    differences: Sequence[compare_numbers.Difference] | None = None,
    relative: float = compare_numbers.RELATIVE,
    because: str = "",
    parameters: Mapping[str, str] | None = None,
    provenance: tuple[Mapping[str, str], Mapping[str, str]] = _NOTHING,
    accept: str = "",
) -> Entry:
    """Make the entry of a picture, with its explanation where it is not the same.

    Parameters
    ----------
    name : str
        The plate or test; each is once in a report.
    expected, actual : (h, w, 3) uint8, optional
        The golden and what was drawn now; None where there is none.
    title : str
        What stands beside the name.
    word : str
        The verdict; "equal", "passes" or "differs" where none is given.
    messages : sequence of str
        What was found to be wrong.
    comparison : Comparison, optional
        Of the two pictures; by the usual limits where none is given.
    before, after : Mapping[str, object], optional
        The numbers of the golden and of now.
    differences : sequence of Difference, optional
        Of the two sets of numbers; found here where none are given.
    relative : float
        The part of the largest expected magnitude that a number may be off.
    because : str
        Why the tolerance is not the usual one.
    parameters : Mapping[str, str], optional
        What the picture was drawn with.
    provenance : tuple of two Mapping[str, str]
        How the golden was made, and how the picture of now was.
    accept : str
        The command that accepts it, without the reason.

    Returns
    -------
    Entry
        Failed where there is a message, a picture beyond its limits or a changed number.

    Raises
    ------
    ValueError
        If a picture is not (h, w, 3) uint8.
    """
    if comparison is None and expected is not None and actual is not None:
        comparison = compare.images(expected, actual)
    if differences is None:
        both = before is not None and after is not None
        differences = compare_numbers.numbers(before or {}, after or {}, relative) if both else ()
    kind = _kind(bool(messages or differences), comparison)
    blobs, ssim = (), None
    if expected is not None and actual is not None and comparison and comparison.same_size:
        if not comparison.equal:
            blobs = tuple(explain.blobs(expected, actual, delta_e=comparison.delta_e_limit))
        if not comparison.passes:
            ssim = explain.similarity_png(expected, actual)
    same = comparison is not None and comparison.equal
    return Entry(
        name=name,
        title=title,
        kind=kind,
        word=word or {FAILED: "differs", CHANGED: "passes", PASSED: "equal"}[kind],
        messages=tuple(messages),
        expected=None if expected is None else explain.png(expected),
        actual=None if actual is None or same else explain.png(actual),
        comparison=comparison,
        blobs=blobs,
        ssim=ssim,
        differences=tuple(differences),
        because=because,
        parameters=parameters or {},
        provenance=provenance,
        accept=accept,
        elements=elements_.worst(tuple(differences), before or {}, after or {}),
        counted=sum(1 for _ in numbers_.leaves(before or {})),
        nearest=elements_.nearest(before or {}, after or {}, relative),
        digests=(
            "" if actual is None else picture_digest(actual),
            "" if after is None else numbers_digest(after),
        ),
    )


def picture_digest(image: np.ndarray) -> str:
    """Name a picture by its pixels, whatever wrote its file.

    Parameters
    ----------
    image : (h, w, 3) uint8
        The picture.

    Returns
    -------
    str
        SHA-256 of its size and its pixels.
    """
    size = f"{image.shape[1]}x{image.shape[0]}\n".encode()
    return hashlib.sha256(size + np.ascontiguousarray(image).tobytes()).hexdigest()


def numbers_digest(values: numbers_.Numbers) -> str:
    """Name numbers by the text that a golden would keep.

    Parameters
    ----------
    values : Mapping[str, object]
        As for `numbers.dumps`.

    Returns
    -------
    str
        SHA-256.
    """
    return hashlib.sha256(numbers_.dumps(values).encode()).hexdigest()


def build(
    entries: Sequence[Entry],
    *,
    title: str,
    about: Mapping[str, str],
    notes: Sequence[str] = (),
    review: str = "",
) -> str:
    """Make the page.

    Parameters
    ----------
    entries : sequence of Entry
        In the order in which they are listed; names must differ.
    title : str
        Of the page.
    about : Mapping[str, str]
        Of the whole run: renderer, versions, date.
    notes : sequence of str
        What is wrong with the run as a whole, such as a renderer that cannot be compared.
    review : str
        The command that applies a downloaded review.json; where there is none, the page gives the
        `accept` commands one by one, without their reasons.

    Returns
    -------
    str
        HTML that names no other file.

    Raises
    ------
    ValueError
        If two entries have one name.
    """
    from lietool.golden import report_page

    names = [each.name for each in entries]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(
            f"report.build: entries must have names that differ; got {', '.join(twice)} twice. Rename one."
        )
    return report_page.render(entries, title=title, about=about, notes=notes, review=review)


def _kind(wrong: bool, comparison: compare.Comparison | None) -> str:
    if wrong or (comparison is not None and not comparison.passes):
        return FAILED
    return CHANGED if comparison is not None and not comparison.equal else PASSED
