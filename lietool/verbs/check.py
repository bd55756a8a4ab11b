"""Check a picture of your own against an accepted one."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from lietool.golden import picture, store, verdict
from lietool.verbs import _compared, _studio


@dataclass(frozen=True)
class Reason:
    """Why a picture cannot be the golden's, without looking at a pixel: a word, its exit code, a sentence."""

    word: str
    code: int
    message: str


@click.command()
@click.argument("file", metavar="PICTURE")
@click.option("--plate", metavar="ID", help="Which plate it should be; not needed where the picture says so.")
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Write the difference, a .png."
)
@click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
@click.pass_context
def command(context: click.Context, file: str, plate: str | None, output: Path | None, as_json: bool) -> None:
    """Check a picture of your own against an accepted one.

    Says whether it is the same by the plate's own tolerance, and else where it differs and how far.  A
    picture that says of itself that it was made with other parameters, or by a renderer that goldens
    are not made with, is told so.

    Ends with 0 if it is the same; 2 if it is no picture; 3 if it has another size, or the plate no golden;
    4 if another renderer has made it; 5 if it differs.
    """
    _compared.check_output(output, file)
    seen = picture.load(file)
    item = _plate(file, plate, seen.texts)
    try:
        golden = store.read(item.place)
    except store.GoldenError as error:
        raise _studio.Stop(3, f"{item.id} has no golden to check with: {error}") from None
    found, reasons = _judged(item, golden, seen)
    # As for all plates: a renderer comes before a size, and that before a difference.
    codes = [reason.code for reason in reasons] or [_compared.CODES[found.word]]
    code = max(codes, key=(0, 5, 3, 4).index)
    left = _compared.leave(found, output)
    if as_json:
        said = _about(item, found, reasons) | {"exit": code, "picture": file, "difference": left}
        click.echo(json.dumps(said, indent=2, ensure_ascii=False))
    else:
        _show(item, found, reasons)
        if found.word == "different" and not reasons:
            other = verdict.differences_of(golden.provenance, seen.texts)
            click.echo(f"  made by something else: {other}\n" if other else "", nl=False)
        if left:
            click.echo(f"  see {left}")
    context.exit(code)


def _judged(
    item: _studio.Item, golden: store.Golden, seen: picture.Picture
) -> tuple[_compared.Pair, list[Reason]]:
    """Compare by the plate's own tolerance; what the picture says of itself goes before where it differs."""
    own = item.plate.tolerance
    limits = verdict.Limits(own.pixels, own.delta_e, own.lowpass, own.relative)
    found = _compared.pair(golden.image, seen.image, limits)
    if not _compared.CODES[found.word]:
        return found, []
    reasons = list(_reasons(item, golden.provenance, seen.texts))
    return (found if reasons else _compared.explained(found)), reasons


def _plate(file: str, plate: str | None, told: Mapping[str, str]) -> _studio.Item:
    wanted = plate or told.get("plate")
    if not wanted:
        raise click.UsageError(f"{file} does not say which plate it is. Name it, such as --plate B2.8")
    found = _studio.items([wanted])
    if len(found) > 1:
        listed = ", ".join(item.id for item in found)
        raise click.UsageError(f"--plate {wanted} stands for several, {listed}. Name one of them")
    return found[0]


def _reasons(item: _studio.Item, golden: Mapping[str, str], told: Mapping[str, str]) -> Iterator[Reason]:
    """What the picture says of itself, by which it is another one or cannot be compared."""
    again = f"{item.program} {item.command} --plate {item.id}"
    command = told.get("command", item.command)
    if command != item.command:
        yield Reason("other command", 5, f"it was made by `lietool {command}`, the golden by `{again}`")
    elif "parameters" in told and (
        change := verdict.changed(golden.get("parameters", ""), told["parameters"])
    ):
        other = told.get("plate", item.id)
        which = f", and is plate {other}" if other != item.id else ""
        yield Reason(
            "other parameters",
            5,
            f"it was made with other parameters{which}: {change}. The golden's are those of `{again}`",
        )
    if look := ", ".join(f"{key} {told[key]}" for key in ("theme", "draft") if key in told):
        yield Reason("other look", 5, f"it was drawn in another look than goldens are: {look}")
    renderer = told.get("renderer", verdict.CANONICAL)
    if not renderer.startswith(verdict.CANONICAL):
        yield Reason(
            "other renderer",
            4,
            f"it was drawn by {renderer!r}, goldens by {verdict.CANONICAL}. "
            "`lietool doctor` says how to have that",
        )


def _about(item: _studio.Item, found: _compared.Pair, reasons: list[Reason]) -> dict[str, Any]:
    return {
        "plate": item.id,
        "verdict": reasons[0].word if reasons else found.word,
        "golden": str(item.place.png),
        "reasons": [{"verdict": reason.word, "message": reason.message} for reason in reasons],
        **_compared.about(found),
    }


def _show(item: _studio.Item, found: _compared.Pair, reasons: list[Reason]) -> None:
    click.echo(f"{item.id}  {item.plate.title}")
    for reason in reasons:
        click.echo(f"{click.style(reason.word, 'red')}\n  {reason.message}")
    if reasons:
        return
    _compared.show(found)
    if not found.comparison.same_size:
        click.echo(f"  {_sizes(item, found)}")


def _sizes(item: _studio.Item, found: _compared.Pair) -> str:
    (w, h), (width, height) = found.comparison.actual_size, found.comparison.expected_size
    said = f"it is {w}x{h}, the golden {width}x{height}"
    wanted = f"Make it at {width}x{height}"
    # To a pixel, as whoever scales a picture rounds.
    wide, high = abs(w * height / h - width), abs(h * width / w - height)
    if wide < max(width / w, 1.0) or high < max(height / h, 1.0):
        return f"{said}, of the same shape. {wanted}: {item.program} {item.command} --plate {item.id}"
    return f"{said}, of another shape. {wanted}, and the page of that shape"
