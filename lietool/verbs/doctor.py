"""Say what renders here, whether goldens can be judged with it, and how to mend what is missing."""

import importlib.metadata
import json
import os
import platform
import re
import sys
from pathlib import Path
from typing import Any

import click

import lietool
from lietool import cache
from lietool.render import advice, probe

_MEGABYTE = 1e6


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON.")
@click.pass_context
def command(context: click.Context, as_json: bool) -> None:
    """Say what renders here, whether goldens can be judged with it, and how to mend what is missing.

    Ends with 0 when this machine can render canonically, with 4 when it cannot.
    """
    found = examine()
    click.echo(json.dumps(found, indent=2) if as_json else "\n".join(_lines(found)))
    context.exit(0 if found["canonical"] else 4)


def examine() -> dict[str, Any]:
    """Return the state of this machine, ready for JSON.

    Returns
    -------
    dict
        ``canonical``; ``renderer`` and ``other``, what `probe.run` finds for the backend that figures use
        and for the second one; ``same_pixels`` (None where one of them fails); ``mend``, what to
        do, most useful first; and ``python``, ``packages``, ``system``, ``cpu``, ``cache``.
    """
    renderer = probe.run()
    other = probe.run("osmesa" if renderer.get("backend") == "egl" else "egl")
    both = "error" not in renderer and "error" not in other
    found = {
        "canonical": renderer.get("canonical", False),
        "renderer": renderer,
        "other": other,
        "same_pixels": renderer["picture"] == other["picture"] if both else None,
        "python": {"version": platform.python_version(), "path": sys.executable},
        "packages": packages(),
        "system": advice.distribution().get("PRETTY_NAME") or platform.platform(),
        "cpu": _cpu(),
        "cache": _cache(),
    }
    return found | {"mend": _mend(found)}


def packages() -> dict[str, str | None]:
    """Return the versions of lietool and of what it needs.

    Returns
    -------
    dict of str
        By the name of the distribution; None where it is not installed.
    """
    versions: dict[str, str | None] = {"lietool": lietool.__version__}
    try:
        wanted = importlib.metadata.requires("lietool") or []
    except importlib.metadata.PackageNotFoundError:
        return versions
    for requirement in wanted:
        name = re.match(r"[\w.-]+", requirement)
        if name is None or "extra ==" in requirement:
            continue
        try:
            versions[name[0]] = importlib.metadata.version(name[0])
        except importlib.metadata.PackageNotFoundError:
            versions[name[0]] = None
    return versions


def _mend(found: dict[str, Any]) -> list[str]:
    if found["renderer"].get("canonical"):
        return []
    asked = [name for name in ("LIETOOL_BACKEND", "GALLIUM_DRIVER") if os.environ.get(name)]
    steps = [f"unset {name}    (it is {os.environ[name]!r})" for name in asked]
    missing = [name for name, version in found["packages"].items() if version is None]
    if missing:
        steps.append(f"{sys.executable} -m pip install {' '.join(missing)}")
    if steps and ("renderer" in found["renderer"] or found["other"].get("canonical")):
        return steps
    if not sys.platform.startswith("linux"):
        return [
            *steps,
            "judge goldens on Linux, in a container for example: the OpenGL of this system only draws",
        ]
    return [*steps, *advice.commands().values()]


def _cpu() -> dict[str, Any]:
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        text = ""
    fields = dict(re.findall(r"^(model name|flags)\s*:\s*(.*)$", text, re.MULTILINE))
    flags = set(fields.get("flags", "").split())
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {
        "model": fields.get("model name") or platform.processor() or platform.machine(),
        "cores": usable,
        "vectors": [name for name in ("sse2", "sse4_1", "avx", "avx2", "avx512f") if name in flags],
    }


def _cache() -> dict[str, Any]:
    used = cache.folder()
    parts = (
        {} if used is None else {part.name: _size(part) for part in sorted(used.iterdir()) if part.is_dir()}
    )
    return {
        "wanted": str(cache.wanted()),
        "used": used and str(used),
        "writable": used is not None,
        "bytes": parts,
    }


def _size(folder: Path) -> int:
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def _lines(found: dict[str, Any]) -> list[str]:
    rows = [
        *_renderer_rows(found["renderer"]),
        (
            "canonical",
            "yes: goldens can be made and judged here"
            if found["canonical"]
            else "NO: goldens can be neither made nor judged here",
        ),
        ("second way", _second_way(found)),
        ("system", found["system"]),
        (
            "cpu",
            "{model}, {cores} cores, {flags}".format(**found["cpu"], flags=" ".join(found["cpu"]["vectors"])),
        ),
        ("python", "{version} ({path})".format(**found["python"])),
        (
            "packages",
            ", ".join(f"{name} {version or 'MISSING'}" for name, version in found["packages"].items()),
        ),
        *_cache_rows(found["cache"]),
    ]
    lines = [f"{name:<12}{value}" for name, value in rows]
    if found["mend"]:
        first, *others = found["mend"]
        lines += ["", "To mend it:", f"  {first}", *(f"  or  {other}" for other in others)]
    return lines


def _renderer_rows(renderer: dict[str, Any]) -> list[tuple[str, str]]:
    if "error" in renderer:
        return [("renderer", f"NONE: {renderer['error']}")]
    versions = (("Mesa", renderer["mesa"]), ("LLVM", renderer["llvm"]))
    rows = [
        ("backend", renderer["backend"]),
        ("renderer", f"{renderer['renderer']}, by {renderer['vendor']}"),
        ("OpenGL", renderer["version"]),
        ("versions", ", ".join(f"{name} {version}" for name, version in versions if version) or "not told"),
    ]
    rows += [("library" if not i else "", path) for i, path in enumerate(renderer["libraries"])]
    rows += [("skipped", f"{backend}: {reason}") for backend, reason in renderer["skipped"].items()]
    return rows + [("note", note) for note in renderer["notes"]]


def _second_way(found: dict[str, Any]) -> str:
    other = found["other"]
    if "error" in other:
        reasons = [f"{backend}: {reason}" for backend, reason in other.get("skipped", {}).items()]
        return f"none ({'; '.join(reasons) or other['error']})"
    pixels = {True: "the same pixels", False: "OTHER PIXELS", None: "nothing to compare with"}
    return f"{other['backend']}: {other['renderer']}, {pixels[found['same_pixels']]}"


def _cache_rows(found: dict[str, Any]) -> list[tuple[str, str]]:
    if found["used"] is None:
        return [("cache", f"none: {found['wanted']} cannot be written; every run compiles its shaders")]
    parts = ", ".join(f"{name} {size / _MEGABYTE:.1f} MB" for name, size in found["bytes"].items())
    elsewhere = "" if found["used"] == found["wanted"] else f"; {found['wanted']} cannot be written"
    return [("cache", f"{found['used']} ({parts or 'empty'}{elsewhere})")]
