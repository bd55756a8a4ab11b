"""One process that a student's file runs in, seen from the grader: started, asked, watched and ended."""

import contextlib
import importlib.util
import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from lietool.exercise import _student_wire as wire
from lietool.exercise._student_folder import Folder
from lietool.exercise._student_trouble import Limits, Trouble, told_by

# So that times, sums and the order of sets do not depend on the machine or the hour.
_ENVIRONMENT = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
    "PYTHONHASHSEED": "0",
    "PYTHONUTF8": "1",
}
# Seconds between two looks at its time and its folder while it computes.
_LOOK = 0.05
# Seconds in which a process must have imported numpy, on whatever machine.
_START = 60.0
# Of what it prints, what is kept, in bytes: a character has up to four.
_KEPT = 16_000
_MOST_FILES = 100
# Seconds in which a process that has closed the channel ends by itself, and says how.
_PATIENCE = 0.5
# How many times as long as it may one lasts that computes, where others have the processor.
_BUSY = 9
# A test takes them away.
_WALLS = True
_CHILD = Path(__file__).with_name("_student_child.py")


class Process:
    """A process that a student's file runs in.

    Parameters
    ----------
    allowed : sequence of str
        The modules that it may import beside numpy.
    limits : Limits
    name : str
        What the student's file is called.
    uses_random : bool
        Whether numpy.random is wanted: it takes a while to import.
    """

    def __init__(self, allowed: Sequence[str], limits: Limits, name: str, uses_random: bool) -> None:
        self.limits, self.printed, self._heard = limits, bytearray(), 0
        self.walls: tuple[str, ...] | None = None
        self.loaded, self._asked = False, 0
        self._late = ""
        self._folder = Folder()
        self._socket, theirs = socket.socketpair()
        told = {
            **asdict(limits),
            "parent": os.getpid(),
            "clock": _clock_of(os.getpid()) is not None,
            "walls": _WALLS,
            "allowed": list(allowed),
            "name": name,
            "folder": self._folder.path,
            "random": uses_random,
            "packages": _packages(("numpy", *(module.split(".")[0] for module in allowed))),
        }
        with theirs:
            try:
                self._process = _started(told, theirs.fileno())
            except BaseException:
                self._socket.close()
                self._folder.remove()
                raise
        assert self._process.stdout is not None
        self._output = self._process.stdout.fileno()
        os.set_blocking(self._output, False)
        self._socket.setblocking(False)
        self._poll = select.poll()
        self._poll.register(self._output, select.POLLIN)
        self._clock = _clock_of(self._process.pid)

    @property
    def lives(self) -> bool:
        """Whether it can be asked."""
        return self._process.returncode is None

    def ready(self) -> None:
        """Wait until numpy is imported and the walls stand.

        Raises
        ------
        RuntimeError
            If that fails: it is no student's fault.
        """
        if self.walls is not None:
            return
        try:
            head, _ = self._exchange(b"", float("inf"), time.monotonic() + _START)
        except Trouble as trouble:
            last = self.printed.decode(errors="replace").strip().splitlines()[-1:] or [trouble.message]
            raise RuntimeError(f"the process for a student's file does not start: {last[0]}") from None
        self.walls = tuple(map(str, head.get("walls") or ()))

    def ask(self, question: dict[str, Any], args: Sequence[Any] = ()) -> list[Any]:
        """Ask for something, and return the values that come; raises Trouble."""
        self.ready()
        self._asked += 1
        message = wire.pack({"id": self._asked, **question}, args)
        cpu, wall = self._cpu() + self.limits.cpu, time.monotonic() + self.limits.wall
        head, values = self._exchange(message, cpu, wall)
        if head.get("id") != self._asked:
            raise self._stopped("output", "it answered what it was not asked")
        if "trouble" in head:
            trouble = told_by(head["trouble"])
            if trouble.kind == "time" or self._late:
                raise self._stopped("time", self._late or self._too_long(), trouble.line)
            raise trouble
        if self._late:
            raise self._stopped("time", self._late)
        return values

    def end(self) -> None:
        """End the process and all that it has started, and remove its folder."""
        if self._socket.fileno() < 0:
            return
        # Also where it is gone itself: its number is its group's, while there is one in that.
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._socket.close()
        assert self._process.stdout is not None
        self._process.stdout.close()
        self._folder.remove()

    def _exchange(self, message: bytes, cpu: float, wall: float) -> tuple[dict[str, Any], list[Any]]:
        """Send a message and return the answer; `_late` says whether the time was over before it came."""
        left, incoming = memoryview(message), wire.Incoming(self.limits.answer)
        number, ends, self._late = self._socket.fileno(), float("inf"), ""
        while True:
            left = left[self._send(left) :]
            self._poll.register(number, select.POLLIN | (select.POLLOUT if left else 0))
            for ready, _ in self._poll.poll(1000 * _LOOK):
                if ready == self._output:
                    self._hear()
                elif self._receive(incoming):
                    self._hear()
                    self._look_in_folder()
                    self._late = self._late or self._lateness(cpu, float("inf"))
                    return self._read(incoming)
            self._look_in_folder()
            if time.monotonic() > ends:
                raise self._stopped("time", self._late)
            if not self._late and (late := self._lateness(cpu, wall)):
                # Python stops there and says where it was; what is deep in numpy hears nothing.
                self._late, ends = late, time.monotonic() + _PATIENCE
                os.kill(self._process.pid, signal.SIGXCPU)

    def _send(self, data: memoryview) -> int:
        try:
            return self._socket.send(data) if data else 0
        except BlockingIOError:
            return 0
        except OSError:
            raise self._died() from None

    def _receive(self, incoming: wire.Incoming) -> bool:
        """Take in what has come of the answer; return whether it is whole."""
        try:
            data = self._socket.recv(1 << 20)
        except BlockingIOError:
            return False
        except OSError:
            data = b""
        if not data:
            raise self._died()
        try:
            return incoming.feed(data)
        except wire.WireError as error:
            raise self._stopped("output", f"it answered something that cannot be read: {error}") from None

    def _read(self, incoming: wire.Incoming) -> tuple[dict[str, Any], list[Any]]:
        try:
            return incoming.message()
        except wire.WireError as error:
            raise self._stopped("output", f"it answered something that cannot be read: {error}") from None

    def _hear(self) -> None:
        """Take in what it has printed."""
        while True:
            try:
                data = os.read(self._output, 1 << 16)
            except BlockingIOError:
                return
            if not data:
                with contextlib.suppress(KeyError):
                    self._poll.unregister(self._output)
                return
            self._heard += len(data)
            self.printed += data[: _KEPT - len(self.printed)]
            if self._heard > self.limits.written:
                raise self._stopped("output", f"it printed more than {_size(self.limits.written)}")

    def _cpu(self) -> float:
        """Return how many seconds of the processor's time it has used."""
        try:
            return self._clock() if self._clock else 0.0
        except OSError:
            return 0.0

    def _lateness(self, cpu: float, wall: float) -> str:
        """Return what is to be said if it has used the time that it has."""
        if self._cpu() > cpu:
            return self._too_long()
        late = time.monotonic() - wall
        if late > 0 and (late > _BUSY * self.limits.wall or not self._computes()):
            return f"it gave no answer in {self.limits.wall:g} s: it waits for something"
        return ""

    def _computes(self) -> bool:
        """Return whether it has the processor, or would have it if that were not busy."""
        try:
            stat = Path(f"/proc/{self._process.pid}/stat").read_text()
        except OSError:
            return False
        # After the name, which may hold anything.
        return stat.rpartition(")")[2].split()[0] == "R"

    def _too_long(self) -> str:
        return f"it took more than {self.limits.cpu:g} s: is there a loop that does not end?"

    def _look_in_folder(self) -> None:
        size, count = self._folder.written()
        if size > self.limits.written or count > _MOST_FILES:
            raise self._stopped("output", f"it wrote more than {_size(self.limits.written)} to files")

    def _stopped(self, kind: str, message: str, line: int | None = None) -> Trouble:
        self.end()
        return Trouble(kind, message, line=line)

    def _died(self) -> Trouble:
        """Return why it has closed the channel."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE)
        code = self._process.returncode
        with contextlib.suppress(Trouble):
            self._hear()
        if self._late:
            return self._stopped("time", self._late)
        if code is None:
            return self._stopped("exit", "it closed the channel to the grader")
        self.end()
        if code >= 0:
            return Trouble("exit", f"it ended its process (exit status {code})")
        if -code == signal.SIGKILL:
            return Trouble("memory", "the system ended it, most likely for the memory that it used")
        with contextlib.suppress(ValueError):
            return Trouble("crash", f"it crashed the interpreter ({signal.Signals(-code).name})")
        return Trouble("crash", f"it crashed the interpreter (signal {-code})")


def _started(told: dict[str, Any], number: int) -> "subprocess.Popen[bytes]":
    # No site: it brings the packages beside numpy, and files that run at the start.
    command = [sys.executable, "-S", "-s", "-P", "-Wignore", str(_CHILD), str(number), json.dumps(told)]
    return subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        bufsize=0,
        cwd=told["folder"],
        env=_ENVIRONMENT,
        pass_fds=(number,),
        start_new_session=True,
    )


def _size(count: int) -> str:
    return f"{count / 2**20:g} MiB"


def _packages(names: Sequence[str]) -> list[str]:
    """Return the folders of packages, and those of their libraries beside them."""
    found: list[str] = []
    for name in dict.fromkeys(names):
        spec = importlib.util.find_spec(name)
        for folder in (spec and spec.submodule_search_locations) or ():
            real = os.path.realpath(folder)
            found += [path for path in (real, f"{real}.libs") if os.path.isdir(path)]  # noqa: PTH112
    return found


def _clock_of(pid: int) -> Callable[[], float] | None:
    """Return what tells the processor's time of a process, or None where nothing does."""
    if sys.platform != "linux":
        return None
    # As clock_getcpuclockid makes it.
    number = (~pid << 3) | 2
    return lambda: time.clock_gettime(number)
