"""`lietool bench pairs`: flips, determinants and energies of every homotopy with every energy."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

import click
import numpy as np

from lietool import figure
from lietool.verbs import _table

# Of the figure whose numbers these are.
_FIGURE = "global-interp"
NAMES = {
    "logexp": "A^E",
    "arap": "A^P",
    "linear": "A^L",
    "frobenius": "E^F",
    "point": "E^P",
    "similarity": "E^R",
    "point-similarity": "E^S",
    "balanced": "(E^F + E^R) / 2",
    "symmetric": "E^F both ways",
}
# Three triangles on a plate of their own are no shape with a nose and a tail.
SHAPES = ("gecko", "fish", "snake", "cat")
CONSTRAINTS = ("line", "loci", "held")
# An energy that is 0 but for rounding.
_NOISE = 1e-13


@dataclass(frozen=True)
class Row:
    """What one way of interpolating does to one pair of shapes.

    Parameters
    ----------
    pair, constraint, homotopy, energy : str
        As `lietool global-interp` calls them.
    triangles : int
    flipped : int
        The most triangles that are turned over at one moment.
    at : float
        That moment; the first of several.
    least_det : float
        The least determinant of a triangle's map, over all moments.
    most_energy : float
        The most that the energy is, over the area of the source.
    """

    pair: str
    constraint: str
    homotopy: str
    energy: str
    triangles: int
    flipped: int
    at: float
    least_det: float
    most_energy: float


def choices(name: str) -> tuple[str, ...]:
    """Return the choices of a parameter of the figure."""
    known = {parameter.name: parameter for parameter in figure.declare(_FIGURE).parameters}
    return known[name].param.choices


@click.command()
@click.option(
    "--pair",
    "pairs",
    type=click.Choice(SHAPES),
    multiple=True,
    default=SHAPES,
    help="Only this; again for more.",
)
@click.option(
    "--constraint",
    "constraints",
    type=click.Choice(CONSTRAINTS),
    multiple=True,
    default=("line", "loci"),
    help="Only with these constraints. [default: line and loci]",
)
@click.option(
    "--angles",
    type=click.Choice(("consistent", "principal")),
    default="consistent",
    show_default=True,
    help="Of the local maps.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the numbers as JSON.")
def pairs(pairs: tuple[str, ...], constraints: tuple[str, ...], angles: str, as_json: bool) -> None:
    """Tell which ways between two shapes turn triangles over.

    Every homotopy with every energy, on the pairs of shapes that
    `lietool global-interp` shows: how many triangles are turned over at the
    worst of 41 moments, the least determinant of a triangle's map, both ends
    included, and the most that the energy is, over the area of the source; one
    energy's numbers say nothing about another's. With the constraint "line" the middle goes
    straight, and where rotations cost nothing an edge is held; with "loci" nose
    and tail wind a full turn away from the local maps; with "held" an edge does.
    """
    asked = list(product(pairs, constraints, choices("homotopy"), choices("energy")))
    rows = [measure(*words, angles=angles) for words in _table.progress(asked, "solving")]
    if as_json:
        click.echo(json.dumps({"angles": angles, "rows": [asdict(row) for row in rows]}, indent=2))
        return
    heads = ("pair", "constraint", "homotopy", "energy", "flipped", "at t", "least det", "most energy")
    _table.show(heads, [_cells(row) for row in rows])


def measure(pair: str, constraint: str, homotopy: str, energy: str, *, angles: str = "consistent") -> Row:
    """Return what a way of interpolating does to a pair, by the numbers of the figure.

    Parameters
    ----------
    pair, constraint, homotopy, energy, angles : str
        As `lietool global-interp` calls them.

    Returns
    -------
    Row
    """
    params = {"example": pair, "constraint": constraint, "homotopy": homotopy, "energy": energy}
    loaded = figure.load(_FIGURE)
    shown: Mapping[str, Any] = loaded.draw(stage="frames", steps=1, angles=angles, **params).numbers
    flipped = np.asarray(shown["flipped"])
    worst = int(np.argmax(flipped))
    return Row(
        pair,
        constraint,
        homotopy,
        energy,
        len(shown["theta"]),
        int(flipped[worst]),
        worst / (len(flipped) - 1),
        float(np.min(shown["least_det"])),
        float(np.max(shown["energy"])),
    )


def _cells(row: Row) -> tuple[str, ...]:
    return (
        row.pair,
        row.constraint,
        NAMES[row.homotopy],
        NAMES[row.energy],
        f"{row.flipped} of {row.triangles}" if row.flipped else "none",
        f"{row.at:.3g}" if row.flipped else "",
        f"{row.least_det:.3f}",
        f"{row.most_energy:.1e}" if row.most_energy > _NOISE else "0",
    )
