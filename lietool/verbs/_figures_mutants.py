"""`lietool figures mutants`: the score of the plates against mistakes in the library."""

import json
import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from lietool import figure, mutation
from lietool.mutation import record
from lietool.mutation import score as score_
from lietool.mutation.mutant import Mutant, MutantError, chosen
from lietool.mutation.score import Tried
from lietool.verbs import _mutants_run, _studio, _table

# Plates whose pictures notice a mutant, each of another command: more would only say the same.
_ENOUGH = 6
# Of a quick run: what may be planned on one processor, and when no further mutant is begun.
_PLANNED, _LAST_BEGIN = 45.0, 38.0


@dataclass(frozen=True)
class Wanted:
    """What the command line asks for."""

    names: tuple[str, ...]
    jobs: int = 1
    quick: bool = False
    seed: int = 0
    fresh: bool = False
    every: bool = False
    record: bool = False
    as_json: bool = False


def listed(names: Sequence[str], as_json: bool) -> None:
    """Print the catalogue."""
    found = _chosen(names)
    if as_json:
        keys = ("name", "module", "mistake", "says", "harmless")
        click.echo(
            json.dumps([{k: getattr(m, k) for k in keys} for m in found], indent=2, ensure_ascii=False)
        )
        return
    _table.show(("mutant", "mistake", "says"), [[m.name, m.mistake, m.harmless or m.says] for m in found])


def run(items: Sequence[_studio.Item], wanted: Wanted) -> int:
    """Try mutants and print what came of it.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    wanted : Wanted

    Returns
    -------
    int
        5 if a mutant slips through, or the catalogue is wrong about one that is harmless; else 0.

    Raises
    ------
    Stop
        With 2 if there is no such mutant, and as `_mutants_run.run`.
    """
    mutants = _chosen(wanted.names)
    commands = {item.id: item.command for item in items}
    if wanted.record and (figure.project() or wanted.quick or wanted.names):
        raise _studio.Stop(
            2, "--record keeps a whole run on our own plates. Leave out names, --quick and --project"
        )
    order = _mutants_run.Order(wanted.jobs, wanted.fresh, enough=10**6 if wanted.every else _ENOUGH)
    if wanted.quick:
        mutants, order = _quick(mutants, commands, wanted)
    try:
        done = _mutants_run.run(mutants, items, order)
    except MutantError as error:
        raise _studio.Stop(2, str(error)) from None
    about = score_.score(done.tried, commands)
    if wanted.record:
        with _studio.writing(str(record.FILE)):
            record.write(done.tried, about, done.seconds, record.FILE)
    code = 5 if any(one.trouble for one in done.tried) else 0
    if wanted.as_json:
        whole = {"exit": code, "score": about, "mutants": [one.plain() for one in done.tried]}
        click.echo(json.dumps(whole, indent=2, ensure_ascii=False))
        return code
    _print(done.tried, about)
    if late := len(mutants) - len(done.tried):
        click.echo(f"{late} of {len(mutants)} were not begun for want of time.")
    return code


def _quick(
    mutants: Sequence[Mutant], commands: Mapping[str, str], wanted: Wanted
) -> tuple[tuple[Mutant, ...], _mutants_run.Order]:
    """Choose what there is time for."""
    # More processes than processors do not make it quicker.
    seconds = _PLANNED * min(wanted.jobs, os.cpu_count() or 1)
    plan = record.sample(record.read(), mutants, commands, wanted.seed, seconds)
    if not plan:
        raise _studio.Stop(
            2,
            "--quick needs a record of which of these plates notice these mutants, and there is none. "
            "Leave it out, or other mutants in",
        )
    by_name = {mutant.name: mutant for mutant in mutants}
    until = time.monotonic() + _LAST_BEGIN
    return tuple(by_name[name] for name in plan), _mutants_run.Order(
        wanted.jobs, wanted.fresh, until, plates=plan
    )


def _chosen(names: Sequence[str]) -> tuple[Mutant, ...]:
    try:
        return chosen(names, mutation.catalogue())
    except MutantError as error:
        raise _studio.Stop(2, str(error)) from None


def _print(tried: Sequence[Tried], about: dict[str, Any]) -> None:
    rows = [
        [one.mutant.name, _word(one), ", ".join(one.by), _moved(one), _few(one.plates)]
        for one in tried
        if not one.mutant.harmless
    ]
    if rows:
        _table.show(("mutant", "", "by", "moves", "plates"), rows)
    harmless = [one for one in tried if one.mutant.harmless]
    if harmless:
        click.echo("\nHarmless:")
        for one in harmless:
            click.echo(f"  {one.mutant.name}: {one.mutant.harmless}")
    click.echo()
    for line in summary(about):
        click.echo(line)
    for one in tried:
        if one.trouble:
            click.echo(click.style("WRONG ", "red") + f"{one.mutant.name}: {one.trouble}")


def summary(about: dict[str, Any]) -> list[str]:
    """Say the score in sentences."""
    by = about["by"]
    lines = [
        f"{about['caught']} of {about['effective']} effective mutants caught ({about['percent']:.0f} %): "
        f"{by['picture']} by the picture, {by['numbers']} by numbers, "
        f"{about['only_numbers']} by numbers alone, "
        f"{about['only_failures']} only because a figure cannot be drawn any more.",
        f"{about['visible_by_picture']} of {about['visible']} that move something by "
        f"{score_.VISIBLE} px or more are caught by the picture alone ({about['visible_percent']:.0f} %).",
    ]
    if about["harmless"]:
        lines.append(f"{about['harmless']} change nothing that can be seen.")
    return lines


def _word(one: Tried) -> str:
    if one.caught:
        return "caught"
    return "slips through" if one.effective else "no effect"


def _moved(one: Tried) -> str:
    if not one.effective:
        return ""
    return "-" if one.displacement is None else f"{one.displacement:.3g} px"


def _few(plates: Sequence[str]) -> str:
    more = f" and {len(plates) - 6} more" if len(plates) > 6 else ""
    return ", ".join(plates[:6]) + more
