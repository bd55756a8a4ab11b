"""Solids of our own: an octopus, strings, a thorned ball, animals in correspondence, a duck, a cactus, a bar.

Most are modelled of round limbs and eggs that flow into each other, cut out by marching cubes and made over
into even triangles; that takes seconds, so it is kept in the cache folder.  All are closed, face outwards,
and are the same on every machine.  x is to the front, y to the left, z up.
"""

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.mesh import _creatures, _even, _implicit, _kept, _sculptures, _strings
from lietool.mesh._flesh import Limb
from lietool.mesh._implicit import Body
from lietool.mesh._solid import Solid, changed, frozen, normals
from lietool.mesh._thorns import thorn_maps, thorn_targets
from lietool.mesh.topology import fail

Array = NDArray[np.float64]
Index = NDArray[np.intp]

__all__ = [
    "DRAFT",
    "FINE",
    "SOLIDS",
    "Solid",
    "animals",
    "bar",
    "cactus",
    "duck",
    "normals",
    "octopus",
    "strings",
    "thorn_ball",
    "thorn_maps",
    "thorn_targets",
]

FINE, DRAFT = 0.040, 0.085
"""Sides of triangles, where the solids are thick: for pictures, and for trying."""

_FINEST, _COARSEST = 0.015, 0.15
# No limb is much thinner: cubes any larger would cut tips off.
_THINNEST = 0.042
# What is kept of a solid, beside its targets.
_OWN = ("V", "F", "part", "along", "around", "distances")


@cache
def octopus(spacing: float = FINE) -> Solid:
    """Return an octopus that waves: "arm 0" is raised to its left, seven others lie round the body.

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15.

    Returns
    -------
    Solid
        Three units wide; `around` is 0 under each arm, where the suckers would be; marks "tip 0" to "tip 7".

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    body = _sculptures.octopus()
    marks = {"eye left": (0.585, 0.30, 0.90), "eye right": (0.585, -0.30, 0.90)}
    marks |= {f"tip {part.name[4:]}": part.points[-1] for part in body.parts if isinstance(part, Limb)}
    return _solid("octopus", body, spacing, marks, eye=0.105)


@cache
def thorn_ball(spacing: float = FINE) -> Solid:
    """Return a ball with one large thorn along z and small ones, and two targets of its large thorn.

    The targets are those of `thorn_targets` as they are by default, named "one" and "two".

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15.

    Returns
    -------
    Solid
        A ball of radius 1 about the origin; the tip of the thorn, the mark "tip", at height 2.57.

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    solid = _solid("thorn-ball", _sculptures.thorn_ball(), spacing, {"tip": (0.0, 0.0, 2.58)})
    one, two = thorn_targets(solid)
    return changed(solid, targets={"one": one, "two": two})


@cache
def animals(spacing: float = FINE) -> Solid:
    """Return a plump animal on four legs, and its relatives "tall", "fat", "long" and "bent" as targets.

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15.

    Returns
    -------
    Solid
        The one at rest; its feet, and theirs, are on the ground z = 0.

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    beast = _creatures.animal()
    solid = _solid("animals", beast.body, spacing, beast.marks, eye=0.072, more=_poses)
    return changed(solid, vertices=solid.vertices - np.array([0.0, 0.0, solid.vertices[:, 2].min()]))


def _poses(V: Array, F: Index) -> dict[str, Array]:
    beast = _creatures.animal()
    W = _creatures.weights(beast, V, F)
    return {name: _creatures.posed(beast, pose, V, W) for name, pose in beast.poses.items()}


@cache
def duck(spacing: float = FINE) -> Solid:
    """Return a rubber duck.

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15.

    Returns
    -------
    Solid
        Two and a half units long; the parts of the beak end in "beak".

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    marks = {"eye left": (0.98, 0.28, 1.38), "eye right": (0.98, -0.28, 1.38), "tail": (-1.3, 0.0, 0.95)}
    return _solid("duck", _sculptures.duck(), spacing, marks, eye=0.075)


@cache
def cactus(spacing: float = FINE) -> Solid:
    """Return a cactus with ribs, two arms and a flower, in a pot.

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15; above 0.06 the ribs are rough.

    Returns
    -------
    Solid
        Three and a half units high; parts "stem", "left arm", "right arm", "pot", "rim", "petal 0" to
        "petal 6".

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    marks = {"top": (0.0, 0.0, 2.86), "tip left": (0.0, 0.82, 2.02), "tip right": (0.0, -0.75, 2.25)}
    return _solid("cactus", _sculptures.cactus(), spacing, marks)


@cache
def bar(spacing: float = FINE) -> Solid:
    """Return a square bar that stands on the ground, its edges rounded.

    Parameters
    ----------
    spacing : float
        The side of the triangles, 0.015 to 0.15.

    Returns
    -------
    Solid
        0.64 wide and 3.2 high; `along` rises from the ground to the top; parts "front", "left", "back",
        "right", "top" and "bottom".

    Raises
    ------
    ValueError
        If the spacing is out of range.
    """
    solid = _solid("bar", _sculptures.bar(), spacing, {})
    V = solid.vertices
    around = np.round(np.arctan2(V[:, 1], V[:, 0]), 6)
    axis = np.stack([np.zeros(33), np.zeros(33), np.linspace(0.0, 3.2, 33)], axis=1)
    out = (V - np.array([0.0, 0.0, 1.6])) / np.array([0.32, 0.32, 1.6])
    side = np.array([0, 1, 4, 2, 3, 5])[np.argmax(np.concatenate([out, -out], axis=1), axis=1)]
    names = ("front", "left", "back", "right", "top", "bottom")
    own = {
        "parts": names,
        "part": side,
        "distances": -np.concatenate([out, -out], axis=1).T[[0, 1, 3, 4, 2, 5]],
    }
    return changed(solid, **own, along=V[:, 2] / 3.2, around=around, axes={"bar": axis})


@cache
def strings(count: int = 4, around: int = 24) -> Solid:
    """Return upright strings side by side.

    Parameters
    ----------
    count : int
        How many.
    around : int
        Vertices on a ring; as fine are the rings.

    Returns
    -------
    Solid
        Four units high, the middle at the origin; parts "string 0", ..., from -y to y.

    Raises
    ------
    ValueError
        If there is no string, or fewer than six vertices on a ring.
    """
    if not (isinstance(count, int) and 1 <= count <= 100):
        fail("solids.strings", "count", "a whole number, 1 to 100", repr(count))
    if not (isinstance(around, int) and 6 <= around <= 200):
        fail("solids.strings", "around", "a whole number, 6 to 200", repr(around))
    return frozen(_strings.strings(count, around))


SOLIDS: dict[str, Callable[[float], Solid]] = {
    "octopus": octopus,
    "thorn-ball": thorn_ball,
    "animals": animals,
    "duck": duck,
    "cactus": cactus,
    "bar": bar,
}
"""The solids that are made of even triangles, by name; `strings` has rings instead."""


def _solid(
    name: str,
    body: Body,
    spacing: float,
    marks: Mapping[str, ArrayLike],
    eye: float = 0.0,
    more: Callable[[Array, Index], dict[str, Array]] | None = None,
) -> Solid:
    where = f"solids.{name.replace('-', '_')}"
    if not (isinstance(spacing, int | float) and _FINEST <= spacing <= _COARSEST):
        fail(where, "spacing", f"a number, {_FINEST} to {_COARSEST}", repr(spacing))
    arrays = _kept.kept(f"{name}-{float(spacing)!r}", lambda: _made(body, spacing, more))
    V, F = arrays["V"], arrays["F"]
    places = {
        mark: int(np.argmin(((V - np.asarray(place)) ** 2).sum(axis=1))) for mark, place in marks.items()
    }
    axes = {part.name: part.points for part in body.parts if isinstance(part, Limb)}
    targets = {key: array for key, array in arrays.items() if key not in _OWN}
    names = tuple(part.name for part in body.parts)
    own = {key: arrays[key] for key in _OWN[2:]}
    return frozen(Solid(V, F, normals(V, F), names, **own, axes=axes, marks=places, eye=eye, targets=targets))


def _made(
    body: Body, spacing: float, more: Callable[[Array, Index], dict[str, Array]] | None
) -> dict[str, np.ndarray]:
    V, F = _implicit.surface(body, min(0.9 * spacing, _THINNEST))
    V, F = _even.even(V, F, lambda p: body.fineness(p, spacing), body.onto)
    part = body.owner(V)
    along, around = body.coordinates(V, part)
    made = dict(zip(_OWN, (V, F, part, along, around, np.round(body.distances(V), 6)), strict=True))
    return made | (more(V, F) if more else {})
