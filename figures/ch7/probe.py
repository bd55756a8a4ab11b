"""Figures 7.2 to 7.4 of the book, and what the papers show of its probe deformer."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _probe_examples as example_
from . import _probe_own as own
from . import _probe_pages as pages
from . import _probe_recipes as recipes
from ._probe_case import Recipe

# What makes a case one's own, on a page of its own.
_OWN = ("shape", "probes", "probe", "poses")
# As in `_probe_weights` and `_probe_recipes`, which need numpy; a declaration must not.
_DISTANCES = ("inverse-distance", "cutoff", "gaussian")
_SMOOTH = ("harmonic", "biharmonic")
_REACH, _HOLD = 0.5, 0.1


@figure(
    plates={
        "B7.3": Plate(
            title="Probes at rest and moved",
            equations=("7.9",),
            caption=(
                "Four probes (frames) are put into a duck. The one in the head (2) turns by 70 degrees, "
                "grows by 1.2 and is raised, the one in the tail (3) turns by 40 degrees and grows by 1.3; "
                "the two in the body (1, 4) stay. Every vertex is moved by the blend of the four motions, "
                "weighted by its distances to the probes."
            ),
        ),
        "B7.2": Plate(
            title="A bar under the blend of two probes",
            equations=("7.9",),
            caption=(
                "The lower probe stays, the upper one turns and goes where it is when the line between both "
                "is bent to an arc of equal length; the bar follows by the blend of both motions. At 120 "
                "degrees it has 89 per cent of its volume by rotation vectors, and 52 by the linear blend of "
                "the same matrices (below), which thins it. Volumes are over that at rest."
            ),
            params={"example": "bend", "way": "phi-se", "beside": "linear"},
        ),
        "B7.4": Plate(
            title="A vortex by probes",
            equations=("7.9", "K 9"),
            caption=(
                "A disc of particles, coloured like the pieces of a cake, and two probes in its middle, one "
                "above and one below. Both turn by 450 degrees and sink, the lower one further and about an "
                "axis that leans. The nearer a particle is to the probes, the further it is taken down and "
                "around, by more than a full turn in the middle: a whirlpool with spiral arms."
            ),
            params={"example": "vortex"},
        ),
        "K2a": Plate(
            title="Four strings and two probes, one turned beyond 2 pi",
            equations=("K 9", "K 3"),
            caption=(
                "The lower probe stays; the upper one turns by 480 degrees and is moved. By rotation vectors "
                "the strings wind around each other, by 441 degrees from end to end, for their ends are not "
                "quite at the probes. Unit quaternions know nothing of the full turn, and of the 480 degrees "
                "are left 120: at the right the strings are wound by 111."
            ),
            params={"example": "strings"},
        ),
        "K2b": Plate(
            title="An arm turned by 390 degrees",
            equations=("K 9", "K 3"),
            caption=(
                "A probe at the tip of an arm turns by 390 degrees about an axis a little off the arm's; the "
                "weights rise along the arm from 0 to 1. By rotation vectors the arm swirls. A quaternion is "
                "the same after a full turn but for its sign: what is left are 30 degrees, and the arm "
                "hardly moves. Above at the right: by how much each place along the arm has turned."
            ),
            params={"example": "octopus"},
        ),
        "M1": Plate(
            title="A mesh with several probes",
            equations=("M 5",),
            caption=(
                "A cactus with a probe in its pot (1), which stays, one at the top (2), which turns by 110 "
                "degrees about the vertical, and one in each arm (3, 4), which leans outwards; the fourth "
                "also grows, by 1.25. Ribs, arms and flower follow."
            ),
            params={"example": "cactus"},
        ),
        "M2": Plate(
            title="Particles stirred by probes",
            equations=("M 5",),
            caption=(
                "The deformer moves points, and needs no mesh: a block of particles in coloured layers is "
                "stirred by two probes, turned by 430 degrees, one clockwise and one the other way."
            ),
            params={"example": "particles"},
        ),
    },
    time=Time("t", 0.0, 1.0),
    mesh=True,
)
def probe(
    example: Annotated[
        Literal["duck", "cactus", "bend", "vortex", "strings", "octopus", "particles"],
        Param("which shape with its probes, where none of your own is given", unless=("shape",)),
    ] = "duck",
    way: Annotated[
        Literal["phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"],
        Param("of blending; only phi-so keeps turns beyond a half turn"),
    ] = "phi-so",
    beside: Annotated[
        Literal["none", "phi-so", "phi-se", "alexa", "polar-quaternion", "dual-quaternion", "linear"],
        Param(
            "another way of blending beside it",
            only=("example", "bend", "strings", "octopus"),
            unless=_OWN,
        ),
    ] = "polar-quaternion",
    t: Annotated[
        float, Param("how far the probes are on their way, or through your sequence", low=0.0, high=1.0)
    ] = 1.0,
    turn: Annotated[
        float,
        Param("turned by so much more than the example says: its main probe", "deg", -360.0, 720.0),
    ] = 0.0,
    weights: Annotated[
        Literal["auto", "inverse-distance", "cutoff", "gaussian", "harmonic", "biharmonic"],
        Param(
            "of the probes at a point, by its distance to them, or as smooth as the surface allows between "
            "the vertices they hold; auto is the example's own, that of the file of probes, or 1/r^2"
        ),
    ] = "auto",
    power: Annotated[
        float,
        Param("of the distance in the weights", low=0.25, high=8.0, only=("weights", *_DISTANCES[:2])),
    ] = 2.0,
    reach: Annotated[
        float,
        Param(
            "where a cutoff ends, or the width of a Gaussian, over half the diagonal of the shape's box",
            low=0.02,
            high=4.0,
            only=("weights", *_DISTANCES[1:]),
        ),
    ] = _REACH,
    sum: Annotated[
        Literal["auto", "unity", "softmax", "capped", "none"],
        Param(
            "of the weights at a point: made 1, or by softmax, or at most 1; auto: 1 where all weights count",
            only=("weights", *_DISTANCES),
        ),
    ] = "auto",
    distance: Annotated[
        Literal["straight", "surface"],
        Param("straight, or along the surface", only=("weights", *_DISTANCES)),
    ] = "straight",
    hold: Annotated[
        float,
        Param(
            "how much farther than its nearest vertex a probe holds others, over half the diagonal of the "
            "shape's box",
            low=0.0,
            high=2.0,
            only=("weights", *_SMOOTH),
        ),
    ] = _HOLD,
    loose: Annotated[
        Literal["refuse", "follow"],
        Param(
            "parts of the shape in which no probe holds a vertex are refused, or follow the nearest with one",
            only=("weights", *_SMOOTH),
            needs="shape",
        ),
    ] = "refuse",
    rotation_weights: Annotated[
        str,
        Param("of the rotations, in words, where they are others: 'gaussian reach=0.3', 'harmonic', 'none'"),
    ] = "",
    translation_weights: Annotated[str, Param("of the translations, likewise")] = "",
    stretch_weights: Annotated[str, Param("of the stretches, likewise: 'none' keeps sizes as they are")] = "",
    origin: Annotated[
        Literal["centre", "world"],
        Param("what motions are expressed about: the probes' centres, or as printed the origin of the world"),
    ] = "centre",
    steps: Annotated[
        int,
        Param("stages that are shown", low=2, high=7, only=("example", "bend", "strings"), unless=_OWN),
    ] = 4,
    around: Annotated[
        float, Param("seen from so much further round to the left", "deg", -180.0, 180.0)
    ] = 0.0,
    above: Annotated[float, Param("seen from so much further above", "deg", -60.0, 60.0)] = 0.0,
    up: Annotated[Literal["z", "y"], Param("which axis of your shape is drawn upwards")] = "z",
    shape: Annotated[
        Path | None,
        Param("your own mesh (obj, ply, stl, off, glb) or cloud of points (ply, xyz)", positional=1),
    ] = None,
    probes: Annotated[Path | None, Param("your probes, in a file .toml or .json")] = None,
    probe: Annotated[
        str,
        Param("your probes in words, with ; between them: 'name=tip centre=0,0,2 axis=0,0,1 degrees=400'"),
    ] = "",
    poses: Annotated[
        Path | None,
        Param("a sequence of poses of the probes, in a file .toml or .json, which t goes through"),
    ] = None,
    inside_out: Annotated[
        Literal["raise", "nearest"],
        Param(
            "probes whose matrices reflect or flatten are refused, or moved by the nearest that do neither",
            needs="probes",
        ),
    ] = "raise",
    paint: Annotated[
        Path | None,
        Param(
            "weights of the probes at the points: columns in a .txt or .csv, or painted on a ply, obj, glb"
        ),
    ] = None,
    *,
    shepard: Library = Library("lietool.deform.weights.shepard"),
    solve: Library = Library("lietool.deform.move.solve"),
) -> Drawing:
    """A shape moved by probes: frames that take the points around them along, each by its weight.

    What to look for: near a probe the shape moves as the probe does; between
    probes their motions are blended. Rotations are added up as vectors, axis times
    angle, so that a turn by more than 360 degrees means what it says; quaternions
    and matrices forget whole turns. Probes at rest are pale, moved ones coloured.

    A file of probes for --probes, in the units of the shape and in degrees::

        [[probe]]
        name = "foot"               # it is not said to move, and stays
        centre = [0, 0, 0]

        [[probe]]
        name = "head"
        centre = [0, 0, 2]
        current = { axis = [0, 0, 1], degrees = 400, translation = [0, 0, 0.5] }

    What current may say: axis and degrees; turns, whole ones on top of these;
    scale, one number or three along the probe's axes; or stretch, a symmetric
    matrix in space; translation of the centre; or matrix, 4 rows of 4, where the
    probe's frame is now. At rest a probe may have, beside its centre, a rotation,
    of axis and degrees or 3 rows of 3; or for both a frame, 4 rows of 4.

    A sequence for --poses, by the names of the probes; each pose is a picture of
    the film, or with --seconds and --fps so many are spread over them::

        fps = 24

        [[pose]]
        head = { axis = [0, 0, 1], degrees = 0 }

        [[pose]]
        head = { axis = [0, 0, 1], degrees = 400 }

    As .json: {"probe": [{"name": "foot", "centre": [0, 0, 0]}, ...]}.

    Harmonic weights are 1 at the vertices a probe holds, and 0 at those of others:
    these about it, see --hold, or those in its table handle, by vertices, ball, box
    or attribute as in the file of poisson. Rotation, translation and stretch may
    have weights of their own, by --way phi-so, phi-se or polar-quaternion. A file
    of probes may say all that, each kind with the words of its options; reach and
    hold are in the units of the shape there::

        [weights]
        kind = "harmonic"
        rotation = { kind = "cutoff", reach = 1.5, power = 3 }
        stretch = { kind = "none" }

        [[probe]]
        centre = [0, 0, 0]

        [[probe]]
        centre = [0, 0, 2]
        handle = { ball = { centre = [0, 0, 2], radius = 0.3 } }
        current = { axis = [0, 0, 1], degrees = 90, scale = 1.5 }

    Painted ones are kind = "painted", file = "w.csv", a column for each probe.
    """
    case = example_.example(example, turn) if shape is None else own.shape(shape, turn)
    case = replace(case, shepard=shepard, solve=solve)
    case = own.poses(own.probes(case, probes, probe, turn), poses)
    recipe = None if weights == "auto" else Recipe(weights, power, reach, sum, distance, hold, loose)
    words = (rotation_weights, translation_weights, stretch_weights)
    case = recipes.weighted(case, recipe, paint, words, own.half_diagonal(case.mesh.vertices))
    case = replace(case, look=replace(case.look.turned(around, above), y_up=up == "y"))
    moving = case.moving(way, origin, inside_out)
    other = None if beside == "none" else case.moving(beside, origin, inside_out, "beside")
    match case.name:
        case "bend":
            drawing = pages.row(moving, other, t, steps)
        case "strings":
            drawing = pages.columns(moving, other, t, steps)
        case "octopus":
            drawing = pages.compare(moving, other, t)
        case _:
            drawing = pages.pair(moving, t)
    fps = 24.0 if case.poses is None else case.poses.fps
    return replace(drawing, notes=moving.notes, moments=moving.moments, fps=fps)
