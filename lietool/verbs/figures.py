"""List the plates, build them, and verify or accept them against their goldens."""

import json
from pathlib import Path
from typing import Any

import click

from lietool.verbs import _command, _picture, _size, _studio, _table

_IDS = click.argument("ids", nargs=-1, metavar="[IDS]...")
_JSON = click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
_OUT = click.option(
    "-o",
    "--output",
    "folder",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("out"),
    show_default=True,
    help="Folder for what is made.",
)
_JOBS = click.option(
    "-j",
    "--jobs",
    type=click.IntRange(1, 64),
    metavar="N",
    default=1,
    show_default=True,
    help="How many processes share the work.",
)


@click.group()
def command() -> None:
    """List the plates, build them, and verify or accept them against their goldens.

    IDS are plates such as B2.8, in any case; a command such as slerp stands for
    all its plates.  Without IDS it is all plates.
    """


@command.command("list")
@_IDS
@_JSON
def list_(ids: tuple[str, ...], as_json: bool) -> None:
    """List plates and the state of their goldens."""
    rows = [
        {
            "plate": item.id,
            "command": item.command,
            "title": item.plate.title,
            "equations": list(item.plate.equations),
            "golden": _state(item),
        }
        for item in _studio.items(ids)
    ]
    if as_json:
        click.echo(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    heads = ("plate", "command", "golden", "equations", "title")
    cells = [[", ".join(v) if isinstance(v := row[head], list) else v for head in heads] for row in rows]
    _table.show(heads, cells, verdict=2)


@command.command()
@click.argument("plate", metavar="ID")
@_JSON
def show(plate: str, as_json: bool) -> None:
    """Show all about a plate and its golden."""
    described = [_describe(item) for item in _studio.items([plate])]
    if as_json:
        click.echo(json.dumps(described, indent=2, ensure_ascii=False))
        return
    for number, about in enumerate(described):
        click.echo("\n" * (number > 0) + "\n".join(_lines(about)))


@command.command()
@_IDS
@_OUT
@click.option("--draft", is_flag=True, help="2x2 samples a pixel instead of 3x3; not compared.")
@click.option("--theme", type=_command.THEME, default="book", help="Any but book is not compared.")
@click.option("--size", metavar="SIZE", type=_command.SIZE, help="Pixels or a length, 8.5cm; not compared.")
@click.option("--dpi", metavar="N", type=_command.DPI, help="Dots per inch, where --size is a length.")
@_JOBS
@_JSON
def build(
    ids: tuple[str, ...],
    folder: Path,
    draft: bool,
    theme: str,
    size: _size.Size | None,
    dpi: float | None,
    jobs: int,
    as_json: bool,
) -> None:
    """Make the pictures and compare them.

    This reports and does not judge: a picture that differs is not an error here.
    `lietool figures verify` judges.
    """
    from lietool.verbs import _figures_build

    quality = _picture.Quality(size, dpi, theme, draft)
    quality.check(".png")
    _figures_build.run(_studio.items(ids), _studio.current(), folder, quality, as_json, jobs)


@command.command()
@_IDS
@_OUT
@_JOBS
@_JSON
@click.pass_context
def verify(context: click.Context, ids: tuple[str, ...], folder: Path, jobs: int, as_json: bool) -> None:
    """Judge pictures and numbers by their goldens.

    A golden is never written by this.
    Ends with 0 if all are as accepted; 3 if a golden is missing, belongs to no
    plate, is damaged or of another size, or lacks a label; 4 if this machine
    cannot render as the goldens were; 5 if a picture, its numbers or its
    parameters differ.  With several it is 4 before 3 before 5.  Expected,
    actual and difference of a failure are left in out/failed/.
    """
    from lietool.verbs import _figures_verify

    items = _studio.items(ids)
    context.exit(
        _figures_verify.run(
            items, _studio.current(), folder / "failed", as_json, everything=not ids, jobs=jobs
        )
    )


@command.command()
@_IDS
@click.option("--reason", metavar="TEXT", help="Why the pictures are right; kept with them.")
@click.option("--all", "everything", is_flag=True, help="All plates.")
def accept(ids: tuple[str, ...], reason: str | None, everything: bool) -> None:
    """Make new goldens, and say what changed.

    Look at the pictures first: what the plates show now is what they are held
    to from now on.  Plates that have not changed at all are left alone.
    Refused (4) where the renderer is not canonical.
    """
    from lietool.verbs import _figures_accept

    if not reason or not reason.strip():
        raise click.UsageError('accept needs a reason, which is kept with the golden: --reason "..."')
    if bool(ids) == everything:
        raise click.UsageError("accept needs plates, or --all for all of them, not both.")
    _figures_accept.run(_studio.items(ids), _studio.current(), " ".join(reason.split()))


@command.command()
@_IDS
@click.option(
    "-o",
    "--output",
    "folder",
    type=click.Path(path_type=Path),
    default=Path("out/gallery"),
    show_default=True,
    help="Folder for the page.",
)
@click.option("--golden", is_flag=True, help="Take the accepted pictures and draw nothing.")
@click.option("--readme", is_flag=True, help="Renew the README.md beside the goldens instead.")
@_JOBS
def gallery(ids: tuple[str, ...], folder: Path, golden: bool, readme: bool, jobs: int) -> None:
    """Make a page of the plates, to open in a browser.

    With pictures drawn now, light and dark, captions, equations, commands,
    parameters and numbers; it needs no network.  A folder that holds an older
    page is renewed, one that holds anything else is refused.
    """
    from lietool.verbs import _figures_gallery

    if not readme:
        _figures_gallery.run(_studio.items(ids), _studio.current(), folder, golden=golden, jobs=jobs)
        return
    if ids or golden:
        raise click.UsageError("--readme is for all plates. Leave out the others and --golden")
    changed = _figures_gallery.write_readme(_studio.items())
    click.echo("\n".join(map(str, changed)) or "nothing has changed")


@command.command()
@click.argument("names", nargs=-1, metavar="[NAMES]...")
@click.option("--plate", "ids", metavar="ID", multiple=True, help="Try them on this only; may be repeated.")
@click.option("--list", "listing", is_flag=True, help="List the catalogue and try nothing.")
@click.option("--quick", is_flag=True, help="A sample, within 50 seconds.")
@click.option("--seed", metavar="N", type=click.IntRange(0), default=0, help="Of the sample.")
@click.option("--fresh", is_flag=True, help="Use nothing that earlier runs have found.")
@click.option("--every", is_flag=True, help="Also plates that are left out where many others notice.")
@click.option("--record", is_flag=True, help="Keep what a whole run finds with the catalogues.")
@_JOBS
@_JSON
@click.pass_context
def mutants(
    context: click.Context,
    names: tuple[str, ...],
    ids: tuple[str, ...],
    listing: bool,
    quick: bool,
    seed: int,
    fresh: bool,
    every: bool,
    record: bool,
    jobs: int,
    as_json: bool,
) -> None:
    """Put mistakes into the library, and see whether the plates notice.

    NAMES are what names of mutants begin with, such as "so3.", or a module;
    without them it is the whole catalogue.  Each is tried by itself, in a process
    of its own, on the plates that execute what it changes, against the
    plates without a mistake, until six pictures have noticed.  What was found is kept, so that a run that is
    stopped goes on where it was.
    Ends with 5 if one that changes a plate is noticed by none, if one that moves
    something by 0.35 pixel is not noticed by a picture, or if the catalogue is
    wrong about which are harmless.
    """
    from lietool.verbs import _figures_mutants

    if listing:
        _figures_mutants.listed(names, as_json)
        return
    wanted = _figures_mutants.Wanted(names, jobs, quick, seed, fresh, every, record, as_json)
    context.exit(_figures_mutants.run(_studio.items(ids), wanted))


def _state(item: _studio.Item) -> str:
    from lietool.golden import store

    try:
        store.provenance(item.place)
    except store.GoldenError as error:
        return error.kind
    return "golden"


def _describe(item: _studio.Item) -> dict[str, Any]:
    from lietool.golden import store

    try:
        golden: dict[str, str] = store.provenance(item.place)
    except store.GoldenError as error:
        golden = {"state": f"{error.kind}: {error}"}
    code = item.figure.function.__code__
    return {
        "plate": item.id,
        "title": item.plate.title,
        "caption": item.plate.caption,
        "equations": list(item.plate.equations),
        "command": _making(item),
        "parameters": json.loads(item.recorded),
        "file": f"{item.figure.file}:{code.co_firstlineno}",
        "golden": {"file": str(item.place.png), **golden},
    }


def _making(item: _studio.Item) -> str:
    first = item.id == next(iter(item.declared.plates))
    return f"lietool {item.command}" + ("" if first else f" --plate {item.id}")


def _lines(about: dict[str, Any]) -> list[str]:
    equations = f"  (equations {', '.join(about['equations'])})" if about["equations"] else ""
    lines = [f"{about['plate']}  {about['title']}{equations}", f"  {about['caption']}", ""]
    for key in ("command", "file"):
        lines.append(f"  {key:<12}{about[key]}")
    for key in ("parameters", "golden"):
        lines.append(f"  {key}")
        lines += [f"    {name:<16}{value}" for name, value in about[key].items()]
    return lines
