"""Parameters that have a part in some pictures of a command only: as declared, tried by experiment."""

import hashlib
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from lietool import figure, paths
from lietool.declaration import Figure
from lietool.golden import numbers
from lietool.parameter import Parameter

COMMANDS = list(dict.fromkeys(figure.plates((paths.FIGURES,)).values()))


class Outcomes:
    """What a command makes of parameters: the same ones are wanted again for every selector."""

    def __init__(self, loaded: Figure) -> None:
        self.loaded = loaded
        self.known: dict[str, object] = {}

    def of(self, params: dict[str, object]) -> object:
        """All that a drawing is, in a form that can be compared; or why there is none."""
        key = repr(sorted(params.items()))
        if key not in self.known:
            self.known[key] = self._drawn(params)
        return self.known[key]

    def _drawn(self, params: dict[str, object]) -> object:
        try:
            drawing = self.loaded.draw(**params)
        except ValueError as error:
            return str(error)
        mesh = drawing.mesh and (content(drawing.mesh.vertices), content(drawing.mesh.faces))
        return numbers.dumps(drawing.numbers), content(drawing.picture), mesh


def content(part: object) -> object:
    """A part of a picture without its identity: arrays by a digest, for hundreds of pictures are kept."""
    if isinstance(part, np.ndarray):
        return part.shape, hashlib.sha256(part.tobytes()).digest()
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


def has_part(outcomes: Outcomes, base: dict[str, object], parameter: Parameter) -> bool:
    """Whether another value of a parameter changes anything."""
    values = others(parameter, base[parameter.name])
    before = outcomes.of(base)
    return any(outcomes.of(base | {parameter.name: value}) != before for value in values)


def pushed(loaded: Figure, base: dict[str, object], parameter: Parameter) -> dict[str, object]:
    """All other numbers near the upper ends of their ranges."""
    found = [p for p in loaded.parameters if p.kind == "float" and p is not parameter and not p.idle(base)]
    return {p.name: others(p, base[p.name])[-1] for p in found}


@pytest.mark.parametrize("name", COMMANDS)
def test_what_has_a_part_is_said(name):
    loaded = figure.load(name, (paths.FIGURES,))
    outcomes = Outcomes(loaded)
    selectors = {p.param.only[0] for p in loaded.parameters if p.param.only} or {
        p.name for p in loaded.parameters if p.name in ("view", "kind", "group", "diagram")
    }
    for selector in (p for p in loaded.parameters if p.name in selectors):
        for choice in selector.param.choices:
            mine = [i for i in loaded.plates if loaded.plate_params(i)[selector.name] == choice]
            base = loaded.plate_params(mine[0]) if mine else loaded.check({selector.name: choice})
            for parameter in loaded.parameters:
                if parameter is selector:
                    continue
                part = has_part(outcomes, base, parameter)
                if not (part or parameter.idle(base)):
                    # Turns beyond a half, say, are followed in one way or another only where there are some.
                    far = base | pushed(loaded, base, parameter)
                    part = has_part(outcomes, far, parameter)
                assert part != parameter.idle(base), (parameter.name, choice)
