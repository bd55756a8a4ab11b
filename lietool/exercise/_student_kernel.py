"""What a student's process may do, as the operating system sees it: limits, and on Linux two walls.

A wall stays where it is whatever the process does to its interpreter.  Landlock leaves it the files of Python
and numpy to read, and its own folder; a filter of system calls leaves it those of computing.  Where a kernel
has neither, the limits are left, and the refusals of `_student_guard`.
"""

import contextlib
import importlib
import os
import signal
import struct
import sys
from collections.abc import Iterable, Sequence
from typing import Any

# Python can be without.
_ctypes: Any = None
_C: Any = None
with contextlib.suppress(ImportError, OSError):
    _ctypes = importlib.import_module("ctypes")
    _C = _ctypes.CDLL(None, use_errno=True)

_PR_SET_PDEATHSIG, _PR_SET_NO_NEW_PRIVS, _PR_SET_SECCOMP = 1, 38, 22


def follow(parent: int) -> None:
    """See to it that this process ends with the one that started it, which may be killed."""
    if _C is None or sys.platform != "linux":
        return
    _C.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(0)


def limit(settings: dict[str, Any]) -> None:
    """Set the limits of this process.

    Parameters
    ----------
    settings : dict
        With "memory" in bytes beyond what is used now, "files" and "written" in bytes, as
        `lietool.exercise.student.Limits`.
    """
    import resource

    wanted = {
        "RLIMIT_CORE": 0,
        "RLIMIT_FSIZE": settings["written"],
        "RLIMIT_NOFILE": settings["files"],
        "RLIMIT_NPROC": 0,
        "RLIMIT_AS": _used() + settings["memory"],
        # Seconds in all: the grader has ended it long before, if it was not killed itself.
        "RLIMIT_CPU": 3600,
    }
    for name, most in wanted.items():
        # One that a system does not have, or does not let us set, is left out.
        with contextlib.suppress(AttributeError, OSError, ValueError):
            number = getattr(resource, name)
            hard = resource.getrlimit(number)[1]
            most = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(number, (most, most))


def _used() -> int:
    """Return how many bytes of addresses are in use."""
    try:
        with open("/proc/self/statm") as file:  # noqa: PTH123
            return int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 1 << 30


def walls(settings: dict[str, Any]) -> list[str]:
    """Put up what walls this kernel has.

    Parameters
    ----------
    settings : dict
        With "packages", "library" and "folder".

    Returns
    -------
    list of str
        Those that stand: "files", "calls".
    """
    if _C is None or sys.platform != "linux":
        return []
    _C.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    files, calls = _wall_files(settings), _wall_calls()
    return [name for name, stands in (("files", files), ("calls", calls)) if stands]


def _of_library(folders: Sequence[str]) -> Iterable[str]:
    """Yield what the standard library is made of: others' packages lie in its folder too."""
    for folder in folders:
        with contextlib.suppress(OSError):
            for entry in os.scandir(folder):
                if entry.name not in ("site-packages", "dist-packages"):
                    yield entry.path


# Of linux/landlock.h.
_EXECUTE, _WRITE, _READ, _LIST, _MAKE, _TRUNCATE = 1, 1 << 1, 1 << 2, 1 << 3, 1 << 8, 1 << 14
_CREATE_RULESET, _ADD_RULE, _RESTRICT = 444, 445, 446
# How many rights each version knows.
_KNOWN = {1: 13, 2: 14, 3: 15, 4: 15}


def _wall_files(settings: dict[str, Any]) -> bool:
    version = _C.syscall(_CREATE_RULESET, None, 0, 1)
    if version < 1:
        return False
    known = (1 << _KNOWN.get(version, 16)) - 1
    # From the fourth on also the network, to bind and to connect; from the sixth on signals to others.
    attributes = struct.pack("QQQ", known, 3, 3)[: 24 if version >= 6 else 16 if version >= 4 else 8]
    rules = _C.syscall(_CREATE_RULESET, attributes, len(attributes), 0)
    if rules < 0:
        return False
    try:
        for path in (*settings["packages"], *_of_library(settings["library"])):
            _allow(rules, path, _READ | _LIST)
        for path in settings["library"]:
            # To find a module in.
            _allow(rules, path, _LIST)
        _allow(rules, settings["folder"], (_READ | _WRITE | _LIST | _MAKE | _TRUNCATE) & known)
        return _C.syscall(_RESTRICT, rules, 0) == 0
    finally:
        os.close(rules)


def _allow(rules: int, path: str, rights: int) -> None:
    try:
        number = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    if not os.path.isdir(path):  # noqa: PTH112
        rights &= _READ | _WRITE | _TRUNCATE
    _C.syscall(_ADD_RULE, rules, 1, struct.pack("=Qi", rights, number), 0)
    os.close(number)


# The numbers of the calls of computing, on x86_64 and on aarch64 (-1: it has none).
_CALLS = {
    "read": (0, 63),
    "write": (1, 64),
    "open": (2, -1),
    "close": (3, 57),
    "stat": (4, -1),
    "fstat": (5, 80),
    "lstat": (6, -1),
    "poll": (7, -1),
    "lseek": (8, 62),
    "mmap": (9, 222),
    "mprotect": (10, 226),
    "munmap": (11, 215),
    "brk": (12, 214),
    "rt_sigaction": (13, 134),
    "rt_sigprocmask": (14, 135),
    "rt_sigreturn": (15, 139),
    "ioctl": (16, 29),
    "pread64": (17, 67),
    "pwrite64": (18, 68),
    "readv": (19, 65),
    "writev": (20, 66),
    "access": (21, -1),
    "select": (23, -1),
    "sched_yield": (24, 124),
    "mremap": (25, 216),
    "madvise": (28, 233),
    "dup": (32, 23),
    "nanosleep": (35, 101),
    "getpid": (39, 172),
    "exit": (60, 93),
    "uname": (63, 160),
    "fcntl": (72, 25),
    "ftruncate": (77, 46),
    "getcwd": (79, 17),
    "readlink": (89, -1),
    "gettimeofday": (96, 169),
    "getrlimit": (97, 163),
    "getrusage": (98, 165),
    "sysinfo": (99, 179),
    "times": (100, 153),
    "getuid": (102, 174),
    "getgid": (104, 176),
    "geteuid": (107, 175),
    "getegid": (108, 177),
    "getppid": (110, 173),
    "sigaltstack": (131, 132),
    "gettid": (186, 178),
    "time": (201, -1),
    "futex": (202, 98),
    "sched_getaffinity": (204, 123),
    "getdents64": (217, 61),
    "restart_syscall": (219, 128),
    "clock_gettime": (228, 113),
    "clock_getres": (229, 114),
    "clock_nanosleep": (230, 115),
    "exit_group": (231, 94),
    "openat": (257, 56),
    "newfstatat": (262, 79),
    "readlinkat": (267, 78),
    "faccessat": (269, 48),
    "pselect6": (270, 72),
    "ppoll": (271, 73),
    "getrandom": (318, 278),
    "statx": (332, 291),
    "rseq": (334, 293),
    "close_range": (436, 436),
    "faccessat2": (439, 439),
}
# By machine: its column above, its name for the filter, and its tgkill.
_MACHINES = {"x86_64": (0, 0xC000003E, 234), "aarch64": (1, 0xC00000B7, 131)}
# Of linux/filter.h and linux/seccomp.h: load a word, jump if equal, return; allowed, and refused with EPERM.
_LOAD, _IF_EQUAL, _RETURN = 0x20, 0x15, 0x06
_ALLOWED, _NOT_PERMITTED = 0x7FFF0000, 0x00050001


def _wall_calls() -> bool:
    found = _MACHINES.get(os.uname().machine)
    if found is None or struct.calcsize("P") != 8:
        return False
    column, machine, tgkill = found
    program = [
        (_LOAD, 0, 0, 4),
        (_IF_EQUAL, 1, 0, machine),
        (_RETURN, 0, 0, _NOT_PERMITTED),
        (_LOAD, 0, 0, 0),
    ]
    for numbers in _CALLS.values():
        if numbers[column] >= 0:
            program += [(_IF_EQUAL, 0, 1, numbers[column]), (_RETURN, 0, 0, _ALLOWED)]
    # A process that gives up sends itself a signal; to others it may send none.
    program += [
        (_IF_EQUAL, 0, 3, tgkill),
        (_LOAD, 0, 0, 16),
        (_IF_EQUAL, 0, 1, os.getpid()),
        (_RETURN, 0, 0, _ALLOWED),
        (_RETURN, 0, 0, _NOT_PERMITTED),
    ]
    code = (_ctypes.c_char * (8 * len(program))).from_buffer_copy(
        b"".join(struct.pack("HBBI", *step) for step in program)
    )
    filters = struct.pack("HxxxxxxP", len(program), _ctypes.addressof(code))
    return _C.prctl(_PR_SET_SECCOMP, 2, filters, 0, 0) == 0
