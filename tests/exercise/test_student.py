"""A student's functions in a process of their own: what crosses, and what is said of trouble."""

import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lietool.exercise import _student_process, student
from lietool.exercise.student import Limits, Student, Trouble

_SOURCE = """import numpy as np

STATE = []


def same(*values):
    return values if len(values) != 1 else values[0]


def kinds(*values):
    print(*(type(value).__name__ for value in values))
    return 0


def spoil(x):
    x[:] = 0
    return x


def count():
    STATE.append(1)
    return len(STATE)


class OddError(ValueError):
    pass


def fails():
    x = 1
    raise OddError("the axis is zero")


def ends():
    import random
    random._os._exit(3)


def hangs():
    while True:
        x = 1


def says(x):
    print("x is", x)
    return 0
"""
_NAMES = ("same", "kinds", "spoil", "count", "fails", "ends", "hangs", "says", "gone")


@pytest.fixture(scope="module")
def running() -> Iterator[Student]:
    """A student whose file is loaded."""
    with Student(_SOURCE, functions=_NAMES) as found:
        yield found


def _called(source: str, *args: Any, **named: Any) -> Any:
    with Student("import numpy as np\n" + source, functions=["f"], **named) as found:
        return found.call("f", *args)


def _trouble(source: str, *args: Any, **named: Any) -> Trouble:
    with pytest.raises(Trouble) as caught:
        _called(source, *args, **named)
    return caught.value


@pytest.mark.parametrize(
    "value",
    [
        np.arange(6.0).reshape(2, 3),
        np.arange(6.0).reshape(2, 3).T,
        np.arange(10)[::-2],
        np.zeros((0, 3)),
        np.array(2.5),
        np.array([True, False]),
        np.array([1 + 2j, np.nan, -np.inf]),
        np.arange(3, dtype=">i2"),
        np.arange(3, dtype=np.float32),
        np.arange(3, dtype=np.uint8),
        np.float64(0.1),
        np.int64(3),
        0.1,
        -0.0,
        float("inf"),
        3,
        True,
        1j,
    ],
    ids=lambda value: f"{type(value).__name__}-{np.asarray(value).dtype.str}-{np.shape(value)}",
)
def test_a_value_comes_back_as_it_went(running: Student, value: Any) -> None:
    got = running.call("same", value)
    assert isinstance(got, np.ndarray)
    assert got.dtype == np.asarray(value).dtype and got.shape == np.shape(value)
    assert got.tobytes() == np.asarray(value).tobytes()
    # It is the grader's own.
    got[...] = 0


def test_a_tuple_comes_back_as_a_tuple_of_arrays(running: Student) -> None:
    got = running.call("same", np.eye(3), 2.0)
    assert isinstance(got, tuple) and [part.shape for part in got] == [(3, 3), ()]


def test_arguments_are_passed_as_what_they_are(running: Student) -> None:
    before = len(running.printed)
    running.call("kinds", np.eye(2), np.float64(1), 1.0, 1, True, None, "x", (1, 2), [1, np.eye(2)], 1j)
    assert running.printed[before:].split() == (
        "ndarray float64 float int bool NoneType str tuple list complex".split()  # noqa: SIM905
    )


@pytest.mark.parametrize("value", [{"a": 1}, object(), np.array([None]), np.array(["a"]), {1, 2}])
def test_what_cannot_be_passed_is_said_at_once(running: Student, value: Any) -> None:
    with pytest.raises(ValueError, match=r"an argument of same cannot be passed: an? "):
        running.call("same", value)
    assert running.call("same", 1.0) == 1


def test_a_function_that_is_not_asked_for_is_not_called(running: Student) -> None:
    with pytest.raises(ValueError, match="OddError is none of the functions same, kinds"):
        running.call("OddError")


def test_an_argument_that_is_spoilt_is_a_copy(running: Student) -> None:
    x = np.ones(3)
    assert not np.any(running.call("spoil", x))
    assert x.all()


def test_an_exception_is_told_with_its_line_and_what_it_is_derived_from(running: Student) -> None:
    with pytest.raises(Trouble) as caught:
        running.call("fails")
    trouble = caught.value
    assert (trouble.kind, trouble.name) == ("error", "OddError")
    assert trouble.message == str(trouble) == "OddError: the axis is zero"
    assert "ValueError" in trouble.bases
    assert trouble.line == _line('    raise OddError("the axis is zero")')


def _line(text: Any) -> int:
    return _SOURCE.splitlines().index(text) + 1


def test_a_loop_that_does_not_end_is_told_with_its_line() -> None:
    with Student(_SOURCE, functions=_NAMES, limits=Limits(cpu=0.3)) as found:
        with pytest.raises(Trouble, match=r"more than 0\.3 s: is there a loop") as caught:
            found.call("hangs")
        assert caught.value.line in (_line("    while True:"), _line("    while True:") + 1)
        assert found.call("count") == 1


def test_a_process_remembers_and_one_after_a_crash_begins_anew() -> None:
    with Student(_SOURCE, functions=_NAMES) as found:
        assert [found.call("count") for _ in range(3)] == [1, 2, 3]
        found.call("says", 1)
        with pytest.raises(Trouble, match="exit status 3"):
            found.call("ends")
        assert found.call("count") == 1
        assert found.printed == "x is 1\n"


def test_trouble_at_import_is_remembered() -> None:
    with Student("x = 1\nx / 0\n", functions=["f", "g"]) as found:
        for function in ("f", "g", "f"):
            began = time.perf_counter()
            with pytest.raises(Trouble, match="ZeroDivisionError") as caught:
                found.call(function)
            assert caught.value.line == 2
        assert time.perf_counter() - began < 0.05


@pytest.mark.parametrize(
    ("source", "line"),
    [
        ("def f(x):\n    return x +\n", 2),
        ("def f(x):\nreturn x\n", 2),
        ("x = 1\n\n\ny = '\0'\n", 4),
        ("\n\nf(x for x in 3, 4)\n", 3),
    ],
)
def test_a_syntax_error_has_its_line(source: str, line: int) -> None:
    with Student(source, functions=["f"]) as found, pytest.raises(Trouble) as caught:
        found.call("f")
    assert caught.value.line == line
    assert re.match("(Syntax|Indentation)Error: ", caught.value.message)
    assert "submission" not in caught.value.message


@pytest.mark.parametrize("source", ["\ufeffdef f(x): return x", "def f(x):\r\n    return x\r\n"])
def test_a_file_of_any_editor_is_read(source: str) -> None:
    with Student(source, functions=["f"]) as found:
        assert found.call("f", 2.0) == 2


def test_prints_are_kept_and_cannot_harm_a_terminal() -> None:
    source = (
        "import sys\ndef f(x):\n    print('one \\x1b[31m\\u202e\\r', object())\n"
        "    print('two', file=sys.stderr)\n    print('x' * 10000)\n    return x\n"
    )
    with Student(source, functions=["f"]) as found:
        assert found.call("f", 1.0) == 1
        assert found.printed.startswith("one �[31m�� <object object at 0x...>\ntwo\nxxx")
        assert len(found.printed) == 4000


@pytest.mark.parametrize(
    "body",
    [
        "np.random.rand(3)",
        "np.random.default_rng().normal(size=3)",
        "np.random.Generator(np.random.PCG64()).normal(size=3)",
        "[__import__('random').random()]",
        "[hash(word) for word in ('a', 'b')]",
        "[float(len(word)) for word in {'a', 'bb', 'ccc', 'dddd'}]",
    ],
)
def test_chance_is_the_same_another_time(body: str) -> None:
    source = f"def f(x): return {body}"
    once = _called(source, 0, seed=7)
    assert np.array_equal(once, _called(source, 0, seed=7))
    if "random" in body:
        assert not np.array_equal(once, _called(source, 0, seed=8))


def test_a_file_may_import_what_its_exercise_allows() -> None:
    source = "import scipy.sparse\ndef f(x): return scipy.sparse.csr_array(x).toarray() * 2"
    assert np.array_equal(_called(source, np.eye(2), allowed=("scipy.sparse",)), 2 * np.eye(2))
    assert _trouble(source, np.eye(2)).message.startswith("scipy.sparse is refused")
    behind = "import scipy.sparse, sys\ndef f(x): return sys.modules['scipy'].spatial.distance.pdist(x)"
    trouble = _trouble(behind, np.eye(2), allowed=("scipy.sparse",))
    assert trouble.message.startswith("scipy.spatial is refused")


@pytest.mark.parametrize(
    "body",
    [
        "np.linalg.svd(np.random.rand(200, 200))[1][:1] * 0",
        "np.fft.fft(np.ones(4))[1:2].real",
        "np.einsum('ij,jk->ik', np.eye(2), np.eye(2), optimize=True)[:1, 1]",
        "np.vectorize(lambda a: a - a)(np.ones(1))",
        "np.polynomial.Polynomial([0, 1])(np.zeros(1))",
        "np.testing.assert_allclose([1.0], [1.0]) or np.zeros(1)",
        "np.ma.masked_array([0.0], [False])",
        "np.log(np.zeros(1)) * np.zeros(1) if False else np.zeros(1)",
        "np.matrix([[0.0]])[0].A1",
        "np.interp([0.0], [0.0, 1.0], [0.0, 1.0])",
        "np.loadtxt(__import__('io').StringIO('0 0'))[:1]",
    ],
)
def test_numpy_is_all_there(body: str) -> None:
    assert np.array_equal(_called(f"def f(x): return {body}", 0), [0])


def test_its_own_folder_is_its_own() -> None:
    source = "def f(x):\n    np.save('a.npy', x)\n    open('b', 'w').close()\n    return np.load('a.npy')"
    assert np.array_equal(_called(source, np.eye(2)), np.eye(2))


def test_what_the_channel_carries_back_is_values_and_no_more() -> None:
    # Who finds the loop that called can answer in its place, with what any function could have returned.
    source = """
import sys
def f(x):
    frame = sys._getframe()
    while "self" not in frame.f_locals:
        frame = frame.f_back
    loop = frame.f_locals["self"]
    while not hasattr(loop, "channel"):
        frame = frame.f_back
        loop = frame.f_locals["self"]
    loop.channel.say(loop.channel.wire.pack({"id": 2, "marks": 10, "passed": True}, [np.array([10.0])]))
    import random
    random._os._exit(0)
"""
    assert np.array_equal(_called(source, 1.0), [10.0])


def test_two_run_beside_each_other() -> None:
    with Student(_SOURCE, functions=_NAMES) as one, Student(_SOURCE, functions=_NAMES) as two:
        one.call("count")
        assert (one.call("count"), two.call("count")) == (2, 1)


def test_a_call_is_quick() -> None:
    began = time.perf_counter()
    with Student(_SOURCE, functions=_NAMES) as found:
        found.call("count")
        start = time.perf_counter() - began
        times = []
        for _ in range(200):
            began = time.perf_counter()
            found.call("same", np.eye(3), 2.0)
            times.append(time.perf_counter() - began)
    # On an idle machine 0.1 s and 0.15 ms.
    assert start < 2 and np.median(times) < 2e-3


def test_it_says_where_it_cannot_be(monkeypatch: pytest.MonkeyPatch) -> None:
    class Elsewhere:
        name = "nt"

    monkeypatch.setattr(student, "os", Elsewhere)
    with pytest.raises(RuntimeError, match="needs Linux or macOS"):
        Student("", functions=[])


def test_a_process_that_does_not_start_is_no_fault_of_a_student(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    child = tmp_path / "child.py"
    child.write_text("raise SystemExit('no numpy here')")
    monkeypatch.setattr(_student_process, "_CHILD", child)
    with Student("", functions=["f"]) as found, pytest.raises(RuntimeError, match="not start: no numpy here"):
        found.call("f")
