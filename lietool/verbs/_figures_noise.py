"""`lietool figures noise`: what is harmless must not fail, so every plate is drawn in every harmless way."""

import json
import signal
import subprocess
import tempfile
import threading
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from lietool.golden import compare, store
from lietool.render import probe
from lietool.verbs import _noise_settings as settings
from lietool.verbs import _noise_worker as worker
from lietool.verbs import _studio, _table

_HEADS = ("plate", "noise", "differ", "beyond dE", "in one place", "9x9 mean", "most of all with")


@dataclass(frozen=True)
class Row:
    """What one way to draw a plate gave: how far from its golden, and whether that passes.

    `numbers` are those that differ, `trouble` is what kept it from being drawn.
    """

    plate: str
    setting: str
    jitter: bool = False
    differing: int = 0
    over: int = 0
    crowd: int = 0
    lowpass: float = 0.0
    passes: bool = True
    numbers: tuple[str, ...] = ()
    trouble: str = ""

    @property
    def alarm(self) -> bool:
        """Whether a reader would be called for nothing."""
        return not self.passes or bool(self.numbers or self.trouble)


def run(items: Sequence[_studio.Item], as_json: bool, *, quick: bool, jobs: int) -> int:
    """Draw plates in every harmless way and print how far each is from its golden.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    as_json : bool
        Print JSON.
    quick : bool
        Only the settings that are farthest from each other.
    jobs : int
        How many processes share the work.

    Returns
    -------
    int
        0, or 5 if there is any alarm.

    Raises
    ------
    Stop
        With 3 if a golden is missing or not whole, with 4 if no canonical renderer works.
    """
    for item in items:
        try:
            store.provenance(item.place)
        except store.GoldenError as error:
            raise _studio.Stop(3, f"{item.id}: {error}") from None
    backends, left_out = available()
    ways = settings.few(backends) if quick else settings.every(backends)
    rows = _measure(items, ways, jobs)
    alarms = [row for row in rows if row.alarm]
    if as_json:
        about = {
            "settings": list(map(str, ways)),
            "left_out": left_out,
            "pictures": len(rows),
            "alarms": [vars(row) for row in alarms],
            "plates": [_worst(item, rows) for item in items],
        }
        click.echo(json.dumps(about, indent=2, ensure_ascii=False))
    else:
        _print(items, rows, ways, left_out)
    return 5 if alarms else 0


def available() -> tuple[list[str], dict[str, str]]:
    """Find the backends that are llvmpipe here, and why the others are left out; stops where none is."""
    found, left_out = [], {}
    for backend in settings.BACKENDS:
        told = probe.run(backend, env=settings.environment(settings.Setting(backend), ""))
        if told.get("canonical"):
            found.append(backend)
        else:
            left_out[backend] = told.get("error") or f"it is {told.get('renderer')}, not llvmpipe"
    if not found:
        reasons = "; ".join(f"{name}: {why}" for name, why in left_out.items())
        raise _studio.Stop(
            4, f"no renderer that goldens can be judged with ({reasons}). See `lietool doctor`"
        )
    return found, left_out


def _measure(items: Sequence[_studio.Item], ways: Sequence[settings.Setting], jobs: int) -> list[Row]:
    rows = []
    with tempfile.TemporaryDirectory(prefix="lietool-noise-") as folder, Crew(jobs) as crew:
        drawn = {name: Path(folder, name) for name in dict.fromkeys(way.computing for way in ways)}
        plates = [item.id for item in items]
        tasks = []
        for name, place in drawn.items():
            place.mkdir()
            way = settings.Setting(backend=ways[0].backend, computing=name)
            tasks.append((way, {"do": "compute", "plates": plates, "folder": str(place)}))
        for way, told in crew.each(tasks, folder, "computing"):
            rows += [
                Row(plate, str(way), numbers=tuple(x.get("numbers", ())), trouble=x.get("trouble", ""))
                for plate, x in told.items()
            ]
        # What could not be computed is an alarm already, and there is nothing to render.
        failed = {(row.plate, row.setting) for row in rows if row.trouble}
        tasks = []
        for way in ways:
            computed = str(settings.Setting(backend=ways[0].backend, computing=way.computing))
            left = [plate for plate in plates if (plate, computed) not in failed]
            tasks.append((way, {"do": "render", "plates": left, "folder": str(drawn[way.computing])}))
        for way, told in crew.each([task for task in tasks if task[1]["plates"]], folder, "rendering"):
            for plate, x in told.items():
                if "trouble" in x:
                    rows.append(Row(plate, str(way), trouble=x["trouble"]))
                else:
                    rows += [
                        Row(plate, str(way), name == "jitter", **x[name]) for name in ("plain", "jitter")
                    ]
    return rows


class Crew:
    """Processes that draw, a few at a time; none outlives the block."""

    def __init__(self, jobs: int) -> None:
        self._pool = ThreadPoolExecutor(jobs)
        self._running: set[subprocess.Popen[str]] = set()
        self._lock, self._over = threading.Lock(), False

    def __enter__(self) -> "Crew":
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._over = True
            for process in self._running:
                process.kill()
        self._pool.shutdown(cancel_futures=True)

    def each(
        self, tasks: Sequence[tuple[settings.Setting, dict[str, Any]]], folder: str, doing: str
    ) -> Iterator[tuple[settings.Setting, dict[str, dict[str, Any]]]]:
        """Do tasks, and yield of each what was told of every plate, in order."""
        promised = [self._pool.submit(self._do, way, task, folder) for way, task in tasks]
        for (way, _), promise in zip(tasks, _table.progress(promised, doing), strict=True):
            yield way, promise.result()

    def _do(self, way: settings.Setting, task: Mapping[str, Any], folder: str) -> dict[str, dict[str, Any]]:
        shaders = Path(folder, way.shaders)
        shaders.mkdir(exist_ok=True)
        left, told = list(task["plates"]), {}
        while left:
            found, trouble = self._once(way, {**task, "plates": left}, str(shaders))
            told |= found
            left = [plate for plate in left if plate not in found]
            if left and trouble:
                # It died at the first that it did not tell of; the others may be well.
                told[left.pop(0)] = {"trouble": trouble}
        return {plate: told[plate] for plate in task["plates"]}

    def _once(self, way: settings.Setting, task: dict[str, Any], shaders: str) -> tuple[dict[str, Any], str]:
        with self._lock:
            if self._over:
                return {}, "ended"
            process = subprocess.Popen(
                worker.start(task),
                env=settings.environment(way, shaders) | {"OPENBLAS_NUM_THREADS": "1"},
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            self._running.add(process)
        out, errors = process.communicate()
        with self._lock:
            self._running.discard(process)
        found = {}
        for line in out.splitlines():
            about = json.loads(line)
            found[about.pop("plate")] = about
        if process.returncode == 0:
            return found, ""
        if process.returncode < 0:
            return found, f"crashed with {signal.Signals(-process.returncode).name}"
        return found, (errors.strip().splitlines() or [f"ended with {process.returncode}"])[-1]


def _worst(item: _studio.Item, rows: Sequence[Row]) -> dict[str, Any]:
    """The largest deviations of a plate, and where they were."""
    mine = [row for row in rows if row.plate == item.id]
    far, near, wide = (max(mine, key=lambda row: getattr(row, key)) for key in ("over", "crowd", "lowpass"))
    tolerance = item.plate.tolerance
    return {
        "plate": item.id,
        "pictures": len(mine),
        "equal": sum(not row.differing for row in mine if not row.jitter),
        "differing": max(row.differing for row in mine if not row.jitter),
        "over": far.over,
        "over_limit": max(compare.STREWN, tolerance.pixels),
        "over_at": _at(far) if far.over else "",
        "crowd": near.crowd,
        "crowd_limit": tolerance.pixels,
        "crowd_at": _at(near) if near.crowd else "",
        "lowpass": wide.lowpass,
        "lowpass_limit": tolerance.lowpass,
        "lowpass_at": _at(wide) if wide.lowpass else "",
        "alarms": sum(row.alarm for row in mine),
    }


def _at(row: Row) -> str:
    return row.setting + (", jitter" if row.jitter else "")


def _print(
    items: Sequence[_studio.Item],
    rows: Sequence[Row],
    ways: Sequence[settings.Setting],
    left_out: Mapping[str, str],
) -> None:
    cells = []
    for item in items:
        worst = _worst(item, rows)
        cells.append(
            [
                worst["plate"],
                "alarm" if worst["alarms"] else "passes",
                f"{worst['differing']} px",
                f"{worst['over']} of {worst['over_limit']}",
                f"{worst['crowd']} of {worst['crowd_limit']}",
                f"{worst['lowpass']:.2f} of {worst['lowpass_limit']:g}",
                worst["crowd_at"] or worst["lowpass_at"],
            ]
        )
    _table.show(_HEADS, cells, verdict=1)
    alarms = [row for row in rows if row.alarm]
    said = defaultdict(list)
    for row in alarms:
        why = f"{row.over} px, {row.crowd} in one place, 9x9 mean {row.lowpass:.2f}"
        said[row.plate].append(f"{_at(row)}: " + (row.trouble or "; ".join(row.numbers) or why))
    for plate, lines in said.items():
        click.echo("\n".join([plate, *(f"  {line}" for line in lines)]))
    for backend, why in left_out.items():
        click.echo(f"left out: {backend}: {why}")
    plain = sum(not row.jitter for row in rows)
    click.echo(
        f"{len(items)} plates in {len(ways)} ways, {plain} drawn and {len(rows) - plain} with jitter:"
        f" {len(alarms)} alarms."
    )
