"""The second plate of `exp_singularity`: two paths of rotations and their logarithms."""

import numpy as np

from lietool.figure import Drawing
from lietool.lie import so3
from lietool.render import scene, style
from lietool.render.camera import Camera
from lietool.render.globe import globe, joined, jumps
from lietool.render.marks import coordinate_axes
from lietool.render.plot import Axes, number

FULL = 2.0 * np.pi
# A full turn about x and one about y: where the paths end.
LAST = 2.0 * FULL


def drawing(turn: float, aside: float) -> Drawing:
    """R_x up to a full turn, then R_y: as it is, and moved aside by a rotation about z."""
    # Closest together at full turns, where the path passes I: beside it the logarithm moves fastest.
    turns, rest = np.divmod(np.linspace(0.0, LAST / FULL, 241), 1.0)
    steps = FULL * (turns + rest**2 * (3.0 - 2.0 * rest))
    through = _motion(steps)
    beside = so3.rotation("z", aside) @ through
    shown = max(int(np.searchsorted(steps, turn + 1e-9)), 1)
    starts = (np.zeros(3), np.array([0.0, 0.0, aside]))
    lifts = [so3.log_along(p[:shown], start) for p, start in zip((through, beside), starts, strict=True)]
    lengths = np.array([np.linalg.norm(lift[-1]) for lift in lifts])
    x = np.linspace(0.0, 3.0 * FULL, 601)
    jacobian = so3.left_jacobian(np.stack([x, 0.0 * x, 0.0 * x], axis=-1))
    smallest = np.linalg.svd(jacobian, compute_uv=False).min(axis=-1)
    camera = Camera((1.0, 0.50, 0.42), (0.0, 0.0, 0.0), 3.1)
    views = [
        scene.View(tuple(_lift_view(lift / FULL, camera, i)), camera, (600.0 * i, 318.0, 600.0, 500.0))
        for i, lift in enumerate(lifts)
    ]
    titles = ("through the identity", "beside the identity")
    page: list[scene.Record] = [
        scene.Label(text, (300.0 + 600.0 * i, 856.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn")
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


def _lift_view(lift: np.ndarray, camera: Camera, which: int) -> list[scene.Record]:
    breaks = jumps(lift)
    color = (style.WRONG, style.RIGHT)[which]
    names = ("$x_1$", "$x_2$", "$x_3$")
    records = [*globe(camera, alpha=0.75), *coordinate_axes(camera, names, 1.42)]
    records.append(
        scene.Lines(joined(-np.stack([0.0 * a, a]) for a in np.eye(3)), style.INK, style.THIN, 0.45)
    )
    corner = (camera.axes[0] + camera.axes[1]) / np.sqrt(2.0)
    records.append(
        scene.Label(r"$|x| = 2\pi$", corner, style.GLASS_EDGE, style.SMALL_TEXT, (20.0, 0.0), "lc")
    )
    records += [scene.Tube(piece, color, 0.018) for piece in np.split(lift, breaks)]
    for jump in breaks:
        start, end = lift[jump - 1], lift[jump]
        # Drawn as a bow below, since straight back it would lie under the path.
        s = np.linspace(0.0, 1.0, 41)[:, None]
        bow = (1.0 - s) * start + s * end - 1.5 * s * (1.0 - s) * camera.axes[1]
        records += [
            scene.Lines(bow, color, 2.6, dash=(7.0, 6.0), lift=0.5),
            scene.Points([start], style.PAPER, 9.0, rim=color),
            scene.Label(_jump_name(start, end), bow[20], color, style.SMALL_TEXT, (14.0, -8.0), "lt"),
        ]
    records.append(scene.Points(lift[[0]], color, 8.0))
    records.append(scene.Points(lift[[-1]], color, 11.0, rim=style.PAPER))
    return records


def _jump_name(start: np.ndarray, end: np.ndarray) -> str:
    return rf"a jump of ${number(2.0 * np.linalg.norm(end - start))}\pi$"


def _smallest(x: np.ndarray, values: np.ndarray, marked: np.ndarray) -> list[scene.Record]:
    axes = Axes((150.0, 90.0, 900.0, 180.0), (0.0, 3.0 * FULL), (0.0, 1.1))
    ticks = [(FULL * n, rf"${2 * n}\pi$" if n else "$0$") for n in range(4)]
    records = axes.frame(
        ticks, [(0.0, "$0$"), (1.0, "$1$")], "$|x|$", r"smallest singular value of $d\exp_x$"
    )
    records.append(axes.area(x, values, style.INK, 0.07))
    records.append(axes.curve(x, values, style.INK))
    records.append(axes.dots(FULL * np.arange(1, 4), 0.0, style.INK))
    for length, color in zip(marked, (style.WRONG, style.RIGHT), strict=True):
        hollow = color == style.RIGHT
        records.append(axes.dots(length, np.interp(length, x, values), color, 10.0, hollow=hollow))
    return records
