"""Figure 4 of Kaji and Ochiai: pose interpolation."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.deform import pose as deform_pose
from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.mesh import solids, surface_io
from lietool.mesh.surface import Mesh
from lietool.render import mesh_look
from lietool.render.camera import STAND

from . import _pose_keys as keys_of
from . import _pose_page as page

_SOLIDS = {"duck": solids.duck, "animal": solids.animals, "cactus": solids.cactus, "octopus": solids.octopus}
# Moments at which determinants are measured, and to how many digits what splines make of rounding is kept.
_MOMENTS, _DIGITS = 601, 10
# Curves that pass keys by: they need not turn as far.
_NEAR = ("b_spline_near", "bezier")


@figure(
    plates={
        "K4": Plate(
            title="Pose interpolation",
            equations=("K 1", "K 9"),
            caption=(
                "Four key poses (orange), turned far and sheared, joined by the B-spline through their "
                "parameters; each pose stands at its time, and where the centre goes is drawn below at the "
                "left. By phi_so the duck turns about as far as it must and stays a duck. The principal "
                "matrix logarithm takes a long way round, drawn out as no key is; its determinants are "
                "those of phi_so, and say nothing of that. The spline through the matrices flattens the "
                "duck and has it inside out (red) where det A falls below 0. Blue, or red: the moment of "
                "the dashed line."
            ),
        ),
        "K4b": Plate(
            title="Pose interpolation with control points",
            equations=("K 1", "K 9"),
            caption=(
                "The same four keys as control points of a B-spline: it meets the first and the last, and "
                "passes near the others, shown all the same (orange). The parameters make up a linear "
                "space, so that any curve in them will do; the matrix logarithm draws the duck out, and "
                "among the matrices it is thin most of the way, and twice inside out (red)."
            ),
            params={"curve": "b_spline_near", "t": 0.78},
        ),
    },
    time=Time("t", 0.0, 1.0, frames=72, seconds=6.0),
    mesh=True,
)
def pose(
    mesh: Annotated[Path | None, Param("a mesh of yours, .obj .ply .off .stl .glb", positional=1)] = None,
    keys: Annotated[Path | None, Param("a file of key poses, .toml or .json")] = None,
    shape: Annotated[
        Literal["duck", "animal", "cactus", "octopus"],
        Param("what is moved where no mesh is given", unless=("mesh",)),
    ] = "duck",
    curve: Annotated[
        Literal["b_spline", "b_spline_near", "bezier", "catmull_rom", "straight"],
        Param("through the keys, or near them"),
    ] = "b_spline",
    parametrisation: Annotated[Literal["phi_so", "phi_se"], Param("of the upper row")] = "phi_so",
    frames: Annotated[int, Param("poses shown between two keys", low=0, high=8)] = 2,
    t: Annotated[float, Param("a moment, 0 the first key and 1 the last", low=0.0, high=1.0)] = 0.9,
    up: Annotated[Literal["z", "y"], Param("which axis of your mesh is drawn upwards", needs="mesh")] = "z",
) -> Drawing:
    """Pose: key transformations joined by a spline in a space of parameters.

    What to look for: the same keys (orange) three times, each pose at its time.
    In the upper row the pale poses between them are as large as they should be.
    In the middle the matrix logarithm, each key's principal one, turns the long
    way round and draws the shape out. Below, matrices are added up: the shape is
    flattened, and red where it is inside out. The plot says so in numbers: det A
    is the volume, in that at rest.

    The mesh that is written is that of the upper row at the moment t.

    A file for --keys, in the units of the mesh and in degrees::

        centre = [0, 0, 1]          # turned about; the middle unless given

        [[key]]
        translation = [-2, 0, 0]

        [[key]]
        axis = [0, 0, 1]
        degrees = 150

        [[key]]
        time = 3                    # 0, 1, 2, ... unless given
        axis = [0, 0, 1]
        degrees = 300
        scale = 0.8
        translation = [2, 0, 0]

    A key is where the mesh goes from where it lies in its own file. It may say axis
    and degrees; turns, whole ones on top of these; scale, a number or three along
    x, y and z; or stretch, a symmetric matrix; translation; or matrix, 4 rows of
    4, which moves space. As .json: {"key": [{"translation": [-2, 0, 0]}, ...]}.
    """
    body, normals = _body(mesh, shape)
    V = body.vertices
    low, high = V.min(axis=0), V.max(axis=0)
    size = float((high - low).max())
    given = (
        keys_of.example((low + high) / 2.0, size)
        if keys is None
        else keys_of.read(keys, (low + high) / 2.0, size)
    )
    rows = [_row(given, name, curve) for name in (parametrisation, "alexa", "linear")]
    if rows[0].path is None:
        raise ValueError(rows[0].why)
    span = given.times[[0, -1]]
    now = float(span[0] + t * (span[1] - span[0]))
    asked, meets = _ratio(given.A[:, :3, :3]), curve not in _NEAR
    stand = STAND if up == "y" else np.eye(3)
    painted = None if body.colours is None else mesh_look.vertex_colors(body.colours)
    shown = page.Shown(V, body.faces, normals, given, tuple(rows), frames, now, asked, meets, stand, painted)
    A = deform_pose.evaluate(rows[0].path, min(max(now, span[0]), span[1]))
    moved = body.moved(V @ A[:3, :3].T + A[:3, 3])
    return Drawing(page.picture(shown), _numbers(given, rows, A), moved)


def _body(mesh: Path | None, shape: str) -> tuple[Mesh, np.ndarray]:
    """The mesh, and the normals of its vertices."""
    if mesh is None:
        solid = _SOLIDS[shape](solids.DRAFT)
        return Mesh(solid.vertices, solid.faces), solid.normals
    body = surface_io.read(mesh)
    if not float(np.ptp(body.vertices, axis=0).max()) > 0.0:
        raise ValueError(f"pose: {mesh} must have an extent; got all vertices at one place. Give a shape")
    return body, solids.normals(body.vertices, body.faces)


def _row(given: keys_of.Given, name: str, curve: str) -> page.Row:
    """One way of joining the keys, and what is measured of it; without a path where it has none."""
    try:
        path = given.path(name, curve)
        t = np.linspace(*path.ends, _MOMENTS)
        L = deform_pose.evaluate(path, t)[:, :3, :3]
        det = np.linalg.det(L)
        return page.Row(name, path, deform_pose.measure(path), t, det, _ratio(L), "")
    except ValueError as error:
        return page.Row(name, None, None, np.zeros(0), np.zeros(0), np.nan, str(error))


def _ratio(L: np.ndarray) -> float:
    """The largest ratio of stretches of matrices (n, 3, 3) on a path; infinite where it flattens."""
    if not (np.linalg.det(L) > 0.0).all():
        return float("inf")
    stretches = np.linalg.svd(L, compute_uv=False)
    return float((stretches[:, 0] / stretches[:, 2]).max())


def _numbers(given: keys_of.Given, rows: list[page.Row], A: np.ndarray) -> dict[str, object]:
    numbers: dict[str, object] = {"keys": given.A, "times": given.times, "A": np.round(A, _DIGITS)}
    numbers["keys ratio"] = round(_ratio(given.A[:, :3, :3]), 4)
    for row in rows:
        numbers[f"{row.name} found"] = row.path is not None
        if row.measure is not None:
            numbers[f"{row.name} turned"] = round(float(np.degrees(row.measure.turned)), 6)
            numbers[f"{row.name} needed"] = round(float(np.degrees(row.measure.geodesic)), 6)
            numbers[f"{row.name} least det"] = round(row.measure.least_det, 6)
            numbers[f"{row.name} inside out"] = row.inside_out
            if np.isfinite(row.ratio):
                numbers[f"{row.name} ratio"] = round(row.ratio, 4)
    return numbers
