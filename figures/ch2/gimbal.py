"""Gimbal lock, section 2.6 of the book: equations (2.21) to (2.23)."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.lie import euler, so3
from lietool.render import marks, scene, solids, style
from lietool.render.camera import Camera, Page
from lietool.render.plot import Axes, number

_SINGULAR = 1e-9
NAMES = (r"\theta_1", r"\theta_2", r"\theta_3")


@figure(
    plates={
        "GL1": Plate(
            title="Three rings, at ordinary angles and at lock",
            equations=("2.21", "2.22"),
            caption=(
                "The rotation R_z(theta_3) R_y(theta_2) R_x(theta_1) as three nested rings, each turning "
                "about an axle in the next. Left: three independent axes. Right: at theta_2 = -90 degrees "
                "the innermost axis has come to lie along the outermost, and one freedom is lost. Below: the "
                "smallest singular value of the Jacobian of the Euler map."
            ),
        ),
        "GL2": Plate(
            title="Euler angles that jump, and why",
            equations=("2.22", "2.23"),
            caption=(
                "Above: the x-y-x Euler angles of R_z(theta), with theta_2 from 0 to 180 degrees. The other "
                "two jump by 180 degrees as theta passes through 0, although the rotation hardly moves; with "
                "theta_2 < 0 (dashed) they need not. Below: the smallest singular value of the Jacobian of "
                "the Euler map, 0 at 0 and 180 degrees for x-y-x, at 90 and -90 degrees for x-y-z."
            ),
            params={"view": "angles", "theta2": 35.0},
        ),
    },
    time=Time("theta2", 60.0, -90.0),
)
def gimbal(
    view: Annotated[Literal["rings", "angles"], Param("the rings, or the angles as curves")] = "rings",
    theta1: Annotated[float, Param("turn of the inner ring about x", "deg", -360.0, 360.0)] = 12.0,
    theta2: Annotated[
        float,
        Param(
            "turn of the middle ring about y; in the curves, the angle that is marked", "deg", -180.0, 180.0
        ),
    ] = -20.0,
    theta3: Annotated[float, Param("turn of the outer ring about z", "deg", -360.0, 360.0)] = -12.0,
) -> Drawing:
    """Gimbal lock: two of the three axes of the Euler angles coincide, and the angles jump.

    What to look for: on the left the red, green and blue axes point in three
    directions; on the right red and blue share one line (they are drawn side by
    side), so that turning the inner ring does what turning the outer one does.
    The smallest singular value says how near the lock is: 0 there. With
    --view angles it is drawn over theta_2, below the angles of a rotation that
    passes through the lock.
    """
    angles = np.deg2rad([theta1, theta2, theta3])
    return _rings(angles) if view == "rings" else _curves(float(angles[1]))


def _rings(angles: np.ndarray) -> Drawing:
    # Always the same of the two locks, so that in motion nothing jumps as theta_2 passes 0.
    locked = np.array([angles[0], -np.pi / 2, angles[2]])
    both = np.stack([angles, locked])
    axes = euler.axes(both, "xyz")
    smallest = euler.singular_values(both, "xyz").min(axis=-1)
    # From here the inner axis, on its way to lock, never points at the viewer.
    camera = Camera((0.8, 0.9, 0.62), height=3.2)
    views = []
    for i in range(2):
        records = [*_gimbal(both[i]), *_axes(axes[i], camera)]
        views.append(scene.View(tuple(records), camera, (600.0 * i, 120.0, 600.0, 690.0)))
        views.append(scene.View(tuple(_legend(300.0 + 600.0 * i, both[i], axes[i], float(smallest[i])))))
    views.append(scene.View((scene.Lines([(600, 60, 0), (600, 840, 0)], style.RULE, style.HAIR),)))
    numbers = {
        "angles": both,
        "rotation": euler.to_matrix(both, "xyz"),
        "axes": axes,
        "smallest_singular_value": smallest,
    }
    return Drawing(scene.Picture(tuple(views)), numbers)


def _legend(x: float, angles: np.ndarray, axes: np.ndarray, smallest: float) -> list[scene.Record]:
    title = "near lock" if _nearness(axes) > 0.5 else "three independent axes"
    title = "at lock" if smallest < _SINGULAR else title
    degrees = [number(a, 1) for a in np.rad2deg(angles)]
    values = r",\;\, ".join(rf"{n} = {d}^{{\circ}}" for n, d in zip(NAMES, degrees, strict=True))
    sigma = rf"$\sigma_{{\min}} = {number(smallest, 3)}$"
    return [
        scene.Label(title, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label(f"${values}$", (x, 92.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
        scene.Label(sigma, (x, 40.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
    ]


def _gimbal(angles: np.ndarray) -> list[scene.Record]:
    """Rings from the outside in, each with the axle that carries the next; the solid is on the inner one."""
    outer, middle, inner = euler.ring_frames(angles, "xyz")
    # A ring is made about z; these bring that axis to the normal of the plane that holds both of its axles.
    about_x, about_y = so3.rotation("y", np.pi / 2), so3.rotation("x", -np.pi / 2)
    records: list[scene.Record] = [
        _ring(outer @ about_x, 0.90, style.AXIS_Z),
        _ring(middle, 0.73, style.AXIS_Y),
        _ring(inner @ about_y, 0.56, style.AXIS_X),
    ]
    for axis, near, far, color in (
        (outer[:, 2], 0.98, 1.16, style.INK),
        (outer[:, 1], 0.78, 0.85, style.INK),
        (middle[:, 0], 0.61, 0.68, style.INK),
    ):
        records += [scene.Tube([s * near * axis, s * far * axis], color, 0.035) for s in (-1.0, 1.0)]
    records.append(scene.Tube([0.31 * inner[:, 2], 0.52 * inner[:, 2]], style.INK, 0.025))
    return records + marks.letter(inner, size=0.64)


def _ring(R: np.ndarray, radius: float, color: str) -> scene.Surface:
    vertices, faces, normals = solids.band(radius - 0.05, radius + 0.05, 0.11)
    return scene.Surface(vertices @ R.T, faces, color, normals @ R.T)


def _axes(axes: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The three axes of rotation, each with its turn and its name; two that coincide run side by side."""
    near = _nearness(axes)
    # At lock the inner axis is drawn beside the outer one, in the direction that it really has.
    aside, name_aside = near * 0.045 * camera.axes[0], near * 14.0
    records: list[scene.Record] = []
    for k, side in enumerate((-1.0, 0.0, 1.0)):
        axis, color, shift = axes[k], style.AXES[k], side * aside
        reach = 1.42 if k == 2 else 1.18 + (0.24 * near if k == 0 else 0.0)
        tail, neck, tip = (length * axis + shift for length in (-reach, reach - 0.24, reach))
        width = style.EDGE + (style.CURVE - style.EDGE) * near * abs(side)
        records.append(scene.Lines([tail, neck], color, width))
        records.append(scene.Arrow(neck, tip, color, 0.02))
        records += _turn((reach - (0.22 + (0.20 * near if k == 0 else 0.0))) * axis, axis, color, camera)
        name = marks.beyond(f"${NAMES[k]}$", tip, axis, camera, gap=33.0, room=90.0)
        offset = name.offset[0] + side * name_aside, name.offset[1]
        records.append(replace(name, offset=offset))
    return records


def _nearness(axes: np.ndarray) -> float:
    """How near the inner axis is to the line of the outer one: 1 at lock, 0 from 40 degrees on."""
    angle = np.arctan2(np.linalg.norm(np.cross(axes[0], axes[2])), abs(axes[0] @ axes[2]))
    rest = max(1.0 - float(angle) / np.deg2rad(40.0), 0.0)
    return rest * rest * (3.0 - 2.0 * rest)


def _turn(center: np.ndarray, axis: np.ndarray, color: str, camera: Camera) -> list[scene.Record]:
    """A curved arrow about an axis, its gap away from the viewer."""
    frame = solids.frame_along(axis)
    toward = frame[:, :2].T @ camera.axes[2]
    middle = np.arctan2(toward[1], toward[0])
    angle = middle + np.deg2rad(np.linspace(-125.0, 105.0, 41))
    ring = np.cos(angle)[:, None] * frame[:, 0] + np.sin(angle)[:, None] * frame[:, 1]
    curve = center + 0.15 * ring
    ahead = np.cross(axis, ring[-1])
    return [
        scene.Tube(curve, color, 0.011),
        scene.Arrow(curve[-1], curve[-1] + 0.10 * ahead, color, 0.011, 3.0),
    ]


def _curves(marked: float) -> Drawing:
    # Midpoints of degrees: at 0 and 180 themselves the angles are not determined.
    theta = np.deg2rad(np.arange(-179.5, 180.0))
    angles = euler.from_matrix(so3.rotation("z", theta), "xyx")
    second = np.linspace(-np.pi, np.pi, 721)
    rows = np.stack([0.0 * second, second, 0.0 * second], axis=-1)
    smallest = {c: euler.singular_values(rows, c).min(axis=-1) for c in ("xyx", "xyz")}
    here = euler.from_matrix(so3.rotation("z", marked), "xyx")
    # The same rotations by the other choice of signs, with theta_2 below 0.
    other = angles * (1.0, -1.0, 1.0) + (np.pi, 0.0, np.pi)
    records = [*_jump(theta, angles, other, marked, here), *_singular(second, smallest, marked)]
    numbers = {"theta": theta, "angles": angles, "theta_2": second, "marked": here}
    numbers["rotation_by_other_angles"] = euler.to_matrix(other, "xyx")
    numbers |= {f"smallest_singular_value_{c}": s for c, s in smallest.items()}
    return Drawing(scene.Picture((scene.View(tuple(records), Page()),)), numbers)


def _degree_ticks(step: int, last: int = 180) -> list[tuple[float, str]]:
    return [(d, rf"${d}^{{\circ}}$") for d in range(-last, last + 1, step)]


def _jump(
    theta: np.ndarray, angles: np.ndarray, other: np.ndarray, marked: float, here: np.ndarray
) -> list[scene.Record]:
    axes = Axes((150.0, 470.0, 920.0, 310.0), (-180.0, 180.0), (-190.0, 190.0))
    title = rf"$R_x({NAMES[2]})\,R_y({NAMES[1]})\,R_x({NAMES[0]}) = R_z(\theta)$"
    records = axes.frame(_degree_ticks(90), _degree_ticks(90), r"$\theta$", title)
    x, y = np.rad2deg(theta), np.rad2deg(angles)
    middle = len(x) // 2
    # On the left the other choice goes on smoothly from the right.
    below = np.append(np.rad2deg(other[:middle, 1]), 0.0)
    records.append(axes.curve(np.append(x[:middle], 0.0), below, style.AXIS_Y, style.EDGE, (8.0, 7.0)))
    for k, dash in ((1, None), (0, None), (2, (16.0, 7.0))):
        for half in (slice(0, middle), slice(middle, None)):
            ends = x[half], y[half, k]
            records.append(axes.curve(*ends, style.AXES[k], style.CURVE, dash))
    for k, aside in ((0, -7.0), (2, 7.0)):
        start, end = axes.at([0.0, 0.0], y[[middle - 1, middle], k]) + np.array([aside, 0.0, 0.0])
        if abs(end[1] - start[1]) > 1.0:
            records.append(scene.Arrow(start, end, style.AXES[k], 1.6, 4.2))
    across = float(np.abs(y[middle] - y[middle - 1]).max())
    jump = rf"a jump of ${number(across, 0)}^{{\circ}}$"
    records.append(scene.Label(jump, axes.at(28.0, 90.0), style.INK, style.SMALL_TEXT, (0.0, 12.0), "rb"))
    for k, place in ((0, 152.0), (1, 114.0), (2, 152.0)):
        for at in (-place, place):
            where = axes.at(at, np.interp(at, x, y[:, k]))
            records.append(
                scene.Label(f"${NAMES[k]}$", where, style.AXES_TEXT[k], style.TEXT, (0.0, 12.0), "cb")
            )
    determined = np.abs(np.sin(marked)) > _SINGULAR
    shown = [k for k in range(3) if determined or k == 1]
    records.append(axes.vertical(float(np.rad2deg(marked)), style.MUTED, dash=None))
    return records + [axes.dots(np.rad2deg(marked), np.rad2deg(here[k]), style.AXES[k], 9.0) for k in shown]


def _singular(second: np.ndarray, smallest: dict[str, np.ndarray], marked: float) -> list[scene.Record]:
    axes = Axes((150.0, 80.0, 920.0, 220.0), (-180.0, 180.0), (0.0, 1.1))
    records = axes.frame(
        _degree_ticks(90),
        [(0.0, "$0$"), (1.0, "$1$")],
        f"${NAMES[1]}$",
        "smallest singular value of the Jacobian",
    )
    x = np.rad2deg(second)
    for convention, color, dash, at in (
        ("xyz", style.MUTED, (10.0, 7.0), 0.0),
        ("xyx", style.INK, None, -90.0),
    ):
        values = smallest[convention]
        records.append(axes.curve(x, values, color, dash=dash))
        records.append(axes.dots(x[values < _SINGULAR], 0.0, color))
        name = "-".join(convention)
        records.append(scene.Label(name, axes.at(at, 1.0), color, style.SMALL_TEXT, (0.0, -32.0), "ct"))
    here = abs(float(np.rad2deg(marked)))
    records.append(axes.vertical(here, style.MUTED, dash=None))
    records.append(axes.dots(here, float(np.interp(here, x, smallest["xyx"])), style.AXIS_Y, 9.0))
    return records
