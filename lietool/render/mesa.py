"""What Mesa reads from the environment while it starts, and what it tells about itself afterwards."""

import contextlib
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import moderngl

from lietool import cache

# Every other width was seen to crash Mesa 22.3 as soon as it compiles a shader.
VECTOR_WIDTHS = ("128", "256")

# What OSMesa and EGL on a software device can be; they crash when they are told of another driver.
_SOFTWARE = ("llvmpipe", "softpipe")
# With less than they are, they crash or refuse.
_OVERRIDES = ("MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE", "MESA_EXTENSION_OVERRIDE")

# Mesa maps the index of its cache into memory: where the disk cannot hold it, writing kills the process.
_ROOM = 16 * 2**20
_DRIVER, _WIDTH = "GALLIUM_DRIVER", "LP_NATIVE_VECTOR_WIDTH"
_SHADERS, _LOG = "MESA_SHADER_CACHE_DIR", "EGL_LOG_LEVEL"
_LIBRARIES = re.compile(r"lib(OSMesa|E?GL|glapi|gallium|LLVM|nvidia|Open)|(_dri|_drv)\.so")


def settings(*, software: bool = True) -> tuple[dict[str, str | None], list[str]]:
    """Return the variables that Mesa must find while it starts (None: unset), and what to tell about them.

    Parameters
    ----------
    software : bool
        Whether it will render on the processor, which cannot be any driver of Mesa's.

    Returns
    -------
    dict
        By variable; those that the user has set well are not in it.
    list of str
        One sentence for each setting of the user's that is overridden.
    """
    wanted: dict[str, str | None] = {}
    notes: list[str] = []
    width = os.environ.get(_WIDTH)
    if width is not None and width not in VECTOR_WIDTHS:
        notes.append(f"{_WIDTH}={width} would crash Mesa and is ignored; {' and '.join(VECTOR_WIDTHS)} work")
        wanted[_WIDTH] = width = None
    if software:
        driver = os.environ.get(_DRIVER)
        if driver and driver not in _SOFTWARE:
            notes.append(f"{_DRIVER}={driver} is no software renderer and is ignored")
            wanted[_DRIVER] = None
        for name in _OVERRIDES:
            if name in os.environ:
                notes.append(f"{name}={os.environ[name]} could crash Mesa and is ignored")
                wanted[name] = None
    if _SHADERS not in os.environ:
        # Mesa's cache does not tell vector widths apart, so each has a folder of its own.
        folder = cache.folder(f"shaders-{width}" if width else "shaders")
        wanted |= {} if folder is None else {_SHADERS: str(folder)}
        if folder and shutil.disk_usage(folder).free < _ROOM:
            notes.append(f"the disk of {folder} is full; compiled shaders are not kept")
            wanted["MESA_SHADER_CACHE_DISABLE"] = "true"
    if _LOG not in os.environ:
        # A backend that does not work is reported by us, in one line, if none works.
        wanted[_LOG] = "fatal"
    return wanted, notes


@contextlib.contextmanager
def environment(variables: Mapping[str, str | None]) -> Iterator[None]:
    """Set variables (None: unset) and put them back afterwards, for no child process should inherit them.

    Parameters
    ----------
    variables : mapping
        By name.
    """
    before = {name: os.environ.get(name) for name in variables}
    _assign(variables)
    try:
        yield
    finally:
        _assign(before)


def describe(gl: moderngl.Context) -> dict[str, Any]:
    """Return what draws, ready for JSON.

    Parameters
    ----------
    gl : moderngl.Context
        A context, current.

    Returns
    -------
    dict
        ``vendor``, ``renderer``, ``version`` as OpenGL gives them; ``mesa``, ``llvm`` (versions) and
        ``bits`` (vector width), None where they are not told; ``libraries``, paths of what is loaded.
    """
    vendor, renderer, version = (gl.info[f"GL_{name}"] for name in ("VENDOR", "RENDERER", "VERSION"))
    mesa, llvm = re.search(r"Mesa (\S+)", version), re.search(r"LLVM ([\d.]+)", renderer)
    bits = re.search(r"(\d+) bits", renderer)
    return {
        "vendor": vendor,
        "renderer": renderer,
        "version": version,
        "mesa": mesa and mesa[1],
        "llvm": llvm and llvm[1],
        "bits": bits and int(bits[1]),
        "libraries": libraries(),
    }


def libraries(maps: Path = Path("/proc/self/maps")) -> list[str]:
    """Return the paths of the OpenGL libraries that this process has really loaded.

    Parameters
    ----------
    maps : Path
        Linux's list of mapped files.

    Returns
    -------
    list of str
        In alphabetical order; empty where the system does not tell.
    """
    try:
        lines = maps.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return []
    paths = {line.split(maxsplit=5)[5] for line in lines if "/" in line}
    return sorted(path for path in paths if _LIBRARIES.search(Path(path).name))


def _assign(variables: Mapping[str, str | None]) -> None:
    for name, value in variables.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
