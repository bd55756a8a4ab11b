"""Figures 5.1 to 5.6 of the book."""

from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure

from . import _triangle_affine as affine
from . import _triangle_compare as comparison
from . import _triangle_equations as diagram
from . import _triangle_map as maps
from . import _triangle_path as path
from . import _triangle_question as question

Corners = tuple[float, float, float, float, float, float]


@figure(
    plates={
        "B5.1": Plate(
            title="Two triangles, and what is between them",
            equations=("5.1", "5.2"),
            caption=(
                "One affine map carries the grey triangle with its corners p to the orange one with its "
                "corners q, and the letter with it. A homotopy A(t) of its linear part, from I at t = 0 to "
                "A at t = 1, says which triangle is between them; all are drawn at one scale, each over its "
                "t. Four homotopies, each on its lane: the straight line, the two that take rotation and "
                "stretch apart, and the power of A. Outlined: the triangle at t. They disagree, least of "
                "all A^P and A^E."
            ),
        ),
        "B5.1b": Plate(
            title="The affine map between two triangles",
            equations=("5.1", "5.2"),
            caption=(
                "The same triangles where they lie in the plane, and the map between them in numbers: the "
                "corners of both, as columns over a row of ones, determine the only affine map that carries "
                "one to the other. Its linear part A (box) carries the grey triangle to the pale one and "
                "leaves the origin where it is; the last column, d, moves that on to the orange one (by t "
                "d, for t from 0 to 1)."
            ),
            params={"equations": True, "t": 0.0},
        ),
        "B5.2": Plate(
            title="As rigid as possible: the rotation on its circle, the stretch on a straight line",
            equations=("3.11", "4.19", "5.2"),
            caption=(
                "A = R S is a point of SO(2) x Sym+(2). Left: R(t) turns evenly to R. Right: S(t) goes "
                "straight from I to S in the cone of positive definite matrices, shown with the plane "
                "through its axis in which all S(t) lie (ellipses: the unit disc under S(t)). Below: the "
                "triangles of equal steps, outlined A(t). From 0 to 1 the line stays in the cone, which is "
                "convex; farther on it meets its wall (cross), and there the triangle collapses and then is "
                "turned over (red)."
            ),
            params={"method": "arap", "steps": 2, "beyond": 1.0},
        ),
        "B5.3": Plate(
            title="Log-Exp: rotation and stretch by their logarithms",
            equations=("3.11", "4.4", "4.19", "5.2"),
            caption=(
                "The same map as a point of SO(2) x Sym+(2), drawn as before. The rotation turns as it did, "
                "but the stretch S(t) = exp(t log S) goes along a curve that bends away from the walls of "
                "the cone and never reaches them, however far t goes on: the triangle becomes thin, but "
                "never collapses. It is drawn as far as the rim."
            ),
            params={"method": "logexp", "steps": 2, "beyond": 1.0},
        ),
        "B5.4": Plate(
            title="The maps of the as-rigid-as-possible interpolation",
            equations=("2.4", "3.11", "4.19"),
            caption=(
                "From A on the left by the polar decomposition to a rotation and a stretch; down to a space "
                "where straight lines may be drawn, the angle by the logarithm, the stretch as it is; from "
                "there along the line from the identity to the moment t; up, and multiplied to A(t). "
                "Upwards the stretch remains as it is, too, which is allowed only where it is positive "
                "definite: for t outside [0, 1] it may not be, and is then red."
            ),
            params={"method": "arap", "equations": True},
        ),
        "B5.5": Plate(
            title="The maps of the Log-Exp interpolation",
            equations=("2.4", "3.11", "4.4", "4.19"),
            caption=(
                "The same diagram with a logarithm for both factors: below is a vector space, so(2) x "
                "sym(2), where the way is t times one vector, and exp carries every vector of it back to a "
                "rotation and a positive definite stretch."
            ),
            params={"method": "logexp", "equations": True},
        ),
        "B5.6": Plate(
            title="A symmetric map: straight line and power",
            equations=("4.19", "5.2"),
            caption=(
                "Upper row: the triangle under (1 - t) I + t S; lower row: under S^t = exp(t log S); "
                "outlined: at t, with that of the other row dashed over it. This S keeps areas, det S = 1, "
                "and so does each of its powers, while the straight line makes the triangle swell on the "
                "way. Plot: how the area changes, det, over the same t."
            ),
            params={"compare": "linear,exponential", "target": (2.0, -1.2, -1.2, 1.22)},
        ),
        "B5.6b": Plate(
            title="A map on which the straight line collapses",
            equations=("3.11", "4.4", "5.2"),
            caption=(
                "Both eigenvalues of A are negative. The straight line A^L passes through two singular "
                "matrices (crosses), and between them the triangle is turned over (red; larger in the "
                "ring). A^P and A^E do not mind. A has no real logarithm, so that its power A^t does not "
                "exist. Upper right: all A with det A > 0, by the angle of the rotation and the inequality "
                "of the stretches; those in the red part have no real logarithm either. The open circle is "
                "a half turn with equal stretches: it has one."
            ),
            params={"compare": "methods", "target": (-1.8, 0.35, 0.85, -0.7)},
        ),
        "B5.6c": Plate(
            title="A map that all four ways reach",
            equations=("3.11", "4.4", "5.2"),
            caption=(
                "The eigenvalues of A are not real: A has a real logarithm, and A^L does not collapse, "
                "though it shrinks. A^E and the power A^t = exp(t log A) have the same determinant for all "
                "t, but are not the same: the power does not keep rotation and stretch apart, and distorts "
                "the triangle on its way (in the ring: A^E filled, A^t dashed). Upper right: A lies beside "
                "the red part, where there is no real logarithm."
            ),
            params={"compare": "methods", "target": (-0.74, -0.33, 1.43, -0.74)},
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def triangle_interp(
    method: Annotated[
        Literal["all", "linear", "arap", "logexp", "matrix-log"],
        Param("the way from I to A, or all of them", only=("compare", "none")),
    ] = "all",
    equations: Annotated[bool, Param("how it is made, in numbers", only=("compare", "none"))] = False,
    compare: Annotated[
        Literal["none", "linear,exponential", "methods"],
        Param("the ways of the stretch alone, or all methods, beside each other with the area"),
    ] = "none",
    source: Annotated[
        Corners, Param("corners of the triangle at t = 0 (x1, y1, x2, y2, x3, y3)", low=-100, high=100)
    ] = (0.0, 0.0, 1.5, 1.4, -0.1, 1.6),
    target: Annotated[
        tuple[float, ...],
        Param("corners of the triangle at t = 1, or four numbers, the matrix A", low=-100, high=100),
    ] = (4.8, 0.5, 3.0, 2.64, 4.16, 0.61),
    turns: Annotated[
        int,
        Param(
            "full turns beyond the principal one", low=-3, high=3, only=("method", "all", "arap", "logexp")
        ),
    ] = 0,
    steps: Annotated[int, Param("equal steps from one triangle to the other", low=1, high=8)] = 4,
    beyond: Annotated[
        float,
        Param(
            "how far the way goes on before 0 and after 1",
            low=0.0,
            high=1.5,
            only=("method", "linear", "arap", "logexp", "matrix-log"),
        ),
    ] = 0.0,
    t: Annotated[float, Param("the moment that is marked", low=-1.5, high=2.5)] = 0.5,
    *,
    affine_map: Library = Library("lietool.interp.triangle.affine_map"),
    arap: Library = Library("lietool.interp.triangle.arap"),
    logexp: Library = Library("lietool.interp.triangle.logexp"),
) -> Drawing:
    """Between two triangles: four homotopies of the map that carries one to the other.

    What to look for: rotation and stretch apart, A = R S, keep the triangle whole
    from t = 0 to 1; beyond, only the one with the logarithm of S does. The straight
    line between I and A collapses where A has negative eigenvalues, and there A has no real
    logarithm either, but for a half turn with a dilation. A triangle that is flat, or the mirror
    image of the other, is refused: no way of regular maps leads to it.
    """
    turning = compare != "none" or method not in ("linear", "matrix-log")
    ways = dict(maps.METHODS) | {"arap": arap, "logexp": logexp}
    given = maps.read(source, target, turns if turning else 0, affine_map, ways)
    times = np.arange(steps + 1) / steps
    if compare == "linear,exponential":
        if turns:
            raise ValueError(
                f"turns must be 0 where the stretch alone is compared; got {turns}. Leave out turns, or "
                "compare methods"
            )
        picture = comparison.pair(given, steps, t)
        return Drawing(picture, maps.numbers(given.symmetric, ("arap", "logexp"), times, t))
    if compare == "methods":
        picture = comparison.four(given, steps, t)
        return Drawing(picture, maps.numbers(given, tuple(maps.METHODS), times, t))
    if method == "all":
        picture = affine.picture(given, t) if equations else question.picture(given, steps, t)
        return Drawing(picture, maps.numbers(given, tuple(maps.METHODS), times, t))
    if not given.exists(method):
        values = ", ".join(f"{value:.3g}" for value in np.linalg.eigvals(given.A).real)
        raise ValueError(
            f"target must give a map A with a real logarithm for matrix-log; got eigenvalues {values}. "
            "Take logexp, or compare methods"
        )
    if equations:
        picture = diagram.picture(given, method, t)
    else:
        picture = path.picture(given, method, steps, beyond, t)
    return Drawing(picture, maps.numbers(given, (method,), times, t))
