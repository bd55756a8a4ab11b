"""The one OpenGL context of a process, from the first library that gives one.

OSMesa first, then EGL on a software device: both are Mesa's llvmpipe and draw
the same pixels.  Nothing outside this package knows where OpenGL comes from.

One process, one context, one thread: OpenGL knows a single current context, and
a newly made one silently takes its place.  Work in parallel belongs to processes
made by ``spawn``, for llvmpipe's threads do not survive a fork.
"""

import contextlib
import os
import sys
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import moderngl

from lietool.render import advice, egl, mesa, osmesa

ENVIRONMENT = "LIETOOL_BACKEND"
BACKENDS = ("osmesa", "egl", "gpu", "system")


class NoRendererError(RuntimeError):
    """Nothing on this machine can render; the message says what to install.

    Parameters
    ----------
    tried : mapping of str
        Why each backend could not be used, in the order tried.
    """

    def __init__(self, tried: Mapping[str, str]) -> None:
        super().__init__(tried)
        self.tried = dict(tried)

    def __str__(self) -> str:
        reasons = "; ".join(f"{backend}: {reason}" for backend, reason in self.tried.items())
        return f"lietool found nothing to render with ({reasons}).\n{advice.text()}"


class Loader(Protocol):
    """What `moderngl.create_context` calls."""

    def load_opengl_function(self, name: str) -> int: ...
    def release(self) -> None: ...
    def __enter__(self) -> "Loader": ...
    def __exit__(self, *_: object) -> None: ...


@dataclass(frozen=True)
class Context:
    """The OpenGL context of this process.

    Attributes
    ----------
    backend : str
        ``osmesa``, ``egl``, ``gpu`` or ``system``.
    canonical : bool
        Whether goldens may be made and judged with it: llvmpipe, by OSMesa or EGL.
    info : dict
        All about it, ready for JSON: what `mesa.describe` returns, ``backend``, ``canonical``,
        ``skipped`` (backends tried before, and why not they) and ``notes``.
    """

    backend: str
    canonical: bool
    info: dict[str, Any]
    _gl: moderngl.Context = field(repr=False)
    _loader: Loader | None = field(repr=False)
    _process: int = field(default_factory=os.getpid, repr=False)
    _thread: int = field(default_factory=threading.get_ident, repr=False)

    @property
    def gl(self) -> moderngl.Context:
        """The moderngl context, made current; RuntimeError in another thread or in a forked child."""
        self.make_current()
        return self._gl

    def make_current(self) -> None:
        """Make this the context that OpenGL calls go to (2 microseconds).

        Raises
        ------
        RuntimeError
            In another thread than the one that made it, and in a fork of the process that made it.
        """
        if os.getpid() != self._process:
            raise RuntimeError(
                f"render.context: OpenGL must not be used in a fork of a process that renders; got a fork of "
                f"process {self._process}. Start workers with multiprocessing.get_context('spawn')."
            )
        if threading.get_ident() != self._thread:
            raise RuntimeError(
                "render.context: OpenGL must be used in the thread that used it first; got another thread. "
                "Render in one thread, or in spawned processes."
            )
        # Another library in this process may have made its own context current since.
        if self._loader is not None:
            self._loader.__enter__()


_context: Context | None = None
_making = threading.Lock()


def get(backend: str | None = None) -> Context:
    """Return the context of this process, made at the first call.

    Parameters
    ----------
    backend : str, optional
        One of `BACKENDS`; if not given, what the process has, else ``LIETOOL_BACKEND``, else the first
        that works of OSMesa, EGL on a software device and, on macOS and Windows, the system's OpenGL.

    Returns
    -------
    Context
        The same one at every call, current.

    Raises
    ------
    NoRendererError
        If nothing can render; the message says what to install.
    ValueError
        If `backend` is unknown, or this process renders with another one.
    RuntimeError
        In another thread than the first caller's, and in a fork of a process that renders.
    """
    global _context
    with _making:
        if _context is None:
            _context = _create(_order(backend))
    _context.make_current()
    if backend not in (None, _context.backend):
        raise ValueError(
            f"render.context.get: backend must be {_context.backend!r}, which this process renders with; "
            f"got {backend!r}. Start another process for another backend."
        )
    return _context


def _order(backend: str | None) -> tuple[str, ...]:
    wanted = backend or os.environ.get(ENVIRONMENT)
    if not wanted:
        return ("osmesa", "egl") if sys.platform.startswith("linux") else ("osmesa", "egl", "system")
    if wanted not in BACKENDS:
        raise ValueError(
            f"render.context.get: {'backend' if backend else ENVIRONMENT} must be one of "
            f"{', '.join(BACKENDS)}; got {wanted!r}. Leave it out to take the first that works."
        )
    return (wanted,)


def _create(backends: tuple[str, ...]) -> Context:
    variables, notes = mesa.settings(software=not {"gpu", "system"} & set(backends))
    for name in (name for name, value in variables.items() if value is None):
        # For good, since Mesa from 25.0 on reads it only when it first compiles a shader.
        os.environ.pop(name, None)
    skipped: dict[str, str] = {}
    for backend in backends:
        try:
            with mesa.environment(variables):
                gl, loader = _open(backend)
        except OSError as error:
            skipped[backend] = str(error)
            continue
        # Otherwise every figure leaves its buffers and textures behind.
        gl.gc_mode = "auto"
        info = mesa.describe(gl)
        canonical = backend in ("osmesa", "egl") and info["renderer"].startswith("llvmpipe")
        info |= {"backend": backend, "canonical": canonical, "skipped": skipped, "notes": notes}
        return Context(backend, canonical, info, gl, loader)
    raise NoRendererError(skipped)


def _open(backend: str) -> tuple[moderngl.Context, Loader | None]:
    if backend == "system":
        with _plain_exceptions_as_os_errors():
            return moderngl.create_context(require=330, standalone=True), None
    loader = osmesa.Loader(osmesa.load()) if backend == "osmesa" else egl.load(software=backend == "egl")
    # moderngl's annotation of `context` does not know the loaders that its manual asks for.
    settings: dict[str, Any] = {"standalone": True, "context": loader}
    return moderngl.create_context(require=330, **settings), loader


@contextlib.contextmanager
def _plain_exceptions_as_os_errors() -> Iterator[None]:
    # glcontext raises Exception itself when there is no display; its subclasses are bugs, and pass.
    try:
        yield
    except BaseException as error:
        if type(error) is not Exception:
            raise
        raise OSError(str(error)) from error
