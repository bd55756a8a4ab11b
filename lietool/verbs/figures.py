"""List the plates, build them, and verify or accept them against their goldens."""

import json
from pathlib import Path

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
    all its plates.  Without IDS it is all plates; with --project it
    is all of the project, and those of the book can be named.
    """


@command.command("list")
@_IDS
@_JSON
def list_(ids: tuple[str, ...], as_json: bool) -> None:
    """List plates and the state of their goldens."""
    from lietool.verbs import _figures_show

    rows = [
        {
            "plate": item.id,
            "command": item.command,
            "title": item.plate.title,
            "equations": list(item.plate.equations),
            "golden": _figures_show.state(item),
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
    from lietool.verbs import _figures_show

    described = [_figures_show.describe(item) for item in _studio.items([plate])]
    if as_json:
        click.echo(json.dumps(described, indent=2, ensure_ascii=False))
        return
    for number, about in enumerate(described):
        click.echo("\n" * (number > 0) + "\n".join(_figures_show.lines(about)))


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

    items = _to_judge(ids)
    context.exit(
        _figures_verify.run(
            items, _studio.current(), folder / "failed", as_json, everything=not ids, jobs=jobs
        )
    )


@command.command()
@_IDS
@click.option("--reason", metavar="TEXT", help="Why the pictures are right; kept with them.")
@click.option("--all", "everything", is_flag=True, help="All plates.")
@click.option(
    "--from",
    "review",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="REVIEW.JSON",
    help="What was marked in a report, each with its reason.",
)
def accept(ids: tuple[str, ...], reason: str | None, everything: bool, review: Path | None) -> None:
    """Make new goldens, and say what changed.

    Look at the pictures first: what the plates show now is what they are held
    to from now on.  Plates that have not changed at all are left alone.
    Refused (4) where the renderer is not canonical.  With --from it is what was
    marked in the page of `lietool figures report`; if a plate shows anything
    else by now, nothing is accepted (5).
    """
    from lietool.verbs import _figures_accept

    if review is not None:
        from lietool.verbs import _figures_review

        if ids or everything or reason is not None:
            raise click.UsageError("--from has the plates and their reasons. Leave out the others")
        _figures_review.run(review, _studio.current())
        return
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
@click.option("--readme", is_flag=True, help="Renew README.md and CHANGES.md beside the goldens instead.")
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
@_IDS
@click.option(
    "-o",
    "--output",
    "path",
    type=click.Path(path_type=Path),
    default=Path("out/report.html"),
    show_default=True,
    help="The file to write.",
)
@_JOBS
@click.pass_context
def report(context: click.Context, ids: tuple[str, ...], path: Path, jobs: int) -> None:
    """Compare pictures with their goldens on one page.

    One file, to open in a browser: it needs no network, and goes with any other
    file of a test run.  Pictures are swiped, blinked, subtracted and magnified
    there, numbers that changed are listed, and what is right is marked with a
    reason for `lietool figures accept --from`.  It ends as `verify` does.
    """
    from lietool.verbs import _figures_report

    items = _to_judge(ids)
    context.exit(_figures_report.run(items, _studio.current(), path, everything=not ids, jobs=jobs))


@command.command()
@_IDS
@click.option("--quick", is_flag=True, help="Only the settings farthest from each other.")
@_JOBS
@_JSON
@click.pass_context
def noise(context: click.Context, ids: tuple[str, ...], quick: bool, jobs: int, as_json: bool) -> None:
    """Draw in every harmless way; none may fail.

    Backends OSMesa and EGL, 0 to 7 threads, processors with and without SSE4.1
    and AVX, vectors of 128 and 256 bits, numpy and its BLAS as on other
    processors, and each picture again with a jitter of one grey level.  Prints
    the largest deviation from the golden against the tolerance.
    Ends with 5 if anything fails that should not.
    """
    from lietool.verbs import _figures_noise

    context.exit(_figures_noise.run(_studio.items(ids), as_json, quick=quick, jobs=jobs))


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


def _to_judge(ids: tuple[str, ...]) -> list[_studio.Item]:
    if items := _studio.items(ids):
        return items
    # A check that looks at nothing passes for ever.
    raise _studio.Stop(2, "there is no plate to compare. Write a figure first: README.md has an example")
