"""Labels of a film: each keeps its place beside its point as long as it can, and glides to another."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lietool.render import compose, labels, placement
from lietool.render.scene import Label, Picture

# Over how many frames, as a part of the film, a label glides from a place to another.
_GLIDE = 0.08


def settled(frames: Sequence[Picture], store: labels.Store, *, closed: bool) -> list[Picture]:
    """Return the frames of a film with all labels fixed where they go.

    Parameters
    ----------
    frames : sequence of Picture
        The different moments in the order of time.
    store : Store
        Where the rasterised labels come from.
    closed : bool
        The last leads on to the first; else the film runs back from there.

    Returns
    -------
    list of Picture
        Their labels have no room any more.
    """
    plans = [placement.Plan.of(compose.wanted(picture, 1.0, store), picture) for picture in frames]
    names = [_names([label.text for label, _, _ in plan.wanted]) for plan in plans]
    count = len(frames)
    moves: dict[tuple[str, int], np.ndarray] = {}
    # There and back, or twice round: what is decided first would not know how it goes on.
    way = [(k, (k - 1) % count) for k in range(count)]
    way += way if closed else [(k, min(k + 1, count - 1)) for k in reversed(range(count))]
    for k, last in way:
        before = [_known(moves.get(name), last) for name in names[k]]
        for name, move in zip(names[k], plans[k].places(before), strict=True):
            moves.setdefault(name, np.full((count, 2), np.nan))[k] = move
        for name in moves.keys() - set(names[k]):
            # What is not in this frame comes back where it was.
            moves[name][k] = moves[name][last]
    smooth = {name: _smoothed(move, closed) for name, move in moves.items()}
    return [_fixed(picture, [smooth[name][k] for name in names[k]]) for k, picture in enumerate(frames)]


def _known(moves: np.ndarray | None, frame: int) -> tuple[float, float] | None:
    if moves is None or np.isnan(moves[frame]).any():
        return None
    return float(moves[frame, 0]), float(moves[frame, 1])


def _names(texts: Sequence[str]) -> list[tuple[str, int]]:
    """The texts, each with how often it came before, by which a label is known from frame to frame."""
    return [(text, texts[:k].count(text)) for k, text in enumerate(texts)]


def _smoothed(moves: np.ndarray, closed: bool) -> np.ndarray:
    """Average moves (n, 2) over neighbouring frames, twice, so that they start and end softly."""
    moves = np.nan_to_num(moves)
    reach = min(max(round(_GLIDE * len(moves) / 2.0), 1), len(moves) - 1)
    for _ in range(2 if reach else 0):
        wide = np.pad(moves, ((reach, reach), (0, 0)), "wrap" if closed else "reflect")
        moves = np.mean([wide[k : k + len(moves)] for k in range(2 * reach + 1)], axis=0)
    return moves


def _fixed(picture: Picture, moves: Sequence[np.ndarray]) -> Picture:
    left = iter(moves)
    views = []
    for view in picture.views:
        records = []
        for record in view.records:
            if isinstance(record, Label):
                move = next(left)
                offset = (record.offset[0] + float(move[0]), record.offset[1] + float(move[1]))
                record = replace(record, offset=offset, room=0.0)
            records.append(record)
        views.append(replace(view, records=tuple(records)))
    return replace(picture, views=tuple(views))
