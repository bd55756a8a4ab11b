"""Plates in several processes at once: each has a renderer of its own, so that the pixels are the same."""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from lietool.verbs import _studio, _table

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

T = TypeVar("T")

# How many seconds a process has for cleaning up before it is killed.
_PATIENCE = 3.0
# Held by a process while it does a piece of work.
_work = threading.Lock()


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
        With 2 and the name of the plate if its figure refuses or cannot read something, with 1 if a
        process dies.
    """
    work = partial(_named, work)
    jobs = min(jobs, len(items))
    if jobs < 2:
        for item in _table.progress(items, doing):
            yield work(item)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool

    others = set(multiprocessing.active_children())
    # A process that was forked from one with a renderer hangs in it.
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), _begin, (threads(jobs),))
    try:
        with _deaf():
            promised = [pool.submit(partial(_interruptible, work), item) for item in items]
        for promise in _table.progress(promised, doing):
            yield promise.result()
    except BrokenProcessPool:
        raise _studio.Stop(
            1, f"one of {jobs} processes died, perhaps for want of memory. Try again with fewer --jobs"
        ) from None
    except BaseException:
        # Nobody waits for what the others are at, which may take for ever.
        _end([child for child in multiprocessing.active_children() if child not in others])
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _named(work: Callable[[_studio.Item], T], item: _studio.Item) -> T:
    """Do some work, and say of which plate it is what goes wrong."""
    try:
        return work(item)
    except OSError as error:
        file = f": {error.filename}" if error.filename else ""
        raise _studio.Stop(2, f"{item.id}: {error.strerror or error}{file}") from error
    except ValueError as error:
        raise _studio.Stop(2, f"{item.id}: {' '.join(str(error).split())}") from error
    except Exception as error:
        # From another process it comes with a traceback that begins where it was received.
        last = traceback.extract_tb(error.__traceback__)[-1]
        error.add_note(f"plate {item.id}, {Path(last.filename).name}, line {last.lineno}")
        raise


def threads(jobs: int) -> int:
    """Return how many threads each of several renderers should have, so that they share the processors."""
    here = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1
    return max(here // jobs, 1)


def _begin(count: int) -> None:
    # Read by Mesa when it is loaded, which it is not yet.
    os.environ.setdefault("LP_NUM_THREADS", str(count))
    signal.signal(signal.SIGTERM, _die)
    threading.Thread(target=_follow, daemon=True).start()


def _follow() -> None:
    """End this process when the one that started it is killed: nobody else would."""
    if parent := multiprocessing.parent_process():
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(_PATIENCE)
        os._exit(1)


class _Ended(BaseException):
    """The end of this process, on its way through what has still to remove half a file."""


def _die(*_: object) -> None:
    if _work.acquire(blocking=False):
        os._exit(1)
    raise _Ended


def _interruptible(work: Callable[[_studio.Item], T], item: _studio.Item) -> T:
    try:
        with _work:
            return work(item)
    except _Ended:
        os._exit(1)


@contextlib.contextmanager
def _deaf() -> Iterator[None]:
    """Let the processes that are started meanwhile be deaf to Ctrl-C: this one hears it, and ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _end(processes: Sequence["BaseProcess"]) -> None:
    """End processes, whatever they do."""
    for process in processes:
        process.terminate()
    deadline = time.monotonic() + _PATIENCE
    for process in processes:
        process.join(max(deadline - time.monotonic(), 0.0))
        process.kill()
