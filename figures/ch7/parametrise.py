"""Figure 7.1 of the book."""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import affine, so3
from lietool.render.scene import Picture

from . import _parametrise_page as page
from ._parametrise_shown import EXACT, Shown, of_rigid, shown, unit

Vector = tuple[float, float, float]
_PHI_SE, _PSI_SE = Library("lietool.lie.affine.phi_se"), Library("lietool.lie.affine.psi_se")
_EXP, _LOG = Library("lietool.lie.se3.exp"), Library("lietool.lie.se3.log")


@figure(
    plates={
        "B7.1": Plate(
            title="The parametrisation of Aff+(3) and its inverse",
            equations=("7.1", "7.2", "7.3", "7.4", "7.5", "7.6", "7.7", "7.8"),
            caption=(
                "Above, phi_se: the letter is stretched by exp(Y) along the three axes of Y, turned about "
                "the axis x, and taken by d. Below, psi: what A is in the linear space, the logarithms of "
                "its stretches, the rotation vector in the ball of radius pi, and l, in whose direction the "
                "origin sets out on its way to d."
            ),
        ),
        "B7.1b": Plate(
            title="psi gives the principal rotation",
            equations=("7.1", "7.2", "7.6", "7.8"),
            caption=(
                "A turn by 250 degrees is the same as one by 110 the other way. phi_se takes x from outside "
                "of the ball of radius pi; psi answers with the vector inside of it, and with another l, for "
                "which A is the same. Such a choice cannot be continuous everywhere: where x leaves the "
                "ball, psi(A) enters it at the opposite point."
            ),
            params={"angle": 250.0},
        ),
        "B7.1c": Plate(
            title="The parametrisation with a plain translation",
            equations=("K 1", "K 2", "K 3", "K 7", "K 8"),
            caption=(
                "The same stretch and rotation by phi_so, the map of Kaji and Ochiai: the translation "
                "comes last, as it is. The origin goes straight to l, and l does not depend on "
                "which of the rotation vectors is taken."
            ),
            params={"map": "phi_so"},
        ),
    },
    time=Time("angle", 0.0, 360.0, frames=72, closed=True),
)
def parametrise(
    axis: Annotated[Vector, Param("axis of the rotation (x, y, z), brought to length 1")] = (0.5, -0.5, 0.7),
    angle: Annotated[float, Param("angle of the rotation", "deg", -720.0, 720.0)] = 80.0,
    translation: Annotated[Vector, Param("l (x, y, z)", low=-3.0, high=3.0)] = (0.0, 1.3, 0.7),
    stretch: Annotated[Vector, Param("factors along the axes of Y (x, y, z)", low=0.25, high=4.0)] = (
        1.0,
        0.7,
        1.5,
    ),
    tilt: Annotated[float, Param("turn of these axes about the x axis", "deg", -180.0, 180.0)] = -20.0,
    map: Annotated[Literal["phi_se", "phi_so"], Param("of the book, or of Kaji and Ochiai")] = "phi_se",
    *,
    phi_se: Library = _PHI_SE,
    psi_se: Library = _PSI_SE,
    exp: Library = _EXP,
    log: Library = _LOG,
) -> Drawing:
    """Parametrise: an affine transformation as rotation vector, translation and log-stretch, and back.

    What to look for: above, the letter goes from grey to orange in three steps;
    below each step are the three numbers that say it. They may be any: every
    point of the space below is a transformation with positive determinant. Turn
    by more than 180 degrees, and the vector that psi gives back (dashed) is
    another one, inside of the ball.
    """
    u = unit("axis", axis)
    Q, logs = so3.rotation("x", np.radians(tilt)), np.log(np.array(stretch))
    phi, psi = affine.phi_so, affine.psi_so
    if map == "phi_se":
        # It has exp and log of rigid motions in it, which may be others too.
        phi, psi = (phi_se, psi_se) if exp is _EXP and log is _LOG else of_rigid(exp, log)

    def at(degrees: float) -> Shown:
        return shown(map, np.radians(degrees) * u, np.array(translation), Q, logs, phi, psi)

    def film(angles: Sequence[float]) -> list[Picture]:
        return page.pictures([at(degrees) for degrees in angles])

    now = at(angle)
    numbers = {
        "parameters": now.given,
        "A": now.A,
        "R": now.R,
        "S": now.S,
        "d": now.d,
        "log_stretch": now.logs,
        "principal": now.back,
        "same": now.same,
        "round_trip_below": EXACT if now.returns else now.off,
    }
    return Drawing(page.pictures([now])[0], numbers, film=film)
