"""Figure 4.2 of the book and the paths of section 4.6."""

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import quaternion
from lietool.render import scene, solids, style
from lietool.render.camera import Camera
from lietool.render.globe import joined, jumps
from lietool.render.theme import Color

from . import _exp_paths, _heads

FULL = 2.0 * np.pi
Exp = Callable[[np.ndarray], np.ndarray]
# Just inside the rim of the half sphere, where a rotation has one place.
_INSIDE = np.pi * (1.0 - 1e-12)


@figure(
    plates={
        "B4.2": Plate(
            title="The exponential map of SO(3) in four stages",
            equations=("4.27", "4.28", "4.29", "4.30"),
            caption=(
                "One dimension lower than life: slices of R^3 and S^3. (a) Rotation vectors x, cut into "
                "shells by the spheres |x| = 2n pi. (b) Each of those spheres collapses to a point, 1 or -1, "
                "and every shell becomes a sphere of unit quaternions q. (c) The spheres are laid onto one, "
                "S^3; its near half is cut away, and where the way runs on that it is a thin line. (d) "
                "Opposite points are the same rotation R. The marked x moves outwards; follow it through "
                "the stages. The heads on its way in (d) count how often each half has been gone."
            ),
        ),
        "B4.2b": Plate(
            title="A path through the identity whose logarithm, begun at 0, must jump; and one beside it",
            equations=("4.25", "4.27", "4.30"),
            caption=(
                "Left: a full turn about the first axis, then a turn about the second. At 360 degrees the "
                "path passes I and turns off, and no logarithm of it that begins at 0 is continuous. Right: "
                "the same path moved aside by a small rotation avoids I, and its logarithm runs round inside "
                "the sphere |x| = 2 pi (below it its shadow on the plane of the first two axes). Below: the "
                "smallest singular value of d exp, zero at every |x| = 2n pi; the dots are where the "
                "logarithms are now."
            ),
            params={"view": "paths", "turn": 450.0},
        ),
    },
    time=Time("turn", 0.0, 720.0),
)
def exp_singularity(
    view: Annotated[Literal["stages", "paths"], Param("the four stages, or the two paths")] = "stages",
    turn: Annotated[
        float, Param("how far the marked rotation has turned; the paths end at 720", "deg", 0.0, 1080.0)
    ] = 500.0,
    azimuth: Annotated[
        float,
        Param(
            "direction of the marked rotation vector in its plane",
            "deg",
            -360.0,
            360.0,
            only=("view", "stages"),
        ),
    ] = -50.0,
    shells: Annotated[
        int, Param("number of shells; a longer turn brings more", low=1, high=3, only=("view", "stages"))
    ] = 3,
    aside: Annotated[
        float,
        Param("rotation about z that moves the second path off I", "deg", 1.0, 60.0, only=("view", "paths")),
    ] = 20.0,
    *,
    exp: Library = Library("lietool.lie.so3.exp"),
    log: Library = Library("lietool.lie.so3.log"),
) -> Drawing:
    """The exponential map of SO(3) folds space: at |x| = 2n pi a whole sphere goes to the identity.

    What to look for: in (a) the bold circles stand for spheres of rotation
    vectors of full turns; in (b) each has shrunk to a point, alternately 1 and -1.
    The shells have the same colours throughout. With --view paths the sphere
    |x| = 2 pi is drawn in space: the path that passes through I has to jump
    from it to the origin, the path beside I never does.
    """
    if view == "paths":
        if turn > 720.0:
            raise ValueError(f"the paths end at a turn of 720 degrees; got {turn:g}. Turn less")
        return _exp_paths.drawing(np.deg2rad(turn), np.deg2rad(aside), log)
    # As many shells as the turn needs: a marked point outside of them all would have nowhere to go.
    shells = max(shells, int(np.ceil(turn / 360.0)))
    return _stages(_polar(np.deg2rad(turn), np.deg2rad(azimuth)), shells, exp)


# In grey the pale orange and the pale green are one; on a disc they lie side by side.
_FILLS = (*style.SHELL_FILLS[:2], style.ramp([0.45], (style.SHELL_FILLS[2], style.SHELLS[2])))

# Rotation vectors lie in the plane z = 0; the real part of a quaternion is drawn along x, 1 at the left.


def _drawn(q: np.ndarray) -> np.ndarray:
    """Unit quaternions without a part along k as points of the unit sphere."""
    return np.stack([-q[..., 0], q[..., 2], q[..., 1]], axis=-1)


def _to_sphere(x: np.ndarray) -> np.ndarray:
    """q = exp(x / 2), where |x| / 2 is the angle of (2.31)."""
    return _drawn(quaternion.exp(x / 2.0))


def _to_chain(x: np.ndarray, shell: np.ndarray | int) -> np.ndarray:
    """The same sphere for every shell, side by side, every second one turned round so that they meet."""
    shell = np.broadcast_to(shell, x.shape[:-1])
    along = np.stack([2.0 * shell, 0.0 * shell, 0.0 * shell], axis=-1)
    return np.where(shell % 2 == 1, -1.0, 1.0)[..., None] * _to_sphere(x) + along


def _to_rotations(x: np.ndarray, exp: Exp) -> np.ndarray:
    """R = exp(hat x), drawn where its quaternion with non-negative real part lies.

    Of a wrong exponential, what is larger or smaller than a rotation lies off the sphere by so much.
    """
    R = exp(x)
    q = quaternion.from_matrix(R, check=False)
    size = np.linalg.norm(R, axis=(-2, -1)) / np.sqrt(3.0)
    return size[..., None] * _drawn(np.where(q[..., :1] < 0.0, -q, q))


def _shell(x: np.ndarray, shells: int) -> np.ndarray:
    """Which shell a rotation vector lies in, counted from 0; full turns belong to the inner one."""
    turns = np.linalg.norm(x, axis=-1) / FULL
    return np.clip(np.ceil(turns - 1e-12) - 1, 0, shells - 1).astype(int)


def _polar(r: ArrayLike, phi: ArrayLike) -> np.ndarray:
    """Rotation vectors from length and azimuth."""
    r, phi = np.broadcast_arrays(r, phi)
    return np.stack([r * np.cos(phi), r * np.sin(phi), 0.0 * r], axis=-1)


def _grid(n: int, azimuths: tuple[float, float] = (0.0, FULL)) -> np.ndarray:
    """Rotation vectors of the n-th shell (from 0), shape (rings, spokes, 3)."""
    return _polar(np.linspace(FULL * n, FULL * (n + 1), 33)[:, None], np.linspace(*azimuths, 97)[None, :])


def _graticule(n: int) -> list[np.ndarray]:
    """Circles and spokes of the n-th shell, to be carried by the maps."""
    around, along = np.linspace(0.0, FULL, 97), np.linspace(FULL * n, FULL * (n + 1), 33)
    circles = [_polar(FULL * (n + k / 6.0), around) for k in range(1, 6)]
    return circles + [_polar(along, k * np.pi / 6.0) for k in range(12)]


def _surface(
    points: np.ndarray, color: Color, material: Literal["matte", "glass"] = "matte"
) -> scene.Surface:
    vertices, faces, normals = solids.grid(points)
    return scene.Surface(vertices, faces, color, normals, material)


def _marked(trail: np.ndarray, name: str, offset: tuple[float, float], radius: float) -> list[scene.Record]:
    """The way of the marked point, broken where it jumps, and the point itself."""
    return [
        *(scene.Tube(piece, style.MARK, radius) for piece in np.split(trail, jumps(trail))),
        scene.Points(trail[-1:], style.MARK, 10.0, rim=style.PAPER),
        scene.Label(name, trail[-1], style.MARK, style.TEXT, offset, room=40.0),
    ]


def _stages(x: np.ndarray, shells: int, exp: Exp) -> Drawing:
    trail = np.linspace(0.0, 1.0, 301)[:, None] * x
    direction = (0.16, -1.0, 0.45)
    plane = Camera((0.0, -1.0, 0.95), (0.0, -0.04, 0.0), 1.78)
    chain = Camera((0.0, -1.0, 0.45), (shells - 1.0, 0.0, 0.0), max(1.72 * shells, 3.8))
    sphere = Camera(direction, (0.0, 0.0, 0.0), 2.95)
    half = Camera((0.62, -1.0, 0.45), (-0.36, 0.0, 0.0), 2.6)
    panels = (
        ((0.0, 455.0, 600.0, 385.0), plane, _disc(trail, shells)),
        ((600.0, 475.0, 600.0, 385.0), chain, _beads(trail, shells, chain)),
        ((600.0, 5.0, 600.0, 385.0), sphere, _layers(trail, shells, sphere)),
        ((0.0, 5.0, 600.0, 385.0), half, _half(trail, float(np.arctan2(x[1], x[0])), half, exp)),
    )
    views = [scene.View(tuple(records), camera, box) for box, camera, records in panels]
    numbers = {
        "x": x,
        "shell": int(_shell(x, shells)) + 1,
        "quaternion": quaternion.exp(x / 2.0),
        "rotation": exp(x),
        "collapsed_to": quaternion.exp(_polar(FULL * np.arange(1, shells + 1), 0.0) / 2.0),
    }
    return Drawing(scene.Picture((*views, scene.View(tuple(_captions())))), numbers)


def _disc(trail: np.ndarray, shells: int) -> list[scene.Record]:
    around = np.linspace(0.0, FULL, 181)
    records: list[scene.Record] = []
    for n in range(shells):
        records.append(_surface(_grid(n) / (FULL * shells), _FILLS[n]))
        lines = joined(g / (FULL * shells) for g in _graticule(n))
        records.append(scene.Lines(lines, style.INK, style.HAIR, 0.3))
        rim = _polar(FULL * (n + 1.0), around)
        records.append(scene.Lines(rim / (FULL * shells), style.INK, style.CURVE, lift=0.02))
        at = _polar(FULL * (n + 1.0), np.deg2rad(75.0)) / (FULL * shells)
        records.append(scene.Label(rf"${2 * (n + 1)}\pi$", at, style.INK, style.SMALL_TEXT, (8.0, 20.0)))
    records.append(scene.Points([(0.0, 0.0, 0.0)], style.INK, 6.0))
    return records + _marked(trail / (FULL * shells), r"$\mathbf{x}$", (24.0, 0.0), 0.010)


def _beads(trail: np.ndarray, shells: int, camera: Camera) -> list[scene.Record]:
    records: list[scene.Record] = []
    for n in range(shells):
        center = np.array([2.0 * n, 0.0, 0.0])
        records.append(_surface(_to_chain(_grid(n), n), style.SHELLS[n], "glass"))
        lines = joined(_to_chain(g, n) for g in _graticule(n))
        records.append(scene.Lines(lines, style.INK, style.HAIR, 0.3))
        records.append(scene.Lines(camera.sphere_outline(center, 1.0), style.SHELLS_TEXT[n], style.EDGE))
        below = center - 1.12 * camera.axes[1]
        records.append(
            scene.Label(f"$n = {n + 1}$", below, style.SHELLS_TEXT[n], style.SMALL_TEXT, anchor="ct")
        )
    poles = np.array([(2.0 * n - 1.0, 0.0, 0.0) for n in range(shells + 1)])
    records.append(scene.Points(poles, style.INK, 7.0))
    for n, pole in enumerate(poles):
        name = "$1$" if n % 2 == 0 else "$-1$"
        offset = (-24.0, 0.0) if n == 0 else (30.0, 0.0) if n == shells else (0.0, 66.0)
        records.append(scene.Label(name, pole, style.INK, style.SMALL_TEXT, offset))
    carried = _to_chain(trail, _shell(trail, shells))
    return records + _marked(carried, "$q$", (0.0, -30.0), 0.03)


def _layers(trail: np.ndarray, shells: int, camera: Camera) -> list[scene.Record]:
    """All copies laid on one sphere, cut open: the far half as a bowl, each copy a layer of its wall."""
    far = (np.deg2rad(30.0), np.deg2rad(210.0))
    bowl = _to_sphere(_grid(0, far))
    rim = np.concatenate([bowl[:, 0], bowl[::-1, -1]])
    layer = 0.075
    outer = 1.0 + layer * shells
    records: list[scene.Record] = [
        _surface(bowl, style.SHELL_FILLS[0]),
        _surface(outer * bowl, style.SHELL_FILLS[shells - 1]),
    ]
    lines = joined(_to_sphere(g) for g in _graticule(0))
    behind = np.where((lines @ camera.axes[2] < 0.1)[:, None], 0.999 * lines, np.nan)
    records.append(scene.Lines(behind, style.INK, style.HAIR, 0.3))
    for n in range(shells):
        wall = np.stack([(1.0 + layer * n) * rim, (1.0 + layer * (n + 1)) * rim])
        records.append(_surface(wall, style.SHELLS[n]))
        records.append(scene.Lines(wall[1], style.SHELLS_TEXT[n], style.THIN))
    records.append(scene.Lines(rim, style.SHELLS_TEXT[0], style.THIN))
    for side, name in ((-1.0, "$1$"), (1.0, "$-1$")):
        pole = np.array([side, 0.0, 0.0])
        records.append(scene.Points([pole], style.INK, 7.0))
        records.append(scene.Label(name, outer * pole, style.INK, style.SMALL_TEXT, (26.0 * side, 0.0)))
    # On the near half, which is cut away, the way of the marked point hangs in the air.
    way = _to_sphere(trail)
    near = np.where((way @ camera.axes[2] > 0.0)[:, None], way, np.nan)
    records.append(scene.Lines(near, style.MARK, style.THIN))
    far = way[way @ camera.axes[2] <= 0.0]
    records += [scene.Tube(piece, style.MARK, 0.016) for piece in np.split(far, jumps(far)) if len(piece)]
    return records + _marked(way[-1:], "$q$", _aside(way[-1], camera), 0.016)


def _half(trail: np.ndarray, azimuth: float, camera: Camera, exp: Exp) -> list[scene.Record]:
    grid = _grid(0)[:17]
    around = np.linspace(0.0, FULL, 181)
    rim = _to_sphere(_polar(np.pi, around))
    flat = _graticule(0)[:2]
    flat += [_polar(np.linspace(0.0, _INSIDE, 17), k * np.pi / 6.0) for k in range(12)]
    curves = np.split(_to_rotations(np.concatenate(flat), exp), np.cumsum([len(g) for g in flat])[:-1])
    lines = [piece for curve in curves for piece in np.split(curve, jumps(curve))]
    records: list[scene.Record] = [
        _surface(_to_sphere(grid), style.GLASS, "glass"),
        scene.Lines(joined(lines), style.GLASS_EDGE, style.HAIR, 0.6),
        scene.Lines(rim, style.INK, style.CURVE),
        scene.Points([(-1.0, 0.0, 0.0)], style.INK, 7.0),
        scene.Label("$I$", (-1.0, 0.0, 0.0), style.INK, style.TEXT, (-46.0, -4.0)),
    ]
    # Opposite points of the rim are one half turn; the pair in the mark's colour is where R goes on.
    for aside, color in ((0.0, style.MARK), (np.pi / 3.0, style.GREYS[1]), (-np.pi / 3.0, style.GREYS[1])):
        pair = _to_sphere(_polar([np.pi, -np.pi], azimuth + aside))
        records.append(scene.Lines(pair, color, style.THIN))
        records.append(scene.Points(pair, color, 8.0))
    way = _to_rotations(trail, exp)
    records += _passes(way, np.linalg.norm(trail, axis=-1))
    return records + _marked(way, "$R$", _aside(way[-1], camera), 0.016)


def _passes(way: np.ndarray, turned: np.ndarray) -> list[scene.Record]:
    """A head for each half turn that is gone; on one and the same leg one behind the other."""
    records: list[scene.Record] = []
    for half in range(int(turned[-1] / np.pi + 1.0)):
        # Every second half turn goes along the same leg again.
        wanted = np.pi * (half + 0.4 + 0.16 * (half // 2))
        at = int(np.searchsorted(turned, wanted))
        if at < len(way) - 1:
            records += _heads.head(way, at, style.MARK, 0.016)
    return records


def _aside(point: np.ndarray, camera: Camera) -> tuple[float, float]:
    """Where the name of a point of the sphere goes: above it, but below it near the top, under a caption."""
    return (0.0, -30.0) if camera.axes[1] @ point > 0.6 else (0.0, 30.0)


def _captions() -> list[scene.Record]:
    titles = (
        (300.0, 846.0, r"(a)  $\mathbf{x} \in \mathrm{\mathbb{R}}^3$, a slice"),
        (900.0, 846.0, r"(b)  $|\mathbf{x}| = 2n\pi$ becomes a point"),
        (900.0, 376.0, r"(c)  $q = \exp(\mathbf{x}/2) \in S^3$, a slice"),
        (300.0, 376.0, r"(d)  $q$ and $-q$ are one $R \in \mathrm{SO}(3)$"),
    )
    maps = (
        ((534, 658), (622, 658), "(4.30)", (0.0, 28.0), "cc"),
        ((900, 514), (900, 426), "(4.29)", (22.0, 0.0), "lc"),
        ((634, 190), (546, 190), r"$2 : 1$", (0.0, 28.0), "cc"),
    )
    records: list[scene.Record] = [
        scene.Label(text, (x, y, 0.0), style.INK, style.TITLE_TEXT, anchor="cn") for x, y, text in titles
    ]
    for start, end, text, offset, anchor in maps:
        middle = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]), 0.0)
        records.append(scene.Arrow((*start, 0.0), (*end, 0.0), style.INK, 2.0, 4.0))
        records.append(scene.Label(text, middle, style.INK, style.SMALL_TEXT, offset, anchor))
    return records
