"""Work in processes of its own: each begins with a fresh library, and may hang or die without harm."""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

# In bytes, of addresses: a mistake may ask for more memory than there is.
_MEMORY = 12 << 30
_PATIENCE = 2.0


@dataclass(frozen=True)
class Job:
    """One process's work: `work(*arguments)` yields pairs (what comes next, what came of the last).

    Parameters
    ----------
    key : str
        Whose it is.
    work : callable
        Of a module, since it is looked up by name in the other process.
    arguments : tuple
    steps : Mapping[str, float]
        What will be done, in this order, and how many seconds each may take.
    """

    key: str
    work: Callable[..., Iterator[Any]]
    arguments: tuple[Any, ...]
    steps: Mapping[str, float]


@dataclass(frozen=True)
class News:
    """What came of one step of a job: `value`, or how it failed ("hangs", "died", "raised" and a text)."""

    job: Job
    step: str
    value: Any = None
    failure: tuple[str, str] | None = None
    last: bool = False


@dataclass(eq=False)
class _Running:
    job: Job
    process: "BaseProcess"
    connection: Connection
    steps: list[str] = field(default_factory=list)
    deadline: float = 0.0

    def rest(self) -> None:
        """Begin the clock of the next step."""
        allowed = self.job.steps[self.steps[0]] if self.steps else _PATIENCE
        self.deadline = time.monotonic() + allowed


def run(
    jobs: Sequence[Job], at_once: int, until: float = float("inf"), preload: Sequence[str] = ()
) -> Iterator[News]:
    """Do jobs, some at once, and yield what comes of their steps as it comes.

    Parameters
    ----------
    jobs : sequence of Job
        Begun in this order.
    at_once : int
        How many processes there are at a time.
    until : float
        When, by `time.monotonic`, no further job is begun.
    preload : sequence of str
        Modules that are imported once, in the process that all others are forked from; nothing that is
        mutated, and always the same.

    Yields
    ------
    News
        Of every step; after one that fails there is none of the job's others.
    """
    waiting = list(reversed(jobs))
    running: list[_Running] = []
    try:
        while running or (waiting and time.monotonic() < until):
            while waiting and len(running) < at_once and time.monotonic() < until:
                running.append(_begin(waiting.pop(), at_once, preload))
            soonest = min(each.deadline for each in running)
            ready = wait([each.connection for each in running], max(soonest - time.monotonic(), 0.0))
            for each in list(running):
                yield from _news(each, each.connection in ready)
                if not each.steps:
                    running.remove(each)
                    _end(each)
    finally:
        for each in running:
            _end(each, at_once=True)


def _begin(job: Job, at_once: int, preload: Sequence[str]) -> _Running:
    context = _context(preload)
    ours, theirs = context.Pipe(duplex=False)
    environment = {key: value for key, value in os.environ.items() if key != "LP_NUM_THREADS"}
    process = context.Process(target=_child, args=(theirs, job, environment, _threads(at_once)), daemon=True)
    process.start()
    theirs.close()
    running = _Running(job, process, ours, list(job.steps))
    running.rest()
    return running


def _news(each: _Running, ready: bool) -> Iterator[News]:
    step = each.steps[0]
    if ready:
        try:
            value, failure = each.connection.recv()
        except (EOFError, OSError):
            value, failure = None, ("died", f"the process died, exit code {_exit(each)}")
    elif time.monotonic() >= each.deadline:
        value, failure = None, ("hangs", f"not done in {each.job.steps[step]:.0f} s")
    else:
        return
    each.steps = [] if failure else each.steps[1:]
    each.rest()
    yield News(each.job, step, value, failure, last=not each.steps)


def _exit(each: _Running) -> int | None:
    each.process.join(_PATIENCE)
    return each.process.exitcode


def _end(each: _Running, at_once: bool = False) -> None:
    each.connection.close()
    each.process.join(0.0 if at_once else 0.05)
    each.process.kill()
    each.process.join(_PATIENCE)


def _context(preload: Sequence[str]) -> Any:
    """Processes that are forked from one with nothing of ours that is mutated, where there are forks."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    # Before the first process: later it has no effect, and is the same list anyway.
    context.set_forkserver_preload(list(preload))
    return context


def _threads(at_once: int) -> int:
    here = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1
    return max(here // at_once, 1)


def _child(connection: Connection, job: Job, environment: Mapping[str, str], threads: int) -> None:
    os.environ.clear()
    # Read by Mesa when it is loaded, which it is not yet.
    os.environ.update({**environment, "LP_NUM_THREADS": str(threads)})
    # Ctrl-C is for the one that began this, and ends it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_follow, daemon=True).start()
    _limit_memory()
    # Whatever a wrong formula makes NumPy or a figure say, nobody wants to read it.
    nothing = open(os.devnull, "w")  # noqa: SIM115, PTH123
    with contextlib.redirect_stdout(nothing), contextlib.redirect_stderr(nothing):
        try:
            for value in job.work(*job.arguments):
                connection.send((value, None))
        except Exception as error:
            connection.send((None, ("raised", told(error))))
    connection.close()
    # Nothing is left to clean up, and a renderer may be slow to end.
    os._exit(0)


def _follow() -> None:
    """End this process with the one that began it: a mistake may otherwise go on for ever."""
    if parent := multiprocessing.parent_process():
        parent.join()
        os._exit(1)


def told(error: BaseException) -> str:
    """Return what an error says, and where it was raised, in one line."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    said = " ".join(str(error).split())[:300]
    return f"{type(error).__name__}: {said} ({Path(last.filename).name}, line {last.lineno})"


def _limit_memory() -> None:
    try:
        import resource

        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY if hard < 0 else min(_MEMORY, hard), hard))
    except (ImportError, OSError, ValueError):
        # A mistake that fills the memory then does so.
        return
