"""Figures 2.1, 2.6 and 3.2 of the book: what depends on the order of two motions, and what does not."""

from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure

from . import _commute_normal, _commute_plane, _commute_space

Vector = tuple[float, float]
Axis = Literal["x", "y", "z"]


@figure(
    plates={
        "B2.1": Plate(
            title="Two translations commute",
            equations=("2.4",),
            caption=(
                "A shape is carried by T_b and then by T_b' (solid), and by T_b' and then by T_b (dashed). "
                "The two ways are two sides each of one parallelogram, so both end at the same place, "
                "which T_b+b' (grey) reaches at once: translations form a commutative group."
            ),
        ),
        "B2.6": Plate(
            title="Two rotations of space do not commute",
            equations=("2.20", "2.21"),
            caption=(
                "Above: a solid turned by 30 degrees about the x axis and then by 45 degrees about the z "
                "axis; the axes stay fixed. Below: the same two turns in the other order. Right, larger and "
                "seen from another side, both ends in one place: a turn about the red axis takes R_1 "
                "to R_2 (translucent), and on the arc a corner of the solid. Its angle is that of R_1^T R_2."
            ),
            params={"group": "rotation3"},
        ),
        "B3.2": Plate(
            title="Translations are a normal subgroup",
            equations=("2.8", "3.5"),
            caption=(
                "Turn by -theta about the origin O, shift by b, turn back by theta: after the three steps "
                "the shape stands upright again, and all that has happened is a shift (dashed). Its vector "
                "is b' = R_theta b, the given b (grey) turned by theta. Faint: halfway on the turn back."
            ),
            params={"group": "normal", "b": (3.6, -0.2), "angle": 140.0, "place": (-2.2, -0.8)},
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def commute(
    group: Annotated[
        Literal["translation2", "rotation2", "rotation3", "normal"],
        Param("two translations, two rotations of the plane or of space, or a turned translation"),
    ] = "translation2",
    b: Annotated[
        Vector, Param("the shift b (x, y)", low=-100.0, high=100.0, only=("group", "translation2", "normal"))
    ] = (4.0, 0.3),
    b2: Annotated[
        Vector, Param("the shift b' (x, y)", low=-100.0, high=100.0, only=("group", "translation2"))
    ] = (1.0, 2.4),
    angle: Annotated[
        float,
        Param(
            "the angle of the first turn, or theta",
            "deg",
            -1080.0,
            1080.0,
            only=("group", "rotation2", "rotation3", "normal"),
        ),
    ] = 30.0,
    angle2: Annotated[
        float,
        Param(
            "the angle of the second turn", "deg", -1080.0, 1080.0, only=("group", "rotation2", "rotation3")
        ),
    ] = 45.0,
    axis: Annotated[Axis, Param("what the first turn is about", only=("group", "rotation3"))] = "x",
    axis2: Annotated[Axis, Param("what the second turn is about", only=("group", "rotation3"))] = "z",
    place: Annotated[
        Vector,
        Param(
            "where the marked corner of the shape stands (x, y)",
            low=-100.0,
            high=100.0,
            only=("group", "translation2", "rotation2", "normal"),
        ),
    ] = (0.9, 2.7),
    t: Annotated[float, Param("how much of the ways is done", low=0.0, high=1.0)] = 1.0,
) -> Drawing:
    """The order of two motions: translations commute, rotations of space do not, and (3.5).

    What to look for: with --group translation2 (or rotation2) both ways end at
    the same place. With rotation3 they do not, unless the axes are the same or
    a turn does nothing: the angle between both ends is printed. With normal, the
    shape that was turned, shifted and turned back has only been shifted, by the
    turned vector. At t < 1 the shape is on its way, along both ways at once. For
    a rotation and a translation see transform2 --kind rigid.
    """
    first, second = np.deg2rad(angle), np.deg2rad(angle2)
    match group:
        case "translation2":
            return _commute_plane.translations(np.array(b), np.array(b2), np.array(place), t)
        case "rotation2":
            return _commute_plane.rotations(float(first), float(second), np.array(place), t)
        case "rotation3":
            return _commute_space.rotations((axis, axis2), (float(first), float(second)), t)
        case _:
            return _commute_normal.drawing(float(first), np.array(b), np.array(place), t)
