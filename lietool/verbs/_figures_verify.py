"""`lietool figures verify`: the judge.  It writes pictures of failures, and never a golden."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from lietool.golden import explain, folder, verdict
from lietool.verbs import _jobs, _studio

# Of these a reader wants to see the pictures.
_SEEN = {"picture", "size", "missing", "torn", "half accepted", "parameters", "inputs"}
# A plate's own parameters were drawn once; where that fails, the other plates still have to be judged.
UNDRAWN = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


@dataclass(frozen=True, eq=False)
class Result:
    """One plate's verdict, in words for a reader."""

    item: _studio.Item
    verdict: verdict.Verdict
    lines: tuple[str, ...] = ()
    left: tuple[Path, ...] = ()


def run(
    items: Sequence[_studio.Item],
    studio: _studio.Studio,
    failed: Path,
    as_json: bool,
    *,
    everything: bool,
    jobs: int = 1,
) -> int:
    """Compare plates with their goldens and print the verdicts.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer.
    failed : Path
        Folder for pictures of failures.
    as_json : bool
        Print JSON.
    everything : bool
        Whether these are all plates, so that goldens without a plate can be found.
    jobs : int
        How many processes share the work.

    Returns
    -------
    int
        The exit code.
    """
    general = [verdict.Finding("renderer", studio.trouble)] if studio.trouble else []
    work = partial(_judged, studio=studio if jobs < 2 else None, failed=failed)
    results = list(_jobs.each(work, items, jobs, "verifying"))
    if everything:
        general += unregistered(items)
    code = verdict.exit_code([*general, *(f for result in results for f in result.verdict.findings)])
    if as_json:
        about = {
            "exit": code,
            "findings": list(map(_finding, general)),
            "plates": list(map(_result, results)),
        }
        click.echo(json.dumps(about, indent=2, ensure_ascii=False))
    else:
        _print(results, general)
    return code


def _judged(item: _studio.Item, studio: _studio.Studio | None, failed: Path) -> Result:
    try:
        return _verify(item, studio or _studio.Studio(), failed)
    except UNDRAWN as error:
        return Result(item, verdict.Verdict((undrawn(error),)))


def undrawn(error: Exception) -> verdict.Finding:
    """Say why a plate cannot be drawn any more."""
    kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
    said = " ".join(str(error).split())
    return verdict.Finding("undrawn", f"cannot be drawn any more: {kind}{said}")


def judge(
    item: _studio.Item,
    painted: _studio.Painted,
    *,
    pictured: bool = True,
    now: Mapping[str, str] | None = None,
) -> verdict.Verdict:
    """Compare a plate that was painted with its golden, by the plate's own tolerance.

    Parameters
    ----------
    item : Item
        The plate.
    painted : Painted
        What it shows.
    pictured : bool
        Whether the picture is compared, or its numbers only.
    now : Mapping[str, str], optional
        What it is made from and by, as `_studio.made_by` tells.

    Returns
    -------
    Verdict
        With every finding.
    """
    tolerance = item.plate.tolerance
    return verdict.judge(
        item.place,
        parameters=item.recorded,
        shown=painted.numbers,
        image=painted.image if pictured else None,
        missing_labels=painted.missing_labels,
        limits=verdict.Limits(tolerance.pixels, tolerance.delta_e, tolerance.lowpass, tolerance.relative),
        now=now,
        program=item.program,
    )


def _verify(item: _studio.Item, studio: _studio.Studio, failed: Path) -> Result:
    if studio.trouble:
        # Numbers need no renderer: they are judged even so.
        return Result(item, judge(item, studio.sketch(item), pictured=False))
    painted = studio.paint(item)
    found = judge(item, painted, now=_studio.made_by(item, studio.info))
    pictures, lines = {}, []
    kinds = {finding.kind for finding in found.findings}
    if _SEEN & kinds:
        pictures["actual"] = painted.image
        if found.golden is not None:
            pictures["expected"] = found.golden.image
        if found.golden is not None and found.comparison is not None and found.comparison.same_size:
            pictures["difference"] = explain.amplified(found.golden.image, painted.image)
            if "picture" in kinds:
                lines = explain.lines(found.golden.image, painted.image, found.comparison)
    with _studio.writing(str(failed)):
        left = explain.leave(failed, item.id, **pictures)
    # The golden's picture has served, and would only fill memory or the way from one process to another.
    return Result(item, replace(found, golden=None), tuple(lines), tuple(left))


def unregistered(items: Sequence[_studio.Item]) -> list[verdict.Finding]:
    """Find the goldens that belong to no plate; `items` are all plates."""
    places = [item.place for item in items]
    strays = [
        path for root in {place.root: 0 for place in places} for path in folder.unregistered(root, places)
    ]
    return [
        verdict.Finding(
            "unregistered", f"{path} belongs to no plate. Remove it, or give the figure that plate again."
        )
        for path in strays
    ]


def _print(results: Sequence[Result], general: Sequence[verdict.Finding]) -> None:
    width = max((len(result.item.id) for result in results), default=0)
    for result in results:
        found = result.verdict
        word = click.style(found.word if found.passes else "FAILS", "green" if found.passes else "red")
        click.echo(f"{result.item.id:<{width}}  {word}{_headroom(found) if found.passes else ''}")
        said = [finding.message for finding in found.findings] + list(result.lines)
        if result.left:
            said.append("see " + ", ".join(map(str, result.left)))
        for line in said:
            click.echo(f"{'':<{width}}    {line}")
    for finding in general:
        click.echo(click.style(f"{finding.kind}: ", "red") + finding.message)
    failed = sum(not result.verdict.passes for result in results)
    summary = f"{len(results)} plates: {len(results) - failed} as accepted, {failed} not"
    click.echo(
        summary + ("; pictures were not compared." if any(f.kind == "renderer" for f in general) else ".")
    )


def _headroom(found: verdict.Verdict) -> str:
    """How near to failing a picture came that is not equal to its golden."""
    c = found.comparison
    if c is None or c.equal:
        return ""
    return (
        f"  {c.differing} px differ, {c.over} of {c.strewn_limit} beyond dE {c.delta_e_limit:g},"
        f" {c.crowd} of {c.pixels_limit} in one place;"
        f" 9x9 mean {abs(c.lowpass):.2f} of {c.lowpass_limit:g}"
    )


def _result(result: Result) -> dict[str, Any]:
    found = result.verdict
    compared = found.comparison
    return {
        "plate": result.item.id,
        "command": result.item.command,
        "verdict": found.word,
        "findings": list(map(_finding, found.findings)),
        "comparison": compared
        and asdict(compared)
        | {"headroom_pixels": compared.headroom_pixels, "headroom_lowpass": compared.headroom_lowpass},
        "numbers": list(map(str, found.differences)),
        "explanation": list(result.lines),
        "left": list(map(str, result.left)),
    }


def _finding(finding: verdict.Finding) -> dict[str, Any]:
    return {"kind": finding.kind, "code": finding.code, "message": finding.message}
