"""The three kinds of `transform2`."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import plane, scene, style

from . import _motions as m

# Of a picture without legend.
_BOX = (110.0, 125.0, 980.0, 650.0)


def rotation(theta: float, place: np.ndarray, t: float) -> Drawing:
    """R_theta about the origin."""
    radius = float(np.linalg.norm(place))
    size = 0.62 * radius or 1.0
    start = m.shift(place)
    end = m.turn(theta) @ start
    middles = [m.turn(part * theta) @ start for part in (1.0 / 3.0, 2.0 / 3.0)]
    circle = plane.arc(m.ORIGIN, radius, 0.0, 2.0 * np.pi, 121)
    angle = m.about(m.ORIGIN, place, theta, 0.42 * radius)
    drawn = [circle, angle, *(m.outline(T, size) for T in (start, *middles, end))]
    page = m.fit(drawn, size, _BOX)
    records: list[scene.Record] = [
        *_axes(page, np.concatenate(drawn)),
        page.circle(m.ORIGIN, radius, style.MUTED),
    ]
    for T in middles:
        records += m.shape(page, T, size, m.Look(style.BETWEEN, style.BETWEEN_EDGE, 0.55))
    records += m.shape(page, start, size, m.START)
    records += m.shape(page, end, size, m.OUTLINE if t < 1.0 else m.END)
    if t < 1.0:
        records += m.shape(page, m.turn(t * theta) @ start, size, m.END)
    for foot in (start[:2, 2], end[:2, 2]):
        records.append(page.line([m.ORIGIN, foot], style.INK))
    records += m.leg(page, angle, m.Way(style.ARC, style.ARC_TEXT), r"\theta", angle[len(angle) // 2])
    records += _feet(page, start[:2, 2], end[:2, 2], radius)
    records += [
        m.title(r"a turn about the origin: $\mathbf{x}' = R_\theta\, \mathbf{x}$"),
        m.note(rf"$\theta = {m.degrees(theta)}$"),
    ]
    numbers = {
        "theta": theta,
        "R": end[:2, :2],
        "x": place,
        "x'": end[:2, 2],
        "radius": radius,
        "before": m.outline(start, size),
        "after": m.outline(end, size),
        "now": m.turn(t * theta) @ start,
    }
    return Drawing(m.picture(records), numbers)


def _axes(page: plane.Plane, drawn: np.ndarray) -> list[scene.Record]:
    """The coordinate axes, a little further than all that is drawn."""
    margin = 26.0 / page.scale
    x, y = zip(drawn.min(axis=0) - margin, drawn.max(axis=0) + margin, strict=True)
    return page.axes((min(x[0], 0.0), max(x[1], 0.0)), (min(y[0], 0.0), max(y[1], 0.0)))


def _feet(page: plane.Plane, x: np.ndarray, x_after: np.ndarray, radius: float) -> list[scene.Record]:
    records: list[scene.Record] = [page.dots([m.ORIGIN, x, x_after], style.INK, 6.5)]
    if m.same(x, x_after, radius):
        return [*records, page.beyond(r"$\mathbf{x} = \mathbf{x}'$", x, -x, room=130.0)]
    for text, at in ((r"$\mathbf{x}$", x), (r"$\mathbf{x}'$", x_after)):
        records.append(page.beyond(text, at, -at, room=110.0))
    return records


def rigid(theta: float, b: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """T_b R_theta, and R_theta T_b = T_{R_theta b} R_theta."""
    start, R, T_b = m.shift(place), m.turn(theta), m.shift(b)
    shapes = [start, R @ start, T_b @ start, T_b @ R @ start, R @ T_b @ start]
    one, two = m.parts(t, 2)
    now = np.stack(
        [m.shift(two * b) @ m.turn(one * theta) @ start, m.turn(two * theta) @ m.shift(one * b) @ start]
    )
    b_turned = R[:2, :2] @ b
    again = m.same(b, b_turned, float(np.abs(b).max()))
    given = (
        rf"$\theta = {m.degrees(theta)},\;\; b = {m.vector(b)},\;\; b' = R_\theta b = {m.vector(b_turned)}$"
    )
    records = [
        *_both_orders(theta, b, b_turned, shapes, now, t, again),
        m.title("two orders, the same end" if again else "two orders, two ends, turned alike"),
        *m.legend([(m.FIRST, r"$T_b\, R_\theta$"), (m.SECOND, r"$R_\theta\, T_b = T_{b'}\, R_\theta$")]),
        m.note(given),
    ]
    numbers = {
        "theta": theta,
        "b": b,
        "b'": b_turned,
        "stages": np.stack([shapes[0], shapes[1], shapes[3]]),
        "other_order": np.stack([shapes[0], shapes[2], shapes[4]]),
        "now": now,
    }
    return Drawing(m.picture(records), numbers)


def _both_orders(
    theta: float,
    b: np.ndarray,
    b_turned: np.ndarray,
    shapes: list[np.ndarray],
    now: np.ndarray,
    t: float,
    again: bool,
) -> list[scene.Record]:
    """The shape at its start, turned, shifted, and at the ends of both orders, and the ways between."""
    feet = [T[:2, 2] for T in shapes]
    extent = m.extent([m.ORIGIN, *feet])
    size = max(0.42 * min(float(np.linalg.norm(feet[0])), extent), 0.15 * extent) or 1.0
    legs = [m.about(m.ORIGIN, feet[0], theta), m.straight(feet[1], b)]
    others = [m.straight(feet[0], b), m.about(m.ORIGIN, feet[2], theta), m.straight(feet[1], b_turned)]
    angle = m.about(feet[1], feet[1] + b, theta, 0.45 * float(np.linalg.norm(b)))
    corners = [m.outline(T, size) for T in shapes]
    page = m.fit([m.ORIGIN, angle, *legs, *others, *corners], size)
    arms = [page.line(np.stack([m.ORIGIN, feet[k]]), style.RULE) for k in (0, 1, 2, 4)]
    records: list[scene.Record] = [*arms, *m.stages(page, shapes[:2], size)]
    for k in (2, 4):
        records += m.shape(page, shapes[k], size, m.Look(style.PAPER, style.ROUTE_2, 0.0, (9.0, 6.0)))
    records += m.shape(page, shapes[3], size, m.END if t == 1.0 else m.OUTLINE)
    if t < 1.0:
        records += m.shape(page, now[1], size, m.Look(style.AFTER, m.SECOND.text))
        records += m.shape(page, now[0], size, m.Look(style.AFTER, m.FIRST.text))
    # Where both orders are one, so are the shifts, and one name is enough.
    names = ("", r"R_\theta", "") if again else ("b", r"R_\theta", r"b' = R_\theta b")
    apart = b - b_turned
    records += m.leg(page, legs[0], m.FIRST, r"R_\theta")
    records += m.leg(page, legs[1], m.FIRST, r"b = R_\theta b" if again else "b", None if again else apart)
    for curve, name, away in zip(others, names, (None, None, -apart), strict=True):
        records += m.leg(page, curve, m.SECOND, name, away)
    records += m.angle(page, angle, feet[1])
    records.append(page.dots(np.stack([m.ORIGIN, *feet]), style.INK, 6.5))
    return [*records, page.beyond("$O$", m.ORIGIN, -np.mean(feet, axis=0), size=style.SMALL_TEXT)]


def about(theta: float, b: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """T_b R_theta T_-b, the turn about b."""
    steps = [m.shift(-b), m.turn(theta), m.shift(b)]
    shapes = [m.shift(place)]
    for step in steps:
        shapes.append(step @ shapes[-1])
    one, two, three = m.parts(t, 3)
    long = m.shift(three * b) @ m.turn(two * theta) @ m.shift(-one * b) @ shapes[0]
    now = np.stack([long, m.shift(b) @ m.turn(t * theta) @ m.shift(-b) @ shapes[0]])
    records = [
        *_three_steps(theta, b, shapes, now, t),
        m.title(r"shift, turn, shift back: a turn about $b$"),
        *m.legend([(m.FIRST, r"$T_b\, R_\theta\, T_{-b}$"), (m.SECOND, r"turn by $\theta$ about $b$")]),
        m.note(rf"$\theta = {m.degrees(theta)},\;\; b = {m.vector(b)}$"),
    ]
    numbers = {
        "theta": theta,
        "b": b,
        "stages": np.stack(shapes),
        "product": steps[2] @ steps[1] @ steps[0],
        "now": now,
    }
    return Drawing(m.picture(records), numbers)


def _three_steps(
    theta: float, b: np.ndarray, shapes: list[np.ndarray], now: np.ndarray, t: float
) -> list[scene.Record]:
    feet = [T[:2, 2] for T in shapes]
    size = 0.2 * m.extent([m.ORIGIN, b, *feet]) or 1.0
    legs = [m.straight(feet[0], -b), m.about(m.ORIGIN, feet[1], theta), m.straight(feet[2], b)]
    direct = m.about(b, feet[0], theta)
    page = m.fit([m.ORIGIN, b, direct, *legs, *(m.outline(T, size) for T in shapes)], size)
    spokes = ((m.ORIGIN, feet[1]), (m.ORIGIN, feet[2]), (b, feet[0]), (b, feet[3]))
    records: list[scene.Record] = [page.line(np.stack(spoke), style.RULE) for spoke in spokes]
    records += [*m.stages(page, shapes[:3], size), *m.travellers(page, now, shapes[3], size, t)]
    for k, (curve, name) in enumerate(zip(legs, ("T_{-b}", r"R_\theta", "T_b"), strict=True)):
        records += m.leg(page, curve, m.FIRST, rf"{k + 1}\!:\; {name}")
    records += m.leg(page, direct, m.SECOND, r"\theta", direct[len(direct) // 2] - b)
    middle = np.mean(feet, axis=0)
    if b.any():
        records += plane.path(page.at(m.straight(m.ORIGIN, b)), style.MUTED, style.EDGE)
    for text, at in (("$O$", m.ORIGIN), ("$b$", b)) if b.any() else (("$O = b$", m.ORIGIN),):
        records.append(page.beyond(text, at, at - middle, size=style.SMALL_TEXT))
    return [*records, page.dots(np.stack([m.ORIGIN, b, *feet]), style.INK, 6.5)]
