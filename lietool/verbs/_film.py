"""Films of a figure: which moments of its time are drawn, and from their pictures to a file."""

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import click

from lietool.figure import Figure, Time

if TYPE_CHECKING:
    import numpy as np

    from lietool.render.scene import Picture

ENDINGS = (".gif", ".apng", ".mp4")
FASTEST, LONGEST = 60.0, 600.0
# So many pictures a second look smooth; a GIF has as many as its figure says, for they make it large.
_SMOOTH = 30.0
_MOST = 3600


@dataclass(frozen=True)
class Pace:
    """How many seconds a film takes and how many pictures it has in each; None leaves it to the figure."""

    seconds: float | None = None
    fps: float | None = None


ITS_OWN = Pace()


def time(figure: Figure, values: Mapping[str, object], ending: str, swept: set[str]) -> Time:
    """Return a figure's time, unless a film of these parameters would show nothing that moves.

    Raises
    ------
    click.UsageError
        If it has none, its parameter is idle, or is among those `swept` that were given.
    """
    if figure.time is None:
        raise click.UsageError(f"{figure.name} has no time to animate. Write a .png")
    for idle in figure.idle(values, [figure.time.param]):
        raise click.UsageError(
            f"a {ending} sweeps {idle.option}, which has a part in the picture only {idle.where}. "
            "Write a .png"
        )
    if figure.time.param in swept:
        option = "--" + figure.time.param.replace("_", "-")
        raise click.UsageError(
            f"a {ending} sweeps {option}, so it cannot be given too. Leave out {option}, or write a .png"
        )
    if ending == ".mp4":
        from lietool.render import video

        video.require()
    return figure.time


def paced(time: Time, ending: str, pace: Pace) -> Time:
    """Return a figure's time with as many frames, and as long, as a film is to have.

    Parameters
    ----------
    time : Time
    ending : str
        Of the file: ``.gif``, ``.apng`` or ``.mp4``.
    pace : Pace

    Raises
    ------
    ValueError
        If it has fewer than two frames or too many.
    """
    seconds = pace.seconds or time.seconds
    fps = pace.fps or rate(time, ending)
    frames = round(fps * seconds)
    # Only an even number has a frame at the far end, where the sweep turns back.
    frames += frames % 2 if not time.closed else 0
    if not 2 <= frames <= _MOST:
        raise ValueError(
            f"a film must have 2 to {_MOST} pictures; got {frames}, {fps:g} a second in {seconds:g} seconds. "
            "Change --seconds or --fps"
        )
    return replace(time, seconds=seconds, frames=frames)


def followed(time: Time, moments: tuple[float, ...], fps: float, pace: Pace) -> Time:
    """Return the time of a film that goes once through moments, so many a second.

    Where both its length and its rate are asked for, it has as many moments as they say, at even distances.

    Parameters
    ----------
    time : Time
    moments : tuple of float
    fps : float
    pace : Pace

    Raises
    ------
    ValueError
        If it has fewer than two frames or too many.
    """
    if pace.seconds and pace.fps:
        count = max(round(pace.seconds * pace.fps), 2)
        moments = tuple(time.start + (time.stop - time.start) * k / (count - 1) for k in range(count))
    seconds = pace.seconds or len(moments) / (pace.fps or fps)
    if not 2 <= len(moments) <= _MOST:
        remedy = "Add another, or write a .png" if len(moments) < 2 else "Change --seconds and --fps"
        raise ValueError(
            f"a film must have 2 to {_MOST} pictures; got a sequence of {len(moments)}. {remedy}"
        )
    return replace(time, moments=moments, frames=len(moments), seconds=seconds)


def rate(time: Time, ending: str) -> float:
    """Return how many pictures a second a film has that nobody asked for more or fewer of."""
    own = time.frames / time.seconds
    return max(own, _SMOOTH) if ending in (".apng", ".mp4") else own


def sweep(time: Time) -> list[float]:
    """Return the values of a figure's time, frame by frame, so that the last leads on to the first.

    A closed one goes round at constant speed. Another goes forth and back, slows down at both ends,
    and takes the same values on both ways.

    Parameters
    ----------
    time : Time

    Returns
    -------
    list of float
        One for each frame.
    """
    if time.moments:
        return list(time.moments)
    count = time.frames
    if time.closed:
        parts = [k / count for k in range(count)]
    else:
        parts = [(1.0 - math.cos(2.0 * math.pi * min(k, count - k) / count)) / 2.0 for k in range(count)]
    return [time.start + (time.stop - time.start) * part for part in parts]


def encode(
    time: Time,
    ending: str,
    draw: Callable[[list[float]], Sequence["Picture"]],
    settle: Callable[[Sequence["Picture"]], list["Picture"]],
    render: Callable[["Picture"], "np.ndarray"],
    title: str,
    said: Mapping[str, str],
) -> bytes:
    """Draw every frame of a film, each moment once, and return the bytes of its file.

    Parameters
    ----------
    time : Time
        With as many frames as there are to be.
    ending : str
    draw : callable
        From all moments to their pictures.
    settle : callable
        From the pictures of all moments to those with their labels at rest.
    render : callable
        From a picture to its pixels.
    title : str
        Before the progress bar.
    said : mapping of str to str
        What the file says of itself.
    """
    from lietool.render import export, video

    places = sweep(time)
    moments = list(dict.fromkeys(places))
    drawn = dict(zip(moments, settle(draw(moments)), strict=True))
    shown = [drawn[place] for place in places]
    distinct = {id(picture): picture for picture in shown}
    images: dict[int, np.ndarray] = {}
    # Only somebody who watches wants to see progress.
    bar = click.progressbar(length=len(distinct), label=title, file=sys.stderr)
    with bar if sys.stderr.isatty() else nullcontext() as progress:
        for key, picture in distinct.items():
            images[key] = render(picture)
            if progress:
                progress.update(1)
    frames = [images[id(picture)] for picture in shown]
    if ending == ".gif":
        return export.gif(frames, time.seconds)
    if ending == ".apng":
        return export.apng(frames, time.seconds, said)
    rest = "; ".join(f"{key} {text}" for key, text in said.items() if key != "Title")
    return video.mp4(frames, time.seconds, {"title": said.get("Title", title), "comment": rest})
