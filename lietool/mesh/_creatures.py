"""A family of animals: one body, meshed once, whose bones turn, lengthen and thicken; the flesh follows."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lietool.lie import so3
from lietool.mesh import topology
from lietool.mesh._flesh import Egg, Limb
from lietool.mesh._implicit import Body
from lietool.mesh._sculptures import curve

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# How soon the pull of a bone fades with the distance from it, and how often the weights are averaged.
_FADE, _ROUNDS = 4.0, 30


@dataclass(frozen=True)
class Bone:
    """What moves with its parent, and by itself about its first point."""

    name: str
    parent: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]


@dataclass(frozen=True)
class Change:
    """What a pose does to a bone: a rotation vector in degrees, and factors along the bone and across it."""

    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    long: float = 1.0
    thick: float = 1.0


Pose = Mapping[str, Change]


@dataclass(frozen=True, eq=False)
class Animal:
    """Flesh, bones and poses; parts of the flesh belong to the bone of their name."""

    body: Body
    bones: tuple[Bone, ...]
    poses: Mapping[str, Pose]
    marks: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)


def _legs() -> list[tuple[Bone, Limb]]:
    legs = []
    for place, x, parent in (("fore", 0.50, "chest"), ("hind", -0.52, "rump")):
        for side, y in (("left", 0.27), ("right", -0.27)):
            top, knee, ankle = (x, y, 0.78), (x - 0.01, 1.05 * y, 0.46), (x + 0.01, 1.1 * y, 0.24)
            upper, lower, paw = (f"{place} {what} {side}" for what in ("leg", "shin", "paw"))
            legs += [
                (
                    Bone(upper, parent, top, knee),
                    Limb(upper, np.array([top, knee]), np.array([0.22, 0.185]), 0.34),
                ),
                (
                    Bone(lower, upper, knee, ankle),
                    Limb(lower, np.array([knee, ankle]), np.array([0.185, 0.17]), 0.08),
                ),
                (
                    Bone(paw, lower, ankle, (x + 0.03, 1.1 * y, 0.06)),
                    Egg(paw, (x + 0.04, 1.1 * y, 0.17), (0.24, 0.21, 0.17), 0.10),
                ),
            ]
    return legs


def animal() -> Animal:
    """A plump animal on four legs, with ears and a tail."""
    flesh = [
        (
            Bone("rump", "", (-0.05, 0.0, 0.98), (-0.60, 0.0, 0.98)),
            Egg("rump", (-0.34, 0.0, 0.98), (0.62, 0.49, 0.50)),
        ),
        (
            Bone("chest", "rump", (-0.05, 0.0, 0.98), (0.50, 0.0, 1.0)),
            Egg("chest", (0.30, 0.0, 1.0), (0.58, 0.46, 0.47), 0.40),
        ),
        (
            Bone("neck", "chest", (0.52, 0.0, 1.16), (0.80, 0.0, 1.58)),
            Limb(
                "neck",
                curve([(0.46, 0, 1.08), (0.66, 0, 1.34), (0.80, 0, 1.58)], 9),
                np.linspace(0.36, 0.27, 9),
                0.26,
            ),
        ),
        (
            Bone("head", "neck", (0.82, 0.0, 1.60), (1.30, 0.0, 1.60)),
            Egg("head", (0.90, 0.0, 1.68), (0.37, 0.35, 0.34), 0.16),
        ),
        (
            None,
            Limb(
                "snout",
                curve([(1.0, 0, 1.62), (1.18, 0, 1.57), (1.32, 0, 1.54)], 7),
                np.linspace(0.25, 0.185, 7),
                0.16,
            ),
        ),
        (
            Bone("tail", "rump", (-0.88, 0.0, 1.16), (-1.36, 0.0, 1.52)),
            Limb(
                "tail",
                curve([(-0.78, 0, 1.08), (-1.05, 0, 1.22), (-1.26, 0, 1.42), (-1.34, 0, 1.66)], 17),
                np.linspace(0.17, 0.065, 17),
                0.16,
            ),
        ),
    ]
    for side, y in (("left", 1.0), ("right", -1.0)):
        way = curve([(0.80, 0.20 * y, 1.88), (0.74, 0.27 * y, 2.08), (0.66, 0.31 * y, 2.26)], 9)
        start, end = (0.80, 0.20 * y, 1.90), (0.66, 0.31 * y, 2.26)
        flesh.append(
            (
                Bone(f"ear {side}", "head", start, end),
                Limb(
                    f"ear {side}",
                    way,
                    np.array([0.12, 0.13, 0.135, 0.13, 0.12, 0.105, 0.085, 0.065, 0.045]),
                    0.07,
                ),
            )
        )
    flesh += _legs()
    marks = {
        "eye left": (1.14, 0.22, 1.79), "eye right": (1.14, -0.22, 1.79), "nose": (1.50, 0.0, 1.60),
        "tail": (-1.34, 0.0, 1.74), "ear left": (0.64, 0.32, 2.30), "ear right": (0.64, -0.32, 2.30),
    }  # fmt: skip
    bones = tuple(bone for bone, _ in flesh if bone is not None)
    return Animal(Body(tuple(part for _, part in flesh)), bones, _poses(), marks)


def _everywhere(names: str, change: Change) -> dict[str, Change]:
    """The same change for all legs, feet or ears that begin with a name."""
    sides = [f"{name} {side}" for name in names.split(", ") for side in ("left", "right")]
    return dict.fromkeys(sides, change)


def _poses() -> dict[str, Pose]:
    legs, paws = "fore leg, hind leg, fore shin, hind shin", "fore paw, hind paw"
    return {
        "tall": {
            **_everywhere(legs, Change(long=2.3, thick=0.84)),
            **_everywhere(paws, Change(long=0.95, thick=0.95)),
            "rump": Change(long=0.86, thick=0.86), "chest": Change(long=0.86, thick=0.86),
            "neck": Change((0.0, -14.0, 0.0), 1.5, 0.86), "head": Change((0.0, 14.0, 0.0), 0.96, 0.96),
            **_everywhere("ear", Change(long=1.2)), "tail": Change((0.0, -50.0, 0.0), 1.25, 0.9),
        },
        "fat": {
            "rump": Change(long=1.06, thick=1.50), "chest": Change(long=1.06, thick=1.46),
            "neck": Change((0.0, 8.0, 0.0), 0.9, 1.36), "head": Change(thick=1.12, long=1.0),
            **_everywhere(legs, Change(long=0.86, thick=1.34)), **_everywhere(paws, Change(thick=1.25)),
            "tail": Change((0.0, 20.0, 0.0), 0.8, 1.5), **_everywhere("ear", Change(long=0.75, thick=1.1)),
        },
        "long": {
            "neck": Change((0.0, -6.0, 0.0), 3.4, 0.95), "head": Change((0.0, 12.0, 0.0), 0.86, 0.82),
            "tail": Change((0.0, -34.0, 0.0), 2.5, 1.35),
            "rump": Change(long=1.12, thick=1.04), "chest": Change(thick=1.02),
            **_everywhere("ear", Change(long=0.5, thick=0.72)),
            **_everywhere(legs, Change(long=1.05, thick=1.16)), **_everywhere(paws, Change(thick=1.16)),
        },
        "bent": {
            "rump": Change((0.0, -30.0, 0.0)), "chest": Change((0.0, -22.0, 0.0)),
            "neck": Change((0.0, 26.0, 0.0), 1.1), "head": Change((0.0, 18.0, 38.0)),
            **_everywhere("hind leg", Change((0.0, -14.0, 0.0), 1.0, 1.1)),
            **_everywhere("hind shin", Change((0.0, 44.0, 0.0), 1.0, 1.1)),
            **_everywhere("fore leg", Change((0.0, -16.0, 0.0), 1.05)),
            **_everywhere("fore shin", Change((0.0, 84.0, 0.0), 1.1)),
            "tail": Change((0.0, 36.0, 0.0), 1.35), **_everywhere("ear", Change((0.0, -18.0, 0.0), 1.15)),
        },
    }  # fmt: skip


def weights(beast: Animal, V: Array, F: Index) -> Array:
    """Return how much each bone moves each vertex (b, n): mostly the bone whose flesh it is."""
    names = [bone.name for bone in beast.bones]
    distance = np.full((len(names), len(V)), np.inf)
    for part in beast.body.parts:
        # The snout goes with the head.
        k = names.index(part.name) if part.name in names else names.index("head")
        size = float(np.mean(part.radii)) if isinstance(part, Limb) else part.thickness(V[:1])[0]
        distance[k] = np.minimum(distance[k], np.maximum(part.distance(V) / size + 0.5, 0.0))
    share = (distance + 0.2) ** -_FADE
    share /= share.sum(axis=0)
    ends = topology.edges("solids", F).ends
    a, b = np.concatenate([ends, ends[:, ::-1]]).T
    count = np.bincount(a, minlength=len(V))
    for _ in range(_ROUNDS):
        mean = np.stack([np.bincount(a, row[b], len(V)) for row in share]) / count
        share = 0.5 * (share + mean)
    return np.round(share / share.sum(axis=0), 9)


def posed(beast: Animal, pose: Pose, V: Array, W: Array) -> Array:
    """Return the vertices (n, 3) in a pose, feet on the ground."""
    moved = np.zeros_like(V)
    maps: dict[str, tuple[Array, Array, Array]] = {}
    for bone, w in zip(beast.bones, W, strict=True):
        change = pose.get(bone.name, Change())
        start = np.array(bone.start)
        u = np.array(bone.end) - start
        u /= np.sqrt(np.sum(u * u))
        R = so3.exp(np.radians(change.turn))
        place = start
        if bone.parent:
            whole, parent_turn, shift = maps[bone.parent]
            place, R = whole @ start + shift, parent_turn @ R
        S = change.thick * np.eye(3) + (change.long - change.thick) * np.outer(u, u)
        # v -> R S (v - start) + place; a child inherits the turn, and its place, but not the stretch.
        A = R @ S
        maps[bone.name] = (A, R, place - A @ start)
        moved += w[:, None] * (V @ A.T + maps[bone.name][2])
    moved[:, 2] -= moved[:, 2].min()
    return np.round(moved, 7)
