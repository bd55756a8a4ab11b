"""The skeletons of the shapes: bones at rest, along the x axis, and the two poses of each.

A bone's flesh is a round cone; a pose turns bones about their first joints, in degrees relative to the bone
that they hang on, and bends what hangs on them along.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Bone:
    """A bone from `start` to `end` with flesh of radius `thick` at both; `parent` is "" for the root."""

    name: str
    parent: str
    start: tuple[float, float]
    end: tuple[float, float]
    thick: tuple[float, float]


@dataclass(frozen=True)
class Pose:
    """Turns of bones, degrees, and where the middle between nose and tail goes."""

    turns: Mapping[str, float]
    middle: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Skeleton:
    """A shape before it is meshed.

    Parameters
    ----------
    bones : tuple of Bone
        Each after the one that it hangs on.
    poses : (Pose, Pose)
        Of the source and of the target.
    spacing : float
        Of the mesh.
    blend : float
        Over how much flesh flows together in the corners between bones.
    marks : mapping from str to (float, float)
        Points at rest that become vertices: the tips for constraints, and eyes.
    """

    bones: tuple[Bone, ...]
    poses: tuple[Pose, Pose]
    spacing: float
    blend: float
    marks: Mapping[str, tuple[float, float]]


def _chain(
    name: str,
    parent: str,
    joints: list[tuple[float, float]],
    thick: list[float],
) -> list[Bone]:
    """Bones name1, name2, ... from joint to joint."""
    made = []
    for k in range(len(joints) - 1):
        above = f"{name}{k}" if k else parent
        made.append(Bone(f"{name}{k + 1}", above, joints[k], joints[k + 1], (thick[k], thick[k + 1])))
    return made


def _row(start: float, stop: float, count: int) -> list[tuple[float, float]]:
    return [(float(x), 0.0) for x in np.linspace(start, stop, count + 1)]


def _leaning(
    joints: list[tuple[float, float]], at: tuple[float, float], lean: float
) -> list[tuple[float, float]]:
    """Joints turned by an angle, degrees, and moved."""
    turn = np.exp(1j * np.radians(lean))
    moved = [complex(*at) + turn * complex(*joint) for joint in joints]
    return [(z.real, z.imag) for z in moved]


def gecko() -> Skeleton:
    """Seen from above; it turns round and bends, its tail more than its head."""
    bones = [
        *_chain("back", "", _row(0.0, 1.0, 2), [0.24, 0.31, 0.25]),
        *_chain("neck", "back2", _row(1.0, 1.3, 1), [0.22, 0.21]),
        *_chain("head", "neck1", _row(1.38, 1.72, 1), [0.29, 0.17]),
        *_chain("tail", "back1", _row(0.0, -2.5, 7), [0.23, 0.20, 0.18, 0.15, 0.13, 0.10, 0.075, 0.05]),
    ]
    for side, y in (("left", 1.0), ("right", -1.0)):
        fore = [(0.92, 0.12 * y), (1.06, 0.56 * y), (1.42, 0.72 * y), (1.56, 0.80 * y)]
        hind = [(0.06, 0.10 * y), (-0.20, 0.54 * y), (0.14, 0.82 * y), (0.28, 0.92 * y)]
        bones += _chain(f"fore {side}", "back2", fore, [0.12, 0.085, 0.075, 0.115])
        bones += _chain(f"hind {side}", "back1", hind, [0.13, 0.095, 0.08, 0.12])
    source = {"back1": 90.0, "tail2": 8.0, "tail3": 14.0, "tail4": 8.0, "tail5": -10.0, "tail6": -22.0}
    target = {"back1": 258.0, "back2": -22.0, "neck1": -22.0, "head1": -18.0}
    target |= {f"tail{k}": 24.0 for k in range(1, 8)}
    target |= {"fore left1": 24.0, "fore left2": -30.0, "fore right1": -34.0, "fore right2": 22.0}
    target |= {"hind left1": -10.0, "hind left2": 18.0, "hind right1": 14.0, "hind right2": -44.0}
    marks = {"nose": (1.89, 0.0), "tail": (-2.55, 0.0), "eye left": (1.5, 0.16), "eye right": (1.5, -0.16)}
    return Skeleton(tuple(bones), (Pose(source), Pose(target)), 0.096, 0.05, marks)


_LINKS = 30


def snake() -> Skeleton:
    """It rolls up, head outside, by one turn and a half and a little more."""
    joints = _row(0.0, -9.0, _LINKS)
    at = np.linspace(0.0, 1.0, _LINKS + 1)
    thick = np.interp(at, [0.0, 0.25, 0.6, 0.85, 1.0], [0.21, 0.28, 0.27, 0.17, 0.05]).tolist()
    bones = [
        Bone("head", "", (0.0, 0.0), (0.62, 0.0), (0.25, 0.26)),
        Bone("snout", "head", (0.62, 0.0), (0.92, 0.0), (0.26, 0.15)),
        *_chain("link", "head", joints, thick),
    ]
    source = {"head": 90.0} | _steps(58.0 * np.sin(4.0 * np.pi * at[1:]))
    target = {"head": 90.0} | _steps(_coil(9.0))
    marks = {"nose": (1.06, 0.0), "tail": (-9.04, 0.0), "eye left": (0.66, 0.14), "eye right": (0.66, -0.14)}
    return Skeleton(tuple(bones), (Pose(source), Pose(target)), 0.165, 0.05, marks)


def _coil(length: float) -> np.ndarray:
    """The directions, degrees, of links along a straight neck and then Archimedes' spiral inwards by 560."""
    total, neck = np.radians(560.0), 0.10
    angle = np.linspace(0.0, total, 2001)
    # The gap between windings is the snake's width and a little, so the inner end has what remains.
    pitch = 0.70 / (2.0 * np.pi)
    inner = ((1.0 - neck) * length - 0.5 * pitch * total**2) / total
    arc = neck * length + (inner + pitch * total) * angle - 0.5 * pitch * angle**2
    middle = (np.arange(_LINKS) + 0.5) * length / _LINKS
    return np.degrees(np.interp(middle, arc, angle))


def _steps(direction: np.ndarray) -> dict[str, float]:
    """The turns of the links that give them these directions."""
    return {f"link{k + 1}": float(turn) for k, turn in enumerate(np.diff(direction, prepend=0.0))}


def fish() -> Skeleton:
    """Seen from above; slender, it turns away and bends."""
    at = np.linspace(0.0, 1.0, 13)
    thick = np.interp(at, [0.0, 0.12, 0.3, 0.55, 0.8, 1.0], [0.20, 0.27, 0.30, 0.24, 0.13, 0.085])
    bones = _chain("back", "", _row(1.5, -2.1, 12), thick.tolist())
    for side, y in (("left", 1.0), ("right", -1.0)):
        fin = [(0.74, 0.20 * y), (0.50, 0.50 * y), (0.26, 0.66 * y)]
        bones += _chain(f"fin {side}", "back3", fin, [0.10, 0.11, 0.05])
        lobe = [(-2.1, 0.02 * y), (-2.42, 0.15 * y), (-2.78, 0.34 * y)]
        bones += _chain(f"lobe {side}", "back12", lobe, [0.09, 0.10, 0.035])
    bend = np.array([0.0, 0.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 10.0, 10.0, 9.0, 8.0])
    source = {f"back{k + 1}": float(turn) for k, turn in enumerate(-0.5 * bend)} | {"back1": 110.0}
    target = {f"back{k + 1}": float(turn) for k, turn in enumerate(bend)} | {"back1": 190.0}
    source |= {"lobe left1": -8.0, "lobe right1": -8.0}
    target |= {"lobe left1": 12.0, "lobe right1": 12.0, "fin left1": 12.0, "fin right1": 14.0}
    marks = {"nose": (1.70, 0.0), "tail": (-2.19, 0.0), "eye left": (1.28, 0.17), "eye right": (1.28, -0.17)}
    marks |= {"lobe left": (-2.81, 0.36), "lobe right": (-2.81, -0.36)}
    return Skeleton(tuple(bones), (Pose(source), Pose(target)), 0.10, 0.04, marks)


def cat() -> Skeleton:
    """Seen from the side: it crouches, and leaps."""
    bones = [
        *_chain("back", "", [(-0.86, 0.0), (-0.2, 0.05), (0.5, 0.0)], [0.36, 0.33, 0.35]),
        *_chain("neck", "back2", [(0.56, 0.10), (0.98, 0.42)], [0.30, 0.25]),
        *_chain("head", "neck1", [(1.02, 0.52), (1.14, 0.50)], [0.32, 0.29]),
        *_chain("muzzle", "head1", [(1.2, 0.42), (1.36, 0.41)], [0.17, 0.12]),
        *_chain("ear", "head1", [(0.86, 0.70), (0.80, 1.00)], [0.15, 0.035]),
        *_chain("brow", "head1", [(1.14, 0.70), (1.20, 0.98)], [0.14, 0.035]),
        *_chain(
            "tail",
            "back1",
            [(-1.08, 0.10), (-1.38, 0.2), (-1.67, 0.3), (-1.96, 0.4), (-2.25, 0.5), (-2.54, 0.6)],
            [0.12, 0.10, 0.095, 0.095, 0.09, 0.085],
        ),
    ]
    for name, parent, at, lean in (
        ("near fore", "back2", (0.62, -0.10), 26.0),
        ("far fore", "back2", (0.34, -0.10), -10.0),
        ("near hind", "back1", (-0.98, -0.06), -26.0),
        ("far hind", "back1", (-0.70, -0.10), 6.0),
    ):
        thick = [0.19, 0.115, 0.085, 0.10] if "fore" in name else [0.25, 0.135, 0.085, 0.10]
        knee = -0.02 if "fore" in name else 0.06
        leg = [(0.0, 0.0), (knee, -0.50), (-0.5 * knee, -0.96), (0.15, -1.04)]
        bones += _chain(name, parent, _leaning(leg, at, lean), thick)
    source = {"tail1": -20.0, "tail2": -24.0, "tail3": -22.0, "tail4": -26.0, "tail5": -38.0}
    source |= {"near fore1": -24.0, "far fore1": 2.0, "near hind1": 20.0, "far hind1": -2.0}
    target = {"back1": 30.0, "back2": -14.0, "neck1": -16.0, "head1": 6.0}
    target |= {"near fore1": 36.0, "near fore2": 16.0, "near fore3": -24.0}
    target |= {"far fore1": 38.0, "far fore2": 14.0, "far fore3": -24.0}
    target |= {"near hind1": -42.0, "near hind2": -18.0, "near hind3": -40.0}
    target |= {"far hind1": -40.0, "far hind2": -14.0, "far hind3": -40.0}
    target |= {"tail1": 6.0, "tail2": 10.0, "tail3": 12.0, "tail4": 8.0, "tail5": 4.0}
    marks = {"nose": (1.49, 0.41), "tail": (-2.62, 0.63), "eye": (1.14, 0.58)}
    marks |= {
        "ear": (0.79, 1.05),
        "brow": (1.21, 1.03),
        "inner fore": (0.5, 0.08),
        "inner hind": (-0.8, 0.05),
    }
    return Skeleton(tuple(bones), (Pose(source), Pose(target, (1.2, 0.9))), 0.115, 0.045, marks)
