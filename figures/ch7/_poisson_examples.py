"""The examples of `poisson`: an octopus that is drawn up by its head, and one whose arm is turned."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from lietool.lie import so3
from lietool.mesh import solids
from lietool.mesh.solids import Solid
from lietool.mesh.surface import Mesh
from lietool.render import style

from ._poisson_case import Case, Motions
from ._probe_look import Look, Patches, patches

Array = NDArray[np.float64]

# Of each arm that stands on the ground, what is pinned; of the head, what is the handle, by its height.
_TIP, _CROWN = 0.82, 1.25
# How the head is moved: turned about an axis, in degrees, drawn and stretched upwards.
_AXIS, _DEGREES, _DRAWN, _STRETCH = (0.9, 0.3, 0.3), 30.0, (0.10, -0.20, 1.00), (1.0, 1.0, 1.3)
# Of the arm that is turned: from where it is free, and from where it is the handle; and how much of the arm's
# direction the axis has that it is rolled up about, so that it does not run into itself.
_ROOT, _HELD, _ASIDE = 0.24, 0.90, 0.22
# From where the arm is in a picture that is taken close by.
_SEEN = 0.16
_FINE = 400
# The systems that were factored: they do not depend on how the handles are moved.
_KEPT: dict[str, dict] = {"head": {}, "arm": {}}


def by_head() -> Case:
    """Return the octopus that is pinned by the tips of its arms, with a handle at the top of its head."""
    s = _octopus()
    arms = tuple(name for name in s.parts if name.startswith("arm") and name != "arm 0")
    pins = np.flatnonzero(s.of(*arms) & (s.along > _TIP))
    crown = np.flatnonzero(s.of("head") & (s.vertices[:, 2] > _CROWN))
    u = np.array(_AXIS) / np.sqrt(np.sum(np.square(_AXIS)))
    motions = Motions(
        s.vertices[crown].mean(axis=0)[None],
        np.radians(_DEGREES) * u[None],
        np.diag(np.log(_STRETCH))[None],
        np.array([_DRAWN]),
    )
    look = Look((1.0, 0.35, 0.30), 0.55, patches=Patches((s.faces,)), eyes=_eyes(s), eye=s.eye)
    mesh = Mesh(s.vertices, s.faces)
    return Case("head", mesh, look, pins, ("head",), (crown,), motions, kept=_KEPT["head"])


def by_arm(degrees: float, motion: str) -> Case:
    """Return the octopus whose arm is turned at its tip: rolled up, its axis bent evenly, or twisted."""
    s = _octopus()
    arm = s.of("arm 0")
    held, pins = np.flatnonzero(arm & (s.along > _HELD)), np.flatnonzero(~arm | (s.along < _ROOT))
    centre = s.vertices[held].mean(axis=0)
    line = s.axes["arm 0"]
    along = line[-1] - line[len(line) // 4]
    u = along / np.sqrt(np.sum(along**2))
    if motion == "roll":
        u = np.array([1.0, 0.0, 0.0]) + _ASIDE * u
    x = np.radians(degrees) * u / np.sqrt(np.sum(u**2))
    go = _rolled(line, x, centre) if motion == "roll" else np.zeros(3)
    motions = Motions(centre[None], x[None], np.zeros((1, 3, 3)), go[None])
    mesh, close = Mesh(s.vertices, s.faces), np.flatnonzero(arm & (s.along > _SEEN))
    return Case("arm", mesh, _arm_look(), pins, ("tip",), (held,), motions, close=close, kept=_KEPT["arm"])


def _rolled(line: Array, x: Array, centre: Array) -> Array:
    """Where the tip goes when the arm's axis is bent evenly, keeping its length."""
    step = np.sqrt(np.sum(np.diff(line, axis=0) ** 2, axis=1))
    along = np.append(0.0, np.cumsum(step)) / step.sum()
    fine = np.linspace(0.0, 1.0, _FINE + 1)
    points = np.stack([np.interp(fine, along, column) for column in line.T], axis=1)
    part = np.clip((0.5 * (fine[1:] + fine[:-1]) - _ROOT) / (_HELD - _ROOT), 0.0, 1.0)
    turned = (so3.exp(part[:, None] * x) @ np.diff(points, axis=0)[..., None])[..., 0]
    bent = points[0] + np.append(np.zeros((1, 3)), np.cumsum(turned, axis=0), axis=0)
    middle = round(0.5 * (1.0 + _HELD) * _FINE)
    return bent[middle] + so3.exp(x) @ (centre - points[middle]) - centre


def _octopus() -> Solid:
    return solids.octopus(solids.DRAFT)


def _eyes(s: Solid) -> tuple[int, ...]:
    return tuple(v for name, v in s.marks.items() if name.startswith("eye"))


@cache
def _arm_look() -> Look:
    """The handle, the two stripes of what is free, and what is pinned."""
    s = _octopus()
    arm = s.of("arm 0")
    free = np.where(arm, s.along - _ROOT, -1.0)
    held = np.where(arm, s.along - _HELD, -1.0)
    stripes = np.where(arm, np.minimum(free, 0.1 * np.cos(2.0 * s.around)), -1.0)
    colors = (style.ALGEBRA, style.BETWEEN, style.AFTER, style.BEFORE)
    made = patches(s.faces, [held, stripes, free])
    edges = (style.BEFORE_EDGE, style.BEFORE_EDGE)
    return Look((1.0, 0.35, 0.30), 0.40, colors, colors, made, edges, _eyes(s), s.eye)
