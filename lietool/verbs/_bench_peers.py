"""`lietool bench peers`: our comparison of pictures beside others, on mistakes and on noise."""

import json
from pathlib import Path

import click


@click.command()
@click.option(
    "--npm",
    type=click.Path(path_type=Path, file_okay=False, exists=True),
    default=".",
    show_default=True,
    help="The folder in which npm has installed pixelmatch and odiff-bin.",
)
@click.option(
    "--plates",
    type=click.IntRange(1, 12),
    default=3,
    show_default=True,
    help="At most so many plates for each mistake.",
)
@click.option(
    "--mutant",
    "names",
    multiple=True,
    help="Only mistakes whose names begin so; again for more. [default: all]",
)
@click.option("--plate", "ids", multiple=True, help="Only this plate; again for more. [default: all]")
@click.option("--rules", "with_rules", is_flag=True, help="Try rules near our own too.")
@click.option(
    "-j", "--jobs", type=click.IntRange(1, 64), default=2, show_default=True, help="Processes that draw."
)
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON.")
def peers(
    npm: Path,
    plates: int,
    names: tuple[str, ...],
    ids: tuple[str, ...],
    with_rules: bool,
    jobs: int,
    as_json: bool,
) -> None:
    """Compare our comparison of pictures with others.

    The plates with mistakes in the library, as `lietool figures mutants` puts
    them there, and the plates drawn in harmless ways, as in `lietool figures noise`, go
    through each comparison at its defaults.  A mistake counts if it changes the
    picture of a plate that is known to notice it, by picture or by numbers, and
    is caught if one of its pictures fails.
    Times are for pictures of 1200x900 pixels: equal ones, a mistake that
    changes the median number of pixels, and a picture that differs everywhere; with
    files, decoding them is part of it.
    Those that are not installed are listed; nothing is fetched.  Takes a quarter of an hour on two CPUs.
    """
    from lietool.verbs import _peers_run, _peers_table, _studio

    about = _peers_run.run(npm, names, _studio.items(ids), plates=plates, with_rules=with_rules, jobs=jobs)
    if as_json:
        click.echo(json.dumps(about, indent=2, ensure_ascii=False))
    else:
        _peers_table.show(about)
