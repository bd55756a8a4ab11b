"""The three kinds of `transform2`."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import plane, scene, style
from lietool.render.solids import grid_faces

from . import _letters
from . import _motions as m
from ._dual_motions import Motions

# Of a picture without legend.
_BOX = (110.0, 118.0, 980.0, 650.0)


def rotation(theta: float, place: np.ndarray, t: float, by: Motions) -> Drawing:
    """R_theta about the origin."""
    radius = float(np.linalg.norm(place))
    size = 0.62 * radius or 1.0
    first = by.shift(place)
    turns = by.turn(theta * np.array([1.0 / 3.0, 2.0 / 3.0, 1.0, t]))
    start = by.matrix(first)
    *middles, end, now = by.matrix(by.product(turns, first))
    circle = plane.arc(m.ORIGIN, radius, 0.0, 2.0 * np.pi, 121)
    spokes = [np.stack([m.ORIGIN, T[:2, 2]]) for T in (start, end)]
    letter = _letters.tracked(size, [start, *middles, end], [circle, *spokes])
    # The corner that is furthest from the origin stands for every other point.
    far = max(letter.outline(start), key=lambda p: round(float(np.linalg.norm(p)), 9))
    reach = float(np.linalg.norm(far))
    arcs = [m.about(m.ORIGIN, place, theta, 0.38 * radius), m.about(m.ORIGIN, far, theta, 0.68 * radius)]
    orbit = plane.arc(m.ORIGIN, reach, 0.0, 2.0 * np.pi, 121)
    page = m.fit([orbit, *arcs], size, _BOX)
    far_after = by.act(turns[2], far)
    records: list[scene.Record] = [
        *_rings(page, radius, reach),
        *_axes(page, np.concatenate([orbit, *arcs])),
        *(m.spoke(page, m.ORIGIN, p) for p in (far, far_after)),
        *(record for T in middles for record in letter.draw(page, T, _letters.GHOST)),
        *letter.draw(page, start, _letters.START),
        *letter.draw(page, end, _letters.OUTLINE if t < 1.0 else _letters.END),
    ]
    if t < 1.0:
        records += letter.draw(page, now, _letters.END)
    records += [page.line(spoke, style.INK) for spoke in spokes]
    for arc in arcs:
        records += m.angle(page, arc, m.ORIGIN)
    records.append(page.dots([far, far_after], style.BEFORE_EDGE, m.DOT))
    records += [*_feet(page, place, end[:2, 2], radius), *_said(theta, place, end[:2, 2])]
    numbers = {
        "theta": theta,
        "R": end[:2, :2],
        "x": place,
        "x'": end[:2, 2],
        "radius": radius,
        "other": np.stack([far, far_after]),
        "before": letter.outline(start),
        "after": letter.outline(end),
        "now": now,
    }
    return Drawing(m.picture(records), numbers)


def _said(theta: float, x: np.ndarray, x_after: np.ndarray) -> list[scene.Record]:
    before, after = m.vectors(x, x_after)
    return [
        m.title(r"a turn about the origin: $\mathbf{x}' = R_\theta\, \mathbf{x}$"),
        m.note(rf"$\theta = {m.degrees(theta)},\;\; \mathbf{{x}} = {before},\;\; \mathbf{{x}}' = {after}$"),
    ]


def _rings(page: plane.Plane, radius: float, reach: float) -> list[scene.Record]:
    """The orbits of the marked point and of the furthest one, and the island between them."""
    around = plane.direction(np.linspace(0.0, 2.0 * np.pi, 181))
    vertices = page.at(np.concatenate([reach * around, radius * around]))
    return [
        scene.Surface(vertices, grid_faces(2, 181), style.AFTER, material="flat", alpha=0.16),
        page.circle(m.ORIGIN, reach, style.BEFORE_EDGE),
        page.circle(m.ORIGIN, radius, style.MUTED, style.EDGE),
    ]


def _axes(page: plane.Plane, drawn: np.ndarray) -> list[scene.Record]:
    """The coordinate axes, a little further than all that is drawn."""
    margin = 26.0 / page.scale
    x, y = zip(drawn.min(axis=0) - margin, drawn.max(axis=0) + margin, strict=True)
    return page.axes((min(x[0], 0.0), max(x[1], 0.0)), (min(y[0], 0.0), max(y[1], 0.0)))


def _feet(page: plane.Plane, x: np.ndarray, x_after: np.ndarray, radius: float) -> list[scene.Record]:
    records: list[scene.Record] = [page.dots([m.ORIGIN, x, x_after], style.INK, m.DOT)]
    if m.same(x, x_after, radius):
        return [*records, page.beyond(r"$\mathbf{x} = \mathbf{x}'$", x, -x, room=70.0)]
    for text, at in ((r"$\mathbf{x}$", x), (r"$\mathbf{x}'$", x_after)):
        records.append(page.beyond(text, at, -at, room=46.0))
    return records


def rigid(theta: float, b: np.ndarray, place: np.ndarray, t: float, by: Motions) -> Drawing:
    """T_b R_theta, and R_theta T_b = T_{R_theta b} R_theta."""
    start, R, T_b = by.shift(place), by.turn(theta), by.shift(b)
    stages = [start, by.product(R, start), by.product(T_b, start)]
    b_turned = by.act(R, b)
    stages += [by.product(T_b, stages[1]), by.product(by.of(theta, b_turned), start)]
    shapes = list(by.matrix(np.stack(stages)))

    one, two = _parts(t, 2)
    short = by.product(by.shift(two[:, None] * b), by.turn(one * theta), start)
    long = by.product(by.turn(two * theta), by.shift(one[:, None] * b), start)
    along = by.matrix(np.stack([short, long], axis=1))
    again = m.same(b, b_turned, float(np.abs(b).max()))
    shown = m.vectors(b, b_turned)
    given = rf"$\theta = {m.degrees(theta)},\;\; b = {shown[0]},\;\; b' = R_\theta\, b = {shown[1]}$"
    records = [
        *_both_orders(theta, b, b_turned, shapes, along, t, again),
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
        "now": along[-1],
    }
    return Drawing(m.picture(records), numbers)


def _both_orders(
    theta: float,
    b: np.ndarray,
    b_turned: np.ndarray,
    shapes: list[np.ndarray],
    along: np.ndarray,
    t: float,
    again: bool,
) -> list[scene.Record]:
    """The shape at its start, turned, shifted, and at the ends of both orders, and the ways between."""
    feet = [T[:2, 2] for T in shapes]
    extent = m.extent([m.ORIGIN, *feet])
    size = max(0.42 * min(float(np.linalg.norm(feet[0])), extent), 0.17 * extent) or 1.0
    legs = [m.about(m.ORIGIN, feet[0], theta), m.straight(feet[1], b)]
    others = [m.straight(feet[0], b), m.about(m.ORIGIN, feet[2], theta), m.straight(feet[1], b_turned)]
    angle = m.about(feet[1], feet[1] + b, theta, 0.42 * float(np.linalg.norm(b)))
    around = m.about(m.ORIGIN, feet[0], theta, 0.38 * float(np.linalg.norm(feet[0])))
    letter = _letters.tracked(size, shapes, [*legs, *others, angle])
    page = m.fit([m.ORIGIN, angle, *legs, *others, *_swept(letter, along)], size)
    records: list[scene.Record] = [
        *m.fan(page, m.ORIGIN, others[1], style.ROUTE_2, 0.09),
        *m.fan(page, m.ORIGIN, legs[0], style.ROUTE_1, 0.12),
        *(m.spoke(page, m.ORIGIN, feet[k]) for k in (0, 1, 2, 4)),
        *m.angle(page, around, m.ORIGIN),
        *m.angle(page, angle, feet[1]),
        *letter.draw(page, m.turn(0.5 * theta) @ shapes[2], _letters.OTHER_GHOST),
        *letter.draw(page, shapes[2], _letters.OTHER_STAGE),
        *letter.stages(page, shapes[:2]),
        *letter.draw(page, shapes[4], _letters.OTHER_END if t == 1.0 else _letters.OTHER_STAGE),
        *letter.draw(page, shapes[3], _letters.END if t == 1.0 else _letters.OUTLINE),
    ]
    if t < 1.0:
        records += letter.draw(page, along[-1, 1], _letters.OTHER_END)
        records += letter.draw(page, along[-1, 0], _letters.Look(style.AFTER, m.FIRST.text))
    # Where both orders are one, so are the shifts, and one name is enough.
    names = (
        ("", r"2\!:\; R_\theta", "") if again else (r"1\!:\; T_b", r"2\!:\; R_\theta", r"b' = R_\theta\, b")
    )
    apart = b - b_turned
    records += m.leg(page, legs[0], m.FIRST, r"1\!:\; R_\theta", part=0.3)
    name = r"b = R_\theta\, b" if again else r"2\!:\; T_b"
    records += m.leg(page, legs[1], m.FIRST, name, None if again else apart)
    for curve, name, away in zip(others, names, (None, None, -apart), strict=True):
        records += m.leg(page, curve, m.SECOND, name, away, part=0.3 if curve is others[1] else 0.5)
    records.append(page.dots(np.stack([m.ORIGIN, *feet]), style.INK, m.DOT))
    return [*records, m.center(page, "$O$", m.ORIGIN, -np.mean(feet, axis=0))]


def about(theta: float, b: np.ndarray, place: np.ndarray, t: float, by: Motions) -> Drawing:
    """T_b R_theta T_-b, the turn about b."""
    steps = [by.shift(-b), by.turn(theta), by.shift(b)]
    stages = [by.shift(place)]
    for step in steps:
        stages.append(by.product(step, stages[-1]))
    shapes = list(by.matrix(np.stack(stages)))
    one, two, three = _parts(t, 3)
    back, there = by.shift(three[:, None] * b), by.shift(-one[:, None] * b)
    long = by.product(back, by.turn(two * theta), there, stages[0])
    short = by.product(steps[2], by.turn(_moments(t) * theta), steps[0], stages[0])
    along = by.matrix(np.stack([long, short], axis=1))
    records = [
        *_three_steps(theta, b, shapes, along, t),
        m.title(r"shift, turn, shift back: a turn about $b$"),
        *m.legend([(m.FIRST, r"$T_b\, R_\theta\, T_{-b}$"), (m.SECOND, r"turn by $\theta$ about $b$")]),
        m.note(rf"$\theta = {m.degrees(theta)},\;\; b = {m.vectors(b)[0]}$"),
    ]
    numbers = {
        "theta": theta,
        "b": b,
        "stages": np.stack(shapes),
        "product": by.matrix(by.product(*steps[::-1])),
        "now": along[-1],
    }
    return Drawing(m.picture(records), numbers)


def _moments(t: float) -> np.ndarray:
    """Times all along the way, for a page that holds it, and last the one that is shown."""
    return np.append(np.linspace(0.0, 1.0, 61), t)


def _parts(t: float, steps: int) -> np.ndarray:
    """How much (steps, n) of each step is done at `_moments`."""
    return np.array([m.parts(float(moment), steps) for moment in _moments(t)]).T


def _swept(letter: _letters.Letter, along: np.ndarray) -> list[np.ndarray]:
    """The corners of the letter all along the ways (n, 2, 3, 3)."""
    return [letter.outline(T) for T in along.reshape(-1, 3, 3)]


def _three_steps(
    theta: float, b: np.ndarray, shapes: list[np.ndarray], along: np.ndarray, t: float
) -> list[scene.Record]:
    feet = [T[:2, 2] for T in shapes]
    size = 0.24 * m.extent([m.ORIGIN, b, *feet]) or 1.0
    legs = [m.straight(feet[0], -b), m.about(m.ORIGIN, feet[1], theta), m.straight(feet[2], b)]
    direct = m.about(b, feet[0], theta)
    radius = 0.3 * float(np.linalg.norm(feet[1]))
    angles = [m.about(c, foot, theta, radius) for c, foot in ((m.ORIGIN, feet[1]), (b, feet[0]))]
    letter = _letters.tracked(size, shapes, [*legs, direct, m.straight(m.ORIGIN, b)])
    page = m.fit([m.ORIGIN, b, direct, *legs, *_swept(letter, along)], size)
    spokes = ((m.ORIGIN, feet[1]), (m.ORIGIN, feet[2]), (b, feet[0]), (b, feet[3]))
    records: list[scene.Record] = [
        m.area(page, [m.ORIGIN, b, feet[0], feet[1]], style.BEFORE, 0.45),
        *m.fan(page, m.ORIGIN, legs[1], style.ROUTE_1, 0.13),
        *m.fan(page, b, direct, style.ROUTE_2, 0.13),
        *(m.spoke(page, *spoke) for spoke in spokes),
        *m.angle(page, angles[0], m.ORIGIN),
        *(m.angle(page, angles[1], b) if b.any() else []),
        *letter.stages(page, shapes[:3]),
        *m.travellers(page, letter, list(along[-1]), shapes[3], t),
    ]
    for k, (curve, name) in enumerate(zip(legs, ("T_{-b}", r"R_\theta", "T_b"), strict=True)):
        # The first beyond the sector about b.
        records += m.leg(page, curve, m.FIRST, rf"{k + 1}\!:\; {name}", part=0.5 if k else 0.72)
    records += m.leg(page, direct, m.SECOND)
    middle = np.mean(feet, axis=0)
    if b.any():
        records += m.given(page, m.straight(m.ORIGIN, b), "")
    for text, point in (("$O$", m.ORIGIN), ("$b$", b)) if b.any() else (("$O = b$", m.ORIGIN),):
        records.append(m.center(page, text, point, point - middle))
    return [*records, page.dots(np.stack([m.ORIGIN, b, *feet]), style.INK, m.DOT)]
