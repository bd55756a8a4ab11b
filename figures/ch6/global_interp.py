"""Figures 6.1 to 6.8 of the book, and what its sections 6.4 and 6.5 say besides."""

from pathlib import Path
from typing import Annotated, Literal

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _morph, _pairs
from . import _morph_pages as pages
from ._morph_form import Forms

_MOVING = ("stage", "local", "global", "morph", "frames")
_WHOLE = ("stage", "global", "morph", "frames")


@figure(
    plates={
        "B6.4": Plate(
            title="From local to global",
            equations=("6.2",),
            caption=(
                "The same moment: of all whole shapes, the one whose maps B_i(t) are nearest to the A_i(t) "
                "in the sense of E^F. The triangles are stitched together again, and none is turned over."
            ),
        ),
        "B6.1": Plate(
            title="Two compatibly triangulated shapes",
            equations=("5.2",),
            caption=(
                "The problem: a continuous way from the source to the target. Both have the same triangles. "
                "Equal numbers stand at the same vertex, colours run from nose to tail, and a band of "
                "triangles is dark in both."
            ),
            params={"stage": "ends"},
        ),
        "B6.2": Plate(
            title="Local affine maps",
            equations=("5.2",),
            caption=(
                "Five points and the triangles {1, 2, 5}, {2, 4, 5} and {2, 3, 4} in two poses. Each "
                "triangle has its own linear map A_i. Below, each triangle about its centre: as it is in the "
                "source (dashed), under A_i (filled), and half way, under A_i(1/2) (thin outline); beside it "
                "A_i in numbers."
            ),
            params={"example": "three-triangles", "stage": "maps"},
        ),
        "B6.3": Plate(
            title="Local interpolation",
            equations=("5.2", "6.2"),
            caption=(
                "Half way, each triangle is where its own map has taken it: by the linear part A_i(t) and by "
                "a translation that goes straight in a frame that turns with the whole. Neighbours do not "
                "agree on where their common edge goes (in the ring: as either of them has it), and the "
                "shape is torn apart."
            ),
            params={"stage": "local"},
        ),
        "B6.5": Plate(
            title="E^F and constraints that wind the other way",
            equations=("6.2",),
            caption=(
                "Nose and tail must stay on two curves, drawn anew in each frame, which turn the other way "
                "round than the local maps do. E^F cannot forgive that: the fish shrinks, and half way most "
                "of its triangles (red) are turned over. A fish that followed the curves, as under E^R "
                "(grey, dotted), would cost more still by E^F: right plot."
            ),
            params={"example": "fish", "stage": "frames", "constraint": "loci"},
        ),
        "B6.6": Plate(
            title="E^F with angles within half a turn",
            equations=("6.2",),
            caption=(
                "The snake rolls up, by consistent angles from -55 to 532 degrees (grey), but each local "
                "angle is taken in (-180, 180] (middle plot). Where the angles jump by a full turn, "
                "neighbours turn opposite ways: the snake kinks and folds over itself, and a few triangles "
                "(ringed, and for t = 1/2 larger, in red) are turned over."
            ),
            params={"example": "snake", "stage": "frames", "angles": "principal"},
        ),
        "B6.7": Plate(
            title="E^R with the same constraints as E^F",
            equations=("6.4", "6.5"),
            caption=(
                "The input of figure 6.5. E^R takes no account of how each triangle is turned and scaled as "
                "a whole: the fish follows the curves the other way round, and no triangle is turned over. "
                "By E^F this way costs more than the one that E^F finds (grey, dotted): right plot."
            ),
            params={"example": "fish", "stage": "frames", "constraint": "loci", "energy": "similarity"},
        ),
        "B6.8": Plate(
            title="E^R finds the rotations by itself; E^F needs consistent angles",
            equations=("6.2", "6.4", "6.5"),
            caption=(
                "Above, E^F with the angles in (-180, 180], which break the snake. In the middle, E^R with "
                "the same angles, and one edge of the head (two dots) held: the snake rolls up whole, since "
                "E^R does not depend on the angles. Below, E^F does as well with angles that are consistent "
                "over the mesh."
            ),
            params={
                "example": "snake",
                "stage": "frames",
                "angles": "principal",
                "energy": "similarity",
                "beside": "both-angles",
            },
        ),
        "G6.1": Plate(
            title="Distances of points, E^P, beside E^F",
            equations=("6.1", "6.2"),
            caption=(
                "A snake whose triangles are small at the ends, half way from P to Q; nose and tail are led "
                "closer together than the local maps say. E^P sums distances of corners, so that a triangle "
                "counts by the square of its area: large ones keep their shape, and the tail's tip (ring) is "
                "given up. E^F counts by the area itself and spreads the error. The plot has a dot for each "
                "triangle."
            ),
            params={
                "example": "swallow",
                "stage": "global",
                "constraint": "loci",
                "winding": 0,
                "beside": "point",
            },
        ),
        "G6.2": Plate(
            title="Points up to similarity, E^S, beside E^R",
            equations=("6.3", "6.4"),
            caption=(
                "Nose and tail lead the cat backwards round, against its local maps. E^S, which measures by "
                "the corners but forgives each triangle its turn and its size, lets it follow, and no "
                "triangle is turned over; E^R gives nearly the same. E^F, below, leaves the body behind, and "
                "parts of it, above all the tail, are turned over (red)."
            ),
            params={
                "example": "cat",
                "stage": "frames",
                "constraint": "loci",
                "energy": "point-similarity",
                "beside": "frobenius",
            },
        ),
        "G6.3": Plate(
            title="A balance of E^F and E^R",
            equations=("6.2", "6.4"),
            caption=(
                "Nose and tail come closer on their curves. E^R (below) lets the whole gecko shrink with "
                "them; with a share of E^F (above) the triangles keep more of their size, and the area does "
                "not sink as far. The price: at the tip of the tail, which its curve pulls at, triangles are "
                "squeezed more, and the least determinant falls lower for a while."
            ),
            params={
                "example": "gecko",
                "stage": "frames",
                "constraint": "loci",
                "winding": 0,
                "energy": "balanced",
                "beside": "similarity",
            },
        ),
        "G6.4": Plate(
            title="The symmetrised error",
            equations=("6.2",),
            caption=(
                "The bulge wanders, so that triangles which are large in P are small in Q. The way from the "
                "target back to the source (purple, dashed) is another than the way there under E^F (left), "
                "whose weights and maps are those of one direction. Under the symmetrised error (right) the "
                "two are the same. The plot: the largest distance of a vertex, over the size of P."
            ),
            params={
                "example": "swallow",
                "stage": "global",
                "constraint": "loci",
                "winding": 0,
                "beside": "symmetric",
            },
        ),
        "G6.5": Plate(
            title="An edge held, or its direction alone, and the barycentre on a curve",
            equations=("6.2", "6.4"),
            caption=(
                "The barycentre (dot) follows its curve, on which the frames lie. Above, the vector between "
                "two vertices of the trunk (arrow) turns backwards, by a full turn other than the local maps "
                "say, and E^R lets the whole cat follow. Below, only the direction (dashed line) is given, "
                "n . (v_k - v_l) = 0, and rears up by 40 degrees: the length of the edge is free, and a "
                "share of E^F, which keeps sizes, lets the cat shrink a little."
            ),
            params={
                "example": "cat",
                "stage": "frames",
                "constraint": "held",
                "energy": "similarity",
                "beside": "direction",
            },
        ),
    },
    time=Time("t", 0.0, 1.0),
    mesh=_MOVING,
)
def global_interp(
    stage: Annotated[
        Literal["ends", "maps", "local", "global", "morph", "frames"],
        Param(
            "both shapes, local maps, one moment torn apart or stitched, that shape alone, or a strip of "
            "frames"
        ),
    ] = "global",
    example: Annotated[
        Literal["gecko", "fish", "snake", "cat", "swallow", "three-triangles"], Param("which pair of shapes")
    ] = "gecko",
    t: Annotated[
        float, Param("the moment; with ends, where from nose to tail a band is marked", low=0.0, high=1.0)
    ] = 0.5,
    energy: Annotated[
        Literal["frobenius", "point", "similarity", "point-similarity", "balanced", "symmetric"],
        Param(
            "how far maps are from the local ones: E^F, E^P, E^R, E^S, a balance, or both ways", only=_WHOLE
        ),
    ] = "frobenius",
    beside: Annotated[
        Literal["none", "frobenius", "point", "similarity", "symmetric", "both-angles", "direction"],
        Param(
            "a second row or shape, by this energy with consistent angles; or E^F with the same angles "
            "above, and with consistent ones below; or E^R and a share of E^F, barycentre thrown, only the "
            "direction of an edge given",
            only=("stage", "global", "frames"),
        ),
    ] = "none",
    homotopy: Annotated[
        Literal["logexp", "arap", "linear"],
        Param("of the local maps: A^E, A^P or A^L", only=("stage", "maps", *_MOVING[1:])),
    ] = "logexp",
    angles: Annotated[
        Literal["consistent", "principal"],
        Param("of the local maps: without jumps over the mesh, or each within half a turn", only=_MOVING),
    ] = "consistent",
    constraint: Annotated[
        Literal["line", "loci", "held"],
        Param(
            "barycentre on a line; nose and tail on curves; or barycentre thrown and an edge held",
            only=_WHOLE,
        ),
    ] = "line",
    winding: Annotated[
        int,
        Param(
            "full turns that loci or edge are led away from the local maps",
            low=-2,
            high=2,
            only=("constraint", "loci", "held"),
        ),
    ] = -1,
    seed: Annotated[
        float,
        Param("where from nose to tail the consistent angles begin", low=0.0, high=1.0, only=_MOVING),
    ] = 0.0,
    turns: Annotated[int, Param("full turns added to all local angles", low=-2, high=2, only=_MOVING)] = 0,
    w: Annotated[
        float, Param("the share of E^F in a balance with E^R", low=0.0, high=1.0, only=("energy", "balanced"))
    ] = 0.5,
    weights: Annotated[
        Literal["area", "equal"], Param("of the triangles in the energy", only=_WHOLE)
    ] = "area",
    steps: Annotated[
        int, Param("frames from either end to the moment t", low=1, high=3, only=("stage", "frames"))
    ] = 2,
    source: Annotated[
        Path | None, Param("your own shape: an outline (svg, csv, json) or a mesh", positional=1)
    ] = None,
    target: Annotated[
        Path | None, Param("the shape that it turns into, of the same kind", positional=2)
    ] = None,
    *,
    matrix: Library = Library("lietool.interp.forms.matrix"),
    pull: Library = Library("lietool.interp.forms.pull"),
    similarity: Library = Library("lietool.interp.forms.similarity"),
) -> Drawing:
    """Two triangulated shapes and the ways between them, from the local maps to the whole shape.

    What to look for: the local maps alone tear the shape apart; an energy
    stitches it together. E^F asks that each triangle be turned just as its local
    map turns it, so that constraints or angles that contradict this make triangles
    shrink and turn over (red, counted); E^R leaves that open and follows. The
    plots beside a strip: the least determinant, below 0 where a triangle is turned
    over, the area of the whole, and one energy, the same for all rows, over t.
    """
    pair = _pairs.pair(example, source, target)
    choice = _morph.Choice(energy, homotopy, angles, constraint, seed, turns, winding, w, weights)
    forms = Forms(matrix, pull, similarity)
    match stage:
        case "ends":
            return pages.ends(pair, t)
        case "maps":
            return pages.maps(pair, choice, t)
        case "local":
            return pages.local(pair, choice, t)
        case "global" if beside != "none":
            return pages.beside(pair, choice, forms, beside, t)
        case "global":
            return pages.whole(pair, choice, forms, t)
        case "morph":
            return pages.alone(pair, choice, forms, t)
    return pages.frames(pair, choice, forms, beside, steps, t)
