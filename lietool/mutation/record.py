"""What a whole run found, kept beside the catalogues: the score, and which plates notice which mutant.

From it a quick run knows where to look, and the README what to say.
"""

import json
import random
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lietool import atomic
from lietool.mutation.mutant import Mutant
from lietool.mutation.score import Tried

FILE = Path(__file__).with_name("record.json")

# Seconds for a process to import the library and to make a renderer.
_START = 0.7
# Plates that are kept of each mutant: a few, cheap and expensive, are enough to choose from.
_KEPT = 12


def read(file: Path = FILE) -> dict[str, Any]:
    """Read the record.

    Parameters
    ----------
    file : Path

    Returns
    -------
    dict
        "score", "seconds" of every plate, and for each of "mutants" what noticed it ("by"), the
        "plates" and the "displacement"; all empty where there is none.
    """
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {"score": {}, "seconds": {}, "mutants": {}}


def write(tried: Sequence[Tried], about: Mapping[str, Any], seconds: Mapping[str, float], file: Path) -> None:
    """Keep what a whole run found.

    Parameters
    ----------
    tried : sequence of Tried
    about : Mapping[str, object]
        The score.
    seconds : Mapping[str, float]
        How long each plate takes.
    file : Path

    Raises
    ------
    OSError
        If it cannot be written.
    """
    mutants = {
        one.mutant.name: {
            "by": list(one.by),
            "plates": _best(one),
            "displacement": one.displacement and float(f"{one.displacement:.3g}"),
        }
        for one in tried
    }
    # In tenths, so that another run seldom changes them.
    costs = {plate: max(round(value, 1), 0.1) for plate, value in sorted(seconds.items())}
    whole = {"score": about, "seconds": costs, "mutants": mutants}
    atomic.write_bytes(file, (json.dumps(whole, indent=1, ensure_ascii=False) + "\n").encode())


def _best(one: Tried) -> list[str]:
    """The plates whose pictures notice a mutant; where none does, those that notice it otherwise."""
    seen = [outcome.plate for outcome in one.outcomes if outcome.picture]
    return (seen or list(one.plates))[:_KEPT]


def sample(
    record: Mapping[str, Any],
    mutants: Sequence[Mutant],
    commands: Mapping[str, str],
    seed: int,
    seconds: float,
) -> dict[str, list[str]]:
    """Choose mutants of all modules, and for each a plate that notices it, spread over commands.

    Parameters
    ----------
    record : Mapping[str, object]
        As `read` returns it.
    mutants : sequence of Mutant
    commands : Mapping[str, str]
        The command of every plate that may be drawn.
    seed : int
    seconds : float
        How long it may take on one processor, as far as can be foreseen.

    Returns
    -------
    dict of list of str
        The plates by mutant, in the order in which they should be tried.
    """
    shuffled = sorted(mutants, key=lambda mutant: mutant.name)
    random.Random(seed).shuffle(shuffled)
    rounds: dict[str, int] = {}
    turns = []
    for mutant in shuffled:
        rounds[mutant.module] = rounds.get(mutant.module, -1) + 1
        turns.append(rounds[mutant.module])
    plan: dict[str, list[str]] = {}
    used = dict.fromkeys(commands.values(), 0)
    referred: set[str] = set()
    for _, mutant in sorted(zip(turns, shuffled, strict=True), key=lambda pair: pair[0]):
        plates = [p for p in record["mutants"].get(mutant.name, {}).get("plates", ()) if p in commands]
        costs = {p: record["seconds"][p] * (1 if p in referred else 2) for p in plates}
        if not costs:
            continue
        # A command that had few so far, if it is not much dearer.
        plate = min(costs, key=lambda p: (costs[p] * (1.0 + used[commands[p]]), p))
        cost = costs[plate] + _START * (1 if plate in referred else 2)
        if cost <= seconds:
            seconds -= cost
            used[commands[plate]] += 1
            referred.add(plate)
            plan[mutant.name] = [plate]
    return plan
