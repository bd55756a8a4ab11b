"""Figures 2.9 and 3.1 of the book, and figure 1 of Kaji and Ochiai: how the groups lie in each other."""

from typing import Annotated, Literal

from lietool.figure import Drawing, Param, Plate, figure

from . import _groups_classes as classes
from . import _groups_cube as cube
from . import _groups_order as order

ALL = "SO,O,SE,E,GL,GL+,SL,CO+,R+,Sym+,Diag+,R,Sim+,Aff+,Aff"


@figure(
    plates={
        "B2.9": Plate(
            title="Dual quaternions and related groups",
            equations=("2.29", "2.30", "2.38", "2.40", "4.16"),
            caption=(
                "Left the plane, right space; below rotations, above with translations. In front unit "
                "numbers, behind the motions v -> ... that they stand for: a number and its negative give "
                "the same one. Every way along the arrows from S^1 to SE(3) leads to the same motion. All "
                "eight are connected. Here |z| = |q| = |p_0| = 1, and w is orthogonal to q."
            ),
        ),
        "B3.1": Plate(
            title="Inclusions of Lie groups",
            equations=("3.1", "3.2", "3.3", "3.4", "3.7", "3.8", "3.9", "3.10"),
            caption=(
                "To the right reflections join, and with them a second component (a second sheet); upwards "
                "translations, in a semidirect product; to the back stretches, by the polar decomposition. "
                "Only SO(n) and O(n) are compact. The dimensions are those for n = 2 and n = 3."
            ),
            params={"diagram": "inclusions"},
        ),
        "K1": Plate(
            title="The hierarchy of 3D transformations and their parameters",
            equations=("K 1", "K 2"),
            caption=(
                "Nine classes, the larger above the smaller. Twelve numbers, of rotation, translation and "
                "stretch, are the parameters of an affine map; each class is a linear subspace of them, in "
                "which some are free and the rest zero, or equal on the diagonal of Y. Pale outline: the "
                "shape. Orange: under the part of one and the same random parameter that lies in the class."
            ),
            params={"diagram": "hierarchy"},
        ),
    }
)
def groups(
    diagram: Annotated[
        Literal["dual-quaternion", "inclusions", "hierarchy", "custom"],
        Param("which groups, and how they are laid out"),
    ] = "dual-quaternion",
    n: Annotated[
        Literal["both", "2", "3"],
        Param(
            "dimension of the space; both in the inclusions, else 3",
            only=("diagram", "inclusions", "hierarchy", "custom"),
        ),
    ] = "both",
    nodes: Annotated[
        str, Param("groups with commas between them, such as SO(2),SO,DQ", only=("diagram", "custom"))
    ] = ALL,
    seed: Annotated[
        int, Param("of the shape's deformation", low=0, high=9999, only=("diagram", "hierarchy"))
    ] = 9337,
) -> Drawing:
    """How the groups lie in each other: a cube, or layers, drawn from what is known of each.

    What to look for: in both cubes parallel arrows do the same thing, and a
    group of the upper face is made of the one below it and the translations.
    Arrows with a hook are inclusions, those with two heads are onto, and two
    elements lead to each. Whatever is drawn is looked up: dimension,
    compactness and components in the records of the groups, the arrows as the
    steps between which no other group of the diagram lies. Name your own with
    --diagram custom --nodes "SO(2),SO,SE,GL+,DQ".
    """
    dimension = 2 if n == "2" else 3
    if diagram == "custom":
        return order.drawing(order.read(nodes, dimension))
    if diagram == "hierarchy":
        return classes.drawing(dimension, seed)
    if diagram == "dual-quaternion":
        return cube.drawing(cube.DUAL_NODES, cube.DUAL, "elements")
    included = [(name, dimension) for name in cube.INCLUDED]
    return cube.drawing(included, cube.inclusions("n" if n == "both" else dimension), n)
