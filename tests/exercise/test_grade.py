"""Grading: what earns points, what is told of what does not, and which mistakes are recognised."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lietool import mutation
from lietool.exercise import (
    Case,
    Check,
    Claim,
    Exercise,
    ExerciseError,
    Function,
    Mistake,
    Picture,
    diagnose,
    grade,
    picture,
)
from lietool.exercise.outcome import Shown
from lietool.exercise.student import Trouble
from lietool.render.context import NoRendererError


def right(x, y):
    x, y = np.asarray(x, float), np.asarray(y, float)
    if not np.isfinite(x).all():
        raise ValueError("x must be finite")
    return x + 2.0 * y


def _cases(rng):
    yield Case("one and two", (1.0, 2.0))
    yield Case("a batch", (rng.random(40), rng.random(40)))


def _bad(rng):
    yield Case("x is nan", (np.nan, 1.0), raises=True)


def _law(f, rng):
    x, y = rng.random(2)
    yield Claim("f(x, 0) = x", f.add(x, 0.0), x, given=(x,))
    yield Claim("f(0, y) = 2 y", f.add(np.zeros(3), np.full(3, y)), 2.0 * y, given=(y,))


EXERCISE = Exercise(
    number=3,
    title="Adding",
    equations=("2.1",),
    functions=(Function("add", reference=right),),
    checks=(Check("values", 4, cases=_cases), Check("laws", 2, law=_law), Check("bad input", 1, cases=_bad)),
    picture=Picture("T1", 3, lambda f: {"add": f.add}),
    mistakes=(
        Mistake("once", "This is x + y.", {"add": lambda x, y: np.asarray(x) + y}),
        Mistake("right", "This is right.", {"add": right}),
    ),
    name="adding",
    arguments={"add": ("x", "y")},
)


class Inline:
    def __init__(self, **functions):
        self.functions, self.calls = functions, 0

    def call(self, function, *args):
        self.calls += 1
        try:
            return self.functions[function](*args)
        except Trouble:
            raise
        except Exception as error:
            kinds = tuple(kind.__name__ for kind in type(error).__mro__)
            raise Trouble("error", str(error), name=kinds[0], bases=kinds[1:], line=12) from None


def judged(add, **options):
    return grade.judge(EXERCISE, Inline(add=add), **({"picture": False} | options))


def points(made):
    return [outcome.points for outcome in made.outcomes]


def test_what_is_right_has_all_points_and_no_diagnosis():
    made = judged(right)
    assert points(made) == [4, 2, 1] and (made.marks, made.of) == (7, 7) and made.diagnosis == ()
    assert all(finding.passed for outcome in made.outcomes for finding in outcome.findings)


def test_what_differs_says_for_what_and_how_far():
    made = judged(lambda x, y: np.asarray(x) + y)
    assert points(made) == [0, 0, 0] and made.diagnosis == ("This is x + y.",)
    first, batch = made.outcomes[0].findings
    assert (first.says, first.given, first.wanted, first.got) == ("one and two", "x = 1, y = 2", "5", "3")
    assert first.off == "0.4, allowed 1e-09" and not first.passed
    assert batch.given == "x = an array of shape (40,), y = an array of shape (40,)"
    assert batch.wanted.startswith("[") and batch.got.startswith(batch.wanted.partition("]")[0])
    json.dumps(made.as_json())


@pytest.mark.parametrize(
    ("add", "trouble"),
    [
        (lambda x, y: {}["a"], "line 12: 'a'"),
        (lambda x, y: np.zeros((2, 2)), "it returned an array of shape (2, 2); wanted a number"),
        (lambda x, y: (x, y), "it returned 2 results: a number, a number; wanted a number"),
    ],
)
def test_what_gives_no_value_says_why(add, trouble):
    made = judged(add)
    assert made.outcomes[0].findings[0].trouble == trouble and made.marks == 0


def test_a_law_with_values_of_another_shape_says_so():
    made = judged(lambda x, y: np.zeros((2, 2)))
    assert made.outcomes[1].trouble == "add: it returned an array of shape (2, 2); wanted a number"


def test_bad_input_must_be_a_value_error():
    def wrong_kind(x, y):
        if not np.isfinite(x).all():
            raise TypeError("no")
        return right(x, y)

    class OwnError(ValueError):
        pass

    def own(x, y):
        if not np.isfinite(x).all():
            raise OwnError
        return right(x, y)

    made = judged(wrong_kind)
    assert points(made) == [4, 2, 0]
    finding = made.outcomes[2].findings[0]
    assert (finding.wanted, finding.trouble) == ("a ValueError", "line 12: no")
    assert points(judged(own)) == [4, 2, 1]
    assert judged(lambda x, y: np.asarray(x) + 2.0 * y).outcomes[2].findings[0].got == "nan"


def test_who_refuses_whatever_comes_earns_nothing_by_it():
    def refuses(x, y):
        raise ValueError("no")

    made = judged(refuses)
    assert points(made) == [0, 0, 0]
    assert made.outcomes[2].trouble == (
        "add returned nothing for any input: what is right must not be refused"
    )
    assert made.diagnosis == ()
    # Wherever the check stands.
    first = replace(EXERCISE, checks=EXERCISE.checks[::-1])
    assert points(grade.judge(first, Inline(add=right), picture=False)) == [1, 2, 4]
    assert points(grade.judge(first, Inline(add=refuses), picture=False)) == [0, 0, 0]


def test_a_mistake_that_fails_explains_nobody_who_fails():
    broken = Mistake("broken", "It divides.", {"add": lambda x, y: 1 // 0})
    made = grade.judge(replace(EXERCISE, mistakes=(broken,)), Inline(add=lambda x, y: {}["a"]), picture=False)
    assert made.marks == 0 and made.diagnosis == ()


def test_a_law_has_integers_as_the_numbers_that_they_are():
    def law(f, rng):
        yield Claim("f(1, 1)^-1 = 1 / 3", f.add(1, 1) ** -1, 1.0 / 3.0)
        x = f.add(np.arange(2), 0)
        x += 0.5
        yield Claim("f(x, 0) = x", x, np.arange(2) + 0.5)

    exercise = replace(EXERCISE, checks=(Check("law", 1, law=law),))
    whole = Inline(add=lambda x, y: np.asarray(x + 2 * y))
    made = grade.judge(exercise, whole, picture=False)
    assert made.marks == 1, made.as_json()


@pytest.mark.parametrize(
    ("check", "message"),
    [
        (Check("none", 1, cases=lambda rng: ()), "check 'none' calls no function"),
        (Check("none", 1, law=lambda f, rng: ()), "check 'none' calls no function"),
        (Check("ours", 1, law=lambda f, rng: [Claim("1 = 1", 1.0, 1.0)]), "check 'ours' calls no function"),
        (
            Check("other", 1, cases=lambda rng: [Case("one", (1.0,), "subtract")]),
            "check 'other': 'one' is for 'subtract', and there are add. Name one of these",
        ),
        (
            Check("few", 1, cases=lambda rng: [Case("one", (1.0,))]),
            "check 'few': what add is judged by fails for 'one': TypeError: right() missing",
        ),
    ],
)
def test_a_check_that_cannot_be_judged_is_the_teachers(check, message):
    with pytest.raises(ExerciseError) as error:
        grade.judge(replace(EXERCISE, checks=(check,)), Inline(add=lambda *args: 1.0), picture=False)
    assert message in str(error.value) and "\n" not in str(error.value)


def test_a_law_that_says_nothing_of_what_comes_has_no_points():
    law = Check("law", 1, law=lambda f, rng: [Claim("x > 0", x, x) for x in [f.add(0.0, 1.0)] if x < 0.0])
    made = grade.judge(replace(EXERCISE, checks=(law,)), Inline(add=right), picture=False)
    assert made.marks == 0 and made.outcomes[0].trouble == (
        "it has nothing to say of what your function returns"
    )


def test_what_is_random_goes_by_the_seed():
    seen = []
    for seed in (0, 0, 1):
        batches = []
        judged(lambda x, y, to=batches: to.append(np.array(x)) or right(x, y), seed=seed)
        seen.append(batches[1])
    assert (seen[0] == seen[1]).all() and (seen[0] != seen[2]).all()


def test_what_runs_out_of_its_time_twice_is_not_waited_for_again():
    def slow(x, y):
        raise Trouble("time", "it took longer than 5 s")

    student = Inline(add=slow)
    made = grade.judge(EXERCISE, student, picture=False)
    assert student.calls == 2 and made.marks == 0
    assert made.outcomes[2].findings[0].trouble == "add was not tried again: it ran out of its time 2 times"


def test_nothing_but_nan_is_a_starter():
    made = judged(lambda x, y: np.full(np.shape(x), np.nan))
    assert made.diagnosis == (
        "It returns nan only, as the file does that you started with: write the function.",
    )


def test_of_several_functions_those_left_blank_are_named_and_mistakes_of_the_others_told():
    other = replace(EXERCISE.functions[0], name="other")
    cases = [Case("some", (float(k), 1.0), name) for name in ("add", "other") for k in range(3)]
    checks = (Check("values", 1, cases=lambda rng: cases),)
    exercise = replace(EXERCISE, functions=(EXERCISE.functions[0], other), checks=checks)
    blank = {"other": lambda x, y: np.nan}
    left = "other gave nan only, as the file does that you started with: write what is left."
    made = grade.judge(exercise, Inline(add=right, **blank), picture=False)
    assert made.diagnosis == (left,)
    made = grade.judge(exercise, Inline(add=lambda x, y: x + y, **blank), picture=False)
    assert made.diagnosis == ("This is x + y.", left)


def test_a_mistake_must_agree_everywhere_and_differ_somewhere():
    assert judged(lambda x, y: np.asarray(x) + y + 1e-4).diagnosis == ()
    assert judged(lambda x, y: np.asarray(x) + y + 1e-12).diagnosis == ("This is x + y.",)
    assert judged(right).diagnosis == ()


def test_the_catalogue_of_mistakes_is_tried():
    (mutant,) = (one for one in mutation.catalogue() if one.name == "so3.exp: half angle missing")
    function = Function("exp", library="lietool.lie.so3.exp")
    wrong = mutation.function(mutant, "lietool.lie.so3.exp")
    exercise = replace(
        EXERCISE,
        functions=(function,),
        checks=(
            Check("values", 1, cases=lambda rng: [Case("some", (x,), "exp") for x in rng.random((3, 3))]),
        ),
        mutants=("so3.exp: half",),
        mistakes=(),
    )
    made = grade.judge(exercise, Inline(exp=wrong), picture=False)
    assert made.diagnosis == (mutant.says,)
    assert grade.judge(replace(exercise, mutants=()), Inline(exp=wrong), picture=False).diagnosis == ()


@pytest.fixture
def plate(monkeypatch):
    """A plate that shows the number 1 + 2 * 2 as a grey."""
    golden = np.full((4, 4, 3), 50, np.uint8)

    class Golden:
        image = golden

    def drawn(plate, functions):
        return np.full((4, 4, 3), 10.0 * functions["add"](1.0, 2.0)).astype(np.uint8)

    def compared(plate, image):
        same = bool((image == golden).all())
        return same, Shown(plate, image, golden, "it is the plate" if same else "it is another")

    monkeypatch.setattr(picture, "golden", lambda plate: Golden)
    monkeypatch.setattr(picture, "drawn", drawn)
    monkeypatch.setattr(picture, "compared", compared)


def test_the_picture_has_points(plate):
    made = judged(right, picture=True)
    assert (made.marks, made.of) == (10, 10) and made.shown.says == "it is the plate"
    made = judged(lambda x, y: np.asarray(x) + y, picture=True)
    assert made.outcomes[-1].points == 0 and made.outcomes[-1].findings[0].off == "it is another"
    assert made.shown.student[0, 0, 0] == 30


def test_a_plate_without_the_students_function_is_the_teachers(plate, monkeypatch):
    monkeypatch.setattr(picture, "drawn", lambda plate, functions: picture.golden(plate).image)
    with pytest.raises(ExerciseError, match="plate T1 is drawn without what is to be written"):
        judged(right, picture=True)


def test_a_function_that_the_plate_does_not_take_is_the_teachers():
    exercise = replace(EXERCISE, picture=Picture("B2.8", 3, lambda f: {"ad": f.add}))
    with pytest.raises(ExerciseError, match=r"plate B2\.8: slerp takes no function 'ad'; it takes "):
        grade.judge(exercise, Inline(add=right))


def test_nobody_loses_points_where_nothing_can_be_drawn(plate, monkeypatch):
    def fails(plate, functions):
        raise NoRendererError({})

    monkeypatch.setattr(picture, "drawn", fails)
    with pytest.raises(NoRendererError):
        judged(right, picture=True)


@pytest.mark.parametrize(
    ("add", "says"),
    [
        (lambda x, y: x + y + np.nan, "add: it returned numbers that are not finite"),
        (lambda x, y: np.zeros(3), "add: it returned an array of shape (3,); wanted a number"),
        (lambda x, y: {}["a"], "line 12: 'a'"),
    ],
)
def test_what_cannot_be_drawn_says_why(plate, add, says):
    made = judged(add, picture=True)
    assert made.shown.student is None and made.shown.says == says
    assert made.outcomes[-1].findings[0].trouble == says and made.outcomes[-1].points == 0


def test_a_figure_that_refuses_says_why(plate, monkeypatch):
    def refuses(plate, functions):
        raise IndexError("index 5 is out\nof bounds")

    monkeypatch.setattr(picture, "drawn", refuses)
    made = judged(right, picture=True)
    assert made.shown.says == (
        "the figure cannot be drawn with what your function returns: index 5 is out of bounds"
    )


def test_an_input_is_not_spoilt_for_the_next():
    def spoils(x, y):
        x += 1.0
        return x

    seen = diagnose.Seen(Case("a", (np.zeros(3), 1.0), "add"), np.full(3, 2.0), np.ones(3))
    exercise = replace(EXERCISE, mistakes=(Mistake("spoils", "It adds 1.", {"add": spoils}),))
    assert diagnose.sentences(exercise, [seen]) == ("It adds 1.",)
    assert (seen.case.args[0] == 0.0).all()


def test_who_cannot_take_batches_is_told_of_another_mistake():
    def one_at_a_time(x, y):
        if np.ndim(x):
            raise TypeError("only one")
        return x + y

    values = [Case("some", (float(k), 1.0), "add") for k in range(3)]
    exercise = replace(EXERCISE, checks=(Check("values", 1, cases=lambda rng: [*values, *_cases(rng)]),))
    made = grade.judge(exercise, Inline(add=one_at_a_time), picture=False)
    assert made.diagnosis == ("This is x + y.",)
    one_at_a_time.__code__ = (lambda x, y: x + 2.0 * y if not np.ndim(x) else None.x).__code__
    assert grade.judge(exercise, Inline(add=one_at_a_time), picture=False).diagnosis == ()


def test_a_mistake_that_is_nearly_right_is_not_told_where_all_is_right():
    nearly = Mistake("nearly", "This is a little more.", {"add": lambda x, y: right(x, y) + 5e-8})
    exercise = replace(EXERCISE, mistakes=(nearly,))

    def add(x, y):
        return right(x, y) if np.isfinite(x).all() else 0.0 * np.asarray(x)

    assert grade.judge(exercise, Inline(add=lambda x, y: right(x, y) + 5e-8), picture=False).diagnosis
    batches = Inline(add=lambda x, y: right(x, y) if not np.ndim(x) else np.zeros(2))
    assert grade.judge(exercise, batches, picture=False).diagnosis == ()
