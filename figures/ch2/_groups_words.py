"""Words beside the arrows of a diagram of groups, each where it has room, and the legend."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from lietool.render import scene, style

from . import _groups_marks as marks

# From an arrow to the box of its label.
_BESIDE = 7.0
_OPEN = "not compact"
Mark = tuple[Callable[[float, float], Sequence[scene.Record]], float, str]
"""What a legend shows from (x, y) to the right, how wide it is, and what it means."""


def place_labels(
    links: Sequence[marks.Link], cards: Sequence[marks.Card], page: tuple[float, float] = marks.PAGE
) -> list[scene.Record]:
    """Return the arrows' labels, each beside its own arrow where it meets no card, arrow or other label."""
    taken = [np.array(c.box) for c in cards]
    inked = [_ink(link) for link in links]
    records: list[scene.Record] = []
    # The longest first: they have the least choice.
    for link in sorted((link for link in links if link.label), key=lambda link: -marks.extent(link.label)[0]):
        half = np.array(marks.extent(link.label)) / 2.0
        others = np.concatenate(
            [np.zeros((0, 2)), *(ink for other, ink in zip(links, inked, strict=True) if other is not link)]
        )
        own = inked[list(links).index(link)]
        places = [
            (p, liked + _trouble(p, half, taken, own, others)) for p, liked in _places(link, half, page)
        ]
        center = min(places, key=lambda place: place[1])[0]
        taken.append(np.concatenate([center - half, center + half]))
        color = style.GROUP_TEXT if link.map.kind == "covering" else style.INK
        records.append(marks.label(link.label, float(center[0]), float(center[1]), "cc", color))
    return records


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
        for t in np.linspace(0.14, 0.86, 37):
            for side in (1.0, -1.0):
                off = _BESIDE + float(np.abs(across) @ half)
                center = a + t * (b - a) + side * off * across
                outside = np.maximum(marks.MARGIN + half - center, 0.0) + np.maximum(
                    center + half + marks.MARGIN - page, 0.0
                )
                yield center, 60.0 * abs(t - 0.5) + 12.0 * (side < 0.0) + 1e3 * float(outside.sum())


def _trouble(
    center: np.ndarray, half: np.ndarray, taken: Sequence[np.ndarray], own: np.ndarray, others: np.ndarray
) -> float:
    low, high = center - half, center + half
    boxes = np.asarray(taken)
    overlap = np.minimum(high + 12.0, boxes[:, 2:]) - np.maximum(low - 12.0, boxes[:, :2])
    met = np.all(overlap > 0.0, axis=1)
    trouble = float(np.sum(200.0 + overlap[met].prod(axis=1)))
    for ink, near, cost in ((own, _BESIDE - 4.0, 500.0), (others, 4.0, 500.0), (others, 24.0, 2.0)):
        trouble += cost * float(((ink > low - near) & (ink < high + near)).all(axis=1).sum())
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
    widths = [wide + near + marks.extent(text)[0] for _, wide, text in shown]
    if sum(widths) + apart * len(widths) > page[0] - marks.MARGIN:
        # What is not marked as compact is not.
        kept = [i for i, mark in enumerate(shown) if mark[2] != _OPEN]
        shown, widths = [shown[i] for i in kept], [widths[i] for i in kept]
    x = (page[0] - sum(widths) - apart * (len(shown) - 1)) / 2.0
    records: list[scene.Record] = []
    for (draw, wide, text), width in zip(shown, widths, strict=True):
        records += [*draw(x, y), marks.label(text, x + wide + near, y - 10.0, "ln")]
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
        (any(not c.group for c in cards), (False, 1, False), "no group"),
    ):
        if occurs:
            more = marks.SHEET * (look[1] - 1)

            def draw(x: float, y: float, look: tuple = look, more: float = more) -> list[scene.Record]:
                return marks.Card(("", 0), (x + wide / 2.0, y - more / 2.0), (wide, high), *look).records()

            yield draw, wide + more, text
