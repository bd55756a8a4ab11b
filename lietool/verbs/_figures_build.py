"""`lietool figures build`: every plate to a PNG, with a table of what came of it."""

import json
import os
import shutil
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import click

from lietool import atomic
from lietool.verbs import _figures_verify, _studio, _table


def run(
    items: Sequence[_studio.Item],
    studio: _studio.Studio,
    folder: Path,
    size: tuple[int, int] | None,
    draft: bool,
    as_json: bool,
) -> None:
    """Make pictures and print how they compare with their goldens.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer.
    folder : Path
        Where the pictures go, each as its plate's id.
    size : tuple of int, optional
        Another size than the picture's own, in pixels.
    draft : bool
        With fewer samples.
    as_json : bool
        Print JSON.

    Raises
    ------
    Stop
        With 4 if nothing renders, with 2 if a picture cannot be written.
    """
    from lietool.render import export

    studio.require()
    comparable = size is None and not draft and not studio.trouble
    rows = []
    for item in _table.progress(items, "building"):
        start = time.perf_counter()
        painted = studio.paint(item, size=size, draft=draft)
        path = folder / f"{item.id}.png"
        made = _studio.provenance(item, studio.info)
        with _studio.writing(str(path)):
            atomic.write_bytes(path, export.png(painted.image, made))
        seconds = time.perf_counter() - start
        word = _figures_verify.judge(item, painted).word if comparable else "not compared"
        rows.append({"plate": item.id, "seconds": round(seconds, 3), "verdict": word, "path": str(path)})
    if as_json:
        click.echo(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    cells = [[row["plate"], f"{row['seconds']:.2f} s", row["verdict"], row["path"]] for row in rows]
    _table.show(("plate", "time", "against golden", "path"), cells, verdict=2)
    for line in _next(items, rows, comparable):
        click.echo(line)


def _next(items: Sequence[_studio.Item], rows: Sequence[dict], comparable: bool) -> list[str]:
    if not items:
        return ["No plates yet."]
    first = items[0]
    program = _program()
    tries = {
        f"{program} {first.command} --help": "what to look for, and what can be changed",
        f"{program} figures show {first.id}": "where a plate and its golden come from",
        f"{program} figures verify": "judge pictures and numbers by their goldens",
    }
    width = max(map(len, tries))
    lines = ["Try next:", *(f"  {line:<{width}}  {what}" for line, what in tries.items())]
    wrong = [row["plate"] for row in rows if row["verdict"] not in ("equal", "passes")]
    if comparable and wrong:
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
