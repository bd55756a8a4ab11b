"""Parameters that have a part in some pictures of a command only: as declared, tried by experiment."""

from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from lietool import figure, paths
from lietool.declaration import Figure
from lietool.golden import numbers
from lietool.parameter import Parameter

COMMANDS = list(dict.fromkeys(figure.plates((paths.FIGURES,)).values()))


def outcome(loaded: Figure, params: dict[str, object]) -> object:
    """All that a drawing is, in a form that can be compared; or why there is none."""
    try:
        drawing = loaded.draw(**params)
    except ValueError as error:
        return str(error)
    mesh = drawing.mesh and (content(drawing.mesh.vertices), content(drawing.mesh.faces))
    return numbers.dumps(drawing.numbers), content(drawing.picture), mesh


def content(part: object) -> object:
    """A part of a picture without its identity: arrays by their bytes, for to print them takes seconds."""
    if isinstance(part, np.ndarray):
        return part.shape, part.tobytes()
    if is_dataclass(part):
        return type(part), *(content(getattr(part, field.name)) for field in fields(part))
    if isinstance(part, (tuple, list)):
        return tuple(map(content, part))
    return part


def others(parameter: Parameter, value: object) -> list[object]:
    """Other values of a parameter, of no particular kind."""
    param = parameter.param
    if parameter.kind in ("float", "int"):
        assert param.low is not None and param.high is not None
        span = param.high - param.low
        kind = float if parameter.kind == "float" else int
        return [kind(param.low + part * span) for part in (0.37, 0.71, 0.93)]
    if parameter.kind == "vector":
        return [tuple(0.7 * x + 0.13 * (i + 1) for i, x in enumerate(value))]  # type: ignore[arg-type]
    if parameter.kind == "bool":
        return [not value]
    return list(param.choices) or ["SO,GL"]


def has_part(loaded: Figure, base: dict[str, object], before: object, parameter: Parameter) -> bool:
    """Whether another value of a parameter changes anything."""
    values = others(parameter, base[parameter.name])
    return any(outcome(loaded, base | {parameter.name: value}) != before for value in values)


def pushed(loaded: Figure, base: dict[str, object], parameter: Parameter) -> dict[str, object]:
    """All other numbers near the upper ends of their ranges."""
    found = [p for p in loaded.parameters if p.kind == "float" and p is not parameter and not p.idle(base)]
    return {p.name: others(p, base[p.name])[-1] for p in found}


@pytest.mark.parametrize("name", COMMANDS)
def test_what_has_a_part_is_said(name):
    loaded = figure.load(name, (paths.FIGURES,))
    selectors = {p.param.only[0] for p in loaded.parameters if p.param.only} or {
        p.name for p in loaded.parameters if p.name in ("view", "kind", "group", "diagram")
    }
    for selector in (p for p in loaded.parameters if p.name in selectors):
        for choice in selector.param.choices:
            mine = [i for i in loaded.plates if loaded.plate_params(i)[selector.name] == choice]
            base = loaded.plate_params(mine[0]) if mine else loaded.check({selector.name: choice})
            before = outcome(loaded, base)
            for parameter in loaded.parameters:
                if parameter is selector:
                    continue
                part = has_part(loaded, base, before, parameter)
                if not (part or parameter.idle(base)):
                    # Turns beyond a half, say, are followed in one way or another only where there are some.
                    far = base | pushed(loaded, base, parameter)
                    part = has_part(loaded, far, outcome(loaded, far), parameter)
                assert part != parameter.idle(base), (parameter.name, choice)
