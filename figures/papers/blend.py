"""Figure 3 of Kaji and Ochiai, and figures 4 and 5 of the paper on probes, cages and blended shapes."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.mesh import solids

from . import _blend_controller, _blend_family, _blend_population, _blend_ways

_THORN = ("example", "thorn")
# Files are given together: one is enough to tell.
_OWN = ("rest",)
_LED = ("view", "controller", "ray")


@figure(
    plates={
        "K3a": Plate(
            title="A thorn turned to and fro: three ways of blending",
            equations=("K 9",),
            caption=(
                "Each face with its normal has a linear map to either target, in which the large thorn is "
                "slanted (dashed, from above), and then turned by 134 degrees, one way and the other; the "
                "arrow goes to its tip. The slants are opposed, so that blended with 0.8 of both, turns and "
                "slants should cancel. By phi_so the thorn leans by 16 degrees, no more than a target (18); "
                "by the logarithm in Aff (Alexa; SAM), which mixes turn and slant, by 32; the camera sees "
                "half of this. By polar parts and quaternions it folds over. That it leans by phi_so at all "
                "comes from the maps: a normal does not tell a slant, so that the faces seem to be turned "
                "about other axes too."
            ),
        ),
        "K3a2": Plate(
            title="The same thorn, its maps known",
            equations=("K 9",),
            caption=(
                "The same targets with the maps by which they were made, which turn about the thorn's own "
                "axis alone. By phi_so the turns and the opposed slants cancel: the thorn stands upright. By "
                "the logarithm in Aff it leans by 30 degrees. By quaternions it stands as well, since here "
                "their vector parts cancel: what folds the thorn, where maps are taken from faces, is what "
                "normals add."
            ),
            params={"maps": "stated"},
        ),
        "K3b": Plate(
            title="Variations of three shapes",
            equations=("K 9",),
            caption=(
                "Left, three animals with the same faces; right, twelve mixtures of them with weights at "
                "random, not negative and of sum 1; all in one scale. The red ball in each triangle shows "
                "the weights, and the colours of the three are mixed by them as the shapes are. The draw is "
                "one in which no two are near to each other."
            ),
            params={"example": "animals", "view": "population"},
        ),
        "M4": Plate(
            title="Weights from a controller",
            equations=("M 5",),
            caption=(
                "The corners of the polygon stand for the shape at rest, above, and for three targets. The "
                "mean value coordinates of the red ball are the weights, shown by the thickness of its lines "
                "to the corners, and right is the blended shape. What the weights of the targets lack of 1 "
                "is the rest's, w_0."
            ),
            params={"example": "animals", "view": "controller", "phase": 215.0, "reach": 0.62},
        ),
        "M5": Plate(
            title="From the middle of a controller through a corner and beyond",
            equations=("M 5",),
            caption=(
                "The ball of the controller goes from the middle towards corner 3 and beyond; w holds the "
                "weights of corners 1 to 3, and 0 is the rest. At the corner they are (0, 0, 1) and the "
                "blended shape is that target, vertex by vertex. Beyond it weights are outside of [0, 1], "
                "and what the target has more than the others grows further. How far off: the farthest "
                "vertex from target 3, in lengths of the rest."
            ),
            params={"example": "animals", "view": "ray", "phase": 0.0, "reach": 1.8},
        ),
    },
    time=Time("phase", 0.0, 360.0, frames=60, seconds=5.0, closed=True),
    mesh=("view", "ways", "controller", "shape"),
)
def blend(
    view: Annotated[
        Literal["ways", "population", "controller", "ray", "shape"],
        Param(
            "three ways side by side; many mixtures; weights by a controller; from its middle outwards; or "
            "the blended shape alone"
        ),
    ] = "ways",
    example: Annotated[Literal["thorn", "animals"], Param("which shapes of ours", unless=_OWN)] = "thorn",
    weights: Annotated[
        tuple[float, ...],
        Param("of the targets, or one for all of them", low=-5.0, high=5.0, only=("view", "ways", "shape")),
    ] = (0.8,),
    way: Annotated[
        Literal["phi_so", "phi_se", "alexa", "polar_quaternion", "dual_quaternion", "linear"],
        Param("of blending transformations; with ways, the first of three"),
    ] = "phi_so",
    phase: Annotated[
        float,
        Param(
            "direction of the controller's point; or moment of a film, in which weights grow from 0 to their "
            "own at 180 and shrink again",
            "deg",
            0.0,
            360.0,
        ),
    ] = 180.0,
    reach: Annotated[
        float,
        Param("of the controller's point from the middle; corners are at 1", low=0.0, high=2.0, only=_LED),
    ] = 0.6,
    maps: Annotated[
        Literal["faces", "stated"],
        Param(
            "of the thorn's faces: with their normals, or as the targets are made", only=_THORN, unless=_OWN
        ),
    ] = "faces",
    angle: Annotated[float, Param("turn of the thorn", "deg", 0.0, 180.0, only=_THORN, unless=_OWN)] = 134.0,
    shear: Annotated[
        float, Param("of the thorn, as a logarithm", low=0.0, high=0.6, only=_THORN, unless=_OWN)
    ] = 0.3,
    stretch: Annotated[
        tuple[float, float, float],
        Param("of the thorn (x, y, z), as logarithms", low=-0.5, high=0.5, only=_THORN, unless=_OWN),
    ] = (0.2, 0.2, 0.0),
    count: Annotated[int, Param("of variations", low=1, high=30, only=("view", "population"))] = 12,
    seed: Annotated[int, Param("of their weights", low=0, high=10**6, only=("view", "population"))] = 920,
    concentration: Annotated[
        float,
        Param(
            "of their weights: below 1 near to single shapes", low=0.1, high=10.0, only=("view", "population")
        ),
    ] = 0.7,
    up: Annotated[Literal["z", "y"], Param("which axis of the shapes is drawn upwards")] = "z",
    rest: Annotated[Path | None, Param("your own shape at rest, a mesh", positional=1)] = None,
    targets: Annotated[
        tuple[Path, ...], Param("what it becomes: meshes of the same faces", positional=2)
    ] = (),
) -> Drawing:
    """Shapes with the same faces blended by weights: three ways compared, a population, a controller.

    What to look for: two turns of a thorn that should cancel do so by phi_so, where
    the logarithm of affine maps leaves it slanted and quaternions fold it over;
    faces for which there is no logarithm are hatched and counted. Mixtures of
    animals are animals. A controller at a corner gives that target exactly, and
    beyond the corner more of it. Your own: a mesh at rest and any number of meshes
    with the same faces; -o of a mesh writes the blend by --way.
    """
    thorn = _blend_family.Thorn(angle, shear, stretch, maps == "stated")
    # A page of many shapes shows them small.
    spacing = solids.DRAFT if view in ("ways", "population") else solids.FINE
    family = _blend_family.family(example, thorn, spacing, rest, targets, up)
    grown = 0.5 - 0.5 * float(np.cos(np.radians(phase)))
    if view == "population":
        return _blend_population.drawing(family, way, count, seed, concentration, grown)
    if view == "controller":
        return _blend_controller.drawing(family, way, reach, phase)
    if view == "ray":
        return _blend_controller.ray(family, way, reach, phase)
    own = _weights(weights, len(family))
    if view == "shape":
        return _blend_controller.alone(family, way, own, grown)
    return _blend_ways.drawing(family, way, grown * own)


def _weights(weights: tuple[float, ...], count: int) -> np.ndarray:
    """One weight for each target."""
    if len(weights) not in (1, count):
        got = ",".join(f"{w:g}" for w in weights)
        many = "" if count == 1 else f", or {count}"
        raise ValueError(
            f"weights must be one number{many}, for there {'is' if count == 1 else 'are'} {count} "
            f"target{'s' * (count > 1)}; got {got}. Leave some out, or name more targets"
        )
    return np.array(weights) if len(weights) == count else np.full(count, weights[0])
