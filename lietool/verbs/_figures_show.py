"""`lietool figures show`: all about a plate and its golden."""

import json
from dataclasses import asdict
from typing import Any

from lietool.golden import history, store
from lietool.verbs import _studio


def state(item: _studio.Item) -> str:
    """Return "golden", or what is wrong with the golden in a word."""
    try:
        store.provenance(item.place)
    except store.GoldenError as error:
        return error.kind
    return "golden"


def describe(item: _studio.Item) -> dict[str, Any]:
    """Return all about a plate, ready for JSON."""
    try:
        golden: dict[str, str] = store.provenance(item.place)
    except store.GoldenError as error:
        golden = {"state": f"{error.kind}: {error}"}
    past = [asdict(change) for change in history.read(golden)]
    golden.pop(history.KEY, None)
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
        "history": past,
    }


def _making(item: _studio.Item) -> str:
    first = item.id == next(iter(item.declared.plates))
    return f"{item.program} {item.command}" + ("" if first else f" --plate {item.id}")


def lines(about: dict[str, Any]) -> list[str]:
    """Return what `describe` found, in lines for a reader."""
    equations = f"  (equations {', '.join(about['equations'])})" if about["equations"] else ""
    said = [f"{about['plate']}  {about['title']}{equations}", f"  {about['caption']}", ""]
    for key in ("command", "file"):
        said.append(f"  {key:<12}{about[key]}")
    for key in ("parameters", "golden"):
        said.append(f"  {key}")
        said += [f"    {name:<16}{value}" for name, value in about[key].items()]
    if about["history"]:
        said.append("  accepted")
    for change in about["history"]:
        what = f" ({change['what']})" if change["what"] else ""
        said.append(f"    {change['date']:<16}  {change['commit']}: {change['reason']}{what}")
    return said
