"""`commute` for two translations and for two rotations of the plane: both ways end at the same place."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import plane, scene, style

from . import _letters
from . import _motions as m

# A parallelogram flatter than this, in page units, has its two ways drawn side by side.
_FLAT = 36.0
_NAMES = ("X", "T_b X", "T_{b'} X", "T_{b+b'} X")


def translations(b: np.ndarray, b2: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """T_b' T_b and T_b T_b' with the parallelogram between them."""
    scale = max(float(np.abs(v).max()) for v in (b, b2, b + b2))
    size = 0.31 * max(float(np.linalg.norm(b)), float(np.linalg.norm(b2))) or 1.0
    start = m.shift(place)
    stops = [start, m.shift(b) @ start, m.shift(b2) @ start]
    ends = np.stack([m.shift(b2) @ m.shift(b) @ start, m.shift(b) @ m.shift(b2) @ start])
    shapes = [*stops, ends[0]]
    sides = [
        m.straight(place + u, v)
        for u, v in ((0.0 * b, b), (b, b2), (0.0 * b, b2), (b2, b), (0.0 * b, b + b2))
    ]
    letter = _letters.tracked(size, shapes, sides)
    page = m.fit([letter.outline(T) for T in (*stops, *ends)], size)
    one, two = m.parts(t, 2)
    now = [m.shift(one * u + two * v) @ start for u, v in ((b, b2), (b2, b))]
    corners = place + np.array([0.0 * b, b, b + b2, b2])
    records: list[scene.Record] = [
        m.area(page, corners[:3], style.ROUTE_1, 0.13),
        m.area(page, corners[[0, 2, 3]], style.ROUTE_2, 0.13),
        *letter.stages(page, stops),
        *m.travellers(page, letter, now, ends[0], t),
    ]
    records += _sides(page, b, b2, place, letter)
    records += m.tags(page, letter, shapes, _NAMES, " = ")
    records += [
        _ends(ends, scale),
        *m.legend([(m.FIRST, "first $b$, then $b'$"), (m.SECOND, "first $b'$, then $b$")]),
        m.note("$T_{b'}\\, T_b = T_b\\, T_{b'} = T_{b+b'}$"),
    ]
    numbers = {
        "b": b,
        "b'": b2,
        "parallelogram": corners,
        "ends": ends,
        "distance_of_ends": float(np.linalg.norm(ends[0] - ends[1])),
        "now": np.stack(now),
    }
    return Drawing(m.picture(records), numbers)


def _sides(
    page: plane.Plane, b: np.ndarray, b2: np.ndarray, place: np.ndarray, letter: _letters.Letter
) -> list[scene.Record]:
    """The four sides as arrows; where two of them would lie on each other, they are moved apart."""
    sides = ((0.0 * b, b, m.FIRST, "1", "b"), (b, b2, m.FIRST, "2", "b'"))
    sides = (*sides, (0.0 * b, b2, m.SECOND, "1", "b'"), (b2, b, m.SECOND, "2", "b"))
    cross = float(b[0] * b2[1] - b[1] * b2[0])
    longest = max((b, b2), key=lambda v: float(v @ v))
    length = float(np.linalg.norm(longest))
    normal = np.array([-longest[1], longest[0]]) / length if length else np.array([0.0, 1.0])
    flat = abs(cross) * page.scale <= _FLAT * length
    records: list[scene.Record] = []
    for k, (start, along, way, step, name) in enumerate(sides):
        side = m.straight(place + start, along)
        away = side.mean(axis=0) - place - (b + b2) / 2.0
        if flat:
            # Steps that go opposite ways lie beside each other by their order, others by their way.
            lane = (1.0, -1.0, -1.0, 1.0)[k] if b @ b2 < 0.0 else (-1.0, -1.0, 1.0, 1.0)[k]
            side = side + lane * 9.0 / page.scale * normal
            away = lane * normal
        records += m.leg(page, side, way, rf"{step}\!:\; {name}", away)
        if not along.any():
            records.append(m.named(page, side, f"${name} = 0$", way.text, away))
    if not flat:
        # Its name on the side away from the letter that is nearest to its middle.
        middle = place + (b + b2) / 2.0
        heavy = [letter.outline(m.shift(place + v)).mean(axis=0) - middle for v in (b, b2)]
        across = np.array([-(b + b2)[1], (b + b2)[0]])
        side = -np.sign(min(heavy, key=lambda v: float(v @ v)) @ across) or 1.0
        records += m.given(page, m.straight(place, b + b2), "b + b'", side * across)
    corners = place + np.array([0.0 * b, b, b2, b + b2])
    return [*records, page.dots(corners, style.INK, m.DOT)]


def rotations(first: float, second: float, place: np.ndarray, t: float) -> Drawing:
    """R_theta' R_theta and R_theta R_theta' of a shape about the origin."""
    angles, reverse = (first, second), (second, first)
    radius = float(np.linalg.norm(place))
    size = 0.48 * radius or 1.0
    start = m.shift(place)
    stops = [start, m.turn(first) @ start, m.turn(second) @ start]
    ends = np.stack([m.turn(b) @ m.turn(a) @ start for a, b in (angles, reverse)])

    def at(t: float) -> list[np.ndarray]:
        one, two = m.parts(t, 2)
        return [m.turn(one * a + two * b) @ start for a, b in (angles, reverse)]

    lanes = [_lanes(place, pair, lane) for pair, lane in ((angles, 0.80), (reverse, 0.48))]
    circle = plane.arc(m.ORIGIN, radius, 0.0, 2.0 * np.pi)
    # Inside the circle are the arcs.
    letter = _letters.tracked(size, [*stops, ends[0]], [circle, *lanes[0], *lanes[1]])
    page = m.fit([circle, *m.swept(letter, at), *lanes[0], *lanes[1]], size)
    feet = [T[:2, 2] for T in (*stops, ends[0])]
    records: list[scene.Record] = [page.circle(m.ORIGIN, radius, style.BEFORE_EDGE, alpha=0.8)]
    for arcs, way in zip(lanes, (m.FIRST, m.SECOND), strict=True):
        for arc in arcs:
            records += m.fan(page, m.ORIGIN, arc, way.color, 0.10)
    records += [m.spoke(page, m.ORIGIN, foot) for foot in feet]
    records += [*letter.stages(page, stops), *m.travellers(page, letter, at(t), ends[0], t)]
    records += _arcs(page, lanes)
    records.append(page.dots(np.stack([m.ORIGIN, *feet]), style.INK, m.DOT))
    given = rf"$\theta = {m.degrees(first)},\;\; \theta' = {m.degrees(second)}$"
    records += [
        _ends(ends, radius),
        *m.legend(
            [(m.FIRST, r"first $\theta$, then $\theta'$"), (m.SECOND, r"first $\theta'$, then $\theta$")]
        ),
        m.note(given + r"$,\;\; R_{\theta'} R_\theta = R_\theta R_{\theta'} = R_{\theta+\theta'}$"),
    ]
    numbers = {
        "angles": np.array(angles),
        "stops": np.stack(stops),
        "ends": ends,
        "distance_of_ends": float(np.linalg.norm(ends[0] - ends[1])),
        "now": np.stack(at(t)),
    }
    return Drawing(m.picture(records), numbers)


def _ends(ends: np.ndarray, scale: float) -> scene.Label:
    return m.title(
        "two ways, the same end" if m.same(ends[0], ends[1], scale) else "two ways, different ends"
    )


def _lanes(place: np.ndarray, angles: tuple[float, float], lane: float) -> list[np.ndarray]:
    """The arcs of two turns, the second a little further out, so that it is seen where it goes back."""
    radius = float(np.linalg.norm(place))
    middle = m.turn(angles[0])[:2, :2] @ place
    return [
        m.about(m.ORIGIN, place, angles[0], lane * radius),
        m.about(m.ORIGIN, middle, angles[1], (lane + 0.06) * radius),
    ]


def _arcs(page: plane.Plane, lanes: list[list[np.ndarray]]) -> list[scene.Record]:
    """The arcs of both ways with their names, those of the outer way outside, of the inner inside."""
    records: list[scene.Record] = []
    for way, arcs, names, side in zip(
        (m.FIRST, m.SECOND), lanes, (("", "'"), ("'", "")), (1.0, -1.0), strict=True
    ):
        for step, (arc, name) in enumerate(zip(arcs, names, strict=True), 1):
            records += m.leg(page, arc, way, rf"{step}\!:\; \theta{name}", side * arc[len(arc) // 2])
    return records
