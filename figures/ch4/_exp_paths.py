"""The second plate of `exp_singularity`: two paths of rotations and their logarithms."""

from collections.abc import Callable

import numpy as np

from lietool.figure import Drawing
from lietool.lie import so3
from lietool.render import scene, solids, style
from lietool.render.camera import Camera
from lietool.render.globe import globe, joined, jumps
from lietool.render.marks import coordinate_axes, curved_arrow
from lietool.render.plot import Axes, number

from . import _heads

FULL = 2.0 * np.pi
# A full turn about x and one about y: where the paths end.
LAST = 2.0 * FULL
# Where the second turn begins.
_AT = r"$360^{\circ}$"


def drawing(turn: float, aside: float, log: Callable[[np.ndarray], np.ndarray]) -> Drawing:
    """R_x up to a full turn, then R_y: as it is, and moved aside by a rotation about z."""
    # Closest together at full turns, where the path passes I: beside it the logarithm moves fastest.
    turns, rest = np.divmod(np.linspace(0.0, LAST / FULL, 241), 1.0)
    steps = FULL * (turns + rest**2 * (3.0 - 2.0 * rest))
    through = _motion(steps)
    beside = so3.rotation("z", aside) @ through
    shown = max(int(np.searchsorted(steps, turn + 1e-9)), 1)
    starts = (np.zeros(3), np.array([0.0, 0.0, aside]))
    logs = log(np.stack([through, beside])[:, :shown])
    lifts = [so3.log_along(so3.exp(x), start) for x, start in zip(logs, starts, strict=True)]
    lengths = np.array([np.linalg.norm(lift[-1]) for lift in lifts])
    x = np.linspace(0.0, 3.0 * FULL, 601)
    jacobian = so3.left_jacobian(np.stack([x, 0.0 * x, 0.0 * x], axis=-1))
    smallest = np.linalg.svd(jacobian, compute_uv=False).min(axis=-1)
    camera = Camera((0.68, -0.80, 0.40), (0.0, 0.0, 0.06), 2.9)
    # Where the second turn begins, once it has.
    corner = int(np.searchsorted(steps[:shown], FULL - 1e-9))
    views = [
        scene.View(tuple(_lift_view(lift / FULL, corner, camera)), camera, (600.0 * i, 300.0, 600.0, 530.0))
        for i, lift in enumerate(lifts)
    ]
    titles = ("log of a path through $I$", "log of a path beside $I$")
    page: list[scene.Record] = [
        scene.Label(text, (300.0 + 600.0 * i, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
        for i, text in enumerate(titles)
    ]
    page += _smallest(x, smallest, lengths)
    numbers = {
        "turn": steps[:shown],
        "lift_through": lifts[0],
        "lift_beside": lifts[1],
        "lengths": lengths,
        "largest_step": np.array(
            [np.linalg.norm(np.diff(a, axis=0), axis=-1).max(initial=0.0) for a in lifts]
        ),
        "length": x,
        "smallest_singular_value": smallest,
    }
    return Drawing(scene.Picture((*views, scene.View(tuple(page)))), numbers)


def _motion(turn: np.ndarray) -> np.ndarray:
    first, then = np.minimum(turn, FULL), np.maximum(turn - FULL, 0.0)
    return so3.rotation("y", then) @ so3.rotation("x", first)


def _lift_view(lift: np.ndarray, corner: int, camera: Camera) -> list[scene.Record]:
    breaks = jumps(lift)
    color = style.ALGEBRA
    names = ("$x_1$", "$x_2$", "$x_3$")
    records = [*globe(camera, alpha=0.75), *coordinate_axes(camera, names, 1.3)]
    records.append(
        scene.Lines(joined(-np.stack([0.0 * a, a]) for a in np.eye(3)), style.INK, style.THIN, 0.45)
    )
    side = (camera.axes[0] + camera.axes[1]) / np.sqrt(2.0)
    records.append(
        scene.Label(r"$|\mathbf{x}| = 2\pi$", side, style.GLASS_EDGE, style.SMALL_TEXT, (16.0, 10.0), "lc")
    )
    pieces = np.split(lift, breaks)
    records += [scene.Tube(piece, color, 0.018) for piece in pieces]
    for k in range(2):
        middle = int(0.45 * corner) if k == 0 else (corner + len(lift)) // 2
        if middle > 2 and (k == 0 or corner < len(lift) - 8):
            records += _heads.head(lift, middle, color, 0.018)
    if not len(breaks):
        records += _shadow(lift, corner)
        if corner < len(lift):
            records += _turn(lift[corner])
    for jump in breaks:
        records += _jump(lift[jump - 1], lift[jump], camera)
    records.append(scene.Points(lift[[0]], color, 8.0))
    records.append(scene.Points(lift[[-1]], color, 11.0, rim=style.PAPER))
    return records


def _turn(point: np.ndarray) -> list[scene.Record]:
    """Where the second turn begins."""
    return [
        scene.Points([point], style.ALGEBRA, 7.0),
        scene.Label(_AT, point, style.ALGEBRA_TEXT, style.SMALL_TEXT, (0.0, -26.0), "ct", room=40.0),
    ]


def _shadow(lift: np.ndarray, corner: int) -> list[scene.Record]:
    """The shadow on the plane of the first two axes, and the wall between it and the path."""
    flat = lift * (1.0, 1.0, 0.0)
    ends = [lift[-1]] if corner >= len(lift) else [lift[corner], lift[-1]]
    drops = joined(np.stack([point, point * (1.0, 1.0, 0.0)]) for point in ends)
    records: list[scene.Record] = [
        scene.Lines(flat, style.MUTED, style.EDGE, 0.8),
        scene.Lines(drops, style.MUTED, style.HAIR),
    ]
    if len(lift) > 1:
        vertices, faces, _ = solids.grid(np.stack([lift, flat]))
        records.append(scene.Surface(vertices, faces, style.ALGEBRA, material="flat", alpha=0.13))
    return records


def _jump(start: np.ndarray, end: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The way back that no rotation takes, as a bow: straight, it would lie under the path."""
    s = np.linspace(0.0, 1.0, 41)[:, None]
    down = camera.axes[1]
    bow = (1.0 - s) * start + s * end - 1.5 * s * (1.0 - s) * down
    # Straight below the middle of the bow, where the sphere ends.
    across = float(camera.axes[0] @ bow[20])
    outside = across * camera.axes[0] - np.sqrt(max(1.25 - across**2, 0.5)) * down
    return [
        *curved_arrow(bow, style.WRONG, 0.010, 3.4),
        scene.Lines(np.stack([bow[20], outside]), style.WRONG, style.HAIR, lift=0.5),
        scene.Points([start], style.PAPER, 9.0, rim=style.WRONG),
        scene.Label(_AT, start, style.WRONG, style.SMALL_TEXT, (12.0, 20.0), "lb", room=40.0),
        scene.Label(_jump_name(start, end), outside, style.WRONG, style.SMALL_TEXT, (0.0, -6.0), "ct"),
    ]


def _jump_name(start: np.ndarray, end: np.ndarray) -> str:
    return rf"a jump of ${number(2.0 * np.linalg.norm(end - start))}\pi$"


def _smallest(x: np.ndarray, values: np.ndarray, marked: np.ndarray) -> list[scene.Record]:
    axes = Axes((150.0, 86.0, 900.0, 150.0), (0.0, 3.0 * FULL), (0.0, 1.05))
    # The sphere's own colour at its radius.
    full = [(FULL * n, rf"${2 * n}\pi$") for n in range(1, 4)]
    ticks = [(0.0, "$0$"), *((at, "" if n == 0 else text) for n, (at, text) in enumerate(full))]
    records = axes.frame(ticks, [(0.0, "$0$"), (1.0, "$1$")], r"$|\mathbf{x}|$")
    records.append(
        scene.Label(
            r"smallest singular value of $d\,\exp_{\mathbf{x}}$",
            (600.0, 266.0, 0.0),
            style.INK,
            style.TITLE_TEXT,
            anchor="cn",
        )
    )
    records.append(axes.curve(x, values, style.INK))
    records.append(axes.dots(FULL * np.arange(2, 4), 0.0, style.INK))
    records.append(axes.dots(FULL, 0.0, style.GLASS_EDGE, 9.0))
    at = axes.at(FULL, 0.0)
    records.append(
        scene.Label(full[0][1], at, style.GLASS_EDGE, style.SMALL_TEXT, (0.0, -14.0), "ct", halo=False)
    )
    for length, name in zip(marked, ("through", "beside"), strict=True):
        value = np.interp(length, x, values)
        records.append(axes.dots(length, value, style.ALGEBRA, 10.0))
        records.append(
            scene.Label(
                name,
                axes.at(length, value),
                style.ALGEBRA_TEXT,
                style.SMALL_TEXT,
                (14.0, 6.0),
                "lb",
                room=60.0,
            )
        )
    return records
