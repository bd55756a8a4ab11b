"""The walls around a student's process without the words, and what a killed grader leaves behind."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

from lietool import paths
from lietool.exercise import _student_folder
from lietool.exercise.student import Student

_GRADER = """
import sys, tempfile
tempfile.tempdir = sys.argv[1]
from lietool.exercise.student import Limits, Student
LOOP = "def f(x):\\n    while True: pass"
with Student(LOOP, functions=["f"], limits=Limits(cpu=100, wall=100)) as student:
    print(student._process._process.pid, flush=True)
    student.call("f", 1.0)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends a busy process with its parent")
def test_a_grader_that_is_killed_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    environment = {**os.environ, "PYTHONPATH": str(paths.PACKAGE.parent)}
    with subprocess.Popen(
        [sys.executable, "-c", _GRADER, str(tmp_path)], stdout=subprocess.PIPE, text=True, env=environment
    ) as grader:
        assert grader.stdout is not None
        pid = int(grader.stdout.readline())
        # Until it is in its loop.
        time.sleep(0.5)
        grader.kill()
    assert _is_gone(pid)
    (left,) = tmp_path.iterdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    # The next one removes it, unless it is so young that its owner may be about to lock it.
    _student_folder._sweep.cache_clear()
    _starts_another()
    assert left.exists()
    _student_folder._sweep.cache_clear()
    os.utime(left, (0, 0))
    with Student("def f(x): return x", functions=["f"]):
        assert not left.exists()
        (lives,) = tmp_path.iterdir()
        os.utime(lives, (0, 0))
        _student_folder._sweep.cache_clear()
        _starts_another()
        assert lives.exists()
    assert not list(tmp_path.iterdir())


def _starts_another() -> None:
    with Student("def f(x): return x", functions=["f"]) as student:
        assert student.call("f", 1.0) == 1


def _is_gone(pid: int) -> bool:
    for _ in range(100):
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            return True
        # Of one that nobody waits for.
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


_WALLED = """
import os, sys, importlib.machinery, types
import socket, threading, signal, mmap
sys.path.append(sys.argv[2])
import numpy as np
path = sys.argv[1] + "/exercise/_student_kernel.py"
kernel = types.ModuleType("kernel")
exec(compile(open(path).read(), path, "exec"), kernel.__dict__)
folder = sys.argv[3]
os.chdir(folder)
library = [path for path in sys.path if "site-packages" not in path]
print(*kernel.walls({"packages": [np.__path__[0]], "library": library, "folder": folder}))
def fork():
    if not os.fork(): os._exit(0)
tries = dict(
    reference=lambda: open(sys.argv[1] + "/lie/so3.py"), passwords=lambda: open("/etc/passwd"),
    listing=lambda: os.listdir("/"), above=lambda: open("../above", "w"), etc=lambda: open("/dev/shm/x", "w"),
    remove=lambda: os.remove(path), fork=fork, spawn=lambda: os.posix_spawn("/bin/true", ["true"], {}),
    execute=lambda: os.execv("/bin/true", ["true"]), network=lambda: socket.socket(),
    pair=lambda: socket.socketpair(), kill=lambda: os.kill(os.getppid(), 0), group=lambda: os.killpg(0, 0),
    thread=lambda: threading.Thread(target=print).start(), memory=lambda: os.memfd_create("x"),
    folder=lambda: os.mkdir("sub"), link=lambda: os.symlink("/", "root"), session=lambda: os.setsid(),
    limits=lambda: __import__("resource").setrlimit(7, (64, 64)), nice=lambda: os.nice(-1),
    root=lambda: os.chroot("/"), user=lambda: os.setuid(0), own=lambda: open("own", "w").write("x"),
    numpy=lambda: np.linalg.svd(np.ones((300, 300))), fft=lambda: __import__("numpy.fft"),
    library=lambda: __import__("statistics"), self=lambda: os.abort if os.getpid() else None,
)
for name, attempt in tries.items():
    try:
        attempt()
        print(name, "done")
    except (OSError, RuntimeError, ValueError) as error:
        print(name, "refused")
    except BaseException as error:
        print(name, type(error).__name__, error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the walls are Linux's")
def test_the_walls_stand_without_the_words(tmp_path: Path) -> None:
    folder = tmp_path / "own"
    folder.mkdir()
    site = Path(np.__file__).parent.parent
    done = subprocess.run(
        [sys.executable, "-S", "-c", _WALLED, str(paths.PACKAGE), str(site), str(folder)],
        capture_output=True,
        text=True,
        env={"OPENBLAS_NUM_THREADS": "1"},
        timeout=60,
    )
    first, *lines = done.stdout.splitlines()
    assert done.returncode == 0, done.stderr
    if first.split() != ["files", "calls"]:
        pytest.skip(f"this kernel has only: {first or 'none'}")
    came = dict(line.split(maxsplit=1) for line in lines)
    open_to_it = {"own", "numpy", "fft", "library", "self"}
    assert {name for name, what in came.items() if what == "done"} == open_to_it
    assert {what for name, what in came.items() if name not in open_to_it} == {"refused"}
    assert [path.name for path in tmp_path.iterdir()] == ["own"]
