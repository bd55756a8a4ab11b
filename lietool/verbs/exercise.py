"""Write formulas of the book yourself, and see what is right: exercises, marks, classes."""

import importlib
import json
from pathlib import Path

import click

from lietool.verbs import _studio, _table

_JSON = click.option("--json", "as_json", is_flag=True, help="Print what a program may read.")
_FILE = click.Path(dir_okay=False, path_type=Path)
_FOLDER = click.Path(file_okay=False, path_type=Path)


# Commands with much to import, and what help says of them without that.
_LATER = {"export": "Write an assignment for another grader."}


class _Group(click.Group):
    """Its commands, and those that are imported when they are used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*super().list_commands(ctx), *_LATER]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in _LATER:
            return importlib.import_module(f"lietool.verbs._exercise_{cmd_name}").command
        return super().get_command(ctx, cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        limit = formatter.width - 6 - max(map(len, self.list_commands(ctx)))
        rows = [(name, mine.get_short_help_str(limit)) for name, mine in self.commands.items()]
        with formatter.section("Commands"):
            formatter.write_dl([*rows, *_LATER.items()])


@click.group(cls=_Group)
def command() -> None:
    """Write formulas of the book yourself, and see what is right: exercises, marks, classes.

    `lietool exercise start NAME` writes a file to fill in, `lietool exercise check` says what is right in it,
    what is not and why, and draws the picture of the book with your function.  With --project there are the
    exercises in DIR/exercises too.
    """


@command.command("list")
@_JSON
def list_(as_json: bool) -> None:
    """List the exercises in the order of the book."""
    from lietool.exercise import load
    from lietool.verbs import _exercise_show

    found = [load.load(name) for name in load.names()]
    if as_json:
        click.echo(json.dumps(list(map(_exercise_show.brief, found)), indent=2, ensure_ascii=False))
        return
    if not found:
        raise _studio.Stop(
            2, "there is no exercise. Write one: DIR/exercises/NAME.py, and give --project DIR"
        )
    heads = ("number", "name", "equations", "plate", "points", "title")
    cells = [
        (str(x.number), x.name, ", ".join(x.equations), x.picture.plate, str(x.total), x.title) for x in found
    ]
    _table.show(heads, cells)
    click.echo(f"`lietool exercise show {found[0].name}` shows one, `lietool exercise start` begins it.")


@command.command()
@click.argument("name")
@click.option("--solution", is_flag=True, help="Print a model solution instead.")
@_JSON
def show(name: str, solution: bool, as_json: bool) -> None:
    """Show what is to be written, and what is checked.

    The solution is a file that `check` takes: do look at it afterwards.
    """
    from lietool.verbs import _exercise_show

    _exercise_show.run(name, solution=solution, as_json=as_json)


@command.command()
@click.argument("name")
@click.argument("folder", metavar="[DIR]", required=False, type=_FOLDER, default=Path())
def start(name: str, folder: Path) -> None:
    """Write the file that an exercise begins with.

    It is DIR/NAME.py, without DIR in this folder.  A file that is there stays as it is.
    """
    from lietool.verbs import _exercise_show

    _exercise_show.start(name, folder)


@command.command()
# One that cannot be read is its owner's trouble, not that of the class.
@click.argument("paths", nargs=-1, metavar="[PATH]...", type=click.Path(path_type=Path, readable=False))
@click.option(
    "--exercise", "name", metavar="NAME", help="What the files are for; else their first lines say."
)
@click.option(
    "--seed", metavar="N", type=click.IntRange(0), default=0, show_default=True, help="Of random inputs."
)
@click.option(
    "-o",
    "--output",
    "pictures",
    type=_FOLDER,
    metavar="DIR",
    help="Folder for the picture. [default: beside the file; of several files none]",
)
@click.option("--report", type=_FOLDER, metavar="DIR", help="Write a page to open in a browser there.")
@click.option("--csv", type=_FILE, metavar="FILE", help="Write the marks as a table.")
@click.option(
    "-j",
    "--jobs",
    type=click.IntRange(1, 64),
    metavar="N",
    default=1,
    show_default=True,
    help="How many processes share the work.",
)
@click.option("--fresh", is_flag=True, help="Forget what earlier runs have found.")
@_JSON
@click.pass_context
def check(
    context: click.Context,
    paths: tuple[Path, ...],
    name: str | None,
    seed: int,
    pictures: Path | None,
    report: Path | None,
    csv: Path | None,
    jobs: int,
    fresh: bool,
    as_json: bool,
) -> None:
    """Say what is right in a file, what is not and why, and give marks.

    Without PATH it is what has been started in this folder.  Several files are
    a class: each is graded in a process that may hang or die without harm,
    what is found is kept as it comes, and a run that was stopped goes on where
    it was.  A file that cannot be read has no marks there.
    Ends with 0 if all is right, and with 5 if not.
    """
    from lietool.verbs import _exercise_check

    wanted = _exercise_check.Wanted(name, seed, pictures, report, csv, jobs, fresh, as_json)
    context.exit(_exercise_check.run(paths, wanted))
