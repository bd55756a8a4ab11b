"""OpenGL without a window by EGL: on a device that is software, on none, or on a GPU."""

import ctypes
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from lietool.render import libraries, mesa

NAMES = ("libEGL.so.1", "libEGL.so")

_MESA, _DRIVER = ("libEGL_mesa.so.0",), ("swrast_dri.so",)
_SOFTWARE = ("llvmpipe", "softpipe")
# Otherwise a surfaceless display takes the first GPU that it sees.
_FORCED = {"LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe"}

_PLATFORM_DEVICE, _PLATFORM_SURFACELESS = 0x313F, 0x31DD
_EXTENSIONS, _NONE, _OPENGL_API, _GL_RENDERER = 0x3055, 0x3038, 0x30A2, 0x1F01
_RENDERABLE_TYPE, _OPENGL_BIT, _SURFACE_TYPE, _PBUFFER_BIT = 0x3040, 0x0008, 0x3033, 0x0001
_CONTEXT_MAJOR, _CONTEXT_MINOR, _PROFILE_MASK, _CORE_PROFILE = 0x3098, 0x30FB, 0x30FD, 0x0001
_MOST_DEVICES = 64

_SIGNATURES = {
    "eglBindAPI": (ctypes.c_uint, ctypes.c_uint),
    "eglChooseConfig": (ctypes.c_uint, *[ctypes.c_void_p] * 3, ctypes.c_int, ctypes.c_void_p),
    "eglCreateContext": (ctypes.c_void_p, *[ctypes.c_void_p] * 4),
    "eglDestroyContext": (ctypes.c_uint, *[ctypes.c_void_p] * 2),
    "eglGetError": (ctypes.c_int,),
    "eglGetProcAddress": (ctypes.c_void_p, ctypes.c_char_p),
    "eglInitialize": (ctypes.c_uint, *[ctypes.c_void_p] * 3),
    "eglMakeCurrent": (ctypes.c_uint, *[ctypes.c_void_p] * 4),
    "eglQueryString": (ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int),
}


class Library:
    """libEGL, with the few functions needed typed.

    Parameters
    ----------
    folders : sequence of Path, optional
        Where to look when the system has none; `libraries.private_folders()` if not given.
    open_library : callable
        What opens a library by its name or path; raises OSError when it cannot.

    Raises
    ------
    OSError
        If there is no libEGL, or it knows nothing of displays without a window.
    """

    def __init__(
        self, folders: Sequence[Path] | None = None, open_library: libraries.Open = ctypes.CDLL
    ) -> None:
        library = libraries.load(NAMES, folders, open_library)
        for name, (result, *arguments) in _SIGNATURES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
        self.call = library
        self._display = self.extension(
            "eglGetPlatformDisplayEXT", ctypes.c_void_p, ctypes.c_uint, *[ctypes.c_void_p] * 2
        )

    def extension(self, name: str, result: type, *arguments: type) -> "ctypes._CFunctionType":
        """Return the extension function `name`; OSError if there is none."""
        address = self.call.eglGetProcAddress(name.encode())
        if not address:
            raise OSError(f"libEGL has no {name}")
        return ctypes.CFUNCTYPE(result, *arguments)(address)

    def devices(self, software: bool) -> Iterator[int]:
        """Yield the handles of the devices that are software, or of those that are not."""
        query = self.extension("eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, *[ctypes.c_void_p] * 2)
        string = self.extension("eglQueryDeviceStringEXT", ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int)
        handles, count = (ctypes.c_void_p * _MOST_DEVICES)(), ctypes.c_int()
        if not query(_MOST_DEVICES, handles, ctypes.byref(count)):
            raise OSError(f"eglQueryDevicesEXT failed with {self.error()}")
        for handle in handles[: count.value]:
            if (b"EGL_MESA_device_software" in (string(handle, _EXTENSIONS) or b"")) == software:
                yield handle

    def display(self, device: int | None) -> int:
        """Return an initialised display on a device, or on none at all (surfaceless)."""
        platform = _PLATFORM_SURFACELESS if device is None else _PLATFORM_DEVICE
        display = self._display(platform, device, None)
        if not display or not self.call.eglInitialize(display, None, None):
            raise OSError(f"libEGL found no driver ({self.error()})")
        return display

    def error(self) -> str:
        """Return the code of the last failure, such as ``0x3001``."""
        return hex(self.call.eglGetError())


class Loader:
    """An EGL context as moderngl wants it.

    Parameters
    ----------
    library : Library
        libEGL.
    device : int or None
        The handle of a device; None for a surfaceless display.

    Raises
    ------
    OSError
        If there is no display, no core profile of OpenGL 3.3, or no context without a surface.
    """

    def __init__(self, library: Library, device: int | None) -> None:
        self._library, call = library, library.call
        self._display = library.display(device)
        wishes = (_RENDERABLE_TYPE, _OPENGL_BIT, _SURFACE_TYPE, _PBUFFER_BIT, _NONE)
        config, count = ctypes.c_void_p(), ctypes.c_int()
        call.eglChooseConfig(self._display, _integers(*wishes), ctypes.byref(config), 1, ctypes.byref(count))
        if not count.value or not call.eglBindAPI(_OPENGL_API):
            raise OSError("EGL offers no desktop OpenGL")
        attributes = (_CONTEXT_MAJOR, 3, _CONTEXT_MINOR, 3, _PROFILE_MASK, _CORE_PROFILE, _NONE)
        self._context = call.eglCreateContext(self._display, config, None, _integers(*attributes))
        if not self._context:
            raise OSError(f"EGL refused a core profile of OpenGL 3.3: {library.error()}")
        self.__enter__()

    def renderer(self) -> str:
        """Return what draws: GL_RENDERER."""
        address = self._library.call.eglGetProcAddress(b"glGetString")
        return (ctypes.CFUNCTYPE(ctypes.c_char_p, ctypes.c_uint)(address)(_GL_RENDERER) or b"").decode()

    def load_opengl_function(self, name: str) -> int:
        return self._library.call.eglGetProcAddress(name.encode()) or 0

    def __enter__(self) -> "Loader":
        if not self._library.call.eglMakeCurrent(self._display, None, None, self._context):
            raise OSError(f"EGL could not make its context current: {self._library.error()}")
        return self

    def __exit__(self, *_: object) -> None:
        return None

    def release(self) -> None:
        if self._context:
            self._library.call.eglMakeCurrent(self._display, None, None, None)
            self._library.call.eglDestroyContext(self._display, self._context)
            self._context = None


def load(software: bool) -> Loader:
    """Return a context on the first device that works: one that is software, or one that is not.

    Parameters
    ----------
    software : bool
        True also tries a surfaceless display, forced to llvmpipe, when no such device works.

    Returns
    -------
    Loader
        Its context is current.

    Raises
    ------
    OSError
        If there is none; the message says why.
    """
    with mesa.environment(_private_mesa() if software else {}):
        return _first(Library(), software)


def _first(library: Library, software: bool) -> Loader:
    failures: list[str] = []
    devices: list[int | None] = []
    try:
        devices += library.devices(software)
    except OSError as error:
        # An EGL that cannot list devices may still have a display on none.
        failures.append(str(error))
    for device in [*devices, *([None] if software else [])]:
        forced = {} if device else {name: value for name, value in _FORCED.items() if name not in os.environ}
        try:
            with mesa.environment(forced):
                loader = Loader(library, device)
        except OSError as error:
            failures.append(str(error))
            continue
        renderer = loader.renderer()
        # A GPU is used only when it is asked for, and then nothing else is.
        if renderer.startswith(_SOFTWARE) == software:
            return loader
        loader.release()
        failures.append(f"EGL gave {renderer}")
    raise OSError(
        "; ".join(dict.fromkeys(failures)) or f"EGL knows no {'software' if software else 'GPU'} device"
    )


def _private_mesa() -> dict[str, str | None]:
    """Load the Mesa that was unpacked without root, and return the variables by which libEGL finds it."""
    folders = libraries.private_folders()
    folder = next((folder for folder in folders if (folder / _MESA[0]).is_file()), None)
    if folder is None:
        return {}
    # libEGL opens it by its name alone, which the linker knows once the library is loaded; so does
    # the driver with what it needs, which lies in a folder of its own in older Mesa.
    libraries.load(_MESA, folders)
    if (folder / "dri" / _DRIVER[0]).is_file():
        libraries.load(_DRIVER, [folder / "dri", *folders])
    places = {
        "__EGL_VENDOR_LIBRARY_DIRS": folder.parents[1] / "share/glvnd/egl_vendor.d",
        "LIBGL_DRIVERS_PATH": folder / "dri",
    }
    return {name: str(place) for name, place in places.items() if name not in os.environ}


def _integers(*values: int) -> ctypes.Array[ctypes.c_int]:
    return (ctypes.c_int * len(values))(*values)
