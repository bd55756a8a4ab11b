"""Figures 7.7 and 7.8 and table 7.1 of the book: a mesh edited by pins and handles."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _poisson_examples as examples
from . import _poisson_own as own
from . import _poisson_pages as pages
from . import _poisson_table as tables

_ARM = ("example", "octopus", "table")


@figure(
    plates={
        "B7.7": Plate(
            title="Pins and a handle",
            equations=("7.12", "7.14"),
            caption=(
                "Seven arms of the octopus are pinned at their tips. The top of its head is a handle, drawn "
                "with its axes: it is drawn up, stretched, and turned by 30 degrees. At the left the weight "
                "of the handle, harmonic on the surface, from 0 at the pins to 1. Such weights have a crease "
                "at the handle's border (black), and so has the edited head."
            ),
        ),
        "B7.8": Plate(
            title="An arm turned by 400 degrees",
            equations=("7.12", "7.14"),
            caption=(
                "The body is pinned (grey), and the tip of an arm (blue) is the handle: it is turned by 400 "
                "degrees and led to where the arm comes when it is rolled up. Below, the arm from near by. "
                "By rotation vectors it is rolled up. Unit quaternions turn it only by the remaining 40 "
                "degrees: it has to be pushed into itself, and hundreds of its faces are turned over (red)."
            ),
            params={"example": "octopus"},
        ),
        "T7.1": Plate(
            title="Three methods on the same edits",
            equations=("7.12", "7.13", "7.14"),
            caption=(
                "The arm rolled up by 170 and by 400 degrees; in a row the tip (blue) is at the same place. "
                "Up to half a turn quaternions and rotation vectors do nearly the same, and the weights "
                "matter: geodesic ones stretch more. Beyond, quaternions turn by the remainder only, "
                "whatever the weights; faces that are turned over are red. Stretch is the larger of s_1 and "
                "1 / s_2."
            ),
            params={"example": "table"},
        ),
    },
    time=Time("t", 0.0, 1.0),
    mesh=True,
)
def poisson(
    example: Annotated[
        Literal["handles", "octopus", "table"],
        Param("pins and handles; two ways of blending beside each other; or the three methods of table 7.1"),
    ] = "handles",
    weights: Annotated[
        Literal["harmonic", "biharmonic", "geodesic"],
        Param(
            "of the handles, between these and the pins",
            only=("example", "handles", "octopus"),
            unless=("paint",),
        ),
    ] = "harmonic",
    way: Annotated[
        Literal["phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"],
        Param(
            "of blending; only phi-so keeps turns beyond a half turn", only=("example", "handles", "octopus")
        ),
    ] = "phi-so",
    beside: Annotated[
        Literal["phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"],
        Param("the way of blending to compare with", only=("example", "octopus")),
    ] = "polar-quaternion",
    motion: Annotated[
        Literal["roll", "twist"],
        Param("the octopus's arm is rolled up, or twisted about itself", only=_ARM, unless=("mesh",)),
    ] = "roll",
    turn: Annotated[
        float,
        Param(
            "angle by which the tip of the octopus's arm is turned",
            "deg",
            -720.0,
            720.0,
            only=_ARM,
            unless=("mesh",),
        ),
    ] = 400.0,
    first: Annotated[
        float,
        Param(
            "angle of the edit in the upper row",
            "deg",
            -720.0,
            720.0,
            only=("example", "table"),
            unless=("mesh",),
        ),
    ] = 170.0,
    t: Annotated[float, Param("how far the handles are on their way", low=0.0, high=1.0)] = 1.0,
    around: Annotated[
        float, Param("seen from so much further round to the left", "deg", -180.0, 180.0)
    ] = 0.0,
    above: Annotated[float, Param("seen from so much further above", "deg", -60.0, 60.0)] = 0.0,
    up: Annotated[Literal["z", "y"], Param("which axis of your mesh is drawn upwards")] = "z",
    mesh: Annotated[Path | None, Param("your own mesh (obj, ply, stl, off, glb)", positional=1)] = None,
    handles: Annotated[
        Path | None, Param("its pins and handles with what moves these, in a file .toml or .json")
    ] = None,
    paint: Annotated[
        Path | None,
        Param(
            "weights of the handles at the vertices: columns in a .txt or .csv, or painted on a ply, obj, glb"
        ),
    ] = None,
    *,
    join: Library = Library("lietool.deform.poisson.join"),
) -> Drawing:
    """A mesh whose pinned vertices stay while handles are dragged, by Poisson's equation.

    What to look for: between pins and handles every face is given a blend of the
    transformations, and the equation joins the faces again. With quaternions a
    handle that turns by 400 degrees turns its surroundings by 40; the
    parametrisation by rotation vectors follows it all the way.

    A file for --handles, in the units of the mesh and in degrees::

        [[pin]]
        box = { low = [-1, -1, 0], high = [1, 1, 0.2] }

        [[handle]]
        name = "tip"
        ball = { centre = [0, 0, 2], radius = 0.3 }
        motion = { axis = [0, 0, 1], degrees = 400, translation = [0, 0, 0.5] }

    A pin or handle has the vertices in a box or in a ball; or those of a list,
    vertices = [17, 18], which count from 0; or those where painted numbers are
    large, attribute = { name = "held", above = 0.5 }. A motion is about the middle
    of the handle's vertices, or about its centre = [x, y, z]. It may say axis and
    degrees; turns, whole ones on top of these; scale, a number or three; or
    stretch, a symmetric matrix; translation; or matrix, 4 rows of 4, which moves
    space. As .json: {"pin": [{"vertices": [0]}], "handle": [...]}.
    """
    given = own.case(mesh, handles, paint)

    def looked(found: examples.Case) -> examples.Case:
        look = replace(found.look.turned(around, above), y_up=up == "y")
        return replace(found, look=look, join=join)

    if example == "handles":
        return pages.handles(looked(given or examples.by_head()), weights, way, t)
    if given is not None and example == "octopus":
        return pages.compare(looked(given), weights, (beside, way), t)
    if given is not None:
        return tables.table([looked(given)], [None], t)
    # Rolled up less the tip is elsewhere, and not on a straight line to where it goes.
    asked = [t * turn] if example == "octopus" else [t * first, t * turn]
    arms = [looked(examples.by_arm(degrees, motion)) for degrees in asked]
    if example == "octopus":
        return pages.compare(arms[0], weights, (beside, way), 1.0)
    return tables.table(arms, asked, 1.0)
