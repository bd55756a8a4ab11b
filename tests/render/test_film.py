"""Labels of a film: at rest where they can be, and gliding where they cannot."""

import numpy as np
import pytest

from lietool.render import film, labels, scene, style
from lietool.render.compose import wanted


def frame(angle: float, room: float = 90.0) -> scene.Picture:
    """A spoke that turns about a point, with a name that would like to be above it."""
    tip = 600.0 + 300.0 * np.cos(angle), 450.0 + 300.0 * np.sin(angle), 0.0
    line = scene.Lines([(1200.0 - tip[0], 900.0 - tip[1], 0.0), tip], style.INK, style.CURVE)
    name = scene.Label("$b$", (600.0, 450.0, 0.0), style.INK, offset=(0.0, 30.0), room=room)
    return scene.Picture((scene.View((line, name)),))


def middles(pictures):
    found = [wanted(picture, 1.0, labels.Store())[0] for picture in pictures]
    assert all(label.room == 0.0 for label, _, _ in found)
    return np.array([(box[:2] + box[2:]) / 2.0 for _, _, box in found])


@pytest.mark.parametrize("closed", [True, False])
def test_no_label_leaps(closed):
    count = 48
    turn = np.linspace(0.0, np.pi, count, endpoint=not closed)
    frames = film.settled([frame(angle) for angle in turn], labels.Store(), closed=closed)
    at = middles(frames)
    steps = np.linalg.norm(np.diff(at, axis=0), axis=-1)
    assert steps.max() < 20.0
    if closed:
        assert np.linalg.norm(at[0] - at[-1]) < 20.0
    # It did have to move.
    assert np.ptp(at, axis=0).max() > 20.0


def test_a_label_that_need_not_move_rests():
    frames = film.settled(
        [frame(angle) for angle in np.linspace(-0.2, 0.2, 20)], labels.Store(), closed=False
    )
    assert np.ptp(middles(frames), axis=0).max() < 1e-9


def test_a_label_without_room_stays_where_it_was_put():
    frames = [frame(angle, room=0.0) for angle in np.linspace(0.0, 3.0, 12)]
    after = film.settled(frames, labels.Store(), closed=True)
    assert np.array_equal(middles(after), middles(frames))


def test_texts_that_come_and_go():
    def numbered(k):
        name = scene.Label(f"${k % 3}$", (600.0, 450.0, 0.0), style.INK, offset=(0.0, 30.0), room=60.0)
        return scene.Picture((scene.View((name, name)),))

    frames = film.settled([numbered(k) for k in range(9)], labels.Store(), closed=True)
    for picture in frames:
        first, second = (box for _, _, box in wanted(picture, 1.0, labels.Store()))
        assert (first[:2] >= second[2:]).any() or (second[:2] >= first[2:]).any()


def test_one_frame():
    assert len(film.settled([frame(0.3)], labels.Store(), closed=False)) == 1
