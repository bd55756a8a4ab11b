"""Plates in several processes at once: each has a renderer of its own, so that the pixels are the same."""

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from lietool.verbs import _studio, _table

T = TypeVar("T")


def each(
    work: Callable[[_studio.Item], T], items: Sequence[_studio.Item], jobs: int, doing: str
) -> Iterator[T]:
    """Do some work for every plate, in this process or in several, and yield what comes of it in order.

    Parameters
    ----------
    work : callable
        From an item; with several processes it must be picklable, and so must be what it returns.
    items : sequence of Item
        The plates.
    jobs : int
        How many processes; 1 is this one.
    doing : str
        What stands before the progress bar.

    Raises
    ------
    Stop
        With 1 if a process dies.
    """
    jobs = min(jobs, len(items))
    if jobs < 2:
        for item in _table.progress(items, doing):
            yield work(item)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    # A process that was forked from one with a renderer hangs in it.
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), _begin, (threads(jobs),))
    try:
        with pool:
            promised = [pool.submit(work, item) for item in items]
            try:
                for promise in _table.progress(promised, doing):
                    yield promise.result()
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    except BrokenProcessPool:
        raise _studio.Stop(
            1, f"one of {jobs} processes died, perhaps for want of memory. Try again with fewer --jobs"
        ) from None


def threads(jobs: int) -> int:
    """Return how many threads each of several renderers should have, so that they share the processors."""
    here = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1
    return max(here // jobs, 1)


def _begin(count: int) -> None:
    # Read by Mesa when it is loaded, which it is not yet.
    os.environ.setdefault("LP_NUM_THREADS", str(count))
