"""`commute` for two translations and for two rotations of the plane: both ways end at the same place."""

import numpy as np

from lietool.figure import Drawing
from lietool.render import plane, scene, style

from . import _motions as m

# A parallelogram flatter than this, in page units, has its two ways drawn side by side.
_FLAT = 36.0
# The four shapes, and about how wide their names are, in page units.
_NAMES = (("X", 30.0), ("T_b X", 70.0), ("T_{b'} X", 76.0), ("T_{b+b'} X", 116.0))


def translations(b: np.ndarray, b2: np.ndarray, place: np.ndarray, t: float) -> Drawing:
    """T_b' T_b and T_b T_b' with the parallelogram between them."""
    scale = max(float(np.abs(v).max()) for v in (b, b2, b + b2))
    size = 0.27 * max(float(np.linalg.norm(b)), float(np.linalg.norm(b2))) or 1.0
    start = m.shift(place)
    stops = [start, m.shift(b) @ start, m.shift(b2) @ start]
    ends = np.stack([m.shift(b2) @ m.shift(b) @ start, m.shift(b) @ m.shift(b2) @ start])
    page = m.fit([m.outline(T, size) for T in (*stops, *ends)], size)
    one, two = m.parts(t, 2)
    now = [m.shift(one * u + two * v) @ start for u, v in ((b, b2), (b2, b))]
    records = [*m.stages(page, stops, size), *m.travellers(page, now, ends[0], size, t)]
    records += _sides(page, b, b2, place)
    shapes = [*stops, ends[0]]
    towards = [T[:2, 2] - place - (b + b2) / 2.0 for T in shapes]
    records += m.tags(page, shapes, size, _NAMES, towards, " = ")
    records += [
        _ends(ends, scale),
        *m.legend([(m.FIRST, "first $b$, then $b'$"), (m.SECOND, "first $b'$, then $b$")]),
        m.note("$T_{b'}\\, T_b = T_b\\, T_{b'} = T_{b+b'}$"),
    ]
    numbers = {
        "b": b,
        "b'": b2,
        "parallelogram": place + np.array([0.0 * b, b, b + b2, b2]),
        "ends": ends,
        "distance_of_ends": float(np.linalg.norm(ends[0] - ends[1])),
        "now": np.stack(now),
    }
    return Drawing(m.picture(records), numbers)


def _sides(page: plane.Plane, b: np.ndarray, b2: np.ndarray, place: np.ndarray) -> list[scene.Record]:
    """The four sides as arrows; where two of them would lie on each other, they are moved apart."""
    sides = ((0.0 * b, b, m.FIRST, "b"), (b, b2, m.FIRST, "b'"), (0.0 * b, b2, m.SECOND, "b'"))
    sides = (*sides, (b2, b, m.SECOND, "b"))
    cross = float(b[0] * b2[1] - b[1] * b2[0])
    longest = max((b, b2), key=lambda v: float(v @ v))
    length = float(np.linalg.norm(longest))
    normal = np.array([-longest[1], longest[0]]) / length if length else np.array([0.0, 1.0])
    flat = abs(cross) * page.scale <= _FLAT * length
    records: list[scene.Record] = []
    for k, (start, along, way, name) in enumerate(sides):
        side = m.straight(place + start, along)
        away = side.mean(axis=0) - place - (b + b2) / 2.0
        if flat:
            # Steps that go opposite ways lie beside each other by their order, others by their way.
            lane = (1.0, -1.0, -1.0, 1.0)[k] if b @ b2 < 0.0 else (-1.0, -1.0, 1.0, 1.0)[k]
            side = side + lane * 9.0 / page.scale * normal
            away = lane * normal
        records += m.leg(page, side, way, name, away)
        if not along.any():
            records.append(m.named(page, side, f"${name} = 0$", way.text, away))
    if not flat:
        both = m.straight(place, b + b2)
        records[:0] = plane.path(page.at(both), style.MUTED, style.EDGE)
        records.append(m.named(page, both, "$b + b'$", style.MUTED))
    corners = place + np.array([0.0 * b, b, b2, b + b2])
    return [*records, page.dots(corners, style.INK, 6.5)]


def rotations(first: float, second: float, place: np.ndarray, t: float) -> Drawing:
    """R_theta' R_theta and R_theta R_theta' of a shape about the origin."""
    angles, reverse = (first, second), (second, first)
    radius = float(np.linalg.norm(place))
    size = 0.42 * radius or 1.0
    start = m.shift(place)
    stops = [start, m.turn(first) @ start, m.turn(second) @ start]
    ends = np.stack([m.turn(b) @ m.turn(a) @ start for a, b in (angles, reverse)])
    one, two = m.parts(t, 2)
    now = [m.turn(one * a + two * b) @ start for a, b in (angles, reverse)]
    lanes = [_lanes(place, pair, lane) for pair, lane in ((angles, 0.80), (reverse, 0.48))]
    circle = plane.arc(m.ORIGIN, radius, 0.0, 2.0 * np.pi)
    page = m.fit([circle, *(m.outline(T, size) for T in (*stops, *ends)), *lanes[0], *lanes[1]], size)
    feet = [T[:2, 2] for T in (*stops, ends[0])]
    records: list[scene.Record] = [page.circle(m.ORIGIN, radius, style.RULE)]
    records += [page.line(np.stack([m.ORIGIN, foot]), style.RULE) for foot in feet]
    records += [*m.stages(page, stops, size), *m.travellers(page, now, ends[0], size, t)]
    records += _arcs(page, lanes)
    records.append(page.dots(np.stack([m.ORIGIN, *feet]), style.INK, 6.5))
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
        "now": np.stack(now),
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
        for arc, name in zip(arcs, names, strict=True):
            records += m.leg(page, arc, way, rf"\theta{name}", side * arc[len(arc) // 2])
    return records
