"""`commute` for a translation between a rotation and its inverse (3.5)."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import plane, scene, style

from . import _motions as m

# The shapes, and about how wide their names are, in page units.
_NAMES = ((r"\mathrm{start}", 70.0), ("1", 18.0), ("2", 18.0), ("3", 18.0))


def drawing(theta: float, b: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """R_theta T_b R_-theta, step by step, and the translation that it is."""
    steps = [m.turn(-theta), m.shift(b), m.turn(theta)]
    shapes = [m.shift(place)]
    for step in steps:
        shapes.append(step @ shapes[-1])
    turned = m.turn(theta)[:2, :2] @ b
    one, two, three = m.parts(t, 3)
    long = m.turn(three * theta) @ m.shift(two * b) @ m.turn(-one * theta) @ shapes[0]
    now = np.stack([long, m.shift(t * turned) @ shapes[0]])
    numbers = {
        "theta": theta,
        "b": b,
        "stages": np.stack(shapes),
        "product": steps[2] @ steps[1] @ steps[0],
        "turned": turned,
        "now": now,
    }
    given = rf"$\theta = {m.degrees(theta)},\;\; b = {m.vector(b)},\;\; R_\theta b = {m.vector(turned)}$"
    records = [
        *_records(theta, b, turned, shapes, now, t),
        m.title("turn, shift, turn back: a shift"),
        *m.legend([(m.FIRST, r"$R_\theta\, T_b\, R_{-\theta}$"), (m.SECOND, r"$T_{R_\theta b}$")]),
        m.note(given),
    ]
    return Drawing(m.picture(records), numbers)


def _records(
    theta: float, b: np.ndarray, turned: np.ndarray, shapes: list[np.ndarray], now: np.ndarray, t: float
) -> list[scene.Record]:
    feet = [T[:2, 2] for T in shapes]
    extent = m.extent([m.ORIGIN, *feet, feet[0] + b])
    size = 0.21 * extent or 1.0
    legs = [
        m.about(m.ORIGIN, feet[0], -theta),
        m.straight(feet[1], b),
        m.about(m.ORIGIN, feet[2], theta),
    ]
    angle = m.about(feet[0], feet[0] + b, theta, 0.62 * float(np.linalg.norm(b)))
    page = m.fit([m.ORIGIN, feet[0] + b, angle, *legs, *(m.outline(T, size) for T in shapes)], size)
    again = m.same(turned, b, extent)
    records: list[scene.Record] = [page.line(np.stack([m.ORIGIN, foot]), style.RULE) for foot in feet]
    records.append(page.beyond("$O$", m.ORIGIN, -np.mean(feet, axis=0), size=style.SMALL_TEXT))
    records += m.angle(page, angle, feet[0])
    if not again:
        records += _given(page, m.straight(feet[0], b), b)
    records += [*m.stages(page, shapes[:3], size), *m.travellers(page, now, shapes[3], size, t)]
    for curve, name in zip(legs, (r"R_{-\theta}", "T_b", r"R_\theta"), strict=True):
        records += m.leg(page, curve, m.FIRST, name)
    direct = m.straight(feet[0], turned)
    records += m.leg(page, direct, m.SECOND, r"R_\theta b = b" if again else r"R_\theta b")
    records.append(page.dots(np.stack([m.ORIGIN, *feet]), style.INK, 6.5))
    # Over the head of each F; at the start away from the vectors.
    towards = [-b - turned, *(T[:2, 1] for T in shapes[1:])]
    return [*records, *m.tags(page, shapes, size, _NAMES, towards, r",\; ")]


def _given(page: plane.Plane, vector: np.ndarray, b: np.ndarray) -> list[scene.Record]:
    """The given b, drawn at the start to be compared with what becomes of it."""
    drawn = plane.path(page.at(vector), style.MUTED, style.EDGE)
    return [*drawn, m.named(page, vector, "$b$", style.MUTED, [b[1], -b[0]])]
