"""`lietool figures build`: every plate to a PNG, with a table of what came of it."""

import json
import os
import shutil
import sys
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click

from lietool import atomic
from lietool.verbs import _figures_verify, _jobs, _picture, _studio, _table


def run(
    items: Sequence[_studio.Item],
    studio: _studio.Studio,
    folder: Path,
    quality: _picture.Quality,
    as_json: bool,
    jobs: int = 1,
) -> None:
    """Make pictures and print how they compare with their goldens.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer of this process.
    folder : Path
        Where the pictures go, each as its plate's id.
    quality : Quality
        How to render; any but the usual one is not compared.
    as_json : bool
        Print JSON.
    jobs : int
        How many processes share the work.

    Raises
    ------
    Stop
        With 4 if nothing renders, with 2 if a picture cannot be written.
    """
    if jobs < 2:
        studio.require()
    work = partial(_build, folder=folder, quality=quality, studio=studio if jobs < 2 else None)
    rows = list(_jobs.each(work, items, jobs, "building"))
    if as_json:
        click.echo(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    cells = [[row["plate"], f"{row['seconds']:.2f} s", row["verdict"], row["path"]] for row in rows]
    _table.show(("plate", "time", "against golden", "path"), cells, verdict=2)
    for line in _next(items, rows):
        click.echo(line)


def _build(
    item: _studio.Item, folder: Path, quality: _picture.Quality, studio: _studio.Studio | None
) -> dict[str, Any]:
    from lietool.render import export

    studio = studio or _studio.Studio()
    studio.require()
    start = time.perf_counter()
    painted = studio.paint(item, size=quality.size, draft=quality.draft, theme=quality.theme)
    path = folder / f"{item.id}.png"
    made = _studio.provenance(item, studio.info)
    with _studio.writing(str(path)):
        atomic.write_bytes(path, export.png(painted.image, made, quality.density))
    seconds = time.perf_counter() - start
    judged = quality.comparable and not studio.trouble
    word = _figures_verify.judge(item, painted, now=made).word if judged else "not compared"
    return {"plate": item.id, "seconds": round(seconds, 3), "verdict": word, "path": str(path)}


def _next(items: Sequence[_studio.Item], rows: Sequence[dict[str, Any]]) -> list[str]:
    if not items:
        return ["No plates yet."]
    first = items[0]
    program = first.program.replace("lietool", _program(), 1)
    tries = {
        f"{program} {first.command} --help": "what to look for, and what can be changed",
        f"{program} figures show {first.id}": "where a plate and its golden come from",
        f"{program} figures verify": "judge pictures and numbers by their goldens",
    }
    width = max(map(len, tries))
    lines = ["Try next:", *(f"  {line:<{width}}  {what}" for line, what in tries.items())]
    wrong = [row["plate"] for row in rows if row["verdict"] not in ("equal", "passes", "not compared")]
    if wrong:
        lines += [
            f"Not as accepted: {', '.join(wrong)}. `{program} figures verify {' '.join(wrong[:3])}` says why."
        ]
    return lines


def _program() -> str:
    """How to call this program from here: by its name, or by its path while the environment is not active."""
    beside = Path(sys.executable).with_name("lietool")
    if shutil.which("lietool") or not beside.exists():
        return "lietool"
    return os.path.relpath(beside)
