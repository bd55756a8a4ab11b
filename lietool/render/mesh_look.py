"""How meshes in space look: surfaces, outlines, probes, cages, weights, shadows.

Every picture of a mesh is made of these, so that one thing looks the same wherever it is drawn; `mesh_page`
puts views of meshes side by side.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.render import marks, mesh_lines, polyline, solids, style
from lietool.render.camera import Box, Camera
from lietool.render.mesh_lines import CREASE
from lietool.render.mesh_shading import shading
from lietool.render.mesh_shadow import shadow as shadow
from lietool.render.scene import Arrow, Lines, Points, Record, Surface, Tube
from lietool.render.theme import Color, Mix, light

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Material = Literal["matte", "flat", "soft"]

WEIGHTS = (style.BEFORE, style.SHELL_FILLS[0], style.SHELLS[0], style.ALGEBRA, style.ALGEBRA_TEXT)
"""The stops of the ramp of weights, from 0 to 1."""

_TENTHS = tuple(k / 10.0 for k in range(1, 10))
# A line on a surface, towards the viewer, in heights of the view; an outline nearly in its place.
_LIFT, _NEAR = 0.0025, 0.001
_OUTLINE = 3.0
# The head of a small arrow, in radii of its shaft.
_HEAD = 2.4
# How far the spiral of more than a full turn opens: in all at least, and each turn at least.
_OPENING, _EACH_TURN = 0.25, 0.2
# Of the arc of a turn, in its radius: half the width of its line; the length and half the width of its head.
_ARC, _ARC_HEAD = 0.035, (0.42, 0.15)
# From the arc to the middle of its name, in page units.
_NAME = 24.0


def surface(
    V: ArrayLike,
    F: ArrayLike,
    color: Color,
    *,
    normals: ArrayLike | None = None,
    crease: float = CREASE,
    material: Material = "matte",
    alpha: float = 1.0,
    by_face: bool = False,
) -> list[Record]:
    """Return a mesh as a lit surface, smooth except at creases.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
        Counter-clockwise seen from outside.
    color : str, Mix or ndarray
        One colour, or one for each vertex, or for each face where `by_face`.
    normals : array_like, shape (n, 3), optional
        Unit normals, such as those of the whole mesh where `F` is a part of it; computed unless given.
    crease : float
        Where faces meet at a larger angle, radians, the edge is sharp; pi has none.
    material : {"matte", "soft", "flat"}
    alpha : float
    by_face : bool
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp).reshape(-1, 3)
    if not len(F):
        return []
    if normals is None:
        V, F, N, origin = shading(V, F, crease)
    else:
        N, origin = np.asarray(normals, float), np.arange(len(V))
    if by_face:
        V, N, color = V[F].reshape(-1, 3), N[F].reshape(-1, 3), _rows(color, np.repeat(np.arange(len(F)), 3))
        F = np.arange(len(V)).reshape(-1, 3)
    else:
        color = _rows(color, origin)
    return [Surface(V, F, color, N, material, alpha)]


def vertex_colors(levels: ArrayLike) -> Array:
    """Return the colours (n, 4) in which to draw vertices, opaque: levels 0 to 1 (n, 3 or 4) of a file."""
    linear = light(np.clip(np.asarray(levels, float)[:, :3], 0.0, 1.0))
    return np.column_stack([linear, np.ones(len(linear))])


def outline(
    V: ArrayLike, F: ArrayLike, camera: Camera, color: str = style.INK, width: float = _OUTLINE
) -> list[Record]:
    """Return the contour of a mesh for a camera: where it turns away from the eye, and its boundary.

    Half of the width is hidden by the mesh itself.
    """
    return [Lines(mesh_lines.contour(V, F, camera), color, width, lift=_NEAR)]


def wires(
    V: ArrayLike, F: ArrayLike, color: str = style.INK, alpha: float = 0.35, width: float = 0.6
) -> list[Record]:
    """Return the edges of a mesh as hairlines."""
    return [Lines(mesh_lines.all_edges(V, F), color, width, alpha, lift=_LIFT)]


def hatched(
    V: ArrayLike, F: ArrayLike, camera: Camera, box: Box, color: str = style.MARK, width: float = style.THIN
) -> list[Record]:
    """Return slanted lines over faces: those to which something does not apply."""
    return [Lines(mesh_lines.hatching(V, F, camera, box), color, width, lift=_LIFT)]


def mixed(tones: Sequence[str], weights: ArrayLike) -> Mix:
    """Return colours mixed of tones, a row of weights (n, k) for each; rows are brought to sum 1."""
    weights = np.asarray(weights, float)
    return Mix(tuple(tones), weights / weights.sum(axis=1, keepdims=True), np.ones(len(weights)))


def weight_colors(weights: ArrayLike, high: float = 1.0) -> Mix:
    """Return colours of weights (n,): pale at 0, dark blue at `high` and above, red below 0."""
    w = np.clip(np.asarray(weights, float).ravel() / high, -1.0, 1.0)
    places = np.linspace(0.0, 1.0, len(WEIGHTS))
    at = np.where(w >= 0.0, w, 0.0)
    hats = np.stack([np.interp(at, places, row) for row in np.eye(len(WEIGHTS))], axis=1)
    below = np.where(w < 0.0, -w, 0.0)[:, None]
    return Mix(
        (*WEIGHTS, style.WRONG), np.concatenate([hats * (1.0 - below), below], axis=1), np.ones(len(w))
    )


def weight_levels(
    V: ArrayLike, F: ArrayLike, weights: ArrayLike, levels: ArrayLike = _TENTHS
) -> list[Record]:
    """Return the lines on a mesh along which a weight is 0.1, 0.2, ..., 0.9."""
    lines = mesh_lines.level_lines(V, F, weights, levels)
    return [Lines(lines, style.INK, style.HAIR, 0.45, lift=_LIFT)]


def eyes(
    V: ArrayLike, N: ArrayLike, places: Sequence[int], radius: float, look: ArrayLike | None = None
) -> list[Record]:
    """Return eyeballs on a creature.

    Parameters
    ----------
    V, N : array_like, shape (n, 3)
        Vertices and unit normals.
    places : sequence of int
        Vertices where the eyes are.
    radius : float
    look : array_like, shape (3,), optional
        Where they look beside straight out.
    """
    V, N = np.asarray(V, float), np.asarray(N, float)
    records: list[Record] = []
    for k in places:
        center = V[k] - 0.3 * radius * N[k]
        toward = mesh_lines.unit(N[k] + (0.0 if look is None else 0.8 * mesh_lines.unit(look)))
        for part, shift, color in ((1.0, 0.0, style.EYE_WHITE), (0.62, 0.47, style.PUPIL)):
            ball, faces, normals = solids.sphere(part * radius, center + shift * radius * toward, 20)
            records.append(Surface(ball, faces, color, normals))
    return records


def probe(frame: ArrayLike, size: float, *, moved: bool = False, alpha: float = 1.0) -> list[Record]:
    """Return a probe: a ball with its three axes, pale at rest and strong where it has moved.

    Parameters
    ----------
    frame : array_like, shape (4, 4)
        Its axes, as long as its columns say, and its centre.
    size : float
        Length of an axis of length 1.
    moved : bool
    alpha : float
    """
    frame = np.asarray(frame, float)
    center, radius = frame[:3, 3], 0.046 * size
    colors = style.AXES if moved else (style.BEFORE_EDGE,) * 3
    records: list[Record] = [
        Arrow(center, center + size * axis, color, radius, _HEAD, alpha)
        for axis, color in zip(frame[:3, :3].T, colors, strict=True)
        if np.linalg.norm(axis) > 1e-9
    ]
    ball, faces, normals = solids.sphere(2.9 * radius, center, 16)
    color = style.INK if moved else style.BEFORE
    return [*records, Surface(ball, faces, color, normals, alpha=alpha)]


def turn(
    center: ArrayLike,
    x: ArrayLike,
    radius: float,
    camera: Camera,
    *,
    color: str = style.MARK,
    text: str | None = None,
    room: float = 60.0,
    start: float = 0.0,
) -> list[Record]:
    """Return the arc of a turn with its head and its angle; more than a full turn is a spiral.

    The spiral opens by a quarter on its way, so that its end is beside its beginning and not on it.

    Parameters
    ----------
    center : array_like, shape (3,)
    x : array_like, shape (3,)
        Rotation vector, radians; any length.
    radius : float
        Of the arc, or of the beginning of the spiral.
    camera : Camera
        The arc begins where it is seen best from there, and ends at its name.
    color : str
    text : str, optional
        The angle in degrees unless given; "" for none.
    room : float
        How far the name may move.
    start : float
        Where the arc begins, radians onwards from where it is seen best.
    """
    center, x = np.asarray(center, float), np.asarray(x, float)
    angle = float(np.linalg.norm(x))
    if angle < 1e-9:
        return []
    u = x / angle
    across = np.cross(camera.axes[2], u)
    v = mesh_lines.unit(across) if np.linalg.norm(across) > 1e-6 else solids.frame_along(u)[:, 0]
    along = np.linspace(0.0, angle, max(round(angle / 0.05), 2) + 1)
    ring = np.cos(start + along)[:, None] * v + np.sin(start + along)[:, None] * np.cross(u, v)
    turns = angle / (2.0 * np.pi)
    grown = max(_OPENING, _EACH_TURN * turns) if turns > 1.0 + 1e-9 else 0.0
    opening = radius * (1.0 + grown * along / angle)
    records = _bent_arrow(center + opening[:, None] * ring, color, radius)
    name = rf"${np.degrees(angle):.0f}^{{\circ}}$" if text is None else text
    if name:
        out = ring[-1] if angle > np.pi else ring[len(ring) // 2]
        at = center + opening[-1] * out
        records.append(marks.beyond(name, at, out, camera, color=color, gap=_NAME, room=room))
    return records


def _bent_arrow(points: Array, color: str, radius: float) -> list[Record]:
    """An arrow along the arc of a turn: its head is larger than that of `marks.curved_arrow`."""
    long, wide = _ARC_HEAD[0] * radius, _ARC_HEAD[1] * radius
    if polyline.remaining(points)[0] <= 1.5 * long:
        return marks.curved_arrow(points, color, _ARC * radius, 3.2)
    base, tip = polyline.shortened(points, long)[-1], points[-1]
    shaft = polyline.shortened(points, 0.9 * long)
    cone, faces, normals = solids.revolve([(0.0, 0.0), (wide, 0.0), (0.0, float(np.linalg.norm(tip - base)))])
    axes = solids.frame_along(tip - base)
    return [Tube(shaft, color, _ARC * radius), Surface(cone @ axes.T + base, faces, color, normals @ axes.T)]


def cage(
    V: ArrayLike,
    F: ArrayLike,
    *,
    picked: Sequence[int] = (),
    color: str = style.GLASS_EDGE,
    flat: float = np.radians(0.5),
) -> list[Record]:
    """Return a cage: thin edges, corners as dots, faint panes of glass.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    picked : sequence of int
        Faces that are shown stronger.
    color : str
    flat : float
        Edges between faces that meet at less, radians, are only there because faces are triangles.
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp).reshape(-1, 3)
    chosen = np.isin(np.arange(len(F)), list(picked))
    panes: list[Record] = [Surface(V, F[~chosen], style.GLASS, material="flat", alpha=0.10)]
    if chosen.any():
        panes.append(Surface(V, F[chosen], style.ARC, material="flat", alpha=0.24))
    corners = V[np.unique(F)]
    return [
        *panes,
        Lines(mesh_lines.creases(V, F, flat), color, style.EDGE, lift=_LIFT),
        Points(corners, color, 4.5, shaded=False),
    ]


def cloud(P: ArrayLike, color: Color, radius: float = 4.0) -> list[Record]:
    """Return a cloud of points as small balls, `radius` in page units."""
    return [Points(np.asarray(P, float), color, radius)]


def inside(records: Sequence[Record], alpha: float = 0.4) -> list[Record]:
    """Return records fainter, for a second view over a mesh that hides them: such as probes inside of it."""
    return [replace(r, alpha=alpha * r.alpha) if hasattr(r, "alpha") else r for r in records]  # type: ignore[call-arg]


def _rows(color: Color, rows: Index) -> Color:
    return color if isinstance(color, str) else color[rows]
