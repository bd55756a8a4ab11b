"""Compare any two pictures by the rule that goldens are held to."""

import json
from pathlib import Path

import click

from lietool.golden import compare, picture, verdict
from lietool.verbs import _compared


@click.command()
@click.argument("expected", metavar="EXPECTED")
@click.argument("actual", metavar="ACTUAL")
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Write the difference, a .png."
)
@click.option(
    "--pixels",
    metavar="N",
    type=click.IntRange(0),
    default=compare.PIXELS,
    show_default=True,
    help="How many pixels in one place may be far from their colour; in all it is 48, or as many as this.",
)
@click.option(
    "--delta-e",
    metavar="DISTANCE",
    type=_compared.LIMIT,
    default=compare.DELTA_E,
    show_default=True,
    help="How far is far, in CIE76.",
)
@click.option(
    "--lowpass",
    metavar="LEVELS",
    type=_compared.LIMIT,
    default=compare.LOWPASS,
    show_default=True,
    help="How much the 9x9 mean of the signed difference may be.",
)
@click.option(
    "--ignore",
    metavar="X0,Y0,X1,Y1",
    type=_compared.Box(),
    multiple=True,
    help="A box in pixels that does not count, x1 and y1 just outside; may be repeated.",
)
@click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
@click.pass_context
def command(
    context: click.Context,
    expected: str,
    actual: str,
    output: Path | None,
    pixels: int,
    delta_e: float,
    lowpass: float,
    ignore: _compared.Boxes,
    as_json: bool,
) -> None:
    """Compare any two pictures by the rule that goldens are held to.

    Ends with 0 if they are the same, with 5 if they are not, with 3 if they have other sizes, and with 2 if
    one is no picture.  It reads PNG of any kind, TIFF, WebP, GIF, BMP, PPM and JPEG; what is transparent lies
    over white.
    """
    _compared.check_output(output, expected, actual)
    before, now = picture.load(expected), picture.load(actual)
    limits = verdict.Limits(pixels, delta_e, lowpass)
    found = _compared.explained(_compared.pair(before.image, now.image, limits, ignore))
    notes = _compared.made_otherwise(before.texts, now.texts)
    left = _compared.leave(found, output)
    code = _compared.CODES[found.word]
    if as_json:
        files = {"expected": expected, "actual": actual, "difference": left}
        said = {"verdict": found.word, "exit": code, **files, "made": notes, **_compared.about(found)}
        click.echo(json.dumps(said, indent=2, ensure_ascii=False))
    else:
        _compared.show(found)
        if code == 3:
            click.echo(f"  {expected} is {_size(before)}, {actual} {_size(now)}")
        for note in notes:
            click.echo(f"  {note}")
        if left:
            click.echo(f"  see {left}")
    context.exit(code)


def _size(seen: picture.Picture) -> str:
    return "x".join(map(str, seen.size))
