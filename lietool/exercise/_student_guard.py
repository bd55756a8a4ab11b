"""What a student's file may import and do, as Python sees it: the refusals that say why.

They are words, not walls: who knows the interpreter gets round them.  The walls are in `_student_kernel`.
"""

import builtins
import os
import sys
from collections.abc import Mapping, Sequence
from typing import Any


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# What a function of an exercise can sensibly want of the standard library.
_PLAIN = _words("""
    __future__ abc array bisect cmath collections contextlib copy dataclasses decimal enum fractions functools
    heapq io itertools json math numbers numpy operator pprint random re statistics string struct sys textwrap
    time types typing typing_extensions warnings
""")
# Refused to everyone, also to a module of the library that a student has reached through another: no event
# tells what they do.
_NEVER = _words("""
    _ctypes _curses _interpreters _multiprocessing _posixshmem _testcapi _testinternalcapi _testlimitedcapi
    _xxinterpchannels _xxsubinterpreters ctypes fcntl mmap readline resource
""")
_ALONE = "an exercise is to be written with numpy alone"
_WORKS = "a function of an exercise works from its arguments alone"
# What is done with them is looked at below, or does no harm.
_EVENTS = _words("""
    import open os.listdir os.scandir compile exec marshal.loads array.__new__ builtins.id builtins.input
    builtins.input/result function.__new__ object.__getattr__ object.__setattr__ object.__delattr__
    sys._getframe sys._getframemodulename sys.excepthook sys.unraisablehook time.sleep
    cpython._PySys_ClearAuditHooks cpython.PyInterpreterState_Clear
""")
# The beginnings of the others, as a student would say them.
_SAYS = (
    (("os.fork", "os.exec", "os.posix_spawn", "os.spawn", "os.system", "os.startfile"), "starting a process"),
    (("subprocess", "pty", "cpython.PyInterpreterState_New"), "starting a process"),
    (("_thread",), "starting a thread"),
    (("socket", "urllib", "http", "ftplib", "smtplib", "webbrowser"), "the network"),
    (("os.kill", "signal"), "sending a signal"),
    (("ctypes", "mmap"), "memory of its own"),
    (("os.", "shutil", "tempfile", "glob", "pathlib"), "what is done to files"),
    (("gc.", "sys.", "code."), "looking into the interpreter"),
)


class RefusedImportError(ModuleNotFoundError):
    """A module that a student's file is not to import."""


class RefusedError(PermissionError):
    """Something that a student's function is not to do."""


REFUSALS = (RefusedImportError, RefusedError)


def hide_ctypes() -> None:
    """Take away ctypes, before numpy is imported: numpy goes without, and nobody finds it there."""
    for name in [name for name in sys.modules if name.split(".")[0] in ("ctypes", "_ctypes")]:
        del sys.modules[name]
    # An import finds None and goes no further.
    sys.modules["ctypes"] = sys.modules["_ctypes"] = None  # type: ignore[assignment]


def builtins_for_a_student(allowed: Sequence[str]) -> dict[str, Any]:
    """Return the builtins of a student's module: its imports are looked at."""
    true_import = builtins.__import__

    def guarded(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> Any:
        if level == 0 and not _may(name, allowed):
            raise RefusedImportError(f"{name} is refused: {_ALONE}", name=name)
        return true_import(name, globals, locals, fromlist or (), level)

    # What site brings to others.
    return {**builtins.__dict__, "__import__": guarded, "exit": sys.exit, "quit": sys.exit}


def _may(name: str, allowed: Sequence[str]) -> bool:
    # `import scipy` where scipy.sparse is allowed comes of `import scipy.sparse` too.
    return name.split(".")[0] in _PLAIN or any(
        name == module or name.startswith(module + ".") for module in allowed
    )


class _Finder:
    """Stands before all that find modules, and lets through numpy, the library and what is allowed."""

    def __init__(self, allowed: Sequence[str]) -> None:
        tops = {"numpy", *(name.split(".")[0] for name in allowed)}
        self._known = frozenset(sys.stdlib_module_names) - _NEVER
        self._tops = frozenset(tops)
        # Of a package that is allowed in part: what it has imported itself, and what is in there.
        self._parts = frozenset(name for name in sys.modules if name.split(".")[0] in tops)

    def find_spec(self, name: str, path: object = None, target: object = None) -> None:
        """Refuse a module, or leave it to the next."""
        top, _, rest = name.partition(".")
        if top in self._known or top == "numpy" or top.startswith("_sysconfigdata"):
            return
        if top in self._tops and (
            not rest or rest.startswith("_") or f"{top}.{rest.split('.')[0]}" in self._parts
        ):
            return
        raise RefusedImportError(f"{name} is refused: {_ALONE}", name=name)


def stand(settings: dict[str, Any]) -> None:
    """Put the finder and the audit hook in their places.

    Parameters
    ----------
    settings : dict
        With "allowed", "packages", "library" and "folder" as `lietool.exercise.student` gives them.
    """
    sys.path[:] = settings["library"]
    sys.meta_path.insert(0, _Finder(settings["allowed"]))
    # Of these Python tells its hooks from 3.12 on.
    for name in ("_thread", "threading"):
        for start in ("start_new_thread", "start_new", "start_joinable_thread"):
            for place in (start, f"_{start}"):
                if hasattr(sys.modules.get(name), place):
                    setattr(sys.modules[name], place, _no_thread)
    sys.addaudithook(_hook(settings))


def _no_thread(*_: object, **__: object) -> None:
    raise RefusedError(f"starting a thread is refused: {_WORKS}")


def _hook(settings: dict[str, Any]) -> Any:
    """Return the audit hook.

    What it needs it has as defaults of its arguments: what a module or a cell holds can be changed by who
    finds its frame in a traceback, and these cannot.
    """
    packages, library = (tuple(f"{path}/" for path in settings[name]) for name in ("packages", "library"))
    hidden = tuple(f"{path}{name}/" for path in library for name in ("site-packages", "dist-packages"))

    def hook(
        event: str,
        args: tuple[Any, ...],
        folder: str = f"{settings['folder']}/",
        packages: tuple[str, ...] = packages,
        library: tuple[str, ...] = library,
        hidden: tuple[str, ...] = hidden,
        writing: int = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND,
        table: tuple[Any, ...] = (_EVENTS, _NEVER, _SAYS, _ALONE, _WORKS, RefusedError, RefusedImportError),
        tools: tuple[Any, ...] = (isinstance, str, bytes, str.startswith),
    ) -> None:
        events, never, says, alone, works, refused, refused_import = table
        is_a, text, raw, starts = tools
        if event not in events:
            for beginnings, words in says:
                if starts(event, beginnings):
                    raise refused(f"{words} is refused: {works}")
            raise refused(f"{event} is refused: {works}")
        if event == "import":
            if args[0] in never:
                raise refused_import(f"{args[0]} is refused: {alone}")
            path, flags = args[1], 0
            if path is None:
                return
        elif event == "open":
            path, flags = args[0], args[2]
        elif event == "os.listdir" or event == "os.scandir":
            path, flags = "." if args[0] is None else args[0], 0
        else:
            return
        if is_a(path, raw):
            path = raw.decode(path, "utf-8", "surrogateescape")
        if not is_a(path, text):
            raise refused(f"opening a file by its number is refused: {works}")
        # A text of the exact type: a student's own kind of text may begin with whatever it likes.
        given = text.join("", (path,))
        full = (given if starts(given, "/") else folder + given) + "/"
        writes = flags & writing
        if "/../" in full or not (
            starts(full, folder)
            or (not writes and starts(full, packages))
            or (not writes and starts(full, library) and not starts(full, hidden))
        ):
            verb = "writing" if writes else "reading"
            raise refused(f"{verb} {given!r} is refused: {works}")

    return hook
