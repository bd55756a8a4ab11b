"""Gimbal lock, section 2.6 of the book: equations (2.21) to (2.23)."""

from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import euler, so3
from lietool.render import marks, scene, solids, style
from lietool.render.camera import Camera, Page
from lietool.render.globe import joined
from lietool.render.plot import Axes, number

_SINGULAR = 1e-9
# Where two axes share a line: the length of a stroke of each. Inside of _SOLID nothing crosses the solid.
_STROKE, _SOLID = 0.075, 0.40
NAMES = (r"\theta_1", r"\theta_2", r"\theta_3")
_TO_MATRIX, _FROM_MATRIX = Library("lietool.lie.euler.to_matrix"), Library("lietool.lie.euler.from_matrix")
# Of angles or a rotation, and of three axes such as "xyx".
_Convert = Callable[[np.ndarray, str], np.ndarray]


@figure(
    plates={
        "GL1": Plate(
            title="Three rings, at ordinary angles and at lock",
            equations=("2.21", "2.22"),
            caption=(
                "The rotation R_z(theta_3) R_y(theta_2) R_x(theta_1) as three nested rings, each turning "
                "about an axle in the next. Left: three independent axes. Right: at theta_2 = -90 degrees "
                "the innermost axis has come to lie along the outermost, drawn as one line of both colours; "
                "only theta_1 + theta_3 matters, and one freedom is lost. Printed below: the angles, and the "
                "smallest singular value of the Jacobian of the Euler map, which is 0 at lock."
            ),
        ),
        "GL2": Plate(
            title="Euler angles that jump, and why",
            equations=("2.22", "2.23"),
            caption=(
                "Above: the x-y-x Euler angles of R_z(theta), with theta_2 from 0 to 180 degrees. The other "
                "two jump by 180 degrees as theta passes through 0, where only their sum is fixed, although "
                "the rotation hardly moves; with theta_2 < 0 (dashed) they need not. Below: the smallest "
                "singular value of the Jacobian of the Euler map, 0 at 0 and 180 degrees for x-y-x, at 90 "
                "and -90 degrees for x-y-z (dashed). The dots mark the angle theta whose values are printed."
            ),
            params={"view": "angles", "theta2": 35.0},
        ),
    },
    time=Time("theta2", 60.0, -90.0),
)
def gimbal(
    view: Annotated[Literal["rings", "angles"], Param("the rings, or the angles as curves")] = "rings",
    theta1: Annotated[
        float, Param("turn of the inner ring about x", "deg", -360.0, 360.0, only=("view", "rings"))
    ] = -14.0,
    theta2: Annotated[
        float,
        Param(
            "turn of the middle ring about y; in the curves, the angle that is marked", "deg", -180.0, 180.0
        ),
    ] = -20.0,
    theta3: Annotated[
        float, Param("turn of the outer ring about z", "deg", -360.0, 360.0, only=("view", "rings"))
    ] = -4.0,
    *,
    to_matrix: Library = _TO_MATRIX,
    from_matrix: Library = _FROM_MATRIX,
) -> Drawing:
    """Gimbal lock: two of the three axes of the Euler angles coincide, and the angles jump.

    What to look for: on the left the red, green and blue axes point in three
    directions; on the right red and blue share one line (drawn in both colours),
    so that turning the inner ring does what turning the outer one does.
    The smallest singular value says how near the lock is: 0 there. With
    --view angles it is drawn over theta_2, below the angles of a rotation that
    passes through the lock.
    """
    angles = np.deg2rad([theta1, theta2, theta3])
    if view == "rings":
        return _rings(angles, to_matrix)
    return _curves(float(angles[1]), to_matrix, from_matrix)


def _rings(angles: np.ndarray, to_matrix: _Convert) -> Drawing:
    # Always the same of the two locks, so that in motion nothing jumps as theta_2 passes 0.
    locked = np.array([angles[0], -np.pi / 2, angles[2]])
    both = np.stack([angles, locked])
    axes = euler.axes(both, "xyz")
    smallest = euler.singular_values(both, "xyz").min(axis=-1)
    # From here the inner axis, on its way to lock, never points at the viewer.
    camera = Camera((0.8, 0.9, 0.62), height=3.2)
    views, turned = [], to_matrix(both, "xyz")
    for i in range(2):
        records = [*_gimbal(both[i], turned[i]), *_axes(axes[i], camera)]
        views.append(scene.View(tuple(records), camera, (600.0 * i, 84.0, 600.0, 690.0)))
        views.append(scene.View(tuple(_legend(300.0 + 600.0 * i, both[i], axes[i], float(smallest[i])))))
    views.append(scene.View((scene.Lines([(600, 60, 0), (600, 840, 0)], style.RULE, style.HAIR),)))
    numbers = {
        "angles": both,
        "rotation": turned,
        "axes": axes,
        "smallest_singular_value": smallest,
    }
    return Drawing(scene.Picture(tuple(views)), numbers)


def _legend(x: float, angles: np.ndarray, axes: np.ndarray, smallest: float) -> list[scene.Record]:
    title = "near lock" if _nearness(axes) > 0.5 else "three independent axes"
    sigma = rf"$\sigma_{{\min}} = {number(smallest, 3)}$"
    if smallest < _SINGULAR:
        title = "at lock"
        # Turning about one line twice: the angles add up, or cancel where the axes point against each other.
        sign = "+" if axes[0] @ axes[2] > 0.0 else "-"
        sigma += rf": only ${NAMES[0]} {sign} {NAMES[2]}$ matters"
    degrees = [number(a, 1) for a in np.rad2deg(angles)]
    values = r",\;\, ".join(rf"{n} = {d}^{{\circ}}" for n, d in zip(NAMES, degrees, strict=True))
    return [
        scene.Label(title, (x, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label(f"${values}$", (x, 92.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
        scene.Label(sigma, (x, 40.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
    ]


def _gimbal(angles: np.ndarray, turned: np.ndarray) -> list[scene.Record]:
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
        (outer[:, 2], 0.98, 1.08, style.INK),
        (outer[:, 1], 0.78, 0.85, style.INK),
        (middle[:, 0], 0.61, 0.68, style.INK),
    ):
        records += [scene.Tube([s * near * axis, s * far * axis], color, 0.035) for s in (-1.0, 1.0)]
    records.append(scene.Tube([0.31 * inner[:, 2], 0.52 * inner[:, 2]], style.INK, 0.025))
    return records + marks.letter(turned, size=0.64)


def _ring(R: np.ndarray, radius: float, color: str) -> scene.Surface:
    vertices, faces, normals = solids.band(radius - 0.05, radius + 0.05, 0.11)
    return scene.Surface(vertices @ R.T, faces, color, normals @ R.T)


def _axes(axes: np.ndarray, camera: Camera) -> list[scene.Record]:
    """The three axes of rotation, each with its turn and its name; two that coincide share one line."""
    near = _nearness(axes)
    records: list[scene.Record] = []
    # Where each axle ends, how far the line goes on behind it, and where the tip is.
    lengths = ((0.80, 1.18 + 0.24 * near, 1.18 + 0.16 * near), (0.97, 1.18, 1.18), (1.10, 1.42, 1.60))
    for k, (start, back, reach) in enumerate(lengths):
        axis, color = axes[k], style.AXES[k]
        tip = reach * axis
        records += _shaft(k, axis, (start, back, reach - 0.10), near if k != 1 else 0.0)
        records.append(scene.Arrow((reach - 0.28) * axis, tip, color, 0.02))
        records += _turn((reach - 0.21) * axis, axis, color, camera)
        name = marks.beyond(f"${NAMES[k]}$", tip, axis, camera, color=style.AXES_TEXT[k], gap=31.0)
        if k == 0:
            # At lock the other head is beyond this one; the name goes beside it.
            offset = (1.0 - near) * np.array(name.offset) + near * np.array([-54.0, -12.0])
            name = replace(name, offset=(float(offset[0]), float(offset[1])))
        records.append(name)
    return records


def _shaft(k: int, axis: np.ndarray, ends: tuple[float, float, float], near: float) -> list[scene.Record]:
    """The line of an axis outside the rings, and as far as another comes to lie on it also inside them.

    Near lock it opens into strokes, which lie in the gaps of the other line, whichever way that points.
    """
    start, back, front = ends
    half = _STROKE * (1.0 - near / 2.0)
    middles = np.arange(-40 + k // 2, 41, 2) * _STROKE
    records: list[scene.Record] = []
    for pieces, alpha in (
        (((-back, -start), (start, front)), 1.0),
        (((-start, -_SOLID), (_SOLID, start)), near),
    ):
        spans = [(max(m - half, low), min(m + half, high)) for m in middles for low, high in pieces]
        parts = [np.outer(span, axis) for span in spans if span[1] - span[0] > 1e-9]
        if alpha > 0.0 and parts:
            width = style.EDGE + (2.0 * style.CURVE - style.EDGE) * near
            records.append(scene.Lines(joined(parts), style.AXES[k], width, alpha))
    return records


def _nearness(axes: np.ndarray) -> float:
    """How near the inner axis is to the line of the outer one: 1 at lock, 0 from 40 degrees on."""
    angle = np.arctan2(np.linalg.norm(np.cross(axes[0], axes[2])), abs(axes[0] @ axes[2]))
    rest = max(1.0 - float(angle) / np.deg2rad(40.0), 0.0)
    return rest * rest * (3.0 - 2.0 * rest)


def _turn(center: np.ndarray, axis: np.ndarray, color: str, camera: Camera) -> list[scene.Record]:
    """A curved arrow about an axis, its head towards the viewer."""
    frame = solids.frame_along(axis)
    toward = frame[:, :2].T @ camera.axes[2]
    middle = np.arctan2(toward[1], toward[0])
    angle = middle + np.deg2rad(np.linspace(-185.0, 55.0, 41))
    ring = np.cos(angle)[:, None] * frame[:, 0] + np.sin(angle)[:, None] * frame[:, 1]
    return marks.curved_arrow(center + 0.15 * ring, color, 0.012, 4.0)


def _about_z(theta: np.ndarray, to_matrix: _Convert) -> np.ndarray:
    """R_z(theta) by its x-y-x angles as the text has them, (2.23)."""
    quarter = np.full_like(theta, np.pi / 2.0)
    return to_matrix(np.stack([-quarter, theta, quarter], axis=-1), "xyx")


def _curves(marked: float, to_matrix: _Convert, from_matrix: _Convert) -> Drawing:
    # Midpoints of degrees: at 0 and 180 themselves the angles are not determined.
    theta = np.deg2rad(np.arange(-179.5, 180.0))
    angles = from_matrix(_about_z(theta, to_matrix), "xyx")
    second = np.linspace(-np.pi, np.pi, 721)
    rows = np.stack([0.0 * second, second, 0.0 * second], axis=-1)
    smallest = {c: euler.singular_values(rows, c).min(axis=-1) for c in ("xyx", "xyz")}
    # That one without rounding, for it may be at lock.
    here = from_matrix(so3.rotation("z", marked), "xyx")
    # The same rotations by the other choice of signs, with theta_2 below 0.
    other = angles * (1.0, -1.0, 1.0) + (np.pi, 0.0, np.pi)
    near = float(euler.singular_values(here, "xyx").min())
    page = [*_jump(theta, angles, other, marked, here), *_singular(second, smallest, here, near)]
    page.append(_values(marked, here, near))
    numbers = {"theta": theta, "angles": angles, "theta_2": second, "marked": here}
    numbers["marked_singular_value"] = near
    numbers["rotation_by_other_angles"] = to_matrix(other, "xyx")
    numbers |= {f"smallest_singular_value_{c}": s for c, s in smallest.items()}
    return Drawing(scene.Picture((scene.View(tuple(page), Page()),)), numbers)


def _degree_ticks(step: int, last: int = 180) -> list[tuple[float, str]]:
    return [(d, rf"${d}^{{\circ}}$") for d in range(-last, last + 1, step)]


def _heading(axes: Axes, text: str) -> scene.Label:
    left, low, width, height = axes.box
    at = (left + width / 2.0, low + height + 56.0, 0.0)
    return scene.Label(text, at, style.INK, style.TITLE_TEXT, anchor="cn")


def _values(marked: float, here: np.ndarray, near: float) -> scene.Label:
    """The angles at the marked theta and how near that is to lock, in one line."""
    first, second, third = (rf"{number(a, 1)}^{{\circ}}" for a in np.rad2deg(here))
    values = [f"{name} = {value}" for name, value in zip(NAMES, (first, second, third), strict=True)]
    if near < _SINGULAR:
        # Of the two outer angles only this is determined; `here` has the second of them 0.
        sign = "+" if np.cos(here[1]) > 0.0 else "-"
        values = [values[1], rf"{NAMES[0]} {sign} {NAMES[2]} = {first}"]
    listed = r",\;\, ".join([*values, rf"\sigma_{{\min}} = {number(near, 3)}"])
    text = rf"at $\theta = {number(np.rad2deg(marked), 1)}^{{\circ}}$:  ${listed}$"
    return scene.Label(text, (600.0, 36.0, 0.0), style.INK, style.SMALL_TEXT, anchor="cn")


def _jump(
    theta: np.ndarray, angles: np.ndarray, other: np.ndarray, marked: float, here: np.ndarray
) -> list[scene.Record]:
    axes = Axes((150.0, 500.0, 900.0, 290.0), (-180.0, 180.0), (-190.0, 190.0))
    records = axes.frame(_degree_ticks(90), _degree_ticks(90), r"$\theta$")
    records.append(_heading(axes, rf"$R_x({NAMES[2]})\,R_y({NAMES[1]})\,R_x({NAMES[0]}) = R_z(\theta)$"))
    x, y = np.rad2deg(theta), np.rad2deg(angles)
    middle = len(x) // 2
    # On the left the other choice goes on smoothly from the right.
    below = np.append(np.rad2deg(other[:middle, 1]), 0.0)
    records.append(axes.curve(np.append(x[:middle], 0.0), below, style.AXIS_Y, style.CURVE, (12.0, 8.0)))
    at = axes.at(-128.0, -128.0)
    text = f"${NAMES[1]} < 0$"
    records.append(scene.Label(text, at, style.AXES_TEXT[1], style.SMALL_TEXT, (14.0, -10.0), "lt"))
    determined = np.abs(np.sin(marked)) > _SINGULAR
    shown = [k for k in range(3) if determined or k == 1]
    ends = [pick(float(np.rad2deg(here[k])) for k in shown) for pick in (min, max)]
    records.append(scene.Lines(axes.at(np.rad2deg(marked), ends), style.MUTED, style.THIN))
    for k in (1, 0, 2):
        for half in (slice(0, middle), slice(middle, None)):
            records.append(axes.curve(x[half], y[half, k], style.AXES[k]))
    records += _leaps(axes, y[[middle - 1, middle]])
    for k, place in ((0, 160.0), (1, 112.0), (2, 160.0)):
        for place_x in (-place, place):
            where = axes.at(place_x, np.interp(place_x, x, y[:, k]))
            name, color = f"${NAMES[k]}$", style.AXES_TEXT[k]
            records.append(scene.Label(name, where, color, style.TEXT, (0.0, 12.0), "cb", room=40.0))
    return records + [axes.dots(np.rad2deg(marked), np.rad2deg(here[k]), style.AXES[k], 9.0) for k in shown]


def _leaps(axes: Axes, sides: np.ndarray) -> list[scene.Record]:
    """The two jumps at theta = 0, on one line in strokes of both colours; `sides` are those of it."""
    records: list[scene.Record] = []
    for k in (k for k in (0, 2) if sides[0, k] != sides[1, k]):
        start, end = axes.at([0.0, 0.0], sides[:, k])
        along = (end - start) / np.linalg.norm(end - start)
        # Each from its own start: an even number of strokes, so that the gaps of one hold those of the other.
        strokes = np.linspace(start, end, 9)
        pieces = joined(strokes[i : i + 2] for i in range(0, 8, 2))
        records.append(scene.Lines(pieces, style.AXES[k], style.CURVE))
        records.append(scene.Arrow(end - 46.0 * along, end - 7.0 * along, style.AXES[k], 1.6, 4.6))
    at_both = np.unique(sides[:, [0, 2]].round(6))
    records.append(axes.dots(np.zeros(len(at_both)), at_both, style.INK, 7.0, hollow=True))
    across = float(np.abs(np.diff(sides, axis=0)).max())
    for text, at, offset, anchor in (
        (rf"a jump of ${number(across, 0)}^{{\circ}}$", at_both[-1], 14.0, "cb"),
        (rf"at $0^{{\circ}}$ only ${NAMES[0]} + {NAMES[2]}$ is fixed", at_both[0], -14.0, "ct"),
    ):
        where = axes.at(0.0, at)
        records.append(scene.Label(text, where, style.INK, style.SMALL_TEXT, (0.0, offset), anchor))
    return records


def _singular(
    second: np.ndarray, smallest: dict[str, np.ndarray], here: np.ndarray, near: float
) -> list[scene.Record]:
    axes = Axes((150.0, 140.0, 900.0, 190.0), (-180.0, 180.0), (0.0, 1.1))
    records = axes.frame(_degree_ticks(90), [(0.0, "$0$"), (1.0, "$1$")], f"${NAMES[1]}$")
    records.append(_heading(axes, r"smallest singular value $\sigma_{\min}$ of the Jacobian"))
    x, at = np.rad2deg(second), float(np.rad2deg(here[1]))
    records.append(scene.Lines(axes.at([at, at], [0.0, near]), style.MUTED, style.THIN))
    for convention, color, dash, place in (
        ("xyz", style.MUTED, (10.0, 7.0), 0.0),
        ("xyx", style.INK, None, -90.0),
    ):
        values = smallest[convention]
        records.append(axes.curve(x, values, color, dash=dash))
        records.append(axes.dots(x[values < _SINGULAR], 0.0, color))
        name = "-".join(convention)
        records.append(scene.Label(name, axes.at(place, 1.0), color, style.SMALL_TEXT, (0.0, -32.0), "ct"))
    return [*records, axes.dots(at, near, style.INK, 9.0)]
