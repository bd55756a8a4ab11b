"""Figures 2.2 and 2.3 of the book, and equation (2.9): the rigid transformations of the plane."""

from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _transform2
from ._dual_motions import Motions

Vector = tuple[float, float]


@figure(
    plates={
        "B2.2": Plate(
            title="A rotation of the plane",
            equations=("2.1", "2.2"),
            caption=(
                "A shape before (grey) and after R_theta, the rotation by theta about the origin, and in "
                "between after a third and two thirds of the turn (pale). The marked point x goes to "
                "x' = R_theta x and stays on its circle; every other point of the shape, such as the one "
                "furthest from the origin (grey dot), stays on its own and turns by the same angle."
            ),
        ),
        "B2.3": Plate(
            title="First a rotation, then a translation",
            equations=("2.5", "2.7"),
            caption=(
                "R_theta turns the shape about the origin O, then T_b shifts it (solid arrows, orange end). "
                "In the other order (dashed arrows, purple shapes) it comes to stand turned alike, but "
                "elsewhere: from the turned shape the shift is b' = R_theta b instead of b, for "
                "R_theta T_b = T_b' R_theta. The angle between b and b' is theta. Faint: halfway on the turn."
            ),
            params={"kind": "rigid", "angle": 100.0, "b": (2.8, 1.3), "place": (2.8, 0.2)},
        ),
        "B2.3b": Plate(
            title="A rotation about another point",
            equations=("2.9",),
            caption=(
                "T_b R_theta T_-b in three steps (solid): a shift that brings the centre b to the origin, a "
                "turn by theta about the origin O, and the shift back. The same shape is reached at once "
                "by a turn by the same angle about b (dashed)."
            ),
            params={"kind": "about", "angle": 60.0, "b": (3.0, 0.1), "place": (5.1, 1.2)},
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def transform2(
    kind: Annotated[
        Literal["rotation", "rigid", "about"],
        Param("a turn about the origin, one with a shift, or a turn about another point"),
    ] = "rotation",
    angle: Annotated[float, Param("the angle theta of the turn", "deg", -1080.0, 1080.0)] = 150.0,
    b: Annotated[
        Vector,
        Param(
            "the shift b (x, y); with about, the centre of the turn",
            low=-100.0,
            high=100.0,
            only=("kind", "rigid", "about"),
        ),
    ] = (2.2, -0.6),
    place: Annotated[
        Vector, Param("where the marked corner of the shape stands (x, y)", low=-100.0, high=100.0)
    ] = (2.1, -1.1),
    t: Annotated[float, Param("how much of the motion is done", low=0.0, high=1.0)] = 1.0,
    *,
    number: Library = Library("lietool.lie.dual_complex.from_matrix"),
    multiply: Library = Library("lietool.lie.dual_complex.multiply"),
    act: Library = Library("lietool.lie.dual_complex.act"),
) -> Drawing:
    """A turn, a turn with a shift, or a turn about another point, of a shape in the plane.

    What to look for: with --kind rotation the marked point stays on its circle
    about the origin. With rigid, follow the solid arrows (turn, then shift) and
    the dashed ones (shift, then turn): both ends are turned alike, and the shifts
    that lead there from the turned shape are b and R_theta b. With about, three
    steps amount to one turn about b. At t < 1 the shape is on its way.
    """
    theta, shift, start = float(np.deg2rad(angle)), np.array(b), np.array(place)
    by = Motions(number, multiply, act)
    match kind:
        case "rotation":
            return _transform2.rotation(theta, start, t, by)
        case "rigid":
            return _transform2.rigid(theta, shift, start, t, by)
        case _:
            return _transform2.about(theta, shift, start, t, by)
