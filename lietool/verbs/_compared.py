"""Two pictures beside each other, in words for readers and programs: what `compare` and `check` share."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import click
import numpy as np

from lietool import atomic
from lietool.golden import compare, explain, picture, verdict
from lietool.render import export
from lietool.verbs import _studio, _table

CODES = {"equal": 0, "same": 0, "different": 5, "other size": 3}
"""The exit codes of verdicts."""

# What explaining a difference holds in memory is many times the pictures.
_MOST_EXPLAINED = 16_000_000
_SHOWN = 8

Boxes = Sequence[tuple[int, int, int, int]]


@dataclass(frozen=True, eq=False)
class Pair:
    """Two pictures (h, w, 3) uint8, what comparing them gave, a word for it, and where they differ."""

    expected: np.ndarray
    actual: np.ndarray
    comparison: compare.Comparison
    word: str
    places: tuple[explain.Blob, ...] = ()


def pair(expected: np.ndarray, actual: np.ndarray, limits: verdict.Limits, ignore: Boxes = ()) -> Pair:
    """Compare two pictures.

    Parameters
    ----------
    expected, actual : (h, w, 3) uint8
        The pictures.
    limits : Limits
        The tolerance.
    ignore : sequence of (x0, y0, x1, y1)
        Boxes in which they may be what they like.

    Returns
    -------
    Pair
        As yet without `places`.

    Raises
    ------
    ValueError
        If a box is not within the pictures.
    """
    if expected.shape == actual.shape:
        actual = picture.ignoring(expected, actual, ignore)
    found = compare.images(
        expected, actual, pixels=limits.pixels, delta_e=limits.delta_e, lowpass=limits.lowpass
    )
    if not found.same_size:
        return Pair(expected, actual, found, "other size")
    if found.passes:
        return Pair(expected, actual, found, "equal" if found.equal else "same")
    return Pair(expected, actual, found, "different")


def explained(found: Pair) -> Pair:
    """Find out where two pictures that are not the same differ, which takes its time.

    Parameters
    ----------
    found : Pair
        Two pictures.

    Returns
    -------
    Pair
        With `places`, unless they are the same, of other sizes, or too large for it.
    """
    if found.word != "different" or found.expected[..., 0].size > _MOST_EXPLAINED:
        return found
    places = explain.blobs(found.expected, found.actual, delta_e=found.comparison.delta_e_limit)
    return replace(found, places=tuple(places))


def show(found: Pair) -> None:
    """Print a verdict and the numbers that it rests on."""
    c = found.comparison
    click.echo(click.style(found.word, "red" if CODES[found.word] else "green"))
    if c.same_size and not c.equal:
        rows = [
            (f"pixels beyond dE {c.delta_e_limit:g}", f"{c.over}", f"{c.strewn_limit}", ""),
            ("of them in one place", f"{c.crowd}", f"{c.pixels_limit}", _at(c.crowd_at)),
            (
                "9x9 mean",
                f"{c.lowpass:+.2f} levels of {c.lowpass_channel}",
                f"{c.lowpass_limit:g}",
                _at(c.lowpass_at),
            ),
            ("largest dE", f"{c.largest_delta_e:.1f}", "", _at(c.largest_delta_e_at)),
            ("pixels that differ", f"{c.differing} of {found.expected[..., 0].size}", "", ""),
        ]
        _table.show(("", "found", "allowed", "at"), rows)
    for place in found.places[:_SHOWN]:
        click.echo(f"  {place}")
    if len(found.places) > _SHOWN:
        click.echo(f"  and {len(found.places) - _SHOWN} places more")


def about(found: Pair) -> dict[str, Any]:
    """Return all of it, ready for JSON.

    Parameters
    ----------
    found : Pair
        Two pictures.

    Returns
    -------
    dict
        ``comparison`` and ``places``.
    """
    c = found.comparison
    headroom = {"headroom_pixels": c.headroom_pixels, "headroom_lowpass": c.headroom_lowpass}
    return {"comparison": asdict(c) | headroom, "places": [asdict(place) for place in found.places]}


def leave(found: Pair, output: Path | None) -> str | None:
    """Write the picture of a difference, if one is wanted and there can be one.

    Parameters
    ----------
    found : Pair
        Two pictures.
    output : Path, optional
        Where to.

    Returns
    -------
    str or None
        The file written.

    Raises
    ------
    Stop
        With 2 if it cannot be written.
    """
    if output is None or not found.comparison.same_size:
        return None
    data = export.png(explain.amplified(found.expected, found.actual), {"Title": "difference, 16 times"})
    with _studio.writing(str(output)):
        atomic.write_bytes(output, data)
    return str(output)


def check_output(output: Path | None, *inputs: str) -> None:
    """Refuse a file for the difference that would not be one, or would overwrite what is compared.

    Parameters
    ----------
    output : Path, optional
        Where to.
    *inputs : str
        The files compared.

    Raises
    ------
    click.UsageError
        If it does not end in .png, its folder is missing, or it is one of them.
    """
    if output is None:
        return
    if output.suffix.lower() != ".png":
        raise click.UsageError(f"--output must end in .png; got {output}")
    if not output.parent.is_dir():
        raise click.UsageError(f"--output {output}: there is no folder {output.parent}. Make it first")
    if output.exists() and any(output.samefile(path) for path in inputs if Path(path).exists()):
        raise click.UsageError(f"--output {output} is a picture to compare. Choose another name")


def made_otherwise(before: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    """Say what two pictures tell of themselves that is not the same.

    Parameters
    ----------
    before, now : Mapping[str, str]
        Their texts.

    Returns
    -------
    list of str
        Sentences without a full stop; what only one of them tells is passed over.
    """
    said = []
    for key, what in (("command", "made by another command"), ("plate", "another plate")):
        if key in before and key in now and before[key] != now[key]:
            said.append(f"{what}: {key} was {before[key]}, is {now[key]}")
    if "parameters" in before and "parameters" in now:
        change = verdict.changed(before["parameters"], now["parameters"])
        said += [f"made with other parameters: {change}"] if change else []
    if change := verdict.differences_of(before, now):
        said.append(f"made by something else: {change}")
    return said


class _Limit(click.FloatRange):
    """A number from 0 on: click takes not-a-number for one, beyond which nothing lies."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Read it from its text."""
        number = super().convert(value, param, ctx)
        if np.isnan(number):
            self.fail(f"must be a number, 0 or more; got {value}", param, ctx)
        return number


LIMIT = _Limit(0.0)


class Box(click.ParamType):
    """A box in pixels, ``X0,Y0,X1,Y1``."""

    name = "box"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int, int, int]:
        """Read it from its text."""
        try:
            x0, y0, x1, y1 = (int(part) for part in str(value).split(","))
        except ValueError:
            self.fail(f"must be X0,Y0,X1,Y1 in whole pixels, such as 0,0,200,40; got {value!r}", param, ctx)
        return x0, y0, x1, y1


def _at(place: tuple[int, int] | None) -> str:
    return "" if place is None else f"({place[0]}, {place[1]})"
