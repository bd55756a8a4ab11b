"""Ways of blending side by side: rest and targets above, the same weights by three ways below."""

from dataclasses import dataclass

import numpy as np

from lietool.deform import shape_blend
from lietool.figure import Drawing
from lietool.render import mesh_page, style
from lietool.render.camera import Box, Camera, project
from lietool.render.scene import Label, Lines, Picture, Record, View

from . import _blend_look as look
from . import _blend_plan as plan
from ._blend_family import Family

Array = np.ndarray

NAMES = {
    "phi_so": r"$\varphi_{so}$",
    "phi_se": r"$\varphi_{se}$",
    "alexa": "matrix logarithm",
    "polar_quaternion": "quaternions",
    "dual_quaternion": "dual quaternions",
    "linear": "matrices",
}
_BESIDE = ("phi_so", "alexa", "polar_quaternion")
_LEFT, _WIDE = 36.0, 1128.0
_ABOVE, _BELOW, _TALL, _LOW = 494.0, 78.0, 366.0, 330.0
# The lower titles' base line.
_SECOND = 456.0
# So many shapes stand in the upper row at most.
_MOST = 6
# Of the thorn above this height the lean is told; by lines and an arc so long, from its tip.
_UPPER = 2.0
# So far a shape may reach out of its box, page units.
_BEYOND = 12.0
_TOP = 2.6
_PLUMB, _ARC = 0.42, 0.32
# The vertical through a tip that points down is seen above what it hangs from.
_OVER = 1.0


@dataclass(frozen=True, eq=False)
class Shown:
    """What one way makes of the weights; or why it makes nothing."""

    way: str
    prepared: shape_blend.Prepared
    blended: shape_blend.Blended | None
    trouble: str = ""


def drawing(family: Family, way: str, weights: Array) -> Drawing:
    """Return rest and targets, and their blends by a way and by those that it is compared with."""
    shown = [_shown(family, name, weights) for name in _row(way)]
    many = min(len(family) + 1, _MOST)
    # The thorn's boxes are taller: of them only a tip comes near to the titles.
    tall = _TALL if _has_tip(family) else _LOW
    left = _LEFT + (plan.ROOM if _has_plan(family) else 0.0)
    above = mesh_page.grid(1, many, (left, _ABOVE, _WIDE, tall))
    below = mesh_page.grid(1, len(shown), (left, _BELOW, _WIDE, tall))
    shapes = [family.rest, *family.targets[: many - 1]]
    upright = [family.upright(X) for X in shapes]
    if _has_tip(family):
        # Above the highest tip there is room for the vertical of another.
        top = max(_TOP, *(float(X[:, 2].max()) for X in shapes))
        upright.append(family.upright(np.array([[0.0, 0.0, top + _PLUMB]])))
    narrow = min(above[0][2], below[0][2])
    camera = mesh_page.together(upright, family.direction, (0.0, 0.0, narrow, tall), 1.06)
    tones = [look.REST, *map(look.target, range(many - 1))]
    colours = [look.own(family, k, three) for k, three in enumerate(tones)]
    views = [
        View(tuple(look.creature(family, X, camera, *own)), camera, box)
        for X, own, box in zip(shapes, colours, above, strict=True)
    ]
    heads = []
    if _has_plan(family):
        views += _plans(family, camera, list(zip(shapes, above, strict=True)))
    for one, box in zip(shown, below, strict=True):
        own = _camera(family, one, camera, box)
        views += _views(family, one, own, box)
        if _has_plan(family) and one.blended:
            views.append(View(tuple(plan.plan(family, camera, box, one.blended.vertices, style.INK))))
        scale = "" if own is camera else rf" (${camera.height / own.height:.2g} : 1$)"
        heads.append(look.line(NAMES[one.way] + scale, box[0] + box[2] / 2.0, _SECOND, style.TITLE_TEXT))
    names = ["rest", *_named(family, many - 1)]
    titles = [*mesh_page.titles(above, names), *heads, _legend(family, weights, many - 1, shown)]
    mesh = shown[0].blended
    if mesh is None:
        raise ValueError(f"weights must be such that {way} has a blend; got {shown[0].trouble}")
    return Drawing(
        Picture((*views, View(tuple(titles)))),
        numbers(family, shown, weights),
        family.written(mesh.vertices),
        tuple(note for one in shown[:1] for note in notes(family, one.prepared, one.blended)),
    )


def _has_tip(family: Family) -> bool:
    """Whether there is a thorn, whose lean is told."""
    return family.solid is not None and "tip" in family.solid.marks


def _has_plan(family: Family) -> bool:
    """Whether its shapes are seen from above too."""
    return _has_tip(family) and family.up == "z" and family.thorn is not None


def _plans(family: Family, camera: Camera, shapes: list[tuple[Array, Box]]) -> list[View]:
    """Rest and targets from above, with the turns of the targets."""
    views = []
    for k, (X, box) in enumerate(shapes):
        edge = look.target(k - 1)[2] if k else style.MUTED
        records = plan.plan(family, camera, box, X, edge)
        made = plan.turned(family, box, k - 1, family.thorn.angle) if k and family.thorn else plan.named(box)
        views.append(View((*made, *records)))
    return views


def _row(way: str) -> list[str]:
    return [way, *(name for name in _BESIDE if name != way)][:3]


def _shown(family: Family, way: str, weights: Array) -> Shown:
    prepared = family.prepared(way)
    try:
        return Shown(way, prepared, family.blended(way, weights))
    except ValueError as error:
        # What else could be wrong with the weights is asked before.
        if "cancel" not in str(error):
            raise
        return Shown(way, prepared, None, "quaternions that cancel each other")


def _camera(family: Family, one: Shown, camera: Camera, box: Box) -> Camera:
    """The camera of all; for what would reach far out of its box, one of its own."""
    if one.blended is None:
        return camera
    U = family.upright(one.blended.vertices)
    seen = project(camera, box, U)[:, :2]
    low, high = np.array(box[:2]) - _BEYOND, np.array(box[:2]) + np.array(box[2:]) + _BEYOND
    inside = bool(((seen >= low) & (seen <= high)).all())
    return camera if inside else mesh_page.together([U], family.direction, box, 1.04)


def notes(family: Family, prepared: shape_blend.Prepared, blended: shape_blend.Blended | None) -> list[str]:
    """What is not as one would expect, a line each."""
    said = [f"{family.names[k]}: {lift.message}" for k, lift in enumerate(prepared.lifts) if lift.message]
    if blended is not None and (lacking := int(blended.fallback.sum())):
        said.append(
            f"{lacking} of {len(family.faces)} faces have no logarithm; these are blended by polar parts"
        )
    if blended is not None and blended.flips:
        said.append(f"{blended.flips} of {len(family.faces)} faces are turned over")
    return said


def numbers(family: Family, shown: list[Shown], weights: Array) -> dict[str, object]:
    """What the page shows."""
    made = [one for one in shown if one.blended]
    found: dict[str, object] = {
        "ways": [one.way for one in shown],
        "blended": [one.way for one in made],
        "weights": weights,
        "lacking": [int(one.blended.fallback.sum()) for one in made if one.blended],
        "flipped": [one.blended.flips for one in made if one.blended],
        "bounds": np.stack([look.bounds(one.blended.vertices) for one in made if one.blended]),
        "targets": np.stack([look.bounds(X) for X in family.targets]),
    }
    if _has_tip(family):
        found["lean"] = np.array([lean(family, one.blended.vertices) for one in made if one.blended])
        found["lean_of_targets"] = np.array([lean(family, X) for X in family.targets])
    return found


def axis(family: Family, X: Array) -> Array:
    """Whereto the axis of the upper part of the thorn points: as an affine map of that part says."""
    rest = family.rest
    upper = family.solid.of("thorn") & (rest[:, 2] > _UPPER) if family.solid else np.ones(len(rest), bool)
    V, U = rest[upper], X[upper]
    A = np.linalg.lstsq(np.column_stack([V, np.ones(len(V))]), U, rcond=None)[0]
    return A[2] / np.linalg.norm(A[2])


def lean(family: Family, X: Array) -> float:
    """The angle in degrees between the axis of the upper thorn and the vertical."""
    along = axis(family, X)
    return round(float(np.degrees(np.arctan2(np.hypot(*along[:2]), along[2]))), 6)


def _views(family: Family, one: Shown, camera: Camera, box: Box) -> list[View]:
    if one.blended is None:
        middle = (box[0] + box[2] / 2.0, box[1] + box[3] / 2.0)
        lines = ("no blend:", "the quaternions", "cancel each other")
        texts = [look.line(text, middle[0], middle[1] + 40.0 - 40.0 * k) for k, text in enumerate(lines)]
        return [View(tuple(texts))]
    X = one.blended.vertices
    records = look.creature(family, X, camera, *look.own(family, 0, look.RESULT))
    records += look.hatched(family, X, one.blended.fallback, camera, box)
    views = [View(tuple(records), camera, box)]
    if _has_tip(family):
        views.append(View(tuple(_leaning(family, X)), camera, box))
    return views


def _leaning(family: Family, X: Array) -> list[Record]:
    """At the tip of the thorn the vertical, the axis of its upper part, and the angle between them."""
    tip = plan.tip(family, X)
    tip, along, up = family.upright(np.stack([tip, axis(family, X), np.array([0.0, 0.0, 1.0])]))
    angle = np.radians(lean(family, X))
    text = rf"${np.degrees(angle):.0f}^{{\circ}}$"
    long = _PLUMB if along @ up > 0.0 else _OVER
    records: list[Record] = [Lines(np.stack([tip, tip + long * up]), style.INK, style.THIN, dash=(9.0, 6.0))]
    if angle < np.radians(0.5):
        end = tip + _PLUMB * up
        return [*records, Label(text, end, style.MARK, style.TEXT, (16.0, -24.0), "lc", room=45.0)]
    across = (along - (along @ up) * up) / np.linalg.norm(along - (along @ up) * up)
    turn = np.linspace(0.0, angle, 40)[:, None]
    arc = np.cos(turn) * up + np.sin(turn) * across
    half = arc[len(arc) // 2]
    return [
        *records,
        Lines(np.stack([tip, tip + _PLUMB * along]), style.MARK, style.EDGE),
        Lines(tip + _ARC * arc, style.MARK, style.EDGE),
        Label(text, tip + _PLUMB * half, style.MARK, style.TEXT, (20.0, -6.0), "lc", room=45.0),
    ]


def _named(family: Family, count: int) -> list[str]:
    own = family.solid is not None
    return [f"target {k + 1}" if own else _short(name) for k, name in enumerate(family.names[:count])]


def _short(name: str) -> str:
    text = name if len(name) <= 14 else f"{name[:13]}..."
    return text.replace("\\", "/").replace("$", r"\$")


def _legend(family: Family, weights: Array, above: int, shown: list[Shown]) -> Label:
    if len(weights) <= 4:
        names = ", ".join(f"w_{k + 1}" for k in range(len(weights)))
        text = f"below: ${names} = {look.numbers(weights)}$"
        if np.ptp(weights) == 0.0:
            text = f"below: ${names.replace(', ', ' = ')} = {weights[0]:.2g}$"
    else:
        text = f"below: blended with {len(weights)} weights of sum ${weights.sum():.2f}$"
    if above < len(family):
        text += f"; {len(family) - above} more targets are not drawn"
    if lacking := max(int(one.blended.fallback.sum()) for one in shown if one.blended):
        text += f"; hatched: {lacking} faces without a logarithm"
    elif _has_tip(family):
        text += "; maps known" if family.maps is not None else "; maps from faces with normals"
    return mesh_page.legend(text)
