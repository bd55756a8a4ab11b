"""`lietool bench speed`: time per element of every public function of `lietool.lie`."""

import json
import os

import click

from lietool.verbs import _table


@click.command()
@click.argument("which", default="", metavar="[NAME]")
@click.option("--quick", is_flag=True, help="Batches to 1000 only.")
@click.option("--json", "as_json", is_flag=True, help="Print seconds per element as JSON.")
def speed(which: str, quick: bool, as_json: bool) -> None:
    """Time the functions of lietool.lie per element.

    Batches have 1, 1000 and a million elements.
    NAME is a module or a function, such as so3 or so3.exp; without it, all.
    Each time is the median of several calls after one that is not counted,
    arguments checked, in one process; a batch that would take more than some
    seconds is left out. What a function takes is read from its docstring.
    """
    from lietool.bench import speed

    sizes = speed.SIZES[:2] if quick else speed.SIZES
    names = [name for name in speed.functions() if name.startswith(which)]
    if not names:
        raise click.UsageError(f"no function begins with {which!r}. Write for example so3")
    left_out = speed.left_out(which)
    timed = [name for name in names if name not in left_out]
    found = {name: speed.time_of(name, sizes) for name in _table.progress(timed, "timing")}
    if as_json:
        click.echo(json.dumps(found, indent=2))
        return
    click.echo(f"Time per element, {os.cpu_count()} CPUs")
    heads = ("function", *(f"of {size}" for size in sizes))
    _table.show(heads, [(name, *map(_text, times.values())) for name, times in found.items()])
    if left_out:
        click.echo(f"\nNot timed, for their arguments are not batches of numbers: {', '.join(left_out)}")


def _text(seconds: float | None) -> str:
    if seconds is None:
        return "-"
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.0f} ns"
