"""Many submissions: each graded in a process that may hang or die, and what is found kept as it comes."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from lietool.exercise import Exercise, load
from lietool.exercise.grade import grade
from lietool.mutation import process
from lietool.verbs import _exercise_journal, _table
from lietool.verbs._exercise_journal import Journal, Record
from lietool.verbs._exercise_read import Submission

# In a process one after the other: it has a renderer to make first.
_TOGETHER = 16
# A student's function has its own limits; this is for a figure that never ends with what it returns.
_SECONDS = 240.0
# What every process needs; the rest is imported where it is used.
_PRELOADED = (
    *("numpy", "PIL.PngImagePlugin", "click", "lietool.mutation", "lietool.exercise.grade"),
    *("lietool.exercise.load", "lietool.exercise.picture", "lietool.render.draw", "lietool.golden.compare"),
    *("lietool.golden.explain", "lietool.verbs._exercise_class"),
)


@dataclass(frozen=True, eq=False)
class Marked:
    """A submission, and what grading it gave or why it could not be graded."""

    submission: Submission
    record: Record | None = None
    trouble: str = ""


@dataclass(frozen=True)
class Task:
    """A text to be graded; `key` is that of its record."""

    key: str
    exercise: str
    source: str
    seed: int
    picture: bool


def alone(submission: Submission, seed: int, picture: bool) -> Marked:
    """Grade one submission in this process.

    Raises
    ------
    ExerciseError
        As `grade`.
    """
    exercise = load.load(submission.exercise)
    graded = grade(exercise, submission.source, seed=seed, picture=picture)
    return Marked(submission, _exercise_journal.record(graded))


def together(
    submissions: Sequence[Submission],
    exercises: Mapping[str, Exercise],
    *,
    seed: int,
    picture: bool,
    jobs: int,
    fresh: bool,
    seconds: float = _SECONDS,
) -> list[Marked]:
    """Grade submissions in processes of their own.

    Parameters
    ----------
    submissions : sequence of Submission
    exercises : mapping from str to Exercise
        Those that they are for.
    seed : int
        Of random inputs.
    picture : bool
        Whether the plates are drawn.
    jobs : int
        How many processes there are at a time.
    fresh : bool
        Whether what earlier runs have found is left alone.
    seconds : float
        How long one submission may take.

    Returns
    -------
    list of Marked
        In the order of the submissions; equal texts are graded once.
    """
    journal = Journal(fresh)
    tasks: dict[str, Task] = {}
    keys = []
    for each in submissions:
        if each.trouble:
            keys.append("")
            continue
        keys.append(journal.key(exercises[each.exercise], each.digest, seed, picture))
        tasks[keys[-1]] = Task(keys[-1], each.exercise, each.source, seed, picture)
    found: dict[str, Record | str] = {key: made for key in tasks if (made := journal.read(key))}
    missing = [task for key, task in tasks.items() if key not in found]
    for key, made in _graded(missing, jobs, seconds):
        found[key] = made
        if isinstance(made, Record):
            journal.keep(key, made)
    return [_marked(each, found.get(key)) for each, key in zip(submissions, keys, strict=True)]


def work(tasks: Sequence[Task]) -> Iterator[Record]:
    """Grade texts one after the other, in the process that this runs in."""
    for task in tasks:
        exercise = load.load(task.exercise)
        yield _exercise_journal.record(grade(exercise, task.source, seed=task.seed, picture=task.picture))


def _marked(submission: Submission, made: Record | str | None) -> Marked:
    if isinstance(made, Record):
        return Marked(submission, made)
    return Marked(submission, None, submission.trouble or made or "it was not graded")


def _graded(tasks: Sequence[Task], jobs: int, seconds: float) -> Iterator[tuple[str, Record | str]]:
    """Yield the key of each task and its record, or why there is none, as they come."""
    # Those of an exercise stay together, for the sake of its figure.
    waiting = deque(sorted(tasks, key=lambda task: task.exercise))
    bar = iter(_table.progress(tasks, "grading"))
    next(bar, None)
    while waiting:
        chunks, by_key = _chunks(waiting, jobs), {task.key: task for task in waiting}
        waiting.clear()
        done: set[str] = set()
        parts = [process.Job(c[0].key, work, (c,), {task.key: seconds for task in c}) for c in chunks]
        for news in process.run(parts, jobs, preload=_PRELOADED):
            done.add(news.step)
            yield news.step, news.value if news.failure is None else _failed(news.failure)
            next(bar, None)
        # What stood behind one that took its process with it.
        waiting.extend(task for key, task in by_key.items() if key not in done)
    for _ in bar:
        pass


def _chunks(tasks: Sequence[Task], jobs: int) -> list[list[Task]]:
    size = max(1, min(_TOGETHER, -(-len(tasks) // (2 * jobs))))
    listed = list(tasks)
    return [listed[k : k + size] for k in range(0, len(listed), size)]


def _failed(failure: tuple[str, str]) -> str:
    kind, says = failure
    return {
        "hangs": f"it could not be graded: {says}",
        "died": "it could not be graded: the process that drew it died",
    }.get(kind, f"it could not be graded: {says}")
