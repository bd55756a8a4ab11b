"""How a user says that probes are weighed: by options, in words, and in the file of probes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from lietool.deform import painted
from lietool.deform.probe_values import Table, shown
from lietool.mesh.files import Place

from ._probe_case import Case
from ._probe_weights import PARTS, SMOOTH, Recipe, loose_vertices, normalised

HOLD = 0.1
"""Unless it is said, how much farther than its nearest vertex a probe holds others: over the shape's size."""
REACH = 0.5
"""And how far weights reach."""
_CHOICES = {
    "sum": ("auto", "unity", "softmax", "capped", "none"),
    "distance": ("straight", "surface"),
    "loose": ("refuse", "follow"),
}
_KEYS = {
    "inverse-distance": ("power", "sum", "distance"),
    "cutoff": ("power", "reach", "sum", "distance"),
    "gaussian": ("reach", "sum", "distance"),
    "harmonic": ("hold", "loose"),
    "biharmonic": ("hold", "loose"),
    "painted": ("file",),
    "none": (),
}
_FARTHEST = 1e6


def weighted(
    case: Case, recipe: Recipe | None, paint: Path | None, words: Sequence[str], size: float
) -> Case:
    """Return a case with the weights that are asked for, on the command line or in the file of probes.

    Parameters
    ----------
    case : Case
    recipe : Recipe or None
        That of the options, its lengths in sizes of the shape.
    paint : Path or None
    words : sequence of str
        Of each of `PARTS` the weights of its own, or nothing.
    size : float
        Half the diagonal of the shape's box.
    """
    if recipe is not None:
        if paint is not None:
            raise ValueError(f"weights must be auto where they are painted; got {recipe.kind}. Leave it out")
        recipe = replace(recipe, reach=recipe.reach * size, hold=recipe.hold * size)
    elif paint is not None:
        recipe = Recipe("painted", values=_painted("paint", paint, case))
    base, parts = _in_file(case, size)
    if base is not None and recipe is not None:
        name = "paint" if paint is not None else "weights"
        raise ValueError(f"{name} must be left out where the file of probes has a kind of weights; got both")
    for part, text in zip(PARTS, words, strict=True):
        if not text:
            continue
        if part in parts:
            option = f"{part}-weights"
            raise ValueError(f"{option} must be left out where the file of probes has them; got both")
        parts[part] = _in_words(part, text, case, size)
    recipe = base or recipe
    if recipe is not None:
        case = replace(case, recipe=recipe, painted=recipe.values)
    case = replace(case, parts=parts)
    return replace(case, notes=_notes(case))


def _in_file(case: Case, size: float) -> tuple[Recipe | None, dict[str, Recipe]]:
    """The recipes in the file of probes: that of all, and those of the parts that have one."""
    table = case.probes.weights
    if table is None:
        return None, {}
    own = {key: value for key, value in table.data.items() if key not in PARTS}
    if not table.data:
        table.fail("", f"given kind, or {', '.join(PARTS[:2])} or {PARTS[2]}", "none of them")
    base = _read(Table(table.place, table.label, own), case, 1.0, size) if own else None
    parts = {}
    for part in PARTS:
        if part in table.data:
            entry = table.table(part, table.data[part], f"{table.label}, {part}")
            parts[part] = _read(entry, case, 1.0, size)
    return base, parts


def _in_words(part: str, text: str, case: Case, size: float) -> Recipe:
    """The recipe that words stand for: `gaussian reach=0.3`, lengths in sizes of the shape."""
    table = Table(Place("probe", Path(f"--{part}-weights")), "", {})
    data: dict[str, Any] = {}
    for word in text.split():
        key, equals, value = word.partition("=")
        if not equals:
            key, value = "kind", word
        if key in data:
            table.fail(key, "given once", "it twice")
        try:
            data[key] = float(value)
        except ValueError:
            data[key] = value
    return _read(Table(table.place, "", data), case, size, size)


def _read(table: Table, case: Case, unit: float, size: float) -> Recipe:
    """Return the recipe of a table, its lengths times a unit."""
    kind = table.data.get("kind")
    if not isinstance(kind, str) or kind not in _KEYS:
        must = f"one of {', '.join(_KEYS)}"
        table.fail("kind", must, "none" if kind is None else shown(kind))
    for key in table.data:
        if key not in ("kind", *_KEYS[kind]):
            known = ", ".join(("kind", *_KEYS[kind]))
            table.fail("", f"of {known} for {kind} weights", f"the key {key!r}")
    if kind == "painted":
        return Recipe(kind, values=_file(table, case))
    lengths = {"reach": REACH * size, "hold": HOLD * size}
    for key, low in (("reach", 1e-6), ("hold", 0.0)):
        if key in table.data:
            lengths[key] = unit * float(table.numbers(key, ()))
            if not low * size <= lengths[key] <= _FARTHEST * size:
                ends = [x * size / unit for x in (low, _FARTHEST)]
                table.fail(key, f"{ends[0]:.3g} to {ends[1]:.3g}", shown(table.data[key]))
    power = float(table.numbers("power", ())) if "power" in table.data else 2.0
    if not 0.25 <= power <= 8.0:
        table.fail("power", "0.25 to 8", f"{power:g}")
    words = {}
    for key, choices in _CHOICES.items():
        words[key] = table.data.get(key, choices[0])
        if words[key] not in choices:
            table.fail(key, f"one of {', '.join(choices)}", shown(words[key]))
    return Recipe(kind, power, **lengths, **words)


def _file(table: Table, case: Case) -> Any:
    name = table.data.get("file")
    if not isinstance(name, str) or not name:
        table.fail("file", "the name of a file of weights", "none" if name is None else shown(name))
    # A file is named from the folder of the one that names it.
    return _painted(f"{table.label} file".strip(), table.place.path.parent / name, case)


def _painted(name: str, path: Path, case: Case) -> Any:
    names = case.probes.names
    values = painted.read(path, len(case.mesh.vertices))
    if values.shape[1] != len(names):
        raise ValueError(
            f"{name} must be weights of {len(names)} probes, {', '.join(names)}; got {values.shape[1]} in "
            f"{path}. Add or leave out columns"
        )
    return normalised(values, "capped")


def _notes(case: Case) -> tuple[str, ...]:
    """What is to be told of the weights of a case."""
    kinds = {recipe.kind for recipe in case.recipes}
    if not kinds & set(SMOOTH):
        held = [case.probes.names[k] for k, entry in enumerate(case.probes.handles) if entry is not None]
        if not held:
            return ()
        return (f"the handle of probe {', '.join(held)} has no part: weights are not harmonic or biharmonic",)
    count = loose_vertices(case.mesh, case.probes) if len(case.mesh.faces) else 0
    if not count:
        return ()
    many = f"{count} vertices that no face uses follow" if count > 1 else "1 vertex that no face uses follows"
    return (f"{many} the nearest of the surface",)
