"""Figures 7.5 and 7.6 of the book, and figure 3 of MEIS: a shape moved by a cage."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _cage_case as case_
from . import _cage_examples as examples
from . import _cage_explain as explained
from . import _cage_own as own
from . import _cage_pages as pages

_MAPS = ("coordinates", "maps")


@figure(
    plates={
        "B7.5": Plate(
            title="A shape in its cage",
            equations=("7.9",),
            caption=(
                "A cactus in a cage, which is bent and twisted. Every face of the cage has a map, and every "
                "point moves by the blend of these. The colour is the weight of one face (outlined): it is "
                "large in front of the face and falls off with the cube of the distance from its middle. "
                "Where it is nothing, the shape is grey at rest and orange in the pose. At the bright stripe "
                "below the face the bent shape comes a little out of its cage."
            ),
        ),
        "B7.6": Plate(
            title="The map of one face",
            equations=("7.9", "M 5"),
            caption=(
                "A face with its normal is a tetrahedron. The only affine map that takes it from where it is "
                "at rest to where it is in the pose is the map of this face: in numbers, and as a frame, "
                "pale at rest, which turns and is no longer of unit vectors. The normal's length is the root "
                "of twice the area, so that a cage grown by some factor gives maps that grow by it."
            ),
            params={"view": "explain"},
        ),
        "B7.5b": Plate(
            title="Maps of faces, edges and corners, and coordinates of the cage's vertices",
            equations=("7.9", "K 9"),
            caption=(
                "The same coarse cage bent by 120 degrees. Maps follow the cage's sides closely, and where "
                "few faces have to make the arc, each shows: faces and corners leave dents, edges fewer. "
                "Blended linearly the bar loses a little more volume. Mean value coordinates follow the "
                "kinks of the cage; Green coordinates stretch the least."
            ),
            params={"view": "compare", "example": "bar", "bend": 120.0, "twist": 0.0},
        ),
        "M3": Plate(
            title="A duck in its cage",
            equations=("M 5",),
            caption=(
                "A duck in a cage of 108 triangles. The upper part of the cage turns by 40 degrees and leans "
                "forward, and the head in it looks to the side. Colour tells the weight of one face at "
                "the cheek (outlined)."
            ),
            params={"example": "duck", "bend": 10.0, "twist": -40.0},
        ),
    },
    time=Time("t", 0.0, 1.0),
    mesh=True,
)
def cage(
    view: Annotated[
        Literal["pair", "explain", "compare"],
        Param("at rest and posed; the map of one element; or kinds of maps and coordinates side by side"),
    ] = "pair",
    example: Annotated[
        Literal["cactus", "duck", "bar"], Param("which shape and cage, where none of your own is given")
    ] = "cactus",
    t: Annotated[float, Param("how far the cage is on its way", low=0.0, high=1.0)] = 1.0,
    bend: Annotated[float, Param("angle by which the cage is bent", "deg", -270.0, 270.0)] = 60.0,
    twist: Annotated[float, Param("angle by which it is twisted", "deg", -540.0, 540.0)] = 40.0,
    coordinates: Annotated[
        Literal["maps", "mean-value", "green"],
        Param(
            "how points follow: by maps of elements, or by coordinates of the cage's vertices",
            only=("view", "pair"),
        ),
    ] = "maps",
    by: Annotated[
        Literal["faces", "edges", "corners"],
        Param("elements of the cage that have maps", only=("view", "pair", "explain"), also=_MAPS),
    ] = "faces",
    way: Annotated[
        Literal["phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"],
        Param("of blending maps; only phi-so keeps turns beyond a half turn", only=_MAPS),
    ] = "phi-so",
    turns: Annotated[
        Literal["neighbours", "followed", "principal"],
        Param(
            "of phi-so: each rotation continues its neighbour's, and also its own on the way from rest; or "
            "each is within half a turn",
            only=_MAPS,
        ),
    ] = "neighbours",
    power: Annotated[
        float, Param("of the distance in the weights of maps", low=0.5, high=8.0, only=_MAPS)
    ] = 3.0,
    ramp: Annotated[
        float,
        Param(
            "behind a face its weight rises from 0 within so much of 3 volume / area of the cage",
            low=0.02,
            high=1.0,
            only=_MAPS,
        ),
    ] = 0.5,
    origin: Annotated[
        Literal["centre", "world"],
        Param(
            "what maps are expressed about: the elements' middles, or as printed the origin of the world",
            only=_MAPS,
        ),
    ] = "centre",
    mark: Annotated[
        str,
        Param(
            "which face (edge, corner) is marked: its number from 0, or auto",
            only=("view", "pair", "explain"),
        ),
    ] = "auto",
    paint: Annotated[
        Literal["weight", "shape"],
        Param("colours: the weight of the marked element, or the shape's own", only=("view", "pair")),
    ] = "weight",
    around: Annotated[
        float, Param("seen from so much further round to the left", "deg", -180.0, 180.0)
    ] = 0.0,
    above: Annotated[float, Param("seen from so much further above", "deg", -60.0, 60.0)] = 0.0,
    up: Annotated[Literal["z", "y"], Param("which axis of your shape is drawn upwards")] = "z",
    give: Annotated[
        Literal["shape", "cage", "rest-cage"],
        Param(
            "which mesh a file .obj, .ply, .stl, .off or .glb gets: moved shape, cage in the pose or at rest"
        ),
    ] = "shape",
    shape: Annotated[
        Path | None,
        Param("your own mesh (obj, ply, stl, off, glb) or cloud of points (ply, xyz)", positional=1),
    ] = None,
    cage: Annotated[
        Path | None,
        Param("its cage, a closed mesh; one is made where there is none: --give rest-cage writes it"),
    ] = None,
    to: Annotated[Path | None, Param("the same cage moved; bent and twisted where there is none")] = None,
    faces: Annotated[int, Param("of the cage that is made, at most", low=12, high=2000, needs="shape")] = 120,
    margin: Annotated[
        float,
        Param(
            "by which it keeps from the shape, over the diagonal of the shape's box",
            low=0.002,
            high=0.5,
            needs="shape",
        ),
    ] = 0.02,
    *,
    tetrahedra: Library = Library("lietool.deform.cage_frames.tetrahedra"),
    maps: Library = Library("lietool.deform.cage_frames.maps"),
) -> Drawing:
    """A shape moved by a cage around it: every face of the cage has an affine map, and points blend them.

    What to look for: where the cage is only turned, the shape is; where its faces
    turn against each other, the shape goes evenly from one map to the next. The
    weight of a face is large next to it, and nowhere in front of it. Points
    outside of the cage move too, by the faces that see them from within, or by the
    nearest face with Green coordinates; they are counted and told.

    A shape of your own: have a cage made, move its vertices in a modeller, which
    has to keep their order, and give both::

        lietool cage my.obj --give rest-cage -o cage.obj
        lietool cage my.obj --cage cage.obj --to moved.obj -o out.obj
    """
    if shape is None:
        own.alone(cage, to)
        case = examples.example(example)
    else:
        case = own.case(shape, cage, to, faces, margin)
    look = replace(case.look.turned(around, above), y_up=up == "y")
    choice = case_.Choice(coordinates, by, way, turns, power, ramp, origin == "world", tetrahedra, maps)
    at = (t, bend, twist)
    if view == "compare":
        drawing = pages.compare(case, choice, look, at)
    elif view == "explain":
        choice = replace(choice, coordinates="maps")
        drawing = explained.explain(case, choice, look, at, case_.marked(case, choice, mark))
    else:
        drawing = pages.pair(case, choice, look, at, case_.marked(case, choice, mark), paint)
    if give != "shape":
        drawing = replace(drawing, mesh=case.cage(at if give == "cage" else (0.0, 0.0, 0.0)))
    return drawing
