"""Trying mutants: references first, then the lines that each plate executes, then mutant by mutant."""

import hashlib
import json
import shutil
import tempfile
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from lietool import atomic, cache, figure, paths
from lietool.mutation import process, reference
from lietool.mutation.mutant import Mutant
from lietool.mutation.score import Outcome, Tried
from lietool.verbs import _mutants_work, _studio, _table

# What every process needs.
_PRELOADED = (
    *("numpy", "scipy.linalg", "scipy.sparse.linalg", "scipy.sparse.csgraph", "scipy.spatial"),
    *("scipy.optimize", "PIL.PngImagePlugin", "click", "lietool.verbs._studio"),
    *("lietool.verbs._mutants_work", "lietool.render.draw", "lietool.golden.compare"),
)
# Seconds that a plate has at least, and how many times as long as without a mistake.
_LEAST, _TIMES = 20.0, 12.0
# And that a plate without a mistake has.
_LONGEST = 600.0


@dataclass(frozen=True)
class Order:
    """How mutants are tried.

    Parameters
    ----------
    jobs : int
        How many processes there are at a time.
    fresh : bool
        Whether what is kept of earlier runs is left alone.
    until : float
        When, by `time.monotonic`, no further mutant is begun.
    enough : int
        A mutant that so many plates notice by the picture is not tried on others.
    plates : Mapping[str, Collection of str], optional
        For each mutant's name the plates to try it on; without it all that execute what it changes.
    """

    jobs: int = 1
    fresh: bool = False
    until: float = float("inf")
    enough: int = 6
    plates: Mapping[str, Collection[str]] | None = None


@dataclass(frozen=True)
class Done:
    """What came of it: the mutants that were tried, in their order, and how long each plate takes."""

    tried: tuple[Tried, ...]
    seconds: Mapping[str, float]


def run(mutants: Sequence[Mutant], items: Sequence[_studio.Item], order: Order) -> Done:
    """Try mutants on plates.

    Parameters
    ----------
    mutants : sequence of Mutant
    items : sequence of Item
    order : Order

    Returns
    -------
    Done
        Without the mutants that were not begun in time.

    Raises
    ------
    Stop
        With 4 if nothing renders as the goldens were, with 2 if a plate cannot be drawn even without
        a mistake.
    """
    with ExitStack() as stack:
        folder = _folder(order.fresh, stack)
        wanted = set().union(*order.plates.values()) if order.plates else {item.id for item in items}
        items = [item for item in items if item.id in wanted]
        references = _references(items, folder, order)
        if order.plates is None:
            lines = _lines(items, references, folder, order)
            chosen = {mutant: _touched(mutant, items, lines) for mutant in mutants}
        else:
            named = order.plates
            chosen = {m: [i for i in items if i.id in named[m.name]] for m in mutants if m.name in named}
        seconds = {plate: sum(made.seconds) for plate, made in references.items()}
        # Where there was no time for a reference, nothing can be compared with it.
        chosen = {
            m: _turns(m, [i for i in plates if i.id in seconds], seconds) for m, plates in chosen.items()
        }
        return Done(tuple(_try(chosen, references, folder, order)), seconds)


def _folder(fresh: bool, stack: ExitStack) -> Path:
    """Where references and results are kept: a folder for each checkout and project."""
    kept = None if fresh else cache.folder("mutants")
    if kept is None:
        made = Path(tempfile.mkdtemp(prefix="lietool-mutants-"))
        stack.callback(shutil.rmtree, made, ignore_errors=True)
        return made
    where = hashlib.sha256(f"{paths.PACKAGE}\n{figure.project()}".encode()).hexdigest()[:12]
    folder = kept / where
    folder.mkdir(exist_ok=True)
    return folder


def _references(items: Sequence[_studio.Item], folder: Path, order: Order) -> dict[str, reference.Reference]:
    found = {item.id: reference.read(_mutants_work.file(folder, item.id)) for item in items}
    stale = [item for item in items if not ((kept := found[item.id]) and kept.current)]
    jobs = [process.Job(i.id, _mutants_work.refer, ([i], folder), {i.id: _LONGEST}) for i in stale]
    # Half of the time is for the mutants.
    half = time.monotonic() + 0.5 * (order.until - time.monotonic())
    for news in _shown(jobs, replace(order, until=half), "drawing without mistakes"):
        if news.failure:
            raise _studio.Stop(2, f"{news.step} cannot be drawn even without a mistake: {news.failure[1]}")
        if news.value:
            raise _studio.Stop(4, news.value)
        found[news.step] = reference.read(_mutants_work.file(folder, news.step))
    return {plate: made for plate, made in found.items() if made is not None}


def _lines(
    items: Sequence[_studio.Item],
    references: Mapping[str, reference.Reference],
    folder: Path,
    order: Order,
) -> dict[str, dict[str, list[int]]]:
    """By plate and module, the lines that run; kept beside the references."""
    lines = {}
    unknown = []
    for item in items:
        kept = _json(folder / f"{item.id}.lines.json")
        if kept.get("edition") == references[item.id].edition:
            lines[item.id] = kept["lines"]
        else:
            unknown.append(item)
    jobs = [process.Job(i.id, _mutants_work.follow, ([i],), {i.id: _LONGEST}) for i in unknown]
    for news in _shown(jobs, order, "following"):
        if news.failure:
            raise _studio.Stop(2, f"{news.step} cannot be followed: {news.failure[1]}")
        lines[news.step] = news.value
        kept = {"edition": references[news.step].edition, "lines": news.value}
        atomic.write_bytes(folder / f"{news.step}.lines.json", json.dumps(kept).encode())
    return lines


def _touched(
    mutant: Mutant, items: Sequence[_studio.Item], lines: Mapping[str, Mapping[str, Sequence[int]]]
) -> list[_studio.Item]:
    changed = mutant.lines
    return [item for item in items if changed.intersection(lines[item.id].get(mutant.module, ()))]


def _turns(mutant: Mutant, items: Sequence[_studio.Item], seconds: Mapping[str, float]) -> list[_studio.Item]:
    """Sort plates: the cheapest of every command and then the others, commands in another order each time.

    So every command meets some mutants, though six plates are enough for each.
    """

    def lot(item: _studio.Item) -> str:
        return hashlib.sha256(f"{mutant.name}\n{item.command}".encode()).hexdigest()

    ranked = sorted(items, key=lambda item: seconds[item.id])
    first = {item.command: item for item in reversed(ranked)}
    return sorted(ranked, key=lambda item: (first[item.command] != item, lot(item)))


def _try(
    chosen: Mapping[Mutant, Sequence[_studio.Item]],
    references: Mapping[str, reference.Reference],
    folder: Path,
    order: Order,
) -> list[Tried]:
    outcomes = {mutant.name: _known(mutant, items, references, folder) for mutant, items in chosen.items()}
    jobs = []
    for mutant, items in chosen.items():
        known = outcomes[mutant.name]
        left = _left(items, known, order)
        if left:
            enough = order.enough - sum(outcome.picture for outcome in known.values())
            steps = {item.id: _LEAST + _TIMES * sum(references[item.id].seconds) for item in left}
            work = (mutant, left, folder, enough)
            jobs.append(process.Job(mutant.name, _mutants_work.attempt, work, steps))
    by_name = {mutant.name: mutant for mutant in chosen}
    for news in _shown(jobs, order, "trying mutants"):
        found = outcomes[news.job.key]
        found[news.step] = _outcome(news)
        if news.last:
            _keep(by_name[news.job.key], found, references, folder)
    sampled = order.plates is not None
    return [
        Tried(mutant, _in_order(items, outcomes[mutant.name]), sampled)
        for mutant, items in chosen.items()
        if outcomes[mutant.name] or not (items or sampled)
    ]


def _left(items: Sequence[_studio.Item], known: Mapping[str, Outcome], order: Order) -> list[_studio.Item]:
    """What is still to be tried of a mutant, after what earlier runs have found."""
    if any(outcome.ended for outcome in known.values()):
        return []
    enough = sum(outcome.picture for outcome in known.values()) >= order.enough
    return [i for i in items if i.id not in known or (known[i.id].skipped and not enough)]


def _in_order(items: Sequence[_studio.Item], found: Mapping[str, Outcome]) -> tuple[Outcome, ...]:
    return tuple(found[i.id] for i in items if i.id in found and not found[i.id].skipped)


def _outcome(news: process.News) -> Outcome:
    if not news.failure:
        return news.value
    kind, says = news.failure
    failure = "hangs" if kind == "hangs" else "undrawn"
    return Outcome(news.step, changed=True, failure=failure, displacement=None, says=says, ended=True)


def _shown(jobs: Sequence[process.Job], order: Order, doing: str) -> Iterator[process.News]:
    """Do jobs, with a progress bar that goes on when one has ended."""
    bar = iter(_table.progress(jobs, doing))
    next(bar, None)
    for news in process.run(jobs, order.jobs, order.until, _PRELOADED):
        yield news
        if news.last:
            next(bar, None)
    for _ in bar:
        pass


def _digest(mutant: Mutant) -> str:
    return hashlib.sha256(json.dumps([mutant.module, mutant.old, mutant.new]).encode()).hexdigest()[:16]


def _known(
    mutant: Mutant,
    items: Sequence[_studio.Item],
    references: Mapping[str, reference.Reference],
    folder: Path,
) -> dict[str, Outcome]:
    """What earlier runs found and still holds."""
    kept = _json(folder / f"mutant-{_digest(mutant)}.json")
    return {
        item.id: Outcome(**kept[item.id]["outcome"])
        for item in items
        if item.id in kept and kept[item.id]["edition"] == references[item.id].edition
    }


def _keep(
    mutant: Mutant,
    outcomes: Mapping[str, Outcome],
    references: Mapping[str, reference.Reference],
    folder: Path,
) -> None:
    file = folder / f"mutant-{_digest(mutant)}.json"
    kept = _json(file) | {
        plate: {"edition": references[plate].edition, "outcome": asdict(outcome)}
        for plate, outcome in outcomes.items()
    }
    atomic.write_bytes(file, json.dumps(kept).encode())


def _json(file: Path) -> dict:
    try:
        return json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
