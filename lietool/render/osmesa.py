"""OpenGL in memory by libOSMesa: no display, no device, no driver to choose."""

import ctypes
from collections.abc import Sequence
from pathlib import Path

from lietool.render import libraries

NAMES = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libOSMesa.8.dylib")

_RGBA, _UNSIGNED_BYTE = 0x1908, 0x1401
_FORMAT, _DEPTH_BITS, _STENCIL_BITS, _ACCUM_BITS = 0x22, 0x30, 0x31, 0x32
_PROFILE, _CORE_PROFILE = 0x33, 0x34
_CONTEXT_MAJOR, _CONTEXT_MINOR = 0x36, 0x37


def load(folders: Sequence[Path] | None = None, open_library: libraries.Open = ctypes.CDLL) -> ctypes.CDLL:
    """Load libOSMesa from the system, else from private folders.

    Parameters
    ----------
    folders : sequence of Path, optional
        Where to look when the system has none; `libraries.private_folders()` if not given.
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
    return libraries.load(NAMES, folders, open_library)


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
