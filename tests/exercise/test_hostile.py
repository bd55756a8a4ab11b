"""What a student's file may try against the grader: each loses its own call, and is told so in one line.

Every text here defines `f`, which is hostile, and the honest `g`, which must go on to answer.
"""

import contextlib
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lietool import paths
from lietool.exercise import _student_process
from lietool.exercise.student import Limits, Student, Trouble

_LIMITS = Limits(cpu=0.4, memory=128 << 20, written=1 << 20)
_REFERENCE = paths.PACKAGE / "lie" / "so3.py"
_GOLDEN = next(iter(sorted((paths.PACKAGE.parent / "golden").rglob("*.png"))), Path("golden/B2.5.png"))
_HONEST = """
import numpy as np

def g(x):
    return 2 * x

"""


@dataclass(frozen=True)
class Hostile:
    """A text, and what is to come of a call of its `f`.

    Parameters
    ----------
    name : str
    source : str
    kind : str
        Of the Trouble, "|" between kinds that are both right; "" where a value comes: 0.
    says : str
        What the message holds, as a pattern.
    alone : bool
        Whether the whole file is lost with it.
    """

    name: str
    source: str
    kind: str
    says: str = ""
    alone: bool = False


def _f(name: str, body: str, kind: str, says: str = "") -> Hostile:
    lines = "".join(f"    {line}\n" for line in body.strip("\n").splitlines())
    return Hostile(name, f"def f(x):\n{lines}", kind, says)


_HANGS = [
    _f("endless loop", "while True: pass", "time", "loop that does not end"),
    _f(
        "endless loop that catches all",
        "while True:\n    try:\n        while True: pass\n    except BaseException: pass",
        "time",
        "loop that does not end",
    ),
    _f("loop in C", "return sum(range(10**13))", "time"),
    _f("loop in numpy", "return np.add.reduce(np.broadcast_to(1.0, 10**12))", "time"),
    _f("loop in a pattern", "import re\nre.match('(a+)+$', 'a' * 60 + 'b')", "time"),
    _f("sleep", "import time\ntime.sleep(1000)", "time", "waits"),
    _f(
        "a lock that nobody opens",
        "import sys\nlock = sys.modules['_thread'].allocate_lock()\nlock.acquire(); lock.acquire()",
        "time",
        "waits",
    ),
    _f("it stops itself", "import sys\nsys.modules['_signal'].raise_signal(19)", "time", "waits"),
    _f(
        "signals that are not heard",
        "import sys\ns = sys.modules['_signal']\nfor n in (s.SIGXCPU, s.SIGTERM, s.SIGPROF, s.SIGINT):\n"
        "    s.signal(n, s.SIG_IGN)\nwhile True: pass",
        "time",
    ),
    _f("big powers", "return 9**9**9", "time|memory"),
]
_ENDS = [
    _f("recursion", "return f(x)", "error", "RecursionError"),
    _f(
        "recursion without a limit",
        "import sys\nsys.setrecursionlimit(10**9)\nreturn f(x) + 1",
        "crash|memory|time|error",
    ),
    _f(
        "recursion in C",
        "import sys\nsys.setrecursionlimit(10**9)\nx = []\n"
        "for _ in range(10**6): x = [x]\nreturn len(repr(x))",
        "crash|memory|time|error",
    ),
    _f("sys.exit", "import sys\nsys.exit(0)", "exit", "called exit"),
    _f("exit", "exit()", "exit", "called exit"),
    _f("SystemExit", "raise SystemExit('ten points')", "exit", "ten points"),
    _f("KeyboardInterrupt", "raise KeyboardInterrupt", "exit", "KeyboardInterrupt"),
    _f("os._exit", "import random\nrandom._os._exit(0)", "exit", "exit status 0"),
    _f("abort", "import random\nrandom._os.abort()", "crash", "SIGABRT|SIGSEGV|SIGILL"),
    _f("its own kill", "import sys\nsys.modules['_signal'].raise_signal(9)", "memory", "the system ended it"),
    _f("huge array", "return np.ones(10**11)", "memory", "more memory"),
    _f("huge list", "return [0] * 10**11", "memory", "more memory"),
    _f("memory piece by piece", "x = []\nwhile True: x.append(bytearray(10**6))", "memory", "more memory"),
    _f(
        "segmentation fault",
        "return np.lib.stride_tricks.as_strided(np.zeros(1), (1 << 40,), (1 << 20,))[1 << 30]",
        "crash",
        "SIGSEGV|SIGBUS",
    ),
    Hostile("exit at import", "import sys\nsys.exit(0)", "exit", "called exit", alone=True),
    Hostile("KeyboardInterrupt at import", "raise KeyboardInterrupt", "exit", alone=True),
    Hostile("os._exit at import", "import random\nrandom._os._exit(7)", "exit", "status 7", alone=True),
    Hostile("endless at import", "while True: pass", "time", alone=True),
    Hostile("memory at import", "x = np.ones(10**11)", "memory", alone=True),
]
_PROCESSES = [
    _f("fork bomb", "import random\nwhile True: random._os.fork()", "refused", "starting a process"),
    _f(
        "fork bomb unseen",
        "import random\nwhile True:\n    try: random._os.fork()\n    except OSError: pass",
        "time",
    ),
    _f("os.system", "import random\nrandom._os.system('touch evil')", "refused", "starting a process"),
    _f("exec", "import random\nrandom._os.execv('/bin/sh', ['sh'])", "refused", "starting a process"),
    _f("posix_spawn", "import random\nrandom._os.posix_spawn('/bin/sh', ['sh'], {})", "refused"),
    _f("import subprocess", "import subprocess", "refused", "subprocess is refused: .*numpy alone"),
    _f("import os", "import os", "refused", "os is refused: .*numpy alone"),
    _f(
        "subprocess behind",
        "import sys\nsys.modules['importlib'].import_module('subprocess').run(['touch', 'evil'])",
        "refused",
        "starting a process",
    ),
    _f("import threading", "import threading", "refused", "numpy alone"),
    _f(
        "thread",
        "import sys\nsys.modules['_thread'].start_new_thread(print, ())",
        "refused",
        "starting a thread",
    ),
    _f(
        "daemon thread",
        "import numpy.testing, sys\n"
        "sys.modules['threading'].Thread(target=f, args=(x,), daemon=True).start()",
        "refused",
        "starting a thread",
    ),
    _f("kill the grader", "import random\nrandom._os.kill(random._os.getppid(), 9)", "refused", "a signal"),
    _f("kill everything", "import random\nrandom._os.killpg(0, 9)", "refused", "a signal"),
    _f("atexit", "import atexit", "refused"),
    _f("import ctypes", "import ctypes", "refused", "numpy alone"),
    _f("import ctypes behind", "import importlib", "refused"),
    _f("_ctypes", "import sys\nsys.modules['importlib'].import_module('_ctypes')", "refused|error", "ctypes"),
    _f("socket", "import socket", "refused"),
    _f(
        "socket behind",
        "import sys\nsys.modules['importlib'].import_module('_socket').socket()",
        "refused",
        "the network",
    ),
]
_FILES = [
    _f("writing outside", "open('/tmp/lietool-evil', 'w')", "refused", "writing '/tmp/lietool-evil'"),
    _f("writing above", "open('../lietool-evil', 'w')", "refused", "writing"),
    _f("np.save outside", "np.save('/tmp/lietool-evil.npy', x)", "refused", "writing"),
    _f("tofile outside", "np.zeros(3).tofile('/tmp/lietool-evil.npy')", "refused", "writing"),
    _f("removing", f"import random\nrandom._os.remove({str(_REFERENCE)!r})", "refused", "done to files"),
    _f("a link", "import random\nrandom._os.symlink('/etc', 'etc')", "refused", "done to files"),
    _f("a folder", "import random\nrandom._os.mkdir('sub')", "refused", "done to files"),
    _f("changing folder", "import random\nrandom._os.chdir('/')", "refused", "done to files"),
    _f(
        "filling the disk",
        "for i in range(1000):\n    with open(f'{i}', 'wb') as file: file.write(bytes(10**6))",
        "output",
        "wrote more than 1 MiB",
    ),
    _f("one large file", "open('a', 'wb').write(bytes(10**8))", "error", "OSError.*too large"),
    _f("many files", "for i in range(10**6): open(f'{i}', 'w').close()", "output|time"),
    _f("all descriptors", "return [open(f'{i}', 'w') for i in range(99)]", "error", "Too many open files"),
    _f("reading the reference", f"open({str(_REFERENCE)!r}).read()", "refused", "reading .*so3.py"),
    _f("reading by bytes", f"open({os.fsencode(_REFERENCE)!r}).read()", "refused", "reading .*so3.py"),
    _f(
        "a path that lies",
        "class Path(str):\n    def startswith(self, *_): return True\n"
        "    def __add__(self, _): return '/dev/null'\n"
        f"return len(open(Path({str(_REFERENCE)!r})).read())",
        "refused",
        "reading .*so3.py",
    ),
    _f("reading a golden", f"np.fromfile({str(_GOLDEN)!r}, np.uint8)", "refused", "reading"),
    _f("listing", f"import random\nrandom._os.listdir({str(paths.PACKAGE)!r})", "refused", "reading"),
    _f("reading /proc", "open('/proc/self/environ').read()", "refused", "reading"),
    _f("reading by number", "open(0).read()", "refused", "by its number"),
    _f(
        "os.open",
        f"import random\nrandom._os.open({str(_REFERENCE)!r}, 0)",
        "refused",
        "reading .*so3.py",
    ),
    _f(
        "the environment",
        "import random\nreturn 0.0 * ('HOME' in random._os.environ) + len(random._os.environ) // 9",
        "",
    ),
]
_IMPORTS = [
    _f("import lietool", "import lietool", "refused", "lietool is refused: .*numpy alone"),
    _f("from lietool", "from lietool.lie import so3", "refused", "lietool.lie is refused"),
    Hostile(
        "import lietool at import", "from lietool.lie.so3 import *", "refused", "numpy alone", alone=True
    ),
    _f(
        "import scipy",
        "from scipy.spatial.transform import Rotation",
        "refused",
        "scipy.spatial.transform is refused",
    ),
    _f("import matplotlib", "import matplotlib.pyplot as plt", "refused", "matplotlib.pyplot is refused"),
    _f("__import__", "__import__('lietool')", "refused", "lietool is refused"),
    _f("exec", "exec('import lietool', {})", "refused", "lietool is refused"),
    _f("eval", "eval('__import__(\"scipy\")')", "refused", "scipy is refused"),
    _f(
        "import_module",
        "import sys\nsys.modules['importlib'].import_module('lietool')",
        "refused|error",
        "lietool",
    ),
    _f(
        "a finder taken away",
        "import sys\nsys.meta_path.pop(0)\n"
        f"sys.path.append({str(paths.PACKAGE.parent)!r})\n"
        "sys.modules['importlib'].import_module('lietool')",
        "refused|error",
        "lietool|reading",
    ),
    _f(
        "a loader by path",
        "import sys\nloader = sys.modules['importlib.machinery'].SourceFileLoader\n"
        f"loader('so3', {str(_REFERENCE)!r}).load_module()",
        "refused",
        "reading .*so3.py",
    ),
    _f(
        "true __import__",
        "import sys\nsys.modules['builtins'].__import__('lietool')",
        "refused|error",
        "lietool",
    ),
]
_FORGES = [
    _f("replacing open", "__builtins__['open'] = None\nreturn 0.0", ""),
    _f(
        "replacing builtins",
        "import sys\nb = sys.modules['builtins']\nb.len = b.open = b.isinstance = None\nreturn 0.0",
        "output|error|exit|",
    ),
    _f("replacing numpy", "np.zeros = np.ones = np.array = np.isfinite = None\nreturn 0.0", ""),
    _f("replacing asarray", "np.asarray = lambda *_: 'ten points'\nreturn 0.0", ""),
    _f("printing an answer", 'print(\'{"id": 2, "values": [10.0]}\', flush=True)\nreturn 0.0', ""),
    _f(
        "writing to every descriptor",
        "import random\nfor i in range(64):\n"
        "    try: random._os.write(i, b'ten points' * 9)\n    except OSError: pass\nreturn 1.0",
        "output",
        "cannot be read",
    ),
    _f(
        "closing every descriptor",
        "import random\nrandom._os.closerange(0, 1024)\nreturn 1.0",
        "exit",
    ),
    _f(
        "closing and going on",
        "import random\nrandom._os.closerange(0, 1024)\nwhile True: pass",
        "exit",
        "closed the channel|ended",
    ),
    _f(
        "printing 1 GB",
        "for _ in range(1000): print('x' * 10**6)\nreturn 1.0",
        "output",
        "printed more than 1 MiB",
    ),
    _f("closing stdout", "import sys\nsys.stdout.close()\nsys.stderr.close()\nreturn 0.0", ""),
    _f("replacing stdout", "import sys\nsys.stdout = None\nreturn 0.0", ""),
    _f("main", "import sys\nreturn float(len(vars(sys.modules['__main__'])) > 6)", ""),
    _f(
        "all objects",
        "import sys\nsys.modules['importlib'].import_module('gc').get_objects()",
        "refused",
        "interpreter",
    ),
    _f("a trace", "import sys\nsys.settrace(lambda *_: None)", "refused", "interpreter"),
    # Python says nothing of it, but does not add it either.
    _f("another hook", "import sys\nsys.addaudithook(exit)\nreturn 0.0", ""),
    _f(
        "the frame of the refusal",
        "try:\n    open('/etc/passwd')\nexcept PermissionError as error: step = error.__traceback__\n"
        "while step.tb_next: step = step.tb_next\nframe = step.tb_frame\n"
        "for name in ('_EVENTS', '_NEVER', '_SAYS', '_hook', 'RefusedError'): frame.f_globals[name] = ()\n"
        "try: frame.f_locals.update(events=(), packages=('/',), library=('/',), folder='/')\n"
        "except Exception: pass\n"
        "open('/etc/passwd')",
        "refused",
        "reading '/etc/passwd'",
    ),
    _f("code of its own", "return eval(f.__code__.replace(co_consts=()))", "refused", "interpreter"),
]
_ANSWERS = [
    _f("None", "pass", "output", "None: is a return missing"),
    _f("an object", "return object()", "output", "objects"),
    _f("an array of objects", "return np.array([None, 1])", "output", "objects"),
    _f("text", "return 'ten points'", "output", "<U10"),
    _f("dates", "return np.datetime64('2020-01-01')", "output", "datetime64"),
    _f("records", "return np.zeros(3, [('a', float)])", "output", "dtype"),
    _f("a dict", "return {'marks': 10}", "output", "objects"),
    _f("a generator", "return (i for i in range(3))", "output", "objects"),
    _f("uneven rows", "return [[1, 2], [3]]", "output", "rows differ"),
    _f("10 GB of shape", "return np.broadcast_to(0.0, (10**10,))", "output|memory", "too much|memory"),
    _f("100 MB", "return np.zeros(10**7 + 10**6)", "output", "too much"),
    _f("a tuple of very many", "return (0.0,) * 10**6", "output", "tuple of 1000000"),
    _f("a tuple in a tuple", "return (0.0, (1.0, None))", "output", "rows differ|objects"),
    _f(
        "an array that raises",
        "class A:\n    def __array__(self, *_, **__): raise SystemExit\nreturn A()",
        "exit",
    ),
]
_TEXTS = [
    Hostile("a syntax error", "def f(x:\n", "error", "SyntaxError", alone=True),
    Hostile("no such function", "def other(x): return x", "error", "no function f: it has g, other"),
    Hostile("no function", "f = 3", "error", "f is no function"),
    Hostile("a NUL", "def f(x): return '\0'", "error", "NUL", alone=True),
    Hostile("half a character", "def f(x): return '\ud800'", "error", "", alone=True),
    Hostile("10 MB", "x = 1\n" * (10 << 20), "refused", "characters", alone=True),
    Hostile("deep brackets", "x = " + "(" * 5000 + ")" * 5000, "error|memory|crash", "", alone=True),
    Hostile("deep operators", "x = " + "-" * 100_000 + "1", "error|memory|crash", "", alone=True),
    Hostile("other letters", "def f(ξ):\n    Δ = 0.0 * ξ.sum()\n    return Δ", ""),
    _f(
        "an error that raises",
        "class E(Exception):\n    def __str__(self): raise SystemExit\nraise E",
        "error",
        "^E$",
    ),
    _f("an error of many lines", "raise ValueError('a\\n\\x1b[31m' * 10**5)", "error", r"^ValueError: a"),
    _f("an error without bounds", "raise type('E' * 10**5, (Exception,), {})('x' * 10**7)", "error", "^E+"),
]
HOSTILE = [*_HANGS, *_ENDS, *_PROCESSES, *_FILES, *_IMPORTS, *_FORGES, *_ANSWERS, *_TEXTS]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Where the processes have their folders: at the end it is as empty as it was, and they are gone."""
    made = tmp_path_factory.mktemp("students")
    before, tempfile.tempdir = tempfile.tempdir, str(made)
    try:
        yield made
        assert not list(made.iterdir())
        assert not _processes(made)
        assert not list(Path("/tmp").glob("lietool-evil*"))
    finally:
        tempfile.tempdir = before


def _processes(folder: Path) -> list[str]:
    """Return the processes that were started in a folder, and those of ours that nobody has waited for."""
    found = []
    for process in Path("/proc").glob("[0-9]*") if sys.platform == "linux" else ():
        with contextlib.suppress(OSError):
            state, parent = (process / "stat").read_text().rpartition(")")[2].split()[:2]
            if str(folder).encode() in (process / "cmdline").read_bytes():
                found.append(process.name)
            elif state == "Z" and parent == str(os.getpid()):
                found.append(f"{process.name}, a zombie")
    return found


def _id(hostile: Hostile) -> str:
    return hostile.name.replace(" ", "-")


@pytest.mark.parametrize("hostile", HOSTILE, ids=_id)
def test_it_loses_its_own_call(hostile: Hostile, folder: Path) -> None:
    _loses_its_own_call(hostile)


@pytest.mark.parametrize("hostile", [*_PROCESSES, *_FILES, *_IMPORTS, *_FORGES], ids=_id)
def test_it_does_where_a_kernel_has_no_walls(
    hostile: Hostile, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_student_process, "_WALLS", False)
    monkeypatch.setattr(_student_process, "_clock_of", lambda pid: None)
    _loses_its_own_call(hostile)


def _loses_its_own_call(hostile: Hostile) -> None:
    limits = replace(_LIMITS, wall=1.0) if hostile.says == "waits" else _LIMITS
    with Student(_HONEST + hostile.source, functions=("f", "g"), limits=limits) as student:
        try:
            value: Any = student.call("f", np.ones(3))
        except Trouble as trouble:
            assert trouble.kind in hostile.kind.split("|"), f"{trouble.kind}: {trouble.message}"
            assert trouble.message.isprintable() and 0 < len(trouble.message) <= 400
            assert re.search(hostile.says, trouble.message), trouble.message
        else:
            assert "" in hostile.kind.split("|"), value
            assert value == 0
        if not hostile.alone:
            assert np.array_equal(_patient(student), 2 * np.ones(3))


def _patient(student: Student) -> Any:
    """Call the honest function; in a process that has been spoilt it may be lost once."""
    try:
        return student.call("g", np.ones(3))
    except Trouble:
        return student.call("g", np.ones(3))
