"""The tables of `lietool bench peers`."""

from typing import Any

import click

from lietool.verbs import _table

# Mistakes that are caught most narrowly, and names in one line.
_NARROW, _NAMES = 8, 6


def show(about: dict[str, Any]) -> None:
    """Print what was measured.

    Parameters
    ----------
    about : dict
        As it is for JSON.
    """
    click.echo(
        f"{about['mistakes']} mistakes that change a picture, {about['pictures']} pictures of them; "
        f"{about['noise']} pictures drawn in harmless ways, {about['noise_differing']} of them not equal."
    )
    results = [result for result in about["results"] if result["version"]]
    heads = ("comparison", "same if", "caught", "false alarms", "equal", "different")
    heads += ("everywhere", "takes")
    rows = [
        (
            f"{result['name']} {result['version']}",
            result["rule"],
            f"{len(result['caught'])} of {about['mistakes']}",
            f"{len(result['alarms'])} of {about['noise']}",
            _ms(result["seconds_equal"]),
            _ms(result["seconds_different"]),
            _ms(result["seconds_everywhere"]),
            result["takes"],
        )
        for result in results
    ]
    _table.show(heads, rows)
    for result in about["results"]:
        if not result["version"]:
            click.echo(f"{result['name']} is not installed: {result['install']}")
        elif result["missed"]:
            click.echo(f"{result['name']} misses {_few(result['missed'])}")
    if about["unknown"]:
        click.echo(
            f"Left out, for no whole run has tried them: {_few(about['unknown'])}. "
            "`lietool figures mutants --record` does"
        )
    _show_own(about)
    if len(about["rules"]) > 1:
        _show_rules(about)


def _show_own(about: dict[str, Any]) -> None:
    used = ", ".join(f"{value:.0%} {limit}" for limit, value in about["noise_use"].items())
    click.echo(f"\nOf our limits noise uses at most {used}. The mistakes that reach them least:")
    _table.show(
        ("mistake", "times a limit", "which"),
        [(one["name"], f"{one['use']:.2f}", one["by"]) for one in about["mistakes_use"][:_NARROW]],
    )


def _show_rules(about: dict[str, Any]) -> None:
    click.echo("\nRules near ours:")
    heads = ("px in one place", "of", "in all", "dE", "9x9 mean", "missed", "alarms", "least caught")
    heads += ("most of noise", "")
    rows = [
        (
            str(rule["pixels"]),
            f"{2 * rule['near'] + 1}x{2 * rule['near'] + 1}",
            str(rule["strewn"]),
            f"{rule['delta_e']:g}",
            f"{rule['lowpass']:g}",
            str(len(rule["missed"])),
            str(rule["alarms"]),
            f"{rule['least']:.2f}",
            f"{rule['most']:.2f}",
            "ours" if rule["own"] else "better" if rule["better"] else "",
        )
        for rule in about["rules"]
    ]
    _table.show(heads, rows)


def _ms(seconds: float) -> str:
    return f"{1000.0 * seconds:.3g} ms"


def _few(names: list[str]) -> str:
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return "; ".join(names[:_NAMES]) + more
