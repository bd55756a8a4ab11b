"""OpenGL in memory by libOSMesa: no display, no device, no driver to choose."""

import ctypes
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

NAMES = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libOSMesa.8.dylib")

_RGBA, _UNSIGNED_BYTE = 0x1908, 0x1401
_FORMAT, _DEPTH_BITS, _STENCIL_BITS, _ACCUM_BITS = 0x22, 0x30, 0x31, 0x32
_PROFILE, _CORE_PROFILE = 0x33, 0x34
_CONTEXT_MAJOR, _CONTEXT_MINOR = 0x36, 0x37

Open = Callable[[str], ctypes.CDLL]


def private_folders() -> list[Path]:
    """Return the library folders under ``sys.prefix/sys``, where ``run`` unpacks packages without root.

    Returns
    -------
    list of Path
        Existing folders, in a fixed order.
    """
    root = Path(sys.prefix, "sys")
    patterns = ("usr/lib/*-linux-gnu*", "lib/*-linux-gnu*", "usr/lib64", "lib64", "usr/lib")
    return [path for pattern in patterns for path in sorted(root.glob(pattern)) if path.is_dir()]


def load(folders: Sequence[Path] | None = None, open_library: Open = ctypes.CDLL) -> ctypes.CDLL:
    """Load libOSMesa from the system, else from private folders.

    Parameters
    ----------
    folders : sequence of Path, optional
        Where to look when the system has none; `private_folders()` if not given.
    open_library : callable
        What opens a library by its name or path; raises OSError when it cannot.

    Returns
    -------
    ctypes.CDLL
        The library.

    Raises
    ------
    OSError
        If no copy can be loaded; the message says why the first one could not.
    """
    folders = private_folders() if folders is None else folders
    failures: list[OSError] = []
    for name in NAMES:
        try:
            return open_library(name)
        except OSError as error:
            failures.append(error)
    for folder in folders:
        for path in (folder / name for name in NAMES):
            if path.is_file():
                try:
                    return _load_with_dependencies(path, folders, open_library)
                except OSError as error:
                    failures.insert(0, error)
    raise failures[0]


def _load_with_dependencies(path: Path, folders: Sequence[Path], open_library: Open) -> ctypes.CDLL:
    # The dynamic linker looks for dependencies in the system's folders only, but takes any library
    # of the right soname that is already loaded. So what it misses is loaded first, by its path.
    tried: set[str] = set()

    def attempt(target: Path) -> ctypes.CDLL:
        while True:
            try:
                return open_library(str(target))
            except OSError as error:
                missing = re.search(r"(?:^|\s)([\w.+-]+\.so[\w.]*)\b", str(error))
                name = missing[1] if missing else ""
                found = next((f / name for f in folders if name and (f / name).is_file()), None)
                if found is None or name in tried:
                    raise
                tried.add(name)
                attempt(found)

    return attempt(path)


class Loader:
    """An OSMesa context as moderngl wants it.

    Parameters
    ----------
    library : ctypes.CDLL
        libOSMesa.

    Raises
    ------
    OSError
        If the library is too old or refuses a core profile of OpenGL 3.3.
    """

    def __init__(self, library: ctypes.CDLL) -> None:
        try:
            create, self._make_current = library.OSMesaCreateContextAttribs, library.OSMesaMakeCurrent
            self._address, self._destroy = library.OSMesaGetProcAddress, library.OSMesaDestroyContext
        except AttributeError as error:
            raise OSError(f"libOSMesa is too old: {error}") from None
        create.restype, create.argtypes = ctypes.c_void_p, [ctypes.c_void_p, ctypes.c_void_p]
        self._make_current.restype = ctypes.c_ubyte
        self._make_current.argtypes = [
            *(ctypes.c_void_p, ctypes.c_void_p),
            *(ctypes.c_uint, ctypes.c_int, ctypes.c_int),
        ]
        self._address.restype, self._address.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
        self._destroy.restype, self._destroy.argtypes = None, [ctypes.c_void_p]
        wishes = (
            *(_FORMAT, _RGBA, _DEPTH_BITS, 24, _STENCIL_BITS, 8, _ACCUM_BITS, 0),
            *(_PROFILE, _CORE_PROFILE, _CONTEXT_MAJOR, 3, _CONTEXT_MINOR, 3, 0),
        )
        self._context = create((ctypes.c_int * len(wishes))(*wishes), None)
        if not self._context:
            raise OSError("libOSMesa refused a core profile of OpenGL 3.3")
        # OSMesa draws into memory of ours; ours is never looked at, pictures go to framebuffer objects.
        self._pixels = ctypes.create_string_buffer(4)
        self.__enter__()

    def load_opengl_function(self, name: str) -> int:
        return self._address(name.encode()) or 0

    def __enter__(self) -> "Loader":
        if not self._make_current(self._context, self._pixels, _UNSIGNED_BYTE, 1, 1):
            raise OSError("libOSMesa could not make its context current")
        return self

    def __exit__(self, *_: object) -> None:
        return None

    def release(self) -> None:
        if self._context:
            self._destroy(self._context)
            self._context = None
