"""How the shapes of `blend` are drawn: their colours, stripes and faces, and polygons that tell weights."""

from collections.abc import Sequence

import numpy as np

from lietool.deform import controller
from lietool.mesh import solids
from lietool.render import mesh_lines, mesh_look, style
from lietool.render import solids as balls
from lietool.render.camera import Box, Camera
from lietool.render.scene import Label, Lines, Points, Record, Surface
from lietool.render.theme import Color

from ._blend_family import TONES, Family

Array = np.ndarray

# Colours of a shape and of its stripes, and of the lines around it.
REST = (style.BEFORE, style.BEFORE_EDGE, style.BEFORE_EDGE)
RESULT = (style.AFTER, style.BETWEEN, style.AFTER_EDGE)
_EDGES = (style.SHELLS_TEXT[0], style.SHELLS_TEXT[2], style.SHELLS_TEXT[1], style.ROUTE_2_TEXT)
_NOSE = 0.08
# Of outlines; half of it is hidden by the shape.
_OUTLINE = 2.4


def tone(k: int) -> str:
    """The colour of a target."""
    return TONES[k % len(TONES)]


def target(k: int) -> tuple[str, str, str]:
    """The colours of a target."""
    return tone(k), style.BETWEEN, _EDGES[k] if k < len(_EDGES) else style.INK


def own(family: Family, k: int, tones: tuple[str, str, str]) -> tuple[Color, str, str]:
    """The same colours, with a fill of its own where the file of the rest, 0, or of target k has such."""
    painted = family.painted[k] if family.painted else None
    return tones[0] if painted is None else painted, tones[1], tones[2]


def mixed(weights: Array, count: int) -> Color:
    """The colour of a mixture, at each of some vertices: of the targets', and as they lack, the rest's.

    Weights below 0 have no colour.
    """
    shares = np.clip(np.append(weights, 1.0 - weights.sum()), 0.0, None)
    tones = (*(tone(k) for k in range(len(weights))), style.BEFORE)
    return mesh_look.mixed(tones, np.tile(shares, (count, 1)))


def creature(
    family: Family,
    X: Array,
    camera: Camera,
    fill: Color,
    stripes: str,
    edge: str,
) -> list[Record]:
    """A shape of a family: its surface, outline and shadow, and the face of an animal."""
    F, U = family.faces, family.upright(X)
    N = solids.normals(U, F)
    ground = min(family.floor, float(U[:, 2].min()))
    records = list(mesh_look.shadow(U, F, ground)) if family.ground else []
    if family.cut is None:
        records += mesh_look.surface(U, F, fill, normals=N if family.solid else None)
    else:
        Y, M = family.cut.carry(U), mesh_lines.unit(family.cut.carry(N))
        records += mesh_look.surface(Y, family.cut.below, fill, normals=M)
        records += mesh_look.surface(Y, family.cut.above, stripes, normals=M)
    records += mesh_look.outline(U, F, camera, edge, _OUTLINE)
    return records + (_face(family.solid, U, N) if family.solid and family.solid.eye else [])


def _face(solid: solids.Solid, X: Array, N: Array) -> list[Record]:
    nose = X[solid.marks["nose"]]
    front = nose - X[solid.of("head")].mean(axis=0)
    places = [place for name, place in solid.marks.items() if name.startswith("eye")]
    ball, faces, normals = balls.sphere(_NOSE, nose, 16)
    eyes = mesh_look.eyes(X, N, places, solid.eye, front)
    return [*eyes, Surface(ball, faces, style.PUPIL, normals)]


def hatched(family: Family, X: Array, lacking: Array, camera: Camera, box: Box) -> list[Record]:
    """Lines over the faces for which a way has no parameters."""
    return mesh_look.hatched(family.upright(X), family.faces[lacking], camera, box)


def corners(count: int, rest: bool) -> Array:
    """Where shapes stand in the plane of weights: a polygon; a segment or a point of too few."""
    k = count + rest
    if k >= 3:
        return controller.regular(k)
    return np.array([[-1.0, 0.0], [1.0, 0.0]])[:k] if k == 2 else np.zeros((1, 2))


def glyph(
    weights: Sequence[Array],
    middle: tuple[float, float],
    radius: float,
    rest: bool,
    dot: float = 8.0,
) -> list[Record]:
    """A small polygon whose corners are the shapes, with a dot where weights are."""
    count = len(weights[0])
    at = np.asarray(middle) + radius * corners(count, rest)
    order = np.roll(np.arange(count + rest), rest)
    tones = [style.BEFORE_EDGE if rest and k == 0 else tone(order[k]) for k in range(count + rest)]
    shares = [np.append(1.0 - w.sum(), w) if rest else w for w in weights]
    rim = np.concatenate([at, at[:1]])
    return [
        Lines(_flat(rim), style.INK, style.THIN),
        *(
            Points(_flat(p[None]), t, max(0.8 * dot, 6.0), style.INK, False)
            for p, t in zip(at, tones, strict=True)
        ),
        Points(_flat(np.stack([share @ at for share in shares])), style.MARK, dot),
    ]


def _flat(p: Array) -> Array:
    return np.pad(p, ((0, 0), (0, 1)))


def line(text: str, x: float, y: float, size: float = style.SMALL_TEXT, color: str = style.INK) -> Label:
    """A line of text in the middle about x, its base line at y."""
    return Label(text, (x, y, 0.0), color, size, anchor="cn")


def number(x: float) -> str:
    """A weight as one writes it: ``0.80``."""
    return f"{0.0 if abs(x) < 5e-3 else x:.2f}"


def numbers(w: Array) -> str:
    """Weights as one writes them: ``0.80, 0.80``."""
    return ",\\, ".join(map(number, w))


def points(family: Family) -> int:
    """How many vertices are drawn."""
    return len(family.rest) + (len(family.cut.share) if family.cut else 0)


def bounds(X: Array) -> Array:
    """The lowest and the highest coordinates; shape (2, 3)."""
    return np.stack([X.min(axis=0), X.max(axis=0)])


def distances(family: Family, X: Array) -> Array:
    """How far a shape's vertices are from each target's, at most, over the size of the rest."""
    far = np.linalg.norm(X - family.targets, axis=-1).max(axis=1) / np.ptp(family.rest, axis=0).max()
    # Where it has arrived, what is left is rounding.
    return np.round(far, 9)
