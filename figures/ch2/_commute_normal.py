"""`commute` for a translation between a rotation and its inverse (3.5)."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import scene, style

from . import _letters
from . import _motions as m


def drawing(theta: float, b: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """R_theta T_b R_-theta, step by step, and the translation that it is."""
    steps = [m.turn(-theta), m.shift(b), m.turn(theta)]
    shapes = [m.shift(place)]
    for step in steps:
        shapes.append(step @ shapes[-1])
    turned = m.turn(theta)[:2, :2] @ b

    def at(t: float) -> list[np.ndarray]:
        one, two, three = m.parts(t, 3)
        long = m.turn(three * theta) @ m.shift(two * b) @ m.turn(-one * theta) @ shapes[0]
        return [long, m.shift(t * turned) @ shapes[0]]

    numbers = {
        "theta": theta,
        "b": b,
        "stages": np.stack(shapes),
        "product": steps[2] @ steps[1] @ steps[0],
        "turned": turned,
        "now": np.stack(at(t)),
    }
    shown = m.vectors(b, turned)
    given = rf"$\theta = {m.degrees(theta)},\;\; b = {shown[0]},\;\; b' = R_\theta\, b = {shown[1]}$"
    records = [
        *_records(theta, b, turned, shapes, at, t),
        m.title("turn, shift, turn back: a shift"),
        *m.legend([(m.FIRST, r"$R_\theta\, T_b\, R_{-\theta}$"), (m.SECOND, "$T_{b'}$")]),
        m.note(given),
    ]
    return Drawing(m.picture(records), numbers)


def _records(
    theta: float, b: np.ndarray, turned: np.ndarray, shapes: list[np.ndarray], at: m.Moving, t: float
) -> list[scene.Record]:
    feet = [T[:2, 2] for T in shapes]
    extent = m.extent([m.ORIGIN, *feet, feet[0] + b])
    size = 0.21 * extent or 1.0
    legs = [
        m.about(m.ORIGIN, feet[0], -theta),
        m.straight(feet[1], b),
        m.about(m.ORIGIN, feet[2], theta),
    ]
    vectors = [m.straight(feet[0], b), m.straight(feet[0], turned)]
    angle = m.about(feet[0], feet[0] + b, theta, 0.36 * float(np.linalg.norm(b)))
    around = m.about(m.ORIGIN, feet[2], theta, 0.3 * float(np.linalg.norm(feet[0])))
    letter = _letters.tracked(size, shapes, [*legs, *vectors, angle])
    outlines = [letter.outline(T) for T in shapes]
    page = m.fit([m.ORIGIN, feet[0] + b, angle, *legs, *outlines, *m.swept(letter, at)], size)
    again = m.same(turned, b, extent)
    records: list[scene.Record] = [
        *m.fan(page, m.ORIGIN, legs[2], style.ROUTE_1, 0.09),
        *m.fan(page, m.ORIGIN, legs[0], style.ROUTE_1, 0.09),
        *(m.spoke(page, m.ORIGIN, foot) for foot in feet),
        m.center(page, "$O$", m.ORIGIN, -np.mean(feet, axis=0)),
        *m.angle(page, around, m.ORIGIN),
        *m.angle(page, angle, feet[0]),
        *letter.draw(page, m.turn(0.5 * theta) @ shapes[2], _letters.FAINT),
        *letter.stages(page, shapes[:3]),
        *m.travellers(page, letter, at(t), shapes[3], t),
    ]
    if not again:
        records += m.given(page, vectors[0], "b", [b[1], -b[0]])
    for k, (curve, name) in enumerate(zip(legs, (r"R_{-\theta}", "T_b", r"R_\theta"), strict=True)):
        records += m.leg(page, curve, m.FIRST, rf"{k + 1}\!:\; {name}")
    records += m.leg(page, vectors[1], m.SECOND, "b' = b" if again else r"b' = R_\theta\, b")
    return [*records, page.dots(np.stack([m.ORIGIN, *feet]), style.INK, m.DOT)]
