"""Grading: what a student's functions return is judged here, in the process that they do not run in."""

import hashlib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from lietool.exercise import compare, diagnose, texts
from lietool.exercise.calls import Caller, Functions
from lietool.exercise.outcome import Finding, Graded, Outcome, Shown
from lietool.exercise.record import Case, Check, Claim, Exercise, ExerciseError, Function, Value
from lietool.exercise.student import Limits, Student, Trouble

# A function that has run out of its time twice will do so again: what is left is lost without waiting.
PATIENCE = 2


def grade(
    exercise: Exercise,
    source: str,
    *,
    seed: int = 0,
    picture: bool = True,
    limits: Limits | None = None,
    name: str = "submission.py",
) -> Graded:
    """Grade a submission.

    The same text, exercise and seed give the same marks and the same words.

    Parameters
    ----------
    exercise : Exercise
        What it is for.
    source : str
        The submission.
    seed : int
        Of random inputs.
    picture : bool
        Whether the plate is drawn; without it its points are neither earned nor to be had.
    limits : Limits, optional
        What the student's process may use.
    name : str
        What messages call the submission.

    Returns
    -------
    Graded
        The marks, and why.

    Raises
    ------
    ExerciseError
        If the plate of the exercise cannot be had, or a check or the picture tries nothing.
    NoRendererError
        If there is to be a picture, and nothing here can draw it.
    """
    names = [function.name for function in exercise.functions]
    with Student(
        source, functions=names, allowed=exercise.allowed, limits=limits or Limits(), name=name, seed=seed
    ) as student:
        made = judge(exercise, student, seed=seed, picture=picture)
        printed = student.printed
    return replace(made, digest=hashlib.sha256(source.encode()).hexdigest(), printed=printed)


def judge(exercise: Exercise, student: Caller, *, seed: int = 0, picture: bool = True) -> Graded:
    """Grade functions, wherever they run.

    Parameters
    ----------
    exercise : Exercise
        What they are for.
    student : Caller
        What calls them.
    seed, picture
        As of `grade`.

    Returns
    -------
    Graded
        The marks, and why; without digest.

    Raises
    ------
    ExerciseError, NoRendererError
        As `grade`.
    """
    trial = _Trial(exercise, student, seed)
    outcomes = [trial.check(index, check) for index, check in enumerate(exercise.checks)]
    outcomes = [trial.with_merit(*each) for each in zip(exercise.checks, outcomes, strict=True)]
    shown = None
    if picture:
        outcome, shown = trial.picture()
        outcomes.append(outcome)
    diagnosis = diagnose.sentences(exercise, trial.seen)
    return Graded(exercise.name, exercise.title, tuple(outcomes), diagnosis, seed, shown=shown)


class _Trial:
    """One submission while it is tried: what came is kept for a diagnosis."""

    def __init__(self, exercise: Exercise, student: Caller, seed: int) -> None:
        self.exercise, self.student, self.seed = exercise, student, seed
        self.seen: list[diagnose.Seen] = []
        self._late: dict[str, int] = {}
        self._calls = 0
        self._answered: set[str] = set()
        self._to_refuse: dict[Check, set[str]] = {}

    def call(self, function: str, *args: Any) -> Any:
        """Call a function of the student, unless it has run out of its time too often; raises Trouble."""
        self._calls += 1
        if self._late.get(function, 0) >= PATIENCE:
            raise Trouble("time", f"{function} was not tried again: it ran out of its time {PATIENCE} times")
        try:
            got = self.student.call(function, *args)
        except Trouble as trouble:
            if trouble.kind == "time":
                self._late[function] = self._late.get(function, 0) + 1
            raise
        self._answered.add(function)
        return got

    def check(self, index: int, check: Check) -> Outcome:
        """Try one check."""
        rng = np.random.default_rng([self.seed, self.exercise.number, index])
        trouble, before = "", self._calls
        if check.cases is not None:
            findings = [self._case(check, case) for case in check.cases(rng)]
        else:
            findings, trouble = self._law(check, rng)
        if not trouble and self._calls == before:
            raise ExerciseError(
                f"exercise {self.exercise.name}: check {check.title!r} calls no function, and anybody would "
                "have its points. Let it try one"
            )
        if not trouble and not findings:
            trouble = "it has nothing to say of what your function returns"
        points = check.points if findings and not trouble and all(x.passed for x in findings) else 0
        kind = "law" if check.cases is None else "cases"
        return Outcome(check.title, kind, points, check.points, tuple(findings), trouble)

    def with_merit(self, check: Check, outcome: Outcome) -> Outcome:
        """Return what came of a check, without points where all was refused by who refuses whatever comes."""
        blind = sorted(self._to_refuse.get(check, set()) - self._answered)
        if not blind or not outcome.points:
            return outcome
        says = f"{' and '.join(blind)} returned nothing for any input: what is right must not be refused"
        return replace(outcome, points=0, trouble=says)

    def _case(self, check: Check, case: Case) -> Finding:
        function = self._meant(check, case)
        case = replace(case, function=function.name)
        given = texts.given(self.exercise.arguments.get(function.name, ()), case.args)
        got, trouble = diagnose.REFUSED, None
        try:
            got = self.call(function.name, *case.args)
        except Trouble as error:
            trouble = error
        if case.raises:
            self._to_refuse.setdefault(check, set()).add(function.name)
            return _refusal(case, given, got, trouble)
        want = self._wanted(check, case, function)
        self.seen.append(diagnose.Seen(case, want, got))
        if trouble is not None:
            return Finding(case.says, False, given, trouble=_told(trouble))
        return _judged(case.says, given, got, want, function.apart, function.tolerance)

    def _meant(self, check: Check, case: Case) -> Function:
        try:
            return self.exercise.function(case.function)
        except KeyError:
            known = ", ".join(function.name for function in self.exercise.functions)
            raise ExerciseError(
                f"exercise {self.exercise.name}, check {check.title!r}: {case.says!r} is for "
                f"{case.function!r}, and there are {known}. Name one of these"
            ) from None

    def _wanted(self, check: Check, case: Case, function: Function) -> Value:
        try:
            with np.errstate(all="ignore"):
                return function.wanted(*case.args)
        except Exception as error:
            raise ExerciseError(
                f"exercise {self.exercise.name}, check {check.title!r}: what {function.name} is judged by "
                f"fails for {case.says!r}: {type(error).__name__}: {_line(error)}. Correct one of them"
            ) from error

    def _law(self, check: Check, rng: np.random.Generator) -> tuple[list[Finding], str]:
        findings: list[Finding] = []
        assert check.law is not None
        try:
            with np.errstate(all="ignore"):
                for claim in check.law(Functions(self.exercise, self), rng):
                    findings.append(_claimed(claim))
        except (Trouble, compare.UnlikeError) as error:
            return findings, _told(error)
        except Exception as error:
            return findings, f"it cannot be tried with what your function returns: {_line(error)}"
        return findings, ""

    def picture(self) -> tuple[Outcome, Shown]:
        """Draw the plate with the student's functions, and compare."""
        from lietool.exercise import picture
        from lietool.render.context import NoRendererError

        wanted = self.exercise.picture
        # Before the student is asked: a plate without a golden is nobody's fault but ours.
        reference = picture.golden(wanted.plate).image
        passes, trouble = False, ""
        shown, before = Shown(wanted.plate, None, reference, ""), self._calls
        try:
            with np.errstate(all="ignore"):
                functions = wanted.functions(Functions(self.exercise, self, finite=True))
                image = picture.drawn(wanted.plate, functions)
        except (ExerciseError, NoRendererError):
            # The student is not to blame.
            raise
        except (Trouble, compare.UnlikeError) as error:
            trouble = _told(error)
        except Exception as error:
            trouble = f"the figure cannot be drawn with what your function returns: {_line(error)}"
        else:
            if self._calls == before:
                raise ExerciseError(
                    f"exercise {self.exercise.name}: plate {wanted.plate} is drawn without what is to be "
                    "written, and anybody would have its points. Pass them to the figure"
                )
            passes, shown = picture.compared(wanted.plate, image)
        shown = replace(shown, says=trouble or shown.says)
        finding = Finding(
            f"plate {wanted.plate}", passes, off="" if passes or trouble else shown.says, trouble=trouble
        )
        points = wanted.points if passes else 0
        return Outcome(f"the picture {wanted.plate}", "picture", points, wanted.points, (finding,)), shown


def _refusal(case: Case, given: str, got: Any, trouble: Trouble | None) -> Finding:
    """Judge what came of an input that must be refused."""
    wanted = "a ValueError"
    if trouble is None:
        return Finding(case.says, False, given, wanted, texts.value(got))
    if trouble.kind == "error" and "ValueError" in (trouble.name, *trouble.bases):
        return Finding(case.says, True)
    return Finding(case.says, False, given, wanted, trouble=_told(trouble))


def _claimed(claim: Claim) -> Finding:
    given, want = texts.given((), claim.given), claim.want
    if not isinstance(want, tuple):
        # One side may hold for all of a batch.
        want = np.broadcast_to(want, np.broadcast_shapes(np.shape(want), np.shape(claim.got)))
    return _judged(claim.says, given, claim.got, want, compare.apart, claim.tolerance)


def _judged(
    says: str,
    given: str,
    got: Any,
    want: Any,
    apart: Callable[[Any, Any], float],
    tolerance: float,
) -> Finding:
    try:
        with np.errstate(all="ignore"):
            off = apart(got, want)
    except compare.UnlikeError as error:
        return Finding(says, False, given, trouble=str(error))
    # Also where it is nan.
    if off <= tolerance:
        return Finding(says, True)
    wanted, came = texts.beside(got, want)
    return Finding(says, False, given, wanted, came, f"{off:.2g}, allowed {tolerance:.2g}")


def _told(error: Trouble | compare.UnlikeError) -> str:
    if isinstance(error, Trouble):
        return f"line {error.line}: {error.message}" if error.line else error.message
    return str(error)


def _line(error: Exception) -> str:
    """An error in one line."""
    text = " ".join(str(error).split())
    return text[:200] or type(error).__name__
