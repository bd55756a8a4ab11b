"""Words beside the arrows of a diagram of groups, each where it has room, and the legend."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from lietool.render import scene, style

from . import _groups_marks as marks

# From an arrow to the box of its label.
_BESIDE = 7.0
_OPEN = "not compact"
# Between two marks of a legend, at the least.
_TIGHT = 24.0
_ROUNDS = 2
# Along an arrow, where its label may be.
_PARTS = np.linspace(0.14, 0.86, 37)
Mark = tuple[Callable[[float, float], Sequence[scene.Record]], float, str]
"""What a legend shows from (x, y) to the right, how wide it is, and what it means."""


def place_labels(
    links: Sequence[marks.Link], cards: Sequence[marks.Card], page: tuple[float, float] = marks.PAGE
) -> list[scene.Record]:
    """Return the arrows' labels, each beside its own arrow where it meets no card, arrow or other label."""
    named = [link for link in links if link.label]
    inked = {id(link): _ink(link) for link in links}
    boxes: dict[int, np.ndarray] = {}

    def costs(link: marks.Link) -> tuple[np.ndarray, np.ndarray]:
        half = np.array(marks.extent(link.label)) / 2.0
        lines = [ink for other, ink in inked.items() if other != id(link)]
        others = np.concatenate([np.zeros((0, 2)), *lines])
        taken = [np.array(c.box) for c in cards] + [box for of, box in boxes.items() if of != id(link)]
        centers, liked = (np.array(column) for column in zip(*_places(link, half, page), strict=True))
        places = np.hstack([centers - half, centers + half])
        return places, liked + _trouble(places, taken, inked[id(link)], others)

    families = _families(named)
    # Once more when each can see all others.
    for _ in range(_ROUNDS):
        for family in families:
            found = [costs(link) for link in family]
            liked = int(np.argmin(np.sum([cost for _, cost in found], axis=0)))
            for link, (places, cost) in zip(family, found, strict=True):
                if len(family) > 1:
                    cost = cost + _apart(liked, len(cost))
                boxes[id(link)] = places[int(np.argmin(cost))]
    records: list[scene.Record] = []
    for link in named:
        x, y = (boxes[id(link)][:2] + boxes[id(link)][2:]) / 2.0
        color = style.GROUP_TEXT if link.map.kind == "covering" else style.INK
        records.append(marks.label(link.label, float(x), float(y), "cc", color))
    return records


def _families(named: Sequence[marks.Link]) -> list[list[marks.Link]]:
    """Links whose labels are placed together; the least steep first, for theirs can hardly move."""
    blocks: dict[int, list[marks.Link]] = {}
    for link in named:
        blocks.setdefault(id(link) if link.family is None else link.family, []).append(link)

    def order(block: Sequence[marks.Link]) -> tuple[float, float]:
        x, y = np.abs(block[0].points[-1] - block[0].points[0])
        longest = max(marks.extent(link.label)[0] for link in block)
        return round(float(np.arctan2(y, x)), 3), -longest

    return sorted(blocks.values(), key=order)


def _apart(liked: int, count: int) -> np.ndarray:
    """What it costs to be elsewhere than the rest of the family, for the places of one straight arrow."""
    part, side = np.divmod(np.arange(count), 2)
    return 400.0 * np.abs(part - liked // 2) / len(_PARTS) + 90.0 * (side != liked % 2)


def _ink(link: marks.Link) -> np.ndarray:
    along = np.linspace(0.0, 1.0, 60)[:, None]
    return np.concatenate([a + along * (b - a) for a, b in link.segments])


def _places(
    link: marks.Link, half: np.ndarray, page: tuple[float, float]
) -> Iterable[tuple[np.ndarray, float]]:
    """Middles of a label's box beside an arrow, and how little each is liked."""
    for a, b in link.segments:
        along = (b - a) / np.linalg.norm(b - a)
        across = np.array([-along[1], along[0]])
        # Above a line rather than below it, and on the right of one that is upright.
        across = across if across @ (0.1, 1.0) > 0.0 else -across
        for t in _PARTS:
            for side in (1.0, -1.0):
                # Beside the line with its edge, or with the corner that is nearest to a slanting one.
                aside = half * np.clip(2.0 * across, -1.0, 1.0)
                clear = _BESIDE + float(np.abs(across) @ half - across @ aside)
                center = a + t * (b - a) + side * (aside + clear * across)
                outside = np.maximum(marks.MARGIN + half - center, 0.0) + np.maximum(
                    center + half + marks.MARGIN - page, 0.0
                )
                yield center, 60.0 * abs(t - 0.5) + 30.0 * (side < 0.0) + 1e3 * float(outside.sum())


def _trouble(
    places: np.ndarray, taken: Sequence[np.ndarray], own: np.ndarray, others: np.ndarray
) -> np.ndarray:
    """What each of the boxes (n, 4) meets: what is taken, its own line, other lines."""
    low, high = places[:, None, :2], places[:, None, 2:]
    left, lower, right, upper = places.T[:, :, None]
    boxes = np.asarray(taken)
    overlap = np.minimum(high + 12.0, boxes[:, 2:]) - np.maximum(low - 12.0, boxes[:, :2])
    met = np.all(overlap > 0.0, axis=-1)
    trouble = np.sum(met * (200.0 + overlap.prod(axis=-1)), axis=1)
    for ink, near, cost in ((own, _BESIDE - 4.0, 500.0), (others, 4.0, 500.0), (others, 24.0, 2.0)):
        x, y = ink.T
        beside = (x > left - near) & (x < right + near)
        trouble += cost * (beside & (y > lower - near) & (y < upper + near)).sum(axis=1)
    return trouble


def legend(
    links: Sequence[marks.Link],
    cards: Sequence[marks.Card],
    y: float = 44.0,
    page: tuple[float, float] = marks.PAGE,
    extra: Sequence[Mark] = (),
) -> list[scene.Record]:
    """Return one row that explains those marks that occur, and `extra` ones."""
    shown = [*_arrow_marks(links), *_card_marks(cards), *extra]
    near, apart = 12.0, 30.0
    widths = [wide + near * (wide > 0.0) + marks.extent(text)[0] for _, wide, text in shown]
    spare = page[0] - 2.0 * marks.MARGIN - sum(widths)
    if len(shown) > 1:
        apart = min(apart, max(spare / (len(shown) - 1), _TIGHT))
    if spare < apart * (len(widths) - 1):
        # What is not marked as compact is not.
        kept = [i for i, mark in enumerate(shown) if mark[2] != _OPEN]
        shown, widths = [shown[i] for i in kept], [widths[i] for i in kept]
    x = (page[0] - sum(widths) - apart * (len(shown) - 1)) / 2.0
    records: list[scene.Record] = []
    for (draw, wide, text), width in zip(shown, widths, strict=True):
        records += [*draw(x, y), marks.label(text, x + wide + near * (wide > 0.0), y - 10.0, "ln")]
        x += width + apart
    return records


def _arrow_marks(links: Sequence[marks.Link]) -> Iterable[Mark]:
    # A subset is drawn as an inclusion is.
    kinds = {link.map.kind == "covering": link.map for link in links}
    wide = 50.0
    for covering, text in ((False, "inclusion"), (True, "two to one, onto")):
        if covering in kinds:
            m = kinds[covering]
            yield lambda x, y, m=m: marks.arrow(marks.Link(m, np.array([[x, y], [x + wide, y]]))), wide, text


def _card_marks(cards: Sequence[marks.Card]) -> Iterable[Mark]:
    high, wide = 30.0, 40.0
    for occurs, look, text in (
        (any(c.compact for c in cards), (True, 1), "compact"),
        (any(not c.compact for c in cards), (False, 1), _OPEN),
        (any(c.sheets > 1 for c in cards), (False, 2), "two components"),
        (any(not c.group for c in cards), (False, 1, False), "not a group"),
    ):
        if occurs:
            more = marks.SHEET * (look[1] - 1)

            def draw(x: float, y: float, look: tuple = look, more: float = more) -> list[scene.Record]:
                return marks.Card(("", 0), (x + wide / 2.0, y + more / 2.0), (wide, high), *look).records()

            yield draw, wide + more, text
