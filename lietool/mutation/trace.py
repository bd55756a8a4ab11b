"""Which lines of the subjects a piece of work executes, from the import on."""

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from lietool import paths
from lietool.mutation.hook import SUBJECTS

Lines = dict[str, set[int]]


@contextlib.contextmanager
def lines(package: Path = paths.PACKAGE) -> Iterator[Lines]:
    """Collect the lines that run meanwhile in this thread.

    Parameters
    ----------
    package : Path
        The folder of the package that the subjects are in.

    Yields
    ------
    dict of set of int
        By module; filled when it ends.
    """
    folders = tuple(str(package.joinpath(*subject.split(".")[1:])) + os.sep for subject in SUBJECTS)
    # By code object, since a look at the file name of every call takes longer than most calls.
    seen: dict[CodeType, set[int]] = {}
    others: set[CodeType] = set()

    def call(frame: FrameType, event: str, argument: Any) -> Any:
        code = frame.f_code
        if code in others:
            return None
        if code not in seen:
            if not code.co_filename.startswith(folders):
                others.add(code)
                return None
            seen[code] = set()
        add = seen[code].add
        add(frame.f_lineno)

        def line(frame: FrameType, event: str, argument: Any) -> Any:
            if event == "line":
                add(frame.f_lineno)
            return line

        return line

    found: Lines = {}
    before = sys.gettrace()
    sys.settrace(call)
    try:
        yield found
    finally:
        sys.settrace(before)
        for code, numbers in seen.items():
            words = Path(code.co_filename).relative_to(package).with_suffix("").parts
            found.setdefault(".".join(("lietool", *words)), set()).update(numbers)
