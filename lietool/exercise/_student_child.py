"""The process that a student's file runs in; `lietool.exercise.student` starts it, by the path of this file.

It knows no lietool and has an empty environment.  It imports numpy, takes away from itself what a function of
an exercise has no use for, then loads the student's text and calls its functions, as it is asked to.
"""

import contextlib
import importlib
import importlib.machinery
import json
import os
import random
import signal
import sys
import types
from collections.abc import Callable
from typing import Any

# Of a message of an exception: it may be anything.
_LONGEST = 300
_MOST_PARTS = 100
# The modules whose exceptions are no student's.
_OURS = ("__main__", "_student_guard", "_student_wire")


def _beside(name: str) -> Any:
    """Return the module of a file beside this one: the folder itself is on no path, and stays off it."""
    file = os.path.join(os.path.dirname(os.path.abspath(__file__)), f"{name}.py")  # noqa: PTH100, PTH118, PTH120
    module = types.ModuleType(name)
    module.__file__ = file
    code = importlib.machinery.SourceFileLoader(name, file).get_code(name)
    assert code is not None
    exec(code, module.__dict__)
    return module


class _Channel:
    """The socket that questions come on and answers go back on."""

    def __init__(self, number: int, wire: Any) -> None:
        self.number, self.wire = number, wire
        self._read, self._write = os.read, os.write

    def _bytes(self, count: int) -> bytearray:
        data = bytearray()
        while len(data) < count:
            part = self._read(self.number, min(count - len(data), 1 << 20))
            if not part:
                # The grader is gone.
                os._exit(0)
            data += part
        return data

    def ask(self) -> tuple[dict[str, Any], list[Any]]:
        """Wait for a question."""
        head, sizes = self.wire.head(self._bytes(self.wire.length(self._bytes(4))))
        return head, self.wire.values(head, [self._bytes(size) for size in sizes])

    def say(self, message: bytes) -> None:
        """Give an answer."""
        view = memoryview(message)
        while view:
            view = view[self._write(self.number, view) :]


class _TooLongError(BaseException):
    """The time is over."""


class _NoAnswerError(Exception):
    """What a function returned is no answer."""


class _NoFunctionError(Exception):
    """The file has no such function."""


def _numbers(asarray: Callable[[Any], Any], value: Any) -> Any:
    """Return as an array of numbers what a function returned."""
    if value is None:
        raise _NoAnswerError("it returned None: is a return missing?")
    try:
        array = asarray(value)
    except ValueError:
        raise _NoAnswerError(
            f"it returned a {type(value).__name__} that is no array: its rows differ"
        ) from None
    if array.dtype.kind == "O":
        raise _NoAnswerError("it returned an array of objects where numbers are wanted")
    if array.dtype.kind not in "biufc":
        raise _NoAnswerError(f"it returned an array of dtype {array.dtype} where numbers are wanted")
    # Of long doubles no two machines agree how long they are.
    if array.dtype.kind in "fc" and array.dtype.itemsize > (16 if array.dtype.kind == "c" else 8):
        array = array.astype("c16" if array.dtype.kind == "c" else "f8")
    return array


def _answer(asarray: Callable[[Any], Any], value: Any, most: int) -> Any:
    if isinstance(value, tuple) and len(value) > _MOST_PARTS:
        raise _NoAnswerError(f"it returned a tuple of {len(value)}, more than any exercise asks for")
    arrays = [_numbers(asarray, part) for part in (value if isinstance(value, tuple) else (value,))]
    if sum(array.nbytes for array in arrays) > most:
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise _NoAnswerError(f"it returned too much: shape {shapes}, more than {most >> 20} MiB")
    return tuple(arrays) if isinstance(value, tuple) else arrays[0]


def _kind(error: BaseException, refused: tuple[type, ...]) -> str:
    for types_, kind in (
        (refused, "refused"),
        (_NoAnswerError, "output"),
        (_TooLongError, "time"),
        (MemoryError, "memory"),
        ((SystemExit, KeyboardInterrupt, GeneratorExit), "exit"),
    ):
        if isinstance(error, types_):
            return kind
    return "error"


def _trouble(error: BaseException, name: str, refused: tuple[type, ...]) -> dict[str, Any]:
    """Return what an exception of the student says."""
    kind, cls = _kind(error, refused), type(error)
    try:
        said = " ".join(str(error)[:4000].split())[:_LONGEST]
    except BaseException:
        said = ""
    if kind == "exit":
        said = f"it called exit ({said})" if isinstance(error, SystemExit) else f"it raised {cls.__name__}"
    elif kind == "memory":
        said = "it wants more memory than there is for it"
    elif kind == "error" and cls is not _NoFunctionError:
        said = f"{cls.__name__}: {said}" if said else cls.__name__
    line, step = None, error.__traceback__
    if isinstance(error, SyntaxError) and error.filename == name:
        # What str() says ends in the file's name and the line.
        line, said = error.lineno, f"{cls.__name__}: {error.msg}"
    while step is not None:
        if step.tb_frame.f_code.co_filename == name:
            line = step.tb_lineno
        step = step.tb_next
    theirs = () if cls.__module__ in _OURS else cls.__mro__
    names = [base.__name__ for base in theirs if base is not object] or [""]
    return {"kind": kind, "message": said, "name": names[0], "bases": names[1:], "line": line}


class _Loop:
    """The student's text, loaded, and the answers of its functions."""

    def __init__(self, channel: _Channel, settings: dict[str, Any], np: Any, guard: Any) -> None:
        self.channel, self.np, self.guard = channel, np, guard
        # As it is now, whatever the student makes of numpy.
        self.asarray = np.asarray
        self.name, self.most, self.allowed = settings["name"], settings["answer"], settings["allowed"]
        self.seconds, self.busy = 0.0, False
        self.module = types.ModuleType("submission")
        self.random = settings["random"]
        self.printed: tuple[Any, Any] = (sys.stdout, sys.stderr)

    def load(self, source: str, seed: int) -> None:
        """Run the student's text."""
        random.seed(seed)
        if self.random:
            self.np.random.seed(seed % 2**32)
        self.module.__dict__["__builtins__"] = self.guard.builtins_for_a_student(self.allowed)
        sys.modules["submission"] = self.module
        exec(compile(source, self.name, "exec", dont_inherit=True), self.module.__dict__)

    def call(self, function: str, args: list[Any]) -> Any:
        """Call one of its functions."""
        found = self.module.__dict__.get(function)
        if not callable(found):
            raise _NoFunctionError(self._missing(function))
        return _answer(self.asarray, found(*args), self.most)

    def _missing(self, function: str) -> str:
        names = self.module.__dict__
        there = [name for name, value in names.items() if isinstance(value, types.FunctionType)]
        there = [name for name in there if names[name].__module__ == "submission"][:5]
        if function in names:
            return f"{function} is no function in the file"
        return f"the file has no function {function}" + (f": it has {', '.join(there)}" if there else "")

    def stop(self, *_: object) -> None:
        """Stop what the student's function does."""
        if self.busy:
            raise _TooLongError

    def turn(self) -> None:
        """Answer one question."""
        head, args = self.channel.ask()
        number = head["id"]
        if self.seconds:
            # Where the grader cannot see the processor's time.
            signal.setitimer(signal.ITIMER_PROF, self.seconds, 0.5)
        try:
            self.busy = True
            message = self.reply(number, head, args)
            self.busy = False
        except BaseException as error:
            self.busy = False
            message = self._failure(number, error)
        if self.seconds:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
        for file in self.printed:
            try:
                file.flush()
            except BaseException:
                continue
        self.channel.say(message)

    def reply(self, number: int, head: dict[str, Any], args: list[Any]) -> bytes:
        """Do what a question asks for."""
        if "source" in head:
            self.load(head["source"], head["seed"])
            return self.channel.wire.pack({"id": number})
        return self.channel.wire.pack({"id": number}, [self.call(head["function"], args)])

    def _failure(self, number: int, error: BaseException) -> bytes:
        try:
            trouble = _trouble(error, self.name, self.guard.REFUSALS)
            # What its frames hold may be what filled the memory.
            error.__traceback__ = None
            return self.channel.wire.pack({"id": number, "trouble": trouble})
        except BaseException:
            return self.channel.wire.pack(
                {"id": number, "trouble": {"kind": "error", "message": "it failed"}}
            )


def _begin() -> _Loop:
    """Make ready: numpy is imported, and then the walls go up."""
    number, settings = int(sys.argv[1]), json.loads(sys.argv[2])
    sys.argv[:] = sys.orig_argv[:] = ["submission"]
    kernel, guard = _beside("_student_kernel"), _beside("_student_guard")
    kernel.follow(settings["parent"])
    # Without site it is the standard library's, and nothing else.
    settings["library"] = [os.path.abspath(path) for path in sys.path]  # noqa: PTH100
    sys.path += [os.path.dirname(path) for path in settings["packages"]]  # noqa: PTH120
    if not settings["allowed"]:
        # It is soon imported, and numpy can be without; others cannot.
        guard.hide_ctypes()
    import numpy

    for name in settings["allowed"]:
        importlib.import_module(name)
    guard.hide_ctypes()
    # Their library is the system's, which is soon out of reach; what numpy brings only when asked wants them.
    for name in ("binascii", "zlib"):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    if settings["random"]:
        # The seed of a generator that is given none: of the system's noise nothing could be graded twice.
        setattr(numpy.random.bit_generator, "randbits", random.getrandbits)  # noqa: B010 - it has no type
    wire = _beside("_student_wire")
    channel = _Channel(number, wire)
    loop = _Loop(channel, settings, numpy, guard)
    sys.dont_write_bytecode = True
    for file in loop.printed:
        # What it has printed is there when it hangs or dies; and no letter of a student's fails.
        file.reconfigure(line_buffering=True, errors="backslashreplace")
    # Whoever looks for what was started finds nothing of it here.
    sys.modules["__main__"] = types.ModuleType("__main__")
    loop.seconds = 0.0 if settings["clock"] else settings["cpu"]
    for which in (signal.SIGXCPU, signal.SIGPROF):
        signal.signal(which, loop.stop)
    kernel.limit(settings)
    walls = kernel.walls(settings) if settings["walls"] else []
    guard.stand(settings)
    channel.say(wire.pack({"id": 0, "walls": walls}))
    return loop


if __name__ == "__main__":
    loop = _begin()
    try:
        while True:
            loop.turn()
    finally:
        # Who has closed the channel has nobody to tell what happened.
        os._exit(1)
