"""One plate against its golden: everything that can be wrong, each with its own message and exit code."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lietool.golden import compare, compare_numbers, numbers, store

# What a kind of finding means to whoever started the program: 3 the golden is not there to compare
# with, 4 this machine cannot compare, 5 it was compared and is not the same.
CODES = {
    "renderer": 4,
    "missing": 3,
    "unregistered": 3,
    "size": 3,
    "torn": 3,
    "half accepted": 3,
    "label": 3,
    "parameters": 5,
    "inputs": 5,
    "golden's renderer": 5,
    "picture": 5,
    "numbers": 5,
    "undrawn": 5,
}
CANONICAL = "llvmpipe"
# Of these the golden says that it was made otherwise: then a picture that differs is no news.
_EXPLAINED = ("parameters", "inputs", "golden's renderer")
# What may make a difference although code and parameters are the same, as a golden records it.
MADE_BY = ("renderer", "backend", "mesa", "llvm", "python", "numpy", "scipy", "matplotlib", "pillow")
MADE_BY += ("scikit-image", "trimesh", "moderngl", "lietool")


@dataclass(frozen=True)
class Finding:
    """Something that is wrong: its `kind`, a key of `CODES`, and a message that says what to do."""

    kind: str
    message: str

    @property
    def code(self) -> int:
        """The exit code that it asks for."""
        return CODES[self.kind]


@dataclass(frozen=True)
class Limits:
    """How far a picture and its numbers may be from their golden."""

    pixels: int = compare.PIXELS
    delta_e: float = compare.DELTA_E
    lowpass: float = compare.LOWPASS
    relative: float = compare_numbers.RELATIVE


@dataclass(frozen=True)
class Verdict:
    """What comparing a plate with its golden gave; it passes if nothing was found."""

    findings: tuple[Finding, ...] = ()
    comparison: compare.Comparison | None = None
    differences: tuple[compare_numbers.Difference, ...] = ()
    golden: store.Golden | None = field(default=None, repr=False)

    @property
    def passes(self) -> bool:
        """Whether the plate is as it was accepted."""
        return not self.findings

    @property
    def word(self) -> str:
        """The verdict for a table: "equal", "passes", or what was found."""
        if self.findings:
            return ", ".join(dict.fromkeys(finding.kind for finding in self.findings))
        if self.comparison is None:
            return "not compared"
        return "equal" if self.comparison.equal else "passes"


def exit_code(findings: Iterable[Finding]) -> int:
    """Return the exit code for all that was found: 4 before 3 before 5, and 0 for nothing.

    Parameters
    ----------
    findings : iterable of Finding
        Of all plates.

    Returns
    -------
    int
        0, 3, 4 or 5.
    """
    codes = {finding.code for finding in findings}
    return next((code for code in (4, 3, 5) if code in codes), 0)


def judge(
    place: store.Place,
    *,
    parameters: str,
    shown: numbers.Numbers,
    image: np.ndarray | None,
    missing_labels: Iterable[str] = (),
    limits: Limits | None = None,
    now: Mapping[str, str] | None = None,
    program: str = "lietool",
) -> Verdict:
    """Compare a plate with its golden.

    A golden that says of itself that it was made from other parameters or files, or by a renderer that
    goldens are not made with, is found to be so, and not to be another picture.

    Parameters
    ----------
    place : Place
        Where the golden lies.
    parameters : str
        The plate's parameters as JSON, as they were recorded.
    shown : Mapping[str, object]
        The numbers in the picture.
    image : (h, w, 3) uint8, optional
        The picture; without it only the rest is compared.
    missing_labels : iterable of str
        Texts that the golden's labels do not hold.
    limits : Limits, optional
        The plate's own, where it has any.
    now : Mapping[str, str], optional
        What the picture is made from and by, in the words of a golden's provenance.
    program : str
        How the program is called, with what it needs to know the plate.

    Returns
    -------
    Verdict
        With every finding, not only the first.
    """
    limits = limits or Limits()
    accept = f'{program} figures accept {place.plate} --reason "..."'
    found = [
        Finding("label", f"label {text!r} is not in {place.labels}. Add it: {accept}")
        for text in missing_labels
    ]
    try:
        golden = store.read(place)
    except store.GoldenError as error:
        # With no golden at all, its labels are not worth a word.
        found = [] if error.kind == "missing" else found
        return Verdict((*found, Finding(error.kind, _unreadable(error, accept))))
    found += _provenance(golden.provenance, parameters, now or {}, accept)
    compared: list[Finding] = []
    comparison = None
    if image is not None:
        comparison = compare.images(
            golden.image, image, pixels=limits.pixels, delta_e=limits.delta_e, lowpass=limits.lowpass
        )
        compared += _picture(comparison, accept)
    differences = compare_numbers.numbers(golden.numbers, shown, limits.relative)
    if differences:
        compared.append(_numbers(differences))
    if not any(finding.kind in _EXPLAINED for finding in found):
        found += _elsewhere(compared, golden.provenance, now or {})
    return Verdict(tuple(found), comparison, tuple(differences), golden)


def differences_of(before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Say by what else a picture was made than another.

    Parameters
    ----------
    before, now : Mapping[str, str]
        Provenances; what one of them does not say is passed over.

    Returns
    -------
    str
        Such as "mesa was 22.3.6, is 25.0.7"; empty where they are the same.
    """
    names = [name for name in MADE_BY if name in before and name in now and before[name] != now[name]]
    return ", ".join(f"{name} was {before[name]}, is {now[name]}" for name in names)


def changed(before: str, after: str) -> str:
    """Say which parameters differ between two sets of them.

    Parameters
    ----------
    before, after : str
        JSON objects.

    Returns
    -------
    str
        Such as "turn was 540.0, is 500.0"; empty when they are the same.
    """
    try:
        a, b = json.loads(before), json.loads(after)
    except ValueError:
        return "they were not recorded"
    if not isinstance(a, dict) or not isinstance(b, dict):
        return "they were not recorded"
    names = [name for name in {**a, **b} if a.get(name, "absent") != b.get(name, "absent")]
    return ", ".join(f"{name} was {_said(a, name)}, is {_said(b, name)}" for name in names)


def _said(values: Mapping[str, object], name: str) -> object:
    value = values.get(name, "absent")
    return '""' if value == "" else value


def _unreadable(error: store.GoldenError, accept: str) -> str:
    if error.kind == "missing":
        return f"{error}. Look at the picture; if it is right: {accept}"
    if error.kind == "half accepted":
        return f"half accepted, run accept again: {error}. {accept}"
    return f"{error}. Restore it from version control, or make it again: {accept}"


def _provenance(
    recorded: Mapping[str, str], parameters: str, now: Mapping[str, str], accept: str
) -> Iterable[Finding]:
    if change := changed(recorded.get("parameters", ""), parameters):
        yield Finding(
            "parameters", f"the golden was made with other parameters: {change}. If meant: {accept}"
        )
    # A golden that is older than this text does not say what it was made from.
    inputs = recorded.get("inputs"), now.get("inputs")
    if None not in inputs and inputs[0] != inputs[1]:
        change = changed(str(inputs[0]), str(inputs[1]))
        yield Finding(
            "inputs", f"the golden was made from other files: {change} (SHA-256). If meant: {accept}"
        )
    renderer = recorded.get("renderer", "unknown")
    if not renderer.startswith(CANONICAL):
        yield Finding(
            "golden's renderer",
            f"the golden was made by {renderer!r}, not by {CANONICAL}. Make it again where "
            f"`lietool doctor` calls the renderer canonical: {accept}",
        )


def _picture(comparison: compare.Comparison, accept: str) -> Iterable[Finding]:
    if not comparison.same_size:
        now, then = ("x".join(map(str, size)) for size in (comparison.actual_size, comparison.expected_size))
        yield Finding("size", f"the picture is {now}, its golden {then}. If meant: {accept}")
    elif not comparison.passes:
        yield Finding(
            "picture",
            f"picture differs: {comparison.says}",
        )


def _numbers(differences: Sequence[compare_numbers.Difference]) -> Finding:
    more = f"; and {len(differences) - 3} entries more" if len(differences) > 3 else ""
    return Finding("numbers", f"numbers differ: {'; '.join(map(str, differences[:3]))}{more}")


def _elsewhere(
    compared: Sequence[Finding], recorded: Mapping[str, str], now: Mapping[str, str]
) -> Iterable[Finding]:
    """Say of what differs, where that is so, that something else made it."""
    other = differences_of(recorded, now)
    for finding in compared:
        yield replace(finding, message=f"{finding.message}. Made otherwise: {other}") if other else finding
