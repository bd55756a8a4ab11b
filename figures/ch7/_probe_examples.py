"""The examples of `probe`: our shapes, and their probes in the words of the command line."""

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lietool.deform import probe_io
from lietool.mesh import particles, solids
from lietool.mesh.solids import Solid
from lietool.mesh.surface import Mesh
from lietool.render import mesh_look, style

from ._probe_case import Case, Recipe
from ._probe_look import Look, by_part, patches

Array = NDArray[np.float64]

# What stands for the degrees of the probe that turns most.
_TURN = "{turn}"

DEGREES = {
    "duck": -70.0,
    "cactus": 110.0,
    "bend": 120.0,
    "vortex": 450.0,
    "strings": 480.0,
    "octopus": 390.0,
    "particles": 430.0,
}
"""By how much the probe turns that turns most."""

_WORDS = {
    "duck": (
        "name=body centre=-0.1,0,-0.1",
        f"name=head centre=0.62,0,1.2 axis=0,0.25,1 degrees={_TURN} scale=1.2 translation=-0.1,0,0.4",
        "name=tail centre=-1.1,0,0.65 axis=0,1,0 degrees=40 scale=1.3 translation=-0.1,0,0.25",
        "name=chest centre=0.75,0,-0.05",
    ),
    "cactus": (
        "name=pot centre=0,0,0",
        f"name=top centre=0,0,2.5 axis=0,0,1 degrees={_TURN} translation=0,0,0.1",
        "name=left centre=0,0.85,1.8 axis=1,0,0 degrees=-45 translation=0,0.2,0",
        "name=right centre=0,-0.8,2 axis=1,0,0 degrees=45 scale=1.25 translation=0,-0.25,0.1",
    ),
    "strings": (
        "name=lower centre=0,0,-2.2",
        f"name=upper centre=0,0,2.2 axis=0,-0.1,1 degrees={_TURN} translation=0,0.3,-0.5",
    ),
    "vortex": (f"name=eye centre=0,0,0 axis=0,0,1 degrees={_TURN} translation=0,0,-1.1",),
    "particles": (
        f"name=upper centre=-0.42,0,0.42 axis=0,1,0 degrees={_TURN}",
        f"name=lower centre=0.42,0,-0.42 axis=0,-1,0 degrees={_TURN} translation=0,0,0",
    ),
}

# Of the bar: where its probes are, and how far apart.
_LOW, _HIGH = 0.4, 2.8


def example(name: str, turn: float) -> Case:
    """Return an example, the probe that turns most turned by more degrees than it says."""
    mesh, look, recipe, painted = _base(name)
    probes = probe_io.from_words(words(name, DEGREES[name] + turn))
    return Case(name, mesh, probes, look, recipe, painted)


def words(name: str, degrees: float) -> list[str]:
    """Return the probes of an example in the words of the command line."""
    if name == "bend":
        return _bent(degrees)
    if name == "octopus":
        return _swirled(degrees)
    return [line.replace(_TURN, f"{degrees!r}") for line in _WORDS[name]]


def _bent(degrees: float) -> list[str]:
    """Two probes of a bar: the upper one goes where it is when the line between them is bent to an arc."""
    a, far = np.radians(degrees), _HIGH - _LOW
    # (1 - cos a) / a and sin a / a, also where a is 0.
    aside, along = far * np.sinc(a / (2.0 * np.pi)) * np.sin(a / 2.0), far * np.sinc(a / np.pi)
    return [
        f"name=lower centre=0,0,{_LOW}",
        f"name=upper centre=0,0,{_HIGH} axis=0,1,0 degrees={degrees!r} "
        f"translation={aside:.12f},0,{along - far:.12f}",
    ]


# How much of the way from the arm's own direction to the horizontal the axis is tilted.
_TILT = 0.35


def _swirled(degrees: float) -> list[str]:
    """One probe at the tip of an arm, about an axis a little off the arm's, so that it swirls."""
    line = solids.octopus().axes["arm 0"]
    u = line[-1] - line[10]
    u = u / np.sqrt(np.sum(u * u)) + (0.0, _TILT, 0.0)
    return [
        f"name=tip centre={','.join(f'{x:.9f}' for x in line[-1])} "
        f"axis={','.join(f'{x:.9f}' for x in u)} degrees={degrees!r}"
    ]


@cache
def _base(name: str) -> tuple[Mesh, Look, Recipe, Array | None]:
    return _BASES[name]()


def _mesh(solid: Solid) -> Mesh:
    return Mesh(solid.vertices, solid.faces)


def _eyes(solid: Solid) -> tuple[int, ...]:
    return tuple(v for name, v in solid.marks.items() if name.startswith("eye"))


def _duck() -> tuple[Mesh, Look, Recipe, None]:
    s = solids.duck()
    beak = patches(s.faces, [s.margin("upper beak", "lower beak")])
    look = Look(
        (1.0, -1.2, 0.35),
        0.55,
        (style.GREYS[1], style.BEFORE),
        (style.BETWEEN_EDGE, style.AFTER),
        beak,
        eyes=_eyes(s),
        eye=s.eye,
        margin=1.16,
    )
    return _mesh(s), look, Recipe(power=2.5), None


def _cactus() -> tuple[Mesh, Look, Recipe, None]:
    s = solids.cactus()
    parts = patches(s.faces, [s.margin("pot", "rim"), s.margin("petal")])
    look = Look(
        (1.0, 0.3, 0.3),
        0.55,
        (style.GREYS[1], style.GREYS[2], style.BEFORE),
        (style.BETWEEN_EDGE, style.ROUTE_2, style.SHELLS[2]),
        parts,
        edges=(style.BEFORE_EDGE, style.SHELLS_TEXT[2]),
    )
    return _mesh(s), look, Recipe(power=2.0), None


def _bar() -> tuple[Mesh, Look, Recipe, None]:
    s = solids.bar()
    sides = patches(s.faces, [s.margin("front", "back", "top", "bottom")])
    look = Look((0.3, -1.0, 0.22), 0.5, (style.GREYS[1], style.BEFORE), (style.BETWEEN, style.AFTER), sides)
    return _mesh(s), look, Recipe("gaussian", reach=0.5 * (_HIGH - _LOW), sum="unity"), None


def _strings() -> tuple[Mesh, Look, Recipe, None]:
    s = solids.strings()
    halves = by_part(s.faces, np.cos(2.0 * s.around), s.part, len(s.parts))
    tones = (*(style.BETWEEN,) * 4, style.AXIS_X, style.ARC, style.AXIS_Y, style.AXIS_Z)
    look = Look(
        (1.0, 0.15, 0.2), 0.5, tones, tones, halves, edges=(style.INK, style.INK), stands=False, margin=1.03
    )
    return _mesh(s), look, Recipe(power=1.6), None


def _octopus() -> tuple[Mesh, Look, Recipe, Array]:
    s = solids.octopus()
    under = patches(
        s.faces, [np.where(s.of("arm"), np.minimum(np.cos(s.around) - 0.3, (s.along - 0.12) * 8.0), -1.0)]
    )
    look = Look(
        (1.0, 0.3, 0.42),
        0.42,
        (style.GREYS[2], style.BEFORE),
        (style.BETWEEN, style.AFTER),
        under,
        eyes=_eyes(s),
        eye=s.eye,
    )
    a = np.clip((s.along - 0.05) / 0.9, 0.0, 1.0)
    painted = np.where(s.of("arm 0"), a * a * (3.0 - 2.0 * a), 0.0)[:, None]
    return _mesh(s), look, Recipe(), painted


def _vortex() -> tuple[Mesh, Look, Recipe, None]:
    cloud = particles.disc(18000, 12)
    tones = (style.AXIS_Z, style.RAMP[1], style.SHELLS[0])
    return _cloud(
        cloud, tones, Look((1.0, 0.0, 0.84), 0.3, dots=3.2, margin=0.99), Recipe("cutoff", 1.6, 1.05)
    )


def _particles() -> tuple[Mesh, Look, Recipe, None]:
    cloud = particles.block(16000, 8)
    tones = (
        style.BETWEEN,
        style.AXIS_Z,
        style.ARC,
        style.ROUTE_1,
        style.SHELLS[0],
        style.AXIS_X,
        style.AXIS_Y,
        style.ROUTE_2,
    )
    return _cloud(
        cloud,
        tones,
        Look((0.25, -1.0, 0.2), 0.35, dots=3.4, margin=1.06, lens=4.0),
        Recipe("cutoff", 2.0, 0.9),
    )


def _cloud(
    cloud: particles.Cloud, tones: tuple[str, ...], look: Look, recipe: Recipe
) -> tuple[Mesh, Look, Recipe, None]:
    colors = (mesh_look.mixed(tones, np.eye(len(tones))[cloud.strip % len(tones)]),)
    mesh = Mesh(cloud.points, np.zeros((0, 3), np.intp))
    return mesh, replace(look, before=colors, after=colors), recipe, None


_BASES = {
    "duck": _duck,
    "cactus": _cactus,
    "bend": _bar,
    "strings": _strings,
    "octopus": _octopus,
    "vortex": _vortex,
    "particles": _particles,
}
